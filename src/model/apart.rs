//! Distances of surfaces from curves and from each other, from samples and descents: never below the true ones.

use glam::DVec3;

use crate::base::math::unit;
use crate::base::solve::lowest;
use crate::base::tolerance::{NEAREST, PARALLEL};
use crate::network::Chain;
use crate::surface::{Domain, Nearest, Surface, chain_breaks};

/// Samples of a curve between its breaks.
const EACH: usize = 12;
/// Local minima tried.
const STARTS: usize = 6;
/// Projections from one surface to the other before the pair is taken as it is.
const ROUNDS: usize = 200;
/// Samples of a surface along each direction.
const GRID: usize = 24;

/// Shortest distance of a curve from a surface, model units.
pub fn from_curve(surface: &Surface, curve: &Chain) -> f64 {
    let nearest = Nearest::new(surface);
    let far = |f: f64| nearest.at(curve.point(f)).distance;
    let stops = [vec![0.0], chain_breaks(curve), vec![1.0]].concat();
    let cell = |w: &[f64]| -> Vec<f64> { (0..EACH).map(|k| w[0] + (w[1] - w[0]) * k as f64 / EACH as f64).collect() };
    let stations: Vec<f64> = stops.windows(2).flat_map(cell).chain([1.0]).collect();
    let values: Vec<f64> = stations.iter().map(|f| far(*f)).collect();
    let last = stations.len() - 1;
    let mut lows: Vec<usize> =
        (0..=last).filter(|&k| values[k] <= values[k.saturating_sub(1)] && values[k] <= values[(k + 1).min(last)]).collect();
    lows.sort_by(|a, b| values[*a].total_cmp(&values[*b]).then(a.cmp(b)));
    let refined = |k: &usize| {
        let f = lowest(stations[k.saturating_sub(1)], stations[(k + 1).min(last)], NEAREST, far);
        far(f).min(values[*k])
    };
    lows.iter().take(STARTS).map(refined).fold(f64::INFINITY, f64::min)
}

/// Shortest distance of two surfaces, model units.
pub fn between(a: &Surface, b: &Surface) -> f64 {
    match (a.domain(), b.domain()) {
        (Domain::Unbounded, Domain::Unbounded) => {
            let (m, n) = (a.normal(0.0, 0.0), b.normal(0.0, 0.0));
            let parallel = m.cross(n).length() <= PARALLEL;
            if parallel { (b.point(0.0, 0.0) - a.point(0.0, 0.0)).dot(m).abs() } else { 0.0 }
        }
        (Domain::Unbounded, _) => off_plane(a, b),
        (_, Domain::Unbounded) => off_plane(b, a),
        _ => bounded(a, b),
    }
}

/// Points of a surface that stand for it: a grid, of a plane without a map its border.
fn samples(surface: &Surface) -> Vec<DVec3> {
    if surface.domain() == Domain::Loop {
        let place = |k: usize| k as f64 / (GRID * GRID) as f64;
        let sides = (0..surface.n_sides()).map(|k| surface.side(k));
        let chains = sides.filter_map(|side| if let crate::surface::Side::Chain { chain, .. } = side { Some(chain) } else { None });
        return chains.flat_map(|c| (0..=GRID * GRID).map(move |k| c.point(place(k)))).collect();
    }
    let at: Vec<f64> = (0..=GRID).map(|k| k as f64 / GRID as f64).collect();
    surface.square_jets(&at, &at).iter().map(|jet| jet.p).collect()
}

/// Distance of a surface from an unbounded plane.
fn off_plane(plane: &Surface, surface: &Surface) -> f64 {
    let (at, normal) = (plane.point(0.0, 0.0), plane.normal(0.0, 0.0));
    let side = |p: DVec3| (p - at).dot(normal);
    let points = samples(surface);
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(side(*p)), h.max(side(*p))));
    if low <= 0.0 && high >= 0.0 {
        return 0.0;
    }
    refined(&points, &Nearest::new(plane), &Nearest::new(surface))
}

fn bounded(a: &Surface, b: &Surface) -> f64 {
    refined(&samples(a), &Nearest::new(b), &Nearest::new(a))
}

/// From the nearest of some points of one surface, feet on the other one and back until they rest.
fn refined(points: &[DVec3], other: &Nearest, own: &Nearest) -> f64 {
    let mut starts: Vec<(f64, DVec3)> = points.iter().map(|p| (other.at(*p).distance, *p)).collect();
    starts.sort_by(|x, y| x.0.total_cmp(&y.0));
    let descent = |(first, p): &(f64, DVec3)| {
        let (mut p, mut best) = (*p, *first);
        for _ in 0..ROUNDS {
            let foot = other.at(p);
            let back = own.at(foot.point);
            let nearer = back.distance.min(foot.distance);
            let rests = best - nearer <= NEAREST * best;
            best = best.min(nearer);
            if rests || unit(back.point - p, 0.0).is_none() {
                break;
            }
            p = back.point;
        }
        best
    };
    starts.iter().take(STARTS).map(descent).fold(f64::INFINITY, f64::min)
}
