//! The line along which two patches touch without crossing, as a tube that lies on a plate does.
//!
//! ```text
//!   f(u, v) = (A(u, v) − B(foot)) · n      the gap from the first patch to the second, n the normal of the second at the foot
//!   e₁, e₂                                 principal directions of f: it stays along e₁, and rises on both sides along e₂
//!   ∇f · e₂ = 0                            the line
//! ```

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::math;
use crate::base::tolerance::{EPSILON, NUDGE};
use crate::surface::closest::foot::{self, FootSearch};
use crate::surface::intersect::fit_branch::{Branch, SHARE};
use crate::surface::intersect::pair::{Pair, Spot};
use crate::surface::intersect::sheet::Cell;
use crate::surface::trims::project::{Landing, cubics};

/// Limits of the march along a touch.
struct Touching {
    /// Newton steps to a place.
    steps: usize,
    /// Longest Newton step, as a share of the domain.
    leap: f64,
    /// First and largest step along the line, as shares of the size of the pair.
    first_share: f64,
    largest_share: f64,
    /// Largest turn from one place to the next, as a cosine, and the one below which steps grow.
    turn_cosines: (f64, f64),
    /// Halvings of a step down to a border.
    halvings: usize,
    /// Places in a row at most.
    max_places: usize,
    /// The patches part across the line so that they are within the tolerance over no more than this share of the pair.
    widest_share: f64,
    /// By how many roundings of a coordinate the vector to a foot may lean: more is beyond a border.
    lean: f64,
    /// Places of a line from each place of the march to the next.
    places_between: usize,
    /// A line is longer than so many widths.
    least_widths: f64,
}

const TOUCH: Touching = Touching {
    steps: 32,
    leap: 0.25,
    first_share: 1.0 / 64.0,
    largest_share: 1.0 / 16.0,
    turn_cosines: (0.97, 0.995),
    halvings: 52,
    max_places: 4096,
    widest_share: 1.0 / 16.0,
    lean: 1024.0,
    places_between: 8,
    least_widths: 4.0,
};

/// A place where the patches are nearest to each other across a line.
#[derive(Clone, Copy)]
pub(crate) struct Ridge {
    a: DVec2,
    b: DVec2,
    pub p: DVec3,
    /// Unit direction of the line.
    way: DVec3,
    /// Within what distance the patches may cross by less than the tolerance, at the most.
    pub width: f64,
}

/// The gap at a place with its first and second derivatives, in the principal directions.
struct Gap {
    b: DVec2,
    p: DVec3,
    /// Of the second patch.
    normal: DVec3,
    value: f64,
    /// Steps in (u, v) of the first patch of unit length along and across the line, and both in space.
    along: (DVec2, DVec3),
    across: (DVec2, DVec3),
    /// Slope and bend across.
    slope: f64,
    bend: f64,
    /// How far the vector to the foot leans from the normal.
    lean: f64,
}

/// Two patches that touch, and the size of the smaller one.
pub(crate) struct Touch<'a> {
    pub pair: &'a Pair<'a>,
    pub size: f64,
}

