//! What lies along the sides of a surface.

use glam::DVec3;

use crate::base::digest::{StableHash, StableHasher};
use crate::base::fault::Result;
use crate::base::tolerance::Tolerance;
use crate::geometry::Motion;
use crate::network::Chain;
use crate::surface::rails::reparam::Map;

/// What lies along one side of the domain.
#[derive(Clone, Debug)]
pub enum Side {
    /// A chain, from the fraction at the side's lower corner to the one at its upper corner (`from > to`: the chain runs against the side).
    Chain {
        /// The modeling curve.
        chain: Chain,
        /// Fraction where the side begins (u or v ascending).
        from: f64,
        /// Fraction where it ends.
        to: f64,
    },
    /// The side is one point.
    Pole(DVec3),
    /// The side is joined to the opposite one and no chain runs along it (closed surface).
    Seam,
    /// A free border without a chain.
    Free,
}

/// A side with the map from its parameter to the chain's fraction (`None`: straight from `from` to `to`).
#[derive(Clone, Debug)]
pub(crate) struct Border {
    pub side: Side,
    pub map: Option<Map>,
    /// The side runs against the map's parameter.
    pub turned: bool,
}

impl Border {
    /// A side whose chain is run from one fraction to another in proportion.
    pub fn straight(side: Side) -> Self {
        Self { side, map: None, turned: false }
    }

    /// The whole chain along the side, forwards or backwards.
    pub fn chain(chain: Chain, reversed: bool) -> Self {
        let (from, to) = if reversed { (1.0, 0.0) } else { (0.0, 1.0) };
        Self::straight(Side::Chain { chain, from, to })
    }

    pub fn turned(&self) -> Self {
        let side = match &self.side {
            Side::Chain { chain, from, to } => Side::Chain { chain: chain.clone(), from: *to, to: *from },
            other => other.clone(),
        };
        Self { side, map: self.map.clone(), turned: !self.turned }
    }

    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        let side = match &self.side {
            Side::Chain { chain, from, to } => Side::Chain { chain: chain.moved(motion), from: *from, to: *to },
            Side::Pole(p) => Side::Pole(motion.point(*p)),
            other => other.clone(),
        };
        Self { side, map: self.map.clone(), turned: self.turned }
    }
}

crate::content!(Border { side, map, turned });

impl StableHash for Side {
    fn hash_into(&self, to: &mut StableHasher) {
        match self {
            Self::Chain { chain, from, to: end } => (0u8, (chain, *from, *end)).hash_into(to),
            Self::Pole(p) => (1u8, *p).hash_into(to),
            Self::Seam => 2u8.hash_into(to),
            Self::Free => 3u8.hash_into(to),
        }
    }
}

/// A part of a chain between two fractions, in the direction from the first to the second.
pub(crate) fn between(chain: &Chain, from: f64, to: f64, tolerance: &Tolerance) -> Result<Chain> {
    let (chain, from, to) = if from > to { (chain.reversed(), 1.0 - from, 1.0 - to) } else { (chain.clone(), from, to) };
    if from <= 0.0 && to >= 1.0 { Ok(chain) } else { chain.slice(from, to, tolerance) }
}
