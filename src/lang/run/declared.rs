//! The values that a script declares, member by member, each with the lines that made it; and its params.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::base::origin::Origin;
use crate::lang::diag::diagnostic::FileId;
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::module::State;
use crate::lang::eval::stages::each_member;
use crate::lang::run::symbols::{Condition, Symbol};
use crate::lang::syntax::ast::{Allowed, Declaration, DeclarationKind, Expr, ExprId, Keyword};
use crate::lang::values::value::{MeshValue, ModuleId, Quantity, Value};

/// Keywords of declarations that bind something which can be drawn.
const DRAWN: &[Keyword] = &[
    Keyword::Point,
    Keyword::Curve,
    Keyword::ModelingCurve,
    Keyword::Surface,
    Keyword::Shell,
    Keyword::Mesh,
    Keyword::Group,
    Keyword::Let,
    Keyword::Import,
];

/// Params, and what a script draws without its meshes.
const SHAPES: &[Keyword] = &[
    Keyword::Use,
    Keyword::Param,
    Keyword::Import,
    Keyword::Point,
    Keyword::Curve,
    Keyword::ModelingCurve,
    Keyword::Surface,
    Keyword::Shell,
];

/// A stretch of one of the run's files.
pub type Stretch = (FileId, Span);

/// A member of a declaration.
#[derive(Clone, Debug)]
pub struct DeclaredValue {
    /// `roof`, `ribs[2]`.
    pub name: Arc<str>,
    /// Its declaration, by its place in the script.
    pub declaration: usize,
    /// The word that declares it.
    pub keyword: Keyword,
    /// Its value.
    pub value: Value,
    /// Its declaration, then the calls and definitions that it went through, each on a line of its own.
    pub lines: Vec<Stretch>,
}

/// A param of the main script.
#[derive(Clone, Debug)]
pub struct DeclaredParam {
    /// Its name.
    pub name: String,
    /// Its value; `None` where it failed.
    pub value: Option<Value>,
    /// Least and largest value, where written as literals.
    pub range: Option<(Quantity, Quantity)>,
    /// Values that it may have, as written.
    pub choices: Vec<String>,
    /// Whether it was set from outside.
    pub set: bool,
    /// Its default, as written.
    pub default: Stretch,
}

