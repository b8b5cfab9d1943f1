//! A strip between two surfaces that has their borders and their tangent planes there.
//!
//! Across the strip it is the Hermite cubic of both borders and of the derivatives across them [P3 §3.3; Farin 2002, chapter 22]. Both are
//! splines along the border, in homogeneous form, so the strip is a B-spline that has them exactly: no gap and no angle but rounding.

use glam::{DVec3, DVec4};

use crate::base::fault::{Result, ValueFault};
use crate::base::origin::Origin;
use crate::base::tolerance::{BRIDGE_KNOT, Tolerance};
use crate::geometry::shapes::nurbs::{Nurbs, projected};
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Chords of which the length of a cubic is the sum.
const CHORDS: usize = 32;
/// Rounds in which lengths and derivatives are brought together.
const ROUNDS: usize = 12;
/// Places of two borders that are compared.
const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// One side of a net: the border and the derivative out across it, on the same knots, homogeneous.
#[derive(Clone, Debug)]
struct NetSide {
    border: Nurbs,
    out: Nurbs,
}

impl NetSide {
    fn reversed(&self) -> Self {
        Self { border: self.border.reversed(), out: self.out.reversed() }
    }

    /// The point and the derivative out of the surface.
    fn at(&self, t: f64) -> (DVec3, DVec3) {
        let value = |c: &Nurbs| c.blossom(c.span(t), &vec![t; c.degree]);
        let (p, d) = (value(&self.border), value(&self.out));
        (projected(p), (d.truncate() - projected(p) * d.w) / p.w)
    }

    /// Whether it is no point.
    fn has_length(&self, tolerance: &Tolerance) -> bool {
        let first = projected(self.border.poles[0]);
        self.border.poles.iter().any(|q| !tolerance.same_point(first, projected(*q)))
    }

    /// How far it is from another one: the sum of the distances of places at the same parameters. Of closed borders the ends say nothing.
    fn apart(&self, other: &Self) -> f64 {
        PLACES.iter().map(|t| self.at(*t).0.distance(other.at(*t).0)).sum()
    }
}

/// The strip between the borders of two surfaces that are nearest to each other, by the distances of places along them. u runs along the first
/// one's border, v from the first surface to the second.
///
/// Fails with E306 for a surface that is trimmed or is no B-spline.
pub fn bridge(surfaces: [&Surface; 2], origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let (ours, theirs) = (sides(surfaces[0], "a", tolerance)?, sides(surfaces[1], "b", tolerance)?);
    let pairs = ours.iter().flat_map(|a| theirs.iter().flat_map(move |b| [(a, b.clone()), (a, b.reversed())]));
    let nearest = pairs.map(|(a, b)| (a.apart(&b), a, b)).min_by(|x, y| x.0.total_cmp(&y.0));
    let Some((_, a, b)) = nearest else {
        return Err(outside("a", "a surface that is one point"));
    };
    let scales = scales(a, &b);
    let pieces = [&a.border.elevated(1), &times(&a.out, scales[0]), &b.border.elevated(1), &times(&b.out, scales[1])];
    let degree = pieces.iter().map(|c| c.degree).max().unwrap_or(1);
    let raised = pieces.map(|c| c.elevated(degree - c.degree));
    let knots = merged(&raised[0].knots, &raised[2].knots);
    let [from, out, to, into] = raised.map(|c| c.refined(&missing(&knots, &c.knots)).poles);
    let third = |p: &[DVec4], d: &[DVec4]| -> Vec<DVec4> { p.iter().zip(d).map(|(p, d)| *p + *d / 3.0).collect() };
    let rows = [from.clone(), third(&from, &out), third(&to, &into), to];
    let counts = (from.len(), 4);
    let poles: Vec<DVec4> = rows.concat();
    if poles.iter().any(|q| q.w <= 0.0) {
        return Err(outside("b", "a surface too far away for the weights of the borders"));
    }
    let net = NurbsSurface { degree: (degree, 3), knots: (knots, [[0.0; 4], [1.0; 4]].concat()), poles, counts };
    Ok(net.surface(SurfaceKind::Hermite, origin, tolerance))
}

fn outside(argument: &'static str, found: &str) -> crate::base::fault::Fault {
    let range = "an untrimmed B-spline surface with borders, as `nurbs(s)` makes it of others".to_owned();
    ValueFault::OutsideRange { argument, found: found.to_owned(), range }.into()
}

/// The sides of a surface that are no points.
fn sides(surface: &Surface, argument: &'static str, tolerance: &Tolerance) -> Result<Vec<NetSide>> {
    if surface.parts().trim.is_some() {
        return Err(outside(argument, "a trimmed surface"));
    }
    let form = surface.to_net(tolerance)?.filter(|form| form.off.is_exact());
    let Some(net) = form.map(|form| form.net) else { return Err(outside(argument, "another surface")) };
    let clamped = |knots: &[f64], p: usize| knots[0] == knots[p] && knots[knots.len() - 1] == knots[knots.len() - 1 - p];
    if !clamped(&net.knots.0, net.degree.0) || !clamped(&net.knots.1, net.degree.1) {
        return Err(outside(argument, "a surface with open knots"));
    }
    Ok((0..4).map(|k| side(&net, k)).filter(|side| side.has_length(tolerance)).collect())
}

