//! Surfaces that are cut by curves.

use glam::DVec3;

use crate::base::fault::quantities::{tolerance_note, typed};
use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// What can go wrong where a surface is cut. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum CutFault {
    /// E659 `cut-open`: a curve ends inside a surface that it should divide.
    CutOpen {
        /// The curve.
        cutter: Origin,
        /// The surface.
        surface: Origin,
        /// Its ends that lie inside; none where it runs from border to border and still divides nothing.
        ends: Vec<DVec3>,
        /// All of it lies beyond the border of the surface.
        outside: bool,
        /// Lengths by which lines along its tangents at its ends reach the border, with the words of the ends; none where the surface is curved.
        reach: Vec<(&'static str, f64)>,
    },
    /// E721 `cuts-too-near`: a cut without ends leaves one part, where every such cut divides: it was not followed all the way.
    NothingParted {
        /// The surface.
        surface: Origin,
        /// A place on the cut.
        at: DVec3,
        /// The model's tolerance.
        tolerance: f64,
    },
    /// E721 `cuts-too-near`: what divides a surface comes so near to itself that parts between are not told apart.
    CutsTooNear {
        /// The surface.
        surface: Origin,
        /// The curves that do; the surface stands for its borders and for what is not known.
        cuts: [Origin; 2],
        /// Where.
        at: DVec3,
        /// How far they are apart.
        apart: f64,
        /// The model's tolerance.
        tolerance: f64,
    },
    /// E721 `cuts-too-near`: the parts of a surface do not add up to it.
    PartsNotWhole {
        /// The surface.
        surface: Origin,
        /// The curves that divide it.
        cuts: Vec<Origin>,
        /// Area of the surface, square model units.
        whole: f64,
        /// Sum of the areas of its parts, square model units.
        parts: f64,
        /// The model's tolerance.
        tolerance: f64,
    },
    /// E999: what curves bound on a surface is not the surface again, whatever the curves are.
    NotDivided {
        /// The surface.
        surface: Origin,
        /// What is wrong, in words that follow "for".
        what: &'static str,
        /// Where.
        at: DVec3,
    },
    /// E660 `keep-off`: the point that says which part to keep is not on the surface, or on a cut.
    KeepOff {
        /// The surface.
        surface: Origin,
        /// The point.
        at: DVec3,
        /// Its distance from the surface.
        off: f64,
        /// The curve it lies on.
        on: Option<Origin>,
        /// The model's tolerance.
        tolerance: f64,
    },
}

impl Describe for CutFault {
    codes! {
        CutOpen "E659", NothingParted "E721", CutsTooNear "E721", PartsNotWhole "E721", NotDivided "E999", KeepOff "E660"
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::CutOpen { cutter, surface, ends, outside, reach } => {
                let places = say.points(ends);
                let why = match ends.len() {
                    _ if *outside => "it lies outside the border".to_owned(),
                    0 => "it runs from border to border, but leaves one part".to_owned(),
                    1 => format!("it ends inside at {}", places[0]),
                    _ => format!("both its ends lie inside, at {}", places.join(" and ")),
                };
                let (which, whole) = (say.quoted(*cutter, "a curve"), say.quoted(*surface, "the surface"));
                Report::new(format!("{which} does not divide {whole}: {why}"))
                    .at(*cutter, if ends.is_empty() { "divides nothing" } else { "ends inside" })
                    .at(*surface, "this surface")
                    .help(longer(&which, reach, say))
            }
            Self::NothingParted { surface, at, tolerance } => {
                let (name, at) = (say.quoted(*surface, "the surface"), say.point(*at));
                Report::new(format!("a cut of {name} could not be traced to its end near {at}: it leaves one part"))
                    .at(*surface, "this surface")
                    .help("a smaller `tolerance` separates curves, and bends of a curve, that are close together")
                    .note(one_point(*tolerance, say))
            }
            Self::CutsTooNear { surface, cuts: [one, other], at, apart, tolerance } => {
                let (name, at) = (say.quoted(*surface, "the surface"), say.point(*at));
                let message = format!("curves that divide {name} are only {} apart at {at}: no part fits between", say.length(*apart));
                let mut report = Report::new(message).at(*surface, "this surface");
                if one != surface {
                    report = report.at(*one, "this curve");
                }
                if other != one && other != surface {
                    report = report.at(*other, "and this one");
                }
                report.help("move one of them away or onto the other, or set a smaller `tolerance`").note(one_point(*tolerance, say))
            }
            Self::PartsNotWhole { surface, cuts, whole, parts, tolerance } => {
                let name = say.quoted(*surface, "the surface");
                let message = format!(
                    "the parts of {name} make up {:.4} % of its area: curves that divide it come too close together",
                    100.0 * parts / whole
                );
                let report = cuts.iter().fold(Report::new(message).at(*surface, "this surface"), |r, cut| r.at(*cut, "this curve"));
                report.help("a smaller `tolerance` separates curves that are close together").note(one_point(*tolerance, say))
            }
            Self::NotDivided { surface, what, at } => {
                let name = say.quoted(*surface, "the surface");
                Report::new(format!("a bug in loft: {name} is divided wrongly: {what} at {}", say.point(*at)))
                    .at(*surface, "this surface")
                    .help("please report it with this script; moving the curves a little may help meanwhile")
            }
            Self::KeepOff { surface, at, off, on, tolerance } => {
                let (p, name) = (say.point(*at), say.quoted(*surface, "the surface"));
                let report = match on {
                    Some(cutter) => {
                        let message = format!("the point {p} to keep lies on {}, between two parts", say.quoted(*cutter, "a cut"));
                        Report::new(message).at(*cutter, "cuts here")
                    }
                    None if *off > 0.0 => Report::new(format!("the point {p} to keep is {} off {name}", say.length(*off))),
                    None => Report::new(format!("the point {p} to keep lies in no part of {name}")),
                };
                report.at(*surface, "this surface").note(tolerance_note(say, *tolerance))
            }
        }
    }
}

/// What makes a curve divide a surface.
fn longer(curve: &str, reach: &[(&str, f64)], say: &dyn Say) -> String {
    let rule = "a curve divides a surface when it runs from border to border, or closes, alone or with others";
    let Some(name) = curve.strip_prefix('`').and_then(|name| name.strip_suffix('`')).filter(|_| !reach.is_empty()) else {
        return rule.to_owned();
    };
    let one = |name: String, (side, by): &(&str, f64)| format!("extend({name}, side: {side}, by: {}, how: linear)", typed(say, *by));
    format!("{rule}; `{}` reaches the border", reach.iter().fold(name.to_owned(), one))
}

/// How near points of cuts are one.
fn one_point(tolerance: f64, say: &dyn Say) -> String {
    format!("points closer together than four times the model's tolerance of {} count as one", say.length(tolerance))
}