impl Cx<'_> {
    /// Evaluates the params, geometry and shells of the main script.
    pub(super) fn evaluate_shapes(&mut self) {
        for i in SHAPES.iter().flat_map(|keyword| self.heads(ModuleId::MAIN, *keyword)).collect::<Vec<u32>>() {
            if self.job.go_on().is_err() {
                return;
            }
            if matches!(self.machine.at(ModuleId::MAIN).states[i as usize], State::Waiting) {
                self.ensure_all(ModuleId::MAIN, i);
            }
        }
    }

    /// What the main script declares and has a value, in order of writing; `symbols` are all its declarations.
    pub fn declared_values(&self, symbols: &[Symbol]) -> Vec<DeclaredValue> {
        let Some(module) = self.machine.modules.first() else { return Vec::new() };
        let mut out = Vec::new();
        each_member(module, &self.program.names, DRAWN, &mut |index, keyword, _, name, value| {
            let lines = self.lines_of(index as usize, self.origin_of(value), symbols);
            out.push(DeclaredValue { name, declaration: index as usize, keyword, value: value.clone(), lines });
        });
        out
    }

    /// The texts of the script and of the modules that it uses.
    pub fn script_files(&self) -> Vec<FileId> {
        self.machine.modules.iter().map(|module| module.file).collect()
    }

    /// Names that the main script declares and that have no value, each with its place.
    pub fn declared_without_value(&self, symbols: &[Symbol]) -> Vec<(String, Stretch)> {
        let Some(module) = self.machine.modules.first() else { return Vec::new() };
        let failed = symbols.iter().filter(|symbol| symbol.condition != Condition::Sound);
        let broken = module.script.broken.iter().map(|b| (self.program.names.text(b.name).to_owned(), (module.file, b.span)));
        failed.filter_map(|symbol| Some((symbol.name.clone()?, (symbol.file, symbol.span)))).chain(broken).collect()
    }

    /// Where a value was made.
    fn origin_of(&self, value: &Value) -> Origin {
        match value {
            Value::Curve(chain) => chain.origin(),
            Value::Surface(surface) => surface.origin(),
            Value::Shell(shell) => shell.origin,
            Value::Mesh(mesh) => match &**mesh {
                MeshValue::Data(_, origin) => *origin,
                MeshValue::Declared { module, index } => self.meshes(*module).get(*index as usize).map_or(Origin::NONE, |m| m.origin),
            },
            _ => Origin::NONE,
        }
    }

    /// The declaration of the main script, then the lines that an origin leads to: the outermost call first, the expression that made
    /// the thing last. What stands on the line before it is left out.
    fn lines_of(&self, declaration: usize, origin: Origin, symbols: &[Symbol]) -> Vec<Stretch> {
        let Some(main) = self.machine.modules.first() else { return Vec::new() };
        let mut made = Vec::new();
        let mut at = origin;
        while let Some(place) = self.program.origins.place(at) {
            made.extend(self.span_of(at));
            // A script that was used is entered by the line that uses it.
            if self.program.origins.place(place.caller).is_none_or(|caller| caller.module != place.module) {
                let mut module = place.module;
                while let Some((user, index)) = self.machine.modules.get(module.index()).and_then(|m| m.parent) {
                    let user_script = self.machine.at(user);
                    made.push((user_script.file, user_script.script.declarations.span(index as usize)));
                    module = user;
                }
            }
            at = place.caller;
        }
        // A name that is bound is made anew; the functions and modules that it went through are those that its declaration names.
        self.named_by(declaration, symbols, &mut BTreeSet::new(), &mut made);
        let mut lines = vec![(main.file, main.script.declarations.span(declaration))];
        let line = |(file, span): Stretch| (file, self.program.sources.place(file, span.start).map(|place| place.line));
        for place in made.into_iter().rev() {
            if lines.iter().all(|known| line(*known) != line(place)) {
                lines.push(place);
            }
        }
        lines
    }

    /// The definitions that a declaration names, and those that these name: the innermost first. Of a module the line that uses it stands
    /// behind the declaration in it that is asked for.
    fn named_by(&self, declaration: usize, symbols: &[Symbol], seen: &mut BTreeSet<usize>, made: &mut Vec<Stretch>) {
        let Some(main) = self.machine.modules.first() else { return };
        for needed in symbols.get(declaration).map_or(&[][..], |symbol| &symbol.needs) {
            let Some(symbol) = symbols.get(*needed) else { continue };
            match symbol.keyword {
                Keyword::Fn if !seen.insert(*needed) => continue,
                Keyword::Fn => self.named_by(*needed, symbols, seen, made),
                Keyword::Use => made.extend(self.asked_of(main.script.declarations.get(declaration).as_deref(), *needed)),
                _ => continue,
            }
            made.push((symbol.file, symbol.span));
        }
    }

    /// The declarations of a module that an expression asks for, the last first: `panel` of `bay.panel`, `stay` of `bay.stay(1m)`.
    fn asked_of(&self, declaration: Option<&Declaration>, used: usize) -> Vec<Stretch> {
        let bound = self.machine.modules.first().and_then(|main| main.script.declarations.bound(used));
        let (Some(module), Some(bound), Some(declaration)) = (self.loaded_by(ModuleId::MAIN, used as u32), bound, declaration) else {
            return Vec::new();
        };
        let (module, nodes) = (self.machine.at(module), &declaration.nodes);
        let is_module = |id: &ExprId| matches!(nodes.get(id.index()).map(|n| &n.expr), Some(Expr::Name(name)) if *name == bound.name);
        let asked = nodes.iter().rev().filter_map(|node| match &node.expr {
            Expr::Field { of, name, .. } | Expr::Call { of: Some(of), name, .. } if is_module(of) => module.find(*name),
            _ => None,
        });
        asked.map(|index| (module.file, module.script.declarations.span(index as usize))).collect()
    }

    /// The params of the main script, in order of writing.
    pub fn declared_params(&self) -> Vec<DeclaredParam> {
        let Some(module) = self.machine.modules.first() else { return Vec::new() };
        let mut out = Vec::new();
        for index in module.script.declarations.with_keyword(Keyword::Param) {
            let declaration = module.script.declarations.whole(index);
            let DeclarationKind::Param { bound, value, allowed, .. } = &declaration.kind else { continue };
            let text = |id: ExprId| self.program.sources.text(module.file, declaration.nodes[id.index()].span).to_owned();
            let number = |id: ExprId| match self.literal_value(&declaration.nodes, id) {
                Some(Value::Number(q)) => Some(q),
                _ => None,
            };
            let (range, choices) = match allowed {
                Some(Allowed::Range(low, high)) => (number(*low).zip(number(*high)), Vec::new()),
                Some(Allowed::Choices(items)) => (None, items.iter().map(|id| text(*id)).collect()),
                None => (None, Vec::new()),
            };
            let name = self.program.names.text(bound.name).to_owned();
            let value_now = self.value_of(&name);
            let set = module.given.iter().any(|given| given.0 == bound.name);
            out.push(DeclaredParam {
                name,
                value: value_now,
                range,
                choices,
                set,
                default: (module.file, declaration.nodes[value.index()].span),
            });
        }
        out
    }
}
