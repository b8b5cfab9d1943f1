//! The machine that runs a script: declarations on demand, expressions by walking their tree.

use std::sync::Arc;

use super::origins::{Origins, Place};
use super::plans::MeshSpec;
use super::syntax::ast::ExprId;
use super::value::ModuleId;
use crate::base::origin::Origin;

/// Where the machine is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    pub module: ModuleId,
    pub declaration: u32,
    pub member: u32,
    pub expr: ExprId,
    pub caller: Origin,
}

/// State of evaluation.
#[derive(Debug)]
pub struct Machine {
    pub(super) site: Site,
    meshes: Vec<Arc<MeshSpec>>,
}

impl Default for Machine {
    fn default() -> Self {
        let site = Site { module: ModuleId::MAIN, declaration: 0, member: 0, expr: ExprId(0), caller: Origin::NONE };
        Self { site, meshes: Vec::new() }
    }
}

impl Machine {
    pub(super) fn origin(&mut self, origins: &mut Origins) -> Origin {
        let Site { module, declaration, member, expr, caller } = self.site;
        origins.add(Place { module, declaration, member, expr: Some(expr), caller })
    }

    pub(super) fn module(&self) -> ModuleId {
        self.site.module
    }

    pub(super) fn meshes(&self, _module: ModuleId) -> &[Arc<MeshSpec>] {
        &self.meshes
    }
}
