//! Surfaces as STEP entities: exact elementary forms where there are such, else B-splines.

use glam::DVec3;

use crate::geometry::shapes::nurbs::projected;
use crate::io::cad::elementary_surface::Ground;
use crate::io::step::write::curves::{arc_of, knots};
use crate::io::step::write::records::{Id, RecordValues, SectionRecords};
use crate::io::step::write::things::StepScale;
use crate::surface::NurbsSurface;
use crate::surface::analysis::elementary::{Elementary, Form, MovedArc};
use crate::surface::shapes::sweep::Path;

/// Writes the surface.
pub fn put(records: &mut SectionRecords, ground: &Ground, scale: &StepScale) -> Id {
    match ground {
        Ground::Net(net, ..) => spline(records, net, scale),
        Ground::Elementary(found) => elementary(records, found, scale),
    }
}

/// Writes an arc that is moved or turned.
pub fn moved(records: &mut SectionRecords, arc: &MovedArc, scale: &StepScale) -> Id {
    let profile = arc_of(records, &arc.profile, scale);
    match arc.path {
        Path::Straight { by } => {
            let way = records.direction(by.normalize_or_zero());
            let vector = records.put("VECTOR", |v| {
                v.text("").id(way).real(by.length() / scale.model);
            });
            records.put("SURFACE_OF_LINEAR_EXTRUSION", |v| {
                v.text("").id(profile).id(vector);
            })
        }
        Path::Turn { about, axis, .. } => {
            let (at, way) = (records.point(about / scale.model), records.direction(axis));
            let place = records.put("AXIS1_PLACEMENT", |v| {
                v.text("").id(at).id(way);
            });
            records.put("SURFACE_OF_REVOLUTION", |v| {
                v.text("").id(profile).id(place);
            })
        }
    }
}

fn elementary(records: &mut SectionRecords, found: &Elementary, scale: &StepScale) -> Id {
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

fn spline(records: &mut SectionRecords, net: &NurbsSurface, scale: &StepScale) -> Id {
    let (nu, nv) = net.counts;
    let point = |records: &mut SectionRecords, i: usize, j: usize| records.point(projected(net.pole(i, j)) / scale.model);
    let points: Vec<Vec<Id>> = (0..nu).map(|i| (0..nv).map(|j| point(records, i, j)).collect()).collect();
    let same =
        |a: (usize, usize), b: (usize, usize)| scale.tolerance.same_point(projected(net.pole(a.0, a.1)), projected(net.pole(b.0, b.1)));
    let closed_u = (0..nv).all(|j| same((0, j), (nu - 1, j)));
    let closed_v = (0..nu).all(|i| same((i, 0), (i, nv - 1)));
    let ((times_u, at_u), (times_v, at_v)) = (knots(&net.knots.0), knots(&net.knots.1));
    let shape = |v: &mut RecordValues| {
        v.int(net.degree.0).int(net.degree.1).list(|v| {
            points.iter().for_each(|row| {
                v.ids(row);
            });
        });
        v.word(".UNSPECIFIED.").flag(closed_u).flag(closed_v).word(".F.");
    };
    let parameters = |v: &mut RecordValues| {
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
