//! A line of constant u or v on a blend of curves, made ready: what the curves across it give is summed once.
//!
//! At a node the blending values of all other curves are 0, so a point costs one curve however many the blend is made of.

use glam::DVec3;

use crate::geometry::Jet;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::blend_terms::{Terms, all_terms};

/// A line of a blend under the parameter along it.
#[derive(Clone, Debug)]
pub(crate) struct BlendLine {
    /// Whether u runs along it.
    along_u: bool,
    /// Terms of the curves along it with their blending values, those that are not 0.
    own: Vec<(usize, f64)>,
    /// Where the curves across meet it, less the nodes, by terms.
    across: Vec<DVec3>,
}

impl BlendLine {
    /// The line along u (`along_u`) or along v at a place of the other parameter.
    pub(crate) fn new(blend: &Blend, along_u: bool, at: f64, side: OneSided) -> Self {
        let (u, v) = blend.axes();
        let weights = if along_u { v.weights(at, side) } else { u.weights(at, side) };
        let own = weights.iter().map(|(term, w)| (term, w[0])).filter(|(_, by)| *by != 0.0).collect();
        let (axis, curves) = if along_u { (u, blend.along_v()) } else { (v, blend.along_u()) };
        let rows = curves.iter().map(|curve| vec![curve.jet(at, side)]).collect();
        let mut across = Vec::with_capacity(axis.terms());
        for (term, row) in all_terms(axis, rows).into_iter().enumerate() {
            let mut sum: Jet = row[0];
            if along_u {
                blend.less_nodes(term, &weights, &mut sum);
            }
            across.push(sum.p);
        }
        Self { along_u, own, across }
    }

    /// Point and derivative along the line, from the given side where it jumps.
    pub(crate) fn jet(&self, blend: &Blend, x: f64, side: OneSided) -> (DVec3, DVec3) {
        let (u, v) = blend.axes();
        let weights = if self.along_u { u.weights(x, side) } else { v.weights(x, side) };
        let mut sum = (DVec3::ZERO, DVec3::ZERO);
        let crossing = |sum: &mut (DVec3, DVec3)| {
            for (term, w) in weights.iter().take_while(|_| !self.across.is_empty()) {
                sum.0 += self.across[term] * w[0];
                sum.1 += self.across[term] * w[1];
            }
        };
        let add = |sum: &mut (DVec3, DVec3), jet: &Jet, by: f64| {
            sum.0 += jet.p * by;
            sum.1 += jet.d1 * by;
        };
        // In the order of [`Blend::jet`], so that both are the same number.
        if self.along_u {
            crossing(&mut sum);
            self.own.iter().for_each(|(term, by)| add(&mut sum, &own_curve(blend.along_u(), v.slopes(), *term, x, side), *by));
        } else {
            for (term, by) in self.own.iter().take_while(|_| !blend.along_v().is_empty()) {
                let mut curve = own_curve(blend.along_v(), u.slopes(), *term, x, side);
                blend.less_nodes(*term, &weights, &mut curve);
                add(&mut sum, &curve, *by);
            }
            crossing(&mut sum);
        }
        sum
    }
}

/// The curve or the slope across the curves that a term stands for.
fn own_curve(curves: &[Rail], slopes: &[Vec<f64>], term: usize, x: f64, side: OneSided) -> Jet {
    let Some(slope) = term.checked_sub(curves.len()) else { return curves[term].jet(x, side) };
    let mut sum = Jet::default();
    for (curve, by) in curves.iter().zip(&slopes[slope]).filter(|(_, by)| **by != 0.0) {
        curve.jet(x, side).add_times(*by, &mut sum);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;
    use crate::surface::shapes::rule::Rule;
    use crate::surface::shapes::spline_parts::Joins;
    use crate::surface::shapes::weights::BlendAxis;

    fn wave(u: f64, v: f64) -> DVec3 {
        DVec3::new(u + 0.1 * math::sin(3.0 * v), v, math::sin(2.0 * u) * math::cos(1.5 * v))
    }

    #[test]
    fn lines_give_the_numbers_of_the_blend() {
        let (us, vs) = ([0.0, 0.2, 0.55, 0.8, 1.0], [0.0, 0.4, 0.7, 1.0]);
        let joints = || vec![(1, Joins::Corner)];
        for rule in [Rule::Linear, Rule::Cubic, Rule::Spline, Rule::Hermite, Rule::Lagrange] {
            for ruled in [false, true] {
                let rail = |at: f64, along_u: bool| Rail::Formula { f: wave, at, along_u };
                let along_v = us.iter().filter(|_| !ruled).map(|at| rail(*at, false)).collect();
                let along_u = vs.iter().map(|at| rail(*at, true)).collect();
                let (u, v) = (BlendAxis::with_joints(us.to_vec(), rule, joints()), BlendAxis::with_joints(vs.to_vec(), rule, joints()));
                let blend = Blend::new(u, v, along_v, along_u);
                let sides = [OneSided::After, OneSided::Before];
                for (at, x) in [(0.0, 0.3), (0.2, 0.55), (0.4, 0.4), (0.37, 0.9), (1.0, 1.0), (0.7, 0.0)] {
                    for (across, side) in sides.iter().flat_map(|a| sides.iter().map(move |b| (*a, *b))) {
                        let whole = blend.jet(x, at, (side, across));
                        assert_eq!(BlendLine::new(&blend, true, at, across).jet(&blend, x, side), (whole.p, whole.du), "{rule:?} {at} {x}");
                        let whole = blend.jet(at, x, (across, side));
                        assert_eq!(
                            BlendLine::new(&blend, false, at, across).jet(&blend, x, side),
                            (whole.p, whole.dv),
                            "{rule:?} {at} {x}"
                        );
                    }
                }
            }
        }
    }
}
