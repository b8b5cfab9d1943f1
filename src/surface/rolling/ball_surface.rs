//! The surface through the arcs of a rolling ball.

use glam::{DVec3, DVec4};

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::base::{job, math};
use crate::geometry::construct::build::{arc_center, arc_through};
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::data::fault::CurveFault;
use crate::network::Chain;
use crate::surface::analysis::iso_line::IsoLine;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rolling::along::turn;
use crate::surface::rolling::ball::{Ball, Guess};
use crate::surface::rolling::breaks::{with_breaks, with_middles, with_sides};
use crate::surface::rolling::station::BallStation;
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::swept::extrude::extrude;
use crate::surface::swept::revolve::{Axis, revolve};

/// Share of the tolerance within which a net keeps to the ball.
const SHARE: f64 = 0.25;
/// Share of it within which a roll is straight or round.
const EXACT: f64 = 1.0 / 64.0;
/// An arc above this angle is made of two halves.
const WIDE: f64 = 2.0 * std::f64::consts::FRAC_PI_3;
/// Stations at the most.
const MOST: usize = 4096;

/// The surface and the curves in which it touches both sides.
pub(crate) struct Roll {
    pub surface: Surface,
    pub contacts: [Chain; 2],
}

/// The surface through the balls at some stations, and at more of them where it needs more.
pub(crate) fn rolled(ball: &Ball, radius: f64, stations: Vec<BallStation>, origin: Origin) -> Result<Roll> {
    let stations = turned(ball, stations);
    let (tolerance, at) = (&ball.tolerance, stations[0].center);
    let pieces = with_breaks(ball, radius, &stations);
    let all = with_middles(ball, radius, &pieces);
    let surface = match straight(&all, origin, tolerance)? {
        Some(surface) => surface,
        None => match round(&stations, &all, ball.closed, origin, tolerance)? {
            Some(surface) => surface,
            None => {
                let sides = with_sides(ball, radius, &pieces);
                let halves = halved(&all);
                net(&refined(ball, radius, sides, halves, origin)?, radius, halves).surface(SurfaceKind::Blend, origin, tolerance)
            }
        },
    };
    let surface = Surface::new(Parts { kind: SurfaceKind::Blend, ..surface.parts().clone() });
    let contact = |v: f64| -> Result<Chain> {
        let lost = || CurveFault::NotConverged { of: origin, what: "the border of the rounding".to_owned(), at };
        Ok(Chain::of_curve(&surface.iso(IsoLine::V(v), origin, tolerance)?.ok_or_else(lost)?))
    };
    let contacts = [contact(0.0)?, contact(1.0)?];
    Ok(Roll { surface, contacts })
}

/// The stations in the order in which the surface's normal is on the side of the first one's.
fn turned(ball: &Ball, mut stations: Vec<BallStation>) -> Vec<BallStation> {
    let s = &stations[stations.len() / 2];
    let normal = (s.center - s.feet[0]) * ball.faces[0].side;
    if s.way.cross(-ball.away(s, 0)).dot(normal) < 0.0 {
        turn(&mut stations);
    }
    stations
}

/// The arc of a station, from the first surface to the second.
fn arc(station: &BallStation, origin: Origin) -> Result<Chain> {
    let (a, b) = (station.feet[0] - station.center, station.feet[1] - station.center);
    let curve = arc_center(station.center, station.feet[0], math::angle_between(a, b), a.cross(b), origin)?;
    Ok(Chain::of_curve(&curve))
}

/// The extrusion of one arc, where all others are the same one moved along a line.
fn straight(stations: &[BallStation], origin: Origin, tolerance: &Tolerance) -> Result<Option<Surface>> {
    let (first, last) = (&stations[0], &stations[stations.len() - 1]);
    let by = last.center - first.center;
    let Some(way) = math::unit(by, tolerance.point) else { return Ok(None) };
    let near = |p: DVec3, q: DVec3| p.distance(q) <= EXACT * tolerance.point;
    let same = |s: &BallStation| {
        let moved = s.center - first.center;
        near(way * moved.dot(way), moved) && (0..2).all(|k| near(s.feet[k], first.feet[k] + moved))
    };
    if !stations.iter().all(same) {
        return Ok(None);
    }
    extrude(&arc(first, origin)?, by, origin, tolerance).map(Some)
}

