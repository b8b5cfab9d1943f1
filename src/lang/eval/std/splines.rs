//! Splines, Bézier curves and NURBS, helices, and offset curves.

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::base::limits::HELIX_TURNS;
use crate::base::tolerance::Tolerance;
use crate::builtins;
use crate::geometry::construct::spline::{Spacing, spaced};
use crate::geometry::construct::{build, polynomial};
use crate::geometry::{Ends, Spline};
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::{CurveOrSurface, places, unit, whole, with_notes};
use crate::lang::eval::std::kinds::PointsOrSurface;
use crate::lang::eval::std::surfaces::reported;
use crate::lang::values::conversions::{Direction, FromValue, Length, Point};
use crate::lang::values::types::Ty;
use crate::lang::values::units::number_text;
use crate::lang::values::value::Value;
use crate::network::Chain;
use crate::surface::offset;

crate::choices! {
    /// How the parameters of data follow from them.
    pub enum SpacingWord {
        /// As far apart as the points.
        Chord = "chord",
        /// The root of that.
        Centripetal = "centripetal",
        /// All alike.
        Uniform = "uniform",
    }
}

impl SpacingWord {
    pub(crate) fn spacing(self) -> Spacing {
        match self {
            Self::Chord => Spacing::Chord,
            Self::Centripetal => Spacing::Centripetal,
            Self::Uniform => Spacing::Uniform,
        }
    }
}

/// How a spline leaves its end.
#[derive(Clone, Copy, Debug)]
pub enum SplineEnd {
    /// `natural` or `bessel`.
    Word(Ends),
    /// A direction.
    Along(DVec3),
}

impl FromValue for SplineEnd {
    const TY: Ty = Ty::OneOf(&[Ty::Choice(&["natural", "bessel"]), Ty::Direction]);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Word(word) if &*word == "bessel" => Some(Self::Word(Ends::Bessel)),
            Value::Word(_) => Some(Self::Word(Ends::Natural)),
            Value::Vector(along, _) => Some(Self::Along(along)),
            _ => None,
        }
    }
}

impl SplineEnd {
    /// E306 for a direction without a length.
    pub(crate) fn ends(self, argument: &'static str) -> Result<Ends, Halt> {
        match self {
            Self::Word(ends) => Ok(ends),
            Self::Along(along) => unit(along, argument).map(Ends::Clamped),
        }
    }
}

