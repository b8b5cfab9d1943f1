//! The stages that depend on everything declared: parts, network, surface model, meshes; each made once.

use std::sync::Arc;

use super::cx::{Cx, Parts, Stop};
use super::value::{MeshValue, ModuleId};
use crate::mesh::Mesh;
use crate::model::Model;
use crate::network::Network;

pub(super) fn parts(cx: &mut Cx, module: ModuleId) -> Result<Arc<Parts>, Stop> {
    let _ = (cx, module);
    Err(Stop::Bug("parts"))
}

pub(super) fn network(cx: &mut Cx, module: ModuleId) -> Result<Arc<Network>, Stop> {
    let parts = parts(cx, module)?;
    cx.pipeline.network(cx, module, &parts)
}

pub(super) fn model(cx: &mut Cx, module: ModuleId) -> Result<Arc<Model>, Stop> {
    let parts = parts(cx, module)?;
    cx.pipeline.model(cx, module, &parts)
}

pub(super) fn mesh(cx: &mut Cx, mesh: &MeshValue) -> Result<Arc<Mesh>, Stop> {
    match mesh {
        MeshValue::Data(mesh, _) => Ok(mesh.clone()),
        MeshValue::Declared { .. } => {
            let _ = cx;
            Err(Stop::Bug("mesh"))
        }
    }
}
