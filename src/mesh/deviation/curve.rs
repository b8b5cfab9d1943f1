//! The least number of steps along a segment that keeps chord error and angle, and the nodes of these steps.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::math::{self, widest_angle};
use crate::base::tolerance::Tolerance;
use crate::base::work;
use crate::geometry::Curve;
use crate::geometry::shapes::nurbs::projected;
use crate::geometry::shapes::nurbs_edit::Bezier;
use crate::mesh::border::counts::for_size;
use crate::mesh::border::layout::Layout;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::sources::distance_to_segment;
use crate::model::Track;

/// What steers the search for the least number of steps.
struct StepSettings {
    /// Counts up to which all are tried.
    max_tried_from_one: u32,
    /// Counts up to which those from the half on are tried; of larger ones the least is found to within what one step more changes.
    max_tried_from_half: u32,
    /// Counts above a broken one grow by one part in so many, and one.
    counts_a_try: u32,
    /// A count grows by no more than this factor at a time: steps longer than bends seem to need more than they do.
    max_growth: f64,
    /// Halvings of a step's control polygon; each brings the bound four times closer to the truth.
    halvings: u32,
    /// Points inside a step where no control polygon is known.
    probes: u32,
    /// Share of a step within which curves without an exact NURBS form are converted for their bound.
    conversion: f64,
    /// Work of bounding one step, in evaluations of a curve.
    work: u64,
}

const SETTINGS: StepSettings = StepSettings {
    max_tried_from_one: 32,
    max_tried_from_half: 4096,
    counts_a_try: 256,
    max_growth: 2.0,
    halvings: 4,
    probes: 8,
    conversion: 1.0 / 16_384.0,
    work: 8,
};

/// How far the worst step of a division is from its limits: 1 is just kept, the square law applies to `chord`.
#[derive(Clone, Copy, Debug)]
struct StepRatio {
    chord: f64,
    angle: f64,
}

/// The least number of steps for the limits, up to `cap`: more are not tried.
///
/// `divided` gives the fractions 0…1 of so many steps. Counts below half of one that does are not the least in any but odd cases;
/// from there on each is tried, so that a looser limit never gives more.
pub fn least_steps(layout: &Layout, segment: usize, divided: &dyn Fn(u32) -> Vec<f64>, limits: &Limits, cap: u32) -> Result<u32> {
    if limits.chord.is_none() && limits.angle.is_none() {
        return Ok(1);
    }
    let line = LimitedSegment { layout, segment, limits };
    let mut worst = Vec::new();
    let (mut low, mut n) = (0_u32, 1_u32);
    loop {
        if n >= cap {
            return Ok(cap);
        }
        let Some(step) = line.worst(&divided(n), &worst)? else { break };
        worst.push(step.at);
        // Deviation falls with the square of the step, turns with the step, once steps are shorter than bends.
        // Where a bend is sharper than any step they fall more slowly: many steps are doubled, and the least is sought between.
        let more = if n > SETTINGS.max_tried_from_half { SETTINGS.max_growth } else { step.ratio.steps().min(SETTINGS.max_growth) };
        let guess = f64::from(n) * more;
        (low, n) = (n, (guess.min(f64::from(cap)) as u32).max(n + 1));
    }
    if n > SETTINGS.max_tried_from_half {
        return line.between(divided, (low, n), &mut worst);
    }
    for count in if n <= SETTINGS.max_tried_from_one { 1 } else { n / 2 }..n {
        match line.broken(&divided(count), &worst)? {
            Some(at) if worst.contains(&at) => {}
            Some(at) => worst.push(at),
            None => return Ok(count),
        }
    }
    Ok(n)
}

/// The next count above one that breaks the limits that keeps them; `None` where they are kept. Limits that fewer steps keep may be broken by
/// more, whose ends fall elsewhere on the bends of the segment.
pub fn more_steps(
    layout: &Layout,
    segment: usize,
    divided: &dyn Fn(u32) -> Vec<f64>,
    limits: &Limits,
    (count, cap): (u32, u32),
) -> Result<Option<u32>> {
    let line = LimitedSegment { layout, segment, limits };
    let (mut worst, mut n) = (Vec::new(), count);
    while n < cap {
        let Some(at) = line.broken(&divided(n), &worst)? else { break };
        worst.push(at);
        n = (n + 1 + n / SETTINGS.counts_a_try).min(cap);
    }
    Ok((n > count).then_some(n))
}

/// Whether one of `count` steps along a segment keeps the limits, given the fractions of its ends.
pub fn step_keeps(layout: &Layout, segment: usize, ends: (f64, f64), count: u32, limits: &Limits) -> Result<bool> {
    Ok(LimitedSegment { layout, segment, limits }.step_ratio(ends, count as usize)?.is_none())
}

impl StepRatio {
    /// Steps in place of one that would keep the limits.
    fn steps(&self) -> f64 {
        self.chord.sqrt().max(self.angle)
    }
}

/// A step that breaks a limit.
struct Broken {
    /// Fraction of its middle.
    at: f64,
    ratio: StepRatio,
}

