//! Family 4: curves and surfaces that cannot be made longer.

use glam::DVec3;

use crate::base::fault::quantities::typed;
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::NEAREST;

/// Why there is nothing at a side that could go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoEnd {
    /// A curve that ends where it starts.
    Closed,
    /// A surface that closes there: the side is a seam.
    Seam,
    /// The side of a surface is a point.
    Pole,
    /// A surface cut by loops.
    Trimmed,
    /// A plane or triangle: fewer or more sides than four.
    Sides,
}

/// Why an extension cannot reach any farther.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// An arc or ellipse is one turn at most; an arc is then closed.
    Turn,
    /// A mirror image is as long as its curve.
    Image,
    /// The polynomial goes no further: it comes to a stop, or its weights vanish.
    Polynomial,
}

/// Why a curve or surface cannot be made longer. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum ExtendFault {
    /// E417: it has no end on that side.
    NoEnd {
        /// The curve or surface.
        of: Origin,
        /// The word of the side.
        side: &'static str,
        /// Why.
        why: NoEnd,
        /// The length asked for.
        by: f64,
    },
    /// E417: the derivative vanishes at the end, which has no direction then.
    NoDirection {
        /// The curve or surface.
        of: Origin,
        /// The word of the side.
        side: &'static str,
        /// Where.
        at: DVec3,
        /// It is a surface.
        surface: bool,
        /// The length asked for.
        by: f64,
    },
    /// E417: a surface has no mirror image along a border, unless it is plane.
    NoImage {
        /// The surface.
        of: Origin,
    },
    /// E418: it goes no further that way.
    TooFar {
        /// The curve or surface.
        of: Origin,
        /// The length asked for.
        by: f64,
        /// The length that there is.
        most: f64,
        /// Why it reaches no farther.
        stop: Stop,
    },
}

impl Describe for ExtendFault {
    codes! { NoEnd "E417", NoDirection "E417", NoImage "E417", TooFar "E418" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::NoEnd { of, side, why, by } => no_end(&say.quoted(*of, "this"), (*of, side), *why, &typed(say, *by)),
            Self::NoDirection { of, side, at, surface: true, .. } => {
                let name = say.quoted(*of, "this surface");
                Report::new(format!(
                    "{name} has no direction across its side `{side}`, as at {}: its derivative vanishes there",
                    say.point(*at)
                ))
                .at(*of, "stands still at its border")
                .help("set its control points, or the ends of its curves, apart there")
            }
            Self::NoDirection { of, side, at, by, .. } => {
                let name = say.quoted(*of, "this curve");
                let part = if *side == "start" { "[1%..]" } else { "[..99%]" };
                let (plain, by) = (name.trim_matches('`'), typed(say, *by));
                Report::new(format!("{name} has no direction at its {side}, {}: its derivative vanishes there", say.point(*at)))
                    .at(*of, "stands still at its border")
                    .help(format!("cut a little off before: `extend({plain}{part}, side: {side}, by: {by})`"))
            }
            Self::NoImage { of } => {
                let name = say.quoted(*of, "this surface");
                Report::new(format!("{name} is a surface: `how: reflect` is for curves"))
                    .label(Subject::Argument("how"), "`linear` or `curvature` for a surface")
                    .help("how: curvature")
                    .note("`mirror` gives its image in a plane, and `join` makes one surface of both")
                    .edit(Subject::Argument("how"), Edit::Put("curvature".to_owned()))
            }
            Self::TooFar { of, by, most, stop } => too_far(say, *of, (*by, *most), *stop),
        }
    }
}

fn no_end(name: &str, (of, side): (Origin, &str), why: NoEnd, by: &str) -> Report {
    let plain = name.trim_matches('`');
    let (message, label, help) = match why {
        NoEnd::Closed => (
            format!("{name} is closed: it has no {side}"),
            "ends where it starts",
            format!("take a part of it: `extend({plain}[..50%], side: {side}, by: {by})`"),
        ),
        NoEnd::Seam => (
            format!("{name} closes at its side `{side}`: nothing ends there"),
            "closes on itself",
            "another side can be extended, or build it open: with less than a whole turn, or of an open profile".to_owned(),
        ),
        NoEnd::Pole => (
            format!("the side `{side}` of {name} is a point: nothing crosses it"),
            "ends in a point",
            "another side can be extended, or build it up to a curve short of the point".to_owned(),
        ),
        NoEnd::Trimmed => (
            format!("{name} is trimmed: its border is no line of constant u or v"),
            "trimmed",
            "extend the surface that it was cut from, and trim that".to_owned(),
        ),
        NoEnd::Sides => (
            format!("{name} does not have four sides, one of which could be its `{side}`"),
            "has no side of that name",
            "build it of four curves, or, if it is plane, as `plane(at:, normal:)`, which has no end".to_owned(),
        ),
    };
    Report::new(message).at(of, label).help(help)
}

/// Digits of a largest length in a message.
const TOLD_DIGITS: i32 = 3;

fn too_far(say: &dyn Say, of: Origin, (by, most): (f64, f64), stop: Stop) -> Report {
    let why = match stop {
        Stop::Turn => "a whole turn is reached there",
        Stop::Image => "its mirror image is no longer than it is",
        Stop::Polynomial => "its continuation ends there",
    };
    // Rounded down, so that the stated length fits.
    let told = if most > 0.0 {
        let step = math::pow(10.0, math::log10(most).floor() + 1.0 - f64::from(TOLD_DIGITS));
        (most * (1.0 - NEAREST) / step).floor() * step
    } else {
        0.0
    };
    let name = say.quoted(of, "this");
    let message = format!("{name} cannot be extended by {}: {why}", say.length(by));
    if told <= 0.0 {
        return Report::new(message).label(Subject::Argument("by"), "too far").help("`how: linear` goes on straight, as far as you like");
    }
    let put = typed(say, told);
    Report::new(message)
        .label(Subject::Argument("by"), format!("at most {put}"))
        .help(format!("by: {put}, or `how: linear`, which goes on straight"))
        .edit(Subject::Argument("by"), Edit::Put(put))
}
