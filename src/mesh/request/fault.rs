//! Family 7: meshes.

use glam::DVec3;

use crate::base::fault::quantities::typed;
use crate::base::fault::{Code, Describe, Edit, Report, Say, Subject};
use crate::base::origin::Origin;
use crate::base::text::decimals;

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

/// How a face meets itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Close {
    /// Along a seam.
    Seam,
    /// At a tip, which is as narrow for elements of every size.
    Tip,
    /// A border turns back along itself.
    Turn,
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

/// A limit of a mesh, by its setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshLimit {
    /// Length of edges.
    Size,
    /// Distance of elements from their surface.
    ChordError,
    /// Turn of the normal over an element.
    AngleError,
}

impl MeshLimit {
    /// The word of the setting.
    pub fn word(self) -> &'static str {
        match self {
            Self::Size => "size",
            Self::ChordError => "chord_error",
            Self::AngleError => "angle_error",
        }
    }
}

impl std::fmt::Display for MeshLimit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.word())
    }
}

/// What can go wrong with a mesh or deserves a word. Lengths are model units, angles radians.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshFault {
    /// W701: a rule without effect.
    RuleUnused {
        /// The clause.
        rule: Origin,
        /// Why, in words: "`south` is on no face of this mesh".
        why: String,
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
    /// E702: two written counts on opposite sides differ, or no counts make the sides equal.
    CountsDiffer {
        /// Elements along one side and what says so.
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
    CountTooCoarse {
        /// The count and its expression.
        count: (u32, Origin),
        /// The setting it breaks.
        limit: MeshLimit,
        /// The expression of that setting.
        says: Origin,
        /// The least count that keeps it.
        needed: u32,
        /// Where it is broken.
        at: DVec3,
    },
    /// E703: a written count below what the shape of a face needs (a ring, a lens).
    CountTooFew {
        /// The count and its expression.
        count: (u32, Origin),
        /// The least count that works.
        needed: u32,
        /// Where.
        at: DVec3,
    },
    /// E703: counts of chains that are fewer than their links.
    CountBelowLinks {
        /// The count and its expression.
        count: (u32, Origin),
        /// How many links (stretches between corners) there are.
        links: u32,
    },
    /// E704: triangles that cannot be avoided.
    QuadsImpossible {
        /// The mesh.
        mesh: Origin,
        /// Surface, number of triangles, place.
        places: Vec<(Origin, u64, DVec3)>,
    },
    /// E704: counts that make the border of quads that no map gives odd in all.
    OddCount {
        /// The count and its expression; none where other faces alone are behind it.
        count: (u32, Origin),
        /// The surface.
        surface: Origin,
        /// A point of the border that needs an even count.
        at: DVec3,
    },
    /// E704: a method that makes triangles only.
    TrianglesOnly {
        /// The mesh or rule that asks for quads.
        of: Origin,
        /// The method.
        method: &'static str,
        /// The surface.
        surface: Origin,
        /// A point of the face.
        at: DVec3,
    },
    /// E705: a face that the mapped method cannot do.
    CannotMap {
        /// The surface.
        surface: Origin,
        /// Why, in words.
        why: String,
        /// A point of the face.
        at: DVec3,
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
    /// E707: a size below the floor of all sizes.
    BelowFloor {
        /// The size and its expression.
        size: (f64, Origin),
        /// The floor and its expression.
        floor: (f64, Origin),
    },
    /// E707: a limit that the floor of the size keeps from being met.
    FloorKeeps {
        /// The setting.
        limit: MeshLimit,
        /// Its expression.
        says: Origin,
        /// The floor and its expression.
        floor: (f64, Origin),
        /// The size that the limit needs.
        needed: f64,
        /// Where.
        at: DVec3,
    },
    /// E715: elements that are turned over or have no area.
    Inverted {
        /// The surface.
        surface: Origin,
        /// How many.
        count: u64,
        /// The first one's middle, u and v.
        uv: (f64, f64),
        /// Where in space.
        at: DVec3,
        /// The face is made freely, of quads.
        free: bool,
    },
    /// E713: borders of a face that cross or touch once they are divided.
    BordersCross {
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
        /// The size of the face, model units.
        size: f64,
    },
    /// E716: a quadtree over a face would need more levels than it may have.
    TreeTooDeep {
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
        /// The levels it may have.
        levels: u8,
    },
    /// E714: a face with nothing inside its border.
    FaceEmpty {
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
    },
    /// E999: elements that are not what their face asks for, whatever that was.
    Unsound {
        /// The mesh and its name.
        mesh: (Origin, String),
        /// The surface.
        surface: Origin,
        /// How the face was made: `mapped`, `delaunay`, …
        method: &'static str,
        /// Triangles and quads of the face.
        elements: [u64; 2],
        /// What is wrong, in words that follow "a face where".
        what: String,
        /// Where.
        at: DVec3,
    },
    /// E718: a face that folds over, whose elements do not lie side by side.
    Folded {
        /// The surface.
        surface: Origin,
        /// How the face was made.
        method: &'static str,
        /// Where it folds.
        at: DVec3,
        /// By how much its normal turns there; `None` where it has none.
        turn: Option<f64>,
    },
    /// E720: a face that closes on itself, whose elements do not keep apart there.
    ClosesTooNear {
        /// The surface.
        surface: Origin,
        /// How the face was made.
        method: &'static str,
        /// Where.
        at: DVec3,
        /// How it closes there.
        close: Close,
    },
    /// E720 of two faces: an element or an edge inside one is that of the other.
    FallTogether {
        /// The surfaces; twice the same for two faces of one.
        surfaces: [Origin; 2],
        /// Where.
        at: DVec3,
    },
    /// E703 without a count: an edge glued so far beside a face that no step keeps the chord error.
    GapTooWide {
        /// How far the edge is from the surface, model units.
        gap: f64,
        /// The chord error with its expression.
        limit: (f64, Origin),
        /// The surface.
        surface: Origin,
        /// Where.
        at: DVec3,
    },
    /// E703 without a count: a limit that is still broken after the last refinement.
    NotReached {
        /// The setting.
        limit: MeshLimit,
        /// Its expression.
        says: Origin,
        /// The surface.
        surface: Origin,
        /// What was reached.
        reached: f64,
        /// Where it is broken.
        at: DVec3,
    },
}

fn steps(n: u32) -> String {
    if n == 1 { "1 element".to_owned() } else { format!("{n} elements") }
}

/// The verb behind [`steps`].
fn is(n: u32) -> &'static str {
    if n == 1 { "is" } else { "are" }
}

impl Describe for MeshFault {
    fn code(&self) -> Code {
        Code(match self {
            Self::RuleUnused { .. } => "W701",
            Self::SetInPart { .. } => "E672",
            Self::TooMany { .. } | Self::TooMuchWork { .. } | Self::TooManySteps { .. } => "E217",
            Self::CountsDiffer { .. } | Self::SidesDoNotClose { .. } => "E702",
            Self::CountTooCoarse { .. }
            | Self::CountTooFew { .. }
            | Self::CountBelowLinks { .. }
            | Self::GapTooWide { .. }
            | Self::NotReached { .. } => "E703",
            Self::QuadsImpossible { .. } | Self::OddCount { .. } | Self::TrianglesOnly { .. } => "E704",
            Self::CannotMap { .. } => "E705",
            Self::RuleOverridden { .. } => "W706",
            Self::Lost { .. } => "W725",
            Self::Sharp { .. } => "W724",
            Self::BelowFloor { .. } | Self::FloorKeeps { .. } => "E707",
            Self::Inverted { .. } => "E715",
            Self::BordersCross { .. } => "E713",
            Self::TreeTooDeep { .. } => "E716",
            Self::FaceEmpty { .. } => "E714",
            Self::Unsound { .. } => "E999",
            Self::Folded { .. } => "E718",
            Self::ClosesTooNear { .. } | Self::FallTogether { .. } => "E720",
        })
    }

    fn describe(&self, say: &dyn Say) -> Report {
        describe_rules(self, say).unwrap_or_else(|| describe_faces(self, say))
    }
}

/// A count in words: beyond sense the digits tell nothing.
fn many(count: u64) -> String {
    const SENSE: u64 = 1_000_000_000_000_000;
    if count > SENSE { "more than 1e15".to_owned() } else { count.to_string() }
}

/// Counts and rules.
fn describe_rules(fault: &MeshFault, say: &dyn Say) -> Option<Report> {
    use MeshFault as F;
    Some(match fault {
        F::RuleUnused { rule, why } => Report::new(format!("this rule has no effect: {why}"))
            .at(*rule, "this rule")
            .help("remove it")
            .edit(Subject::Entity(*rule), Edit::DropRule(None)),
        F::SetInPart { group, mesh, curve, at } => {
            let (set, curve) = (say.quoted(*group, "a group"), say.quoted(*curve, "a curve"));
            Report::new(format!("{set} would contain only a part of {curve}, which ends inside a border at {}", say.point(*at)))
                .at(*group, "this group")
                .at(*mesh, "has no node where the curve ends")
                .help(format!("list {curve} in the mesh too, so that its ends become nodes"))
        }
        F::TooMany { of, name, elements, limit } => {
            let size = elements.map_or_else(|| format!("more than {}", many(*limit)), many);
            Report::new(format!("the mesh `{name}` would have {size} elements"))
                .at(*of, "asked for here")
                .help(format!("use a larger value; the limit is {limit} elements, `--max-elements` sets another"))
        }
        F::TooMuchWork { of, name, surface } => {
            let report = Report::new(format!("the mesh `{name}` exceeds its work limit")).at(*of, "asked for here");
            let most = format!("most of it is used for {}", say.quoted(*surface, "this face"));
            let report = if surface.is_some() { report.at(*surface, most) } else { report };
            report
                .note("this limit follows from the number of elements; `--max-work` does not change it")
                .help("use a value that suits the size of the face; look for points that are far off by mistake")
        }
        F::TooManySteps { of, name, limit } => Report::new(format!("the mesh `{name}` has too many steps along a border"))
            .at(*of, "asked for here")
            .help(format!("use fewer steps; the limit is {limit} from corner to corner")),
        F::CountsDiffer { a, b, surface, at } => {
            let mut report = Report::new("a mapped face needs equal counts on opposite edges");
            for (count, origin) in [a, b] {
                if origin.is_some() {
                    report = report.at(*origin, steps(*count)).edit(Subject::Entity(*origin), Edit::DropSetting);
                }
            }
            report
                .at(*surface, "the face between them")
                .note(format!("{} on one side, {} on the other, of the face at {}", steps(a.0), steps(b.0), say.point(*at)))
                .help("drop one of the two")
        }
        F::SidesDoNotClose { counts, written, surface } => {
            let [a, b, c] = counts;
            let mut report =
                Report::new(format!("no quads fill a face with {a}, {b} and {c} elements on its three sides")).at(*surface, "this face");
            for (count, origin) in written {
                report = report.at(*origin, steps(*count)).edit(Subject::Entity(*origin), Edit::DropSetting);
            }
            report
                .note("the sum must be even, and each side must have fewer elements than the other two together")
                .help("drop one of the counts, or say `elements: triangles` with equal counts")
        }
        F::CountTooCoarse { count, limit, says, needed, at } => {
            Report::new(format!("{} {} too coarse for `{limit}` at {}", steps(count.0), is(count.0), say.point(*at)))
                .at(count.1, steps(count.0))
                .at(*says, format!("asks for at least {needed}"))
                .help(format!("count: {needed}"))
                .edit(Subject::Entity(count.1), Edit::Put(needed.to_string()))
        }
        F::CountTooFew { count, needed, at } => Report::new(format!("with {}, edges would coincide at {}", steps(count.0), say.point(*at)))
            .at(count.1, steps(count.0))
            .note("a closed curve needs at least 3 elements; of two curves with the same ends, the longer needs at least 2")
            .help(format!("count: {needed}"))
            .edit(Subject::Entity(count.1), Edit::Put(needed.to_string())),
        F::CountBelowLinks { count, links } => Report::new(format!("{} {} too few for {links} links", steps(count.0), is(count.0)))
            .at(count.1, steps(count.0))
            .help(format!("count: {links}"))
            .edit(Subject::Entity(count.1), Edit::Put(links.to_string())),
        F::RuleOverridden { key, earlier, later } => {
            Report::new(format!("`{key}` is set twice for the same part of the mesh; the later rule applies"))
                .at(*earlier, "has no effect")
                .at(*later, "applies")
                .help("remove the first of the two")
                .edit(Subject::Entity(*earlier), Edit::DropRule(Some(key)))
        }
        F::Sharp { of, name, angle, at, surface, faces, cure } => {
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
        F::Lost { of, name, what, length, at, more } => lost(say, (*of, name), *what, (*length, *at, *more)),
        F::BelowFloor { size, floor } => {
            Report::new(format!("the size {} is below `min_size`, {}", say.length(size.0), say.length(floor.0)))
                .at(size.1, "below the minimum")
                .at(floor.1, "the smallest size allowed")
                .help(format!("lower `min_size` to {} or less", say.length(size.0)))
        }
        F::FloorKeeps { limit, says, floor, needed, at } => {
            let (place, size) = (say.point(*at), say.length(*needed));
            Report::new(format!("`min_size` prevents `{limit}` at {place}, which needs edges of {size}"))
                .at(*says, format!("needs {size}"))
                .at(floor.1, format!("edges are at least {}", say.length(floor.0)))
                .help(format!("`min_size` below {size}, or a larger `{limit}`"))
        }
        F::NotReached { limit, says, surface, reached, at } => {
            let reached = match *limit {
                _ if !reached.is_finite() => "no finite bound was found".to_owned(),
                MeshLimit::AngleError => say.angle(*reached),
                _ => say.length(*reached),
            };
            Report::new(format!("`{limit}` cannot be kept on {}: {reached} at {}", say.quoted(*surface, "a face"), say.point(*at)))
                .at(*says, "not kept")
                .at(*surface, "this face")
                .help(format!("raise `{limit}`"))
        }
        F::GapTooWide { gap, limit, surface, at } => {
            let off = say.length(*gap);
            let whose = say.quoted(*surface, "a face");
            Report::new(format!("`chord_error` cannot be kept on {whose}: an edge glued to it is {off} away at {}", say.point(*at)))
                .at(limit.1, format!("{} is not above the gap", say.length(limit.0)))
                .at(*surface, "this face")
                .help(format!("a `chord_error` well above {off}"))
        }
        _ => return None,
    })
}

/// Faces and elements.
fn describe_faces(fault: &MeshFault, say: &dyn Say) -> Report {
    use MeshFault as F;
    match fault {
        F::QuadsImpossible { mesh, places } => {
            let total: u64 = places.iter().map(|p| p.1).sum();
            let triangles = if total == 1 { "element must be a triangle" } else { "elements must be triangles" };
            let mut report =
                Report::new(format!("`elements: quads` is impossible here: {total} {triangles}")).at(*mesh, "`elements: quads`");
            for (surface, count, at) in places.iter().take(8) {
                let plural = if *count == 1 { "" } else { "s" };
                report = report.at(*surface, format!("{count} triangle{plural} at {}", say.point(*at)));
            }
            report.help("elements: mixed").edit(Subject::Entity(*mesh), Edit::Set("elements", "mixed".to_owned()))
        }
        F::OddCount { count, surface, at } => {
            let mut report = Report::new(format!("`elements: quads` is impossible here: an odd number of steps at {}", say.point(*at)));
            if count.1.is_some() {
                let even = (count.0 + 1).to_string();
                report = report.at(count.1, steps(count.0)).help(format!("count: {even}")).edit(Subject::Entity(count.1), Edit::Put(even));
            }
            report.at(*surface, "is meshed freely, so its border needs an even number of steps in all")
        }
        F::TrianglesOnly { of, method, surface, at } => {
            Report::new(format!("`elements: quads` is impossible here: `method: {method}` makes triangles, at {}", say.point(*at)))
                .at(*of, "`elements: quads`")
                .at(*surface, "this face")
                .help("method: delaunay")
        }
        F::CannotMap { surface, why, at } => {
            Report::new(format!("{} cannot be mapped at {}: {why}", say.quoted(*surface, "a face"), say.point(*at)))
                .at(*surface, "this face")
        }
        F::Inverted { surface, count, uv, at, free } => Report::new(format!(
            "{count} {} inverted or without area in {}, the first at {} (u {}, v {})",
            if *count == 1 { "element is" } else { "elements are" },
            say.quoted(*surface, "a face"),
            say.point(*at),
            decimals(uv.0, 3),
            decimals(uv.1, 3)
        ))
        .at(*surface, if *free { "has no room for convex quads there" } else { "folds there" })
        .help(if *free {
            "a smaller `size` or a larger `count` on the borders there, or `elements: mixed`"
        } else {
            "add a curve across the fold, or divide the surface in two"
        }),
        F::BordersCross { surface, at, size } => Report::new(format!(
            "borders of {} divided into steps of {} cross or touch at {}",
            say.quoted(*surface, "a face"),
            say.length(*size),
            say.point(*at)
        ))
        .at(*surface, "this face")
        .help("move the borders further apart, or divide them more finely there"),
        F::Folded { surface, method, at, turn } => {
            let (name, at) = (say.quoted(*surface, "a face"), say.point(*at));
            let why = match turn {
                Some(turn) => format!("{name} folds over at {at}, where its normal turns by {}", say.angle(*turn)),
                None => format!("{name} has no normal at {at}"),
            };
            Report::new(format!("{why}: elements of `method: {method}` overlap there"))
                .at(*surface, "this face")
                .help("add a curve across the fold, or divide the surface in two")
        }
        F::ClosesTooNear { surface, method, at, close: Close::Turn } => Report::new(format!(
            "a border of {} turns back along itself at {}, where elements of `method: {method}` would coincide",
            say.quoted(*surface, "a face"),
            say.point(*at)
        ))
        .at(*surface, "this face")
        .help("move the points of that border so that it does not turn back, or set a smaller `size`"),
        F::ClosesTooNear { surface, method, at, close } => Report::new(format!(
            "{} closes on itself at {}, where elements of `method: {method}` would coincide",
            say.quoted(*surface, "a face"),
            say.point(*at)
        ))
        .at(*surface, "this face")
        .help(match *method {
            "mapped" => "a smaller `size`",
            _ if *close == Close::Tip => "`method: mapped` meshes the tip in rows",
            _ => "a smaller `size`, or `method: mapped`",
        }),
        F::FallTogether { surfaces: [first, second], at } => Report::new(format!(
            "{} and {} coincide at {}: both would have the same edge or element there",
            say.quoted(*first, "a face"),
            say.quoted(*second, "another face"),
            say.point(*at)
        ))
        .at(*first, "this face")
        .at(*second, "and this one have the same nodes there")
        .help("a `count` of 2 or more on the borders near that place, or a smaller `size`"),
        F::Unsound { mesh: (mesh, name), surface, method, elements: [triangles, quads], what, at } => Report::new(format!(
            "a bug in loft: the mesh `{name}` is wrong on {}: {what}, at {}",
            say.quoted(*surface, "a face"),
            say.point(*at)
        ))
        .at(*mesh, "this mesh was not made")
        .at(*surface, format!("this face, {triangles} triangles and {quads} quads of `method: {method}`"))
        .help("please report it with this script; another `method` or `size` may work meanwhile"),
        F::TreeTooDeep { surface, at, levels } => {
            Report::new(format!("the quadtree of {} needs more than {levels} levels at {}", say.quoted(*surface, "a face"), say.point(*at)))
                .at(*surface, "has a piece of border there shorter than a millionth of the size")
                .help("method: delaunay")
        }
        F::FaceEmpty { surface, at } => {
            Report::new(format!("{} has nothing inside its border at {}", say.quoted(*surface, "a face"), say.point(*at)))
                .at(*surface, "this face")
        }
        // Answered by the table above; listed so that a new fault cannot be forgotten.
        F::RuleUnused { .. }
        | F::SetInPart { .. }
        | F::TooMany { .. }
        | F::TooManySteps { .. }
        | F::TooMuchWork { .. }
        | F::CountsDiffer { .. }
        | F::SidesDoNotClose { .. }
        | F::CountTooCoarse { .. }
        | F::CountTooFew { .. }
        | F::CountBelowLinks { .. }
        | F::RuleOverridden { .. }
        | F::Sharp { .. }
        | F::Lost { .. }
        | F::BelowFloor { .. }
        | F::FloorKeeps { .. }
        | F::GapTooWide { .. }
        | F::NotReached { .. } => Report::new("a fault that another table has words for"),
    }
}

/// The report of a part that is too small for its mesh: its length, place, and how many others there are.
fn lost(say: &dyn Say, (of, mesh): (Origin, &str), what: LostPart, (length, at, more): (f64, DVec3, usize)) -> Report {
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
