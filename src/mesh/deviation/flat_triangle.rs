//! How far a flat triangle may be from the surface that it stands for: bounded, by parts where the whole is not enough.

use glam::{DVec2, DVec3};

use crate::base::range::Interval3;
use crate::base::tolerance::EPSILON;
use crate::mesh::deviation::proof::{CERTIFY_SETTINGS, Proof};
use crate::mesh::deviation::quadratic::over_sides;
use crate::surface::core::power_form::Bends;
use crate::surface::{Enclosure, Evaluator, foot_within};

/// An interval made wider, inside another.
pub(super) fn widened(low: f64, high: f64, (least, most): (f64, f64)) -> (f64, f64) {
    let more = (high - low) * CERTIFY_SETTINGS.widening;
    ((low - more).max(least), (high + more).min(most))
}

/// The part of a surface that a face covers, and how far its elements may be from it.
pub(super) struct Region<'a> {
    pub surface: Evaluator<'a>,
    pub u: (f64, f64),
    pub v: (f64, f64),
    /// Only u + v ≤ 1 belongs to it.
    pub slanted: bool,
    /// Model units.
    pub limit: f64,
}

/// A corner of a flat triangle.
#[derive(Clone, Copy)]
pub(super) struct FlatCorner {
    p: DVec3,
    /// Place of its foot on the surface.
    uv: DVec2,
    foot: DVec3,
    /// Distance of the foot.
    off: f64,
    /// The coordinate of the place that does not matter, at a pole.
    free: Option<usize>,
}

impl FlatCorner {
    /// One on the surface.
    pub(super) fn on(p: DVec3, uv: (f64, f64)) -> Self {
        Self { p, uv: DVec2::from(uv), foot: p, off: 0.0, free: None }
    }
}

/// Places of a triangle's corners, the free ones in the middle of the others.
fn places(t: &[FlatCorner; 3]) -> [DVec2; 3] {
    let mut uv = t.map(|c| c.uv);
    for k in 0..3 {
        if let Some(axis) = t[k].free {
            uv[k][axis] = 0.5 * (t[(k + 1) % 3].uv[axis] + t[(k + 2) % 3].uv[axis]);
        }
    }
    uv
}

/// A bound of the distance between a flat triangle and its surface, and what of it is bent along u and along v.
struct TriangleBound {
    error: f64,
    bends: [f64; 2],
}

