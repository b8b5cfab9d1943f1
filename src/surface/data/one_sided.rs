//! From which side a value is approached.

/// From which side a value is approached where derivatives jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OneSided {
    /// The piece that follows (at the last parameter the one before).
    After,
    /// The piece before (at the first parameter the one that follows).
    Before,
}

impl OneSided {
    /// The other side.
    pub fn turned(self) -> Self {
        if self == Self::After { Self::Before } else { Self::After }
    }
}
