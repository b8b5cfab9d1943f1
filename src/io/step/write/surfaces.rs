//! Surfaces as STEP entities: exact elementary forms where there are such, else B-splines.

use glam::DVec3;

use super::curves::{Scale, knots};
use super::text::{Id, Records, Values};
use crate::base::fault::Result;
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::geometry::nurbs::projected;
use crate::io::cad::nets::{trimmed_net, with_whole_poles};
use crate::model::Patch;
use crate::surface::elementary::{Elementary, Form};
use crate::surface::{Domain, NurbsSurface, Off, Side, Surface};

/// Share of the tolerance that a net may be off, where that can be had.
const FINE: f64 = 0.1;

/// The surface of one face.
#[derive(Clone, Debug)]
pub enum Ground {
    /// A plane, cylinder, cone, sphere or torus.
    Elementary(Elementary),
    /// A B-spline with how far it is off, and the points that its poles were made.
    Net(NurbsSurface, Off, Vec<DVec3>),
}

/// The surface below a patch, cut to its rectangle where it is a B-spline; `None` for a plane without a border.
pub fn ground(surface: &Surface, patch: &Patch, scale: &Scale) -> Result<Option<Ground>> {
    if surface.domain() == Domain::Unbounded {
        return Ok(None);
    }
    if let Some(found) = surface.elementary(patch.v, &scale.tolerance) {
        return Ok(Some(Ground::Elementary(found)));
    }
    let base = surface.untrimmed();
    let poles: Vec<DVec3> = (0..base.n_sides()).filter_map(|k| if let Side::Pole(at) = base.side(k) { Some(at) } else { None }).collect();
    // Edges lie in space: the net may run by the profile's own parameter, with which it is exact.
    let whole = patch.u == (0.0, 1.0) && patch.v == (0.0, 1.0);
    if let (0.0, 1.0) = patch.u
        && let Some(net) = surface.swept_net(patch.v, &scale.tolerance)
    {
        return Ok(Some(shaped(net, Off::Exact, &poles, scale)));
    }
    let form = |tolerance: &Tolerance| match surface.domain() {
        Domain::Square if whole => surface.to_net(tolerance),
        _ => surface.ground_net(tolerance),
    };
    // Edges are within the tolerance: the surface is to be nearer, so that areas and volumes are found again.
    let fine = Tolerance { point: FINE * scale.tolerance.point, ..scale.tolerance };
    let form = form(&fine).or_else(|_| form(&scale.tolerance))?;
    let Some(form) = form else { return Ok(None) };
    let cut = match surface.domain() {
        Domain::Square if !whole => trimmed_net(form.net.clone(), [patch.u.0, patch.u.1, patch.v.0, patch.v.1]).unwrap_or(form.net),
        _ => form.net,
    };
    Ok(Some(shaped(cut, form.off, &poles, scale)))
}

/// A net with its poles, or the plane that it is.
fn shaped(net: NurbsSurface, off: Off, poles: &[DVec3], scale: &Scale) -> Ground {
    if let Some(plane) = flat(&net, scale) {
        return Ground::Elementary(plane);
    }
    let (net, poles) = with_whole_poles(net, poles, &scale.tolerance);
    let moved = poles.iter().map(|pole| pole.moved).fold(0.0, f64::max);
    Ground::Net(net, off.and(moved), poles.iter().filter(|pole| pole.moved > scale.tolerance.rounding).map(|pole| pole.at).collect())
}

