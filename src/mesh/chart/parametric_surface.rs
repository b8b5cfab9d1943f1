//! What the free mesher evaluates of a surface and of a size: nothing else is known here.

use glam::{DVec2, DVec3};

use crate::surface::step;

/// A point of the surface with its derivatives by the chart's x and y.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spot {
    /// The point.
    pub p: DVec3,
    /// ∂/∂x.
    pub dx: DVec3,
    /// ∂/∂y.
    pub dy: DVec3,
}

impl Spot {
    /// Unit normal; zero where the surface is singular.
    pub fn normal(&self) -> DVec3 {
        self.dx.cross(self.dy).normalize_or_zero()
    }

    /// The step in the chart whose image is the tangential part of `d`, to first order; `None` where the surface is singular.
    pub fn step(&self, d: DVec3) -> Option<DVec2> {
        step(self.dx, self.dy, d)
    }
}

/// Second-order expansion about a place of the chart.
#[derive(Clone, Copy, Debug, Default)]
pub struct LocalExpansion {
    /// The place itself.
    pub spot: Spot,
    /// ∂²/∂x², ∂²/∂x∂y and ∂²/∂y².
    pub bends: [DVec3; 3],
}

impl LocalExpansion {
    /// Point and derivatives at a distance in the chart from the place.
    pub fn spot(&self, d: DVec2) -> Spot {
        let Spot { p, dx, dy } = self.spot;
        let [xx, xy, yy] = self.bends;
        let (by_x, by_y) = (xx * d.x + xy * d.y, xy * d.x + yy * d.y);
        Spot { p: p + (dx + by_x * 0.5) * d.x + (dy + by_y * 0.5) * d.y, dx: dx + by_x, dy: dy + by_y }
    }
}

/// A surface over the plane of its chart, in which lengths are nearly those in space on average.
pub trait ParametricSurface: Sync {
    /// Point and derivatives.
    fn spot(&self, xy: DVec2) -> Spot;
    /// The expansion about a place; a plane where second derivatives are not known.
    fn expansion(&self, xy: DVec2) -> LocalExpansion {
        LocalExpansion { spot: self.spot(xy), ..LocalExpansion::default() }
    }
    /// The point alone.
    fn point(&self, xy: DVec2) -> DVec3 {
        self.spot(xy).p
    }
    /// The origin of the chart, where the surface is a plane and lengths and angles in the chart are those in it; else `None`.
    fn plane(&self) -> Option<Spot> {
        None
    }
    /// The nearest place where the surface is defined.
    fn clamp(&self, xy: DVec2) -> DVec2;
}

/// Wanted edge length over a surface.
pub trait SizeField: Sync {
    /// Model units, positive.
    fn size(&self, xy: DVec2, p: DVec3) -> f64;

    /// Whether it is the same everywhere.
    fn is_even(&self) -> bool {
        false
    }
}

/// One length everywhere, model units.
pub struct UniformSize(pub f64);

impl SizeField for UniformSize {
    fn size(&self, _: DVec2, _: DVec3) -> f64 {
        self.0
    }

    fn is_even(&self) -> bool {
        true
    }
}

/// Foot of a point near a place of the chart: one or two Gauss–Newton steps, enough where the point is near the surface.
pub fn foot(chart_surface: &dyn ParametricSurface, from: DVec2, wanted: DVec3) -> (DVec2, DVec3) {
    let (xy, spot) = foot_spot(chart_surface, from, wanted);
    (xy, spot.p)
}

/// The same with the derivatives there.
pub fn foot_spot(chart_surface: &dyn ParametricSurface, from: DVec2, wanted: DVec3) -> (DVec2, Spot) {
    let mut xy = from;
    let mut spot = chart_surface.spot(xy);
    for _ in 0..2 {
        let d = wanted - spot.p;
        let Some(step) = spot.step(d) else { break };
        xy = chart_surface.clamp(xy + step);
        spot = chart_surface.spot(xy);
        let moved = spot.dx * step.x + spot.dy * step.y;
        // On a flat place one step reaches the foot.
        if (wanted - spot.p).dot(moved).abs() <= MAX_FOOT_ERROR * moved.length_squared() {
            break;
        }
    }
    (xy, spot)
}

/// Foot from a guess that is a mean of places in the chart; the guess itself where it is off by less than `MAX_GUESS_ERROR` of `step`.
/// Near a pole such a mean is not a foot.
pub fn foot_near(chart_surface: &dyn ParametricSurface, guess: DVec2, wanted: DVec3, step: f64) -> (DVec2, Spot) {
    let spot = chart_surface.spot(guess);
    let off = spot.step(wanted - spot.p).map_or(0.0, |d| (spot.dx * d.x + spot.dy * d.y).length_squared());
    if off > MAX_GUESS_ERROR * MAX_GUESS_ERROR * step * step { foot_spot(chart_surface, guess, wanted) } else { (guess, spot) }
}

/// Share of a step by which a guess of its end may be off.
const MAX_GUESS_ERROR: f64 = 0.1;
/// Share of a step that may be left to the foot at its end.
const MAX_FOOT_ERROR: f64 = 0.02;
