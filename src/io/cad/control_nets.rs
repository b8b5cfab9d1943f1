//! Work on nets of control points: the stretch of knots that counts, borders and poles, and nets between two curves.

use std::sync::Arc;

use glam::{DVec2, DVec3, DVec4};

use crate::base::bbox::Box3;
use crate::base::limits;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::curves::curve::Shape;
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::geometry::{Curve, Kind, Nurbs};
use crate::io::cad::defect::{Defect, defect};
use crate::surface::NurbsSurface;

/// The part of a surface over first and last u, first and last v, with full end knots, over 0…1.
pub fn trimmed_net(net: NurbsSurface, [u0, u1, v0, v1]: [f64; 4]) -> Result<NurbsSurface, Defect> {
    check_knots(&net.knots.0, net.counts.0, net.degree.0)?;
    check_knots(&net.knots.1, net.counts.1, net.degree.1)?;
    let NurbsSurface { degree, knots, mut poles, mut counts } = net;
    let mut knots_u = knots.0;
    if !is_full(&knots_u, degree.0, u0, u1) {
        let rows: Vec<Nurbs> =
            poles.chunks_exact(counts.0).map(|row| Nurbs::new(degree.0, knots_u.clone(), row.to_vec()).part(u0, u1)).collect();
        counts.0 = rows[0].poles.len();
        knots_u = rows[0].knots.clone();
        poles = rows.into_iter().flat_map(|row| row.poles).collect();
    }
    let mut knots_v = knots.1;
    if !is_full(&knots_v, degree.1, v0, v1) {
        let column = |i: usize| -> Vec<DVec4> { (0..counts.1).map(|j| poles[j * counts.0 + i]).collect() };
        let columns: Vec<Nurbs> = (0..counts.0).map(|i| Nurbs::new(degree.1, knots_v.clone(), column(i)).part(v0, v1)).collect();
        counts.1 = columns[0].poles.len();
        knots_v = columns[0].knots.clone();
        poles = (0..counts.1).flat_map(|j| columns.iter().map(move |c| c.poles[j])).collect();
    }
    Ok(NurbsSurface { degree, knots: (unit(&knots_u), unit(&knots_v)), poles, counts })
}

/// A border of a net that is no point.
#[derive(Clone, Debug)]
pub struct NetBorder {
    /// The border in space, by the parameter that runs along it.
    pub curve: Curve,
    /// The box about its control points, which holds it.
    pub hull: Box3,
    /// It runs along v.
    along_v: bool,
    /// The other parameter.
    at: f64,
    /// That parameter ascends where the net is on the left.
    pub ascends: bool,
}

impl NetBorder {
    /// Parameters of the net at one of the curve.
    pub fn at(&self, t: f64) -> DVec2 {
        if self.along_v { DVec2::new(self.at, t) } else { DVec2::new(t, self.at) }
    }
}

/// The borders of a net that are no points.
pub fn borders(net: &NurbsSurface) -> Vec<NetBorder> {
    let (nu, nv) = net.counts;
    let along_u = |j: usize| Nurbs::new(net.degree.0, net.knots.0.clone(), (0..nu).map(|i| net.pole(i, j)).collect());
    let along_v = |i: usize| Nurbs::new(net.degree.1, net.knots.1.clone(), (0..nv).map(|j| net.pole(i, j)).collect());
    let is_pole = |curve: &Nurbs| curve.poles.iter().all(|q| projected(*q) == projected(curve.poles[0]));
    let ends = |knots: &[f64]| (knots[0], knots[knots.len() - 1]);
    let ((u0, u1), (v0, v1)) = (ends(&net.knots.0), ends(&net.knots.1));
    let all = [
        (along_v(0), true, u0, false),
        (along_v(nu - 1), true, u1, true),
        (along_u(0), false, v0, true),
        (along_u(nv - 1), false, v1, false),
    ];
    let curved = all.into_iter().filter(|(curve, ..)| !is_pole(curve));
    let border = |(curve, along_v, at, ascends): (Nurbs, bool, f64, bool)| {
        let hull = Box3::of(curve.poles.iter().map(|q| projected(*q)));
        NetBorder { curve: spline(curve, Origin::NONE), hull, along_v, at, ascends }
    };
    curved.map(border).collect()
}

/// A spline as a curve.
pub fn spline(curve: Nurbs, origin: Origin) -> Curve {
    Curve::new(Shape::Nurbs(Arc::new(curve)), Kind::Spline, origin)
}

/// A border row of a net that was made one point.
#[derive(Clone, Copy, Debug)]
pub struct WholePole {
    /// The point.
    pub at: DVec3,
    /// How far control points were moved at most, model units.
    pub moved: f64,
}

/// The net with each border row whose control points are one point within the tolerance made one point, as other programs know poles:
/// one of these where it is as near.
pub fn with_whole_poles(mut net: NurbsSurface, known: &[DVec3], tolerance: &Tolerance) -> (NurbsSurface, Vec<WholePole>) {
    let (nu, nv) = net.counts;
    let rows: [Vec<usize>; 4] = [
        (0..nu).collect(),
        (0..nu).map(|i| (nv - 1) * nu + i).collect(),
        (0..nv).map(|j| j * nu).collect(),
        (0..nv).map(|j| j * nu + nu - 1).collect(),
    ];
    let mut poles = Vec::new();
    for row in rows {
        let center = Box3::of(row.iter().map(|k| projected(net.poles[*k]))).center();
        let whole = |at: DVec3| WholePole { at, moved: row.iter().map(|k| projected(net.poles[*k]).distance(at)).fold(0.0, f64::max) };
        // Control points of a circle stand on a square round it.
        let is_one = |pole: &WholePole| pole.moved <= std::f64::consts::SQRT_2 * tolerance.point;
        let found = known.iter().map(|at| whole(*at)).find(is_one).or_else(|| Some(whole(center)).filter(is_one));
        if let Some(pole) = found.filter(|pole| pole.moved > 0.0) {
            row.iter().for_each(|k| net.poles[*k] = weighted(pole.at, net.poles[*k].w));
            poles.push(pole);
        }
    }
    (net, poles)
}