/// The revolution of one arc, where all others are the same one turned about an axis: `stations`, by which it is found, and `all`.
fn round(stations: &[BallStation], all: &[BallStation], closed: bool, origin: Origin, tolerance: &Tolerance) -> Result<Option<Surface>> {
    let n = stations.len() - 1;
    let (a, b, c) = (stations[0].center, stations[n / 3].center, stations[2 * n / 3].center);
    let Ok(circle) = arc_through(a, c, b, origin) else { return Ok(None) };
    let CurveShape::Arc(circle) = circle.shape() else { return Ok(None) };
    let Some(direction) = math::unit(circle.u.cross(circle.v), 0.0) else { return Ok(None) };
    let axis = Axis { about: circle.center, direction };
    // Height over the axis and distance from it: the same at every station.
    let profile = |p: DVec3| {
        let d = p - axis.about;
        (d.dot(direction), d.reject_from_normalized(direction).length())
    };
    let near = |p: DVec3, q: DVec3| {
        let (x, y) = (profile(p), profile(q));
        (x.0 - y.0).abs().max((x.1 - y.1).abs()) <= EXACT * tolerance.point
    };
    let same = |s: &BallStation| near(s.center, a) && (0..2).all(|k| near(s.feet[k], stations[0].feet[k]));
    // The arc stands in a plane through the axis.
    let upright = stations[0].way.dot(direction).abs() * stations[0].center.distance(axis.about) <= EXACT * tolerance.point;
    if !upright || !all.iter().all(same) {
        return Ok(None);
    }
    let out = |s: &BallStation| (s.center - axis.about).reject_from_normalized(direction);
    let step = |w: &[BallStation]| {
        let angle = math::angle_between(out(&w[0]), out(&w[1]));
        angle.copysign(out(&w[0]).cross(out(&w[1])).dot(direction))
    };
    let whole: f64 = stations.windows(2).map(step).sum();
    let angle = if closed { std::f64::consts::TAU.copysign(whole) } else { whole };
    revolve(&arc(&stations[0], origin)?, &axis, angle, origin, tolerance).map(Some)
}

/// More stations where the net through those that are there leaves the ball.
fn refined(ball: &Ball, radius: f64, stations: Vec<BallStation>, halves: bool, origin: Origin) -> Result<Vec<BallStation>> {
    let lost = |at: DVec3| CurveFault::NotConverged { of: origin, what: "the way of the ball".to_owned(), at };
    let mut done = vec![stations[0]];
    let mut open: Vec<BallStation> = stations[1..].iter().rev().copied().collect();
    while let Some(next) = open.pop() {
        job::poll();
        let last = done[done.len() - 1];
        if next.center == last.center {
            done.push(next);
            continue;
        }
        match off(ball, radius, halves, &last, &next).ok_or_else(|| lost(last.center))? {
            None => done.push(next),
            Some(_) if done.len() + open.len() > MOST || length_between(&last, &next) <= ball.tolerance.point => {
                return Err(lost(next.center).into());
            }
            Some(middle) => open.extend([next, middle]),
        }
    }
    Ok(done)
}

/// A ball between two stations, about in the middle, where the net between them is off at some place; outer none where none is found.
fn off(ball: &Ball, radius: f64, halves: bool, a: &BallStation, b: &BallStation) -> Option<Option<BallStation>> {
    const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
    let piece = net(&[*a, *b], radius, halves);
    let allowed = SHARE * ball.tolerance.point;
    let side = (OneSided::After, OneSided::After);
    let mut middle = None;
    let mut near = true;
    for u in PLACES {
        let jets = PLACES.map(|v| piece.jet(u, v, side));
        let ends = [piece.jet(u, 0.0, side), piece.jet(u, 1.0, side)];
        let plane = (between(a, b, u), (ends[0].du + ends[1].du).normalize_or_zero());
        let uv = [0, 1].map(|k: usize| a.uv[k].lerp(ball.faces[k].turned_to(b.uv[k], a.uv[k]), u));
        let Some(found) = ball.station(radius, plane, &Guess { uv, points: ends.map(|e| e.p) }) else {
            return nearer(ball, radius, a, b).map(Some);
        };
        let on_ball = |jet: &Jet2| (jet.p.distance(found.center) - radius).abs() <= allowed;
        near &= jets.iter().all(on_ball) && (0..2).all(|k| ends[k].p.distance(found.feet[k]) <= allowed);
        if u == 0.5 {
            middle = Some(found);
        }
    }
    Some(if near { None } else { middle })
}

/// A ball between two stations, from the first one on in steps that become smaller until one is found.
fn nearer(ball: &Ball, radius: f64, a: &BallStation, b: &BallStation) -> Option<BallStation> {
    const SMALLER: i32 = 8;
    let whole = length_of((a.center, a.way), (b.center, b.way));
    (1..=SMALLER).find_map(|k| ball.ahead(radius, a, whole * math::powi(0.5, k)))
}

/// The centre between two stations, cubic.
fn between(a: &BallStation, b: &BallStation, u: f64) -> DVec3 {
    let h = length_between(a, b) / 3.0;
    let (p, q) = (a.center + a.way * (h / a.speed()), b.center - b.way * (h / b.speed()));
    let w = 1.0 - u;
    a.center * (w * w * w) + p * (3.0 * w * w * u) + q * (3.0 * w * u * u) + b.center * (u * u * u)
}

