//! Family 6 once more: the curves of a loop, and how the loops of a face lie to each other.

use glam::DVec3;

use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// What the curves of a loop were given for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopRole {
    /// The boundary of a plane.
    Plane,
    /// The borders of a hole that is filled.
    Fill,
    /// The outer loop of a trimmed surface.
    Outer,
    /// A hole of a trimmed surface, by its place in the list of holes.
    Hole(usize),
}

/// What can go wrong with the loops of a face. Lengths and points are in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum LoopFault {
    /// E502: one curve alone that does not come back to its start.
    Open {
        /// The curve.
        of: Origin,
        /// Its ends.
        ends: (DVec3, DVec3),
        /// The word of a constructor that closes by `closed: true`.
        closes: Option<&'static str>,
        /// What it was given for.
        role: LoopRole,
        /// The curves given for one hole each that close together.
        together: Vec<Origin>,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E502: several curves of one loop, of which some are closed by themselves.
    ClosedAmong {
        /// All of them, as given.
        given: Vec<Origin>,
        /// The closed ones, the widest first.
        closed: Vec<Origin>,
        /// The others.
        open: Vec<Origin>,
        /// What they were given for.
        role: LoopRole,
    },
    /// E612: a hole outside its outer loop.
    Outside {
        /// The hole.
        hole: Origin,
        /// The outer loop, or the surface that has it.
        outer: Origin,
        /// The trimming.
        trimming: Origin,
        /// A point of the hole.
        at: DVec3,
    },
    /// E661 `loops-meet`, E612 where one is the outer loop: two loops that cross, share a run or touch more than once.
    Meet {
        /// The later hole.
        a: Origin,
        /// The earlier hole, or the outer loop.
        b: Origin,
        /// The second one is the outer loop.
        outer: bool,
        /// The trimming.
        trimming: Origin,
        /// Where they meet.
        places: Vec<DVec3>,
        /// Ends of a run that both have.
        run: Option<(DVec3, DVec3)>,
        /// How far they are from each other there.
        apart: f64,
        /// The tolerance applied.
        tolerance: f64,
    },
    /// E661, E612: one loop over the whole of another one.
    Repeated {
        /// The later one, with its place in the list of holes.
        a: (Origin, usize),
        /// The earlier one; no place for the outer loop.
        b: (Origin, Option<usize>),
        /// The trimming.
        trimming: Origin,
    },
    /// E662 `hole-in-hole`: a hole inside another one.
    Nested {
        /// The inner one.
        inner: Origin,
        /// The one around it.
        around: Origin,
        /// The trimming.
        trimming: Origin,
        /// A point of the inner one.
        at: DVec3,
    },
    /// E663 `curve-given-twice`: one curve twice where each is wanted once.
    Twice {
        /// The curve.
        of: Origin,
        /// The parameter it was given to.
        argument: &'static str,
        /// Its two places there.
        places: (usize, usize),
        /// They are in the loop of this hole.
        hole: Option<usize>,
    },
}

