//! Surfaces as IGES entities: B-splines, and planes, cylinders, cones, spheres and tori of solids.

use crate::base::tolerance::Tolerance;
use crate::geometry::shapes::nurbs::projected;
use crate::io::cad::elementary_surface::Ground;
use crate::io::iges::entity_writer::{EntityValues, Role};
use crate::io::iges::write::file_builder::FileBuilder;
use crate::surface::analysis::elementary::{Elementary, Form};
use crate::surface::{NetForm, NurbsSurface, Off};

impl FileBuilder<'_> {
    pub(super) fn form(&mut self, form: &NetForm, role: Role) -> u32 {
        self.off = self.off.max(form.off.distance());
        self.sampled |= matches!(form.off, Off::Sampled(_));
        self.net(&form.net, role)
    }

    pub(super) fn net(&mut self, net: &NurbsSurface, role: Role) -> u32 {
        let closed = (0..2).map(|across| i64::from(is_closed(net, across == 1, &self.scale.tolerance))).collect::<Vec<_>>();
        let polynomial = net.poles.iter().all(|q| q.w == net.poles[0].w);
        let last = |n: usize| n as i64 - 1;
        let ends = |knots: &[f64]| [knots[0], knots[knots.len() - 1]];
        let range = [ends(&net.knots.0), ends(&net.knots.1)].concat();
        let values = EntityValues::new().int(last(net.counts.0)).int(last(net.counts.1)).int(net.degree.0 as i64).int(net.degree.1 as i64);
        let values = values.int(closed[0]).int(closed[1]).int(i64::from(polynomial)).int(0).int(0);
        let values = values.reals(net.knots.0.iter().copied()).reals(net.knots.1.iter().copied());
        let values = values.reals(net.poles.iter().map(|q| q.w));
        let values = net.poles.iter().fold(values, |values, q| values.point(projected(*q) / self.scale.model));
        self.sheet.add(128, 0, role, values.reals(range))
    }

    /// The surface of a face of a solid.
    pub(super) fn ground(&mut self, ground: &Ground) -> u32 {
        match ground {
            Ground::Net(net, ..) => self.net(net, Role::Part),
            Ground::Elementary(found) => self.elementary(found),
        }
    }

    /// A surface placed by a point, a direction and a direction of reference.
    fn elementary(&mut self, found: &Elementary) -> u32 {
        let scale = self.scale.model;
        let (kind, at, axis, sizes) = match &found.form {
            Form::Plane { at, normal } => (190, *at, *normal, vec![]),
            Form::Cylinder { axis, radius } => (192, axis.about, axis.direction, vec![radius / scale]),
            Form::Cone { axis, radius, angle } => (194, axis.about, axis.direction, vec![radius / scale, angle.to_degrees()]),
            Form::Sphere { axis, radius } => (196, axis.about, axis.direction, vec![radius / scale]),
            Form::Torus { axis, major, minor } => (198, axis.about, axis.direction, vec![major / scale, minor / scale]),
        };
        let at = self.sheet.add(116, 0, Role::Place, EntityValues::new().point(at / scale).int(0));
        let [axis, reference] =
            [axis, found.reference].map(|way| self.sheet.add(123, 0, Role::Direction, EntityValues::new().reals(way.to_array())));
        // Of a sphere the radius stands before the axis.
        let values = match kind {
            196 => EntityValues::new().int(at).reals(sizes).int(axis),
            _ => EntityValues::new().int(at).int(axis).reals(sizes),
        };
        self.sheet.add(kind, 1, Role::Part, values.int(reference))
    }
}

/// Whether the first and the last line of control points are one, in u or in v.
fn is_closed(net: &NurbsSurface, in_v: bool, tolerance: &Tolerance) -> bool {
    let (nu, nv) = net.counts;
    let pairs: Vec<(usize, usize)> =
        if in_v { (0..nu).map(|i| (i, (nv - 1) * nu + i)).collect() } else { (0..nv).map(|j| (j * nu, j * nu + nu - 1)).collect() };
    pairs.iter().all(|(a, b)| tolerance.same_point(projected(net.poles[*a]), projected(net.poles[*b])))
}
