//! How far a swept surface lies from the sections that its law asks for between its stations.

use glam::DVec3;

use crate::base::tolerance::Tolerance;
use crate::surface::closest::foot::foot;
use crate::surface::core::surface::Surface;
use crate::surface::rails::reparam::{Map, Reparam};
use crate::surface::swept::sweep_net::SweepNet;

/// A surface keeps its law to this share of the length of the section that the law asks for.
pub const SHARE: f64 = 1.0 / 131_072.0;

/// Places at which a section is compared, between two of its breaks.
const PLACES: usize = 4;

/// Where a surface is off its law.
#[derive(Default)]
pub struct Missed {
    /// Fractions of the main guide half way between stations where it is off by more than [`SHARE`].
    pub fractions: Vec<f64>,
    /// The place with the largest distance as a share of the section's length.
    pub worst: Miss,
}

/// A point of a section that the law asks for, off the surface.
#[derive(Clone, Copy, Default)]
pub struct Miss {
    /// The point of the section.
    pub at: DVec3,
    /// Its distance from the surface.
    pub off: f64,
    /// The same as a share of the section's length.
    pub share: f64,
}

/// Compares a surface with the sections half way between its stations.
pub fn missed(surface: &Surface, net: &SweepNet, tolerance: &Tolerance) -> Missed {
    let mut missed = Missed::default();
    for rib in &net.halfway {
        let map = Map::new(net.breaks.clone(), rib.breaks.clone(), Reparam::Smooth, net.closed.1);
        let inner = |w: &[f64]| (0..PLACES).map(|k| w[0] + (w[1] - w[0]) * k as f64 / PLACES as f64).collect::<Vec<_>>();
        let places = net.breaks.windows(2).flat_map(inner).chain([1.0]);
        let off = |v: f64| {
            let p = rib.chain.point(map.value(v));
            (foot(surface.evaluator(), p, (rib.w, v).into()).1, p)
        };
        let (off, at) = places.map(off).fold((0.0, rib.chain.start()), |most, next| if next.0 > most.0 { next } else { most });
        let length = rib.chain.length();
        if off > tolerance.point && off > SHARE * length {
            missed.fractions.push(rib.w);
            if off / length > missed.worst.share {
                missed.worst = Miss { at, off, share: off / length };
            }
        }
    }
    missed
}
