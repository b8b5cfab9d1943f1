//! Curves as rational B-splines, and under affine maps.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::tolerance::Tolerance;
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::fault::CurveFault;
use crate::geometry::data::kind::Kind;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::nurbs::{Nurbs, projected, weighted};

/// Pieces of an approximation at most.
const MOST_PIECES: usize = 1 << 16;

impl Curve {
    /// The image under an affine map, exactly, with its own parameter; `vector` maps differences of what `point` maps.
    /// `None` for helices, offsets and composites.
    pub fn mapped(&self, point: impl Fn(DVec3) -> DVec3, vector: impl Fn(DVec3) -> DVec3) -> Option<Self> {
        let (shape, kind) = match self.shape() {
            Shape::Line(a, b) => (Shape::Line(point(*a), point(*b)), self.kind()),
            Shape::Arc(arc) => {
                let image = EllipticArc::new(point(arc.center), vector(arc.u), vector(arc.v), arc.sweep);
                let kind = if image.radius.is_some() { self.kind() } else { Kind::Ellipse };
                (Shape::Arc(Box::new(image)), kind)
            }
            Shape::Nurbs(c) => {
                let poles = c.poles.iter().map(|q| weighted(point(projected(*q)), q.w)).collect();
                (Shape::Nurbs(Arc::new(Nurbs { poles, knots: c.knots.clone(), ..**c })), self.kind())
            }
            Shape::Helix(_) | Shape::Offset(_) | Shape::Composite(_) => return None,
        };
        Some(Self::new(shape, kind, self.origin()))
    }

    /// The rational B-spline that is the curve itself, if there is one.
    pub fn exact_nurbs(&self) -> Option<Nurbs> {
        match self.shape() {
            Shape::Line(a, b) => Some(Nurbs::line(*a, *b)),
            Shape::Arc(arc) => Some(arc.to_nurbs()),
            Shape::Nurbs(c) => Some(c.as_ref().clone()),
            Shape::Composite(c) => {
                c.pieces.iter().map(Self::exact_nurbs).collect::<Option<Vec<Nurbs>>>().map(|pieces| Nurbs::joined(&pieces))
            }
            Shape::Helix(_) | Shape::Offset(_) => None,
        }
    }

    /// The rational B-spline form; exact where there is one, else within `tolerance.point`.
    pub fn to_nurbs(&self, tolerance: &Tolerance) -> Result<Nurbs> {
        match (self.exact_nurbs(), self.shape()) {
            (Some(exact), _) => Ok(exact),
            (None, Shape::Composite(c)) => {
                let pieces: Result<Vec<Nurbs>> = c.pieces.iter().map(|p| p.to_nurbs(tolerance)).collect();
                Ok(Nurbs::joined(&pieces?))
            }
            (None, _) => self.hermite(tolerance),
        }
    }

    /// Cubic Hermite pieces, halved where the curve leaves them by more than the tolerance.
    fn hermite(&self, tolerance: &Tolerance) -> Result<Nurbs> {
        let mut pieces = Vec::new();
        for span in self.knots().windows(2) {
            let mut open = vec![(span[0], span[1])];
            while let Some((a, b)) = open.pop() {
                let (from, to, h) = (self.jet(a), self.jet_before(b), b - a);
                let poles = [from.p, from.p + from.d1 * (h / 3.0), to.p - to.d1 * (h / 3.0), to.p];
                let cubic = Nurbs::bezier(a, b, poles.iter().map(|p| p.extend(1.0)).collect());
                // The error of a Hermite cubic is a quartic bump; half the tolerance covers what samples miss of it.
                let far = (1..8).any(|i| {
                    let t = a + h * f64::from(i) / 8.0;
                    cubic.jet(t).p.distance(self.point(t)) > 0.5 * tolerance.point
                });
                if !far {
                    pieces.push(cubic);
                } else if pieces.len() + open.len() > MOST_PIECES {
                    return Err(CurveFault::NotConverged { of: self.origin(), what: "the spline form".to_owned(), at: from.p }.into());
                } else {
                    let middle = 0.5 * (a + b);
                    open.push((middle, b));
                    open.push((a, middle));
                }
            }
        }
        Ok(Nurbs::joined(&pieces))
    }
}
