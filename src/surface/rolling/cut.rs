//! A surface cut back to where the ball touches it.

use super::ball::{Ball, LEFT};
use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::network::Chain;
use crate::surface::core::Surface;
use crate::surface::divide;

/// Share of a step on which a surface goes on at the least, where it is taken to go on so far.
const AHEAD: f64 = 0.5;

/// The part of surface `k` on the far side of the contact curve from the edge.
pub(super) fn cut_back(ball: &Ball, k: usize, contact: &Chain, origin: Origin) -> Result<Surface> {
    let face = &ball.faces[k];
    let at = contact.point(0.5);
    let from = ball.edge.closest(at).1;
    let along = contact.jet(0.5).d1.normalize_or_zero();
    let normal = face.normal_at(at);
    let out = along.cross(normal).normalize_or_zero();
    let away = if out.dot(at - from) < 0.0 { -out } else { out };
    // Half as far as there is something of the surface ahead: clear of the cut and of the border beyond.
    let ahead = |step: f64| (face.nearest(at + away * step) - at).dot(away);
    let least = LEFT * ball.tolerance.point;
    let mut step = at.distance(from);
    while step > least && ahead(step) < AHEAD * step {
        step *= 0.5;
    }
    let keep = face.nearest(at + away * (0.5 * ahead(step.max(least))));
    divide(&face.kept, std::slice::from_ref(contact), keep, origin, &ball.tolerance)
}
