//! Mid nodes of order 2: on the curve for borders, on the surface for all other edges, each edge once.

use glam::DVec3;

use crate::base::{job, par};
use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::{FaceMesh, element_ranges};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::input::Input;
use crate::surface::{Surface, foot_within};

/// Mid nodes by edge: for each lower node a short list of higher nodes.
struct Table {
    head: Vec<u32>,
    entries: Vec<(u32, u32, u32)>,
}

const NONE: u32 = u32::MAX;

impl Table {
    fn new(nodes: usize) -> Self {
        Self { head: vec![NONE; nodes], entries: Vec::new() }
    }

    /// The mid node of an edge, made by `make` when there is none yet.
    fn mid(&mut self, a: u32, b: u32, make: impl FnOnce() -> u32) -> u32 {
        let (low, high) = (a.min(b), a.max(b));
        let mut at = self.head[low as usize];
        while at != NONE {
            let (other, mid, next) = self.entries[at as usize];
            if other == high {
                return mid;
            }
            at = next;
        }
        let mid = make();
        self.entries.push((high, mid, self.head[low as usize]));
        self.head[low as usize] = (self.entries.len() - 1) as u32;
        mid
    }
}

/// Adds mid nodes to a finished mesh of corner nodes.
pub fn add(input: &Input, layout: &Layout, nodes: &Nodes, prepared: &[FaceMesh], mesh: &mut Mesh) {
    let corners = mesh.nodes.len() as u32;
    let mut table = Table::new(corners as usize);
    let mut next = corners;
    for segment in 0..layout.pieces.segments.len() {
        let (of, at) = (nodes.of_segment(layout, segment, false), nodes.fractions(segment, false));
        for (w, f) in of.windows(2).zip(at.windows(2)) {
            table.mid(w[0], w[1], || {
                mesh.nodes.push(layout.point(segment, 0.5 * (f[0] + f[1])));
                next += 1;
                next - 1
            });
        }
    }
    for (face_mesh, (triangles, quads)) in prepared.iter().zip(element_ranges(prepared)) {
        let surface = &input.model.surfaces[face_mesh.surface.index()].surface;
        let places = Places(&face_mesh.geometry.nodes);
        let mut new: Vec<InnerEdge> = Vec::new();
        let free = matches!(face_mesh.geometry.nodes, FaceNodes::Free(..));
        let corner = &mesh.nodes;
        let mut mid = |a: u32, b: u32, uv: &dyn Fn(u32, u32) -> (f64, f64)| {
            table.mid(a, b, || {
                let ends = free.then(|| ([a, b].map(|n| corner[n as usize]), [uv(a, a), uv(b, b)]));
                new.push(InnerEdge { uv: uv(a, b), ends });
                next += 1;
                next - 1
            })
        };
        // Elements of a face come in the order of its cells.
        places.each(
            face_mesh,
            &mesh.triangles[triangles],
            |corners, uv, is_quad| {
                job::poll();
                let n = corners.len();
                let mids: Vec<u32> = (0..n).map(|k| mid(corners[k], corners[(k + 1) % n], uv)).collect();
                if is_quad {
                    mesh.quad_mids.push([mids[0], mids[1], mids[2], mids[3]]);
                } else {
                    mesh.triangle_mids.push([mids[0], mids[1], mids[2]]);
                }
            },
            &mesh.quads[quads],
        );
        let points: Vec<DVec3> = par::map(new.len(), |k| middle_of(surface, &new[k]));
        mesh.nodes.extend(points);
    }
    mesh.line_mids = mesh.lines.iter().map(|l| table.mid(l[0], l[1], || l[0])).collect();
}

/// An edge inside a face.
struct InnerEdge {
    /// The middle of its ends in (u, v).
    uv: (f64, f64),
    /// Of free faces its ends, and their places.
    ends: Option<Ends>,
}

/// Two points and their places.
type Ends = ([DVec3; 2], [(f64, f64); 2]);

