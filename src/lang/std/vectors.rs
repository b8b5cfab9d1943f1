//! Functions and fields of points and directions.

use crate::lang::types::Vector;
use crate::lang::value::Quantity;
use crate::{builtins, fields};

builtins! {
    /// Scalar product of two vectors.
    ///
    /// ```loft
    /// let a = dot((1, 2, 3), (1, 0, 1)) // => 4
    /// ```
    fn dot(
        /// A vector.
        a: Vector,
        /// Another.
        b: Vector,
    ) -> Quantity = |_, a, b| Ok(Quantity::new(a.0.dot(b.0), a.1.times(b.1).unwrap_or_default()));
}

fields! {
    /// First coordinate.
    fn x(v: Vector) -> Quantity = |_, v| Ok(Quantity::new(v.0.x, v.1));
    /// Second coordinate.
    fn y(v: Vector) -> Quantity = |_, v| Ok(Quantity::new(v.0.y, v.1));
    /// Third coordinate.
    fn z(v: Vector) -> Quantity = |_, v| Ok(Quantity::new(v.0.z, v.1));
}
