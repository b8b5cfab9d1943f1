//! The first row of a lattice of triangles: a node in each corner that two of them fill, and one over each edge of the border.

use glam::DVec3;

use crate::base::math;
use crate::mesh::chart::outline::cross;
use crate::mesh::tri::front::{Front, FrontStep, STRAIGHT, apart};
use crate::mesh::tri::placement_settings::{FRONT, TWO_TRIANGLE_CORNERS};
use crate::mesh::tri::point_hash::SurfacePoint;

impl Front<'_> {
    /// A row of nodes along the border, each the tip of an equilateral triangle over an edge; they do not grow further but
    /// for the one over the longest straight run, from which the lattice starts.
    pub(crate) fn layer(&mut self) -> Option<u32> {
        let outline = self.input.outline;
        self.corners();
        let (mut best, mut first) = (0.0, None);
        let mut run = (0.0, DVec3::ZERO);
        for &[a, b] in &outline.loops {
            let (pa, pb) = (outline.p[a as usize], outline.p[b as usize]);
            let (xa, xb) = (outline.xy[a as usize], outline.xy[b as usize]);
            let side = pb - pa;
            let Some(along) = side.try_normalize() else { continue };
            run = if along.dot(run.1) > STRAIGHT { (run.0 + side.length(), run.1) } else { (side.length(), along) };
            let middle = 0.5 * (xa + xb);
            let spot = self.input.chart_surface.spot(middle);
            let size = self.input.field.size(middle, spot.p);
            let inward = spot.normal().cross(along);
            // Between the height of the edge's own triangle and that of the wanted one.
            let tall = (size * size - 0.25 * side.length_squared()).max(0.25 * size * size).sqrt();
            let Some(step) = spot.step(inward * tall) else { continue };
            let to = self.input.chart_surface.clamp(middle + step);
            let new = self.input.chart_surface.spot(to);
            let size = self.input.field.size(to, new.p);
            if new.p.distance(spot.p) > FRONT.max_step_ratio * tall || self.is_on_edge(to) {
                continue;
            }
            let at = self.point(to, &new);
            if self.near_node(at, size) || self.near_others(at, size, [a, b]) {
                continue;
            }
            let along = along.reject_from_normalized(new.normal()).normalize_or_zero();
            self.add(at, size, along);
            self.open.clear();
            if run.0 > best && along != DVec3::ZERO {
                (best, first) = (run.0, Some(self.grown.p.len() as u32 - 1));
            }
        }
        first
    }

    /// A node on the bisector of every corner that two triangles fill best.
    fn corners(&mut self) {
        let outline = self.input.outline;
        let mut before = vec![u32::MAX; outline.p.len()];
        outline.loops.iter().for_each(|e| before[e[1] as usize] = e[0]);
        for &[a, b] in &outline.loops {
            let Some(from) = outline.p.get(before[a as usize] as usize) else { continue };
            let (pa, pb, xy) = (outline.p[a as usize], outline.p[b as usize], outline.xy[a as usize]);
            let spot = self.input.chart_surface.spot(xy);
            let normal = spot.normal();
            let (out, back) = ((pb - pa).reject_from_normalized(normal), (*from - pa).reject_from_normalized(normal));
            let turn = math::atan2(normal.dot(out.cross(back)), out.dot(back));
            if !TWO_TRIANGLE_CORNERS.contains(&turn) {
                continue;
            }
            let way = (out.normalize_or_zero() + back.normalize_or_zero()).normalize_or_zero();
            let size = self.input.field.size(xy, pa);
            let Some(step) = spot.step(way * size) else { continue };
            let to = self.input.chart_surface.clamp(xy + step);
            let new = self.input.chart_surface.spot(to);
            let at = self.point(to, &new);
            let near = self.near_edges(FrontStep { from: xy, to: at, size }, FRONT.min_border_distance, Some(a));
            let along = way.reject_from_normalized(new.normal()).normalize_or_zero();
            let far = new.p.distance(pa) > FRONT.max_step_ratio * size || self.is_on_edge(to);
            if !near && !far && along != DVec3::ZERO && !self.near_node(at, size) {
                self.add(at, size, along);
                self.open.clear();
            }
        }
    }

    /// Whether a tip is too near to an edge of the border that is not its own.
    fn near_others(&self, to: SurfacePoint, size: f64, own: [u32; 2]) -> bool {
        let outline = self.input.outline;
        let middle = 0.5 * (outline.xy[own[0] as usize] + outline.xy[own[1] as usize]);
        self.border.any(to, FRONT.border_search_radius * size, size, |sample, _| {
            let edge = self.edges[sample.tag as usize];
            if edge == own {
                return false;
            }
            let [a, b] = edge.map(|n| n as usize);
            cross(middle, to.xy, outline.xy[a], outline.xy[b]) || apart(to.p, outline.p[a], outline.p[b]) < FRONT.min_border_distance * size
        })
    }
}
