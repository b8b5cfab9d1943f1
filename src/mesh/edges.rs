//! The least number of steps along a stretch that keeps chord error and angle, and the nodes of these steps.

use std::f64::consts::PI;

use glam::{DVec3, DVec4};

use super::counts::for_size;
use super::layout::Layout;
use crate::base::fault::Result;
use crate::base::math::{self, angle_between};
use crate::base::tolerance::{Tolerance, WHOLE_NUMBER};
use crate::geometry::Curve;
use crate::geometry::nurbs::projected;
use crate::model::Track;

/// Halvings of a step's control polygon; each brings the bound four times closer to the truth.
const HALVINGS: u32 = 4;
/// Points inside a step where no control polygon is known.
const PROBES: u32 = 8;
/// Refinements before the last count is taken; each at least adds a step and follows the square law.
const ROUNDS: usize = 200;

/// Limits along a line, model units and radians.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits {
    /// Largest distance of a step's chord from the curve.
    pub chord: Option<f64>,
    /// Largest turn of the tangent across a step.
    pub angle: Option<f64>,
}

/// How far the worst step of a division is from its limits: 1 is just kept, the square law applies to `chord`.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    chord: f64,
    angle: f64,
}

/// The least number of steps for the limits, up to `cap`: so many are not looked at any more.
///
/// `divided` gives the fractions 0…1 of so many steps.
pub fn least_steps(layout: &Layout, stretch: usize, divided: &dyn Fn(u32) -> Vec<f64>, limits: &Limits, cap: u32) -> Result<u32> {
    if limits.chord.is_none() && limits.angle.is_none() {
        return Ok(1);
    }
    let mut n = 1_u32;
    for _ in 0..ROUNDS {
        if n >= cap {
            break;
        }
        let load = worst(layout, stretch, divided(n), limits)?;
        let keeps = 1.0 + WHOLE_NUMBER;
        if load.chord <= keeps && load.angle <= keeps {
            break;
        }
        // Deviation falls with the square of the step, turns with the step; from below, so that the least count is met.
        let factor = load.chord.sqrt().max(load.angle);
        let guess = f64::from(n) * factor * if n < 4 { 0.9 } else { 1.0 };
        n = (guess.min(f64::from(cap)) as u32).max(n + 1);
    }
    Ok(n.min(cap))
}

fn worst(layout: &Layout, stretch: usize, fractions: Vec<f64>, limits: &Limits) -> Result<Load> {
    let atom = &layout.pieces.atoms[stretch];
    let track = &layout.parts[atom.track].track;
    let at: Vec<f64> = fractions.into_iter().map(|f| atom.s.0 + (atom.s.1 - atom.s.0) * f).collect();
    // What is kept for sure, or no worse than what was seen, need not be known closer.
    let enough = |limit: Option<f64>, seen: f64| limit.map_or(f64::INFINITY, |limit| limit * seen.max(1.0));
    let (mut load, mut reached) = (Load::default(), track.point(at[0]));
    for w in at.windows(2) {
        let (chord, angle) = match track {
            Track::Links { .. } => {
                let start = std::mem::replace(&mut reached, track.point(w[1]));
                let enough = (enough(limits.chord, load.chord), enough(limits.angle, load.angle));
                hull_of(track, (w[0], w[1]), (start, reached), enough)?
            }
            Track::Iso(_) => probed(track, w[0], w[1]),
        };
        load.chord = load.chord.max(limits.chord.map_or(0.0, |limit| chord / limit));
        load.angle = load.angle.max(limits.angle.map_or(0.0, |limit| angle / limit));
    }
    Ok(load)
}

/// Bounds over a step on links: distance from the chord by the convex hull, turn by the cone of the control legs [Floater 1992].
/// Bounds up to `enough` may be rough.
fn hull_of(track: &Track, (s0, s1): (f64, f64), ends: (DVec3, DVec3), enough: (f64, f64)) -> Result<(f64, f64)> {
    let Track::Links { chains, starts, span } = track else {
        return Ok((0.0, 0.0));
    };
    let (a, b) = (span.0 + s0, span.0 + s1);
    let k = starts.partition_point(|x| *x <= 0.5 * (a + b)).clamp(1, chains.len()) - 1;
    let (chain, against) = &chains[k];
    let length = starts[k + 1] - starts[k];
    let (mut from, mut to) = (a - starts[k], b - starts[k]);
    if *against {
        (from, to) = (length - to, length - from);
    }
    // The cone stands about the chord, so two directions in it differ by twice its half angle at most.
    let enough = (enough.0, 0.5 * enough.1);
    let ends = if *against { (ends.1, ends.0) } else { ends };
    let (mut chord, mut angle, mut before) = (0.0_f64, 0.0_f64, 0.0);
    for run in chain.runs() {
        let extent = (run.s1 - run.s0).abs();
        let (low, high) = ((from - before).max(0.0), (to - before).min(extent));
        before += extent;
        if high <= low {
            continue;
        }
        let (c, t) = if run.s0 <= run.s1 { (run.s0 + low, run.s0 + high) } else { (run.s0 - high, run.s0 - low) };
        let ends = if run.s0 > run.s1 { (ends.1, ends.0) } else { ends };
        let bound = hull_on_curve(&run.curve, (c, t), ends, enough)?;
        (chord, angle) = (chord.max(bound.0), angle.max(bound.1));
    }
    Ok((chord, 2.0 * angle))
}

