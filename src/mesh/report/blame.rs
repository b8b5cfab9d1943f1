//! Why the least angle of a face is small: what its border is like there.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_6;

use glam::DVec3;

use crate::base::math::{self, angle_between};
use crate::base::text::real;
use crate::base::tolerance::COSINE_ROUNDING;
use crate::base::{job, par};
use crate::mesh::border::layout::Face;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_mesh::{FaceMesh, element_ranges};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::data::quality::QualityTally;
use crate::mesh::face::map_quality::{self, MAP_CHOICE, MapQuality};
use crate::mesh::request::fault::Cure;
use crate::mesh::request::methods::Method;
use crate::mesh::request::sources::distance_to_segment;
use crate::mesh::size::remark::Remark;
use crate::mesh::size::sizing::Sizing;

/// Angles from here on need no word, radians: 15°.
const SMALL: f64 = 0.2618;
/// A corner of the border this much wider than the least angle is not its cause.
const ITSELF: f64 = 1.5;
/// Size that makes the angle over a short side 27°, over that side.
const TALLER: f64 = 2.0;
/// A side shorter than this share of the longest one makes its triangle sharp.
const SHORT: f64 = 0.3;

/// A corner of the border as sharp is the cause of sharp angles near it, radians: 30°.
const POINTED: f64 = FRAC_PI_6;
/// How far its doing goes, in sides of the element.
const REACH: f64 = 3.0;

/// What is to be said of the least angle of a face.
#[derive(Default)]
pub struct Seen {
    /// With its place and the border's part in it; nothing where it is not small.
    pub line: String,
    /// W724: one that is sharp and away from sharp corners.
    pub sharp: Option<Remark>,
}

/// The least angle of each face, of which the quality is known; nothing where triangles are long by their method.
pub fn of_faces(made: &FaceInput, sizing: &Sizing, foreseen: &[Option<MapQuality>], prepared: &[FaceMesh], mesh: &Mesh) -> Vec<Seen> {
    let ranges = element_ranges(prepared);
    par::map(prepared.len(), |f| {
        let blunt = |quality: QualityTally| quality.largest_cosine() < math::cos(MAP_CHOICE.min_map_angle) - COSINE_ROUNDING;
        if prepared[f].geometry.quality.is_some_and(blunt) {
            return Seen::default();
        }
        let elements = (&mesh.triangles[ranges[f].0.clone()], &mesh.quads[ranges[f].1.clone()]);
        of_face(made, sizing, foreseen[f].as_ref(), &made.layout.faces[f], elements, mesh).unwrap_or_default()
    })
}

type Elements<'a> = (&'a [[u32; 3]], &'a [[u32; 4]]);

fn of_face(
    made: &FaceInput,
    sizing: &Sizing,
    foreseen: Option<&MapQuality>,
    face: &Face,
    (triangles, quads): Elements,
    mesh: &Mesh,
) -> Option<Seen> {
    if face.free && face.method.is_coarse() {
        return None;
    }
    let squared_cosine = math::cos(MAP_CHOICE.min_map_angle) * math::cos(MAP_CHOICE.min_map_angle) - COSINE_ROUNDING;
    // Only few elements have a corner as sharp: the others are left out before angles are computed. Each corner comes first, with the
    // nodes after and before it.
    let halves = job::looking(quads).filter(|q| may_be_sharp(mesh, **q, squared_cosine));
    let halves = halves.flat_map(|[a, b, c, d]| [[*a, *b, *d], [*b, *c, *a], [*c, *d, *b], [*d, *a, *c]]);
    let own = job::looking(triangles).filter(|t| may_be_sharp(mesh, **t, squared_cosine));
    let own = own.flat_map(|[a, b, c]| [[*a, *b, *c], [*b, *c, *a], [*c, *a, *b]]);
    let all: Vec<(f64, [u32; 3])> = own.chain(halves).map(|t| (angle(mesh, t), t)).collect();
    let least = all.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0))?;
    if least.0 >= MAP_CHOICE.min_map_angle {
        return None;
    }
    let blame = Blame { made, sizing, face, mesh, edges: edges(made, face) };
    let pointed = blame.pointed();
    let sharp = job::looking(all)
        .filter(|(angle, t)| *angle < MAP_CHOICE.min_map_angle && !blame.is_near(&pointed, *t))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let sharp = sharp.map(|(angle, t)| {
        let surface = made.input.model.surfaces[face.surface.index()].name.clone();
        Remark::Sharp { angle, at: mesh.nodes[t[0] as usize], surface, faces: 1, cure: blame.cure(foreseen, t) }
    });
    let why = if least.0 < SMALL { blame.why(least) } else { None };
    let tell = |why| {
        format!(
            "; least angle {}° at {}: {why}",
            digits(least.0.to_degrees()),
            crate::mesh::report::reasons::point(made.input, mesh.nodes[least.1[0] as usize])
        )
    };
    Some(Seen { line: why.map(tell).unwrap_or_default(), sharp })
}

fn angle(mesh: &Mesh, c: [u32; 3]) -> f64 {
    let [a, b, d] = c.map(|n| mesh.nodes[n as usize]);
    if a == b || a == d { 0.0 } else { angle_between(b - a, d - a) }
}

/// Whether an element has a corner whose cosine is positive with at least this square, or two nodes at one place.
fn may_be_sharp<const N: usize>(mesh: &Mesh, corners: [u32; N], square: f64) -> bool {
    let p = corners.map(|n| mesh.nodes[n as usize]);
    let sides: [DVec3; N] = std::array::from_fn(|k| p[(k + 1) % N] - p[k]);
    let squares = sides.map(DVec3::length_squared);
    (0..N).any(|k| {
        let before = (k + N - 1) % N;
        let (along, lengths) = (-sides[before].dot(sides[k]), squares[before] * squares[k]);
        lengths == 0.0 || along > 0.0 && along * along >= square * lengths
    })
}

