//! The one place where it is said when two things are the same.

use glam::DVec3;

/// What counts as equal in one model; made once, passed first.
///
/// `point` is what the user allows, `rounding` what arithmetic may have done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Two points closer than this are one, model length units.
    pub point: f64,
    /// What rounding may have done to a coordinate: 1e-12 × the model's size, model length units.
    pub rounding: f64,
    /// Smaller turns are smooth, larger ones are kinks, radians.
    pub angle: f64,
    /// Ends iterations on parameters normalised to 0…1.
    pub parameter: f64,
}

crate::content!(Tolerance { point, rounding, angle, parameter });

/// Sine of the angle by which normals may differ from those of the simple form that a surface is taken for.
pub const FLAT: f64 = 1e-6;
/// Relative accuracy of a stored arc length.
pub const LENGTH_ACCURACY: f64 = 1e-13;
/// Absolute error that a panel of a stored arc length may always have, model length units.
pub const LENGTH_FLOOR: f64 = 1e-16;
/// Error of a panel of a stored arc length that rounding of the points makes, as a share of their distance from the origin.
pub const LENGTH_ROUNDING: f64 = 4e-15;
/// A quotient within this of a whole number is that number (counts of mesh steps).
pub const WHOLE_NUMBER: f64 = 1e-9;
/// Smallest sine of the angle between two directions that may span a plane or count as not parallel.
pub const PARALLEL: f64 = 1e-9;
/// Relative change at which floating point arithmetic has nothing more to give.
pub const EPSILON: f64 = 1e-14;
/// How far a fitted frame along a path may be from the exact one, entry by entry.
pub const FRAME: f64 = 1e-12;
/// Share of the largest speed below which a curve stands still: a cusp.
pub const CUSP: f64 = 1e-10;
/// Two runs of a loop that meet within the tolerance and are farther apart than this share of it do not cross each other.
pub const BESIDE: f64 = 1e-3;
/// A piece of a part of a curve that is shorter than this share of the curve is there by rounding: the part was to end at a knot
/// and ends beside it. What is said of it by differences is noise, and what it adds to bounds is nothing.
pub const SLIVER: f64 = 1e-10;
/// Least interval, as a share of the domain, over which a direction is taken where derivatives vanish.
pub const NUDGE: f64 = 1e-6;
/// A tangent shorter than this share of the size is not taken from a polynomial that is as near as rounding: its direction would be off.
pub const SHORT_TANGENT: f64 = 1e-5;
/// Step of a Newton iteration, as a share of the piece, after which one more would change nothing.
pub const NEWTON_STEP: f64 = 1e-8;
/// Two sums of areas in (u, v) that differ by no more than this share are of one region.
pub const RELATIVE_AREA: f64 = 1e-7;
/// Rounding of a squared cosine, with much to spare.
pub const COSINE_ROUNDING: f64 = 1e-9;
/// Stated relative error of areas, volumes and moments.
pub const MEASURE_ACCURACY: f64 = 1e-10;
/// Relative errors of integrals up to which what does not fall from one size of cells to the next is rounding.
pub const MEASURE_ROUNDING: f64 = 1e-8;
/// W228 tells of a measure whose estimated relative error is larger than this.
pub const MEASURE_TOLD: f64 = 1e-6;
/// What is integrated counts as at least this share of what it could be with the same lengths: below that it is rounding.
pub const LEAST_SIZE: f64 = 1e-4;
/// Relative error of a volume of which only the sign is wanted, where the body is not thin.
pub const SIGN_ACCURACY: f64 = 1e-3;
/// Share by which an area or a volume may differ from what a file states of it, and its centroid as a share of the size.
pub const STATED: f64 = 1e-4;
/// Below this barycentric distance from a corner a quotient 0/0 is replaced by its expansion.
pub const POLE_REACH: f64 = 1e-6;
/// Parameter distance from a pole at which its normal is averaged when the tangents there are parallel.
pub const POLE_STEP: f64 = 1e-3;
/// |U_u × U_v| below this share of the largest |U_u|·|U_v| is singular.
pub const SINGULAR: f64 = 1e-9;
/// Jump of a first derivative of a net, as a share of it, up to which it is rounding of the control points in a file.
pub const SAME_SLOPE: f64 = 1e-10;
/// Largest share of the size of a face's borders by which they are moved to make them borders of its surface.
pub const MOST_REPAIR: f64 = 0.1;
/// Share of the size of a face's borders up to which they may be farther off its surface than they were found to be.
pub const SMALL_GAP: f64 = 1e-3;
/// How far before a knot, in the parameter, the span that ends there is evaluated.
pub const BEFORE_KNOT: f64 = 1e-13;
/// Places on a surface nearer than so many tolerances are taken as one where curves divide it: two curves that meet there are each
/// within the tolerance of the place, and of the surface.
pub const TOLD_APART: f64 = 4.0;
/// A free end that misses a curve by at most this many tolerances gets a warning.
pub const NEAR_MISS: f64 = 10.0;
/// A loop of a file within this share of the tolerance of a surface's own border is that border: two such borders of one curve are then
/// within the tolerance of each other. Beyond that the curve is the border, for every face that has it.
pub const ONE_BORDER: f64 = 0.5;
/// Borders of imported faces are glued over this many times the widest gap inside the borders of one face (`docs/notes/glue.md`).
pub const GAP_ROOM: f64 = 10.0;
/// Free borders that run along each other within this many times the stated glue distance were meant to be one.
pub const MISMATCH: f64 = 3.0;
/// Curvature, as a share of the larger one, that a downhill step assumes where the function bends the other way.
pub const LEAST_CURVATURE: f64 = 1e-3;

