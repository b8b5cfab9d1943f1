//! Repair of elements that exceed the chord error or the angle: a quad is cut along its other diagonal, and nodes are moved.
//!
//! A face that is made anew has other bad places, one element in a thousand: shorter lengths for each of them would not converge.

use std::cell::Cell;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::chart::halves::NONE;
use crate::mesh::quad::net::{Net, least_quality};
use crate::mesh::quad::net_fit::{NetFit, nodes};
use crate::mesh::quad::settings::LIMIT_REPAIR;
use crate::mesh::quad::smooth::Smoother;
use crate::mesh::tri::graded_size::GradedSize;
use crate::mesh::tri::limit_table::{ChartTriangle, LimitTable, ratio_of, sampled_ratio};

impl NetFit<'_> {
    /// Repairs elements that exceed a limit where they are few; the remaining ones need shorter lengths.
    pub(crate) fn repair(&self, net: &mut Net, field: &GradedSize, ratios: &mut LimitTable, job: &Job) -> Result<()> {
        let (mut least, mut idle, mut bounded) = (usize::MAX, 0, 0);
        for round in 0..=LIMIT_REPAIR.max_rounds {
            let over = self.over(net, ratios);
            idle = if over.len() < least { 0 } else { idle + 1 };
            least = least.min(over.len());
            if over.is_empty()
                || over.len() * LIMIT_REPAIR.few > net.face.len()
                || idle > LIMIT_REPAIR.max_idle_rounds
                || round == LIMIT_REPAIR.max_rounds
            {
                break;
            }
            let by_bounds = over.len() <= LIMIT_REPAIR.max_bounded_in_round && bounded + over.len() <= LIMIT_REPAIR.max_bounded;
            bounded += if by_bounds { over.len() } else { 0 };
            self.move_nodes(net, field, &over, by_bounds, job)?;
        }
        Ok(())
    }

    /// Elements that exceed a limit with either diagonal, with the lesser ratio; the others get the diagonal that keeps it.
    fn over(&self, net: &mut Net, ratios: &mut LimitTable) -> Vec<(f64, usize)> {
        let turn = |net: &mut Net, f: usize, by: usize| {
            if net.face[f][3] != NONE {
                net.face[f].rotate_left(by);
            }
        };
        let first = self.over_limit(net, ratios);
        first.iter().for_each(|(_, f)| turn(net, *f, 1));
        let second = self.over_limit(net, ratios);
        let other = |f: usize| second.binary_search_by_key(&f, |found| found.1).map_or(0.0, |k| second[k].0);
        first.iter().filter(|(ratio, f)| other(*f) >= *ratio).for_each(|(_, f)| turn(net, *f, 3));
        let own = |f: usize| first.binary_search_by_key(&f, |found| found.1).map_or(f64::INFINITY, |k| first[k].0);
        second.iter().map(|(ratio, f)| (ratio.min(own(*f)), *f)).collect()
    }

    /// Elements that exceed a limit with their diagonal, with their ratios.
    fn over_limit(&self, net: &Net, ratios: &mut LimitTable) -> Vec<(f64, usize)> {
        let triangulation = nodes(net);
        let all: Vec<u32> = (0..triangulation.tri.len() as u32).collect();
        ratios.update(self.fit.chart, &triangulation, &all, &self.fit.limits);
        let mut next = 0;
        let ratio = |f: usize| {
            let own = next..next + net.corners(f).len() as u32 - 2;
            next = own.end;
            (own.map(|t| ratios.of(t).worst()).fold(0.0, f64::max), f)
        };
        (0..net.face.len()).map(ratio).filter(|found| found.0 > 1.0).collect()
    }

    /// Moves nodes of some elements to where the worst ratio round them is least: by their bounds, or by samples and how much the bound of each
    /// is above them.
    fn move_nodes(&self, net: &mut Net, field: &GradedSize, over: &[(f64, usize)], by_bounds: bool, job: &Job) -> Result<()> {
        let found = |net: &Net, f: usize, enough: f64| {
            let half = |corners: [u32; 3]| {
                let c = corners.map(|n| n as usize);
                let (chart, limits) = (self.fit.chart, &self.fit.limits);
                let triangle = ChartTriangle { xy: c.map(|n| net.xy[n]), p: c.map(|n| net.p[n]) };
                if by_bounds { ratio_of(chart, triangle, limits).worst() } else { sampled_ratio(chart, triangle, limits) }
            };
            let [a, b, c, d] = net.face[f];
            if d == NONE {
                return half([a, b, c]);
            }
            let cut = half([a, b, c]).max(half([a, c, d]));
            if cut <= enough { cut } else { cut.min(half([b, c, d]).max(half([b, d, a]))) }
        };
        let mut above = vec![if by_bounds { 1.0 } else { LIMIT_REPAIR.bound_over_sample.start }; net.face.len()];
        if !by_bounds {
            over.iter().for_each(|(ratio, f)| {
                above[*f] = (ratio / found(net, *f, 0.0)).clamp(LIMIT_REPAIR.bound_over_sample.start, LIMIT_REPAIR.bound_over_sample.end)
            });
        }
        let ratio = |net: &Net, f: usize| above[f] * found(net, f, LIMIT_REPAIR.target_ratio / above[f]);
        let mut smoother = Smoother::new(net, self.fit.chart, field);
        for f in over.iter().map(|found| found.1) {
            for n in smoother.net.face[f] {
                if n == NONE || n < smoother.net.fixed || ratio(smoother.net, f) <= LIMIT_REPAIR.target_ratio {
                    continue;
                }
                let least = least_quality(smoother.net, smoother.faces(n as usize)).min(LIMIT_REPAIR.min_quality);
                let best = Cell::new(f64::INFINITY);
                let score = |net: &Net, faces: &[u32]| {
                    let mut most = if least_quality(net, faces) < least { f64::INFINITY } else { 0.0 };
                    for f in faces {
                        // A place that is no better than another one needs no exact score.
                        if most > best.get() {
                            break;
                        }
                        most = ratio(net, *f as usize).max(most);
                    }
                    best.set(most.min(best.get()));
                    -most
                };
                smoother.climb(n as usize, &score, -LIMIT_REPAIR.target_ratio);
                job.go_on()?;
            }
        }
        Ok(())
    }
}
