//! Other exact forms of a rational B-spline: knot insertion, parts, Bézier pieces, higher degree, joining.
//!
//! All of them read poles off the blossom [Ramshaw 1989]: the pole of knots x₁…x_p is the blossom there.

use glam::DVec4;

use crate::base::tolerance::ROUNDING_SHARE;
use crate::geometry::shapes::nurbs::{MAX_DEGREE, Nurbs};

/// One polynomial or rational piece of degree `poles.len() - 1` over `t0…t1`, homogeneous Bézier points.
#[derive(Clone, Debug, PartialEq)]
pub struct Bezier {
    /// First parameter.
    pub t0: f64,
    /// Last parameter.
    pub t1: f64,
    /// Bézier points (wx, wy, wz, w).
    pub poles: Vec<DVec4>,
}

impl Bezier {
    /// Both halves, by de Casteljau's algorithm.
    pub fn halves(&self) -> (Self, Self) {
        let middle = 0.5 * (self.t0 + self.t1);
        let mut right = self.poles.clone();
        let n = right.len();
        let mut left = Vec::with_capacity(n);
        for r in 0..n {
            left.push(right[0]);
            for i in 0..n - 1 - r {
                right[i] = (right[i] + right[i + 1]) * 0.5;
            }
        }
        (Self { t0: self.t0, t1: middle, poles: left }, Self { t0: middle, t1: self.t1, poles: right })
    }

    /// Rows over one parameter, halved together until all weights are above 0: parts one after the other, each with all rows; `None` where a
    /// weight vanishes on the way.
    pub fn with_weights(rows: Vec<Self>) -> Option<Vec<Vec<Self>>> {
        /// Halvings at most.
        const DEPTH: usize = 24;
        let mut open = vec![(rows, 0)];
        let mut parts = Vec::new();
        while let Some((rows, depth)) = open.pop() {
            let ends = |row: &Self| row.poles[0].w > 0.0 && row.poles[row.poles.len() - 1].w > 0.0;
            if rows.iter().all(|row| row.poles.iter().all(|q| q.w > 0.0)) {
                parts.push(rows);
            } else if depth == DEPTH || !rows.iter().all(ends) {
                return None;
            } else {
                let (left, right): (Vec<Self>, Vec<Self>) = rows.iter().map(Self::halves).unzip();
                open.extend([(right, depth + 1), (left, depth + 1)]);
            }
        }
        Some(parts)
    }
}

impl Nurbs {
    /// The same curve on other knots: every knot of `knots` between its ends must be one of this curve's with at least its multiplicity.
    fn on_knots(&self, knots: Vec<f64>) -> Self {
        let p = self.degree;
        let count = knots.len() - p - 1;
        let poles = (0..count)
            .map(|i| {
                // Any non-empty new span of the pole's support will do; the middle one extrapolates least.
                let spans = (i..=i + p).filter(|&j| j >= p && j < count && knots[j] < knots[j + 1]);
                let best = spans.min_by_key(|&j| (2 * j).abs_diff(2 * i + p)).unwrap_or(i);
                let k = self.span(0.5 * (knots[best] + knots[best + 1]));
                self.blossom(k, &knots[i + 1..=i + p])
            })
            .collect();
        Self { degree: p, knots, poles, polynomial: self.polynomial }
    }

    /// The same curve with more knots (any inside the domain, each up to multiplicity `degree`).
    pub fn refined(&self, more: &[f64]) -> Self {
        let mut knots = [self.knots.as_slice(), more].concat();
        knots.sort_by(f64::total_cmp);
        self.on_knots(knots)
    }

    /// The exact piece over `t0…t1` with full end knots. A knot that lies beside an end by rounding is that end: a span so short is noise.
    pub fn part(&self, t0: f64, t1: f64) -> Self {
        let ends = self.degree + 1;
        let beside = ROUNDING_SHARE * (self.knots[self.knots.len() - 1] - self.knots[0]);
        let inner = self.knots.iter().copied().filter(|x| t0 + beside < *x && *x < t1 - beside);
        let knots: Vec<f64> = std::iter::repeat_n(t0, ends).chain(inner).chain(std::iter::repeat_n(t1, ends)).collect();
        self.on_knots(knots)
    }

