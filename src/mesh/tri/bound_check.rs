//! Limits of triangles: lengths of sides, and bounds of how far each is from its surface.

use std::cell::{Cell, RefCell};

use glam::{DVec2, DVec3};

use crate::mesh::request::work::allow;
use crate::mesh::tri::limit_table::{LimitTable, ratio};
use crate::mesh::tri::longest::{Longest, longest_side};
use crate::mesh::tri::optimize::LimitCheck;
use crate::mesh::tri::triangle_fit::FaceFit;
use crate::mesh::tri::triangulation::Triangulation;

/// Number of curves of a point at which bounding a triangle costs as much as on a net.
const CURVES_OF_A_NET: usize = 2;
/// Largest cost of bounding a triangle that is allowed, over that on a net.
const MAX_NETS: usize = 8;

/// The limits of sides by their lengths, and of triangles by their bounds.
pub(crate) struct BoundCheck<'a> {
    pub(crate) fit: &'a FaceFit<'a>,
    /// Length of sides up to which limits are not kept, model units.
    pub(crate) floor: f64,
    pub(crate) ratios: &'a RefCell<LimitTable>,
    /// Work that was allowed for the triangles so far, over all rounds.
    pub(crate) allowed: &'a Cell<u64>,
}

impl LimitCheck for BoundCheck<'_> {
    fn broken(&self, triangulation: &Triangulation, some: &[u32]) -> Vec<u32> {
        let mut ratios = self.ratios.borrow_mut();
        ratios.update(self.fit.chart, triangulation, some, &self.fit.limits);
        let over = |t: u32| ratios.of(t).worst() > 1.0 && longest_side(triangulation, t) > self.floor;
        self.fit.longest.broken_or(triangulation, some, over)
    }

    fn is_per_triangle(&self) -> bool {
        true
    }

    fn allow_work(&self, triangles: usize) {
        self.fit.allow_bounds(triangles, self.allowed);
    }

    fn keeps(&self, triangulation: &Triangulation, corners: [u32; 3], first: Option<(DVec2, DVec3)>) -> bool {
        let [a, b, c] = corners.map(|n| n as usize);
        let a = first.map_or_else(|| triangulation.p[a], |first| first.1);
        let longest =
            a.distance(triangulation.p[b]).max(triangulation.p[b].distance(triangulation.p[c])).max(triangulation.p[c].distance(a));
        longest <= self.floor || ratio(self.fit.chart, triangulation, corners, first, &self.fit.limits).worst() <= 1.0
    }
}

impl LimitCheck for Longest<'_> {
    fn broken(&self, triangulation: &Triangulation, some: &[u32]) -> Vec<u32> {
        self.broken(triangulation, some)
    }

    fn is_per_triangle(&self) -> bool {
        false
    }

    fn allow_work(&self, _: usize) {}

    fn keeps(&self, _: &Triangulation, _: [u32; 3], _: Option<(DVec2, DVec3)>) -> bool {
        true
    }
}

impl FaceFit<'_> {
    /// Allows the work that bounds of so many triangles may take; `allowed` is what was allowed before.
    pub(crate) fn allow_bounds(&self, triangles: usize, allowed: &Cell<u64>) {
        let (across, along) = self.surface.curves_of_a_point();
        let nets = ((across + along) / CURVES_OF_A_NET).clamp(1, MAX_NETS);
        let mut worth = allowed.get();
        allow(triangles as u64 * nets as u64, &mut worth);
        allowed.set(worth);
    }
}
