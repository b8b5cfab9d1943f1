//! Surfaces over nets of points: Bézier, polynomial, NURBS and interpolated.

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::lang::eval::std::surfaces::{reported, rows};
use crate::lang::values::conversions::{Length, Point};
use crate::surface::Surface;
use crate::surface::points::control_net::{self, Net};
use crate::surface::points::interpolate;

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
    /// Bicubic, twice continuously differentiable, natural at its border.
    /// ```loft
    /// surface ground = grid([for j in 0..4: [for i in 0..5: (i * 1m, j * 1m, sin(i * 60deg) * 200mm)]])
    /// ```
    fn grid(
        /// Rows of points along u, one row per v, all as long.
        points: Vec<Vec<Point>>,
    ) -> Surface = |cx, points| {
        let points = rows(points);
        cx.seen(points.iter().flatten().copied());
        let tolerance = cx.tolerance()?;
        let (surface, notes) = interpolate::grid(&points, cx.origin(), &tolerance)?;
        reported(cx, surface, &notes)
    };
}
