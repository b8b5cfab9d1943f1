//! Meshes that would be too large, refused before anything is divided or allocated for them.

use crate::base::fault::{Fault, Result};
use crate::base::limits::MESH_STEPS;
use crate::base::origin::Origin;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::border::counts::steps;
use crate::mesh::border::layout::Layout;
use crate::mesh::deviation::curve::least_steps;
use crate::mesh::request::fault::MeshFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::work::too_many;
use crate::mesh::size::border_spacing::BorderSpacing;
use crate::mesh::size::sizing::{Decision, Sizing};

/// E217 where a segment takes more steps than one may, at the expression that demands them.
pub fn refuse_steps(input: &Input, layout: &Layout, sizing: &Sizing) -> Result<()> {
    let demanded = |d: &Decision| d.count.map_or(d.demand, |c| c.0).max(d.least);
    match sizing.decisions.iter().position(|d| demanded(d) > MESH_STEPS) {
        Some(k) => Err(too_many_steps(input, of_segment(input, layout, sizing, k))),
        None => Ok(()),
    }
}

/// E217 where the bends of faces alone demand more steps along borders than a mesh may have, before those steps are carried on
/// to neighbours: `spacings` and the size of each segment. A free face has an element at each step of its border, but few where
/// its method is coarse.
pub fn refuse_bends(input: &Input, layout: &Layout, spacings: &[BorderSpacing], size: &[f64]) -> Result<()> {
    let plan = input.plan;
    let Some(limit) = plan.settings.chord_error.or(plan.settings.angle_error) else { return Ok(()) };
    let near = input.tolerance.point;
    let demand = |k: usize| spacings[k].demand((layout.length(k) - near).max(0.0), size[k], u32::MAX);
    let bent = |k: &usize| spacings[*k].least() < size[*k];
    if (0..spacings.len()).any(|k| bent(&k) && demand(k) > MESH_STEPS) {
        return Err(too_many_steps(input, limit.1));
    }
    let free = layout.faces.iter().filter(|face| face.free && !face.method.is_coarse());
    let steps: u64 = free.flat_map(|face| face.sides.iter().flat_map(|s| s.segments())).filter(bent).map(|k| u64::from(demand(k))).sum();
    if steps > plan.most_elements { Err(too_many(plan, limit.1, Some(steps))) } else { Ok(()) }
}

pub(crate) fn too_many_steps(input: &Input, of: Origin) -> Fault {
    MeshFault::TooManySteps { of, name: input.plan.name.clone(), limit: MESH_STEPS }.into()
}

/// The expression that makes the steps of a segment as many as they are.
pub(crate) fn of_segment(input: &Input, layout: &Layout, sizing: &Sizing, k: usize) -> Origin {
    let (plan, decision) = (input.plan, &sizing.decisions[k]);
    let count = |rule: usize| plan.rules[rule].settings.count.map(|c| c.1);
    let by_bends = || {
        let chord = Limits { angle: None, ..Limits::of(input) };
        let enough = |n: u32| steps(n, 1.0);
        let alone = least_steps(layout, k, &enough, &chord, decision.least.min(MESH_STEPS)).unwrap_or(1);
        let angle = plan.settings.angle_error.filter(|_| plan.settings.chord_error.is_none() || alone < decision.least.min(MESH_STEPS));
        angle.or(plan.settings.chord_error).map(|limit| limit.1)
    };
    let even = ((layout.length(k) - input.tolerance.point) / decision.size.0 - WHOLE_NUMBER).ceil();
    let demanded = decision.count.map_or(decision.demand, |c| c.0);
    if decision.least > 1
        && f64::from(decision.least) >= even
        && decision.least >= demanded
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
        let bends = plan.bend_limit().map(|limit| limit.1);
        if let Some(found) = who.map(|w| plan.refines[sizing.wanted.sources.items()[w.item as usize].tag as usize].size.1).or(bends) {
            return found;
        }
    }
    of_size(input, decision.size.1)
}

/// The expression of a size: that of a rule or clause, else the mesh's own.
pub fn of_size(input: &Input, clause: Option<usize>) -> Origin {
    let plan = input.plan;
    let own = plan.size_origin();
    let Some(clause) = clause else { return own };
    match plan.rules.get(clause) {
        Some(rule) => rule.settings.size.map_or(rule.origin, |s| s.1),
        None => plan.refines.get(clause - plan.rules.len()).map_or(own, |refine| refine.size.1),
    }
}
