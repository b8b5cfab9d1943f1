//! Declarations evaluated on demand, each once, with what they depend on.

use crate::base::bbox::Box3;
use crate::base::fault::Severity;
use crate::base::work::{self};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, DECLARATION_DEPTH, Site};
use crate::lang::eval::memory::Dependencies;
use crate::lang::eval::memory::Ended;
use crate::lang::eval::memory::Sees;
use crate::lang::eval::module::State;
use crate::lang::syntax::ast::{Declaration, ExprId, Keyword};
use crate::lang::values::origins::NO_MEMBER;
use crate::lang::values::value::{ModuleId, Value};

impl Cx<'_> {
    /// Evaluates a declaration with everything it depends on, dependencies first, so that long chains stay flat.
    pub(crate) fn ensure_all(&mut self, module: ModuleId, declaration: u32) {
        let (mut at, mut stack) = (Some((declaration, 0)), Vec::new());
        self.machine.stamp += 1;
        let stamp = self.machine.stamp;
        let script = self.machine.at(module).script.clone();
        while let Some((index, from)) = at.take().or_else(|| stack.pop()) {
            if !matches!(self.machine.at(module).states[index as usize], State::Waiting) {
                continue;
            }
            let next = script.declarations.find_use(index as usize, from, |name| {
                let found = self.machine.at(module).find(name)?;
                let waits = matches!(self.machine.at(module).states[found as usize], State::Waiting);
                let fresh = self.machine.at(module).entered[found as usize] != stamp;
                (waits && fresh && found != index).then_some(found)
            });
            match next {
                Some((behind, found)) => {
                    self.machine.at_mut(module).entered[index as usize] = stamp;
                    stack.push((index, behind));
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
        let declaration: &Declaration = &script.declarations.whole(index as usize);
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
        self.put_back(Ended { module, index, state, sees, start, said: &said }, asked, seen);
        if files {
            self.machine.filed.extend(said.into_iter().map(|d| (Some((module, index)), d)));
        }
        answer
    }

    /// Ends what was counted for a declaration, keeps it for the next run, and goes on counting for the one around it.
    fn put_back(&mut self, ended: Ended, asked_around: Dependencies, seen_around: Box3) {
        let mut asked = std::mem::replace(&mut self.machine.asked, asked_around);
        let seen = std::mem::replace(&mut self.seen, seen_around);
        self.seen = self.seen.union(seen);
        self.remember(&ended, asked, seen);
        let Ended { module, index, state, sees, start, .. } = ended;
        // Meshes are numbered anew in each run, so what holds one is not kept.
        asked.fleeting |= self.machine.at(module).script.declarations.keyword(index as usize) == Keyword::Mesh;
        self.end(module, index, state, sees, asked);
        self.machine.asked.join(asked);
        self.machine.asked.members += self.machine.room.held().saturating_sub(start.members);
        self.machine.asked.steps += self.machine.steps - start.steps;
    }
}
