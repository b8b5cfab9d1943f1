//! Whether the map of a flat face is regular: its Jacobian n · (∂u × ∂v) is positive, by bounds over rectangles [Moore 1966].
//!
//! In corners and along poles the Jacobian may be zero. There its slopes decide: where it rises along both ways that lead from a corner
//! into a rectangle, or away from a pole, it is positive in the rectangle.

use glam::DVec3;

use crate::base::math;
use crate::base::range::{Interval, Interval3};
use crate::base::tolerance::Tolerance;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::Domain;
use crate::surface::rails::side::Side;

/// Rectangles that are looked at, at most.
const MOST: usize = 2048;
/// Width of a rectangle that is not halved any more.
const LEAST: f64 = 1.0 / (1 << 20) as f64;

/// Corners of the square and of the triangle, each with both ways along its sides.
const SQUARE: [Corner; 4] = [
    Corner { at: (0.0, 0.0), ways: [(1.0, 0.0), (0.0, 1.0)] },
    Corner { at: (1.0, 0.0), ways: [(-1.0, 0.0), (0.0, 1.0)] },
    Corner { at: (1.0, 1.0), ways: [(-1.0, 0.0), (0.0, -1.0)] },
    Corner { at: (0.0, 1.0), ways: [(1.0, 0.0), (0.0, -1.0)] },
];
const TRIANGLE: [Corner; 3] = [
    Corner { at: (0.0, 0.0), ways: [(1.0, 0.0), (0.0, 1.0)] },
    Corner { at: (1.0, 0.0), ways: [(-1.0, 0.0), (-1.0, 1.0)] },
    Corner { at: (0.0, 1.0), ways: [(0.0, -1.0), (1.0, -1.0)] },
];

struct Corner {
    at: (f64, f64),
    ways: [(f64, f64); 2],
}

/// Low and high of u and of v.
type Rectangle = [(f64, f64); 2];

/// Whether the map of a flat surface with this unit normal has a positive Jacobian, in corners within what the tolerance moves it by; false
/// where bounds of [`MOST`] rectangles leave it open.
pub(crate) fn is_regular(surface: &Surface, normal: DVec3, tolerance: &Tolerance) -> bool {
    let across = math::any_normal(normal);
    let axes = [across, normal.cross(across)];
    let map = FlatMap { surface, axes, tolerance, breaks: breaks(surface), triangle: surface.domain() == Domain::Triangle };
    let mut left: Vec<Rectangle> = vec![[(0.0, 1.0); 2]];
    for _ in 0..MOST {
        let Some(rectangle) = left.pop() else { return true };
        let bounds = surface.enclosure(rectangle[0], rectangle[1]);
        if map.is_positive(&rectangle, &bounds) {
            continue;
        }
        if map.jacobian(&bounds.mid) < -map.slack(&bounds.mid) {
            return false;
        }
        let Some(halves) = map.halves(rectangle, &bounds) else { return false };
        left.extend(halves.into_iter().filter(|[u, v]| !map.triangle || u.0 + v.0 < 1.0));
    }
    left.is_empty()
}

/// A map with the lines where it is less than smooth: of constant u, of constant v, and of constant u + v in a triangle.
struct FlatMap<'a> {
    surface: &'a Surface,
    /// Unit vectors in the plane, counter-clockwise about its normal.
    axes: [DVec3; 2],
    tolerance: &'a Tolerance,
    breaks: [Vec<f64>; 3],
    triangle: bool,
}

fn breaks(surface: &Surface) -> [Vec<f64>; 3] {
    let Shape::Trilateral(map) = &surface.parts().shape else {
        let (us, vs) = surface.breaks();
        return [us, vs, Vec::new()];
    };
    let [bottom, slant, left] = map.sides().each_ref().map(|side| {
        let mut own = Vec::new();
        side.breaks(&mut own);
        own
    });
    // Each point of a triangle is made of the points of all sides with the same u, the same v and the same u + v.
    let us = bottom.iter().copied().chain(slant.iter().map(|x| 1.0 - x)).collect();
    [us, [slant, left.clone()].concat(), [bottom, left].concat()]
}

