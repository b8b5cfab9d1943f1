//! A mesh with how it came about.

use crate::mesh::data::mesh::Mesh;
use crate::mesh::report::explain::Explanation;
use crate::mesh::size::remark::Remark;

/// A mesh with what it was made of.
#[derive(Clone, Debug, Default)]
pub struct Built {
    /// The mesh.
    pub mesh: Mesh,
    /// How it came about.
    pub explanation: Explanation,
    /// What is to be said about its rules.
    pub remarks: Vec<Remark>,
}
