//! Taking over what the run before found, and keeping what this one finds.

use crate::lang::eval::memory::Start;
use std::sync::Arc;

use crate::base::bbox::Box3;
use crate::base::digest::Digest;
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::eval::context::Cx;
use crate::lang::eval::machine::Machine;
use crate::lang::eval::memory::Sees;
use crate::lang::eval::memory::{Dependencies, Ended, Kept, Memory, attached, detached};
use crate::lang::eval::module::{Stage, State};
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::value::{MeshValue, ModuleId, Value};

/// What a run leaves that is of no more use. To give its memory back piece by piece takes a tenth of a run over 10^5 declarations, which a
/// program that ends may save.
#[derive(Debug, Default)]
pub struct Remains {
    /// Declarations and their values.
    pub machine: Option<Box<Machine>>,
    /// Of a run that nothing is taken over from.
    pub memory: Option<Box<Memory>>,
}

impl Cx<'_> {
    /// Works with what earlier runs found; to be called before [`Cx::load`].
    pub fn recall_from(&mut self, mut memory: Memory) {
        memory.begin();
        self.program.names = std::mem::take(&mut memory.names);
        self.program.origins = std::mem::take(&mut memory.origins);
        self.memory = Some(memory);
    }

    /// What the next run may take over, empty when this one worked without, and what is of no more use.
    pub fn into_memory(mut self) -> (Memory, Remains) {
        let mut memory = self.memory.take().unwrap_or_default();
        memory.end();
        memory.names = self.program.names;
        memory.origins = self.program.origins;
        (memory, Remains { machine: Some(Box::new(self.machine)), ..Remains::default() })
    }

    /// Brings a declaration to the state in which the run before left it; `false` when it must be evaluated.
    pub(crate) fn recall(&mut self, module: ModuleId, index: u32, sees: Sees) -> bool {
        if self.memory.is_none() {
            return false;
        }
        let keys = self.keys(module);
        let (Some(key), tolerance) = (keys.of[index as usize], self.tolerance) else { return false };
        let Some(memory) = &mut self.memory else { return false };
        let fits = |kept: &&Kept| {
            (kept.tolerance.is_none() || kept.tolerance == tolerance) && kept.world.is_none_or(|world| Some(world) == keys.world)
        };
        if sees == Sees::Own
            && let Some(kept) = memory.find(sees.key(key)).and_then(|entry| entry.kept.as_ref()).filter(fits).cloned()
        {
            memory.count_reused();
            self.restore_within(module, index, kept);
            return true;
        }
        let Some(entry) = memory.find(key) else { return false };
        match entry.kept.as_ref().filter(fits).filter(|kept| sees == Sees::All || !kept.numbered) {
            Some(kept) => {
                let kept = kept.clone();
                memory.count_reused();
                self.restore(module, index, kept);
                true
            }
            None => match entry.suspended {
                Some(seen) if tolerance.is_none() => {
                    self.seen = self.seen.union(seen);
                    self.machine.at_mut(module).states[index as usize] = State::Suspended;
                    true
                }
                _ => false,
            },
        }
    }

    fn restore_within(&mut self, module: ModuleId, index: u32, kept: Kept) {
        if self.tolerance.is_none() {
            self.seen = self.seen.union(kept.seen);
        }
        self.machine.room.take_over(kept.members);
        self.machine.steps += kept.steps;
        let asked = Dependencies { world: kept.world.is_some(), numbered: true, ..Dependencies::default() };
        self.machine.at_mut(module).within.insert(index, (State::Done(kept.value), asked));
    }

    fn restore(&mut self, module: ModuleId, index: u32, kept: Kept) {
        if self.tolerance.is_none() {
            self.seen = self.seen.union(kept.seen);
        }
        self.machine.room.take_over(kept.members);
        self.machine.steps += kept.steps;
        let m = &mut self.machine.modules[module.index()];
        let span = m.script.declarations.span(index as usize);
        let said = attached(&kept.said, m.file, span.start);
        let fleeting = m.script.declarations.keyword(index as usize) == Keyword::Mesh;
        m.asked[index as usize] =
            Dependencies { world: kept.world.is_some(), fleeting, numbered: kept.numbered, ..Dependencies::default() }.into();
        let mut next = m.meshes.len() as u32;
        m.states[index as usize] = State::Done(if fleeting { numbered(&kept.value, module, &mut next) } else { kept.value });
        m.meshes.extend(kept.meshes);
        m.mesh_stages.resize_with(m.meshes.len(), || Stage::Waiting);
        for mut check in kept.checks {
            check.file = m.file;
            check.span.start += span.start;
            check.span.end += span.start;
            m.checks.push((index, check));
        }
        m.reports.extend(kept.reports.into_iter().map(|table| (index, table)));
        self.machine.filed.extend(said.into_iter().map(|d| (Some((module, index)), d)));
    }

    /// Counters before an evaluation.
    pub(crate) fn start(&self, module: ModuleId) -> Start {
        let m = self.machine.at(module);
        let machine = &self.machine;
        Start {
            members: machine.room.held(),
            steps: machine.steps,
            checks: m.checks.len(),
            reports: m.reports.len(),
            meshes: m.meshes.len(),
        }
    }

    /// Keeps the state that an evaluation ended in, where the next run may take it over.
    pub(crate) fn remember(&mut self, ended: &Ended, asked: Dependencies, seen: Box3) {
        let Ended { module, index, sees, start, said, .. } = *ended;
        if self.memory.is_none() {
            return;
        }
        let keys = self.keys(module);
        let Some(key) = keys.of[index as usize] else { return };
        let key = if asked.numbered { sees.key(key) } else { key };
        match &ended.state {
            State::Suspended if !asked.fleeting => {
                if let Some(memory) = &mut self.memory {
                    memory.suspend(key, seen);
                }
            }
            State::Done(value) if !asked.fleeting => {
                let value = value.clone();
                let world = if asked.world { keys.world } else { None };
                if asked.world && world.is_none() {
                    return;
                }
                if let Some(kept) = self.kept(module, index, start, asked, said) {
                    let kept = Kept { value, seen, world, numbered: asked.numbered, ..kept };
                    if let Some(memory) = &mut self.memory {
                        memory.keep(key, kept);
                    }
                }
            }
            _ => {}
        }
    }

    /// What an evaluation did beside making a value; `None` when that cannot be repeated.
    fn kept(&self, module: ModuleId, index: u32, start: Start, asked: Dependencies, said: &[Diagnostic]) -> Option<Kept> {
        let m = self.machine.at(module);
        let keyword = m.script.declarations.keyword(index as usize);
        match keyword {
            // These make more than a value.
            Keyword::Use | Keyword::Export | Keyword::Picture => return None,
            _ => {}
        }
        let span = m.script.declarations.span(index as usize);
        let own = |n: &u32| *n == index;
        let mut checks: Vec<_> = m.checks[start.checks..].iter().filter(|c| own(&c.0)).map(|c| c.1.clone()).collect();
        for check in &mut checks {
            check.span.start = check.span.start.checked_sub(span.start)?;
            check.span.end = check.span.end.checked_sub(span.start)?;
        }
        let reports: Vec<_> = m.reports[start.reports..].iter().filter(|r| own(&r.0)).map(|r| r.1.clone()).collect();
        let text: Option<Digest> = (!said.is_empty() || !checks.is_empty() || !reports.is_empty()).then(|| self.text_key(module, index));
        Some(Kept {
            tolerance: self.tolerance,
            said: detached(said, m.file, span)?,
            text,
            checks,
            reports,
            meshes: if keyword == Keyword::Mesh { m.meshes[start.meshes..].to_vec() } else { Vec::new() },
            members: self.machine.room.held().saturating_sub(start.members).saturating_sub(asked.members),
            steps: (self.machine.steps - start.steps).saturating_sub(asked.steps),
            ..Kept::of(Value::None)
        })
    }
}

/// The value of a `mesh` declaration with its meshes numbered from `next` on.
fn numbered(value: &Value, module: ModuleId, next: &mut u32) -> Value {
    match value {
        Value::List(items) => Value::list(items.iter().map(|item| numbered(item, module, next)).collect()),
        Value::Mesh(_) => {
            *next += 1;
            Value::Mesh(Arc::new(MeshValue::Declared { module, index: *next - 1 }))
        }
        other => other.clone(),
    }
}