impl FlatMap<'_> {
    fn jacobian(&self, jet: &Jet2) -> f64 {
        let [x, y] = self.axes;
        jet.du.dot(x) * jet.dv.dot(y) - jet.du.dot(y) * jet.dv.dot(x)
    }

    /// Bounds of n · (a × b).
    fn area(&self, a: &Interval3, b: &Interval3) -> Interval {
        let [x, y] = self.axes;
        a.along(x) * b.along(y) - a.along(y) * b.along(x)
    }

    /// What the Jacobian changes by when points move by the tolerance.
    fn slack(&self, jet: &Jet2) -> f64 {
        self.tolerance.point * (jet.du.length() + jet.dv.length())
    }

    fn is_positive(&self, rectangle: &Rectangle, bounds: &Enclosure) -> bool {
        let direct = self.area(&bounds.du, &bounds.dv);
        let [by_u, by_v] = self.slopes(bounds);
        // The middle of a rectangle over the slant of a triangle is not that of its bounds.
        let about = |x: f64| by_u * Interval::around_zero(bounds.half.0) + by_v * Interval::around_zero(bounds.half.1) + Interval::at(x);
        if direct.low > 0.0 || !self.triangle && about(self.jacobian(&bounds.mid)).low > 0.0 {
            return true;
        }
        let [(u0, u1), (v0, v1)] = *rectangle;
        let within = |x: &f64, low: f64, high: f64| low < *x && *x < high;
        let [us, vs, sums] = &self.breaks;
        let smooth = !us.iter().any(|x| within(x, u0, u1))
            && !vs.iter().any(|x| within(x, v0, v1))
            && !sums.iter().any(|x| within(x, u0 + v0, u1 + v1));
        let rises = |way: &(f64, f64)| (by_u * way.0 + by_v * way.1).low > 0.0;
        let pole = |k: usize| !self.triangle && matches!(self.surface.parts().borders[k].side, Side::Pole(_));
        let beside_pole = || {
            let sides = [(3, u0 == 0.0, (1.0, 0.0)), (1, u1 == 1.0, (-1.0, 0.0)), (0, v0 == 0.0, (0.0, 1.0)), (2, v1 == 1.0, (0.0, -1.0))];
            sides.iter().any(|(side, there, way)| *there && pole(*side) && rises(way))
        };
        let in_corner = || {
            let corners: &[Corner] = if self.triangle { &TRIANGLE } else { &SQUARE };
            let holds = |c: &&Corner| u0 <= c.at.0 && c.at.0 <= u1 && v0 <= c.at.1 && c.at.1 <= v1;
            corners.iter().filter(holds).any(|corner| {
                let jet = self.surface.jet(corner.at.0, corner.at.1);
                corner.ways.iter().all(rises) && self.jacobian(&jet) >= -self.slack(&jet)
            })
        };
        smooth && (beside_pole() || in_corner())
    }

    /// Bounds of the derivatives of the Jacobian by u and by v.
    fn slopes(&self, b: &Enclosure) -> [Interval; 2] {
        let slope = |du: &Interval3, dv: &Interval3| self.area(du, &b.dv) + self.area(&b.du, dv);
        [slope(&b.duu, &b.duv), slope(&b.duv, &b.dvv)]
    }

    /// Both halves of a rectangle, cut across the direction along which the Jacobian changes more, at the break nearest to its middle.
    fn halves(&self, rectangle: Rectangle, bounds: &Enclosure) -> Option<[Rectangle; 2]> {
        let [by_u, by_v] = self.slopes(bounds);
        let change = (by_u.reach() * bounds.half.0, by_v.reach() * bounds.half.1);
        let width = |k: usize| rectangle[k].1 - rectangle[k].0;
        // Where nothing is known of second derivatives, and in narrow rectangles, the wider direction.
        let known = !bounds.duu.is_unbounded() && !bounds.duv.is_unbounded() && !bounds.dvv.is_unbounded();
        let by_width = !known || width(0).max(width(1)) > 8.0 * width(0).min(width(1));
        let across = usize::from(if by_width { width(1) > width(0) } else { change.1 > change.0 });
        let (low, high) = rectangle[across];
        if high - low < LEAST {
            return None;
        }
        let middle = 0.5 * (low + high);
        let inner = self.breaks[across].iter().copied().filter(|x| *x > low + LEAST && *x < high - LEAST);
        let at = inner.min_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs())).unwrap_or(middle);
        let (mut first, mut second) = (rectangle, rectangle);
        (first[across].1, second[across].0) = (at, at);
        Some([first, second])
    }
}
