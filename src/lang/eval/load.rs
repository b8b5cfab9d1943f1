//! `use "ribs.loft" (height: 3m) as ribs`: modules, and reading files for them and for imports.

use std::sync::Arc;

use crate::base::limits;
use crate::base::origin::Origin;
use crate::io::FileError;
use crate::io::files::access::unfit_name;
use crate::io::files::fault::{AccessFault, ContentFault};
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::eval::module::{Given, Module};
use crate::lang::syntax::ast::{Arg, Bound, DeclarationKind, Expr, ExprId, Keyword, TextPart};
use crate::lang::values::units;
use crate::lang::values::value::{ModuleId, Value};

impl Cx<'_> {
    /// Adds a script as a module: parsed, its units known, its names bound once. `place` is the module that it stands for anew.
    pub(crate) fn add_module(&mut self, name: &str, path: &str, text: Arc<str>, label: String, place: Option<ModuleId>) -> ModuleId {
        let file = self.program.sources.add(name, Arc::clone(&text));
        let (script, mistakes) = crate::lang::syntax::parse_shared(&text, file, &mut self.program.names);
        self.machine.filed.extend(mistakes.into_iter().map(|d| (None, d)));
        let (module, twice) = Module::new(file, path.into(), Arc::new(script), self.program.names.len());
        let id = place.unwrap_or_else(|| ModuleId::at(self.machine.modules.len()));
        match self.machine.modules.get_mut(id.index()) {
            Some(before) => *before = module,
            None => self.machine.modules.push(module),
        }
        self.settle_in(id, &label);
        self.machine.at_mut(id).label = label;
        self.set_unit(id);
        let script = self.machine.at(id).script.clone();
        for (first, second) in twice {
            let bound = |i: u32| script.declarations.bound(i as usize);
            let (Some(a), Some(b)) = (bound(first), bound(second)) else { continue };
            let text = self.program.names.text(b.name);
            let diagnostic = Diagnostic::new("E202", format!("`{text}` is defined twice"), file, b.span, "again here")
                .label(file, a.span, "first here")
                .help(format!("another name: `{text}_2`"))
                .put(b.span, format!("{text}_2"));
            self.machine.filed.push((Some((id, second)), diagnostic));
        }
        id
    }

    /// Finds the `units` of a script.
    fn set_unit(&mut self, id: ModuleId) {
        let script = self.machine.at(id).script.clone();
        let file = self.machine.at(id).file;
        let mut found: Option<Bound> = None;
        for i in script.declarations.with_keyword(Keyword::Units) {
            let DeclarationKind::Units(bound) = script.declarations.whole(i).kind else { continue };
            let owner = Some((id, i as u32));
            let text = self.program.names.text(bound.name).to_owned();
            if let Some(first) = found {
                let diagnostic = Diagnostic::new("E202", "`units` may be declared only once", file, bound.span, "again here").label(
                    file,
                    first.span,
                    "first here",
                );
                self.machine.filed.push((owner, diagnostic));
                continue;
            }
            found = Some(bound);
            match units::length_unit(&text) {
                Some(unit) => self.machine.at_mut(id).unit = unit,
                None => {
                    let known: Vec<&str> = units::LENGTHS.iter().map(|u| u.name).collect();
                    let meant =
                        crate::lang::syntax::number::meant(&text).and_then(|meant| units::length_unit(&meant)).map(|unit| unit.name);
                    let near = meant.or_else(|| crate::lang::words::names::nearest(&text, known.iter().copied()));
                    let label = near.map_or_else(|| "no such unit".to_owned(), |n| format!("did you mean `{n}`?"));
                    let message = format!("`{text}` is not a unit of length");
                    let diagnostic = Diagnostic::new("E213", message, file, bound.span, label).help(format!("one of {}", known.join(", ")));
                    let diagnostic = near.into_iter().fold(diagnostic, |d, near| d.put(bound.span, near));
                    self.machine.filed.push((owner, diagnostic));
                }
            }
        }
    }

    /// A `use` declaration.
    pub(crate) fn load_module(&mut self, code: Code<'_>, path: ExprId, args: &[Arg], bound: Bound) -> Result<Value, Halt> {
        let (written, origin) = self.path_text(code, path)?;
        let mut gather = Gather::default();
        let mut given = Vec::with_capacity(args.len());
        for arg in args {
            let Some((name, span)) = arg.name else {
                let draft = self.error(code, "E303", "params of a module are given by name", code.span(arg.value), "which param?");
                gather.take::<()>(Err(draft.help("`name: value`").stop()));
                continue;
            };
            let value = self.param_of_module(code, arg.value);
            given.extend(gather.take(value).map(|v| (name, span, v)));
        }
        gather.done()?;
        let from = self.machine.at(code.module).path.clone();
        let resolved = self.files.resolve(&from, &written).map_err(|e| file_fault(e, &written, origin))?;
        if let Some(circle) = self.circle(code.module, &resolved) {
            return Err(ContentFault::ImportCycle { of: origin, ring: circle }.into());
        }
        let bytes = self.files.read(&resolved, limits::SOURCE_BYTES).map_err(|e| file_fault(e, &written, origin))?;
        let Ok(text) = String::from_utf8(bytes) else {
            let what = "it is not UTF-8 text".to_owned();
            return Err(AccessFault::CannotRead { of: origin, path: written, similar: Vec::new(), why: what }.into());
        };
        let label = self.program.names.text(bound.name).to_owned();
        let parent = self.machine.at(code.module).label.clone();
        let label = if parent.is_empty() { label } else { format!("{parent}.{label}") };
        let before = self.loaded_by(code.module, code.declaration);
        let id = self.add_module(&written, &resolved, text.into(), label, before);
        let module = self.machine.at_mut(id);
        module.parent = Some((code.module, code.declaration));
        let file = self.machine.at(code.module).file;
        for (name, span, value) in given {
            let name = self.program.names.text(name).to_owned();
            if let Err(diagnostic) = self.give(id, &name, Given::Value(value, file, span)) {
                self.sink.reports.push(*diagnostic);
            }
        }
        Ok(Value::Module(id))
    }

    /// The module that a `use` declaration has loaded.
    pub(crate) fn loaded_by(&self, module: ModuleId, declaration: u32) -> Option<ModuleId> {
        let loaded = self.machine.modules.iter().position(|m| m.parent == Some((module, declaration)));
        loaded.map(ModuleId::at)
    }

    /// A value that may be given to a param of a module.
    fn param_of_module(&mut self, code: Code<'_>, id: ExprId) -> Result<Value, Halt> {
        if let Expr::Name(name) = code.expr(id)
            && !self.is_bound(code.module, *name)
            && !self.machine.at(code.module).is_broken(*name)
        {
            // Words are the module's own: whether it is one is asked there.
            return Ok(Value::Word(self.program.names.text(*name).into()));
        }
        match self.eval(code, id)? {
            value @ (Value::Number(_) | Value::Bool(_) | Value::Text(_) | Value::Word(_)) => Ok(value),
            other => {
                let found = self.kind(&other);
                let text = format!("a param is a number, quantity, bool, string or word, got {found}");
                Err(self.error(code, "E211", text, code.span(id), found).stop())
            }
        }
    }

    /// The text of a path that is read and where it stands. E801 where it names no file on any system.
    pub(crate) fn path_text(&mut self, code: Code<'_>, path: ExprId) -> Result<(String, Origin), Halt> {
        let text = match code.expr(path) {
            Expr::Text(parts) => match parts.as_slice() {
                [TextPart::Literal(text)] => text.to_string(),
                _ => self.interpolate(code, parts)?,
            },
            _ => return Err(Halt::Bug("a path that is no text")),
        };
        let origin = self.origin_at(path);
        match unfit_name(&text) {
            Some(why) => Err(AccessFault::CannotRead { of: origin, path: text, similar: Vec::new(), why }.into()),
            None => Ok((text, origin)),
        }
    }

    /// The circle of modules that loading this file would close.
    fn circle(&self, module: ModuleId, resolved: &str) -> Option<Vec<String>> {
        let mut names = Vec::new();
        let mut at = Some(module);
        while let Some(id) = at {
            let module = self.machine.at(id);
            let name = self.program.sources.get(module.file).map_or(String::new(), |s| s.name.clone());
            names.push(name);
            if &*module.path == resolved {
                names.reverse();
                names.push(names[0].clone());
                return Some(names);
            }
            at = module.parent.map(|p| p.0);
        }
        None
    }

    /// The declarations of a script with this keyword.
    pub(crate) fn heads(&self, module: ModuleId, keyword: Keyword) -> Vec<u32> {
        let declarations = &self.machine.at(module).script.declarations;
        declarations.with_keyword(keyword).map(|i| i as u32).collect()
    }
}

/// What a file cannot be read for, as a fault.
pub(crate) fn file_fault(error: FileError, path: &str, of: Origin) -> AccessFault {
    let path = path.to_owned();
    match error {
        FileError::Missing { similar } => AccessFault::CannotRead { of, path, similar, why: String::new() },
        FileError::Outside => AccessFault::Outside { of, path },
        FileError::TooLarge(bytes) => AccessFault::TooLarge { of, path, bytes, limit: limits::DATA_BYTES },
        FileError::Other(why) => AccessFault::CannotRead { of, path, similar: Vec::new(), why },
    }
}
