//! Nearest points of surfaces.
//!
//! Of a profile extruded or turned the profile's own nearest point is taken, found by bounds (`SweptProfile`). Any other
//! surface is sampled once; a query starts a safeguarded Newton descent from the best few local minima among the samples of each
//! rectangle between creases; blocks of samples whose box is too far away are not looked at. The samples are finer than the bends of
//! the curves below (at least four in every cell between knots), but this is sampling: a dent narrower than a sixteenth of a cell
//! may be missed. The distance found is never below the true one.

use std::sync::OnceLock;

use glam::DVec3;

use crate::base::job;
use crate::base::tolerance::EPSILON;
use crate::network::Chain;
use crate::surface::closest::descent::{Local, descend_within};
use crate::surface::closest::samples::{Samples, Start};
use crate::surface::closest::swept_profile::SweptProfile;
use crate::surface::core::evaluator::PreparedSurface;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::Domain;
use crate::surface::rails::side::Side;

/// The point of a surface nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Surface parameters.
    pub uv: (f64, f64),
    /// The point there.
    pub point: DVec3,
    /// Its distance, model units.
    pub distance: f64,
}

/// A surface prepared for many queries.
#[derive(Clone, Debug)]
pub struct Nearest {
    surface: Surface,
    /// The surface without its borders, which is sampled.
    whole: Surface,
    swept: Option<SweptProfile>,
    /// Made when first needed.
    sampled: OnceLock<Sampled>,
    /// Which samples a trimmed surface keeps.
    kept: OnceLock<Vec<bool>>,
}

/// The samples of a surface, with the surface prepared for many evaluations; a plane has no samples.
#[derive(Clone, Debug)]
struct Sampled {
    prepared: PreparedSurface,
    samples: Samples,
}

/// Creases and seams that a descent goes through, at the most.
const BEYOND: usize = 16;
/// Samples of a border without a curve.
const BORDER: usize = 64;

impl Nearest {
    /// Samples the surface.
    pub fn new(surface: &Surface) -> Self {
        let whole = if surface.domain() == Domain::Loop && !surface.is_flat() { surface.untrimmed() } else { surface.clone() };
        let swept = SweptProfile::of(&whole);
        Self { surface: surface.clone(), whole, swept, sampled: OnceLock::new(), kept: OnceLock::new() }
    }

    fn sampled(&self) -> &Sampled {
        self.sampled.get_or_init(|| match self.whole.domain() {
            Domain::Square | Domain::Triangle => Sampled { samples: Samples::new(&self.whole), prepared: self.whole.quick() },
            _ => Sampled { samples: Samples::default(), prepared: PreparedSurface::plain(&self.whole) },
        })
    }