impl Describe for LoopFault {
    codes! {
        Open "E502", ClosedAmong "E502", Outside "E612", Nested "E662", Twice "E663";
        Self::Meet { outer, .. } => if *outer { "E612" } else { "E661" },
        Self::Repeated { b: (_, earlier), .. } => if earlier.is_none() { "E612" } else { "E661" }
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Open { of, ends, closes, role, together, tolerance } => {
                closing(open(*of, *ends, (*role, *tolerance), say), *of, *closes, together, say)
            }
            Self::ClosedAmong { given, closed, open, role } => closed_among(given, (closed, open), *role, say),
            Self::Outside { hole, outer, trimming, at } => {
                let (which, around) = (say.quoted(*hole, "the hole"), say.quoted(*outer, "the surface"));
                Report::new(format!("{which} is not inside the outer loop {around}: its point {} is outside", say.point(*at)))
                    .at(*hole, "this hole")
                    .at(*outer, "the outer loop")
                    .at(*trimming, "trimmed here")
                    .help("a hole lies wholly inside; where it cuts the border, make one outer loop of both")
            }
            Self::Meet { a, b, outer, trimming, places, run, apart, tolerance } => {
                let report = meet((*a, *b), *outer, *trimming, (places, *run), say);
                // Curves that were carried to a surface are up to a quarter of the tolerance off.
                if *apart > 0.5 * tolerance { report.note(apart_there(*apart, *tolerance, say)) } else { report }
            }
            Self::Repeated { a, b, trimming } => repeated(*a, *b, *trimming, say),
            Self::Nested { inner, around, trimming, at } => {
                let (which, other) = (say.quoted(*inner, "one hole"), say.quoted(*around, "another one"));
                Report::new(format!("the hole {which} lies inside the hole {other}, at {}", say.point(*at)))
                    .at(*inner, "this hole")
                    .at(*around, "inside this one")
                    .at(*trimming, "trimmed here")
                    .help(format!("leave {which} out; an island in a hole is a surface of its own"))
            }
            Self::Twice { of, argument, places, hole } => {
                let report = Report::new(format!("{} is given twice", say.quoted(*of, "one curve"))).help("give each curve once");
                match hole {
                    Some(k) => report.label(Subject::Item(argument, *k), "in this loop").at(*of, "this curve"),
                    None => report
                        .label(Subject::Item(argument, places.0), "here")
                        .label(Subject::Item(argument, places.1), "and here again")
                        .edit(Subject::Item(argument, places.1), Edit::DropArgument),
                }
            }
        }
    }
}

/// A loop whose one curve does not close.
fn open(of: Origin, ends: (DVec3, DVec3), (role, tolerance): (LoopRole, f64), say: &dyn Say) -> Report {
    let what = match role {
        LoopRole::Plane | LoopRole::Fill => "the boundary does not close",
        LoopRole::Outer => "the outer loop does not close",
        LoopRole::Hole(_) => "the hole does not close",
    };
    let (name, (start, end)) = (say.quoted(of, "the curve"), say.pair(ends.0, ends.1));
    let (gap, tolerance) = (say.length(ends.0.distance(ends.1)), say.length(tolerance));
    Report::new(format!("{what}: {name} starts at {start} and ends at {end}"))
        .at(of, "an open curve")
        .note(format!("the gap is {gap}; the model's tolerance is {tolerance}"))
}

/// What closes the loop: the other curves of its hole, a setting of its constructor, or a further curve.
fn closing(report: Report, of: Origin, closes: Option<&'static str>, together: &[Origin], say: &dyn Say) -> Report {
    let names: Vec<String> = together.iter().map(|o| say.name(*o)).collect();
    match closes {
        _ if !names.is_empty() && names.iter().all(|n| !n.is_empty()) => {
            report.help(format!("curves of one hole stand in a list of their own: `holes: [[{}]]`", names.join(", ")))
        }
        Some(word) => {
            report.help(format!("`closed: true` in the `{word}` closes it")).edit(Subject::Entity(of), Edit::Add("closed: true".to_owned()))
        }
        None => report.help("add a curve that joins these two points"),
    }
}

