//! Families 2 and 3: values that do not fit, found below the language.

use glam::DVec3;

use super::quantities::{typed, typed_point};
use super::{Describe, Edit, Report, Say, Subject, codes};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::text::decimals;

/// A plain value that an entity cannot be made from.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueFault {
    /// E306: an argument outside its range; `range` says it in words ("between 0 and 1").
    OutsideRange {
        /// Parameter name.
        argument: &'static str,
        /// The value as text.
        found: String,
        /// What is allowed, in words.
        range: String,
    },
    /// E306: a length outside its range.
    LengthOutside {
        /// Parameter name.
        argument: &'static str,
        /// The length, or the largest of a point's coordinates, model units.
        found: f64,
        /// What is allowed.
        range: LengthRange,
    },
    /// E306: an offset farther than a curve allows.
    OffsetTooFar {
        /// The distance, model units.
        found: f64,
        /// The distances that the curve's bends allow.
        range: LengthRange,
        /// About the largest distance that works on this side, model units.
        most: f64,
    },
    /// E306: the normal of a plane that the curve leaves.
    NotItsPlane {
        /// Parameter name.
        argument: &'static str,
        /// By how much, model units.
        by: f64,
    },
    /// E306: a direction that should be at right angles to another one.
    NotAcross {
        /// Parameter name.
        argument: &'static str,
        /// The angle between the two, radians.
        angle: f64,
        /// What it should be at right angles to, in words.
        to: &'static str,
    },
    /// E301: one of several forms is incomplete.
    Missing {
        /// The function.
        function: &'static str,
        /// What is missing, in words: "a third point or a centre".
        what: &'static str,
        /// A call that works.
        example: &'static str,
    },
    /// E305: arguments of two forms that exclude each other.
    Exclusive {
        /// The function.
        function: &'static str,
        /// What it takes: "a third point or a centre, not both".
        what: &'static str,
        /// The arguments of which one side must go.
        arguments: Vec<&'static str>,
        /// Calls that work.
        example: &'static str,
    },
    /// E211: links are asked of a curve that is not in the network.
    NoLinks {
        /// The curve.
        of: Origin,
    },
    /// E211: the shape of elements of a mesh that has no known faces.
    NoFaces {
        /// Name of the mesh.
        mesh: String,
    },
    /// E215: none or several edges lie where one is asked for.
    NotOneEdge {
        /// The surface or shell; none for a list.
        of: Origin,
        /// The edges that lie there.
        found: Vec<EdgePlace>,
    },
    /// W728: a list without members where things are selected.
    NothingSelected {
        /// The expression.
        of: Origin,
        /// What they are selected for: "group", "picture".
        keyword: &'static str,
    },
    /// W224: a group of which the meshes that are written hold nothing.
    NotMeshed {
        /// The group.
        of: Origin,
        /// Its name.
        group: String,
        /// The meshes, by name.
        meshes: Vec<String>,
    },
    /// W729: `all` or `any` of no condition inside a check.
    OfNothing {
        /// The call.
        of: Origin,
        /// The function.
        function: &'static str,
        /// What it gives.
        result: bool,
    },
    /// E211: a value of the wrong kind inside a list that may hold several kinds.
    WrongKind {
        /// Parameter name.
        argument: &'static str,
        /// What may be there, in words: "a point, curve, surface, shell or mesh".
        wanted: &'static str,
        /// What is there, in words: "an angle".
        found: String,
    },
    /// E211: numbers of several dimensions, or members of several kinds, where one is wanted.
    Mixed {
        /// Parameter name.
        argument: &'static str,
        /// One of them in words: "a length".
        found: String,
        /// What it stands beside: "an angle".
        beside: String,
    },
    /// E903: the script itself says that something is wrong.
    Raised {
        /// In its words.
        message: String,
    },
    /// E230: known but not in this version.
    NotInThisVersion {
        /// What was asked for, for example "`method: delaunay`".
        what: String,
    },
    /// E217: a call that takes more work than one may.
    Work,
    /// E217: a stage over all curves or surfaces that takes more work than it may.
    StageWork {
        /// What would be made, for example "the network".
        what: &'static str,
    },
    /// E217: a row of the report that takes more work than all of them may.
    RowWork {
        /// What is measured.
        of: Origin,
        /// What of it and its name, for example "the area of `roof`".
        what: String,
    },
    /// W227: the box of a surface may be too large.
    LooseBox {
        /// The surface.
        of: Origin,
        /// By how much at most.
        by: f64,
        /// The same as a share of the diagonal of the box asked for.
        share: f64,
    },
    /// W228: a measure is known to few digits.
    RoughMeasure {
        /// The surface, shell or part.
        of: Origin,
        /// Which measure: "the area".
        what: &'static str,
        /// By how much of its value it may be off.
        share: f64,
    },
    /// E217: a list or work limit.
    Limit {
        /// What would be made, for example "a mesh of 4 000 000 000 elements".
        what: String,
        /// The limit in words.
        limit: String,
    },
}

