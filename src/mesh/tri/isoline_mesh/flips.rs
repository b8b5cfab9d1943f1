//! Sides between cells and borders, flipped to where the triangles beside them are less over the limits: a constrained Delaunay triangulation
//! joins nodes that are near each other, across the bends of the surface as well as along them.

use crate::base::job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::chart::outline::is_left;
use crate::mesh::tri::isoline_mesh::IsolineMesher;
use crate::mesh::tri::limit_table::{self, LimitRatios};
use crate::mesh::tri::placement_settings::ISOLINES;
use crate::mesh::tri::triangulation::Triangulation;

impl IsolineMesher<'_> {
    /// The ratios of a triangle beside a border; `None` where it is flat and does not wrap round.
    ///
    /// At a pole the chart has edges that are points in space, and lines of the surface run into it: a triangle on such an edge, or with its
    /// corners on such a line, has nothing to keep.
    pub(crate) fn ratio_beside(&self, triangulation: &Triangulation, c: [u32; 3]) -> Option<LimitRatios> {
        let has_nothing = self.is_flat(triangulation, c) && !self.wraps(triangulation, c);
        (!has_nothing).then(|| limit_table::ratio_of_long(self.input.chart, triangulation, c, self.input.limits, &self.normals))
    }

    /// Flips sides of triangles over the limits while the worse of the two beside one gets better; `ratios` are those of the triangles,
    /// without those that are sure.
    pub(crate) fn flip_over(&self, triangulation: &mut Triangulation, ratios: &mut [Option<LimitRatios>]) {
        let over = |ratio: Option<LimitRatios>| ratio.is_some_and(|ratio| ratio.worst() > 1.0);
        let mut open: Vec<u32> = (0..triangulation.tri.len() as u32).rev().filter(|t| over(ratios[*t as usize])).collect();
        let twins = self.input.outline.twins();
        let mut left = ISOLINES.max_flips * triangulation.tri.len();
        while let (Some(t), true) = (open.pop(), left > 0) {
            job::poll();
            if !over(ratios[t as usize]) {
                continue;
            }
            let joins_twice = |k: usize| {
                let (a, _, _, tip) = triangulation.round_side(t, k);
                triangulation.joined_elsewhere(&twins, a, tip)
            };
            let ways = (0..3).filter_map(|k| self.flipped(triangulation, ratios, t, k).map(|found| (k, found)));
            let best = ways.filter(|(k, _)| !joins_twice(*k)).min_by(|a, b| worst(&a.1).total_cmp(&worst(&b.1)));
            let Some((k, found)) = best else { continue };
            let other = triangulation.across[t as usize][k];
            triangulation.flip(t, k);
            left -= 1;
            [ratios[t as usize], ratios[other as usize]] = found;
            let around = [t, other].into_iter().flat_map(|t| triangulation.across[t as usize]).filter(|t| *t != NO_TRIANGLE);
            open.extend(around);
        }
    }

    /// The ratios of the two triangles that a flip makes of those at side `k` of `t`, where that is allowed and their worse one is less.
    fn flipped(&self, triangulation: &Triangulation, ratios: &[Option<LimitRatios>], t: u32, k: usize) -> Option<[Option<LimitRatios>; 2]> {
        let other = triangulation.across[t as usize][k];
        if other == NO_TRIANGLE || triangulation.locked[t as usize] >> k & 1 == 1 {
            return None;
        }
        let (a, b, d, tip) = triangulation.round_side(t, k);
        let (p, xy) = (|n: u32| triangulation.p[n as usize], |n: u32| triangulation.xy[n as usize]);
        let most = self.input.rules.at(p(a), self.input.size).max(self.input.rules.at(p(tip), self.input.size));
        let convex = is_left(xy(a), xy(b), xy(tip)) && is_left(xy(a), xy(tip), xy(d));
        if !convex || p(a).distance(p(tip)) > ISOLINES.max_side_ratio * most {
            return None;
        }
        let now = worst(&[ratios[t as usize], ratios[other as usize]]);
        let one = self.ratio_beside(triangulation, [a, b, tip]).filter(|one| one.worst() < now)?;
        let next = self.ratio_beside(triangulation, [a, tip, d]).filter(|next| next.worst() < now)?;
        Some([Some(one), Some(next)])
    }
}

/// The worse of two triangles.
fn worst(of: &[Option<LimitRatios>; 2]) -> f64 {
    of.iter().flatten().map(LimitRatios::worst).fold(0.0, f64::max)
}
