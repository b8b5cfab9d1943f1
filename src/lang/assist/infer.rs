//! The types of names and expressions, from their text alone.

use crate::lang::assist::function::Function;
use crate::lang::assist::scripts::{Locals, NamedExpressions, Scripts};
use crate::lang::assist::shape::KnownType;
use crate::lang::eval::std::{builtins, fields};
use crate::lang::syntax::ast::{Arg, Binary, Clause, Declaration, DeclarationKind, Expr, ExprId, FnParam, For, Keyword, TextPart, Unary};
use crate::lang::values::types::Ty;
use crate::lang::values::units::{MILLIMETRE, quantity};
use crate::lang::values::value::Dim;

/// How deep the search for a type goes.
const DEPTH: u32 = 64;
/// Functions that give the same kind of thing as their first argument.
const ALIKE: [&str; 8] = ["move", "rotate", "scale", "mirror", "reverse", "sort", "lerp", "mean"];

impl Scripts<'_> {
    /// The type of a name in a script.
    pub(crate) fn shape_of_name(&self, unit: usize, name: &str, locals: &Locals) -> KnownType {
        if let Some((_, shape)) = locals.iter().rev().find(|(local, _)| local == name) {
            return shape.clone();
        }
        let home = self.unit(unit);
        let Some(entry) = home.declared.get(name) else {
            return if name == "network" { KnownType::Is(Ty::Network) } else { KnownType::Unknown };
        };
        let Some((at, declaration)) = home.declaration(name) else {
            return by_keyword(entry.keyword).or(|| self.last_run(unit, name));
        };
        if let Some(shape) = home.shapes.borrow().get(&at) {
            return shape.clone();
        }
        let Some(found) = self.deeper(|| self.declared(unit, &declaration)) else { return KnownType::Unknown };
        let found = match found {
            KnownType::List(of) if *of == KnownType::Unknown => self.last_run(unit, name).or(|| KnownType::list(KnownType::Unknown)),
            // What a file holds is known once it was read.
            found if entry.keyword == Keyword::Import => self.last_run(unit, name).or(|| found),
            found => found.or(|| self.last_run(unit, name)),
        };
        home.shapes.borrow_mut().insert(at, found.clone());
        found
    }

    /// A step further, unless that is too far or goes round in a circle.
    fn deeper<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        let depth = self.depth.get();
        if depth >= DEPTH {
            return None;
        }
        self.depth.set(depth + 1);
        let found = work();
        self.depth.set(depth);
        Some(found)
    }

    fn declared(&self, unit: usize, declaration: &Declaration) -> KnownType {
        let home = self.unit(unit);
        let code = NamedExpressions { unit, names: &home.names, nodes: &declaration.nodes };
        let mut locals = Locals::new();
        let of_keyword = by_keyword(declaration.keyword);
        match &declaration.kind {
            DeclarationKind::Load { path, .. } => match (literal(code, *path), declaration.keyword) {
                (Some(path), Keyword::Use) => self.module(unit, &path).map_or(KnownType::Unknown, KnownType::Module),
                (Some(path), _) => of_file(&path),
                (None, _) => KnownType::Unknown,
            },
            DeclarationKind::Param { ty, value, .. } => match ty.and_then(|ty| Ty::written(code.text(ty.name), ty.lists)) {
                Some(ty) => KnownType::of(ty),
                // A name that is bound to nothing is a word.
                None if matches!(code.nodes[value.index()].expr, Expr::Name(_)) => {
                    self.shape(code, *value, &mut locals).or(|| KnownType::Is(Ty::Word))
                }
                None => self.shape(code, *value, &mut locals),
            },
            DeclarationKind::Value { family, value, .. } => {
                self.family(code, family, &mut locals);
                let one = of_keyword.or(|| self.shape(code, *value, &mut locals));
                family.iter().fold(one, |shape, _| KnownType::list(shape))
            }
            DeclarationKind::Collection { family, .. } => family.iter().fold(of_keyword, |shape, _| KnownType::list(shape)),
            _ => KnownType::Unknown,
        }
    }

    fn family(&self, code: NamedExpressions<'_>, family: &[For], locals: &mut Locals) {
        for one in family {
            let member = self.shape(code, one.list, locals).member();
            locals.push((code.text(one.name).to_owned(), member));
        }
    }

    /// What a function of a script gives.
    pub(crate) fn result_of_fn(&self, unit: usize, declaration: &Declaration) -> KnownType {
        let home = self.unit(unit);
        let code = NamedExpressions { unit, names: &home.names, nodes: &declaration.nodes };
        let DeclarationKind::Fn { params, returns, body, .. } = &declaration.kind else { return KnownType::Unknown };
        if let Some(ty) = returns.and_then(|ty| Ty::written(code.text(ty.name), ty.lists)) {
            return KnownType::of(ty);
        }
        let mut locals = params.iter().map(|p| (code.text(p.bound.name).to_owned(), self.shape_of_param(code, p))).collect();
        self.deeper(|| self.shape(code, *body, &mut locals)).unwrap_or_default()
    }

    pub(crate) fn shape_of_param(&self, code: NamedExpressions<'_>, param: &FnParam) -> KnownType {
        match (param.ty.and_then(|ty| Ty::written(code.text(ty.name), ty.lists)), param.default) {
            (Some(ty), _) => KnownType::of(ty),
            (None, Some(default)) => self.deeper(|| self.shape(code, default, &mut Locals::new())).unwrap_or_default(),
            (None, None) => KnownType::Unknown,
        }
    }

    /// The type of an expression.
    pub(crate) fn shape(&self, code: NamedExpressions<'_>, id: ExprId, locals: &mut Locals) -> KnownType {
        self.deeper(|| self.shape_here(code, id, locals)).unwrap_or_default()
    }

    fn shape_here(&self, code: NamedExpressions<'_>, id: ExprId, locals: &mut Locals) -> KnownType {
        match &code.nodes[id.index()].expr {
            Expr::Number(_) => KnownType::Is(Ty::Number),
            Expr::Quantity(x, unit) => quantity(*x, unit, MILLIMETRE).map_or(KnownType::Unknown, |q| of_dim(q.dim)),
            Expr::Text(_) => KnownType::Is(Ty::Text),
            Expr::Bool(_) | Expr::Within { .. } | Expr::Unary(Unary::Not, _) => KnownType::Is(Ty::Bool),
            Expr::None | Expr::Slice { .. } => KnownType::Unknown,
            Expr::Name(name) => self.shape_of_name(code.unit, code.text(*name), locals),
            Expr::Call { name, of, args, .. } => self.called(code, code.text(*name), *of, args, locals),
            Expr::Field { of, name, .. } => {
                let of = self.shape(code, *of, locals);
                self.member(code.unit, &of, code.text(*name))
            }
            Expr::Index { of, index } => self.indexed(code, *of, *index, locals),
            Expr::Tuple(items) => {
                let lengths = items.iter().any(|i| self.shape(code, *i, locals).dim() == Some(Dim::LENGTH));
                KnownType::Is(if lengths { Ty::Point } else { Ty::Vector })
            }
            Expr::List(items) => {
                let known = items.iter().map(|i| self.shape(code, *i, locals)).find(|shape| *shape != KnownType::Unknown);
                KnownType::list(known.unwrap_or_default())
            }
            Expr::Comprehension { clauses, body } => {
                let outer = locals.len();
                for clause in clauses {
                    if let Clause::For(one) = clause {
                        self.family(code, std::slice::from_ref(one), locals);
                    }
                }
                let body = self.shape(code, *body, locals);
                locals.truncate(outer);
                KnownType::list(body)
            }
            Expr::Record(keys) => {
                KnownType::Record(keys.iter().map(|(key, value)| (code.text(*key).to_owned(), self.shape(code, *value, locals))).collect())
            }
            Expr::Unary(Unary::Minus, of) => self.shape(code, *of, locals),
            Expr::Binary { op, a, b, .. } => {
                let sides = (self.shape(code, *a, locals), self.shape(code, *b, locals));
                of_operator(*op, sides)
            }
            Expr::If { then, otherwise, .. } => self.shape(code, *then, locals).or(|| self.shape(code, *otherwise, locals)),
            Expr::Let { name, value, body, .. } => {
                let value = self.shape(code, *value, locals);
                locals.push((code.text(*name).to_owned(), value));
                let body = self.shape(code, *body, locals);
                locals.pop();
                body
            }
        }
    }

    fn called(&self, code: NamedExpressions<'_>, name: &str, of: Option<ExprId>, args: &[Arg], locals: &mut Locals) -> KnownType {
        let before = of.map(|of| self.shape(code, of, locals));
        if let Some(KnownType::Module(module)) = before {
            let home = self.unit(module);
            return home.declaration(name).map_or(KnownType::Unknown, |(_, declaration)| self.result_of_fn(module, &declaration));
        }
        let home = self.unit(code.unit);
        if let Some((_, declaration)) = home.declaration(name).filter(|(_, d)| d.keyword == Keyword::Fn) {
            return self.result_of_fn(code.unit, &declaration);
        }
        let first = before.or_else(|| args.first().map(|arg| self.shape(code, arg.value, locals)));
        let first = first.unwrap_or_default();
        // `length(c)` is `c.length`.
        if fields().any(|f| f.name == name) { self.member(code.unit, &first, name) } else { of_builtin(name, &first) }
    }

    /// The type of `of.name`.
    pub(crate) fn member(&self, unit: usize, of: &KnownType, name: &str) -> KnownType {
        match of {
            KnownType::Module(module) => return self.shape_of_name(*module, name, &Locals::new()),
            KnownType::Record(keys) => {
                if let Some((_, shape)) = keys.iter().find(|(key, _)| key == name) {
                    return shape.clone();
                }
            }
            KnownType::Is(Ty::Point | Ty::Node | Ty::Vertex) if matches!(name, "x" | "y" | "z") => return of_dim(Dim::LENGTH),
            KnownType::Table(_) if name == "rows" => return KnownType::list(of.member()),
            KnownType::Table(_) if name == "points" => return KnownType::list(KnownType::Is(Ty::Point)),
            _ => {}
        }
        let field = fields().find(|f| f.name == name && f.params.first().is_some_and(|p| of.has_fields_of(p.ty)));
        if let Some(field) = field.filter(|_| *of != KnownType::Unknown) {
            return if name == "bbox" { of_builtin("box", of) } else { KnownType::of(field.returns) };
        }
        // Of something unknown a field is known when all of its name give the same.
        let all = fields().filter(|f| f.name == name).map(|f| KnownType::of(f.returns)).reduce(KnownType::either);
        match (all, Function::of_script(self, unit, name)) {
            (Some(shape), _) => shape,
            (None, Some(_)) => {
                let home = self.unit(unit);
                home.declaration(name).map_or(KnownType::Unknown, |(_, declaration)| self.result_of_fn(unit, &declaration))
            }
            (None, None) => of_builtin(name, of),
        }
    }

    fn indexed(&self, code: NamedExpressions<'_>, of: ExprId, index: ExprId, locals: &mut Locals) -> KnownType {
        let of = self.shape(code, of, locals);
        let run = matches!(code.nodes[index.index()].expr, Expr::Slice { .. } | Expr::Binary { op: Binary::Run, .. });
        match &of {
            KnownType::Is(Ty::Curve) => KnownType::Is(Ty::Curve),
            KnownType::List(_) if run => of,
            KnownType::Record(keys) => {
                let key = literal(code, index);
                keys.iter().find(|(k, _)| Some(k) == key.as_ref()).map_or(KnownType::Unknown, |(_, shape)| shape.clone())
            }
            other => other.member(),
        }
    }
}

