//! Shapes: trees without their literals, names and places.
//!
//! The tree of a declaration follows from the kinds of its tokens alone. So pest is asked once for each sequence of
//! kinds; a declaration of a known shape takes the tree from before and its own numbers, names and places. There is
//! no second way: also the first declaration of a shape is made from it.

use crate::lang::diag::span::Span;
use std::collections::BTreeMap;
use std::rc::Rc;

use crate::lang::syntax::ast::*;
use crate::lang::syntax::number;
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::token::Kind;
use crate::lang::words::names::{Name, Names};

/// A declaration whose spans hold the numbers of their first and last token instead of bytes, and whose names are the
/// numbers of the tokens that hold them. Numbers and strings are empty; they are read from the tokens.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    pub declaration: Declaration,
    /// Tokens of the stretches of the strings, in the order of nodes.
    pub stretches: Vec<u32>,
    /// Quantities with `^` and a number behind them: `2m^2` may be meant as `2m2`.
    pub powers: Vec<u32>,
}

/// Shapes met so far. Only short ones are kept: long ones hardly come twice.
#[derive(Debug, Default)]
pub(crate) struct Shapes {
    known: BTreeMap<Box<[Kind]>, Rc<Shape>>,
}

/// Most tokens of a shape that is kept.
const LONGEST: usize = 256;
/// Most shapes kept.
const MOST: usize = 4096;

impl Shapes {
    /// The shape of these kinds when it was met before.
    pub fn get(&self, kinds: &[Kind]) -> Option<Rc<Shape>> {
        if kinds.len() > LONGEST { None } else { self.known.get(kinds).cloned() }
    }

    /// Keeps a shape.
    pub fn insert(&mut self, kinds: &[Kind], shape: &Rc<Shape>) {
        if kinds.len() <= LONGEST && self.known.len() < MOST {
            self.known.insert(kinds.into(), Rc::clone(shape));
        }
    }
}

/// Fills a shape with the tokens of one declaration.
pub(crate) struct Filler<'a> {
    pub source: &'a str,
    pub tokens: &'a Tokens,
    /// Number of the declaration's first token.
    pub base: usize,
    pub names: &'a mut Names,
}

