//! One evaluated script: its declarations, their states and what they have produced.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::base::digest::Digest;
use crate::lang::diag::diagnostic::FileId;
use crate::lang::diag::span::Span;
use crate::lang::eval::memory::{AskedFlags, Dependencies, Keys};
use crate::lang::eval::pipeline::{Parts, Sound};
use crate::lang::syntax::ast::{Allowed, Declaration, DeclarationKind, Expr, ExprId, Keyword, Script};
use crate::lang::values::plans::{CheckResult, ExportSpec, MeshSpec, PictureSpec, ReportTable};
use crate::lang::values::units::LengthUnit;
use crate::lang::values::value::{ModuleId, Value};
use crate::lang::words::names::Name;
use crate::mesh::Mesh;
use crate::model::Model;
use crate::network::Network;

/// How far a declaration is.
#[derive(Clone, Debug)]
pub(crate) enum State {
    /// Not asked for yet.
    Waiting,
    /// Being evaluated; being asked for now is a cycle.
    Running,
    /// Asked for the tolerance before it was known.
    Suspended,
    /// Evaluated.
    Done(Value),
    /// Reported.
    Failed,
    /// Depends on a declaration that failed.
    Skipped(ModuleId, u32),
    /// Depends on something reported elsewhere.
    Broken,
}

/// A stage that is made once.
#[derive(Clone, Debug)]
pub(crate) enum Stage<T> {
    /// Not asked for yet.
    Waiting,
    /// Being made.
    Running,
    /// Made.
    Done(T),
    /// Reported.
    Failed,
    /// A declaration it depends on failed.
    Skipped(ModuleId, u32),
}

/// A param set from outside: its value, or the text of a literal.
#[derive(Clone, Debug)]
pub(crate) enum Given {
    /// From `--set` or a table: the text of a literal, and where it stands.
    Text(Arc<str>, Written),
    /// From `use`: an evaluated value and where it stands.
    Value(Value, FileId, Span),
}

/// Where a param is set: in the text of a `--set`, or in a cell of a table.
#[derive(Clone, Debug)]
pub(crate) struct Written {
    /// The table, or a file that holds the text of the option.
    pub file: FileId,
    /// Its name: the head of the column.
    pub name: Span,
    /// Its value: the cell.
    pub value: Span,
    /// The column in words; `None` for an option.
    pub column: Option<String>,
    /// Row and column in words.
    pub cell: Option<String>,
}

/// One evaluated script.
#[derive(Debug)]
pub(crate) struct Module {
    /// Its text.
    pub file: FileId,
    /// Resolved path, for what it loads itself.
    pub path: Arc<str>,
    /// Its name in the script that uses it, empty for the main one.
    pub label: String,
    /// The `use` that made it.
    pub parent: Option<(ModuleId, u32)>,
    /// Its declarations.
    pub script: Arc<Script>,
    /// Its unit: what bare numbers are in.
    pub unit: LengthUnit,
    /// Declaration by name, plus one.
    by_name: Vec<u32>,
    /// Names of declarations that did not parse, sorted.
    broken: Vec<Name>,
    /// Words that params list as their choices, sorted.
    choices: Vec<Name>,
    /// State of each declaration.
    pub states: Vec<State>,
    /// Walk through dependencies that met a declaration last.
    pub entered: Vec<u32>,
    /// Params set from outside.
    pub given: Vec<(Name, Given)>,
    /// Tokens of each declaration as a digest, in a run with a memory.
    pub tokens: Vec<Digest>,
    /// Keys of the declarations, made when first asked for.
    pub keys: Option<Keys>,
    /// What each declaration asked for beside values.
    pub asked: Vec<AskedFlags>,
    /// Declarations whose patches and edges are numbered otherwise where geometry is made from them: as they are there.
    pub within: BTreeMap<u32, (State, Dependencies)>,
    pub parts: Stage<Arc<Parts>>,
    pub network: Stage<Arc<Network>>,
    pub model: Stage<Arc<Model>>,
    /// What is sound of the geometry, where some of it failed.
    pub sound: Stage<Sound>,
    /// A declaration that meshes were made without, as it failed.
    pub lacks: Option<(ModuleId, u32)>,
    /// Models of surfaces that are not all declared, or that curves and surfaces are made from, of which patches or edges were asked;
    /// with `true` those that stand on no network.
    pub annexes: Vec<(Arc<Model>, bool)>,
    pub meshes: Vec<Arc<MeshSpec>>,
    pub mesh_stages: Vec<Stage<Arc<Mesh>>>,
    pub checks: Vec<(u32, CheckResult)>,
    pub reports: Vec<(u32, ReportTable)>,
    pub exports: Vec<(u32, ExportSpec)>,
    pub pictures: Vec<(u32, PictureSpec)>,
}

