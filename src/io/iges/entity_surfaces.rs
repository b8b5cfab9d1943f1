//! Parameters of surface entities.

use crate::io::cad::defect::{Defect, defect};
use crate::io::iges::entity_curves::{check_degree, increasing, range};
use crate::io::iges::entity_data::{Data, NetData};
use crate::io::iges::params::ParameterReader;

/// 108.
pub fn plane(r: &mut ParameterReader) -> Result<Data, Defect> {
    let c = r.reals(4, "coefficients")?;
    let border = if r.left() > 0 { r.pointer("border")? } else { 0 };
    // Place and size of a symbol.
    for _ in 0..r.left().min(4) {
        r.real_or(0.0);
    }
    Ok(Data::Plane { coefficients: [c[0], c[1], c[2], c[3]], border })
}

/// 114: after each row of patches, and after the last one, the standard has patches without meaning; some files leave them out.
pub fn patches(r: &mut ParameterReader) -> Result<Data, Defect> {
    const EACH: usize = 48;
    r.int("kind of spline")?;
    r.int("kind of patches")?;
    let (m, n) = (r.count("count of patches in u")?, r.count("count of patches in v")?);
    if m == 0 || n == 0 {
        return Err(defect("a spline surface of no patches"));
    }
    r.needs(m, 1, "joints")?;
    r.needs(n, 1, "joints")?;
    let (u, v) = (r.reals(m + 1, "joints in u")?, r.reals(n + 1, "joints in v")?);
    increasing(&u)?;
    increasing(&v)?;
    let full = (m + 1).saturating_mul(n + 1);
    let dummies = full.saturating_mul(EACH) <= r.left();
    let count = if dummies { full } else { m.saturating_mul(n) };
    r.needs(count, EACH, "patches")?;
    let patches = r.reals(count * EACH, "coefficients")?;
    Ok(Data::Patches { u, v, patches, dummies })
}

/// 118.
pub fn ruled(form: i32, r: &mut ParameterReader) -> Result<Data, Defect> {
    let rails = [r.pointer("first curve")?, r.pointer("second curve")?];
    let crossed = r.int("direction")? == 1;
    if r.left() > 0 {
        r.int("developable")?;
    }
    Ok(Data::Ruled { rails, crossed, by_length: form == 0 })
}

/// 120.
pub fn revolution(r: &mut ParameterReader) -> Result<Data, Defect> {
    let (axis, profile) = (r.pointer("axis")?, r.pointer("profile")?);
    Ok(Data::Revolution { axis, profile, start: r.real("first angle")?, end: r.real("last angle")? })
}

/// 128.
pub fn net(r: &mut ParameterReader) -> Result<Data, Defect> {
    let last = (r.count("last index in u")?, r.count("last index in v")?);
    let degree = (r.count("degree in u")?, r.count("degree in v")?);
    for what in ["closed in u", "closed in v", "polynomial", "periodic in u", "periodic in v"] {
        r.int(what)?;
    }
    let counts = (last.0 + 1, last.1 + 1);
    check_degree(counts.0, degree.0)?;
    check_degree(counts.1, degree.1)?;
    let n = counts.0.saturating_mul(counts.1);
    r.needs(n, 4, "control points with weights")?;
    let knots = (r.reals(counts.0 + degree.0 + 1, "knots in u")?, r.reals(counts.1 + degree.1 + 1, "knots in v")?);
    let weights = r.reals(n, "weights")?;
    let points = r.points(n, "control points")?;
    let u = range(r, (knots.0[degree.0], knots.0[counts.0]));
    let v = range(r, (knots.1[degree.1], knots.1[counts.1]));
    Ok(Data::Net(NetData { degree, counts, knots, weights, points, range: [u.0, u.1, v.0, v.1] }))
}

/// 140.
pub fn offset(r: &mut ParameterReader) -> Result<Data, Defect> {
    let indicator = r.point("side")?;
    Ok(Data::OffsetSurface { indicator, distance: r.real("distance")?, base: r.pointer("surface")? })
}

/// 190; form 1 says where parameters start.
pub fn plane_surface(form: i32, r: &mut ParameterReader) -> Result<Data, Defect> {
    let (at, normal) = (r.pointer("point")?, r.pointer("normal")?);
    let reference = if form == 1 { r.pointer("reference direction")? } else { 0 };
    Ok(Data::PlaneSurface { at, normal, reference })
}

/// 192 cylinder, 194 cone, 196 sphere, 198 torus; form 1 says where parameters start.
pub fn round(kind: u32, form: i32, r: &mut ParameterReader) -> Result<Data, Defect> {
    let at = r.pointer("point")?;
    let (axis, sizes) = match kind {
        192 => (r.pointer("axis")?, [r.real("radius")?, 0.0]),
        196 => (0, [r.real("radius")?, 0.0]),
        _ => (r.pointer("axis")?, [r.real("radius")?, r.real("second size")?]),
    };
    let axis = if kind == 196 && form == 1 { r.pointer("axis")? } else { axis };
    let reference = if form == 1 { r.pointer("reference direction")? } else { 0 };
    Ok(Data::Round { kind, at, axis, sizes, reference })
}
