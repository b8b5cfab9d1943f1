//! Meshes compared as geometry: the same nodes whatever their numbers, the same faces on them in the same groups, else how
//! far the two are apart and where.

use std::collections::BTreeMap;

use glam::DVec3;

use super::describe::tolerances;
use super::values::rounded;
use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::job;
use crate::io::files::fault::Malformed;
use crate::io::mesh_files::{obj_read, stl_read};
use crate::mesh::Mesh;

/// Digits of a place.
const DIGITS: usize = 6;

/// A mesh without numbers: places, and what stands on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Different places.
    pub nodes: Vec<DVec3>,
    /// Faces and lines.
    pub elements: Vec<Element>,
}

/// A face, or an open run of edges.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Element {
    /// Name of its group; empty without one.
    pub group: String,
    /// Whether the last node is joined to the first.
    pub closed: bool,
    /// Indices of its nodes, in order.
    pub nodes: Vec<u32>,
}

/// Gathers places, each once.
#[derive(Default)]
struct Places {
    shape: Shape,
    known: BTreeMap<[u64; 3], u32>,
}

impl Places {
    fn node(&mut self, p: DVec3) -> u32 {
        job::poll();
        let key = p.to_array().map(|x| (x + 0.0).to_bits());
        let nodes = &mut self.shape.nodes;
        *self.known.entry(key).or_insert_with(|| {
            nodes.push(p);
            nodes.len() as u32 - 1
        })
    }

    fn element(&mut self, group: &str, closed: bool, points: impl IntoIterator<Item = DVec3>) {
        let nodes = points.into_iter().map(|p| self.node(p)).collect();
        self.shape.elements.push(Element { group: group.to_owned(), closed, nodes });
    }
}

impl Shape {
    /// Faces, lines and vertices of an OBJ.
    pub fn from_obj(bytes: &[u8]) -> Result<Self, Malformed> {
        let obj = obj_read::read(bytes)?;
        let mut places = Places::default();
        obj.points.iter().for_each(|p| {
            places.node(*p);
        });
        for group in &obj.groups {
            for k in &group.polygons {
                places.element(&group.name, true, obj.polygons[*k].iter().map(|n| obj.vertices[*n as usize]));
            }
            for k in &group.polylines {
                places.element(&group.name, false, obj.polylines[*k].iter().copied());
            }
        }
        Ok(places.shape)
    }

    /// Triangles of an STL by solid.
    pub fn from_stl(bytes: &[u8]) -> Result<Self, Malformed> {
        stl_read::read(bytes, "").map(|(mesh, _)| Self::from_faces(&mesh))
    }

    /// The faces of a mesh, by surface.
    fn from_faces(mesh: &Mesh) -> Self {
        let mut places = Places::default();
        let at = |n: &u32| mesh.nodes[*n as usize];
        for face in &mesh.faces {
            for k in face.triangles.clone() {
                places.element(&face.name, true, mesh.triangles[k as usize].iter().map(at));
            }
            for k in face.quads.clone() {
                places.element(&face.name, true, mesh.quads[k as usize].iter().map(at));
            }
        }
        places.shape
    }

    /// A mesh as it is: elements of all kinds, its nodes with their own numbers. Groups are compared elsewhere.
    pub fn from_mesh(mesh: &Mesh) -> Self {
        let element = |closed: bool, nodes: &[u32]| Element { group: String::new(), closed, nodes: nodes.to_vec() };
        let lines = mesh.lines.iter().map(|n| element(false, n));
        let faces = mesh.triangles.iter().map(|n| element(true, n)).chain(mesh.quads.iter().map(|n| element(true, n)));
        Self { nodes: mesh.nodes.clone(), elements: lines.chain(faces).collect() }
    }

    /// Triangles that fill the elements; an edge is a triangle without width.
    fn triangles(&self) -> Vec<[DVec3; 3]> {
        let at = |n: u32| self.nodes[n as usize];
        let fan = |element: &Element| -> Vec<[DVec3; 3]> {
            let n = &element.nodes;
            match (element.closed && n.len() > 2, n.as_slice()) {
                (true, _) => (1..n.len() - 1).map(|k| [at(n[0]), at(n[k]), at(n[k + 1])]).collect(),
                (false, [one]) => vec![[at(*one); 3]],
                (false, _) => n.windows(2).map(|w| [at(w[0]), at(w[1]), at(w[1])]).collect(),
            }
        };
        self.elements.iter().flat_map(fan).collect()
    }
}

