//! From a plan to a mesh: the one entry point for the floors above.

use super::data::Mesh;
use super::plan::Plan;
use crate::base::fault::{Fault, Result};
use crate::base::job::Job;
use crate::base::tolerance::Tolerance;
use crate::model::Model;
use crate::network::Network;

/// What a mesh is made from.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    /// What is asked.
    pub plan: &'a Plan,
    /// Patches and edges.
    pub model: &'a Model,
    /// Links and nodes.
    pub network: &'a Network,
    /// The model's tolerance.
    pub tolerance: &'a Tolerance,
}

/// How a mesh came about, for `-v` and `explain`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Explanation {
    /// One line each: which method a face got and its counts; which rule decided a strip.
    pub lines: Vec<String>,
}

/// Makes the mesh. Warnings and notes go to `sink`.
pub fn build(input: &Input, job: &Job, sink: &mut Vec<Fault>) -> Result<(Mesh, Explanation)> {
    let _ = sink;
    job.go_on()?;
    Ok((Mesh { name: input.plan.name.clone(), order: input.plan.order, ..Mesh::default() }, Explanation::default()))
}
