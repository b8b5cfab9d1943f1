//! Planes by their frame: unbounded, whole squares of faces, faces without a map.

use crate::network::fault::GridFault;
use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::data::fault::CurveFault;
use crate::network::Chain;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::{BorderFault, LoopRole};
use crate::surface::rails::boundary::{Step, end, samples, start, walked};
use crate::surface::rails::side::{Border, Side};
use crate::surface::shapes::frame::Frame;

/// The unbounded plane through a point, u and v in model units from it; E409 for a normal without length.
pub fn unbounded(at: DVec3, normal: DVec3, origin: Origin) -> Result<Surface> {
    let Some(n) = math::unit(normal, 0.0) else {
        return Err(CurveFault::ZeroDirection { of: origin, argument: "normal", needed: "with a length" }.into());
    };
    let eu = math::any_normal(n);
    let frame = Frame { origin: at, eu, ev: n.cross(eu) };
    Ok(flat(Shape::Plane(frame), Domain::Unbounded, Vec::new(), String::new(), origin, Vec::new()))
}

/// The plane z = 0 with u along x and v along y.
pub fn level(origin: Origin) -> Surface {
    let frame = Frame { origin: DVec3::ZERO, eu: DVec3::X, ev: DVec3::Y };
    flat(Shape::Plane(frame), Domain::Unbounded, Vec::new(), String::new(), origin, Vec::new())
}

/// The square of an unbounded plane that holds whatever of it lies in a box, with room around.
pub(crate) fn over(surface: &Surface, reach: Box3) -> Surface {
    let parts = surface.parts();
    let Shape::Plane(frame) = parts.shape else { return surface.clone() };
    let (center, size) = (reach.center(), reach.diagonal());
    let (eu, ev) = (frame.eu.normalize_or_zero() * (2.0 * size), frame.ev.normalize_or_zero() * (2.0 * size));
    let (u, v) = frame.uv(center);
    let middle = frame.jet(u, v).p;
    let shape = Shape::Plane(Frame { origin: middle - eu * 0.5 - ev * 0.5, eu, ev });
    Surface::new(Parts { shape, domain: Domain::Square, borders: free_sides(), trim: None, chains: Vec::new(), ..parts.clone() })
}

/// The whole square of the frame of a plane face.
pub(crate) fn squared(surface: &Surface) -> Surface {
    Surface::new(Parts { domain: Domain::Square, borders: free_sides(), trim: None, ..surface.parts().clone() })
}

/// Share of a plane face by which its square is widened on each side.
const WIDER: f64 = 1.0 / 16.0;

/// The square of the frame of a plane face with room around, so that no curve of the face runs along a side of it.
pub(crate) fn widened(surface: &Surface) -> Surface {
    let Shape::Plane(frame) = surface.parts().shape else { return squared(surface) };
    let (eu, ev) = (frame.eu * (1.0 + 2.0 * WIDER), frame.ev * (1.0 + 2.0 * WIDER));
    let shape = Shape::Plane(Frame { origin: frame.origin - (frame.eu + frame.ev) * WIDER, eu, ev });
    Surface::new(Parts { shape, domain: Domain::Square, borders: free_sides(), trim: None, ..surface.parts().clone() })
}

fn free_sides() -> Vec<Border> {
    (0..4).map(|_| Border::straight(Side::Free)).collect()
}

impl Surface {
    /// Number of sides of a plane that has two to four and yet no map, since that would fold over.
    pub fn sides_without_map(&self, tolerance: &Tolerance) -> Option<usize> {
        let Parts { domain, kind, trim, chains, .. } = self.parts();
        if *domain != Domain::Loop || *kind != SurfaceKind::Plane || trim.is_some() {
            return None;
        }
        let sides = if let [whole] = chains.as_slice() { whole.kinks(tolerance).len() } else { chains.len() };
        (2..=4).contains(&sides).then_some(sides)
    }
}

/// A bounded plane as a face without a map, whose parameters are straight; any other surface as it is.
pub(crate) fn unmapped(surface: &Surface, tolerance: &Tolerance) -> Result<Surface> {
    let parts = surface.parts();
    if parts.kind != SurfaceKind::Plane || parts.domain == Domain::Loop || parts.chains.is_empty() {
        return Ok(surface.clone());
    }
    let walk = walked(&parts.chains, LoopRole::Plane, tolerance)?;
    let frame = fitted(&walk, tolerance)?;
    let flat = around(&walk, frame, parts.origin);
    Ok(if parts.flipped { flat.flipped() } else { flat })
}

pub(crate) fn flat(shape: Shape, domain: Domain, borders: Vec<Border>, flow: String, origin: Origin, chains: Vec<Chain>) -> Surface {
    Surface::new(Parts {
        origin,
        kind: SurfaceKind::Plane,
        flow,
        domain,
        closed: (false, false),
        shape,
        borders,
        kinks: (Vec::new(), Vec::new()),
        chains,
        generated: Vec::new(),
        trim: None,
        flipped: false,
    })
}

/// The plane of a boundary with the box of it as frame: u along the first curve's chord, normal by the walk's sense; E655.
pub(crate) fn fitted(walk: &[Step], tolerance: &Tolerance) -> Result<Frame> {
    let rings: Vec<Vec<DVec3>> = walk.iter().map(samples).collect();
    let points: Vec<DVec3> = rings.iter().flatten().copied().collect();
    let center = points.iter().copied().sum::<DVec3>() / points.len() as f64;
    // Twice the area vector [Newell]; a boundary that encloses nothing has no plane.
    let area: DVec3 = (0..points.len()).map(|k| (points[k] - center).cross(points[(k + 1) % points.len()] - center)).sum();
    let size = Box3::of(points.iter().copied()).diagonal();
    let Some(normal) = math::unit(area, tolerance.point * size) else {
        let fault = GridFault::FlowUnknown {
            curves: walk.iter().map(|s| s.0.origin()).collect(),
            why: crate::network::fault::NoFlow::TooFewCurves { given: walk.len() },
        };
        return Err(fault.into());
    };
    let (mut off, mut at, mut curve) = (0.0, center, walk[0].0.origin());
    for (ring, step) in rings.iter().zip(walk) {
        for p in ring {
            let distance = (*p - center).dot(normal).abs();
            if distance > off {
                (off, at, curve) = (distance, *p, step.0.origin());
            }
        }
    }
    if off > tolerance.point {
        return Err(BorderFault::PlaneNotFlat { curve, off, at, tolerance: tolerance.point }.into());
    }
    let chord = end(&walk[0]) - start(&walk[0]);
    let eu = math::unit(chord.reject_from_normalized(normal), tolerance.point).unwrap_or_else(|| math::any_normal(normal));
    let ev = normal.cross(eu);
    let span = |e: DVec3| points.iter().map(|p| (*p - center).dot(e)).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    let ((u0, u1), (v0, v1)) = (span(eu), span(ev));
    Ok(Frame { origin: center + eu * u0 + ev * v0, eu: eu * (u1 - u0), ev: ev * (v1 - v0) })
}

/// A boundary that no map fits.
pub(crate) fn around(walk: &[Step], frame: Frame, origin: Origin) -> Surface {
    let borders = walk.iter().map(|(chain, against)| Border::chain(chain.clone(), *against)).collect();
    let chains = walk.iter().map(|step| step.0.clone()).collect();
    flat(Shape::Plane(frame), Domain::Loop, borders, String::new(), origin, chains)
}
