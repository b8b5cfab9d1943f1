//! Counts, nodes and elements of a set of faces that share their borders.

use crate::mesh::border::layout::closes;
use crate::mesh::cache::reuse::{recall_face, recall_steps};
use crate::mesh::chart::face_input::empty;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::divide::too_large::refuse_counts;
use crate::mesh::face::mapped::refuse_triangles;
use crate::mesh::request::work::too_many;
use crate::mesh::tri::too_large::refuse_large;
use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::digest::Digest;
use crate::base::fault::{Fault, MeshFault, Result};
use crate::base::job::Job;
use crate::base::{par, work};
use crate::mesh::border::inside;
use crate::mesh::border::layout::Uneven;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::border::nodes::Nodes;
use crate::mesh::cache::reuse::{CacheView, Inside, recalled};
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_geometry::FaceGeometries;
use crate::mesh::data::face_mesh;
use crate::mesh::data::face_mesh::{FaceMesh, FaceRanges};
use crate::mesh::data::mesh::{FaceRange, Mesh};
use crate::mesh::divide::relations::Relations;
use crate::mesh::divide::row_demand;
use crate::mesh::divide::row_demand::RowDemand;
use crate::mesh::divide::strips;
use crate::mesh::divide::verdict;
use crate::mesh::divide::verdict::{Finished, Verdict};
use crate::mesh::face::mapped;
use crate::mesh::face::together::Asked;
use crate::mesh::face::twins;
use crate::mesh::face::{foresee, together};
use crate::mesh::output::{lines, second_order};
use crate::mesh::pipeline::free_face;
use crate::mesh::report::explain::Explanation;
use crate::mesh::report::{blame, border_error};
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::size::proximity;
use crate::mesh::size::proximity::Narrow;
use crate::mesh::size::remark::Remark;
use crate::mesh::size::sizing::{MOST, Sizing};
use crate::mesh::size::uneven;
use crate::mesh::verify::{face_check, turned};
use crate::surface::Domain;
use crate::surface::quick::PowerForm;

/// Refinements of whole faces before a limit counts as out of reach.
const ROUNDS: usize = 40;
/// Times borders are divided anew where they come too near to each other.
const MAX_SAMPLES: usize = 24;

/// The mesh of some faces, with what is needed to name its parts.
pub struct Part {
    /// The mesh, without groups.
    pub mesh: Mesh,
    /// Surface and element ranges of its faces.
    pub ranges: crate::mesh::output::sets::Ranges,
    /// How it came about.
    pub explanation: Explanation,
    /// Its segments.
    pub layout: Layout,
    /// Nodes on them.
    pub nodes: Nodes,
    /// Its rules.
    pub sizing: Sizing,
}

/// Surfaces that are made ready once for their borders, faces and bounds, where there are few: each takes many times the room
/// of its net.
const HELD: usize = 64;

/// The surfaces of faces that are surely made freely under limits, ready for many evaluations.
fn held(input: &Input, layout: &Layout, limits: &Limits) -> Vec<PowerForm> {
    if limits.chord.is_none() && limits.angle.is_none() {
        return Vec::new();
    }
    let surface = |face: &Face| &input.model.surfaces[face.surface.index()].surface;
    let free = |face: &&Face| face.method.is_free() || surface(face).domain() == Domain::Loop;
    layout.faces.iter().filter(free).take(HELD).filter_map(|face| surface(face).power_form()).collect()
}

/// Times that the steps of the border of a face that closes on itself are halved for it.
const HALVED: u32 = 6;

/// The same where triangles beside its border lean.
const LEANING: u32 = 3;

/// Divides what is laid out, refines until every limit is kept, and fills. `size` is the target size where no rule says
/// another, model units.
pub fn assemble(input: &Input, mut layout: Layout, size: f64, (known, job): (Option<&CacheView>, &Job)) -> Result<Part> {
    inside::place(input, &mut layout);
    loop {
        match attempt(input, &mut layout, size, (known, job)) {
            Ok(done) => return Ok(finish(input, layout, done)),
            // What was only made freely for better angles has a map.
            Err(_) if keep_maps(&mut layout) => job.go_on()?,
            Err(fault) if halve_leaning(input, &mut layout, &fault) => job.go_on()?,
            Err(fault) => return Err(fault),
        }
    }
}

/// Takes back that faces are made freely because their maps are sharp; whether there were any.
fn keep_maps(layout: &mut Layout) -> bool {
    let mut any = false;
    for face in layout.faces.iter_mut().filter(|face| matches!(face.uneven, Some(Uneven::Sharp(_)))) {
        face.keep_map();
        any = true;
    }
    any
}

