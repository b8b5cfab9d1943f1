//! A surface as a ball rolls on it.

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::math;
use crate::base::tolerance::Tolerance;
use crate::surface::closest::nearest::{Nearest, closest};
use crate::surface::core::plane;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::{Jet2, unit_normal};
use crate::surface::offset::exact::level;
use crate::surface::trims::trim::with_loops;

/// One of the two surfaces.
pub(crate) struct Face {
    /// The part that is kept of it.
    pub kept: Surface,
    /// All of it.
    ground: Surface,
    /// 1 where the ball lies on the side of the normal, else −1.
    pub side: f64,
    near: Nearest,
}

impl Face {
    pub(crate) fn new(surface: &Surface, tolerance: &Tolerance) -> Result<Self> {
        let kept = with_loops(&plane::unmapped(surface, tolerance)?, tolerance)?;
        // What is flat goes on beyond its borders.
        let ground = match level(surface, tolerance) {
            Some(normal) => {
                plane::unbounded(kept.hull().center().reject_from(normal) + normal * flat_height(&kept, normal), normal, surface.origin())?
            }
            None => kept.untrimmed(),
        };
        Ok(Self { near: Nearest::new(&kept), ground, side: 1.0, kept })
    }

    /// Point and derivatives; beyond the borders those of the parabola that goes on there.
    pub fn jet(&self, uv: DVec2) -> Jet2 {
        let inner = self.ground.hold(uv);
        let (jet, d) = (self.ground.jet(inner.x, inner.y), uv - inner);
        // Beyond a pole nothing goes on.
        if d == DVec2::ZERO || unit_normal(&jet).is_none() {
            return jet;
        }
        let (au, av) = (jet.duu * d.x + jet.duv * d.y, jet.duv * d.x + jet.dvv * d.y);
        let p = jet.p + (jet.du + au * 0.5) * d.x + (jet.dv + av * 0.5) * d.y;
        Jet2 { p, du: jet.du + au, dv: jet.dv + av, ..jet }
    }

    /// Where the whole surface is less than smooth: lines of constant u, of constant v; where it closes, there too.
    pub fn breaks(&self) -> [Vec<f64>; 2] {
        let ((us, vs), closed) = (self.ground.breaks(), self.ground.closed());
        let with_seam = |mut all: Vec<f64>, closed: bool| {
            all.extend(closed.then_some(0.0));
            all
        };
        [with_seam(us, closed.0), with_seam(vs, closed.1)]
    }

    /// Whether it closes in u (`axis` 0) or v (1).
    pub fn is_closed(&self, axis: usize) -> bool {
        if axis == 0 { self.ground.closed().0 } else { self.ground.closed().1 }
    }

    /// The nearest place at which it may be evaluated: not far beyond the borders.
    pub fn hold(&self, uv: DVec2) -> DVec2 {
        let inner = self.ground.hold(uv);
        if inner == uv || unit_normal(&self.ground.jet(inner.x, inner.y)).is_none() {
            return inner;
        }
        inner + (uv - inner).clamp(DVec2::splat(-BEYOND), DVec2::splat(BEYOND))
    }

    pub(crate) fn uv_of(&self, p: DVec3) -> DVec2 {
        self.ground.flat_uv(p).unwrap_or_else(|| closest(&self.ground, p).uv).into()
    }

    /// Unit normal of the whole surface at the foot of a point.
    pub fn normal_at(&self, p: DVec3) -> DVec3 {
        unit_normal(&self.jet(self.uv_of(p))).unwrap_or_default()
    }

    /// How far a point is from the whole surface, on the side of its normal.
    pub(crate) fn height(&self, p: DVec3) -> f64 {
        let jet = self.jet(self.uv_of(p));
        (p - jet.p).dot(unit_normal(&jet).unwrap_or_default())
    }

    /// The nearest point of the whole surface.
    pub fn foot(&self, p: DVec3) -> DVec3 {
        self.jet(self.uv_of(p)).p
    }

    /// A place, whole turns away where the surface closes, as near as it can be to another one.
    pub fn turned_to(&self, uv: DVec2, to: DVec2) -> DVec2 {
        let closed = self.ground.closed();
        let turn = |x: f64, near: f64, closed: bool| if closed { x + (near - x).round() } else { x };
        DVec2::new(turn(uv.x, to.x, closed.0), turn(uv.y, to.y, closed.1))
    }

    /// Distance of a point from the kept part.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.near.at(p).distance
    }

    /// Whether the kept part goes on from one of its points in a direction.
    pub(crate) fn runs_on(&self, p: DVec3, direction: DVec3, step: f64) -> bool {
        self.distance(p + direction * step) <= RUNS_ON * step
    }

    /// Whether a point of the whole surface is on the border of the kept part, within about a distance.
    pub fn on_border(&self, p: DVec3, point: f64) -> bool {
        const WAYS: usize = 16;
        let normal = self.normal_at(p);
        let across = math::any_normal(normal);
        let up = normal.cross(across);
        let way = |k: usize| {
            let (sin, cos) = math::sin_cos(k as f64 * std::f64::consts::TAU / WAYS as f64);
            across * cos + up * sin
        };
        self.distance(p) <= point && (0..WAYS).any(|k| self.distance(p + way(k) * point) > 0.5 * point)
    }
}

/// Height of a flat surface along its normal.
fn flat_height(surface: &Surface, normal: DVec3) -> f64 {
    let (u, v) = MIDDLE;
    surface.untrimmed().point(u, v).dot(normal)
}

/// How far beyond its borders a surface may go on, in u and v.
pub(crate) const BEYOND: f64 = 0.25;
/// A place in the middle of squares and triangles.
pub(crate) const MIDDLE: (f64, f64) = (0.25, 0.25);
/// A surface counts as running on in a direction when a step that way leaves it by no more than this share of the step.
const RUNS_ON: f64 = 0.05;
