//! Sweeps: a profile along a path, sections along guides.

use crate::base::fault::Say;
use crate::base::fault::ValueFault;
use crate::builtins;
use crate::lang::eval::std::surfaces::reported;
use crate::lang::eval::std::transforms::axis_line;
use crate::lang::values::conversions::{Angle, Axis, Length, Point};
use crate::lang::values::value::Value;
use crate::network::Chain;
use crate::surface::Surface;
use crate::surface::analysis::fairness::StationFairness;
use crate::surface::intersect::line_crossing::any_crossing;
use crate::surface::swept::along::{AlongSettings, along as carried_along};
use crate::surface::swept::laws::Law;
use crate::surface::swept::revolve;
use crate::surface::swept::sweep::sweep as swept;
use crate::surface::swept::sweep_input::{Input, NetMethod};

crate::choices! {
    /// What a profile does at a corner of its path.
    pub enum CornerWord {
        /// It is cut by the plane that bisects the corner.
        Miter = "miter",
        /// It is turned about the corner.
        Round = "round",
    }
}

crate::choices! {
    /// The rule by which sections travel.
    pub enum LawWord {
        /// They stay parallel.
        Parallel = "parallel",
        /// They turn about the axis.
        Rotational = "rotational",
        /// They stay normal to the main guide.
        Normal = "normal",
        /// They divide all guides in the same ratio.
        Synchronized = "synchronized",
    }
}

crate::choices! {
    /// How the net of sections and guides becomes a surface.
    pub enum MethodWord {
        /// By splines through all of them, smooth across all.
        Gordon = "gordon",
        /// Each patch from its own four curves, to compare.
        Local = "local",
    }
}

const ROTATIONAL: &str = "sweep(a, law: rotational, guides: [g], axis: (0, 0, 1))";
const SWEEP: &str = "sweep([a, b], law: parallel, guides: [g])";

