//! Checks finished faces against size, chord error and angle, and says what is missing in which direction.

use glam::DVec3;

use super::build::Input;
use super::chart::Shape;
use super::chord;
use super::data::Mesh;
use super::edges::Limits;
use super::faces::{Frame, Prepared};
use super::layout::Face;
use super::proof::{self, Proof};
use super::reuse::{Known, recalled};
use super::rows::{SIZE_ROOM, Wish};
use crate::base::digest::{Digest, Digester};
use crate::base::math::angle_between;
use crate::base::par;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::surface::{Lean, Surface};

/// Room for the measured chord error: what its search may leave unseen.
const SEEN: f64 = 1.001;

/// What a face asks for, as factors on its counts along u and along v (a triangle: the first for all).
#[derive(Clone, Debug)]
pub struct Verdict {
    /// For the size; a written count may overrule it.
    pub size: [f64; 2],
    /// For chord error and angle.
    pub limit: [f64; 2],
    /// The limit behind.
    pub broken: &'static str,
    /// What was measured for it.
    pub reached: f64,
}

impl Verdict {
    /// Nothing is asked.
    pub const FINE: Self = Self { size: [1.0; 2], limit: [1.0; 2], broken: "size", reached: 0.0 };

    /// No limit is broken.
    pub fn keeps_limits(&self) -> bool {
        self.limit.iter().all(|f| *f <= 1.0)
    }

    /// The size is kept.
    pub fn keeps_size(&self) -> bool {
        self.size.iter().all(|f| *f <= 1.0 + WHOLE_NUMBER)
    }

    /// The largest factor.
    pub fn worst(&self) -> f64 {
        self.size.iter().chain(&self.limit).fold(1.0, |m: f64, f| m.max(*f))
    }
}

/// Everything about one face that a check needs.
pub struct Finished<'a> {
    /// Its place in the layout.
    pub face: &'a Face,
    /// Its chart and ids.
    pub ready: &'a Prepared,
    /// Its elements in the mesh.
    pub triangles: std::ops::Range<usize>,
    /// Sampled bends, to choose the direction of refinement.
    pub wishes: &'a [Wish; 2],
    /// Directions whose counts are written out: the size does not speak there.
    pub written: [bool; 2],
}

/// The verdict on each face.
pub fn check(input: &Input, limits: &Limits, mesh: &Mesh, faces: &[Finished], keyed: Option<(&Known, &[Digest])>) -> Vec<Verdict> {
    par::map(faces.len(), |k| {
        let finished = &faces[k];
        let key = |_: &Known| {
            let start = Digester::new("verdict").with(&keyed.map(|keyed| keyed.1[k]));
            start
                .with(&(limits, finished.face.size.0, (finished.written, finished.wishes, (input.tolerance, finished.ready.chart.flipped))))
                .finish()
        };
        recalled(keyed.map(|keyed| keyed.0), |reuse| &reuse.verdicts, key, || verdict_on(input, limits, mesh, finished))
    })
}

fn verdict_on(input: &Input, limits: &Limits, mesh: &Mesh, finished: &Finished) -> Verdict {
    let surface = &input.model.surfaces[finished.face.surface.index()].surface;
    let mut verdict = Verdict::FINE;
    sizes(finished, mesh, &mut verdict);
    if let Some(limit) = limits.chord {
        chords(input, (surface, limit), mesh, finished, &mut verdict);
    }
    if let Some(limit) = limits.angle {
        turns(surface, finished, limit, &mut verdict);
    }
    verdict
}

/// The chord error: proved by bounds. Where there is no proof it is measured, and where no place breaks the limit the bound is
/// what has to fall.
fn chords(input: &Input, (surface, limit): (&Surface, f64), mesh: &Mesh, finished: &Finished, verdict: &mut Verdict) {
    let (chart, triangles) = (&finished.ready.chart, &mesh.triangles[finished.triangles.clone()]);
    let proof = proof::of_face((surface, limit), chart, triangles, &mesh.nodes);
    if proof == Proof::Kept {
        return;
    }
    let measured = chord::of_face(surface, chart, triangles, &mesh.nodes, input.tolerance);
    let over = measured * SEEN / limit;
    let (over, share) = match proof {
        Proof::Open(bound, [a, b]) | Proof::Broken(bound, [a, b]) if over <= 1.0 => (bound, [2.0 * a >= b, 2.0 * b >= a]),
        _ => (over, directions(finished)),
    };
    verdict.limit = share.map(|dominates| if dominates { over.sqrt().min(2.0) } else { 1.0 });
    (verdict.broken, verdict.reached) = ("chord_error", over * limit / SEEN);
}

/// Which directions bend enough to be worth refining: the larger one, and the other when it adds half as much.
fn directions(finished: &Finished) -> [bool; 2] {
    let Frame::Grid(frame) = &finished.ready.chart.frame else {
        return [true; 2];
    };
    let (nu, nv) = frame.size();
    let per_step = |wish: &Wish, n: usize| wish.bend / (n * n) as f64;
    let (a, b) = (per_step(&finished.wishes[0], nu), per_step(&finished.wishes[1], nv));
    [2.0 * a >= b, 2.0 * b >= a]
}

