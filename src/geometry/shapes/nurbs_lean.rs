//! The same rational B-spline on as few knots as its smoothness needs.

use glam::DVec4;

use crate::geometry::shapes::nurbs::Nurbs;

/// Poles up to which knots are taken away that stand less often than the degree: each of them costs as much as there are poles.
const FEW: usize = 4096;

impl Nurbs {
    /// The same curve without inner knots at which it is smoother than they allow. No pole of a smaller set moves the curve by more than
    /// `within`, model units: with what rounding does to coordinates the curve is the same. All weights are above 0.
    ///
    /// Knots that stand as often as the degree go first, all at once: other programs take these for corners.
    pub fn lean(&self, within: f64) -> Self {
        let (a, b) = self.domain();
        let is_full = self.knots[0] == a && self.knots[self.knots.len() - 1] == b;
        if self.degree < 2 || !is_full || self.poles.iter().any(|q| q.w <= 0.0) {
            return self.clone();
        }
        let mut curve = self.without_corners(within);
        let mut k = curve.degree + 1;
        while curve.poles.len() <= FEW && k + curve.degree + 1 < curve.knots.len() {
            // The last of equal knots; where one goes, the one before it is looked at next.
            if curve.knots[k] == curve.knots[k + 1] || !curve.remove(k, within) {
                k += 1;
            } else if k > curve.degree + 1 {
                k -= 1;
            }
        }
        Self::new(curve.degree, curve.knots, curve.poles)
    }

    /// Distance of two homogeneous poles that is as far as `within` for the curve.
    fn room(&self, within: f64) -> f64 {
        let least = self.poles.iter().map(|q| q.w).fold(f64::INFINITY, f64::min);
        let farthest = self.poles.iter().map(|q| q.truncate().length() / q.w).fold(0.0, f64::max);
        if self.polynomial { within * least } else { within * least / (1.0 + farthest) }
    }

    /// Without one of each inner knots that stand as often as the degree, where the curve has no corner.
    fn without_corners(&self, within: f64) -> Self {
        let (p, room) = (self.degree, self.room(within));
        let (mut knots, mut poles) = (self.knots.clone(), self.poles.clone());
        let (mut gone, mut k) = (vec![false; knots.len()], p + 1);
        let mut gone_poles = vec![false; poles.len()];
        while k + p + 1 < knots.len() {
            let times = knots[k..].iter().take_while(|x| **x == knots[k]).count();
            if times == p && k + p < knots.len() {
                // The pole at the knot lies between its neighbours.
                let (before, at, after) = (knots[k - 1], knots[k], knots[k + p]);
                let share = (at - before) / (after - before);
                let between = poles[k - 2] * (1.0 - share) + poles[k] * share;
                if (between - poles[k - 1]).length() <= room {
                    (gone[k], gone_poles[k - 1]) = (true, true);
                }
            }
            k += times;
        }
        let mut flags = gone.into_iter();
        knots.retain(|_| flags.next() != Some(true));
        let mut flags = gone_poles.into_iter();
        poles.retain(|_| flags.next() != Some(true));
        Self { degree: p, knots, poles, polynomial: self.polynomial }
    }

    /// Takes knot `r`, the last of equal ones, away once [Piegl & Tiller 1997, A5.8]; whether it could.
    fn remove(&mut self, r: usize, within: f64) -> bool {
        let (p, u) = (self.degree, self.knots[r]);
        let s = self.knots[..=r].iter().rev().take_while(|x| **x == u).count();
        if s > p || r < p + 1 {
            return false;
        }
        let (first, last) = (r - p, r - s);
        let off = first - 1;
        let mut made = vec![DVec4::ZERO; last + 2 - off];
        made[0] = self.poles[off];
        made[last + 1 - off] = self.poles[last + 1];
        let share = |i: usize| (u - self.knots[i]) / (self.knots[i + p + 1] - self.knots[i]);
        let (mut i, mut j) = (first, last);
        while j > i {
            let (low, high) = (share(i), share(j));
            made[i - off] = (self.poles[i] - made[i - off - 1] * (1.0 - low)) / low;
            made[j - off] = (self.poles[j] - made[j + 1 - off] * high) / (1.0 - high);
            (i, j) = (i + 1, j - 1);
        }
        let miss = if j < i {
            made[i - 1 - off] - made[j + 1 - off]
        } else {
            self.poles[i] - made[i + 1 - off] * share(i) - made[i - 1 - off] * (1.0 - share(i))
        };
        if miss.length().is_nan() || miss.length() > self.room(within) {
            return false;
        }
        let (mut i, mut j) = (first, last);
        while j > i {
            self.poles[i] = made[i - off];
            self.poles[j] = made[j - off];
            (i, j) = (i + 1, j - 1);
        }
        self.poles.remove((2 * r - s - p) / 2);
        self.knots.remove(r);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline(degree: usize, weights: bool) -> Nurbs {
        let count = 12;
        let inner = (1..count - degree).map(|k| k as f64 + 0.2 * ((k * k) % 3) as f64);
        let end = (count - degree) as f64;
        let knots = std::iter::repeat_n(0.0, degree + 1).chain(inner).chain(std::iter::repeat_n(end, degree + 1)).collect();
        let pole = |k: usize| {
            let x = k as f64;
            let w = if weights { 1.0 + 0.3 * ((k * 7) % 4) as f64 } else { 1.0 };
            DVec4::new(x * w, ((k * k) % 5) as f64 * w, ((k * 3) % 7) as f64 * w, w)
        };
        Nurbs::new(degree, knots, (0..count).map(pole).collect())
    }

    #[test]
    fn knots_that_were_put_in_go_again() {
        for (degree, weights) in [(2, false), (3, false), (3, true), (4, true), (5, false)] {
            let known = spline(degree, weights);
            let pieces: Vec<Nurbs> = known.breaks().windows(2).map(|w| known.part(w[0].0, w[1].0)).collect();
            let joined = Nurbs::joined(&pieces);
            let found = joined.lean(1e-10);
            assert_eq!(found.knots, known.knots, "degree {degree}");
            for (a, b) in found.poles.iter().zip(&known.poles) {
                assert!((*a - *b).length() < 1e-9, "degree {degree}: {a} {b}");
            }
        }
    }

    #[test]
    fn corners_stay() {
        let a = Nurbs::bezier(0.0, 1.0, [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]].map(|[x, y]| DVec4::new(x, y, 0.0, 1.0)).to_vec());
        let b = Nurbs::bezier(1.0, 2.0, [[3.0, 0.0], [3.0, 1.0], [3.0, 2.0], [3.0, 3.0]].map(|[x, y]| DVec4::new(x, y, 0.0, 1.0)).to_vec());
        let row = Nurbs::joined(&[a, b]);
        assert_eq!(row.lean(1e-9), row);
    }
}
