//! From a plan to a mesh: the entry points for the floors above.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::digest::{Digest, StableHasher};
use crate::base::fault::{Fault, Result};
use crate::base::job::Job;
use crate::base::limits::WORK_OF_A_SURFACE;
use crate::base::origin::Origin;
use crate::base::work::{self, Budget, Exceeded};
use crate::mesh::border::layout::Layout;
use crate::mesh::cache::key;
use crate::mesh::cache::reuse::{CacheView, Reuse};
use crate::mesh::data::mesh::Group;
use crate::mesh::output::sets;
use crate::mesh::pipeline::assemble::{MeshPart, assemble};
use crate::mesh::report::built::Built;
use crate::mesh::request::input::Input;
use crate::mesh::request::work::{too_many, too_much_work, work_on};
use crate::mesh::size::remark::Remark;
use crate::mesh::verify::contact_bodies::{self, MeshBody};
use crate::mesh::verify::contacts;
use crate::model::{Model, PatchId, SurfaceId};
use crate::surface::{Domain, Surface};

/// Number of samples along each direction of a patch for the box of what is meshed.
const SAMPLES: usize = 9;
/// Size over the diagonal of that box when no size is given.
const DEFAULT_SIZE_SHARE: f64 = 0.05;

/// Makes the mesh. Warnings and notes go to `sink`.
///
/// Fails as [`MeshLayouts::new`] and [`MeshLayouts::build`] do.
pub fn build(input: &Input, job: &Job, sink: &mut Vec<Fault>) -> Result<Built> {
    let built = MeshLayouts::new(input)?.build(input, None, job)?;
    sink.extend(built.remarks.iter().map(|remark| remark.fault(input)));
    Ok(built)
}

/// The layouts of a mesh before any segment is divided. Their key identifies the mesh.
pub struct MeshLayouts {
    /// The model with nets in parameters in which they run evenly, where some do not.
    evened: Option<Model>,
    layouts: Vec<Layout>,
    size: f64,
    surfaces: BTreeMap<SurfaceId, Digest>,
}

impl MeshLayouts {
    /// Lays out the faces, curves and points of a plan.
    ///
    /// Fails with E230 for methods of a later version.
    pub fn new(input: &Input) -> Result<Self> {
        let evened = input.model.evened(input.plan.surfaces.iter().map(|surface| surface.0));
        let input = &within(input, &evened);
        let patches: Vec<(PatchId, bool)> =
            input.plan.surfaces.iter().flat_map(|(s, flipped)| input.model.patches_of(*s).map(move |p| (p, *flipped))).collect();
        let size = input.plan.settings.size.map_or_else(|| default_size(input, &patches), |s| s.0);
        let layouts = if input.plan.settings.conforming() {
            // What is of no body, with the curves and points, then each body.
            let of = |p: &PatchId| input.plan.bodies.get(&input.model.patches[p.index()].surface).copied();
            let all: BTreeSet<Option<usize>> = input.plan.bodies.values().copied().map(Some).chain([None]).collect();
            let lot = |body| patches.iter().copied().filter(|(p, _)| of(p) == body).collect::<Vec<_>>();
            all.into_iter().map(|body| Layout::new(input, &lot(body), body.is_none())).collect()
        } else {
            // Each face by itself, then the curves and points.
            let lines = std::iter::once_with(|| Layout::new(input, &[], true));
            patches.iter().map(|p| Layout::new(input, &[*p], false)).chain(lines).collect()
        };
        let surfaces = &input.model.surfaces;
        let digest = |s: SurfaceId| StableHasher::new("surface").with(&surfaces[s.index()].surface).finish();
        let surfaces = input.plan.surfaces.iter().map(|(s, _)| (*s, digest(*s))).collect();
        Ok(Self { evened, layouts, size, surfaces })
    }

    /// A digest of all that the mesh depends on, of its content alone: in every run and on every machine the same mesh has
    /// the same key. Where things stand in a script, and what the mesh does not touch, is no part of it.
    pub fn key(&self, input: &Input) -> Digest {
        key::of(&within(input, &self.evened), &self.layouts, self.size, &self.surfaces)
    }

