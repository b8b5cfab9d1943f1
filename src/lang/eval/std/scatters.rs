//! Surfaces through scattered points.

use crate::builtins;
use crate::lang::eval::std::curves::places;
use crate::lang::eval::std::surfaces::reported;
use crate::lang::values::conversions::{Direction, Point};
use crate::surface::{self, Surface};

builtins! {
    /// Smooth surface through scattered points.
    ///
    /// The points come in any order and without rows. They are joined to triangles in the plane nearest to them (Delaunay), or seen along
    /// `along:`; over each triangle lie three cubics [Clough & Tocher 1965], whose gradients at the points are those of the quadratics
    /// nearest to their neighbours. The surface contains every point and is smooth everywhere; planes are met exactly, and quadratics where
    /// a point has neighbours enough. Its border is the convex hull of the points, drawn in to points that are about in a row along it (thin
    /// triangles, below 3°, are left out). u and v run over their box in the plane, u as near to
    /// the x-axis as can be; the normal points up. A place of the plane has one height: points of a closed surface are divided first.
    /// ```loft
    /// let soundings = [for k in 0..40: (sin(k * 137deg) * k * 25m, cos(k * 137deg) * k * 25m, -20m - cos(k * 9deg) * 5m)]
    /// surface bed = scatter(soundings, along: (0, 0, 1))
    /// check deviation(bed, soundings).max <= 1e-6mm
    /// ```
    fn scatter(
        /// Three or more points that do not lie on one line.
        points: Vec<Point>,
        /// The direction of heights; the normal of the plane nearest to the points when left out.
        along: Option<Direction>,
    ) -> Surface = |cx, points, along| {
        let points = places(points);
        cx.seen(points.iter().copied());
        let tolerance = cx.tolerance()?;
        let (surface, notes) = surface::scatter(&points, along.map(|d| d.0), cx.origin(), &tolerance)?;
        reported(cx, surface, &notes)
    };
}
