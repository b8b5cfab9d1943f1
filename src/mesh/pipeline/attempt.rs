//! The mesh of some faces, divided and filled, and divided anew for as long as a retry demands it.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::digest::Digest;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::par;
use crate::mesh::border::layout::{Face, Layout, closes};
use crate::mesh::border::nodes::Nodes;
use crate::mesh::cache::reuse::{CacheView, KeyedFaces, recall_face, recall_steps, recalled};
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_mesh::{self, FaceMesh, FaceRanges};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::divide::relations::Relations;
use crate::mesh::divide::row_demand::{self, RowDemand};
use crate::mesh::divide::strips;
use crate::mesh::divide::too_large::refuse_counts;
use crate::mesh::divide::verdict::{self, Finished, Verdict};
use crate::mesh::face::coincident::{self, Demand};
use crate::mesh::face::{map_quality, twins};
use crate::mesh::pipeline::fill::{Refill, diagonal_rule, fill, free, number, prepare, slide};
use crate::mesh::pipeline::retry::Retry;
use crate::mesh::report::blame;
use crate::mesh::report::explain::Explanation;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::work::allow;
use crate::mesh::size::proximity::{self, Narrow};
use crate::mesh::size::remark::Remark;
use crate::mesh::size::row_spacing;
use crate::mesh::size::sizing::{MOST, Sizing};
use crate::mesh::size::uneven;
use crate::mesh::tri::too_large::refuse_large;
use crate::mesh::verify::{face_check, face_fault, turned};
use crate::surface::{Domain, PreparedSurface};

/// How often a mesh is divided anew.
struct AttemptSettings {
    /// Largest number of refinements of whole faces before a limit counts as out of reach.
    max_refinements: usize,
    /// Largest number of searches for borders that come too near to each other.
    max_border_searches: usize,
    /// Largest number of times that the steps of the border of a face that closes on itself are halved.
    max_halvings: u32,
    /// Largest number of surfaces whose power forms are computed once for borders, faces and bounds: each takes many times the memory of
    /// its net.
    max_power_forms: usize,
}

const ATTEMPT: AttemptSettings = AttemptSettings { max_refinements: 40, max_border_searches: 24, max_halvings: 6, max_power_forms: 64 };

/// The surfaces of faces that are certainly free under limits, made ready once.
fn made_ready(input: &Input, layout: &Layout, limits: &Limits) -> Vec<PreparedSurface> {
    if limits.chord.is_none() && limits.angle.is_none() {
        return Vec::new();
    }
    let surface = |face: &Face| &input.model.surfaces[face.surface.index()].surface;
    let free = |face: &&Face| face.method.is_free() || surface(face).domain() == Domain::Loop;
    layout.faces.iter().filter(free).take(ATTEMPT.max_power_forms).map(|face| surface(face).quick()).collect()
}

/// The finished mesh of some faces, without their layout.
pub(crate) struct FinishedMesh {
    pub nodes: Nodes,
    pub prepared: Vec<FaceMesh>,
    pub sizing: Sizing,
    pub mesh: Mesh,
    pub explanation: Explanation,
}

/// How a round ends.
enum RoundResult {
    /// The mesh keeps all limits.
    Done(Box<FinishedMesh>),
    /// It is divided anew; these were the counts of segments and rows.
    Again(Retry, Vec<u32>),
}

/// Counts of segments and rows, with the nodes on the segments.
struct DividedSegments {
    /// Of segments and rows.
    counts: Vec<u32>,
    /// The strip of each.
    strip: Vec<usize>,
    nodes: Nodes,
    /// The counts are those that were checked last: only a size is missed, where a written count overrules it.
    is_settled: bool,
}

/// The state of a mesh between two rounds.
struct Attempt<'a> {
    input: &'a Input<'a>,
    layout: &'a mut Layout,
    /// Target size where no rule sets another one, model units.
    size: f64,
    cache: Option<&'a CacheView<'a>>,
    job: &'a Job,
    limits: Limits,
    sizing: Sizing,
    demands: Vec<[RowDemand; 2]>,
    relations: Relations,
    /// Counts of the first division of this layout.
    first: Vec<u32>,
    /// Where borders were found too near to each other.
    narrow: Vec<Narrow>,
    /// The counts that were checked against limits last, and how the faces kept them.
    checked: Vec<u32>,
    verdicts: Vec<Verdict>,
    /// Searches for near borders that are left, and the counts at which steps were shortened last.
    searches: usize,
    shortened: Vec<u32>,
    /// How often steps that broke a limit were raised.
    raises: u32,
    /// Work charged for the counts so far.
    charged_work: u64,
    /// Number of demands on each face because it shares nodes with another one.
    demands_on: BTreeMap<usize, u32>,
}

