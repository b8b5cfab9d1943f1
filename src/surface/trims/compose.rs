//! Curves in (u, v) put into a surface exactly: on planes by the frame, on nets by composing polynomials in Bernstein form.
//!
//! Over a patch of degrees p, q a curve of degree m is one of degree m (p + q), rational where either is [DeRose 1988]: de
//! Casteljau's steps with (1 − s, s) being polynomials of the curve's parameter. Curves are cut where they meet inner knots.

use std::sync::Arc;

use glam::DVec4;

use crate::base::origin::Origin;
use crate::base::tolerance::EPSILON;
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::shapes::bounds::binomial;
use crate::geometry::shapes::nurbs::{COMMON_DEGREE, projected};
use crate::geometry::shapes::nurbs_edit::Bezier;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::network::Chain;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::shapes::frame::Frame;
use crate::surface::shapes::nurbs::NurbsSurface;

/// Pieces of a curve at most.
const MOST_PIECES: usize = 1 << 12;
/// Halvings down to a knot.
const HALVINGS: u32 = 52;

/// A curve in (u, v) as the curve of space that lies over it, the same but for rounding. `None` where there is none of degree
/// 9 at most, and where the curve leaves 0…1.
pub(crate) fn exact(surface: &Surface, chain: &Chain, origin: Origin) -> Option<Curve> {
    let curve = rational(&chain.to_curve().ok()?)?;
    let parts = surface.parts();
    let turn = |b: DVec4| if parts.flipped { DVec4::new(b.x, b.w - b.y, b.z, b.w) } else { b };
    let pieces: Vec<Bezier> = curve.beziers().into_iter().map(|b| Bezier { poles: b.poles.into_iter().map(turn).collect(), ..b }).collect();
    let leaves = |b: &DVec4| {
        let p = projected(*b);
        p.x.min(p.y) < -EPSILON || p.x.max(p.y) > 1.0 + EPSILON
    };
    if surface.domain() != Domain::Unbounded && pieces.iter().flat_map(|b| &b.poles).any(leaves) {
        return None;
    }
    let made = match &parts.shape {
        Shape::Plane(frame) => pieces.iter().map(|b| over_plane(frame, b)).collect(),
        Shape::Nurbs(net) => over_net(net, pieces)?,
        _ => return None,
    };
    Some(Curve::new(CurveShape::Nurbs(Arc::new(Nurbs::joined(&made))), Kind::Project, origin))
}

/// The rational form of a curve that has an exact one.
pub(crate) fn rational(curve: &Curve) -> Option<Nurbs> {
    match curve.shape() {
        CurveShape::Line(a, b) => Some(Nurbs::line(*a, *b)),
        CurveShape::Arc(arc) => Some(arc.to_nurbs()),
        CurveShape::Nurbs(c) => Some(c.as_ref().clone()),
        CurveShape::Composite(c) => Some(Nurbs::joined(&c.pieces.iter().map(rational).collect::<Option<Vec<_>>>()?)),
        CurveShape::Helix(_) | CurveShape::Offset(_) => None,
    }
}

fn over_plane(frame: &Frame, piece: &Bezier) -> Nurbs {
    let at = |b: &DVec4| (frame.origin * b.w + frame.eu * b.x + frame.ev * b.y).extend(b.w);
    Nurbs::bezier(piece.t0, piece.t1, piece.poles.iter().map(at).collect())
}

fn over_net(net: &NurbsSurface, pieces: Vec<Bezier>) -> Option<Vec<Nurbs>> {
    let degree = pieces.first()?.poles.len() - 1;
    if degree * (net.degree.0 + net.degree.1) > COMMON_DEGREE {
        return None;
    }
    let mut parted = pieces;
    for (knots, along_u) in [(&net.knots.0, true), (&net.knots.1, false)] {
        let mut inner: Vec<f64> = knots.iter().copied().filter(|k| *k > 0.0 && *k < 1.0).collect();
        inner.dedup();
        for knot in inner {
            parted = parted.into_iter().flat_map(|piece| cut(piece, knot, along_u)).collect();
        }
        if parted.len() > MOST_PIECES {
            return None;
        }
    }
    let patches = Patches::of(net);
    Some(parted.iter().map(|piece| patches.over(piece)).collect())
}