    /// Point and derivatives at a place of the unit square.
    fn jet(&self, x: f64, y: f64) -> Jet2 {
        self.sampled().prepared.evaluator().square_jet(x, y)
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The samples held.
    pub fn samples(&self) -> usize {
        self.sampled.get().map_or(0, |sampled| sampled.samples.len())
    }

    /// The nearest point of the surface.
    pub fn at(&self, p: DVec3) -> Closest {
        job::poll();
        match self.surface.domain() {
            Domain::Unbounded => self.foot(p),
            Domain::Loop if self.surface.is_flat() => self.inside_loop(p),
            Domain::Loop => self.inside_trim(p),
            Domain::Square | Domain::Triangle => self.search(p),
        }
    }

    fn closest(&self, uv: (f64, f64), p: DVec3) -> Closest {
        let point = self.surface.point(uv.0, uv.1);
        Closest { uv, point, distance: point.distance(p) }
    }

    /// The nearest point of the surface without its borders.
    fn search(&self, p: DVec3) -> Closest {
        if let Some(uv) = self.swept.as_ref().and_then(|swept| swept.at(p)) {
            return self.closest(uv, p);
        }
        self.lowest(p, None, |_| true).unwrap_or_else(|| self.closest((0.0, 0.0), p))
    }

    /// The least local minimum of the distance that counts, found from samples, or from those that are kept.
    fn lowest(&self, p: DVec3, kept: Option<&[bool]>, counts: impl Fn((f64, f64)) -> bool) -> Option<Closest> {
        let mut best: Option<Closest> = None;
        for start in self.sampled().samples.starts(p, kept) {
            if best.is_some_and(|best| best.distance <= start.least.max(EPSILON * p.length())) {
                continue;
            }
            let found = self.descend(start, p);
            if counts(found.uv) && best.is_none_or(|best| found.distance < best.distance) {
                best = Some(found);
            }
        }
        best
    }

    /// Goes down to a local minimum of the distance, through creases and seams.
    fn descend(&self, start: Start, p: DVec3) -> Closest {
        let half_square = |jet: &Jet2| {
            let gap = jet.p - p;
            Local {
                value: 0.5 * gap.length_squared(),
                gradient: [gap.dot(jet.du), gap.dot(jet.dv)],
                hessian: [
                    jet.du.length_squared() + gap.dot(jet.duu),
                    jet.du.dot(jet.dv) + gap.dot(jet.duv),
                    jet.dv.length_squared() + gap.dot(jet.dvv),
                ],
            }
        };
        let down = |start: Start| {
            let (x, y) = descend_within(&|x, y| self.jet(x, y), start.within, start.place, half_square).place;
            (Start { place: (x, y), ..start }, self.jet(x, y).p)
        };
        let (mut end, mut point) = down(start);
        for _ in 0..BEYOND {
            let next = self.sampled().samples.beyond(end.place, end.within).map(down);
            let Some(next) = next.min_by(|a, b| a.1.distance_squared(p).total_cmp(&b.1.distance_squared(p))) else { break };
            if next.1.distance_squared(p) >= point.distance_squared(p) {
                break;
            }
            (end, point) = next;
        }
        Closest { uv: self.whole.from_square(end.place.0, end.place.1), point, distance: point.distance(p) }
    }

    /// The foot on the plane.
    fn foot(&self, p: DVec3) -> Closest {
        self.closest(self.surface.flat_uv(p).unwrap_or_default(), p)
    }

    /// The nearest point of the whole surface where that is kept, else the nearest one of the borders and of what is kept inside.
    fn inside_trim(&self, p: DVec3) -> Closest {
        let found = self.search(p);
        let keeps = |(u, v): (f64, f64)| self.surface.keeps(u, v);
        if keeps(found.uv) {
            return found;
        }
        let kept = self.kept.get_or_init(|| self.sampled().samples.places().map(|(x, y)| keeps(self.whole.from_square(x, y))).collect());
        let inside = self.lowest(p, Some(kept), keeps);
        let border = |k: usize| match (self.surface.side(k), self.surface.border_line(k)) {
            (Side::Chain { chain, .. }, _) => {
                let (f, point, distance) = chain.closest(p);
                Some(Closest { uv: self.surface.border_place(k, f).unwrap_or_default(), point, distance })
            }
            (_, Some((a, b))) => {
                let uv = |t: f64| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
                let far = |t: f64| self.closest(uv(t), p).distance;
                let best = (0..=BORDER).map(|k| k as f64 / BORDER as f64).min_by(|s, t| far(*s).total_cmp(&far(*t))).unwrap_or(0.0);
                let step = 1.0 / BORDER as f64;
                let t = crate::base::solve::lowest((best - step).max(0.0), (best + step).min(1.0), crate::base::tolerance::NEAREST, far);
                Some(self.closest(uv(t), p))
            }
            _ => None,
        };
        (0..self.surface.n_sides()).filter_map(border).chain(inside).min_by(|a, b| a.distance.total_cmp(&b.distance)).unwrap_or(found)
    }

    /// The foot on the plane where it lies inside the boundary, else the nearest point of the boundary.
    fn inside_loop(&self, p: DVec3) -> Closest {
        let foot = self.foot(p);
        let normal = self.surface.normal(0.5, 0.5);
        let borders: Vec<Chain> = (0..self.surface.n_sides())
            .filter_map(|k| match self.surface.side(k) {
                Side::Chain { chain, from, to } => Some(if from > to { chain.reversed() } else { chain }),
                _ => None,
            })
            .collect();
        let turns: f64 = borders.iter().map(|chain| winding(chain, (0.0, 1.0), foot.point, normal)).sum();
        if turns.abs() > std::f64::consts::PI {
            return foot;
        }
        let nearest = borders.iter().map(|chain| chain.closest(p)).min_by(|a, b| a.2.total_cmp(&b.2));
        nearest.map_or(foot, |(_, point, distance)| Closest { uv: self.surface.flat_uv(point).unwrap_or_default(), point, distance })
    }
}

/// The point of a surface nearest to a given one; for many points make a [`Nearest`] once.
pub fn closest(surface: &Surface, p: DVec3) -> Closest {
    Nearest::new(surface).at(p)
}

/// Angle by which a run of a chain turns about a point, seen against a unit normal, radians.
///
/// A run shorter than the way from its start to the point and on to its end turns as its chord does; longer ones are halved.
fn winding(chain: &Chain, whole: (f64, f64), about: DVec3, normal: DVec3) -> f64 {
    const MAX_DEPTH: u32 = 48;
    let mut open = vec![(whole, 0)];
    let mut turn = 0.0;
    while let Some(((f0, f1), depth)) = open.pop() {
        job::poll();
        let (a, b) = (chain.point(f0) - about, chain.point(f1) - about);
        if (f1 - f0) * chain.length() < a.length() + b.length() || depth == MAX_DEPTH {
            turn += crate::base::math::atan2(a.cross(b).dot(normal), a.dot(b));
        } else {
            let middle = 0.5 * (f0 + f1);
            open.push(((middle, f1), depth + 1));
            open.push(((f0, middle), depth + 1));
        }
    }
    turn
}
