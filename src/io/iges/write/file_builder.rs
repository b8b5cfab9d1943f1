//! A file that is being made, and how accurate it is.

use crate::io::iges::entity_writer::IgesFile;
use crate::io::iges::write::things::IgesScale;

pub(crate) struct FileBuilder<'s> {
    pub(crate) sheet: IgesFile,
    pub(crate) scale: &'s IgesScale,
    /// How far nets are from their surfaces at most, model units, and whether all that is known of one are samples.
    pub(crate) off: f64,
    pub(crate) sampled: bool,
    /// What is not in the file, in words.
    pub(crate) left_out: Vec<String>,
}
