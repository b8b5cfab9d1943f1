//! Floor 4: patches, edges, vertices, loops and shells cut and glued from surfaces.

pub mod apart;
pub mod atoms;
pub mod carry;
pub mod contact;
mod edge_chain;
mod feet;
pub mod gather;
pub mod glue;
pub mod imprint;
mod imprint_pieces;
pub mod loops;
pub mod measure;
mod measure_quadrature;
mod measure_strips;
mod measure_triangles;
mod measure_trimmed;
pub mod moments;
mod nearest;
mod outwards;
mod patches;
mod sew;
pub mod shared;
pub mod shells;
mod sides;
pub mod stretches;
pub mod topology;
pub mod trace;

pub use contact::{Apart, Contact, Spread};
pub use loops::Loop;
pub use moments::Moments;
pub use patches::Lines;
pub use shared::{Course, EdgePart, SharedEdge, SharedEdges, SharedTrack};
pub use shells::ShellRequest;
pub use stretches::{Meeting, Stretch};
pub use topology::{Edge, EdgeCurve, EdgeId, Model, Patch, PatchId, Shell, SurfaceId, Vertex, VertexId};
pub use trace::{Trace, Track};
