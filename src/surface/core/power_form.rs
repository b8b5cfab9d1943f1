//! A net made ready for many evaluations: one polynomial a span, and bounds of its third derivatives. A blend of curves: see
//! `shapes/blend_powers.rs`.
//!
//! The power form over 0…1 of a span costs a few dozen multiplications a point where the basis functions cost hundreds.
//! With |∂³| known over a box, second derivatives in it are those in its middle and a little more: a bound for the price
//! of one evaluation. `docs/notes/bounds.md` has the formulas.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::base::range::Interval3;
use crate::base::tolerance::{BEFORE_KNOT, EPSILON, UNBOUNDED_REACH};
use crate::base::work;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::blend_powers::BlendPowers;
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::shapes::polynomial_pieces::BoxBends;
use crate::surface::shapes::powers::Powers;

/// Highest degree in powers: about the middle of a span they lose a factor of 2 a degree, here 4e-12 of the size.
const HIGHEST: usize = 14;

/// A net or a blend of curves, ready.
#[derive(Clone, Debug)]
pub struct PowerForm {
    surface: Surface,
    form: Form,
}

#[derive(Clone, Debug)]
enum Form {
    Net(Arc<Powers>),
    Blend(Arc<BlendPowers>),
}

/// Second derivatives along a unit vector over a box.
#[derive(Clone, Copy, Debug)]
pub struct Bends {
    /// Those in the middle: ∂uu, ∂uv, ∂vv.
    pub mid: [f64; 3],
    /// How far they may be from there.
    pub slack: [f64; 3],
    /// How far jumps of first derivatives inside move the surface away from what second ones say, model units.
    pub jump: f64,
}

impl Bends {
    /// What holds both.
    pub fn union(&self, other: &Self) -> Self {
        let of = |bends: &Self| BoxBends { mid: bends.mid, slack: bends.slack };
        let BoxBends { mid, slack } = of(self).union(&of(other));
        Self { mid, slack, jump: self.jump.max(other.jump) }
    }

    /// The most that the second derivative along a step of (u, v) is.
    pub fn along(&self, step: DVec2) -> f64 {
        let squares = [step.x * step.x, 2.0 * step.x * step.y, step.y * step.y];
        let mid: f64 = (0..3).map(|k| self.mid[k] * squares[k]).sum();
        mid.abs() + (0..3).map(|k| self.slack[k] * squares[k].abs()).sum::<f64>()
    }
}

impl Surface {
    /// The net made ready; `None` for surfaces that are none.
    pub fn power_form(&self) -> Option<PowerForm> {
        let Shape::Nurbs(net) = &self.parts().shape else { return None };
        if net.degree.0.max(net.degree.1) > HIGHEST {
            return None;
        }
        Some(PowerForm { surface: self.clone(), form: Form::Net(self.ready().net.take(|| Some(Powers::new(net)))?) })
    }

    /// The blend of curves made ready; `None` for surfaces that are none, for planes with a map and for nets of
    /// straight lines, which are as cheap by themselves.
    pub(super) fn blend_form(&self) -> Option<PowerForm> {
        let Shape::Blend(blend) = &self.parts().shape else { return None };
        let mut rails = blend.along_u().iter().chain(blend.along_v());
        if self.is_in_plane() || rails.all(|rail| rail.is_straight(0.0, 1.0)) {
            return None;
        }
        Some(PowerForm { surface: self.clone(), form: Form::Blend(self.ready().blend.take(|| BlendPowers::new(blend))?) })
    }
}

