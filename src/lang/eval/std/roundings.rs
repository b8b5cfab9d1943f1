//! Corners of curves made round or cut.

use crate::builtins;
use crate::geometry::construct::fillet::{Treatment, treat};
use crate::lang::eval::std::curves::{places, whole};
use crate::lang::values::conversions::{Length, Point};
use crate::network::Chain;

builtins! {
    /// Curve with arcs in the place of its corners.
    ///
    /// Each arc touches both sides of its corner, which are cut back to it; the sides may be lines, arcs and any other curves
    /// that lie in a plane there. A closed curve whose first corner is rounded starts where the arc there ends. A radius that
    /// does not fit is E414, which states the largest one; two corners that share a side are treated together.
    /// ```loft
    /// let bent = polyline([(0, 0), (4m, 0), (4m, 3m), (8m, 3m)])
    /// curve one = fillet(bent, at: (4m, 0), radius: 1m)
    /// curve both = fillet(bent, radius: 1m)
    /// check one.length - both.length == (2 - pi / 2) * 1m within 1e-9
    /// ```
    fn fillet(
        /// A curve with corners.
        of: Chain,
        /// Corners to be rounded; left out, all of them.
        at: Option<Vec<Point>>,
        /// Radius of the arcs, above 0.
        radius: Length,
    ) -> Chain = |cx, of, at, radius| {
        let (curve, origin) = (of.to_curve()?, cx.origin());
        Ok(whole(treat(&curve, at.map(places).as_deref(), (Treatment::Round(radius.0), "radius"), origin)?))
    };

    /// Curve with straight cuts in the place of its corners.
    ///
    /// `length:` is what each of the two sides of a corner loses, along the side. A closed curve whose first corner is cut starts
    /// where the cut there ends. A length that does not fit is E414, which states the largest one.
    /// ```loft
    /// let corner = polyline([(0, 0), (4m, 0), (4m, 3m)])
    /// curve cut = chamfer(corner, length: 1m)
    /// check cut.length == (5 + sqrt(2)) * 1m within 1e-9
    /// ```
    fn chamfer(
        /// A curve with corners.
        of: Chain,
        /// Corners to be cut; left out, all of them.
        at: Option<Vec<Point>>,
        /// What each side of a corner loses, above 0.
        length: Length,
    ) -> Chain = |cx, of, at, length| {
        let (curve, origin) = (of.to_curve()?, cx.origin());
        Ok(whole(treat(&curve, at.map(places).as_deref(), (Treatment::Cut(length.0), "length"), origin)?))
    };
}
