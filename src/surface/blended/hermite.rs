//! Hermite blended Coons patches, and nets of them [Coons 1967; Farin 2002, chapter 22].
//!
//! ```text
//! r₁ = Σ h₀(u) F + Σ h₁(u) ∂u,   r₂ = Σ h₀(v) G + Σ h₁(v) ∂v,   r₃ both of the nodes,   r = r₁ + r₂ − r₃
//! ```
//!
//! in every cell, h₀ the cubics of values and h₁ those of slopes. The derivative across a curve is the cubic of what the crossing curves have
//! at its nodes and of the twists there. Curves run through the nodes in parameters that are C1, in the same u and v on both
//! sides, so both cells at a curve have the same derivatives whatever their widths: the surface is C1. As derivatives of both
//! directions have the same twists they are compatible, and the boundary derivatives are met.

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::flow::Member;
use crate::network::{Chain, Flow};
use crate::surface::blended::coons::{BlendMethod, CoonsSettings, Grid, finish, gridded};
use crate::surface::blended::twists::{self, Twist};
use crate::surface::core::surface::Surface;
use crate::surface::faults::CornerFault;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::Reparam;
use crate::surface::shapes::blend::Blend;

/// The Hermite blended surface over a grid of curves with or without poles, with notes and warnings (N609, W614).
///
/// Fails as [`coons::build`](super::coons::build) does, with E653 where two curves are tangent to each other in a node, with E652 where two
/// neighbouring ones are at a pole.
pub fn build(grid: &Grid, twist: Twist, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let mut notes = Vec::new();
    let settings = CoonsSettings { method: BlendMethod::Hermite, reparam: Reparam::Smooth, origin };
    let (mut blend, made) = gridded(grid, &settings, tolerance, &mut notes)?;
    spanned(&blend, tolerance)?;
    if twist != Twist::Zero {
        let found = twists::at_nodes(&blend, twist, made.closed);
        blend = blend.with_twists(&found);
    }
    Ok((finish(blend, made, tolerance, &mut notes), notes))
}

/// E653 and E652 unless the curves of each node span a plane.
fn spanned(blend: &Blend, tolerance: &Tolerance) -> Result<()> {
    let origin = |rail: &Rail| rail.chain().map_or(Origin::NONE, Chain::origin);
    let (n, m) = (blend.along_v().len(), blend.along_u().len());
    for (i, j) in (0..m - 1).flat_map(|j| (0..n - 1).map(move |i| (i, j))) {
        let cell = twists::cell(blend, i, j);
        for b in [0, 1] {
            if cell.poles[b] {
                if let Some(angle) = parallel(cell.dv[0][b], cell.dv[1][b], tolerance) {
                    let (one, other) = (origin(&blend.along_v()[i]), origin(&blend.along_v()[i + 1]));
                    return Err(CornerFault::PoleParallel { a: one, b: other, at: cell.p[0][b], angle, least: tolerance.angle }.into());
                }
                continue;
            }
            for a in [0, 1] {
                if let Some(angle) = parallel(cell.du[a][b], cell.dv[a][b], tolerance) {
                    let (one, other) = (origin(&blend.along_u()[j + b]), origin(&blend.along_v()[i + a]));
                    return Err(CornerFault::TangentsParallel { a: one, b: other, at: cell.p[a][b], angle, least: tolerance.angle }.into());
                }
            }
        }
    }
    Ok(())
}

/// The angle between two lines that are taken for parallel, radians.
fn parallel(a: DVec3, b: DVec3, tolerance: &Tolerance) -> Option<f64> {
    if a == DVec3::ZERO || b == DVec3::ZERO {
        return None;
    }
    let angle = math::angle_between(a, b);
    let angle = angle.min(std::f64::consts::PI - angle);
    (angle <= tolerance.angle).then_some(angle)
}