/// Ends that `snap` moves by at most this share of their curve's length: a measurement is good to better than a hundredth, and
/// a curve that moves further is another one.
pub const SNAP_SHARE: f64 = 0.01;
/// Share of the tolerance to which places found by computing are shown.
const SHOWN: f64 = 1e-3;
/// Most decimals of a place that is shown.
const MOST_PLACES: f64 = 300.0;

const DEFAULT_ANGLE_DEG: f64 = 0.1;
const DEFAULT_PARAMETER: f64 = 1e-9;
const POINT_SHARE: f64 = 1e-6;
/// Least tolerance over the rounding of coordinates.
const ROUNDINGS: f64 = 10.0;
/// What arithmetic may have done to a coordinate, as a share of the model's size.
pub const ROUNDING_SHARE: f64 = 1e-12;
/// The nearest pair of two curves is the nearest one to this share of its distance.
pub const NEAREST_PAIR: f64 = 1e-6;
/// No point of a surface stands out of its box by more than this share of the diagonal.
pub const BOX: f64 = 1e-6;
/// A bound above this says nothing; finite, so that arithmetic on it never becomes NaN.
pub const UNBOUNDED_REACH: f64 = 1e120;
/// No place of an edge is nearer to a point by more than this share of the distance than the one that is given.
pub const NEAREST_PLACE: f64 = 1e-3;
/// A place outside of a triangle by this share of it, or less, is read from it.
pub const BESIDE_TRIANGLE: f64 = 1e-9;
/// A node nearer to an edge of a border, in the chart, than this share of the side of the cells about it lies on the edge.
pub const ON_EDGE: f64 = 1e-3;
/// How far an interpolated surface may lie beside the surface itself, over the least length of elements.
pub const INTERPOLATED: f64 = 1e-4;
/// Sine of a corner of a quad below which all are as bad.
pub const FLAT_CORNER: f64 = 1e-3;
/// Damping of the second derivatives of a nearest quadratic, as a share of the sum of all squares.
pub const DAMPED_BENDS: f64 = 1e-4;
/// Damping of its first ones.
pub const DAMPED_SLOPES: f64 = 1e-12;
/// Deviation of a surface over the width of a box that counts as none.
pub const FLAT_BOX: f64 = 1e-9;
/// Nearest points are the nearest ones to this share of their distance.
pub const NEAREST: f64 = 1e-9;
/// Share of the sum of sizes to which trimmed faces that a water plane crosses are integrated.
pub const FLOAT_TRIMMED: f64 = 1e-9;
/// Difference of the volume below water from two directions that still is one volume, as a share of wetted area times length.
pub const FLOAT_CLOSED: f64 = 1e-6;
/// How near to a water plane what lies along it is, as a share of the diagonal of the body.
pub const FLOAT_ALONG: f64 = 1e-7;
/// Residuals of a position of rest that end its search: of the volume as a share of it, of the arms as shares of the length of the body.
pub const FLOAT_AT_REST: f64 = 1e-12;
/// The same where rounds do not lower them any more.
pub const FLOAT_NEARLY_AT_REST: f64 = 1e-9;
/// How far the net that stands for a face of a floating body may be off, as a share of the reach of the body.
pub const FLOAT_NET: f64 = 1e-9;
/// Difference of two rules that ends a cell of a floating body, as a share of its area times the powers of the reach of the body.
pub const FLOAT_CELL: f64 = 1e-10;
/// The same where a rule of more points does not come nearer: the face is less than analytic there.
pub const FLOAT_ROUGH_CELL: f64 = 1e-8;
/// A flat face is level with the water where the sine of the angle between them is below this.
pub const FLOAT_LEVEL: f64 = 1e-12;
/// Share of the rows between which the farthest place of a waterline is found.
pub const FLOAT_FARTHEST: f64 = 1e-9;
/// How far beside a plane a waterline or cross section is taken, as a share of the diagonal of the body: faces may meet in the plane itself.
pub const FLOAT_BESIDE: f64 = 1e-10;
/// Difference of two rules that ends a part of a cell below water, as a share of what the whole body may have.
pub const FLOAT_WET: f64 = 1e-12;
/// Share of the range of depths to which a first depth of a position is found.
pub const FLOAT_FIRST_DEPTH: f64 = 1e-3;
/// By how much of the energy before a row of faired points might be fairer within the same distance.
pub const FAIR_ROW: f64 = 1e-6;
/// The same of rows of points.
pub const FAIR_ROWS: f64 = 1e-3;
/// Knots of borders over 0…1 that are nearer are one.
pub const BRIDGE_KNOT: f64 = 1e-12;
/// Heights of a curve over a plane of this share of the largest are rounding.
pub const CURVE_HEIGHT_ROUNDING: f64 = 4e-16;
/// Crossings of a curve and a plane that are nearer than this share of the curve's parameters are one: a touch is known no better.
pub const CURVE_CROSSINGS_APART: f64 = 1e-7;
/// Points of a section and of a line of a hull that are nearer than this share of the hull's diagonal are one.
pub const OFFSETS_SAME: f64 = 1e-6;
/// Places of the border of a plane face of quads are multiples of a power of two, about this share of its diagonal.
pub const PLANE_GRID: f64 = 1.5e-11;
/// How far the first field of a hole may be from the borders, as a share of the size of the hole.
pub const FILL_GAP: f64 = 1e-7;
/// How far its tangent planes may be from those beside it, radians.
pub const FILL_ANGLE: f64 = 1e-5;
/// How far its curvatures may be from those beside it, as a share of these.
pub const FILL_BEND: f64 = 1e-3;
/// A pivot of least squares of a hole below this share of its own entry is none.
pub const FILL_PIVOT: f64 = 1e-13;