builtins! {
    /// Surface swept by a curve along a path.
    ///
    /// The profile may be anywhere: it moves rigidly with the path, keeps its position relative to the start, and turns with the
    /// path's direction without turning about it (the rotation-minimising frame); the twist that remains where a path closes is spread
    /// over its length. u runs along the path, v along the profile. At corners of the path the surface is cut by the bisecting
    /// plane; the runs that end in a corner must be straight. A straight path gives what `extrude` gives, an arc what `revolve` gives.
    /// ```loft
    /// curve way = spline([(0, 0, 0), (1m, 0, 0), (2m, 1m, 500mm)], start: (1, 0, 0))
    /// curve ring = circle(center: (0, 0, 0), radius: 200mm, normal: (1, 0, 0))
    /// surface pipe = along(ring, way)
    /// ```
    fn along(
        /// The curve that is swept.
        profile: Chain,
        /// The path of the sweep.
        path: Chain,
        /// What happens at corners of the path: the surface is cut by the bisecting plane, or the profile turns about the corner.
        corner: CornerWord = "miter",
        /// How far the profile turns about the path from start to end.
        twist: Angle = "0deg",
    ) -> Surface = |cx, profile, path, corner, twist| {
        let tolerance = cx.tolerance()?;
        let settings = AlongSettings { twist: twist.0, round: matches!(corner, CornerWord::Round), origin: cx.origin() };
        let (surface, notes) = carried_along(&profile, &path, &settings, &tolerance)?;
        reported(cx, surface, &notes)
    };

    /// Surface of sections that travel along guides by a law.
    ///
    /// It contains every section and every guide; u runs along the first guide, the main one, v along the sections. The law says
    /// where sections stand between those given: `parallel` ones in parallel planes, `rotational` ones in half-planes of the axis,
    /// `normal` ones in planes normal to the main guide, `synchronized` ones through points that divide all guides in the same
    /// ratio. Its assumptions are checked first. Between two sections those around are deformed to touch the guides, with the least
    /// bending, and blended; before the first one and after the last the nearest one is deformed. Every section must touch every guide within the tolerance;
    /// their order and direction change nothing. One section on one guide is exact.
    /// ```loft
    /// curve foot = spline([(0, -60, 0), (0, -30, 18), (0, 0, 24), (0, 30, 18), (0, 60, 0)])
    /// curve head = spline([(120, -50, 0), (120, -25, 30), (120, 0, 34), (120, 25, 12), (120, 50, 0)])
    /// curve left = spline([(0, -60, 0), (40, -62, 4), (80, -55, 6), (120, -50, 0)])
    /// curve right = spline([(0, 60, 0), (60, 66, -5), (120, 50, 0)])
    /// surface hood = sweep([foot, head], law: parallel, guides: [left, right])
    /// ```
    fn sweep(
        /// The sections.
        sections: Vec<Chain>,
        /// The rule by which they travel.
        law: LawWord,
        /// The guides, the main one first.
        guides: Vec<Chain>,
        /// Direction of the axis of the rotational law, or a straight curve.
        axis: Option<Axis>,
        /// A point of that axis; the origin, or the curve's start.
        about: Option<Point>,
        /// How the net becomes a surface.
        method: MethodWord = "gordon",
    ) -> Surface = |cx, sections, law, guides, axis, about, method| {
        let tolerance = cx.tolerance()?;
        for (what, list) in [("a section", &sections), ("a guide", &guides)] {
            if list.is_empty() {
                return Err(ValueFault::Missing { function: "sweep", what, example: SWEEP }.into());
            }
        }
        let law = match (law, axis) {
            (LawWord::Rotational, Some(axis)) => {
                let (direction, start) = axis_line(cx, &axis)?;
                let about = about.map(|p| p.0).or(start).unwrap_or(glam::DVec3::ZERO);
                Law::Rotational(revolve::Axis { about, direction })
            }
            (LawWord::Rotational, None) => {
                return Err(ValueFault::Missing { function: "sweep", what: "the axis of the rotational law", example: ROTATIONAL }.into());
            }
            (_, Some(_)) => {
                let arguments = vec!["law", "axis"];
                let what = "`axis:` with the rotational law only";
                return Err(ValueFault::Exclusive { function: "sweep", what, arguments, example: ROTATIONAL }.into());
            }
            (LawWord::Parallel, None) => Law::Parallel,
            (LawWord::Normal, None) => Law::Normal,
            (LawWord::Synchronized, None) => Law::Synchronized,
        };
        let method = match method {
            MethodWord::Gordon => NetMethod::Gordon,
            MethodWord::Local => NetMethod::Local,
        };
        let input = Input { sections: &sections, guides: &guides, law, method, origin: cx.origin() };
        let (surface, notes) = swept(&input, &tolerance)?;
        reported(cx, surface, &notes)
    };

    /// How fair the curves are that a surface is made through.
    ///
    /// They are the stations of a sweep, the sections of a skin, the curves along v of a net.
    /// A record of each, in their order: `at`, its u, or v of a section of a skin; `given`, whether it is one of the curves that were given;
    /// `inflections`, how often it begins to bend the other way, corners left out; `radius`, the least one of its bends, `none` where it is straight;
    /// `bending`, ∫κ² along it times its length, beside the larger of those of the given curves around it, `none` where these are straight and it is not. A station between two sections
    /// that is as fair as these has no more inflections, and a bending near 1.
    /// ```loft
    /// curve foot = spline([(0, -60, 0), (0, -30, 18), (0, 0, 24), (0, 30, 18), (0, 60, 0)])
    /// curve head = spline([(120, -60, 0), (120, -20, 21), (120, 0, 24), (120, 25, 19), (120, 60, 0)])
    /// curve left = line((0, -60, 0), (120, -60, 0))
    /// curve right = line((0, 60, 0), (120, 60, 0))
    /// curve crest = spline([(0, 0, 24), (60, 0, 30), (120, 0, 24)])
    /// surface hood = sweep([foot, head], law: parallel, guides: [left, right, crest])
    /// report fairness(hood)
    /// check max(hood.inflections) == 0
    /// ```
    fn fairness(
        /// The surface.
        s: Surface,
    ) -> Vec<Value> = |cx, s| {
        let row = |station: StationFairness| {
            let radius = if station.radius.is_finite() { Value::length(station.radius) } else { Value::None };
            cx.record([
                ("at", Value::number(station.at)),
                ("given", Value::Bool(station.given)),
                ("inflections", Value::number(station.inflections as f64)),
                ("radius", radius),
                ("bending", if station.bending.is_finite() { Value::number(station.bending) } else { Value::None }),
            ])
        };
        Ok(s.fairness().into_iter().map(row).collect())
    };
}

