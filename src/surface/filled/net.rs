//! The net of a corner of a hole: the field and what the borders are off it, blended in, interpolated by a spline.

use glam::{DVec2, DVec3, DVec4};

use crate::base::job;
use crate::base::math;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::one_sided::OneSided;
use crate::surface::filled::field::Field;
use crate::surface::filled::patch::{EdgePlace, Part, Patch};
use crate::surface::filled::ribbon::Ribbons;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Degree of the nets.
const DEGREE: usize = 7;
/// Numbers of spans that are tried, one after the other, and whether there is a knot wherever a border is less than analytic.
const TRIES: [(usize, bool); 8] = [(2, false), (4, false), (8, false), (2, true), (4, true), (16, false), (8, true), (32, true)];
/// How near to the borders nets are, as a share of the tolerance.
const NEAR: f64 = 1.0 / 5000.0;
/// Power by which what two sides say at their corner fades along them.
const FADE: i32 = 4;
/// Least width of a span, as a share of the mean.
const NARROW: f64 = 0.3;

/// What the border is off the field at a place of an edge: position, and derivative across in the patch's parameters.
#[derive(Clone, Copy, Debug)]
struct Off {
    at: EdgePlace,
    /// The point of the border.
    exact: Option<DVec3>,
    zero: DVec3,
    one: DVec3,
}

/// A patch with all that its points are made of.
pub struct PatchNet<'a> {
    pub ribbons: &'a Ribbons<'a>,
    pub field: &'a Field,
    pub patch: Patch,
}

/// Values at 0 and 1: B0 is 1 and 0, B1 has a derivative of 1 and 0; all other derivatives up to the second are 0.
fn blends(t: f64) -> [f64; 2] {
    let s = 1.0 - t;
    let cube = s * s * s;
    [cube * (1.0 + 3.0 * t + 6.0 * t * t), cube * t * (1.0 + 3.0 * t)]
}

impl PatchNet<'_> {
    /// What a side is off at a fraction: the point there, the position, and the derivative where the plane is left in a direction.
    fn at_side(&self, side: usize, f: f64, way: DVec2) -> (DVec3, DVec3, DVec3) {
        let place = self.ribbons.place(side, f);
        let jet = self.field.jet(place.p.truncate());
        let d = place.d1.truncate();
        let square = d.length_squared();
        let (along, inward) = if square > 0.0 { (way.dot(d) / square, way.dot(place.inward)) } else { (0.0, 0.0) };
        let slide = place.d1 - jet.along(d);
        let turn = place.across.map_or(DVec3::ZERO, |(first, _)| first - jet.along(place.inward));
        (place.p, place.p - jet.p, slide * along + turn * inward)
    }

    fn edges(&self, us: &[f64], vs: &[f64]) -> (Vec<Off>, Vec<Off>) {
        let (patch, ribbons) = (&self.patch, self.ribbons);
        let off = |part: Option<Part>, at: EdgePlace, way: DVec2| match part {
            Some(part) => {
                let (exact, zero, one) = self.at_side(part.side, part.fraction(at.t), way);
                Off { at, exact: Some(exact), zero, one }
            }
            None => Off { at, exact: None, zero: DVec3::ZERO, one: DVec3::ZERO },
        };
        let (low, west) = (patch.on_bottom(ribbons, 0.0), patch.on_left(ribbons, 0.0));
        let bottom = us.iter().map(|u| patch.on_bottom(ribbons, *u)).map(|at| off(patch.bottom, at, patch.map(&at, &west)[2]));
        let left = vs.iter().map(|v| patch.on_left(ribbons, *v)).map(|at| off(patch.left, at, patch.map(&low, &at)[1]));
        let (mut bottom, left): (Vec<Off>, Vec<Off>) = (bottom.collect(), left.collect());
        if let (Some(part), None) = (patch.bottom, patch.left) {
            self.agree(part, &mut bottom);
        }
        (bottom, left)
    }

    /// Makes derivatives across a whole side at its ends those that the patch beside it has: what is missing fades along the side.
    fn agree(&self, part: Part, bottom: &mut [Off]) {
        let (patch, n) = (&self.patch, self.ribbons.sides.len());
        let west = patch.on_left(self.ribbons, 0.0);
        let missing = [0.0, 1.0].map(|t: f64| {
            let way = patch.map(&patch.on_bottom(self.ribbons, t), &west)[2];
            let corner = if t == 0.0 { part.side } else { (part.side + 1) % n };
            self.at_corner(corner, way) - self.at_side(part.side, t, way).2
        });
        for off in bottom {
            let t = off.at.t;
            off.one += missing[0] * math::powi(1.0 - t, FADE) + missing[1] * math::powi(t, FADE);
        }
    }

    /// What a corner is off in a direction: by the derivatives along both sides, where these run in different directions, else the mean of what
    /// both sides say.
    fn at_corner(&self, corner: usize, way: DVec2) -> DVec3 {
        const APART: f64 = 0.1;
        let n = self.ribbons.sides.len();
        let ends = [((corner + n - 1) % n, 1.0), (corner, 0.0)];
        let [a, b] = ends.map(|(side, f)| self.ribbons.place(side, f).d1.truncate());
        let cross = a.perp_dot(b);
        if cross.abs() > APART * a.length() * b.length() {
            let [along_a, along_b] = [(ends[0], a), (ends[1], b)].map(|((side, f), d)| self.at_side(side, f, d).2);
            return along_a * (way.perp_dot(b) / cross) + along_b * (a.perp_dot(way) / cross);
        }
        let [one, other] = ends.map(|(side, f)| self.at_side(side, f, way).2);
        0.5 * (one + other)
    }

    /// Points of a grid, u fastest, in the plane's coordinates.
    fn grid(&self, us: &[f64], vs: &[f64]) -> Vec<DVec3> {
        const STEP: f64 = 1.0 / 1024.0;
        let (bottom, left) = self.edges(us, vs);
        let (ends, sides) = self.edges(&[0.0, STEP], &[0.0, STEP]);
        let both_sides = if self.patch.left.is_some() { 1.0 } else { 0.0 };
        let corner = ends[0].zero;
        let twist = 0.5 * ((ends[1].one - ends[0].one) + (sides[1].one - sides[0].one)) / STEP;
        let mut out = Vec::with_capacity(us.len() * vs.len());
        for b in &left {
            for a in &bottom {
                match (a.exact, b.exact) {
                    (Some(p), _) if b.at.t == 0.0 => out.push(p),
                    (_, Some(p)) if a.at.t == 0.0 => out.push(p),
                    _ => {
                        let (x, y) = (blends(a.at.t), blends(b.at.t));
                        let each = a.zero * y[0] + a.one * y[1] + b.zero * x[0] + b.one * x[1];
                        let both =
                            corner * (x[0] * y[0]) + sides[0].one * (x[1] * y[0]) + ends[0].one * (x[0] * y[1]) + twist * (x[1] * y[1]);
                        out.push(self.field.point(self.patch.map(&a.at, &b.at)[0]) + each - both * both_sides);
                    }
                }
            }
        }
        out
    }
}

