//! STL: triangles with normals, single precision in the binary form; text has one `solid` per surface.

use std::io::{self, Write};

use glam::DVec3;

use crate::base::text::{push_real, push_single};
use crate::io::files::block_writer::{write_fixed, write_records};
use crate::io::files::loss::Loss;
use crate::io::files::names::{Names, Naming};
use crate::io::mesh_files::deck::{Deck, Encoding};
use crate::io::mesh_files::format::{Format, Takes};
use crate::io::mesh_files::losses::{left_out, names_lost};
use crate::io::mesh_files::single_precision::rounding;
use crate::io::mesh_files::triangulated::halves;
use crate::mesh::{FaceRange, Mesh};

/// Binary by default.
pub const FORMAT: Format = Format {
    name: "stl",
    extensions: &["stl"],
    encoding: Encoding::Binary,
    encodings: &[Encoding::Binary, Encoding::Text],
    elements: &[],
    takes: Takes::Faces,
    unit: None,
    colors: false,
    holds: "triangles, quads as two of them; text: a name per surface",
    write,
};

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    if deck.is_text(FORMAT.encoding) {
        let losses = write_text(deck, out)?;
        return Ok(losses.into_iter().chain(left_out(mesh, true)).collect());
    }
    let mut header = [b' '; 80];
    // The first word must not be `solid`: some readers take that for text.
    let title = format!("made by loft, lengths in {}", deck.unit);
    header.iter_mut().zip(title.bytes()).for_each(|(to, from)| *to = from);
    out.write_all(&header)?;
    let (triangles, quads) = (mesh.triangles.len(), mesh.quads.len());
    let moved = single_precision(deck)?;
    let count = u32::try_from(triangles + 2 * quads).map_err(|_| io::Error::other("more triangles than STL can count"))?;
    out.write_all(&count.to_le_bytes())?;
    write_fixed::<50>(out, triangles, |i, record| facet(deck, mesh.triangles[i], record))?;
    write_fixed::<100>(out, quads, |i, record| {
        let [a, b] = halves(mesh, i);
        let (first, second) = record.split_at_mut(50);
        if let (Ok(first), Ok(second)) = (first.try_into(), second.try_into()) {
            facet(deck, a, first);
            facet(deck, b, second);
        }
    })?;
    let losses = moved.into_iter().chain(left_out(mesh, true));
    Ok(losses.chain(names_lost(mesh, deck.options, "the sets", |_| true)).collect())
}

/// What is lost where coordinates are rounded to single precision: far from the origin whole edges.
///
/// Fails where corners of a triangle fall together.
fn single_precision(deck: &Deck) -> io::Result<Option<Loss>> {
    let moved = rounding(deck, DVec3::ZERO).map_err(|corners| {
        io::Error::other(format!(
            "binary STL has single precision, in which corners of a triangle at {} coincide: write it with `encoding: text`, or move the \
             model to the origin",
            corners.place(deck)
        ))
    })?;
    let loss =
        |moved: f64| format!("all digits of the nodes: they move by up to {moved:.1e} {}, and `encoding: text` keeps them", deck.unit);
    Ok(moved.map(|moved| Loss::LeftOut(loss(moved))))
}

fn normal(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let n = (b - a).cross(c - a);
    let length = n.length();
    if length > 0.0 { n / length } else { DVec3::ZERO }
}

fn corners(deck: &Deck, nodes: [u32; 3]) -> [DVec3; 3] {
    nodes.map(|n| deck.place(n))
}

fn facet(deck: &Deck, nodes: [u32; 3], record: &mut [u8; 50]) {
    let [a, b, c] = corners(deck, nodes);
    let n = normal(a, b, c);
    for (k, v) in [n, a, b, c].into_iter().enumerate() {
        let at = 12 * k;
        record[at..at + 4].copy_from_slice(&(v.x as f32).to_le_bytes());
        record[at + 4..at + 8].copy_from_slice(&(v.y as f32).to_le_bytes());
        record[at + 8..at + 12].copy_from_slice(&(v.z as f32).to_le_bytes());
    }
    record[48..50].fill(0);
}

/// Surfaces with all their patches, by name in order of declaration.
fn surfaces(mesh: &Mesh) -> Vec<(&str, Vec<&FaceRange>)> {
    let mut surfaces: Vec<(&str, Vec<&FaceRange>)> = Vec::new();
    for face in mesh.faces.iter().filter(|face| !face.triangles.is_empty() || !face.quads.is_empty()) {
        match surfaces.last_mut() {
            Some((name, ranges)) if *name == face.name => ranges.push(face),
            _ => surfaces.push((&face.name, vec![face])),
        }
    }
    surfaces
}

fn write_text(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let mut names = Names::new(Naming::Free);
    let whole =
        FaceRange { name: mesh.name.clone(), triangles: 0..mesh.triangles.len() as u32, quads: 0..mesh.quads.len() as u32, lines: 0..0 };
    let mut surfaces = surfaces(mesh);
    if surfaces.is_empty() {
        surfaces.push((&mesh.name, vec![&whole]));
    }
    for (name, ranges) in &surfaces {
        let name = names.give(name);
        writeln!(out, "solid {name}")?;
        for range in ranges {
            let (t, q) = (range.triangles.start as usize, range.quads.start as usize);
            write_records(out, range.triangles.len(), |i, text| facet_text(deck, mesh.triangles[t + i], text))?;
            write_records(out, range.quads.len(), |i, text| {
                for half in halves(mesh, q + i) {
                    facet_text(deck, half, text);
                }
            })?;
        }
        writeln!(out, "endsolid {name}")?;
    }
    let mut losses = names.losses;
    losses.extend(names_lost(mesh, deck.options, "the sets", |group| !surfaces.iter().any(|(name, _)| *name == group.name)));
    Ok(losses)
}

fn facet_text(deck: &Deck, nodes: [u32; 3], text: &mut Vec<u8>) {
    let [a, b, c] = corners(deck, nodes);
    text.extend_from_slice(b"facet normal");
    // Readers compute the normal from the corners anyway: single precision is enough.
    for x in normal(a, b, c).to_array() {
        text.push(b' ');
        push_single(text, x as f32);
    }
    text.extend_from_slice(b"\nouter loop\n");
    for p in [a, b, c] {
        text.extend_from_slice(b"vertex ");
        push_real(text, p.x);
        text.push(b' ');
        push_real(text, p.y);
        text.push(b' ');
        push_real(text, p.z);
        text.push(b'\n');
    }
    text.extend_from_slice(b"endloop\nendfacet\n");
}
