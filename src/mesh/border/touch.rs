//! Faces that touch without sharing nodes.

use glam::DVec3;

/// How two faces touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// They cover each other.
    Overlap,
    /// An edge of the first lies on the second.
    Edge,
    /// They cross.
    Crossing,
    /// The body of the first lies inside that of the second.
    Inside,
    /// They come near each other, and the search of what they have in common found no end.
    Unknown,
}

impl Kind {
    /// Its number in records.
    pub fn word(self) -> u8 {
        self as u8
    }

    /// The kind of a number.
    pub fn of_word(word: u8) -> Option<Self> {
        [Self::Overlap, Self::Edge, Self::Crossing, Self::Inside, Self::Unknown].into_iter().find(|kind| kind.word() == word)
    }
}

/// Two surfaces of a mesh that touch without sharing nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Touch {
    /// How.
    pub kind: Kind,
    /// Their places in the plan.
    pub surfaces: (usize, usize),
    /// Their names.
    pub names: (String, String),
    /// Length of the edges that lie on the other face, model units; 0 where there is none.
    pub length: f64,
    /// In the middle of the longest segment.
    pub at: DVec3,
}
