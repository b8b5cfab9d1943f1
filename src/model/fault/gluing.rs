//! Borders that are glued to one edge, and what becomes too small by it.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// What can go wrong where borders are glued, or deserves a word. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum GluingFault {
    /// N513: borders that are apart became one edge of a shell.
    Glued {
        /// The shell.
        shell: Origin,
        /// What says how far, if anything does.
        says: Option<Origin>,
        /// The surface whose border counts.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Their largest distance.
        gap: f64,
        /// Where that is.
        at: DVec3,
    },
    /// E711: two sides that should be one lie too far apart.
    EdgeMismatch {
        /// One surface.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Their largest distance.
        gap: f64,
        /// Where that is.
        at: DVec3,
        /// The distance within which edges are glued, with the expression that says so.
        stated: (f64, Origin),
    },
    /// N712: edges shorter than what is glued became corners.
    EdgeTooShort {
        /// The surface or curve it is on.
        of: Origin,
        /// Its length.
        length: f64,
        /// Where.
        at: DVec3,
        /// How many others that are shorter.
        more: usize,
    },
    /// N712: a face thinner than what is glued became an edge.
    FaceTooThin {
        /// The surface.
        surface: Origin,
        /// A point of its border.
        at: DVec3,
        /// How many others.
        more: usize,
    },
}

impl Describe for GluingFault {
    codes! { Glued "N513", EdgeMismatch "E711", EdgeTooShort "N712", FaceTooThin "N712" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Glued { shell, says, a, b, gap, at } => Report::new(format!(
                "edges of {} were glued over gaps up to {}, the widest between {} and {} at {}",
                say.quoted(*shell, "the shell"),
                say.length(*gap),
                say.quoted(*a, "one face"),
                say.quoted(*b, "its neighbour"),
                say.point(*at)
            ))
            .at(says.unwrap_or(*shell), if says.is_some() { "asked for here" } else { "its faces have separate borders" }),
            Self::EdgeMismatch { a, b, gap, at, stated } => Report::new(format!(
                "the borders of {} and {} are {} apart at {}",
                say.quoted(*a, "one face"),
                say.quoted(*b, "its neighbour"),
                say.length(*gap),
                say.point(*at)
            ))
            .at(stated.1, format!("edges within {} are glued", say.length(stated.0)))
            .both(*a, *b, "this border")
            .help("set a larger `snap`, or build both on the same curve"),
            Self::EdgeTooShort { of, length, at, more } => Report::new(format!(
                "an edge of {} only {} long at {} became a corner{}",
                say.quoted(*of, "a face"),
                say.length(*length),
                say.point(*at),
                match more {
                    0 => String::new(),
                    1 => ", and a shorter one".to_owned(),
                    _ => format!(", and {more} shorter ones"),
                }
            ))
            .at(*of, "has two corners that almost coincide"),
            Self::FaceTooThin { surface, at, more } => Report::new(format!(
                "{} is thinner than the gluing distance and became an edge at {}{}",
                say.quoted(*surface, "a face"),
                say.point(*at),
                if *more == 0 { String::new() } else { format!(", as {more} others did") }
            ))
            .at(*surface, "has no interior left"),
        }
    }
}
