//! Trimmed surfaces as they are: loops, lines and places of their borders, the surface below.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::core::trim::Trim;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::rails::side::{Border, Side};
use crate::surface::rails::trim_curve::TrimCurve;

impl Surface {
    /// Where the surface is defined apart from any trimming.
    pub fn ground(&self) -> Domain {
        self.parts().trim.as_ref().map_or(self.parts().domain, |trim| trim.ground)
    }

    /// The whole surface below a trimmed one, without names for its borders; any other as it is.
    pub fn untrimmed(&self) -> Self {
        let parts = self.parts();
        let Some(trim) = &parts.trim else { return self.clone() };
        let sides = if trim.ground == Domain::Triangle { 3 } else { 4 };
        let borders = (0..sides).map(|_| Border::straight(Side::Free)).collect();
        Self::new(Parts { domain: trim.ground, borders, trim: None, ..parts.clone() })
    }

    /// Whether it is a plane, trimmed or not, whose parameters are straight and even.
    pub fn is_flat(&self) -> bool {
        matches!(self.parts().shape, Shape::Plane(_))
    }

    /// Whether all of it lies in a plane, whatever its parameters are.
    pub fn is_in_plane(&self) -> bool {
        self.is_flat() || self.kind() == SurfaceKind::Plane
    }

    /// Number of sides of each loop, the outer one first; one loop of all sides for what is not trimmed.
    pub fn loops(&self) -> Vec<usize> {
        self.parts().trim.as_ref().map_or_else(|| vec![self.n_sides()], |trim| trim.loops.clone())
    }

    /// The straight line in (u, v) that a border of a trimmed surface is, in the loop's direction; `None` for one that is a
    /// curve there.
    pub fn border_line(&self, k: usize) -> Option<((f64, f64), (f64, f64))> {
        match self.parts().trim.as_ref()?.trim_curves.get(k)? {
            TrimCurve::Line(a, b) => Some((*a, *b)),
            TrimCurve::Pcurve(_) => None,
        }
    }

    /// About where a share of the length of a border lies in (u, v), and how far from there it may be; exact on planes and for straight
    /// lines in (u, v). `None` for a border of which nothing is known there.
    pub fn border_about(&self, k: usize, share: f64) -> Option<(DVec2, f64)> {
        let trim_curve = self.parts().trim.as_ref().and_then(|trim| trim.trim_curves.get(k));
        match (self.side(k), trim_curve) {
            (Side::Chain { chain, from, to }, _) if self.is_flat() => {
                Some((self.flat_uv(chain.point(from + (to - from) * share))?.into(), 0.0))
            }
            (_, Some(TrimCurve::Line(a, b))) => Some((DVec2::from(*a).lerp(DVec2::from(*b), share), 0.0)),
            (Side::Chain { from, to, .. }, Some(TrimCurve::Pcurve(pcurve))) => Some(pcurve.about(from + (to - from) * share)),
            _ => None,
        }
    }

    /// The same, whose borders were made of curves that are as far from it at the least, model units; others than trimmed ones stay as they are.
    pub fn with_borders_off(self, off: f64) -> Self {
        let Some(trim) = &self.parts().trim else { return self };
        let trim = Some(Arc::new(Trim { off, ..(**trim).clone() }));
        Self::new(Parts { trim, ..self.parts().clone() })
    }

    /// How far the borders of a trimmed surface are from it and the end of each from the start of the next one, at most, model
    /// units; 0 for others. Along a border it is measured where it was followed.
    pub fn gap(&self) -> f64 {
        let Some(trim) = &self.parts().trim else { return 0.0 };
        let off = trim.trim_curves.iter().map(|c| if let TrimCurve::Pcurve(pcurve) = c { pcurve.off } else { 0.0 }).fold(0.0, f64::max);
        let end = |k: usize| match self.side(k) {
            Side::Chain { chain, to, .. } => Some(chain.point(to)),
            _ => self.border_line(k).map(|(_, b)| self.point(b.0, b.1)),
        };
        let (mut widest, mut first) = (off.max(trim.off), 0);
        for n in &trim.loops {
            for k in 0..*n {
                if let (Some(a), Some(b)) = (end(first + k), self.border_start(first + (k + 1) % n)) {
                    widest = widest.max(a.distance(b));
                }
            }
            first += n;
        }
        widest
    }

    /// The loops as polygons in (u, v) whose corners lie on the borders.
    pub fn outlines(&self) -> Vec<Vec<DVec2>> {
        let Some(trim) = &self.parts().trim else { return Vec::new() };
        let mut first = 0;
        let polygon = |n: &usize| {
            let range = first..first + n;
            first += n;
            range
                .flat_map(|k| {
                    let mut places = trim.trim_curves[k].places();
                    places.pop();
                    places
                })
                .collect()
        };
        trim.loops.iter().map(polygon).collect()
    }

    /// The nearest place at which the surface is defined; directions in which it closes go on without end.
    pub(crate) fn hold(&self, uv: DVec2) -> DVec2 {
        let (closed_u, closed_v) = self.closed();
        let hold = |x: f64, closed: bool| if closed { x } else { x.clamp(0.0, 1.0) };
        match self.ground() {
            Domain::Square => DVec2::new(hold(uv.x, closed_u), hold(uv.y, closed_v)),
            Domain::Triangle => {
                let (u, v) = (uv.x.clamp(0.0, 1.0), uv.y.clamp(0.0, 1.0));
                let over = 0.5 * (u + v - 1.0).max(0.0);
                DVec2::new((u - over).max(0.0), (v - over).max(0.0))
            }
            Domain::Loop | Domain::Unbounded => uv,
        }
    }

    /// Points of a border: the start of each of a loop's sides.
    pub fn border_start(&self, k: usize) -> Option<DVec3> {
        match self.side(k) {
            Side::Chain { chain, from, .. } => Some(chain.point(from)),
            _ => self.border_line(k).map(|(a, _)| self.point(a.0, a.1)),
        }
    }
}
