//! Two surfaces, the edge in which they meet, and on which side of each the ball rolls.

use glam::{DVec2, DVec3};

use super::station::{Place, Station, station};
use crate::base::fault::{BlendFault, NoBlend, Result};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::closest::Nearest;
use crate::surface::core::{Jet2, Surface, unit_normal};
use crate::surface::offset::level;
use crate::surface::plane;
use crate::surface::with_loops;

/// Places along the edge at which a radius is tried.
pub(super) const STARTS: usize = 16;
/// Steps in which the radius grows to the one that is asked for.
const GROWTH: usize = 8;
/// A surface counts as running on in a direction when a step that way leaves it by no more than this share of the step.
const RUNS_ON: f64 = 0.05;
/// Steps by which directions are tried, as a share of the edge's length.
const PROBE: f64 = 1.0 / 8192.0;

/// How far beyond its borders a surface may go on, in u and v.
const BEYOND: f64 = 0.25;

/// One of the two surfaces.
pub(super) struct Face {
    /// The part that is kept of it.
    pub kept: Surface,
    /// All of it.
    ground: Surface,
    /// 1 where the ball lies on the side of the normal, else −1.
    pub side: f64,
    near: Nearest,
}

impl Face {
    fn new(surface: &Surface, tolerance: &Tolerance) -> Result<Self> {
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

    fn uv_of(&self, p: DVec3) -> DVec2 {
        self.ground.flat_uv(p).unwrap_or_else(|| crate::surface::closest(&self.ground, p).uv).into()
    }

    /// Unit normal of the whole surface at the foot of a point.
    pub fn normal_at(&self, p: DVec3) -> DVec3 {
        unit_normal(&self.jet(self.uv_of(p))).unwrap_or_default()
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

    /// The nearest point of the kept part.
    pub fn nearest(&self, p: DVec3) -> DVec3 {
        self.near.at(p).point
    }

    /// Distance of a point from the kept part.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.near.at(p).distance
    }

    /// Whether the kept part goes on from one of its points in a direction.
    fn runs_on(&self, p: DVec3, direction: DVec3, step: f64) -> bool {
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

/// A place in the middle of squares and triangles.
const MIDDLE: (f64, f64) = (0.25, 0.25);

/// A place of the edge from which the ball starts.
pub(super) struct Start {
    pub at: DVec3,
    along: DVec3,
    uv: [DVec2; 2],
    /// Unit directions on both surfaces, across the edge, to where the ball touches.
    out: [DVec3; 2],
}

/// About where a ball touches.
pub(super) struct Guess {
    pub uv: [DVec2; 2],
    pub points: [DVec3; 2],
}

/// What rolls.
pub(super) struct Ball {
    pub faces: [Face; 2],
    pub edge: Chain,
    pub closed: bool,
    pub origins: [Origin; 2],
    pub tolerance: Tolerance,
    pub starts: Vec<Start>,
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

    fn start(&self, f: f64) -> Result<Start> {
        let jet = if f == 1.0 { self.edge.jet_before(f) } else { self.edge.jet(f) };
        let uv = [self.faces[0].uv_of(jet.p), self.faces[1].uv_of(jet.p)];
        let tangent = || self.fault(NoBlend::Tangent { at: jet.p });
        let normal = |k: usize| unit_normal(&self.faces[k].jet(uv[k])).ok_or_else(tangent);
        let normals = [normal(0)?, normal(1)?];
        // The edge is within the tolerance of both, its direction less sure: both normals know it.
        let across = math::unit(normals[0].cross(normals[1]), NUDGE).ok_or_else(tangent)?;
        let along = across * across.dot(jet.d1).signum();
        Ok(Start { at: jet.p, along, uv, out: normals.map(|n| n.cross(along).normalize_or_zero()) })
    }

    /// Turns the directions away from the edge to where the ball is, and finds its side of each surface: where a surface runs on
    /// beyond the edge that of `keep`.
    fn choose_sides(&mut self, keep: Option<DVec3>) -> Result<()> {
        let middle = &self.starts[STARTS / 2];
        let step = PROBE * self.edge.length();
        let normals = [0, 1].map(|k: usize| unit_normal(&self.faces[k].jet(middle.uv[k])).unwrap_or_default());
        let near = |p: DVec3| self.starts.iter().min_by(|s, t| s.at.distance(p).total_cmp(&t.at.distance(p)));
        let kept = keep.and_then(|p| near(p).map(|start| (start, p - start.at)));
        let turn = |k: usize| {
            let out = middle.out[k];
            let runs = [out, -out].map(|d| self.faces[k].runs_on(middle.at, d, step));
            match (runs, kept) {
                ([true, false], _) => Ok(1.0),
                ([false, true], _) => Ok(-1.0),
                (_, Some((start, to))) => {
                    let ahead = to.dot(start.out[k]);
                    let tells = ahead.abs() > self.tolerance.point;
                    tells
                        .then_some(ahead.signum())
                        .ok_or_else(|| self.fault(NoBlend::KeepOnEdge { surface: self.origins[k], at: start.at }))
                }
                // The ball is on the side of the other one's normal.
                _ => Ok(out.dot(normals[1 - k]).signum()),
            }
        };
        let turns = [turn(0)?, turn(1)?];
        for k in 0..2 {
            let other = middle.out[1 - k] * turns[1 - k];
            self.faces[k].side = normals[k].dot(other).signum();
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
    pub fn grown(&self, start: &Start, radius: f64) -> Option<Station> {
        let half = 0.5 * math::angle_between(start.out[0], start.out[1]);
        let first = radius / GROWTH as f64 / math::tan(half);
        let step = |k: usize| {
            let jet = self.faces[k].jet(start.uv[k]);
            crate::surface::foot::step(jet.du, jet.dv, start.out[k] * first).map(|s| start.uv[k] + s)
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
    pub fn station(&self, radius: f64, plane: (DVec3, DVec3), guess: &Guess) -> Option<Station> {
        self.at(radius, &Place::Plane(plane.0, plane.1), guess)
    }

    /// The ball at a place.
    pub fn at(&self, radius: f64, place: &Place, guess: &Guess) -> Option<Station> {
        let from = |uv: [DVec2; 2]| station(&self.faces, radius, place, uv, self.tolerance.rounding);
        // A step in (u, v) says little beside a pole: there the points say more.
        from(guess.uv).or_else(|| from([0, 1].map(|k: usize| self.faces[k].uv_of(guess.points[k]))))
    }

    /// Whether it touches both surfaces inside their kept parts.
    pub fn holds(&self, station: &Station) -> bool {
        (0..2).all(|k| self.faces[k].distance(station.feet[k]) <= self.tolerance.point)
    }

    /// Whether something is left of both surfaces beyond where it touches them.
    pub fn leaves(&self, station: &Station) -> bool {
        let step = LEFT * self.tolerance.point;
        self.at_end(station) || (0..2).all(|k| self.faces[k].runs_on(station.feet[k], self.away(station, k), step))
    }

    /// Whether a ball reaches into no surface, and its feet run forwards.
    pub fn fits(&self, station: &Station, radius: f64) -> bool {
        (0..2).all(|k| {
            let forward = station.rates[k].dot(station.way) > NUDGE;
            forward && self.faces[k].distance(station.center) >= radius - self.tolerance.point
        })
    }

    /// Unit direction on a surface away from the edge, where the ball touches.
    pub fn away(&self, station: &Station, k: usize) -> DVec3 {
        let normal = station.center - station.feet[k];
        let across = station.feet[k] - station.feet[1 - k];
        across.reject_from(normal).normalize_or_zero()
    }

    /// Whether it is the ball beside an end of an open edge.
    fn at_end(&self, station: &Station) -> bool {
        let ends = [&self.starts[0], &self.starts[STARTS]];
        !self.closed && ends.into_iter().any(|s| (station.center - s.at).dot(s.along).abs() <= self.tolerance.point)
    }

    /// More balls beyond the ends of an open edge, until they touch inside no surface.
    pub fn run_out(&self, radius: f64, stations: &mut Vec<Station>) {
        const MOST: usize = 16;
        for _ in 0..2 {
            for _ in 0..MOST {
                let last = stations[stations.len() - 1];
                let inside = |k: &usize| {
                    let (face, foot, point) = (&self.faces[*k], last.feet[*k], self.tolerance.point);
                    face.distance(foot) <= 2.0 * point && !face.on_border(foot, 2.0 * point)
                };
                let Some(k) = (0..2).find(inside) else { break };
                let step = last.feet[k].distance(self.edge.closest(last.feet[k]).1);
                let Some(next) = self.station(radius, (last.center + last.way * step, last.way), &Guess { uv: last.uv, points: last.feet })
                else {
                    break;
                };
                stations.push(next);
            }
            stations.reverse();
            stations.iter_mut().for_each(Station::turn);
        }
    }
}

/// What is left of a surface beyond the ball is as wide as this, in tolerances, at the least.
pub(super) const LEFT: f64 = 8.0;
