//! The balls along an edge.

use glam::DVec3;

use crate::surface::rolling::ball::{Ball, Guess, LEFT, STARTS};
use crate::surface::rolling::station::BallStation;

/// Balls round a closed edge at most, and the cosine of the largest turn of the centre's way from one to the next.
const MOST_AROUND: usize = 1024;
const TURN: f64 = 0.75;

impl Ball {
    /// The balls of a radius at places along the edge; where there is none, the place.
    pub fn stations(&self, radius: f64) -> std::result::Result<Vec<BallStation>, DVec3> {
        let found = self.beside_starts(radius);
        let even = |all: &[BallStation]| all.windows(2).all(|w| w[0].way.dot(w[1].way) >= TURN);
        let found = if self.closed && !found.as_ref().is_ok_and(|all| even(all)) { self.around(radius) } else { found };
        found.and_then(|all| match self.closed && self.is_point(&all) {
            true => Err(self.edge.closest(all[0].center).1),
            false => Ok(all),
        })
    }

    /// Whether the points where balls touch one of the surfaces are hardly more than one.
    fn is_point(&self, stations: &[BallStation]) -> bool {
        let reach = |k: usize| stations.iter().map(|s| s.feet[k].distance(stations[0].feet[k])).fold(0.0, f64::max);
        (0..2).any(|k| reach(k) <= LEFT * self.tolerance.point)
    }

    /// The ball about a step of its centre farther on, where that turns little.
    pub fn ahead(&self, radius: f64, last: &BallStation, step: f64) -> Option<BallStation> {
        let guess = Guess { uv: last.uv, points: [0, 1].map(|k: usize| last.feet[k] + last.rates[k] * step) };
        let next = self.station(radius, (last.center + last.way * step, last.way), &guess)?;
        (next.way.dot(last.way) >= TURN && next.center.distance(last.center) <= 2.0 * step).then_some(next)
    }

    /// The same in planes across the edge at equal steps.
    fn beside_starts(&self, radius: f64) -> std::result::Result<Vec<BallStation>, DVec3> {
        let mut all = Vec::with_capacity(self.starts.len());
        for start in &self.starts {
            crate::base::job::poll();
            all.push(self.grown(start, radius).ok_or(start.at)?);
        }
        if self.closed {
            all[STARTS] = all[0];
        }
        let kept: Vec<bool> = all.iter().map(|s| self.holds(s) && self.leaves(s)).collect();
        // Towards the ends of an open edge it may leave the surfaces for good.
        let gone = |k: usize| if k < STARTS / 2 { kept[..k].iter().all(|x| !x) } else { kept[k..].iter().all(|x| !x) };
        let within = |k: usize| kept[k] || !self.closed && k != STARTS / 2 && gone(k);
        match (0..=STARTS).find(|k| !within(*k) || !self.fits(&all[*k], radius)) {
            Some(k) => Err(self.starts[k].at),
            None => Ok(all),
        }
    }

    /// The balls of a radius along a closed edge, the last one the first: from one of them on in the direction of its centre's way. A
    /// large ball's centre runs on a small closed curve, and not past the places of the edge one after the other.
    fn around(&self, radius: f64) -> std::result::Result<Vec<BallStation>, DVec3> {
        let beside = |p: DVec3| self.edge.closest(p).1;
        let first = self.starts[..STARTS].iter().find_map(|start| self.grown(start, radius)).ok_or(self.starts[0].at)?;
        let longest = self.edge.length() / STARTS as f64;
        let (mut step, mut all) = (longest, vec![first]);
        while all.len() < MOST_AROUND {
            crate::base::job::poll();
            let last = all[all.len() - 1];
            if !(self.holds(&last) && self.leaves(&last) && self.fits(&last, radius)) {
                return Err(beside(last.center));
            }
            let back = first.center - last.center;
            if back.dot(last.way) > 0.0 && back.length() <= step && first.way.dot(last.way) >= TURN {
                all.push(first);
                return Ok(all);
            }
            match self.ahead(radius, &last, step) {
                Some(next) => {
                    all.push(next);
                    step = (2.0 * step).min(longest);
                }
                None if step <= self.tolerance.point => break,
                None => step *= 0.5,
            }
        }
        Err(beside(all[all.len() - 1].center))
    }
}
