//! The part of a surface below a plane: where rows and borders cross it.

use glam::DVec3;

use crate::base::solve::{bracketed, turn};
use crate::base::tolerance::EPSILON;
use crate::surface::Surface;

/// A row is halved at most so often in search of its crossings.
const MAX_DEPTH: u32 = 30;
/// Parts of a border between two stops, at whose ends its side of the plane is looked at.
const PARTS: usize = 8;

/// Points with n·p < d.
#[derive(Clone, Copy, Debug)]
pub struct Below {
    /// Unit normal of the plane.
    pub normal: DVec3,
    /// Distance of the plane from the origin along it, model units.
    pub distance: f64,
}

impl Below {
    /// Height over the plane, model units.
    pub fn height(self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.distance
    }

    /// Adds the parameters at which a curve crosses the plane to its ascending stops.
    pub fn add_stops(self, stops: &mut Vec<f64>, point: impl Fn(f64) -> DVec3) {
        let mut found = Vec::new();
        for w in stops.windows(2) {
            let place = |k: usize| w[0] + (w[1] - w[0]) * k as f64 / PARTS as f64;
            let heights: Vec<f64> = (0..=PARTS).map(|k| self.height(point(place(k)))).collect();
            for k in 0..PARTS {
                let (low, high) = (place(k), place(k + 1));
                if heights[k + 1] == 0.0 {
                    found.push(high);
                }
                if heights[k] * heights[k + 1] < 0.0 {
                    found.extend(turn(low, high, heights[k] > 0.0, |t| Some(self.height(point(t)) > 0.0)));
                }
            }
        }
        stops.extend(found);
        stops.sort_by(f64::total_cmp);
        stops.dedup();
    }
}

/// Ends of a row of constant v, and where it crosses a plane: from bounds of heights and slopes, none is missed.
pub fn crossings(surface: &Surface, plane: Below, (low, high): (f64, f64), v: f64) -> Vec<f64> {
    let mut stops = vec![low, high];
    let mut open = vec![(low.min(high), low.max(high), 0)];
    while let Some((a, b, depth)) = open.pop() {
        let known = surface.enclosure((a, b), (v, v));
        let (height, slope) = (known.p.along(plane.normal), known.du.along(plane.normal));
        if height.low >= plane.distance || height.high <= plane.distance {
            continue;
        }
        if slope.low > 0.0 || slope.high < 0.0 {
            let level = |u: f64| {
                let jet = surface.jet(u, v);
                (plane.height(jet.p), plane.normal.dot(jet.du))
            };
            if level(a).0 * level(b).0 < 0.0 {
                stops.push(bracketed(a, b, EPSILON * (b - a), level));
            }
        } else if depth < MAX_DEPTH {
            let middle = 0.5 * (a + b);
            open.extend([(a, middle, depth + 1), (middle, b, depth + 1)]);
        }
    }
    stops.sort_by(f64::total_cmp);
    if low > high {
        stops.reverse();
    }
    stops
}
