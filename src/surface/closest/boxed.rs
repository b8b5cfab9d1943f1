//! Boxes found with a bound, and what grows them.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::tolerance::BOX;
use crate::surface::closest::descent::{Local, descend};
use crate::surface::core::surface::Surface;

/// A box that holds a surface, and one around points of it that were found.
#[derive(Clone, Copy, Debug)]
pub struct Boxed {
    /// No point of the surface stands out of it by more than [`BOX`] of its diagonal.
    pub bounds: Box3,
    /// Around points of the surface.
    pub(crate) found: Box3,
}

impl Boxed {
    /// A box of points.
    pub(crate) fn of(bounds: Box3) -> Self {
        Self { bounds, found: bounds }
    }

    /// With a point of the surface.
    pub(crate) fn with(self, p: DVec3) -> Self {
        Self { bounds: self.bounds.with(p), found: self.found.with(p) }
    }

    /// With a box that points of the surface reach.
    pub(crate) fn and(self, bounds: Box3) -> Self {
        Self { bounds: self.bounds.union(bounds), found: self.found.union(bounds) }
    }

    /// With a box that may reach farther than its points.
    pub(crate) fn held_by(self, hull: Box3) -> Self {
        Self { bounds: self.bounds.union(hull), ..self }
    }

    /// By how much the box may be too large at most; `None` where that is no more than [`BOX`] of its diagonal.
    pub fn loose(&self) -> Option<f64> {
        let apart = (self.bounds.max - self.found.max).max(self.found.min - self.bounds.min).max_element();
        (apart > BOX * self.bounds.diagonal()).then_some(apart)
    }
}

/// A place of the square with its point.
pub(crate) type Sample = ((f64, f64), DVec3);

/// Where descents from the lowest and highest samples of each coordinate end.
pub(crate) fn extremes(surface: &Surface, samples: &[Sample]) -> Vec<Sample> {
    let mut ends = Vec::new();
    for direction in 0..6 {
        let (axis, sign) = (direction / 2, if direction % 2 == 0 { 1.0 } else { -1.0 });
        let height = |k: usize| sign * samples[k].1[axis];
        // The lowest few samples: neighbouring ones fall to the same minimum.
        let mut order: Vec<usize> = (0..samples.len()).collect();
        order.sort_by(|&a, &b| height(a).total_cmp(&height(b)).then(a.cmp(&b)));
        for &k in order.iter().take(4) {
            let end = descend(&|x, y| surface.square_jet(x, y), samples[k].0, |jet| Local {
                value: sign * jet.p[axis],
                gradient: [sign * jet.du[axis], sign * jet.dv[axis]],
                hessian: [sign * jet.duu[axis], sign * jet.duv[axis], sign * jet.dvv[axis]],
            });
            ends.push((end.place, surface.square_jet(end.place.0, end.place.1).p));
        }
    }
    ends
}

/// Rectangles looked at before what is left is taken by its bound.
pub(crate) const MOST: usize = 20_000;

/// A rectangle of (u, v): its ends in u and in v.
pub(crate) type UvBox = ((f64, f64), (f64, f64));

/// Both halves of a rectangle, along u or along v.
pub(crate) fn halves((u, v): UvBox, along_u: bool) -> [UvBox; 2] {
    let (mu, mv) = (0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
    if along_u { [((u.0, mu), v), ((mu, u.1), v)] } else { [(u, (v.0, mv)), (u, (mv, v.1))] }
}
