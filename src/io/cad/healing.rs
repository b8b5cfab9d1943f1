//! What was repaired in a file so that its faces can be used, each with its place and distance.

use glam::DVec3;

use crate::base::text;

/// By which rule something was repaired.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// A border beside its surface was snapped to it.
    Border,
    /// Curves of a border that end apart were joined.
    Ends,
    /// A border closes only within what the file says of its accuracy.
    Accuracy,
}

impl Rule {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Border, Self::Ends, Self::Accuracy];

    /// What was done, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Border => "a border was snapped to its surface",
            Self::Ends => "a gap in a border was closed",
            Self::Accuracy => "the stated accuracy of the file was applied to a border",
        }
    }
}

/// Something that was repaired.
#[derive(Clone, Debug, PartialEq)]
pub struct Repair {
    /// By which rule.
    pub rule: Rule,
    /// Of [`Part::surfaces`](crate::io::cad::part::Part::surfaces).
    pub face: usize,
    /// Its name and number: `entity 144 at D87`.
    pub entity: String,
    /// Line of the file where it stands.
    pub line: u64,
    /// How far things were moved at most, model units.
    pub distance: f64,
    /// Where that was.
    pub place: DVec3,
}

impl Repair {
    /// Rule and distance in words.
    pub fn in_words(&self, unit: &str) -> String {
        let at = [self.place.x, self.place.y, self.place.z].map(|x| text::real((x * 1e3).round() / 1e3)).join(", ");
        format!("{}: {}, by {:.1e} {unit} at ({at})", self.entity, self.rule.words(), self.distance)
    }
}

/// The largest distance by which a face is off, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Off {
    /// Model units.
    pub distance: f64,
    /// Where.
    pub place: DVec3,
    /// What repairs it.
    pub rule: Rule,
}

impl Off {
    /// Off by nothing.
    pub const NONE: Self = Self { distance: 0.0, place: DVec3::ZERO, rule: Rule::Border };

    /// The worse of the two.
    pub fn or(self, distance: f64, place: DVec3, rule: Rule) -> Self {
        if distance > self.distance { Self { distance, place, rule } } else { self }
    }
}
