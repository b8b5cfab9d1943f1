//! The chart of a surface: its parameters sheared and scaled so that lengths in the chart are those in space on average.

use glam::{DVec2, DVec3};

use crate::base::tolerance::{EPSILON, WHOLE_NUMBER};
use crate::mesh::chart::outline::Outline;
use crate::mesh::chart::parametric_surface::{LocalExpansion, ParametricSurface, Spot};
use crate::surface::core::evaluator::PreparedSurface;
use crate::surface::{Domain, Evaluator, Jet2, Surface};

/// A surface under a chart (x, y) = (a u + b v, c v).
#[derive(Clone, Debug)]
pub struct Chart {
    surface: PreparedSurface,
    domain: Domain,
    /// Directions in which borders may run over the seam.
    closed: (bool, bool),
    a: f64,
    b: f64,
    c: f64,
    /// 1 / a and 1 / c.
    by: (f64, f64),
}

impl Chart {
    /// The chart whose mean metric over some places is that of the plane; `None` where the surface is singular all over.
    pub fn new(surface: &Surface, places: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let (mut e, mut f, mut g, mut n) = (0.0, 0.0, 0.0, 0.0);
        for (u, v) in places {
            let jet = surface.jet(u, v);
            e += jet.du.length_squared();
            f += jet.du.dot(jet.dv);
            g += jet.dv.length_squared();
            n += 1.0;
        }
        let (e, f, g) = (e / n, f / n, g / n);
        let a = f64::sqrt(e);
        let b = f / a;
        let rest = g - b * b;
        // Parameters that run together are not sheared apart.
        let c = if rest > EPSILON * g { rest.sqrt() } else { g.sqrt() };
        (a.is_finite() && c.is_finite() && a > 0.0 && c > 0.0).then(|| Self {
            surface: surface.quick(),
            domain: surface.ground(),
            closed: if surface.domain() == Domain::Loop { surface.closed() } else { (false, false) },
            a,
            b,
            c,
            by: (1.0 / a, 1.0 / c),
        })
    }

    /// Surface parameters of a place of the chart.
    pub fn uv(&self, xy: DVec2) -> (f64, f64) {
        let v = xy.y * self.by.1;
        ((xy.x - self.b * v) * self.by.0, v)
    }

    /// The box of an outline in the surface's parameters.
    pub fn box_of(&self, outline: &Outline) -> (DVec2, DVec2) {
        let places = outline.xy.iter().map(|xy| DVec2::from(self.uv(*xy)));
        places.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    }

    /// How many lines of constant u, and of constant v, at which the surface is less than analytic, cross the box of an outline.
    pub fn breaks(&self, outline: &Outline) -> [usize; 2] {
        let (low, high) = self.box_of(outline);
        let (us, vs) = self.surface().breaks();
        let inside = |lines: Vec<f64>, low: f64, high: f64| lines.into_iter().filter(|x| low < *x && *x < high).count();
        [inside(us, low.x, high.x), inside(vs, low.y, high.y)]
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        self.surface.surface()
    }

    /// The surface for many evaluations.
    pub fn evaluator(&self) -> Evaluator<'_> {
        self.surface.evaluator()
    }

    /// Point, ∂/∂u and ∂/∂v.
    pub fn tangents(&self, (u, v): (f64, f64)) -> [DVec3; 3] {
        self.evaluator().tangents(u, v)
    }

    /// Point and all derivatives by u and v at a place of the chart.
    pub fn jet(&self, xy: DVec2) -> Jet2 {
        let (u, v) = self.uv(xy);
        self.evaluator().jet(u, v)
    }

    /// A point with its derivatives by the chart's x and y, from those by u and v.
    pub fn spot_of(&self, [p, du, dv]: [DVec3; 3]) -> Spot {
        let dx = du * self.by.0;
        Spot { p, dx, dy: (dv - dx * self.b) * self.by.1 }
    }

    /// The same to second order.
    pub fn expansion_of(&self, jet: &Jet2) -> LocalExpansion {
        let (by_x, by_y) = self.by;
        let dxx = jet.duu * (by_x * by_x);
        let dxv = jet.duv * by_x;
        let bends = [dxx, (dxv - dxx * self.b) * by_y, (jet.dvv - (dxv * 2.0 - dxx * self.b) * self.b) * (by_y * by_y)];
        LocalExpansion { spot: self.spot_of([jet.p, jet.du, jet.dv]), bends }
    }

    /// The place of surface parameters in the chart.
    pub fn xy(&self, (u, v): (f64, f64)) -> DVec2 {
        DVec2::new(self.a * u + self.b * v, self.c * v)
    }
}

impl ParametricSurface for Chart {
    fn spot(&self, xy: DVec2) -> Spot {
        self.spot_of(self.tangents(self.uv(xy)))
    }

    fn expansion(&self, xy: DVec2) -> LocalExpansion {
        self.expansion_of(&self.jet(xy))
    }

    fn point(&self, xy: DVec2) -> DVec3 {
        let (u, v) = self.uv(xy);
        self.evaluator().point(u, v)
    }

    fn plane(&self) -> Option<Spot> {
        let origin = self.spot(DVec2::ZERO);
        let off = [origin.dx.length_squared() - 1.0, origin.dy.length_squared() - 1.0, origin.dx.dot(origin.dy)];
        (self.surface().is_flat() && off.into_iter().all(|x| x.abs() < WHOLE_NUMBER)).then_some(origin)
    }

    fn clamp(&self, xy: DVec2) -> DVec2 {
        let (u, v) = self.uv(xy);
        let inside = |x: f64| (0.0..=1.0).contains(&x);
        let hold = |x: f64, closed: bool| if closed { x } else { x.clamp(0.0, 1.0) };
        match self.domain {
            Domain::Square if inside(u) && inside(v) => xy,
            Domain::Square => self.xy((hold(u, self.closed.0), hold(v, self.closed.1))),
            Domain::Triangle => {
                let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
                let over = 0.5 * (u + v - 1.0).max(0.0);
                self.xy(((u - over).max(0.0), (v - over).max(0.0)))
            }
            Domain::Loop | Domain::Unbounded => xy,
        }
    }
}
