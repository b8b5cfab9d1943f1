//! What a mesh is made from.

use crate::base::tolerance::Tolerance;
use crate::mesh::request::plan::Plan;
use crate::model::Model;
use crate::network::Network;

/// What a mesh is made from.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// Patches and edges.
    pub model: &'a Model,
    /// Links and nodes.
    pub network: &'a Network,
    /// The model's tolerance.
    pub tolerance: &'a Tolerance,
}
