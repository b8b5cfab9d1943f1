//! Elements that break a chord error or an angle, repaired where they are: a quad is cut along its other diagonal, and nodes are moved.
//!
//! A face that is made anew has other bad places, one element in a thousand: were lengths made shorter for each of them, there would be no
//! end to it.

use std::cell::Cell;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::chart::halves::NONE;
use crate::mesh::quad::maker::{Maker, nodes};
use crate::mesh::quad::net::{Net, least_quality};
use crate::mesh::quad::smooth::Smoother;
use crate::mesh::tri::graded_size::GradedSize;
use crate::mesh::tri::limit_table::{LimitTable, likely, load_of};

/// Rounds of moves at most.
const ROUNDS: usize = 12;
/// Rounds that may leave as many elements as before.
const IDLE: usize = 2;
/// Where more than one element in so many breaks a limit, lengths are wrong.
const FEW: usize = 12;
/// Least quality, 0 to 1, of elements that a move changes, unless it was lower.
const MIN_QUALITY: f64 = 0.65;
/// So many elements are moved by their bounds in a round, and in all rounds: more by samples, for a twentieth of the work.
const BOUNDED: (usize, usize) = (24, 32);
/// A load that is enough.
const ENOUGH: f64 = 0.98;
/// How much bounds are above samples: of elements that keep the limits, and of others at most.
const ABOVE: (f64, f64) = (1.1, 3.0);

impl Maker<'_> {
    /// Repairs elements that break a limit where they are few; what is left of them needs shorter lengths.
    pub(crate) fn repair(&self, net: &mut Net, field: &GradedSize, loads: &mut LimitTable, job: &Job) -> Result<()> {
        let (mut least, mut idle, mut bounded) = (usize::MAX, 0, 0);
        for round in 0..=ROUNDS {
            let over = self.over(net, loads);
            idle = if over.len() < least { 0 } else { idle + 1 };
            least = least.min(over.len());
            if over.is_empty() || over.len() * FEW > net.face.len() || idle > IDLE || round == ROUNDS {
                break;
            }
            let by_bounds = over.len() <= BOUNDED.0 && bounded + over.len() <= BOUNDED.1;
            bounded += if by_bounds { over.len() } else { 0 };
            self.move_nodes((net, field), &over, by_bounds, job)?;
        }
        Ok(())
    }

    /// Elements that break a limit whichever way they are cut, with the lesser load; the others are cut so that they keep it.
    fn over(&self, net: &mut Net, loads: &mut LimitTable) -> Vec<(f64, usize)> {
        let turn = |net: &mut Net, f: usize, by: usize| {
            if net.face[f][3] != NONE {
                net.face[f].rotate_left(by);
            }
        };
        let first = self.loaded(net, loads);
        first.iter().for_each(|(_, f)| turn(net, *f, 1));
        let second = self.loaded(net, loads);
        let other = |f: usize| second.binary_search_by_key(&f, |found| found.1).map_or(0.0, |k| second[k].0);
        first.iter().filter(|(load, f)| other(*f) >= *load).for_each(|(_, f)| turn(net, *f, 3));
        let own = |f: usize| first.binary_search_by_key(&f, |found| found.1).map_or(f64::INFINITY, |k| first[k].0);
        second.iter().map(|(load, f)| (load.min(own(*f)), *f)).collect()
    }

    /// Elements that break a limit as they are cut, with their loads.
    fn loaded(&self, net: &Net, loads: &mut LimitTable) -> Vec<(f64, usize)> {
        let triangulation = nodes(net);
        let all: Vec<u32> = (0..triangulation.tri.len() as u32).collect();
        loads.update(self.fit.chart, &triangulation, &all, &self.fit.limits);
        let mut next = 0;
        let load = |f: usize| {
            let own = next..next + net.corners(f).len() as u32 - 2;
            next = own.end;
            (own.map(|t| loads.of(t).worst()).fold(0.0, f64::max), f)
        };
        (0..net.face.len()).map(load).filter(|found| found.0 > 1.0).collect()
    }

    /// Moves nodes of some elements to where the worst load round them is least: by their bounds, or by samples and how much the bound of each
    /// is above them.
    fn move_nodes(&self, (net, field): (&mut Net, &GradedSize), over: &[(f64, usize)], by_bounds: bool, job: &Job) -> Result<()> {
        let found = |net: &Net, f: usize, enough: f64| {
            let half = |corners: [u32; 3]| {
                let c = corners.map(|n| n as usize);
                let (chart, at, limits) = (self.fit.chart, (c.map(|n| net.xy[n]), c.map(|n| net.p[n])), &self.fit.limits);
                if by_bounds { load_of(chart, at, limits).worst() } else { likely(chart, at, limits) }
            };
            let [a, b, c, d] = net.face[f];
            if d == NONE {
                return half([a, b, c]);
            }
            let cut = half([a, b, c]).max(half([a, c, d]));
            if cut <= enough { cut } else { cut.min(half([b, c, d]).max(half([b, d, a]))) }
        };
        let mut above = vec![if by_bounds { 1.0 } else { ABOVE.0 }; net.face.len()];
        if !by_bounds {
            over.iter().for_each(|(load, f)| above[*f] = (load / found(net, *f, 0.0)).clamp(ABOVE.0, ABOVE.1));
        }
        let load = |net: &Net, f: usize| above[f] * found(net, f, ENOUGH / above[f]);
        let mut smoother = Smoother::new(net, self.fit.chart, field);
        for f in over.iter().map(|found| found.1) {
            for n in smoother.net.face[f] {
                if n == NONE || n < smoother.net.fixed || load(smoother.net, f) <= ENOUGH {
                    continue;
                }
                let least = least_quality(smoother.net, smoother.faces(n as usize)).min(MIN_QUALITY);
                let best = Cell::new(f64::INFINITY);
                let score = |net: &Net, faces: &[u32]| {
                    let mut most = if least_quality(net, faces) < least { f64::INFINITY } else { 0.0 };
                    for f in faces {
                        // Once it is no better than another place, that is all there is to know.
                        if most > best.get() {
                            break;
                        }
                        most = load(net, *f as usize).max(most);
                    }
                    best.set(most.min(best.get()));
                    -most
                };
                smoother.climb(n as usize, (&score, -ENOUGH));
                job.go_on()?;
            }
        }
        Ok(())
    }
}
