//! Ends of curves that miss, and ends that `snap` moves.

use glam::DVec3;

use crate::base::fault::quantities::{round_above, tolerance_note, typed};
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;
use crate::base::tolerance::SNAP_SHARE;

/// One end of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveEnd {
    /// The curve.
    pub of: Origin,
    /// The last point, else the first one.
    pub last: bool,
    /// Where it is.
    pub at: DVec3,
}

/// What can go wrong with ends of curves, or deserves a word. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum EndFault {
    /// E501: two ends that should be one point are not.
    EndsMiss {
        /// First curve and its end.
        a: CurveEnd,
        /// Second curve and its end.
        b: CurveEnd,
        /// The gap is small beside both curves, so that they may be meant to meet.
        near: bool,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E502: curves in a row do not come back to where they began.
    BoundaryOpen {
        /// The curve that ends where nothing starts, with that end.
        a: CurveEnd,
        /// The curve that starts where nothing ends, with that end.
        b: CurveEnd,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E511: two ends closer than the snap distance, and neither can move.
    SnapFixed {
        /// First curve and its end.
        a: CurveEnd,
        /// Second curve and its end.
        b: CurveEnd,
        /// The snap distance.
        snap: f64,
        /// The expression in which it is written.
        asked: Origin,
        /// The curve of them that stays since others are made from it.
        settled: Option<Origin>,
    },
    /// N513: an end was moved by `snap`; W223 when that is a large share of its curve.
    Snapped {
        /// The curve and the end before the move.
        end: CurveEnd,
        /// Where it went.
        to: DVec3,
        /// Length of its curve, model units.
        length: f64,
        /// The expression in which the distance is written.
        asked: Origin,
    },
    /// W514: an end misses a curve by little more than the tolerance.
    NearMiss {
        /// The curve and its end.
        end: CurveEnd,
        /// The curve it misses.
        other: Origin,
        /// The nearest point of that curve.
        nearest: DVec3,
        /// Whether that point is an end as well.
        other_end: bool,
        /// The tolerance applied.
        tolerance: f64,
    },
}

impl CurveEnd {
    fn verb(&self) -> &'static str {
        if self.last { "ends here" } else { "starts here" }
    }
}

impl Describe for EndFault {
    codes! {
        EndsMiss "E501", BoundaryOpen "E502", SnapFixed "E511", NearMiss "W514";
        Self::Snapped { end, to, length, .. } => if moves_far(end.at.distance(*to), *length) { "W223" } else { "N513" }
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::EndsMiss { a, b, near, tolerance } => ends_miss(a, b, *near, *tolerance, say),
            Self::BoundaryOpen { a, b, tolerance } => boundary_open(a, b, *tolerance, say),
            Self::SnapFixed { a, b, snap, asked, settled } => snap_fixed([a, b], *snap, *asked, *settled, say),
            Self::Snapped { end, to, length, asked } => snapped(end, *to, *length, *asked, say),
            Self::NearMiss { end, other, nearest, other_end, tolerance } => near_miss(end, (*other, *nearest, *other_end), *tolerance, say),
        }
    }
}

/// Whether a move changes a curve of this length.
fn moves_far(moved: f64, length: f64) -> bool {
    moved > SNAP_SHARE * length
}

fn snapped(end: &CurveEnd, to: DVec3, length: f64, asked: Origin, say: &dyn Say) -> Report {
    let moved = end.at.distance(to);
    let far = moves_far(moved, length);
    let (from, onto) = say.pair(end.at, to);
    let words = format!(
        "the {} of {} moved by {}{} from {from} to {onto}",
        if end.last { "end" } else { "start" },
        say.quoted(end.of, "a curve"),
        say.length(moved),
        if far { format!(", {} % of its length,", rounded(100.0 * moved / length)) } else { String::new() }
    );
    let report = Report::new(words).at(end.of, end.verb());
    if !far {
        return report;
    }
    report
        .at(asked, "ends closer than this are joined")
        .help(format!("correct this end, or declare a `snap` below {}", typed(say, moved)))
        .note(format!(
            "`snap` is for small errors of measurement; a move by more than {} % of the length changes the curve",
            100.0 * SNAP_SHARE
        ))
}

/// A number of two digits, or a whole one.
fn rounded(x: f64) -> String {
    if x < 10.0 { format!("{x:.1}") } else { format!("{x:.0}") }
}

