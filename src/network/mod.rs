//! Floor 2: curves become nodes and links; runs of them become modeling curves ("chains"); node lists become flows.

pub mod chain;
pub mod detect;
pub mod flow;
pub mod flow_chains;
pub mod graph;
mod layout;
pub mod meet;
mod slice;

pub use chain::{Chain, Run};
pub use flow::{Flow, FlowFault, FlowKind, FlowOptions, NodeList};
pub use flow_chains::{ChainFlow, of_chains};
pub use graph::{Link, LinkId, Network, Node, NodeId};
pub use meet::{Meeting, meet, meet_once};
