//! Functions on numbers and quantities.

use crate::builtins;
use crate::lang::value::Quantity;

builtins! {
    /// Absolute value of a number or quantity.
    ///
    /// ```loft
    /// let a = abs(-3mm) // => 3mm
    /// ```
    fn abs(
        /// A number or quantity.
        x: Quantity,
    ) -> Quantity = |_, x| Ok(Quantity { value: x.value.abs(), ..x });
}
