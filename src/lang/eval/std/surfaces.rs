//! Constructors of surfaces.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::{Fault, ValueFault};
use crate::base::tolerance::Tolerance;
use crate::builtins;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::unit;
use crate::lang::eval::std::kinds::{Cutter, Trimmed};
use crate::lang::eval::std::transforms::axis_line;
use crate::lang::values::types::{Angle, Axis, Direction, Length, Point, Rest};
use crate::lang::values::value::{Plane, Value};
use crate::model::measure;
use crate::network::{self, Chain, ChainFlow, FlowKind};
use crate::surface::blended::coons::{self, Grid, Method, Settings};
use crate::surface::blended::plane_face;
use crate::surface::core::plane;
use crate::surface::faults::{LoopFault, SurfaceFault};
use crate::surface::intersect::self_intersection::crossing;
use crate::surface::points::control_net::{self, Net};
use crate::surface::points::interpolate;
use crate::surface::swept::{extrude, revolve};
use crate::surface::{Domain, Reparam, Surface, Way, carried, ruled as surface_between};

/// Checks that (u, v) lies in the surface's domain; each with the name of its argument.
pub(crate) fn checked_uv(surface: &Surface, u: (f64, &'static str), v: (f64, &'static str)) -> Result<(f64, f64), Halt> {
    for (value, argument) in [u, v] {
        if !(0.0..=1.0).contains(&value) {
            let (found, range) = (value.to_string(), "between 0 and 1".to_owned());
            return Err(ValueFault::OutsideRange { argument, found, range }.into());
        }
    }
    if surface.domain() == Domain::Triangle && u.0 + v.0 > 1.0 {
        let (found, range) = (v.0.to_string(), "at most 1 less u on a surface of three sides".to_owned());
        return Err(ValueFault::OutsideRange { argument: v.1, found, range }.into());
    }
    Ok((u.0, v.0))
}

crate::choices! {
    /// How curves are matched between their meetings.
    pub enum ReparamWord {
        /// Smoothly, so that the surface is C1 across its curves.
        Smooth = "smooth",
        /// Piecewise linear, as first published; the surface is C0 across its curves.
        Linear = "linear",
    }
}

crate::choices! {
    /// How neighbouring curves of a grid are blended.
    pub enum BlendWord {
        /// Linearly inside one loop, cubically where inner curves make several cells.
        Auto = "auto",
        /// Linearly between neighbours; across inner curves the surface has a kink.
        Linear = "linear",
        /// Cubically between neighbours, so that the surface is C1 across inner curves.
        Cubic = "cubic",
    }
}

/// Curves as a builtin gets them: those in a row, and those said to run along u and v.
struct Curves {
    row: Rest<Chain>,
    u: Option<Vec<Chain>>,
    v: Option<Vec<Chain>>,
}

impl Curves {
    /// E663 for a curve that stands twice in one of the lists.
    fn each_once(&self, tolerance: &Tolerance) -> Result<(), Halt> {
        let lists = [("curves", Some(&self.row.0)), ("u", self.u.as_ref()), ("v", self.v.as_ref())];
        for (argument, list) in lists {
            let Some(list) = list else { continue };
            if let Some(places) = network::given_twice(list, tolerance) {
                return Err(LoopFault::Twice { of: list[places.1].origin(), argument, places, hole: None }.into());
            }
        }
        Ok(())
    }

    /// All curves in order of writing, each once, and the places of those along u and v.
    fn listed(self) -> (Vec<Chain>, Vec<usize>, Vec<usize>) {
        let mut all = self.row.0;
        let mut place = |chain: Chain| {
            all.iter().position(|c| same(c, &chain)).unwrap_or_else(|| {
                all.push(chain);
                all.len() - 1
            })
        };
        let along_u = self.u.unwrap_or_default().into_iter().map(&mut place).collect();
        let along_v = self.v.unwrap_or_default().into_iter().map(&mut place).collect();
        (all, along_u, along_v)
    }
}

/// Whether two values are the same run of curves in the same direction.
fn same(a: &Chain, b: &Chain) -> bool {
    let run = |x: &network::Run, y: &network::Run| x.s0 == y.s0 && x.s1 == y.s1 && network::chain::same_curve(&x.curve, &y.curve);
    a.runs().len() == b.runs().len() && a.runs().iter().zip(b.runs()).all(|(x, y)| run(x, y))
}

