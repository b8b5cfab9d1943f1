//! Family 4: curves.

use glam::DVec3;

use crate::base::fault::quantities::typed;
use crate::base::fault::{Describe, Edit, Report, Say, Subject};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::text::real;
use crate::base::tolerance::NEAREST;

/// What can be wrong with a curve.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveFault {
    /// E401: nothing is left of the curve.
    ZeroLength {
        /// The curve.
        of: Origin,
        /// Its length, model units.
        length: f64,
        /// The model's tolerance, model units; 0 when none was needed to see it.
        tolerance: f64,
    },
    /// E402: fewer points than the kind of curve needs.
    TooFewPoints {
        /// The curve.
        of: Origin,
        /// What is made, with its article: "a closed spline".
        what: &'static str,
        /// Parameter that holds the points or asks for their number.
        argument: &'static str,
        /// Points needed.
        needed: usize,
        /// Points given.
        given: usize,
    },
    /// E403: two neighbouring points are one.
    DuplicatePoints {
        /// The curve.
        of: Origin,
        /// Index of the first of the two, from 0.
        index: usize,
        /// Number of points; with `index + 1 == count` the second one is point 0.
        count: usize,
        /// Where they are.
        at: DVec3,
        /// Their distance, model units.
        distance: f64,
        /// The model's tolerance, model units; 0 when they are exactly equal.
        tolerance: f64,
    },
    /// E404: no circle goes through three points on a line.
    Collinear {
        /// The curve.
        of: Origin,
        /// Start, point on the arc and end.
        points: [DVec3; 3],
    },
    /// E405: rho outside (0, 1).
    Rho {
        /// The curve.
        of: Origin,
        /// As given.
        rho: f64,
    },
    /// E406: knots that decrease, are too many or stand too often.
    Knots {
        /// The curve.
        of: Origin,
        /// What is wrong with them.
        what: KnotFault,
    },
    /// E407: a weight that is not above zero.
    Weight {
        /// The curve.
        of: Origin,
        /// Its index, from 0.
        index: usize,
        /// As given.
        weight: f64,
    },
    /// E408: a number that is not finite.
    NonFinite {
        /// The curve.
        of: Origin,
        /// Parameter that holds it.
        argument: &'static str,
        /// Its place in a list, from 0.
        index: Option<usize>,
    },
    /// E409: a direction without length.
    ZeroDirection {
        /// The curve.
        of: Origin,
        /// Parameter that holds it.
        argument: &'static str,
        /// What would do: "at right angles to the axis".
        needed: &'static str,
    },
    /// E410: halving did not reach the accuracy of arc lengths.
    LengthStalled {
        /// The curve.
        of: Origin,
        /// Parameter where it happened.
        t: f64,
        /// The point there.
        at: DVec3,
    },
    /// E411: an arc or helix that turns by nothing.
    ZeroAngle {
        /// The curve.
        of: Origin,
        /// Parameter that holds it.
        argument: &'static str,
    },
    /// E412: more than one turn.
    AngleTooLarge {
        /// The curve.
        of: Origin,
        /// Parameter that holds it.
        argument: &'static str,
        /// As given, radians.
        angle: f64,
    },
    /// E413: an iteration that came to no end.
    NotConverged {
        /// The curve.
        of: Origin,
        /// What was sought: "the meetings with `b`".
        what: String,
        /// Where it was sought last.
        at: DVec3,
    },
    /// E414: a rounding or cut of a corner that its sides have no room for.
    CornerTooNarrow {
        /// The curve.
        of: Origin,
        /// Parameter that holds the size.
        argument: &'static str,
        /// Radius or length as given, model units.
        wanted: f64,
        /// The largest one that fits this corner and those it shares a side with; 0 where none does.
        largest: f64,
        /// The corner.
        at: DVec3,
    },
    /// E415: no corner where one is to be rounded or cut.
    NoCorner {
        /// The curve.
        of: Origin,
        /// The place; none where the curve has no corner at all.
        at: Option<DVec3>,
        /// The corner nearest to it.
        nearest: Option<DVec3>,
    },
    /// E416: the sides of a corner that is to be rounded do not lie in its plane.
    CornerNotFlat {
        /// The curve.
        of: Origin,
        /// The corner.
        at: DVec3,
        /// How far they leave it, model units.
        out: f64,
    },
}

/// What is wrong with a list of knots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KnotFault {
    /// A knot below the one before it.
    Decreasing {
        /// Its index, from 0.
        index: usize,
        /// The two values.
        pair: (f64, f64),
    },
    /// A knot that stands so often that the curve falls apart.
    TooOften {
        /// The value.
        knot: f64,
        /// How often it stands.
        times: usize,
        /// How often it may.
        allowed: usize,
    },
    /// Another number of knots than poles and degree ask for.
    Count {
        /// Knots needed.
        needed: usize,
        /// Knots given.
        given: usize,
        /// Poles given.
        points: usize,
        /// Degree given.
        degree: usize,
    },
    /// First and last knot of the domain are equal.
    EmptyDomain {
        /// Their value.
        knot: f64,
    },
}

