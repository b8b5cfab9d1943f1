//! One surface of any kind: what every caller above this floor works with.

use std::sync::Arc;

use glam::DVec3;

use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Motion;
use crate::network::Chain;

/// Point and derivatives up to order two at one (u, v).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet2 {
    /// The point.
    pub p: DVec3,
    /// ∂/∂u.
    pub du: DVec3,
    /// ∂/∂v.
    pub dv: DVec3,
    /// ∂²/∂u².
    pub duu: DVec3,
    /// ∂²/∂u∂v.
    pub duv: DVec3,
    /// ∂²/∂v².
    pub dvv: DVec3,
}

/// The word a surface was made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum SurfaceKind {
    Coons,
    Transfinite,
    Ruled,
    Plane,
    Extrude,
    Revolve,
    Bezier,
    Nurbs,
    Grid,
}

impl SurfaceKind {
    /// The word as scripts and reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Coons => "coons",
            Self::Transfinite => "transfinite",
            Self::Ruled => "ruled",
            Self::Plane => "plane",
            Self::Extrude => "extrude",
            Self::Revolve => "revolve",
            Self::Bezier => "bezier_surface",
            Self::Nurbs => "nurbs_surface",
            Self::Grid => "grid",
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
}

/// What lies along one side of the domain.
#[derive(Clone, Debug)]
pub enum Side {
    /// A chain, from the fraction at the side's lower corner to the one at its upper corner (`from > to`: the chain runs against the side).
    Chain {
        /// The modeling curve.
        chain: Chain,
        /// Fraction where the side begins (u or v ascending).
        from: f64,
        /// Fraction where it ends.
        to: f64,
    },
    /// The side is one point.
    Pole(DVec3),
    /// The side is joined to the opposite one (closed surface).
    Seam,
    /// A free border that no chain carries.
    Free,
}

/// A surface over its domain. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Surface(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    origin: Origin,
}

impl Surface {
    /// The expression that made it.
    pub fn origin(&self) -> Origin {
        self.0.origin
    }

    /// The same made by another expression.
    pub fn with_origin(&self, origin: Origin) -> Self {
        Self(Arc::new(Inner { origin }))
    }

    /// The word it was made with.
    pub fn kind(&self) -> SurfaceKind {
        SurfaceKind::Plane
    }

    /// Phrase of its flow (math.md section 7), for example "quadrilateral".
    pub fn flow(&self) -> String {
        String::new()
    }

    /// Square, or triangle for a uniform trilateral.
    pub fn domain(&self) -> Domain {
        Domain::Square
    }

    /// Whether u (first) and v (second) are periodic.
    pub fn closed(&self) -> (bool, bool) {
        (false, false)
    }

    /// Point and derivatives.
    pub fn jet(&self, u: f64, v: f64) -> Jet2 {
        let _ = (u, v);
        Jet2::default()
    }

    /// Point.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        self.jet(u, v).p
    }

    /// Unit normal `du × dv`; at a pole the limit; zero only where the surface is singular.
    pub fn normal(&self, u: f64, v: f64) -> DVec3 {
        let jet = self.jet(u, v);
        jet.du.cross(jet.dv).normalize_or_zero()
    }

    /// Points of the tensor grid `us × vs`, row by row (u fastest), curves evaluated once per row.
    pub fn grid(&self, us: &[f64], vs: &[f64], out: &mut [DVec3]) {
        for (row, &v) in out.chunks_mut(us.len()).zip(vs) {
            for (p, &u) in row.iter_mut().zip(us) {
                *p = self.point(u, v);
            }
        }
    }

    /// Interior values of u (first) and v (second) where the surface has a kink line, ascending.
    pub fn kinks(&self) -> (&[f64], &[f64]) {
        (&[], &[])
    }

    /// Sides in the order v = 0, u = 1, v = 1, u = 0 (a triangle: v = 0, the slant from (1, 0) to (0, 1), u = 0).
    ///
    /// Each runs with ascending u or v (the slant: ascending v).
    pub fn side(&self, k: usize) -> Side {
        let _ = k;
        Side::Free
    }

    /// Side parameter (u or v) at a fraction of the chain that lies along side `k`.
    pub fn side_parameter(&self, k: usize, fraction: f64) -> f64 {
        let _ = k;
        fraction
    }

    /// Inverse of [`Surface::side_parameter`]: fraction of the chain at a side parameter.
    pub fn side_fraction(&self, k: usize, parameter: f64) -> f64 {
        let _ = k;
        parameter
    }

    /// The modeling curves it stands on.
    pub fn chains(&self) -> &[Chain] {
        &[]
    }

    /// The same surface with its other side up: v runs backwards, so the normal turns.
    pub fn flipped(&self) -> Self {
        self.clone()
    }

    /// Carried by a motion, exactly.
    pub fn moved(&self, motion: &Motion) -> Self {
        let _ = motion;
        self.clone()
    }

    /// Warnings found while building (singular or folded patches, oscillation), by sampling 9×9 a cell.
    pub fn review(&self, tolerance: &Tolerance) -> Vec<crate::base::fault::Fault> {
        let _ = tolerance;
        Vec::new()
    }
}
