//! Faults of a whole mesh: its rules, its amount, its sets, its angles, what is too small for it.

use glam::DVec3;

use crate::base::fault::quantities::typed;
use crate::base::fault::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::origin::Origin;

/// The setting that makes angles of elements larger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cure {
    /// `method: auto`.
    Auto,
    /// Written counts or their growth.
    Rows,
    /// A size, model units.
    Size(f64),
    /// `method: delaunay`.
    Method,
    /// A smaller size at the place.
    Near,
}

/// A part of a model that is too small for its mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LostPart {
    /// A hole of a surface.
    Hole {
        /// Its curve.
        hole: Origin,
        /// The surface.
        surface: Origin,
    },
    /// A curve.
    Curve(Origin),
    /// A surface with a face that is as good as a line.
    Face(Origin),
}

/// What can go wrong with a mesh as a whole, or deserves a word. Lengths are model units, angles radians.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshFault {
    /// W701: a rule without effect.
    RuleUnused {
        /// The clause.
        rule: Origin,
        /// Why, in words: "`south` is on no face of this mesh".
        why: String,
    },
    /// W706: of two equal rules the later one holds.
    RuleOverridden {
        /// The setting.
        key: &'static str,
        /// The clause that loses.
        earlier: Origin,
        /// The clause that holds.
        later: Origin,
    },
    /// E217: more elements than a mesh may have.
    TooMany {
        /// What asks for so many, the size where it is written.
        of: Origin,
        /// The mesh.
        name: String,
        /// How many; `None` where that is not known.
        elements: Option<u64>,
        /// How many may be.
        limit: u64,
    },
    /// E217: more work than the elements that are asked for are worth.
    TooMuchWork {
        /// What asks for it: the limit on bends, else the size.
        of: Origin,
        /// The mesh.
        name: String,
        /// The face that takes it, if it is one.
        surface: Origin,
    },
    /// E217: more steps along a border than a mesh may have.
    TooManySteps {
        /// What asks for so many.
        of: Origin,
        /// The mesh.
        name: String,
        /// How many may be.
        limit: u32,
    },
    /// E672: a curve of a group runs along a border for a part of it only and ends where no node is.
    SetInPart {
        /// The group.
        group: Origin,
        /// The mesh.
        mesh: Origin,
        /// The curve.
        curve: Origin,
        /// The middle of that border.
        at: DVec3,
    },
    /// W724: elements with sharp angles, away from sharp corners of their face.
    Sharp {
        /// The mesh.
        of: Origin,
        /// Its name.
        name: String,
        /// The least angle, radians.
        angle: f64,
        /// Where.
        at: DVec3,
        /// Surface of the face.
        surface: String,
        /// How many faces have such.
        faces: usize,
        /// The setting to change.
        cure: Cure,
    },
    /// W725: something of the model that became a point or a line of the mesh.
    Lost {
        /// The mesh.
        of: Origin,
        /// Its name.
        name: String,
        /// What is not there.
        what: LostPart,
        /// Its length, of a hole that round it, model units.
        length: f64,
        /// Where it is.
        at: DVec3,
        /// How many others there are.
        more: usize,
    },
    /// W730: a curve that lies on a face along a part of its segments, and shares no nodes with it.
    Loose {
        /// The mesh.
        of: Origin,
        /// The curve.
        curve: Origin,
        /// The surface of the face.
        surface: Origin,
        /// Length that lies on the face, model units.
        length: f64,
        /// Where it leaves the face first.
        at: DVec3,
        /// How many other curves there are.
        more: usize,
        /// Whether the mesh is imprinted.
        imprint: bool,
    },
}

