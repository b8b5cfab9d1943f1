//! Positions at which weight and buoyancy balance: Newton on depth, trim and heel with the stiffness of the water plane.
//!
//! With the centre of gravity G and the centre of buoyancy B in ξ, η, ζ: V is the wanted volume, V (ξ_B − ξ_G) = 0 and, where the heel is
//! free, V (η_B − η_G) = 0. By a change of the depth the water rises over its plane by as much, by one of the trim by −ξ, by one of
//! the heel by −η cos trim; integrals of these over the water plane, and the turn of ξ and η, are the derivatives.

use glam::DVec3;

use super::body::Body;
use super::fault::FloatFault;
use super::particulars::{Position, center_of_buoyancy};
use crate::base::fault::Result;
use crate::base::solve::{bracketed_from, dense};
use crate::base::tolerance::{FLOAT_AT_REST, FLOAT_FIRST_DEPTH, FLOAT_NEARLY_AT_REST};
use crate::base::{job, math};

/// Rounds of Newton.
const ROUNDS: usize = 60;
/// Largest turn of a round, radians.
const TURN: f64 = 0.15;
/// Largest change of the depth of a round, as a share of the body's height.
const RISE: f64 = 0.25;
/// From here on the depth is found first, and trim and heel after it.
const NEAR: f64 = 0.01;
/// Rounds without a better position that end the search far from rest.
const IDLE: usize = 6;

/// A weight in the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Volume of water as heavy, cubic model units.
    pub volume: f64,
    /// Centre of gravity, in the model's coordinates.
    pub center: DVec3,
}

/// The position of equilibrium at a given heel, or with a free one a stable position near upright.
///
/// Fails with E306 where the body sinks, E413 where no equilibrium is found.
pub fn equilibrium(body: &Body, load: &Load, heel: Option<f64>, guess: Position) -> Result<Position> {
    /// First heels tried one after the other where the heel is free, radians.
    const HEELS: [f64; 5] = [0.0, 0.2, -0.2, 0.8, -0.8];
    let whole = body.whole_volume();
    if load.volume >= whole {
        return Err(FloatFault::Sinks { body: body.origin, wanted: load.volume, whole }.into());
    }
    if let Some(heel) = heel {
        return settled(body, load, false, Position { heel, ..guess });
    }
    let mut first = None;
    for heel in HEELS {
        let found = settled(body, load, true, Position { heel, ..guess });
        match found {
            Ok(position) if is_stable(body, load, &position) => return Ok(position),
            other => first = first.or(Some(other)),
        }
    }
    first.unwrap_or(Ok(guess))
}

/// Positions of equilibrium at heels one after the other: each search begins where the ones before lead to.
#[derive(Clone, Debug)]
pub struct HeelSeries {
    first: Position,
    /// The last three, the newest last.
    found: Vec<Position>,
}

impl HeelSeries {
    /// One that begins at a position.
    pub fn new(first: Position) -> Self {
        Self { first, found: Vec::new() }
    }

    /// The position of equilibrium at the next heel, radians.
    ///
    /// Fails as [`equilibrium`].
    pub fn at(&mut self, body: &Body, load: &Load, heel: f64) -> Result<Position> {
        let near = self.expected(heel).and_then(|guess| equilibrium(body, load, Some(heel), guess).ok());
        let last = self.found.last().copied().unwrap_or(self.first);
        let position = near.map_or_else(|| equilibrium(body, load, Some(heel), last), Ok)?;
        self.found.push(position);
        if self.found.len() > 3 {
            self.found.remove(0);
        }
        Ok(position)
    }

    /// By the parabola through the last three positions; `None` where the heel is farther from them than they are from each other.
    fn expected(&self, heel: f64) -> Option<Position> {
        let [a, b, c] = &self.found[..] else { return None };
        let (reach, steps) = ((heel - c.heel).abs(), [(b.heel - a.heel).abs(), (c.heel - b.heel).abs(), (c.heel - a.heel).abs()]);
        if steps.contains(&0.0) || reach > steps[2] {
            return None;
        }
        let weight = |own: &Position, others: [&Position; 2]| {
            others.iter().map(|other| (heel - other.heel) / (own.heel - other.heel)).product::<f64>()
        };
        let weights = [weight(a, [b, c]), weight(b, [a, c]), weight(c, [a, b])];
        let of = |value: fn(&Position) -> f64| weights[0] * value(a) + weights[1] * value(b) + weights[2] * value(c);
        Some(Position { depth: of(|p| p.depth), trim: of(|p| p.trim), heel, ..*c })
    }
}

