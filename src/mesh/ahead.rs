//! What a mesh would be too large for, told before anything is divided or allocated for it.

use super::build::Input;
use super::counts::steps;
use super::edges::{Limits, least_steps};
use super::faces;
use super::free::face::{self as free_face, FaceInput};
use super::layout::{Face, Layout};
use super::nodes::Nodes;
use super::plan::Elements;
use super::relations::Relations;
use super::rows;
use super::sizing::{Decision, Sizing};
use super::spacing::BorderSpacing;
use crate::base::fault::{Fault, MeshFault, Result};
use crate::base::job::Job;
use crate::base::limits::MESH_STEPS;
use crate::base::origin::Origin;
use crate::base::tolerance::WHOLE_NUMBER;

/// Steps of each segment at which a free face is looked at ahead: more where borders so coarse cross.
const COARSE: [u32; 3] = [32, 512, 8192];
/// Share of the largest mesh below which the box of a face tells that it is small enough.
const SMALL: f64 = 0.1;

/// E217 where a segment takes more steps than one may, at what asks for them.
pub fn refuse_steps(input: &Input, layout: &Layout, sizing: &Sizing) -> Result<()> {
    let asked = |d: &Decision| d.count.map_or(d.demand, |c| c.0).max(d.least);
    match sizing.decisions.iter().position(|d| asked(d) > MESH_STEPS) {
        Some(k) => Err(too_many_steps(input, of_segment(input, layout, sizing, k))),
        None => Ok(()),
    }
}

/// E217 where the bends of faces alone ask for more steps along borders than a mesh may have, before those steps are carried on
/// to neighbours: `spacings` and the size of each segment. A free face has an element at each step of its border, but few where
/// it is sparing.
pub fn refuse_bends(input: &Input, layout: &Layout, spacings: &[BorderSpacing], size: &[f64]) -> Result<()> {
    let plan = input.plan;
    let Some(limit) = plan.chord_error.or(plan.angle_error) else { return Ok(()) };
    let near = input.tolerance.point;
    let demand = |k: usize| spacings[k].demand((layout.length(k) - near).max(0.0), size[k], u32::MAX);
    let bent = |k: &usize| spacings[*k].least() < size[*k];
    if (0..spacings.len()).any(|k| bent(&k) && demand(k) > MESH_STEPS) {
        return Err(too_many_steps(input, limit.1));
    }
    let free = layout.faces.iter().filter(|face| face.free && !face.method.is_coarse());
    let steps: u64 = free.flat_map(|face| face.sides.iter().flat_map(|s| s.segments())).filter(bent).map(|k| u64::from(demand(k))).sum();
    if steps > plan.most_elements { Err(faces::too_many(plan, limit.1, Some(steps))) } else { Ok(()) }
}

fn too_many_steps(input: &Input, of: Origin) -> Fault {
    MeshFault::TooManySteps { of, name: input.plan.name.clone(), limit: MESH_STEPS }.into()
}

/// The expression that makes the steps of a segment as many as they are.
fn of_segment(input: &Input, layout: &Layout, sizing: &Sizing, k: usize) -> Origin {
    let (plan, decision) = (input.plan, &sizing.decisions[k]);
    let count = |rule: usize| plan.rules[rule].count.map(|c| c.1);
    let by_bends = || {
        let chord = Limits { angle: None, ..Limits::of(input) };
        let enough = |n: u32| steps(n, 1.0);
        let alone = least_steps(layout, k, &enough, &chord, decision.least.min(MESH_STEPS)).unwrap_or(1);
        let angle = plan.angle_error.filter(|_| plan.chord_error.is_none() || alone < decision.least.min(MESH_STEPS));
        angle.or(plan.chord_error).map(|limit| limit.1)
    };
    let even = ((layout.length(k) - input.tolerance.point) / decision.size.0 - WHOLE_NUMBER).ceil();
    let asked = decision.count.map_or(decision.demand, |c| c.0);
    if decision.least > 1
        && f64::from(decision.least) >= even
        && decision.least >= asked
        && let Some(limit) = by_bends()
    {
        return limit;
    }
    if let Some(count) = decision.count.and_then(|(_, rule)| count(rule)) {
        return count;
    }
    if let Some(spacing) = &sizing.spacings[k]
        && spacing.least() < decision.size.0
    {
        let shortest = spacing.places().min_by(|a, b| spacing.length_at(*a).total_cmp(&spacing.length_at(*b))).unwrap_or(0.0);
        let who = sizing.wanted.sources.who(layout.point(k, shortest), decision.size.0);
        let bends = plan.chord_error.or(plan.angle_error).map(|limit| limit.1);
        if let Some(found) = who.map(|w| plan.refines[sizing.wanted.sources.items()[w.item as usize].tag as usize].size.1).or(bends) {
            return found;
        }
    }
    of_size(input, decision.size.1)
}

