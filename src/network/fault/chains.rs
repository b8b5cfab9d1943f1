//! Chains that break, repeat a stretch or have no length.

use glam::DVec3;

use crate::base::fault::quantities::{round_above, round_down, tolerance_note, typed};
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;
use crate::network::fault::CurveEnd;

/// What can go wrong with a chain. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum ChainFault {
    /// E503: two neighbours of a chain share no node.
    Broken {
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
    Repeats {
        /// The part that runs over it first.
        a: Origin,
        /// The part that runs over it again.
        b: Origin,
        /// Ends of the stretch.
        stretch: (DVec3, DVec3),
    },
    /// E505: more than one run fits.
    Ambiguous {
        /// The curve where the ways part.
        of: Origin,
        /// The point there.
        at: DVec3,
        /// The curves that could follow.
        candidates: Vec<Origin>,
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

impl Describe for ChainFault {
    codes! { Broken "E503", Repeats "E504", Ambiguous "E505", LoopThin "E611", NoLength "E401" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Broken { a, b, reversed_fits, snaps, tolerance } => chain_broken(a, b, (*reversed_fits, *snaps), *tolerance, say),
            Self::Repeats { a, b, stretch } => chain_repeats(*a, *b, *stretch, say),
            Self::Ambiguous { of, at, candidates } => chain_ambiguous(*of, *at, candidates, say),
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

fn chain_broken(a: &CurveEnd, b: &CurveEnd, (reversed_fits, snaps): (bool, bool), tolerance: f64, say: &dyn Say) -> Report {
    let gap = a.at.distance(b.at);
    let (here, there) = say.pair(a.at, b.at);
    let (one, next) = (say.quoted(a.of, "one part"), say.quoted(b.of, "the next"));
    let report = Report::new(format!("the chain breaks: {one} ends at {here}, {next} starts at {there}, {} apart", say.length(gap)))
        .at(a.of, "ends here")
        .at(b.of, "starts elsewhere")
        .note(tolerance_note(say, tolerance));
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