/// A spline along one direction: its knots and where it is interpolated.
struct Spline {
    knots: Vec<f64>,
    sites: Vec<f64>,
    /// Per site the first function that is not zero there, and all that are not.
    rows: Vec<(usize, Vec<f64>)>,
}

impl Spline {
    fn new(breaks: &[(f64, usize)], spans: usize) -> Self {
        let mut inner: Vec<(f64, usize)> = breaks.to_vec();
        let mut before = 0.0;
        for end in breaks.iter().map(|b| b.0).chain([1.0]) {
            let parts = ((end - before) * spans as f64 - NARROW).ceil().max(1.0) as usize;
            inner.extend((1..parts).map(|k| (before + (end - before) * k as f64 / parts as f64, 1)));
            before = end;
        }
        inner.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut knots = vec![0.0; DEGREE + 1];
        knots.extend(inner.iter().flat_map(|(x, times)| std::iter::repeat_n(*x, *times)));
        knots.extend([1.0; DEGREE + 1]);
        let count = knots.len() - DEGREE - 1;
        let sites: Vec<f64> = (0..count).map(|k| knots[k + 1..=k + DEGREE].iter().sum::<f64>() / DEGREE as f64).collect();
        let rows = sites.iter().map(|t| functions(&knots, *t)).collect();
        Self { knots, sites, rows }
    }

    /// Poles through values at the sites; the matrix is totally positive, so that elimination needs no pivots [de Boor 1978, chapter XIII].
    fn poles(&self, values: &mut [DVec3]) {
        let n = self.sites.len();
        let (mut rows, width) = (self.rows.clone(), DEGREE + 1);
        for k in 0..n {
            for i in k + 1..n.min(k + width) {
                let (first, row) = (rows[i].0, rows[k].clone());
                if first > k || k < row.0 || k - first >= width {
                    continue;
                }
                let factor = rows[i].1[k - first] / row.1[k - row.0];
                for j in k..row.0 + width {
                    // What is right of a later row is not left of it: rows move to the right.
                    if let Some(entry) = rows[i].1.get_mut(j - first) {
                        *entry -= factor * row.1[j - row.0];
                    }
                }
                let above = values[k];
                values[i] -= above * factor;
            }
        }
        for k in (0..n).rev() {
            let (first, row) = &rows[k];
            let rest: DVec3 = (k + 1..(first + width).min(n)).map(|j| values[j] * row[j - first]).sum();
            values[k] = (values[k] - rest) / row[k - first];
        }
    }
}

/// The first function that is not zero at a place, and the values of all that are not [Piegl & Tiller 1997, A2.2].
fn functions(knots: &[f64], t: f64) -> (usize, Vec<f64>) {
    let last = knots.len() - DEGREE - 2;
    let span = knots.partition_point(|k| *k <= t).saturating_sub(1).clamp(DEGREE, last);
    let mut values = vec![1.0];
    for d in 1..=DEGREE {
        let mut next = vec![0.0; d + 1];
        for (r, value) in values.iter().enumerate() {
            let (low, high) = (knots[span + 1 + r - d], knots[span + 1 + r]);
            let share = value / (high - low);
            next[r] += (high - t) * share;
            next[r + 1] += (t - low) * share;
        }
        values = next;
    }
    (span - DEGREE, values)
}

