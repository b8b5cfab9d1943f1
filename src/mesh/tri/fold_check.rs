//! Triangles that cut off a fold: where a surface turns back within a step, sides that are short in space may pass over far more of it.
//!
//! Lengths in space do not see that. A face whose triangles meet at sharp angles is made again with a check of each: no place of the surface
//! over a triangle may be farther from it than half of the size, which is what rows of nodes a size apart keep.

use std::cell::{Cell, OnceCell};

use glam::{DVec2, DVec3};

use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::deviation::bend_tiles::BendTiles;
use crate::mesh::deviation::cut_off::farthest_place;
use crate::mesh::deviation::quadratic::over_sides;
use crate::mesh::tri::optimize::LimitCheck;
use crate::mesh::tri::triangle_fit::FaceFit;
use crate::mesh::tri::triangulation::Triangulation;

/// What steers the check.
struct FoldSettings {
    /// Cosine of the angle between the normals of neighbours from which on they may cut off a fold: 60°.
    min_cosine: f64,
    /// Largest distance of the surface from a triangle, over the size.
    max_distance: f64,
    /// Triangles across a tile, and tiles each way at the least and at the most.
    triangles_across_tile: f64,
    tiles: (f64, f64),
}

const SETTINGS: FoldSettings = FoldSettings { min_cosine: 0.5, max_distance: 0.5, triangles_across_tile: 3.0, tiles: (8.0, 64.0) };

/// Lengths of sides, and folds.
pub(crate) struct FoldCheck<'a> {
    fit: &'a FaceFit<'a>,
    /// Work that was allowed for the triangles so far, over all rounds.
    allowed: &'a Cell<u64>,
    /// Second derivatives of the surface: triangles over which it bends little cut off nothing.
    tiles: OnceCell<BendTiles>,
}

impl<'a> FoldCheck<'a> {
    pub(crate) fn new(fit: &'a FaceFit<'a>, allowed: &'a Cell<u64>) -> Self {
        Self { fit, allowed, tiles: OnceCell::new() }
    }

    /// Whether the surface may bend so far over three places of (u, v) that a place of it is too far from the triangle between its points.
    fn may_cut_off(&self, uv: [DVec2; 3], allowed: f64) -> bool {
        let FaceFit { surface, chart, outline, longest, .. } = self.fit;
        let tiles = self.tiles.get_or_init(|| {
            let across = outline.area().sqrt() / (longest.inside * SETTINGS.triangles_across_tile);
            BendTiles::new(surface, chart.box_of(outline), across.clamp(SETTINGS.tiles.0, SETTINGS.tiles.1) as usize)
        });
        let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
        tiles.lengths((low, high)).is_none_or(|bends| over_sides(&bends, uv, high - low) > allowed)
    }

    /// Whether triangles cut off a fold.
    pub(crate) fn is_needed(&self, triangulation: &Triangulation) -> bool {
        // Over triangles at a pole (u, v) is not linear.
        if self.fit.face.has_pole() {
            return false;
        }
        let up = |t: usize| {
            let [a, b, c] = triangulation.tri[t].map(|n| triangulation.p[n as usize]);
            (b - a).cross(c - a).normalize_or_zero()
        };
        let normals: Vec<DVec3> = (0..triangulation.tri.len()).map(up).collect();
        let beside = |t: usize| triangulation.across[t].into_iter().filter(|o| *o != NO_TRIANGLE);
        let is_sharp = |t: &usize| beside(*t).any(|o| normals[*t].dot(normals[o as usize]) < SETTINGS.min_cosine);
        (0..normals.len()).filter(is_sharp).any(|t| self.cuts_off(triangulation, triangulation.tri[t], None))
    }

    /// Whether a place of the surface over a triangle, with its first corner moved to a place, is too far from it.
    fn cuts_off(&self, triangulation: &Triangulation, corners: [u32; 3], first: Option<(DVec2, DVec3)>) -> bool {
        let [_, b, c] = corners.map(|n| n as usize);
        let (a, pa) = first.unwrap_or_else(|| (triangulation.xy[corners[0] as usize], triangulation.p[corners[0] as usize]));
        let xy = [a, triangulation.xy[b], triangulation.xy[c]].map(|xy| DVec2::from(self.fit.chart.uv(xy)));
        let p = [pa, triangulation.p[b], triangulation.p[c]];
        let allowed = SETTINGS.max_distance * self.fit.longest.inside;
        self.may_cut_off(xy, allowed) && farthest_place(self.fit.chart.evaluator(), xy, p).0 > allowed
    }
}

impl LimitCheck for FoldCheck<'_> {
    fn broken(&self, triangulation: &Triangulation, some: &[u32]) -> Vec<u32> {
        self.fit.longest.broken_or(triangulation, some, |t| self.cuts_off(triangulation, triangulation.tri[t as usize], None))
    }

    fn is_per_triangle(&self) -> bool {
        true
    }

    fn holds_from_the_start(&self) -> bool {
        true
    }

    fn allow_work(&self, triangles: usize) {
        self.fit.allow_bounds(triangles, self.allowed);
    }

    fn keeps(&self, triangulation: &Triangulation, corners: [u32; 3], first: Option<(DVec2, DVec3)>) -> bool {
        !self.cuts_off(triangulation, corners, first)
    }
}