/// A text without interpolation.
fn literal(code: NamedExpressions<'_>, id: ExprId) -> Option<String> {
    match &code.nodes[id.index()].expr {
        Expr::Text(parts) => match parts.as_slice() {
            [TextPart::Literal(text)] => Some(text.to_string()),
            _ => None,
        },
        _ => None,
    }
}

/// What a declaration with this keyword must be.
pub(crate) fn by_keyword(keyword: Keyword) -> KnownType {
    match keyword {
        Keyword::Point => KnownType::Is(Ty::Point),
        Keyword::Curve | Keyword::ModelingCurve => KnownType::Is(Ty::Curve),
        Keyword::Surface => KnownType::Is(Ty::Surface),
        Keyword::Shell => KnownType::Is(Ty::Shell),
        Keyword::Mesh => KnownType::Is(Ty::Mesh),
        Keyword::Group => KnownType::list(KnownType::Unknown),
        _ => KnownType::Unknown,
    }
}

fn of_dim(dim: Dim) -> KnownType {
    KnownType::Is(if dim.is_none() { Ty::Number } else { Ty::Quantity(dim) })
}

/// What a file of this ending is read as.
fn of_file(path: &str) -> KnownType {
    let record =
        |keys: &[(&str, KnownType)]| KnownType::Record(keys.iter().map(|(key, shape)| ((*key).to_owned(), shape.clone())).collect());
    let many = |ty: Ty| KnownType::list(KnownType::Is(ty));
    let (points, curves, surfaces) = (("points", many(Ty::Point)), ("curves", many(Ty::Curve)), ("surfaces", many(Ty::Surface)));
    match path.rsplit_once('.').map_or(String::new(), |(_, ending)| ending.to_ascii_lowercase()).as_str() {
        "csv" | "dat" | "txt" => KnownType::Table([].into()),
        "stl" => record(&[("mesh", KnownType::Is(Ty::Mesh))]),
        "obj" => {
            let lists = KnownType::list(many(Ty::Point));
            record(&[
                points,
                ("polylines", lists.clone()),
                ("polygons", lists),
                ("groups", KnownType::Unknown),
                ("mesh", KnownType::Is(Ty::Mesh)),
            ])
        }
        "igs" | "iges" | "stp" | "step" | "p21" => {
            let group = record(&[("name", KnownType::Is(Ty::Text)), points.clone(), curves.clone(), surfaces.clone()]);
            let groups = ["groups", "shells", "solids", "colors"].map(|key| (key, KnownType::list(group.clone())));
            let lists: Vec<(&str, KnownType)> = [points, curves, surfaces].into_iter().chain(groups).collect();
            record(&lists)
        }
        _ => KnownType::Unknown,
    }
}

