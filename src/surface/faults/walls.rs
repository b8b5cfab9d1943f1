//! Family 6: offsets of surfaces that are not smooth, and walls.

use glam::DVec3;

use crate::base::fault::{Describe, Report, Say, codes};
use crate::base::origin::Origin;

/// Why the walls of two faces do not meet at their edge. Lengths in model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WallEdge {
    /// Three faces have it.
    Three,
    /// It is a part of a longer border.
    Part,
    /// It is sharp at some places and smooth at others, or a ridge and a valley.
    Mixed,
    /// The moved faces meet nowhere.
    Apart {
        /// How far they were moved.
        distance: f64,
    },
    /// The moved edges of a corner do not meet in a point.
    Corner,
    /// Two borders that run beside each other are no one edge.
    Gap {
        /// How far they are apart.
        apart: f64,
    },
    /// The faces belong to pieces that do not hang together, and their wall is to be on one side.
    Loose,
    /// Nothing is left of an edge or a face.
    Gone {
        /// How far the faces were moved.
        distance: f64,
    },
}

/// What can go wrong with an offset or a wall. Lengths and points are in model units, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub enum WallFault {
    /// E670: the surface has a crease.
    Creased {
        /// The offset.
        offset: Origin,
        /// The surface.
        surface: Origin,
        /// Where the normals jump most.
        at: DVec3,
        /// By how much.
        angle: f64,
    },
    /// E670: the surface has a tip.
    Tip {
        /// The offset.
        offset: Origin,
        /// The surface.
        surface: Origin,
        /// The tip.
        at: DVec3,
    },
    /// E670: the surface is made of pieces between which its curvature jumps.
    Pieces {
        /// The offset.
        offset: Origin,
        /// The surface.
        surface: Origin,
    },
    /// E671: the walls of two faces do not meet.
    Edge {
        /// The wall.
        wall: Origin,
        /// One face.
        a: Origin,
        /// The other one; the same for a border of one face.
        b: Origin,
        /// A place of the edge.
        at: DVec3,
        /// What is wrong with it.
        why: WallEdge,
    },
}

impl Describe for WallFault {
    codes! { Creased "E670", Tip "E670", Pieces "E670", Edge "E671" }

    fn describe(&self, say: &dyn Say) -> Report {
        match self {
            Self::Creased { offset, surface, at, angle } => {
                Report::new(format!("{} has a crease of {} at {}", say.quoted(*surface, "the surface"), say.angle(*angle), say.point(*at)))
                    .at(*surface, "its normals jump there")
                    .at(*offset, "is not unique at the crease")
                    .help("build two surfaces that meet at the crease, each from the parts of the curves on its side, and offset each")
            }
            Self::Tip { offset, surface, at } => {
                Report::new(format!("{} has a tip at {}", say.quoted(*surface, "the surface"), say.point(*at)))
                    .at(*surface, "its normals have no common limit there")
                    .at(*offset, "is not unique at the tip")
                    .help("cut the tip off first, `trim(s, by: …, keep: …)`")
            }
            Self::Pieces { offset, surface } => {
                let name = say.quoted(*surface, "the surface");
                Report::new(format!("{name} is made of triangles, and its curvature jumps between them: its offset has no net"))
                    .at(*surface, "made of triangles")
                    .at(*offset, "has no smooth offset")
                    .help("build a net first: `grid` through rows of its points")
            }
            Self::Edge { wall, a, b, at, why } => edge((*a, *b), *at, *why, say).both(*a, *b, "this face").at(*wall, "asked for here"),
        }
    }
}

fn edge((a, b): (Origin, Origin), at: DVec3, why: WallEdge, say: &dyn Say) -> Report {
    let (x, y, place) = (say.quoted(a, "one face"), say.quoted(b, "another"), say.point(at));
    match why {
        WallEdge::Gap { apart } => {
            Report::new(format!("borders of {x} and {y} are {} apart at {place}: walls join where faces share an edge", say.length(apart)))
                .help("build both on the same curve, or set a larger `tolerance`")
        }
        WallEdge::Loose => Report::new(format!("{x} and {y} are not connected: the side of the wall on {y} is not determined, at {place}"))
            .help("make a shell of each connected piece, or set `side: both`"),
        WallEdge::Three => {
            Report::new(format!("{x} and {y} share the edge at {place} with a third face: which walls meet there is ambiguous"))
                .help("thicken the faces on one side of the edge first, then the others")
        }
        WallEdge::Part => Report::new(format!("{x} and {y} share a part of a border at {place}, not a whole edge"))
            .help("divide the longer border where the shorter one ends, `split(s, by: …)`"),
        WallEdge::Mixed => Report::new(format!("the edge of {x} and {y} is sharp at some places and smooth at others, as at {place}"))
            .help("divide both faces there, `split(s, by: …)`"),
        WallEdge::Apart { distance } => {
            Report::new(format!("the offsets of {x} and {y} by {} do not meet near their edge at {place}", say.length(distance.abs())))
                .help("a thinner wall, or faces at an angle farther from 180°")
        }
        WallEdge::Corner => Report::new(format!("the walls at the corner {place} of {x} and {y} do not meet in one point"))
            .help("let borders cross edges at right angles, and no more than three faces meet in a corner"),
        WallEdge::Gone { distance } => {
            Report::new(format!("nothing is left of the offset of {x} near {place} at a distance of {}", say.length(distance.abs())))
                .help("a thinner wall, or one on the other side, `side:`")
        }
    }
}
