//! The mesh of some faces, divided and filled, and divided anew for as long as something asks for it.

use std::collections::BTreeMap;

use crate::base::digest::Digest;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::par;
use crate::mesh::border::layout::{Face, Layout, Uneven, closes};
use crate::mesh::border::nodes::Nodes;
use crate::mesh::cache::reuse::{CacheView, recall_face, recall_steps, recalled};
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_mesh::{self, FaceMesh, FaceRanges};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::divide::relations::Relations;
use crate::mesh::divide::row_demand::{self, RowDemand};
use crate::mesh::divide::strips;
use crate::mesh::divide::too_large::refuse_counts;
use crate::mesh::divide::verdict::{self, Finished, Verdict};
use crate::mesh::face::together::{self, Asked};
use crate::mesh::face::{foresee, twins};
use crate::mesh::pipeline::fill::{fill, free, number, prepare};
use crate::mesh::report::blame;
use crate::mesh::report::explain::Explanation;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::work::allow;
use crate::mesh::size::proximity::{self, Narrow};
use crate::mesh::size::remark::Remark;
use crate::mesh::size::sizing::{MOST, Sizing};
use crate::mesh::size::uneven;
use crate::mesh::tri::too_large::refuse_large;
use crate::mesh::verify::{face_check, turned};
use crate::surface::Domain;
use crate::surface::core::power_form::PowerForm;

/// Refinements of whole faces before a limit counts as out of reach.
const ROUNDS: usize = 40;
/// Times borders are divided anew where they come too near to each other.
const MAX_SEARCHES: usize = 24;
/// Times that the steps of the border of a face that closes on itself are halved for it.
const HALVED: u32 = 6;

/// Surfaces whose power forms are kept for their borders, faces and bounds: each takes many times the room of its net.
const HELD: usize = 64;

/// Power forms of the surfaces of faces that are surely made freely under limits.
fn held(input: &Input, layout: &Layout, limits: &Limits) -> Vec<PowerForm> {
    if limits.chord.is_none() && limits.angle.is_none() {
        return Vec::new();
    }
    let surface = |face: &Face| &input.model.surfaces[face.surface.index()].surface;
    let free = |face: &&Face| face.method.is_free() || surface(face).domain() == Domain::Loop;
    layout.faces.iter().filter(free).take(HELD).filter_map(|face| surface(face).power_form()).collect()
}

/// Everything but the layout.
pub(crate) struct Done {
    pub nodes: Nodes,
    pub prepared: Vec<FaceMesh>,
    pub sizing: Sizing,
    pub mesh: Mesh,
    pub explanation: Explanation,
}

/// Why a mesh is divided anew.
enum Retry {
    /// Mapped faces have pieces of border as short as a row would be, or lie beside free faces with such: they are made freely.
    UnevenBorders(Vec<(usize, Uneven)>),
    /// Borders of free faces come nearer to each other than their steps: these become shorter there.
    NearBorders(Vec<Narrow>),
    /// Faces are foreseen to be better made freely: with the reason and the elements foreseen.
    BetterFree(Vec<(usize, Uneven, u64)>),
    /// Faces made freely turned out worse than their maps.
    BetterMapped(Vec<usize>),
    /// A face breaks a limit: its rows ask for more steps.
    BrokenLimits,
    /// Faces have elements or edges in the same nodes.
    FallTogether(Asked),
    /// Elements of a face from one of its sides to another are the same ones: the steps of its border are halved.
    ClosesOnItself(usize),
}

/// How a round ends.
enum Step {
    /// The mesh keeps everything.
    Done(Box<Done>),
    /// It is divided anew; these were the counts of segments and rows.
    Again(Retry, Vec<u32>),
}

/// Counts with the nodes that they make.
struct Division {
    /// Of segments and rows.
    counts: Vec<u32>,
    /// The strip of each.
    strip: Vec<usize>,
    nodes: Nodes,
    /// The counts are those that were checked last: nothing moved, so only a size is missed, where a written count overrules it.
    is_settled: bool,
}

/// What is known of a mesh between two rounds.
struct Attempt<'a> {
    input: &'a Input<'a>,
    layout: &'a mut Layout,
    /// Where no rule says another, model units.
    size: f64,
    known: Option<&'a CacheView<'a>>,
    job: &'a Job,
    limits: Limits,
    sizing: Sizing,
    demands: Vec<[RowDemand; 2]>,
    relations: Relations,
    /// Where borders were found too near to each other.
    narrow: Vec<Narrow>,
    /// The counts that were checked against limits last, and how the faces kept them.
    checked: Vec<u32>,
    verdicts: Vec<Verdict>,
    /// Searches for near borders that are left, and the counts at which steps were shortened last.
    searches: usize,
    shortened: Vec<u32>,
    /// Work that the counts so far were worth.
    worth: u64,
    /// How often each face was asked for more because it falls together with another one.
    asked: BTreeMap<usize, u32>,
}

