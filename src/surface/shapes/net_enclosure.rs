//! Bounds of nets: the Bézier points of the piece over a rectangle and of its derivatives (convex hull property), a
//! rational piece by the quotient rule about its first point.

use glam::{DVec3, DVec4};

use crate::base::range::{Interval, Interval3};
use crate::base::tolerance::{EPSILON, SAME_SLOPE};
use crate::geometry::shapes::nurbs::{COMMON_DEGREE, MAX_DEGREE, projected};
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::nurbs::NurbsSurface;

/// The Bézier points over an interval inside one span, as sums of the active poles.
#[derive(Clone, Debug)]
pub struct NetStrip {
    first: usize,
    width: f64,
    /// Row k: shares of the active poles in Bézier point k.
    shares: Vec<[f64; MAX_DEGREE + 1]>,
}

impl NetStrip {
    /// Its width in the parameter.
    pub(crate) fn width(&self) -> f64 {
        self.width
    }
}

/// Blossom values of the basis functions of one span: how much each active pole adds [Ramshaw 1989].
fn shares(knots: &[f64], p: usize, span: usize, arguments: &[f64]) -> [f64; MAX_DEGREE + 1] {
    let mut out = [0.0; MAX_DEGREE + 1];
    for own in 0..=p {
        let mut d = [0.0; MAX_DEGREE + 1];
        d[own] = 1.0;
        for r in 1..=p {
            for j in (r..=p).rev() {
                let (low, high) = (knots[span - p + j], knots[span + 1 + j - r]);
                let share = (arguments[r - 1] - low) / (high - low);
                d[j] = d[j - 1] * (1.0 - share) + d[j] * share;
            }
        }
        out[own] = d[p];
    }
    out
}

/// The same in a number of steps that grows with the square of the degree: level by level, all active poles at once.
fn shares_by_levels(knots: &[f64], p: usize, span: usize, arguments: &[f64]) -> [f64; MAX_DEGREE + 1] {
    let mut out = [0.0; MAX_DEGREE + 1];
    out[0] = 1.0;
    for (r, t) in (1..=p).zip(arguments) {
        let mut next = [0.0; MAX_DEGREE + 1];
        for (j, value) in out.iter().enumerate().take(r) {
            let i = span + 1 + j - r;
            let share = value / (knots[i + r] - knots[i]);
            next[j] += (knots[i + r] - t) * share;
            next[j + 1] += (t - knots[i]) * share;
        }
        out = next;
    }
    out
}

type PoleRows = Vec<Vec<DVec4>>;

/// Differences along u (within rows) times `f`.
fn along_u(net: &PoleRows, f: f64) -> PoleRows {
    net.iter().map(|row| row.windows(2).map(|w| (w[1] - w[0]) * f).collect()).collect()
}

fn along_v(net: &PoleRows, f: f64) -> PoleRows {
    net.windows(2).map(|w| w[0].iter().zip(&w[1]).map(|(a, b)| (*b - *a) * f).collect()).collect()
}

fn hull(net: &PoleRows) -> (Interval3, Interval) {
    let mut all = net.iter().flatten();
    let Some(first) = all.next() else { return (Interval3::default(), Interval::default()) };
    let (low, high) = all.fold((*first, *first), |(low, high), q| (low.min(*q), high.max(*q)));
    (Interval3 { low: low.truncate(), high: high.truncate() }, Interval { low: low.w, high: high.w })
}

impl NurbsSurface {
    /// Inner knots, and whether first derivatives jump at one of them between two values.
    pub fn knot_lines(&self, in_u: bool, (x0, x1): (f64, f64)) -> (Vec<f64>, bool) {
        let (us, vs) = self.breaks();
        let lines = if in_u { us } else { vs };
        let corner = lines.iter().any(|x| *x > x0 + EPSILON && *x < x1 - EPSILON && self.has_corner(in_u, *x));
        (lines, corner)
    }

