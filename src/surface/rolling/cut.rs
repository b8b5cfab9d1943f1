//! A surface cut back to where the ball touches it.

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::network::Chain;
use crate::surface::core::surface::Surface;
use crate::surface::rolling::ball::{Ball, LEFT};
use crate::surface::trims::divide::divide;

/// Share of a step on which a surface goes on at the least, where it is taken to go on so far.
const AHEAD: f64 = 0.5;
/// Share of its distance from the middle of the cut at which a place must be clear of all of the cut.
const CLEAR: f64 = 0.7;

/// The part of surface `k` on the far side of the contact curve from the edge.
pub(crate) fn cut_back(ball: &Ball, k: usize, contact: &Chain, origin: Origin) -> Result<Surface> {
    let face = &ball.faces[k];
    let at = contact.point(0.5);
    let from = ball.edge.closest(at).1;
    let along = contact.jet(0.5).d1.normalize_or_zero();
    let normal = face.normal_at(at);
    let out = along.cross(normal).normalize_or_zero();
    let away = if out.dot(at - from) < 0.0 { -out } else { out };
    // A place well beside the cut: farther and farther from it while the surface goes on, and while no other part of the cut is much
    // nearer than this one, for across a small closed one lies what goes.
    let place = |step: f64| {
        let ahead = (face.nearest(at + away * step) - at).dot(away);
        let keep = face.nearest(at + away * (0.5 * ahead));
        let clear = contact.closest(keep).2 >= CLEAR * keep.distance(at);
        (keep, ahead >= AHEAD * step && clear)
    };
    let (mut step, longest) = (LEFT * ball.tolerance.point, at.distance(from));
    let mut keep = place(step).0;
    while 2.0 * step <= longest {
        step *= 2.0;
        let (farther, good) = place(step);
        if !good {
            break;
        }
        keep = farther;
    }
    divide(&face.kept, std::slice::from_ref(contact), keep, origin, &ball.tolerance)
}
