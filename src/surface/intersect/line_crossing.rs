//! Where lines of constant u or v of a face cross themselves. That is quickly found, and what crosses all along a face, as a profile does
//! that crosses itself, is found by any of them.

use std::f64::consts::PI;

use glam::DVec3;

use crate::base::math;
use crate::base::tolerance::Tolerance;
use crate::geometry::{Hit, self_intersect};
use crate::surface::analysis::iso_line::IsoLine;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;
use crate::surface::intersect::self_intersection::{Crossing, crossing};

/// Where lines are looked at: on a border, and inside where no symmetry is.
const PLACES: [f64; 2] = [0.0, 0.382];
/// Samples of a line between two kinks.
const SAMPLES: usize = 12;
/// A loop with one corner turns by more than half a turn, a closed line of two loops by more than a whole one [Fenchel 1929].
const TURNS: (f64, f64) = (0.9 * PI, 2.02 * PI);
/// Steps towards a place on a line.
const STEPS: usize = 16;

/// A place in which faces cross themselves or each other, by their parts and by their lines of constant u and v; the first one found.
pub fn any_crossing(faces: &[Surface], tolerance: &Tolerance) -> Option<Crossing> {
    crossing(faces, tolerance).or_else(|| faces.iter().find_map(|face| crossing_line(face, tolerance)))
}

/// A place in which a line of constant u or v of a face without trims crosses itself; the first one found.
fn crossing_line(surface: &Surface, tolerance: &Tolerance) -> Option<Crossing> {
    if surface.domain() != Domain::Square {
        return None;
    }
    let lines = PLACES.into_iter().flat_map(|x| [IsoLine::U(x), IsoLine::V(x)]);
    lines.filter(|line| bends_back(surface, *line)).find_map(|line| along(surface, line, tolerance))
}

/// Whether a line turns so much that it can cross itself.
fn bends_back(surface: &Surface, line: IsoLine) -> bool {
    let (us, vs) = surface.cells();
    let (cells, closed) = if matches!(line, IsoLine::U(_)) { (vs, surface.closed().1) } else { (us, surface.closed().0) };
    let stops = [vec![0.0], cells, vec![1.0]].concat();
    let inner = |w: &[f64]| (0..SAMPLES).map(|k| w[0] + (w[1] - w[0]) * (k as f64 + 0.5) / SAMPLES as f64).collect::<Vec<_>>();
    let running: Vec<(f64, OneSided)> = stops.windows(2).flat_map(inner).map(|x| (x, OneSided::After)).collect();
    let at = [(line.value(), OneSided::After)];
    let jets: Vec<Jet2> = if matches!(line, IsoLine::U(_)) { surface.jets(&at, &running) } else { surface.jets(&running, &at) };
    let mut ways: Vec<DVec3> = jets.iter().map(|jet| if matches!(line, IsoLine::U(_)) { jet.dv } else { jet.du }).collect();
    if closed {
        ways.extend(ways.first().copied());
    }
    let turned: f64 = ways.windows(2).map(|w| math::angle_between(w[0], w[1])).sum();
    turned > if closed { TURNS.1 } else { TURNS.0 }
}

fn along(surface: &Surface, line: IsoLine, tolerance: &Tolerance) -> Option<Crossing> {
    let curve = surface.iso(line, surface.origin(), tolerance).ok()??;
    let hits = self_intersect(&curve, tolerance).ok()?;
    let (from, to) = curve.domain();
    let place = |t: f64, p: DVec3| {
        let guesses = [(t - from) / (to - from), curve.length_at(t) / curve.length()];
        guesses.into_iter().map(|guess| foot(surface, line, guess, p)).min_by(|a, b| a.1.total_cmp(&b.1))
    };
    hits.iter().find_map(|hit| {
        let Hit::Point { ta, tb, at, tangent: false, .. } = hit else { return None };
        let ((a, off), (b, other)) = (place(*ta, *at)?, place(*tb, *at)?);
        let found = off.max(other) <= 2.0 * tolerance.point && (a - b).abs() > tolerance.parameter;
        found.then(|| Crossing { at: *at, faces: (0, 0), uv: (line.at(a), line.at(b)) })
    })
}

/// The parameter on a line of the point nearest to a place, near a guess, and how far it is off.
fn foot(surface: &Surface, line: IsoLine, guess: f64, p: DVec3) -> (f64, f64) {
    let jet = |t: f64| {
        let (u, v) = line.at(t);
        let jet = surface.jet(u, v);
        (jet.p, if matches!(line, IsoLine::U(_)) { jet.dv } else { jet.du })
    };
    let mut t = guess;
    for _ in 0..STEPS {
        let (at, way) = jet(t);
        let step = (p - at).dot(way) / way.length_squared();
        if step.is_finite() {
            t = (t + step).clamp(0.0, 1.0);
        }
    }
    (t, jet(t).0.distance(p))
}