impl Filler<'_> {
    /// The declaration of this shape at `base`.
    pub fn fill(&mut self, shape: &Shape, doc: Option<Box<str>>) -> Declaration {
        let from = &shape.declaration;
        let mut stretches = shape.stretches.iter();
        let nodes = from.nodes.iter().map(|n| Node { span: self.span(n.span), expr: self.expr(n, &mut stretches) }).collect();
        Declaration {
            keyword: from.keyword,
            span: self.span(from.span),
            keyword_span: self.span(from.keyword_span),
            doc,
            kind: self.kind(&from.kind),
            nodes,
        }
    }

    fn span(&self, tokens: Span) -> Span {
        self.tokens.stretch(self.base + tokens.start as usize, self.base + tokens.end as usize)
    }

    fn text(&self, token: u32) -> &str {
        let at = self.base + token as usize;
        &self.source[self.tokens.starts[at] as usize..self.tokens.ends[at] as usize]
    }

    fn name(&mut self, token: Name) -> Name {
        let at = self.base + token.0 as usize;
        self.names.intern(&self.source[self.tokens.starts[at] as usize..self.tokens.ends[at] as usize])
    }

    fn bound(&mut self, bound: Bound) -> Bound {
        Bound { name: self.name(bound.name), span: self.span(bound.span) }
    }

    fn expr(&mut self, node: &Node, stretches: &mut std::slice::Iter<'_, u32>) -> Expr {
        match &node.expr {
            Expr::Number(_) => Expr::Number(number::value(self.text(node.span.start))),
            Expr::Quantity(..) => {
                let (digits, unit) = number::split_unit(self.text(node.span.start));
                Expr::Quantity(number::value(digits), unit.into())
            }
            Expr::Text(parts) => Expr::Text(self.parts(parts, stretches)),
            Expr::Name(name) => Expr::Name(self.name(*name)),
            Expr::Call { name, name_span, of, args } => {
                Expr::Call { name: self.name(*name), name_span: self.span(*name_span), of: *of, args: self.args(args) }
            }
            Expr::Field { of, name, name_span } => Expr::Field { of: *of, name: self.name(*name), name_span: self.span(*name_span) },
            Expr::Comprehension { clauses, body } => {
                let clause = |c: &Clause| match c {
                    Clause::For(f) => Clause::For(self.family_one(f)),
                    Clause::If(condition) => Clause::If(*condition),
                };
                Expr::Comprehension { clauses: clauses.iter().map(clause).collect(), body: *body }
            }
            Expr::Record(pairs) => Expr::Record(pairs.iter().map(|&(name, value)| (self.name(name), value)).collect()),
            Expr::Binary { op, op_span, a, b } => Expr::Binary { op: *op, op_span: self.span(*op_span), a: *a, b: *b },
            Expr::Let { name, name_span, value, body } => {
                Expr::Let { name: self.name(*name), name_span: self.span(*name_span), value: *value, body: *body }
            }
            same @ (Expr::Bool(_)
            | Expr::None
            | Expr::Index { .. }
            | Expr::Slice { .. }
            | Expr::Tuple(_)
            | Expr::List(_)
            | Expr::Unary(..)
            | Expr::Within { .. }
            | Expr::If { .. }) => same.clone(),
        }
    }

    /// Literal stretches of a string that hold nothing are left out.
    fn parts(&mut self, parts: &[TextPart], stretches: &mut std::slice::Iter<'_, u32>) -> Vec<TextPart> {
        let mut filled = Vec::with_capacity(parts.len());
        for part in parts {
            match part {
                TextPart::Value(id) => filled.push(TextPart::Value(*id)),
                TextPart::Literal(_) => {
                    let text = stretches.next().map(|&token| unescape(self.text(token))).unwrap_or_default();
                    if !text.is_empty() {
                        filled.push(TextPart::Literal(text));
                    }
                }
            }
        }
        filled
    }

    fn args(&mut self, args: &[Arg]) -> Vec<Arg> {
        args.iter().map(|a| Arg { name: a.name.map(|(name, span)| (self.name(name), self.span(span))), value: a.value }).collect()
    }

    fn family_one(&mut self, f: &For) -> For {
        For { name: self.name(f.name), name_span: self.span(f.name_span), list: f.list }
    }

    fn family(&mut self, family: &[For]) -> Vec<For> {
        family.iter().map(|f| self.family_one(f)).collect()
    }

    fn settings(&mut self, settings: &[SettingEntry]) -> Vec<SettingEntry> {
        settings.iter().map(|s| SettingEntry { key: self.name(s.key), key_span: self.span(s.key_span), value: s.value }).collect()
    }

    fn ty(&mut self, ty: &Option<TypeName>) -> Option<TypeName> {
        ty.map(|t| TypeName { name: self.name(t.name), lists: t.lists, span: self.span(t.span) })
    }

    fn kind(&mut self, kind: &DeclarationKind) -> DeclarationKind {
        use DeclarationKind as K;
        match kind {
            K::Units(bound) => K::Units(self.bound(*bound)),
            K::Tolerance(values) => K::Tolerance(values.clone()),
            K::Snap(value) => K::Snap(*value),
            K::Load { path, args, bound } => K::Load { path: *path, args: self.args(args), bound: self.bound(*bound) },
            K::Param { bound, ty, value, allowed } => {
                K::Param { bound: self.bound(*bound), ty: self.ty(ty), value: *value, allowed: allowed.clone() }
            }
            K::Fn { bound, params, returns, body } => {
                let bound = self.bound(*bound);
                let param = |p: &FnParam| FnParam { bound: self.bound(p.bound), ty: self.ty(&p.ty), default: p.default };
                let params = params.iter().map(param).collect();
                K::Fn { bound, params, returns: self.ty(returns), body: *body }
            }
            K::Value { bound, family, value } => K::Value { bound: self.bound(*bound), family: self.family(family), value: *value },
            K::Collection { bound, family, things, settings, clauses } => {
                let bound = self.bound(*bound);
                let family = self.family(family);
                let settings = self.settings(settings);
                let clause = |c: &MeshClause| MeshClause {
                    word: c.word,
                    span: self.span(c.span),
                    things: c.things.clone(),
                    settings: self.settings(&c.settings),
                };
                let clauses = clauses.iter().map(clause).collect();
                K::Collection { bound, family, things: things.clone(), settings, clauses }
            }
            K::Output { label, things, family, to, settings } => {
                K::Output { label: *label, things: things.clone(), family: self.family(family), to: *to, settings: self.settings(settings) }
            }
        }
    }
}

/// The text of a stretch of a string: its quotes or braces taken off, its escapes resolved.
fn unescape(stretch: &str) -> Box<str> {
    let inner = &stretch[1..stretch.len() - 1];
    if !inner.contains('\\') {
        return inner.into();
    }
    let mut text = String::with_capacity(inner.len());
    let mut rest = inner.chars();
    while let Some(c) = rest.next() {
        if c != '\\' {
            text.push(c);
            continue;
        }
        match rest.next() {
            Some('n') => text.push('\n'),
            Some('u') => {
                let digits: String = rest.by_ref().skip(1).take_while(|&c| c != '}').collect();
                text.extend(u32::from_str_radix(&digits, 16).ok().and_then(char::from_u32));
            }
            Some(other) => text.push(other),
            None => {}
        }
    }
    text.into()
}
