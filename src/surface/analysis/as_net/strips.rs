//! A mapped surface as bicubic pieces within the tolerance, where it is no sum of curves.
//!
//! Each piece is the bicubic Hermite patch of the surface's own derivatives at its corners, so neighbours agree; where
//! the surface leaves a piece by more than the tolerance allows, its whole strip is halved.

use glam::{DVec3, DVec4};

use crate::base::fault::Result;
use crate::base::tolerance::{EPSILON, NUDGE, Tolerance};
use crate::geometry::data::fault::CurveFault;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::{Jet2, slopes};
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Strips in one direction at most.
const MOST_STRIPS: usize = 1 << 10;
/// Places inside a strip at which the pieces are compared with the surface.
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];

/// A parameter of the square, from one side.
type SidedParameter = (f64, OneSided);

/// Bicubic pieces in the making.
pub struct Fit<'s> {
    surface: &'s Surface,
    tolerance: &'s Tolerance,
    us: Vec<f64>,
    vs: Vec<f64>,
    /// How far beside the surface, along its normals.
    beside: f64,
}

impl<'s> Fit<'s> {
    /// Pieces of a surface over a square or a triangle.
    pub fn new(surface: &'s Surface, tolerance: &'s Tolerance) -> Self {
        let (us, vs) = surface.breaks();
        let stops = |inner: &[f64]| [&[0.0], inner, &[1.0]].concat();
        // A triangle is read over the square: its rows all run over 0…1.
        let us = if surface.domain() == Domain::Triangle { vec![0.0, 1.0] } else { stops(&us) };
        Self { surface, tolerance, us, vs: stops(&vs), beside: 0.0 }
    }

    /// Point, ∂u, ∂v and ∂uv over the square.
    fn jets(&self, us: &[SidedParameter], vs: &[SidedParameter]) -> Vec<Jet2> {
        if self.beside != 0.0 {
            let places = vs.iter().flat_map(|v| us.iter().map(move |u| (*u, *v)));
            return places.map(|place| beside(self.surface, place, self.beside)).collect();
        }
        if self.surface.domain() != Domain::Triangle {
            return self.surface.jets(us, vs);
        }
        // T(s(1 − t), t).
        let each = vs.iter().flat_map(|v| us.iter().map(move |u| (*u, *v)));
        each.map(|((s, lean_s), (t, lean_t))| {
            let jet = self.surface.jet_one_sided(s * (1.0 - t), t, (lean_s, lean_t));
            let (du, across) = (jet.du * (1.0 - t), jet.duv - jet.duu * s);
            Jet2 { p: jet.p, du, dv: jet.dv - jet.du * s, duv: across * (1.0 - t) - jet.du, ..Jet2::default() }
        })
        .collect()
    }

    /// Of the points at a distance along the normals instead.
    pub fn beside(self, beside: f64) -> Self {
        Self { beside, ..self }
    }

    /// The net; E413 where too many pieces would be needed.
    pub fn run(mut self) -> Result<NurbsSurface> {
        loop {
            let net = self.net();
            let (split_u, split_v) = self.off(&net);
            if split_u.is_empty() && split_v.is_empty() {
                return Ok(net);
            }
            halve(&mut self.us, &split_u);
            halve(&mut self.vs, &split_v);
            if self.us.len().max(self.vs.len()) > MOST_STRIPS {
                let what = "the spline form of a surface".to_owned();
                let at = self.surface.point(self.us[split_u.first().copied().unwrap_or(0)], 0.0);
                return Err(CurveFault::NotConverged { of: self.surface.origin(), what, at }.into());
            }
        }
    }

    /// Strips in which the net is too far from the surface: along u, along v.
    fn off(&self, net: &NurbsSurface) -> (Vec<usize>, Vec<usize>) {
        // On the lines between strips only one direction is to blame; inside the pieces both.
        let inside = |stops: &[f64]| -> Vec<f64> { stops.windows(2).flat_map(|w| PLACES.map(|x| w[0] + (w[1] - w[0]) * x)).collect() };
        let (us, vs) = (inside(&self.us), inside(&self.vs));
        let far = |us: &[f64], vs: &[f64]| -> Vec<bool> {
            let side = |list: &[f64]| list.iter().map(|x| (*x, OneSided::After)).collect::<Vec<SidedParameter>>();
            let mut found = vec![DVec3::ZERO; us.len() * vs.len()];
            net.grid(us, vs, &mut found);
            let jets = self.jets(&side(us), &side(vs));
            found.iter().zip(jets).map(|(p, jet)| p.distance(jet.p) > 0.5 * self.tolerance.point).collect()
        };
        let n = PLACES.len();
        let by_u = far(&us, &self.vs);
        let mut split_u: Vec<usize> =
            (0..self.us.len() - 1).filter(|i| (0..self.vs.len()).any(|j| (0..n).any(|k| by_u[j * us.len() + n * i + k]))).collect();
        let by_v = far(&self.us, &vs);
        let mut split_v: Vec<usize> = (0..self.vs.len() - 1)
            .filter(|j| (0..n).any(|k| by_v[(n * j + k) * self.us.len()..][..self.us.len()].contains(&true)))
            .collect();
        if split_u.is_empty() && split_v.is_empty() {
            let both = far(&us, &vs);
            for (place, _) in both.iter().enumerate().filter(|(_, far)| **far) {
                split_u.push(place % us.len() / n);
                split_v.push(place / us.len() / n);
            }
            split_u.sort_unstable();
            split_u.dedup();
            split_v.sort_unstable();
            split_v.dedup();
        }
        (split_u, split_v)
    }