fn snap_fixed([a, b]: [&CurveEnd; 2], snap: f64, asked: Origin, settled: Option<Origin>, say: &dyn Say) -> Report {
    let gap = a.at.distance(b.at);
    let (one, other, at) = (say.quoted(a.of, "one curve"), say.quoted(b.of, "another"), say.point(a.at));
    let words = format!(
        "{one} and {other} end {} apart at {at}, closer than `snap {}`, and neither end can be moved",
        say.length(gap),
        typed(say, snap)
    );
    let below = typed(say, gap);
    let report = Report::new(words)
        .at(a.of, a.verb())
        .at(b.of, b.verb())
        .at(asked, "ends closer than this are joined")
        .help(format!("define one of them through points, end both at one point, or declare a `snap` below {below}"));
    match settled {
        Some(of) => report.note(format!(
            "{} cannot move any more: other curves are made from it, and `snap` treats those later",
            say.quoted(of, "the first")
        )),
        None => report,
    }
}

fn ends_miss(a: &CurveEnd, b: &CurveEnd, near: bool, tolerance: f64, say: &dyn Say) -> Report {
    let gap = a.at.distance(b.at);
    let wanted = typed(say, round_above(gap));
    let (one, other) = (say.quoted(a.of, "one curve"), say.quoted(b.of, "another"));
    let (here, there) = say.pair(a.at, b.at);
    let report = Report::new(format!("{one} and {other} miss each other by {} at {here}", say.length(gap)))
        .at(a.of, a.verb())
        .at(b.of, b.verb())
        .label(Subject::Call, format!("needs a closed boundary; the model's tolerance is {}", say.length(tolerance)))
        .note(format!("the other curve {} at {there}", if b.last { "ends" } else { "starts" }));
    if !near {
        return report.help(format!("add a curve from {here} to {there}, or correct one of these ends"));
    }
    report
        .help(format!("end both at one point, or declare `snap {wanted}`"))
        .edit(Subject::Entity(a.of), Edit::Declare("snap", wanted.clone()))
        .note(format!("within a tolerance of {wanted} they would be one point"))
}

fn boundary_open(a: &CurveEnd, b: &CurveEnd, tolerance: f64, say: &dyn Say) -> Report {
    let side = |end: &CurveEnd| if end.last { "ends" } else { "starts" };
    let gap = a.at.distance(b.at);
    let (here, there) = say.pair(a.at, b.at);
    let (one, other) = (say.quoted(a.of, "one curve"), say.quoted(b.of, "another"));
    Report::new(format!("the boundary does not close: {one} {} at {here}, {other} {} at {there}", side(a), side(b)))
        .at(a.of, a.verb())
        .at(b.of, b.verb())
        .help("add a curve that joins these two points")
        .note(format!("the gap is {}; the model's tolerance is {}", say.length(gap), say.length(tolerance)))
}

fn near_miss(end: &CurveEnd, other: (Origin, DVec3, bool), tolerance: f64, say: &dyn Say) -> Report {
    let (of, nearest, is_end) = other;
    let gap = end.at.distance(nearest);
    let wanted = typed(say, round_above(gap));
    let (here, there) = say.pair(end.at, nearest);
    let report = Report::new(format!(
        "the {} of {} at {} misses {}{} by {}",
        if end.last { "end" } else { "start" },
        say.quoted(end.of, "a curve"),
        here,
        if is_end { "the end of " } else { "" },
        say.quoted(of, "another"),
        say.length(gap)
    ))
    .at(end.of, end.verb())
    .at(of, format!("passes {there}"))
    .note(tolerance_note(say, tolerance));
    // `snap` moves ends to ends.
    if is_end {
        report
            .help(format!("if they should meet, declare `snap {wanted}` or `tolerance {wanted}`"))
            .edit(Subject::Entity(end.of), Edit::Declare("snap", wanted.clone()))
            .edit(Subject::Entity(end.of), Edit::Declare("tolerance", wanted))
    } else {
        report
            .help(format!("if they should meet, declare `tolerance {wanted}`"))
            .edit(Subject::Entity(end.of), Edit::Declare("tolerance", wanted))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::fault::PlainWords;

    #[test]
    fn a_miss_names_gap_place_tolerance_and_a_snap_that_passes() {
        let end = |last, x| CurveEnd { of: Origin::NONE, last, at: DVec3::new(x, 0.0, 0.0) };
        let fault = EndFault::EndsMiss { a: end(true, 0.0), b: end(false, 0.3), near: true, tolerance: 0.001 };
        let report = fault.describe(&PlainWords);
        assert_eq!(fault.code().0, "E501");
        assert_eq!(report.message, "one curve and another miss each other by 0.300000 at (0.000000, 0.000000, 0.000000)");
        assert_eq!(report.help.as_deref(), Some("end both at one point, or declare `snap 0.5`"));
        assert!(report.labels.iter().any(|(_, text)| text.contains("tolerance is 0.001")));
    }
}
