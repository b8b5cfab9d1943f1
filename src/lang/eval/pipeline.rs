//! The stages behind a script, as the session gives them to the evaluator, and what they are given.

use std::sync::Arc;

use glam::DVec3;

use crate::base::origin::Origin;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::plans::MeshSpec;
use crate::lang::values::value::ModuleId;
use crate::mesh::Mesh;
use crate::model::Model;
use crate::network::{Chain, Network};
use crate::surface::Surface;

/// Something a declaration binds, under its unique name (`south`, `ribs[2]`).
#[derive(Clone, Debug)]
pub struct Declared<T> {
    /// Name as the user says it; for a nameless curve its source text.
    pub name: Arc<str>,
    /// The declaration and member; geometry that it binds carries it too.
    pub origin: Origin,
    /// What it binds.
    pub value: T,
}

/// What a script declares, in order of declaration; what the network and the surface model are built from.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// `point`s.
    pub points: Vec<Declared<DVec3>>,
    /// `curve`s; each is one whole curve whose origin is the declaration's.
    pub curves: Vec<Declared<Chain>>,
    /// `modeling curve`s.
    pub modeling: Vec<Declared<Chain>>,
    /// `surface`s.
    pub surfaces: Vec<Declared<Surface>>,
}

/// The geometry of a script as far as it is sound: everything, or where something failed what was evaluated.
#[derive(Clone, Debug)]
pub struct Sound {
    /// What is declared.
    pub parts: Arc<Parts>,
    /// The network of these curves.
    pub network: Arc<Network>,
    /// The surface model of these surfaces.
    pub model: Arc<Model>,
    /// Whether the network is that of these curves: meshes and shells can be made on it.
    pub stands: bool,
}

/// The stages that depend on everything declared; the session implements them over the kernel floors.
///
/// Each is called at most once per script (mesh: per mesh); results are kept by [`Cx`].
pub trait Pipeline: Sync {
    /// The network of all curves, nameless ones under declared surfaces included.
    fn network(&self, cx: &mut Cx, module: ModuleId, parts: &Parts) -> Result<Arc<Network>, Halt>;
    /// Patches, edges and vertices of all these surfaces, on the network of these curves.
    fn model(&self, cx: &mut Cx, module: ModuleId, parts: &Parts, network: Arc<Network>) -> Result<Arc<Model>, Halt>;
    /// A declared mesh.
    fn mesh(&self, cx: &mut Cx, module: ModuleId, mesh: &MeshSpec) -> Result<Arc<Mesh>, Halt>;
}
