//! The machine that runs a script: declarations on demand, each once, in dependency order.

use std::sync::Arc;

use crate::base::bbox::Box3;
use crate::base::fault::{Fault, Severity};
use crate::base::limits;
use crate::base::origin::Origin;
use crate::base::work::{self, Budget};
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::diag::span::Span;
use crate::lang::eval::bind::Blame;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::memory::Dependencies;
use crate::lang::eval::memory::Sees;
use crate::lang::eval::memory::Start;
use crate::lang::eval::module::{Module, State};
use crate::lang::eval::room::MemoryBudget;
use crate::lang::eval::std::Builtin;
use crate::lang::syntax::ast::{Declaration, Expr, ExprId, Keyword, Node};
use crate::lang::values::origins::{NO_MEMBER, Origins, Place};
use crate::lang::values::plans::MeshSpec;
use crate::lang::values::value::{ModuleId, Value};
use crate::lang::words::names::Name;

/// Declarations inside each other's evaluation; reached by cycles through branches alone, since dependencies are
/// evaluated first.
const DECLARATION_DEPTH: usize = 500;
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
pub(crate) struct Frame {
    /// The function.
    pub name: Name,
    /// Where it was called; its `expr` is the call.
    pub site: Site,
    /// The origin of the call, made when first asked for.
    pub origin: Origin,
}

/// What `name(` leads to, looked up once per name.
#[derive(Debug)]
pub(crate) enum Word {
    Unknown,
    Known { function: Option<&'static Builtin>, fields: Box<[&'static Builtin]> },
}

/// State of evaluation.
#[derive(Debug)]
pub struct Machine {
    pub(crate) modules: Vec<Module>,
    pub(crate) site: Site,
    pub(crate) locals: Vec<(Name, Value)>,
    pub(crate) base: usize,
    pub(crate) calls: Vec<Frame>,
    pub(crate) running: Vec<(ModuleId, u32)>,
    pub(crate) words: Vec<Word>,
    pub(crate) steps: u64,
    /// What a call may take.
    pub(crate) budget: Budget,
    /// Members of lists held.
    pub(crate) room: MemoryBudget,
    next_look: u64,
    pub(crate) depth: u32,
    pub(crate) in_within: bool,
    /// Number of the walk through dependencies.
    stamp: u32,
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
            words: Vec::new(),
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
            glued: std::collections::BTreeMap::new(),
        }
    }
}

