//! Offsets of surfaces: exact where planes, cylinders, cones and sweeps have exact ones, else nets within a tenth of the tolerance.

use crate::base::bbox::Box3;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::io::cad::base_surface::Base;
use crate::io::cad::defect::{Defect, defect};
use crate::surface::{Surface, offset};

/// Share of the tolerance that an offset may be off: its areas are to be found again.
const FINE: f64 = 0.1;

impl Base {
    /// The surface at a distance along the normals of [`Base::surface`], of a cylinder or cone away from its axis, and whether it turns
    /// back over itself somewhere. Model units.
    ///
    /// Fails where the surface has creases or tips, or where nothing is left of it.
    pub fn beside(self, distance: f64, reach: &Box3, origin: Origin, tolerance: &Tolerance) -> Result<(Self, bool), Defect> {
        if !distance.is_finite() {
            return Err(defect("its distance is not a number"));
        }
        let fine = Tolerance { point: FINE * tolerance.point, ..*tolerance };
        let (range, surface) = match &self {
            _ if distance == 0.0 => return Ok((self, false)),
            Self::Plane(at, u, v) => return Ok((Self::Plane(*at + u.cross(*v) * distance, *u, *v), false)),
            Self::Unbounded { axis, radius, slope, reference } => {
                let radius = radius + distance * (1.0 + slope * slope).sqrt();
                if radius <= 0.0 && *slope == 0.0 {
                    return Err(defect("its offset turns it inside out"));
                }
                return Ok((Self::Unbounded { axis: *axis, radius, slope: *slope, reference: *reference }, false));
            }
            Self::Net(_, range) => (*range, self.surface(reach, origin, tolerance)?),
            _ => (NO_RANGE, self.surface(reach, origin, &fine)?),
        };
        let (made, folds) = offset(&surface, distance, origin, &fine)?;
        let net = match made.swept_net((0.0, 1.0), &fine) {
            Some(net) => net,
            None => made.to_net(&fine)?.ok_or_else(|| defect("its offset has no net"))?.net,
        };
        Ok((Self::Net(net, range), !folds.is_empty()))
    }

    /// The unit normal of its surface value in the middle of its parameters; zero where there is none.
    pub fn upright(&self, reach: &Box3, origin: Origin, tolerance: &Tolerance) -> Result<glam::DVec3, Defect> {
        match self {
            Self::Plane(_, u, v) => Ok(u.cross(*v)),
            Self::Unbounded { reference, .. } => Ok(-*reference),
            _ => Ok(self.surface(reach, origin, tolerance).map(|surface: Surface| surface.normal(0.5, 0.5))?),
        }
    }
}

/// Parameters of the file that the net does not have in proportion.
const NO_RANGE: [f64; 4] = [f64::NAN; 4];