impl Describe for MeshFault {
    codes! {
        RuleUnused "W701", RuleOverridden "W706", TooMany "E217", TooMuchWork "E217", TooManySteps "E217", SetInPart "E672",
        Sharp "W724", Lost "W725", Loose "W730"
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::RuleUnused { rule, why } => Report::new(format!("this rule has no effect: {why}"))
                .at(*rule, "this rule")
                .help("remove it")
                .edit(Subject::Entity(*rule), Edit::DropRule(None)),
            Self::RuleOverridden { key, earlier, later } => {
                Report::new(format!("`{key}` is set twice for the same part of the mesh; the later rule applies"))
                    .at(*earlier, "has no effect")
                    .at(*later, "applies")
                    .help("remove the first of the two")
                    .edit(Subject::Entity(*earlier), Edit::DropRule(Some(key)))
            }
            Self::TooMany { of, name, elements, limit } => {
                let limit = grouped(*limit);
                let message = match elements {
                    Some(count) => format!("mesh `{name}` would have {} elements; the limit is {limit}", many(*count)),
                    None => format!("mesh `{name}` would have too many elements; the limit is {limit}"),
                };
                Report::new(message).at(*of, "asked for here").help("use a larger value, or set another limit with `--max-elements`")
            }
            Self::TooMuchWork { of, name, surface } => {
                let report = Report::new(format!("the mesh `{name}` exceeds its work limit")).at(*of, "asked for here");
                let most = format!("most of it is used for {}", say.quoted(*surface, "this face"));
                let report = if surface.is_some() { report.at(*surface, most) } else { report };
                report
                    .note("this limit follows from the number of elements; `--max-work` does not change it")
                    .help("use a value that suits the size of the face; look for points that are far off by mistake")
            }
            Self::TooManySteps { of, name, limit } => Report::new(format!("the mesh `{name}` has too many steps along a border"))
                .at(*of, "asked for here")
                .help(format!("use fewer steps; the limit is {limit} from corner to corner")),
            Self::SetInPart { group, mesh, curve, at } => {
                let (set, curve) = (say.quoted(*group, "a group"), say.quoted(*curve, "a curve"));
                Report::new(format!("{set} would contain only a part of {curve}, which ends inside a border at {}", say.point(*at)))
                    .at(*group, "this group")
                    .at(*mesh, "has no node where the curve ends")
                    .help(format!("list {curve} in the mesh too, so that its ends become nodes"))
            }
            Self::Sharp { of, name, angle, at, surface, faces, cure } => {
                let more = match *faces {
                    0 | 1 => String::new(),
                    2 => ", and one more face has such angles".to_owned(),
                    n => format!(", and {} more faces have such angles", n - 1),
                };
                let help = match cure {
                    Cure::Auto => "without `method: mapped` the face is meshed freely, with larger angles".to_owned(),
                    Cure::Rows => "change the `count` or `bias` on the sides of this face".to_owned(),
                    Cure::Size(size) => {
                        format!("`size: {}` on this face, or `method: delaunay`, which uses steps as short", typed(say, *size))
                    }
                    Cure::Method => "`method: delaunay` on this face".to_owned(),
                    Cure::Near => "a smaller `size` on this face, or `near` this place".to_owned(),
                };
                // A face without a name is identified by the place.
                let (on, place) = match surface.as_str() {
                    "" => (format!("at {}", say.point(*at)), "the sharpest is".to_owned()),
                    name => (format!("on `{name}`"), format!("the sharpest is at {},", say.point(*at))),
                };
                Report::new(format!("`{name}` has angles down to {} {on}", say.angle(*angle)))
                    .at(*of, "this mesh")
                    .note(format!("{place} away from sharp corners{more}"))
                    .help(help)
            }
            Self::Loose { of, curve, surface, length, at, more, imprint } => {
                let report = loose(say, (*curve, *surface), (*length, *at), *more).at(*of, "has it beside the face");
                report.help(if *imprint {
                    "end the curve where it leaves the face"
                } else {
                    "`imprint: true` in the mesh cuts the curve there"
                })
            }
            Self::Lost { of, name, what, length, at, more } => lost(say, *of, name, *what, *length, *at, *more),
        }
    }
}

/// A count to be read: whole up to a thousand millions, else its first two digits.
fn many(count: u64) -> String {
    const WHOLE: u64 = 1_000_000_000;
    const SENSE: u64 = 1_000_000_000_000_000;
    match count {
        0..WHOLE => grouped(count),
        WHOLE..=SENSE => format!("{:.1e}", count as f64).replace(".0e", "e"),
        _ => "more than 1e15".to_owned(),
    }
}

/// A count with its digits in threes.
fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let places = digits
        .chars()
        .enumerate()
        .map(|(k, digit)| if k > 0 && (digits.len() - k).is_multiple_of(3) { format!(" {digit}") } else { digit.to_string() });
    places.collect()
}

/// The report of a curve that lies on a face and shares no nodes with it: the length that does, and where it leaves the face.
fn loose(say: &dyn Say, (curve, surface): (Origin, Origin), (length, at): (f64, DVec3), more: usize) -> Report {
    let (line, face) = (say.quoted(curve, "a curve"), say.quoted(surface, "a face"));
    let report = Report::new(format!("{line} leaves {face} at {} and shares no nodes with it", say.point(at)))
        .at(curve, format!("{} of it lie on {face}", say.length(length)));
    match more {
        0 => report,
        1 => report.note("one more curve leaves a face so"),
        n => report.note(format!("{n} more curves leave faces so")),
    }
}

/// The report of a part that is too small for its mesh: its length, place, and how many others there are.
fn lost(say: &dyn Say, of: Origin, mesh: &str, what: LostPart, length: f64, at: DVec3, more: usize) -> Report {
    let (part, as_what, left) = match what {
        LostPart::Hole { hole, surface } => {
            let of = say.quoted(surface, "its surface");
            let hole = say.quoted(hole, "a hole");
            (format!("{hole}, a hole of {of} with a circumference of only {},", say.length(length)), "point", "no hole there")
        }
        LostPart::Curve(curve) => {
            (format!("{}, only {} long,", say.quoted(curve, "a curve"), say.length(length)), "point", "no line there")
        }
        LostPart::Face(surface) => (format!("a face of {}", say.quoted(surface, "a surface")), "line", "no element there"),
    };
    let report = Report::new(format!("{part} became a {as_what} of `{mesh}` at {}", say.point(at)));
    let report = match what {
        LostPart::Hole { hole, surface } => report.at(hole, "is filled in the mesh").at(surface, "has this hole"),
        LostPart::Curve(curve) => report.at(curve, "is not longer than the gluing distance"),
        LostPart::Face(surface) => report.at(surface, "is not wider than the gluing distance"),
    };
    let report = if more > 0 { report.note(format!("so did {more} other{}", if more == 1 { "" } else { "s" })) } else { report };
    report.at(of, format!("has {left}")).help("set a smaller `tolerance`, or `snap` of its shell, or remove it from the model")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_readable() {
        let said = [999, 12_345, 100_000_000, 2_000_000_000_000, 1_260_000_000_000, u64::MAX].map(many);
        assert_eq!(said, ["999", "12 345", "100 000 000", "2e12", "1.3e12", "more than 1e15"]);
    }
}
