//! Checks finished faces against size, chord error and angle, and by which factor counts are too small in each direction.

use glam::{DVec2, DVec3};

use crate::base::digest::{StableHash, StableHasher};
use crate::base::math::widest_angle;
use crate::base::par;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::border::layout::Face;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::deviation::proof::Proof;
use crate::mesh::deviation::{certify, measure, poles};
use crate::mesh::divide::row_demand::RowDemand;
use crate::mesh::mapped::grid::Grid;
use crate::mesh::request::fault::MeshLimit;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::recall::RecallFace;
use crate::mesh::size::border_spacing::SIZE_ROOM;
use crate::surface::{OneSided, Surface};

/// What steers the check of finished faces.
struct CheckSettings {
    /// Room for the measured chord error: what its search may leave unseen.
    measured_room: f64,
    /// Places along each direction of a face at which its normal is sampled, at least.
    min_samples: usize,
    /// Places along a side of a cell at most.
    max_cell_samples: usize,
}

const SETTINGS: CheckSettings = CheckSettings { measured_room: 1.001, min_samples: 64, max_cell_samples: 16 };

/// What a face demands, as factors on its counts along u and along v (a triangle: the first for all).
#[derive(Clone, Copy, Debug)]
pub struct Verdict {
    /// For the size; a written count may overrule it.
    pub size: [f64; 2],
    /// For chord error and angle.
    pub limit: [f64; 2],
    /// The limit behind.
    pub broken: MeshLimit,
    /// What was measured for it.
    pub reached: f64,
}

impl Verdict {
    /// Nothing is missing.
    pub const FINE: Self = Self { size: [1.0; 2], limit: [1.0; 2], broken: MeshLimit::Size, reached: 0.0 };

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
    /// Its geometry and ids.
    pub face_mesh: &'a FaceMesh,
    /// Its elements in the mesh.
    pub triangles: std::ops::Range<usize>,
    /// Sampled bends, to choose the direction of refinement.
    pub demands: &'a [RowDemand; 2],
    /// Directions whose counts are written out: the size does not act there.
    pub written: [bool; 2],
}

/// The verdict on each face.
pub fn check(input: &Input, limits: &Limits, mesh: &Mesh, faces: &[Finished], recall: &RecallFace<Verdict>) -> Vec<Verdict> {
    par::map(faces.len(), |k| {
        let finished = &faces[k];
        let hash = |to: &mut StableHasher| {
            let of_face = (finished.written, finished.demands, (input.tolerance, finished.face_mesh.geometry.flipped));
            (limits, finished.face.size.0, of_face).hash_into(to);
        };
        recall(k, &hash, &|| verdict_on(input, limits, mesh, finished))
    })
}

fn verdict_on(input: &Input, limits: &Limits, mesh: &Mesh, finished: &Finished) -> Verdict {
    let surface = &input.model.surfaces[finished.face.surface.index()].surface;
    let mut verdict = Verdict::FINE;
    sizes(finished, mesh, input.tolerance.point, &mut verdict);
    if let Some(limit) = limits.chord {
        chords(input, limit, mesh, finished, &mut verdict);
    }
    if let Some(limit) = limits.angle {
        turns(surface, finished, limits, limit, &mut verdict);
    }
    verdict
}

/// The chord error: proved by bounds. Where there is no proof it is measured, and where no place breaks the limit the bound is
/// what has to fall.
fn chords(input: &Input, limit: f64, mesh: &Mesh, finished: &Finished, verdict: &mut Verdict) {
    let surface = &input.model.surfaces[finished.face.surface.index()].surface;
    let (geometry, triangles) = (&finished.face_mesh.geometry, &mesh.triangles[finished.triangles.clone()]);
    let proof = certify::of_face(surface, limit, geometry, triangles, &mesh.nodes);
    if proof == Proof::Kept {
        return;
    }
    let measured = measure::of_face(surface, geometry, triangles, &mesh.nodes, input.tolerance);
    let over = measured * SETTINGS.measured_room / limit;
    let (over, share) = match proof {
        Proof::Open(bound, [a, b]) | Proof::Broken(bound, [a, b]) if over <= 1.0 => (bound, [2.0 * a >= b, 2.0 * b >= a]),
        _ => (over, directions(finished)),
    };
    verdict.limit = share.map(|dominates| if dominates { over.sqrt().min(2.0) } else { 1.0 });
    (verdict.broken, verdict.reached) = (MeshLimit::ChordError, over * limit / SETTINGS.measured_room);
}

