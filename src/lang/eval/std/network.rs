//! Curves as a network: meetings, places along curves, nodes and links.

use glam::DVec3;

use crate::base::fault::{Say, ValueFault};
use crate::base::tolerance::WHOLE_NUMBER;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::kinds::{CurveOrSurface, LinkOf, Meeting, NetworkOf, ThingsOrCurve};
use crate::lang::values::conversions::{Length, NodePlace, Point, Rest, Station};
use crate::lang::values::value::{Dim, Quantity, Value};
use crate::network::{Chain, LinkId};
use crate::surface::data::bends;
use crate::surface::points::even_points::{MOST, even_points};
use crate::{builtins, fields};

/// Fraction of a curve at a fraction or length; both must lie on the curve.
pub(crate) fn fraction_of(cx: &Cx, chain: &Chain, station: Station, argument: &'static str) -> Result<f64, Halt> {
    let (fraction, found) = match station {
        Station::Fraction(f) => (f, format!("{}%", shown(f * 100.0))),
        Station::Length(s) => (s / chain.length(), format!("{}{}", shown(s), cx.unit().name)),
    };
    if (-WHOLE_NUMBER..=1.0 + WHOLE_NUMBER).contains(&fraction) {
        return Ok(fraction.clamp(0.0, 1.0));
    }
    let range = format!("between 0% and 100%, or 0 and the curve's length of {}{}", shown(chain.length()), cx.unit().name);
    Err(ValueFault::OutsideRange { argument, found, range }.into())
}