impl Region<'_> {
    /// A point with the surface point at a place as its foot; `free` is the coordinate that does not matter there.
    pub(super) fn corner(&self, p: DVec3, uv: (f64, f64), free: Option<usize>) -> FlatCorner {
        let foot = self.surface.point(uv.0, uv.1);
        FlatCorner { p, uv: DVec2::from(uv), foot, off: p.distance(foot), free }
    }

    /// What is known of a flat triangle; `known` are bounds over its widened box.
    pub(super) fn certify(&self, triangle: [FlatCorner; 3], known: Option<&Enclosure>) -> Proof {
        let mut open = vec![(triangle, CERTIFY_SETTINGS.max_halvings)];
        let mut known = known;
        let mut open_parts = 0;
        while let Some((t, left)) = open.pop() {
            let off = t.iter().fold(0.0, |m: f64, c| m.max(c.off));
            let uv = places(&t);
            let bound = self.bound(&t, uv, known.take());
            if off + bound.error <= self.limit {
                continue;
            }
            open_parts += 1;
            let bends = bound.bends;
            if left == 0 {
                return Proof::Blind;
            }
            if open_parts > CERTIFY_SETTINGS.max_open_parts {
                return Proof::Open((off + bound.error) / self.limit, bends);
            }
            let m = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| self.middle_of_side(&t, &uv, i, j));
            let far = m.iter().fold(0.0, |m: f64, c| m.max(c.0));
            if far > self.limit {
                return Proof::Broken(far / self.limit, bends);
            }
            let m = m.map(|c| c.1);
            open.push((m, left - 1));
            for k in 0..3 {
                open.push(([t[k], m[(k + 2) % 3], m[(k + 1) % 3]], left - 1));
            }
        }
        Proof::Kept
    }

    /// The middle of the side between two corners with its distance from the surface. Its foot is the nearest point, unless that is far from the
    /// middle of the places (beyond a fold): then the point there, for any point of the surface bounds the distance.
    fn middle_of_side(&self, t: &[FlatCorner; 3], uv: &[DVec2; 3], i: usize, j: usize) -> (f64, FlatCorner) {
        let (p, guess) = (0.5 * (t[i].p + t[j].p), 0.5 * (uv[i] + uv[j]));
        let (off, at) = foot_within(self.surface, p, (guess.x, guess.y), self.u, self.v);
        let width = uv[0].max(uv[1]).max(uv[2]) - uv[0].min(uv[1]).min(uv[2]);
        let at = DVec2::from(at);
        let there = self.surface.point(guess.x, guess.y);
        let beside = p.distance(there);
        if (at - guess).abs().cmple(CERTIFY_SETTINGS.max_stray * width).all() || beside > CERTIFY_SETTINGS.max_used_share * self.limit {
            return (off, FlatCorner { p, uv: at, foot: self.surface.point(at.x, at.y), off, free: None });
        }
        (off, FlatCorner { p, uv: guess, foot: there, off: beside, free: None })
    }

    /// How far the surface is from the flat triangle between feet.
    fn bound(&self, t: &[FlatCorner; 3], uv: [DVec2; 3], known: Option<&Enclosure>) -> TriangleBound {
        let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
        let ((x0, x1), (y0, y1)) = (widened(low.x, high.x, self.u), widened(low.y, high.y, self.v));
        let width = high - low;
        let ranges = if known.is_none() { self.surface.ranges((DVec2::new(x0, y0), DVec2::new(x1, y1))) } else { None };
        let second = match ranges {
            Some(second) => second,
            None => {
                let own;
                let enclosure = match known {
                    Some(enclosure) => enclosure,
                    None => {
                        own = self.surface.surface().enclosure((x0, x1), (y0, y1));
                        &own
                    }
                };
                let second = [enclosure.duu, enclosure.duv, enclosure.dvv];
                if second.iter().any(Interval3::is_unbounded) {
                    // What is left of a function without its mean slopes has slopes of half their width, and changes by half of that
                    // on the mean over the corners.
                    let wide = |r: &Interval3| 0.25 * (r.high - r.low).length();
                    let bends = [width.x * wide(&enclosure.du), width.y * wide(&enclosure.dv)];
                    return TriangleBound { error: bends[0] + bends[1], bends };
                }
                second
            }
        };
        let (a, b) = (t[1].foot - t[0].foot, t[2].foot - t[0].foot);
        let twice = a.cross(b).length();
        let square = |r: &Interval3| r.reach();
        if twice <= EPSILON * (a.length_squared() + b.length_squared()) {
            let slack = second.each_ref().map(square);
            let error = over_sides(&Bends { mid: [0.0; 3], slack, jump: 0.0 }, uv, width);
            return TriangleBound { error, bends: [slack[0] * width.x * width.x, slack[2] * width.y * width.y] };
        }
        let flat = Flat::new(uv, a, b, twice, &second);
        let box_ = (DVec2::new(x0, y0), DVec2::new(x1, y1));
        let error =
            self.beside(t, &flat, box_, &second).map_or(flat.whole, |beside| flat.whole.min(DVec2::new(flat.shifted, beside).length()));
        TriangleBound { error, bends: [flat.bent(0) * width.x * width.x, flat.bent(2) * width.y * width.y] }
    }

    /// What the border of the face may cut off of a flat triangle; `None` where feet may lie beyond the box in which the
    /// surface is known.
    fn beside(&self, t: &[FlatCorner; 3], flat: &Flat, (least, most): (DVec2, DVec2), second: &[Interval3; 3]) -> Option<f64> {
        let (low, high) = (flat.low - flat.shift, flat.high + flat.shift);
        let mut cut = 0.0;
        for (axis, range) in [self.u, self.v].into_iter().enumerate() {
            for (out, on, end) in [(low[axis] < least[axis], range.0, least[axis]), (high[axis] > most[axis], range.1, most[axis])] {
                if out && on != end {
                    return None;
                }
                if out {
                    let along = if axis == 0 { DVec2::Y } else { DVec2::X };
                    let span = (most - least).dot(along);
                    cut += self.sagitta(t, flat.normal, BorderSide { along, span }, second, &|uv| (uv[axis] - on).abs());
                }
            }
        }
        if self.slanted && high.x + high.y > 1.0 {
            let span = (most - least).max_element();
            cut += self.sagitta(t, flat.normal, BorderSide { along: DVec2::new(1.0, -1.0), span }, second, &|uv| (1.0 - uv.x - uv.y).abs());
        }
        Some(cut)
    }

    /// How far a border is from its chord, in the plane of the triangle; `away` is how far a place is
    /// from the border.
    fn sagitta(&self, t: &[FlatCorner; 3], normal: DVec3, side: BorderSide, second: &[Interval3; 3], away: &dyn Fn(DVec2) -> f64) -> f64 {
        let BorderSide { along, span } = side;
        let on: Vec<&FlatCorner> = t.iter().filter(|c| away(c.uv) <= EPSILON).collect();
        let (way, share) = match on[..] {
            [a, b] => {
                let part = (a.uv - b.uv).abs().max_element() / span;
                (a.foot - b.foot, part * part / 8.0)
            }
            // One corner, or none where the border is near: at most as far as from a tangent.
            _ => {
                let near = t.iter().fold(&t[0], |best, c| if away(c.uv) < away(best.uv) { c } else { best });
                let jet = self.surface.jet(near.uv.x, near.uv.y);
                (jet.du * along.x + jet.dv * along.y, 0.5)
            }
        };
        let aside = normal.cross(way).normalize_or_zero();
        let r = second.each_ref().map(|r| r.along(aside).reach());
        let bend = r[0] * along.x * along.x + 2.0 * r[1] * (along.x * along.y).abs() + r[2] * along.y * along.y;
        share * span * span * bend
    }
}

