//! Family 4: curves.

use glam::DVec3;

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;
use crate::base::text::real;

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
    /// A knot, or a step between two, that cannot be computed with.
    Beyond {
        /// Its value.
        found: f64,
    },
    /// First and last knot of the domain are equal.
    EmptyDomain {
        /// Their value.
        knot: f64,
    },
}

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
    /// E404: no circle passes through three collinear points.
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
}

impl Describe for CurveFault {
    codes! {
        ZeroLength "E401", TooFewPoints "E402", DuplicatePoints "E403", Collinear "E404", Rho "E405", Knots "E406", Weight "E407",
        NonFinite "E408", ZeroDirection "E409", LengthStalled "E410", ZeroAngle "E411", AngleTooLarge "E412", NotConverged "E413"
    }

    fn describe(&self, say: &dyn Say) -> Report {
        let curve = |of: &Origin| say.quoted(*of, "this curve");
        match self {
            Self::ZeroLength { of, length, tolerance } => zero_length(say, *of, *length, *tolerance),
            Self::TooFewPoints { what, argument, needed, given, .. } => {
                let points = if *needed == 1 { "point" } else { "points" };
                Report::new(format!("{what} needs at least {needed} {points}, got {given}"))
                    .label(Subject::Argument(argument), format!("{given} given"))
            }
            Self::DuplicatePoints { of, index, count, at, distance, tolerance } => {
                duplicate_points((*index, (index + 1) % count), &curve(of), *at, (*distance, *tolerance), say)
            }
            Self::Collinear { points: [a, m, b], .. } => {
                let on = say.points(&[*a, *m, *b]).join(", ");
                let typed = |p: &DVec3| format!("({}, {}, {})", real(p.x), real(p.y), real(p.z));
                Report::new(format!("no circle passes through three collinear points: {on}"))
                    .label(Subject::Argument("through"), "on the line through the other two")
                    .help(format!("move it off the line, or say line({}, {})", typed(a), typed(b)))
            }
            Self::Rho { rho, .. } => Report::new(format!("`rho` must be between 0 and 1, ends excluded, got {rho}"))
                .label(Subject::Argument("rho"), "below 0.5 an ellipse, 0.5 a parabola, above a hyperbola")
                .help("rho: 0.5")
                .edit(Subject::Argument("rho"), Edit::Put("0.5".to_owned())),
            Self::Knots { of, what } => knots(*what, &curve(of)),
            Self::Weight { of, index, weight } => Report::new(format!("weight {index} of {} is {weight}, it must be above 0", curve(of)))
                .label(Subject::Item("weights", *index), "not above 0")
                .help("a weight of 1 is neutral")
                .edit(Subject::Argument("weights"), Edit::Member(*index, Some("1".to_owned()))),
            Self::NonFinite { argument, index, .. } => {
                let (subject, which) = match index {
                    Some(i) => (Subject::Item(argument, *i), format!("number {i} of `{argument}`")),
                    None => (Subject::Argument(argument), format!("`{argument}`")),
                };
                Report::new(format!("{which} is not finite")).label(subject, "infinite or not a number")
            }
            Self::ZeroDirection { argument, needed, .. } => {
                Report::new(format!("`{argument}` gives no direction: it must be a vector {needed}"))
                    .label(Subject::Argument(argument), "no direction")
            }
            Self::LengthStalled { of, t, at } => {
                Report::new(format!("the length of {} could not be measured near {} (parameter {t})", curve(of), say.point(*at)))
                    .at(*of, "this curve")
                    .note("this should never appear: please report it with the script")
            }
            Self::ZeroAngle { of, argument } => Report::new(format!("`{argument}` is zero, so {} has no length", curve(of)))
                .label(Subject::Argument(argument), "an angle of 0"),
            Self::AngleTooLarge { argument, angle, .. } => {
                Report::new(format!("`{argument}` is {}, more than one turn", say.angle(*angle)))
                    .label(Subject::Argument(argument), "at most 360°")
                    .help("360deg is the whole circle; a helix may turn further")
                    .edit(Subject::Argument(argument), Edit::Put("360deg".to_owned()))
            }
            Self::NotConverged { of, what, at } => {
                Report::new(format!("{what} could not be determined near {}", say.point(*at))).at(*of, "on this curve")
            }
        }
    }
}

fn zero_length(say: &dyn Say, of: Origin, length: f64, tolerance: f64) -> Report {
    let name = say.quoted(of, "this curve");
    if tolerance == 0.0 {
        return Report::new(format!("{name} has no length: it starts and ends at one point")).at(of, "nothing to draw");
    }
    let message = format!("{name} is {} long, not above the model's tolerance of {}", say.length(length), say.length(tolerance));
    let report = Report::new(message).at(of, "too short to be a curve");
    if length > 0.0 { report.help(format!("`tolerance` below {} would keep it", say.length(length))) } else { report }
}

fn duplicate_points((index, next): (usize, usize), name: &str, at: DVec3, (distance, tolerance): (f64, f64), say: &dyn Say) -> Report {
    let how = if tolerance == 0.0 {
        "are the same".to_owned()
    } else {
        format!("are {} apart, not above the model's tolerance of {}", say.length(distance), say.length(tolerance))
    };
    let report = Report::new(format!("points {index} and {next} of {name} {how}, at {}", say.point(at)))
        .label(Subject::Item("points", index), format!("point {index}"))
        .label(Subject::Item("points", next), format!("point {next}, the same"))
        .edit(Subject::Argument("points"), Edit::Member(next, None));
    match (next, tolerance == 0.0) {
        (0, _) => report.help("leave the last point out: a closed curve returns to its first by itself"),
        (_, true) => report.help(format!("leave point {next} out")),
        (_, false) => report.help(format!("leave point {next} out, or set `tolerance` below {}", say.length(distance))),
    }
}

fn knots(what: KnotFault, name: &str) -> Report {
    match what {
        KnotFault::Decreasing { index, pair } => {
            Report::new(format!("knot {index} of {name} is {}, below the {} before it", pair.1, pair.0))
                .label(Subject::Item("knots", index), "decreases")
        }
        KnotFault::TooOften { knot, times, allowed } => {
            Report::new(format!("knot {knot} of {name} occurs {times} times; at most {allowed} are allowed here"))
                .label(Subject::Argument("knots"), "the curve would be discontinuous there")
        }
        KnotFault::Count { needed, given, points, degree } => {
            Report::new(format!("{points} points of degree {degree} need {needed} knots, got {given}"))
                .label(Subject::Argument("knots"), format!("{given} given"))
                .note("points + degree + 1 knots, the outer ones repeated where the curve is to start and end at its poles")
        }
        KnotFault::Beyond { found } if found.abs() < 1.0 => Report::new(format!("two knots of {name} are only {} apart", real(found)))
            .label(Subject::Argument("knots"), "too little to compute with")
            .help("make them equal, or set the knots farther apart: only their proportions matter"),
        KnotFault::Beyond { found } => Report::new(format!("the knots of {name} reach {}", real(found)))
            .label(Subject::Argument("knots"), "too large to compute with")
            .help("make them smaller: only their proportions matter"),
        KnotFault::EmptyDomain { knot } => Report::new(format!("the domain of {name} is empty: it starts and ends at {knot}"))
            .label(Subject::Argument("knots"), "no two different knots in the middle"),
    }
}
