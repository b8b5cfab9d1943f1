//! The curves of the loops of a face.

use crate::base::bbox::Box3;
use crate::geometry::Curve;

/// One curve of a loop.
#[derive(Clone, Debug)]
pub struct Border {
    /// The curve in space, in the loop's direction; it counts.
    pub space: Curve,
    /// The same in the (u, v) of the base surface, z = 0, in any direction: where the file has it, it agrees with the curve in
    /// space, and the file's parameters are the surface's in proportion.
    pub uv: Option<Curve>,
}

/// The box around all curves of loops.
pub fn reach<'a>(loops: impl IntoIterator<Item = &'a Vec<Border>>) -> Box3 {
    loops.into_iter().flatten().map(|b| b.space.bbox()).fold(Box3::EMPTY, Box3::union)
}

/// The curves that a curve is made of.
pub fn pieces(curve: &Curve) -> Vec<Curve> {
    curve.composite().map_or_else(|| vec![curve.clone()], |c| c.pieces.clone())
}

/// A loop run the other way.
pub fn backwards(borders: Vec<Border>) -> Vec<Border> {
    borders.into_iter().rev().map(|b| Border { space: b.space.reversed(), uv: b.uv }).collect()
}
