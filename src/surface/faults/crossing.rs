//! Surfaces that meet in no curve, in several, or along each other.

use glam::DVec3;

use crate::base::fault::quantities::tolerance_note;
use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// What can go wrong where surfaces meet. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum CrossingFault {
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
}

impl Describe for CrossingFault {
    codes! {
        NoCurve "E507", SeveralCurves "E508", RunAlong "E657", WithoutEnd "E658";
        Self::NotOneSection { curves, .. } => if curves.is_empty() { "E507" } else { "E508" }
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::NoCurve { a, b, touch, tolerance } => {
                let (x, y) = (say.met(*a, "one surface"), say.met(*b, "the other"));
                let message = match touch {
                    Some(at) => format!("{x} and {y} meet in no curve: they touch at {}", say.point(*at)),
                    None => format!("{x} and {y} do not meet"),
                };
                let report = Report::new(message).both(*a, *b, "this surface");
                report.note(tolerance_note(say, *tolerance))
            }
            Self::SeveralCurves { a, b, curves } => {
                let list = listed(curves, say);
                let (x, y) = (say.met(*a, "one surface"), say.met(*b, "the other"));
                Report::new(format!("{x} and {y} meet in {} curves: {list}", curves.len()))
                    .both(*a, *b, "this surface")
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
                say.met(*a, "one surface"),
                say.met(*b, "the other"),
                say.point(*at)
            ))
            .both(*a, *b, "this surface")
            .note(format!("they are nearer than the model's tolerance, {}, and almost parallel there", say.length(*tolerance))),
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
