//! One way to evaluate a surface often: by its power form where it has one, else by its shape.

use glam::{DVec2, DVec3};

use crate::base::digest::{StableHash, StableHasher};
use crate::base::range::Interval3;
use crate::surface::core::power_form::{Bends, PowerForm};
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::Jet2;

/// A surface that keeps its power form: what is evaluated often owns one, and passes its [`Evaluator`].
#[derive(Clone, Debug)]
pub struct PreparedSurface {
    surface: Surface,
    power_form: Option<PowerForm>,
}

/// A borrowed surface with its power form, if it has one. Parameters are those of the surface, lengths model units.
#[derive(Clone, Copy, Debug)]
pub struct Evaluator<'a> {
    surface: &'a Surface,
    power_form: Option<&'a PowerForm>,
}

impl Surface {
    /// The surface with its power form, made now or shared with whoever keeps it.
    pub fn prepared(&self) -> PreparedSurface {
        PreparedSurface { surface: self.clone(), power_form: self.power_form() }
    }

    /// The same, with that of a blend of curves too.
    pub fn quick(&self) -> PreparedSurface {
        PreparedSurface { surface: self.clone(), power_form: self.power_form().or_else(|| self.blend_form()) }
    }

    /// Evaluation by the shape alone, for few evaluations.
    pub fn evaluator(&self) -> Evaluator<'_> {
        Evaluator { surface: self, power_form: None }
    }
}

impl PreparedSurface {
    /// The surface without a power form.
    pub fn plain(surface: &Surface) -> Self {
        Self { surface: surface.clone(), power_form: None }
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Its evaluator.
    pub fn evaluator(&self) -> Evaluator<'_> {
        Evaluator { surface: &self.surface, power_form: self.power_form.as_ref() }
    }
}

/// The power form follows from the surface.
impl StableHash for PreparedSurface {
    fn hash_into(&self, to: &mut StableHasher) {
        self.surface.hash_into(to);
    }
}

impl<'a> Evaluator<'a> {
    /// The surface.
    pub fn surface(self) -> &'a Surface {
        self.surface
    }

    /// Whether there is a power form.
    pub fn has_power_form(self) -> bool {
        self.power_form.is_some()
    }

    /// The same surface by its shape alone.
    pub fn without_power_form(self) -> Self {
        Self { power_form: None, ..self }
    }

    /// The point.
    #[inline]
    pub fn point(self, u: f64, v: f64) -> DVec3 {
        self.power_form.map_or_else(|| self.surface.point(u, v), |form| form.point(u, v))
    }

    /// Point, ∂/∂u and ∂/∂v.
    #[inline]
    pub fn tangents(self, u: f64, v: f64) -> [DVec3; 3] {
        let by_shape = || {
            let jet = self.surface.jet(u, v);
            [jet.p, jet.du, jet.dv]
        };
        self.power_form.map_or_else(by_shape, |form| form.tangents(u, v))
    }

    /// Point and all derivatives.
    #[inline]
    pub fn jet(self, u: f64, v: f64) -> Jet2 {
        self.power_form.map_or_else(|| self.surface.jet(u, v), |form| form.jet(u, v))
    }

    /// Point and all derivatives with respect to x and y of the unit square, see [`Surface::square_jet`].
    pub fn square_jet(self, x: f64, y: f64) -> Jet2 {
        self.power_form.map_or_else(|| self.surface.square_jet(x, y), |form| form.jet(x, y))
    }

    /// Ranges of ∂uu, ∂uv and ∂vv over a box inside the surface's parameters, from a blend's power form; `None` where there is none.
    pub fn ranges(self, area: (DVec2, DVec2)) -> Option<[Interval3; 3]> {
        self.power_form?.ranges(area)
    }

    /// Whether it has a power form that [`ranges`](Self::ranges) come from.
    pub fn has_ranges(self) -> bool {
        self.power_form.is_some_and(PowerForm::is_blend)
    }

    /// Second derivatives along a unit vector over a box inside the surface's parameters; `None` where they are not bounded.
    pub fn bends(self, (low, high): (DVec2, DVec2), along: DVec3) -> Option<Bends> {
        if let Some(bends) = self.power_form.and_then(|form| form.bends((low, high), along)) {
            return Some(bends);
        }
        let enclosure = self.surface.enclosure((low.x, high.x), (low.y, high.y));
        let all = [enclosure.duu, enclosure.duv, enclosure.dvv];
        if all.iter().any(Interval3::is_unbounded) {
            return None;
        }
        let ranges = all.map(|r| r.along(along));
        Some(Bends { mid: ranges.map(|r| 0.5 * (r.low + r.high)), slack: ranges.map(|r| 0.5 * (r.high - r.low)), jump: 0.0 })
    }
}
