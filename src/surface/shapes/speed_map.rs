//! Maps of the parameters of a net that make its speed even.

use glam::DVec4;

use crate::geometry::shapes::bounds::binomial;
use crate::geometry::shapes::nurbs::{MAX_DEGREE, projected};
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Largest speed over the mean one from which on a direction is evened out.
pub(crate) const STEEP: f64 = 32.0;
/// Largest ratio of the speeds at two neighbouring stops; speeds below this share of the mean one are not looked at.
const RATIO: f64 = 2.0;
const SLOW: f64 = 0.5;
/// Most halvings of a span, and most stops.
pub(crate) const HALVINGS: u32 = 16;
const STOPS: usize = 128;
/// Places across at which speeds are taken.
const ACROSS: usize = 5;

/// A monotone map of a parameter, both from 0 to 1: quadratic between stops.
#[derive(Clone, Debug)]
pub(crate) struct SpeedMap {
    /// The parameter of the net at the stops.
    old: Vec<f64>,
    /// The new one.
    new: Vec<f64>,
    /// From each stop to the next one, the slope at the first over the sum of both.
    share: Vec<f64>,
}

impl SpeedMap {
    /// By the speed at each value, from some stops on, which are halved where it differs much; `mean` is the speed all in all.
    fn new(mut old: Vec<f64>, mean: f64, speed: &dyn Fn(f64) -> f64) -> Self {
        let held = |x: f64| speed(x).max(SLOW * mean);
        let mut speeds: Vec<f64> = old.iter().map(|x| held(*x)).collect();
        let mut left = vec![HALVINGS; old.len()];
        let mut k = 0;
        while k + 1 < old.len() {
            let middle = 0.5 * (old[k] + old[k + 1]);
            let there = held(middle);
            let all = [speeds[k], there, speeds[k + 1]];
            let (least, most) = (all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(0.0, f64::max));
            if most <= RATIO * least || left[k] == 0 || old.len() >= STOPS {
                k += 1;
                continue;
            }
            left[k] -= 1;
            old.insert(k + 1, middle);
            speeds.insert(k + 1, there);
            left.insert(k + 1, left[k]);
        }
        let slope: Vec<f64> = speeds.iter().map(|speed| 1.0 / speed).collect();
        let mut new = vec![0.0];
        for k in 0..old.len() - 1 {
            new.push(new[k] + 2.0 * (old[k + 1] - old[k]) / (slope[k] + slope[k + 1]));
        }
        let whole = new[new.len() - 1];
        new.iter_mut().for_each(|x| *x /= whole);
        let share = slope.windows(2).map(|w| w[0] / (w[0] + w[1])).collect();
        Self { old, new, share }
    }

    /// The new parameter of an old one.
    pub(crate) fn place(&self, x: f64) -> f64 {
        let k = self.old.partition_point(|stop| *stop <= x).clamp(1, self.share.len()) - 1;
        let y = ((x - self.old[k]) / (self.old[k + 1] - self.old[k])).clamp(0.0, 1.0);
        let r = self.share[k];
        // y = 2 r s (1 − s) + s², from its smaller root.
        let s = if y == 0.0 { 0.0 } else { y / (r + (r * r + (1.0 - 2.0 * r) * y).max(0.0).sqrt()) };
        self.new[k] + (self.new[k + 1] - self.new[k]) * s
    }
}

impl NurbsSurface {
    /// The map that makes the speed along a direction nearly even; `None` where it nearly is, or twice the degree would be too high.
    pub(crate) fn speed_map(&self, in_u: bool) -> Option<SpeedMap> {
        let (knots, degree) = if in_u { (&self.knots.0, self.degree.0) } else { (&self.knots.1, self.degree.1) };
        let (along, across) = if in_u { self.counts } else { (self.counts.1, self.counts.0) };
        if 2 * degree > MAX_DEGREE {
            return None;
        }
        // The points of the first derivative bound the speed, and are it at the ends.
        let steps: Vec<f64> = (0..along - 1)
            .map(|i| {
                (0..across).map(|j| projected(self.pole_of(in_u, i + 1, j)).distance(projected(self.pole_of(in_u, i, j)))).sum::<f64>()
            })
            .map(|sum| sum / across as f64)
            .collect();
        let mean: f64 = steps.iter().sum();
        let speeds = steps.iter().enumerate().map(|(i, step)| degree as f64 * step / (knots[i + degree + 1] - knots[i + 1]));
        let most = speeds.filter(|speed| speed.is_finite()).fold(0.0, f64::max);
        if most <= STEEP * mean {
            return None;
        }
        let speed = |x: f64| {
            let one = |j: usize| {
                let y = (j as f64 + 0.5) / ACROSS as f64;
                let side = (OneSided::After, OneSided::After);
                if in_u { self.jet(x, y, side).du.length() } else { self.jet(y, x, side).dv.length() }
            };
            (0..ACROSS).map(one).sum::<f64>() / ACROSS as f64
        };
        let inner = if in_u { self.breaks().0 } else { self.breaks().1 };
        let stops = [vec![0.0], inner, vec![1.0]].concat();
        (stops.len() < STOPS).then(|| SpeedMap::new(stops, mean, &speed))
    }

