//! A surface cut back to where the ball touches it.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::surface::closest::nearest::closest;
use crate::surface::core::surface::Surface;
use crate::surface::rolling::ball::Ball;
use crate::surface::rolling::ball_surface::Roll;
use crate::surface::trims::divide::beside;

/// The part of surface `k` on the far side of the rounding's contact from the edge.
pub(crate) fn cut_back(ball: &Ball, k: usize, roll: &Roll, origin: Origin) -> Result<Surface> {
    // The rounding is tangent to the surface there, and its v runs from the first surface to the second.
    let whole = roll.surface.untrimmed();
    let away = |at: DVec3| {
        let (u, _) = closest(&whole, at).uv;
        let jet = whole.jet(u, k as f64);
        if k == 0 { -jet.dv } else { jet.dv }
    };
    beside(&ball.faces[k].kept, &roll.contacts[k], away, origin, &ball.tolerance)
}
