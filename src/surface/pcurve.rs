//! Where a curve that lies on a surface runs in (u, v): followed step by step, so that it never jumps to another sheet.

use std::cell::Cell;
use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};

use super::core::{Domain, Jet2, Side, Surface};
use super::foot::{Footing, step};
use super::quick::PowerForm;
use crate::base::tolerance::{EPSILON, NUDGE, POLE_STEP, SINGULAR};
use crate::network::Chain;

/// Steps between two breaks of a curve at the least.
const LEAST: usize = 8;
/// Largest share of a turn from one place to the next where a surface closes.
const TURN: f64 = 0.2;
/// Halvings of a step before it counts as a leap.
const MAX_DEPTH: u32 = 12;
/// How far a foot may be from where the last two places point, as a share of the step: a turn less than that is followed.
const BEND: f64 = 0.25;

/// How much more than at the stations beside it a way may bend between two of them.
const BENT: f64 = 4.0;
/// Steps of a stretch that has a box of its own.
const STRETCH: usize = 16;

/// What a border of a trimmed surface is in (u, v), from its start to its end in the loop's direction.
#[derive(Clone, Debug)]
pub(super) enum TrimCurve {
    /// A straight line.
    Line((f64, f64), (f64, f64)),
    /// The feet of a chain.
    Pcurve(Arc<Pcurve>),
}

impl TrimCurve {
    /// The same backwards, in other parameters.
    pub fn flipped(&self, turn: &dyn Fn((f64, f64)) -> (f64, f64)) -> Self {
        match self {
            Self::Line(a, b) => Self::Line(turn(*b), turn(*a)),
            Self::Pcurve(pcurve) => {
                let at = pcurve.at.iter().rev().map(|(f, uv)| (*f, turn((uv.x, uv.y)).into()));
                Self::Pcurve(Arc::new(Pcurve::new(at.collect(), pcurve.off)))
            }
        }
    }

    /// The same backwards.
    pub fn turned(&self) -> Self {
        match self {
            Self::Line(a, b) => Self::Line(*b, *a),
            Self::Pcurve(pcurve) => Self::Pcurve(Arc::new(pcurve.turned())),
        }
    }

    /// Whether a straight line passes a place within a distance in (u, v); a curve is not asked.
    pub fn touches(&self, p: DVec2, distance: f64) -> bool {
        let Self::Line(a, b) = self else { return false };
        let (a, b) = (DVec2::from(*a), DVec2::from(*b));
        let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        a.lerp(b, share).distance(p) <= distance
    }

    /// Whether all of it is a line along which a parameter is whole: the seam of a surface that closes in that direction.
    pub fn is_seam(&self, closed: (bool, bool)) -> bool {
        let places = self.places();
        let whole = |x: fn(&DVec2) -> f64| places.iter().all(|p| (x(p) - x(&places[0]).round()).abs() <= NUDGE);
        closed.0 && whole(|p| p.x) || closed.1 && whole(|p| p.y)
    }

    /// Shifted in (u, v).
    pub fn shifted(&self, by: DVec2) -> Self {
        self.mapped(&|(u, v)| (u + by.x, v + by.y))
    }

    /// In other parameters; a line stays one, between other ends.
    pub fn mapped(&self, to: &dyn Fn((f64, f64)) -> (f64, f64)) -> Self {
        match self {
            Self::Line(a, b) => Self::Line(to(*a), to(*b)),
            Self::Pcurve(pcurve) => {
                let at = pcurve.at.iter().map(|(f, uv)| (*f, to((uv.x, uv.y)).into())).collect();
                Self::Pcurve(Arc::new(Pcurve::new(at, pcurve.off)))
            }
        }
    }

    /// Whether it stays what it is where u and v are mapped each by itself: an oblique straight line does not.
    pub fn is_upright(&self) -> bool {
        !matches!(self, Self::Line(a, b) if a.0 != b.0 && a.1 != b.1)
    }

    /// Places along it, ends included.
    pub fn places(&self) -> Vec<DVec2> {
        match self {
            Self::Line(a, b) => vec![DVec2::new(a.0, a.1), DVec2::new(b.0, b.1)],
            Self::Pcurve(pcurve) => pcurve.at.iter().map(|s| s.1).collect(),
        }
    }
}

/// A chain's places on a surface at fractions of the chain, in the order of the loop.
#[derive(Clone, Debug)]
pub(super) struct Pcurve {
    at: Vec<(f64, DVec2)>,
    /// The largest distance from the surface met on the way, model units.
    pub off: f64,
    /// Boxes about stretches of [`STRETCH`] steps, made when first asked for.
    boxes: OnceLock<Box<[(DVec2, DVec2)]>>,
}