/// Halves the steps of the borders of faces made with as few triangles as may be that do not keep a limit: what stands beside a
/// long step of a border leans over the surface, however small it is. Whether there were any.
fn halve_leaning(input: &Input, layout: &mut Layout, fault: &Fault) -> bool {
    let Fault::Mesh(fault) = fault else { return false };
    let MeshFault::NotReached { surface, .. } = &**fault else { return false };
    let of = |face: &Face| input.model.surfaces[face.surface.index()].surface.origin();
    let mut any = false;
    for face in layout.faces.iter_mut().filter(|face| of(face) == *surface) {
        if face.method.is_coarse() && face.halved < LEANING {
            face.halved += 1;
            any = true;
        }
    }
    any
}

/// Divides, refines and fills once.
fn attempt(input: &Input, layout: &mut Layout, size: f64, (known, job): (Option<&CacheView>, &Job)) -> Result<Done> {
    let mut narrow: Vec<Narrow> = Vec::new();
    let limits = Limits::of(input);
    let _held = held(input, layout, &limits);
    let (mut sizing, mut demands, mut relations) = begin(input, layout, size, (known, job))?;
    let (mut last, mut verdicts): (Vec<u32>, Vec<Verdict>) = (Vec::new(), Vec::new());
    let (mut looks, mut before, mut worth) = (MAX_SAMPLES, Vec::new(), 0);
    let mut asked = BTreeMap::new();
    for _ in 0..ROUNDS + MAX_SAMPLES + (2 + HALVED as usize) * layout.faces.len() {
        job.go_on()?;
        let mut unknown = sizing.segments(layout);
        unknown.extend(relations.rows());
        let (counts, strip) = strips::solve(&unknown, &relations.list, (MOST, input.tolerance.point))
            .map_err(|c| relations.fault(input, layout, &sizing, &c))?;
        relations.refuse_odd_borders(input, layout, &sizing, &counts)?;
        // Nothing moved, so only the size is missed, where a written count overrules it.
        let settled = counts == last;
        refuse_counts(input, layout, (&sizing, &relations), (&counts, &mut worth))?;
        let nodes = Nodes::new(layout, &counts[..layout.pieces.segments.len()], |segment, count| sizing.fractions(segment, count));
        let uneven = uneven::find(layout, (&nodes, input.tolerance.point), &sizing);
        if !uneven.is_empty() {
            uneven.into_iter().for_each(|(f, step)| layout.faces[f].uneven = Some(step));
            (sizing, demands, relations) = begin(input, layout, size, (known, job))?;
            narrow.clear();
            (last, before) = (Vec::new(), Vec::new());
            continue;
        }
        let border = nodes.points(layout, &input.plan.points);
        let made = FaceInput { input, layout: &*layout, nodes: &nodes, points: &border, wanted: &sizing.wanted };
        // Shorter steps that leave all counts as they are help no more.
        if looks > 0 && counts != before {
            looks -= 1;
            let found = proximity::find(&made);
            if !found.is_empty() {
                narrow.extend(found);
                sizing = Sizing::new(input, layout, size, (&recall_steps(known), &narrow))?;
                before = counts;
                continue;
            }
        }
        let mut prepared = prepare(&made, &relations, &counts)?;
        let foreseen = foresee::find(&made, &prepared);
        let better = foresee::better_free(&made, &sizing, &foreseen, &prepared);
        if !better.is_empty() {
            for (f, why, elements) in better {
                (layout.faces[f].uneven, layout.faces[f].foreseen_free) = (Some(why), elements);
            }
            (sizing, demands, relations) = begin(input, layout, size, (known, job))?;
            narrow.clear();
            (last, before) = (Vec::new(), Vec::new());
            continue;
        }
        let key = |known: &CacheView| prepared.iter().map(|ready| known.face(ready, &border, input.tolerance.point)).collect();
        let keys: Vec<Digest> = known.map(key).unwrap_or_default();
        let keyed = known.map(|known| (known, keys.as_slice()));
        let mut mesh = fill(input, &border, &prepared, (keyed, false), job)?;
        if !settled {
            let recall = recall_face(keyed, "verdict", |reuse| &reuse.verdicts);
            verdicts = verdict::check(input, &limits, &mesh, &finished(layout, &sizing, &prepared, &demands), &recall);
        }
        if settled || verdicts.iter().all(|v| v.keeps_limits() && v.keeps_size()) {
            turned::refuse_turned(input, &prepared, &mesh, &recall_face(keyed, "turned", |reuse| &reuse.turned))?;
            if layout.faces.iter().any(|f| f.free) {
                free(&made, &mut prepared, (known, job))?;
                mesh = fill(input, &border, &prepared, (keyed, true), job)?;
                let back = foresee::better_mapped(&made, &prepared, &mesh);
                if !back.is_empty() {
                    back.into_iter().for_each(|f| layout.faces[f].keep_map());
                    (sizing, demands, relations) = begin(input, layout, size, (known, job))?;
                    narrow.clear();
                    (last, before) = (Vec::new(), Vec::new());
                    continue;
                }
                if twins::divide(&made, &mut prepared, &mesh) {
                    number(&made, &mut prepared);
                    mesh = fill(input, &border, &prepared, (keyed, true), job)?;
                }
                turned::refuse_concave(input, &prepared, &mesh)?;
            }
            let together = together::part(&made, &prepared, (&mut mesh, &limits));
            if let Some(first) = together.first() {
                match together::ask(layout, &prepared, &together, &mut asked) {
                    Some(Asked::Rows(rows)) => {
                        relations.raise(&rows, &counts);
                        last = Vec::new();
                    }
                    Some(Asked::Anew) => {
                        (sizing, demands, relations) = begin(input, layout, size, (known, job))?;
                        narrow.clear();
                        (last, before) = (Vec::new(), Vec::new());
                    }
                    None => return Err(together::fault(input, layout, &mesh, first)),
                }
                continue;
            }
            let found = face_check::unsound(input, (&*layout, &nodes), &prepared, &mesh);
            let coarse = |f: &usize| {
                let face = &layout.faces[*f];
                closes(face) && face.halved < HALVED && foresee::is_twisted(&prepared[*f], &mesh)
            };
            let twisted = if found.is_none() { (0..prepared.len()).find(coarse) } else { None };
            if let Some((f, defect)) = found
                && (!closes(&layout.faces[f]) || layout.faces[f].halved == HALVED)
            {
                return Err(face_check::fault(input, (&*layout, &nodes, &layout.faces[f]), (&prepared[f], defect), &mesh));
            }
            if let Some(f) = found.map(|(f, _)| f).or(twisted) {
                // Where a face closes on itself, elements from one of its sides to another may be the same ones.
                layout.faces[f].halved += 1;
                (sizing, demands, relations) = begin(input, layout, size, (known, job))?;
                narrow.clear();
                (last, before) = (Vec::new(), Vec::new());
                continue;
            }
            layout.faces.iter_mut().zip(&foreseen).for_each(|(face, found)| face.foreseen = found.map(|found| found.angle));
            let made = FaceInput { input, layout: &*layout, nodes: &nodes, points: &border, wanted: &sizing.wanted };
            let blames = blame::of_faces(&made, (&sizing, &foreseen), &prepared, &mesh);
            let sharp: Vec<Remark> = blames.iter().filter_map(|seen| seen.sharp.clone()).collect();
            sizing.sharp = sharp.into_iter().reduce(Remark::sharper);
            sizing.take(&counts);
            sizing.take_refined(input, &prepared);
            let mut explanation = Explanation::new(input, layout, &sizing, &prepared, (&counts, &strip));
            explanation.lines.iter_mut().zip(blames).for_each(|(line, blame)| line.push_str(&blame.line));
            return Ok(Done { nodes, prepared, sizing, mesh, explanation });
        }
        relations.raise(&verdicts, &counts);
        last = counts;
    }
    Err(relations.out_of_reach(input, layout, &verdicts))
}