impl Module {
    /// A script ready to be evaluated, and the pairs of declarations that bind the same name.
    pub fn new(file: FileId, path: Arc<str>, script: Arc<Script>, n_names: usize) -> (Self, Vec<(u32, u32)>) {
        let mut by_name = vec![0; n_names];
        let mut states = vec![State::Waiting; script.declarations.len()];
        let mut twice = Vec::new();
        for (i, state) in states.iter_mut().enumerate() {
            let Some(bound) = script.declarations.bound(i) else { continue };
            let slot: &mut u32 = &mut by_name[bound.name.index()];
            if *slot == 0 {
                *slot = i as u32 + 1;
            } else {
                twice.push((*slot - 1, i as u32));
                *state = State::Failed;
            }
        }
        let mut broken: Vec<Name> = script.broken.iter().map(|b| b.name).collect();
        broken.sort_unstable();
        let mut choices: Vec<Name> =
            script.declarations.with_keyword(Keyword::Param).flat_map(|at| choices(&script.declarations.whole(at))).collect();
        choices.sort_unstable();
        let module = Self {
            file,
            path,
            label: String::new(),
            parent: None,
            script,
            unit: crate::lang::values::units::MILLIMETRE,
            by_name,
            broken,
            choices,
            entered: vec![0; states.len()],
            asked: vec![AskedFlags::default(); states.len()],
            within: BTreeMap::new(),
            states,
            given: Vec::new(),
            tokens: Vec::new(),
            keys: None,
            parts: Stage::Waiting,
            network: Stage::Waiting,
            model: Stage::Waiting,
            sound: Stage::Waiting,
            lacks: None,
            annexes: Vec::new(),
            meshes: Vec::new(),
            mesh_stages: Vec::new(),
            checks: Vec::new(),
            reports: Vec::new(),
            exports: Vec::new(),
            pictures: Vec::new(),
        };
        (module, twice)
    }

    /// The declaration that binds a name.
    pub fn find(&self, name: Name) -> Option<u32> {
        self.by_name.get(name.index()).and_then(|i| i.checked_sub(1))
    }

    /// Whether a declaration of that name did not parse.
    pub fn is_broken(&self, name: Name) -> bool {
        self.broken.binary_search(&name).is_ok()
    }

    /// Whether some param lists this name among its choices.
    pub fn is_choice(&self, name: Name) -> bool {
        self.choices.binary_search(&name).is_ok()
    }

    /// All names bound here.
    pub fn names(&self) -> impl Iterator<Item = Name> + '_ {
        (0..self.script.declarations.len()).filter_map(|at| self.script.declarations.bound(at).map(|b| b.name))
    }
}

/// The words that a param lists as its choices.
fn choices(declaration: &Declaration) -> Vec<Name> {
    let items = match &declaration.kind {
        DeclarationKind::Param { allowed: Some(Allowed::Choices(items)), .. } => items.as_slice(),
        _ => &[],
    };
    let word = |id: &ExprId| match declaration.nodes[id.index()].expr {
        Expr::Name(name) => Some(name),
        _ => None,
    };
    items.iter().filter_map(word).collect()
}
