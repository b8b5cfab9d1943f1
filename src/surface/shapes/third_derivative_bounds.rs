//! Bounds of the third derivatives of a net over boxes that get smaller where that makes the bounds much better.
//!
//! Hulls of differences, and the quotient rule where weights differ, overestimate many times over a span in which a net runs at
//! uneven speed or turns through a good part of a circle. Halves of a box decide: where they are hardly better, the box is small enough.

use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;

use glam::{DVec2, DVec3, DVec4};

use crate::geometry::shapes::bounds::binomial;
use crate::geometry::shapes::nurbs::projected;
use crate::surface::shapes::net_enclosure::NetStrip;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Boxes along each side of a span at the least.
const BOXES: usize = 3;
/// Nets of one weight up to this degree need no halving.
const MAX_UNHALVED_DEGREE: usize = 3;
/// Bounds over smaller boxes as a share of those over larger ones, from which on boxes are small enough.
const MAX_BOUND_RATIO: f64 = 0.75;
/// What bounds in any direction weigh beside those along the normal: triangles are hardly tilted against the surface.
const LEANING: f64 = 0.1;
/// Halvings of a box along each direction.
const MAX_DEPTH: u8 = 6;
/// Boxes of a net that are halved at most.
const MAX_HALVED: usize = 2048;

/// Bounds of |∂uuu|, |∂uuv|, |∂uvv|, |∂vvv| over a box: along a unit normal, and in any direction.
#[derive(Clone, Copy, Debug)]
struct ThirdDerivatives {
    normal: DVec3,
    along_normal: [f64; 4],
    any_direction: [f64; 4],
}

impl ThirdDerivatives {
    /// How far they let the surface be off over a box of these widths.
    fn weight(&self, wide: DVec2) -> f64 {
        let powers = [wide.x * wide.x * wide.x, wide.x * wide.x * wide.y, wide.x * wide.y * wide.y, wide.y * wide.y * wide.y];
        (0..4).map(|k| (self.along_normal[k] + LEANING * self.any_direction[k]) * powers[k]).sum()
    }
}

/// A box with its bounds; a halved one has two next to each other in the list.
#[derive(Clone, Copy, Debug)]
struct Node {
    third: ThirdDerivatives,
    /// The direction across which it is halved, and where the first half is.
    halves: Option<(usize, u32)>,
}

/// The boxes of a net.
#[derive(Debug)]
pub(crate) struct ThirdDerivativeBounds {
    /// Lines between boxes that are not halves.
    lines: (Vec<f64>, Vec<f64>),
    /// Those boxes, u fastest, and halves behind them.
    nodes: Vec<Node>,
}

/// A box of parameters.
type Area = (DVec2, DVec2);

/// The halves of a box across a direction.
fn halves((low, high): Area, axis: usize) -> [Area; 2] {
    let middle = 0.5 * (low[axis] + high[axis]);
    let (mut first, mut second) = (high, low);
    (first[axis], second[axis]) = (middle, middle);
    [(low, first), (second, high)]
}

impl ThirdDerivativeBounds {
    /// Of a net with its knots, 0 and 1 among them; `normal` gives that of a place.
    pub fn new(net: &NurbsSurface, knots: (&[f64], &[f64]), normal: &impl Fn(f64, f64) -> DVec3) -> Self {
        let lines = (divided(knots.0), divided(knots.1));
        let strips = |in_u: bool, lines: &[f64]| -> Vec<NetStrip> { lines.windows(2).map(|w| net.strip(in_u, (w[0], w[1]))).collect() };
        let (us, vs) = (strips(true, &lines.0), strips(false, &lines.1));
        let middle = |lines: &[f64], k: usize| 0.5 * (lines[k] + lines[k + 1]);
        let row = |j: usize| (0..us.len()).map(move |i| (i, j));
        let third = |(i, j): (usize, usize)| net.third(&us[i], &vs[j], normal(middle(&lines.0, i), middle(&lines.1, j)));
        let nodes = (0..vs.len()).flat_map(row).map(|at| Node { third: third(at), halves: None }).collect();
        let mut thirds = Self { lines, nodes };
        let needs_no_halving = net.degree.0.max(net.degree.1) <= MAX_UNHALVED_DEGREE && net.poles.iter().all(|q| q.w == net.poles[0].w);
        if !needs_no_halving {
            thirds.halve(net, knots, normal);
        }
        thirds
    }

