//! Curves and surfaces through or near many points.

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::geometry::Ends;
use crate::geometry::construct::fit_curve::{Fit, fit};
use crate::geometry::construct::spline::Spacing;
use crate::geometry::shapes::least_squares::DEGREE;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::{places, whole};
use crate::lang::eval::std::point_nets::NetTwist;
use crate::lang::eval::std::splines::{SpacingWord, SplineEnd};
use crate::lang::eval::std::surfaces::{reported, rows};
use crate::lang::values::conversions::{Angle, FromValue, Length, Point};
use crate::lang::values::types::Ty;
use crate::lang::values::value::Value;
use crate::surface::points::fit_net::{self, Near, NetFitting};
use crate::surface::points::interpolate::{BorderEnds, CornerTwists};

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

/// What `fit` was told.
#[derive(Clone, Copy, Debug)]
struct FitSettings {
    tolerance: Option<Length>,
    noise: Option<Length>,
    start: Option<SplineEnd>,
    end: Option<SplineEnd>,
    closed: bool,
    kinks: Option<Angle>,
    parameter: Option<SpacingWord>,
    degree: Option<usize>,
    twist: Option<CornerTwists>,
}

impl FitSettings {
    /// E305 where two of these were given, or one that the kind of data does not take.
    fn check(self, surface: bool) -> Result<(), Halt> {
        let tangent = self.start.map(|_| "start").or(self.end.map(|_| "end"));
        let near = self.tolerance.map(|_| "tolerance").or(self.noise.map(|_| "noise"));
        let whole = self.closed.then_some("closed");
        let parameter = self.parameter.map(|_| "parameter");
        let degree = self.degree.map(|_| "degree");
        let refused = match (tangent, near, whole) {
            _ if self.tolerance.is_some() && self.noise.is_some() => {
                Some(("a tolerance or the noise of the points", ["tolerance", "noise"]))
            }
            (Some(tangent), Some(near), _) => Some(("end tangents or a tolerance, not both", [tangent, near])),
            (Some(tangent), _, Some(closed)) => Some(("end tangents or `closed: true`, not both", [tangent, closed])),
            (_, Some(near), _) if surface && self.twist.is_some() => Some(("a tolerance or twists at the corners", [near, "twist"])),
            _ if surface => {
                let only_curves = tangent.or(whole).or(self.kinks.map(|_| "kinks"));
                only_curves.map(|argument| ("rows of points, or what only curves take", ["points", argument]))
            }
            _ => {
                let only_surfaces = self.noise.map(|_| "noise").or(degree).or(self.twist.map(|_| "twist"));
                let corrected =
                    near.and(parameter).map(|argument| ("a spacing of the parameters, or a tolerance", ["tolerance", argument]));
                only_surfaces.map(|argument| ("a row of points, or what only surfaces take", ["points", argument])).or(corrected)
            }
        };
        match (refused, degree, near) {
            (Some((what, pair)), ..) => {
                Err(ValueFault::Exclusive { function: "fit", what, arguments: pair.to_vec(), example: EXAMPLE }.into())
            }
            (None, Some(_), None) => {
                let what = "a degree with a `tolerance:` or `noise:`; through all points surfaces are cubic";
                Err(ValueFault::Missing { function: "fit", what, example: "fit(rows, tolerance: 1mm, degree: 2)" }.into())
            }
            _ => Ok(()),
        }
    }

    /// How near a surface is to its points, or a curve (no noise).
    fn near(self) -> Result<Near, Halt> {
        for (argument, length) in [("tolerance", self.tolerance), ("noise", self.noise)] {
            if let Some(length) = length.filter(|length| length.0 <= 0.0) {
                let (found, range) = (length.0.to_string(), "above 0; left out, all points are met".to_owned());
                return Err(ValueFault::OutsideRange { argument, found, range }.into());
            }
        }
        Ok(match (self.tolerance, self.noise) {
            (Some(within), _) => Near::Within(within.0),
            (None, Some(deviation)) => Near::Noise(deviation.0),
            (None, None) => Near::All,
        })
    }

