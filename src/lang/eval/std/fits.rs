//! Curves and surfaces through or near many points.

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::geometry::construct::fit_curve::{Fit, fit};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::{places, unit, whole};
use crate::lang::eval::std::surfaces::{reported, rows};
use crate::lang::values::conversions::{Angle, Direction, FromValue, Length, Point};
use crate::lang::values::types::Ty;
use crate::lang::values::value::Value;
use crate::surface;

/// A row of points, or rows of them.
#[derive(Clone, Debug)]
pub enum Data {
    /// For a curve.
    Row(Vec<Point>),
    /// For a surface, one row per v.
    Rows(Vec<Vec<Point>>),
}

impl FromValue for Data {
    const TY: Ty = Ty::OneOf(&[Ty::List(&Ty::List(&Ty::Point)), Ty::List(&Ty::Point)]);
    fn from_value(value: Value) -> Option<Self> {
        let nested = matches!(&value, Value::List(items) if matches!(items.first(), Some(Value::List(_))));
        if nested { Vec::from_value(value).map(Self::Rows) } else { Vec::from_value(value).map(Self::Row) }
    }
}

const EXAMPLE: &str = "fit(points, tolerance: 0.1mm), or fit(points, start: (1, 0, 0))";

/// What only curves take, or only those through all points.
#[derive(Clone, Copy)]
struct FitSettings {
    tolerance: Option<Length>,
    start: Option<Direction>,
    end: Option<Direction>,
    closed: bool,
    kinks: Option<Angle>,
}

impl FitSettings {
    /// E305 where two of these were given.
    fn check(self, surface: bool) -> Result<(), Halt> {
        let tangent = self.start.map(|_| "start").or(self.end.map(|_| "end"));
        let near = self.tolerance.map(|_| "tolerance");
        let whole = self.closed.then_some("closed");
        let (what, pair) = match (tangent, near, whole) {
            (Some(tangent), Some(near), _) => ("end tangents or a tolerance, not both", [tangent, near]),
            (Some(tangent), _, Some(closed)) => ("end tangents or `closed: true`, not both", [tangent, closed]),
            _ if surface => match tangent.or(whole).or(self.kinks.map(|_| "kinks")) {
                Some(argument) => ("rows of points, or what only curves take", ["points", argument]),
                None => return Ok(()),
            },
            _ => return Ok(()),
        };
        Err(ValueFault::Exclusive { function: "fit", what, arguments: pair.to_vec(), example: EXAMPLE }.into())
    }

    fn within(self) -> Result<Option<f64>, Halt> {
        match self.tolerance {
            Some(t) if t.0 <= 0.0 => {
                let (found, range) = (t.0.to_string(), "above 0; left out, all points are met".to_owned());
                Err(ValueFault::OutsideRange { argument: "tolerance", found, range }.into())
            }
            given => Ok(given.map(|t| t.0)),
        }
    }
}

fn fitted(cx: &mut Cx, data: Data, said: FitSettings) -> Result<Value, Halt> {
    let within = said.within()?;
    match data {
        Data::Row(points) => {
            said.check(false)?;
            let direction = |d: Option<Direction>, argument| d.map(|d| unit(d.0, argument)).transpose();
            let how = Fit {
                tolerance: within,
                start: direction(said.start, "start")?,
                end: direction(said.end, "end")?,
                closed: said.closed,
                kinks: said.kinks.map(|angle| angle.0),
            };
            Ok(Value::Curve(whole(fit(&places(points), &how, cx.origin())?)))
        }
        Data::Rows(net) => {
            said.check(true)?;
            let net = rows(net);
            cx.seen(net.iter().flatten().copied());
            let tolerance = cx.tolerance()?;
            let (surface, notes) = surface::points::fit_net::fit(&net, within, cx.origin(), &tolerance)?;
            Ok(Value::Surface(reported(cx, surface, &notes)?))
        }
    }
}

builtins! {
    /// Smooth curve or surface through many points, or within a tolerance of them.
    ///
    /// Points give a curve, rows of points a surface. With `tolerance:` no point is farther than that from the result, and no knot
    /// of it can be left out, so that it has few spans; the first and the last point of a curve and the corners of a surface are met. Without it all points
    /// are met; the end tangents are those of the parabola through three points at each end, or `start:` and `end:`. Everything is
    /// cubic and twice continuously differentiable, but at corners: turns of the data above `kinks:`. `deviation` gives how far
    /// the points are from the result.
    /// ```loft
    /// let measured = [for i in 0..41: (i * 100mm, sin(i * 9deg) * 400mm, 0)]
    /// curve smooth = fit(measured, tolerance: 1mm)
    /// check deviation(smooth, measured).max <= 1mm
    /// surface ground = fit([for j in 0..13: [for i in 0..17: (i * 1m, j * 1m, sin(i * 20deg) * cos(j * 15deg) * 1m)]], tolerance: 5mm)
    /// ```
    fn fit(
        /// Points in order, or rows of them along u, one row per v.
        points: Data,
        /// How far the result may pass from a point, above 0.
        tolerance: Option<Length>,
        /// Direction at the first point of a curve through all.
        start: Option<Direction>,
        /// Direction at the last point.
        end: Option<Direction>,
        /// Whether a curve returns smoothly to its first point.
        closed: bool = "false",
        /// Turns of the data above this are kept as corners of a curve.
        kinks: Option<Angle>,
    ) -> Value = |cx, points, tolerance, start, end, closed, kinks| {
        fitted(cx, points, FitSettings { tolerance, start, end, closed, kinks })
    };
}