impl Touch<'_> {
    /// The whole line along which the patches touch through a place, from border to border or closed. `None` where they do not, where
    /// they part within the line, and where they stay together on both sides of it.
    pub fn line(&self, start: Ridge) -> Option<Branch> {
        let (mut ridges, closed) = self.run_along(start)?;
        if !closed {
            let back = Ridge { way: -start.way, ..start };
            let (behind, _) = self.run_along(back)?;
            let mut all: Vec<Ridge> = behind.into_iter().skip(1).map(|r| Ridge { way: -r.way, ..r }).collect();
            all.reverse();
            all.append(&mut ridges);
            ridges = all;
        }
        // A short line is a touching point.
        let length: f64 = ridges.windows(2).map(|w| w[0].p.distance(w[1].p)).sum();
        if length <= TOUCH.least_widths * start.width {
            return None;
        }
        let mut pieces = Vec::new();
        for (k, w) in ridges.windows(2).enumerate() {
            let from = k as f64;
            let land = |f: f64, _: Option<DVec2>, _: bool| self.between(&w[0], &w[1], f - from).ok_or(());
            pieces.extend(cubics(&[from, from + 1.0], SHARE * self.pair.point, land, |_| ()).ok()?);
        }
        let spots = ridges.iter().map(|r| Spot { a: r.a, b: r.b, p: r.p, way: r.way, sine: 0.0 }).collect();
        Some(Branch { spots, cubics: pieces })
    }

    /// Places of a line in both (u, v), several from each of its places to the next.
    pub fn places(&self, line: &Branch) -> Vec<[DVec2; 2]> {
        let first = line.spots.first().map(|spot| [spot.a, spot.b]);
        let between = line.spots.windows(2).flat_map(|w| {
            (1..=TOUCH.places_between).map(|k| {
                let share = k as f64 / TOUCH.places_between as f64;
                let chord = w[1].p - w[0].p;
                let (a, b) = (w[0].a.lerp(w[1].a, share), w[0].b.lerp(w[1].b, share));
                let plane = (w[0].p + chord * share, chord.normalize_or_zero());
                let inner = if k < TOUCH.places_between { self.ridge(a, b, Some(plane)) } else { None };
                inner.map_or([a, b], |ridge| [ridge.a, ridge.b])
            })
        });
        first.into_iter().chain(between).collect()
    }

    /// Whether the patches part beside a line that passes through a cell of the first one: at the corners of the cell by a quarter at least of
    /// what their bend at the line tells.
    pub fn parts_beside(&self, x: &Cell, near: DVec2) -> bool {
        let Some(ridge) = self.ridge(x.middle(), near, None) else { return false };
        let Some(middle) = self.gap(ridge.a, ridge.b) else { return false };
        [(x.u.0, x.v.0), (x.u.1, x.v.0), (x.u.0, x.v.1), (x.u.1, x.v.1)].into_iter().all(|corner| {
            self.gap(corner.into(), ridge.b).is_some_and(|gap| {
                let aside = (gap.p - ridge.p).reject_from(ridge.way).length();
                let wanted = 0.25 * 0.5 * middle.bend.abs() * aside * aside - 2.0 * self.pair.point;
                gap.value * middle.bend.signum() >= wanted
            })
        })
    }

    /// The gap at a place of the first patch; `None` where a patch is singular or the gap bends in no direction.
    fn gap(&self, a: DVec2, near: DVec2) -> Option<Gap> {
        let s = self.pair.a.jet(a);
        let b = self.pair.b.foot(s.p, near).0;
        let t = self.pair.b.jet(b);
        let n = t.du.cross(t.dv).try_normalize()?;
        let off = s.p - t.p;
        // Second derivatives: of the first patch along the normal, less those of the second one over the same way.
        let (x, y) = (foot::step(t.du, t.dv, s.du)?, foot::step(t.du, t.dv, s.dv)?);
        let bent = |p: DVec2, q: DVec2| t.duu.dot(n) * p.x * q.x + t.duv.dot(n) * (p.x * q.y + p.y * q.x) + t.dvv.dot(n) * p.y * q.y;
        let h = [s.duu.dot(n) - bent(x, x), s.duv.dot(n) - bent(x, y), s.dvv.dot(n) - bent(y, y)];
        // An orthonormal frame of the tangent plane of the first patch, and its steps in (u, v).
        let e = s.du.try_normalize()?;
        let f = s.du.cross(s.dv).cross(e).try_normalize()?;
        let (along_e, along_f) = (foot::step(s.du, s.dv, e)?, foot::step(s.du, s.dv, f)?);
        let second = |p: DVec2, q: DVec2| h[0] * p.x * q.x + h[1] * (p.x * q.y + p.y * q.x) + h[2] * p.y * q.y;
        let (ee, ef, ff) = (second(along_e, along_e), second(along_e, along_f), second(along_f, along_f));
        let half = 0.5 * (ee - ff);
        let root = math::hypot(half, ef);
        let mean = 0.5 * (ee + ff);
        let bend = if mean >= 0.0 { mean + root } else { mean - root };
        // The eigenvector of the larger eigenvalue, by the longer of two forms of it.
        let (p, q) = (DVec2::new(bend - ff, ef), DVec2::new(ef, bend - ee));
        let main = if p.length() >= q.length() { p } else { q }.try_normalize()?;
        let turn = |w: DVec2| (along_e * w.x + along_f * w.y, e * w.x + f * w.y);
        let (across, along) = (turn(main), turn(main.perp()));
        Some(Gap {
            b,
            p: s.p.midpoint(t.p),
            normal: n,
            value: off.dot(n),
            along,
            across,
            slope: across.1.dot(n),
            bend,
            lean: off.reject_from_normalized(n).length(),
        })
    }

    /// The place of the line near another one, in a plane through a point with a normal if that is given; `None` beyond a border and where
    /// the patches are not within the tolerance.
    pub fn ridge(&self, a: DVec2, b: DVec2, plane: Option<(DVec3, DVec3)>) -> Option<Ridge> {
        let (mut a, mut b, mut held) = (a, b, false);
        for _ in 0..TOUCH.steps {
            let gap = self.gap(a, b)?;
            let sideways = -gap.slope / gap.bend;
            let onward = plane.map_or(0.0, |(p, n)| ((p - gap.p).dot(n) - gap.across.1.dot(n) * sideways) / gap.along.1.dot(n));
            let step = gap.across.0 * sideways + gap.along.0 * onward;
            if !step.is_finite() {
                return None;
            }
            let free = a + step.clamp(DVec2::splat(-TOUCH.leap), DVec2::splat(TOUCH.leap));
            (a, b) = (self.pair.a.hold(free), gap.b);
            held = a.distance(free) > NUDGE * NUDGE;
            if step.abs().max_element() <= EPSILON {
                break;
            }
        }
        let gap = self.gap(a, b)?;
        // Twice the tolerance is the most by which they part beside the line and are within it.
        let width = 2.0 * (self.pair.point / gap.bend.abs()).sqrt();
        let narrow = width <= TOUCH.widest_share * self.size;
        // Along the line they part no faster than across it within the tolerance: else they cross there.
        let is_slow = gap.along.1.dot(gap.normal).abs() <= (gap.bend * self.pair.point).abs().sqrt();
        let is_there =
            !held && gap.value.abs() <= self.pair.point && gap.lean <= TOUCH.lean * EPSILON * self.size.max(gap.p.abs().max_element());
        (narrow && is_slow && is_there).then_some(Ridge { a, b: gap.b, p: gap.p, way: gap.along.1, width })
    }

    /// Whether a common place is part of a touch: no farther from the line than the patches may cross within the tolerance.
    pub fn has(&self, spot: &Spot) -> bool {
        self.ridge(spot.a, spot.b, None).is_some_and(|ridge| ridge.p.distance(spot.p) <= ridge.width)
    }

    /// Places along the line one way, and whether it came back to the start; `None` where the patches part.
    fn run_along(&self, start: Ridge) -> Option<(Vec<Ridge>, bool)> {
        let mut ridges = vec![start];
        let mut h = TOUCH.first_share * self.size;
        while ridges.len() < TOUCH.max_places {
            job::poll();
            let here = ridges[ridges.len() - 1];
            let Some(next) = self.onward(&here, h) else {
                // The longest step that stays on both, to rounding: there a border is, or the step was too long to find the line again.
                let (mut low, mut high) = (0.0, h);
                let mut last = None;
                for _ in 0..TOUCH.halvings {
                    let middle = 0.5 * (low + high);
                    match self.onward(&here, middle) {
                        Some(there) => (low, last) = (middle, Some(there)),
                        None => high = middle,
                    }
                }
                let end = last.unwrap_or(here);
                if self.is_at_border(&end) {
                    ridges.extend(last.filter(|last| last.p.distance(here.p) > EPSILON * self.size));
                    return Some((ridges, false));
                }
                h *= 0.5;
                if h < start.width.max(NUDGE * self.size) {
                    return None;
                }
                continue;
            };
            let cosine = next.way.dot(here.way);
            if cosine < TOUCH.turn_cosines.0 {
                h *= 0.5;
                if h < NUDGE * self.size {
                    return None;
                }
                continue;
            }
            let chord = next.p - here.p;
            let share = (start.p - here.p).dot(chord) / chord.length_squared();
            if ridges.len() > 2 && (0.0..=1.0).contains(&share) && start.p.distance(here.p + chord * share) <= 0.25 * chord.length() {
                ridges.push(start);
                return Some((ridges, true));
            }
            ridges.push(next);
            if cosine >= TOUCH.turn_cosines.1 {
                h = (1.5 * h).min(TOUCH.largest_share * self.size);
            }
        }
        None
    }

    /// The place a step further on, in the direction of the march.
    fn onward(&self, here: &Ridge, h: f64) -> Option<Ridge> {
        let (s, t) = (self.pair.a.jet(here.a), self.pair.b.jet(here.b));
        let step = here.way * h;
        let (a, b) = (here.a + foot::step(s.du, s.dv, step)?, here.b + foot::step(t.du, t.dv, step)?);
        let next = self.ridge(a, self.pair.b.hold(b), Some((here.p + step, here.way)))?;
        let near = (next.p - here.p).length() <= 1.5 * h;
        near.then(|| if next.way.dot(here.way) < 0.0 { Ridge { way: -next.way, ..next } } else { next })
    }

    /// Whether a line passes through a place, in both (u, v): where a patch closes its seam is two places.
    pub fn passes(&self, line: &Branch, at: &Ridge) -> bool {
        line.spots.windows(2).any(|w| {
            let chord = w[1].p - w[0].p;
            let (length, share) = (chord.length(), (at.p - w[0].p).dot(chord) / chord.length_squared());
            let is_near = (-0.01..=1.01).contains(&share) && (w[0].p + chord * share).distance(at.p) <= 0.5 * length;
            let on = || self.ridge(w[0].a.lerp(w[1].a, share), w[0].b.lerp(w[1].b, share), Some((at.p, chord / length)));
            let same = |on: Ridge| on.p.distance(at.p) <= self.pair.point && on.a.distance(at.a).max(on.b.distance(at.b)) <= NUDGE.sqrt();
            is_near && on().is_some_and(same)
        })
    }

    /// Whether a place is on a border of either patch, but for what a step to a border may be short of.
    fn is_at_border(&self, at: &Ridge) -> bool {
        let near = |inside: f64| inside <= NUDGE;
        self.pair.a.lines().into_iter().any(|line| near(line.inside(self.pair.a, at.a)))
            || self.pair.b.lines().into_iter().any(|line| near(line.inside(self.pair.b, at.b)))
    }

    /// The place of the line a share of the way from one to the next.
    fn between(&self, from: &Ridge, to: &Ridge, share: f64) -> Option<Landing> {
        let chord = to.p - from.p;
        let length = chord.length();
        let across = chord / length;
        let ridge = if share <= 0.0 {
            *from
        } else if share >= 1.0 {
            *to
        } else {
            self.ridge(from.a.lerp(to.a, share), from.b.lerp(to.b, share), Some((from.p + chord * share, across)))?
        };
        let rise = ridge.way.dot(across);
        let d1 = if rise.abs() > 0.5 { ridge.way * (length / rise) } else { chord };
        Some(Landing { uv: ridge.a, p: ridge.p, d1 })
    }
}
