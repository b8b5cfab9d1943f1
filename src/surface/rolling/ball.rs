//! Two surfaces, the edge in which they meet, and on which side of each the ball rolls.

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::closest::foot;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::unit_normal;
use crate::surface::faults::{BlendFault, NoBlend};
use crate::surface::rolling::face::Face;
use crate::surface::rolling::station::{BallStation, Place, station};

/// Places along the edge at which a radius is tried.
pub(crate) const STARTS: usize = 16;
/// Steps in which the radius grows to the one that is asked for.
const GROWTH: usize = 8;
/// Steps by which directions are tried, as a share of the edge's length.
const PROBE: f64 = 1.0 / 8192.0;

/// A place of the edge from which the ball starts.
pub(crate) struct BallStart {
    pub at: DVec3,
    pub along: DVec3,
    uv: [DVec2; 2],
    /// Unit directions on both surfaces, across the edge, to where the ball touches.
    out: [DVec3; 2],
}

/// About where a ball touches.
pub(crate) struct Guess {
    pub uv: [DVec2; 2],
    pub points: [DVec3; 2],
}

/// What rolls.
pub(crate) struct Ball {
    pub faces: [Face; 2],
    pub edge: Chain,
    pub closed: bool,
    pub origins: [Origin; 2],
    pub tolerance: Tolerance,
    pub starts: Vec<BallStart>,
}

impl Ball {
    pub fn new(surfaces: [&Surface; 2], edge: Chain, keep: Option<DVec3>, tolerance: &Tolerance) -> Result<Self> {
        let faces = [Face::new(surfaces[0], tolerance)?, Face::new(surfaces[1], tolerance)?];
        let origins = surfaces.map(Surface::origin);
        let closed = edge.is_closed(tolerance);
        let mut ball = Self { faces, edge, closed, origins, tolerance: *tolerance, starts: Vec::new() };
        ball.starts = (0..=STARTS).map(|k| ball.start(k as f64 / STARTS as f64)).collect::<Result<_>>()?;
        ball.choose_sides(keep)?;
        if !closed {
            ball.ends_on_borders()?;
        }
        Ok(ball)
    }

    pub fn fault(&self, why: NoBlend) -> crate::base::fault::Fault {
        BlendFault::NoEdge { a: self.origins[0], b: self.origins[1], why }.into()
    }

    fn start(&self, f: f64) -> Result<BallStart> {
        let jet = if f == 1.0 { self.edge.jet_before(f) } else { self.edge.jet(f) };
        let uv = [self.faces[0].uv_of(jet.p), self.faces[1].uv_of(jet.p)];
        let tangent = || self.fault(NoBlend::Tangent { at: jet.p });
        let normal = |k: usize| unit_normal(&self.faces[k].jet(uv[k])).ok_or_else(tangent);
        let normals = [normal(0)?, normal(1)?];
        // The edge is within the tolerance of both, its direction less sure: both normals know it.
        let across = math::unit(normals[0].cross(normals[1]), NUDGE).ok_or_else(tangent)?;
        let along = across * across.dot(jet.d1).signum();
        Ok(BallStart { at: jet.p, along, uv, out: normals.map(|n| n.cross(along).normalize_or_zero()) })
    }

    /// Finds on which side of each surface the ball is, and turns the directions away from the edge to where it touches.
    fn choose_sides(&mut self, keep: Option<DVec3>) -> Result<()> {
        let middle = &self.starts[STARTS / 2];
        let step = PROBE * self.edge.length();
        let normals = [0, 1].map(|k: usize| unit_normal(&self.faces[k].jet(middle.uv[k])).unwrap_or_default());
        // It is on the side of a surface on which the other one goes on; where that goes on on both, on that of `keep`, or of the normal.
        let side = |k: usize| {
            let out = middle.out[1 - k];
            match [out, -out].map(|d| self.faces[1 - k].runs_on(middle.at, d, step)) {
                [true, false] => Ok(normals[k].dot(out).signum()),
                [false, true] => Ok(-normals[k].dot(out).signum()),
                _ => keep.map_or(Ok(1.0), |p| {
                    // On the surface itself it is on the side to which it is seen from the edge.
                    let (height, from) = (self.faces[k].height(p), self.edge.closest(p).1);
                    let is_on = height.abs() <= self.tolerance.point;
                    let height = if is_on { (p - from).dot(self.faces[k].normal_at(from)) } else { height };
                    let decides = height.abs() > self.tolerance.point;
                    let (surface, on) = (self.origins[1 - k], self.origins[k]);
                    decides.then_some(height.signum()).ok_or_else(|| self.fault(NoBlend::KeepOn { surface, on, at: p }))
                }),
            }
        };
        let sides = [side(0)?, side(1)?];
        let turns = [0, 1].map(|k: usize| (middle.out[k].dot(normals[1 - k]) * sides[1 - k]).signum());
        for (face, side) in self.faces.iter_mut().zip(sides) {
            face.side = side;
        }
        for start in &mut self.starts {
            for (out, turn) in start.out.iter_mut().zip(turns) {
                *out *= turn;
            }
        }
        Ok(())
    }