/// Divides, refines and fills.
pub(crate) fn attempt(input: &Input, layout: &mut Layout, size: f64, cache: Option<&CacheView>, job: &Job) -> Result<FinishedMesh> {
    let limits = Limits::of(input);
    let _ready = made_ready(input, layout, &limits);
    let (sizing, demands, relations) = begin(input, layout, size, cache, job)?;
    let mut attempt = Attempt {
        input,
        layout,
        size,
        cache,
        job,
        limits,
        sizing,
        demands,
        relations,
        first: Vec::new(),
        narrow: Vec::new(),
        checked: Vec::new(),
        verdicts: Vec::new(),
        searches: ATTEMPT.max_border_searches,
        shortened: Vec::new(),
        raises: 0,
        charged_work: 0,
        demands_on: BTreeMap::new(),
    };
    for _ in 0..ATTEMPT.max_refinements + ATTEMPT.max_border_searches + (2 + ATTEMPT.max_halvings as usize) * attempt.layout.faces.len() {
        job.go_on()?;
        match attempt.round()? {
            RoundResult::Done(done) => return Ok(*done),
            RoundResult::Again(retry, counts) => attempt.retry(retry, counts)?,
        }
    }
    Err(attempt.relations.out_of_reach(input, attempt.layout, &attempt.verdicts))
}