/// A segment under limits.
struct LimitedSegment<'a> {
    layout: &'a Layout,
    segment: usize,
    limits: &'a Limits,
}

impl LimitedSegment<'_> {
    /// The least count above `low`, which does not do, up to `high`, which does, as if all between did from one on: the least
    /// that does where others were broken, checked whole.
    fn between(&self, divided: &dyn Fn(u32) -> Vec<f64>, (mut low, high): (u32, u32), worst: &mut Vec<f64>) -> Result<u32> {
        loop {
            let mut least = high;
            while least - low > 1 {
                let middle = low + (least - low) / 2;
                if self.broken_at(&divided(middle), worst)?.is_some() { low = middle } else { least = middle }
            }
            if least == high {
                return Ok(high);
            }
            match self.worst(&divided(least), worst)? {
                Some(step) => {
                    worst.push(step.at);
                    low = least;
                }
                None => return Ok(least),
            }
        }
    }

    /// The first of some places whose step breaks a limit, tried from the last on.
    fn broken_at(&self, fractions: &[f64], places: &[f64]) -> Result<Option<f64>> {
        for place in places.iter().rev() {
            if self.ratio(fractions, Self::at(fractions, *place))?.is_some() {
                return Ok(Some(*place));
            }
        }
        Ok(None)
    }

    /// The place of a step that breaks a limit, searched first where others did.
    fn broken(&self, fractions: &[f64], worst: &[f64]) -> Result<Option<f64>> {
        if let Some(place) = self.broken_at(fractions, worst)? {
            return Ok(Some(place));
        }
        for k in 0..fractions.len() - 1 {
            if self.ratio(fractions, k)?.is_some() {
                return Ok(Some(0.5 * (fractions[k] + fractions[k + 1])));
            }
        }
        Ok(None)
    }

    /// The step that breaks a limit most, or one that needs twice as many.
    fn worst(&self, fractions: &[f64], worst: &[f64]) -> Result<Option<Broken>> {
        let mut found: Option<Broken> = None;
        let first = worst.iter().rev().map(|place| Self::at(fractions, *place));
        for k in first.chain(0..fractions.len() - 1) {
            let Some(ratio) = self.ratio(fractions, k)? else { continue };
            if found.as_ref().is_none_or(|f| f.ratio.steps() < ratio.steps()) {
                let enough = ratio.steps() >= SETTINGS.max_growth;
                found = Some(Broken { at: 0.5 * (fractions[k] + fractions[k + 1]), ratio });
                if enough {
                    break;
                }
            }
        }
        Ok(found)
    }

    /// The step over a place.
    fn at(fractions: &[f64], place: f64) -> usize {
        fractions.partition_point(|f| *f <= place).clamp(1, fractions.len() - 1) - 1
    }

    /// How far a step is over its limits; `None` where it keeps them.
    fn ratio(&self, fractions: &[f64], k: usize) -> Result<Option<StepRatio>> {
        self.step_ratio((fractions[k], fractions[k + 1]), fractions.len() - 1)
    }

    /// The same of a step between two fractions, one of `steps`.
    fn step_ratio(&self, ends: (f64, f64), steps: usize) -> Result<Option<StepRatio>> {
        work::spend(SETTINGS.work);
        let (limits, segment) = (self.limits, &self.layout.pieces.segments[self.segment]);
        let track = &self.layout.parts[segment.track].track;
        let length = segment.s.1 - segment.s.0;
        let (a, b) = (segment.s.0 + length * ends.0, segment.s.0 + length * ends.1);
        let steps = steps as f64;
        // A bound that keeps the limit need not be closer.
        let most = StepAllowance {
            chord: limits.chord.map_or(f64::INFINITY, |limit| limit * (1.0 + limits.chord_room(length))),
            angle: limits.angle.map_or(f64::INFINITY, |limit| limit * (1.0 + limits.turn_room(length, limit * steps))),
            near: limits.near,
        };
        let (chord, angle) = match track {
            Track::Links { .. } => hull_of(track, (a, b), (track.point(a), track.point(b)), &most)?,
            Track::Iso(_) => probed(track, a, b),
        };
        let over = |x: f64, limit: Option<f64>| limit.map_or(0.0, |limit| x / limit);
        let ratio = StepRatio { chord: over(chord, limits.chord), angle: over(angle, limits.angle) };
        Ok((chord > most.chord || angle > most.angle).then_some(ratio))
    }
}

/// What is allowed of a step: bounds up to there need not be closer to the truth.
struct StepAllowance {
    /// Distance from the chord, model units.
    chord: f64,
    /// Turn of the tangent, radians.
    angle: f64,
    /// A piece of another curve that is no longer, as rounding leaves at a kink, has no direction; model units.
    near: f64,
}

