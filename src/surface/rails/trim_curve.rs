//! Where the borders of a trimmed surface run in (u, v).

use std::sync::{Arc, OnceLock};

use glam::DVec2;

use crate::base::tolerance::NUDGE;

/// How much more than at the stations beside it a way may bend between two of them.
const BENT: f64 = 4.0;
/// Steps of a piece that has a box of its own.
const PIECE_STEPS: usize = 16;

/// What a border of a trimmed surface is in (u, v), from its start to its end in the loop's direction.
#[derive(Clone, Debug)]
pub(crate) enum TrimCurve {
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

    /// Whether the chords between its places pass a place within a distance in (u, v).
    pub fn passes(&self, p: DVec2, distance: f64) -> bool {
        self.places().windows(2).any(|w| Self::Line(w[0].into(), w[1].into()).touches(p, distance))
    }

    /// About where a share of the way lies.
    pub fn share(&self, share: f64) -> DVec2 {
        match self {
            Self::Line(a, b) => DVec2::from(*a).lerp(DVec2::from(*b), share),
            Self::Pcurve(pcurve) => pcurve.share(share),
        }
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
pub(crate) struct Pcurve {
    at: Vec<(f64, DVec2)>,
    /// The largest distance from the surface met on the way, model units.
    pub off: f64,
    /// Boxes about pieces of [`PIECE_STEPS`] steps, made when first asked for.
    boxes: OnceLock<Box<[(DVec2, DVec2)]>>,
}

impl Pcurve {
    pub(crate) fn new(at: Vec<(f64, DVec2)>, off: f64) -> Self {
        Self { at, off, boxes: OnceLock::new() }
    }

    /// Pieces of the way, each with a box that holds it: about its stations, and farther by its longest step.
    pub fn boxed_pieces(&self) -> impl Iterator<Item = (&[(f64, DVec2)], (DVec2, DVec2))> {
        let piece = |k: usize| &self.at[k * PIECE_STEPS..(k * PIECE_STEPS + PIECE_STEPS + 1).min(self.at.len())];
        let boxed = |at: &[(f64, DVec2)]| {
            let step = at.windows(2).map(|w| w[0].1.distance(w[1].1)).fold(0.0, f64::max);
            let low = at.iter().fold(DVec2::INFINITY, |low, s| low.min(s.1));
            let high = at.iter().fold(DVec2::NEG_INFINITY, |high, s| high.max(s.1));
            (low - step, high + step)
        };
        let n = (self.at.len() - 1).div_ceil(PIECE_STEPS);
        let boxes = self.boxes.get_or_init(|| (0..n).map(|k| boxed(piece(k))).collect());
        boxes.iter().enumerate().map(move |(k, held)| (piece(k), *held))
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