/// Divides, refines and fills.
pub(crate) fn attempt(input: &Input, layout: &mut Layout, size: f64, (known, job): (Option<&CacheView>, &Job)) -> Result<Done> {
    let limits = Limits::of(input);
    let _held = held(input, layout, &limits);
    let (sizing, demands, relations) = begin(input, layout, size, (known, job))?;
    let mut attempt = Attempt {
        input,
        layout,
        size,
        known,
        job,
        limits,
        sizing,
        demands,
        relations,
        narrow: Vec::new(),
        checked: Vec::new(),
        verdicts: Vec::new(),
        searches: MAX_SEARCHES,
        shortened: Vec::new(),
        worth: 0,
        asked: BTreeMap::new(),
    };
    for _ in 0..ROUNDS + MAX_SEARCHES + (2 + HALVED as usize) * attempt.layout.faces.len() {
        job.go_on()?;
        match attempt.round()? {
            Step::Done(done) => return Ok(*done),
            Step::Again(retry, counts) => attempt.retry(retry, counts)?,
        }
    }
    Err(attempt.relations.out_of_reach(input, attempt.layout, &attempt.verdicts))
}

impl Attempt<'_> {
    /// Counts of all segments and rows, and the nodes on segments.
    fn divide(&mut self) -> Result<Division> {
        let (input, layout) = (self.input, &*self.layout);
        let mut unknown = self.sizing.segments(layout);
        unknown.extend(self.relations.rows());
        let (counts, strip) = strips::solve(&unknown, &self.relations.list, MOST, input.tolerance.point)
            .map_err(|conflict| self.relations.fault(input, layout, &self.sizing, &conflict))?;
        self.relations.refuse_odd_borders(input, layout, &self.sizing, &counts)?;
        allow(refuse_counts(input, layout, &self.sizing, &self.relations.of_face, &counts)?, &mut self.worth);
        let fractions = |segment, count| self.sizing.fractions(segment, count);
        let nodes = Nodes::new(layout, &counts[..layout.pieces.segments.len()], fractions);
        Ok(Division { is_settled: counts == self.checked, counts, strip, nodes })
    }

    /// Divides and fills once, until something asks for another division.
    fn round(&mut self) -> Result<Step> {
        let Division { counts, strip, nodes, is_settled } = self.divide()?;
        let (input, known, job) = (self.input, self.known, self.job);
        let uneven = uneven::find(self.layout, &nodes, input.tolerance.point, &self.sizing);
        if !uneven.is_empty() {
            return Ok(Step::Again(Retry::UnevenBorders(uneven), counts));
        }
        let border = nodes.points(self.layout, &input.plan.points);
        let made = FaceInput { input, layout: &*self.layout, nodes: &nodes, points: &border, wanted: &self.sizing.wanted };
        // Shorter steps that leave all counts as they are help no more.
        if self.searches > 0 && counts != self.shortened {
            self.searches -= 1;
            let found = proximity::find(&made);
            if !found.is_empty() {
                return Ok(Step::Again(Retry::NearBorders(found), counts));
            }
        }
        let mut prepared = prepare(&made, &self.relations, &counts)?;
        let foreseen = foresee::find(&made, &prepared);
        let better = foresee::better_free(&made, &self.sizing, &foreseen, &prepared);
        if !better.is_empty() {
            return Ok(Step::Again(Retry::BetterFree(better), counts));
        }
        let key = |known: &CacheView| prepared.iter().map(|ready| known.face(ready, &border, input.tolerance.point)).collect();
        let keys: Vec<Digest> = known.map(key).unwrap_or_default();
        let keyed = known.map(|known| (known, keys.as_slice()));
        let mut mesh = fill(input, &border, &prepared, (keyed, false), job)?;
        if !is_settled {
            let recall = recall_face(keyed, "verdict", |reuse| &reuse.verdicts);
            let finished = finished(self.layout, &self.sizing, &prepared, &self.demands);
            self.verdicts = verdict::check(input, &self.limits, &mesh, &finished, &recall);
            if !self.verdicts.iter().all(|v| v.keeps_limits() && v.keeps_size()) {
                return Ok(Step::Again(Retry::BrokenLimits, counts));
            }
        }
        turned::refuse_turned(input, &prepared, &mesh, &recall_face(keyed, "turned", |reuse| &reuse.turned))?;
        if self.layout.faces.iter().any(|face| face.free) {
            free(&made, &mut prepared, (known, job))?;
            mesh = fill(input, &border, &prepared, (keyed, true), job)?;
            let back = foresee::better_mapped(&made, &prepared, &mesh);
            if !back.is_empty() {
                return Ok(Step::Again(Retry::BetterMapped(back), counts));
            }
            if twins::divide(&made, &mut prepared, &mesh) {
                number(&made, &mut prepared);
                mesh = fill(input, &border, &prepared, (keyed, true), job)?;
            }
            turned::refuse_concave(input, &prepared, &mesh)?;
        }
        let together = together::part(&made, &prepared, (&mut mesh, &self.limits));
        if let Some(first) = together.first() {
            return match together::ask(self.layout, &prepared, &together, &mut self.asked) {
                Some(asked) => Ok(Step::Again(Retry::FallTogether(asked), counts)),
                None => Err(together::fault(input, self.layout, &mesh, first)),
            };
        }
        if let Some(face) = self.closing_on_itself(&nodes, &prepared, &mesh)? {
            return Ok(Step::Again(Retry::ClosesOnItself(face), counts));
        }
        self.layout.faces.iter_mut().zip(&foreseen).for_each(|(face, found)| face.foreseen = found.map(|found| found.angle));
        let made = FaceInput { input, layout: &*self.layout, nodes: &nodes, points: &border, wanted: &self.sizing.wanted };
        let blames = blame::of_faces(&made, (&self.sizing, &foreseen), &prepared, &mesh);
        let sharp: Vec<Remark> = blames.iter().filter_map(|seen| seen.sharp.clone()).collect();
        let mut sizing = std::mem::take(&mut self.sizing);
        sizing.sharp = sharp.into_iter().reduce(Remark::sharper);
        sizing.mark_used(&counts);
        sizing.effects.mark_inside(input, &prepared);
        let mut explanation = Explanation::new(input, self.layout, &sizing, &prepared, (&counts, &strip));
        explanation.lines.iter_mut().zip(blames).for_each(|(line, blame)| line.push_str(&blame.line));
        Ok(Step::Done(Box::new(Done { nodes, prepared, sizing, mesh, explanation })))
    }

    /// A face that closes on itself and has to have shorter steps for it; fails for what is wrong with a face otherwise.
    fn closing_on_itself(&self, nodes: &Nodes, prepared: &[FaceMesh], mesh: &Mesh) -> Result<Option<usize>> {
        let layout = &*self.layout;
        let found = face_check::unsound(self.input, (layout, nodes), prepared, mesh);
        let coarse = |f: &usize| {
            let face = &layout.faces[*f];
            closes(face) && face.halved < HALVED && foresee::is_twisted(&prepared[*f], mesh)
        };
        let Some((f, defect)) = found else { return Ok((0..prepared.len()).find(coarse)) };
        if !closes(&layout.faces[f]) || layout.faces[f].halved == HALVED {
            return Err(face_check::fault(self.input, (layout, nodes, &layout.faces[f]), (&prepared[f], defect), mesh));
        }
        Ok(Some(f))
    }

    /// Changes what the next division follows from; `counts` are those of the last one.
    fn retry(&mut self, retry: Retry, counts: Vec<u32>) -> Result<()> {
        match retry {
            Retry::NearBorders(found) => {
                self.narrow.extend(found);
                self.sizing = Sizing::new(self.input, self.layout, self.size, &recall_steps(self.known), &self.narrow)?;
                self.shortened = counts;
                return Ok(());
            }
            Retry::BrokenLimits => {
                self.relations.raise(&self.verdicts, &counts);
                self.checked = counts;
                return Ok(());
            }
            Retry::FallTogether(Asked::Rows(rows)) => {
                self.relations.raise(&rows, &counts);
                self.checked = Vec::new();
                return Ok(());
            }
            // The layout has changed where it was asked.
            Retry::FallTogether(Asked::Anew) => {}
            Retry::UnevenBorders(faces) => faces.into_iter().for_each(|(f, why)| self.layout.faces[f].uneven = Some(why)),
            Retry::BetterFree(faces) => {
                for (f, why, elements) in faces {
                    (self.layout.faces[f].uneven, self.layout.faces[f].foreseen_free) = (Some(why), elements);
                }
            }
            Retry::BetterMapped(faces) => faces.into_iter().for_each(|f| self.layout.faces[f].keep_map()),
            Retry::ClosesOnItself(f) => self.layout.faces[f].halved += 1,
        }
        (self.sizing, self.demands, self.relations) = begin(self.input, self.layout, self.size, (self.known, self.job))?;
        self.narrow.clear();
        (self.checked, self.shortened) = (Vec::new(), Vec::new());
        Ok(())
    }
}

/// Sizes of everything, what rows want, and the equations between counts.
fn begin(
    input: &Input,
    layout: &mut Layout,
    size: f64,
    (known, job): (Option<&CacheView>, &Job),
) -> Result<(Sizing, Vec<[RowDemand; 2]>, Relations)> {
    let sizing = Sizing::new(input, layout, size, &recall_steps(known), &[])?;
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

fn finished<'a>(layout: &'a Layout, sizing: &Sizing, prepared: &'a [FaceMesh], demands: &'a [[RowDemand; 2]]) -> Vec<Finished<'a>> {
    let one = |(f, (triangles, _)): (usize, FaceRanges)| Finished {
        face: &layout.faces[f],
        face_mesh: &prepared[f],
        triangles,
        demands: &demands[f],
        written: written(layout, sizing, f),
    };
    face_mesh::element_ranges(prepared).into_iter().enumerate().map(one).collect()
}
