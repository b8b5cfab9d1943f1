//! Distances and angles between points, curves and faces, and how far points are from a surface.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::base::math;
use crate::base::par;
use crate::builtins;
use crate::geometry::closest;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::eval::std::kinds::CurveOrFaces;
use crate::lang::eval::std::vectors::{not_zero, together, vector};
use crate::lang::values::conversions::{Angle, Point, Vector};
use crate::lang::values::value::{Dim, Quantity, Value};
use crate::model::apart::{between, from_curve};
use crate::network::Chain;
use crate::network::meet::closest_points;
use crate::surface::core::plane;
use crate::surface::{Domain, Nearest, Surface, SurfaceKind, axis_of};

/// What a distance is taken from.
enum Figure {
    Point(Vector),
    Curve(Chain),
    Faces(Vec<Surface>),
}

/// A value as a figure; edges are the curves they lie on.
fn figure(cx: &mut Cx, value: Value, argument: &'static str) -> Result<Figure, Halt> {
    Ok(match value {
        Value::Vector(..) | Value::Node(_) | Value::Vertex(..) => Figure::Point(vector(cx, value, argument)?),
        Value::Curve(_) | Value::Link(..) => Figure::Curve(cx.as_chain(value)?),
        Value::Edge(home, edge) => {
            let tolerance = cx.tolerance()?;
            let scene = Scene { model: cx.model(&home)?, network: cx.network_of(&home)? };
            let later = || ValueFault::NotInThisVersion { what: "a line across a trimmed surface as a curve".to_owned() };
            Figure::Curve(scene.shared_chain(&edge, &tolerance)?.ok_or_else(later)?)
        }
        Value::Surface(s) => Figure::Faces(vec![s]),
        Value::Shell(s) => Figure::Faces(s.surfaces.clone()),
        Value::Plane(p) => Figure::Faces(vec![plane::unbounded(p.at, p.normal, cx.origin())?]),
        other => {
            let wanted = "a point, a curve or a surface";
            return Err(ValueFault::WrongKind { argument, wanted, found: cx.kind(&other) }.into());
        }
    })
}

/// The least of some distances.
fn least(distances: impl Iterator<Item = f64>) -> Quantity {
    Quantity::new(distances.fold(f64::INFINITY, f64::min), Dim::LENGTH)
}

/// Shortest distance of two things.
fn distance(cx: &mut Cx, a: Value, b: Value) -> Result<Quantity, Halt> {
    let (a, b) = (figure(cx, a, "a")?, figure(cx, b, "b")?);
    // A tuple without a unit is a point beside anything with a place.
    let place = |cx: &Cx, p: Vector| together(cx, p, Vector(DVec3::ZERO, Dim::LENGTH)).map(|(p, _)| p.0);
    Ok(match (a, b) {
        (Figure::Point(a), Figure::Point(b)) => {
            let (a, b) = together(cx, a, b)?;
            Quantity::new(a.0.distance(b.0), a.1)
        }
        (Figure::Point(p), Figure::Curve(c)) | (Figure::Curve(c), Figure::Point(p)) => least([c.closest(place(cx, p)?).2].into_iter()),
        (Figure::Point(p), Figure::Faces(f)) | (Figure::Faces(f), Figure::Point(p)) => {
            let p = place(cx, p)?;
            least([to_faces(cx, &f, p)].into_iter())
        }
        (Figure::Curve(a), Figure::Curve(b)) => {
            let (p, q) = closest_points(&a, &b);
            least([p.distance(q)].into_iter())
        }
        (Figure::Curve(c), Figure::Faces(f)) | (Figure::Faces(f), Figure::Curve(c)) => least(f.iter().map(|s| from_curve(s, &c))),
        (Figure::Faces(a), Figure::Faces(b)) => least(a.iter().flat_map(|a| b.iter().map(|b| between(a, b)))),
    })
}

/// Shortest distance of a point from faces, model units: the nearer boxes first, since what lies behind the nearest point found is not asked.
fn to_faces(cx: &mut Cx, faces: &[Surface], p: DVec3) -> f64 {
    let beyond = |face: &Surface| if face.domain() == Domain::Unbounded { 0.0 } else { face.hull().distance_squared(p).sqrt() };
    let mut order: Vec<(f64, &Surface)> = match faces {
        [one] => vec![(0.0, one)],
        several => several.iter().map(|face| (beyond(face), face)).collect(),
    };
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut nearest = f64::INFINITY;
    for (beyond, face) in order {
        if beyond < nearest {
            nearest = nearest.min(cx.machine.feet.of(face).at(p).distance);
        }
    }
    nearest
}

/// What an angle is taken from: a direction, or a plane by its normal.
enum Way {
    Along(DVec3),
    Across(DVec3),
}

