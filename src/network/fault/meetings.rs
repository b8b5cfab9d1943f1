//! Curves and points that do not meet, or meet more than once.

use glam::DVec3;

use crate::base::fault::quantities::{round_up, tolerance_note, typed};
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;
use crate::base::text::decimals;

/// What can go wrong where curves meet. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum MeetingFault {
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
    /// E509: two curves overlap where a point is wanted.
    Overlap {
        /// First curve.
        a: Origin,
        /// Second curve.
        b: Origin,
        /// Ends of the overlaps.
        overlaps: Vec<(DVec3, DVec3)>,
    },
}

impl Describe for MeetingFault {
    codes! { NoMeeting "E507", PointOff "E507", SeveralMeetings "E508", Overlap "E509" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::NoMeeting { a, b, near, tolerance } => no_meeting(*a, *b, *near, *tolerance, say),
            Self::PointOff { of, point, nearest, tolerance } => {
                let ((given, found), curve) = (say.pair(*point, *nearest), say.quoted(*of, "the curve"));
                let away = say.length(point.distance(*nearest));
                Report::new(format!("the point {given} is not on {curve}: the nearest point of the curve, {found}, is {away} away"))
                    .at(*of, "this curve")
                    .note(tolerance_note(say, *tolerance))
            }
            Self::SeveralMeetings { a, b, candidates } => several_meetings(*a, *b, candidates, say),
            Self::Overlap { a, b, overlaps } => overlap(*a, *b, overlaps, say),
        }
    }
}

fn no_meeting(a: (Origin, DVec3), b: (Origin, DVec3), near: bool, tolerance: f64, say: &dyn Say) -> Report {
    let gap = a.1.distance(b.1);
    let wider = if near { format!("; {} would let them meet", typed(say, round_up(gap))) } else { String::new() };
    let (one, other) = (say.met(a.0, "one curve"), say.met(b.0, "the other"));
    let (here, there) = say.pair(a.1, b.1);
    Report::new(format!("{one} and {other} do not meet: they come closest at {here} and {there}, {} apart", say.length(gap)))
        .both(a.0, b.0, "this curve")
        .note(format!("{}{wider}", tolerance_note(say, tolerance)))
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
        say.met(a, "one curve"),
        say.met(b, "the other"),
        candidates.len(),
        list.join(", ")
    ))
    .both(a, b, "this curve");
    if name_a.is_empty() || name_b.is_empty() {
        report.help("pick one: `meet(a, b)[0]`, or `nearest(meet(a, b), P)`")
    } else {
        let picked = format!("meet({name_a}, {name_b})[0]");
        report
            .help(format!("pick one: `{picked}`, or `nearest(meet({name_a}, {name_b}), P)`"))
            .edit(Subject::Call, Edit::Instead { of: format!("{name_a} & {name_b}"), put: picked })
    }
}

fn overlap(a: Origin, b: Origin, overlaps: &[(DVec3, DVec3)], say: &dyn Say) -> Report {
    let ends = |(p, q): &(DVec3, DVec3)| {
        let (from, to) = say.pair(*p, *q);
        format!("from {from} to {to}")
    };
    let list: Vec<String> = overlaps.iter().map(ends).collect();
    Report::new(format!("{} and {} share a run {}, not a point", say.met(a, "one curve"), say.met(b, "the other"), list.join(" and ")))
        .both(a, b, "this curve")
        .help("`meet(a, b)` lists the ends of the run")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::fault::Fault;

    #[test]
    fn many_meetings_are_counted() {
        let fault: Fault =
            MeetingFault::SeveralMeetings { a: Origin::NONE, b: Origin::NONE, candidates: vec![(DVec3::ZERO, 0.25); 9] }.into();
        assert_eq!(fault.code().0, "E508");
        assert!(fault.to_string().contains("meet 9 times"), "{fault}");
        assert!(fault.to_string().ends_with("and 3 more"), "{fault}");
    }
}
