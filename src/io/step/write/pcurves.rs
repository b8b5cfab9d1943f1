//! Curves of edges in the parameters of the elementary surfaces on which they lie.
//!
//! Readers can project an edge onto its surface, but do so within tolerances of their own, by which the area beside an oblique cut is
//! off by up to 1e-4. Where one parameter is constant they project exactly: such edges are left to them.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::base::math;
use crate::base::tolerance::{NUDGE, POLE_STEP, Tolerance};
use crate::geometry::Nurbs;
use crate::io::cad::curve_on_surface::fitted;
use crate::io::step::write::curves::{Along, spline_of};
use crate::io::step::write::records::{Id, SectionRecords};
use crate::io::step::write::things::StepScale;
use crate::surface::analysis::elementary::{Elementary, Form};

/// Pieces of a smooth stretch of an edge to begin with, each of which gets a spline of its own.
const PLACES: usize = 4;
/// Largest turn along a piece, as a share of a whole one.
const LEAP: f64 = 0.2;
/// Halvings of a piece: what then still turns more leaps through a pole.
const MAX_DEPTH: u32 = 16;
/// Control points of a curve in (u, v): readers integrate over its pieces, and some end at thousands of them.
const MOST: usize = 1_000;
/// Share of the tolerance within which a curve in (u, v) follows its edge.
const FINE: f64 = 0.1;

/// Puts an edge in the parameters of a surface; `None` on a plane, along a constant parameter and where no curve stays near.
pub fn put(records: &mut SectionRecords, surface: Id, found: &Elementary, edge: &Along, scale: &StepScale) -> Option<Id> {
    let frame = ParameterFrame::of(found)?;
    let curve = frame.within(edge, scale)?;
    let point = |records: &mut SectionRecords, p: DVec3| {
        records.put("CARTESIAN_POINT", |v| {
            v.text("").reals([p.x, p.y / frame.unit(scale)]);
        })
    };
    let points: Vec<Id> = (0..curve.poles.len()).map(|k| point(records, curve.pole(k))).collect();
    let geometry = spline_of(records, &curve, &points, "");
    let context = records.put_complex(|v| {
        v.part("GEOMETRIC_REPRESENTATION_CONTEXT", |v| {
            v.int(2);
        });
        v.part("PARAMETRIC_REPRESENTATION_CONTEXT", |_| {});
        v.part("REPRESENTATION_CONTEXT", |v| {
            v.text("").text("");
        });
    });
    let representation = records.put("DEFINITIONAL_REPRESENTATION", |v| {
        v.text("").ids(&[geometry]).id(context);
    });
    Some(records.put("PCURVE", |v| {
        v.text("").id(surface).id(representation);
    }))
}

/// A surface round an axis with its parameters: u is the angle from x, v the length along the axis, or an angle.
struct ParameterFrame<'e> {
    form: &'e Form,
    at: DVec3,
    x: DVec3,
    y: DVec3,
    z: DVec3,
}

impl<'e> ParameterFrame<'e> {
    fn of(found: &'e Elementary) -> Option<Self> {
        let axis = match &found.form {
            Form::Plane { .. } => return None,
            Form::Cylinder { axis, .. } | Form::Cone { axis, .. } | Form::Sphere { axis, .. } | Form::Torus { axis, .. } => axis,
        };
        let (x, z) = (found.reference, axis.direction);
        Some(Self { form: &found.form, at: axis.about, x, y: z.cross(x), z })
    }

    /// Model units in one of v.
    fn unit(&self, scale: &StepScale) -> f64 {
        if matches!(self.form, Form::Cylinder { .. } | Form::Cone { .. }) { scale.model } else { 1.0 }
    }

    /// The parameters of a point, angles within half a turn.
    fn uv(&self, p: DVec3) -> DVec2 {
        let d = p - self.at;
        let (a, b, h) = (d.dot(self.x), d.dot(self.y), d.dot(self.z));
        let out = DVec2::new(a, b).length();
        let v = match self.form {
            Form::Sphere { .. } => math::atan2(h, out),
            Form::Torus { major, .. } => math::atan2(h, out - major),
            _ => h,
        };
        DVec2::new(math::atan2(b, a), v)
    }

    /// The point at parameters.
    fn point(&self, uv: DVec3) -> DVec3 {
        let (sin, cos) = (math::sin(uv.x), math::cos(uv.x));
        let (out, h) = match self.form {
            Form::Plane { .. } => (0.0, 0.0),
            Form::Cylinder { radius, .. } => (*radius, uv.y),
            Form::Cone { radius, angle, .. } => (radius + uv.y * math::tan(*angle), uv.y),
            Form::Sphere { radius, .. } => (radius * math::cos(uv.y), radius * math::sin(uv.y)),
            Form::Torus { major, minor, .. } => (major + minor * math::cos(uv.y), minor * math::sin(uv.y)),
        };
        self.at + (self.x * cos + self.y * sin) * out + self.z * h
    }