    /// The surfaces of the plan on which the faces of the mesh lie, in its order.
    pub fn surfaces<'a>(&'a self, input: &Input<'a>) -> Vec<&'a Surface> {
        let surfaces = &within(input, &self.evened).model.surfaces;
        input.plan.surfaces.iter().map(|(id, _)| &surfaces[id.index()].surface).collect()
    }

    /// Makes the mesh, with parts of others in `reuse` and its own left there.
    ///
    /// Fails with E702, E703 (counts), E704 (only quads is impossible), E705 or E230 (a face that cannot be mapped),
    /// E217 (too many elements), E715 (turned elements), E666 (faces to be joined that cover each other), E672 (a set in part).
    pub fn build(self, input: &Input, reuse: Option<&Reuse>, job: &Job) -> Result<Built> {
        self.measured(input, reuse, job).0
    }

    /// The same, with the work that it took, without that of its free faces; the budget where it took more.
    pub fn measured(mut self, input: &Input, reuse: Option<&Reuse>, job: &Job) -> (Result<Built>, u64) {
        let evened = self.evened.take();
        let input = &within(input, &evened);
        let surfaces = &input.plan.surfaces;
        let most = work_on(surfaces.iter().map(|(s, _)| &input.model.surfaces[s.index()].surface));
        // The borders of each face are examined before any element is made.
        let most = most.saturating_add(surfaces.len() as u64 * WORK_OF_A_SURFACE);
        let within = Budget::new(most).within(|| work::measured(|| self.built(input, reuse, job)));
        within.unwrap_or_else(|Exceeded| (Err(too_much_work(input, Origin::NONE)), most))
    }

    fn built(self, input: &Input, reuse: Option<&Reuse>, job: &Job) -> Result<Built> {
        let cache = reuse.map(|reuse| CacheView { reuse, surfaces: &self.surfaces });
        let (mut parts, mut elements): (Vec<MeshPart>, u64) = (Vec::new(), 0);
        for layout in self.layouts {
            parts.push(assemble(input, layout, self.size, cache.as_ref(), job)?);
            elements += parts.last().map_or(0, |part| (part.mesh.triangles.len() + part.mesh.quads.len()) as u64);
            if elements > input.plan.most_elements {
                return Err(too_many(input.plan, input.plan.size_origin(), None));
            }
        }
        let mut remarks = Vec::new();
        if let Some((first, others)) = parts.split_first_mut() {
            others.iter().for_each(|part| first.sizing.join(&part.sizing));
            remarks = first.sizing.remarks();
            remarks.extend(first.layout.lost.iter().chain(others.iter().flat_map(|part| &part.layout.lost)).copied().map(Remark::Lost));
            remarks.extend(
                first.layout.loose.iter().chain(others.iter().filter_map(|part| part.layout.loose.as_ref())).copied().map(Remark::Loose),
            );
            let mut leaves = Vec::with_capacity(parts.len());
            // Faces without shared nodes, where the plan says so, touch on purpose.
            for part in parts.iter().filter(|_| input.plan.settings.conforming()) {
                let (touches, own) = contacts::find(input, &part.layout, &part.nodes, &part.mesh);
                contacts::refuse_overlaps(input, &touches)?;
                leaves.push(own);
                remarks.extend(touches.into_iter().map(Remark::Touch));
            }
            // Bodies share no nodes and may touch; none overlaps another one.
            if input.plan.settings.conforming() {
                let bodies: Vec<MeshBody> = parts.iter().map(|part| MeshBody { layout: &part.layout, mesh: &part.mesh }).collect();
                remarks.extend(contact_bodies::find(input, &bodies, leaves).into_iter().map(Remark::Touch));
            }
        }
        let built = Built { remarks, ..merge(input, parts)? };
        debug_assert_eq!(built.mesh.check(), Ok(()));
        Ok(built)
    }
}

/// The same on another model, where there is one.
fn within<'a>(input: &Input<'a>, evened: &'a Option<Model>) -> Input<'a> {
    Input { model: evened.as_ref().unwrap_or(input.model), ..*input }
}