    /// An open edge ends on a border of both surfaces.
    fn ends_on_borders(&self) -> Result<()> {
        let step = PROBE * self.edge.length();
        for (start, direction) in [(&self.starts[0], -1.0), (&self.starts[STARTS], 1.0)] {
            for k in 0..2 {
                if self.faces[k].runs_on(start.at, start.along * direction, step) {
                    return Err(self.fault(NoBlend::EndsInside { surface: self.origins[k], at: start.at }));
                }
            }
        }
        Ok(())
    }

    /// The ball beside a place of the edge, grown step by step.
    pub fn grown(&self, start: &BallStart, radius: f64) -> Option<BallStation> {
        let half = 0.5 * math::angle_between(start.out[0], start.out[1]);
        let first = radius / GROWTH as f64 / math::tan(half);
        let step = |k: usize| {
            let jet = self.faces[k].jet(start.uv[k]);
            foot::step(jet.du, jet.dv, start.out[k] * first).map(|s| start.uv[k] + s)
        };
        let mut guess = Guess { uv: [step(0)?, step(1)?], points: start.out.map(|out| start.at + out * first) };
        let (mut before, mut last) = ((start.uv, [start.at; 2]), None);
        for k in 1..=GROWTH {
            let size = radius * k as f64 / GROWTH as f64;
            let found = self.station(size, (start.at, start.along), &guess)?;
            guess.uv = [0, 1].map(|k: usize| found.uv[k] * 2.0 - self.faces[k].turned_to(before.0[k], found.uv[k]));
            guess.points = [0, 1].map(|k: usize| found.feet[k] * 2.0 - before.1[k]);
            before = (found.uv, found.feet);
            last = Some(found);
        }
        last
    }

    /// The ball whose centre is in a plane.
    pub fn station(&self, radius: f64, plane: (DVec3, DVec3), guess: &Guess) -> Option<BallStation> {
        self.at(radius, &Place::Plane(plane.0, plane.1), guess)
    }

    /// The ball at a place.
    pub fn at(&self, radius: f64, place: &Place, guess: &Guess) -> Option<BallStation> {
        let from = |uv: [DVec2; 2]| station(&self.faces, radius, place, uv, self.tolerance.rounding);
        // A step in (u, v) says little beside a pole: there the points say more.
        from(guess.uv).or_else(|| from([0, 1].map(|k: usize| self.faces[k].uv_of(guess.points[k]))))
    }

    /// Whether it touches both surfaces inside their kept parts.
    pub fn holds(&self, station: &BallStation) -> bool {
        (0..2).all(|k| self.faces[k].distance(station.feet[k]) <= self.tolerance.point)
    }

    /// Whether something is left of both surfaces beyond where it touches them.
    pub fn leaves(&self, station: &BallStation) -> bool {
        let step = LEFT * self.tolerance.point;
        self.at_end(station) || (0..2).all(|k| self.faces[k].runs_on(station.feet[k], self.away(station, k), step))
    }

    /// Whether a ball reaches into no surface, and its feet run forwards.
    pub fn fits(&self, station: &BallStation, radius: f64) -> bool {
        (0..2).all(|k| {
            let forward = station.rates[k].dot(station.way) > NUDGE;
            forward && self.faces[k].distance(station.center) >= radius - self.tolerance.point
        })
    }

    /// Unit direction on a surface away from the edge, where the ball touches.
    pub fn away(&self, station: &BallStation, k: usize) -> DVec3 {
        let normal = station.center - station.feet[k];
        let across = station.feet[k] - station.feet[1 - k];
        across.reject_from(normal).normalize_or_zero()
    }

    /// Whether it is the ball beside an end of an open edge.
    fn at_end(&self, station: &BallStation) -> bool {
        let ends = [&self.starts[0], &self.starts[STARTS]];
        !self.closed && ends.into_iter().any(|s| (station.center - s.at).dot(s.along).abs() <= self.tolerance.point)
    }

    /// Whether it touches a surface inside its kept part.
    pub fn is_inside(&self, station: &BallStation, k: usize) -> bool {
        let (face, foot, near) = (&self.faces[k], station.feet[k], 2.0 * self.tolerance.point);
        face.distance(foot) <= near && !face.on_border(foot, near)
    }
}

/// What is left of a surface beyond the ball is as wide as this, in tolerances, at the least.
pub(crate) const LEFT: f64 = 8.0;