    /// The Bézier pieces between distinct knots, in order.
    pub fn beziers(&self) -> Vec<Bezier> {
        self.beziers_from((f64::NEG_INFINITY, f64::INFINITY))
    }

    /// Those that begin at or after one parameter and before another.
    pub fn beziers_from(&self, (from, to): (f64, f64)) -> Vec<Bezier> {
        let p = self.degree;
        let mut pieces = Vec::new();
        let first = self.knots.partition_point(|t| *t < from).max(p);
        for k in first..self.poles.len() {
            let (t0, t1) = (self.knots[k], self.knots[k + 1]);
            if t0 >= to {
                break;
            }
            if t0 < t1 {
                let mut arguments = [t0; MAX_DEGREE];
                let mut poles = Vec::with_capacity(p + 1);
                for j in 0..=p {
                    if j > 0 {
                        arguments[p - j] = t1;
                    }
                    poles.push(self.blossom(k, &arguments[..p]));
                }
                pieces.push(Bezier { t0, t1, poles });
            }
        }
        pieces
    }

    /// The Bézier points of the last polynomial piece where it goes on for `more` of the parameter; their weights may be of any sign.
    pub fn onward(&self, more: f64) -> Bezier {
        let (p, t0) = (self.degree, self.domain().1);
        let (k, t1) = (self.span(t0), t0 + more);
        let pole = |j: usize| {
            let mut arguments = [t0; MAX_DEGREE];
            arguments[p - j..p].fill(t1);
            self.blossom(k, &arguments[..p])
        };
        Bezier { t0, t1, poles: (0..=p).map(pole).collect() }
    }

    /// The same curve with its degree raised by `by`, to at most 25.
    pub fn elevated(&self, by: usize) -> Self {
        let mut curve = self.clone();
        for _ in 0..by {
            if curve.degree == MAX_DEGREE {
                break;
            }
            curve = curve.elevated_once();
        }
        curve
    }

    fn elevated_once(&self) -> Self {
        let clamped = self.part(self.domain().0, self.domain().1);
        let q = self.degree + 1;
        let knots: Vec<f64> = clamped.breaks().into_iter().flat_map(|(x, times)| std::iter::repeat_n(x, times + 1)).collect();
        let count = knots.len() - q - 1;
        let poles = (0..count)
            .map(|i| {
                let best = (i..=i + q)
                    .filter(|&j| j >= q && j < count && knots[j] < knots[j + 1])
                    .min_by_key(|&j| (2 * j).abs_diff(2 * i + q))
                    .unwrap_or(i);
                let k = clamped.span(0.5 * (knots[best] + knots[best + 1]));
                let arguments = &knots[i + 1..=i + q];
                // The blossom of higher degree is the mean of those that leave one argument out.
                let mut sum = DVec4::ZERO;
                let mut rest = [0.0; MAX_DEGREE];
                for out in 0..q {
                    for (to, from) in (0..q).filter(|j| *j != out).enumerate() {
                        rest[to] = arguments[from];
                    }
                    sum += clamped.blossom(k, &rest[..q - 1]);
                }
                sum / q as f64
            })
            .collect();
        Self { degree: q, knots, poles, polynomial: self.polynomial }
    }

    /// The same shape over another domain.
    pub fn over(&self, t0: f64, t1: f64) -> Self {
        let (a, b) = self.domain();
        let to = |x: f64| {
            if x == a {
                t0
            } else if x == b {
                t1
            } else {
                t0 + (x - a) / (b - a) * (t1 - t0)
            }
        };
        Self {
            degree: self.degree,
            knots: self.knots.iter().map(|x| to(*x)).collect(),
            poles: self.poles.clone(),
            polynomial: self.polynomial,
        }
    }