/// What a function of the language gives for a first argument like this.
fn of_builtin(name: &str, first: &KnownType) -> KnownType {
    if ALIKE.contains(&name) && *first != KnownType::Unknown {
        return if name == "mean" { first.member() } else { first.clone() };
    }
    let point = || KnownType::Is(Ty::Point);
    match name {
        "box" => {
            let keys = [("min", point()), ("max", point()), ("size", point()), ("diagonal", of_dim(Dim::LENGTH))];
            KnownType::Record(keys.map(|(key, shape)| (key.to_owned(), shape)).into())
        }
        "nearest" if matches!(first, KnownType::List(_)) => first.member(),
        "nearest" if first.is(Ty::Curve) => point(),
        "flatten" => match first.member() {
            list @ KnownType::List(_) => list,
            _ => first.clone(),
        },
        "plane" if first.fits(Ty::Rest(&Ty::Curve)) && *first != KnownType::Unknown => KnownType::Is(Ty::Surface),
        "min" | "max" | "sum" if matches!(first, KnownType::List(_)) => first.member(),
        "abs" | "min" | "max" if first.dim().is_some() => first.clone(),
        "linspace" => KnownType::list(first.clone()),
        "distance" => of_dim(Dim::LENGTH),
        _ => builtins().find(|b| b.name == name).map_or(KnownType::Unknown, |b| KnownType::of(b.returns)),
    }
}

