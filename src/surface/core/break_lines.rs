//! Lines of constant u or v, and triangles of (u, v), between which a surface is smooth or analytic.

use glam::DVec2;

use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::breaks::tidy;
use crate::surface::data::kind::Domain;

impl Surface {
    /// Interior values of u (first) and v (second) where the surface has a kink line, ascending.
    pub fn kinks(&self) -> (&[f64], &[f64]) {
        (&self.parts().kinks.0, &self.parts().kinks.1)
    }

    /// Interior values of u (first) and v (second) where the surface is less than analytic: kinks, network lines, joints
    /// and knots of the curves, ascending. Between them quadrature and bounds behave.
    pub fn breaks(&self) -> (Vec<f64>, Vec<f64>) {
        self.own_lines(self.parts().shape.breaks())
    }

    /// The lines of the shape in the surface's own parameters.
    fn own_lines(&self, (us, vs): (Vec<f64>, Vec<f64>)) -> (Vec<f64>, Vec<f64>) {
        match (self.parts().flipped, self.ground()) {
            (false, _) => (us, vs),
            (true, Domain::Triangle) => (vs, us),
            (true, _) => (us, vs.iter().rev().map(|v| 1.0 - v).collect()),
        }
    }

    /// Whether it, or what it was cut from, goes through scattered points: it is analytic over its triangles.
    pub fn is_scattered(&self) -> bool {
        matches!(self.parts().shape, Shape::Scatter(_))
    }

    /// The triangles of (u, v) over which the surface is analytic, all of a whole surface through scattered points; empty for others.
    pub fn triangles(&self) -> Vec<[DVec2; 3]> {
        let Shape::Scatter(field) = &self.parts().shape else { return Vec::new() };
        let turn = |c: DVec2| if self.parts().flipped { DVec2::new(c.x, 1.0 - c.y) } else { c };
        field.pieces().iter().map(|piece| piece.corners.map(turn)).collect()
    }

    /// Ends of the cells that the report samples: network lines and kinks (of a net: knots), inner ones, u first.
    pub fn cells(&self) -> (Vec<f64>, Vec<f64>) {
        self.own_lines(self.parts().shape.cells())
    }

    /// Shares of the way along a straight line between two (u, v) at which it crosses one of [`Surface::breaks`], ascending, 0 and 1 left out.
    pub fn breaks_between(&self, from: (f64, f64), to: (f64, f64)) -> Vec<f64> {
        let (us, vs) = self.breaks();
        let along = |lines: Vec<f64>, a: f64, b: f64| lines.into_iter().filter(move |_| a != b).map(move |x| (x - a) / (b - a));
        tidy(along(us, from.0, to.0).chain(along(vs, from.1, to.1)).collect(), f64::EPSILON * 64.0)
    }
}
