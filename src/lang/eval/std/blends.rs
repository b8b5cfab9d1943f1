//! Roundings and smooth strips between surfaces.

use crate::base::fault::{Say, ValueFault};
use crate::builtins;
use crate::lang::eval::std::surfaces::reported;
use crate::lang::values::conversions::{Length, Point};
use crate::surface::blended::bridge::bridge;
use crate::surface::{Surface, rolling};

builtins! {
    /// Two surfaces with a rounding in the place of the edge in which they meet.
    ///
    /// A list of three: the first surface cut back, the rounding, the second one cut back. The rounding is the envelope of a ball that
    /// rolls along the edge and touches both; it joins both smoothly. u runs along the edge, v from the first surface to the second;
    /// its normal is on the side of the first one's. Where a surface extends past the edge, the ball is on the side of the other one on
    /// which the point `keep:` is, and the rest is cut off too; a centre of the ball is always right. Without `keep:` it is on the side of
    /// the other one's normal. Between planes, and round an axis, the rounding is a part of a cylinder or a torus, exactly; elsewhere a net
    /// within a quarter of the tolerance. An open edge ends on borders of both surfaces. A radius that does not fit is E673, which states the largest one.
    /// ```loft
    /// surface floor = plane(polyline([(0, 0, 0), (2m, 0, 0), (2m, 1m, 0), (0, 1m, 0)], closed: true))
    /// surface wall = extrude(line((0, 0, 0), (2m, 0, 0)), by: (0, 0, 1m))
    /// let parts = blend(wall, floor, radius: 200mm)
    /// check parts[1].area == pi / 2 * 200mm * 2m within 1e-9%
    /// shell corner of parts
    /// ```
    fn blend(
        /// One surface.
        a: Surface,
        /// The other one.
        b: Surface,
        /// Radius of the ball, above 0.
        radius: Length,
        /// A point on the sides of both surfaces on which the ball is, where they extend past the edge.
        keep: Option<Point>,
    ) -> Vec<Surface> = |cx, a, b, radius, keep| {
        if radius.0 <= 0.0 {
            return Err(ValueFault::OutsideRange { argument: "radius", found: cx.length(radius.0), range: "above 0".to_owned() }.into());
        }
        let (origin, tolerance) = (cx.origin(), cx.tolerance()?);
        let parts = rolling([&a, &b], radius.0, keep.map(|p| p.0), origin, &tolerance)?;
        parts.into_iter().map(|part| reported(cx, part, &[])).collect()
    };

    /// A strip between two surfaces that continues both smoothly.
    ///
    /// It fills a gap: its borders are the two borders that face each other, found by the distances of places along them, with no gap, and it has
    /// the tangent planes of both surfaces all along them. Across the strip it is a cubic that is run through at an even speed. u runs along the
    /// border of the first surface, v from there to the second one; its ends are the cubics between the ends of the borders. Both surfaces
    /// are untrimmed B-splines (`grid`, `fit`, `nurbs_surface`, `bezier_surface`, or what `nurbs(s)` gives), else E306.
    /// ```loft
    /// surface low = grid([for j in 0..3: [for i in 0..4: (i * 1m, j * 1m, 0)]])
    /// surface high = grid([for j in 4..7: [for i in 0..4: (i * 1m, j * 1m, 1m)]])
    /// surface strip = bridge(low, high)
    /// check connection(low, strip).angle < 0.001deg
    /// check connection(strip, high).gap < 1um
    /// ```
    fn bridge(
        /// One surface.
        a: Surface,
        /// The other one.
        b: Surface,
    ) -> Surface = |cx, a, b| {
        let (origin, tolerance) = (cx.origin(), cx.tolerance()?);
        let strip = bridge([&a, &b], origin, &tolerance)?;
        reported(cx, strip, &[])
    };
}