    fn degree(self) -> Result<usize, Halt> {
        match self.degree.unwrap_or(DEGREE) {
            degree if (1..=DEGREE).contains(&degree) => Ok(degree),
            degree => {
                let (found, range) = (degree.to_string(), format!("1 to {DEGREE}"));
                Err(ValueFault::OutsideRange { argument: "degree", found, range }.into())
            }
        }
    }
}

fn fitted(cx: &mut Cx, data: Data, said: FitSettings) -> Result<Value, Halt> {
    let near = said.near()?;
    let spacing = said.parameter.map_or(Spacing::Chord, SpacingWord::spacing);
    match data {
        Data::Row(points) => {
            said.check(false)?;
            let end = |end: Option<SplineEnd>, argument| end.map(|end| end.ends(argument)).transpose();
            let how = Fit {
                tolerance: said.tolerance.map(|t| t.0),
                start: end(said.start, "start")?,
                end: end(said.end, "end")?,
                spacing,
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
            let ends = BorderEnds { spacing, twists: said.twist.unwrap_or_default(), ..BorderEnds::alike(Ends::Bessel) };
            let how = NetFitting { near, ends, degree: said.degree()? };
            let (surface, notes) = fit_net::fit(&net, &how, cx.origin(), &tolerance)?;
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
    /// cubic and twice continuously differentiable, but at corners: turns of the data above `kinks:`; a surface near its points may have a lower
    /// `degree:`. For measured points that scatter `noise:` is their standard deviation: the root of the mean square of their distances comes
    /// to it, with few spans; where it is stated much smaller than they scatter the surface follows them, and W678 says so. `deviation`
    /// gives how far the points are from the result, and `fair` moves single points that are off.
    /// ```loft
    /// let measured = [for i in 0..41: (i * 100mm, sin(i * 9deg) * 400mm, 0)]
    /// curve smooth = fit(measured, tolerance: 1mm)
    /// check deviation(smooth, measured).max <= 1mm
    /// surface ground = fit([for j in 0..13: [for i in 0..17: (i * 1m, j * 1m, sin(i * 20deg) * cos(j * 15deg) * 1m)]], tolerance: 5mm)
    /// let dish = [for j in 0..9: [for i in 0..9: (i * 1m, j * 1m, i * i * j * 10mm)]]
    /// surface one = fit(dish, tolerance: 1um, degree: 2, parameter: uniform)
    /// check one.net_size == [3, 3]
    /// ```
    fn fit(
        /// Points in order, or rows of them along u, one row per v.
        points: Data,
        /// How far the result may pass from a point, above 0.
        tolerance: Option<Length>,
        /// Direction at the first point of a curve through all, `natural` or `bessel`; that of a parabola when left out.
        start: Option<SplineEnd>,
        /// The same at the last point.
        end: Option<SplineEnd>,
        /// Whether a curve returns smoothly to its first point.
        closed: bool = "false",
        /// Turns of the data above this are kept as corners of a curve.
        kinks: Option<Angle>,
        /// Spacing of the parameters; chord lengths when left out.
        parameter: Option<SpacingWord>,
        /// Standard deviation of the points of a surface about what is sought, above 0.
        noise: Option<Length>,
        /// Degree of a surface near its points, 1 to 3; 3 when left out.
        degree: Option<usize>,
        /// Twists at the corners of a surface through all points, as of `grid`; of parabolas when left out.
        twist: Option<NetTwist>,
    ) -> Value = |cx, points, tolerance, start, end, closed, kinks, parameter, noise, degree, twist| {
        let twist = twist.map(NetTwist::twists).transpose()?;
        fitted(cx, points, FitSettings { tolerance, noise, start, end, closed, kinks, parameter, degree, twist })
    };
}
