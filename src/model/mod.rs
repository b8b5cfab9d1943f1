//! Floor 4: patches, edges, vertices, loops and shells cut and glued from surfaces.

pub mod topology;

pub use topology::{Edge, EdgeCurve, EdgeId, Model, Patch, PatchId, Shell, SurfaceId, Vertex, VertexId};
