//! The machine that runs a script: declarations on demand, each once, in dependency order.

use std::sync::Arc;

use crate::base::fault::Fault;
use crate::base::limits;
use crate::base::origin::Origin;
use crate::base::work::Budget;
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::diag::span::Span;
use crate::lang::eval::bind::Blame;
use crate::lang::eval::context::Cx;
use crate::lang::eval::feet::KeptFeet;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::memory::Dependencies;
use crate::lang::eval::module::Module;
use crate::lang::eval::room::MemoryBudget;
use crate::lang::eval::std::Builtin;
use crate::lang::syntax::ast::{Expr, ExprId, Node};
use crate::lang::values::origins::{NO_MEMBER, OriginEntry, Origins};
use crate::lang::values::plans::MeshSpec;
use crate::lang::values::value::{ModuleId, Value};
use crate::lang::words::names::Name;

/// Declarations inside each other's evaluation; reached by cycles through branches alone, since dependencies are
/// evaluated first.
pub(crate) const DECLARATION_DEPTH: usize = 500;
/// Expressions inside each other over all calls; with the stack of [`on_big_stack`] that is safe.
const EXPRESSION_DEPTH: u32 = 30_000;
/// Steps between two looks at the stop flag.
const STEPS_A_LOOK: u64 = 1 << 16;
/// Steps that take about as long as an evaluation of a curve.
const STEPS_OF_A_UNIT: u64 = 4;
const STACK_BYTES: usize = 1 << 30;

/// Runs `work` on a thread whose stack holds the deepest legal recursion; on this one when no thread can be had.
pub fn on_big_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    crate::base::par::on_stack(STACK_BYTES, work)
}

/// Code of one declaration: its arena and where it stands.
#[derive(Clone, Copy)]
pub(crate) struct Code<'c> {
    pub nodes: &'c [Node],
    pub module: ModuleId,
    pub declaration: u32,
}

impl<'c> Code<'c> {
    pub fn expr(&self, id: ExprId) -> &'c Expr {
        &self.nodes[id.index()].expr
    }
    pub fn span(&self, id: ExprId) -> Span {
        self.nodes[id.index()].span
    }
}

/// Where the machine is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    pub module: ModuleId,
    pub declaration: u32,
    pub member: [u32; 2],
    pub expr: ExprId,
}

/// A call of a script's function that is being run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CallFrame {
    /// The function.
    pub name: Name,
    /// Where it was called; its `expr` is the call.
    pub site: Site,
    /// The origin of the call, made when first asked for.
    pub origin: Origin,
}

/// What `name(` leads to, looked up once per name.
#[derive(Debug)]
pub(crate) struct Word {
    pub function: Option<&'static Builtin>,
    pub fields: Box<[&'static Builtin]>,
}

/// The words looked up so far: of very many names few are called.
#[derive(Debug, Default)]
pub(crate) struct Words {
    /// Of each name its place in the list plus one, or 0.
    places: Vec<u32>,
    known: Vec<Word>,
}

impl Words {
    /// What a name leads to, when it was looked up.
    pub(crate) fn get(&self, name: Name) -> Option<&Word> {
        let place = *self.places.get(name.index())?;
        self.known.get((place as usize).wrapping_sub(1))
    }

    /// Keeps what a name leads to.
    pub(crate) fn insert(&mut self, name: Name, word: Word) {
        if self.places.len() <= name.index() {
            self.places.resize(name.index() + 1, 0);
        }
        self.known.push(word);
        self.places[name.index()] = self.known.len() as u32;
    }
}

/// State of evaluation.
#[derive(Debug)]
pub struct Machine {
    pub(crate) modules: Vec<Module>,
    pub(crate) site: Site,
    pub(crate) locals: Vec<(Name, Value)>,
    pub(crate) base: usize,
    pub(crate) calls: Vec<CallFrame>,
    pub(crate) running: Vec<(ModuleId, u32)>,
    pub(crate) words: Words,
    pub(crate) steps: u64,
    /// What a call may take.
    pub(crate) budget: Budget,
    /// Members of lists held.
    pub(crate) room: MemoryBudget,
    next_look: u64,
    pub(crate) depth: u32,
    pub(crate) in_within: bool,
    /// Number of the walk through dependencies.
    pub(crate) stamp: u32,
    /// Declarations that a reported cycle holds.
    pub(crate) in_cycle: Vec<(ModuleId, u32)>,
    /// Stages being gathered, for the words of a cycle.
    pub(crate) stages: u32,
    pub(crate) defaults: std::collections::BTreeMap<(usize, usize), Value>,
    pub(crate) filed: Vec<(Option<(ModuleId, u32)>, Diagnostic)>,
    /// Names that nothing binds, of which it is not yet told what was meant.
    pub(crate) unknown: crate::lang::eval::misspelt::Unknowns,
    /// What the declaration being evaluated asked for beside values.
    pub(crate) asked: Dependencies,
    /// Surfaces made ready for their nearest points.
    pub(crate) feet: KeptFeet,
    /// Shells that something of was asked for, by script and expression.
    pub(crate) glued: std::collections::BTreeMap<(ModuleId, Origin), Vec<crate::lang::eval::glued::Asked>>,
}

impl Default for Machine {
    fn default() -> Self {
        let site = Site { module: ModuleId::MAIN, declaration: 0, member: [NO_MEMBER; 2], expr: ExprId(0) };
        Self {
            modules: Vec::new(),
            site,
            locals: Vec::new(),
            base: 0,
            calls: Vec::new(),
            running: Vec::new(),
            words: Words::default(),
            steps: 0,
            budget: Budget::new(limits::CALL_WORK),
            room: MemoryBudget::default(),
            next_look: STEPS_A_LOOK,
            depth: 0,
            in_within: false,
            stamp: 0,
            in_cycle: Vec::new(),
            stages: 0,
            defaults: std::collections::BTreeMap::new(),
            filed: Vec::new(),
            unknown: crate::lang::eval::misspelt::Unknowns::new(),
            asked: Dependencies::default(),
            feet: KeptFeet::default(),
            glued: std::collections::BTreeMap::new(),
        }
    }
}

fn place(site: Site, caller: Origin) -> OriginEntry {
    OriginEntry { module: site.module, declaration: site.declaration, member: site.member, expr: Some(site.expr), caller }
}

impl Machine {
    /// The origin of the expression being run; the calls that lead to it get theirs on the way.
    pub(crate) fn origin(&mut self, origins: &mut Origins) -> Origin {
        let mut caller = Origin::NONE;
        for frame in &mut self.calls {
            if !frame.origin.is_some() {
                frame.origin = origins.add(place(frame.site, caller));
            }
            caller = frame.origin;
        }
        origins.add(place(self.site, caller))
    }