builtins! {
    /// Smooth cubic spline through points.
    ///
    /// Twice continuously differentiable. Its ends are `natural`, without a bend, or `bessel`, as the parabola through three points
    /// leaves them, or run in a direction. Parameters are chord lengths, their roots (`parameter: centripetal`, for points of
    /// uneven distances) or whole numbers (`uniform`, where curves of as many points are to have the same knots).
    /// ```loft
    /// curve edge = spline([(0, 0), (1m, 0.2m), (2m, 0)], start: (1, 0, 0))
    /// ```
    fn spline(
        /// Points in order.
        points: Vec<Point>,
        /// Direction at the first point, `natural` or `bessel`; natural when left out.
        start: Option<SplineEnd>,
        /// The same at the last point.
        end: Option<SplineEnd>,
        /// Whether it returns smoothly to the first point.
        closed: bool = "false",
        /// Spacing of the parameters.
        parameter: SpacingWord = "chord",
    ) -> Chain = |cx, list, start, end, closed, parameter| {
        if let (true, Some(argument)) = (closed, start.map(|_| "start").or(end.map(|_| "end"))) {
            let (what, arguments) = ("end tangents or `closed: true`, not both", vec![argument, "closed"]);
            let example = "spline([A, B, C], start: (1, 0, 0)), or spline([A, B, C], closed: true)";
            return Err(ValueFault::Exclusive { function: "spline", what, arguments, example }.into());
        }
        let end_of = |end: Option<SplineEnd>, argument| end.map_or(Ok(Ends::Natural), |end| end.ends(argument));
        let settings = Spline { start: end_of(start, "start")?, end: end_of(end, "end")?, closed };
        Ok(whole(spaced(&places(list), &settings, parameter.spacing(), cx.origin())?))
    };

    /// Bézier curve of its control points.
    ///
    /// ```loft
    /// curve lip = bezier([(0, 0), (1m, 1m), (2m, 0)])
    /// ```
    fn bezier(
        /// Control points; the degree is one less than their number.
        points: Vec<Point>,
        /// A weight for each point, above 0.
        weights: Option<Vec<f64>>,
    ) -> Chain = |cx, list, weights| Ok(whole(build::bezier(&places(list), weights.as_deref(), cx.origin())?));

    /// Polynomial segment: coordinates are sums of coefficients times powers of t.
    ///
    /// The coefficient in place i belongs to t^i; the segment runs from t = `from` to `to` and is kept as a Bézier curve, exactly
    /// but for rounding. Segments in u and v bound trimmed polynomial patches, `trim(patch, outer: segments, uv: true)`; of
    /// records: `[for s in part.outer: polynomial_curve(x: s.u, y: s.v, from: s.t[0], to: s.t[1])]`.
    /// ```loft
    /// curve half = polynomial_curve(x: [0, 2m], y: [0, 0, 4m], to: 0.5)
    /// let p = half.end // => (1000mm, 1000mm, 0mm)
    /// ```
    fn polynomial_curve(
        /// Coefficients of x, of ascending powers.
        x: Vec<Length>,
        /// Those of y.
        y: Vec<Length>,
        /// Those of z.
        z: Option<Vec<Length>>,
        /// Where it starts, 0 to 1.
        from: f64 = "0",
        /// Where it ends, 0 to 1.
        to: f64 = "1",
    ) -> Chain = |cx, x, y, z, from, to| {
        let z = z.unwrap_or_default();
        let most = x.len().max(y.len()).max(z.len());
        let at = |list: &[Length], i: usize| list.get(i).map_or(0.0, |c| c.0);
        let coefficients: Vec<DVec3> = (0..most).map(|i| DVec3::new(at(&x, i), at(&y, i), at(&z, i))).collect();
        Ok(whole(polynomial::segment(&coefficients, (from, to), cx.origin())?))
    };

    /// B-spline of its control points.
    ///
    /// ```loft
    /// curve wave = bspline([(0, 0), (1m, 1m), (2m, -1m), (3m, 0)])
    /// ```
    fn bspline(
        /// Control points.
        points: Vec<Point>,
        /// Degree.
        degree: usize = "3",
        /// Knots, not decreasing, one more than points and degree together; clamped and uniform when left out.
        knots: Option<Vec<f64>>,
        /// Whether it returns smoothly to its start.
        closed: bool = "false",
    ) -> Chain = |cx, list, degree, knots, closed| {
        Ok(whole(build::bspline(&places(list), degree, knots.as_deref(), closed, cx.origin())?))
    };

    /// Rational B-spline of control points, weights and knots; or a surface as one.
    ///
    /// A surface that is a B-spline stays what it is, and so do extrusions, revolutions and parallel sweeps of such curves. Nets,
    /// skins and other sweeps become splines of degree 3 or 5 that are nowhere farther from the surface than `tolerance:`, with few
    /// control points; N677 says how far at most. `s.net_size` and `s.net_degree` are those of the result. IGES files hold the same.
    /// ```loft
    /// curve quarter = nurbs([(1m, 0), (1m, 1m), (0, 1m)], weights: [1, sqrt(0.5), 1], knots: [0, 0, 0, 1, 1, 1], degree: 2)
    /// surface vase = skin([for i in 0..4: circle(center: (0, 0, i * 1m), radius: 1m + 300mm * sin(i * 60deg))])
    /// surface light = nurbs(vase, tolerance: 0.1mm)
    /// check light.area == vase.area within 0.1%
    /// ```
    fn nurbs(
        /// Control points of a curve, or a surface.
        points: PointsOrSurface,
        /// A weight for each point of a curve, above 0.
        weights: Option<Vec<f64>>,
        /// Knots of a curve, not decreasing, one more than points and degree together.
        knots: Option<Vec<f64>>,
        /// Degree of a curve; 3 when left out.
        degree: Option<usize>,
        /// How far the result may be from a surface; the model's tolerance when left out.
        tolerance: Option<Length>,
    ) -> Value = |cx, of, weights, knots, degree, tolerance| {
        const EXAMPLE: &str = "nurbs([(1m, 0), (1m, 1m), (0, 1m)], weights: [1, 0.7, 1], knots: [0, 0, 0, 1, 1, 1], degree: 2)";
        let origin = cx.origin();
        let exclusive = |argument| {
            let (what, example) = ("weights, knots and a degree with points, a tolerance with a surface", "nurbs(hull, tolerance: 0.01mm)");
            Err(ValueFault::Exclusive { function: "nurbs", what, arguments: vec!["points", argument], example }.into())
        };
        match (of, weights, knots) {
            (PointsOrSurface::Points(_), ..) if tolerance.is_some() => exclusive("tolerance"),
            (PointsOrSurface::Surface(_), Some(_), _) => exclusive("weights"),
            (PointsOrSurface::Surface(_), _, Some(_)) => exclusive("knots"),
            (PointsOrSurface::Surface(_), ..) if degree.is_some() => exclusive("degree"),
            (PointsOrSurface::Points(list), Some(weights), Some(knots)) => {
                Ok(Value::Curve(whole(build::nurbs(&places(list), &weights, &knots, degree.unwrap_or(3), origin)?)))
            }
            (PointsOrSurface::Points(_), weights, _) => {
                let what = if weights.is_none() { "a weight for each point: `weights:`" } else { "its knots: `knots:`" };
                Err(ValueFault::Missing { function: "nurbs", what, example: EXAMPLE }.into())
            }
            (PointsOrSurface::Surface(surface), ..) => {
                let model = cx.tolerance()?;
                let near = Tolerance { point: tolerance.map_or(model.point, |t| t.0), ..model };
                if near.point <= 0.0 {
                    let (found, range) = (near.point.to_string(), "above 0".to_owned());
                    return Err(ValueFault::OutsideRange { argument: "tolerance", found, range }.into());
                }
                let (made, note) = surface.as_net(origin, &near)?;
                Ok(Value::Surface(reported(cx, made, note.as_slice())?))
            }
        }
    };

    /// Helix about an axis.
    ///
    /// ```loft
    /// curve stair = helix(center: (0, 0, 0), start: (1m, 0, 0), pitch: 3m, turns: 1.5)
    /// ```
    fn helix(
        /// A point of the axis.
        center: Point,
        /// Where it starts.
        start: Point,
        /// Rise of one turn.
        pitch: Length,
        /// How many turns, at most 10000; negative runs clockwise.
        turns: f64,
        /// Direction of the axis.
        axis: Direction = "(0, 0, 1)",
    ) -> Chain = |cx, center, start, pitch, turns, axis| {
        let axis = unit(axis.0, "axis")?;
        if turns.abs() > HELIX_TURNS {
            let (found, range) = (number_text(turns), format!("at most {HELIX_TURNS} either way"));
            return Err(ValueFault::OutsideRange { argument: "turns", found, range }.into());
        }
        Ok(whole(build::helix(center.0, axis, start.0, pitch.0, turns, cx.origin())?))
    };

    /// Curve or surface at a distance from another one.
    ///
    /// The curve lies to the left of a plane curve seen against `normal:`, the surface along the normals. Offsets of planes, of extrusions across the plane
    /// of their profile and of revolutions are of the same kind, exactly; other surfaces become bicubic nets that keep the
    /// distance within `tolerance:`, the model's when left out. The loops of a trimmed surface go with it. Where a surface bends
    /// tighter than the distance its offset folds over: W664 states the place and the largest distance. A crease is E670: divide the
    /// surface there.
    /// ```loft
    /// curve inner = line((0, 0), (4m, 0))
    /// curve outer = offset(inner, -300mm)
    /// surface tube = extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 3m))
    /// surface liner = offset(tube, 100mm)
    /// check liner.area == 0.9 * tube.area within 1e-9%
    /// ```
    fn offset(
        /// A curve in a plane, or a surface.
        of: CurveOrSurface,
        /// How far; negative to the right, or against the normal.
        distance: Length,
        /// Normal of the plane of a curve; (0, 0, 1) when left out.
        normal: Option<Direction>,
        /// How near a surface that is not exact is to the distance.
        tolerance: Option<Length>,
    ) -> Value = |cx, of, distance, normal, tolerance| {
        let origin = cx.origin();
        let exclusive = |argument| {
            let (what, example) = ("a normal with a curve, a tolerance with a surface", "offset(rim, 2mm), or offset(hull, 2mm, tolerance: 0.01mm)");
            Err(ValueFault::Exclusive { function: "offset", what, arguments: vec!["of", argument], example }.into())
        };
        match of {
            CurveOrSurface::Curve(_) if tolerance.is_some() => exclusive("tolerance"),
            CurveOrSurface::Surface(_) if normal.is_some() => exclusive("normal"),
            CurveOrSurface::Curve(chain) => {
                let normal = unit(normal.map_or(DVec3::Z, |n| n.0), "normal")?;
                Ok(Value::Curve(whole(build::offset(&chain.to_curve()?, distance.0, normal, origin)?)))
            }
            CurveOrSurface::Surface(surface) => {
                let model = cx.tolerance()?;
                let near = Tolerance { point: tolerance.map_or(model.point, |t| t.0), ..model };
                if near.point <= 0.0 {
                    let (found, range) = (near.point.to_string(), "above 0".to_owned());
                    return Err(ValueFault::OutsideRange { argument: "tolerance", found, range }.into());
                }
                let (made, notes) = offset(&surface, distance.0, origin, &near)?;
                Ok(Value::Surface(if notes.is_empty() { reported(cx, made, &[])? } else { with_notes(cx, made, &notes) }))
            }
        }
    };
}
