//! A curve of a net that is a fixed sum of others: what a spline through sections is between them.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::range::Interval3;
use crate::base::tolerance::Tolerance;
use crate::geometry::{Jet, Motion};
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::Line;
use crate::surface::rails::rail::Rail;

/// A sum of curves in one parameter. Its shares sum to 1, so that it moves as they do.
#[derive(Clone, Debug)]
pub struct Mixed {
    parts: Vec<Part>,
}

/// One curve of a sum.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its share.
    pub by: f64,
    /// The curve.
    pub rail: Rail,
    /// A plane onto which it is dropped first: a point and the unit normal.
    pub onto: Option<(DVec3, DVec3)>,
}

crate::content!(Mixed { parts });
crate::content!(Part { by, rail, onto });

impl Part {
    fn jet(&self, x: f64, side: OneSided) -> Jet {
        let jet = self.rail.jet(x, side);
        let Some((at, n)) = self.onto else { return jet };
        let flat = |v: DVec3| v - n * n.dot(v);
        Jet { p: at + flat(jet.p - at), d1: flat(jet.d1), d2: flat(jet.d2) }
    }

    fn line(&self, x0: f64, x1: f64) -> Line {
        let line = self.rail.line(x0, x1);
        let Some((_, n)) = self.onto else { return line };
        let flat = |r: Interval3| r + -(r.along(n) * n);
        Line::new(line.half, self.jet(0.5 * (x0 + x1), OneSided::After), Some(flat(line.d1)), flat(line.d2))
    }
}

impl Mixed {
    /// The sum of some curves whose shares sum to 1; each of them knows its kinks as lines of the surface.
    pub fn new(mut parts: Vec<Part>, tolerance: &Tolerance) -> Self {
        for part in &mut parts {
            let own = part.rail.kink_lines(tolerance);
            part.rail.set_kinks(own);
        }
        Self { parts }
    }

    /// Point and derivatives.
    pub fn jet(&self, x: f64, side: OneSided) -> Jet {
        self.parts.iter().fold(Jet::default(), |sum, part| {
            let jet = part.jet(x, side);
            Jet { p: sum.p + jet.p * part.by, d1: sum.d1 + jet.d1 * part.by, d2: sum.d2 + jet.d2 * part.by }
        })
    }

    /// Points at many parameters in ascending or descending order.
    pub fn points(&self, xs: &[f64]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; xs.len()];
        for part in &self.parts {
            let flat = |p: DVec3| part.onto.map_or(p, |(at, n)| p - n * n.dot(p - at));
            sums.iter_mut().zip(part.rail.points(xs)).for_each(|(sum, p)| *sum += flat(p) * part.by);
        }
        sums
    }

    /// Its bounds over `x0 < x1`.
    pub fn line(&self, x0: f64, x1: f64) -> Line {
        Line::sum(self.parts.iter().map(|part| (part.by, part.line(x0, x1))))
    }

    /// Kinks of all its curves, as [`Rail::kink_lines`] has them.
    pub fn kink_lines(&self, tolerance: &Tolerance) -> Vec<(f64, f64)> {
        self.parts.iter().flat_map(|part| part.rail.kink_lines(tolerance)).collect()
    }

    /// Tells its curves which kink lines of the surface their kinks became.
    pub fn set_kinks(&mut self, lines: &[(f64, f64)]) {
        for part in &mut self.parts {
            let line_of = |&(x, f): &(f64, f64)| {
                let same = lines.iter().filter(|l| l.1 == f);
                (same.map(|l| l.0).min_by(|a, b| (a - x).abs().total_cmp(&(b - x).abs())).unwrap_or(x), f)
            };
            let own = part.rail.kinks().iter().map(line_of).collect();
            part.rail.set_kinks(own);
        }
    }

    /// Kink lines of its curves.
    pub fn kinks(&self) -> Vec<(f64, f64)> {
        self.parts.iter().flat_map(|part| part.rail.kinks()).collect()
    }

    /// Surface parameters where it is less than smooth.
    pub fn breaks(&self, out: &mut Vec<f64>) {
        self.parts.iter().for_each(|part| part.rail.breaks(out));
    }

    /// The mean length of its curves, by their shares.
    pub fn length(&self) -> f64 {
        self.parts.iter().map(|part| part.by * part.rail.length()).sum::<f64>().max(0.0)
    }

    /// A box that holds it.
    pub fn hull(&self) -> Box3 {
        let all = self.parts.iter().fold(Box3::EMPTY, |all, part| {
            let own = part.rail.hull();
            let flat = part.onto.map_or(own, |(at, _)| {
                // Dropped onto the plane no point is farther from a point of it than before.
                let reach = DVec3::splat((own.min - at).abs().max((own.max - at).abs()).length());
                Box3 { min: at - reach, max: at + reach }
            });
            all.union(own).union(flat)
        });
        let reach: f64 = self.parts.iter().map(|part| part.by.abs()).sum();
        let (center, half) = (all.center(), (all.max - all.min) * (0.5 * reach));
        Box3 { min: center - half, max: center + half }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let one = |part: &Part| {
            let onto = part.onto.map(|(at, n)| (motion.point(at), motion.vector(n).normalize_or_zero()));
            Part { by: part.by, rail: part.rail.moved(motion), onto }
        };
        Self { parts: self.parts.iter().map(one).collect() }
    }
}
