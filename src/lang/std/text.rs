//! Functions on texts.

use std::sync::Arc;

use crate::builtins;
use crate::lang::value::Value;

builtins! {
    /// A value as text.
    ///
    /// ```loft
    /// let a = text(3mm) // => "3mm"
    /// ```
    fn text(
        /// Any value.
        value: Value,
    ) -> Arc<str> = |_, value| Ok(match value { Value::Text(t) => t, other => format!("{other:?}").into() });
}