crate::fields! {
    /// Curves across a surface that it is made through, in the order of u.
    ///
    /// Sections of a sweep or a skin, curves along v of a net.
    fn stations(
        /// The surface.
        s: Surface,
    ) -> Vec<Chain> = |_cx, s| Ok(s.stations());

    /// How often each of its stations begins to bend the other way, in their order.
    ///
    /// A list of no numbers where it was not made through curves. `fairness(s)` has more.
    fn inflections(
        /// The surface.
        s: Surface,
    ) -> Vec<usize> = |_cx, s| Ok(s.fairness().iter().map(|station| station.inflections).collect());

    /// How much each of its stations bends, beside the given curves around it.
    ///
    /// ∫κ² along it times its length, over the larger one of those of the given curve before it and the one after it; 1 for a given curve, `none` where those are straight and it is not. A list of no numbers where it was not made through curves.
    fn bending(
        /// The surface.
        s: Surface,
    ) -> Vec<Option<f64>> = |_cx, s| Ok(s.fairness().iter().map(|station| Some(station.bending).filter(|b| b.is_finite())).collect());

    /// Counts of control points of a B-spline surface along u and v.
    ///
    /// Empty for other surfaces; `nurbs(s)` makes one of any.
    fn net_size(
        /// The surface.
        s: Surface,
    ) -> Vec<usize> = |_cx, s| Ok(s.net_size().map_or_else(Vec::new, |[_, counts]| vec![counts.0, counts.1]));

    /// Degrees of a B-spline surface along u and v; empty for others.
    fn net_degree(
        /// The surface.
        s: Surface,
    ) -> Vec<usize> = |_cx, s| Ok(s.net_size().map_or_else(Vec::new, |[degree, _]| vec![degree.0, degree.1]));

    /// The largest angle between the normals on both sides of the curves of its net.
    ///
    /// Corners of the curves are left out.
    fn patch_angle(
        /// The surface.
        s: Surface,
    ) -> Angle = |_cx, s| Ok(Angle(s.patch_angle()));

    /// The largest distance from the curves that it was made through.
    ///
    /// At their own parameters. None where it was not made through curves. Where curves of a net miss each other it is what a surface between them must leave.
    fn residual(
        /// The surface.
        s: Surface,
    ) -> Option<Length> = |_cx, s| Ok(s.net_curves().iter().map(|c| c.residual).reduce(f64::max).map(Length));

    /// The curves that it was made through, as records.
    ///
    /// Of `curve`, `along` and `at`, `segments`, `scale` and `residual`. Those along v first (stations of a sweep), by ascending u. `scale` is that of the section that was deformed to a station and
    /// differs most from 1; none of curves that were given. A list of no records where it was not made through curves.
    fn net(
        /// The surface.
        s: Surface,
    ) -> Vec<Value> = |cx, s| Ok(s.net_curves().into_iter().map(|c| {
        let name = if c.given { cx.name(c.origin) } else { String::new() };
        cx.record([
            ("curve", Value::text(&name)),
            ("along", Value::text(if c.along_u { "u" } else { "v" })),
            ("at", Value::number(c.at)),
            ("segments", Value::number(c.segments as f64)),
            ("scale", c.scale.map_or(Value::None, Value::number)),
            ("residual", Value::length(c.residual)),
        ])
    }).collect());

    /// The place in which it crosses itself, as W669 reports it. The list is empty where none is found.
    fn self_crossings(
        /// The surface.
        s: Surface,
    ) -> Vec<Point> = |cx, s| Ok(any_crossing(&[s], &cx.tolerance()?).into_iter().map(|found| Point(found.at)).collect());
}