/// What differs by more than `within`, in words; lengths are in `unit`.
pub fn differs(old: &Shape, new: &Shape, within: f64, unit: &str) -> Option<String> {
    let Matched { partner, unmatched_old, unmatched_new } = matched(old, new, within);
    if unmatched_old.is_empty() && unmatched_new.is_empty() {
        return cells_differ(old, new, &partner, unit);
    }
    if old.nodes.len() == new.nodes.len() && old.elements == new.elements {
        // The same numbers: each node is known.
        let moved = old.nodes.iter().zip(&new.nodes).map(|(a, b)| (a.distance(*b), *b));
        return said_moved(&moved.filter(|m| m.0 > within).collect::<Vec<_>>(), within, unit);
    }
    let gone: Vec<DVec3> = unmatched_old.iter().map(|n| old.nodes[*n]).collect();
    let come: Vec<DVec3> = unmatched_new.iter().map(|n| new.nodes[*n]).collect();
    if gone.len() == come.len() && old.nodes.len() == new.nodes.len() && old.elements.len() == new.elements.len() {
        let points: Vec<[DVec3; 3]> = gone.iter().map(|p| [*p; 3]).collect();
        let near = Near::new(&points);
        let moved: Vec<(f64, DVec3)> = come.iter().map(|p| (near.distance(*p, within), *p)).collect();
        return said_moved(&moved, within, unit);
    }
    Some(said_apart(old, new, &gone, &come, within, unit))
}

fn said_moved(moved: &[(f64, DVec3)], within: f64, unit: &str) -> Option<String> {
    let farthest = moved.iter().copied().reduce(|most, other| if other.0 > most.0 { other } else { most })?;
    let nodes = if moved.len() == 1 { "1 node moved".to_owned() } else { format!("{} nodes moved, farthest", moved.len()) };
    let times = if within > 0.0 { format!(" ({})", tolerances(farthest.0 / within)) } else { String::new() };
    Some(format!("{nodes} {} {unit} at {}{times}", rounded(farthest.0, 2), place(farthest.1)))
}

fn said_apart(old: &Shape, new: &Shape, gone: &[DVec3], come: &[DVec3], within: f64, unit: &str) -> String {
    let farthest = |points: &[DVec3], other: &Shape| {
        let triangles = other.triangles();
        let near = Near::new(&triangles);
        let far = points.iter().map(|p| (near.distance(*p, within), *p));
        far.reduce(|most, other| if other.0 > most.0 { other } else { most })
    };
    let both = [farthest(gone, new), farthest(come, old)];
    let counts = |what: &str, a: usize, b: usize| if a == b { format!("{a} {what}") } else { format!("{a} → {b} {what}") };
    let (n, c) = (counts("nodes", old.nodes.len(), new.nodes.len()), counts("elements", old.elements.len(), new.elements.len()));
    let far = both.into_iter().flatten().reduce(|most, other| if other.0 > most.0 { other } else { most });
    let far = match far {
        Some((d, _)) if d.is_infinite() => "one of the two is empty".to_owned(),
        Some((d, _)) if d <= within => format!("on the same surface (Hausdorff distance {} {unit})", rounded(d, 2)),
        Some((d, p)) => format!("Hausdorff distance {} {unit} at {}", rounded(d, 2), place(p)),
        None => "no node has another place".to_owned(),
    };
    format!("{n}, {c}, {far}")
}

fn place(p: DVec3) -> String {
    let [x, y, z] = p.to_array().map(|x| {
        let text = rounded(x, DIGITS);
        if text.contains(['.', 'e']) { text } else { format!("{text}.0") }
    });
    format!("({x}, {y}, {z})")
}

/// Which new node each old one is.
struct Matched {
    partner: Vec<u32>,
    unmatched_old: Vec<usize>,
    unmatched_new: Vec<usize>,
}

