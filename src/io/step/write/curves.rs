//! Curves as STEP entities: lines, circles and B-splines.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::math::atan2;
use crate::geometry::curves::curve::Shape;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::{Curve, Nurbs};
use crate::io::step::write::records::{Id, RecordValues, SectionRecords};
use crate::io::step::write::things::StepScale;

/// The geometry of an edge: without ends where it is a line or a circle.
#[derive(Debug)]
pub enum Along {
    /// A line from one end to the other; its parameter is the length, units of the file.
    Line(DVec3, DVec3),
    /// A circle from where its arc begins; its parameter is the angle.
    Circle(EllipticArc),
    /// A spline.
    Spline(Nurbs),
}

impl Along {
    /// Of the curve of an edge.
    pub fn of(curve: &Curve, scale: &StepScale) -> Result<Self> {
        if let Some([a, b]) = corners(curve).as_deref() {
            return Ok(Self::Line(*a, *b));
        }
        match curve.shape() {
            Shape::Arc(arc) if arc.radius.is_some() => Ok(Self::Circle(**arc)),
            _ => {
                let curve = curve.to_nurbs(&scale.tolerance)?;
                let ((a, b), n) = (curve.domain(), curve.knots.len());
                let is_full = curve.knots[0] == a && curve.knots[n - 1] == b;
                let curve = if is_full { curve } else { curve.part(a, b) };
                Ok(Self::Spline(curve.lean(scale.tolerance.rounding)))
            }
        }
    }

    /// Writes it.
    pub fn put(&self, records: &mut SectionRecords, scale: &StepScale) -> Id {
        match self {
            Self::Line(a, b) => {
                let (at, way) = (records.point(*a / scale.model), records.direction((*b - *a).normalize_or_zero()));
                let vector = records.put("VECTOR", |v| {
                    v.text("").id(way).real(1.0);
                });
                records.put("LINE", |v| {
                    v.text("").id(at).id(vector);
                })
            }
            Self::Circle(arc) => circle(records, arc, "", scale),
            Self::Spline(curve) => spline(records, curve, "", scale),
        }
    }

    /// Whether it is a line or a circle.
    pub fn is_conic(&self) -> bool {
        !matches!(self, Self::Spline(_))
    }

    /// Parameters between which its curvature is continuous, ascending; the first and the last are its ends.
    pub fn knots(&self, scale: &StepScale) -> Vec<f64> {
        match self {
            Self::Line(a, b) => vec![0.0, a.distance(*b) / scale.model],
            Self::Circle(arc) => vec![0.0, arc.sweep],
            Self::Spline(curve) => {
                let (times, at) = knots(&curve.knots);
                let kept = at.iter().zip(times).filter(|(_, times)| curve.degree < times + 2);
                kept.map(|(t, _)| *t).collect()
            }
        }
    }

    /// The point at a parameter, model units.
    pub fn point(&self, t: f64, scale: &StepScale) -> DVec3 {
        match self {
            Self::Line(a, b) => *a + (*b - *a).normalize_or_zero() * (t * scale.model),
            Self::Circle(arc) => arc.jet(t).p,
            Self::Spline(curve) => curve.jet(t).p,
        }
    }
}

/// The whole circle of an arc; its angle is 0 where the arc begins.
fn circle(records: &mut SectionRecords, arc: &EllipticArc, name: &str, scale: &StepScale) -> Id {
    let x = arc.u.normalize_or_zero();
    let frame = records.frame(arc.center / scale.model, arc.u.cross(arc.v).normalize_or_zero(), x);
    let radius = arc.u.length() / scale.model;
    records.put("CIRCLE", |v| {
        v.text(name).id(frame).real(radius);
    })
}

/// A conic between two of its angles.
fn trimmed(records: &mut SectionRecords, basis: Id, (from, to): (f64, f64), name: &str) -> Id {
    let end = |v: &mut RecordValues, at: f64| {
        v.list(|v| {
            v.typed("PARAMETER_VALUE", at);
        });
    };
    records.put("TRIMMED_CURVE", |v| {
        end(v.text(name).id(basis), from);
        end(v, to);
        v.flag(true).word(".PARAMETER.");
    })
}

/// An arc of a circle or an ellipse.
pub fn arc_of(records: &mut SectionRecords, arc: &EllipticArc, scale: &StepScale) -> Id {
    if arc.radius.is_some() {
        let basis = circle(records, arc, "", scale);
        return trimmed(records, basis, (0.0, arc.sweep), "");
    }
    // From the first point to the end of the longer axis.
    let first = 0.5 * atan2(2.0 * arc.u.dot(arc.v), arc.u.length_squared() - arc.v.length_squared());
    let axes = arc.part(first, first + arc.sweep);
    let frame = records.frame(arc.center / scale.model, axes.u.cross(axes.v).normalize_or_zero(), axes.u.normalize_or_zero());
    let basis = records.put("ELLIPSE", |v| {
        v.text("").id(frame).real(axes.u.length() / scale.model).real(axes.v.length() / scale.model);
    });
    let from = (-first).rem_euclid(TAU);
    trimmed(records, basis, (from, from + arc.sweep), "")
}