/// Parts one after the other as one mesh, with its named sets.
///
/// Fails with E672 for a set that would hold a part of what it is of.
fn merge(input: &Input, mut parts: Vec<MeshPart>) -> Result<Built> {
    let mut built = Built::default();
    let mut ranges: sets::Ranges = Vec::new();
    let mut offsets = Vec::new();
    let names = sets::names(input);
    for part in &mut parts {
        let mut mesh = std::mem::take(&mut part.mesh);
        for (face, ((_, surface), ..)) in mesh.faces.iter_mut().zip(&part.ranges) {
            face.name = names.get(surface).cloned().unwrap_or_default();
        }
        let (t, q) = (built.mesh.triangles.len() as u32, built.mesh.quads.len() as u32);
        offsets.push(built.mesh.corner_count() as u32);
        ranges.extend(part.ranges.iter().map(|(s, a, b)| (*s, a.start + t..a.end + t, b.start + q..b.end + q)));
        built.explanation.append(&mut part.explanation);
        built.mesh.append(mesh);
    }
    (built.mesh.name, built.mesh.order) = (input.plan.name.clone(), input.plan.settings.order());
    let named: Vec<sets::PartNodes> =
        parts.iter().zip(offsets).map(|(p, offset)| sets::PartNodes { layout: &p.layout, nodes: &p.nodes, offset }).collect();
    let mut groups = Vec::new();
    let mut done: BTreeSet<SurfaceId> = BTreeSet::new();
    for (surface, _) in &input.plan.surfaces {
        if done.insert(*surface) {
            groups.push(sets::of_surface(&built.mesh, &ranges, *surface, &names[surface]));
        }
    }
    for request in &input.plan.groups {
        groups.push(sets::of_request(input, &named, &built.mesh, &ranges, request)?);
    }
    built.mesh.groups = together(groups);
    Ok(built)
}

/// Sets of one name as one: pieces of a surface, whose elements are all of it.
fn together(groups: Vec<Group>) -> Vec<Group> {
    let mut out: Vec<Group> = Vec::with_capacity(groups.len());
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for group in groups {
        let Some(place) = places.get(&group.name) else {
            places.insert(group.name.clone(), out.len());
            out.push(group);
            continue;
        };
        let whole = &mut out[*place];
        let parts = [
            (&mut whole.nodes, group.nodes),
            (&mut whole.lines, group.lines),
            (&mut whole.triangles, group.triangles),
            (&mut whole.quads, group.quads),
        ];
        for (all, own) in parts {
            all.extend(own);
            all.sort_unstable();
            all.dedup();
        }
    }
    out
}

/// A twentieth of the diagonal of what is meshed.
fn default_size(input: &Input, patches: &[(PatchId, bool)]) -> f64 {
    let mut around = Box3::of(input.plan.points.iter().copied());
    for (_, chain) in &input.plan.curves {
        around = around.union(Box3::of((0..=SAMPLES * SAMPLES).map(|k| chain.point(k as f64 / (SAMPLES * SAMPLES) as f64))));
    }
    for (patch, _) in patches {
        let record = &input.model.patches[patch.index()];
        let surface = &input.model.surfaces[record.surface.index()].surface;
        let at = |(low, high): (f64, f64), k: usize| low + (high - low) * k as f64 / (SAMPLES - 1) as f64;
        let mut points = vec![DVec3::ZERO; SAMPLES * SAMPLES];
        if surface.domain() == Domain::Loop {
            around = around.union(crate::surface::bbox(surface));
            continue;
        }
        if surface.domain() == Domain::Square {
            let us: Vec<f64> = (0..SAMPLES).map(|k| at(record.u, k)).collect();
            let vs: Vec<f64> = (0..SAMPLES).map(|k| at(record.v, k)).collect();
            surface.grid(&us, &vs, &mut points);
        } else {
            for (k, p) in points.iter_mut().enumerate() {
                let (i, j) = (k % SAMPLES, k / SAMPLES);
                let v = at((0.0, 1.0), j);
                *p = surface.point((1.0 - v) * at((0.0, 1.0), i), v);
            }
        }
        around = around.union(Box3::of(points));
    }
    let diagonal = around.diagonal();
    // Methods with as few elements as possible take the size from the chord error alone.
    let share =
        if input.plan.settings.method().is_coarse() && input.plan.settings.chord_error.is_some() { 1.0 } else { DEFAULT_SIZE_SHARE };
    if diagonal > 0.0 { share * diagonal } else { 1.0 }
}
