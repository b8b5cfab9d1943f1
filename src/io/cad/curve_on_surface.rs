//! Curves in space made from curves in the (u, v) of a surface.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use crate::base::bbox::Box3;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::geometry::construct::spline::{open_slopes, through};
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::io::cad::base_surface::Base;
use crate::io::cad::curves::transformed;
use crate::io::cad::defect::{Defect, defect};

/// Steps along a smooth piece of the curve to begin with, and at most.
const STEPS: (usize, usize) = (8, 4096);

/// The curve S(u(t), v(t)): exact on planes and along lines of constant u or v of a net, else within the tolerance.
///
/// `None` when it is one point.
pub fn composed(base: &Base, uv: &Curve, tolerance: &Tolerance, origin: Origin) -> Result<Option<Curve>, Defect> {
    if let Base::Plane(at, u, v) = base {
        let m = DAffine3::from_mat3_translation(DMat3::from_cols(*u, *v, u.cross(*v)), *at);
        return Ok(Some(transformed(uv, &m, tolerance)?.with_origin(origin)));
    }
    let curve = match along_line(base, uv) {
        Some(exact) => exact,
        None => {
            let lost = || defect("its curves in (u, v) cannot be read in the parameters of this surface");
            let at = |t: f64| {
                let p = uv.point(t);
                base.point(p.x, p.y).ok_or_else(lost)
            };
            fitted(&uv.knots(), tolerance, &at, &|p| p)?
        }
    };
    let size = Box3::of((0..curve.poles.len()).map(|k| curve.pole(k))).diagonal();
    Ok((size > tolerance.point).then(|| Curve::new(Shape::Nurbs(Arc::new(curve)), Kind::Nurbs, origin)))
}

/// A line of constant u or v of a net.
fn along_line(base: &Base, uv: &Curve) -> Option<Nurbs> {
    let (Base::Net(net, _), Shape::Line(a, b)) = (base, uv.shape()) else { return None };
    let m = base.to_surface()?;
    let (a, b) = (m.transform_point3(*a), m.transform_point3(*b));
    let at_u = (a.x - b.x).abs() <= EPSILON;
    if !at_u && (a.y - b.y).abs() > EPSILON {
        return None;
    }
    let (fixed, from, to) = if at_u { (a.x, a.y, b.y) } else { (a.y, a.x, b.x) };
    let (low, high) = (from.min(to).clamp(0.0, 1.0), from.max(to).clamp(0.0, 1.0));
    if low >= high {
        return None;
    }
    let part = net.iso(at_u, fixed.clamp(0.0, 1.0)).part(low, high);
    Some(if from < to { part } else { part.reversed() })
}

/// Cubic splines through places of a curve between its knots, each smooth piece with more of them until the points that
/// `shown` makes of it are near between them too.
pub fn fitted(
    knots: &[f64],
    tolerance: &Tolerance,
    at: &dyn Fn(f64) -> Result<DVec3, Defect>,
    shown: &dyn Fn(DVec3) -> DVec3,
) -> Result<Nurbs, Defect> {
    let mut pieces = Vec::new();
    for span in knots.windows(2) {
        let (from, width) = (span[0], span[1] - span[0]);
        let mut steps = STEPS.0;
        let piece = loop {
            let place = |k: f64| from + width * (k / steps as f64);
            let points = (0..=steps).map(|k| at(place(k as f64))).collect::<Result<Vec<DVec3>, Defect>>()?;
            let spans = vec![width / steps as f64; steps];
            let slopes = open_slopes(&points, &spans, end_slopes(&points, width / steps as f64));
            let fit = through(&points, &spans, &slopes);
            let mut far = 0.0_f64;
            for k in 0..steps {
                let t = k as f64 + 0.5;
                far = far.max(shown(fit.jet(width * (t / steps as f64)).p).distance(shown(at(place(t))?)));
            }
            // Between the samples a fourth-order error is largest in the middle.
            if far <= 0.5 * tolerance.point.max(tolerance.rounding) || steps >= STEPS.1 {
                break fit;
            }
            steps *= 2;
        };
        pieces.push(piece);
    }
    Ok(Nurbs::joined(&pieces))
}

/// Slopes at the ends from a polynomial of degree four through the points next to them.
fn end_slopes(points: &[DVec3], h: f64) -> [Option<DVec3>; 2] {
    let slope = |p: [DVec3; 5]| (p[0] * -25.0 + p[1] * 48.0 - p[2] * 36.0 + p[3] * 16.0 - p[4] * 3.0) / (12.0 * h);
    let n = points.len() - 1;
    let first = slope([points[0], points[1], points[2], points[3], points[4]]);
    let last = -slope([points[n], points[n - 1], points[n - 2], points[n - 3], points[n - 4]]);
    [Some(first), Some(last)]
}