impl Tolerance {
    /// Tolerance with the given point distance in a model of the given box diagonal, both in model units.
    pub fn new(point: f64, diagonal: f64) -> Self {
        Self { point, rounding: ROUNDING_SHARE * diagonal.max(point), angle: DEFAULT_ANGLE_DEG.to_radians(), parameter: DEFAULT_PARAMETER }
    }

    /// The default for a model whose box has this diagonal: a millionth of it, rounded down to a power of ten.
    ///
    /// `fallback` (model units) is used when the diagonal is zero: a model without points.
    pub fn from_diagonal(diagonal: f64, fallback: f64) -> Self {
        if !(diagonal > 0.0 && diagonal.is_finite()) {
            return Self::new(fallback, 0.0);
        }
        let wanted = POINT_SHARE * diagonal;
        let mut exponent = super::math::log10(wanted).floor() as i32;
        // The logarithm of an exact power of ten may fall a hair below it.
        if power_of_ten(exponent + 1) <= wanted {
            exponent += 1;
        }
        Self::new(power_of_ten(exponent), diagonal)
    }

    /// The same for a model that reaches so far from the origin, model units: not below what rounding does to coordinates there.
    pub fn at_distance(self, furthest: f64) -> Self {
        let rounding = EPSILON * furthest;
        if !(rounding > self.rounding && rounding.is_finite()) {
            return self;
        }
        let (mut exponent, least) = (super::math::log10(rounding).floor() as i32, ROUNDINGS * rounding);
        while power_of_ten(exponent) < least {
            exponent += 1;
        }
        Self { point: self.point.max(power_of_ten(exponent)), rounding, ..self }
    }

