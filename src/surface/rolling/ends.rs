//! Where the rounding of an open edge ends: on the borders of both surfaces.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::geometry::construct::build::line;
use crate::network::{Chain, meet};
use crate::surface::core::surface::Surface;
use crate::surface::faults::NoBlend;
use crate::surface::offset::boundary::border_chains;
use crate::surface::rolling::ball::Ball;
use crate::surface::rolling::ball_surface::Roll;
use crate::surface::trims::project::{Way, project};
use crate::surface::trims::trim::trim;

/// Steps from the middle to an end in which the border is looked for.
const STEPS: usize = 256;
/// Halvings of such a step.
const HALVINGS: usize = 48;
/// Distance from a surface within which a point is on it, in roundings.
const ON: f64 = 16.0;

/// The rounding without what stands out over the borders of the surfaces, and its contacts within them.
///
/// Where both contacts end at one arc that is its end, elsewhere it is straight in (u, v). Fails with E674 where a contact ends
/// inside its surface or runs over a border.
pub(crate) fn ended(ball: &Ball, roll: Roll, origin: Origin) -> Result<Roll> {
    let point = ball.tolerance.point;
    let mut stops = [[0.0, 1.0]; 2];
    if !ball.closed {
        for (k, stops) in stops.iter_mut().enumerate() {
            for stop in stops {
                *stop = stop_of(ball, k, &roll.surface, *stop)?;
            }
        }
    }
    let roll = if stops == [[0.0, 1.0]; 2] { roll } else { slanted(ball, &roll, stops, origin)? };
    for (k, contact) in roll.contacts.iter().enumerate() {
        for border in border_chains(&ball.faces[k].kept, &ball.tolerance)? {
            let inner = |p: &DVec3| ball.closed || p.distance(contact.start()).min(p.distance(contact.end())) > AWAY * point;
            if let Some(m) = meet(contact, &border, &ball.tolerance)?.iter().find(|m| inner(&m.point)) {
                return Err(ball.fault(NoBlend::Leaves { surface: ball.origins[k], at: m.point }));
            }
        }
    }
    Ok(roll)
}

/// A contact that is this near to its end, in tolerances, is there.
const AWAY: f64 = 16.0;

/// u at which a contact meets the border of its surface, towards an end of the rounding.
fn stop_of(ball: &Ball, k: usize, rounding: &Surface, end: f64) -> Result<f64> {
    let face = &ball.faces[k];
    let at = |u: f64| rounding.point(u, k as f64);
    if face.on_border(at(end), 2.0 * ball.tolerance.point) {
        return Ok(end);
    }
    let on = |u: f64| {
        let p = at(u);
        face.distance(p) <= 0.5 * ball.tolerance.point && face.distance(face.foot(p)) <= ON * ball.tolerance.rounding
    };
    let place = |i: usize| 0.5 + (end - 0.5) * i as f64 / STEPS as f64;
    let Some(first) = (1..=STEPS).find(|i| !on(place(*i))) else {
        return Err(ball.fault(NoBlend::EndsInside { surface: ball.origins[k], at: at(end) }));
    };
    let (mut inside, mut outside) = (place(first - 1), place(first));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if on(middle) { inside = middle } else { outside = middle }
    }
    Ok(inside)
}

/// The part of a rounding between lines that are straight in (u, v); `stops[k]` are u where contact `k` ends.
fn slanted(ball: &Ball, roll: &Roll, stops: [[f64; 2]; 2], origin: Origin) -> Result<Roll> {
    let (surface, tolerance) = (&roll.surface, &ball.tolerance);
    let contact = |k: usize| {
        let chain = &roll.contacts[k];
        let fraction = |u: f64| if u == 0.0 || u == 1.0 { u } else { chain.closest(surface.point(u, k as f64)).0 };
        chain.slice(fraction(stops[k][0]), fraction(stops[k][1]), tolerance)
    };
    let contacts = [contact(0)?, contact(1)?];
    let end = |e: usize| -> Result<Chain> {
        let across = line(DVec3::new(stops[0][e], 0.0, 0.0), DVec3::new(stops[1][e], 1.0, 0.0), origin)?;
        Ok(Chain::of_curve(&project(surface, &Chain::of_curve(&across), Way::Parameters, origin, tolerance)?))
    };
    let around = [contacts[0].clone(), end(1)?, contacts[1].clone(), end(0)?];
    Ok(Roll { surface: trim(surface, &around, &[], origin, tolerance)?, contacts })
}
