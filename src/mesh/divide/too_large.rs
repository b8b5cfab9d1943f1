//! E217 before anything is allocated for more elements than a mesh may have.

use crate::base::fault::Result;
use crate::base::limits::MESH_STEPS;
use crate::base::origin::Origin;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::divide::row_demand;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::Elements;
use crate::mesh::request::work::too_many;
use crate::mesh::size::sizing::Sizing;
use crate::mesh::size::too_large::{of_segment, too_many_steps};

/// The expression that makes the steps of a segment as many as they are, where rows of mapped faces may demand more than the segment
/// itself: then a limit on their bends does.
pub(crate) fn of_count(input: &Input, layout: &Layout, sizing: &Sizing, k: usize, count: u32) -> Origin {
    let (plan, decision) = (input.plan, &sizing.decisions[k]);
    let own = decision.count.map_or(decision.demand, |c| c.0).max(decision.least);
    let (Some(limit), true) =
        (plan.settings.chord_error.or(plan.settings.angle_error), f64::from(count) > MIN_RATIO_BY_ROWS * f64::from(own))
    else {
        return of_segment(input, layout, sizing, k);
    };
    let Some(angle) = plan.settings.angle_error.filter(|_| plan.settings.chord_error.is_some()) else { return limit.1 };
    let steps = |limits: Limits| -> f64 {
        let beside = layout.faces.iter().filter(|f| !f.free && f.segments().any(|s| s == k));
        let demands = beside.flat_map(|face| {
            let patch = &input.model.patches[face.patch.index()];
            row_demand::demands(&input.model.surfaces[face.surface.index()].surface, patch.u, patch.v, face.size.0, &limits)
        });
        demands.map(|w| w.least).fold(0.0, f64::max)
    };
    let by_angle = steps(Limits { chord: None, ..Limits::of(input) });
    if by_angle > steps(Limits { angle: None, ..Limits::of(input) }) { angle.1 } else { limit.1 }
}

/// Steps over those that a segment demands itself from which rows decide.
const MIN_RATIO_BY_ROWS: f64 = 1.1;

/// The elements that counts of segments and rows make, those inside free faces left out; E217 where a mesh may not have so many.
/// `rows_of_face` are the rows of each face, as in [`super::relations::Relations::of_face`].
pub fn refuse_counts(input: &Input, layout: &Layout, sizing: &Sizing, rows_of_face: &[Vec<usize>], counts: &[u32]) -> Result<u64> {
    let segments = layout.pieces.segments.len();
    if let Some(k) = (0..segments).find(|k| counts[*k] > MESH_STEPS) {
        return Err(too_many_steps(input, of_count(input, layout, sizing, k, counts[k])));
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
    let of_faces: Vec<u64> = layout.faces.iter().zip(rows_of_face).map(elements).collect();
    let lines = layout.curves.iter().flatten().map(|u| u64::from(counts[u.segment]));
    let total = of_faces.iter().copied().chain(lines).fold(0, u64::saturating_add);
    if total <= input.plan.most_elements {
        return Ok(total);
    }
    let largest = (0..of_faces.len()).max_by_key(|f| of_faces[*f]);
    let around: Vec<usize> = largest.map_or_else(|| (0..segments).collect(), |f| layout.faces[f].segments().collect());
    let longest = around.into_iter().max_by_key(|k| counts[*k]);
    let of = longest.map_or(input.plan.origin, |k| of_count(input, layout, sizing, k, counts[k]));
    Err(too_many(input.plan, of, Some(total)))
}
