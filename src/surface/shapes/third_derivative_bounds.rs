//! Bounds of the second and third derivatives of a net over boxes, found span by span when they are asked for.
//!
//! Hulls of differences, and the quotient rule where weights differ, overestimate third derivatives many times over a span in which a net
//! runs at uneven speed, turns through a good part of a circle or has uneven weights. A span is one box at first; the box over
//! which third derivatives let second ones vary most, for its bend, is halved until they matter little everywhere.

use std::rc::Rc;
use std::sync::OnceLock;

use glam::{DVec2, DVec3, DVec4};

use crate::base::tolerance::FLAT_BOX;
use crate::base::work;
use crate::geometry::shapes::bounds::binomial;
use crate::geometry::shapes::nurbs::projected;
use crate::surface::data::jet::Jet2;
use crate::surface::shapes::net_enclosure::NetStrip;
use crate::surface::shapes::nurbs::NurbsSurface;

/// What steers the boxes of a span.
struct BoxSettings {
    /// How far third derivatives let the surface be off over a box, as a share of what second ones do, up to which it is small enough.
    max_share: f64,
    /// Share of the bend that the most curved place of a span has which counts for all its boxes: over inflections bends vanish.
    counted_curvature: f64,
    /// The most that a triangle is taken to lean against the surface, sine; it leans by no more than the span turns.
    max_lean: f64,
    /// That turn, over the deviation of a span over its width: a few times what it is on a sphere.
    turns: f64,
    /// Deviation over the width of a box that counts as none.
    min_sag: f64,
    /// Halvings of a span along each direction.
    max_depth: u8,
    /// Boxes of a net that are halved at most, shared out to its spans.
    max_halved: usize,
    /// Boxes of a span that may be halved at the least.
    min_halved_of_span: usize,
}

const SETTINGS: BoxSettings = BoxSettings {
    max_share: 1.0,
    counted_curvature: 0.5,
    max_lean: 0.1,
    turns: 8.0,
    min_sag: FLAT_BOX,
    max_depth: 8,
    max_halved: 2048,
    min_halved_of_span: 64,
};

/// Bounds of |∂uuu|, |∂uuv|, |∂uvv|, |∂vvv| over a box: along a unit normal, and in any direction.
#[derive(Clone, Copy, Debug)]
struct ThirdDerivatives {
    normal: DVec3,
    along_normal: [f64; 4],
    any_direction: [f64; 4],
}

impl ThirdDerivatives {
    /// Bounds along a unit vector.
    fn along(&self, along: DVec3) -> [f64; 4] {
        let (up, aside) = (along.dot(self.normal).abs(), along.cross(self.normal).length());
        std::array::from_fn(|k| (up * self.along_normal[k] + aside * self.any_direction[k]).min(self.any_direction[k]))
    }
}

/// A box with its bounds; a halved one has two next to each other in the list.
#[derive(Clone, Copy, Debug)]
struct Node {
    third: ThirdDerivatives,
    /// Second derivatives in the middle: ∂uu, ∂uv, ∂vv.
    second: [DVec3; 3],
    /// The direction across which it is halved, and where the first half is.
    halves: Option<(usize, u32)>,
}

/// Derivatives along a unit vector over a box: bounds of |∂uuu|, |∂uuv|, |∂uvv|, |∂vvv|, and the ranges of ∂uu, ∂uv, ∂vv.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DerivativesAlong {
    pub(crate) third: [f64; 4],
    pub(crate) low: [f64; 3],
    pub(crate) high: [f64; 3],
}

impl DerivativesAlong {
    const NONE: Self = Self { third: [0.0; 4], low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
}

/// The boxes of a net.
#[derive(Debug)]
pub(crate) struct ThirdDerivativeBounds {
    /// Knots, 0 and 1 among them.
    knots: (Vec<f64>, Vec<f64>),
    /// Of each span, u fastest: all of it first, halves behind it.
    spans: Vec<OnceLock<Vec<Node>>>,
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

/// Sum of bounds times powers of the half widths of a box: ∂uuu, ∂uuv, ∂uvv, ∂vvv.
fn terms(third: [f64; 4], half: DVec2) -> [f64; 4] {
    let DVec2 { x, y } = half;
    [third[0] * x * x * x, third[1] * x * x * y, third[2] * x * y * y, third[3] * y * y * y]
}

impl ThirdDerivativeBounds {
    /// Of a net with these knots, 0 and 1 among them.
    pub fn new(knots: (Vec<f64>, Vec<f64>)) -> Self {
        let n = (knots.0.len() - 1) * (knots.1.len() - 1);
        Self { knots, spans: (0..n).map(|_| OnceLock::new()).collect() }
    }