fn way(cx: &mut Cx, value: Value, argument: &'static str) -> Result<Way, Halt> {
    if let Value::Plane(p) = &value {
        return Ok(Way::Across(p.normal));
    }
    match value {
        Value::Vector(..) | Value::Node(_) | Value::Vertex(..) => {
            let v = vector(cx, value, argument)?;
            not_zero(v, argument)?;
            Ok(Way::Along(v.0))
        }
        Value::Surface(s) if s.kind() == SurfaceKind::Plane => Ok(Way::Across(s.normal(0.5, 0.5))),
        Value::Curve(_) | Value::Link(..) | Value::Edge(..) => {
            let tolerance = cx.tolerance()?;
            match figure(cx, value, argument)? {
                Figure::Curve(c) => Ok(Way::Along(axis_of(&c, &tolerance)?.direction)),
                _ => Err(Halt::Bug("a curve is a curve")),
            }
        }
        other => {
            let wanted = "a direction, a straight curve or a plane";
            Err(ValueFault::WrongKind { argument, wanted, found: cx.kind(&other) }.into())
        }
    }
}

builtins! {
    /// Shortest distance of points, nodes, curves, edges, surfaces, shells and planes.
    ///
    /// From a surface it is found from samples, at least four between its knots, and Newton steps; it is never below the
    /// true one.
    /// ```loft
    /// let a = distance((0, 0, 0), (3mm, 4mm, 0)) // => 5mm
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let b = distance((1m, 2m, 1m), wall) // => 2000mm
    /// ```
    fn distance(
        /// A point, curve, surface, shell or plane.
        a: Value,
        /// Another.
        b: Value,
    ) -> Quantity = distance;

    /// The angle between directions, straight curves and planes.
    ///
    /// Between two directions or curves 0 to 180 degrees; with a plane 0 to 90.
    /// ```loft
    /// let a = angle((1, 0, 0), (0, 1, 0)) // => 90deg
    /// curve rafter = line((0, 0, 0), (1m, 0, 1m))
    /// let b = angle(rafter, plane(at: (0, 0, 0), normal: (0, 0, 1))) // => 45deg
    /// ```
    fn angle(
        /// A direction, a straight curve or edge, or a plane.
        a: Value,
        /// Another.
        b: Option<Value>,
    ) -> Angle = |cx, a, b| {
        let Some(b) = b else {
            let (what, example) = ("two directions, or one edge of a surface", "angle(south, north)");
            return Err(ValueFault::Missing { function: "angle", what, example }.into());
        };
        let (a, b) = (way(cx, a, "a")?, way(cx, b, "b")?);
        let right = std::f64::consts::FRAC_PI_2;
        Ok(Angle(match (a, b) {
            (Way::Along(a), Way::Along(b)) => math::angle_between(a, b),
            (Way::Along(a), Way::Across(n)) | (Way::Across(n), Way::Along(a)) => (right - math::angle_between(a, n)).abs(),
            (Way::Across(m), Way::Across(n)) => right - (right - math::angle_between(m, n)).abs(),
        }))
    };

    /// How far points are from a curve, surface or shell.
    ///
    /// A record: `distances` in order of the points, of faces positive on the side of the normal; `max`, `mean` and `rms` of their
    /// absolute values; and `at`, the farthest point.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface slab = extrude(south, by: (0, 2m, 0))
    /// let off = deviation(slab, [(1m, 1m, 3mm), (2m, 1m, -4mm)])
    /// let worst = off.max // => 4mm
    /// ```
    fn deviation(
        /// A curve, a surface or a shell.
        from: CurveOrFaces,
        /// Points.
        points: Vec<Point>,
    ) -> Value = |cx, from, points| {
        if points.is_empty() {
            let (found, range) = ("an empty list".to_owned(), "at least one point".to_owned());
            return Err(ValueFault::OutsideRange { argument: "points", found, range }.into());
        }
        let (surfaces, curve) = match &from {
            CurveOrFaces::Faces(faces) => (faces.surfaces().iter().map(|s| cx.machine.feet.of(s)).collect(), None),
            CurveOrFaces::Curve(chain) => (Vec::<Arc<Nearest>>::new(), Some(chain.to_curve()?)),
        };
        let off = par::map(points.len(), |k| {
            let p = points[k].0;
            if let Some(curve) = &curve {
                return closest(curve, p).distance;
            }
            let feet = surfaces.iter().map(|s| (s.at(p), s.surface()));
            let nearest = feet.reduce(|best, next| if next.0.distance < best.0.distance { next } else { best });
            nearest.map_or(0.0, |(foot, surface)| {
                let side = (p - foot.point).dot(surface.normal(foot.uv.0, foot.uv.1));
                if side < 0.0 { -foot.distance } else { foot.distance }
            })
        });
        let n = off.len() as f64;
        let worst = (0..off.len()).fold(0, |w, k| if off[k].abs() > off[w].abs() { k } else { w });
        let mean = off.iter().map(|d| d.abs()).sum::<f64>() / n;
        let rms = (off.iter().map(|d| d * d).sum::<f64>() / n).sqrt();
        Ok(cx.record([
            ("max", Value::length(off[worst].abs())),
            ("mean", Value::length(mean)),
            ("rms", Value::length(rms)),
            ("at", Value::point(points[worst].0)),
            ("distances", Value::list(off.into_iter().map(Value::length).collect())),
        ]))
    };
}