impl Attempt<'_> {
    /// Counts of all segments and rows, and the strip of each.
    fn counts(&self) -> Result<(Vec<u32>, Vec<usize>)> {
        let (input, layout) = (self.input, &*self.layout);
        let mut unknown = self.sizing.segments(layout);
        unknown.extend(self.relations.rows());
        strips::solve(&unknown, &self.relations.list, MOST, input.tolerance.point)
            .map_err(|conflict| self.relations.fault(input, layout, &self.sizing, &conflict))
    }

    /// The nodes on segments of these counts.
    fn divide(&mut self, counts: Vec<u32>, strip: Vec<usize>) -> Result<DividedSegments> {
        let (input, layout) = (self.input, &*self.layout);
        self.relations.refuse_odd_borders(input, layout, &self.sizing, &counts)?;
        allow(refuse_counts(input, layout, &self.sizing, &self.relations.of_face, &counts)?, &mut self.charged_work);
        let fractions = |segment, count| self.sizing.fractions(segment, count);
        let nodes = Nodes::new(layout, &counts[..layout.pieces.segments.len()], fractions);
        Ok(DividedSegments { is_settled: counts == self.checked, counts, strip, nodes })
    }

    /// Divides and fills once, or up to the first reason for another division.
    fn round(&mut self) -> Result<RoundResult> {
        let (input, cache, job) = (self.input, self.cache, self.job);
        let (counts, strip) = self.counts()?;
        if self.first.is_empty() {
            self.first.clone_from(&counts);
        }
        let crowded = uneven::crowded(input, self.layout, &self.relations.of_face, [&self.first, &counts]);
        if !crowded.is_empty() {
            return Ok(RoundResult::Again(Retry::UnevenBorders(crowded), counts));
        }
        let DividedSegments { counts, strip, mut nodes, is_settled } = self.divide(counts, strip)?;
        if let Some(retry) = self.unfit_borders(&counts, &nodes)? {
            return Ok(RoundResult::Again(retry, counts));
        }
        let mut border = nodes.points(self.layout, &input.plan.points);
        let face_input = self::face_input(input, self.layout, &nodes, &border, &self.sizing);
        // Shorter steps that leave all counts unchanged have no further effect.
        if self.searches > 0 && counts != self.shortened {
            self.searches -= 1;
            let found = proximity::find(&face_input);
            if !found.is_empty() {
                return Ok(RoundResult::Again(Retry::NearBorders(found), counts));
            }
        }
        let mut prepared = prepare(&face_input, &self.relations, &counts)?;
        let predicted = map_quality::find(&face_input, &prepared);
        let better = map_quality::better_free(&face_input, &self.sizing, &predicted, &prepared);
        if !better.is_empty() {
            return Ok(RoundResult::Again(Retry::BetterFree(better), counts));
        }
        let key = |cache: &CacheView| prepared.iter().map(|face_mesh| cache.face(face_mesh, &border, diagonal_rule(input))).collect();
        let keys: Vec<Digest> = cache.map(key).unwrap_or_default();
        let keyed = cache.map(|cache| KeyedFaces { cache, keys: &keys });
        let mut mesh = fill(input, &border, &prepared, keyed, Refill::First, job)?;
        if !is_settled {
            let recall = recall_face(keyed, "verdict", |reuse| &reuse.verdicts);
            let finished = finished(self.layout, &self.sizing, &prepared, &self.demands);
            self.verdicts = verdict::check(input, &self.limits, &mesh, &finished, &recall);
            if !self.verdicts.iter().all(|v| v.keeps_limits() && v.keeps_size()) {
                return Ok(RoundResult::Again(Retry::BrokenLimits, counts));
            }
        }
        turned::refuse_turned(input, &prepared, &mesh, &recall_face(keyed, "turned", |reuse| &reuse.turned))?;
        if self.layout.faces.iter().any(|face| face.free) {
            free(&face_input, &mut prepared, cache, job)?;
            slide(self.layout, &mut nodes, &mut border, &prepared);
            let face_input = self::face_input(input, self.layout, &nodes, &border, &self.sizing);
            mesh = fill(input, &border, &prepared, keyed, Refill::Again, job)?;
            let back = map_quality::better_mapped(&face_input, &prepared, &mesh);
            if !back.is_empty() {
                return Ok(RoundResult::Again(Retry::BetterMapped(back), counts));
            }
            if twins::divide(&face_input, &mut prepared, &mesh) {
                number(&face_input, &mut prepared);
                mesh = fill(input, &border, &prepared, keyed, Refill::Again, job)?;
            }
            turned::refuse_concave(input, &prepared, &mesh)?;
        }
        let face_input = self::face_input(input, self.layout, &nodes, &border, &self.sizing);
        let coincidences = coincident::resolve(&face_input, &prepared, &mut mesh, &self.limits);
        if let Some(first) = coincidences.first() {
            return match coincident::demand(self.layout, &prepared, &coincidences, &mut self.demands_on) {
                Some(demand) => Ok(RoundResult::Again(Retry::Coincident(demand), counts)),
                None => Err(coincident::fault(input, self.layout, &mesh, first)),
            };
        }
        if let Some(face) = self.closing_on_itself(&face_input, &prepared, &mesh)? {
            return Ok(RoundResult::Again(Retry::ClosesOnItself(face), counts));
        }
        face_mesh::measure_quality(&mut prepared, &mesh);
        let blames = blame::of_faces(&face_input, &self.sizing, &predicted, &prepared, &mesh);
        self.layout.faces.iter_mut().zip(&predicted).for_each(|(face, found)| face.foreseen = found.map(|found| found.angle));
        let mut sizing = std::mem::take(&mut self.sizing);
        sizing.sharp = blames.iter().filter_map(|seen| seen.sharp.clone()).reduce(Remark::sharper);
        sizing.mark_used(&counts);
        sizing.effects.mark_inside(input, &prepared);
        let mut explanation = Explanation::new(input, self.layout, &sizing, &prepared, &counts, &strip);
        explanation.lines.iter_mut().zip(blames).for_each(|(line, blame)| line.push_str(&blame.line));
        Ok(RoundResult::Done(Box::new(FinishedMesh { nodes, prepared, sizing, mesh, explanation })))
    }

    /// Why borders divided like this are divided anew.
    fn unfit_borders(&self, counts: &[u32], nodes: &Nodes) -> Result<Option<Retry>> {
        let broken = self.sizing.broken(self.input, self.layout, counts)?;
        if !broken.is_empty() {
            return Ok(Some(Retry::BrokenSteps(broken)));
        }
        let unfit = row_spacing::unfit(self.layout, nodes, &self.sizing.rows, &self.relations.of_face, counts);
        if !unfit.is_empty() {
            return Ok(Some(Retry::UnfitRows(unfit)));
        }
        let uneven = uneven::find(self.layout, nodes, self.input.tolerance.point, &self.sizing);
        Ok((!uneven.is_empty()).then_some(Retry::UnevenBorders(uneven)))
    }

    /// A face that closes on itself and has to have shorter steps for it; fails for what is wrong with a face otherwise.
    fn closing_on_itself(&self, face_input: &FaceInput, prepared: &[FaceMesh], mesh: &Mesh) -> Result<Option<usize>> {
        let layout = face_input.layout;
        let found = face_check::unsound(face_input, prepared, mesh);
        let coarse = |f: &usize| {
            let face = &layout.faces[*f];
            closes(face) && face.halved < ATTEMPT.max_halvings && map_quality::is_twisted(&prepared[*f], mesh)
        };
        let Some((f, defect)) = found else { return Ok((0..prepared.len()).find(coarse)) };
        if !closes(&layout.faces[f]) || layout.faces[f].halved == ATTEMPT.max_halvings {
            return Err(face_fault::fault(face_input, &layout.faces[f], &prepared[f], defect, mesh));
        }
        Ok(Some(f))
    }

    /// Changes what the next division follows from; `counts` are those of the last one.
    fn retry(&mut self, retry: Retry, counts: Vec<u32>) -> Result<()> {
        match retry {
            Retry::NearBorders(found) => {
                self.narrow.extend(found);
                self.sizing = Sizing::new(self.input, self.layout, self.size, &recall_steps(self.cache), &self.narrow)?;
                self.shortened = counts;
                return Ok(());
            }
            Retry::BrokenSteps(mut raised) => {
                // The segments of a strip have one count: each time more is demanded, or they might take turns in breaking a limit.
                raised.iter_mut().for_each(|(_, least)| *least += *least / 32 * self.raises);
                self.raises += 1;
                return self.sizing.raise(self.input, self.layout, &raised);
            }
            Retry::BrokenLimits => {
                self.relations.raise(&self.verdicts, &counts);
                self.checked = counts;
                return Ok(());
            }
            Retry::Coincident(Demand::Rows(rows)) => {
                self.relations.raise(&rows, &counts);
                self.checked = Vec::new();
                return Ok(());
            }
            // The layout has changed already.
            Retry::Coincident(Demand::NewLayout) => {}
            Retry::UnevenBorders(faces) => faces.into_iter().for_each(|(f, why)| self.layout.faces[f].uneven = Some(why)),
            Retry::BetterFree(faces) => {
                for (f, why, elements) in faces {
                    (self.layout.faces[f].uneven, self.layout.faces[f].foreseen_free) = (Some(why), elements);
                }
            }
            Retry::BetterMapped(faces) => faces.into_iter().for_each(|f| self.layout.faces[f].keep_map()),
            Retry::UnfitRows(faces) => faces.into_iter().for_each(|f| self.layout.faces[f].even_rows = true),
            Retry::ClosesOnItself(f) => self.layout.faces[f].halved += 1,
        }
        (self.sizing, self.demands, self.relations) = begin(self.input, self.layout, self.size, self.cache, self.job)?;
        self.narrow.clear();
        (self.first, self.checked, self.shortened) = (Vec::new(), Vec::new(), Vec::new());
        Ok(())
    }
}

