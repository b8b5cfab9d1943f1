//! Named sets: one per surface, then the requested ones.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::job;
use crate::mesh::border::beside;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::data::mesh::{Group, Mesh};
use crate::mesh::request::fault::MeshFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::plan::{GroupRequest, Target};
use crate::model::{PatchId, SurfaceId};

/// Where the elements of a face are in the mesh: its patch and surface, triangles, quads.
pub type FaceElements = ((PatchId, SurfaceId), std::ops::Range<u32>, std::ops::Range<u32>);
/// Where the elements of all faces are.
pub type Ranges = Vec<FaceElements>;

/// A part of a mesh: its layout, the nodes on it, and the number of its first node in the mesh.
pub struct PartNodes<'a> {
    /// Segments.
    pub layout: &'a Layout,
    /// Nodes on them.
    pub nodes: &'a Nodes,
    /// First node.
    pub offset: u32,
}

/// Ascending, each once.
fn sorted(mut list: Vec<u32>) -> Vec<u32> {
    list.sort_unstable();
    list.dedup();
    list
}

/// What the set of each surface is called: pieces of one surface like that one, any others apart, with their number behind
/// a name that several have (one expression may make many) and behind `surface` where they have none.
pub fn names(input: &Input) -> BTreeMap<SurfaceId, String> {
    let surface = |id: SurfaceId| &input.model.surfaces[id.index()];
    let kin = |a: SurfaceId, b: SurfaceId| {
        let of = |id: SurfaceId| surface(id).surface.part_of().iter().chain(std::iter::once(&surface(id).surface));
        of(a).any(|x| of(b).any(|y| x.is(y)))
    };
    let used: BTreeSet<&str> = input.plan.surfaces.iter().map(|(id, _)| surface(*id).name.as_str()).collect();
    let mut found: BTreeMap<SurfaceId, String> = BTreeMap::new();
    let mut alike: BTreeMap<&str, Vec<SurfaceId>> = BTreeMap::new();
    for (id, _) in &input.plan.surfaces {
        if found.contains_key(id) {
            continue;
        }
        let own = surface(*id).name.as_str();
        let known = alike.entry(own).or_default();
        let name = match known.iter().find(|other| !own.is_empty() && kin(**other, *id)) {
            Some(other) => found[other].clone(),
            None if known.is_empty() && !own.is_empty() => own.to_owned(),
            None => {
                let base = if own.is_empty() { "surface" } else { own };
                let numbers = known.len()..;
                let mut free = numbers.map(|n| format!("{base}[{n}]")).filter(|name| !used.contains(name.as_str()));
                free.next().unwrap_or_default()
            }
        };
        known.push(*id);
        found.insert(*id, name);
    }
    found
}

/// The set of one surface.
pub fn of_surface(mesh: &Mesh, ranges: &Ranges, surface: SurfaceId, name: &str) -> Group {
    of_faces(mesh, ranges, name, &Target::Surface(surface))
}

/// The set of the faces of a target.
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
    for &t in job::looking(&group.triangles) {
        mark(&mesh.triangles[t as usize]);
        if let Some(mids) = mesh.triangle_mids.get(t as usize) {
            mark(mids);
        }
    }
    for &q in job::looking(&group.quads) {
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

/// The set of a `group`: its surfaces, the nodes along its curves and edges with their line elements, its points.
///
/// Fails with E672 where a curve ends inside a segment of a border, where no node is: its set would hold a part of it.
pub fn of_request(input: &Input, parts: &[PartNodes], mesh: &Mesh, ranges: &Ranges, request: &GroupRequest) -> Result<Group> {
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
            Target::Chain(_) | Target::Edge(_) => {
                let mut steps: Vec<(u32, u32)> = Vec::new();
                for PartNodes { layout, nodes: of, offset } in parts {
                    let on = layout.on(input, member);
                    if let Target::Chain(chain) = member
                        && let Some(at) = beside::cut_short(input, layout, chain, &on)
                    {
                        return Err(
                            MeshFault::SetInPart { group: request.origin, mesh: input.plan.origin, curve: chain.origin(), at }.into()
                        );
                    }
                    for segment in on {
                        let along = of.of_segment(layout, segment, false);
                        steps.extend(along.windows(2).map(|w| (w[0].min(w[1]) + offset, w[0].max(w[1]) + offset)));
                        nodes.extend(along.iter().map(|n| n + offset));
                    }
                }
                steps.sort_unstable();
                let is_step = |line: &[u32; 2]| steps.binary_search(&(line[0].min(line[1]), line[0].max(line[1]))).is_ok();
                group.lines.extend(mesh.lines.iter().enumerate().filter(|(_, line)| is_step(line)).map(|(k, _)| k as u32));
                nodes.extend(mids_of(mesh, &steps));
            }
            Target::Point(point) => nodes.extend(at_point(input, mesh, *point)),
        }
    }
    (group.lines, group.triangles, group.quads) = (sorted(group.lines), sorted(group.triangles), sorted(group.quads));
    group.nodes = sorted(nodes);
    Ok(group)
}

/// Mid nodes of some edges of elements, which are given by their corners, the lower one first, ascending.
fn mids_of(mesh: &Mesh, steps: &[(u32, u32)]) -> Vec<u32> {
    let mut found = Vec::new();
    let mut collect = |corners: &[u32], mids: &[u32]| {
        for (k, mid) in mids.iter().enumerate() {
            let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
            if steps.binary_search(&(a.min(b), a.max(b))).is_ok() {
                found.push(*mid);
            }
        }
    };
    job::looking(mesh.triangles.iter().zip(&mesh.triangle_mids)).for_each(|(corners, mids)| collect(corners, mids));
    job::looking(mesh.quads.iter().zip(&mesh.quad_mids)).for_each(|(corners, mids)| collect(corners, mids));
    mesh.lines.iter().zip(&mesh.line_mids).for_each(|(corners, mid)| collect(corners, &[*mid]));
    found
}

/// Nodes at a point.
fn at_point(input: &Input, mesh: &Mesh, point: DVec3) -> Vec<u32> {
    let at = |(_, p): &(usize, &DVec3)| input.tolerance.same_point(**p, point);
    mesh.nodes.iter().enumerate().filter(at).map(|(n, _)| n as u32).collect()
}
