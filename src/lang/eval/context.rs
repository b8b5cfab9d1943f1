//! What evaluation and builtins work with: tolerance, units, origins, notes and the stages of the pipeline.

use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::Fault;
use crate::base::job::Job;
use crate::base::limits::REPORTS_OF_A_KIND;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::io::Files;
use crate::lang::diag::diagnostic::{Diagnostic, Sources};
use crate::lang::eval::machine::Machine;
use crate::lang::eval::memory::Memory;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::origins::Origins;
use crate::lang::values::plans::MeshSpec;
use crate::lang::values::units::LengthUnit;
use crate::lang::values::value::{Home, MeshValue, ModuleId, Record, ShellValue, Value};
use crate::lang::words::names::Names;
use crate::mesh::Mesh;
use crate::model::Model;
use crate::network::{Chain, Network};
use crate::surface::Surface;

/// Reports back to which a new one is looked for, so that equal ones are counted.
pub(crate) const SAID_JUST_NOW: usize = 64;

/// Why an evaluation gives no value.
#[derive(Clone, Debug)]
pub enum Halt {
    /// It was reported already.
    Failed,
    /// It depends on a declaration that failed: script and place there.
    Skipped(ModuleId, u32),
    /// It depends on something that did not parse and was reported there.
    Broken,
    /// It asks for the tolerance, which is not known yet; it is evaluated again when it is.
    NotYet,
    /// The kernel or a builtin says why; becomes a diagnostic at the call.
    Fault(Fault),
    /// Something that cannot happen did.
    Bug(&'static str),
}

impl From<Fault> for Halt {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

macro_rules! stop_from {
    ($($family:ident),+) => { $(
        impl From<crate::base::fault::$family> for Halt {
            fn from(fault: crate::base::fault::$family) -> Self {
                Self::Fault(fault.into())
            }
        }
    )+ };
}
stop_from!(ValueFault, CurveFault, NetworkFault, SurfaceFault, SweepFault, LoopFault, MeshFault, FileFault);

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

/// When a curve is snapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// In this round.
    Now,
    /// In a round before; it stays from then on when other curves are made from it.
    Before {
        /// Whether some are.
        named: bool,
    },
}

/// A round of `snap`.
#[derive(Debug)]
pub struct Snapping {
    /// The curves with their turns.
    pub curves: Vec<(Declared<Chain>, Turn)>,
    /// The declared points that ends may go to.
    pub points: Vec<DVec3>,
    /// Ends closer than this are brought together, model units.
    pub distance: f64,
    /// The expression that says the distance.
    pub origin: Origin,
}

/// The stages that depend on everything declared; the session implements them over the kernel floors.
///
/// Each is called at most once per script (mesh: per mesh); results are kept by [`Cx`].
pub trait Pipeline: Sync {
    /// Moves ends of measured curves together (`snap d`), before anything asks for the tolerance. What moved is replaced in
    /// place and noted (N513).
    fn snap(&self, cx: &mut Cx, snapping: &mut Snapping) -> Result<(), Halt>;
    /// The network of all curves, nameless ones under declared surfaces included.
    fn network(&self, cx: &mut Cx, module: ModuleId, parts: &Parts) -> Result<Arc<Network>, Halt>;
    /// Patches, edges and vertices of all these surfaces, on the network of these curves.
    fn model(&self, cx: &mut Cx, module: ModuleId, parts: (&Parts, Arc<Network>)) -> Result<Arc<Model>, Halt>;
    /// A declared mesh.
    fn mesh(&self, cx: &mut Cx, module: ModuleId, mesh: &MeshSpec) -> Result<Arc<Mesh>, Halt>;
}

/// One run: scripts, values, and what builtins may ask for.
pub struct Cx<'w> {
    /// All names.
    pub names: Names,
    /// Where entities come from.
    pub origins: Origins,
    /// Texts of all files.
    pub sources: Sources,
    /// Ctrl-C and progress.
    pub job: &'w Job,
    pub(crate) files: &'w (dyn Files + Sync),
    pub(crate) pipeline: &'w dyn Pipeline,
    pub(crate) unit: LengthUnit,
    pub(crate) tolerance: Option<Tolerance>,
    pub(crate) seen: Box3,
    pub(crate) sink: Vec<Diagnostic>,
    /// Every report is kept in its own words, also where a screen shows one for many.
    pub whole: bool,
    pub(crate) machine: Machine,
    /// What earlier runs found; `None` in a run that keeps nothing.
    pub(crate) memory: Option<Memory>,
}

