//! How fair the curves are that a surface is made through.

use crate::surface::core::surface::Surface;
use crate::surface::data::bends::{bending, inflections, least_radius};

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
    /// ∫κ² ds times its length, over the larger of those of the given curves on either side; 1 for a given one.
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
            let ratio = if most > 0.0 { bends[k] / most } else { f64::from(u8::from(bends[k] > 0.0)) };
            StationFairness {
                at: places.get(k).map_or(0.0, |place| place.at),
                given: given[k],
                inflections: inflections(&stations[k]).len(),
                radius: least_radius(&stations[k]),
                bending: if given[k] { 1.0 } else { ratio },
            }
        };
        (0..stations.len()).map(row).collect()
    }
}
