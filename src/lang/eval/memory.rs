//! What one run leaves for the next: values of declarations under keys made of all that they depend on.
//!
//! A value is taken over when its key is the same, and with it what was said, what it adds to the box that decides the
//! tolerance, and the origins of its entities, which stay valid because declarations keep their homes. Nothing else
//! is assumed: a run with a memory gives the same bits as one without.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::base::bbox::Box3;
use crate::base::digest::{Digest, StableHasher};
use crate::base::tolerance::Tolerance;
use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::diag::span::Span;
use crate::lang::eval::module::State;
use crate::lang::values::origins::{Home, Origins};
use crate::lang::values::plans::{CheckResult, MeshSpec, ReportTable};
use crate::lang::values::value::{ModuleId, Value};
use crate::lang::words::names::Names;

/// Entries that are kept whatever the size of the model, so that going back and forth between two states costs nothing.
const ENTRIES: usize = 10_000;
/// Entries kept for each one that the last run used.
const HISTORY: usize = 4;
/// Origins at which everything is forgotten; a model of a million entities makes about two million in a run.
const ORIGINS: usize = 50_000_000;

/// What is kept between runs; empty before the first one.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    pub(crate) names: Names,
    pub(crate) origins: Origins,
    homes: BTreeMap<Digest, Home>,
    entries: BTreeMap<Digest, MemoryEntry>,
    /// Names of the scripts in order of their numbers: values may hold such numbers.
    modules: Vec<String>,
    run: u64,
    reused: usize,
}

/// One declaration as it was evaluated.
#[derive(Clone, Debug, Default)]
pub(crate) struct MemoryEntry {
    /// It asked for the tolerance before that was known, having added this to the box.
    pub suspended: Option<Box3>,
    /// Its value.
    pub kept: Option<Kept>,
    used: u64,
}

/// A value with everything its evaluation did beside making it.
#[derive(Clone, Debug)]
pub(crate) struct Kept {
    pub value: Value,
    /// Added to the box that decides the tolerance.
    pub seen: Box3,
    /// The tolerance, when it was known by then.
    pub tolerance: Option<Tolerance>,
    /// Key of all geometry, when a stage was asked for.
    pub world: Option<Digest>,
    /// Whether it depends on where it is asked for.
    pub numbered: bool,
    /// Notes and warnings, places counted from the start of the declaration.
    pub said: Vec<Diagnostic>,
    /// Digest of its text, when what was said or written depends on more than the tokens.
    pub text: Option<Digest>,
    pub checks: Vec<CheckResult>,
    pub reports: Vec<ReportTable>,
    pub meshes: Vec<Arc<MeshSpec>>,
    /// List members and steps that it took itself.
    pub members: usize,
    pub steps: u64,
}

impl Kept {
    /// A value alone.
    pub(crate) fn of(value: Value) -> Self {
        Self {
            value,
            seen: Box3::EMPTY,
            tolerance: None,
            world: None,
            numbered: false,
            said: Vec::new(),
            text: None,
            checks: Vec::new(),
            reports: Vec::new(),
            meshes: Vec::new(),
            members: 0,
            steps: 0,
        }
    }
}

impl Memory {
    /// Begins a run: nothing stands anywhere yet.
    pub(crate) fn begin(&mut self) {
        if self.origins.len() > ORIGINS {
            *self = Self::default();
        }
        self.run += 1;
        self.reused = 0;
        self.origins.leave();
    }

    /// Ends a run: what was not used for long is forgotten.
    pub(crate) fn end(&mut self) {
        let live = self.entries.values().filter(|e| e.used == self.run).count();
        let allowed = (HISTORY * live).max(ENTRIES);
        let Some(surplus) = self.entries.len().checked_sub(allowed).filter(|n| *n > 0) else { return };
        let mut ages: Vec<u64> = self.entries.values().map(|e| e.used).collect();
        ages.sort_unstable();
        let oldest = ages[surplus - 1].min(self.run - 1);
        self.entries.retain(|_, e| e.used > oldest);
    }

    /// The home of a declaration under the digest of its identity.
    pub(crate) fn home(&mut self, identity: Digest, origins: &mut Origins) -> Home {
        *self.homes.entry(identity).or_insert_with(|| origins.new_home())
    }

    /// Says which script has a number; when it was another one before, all values are forgotten.
    pub(crate) fn enter(&mut self, module: ModuleId, label: &str) {
        match self.modules.get(module.index()) {
            Some(before) if before == label => {}
            Some(_) => {
                self.entries.clear();
                self.modules.truncate(module.index());
                self.modules.push(label.to_owned());
            }
            None => self.modules.push(label.to_owned()),
        }
    }

    /// The entry of a key, marked as used.
    pub(crate) fn find(&mut self, key: Digest) -> Option<&MemoryEntry> {
        let entry = self.entries.get_mut(&key)?;
        entry.used = self.run;
        Some(entry)
    }

