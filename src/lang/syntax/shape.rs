//! Shapes: trees without their literals, names and places.
//!
//! The tree of a declaration follows from the kinds of its tokens alone. So pest is asked once for each sequence of
//! kinds; a declaration of a known shape takes the tree from before and its own numbers, names and places. There is
//! no second way: also the first declaration of a shape is made from it.

use crate::lang::diag::span::Span;
use std::collections::BTreeMap;
use std::sync::Arc;

use crate::lang::syntax::ast::*;
use crate::lang::syntax::declarations::TokenPlaces;
use crate::lang::syntax::number;
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::scopes::bound;
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
    /// Tokens of the names, in the order in which they are read.
    pub names: Vec<u32>,
    /// Places in `names` of those that are used as values or called, in the order of nodes.
    pub uses: Vec<u32>,
    /// Place in `names` of the one that it binds.
    pub bound: Option<u32>,
}

impl Shape {
    /// A shape with its tree, the tokens of its strings, and of its powers.
    pub fn new(declaration: Declaration, stretches: Vec<u32>, powers: Vec<u32>) -> Self {
        let mut shape = Self { declaration, stretches, powers, names: Vec::new(), uses: Vec::new(), bound: None };
        shape.find_names();
        shape
    }

    /// Whether declarations of this shape are kept as what sets them apart: those that are looked at once. The body of a function is
    /// looked at in each call.
    pub fn is_shared(&self) -> bool {
        matches!(self.declaration.kind, DeclarationKind::Value { .. })
    }

    fn find_names(&mut self) {
        if !self.is_shared() {
            return;
        }
        let mut names = Vec::new();
        Filler { source: "", places: Places::None, base: 0, names: NameSource::Noted(&mut names) }.fill(self, None);
        let place = |token: Name| names.iter().position(|name| *name == token.0).map(|place| place as u32);
        let used = |node: &Node| match node.expr {
            Expr::Name(name) | Expr::Call { name, .. } => place(name),
            _ => None,
        };
        self.uses = self.declaration.nodes.iter().filter_map(used).collect();
        self.bound = bound(&self.declaration).and_then(|b| place(b.name));
        self.names = names;
    }
}

/// A shape, and its place among those that a script shares.
#[derive(Clone, Debug)]
pub(crate) struct KnownShape {
    pub shape: Arc<Shape>,
    pub shared: Option<u32>,
}

/// Shapes met so far. Only short ones are kept: long ones hardly come twice.
#[derive(Debug, Default)]
pub(crate) struct Shapes {
    known: BTreeMap<Box<[Kind]>, KnownShape>,
}

/// Most tokens of a shape that is kept.
const LONGEST: usize = 256;
/// Most shapes kept.
const MOST: usize = 4096;

impl Shapes {
    /// The shape of these kinds when it was met before.
    pub fn get(&self, kinds: &[Kind]) -> Option<KnownShape> {
        if kinds.len() > LONGEST { None } else { self.known.get(kinds).cloned() }
    }

    /// Whether a shape of these kinds is kept when it is found.
    pub fn has_room(&self, kinds: &[Kind]) -> bool {
        kinds.len() <= LONGEST && self.known.len() < MOST
    }

    /// Keeps a shape.
    pub fn insert(&mut self, kinds: &[Kind], shape: &KnownShape) {
        if self.has_room(kinds) {
            self.known.insert(kinds.into(), shape.clone());
        }
    }
}

/// Fills a shape with the tokens of one declaration.
pub(crate) struct Filler<'a> {
    pub source: &'a str,
    pub places: Places<'a>,
    /// Number of the declaration's first token.
    pub base: usize,
    pub names: NameSource<'a>,
}

/// Where a [`Filler`] has the places of tokens from.
#[derive(Clone, Copy)]
pub(crate) enum Places<'a> {
    /// A file that was just read.
    Read(&'a Tokens),
    /// What a script keeps of it.
    Kept(&'a TokenPlaces),
    /// Nowhere.
    None,
}

/// Where a [`Filler`] has the names from.
pub(crate) enum NameSource<'a> {
    /// The text, entered here.
    Text(&'a mut Names),
    /// A list, in the order in which they are read.
    Listed(std::slice::Iter<'a, Name>),
    /// Nowhere: the tokens that are asked for are noted, and texts and places are empty.
    Noted(&'a mut Vec<u32>),
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

    /// The same into a declaration of this shape that nobody looks at any more, so that its lists need not be made again.
    pub fn fill_again(&mut self, shape: &Shape, used: &mut Declaration, doc: Option<Box<str>>) {
        let from = &shape.declaration;
        let mut stretches = shape.stretches.iter();
        for (n, node) in from.nodes.iter().zip(&mut used.nodes) {
            node.span = self.span(n.span);
            match (&n.expr, &mut node.expr) {
                (Expr::Tuple(_) | Expr::List(_), _) => {}
                (Expr::Number(_), Expr::Number(value)) => *value = number::value(self.text(n.span.start)),
                (Expr::Name(name), Expr::Name(new_name)) => *new_name = self.name(*name),
                (Expr::Call { name, name_span, args, .. }, Expr::Call { name: new_name, name_span: new_span, args: new_args, .. }) => {
                    (*new_name, *new_span) = (self.name(*name), self.span(*name_span));
                    for (arg, new) in args.iter().zip(new_args) {
                        new.name = arg.name.map(|(name, span)| (self.name(name), self.span(span)));
                    }
                }
                (_, new) => *new = self.expr(n, &mut stretches),
            }
        }
        (used.span, used.keyword_span) = (self.span(from.span), self.span(from.keyword_span));
        used.doc = doc;
        match (&from.kind, &mut used.kind) {
            (DeclarationKind::Value { bound, family, .. }, DeclarationKind::Value { bound: new_bound, .. }) if family.is_empty() => {
                *new_bound = self.bound(*bound);
            }
            (kind, new) => *new = self.kind(kind),
        }
    }

    #[inline]
    fn place(&self, first: u32, last: u32) -> Option<Span> {
        let (first, last) = (self.base + first as usize, self.base + last as usize);
        match self.places {
            Places::Read(tokens) => Some(tokens.stretch(first, last)),
            Places::Kept(places) => places.stretch(first, last),
            Places::None => None,
        }
    }

    fn span(&self, tokens: Span) -> Span {
        self.place(tokens.start, tokens.end).unwrap_or_default()
    }

    fn text(&self, token: u32) -> &str {
        self.place(token, token).map_or("\"\"", |Span { start, end }| &self.source[start as usize..end as usize])
    }

    fn name(&mut self, token: Name) -> Name {
        let place = self.place(token.0, token.0).unwrap_or_default();
        match &mut self.names {
            NameSource::Text(names) => names.intern(&self.source[place.start as usize..place.end as usize]),
            NameSource::Listed(listed) => listed.next().copied().unwrap_or(token),
            NameSource::Noted(noted) => {
                noted.push(token.0);
                token
            }
        }
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