impl CurveFault {
    /// The curve it speaks of.
    fn origin(&self) -> Origin {
        match self {
            Self::ZeroLength { of, .. }
            | Self::TooFewPoints { of, .. }
            | Self::DuplicatePoints { of, .. }
            | Self::Collinear { of, .. }
            | Self::Rho { of, .. }
            | Self::Knots { of, .. }
            | Self::Weight { of, .. }
            | Self::NonFinite { of, .. }
            | Self::ZeroDirection { of, .. }
            | Self::LengthStalled { of, .. }
            | Self::ZeroAngle { of, .. }
            | Self::AngleTooLarge { of, .. }
            | Self::NotConverged { of, .. }
            | Self::CornerTooNarrow { of, .. }
            | Self::NoCorner { of, .. }
            | Self::CornerNotFlat { of, .. } => *of,
        }
    }
}

impl Describe for CurveFault {
    fn describe(&self, say: &dyn Say) -> Report {
        let name = say.quoted(self.origin(), "this curve");
        match self {
            Self::ZeroLength { of, length, tolerance } => zero_length(say, *of, *length, *tolerance),
            Self::TooFewPoints { what, argument, needed, given, .. } => {
                let points = if *needed == 1 { "point" } else { "points" };
                Report::new("E402", format!("{what} needs at least {needed} {points}, got {given}"))
                    .label(Subject::Argument(argument), format!("{given} given"))
            }
            Self::DuplicatePoints { .. } => duplicate_points(self, say),
            Self::Collinear { points: [a, m, b], .. } => {
                let on = say.points(&[*a, *m, *b]).join(", ");
                let typed = |p: &DVec3| format!("({}, {}, {})", real(p.x), real(p.y), real(p.z));
                Report::new("E404", format!("no circle goes through three points of one line: {on}"))
                    .label(Subject::Argument("through"), "on the line through the other two")
                    .help(format!("move it off the line, or say line({}, {})", typed(a), typed(b)))
            }
            Self::Rho { rho, .. } => Report::new("E405", format!("`rho` must be between 0 and 1, ends excluded, got {rho}"))
                .label(Subject::Argument("rho"), "below 0.5 an ellipse, 0.5 a parabola, above a hyperbola")
                .help("rho: 0.5")
                .edit(Subject::Argument("rho"), Edit::Put("0.5".to_owned())),
            Self::Knots { what, .. } => knots(*what, &name),
            Self::Weight { index, weight, .. } => Report::new("E407", format!("weight {index} of {name} is {weight}, it must be above 0"))
                .label(Subject::Item("weights", *index), "not above 0")
                .help("a weight of 1 is neutral")
                .edit(Subject::Argument("weights"), Edit::Member(*index, Some("1".to_owned()))),
            Self::NonFinite { argument, index, .. } => {
                let (subject, which) = match index {
                    Some(i) => (Subject::Item(argument, *i), format!("number {i} of `{argument}`")),
                    None => (Subject::Argument(argument), format!("`{argument}`")),
                };
                Report::new("E408", format!("{which} is not finite")).label(subject, "infinite or not a number")
            }
            Self::ZeroDirection { argument, needed, .. } => {
                Report::new("E409", format!("`{argument}` gives no direction: it must be a vector {needed}"))
                    .label(Subject::Argument(argument), "no direction")
            }
            Self::LengthStalled { of, t, at } => {
                Report::new("E410", format!("the length of {name} could not be measured near {} (parameter {t})", say.point(*at)))
                    .at(*of, "this curve")
                    .note("this should never appear: please report it with the script")
            }
            Self::ZeroAngle { argument, .. } => Report::new("E411", format!("`{argument}` is zero, so {name} has no length"))
                .label(Subject::Argument(argument), "an angle of 0"),
            Self::AngleTooLarge { argument, angle, .. } => {
                Report::new("E412", format!("`{argument}` is {}, more than one turn", say.angle(*angle)))
                    .label(Subject::Argument(argument), "at most 360°")
                    .help("360deg is the whole circle; a helix may turn further")
                    .edit(Subject::Argument(argument), Edit::Put("360deg".to_owned()))
            }
            Self::NotConverged { of, what, at } => {
                Report::new("E413", format!("{what} could not be determined near {}", say.point(*at))).at(*of, "on this curve")
            }
            Self::CornerTooNarrow { argument, wanted, largest, at, .. } => narrow_corner(say, argument, *wanted, *largest, *at),
            Self::NoCorner { at: None, .. } => {
                Report::new("E415", format!("{name} has no corner")).label(Subject::Call, "nothing to round or cut")
            }
            Self::NoCorner { at: Some(p), nearest, .. } => {
                let report =
                    Report::new("E415", format!("there is no corner at {}", say.point(*p))).label(Subject::Argument("at"), "no corner");
                match nearest {
                    Some(corner) => report
                        .help(format!("the nearest corner is at {}; `at:` left out takes all of them", say.point(*corner)))
                        .edit(Subject::Argument("at"), Edit::DropArgument),
                    None => report.note("the curve has no corner"),
                }
            }
            Self::CornerNotFlat { at, out, .. } => {
                let message = format!("the sides of the corner at {} leave its plane by {}", say.point(*at), say.length(*out));
                Report::new("E416", message)
                    .label(Subject::Call, "an arc needs sides in one plane")
                    .help("round the corner before the sides are bent out of its plane, or cut it with `chamfer`")
            }
        }
    }
}

