//! Golden tests of the user's own models: what a run finds as short readable text, compared with what it found before.
//!
//! `discover` finds models, `run` runs them through [`crate::session::run`] in scratch folders, `section` turns outcomes
//! into lines, `file` reads and writes the golden, `compare` matches lines, `describe` says in words what moved; `copies`
//! compares exported files, meshes as geometry.

mod accept;
mod cells;
mod compare;
mod contents;
mod copies;
mod describe;
mod details;
mod diff;
mod discover;
mod file;
mod geometry;
mod junit;
mod line;
mod line_builder;
mod model_test;
mod parse;
mod quote;
mod quotes;
mod renames;
mod requests;
mod run;
mod scratch;
mod section;
mod tokens;
mod values;
mod verdict;
mod words;

pub use describe::DiffLine;
pub use diff::{Difference, NoDiff, diff};
pub use discover::{Test, TestState, discover};
pub use file::{Flaw, Golden, Producer};
pub use junit::text as junit_text;
pub use run::{Settings, name_of, names, run_all, run_one, run_one_again};
pub use verdict::{CaseResult, Verdict};
