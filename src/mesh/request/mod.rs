//! What is requested of a mesh, and what all rooms after this one may read: the plan with its model, limits, sources of sizes.

pub mod decider;
pub mod fault;
pub mod input;
pub mod limits;
pub mod methods;
pub mod plan;
pub mod recall;
pub mod settings;
pub mod size_requests;
pub mod sources;
pub mod work;

/// Version of the mesher: one more whenever the same plan gives another mesh, so that golden files can name it as the cause.
pub const VERSION: u32 = 73;