/// A curve with its ends, under a name.
pub fn bounded(records: &mut SectionRecords, curve: &Curve, name: &str, scale: &StepScale) -> Result<Id> {
    if let Some(points) = corners(curve) {
        let points: Vec<Id> = points.into_iter().map(|p| records.point(p / scale.model)).collect();
        return Ok(records.put("POLYLINE", |v| {
            v.text(name).ids(&points);
        }));
    }
    match curve.shape() {
        Shape::Composite(composite) => {
            let mut segments = Vec::with_capacity(composite.pieces.len());
            for (k, piece) in composite.pieces.iter().enumerate() {
                let part = bounded(records, piece, "", scale)?;
                let last = k + 1 == composite.pieces.len() && !curve.is_closed(&scale.tolerance);
                segments.push(records.put("COMPOSITE_CURVE_SEGMENT", |v| {
                    v.word(if last { ".DISCONTINUOUS." } else { ".CONTINUOUS." }).flag(true).id(part);
                }));
            }
            Ok(records.put("COMPOSITE_CURVE", |v| {
                v.text(name).ids(&segments).word(".U.");
            }))
        }
        Shape::Arc(arc) if arc.radius.is_some() && arc.sweep >= TAU => Ok(circle(records, arc, name, scale)),
        Shape::Arc(arc) if arc.radius.is_some() => {
            let basis = circle(records, arc, "", scale);
            Ok(trimmed(records, basis, (0.0, arc.sweep), name))
        }
        _ => Ok(spline(records, &curve.to_nurbs(&scale.tolerance)?.lean(scale.tolerance.rounding), name, scale)),
    }
}

/// The corners of a line or of lines in a row.
fn corners(curve: &Curve) -> Option<Vec<DVec3>> {
    match curve.shape() {
        Shape::Line(a, b) => Some(vec![*a, *b]),
        Shape::Nurbs(c) if c.degree == 1 && c.polynomial => Some((0..c.poles.len()).map(|k| c.pole(k)).collect()),
        Shape::Composite(composite) => {
            let mut points = vec![curve.start()];
            for piece in &composite.pieces {
                points.extend_from_slice(&corners(piece)?[1..]);
            }
            Some(points)
        }
        _ => None,
    }
}

/// Distinct knots and how often each stands.
pub fn knots(all: &[f64]) -> (Vec<usize>, Vec<f64>) {
    all.chunk_by(|a, b| a == b).map(|same| (same.len(), same[0])).unzip()
}

/// A B-spline, rational where its weights differ.
pub fn spline(records: &mut SectionRecords, curve: &Nurbs, name: &str, scale: &StepScale) -> Id {
    let (a, b) = curve.domain();
    let n = curve.knots.len();
    let is_full = curve.knots[0] == a && curve.knots[n - 1] == b;
    let part;
    let curve = if is_full {
        curve
    } else {
        part = curve.part(a, b);
        &part
    };
    let points: Vec<Id> = (0..curve.poles.len()).map(|k| records.point(curve.pole(k) / scale.model)).collect();
    spline_of(records, curve, &points, name)
}

/// A B-spline whose control points are written, in space or in the parameters of a surface.
pub fn spline_of(records: &mut SectionRecords, curve: &Nurbs, points: &[Id], name: &str) -> Id {
    let closed = curve.pole(0) == curve.pole(curve.poles.len() - 1);
    let (times, places) = knots(&curve.knots);
    let shape = |v: &mut RecordValues| {
        v.int(curve.degree).ids(points).word(".UNSPECIFIED.").flag(closed).word(".F.");
    };
    let parameters = |v: &mut RecordValues| {
        v.ints(times.iter().copied()).reals(places.iter().copied()).word(".UNSPECIFIED.");
    };
    if curve.polynomial {
        return records.put("B_SPLINE_CURVE_WITH_KNOTS", |v| {
            shape(v.text(name));
            parameters(v);
        });
    }
    records.put_complex(|v| {
        v.part("BOUNDED_CURVE", |_| {});
        v.part("B_SPLINE_CURVE", shape);
        v.part("B_SPLINE_CURVE_WITH_KNOTS", parameters);
        v.part("CURVE", |_| {});
        v.part("GEOMETRIC_REPRESENTATION_ITEM", |_| {});
        v.part("RATIONAL_B_SPLINE_CURVE", |v| {
            v.reals(curve.poles.iter().map(|q| q.w));
        });
        v.part("REPRESENTATION_ITEM", |v| {
            v.text(name);
        });
    })
}
