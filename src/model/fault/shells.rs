//! Shells: open, one-sided or branching ones.

use glam::DVec3;

use crate::base::fault::quantities::{round_above, typed};
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// What can go wrong with a shell, or deserves a word. Lengths are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum ShellFault {
    /// N615: a shell has free edges.
    Open {
        /// The shell.
        shell: Origin,
        /// How many free edges.
        edges: usize,
        /// Their length.
        length: f64,
        /// Middle of the longest one.
        at: DVec3,
    },
    /// E616: no choice of sides makes every edge be used in opposite senses.
    NotOrientable {
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
    NonManifold {
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
        /// The gap is small beside both faces, so that they may be meant to meet.
        near: bool,
        /// The distance within which edges are glued, with the expression that says so.
        snap: Option<(f64, Origin)>,
    },
    /// E656 `shell-not-closed`: something that only a closed shell has was asked for.
    NotClosed {
        /// The shell.
        shell: Origin,
        /// What was asked for, for example "volume".
        wanted: &'static str,
        /// Free edges: surface, middle, length; the longest first.
        free: Vec<(Origin, DVec3, f64)>,
    },
}

impl Describe for ShellFault {
    codes! { Open "N615", NotOrientable "E616", NonManifold "E617", NotAdjacent "E618", NotClosed "E656" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Open { shell, edges, length, at } => Report::new(format!(
                "{} is open: {edges} free edge{}, {} long in total; the longest passes through {}",
                say.quoted(*shell, "the shell"),
                if *edges == 1 { "" } else { "s" },
                say.length(*length),
                say.point(*at)
            ))
            .at(*shell, "not closed"),
            Self::NotOrientable { shell, a, b, at } => Report::new(format!(
                "{} is not orientable: {} and {} cannot be oriented alike at {}",
                say.quoted(*shell, "the shell"),
                say.quoted(*a, "one surface"),
                say.quoted(*b, "another one"),
                say.point(*at)
            ))
            .at(*shell, "has no outside")
            .help("split the ring of surfaces into two shells"),
            Self::NonManifold { shell, users, at } => {
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
            Self::NotAdjacent { a, b, gap, at, near, snap } => {
                let report = Report::new(format!(
                    "{} and {} share no edge; their borders are {} apart at {}",
                    say.quoted(*a, "one face"),
                    say.quoted(*b, "another one"),
                    say.length(*gap),
                    say.point(*at)
                ));
                not_glued(report.both(*a, *b, "this face"), *near, *gap, *snap, say)
            }
            Self::NotClosed { shell, wanted, free } => {
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
        }
    }
}

/// E618 with the `snap` of the shell, and one that reaches over a small gap.
fn not_glued(report: Report, near: bool, gap: f64, snap: Option<(f64, Origin)>, say: &dyn Say) -> Report {
    let report = match snap {
        Some((within, says)) => report.at(says, format!("edges within {} are glued", say.length(within))),
        None => report,
    };
    if !near {
        return report;
    }
    let larger = typed(say, round_above(gap));
    let report = report.help(format!("`snap: {larger}` in the settings of the shell glues them, or build both on the same curve"));
    match snap {
        Some((_, says)) => report.edit(Subject::Entity(says), Edit::Put(larger)),
        None => report,
    }
}
