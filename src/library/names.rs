//! How things made in Rust are called in messages: each has an origin of its own, and names are found by it.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::DVec3;

use crate::base::fault::Say;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::lang::values::places::place_texts;
use crate::lang::values::units::{LengthUnit, MILLIMETRE, angle_text, number_text, told_length};

/// Those of scripts are small numbers, counted from 1.
const FIRST: u32 = 1 << 31;

/// An origin that nothing else has.
pub fn fresh() -> Origin {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    Origin(FIRST | NEXT.fetch_add(1, Ordering::Relaxed))
}

/// Names of curves and surfaces by their origins.
#[derive(Clone, Debug, Default)]
pub struct Names(BTreeMap<Origin, Arc<str>>);

impl Names {
    /// Adds a name; one that is there stays, and an empty one is none.
    pub fn add(&mut self, origin: Origin, name: &str) {
        if !name.is_empty() {
            self.0.entry(origin).or_insert_with(|| name.into());
        }
    }

    /// The name; empty where there is none.
    pub fn of(&self, origin: Origin) -> String {
        self.0.get(&origin).map_or_else(String::new, |name| name.to_string())
    }
}

/// Speaks of things by their names, and of lengths in a unit.
pub struct Speaker<'a> {
    /// The names.
    pub names: &'a Names,
    /// The unit of coordinates; `None` where none is known: bare numbers.
    pub unit: Option<LengthUnit>,
    /// How finely places are printed.
    pub tolerance: Option<Tolerance>,
}

impl Say for Speaker<'_> {
    fn name(&self, origin: Origin) -> String {
        self.names.of(origin)
    }

    fn length(&self, length: f64) -> String {
        match self.unit {
            Some(unit) => {
                let (text, unit) = told_length(length, unit);
                format!("{text} {}", unit.name)
            }
            None => number_text(length),
        }
    }

    fn points(&self, places: &[DVec3]) -> Vec<String> {
        match self.unit {
            Some(unit) => place_texts(places, self.tolerance, unit),
            None => places.iter().map(|p| format!("({}, {}, {})", number_text(p.x), number_text(p.y), number_text(p.z))).collect(),
        }
    }

    fn angle(&self, radians: f64) -> String {
        angle_text(radians)
    }
}

/// The unit of a model that states none.
pub const DEFAULT_UNIT: LengthUnit = MILLIMETRE;