fn closed_among(given: &[Origin], (closed, open): (&[Origin], &[Origin]), role: LoopRole, say: &dyn Say) -> Report {
    let name = |o: &Origin| say.name(*o);
    let quoted: Vec<String> = closed.iter().take(SHOWN).map(|o| say.quoted(*o, "a curve")).collect();
    let many = match quoted.as_slice() {
        [one] => format!("{one} is closed by itself"),
        [a, b] => format!("{a} and {b} are both closed"),
        all if closed.len() > SHOWN => {
            format!("{} and {} more are all closed", all.join(", "), closed.len() - SHOWN)
        }
        all => format!("{} are all closed", all.join(", ")),
    };
    let mut report = Report::new(format!("{many}; a loop of several curves consists of open ones"));
    for of in closed.iter().take(SHOWN) {
        report = report.at(*of, "closed");
    }
    let (around, inner): (Vec<String>, Vec<String>) = match open {
        [] => (closed.iter().take(1).map(name).collect(), closed.iter().skip(1).map(name).collect()),
        _ => (open.iter().map(name).collect(), closed.iter().map(name).collect()),
    };
    let named = given.len() <= 2 * SHOWN && around.iter().chain(&inner).all(|n| !n.is_empty());
    let (outer, holes) = (around.join(", "), inner.join(", "));
    let both = if closed.len() == 2 { "both are closed: " } else { "" };
    match role {
        LoopRole::Hole(_) if named => report.help(format!("{both}each is a hole: `holes: [{}]`", [around, inner].concat().join(", "))),
        LoopRole::Hole(_) => report.help("a closed curve is a hole by itself"),
        LoopRole::Plane if named => {
            let put = format!("trim(plane({outer}), holes: [{holes}])");
            let of = format!("plane({})", given.iter().map(name).collect::<Vec<_>>().join(", "));
            report.help(format!("{both}`{put}`")).edit(Subject::Call, Edit::Instead { of, put })
        }
        LoopRole::Outer if named => {
            let ring = if around.len() == 1 { outer } else { format!("[{outer}]") };
            report.help(format!("{both}`outer: {ring}, holes: [{holes}]`"))
        }
        _ => report.help("the outer one is the boundary, the others are holes: `trim(plane(outer), holes: [inner])`"),
    }
}

/// Two loops that meet at places or along a run.
fn meet(
    (a, b): (Origin, Origin),
    outer: bool,
    trimming: Origin,
    (places, run): (&[DVec3], Option<(DVec3, DVec3)>),
    say: &dyn Say,
) -> Report {
    let (first, second) = (say.quoted(a, "one hole"), say.quoted(b, if outer { "the surface" } else { "another one" }));
    let whom = if outer { format!("the hole {first} and the outer loop {second}") } else { format!("the holes {first} and {second}") };
    let message = match run {
        Some((from, to)) => {
            let (from, to) = say.pair(from, to);
            format!("{whom} run along each other from {from} to {to}")
        }
        None => {
            let list = say.points(&places[..places.len().min(SHOWN)]);
            let more = places.len().saturating_sub(SHOWN);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            format!("{whom} meet at {}{more}", list.join(" and "))
        }
    };
    let report = Report::new(message).at(a, "this hole").at(b, if outer { "the outer loop" } else { "meets this one" });
    report.at(trimming, "trimmed here").help(if outer {
        "a hole lies wholly inside; where it cuts the border, make one outer loop of both"
    } else {
        "move them apart, or make one hole of both"
    })
}

fn apart_there(apart: f64, tolerance: f64, say: &dyn Say) -> String {
    format!("they are {} apart there; the model's tolerance is {}", say.length(apart), say.length(tolerance))
}

/// Places of a meeting, and curves of a loop, that are listed.
const SHOWN: usize = 4;

fn repeated(a: (Origin, usize), b: (Origin, Option<usize>), trimming: Origin, say: &dyn Say) -> Report {
    let (first, second) = (say.quoted(a.0, "one hole"), say.quoted(b.0, "another one"));
    let Some(earlier) = b.1 else {
        return Report::new(format!("the hole {first} runs along the whole outer loop {second}: nothing would be left"))
            .at(a.0, "this hole")
            .at(b.0, "the outer loop")
            .at(trimming, "trimmed here")
            .help("a hole lies wholly inside");
    };
    if a.0 == b.0 {
        return Report::new(format!("the hole {first} is given twice"))
            .label(Subject::Item("holes", earlier), "here")
            .label(Subject::Item("holes", a.1), "and here again")
            .at(a.0, "this hole")
            .help("give each hole once");
    }
    Report::new(format!("the holes {first} and {second} are the same loop"))
        .at(a.0, "this hole")
        .at(b.0, "is this one again")
        .at(trimming, "trimmed here")
        .help("give each hole once")
}
