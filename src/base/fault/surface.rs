//! Family 6: surfaces and the surface model.

use glam::DVec3;

use super::no_flow::NoFlow;
use super::surface_shape::describe_shape;
use super::{Describe, Report, Say};
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

/// How a surface is made, for what helps where it folds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Construction {
    /// From curves around it and across.
    Curves,
    /// Through sections in an order.
    Sections,
    /// A profile is carried.
    Carried,
}

/// What can go wrong with a surface, a patch or a shell, or deserves a word. Lengths are model units, angles radians.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceFault {
    /// E601: the curves span no flow.
    FlowUnknown {
        /// The curves given.
        curves: Vec<Origin>,
        /// What is nearest to success.
        why: NoFlow,
    },
    /// E602: two curves of a grid share no node.
    GridIncomplete {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Smallest distance.
        gap: f64,
        /// Where that is, on `a`.
        at: DVec3,
        /// Crossings found.
        found: usize,
        /// Crossings of the complete grid.
        wanted: usize,
    },
    /// E603: two curves of a grid meet twice.
    GridDouble {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// First meeting.
        first: DVec3,
        /// Second meeting.
        second: DVec3,
    },
    /// E604: the curves of one family are met in different orders, or two meetings coincide in the mean.
    GridNotMonotone {
        /// The curve along which they come in the wrong order.
        curve: Origin,
        /// The curve that should come first.
        a: Origin,
        /// The curve that should come after it.
        b: Origin,
        /// Meeting with `a`.
        first: DVec3,
        /// Meeting with `b`.
        second: DVec3,
    },
    /// E605: two curves of one family meet away from a pole.
    FamilyCrosses {
        /// One curve.
        a: Origin,
        /// The other one.
        b: Origin,
        /// Where they meet.
        at: DVec3,
    },
    /// W606: the two derivatives are parallel or vanish inside.
    PatchSingular {
        /// The surface.
        surface: Origin,
        /// Where, u and v.
        uv: (f64, f64),
        /// Where in space.
        at: DVec3,
        /// How the surface is made.
        made: Construction,
    },
    /// W607: the normal flips inside.
    PatchFolded {
        /// The surface.
        surface: Origin,
        /// Where, u and v.
        uv: (f64, f64),
        /// Where in space.
        at: DVec3,
        /// Angle between the normal there and that of the neighbouring sample.
        turn: f64,
        /// How the surface is made.
        made: Construction,
    },
    /// W669: a surface crosses itself, or two faces made together cross.
    CrossesItself {
        /// The surface.
        surface: Origin,
        /// Where, u and v of both places; none of two faces.
        uv: Option<((f64, f64), (f64, f64))>,
        /// Where in space.
        at: DVec3,
    },
    /// N608: the Lagrange map may swing out between its curves.
    TransfiniteOscillation {
        /// The surface.
        surface: Origin,
        /// `u` or `v`.
        direction: char,
        /// Curves across that direction.
        curves: usize,
        /// Largest sum of the absolute blending values.
        lebesgue: f64,
    },
    /// N609: an end stands out over the border and is left out.
    EndTrimmed {
        /// The curve.
        curve: Origin,
        /// The border it stands out over.
        border: Origin,
        /// The end that is left out.
        end: DVec3,
        /// Length left out.
        length: f64,
    },
    /// E611: the boundary crosses itself.
    LoopSelfIntersects {
        /// One curve.
        a: Origin,
        /// The other one (or the same).
        b: Origin,
        /// Where.
        at: DVec3,
        /// Fractions of arc length along both.
        along: (f64, f64),
    },
    /// W614: kinks so close that a strip of patches is a sliver.
    SliverPatch {
        /// The surface.
        surface: Origin,
        /// `u` or `v`: the direction across the strip.
        direction: char,
        /// Where the strip begins and ends.
        from_to: (f64, f64),
        /// Width of the strip, length.
        width: f64,
        /// Width of its narrower neighbour, length.
        neighbour: f64,
        /// A point on the strip.
        at: DVec3,
    },
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
    /// E612: a loop of a closed surface with border on both sides of it.
    LoopGoesRound {
        /// The loop.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// The trimming.
        trimming: Origin,
        /// A point of the loop.
        at: DVec3,
    },
    /// E613: a loop that is not on its surface.
    LoopOutsideSurface {
        /// The curve.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// How far the curve is from the surface, model units.
        off: f64,
        /// Where.
        at: DVec3,
        /// The model's tolerance.
        tolerance: f64,
    },
    /// E613: a loop in (u, v) that leaves 0…1.
    LoopOutsideParameters {
        /// The curve.
        of: Origin,
        /// The surface.
        surface: Origin,
        /// Where.
        uv: (f64, f64),
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
    /// E621: the axis is not a straight line.
    AxisNotStraight {
        /// The axis.
        axis: Origin,
        /// Its largest distance from the line through its ends.
        off: f64,
        /// Where that is.
        at: DVec3,
    },
    /// E622: the profile lies in the axis.
    GeneratrixOnAxis {
        /// The profile.
        profile: Origin,
        /// First point of the stretch in the axis.
        from: DVec3,
        /// Last point of it.
        to: DVec3,
    },
    /// E623: the profile meets the axis between its ends.
    GeneratrixCrossesAxis {
        /// The profile.
        profile: Origin,
        /// Where.
        at: DVec3,
        /// Fraction of the profile's arc length.
        fraction: f64,
    },
    /// E624: the profile runs along the direction in which it is carried.
    SweepDegenerate {
        /// The profile.
        profile: Origin,
        /// First point of the stretch.
        from: DVec3,
        /// Last point of it.
        to: DVec3,
    },
    /// W651: rows of points whose spacing differs much from the mean.
    GridUneven {
        /// The surface.
        surface: Origin,
        /// `row` or `column`.
        line: &'static str,
        /// Its number, from 0.
        index: usize,
        /// Its spacing over the mean.
        ratio: f64,
        /// Where.
        at: DVec3,
    },
    /// E676 `no-net`: a surface that is no single B-spline net.
    NoNet {
        /// The surface.
        surface: Origin,
        /// It is a trimmed one, else a plane without sides.
        trimmed: bool,
    },
    /// W664 `offset-folds`: an offset turns back over itself.
    OffsetFolds {
        /// The offset.
        surface: Origin,
        /// How far, model units.
        distance: f64,
        /// The largest distance to that side without a fold, as sampled.
        largest: f64,
        /// The place of the surface below that bends tightest.
        at: DVec3,
    },
    /// E655 `plane-not-flat`: boundary curves that lie in no one plane.
    PlaneNotFlat {
        /// The curve with the point farthest off.
        curve: Origin,
        /// Largest distance from the mean plane.
        off: f64,
        /// Where that is.
        at: DVec3,
        /// What would pass.
        tolerance: f64,
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
}

impl Describe for SurfaceFault {
    fn describe(&self, say: &dyn Say) -> Report {
        describe_flow(self, say).or_else(|| describe_shape(self, say)).unwrap_or_else(|| describe_model(self, say))
    }
}

/// E601–E605, N609: the grid of curves.
fn describe_flow(fault: &SurfaceFault, say: &dyn Say) -> Option<Report> {
    use SurfaceFault as F;
    Some(match fault {
        F::FlowUnknown { curves, why } => super::no_flow::describe(curves, why, say),
        F::GridIncomplete { a, b, gap, at, found, wanted } => Report::new(
            "E602",
            format!(
                "{} and {} share no node; their nearest points are {} apart at {}",
                say.quoted(*a, "a curve along u"),
                say.quoted(*b, "a curve along v"),
                say.length(*gap),
                say.point(*at)
            ),
        )
        .at(*a, "this curve")
        .at(*b, "does not meet this one")
        .note(format!("{found} of {wanted} crossings of the grid were found"))
        .help("let every curve along u cross every curve along v, or leave one of these two out"),
        F::GridDouble { a, b, first, second } => {
            let (here, there) = say.pair(*first, *second);
            let (one, other) = (say.quoted(*a, "one curve"), say.quoted(*b, "another one"));
            Report::new("E603", format!("{one} and {other} meet twice, at {here} and at {there}"))
                .at(*a, "this curve")
                .at(*b, "and this one")
                .help("take the run with one of the two meetings: `c[A..B]`")
        }
        F::GridNotMonotone { curve, a, b, first, second } => {
            let (here, there) = say.pair(*first, *second);
            let (one, next) = (say.quoted(*a, "the first"), say.quoted(*b, "the next"));
            let along = say.quoted(*curve, "one curve");
            Report::new("E604", format!("along {along} the curves come in the wrong order: {one} at {here}, {next} at {there}"))
                .at(*curve, "met in another order than its neighbours")
                .at(*a, "should come before")
                .at(*b, "this one")
                .help("every curve along u must meet the curves along v in the same order")
        }
        F::FamilyCrosses { a, b, at } => Report::new(
            "E605",
            format!(
                "{} and {} run the same way but meet at {}",
                say.quoted(*a, "one curve"),
                say.quoted(*b, "another one"),
                say.point(*at)
            ),
        )
        .at(*a, "this curve")
        .at(*b, "meets this one")
        .help("curves of one family may share a pole and nothing else; if this is one, say `pole: P`"),
        F::EndTrimmed { curve, border, end, length } => Report::new(
            "N609",
            format!(
                "{} extends {} past {} to {}; the overhang is ignored",
                say.quoted(*curve, "a curve"),
                say.length(*length),
                say.quoted(*border, "the border"),
                say.point(*end)
            ),
        )
        .at(*curve, "trimmed to the border"),
        _ => return None,
    })
}

/// A name in backquotes, or what stands for one that is missing.
fn called(name: &str, otherwise: &str) -> String {
    if name.is_empty() { otherwise.to_owned() } else { format!("`{name}`") }
}

/// What makes pieces of two faces, where both have names.
fn pieces((a, b): &(String, String)) -> Option<String> {
    (!a.is_empty() && !b.is_empty() && a != b).then(|| format!("imprint({a}, {b})"))
}

/// N615–E618, E656: patches and shells.
fn describe_model(fault: &SurfaceFault, say: &dyn Say) -> Report {
    use SurfaceFault as F;
    match fault {
        F::ShellOpen { shell, edges, length, at } => Report::new(
            "N615",
            format!(
                "{} is open: {edges} free edge{}, {} long in total; the longest passes through {}",
                say.quoted(*shell, "the shell"),
                if *edges == 1 { "" } else { "s" },
                say.length(*length),
                say.point(*at)
            ),
        )
        .at(*shell, "not closed"),
        F::ShellGlued { shell, says, a, b, gap, at } => Report::new(
            "N513",
            format!(
                "edges of {} were glued over gaps up to {}, the widest between {} and {} at {}",
                say.quoted(*shell, "the shell"),
                say.length(*gap),
                say.quoted(*a, "one face"),
                say.quoted(*b, "its neighbour"),
                say.point(*at)
            ),
        )
        .at(says.unwrap_or(*shell), if says.is_some() { "asked for here" } else { "its faces have separate borders" }),
        F::ImprintOverlap { imprint, a, b, names, at } => Report::new("E666", {
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
                    (format!("an edge of {one} lies on {other} without sharing nodes, {length} long, at"), "its edge", "lies on this face")
                }
                Touching::Edge { .. } => {
                    (format!("an edge of {one} meets {other} without sharing a node at"), "its edge", "meets this face")
                }
                Touching::Meeting => (format!("{one} and {other} touch or cross at"), "this face", "and this one"),
                Touching::Crossing => (format!("{one} and {other} cross without sharing nodes at"), "this face", "and this one"),
                Touching::Inside => {
                    (format!("the body of {one} lies inside that of {other}, which has no void there, at"), "this body", "lies in this one")
                }
                Touching::Unknown => (
                    format!("whether {one} and {other} cross could not be determined within the search limits, near"),
                    "this face",
                    "and this one",
                ),
            };
            Report::new("W667", format!("{text} {}", say.point(*at)))
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
        F::ShellNotOrientable { shell, a, b, at } => Report::new(
            "E616",
            format!(
                "{} has only one side: {} and {} cannot be oriented alike at {}",
                say.quoted(*shell, "the shell"),
                say.quoted(*a, "one surface"),
                say.quoted(*b, "another one"),
                say.point(*at)
            ),
        )
        .at(*shell, "has no outside")
        .help("split the ring of surfaces into two shells"),
        F::ShellNonManifold { shell, users, at } => {
            let mut report = Report::new(
                "E617",
                format!("{} faces of {} share the edge at {}", users.len(), say.quoted(*shell, "the shell"), say.point(*at)),
            )
            .at(*shell, "an edge of a shell joins at most two faces");
            for user in users {
                report = report.at(*user, "uses the edge");
            }
            report.help("make two shells")
        }
        F::NotAdjacent { a, b, gap, at } => Report::new(
            "E618",
            format!(
                "{} and {} share no edge; their borders are {} apart at {}",
                say.quoted(*a, "one face"),
                say.quoted(*b, "another one"),
                say.length(*gap),
                say.point(*at)
            ),
        )
        .at(*a, "this face")
        .at(*b, "and this one"),
        F::ShellNotClosed { shell, wanted, free } => {
            if free.is_empty() {
                let shell_name = say.quoted(*shell, "the shell");
                let text = format!("the {wanted} of {shell_name} needs a closed shell, but more than two of its faces share an edge");
                return Report::new("E656", text).at(*shell, "branches").help("make a shell of only the faces that enclose it");
            }
            let length: f64 = free.iter().map(|edge| edge.2).sum();
            let mut report = Report::new(
                "E656",
                format!(
                    "the {wanted} of {} needs a closed shell, but it has {} free edge{}, {} long in total",
                    say.quoted(*shell, "an open shell"),
                    free.len(),
                    if free.len() == 1 { "" } else { "s" },
                    say.length(length)
                ),
            )
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
        // Answered by the tables above; listed so that a new fault cannot be forgotten.
        F::FlowUnknown { .. }
        | F::GridIncomplete { .. }
        | F::GridDouble { .. }
        | F::GridNotMonotone { .. }
        | F::FamilyCrosses { .. }
        | F::PatchSingular { .. }
        | F::PatchFolded { .. }
        | F::CrossesItself { .. }
        | F::TransfiniteOscillation { .. }
        | F::EndTrimmed { .. }
        | F::LoopSelfIntersects { .. }
        | F::LoopGoesRound { .. }
        | F::LoopOutsideSurface { .. }
        | F::LoopOutsideParameters { .. }
        | F::SliverPatch { .. }
        | F::AxisNotStraight { .. }
        | F::GeneratrixOnAxis { .. }
        | F::GeneratrixCrossesAxis { .. }
        | F::SweepDegenerate { .. }
        | F::GridUneven { .. }
        | F::OffsetFolds { .. }
        | F::NoNet { .. }
        | F::PlaneNotFlat { .. } => Report::new("E999", "a fault that another table has words for"),
    }
}