/// Digits of a largest size in a message.
const STATED_DIGITS: i32 = 3;

fn narrow_corner(say: &dyn Say, argument: &'static str, wanted: f64, largest: f64, at: DVec3) -> Report {
    let (what, size) = if argument == "length" { ("cut", "length") } else { ("rounding", "radius") };
    if largest <= 0.0 {
        let message = format!("no {what} fits the corner at {}: the curve turns straight back there", say.point(at));
        return Report::new("E414", message).label(Subject::Argument(argument), "does not fit at any size");
    }
    // Rounded down, so that the stated size fits; by less than it was searched for, so that 5 mm stays 5 mm.
    let step = math::pow(10.0, math::log10(largest).floor() + 1.0 - f64::from(STATED_DIGITS));
    let rounded = (largest * (1.0 + NEAREST) / step).floor() * step;
    let message = format!("a {what} of {} does not fit the corner at {}", say.length(wanted), say.point(at));
    let put = typed(say, rounded);
    Report::new("E414", message)
        .label(Subject::Argument(argument), format!("at most {put} there"))
        .help(format!("{argument}: {put}"))
        .note(format!("with the largest {size}, this corner and those it shares a side with all fit"))
        .edit(Subject::Argument(argument), Edit::Put(put))
}

fn zero_length(say: &dyn Say, of: Origin, length: f64, tolerance: f64) -> Report {
    let name = say.quoted(of, "this curve");
    if tolerance == 0.0 {
        return Report::new("E401", format!("{name} has no length: it starts and ends at one point")).at(of, "nothing to draw");
    }
    let message = format!("{name} is {} long, not above the model's tolerance of {}", say.length(length), say.length(tolerance));
    let report = Report::new("E401", message).at(of, "too short to be a curve");
    if length > 0.0 { report.help(format!("`tolerance` below {} would keep it", say.length(length))) } else { report }
}

fn duplicate_points(fault: &CurveFault, say: &dyn Say) -> Report {
    let CurveFault::DuplicatePoints { of, index, count, at, distance, tolerance } = fault else {
        return Report::new("E403", "two points coincide");
    };
    let next = (index + 1) % count;
    let name = say.quoted(*of, "this curve");
    let how = if *tolerance == 0.0 {
        "are the same".to_owned()
    } else {
        format!("are {} apart, not above the model's tolerance of {}", say.length(*distance), say.length(*tolerance))
    };
    let report = Report::new("E403", format!("points {index} and {next} of {name} {how}, at {}", say.point(*at)))
        .label(Subject::Item("points", *index), format!("point {index}"))
        .label(Subject::Item("points", next), format!("point {next}, the same"))
        .edit(Subject::Argument("points"), Edit::Member(next, None));
    match (next, *tolerance == 0.0) {
        (0, _) => report.help("leave the last point out: a closed curve returns to its first by itself"),
        (_, true) => report.help(format!("leave point {next} out")),
        (_, false) => report.help(format!("leave point {next} out, or set `tolerance` below {}", say.length(*distance))),
    }
}

fn knots(what: KnotFault, name: &str) -> Report {
    match what {
        KnotFault::Decreasing { index, pair } => {
            Report::new("E406", format!("knot {index} of {name} is {}, below the {} before it", pair.1, pair.0))
                .label(Subject::Item("knots", index), "decreases")
        }
        KnotFault::TooOften { knot, times, allowed } => {
            Report::new("E406", format!("knot {knot} of {name} occurs {times} times; at most {allowed} are allowed here"))
                .label(Subject::Argument("knots"), "the curve would be discontinuous there")
        }
        KnotFault::Count { needed, given, points, degree } => {
            Report::new("E406", format!("{points} points of degree {degree} need {needed} knots, got {given}"))
                .label(Subject::Argument("knots"), format!("{given} given"))
                .note("points + degree + 1 knots, the outer ones repeated where the curve is to start and end at its poles")
        }
        KnotFault::EmptyDomain { knot } => {
            Report::new("E406", format!("the knots of {name} leave no domain: it starts and ends at {knot}"))
                .label(Subject::Argument("knots"), "no two different knots in the middle")
        }
    }
}