fn of_operator(op: Binary, (a, b): (KnownType, KnownType)) -> KnownType {
    let is_vector = |shape: &KnownType| shape.fits(Ty::Vector) && *shape != KnownType::Unknown;
    match op {
        Binary::Meet => match [&a, &b].iter().filter(|side| side.is(Ty::Curve)).count() {
            2 => KnownType::Is(Ty::Node),
            1 => KnownType::Is(Ty::Point),
            _ if a == KnownType::Unknown || b == KnownType::Unknown => KnownType::Unknown,
            _ => KnownType::Is(Ty::Curve),
        },
        Binary::Run => KnownType::Is(Ty::Range),
        Binary::Times | Binary::Divide => {
            let product = |a: Dim, b: Dim| if op == Binary::Times { a.times(b) } else { a.over(b) };
            match (a.dim(), b.dim()) {
                (Some(x), Some(y)) => product(x, y).map_or(KnownType::Unknown, of_dim),
                _ if is_vector(&a) => a,
                _ if is_vector(&b) => b,
                _ => KnownType::Unknown,
            }
        }
        Binary::Plus | Binary::Minus => match () {
            () if is_vector(&a) || is_vector(&b) => {
                let place = |shape: &KnownType| matches!(shape, KnownType::Is(Ty::Point | Ty::Node | Ty::Vertex));
                KnownType::Is(if place(&a) || place(&b) { Ty::Point } else { Ty::Vector })
            }
            () => a.or(|| b),
        },
        Binary::Power => {
            if a.dim() == Some(Dim::NONE) {
                a
            } else {
                KnownType::Unknown
            }
        }
        _ => KnownType::Is(Ty::Bool),
    }
}