/// Largest distance of a mid node from the middle of its edge, over the length of the edge; beyond it the foot in space is taken.
const MAX_MIDDLE_DISTANCE: f64 = 0.15;

/// The mid node of an edge: on the surface in the middle of (u, v). Where that is far from the edge, as beside a pole of a free face, the
/// foot of the middle in space.
fn middle_of(surface: &Surface, edge: &InnerEdge) -> DVec3 {
    let plain = surface.point(edge.uv.0, edge.uv.1);
    let Some(([a, b], places)) = edge.ends else { return plain };
    let middle = 0.5 * (a + b);
    if plain.distance(middle) <= MAX_MIDDLE_DISTANCE * a.distance(b) {
        return plain;
    }
    let range = |closed: bool| if closed { (f64::NEG_INFINITY, f64::INFINITY) } else { (0.0, 1.0) };
    let (u, v) = surface.closed();
    let feet = [edge.uv, places[0], places[1]].map(|from| foot_within(surface.evaluator(), middle, from, range(u), range(v)));
    let best = feet.into_iter().fold((f64::INFINITY, edge.uv), |best, foot| if foot.0 < best.0 { foot } else { best });
    surface.point(best.1.0, best.1.1)
}

/// (u, v) of the corners of elements, cell by cell.
struct Places<'a>(&'a FaceNodes);

/// (u, v) in the middle of the edge between two nodes of a cell.
type Middle<'a> = &'a dyn Fn(u32, u32) -> (f64, f64);

impl Places<'_> {
    /// Visits the elements of a face in the order of the mesh: corner nodes, and where the middles of their edges lie.
    fn each(&self, face_mesh: &FaceMesh, triangles: &[[u32; 3]], mut visit: impl FnMut(&[u32], Middle, bool), quads: &[[u32; 4]]) {
        let (mut t, mut q) = (triangles.iter(), quads.iter());
        if let FaceNodes::Grid(grid, frame) = self.0 {
            let (nu, nv) = grid.size();
            for j in 0..nv {
                for i in 0..nu {
                    let at = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                    let of = at.map(|(i, j)| frame.node(i, j));
                    let uv = at.map(|(i, j)| grid.uv(i, j));
                    let middle = |a: u32, b: u32| cell_middle(&of, &uv, a, b);
                    let pole = (0..4).any(|k| of[k] == of[(k + 1) % 4]);
                    let count = if face_mesh.quads > 0 || pole { 1 } else { 2 };
                    for _ in 0..count {
                        if face_mesh.quads > 0 && !pole || face_mesh.triangles == 0 {
                            if let Some(corners) = q.next() {
                                visit(corners, &middle, true);
                            }
                        } else if let Some(corners) = t.next() {
                            visit(corners, &middle, false);
                        }
                    }
                }
            }
            return;
        }
        let (uv, ids) = (self.0.listed_uv(), self.0.listed_ids());
        self.0.each_listed_cell(|cell| {
            let middle = |a: u32, b: u32| {
                let of = |id: u32| cell.iter().find(|n| ids[**n] == id).map_or((0.0, 0.0), |n| uv[*n]);
                mean(of(a), of(b))
            };
            if cell.len() == 4 {
                if let Some(corners) = q.next() {
                    visit(corners, &middle, true);
                }
            } else if let Some(corners) = t.next() {
                visit(corners, &middle, false);
            }
        });
    }
}

fn mean(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1))
}

/// The middle of an edge of a cell; from a pole straight along the line that ends there.
fn cell_middle(of: &[u32; 4], uv: &[(f64, f64); 4], a: u32, b: u32) -> (f64, f64) {
    let places = |id: u32| (0..4).filter(move |k| of[*k] == id);
    // A pole is two corners of its cell: the one next to the other node counts.
    let pairs = places(a).flat_map(|x| places(b).map(move |y| (x, y)));
    let near = pairs.min_by_key(|(x, y)| usize::from((x + 1) % 4 != *y && (y + 1) % 4 != *x));
    near.map_or((0.0, 0.0), |(x, y)| mean(uv[x], uv[y]))
}
