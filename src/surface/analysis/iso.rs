//! Lines of constant u or v as curves: exact where they have such a form, else fitted.

use std::sync::Arc;

use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::geometry::construct::build::line;
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::{Curve, Kind};
use crate::network::Chain;
use crate::surface::analysis::iso_fit;
use crate::surface::analysis::iso_line::IsoLine;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::side::{Side, between};
use crate::surface::shapes::blend::Blend;

impl Surface {
    /// The line of constant u or v as a curve with the same points: exact on borders and on the curves of a grid, on nets,
    /// extruded and revolved surfaces, and along the straight lines of a ruled one; elsewhere within a quarter of the
    /// tolerance, which is proved. `None` for a plane without a map.
    ///
    /// Fails with E401 where the line is one point, E413 where a fit is not to be had (a cusp below).
    pub fn iso(&self, at: IsoLine, origin: Origin, tolerance: &Tolerance) -> Result<Option<Curve>> {
        match self.domain() {
            Domain::Square => {}
            Domain::Triangle => return iso_fit::fitted(self, at, origin, tolerance).map(Some),
            Domain::Loop | Domain::Unbounded => return Ok(None),
        }
        let whole = |chain: Chain| chain.to_curve().map(|c| Some(c.with_origin(origin)));
        if let Some(chain) = self.along_border(at, origin, tolerance)? {
            return whole(chain);
        }
        let parts = self.parts();
        // From the surface's parameters to the shape's.
        let inner = match at {
            IsoLine::V(v) if parts.flipped => IsoLine::V(1.0 - v),
            other => other,
        };
        let found = match &parts.shape {
            Shape::Nurbs(net) => {
                let shape = CurveShape::Nurbs(Arc::new(net.iso(matches!(at, IsoLine::U(_)), inner.value())));
                Some(Curve::new(shape, Kind::Iso, origin))
            }
            Shape::Sweep(sweep) => Some(match inner {
                IsoLine::U(u) => match sweep.profile_at(u) {
                    Some(chain) => chain.to_curve()?,
                    None => return Ok(None),
                },
                IsoLine::V(v) => sweep.path_at(v, origin, tolerance)?,
            }),
            Shape::Blend(blend) => match on_grid(blend, inner, tolerance)? {
                Some(chain) => Some(chain.to_curve()?),
                None => match inner {
                    IsoLine::U(_) if blend.along_v().is_empty() && blend.along_u().len() == 2 => {
                        let turned = |t: f64| if parts.flipped { 1.0 - t } else { t };
                        let end = |t: f64| self.point(at.value(), turned(t));
                        Some(line(end(0.0), end(1.0), origin)?)
                    }
                    _ => None,
                },
            },
            Shape::Trilateral(_) | Shape::Plane(_) | Shape::Framed(_) | Shape::Scatter(_) | Shape::Joined(_) => None,
        };
        let Some(curve) = found else { return iso_fit::fitted(self, at, origin, tolerance).map(Some) };
        let length = curve.length();
        if length <= tolerance.point {
            return Err(CurveFault::ZeroLength { of: origin, length, tolerance: tolerance.point }.into());
        }
        let against = parts.flipped && matches!(at, IsoLine::U(_));
        Ok(Some(if against { curve.reversed() } else { curve }.with_origin(origin)))
    }

    /// The chain along a border, if the line is one; E401 for a pole.
    fn along_border(&self, at: IsoLine, origin: Origin, tolerance: &Tolerance) -> Result<Option<Chain>> {
        let k = match at {
            IsoLine::V(0.0) => 0,
            IsoLine::U(1.0) => 1,
            IsoLine::V(1.0) => 2,
            IsoLine::U(0.0) => 3,
            _ => return Ok(None),
        };
        let side = match self.side(k) {
            // A seam lies on the chain of the opposite side.
            Side::Seam => self.side((k + 2) % 4),
            side => side,
        };
        match side {
            Side::Chain { chain, from, to } => between(&chain, from, to, tolerance).map(Some),
            Side::Pole(_) => Err(CurveFault::ZeroLength { of: origin, length: 0.0, tolerance: tolerance.point }.into()),
            Side::Seam | Side::Free => Ok(None),
        }
    }
}

/// The curve of a grid that lies at this parameter.
fn on_grid(blend: &Blend, at: IsoLine, tolerance: &Tolerance) -> Result<Option<Chain>> {
    let (u, v) = blend.axes();
    let (nodes, rails) = match at {
        IsoLine::U(_) => (&u.nodes, blend.along_v()),
        IsoLine::V(_) => (&v.nodes, blend.along_u()),
    };
    let place = nodes.iter().position(|x| (x - at.value()).abs() <= EPSILON);
    match place.and_then(|i| rails.get(i)) {
        Some(Rail::Chain { chain, map, .. }) => between(chain, map.value(0.0), map.value(1.0), tolerance).map(Some),
        _ => Ok(None),
    }
}
