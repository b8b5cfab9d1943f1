//! How far the waterline of a body reaches, and the areas of its cross sections.

use glam::DVec3;

use super::body::Body;
use super::face::Way;
use super::traces::{Trace, border_crossings, chord_sum, traces};
use super::water::Water;
use crate::base::quadrature::gauss_legendre;
use crate::base::solve::{lowest, turn};
use crate::base::tolerance::{FLOAT_BESIDE, FLOAT_FARTHEST, FLOAT_LEVEL};

/// Rows of a curve that are looked at for where it reaches farthest.
const ROWS: usize = 9;
/// Curves that are searched for the farthest place, of those that may have it.
const SEARCHED: usize = 4;
/// Orders of the rules of a curve of a cross section.
const ORDER: usize = 12;
/// Parts of a curve at whose ends its side of the water is looked at.
const PARTS: usize = 8;

/// How far a waterline reaches along ξ and η of its water plane, model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Aft and fore end.
    pub along: (f64, f64),
    /// Starboard and port end.
    pub across: (f64, f64),
}

impl Outline {
    fn with(self, q: DVec3) -> Self {
        Self { along: (self.along.0.min(q.x), self.along.1.max(q.x)), across: (self.across.0.min(q.y), self.across.1.max(q.y)) }
    }

    const NOTHING: Self = Self { along: (f64::INFINITY, f64::NEG_INFINITY), across: (f64::INFINITY, f64::NEG_INFINITY) };
}

impl Body {
    /// How far the waterline reaches; `None` where the plane crosses nothing.
    pub fn outline(&self, water: &Water) -> Option<Outline> {
        let mut found = self.own_outline(water);
        if self.mirrored {
            let other = self.own_outline(&water.mirrored());
            found = found.with(DVec3::new(other.along.0, other.across.0, 0.0)).with(DVec3::new(other.along.1, other.across.1, 0.0));
        }
        (found.along.0 < found.along.1).then_some(found)
    }

    fn own_outline(&self, water: &Water) -> Outline {
        let below = FLOAT_BESIDE * self.bounds.diagonal();
        let plane = self.plane(water.up, water.up.dot(water.origin) - below);
        let mut found = Outline::NOTHING;
        self.triangles.segments(&|p| water.height(p) + below, |a, b, _| found = found.with(water.local(a)).with(water.local(b)));
        let mut curves: Vec<Trace> = Vec::new();
        for face in &self.faces {
            if face.way == Way::Flat {
                found = border_crossings(face, plane).into_iter().fold(found, |all, p| all.with(water.local(p)));
            } else {
                curves.extend(traces(face, plane));
            }
        }
        for along in [true, false] {
            for sign in [1.0, -1.0] {
                let value = |p: DVec3| {
                    let q = water.local(p);
                    sign * if along { q.x } else { q.y }
                };
                if let Some(p) = farthest(&curves, &value) {
                    found = found.with(water.local(p));
                }
            }
        }
        found
    }

    /// Area below the water of the cross section at x, square model units; of a mirrored body of both sides.
    pub fn section_area(&self, x: f64, water: &Water) -> f64 {
        let middle = 0.5 * (self.bounds.min.x + self.bounds.max.x);
        let x = x + FLOAT_BESIDE * self.bounds.diagonal() * if x > middle { -1.0 } else { 1.0 };
        let own = self.own_section(x, water);
        let both = match (self.mirrored, water.up.y == 0.0) {
            (false, _) => own,
            (true, true) => 2.0 * own,
            (true, false) => own + self.own_section(x, &water.mirrored()),
        };
        if self.turned_inwards() { -both } else { both }
    }