/// Edges along u and v against the size with its room; diagonals are left aside.
fn sizes(finished: &Finished, mesh: &Mesh, verdict: &mut Verdict) {
    let most = finished.face.size.0 * SIZE_ROOM;
    let node = |id: u32| mesh.nodes[id as usize];
    match &finished.ready.chart.frame {
        Frame::Grid(frame) => {
            let (nu, nv) = frame.size();
            let mut longest = [0.0_f64; 2];
            if !finished.written[0] {
                for j in 1..nv {
                    let mut last = node(frame.node(0, j));
                    for i in 1..=nu {
                        let next = node(frame.node(i, j));
                        longest[0] = longest[0].max(last.distance_squared(next));
                        last = next;
                    }
                }
            }
            if !finished.written[1] {
                for j in 0..nv {
                    for i in 1..nu {
                        longest[1] = longest[1].max(node(frame.node(i, j)).distance_squared(node(frame.node(i, j + 1))));
                    }
                }
            }
            verdict.size = longest.map(|square| square.sqrt() / most);
        }
        Frame::Lattice(frame) => {
            let n = frame.sides[0].len() - 1;
            let mut longest = 0.0_f64;
            for (i, j) in super::trilateral::LatticeFrame::inner(n) {
                let p = node(frame.node(i, j));
                for q in [(i + 1, j), (i, j + 1), (i + 1, j - 1)] {
                    longest = longest.max(p.distance_squared(node(frame.node(q.0, q.1))));
                }
            }
            verdict.size = [longest.sqrt() / most; 2];
        }
        // What is made freely keeps its limits by itself.
        Frame::Free(_) => {}
        Frame::Blocks(places) => {
            let Shape::Blocks(blocks) = &finished.ready.chart.shape else { return };
            let inner = blocks.inner as u32;
            let mut longest = 0.0_f64;
            for q in &blocks.quads {
                for k in 0..4 {
                    let (a, b) = (q[k], q[(k + 1) % 4]);
                    if a < inner || b < inner {
                        longest = longest.max(node(places[a as usize]).distance_squared(node(places[b as usize])));
                    }
                }
            }
            verdict.size = [longest.sqrt() / most; 2];
        }
    }
    for (factor, written) in verdict.size.iter_mut().zip(finished.written) {
        if written {
            *factor = 1.0;
        }
    }
}

/// Turns of the normal between the corners of each cell.
fn turns(surface: &Surface, finished: &Finished, limit: f64, verdict: &mut Verdict) {
    let mut worst = [0.0_f64; 3];
    match &finished.ready.chart.shape {
        Shape::Grid(grid) => {
            let (nu, nv) = grid.size();
            let lean = |at: usize, last: usize| if at == last { Lean::Before } else { Lean::After };
            let row = |j: usize| -> Vec<DVec3> {
                (0..=nu)
                    .map(|i| {
                        let (u, v) = grid.uv(i, j);
                        surface.normal_lean(u, v, (lean(i, nu), lean(j, nv)))
                    })
                    .collect()
            };
            let mut below = row(0);
            for j in 0..nv {
                let above = row(j + 1);
                for i in 0..nu {
                    worst[0] = worst[0].max(turn(below[i], below[i + 1])).max(turn(above[i], above[i + 1]));
                    worst[1] = worst[1].max(turn(below[i], above[i])).max(turn(below[i + 1], above[i + 1]));
                    worst[2] = worst[2].max(turn(below[i], above[i + 1])).max(turn(below[i + 1], above[i]));
                }
                below = above;
            }
        }
        shape => {
            let uv = match shape {
                Shape::Lattice(lattice) => super::trilateral::lattice_points(lattice),
                Shape::Blocks(blocks) => blocks.uv.clone(),
                Shape::Free(free) => free.uv.clone(),
                Shape::Grid(_) => Vec::new(),
            };
            let normals: Vec<DVec3> = uv.iter().map(|(u, v)| surface.normal(*u, *v)).collect();
            super::chord::each_cell(shape, |corners| {
                for a in corners {
                    for b in corners {
                        worst[2] = worst[2].max(turn(normals[*a], normals[*b]));
                    }
                }
            });
        }
    }
    let most = worst.iter().fold(0.0_f64, |m, t| m.max(*t));
    let over = most / limit;
    if over > 1.0 + WHOLE_NUMBER {
        let share = [2.0 * worst[0] >= worst[1], 2.0 * worst[1] >= worst[0]];
        for (factor, dominates) in verdict.limit.iter_mut().zip(share) {
            if dominates {
                *factor = factor.max(over.min(2.0));
            }
        }
        if worst[0] == 0.0 && worst[1] == 0.0 {
            verdict.limit = verdict.limit.map(|f| f.max(over.min(2.0)));
        }
        (verdict.broken, verdict.reached) = ("angle_error", most);
    }
}

fn turn(a: DVec3, b: DVec3) -> f64 {
    if a == DVec3::ZERO || b == DVec3::ZERO { 0.0 } else { angle_between(a, b) }
}
