//! Why one entity cannot be used.

use glam::DVec3;

use crate::base::fault::{Fault, Say};
use crate::base::origin::Origin;
use crate::base::text;

/// What is wrong with an entity, in words; the rest of the file does not suffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Defect(pub String);

/// A defect in these words.
pub fn defect(what: impl Into<String>) -> Defect {
    Defect(what.into())
}

/// Says faults of the kernel in the numbers of the model.
struct Plain;

impl Say for Plain {
    fn name(&self, _: Origin) -> String {
        String::new()
    }

    fn length(&self, length: f64) -> String {
        text::real(length)
    }

    fn points(&self, places: &[DVec3]) -> Vec<String> {
        places.iter().map(|p| format!("({}, {}, {})", text::real(p.x), text::real(p.y), text::real(p.z))).collect()
    }

    fn angle(&self, radians: f64) -> String {
        format!("{}°", text::real(radians.to_degrees()))
    }
}

impl From<Fault> for Defect {
    fn from(fault: Fault) -> Self {
        Self(fault.describe(&Plain).message)
    }
}
