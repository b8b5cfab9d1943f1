//! Whether a place lies in the kept part of a trimmed surface, exactly: by the angle that its borders turn about the place.

use glam::{DVec2, DVec3};

use crate::base::math;
use crate::base::predicates::{Side as Within, point_in_polygon};
use crate::base::tolerance::NUDGE;
use crate::network::Chain;
use crate::surface::closest::foot::foot;
use crate::surface::core::surface::Surface;
use crate::surface::rails::side::Side;
use crate::surface::rails::trim_curve::TrimCurve;

/// A value and those whole steps away that are between two others, those between 0 and 1 first.
pub(crate) fn within(x: f64, (low, high): (f64, f64)) -> Vec<f64> {
    let (first, last) = ((low - x - NUDGE).ceil() as i64, (high - x + NUDGE).floor() as i64);
    let mut turns: Vec<i64> = (first..=last).collect();
    turns.sort_by_key(|n| (n.abs(), -n));
    turns.into_iter().map(|n| x + n as f64).collect()
}

/// Halvings of a piece of a border, one after the other and in all: where a damaged border jumps to and fro each half may be as long.
const MAX_DEPTH: u32 = 40;
const MOST: u32 = 16 * MAX_DEPTH;

/// A fraction of a chain and its place.
type ChainFoot = (f64, DVec2);

impl Surface {
    /// A place and the same place whole turns away, round a surface that closes: of a trimmed surface all that its loops may hold.
    pub fn copies(&self, (u, v): (f64, f64)) -> Vec<DVec2> {
        let vs = self.copies_along(1, v);
        self.copies_along(0, u).into_iter().flat_map(|u| vs.iter().map(move |v| DVec2::new(u, *v))).collect()
    }

    /// The same of u alone (axis 0) or of v (axis 1).
    pub fn copies_along(&self, axis: usize, x: f64) -> Vec<f64> {
        let closed = if axis == 0 { self.closed().0 } else { self.closed().1 };
        match &self.parts().trim {
            _ if !closed => vec![x],
            None => vec![x, x + 1.0, x - 1.0],
            Some(trim) => within(x, (trim.reach.0[axis], trim.reach.1[axis])),
        }
    }

    /// Whether a place of a trimmed surface lies in the kept part; borders count as they run, not as polygons. `true` for a
    /// surface that is not trimmed.
    pub fn holds(&self, u: f64, v: f64) -> bool {
        let Some(trim) = &self.parts().trim else { return true };
        self.copies((u, v)).into_iter().any(|p| {
            let turns: f64 = trim.trim_curves.iter().enumerate().map(|(k, trim_curve)| self.turning(k, trim_curve, p)).sum();
            turns > std::f64::consts::PI
        })
    }

    /// Whether a point of space lies on the kept part or its border, within a distance, where its foot on the surface below is known.
    pub(crate) fn keeps_point(&self, p: DVec3, uv: DVec2, point: f64) -> bool {
        let on_border = |k: usize| match self.side(k) {
            Side::Chain { chain, .. } => chain.closest(p).2 <= point,
            _ => false,
        };
        self.parts().trim.is_none() || self.holds(uv.x, uv.y) || (0..self.n_sides()).any(on_border)
    }

    /// The angle by which border `k` turns about a place.
    fn turning(&self, k: usize, trim_curve: &TrimCurve, p: DVec2) -> f64 {
        match self.side(k) {
            Side::Chain { chain, .. } => self.turn_along(trim_curve, Some(&chain), p),
            _ => self.turn_along(trim_curve, None, p),
        }
    }

    /// The angle by which a way over the surface turns about a place; the chain is the one whose feet it has.
    pub(crate) fn turn_along(&self, trim_curve: &TrimCurve, chain: Option<&Chain>, p: DVec2) -> f64 {
        match trim_curve {
            TrimCurve::Line(a, b) => angle(DVec2::from(*a), DVec2::from(*b), p),
            TrimCurve::Pcurve(pcurve) => {
                let Some(chain) = chain else { return 0.0 };
                let turned = |(at, (low, high)): (&[(f64, DVec2)], (DVec2, DVec2))| {
                    // About a place outside the box that holds a way, the way turns as its chord does.
                    if p.cmplt(low).any() || p.cmpgt(high).any() {
                        return angle(at[0].1, at[at.len() - 1].1, p);
                    }
                    at.windows(2).map(|w| self.turn_of(chain, (w[0], w[1]), p, MAX_DEPTH, &mut { MOST })).sum()
                };
                pcurve.boxed_pieces().map(turned).sum()
            }
        }
    }

    /// The same for a piece of a chain between two of its feet, halved while the place may lie between it and its chord.
    fn turn_of(&self, chain: &Chain, ((fa, a), (fb, b)): (ChainFoot, ChainFoot), p: DVec2, deep: u32, left: &mut u32) -> f64 {
        let length = a.distance(b);
        let nearest = {
            let share = ((p - a).dot(b - a) / (length * length)).clamp(0.0, 1.0);
            if share.is_finite() { a.lerp(b, share) } else { a }
        };
        if nearest.distance(p) > length || deep == 0 || *left == 0 {
            return angle(a, b, p);
        }
        *left -= 1;
        let middle = 0.5 * (fa + fb);
        let guess = a.lerp(b, 0.5);
        let at = match self.flat_uv(chain.point(middle)) {
            Some((u, v)) => DVec2::new(u, v),
            None => foot(self.evaluator(), chain.point(middle), guess).0,
        };
        let first = self.turn_of(chain, ((fa, a), (middle, at)), p, deep - 1, left);
        first + self.turn_of(chain, ((middle, at), (fb, b)), p, deep - 1, left)
    }
}

/// The angle from one place to another, seen from a third.
fn angle(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    let (a, b) = (a - p, b - p);
    math::atan2(a.perp_dot(b), a.dot(b))
}

impl Surface {
    /// Whether a place lies in the kept part, by the polygons of [`Surface::outlines`].
    pub fn keeps(&self, u: f64, v: f64) -> bool {
        let outlines = self.outlines();
        self.copies((u, v)).into_iter().any(|p| outlines.iter().fold(false, |kept, polygon| kept != inside(polygon, p)))
    }
}

/// Whether a place is inside a polygon or on it.
pub(crate) fn inside(polygon: &[DVec2], p: DVec2) -> bool {
    point_in_polygon(p, polygon) != Within::Outside
}
