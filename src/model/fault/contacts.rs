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
        /// In the middle of the longest segment.
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
                let (text, first, second) = touching(*how, names, say);
                Report::new(format!("{text} {}", say.point(*at)))
                    .at(*a, first)
                    .at(*b, second)
                    .at(*within, "they are not joined here")
                    .help(joining(*how, names, *imprint, &say.point(*at)))
            }
        }
    }
}

/// How two faces touch, up to the place, and the labels of both.
fn touching(how: Touching, names: &(String, String), say: &dyn Say) -> (String, &'static str, &'static str) {
    let (one, other) = (called(&names.0, "one face"), called(&names.1, "another face"));
    let faces = |text: String| (text, "this face", "and this one");
    match how {
        Touching::Overlap => faces(format!("{one} and {other} overlap at")),
        Touching::Edge { length } if length > 0.0 => {
            let text = format!("an edge of {one} lies on {other} without sharing nodes, {} long, at", say.length(length));
            (text, "its edge", "lies on this face")
        }
        Touching::Edge { .. } => (format!("an edge of {one} meets {other} without sharing a node at"), "its edge", "meets this face"),
        Touching::Meeting => faces(format!("{one} and {other} touch or cross at")),
        Touching::Crossing => faces(format!("{one} and {other} cross without sharing nodes at")),
        Touching::Inside => {
            (format!("the body of {one} lies inside that of {other}, which has no void there, at"), "this body", "lies in this one")
        }
        Touching::Unknown => faces(format!("whether {one} and {other} cross could not be determined within the search limits, near")),
    }
}

/// What joins or parts two faces that touch.
fn joining(how: Touching, names: &(String, String), imprint: bool, place: &str) -> String {
    let text = match (how, pieces(names)) {
        (Touching::Overlap, Some(pieces)) => return format!("`{pieces}` are their pieces, with the common region once"),
        (Touching::Overlap, None) => "mesh the pieces that `imprint` makes of them: the common region is one of them",
        (Touching::Edge { length }, _) if length <= 0.0 => {
            return format!("list the point in the mesh, then both share a node there: `mesh m of …, {place}`");
        }
        (Touching::Inside, _) => "one mesh of both fills this space twice: cut or leave out one of them, or mesh them separately",
        (Touching::Unknown, _) => "check them with `meet`, or leave one of them out",
        _ if !imprint => "`imprint: true` in the settings joins them",
        (Touching::Meeting, _) => "the line along which they meet cuts off no part; in a mesh of the shell both have its nodes",
        (_, pieces) => {
            let pieces = pieces.map_or_else(|| "the pieces that `imprint` makes of them".to_owned(), |pieces| format!("`{pieces}`"));
            return format!(
                "`imprint: true` joins whole edges, or parts of them between corners, and this part ends at no corner: mesh {pieces}"
            );
        }
    };
    text.to_owned()
}

/// A name in backquotes, or what stands for one that is missing.
fn called(name: &str, otherwise: &str) -> String {
    if name.is_empty() { otherwise.to_owned() } else { format!("`{name}`") }
}

/// What makes pieces of two faces, where both have names.
fn pieces((a, b): &(String, String)) -> Option<String> {
    (!a.is_empty() && !b.is_empty() && a != b).then(|| format!("imprint({a}, {b})"))
}
