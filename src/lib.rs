//! `lofting` turns a short text file into exact surfaces, an analysis-ready mesh and the files a solver reads.
//!
//! The pipeline, each arrow a pure function of its left side and the [`base::tolerance::Tolerance`]:
//!
//! ```text
//! text → tree → declarations → dependency graph → curves → network → chains → surfaces → model → meshes → files
//! ```
//!
//! The crate is laid out in floors, and a floor imports only from floors below it:
//! [`base`] · [`geometry`] · [`network`] · [`surface`] · [`model`] · [`mesh`] · [`io`], [`draw`] · [`lang`] · [`session`] · `cli`.
//! `docs/architecture.md` tells what each one holds and what is deliberately absent from it.

pub mod base;
#[cfg(feature = "cli")]
pub mod cli;
pub mod draw;
pub mod geometry;
pub mod io;
pub mod lang;
pub mod mesh;
pub mod model;
pub mod network;
pub mod session;
pub mod surface;