/// Edges that are told where one is wanted.
const EDGES_SHOWN: usize = 4;

/// The lengths that are allowed. Lengths and points are model units.
#[derive(Clone, Debug, PartialEq)]
pub enum LengthRange {
    /// Above zero.
    Positive,
    /// Up to this, either way.
    Within(f64),
    /// Below a radius on one side, at this place where it changes along the curve.
    BelowRadius(f64, Option<DVec3>),
    /// So small that both sides of the corner here still meet.
    MeetsAtCorner(DVec3),
    /// So small that something is left of the side between these points.
    LeavesOfSide(DVec3, DVec3),
}

impl LengthRange {
    fn words(&self, say: &dyn Say) -> String {
        match self {
            Self::Positive => "above 0".to_owned(),
            Self::Within(limit) => format!("between -{0} and {0}", say.length(*limit)),
            Self::BelowRadius(radius, None) => format!("below the radius, {}, on this side", say.length(*radius)),
            Self::BelowRadius(radius, Some(at)) => {
                format!("below {} on this side, the curve's radius at {}", say.length(*radius), say.point(*at))
            }
            Self::MeetsAtCorner(at) => format!("small enough for both sides of the corner at {} to meet", say.point(*at)),
            Self::LeavesOfSide(from, to) => {
                let (from, to) = say.pair(*from, *to);
                format!("small enough to leave a part of the side from {from} to {to}")
            }
        }
    }
}

/// E306 in words.
fn outside(argument: &'static str, found: String, range: &str) -> Report {
    Report::new(format!("`{argument}` must be {range}, got {found}")).label(Subject::Argument(argument), found)
}

/// E305 with its arguments; the edit drops the last one.
fn exclusive(report: Report, arguments: &[&'static str]) -> Report {
    let report = arguments.iter().enumerate().fold(report, |report, (k, argument)| {
        report.label(Subject::Argument(argument), if k == 0 { "remove one of these" } else { "or this" })
    });
    match arguments.last() {
        Some(last) => report.edit(Subject::Argument(last), Edit::DropArgument),
        None => report,
    }
}

/// An edge among several that lie at one place.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgePlace {
    /// Its middle.
    pub middle: DVec3,
    /// The curve that it lies on; none where that has no name of its own.
    pub curve: Origin,
    /// The surfaces on it, each once.
    pub faces: Vec<Origin>,
}

/// E215 of edges: where each of several is, and what chooses one.
fn not_one_edge(say: &dyn Say, of: Origin, found: &[EdgePlace]) -> Report {
    let whole = say.quoted(of, "these faces");
    let message = match found.len() {
        0 => format!("no edge of {whole} lies there"),
        n => format!("{n} edges of {whole} lie there"),
    };
    let report = Report::new(message).label(Subject::Call, "asked for here");
    let shown = &found[..found.len().min(EDGES_SHOWN)];
    let middles: Vec<DVec3> = shown.iter().map(|edge| edge.middle).collect();
    let middles = say.points(&middles);
    let described = shown.iter().zip(&middles).map(|(edge, middle)| {
        let names: Vec<String> = edge.faces.iter().map(|face| say.quoted(*face, "a face")).collect();
        let on = if edge.curve.is_some() { format!(", on {}", say.quoted(edge.curve, "a curve")) } else { String::new() };
        let between = match names.as_slice() {
            _ if edge.faces == [of] => String::new(),
            [] => String::new(),
            [one] => format!(", a free edge of {one}"),
            [first, rest @ ..] => format!(", between {first}{}", rest.iter().map(|name| format!(" and {name}")).collect::<String>()),
        };
        format!("one has its middle at {middle}{on}{between}")
    });
    let report = described.fold(report, Report::note);
    let is_name = |name: &String| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || "_.[]".contains(c));
    let name = shown.iter().map(|edge| say.name(edge.curve)).find(is_name);
    let Some(key) = name.or_else(|| middles.first().map(|middle| typed_point(middle))) else { return report };
    report.help(format!("a curve or a point that lies on one of them alone: `edge({key})`")).edit(Subject::Argument("on"), Edit::Put(key))
}