impl<'w> Cx<'w> {
    /// A fresh run.
    pub fn new(files: &'w (dyn Files + Sync), pipeline: &'w dyn Pipeline, job: &'w Job) -> Self {
        Self {
            names: Names::default(),
            origins: Origins::default(),
            sources: Sources::default(),
            job,
            files,
            pipeline,
            unit: crate::lang::values::units::MILLIMETRE,
            tolerance: None,
            seen: Box3::EMPTY,
            sink: Vec::new(),
            whole: false,
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
        self.unit
    }

    /// The origin of the call being made; entities made by a builtin carry it.
    pub fn origin(&mut self) -> Origin {
        self.machine.origin(&mut self.origins)
    }

    /// Whether a `check` is being evaluated.
    pub fn in_check(&self) -> bool {
        let keyword = |(module, index): &(ModuleId, u32)| self.machine.at(*module).script.declarations[*index as usize].keyword;
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

    /// Says a note or a warning that stands for `more` further ones. What was said just before is counted, not kept, so that
    /// a loop that says the same a million times holds one report; of one code a thousand are kept at most.
    pub fn say_counted(&mut self, fault: &Fault, more: usize) {
        let mut diagnostic = self.diagnose(fault);
        diagnostic.more = more;
        match self.sink.iter_mut().rev().take(SAID_JUST_NOW).find(|d| d.is_like(&diagnostic)) {
            Some(found) => found.fold(diagnostic, self.whole),
            None => self.keep(diagnostic),
        }
    }

    fn keep(&mut self, diagnostic: Diagnostic) {
        let of_this = |d: &&mut Diagnostic| d.code == diagnostic.code;
        let kept = if self.sink.len() < REPORTS_OF_A_KIND { 0 } else { self.sink.iter_mut().filter(of_this).count() };
        match self.sink.iter_mut().rev().find(of_this) {
            Some(last) if kept >= REPORTS_OF_A_KIND => last.fold(diagnostic, self.whole),
            _ => self.sink.push(diagnostic),
        }
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
        let (keys, values) = fields.into_iter().map(|(k, v)| (self.names.intern(k), v)).unzip::<_, _, Vec<_>, Vec<_>>();
        Value::Record(Arc::new(Record { keys: Arc::new(keys), values, row: false, part: None }))
    }

    /// The network of a script; evaluates all its curves first.
    pub fn network(&mut self, module: ModuleId) -> Result<Arc<Network>, Halt> {
        crate::lang::eval::stages::network(self, module)
    }

    /// The surface model of a script, whose surfaces are evaluated first, or the one that things are numbered in.
    pub fn model(&mut self, of: impl Into<Home>) -> Result<Arc<Model>, Halt> {
        match of.into() {
            Home { annex: Some(model), .. } => Ok(model),
            Home { module, annex: None, .. } => crate::lang::eval::stages::model(self, module),
        }
    }

    /// The network that the model stands on in which things are numbered.
    pub fn network_of(&mut self, home: &Home) -> Result<Arc<Network>, Halt> {
        match home {
            Home { alone: true, .. } => Ok(Arc::default()),
            Home { annex: Some(_), .. } => Ok(self.ground(home.module)?.1),
            Home { annex: None, .. } => self.network(home.module),
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
