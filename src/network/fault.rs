//! Family 5: ends that miss, chains that break, meetings that are not one.

use glam::DVec3;

use crate::base::fault::quantities::{round_above, round_down, round_up, typed};
use crate::base::fault::{Code, Describe, Edit, Report, Say, Subject};
use crate::base::origin::Origin;
use crate::base::text::decimals;
use crate::base::tolerance::SNAP_SHARE;

/// What can go wrong with networks and chains, or deserves a word. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum NetworkFault {
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
    /// E503: two neighbours of a chain share no node.
    ChainBroken {
        /// The part before the gap, with its end.
        a: CurveEnd,
        /// The part after the gap, with its start.
        b: CurveEnd,
        /// Whether the second part reversed would fit.
        reversed_fits: bool,
        /// Whether both parts are so much longer than the gap that `snap` can close it.
        snaps: bool,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E504: a chain runs twice over the same stretch.
    ChainRepeats {
        /// The part that runs over it first.
        a: Origin,
        /// The part that runs over it again.
        b: Origin,
        /// Ends of the stretch.
        stretch: (DVec3, DVec3),
    },
    /// E505: more than one run fits.
    ChainAmbiguous {
        /// The curve where the ways part.
        of: Origin,
        /// The point there.
        at: DVec3,
        /// The curves that could follow.
        candidates: Vec<Origin>,
    },
    /// E506: points that are pairwise close form a cluster wider than two tolerances.
    ClusterAmbiguous {
        /// Some of the points, farthest pair first, with their curves.
        points: Vec<(DVec3, Origin)>,
        /// How many points there are.
        count: usize,
        /// Largest distance between two of them.
        diameter: f64,
        /// The tolerance applied.
        tolerance: f64,
        /// A tolerance that keeps them apart.
        smaller: f64,
    },
    /// E611: a loop comes as near to itself as the tolerance, and does not cross itself.
    LoopThin {
        /// One curve.
        a: Origin,
        /// The other one (or the same).
        b: Origin,
        /// Where.
        at: DVec3,
        /// Distance of the two there, model units.
        apart: f64,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E507: two curves do not meet.
    NoMeeting {
        /// First curve and its nearest point.
        a: (Origin, DVec3),
        /// Second curve and its nearest point.
        b: (Origin, DVec3),
        /// The gap is small beside both curves, so that they may be meant to meet.
        near: bool,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E507: a point is not on a curve.
    PointOff {
        /// The curve.
        of: Origin,
        /// The point.
        point: DVec3,
        /// The nearest point of the curve.
        nearest: DVec3,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E508: two curves meet more than once where one meeting is wanted.
    SeveralMeetings {
        /// First curve.
        a: Origin,
        /// Second curve.
        b: Origin,
        /// Points and arc-length fractions on the first curve.
        candidates: Vec<(DVec3, f64)>,
    },
    /// E509: two curves share a run where a point is wanted.
    SharesRun {
        /// First curve.
        a: Origin,
        /// Second curve.
        b: Origin,
        /// Ends of the runs.
        runs: Vec<(DVec3, DVec3)>,
    },
    /// E510: something higher stands on it.
    InUse {
        /// What was to be removed.
        of: Origin,
        /// Who uses it, upper-most first.
        users: Vec<Origin>,
    },
    /// E511: two ends closer than the snap distance, and neither can move.
    SnapFixed {
        /// First curve and its end.
        a: CurveEnd,
        /// Second curve and its end.
        b: CurveEnd,
        /// The snap distance.
        snap: f64,
        /// The expression that says it.
        asked: Origin,
        /// The curve of them that stays since others are made from it.
        settled: Option<Origin>,
    },
    /// N512: two curves run over the same links.
    SharedRun {
        /// The curve that owns the links.
        owner: Origin,
        /// The curve that runs over them.
        other: Origin,
        /// Ends of the run.
        run: (DVec3, DVec3),
        /// Its length.
        length: f64,
    },
    /// N513: an end was moved by `snap`; W223 when that is a large share of its curve.
    Snapped {
        /// The curve and the end before the move.
        end: CurveEnd,
        /// Where it went.
        to: DVec3,
        /// Length of its curve, model units.
        length: f64,
        /// The expression that says the distance.
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
    /// E401: a run of no length.
    NoLength {
        /// The curve.
        of: Origin,
        /// Where it is.
        at: DVec3,
        /// Its length.
        length: f64,
        /// The tolerance applied.
        tolerance: f64,
    },
}

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

impl CurveEnd {
    fn verb(&self) -> &'static str {
        if self.last { "ends here" } else { "starts here" }
    }
}

impl Describe for NetworkFault {
    fn code(&self) -> Code {
        Code(match self {
            Self::EndsMiss { .. } => "E501",
            Self::BoundaryOpen { .. } => "E502",
            Self::ChainBroken { .. } => "E503",
            Self::ChainRepeats { .. } => "E504",
            Self::ChainAmbiguous { .. } => "E505",
            Self::ClusterAmbiguous { .. } => "E506",
            Self::LoopThin { .. } => "E611",
            Self::NoMeeting { .. } | Self::PointOff { .. } => "E507",
            Self::SeveralMeetings { .. } => "E508",
            Self::SharesRun { .. } => "E509",
            Self::InUse { .. } => "E510",
            Self::SnapFixed { .. } => "E511",
            Self::SharedRun { .. } => "N512",
            Self::Snapped { end, to, length, .. } => {
                if moves_far(end.at.distance(*to), *length) {
                    "W223"
                } else {
                    "N513"
                }
            }
            Self::NearMiss { .. } => "W514",
            Self::NoLength { .. } => "E401",
        })
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::EndsMiss { a, b, near, tolerance } => ends_miss(a, b, (*near, *tolerance), say),
            Self::BoundaryOpen { a, b, tolerance } => boundary_open(a, b, *tolerance, say),
            Self::ChainBroken { a, b, reversed_fits, snaps, tolerance } => chain_broken(a, b, (*reversed_fits, *snaps), *tolerance, say),
            Self::ChainRepeats { a, b, stretch } => chain_repeats(*a, *b, *stretch, say),
            Self::ChainAmbiguous { of, at, candidates } => chain_ambiguous(*of, *at, candidates, say),
            Self::ClusterAmbiguous { points, count, diameter, tolerance, smaller } => {
                let mut report = Report::new(format!(
                    "{count} points near {} are pairwise closer than {} but spread over {}: it is ambiguous which of them are one node",
                    say.point(points.first().map_or(DVec3::ZERO, |p| p.0)),
                    say.length(*tolerance),
                    say.length(*diameter)
                ));
                for (point, of) in points {
                    report = report.at(*of, format!("through {}", say.point(*point)));
                }
                let smaller = typed(say, *smaller);
                report.help(format!("`tolerance {smaller}` keeps them apart")).edit(Subject::Call, Edit::Declare("tolerance", smaller))
            }
            Self::LoopThin { a, b, at, apart, tolerance } => {
                let smaller = typed(say, round_down(0.5 * apart.min(*tolerance)));
                Report::new(format!(
                    "the boundary comes too close to itself: {} and {} are {} apart at {}, within the tolerance of {}",
                    say.quoted(*a, "one curve"),
                    if a == b { "itself".to_owned() } else { say.quoted(*b, "another one") },
                    say.length(*apart),
                    say.point(*at),
                    say.length(*tolerance)
                ))
                .at(*a, "this curve")
                .at(*b, "runs beside this one")
                .help(format!("`tolerance {smaller}` keeps them apart"))
                .edit(Subject::Call, Edit::Declare("tolerance", smaller))
            }
            Self::NoMeeting { a, b, near, tolerance } => no_meeting(*a, *b, (*near, *tolerance), say),
            Self::PointOff { of, point, nearest, tolerance } => {
                let ((given, found), curve) = (say.pair(*point, *nearest), say.quoted(*of, "the curve"));
                let away = say.length(point.distance(*nearest));
                Report::new(format!("the point {given} is not on {curve}: the nearest point of the curve, {found}, is {away} away"))
                    .at(*of, "this curve")
                    .note(tolerance_note(*tolerance, say))
            }
            Self::SeveralMeetings { a, b, candidates } => several_meetings(*a, *b, candidates, say),
            Self::SharesRun { a, b, runs } => shares_run(*a, *b, runs, say),
            Self::InUse { of, users } => in_use(*of, users, say),
            Self::SnapFixed { a, b, snap, asked, settled } => snap_fixed([a, b], (*snap, *asked), *settled, say),
            Self::SharedRun { owner, other, run, length } => {
                let ((from, to), long) = (say.pair(run.0, run.1), say.length(*length));
                let (one, another) = (say.quoted(*owner, "one curve"), say.quoted(*other, "another"));
                let first = say.quoted(*owner, "the first");
                Report::new(format!("{one} and {another} share a run of {long} from {from} to {to}; it belongs to {first}"))
                    .at(*other, "runs over it")
                    .at(*owner, "owns it")
            }
            Self::Snapped { end, to, length, asked } => snapped(end, (*to, *length), *asked, say),
            Self::NearMiss { end, other, nearest, other_end, tolerance } => near_miss(end, (*other, *nearest, *other_end), *tolerance, say),
            Self::NoLength { of, at, length, tolerance } => Report::new(format!(
                "{} is a run of length {} at {}, which is a point within the tolerance of {}",
                say.quoted(*of, "this"),
                say.length(*length),
                say.point(*at),
                say.length(*tolerance)
            ))
            .at(*of, "has no length"),
        }
    }
}

/// Whether a move changes a curve of this length.
fn moves_far(moved: f64, length: f64) -> bool {
    moved > SNAP_SHARE * length
}

fn snapped(end: &CurveEnd, (to, length): (DVec3, f64), asked: Origin, say: &dyn Say) -> Report {
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

fn snap_fixed([a, b]: [&CurveEnd; 2], (snap, asked): (f64, Origin), settled: Option<Origin>, say: &dyn Say) -> Report {
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

fn tolerance_note(tolerance: f64, say: &dyn Say) -> String {
    format!("the model's tolerance is {}", say.length(tolerance))
}

fn ends_miss(a: &CurveEnd, b: &CurveEnd, (near, tolerance): (bool, f64), say: &dyn Say) -> Report {
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

fn chain_broken(a: &CurveEnd, b: &CurveEnd, (reversed_fits, snaps): (bool, bool), tolerance: f64, say: &dyn Say) -> Report {
    let gap = a.at.distance(b.at);
    let (here, there) = say.pair(a.at, b.at);
    let (one, next) = (say.quoted(a.of, "one part"), say.quoted(b.of, "the next"));
    let report = Report::new(format!("the chain breaks: {one} ends at {here}, {next} starts at {there}, {} apart", say.length(gap)))
        .at(a.of, "ends here")
        .at(b.of, "starts elsewhere")
        .note(tolerance_note(tolerance, say));
    let name = say.name(b.of);
    if let (true, Some((put, from, to))) = (reversed_fits, turned_run(&name)) {
        report.help(format!("`{put}` runs from {from} to {to}")).edit(Subject::Call, Edit::Instead { put, of: name })
    } else if reversed_fits {
        report
            .help(if name.is_empty() {
                "run the second part backwards, with `-` before it".to_owned()
            } else {
                format!("run it backwards: `-{name}`")
            })
            .edit(Subject::Call, Edit::Instead { put: format!("-{name}"), of: name })
    } else if !snaps {
        report.help("end both at one node")
    } else {
        let wanted = typed(say, round_above(gap));
        report.help(format!("end both at one node, or declare `snap {wanted}`")).edit(Subject::Call, Edit::Declare("snap", wanted))
    }
}

/// `eave[A..B]` for `eave[B..A]`, with `A` and `B`.
fn turned_run(typed: &str) -> Option<(String, String, String)> {
    let (curve, run) = typed.strip_suffix(']')?.rsplit_once('[')?;
    let (from, to) = run.split_once("..")?;
    let (from, to) = (from.trim(), to.trim());
    (!from.is_empty() && !to.is_empty()).then(|| (format!("{curve}[{to}..{from}]"), to.to_owned(), from.to_owned()))
}

fn chain_repeats(a: Origin, b: Origin, stretch: (DVec3, DVec3), say: &dyn Say) -> Report {
    let (from, to) = say.pair(stretch.0, stretch.1);
    Report::new(format!("the chain runs twice over the stretch from {from} to {to}"))
        .at(a, "runs over it first")
        .at(b, "runs over it again")
        .help("end the first part where the second one begins")
}

fn chain_ambiguous(of: Origin, at: DVec3, candidates: &[Origin], say: &dyn Say) -> Report {
    let names: Vec<String> = candidates.iter().map(|&c| say.quoted(c, "a curve")).collect();
    let mut report =
        Report::new(format!("after {} at {} more than one curve fits: {}", say.quoted(of, "a curve"), say.point(at), names.join(", ")))
            .at(of, "several curves start at its end");
    for &candidate in candidates {
        report = report.at(candidate, "could follow");
    }
    report.help("write the boundary as one modeling curve, for example `a + b + c`")
}

fn no_meeting(a: (Origin, DVec3), b: (Origin, DVec3), (near, tolerance): (bool, f64), say: &dyn Say) -> Report {
    let gap = a.1.distance(b.1);
    let wider = if near { format!("; {} would let them meet", typed(say, round_up(gap))) } else { String::new() };
    let (one, other) = (say.quoted(a.0, "one curve"), say.quoted(b.0, "the other"));
    let (here, there) = say.pair(a.1, b.1);
    Report::new(format!("{one} and {other} do not meet: they come closest at {here} and {there}, {} apart", say.length(gap)))
        .at(a.0, "this curve")
        .at(b.0, "and this one")
        .note(format!("{}{wider}", tolerance_note(tolerance, say)))
}

fn several_meetings(a: Origin, b: Origin, candidates: &[(DVec3, f64)], say: &dyn Say) -> Report {
    const SHOWN: usize = 6;
    let shown: Vec<DVec3> = candidates.iter().take(SHOWN).map(|c| c.0).collect();
    let one = |(p, c): (&String, &(DVec3, f64))| format!("{p} ({}%)", decimals(100.0 * c.1, 1));
    let list: Vec<String> = say.points(&shown).iter().zip(candidates).map(one).collect();
    let more = if candidates.len() > SHOWN { format!(" and {} more", candidates.len() - SHOWN) } else { String::new() };
    let (name_a, name_b) = (say.name(a), say.name(b));
    let report = Report::new(format!(
        "{} and {} meet {} times: at {}{more}",
        say.quoted(a, "one curve"),
        say.quoted(b, "the other"),
        candidates.len(),
        list.join(", ")
    ))
    .at(a, "this curve")
    .at(b, "and this one");
    if name_a.is_empty() || name_b.is_empty() {
        report.help("pick one: `meet(a, b)[0]`, or `nearest(meet(a, b), P)`")
    } else {
        let picked = format!("meet({name_a}, {name_b})[0]");
        report
            .help(format!("pick one: `{picked}`, or `nearest(meet({name_a}, {name_b}), P)`"))
            .edit(Subject::Call, Edit::Instead { of: format!("{name_a} & {name_b}"), put: picked })
    }
}

fn shares_run(a: Origin, b: Origin, runs: &[(DVec3, DVec3)], say: &dyn Say) -> Report {
    let run = |(p, q): &(DVec3, DVec3)| {
        let (from, to) = say.pair(*p, *q);
        format!("from {from} to {to}")
    };
    let list: Vec<String> = runs.iter().map(run).collect();
    Report::new(format!(
        "{} and {} share a run {}, not a point",
        say.quoted(a, "one curve"),
        say.quoted(b, "the other"),
        list.join(" and ")
    ))
    .at(a, "this curve")
    .at(b, "and this one")
    .help("`meet(a, b)` lists the ends of the run")
}

fn in_use(of: Origin, users: &[Origin], say: &dyn Say) -> Report {
    let names: Vec<String> = users.iter().map(|&u| say.quoted(u, "an unnamed entity")).collect();
    let name = say.name(of);
    let mut report = Report::new(format!("{} is used by {}", say.quoted(of, "this"), names.join(", "))).at(of, "to be removed");
    for &user in users {
        report = report.at(user, "uses it");
    }
    report.help(format!("remove {} first, or `:remove! {name}` to remove all", names.join(", then ")))
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
    .note(tolerance_note(tolerance, say));
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
    use crate::base::fault::{Fault, Plain};

    #[test]
    fn round_numbers_bracket_their_length() {
        for (length, up, down) in [(0.3, 0.5, 0.2), (0.5, 0.5, 0.2), (1.0, 1.0, 0.5), (7.0, 10.0, 5.0), (1.5e-4, 2e-4, 1e-4)] {
            assert!((round_up(length) / up - 1.0).abs() < 1e-12, "{length} up to {}", round_up(length));
            assert!(round_above(length) > length && round_above(up) > up);
            assert!((round_down(length) / down - 1.0).abs() < 1e-12, "{length} down to {}", round_down(length));
        }
    }

    #[test]
    fn a_miss_names_gap_place_tolerance_and_a_snap_that_passes() {
        let end = |last, x| CurveEnd { of: Origin::NONE, last, at: DVec3::new(x, 0.0, 0.0) };
        let fault = NetworkFault::EndsMiss { a: end(true, 0.0), b: end(false, 0.3), near: true, tolerance: 0.001 };
        let report = fault.describe(&Plain);
        assert_eq!(fault.code().0, "E501");
        assert_eq!(report.message, "one curve and another miss each other by 0.300000 at (0.000000, 0.000000, 0.000000)");
        assert_eq!(report.help.as_deref(), Some("end both at one point, or declare `snap 0.5`"));
        assert!(report.labels.iter().any(|(_, text)| text.contains("tolerance is 0.001")));
    }

    #[test]
    fn codes_are_those_of_the_table() {
        let fault: Fault =
            NetworkFault::SeveralMeetings { a: Origin::NONE, b: Origin::NONE, candidates: vec![(DVec3::ZERO, 0.25); 9] }.into();
        assert_eq!(fault.code().0, "E508");
        assert!(fault.to_string().contains("meet 9 times"), "{fault}");
        assert!(fault.to_string().ends_with("and 3 more"), "{fault}");
    }
}