    /// Curves in a row as one of their highest degree, joined with full knots; domains follow each other.
    ///
    /// Weights of a piece are scaled so that they agree at the joint; the point there is that of the piece before.
    pub fn joined(pieces: &[Self]) -> Self {
        let degree = pieces.iter().map(|c| c.degree).max().unwrap_or(1);
        let (mut knots, mut poles): (Vec<f64>, Vec<DVec4>) = (Vec::new(), Vec::new());
        for piece in pieces {
            let (a, b) = piece.domain();
            let piece = piece.part(a, b).elevated(degree - piece.degree);
            match poles.last().copied() {
                None => {
                    knots = piece.knots;
                    poles = piece.poles;
                }
                Some(last) => {
                    let start = knots[knots.len() - 1];
                    let piece = piece.over(start, start + (b - a));
                    knots.pop();
                    knots.extend(&piece.knots[degree + 1..]);
                    let scale = last.w / piece.poles[0].w;
                    poles.extend(piece.poles[1..].iter().map(|q| *q * scale));
                }
            }
        }
        Self::new(degree, knots, poles)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn sample() -> Nurbs {
        let poles = [
            (0.0, 0.0, 0.0, 1.0),
            (1.0, 2.0, 0.5, 0.7),
            (3.0, 2.0, 1.0, 1.4),
            (4.0, 0.0, 2.0, 1.0),
            (5.0, 1.0, 0.0, 0.9),
            (7.0, 0.0, 1.0, 1.0),
        ];
        Nurbs::new(
            3,
            vec![0.0, 0.0, 0.0, 0.0, 0.3, 0.7, 1.0, 1.0, 1.0, 1.0],
            poles.map(|(x, y, z, w)| crate::geometry::shapes::nurbs::weighted(DVec3::new(x, y, z), w)).to_vec(),
        )
    }

    fn same(a: &Nurbs, b: &Nurbs, map: impl Fn(f64) -> f64) {
        let (t0, t1) = b.domain();
        for i in 0..=40 {
            let t = t0 + (t1 - t0) * f64::from(i) / 40.0;
            assert!(a.jet(map(t)).p.distance(b.jet(t).p) < 1e-13, "{t}");
        }
    }

    #[test]
    fn a_knot_beside_an_end_by_rounding_is_that_end() {
        let curve = sample();
        for (t0, t1) in [(0.0, 0.7 + 1e-16), (0.0, 0.7 + 2e-13), (0.3 - 1e-16, 1.0), (0.3 - 2e-13, 0.7 + 2e-13)] {
            let piece = curve.part(t0, t1);
            let spans: Vec<f64> = piece.knots.windows(2).map(|w| w[1] - w[0]).filter(|w| *w > 0.0).collect();
            assert!(spans.iter().all(|w| *w > 0.1), "{spans:?}");
            same(&curve, &piece, |t| t);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_lower_order() {
        let c = sample();
        for degree in 1..=5 {
            let c = if degree < 3 { Nurbs::bezier(0.0, 1.0, c.poles[..=degree].to_vec()) } else { c.elevated(degree - 3) };
            for t in [0.05, 0.31, 0.5, 0.8, 0.95] {
                let h = 1e-5;
                let (before, after, here) = (c.jet(t - h), c.jet(t + h), c.jet(t));
                assert!(((after.p - before.p) / (2.0 * h) - here.d1).length() < 1e-7);
                assert!(((after.d1 - before.d1) / (2.0 * h) - here.d2).length() < 1e-5);
                assert!(((after.d2 - before.d2) / (2.0 * h) - c.third(t)).length() < 1e-3, "{degree} {t}");
            }
        }
    }

    #[test]
    fn other_forms_keep_the_curve() {
        let c = sample();
        same(&c, &c.refined(&[0.1, 0.3, 0.5, 0.5, 0.9]), |t| t);
        same(&c, &c.elevated(1), |t| t);
        same(&c, &c.elevated(4), |t| t);
        same(&c, &c.part(0.2, 0.75), |t| t);
        same(&c, &c.reversed(), |t| 1.0 - t);
        same(&c, &c.over(2.0, 5.0), |t| (t - 2.0) / 3.0);
        same(&c, &Nurbs::joined(&[c.part(0.0, 0.4), c.part(0.4, 1.0)]), |t| t);
        for piece in c.beziers() {
            let (left, right) = piece.halves();
            for b in [&piece, &left, &right] {
                same(&c, &Nurbs::bezier(b.t0, b.t1, b.poles.clone()), |t| t);
            }
        }
    }
}