/// Which directions bend enough to be worth refining: the larger one, and the other when it adds half as much.
fn directions(finished: &Finished) -> [bool; 2] {
    let FaceNodes::Grid(_, frame) = &finished.face_mesh.geometry.nodes else {
        return [true; 2];
    };
    let (nu, nv) = frame.size();
    let per_step = |demand: &RowDemand, n: usize| demand.bend / (n * n) as f64;
    let (a, b) = (per_step(&finished.demands[0], nu), per_step(&finished.demands[1], nv));
    [2.0 * a >= b, 2.0 * b >= a]
}

/// Edges along u and v against the size with its room; diagonals are left aside.
fn sizes(finished: &Finished, mesh: &Mesh, near: f64, verdict: &mut Verdict) {
    let most = finished.face.size.0 * SIZE_ROOM + near;
    let node = |id: u32| mesh.nodes[id as usize];
    match &finished.face_mesh.geometry.nodes {
        FaceNodes::Grid(_, frame) => {
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
        FaceNodes::Lattice(_, frame) => {
            let n = frame.sides[0].len() - 1;
            let mut longest = 0.0_f64;
            for (i, j) in crate::mesh::mapped::trilateral::LatticeIds::inner(n) {
                let p = node(frame.node(i, j));
                for q in [(i + 1, j), (i, j + 1), (i + 1, j - 1)] {
                    longest = longest.max(p.distance_squared(node(frame.node(q.0, q.1))));
                }
            }
            verdict.size = [longest.sqrt() / most; 2];
        }
        // What is meshed freely keeps its limits by itself.
        FaceNodes::Free(..) => {}
        FaceNodes::Blocks(blocks, places) => {
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

/// Turns of the normal over each cell: between its corners, and between places inside where cells are large.
fn turns(surface: &Surface, finished: &Finished, limits: &Limits, limit: f64, verdict: &mut Verdict) {
    let worst = match &finished.face_mesh.geometry.nodes {
        FaceNodes::Grid(grid, frame) => turns_of_grid(surface, grid, frame.poles),
        nodes => [0.0, 0.0, turn_of_cells(surface, nodes)],
    };
    let most = worst.iter().fold(0.0_f64, |m, t| m.max(*t));
    let over = most / limit;
    let room = |demand: &RowDemand| limits.turn_room(demand.length, limit);
    if over > 1.0 + finished.demands.iter().map(room).fold(f64::INFINITY, f64::min) {
        let share = [2.0 * worst[0] >= worst[1], 2.0 * worst[1] >= worst[0]];
        for (factor, dominates) in verdict.limit.iter_mut().zip(share) {
            if dominates {
                *factor = factor.max(over.min(2.0));
            }
        }
        if worst[0] == 0.0 && worst[1] == 0.0 {
            verdict.limit = verdict.limit.map(|f| f.max(over.min(2.0)));
        }
        (verdict.broken, verdict.reached) = (MeshLimit::AngleError, most);
    }
}

/// The largest turns over cells of a grid: along u, along v, and in all.
fn turns_of_grid(surface: &Surface, grid: &Grid, poles: [bool; 4]) -> [f64; 3] {
    let (nu, nv) = grid.size();
    let parts = |n: usize| SETTINGS.min_samples.div_ceil(n).min(SETTINGS.max_cell_samples);
    let (ku, kv) = (parts(nu), parts(nv));
    let lean = |last: bool| if last { OneSided::Before } else { OneSided::After };
    let tangents = |at: DVec2| surface.evaluator().tangents(at.x, at.y);
    let line = |j: usize, y: usize| -> Vec<DVec3> {
        (0..=nu * ku)
            .map(|n| {
                let i = (n / ku).min(nu - 1);
                let (u, v) = inside(grid, (i, j), ((n - i * ku) as f64 / ku as f64, y as f64 / kv as f64));
                let (on_u, on_v) = ([n == 0, n == nu * ku], [j == 0 && y == 0, j + 1 == nv && y == kv]);
                // Each line to the tip of a cone has its own normal there.
                let at_pole = poles[0] && on_v[0] || poles[1] && on_u[1] || poles[2] && on_v[1] || poles[3] && on_u[0];
                let of_pole = at_pole.then(|| poles::normal(surface, &tangents, DVec2::new(u, v))).flatten();
                of_pole.unwrap_or_else(|| surface.normal_one_sided(u, v, (lean(on_u[1]), lean(on_v[1]))))
            })
            .collect()
    };
    let mut worst = [0.0_f64; 3];
    let mut lines = vec![line(0, 0)];
    for j in 0..nv {
        lines.extend((1..=kv).map(|y| line(j, y)));
        for i in 0..nu {
            let along = lines.iter().map(|line| widest_angle(&line[i * ku..=(i + 1) * ku]));
            let across = (i * ku..=(i + 1) * ku).map(|n| widest_angle(&lines.iter().map(|line| line[n]).collect::<Vec<_>>()));
            let (along, across) = (along.fold(0.0, f64::max), across.fold(0.0, f64::max));
            let all: Vec<DVec3> = lines.iter().flat_map(|line| &line[i * ku..=(i + 1) * ku]).copied().collect();
            worst = [worst[0].max(along), worst[1].max(across), worst[2].max(widest_angle(&all))];
        }
        lines.drain(..kv);
    }
    worst
}

/// A place in a cell of a grid by its shares.
fn inside(grid: &Grid, (i, j): (usize, usize), (x, y): (f64, f64)) -> (f64, f64) {
    let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| grid.uv(i, j));
    let mix = |a: f64, b: f64, t: f64| if t == 1.0 { b } else { a + (b - a) * t };
    (mix(mix(a.0, b.0, x), mix(d.0, c.0, x), y), mix(mix(a.1, b.1, x), mix(d.1, c.1, x), y))
}

/// The largest turn over the cells of a lattice, of blocks or of a free face.
fn turn_of_cells(surface: &Surface, nodes: &FaceNodes) -> f64 {
    let uv = nodes.listed_uv();
    let normals: Vec<DVec3> = uv.iter().map(|(u, v)| surface.normal(*u, *v)).collect();
    let few = uv.len() < SETTINGS.min_samples * SETTINGS.min_samples;
    let mut worst = 0.0_f64;
    nodes.each_listed_cell(|corners| {
        let places: Vec<DVec2> = corners.iter().map(|c| uv[*c].into()).collect();
        let middle = places.iter().sum::<DVec2>() / places.len() as f64;
        // Seen from inside the cell: along a crease there are two normals.
        let on_crease = |at: DVec2| surface.normal_on_crease(at, middle);
        let mut own: Vec<DVec3> = corners.iter().zip(&places).map(|(c, at)| on_crease(*at).unwrap_or(normals[*c])).collect();
        if few {
            // The middles of sides and diagonals.
            for (k, a) in places.iter().enumerate() {
                let middles = places[k + 1..].iter().map(|b| a.midpoint(*b));
                own.extend(middles.map(|at| on_crease(at).unwrap_or_else(|| surface.normal(at.x, at.y))));
            }
        }
        worst = worst.max(widest_angle(&own));
    });
    worst
}
