//! The closed bodies that the faces of a mesh enclose, each with its cavities and with its outside outside.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::{job, math};
use crate::io::mesh_files::deck::Deck;
use crate::io::mesh_files::triangulated::{count, triangle, triangles};
use crate::mesh::Mesh;

/// A body: one skin around it, and one in it for each cavity.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Body {
    /// Its triangles, ascending: triangles of the mesh, then halves of its quads.
    pub triangles: Vec<u32>,
    /// Its triangles point into it in the mesh, and are to be turned where a format takes their side for the outside.
    pub inside_out: bool,
}

impl Body {
    /// Corners of one of its triangles, counter-clockwise seen from outside.
    pub(crate) fn corners(&self, mesh: &Mesh, number: u32) -> [u32; 3] {
        let [a, b, c] = triangle(mesh, number as usize);
        if self.inside_out { [a, c, b] } else { [a, b, c] }
    }
}

/// Why faces enclose no bodies: edges that do not have one face on either side, how many, and the nodes of the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Defect {
    /// Of one face.
    Open(usize, [u32; 2]),
    /// Of three faces or more.
    Crowded(usize, [u32; 2]),
    /// Of two faces that point to different sides.
    Turned(usize, [u32; 2]),
}

impl Defect {
    /// What the mesh has, with the place of the first edge in units of the file.
    pub(crate) fn words(self, deck: &Deck) -> String {
        let (n, [a, b], what) = match self {
            Self::Open(n, edge) => (n, edge, "of one face only"),
            Self::Crowded(n, edge) => (n, edge, "of more than two faces"),
            Self::Turned(n, edge) => (n, edge, "between faces that point to different sides"),
        };
        // Text for people: six digits show where to look.
        let place = ((deck.place(a) + deck.place(b)) / 2.0).to_array().map(|x| crate::base::text::decimals(x, 6)).join(", ");
        match n {
            1 => format!("an edge {what} at ({place}) {}", deck.unit),
            n => format!("{n} edges {what}, the first at ({place}) {}", deck.unit),
        }
    }

    /// What to do.
    pub(crate) fn help(self) -> &'static str {
        match self {
            Self::Open(..) => "mesh a closed shell, or write it as .stl or .glb",
            Self::Crowded(..) => "write a mesh for each body to a file of its own",
            Self::Turned(..) => "mesh a shell of the surfaces: its faces point to one side",
        }
    }
}

/// The bodies of a mesh in the order of their first triangles.
///
/// Faces that are joined by edges are a skin. A skin that lies in another and faces the other way is a cavity of the body
/// around it. Where the outermost skin points inwards, all that lies in it is inside out. Time and memory are those of sorting the
/// sides of all triangles; a skin whose box lies in that of another is compared with all triangles of that one.
pub(crate) fn bodies(mesh: &Mesh) -> Result<Vec<Body>, Defect> {
    let skins = skins(mesh)?;
    let around: Vec<Vec<usize>> = skins.iter().map(|skin| containers(mesh, skin, &skins)).collect();
    let size = |k: &usize| skins[*k].volume.abs();
    let inside_out = |k: usize| {
        let outermost = around[k].iter().copied().max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(k);
        skins[outermost].volume < 0.0
    };
    let is_cavity = |k: usize| (skins[k].volume < 0.0) != inside_out(k);
    let owner = |k: usize| match is_cavity(k) {
        true => around[k].iter().copied().filter(|k| !is_cavity(*k)).min_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(k),
        false => k,
    };
    let mut bodies: Vec<Option<Body>> = skins.iter().map(|_| None).collect();
    for (k, skin) in skins.iter().enumerate() {
        let inside_out = inside_out(k);
        let body = bodies[owner(k)].get_or_insert_with(|| Body { triangles: Vec::new(), inside_out });
        body.triangles.extend(&skin.triangles);
    }
    let mut bodies: Vec<Body> = bodies.into_iter().flatten().collect();
    bodies.iter_mut().for_each(|body| job::sort(&mut body.triangles));
    bodies.sort_by_key(|body| body.triangles.first().copied());
    Ok(bodies)
}

/// Triangles that are joined by edges and enclose something.
struct Skin {
    /// Ascending.
    triangles: Vec<u32>,
    /// Cubed units of the model, below 0 where it points inwards.
    volume: f64,
    hull: Box3,
}