/// Sizes of everything, what rows want, and the equations between counts.
fn begin(
    input: &Input,
    layout: &mut Layout,
    size: f64,
    (known, job): (Option<&CacheView>, &Job),
) -> Result<(Sizing, Vec<[RowDemand; 2]>, Relations)> {
    let sizing = Sizing::new(input, layout, size, (&recall_steps(known), &[]))?;
    refuse_large(input, layout, &sizing, job)?;
    let demands = demands(input, layout, &sizing, &Limits::of(input), known);
    let relations = Relations::new(layout, &demands);
    Ok((sizing, demands, relations))
}

/// What the rows of each face want; nothing where all is written and no limit is set.
fn demands(input: &Input, layout: &Layout, sizing: &Sizing, limits: &Limits, known: Option<&CacheView>) -> Vec<[RowDemand; 2]> {
    par::map(layout.faces.len(), |f| {
        let face = &layout.faces[f];
        if face.free {
            return [RowDemand::default(); 2];
        }
        let no_limit = limits.chord.is_none() && limits.angle.is_none();
        if no_limit && written(layout, sizing, f) == [true; 2] {
            return [RowDemand::default(); 2];
        }
        let patch = &input.model.patches[face.patch.index()];
        let key = |known: &CacheView| known.on("demands", face.surface).with(&(patch.u, patch.v, (face.size.0, limits))).finish();
        let surface = &input.model.surfaces[face.surface.index()].surface;
        recalled(known, |reuse| &reuse.demands, key, || row_demand::demands(surface, patch.u, patch.v, face.size.0, limits))
    })
}

