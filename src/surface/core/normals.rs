//! Normals of surfaces, at poles too.

use glam::{DVec2, DVec3};

use crate::base::tolerance::{EPSILON, POLE_STEP, Tolerance};
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::{Jet2, unit_normal};
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::side::Side;

impl Surface {
    /// Unit normal `du × dv`; at a pole the limit; zero only where the surface is singular.
    pub fn normal(&self, u: f64, v: f64) -> DVec3 {
        self.normal_one_sided(u, v, (OneSided::After, OneSided::After))
    }

    /// The normal at a place on a crease or seam, on the side of it where another place is; none elsewhere, nor at a pole. Where the
    /// surface closes places go on beyond 0…1.
    pub fn normal_on_crease(&self, at: DVec2, towards: DVec2) -> Option<DVec3> {
        let (kinks, closed) = (self.kinks(), self.closed());
        let sided = |x: f64, towards: f64, kinks: &[f64], closed: bool| {
            let side = if towards < x { OneSided::Before } else { OneSided::After };
            let x = if closed { x - x.floor() } else { x };
            // Both ends of what closes are one line.
            if closed && x.min(1.0 - x) <= EPSILON {
                return (if side == OneSided::Before { 1.0 } else { 0.0 }, side, true);
            }
            kinks.iter().find(|k| (x - **k).abs() <= EPSILON).map_or((x, side, false), |k| (*k, side, true))
        };
        let (u, u_side, on_u) = sided(at.x, towards.x, kinks.0, closed.0);
        let (v, v_side, on_v) = sided(at.y, towards.y, kinks.1, closed.1);
        if on_u || on_v { unit_normal(&self.jet_one_sided(u, v, (u_side, v_side))) } else { None }
    }

    /// Unit normal of the smooth piece on the given side, see [`Surface::jet_one_sided`].
    pub fn normal_one_sided(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> DVec3 {
        self.normal_of(&self.jet_one_sided(u, v, side), (u, v))
    }

    /// Unit normal at a place whose derivatives are known, see [`Surface::normal_one_sided`].
    pub fn normal_of(&self, jet: &Jet2, (u, v): (f64, f64)) -> DVec3 {
        if let Some(normal) = unit_normal(jet) {
            return normal;
        }
        let at_end = [v == 0.0, u == 1.0, v == 1.0, u == 0.0];
        let pole =
            (0..4).find(|&k| at_end[k] && self.parts().domain == Domain::Square && matches!(self.parts().borders[k].side, Side::Pole(_)));
        pole.map_or(DVec3::ZERO, |k| self.pole_normal(k))
    }

    /// The normal of the pole on side `k`: the cross product of the tangents of the two borders that end there, or the
    /// mean of the normals a step away where these are parallel.
    fn pole_normal(&self, k: usize) -> DVec3 {
        let place = |along: f64, inward: f64| match k {
            0 => (along, inward),
            1 => (1.0 - inward, along),
            2 => (along, 1.0 - inward),
            _ => (inward, along),
        };
        let inward = |along: f64| {
            let (u, v) = place(along, 0.0);
            let side =
                (if u == 1.0 { OneSided::Before } else { OneSided::After }, if v == 1.0 { OneSided::Before } else { OneSided::After });
            let jet = self.jet_one_sided(u, v, side);
            [jet.dv, -jet.du, -jet.dv, jet.du][k]
        };
        const SAMPLES: u32 = 16;
        let mean = (0..SAMPLES).fold(DVec3::ZERO, |sum, i| {
            let (u, v) = place((f64::from(i) + 0.5) / f64::from(SAMPLES), POLE_STEP);
            sum + unit_normal(&self.jet(u, v)).unwrap_or(DVec3::ZERO)
        });
        let (first, last) = (inward(0.0), inward(1.0));
        let cross = first.cross(last);
        if cross.length() > Tolerance::new(0.0, 0.0).angle * first.length() * last.length() {
            // Borders say the plane, the neighbourhood says which side is up.
            let normal = cross.normalize_or_zero();
            return if normal.dot(mean) < 0.0 { -normal } else { normal };
        }
        mean.normalize_or_zero()
    }
}
