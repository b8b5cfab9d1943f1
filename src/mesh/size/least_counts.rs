//! The least count of each segment: what keeps segments apart, and what chord error and angle allow.

use std::f64::consts::FRAC_PI_3;

use crate::base::digest::StableHasher;
use crate::base::fault::Result;
use crate::base::limits::MESH_STEPS;
use crate::base::par;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::border::counts::steps;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::deviation::curve::{least_steps, more_steps};
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::recall::RecallSteps;
use crate::mesh::size::border_spacing::BorderSpacings;
use crate::mesh::size::sizing::Sizing;

/// One step more than a segment may have: enough to refuse it.
pub(super) const MAX_COUNT: u32 = MESH_STEPS + 1;

/// Largest turn of a border across one step where triangles may be as long as the chord error lets them, radians: 60°. What
/// stands beside a step that turns more is tilted against the surface, however small it is.
const MAX_TURN: f64 = FRAC_PI_3;

/// Elements have no more steps of borders each.
const STEPS_OF_AN_ELEMENT: u32 = 4;

/// The least count of each segment for chord error and angle, [`MAX_COUNT`] where it would be more. `bias` is that of each, which holds
/// where it has no spacing.
pub(super) fn for_limits(
    input: &Input,
    layout: &Layout,
    bias: &[f64],
    spacings: &BorderSpacings,
    recall: &RecallSteps,
) -> Result<Vec<u32>> {
    let limits = Limits::of(input);
    let coarse = coarse_borders(input, layout, &limits);
    let most = u32::try_from(input.plan.most_elements).unwrap_or(MAX_COUNT).saturating_mul(STEPS_OF_AN_ELEMENT).saturating_add(1);
    let most = MAX_COUNT.min(most);
    par::try_map(bias.len(), |k| {
        let bias = bias[k];
        let divided = |count: u32| spacings[k].as_ref().map_or_else(|| steps(count, bias), |spacing| spacing.steps(count));
        let limits = if coarse[k] { limits.turning(MAX_TURN) } else { limits };
        let segment = &layout.pieces.segments[k];
        let key = || {
            let track = &layout.parts[segment.track].track;
            StableHasher::new("steps").with(&(track, segment.s, (bias, &limits, u64::from(most)))).finish()
        };
        let find = || least_steps(layout, k, &divided, &limits, most);
        // Without a limit there is nothing to find; a spacing is not in the key.
        let is_worth = (limits.chord.is_some() || limits.angle.is_some()) && spacings[k].is_none();
        if is_worth { recall(&key, &find) } else { find() }
    })
}

/// Segments whose steps break a limit, with the next count of each that keeps it. Counts are those of all segments, `least` what each was
/// known to keep its limits with.
pub(super) fn broken(input: &Input, layout: &Layout, sizing: &Sizing, counts: &[u32]) -> Result<Vec<(usize, u32)>> {
    let limits = Limits::of(input);
    if limits.chord.is_none() && limits.angle.is_none() {
        return Ok(Vec::new());
    }
    let coarse = coarse_borders(input, layout, &limits);
    let found = par::try_map(sizing.decisions.len(), |k| {
        if counts[k] <= sizing.decisions[k].least {
            return Ok(None);
        }
        let limits = if coarse[k] { limits.turning(MAX_TURN) } else { limits };
        more_steps(layout, k, &|count| sizing.fractions(k, count), &limits, (counts[k], MAX_COUNT))
    })?;
    Ok(found.into_iter().enumerate().filter_map(|(k, more)| Some((k, more?))).collect())
}

/// Segments whose steps a chord error alone may make so long that triangles beside them are tilted: those of bent faces made with
/// as few triangles as may be.
fn coarse_borders(input: &Input, layout: &Layout, limits: &Limits) -> Vec<bool> {
    let mut found = vec![false; layout.pieces.segments.len()];
    let bent = |face: &&Face| !input.model.surfaces[face.surface.index()].surface.is_flat();
    if limits.chord.is_some() {
        let faces = layout.faces.iter().filter(|face| face.method.is_coarse()).filter(bent);
        faces.flat_map(|face| face.segments()).for_each(|k| found[k] = true);
    }
    found
}

/// Least steps of the borders of a face that is meshed freely between two poles, before they are halved: with fewer there may be
/// nothing inside.
const MIN_CLOSED_COUNT: u32 = 4;

/// Least counts that keep segments from falling on each other: 3 for a ring; of several with the same ends the shortest may
/// be one step, as a blunt trailing edge is, and the others take 2.
pub(super) fn to_keep_apart(layout: &Layout, near: f64) -> Vec<u32> {
    let ends = |k: usize| {
        let (a, b) = layout.pieces.segments[k].ends;
        (a.min(b), a.max(b))
    };
    let n = layout.pieces.segments.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_key(|k| (ends(*k), *k));
    // Free quads come from cells whose sides are two steps, or one where a count is odd; those may not fall together either.
    let mut halved = vec![false; n];
    layout.faces.iter().filter(|f| f.takes_quads()).flat_map(|f| f.segments()).for_each(|s| halved[s] = true);
    let mut least = vec![1; n];
    for group in order.chunk_by(|a, b| ends(*a) == ends(*b)) {
        let length = |k: &usize| layout.pieces.segments[*k].length();
        let shortest = group.iter().map(length).fold(f64::INFINITY, f64::min);
        let alike = group.iter().filter(|k| length(k) <= shortest * (1.0 + WHOLE_NUMBER) + near).count();
        for k in group {
            let (a, b) = ends(*k);
            let sides = match () {
                () if a == b => 3,
                () if group.len() == 1 || (alike == 1 && length(k) == shortest) => 1,
                () => 2,
            };
            least[*k] = if halved[*k] { 2 * sides - 1 } else { sides };
        }
    }
    for face in layout.faces.iter().filter(|face| face.free) {
        let poles = face.sides.iter().filter(|side| side.uses.is_empty()).count();
        if face.halved > 0 || poles == 2 && face.sides.len() == 4 {
            face.segments().for_each(|k| least[k] = least[k].max(MIN_CLOSED_COUNT << face.halved));
        }
    }
    least
}