/// What decides a flow beside the curves.
struct Said {
    pole: Option<Point>,
    closed: bool,
    reparam: ReparamWord,
    method: Method,
}

/// A surface over a grid of curves, its flow found.
fn over_grid(cx: &mut Cx, curves: Curves, said: &Said) -> Result<Surface, Halt> {
    let tolerance = cx.tolerance()?;
    curves.each_once(&tolerance)?;
    let (chains, along_u, along_v) = curves.listed();
    let options = ChainFlow { along_u, along_v, pole: said.pole.map(|p| p.0), closed: said.closed };
    let (flow, nodes) = network::of_chains(&chains, &options, &tolerance)?;
    let blend = match said.method {
        Method::Linear => Some("linear"),
        Method::Cubic => Some("cubic"),
        Method::Coons | Method::Lagrange | Method::Gordon => None,
    };
    if let Some(word) = blend.filter(|_| flow.kind == FlowKind::UniformTrilateral) {
        let range = "auto where three curves have no pole: they are blended in one way".to_owned();
        return Err(ValueFault::OutsideRange { argument: "blend", found: word.to_owned(), range }.into());
    }
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    let reparam = match said.reparam {
        ReparamWord::Smooth => Reparam::Smooth,
        ReparamWord::Linear => Reparam::Linear,
    };
    let settings = Settings { method: said.method, reparam, origin: cx.origin() };
    let (surface, notes) = coons::build(&Grid { chains: &chains, flow: &flow, poles }, &settings, &tolerance)?;
    finished(cx, surface, &notes)
}

/// Says the notes of a surface and what a look at it finds.
pub(crate) fn finished(cx: &mut Cx, surface: Surface, notes: &[Fault]) -> Result<Surface, Halt> {
    notes.iter().for_each(|note| cx.say(note));
    let tolerance = cx.tolerance()?;
    let found = surface.validate(&tolerance);
    found.iter().for_each(|warning| cx.say(warning));
    tell_crossing(cx, &[notes, &found].concat(), std::slice::from_ref(&surface), &tolerance);
    Ok(surface)
}

/// W669 where faces made together cross themselves or each other; nothing where it is said already that they fold over.
pub(crate) fn tell_crossing(cx: &mut Cx, said: &[Fault], faces: &[Surface], tolerance: &Tolerance) {
    const FOLDS: [&str; 4] = ["W606", "W607", "W639", "W664"];
    if said.iter().any(|fault| FOLDS.contains(&fault.code().0)) {
        return;
    }
    if let Some(found) = crossing(faces, tolerance) {
        let uv = (found.faces.0 == found.faces.1).then_some(found.uv);
        let surface = cx.origin();
        cx.say(&SurfaceFault::CrossesItself { surface, uv, at: found.at }.into());
    }
}

/// Where a part of a surface stands among others: its centre in whole tolerances, which rounding does not change, and its area.
fn by_centre(part: Surface, tolerance: &Tolerance) -> ([i64; 3], f64, Surface) {
    // Centres often lie on round numbers: the steps between whole tolerances do not.
    const OFF: f64 = 0.37;
    let sheet = measure::sheet(std::slice::from_ref(&part));
    let whole = |x: f64| (x / tolerance.point + OFF).floor() as i64;
    (sheet.centroid.to_array().map(whole), sheet.area, part)
}

pub(crate) fn rows(net: Vec<Vec<Point>>) -> Vec<Vec<DVec3>> {
    net.into_iter().map(|row| row.into_iter().map(|p| p.0).collect()).collect()
}

const TRIM_EXAMPLE: &str = "trim(s, by: [c], keep: P)";
const PLANE_EXAMPLE: &str = "plane(a, b, c), or plane(at: P, normal: (0, 0, 1))";

