//! The frame of a path that turns about its corners: each run to its end, then a turn about the corner into the next one.

use glam::{DMat3, DVec3};

use crate::base::math;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::surface::shapes::matrices::Matrices;
use crate::surface::swept::laws::{halved, samples};
use crate::surface::swept::legs::Legs;

/// How a profile moves along a path with turns: u goes on while the path stands still in a corner.
pub struct Rounded {
    /// The rotation by u.
    pub turn: Matrices,
    /// u of the ends of runs, with the fractions of the path there, ascending; a turn has one fraction at both.
    pub stops: Vec<(f64, f64)>,
    /// Inner ends of turns, with their fractions.
    pub corners: Vec<(f64, f64)>,
    /// Fractions of the profile at which it crosses the axis of a turn.
    pub crossings: Vec<f64>,
    /// The point that is farthest on the inner side of a turn, and how far, where the profile reaches over to it.
    pub inside: Option<(DVec3, f64)>,
}

/// One turn about a corner.
struct RoundedTurn {
    axis: DVec3,
    angle: f64,
    base: DMat3,
    /// The largest distance of the profile from the axis.
    reach: f64,
}

impl Rounded {
    /// The turns of a profile about the corners of a path; `None` where no polynomial fits the frame.
    pub fn new(legs: &mut Legs, profile: &Chain, tolerance: &Tolerance) -> Option<Self> {
        let path = legs.path();
        let foot = path.start();
        let mut turns: Vec<Option<RoundedTurn>> = Vec::new();
        let (mut crossings, mut inside) = (Vec::new(), None::<(DVec3, f64)>);
        for k in 0..legs.count() {
            let Some((at, before, after)) = legs.corner_after(k) else {
                turns.push(None);
                continue;
            };
            let (axis, angle) = (before.cross(after).normalize_or_zero(), math::angle_between(before, after));
            let base = legs.turned(k, legs.run(k).1);
            // Forwards where it is on the outer side.
            let outwards = base.transpose() * before.cross(axis);
            let side = |f: f64| (profile.point(f) - foot).dot(outwards);
            let along = base.transpose() * axis;
            let arm = |f: f64| (profile.point(f) - foot).reject_from_normalized(along).length();
            let places = samples(profile);
            let reach = places.iter().map(|f| arm(*f)).fold(0.0, f64::max);
            // On the axis nothing moves.
            turns.push((reach > tolerance.point).then_some(RoundedTurn { axis, angle, base, reach }));
            let near = tolerance.point;
            let least = places.iter().copied().min_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(0.0);
            if side(least) < -near {
                let p = at + base * (profile.point(least) - foot);
                if inside.is_none_or(|(_, most)| -side(least) > most) {
                    inside = Some((p, -side(least)));
                }
            }
            for w in places.windows(2) {
                let (a, b) = (side(w[0]), side(w[1]));
                if (a < 0.0) != (b < 0.0) && a.abs().max(b.abs()) > near {
                    crossings.push(halved((w[0], w[1]), a < 0.0, side));
                }
            }
        }
        let near = tolerance.point / profile.length();
        crossings.sort_by(f64::total_cmp);
        crossings.dedup_by(|b, a| *b - *a <= near);
        crossings.retain(|f| *f > near && *f < 1.0 - near);
        let (turn, stops) = fitted(legs, &turns)?;
        let twice = |w: &[(f64, f64)]| w[0].1 == w[1].1;
        let inner = |s: &(f64, f64)| s.0 > 0.0 && s.0 < 1.0;
        let mut corners: Vec<(f64, f64)> = stops.windows(2).filter(|w| twice(w)).flat_map(|w| [w[0], w[1]]).filter(inner).collect();
        corners.extend(stops.iter().copied().filter(inner).filter(|s| legs.is_corner(s.1)));
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        corners.dedup();
        Some(Self { turn, stops, corners, crossings, inside })
    }

    /// The fraction of the path at u; none inside a turn.
    pub fn fraction(&self, u: f64) -> Option<f64> {
        let k = self.stops.partition_point(|s| s.0 <= u).clamp(1, self.stops.len() - 1);
        let (a, b) = (self.stops[k - 1], self.stops[k]);
        (a.1 != b.1).then(|| a.1 + (b.1 - a.1) * (u - a.0) / (b.0 - a.0))
    }
}

/// The rotations over u, and u with the fractions of the path at the ends of runs and turns.
fn fitted(legs: &mut Legs, turns: &[Option<RoundedTurn>]) -> Option<(Matrices, Vec<(f64, f64)>)> {
    let length = legs.path().length();
    let whole = length + turns.iter().flatten().map(|t| t.angle * t.reach).sum::<f64>();
    let mut all = Matrices::empty();
    let (mut gone, mut stops) = (0.0, vec![(0.0, 0.0)]);
    let last = turns.len() - 1;
    for (k, turn) in turns.iter().enumerate() {
        let (from, to) = legs.run(k);
        let start = gone;
        gone += (to - from) * length;
        let ends = k == last && turn.is_none();
        let u_of = |f: f64| if f == to && ends { 1.0 } else { (start + (f - from) * length) / whole };
        let breaks = [&[from][..], &legs.stops(k)].concat();
        for w in breaks.windows(2) {
            let (a, b) = (u_of(w[0]), u_of(w[1]));
            let mut of = |u: f64| legs.turned(k, if u >= b { w[1] } else { w[0] + (w[1] - w[0]) * (u - a) / (b - a) });
            if !all.fit((a, b), &mut of) {
                return None;
            }
        }
        stops.push((u_of(to), to));
        if let Some(turn) = turn {
            let a = u_of(to);
            gone += turn.angle * turn.reach;
            let b = if k == last { 1.0 } else { gone / whole };
            let mut of = |u: f64| about(turn.axis, turn.angle * (u - a) / (b - a)) * turn.base;
            if !all.fit((a, b), &mut of) {
                return None;
            }
            stops.push((b, to));
        }
    }
    Some((all, stops))
}

/// The rotation about a unit vector, radians.
fn about(axis: DVec3, angle: f64) -> DMat3 {
    let (sin, cos) = math::sin_cos(angle);
    let column = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}
