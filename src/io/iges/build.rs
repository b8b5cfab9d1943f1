//! Faces as surface values.

use super::damage::Damage;
use super::faces::{Border, Face};
use super::part::Part;
use crate::base::fault::Malformed;
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::surface::{Surface, trim};

impl Part {
    /// Makes [`Part::built`] of the faces; says which could not be made.
    pub fn build(&mut self, origin: Origin, tolerance: &Tolerance) -> Vec<Malformed> {
        let mut skipped = Vec::new();
        self.built = Vec::with_capacity(self.surfaces.len());
        for item in &self.surfaces {
            job::look();
            self.built.push(match item.value.surface(origin, tolerance) {
                Ok(surface) => Some(surface),
                Err(Damage(why)) => {
                    skipped.push(Malformed::line(item.line, format!("{} at D{}: skipped: {why}", item.name, item.d)));
                    None
                }
            });
        }
        skipped
    }
}

impl Face {
    /// The surface value; borders may be as far off as the file has them.
    pub fn surface(&self, origin: Origin, tolerance: &Tolerance) -> Result<Surface, Damage> {
        let tolerance = Tolerance { point: tolerance.point.max(2.0 * self.gap), ..*tolerance };
        let surface = match (&self.outer, self.holes.as_slice()) {
            (None, []) => self.base.clone(),
            (outer, holes) => {
                let outer = outer.as_deref().map(chains).unwrap_or_default();
                let holes: Vec<Vec<Chain>> = holes.iter().map(|hole| chains(hole)).collect();
                trim(&self.base, &outer, &holes, origin, &tolerance)?
            }
        };
        Ok(if self.flipped { surface.flipped() } else { surface })
    }
}

fn chains(borders: &[Border]) -> Vec<Chain> {
    borders.iter().map(|b| Chain::of_curve(&b.space)).collect()
}
