//! Trimmed nets that run at very uneven speed, in parameters in which they run evenly: what a mesher is given.
//!
//! A net may run through a tenth of its length in a thousandth of its range. Triangles that are straight in its parameters are bent in space
//! there, and bounds over boxes of them say nothing. Each parameter that does so is a monotone function of a new one: quadratic between some
//! stops, with a slope of one over the speed at each of them. In the new one the same surface is a net of twice the degree, exactly.

use std::sync::Arc;

use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::kind::Domain;
use crate::surface::rails::trim_curve::TrimCurve;
use crate::surface::shapes::speed_map::SpeedMap;

/// A surface in parameters in which it runs evenly.
#[derive(Debug)]
pub struct Evened {
    surface: Surface,
    speed_maps: [Option<SpeedMap>; 2],
    flipped: bool,
}

impl Evened {
    /// Of a trimmed net without kinks that needs it.
    pub(crate) fn of(surface: &Surface) -> Option<Self> {
        let parts = surface.parts();
        let (Shape::Nurbs(net), Some(trim)) = (&parts.shape, &parts.trim) else { return None };
        if parts.domain != Domain::Loop || !parts.kinks.0.is_empty() || !parts.kinks.1.is_empty() {
            return None;
        }
        let speed_map = |in_u: bool, closed: bool| if closed { None } else { net.speed_map(in_u) };
        let speed_maps = [speed_map(true, parts.closed.0), speed_map(false, parts.closed.1)];
        if speed_maps.iter().all(Option::is_none) || !trim.trim_curves.iter().all(TrimCurve::is_upright) {
            return None;
        }
        let mut shape = net.clone();
        for (in_u, speed_map) in [(true, &speed_maps[0]), (false, &speed_maps[1])] {
            if let Some(speed_map) = speed_map {
                shape = shape.composed(in_u, speed_map);
            }
        }
        let mut evened = Self { surface: surface.clone(), speed_maps, flipped: parts.flipped };
        let trim = Arc::new(trim.with_courses(trim.trim_curves.iter().map(|c| c.mapped(&|at| evened.place(at))).collect()));
        evened.surface = surface.remade(Parts { shape: Shape::Nurbs(shape), trim: Some(trim), ..parts.clone() });
        Some(evened)
    }

    /// The surface in its new parameters.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The new parameters of a place by its old ones.
    pub fn place(&self, (u, v): (f64, f64)) -> (f64, f64) {
        let by = |k: usize, x: f64| self.speed_maps[k].as_ref().map_or(x, |speed_map| speed_map.place(x));
        let v = if self.flipped && self.speed_maps[1].is_some() { 1.0 - by(1, 1.0 - v) } else { by(1, v) };
        (by(0, u), v)
    }
}