    /// The digest of the text that an entry depends on beyond its key.
    pub(crate) fn text_of(&self, key: Digest) -> Option<Digest> {
        self.entries.get(&key)?.kept.as_ref()?.text
    }

    /// Keeps what became of a declaration.
    pub(crate) fn keep(&mut self, key: Digest, kept: Kept) {
        let entry = self.entries.entry(key).or_default();
        entry.used = self.run;
        entry.kept = Some(kept);
    }

    /// The value kept under a key.
    pub(crate) fn value_of(&mut self, key: Digest) -> Option<Value> {
        Some(self.find(key)?.kept.as_ref()?.value.clone())
    }

    /// Keeps a value that came about without an evaluation.
    pub(crate) fn keep_value(&mut self, key: Digest, value: Value) {
        self.keep(key, Kept::of(value));
    }

    /// Keeps that a declaration waits for the tolerance.
    pub(crate) fn suspend(&mut self, key: Digest, seen: Box3) {
        let entry = self.entries.entry(key).or_default();
        entry.used = self.run;
        entry.suspended = Some(seen);
    }

    pub(crate) fn count_reused(&mut self) {
        self.reused += 1;
    }

    /// Declarations whose value was taken over in the last run.
    pub fn reused(&self) -> usize {
        self.reused
    }
}

/// What was said with places counted from `start`; `None` when it speaks of places outside the stretch.
pub(crate) fn detached(said: &[Diagnostic], file: FileId, span: Span) -> Option<Vec<Diagnostic>> {
    let inside = |f: FileId, s: Span| f == file && s.start >= span.start && s.end <= span.end;
    let all_inside = |d: &Diagnostic| d.labels.iter().all(|l| inside(l.file, l.span)) && d.fixes.iter().all(|f| inside(f.file, f.span));
    let moved = |_, s: Span| (file, Span { start: s.start - span.start, end: s.end - span.start });
    said.iter().all(all_inside).then(|| said.iter().map(|d| d.moved(moved)).collect())
}

/// The opposite of [`detached`].
pub(crate) fn attached(said: &[Diagnostic], file: FileId, start: u32) -> Vec<Diagnostic> {
    let moved = |_, s: Span| (file, Span { start: s.start + start, end: s.end + start });
    said.iter().map(|d| d.moved(moved)).collect()
}

/// What is kept of the [`Dependencies`] of each declaration.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AskedFlags {
    world: bool,
    fleeting: bool,
    pub numbered: bool,
}

impl From<Dependencies> for AskedFlags {
    fn from(of: Dependencies) -> Self {
        Self { world: of.world, fleeting: of.fleeting, numbered: of.numbered }
    }
}

impl From<AskedFlags> for Dependencies {
    fn from(of: AskedFlags) -> Self {
        Self { world: of.world, fleeting: of.fleeting, numbered: of.numbered, ..Self::default() }
    }
}

/// What an evaluation asked for beside the values of other declarations.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Dependencies {
    /// The network, the surface model or another stage of its own script.
    pub world: bool,
    /// Something that is not kept: a mesh, a stage of another script.
    pub fleeting: bool,
    /// Patches, edges or vertices of surfaces, which geometry that is made from them numbers by itself.
    pub numbered: bool,
    /// List members and steps of the declarations evaluated inside it.
    pub members: usize,
    pub steps: u64,
}

impl Dependencies {
    /// Takes over what a declaration depended on that this one uses.
    pub fn join(&mut self, other: Self) {
        self.world |= other.world;
        self.fleeting |= other.fleeting;
        self.numbered |= other.numbered;
    }
}

/// Keys of a script, made once per run.
#[derive(Clone, Debug)]
pub(crate) struct Keys {
    /// Of each declaration; `None` where it cannot have one.
    pub of: Arc<[Option<Digest>]>,
    /// Of all geometry together.
    pub world: Option<Digest>,
}

/// How far counters were when an evaluation began.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub members: usize,
    pub steps: u64,
    pub checks: usize,
    pub reports: usize,
    pub meshes: usize,
}

/// An evaluation of a declaration that has ended.
pub(crate) struct Ended<'a> {
    pub module: ModuleId,
    pub index: u32,
    pub state: State,
    pub sees: Sees,
    pub start: Start,
    /// Reports made on the way.
    pub said: &'a [Diagnostic],
}

/// Which surfaces a declaration sees while it is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sees {
    /// Those of the whole script.
    All,
    /// Those that it names: geometry is being made from it.
    Own,
}

impl Sees {
    /// The key under which a value that depends on this is kept.
    pub fn key(self, key: Digest) -> Digest {
        match self {
            Self::All => key,
            Self::Own => StableHasher::new("within").with(&key).finish(),
        }
    }
}