    /// Derivatives along a unit vector over a box; `jet` evaluates the net.
    pub fn along(&self, net: &NurbsSurface, jet: &impl Fn(DVec2) -> Jet2, (low, high): Area, along: DVec3) -> DerivativesAlong {
        // Knots that end the box do not count what is beyond.
        let range = |knots: &[f64], a: f64, b: f64| {
            let last = knots.len() - 2;
            let from = (knots.partition_point(|l| *l <= a).max(1) - 1).min(last);
            (from, (knots.partition_point(|l| *l < b).max(1) - 1).clamp(from, last))
        };
        let (us, vs) = (&self.knots.0, &self.knots.1);
        let ((i0, i1), (j0, j1)) = (range(us, low.x, high.x), range(vs, low.y, high.y));
        let mut found = DerivativesAlong::NONE;
        for j in j0..=j1 {
            for i in i0..=i1 {
                let whole = (DVec2::new(us[i], vs[j]), DVec2::new(us[i + 1], vs[j + 1]));
                // Made once for everyone, whoever comes first.
                let made = || work::uncharged(|| SpanBoxes::new(net, jet, whole, self.spans.len()).nodes);
                let nodes = self.spans[j * (us.len() - 1) + i].get_or_init(made);
                add(nodes, 0, whole, (low, high), along, &mut found);
            }
        }
        found
    }
}

/// Adds what a box and its halves say over another box.
fn add(nodes: &[Node], node: usize, own: Area, area: Area, along: DVec3, found: &mut DerivativesAlong) {
    let Node { third, second, halves: parts } = &nodes[node];
    let Some((axis, first)) = parts else {
        let third = third.along(along);
        let middle = 0.5 * (own.0 + own.1);
        // How far what is asked for reaches from the middle.
        let reach = (middle - area.0.clamp(own.0, own.1)).abs().max((area.1.clamp(own.0, own.1) - middle).abs());
        for k in 0..3 {
            let (at, slack) = (second[k].dot(along), third[k] * reach.x + third[k + 1] * reach.y);
            (found.low[k], found.high[k]) = (found.low[k].min(at - slack), found.high[k].max(at + slack));
        }
        (0..4).for_each(|k| found.third[k] = found.third[k].max(third[k]));
        return;
    };
    let [before, after] = halves(own, *axis);
    let middle = before.1[*axis];
    if area.0[*axis] < middle {
        add(nodes, *first as usize, before, area, along, found);
    }
    if area.1[*axis] > middle || area.0[*axis] >= middle {
        add(nodes, *first as usize + 1, after, area, along, found);
    }
}

/// A box of a span that may be halved.
struct OpenBox {
    node: usize,
    area: Area,
    depth: [u8; 2],
    /// How far second derivatives in the middle let the surface be off.
    sag: f64,
    /// The same of third ones, along each direction: by those along the normal, and by those in any direction.
    slack: [[f64; 2]; 2],
    /// Width in space.
    width: f64,
    strips: Strips,
}

/// The strips of both directions of a box: halves have one in common.
type Strips = [Rc<NetStrip>; 2];

/// The boxes of a span while they are made.
struct SpanBoxes<'a, J> {
    net: &'a NurbsSurface,
    jet: &'a J,
    nodes: Vec<Node>,
    open: Vec<OpenBox>,
    /// Largest deviation over the square of the width.
    curvature: f64,
    /// How much triangles may lean against the surface, sine.
    lean: f64,
}

impl<'a, J: Fn(DVec2) -> Jet2> SpanBoxes<'a, J> {
    /// Halves boxes, the worst one first, until all are small enough.
    fn new(net: &'a NurbsSurface, jet: &'a J, whole: Area, spans: usize) -> Self {
        let mut boxes = Self { net, jet, nodes: Vec::new(), open: Vec::new(), curvature: 0.0, lean: 0.0 };
        boxes.push(whole, [0; 2], [0, 1].map(|axis| boxes.strip(whole, axis)));
        let first = &boxes.open[0];
        boxes.lean = (SETTINGS.turns * (first.sag + first.slack[0][0] + first.slack[0][1]) / first.width).min(SETTINGS.max_lean);
        let most = (SETTINGS.max_halved / spans).max(SETTINGS.min_halved_of_span);
        for _ in 0..most {
            let Some((k, axis)) = boxes.worst() else { break };
            let OpenBox { node, area, mut depth, strips, .. } = boxes.open.swap_remove(k);
            depth[axis] += 1;
            boxes.nodes[node].halves = Some((axis, boxes.nodes.len() as u32));
            for part in halves(area, axis) {
                let mut strips = strips.clone();
                strips[axis] = boxes.strip(part, axis);
                boxes.push(part, depth, strips);
            }
        }
        boxes
    }