builtins! {
    /// Coons surface through a closed loop or a grid of curves.
    ///
    /// Curves come in any order and direction: what they span is found from the nodes they share. The surface
    /// contains every curve. The first curve written runs along u. Inside one loop curves are blended linearly (four
    /// straight lines give the hyperbolic paraboloid); where inner curves make several cells the blend is cubic, and
    /// the surface is C1 across them.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// curve north = arc((0, 3m, 0), (4m, 3m, 0), through: (2m, 3m, 1m))
    /// curve west = line(south.start, north.start)
    /// curve east = line(south.end, north.end)
    /// surface roof = coons(south, east, north, west)
    /// ```
    fn coons(
        /// Boundary curves and inner curves.
        curves: Rest<Chain>,
        /// Those that run along u, where the curves alone do not decide.
        u: Option<Vec<Chain>>,
        /// Those that run along v.
        v: Option<Vec<Chain>>,
        /// The point to which a side shrinks, where the curves alone do not decide.
        pole: Option<Point>,
        /// Whether the surface closes in u, where the curves alone do not decide.
        closed: bool = "false",
        /// How curves are matched between their meetings.
        reparam: ReparamWord = "smooth",
        /// How neighbouring curves are blended: `auto` is `linear` for one cell and `cubic` for several; three curves without a
        /// pole are blended in one way, `auto`.
        blend: BlendWord = "auto",
    ) -> Surface = |cx, row, u, v, pole, closed, reparam, blend| {
        let method = match blend {
            BlendWord::Auto => Method::Coons,
            BlendWord::Linear => Method::Linear,
            BlendWord::Cubic => Method::Cubic,
        };
        over_grid(cx, Curves { row, u, v }, &Said { pole, closed, reparam, method })
    };

    /// Transfinite surface through a grid of curves: one blend over the whole grid.
    ///
    /// With more than three curves one way it may oscillate between them; `coons` does not.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// curve north = line((0, 3m, 1m), (4m, 3m, 0))
    /// curve west = line(south.start, north.start)
    /// curve middle = line(south.at(50%), north.at(50%))
    /// curve east = line(south.end, north.end)
    /// surface roof = transfinite(u: [south, north], v: [west, middle, east])
    /// ```
    fn transfinite(
        /// Boundary curves and inner curves.
        curves: Rest<Chain>,
        /// Those that run along u, where the curves alone do not decide.
        u: Option<Vec<Chain>>,
        /// Those that run along v.
        v: Option<Vec<Chain>>,
        /// The point to which a side shrinks, where the curves alone do not decide.
        pole: Option<Point>,
        /// Whether the surface closes in u, where the curves alone do not decide.
        closed: bool = "false",
        /// How curves are matched between their meetings.
        reparam: ReparamWord = "smooth",
    ) -> Surface = |cx, row, u, v, pole, closed, reparam| {
        over_grid(cx, Curves { row, u, v }, &Said { pole, closed, reparam, method: Method::Lagrange })
    };

    /// Surface of straight lines between two curves.
    ///
    /// The second curve is read backwards where that keeps the lines from crossing.
    /// ```loft
    /// curve low = line((0, 0, 0), (4m, 0, 0))
    /// curve high = arc((0, 2m, 1m), (4m, 2m, 1m), through: (2m, 2m, 2m))
    /// surface ramp = ruled(low, high)
    /// ```
    fn ruled(
        /// v = 0; its direction is +u.
        a: Chain,
        /// v = 1.
        b: Chain,
    ) -> Surface = |cx, a, b| {
        let tolerance = cx.tolerance()?;
        let (surface, notes) = surface_between(&a, &b, cx.origin(), &tolerance)?;
        finished(cx, surface, &notes)
    };

    /// Flat face inside curves that close, or the unbounded plane through a point.
    ///
    /// Curves come in any order and direction; the first one runs along u.
    /// ```loft
    /// curve rim = circle(center: (0, 0, 0), radius: 1m)
    /// surface lid = plane(rim)
    /// let cut = plane(at: (0, 0, 500mm), normal: (0, 0, 1))
    /// ```
    fn plane(
        /// Curves around the face.
        curves: Rest<Chain>,
        /// A point of the unbounded plane.
        at: Option<Point>,
        /// Its normal.
        normal: Option<Direction>,
    ) -> Value = |cx, curves, at, normal| match (curves.0.is_empty(), at, normal) {
        (true, Some(at), Some(normal)) => Ok(Value::Plane(Arc::new(Plane { at: at.0, normal: unit(normal.0, "normal")? }))),
        (false, None, None) => {
            let tolerance = cx.tolerance()?;
            let (surface, notes) = plane_face::bounded(&curves.0, cx.origin(), &tolerance)?;
            finished(cx, surface, &notes).map(Value::Surface)
        }
        (false, at, _) => {
            let arguments = vec!["curves", if at.is_some() { "at" } else { "normal" }];
            let what = "curves around a face, or a point and a normal, not both";
            Err(ValueFault::Exclusive { function: "plane", what, arguments, example: PLANE_EXAMPLE }.into())
        }
        _ => {
            let what = "curves around a face, or a point and a normal";
            Err(ValueFault::Missing { function: "plane", what, example: PLANE_EXAMPLE }.into())
        }
    };

    /// A curve projected to a surface: to the nearest points, or along a direction.
    ///
    /// It is a cubic within a quarter of the tolerance, lies on the surface and may trim it.
    /// ```loft
    /// curve south = arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 1m))
    /// surface roof = extrude(south, by: (0, 9m, 0))
    /// curve eye = project(circle(center: (2m, 4m, 3m), radius: 800mm), onto: roof, along: (0, 0, 1))
    /// surface open = trim(roof, holes: [eye])
    /// ```
    fn project(
        /// The curve.
        curve: Chain,
        /// The surface.
        onto: Surface,
        /// A direction, either way; to the nearest points when left out.
        along: Option<Direction>,
    ) -> Chain = |cx, curve, onto, along| {
        let tolerance = cx.tolerance()?;
        let way = match along {
            Some(along) => Way::Along(unit(along.0, "along")?),
            None => Way::Nearest,
        };
        Ok(Chain::of_curve(&carried(&onto, &curve, way, cx.origin(), &tolerance)?))
    };

    /// The part of a surface inside a loop of curves, outside others, or cut off.
    ///
    /// Curves of a loop come in any order and direction and must lie on the surface within the tolerance. Without `outer:`
    /// the surface's own border is the outer loop. `by:` takes curves on the surface, or surfaces that it meets, which
    /// divide it from border to border or in closed loops; the part with the point `keep:` stays (`split` has all of them).
    /// Holes lie apart from each other and inside the outer loop, or touch in one point; those that the surface has stay.
    /// ```loft
    /// curve rim = circle(center: (0, 0, 0), radius: 1m)
    /// curve eye = circle(center: (300mm, 0, 0), radius: 200mm)
    /// surface lid = trim(plane(rim), holes: [eye])
    /// surface ring = trim(plane(at: (0, 0, 0), normal: (0, 0, 1)), outer: rim, holes: [eye])
    /// surface half = trim(lid, by: plane(at: (0, 0, 0), normal: (1, 0, 0)), keep: (-500mm, 0, 0))
    /// ```
    fn trim(
        /// The surface that is trimmed; of an unbounded plane, the part inside `outer:`.
        s: Trimmed,
        /// Curves of the outer loop.
        outer: Option<Vec<Chain>>,
        /// Curves of the holes: a closed one is a hole, others are put together where they close.
        holes: Option<Vec<Chain>>,
        /// Curves, surfaces, shells or planes that cut.
        by: Option<Vec<Cutter>>,
        /// A point of the part that stays.
        keep: Option<Point>,
        /// Whether x and y of the curves of loops are u and v of the surface; of an unbounded plane, lengths from its point.
        uv: bool = "false",
    ) -> Surface = |cx, s, outer, holes, by, keep, uv| {
        let tolerance = cx.tolerance()?;
        let s = match s {
            Trimmed::Surface(s) => s,
            Trimmed::Plane(_) if outer.is_none() => {
                let what = "an outer loop: the plane has no border of its own";
                return Err(ValueFault::Missing { function: "trim", what, example: "trim(s, outer: c)" }.into());
            }
            Trimmed::Plane(p) => plane::unbounded(p.at, p.normal, cx.origin())?,
        };
        let mut outer = outer.unwrap_or_default();
        let mut holes = network::rings(&holes.unwrap_or_default(), &tolerance);
        if uv {
            for chain in outer.iter_mut().chain(holes.iter_mut().flatten()) {
                *chain = Chain::of_curve(&carried(&s, chain, Way::Parameters, chain.origin(), &tolerance)?);
            }
        }
        let (by, keep) = match (by, keep) {
            (None, None) => {
                let surface = crate::surface::trim(&s, &outer, &holes, cx.origin(), &tolerance)?;
                return finished(cx, surface.cut_from(&[s]), &[]);
            }
            (Some(by), Some(keep)) => (by, keep),
            (Some(_), None) => return Err(ValueFault::Missing { function: "trim", what: "a point of the part to keep", example: TRIM_EXAMPLE }.into()),
            (None, Some(_)) => return Err(ValueFault::Missing { function: "trim", what: "what cuts", example: TRIM_EXAMPLE }.into()),
        };
        let loops = !(outer.is_empty() && holes.is_empty());
        let whole = if loops { crate::surface::trim(&s, &outer, &holes, s.origin(), &tolerance)? } else { s.clone() };
        let cutters = crate::lang::eval::meetings::cutters(cx, &whole, by)?;
        let surface = crate::surface::divide(&whole, &cutters, keep.0, cx.origin(), &tolerance)?;
        let parts = crate::surface::split(&whole, &cutters, cx.origin(), &tolerance)?;
        measure::adds_up(&whole, &cutters, &measure::areas(&parts), &tolerance)?;
        finished(cx, surface.cut_from(&[s]), &[])
    };

    /// All parts into which curves or surfaces divide a surface.
    ///
    /// They are the parts of which `trim(s, by:, keep:)` keeps one, in the order of their centres along x, then y, then z,
    /// whatever the order of the cutters; their areas add up to that of the surface. In a mesh of the parts a group of the surface,
    /// and a rule on it, applies to all of them; on a part it applies to that part alone. Without a declaration of its own a part is called by its
    /// place in its list, as `rooms[0]`, in reports and as a set in files.
    /// ```loft
    /// surface floor = plane(circle(center: (0, 0, 0), radius: 1m))
    /// curve wall = line((-1m, 0, 0), (1m, 0, 0))
    /// let rooms = split(floor, by: wall)
    /// let n = len(rooms) // => 2
    /// surface south = rooms[0]
    /// ```
    fn split(
        /// The surface that is divided.
        s: Surface,
        /// A curve, surface, shell or plane that cuts, or a list of them.
        by: Vec<Cutter>,
    ) -> Vec<Surface> = |cx, s, by| {
        let tolerance = cx.tolerance()?;
        let cutters = crate::lang::eval::meetings::cutters(cx, &s, by)?;
        let parts = crate::surface::split(&s, &cutters, cx.origin(), &tolerance)?;
        let mut keyed: Vec<([i64; 3], f64, Surface)> = parts.into_iter().map(|part| by_centre(part, &tolerance)).collect();
        measure::adds_up(&s, &cutters, &keyed.iter().map(|part| part.1).collect::<Vec<_>>(), &tolerance)?;
        keyed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        keyed.into_iter().map(|(_, _, part)| finished(cx, part, &[])).collect()
    };

    /// Surface swept by a curve along a straight line.
    ///
    /// u runs along the sweep, v along the profile.
    /// ```loft
    /// curve foot = arc((0, 0, 0), (4m, 0, 0), through: (2m, 1m, 0))
    /// surface wall = extrude(foot, by: (0, 0, 3m))
    /// ```
    fn extrude(
        /// The curve that is moved.
        profile: Chain,
        /// How far and which way.
        by: Point,
    ) -> Surface = |cx, profile, by| {
        let tolerance = cx.tolerance()?;
        let surface = extrude::extrude(&profile, by.0, cx.origin(), &tolerance)?;
        finished(cx, surface, &[])
    };

    /// Surface swept by a curve about an axis.
    ///
    /// u runs with the turn, v along the profile; ends of the profile on the axis are poles.
    /// ```loft
    /// curve profile = arc((0, 0, -1m), (0, 0, 1m), through: (1m, 0, 0))
    /// surface ball = revolve(profile)
    /// ```
    fn revolve(
        /// The curve that is turned.
        profile: Chain,
        /// Direction of the axis, or a straight curve.
        axis: Axis = "(0, 0, 1)",
        /// How far it is turned, at most 360deg either way.
        angle: Angle = "360deg",
        /// A point of the axis; the origin, or the curve's start.
        about: Option<Point>,
    ) -> Surface = |cx, profile, axis, angle, about| {
        let tolerance = cx.tolerance()?;
        let (direction, start) = axis_line(cx, &axis)?;
        let about = about.map(|p| p.0).or(start).unwrap_or(DVec3::ZERO);
        let surface = revolve::revolve(&profile, &revolve::Axis { about, direction }, angle.0, cx.origin(), &tolerance)?;
        finished(cx, surface, &[])
    };

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
        finished(cx, surface, &[])
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
        finished(cx, surface, &[])
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
        finished(cx, surface, &[])
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
        finished(cx, surface, &notes)
    };
}
