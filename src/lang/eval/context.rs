//! One run as evaluation and builtins see it: the program, the machine, the sink of reports, and the stages behind.

use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::Fault;
use crate::base::job::Job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::io::Files;
use crate::lang::diag::diagnostic::Sources;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Machine;
use crate::lang::eval::memory::Memory;
use crate::lang::eval::pipeline::{Declared, Parts, Pipeline, Sound};
use crate::lang::eval::sink::Sink;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::origins::Origins;
use crate::lang::values::plans::MeshSpec;
use crate::lang::values::units::{LengthUnit, MILLIMETRE};
use crate::lang::values::value::{EntityHome, MeshValue, ModuleId, Record, ShellValue, Value};
use crate::lang::words::names::Names;
use crate::mesh::Mesh;
use crate::model::Model;
use crate::network::Network;

/// The scripts of a run as far as they do not change while it is evaluated.
pub struct Program {
    /// All names.
    pub names: Names,
    /// Where entities come from.
    pub origins: Origins,
    /// Texts of all files.
    pub sources: Sources,
    /// The unit of all lengths: that of the main script.
    pub unit: LengthUnit,
}

impl Default for Program {
    fn default() -> Self {
        Self { names: Names::default(), origins: Origins::default(), sources: Sources::default(), unit: MILLIMETRE }
    }
}

/// One run: its scripts, its values, what it says, and what builtins may ask for.
pub struct Cx<'w> {
    /// Names, places and texts of the scripts.
    pub program: Program,
    /// Ctrl-C and progress.
    pub job: &'w Job,
    pub(crate) files: &'w (dyn Files + Sync),
    pub(crate) pipeline: &'w dyn Pipeline,
    pub(crate) tolerance: Option<Tolerance>,
    pub(crate) seen: Box3,
    /// What was said so far and is not filed under a declaration yet.
    pub sink: Sink,
    pub(crate) machine: Machine,
    /// What earlier runs found; `None` in a run that keeps nothing.
    pub(crate) memory: Option<Memory>,
}

impl<'w> Cx<'w> {
    /// A fresh run.
    pub fn new(files: &'w (dyn Files + Sync), pipeline: &'w dyn Pipeline, job: &'w Job) -> Self {
        Self {
            program: Program::default(),
            job,
            files,
            pipeline,
            tolerance: None,
            seen: Box3::EMPTY,
            sink: Sink::default(),
            machine: Machine::default(),
            memory: None,
        }
    }

    /// The tolerance, or [`Halt::NotYet`] while the box that decides it is still being found.
    ///
    /// A builtin that needs it asks first thing, before work that would be done twice.
    pub fn tolerance(&self) -> Result<Tolerance, Halt> {
        self.tolerance.ok_or(Halt::NotYet)
    }

    /// The unit of all lengths of this run: that of the main script.
    pub fn unit(&self) -> LengthUnit {
        self.program.unit
    }

    /// The origin of the call being made; entities made by a builtin carry it.
    pub fn origin(&mut self) -> Origin {
        self.machine.origin(&mut self.program.origins)
    }

    /// Whether a `check` is being evaluated.
    pub fn in_check(&self) -> bool {
        let keyword = |(module, index): &(ModuleId, u32)| self.machine.at(*module).script.declarations.keyword(*index as usize);
        self.machine.running.last().map(keyword) == Some(Keyword::Check)
    }

    /// The script whose code is being run.
    pub fn module(&self) -> ModuleId {
        self.machine.module()
    }

    /// Says a note or a warning; the letter of the code decides which.
    pub fn say(&mut self, fault: &Fault) {
        self.say_counted(fault, 0);
    }

    /// Says a note or a warning that stands for `more` further ones; see [`Sink::say`].
    pub fn say_counted(&mut self, fault: &Fault, more: usize) {
        let mut diagnostic = self.diagnose(fault);
        diagnostic.more = more;
        self.sink.say(diagnostic);
    }

    /// Counts control points of a surface made without the tolerance into the box that decides its default.
    ///
    /// Curves that builtins return are counted without being asked.
    pub fn seen(&mut self, points: impl IntoIterator<Item = DVec3>) {
        if self.tolerance.is_none() {
            self.seen = points.into_iter().fold(self.seen, Box3::with);
        }
    }

    /// A record value.
    pub fn record(&mut self, fields: impl IntoIterator<Item = (&'static str, Value)>) -> Value {
        let (keys, values) = fields.into_iter().map(|(k, v)| (self.program.names.intern(k), v)).unzip::<_, _, Vec<_>, Vec<_>>();
        Value::Record(Arc::new(Record { keys: Arc::new(keys), values, row: false, part: None }))
    }

    /// The network of a script; evaluates all its curves first.
    pub fn network(&mut self, module: ModuleId) -> Result<Arc<Network>, Halt> {
        crate::lang::eval::stages::network(self, module)
    }

    /// The surface model of a script, whose surfaces are evaluated first, or the one that things are numbered in.
    pub fn model(&mut self, of: impl Into<EntityHome>) -> Result<Arc<Model>, Halt> {
        match of.into() {
            EntityHome { annex: Some(model), .. } => Ok(model),
            EntityHome { module, annex: None, .. } => crate::lang::eval::stages::model(self, module),
        }
    }

    /// The network that the model stands on in which things are numbered.
    pub fn network_of(&mut self, home: &EntityHome) -> Result<Arc<Network>, Halt> {
        match home {
            EntityHome { alone: true, .. } => Ok(Arc::default()),
            EntityHome { annex: Some(_), .. } => Ok(self.ground(home.module)?.1),
            EntityHome { annex: None, .. } => self.network(home.module),
        }
    }

    /// What is sound of a script's geometry, for showing it; asked after everything was evaluated.
    pub fn sound(&mut self, module: ModuleId) -> Result<Sound, Halt> {
        crate::lang::eval::stages::sound(self, module)
    }

    /// Network and surface model that shells and meshes are made on: the whole, or what is sound where declarations failed.
    pub fn ground(&mut self, module: ModuleId) -> Result<(Arc<Model>, Arc<Network>), Halt> {
        crate::lang::eval::stages::ground(self, module)
    }

    /// What a script declares; evaluates all its points, curves and surfaces first.
    pub fn parts(&mut self, module: ModuleId) -> Result<Arc<Parts>, Halt> {
        crate::lang::eval::stages::parts(self, module)
    }

    /// The declared groups of a script that did not fail: their things, nested lists flattened.
    pub fn groups(&mut self, module: ModuleId) -> Result<Vec<Declared<Vec<Value>>>, Halt> {
        crate::lang::eval::stages::groups(self, module)
    }

    /// The declared shells of a script that did not fail.
    pub fn shells(&mut self, module: ModuleId) -> Result<Vec<Declared<Arc<ShellValue>>>, Halt> {
        crate::lang::eval::stages::shells(self, module)
    }

    /// The mesh behind a value; a declared one is built on first use.
    pub fn mesh(&mut self, mesh: &MeshValue) -> Result<Arc<Mesh>, Halt> {
        crate::lang::eval::stages::mesh(self, mesh)
    }

    /// The declared meshes of a script evaluated so far.
    pub fn meshes(&self, module: ModuleId) -> &[Arc<MeshSpec>] {
        self.machine.meshes(module)
    }
}
