//! Imported cells, as the language sees them.

use std::sync::Arc;

use crate::lang::values::value::Value;
use crate::lang::words::names::Name;

/// What `import "x.csv" as x` binds: rows of numbers, quantities, texts and `none`.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Lines above the first one all of numbers (dat and txt).
    pub title: Arc<str>,
    /// Cells of the header, when there is one, as written less its unit.
    pub header: Option<Arc<Vec<Value>>>,
    /// The header as names, for `row.x`.
    pub keys: Arc<Vec<Name>>,
    /// Rows: lists, or records that are rows when there is a header.
    pub rows: Arc<Vec<Value>>,
}
