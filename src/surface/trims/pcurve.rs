//! Where a curve that lies on a surface runs in (u, v): followed step by step, so that it never jumps to another sheet.

use std::cell::Cell;

use glam::{DVec2, DVec3};

use crate::base::tolerance::{EPSILON, NUDGE, POLE_STEP, SINGULAR};
use crate::network::Chain;
use crate::surface::closest::foot::{foot, step};
use crate::surface::closest::nearest::closest;
use crate::surface::core::surface::Surface;
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::kind::Domain;
use crate::surface::rails::side::Side;
use crate::surface::rails::trim_curve::Pcurve;

/// What steers the steps in which a curve is followed in (u, v).
struct Following {
    /// Steps between two breaks of a curve at the least.
    least_steps: usize,
    /// Largest share of a turn from one place to the next where a surface closes.
    largest_turn_share: f64,
    /// Halvings of a step before it counts as a leap.
    max_halvings: u32,
    /// How far a foot may be from where the last two places point, as a share of the step: a turn less than that is followed.
    largest_bend_share: f64,
}

const FOLLOW: Following = Following { least_steps: 8, largest_turn_share: 0.2, max_halvings: 12, largest_bend_share: 0.25 };

/// Where a curve is too far from the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OffSurface {
    /// The point of the curve.
    pub at: DVec3,
    /// How far it is, model units.
    pub distance: f64,
}

impl Pcurve {
    /// Follows a chain between two fractions from a place near its first point; fails where it is farther from the surface
    /// than `near`.
    ///
    /// From a pole, where u (or v) says nothing, the way is found from the other end.
    pub fn follow(surface: &Surface, chain: &Chain, (from, to): (f64, f64), start: DVec2, near: f64) -> Result<Self, OffSurface> {
        if is_pole(surface, start) {
            let end = closest(surface, chain.point(to)).uv.into();
            if !is_pole(surface, end) {
                return Self::along(surface, chain, (to, from), end, near).map(|pcurve| pcurve.turned());
            }
        }
        Self::along(surface, chain, (from, to), start, near)
    }

    fn along(surface: &Surface, chain: &Chain, (from, to): (f64, f64), start: DVec2, near: f64) -> Result<Self, OffSurface> {
        let stops = chain_breaks(chain);
        let (low, high) = (from.min(to), from.max(to));
        let mut cuts: Vec<f64> = stops.into_iter().filter(|f| *f > low && *f < high).collect();
        cuts.insert(0, low);
        cuts.push(high);
        if from > to {
            cuts.reverse();
        }
        let widest = Cell::new(0.0_f64);
        let land = |f: f64, guess: DVec2| -> Result<DVec2, OffSurface> {
            let p = chain.point(f);
            let (mut uv, mut distance) = foot(surface.evaluator(), p, guess);
            if distance > near && !surface.is_flat() {
                // On a crease the steps to a foot go by the derivatives of one side, and lead nowhere from the other.
                let best = closest(&surface.untrimmed(), p);
                let off = |place: &DVec2| (*place - guess).length();
                if let Some(place) = surface.copies(best.uv).into_iter().min_by(|a, b| off(a).total_cmp(&off(b))) {
                    (uv, distance) = (place, best.distance);
                }
            }
            if distance > near {
                return Err(OffSurface { at: p, distance });
            }
            widest.set(widest.get().max(distance));
            Ok(uv)
        };
        let mut at = vec![(from, land(from, start)?)];
        for w in cuts.windows(2) {
            for k in 1..=FOLLOW.least_steps {
                let f = if k == FOLLOW.least_steps { w[1] } else { w[0] + (w[1] - w[0]) * k as f64 / FOLLOW.least_steps as f64 };
                follow_to(surface, chain, &mut at, f, &land, FOLLOW.max_halvings)?;
            }
        }
        Ok(Self::new(at, widest.get()))
    }

    /// The same with its ends at poles where the way before them points: there every u (or v) is the same point.
    pub fn into_poles(mut self, surface: &Surface, chain: &Chain) -> Self {
        for last in [false, true] {
            let end = if last { self.ends().1 } else { self.ends().0 };
            if !is_pole(surface, end) {
                continue;
            }
            let before = |k: f64| {
                let f = self.fraction(if last { 1.0 - k * POLE_STEP } else { k * POLE_STEP });
                foot(surface.evaluator(), chain.point(f), self.guess(f)).0
            };
            let held = surface.hold(end);
            let jet = surface.jet(held.x, held.y);
            let limit = before(1.0) * 3.0 - before(2.0) * 3.0 + before(3.0);
            let place = if jet.du.length() < jet.dv.length() { DVec2::new(limit.x, end.y) } else { DVec2::new(end.x, limit.y) };
            self = self.ending(last, place);
        }
        self
    }
}

/// Whether the surface stands still at a place in one direction, or the place lies on a side that is a point within the tolerance.
pub(crate) fn is_pole(surface: &Surface, uv: DVec2) -> bool {
    let uv = surface.hold(uv);
    let jet = surface.jet(uv.x, uv.y);
    let (du, dv) = (jet.du.length(), jet.dv.length());
    du.min(dv) <= SINGULAR * du.max(dv) || on_pole_side(surface, uv)
}

/// Whether a place lies on a border that is one point.
fn on_pole_side(surface: &Surface, uv: DVec2) -> bool {
    let parts = surface.parts();
    let is_pole = |k: usize| parts.borders.get(k).is_some_and(|border| matches!(border.side, Side::Pole(_)));
    match &parts.trim {
        Some(trim) => trim.trim_curves.iter().enumerate().any(|(k, trim_curve)| is_pole(k) && trim_curve.touches(uv, NUDGE)),
        None if parts.domain == Domain::Square => {
            let off = [uv.y, 1.0 - uv.x, 1.0 - uv.y, uv.x];
            off.iter().enumerate().any(|(k, off)| is_pole(k) && off.abs() <= NUDGE)
        }
        None => false,
    }
}

/// Goes on to a fraction, in smaller steps where the way bends or the foot leaps.
fn follow_to(
    surface: &Surface,
    chain: &Chain,
    at: &mut Vec<(f64, DVec2)>,
    to: f64,
    land: &impl Fn(f64, DVec2) -> Result<DVec2, OffSurface>,
    left: u32,
) -> Result<(), OffSurface> {
    let (from, here) = at[at.len() - 1];
    // First order: the tangent's foot in (u, v).
    let jet = surface.jet(here.x, here.y);
    let d1 = chain.jet(from.min(to).max(0.0)).d1;
    let ahead = if at.len() > 1 {
        let (before, there) = at[at.len() - 2];
        (here - there) * ((to - from) / (from - before))
    } else {
        step(jet.du, jet.dv, d1 * (to - from)).unwrap_or(DVec2::ZERO)
    };
    let next = land(to, here + ahead);
    let fine = match &next {
        Ok(uv) => {
            let moved = *uv - here;
            // Beside a pole the other way round leads to the same place.
            let (closed_u, closed_v) = surface.closed();
            let sure =
                (!closed_u || moved.x.abs() <= FOLLOW.largest_turn_share) && (!closed_v || moved.y.abs() <= FOLLOW.largest_turn_share);
            sure && (moved - ahead).length() <= FOLLOW.largest_bend_share * moved.length().max(ahead.length())
                || moved.length() <= EPSILON.sqrt()
        }
        Err(_) => false,
    };
    if fine || left == 0 {
        at.push((to, next?));
        return Ok(());
    }
    let middle = 0.5 * (from + to);
    follow_to(surface, chain, at, middle, land, left - 1)?;
    follow_to(surface, chain, at, to, land, left - 1)
}
