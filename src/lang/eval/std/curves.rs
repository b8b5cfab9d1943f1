//! Constructors of curves.

use glam::DVec3;

use crate::base::fault::{Fault, ValueFault};
use crate::base::math;
use crate::base::tolerance::PARALLEL;
use crate::builtins;
use crate::geometry::construct::{build, fillet};
use crate::geometry::{Curve, Kind};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::conversions::{Angle, Direction, FromValue, Length, Point};
use crate::lang::values::types::Ty;
use crate::lang::values::value::Value;
use crate::network::Chain;
use crate::surface::Surface;

/// A constructed curve as a value.
pub(crate) fn whole(curve: Curve) -> Chain {
    Chain::of_curve(&curve)
}

/// The direction at length one; the zero vector has none.
pub(crate) fn unit(direction: DVec3, argument: &'static str) -> Result<DVec3, Halt> {
    // Scaling by the largest coordinate keeps tiny and huge directions apart from zero.
    let largest = direction.abs().max_element();
    match (largest > 0.0).then(|| math::unit(direction / largest, PARALLEL)).flatten() {
        Some(unit) => Ok(unit),
        None => {
            let found = format!("({}, {}, {})", direction.x, direction.y, direction.z);
            Err(ValueFault::OutsideRange { argument, found, range: "a direction other than 0".to_owned() }.into())
        }
    }
}

pub(crate) fn places(points: Vec<Point>) -> Vec<DVec3> {
    points.into_iter().map(|p| p.0).collect()
}

const ARC_EXAMPLE: &str = "arc(A, B, through: P), or arc(center: C, start: A, angle: 90deg, normal: (0, 0, 1))";
const CIRCLE_EXAMPLE: &str = "circle(center: C, radius: 2m), or circle(center: C, start: A)";

/// The two ways to say an arc.
struct ArcSaid {
    from: Option<Point>,
    to: Option<Point>,
    through: Option<Point>,
    center: Option<Point>,
    start: Option<Point>,
    angle: Option<Angle>,
}

impl ArcSaid {
    fn exclusive(arguments: Vec<&'static str>) -> Halt {
        let what = "a third point or a centre, not both";
        ValueFault::Exclusive { function: "arc", what, arguments, example: ARC_EXAMPLE }.into()
    }

    fn missing(what: &'static str) -> Halt {
        ValueFault::Missing { function: "arc", what, example: ARC_EXAMPLE }.into()
    }

    fn build(self, normal: DVec3, origin: crate::base::origin::Origin) -> Result<Curve, Halt> {
        let given = |name, there: bool| there.then_some(name);
        let by_points = [given("from", self.from.is_some()), given("to", self.to.is_some()), given("through", self.through.is_some())];
        let by_center =
            [given("center", self.center.is_some()), given("start", self.start.is_some()), given("angle", self.angle.is_some())];
        let (by_points, by_center): (Vec<_>, Vec<_>) =
            (by_points.into_iter().flatten().collect(), by_center.into_iter().flatten().collect());
        if let (Some(last), Some(first)) = (by_points.last(), by_center.first()) {
            return Err(Self::exclusive(vec![*last, *first]));
        }
        match self {
            Self { from: Some(a), to: Some(b), through: Some(p), .. } => Ok(build::arc_through(a.0, b.0, p.0, origin)?),
            Self { center: Some(c), start: Some(s), angle: Some(a), .. } => Ok(build::arc_center(c.0, s.0, a.0, normal, origin)?),
            Self { from: Some(_), to: Some(_), .. } => Err(Self::missing("a third point or a centre")),
            _ if by_center.is_empty() => Err(Self::missing("two ends and a point between them, or a centre, a start and an angle")),
            _ => Err(Self::missing("`center:`, `start:` and `angle:` together")),
        }
    }
}

/// What can be offset.
#[derive(Clone, Debug)]
pub enum CurveOrSurface {
    /// A plane curve.
    Curve(Chain),
    /// A surface.
    Surface(Surface),
}

impl FromValue for CurveOrSurface {
    const TY: Ty = Ty::OneOf(&[Ty::Curve, Ty::Surface]);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Curve(chain) => Some(Self::Curve(chain)),
            Value::Surface(surface) => Some(Self::Surface(surface)),
            _ => None,
        }
    }
}

/// A surface whose warnings say all there is to say.
pub(crate) fn with_notes(cx: &mut Cx, surface: Surface, notes: &[Fault]) -> Surface {
    notes.iter().for_each(|note| cx.say(note));
    surface
}