/// Side `k` of a net with full end knots: v = 0, u = 1, v = 1, u = 0.
fn side(net: &NurbsSurface, k: usize) -> NetSide {
    let (across_v, last) = (k.is_multiple_of(2), k == 1 || k == 2);
    let (along, across) = if across_v { (&net.knots.0, &net.knots.1) } else { (&net.knots.1, &net.knots.0) };
    let (degree, p) = if across_v { net.degree } else { (net.degree.1, net.degree.0) };
    let (count, rows) = if across_v { net.counts } else { (net.counts.1, net.counts.0) };
    let row = |r: usize| -> Vec<DVec4> { (0..count).map(|i| if across_v { net.pole(i, r) } else { net.pole(r, i) }).collect() };
    let (edge, next) = if last { (row(rows - 1), row(rows - 2)) } else { (row(0), row(1)) };
    // The first inner knot interval decides how fast the first leg of the poles is run through.
    let n = across.len();
    let width = if last { across[n - 2] - across[n - 2 - p] } else { across[p + 1] - across[1] };
    let out = edge.iter().zip(&next).map(|(e, n)| (*e - *n) * (p as f64 / width)).collect();
    let curve = |poles: Vec<DVec4>| Nurbs::new(degree, along.clone(), poles).over(0.0, 1.0);
    NetSide { border: curve(edge), out: curve(out) }
}

/// Factors of both derivatives at both ends of the borders, linear between: there the cubic across runs through its length at an even
/// speed, as near as it can. They follow from the ends alone, so strips side by side have one end in common.
fn scales(a: &NetSide, b: &NetSide) -> [[f64; 2]; 2] {
    let at = [0.0, 1.0].map(|t| even(a.at(t), b.at(t)));
    // Where a surface has no derivative across, as at a point, the other end says how large it is elsewhere.
    let filled = |x: Option<f64>, other: Option<f64>| x.or(other).unwrap_or(1.0);
    [0, 1].map(|side: usize| [filled(at[0][side], at[1][side]), filled(at[1][side], at[0][side])])
}

/// Factors of two derivatives out at two points with which the cubic between them is run through at an even speed at its ends; none for a
/// derivative that is zero.
fn even((p, d): (DVec3, DVec3), (q, e): (DVec3, DVec3)) -> [Option<f64>; 2] {
    let factor = |d: DVec3, length: f64| (d != DVec3::ZERO).then(|| length / d.length());
    let mut long = p.distance(q);
    for _ in 0..ROUNDS {
        let third = |d: DVec3| d * (factor(d, long).unwrap_or(0.0) / 3.0);
        long = length([p, p + third(d), q + third(e), q]);
    }
    [factor(d, long), factor(e, long)]
}

/// Length of a Bézier cubic, as a polyline.
fn length([a, b, c, d]: [DVec3; 4]) -> f64 {
    let at = |k: usize| {
        let t = k as f64 / CHORDS as f64;
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    };
    (0..CHORDS).map(|k| at(k).distance(at(k + 1))).sum()
}

/// A curve times the linear function with these values at 0 and 1, of a degree more.
fn times(curve: &Nurbs, [from, to]: [f64; 2]) -> Nurbs {
    let q = curve.degree + 1;
    let knots: Vec<f64> = curve.breaks().into_iter().flat_map(|(x, times)| std::iter::repeat_n(x, times + 1)).collect();
    let poles = (0..knots.len() - q - 1)
        .map(|i| {
            let arguments = &knots[i + 1..=i + q];
            let middle = (i..=i + q).filter(|&j| knots[j] < knots[j + 1]).min_by_key(|&j| (2 * j).abs_diff(2 * i + q));
            let k = middle.map_or(curve.degree, |j| curve.span(0.5 * (knots[j] + knots[j + 1])));
            // The blossom of a product is the mean of those of its factors over all ways to share the arguments.
            let part = |out: usize| {
                let rest: Vec<f64> = (0..q).filter(|j| *j != out).map(|j| arguments[j]).collect();
                curve.blossom(k, &rest) * (from + (to - from) * arguments[out])
            };
            (0..q).fold(DVec4::ZERO, |sum, out| sum + part(out)) / q as f64
        })
        .collect();
    Nurbs::new(q, knots, poles)
}

/// Each knot as often as where it is most.
fn merged(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut all = [a, &missing(b, a)].concat();
    all.sort_by(f64::total_cmp);
    all
}

/// The knots of `all` that `some` lacks, both ascending.
fn missing(all: &[f64], some: &[f64]) -> Vec<f64> {
    let mut k = 0;
    let mut out = Vec::new();
    for &x in all {
        while k < some.len() && some[k] < x - BRIDGE_KNOT {
            k += 1;
        }
        if k < some.len() && some[k] <= x + BRIDGE_KNOT {
            k += 1;
        } else {
            out.push(x);
        }
    }
    out
}