/// Parameters of an edge where it is not analytic, with the multiplicity of a knot there.
fn breaks(ribbons: &Ribbons, part: Option<Part>, tolerance: &Tolerance) -> Vec<(f64, usize)> {
    let Some(half) = part else { return Vec::new() };
    let chain = &ribbons.sides[half.side].chain;
    let near = tolerance.point / chain.length();
    let mut found: Vec<(f64, usize)> = Vec::new();
    for f in chain_breaks(chain) {
        let t = (f - half.from) / (half.to - half.from);
        if t <= near || t >= 1.0 - near || found.last().is_some_and(|last| (last.0 - t).abs() <= near) {
            continue;
        }
        let (a, b) = (chain.jet_before(f), chain.jet(f));
        let (first, second) = (a.d1.length(), a.d2.length().max(b.d2.length()).max(chain.length()));
        let times = match () {
            () if a.d1.distance(b.d1) > EPSILON.sqrt() * first => DEGREE,
            () if a.d2.distance(b.d2) > EPSILON.sqrt() * second => DEGREE - 1,
            () => DEGREE - 2,
        };
        found.push((t, times));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// The net of a patch, within a share of the tolerance of its borders.
pub fn net(patch: &PatchNet, tolerance: &Tolerance) -> NurbsSurface {
    let ribbons = patch.ribbons;
    let [along, up] = [patch.patch.bottom, patch.patch.left].map(|part| breaks(ribbons, part, tolerance));
    let near = (NEAR * tolerance.point).max(tolerance.rounding);
    let mut best: Option<(f64, NurbsSurface)> = None;
    for (spans, broken) in TRIES {
        job::poll();
        let [u, v] = [&along, &up].map(|breaks| {
            let kept: Vec<(f64, usize)> = breaks.iter().copied().filter(|(_, times)| broken || *times >= DEGREE - 1).collect();
            Spline::new(&kept, spans)
        });
        let net = with_spans(patch, &u, &v);
        let off = distance(patch, &net);
        if best.as_ref().is_none_or(|(before, _)| off < *before) {
            best = Some((off, net));
        }
        if best.as_ref().is_some_and(|(off, _)| *off <= near) {
            break;
        }
    }
    best.map(|(_, net)| net).unwrap_or_else(|| with_spans(patch, &Spline::new(&along, 1), &Spline::new(&up, 1)))
}

fn with_spans(patch: &PatchNet, u: &Spline, v: &Spline) -> NurbsSurface {
    let (nu, nv) = (u.sites.len(), v.sites.len());
    let mut points = patch.grid(&u.sites, &v.sites);
    points.chunks_exact_mut(nu).for_each(|row| u.poles(row));
    let mut column = vec![DVec3::ZERO; nv];
    for i in 0..nu {
        (0..nv).for_each(|j| column[j] = points[j * nu + i]);
        v.poles(&mut column);
        (0..nv).for_each(|j| points[j * nu + i] = column[j]);
    }
    let pole = |p: &DVec3| -> DVec4 { patch.ribbons.plane.global(*p).extend(1.0) };
    NurbsSurface {
        degree: (DEGREE, DEGREE),
        knots: (u.knots.clone(), v.knots.clone()),
        poles: points.iter().map(pole).collect(),
        counts: (nu, nv),
    }
}

/// How far a net is from its patch, on the borders and inside, model units.
fn distance(patch: &PatchNet, net: &NurbsSurface) -> f64 {
    const PLACES: usize = 24;
    const INSIDE: usize = 5;
    let side = OneSided::After;
    let point = |u: f64, v: f64| net.jet(u, v, (side, side)).p;
    let edge = |part: Part, t: f64| patch.ribbons.sides[part.side].point(part.fraction(t));
    let at = |k: usize, n: usize| (k as f64 + 0.37) / n as f64;
    let mut worst: f64 = 0.0;
    for t in (0..PLACES).map(|k| at(k, PLACES)) {
        let bottom = patch.patch.bottom.map_or(0.0, |part| point(t, 0.0).distance(edge(part, t)));
        let left = patch.patch.left.map_or(0.0, |part| point(0.0, t).distance(edge(part, t)));
        worst = worst.max(bottom).max(left);
    }
    let ts: Vec<f64> = (0..=INSIDE).map(|k| if k == INSIDE { 1.0 } else { at(k, INSIDE) }).collect();
    let inside = patch.grid(&ts, &ts);
    for (p, (j, i)) in inside.iter().zip((0..ts.len()).flat_map(|j| (0..ts.len()).map(move |i| (j, i)))) {
        worst = worst.max(point(ts[i], ts[j]).distance(patch.ribbons.plane.global(*p)));
    }
    worst
}