fn place(site: Site, caller: Origin) -> Place {
    Place { module: site.module, declaration: site.declaration, member: site.member, expr: Some(site.expr), caller }
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

    /// Evaluates a declaration with everything it depends on, dependencies first, so that long chains stay flat.
    pub(crate) fn ensure_all(&mut self, module: ModuleId, declaration: u32) {
        let mut stack: Vec<(u32, usize)> = vec![(declaration, 0)];
        self.machine.stamp += 1;
        let stamp = self.machine.stamp;
        let script = self.machine.at(module).script.clone();
        while let Some((index, from)) = stack.pop() {
            if !matches!(self.machine.at(module).states[index as usize], State::Waiting) {
                continue;
            }
            let nodes = &script.declarations[index as usize].nodes;
            let next = (from..nodes.len()).find_map(|k| {
                let name = match &nodes[k].expr {
                    Expr::Name(name) | Expr::Call { name, .. } => *name,
                    _ => return None,
                };
                let found = self.machine.at(module).find(name)?;
                let waits = matches!(self.machine.at(module).states[found as usize], State::Waiting);
                let fresh = self.machine.at(module).entered[found as usize] != stamp;
                (waits && fresh && found != index).then_some((k, found))
            });
            match next {
                Some((k, found)) => {
                    self.machine.at_mut(module).entered[index as usize] = stamp;
                    stack.push((index, k + 1));
                    stack.push((found, 0));
                }
                None => {
                    let _ = self.ensure(module, index);
                }
            }
        }
    }

    /// The value of a declaration, evaluated on first use.
    pub(crate) fn ensure(&mut self, module: ModuleId, index: u32) -> Result<Value, Halt> {
        let sees = self.sees(module, index);
        if matches!(self.seen_as(module, index, sees).0, State::Waiting) && !self.recall(module, index, sees) {
            // Its own calls have their own budgets.
            return work::uncharged(|| self.evaluate(module, index, sees));
        }
        let (state, asked) = self.seen_as(module, index, sees);
        let answer = match state {
            State::Done(value) => Ok(value.clone()),
            State::Waiting => Err(Halt::Bug("a declaration that was neither evaluated nor taken over")),
            State::Failed => Err(Halt::Skipped(module, index)),
            State::Skipped(m, d) => Err(Halt::Skipped(*m, *d)),
            State::Suspended => Err(Halt::NotYet),
            State::Broken => Err(Halt::Broken),
            State::Running => return Err(self.cycle(module, index)),
        };
        self.machine.asked.join(asked);
        answer
    }

    fn evaluate(&mut self, module: ModuleId, index: u32, sees: Sees) -> Result<Value, Halt> {
        if self.machine.running.len() >= DECLARATION_DEPTH {
            return Err(self.cycle(module, index));
        }
        self.begin(module, index, sees);
        self.machine.running.push((module, index));
        let script = self.machine.at(module).script.clone();
        let declaration: &Declaration = &script.declarations[index as usize];
        let site = Site { module, declaration: index, member: [NO_MEMBER; 2], expr: ExprId(u32::MAX) };
        let site = std::mem::replace(&mut self.machine.site, site);
        let base = std::mem::replace(&mut self.machine.base, self.machine.locals.len());
        let calls = std::mem::take(&mut self.machine.calls);
        let sink = std::mem::take(&mut self.sink.reports);
        let start = self.start(module);
        let asked = std::mem::take(&mut self.machine.asked);
        let seen = std::mem::replace(&mut self.seen, Box3::EMPTY);
        let (depth, room) = (self.machine.depth, self.machine.room);

        let code = Code { nodes: &declaration.nodes, module, declaration: index };
        let job = self.job;
        let mut result = job.watch(|| self.declare(code, declaration)).unwrap_or_else(|fault| Err(fault.into()));
        if let Err(stop) = result {
            result = Err(self.settle(code, stop, declaration.span));
        }

        self.machine.depth = depth;
        self.machine.room.settle(room, result.as_ref().ok());
        self.machine.locals.truncate(self.machine.base);
        self.machine.base = base;
        self.machine.calls = calls;
        self.machine.site = site;
        self.machine.running.pop();
        let said = std::mem::replace(&mut self.sink.reports, sink);
        let failed = said.iter().any(|d| d.severity() == Severity::Error);
        let state = match &result {
            Ok(_) if failed => State::Failed,
            Ok(value) => State::Done(value.clone()),
            Err(Halt::Skipped(..) | Halt::NotYet | Halt::Broken) if failed => State::Failed,
            Err(Halt::Skipped(m, d)) => State::Skipped(*m, *d),
            Err(Halt::NotYet) => State::Suspended,
            Err(Halt::Broken) => State::Broken,
            Err(_) => State::Failed,
        };
        let waits = matches!(state, State::Suspended);
        let answer = match &state {
            State::Done(_) => result,
            State::Failed => Err(Halt::Skipped(module, index)),
            State::Skipped(m, d) => Err(Halt::Skipped(*m, *d)),
            State::Suspended => Err(Halt::NotYet),
            _ => Err(Halt::Broken),
        };
        let files = !waits && (sees == Sees::All || failed || !self.machine.asked.numbered);
        self.put_back((module, index), (state, sees), start, (asked, seen, &said));
        if files {
            self.machine.filed.extend(said.into_iter().map(|d| (Some((module, index)), d)));
        }
        answer
    }

    /// Ends what was counted for a declaration, keeps it for the next run, and goes on counting for the one around it.
    fn put_back(
        &mut self,
        (module, index): (ModuleId, u32),
        (state, sees): (State, Sees),
        start: Start,
        (around, seen, said): (Dependencies, Box3, &[Diagnostic]),
    ) {
        let mut asked = std::mem::replace(&mut self.machine.asked, around);
        let own_seen = std::mem::replace(&mut self.seen, seen);
        self.seen = self.seen.union(own_seen);
        self.remember((module, index), (&state, sees), start, asked, (own_seen, said));
        // Meshes are numbered anew in each run, so what holds one is not kept.
        asked.fleeting |= self.machine.at(module).script.declarations[index as usize].keyword == Keyword::Mesh;
        self.end(module, index, (state, sees), asked);
        self.machine.asked.join(asked);
        self.machine.asked.members += self.machine.room.held().saturating_sub(start.members);
        self.machine.asked.steps += self.machine.steps - start.steps;
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
            None => self.machine.at(code.module).script.declarations[code.declaration as usize].span,
        }
    }
}