/// Bounds over a step on links: distance from the chord by the convex hull, turn by the directions of the control legs [Floater 1992].
fn hull_of(track: &Track, (s0, s1): (f64, f64), ends: (DVec3, DVec3), allowed: &StepAllowance) -> Result<(f64, f64)> {
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
    let (mut chord, mut before) = (0.0_f64, 0.0);
    let mut turning = Vec::new();
    for run in chain.runs() {
        let extent = (run.s1 - run.s0).abs();
        let (low, high) = ((from - before).max(0.0), (to - before).min(extent));
        before += extent;
        if high <= low {
            continue;
        }
        let forward = run.s0 <= run.s1;
        let part = if forward { (run.s0 + low, run.s0 + high) } else { (run.s0 - high, run.s0 - low) };
        let pieces = pieces_of(&run.curve, part, ends.0.distance(ends.1))?;
        if allowed.angle.is_finite() && high - low > allowed.near {
            turning.extend(pieces.iter().map(|piece| (piece.clone(), if forward { 1.0 } else { -1.0 })));
        }
        if allowed.chord.is_finite() {
            chord = chord_of(pieces, ends, allowed.chord, chord);
        }
    }
    Ok((chord, turn_of(turning, allowed.angle)))
}

/// Bézier pieces of a part of a curve by arc length, converted for a step with a chord of this length.
fn pieces_of(curve: &Curve, s: (f64, f64), across: f64) -> Result<Vec<Bezier>> {
    let length = curve.length();
    let wrap = |x: f64| if x > length { x - length } else { x };
    let (s0, mut s1) = (wrap(s.0), wrap(s.1));
    if s1 <= s0 {
        s1 = length;
    }
    let (t0, t1) = (curve.param_at_length(s0), curve.param_at_length(s1));
    if t1 <= t0 {
        return Ok(Vec::new());
    }
    Ok(curve.part(t0, t1).to_nurbs(&Tolerance::new(across * SETTINGS.conversion, across))?.beziers())
}

/// Distance bound of pieces of a curve from a chord, closer only where it is above what is `enough` or was seen.
fn chord_of(pieces: Vec<Bezier>, ends: (DVec3, DVec3), enough: f64, seen: f64) -> f64 {
    let mut chord = seen;
    let mut open: Vec<_> = pieces.into_iter().map(|piece| (piece, SETTINGS.halvings)).collect();
    while let Some((piece, left)) = open.pop() {
        let own = piece.poles.iter().map(|q| distance_to_segment(projected(*q), ends.0, ends.1)).fold(0.0, f64::max);
        if own > enough.max(chord) && left > 0 && piece.poles.len() > 2 {
            let (a, b) = piece.halves();
            open.extend([(a, left - 1), (b, left - 1)]);
        } else {
            chord = chord.max(own);
        }
    }
    chord
}

/// How far tangents of pieces, each run one way or the other, are apart: tangents lie between control legs, and the first and last
/// legs are tangents. Pieces are halved until a bound is `enough` or tangents are sure to be farther apart.
fn turn_of(mut pieces: Vec<(Bezier, f64)>, enough: f64) -> f64 {
    for left in (0..=SETTINGS.halvings).rev() {
        let (mut legs, mut tangents) = (Vec::new(), Vec::new());
        for (piece, sign) in &pieces {
            let points: Vec<DVec3> = piece.poles.iter().map(|q| projected(*q)).collect();
            let own: Vec<DVec3> = points.windows(2).filter_map(|w| (w[1] - w[0]).try_normalize()).map(|leg| *sign * leg).collect();
            tangents.extend(own.first().into_iter().chain(own.last()).copied());
            legs.extend(own);
        }
        let (sure, bound) = (widest_angle(&tangents), widest_angle(&legs));
        // Tangents that are more than a right angle apart may have more between them.
        if sure > enough || left == 0 || bound <= enough && bound <= FRAC_PI_2 {
            return sure.max(bound);
        }
        pieces = pieces.into_iter().flat_map(|(piece, sign)| halved(&piece).map(move |half| (half, sign))).collect();
    }
    0.0
}

/// Both halves of a piece; one of a straight piece is as good as the whole.
fn halved(piece: &Bezier) -> impl Iterator<Item = Bezier> + use<> {
    let (a, b) = if piece.poles.len() > 2 { piece.halves() } else { (piece.clone(), piece.clone()) };
    [a, b].into_iter()
}

/// Distance and turn at points inside a step.
fn probed(track: &Track, s0: f64, s1: f64) -> (f64, f64) {
    let (a, b) = (track.jet(s0), track.jet(s1));
    let (mut chord, mut angle) = (0.0_f64, angle_or_zero(a.1, b.1));
    for k in 1..SETTINGS.probes {
        let (p, tangent) = track.jet(s0 + (s1 - s0) * f64::from(k) / f64::from(SETTINGS.probes));
        chord = chord.max(distance_to_segment(p, a.0, b.0));
        angle = angle.max(angle_or_zero(a.1, tangent)).max(angle_or_zero(tangent, b.1));
    }
    (chord, angle)
}

fn angle_or_zero(a: DVec3, b: DVec3) -> f64 {
    if a == DVec3::ZERO || b == DVec3::ZERO { 0.0 } else { math::angle_between(a, b) }
}

/// The wanted number of steps for a size, of a length that may be longer by `near`.
pub fn wanted_steps(length: f64, near: f64, size: f64, bias: f64, cap: u32) -> u32 {
    for_size((length - near).max(0.0), size, bias).min(f64::from(cap)) as u32
}
