//! The curve network: all declared curves in one graph of nodes and links [Koh & Park 1990, §3.1].

use glam::DVec3;

use super::chain::Chain;
use crate::base::fault::{Fault, Result};
use crate::base::job::Job;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;

crate::ids! {
    /// A node of the network.
    NodeId,
    /// A link of the network.
    LinkId,
    /// A curve of the network.
    CurveId,
}

/// A point where curves end or meet.
#[derive(Clone, Debug)]
pub struct Node {
    /// Where it is: the declared point among the hits, else their mean.
    pub point: DVec3,
    /// Links that end here, with `true` where the link ends and `false` where it starts; ascending.
    pub ends: Vec<(LinkId, bool)>,
}

/// A run of one curve between neighbouring nodes.
#[derive(Clone, Debug)]
pub struct Link {
    /// The curve that owns it.
    pub curve: CurveId,
    /// Arc lengths on the owner, ascending.
    pub s: (f64, f64),
    /// First and last node, in the direction of the owner.
    pub nodes: (NodeId, NodeId),
}

/// A curve with the links it runs over.
#[derive(Clone, Debug)]
pub struct NetCurve {
    /// Unique name; ties and ownership go by it.
    pub name: String,
    /// Its geometry.
    pub curve: Curve,
    /// Links it runs over from start to end, with `true` where it runs against the link's direction (shared runs).
    pub links: Vec<(LinkId, bool)>,
    /// Its nodes from start to end, `links.len() + 1` of them.
    pub nodes: Vec<NodeId>,
    /// Arc lengths of these nodes on this curve.
    pub stations: Vec<f64>,
}

/// A curve to insert.
#[derive(Clone, Debug)]
pub struct Input {
    /// Unique name.
    pub name: String,
    /// Geometry.
    pub curve: Curve,
    /// Arc lengths where a node is asked for (ends of slices).
    pub cuts: Vec<f64>,
}

/// The curves of a model, their nodes and links; numbered in order of declaration, then along curves.
#[derive(Clone, Debug, Default)]
pub struct Network {
    /// Curves in order of declaration.
    pub curves: Vec<NetCurve>,
    /// Nodes.
    pub nodes: Vec<Node>,
    /// Links.
    pub links: Vec<Link>,
}

impl Network {
    /// All curves at once. `points` are the declared points, which give their place to the nodes they hit.
    ///
    /// Notes and warnings (shared runs, near misses) go to `sink`.
    pub fn build(inputs: Vec<Input>, points: &[DVec3], tolerance: &Tolerance, job: &Job, sink: &mut Vec<Fault>) -> Result<Self> {
        let _ = (inputs, points, tolerance, job, sink);
        Ok(Self::default())
    }

    /// The links a chain runs over, with `true` where it runs against the link; `None` where a run lies on a curve that is not in the network.
    pub fn links_of(&self, chain: &Chain, tolerance: &Tolerance) -> Option<Vec<(LinkId, bool)>> {
        let _ = (chain, tolerance);
        None
    }

    /// The node within tolerance of a point.
    pub fn node_at(&self, point: DVec3, tolerance: &Tolerance) -> Option<NodeId> {
        self.nodes.iter().position(|n| tolerance.same_point(n.point, point)).map(NodeId::at)
    }

    /// A link's geometry as a chain along its own direction.
    pub fn link_chain(&self, link: LinkId) -> Chain {
        Chain::of_curve(&self.curves[self.links[link.index()].curve.index()].curve)
    }

    /// Invariants of math.md 3.1; the sentence says what is broken.
    pub fn check(&self) -> std::result::Result<(), String> {
        Ok(())
    }
}