/// Where a curve is too far from the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Off {
    /// The point of the curve.
    pub at: DVec3,
    /// How far it is, model units.
    pub distance: f64,
}

impl Pcurve {
    fn new(at: Vec<(f64, DVec2)>, off: f64) -> Self {
        Self { at, off, boxes: OnceLock::new() }
    }

    /// Stretches of the way, each with a box that holds it: about its stations, and farther by its longest step.
    pub fn stretches(&self) -> impl Iterator<Item = (&[(f64, DVec2)], (DVec2, DVec2))> {
        let stretch = |k: usize| &self.at[k * STRETCH..(k * STRETCH + STRETCH + 1).min(self.at.len())];
        let boxed = |at: &[(f64, DVec2)]| {
            let step = at.windows(2).map(|w| w[0].1.distance(w[1].1)).fold(0.0, f64::max);
            let low = at.iter().fold(DVec2::INFINITY, |low, s| low.min(s.1));
            let high = at.iter().fold(DVec2::NEG_INFINITY, |high, s| high.max(s.1));
            (low - step, high + step)
        };
        let n = (self.at.len() - 1).div_ceil(STRETCH);
        let boxes = self.boxes.get_or_init(|| (0..n).map(|k| boxed(stretch(k))).collect());
        boxes.iter().enumerate().map(move |(k, held)| (stretch(k), *held))
    }

    /// Follows a chain between two fractions from a place near its first point; fails where it is farther from the surface
    /// than `near`.
    ///
    /// From a pole, where u (or v) says nothing, the way is found from the other end.
    pub fn follow(surface: &Surface, (chain, from, to): (&Chain, f64, f64), start: DVec2, near: f64) -> Result<Self, Off> {
        if is_pole(surface, start) {
            let end = super::closest::closest(surface, chain.point(to)).uv.into();
            if !is_pole(surface, end) {
                return Self::along(surface, (chain, to, from), end, near).map(|pcurve| pcurve.turned());
            }
        }
        Self::along(surface, (chain, from, to), start, near)
    }

    fn along(surface: &Surface, (chain, from, to): (&Chain, f64, f64), start: DVec2, near: f64) -> Result<Self, Off> {
        let stops = super::breaks::chain_breaks(chain);
        let (low, high) = (from.min(to), from.max(to));
        let mut cuts: Vec<f64> = stops.into_iter().filter(|f| *f > low && *f < high).collect();
        cuts.insert(0, low);
        cuts.push(high);
        if from > to {
            cuts.reverse();
        }
        let widest = Cell::new(0.0_f64);
        let land = |f: f64, guess: DVec2| -> Result<DVec2, Off> {
            let p = chain.point(f);
            let (uv, distance) = foot((surface, None), p, guess);
            if distance > near {
                return Err(Off { at: p, distance });
            }
            widest.set(widest.get().max(distance));
            Ok(uv)
        };
        let mut at = vec![(from, land(from, start)?)];
        for w in cuts.windows(2) {
            for k in 1..=LEAST {
                let f = if k == LEAST { w[1] } else { w[0] + (w[1] - w[0]) * k as f64 / LEAST as f64 };
                walk(surface, chain, &mut at, f, &land, MAX_DEPTH)?;
            }
        }
        Ok(Self::new(at, widest.get()))
    }

    /// The same in the other direction.
    pub fn turned(&self) -> Self {
        Self::new(self.at.iter().rev().copied().collect(), self.off)
    }

    /// The first and the last place.
    pub fn ends(&self) -> (DVec2, DVec2) {
        (self.at[0].1, self.at[self.at.len() - 1].1)
    }

    /// This way and then another that goes on from its end.
    pub fn then(mut self, more: &Self) -> Self {
        self.at.extend(more.at.iter().skip(1));
        Self::new(self.at, self.off)
    }

