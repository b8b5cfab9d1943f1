//! Any mapped surface as a B-spline: exact where it is one, else within the tolerance, with a bound of what it is off.

mod blended;
mod family;
mod splines;
mod strips;

use super::core::{Domain, Surface};
use super::nurbs::NurbsSurface;
use super::revolve::Axis;
use super::shape::Shape;
use super::sweep::Path;
use super::{extrude, revolve};
use crate::base::fault::{CurveFault, Result};
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use strips::Fit;

/// Share of the tolerance that a net may be off: what is compared with it has a share of its own.
const SHARE: f64 = 0.9;

/// A surface as a B-spline.
#[derive(Clone, Debug)]
pub struct NetForm {
    /// The net over 0 ≤ u, v ≤ 1.
    pub net: NurbsSurface,
    /// How far it is from the surface, model units; 0 where they are the same.
    pub off: Off,
}

/// How far a net is from its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Off {
    /// It is the surface.
    Exact,
    /// Nowhere more, model units.
    Bounded(f64),
    /// Not more at the places looked at, model units.
    Sampled(f64),
}

impl Off {
    /// Model units.
    pub fn distance(self) -> f64 {
        match self {
            Self::Exact => 0.0,
            Self::Bounded(off) | Self::Sampled(off) => off,
        }
    }
}

impl Surface {
    /// The rational B-spline form; for sweeps exact as far as their profile is one, else within `tolerance.point`.
    ///
    /// A triangle becomes a net with one row in its last corner. `None` for planes without a map; fails with E413 where
    /// too many pieces would be needed.
    pub fn to_net(&self, tolerance: &Tolerance) -> Result<Option<NetForm>> {
        let parts = self.parts();
        if matches!(parts.domain, Domain::Loop | Domain::Unbounded) {
            return Ok(None);
        }
        if let Shape::Sweep(sweep) = &parts.shape
            && let Some(profile) = sweep.profile().chain()
        {
            let form = swept(profile, sweep.path(), tolerance)?;
            return Ok(Some(self.turned(form)));
        }
        self.mapped(tolerance).map(Some)
    }

    /// The surface below a trimmed one as a rational B-spline in the same (u, v), within `tolerance.point`; `None` for a plane.
    ///
    /// Over a triangle (u, v) is the net's (u / (1 − v), v). Fails like [`Surface::to_net`].
    pub fn ground_net(&self, tolerance: &Tolerance) -> Result<Option<NetForm>> {
        let whole = self.untrimmed();
        if matches!(whole.parts().shape, Shape::Plane(_)) { Ok(None) } else { whole.mapped(tolerance).map(Some) }
    }

    /// A net within `tolerance.point` of the points at a distance along the normals of a smooth surface over a square.
    pub(super) fn offset_net(&self, distance: f64, tolerance: &Tolerance) -> Result<NurbsSurface> {
        Fit::new(self, tolerance).beside(distance).run()
    }

    /// In the same (u, v).
    fn mapped(&self, tolerance: &Tolerance) -> Result<NetForm> {
        let within = SHARE * tolerance.point;
        let made = match &self.parts().shape {
            Shape::Nurbs(net) => Some(Ok(NetForm { net: net.clone(), off: Off::Exact })),
            Shape::Blend(blend) => blended::blended(blend, within),
            _ => None,
        };
        match made {
            Some(Ok(form)) => Ok(self.turned(form)),
            Some(Err((u, v))) => {
                let what = "the spline form of a surface".to_owned();
                Err(CurveFault::NotConverged { of: self.origin(), what, at: self.point(u, v) }.into())
            }
            None => Ok(NetForm { net: Fit::new(self, tolerance).run()?, off: Off::Sampled(within) }),
        }
    }

    /// From the shape's (u, v) to the surface's.
    fn turned(&self, form: NetForm) -> NetForm {
        if self.parts().flipped { NetForm { net: flipped(form.net), ..form } } else { form }
    }
}

fn swept(profile: &Chain, path: Path, tolerance: &Tolerance) -> Result<NetForm> {
    let curve = profile.to_curve()?;
    let off = if curve.is_spline() { Off::Exact } else { Off::Sampled(SHARE * tolerance.point) };
    let profile = curve.to_nurbs(tolerance)?;
    let net = match path {
        Path::Straight { by } => extrude::net(&profile, by),
        Path::Turn { about, axis, angle } => revolve::net(&profile, &Axis { about, direction: axis }, angle),
    };
    Ok(NetForm { net, off })
}

/// v backwards.
fn flipped(net: NurbsSurface) -> NurbsSurface {
    let poles = net.poles.chunks_exact(net.counts.0).rev().flatten().copied().collect();
    let knots = (net.knots.0.clone(), net.knots.1.iter().rev().map(|k| 1.0 - k).collect());
    NurbsSurface { poles, knots, ..net }
}
