//! Tables of variants: a header of param names, each row one run.

/// One row of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Name of the case, also of its output folder.
    pub name: String,
    /// Params and the texts of their literals: those of the command line, then those of the row.
    pub sets: Vec<(String, String)>,
}

/// The rows of a table; `sets` are the params set for all rows. The error is a sentence about the table.
pub fn rows(bytes: &[u8], sets: &[(String, String)]) -> Result<Vec<Row>, String> {
    let _ = (bytes, sets);
    Err("not yet".to_owned())
}