impl PowerForm {
    /// The shape, and what it was made ready by.
    fn parts(&self) -> Made<'_> {
        match (&self.surface.parts().shape, &self.form) {
            (Shape::Nurbs(net), Form::Net(powers)) => Made::Net(net, powers),
            (Shape::Blend(blend), Form::Blend(powers)) => Made::Blend(blend, powers),
            _ => Made::Neither,
        }
    }

    /// Whether it is that of a blend.
    pub fn is_blend(&self) -> bool {
        matches!(self.form, Form::Blend(_))
    }

    /// Lines at which first derivatives may jump, of u or of v.
    fn corners(&self, in_u: bool) -> &[f64] {
        match &self.form {
            Form::Net(powers) if in_u => &powers.corners.0,
            Form::Net(powers) => &powers.corners.1,
            Form::Blend(powers) => powers.corners(in_u),
        }
    }

    /// The point alone.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let (u, v) = self.surface.wrapped(u, v);
        let (u, v, _) = self.surface.inner(u, v, (OneSided::After, OneSided::After));
        match self.parts() {
            Made::Net(_, powers) => {
                work::spend(1);
                powers.point(u, v)
            }
            Made::Blend(blend, powers) => {
                work::spend(1);
                powers.point(blend, u, v).unwrap_or_else(|| self.by_shape(u, v).p)
            }
            Made::Neither => self.by_shape(u, v).p,
        }
    }

    /// By the shape, in its own parameters.
    fn by_shape(&self, u: f64, v: f64) -> Jet2 {
        self.surface.parts().shape.jet(u, v, (OneSided::After, OneSided::After))
    }

    /// Point, ∂/∂u and ∂/∂v.
    pub fn tangents(&self, u: f64, v: f64) -> [DVec3; 3] {
        let (u, v) = self.surface.wrapped(u, v);
        let (u, v, _) = self.surface.inner(u, v, (OneSided::After, OneSided::After));
        let own = match self.parts() {
            Made::Net(_, powers) => {
                work::spend(1);
                powers.tangents(u, v)
            }
            _ => self.own_jet(u, v),
        };
        let jet = self.surface.outer(own);
        [jet.p, jet.du, jet.dv]
    }

    /// Point and all derivatives.
    pub fn jet(&self, u: f64, v: f64) -> Jet2 {
        let (u, v) = self.surface.wrapped(u, v);
        let (u, v, _) = self.surface.inner(u, v, (OneSided::After, OneSided::After));
        self.surface.outer(self.own_jet(u, v))
    }

    /// The same in the shape's own parameters.
    fn own_jet(&self, u: f64, v: f64) -> Jet2 {
        match self.parts() {
            Made::Net(_, powers) => {
                work::spend(1);
                powers.jet(u, v)
            }
            Made::Blend(blend, powers) => {
                work::spend(1);
                powers.jet(blend, u, v).unwrap_or_else(|| self.by_shape(u, v))
            }
            Made::Neither => self.by_shape(u, v),
        }
    }

    /// A box in the shape's own parameters; `None` over a seam.
    fn own_box(&self, (low, high): (DVec2, DVec2)) -> Option<(DVec2, DVec2)> {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        // Round the middle: a box over a seam leaves the parameters at one side and is not answered.
        let (u, v) = self.surface.wrapped(middle.x, middle.y);
        let (u, v, _) = self.surface.inner(u, v, (OneSided::After, OneSided::After));
        let (low, high) = (DVec2::new(u, v) - half, DVec2::new(u, v) + half);
        (low.min_element() >= -EPSILON && high.max_element() <= 1.0 + EPSILON).then_some((low, high))
    }

    /// Second derivatives along a unit vector over a box of (u, v), and what jumps of first ones inside add; `None` over a seam.
    pub fn bends(&self, (low, high): (DVec2, DVec2), along: DVec3) -> Option<Bends> {
        work::spend(4);
        let (low, high) = self.own_box((low, high))?;
        let bends = match self.parts() {
            Made::Net(net, powers) => over_spans((net, powers), (low, high), along)?,
            Made::Blend(blend, powers) => powers.bends(blend, (low, high), along)?,
            Made::Neither => return None,
        };
        Some(Bends { jump: self.jump((low, high), along), ..self.turned(&bends) })
    }

    /// Ranges of ∂uu, ∂uv and ∂vv over a box of (u, v); `None` of a net, over a seam, and where first derivatives jump inside.
    pub fn ranges(&self, (low, high): (DVec2, DVec2)) -> Option<[Interval3; 3]> {
        let Made::Blend(blend, powers) = self.parts() else { return None };
        work::spend(4);
        let (low, high) = self.own_box((low, high))?;
        let [duu, duv, dvv] = powers.ranges(blend, (low, high))?;
        Some([duu, if self.surface.parts().flipped { -duv } else { duv }, dvv])
    }

    /// How far jumps of first derivatives in a box of the shape's own parameters move the surface along a unit vector away from
    /// what second derivatives say of it between any three places in the box. `docs/notes/bounds.md` has the formula.
    fn jump(&self, (low, high): (DVec2, DVec2), along: DVec3) -> f64 {
        let own = |lines: &[f64], (a, b): (f64, f64), at: &dyn Fn(f64) -> f64| {
            crossed(lines, a, b).map(|c| at(c) * (c - a) * (b - c) / (b - a)).sum::<f64>()
        };
        let (wide, high_up) = ((low.x, high.x), (low.y, high.y));
        own(self.corners(true), wide, &|c| self.jump_along(true, c, high_up, along))
            + own(self.corners(false), high_up, &|c| self.jump_along(false, c, wide, along))
    }

    /// The largest jump of the first derivative across a line, along a unit vector, between two places of it.
    fn jump_along(&self, in_u: bool, c: f64, (low, high): (f64, f64), along: DVec3) -> f64 {
        let place = |x: f64, y: f64| if in_u { DVec2::new(x, y) } else { DVec2::new(y, x) };
        let middle = 0.5 * (low + high);
        let beside = |x: f64| {
            let at = place(x, middle);
            let jet = self.surface.outer(self.own_jet(at.x, at.y));
            if in_u { (jet.du, jet.duv) } else { (jet.dv, jet.duv) }
        };
        let (before, after) = (beside(c - BEFORE_KNOT), beside(c));
        let off = (after.0 - before.0).dot(along).abs();
        // How the jump changes along the line: by the mixed derivatives beside it.
        let strip = |x: f64| match self.parts() {
            Made::Net(net, powers) => over_spans((net, powers), (place(x, low), place(x, high)), along),
            Made::Blend(blend, powers) => powers.bends(blend, (place(x, low), place(x, high)), along),
            Made::Neither => None,
        };
        let (Some(a), Some(b)) = (strip(c - BEFORE_KNOT), strip(c + BEFORE_KNOT)) else { return UNBOUNDED_REACH };
        off + 0.5 * (high - low) * ((b.mid[1] - a.mid[1]).abs() + a.slack[1] + b.slack[1])
    }

    /// Middles and half widths turned as second derivatives are.
    fn turned(&self, own: &BoxBends) -> Bends {
        let range = |k: usize| DVec3::new(own.mid[k], own.slack[k], 0.0);
        let turned = self.surface.outer(Jet2 { duu: range(0), duv: range(1), dvv: range(2), ..Jet2::default() });
        let ranges = [turned.duu, turned.duv, turned.dvv];
        Bends { mid: ranges.map(|r| r.x), slack: ranges.map(|r| r.y.abs()), jump: 0.0 }
    }
}

/// A shape with what it was made ready by.
enum Made<'a> {
    Net(&'a NurbsSurface, &'a Powers),
    Blend(&'a Blend, &'a BlendPowers),
    Neither,
}

/// Second derivatives of a net over a box, part by part between knots where they jump.
fn over_spans((net, powers): (&NurbsSurface, &Powers), (low, high): (DVec2, DVec2), along: DVec3) -> Option<BoxBends> {
    let mut whole: Option<BoxBends> = None;
    let mut from = low;
    for y in crossed(&powers.rough.1, low.y, high.y).chain([high.y]) {
        from.x = low.x;
        for x in crossed(&powers.rough.0, low.x, high.x).chain([high.x]) {
            let own = powers.bends(net, (from, DVec2::new(x, y)), along);
            whole = Some(whole.map_or(own, |w| w.union(&own)));
            from.x = x;
        }
        from.y = y;
    }
    whole
}

/// Lines strictly inside an interval.
fn crossed(lines: &[f64], low: f64, high: f64) -> impl Iterator<Item = f64> + '_ {
    lines.iter().copied().filter(move |x| *x > low + EPSILON && *x < high - EPSILON)
}