/// The same where rows of mapped faces may ask for more steps than the segment itself: then their bends do.
fn of_count(input: &Input, layout: &Layout, sizing: &Sizing, (k, count): (usize, u32)) -> Origin {
    let (plan, decision) = (input.plan, &sizing.decisions[k]);
    let own = decision.count.map_or(decision.demand, |c| c.0).max(decision.least);
    let (Some(limit), true) = (plan.chord_error.or(plan.angle_error), f64::from(count) > BY_ROWS * f64::from(own)) else {
        return of_segment(input, layout, sizing, k);
    };
    let Some(angle) = plan.angle_error.filter(|_| plan.chord_error.is_some()) else { return limit.1 };
    let steps = |limits: Limits| -> f64 {
        let beside = layout.faces.iter().filter(|f| !f.free && f.segments().any(|s| s == k));
        let demands = beside.flat_map(|face| {
            let patch = &input.model.patches[face.patch.index()];
            rows::demands(&input.model.surfaces[face.surface.index()].surface, patch.u, patch.v, face.size.0, &limits)
        });
        demands.map(|w| w.least).fold(0.0, f64::max)
    };
    let by_angle = steps(Limits { chord: None, ..Limits::of(input) });
    if by_angle > steps(Limits { angle: None, ..Limits::of(input) }) { angle.1 } else { limit.1 }
}

/// Steps over those that a segment asks for itself from which rows decide.
const BY_ROWS: f64 = 1.1;

/// The expression of a size: that of a rule or clause, else the mesh's own.
pub fn of_size(input: &Input, clause: Option<usize>) -> Origin {
    let plan = input.plan;
    let own = plan.size_origin();
    let Some(clause) = clause else { return own };
    match plan.rules.get(clause) {
        Some(rule) => rule.size.map_or(rule.origin, |s| s.1),
        None => plan.refines.get(clause - plan.rules.len()).map_or(own, |refine| refine.size.1),
    }
}

/// E217 where the wanted lengths ask for more inside a free face than a mesh may have: its border, divided coarsely, is
/// triangulated and the lengths are added up over it, so that nobody waits for the border itself.
pub fn refuse_large(input: &Input, layout: &Layout, sizing: &Sizing, job: &Job) -> Result<()> {
    for face in layout.faces.iter().filter(|face| face.free) {
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let least = face.size.0.min(sizing.wanted.sources.least()).max(sizing.wanted.written);
        let across = surface.hull().diagonal() / least;
        let most = input.plan.most_elements as f64;
        if across * across < SMALL * most {
            continue;
        }
        for coarse in COARSE {
            job.go_on()?;
            let counts: Vec<u32> = sizing.decisions.iter().map(|d| d.count.map_or(d.demand, |c| c.0).min(coarse)).collect();
            let nodes = Nodes::new(layout, sizing, &counts);
            let points = nodes.points(layout, &input.plan.points);
            let made = FaceInput { input, layout, nodes: &nodes, points: &points, wanted: &sizing.wanted };
            let Some([elements, by_size]) = free_face::elements_ahead(&made, face) else { continue };
            if elements > most {
                let refines = input.plan.refines.iter().map(|r| r.size).min_by(|a, b| a.0.total_cmp(&b.0));
                let refined = refines.filter(|_| by_size <= most).map(|size| size.1);
                return Err(faces::too_many(input.plan, refined.unwrap_or_else(|| of_size(input, face.size.1)), Some(elements as u64)));
            }
            break;
        }
    }
    Ok(())
}

/// E217 before anything is allocated for more elements than a mesh may have.
pub fn refuse_counts(
    input: &Input,
    layout: &Layout,
    (sizing, relations): (&Sizing, &Relations),
    (counts, worth): (&[u32], &mut u64),
) -> Result<()> {
    let segments = layout.pieces.segments.len();
    if let Some(k) = (0..segments).find(|k| counts[*k] > MESH_STEPS) {
        return Err(too_many_steps(input, of_count(input, layout, sizing, (k, counts[k]))));
    }
    let elements = |(face, rows): (&Face, &Vec<usize>)| -> u64 {
        if face.free {
            // The border at least; how many are inside is known before any is made.
            return face.sides.iter().flat_map(|s| &s.uses).map(|u| u64::from(counts[u.segment])).sum();
        }
        let n = |k: usize| u64::from(counts[rows[k]]);
        let cells = if face.is_triangle() { n(0).saturating_mul(n(0)) } else { n(0).saturating_mul(n(1)) };
        if face.elements == Elements::Triangles && !face.is_triangle() { 2 * cells } else { cells }
    };
    let of_faces: Vec<u64> = layout.faces.iter().zip(&relations.of_face).map(elements).collect();
    let lines = layout.curves.iter().flatten().map(|u| u64::from(counts[u.segment]));
    let total = of_faces.iter().copied().chain(lines).fold(0, u64::saturating_add);
    if total <= input.plan.most_elements {
        faces::allow(total, worth);
        return Ok(());
    }
    let largest = (0..of_faces.len()).max_by_key(|f| of_faces[*f]);
    let around: Vec<usize> = largest.map_or_else(|| (0..segments).collect(), |f| layout.faces[f].segments().collect());
    let longest = around.into_iter().max_by_key(|k| counts[*k]);
    let of = longest.map_or(input.plan.origin, |k| of_count(input, layout, sizing, (k, counts[k])));
    Err(faces::too_many(input.plan, of, Some(total)))
}
