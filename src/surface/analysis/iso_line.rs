//! A line of constant u or v.

/// A line on a surface along which one parameter is constant; it runs with the other one ascending.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IsoLine {
    /// u is this, v runs.
    U(f64),
    /// v is this, u runs.
    V(f64),
}

impl IsoLine {
    /// (u, v) where the other parameter is `t`.
    pub fn at(self, t: f64) -> (f64, f64) {
        match self {
            Self::U(u) => (u, t),
            Self::V(v) => (t, v),
        }
    }

    /// The constant parameter.
    pub fn value(self) -> f64 {
        match self {
            Self::U(x) | Self::V(x) => x,
        }
    }
}
