//! Where the files of a run come from and go to: folders on the disk, or memory.

use std::collections::BTreeSet;
use std::io;

use crate::io::Files;

/// What a run does with its outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outputs {
    /// They are written.
    Written,
    /// They are only counted: `loft check`.
    Counted,
    /// They are not made: a page shows the model.
    Skipped,
}

/// The files of one run. Outputs are staged by [`Files::write`] and stand when they are committed.
pub trait Store: Files + Sync {
    /// What becomes of outputs.
    fn outputs(&self) -> Outputs;
    /// The resolved name of the script itself, beside which its imports are looked for.
    fn script_name(&self, shown: &str) -> String;
    /// The identity of the file of an output: its real folder and its name, letter case aside, since many
    /// systems ignore that; `None` where it may not stand.
    fn file_of(&self, path: &str) -> Option<String>;
    /// The files that were read, identified as by [`Store::file_of`].
    fn files_read(&self) -> BTreeSet<String>;
    /// Where an output stands, for people: as seen from the working directory, in full where it is not below that.
    fn shown_place(&self, path: &str) -> String;
    /// Gives all staged outputs their names.
    fn commit(&self) -> io::Result<()>;
    /// Removes everything that was not committed.
    fn discard(&self);
}
