//! Which simple form a surface has, whatever it is written as: plane, cylinder, cone, sphere or ring torus.
//!
//! Points and normals on a grid inside the surface give the form and its sizes; then each point must lie on it.

use glam::{DMat3, DVec3};

use crate::base::tolerance::{FLAT, PARALLEL, Tolerance};
use crate::surface::core::surface::Surface;

/// Places along u and along v.
const PLACES: u32 = 9;

/// A form with its radii, model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SimpleForm {
    /// A plane.
    Plane,
    /// A round cylinder.
    Cylinder {
        /// Its radius.
        radius: f64,
    },
    /// A round cone.
    Cone,
    /// A sphere.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A ring torus.
    Torus {
        /// Radius of the circle of centres.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
}

/// A point of the surface with its unit normal.
#[derive(Clone, Copy)]
struct Foot {
    p: DVec3,
    n: DVec3,
}

impl Surface {
    /// The form on which the surface lies within the tolerance; `None` where it is of another one.
    pub fn simple_form(&self, tolerance: &Tolerance) -> Option<SimpleForm> {
        let at = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
        let mut feet = Vec::with_capacity((PLACES * PLACES) as usize);
        for k in 0..PLACES * PLACES {
            let jet = self.jet(at(k % PLACES), at(k / PLACES));
            let n = jet.du.cross(jet.dv).normalize_or_zero();
            if n != DVec3::ZERO && jet.p.is_finite() {
                feet.push(Foot { p: jet.p, n });
            }
        }
        if feet.len() < 9 {
            return None;
        }
        let near = tolerance.point;
        plane(&feet, near)
            .or_else(|| sphere(&feet, near))
            .or_else(|| cylinder(&feet, near))
            .or_else(|| cone(&feet, near))
            .or_else(|| torus(self, &feet, near))
    }
}

fn mean(places: impl Iterator<Item = DVec3>, n: usize) -> DVec3 {
    places.sum::<DVec3>() / n as f64
}

fn plane(feet: &[Foot], near: f64) -> Option<SimpleForm> {
    let Foot { p, n } = feet[0];
    feet.iter().all(|f| (f.p - p).dot(n).abs() <= near && f.n.cross(n).length() <= FLAT).then_some(SimpleForm::Plane)
}

/// The signed radius of the round thing whose normals these are, and its centre.
fn round(feet: &[Foot]) -> Option<(f64, DVec3)> {
    let (p, n) = (mean(feet.iter().map(|f| f.p), feet.len()), mean(feet.iter().map(|f| f.n), feet.len()));
    let (mut up, mut down) = (0.0, 0.0);
    for f in feet {
        up += (f.p - p).dot(f.n - n);
        down += (f.n - n).length_squared();
    }
    if down <= PARALLEL {
        return None;
    }
    let radius = up / down;
    Some((radius, p - n * radius))
}

fn sphere(feet: &[Foot], near: f64) -> Option<SimpleForm> {
    let (radius, center) = round(feet)?;
    let radius = radius.abs();
    let fits = |f: &Foot| ((f.p - center).length() - radius).abs() <= near;
    // One arc of normals leaves the centre open.
    let across = widest(feet.iter().map(|f| f.n))?;
    (feet.iter().all(fits) && feet.iter().any(|f| f.n.dot(across).abs() > FLAT)).then_some(SimpleForm::Sphere { radius })
}

/// The unit vector across the two directions that differ most.
fn widest(directions: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    let all: Vec<DVec3> = directions.collect();
    let longest = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
    let first = all.iter().copied().fold(DVec3::ZERO, longest);
    let across = all.iter().map(|d| first.cross(*d)).fold(DVec3::ZERO, longest);
    across.try_normalize()
}

fn cylinder(feet: &[Foot], near: f64) -> Option<SimpleForm> {
    let axis = widest(feet.iter().map(|f| f.n))?;
    if feet.iter().any(|f| f.n.dot(axis).abs() > FLAT) {
        return None;
    }
    let flat: Vec<Foot> = feet.iter().map(|f| Foot { p: f.p.reject_from_normalized(axis), n: f.n.reject_from_normalized(axis) }).collect();
    let (radius, center) = round(&flat)?;
    let radius = radius.abs();
    let fits = |f: &Foot| ((f.p - center).length() - radius).abs() <= near;
    flat.iter().all(fits).then_some(SimpleForm::Cylinder { radius })
}

fn cone(feet: &[Foot], near: f64) -> Option<SimpleForm> {
    let first = feet[0].n;
    let axis = widest(feet.iter().map(|f| f.n - first))?;
    let rise = first.dot(axis);
    if feet.iter().any(|f| (f.n.dot(axis) - rise).abs() > FLAT) {
        return None;
    }
    // The apex lies in all tangent planes.
    let about = mean(feet.iter().map(|f| f.p), feet.len());
    let (mut m, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for f in feet {
        m += DMat3::from_cols(f.n * f.n.x, f.n * f.n.y, f.n * f.n.z);
        right += f.n * f.n.dot(f.p - about);
    }
    if m.determinant().abs() <= PARALLEL {
        return None;
    }
    let apex = about + m.inverse() * right;
    (apex.is_finite() && feet.iter().all(|f| (f.p - apex).dot(f.n).abs() <= near)).then_some(SimpleForm::Cone)
}

/// Radius of the circle through three points.
fn circle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let double = (b - a).cross(c - a).length();
    a.distance(b) * b.distance(c) * c.distance(a) / (2.0 * double)
}

fn torus(surface: &Surface, feet: &[Foot], near: f64) -> Option<SimpleForm> {
    let p = |u: f64, v: f64| surface.point(u, v);
    let lines = [circle(p(0.5, 0.4), p(0.5, 0.5), p(0.5, 0.6)), circle(p(0.4, 0.5), p(0.5, 0.5), p(0.6, 0.5))];
    for minor in lines.into_iter().flat_map(|r| [r, -r]).filter(|r| r.is_finite()) {
        // The centres of the tube lie on a circle.
        let centers: Vec<DVec3> = feet.iter().map(|f| f.p - f.n * minor).collect();
        let first = centers[0];
        let Some(axis) = widest(centers.iter().map(|c| *c - first)) else { continue };
        let farthest = |from: DVec3| centers.iter().copied().fold(from, |a, b| if b.distance(from) > a.distance(from) { b } else { a });
        let far = farthest(first);
        let between = |c: &DVec3| c.distance(first).min(c.distance(far));
        let Some(third) = centers.iter().copied().max_by(|a, b| between(a).total_cmp(&between(b))) else { continue };
        let major = circle(first, third, far);
        let (ab, ac) = (third - first, far - first);
        let normal = ab.cross(ac);
        let center =
            first + (normal.cross(ab) * ac.length_squared() + ac.cross(normal) * ab.length_squared()) / (2.0 * normal.length_squared());
        let fits = |c: &DVec3| (c.distance(center) - major).abs() <= near && (*c - first).dot(axis).abs() <= near;
        if center.is_finite() && major > minor.abs() + near && centers.iter().all(fits) {
            return Some(SimpleForm::Torus { major, minor: minor.abs() });
        }
    }
    None
}
