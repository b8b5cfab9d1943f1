//! Counts of elements along borders.

use glam::DVec3;

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;
use crate::mesh::request::fault::MeshLimit;

/// What can go wrong with counts.
#[derive(Clone, Debug, PartialEq)]
pub enum CountFault {
    /// E702: two written counts on opposite sides differ, or no counts make the sides equal.
    Differ {
        /// Elements along one side and where that is written.
        a: (u32, Origin),
        /// Elements along the other one.
        b: (u32, Origin),
        /// The surface between them.
        surface: Origin,
        /// A point of the face.
        at: DVec3,
    },
    /// E702: the three sides of a face for quads.
    SidesDoNotClose {
        /// Elements along the three sides.
        counts: [u32; 3],
        /// Written counts among them.
        written: Vec<(u32, Origin)>,
        /// The surface.
        surface: Origin,
    },
    /// E703: a written count is too coarse for a limit.
    TooCoarse {
        /// The count and its expression.
        count: (u32, Origin),
        /// The setting it breaks.
        limit: MeshLimit,
        /// Where that setting is written.
        written_at: Origin,
        /// The least count that keeps it.
        needed: u32,
        /// Where it is broken.
        at: DVec3,
    },
    /// E703: a written count below what the shape of a face needs (a ring, a lens).
    TooFew {
        /// The count and its expression.
        count: (u32, Origin),
        /// The least count that works.
        needed: u32,
        /// Where.
        at: DVec3,
    },
    /// E703: a count on a chain that is less than its number of links.
    BelowLinks {
        /// The count and its expression.
        count: (u32, Origin),
        /// How many links the chain has.
        links: u32,
    },
    /// E704: counts that add up to an odd number along the border of a freely meshed face of quads.
    Odd {
        /// The count and its expression; none where it follows from other faces alone.
        count: (u32, Origin),
        /// The surface.
        surface: Origin,
        /// A point of the border that needs an even count.
        at: DVec3,
    },
}

impl Describe for CountFault {
    codes! { Differ "E702", SidesDoNotClose "E702", TooCoarse "E703", TooFew "E703", BelowLinks "E703", Odd "E704" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Differ { a, b, surface, at } => {
                let mut report = Report::new("a mapped face needs equal counts on opposite edges");
                for (count, origin) in [a, b] {
                    if origin.is_some() {
                        report = report.at(*origin, elements_of(*count)).edit(Subject::Entity(*origin), Edit::DropSetting);
                    }
                }
                report
                    .at(*surface, "the face between them")
                    .note(format!("{} on one side, {} on the other, of the face at {}", elements_of(a.0), elements_of(b.0), say.point(*at)))
                    .help("drop one of the two")
            }
            Self::SidesDoNotClose { counts, written, surface } => {
                let [a, b, c] = counts;
                let mut report = Report::new(format!("no quads fill a face with {a}, {b} and {c} elements on its three sides"))
                    .at(*surface, "this face");
                for (count, origin) in written {
                    report = report.at(*origin, elements_of(*count)).edit(Subject::Entity(*origin), Edit::DropSetting);
                }
                report
                    .note("the sum must be even, and each side must have fewer elements than the other two together")
                    .help("drop one of the counts, or say `elements: triangles` with equal counts")
            }
            Self::TooCoarse { count, limit, written_at, needed, at } => {
                Report::new(format!("{} {} too coarse for `{limit}` at {}", elements_of(count.0), is(count.0), say.point(*at)))
                    .at(count.1, elements_of(count.0))
                    .at(*written_at, format!("asks for at least {needed}"))
                    .help(format!("count: {needed}"))
                    .edit(Subject::Entity(count.1), Edit::Put(needed.to_string()))
            }
            Self::TooFew { count, needed, at } => {
                Report::new(format!("with {}, edges would coincide at {}", elements_of(count.0), say.point(*at)))
                    .at(count.1, elements_of(count.0))
                    .note("a closed curve needs at least 3 elements; of two curves with the same ends, the longer needs at least 2")
                    .help(format!("count: {needed}"))
                    .edit(Subject::Entity(count.1), Edit::Put(needed.to_string()))
            }
            Self::BelowLinks { count, links } => Report::new(format!("{} {} too few for {links} links", elements_of(count.0), is(count.0)))
                .at(count.1, elements_of(count.0))
                .help(format!("count: {links}"))
                .edit(Subject::Entity(count.1), Edit::Put(links.to_string())),
            Self::Odd { count, surface, at } => {
                let mut report = Report::new(format!(
                    "`elements: quads` is impossible here: an odd number of elements along the border at {}",
                    say.point(*at)
                ));
                if count.1.is_some() {
                    let even = (count.0 + 1).to_string();
                    report = report
                        .at(count.1, elements_of(count.0))
                        .help(format!("count: {even}"))
                        .edit(Subject::Entity(count.1), Edit::Put(even));
                }
                report.at(*surface, "is meshed freely, so its border needs an even number of elements in all")
            }
        }
    }
}

fn elements_of(n: u32) -> String {
    if n == 1 { "1 element".to_owned() } else { format!("{n} elements") }
}

/// The verb behind [`elements_of`].
fn is(n: u32) -> &'static str {
    if n == 1 { "is" } else { "are" }
}