    /// The box of a node that is no half.
    fn area(&self, (i, j): (usize, usize)) -> Area {
        (DVec2::new(self.lines.0[i], self.lines.1[j]), DVec2::new(self.lines.0[i + 1], self.lines.1[j + 1]))
    }

    /// Halves boxes for as long as bounds get much better.
    fn halve(&mut self, net: &NurbsSurface, knots: (&[f64], &[f64]), normal: &impl Fn(f64, f64) -> DVec3) {
        let mut strips = KnownStrips { net, known: BTreeMap::new() };
        let mut over = |(low, high): Area| {
            let middle = 0.5 * (low + high);
            let (u, v) = (strips.of(true, (low.x, high.x)), strips.of(false, (low.y, high.y)));
            net.third(&u, &v, normal(middle.x, middle.y))
        };
        let n = self.lines.0.len() - 1;
        let mut open: VecDeque<(usize, Area, [u8; 2])> = VecDeque::new();
        for j in 0..knots.1.len() - 1 {
            for i in 0..knots.0.len() - 1 {
                let (low, high) = (DVec2::new(knots.0[i], knots.1[j]), DVec2::new(knots.0[i + 1], knots.1[j + 1]));
                let inner: Vec<(usize, usize)> = (0..BOXES * BOXES).map(|k| (i * BOXES + k % BOXES, j * BOXES + k / BOXES)).collect();
                let of_parts: f64 = inner.iter().map(|(i, j)| self.nodes[j * n + i].third.weight(high - low)).sum();
                // Where boxes give the bound of the whole span, smaller ones would too.
                if of_parts < MAX_BOUND_RATIO * (BOXES * BOXES) as f64 * over((low, high)).weight(high - low) {
                    open.extend(inner.into_iter().map(|(i, j)| (j * n + i, self.area((i, j)), [0; 2])));
                }
            }
        }
        let mut halved = 0;
        while let Some((node, area, deep)) = open.pop_front().filter(|_| halved < MAX_HALVED) {
            let wide = area.1 - area.0;
            let whole = self.nodes[node].third.weight(wide);
            let tries = (0..2).filter(|axis| deep[*axis] < MAX_DEPTH).map(|axis| {
                let parts = halves(area, axis).map(|part| (part, over(part)));
                (0.5 * (parts[0].1.weight(wide) + parts[1].1.weight(wide)), axis, parts)
            });
            let Some((weight, axis, parts)) = tries.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            if weight < MAX_BOUND_RATIO * whole {
                halved += 1;
                let first = self.nodes.len();
                self.nodes[node].halves = Some((axis, first as u32));
                let mut deep = deep;
                deep[axis] += 1;
                for (k, (part, third)) in parts.into_iter().enumerate() {
                    self.nodes.push(Node { third, halves: None });
                    open.push_back((first + k, part, deep));
                }
            }
        }
    }

    /// Bounds along a unit vector over a box: ∂uuu, ∂uuv, ∂uvv, ∂vvv.
    pub fn bounds_along(&self, (low, high): Area, along: DVec3) -> [f64; 4] {
        let range = |lines: &[f64], a: f64, b: f64| {
            let at = |x: f64| lines.partition_point(|l| *l <= x).clamp(1, lines.len() - 1) - 1;
            (at(a), at(b))
        };
        let ((i0, i1), (j0, j1)) = (range(&self.lines.0, low.x, high.x), range(&self.lines.1, low.y, high.y));
        let n = self.lines.0.len() - 1;
        let mut bounds = [0.0_f64; 4];
        for j in j0..=j1 {
            for i in i0..=i1 {
                self.add(j * n + i, self.area((i, j)), (low, high), along, &mut bounds);
            }
        }
        bounds
    }

    /// Raises bounds over another box by those of a box and its halves.
    fn add(&self, node: usize, own: Area, area: Area, along: DVec3, bounds: &mut [f64; 4]) {
        let Node { third, halves: parts } = &self.nodes[node];
        let Some((axis, first)) = parts else {
            let (up, aside) = (along.dot(third.normal).abs(), along.cross(third.normal).length());
            for (k, bound) in bounds.iter_mut().enumerate() {
                *bound = bound.max((up * third.along_normal[k] + aside * third.any_direction[k]).min(third.any_direction[k]));
            }
            return;
        };
        let [before, after] = halves(own, *axis);
        let middle = before.1[*axis];
        if area.0[*axis] < middle {
            self.add(*first as usize, before, area, along, bounds);
        }
        if area.1[*axis] >= middle {
            self.add(*first as usize + 1, after, area, along, bounds);
        }
    }
}

