//! Functions on texts.

use std::sync::Arc;

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::lang::values::value::Value;

builtins! {
    /// A value as text: shortest number and unit, in model units or degrees.
    ///
    /// ```loft
    /// let a = text(0.3cm) // => "3mm"
    /// ```
    fn text(
        /// Any value.
        value: Value,
    ) -> Arc<str> = |cx, value| Ok(cx.show(&value).into());

    /// Stops with a message of the script's own.
    ///
    /// ```loft
    /// fn half(n) = if mod(n, 2) == 0 then n / 2 else error("{n} is odd")
    /// let a = half(6) // => 3
    /// ```
    fn error(
        /// What to say.
        message: Arc<str>,
    ) -> Value = |_, message| Err(ValueFault::Raised { message: message.to_string() }.into());
}