    /// Whether the first derivative across an inner knot jumps there, by more than rounding. It may at knots as often as the
    /// degree, and does not where the jump of the homogeneous derivative is one multiple of the points all along the knot, as
    /// between arcs of a circle.
    pub fn has_corner(&self, in_u: bool, x: f64) -> bool {
        let (knots, degree) = if in_u { (&self.knots.0, self.degree.0) } else { (&self.knots.1, self.degree.1) };
        let before = knots.partition_point(|k| *k < x - EPSILON);
        let after = knots.len() - knots.partition_point(|k| *k <= x + EPSILON);
        let often = knots.len() - before - after;
        if often < degree || before == 0 || after == 0 || often > degree {
            return often >= degree;
        }
        // The column of poles on the knot, with those to either side.
        let column = before - 1;
        let (from, to) = (degree as f64 / (x - knots[before - 1]), degree as f64 / (knots[before + often] - x));
        let (nu, nv) = self.counts;
        let origin = projected(self.pole_of(in_u, column, 0));
        let local = |q: DVec4| (q.truncate() - origin * q.w).extend(q.w);
        let n = if in_u { nv } else { nu };
        let rows = (0..n).map(|j| [column - 1, column, column + 1].map(|i| local(self.pole_of(in_u, i, j))));
        let slopes = |[a, b, c]: [DVec4; 3]| (b, (b - a) * from, (c - b) * to);
        let (b, left, right) = slopes([column - 1, column, column + 1].map(|i| local(self.pole_of(in_u, i, 0))));
        let share = (right.w - left.w) / b.w;
        let (most, scale) = rows.map(slopes).fold((0.0_f64, 0.0_f64), |(most, scale), (b, left, right)| {
            // Weights count by the reach of the points.
            let size = |q: DVec4| q.truncate().length() + q.w.abs() * b.truncate().length();
            (most.max(size(right - left - b * share)), scale.max(size(left)).max(size(right)))
        });
        most > SAME_SLOPE * scale
    }

    /// The homogeneous pole in a column across a direction and a row along it.
    pub(crate) fn pole_of(&self, in_u: bool, i: usize, j: usize) -> DVec4 {
        let (i, j) = if in_u { (i, j) } else { (j, i) };
        self.poles[j * self.counts.0 + i]
    }

    /// The Bézier points of one direction between two values inside one span.
    pub fn strip(&self, in_u: bool, (x0, x1): (f64, f64)) -> NetStrip {
        let p = if in_u { self.degree.0 } else { self.degree.1 };
        let point = |k: usize| {
            let mut arguments = [x0; MAX_DEGREE];
            arguments[..k].fill(x1);
            self.blossom(in_u, (x0, x1), &arguments[..p])
        };
        let points: Vec<_> = (0..=p).map(point).collect();
        NetStrip { first: points[0].0, width: x1 - x0, shares: points.into_iter().map(|point| point.1).collect() }
    }

    /// The blossom of one direction at as many arguments as its degree, in the span that holds two values: the first active pole, and the
    /// shares of these.
    pub(crate) fn blossom(&self, in_u: bool, (x0, x1): (f64, f64), arguments: &[f64]) -> (usize, [f64; MAX_DEGREE + 1]) {
        let (knots, p) = if in_u { (&self.knots.0, self.degree.0) } else { (&self.knots.1, self.degree.1) };
        let middle = 0.5 * (x0 + x1);
        let span = (knots.partition_point(|k| *k <= middle)).clamp(p + 1, knots.len() - p - 1) - 1;
        let shares = if p <= COMMON_DEGREE { shares(knots, p, span, arguments) } else { shares_by_levels(knots, p, span, arguments) };
        (span - p, shares)
    }

