//! The balls along an edge, found by a march along the way of their centres.
//!
//! Planes across the edge at places along it would not do: where it bends sharply, the way of the centres meets them in another order.

use glam::DVec3;

use crate::surface::rolling::ball::{Ball, Guess, LEFT, STARTS};
use crate::surface::rolling::station::BallStation;

/// Balls along an edge at most.
const MOST_ALONG: usize = 1024;
/// Share of a step by which the first ball is farther on than the next one, and taken for it.
const BEYOND: f64 = 0.25;
/// Cosines of the largest turn of the centre's way from one to the next, about 41°, and of half of it.
const TURN: f64 = 0.75;
const CHORD: f64 = 0.935;

/// The next step of the march.
enum Next {
    Ball(BallStation),
    /// Nothing: it is the last one.
    End,
    /// No ball is found although the surfaces go on.
    Lost,
}

impl Ball {
    /// The balls of a radius along the edge, of a closed one the last one the first, of an open one beyond its ends until they touch
    /// inside no surface; where there is none, the place.
    pub fn stations(&self, radius: f64) -> std::result::Result<Vec<BallStation>, DVec3> {
        let middle = STARTS / 2;
        // An open edge has one in its middle, if it has any.
        let mut places = if self.closed { 0..STARTS } else { middle..middle + 1 };
        let grown = |k: usize| self.grown(&self.starts[k], radius).filter(|ball| self.holds(ball) && self.leaves(ball));
        let first = places.find_map(grown).ok_or(self.starts[middle].at)?;
        let mut all = vec![first];
        self.walk(radius, &mut all)?;
        if self.closed {
            let reach = |k: usize| all.iter().map(|s| s.feet[k].distance(first.feet[k])).fold(0.0, f64::max);
            // Where it touches one of the surfaces in hardly more than a point it leaves nothing of it.
            let is_point = (0..2).any(|k| reach(k) <= LEFT * self.tolerance.point);
            return if is_point { Err(self.beside(&first)) } else { Ok(all) };
        }
        turn(&mut all);
        self.walk(radius, &mut all)?;
        turn(&mut all);
        Ok(all)
    }

    /// The place of the edge beside a ball.
    fn beside(&self, station: &BallStation) -> DVec3 {
        self.edge.closest(station.center).1
    }

    /// Adds balls in the direction of the last one's way.
    fn walk(&self, radius: f64, all: &mut Vec<BallStation>) -> std::result::Result<(), DVec3> {
        let longest = self.edge.length() / STARTS as f64;
        let (mut step, mut beyond) = (longest, false);
        while all.len() < MOST_ALONG {
            crate::base::job::poll();
            let last = all[all.len() - 1];
            let kept = self.holds(&last) && self.leaves(&last);
            // Towards the ends of an open edge it may leave the surfaces, for good.
            if kept && (beyond || !self.fits(&last, radius)) || !kept && self.closed {
                return Err(self.beside(&last));
            }
            beyond |= !kept;
            match self.next(radius, all, &mut step, longest) {
                Next::Ball(next) => all.push(next),
                Next::End => return Ok(()),
                Next::Lost if beyond => return Ok(()),
                Next::Lost => return Err(self.beside(&last)),
            }
        }
        Err(self.beside(&all[all.len() - 1]))
    }

    /// What follows the last one of some balls.
    fn next(&self, radius: f64, all: &[BallStation], step: &mut f64, longest: f64) -> Next {
        let (first, last) = (all[0], all[all.len() - 1]);
        let is_last = match self.closed {
            true => all.len() > 1 && last.center == first.center,
            false => (0..2).all(|k| !self.is_inside(&last, k)),
        };
        if is_last {
            return Next::End;
        }
        if !self.closed
            && let Some(end) = self.at_ends(radius, &last, *step)
        {
            return Next::Ball(end);
        }
        loop {
            if let Some(next) = self.ahead(radius, &last, *step) {
                // The first one is between them, or hardly beyond.
                let back = (first.center - last.center).dot(last.way) > 0.0 && (first.center - next.center).dot(next.way) <= BEYOND * *step;
                if self.closed && all.len() > 1 && back && follows(&last, &first, *step) {
                    return Next::Ball(first);
                }
                *step = (2.0 * *step).min(longest);
                return Next::Ball(next);
            }
            if *step <= self.tolerance.point {
                return Next::Lost;
            }
            *step *= 0.5;
        }
    }

    /// The ball in the plane across an open edge at an end of it, where that is less than a step ahead.
    fn at_ends(&self, radius: f64, last: &BallStation, step: f64) -> Option<BallStation> {
        let guess = Guess { uv: last.uv, points: last.feet };
        let ends = [&self.starts[0], &self.starts[STARTS]].into_iter().filter_map(|end| {
            let way = if end.along.dot(last.way) < 0.0 { -end.along } else { end.along };
            let ahead = (end.at - last.center).dot(way);
            let there = (ahead > self.tolerance.point && ahead <= step).then(|| self.station(radius, (end.at, way), &guess))??;
            follows(last, &there, step).then_some(there)
        });
        ends.min_by(|a, b| a.center.distance(last.center).total_cmp(&b.center.distance(last.center)))
    }

    /// The ball about a step of its centre farther on, where that turns little.
    pub fn ahead(&self, radius: f64, last: &BallStation, step: f64) -> Option<BallStation> {
        let guess = Guess { uv: last.uv, points: [0, 1].map(|k: usize| last.feet[k] + last.rates[k] * step) };
        let next = self.station(radius, (last.center + last.way * step, last.way), &guess)?;
        follows(last, &next, step).then_some(next)
    }
}

/// Balls the other way round.
pub(crate) fn turn(all: &mut [BallStation]) {
    all.reverse();
    all.iter_mut().for_each(BallStation::turn);
}

/// Whether a ball is farther on by about a step on the way of another one's centre, and not on another branch of it: the way turns little,
/// the chord looks along it at both ends, and the feet are on the same sides of it. Where surfaces are nearly tangent, branches on which
/// they have changed sides are near.
fn follows(last: &BallStation, next: &BallStation, step: f64) -> bool {
    let by = next.center - last.center;
    let along = by.dot(last.way).min(by.dot(next.way));
    let sides = |s: &BallStation| (s.feet[0] - s.center).cross(s.feet[1] - s.center).dot(s.way).signum();
    let close = next.way.dot(last.way) >= TURN && along >= CHORD * by.length() && by.length() <= 2.0 * step;
    close && sides(last) == sides(next)
}