/// Whether a small heel turns the body back.
fn is_stable(body: &Body, load: &Load, at: &Position) -> bool {
    let water = at.water();
    let wet = body.wet_anyhow(&water);
    let (_, my) = wet.plane_moment();
    let across = wet.plane_inertia()[2] - my * my / wet.plane_area();
    let height = water.local(load.center).z - water.local(center_of_buoyancy(&wet, &water)).z;
    across > height * wet.volume()
}

/// Newton from a first trim and heel.
fn settled(body: &Body, load: &Load, free: bool, guess: Position) -> Result<Position> {
    let size = body.bounds.max - body.bounds.min;
    let mut at = guess;
    let mut best: Option<(f64, Position)> = None;
    let mut idle = 0;
    for round in 0..ROUNDS {
        job::poll();
        let (mut off, mut step) = newton(body, load, free, &at, size.length());
        if round == 0 && off > NEAR {
            at.depth = depth_of(body, load, guess);
            (off, step) = newton(body, load, free, &at, size.length());
        }
        if best.is_none_or(|b| off < b.0) {
            (best, idle) = (Some((off, at)), 0);
        } else {
            idle += 1;
        }
        // What is left of a small rest is that of the sums.
        let rounding = best.is_some_and(|b| b.0 <= FLOAT_NEARLY_AT_REST) && idle > 0;
        if off <= FLOAT_AT_REST || rounding || idle > IDLE {
            break;
        }
        let turn = step.y.abs().max(step.z.abs());
        let shrink = (TURN / turn.max(TURN)).min(RISE * size.z / step.x.abs().max(RISE * size.z));
        at = Position { depth: at.depth + shrink * step.x, trim: at.trim + shrink * step.y, heel: at.heel + shrink * step.z, ..at };
    }
    let off = best.map_or(1.0, |b| b.0);
    match best {
        Some((off, position)) if off <= FLOAT_NEARLY_AT_REST => Ok(position),
        _ => Err(FloatFault::NoEquilibrium { body: body.origin, heel: at.heel, rounds: ROUNDS, off }.into()),
    }
}

/// The depth at which the volume is the wanted one, trim and heel as they are: roughly, by Newton from the depth of `at`.
fn depth_of(body: &Body, load: &Load, at: Position) -> f64 {
    let water = Position { depth: 0.0, ..at }.water();
    let mirrored = if body.mirrored { water.mirrored() } else { water };
    let heights = body.bounds.corners().into_iter().flat_map(|p| [water.height(p), mirrored.height(p)]);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
    let guess = if low < at.depth && at.depth < high { at.depth } else { 0.5 * (low + high) };
    bracketed_from((low, high), true, guess, FLOAT_FIRST_DEPTH * (high - low), |depth| {
        // What is open counts up to the plane here; the position found is examined.
        let wet = body.wet_anyhow(&Position { depth, ..at }.water());
        (wet.volume() - load.volume, wet.plane_area())
    })
}

/// How far a position is from equilibrium, and the step of Newton: depth, trim, heel.
fn newton(body: &Body, load: &Load, free: bool, at: &Position, length: f64) -> (f64, DVec3) {
    let water = at.water();
    let wet = body.wet_anyhow(&water);
    let (volume, area) = (wet.volume(), wet.plane_area());
    let (b, g) = (water.local(center_of_buoyancy(&wet, &water)), water.local(load.center));
    let residual = [volume - load.volume, volume * (b.x - g.x), volume * (b.y - g.y)];
    let off = (residual[0] / load.volume).abs().max((residual[1] / (load.volume * length)).abs()).max(if free {
        (residual[2] / (load.volume * length)).abs()
    } else {
        0.0
    });
    let (mx, my) = wet.plane_moment();
    let [xx, xy, yy] = wet.plane_inertia();
    let (sin, cos) = math::sin_cos(at.trim);
    let arm = (b - g) * volume;
    let mut matrix = [
        [area, -mx, -my * cos],
        [mx - g.x * area, -(xx - g.x * mx) - arm.z, -(xy - g.x * my) * cos - arm.y * sin],
        [my - g.y * area, -(xy - g.y * mx), -(yy - g.y * my) * cos + arm.x * sin - arm.z * cos],
    ];
    let mut right = residual.map(|r| -r);
    if !free {
        (matrix[2], right[2]) = ([0.0, 0.0, 1.0], 0.0);
    }
    if !dense(matrix.as_flattened_mut(), &mut right) {
        right = [-residual[0] / area.max(f64::MIN_POSITIVE), 0.0, 0.0];
    }
    (off, DVec3::from(right))
}