/// A border of the face beside a triangle: its direction in (u, v), and how far it runs along the box of the triangle.
struct BorderSide {
    along: DVec2,
    span: f64,
}

/// A flat triangle over places, and the bounds that ranges of second derivatives give for the surface there.
struct Flat {
    normal: DVec3,
    /// Box of the places.
    low: DVec2,
    high: DVec2,
    /// How far the foot of a point may lie from its place.
    shift: DVec2,
    /// The surface over the triangle in the direction of the normal, found at the feet.
    shifted: f64,
    /// How far a point may be from that of its own place.
    whole: f64,
    bends: Bends,
}

impl Flat {
    /// Of the sides `a` and `b` from the first corner and twice the area between them.
    fn new(uv: [DVec2; 3], a: DVec3, b: DVec3, twice: f64, second: &[Interval3; 3]) -> Self {
        let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
        let width = high - low;
        let normal = a.cross(b) / twice;
        let e = a.normalize_or_zero();
        let f = normal.cross(e);
        let up = second.each_ref().map(|r| r.along(normal));
        let bends = Bends { mid: up.map(|r| 0.5 * (r.low + r.high)), slack: up.map(|r| 0.5 * (r.high - r.low)), jump: 0.0 };
        let aside = second.each_ref().map(|r| DVec2::new(r.along(e).reach(), r.along(f).reach()).length());
        let height = over_sides(&bends, uv, width);
        let along = over_sides(&Bends { mid: [0.0; 3], slack: aside, jump: 0.0 }, uv, width);
        let whole = DVec2::new(height, along).length();
        let mut flat = Self { normal, low, high, shift: DVec2::INFINITY, shifted: f64::INFINITY, whole, bends };
        // Slopes along a side vanish somewhere on it, and change by second derivatives over the widened box.
        let room = width * (1.0 + 2.0 * CERTIFY_SETTINGS.widening);
        let sides = [uv[1] - uv[0], uv[2] - uv[0]].map(DVec2::abs);
        let slope = |d: DVec2, c: [f64; 3]| d.x * room.x * c[0] + (d.x * room.y + d.y * room.x) * c[1] + d.y * room.y * c[2];
        let heights = [twice / b.length(), twice / a.length()];
        let swing = slope(sides[0], aside) / heights[0] + slope(sides[1], aside) / heights[1];
        if swing < 1.0 {
            let most = along / (1.0 - swing);
            let steps = heights.map(|h| most / h);
            flat.shift = sides[0] * steps[0] + sides[1] * steps[1];
            let up = [0, 1, 2].map(|k| flat.bent(k));
            flat.shifted = height + steps[0] * slope(sides[0], up) + steps[1] * slope(sides[1], up);
        }
        flat
    }

    /// Most of a second derivative along the normal.
    fn bent(&self, k: usize) -> f64 {
        self.bends.mid[k].abs() + self.bends.slack[k]
    }
}
