//! Triangles on their backs: right side up in the chart and folded over in space, as near a tip, where the chart is skewed.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::tri::optimize::MeshOptimizer;
use crate::mesh::tri::optimize_settings::REPAIR;

impl MeshOptimizer<'_> {
    /// Flips sides of triangles that lie against the normal of their surface, where both new ones lie with it, have no longer side and keep
    /// the limits.
    pub fn set_upright(&mut self) {
        for _ in 0..REPAIR.max_upright_passes {
            let folded: Vec<u32> = (0..self.triangulation.tri.len() as u32).filter(|t| self.is_folded(*t)).collect();
            let mut flipped = false;
            for t in folded {
                job::poll();
                flipped |= self.is_folded(t) && !self.lies_upright(self.triangulation.tri[t as usize]) && self.flip_upright(t);
            }
            if !flipped {
                break;
            }
        }
    }

    /// Whether a triangle meets a neighbour at an angle below a right one.
    fn is_folded(&self, t: u32) -> bool {
        let triangulation = &self.triangulation;
        let own = self.up(triangulation.tri[t as usize]);
        let beside = |other: u32| other != NO_TRIANGLE && self.up(triangulation.tri[other as usize]).dot(own) < 0.0;
        triangulation.alive(t) && triangulation.across[t as usize].into_iter().any(beside)
    }

    /// Twice the area along the normal.
    fn up(&self, corners: [u32; 3]) -> DVec3 {
        let [a, b, c] = corners.map(|n| self.triangulation.p[n as usize]);
        (b - a).cross(c - a)
    }

    fn lies_upright(&self, corners: [u32; 3]) -> bool {
        let middle = corners.iter().map(|n| self.triangulation.xy[*n as usize]).sum::<DVec2>() / 3.0;
        self.up(corners).dot(self.chart_surface.spot(middle).normal()) > 0.0
    }

    fn flip_upright(&mut self, t: u32) -> bool {
        let mut best: Option<(f64, usize)> = None;
        for k in 0..3 {
            let Some([a, b, c, d]) = self.quad(t, k).filter(|quad| self.convex(*quad)) else { continue };
            let length = |x: u32, y: u32| self.triangulation.p[x as usize].distance(self.triangulation.p[y as usize]);
            if length(a, c) > length(a, b).max(length(b, c)).max(length(c, d)).max(length(d, a)).max(length(b, d)) {
                continue;
            }
            let new = [[a, b, c], [a, c, d]];
            let worst = new.iter().map(|corners| self.triangulation.shape(*corners)).fold(1.0, f64::min);
            let is_better = best.is_none_or(|(least, _)| worst > least);
            if is_better && new.iter().all(|corners| self.lies_upright(*corners) && self.keeps(*corners, None)) {
                best = Some((worst, k));
            }
        }
        let Some((_, k)) = best else { return false };
        let other = self.triangulation.across[t as usize][k];
        self.triangulation.flip(t, k);
        self.wake(t);
        self.wake(other);
        true
    }
}