/// What faces are made from, with these nodes on their borders.
fn face_input<'a>(input: &'a Input, layout: &'a Layout, nodes: &'a Nodes, points: &'a [DVec3], sizing: &'a Sizing) -> FaceInput<'a> {
    FaceInput { input, layout, nodes, points, wanted: &sizing.wanted, sliding: sizing.sliding.each() }
}

/// Sizes of all segments, demands of rows, and the equations between counts.
fn begin(
    input: &Input,
    layout: &mut Layout,
    size: f64,
    cache: Option<&CacheView>,
    job: &Job,
) -> Result<(Sizing, Vec<[RowDemand; 2]>, Relations)> {
    let sizing = Sizing::new(input, layout, size, &recall_steps(cache), &[])?;
    refuse_large(input, layout, &sizing, job)?;
    let demands = demands(input, layout, &sizing, &Limits::of(input), cache);
    let relations = Relations::new(layout, &sizing, &demands);
    Ok((sizing, demands, relations))
}

/// The demands of the rows of each face; none where all counts are written and no limit is set.
fn demands(input: &Input, layout: &Layout, sizing: &Sizing, limits: &Limits, cache: Option<&CacheView>) -> Vec<[RowDemand; 2]> {
    par::map(layout.faces.len(), |f| {
        let face = &layout.faces[f];
        if face.free {
            return [RowDemand::default(); 2];
        }
        let no_limit = limits.chord.is_none() && limits.angle.is_none();
        if no_limit && sizing.written_directions(&layout.faces[f]) == [true; 2] {
            return [RowDemand::default(); 2];
        }
        let patch = &input.model.patches[face.patch.index()];
        let key = |cache: &CacheView| cache.on("demands", face.surface).with(&(patch.u, patch.v, (face.size.0, limits))).finish();
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let even = recalled(cache, |reuse| &reuse.demands, key, || row_demand::demands(surface, patch.u, patch.v, face.size.0, limits));
        [0, 1].map(|k| sizing.rows[f][k].map_or(even[k], |rows| even[k].of_uneven(rows.uneven)))
    })
}

fn finished<'a>(layout: &'a Layout, sizing: &Sizing, prepared: &'a [FaceMesh], demands: &'a [[RowDemand; 2]]) -> Vec<Finished<'a>> {
    let one = |(f, (triangles, _)): (usize, FaceRanges)| Finished {
        face: &layout.faces[f],
        face_mesh: &prepared[f],
        triangles,
        demands: &demands[f],
        written: sizing.written_directions(&layout.faces[f]),
    };
    face_mesh::element_ranges(prepared).into_iter().enumerate().map(one).collect()
}
