//! Where a thing is, how it is spread and which side it shows: moments up to the third of curves, surfaces and points.
//!
//! All are integrals in one pass over the thing, in units of its own size, each of them of a density that is nowhere
//! negative: what cancels out or is zero by symmetry asks for no more accuracy than the mass does.

use glam::DVec3;

use super::measure::over;
use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::base::tolerance::MEASURE_ACCURACY;
use crate::geometry::Curve;
use crate::network::{Chain, Run};
use crate::surface::{Domain, Surface};

/// Integrals about a point. Mass is arc length, area or a number of points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Length, area or number, model units to the power of the thing's dimension.
    pub mass: f64,
    /// The point that all that follows is about, model units.
    pub about: DVec3,
    /// ∫ x, ∫ y, ∫ z.
    first: DVec3,
    /// ∫ xx, yy, zz, xy, yz, zx.
    second: [f64; 6],
    /// ∫ xxx, yyy, zzz.
    third: DVec3,
    /// Of a surface ∫ n, the area vector; of a closed curve the area vector of what it goes round, ½ ∮ r × dr.
    pub side: DVec3,
    /// Of a surface ⅓ ∫ r·n: the volume between it and the point.
    pub inside: f64,
}

/// Integrands of one pass.
const N: usize = 17;

impl Moments {
    /// Of a surface; nothing of an unbounded plane.
    pub fn of_surface(surface: &Surface) -> Self {
        if surface.domain() == Domain::Unbounded {
            return Self::default();
        }
        let Frame { about, reach } = Frame::of(surface.hull());
        let (sum, _) = over(surface, about, MEASURE_ACCURACY, &|jet, r| {
            let n = jet.du.cross(jet.dv);
            densities(n.length(), r / reach, n, (r / reach).dot(n))
        });
        let found = Self::from_sums(&sum, about, reach);
        Self { side: found.side, inside: found.inside * reach / 3.0, ..found }
    }

    /// Of a curve.
    pub fn of_curve(curve: &Curve) -> Self {
        Self::of_parts(&[(curve, curve.domain().0, curve.domain().1)], Frame::of(curve.bbox()))
    }

    /// Of a modeling curve.
    pub fn of_chain(chain: &Chain) -> Self {
        let parts: Vec<(&Curve, f64, f64)> = chain.runs().iter().flat_map(|run| spans(run).map(|(a, b)| (&run.curve, a, b))).collect();
        Self::of_parts(&parts, Frame::of(chain.bbox()))
    }

    /// Of points of mass 1 each.
    pub fn of_points(points: impl Iterator<Item = DVec3> + Clone) -> Self {
        let bounds = Box3::of(points.clone());
        if bounds.is_empty() {
            return Self::default();
        }
        let Frame { about, reach } = Frame::of(bounds);
        let mut sum = [0.0; N];
        for p in points {
            add(&mut sum, 1.0, &densities(1.0, (p - about) / reach, DVec3::ZERO, 0.0));
        }
        Self { side: DVec3::ZERO, inside: 0.0, ..Self::from_sums(&sum, about, reach) }
    }

    /// Of pieces of curves between two parameters each; backwards where the second is the smaller one.
    fn of_parts(parts: &[(&Curve, f64, f64)], Frame { about, reach }: Frame) -> Self {
        let density = |curve: &Curve, t: f64, sign: f64| {
            let jet = curve.jet(t);
            let r = (jet.p - about) / reach;
            densities(jet.d1.length(), r, r.cross(jet.d1) * (0.5 * sign), 0.0)
        };
        let rules = [gauss_legendre(6), gauss_legendre(10)];
        let rule_on = |rule: &[(f64, f64)], (curve, a, b): (&Curve, f64, f64)| {
            let (low, high, sign) = if a < b { (a, b, 1.0) } else { (b, a, -1.0) };
            let mut sum = [0.0; N];
            for (x, w) in rule {
                let t = 0.5 * (low + high) + 0.5 * (high - low) * x;
                add(&mut sum, 0.5 * (high - low) * w, &density(curve, t, sign));
            }
            sum
        };
        let mut open: Vec<((&Curve, f64, f64), u32)> = Vec::new();
        for (curve, a, b) in parts {
            let mut stops: Vec<f64> = curve.knots().into_iter().filter(|t| *t > a.min(*b) && *t < a.max(*b)).collect();
            stops.insert(0, a.min(*b));
            stops.push(a.max(*b));
            let turned = |w: &[f64]| if a < b { (*curve, w[0], w[1]) } else { (*curve, w[1], w[0]) };
            open.extend(stops.windows(2).map(|w| (turned(w), 0)));
        }
        let whole: f64 = open.iter().map(|(part, _)| rule_on(&rules[0], *part)[0]).sum();
        let share = MEASURE_ACCURACY * whole / open.len().max(1) as f64;
        let mut sum = [0.0; N];
        while let Some((part, depth)) = open.pop() {
            job::poll();
            const MAX_DEPTH: u32 = 20;
            let (rough, fine) = (rule_on(&rules[0], part), rule_on(&rules[1], part));
            if depth == MAX_DEPTH || rough.iter().zip(&fine).all(|(a, b)| (a - b).abs() <= share) {
                add(&mut sum, 1.0, &fine);
            } else {
                let (curve, a, b) = part;
                let middle = 0.5 * (a + b);
                open.extend([((curve, middle, b), depth + 1), ((curve, a, middle), depth + 1)]);
            }
        }
        let found = Self::from_sums(&sum, about, reach);
        Self { side: found.side * reach, inside: 0.0, ..found }
    }