    /// The same surface by a new parameter in one direction.
    pub(crate) fn composed(&self, in_u: bool, speed_map: &SpeedMap) -> Self {
        let (degree, across) = if in_u { (self.degree.0, self.counts.1) } else { (self.degree.1, self.counts.0) };
        let most = 2 * degree;
        let mut lines: Vec<Vec<DVec4>> = Vec::new();
        for (k, r) in speed_map.share.iter().enumerate() {
            let (a, b) = (speed_map.old[k], speed_map.old[k + 1]);
            let inner = a + (b - a) * r;
            let first = usize::from(k > 0);
            lines.extend((first..=most).map(|n| {
                let mut line = vec![DVec4::ZERO; across];
                // Of all ways to take so many of the three points of the quadratic.
                for ends in 0..=n / 2 {
                    let middles = n - 2 * ends;
                    if middles + ends > degree {
                        continue;
                    }
                    let starts = degree - middles - ends;
                    let ways = binomial(degree, starts) * binomial(degree - starts, middles) * f64::from(1u32 << middles);
                    let weight = ways / binomial(most, n);
                    let arguments = [vec![a; starts], vec![inner; middles], vec![b; ends]].concat();
                    let (from, shares) = self.blossom(in_u, (a, b), &arguments);
                    for (own, share) in shares.iter().take(degree + 1).enumerate() {
                        line.iter_mut().enumerate().for_each(|(j, q)| *q += self.pole_of(in_u, from + own, j) * (weight * share));
                    }
                }
                line
            }));
        }
        let last = speed_map.new.len() - 1;
        let inner = speed_map.new[1..last].iter().flat_map(|x| vec![*x; most]);
        let knots: Vec<f64> = vec![0.0; most + 1].into_iter().chain(inner).chain(vec![1.0; most + 1]).collect();
        let n = lines.len();
        if in_u {
            let poles = (0..across).flat_map(|j| lines.iter().map(move |line| line[j])).collect();
            Self { degree: (most, self.degree.1), knots: (knots, self.knots.1.clone()), poles, counts: (n, across) }
        } else {
            Self { degree: (self.degree.0, most), knots: (self.knots.0.clone(), knots), poles: lines.concat(), counts: (across, n) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::sin_cos;

    #[test]
    fn an_evened_net_is_the_same_surface_at_even_speed() {
        let (knots_u, knots_v) = (vec![0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0], [vec![0.0; 4], vec![0.002, 0.6], vec![1.0; 4]].concat());
        let pole = |k: usize| {
            let (x, y) = ((k % 4) as f64, (k / 4) as f64);
            let w = 1.0 + 0.1 * x;
            DVec4::new(x * w, y * w, sin_cos(x + 0.7 * y).0 * w, w)
        };
        let net = NurbsSurface { degree: (2, 3), knots: (knots_u, knots_v), poles: (0..24).map(pole).collect(), counts: (4, 6) };
        assert!(net.speed_map(true).is_none());
        let speed_map = net.speed_map(false).expect("runs unevenly");
        let evened = net.composed(false, &speed_map);
        let side = (OneSided::After, OneSided::After);
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for k in 0..=1000 {
            let (u, v) = (0.37, f64::from(k) / 1000.0 * if k % 2 == 0 { 1.0 } else { 0.01 });
            let jet = evened.jet(u, speed_map.place(v), side);
            assert!(jet.p.distance(net.jet(u, v, side).p) < 1e-12, "{v}");
            (least, most) = (least.min(jet.dv.length()), most.max(jet.dv.length()));
        }
        assert!(most < 4.0 * least, "{least} {most}");
        assert!((1..speed_map.new.len() - 1).all(|k| !evened.has_corner(false, speed_map.new[k])));
    }
}
