//! How curves are blended across one direction.

/// How curves are blended across one direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// 1 − ξ and ξ between the two neighbours [Coons 1967]: local, continuous.
    Linear,
    /// 3ξ² − 2ξ³ between the two neighbours [Koh & Park 1990, eq. 4.3–4.5]: C1, local.
    Cubic,
    /// The Lagrange polynomial through all of them [Koh & Park 1990, eq. 4.1]; with two curves linear.
    Lagrange,
    /// Cubic splines through all of them, C2, not a knot at the ends (Gordon).
    Spline,
    /// Cubic splines through all of them, C2 across the seam too: the last curve is the first one.
    Periodic,
    /// 3ξ² − 2ξ³ between the two neighbours, and the two cubics of slopes for twists at the nodes: C1, local (`hermite`).
    Hermite,
}

impl Rule {
    /// Its word in the language; none for blends through all curves.
    pub fn name(self) -> Option<&'static str> {
        match self {
            Self::Linear => Some("linear"),
            Self::Cubic => Some("cubic"),
            Self::Lagrange | Self::Spline | Self::Periodic | Self::Hermite => None,
        }
    }

    /// Whether terms are curves and slopes.
    pub(super) fn has_slopes(self) -> bool {
        matches!(self, Self::Spline | Self::Periodic | Self::Hermite)
    }
}

crate::content_of_word!(Rule);