    /// The same with another angle that separates kinks from smooth turns, radians.
    pub fn with_angle(self, angle: f64) -> Self {
        Self { angle, ..self }
    }

    /// The diagonal of the model's box, at least the tolerance, model length units.
    pub fn size(&self) -> f64 {
        self.rounding / ROUNDING_SHARE
    }

    /// Whether two points are one.
    pub fn same_point(&self, a: DVec3, b: DVec3) -> bool {
        a.distance_squared(b) <= self.point * self.point
    }

    /// A place that was computed, as it is shown to people: whole multiples of a thousandth of the tolerance, so that `-4.9e-16`
    /// is 0. The largest power of ten up to that thousandth is the step; a coordinate too large for it stays as it is.
    pub fn rounded(&self, p: DVec3) -> DVec3 {
        let places = -super::math::log10(self.point * SHOWN).floor();
        if !(0.0..=MOST_PLACES).contains(&places) {
            return p;
        }
        let places = places as usize;
        let one = |x: f64| format!("{x:.places$}").parse::<f64>().map_or(x, |rounded| rounded + 0.0);
        DVec3::new(one(p.x), one(p.y), one(p.z))
    }

    /// Whether a curve with these one-sided tangents (any length but zero) has a kink.
    pub fn is_kink(&self, before: DVec3, after: DVec3) -> bool {
        super::math::angle_between(before, after) > self.angle
    }
}

/// 10^exponent as the nearest double.
fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_shown_to_a_thousandth_of_the_tolerance() {
        let (tolerance, thousand) = (Tolerance::new(1e-3, 1e3), Tolerance::new(1e6, 1e12));
        for (x, shown) in [(-4.9e-16, 0.0_f64), (0.1 + 0.2, 0.3), (12.3456789012, 12.345679), (-1.5e300, -1.5e300), (2e-6, 2e-6)] {
            let found = tolerance.rounded(DVec3::splat(x));
            assert_eq!((found.x.to_bits(), found.z), (shown.to_bits(), shown), "{x}");
        }
        assert_eq!(thousand.rounded(DVec3::splat(1.5)), DVec3::splat(1.5));
    }

    #[test]
    fn default_is_a_power_of_ten_at_or_below_a_millionth() {
        for (diagonal, expected) in [(1000.0, 1e-3), (999.0, 1e-4), (1.0, 1e-6), (12.5, 1e-5), (3e9, 1e3)] {
            assert_eq!(Tolerance::from_diagonal(diagonal, 1.0).point, expected, "{diagonal}");
        }
        assert_eq!(Tolerance::from_diagonal(0.0, 0.001).point, 0.001);
    }

    #[test]
    fn far_from_the_origin_the_size_decides_until_rounding_does() {
        for (diagonal, furthest, expected) in [(70.0, 3.7e5, 1e-5), (70.0, 0.0, 1e-5), (1.0, 1e9, 1e-4), (1.0, 3e9, 1e-3)] {
            let tolerance = Tolerance::from_diagonal(diagonal, 1.0).at_distance(furthest);
            assert_eq!(tolerance.point, expected, "{diagonal} {furthest}");
        }
    }
}