    fn own_section(&self, x: f64, water: &Water) -> f64 {
        let Some(up) = (water.up - DVec3::X * water.up.x).try_normalize() else { return 0.0 };
        let rise = up.dot(water.up);
        let plane = self.plane(DVec3::X, x);
        let depth = |p: DVec3| water.height(p) / rise;
        // With b the height over the water in the section, its area is ∮ b n_b ds where b < 0.
        let straight = |a: DVec3, b: DVec3, n: DVec3| {
            let (ha, hb) = (depth(a), depth(b));
            let outwards = (n - DVec3::X * n.x).normalize_or_zero();
            let wet = if ha * hb < 0.0 { ha.min(hb) / (ha.min(hb) - ha.max(hb)) } else { f64::from(ha.min(hb) < 0.0) };
            let mean = 0.5 * (ha.min(0.0) + hb.min(0.0));
            // A side that leaves the water is a triangle as deep as its lower end.
            let mean = if ha * hb < 0.0 { 0.5 * ha.min(hb) } else { mean };
            mean * wet * (b - a).length() * outwards.dot(up)
        };
        let mut sum = 0.0;
        self.triangles.segments(&|p| p.x - x, |a, b, n| sum += straight(a, b, n));
        let rule = gauss_legendre(ORDER);
        for face in &self.faces {
            if face.way != Way::Flat {
                sum += traces(face, plane).iter().map(|trace| curved(trace, up, &depth, &rule)).sum::<f64>();
                continue;
            }
            let whole = &face.cells[0].sums;
            let normal = DVec3::new(whole[1], whole[2], whole[3]);
            let line = normal.cross(DVec3::X).normalize_or_zero();
            let slope = line.dot(water.up) / rise;
            // Antiderivatives along the line in which the planes meet: of 1, and of the height where it is below zero.
            let length = chord_sum(face, plane, &|p| line.dot(p));
            let below = chord_sum(face, plane, &|p| {
                let b = depth(p).min(0.0);
                if slope.abs() > FLOAT_LEVEL { b * b / (2.0 * slope) } else { b * line.dot(p) }
            });
            let outwards = (normal - DVec3::X * normal.x).normalize_or_zero();
            sum += below * length.signum() * outwards.dot(up);
        }
        sum
    }
}

/// The share of a curve of a cross section in its area.
fn curved(trace: &Trace, up: DVec3, depth: &impl Fn(DVec3) -> f64, rule: &[(f64, f64)]) -> f64 {
    let (first, last) = trace.rows;
    let row = |k: usize| first + (last - first) * k as f64 / PARTS as f64;
    let mut stops = vec![first];
    for k in 0..PARTS {
        let (a, b) = (row(k), row(k + 1));
        let (at_a, at_b) = (depth(trace.point(a)), depth(trace.point(b)));
        if at_a * at_b < 0.0 {
            stops.extend(turn(a, b, at_a > 0.0, |t| Some(depth(trace.point(t)) > 0.0)));
        }
        // A place in the plane itself is an end too.
        stops.push(b);
    }
    let mut sum = 0.0;
    for w in stops.windows(2) {
        let half = 0.5 * (w[1] - w[0]);
        if depth(trace.point(w[0] + half)) >= 0.0 {
            continue;
        }
        let mut guess = 0.5 * (trace.strip.reach.0 + trace.strip.reach.1);
        for (t, weight) in rule {
            let place = trace.place(w[0] + half * (1.0 + t), guess);
            guess = if trace.strip.along == 0 { place.0 } else { place.1 };
            let jet = trace.cut.face.tangents(place.0, place.1);
            let n = jet[1].cross(jet[2]) * trace.cut.face.sign;
            let slope = jet[1 + trace.strip.along].x.abs();
            sum += weight * half * depth(jet[0]) * n.dot(up) / slope;
        }
    }
    sum
}

/// The point of some curves at which a value is largest.
fn farthest(curves: &[Trace], value: &impl Fn(DVec3) -> f64) -> Option<DVec3> {
    let mut best: Option<(f64, DVec3)> = None;
    let mut open: Vec<(f64, &Trace, (f64, f64))> = Vec::new();
    for trace in curves {
        let row = |k: usize| trace.rows.0 + (trace.rows.1 - trace.rows.0) * k as f64 / (ROWS - 1) as f64;
        let points: Vec<(f64, DVec3)> = (0..ROWS).map(|k| trace.point(row(k))).map(|p| (value(p), p)).collect();
        let Some((k, most)) = points.iter().enumerate().max_by(|a, b| a.1.0.total_cmp(&b.1.0)) else { continue };
        if best.is_none_or(|b| most.0 > b.0) {
            best = Some(*most);
        }
        // What it may rise by between two rows, from the bend of the values there.
        if k > 0 && k + 1 < ROWS {
            let bend = (2.0 * points[k].0 - points[k - 1].0 - points[k + 1].0).abs();
            open.push((most.0 + bend, trace, (row(k - 1), row(k + 1))));
        } else {
            let inner = if k == 0 { 1 } else { ROWS - 2 };
            let beyond = if k == 0 { 2 } else { ROWS - 3 };
            let bend = (points[k].0 - 2.0 * points[inner].0 + points[beyond].0).abs();
            open.push((most.0 + bend, trace, (row(k.min(inner)), row(k.max(inner)))));
        }
    }
    let limit = best?.0;
    open.retain(|(may, ..)| *may > limit);
    open.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, trace, (low, high)) in open.into_iter().take(SEARCHED) {
        let row = lowest(low, high, FLOAT_FARTHEST, |row| -value(trace.point(row)));
        let p = trace.point(row);
        if best.is_none_or(|b| value(p) > b.0) {
            best = Some((value(p), p));
        }
    }
    best.map(|b| b.1)
}
