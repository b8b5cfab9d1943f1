//! Which name means what: each place where a script says a name, with what it is bound to there.

use std::collections::BTreeMap;

use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::{Arg, Bound, Clause, Declaration, DeclarationKind, Expr, ExprId, For, Keyword, Script, TextPart};
use crate::lang::words::names::Name;

/// What a name is bound to where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// A declaration of the script, by its place.
    Declaration(usize),
    /// A parameter, or a name of `for` or `let … in`, told by where that is bound.
    Local(Span),
    /// Nothing of this script: a word for a choice, a function of the language, or a mistake.
    Free,
}

/// One place where a name stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// The name.
    pub name: Name,
    /// Where it stands.
    pub span: Span,
    /// What it means.
    pub binding: Binding,
    /// The name before the dot, for `ribs` in `ribs.arch`: with its declaration when it has one. Of a param that `use` gives, that `use`.
    pub of: Option<usize>,
    /// The module of that module which the name belongs to: `parts` in `ribs.parts.arch`.
    pub through: Option<Name>,
    /// It stands where it is bound.
    pub binds: bool,
}

/// All names of a script, in order of place.
pub fn occurrences(script: &Script) -> Vec<Occurrence> {
    // Of two declarations of a name the first one counts.
    let declared: BTreeMap<Name, usize> =
        (0..script.declarations.len()).rev().filter_map(|i| Some((script.declarations.bound(i)?.name, i))).collect();
    let mut out = Vec::new();
    for (index, declaration) in script.declarations.iter().enumerate() {
        let mut walker = Walker { declaration: &declaration, index, declared: &declared, script, locals: Vec::new(), out: &mut out };
        if let Some(b) = bound(&declaration) {
            walker.out.push(Occurrence {
                name: b.name,
                span: b.span,
                binding: Binding::Declaration(index),
                of: None,
                through: None,
                binds: true,
            });
        }
        walker.declaration();
    }
    out.sort_by_key(|o| o.span);
    out
}

struct Walker<'s> {
    declaration: &'s Declaration,
    index: usize,
    declared: &'s BTreeMap<Name, usize>,
    script: &'s Script,
    locals: Vec<(Name, Span)>,
    out: &'s mut Vec<Occurrence>,
}

