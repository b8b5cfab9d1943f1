//! Reads STL, binary or text, into a mesh whose equal corners are one node.

use glam::DVec3;

use crate::base::job;
use crate::base::text::parse_real;
use crate::io::files::fault::Malformed;
use crate::io::mesh_files::obj_read::group_of;
use crate::io::mesh_files::weld::weld;
use crate::io::tables::text::decode;
use crate::mesh::{FaceRange, Mesh};

/// Bytes of the header of a binary file, and of each triangle.
const HEADER: usize = 84;
const RECORD: usize = 50;

/// Reads an STL: one surface per `solid`; triangles whose corners are not three are skipped and reported (W810).
///
/// A file is binary when its size is what its count of triangles says, whatever its first word.
pub fn read(bytes: &[u8], name: &str) -> Result<(Mesh, Vec<Malformed>), Malformed> {
    let count = bytes.get(80..HEADER).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let solids = match count {
        Some(count) if bytes.len() as u64 == HEADER as u64 + RECORD as u64 * u64::from(count) => {
            vec![(name.to_owned(), binary(&bytes[HEADER..])?)]
        }
        _ if bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) => text(bytes, name)?,
        Some(count) if bytes.len() >= HEADER => {
            let what = format!(
                "the file states {count} triangles, which needs {} bytes, but it has {}",
                HEADER as u64 + RECORD as u64 * u64::from(count),
                bytes.len()
            );
            return Err(Malformed { line: 0, column: Some(81), what });
        }
        _ => {
            return Err(Malformed {
                line: 0,
                column: Some(1),
                what: "this is neither text that starts with `solid` nor a binary STL".to_owned(),
            });
        }
    };
    Ok(assemble(solids, name))
}

type Corners = Vec<DVec3>;

fn binary(records: &[u8]) -> Result<Corners, Malformed> {
    let mut corners = Vec::with_capacity(records.len() / RECORD * 3);
    for (k, record) in records.as_chunks::<RECORD>().0.iter().enumerate() {
        job::poll();
        for corner in record[12..48].as_chunks::<12>().0 {
            let mut p = [0.0; 3];
            for (x, bytes) in p.iter_mut().zip(corner.as_chunks::<4>().0) {
                *x = f64::from(f32::from_le_bytes(*bytes));
            }
            if !p.iter().all(|x: &f64| x.is_finite()) {
                let what = format!("triangle {} has a coordinate that is not a number", k + 1);
                return Err(Malformed { line: 0, column: Some((HEADER + RECORD * k + 1) as u64), what });
            }
            corners.push(p.into());
        }
    }
    Ok(corners)
}

fn text(bytes: &[u8], name: &str) -> Result<Vec<(String, Corners)>, Malformed> {
    let mut solids: Vec<(String, Corners)> = Vec::new();
    let mut in_loop = None;
    for (k, line) in decode(bytes)?.lines().enumerate() {
        job::poll();
        let number = k as u64 + 1;
        let mut words = line.split_whitespace();
        let Some(keyword) = words.next() else { continue };
        match (keyword.to_ascii_lowercase().as_str(), solids.last_mut()) {
            ("solid", _) => {
                let title = words.collect::<Vec<_>>().join(" ");
                solids.push((if title.is_empty() { name.to_owned() } else { title }, Vec::new()));
            }
            ("outer", Some(_)) if in_loop.is_none() => in_loop = Some(0),
            ("vertex", Some((_, corners))) if in_loop.is_some() => {
                let p = words.map(|word| parse_real(word).filter(|x| x.is_finite())).collect::<Option<Vec<f64>>>();
                let Some([x, y, z]) = p.as_deref() else {
                    return Err(Malformed::line(number, "a vertex has three coordinates"));
                };
                corners.push(DVec3::new(*x, *y, *z));
                in_loop = in_loop.map(|n| n + 1);
            }
            ("endloop", Some(_)) => {
                if in_loop != Some(3) {
                    return Err(Malformed::line(number, format!("a loop has three vertices, got {}", in_loop.unwrap_or(0))));
                }
                in_loop = None;
            }
            ("facet" | "endfacet" | "endsolid", Some(_)) if in_loop.is_none() => {}
            _ => return Err(Malformed::line(number, format!("`{keyword}` does not belong here"))),
        }
    }
    if in_loop.is_some() {
        return Err(Malformed::line(bytes.iter().filter(|b| **b == b'\n').count() as u64 + 1, "the file ends inside a triangle"));
    }
    Ok(solids)
}

fn assemble(solids: Vec<(String, Corners)>, name: &str) -> (Mesh, Vec<Malformed>) {
    let all: Corners = solids.iter().flat_map(|(_, corners)| corners.iter().copied()).collect();
    let (nodes, places) = weld(&all);
    let mut mesh = Mesh { name: name.to_owned(), order: 1, nodes, ..Mesh::default() };
    let (mut at, mut skipped) = (0, 0);
    for (name, corners) in solids {
        let start = mesh.triangles.len() as u32;
        for [a, b, c] in places[at..at + corners.len()].as_chunks::<3>().0 {
            job::poll();
            if a == b || b == c || c == a {
                skipped += 1;
            } else {
                mesh.triangles.push([*a, *b, *c]);
            }
        }
        at += corners.len();
        mesh.faces.push(FaceRange { name, triangles: start..mesh.triangles.len() as u32, quads: 0..0, lines: 0..0 });
    }
    mesh.groups = mesh.faces.iter().map(|face| group_of(&mesh, face)).collect();
    let skipped =
        (skipped > 0).then(|| Malformed { line: 0, column: None, what: format!("triangles with equal corners are skipped: {skipped}") });
    (mesh, skipped.into_iter().collect())
}
