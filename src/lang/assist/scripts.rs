//! The scripts that a place in a text can refer to: that text, and the modules it uses, each read once.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use crate::lang::assist::shape::KnownType;
use crate::lang::diag::diagnostic::FileId;
use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::{Declaration, DeclarationKind, Keyword, Node, Script};
use crate::lang::syntax::outline::outline;
use crate::lang::syntax::parse;
use crate::lang::words::names::{Name, Names};

/// Gives path and text of the file that a script (its path first) names so in `use`.
pub type OpenFile<'o> = &'o dyn Fn(&str, &str) -> Option<(String, String)>;
/// What the last run showed of the names of the script.
pub type Known = BTreeMap<String, KnownType>;

/// Modules that are read at most.
const MODULES: usize = 64;

/// One script.
pub(crate) struct Unit {
    pub path: String,
    pub text: String,
    pub script: Script,
    pub names: Names,
    /// All names with their keywords, of broken declarations too; of two of a name the first counts.
    pub declared: BTreeMap<String, ScriptName>,
    /// Those names in order of writing.
    pub order: Vec<String>,
    /// All declarations, with the names they bind.
    pub spans: Vec<(Span, Option<Span>)>,
    pub shapes: RefCell<BTreeMap<usize, KnownType>>,
}

/// A name of a script.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScriptName {
    pub keyword: Keyword,
    /// Its declaration, when that is sound.
    pub declaration: Option<usize>,
}

impl Unit {
    fn new(path: String, text: String) -> Self {
        let mut names = Names::default();
        let (script, _) = parse(&text, FileId(0), &mut names);
        let (mut declared, mut order, mut spans) = (BTreeMap::new(), Vec::new(), Vec::new());
        for o in outline(&text) {
            spans.push((o.span, o.name));
            let (Some(keyword), Some(span)) = (o.keyword, o.name) else { continue };
            let name = &text[span.start as usize..span.end as usize];
            if !declared.contains_key(name) {
                declared.insert(name.to_owned(), ScriptName { keyword, declaration: None });
                order.push(name.to_owned());
            }
        }
        for at in (0..script.declarations.len()).rev() {
            let Some(bound) = script.declarations.bound(at) else { continue };
            let entry = ScriptName { keyword: script.declarations.keyword(at), declaration: Some(at) };
            declared.insert(names.text(bound.name).to_owned(), entry);
        }
        Self { path, text, script, names, declared, order, spans, shapes: RefCell::default() }
    }

    pub fn declaration(&self, name: &str) -> Option<(usize, Arc<Declaration>)> {
        let at = self.declared.get(name)?.declaration?;
        Some((at, self.script.declarations.whole(at)))
    }

    /// A declaration's text.
    pub fn source(&self, start: u32, end: u32) -> &str {
        self.text.get(start as usize..end as usize).unwrap_or("")
    }
}

/// Expressions with the names they are written in.
#[derive(Clone, Copy)]
pub(crate) struct NamedExpressions<'c> {
    /// The script whose names they see.
    pub unit: usize,
    pub names: &'c Names,
    pub nodes: &'c [Node],
}

impl NamedExpressions<'_> {
    pub fn text(&self, name: Name) -> &str {
        self.names.text(name)
    }
}

/// Names of `for`, `let … in` and parameters, the innermost last.
pub(crate) type Locals = Vec<(String, KnownType)>;

/// All scripts at hand.
pub(crate) struct Scripts<'o> {
    units: RefCell<Vec<Rc<Unit>>>,
    open: OpenFile<'o>,
    known: &'o Known,
    /// How deep the search for a type is.
    pub depth: Cell<u32>,
}

impl<'o> Scripts<'o> {
    /// The main script is the first.
    pub fn new(text: &str, path: &str, open: OpenFile<'o>, known: &'o Known) -> Self {
        let main = Rc::new(Unit::new(path.to_owned(), text.to_owned()));
        Self { units: RefCell::new(vec![main]), open, known, depth: Cell::new(0) }
    }

    pub fn unit(&self, at: usize) -> Rc<Unit> {
        let units = self.units.borrow();
        units.get(at).unwrap_or(&units[0]).clone()
    }

    /// What the last run showed of a name of the main script.
    pub fn last_run(&self, unit: usize, name: &str) -> KnownType {
        self.known.get(name).filter(|_| unit == 0).cloned().unwrap_or_default()
    }

    /// The module that a script names so.
    pub fn module(&self, from: usize, written: &str) -> Option<usize> {
        let (path, text) = (self.open)(&self.unit(from).path, written)?;
        if let Some(at) = self.units.borrow().iter().position(|unit| unit.path == path) {
            return Some(at);
        }
        let at = self.units.borrow().len();
        (at < MODULES).then(|| self.units.borrow_mut().push(Rc::new(Unit::new(path, text))))?;
        Some(at)
    }

    /// An expression written somewhere in a script.
    pub fn shape_of_text(&self, unit: usize, text: &str, locals: &mut Locals) -> KnownType {
        let mut names = Names::default();
        let (script, _) = parse(&format!("let x = {text}"), FileId(0), &mut names);
        let Some(declaration) = script.declarations.iter().next() else { return KnownType::Unknown };
        let DeclarationKind::Value { value, .. } = &declaration.kind else { return KnownType::Unknown };
        self.shape(NamedExpressions { unit, names: &names, nodes: &declaration.nodes }, *value, locals)
    }
}
