//! Floor 7: the language: text to tree, values, evaluation by dependency, diagnostics.
//!
//! A room imports only from rooms before it:
//!
//! [`diag`] · [`words`] · [`syntax`] · [`values`] · [`eval`] · [`incremental`] · [`declare`] · [`assist`] · [`run`] · [`fmt`]

pub mod assist;
pub mod declare;
pub mod diag;
pub mod eval;
pub mod fmt;
pub mod incremental;
pub mod run;
pub mod syntax;
pub mod values;
pub mod words;