    /// Bounds over the rectangle of two strips.
    pub fn enclosure(&self, u: &NetStrip, v: &NetStrip, (x, y): (f64, f64), half: (f64, f64)) -> Enclosure {
        let net = self.piece(u, v);
        let (p, q) = (self.degree.0 as f64, self.degree.1 as f64);
        let nets = |net: &PoleRows| {
            let (nu, nv) = (along_u(net, p / u.width), along_v(net, q / v.width));
            let (uu, vv) = (along_u(&nu, (p - 1.0) / u.width), along_v(&nv, (q - 1.0) / v.width));
            [hull(net), hull(&nu), hull(&nv), hull(&uu), hull(&along_v(&nu, q / v.width)), hull(&vv)]
        };
        let mid = self.jet(x, y, (OneSided::After, OneSided::After));
        let same_weights = net.iter().flatten().all(|q| q.w == net[0][0].w);
        if same_weights {
            let hulls = nets(&net).map(|h| h.0 * (1.0 / net[0][0].w));
            let mut enclosure = Enclosure::new(mid, half, [hulls[3], hulls[4], hulls[5]], Some([hulls[1], hulls[2]]));
            enclosure.p = enclosure.p.intersection(hulls[0]);
            return enclosure;
        }
        // Relative to the first point little cancels.
        let origin = projected(net[0][0]);
        let local: PoleRows = net.iter().map(|row| row.iter().map(|q| (q.truncate() - origin * q.w).extend(q.w)).collect()).collect();
        let [value, u1, v1, uu, uv, vv] = nets(&local);
        let over = value.1.inverse();
        let points: Vec<DVec3> = local.iter().flatten().map(|q| projected(*q)).collect();
        let place = Interval3::of(points);
        let du = (u1.0 - place * u1.1) * over;
        let dv = (v1.0 - place * v1.1) * over;
        let second = [
            (uu.0 - du * (u1.1 * 2.0) - place * uu.1) * over,
            (uv.0 - du * v1.1 - dv * u1.1 - place * uv.1) * over,
            (vv.0 - dv * (v1.1 * 2.0) - place * vv.1) * over,
        ];
        let mut enclosure = Enclosure::new(mid, half, second, Some([du, dv]));
        enclosure.p = enclosure.p.intersection(place + origin);
        enclosure
    }

    /// Bézier points over a rectangle, rows along u.
    pub(crate) fn piece(&self, u: &NetStrip, v: &NetStrip) -> PoleRows {
        let (p, q) = self.degree;
        let mut all = vec![DVec4::ZERO; (p + 1) * (q + 1)];
        self.piece_into(u, v, &mut all);
        all.chunks_exact(p + 1).map(<[DVec4]>::to_vec).collect()
    }

    /// The same into one list, row after row.
    pub(crate) fn piece_into(&self, u: &NetStrip, v: &NetStrip, into: &mut [DVec4]) {
        let (p, q) = self.degree;
        let n = p + 1;
        let (mut few, mut many) = ([DVec4::ZERO; POINTS], Vec::new());
        let rows: &mut [DVec4] = if n * (q + 1) <= POINTS {
            &mut few
        } else {
            many.resize(n * (q + 1), DVec4::ZERO);
            &mut many
        };
        for j in 0..=q {
            let row = &self.poles[(v.first + j) * self.counts.0 + u.first..][..n];
            for (k, share) in u.shares.iter().enumerate() {
                rows[j * n + k] = row.iter().zip(share).fold(DVec4::ZERO, |sum, (pole, s)| sum + *pole * *s);
            }
        }
        for (k, share) in v.shares.iter().enumerate() {
            for i in 0..n {
                into[k * n + i] = (0..=q).fold(DVec4::ZERO, |sum, j| sum + rows[j * n + i] * share[j]);
            }
        }
    }
}

/// Most points of a piece of a net of the degrees that most surfaces keep to.
const POINTS: usize = (COMMON_DEGREE + 1) * (COMMON_DEGREE + 1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_the_same_by_levels() {
        for p in 1..=9 {
            let knots: Vec<f64> = (0..3 * p + 4).map(|k| (k * k + 9 * k) as f64 / 50.0).collect();
            let span = p + 2;
            let arguments: Vec<f64> = (0..p).map(|k| knots[span] + (knots[span + 1] - knots[span]) * k as f64 / p as f64).collect();
            let (a, b) = (shares(&knots, p, span, &arguments), shares_by_levels(&knots, p, span, &arguments));
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12), "{p}: {a:?} {b:?}");
        }
    }
}