    /// The box that is worst for its bend, and the direction in which it is halved.
    fn worst(&self) -> Option<(usize, usize)> {
        let mut worst: Option<(f64, usize, usize)> = None;
        for (k, own) in self.open.iter().enumerate() {
            let sag = own.sag.max(SETTINGS.counted_curvature * self.curvature * own.width * own.width).max(SETTINGS.min_sag * own.width);
            let slack = [0, 1].map(|axis| own.slack[0][axis] + self.lean * own.slack[1][axis]);
            let share = (slack[0] + slack[1]) / sag;
            let axis = usize::from(slack[1] > slack[0]);
            let axis = if own.depth[axis] < SETTINGS.max_depth { axis } else { 1 - axis };
            let is_open = share > SETTINGS.max_share && own.depth[axis] < SETTINGS.max_depth && slack[axis] > 0.0;
            if is_open && worst.is_none_or(|(most, ..)| share > most) {
                worst = Some((share, k, axis));
            }
        }
        worst.map(|(_, k, axis)| (k, axis))
    }

    fn strip(&self, (low, high): Area, axis: usize) -> Rc<NetStrip> {
        Rc::new(self.net.strip(axis == 0, (low[axis], high[axis])))
    }

    fn push(&mut self, area: Area, depth: [u8; 2], strips: Strips) {
        let (low, high) = area;
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let jet = (self.jet)(middle);
        let normal = jet.du.cross(jet.dv).normalize_or_zero();
        let third = self.net.third(&strips[0], &strips[1], normal);
        let slack = [third.along_normal, third.any_direction].map(|third| {
            let [a, b, c, d] = terms(third, half);
            [a + 2.0 * b + c, b + 2.0 * c + d]
        });
        let second = [jet.duu, jet.duv, jet.dvv];
        let [uu, uv, vv] = second.map(|d| d.dot(normal).abs());
        let sag = uu * half.x * half.x + 2.0 * uv * half.x * half.y + vv * half.y * half.y;
        let width = jet.du.length() * half.x + jet.dv.length() * half.y;
        if width > 0.0 {
            self.curvature = self.curvature.max(sag / (width * width));
        }
        self.open.push(OpenBox { node: self.nodes.len(), area, depth, sag, slack, width, strips });
        self.nodes.push(Node { third, second, halves: None });
    }
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
        let (net, area) = (net(5, 1.0), (DVec2::splat(0.1), DVec2::splat(0.2)));
        for jet in [Jet2::default(), Jet2 { du: DVec3::X, dv: DVec3::X, ..Jet2::default() }] {
            let thirds = ThirdDerivativeBounds::new((vec![0.0, 0.4, 1.0], vec![0.0, 1.0]));
            for along in [DVec3::X, DVec3::Y, DVec3::Z] {
                let found = thirds.along(&net, &|_| jet, area, along);
                assert!(found.third.iter().all(|bound| *bound > 0.0), "{found:?}");
            }
        }
    }

    #[test]
    fn no_third_derivative_is_above_its_bound() {
        const H: f64 = 1e-4;
        for case in 0..12 {
            let net = net(case * 977, 1.5 * (case % 3) as f64);
            let surface = net.clone().surface(SurfaceKind::Nurbs, Origin::NONE, &Tolerance::new(1e-6, 10.0));
            let thirds = ThirdDerivativeBounds::new((vec![0.0, 0.4, 1.0], vec![0.0, 1.0]));
            let own = |at: DVec2| surface.jet(at.x, at.y);
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
                let over = thirds.along(&net, &own, (DVec2::new(u, v) - half, DVec2::new(u, v) + half), along);
                let place = jet(u + half.x * (2.0 * at(8) - 1.0), v + half.y * (2.0 * at(9) - 1.0));
                for (k, second) in [place.duu, place.duv, place.dvv].into_iter().enumerate() {
                    let (own, room) = (second.dot(along), 1e-9 * second.length());
                    assert!(own >= over.low[k] - room && own <= over.high[k] + room, "case {case}, at {u} {v}: {own} is out of {over:?}");
                }
                for (third, bound) in found.iter().zip(over.third) {
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