/// Strips that were made: boxes beside each other have one in common.
struct KnownStrips<'a> {
    net: &'a NurbsSurface,
    /// By direction and the bits of both ends.
    known: BTreeMap<(bool, u64, u64), Rc<NetStrip>>,
}

impl KnownStrips<'_> {
    fn of(&mut self, in_u: bool, ends: (f64, f64)) -> Rc<NetStrip> {
        let make = || Rc::new(self.net.strip(in_u, ends));
        self.known.entry((in_u, ends.0.to_bits(), ends.1.to_bits())).or_insert_with(make).clone()
    }
}

/// Each span cut into boxes.
fn divided(knots: &[f64]) -> Vec<f64> {
    let inside = |w: &[f64]| (0..BOXES).map(|k| w[0] + (w[1] - w[0]) * k as f64 / BOXES as f64).collect::<Vec<_>>();
    knots.windows(2).flat_map(inside).chain([1.0]).collect()
}

impl NurbsSurface {
    /// Bounds of the third derivatives over a rectangle inside one span: hulls of differences, and the quotient rule
    /// about the first point; apart along the normal in the middle, where a change of parameters adds nothing. Without a normal
    /// there any direction takes its part.
    fn third(&self, u: &NetStrip, v: &NetStrip, normal: DVec3) -> ThirdDerivatives {
        let normal = if normal.is_normalized() { normal } else { DVec3::Z };
        let (n, rows) = (self.degree.0 + 1, self.degree.1 + 1);
        let mut net = vec![DVec4::ZERO; n * rows];
        self.piece_into(u, v, &mut net);
        let light = net.iter().map(|q| q.w).fold(f64::INFINITY, f64::min);
        let origin = projected(net[0]);
        let (mut points, reach) = ((0.0_f64, 0.0_f64), |q: DVec3| (q.dot(normal).abs(), q.length()));
        for q in &mut net {
            *q = (q.truncate() - origin * q.w).extend(q.w);
            let (up, whole) = reach(projected(*q));
            points = (points.0.max(up), points.1.max(whole));
        }
        // Bounds of the i-th difference along u and the j-th along v: normal and whole numerator, weight.
        let (mut a, mut b, mut w) = ([[0.0_f64; 4]; 4], [[0.0_f64; 4]; 4], [[0.0_f64; 4]; 4]);
        let mut in_v = net.clone();
        for i in 0..4_usize.min(n) {
            in_v.copy_from_slice(&net);
            for j in 0..(4 - i).min(rows) {
                for q in (0..rows - j).flat_map(|r| &in_v[r * n..r * n + n - i]) {
                    let (up, whole) = reach(q.truncate());
                    (a[i][j], b[i][j], w[i][j]) = (a[i][j].max(up), b[i][j].max(whole), w[i][j].max(q.w.abs()));
                }
                let f = (self.degree.1 as f64 - j as f64) / v.width();
                (0..(rows - j - 1) * n).for_each(|k| in_v[k] = (in_v[k + n] - in_v[k]) * f);
            }
            let f = (self.degree.0 as f64 - i as f64) / u.width();
            for r in 0..rows {
                (r * n..r * n + n - i - 1).for_each(|k| net[k] = (net[k + 1] - net[k]) * f);
            }
        }
        let along_normal = highest(&a, &w, points.0, light);
        ThirdDerivatives { normal, along_normal, any_direction: highest(&b, &w, points.1, light) }
    }
}