    /// Takes densities apart again: they hold the mass besides, and lengths in units of `reach`.
    fn from_sums(sum: &[f64; N], about: DVec3, reach: f64) -> Self {
        let bare = |k: usize, scale: f64| (sum[k] - sum[0]) * scale;
        let three = |k: usize, scale: f64| DVec3::new(bare(k, scale), bare(k + 1, scale), bare(k + 2, scale));
        Self {
            mass: sum[0],
            about,
            first: three(1, reach),
            second: std::array::from_fn(|k| bare(4 + k, reach * reach)),
            third: three(10, reach * reach * reach),
            side: three(13, 1.0),
            inside: bare(16, 1.0),
        }
    }

    /// The same about another point. The area vector of an open curve depends on it, that of anything else does not.
    pub fn about(&self, other: DVec3) -> Self {
        let d = other - self.about;
        let (m, f, s) = (self.mass, self.first, self.second);
        let squares = DVec3::new(s[0], s[1], s[2]);
        let cross = |a: usize, b: usize| -d[a] * f[b] - d[b] * f[a] + d[a] * d[b] * m;
        let moved = |k: usize, (a, b): (usize, usize)| s[k] + cross(a, b);
        Self {
            mass: m,
            about: other,
            first: f - d * m,
            second: [moved(0, (0, 0)), moved(1, (1, 1)), moved(2, (2, 2)), moved(3, (0, 1)), moved(4, (1, 2)), moved(5, (2, 0))],
            third: self.third - 3.0 * d * squares + 3.0 * d * d * f - d * d * d * m,
            side: self.side,
            inside: self.inside - d.dot(self.side) / 3.0,
        }
    }

    /// Both together, about this one's point.
    pub fn plus(&self, other: &Self) -> Self {
        let o = other.about(self.about);
        Self {
            mass: self.mass + o.mass,
            about: self.about,
            first: self.first + o.first,
            second: std::array::from_fn(|k| self.second[k] + o.second[k]),
            third: self.third + o.third,
            side: self.side + o.side,
            inside: self.inside + o.inside,
        }
    }

    /// All together; nothing of nothing.
    pub fn total(all: impl IntoIterator<Item = Self>) -> Self {
        let mut all = all.into_iter().filter(|m| m.mass > 0.0);
        let Some(first) = all.next() else { return Self::default() };
        all.fold(first, |sum, m| sum.plus(&m))
    }

    /// The other side up.
    pub fn flipped(&self) -> Self {
        Self { side: -self.side, inside: -self.inside, ..*self }
    }

    /// The same with mass 1; nothing of nothing.
    pub fn of_mass_one(&self) -> Self {
        if self.mass == 0.0 {
            return *self;
        }
        let by = 1.0 / self.mass;
        Self {
            mass: 1.0,
            about: self.about,
            first: self.first * by,
            second: self.second.map(|x| x * by),
            third: self.third * by,
            side: self.side * by,
            inside: self.inside * by,
        }
    }

    /// Centre of mass; `None` without any.
    pub fn centroid(&self) -> Option<DVec3> {
        (self.mass > 0.0).then(|| self.about + self.first / self.mass)
    }

    /// Mean squares about the centroid: xx, yy, zz, xy, yz, zx, square model units.
    pub fn spread(&self) -> [f64; 6] {
        self.centroid().map_or([0.0; 6], |c| self.about(c).of_mass_one().second)
    }

