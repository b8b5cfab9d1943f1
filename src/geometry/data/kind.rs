//! The words that curves are made with.

/// The word a curve was made with; what reports call its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Straight segment.
    Line,
    /// Straight segments in a row.
    Polyline,
    /// Part of a circle.
    Arc,
    /// Whole circle.
    Circle,
    /// Ellipse or a part of it.
    Ellipse,
    /// Conic section from its three control points and rho.
    Conic,
    /// Parabola.
    Parabola,
    /// Interpolating cubic spline.
    Spline,
    /// Bézier curve.
    Bezier,
    /// B-spline.
    Bspline,
    /// Rational B-spline.
    Nurbs,
    /// Helix.
    Helix,
    /// Offset of a plane curve.
    Offset,
    /// Several curves in a row.
    Composite,
    /// Line of constant u or v of a surface.
    Iso,
    /// Curve projected to a surface.
    Project,
    /// Curve in which surfaces meet.
    Meet,
    /// Curve through or near many points.
    Fit,
}

impl Kind {
    /// The word as scripts and reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Polyline => "polyline",
            Self::Arc => "arc",
            Self::Circle => "circle",
            Self::Ellipse => "ellipse",
            Self::Conic => "conic",
            Self::Parabola => "parabola",
            Self::Spline => "spline",
            Self::Bezier => "bezier",
            Self::Bspline => "bspline",
            Self::Nurbs => "nurbs",
            Self::Helix => "helix",
            Self::Offset => "offset",
            Self::Composite => "composite",
            Self::Iso => "iso",
            Self::Project => "project",
            Self::Meet => "meet",
            Self::Fit => "fit",
        }
    }
}

crate::content_of_word!(Kind);
