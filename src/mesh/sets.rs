//! Named sets: one per surface, then those asked for.

use glam::DVec3;

use super::build::Input;
use super::data::{Group, Mesh};
use super::layout::Layout;
use super::nodes::Nodes;
use super::plan::{GroupRequest, Target};
use crate::model::{PatchId, SurfaceId};

/// Where the elements of a face are in the mesh: its patch and surface, triangles, quads.
pub type FaceElements = ((PatchId, SurfaceId), std::ops::Range<u32>, std::ops::Range<u32>);
/// Where the elements of all faces are.
pub type Ranges = Vec<FaceElements>;

/// Ascending, each once.
fn sorted(mut list: Vec<u32>) -> Vec<u32> {
    list.sort_unstable();
    list.dedup();
    list
}

/// The set of one surface.
pub fn of_surface(input: &Input, mesh: &Mesh, ranges: &Ranges, surface: SurfaceId) -> Group {
    of_faces(mesh, ranges, &input.model.surfaces[surface.index()].name, &Target::Surface(surface))
}

/// The set of the faces that a target speaks of.
fn of_faces(mesh: &Mesh, ranges: &Ranges, name: &str, target: &Target) -> Group {
    let mut group = Group { name: name.to_owned(), ..Group::default() };
    for (_, triangles, quads) in ranges.iter().filter(|r| target.faces(r.0.0, r.0.1).is_some()) {
        group.triangles.extend(triangles.clone());
        group.quads.extend(quads.clone());
    }
    group.nodes = nodes_of(mesh, &group);
    group
}

/// Nodes of the elements of a group, mid nodes included.
fn nodes_of(mesh: &Mesh, group: &Group) -> Vec<u32> {
    let mut seen = vec![false; mesh.nodes.len()];
    let mut mark = |ids: &[u32]| ids.iter().for_each(|n| seen[*n as usize] = true);
    for &t in &group.triangles {
        mark(&mesh.triangles[t as usize]);
        if let Some(mids) = mesh.triangle_mids.get(t as usize) {
            mark(mids);
        }
    }
    for &q in &group.quads {
        mark(&mesh.quads[q as usize]);
        if let Some(mids) = mesh.quad_mids.get(q as usize) {
            mark(mids);
        }
    }
    for &l in &group.lines {
        mark(&mesh.lines[l as usize]);
        if let Some(mid) = mesh.line_mids.get(l as usize) {
            mark(&[*mid]);
        }
    }
    seen.iter().enumerate().filter(|(_, s)| **s).map(|(n, _)| n as u32).collect()
}

/// The set of a `group`: its surfaces, the nodes along its curves with their line elements, its points.
pub fn of_request(input: &Input, parts: &[(&Layout, &Nodes, u32)], mesh: &Mesh, ranges: &Ranges, request: &GroupRequest) -> Group {
    let mut group = Group { name: request.name.clone(), ..Group::default() };
    let mut nodes = Vec::new();
    for member in &request.members {
        match member {
            Target::Surface(_) | Target::Patches(_) => {
                let own = of_faces(mesh, ranges, &request.name, member);
                group.triangles.extend(own.triangles);
                group.quads.extend(own.quads);
                nodes.extend(own.nodes);
            }
            Target::Chain(chain) => {
                for (layout, of, offset) in parts {
                    for u in layout.on(input, chain) {
                        nodes.extend(of.of_stretch(layout, u, false).iter().map(|n| n + offset));
                    }
                }
                let on: Vec<u32> = sorted(nodes.clone());
                for (k, line) in mesh.lines.iter().enumerate() {
                    if line.iter().all(|n| on.binary_search(n).is_ok()) && lies_on(input, chain, mesh, k) {
                        group.lines.push(k as u32);
                        nodes.extend(mesh.line_mids.get(k));
                    }
                }
            }
            Target::Point(point) => nodes.extend(at_point(input, mesh, *point)),
        }
    }
    (group.lines, group.triangles, group.quads) = (sorted(group.lines), sorted(group.triangles), sorted(group.quads));
    group.nodes = sorted(nodes);
    group
}

/// Whether the middle of a line element is on the chain, near enough for its length.
fn lies_on(input: &Input, chain: &crate::network::Chain, mesh: &Mesh, line: usize) -> bool {
    let Ok(curve) = chain.to_curve() else { return false };
    let [a, b] = mesh.lines[line].map(|n| mesh.nodes[n as usize]);
    let on = |p: DVec3, slack: f64| crate::geometry::closest(&curve, p).distance <= slack;
    on(a, input.tolerance.point) && on(b, input.tolerance.point) && on((a + b) * 0.5, 0.5 * a.distance(b))
}

/// Nodes at a point.
fn at_point(input: &Input, mesh: &Mesh, point: DVec3) -> Vec<u32> {
    let at = |(_, p): &(usize, &DVec3)| input.tolerance.same_point(**p, point);
    mesh.nodes.iter().enumerate().filter(at).map(|(n, _)| n as u32).collect()
}
