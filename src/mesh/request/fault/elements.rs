//! Elements that are wrong: inverted, overlapping or coincident ones.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;
use crate::base::text::decimals;

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

/// What is wrong with elements of a face. Angles are radians.
#[derive(Clone, Debug, PartialEq)]
pub enum ElementFault {
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
}

impl Describe for ElementFault {
    codes! { Inverted "E715", Folded "E718", ClosesTooNear "E720", FallTogether "E720", Unsound "E999" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Inverted { surface, count, uv, at, free } => Report::new(format!(
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
            Self::Folded { surface, method, at, turn } => {
                let (name, at) = (say.quoted(*surface, "a face"), say.point(*at));
                let why = match turn {
                    Some(turn) => format!("{name} folds over at {at}, where its normal turns by {}", say.angle(*turn)),
                    None => format!("{name} has no normal at {at}"),
                };
                Report::new(format!("{why}: elements of `method: {method}` overlap there"))
                    .at(*surface, "this face")
                    .help("add a curve across the fold, or divide the surface in two")
            }
            Self::ClosesTooNear { surface, method, at, close: Close::Turn } => Report::new(format!(
                "a border of {} turns back along itself at {}, where elements of `method: {method}` would coincide",
                say.quoted(*surface, "a face"),
                say.point(*at)
            ))
            .at(*surface, "this face")
            .help("move the points of that border so that it does not turn back, or set a smaller `size`"),
            Self::ClosesTooNear { surface, method, at, close } => Report::new(format!(
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
            Self::FallTogether { surfaces: [first, second], at } => Report::new(format!(
                "{} and {} coincide at {}: both would have the same edge or element there",
                say.quoted(*first, "a face"),
                say.quoted(*second, "another face"),
                say.point(*at)
            ))
            .at(*first, "this face")
            .at(*second, "and this one have the same nodes there")
            .help("a `count` of 2 or more on the borders near that place, or a smaller `size`"),
            Self::Unsound { mesh: (mesh, name), surface, method, elements: [triangles, quads], what, at } => Report::new(format!(
                "a bug in loft: the mesh `{name}` is wrong on {}: {what}, at {}",
                say.quoted(*surface, "a face"),
                say.point(*at)
            ))
            .at(*mesh, "this mesh was not made")
            .at(*surface, format!("this face, {triangles} triangles and {quads} quads of `method: {method}`"))
            .help("please report it with this script; another `method` or `size` may work meanwhile"),
        }
    }
}
