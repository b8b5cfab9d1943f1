//! Shells glued once a run, whoever asks for what they measure.

use crate::model::fault::ShellFault;
use std::sync::Arc;

use crate::base::fault::Fault;
use crate::base::work::Once;
use crate::hydrostatics::body::Body;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::values::value::{ModuleId, ShellValue};
use crate::model::SurfaceId;
use crate::model::measure::{self, Solid};
use crate::model::topology::Shell;
use crate::surface::Surface;

/// A shell with the model that it is a part of.
#[derive(Debug)]
pub struct Glued {
    /// The model.
    pub scene: Scene,
    /// Its surfaces as they are turned, and what is free.
    pub shell: Shell,
    /// What there is to say of it where it is declared.
    pub said: Vec<Fault>,
    solid: Once<Solid>,
    body: Once<Arc<Body>>,
}

impl Glued {
    /// Its surfaces, each with whether the other side is used.
    pub fn faces(&self) -> Vec<(Surface, bool)> {
        let face = |(id, other): &(SurfaceId, bool)| (self.scene.model.surfaces[id.index()].surface.clone(), *other);
        self.shell.surfaces.iter().map(face).collect()
    }

    /// It as a body in water, made by whoever asks first.
    pub fn body(&self, make: impl FnOnce() -> Result<Body, Halt>) -> Result<Arc<Body>, Halt> {
        self.body.try_get(|| make().map(Arc::new))
    }

    /// What it encloses; of a closed one only.
    pub fn solid(&self) -> Solid {
        self.solid.get(|| measure::solid(&self.faces()))
    }
}

/// What was made of one shell, found again by what it is of.
#[derive(Debug)]
pub(crate) struct Asked {
    of: ShellValue,
    glued: Arc<Once<Arc<Glued>>>,
}

impl Asked {
    fn is_of(&self, shell: &ShellValue) -> bool {
        let Self { of, .. } = self;
        let same = || of.surfaces.iter().zip(&shell.surfaces).all(|(a, b)| a.is(b));
        (of.origin, &of.name, of.snap, of.imprint, of.flip, of.body)
            == (shell.origin, &shell.name, shell.snap, shell.imprint, shell.flip, shell.body)
            && of.surfaces.len() == shell.surfaces.len()
            && same()
    }
}

impl Cx<'_> {
    /// A shell in the model of a script's surfaces, extended by those of its own that are not among them.
    pub fn glued(&mut self, module: ModuleId, shell: &ShellValue) -> Result<Arc<Glued>, Halt> {
        let tolerance = self.tolerance()?;
        // Whoever asks depends on all surfaces, also where the shell is known.
        self.ground(module)?;
        let known = self.machine.glued.entry((module, shell.origin)).or_default();
        let once = match known.iter().find(|asked| asked.is_of(shell)) {
            Some(asked) => asked.glued.clone(),
            None => {
                let glued = Arc::new(Once::default());
                known.push(Asked { of: shell.clone(), glued: glued.clone() });
                glued
            }
        };
        once.try_get(|| {
            let scene = Scene::of(self, module, &shell.surfaces)?;
            let mut said = Vec::new();
            let built = scene.shell(shell, &tolerance, &mut said)?;
            Ok(Arc::new(Glued { scene, shell: built, said, solid: Once::default(), body: Once::default() }))
        })
    }

    /// What a closed shell encloses; an open one encloses nothing.
    pub fn solid(&mut self, shell: &ShellValue) -> Result<Solid, Halt> {
        let glued = self.glued(self.module(), shell)?;
        let built = &glued.shell;
        if !built.closed {
            let origin = |id: &SurfaceId| glued.scene.model.surfaces[id.index()].surface.origin();
            let free = built.free.iter().map(|(id, at, length)| (origin(id), *at, *length)).collect();
            return Err(ShellFault::NotClosed { shell: shell.origin, wanted: "volume", free }.into());
        }
        Ok(glued.solid())
    }
}
