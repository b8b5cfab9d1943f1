//! Any mapped surface as a B-spline: exact where it is one, else within the tolerance, with a bound of what it is off.

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::data::fault::CurveFault;
use crate::surface::analysis::as_net::strips::Fit;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::DeviationFault;
use crate::surface::faults::SurfaceFault;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::Map;
use crate::surface::rails::side::between;
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::shapes::sweep::{Path, Sweep};
use crate::surface::swept::extrude;
use crate::surface::swept::revolve::{self, Axis};

pub mod blended;
pub mod carried;
pub mod family;
pub mod splines;
pub mod strips;

/// Strips each way of a net for scattered points at most.
const MOST_STRIPS: f64 = 128.0;
/// Degrees that are tried.
const DEGREES: [usize; 2] = [3, 5];
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
    /// Whether the form is the surface itself.
    pub fn is_exact(self) -> bool {
        matches!(self, Self::Exact)
    }

    /// Model units.
    pub fn distance(self) -> f64 {
        match self {
            Self::Exact => 0.0,
            Self::Bounded(off) | Self::Sampled(off) => off,
        }
    }

    /// And as far again, model units, within a bound.
    pub fn and(self, further: f64) -> Self {
        match self {
            Self::Exact if further == 0.0 => Self::Exact,
            Self::Exact | Self::Bounded(_) => Self::Bounded(self.distance() + further),
            Self::Sampled(off) => Self::Sampled(off + further),
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
        if let Some(net) = exact(&parts.shape) {
            return Ok(Some(self.turned(NetForm { net, off: Off::Exact })));
        }
        self.mapped(tolerance, false).map(Some)
    }

    /// The surface that its B-spline form is, within `tolerance.point`, and N677 with how far it is off where it is not exact.
    ///
    /// Fails with E676 for a surface without one net, a plane without a map or a trimmed one, and like [`Surface::to_net`].
    pub fn as_net(&self, origin: Origin, tolerance: &Tolerance) -> Result<(Self, Option<Fault>)> {
        let trimmed = self.parts().trim.is_some();
        match self.to_net(tolerance)? {
            Some(form) if !trimmed => {
                let fault = |off, proved| DeviationFault::AsNet { net: origin, surface: self.origin(), off, proved }.into();
                let note = match form.off {
                    Off::Exact => None,
                    Off::Bounded(off) => Some(fault(off, true)),
                    Off::Sampled(off) => Some(fault(off, false)),
                };
                Ok((form.net.surface(SurfaceKind::Nurbs, origin, tolerance), note))
            }
            _ => Err(SurfaceFault::NoNet { surface: self.origin(), trimmed }.into()),
        }
    }

    /// Degrees along u and v and counts of control points of a surface that is a B-spline.
    pub fn net_size(&self) -> Option<[(usize, usize); 2]> {
        match &self.parts().shape {
            Shape::Nurbs(net) => Some([net.degree, net.counts]),
            _ => None,
        }
    }

    /// The surface below a trimmed one as a rational B-spline in the same (u, v), within `tolerance.point`; `None` for a plane.
    ///
    /// Over a triangle (u, v) is the net's (u / (1 − v), v). Fails like [`Surface::to_net`].
    pub fn ground_net(&self, tolerance: &Tolerance) -> Result<Option<NetForm>> {
        let whole = self.untrimmed();
        if matches!(whole.parts().shape, Shape::Plane(_)) { Ok(None) } else { whole.mapped(tolerance, true).map(Some) }
    }

    /// A net within `tolerance.point` of the points at a distance along the normals of a smooth surface over a square.
    pub(crate) fn offset_net(&self, distance: f64, tolerance: &Tolerance) -> Result<NurbsSurface> {
        self.few_strips(tolerance)?;
        Fit::new(self, tolerance).beside(distance).run()
    }

    /// The exact net of an extruded or revolved surface between two values of v, by the parameter of its profile; `None` where the profile
    /// or the surface is none. Of a trimmed surface that of the whole one.
    pub fn swept_net(&self, v: (f64, f64), tolerance: &Tolerance) -> Option<NurbsSurface> {
        let parts = self.parts();
        let Shape::Sweep(sweep) = &parts.shape else { return None };
        let Rail::Chain { chain, map, .. } = sweep.profile() else { return None };
        let (from, to) = match (parts.domain, parts.flipped) {
            (Domain::Loop, _) => (0.0, 1.0),
            (_, true) => (1.0 - v.1, 1.0 - v.0),
            (_, false) => v,
        };
        let profile = between(chain, map.value(from), map.value(to), tolerance).ok()?;
        let net = exact(&Shape::Sweep(Sweep::new(Rail::new(profile, Map::identity()), sweep.path())))?;
        Some(self.turned(NetForm { net, off: Off::Exact }).net)
    }

    /// Within the tolerance, in the same (u, v) where it has to be.
    fn mapped(&self, tolerance: &Tolerance, same_uv: bool) -> Result<NetForm> {
        let within = SHARE * tolerance.point;
        let made = match &self.parts().shape {
            Shape::Nurbs(net) => Some(Ok(NetForm { net: net.clone(), off: Off::Exact })),
            Shape::Blend(blend) => blended::blended(blend, within),
            Shape::Framed(_) | Shape::Sweep(_) => carried::carried(self, within, same_uv),
            _ => None,
        };
        match made {
            Some(Ok(form)) => Ok(self.turned(form)),
            Some(Err((u, v))) => {
                let what = "the spline form of a surface".to_owned();
                Err(CurveFault::NotConverged { of: self.origin(), what, at: self.point(u, v) }.into())
            }
            None => {
                self.few_strips(tolerance)?;
                Ok(NetForm { net: Fit::new(self, tolerance).run()?, off: Off::Sampled(within) })
            }
        }
    }

    /// E413 where the sides of triangles would ask for more strips of a net than can be afforded.
    fn few_strips(&self, tolerance: &Tolerance) -> Result<()> {
        let Shape::Scatter(field) = &self.parts().shape else { return Ok(()) };
        let (strips, at) = field.strips(tolerance.point);
        if strips <= MOST_STRIPS {
            return Ok(());
        }
        let what = format!("the spline form of rough scattered points, with about {strips:.0} strips of pieces each way,");
        Err(CurveFault::NotConverged { of: self.origin(), what, at }.into())
    }

    /// From the shape's (u, v) to the surface's.
    fn turned(&self, form: NetForm) -> NetForm {
        if self.parts().flipped { NetForm { net: flipped(form.net), ..form } } else { form }
    }
}

/// The net of a profile that is moved straight, about an axis, or without a turn, where its own B-spline form is exact.
fn exact(shape: &Shape) -> Option<NurbsSurface> {
    match shape {
        Shape::Sweep(sweep) => {
            let profile = carried::exact(sweep.profile())?;
            Some(match sweep.path() {
                Path::Straight { by } => extrude::net(&profile, by),
                Path::Turn { about, axis, angle } => revolve::net(&profile, &Axis { about, direction: axis }, angle),
            })
        }
        Shape::Framed(framed) => {
            let (path, foot) = framed.translation()?;
            Some(carried::translated(&carried::exact(path)?, &carried::exact(framed.profile())?, foot))
        }
        _ => None,
    }
}

/// v backwards.
fn flipped(net: NurbsSurface) -> NurbsSurface {
    let poles = net.poles.chunks_exact(net.counts.0).rev().flatten().copied().collect();
    let knots = (net.knots.0.clone(), net.knots.1.iter().rev().map(|k| 1.0 - k).collect());
    NurbsSurface { poles, knots, ..net }
}
