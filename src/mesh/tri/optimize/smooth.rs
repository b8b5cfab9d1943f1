//! Nodes moved over the surface to the middle of what is round them.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::chart::parametric_surface::foot_near;
use crate::mesh::tri::optimize::MeshOptimizer;
use crate::mesh::tri::optimize_settings::REPAIR;
use crate::mesh::tri::shape::Star;

impl MeshOptimizer<'_> {
    /// Moves free nodes that wait towards the area-weighted mean of their triangles' centroids, and in the next round their
    /// neighbours too.
    pub fn smooth(&mut self, rounds: usize) {
        for _ in 0..rounds {
            let mut moved = false;
            for node in self.active.take() {
                job::poll();
                if !self.triangulation.is_free(node) || self.triangulation.at[node as usize] == NO_TRIANGLE {
                    continue;
                }
                if self.relax(node) {
                    moved = true;
                    self.ring.node.iter().for_each(|n| self.active.add(*n));
                }
            }
            if !moved {
                return;
            }
        }
    }

    /// One step of one node; whether it moved by more than the least move.
    fn relax(&mut self, node: u32) -> bool {
        self.fill_rim(node);
        let here = self.triangulation.p[node as usize];
        let before = self.rim.worst(self.triangulation.xy[node as usize], here);
        if before > self.settings.still_quality {
            return false;
        }
        let xy = self.triangulation.xy[node as usize];
        let (mut sum, mut place, mut weights) = (DVec3::ZERO, DVec2::ZERO, 0.0);
        let (points, places) = (self.rim.points(), self.rim.places());
        let n = points.len();
        for i in 0..n {
            let j = if i + 1 < n { i + 1 } else { 0 };
            let (a, b) = (points[i], points[j]);
            let area = (a - here).cross(b - here).length();
            let size = (self.triangulation.size[self.ring.node[i] as usize] + self.triangulation.size[self.ring.node[j] as usize]) * 0.5;
            let weight = area / (size * size * size * size);
            sum += (here + a + b) * weight;
            place += (xy + places[i] + places[j]) * weight;
            weights += weight;
        }
        let size = self.triangulation.size[node as usize];
        let demand = sum / (3.0 * weights) - here;
        // The same mean in the chart is nearly the foot of the one in space.
        let way = place / (3.0 * weights) - xy;
        let mut share = self.settings.relaxation;
        for _ in 0..3 {
            let step = demand * share;
            if step.length() < REPAIR.min_move * size {
                return false;
            }
            let (xy, spot) = foot_near(self.chart_surface, self.chart_surface.clamp(xy + way * share), here + step, step.length());
            let p = spot.p;
            // Where rounding has turned a triangle over already, others may not be turned over.
            let is_upright = self.rim.worst(xy, p) >= before.clamp(0.0, self.settings.still_quality);
            if is_upright && (!self.guards_moves || self.star_keeps(&self.ring.node, node, &Star { p, xy, worst: 0.0 })) {
                self.place(node, xy, p);
                return true;
            }
            share *= 0.4;
        }
        false
    }

    pub(crate) fn fill_rim(&mut self, node: u32) {
        let triangulation = &self.triangulation;
        triangulation.ring(node, &mut self.ring);
        self.rim.fill(self.ring.node.iter().map(|n| (triangulation.p[*n as usize], triangulation.xy[*n as usize])));
        self.rim.longest = triangulation.size[node as usize] * self.settings.max_length_ratio;
    }

    pub(crate) fn place(&mut self, node: u32, xy: DVec2, p: DVec3) {
        self.triangulation.xy[node as usize] = xy;
        self.triangulation.p[node as usize] = p;
        self.triangulation.size[node as usize] = self.field.size(xy, p) * self.size_factor[node as usize];
        self.touch(node);
    }
}
