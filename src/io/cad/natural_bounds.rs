//! Outer loops that are the border of their surface: such a face is the whole surface.

use glam::DVec3;

use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::closest;
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Kind};
use crate::io::cad::base_surface::Base;
use crate::io::cad::border::Border;
use crate::surface::{Side, Surface};

/// Places compared along each curve.
const SAMPLES: usize = 16;

/// How far a loop may be from the sides of a surface, model units.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    /// From seams: nothing else is joined there.
    pub seam: f64,
    /// From free sides, which other faces have too, and they from it.
    pub free: f64,
}

/// Whether a loop runs along the sides of a surface and covers all of them that are free.
pub fn is_natural(base: &Base, surface: &Surface, outer: &[Border], allowed: Allowance, tolerance: &Tolerance) -> bool {
    let Some(sides) = sides(base, surface, tolerance) else { return false };
    let room = |is_free: bool| if is_free { allowed.free } else { allowed.seam };
    let on_side = |p: DVec3| sides.iter().any(|(side, is_free)| closest(side, p).distance <= room(*is_free));
    let on_curve = |p: DVec3| outer.iter().any(|b| closest(&b.space, p).distance <= allowed.free);
    outer.iter().all(|b| places(&b.space).all(on_side)) && sides.iter().filter(|s| s.1).all(|(side, _)| places(side).all(on_curve))
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
