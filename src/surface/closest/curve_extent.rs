//! The box that a curve just fits into.

use std::collections::VecDeque;

use crate::base::bbox::Box3;
use crate::base::tolerance::{BOX, EPSILON};
use crate::network::Chain;
use crate::surface::closest::samples::stations;
use crate::surface::data::breaks::chain_breaks;

/// Pieces looked at before what is left is taken by its bound.
const MOST: usize = 20_000;

/// The smallest box along the axes that holds a curve: no point of it stands out by more than [`BOX`] of the diagonal.
///
/// Turning points between samples are found by bisection of the slope; bounds of the derivatives over ever shorter
/// pieces then show that nothing lies further out, or find what does.
pub fn curve_bbox(chain: &Chain) -> Box3 {
    curve_bbox_between(chain, 0.0, 1.0)
}

/// The same of what of a curve lies between two fractions of it.
pub(crate) fn curve_bbox_between(chain: &Chain, from: f64, to: f64) -> Box3 {
    let inner = stations(&chain_breaks(chain)).into_iter().filter(|f| *f > from && *f < to);
    let stops: Vec<f64> = [from].into_iter().chain(inner).chain([to]).collect();
    let mut bounds = Box3::of(stops.iter().map(|&f| chain.point(f)));
    for w in stops.windows(2) {
        for axis in 0..3 {
            let slope = |f: f64| chain.jet(f).d1[axis];
            let (mut low, mut high) = (w[0], w[1]);
            let falls = slope(low) < 0.0;
            if falls == (chain.jet_before(high).d1[axis] < 0.0) {
                continue;
            }
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if (slope(middle) < 0.0) == falls { low = middle } else { high = middle }
            }
            bounds = bounds.with(chain.point(low));
        }
    }
    proved(chain, &stops, bounds)
}

/// Grows a box of points of the curve until it holds the curve, by branch and bound.
fn proved(chain: &Chain, stops: &[f64], mut bounds: Box3) -> Box3 {
    let room = BOX * bounds.diagonal();
    let mut open: VecDeque<(f64, f64)> = stops.windows(2).map(|w| (w[0], w[1])).collect();
    let mut seen = 0;
    while let Some((from, to)) = open.pop_front() {
        let ends = Box3::of([chain.point(from), chain.point(to)]);
        bounds = bounds.union(ends);
        let (h, enclosure) = (to - from, chain.enclosure(from, to));
        let mut hull = ends;
        for k in 0..3 {
            let (d1, d2) = (enclosure.d1.coordinate(k), enclosure.d2.coordinate(k));
            if d1.low < 0.0 && d1.high > 0.0 {
                // Off the line between its ends by the slope alone, or by the second derivative and the jumps of the slope.
                let reach = (0.5 * h * d1.reach()).min(0.125 * h * h * d2.reach() + 0.25 * h * enclosure.jumps[k]);
                hull.min[k] -= reach;
                hull.max[k] += reach;
            }
        }
        let over = (hull.max - bounds.max).max(bounds.min - hull.min).max_element();
        if over <= room {
            continue;
        }
        seen += 1;
        if seen > MOST || h <= EPSILON {
            bounds = bounds.union(hull);
            continue;
        }
        let middle = 0.5 * (from + to);
        open.extend([(from, middle), (middle, to)]);
    }
    bounds
}