impl Walker<'_> {
    fn declaration(&mut self) {
        match &self.declaration.kind {
            DeclarationKind::Units(_) => {}
            DeclarationKind::Tolerance(list) => list.iter().for_each(|e| self.expr(*e)),
            DeclarationKind::Snap(e) => self.expr(*e),
            DeclarationKind::Load { path, args, .. } => {
                self.expr(*path);
                for arg in args {
                    if let Some((name, span)) = arg.name.filter(|_| self.declaration.keyword == Keyword::Use) {
                        let of = Some(self.index);
                        self.out.push(Occurrence { name, span, binding: Binding::Free, of, through: None, binds: false });
                    }
                    self.expr(arg.value);
                }
            }
            DeclarationKind::Param { value, allowed, .. } => {
                self.expr(*value);
                match allowed {
                    Some(crate::lang::syntax::ast::Allowed::Range(a, b)) => [*a, *b].into_iter().for_each(|e| self.expr(e)),
                    Some(crate::lang::syntax::ast::Allowed::Choices(list)) => list.iter().for_each(|e| self.expr(*e)),
                    None => {}
                }
            }
            DeclarationKind::Fn { params, body, .. } => {
                for param in params {
                    param.default.into_iter().for_each(|e| self.expr(e));
                    self.bind(param.bound.name, param.bound.span);
                }
                self.expr(*body);
            }
            DeclarationKind::Value { family, value, .. } => {
                self.family(family);
                self.expr(*value);
            }
            DeclarationKind::Collection { family, things, settings, clauses, .. } => {
                self.family(family);
                things.iter().for_each(|e| self.expr(*e));
                settings.iter().for_each(|s| self.expr(s.value));
                for clause in clauses {
                    clause.things.iter().for_each(|e| self.expr(*e));
                    clause.settings.iter().for_each(|s| self.expr(s.value));
                }
            }
            DeclarationKind::Output { label, things, family, to, settings } => {
                self.family(family);
                label.iter().chain(things).chain(to).for_each(|e| self.expr(*e));
                settings.iter().for_each(|s| self.expr(s.value));
            }
        }
    }

    fn bind(&mut self, name: Name, span: Span) {
        self.locals.push((name, span));
        self.out.push(Occurrence { name, span, binding: Binding::Local(span), of: None, through: None, binds: true });
    }

    fn family(&mut self, family: &[For]) {
        for f in family {
            self.expr(f.list);
            self.bind(f.name, f.name_span);
        }
    }

    fn says(&mut self, name: Name, span: Span, value: bool) {
        let local = self.locals.iter().rev().find(|l| l.0 == name).filter(|_| value);
        let declared = self.declared.get(&name).copied();
        // What is called is a function, whatever else has its name.
        let fits = |d: &usize| value || self.script.declarations.keyword(*d) == Keyword::Fn;
        let binding = match (local, declared.filter(fits)) {
            (Some(local), _) => Binding::Local(local.1),
            (None, Some(d)) => Binding::Declaration(d),
            (None, None) => Binding::Free,
        };
        self.out.push(Occurrence { name, span, binding, of: None, through: None, binds: false });
    }

    /// A name behind a dot: a function of the script, or a name of the module before the dot.
    fn behind_dot(&mut self, of: ExprId, name: Name, span: Span) {
        self.says(name, span, false);
        let (before, through) = match self.declaration.nodes[of.index()].expr {
            Expr::Name(before) => (before, None),
            Expr::Field { of, name, .. } => match self.declaration.nodes[of.index()].expr {
                Expr::Name(before) => (before, Some(name)),
                _ => return,
            },
            _ => return,
        };
        let module = self.declared.get(&before).filter(|_| !self.locals.iter().any(|l| l.0 == before));
        if let (Some(last), Some(module)) = (self.out.last_mut(), module) {
            (last.of, last.through) = (Some(*module), through);
        }
    }

    fn expr(&mut self, id: ExprId) {
        let node = &self.declaration.nodes[id.index()];
        match &node.expr {
            Expr::Number(_) | Expr::Quantity(..) | Expr::Bool(_) | Expr::None => {}
            Expr::Name(name) => self.says(*name, node.span, true),
            Expr::Text(parts) => parts.iter().for_each(|p| {
                if let TextPart::Value(e) = p {
                    self.expr(*e)
                }
            }),
            Expr::Call { name, name_span, of, args } => {
                match of {
                    Some(of) => {
                        self.expr(*of);
                        self.behind_dot(*of, *name, *name_span);
                    }
                    None => self.says(*name, *name_span, false),
                }
                args.iter().for_each(|Arg { value, .. }| self.expr(*value));
            }
            Expr::Field { of, name, name_span } => {
                self.expr(*of);
                self.behind_dot(*of, *name, *name_span);
            }
            Expr::Index { of: a, index: b } | Expr::Binary { a, b, .. } | Expr::Within { of: a, tolerance: b } => {
                self.expr(*a);
                self.expr(*b);
            }
            Expr::Slice { from, to } => from.iter().chain(to).for_each(|e| self.expr(*e)),
            Expr::Tuple(list) | Expr::List(list) => list.iter().for_each(|e| self.expr(*e)),
            Expr::Comprehension { clauses, body } => {
                let outer = self.locals.len();
                for clause in clauses {
                    match clause {
                        Clause::For(f) => {
                            self.expr(f.list);
                            self.bind(f.name, f.name_span);
                        }
                        Clause::If(e) => self.expr(*e),
                    }
                }
                self.expr(*body);
                self.locals.truncate(outer);
            }
            Expr::Record(fields) => fields.iter().for_each(|f| self.expr(f.1)),
            Expr::Unary(_, e) => self.expr(*e),
            Expr::If { condition, then, otherwise } => [condition, then, otherwise].into_iter().for_each(|e| self.expr(*e)),
            Expr::Let { name, name_span, value, body } => {
                self.expr(*value);
                let outer = self.locals.len();
                self.bind(*name, *name_span);
                self.expr(*body);
                self.locals.truncate(outer);
            }
        }
    }
}

/// The name that a declaration binds.
pub(crate) fn bound(declaration: &Declaration) -> Option<Bound> {
    match &declaration.kind {
        DeclarationKind::Load { bound, .. }
        | DeclarationKind::Param { bound, .. }
        | DeclarationKind::Fn { bound, .. }
        | DeclarationKind::Value { bound, .. }
        | DeclarationKind::Collection { bound, .. } => Some(*bound),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::diag::diagnostic::FileId;
    use crate::lang::syntax::parse;
    use crate::lang::words::names::Names;

    #[test]
    fn names_mean_what_is_nearest() {
        let text = "let i = 2\nlet list = [for i in 0..3: i + j]\nfn f(i) = i * k\nlet k = let i = i in i\ncurve line = line(f(i), f)\nlet m = k.f + ribs.arch";
        let mut names = Names::default();
        let (script, said) = parse(text, FileId(0), &mut names);
        assert!(said.is_empty());
        let found = occurrences(&script);
        let at = |needle: &str, plus: usize| {
            let start = (text.find(needle).unwrap_or(0) + plus) as u32;
            found.iter().find(|o| o.span.start == start).map(|o| o.binding)
        };
        assert_eq!(at("let i", 4), Some(Binding::Declaration(0)));
        assert!(matches!(at("i + j", 0), Some(Binding::Local(_))));
        assert_eq!(at("+ j", 2), Some(Binding::Free));
        assert!(matches!(at("i * k", 0), Some(Binding::Local(_))));
        assert_eq!(at("* k", 2), Some(Binding::Declaration(3)));
        // The value of a local `let` still sees the outer name.
        assert_eq!(at("= i in", 2), Some(Binding::Declaration(0)));
        assert_eq!(at("line(f", 0), Some(Binding::Free));
        assert_eq!(at("f(i)", 0), Some(Binding::Declaration(2)));
        assert_eq!(at("k.f", 2), Some(Binding::Declaration(2)));
    }
}
