//! Faults of the surface model: patches, shells, and the gluing of their borders.

use glam::DVec3;

use crate::base::fault::{Code, Describe, Report, Say};
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

/// What can go wrong with patches and shells, or deserves a word. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum ModelFault {
    /// N615: a shell has free edges.
    ShellOpen {
        /// The shell.
        shell: Origin,
        /// How many free edges.
        edges: usize,
        /// Their length.
        length: f64,
        /// Middle of the longest one.
        at: DVec3,
    },
    /// N513: borders that are apart became one edge of a shell.
    ShellGlued {
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
    /// E616: no choice of sides makes every edge be used in opposite senses.
    ShellNotOrientable {
        /// The shell.
        shell: Origin,
        /// One surface at the edge where it fails.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Middle of that edge.
        at: DVec3,
    },
    /// E617: more than two patches at one edge.
    ShellNonManifold {
        /// The shell.
        shell: Origin,
        /// Surfaces that use the edge.
        users: Vec<Origin>,
        /// Middle of the edge.
        at: DVec3,
    },
    /// E618: two faces share no edge.
    NotAdjacent {
        /// One face.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Smallest distance of their borders.
        gap: f64,
        /// Where that is.
        at: DVec3,
    },
    /// E656 `shell-not-closed`: something that only a closed shell has was asked for.
    ShellNotClosed {
        /// The shell.
        shell: Origin,
        /// What was asked for, for example "volume".
        wanted: &'static str,
        /// Free edges: surface, middle, length; the longest first.
        free: Vec<(Origin, DVec3, f64)>,
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

impl Describe for ModelFault {
    fn code(&self) -> Code {
        Code(match self {
            Self::ShellOpen { .. } => "N615",
            Self::ShellGlued { .. } => "N513",
            Self::ImprintOverlap { .. } => "E666",
            Self::FacesTouch { .. } => "W667",
            Self::ShellNotOrientable { .. } => "E616",
            Self::ShellNonManifold { .. } => "E617",
            Self::NotAdjacent { .. } => "E618",
            Self::ShellNotClosed { .. } => "E656",
            Self::EdgeMismatch { .. } => "E711",
            Self::EdgeTooShort { .. } | Self::FaceTooThin { .. } => "N712",
        })
    }

    fn describe(&self, say: &dyn Say) -> Report {
        use ModelFault as F;
        match self {
            F::ShellOpen { shell, edges, length, at } => Report::new(format!(
                "{} is open: {edges} free edge{}, {} long in total; the longest passes through {}",
                say.quoted(*shell, "the shell"),
                if *edges == 1 { "" } else { "s" },
                say.length(*length),
                say.point(*at)
            ))
            .at(*shell, "not closed"),
            F::ShellGlued { shell, says, a, b, gap, at } => Report::new(format!(
                "edges of {} were glued over gaps up to {}, the widest between {} and {} at {}",
                say.quoted(*shell, "the shell"),
                say.length(*gap),
                say.quoted(*a, "one face"),
                say.quoted(*b, "its neighbour"),
                say.point(*at)
            ))
            .at(says.unwrap_or(*shell), if says.is_some() { "asked for here" } else { "its faces have separate borders" }),
            F::ImprintOverlap { imprint, a, b, names, at } => Report::new({
                let (one, other) = (called(&names.0, "one face"), called(&names.1, "another face"));
                format!("{one} and {other} overlap at {}: the common region would be meshed twice", say.point(*at))
            })
            .at(*imprint, "joins faces along lines")
            .at(*a, "this face")
            .at(*b, "and this one")
            .help(match pieces(names) {
                Some(pieces) => format!("`mesh m of {pieces}` meshes the common region once"),
                None => "mesh the pieces that `imprint` makes of them: the common region is one of them".to_owned(),
            }),
            F::FacesTouch { within, a, b, names, how, at, imprint } => {
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
            F::ShellNotOrientable { shell, a, b, at } => Report::new(format!(
                "{} has only one side: {} and {} cannot be oriented alike at {}",
                say.quoted(*shell, "the shell"),
                say.quoted(*a, "one surface"),
                say.quoted(*b, "another one"),
                say.point(*at)
            ))
            .at(*shell, "has no outside")
            .help("split the ring of surfaces into two shells"),
            F::ShellNonManifold { shell, users, at } => {
                let mut report = Report::new(format!(
                    "{} faces of {} share the edge at {}",
                    users.len(),
                    say.quoted(*shell, "the shell"),
                    say.point(*at)
                ))
                .at(*shell, "an edge of a shell joins at most two faces");
                for user in users {
                    report = report.at(*user, "uses the edge");
                }
                report.help("make two shells")
            }
            F::NotAdjacent { a, b, gap, at } => Report::new(format!(
                "{} and {} share no edge; their borders are {} apart at {}",
                say.quoted(*a, "one face"),
                say.quoted(*b, "another one"),
                say.length(*gap),
                say.point(*at)
            ))
            .at(*a, "this face")
            .at(*b, "and this one"),
            F::ShellNotClosed { shell, wanted, free } => {
                if free.is_empty() {
                    let shell_name = say.quoted(*shell, "the shell");
                    let text = format!("the {wanted} of {shell_name} needs a closed shell, but more than two of its faces share an edge");
                    return Report::new(text).at(*shell, "branches").help("make a shell of only the faces that enclose it");
                }
                let length: f64 = free.iter().map(|edge| edge.2).sum();
                let mut report = Report::new(format!(
                    "the {wanted} of {} needs a closed shell, but it has {} free edge{}, {} long in total",
                    say.quoted(*shell, "an open shell"),
                    free.len(),
                    if free.len() == 1 { "" } else { "s" },
                    say.length(length)
                ))
                .at(*shell, "open");
                for (surface, at, length) in free.iter().take(4) {
                    report = report.note(format!(
                        "free edge of {} through {}, {} long",
                        say.quoted(*surface, "a surface"),
                        say.point(*at),
                        say.length(*length)
                    ));
                }
                report.help("add the surfaces that close it to the shell")
            }
            F::EdgeMismatch { a, b, gap, at, stated } => Report::new(format!(
                "the borders of {} and {} are {} apart at {}",
                say.quoted(*a, "one face"),
                say.quoted(*b, "its neighbour"),
                say.length(*gap),
                say.point(*at)
            ))
            .at(stated.1, format!("edges within {} are glued", say.length(stated.0)))
            .at(*a, "this border")
            .at(*b, "and this one")
            .help("set a larger `snap`, or build both on the same curve"),
            F::EdgeTooShort { of, length, at, more } => Report::new(format!(
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
            F::FaceTooThin { surface, at, more } => Report::new(format!(
                "{} is thinner than the gluing distance and became an edge at {}{}",
                say.quoted(*surface, "a face"),
                say.point(*at),
                if *more == 0 { String::new() } else { format!(", as {more} others did") }
            ))
            .at(*surface, "has no interior left"),
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
