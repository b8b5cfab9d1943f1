//! The box that a surface just fits into.

use glam::DVec3;

use super::closest::stations;
use super::core::{Domain, Side, Surface};
use super::descent::{Local, descend};
use crate::base::bbox::Box3;
use crate::network::Chain;

/// The smallest box along the axes that holds the surface: from the extreme samples a descent finds the extreme points.
///
/// Like nearest points this rests on samples of every cell; an extreme reached inside a dent narrower than a sample
/// step may be missed.
pub fn bbox(surface: &Surface) -> Box3 {
    if surface.domain() == Domain::Unbounded {
        return Box3 { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
    }
    if surface.domain() == Domain::Loop {
        return (0..surface.n_sides()).fold(Box3::EMPTY, |bounds, k| match surface.side(k) {
            Side::Chain { chain, .. } => bounds.union(chain_bbox(&chain)),
            _ => bounds,
        });
    }
    let (us, vs) = surface.cells();
    let (xs, ys) = (stations(&us), stations(&vs));
    let jets = surface.square_jets(&xs, &ys);
    let mut bounds = Box3::of(jets.iter().map(|jet| jet.p));
    for direction in 0..6 {
        let (axis, sign) = (direction / 2, if direction % 2 == 0 { 1.0 } else { -1.0 });
        let height = |k: usize| sign * jets[k].p[axis];
        // The lowest few samples: neighbouring ones fall to the same minimum.
        let mut order: Vec<usize> = (0..jets.len()).collect();
        order.sort_by(|&a, &b| height(a).total_cmp(&height(b)).then(a.cmp(&b)));
        for &k in order.iter().take(4) {
            let start = (xs[k % xs.len()], ys[k / xs.len()]);
            let end = descend(surface, start, |jet| Local {
                value: sign * jet.p[axis],
                gradient: [sign * jet.du[axis], sign * jet.dv[axis]],
                hessian: [sign * jet.duu[axis], sign * jet.duv[axis], sign * jet.dvv[axis]],
            });
            bounds = bounds.with(surface.square_jet(end.place.0, end.place.1).p);
        }
    }
    bounds
}

/// The box of a chain by samples and Newton's method on each coordinate's slope.
fn chain_bbox(chain: &Chain) -> Box3 {
    let stops = stations(&super::breaks::chain_breaks(chain));
    let mut bounds = Box3::of(stops.iter().map(|&f| chain.point(f)));
    for w in stops.windows(2) {
        for axis in 0..3 {
            let slope = |f: f64| chain.jet(f).d1[axis];
            let (mut low, mut high) = (w[0], w[1]);
            let rising = slope(low) < 0.0;
            if rising == (chain.jet_before(high).d1[axis] < 0.0) {
                continue;
            }
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if (slope(middle) < 0.0) == rising { low = middle } else { high = middle }
            }
            bounds = bounds.with(chain.point(low));
        }
    }
    bounds
}