    /// The bicubic pieces as one net; inner knots are double, and triple where the derivative across them jumps.
    fn net(&self) -> NurbsSurface {
        let sided = |stops: &[f64]| -> Vec<SidedParameter> {
            stops.windows(2).flat_map(|w| [(w[0], OneSided::After), (w[1], OneSided::Before)]).collect()
        };
        let (us, vs) = (sided(&self.us), sided(&self.vs));
        let jets = self.jets(&us, &vs);
        let at = |i: usize, j: usize| &jets[j * us.len() + i];
        let (m, n) = (self.us.len() - 1, self.vs.len() - 1);
        let counts = (3 * m + 1, 3 * n + 1);
        let mut poles = vec![DVec4::ZERO; counts.0 * counts.1];
        for (i, j) in (0..n).flat_map(|j| (0..m).map(move |i| (i, j))) {
            let (h, k) = ((self.us[i + 1] - self.us[i]) / 3.0, (self.vs[j + 1] - self.vs[j]) / 3.0);
            for (a, b) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let jet = at(2 * i + a, 2 * j + b);
                let (x, y) = (3 * (i + a), 3 * (j + b));
                let (du, dv) = (if a == 0 { jet.du * h } else { jet.du * -h }, if b == 0 { jet.dv * k } else { jet.dv * -k });
                let twist = jet.duv * (h * k) * if a == b { 1.0 } else { -1.0 };
                let (next_x, next_y) = (if a == 0 { x + 1 } else { x - 1 }, if b == 0 { y + 1 } else { y - 1 });
                for (x, y, p) in
                    [(x, y, jet.p), (next_x, y, jet.p + du), (x, next_y, jet.p + dv), (next_x, next_y, jet.p + du + dv + twist)]
                {
                    poles[y * counts.0 + x] = p.extend(1.0);
                }
            }
        }
        let same = |a: DVec3, b: DVec3| (a - b).length() <= EPSILON * (a.length() + b.length()) * MOST_STRIPS as f64;
        let smooth_u: Vec<bool> = (1..m).map(|i| (0..vs.len()).all(|j| same(at(2 * i - 1, j).du, at(2 * i, j).du))).collect();
        let smooth_v: Vec<bool> = (1..n).map(|j| (0..us.len()).all(|i| same(at(i, 2 * j - 1).dv, at(i, 2 * j).dv))).collect();
        let (keep_u, keep_v) = (kept(counts.0, &smooth_u), kept(counts.1, &smooth_v));
        let poles = keep_v.iter().flat_map(|y| keep_u.iter().map(|x| poles[*y * counts.0 + *x]).collect::<Vec<_>>()).collect();
        let knots = (knots(&self.us, &smooth_u), knots(&self.vs, &smooth_v));
        NurbsSurface { degree: (3, 3), knots, poles, counts: (keep_u.len(), keep_v.len()) }
    }
}

/// Halves the strips with these indices, ascending.
fn halve(stops: &mut Vec<f64>, strips: &[usize]) {
    for k in strips.iter().rev() {
        stops.insert(k + 1, 0.5 * (stops[*k] + stops[k + 1]));
    }
}

/// Places of poles that stay: on a smooth line the middle one follows from its neighbours.
fn kept(count: usize, smooth: &[bool]) -> Vec<usize> {
    (0..count).filter(|k| k % 3 != 0 || *k == 0 || *k + 1 == count || !smooth[k / 3 - 1]).collect()
}

fn knots(stops: &[f64], smooth: &[bool]) -> Vec<f64> {
    let inner = stops[1..stops.len() - 1].iter().zip(smooth);
    let inner = inner.flat_map(|(x, smooth)| std::iter::repeat_n(*x, if *smooth { 2 } else { 3 }));
    std::iter::repeat_n(0.0, 4).chain(inner).chain(std::iter::repeat_n(1.0, 4)).collect()
}

/// The jet at a distance: point, ∂u, ∂v and ∂uv; zero where a surface has no normal.
pub(crate) fn beside(surface: &Surface, (u, v): ((f64, OneSided), (f64, OneSided)), distance: f64) -> Jet2 {
    let side = (u.1, v.1);
    let step = |x: (f64, OneSided)| if x.1 == OneSided::After && x.0 + NUDGE <= 1.0 || x.0 < NUDGE { NUDGE } else { -NUDGE };
    let (du, dv) = (step(u), step(v));
    let jet = surface.jet_one_sided(u.0, v.0, side);
    let normal = |u: f64, v: f64| surface.normal_one_sided(u, v, side);
    let n = normal(u.0, v.0);
    let differences = || ((normal(u.0 + du, v.0) - n) / du, (normal(u.0, v.0 + dv) - n) / dv);
    let (nu, nv) = slopes(&jet).unwrap_or_else(differences);
    let beyond = slopes(&surface.jet_one_sided(u.0, v.0 + dv, side)).map_or(nu, |next| next.0);
    Jet2 {
        p: jet.p + n * distance,
        du: jet.du + nu * distance,
        dv: jet.dv + nv * distance,
        duv: jet.duv + (beyond - nu) * (distance / dv),
        ..Jet2::default()
    }
}
