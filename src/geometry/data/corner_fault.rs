//! Family 4: corners that are rounded or cut.

use glam::DVec3;

use crate::base::fault::quantities::typed;
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::NEAREST;

/// What can be wrong with a corner that is to be rounded or cut. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum CornerFault {
    /// E414: a rounding or cut of a corner that its sides have no room for.
    TooNarrow {
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
    NotFlat {
        /// The curve.
        of: Origin,
        /// The corner.
        at: DVec3,
        /// How far they leave it, model units.
        out: f64,
    },
}

impl Describe for CornerFault {
    codes! { TooNarrow "E414", NoCorner "E415", NotFlat "E416" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::TooNarrow { argument, wanted, largest, at, .. } => narrow_corner(say, argument, (*wanted, *largest), *at),
            Self::NoCorner { of, at: None, .. } => {
                Report::new(format!("{} has no corner", say.quoted(*of, "this curve"))).label(Subject::Call, "nothing to round or cut")
            }
            Self::NoCorner { at: Some(p), nearest, .. } => {
                let report = Report::new(format!("there is no corner at {}", say.point(*p))).label(Subject::Argument("at"), "no corner");
                match nearest {
                    Some(corner) => report
                        .help(format!("the nearest corner is at {}; without `at:` all corners are taken", say.point(*corner)))
                        .edit(Subject::Argument("at"), Edit::DropArgument),
                    None => report.note("the curve has no corner"),
                }
            }
            Self::NotFlat { at, out, .. } => {
                let message = format!("the sides of the corner at {} leave its plane by {}", say.point(*at), say.length(*out));
                Report::new(message)
                    .label(Subject::Call, "an arc needs sides in one plane")
                    .help("round the corner before the sides are bent out of its plane, or cut it with `chamfer`")
            }
        }
    }
}

/// Digits of a largest size in a message.
const TOLD_DIGITS: i32 = 3;

fn narrow_corner(say: &dyn Say, argument: &'static str, (wanted, largest): (f64, f64), at: DVec3) -> Report {
    let (what, size) = if argument == "length" { ("cut", "length") } else { ("rounding", "radius") };
    if largest <= 0.0 {
        let message = format!("no {what} fits the corner at {}: the curve turns straight back there", say.point(at));
        return Report::new(message).label(Subject::Argument(argument), "does not fit at any size");
    }
    // Rounded down, so that the stated size fits; by less than it was searched for, so that 5 mm stays 5 mm.
    let step = math::pow(10.0, math::log10(largest).floor() + 1.0 - f64::from(TOLD_DIGITS));
    let told = (largest * (1.0 + NEAREST) / step).floor() * step;
    let message = format!("a {what} of {} does not fit the corner at {}", say.length(wanted), say.point(at));
    let put = typed(say, told);
    Report::new(message)
        .label(Subject::Argument(argument), format!("at most {put} there"))
        .help(format!("{argument}: {put}"))
        .note(format!("with the largest {size}, this corner and those it shares a side with all fit"))
        .edit(Subject::Argument(argument), Edit::Put(put))
}