/// Nodes at one place within `within`, the nearest pairs first.
fn matched(old: &Shape, new: &Shape, within: f64) -> Matched {
    let boxes: Vec<Box3> = new.nodes.iter().map(|p| Box3::of([*p])).collect();
    let tree = BoxTree::build(&boxes);
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (k, p) in job::looking(old.nodes.iter().enumerate()) {
        tree.query(&Box3::of([*p]), within, |m| {
            let distance = p.distance(new.nodes[m]);
            if distance <= within {
                pairs.push((distance, k, m));
            }
        });
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut partner = vec![u32::MAX; old.nodes.len()];
    let mut matched = vec![false; new.nodes.len()];
    for (_, k, m) in pairs {
        if partner[k] == u32::MAX && !matched[m] {
            partner[k] = m as u32;
            matched[m] = true;
        }
    }
    let unmatched_old = (0..partner.len()).filter(|k| partner[*k] == u32::MAX).collect();
    let unmatched_new = (0..matched.len()).filter(|m| !matched[*m]).collect();
    Matched { partner, unmatched_old, unmatched_new }
}

/// An element that begins at its smallest number; an open one at its smaller end.
fn canonical(element: &Element, number: impl Fn(u32) -> u32) -> Element {
    let mut nodes: Vec<u32> = element.nodes.iter().map(|n| number(*n)).collect();
    if element.closed {
        let first = (0..nodes.len()).min_by_key(|k| nodes[*k]).unwrap_or(0);
        nodes.rotate_left(first);
    } else if nodes.last() < nodes.first() {
        nodes.reverse();
    }
    Element { nodes, ..element.clone() }
}

/// What differs between elements on the same nodes.
fn cells_differ(old: &Shape, new: &Shape, partner: &[u32], unit: &str) -> Option<String> {
    let mut before: Vec<Element> = job::looking(&old.elements).map(|c| canonical(c, |n| partner[n as usize])).collect();
    let mut after: Vec<Element> = job::looking(&new.elements).map(|c| canonical(c, |n| n)).collect();
    before.sort();
    after.sort();
    let (gone, come) = (without(&before, &after), without(&after, &before));
    let first = come.first().or(gone.first())?;
    let centre = first.nodes.iter().map(|n| new.nodes[*n as usize]).sum::<DVec3>() / first.nodes.len().max(1) as f64;
    let bare = |elements: &[Element], turned: bool| {
        let strip = |c: &Element| {
            let mut nodes = c.nodes.clone();
            if turned {
                nodes.reverse();
            }
            canonical(&Element { group: String::new(), closed: c.closed, nodes }, |n| n)
        };
        let mut elements: Vec<Element> = elements.iter().map(strip).collect();
        elements.sort();
        elements
    };
    let what = if bare(&gone, false) == bare(&come, false) {
        let from = gone.iter().find(|c| c.nodes == first.nodes).map_or("", |c| c.group.as_str());
        format!("{} elements changed their group, the first from `{from}` to `{}`,", come.len(), first.group)
    } else if bare(&gone, true) == bare(&come, false) {
        format!("{} faces are turned over, the first", come.len())
    } else {
        format!("the nodes are the same, but {} elements became {} others, the first", gone.len(), come.len())
    };
    Some(format!("{what} at {} {unit}", place(centre)))
}

/// Items of a sorted list that the other sorted list has not, repeated ones counted.
fn without(these: &[Element], those: &[Element]) -> Vec<Element> {
    let mut rest = those.iter().peekable();
    let mut found = Vec::new();
    for element in these {
        while rest.next_if(|other| *other < element).is_some() {}
        if rest.next_if(|other| *other == element).is_none() {
            found.push(element.clone());
        }
    }
    found
}

/// The nearest of many triangles.
struct Near<'t> {
    triangles: &'t [[DVec3; 3]],
    tree: BoxTree,
    reach: f64,
}

impl<'t> Near<'t> {
    fn new(triangles: &'t [[DVec3; 3]]) -> Self {
        let boxes: Vec<Box3> = triangles.iter().map(|t| Box3::of(*t)).collect();
        let all = boxes.iter().fold(Box3::EMPTY, |all, b| all.union(*b));
        Self { triangles, tree: BoxTree::build(&boxes), reach: all.diagonal() }
    }