    /// Mean cubes about the centroid: xxx, yyy, zzz, cubic model units.
    pub fn skew(&self) -> DVec3 {
        self.centroid().map_or(DVec3::ZERO, |c| self.about(c).of_mass_one().third)
    }
}

/// What integrals are taken in.
struct Frame {
    /// The origin, near the thing.
    about: DVec3,
    /// The unit of lengths, model units.
    reach: f64,
}

impl Frame {
    /// For what lies in a box.
    fn of(bounds: Box3) -> Self {
        let reach = 0.5 * bounds.diagonal();
        if bounds.is_empty() || !reach.is_finite() {
            return Self { about: DVec3::ZERO, reach: 1.0 };
        }
        Self { about: bounds.center(), reach: if reach > 0.0 { reach } else { 1.0 } }
    }
}

/// Mass `a` at `q` with side `n` and `a`-fold height `h`, each beside the mass, so that none is negative.
fn densities(a: f64, q: DVec3, n: DVec3, h: f64) -> [f64; N] {
    let (x, y, z) = (q.x, q.y, q.z);
    let polynomials = [x, y, z, x * x, y * y, z * z, x * y, y * z, z * x, x * x * x, y * y * y, z * z * z];
    let mut all = [a; N];
    (0..12).for_each(|k| all[k + 1] += a * polynomials[k]);
    (0..3).for_each(|k| all[k + 13] += n[k]);
    all[16] += h;
    all
}

fn add(sum: &mut [f64; N], weight: f64, values: &[f64; N]) {
    (0..N).for_each(|k| sum[k] += weight * values[k]);
}

/// The parameters a run goes between; two pairs where it passes the start of its curve.
fn spans(run: &Run) -> impl Iterator<Item = (f64, f64)> {
    let (length, (first, last)) = (run.curve.length(), run.curve.domain());
    let at = |s: f64| {
        if s >= length {
            last
        } else if s <= 0.0 {
            first
        } else {
            run.curve.param_at_length(s)
        }
    };
    let pairs = if run.s0.max(run.s1) > length {
        let (low, high) = (run.s0.min(run.s1), run.s0.max(run.s1));
        let (before, after) = ((at(low), last), (first, at(high - length)));
        if run.is_backward() { [(after.1, after.0), (before.1, before.0)] } else { [before, after] }
    } else {
        [(at(run.s0), at(run.s1)), (0.0, 0.0)]
    };
    pairs.into_iter().filter(|(a, b)| a != b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::geometry::construct::build;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-9
    }

    #[test]
    fn a_line_and_its_halves() {
        let line = |a: DVec3, b: DVec3| Moments::of_curve(&build::line(a, b, Origin::NONE).expect("a line"));
        let (a, b, c) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(5.0, 2.0, 6.0), DVec3::new(3.0, 2.0, 4.5));
        let (whole, halves) = (line(a, b), line(a, c).plus(&line(c, b)));
        assert!(near(whole.mass, 5.0) && whole.centroid().is_some_and(|p| p.distance(c) < 1e-9));
        // Along the line the mean square is l²/12.
        let expected = [16.0 / 12.0, 0.0, 9.0 / 12.0, 0.0, 0.0, 12.0 / 12.0];
        for m in [whole, halves] {
            assert!(m.spread().iter().zip(expected).all(|(a, b)| near(*a, b)), "{:?}", m.spread());
            assert!(m.skew().length() < 1e-9 && near(m.mass, 5.0));
        }
    }

    #[test]
    fn points_and_what_they_are_about() {
        let points = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0), DVec3::new(5.0, 1.0, -3.0)];
        let all = Moments::of_points(points.iter().copied());
        let far = all.about(DVec3::new(9.0, -7.0, 4.0));
        let c = points.iter().sum::<DVec3>() / 4.0;
        let cubes = points.iter().map(|p| (*p - c) * (*p - c) * (*p - c)).sum::<DVec3>() / 4.0;
        for m in [all, far] {
            assert!(m.centroid().is_some_and(|p| p.distance(c) < 1e-12));
            assert!(m.skew().distance(cubes) < 1e-9, "{:?} {cubes:?}", m.skew());
            let xy = points.iter().map(|p| (p.x - c.x) * (p.y - c.y)).sum::<f64>() / 4.0;
            assert!(near(m.spread()[3], xy));
        }
    }
}
