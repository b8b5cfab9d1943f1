//! Flat faces below the water plane, from their borders by Green's theorem in their own plane.

use glam::DVec3;

use super::face::Face;
use super::sums::{WET, Wet, wet_densities};
use super::water::Water;
use super::wet_cells::{Scale, WetRules};
use crate::base::job;
use crate::base::tolerance::{FLOAT_LEVEL, NUDGE};
use crate::model::measure::Below;
use crate::model::measure_flat::{boundary, gaps, runs};

/// A run of a border is halved at most so often.
const MAX_DEPTH: u32 = 14;

/// A path of points by a parameter between two values.
type Path<'a> = (Box<dyn Fn(f64) -> (DVec3, DVec3) + 'a>, f64, f64);

/// The border of a flat face: points with their derivatives, cut where it crosses a plane.
fn border<'a>(walks: &'a [crate::model::measure_flat::Boundary], below: Below) -> Vec<Path<'a>> {
    let mut paths: Vec<Path> = Vec::new();
    for walk in walks {
        for (k, from, to) in runs(walk) {
            let chain = &walk[k].0;
            let mut stops = vec![from.min(to), from.max(to)];
            below.add_stops(&mut stops, |t| chain.point(t));
            let at = move |t: f64| {
                let jet = chain.jet(t);
                (jet.p, jet.d1)
            };
            let ordered: Vec<(f64, f64)> = stops.windows(2).map(|w| if from < to { (w[0], w[1]) } else { (w[1], w[0]) }).collect();
            paths.extend(ordered.into_iter().map(|(a, b)| (Box::new(at) as Box<dyn Fn(f64) -> (DVec3, DVec3)>, a, b)));
        }
        for (a, b) in gaps(walk) {
            paths.push((Box::new(move |t| (a + (b - a) * t, b - a)), 0.0, 1.0));
        }
    }
    paths
}

/// Points at which the border of a flat face crosses a plane.
pub fn crossings(face: &Face, below: Below) -> Vec<DVec3> {
    let walks = boundary(face.prepared.surface());
    let ends = |(at, a, b): &Path| [at(*a).0, at(*b).0];
    let close = |p: &DVec3| below.height(*p).abs() <= face.cells[0].bounds.diagonal() * NUDGE;
    border(&walks, below).iter().flat_map(ends).filter(close).collect()
}

/// Half the sum, over the parts of the border on either side of a plane, of what a function rises by along them, with the sign of the side:
/// parts that follow each other on one side cancel, so that the ends of chords in the plane are left.
pub fn chord_sum(face: &Face, below: Below, value: &impl Fn(DVec3) -> f64) -> f64 {
    let walks = boundary(face.prepared.surface());
    let part = |(at, a, b): &Path| {
        let side = below.height(at(0.5 * (a + b)).0).signum();
        0.5 * side * (value(at(*b).0) - value(at(*a).0))
    };
    border(&walks, below).iter().map(part).sum()
}

/// Adds what is below the water of a flat face that its plane crosses.
pub fn wet_of_flat(face: &Face, water: &Water, below: Below, scale: &Scale, rules: &WetRules, to: &mut Wet) {
    let whole = &face.cells[0].sums;
    let normal = DVec3::new(whole[1], whole[2], whole[3]).normalize_or_zero();
    let level = water.up.cross(normal);
    let rise = level.length();
    if rise <= FLOAT_LEVEL {
        return;
    }
    // a runs along the water, b up the face; (a, b, normal) is right-handed.
    let along = level / rise;
    let upwards = normal.cross(along);
    let walks = boundary(face.prepared.surface());
    let paths = border(&walks, below);
    // ∬ g da db over b < 0 is −∮ G da round the face with G the integral of g along b from the water.
    let density = |p: DVec3, by: DVec3, all: bool| -> [f64; WET] {
        let b = below.height(p) / rise;
        if b >= 0.0 && !all {
            return [0.0; WET];
        }
        let weight = -by.dot(along) * b / 6.0;
        let g = |share: f64| wet_densities(water, p - upwards * (b * share), normal);
        let (near, middle, far) = (g(0.0), g(0.5), g(1.0));
        std::array::from_fn(|k| weight * (near[k] + 4.0 * middle[k] + far[k]))
    };
    let by_rule = |path: &Path, (a, b): (f64, f64), rule: &[(f64, f64)], all: bool| {
        let mut sum = [0.0; WET];
        for (t, w) in rule {
            let (p, by) = path.0(0.5 * (a + b) + 0.5 * (b - a) * t);
            let value = density(p, by, all);
            (0..WET).for_each(|k| sum[k] += 0.5 * (b - a) * w * value[k]);
        }
        sum
    };
    // Whichever way the border is walked, the area is positive.
    let area: f64 = paths.iter().map(|path| by_rule(path, (path.1, path.2), &rules.rules()[0], true)[0]).sum();
    let sign = if area < 0.0 { -1.0 } else { 1.0 };
    let allowed = scale.allowed();
    for path in &paths {
        let mut open = vec![((path.1, path.2), 0)];
        while let Some(((a, b), depth)) = open.pop() {
            job::poll();
            let (rough, fine) = (by_rule(path, (a, b), &rules.rules()[0], false), by_rule(path, (a, b), &rules.rules()[1], false));
            let apart: [f64; WET] = std::array::from_fn(|k| (fine[k] - rough[k]).abs());
            if depth == MAX_DEPTH || apart.iter().zip(allowed).all(|(x, most)| *x <= most) {
                to.add(&fine.map(|x| sign * x), &apart);
            } else {
                let middle = 0.5 * (a + b);
                open.extend([((middle, b), depth + 1), ((a, middle), depth + 1)]);
            }
        }
    }
}
