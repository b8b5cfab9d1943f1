//! Outer loops that are the border of their surface: such a face is the whole surface.

use glam::DVec3;

use super::base::Base;
use super::face::Border;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::curve::Shape;
use crate::geometry::{Curve, Kind, closest};
use crate::surface::{Side, Surface};

/// Places compared along each curve.
const SAMPLES: usize = 16;

/// Whether a loop runs along the sides of a surface and covers all of them that are free; places within `room` are one.
pub fn is_natural(base: &Base, surface: &Surface, outer: &[Border], room: f64, tolerance: &Tolerance) -> bool {
    let Some(sides) = sides(base, surface, tolerance) else { return false };
    let lines: Vec<&Curve> = sides.iter().map(|s| &s.0).collect();
    let curves: Vec<&Curve> = outer.iter().map(|b| &b.space).collect();
    let near = |p: DVec3, among: &[&Curve]| among.iter().any(|c| closest(c, p).distance <= room);
    curves.iter().all(|c| places(c).all(|p| near(p, &lines)))
        && sides.iter().filter(|s| s.1).all(|(side, _)| places(side).all(|p| near(p, &curves)))
}

/// The largest distance of a loop from the sides of a surface where each of its curves is one side, run evenly; none where that is
/// not so within `room`, a quick look that may miss.
pub fn matched(base: &Base, surface: &Surface, outer: &[Border], room: f64, tolerance: &Tolerance) -> Option<f64> {
    if surface.closed() != (false, false) {
        return None;
    }
    let sides = sides(base, surface, tolerance)?;
    let mut left: Vec<&Curve> = sides.iter().map(|s| &s.0).collect();
    if left.len() != outer.len() {
        return None;
    }
    let mut off = 0.0_f64;
    for border in outer {
        let found = left.iter().enumerate().find_map(|(k, side)| beside(&border.space, side, room).map(|off| (k, off)));
        let (k, own) = found?;
        left.swap_remove(k);
        off = off.max(own);
    }
    Some(off)
}

/// The largest distance of two curves at equal shares of their parameters, in the better direction, where it is within `room`.
fn beside(a: &Curve, b: &Curve, room: f64) -> Option<f64> {
    let ahead = a.start().distance(b.start()) <= room && a.end().distance(b.end()) <= room;
    let back = a.start().distance(b.end()) <= room && a.end().distance(b.start()) <= room;
    if !ahead && !back {
        return None;
    }
    let others: Vec<DVec3> = places(b).collect();
    let off = places(a).enumerate().map(|(k, p)| p.distance(others[if ahead { k } else { SAMPLES - k }])).fold(0.0, f64::max);
    (off <= room).then_some(off)
}

/// Sides that are no poles, each with `true` when it is free and not a seam.
fn sides(base: &Base, surface: &Surface, tolerance: &Tolerance) -> Option<Vec<(Curve, bool)>> {
    let net = base.net(&crate::base::bbox::Box3::EMPTY, tolerance).ok()?;
    let mut sides = Vec::new();
    for k in 0..surface.n_sides() {
        let side = surface.side(k);
        if matches!(side, Side::Pole(_)) {
            continue;
        }
        // Sides are v = 0, u = 1, v = 1, u = 0.
        let (at_u, at) = [(false, 0.0), (true, 1.0), (false, 1.0), (true, 0.0)][k];
        let line = Curve::new(Shape::Nurbs(std::sync::Arc::new(net.iso(at_u, at))), Kind::Iso, Origin::NONE);
        sides.push((line, !matches!(side, Side::Seam)));
    }
    Some(sides)
}

fn places(curve: &Curve) -> impl Iterator<Item = DVec3> {
    let (a, b) = curve.domain();
    (0..=SAMPLES).map(move |i| curve.point(a + (b - a) * i as f64 / SAMPLES as f64))
}
