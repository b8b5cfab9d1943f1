//! Curvature combs: teeth that stand on curves away from the centre of curvature, as long as the curvature is large.

use glam::DVec3;

use super::scene::{Kind, Line};
use crate::base::tolerance::Tolerance;
use crate::network::Chain;

/// Teeth of a smooth piece of a curve.
const TEETH: usize = 48;
/// Length of the longest tooth as a share of the size of what is drawn.
const LONGEST: f64 = 0.12;

/// The curvature vectors along the smooth pieces of a curve, 1/model unit, with their places.
fn pieces(chain: &Chain, tolerance: &Tolerance) -> Vec<Vec<(DVec3, DVec3)>> {
    let mut corners: Vec<f64> = chain.joints().iter().copied().chain(chain.kinks(tolerance)).collect();
    corners.sort_by(f64::total_cmp);
    corners.dedup();
    let tooth = |w: &[f64], k: usize| {
        let f = w[0] + (w[1] - w[0]) * k as f64 / TEETH as f64;
        // At the end of a piece what lies before it is meant.
        let jet = if k == TEETH { chain.jet_before(w[1]) } else { chain.jet(f) };
        let speed = jet.d1.length_squared();
        let along = if speed > 0.0 { jet.d1 * (jet.d2.dot(jet.d1) / speed) } else { jet.d2 };
        let bend = if speed > 0.0 { (jet.d2 - along) / speed } else { DVec3::ZERO };
        (jet.p, bend)
    };
    corners.windows(2).map(|w| (0..=TEETH).map(|k| tooth(w, k)).collect()).collect()
}

/// Combs of some curves at one scale, and the curvature of the longest tooth, 1/model unit; `size` is that of what is drawn. Straight curves have none.
pub fn combs(chains: &[&Chain], size: f64, tolerance: &Tolerance) -> (Vec<Line>, f64) {
    let all: Vec<Vec<(DVec3, DVec3)>> = chains.iter().flat_map(|chain| pieces(chain, tolerance)).collect();
    let largest = |piece: &[(DVec3, DVec3)]| piece.iter().map(|(_, bend)| bend.length()).filter(|k| k.is_finite()).fold(0.0, f64::max);
    // Curvature that turns a curve by less than the tolerance of angles is rounding.
    let bent: Vec<&Vec<(DVec3, DVec3)>> = all.iter().filter(|piece| largest(piece) * size > tolerance.angle).collect();
    let most = bent.iter().map(|piece| largest(piece)).fold(0.0, f64::max);
    if bent.is_empty() {
        return (Vec::new(), 0.0);
    }
    let scale = LONGEST * size / most;
    let mut lines = Vec::new();
    for piece in bent {
        let teeth = || piece.iter().filter(|(_, bend)| bend.is_finite());
        let tips: Vec<DVec3> = teeth().map(|(p, bend)| *p - *bend * scale).collect();
        lines.extend(teeth().zip(&tips).map(|((p, _), tip)| Line { kind: Kind::Comb, points: vec![*p, *tip] }));
        lines.push(Line { kind: Kind::Comb, points: tips });
    }
    (lines, most)
}
