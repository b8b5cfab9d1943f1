//! Floor 2: curves become nodes and links; runs of them become modeling curves ("chains"); node lists become flows.

mod assemble;
pub mod chain;
mod check;
mod cluster;
mod enclosure;
pub mod fault;
pub mod flow;
pub mod flow_chains;
pub mod flow_detection;
pub mod graph;
mod hits;
mod layout;
pub mod meet;
mod near;
pub mod net;
mod numbering;
mod ring_way;
mod rings;
mod rows;
mod run;
mod shared;
mod slice;
pub mod snap;

pub use chain::{Chain, Run};
pub use enclosure::ChainEnclosure;
pub use flow::{Flow, FlowFault, FlowKind, FlowOptions, NodeList};
pub use flow_chains::{ChainFlow, of_chains};
pub use graph::{CurveId, Input, Link, LinkId, LinkMap, Network, Node, NodeId};
pub use meet::{Meeting, given_twice, meet, meet_once};
pub use rings::rings;
pub use snap::{Hold, Move, SnapEnd, snap};
