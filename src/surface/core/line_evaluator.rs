//! Lines of constant u or v on a surface, made ready for many evaluations.

use glam::DVec3;

use crate::base::work;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::blend_line::BlendLine;

/// A line of constant u or v on a blend of curves.
#[derive(Clone, Debug)]
pub struct LineEvaluator {
    surface: Surface,
    along_u: bool,
    line: BlendLine,
}

impl Surface {
    /// The line through a place along u (`along_u`) or along v, made ready; `None` of surfaces that are evaluated as cheaply by themselves.
    pub fn line_evaluator(&self, (u, v): (f64, f64), along_u: bool) -> Option<LineEvaluator> {
        let Shape::Blend(blend) = &self.parts().shape else { return None };
        if self.ground() == Domain::Triangle {
            return None;
        }
        let (u, v) = self.wrapped(u, v);
        let (u, v, side) = self.inner(u, v, (OneSided::After, OneSided::After));
        let (at, side) = if along_u { (v, side.1) } else { (u, side.0) };
        work::spend(1);
        Some(LineEvaluator { surface: self.clone(), along_u, line: BlendLine::new(blend, along_u, at, side) })
    }
}

impl LineEvaluator {
    /// Point and derivative along the line at a place of it, from the given side where it jumps: the same as [`Surface::jet_one_sided`] gives.
    pub fn jet(&self, (u, v): (f64, f64), side: OneSided) -> (DVec3, DVec3) {
        let Shape::Blend(blend) = &self.surface.parts().shape else { return Default::default() };
        work::spend(1);
        let (u, v) = self.surface.wrapped(u, v);
        let (u, v, side) = self.surface.inner(u, v, (side, side));
        let (x, side) = if self.along_u { (u, side.0) } else { (v, side.1) };
        let (p, d1) = self.line.jet(blend, x, side);
        (p, if self.surface.parts().flipped && !self.along_u { -d1 } else { d1 })
    }
}