/// The closed skins of a mesh in the order of their first triangles.
fn skins(mesh: &Mesh) -> Result<Vec<Skin>, Defect> {
    // Sides by their lower and higher nodes; the number of the triangle doubled, plus 1 where it runs from the higher node.
    let mut sides: Vec<[u32; 3]> = Vec::with_capacity(3 * count(mesh));
    for (k, [a, b, c]) in job::looking(triangles(mesh)).enumerate() {
        let side = |from: u32, to: u32| [from.min(to), from.max(to), 2 * k as u32 + u32::from(from > to)];
        sides.extend([side(a, b), side(b, c), side(c, a)]);
    }
    job::sort(&mut sides);
    let mut wrong: [(usize, [u32; 2]); 3] = Default::default();
    let mut joined: Vec<u32> = (0..count(mesh) as u32).collect();
    for same in job::looking(sides.chunk_by(|a, b| a[..2] == b[..2])) {
        let defect = match same {
            [one, other] if one[2] % 2 != other[2] % 2 => {
                let (a, b) = (first_of(&mut joined, one[2] / 2), first_of(&mut joined, other[2] / 2));
                joined[a.max(b) as usize] = a.min(b);
                continue;
            }
            [_] => 1,
            [_, _] => 2,
            _ => 0,
        };
        if wrong[defect].0 == 0 {
            wrong[defect].1 = [same[0][0], same[0][1]];
        }
        wrong[defect].0 += 1;
    }
    match wrong {
        [(n, edge), ..] if n > 0 => return Err(Defect::Crowded(n, edge)),
        [_, (n, edge), _] if n > 0 => return Err(Defect::Open(n, edge)),
        [.., (n, edge)] if n > 0 => return Err(Defect::Turned(n, edge)),
        _ => {}
    }
    let mut skins: Vec<Skin> = Vec::new();
    let mut number = vec![0_u32; joined.len()];
    for k in job::looking(0..joined.len()) {
        let first = first_of(&mut joined, k as u32) as usize;
        if first == k {
            number[k] = skins.len() as u32;
            skins.push(Skin { triangles: Vec::new(), volume: 0.0, hull: Box3::EMPTY });
        }
        let skin = &mut skins[number[first] as usize];
        skin.triangles.push(k as u32);
        // Volumes over the first corner of the skin: far from the origin nothing cancels.
        let from = mesh.nodes[triangle(mesh, first)[0] as usize];
        let [a, b, c] = triangle(mesh, k).map(|n| mesh.nodes[n as usize]);
        skin.volume += (a - from).dot((b - from).cross(c - from)) / 6.0;
        skin.hull = skin.hull.with(a).with(b).with(c);
    }
    Ok(skins)
}

/// The first triangle of those that one is joined with; halves the way there [Tarjan & van Leeuwen 1984].
fn first_of(joined: &mut [u32], mut k: u32) -> u32 {
    while joined[k as usize] != k {
        let next = joined[joined[k as usize] as usize];
        joined[k as usize] = next;
        k = next;
    }
    k
}

/// Indices of the skins that one lies in.
fn containers(mesh: &Mesh, skin: &Skin, skins: &[Skin]) -> Vec<usize> {
    let Some(first) = skin.triangles.first() else { return Vec::new() };
    let [a, b, c] = triangle(mesh, *first as usize).map(|n| mesh.nodes[n as usize]);
    let place = (a + b + c) / 3.0;
    let holds = |other: &Skin| {
        let boxes = !std::ptr::eq(other, skin) && skin.hull.min.cmpge(other.hull.min).all() && skin.hull.max.cmple(other.hull.max).all();
        boxes && winding(mesh, other, place).abs() > 0.5
    };
    (0..skins.len()).filter(|k| holds(&skins[*k])).collect()
}

/// How often a skin winds about a place: the solid angles of its triangles [Van Oosterom & Strackee 1983, eq. 8].
fn winding(mesh: &Mesh, skin: &Skin, place: DVec3) -> f64 {
    let mut sum = 0.0;
    for k in job::looking(&skin.triangles) {
        let [a, b, c] = triangle(mesh, *k as usize).map(|n| mesh.nodes[n as usize] - place);
        let (x, y, z) = (a.length(), b.length(), c.length());
        sum += 2.0 * math::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
    }
    sum / (4.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron that many times as large about (1, 1, 1), pointing outwards or inwards.
    fn add(mesh: &mut Mesh, size: f64, outwards: bool) {
        let n = mesh.nodes.len() as u32;
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        mesh.nodes.extend(corners.map(|p| DVec3::ONE + DVec3::from_array(p) * size));
        for [a, b, c] in [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]] {
            mesh.triangles.push(if outwards { [n + a, n + b, n + c] } else { [n + a, n + c, n + b] });
        }
    }

    fn found(parts: &[(f64, bool)]) -> Vec<(usize, bool)> {
        let mut mesh = Mesh { name: "m".into(), order: 1, ..Mesh::default() };
        parts.iter().for_each(|(size, outwards)| add(&mut mesh, *size, *outwards));
        bodies(&mesh).unwrap().iter().map(|body| (body.triangles.len(), body.inside_out)).collect()
    }

    #[test]
    fn skins_in_skins_are_cavities_or_bodies_by_their_side() {
        assert_eq!(found(&[(1.0, true)]), [(4, false)]);
        assert_eq!(found(&[(1.0, false)]), [(4, true)]);
        assert_eq!(found(&[(9.0, true), (3.0, false)]), [(8, false)]);
        assert_eq!(found(&[(3.0, true), (9.0, false)]), [(8, true)]);
        // A body in the cavity of another one.
        assert_eq!(found(&[(9.0, true), (3.0, false), (1.0, true)]), [(8, false), (4, false)]);
        assert_eq!(found(&[]), []);
    }

    #[test]
    fn what_encloses_nothing_is_told_with_its_place() {
        let mut mesh = Mesh { name: "m".into(), order: 1, ..Mesh::default() };
        add(&mut mesh, 1.0, true);
        let options = crate::io::mesh_files::deck::Options::default();
        let words = |mesh: &Mesh| bodies(mesh).unwrap_err().words(&Deck { mesh, unit: "mm", options: &options });
        let whole = mesh.clone();
        mesh.triangles.pop();
        assert_eq!(words(&mesh), "3 edges of one face only, the first at (1, 1, 0) mm");
        mesh = whole.clone();
        mesh.triangles[0].swap(1, 2);
        assert_eq!(bodies(&mesh), Err(Defect::Turned(3, [0, 1])));
        mesh = whole;
        mesh.triangles.push([0, 1, 2]);
        assert_eq!(bodies(&mesh), Err(Defect::Crowded(3, [0, 1])));
    }
}