/// Mean length that the centre and both points go from one station to the next.
fn length_between(a: &BallStation, b: &BallStation) -> f64 {
    let feet = |k: usize| length_of((a.feet[k], a.rates[k]), (b.feet[k], b.rates[k]));
    (length_of((a.center, a.way), (b.center, b.way)) + feet(0) + feet(1)) / 3.0
}

/// About the length of a way from one point to another: of the circle that touches both directions.
fn length_of(a: (DVec3, DVec3), b: (DVec3, DVec3)) -> f64 {
    let chord = a.0.distance(b.0);
    let half = 0.5 * math::angle_between(a.1, b.1);
    if half > 0.0 { chord * half / math::sin(half) } else { chord }
}

/// A homogeneous pole and its derivative by the length of the centre's way.
type MovingPole = (DVec4, DVec4);

/// The poles of a station's arc: three, or five where it is made of two halves; derivatives by the mean length of the ways.
fn poles(s: &BallStation, radius: f64, halves: bool) -> Vec<MovingPole> {
    let foot = |k: usize| (s.feet[k], s.rates[k]);
    let all = if halves {
        let middle = s.feet[0] + s.feet[1] - s.center * 2.0;
        let (length, rate) = (middle.length(), s.rates[0] + s.rates[1] - s.way * 2.0);
        let half = (s.center + middle * (radius / length), s.way + rate.reject_from(middle) * (radius / length));
        [arc_poles(s, [foot(0), half], radius).as_slice(), &arc_poles(s, [half, foot(1)], radius)[1..]].concat()
    } else {
        arc_poles(s, [foot(0), foot(1)], radius).to_vec()
    };
    all.into_iter().map(|(p, d)| (p, d / s.speed())).collect()
}

/// The three poles of the arc about a station's centre between two points with their rates.
fn arc_poles(s: &BallStation, ends: [(DVec3, DVec3); 2], radius: f64) -> [MovingPole; 3] {
    let middle = ends[0].0 + ends[1].0 - s.center * 2.0;
    let rate = ends[0].1 + ends[1].1 - s.way * 2.0;
    let length = middle.length();
    let weight = length / (2.0 * radius);
    let length_rate = middle.dot(rate) / length;
    let weight_rate = length_rate / (2.0 * radius);
    let apex = s.center * weight + middle * (radius / length);
    let apex_rate = s.center * weight_rate + s.way * weight + (rate - middle * (length_rate / length)) * (radius / length);
    let end = |k: usize| (ends[k].0.extend(1.0), ends[k].1.extend(0.0));
    [end(0), (apex.extend(weight), apex_rate.extend(weight_rate)), end(1)]
}

/// Whether arcs are made of two halves: the middle pole of one that is nearly half a circle is far away, and its weight is small.
fn halved(stations: &[BallStation]) -> bool {
    let angle = |s: &BallStation| math::angle_between(s.feet[0] - s.center, s.feet[1] - s.center);
    stations.iter().any(|s| angle(s) > WIDE)
}

/// The net through some stations: arcs along v, cubics along u. Their derivatives are continuous, but where a station is there twice
/// each side has its own.
fn net(stations: &[BallStation], radius: f64, halves: bool) -> NurbsSurface {
    let steps: Vec<f64> = stations.windows(2).map(|w| length_between(&w[0], &w[1])).collect();
    let total: f64 = steps.iter().sum();
    let rows: Vec<_> = stations.iter().map(|s| poles(s, radius, halves)).collect();
    let (n, across, twice) = (stations.len(), rows[0].len(), |i: usize| stations[i].center == stations[i + 1].center);
    let mut all = Vec::with_capacity(2 * across * n);
    for k in 0..across {
        for (i, row) in rows.iter().enumerate() {
            let (p, d) = row[k];
            if i == 0 {
                all.push(p);
            } else if !twice(i - 1) {
                all.push(p - d * (steps[i - 1] / 3.0));
            }
            if i + 1 == n || twice(i) {
                all.push(p);
            } else {
                all.push(p + d * (steps[i] / 3.0));
            }
        }
    }
    let mut knots = vec![0.0; 4];
    let mut way = 0.0;
    for (i, step) in steps.iter().enumerate().take(n - 2) {
        way += step;
        // Of a station that is there twice, two knots come with the first and one with the second.
        knots.extend(std::iter::repeat_n(way / total, if twice(i) { 1 } else { 2 }));
    }
    knots.extend([1.0; 4]);
    let inner: &[f64] = if halves { &[0.5, 0.5] } else { &[] };
    let knots = (knots, [&[0.0; 3], inner, &[1.0; 3]].concat());
    NurbsSurface { degree: (3, 2), counts: (all.len() / across, across), knots, poles: all }
}
