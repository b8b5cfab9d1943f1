//! How fair the curves are that a surface is made through.

use crate::surface::core::surface::Surface;
use crate::surface::data::bends::{bending, inflections, largest_curvature};

/// How fair one of the curves is that a surface is made through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StationFairness {
    /// Its u, or v of a section of a skin.
    pub at: f64,
    /// Whether it is one of the curves that were given.
    pub given: bool,
    /// How often it begins to bend the other way.
    pub inflections: usize,
    /// The least radius of its bends, model units; infinite where it is straight.
    pub radius: f64,
    /// ∫κ² ds times its length, over the larger of those of the given curves on either side; 1 for a given one, infinite
    /// where it bends and they do not.
    pub bending: f64,
}

impl Surface {
    /// How fair the curves along v that it is made through are, by ascending u, or the sections of a skin, by ascending v; none where it is
    /// not made through curves.
    pub fn fairness(&self) -> Vec<StationFairness> {
        let stations = self.stations();
        let given: Vec<bool> = stations.iter().map(|s| self.chains().iter().any(|c| c.origin() == s.origin())).collect();
        let bends: Vec<f64> = stations.iter().map(|s| bending(s) * s.length()).collect();
        let places = self.net_curves();
        let row = |k: usize| {
            let around = [(0..=k).rev().find(|k| given[*k]), (k..given.len()).find(|k| given[*k])];
            let most = around.into_iter().flatten().map(|k| bends[k]).fold(0.0, f64::max);
            // Straight ones are as fair as straight ones.
            let ratio = if bends[k] == most { 1.0 } else { bends[k] / most };
            StationFairness {
                at: places.get(k).map_or(0.0, |place| place.at),
                given: given[k],
                inflections: inflections(&stations[k]).len(),
                radius: largest_curvature(&stations[k]).recip(),
                bending: if given[k] { 1.0 } else { ratio },
            }
        };
        (0..stations.len()).map(row).collect()
    }
}