/// Of a uniform trilateral the corner whose two sides are nearest to each other in length; of several that are as near the first by
/// coordinates.
pub fn default_pole(chains: &[Chain], flow: &Flow, tolerance: &Tolerance) -> Option<DVec3> {
    let (bottom, left, slant) = (flow.along_u.first()?, flow.along_v.first()?, flow.along_v.get(1)?);
    let end = |side: &Member, k: usize| side.crossings.get(k).copied().unwrap_or(if (k == 1) == side.reversed { 0.0 } else { 1.0 });
    let length = |side: &Member| (end(side, 1) - end(side, 0)).abs() * chains[side.curve].length();
    let corner = |side: &Member, k: usize| tolerance.rounded(chains[side.curve].point(end(side, k)));
    let corners = [(corner(bottom, 0), bottom, left), (corner(bottom, 1), bottom, slant), (corner(left, 1), left, slant)];
    let mut all = corners.map(|(at, a, b)| (at, (length(a) - length(b)).abs()));
    all.sort_by(|a, b| (a.0.x.total_cmp(&b.0.x)).then(a.0.y.total_cmp(&b.0.y)).then(a.0.z.total_cmp(&b.0.z)));
    let least = all.iter().map(|corner| corner.1).fold(f64::INFINITY, f64::min);
    all.iter().find(|corner| corner.1 <= least + tolerance.point).map(|corner| corner.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::data::one_sided::OneSided;
    use crate::surface::shapes::rule::Rule;
    use crate::surface::shapes::weights::BlendAxis;

    type Formula = fn(f64, f64) -> DVec3;

    fn blend(f: Formula, us: &[f64], vs: &[f64], pole: Option<DVec3>) -> Blend {
        let along_v = us.iter().map(|&at| Rail::Formula { f, at, along_u: false }).collect();
        let mut along_u: Vec<Rail> = vs.iter().map(|&at| Rail::Formula { f, at, along_u: true }).collect();
        if let Some(pole) = pole {
            along_u[0] = Rail::Point(pole);
        }
        Blend::new(BlendAxis::new(us.to_vec(), Rule::Cubic), BlendAxis::new(vs.to_vec(), Rule::Cubic), along_v, along_u)
    }

    fn bezier(p: [[f64; 3]; 4], t: f64) -> DVec3 {
        let [a, b, c, d] = p.map(DVec3::from);
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * t * s * s) + c * (3.0 * t * t * s) + d * (t * t * t)
    }

    fn is_near(blend: &Blend, samples: &[(f64, f64, [f64; 3])]) {
        let twisted = blend.clone().with_twists(&vec![DVec3::ZERO; blend.along_v().len() * blend.along_u().len()]);
        for &(u, v, point) in samples {
            for blend in [blend, &twisted] {
                let p = blend.jet(u, v, (OneSided::After, OneSided::After)).p;
                assert!(p.distance(point.into()) < 1e-12, "{u} {v}: {p}");
                let mut grid = [DVec3::ZERO];
                blend.grid(&[u], &[v], &mut grid);
                assert!(grid[0].distance(p) < 4e-15);
            }
        }
    }

    /// Borders of the reference patch, each in the parameter of its Bézier curve.
    fn quad(u: f64, v: f64) -> DVec3 {
        if u == 0.0 {
            return bezier([[0.0; 3], [0.0, 1.0, 0.5], [0.0, 2.0, 0.5], [0.0, 3.0, 0.0]], v);
        }
        if u == 1.0 {
            return bezier([[3.0, 0.0, 0.0], [3.2, 1.0, 1.0], [3.2, 2.0, 1.0], [3.0, 3.0, 0.5]], v);
        }
        if v == 0.0 {
            return bezier([[0.0; 3], [1.0, 0.0, 0.8], [2.0, 0.0, 0.8], [3.0, 0.0, 0.0]], u);
        }
        bezier([[0.0, 3.0, 0.0], [1.0, 3.3, 1.0], [2.0, 3.3, 1.0], [3.0, 3.0, 0.5]], u)
    }

    /// Samples of `hermite_coons.json`.
    #[test]
    fn a_patch_of_four_sides() {
        let blend = blend(quad, &[0.0, 1.0], &[0.0, 1.0], None);
        is_near(
            &blend,
            &[
                (0.5, 0.5, [1.5750000000000002, 1.6124999999999998, 1.175]),
                (0.25, 0.75, [0.767578125, 2.3923828124999997, 0.84375]),
                (0.1, 0.9, [0.30151199999999995, 2.7787320000000006, 0.404352]),
                (0.6, 0.2, [1.862208, 0.6224640000000002, 0.9666240000000001]),
            ],
        );
        let twists = [DVec3::new(1.0, -2.0, 5.0), DVec3::X, DVec3::Y, DVec3::splat(-3.0)];
        for blend in [blend.clone(), blend.with_twists(&twists)] {
            for x in (0..=50).map(|k| f64::from(k) / 50.0) {
                for (u, v) in [(0.0, x), (1.0, x), (x, 0.0), (x, 1.0)] {
                    let p = blend.jet(u, v, (OneSided::After, OneSided::After)).p;
                    assert!((p - quad(u, v)).abs().max_element() <= 4.5e-16 * 3.3, "{u} {v}");
                }
            }
        }
    }

    /// Samples of `hermite_coons.json`: quarter circles as Bézier curves, the side v = 0 a pole.
    #[test]
    fn a_patch_of_three_sides() {
        const K: f64 = 0.5522847498307936;
        let sides: Formula = |u, v| match (u, v) {
            (0.0, _) => bezier([[0.0, 0.0, 1.0], [K, 0.0, 1.0], [1.0, 0.0, K], [1.0, 0.0, 0.0]], v),
            (1.0, _) => bezier([[0.0, 0.0, 1.0], [0.0, K, 1.0], [0.0, 1.0, K], [0.0, 1.0, 0.0]], v),
            _ => bezier([[1.0, 0.0, 0.0], [1.0, K, 0.0], [K, 1.0, 0.0], [0.0, 1.0, 0.0]], u),
        };
        let blend = blend(sides, &[0.0, 1.0], &[0.0, 1.0], Some(DVec3::Z));
        is_near(
            &blend,
            &[
                (0.5, 0.5, [0.4571067811865476, 0.4571067811865476, 0.7071067811865477]),
                (0.25, 0.25, [0.3405607404145676, 0.09722504026089564, 0.9214150429449554]),
                (0.5, 0.9, [0.6947636354360399, 0.6947636354360399, 0.1622051942088828]),
                (0.9, 0.1, [0.008299490875697441, 0.15808097604190624, 0.9869116882454316]),
            ],
        );
        let places: Vec<f64> = (0..=20).map(|k| f64::from(k) / 20.0).collect();
        let mut all = vec![DVec3::ZERO; places.len() * places.len()];
        blend.grid(&places, &places, &mut all);
        let off = all.iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
        assert!((off - 0.04193256040430393).abs() < 1e-12, "{off}");
    }

    /// With the twists of a bicubic surface every cell of an uneven net is that surface.
    #[test]
    fn bicubic_surfaces_are_reproduced_by_their_twists() {
        let f: Formula = |u, v| DVec3::new(u + 0.1 * v * v, v, u * u * u * v * v * v - 2.0 * u * u * v + v * v * v);
        let (us, vs) = ([0.0, 0.15, 1.0], [0.0, 0.6, 0.7, 1.0]);
        let twist = |u: f64, v: f64| DVec3::new(0.0, 0.0, 9.0 * u * u * v * v - 4.0 * u);
        let twists: Vec<DVec3> = vs.iter().flat_map(|&v| us.iter().map(move |&u| twist(u, v))).collect();
        let blend = blend(f, &us, &vs, None).with_twists(&twists);
        assert_eq!(blend.twists(), twists);
        let places: Vec<f64> = (0..=40).map(|k| f64::from(k) / 40.0).collect();
        let mut all = vec![DVec3::ZERO; places.len() * places.len()];
        blend.grid(&places, &places, &mut all);
        for (k, p) in all.iter().enumerate() {
            let (u, v) = (places[k % places.len()], places[k / places.len()]);
            assert!(p.distance(f(u, v)) < 1e-14, "{u} {v}");
            assert!(blend.jet(u, v, (OneSided::Before, OneSided::Before)).p.distance(*p) < 1e-14);
        }
    }
}