    /// Whether a point is so near the axis that its angle says nothing.
    fn is_pole(&self, p: DVec3, tolerance: &Tolerance) -> bool {
        (p - self.at).reject_from_normalized(self.z).length() <= tolerance.point
    }

    /// The curve (u, v, 0) of an edge by the edge's own parameter.
    fn within(&self, edge: &Along, scale: &StepScale) -> Option<Nurbs> {
        let known = self.stations(edge, scale)?;
        let inner = known.iter().filter(|s| !self.is_pole(s.2, &scale.tolerance));
        if edge.is_conic() && (is_constant(inner.clone().map(|s| s.1.x)) || is_constant(inner.map(|s| s.1.y))) {
            return None;
        }
        let (first, last) = (known[0].0, known[known.len() - 1].0);
        let beside = |t: f64| {
            let k = known.partition_point(|s| s.0 < t).clamp(1, known.len() - 1);
            known[if self.is_pole(known[k].2, &scale.tolerance) { k - 1 } else { k }].1
        };
        let at = |t: f64| {
            let p = edge.point(t, scale);
            if !self.is_pole(p, &scale.tolerance) {
                return self.near(self.uv(p), beside(t));
            }
            // At a pole the angle is the one that the way leads to.
            let step = if t - first < last - t { POLE_STEP } else { -POLE_STEP } * (last - first);
            let before = |k: f64| self.near(self.uv(edge.point(t + k * step, scale)), beside(t + k * step));
            DVec2::new((before(1.0) * 3.0 - before(2.0) * 3.0 + before(3.0)).x, self.uv(p).y)
        };
        let fine = Tolerance { point: FINE * scale.tolerance.point, ..scale.tolerance };
        let knots: Vec<f64> = known.iter().map(|s| s.0).collect();
        let curve = fitted(&knots, &fine, &|t| Ok(at(t).extend(0.0)), &|uv| self.point(uv)).ok()?;
        let is_near = |t: f64| self.point(curve.jet(t).p).distance(edge.point(t, scale)) <= 2.0 * scale.tolerance.point;
        let is_whole = knots.windows(2).all(|w| is_near(w[0]) && is_near(0.5 * (w[0] + w[1])));
        (is_whole && curve.poles.len() <= MOST).then_some(curve)
    }

    /// Parameters of an edge with their (u, v), which go on over the seam, and points: so near to each other that the edge turns little
    /// between them. `None` where it leaps, through a pole.
    fn stations(&self, edge: &Along, scale: &StepScale) -> Option<Vec<(f64, DVec2, DVec3)>> {
        let of = |t: f64| {
            let p = edge.point(t, scale);
            (t, self.uv(p), p)
        };
        let knots = edge.knots(scale);
        let mut found = vec![of(knots[0])];
        let mut open: Vec<(f64, u32)> = Vec::new();
        for w in knots.windows(2).rev() {
            open.extend((1..=PLACES).rev().map(|k| (w[0] + (w[1] - w[0]) * k as f64 / PLACES as f64, MAX_DEPTH)));
        }
        while let Some((t, deeper)) = open.pop() {
            let (last, mut next) = (found[found.len() - 1], of(t));
            next.1 = self.near(next.1, last.1);
            let turn = (next.1 - last.1).abs() / TAU;
            let to_pole = [last.2, next.2].iter().any(|p| self.is_pole(*p, &scale.tolerance));
            if to_pole || turn.x <= LEAP && (turn.y <= LEAP || !self.turns_v()) {
                found.push(next);
            } else if deeper > 0 {
                open.extend([(t, deeper - 1), (0.5 * (last.0 + t), deeper - 1)]);
            } else {
                return None;
            }
        }
        let inner = &found[1..found.len() - 1];
        (!inner.is_empty() && inner.iter().all(|s| !self.is_pole(s.2, &scale.tolerance))).then_some(found)
    }

    /// Whether v is an angle that runs all round.
    fn turns_v(&self) -> bool {
        matches!(self.form, Form::Torus { .. })
    }

    /// Parameters with whole turns added that are nearest to others.
    fn near(&self, p: DVec2, guess: DVec2) -> DVec2 {
        let turn = |x: f64, guess: f64| x + TAU * ((guess - x) / TAU).round();
        DVec2::new(turn(p.x, guess.x), if self.turns_v() { turn(p.y, guess.y) } else { p.y })
    }
}

/// Whether values are equal but for rounding.
fn is_constant(values: impl Iterator<Item = f64> + Clone) -> bool {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    high - low <= NUDGE * NUDGE.max(high.abs())
}