    /// The same with an end, the last one or the first, at another place.
    pub fn ending(mut self, last: bool, place: DVec2) -> Self {
        let k = if last { self.at.len() - 1 } else { 0 };
        self.at[k].1 = place;
        Self::new(self.at, self.off)
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
                foot((surface, None), chain.point(f), self.guess(f)).0
            };
            let held = surface.hold(end);
            let jet = surface.jet(held.x, held.y);
            let limit = before(1.0) * 3.0 - before(2.0) * 3.0 + before(3.0);
            let place = if jet.du.length() < jet.dv.length() { DVec2::new(limit.x, end.y) } else { DVec2::new(end.x, limit.y) };
            self = self.ending(last, place);
        }
        self
    }

    /// The chain's fraction at a share of the way.
    pub fn fraction(&self, share: f64) -> f64 {
        let (from, to) = (self.at[0].0, self.at[self.at.len() - 1].0);
        from + (to - from) * share
    }

    /// About where a share of the way lies.
    pub fn share(&self, share: f64) -> DVec2 {
        self.guess(self.fraction(share))
    }

    /// About where a fraction of the chain lies.
    pub fn guess(&self, f: f64) -> DVec2 {
        let k = self.after(f);
        let ((a, p), (b, q)) = (self.at[k - 1], self.at[k]);
        p.lerp(q, ((f - a) / (b - a)).clamp(0.0, 1.0))
    }

    /// The first station, but for the start, that a fraction does not pass.
    fn after(&self, f: f64) -> usize {
        let ascending = self.at[0].0 <= self.at[self.at.len() - 1].0;
        self.at.partition_point(|s| if ascending { s.0 < f } else { s.0 > f }).clamp(1, self.at.len() - 1)
    }

    /// About where a fraction of the chain lies, and how far from there it may be: by how much the way bends at the stations on the
    /// smoother side, for a kink lies at a station.
    pub fn about(&self, f: f64) -> (DVec2, f64) {
        let k = self.after(f);
        let (a, b) = (self.at[k - 1].0, self.at[k].0);
        let slope = |i: usize| (self.at[i].1 - self.at[i - 1].1) / (self.at[i].0 - self.at[i - 1].0);
        let bend = |i: usize| {
            let inside = i > 0 && i + 1 < self.at.len();
            inside.then(|| 2.0 * (slope(i + 1) - slope(i)).length() / (self.at[i + 1].0 - self.at[i - 1].0).abs())
        };
        let most = |i: Option<usize>, j: usize| i.and_then(bend).into_iter().chain(bend(j)).reduce(f64::max);
        let (before, after) = (most((k - 1).checked_sub(1), k - 1), most(Some(k + 1), k));
        let bent = match (before, after) {
            (Some(x), Some(y)) => x.min(y),
            (x, y) => x.or(y).unwrap_or(0.0),
        };
        (self.guess(f), BENT * 0.5 * bent * ((f - a) * (b - f)).abs())
    }
}

/// Whether the surface stands still at a place in one direction, or the place lies on a side that is a point within the tolerance.
pub(super) fn is_pole(surface: &Surface, uv: DVec2) -> bool {
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
        Some(trim) => trim.courses.iter().enumerate().any(|(k, course)| is_pole(k) && course.touches(uv, NUDGE)),
        None if parts.domain == Domain::Square => {
            let off = [uv.y, 1.0 - uv.x, 1.0 - uv.y, uv.x];
            off.iter().enumerate().any(|(k, off)| is_pole(k) && off.abs() <= NUDGE)
        }
        None => false,
    }
}

/// Goes on to a fraction, in smaller steps where the way bends or the foot leaps.
fn walk(
    surface: &Surface,
    chain: &Chain,
    at: &mut Vec<(f64, DVec2)>,
    to: f64,
    land: &impl Fn(f64, DVec2) -> Result<DVec2, Off>,
    left: u32,
) -> Result<(), Off> {
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
            let sure = (!closed_u || moved.x.abs() <= TURN) && (!closed_v || moved.y.abs() <= TURN);
            sure && (moved - ahead).length() <= BEND * moved.length().max(ahead.length()) || moved.length() <= EPSILON.sqrt()
        }
        Err(_) => false,
    };
    if fine || left == 0 {
        at.push((to, next?));
        return Ok(());
    }
    let middle = 0.5 * (from + to);
    walk(surface, chain, at, middle, land, left - 1)?;
    walk(surface, chain, at, to, land, left - 1)
}

/// Feet on a surface, held in the parts of (u, v) where it is.
struct Whole<'a>(&'a Surface, Option<&'a PowerForm>);

impl Footing for Whole<'_> {
    fn jet(&self, uv: DVec2) -> Jet2 {
        self.0.jet_by(self.1, uv.x, uv.y)
    }

    fn hold(&self, uv: DVec2) -> DVec2 {
        self.0.hold(uv)
    }
}

/// The foot of a point near a guess, with its distance; by the surface made ready, where it is.
pub(super) fn foot((surface, quick): (&Surface, Option<&PowerForm>), p: DVec3, guess: DVec2) -> (DVec2, f64) {
    Whole(surface, quick).foot(p, guess)
}