/// Directions of a face with a side whose counts are all written out.
fn written(layout: &Layout, sizing: &Sizing, face: usize) -> [bool; 2] {
    let sides = &layout.faces[face].sides;
    if layout.faces[face].free {
        return [true; 2];
    }
    let all = |k: usize| !sides[k].uses.is_empty() && sides[k].uses.iter().all(|u| sizing.decisions[u.segment].count.is_some());
    if sides.len() == 3 { [(0..3).any(all); 2] } else { [all(0) || all(2), all(1) || all(3)] }
}

/// FaceGeometries and ids of all faces; free ones are left empty, since nothing else depends on what is in them.
fn prepare(made: &FaceInput, relations: &Relations, counts: &[u32]) -> Result<Vec<FaceMesh>> {
    let layout = made.layout;
    let mut prepared = par::try_map(layout.faces.len(), |f| {
        if layout.faces[f].free {
            return Ok(empty(made, &layout.faces[f]));
        }
        let rows: Vec<u32> = relations.of_face[f].iter().map(|r| counts[*r]).collect();
        mapped::prepare(made.input, layout, made.nodes, &layout.faces[f], &rows)
    })?;
    refuse_triangles(made.input, layout, &prepared)?;
    number(made, &mut prepared);
    Ok(prepared)
}

/// Free faces that are made before their elements are counted against what a mesh may have.
const AT_A_TIME: usize = 64;

/// Makes the free faces; E217 for more elements than a mesh may have.
fn free(made: &FaceInput, prepared: &mut [FaceMesh], (known, job): (Option<&CacheView>, &Job)) -> Result<()> {
    let faces = &made.layout.faces;
    let which: Vec<usize> = (0..faces.len()).filter(|f| faces[*f].free).collect();
    job.expect(which.len() as u64);
    let mut total: u64 = (0..faces.len()).filter(|f| !faces[*f].free).map(|f| prepared[f].triangles + prepared[f].quads).sum();
    for some in which.chunks(AT_A_TIME) {
        let ready = par::try_map(some.len(), |k| {
            job.go_on()?;
            let ready = free_face::prepare(made, &faces[some[k]], (known, job));
            job.advance(1);
            ready
        })?;
        for (f, ready) in some.iter().zip(ready) {
            total += ready.triangles + ready.quads;
            prepared[*f] = ready;
        }
        if total > made.input.plan.most_elements {
            return Err(too_many(made.input.plan, made.input.plan.size_origin(), None));
        }
    }
    number(made, prepared);
    Ok(())
}

/// Ids of the inner nodes, face by face.
fn number(made: &FaceInput, prepared: &mut [FaceMesh]) {
    let mut first = made.nodes.total;
    for ready in prepared.iter_mut() {
        ready.number(first);
        first += ready.inner as u32;
    }
}

/// One face being filled: its parts of the arrays.
struct Fill<'a> {
    ready: &'a FaceMesh,
    key: Option<(&'a CacheView<'a>, Digest)>,
    again: bool,
    nodes: &'a mut [DVec3],
    triangles: &'a mut [[u32; 3]],
    quads: &'a mut [[u32; 4]],
    result: Result<()>,
}

impl Fill<'_> {
    fn fill(&mut self, input: &Input, border: &[DVec3]) {
        let found = |(known, key): (&CacheView, Digest)| if self.again { known.inside_again(key) } else { known.inside(key) };
        if let Some(inside) = self.key.and_then(found)
            && inside.nodes.len() == self.nodes.len()
        {
            self.nodes.copy_from_slice(&inside.nodes);
            return self.ready.fill(&inside.diagonals, self.triangles, self.quads);
        }
        let surface = &input.model.surfaces[self.ready.surface.index()].surface;
        let (diagonals, work) = work::measured(|| {
            self.ready.points(surface, self.nodes);
            let (first, own) = (self.ready.first, &*self.nodes);
            let node = |id: u32| if id < first { border[id as usize] } else { own[(id - first) as usize] };
            self.ready.diagonals(surface, &node, input.tolerance.point)
        });
        self.ready.fill(&diagonals, self.triangles, self.quads);
        if let Some((known, key)) = self.key {
            known.keep_inside(key, (Inside { nodes: self.nodes.to_vec(), diagonals }, work));
        }
    }
}