/// Distance and direction bounds of a piece of a curve against a chord, closer only where they are above what is `enough`.
fn hull_on_curve(curve: &Curve, s: (f64, f64), ends: (DVec3, DVec3), enough: (f64, f64)) -> Result<(f64, f64)> {
    let length = curve.length();
    let wrap = |x: f64| if x > length { x - length } else { x };
    let (s0, mut s1) = (wrap(s.0), wrap(s.1));
    if s1 <= s0 {
        s1 = length;
    }
    let (t0, t1) = (curve.param_at_length(s0), curve.param_at_length(s1));
    if t1 <= t0 {
        return Ok((0.0, 0.0));
    }
    let along = ends.1 - ends.0;
    let nurbs = curve.part(t0, t1).to_nurbs(&Tolerance::new(along.length() * CONVERSION, along.length()))?;
    let (mut chord, mut angle) = (0.0_f64, 0.0_f64);
    let mut open: Vec<_> = nurbs.beziers().into_iter().map(|b| (b, HALVINGS)).collect();
    while let Some((piece, left)) = open.pop() {
        let own = hull_of_poles(&piece.poles, ends, along, enough.1.is_finite());
        let rough = own.0 > enough.0.max(chord) || own.1 > enough.1.max(angle);
        if rough && left > 0 && piece.poles.len() > 2 {
            let (a, b) = piece.halves();
            open.push((a, left - 1));
            open.push((b, left - 1));
            continue;
        }
        (chord, angle) = (chord.max(own.0), angle.max(own.1));
    }
    Ok((chord, angle))
}

/// Distance of a control polygon from a chord, and the largest turn of its legs from it where that is asked for.
fn hull_of_poles(poles: &[DVec4], ends: (DVec3, DVec3), along: DVec3, turns: bool) -> (f64, f64) {
    let (mut chord, mut angle, mut last) = (0.0_f64, 0.0_f64, None);
    for p in poles.iter().map(|q| projected(*q)) {
        chord = chord.max(distance_to_segment(p, ends.0, ends.1));
        let leg = last.replace(p).map_or(DVec3::ZERO, |last| p - last);
        if turns && leg.length_squared() > 0.0 {
            // A step round a whole loop has no chord and turns all the way.
            angle = angle.max(if along == DVec3::ZERO { PI } else { angle_between(leg, along) });
        }
    }
    (chord, angle)
}

/// Share of a step within which curves without an exact NURBS form are converted for their bound.
const CONVERSION: f64 = 1.0 / 16_384.0;

/// Distance and turn at points inside a step.
fn probed(track: &Track, s0: f64, s1: f64) -> (f64, f64) {
    let (a, b) = (track.jet(s0), track.jet(s1));
    let (mut chord, mut angle) = (0.0_f64, angle_or_zero(a.1, b.1));
    for k in 1..PROBES {
        let (p, tangent) = track.jet(s0 + (s1 - s0) * f64::from(k) / f64::from(PROBES));
        chord = chord.max(distance_to_segment(p, a.0, b.0));
        angle = angle.max(angle_or_zero(a.1, tangent)).max(angle_or_zero(tangent, b.1));
    }
    (chord, angle)
}

fn angle_or_zero(a: DVec3, b: DVec3) -> f64 {
    if a == DVec3::ZERO || b == DVec3::ZERO { 0.0 } else { math::angle_between(a, b) }
}

/// Distance of a point from a straight segment.
pub fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let square = along.length_squared();
    let t = if square > 0.0 { ((p - a).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + along * t)
}

/// The wanted number of steps for a size.
pub fn wanted_steps(length: f64, size: f64, bias: f64, cap: u32) -> u32 {
    for_size(length, size, bias).min(f64::from(cap)) as u32
}