impl Describe for ValueFault {
    codes! {
        OutsideRange "E306", LengthOutside "E306", OffsetTooFar "E306", NotItsPlane "E306", NotAcross "E306", Missing "E301", Exclusive "E305",
        NoLinks "E211", NoFaces "E211", WrongKind "E211", Mixed "E211", NotOneEdge "E215", NothingSelected "W728",
        NotMeshed "W224", OfNothing "W729", Raised "E903", NotInThisVersion "E230", Work "E217", StageWork "E217", RowWork "E217",
        Limit "E217", LooseBox "W227", RoughMeasure "W228"
    }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::OutsideRange { argument, found, range } => outside(argument, found.clone(), range),
            Self::LengthOutside { argument, found, range } => outside(argument, say.length(*found), &range.words(say)),
            Self::OffsetTooFar { found, range, most } => outside("distance", say.length(*found), &range.words(say))
                .help(format!("`{}` works, and is about the most on this side", typed(say, *most)))
                .edit(Subject::Argument("distance"), Edit::Put(typed(say, *most))),
            Self::NotItsPlane { argument, by } => {
                let found = format!("one whose plane the curve leaves by {}", say.length(*by));
                outside(argument, found, "the normal of a plane that contains the curve")
            }
            Self::NotAcross { argument, angle, to } => {
                outside(argument, format!("{} to it", say.angle(*angle)), &format!("at right angles to {to}"))
            }
            Self::Missing { function, what, example } => {
                Report::new(format!("`{function}` needs {what}")).label(Subject::Call, "missing here").help(*example)
            }
            Self::Exclusive { function, what, arguments, example } => {
                exclusive(Report::new(format!("`{function}` takes {what}")).help(*example), arguments)
            }
            Self::NoLinks { of } => {
                let message = format!("{} is construction geometry and has no links", say.quoted(*of, "this curve"));
                let report = Report::new(message).label(Subject::Call, "links are asked for here").at(*of, "made here");
                report.help("bind it with `curve`: then it joins the network")
            }
            Self::NoFaces { mesh } => Report::new(format!("`{mesh}` has no faces on surfaces")).label(Subject::Call, "asked for here"),
            Self::NotOneEdge { of, found } => not_one_edge(say, *of, found),
            Self::NothingSelected { of, keyword } => Report::new(format!("this selects nothing for the {keyword}"))
                .at(*of, "an empty list")
                .help("`report` what it selects from, or remove it"),
            Self::NotMeshed { of, group, meshes } => {
                let meshes: Vec<String> = meshes.iter().map(|mesh| format!("`{mesh}`")).collect();
                let message = format!("no member of the group `{group}` is in {}: no file has a set of it", meshes.join(" or "));
                Report::new(message).at(*of, "its members are not meshed").help("mesh its members too, or group what is meshed")
            }
            Self::OfNothing { of, function, result } => {
                Report::new(format!("`{function}` of an empty list is {result}: this check tests nothing"))
                    .at(*of, "an empty list")
                    .help("check that there is something first: `check len(list) > 0`")
            }
            Self::WrongKind { argument, wanted, found } => {
                Report::new(format!("`{argument}` takes {wanted}, got {found}")).label(Subject::Argument(argument), found.clone())
            }
            Self::Mixed { argument, found, beside } => {
                Report::new(format!("{found} beside {beside}")).label(Subject::Argument(argument), "these must be of one kind")
            }
            Self::Raised { message } => Report::new(message.clone()).label(Subject::Call, "raised here"),
            Self::NotInThisVersion { what } => Report::new(format!("{what} is not in this version")).label(Subject::Call, "asked for here"),
            Self::Work => Report::new("this call exceeds its work limit")
                .label(Subject::Call, "made here")
                .note("the limit of one call is fixed; `--max-work` does not change it")
                .help("use fewer or simpler parts; look for points that are far off by mistake"),
            Self::StageWork { what } => Report::new(format!("{what} exceeds its work limit"))
                .help("use fewer or simpler curves and surfaces; look for points that are far off by mistake"),
            Self::RowWork { of, what } => Report::new(format!("{what} exceeds its work limit"))
                .at(*of, "measured for the report")
                .help("use fewer or simpler parts; look for points that are far off by mistake"),
            Self::LooseBox { of, by, share } => {
                let (name, by) = (say.quoted(*of, "this surface"), say.length(*by));
                let message = format!("the box of {name} may be too large by up to {by}, {} % of its diagonal", decimals(share * 100.0, 4));
                Report::new(message)
                    .at(*of, "has more equally extreme places than are examined")
                    .help("it contains the surface; boxes of parts of it (`split`) are tighter")
            }
            Self::RoughMeasure { of, what, share } => {
                Report::new(format!("{what} of {} may be off by {share:.0e} of its value", say.quoted(*of, "this")))
                    .at(*of, format!("about {} digits hold", (-math::log10(*share)).floor().max(0.0)))
                    .help("a measure takes a limited amount of work: measure parts of it (`split`), or make it of fewer or smoother curves")
            }
            Self::Limit { what, limit } => {
                Report::new(format!("{what} exceeds its limit")).label(Subject::Call, "made here").help(format!("the limit is {limit}"))
            }
        }
    }
}