/// Leibniz' rule N = S w solved for the derivatives of S, by bounds of those of N and w, of S and of 1 / w.
fn highest(a: &[[f64; 4]; 4], w: &[[f64; 4]; 4], reach: f64, light: f64) -> [f64; 4] {
    let mut s = [[0.0; 4]; 4];
    s[0][0] = reach;
    for order in 1..4_usize {
        for i in 0..=order {
            let j = order - i;
            let mut sum = a[i][j];
            for (k, l) in (0..=i).flat_map(|k| (0..=j).map(move |l| (k, l))).filter(|kl| *kl != (i, j)) {
                sum += binomial(i, k) * binomial(j, l) * s[k][l] * w[i - k][j - l];
            }
            s[i][j] = sum / light;
        }
    }
    [s[3][0], s[2][1], s[1][2], s[0][3]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::base::tolerance::Tolerance;
    use crate::geometry::shapes::nurbs::weighted;
    use crate::surface::data::kind::SurfaceKind;
    use crate::surface::data::one_sided::OneSided;

    /// A number from 0 to 1 that looks random.
    fn noise(k: usize) -> f64 {
        (k.wrapping_mul(2_654_435_761) >> 7 & 0xffff) as f64 / 65_536.0
    }

    /// A bent net of degree 6 by 5 with an inner knot, and weights that differ by `variation`.
    fn net(seed: usize, variation: f64) -> NurbsSurface {
        let knots = ([vec![0.0; 7], vec![0.4], vec![1.0; 7]].concat(), [vec![0.0; 6], vec![1.0; 6]].concat());
        let pole = |k: usize| {
            let place = DVec3::new((k % 8) as f64, (k / 8) as f64, 0.0);
            let off = DVec3::new(noise(seed + 3 * k), noise(seed + 3 * k + 1), 4.0 * noise(seed + 3 * k + 2));
            weighted(place + off, 1.0 + variation * noise(seed + 7 * k + 1000))
        };
        NurbsSurface { degree: (6, 5), knots, poles: (0..48).map(pole).collect(), counts: (8, 6) }
    }

    #[test]
    fn boxes_without_a_normal_count() {
        let net = net(5, 1.0);
        let bounds_with = |normal: DVec3| {
            let thirds = ThirdDerivativeBounds::new(&net, (&[0.0, 0.4, 1.0], &[0.0, 1.0]), &|_, _| normal);
            thirds.bounds_along((DVec2::splat(0.1), DVec2::splat(0.2)), DVec3::Z)
        };
        assert!(bounds_with(DVec3::Z)[0] > 0.0);
        assert_eq!(bounds_with(DVec3::ZERO), bounds_with(DVec3::Z));
        assert_eq!(bounds_with(DVec3::NAN), bounds_with(DVec3::Z));
    }

    #[test]
    fn no_third_derivative_is_above_its_bound() {
        const H: f64 = 1e-4;
        for case in 0..12 {
            let net = net(case * 977, 1.5 * (case % 3) as f64);
            let surface = net.clone().surface(SurfaceKind::Nurbs, Origin::NONE, &Tolerance::new(1e-6, 10.0));
            let thirds = ThirdDerivativeBounds::new(&net, (&[0.0, 0.4, 1.0], &[0.0, 1.0]), &|u, v| surface.normal(u, v));
            let (mut tightest, mut looked) = (f64::INFINITY, 0);
            for k in 0..200 {
                let at = |n: usize| noise(case + 31 * k + n);
                let (u, v) = (0.02 + 0.96 * at(1), 0.02 + 0.96 * at(2));
                if (u - 0.4).abs() < 2.0 * H {
                    continue;
                }
                let jet = |u: f64, v: f64| net.jet(u, v, (OneSided::After, OneSided::After));
                let slope = |a: DVec3, b: DVec3| (b - a) / (2.0 * H);
                let (left, right, below, above) = (jet(u - H, v), jet(u + H, v), jet(u, v - H), jet(u, v + H));
                let found =
                    [slope(left.duu, right.duu), slope(below.duu, above.duu), slope(left.dvv, right.dvv), slope(below.dvv, above.dvv)];
                let along = DVec3::new(at(3) - 0.5, at(4) - 0.5, at(5) - 0.5).normalize();
                let half = DVec2::new(0.02 * at(6), 0.02 * at(7));
                let bounds = thirds.bounds_along((DVec2::new(u, v) - half, DVec2::new(u, v) + half), along);
                for (third, bound) in found.iter().zip(bounds) {
                    let own = third.dot(along).abs();
                    assert!(own <= bound * (1.0 + 1e-4) + 1e-3, "case {case}, at {u} {v}: {own} is above {bound}");
                    if own > 1.0 {
                        (tightest, looked) = (tightest.min(bound / own), looked + 1);
                    }
                }
            }
            // The bounds say something: somewhere they are near what there is.
            assert!(looked > 100 && tightest < 4.0, "case {case}: {looked} {tightest}");
        }
    }
}
