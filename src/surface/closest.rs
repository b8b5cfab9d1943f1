//! Nearest points of surfaces.
//!
//! A surface is sampled once; a query starts a safeguarded Newton descent from the best few local minima among the
//! samples. The samples are finer than the bends of the curves below (at least four in every cell between knots), but
//! this is sampling: a dent narrower than a sixteenth of a cell may be missed. The distance found is never below the true one.

use glam::DVec3;

use super::core::{Domain, Side, Surface};
use super::descent::{Local, descend};
use crate::base::tolerance::EPSILON;
use crate::network::Chain;

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
    xs: Vec<f64>,
    ys: Vec<f64>,
    points: Vec<DVec3>,
}

/// Samples along one direction, at the least.
const LEAST: usize = 24;
/// Samples in a cell between breaks, at the least.
const EACH: usize = 4;
/// Samples of a border that no curve carries.
const BORDER: usize = 64;
/// Local minima tried.
const STARTS: usize = 6;

impl Nearest {
    /// Samples the surface.
    pub fn new(surface: &Surface) -> Self {
        if surface.domain() == Domain::Loop && !surface.is_flat() {
            let below = Self::new(&surface.untrimmed());
            return Self { surface: surface.clone(), ..below };
        }
        if !matches!(surface.domain(), Domain::Square | Domain::Triangle) {
            return Self { surface: surface.clone(), xs: Vec::new(), ys: Vec::new(), points: Vec::new() };
        }
        let (us, vs) = surface.cells();
        let (xs, ys) = (stations(&us), stations(&vs));
        let points = surface.square_jets(&xs, &ys).iter().map(|jet| jet.p).collect();
        Self { surface: surface.clone(), xs, ys, points }
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The nearest point of the surface.
    pub fn at(&self, p: DVec3) -> Closest {
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

    fn search(&self, p: DVec3) -> Closest {
        let nx = self.xs.len();
        let far = |k: usize| self.points[k].distance_squared(p);
        let lowest = |k: usize| {
            let (i, j) = (k % nx, k / nx);
            let (low, high) = ((i.saturating_sub(1), j.saturating_sub(1)), ((i + 1).min(nx - 1), (j + 1).min(self.ys.len() - 1)));
            (low.1..=high.1).all(|b| (low.0..=high.0).all(|a| far(k) <= far(b * nx + a)))
        };
        let mut starts: Vec<usize> = (0..self.points.len()).filter(|&k| lowest(k)).collect();
        starts.sort_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
        let half_square = |jet: &super::Jet2| {
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
        // All samples of a pole are one start: which of them leads away from it is not known yet.
        let places = starts.iter().scan(None, |last: &mut Option<(DVec3, usize)>, &k| {
            let (p, n) = last.map_or((self.points[k], 1), |(p, n)| {
                if p.distance_squared(self.points[k]) <= EPSILON * EPSILON * p.length_squared() { (p, n) } else { (self.points[k], n + 1) }
            });
            *last = Some((p, n));
            (n <= STARTS).then_some(k)
        });
        let found = places.map(|k| {
            let end = descend(&self.surface, (self.xs[k % nx], self.ys[k / nx]), half_square);
            self.closest(self.surface.from_square(end.place.0, end.place.1), p)
        });
        found.reduce(|best, next| if next.distance < best.distance { next } else { best }).unwrap_or_else(|| self.closest((0.0, 0.0), p))
    }

    /// The foot on the plane.
    fn foot(&self, p: DVec3) -> Closest {
        self.closest(self.surface.flat_uv(p).unwrap_or_default(), p)
    }

    /// The nearest point of the whole surface where that is kept, else the nearest one of the borders.
    fn inside_trim(&self, p: DVec3) -> Closest {
        let below = Self { surface: self.surface.untrimmed(), ..self.clone() };
        let found = below.search(p);
        if self.surface.keeps(found.uv.0, found.uv.1) {
            return found;
        }
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
        (0..self.surface.n_sides()).filter_map(border).min_by(|a, b| a.distance.total_cmp(&b.distance)).unwrap_or(found)
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
    const DEEPEST: u32 = 48;
    let mut open = vec![(whole, 0)];
    let mut turn = 0.0;
    while let Some(((f0, f1), depth)) = open.pop() {
        let (a, b) = (chain.point(f0) - about, chain.point(f1) - about);
        if (f1 - f0) * chain.length() < a.length() + b.length() || depth == DEEPEST {
            turn += crate::base::math::atan2(a.cross(b).dot(normal), a.dot(b));
        } else {
            let middle = 0.5 * (f0 + f1);
            open.push(((middle, f1), depth + 1));
            open.push(((f0, middle), depth + 1));
        }
    }
    turn
}

/// Sample stations between given inner ends of cells.
pub(super) fn stations(inner: &[f64]) -> Vec<f64> {
    let stops = [&[0.0], inner, &[1.0]].concat();
    let each = EACH.max(LEAST.div_ceil(stops.len() - 1));
    let mut all = Vec::with_capacity(each * stops.len());
    for w in stops.windows(2) {
        all.extend((0..each).map(|k| w[0] + (w[1] - w[0]) * k as f64 / each as f64));
    }
    all.push(1.0);
    all
}