/// A number with at most six digits after the point.
fn shown(x: f64) -> String {
    let text = format!("{x:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The links a curve runs over, in its direction.
fn links(cx: &mut Cx, chain: &Chain) -> Result<Vec<(LinkId, bool)>, Halt> {
    let module = cx.module();
    let tolerance = cx.tolerance()?;
    let graph = cx.network(module)?;
    graph.links_of(chain, &tolerance).ok_or_else(|| ValueFault::NoLinks { of: chain.origin() }.into())
}

fn nodes(cx: &mut Cx, chain: &Chain) -> Result<Vec<DVec3>, Halt> {
    let links = links(cx, chain)?;
    let module = cx.module();
    let graph = cx.network(module)?;
    let ends = |(link, against): (LinkId, bool)| {
        let (a, b) = graph.links[link.index()].nodes;
        if against { (b, a) } else { (a, b) }
    };
    let first = links.first().map(|l| ends(*l).0);
    let all = first.into_iter().chain(links.iter().map(|l| ends(*l).1));
    Ok(all.map(|node| graph.nodes[node.index()].point).collect())
}

builtins! {
    /// All places where curves and surfaces meet, or all curves in which surfaces do.
    ///
    /// Places come in order along the curve, of two curves the first; curves by their first points. A run that both share
    /// gives its two ends. `a & b` is the one place or curve in which they meet. A plane without end, a trimmed
    /// surface and a shell are surfaces here.
    /// ```loft
    /// curve a = circle(center: (0, 0, 0), radius: 1m)
    /// curve b = line((-2m, 0, 0), (2m, 0, 0))
    /// let n = len(meet(a, b)) // => 2
    /// surface wall = extrude(a, by: (0, 0, 3m))
    /// let p = meet(line((0, 0, 1m), (2m, 0, 1m)), wall) // => [(1000mm, 0mm, 1000mm)]
    /// curve hoop = wall & plane(at: (0, 0, 1m), normal: (0, 0, 1))
    /// ```
    fn meet(
        /// A curve, a surface, a shell or a plane.
        a: Meeting,
        /// Another.
        b: Meeting,
    ) -> Vec<Value> = |cx, a, b| crate::lang::eval::meetings::meet_all(cx, &a, &b);

    /// The nearest of several things, or the nearest point of one curve.
    ///
    /// Of a list of points, curves or surfaces it gives the member, of two equally near the first.
    /// ```loft
    /// curve a = circle(center: (0, 0, 0), radius: 1m)
    /// curve b = line((-2m, 0, 0), (2m, 0, 0))
    /// let east = nearest(meet(a, b), (1m, 0, 0))
    /// let top = nearest(a, (0, 3m, 0)) // => (0mm, 1000mm, 0mm)
    /// let far = nearest([a, b], (0, 3m, 0)).closed // => true
    /// ```
    fn nearest(
        /// Points, nodes, curves or surfaces to choose from, or one curve.
        of: ThingsOrCurve,
        /// Where it should be near.
        to: Point,
    ) -> Value = |cx, of, to| match of {
        ThingsOrCurve::Curve(chain) => Ok(Value::point(chain.closest(to.0).1)),
        ThingsOrCurve::Things(values) => {
            let mut best: Option<(f64, Value)> = None;
            for value in values {
                let distance = match &value {
                    Value::Node(p) | Value::Vector(p, _) => p.distance(to.0),
                    Value::Curve(chain) => chain.closest(to.0).2,
                    Value::Surface(surface) => cx.machine.feet.of(surface).at(to.0).distance,
                    _ => continue,
                };
                if best.as_ref().is_none_or(|(least, _)| distance < *least) {
                    best = Some((distance, value));
                }
            }
            let empty = || ValueFault::OutsideRange { argument: "of", found: "an empty list".to_owned(), range: "at least one thing".to_owned() };
            best.map(|(_, value)| value).ok_or_else(|| empty().into())
        }
    };

    /// The point at a place along a curve, or at u and v of a surface.
    ///
    /// On a curve the place is a fraction of its length or a length from its start.
    /// ```loft
    /// curve c = line((0, 0, 0), (4m, 0, 0))
    /// point a = c.at(25%)
    /// point b = at(c, 1200mm)
    /// surface s = extrude(c, by: (0, 0, 1m))
    /// point p = s.at(0.5, 0.5)
    /// ```
    fn at(
        /// A curve or a surface.
        of: CurveOrSurface,
        /// Fraction or length along the curve; u of the surface.
        at: Station,
        /// v of the surface.
        v: Option<f64>,
    ) -> Point = |cx, of, at, v| match (of, at, v) {
        (CurveOrSurface::Curve(chain), at, None) => Ok(Point(chain.point(fraction_of(cx, &chain, at, "at")?))),
        (CurveOrSurface::Surface(surface), Station::Fraction(u), Some(v)) => {
            let (u, v) = crate::lang::eval::std::surfaces::checked_uv(&surface, (u, "at"), (v, "v"))?;
            Ok(Point(surface.point(u, v)))
        }
        (CurveOrSurface::Curve(_), ..) => {
            Err(ValueFault::Missing { function: "at", what: "one place along a curve, not two", example: "south.at(30%)" }.into())
        }
        (CurveOrSurface::Surface(_), ..) => {
            Err(ValueFault::Missing { function: "at", what: "u and v of a surface, two numbers", example: "roof.at(0.5, 0.5)" }.into())
        }
    };

    /// Equally spaced points along a curve, both ends included.
    ///
    /// ```loft
    /// curve c = line((0, 0, 0), (4m, 0, 0))
    /// let stations = c.points(5)
    /// ```
    fn points(
        /// A curve.
        of: Chain,
        /// How many, at least 2.
        count: usize,
    ) -> Vec<Point> = |cx, of, count| {
        if count < 2 {
            let range = "at least 2".to_owned();
            return Err(ValueFault::OutsideRange { argument: "count", found: count.to_string(), range }.into());
        }
        cx.room(count)?;
        Ok((0..count).map(|k| Point(of.point(k as f64 / (count - 1) as f64))).collect())
    };

    /// Points at even arc lengths on curves: as many on each, as few as do.
    ///
    /// They are the fewest with which the cubic spline through the points of each curve, `spline(points, start: bessel, end: bessel)`,
    /// is within `within:` of it, looked at in three places of each span. Kinks are among the points; there one spline ends and the
    /// next begins. Opposite borders of a region get the same number so. If 2000 are too few that is E654.
    /// ```loft
    /// curve a = arc((0, 0), (4m, 0), through: (2m, 2m))
    /// curve b = line((0, 3m), (4m, 3m))
    /// let both = even_points(a, b, within: 0.1mm)
    /// check len(both[0]) == len(both[1])
    /// check distance(a.at(3%), spline(both[0], start: bessel, end: bessel)) <= 0.1mm
    /// ```
    fn even_points(
        /// One or more curves.
        curves: Rest<Chain>,
        /// How far the splines may be from the curves, above 0.
        within: Length,
        /// How many points at least, 2 to 2000.
        least: usize = "2",
    ) -> Vec<Vec<Point>> = |cx, curves, within, least| {
        if within.0 <= 0.0 || !within.0.is_finite() {
            let (found, range) = (cx.length(within.0), "above 0".to_owned());
            return Err(ValueFault::OutsideRange { argument: "within", found, range }.into());
        }
        if !(2..=MOST).contains(&least) {
            let range = format!("2 to {MOST}");
            return Err(ValueFault::OutsideRange { argument: "least", found: least.to_string(), range }.into());
        }
        let tolerance = cx.tolerance()?;
        cx.room(curves.0.len().saturating_mul(MOST))?;
        let found = even_points(&curves.0, within.0, least, &tolerance)?;
        Ok(found.into_iter().map(|row| row.into_iter().map(Point).collect()).collect())
    };
}

fields! {
    /// First point of a curve.
    fn start(of: Chain) -> NodePlace = |_, of| Ok(NodePlace(of.start()));
    /// Last point of a curve.
    fn end(of: Chain) -> NodePlace = |_, of| Ok(NodePlace(of.end()));
    /// The point halfway along a curve.
    fn mid(of: Chain) -> Point = |_, of| Ok(Point(of.point(0.5)));
    /// Arc length of a curve.
    fn length(of: Chain) -> Length = |_, of| Ok(Length(of.length()));
    /// Whether a curve ends where it starts.
    fn closed(of: Chain) -> bool = |cx, of| Ok(of.is_closed(&cx.tolerance()?));
    /// The points where a curve changes direction suddenly.
    fn kinks(of: Chain) -> Vec<Point> = |cx, of| {
        Ok(of.kinks(&cx.tolerance()?).into_iter().map(|f| Point(of.point(f))).collect())
    };
    /// The points where a curve begins to bend the other way; corners are none.
    fn inflections(of: Chain) -> Vec<Point> = |_, of| Ok(bends::inflections(&of).into_iter().map(|f| Point(of.point(f))).collect());
    /// The integral of the squared curvature of a curve along it, 1/length.
    ///
    /// It tells how much the curve bends; corners are left out.
    fn bending(of: Chain) -> Quantity = |_, of| Ok(Quantity::new(bends::bending(&of), Dim::CURVATURE));
    /// The links of the network that a curve runs over, in its direction.
    fn links(of: Chain) -> Vec<LinkOf> = |cx, of| {
        let module = cx.module();
        Ok(links(cx, &of)?.into_iter().map(|(link, _)| LinkOf(module, link)).collect())
    };
    /// The nodes of the network along a curve.
    fn nodes(of: Chain) -> Vec<NodePlace> = |cx, of| Ok(nodes(cx, &of)?.into_iter().map(NodePlace).collect());
    /// All nodes of the network.
    fn nodes(of: NetworkOf) -> Vec<NodePlace> = |cx, of| Ok(cx.network(of.0)?.nodes.iter().map(|n| NodePlace(n.point)).collect());
    /// All links of the network.
    fn links(of: NetworkOf) -> Vec<LinkOf> = |cx, of| {
        Ok((0..cx.network(of.0)?.links.len()).map(|i| LinkOf(of.0, LinkId::at(i))).collect())
    };
    /// All curves of the network.
    fn curves(of: NetworkOf) -> Vec<Chain> = |cx, of| Ok(cx.network(of.0)?.curves.iter().map(|c| Chain::of_curve(&c.curve)).collect());
}
