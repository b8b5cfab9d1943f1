//! Blending functions in powers.

use crate::base::math;
use crate::surface::data::one_sided::OneSided;
use crate::surface::shapes::polynomial_pieces::{MOST_POWERS, powers_of};
use crate::surface::shapes::weights::BlendAxis;

/// Blending functions of one direction in powers, cell by cell.
#[derive(Debug)]
pub(super) struct AxisPowers {
    pub ends: Vec<f64>,
    /// For each cell the terms that take part with their coefficients.
    pub terms: Vec<Vec<(usize, Vec<f64>)>>,
}

impl AxisPowers {
    /// `None` of polynomials through too many nodes.
    pub fn new(axis: &BlendAxis) -> Option<Self> {
        let nodes = if axis.is_piecewise() { 4 } else { axis.nodes.len() };
        if nodes > MOST_POWERS {
            return None;
        }
        let ends = if axis.is_piecewise() { axis.nodes.clone() } else { vec![0.0, 1.0] };
        let places: Vec<f64> = (0..nodes).map(|k| -math::cos(std::f64::consts::PI * (k as f64 + 0.5) / nodes as f64)).collect();
        let to_powers = powers_of(&places);
        let cell = |w: &[f64]| {
            let at = |s: &f64| axis.weights(w[0] + 0.5 * (w[1] - w[0]) * (s + 1.0), OneSided::After);
            let all: Vec<_> = places.iter().map(at).collect();
            let one = |k: usize| {
                let powers = to_powers.iter().map(|row| row.iter().zip(&all).map(|(by, w)| by * w.values()[k][0]).sum()).collect();
                (all[0].term(k), powers)
            };
            (0..all[0].values().len()).map(one).collect::<Vec<(usize, Vec<f64>)>>()
        };
        Some(Self { terms: ends.windows(2).map(cell).collect(), ends })
    }
}
