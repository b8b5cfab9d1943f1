//! Faces that overlap, cross or touch.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// How two faces touch that share no edge there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touching {
    /// They cover each other.
    Overlap,
    /// An edge of the first lies on the second.
    Edge {
        /// Length of what lies there, model units; 0 for a point.
        length: f64,
    },
    /// They cross.
    Crossing,
    /// They have a curve in common.
    Meeting,
    /// The body of the first lies inside that of the second.
    Inside,
    /// The search of what they have in common came to no end.
    Unknown,
}

/// What can go wrong where faces touch, or deserves a word.
#[derive(Clone, Debug, PartialEq)]
pub enum ContactFault {
    /// E666: faces that are to be joined where they touch cover each other.
    ImprintOverlap {
        /// What asks for it.
        imprint: Origin,
        /// One face.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Their names.
        names: (String, String),
        /// A place on both.
        at: DVec3,
    },
    /// W667: faces of a mesh touch without sharing nodes.
    FacesTouch {
        /// The mesh or shell.
        within: Origin,
        /// One face; its edge lies on the other one where an edge does.
        a: Origin,
        /// The other face.
        b: Origin,
        /// Their names.
        names: (String, String),
        /// How they touch.
        how: Touching,
        /// In the middle of the longest stretch.
        at: DVec3,
        /// Whether faces that touch were asked to share nodes.
        imprint: bool,
    },
}

impl Describe for ContactFault {
    codes! { ImprintOverlap "E666", FacesTouch "W667" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::ImprintOverlap { imprint, a, b, names, at } => Report::new({
                let (one, other) = (called(&names.0, "one face"), called(&names.1, "another face"));
                format!("{one} and {other} overlap at {}: the common region would be meshed twice", say.point(*at))
            })
            .at(*imprint, "joins faces along lines")
            .both(*a, *b, "this face")
            .help(match pieces(names) {
                Some(pieces) => format!("`mesh m of {pieces}` meshes the common region once"),
                None => "mesh the pieces that `imprint` makes of them: the common region is one of them".to_owned(),
            }),
            Self::FacesTouch { within, a, b, names, how, at, imprint } => {
                let (one, other) = (called(&names.0, "one face"), called(&names.1, "another face"));
                let (text, first, second) = match how {
                    Touching::Overlap => (format!("{one} and {other} overlap at"), "this face", "and this one"),
                    Touching::Edge { length } if *length > 0.0 => {
                        let length = say.length(*length);
                        (
                            format!("an edge of {one} lies on {other} without sharing nodes, {length} long, at"),
                            "its edge",
                            "lies on this face",
                        )
                    }
                    Touching::Edge { .. } => {
                        (format!("an edge of {one} meets {other} without sharing a node at"), "its edge", "meets this face")
                    }
                    Touching::Meeting => (format!("{one} and {other} touch or cross at"), "this face", "and this one"),
                    Touching::Crossing => (format!("{one} and {other} cross without sharing nodes at"), "this face", "and this one"),
                    Touching::Inside => (
                        format!("the body of {one} lies inside that of {other}, which has no void there, at"),
                        "this body",
                        "lies in this one",
                    ),
                    Touching::Unknown => (
                        format!("whether {one} and {other} cross could not be determined within the search limits, near"),
                        "this face",
                        "and this one",
                    ),
                };
                Report::new(format!("{text} {}", say.point(*at)))
                    .at(*a, first)
                    .at(*b, second)
                    .at(*within, "they are not joined here")
                    .help(match how {
                        Touching::Overlap => match pieces(names) {
                            Some(pieces) => format!("`{pieces}` are their pieces, with the common region once"),
                            None => "mesh the pieces that `imprint` makes of them: the common region is one of them".to_owned(),
                        },
                        Touching::Edge { length } if *length <= 0.0 => {
                            format!("list the point in the mesh, then both share a node there: `mesh m of …, {}`", say.point(*at))
                        }
                        Touching::Inside => "one mesh of both fills this space twice: cut or leave out one of them, or mesh them separately".to_owned(),
                        Touching::Unknown => "check them with `meet`, or leave one of them out".to_owned(),
                        _ if !imprint => "`imprint: true` in the settings joins them".to_owned(),
                        Touching::Meeting => "the line along which they meet cuts off no part; in a mesh of the shell both have its nodes".to_owned(),
                        _ => match pieces(names) {
                            Some(pieces) => format!("`imprint: true` joins whole edges, or parts of them between corners, and this part ends at no corner: mesh `{pieces}`"),
                            None => "`imprint: true` joins whole edges, or parts of them between corners, and this part ends at no corner: mesh the pieces that `imprint` makes of them".to_owned(),
                        },
                    })
            }
        }
    }
}

/// A name in backquotes, or what stands for one that is missing.
fn called(name: &str, otherwise: &str) -> String {
    if name.is_empty() { otherwise.to_owned() } else { format!("`{name}`") }
}

/// What makes pieces of two faces, where both have names.
fn pieces((a, b): &(String, String)) -> Option<String> {
    (!a.is_empty() && !b.is_empty() && a != b).then(|| format!("imprint({a}, {b})"))
}