/// Whether the knots begin and end with full multiplicity at these parameters.
fn is_full(knots: &[f64], degree: usize, first: f64, last: f64) -> bool {
    knots[..=degree].iter().all(|k| *k == first) && knots[knots.len() - degree - 1..].iter().all(|k| *k == last)
}

/// Knots over 0…1.
fn unit(knots: &[f64]) -> Vec<f64> {
    let (a, b) = (knots[0], knots[knots.len() - 1]);
    knots.iter().map(|k| if *k == b { 1.0 } else { (k - a) / (b - a) }).collect()
}

/// Knots that do not decrease, have a domain and keep the surface in one piece.
fn check_knots(knots: &[f64], points: usize, degree: usize) -> Result<(), Defect> {
    if let Some(k) = knots.windows(2).position(|w| w[1] < w[0]) {
        return Err(defect(format!("knots must not decrease: {} is followed by {}", knots[k], knots[k + 1])));
    }
    if let Some(found) = limits::knot_beyond(knots) {
        return Err(defect(format!("its knots cannot be computed with: one, or a step between two, is {found:e}")));
    }
    let (first, last) = (knots[degree], knots[points]);
    if first >= last {
        return Err(defect("its knots give it no range of parameters"));
    }
    let torn = knots.chunk_by(|a, b| a == b).find(|same| first < same[0] && same[0] < last && same.len() > degree);
    match torn {
        Some(same) => Err(defect(format!("the knot {} occurs {} times, which tears the surface of degree {degree}", same[0], same.len()))),
        None => Ok(()),
    }
}

/// The net between two curves, equal parameters joined; u along them, v from the first to the second.
pub fn ruled_net(a: &Nurbs, b: &Nurbs) -> NurbsSurface {
    let degree = a.degree.max(b.degree);
    let full = |c: &Nurbs| {
        let (first, last) = c.domain();
        c.part(first, last).elevated(degree - c.degree).over(0.0, 1.0)
    };
    let (a, b) = (full(a), full(b));
    let (more_a, more_b) = (missing(&a.knots, &b.knots), missing(&b.knots, &a.knots));
    let (a, b) = (a.refined(&more_a), b.refined(&more_b));
    let n = a.poles.len();
    let poles = a.poles.iter().chain(&b.poles).copied().collect();
    NurbsSurface { degree: (degree, 1), knots: (a.knots, vec![0.0, 0.0, 1.0, 1.0]), poles, counts: (n, 2) }
}

/// Knots that the second list has more often than the first; both ascend.
fn missing(has: &[f64], other: &[f64]) -> Vec<f64> {
    let mut missing = Vec::new();
    let mut k = 0;
    for x in other {
        while has.get(k).is_some_and(|h| h < x) {
            k += 1;
        }
        if has.get(k) == Some(x) {
            k += 1;
        } else {
            missing.push(*x);
        }
    }
    missing
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::surface::OneSided;

    #[test]
    fn a_ruled_net_joins_equal_parameters() {
        let line = Nurbs::line(DVec3::ZERO, DVec3::X);
        let poles = [(0.0, 1.0, 0.0), (0.3, 2.0, 1.0), (0.6, 0.5, 0.0), (1.0, 1.0, 2.0)].map(|(x, y, z)| DVec3::new(x, y, z).extend(1.0));
        let curve = Nurbs::new(2, vec![1.0, 1.0, 1.0, 1.5, 3.0, 3.0, 3.0], poles.to_vec());
        let net = ruled_net(&line, &curve);
        for k in 0..=10 {
            let x = f64::from(k) / 10.0;
            let at = |v: f64| net.jet(x, v, (OneSided::After, OneSided::After)).p;
            assert!(at(0.0).distance(line.jet(x).p) < 1e-15 && at(1.0).distance(curve.jet(1.0 + 2.0 * x).p) < 1e-14);
        }
    }

    #[test]
    fn a_net_is_cut_to_its_range() {
        let knots = vec![-2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0];
        let poles: Vec<_> =
            (0..8).map(|k| DVec3::new(f64::from(k % 4), f64::from(k / 4), f64::from(k * k % 5)).extend(1.0 + f64::from(k % 3))).collect();
        let net = NurbsSurface { degree: (2, 1), knots: (knots.clone(), vec![0.0, 0.0, 2.0, 2.0]), poles: poles.clone(), counts: (4, 2) };
        let cut = trimmed_net(net, [0.25, 1.5, 0.5, 2.0]).expect("a net");
        let rows: Vec<Nurbs> = poles.chunks_exact(4).map(|row| Nurbs::new(2, knots.clone(), row.to_vec())).collect();
        for (u, v) in [(0.0, 0.0), (0.4, 0.3), (0.9, 1.0), (1.0, 0.0)] {
            let found = cut.jet(u, v, (OneSided::After, OneSided::After)).p;
            let share = (0.5 + 1.5 * v) / 2.0;
            let row = |k: usize| rows[k].blossom(rows[k].span(0.25 + 1.25 * u), &[0.25 + 1.25 * u; 2]);
            let q = row(0) * (1.0 - share) + row(1) * share;
            assert!(found.distance(q.truncate() / q.w) < 1e-13, "{u} {v}");
        }
    }
}
