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
use crate::lang::values::conversions::{Angle, Axis, Direction, Point, Rest};
use crate::lang::values::value::{Plane, Value};
use crate::model::measure;
use crate::network::{self, Chain};
use crate::surface::blended::plane_face;
use crate::surface::core::plane;
use crate::surface::faults::SurfaceFault;
use crate::surface::intersect::line_crossing::any_crossing;
use crate::surface::swept::{extrude, revolve};
use crate::surface::{Domain, Surface, Way, project, ruled as surface_between, ruled_as_drawn};

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

/// Reports the notes and what `validate` finds.
pub(crate) fn reported(cx: &mut Cx, surface: Surface, notes: &[Fault]) -> Result<Surface, Halt> {
    notes.iter().for_each(|note| cx.say(note));
    let tolerance = cx.tolerance()?;
    let found = surface.validate(&tolerance);
    found.iter().for_each(|warning| cx.say(warning));
    note_crossing(cx, &[notes, &found].concat(), std::slice::from_ref(&surface), &tolerance);
    Ok(surface)
}

/// W669 where faces made together cross themselves or each other; nothing where it is said already that they fold over.
pub(crate) fn note_crossing(cx: &mut Cx, said: &[Fault], faces: &[Surface], tolerance: &Tolerance) {
    const FOLDS: [&str; 4] = ["W606", "W607", "W639", "W664"];
    if said.iter().any(|fault| FOLDS.contains(&fault.code().0)) {
        return;
    }
    if let Some(found) = any_crossing(faces, tolerance) {
        let uv = (found.faces.0 == found.faces.1).then_some(found.uv);
        let surface = cx.origin();
        cx.say(&SurfaceFault::CrossesItself { surface, uv, at: found.at }.into());
    }
}

/// Where a part of a surface stands among others: its centre in whole tolerances, which rounding does not change, and its area with the
/// error of that.
fn by_centre(part: Surface, tolerance: &Tolerance) -> ([i64; 3], (f64, f64), Surface) {
    // An offset, so that rounding does not decide for centres at round numbers.
    const OFF: f64 = 0.37;
    let sheet = measure::sheet(std::slice::from_ref(&part));
    let whole = |x: f64| (x / tolerance.point + OFF).floor() as i64;
    (sheet.centroid.to_array().map(whole), (sheet.area, sheet.error * sheet.area), part)
}

pub(crate) fn rows(net: Vec<Vec<Point>>) -> Vec<Vec<DVec3>> {
    net.into_iter().map(|row| row.into_iter().map(|p| p.0).collect()).collect()
}

const TRIM_EXAMPLE: &str = "trim(s, by: [c], keep: P)";
const PLANE_EXAMPLE: &str = "plane(a, b, c), or plane(at: P, normal: (0, 0, 1))";

builtins! {
    /// Surface of straight lines between two curves.
    ///
    /// The second curve is read backwards where that keeps the lines from crossing, a closed one from the start from which they twist
    /// least. Lines join equal shares of the lengths; corners go to corners where both have equally many.
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
        /// Whether lines join equal shares of the lengths from where the curves start: for a twist that is meant.
        as_drawn: bool = "false",
    ) -> Surface = |cx, a, b, as_drawn| {
        let tolerance = cx.tolerance()?;
        let between = if as_drawn { ruled_as_drawn } else { surface_between };
        let (surface, notes) = between(&a, &b, cx.origin(), &tolerance)?;
        reported(cx, surface, &notes)
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
            reported(cx, surface, &notes).map(Value::Surface)
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
        Ok(Chain::of_curve(&project(&onto, &curve, way, cx.origin(), &tolerance)?))
    };

    /// The part of a surface inside a loop of curves, outside others, or cut off.
    ///
    /// Curves of a loop come in any order and direction and must lie on the surface within the tolerance. Without `outer:`
    /// the surface's own border is the outer loop. `by:` takes curves on the surface, or surfaces that it meets, which
    /// divide it from border to border or in closed loops; the part with the point `keep:` stays, or the only part near it (`split` has all of them).
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
                *chain = Chain::of_curve(&project(&s, chain, Way::Parameters, chain.origin(), &tolerance)?);
            }
        }
        let (by, keep) = match (by, keep) {
            (None, None) => {
                let surface = crate::surface::trim(&s, &outer, &holes, cx.origin(), &tolerance)?;
                return reported(cx, surface.cut_from(&[s]), &[]);
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
        measure::adds_up(&whole, &cutters, &measure::areas_within(&parts), &tolerance)?;
        reported(cx, surface.cut_from(&[s]), &[])
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
        let mut keyed: Vec<([i64; 3], (f64, f64), Surface)> = parts.into_iter().map(|part| by_centre(part, &tolerance)).collect();
        measure::adds_up(&s, &cutters, &keyed.iter().map(|part| part.1).collect::<Vec<_>>(), &tolerance)?;
        keyed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.0.total_cmp(&b.1.0)));
        keyed.into_iter().map(|(_, _, part)| reported(cx, part, &[])).collect()
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
        reported(cx, surface, &[])
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
        reported(cx, surface, &[])
    };
}