    pub(crate) fn module(&self) -> ModuleId {
        self.site.module
    }

    pub(crate) fn meshes(&self, module: ModuleId) -> &[Arc<MeshSpec>] {
        self.modules.get(module.index()).map_or(&[], |m| &m.meshes)
    }

    /// Which of a script's meshes has a name, from 1, and how many there are so far.
    pub(crate) fn place_of_mesh(&self, module: ModuleId, name: &str) -> (usize, usize) {
        let all = self.meshes(module);
        (1 + all.iter().position(|m| *m.name == *name).unwrap_or_default(), all.len())
    }

    pub(crate) fn at(&self, module: ModuleId) -> &Module {
        &self.modules[module.index()]
    }

    pub(crate) fn at_mut(&mut self, module: ModuleId) -> &mut Module {
        &mut self.modules[module.index()]
    }
}

impl Halt {
    /// Of two reasons the one that says more: what was reported, then what was skipped, then what waits.
    pub(crate) fn or(self, other: Self) -> Self {
        let rank = |s: &Self| match s {
            Self::Failed | Self::Fault(_) | Self::Bug(_) => 0,
            Self::Broken => 1,
            Self::Skipped(..) => 2,
            Self::NotYet => 3,
        };
        if rank(&other) < rank(&self) { other } else { self }
    }
}

/// Collects values of independent parts: goes on after a failure, so that each part reports its own.
#[derive(Default)]
pub(crate) struct Gather {
    stop: Option<Halt>,
}

impl Gather {
    pub fn take<T>(&mut self, result: Result<T, Halt>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(stop) => {
                self.stop = Some(match self.stop.take() {
                    Some(before) => before.or(stop),
                    None => stop,
                });
                None
            }
        }
    }

    pub fn done(self) -> Result<(), Halt> {
        self.stop.map_or(Ok(()), Err)
    }
}

impl Cx<'_> {
    /// Counts a step; fails when the work limit is reached or the run is stopped.
    #[inline]
    pub(crate) fn step(&mut self) -> Result<(), Halt> {
        self.machine.steps += 1;
        if self.machine.steps >= self.machine.next_look { self.look() } else { Ok(()) }
    }

    #[cold]
    fn look(&mut self) -> Result<(), Halt> {
        self.machine.next_look = self.machine.steps + STEPS_A_LOOK;
        self.job.charge(STEPS_A_LOOK / STEPS_OF_A_UNIT);
        self.job.go_on()?;
        if self.machine.steps > limits::EVALUATION_STEPS {
            return Err(crate::base::fault::ValueFault::Limit {
                what: "the work of this script".into(),
                limit: "10^9 evaluation steps".into(),
            }
            .into());
        }
        Ok(())
    }

    /// Counts `n` steps of a builtin or loop at once.
    pub fn steps(&mut self, n: usize) -> Result<(), Halt> {
        self.machine.steps += n as u64;
        if self.machine.steps >= self.machine.next_look { self.look() } else { Ok(()) }
    }

    #[inline]
    pub(crate) fn deeper(&mut self, code: Code<'_>, id: ExprId) -> Result<(), Halt> {
        self.machine.depth += 1;
        if self.machine.depth > EXPRESSION_DEPTH { Err(self.too_deep(code, id)) } else { Ok(()) }
    }

    #[cold]
    pub(crate) fn too_deep(&mut self, code: Code<'_>, id: ExprId) -> Halt {
        let span = code.span(id);
        self.error(code, "E216", "calls are nested too deep", span, "the recursion does not end here")
            .help(format!("at most {} calls may be nested; give the function an `if` that ends the recursion", limits::CALL_DEPTH))
            .stop()
    }

    /// Turns a fault that reached a declaration into its diagnostic.
    pub(crate) fn settle(&mut self, code: Code<'_>, stop: Halt, span: Span) -> Halt {
        match stop {
            Halt::Fault(Fault::Interrupted) => Halt::Broken,
            Halt::Fault(fault) => {
                let diagnostic = self.locate(&fault, code, span, &Blame::default());
                self.sink.reports.push(diagnostic);
                Halt::Failed
            }
            Halt::Bug(what) => self.error(code, "E999", format!("a bug in loft: {what}"), span, "while evaluating this").stop(),
            other => other,
        }
    }

    /// The narrowest expression being evaluated.
    pub(crate) fn machine_span(&self, code: Code<'_>) -> Span {
        match code.nodes.get(self.machine.site.expr.index()) {
            Some(node) => node.span,
            None => self.machine.at(code.module).script.declarations.span(code.declaration as usize),
        }
    }
}