/// Parameters at which u (or v) of a piece is a number, ascending; none of a piece that is all there.
pub(super) fn where_it_is(piece: &Bezier, knot: f64, along_u: bool) -> Vec<f64> {
    let off = |b: &DVec4| if along_u { b.x - knot * b.w } else { b.y - knot * b.w };
    let (mut cuts, mut open): (Vec<(f64, f64)>, _) = (Vec::new(), vec![(piece.clone(), 0)]);
    while let Some((part, halved)) = open.pop() {
        let (low, high) = part.poles.iter().map(off).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if low > EPSILON || high < -EPSILON || (low >= -EPSILON && high <= EPSILON && halved == 0) {
            continue;
        }
        if halved == HALVINGS || high - low <= EPSILON {
            // Neighbours that are both on the knot are one place: a curve that crosses it slowly is on it for a while.
            match cuts.last_mut() {
                Some(last) if part.t0 <= last.1 => last.1 = part.t1,
                _ => cuts.push((part.t0, part.t1)),
            }
            continue;
        }
        let (left, right) = part.halves();
        open.extend([(right, halved + 1), (left, halved + 1)]);
    }
    cuts.iter().map(|c| 0.5 * (c.0 + c.1)).collect()
}

/// A piece cut where u (or v) is a knot.
fn cut(piece: Bezier, knot: f64, along_u: bool) -> Vec<Bezier> {
    let cuts = where_it_is(&piece, knot, along_u);
    let room = EPSILON * (piece.t1 - piece.t0).max(piece.t1.abs());
    let mut found = Vec::new();
    let mut rest = Nurbs::bezier(piece.t0, piece.t1, piece.poles.clone());
    for at in cuts {
        let (a, b) = rest.domain();
        if at - a > room && b - at > room {
            found.extend(rest.part(a, at).beziers());
            rest = rest.part(at, b);
        }
    }
    found.extend(rest.beziers());
    found
}

/// The Bézier patches of a net, with their ends in u and v.
struct Patches {
    us: Vec<f64>,
    vs: Vec<f64>,
    /// Poles of patch (i, j), u fastest, at i + j · patches along u.
    poles: Vec<Vec<DVec4>>,
    degree: (usize, usize),
}

impl Patches {
    fn of(net: &NurbsSurface) -> Self {
        let (p, q) = net.degree;
        let row = |j: usize| Nurbs::new(p, net.knots.0.clone(), net.poles[j * net.counts.0..(j + 1) * net.counts.0].to_vec()).beziers();
        let rows: Vec<Vec<Bezier>> = (0..net.counts.1).map(row).collect();
        let column = |i: usize, k: usize| Nurbs::new(q, net.knots.1.clone(), rows.iter().map(|r| r[i].poles[k]).collect()).beziers();
        let columns: Vec<Vec<Vec<Bezier>>> = (0..rows[0].len()).map(|i| (0..=p).map(|k| column(i, k)).collect()).collect();
        let ends = |all: &[Bezier]| all.iter().map(|b| b.t0).chain(all.last().map(|b| b.t1)).collect::<Vec<f64>>();
        let (us, vs) = (ends(&rows[0]), ends(&columns[0][0]));
        let patch = |(j, i): (usize, usize)| (0..=q).flat_map(|l| columns[i].iter().map(move |c| c[j].poles[l])).collect();
        let poles = (0..vs.len() - 1).flat_map(|j| (0..us.len() - 1).map(move |i| (j, i))).map(patch).collect();
        Self { us, vs, poles, degree: net.degree }
    }

    /// A piece that lies over one patch, put into it.
    fn over(&self, piece: &Bezier) -> Nurbs {
        let middle = Nurbs::bezier(piece.t0, piece.t1, piece.poles.clone()).jet(0.5 * (piece.t0 + piece.t1)).p;
        let span = |ends: &[f64], x: f64| ends[1..ends.len() - 1].partition_point(|k| *k <= x);
        let (i, j) = (span(&self.us, middle.x), span(&self.vs, middle.y));
        let shares = |ends: &[f64], k: usize, x: &dyn Fn(&DVec4) -> f64| -> [Vec<f64>; 2] {
            let (a, b) = (ends[k], ends[k + 1]);
            let share = |w: &DVec4| (x(w) - a * w.w) / (b - a);
            let far: Vec<f64> = piece.poles.iter().map(share).collect();
            [piece.poles.iter().zip(&far).map(|(b, s)| b.w - s).collect(), far]
        };
        let (along_u, along_v) = (shares(&self.us, i, &|b| b.x), shares(&self.vs, j, &|b| b.y));
        let poles = &self.poles[i + j * (self.us.len() - 1)];
        let rows: Vec<Vec<DVec4>> =
            poles.chunks(self.degree.0 + 1).map(|row| casteljau(row.iter().map(|b| vec![*b]).collect(), &along_u)).collect();
        Nurbs::bezier(piece.t0, piece.t1, casteljau(rows, &along_v))
    }
}