    /// Distance to the nearest one; infinite when there is none. `guess` is where the search begins.
    fn distance(&self, p: DVec3, guess: f64) -> f64 {
        job::poll();
        if self.triangles.is_empty() {
            return f64::INFINITY;
        }
        let mut margin = if guess > 0.0 { guess } else { self.reach.max(f64::MIN_POSITIVE) };
        loop {
            let mut best = f64::INFINITY;
            self.tree.query(&Box3::of([p]), margin, |k| best = best.min(to_triangle(p, &self.triangles[k])));
            if best <= margin || !margin.is_finite() {
                return best;
            }
            margin *= 4.0;
        }
    }
}

/// Distance of a point from a triangle, which may have no width [Ericson 2005, §5.1.5].
fn to_triangle(p: DVec3, &[a, b, c]: &[DVec3; 3]) -> f64 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let edge = |a: DVec3, b: DVec3| {
        let d = b - a;
        let length = d.length_squared();
        let t = if length > 0.0 { ((p - a).dot(d) / length).clamp(0.0, 1.0) } else { 0.0 };
        p.distance(a + d * t)
    };
    let inside = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return (p - a).dot(normal).abs() / normal.length();
    }
    edge(a, b).min(edge(b, c)).min(edge(c, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "g roof\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

    fn said(old: &str, new: &str) -> Option<String> {
        differs(&Shape::from_obj(old.as_bytes()).unwrap(), &Shape::from_obj(new.as_bytes()).unwrap(), 1e-6, "m")
    }

    #[test]
    fn numbers_of_nodes_are_nothing() {
        assert_eq!(said("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "v 1 0 0\nv 0 1 0\nv 0 0 0\nf 1 2 3\n"), None);
        assert_eq!(said(SQUARE, "g roof\nv 0 1 0\nv 1 1 0.0000005\nv 1 0 0\nv 0 0 0\nf 2 4 3\nf 4 2 1\n"), None);
    }

    #[test]
    fn a_moved_node_is_found_and_placed() {
        let moved = SQUARE.replace("v 1 1 0", "v 1 1 0.000002");
        assert_eq!(said(SQUARE, &moved).as_deref(), Some("1 node moved 2e-6 m at (1.0, 1.0, 2e-6) (2 tolerances)"));
        let renumbered = "g roof\nv 0 1 0\nv 1 1 0.5\nv 1 0 0\nv 0 0 0\nf 2 4 3\nf 4 2 1\n";
        assert_eq!(said(SQUARE, renumbered).as_deref(), Some("1 node moved 0.5 m at (1.0, 1.0, 0.5) (5e5 tolerances)"));
    }

    #[test]
    fn other_faces_are_told() {
        let flipped = SQUARE.replace("f 1 2 3\nf 1 3 4", "f 1 2 4\nf 2 3 4");
        assert!(said(SQUARE, &flipped).unwrap().starts_with("the nodes are the same, but 2 elements became 2 others, the first at"));
        let turned = SQUARE.replace("f 1 2 3\nf 1 3 4", "f 3 2 1\nf 4 3 1");
        assert!(said(SQUARE, &turned).unwrap().starts_with("2 faces are turned over, the first at"));
        let regrouped = SQUARE.replace("f 1 3 4", "g wall\nf 1 3 4");
        assert!(said(SQUARE, &regrouped).unwrap().starts_with("1 elements changed their group, the first from `roof` to `wall`"));
    }

    #[test]
    fn other_nodes_are_apart() {
        let finer = "g roof\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0.25\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
        assert_eq!(said(SQUARE, finer).as_deref(), Some("4 → 5 nodes, 2 → 4 elements, Hausdorff distance 0.25 m at (0.5, 0.5, 0.25)"));
        assert!(said(SQUARE, &finer.replace("0.25", "0")).unwrap().contains("on the same surface"));
    }

    #[test]
    fn distances_to_triangles() {
        let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for (p, d) in [((0.2, 0.2, 3.0), 3.0), ((-1.0, 0.5, 0.0), 1.0), ((1.0, 1.0, 0.0), 0.5_f64.sqrt()), ((3.0, 0.0, 0.0), 2.0)] {
            assert!((to_triangle(p.into(), &t) - d).abs() < 1e-15, "{p:?}");
        }
        assert_eq!(to_triangle(DVec3::Z, &[DVec3::ZERO; 3]), 1.0);
        assert_eq!(to_triangle(DVec3::Z, &[DVec3::NEG_X, DVec3::X, DVec3::X]), 1.0);
    }
}