/// A number with three digits that count.
fn digits(x: f64) -> String {
    real(format!("{x:.2e}").parse().unwrap_or(x))
}

/// Border edges of a face by the numbers of their nodes, with their segments.
fn edges(made: &FaceInput, face: &Face) -> BTreeMap<(u32, u32), usize> {
    let mut edges = BTreeMap::new();
    for segment in face.segments() {
        for w in made.nodes.of_segment(made.layout, segment, false).windows(2) {
            edges.insert((w[0].min(w[1]), w[0].max(w[1])), segment);
        }
    }
    edges
}

struct Blame<'a> {
    made: &'a FaceInput<'a>,
    sizing: &'a Sizing,
    face: &'a Face,
    mesh: &'a Mesh,
    edges: BTreeMap<(u32, u32), usize>,
}

impl Blame<'_> {
    fn segment(&self, a: u32, b: u32) -> Option<usize> {
        self.edges.get(&(a.min(b), a.max(b))).copied()
    }

    /// The longest step of the border at a node, and its segment.
    fn longest_at(&self, n: u32) -> Option<(f64, usize)> {
        let length = |(a, b): &(u32, u32)| self.mesh.nodes[*a as usize].distance(self.mesh.nodes[*b as usize]);
        let own = self.edges.iter().filter(|((a, b), _)| *a == n || *b == n).map(|(e, segment)| (length(e), *segment));
        own.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Nodes at which two edges of the border meet at a sharp angle.
    fn pointed(&self) -> Vec<DVec3> {
        let node = |n: u32| self.mesh.nodes[n as usize];
        let mut at: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (a, b) in self.edges.keys() {
            at.entry(*a).or_default().push(*b);
            at.entry(*b).or_default().push(*a);
        }
        let sharp = |(n, others): &(&u32, &Vec<u32>)| {
            let ways: Vec<DVec3> = others.iter().map(|o| node(*o) - node(**n)).filter(|way| *way != DVec3::ZERO).collect();
            (1..ways.len()).any(|i| (0..i).any(|j| angle_between(ways[i], ways[j]) < POINTED))
        };
        at.iter().filter(sharp).map(|(n, _)| node(*n)).collect()
    }

    /// Whether an element is near a sharp corner of the border.
    fn is_near(&self, pointed: &[DVec3], c: [u32; 3]) -> bool {
        let p = c.map(|n| self.mesh.nodes[n as usize]);
        let longest = (0..3).map(|k| p[k].distance(p[(k + 1) % 3])).fold(0.0, f64::max);
        pointed.iter().any(|q| p.iter().any(|p| p.distance(*q) <= REACH * longest))
    }

    /// The setting that makes a sharp angle larger.
    fn cure(&self, foreseen: Option<&MapQuality>, c: [u32; 3]) -> Cure {
        let p = c.map(|n| self.mesh.nodes[n as usize]);
        let shortest = (0..3).map(|k| p[k].distance(p[(k + 1) % 3])).fold(f64::INFINITY, f64::min);
        match foreseen {
            _ if map_quality::is_written(self.face, self.sizing) => Cure::Rows,
            None => Cure::Near,
            Some(found) if self.face.method == Method::Mapped && found.is_worse_than_free() => Cure::Auto,
            // A right-angled triangle of the size beside the short side has 27°.
            Some(_) if TALLER * shortest < self.face.size.0 => Cure::Size(TALLER * shortest),
            Some(_) => Cure::Method,
        }
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
        let given = [0, 1, 2].map(|k| self.segment(side(k).0, side(k).1));
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
            let Some(segment) = given[k] else { continue };
            // Short steps on one side and long ones on the other.
            let facing = self.longest_at(c[k]).filter(|l| l.0 * SHORT > length(k) && given[(k + 1) % 3].or(given[(k + 2) % 3]).is_none());
            if let Some((step, segment)) = facing {
                let gap = distance_to_segment(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
                return Some(format!("between borders {} apart, with a step of {}{}", digits(gap), digits(step), self.kept(segment, gap)));
            }
            if length(k) < SHORT * longest {
                return Some(format!("beside a piece of the border of {}", digits(length(k))));
            }
            if self.on_border(c[k]) {
                let gap = distance_to_segment(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
                let step = digits(length(k));
                return Some(format!("between borders {} apart, with a step of {step}{}", digits(gap), self.kept(segment, gap)));
            }
        }
        let shortest = (0..3).find(|k| length(*k) < SHORT * longest)?;
        let (a, b) = side(shortest);
        (self.on_border(a) && self.on_border(b)).then(|| format!("between borders {} apart", digits(length(shortest))))
    }

    /// Why a step was not made shorter, in words that follow it.
    fn kept(&self, segment: usize, gap: f64) -> String {
        let mapped = || self.made.layout.faces.iter().any(|f| !f.free && f.segments().any(|s| s == segment));
        if self.sizing.decisions[segment].count.is_some() {
            " by a written count".to_owned()
        } else if mapped() {
            " of the rows of a mapped face".to_owned()
        } else if gap < crate::mesh::size::proximity::floor(self.made, self.face) {
            format!(" that is not made less than {}", digits(crate::mesh::size::proximity::floor(self.made, self.face)))
        } else {
            String::new()
        }
    }
}
