//! Family 6 once more: surfaces that meet, and what is cut by them.

use glam::DVec3;

use crate::base::fault::{Code, Describe, Report, Say};
use crate::base::origin::Origin;

/// What can go wrong where surfaces meet or are cut. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum CutFault {
    /// E507: two surfaces have no curve in common.
    NoCurve {
        /// One surface.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Where they touch without crossing, if they do.
        touch: Option<DVec3>,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E508: two surfaces meet in more than one curve where one is wanted.
    SeveralCurves {
        /// One surface.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Middle and length of each curve.
        curves: Vec<(DVec3, f64)>,
    },
    /// E507, E508: a mesh and a plane that meet in no curve, or in several, where one is wanted.
    NotOneSection {
        /// The expression.
        of: Origin,
        /// Middle and length of each curve.
        curves: Vec<(DVec3, f64)>,
    },
    /// E657 `surfaces-coincide`: two surfaces run along each other over an area or a line, so they have no curve that is sure.
    RunAlong {
        /// One surface.
        a: Origin,
        /// The other one.
        b: Origin,
        /// A place where they do.
        at: DVec3,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E658 `meets-without-end`: two unbounded planes.
    WithoutEnd {
        /// What was asked for.
        of: Origin,
    },
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
    fn code(&self) -> Code {
        Code(match self {
            Self::NoCurve { .. } => "E507",
            Self::SeveralCurves { .. } => "E508",
            Self::NotOneSection { curves, .. } => {
                if curves.is_empty() {
                    "E507"
                } else {
                    "E508"
                }
            }
            Self::RunAlong { .. } => "E657",
            Self::WithoutEnd { .. } => "E658",
            Self::CutOpen { .. } => "E659",
            Self::NotDivided { .. } => "E999",
            Self::NothingParted { .. } | Self::CutsTooNear { .. } | Self::PartsNotWhole { .. } => "E721",
            Self::KeepOff { .. } => "E660",
        })
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::NoCurve { a, b, touch, tolerance } => {
                let (x, y) = (say.quoted(*a, "one surface"), say.quoted(*b, "the other"));
                let message = match touch {
                    Some(at) => format!("{x} and {y} meet in no curve: they touch at {}", say.point(*at)),
                    None => format!("{x} and {y} do not meet"),
                };
                let report = Report::new(message).at(*a, "this surface").at(*b, "and this one");
                report.note(format!("the model's tolerance is {}", say.length(*tolerance)))
            }
            Self::SeveralCurves { a, b, curves } => {
                let list = listed(curves, say);
                let (x, y) = (say.quoted(*a, "one surface"), say.quoted(*b, "the other"));
                Report::new(format!("{x} and {y} meet in {} curves: {list}", curves.len()))
                    .at(*a, "this surface")
                    .at(*b, "and this one")
                    .help("`meet(a, b)` is the list of all of them")
            }
            Self::NotOneSection { of, curves } if curves.is_empty() => {
                Report::new("the mesh and the plane do not meet").at(*of, "asked for here")
            }
            Self::NotOneSection { of, curves } => {
                let message = format!("the mesh and the plane meet in {} curves: {}", curves.len(), listed(curves, say));
                Report::new(message).at(*of, "asked for here").help("`section(a, b)` is the list of all of them")
            }
            Self::RunAlong { a, b, at, tolerance } => Report::new(format!(
                "{} and {} run along each other near {}, so the curve in which they meet is not well defined",
                say.quoted(*a, "one surface"),
                say.quoted(*b, "the other"),
                say.point(*at)
            ))
            .at(*a, "this surface")
            .at(*b, "and this one")
            .note(format!("they are nearer than the model's tolerance, {}, and almost parallel there", say.length(*tolerance))),
            Self::NotDivided { surface, what, at } => {
                let name = say.quoted(*surface, "the surface");
                Report::new(format!("a bug in loft: {name} is divided wrongly: {what} at {}", say.point(*at)))
                    .at(*surface, "this surface")
                    .help("please report it with this script; moving the curves a little may help meanwhile")
            }
            Self::NothingParted { surface, at, tolerance } => {
                let (name, at) = (say.quoted(*surface, "the surface"), say.point(*at));
                Report::new(format!("a cut of {name} cannot be followed to its end near {at}: both of its sides are one part"))
                    .at(*surface, "this surface")
                    .help("a smaller `tolerance` separates curves, and bends of a curve, that are close together")
                    .note(format!(
                        "points closer together than four times the model's tolerance of {} count as one",
                        say.length(*tolerance)
                    ))
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
                report.help("move one of them away or onto the other, or set a smaller `tolerance`").note(format!(
                    "points closer together than four times the model's tolerance of {} count as one",
                    say.length(*tolerance)
                ))
            }
            Self::PartsNotWhole { surface, cuts, whole, parts, tolerance } => {
                let name = say.quoted(*surface, "the surface");
                let message = format!(
                    "the parts of {name} make up {:.4} % of its area: curves that divide it come too close together",
                    100.0 * parts / whole
                );
                let report = cuts.iter().fold(Report::new(message).at(*surface, "this surface"), |r, cut| r.at(*cut, "this curve"));
                report.help("a smaller `tolerance` separates curves that are close together").note(format!(
                    "points closer together than four times the model's tolerance of {} count as one",
                    say.length(*tolerance)
                ))
            }
            Self::CutOpen { cutter, surface, ends, outside } => {
                let places = say.points(ends);
                let why = match ends.len() {
                    _ if *outside => "all of it lies beyond the border".to_owned(),
                    0 => "it runs from border to border, but both of its sides are one part".to_owned(),
                    1 => format!("it ends inside at {}", places[0]),
                    _ => format!("both its ends lie inside, at {}", places.join(" and ")),
                };
                let (which, whole) = (say.quoted(*cutter, "a curve"), say.quoted(*surface, "the surface"));
                Report::new(format!("{which} cuts nothing off {whole}: {why}"))
                    .at(*cutter, if ends.is_empty() { "divides nothing" } else { "ends inside" })
                    .at(*surface, "this surface")
                    .help("a curve divides a surface when it runs from border to border, or closes, alone or with others")
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
                report.at(*surface, "this surface").note(format!("the model's tolerance is {}", say.length(*tolerance)))
            }
            Self::WithoutEnd { of } => Report::new("two unbounded planes meet in an infinite line")
                .at(*of, "a curve has a finite length")
                .help("bound one of them: `plane(curves)` is the face inside curves"),
        }
    }
}

/// Curves by a point and their length, the first few of them.
fn listed(curves: &[(DVec3, f64)], say: &dyn Say) -> String {
    const SHOWN: usize = 6;
    let one = |(p, length): &(DVec3, f64)| format!("through {}, {} long", say.point(*p), say.length(*length));
    let list: Vec<String> = curves.iter().take(SHOWN).map(one).collect();
    let more = if curves.len() > SHOWN { format!("; and {} more", curves.len() - SHOWN) } else { String::new() };
    format!("{}{more}", list.join("; "))
}