builtins! {
    /// Straight segment between two points.
    ///
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// ```
    fn line(
        /// Where it starts.
        from: Point,
        /// Where it ends.
        to: Point,
    ) -> Chain = |cx, from, to| Ok(whole(build::line(from.0, to.0, cx.origin())?));

    /// Straight segments through points.
    ///
    /// `round:` puts an arc of that radius in the place of every corner, in the plane of its two sides; a closed one then
    /// starts where the arc of its first corner ends. A radius that does not fit is E414, which states the largest one.
    /// ```loft
    /// curve border = polyline([(0, 0), (4m, 0), (4m, 3m)], closed: true)
    /// curve plate = polyline([(0, 0), (4m, 0), (4m, 3m), (0, 3m)], closed: true, round: 500mm)
    /// check plate.length == (10 + pi) * 1m within 1e-9
    /// ```
    fn polyline(
        /// Corners in order.
        points: Vec<Point>,
        /// Whether it returns to the first point.
        closed: bool = "false",
        /// Radius of the arcs at the corners, above 0.
        round: Option<Length>,
    ) -> Chain = |cx, list, closed, round| Ok(whole(match round {
        Some(radius) => fillet::rounded_polyline(&places(list), closed, (radius.0, "round"), cx.origin())?,
        None => build::polyline(&places(list), closed, cx.origin())?,
    }));

    /// Circular arc, through three points or about a centre.
    ///
    /// `arc(A, B, through: P)` runs from A over P to B; `arc(center:, start:, angle:, normal:)` turns counter-clockwise
    /// seen against the normal, clockwise when the angle is negative.
    /// ```loft
    /// curve a = arc((-2m, 0, 0), (2m, 0, 0), through: (0, 0, 1m))
    /// curve b = arc(center: (0, 0, 5m), start: (2m, 0, 5m), angle: 90deg)
    /// ```
    fn arc(
        /// Where it starts.
        from: Option<Point>,
        /// Where it ends.
        to: Option<Point>,
        /// A point between the ends.
        through: Option<Point>,
        /// Centre.
        center: Option<Point>,
        /// Where an arc about a centre starts.
        start: Option<Point>,
        /// How far it turns, at most 360deg.
        angle: Option<Angle>,
        /// Axis of the turn.
        normal: Direction = "(0, 0, 1)",
    ) -> Chain = |cx, from, to, through, center, start, angle, normal| {
        let normal = unit(normal.0, "normal")?;
        Ok(whole(ArcSaid { from, to, through, center, start, angle }.build(normal, cx.origin())?))
    };

    /// Whole circle about a centre.
    ///
    /// Without `start:` it begins on the model's x axis seen from the centre (on y where the normal is x).
    /// ```loft
    /// curve rim = circle(center: (0, 0, 1m), radius: 500mm)
    /// ```
    fn circle(
        /// Centre.
        center: Point,
        /// Radius.
        radius: Option<Length>,
        /// Where it begins, instead of a radius.
        start: Option<Point>,
        /// Axis of the circle.
        normal: Direction = "(0, 0, 1)",
    ) -> Chain = |cx, center, radius, start, normal| {
        let (normal, origin) = (unit(normal.0, "normal")?, cx.origin());
        Ok(whole(match (radius, start) {
            (Some(r), None) => build::circle(center.0, r.0, normal, origin)?,
            (None, Some(p)) => build::circle_start(center.0, p.0, normal, origin)?,
            (Some(_), Some(_)) => {
                let (what, arguments) = ("a radius or a start, not both", vec!["radius", "start"]);
                return Err(ValueFault::Exclusive { function: "circle", what, arguments, example: CIRCLE_EXAMPLE }.into());
            }
            (None, None) => {
                return Err(ValueFault::Missing { function: "circle", what: "a radius or a start", example: CIRCLE_EXAMPLE }.into());
            }
        }))
    };

    /// Ellipse, whole or a part of it.
    ///
    /// The angles are those of the parameter: a point lies at centre + major · cos + minor · sin.
    /// ```loft
    /// curve rim = ellipse(center: (0, 0, 0), major: (3m, 0, 0), minor: (0, 2m, 0))
    /// curve vault = ellipse(center: (0, 0, 0), major: (3m, 0, 0), minor: (0, 0, 1m), to: 180deg)
    /// ```
    fn ellipse(
        /// Centre.
        center: Point,
        /// One half axis, from the centre.
        major: Point,
        /// The other half axis, at right angles to the first.
        minor: Point,
        /// Where it begins, 0 at the end of `major`.
        from: Angle = "0deg",
        /// Where it ends, at most 360deg from there; less than `from` runs the other way.
        to: Angle = "360deg",
    ) -> Chain = |cx, center, major, minor, from, to| {
        Ok(whole(build::ellipse(center.0, major.0, minor.0, from.0, to.0 - from.0, cx.origin())?))
    };

    /// Conic section between two points with tangents towards an apex.
    ///
    /// `rho` below 0.5 gives an ellipse, 0.5 a parabola, above it a hyperbola.
    /// ```loft
    /// curve nose = conic((0, 0, 0), (1m, 2m, 0), (2m, 0, 0), rho: 0.6)
    /// ```
    fn conic(
        /// Where it starts.
        from: Point,
        /// Where the end tangents meet.
        apex: Point,
        /// Where it ends.
        to: Point,
        /// How far it is drawn to the apex, between 0 and 1.
        rho: f64,
    ) -> Chain = |cx, from, apex, to, rho| Ok(whole(build::conic(from.0, apex.0, to.0, rho, Kind::Conic, cx.origin())?));

    /// Parabola between two points with tangents towards an apex.
    ///
    /// ```loft
    /// curve cable = parabola((0, 0, 10m), (25m, 0, -2m), (50m, 0, 10m))
    /// ```
    fn parabola(
        /// Where it starts.
        from: Point,
        /// Where the end tangents meet.
        apex: Point,
        /// Where it ends.
        to: Point,
    ) -> Chain = |cx, from, apex, to| Ok(whole(build::conic(from.0, apex.0, to.0, 0.5, Kind::Parabola, cx.origin())?));
}
