//! Surfaces over nets of points: Bézier, polynomial, NURBS and interpolated.

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::geometry::Ends;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::unit;
use crate::lang::eval::std::splines::{SpacingWord, SplineEnd};
use crate::lang::eval::std::surfaces::{reported, rows};
use crate::lang::values::conversions::{Direction, FromValue, Length, Point};
use crate::lang::values::types::Ty;
use crate::lang::values::value::Value;
use crate::surface::Surface;
use crate::surface::points::control_net::{self, Net};
use crate::surface::points::interpolate::{self, BorderEnd, BorderEnds, CornerTwists};

/// How a surface leaves a border of its grid.
#[derive(Clone, Debug)]
pub enum NetEnd {
    /// Alike everywhere.
    One(SplineEnd),
    /// In a direction at each point of the border.
    Each(Vec<Direction>),
}

impl FromValue for NetEnd {
    const TY: Ty = Ty::OneOf(&[Ty::List(&Ty::Direction), Ty::Choice(&["natural", "bessel"]), Ty::Direction]);
    fn from_value(value: Value) -> Option<Self> {
        if matches!(value, Value::List(_)) { Vec::from_value(value).map(Self::Each) } else { SplineEnd::from_value(value).map(Self::One) }
    }
}

impl NetEnd {
    /// E306 for a direction without a length.
    pub(crate) fn border(self, argument: &'static str) -> Result<BorderEnd, Halt> {
        Ok(match self {
            Self::One(end) => BorderEnd::Alike(end.ends(argument)?),
            // One direction may arrive as a list of it.
            Self::Each(all) if all.len() == 1 => BorderEnd::Alike(Ends::Clamped(unit(all[0].0, argument)?)),
            Self::Each(all) => BorderEnd::Along(all.into_iter().map(|along| unit(along.0, argument)).collect::<Result<_, _>>()?),
        })
    }
}

/// Twists at the corners of a grid.
#[derive(Clone, Debug)]
pub enum NetTwist {
    /// `zero` or `adini`.
    Word(CornerTwists),
    /// One a corner.
    Each(Vec<Point>),
}

impl FromValue for NetTwist {
    const TY: Ty = Ty::OneOf(&[Ty::List(&Ty::Point), Ty::Choice(&["zero", "adini"])]);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Word(word) if &*word == "adini" => Some(Self::Word(CornerTwists::Adini)),
            Value::Word(_) => Some(Self::Word(CornerTwists::Zero)),
            list => Vec::from_value(list).map(Self::Each),
        }
    }
}

impl NetTwist {
    /// E306 for other than four vectors.
    pub(crate) fn twists(self) -> Result<CornerTwists, Halt> {
        match self {
            Self::Word(twists) => Ok(twists),
            Self::Each(all) => match all[..] {
                [a, b, c, d] => Ok(CornerTwists::Given([a.0, b.0, c.0, d.0])),
                _ => {
                    let (found, range) = (format!("{} vectors", all.len()), "4, at (0, 0), (1, 0), (0, 1) and (1, 1)".to_owned());
                    Err(ValueFault::OutsideRange { argument: "twist", found, range }.into())
                }
            },
        }
    }
}