/// Keys of the faces before free ones have their insides, and whether the mapped ones were filled under them just now.
type Keyed<'a> = (Option<(&'a CacheView<'a>, &'a [Digest])>, bool);

/// All nodes and elements; faces and rows of large faces on several threads.
fn fill(input: &Input, border: &[DVec3], prepared: &[FaceMesh], (keyed, again): Keyed, job: &Job) -> Result<Mesh> {
    let sum = |f: &dyn Fn(&FaceMesh) -> u64| prepared.iter().map(f).sum::<u64>() as usize;
    let on_border = border.len();
    let mut all = Vec::with_capacity(on_border + sum(&|p| p.inner));
    all.extend_from_slice(border);
    all.resize(on_border + sum(&|p| p.inner), DVec3::ZERO);
    let mut mesh = Mesh { name: input.plan.name.clone(), order: input.plan.order, nodes: all, ..Mesh::default() };
    mesh.triangles = vec![[0; 3]; sum(&|p| p.triangles)];
    mesh.quads = vec![[0; 4]; sum(&|p| p.quads)];
    let (border, mut inner) = mesh.nodes.split_at_mut(on_border);
    let (border, mut triangles, mut quads) = (&*border, mesh.triangles.as_mut_slice(), mesh.quads.as_mut_slice());
    let mut work = Vec::new();
    for (k, ready) in prepared.iter().enumerate() {
        let own;
        (own, inner) = inner.split_at_mut(ready.inner as usize);
        let (t, q);
        (t, triangles) = triangles.split_at_mut(ready.triangles as usize);
        (q, quads) = quads.split_at_mut(ready.quads as usize);
        let free = matches!(ready.geometry.nodes, FaceNodes::Free(..));
        let key = keyed.filter(|_| !free).map(|(known, keys)| (known, keys[k]));
        work.push(Fill { ready, key, again, nodes: own, triangles: t, quads: q, result: Ok(()) });
    }
    job.expect(work.len() as u64);
    par::chunks_mut(&mut work, 1, |_, faces| {
        for face in faces {
            face.result = job.go_on();
            if face.result.is_ok() {
                face.fill(input, border);
                job.advance(1);
            }
        }
    });
    work.into_iter().try_for_each(|face| face.result)?;
    Ok(mesh)
}

fn finished<'a>(layout: &'a Layout, sizing: &Sizing, prepared: &'a [FaceMesh], demands: &'a [[RowDemand; 2]]) -> Vec<Finished<'a>> {
    let one = |(f, (triangles, _)): (usize, FaceRanges)| Finished {
        face: &layout.faces[f],
        ready: &prepared[f],
        triangles,
        demands: &demands[f],
        written: written(layout, sizing, f),
    };
    face_mesh::element_ranges(prepared).into_iter().enumerate().map(one).collect()
}

/// Everything but the layout.
struct Done {
    nodes: Nodes,
    prepared: Vec<FaceMesh>,
    sizing: Sizing,
    mesh: Mesh,
    explanation: Explanation,
}

/// Ranges, line elements and mid nodes.
fn finish(input: &Input, layout: Layout, done: Done) -> Part {
    let Done { nodes, prepared, sizing, mut mesh, explanation } = done;
    let mut ranges = crate::mesh::output::sets::Ranges::new();
    for ((ready, face), own) in prepared.iter().zip(&layout.faces).zip(face_mesh::element_ranges(&prepared)) {
        let [triangles, quads] = [own.0, own.1].map(|range| range.start as u32..range.end as u32);
        let name = input.model.surfaces[ready.surface.index()].name.clone();
        mesh.faces.push(FaceRange { name, triangles: triangles.clone(), quads: quads.clone(), lines: 0..0 });
        ranges.push(((face.patch, ready.surface), triangles, quads));
    }
    lines::add(input, &layout, &nodes, &mut mesh);
    if input.plan.order == 2 {
        second_order::add(input, &layout, &nodes, &prepared, &mut mesh);
    }
    mesh.border_error = border_error::of_free_borders(&layout, &nodes);
    mesh.geometries = FaceGeometries(prepared.into_iter().map(FaceMesh::into_chart).collect());
    Part { mesh, ranges, explanation, layout, nodes, sizing }
}
