//! Functions on lists.

use crate::builtins;
use crate::lang::types::Rest;
use crate::lang::value::Value;

builtins! {
    /// A list without inner lists.
    ///
    /// ```loft
    /// let a = flatten([1, [2, [3]]]) // => [1, 2, 3]
    /// ```
    fn flatten(
        /// Lists and values.
        list: Rest<Value>,
    ) -> Vec<Value> = |_, list| Ok(list.0);
}
