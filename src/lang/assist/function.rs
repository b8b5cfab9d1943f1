//! What a call takes, whoever declares it: the language, a script, a module's params, or `import`.

use crate::lang::assist::scripts::{NamedExpressions, Scripts};
use crate::lang::assist::shape::KnownType;
use crate::lang::eval::std::{Builtin, builtins, fields};
use crate::lang::syntax::ast::{Allowed, DeclarationKind, FnParam, Keyword};
use crate::lang::values::settings::FILE_UNITS;
use crate::lang::values::types::Ty;

/// A parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// As written before the colon.
    pub name: String,
    /// What it takes as far as it is known.
    pub ty: Ty,
    /// Its type as signatures show it.
    pub shown: String,
    /// Source of its default.
    pub default: Option<String>,
    /// What is allowed, as written: `20m to 80m`.
    pub range: Option<String>,
    /// The words it may be, where these are listed.
    pub words: Vec<String>,
    /// What it means.
    pub docs: String,
}

/// A function.
#[derive(Clone, Debug)]
pub struct Function {
    /// As written.
    pub name: String,
    /// In order.
    pub params: Vec<Parameter>,
    /// `line(from: point, to: point) → curve`.
    pub signature: String,
    /// What it does.
    pub docs: String,
    /// What it gives.
    pub gives: KnownType,
}

impl Parameter {
    /// `radius: length = 1m`.
    pub fn signature(&self) -> String {
        let ty = if self.shown.is_empty() { String::new() } else { format!(": {}", self.shown) };
        let default = self.default.as_ref().map(|d| format!(" = {d}")).unwrap_or_default();
        format!("{}{ty}{default}", self.name)
    }

    fn new(name: &str, ty: Ty, docs: &str) -> Self {
        Self { name: name.to_owned(), ty, shown: ty.signature(), default: None, range: None, words: Vec::new(), docs: docs.to_owned() }
    }
}

impl Function {
    /// The first sentence of its docs.
    pub fn summary(&self) -> &str {
        self.docs.split(['\n', '.']).next().unwrap_or("").trim()
    }

    /// A function of the language.
    pub fn of_language(name: &str) -> Option<Self> {
        builtins().chain(fields()).find(|b| b.name == name).map(Self::of_builtin)
    }

    pub(crate) fn of_builtin(builtin: &'static Builtin) -> Self {
        let parameter = |p: &crate::lang::eval::std::Param| Parameter {
            default: p.default.map(str::to_owned),
            ..Parameter::new(p.name, p.ty, p.docs.trim())
        };
        Self {
            name: builtin.name.to_owned(),
            params: builtin.params.iter().map(parameter).collect(),
            signature: builtin.signature(),
            docs: builtin.docs.trim().to_owned(),
            gives: KnownType::of(builtin.returns),
        }
    }

    /// A function that a script declares.
    pub(crate) fn of_script(scripts: &Scripts<'_>, unit: usize, name: &str) -> Option<Self> {
        let home = scripts.unit(unit);
        let (_, declaration) = home.declaration(name)?;
        let DeclarationKind::Fn { params, .. } = &declaration.kind else { return None };
        let code = NamedExpressions { unit, names: &home.names, nodes: &declaration.nodes };
        let parameter = |p: &FnParam| {
            let ty = p.ty.and_then(|ty| Ty::written(code.text(ty.name), ty.lists)).unwrap_or(Ty::Any);
            let default = p.default.map(|d| code.nodes[d.index()].span).map(|span| home.source(span.start, span.end).to_owned());
            let shown = if ty == Ty::Any { scripts.shape_of_param(code, p).signature() } else { ty.signature() };
            Parameter { shown, default, ..Parameter::new(code.text(p.bound.name), ty, "") }
        };
        let params: Vec<Parameter> = params.iter().map(parameter).collect();
        let gives = scripts.result_of_fn(unit, &declaration);
        let result = if gives == KnownType::Unknown { String::new() } else { format!(" → {}", gives.signature()) };
        let list: Vec<String> = params.iter().map(Parameter::signature).collect();
        let signature = format!("{name}({}){result}", list.join(", "));
        Some(Self { name: name.to_owned(), params, signature, docs: declaration.doc.as_deref().unwrap_or("").to_owned(), gives })
    }

    /// The params of a module, which `use` takes in brackets.
    pub(crate) fn of_module(scripts: &Scripts<'_>, module: usize) -> Self {
        let home = scripts.unit(module);
        let of_name = |name: &String| Self::param_of_script(scripts, module, name);
        let params: Vec<Parameter> = home.order.iter().filter_map(of_name).collect();
        let list: Vec<String> = params.iter().map(Parameter::signature).collect();
        let signature = format!("use \"…\" ({})", list.join(", "));
        Self { name: "use".to_owned(), params, signature, docs: String::new(), gives: KnownType::Unknown }
    }

    /// A `param` of a script.
    pub(crate) fn param_of_script(scripts: &Scripts<'_>, unit: usize, name: &str) -> Option<Parameter> {
        let home = scripts.unit(unit);
        let (_, declaration) = home.declaration(name).filter(|(_, d)| d.keyword == Keyword::Param)?;
        let DeclarationKind::Param { value, allowed, .. } = &declaration.kind else { return None };
        let source =
            |start: usize, end: usize| home.source(declaration.nodes[start].span.start, declaration.nodes[end].span.end).to_owned();
        let words = match allowed {
            Some(Allowed::Choices(list)) => list.iter().map(|id| source(id.index(), id.index())).collect(),
            _ => Vec::new(),
        };
        let range = match allowed {
            Some(Allowed::Range(a, b)) => Some(source(a.index(), b.index())),
            _ if !words.is_empty() => Some(format!("one of {}", words.join(", "))),
            _ => None,
        };
        let shape = scripts.shape_of_name(unit, name, &Vec::new());
        let ty = if let KnownType::Is(ty) = shape { ty } else { Ty::Any };
        let docs = declaration.doc.as_deref().unwrap_or("");
        let default = Some(source(value.index(), value.index()));
        Some(Parameter { shown: shape.signature(), default, range, words, ..Parameter::new(name, ty, docs) })
    }

    /// What `import` takes in brackets.
    pub(crate) fn of_import() -> Self {
        let params = vec![
            Parameter::new("header", Ty::Bool, "The first line of a table holds names, also where all its cells are numbers."),
            Parameter::new("unit", Ty::Choice(FILE_UNITS), "Unit of the bare numbers in the file."),
        ];
        let signature = "import \"…\" (header: bool, unit: mm|…)".to_owned();
        Self { name: "import".to_owned(), params, signature, docs: String::new(), gives: KnownType::Unknown }
    }
}
