//! Floor 2: curves become nodes and links; runs of them become modeling curves ("chains"); node lists become flows.

pub mod chain;
pub mod flow;
pub mod graph;
pub mod meet;
mod slice;

pub use chain::{Chain, Run};
pub use flow::{Flow, FlowKind};
pub use graph::{Link, LinkId, Network, Node, NodeId};
pub use meet::{Meeting, meet};