/// The plane in which all poles of a net lie but for rounding.
fn flat(net: &NurbsSurface, scale: &Scale) -> Option<Elementary> {
    let (nu, nv) = net.counts;
    let at = |i: usize, j: usize| projected(net.pole(i, j));
    let corner = at(0, 0);
    let arms = [at(nu - 1, 0), at(nu - 1, nv - 1), at(0, nv - 1)].map(|p| p - corner);
    // Both halves of the quadrilateral of the corners: one may be nothing.
    let area = arms[0].cross(arms[1]) + arms[1].cross(arms[2]);
    let longest = arms.into_iter().fold(DVec3::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
    if area.length() <= PARALLEL * longest.length_squared() {
        return None;
    }
    let normal = area.normalize_or_zero();
    let lies = |q: &glam::DVec4| (projected(*q) - corner).dot(normal).abs() <= scale.tolerance.rounding;
    if !net.poles.iter().all(lies) {
        return None;
    }
    let reference = longest.reject_from_normalized(normal).normalize_or_zero();
    Some(Elementary { form: Form::Plane { at: corner, normal }, reference, along: true })
}

/// Writes the surface; gives it with whether its normal is the one of the model's surface.
pub fn put(records: &mut Records, ground: &Ground, scale: &Scale) -> (Id, bool) {
    match ground {
        Ground::Net(net, ..) => (spline(records, net, scale), true),
        Ground::Elementary(found) => (elementary(records, found, scale), found.along),
    }
}

fn elementary(records: &mut Records, found: &Elementary, scale: &Scale) -> Id {
    let reference = found.reference;
    let mut round = |name: &str, at: DVec3, axis: DVec3, sizes: &[f64]| {
        let frame = records.frame(at / scale.model, axis, reference);
        records.put(name, |v| {
            v.text("").id(frame);
            sizes.iter().for_each(|size| {
                v.real(*size);
            });
        })
    };
    match &found.form {
        Form::Plane { at, normal } => round("PLANE", *at, *normal, &[]),
        Form::Cylinder { axis, radius } => round("CYLINDRICAL_SURFACE", axis.about, axis.direction, &[radius / scale.model]),
        Form::Cone { axis, radius, angle } => round("CONICAL_SURFACE", axis.about, axis.direction, &[radius / scale.model, *angle]),
        Form::Sphere { axis, radius } => round("SPHERICAL_SURFACE", axis.about, axis.direction, &[radius / scale.model]),
        Form::Torus { axis, major, minor } => {
            round("TOROIDAL_SURFACE", axis.about, axis.direction, &[major / scale.model, minor / scale.model])
        }
    }
}

fn spline(records: &mut Records, net: &NurbsSurface, scale: &Scale) -> Id {
    let (nu, nv) = net.counts;
    let point = |records: &mut Records, i: usize, j: usize| records.point(projected(net.pole(i, j)) / scale.model);
    let points: Vec<Vec<Id>> = (0..nu).map(|i| (0..nv).map(|j| point(records, i, j)).collect()).collect();
    let same =
        |a: (usize, usize), b: (usize, usize)| scale.tolerance.same_point(projected(net.pole(a.0, a.1)), projected(net.pole(b.0, b.1)));
    let closed_u = (0..nv).all(|j| same((0, j), (nu - 1, j)));
    let closed_v = (0..nu).all(|i| same((i, 0), (i, nv - 1)));
    let ((times_u, at_u), (times_v, at_v)) = (knots(&net.knots.0), knots(&net.knots.1));
    let shape = |v: &mut Values| {
        v.int(net.degree.0).int(net.degree.1).list(|v| {
            points.iter().for_each(|row| {
                v.ids(row);
            });
        });
        v.word(".UNSPECIFIED.").flag(closed_u).flag(closed_v).word(".F.");
    };
    let parameters = |v: &mut Values| {
        v.ints(times_u.iter().copied()).ints(times_v.iter().copied());
        v.reals(at_u.iter().copied()).reals(at_v.iter().copied()).word(".UNSPECIFIED.");
    };
    if net.poles.iter().all(|q| q.w == net.poles[0].w) {
        return records.put("B_SPLINE_SURFACE_WITH_KNOTS", |v| {
            shape(v.text(""));
            parameters(v);
        });
    }
    records.put_complex(|v| {
        v.part("BOUNDED_SURFACE", |_| {});
        v.part("B_SPLINE_SURFACE", shape);
        v.part("B_SPLINE_SURFACE_WITH_KNOTS", parameters);
        v.part("GEOMETRIC_REPRESENTATION_ITEM", |_| {});
        v.part("RATIONAL_B_SPLINE_SURFACE", |v| {
            v.list(|v| {
                (0..nu).for_each(|i| {
                    v.reals((0..nv).map(|j| net.pole(i, j).w));
                });
            });
        });
        v.part("REPRESENTATION_ITEM", |v| {
            v.text("");
        });
        v.part("SURFACE", |_| {});
    })
}
