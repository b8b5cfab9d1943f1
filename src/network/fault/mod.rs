//! What can go wrong with networks and chains, family by family.

pub mod chains;
pub mod ends;
pub mod graph;
pub mod grid;
pub mod meetings;
pub mod net;
pub mod no_flow;

pub use chains::ChainFault;
pub use ends::{CurveEnd, EndFault};
pub use graph::GraphFault;
pub use grid::GridFault;
pub use meetings::MeetingFault;
pub use net::NetFault;
pub use no_flow::NoFlow;