/// De Casteljau's steps over polynomials: Σ Bᵢ(s) bᵢ with 1 − s and s given as polynomials.
fn casteljau(mut b: Vec<Vec<DVec4>>, [near, far]: &[Vec<f64>; 2]) -> Vec<DVec4> {
    while b.len() > 1 {
        let step = |w: &[Vec<DVec4>]| product(near, &w[0]).into_iter().zip(product(far, &w[1])).map(|(x, y)| x + y).collect();
        b = b.windows(2).map(step).collect();
    }
    b.pop().unwrap_or_default()
}

/// The product of two polynomials in Bernstein form.
fn product(f: &[f64], g: &[DVec4]) -> Vec<DVec4> {
    let (m, n) = (f.len() - 1, g.len() - 1);
    let mut made = vec![DVec4::ZERO; m + n + 1];
    for (i, x) in f.iter().enumerate() {
        for (j, y) in g.iter().enumerate() {
            made[i + j] += *y * (x * binomial(m, i) * binomial(n, j) / binomial(m + n, i + j));
        }
    }
    made
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::base::tolerance::Tolerance;
    use crate::geometry::construct::build;
    use crate::surface::core::plane;
    use crate::surface::points::control_net::{Net, bezier, nurbs};

    fn wave(i: usize, j: usize) -> DVec3 {
        let (x, y) = (i as f64, j as f64);
        DVec3::new(x, y + 0.1 * x, ((7 * i + 3 * j) % 5) as f64 * 0.4)
    }

    fn rows(nu: usize, nv: usize) -> Vec<Vec<DVec3>> {
        (0..nv).map(|j| (0..nu).map(|i| wave(i, j)).collect()).collect()
    }

    /// Each point of the curve of space lies over the point of the curve in (u, v) with its parameter, flipped or not.
    #[test]
    fn curves_over_nets_and_planes_are_exact() {
        let tolerance = Tolerance::new(1e-6, 1.0);
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let curves = [
            build::line(at(0.1, 0.2), at(0.93, 0.71), Origin::NONE).unwrap(),
            build::line(at(0.0, 0.5), at(1.0, 0.5), Origin::NONE).unwrap(),
            build::bezier(&[at(0.1, 0.1), at(0.9, 0.0), at(0.2, 0.95)], None, Origin::NONE).unwrap(),
            build::circle(at(0.5, 0.45), 0.4, DVec3::Z, Origin::NONE).unwrap(),
            build::polyline(&[at(0.2, 0.2), at(0.8, 0.3), at(0.5, 1.0)], true, Origin::NONE).unwrap(),
        ];
        let weights: Vec<Vec<f64>> = (0..3).map(|j| (0..3).map(|i| 1.0 + 0.2 * ((i + 2 * j) % 3) as f64).collect()).collect();
        let (few, many) = (rows(3, 3), rows(5, 4));
        let knots = ([0.0, 0.0, 0.0, 0.3, 0.5, 1.0, 1.0, 1.0], [0.0, 0.0, 0.5, 0.8, 1.0, 1.0]);
        let surfaces = [
            (plane::unbounded(wave(1, 2), DVec3::new(1.0, 2.0, 3.0), Origin::NONE).unwrap(), 5),
            (bezier(&Net { rows: &few, weights: None }, Origin::NONE, &tolerance).unwrap(), 5),
            (bezier(&Net { rows: &few, weights: Some(&weights) }, Origin::NONE, &tolerance).unwrap(), 5),
            (nurbs(&Net { rows: &many, weights: None }, (2, 1), (Some(&knots.0), Some(&knots.1)), Origin::NONE, &tolerance).unwrap(), 5),
            // Six times two is a degree too high for the parabola and the circle.
            (bezier(&Net { rows: &rows(4, 4), weights: None }, Origin::NONE, &tolerance).unwrap(), 3),
        ];
        for (surface, wanted) in surfaces {
            for surface in [surface.flipped(), surface] {
                let mut found = 0;
                for curve in &curves {
                    let chain = Chain::of_curve(curve);
                    let Some(made) = exact(&surface, &chain, Origin::NONE) else { continue };
                    found += 1;
                    let flat = rational(curve).unwrap();
                    let CurveShape::Nurbs(made) = made.shape() else { panic!("a net makes a net") };
                    let ((a, b), (c, d)) = (flat.domain(), made.domain());
                    assert!((d - c - (b - a)).abs() < 1e-12);
                    for k in 0..=64 {
                        let share = f64::from(k) / 64.0;
                        let uv = flat.jet(a + (b - a) * share).p;
                        let off = surface.point(uv.x, uv.y).distance(made.jet(c + (d - c) * share).p);
                        assert!(off < 2e-14 * 5.0, "{off:e} at {share} over {:?}", surface.kind());
                    }
                }
                assert_eq!(found, wanted);
            }
        }
    }
}