builtins! {
    /// Bézier surface of a net of control points.
    ///
    /// ```loft
    /// surface sail = bezier_surface([[(0, 0, 0), (1m, 0, 1m), (2m, 0, 0)], [(0, 2m, 0), (1m, 2m, 0), (2m, 2m, 1m)]])
    /// ```
    fn bezier_surface(
        /// Rows of control points along u, one row per v, all as long.
        net: Vec<Vec<Point>>,
        /// A weight for each point, in the same rows.
        weights: Option<Vec<Vec<f64>>>,
    ) -> Surface = |cx, net, weights| {
        let net = rows(net);
        cx.seen(net.iter().flatten().copied());
        let tolerance = cx.tolerance()?;
        let surface = control_net::bezier(&Net { rows: &net, weights: weights.as_deref() }, cx.origin(), &tolerance)?;
        reported(cx, surface, &[])
    };

    /// Polynomial patch: coordinates are sums of coefficients times powers of u, v.
    ///
    /// The coefficient in row i, place j belongs to u^i v^j. The patch is kept as a Bézier surface, exactly but for rounding, and
    /// may be trimmed by curves in u and v. Records of patches: `[for p in part.patches: polynomial(x: p.x, y: p.y, z: p.z)]`.
    /// ```loft
    /// surface saddle = polynomial(
    ///   x: [[0, 0, 0], [2, 0, 0]],
    ///   y: [[0, 3, 0], [0, 0, 0]],
    ///   z: [[0, 0, 1], [0, -2, 0]]
    /// )
    /// let p = saddle.at(0.5, 1) // => (1mm, 3mm, 0mm)
    /// ```
    fn polynomial(
        /// Coefficients of x: a row for each power of u, in it one for each power of v.
        x: Vec<Vec<Length>>,
        /// Those of y, in as many rows.
        y: Vec<Vec<Length>>,
        /// Those of z.
        z: Vec<Vec<Length>>,
    ) -> Surface = |cx, x, y, z| {
        let shape = |rows: &[Vec<Length>]| rows.iter().map(Vec::len).collect::<Vec<_>>();
        for (argument, other) in [("y", &y), ("z", &z)] {
            if shape(other) != shape(&x) {
                let (found, range) = (format!("rows of {:?}", shape(other)), format!("rows of {:?} as in `x`", shape(&x)));
                return Err(ValueFault::OutsideRange { argument, found, range }.into());
            }
        }
        let row = |i: usize| (0..x[i].len()).map(|j| DVec3::new(x[i][j].0, y[i][j].0, z[i][j].0)).collect();
        let coefficients: Vec<Vec<DVec3>> = (0..x.len()).map(row).collect();
        let net = crate::surface::polynomial_net(&coefficients)?;
        cx.seen(net.iter().flatten().copied());
        let tolerance = cx.tolerance()?;
        let surface = control_net::bezier(&Net { rows: &net, weights: None }, cx.origin(), &tolerance)?;
        reported(cx, surface, &[])
    };

    /// Rational B-spline surface of a net of control points.
    ///
    /// ```loft
    /// let net = [for j in 0..4: [for i in 0..5: (i * 1m, j * 1m, (i + j) * 100mm)]]
    /// surface panel = nurbs_surface(net, degree_u: 3, degree_v: 2)
    /// ```
    fn nurbs_surface(
        /// Rows of control points along u, one row per v, all as long.
        net: Vec<Vec<Point>>,
        /// Degree along u.
        degree_u: usize = "3",
        /// Degree along v.
        degree_v: usize = "3",
        /// Knots along u; clamped and uniform when left out.
        knots_u: Option<Vec<f64>>,
        /// Knots along v.
        knots_v: Option<Vec<f64>>,
        /// A weight for each point, in the same rows.
        weights: Option<Vec<Vec<f64>>>,
    ) -> Surface = |cx, net, degree_u, degree_v, knots_u, knots_v, weights| {
        let net = rows(net);
        cx.seen(net.iter().flatten().copied());
        let tolerance = cx.tolerance()?;
        let knots = (knots_u.as_deref(), knots_v.as_deref());
        let net = Net { rows: &net, weights: weights.as_deref() };
        let surface = control_net::nurbs(&net, (degree_u, degree_v), knots, cx.origin(), &tolerance)?;
        reported(cx, surface, &[])
    };

    /// Smooth surface through a grid of points.
    ///
    /// Bicubic, twice continuously differentiable. It leaves each border `natural`, without a bend across it, or `bessel`, as the
    /// parabola through three points does, or in a direction, or in one for each point of the border. Parameters are mean chord lengths, or
    /// `centripetal`, or `uniform`: then grids that have a row of points in common have the same border curve there, with no gap.
    ///
    /// Where no border is natural the corners have twists: those of parabolas along the border, none (`zero`), those of the Coons patches
    /// of the corner cells (`adini`), or given ones: mixed derivatives over the parameters of the corner cell, each from 0 to 1.
    /// ```loft
    /// let points = [for j in 0..4: [for i in 0..5: (i * 1m, j * 1m, sin(i * 60deg) * 200mm)]]
    /// surface ground = grid(points)
    /// surface level = grid(points, start_u: (1, 0, 0), end_u: bessel, parameter: uniform)
    /// let saddle = [for j in 0..4: [for i in 0..5: (i * 1m, j * 1m, i * j * 200mm)]]
    /// let each = (0, 0, 200mm)
    /// surface twisted = grid(saddle, start_u: bessel, end_u: bessel, start_v: bessel, end_v: bessel, twist: [each, each, each, each])
    /// ```
    fn grid(
        /// Rows of points along u, one row per v, all as long.
        points: Vec<Vec<Point>>,
        /// How it leaves the first u: `natural`, `bessel`, a direction or one a row; natural when left out.
        start_u: Option<NetEnd>,
        /// How it arrives at the last u.
        end_u: Option<NetEnd>,
        /// How it leaves the first v.
        start_v: Option<NetEnd>,
        /// How it arrives at the last v.
        end_v: Option<NetEnd>,
        /// Spacing of the parameters.
        parameter: SpacingWord = "chord",
        /// Twists at the corners: `zero`, `adini`, or four vectors at (0, 0), (1, 0), (0, 1) and (1, 1); of parabolas when left out.
        twist: Option<NetTwist>,
    ) -> Surface = |cx, points, start_u, end_u, start_v, end_v, parameter, twist| {
        let points = rows(points);
        cx.seen(points.iter().flatten().copied());
        let tolerance = cx.tolerance()?;
        let end = |end: Option<NetEnd>, argument| end.map_or(Ok(BorderEnd::Alike(Ends::Natural)), |end| end.border(argument));
        let ends = BorderEnds {
            u: [end(start_u, "start_u")?, end(end_u, "end_u")?],
            v: [end(start_v, "start_v")?, end(end_v, "end_v")?],
            spacing: parameter.spacing(),
            twists: twist.map_or(Ok(CornerTwists::default()), NetTwist::twists)?,
        };
        let (surface, notes) = interpolate::grid_with(&points, &ends, cx.origin(), &tolerance)?;
        reported(cx, surface, &notes)
    };
}
