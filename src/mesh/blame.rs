//! Why the least angle of a face is small: what its border is like there.

use std::collections::BTreeMap;

use glam::DVec3;

use super::data::Mesh;
use super::edges::distance_to_segment;
use super::faces::Prepared;
use super::free::face::Made;
use super::layout::Face;
use super::sizing::Sizing;
use crate::base::math::angle_between;
use crate::base::par;
use crate::base::text::real;

/// Angles from here on need no word, radians: 15°.
const SMALL: f64 = 0.2618;
/// A corner of the border this much wider than the least angle is not its cause.
const ITSELF: f64 = 1.5;
/// A side shorter than this share of the longest one makes its triangle sharp.
const SHORT: f64 = 0.3;

/// The least angle of each face with its place and the border's part in it; nothing where it is not small, or where
/// triangles are long by their method.
pub fn of_faces(made: &Made, sizing: &Sizing, prepared: &[Prepared], mesh: &Mesh) -> Vec<String> {
    let (mut t, mut q) = (0, 0);
    let ranges = prepared.iter().map(|ready| {
        let range = (t..t + ready.triangles as usize, q..q + ready.quads as usize);
        (t, q) = (range.0.end, range.1.end);
        range
    });
    let ranges: Vec<_> = ranges.collect();
    par::map(prepared.len(), |f| {
        let elements = (&mesh.triangles[ranges[f].0.clone()], &mesh.quads[ranges[f].1.clone()]);
        of_face(made, sizing, &made.layout.faces[f], elements, mesh).unwrap_or_default()
    })
}

type Elements<'a> = (&'a [[u32; 3]], &'a [[u32; 4]]);

fn of_face(made: &Made, sizing: &Sizing, face: &Face, (triangles, quads): Elements, mesh: &Mesh) -> Option<String> {
    if face.free && face.method.is_sparing() {
        return None;
    }
    // Each corner first, with the nodes before and after it.
    let halves = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *d], [*b, *c, *a], [*c, *d, *b], [*d, *a, *c]]);
    let own = triangles.iter().flat_map(|[a, b, c]| [[*a, *b, *c], [*b, *c, *a], [*c, *a, *b]]);
    let least = own.chain(halves).map(|t| (angle(mesh, t), t)).min_by(|a, b| a.0.total_cmp(&b.0))?;
    if least.0 >= SMALL {
        return None;
    }
    let why = Blame { made, sizing, face, mesh, edges: edges(made, face) }.why(least)?;
    Some(format!("; least angle {}° at {}: {why}", digits(least.0.to_degrees()), place(mesh.nodes[least.1[0] as usize])))
}

fn angle(mesh: &Mesh, c: [u32; 3]) -> f64 {
    let [a, b, d] = c.map(|n| mesh.nodes[n as usize]);
    if a == b || a == d { 0.0 } else { angle_between(b - a, d - a) }
}

fn place(p: DVec3) -> String {
    format!("({:.3}, {:.3}, {:.3})", p.x + 0.0, p.y + 0.0, p.z + 0.0)
}

/// A number with three digits that count.
fn digits(x: f64) -> String {
    real(format!("{x:.2e}").parse().unwrap_or(x))
}

/// Border edges of a face by the numbers of their nodes, with their stretches.
fn edges(made: &Made, face: &Face) -> BTreeMap<(u32, u32), usize> {
    let mut edges = BTreeMap::new();
    for stretch in face.stretches() {
        for w in made.nodes.of_stretch(made.layout, stretch, false).windows(2) {
            edges.insert((w[0].min(w[1]), w[0].max(w[1])), stretch);
        }
    }
    edges
}

struct Blame<'a> {
    made: &'a Made<'a>,
    sizing: &'a Sizing,
    face: &'a Face,
    mesh: &'a Mesh,
    edges: BTreeMap<(u32, u32), usize>,
}

impl Blame<'_> {
    fn stretch(&self, a: u32, b: u32) -> Option<usize> {
        self.edges.get(&(a.min(b), a.max(b))).copied()
    }

    /// The longest step of the border at a node, and its stretch.
    fn longest_at(&self, n: u32) -> Option<(f64, usize)> {
        let length = |(a, b): &(u32, u32)| self.mesh.nodes[*a as usize].distance(self.mesh.nodes[*b as usize]);
        let own = self.edges.iter().filter(|((a, b), _)| *a == n || *b == n).map(|(e, stretch)| (length(e), *stretch));
        own.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn on_border(&self, n: u32) -> bool {
        n < self.made.nodes.total
    }

    /// What the border does at a sharp triangle.
    fn why(&self, (least, c): (f64, [u32; 3])) -> Option<String> {
        let p = c.map(|n| self.mesh.nodes[n as usize]);
        // The side opposite each corner: where it is the border's, with its length and the distance of the corner.
        let side = |k: usize| (c[(k + 1) % 3], c[(k + 2) % 3]);
        let length = |k: usize| p[(k + 1) % 3].distance(p[(k + 2) % 3]);
        let given = [0, 1, 2].map(|k| self.stretch(side(k).0, side(k).1));
        for k in 0..3 {
            // Between two edges of the border.
            if given[k].is_none() && given[(k + 1) % 3].is_some() && given[(k + 2) % 3].is_some() {
                let turn = angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                let [a, b] = [length((k + 1) % 3), length((k + 2) % 3)].map(digits);
                return Some(if turn <= ITSELF * least {
                    format!("in a corner of the border of {}°", digits(turn.to_degrees()))
                } else {
                    format!("in a corner of the border, between steps of {a} and {b}")
                });
            }
        }
        let longest = (0..3).map(length).fold(0.0, f64::max);
        for k in 0..3 {
            let Some(stretch) = given[k] else { continue };
            // Short steps on one side and long ones on the other.
            let facing = self.longest_at(c[k]).filter(|l| l.0 * SHORT > length(k) && given[(k + 1) % 3].or(given[(k + 2) % 3]).is_none());
            if let Some((step, stretch)) = facing {
                let gap = distance_to_segment(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
                return Some(format!("between borders {} apart, with a step of {}{}", digits(gap), digits(step), self.kept(stretch, gap)));
            }
            if length(k) < SHORT * longest {
                return Some(format!("beside a piece of the border of {}", digits(length(k))));
            }
            if self.on_border(c[k]) {
                let gap = distance_to_segment(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
                let step = digits(length(k));
                return Some(format!("between borders {} apart, with a step of {step}{}", digits(gap), self.kept(stretch, gap)));
            }
        }
        let shortest = (0..3).find(|k| length(*k) < SHORT * longest)?;
        let (a, b) = side(shortest);
        (self.on_border(a) && self.on_border(b)).then(|| format!("between borders {} apart", digits(length(shortest))))
    }

    /// Why a step was not made shorter, in words that follow it.
    fn kept(&self, stretch: usize, gap: f64) -> String {
        let mapped = || self.made.layout.faces.iter().any(|f| !f.free && f.stretches().any(|s| s == stretch));
        if self.sizing.decisions[stretch].count.is_some() {
            " by a written count".to_owned()
        } else if mapped() {
            " of the rows of a mapped face".to_owned()
        } else if gap < super::narrow::floor(self.made, self.face) {
            format!(" that is not made less than {}", digits(super::narrow::floor(self.made, self.face)))
        } else {
            String::new()
        }
    }
}
