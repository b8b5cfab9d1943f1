//! Surfaces made ready for the points nearest to others, kept from call to call: a script asks one point at a time.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::surface::{Nearest, Surface};

/// Surfaces kept at the most.
const SURFACES: usize = 512;
/// Samples kept at the most, beside those of the last surface asked for: 24 bytes each.
const SAMPLES: usize = 1 << 21;

/// The surfaces asked for last, the latest at the back.
#[derive(Debug, Default)]
pub(crate) struct KeptFeet(VecDeque<Arc<Nearest>>);

impl KeptFeet {
    /// The surface ready for many points, as an earlier call left it.
    pub(crate) fn of(&mut self, surface: &Surface) -> Arc<Nearest> {
        let known = self.0.iter().position(|nearest| nearest.surface().is(surface)).and_then(|k| self.0.remove(k));
        let nearest = known.unwrap_or_else(|| Arc::new(Nearest::new(surface)));
        self.0.push_back(nearest.clone());
        let mut samples: usize = self.0.iter().map(|nearest| nearest.samples()).sum();
        while self.0.len() > 1 && (self.0.len() > SURFACES || samples > SAMPLES) {
            samples -= self.0.pop_front().map_or(0, |oldest| oldest.samples());
        }
        nearest
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::base::origin::Origin;
    use crate::surface::core::plane::unbounded;

    #[test]
    fn a_surface_is_made_ready_once_and_the_oldest_is_left() {
        let plane = |z: f64| unbounded(DVec3::Z * z, DVec3::Z, Origin::NONE).unwrap();
        let first = plane(0.0);
        let mut kept = KeptFeet::default();
        let made = kept.of(&first);
        assert!(Arc::ptr_eq(&made, &kept.of(&first.clone())));
        assert!(!Arc::ptr_eq(&made, &kept.of(&plane(0.0))));
        (1..=SURFACES).for_each(|k| drop(kept.of(&plane(k as f64))));
        assert!(kept.0.len() == SURFACES && !Arc::ptr_eq(&made, &kept.of(&first)));
    }
}
