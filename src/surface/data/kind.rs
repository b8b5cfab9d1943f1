//! The words of surfaces, and where their parameters may be.

use crate::surface::faults::Construction;

/// The word a surface was made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum SurfaceKind {
    Coons,
    Transfinite,
    Hermite,
    Ruled,
    Plane,
    Extrude,
    Revolve,
    Bezier,
    Nurbs,
    Grid,
    Fit,
    Offset,
    Trim,
    Gordon,
    Skin,
    Along,
    Sweep,
    Blend,
    Scatter,
    Join,
    Fill,
}

impl SurfaceKind {
    /// How it is made, for what helps where it folds.
    pub fn construction(self) -> Construction {
        match self {
            Self::Skin => Construction::Sections,
            Self::Extrude | Self::Revolve | Self::Along => Construction::Carried,
            _ => Construction::Curves,
        }
    }

    /// The word as scripts and reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Coons => "coons",
            Self::Transfinite => "transfinite",
            Self::Hermite => "hermite",
            Self::Ruled => "ruled",
            Self::Plane => "plane",
            Self::Extrude => "extrude",
            Self::Revolve => "revolve",
            Self::Bezier => "bezier_surface",
            Self::Nurbs => "nurbs_surface",
            Self::Grid => "grid",
            Self::Fit => "fit",
            Self::Offset => "offset",
            Self::Trim => "trim",
            Self::Gordon => "gordon",
            Self::Skin => "skin",
            Self::Along => "along",
            Self::Sweep => "sweep",
            Self::Blend => "blend",
            Self::Scatter => "scatter",
            Self::Join => "join",
            Self::Fill => "fill",
        }
    }
}

/// Where (u, v) may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// 0 ≤ u, v ≤ 1.
    Square,
    /// u, v ≥ 0 and u + v ≤ 1; barycentric (1 − u − v, u, v) over the vertices.
    Triangle,
    /// The part of 0 ≤ u, v ≤ 1 inside a loop of sides: a plane face that no map fits (not mapped in this version).
    Loop,
    /// All of the plane.
    Unbounded,
}

crate::content_of_word!(SurfaceKind, Domain);
