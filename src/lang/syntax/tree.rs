//! What matched to a `Shape`.

use crate::lang::diag::span::Span;
use crate::lang::syntax::Rule;
use crate::lang::syntax::ast::*;
use crate::lang::syntax::climb::{Climber, Term};
use crate::lang::syntax::matching::Pair;
use crate::lang::syntax::mistake::Refused;
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::shape::Shape;
use crate::lang::syntax::token::Kind;
use crate::lang::words::names::Name;

pub(crate) type Result<T> = std::result::Result<T, Refused>;

/// Builds the shape of one declaration.
pub(crate) struct Builder<'a> {
    tokens: &'a Tokens,
    base: usize,
    pub nodes: Vec<Node>,
    stretches: Vec<Vec<u32>>,
}

/// The shape of the declaration in tokens `base..end`, from the rule that matched it.
pub(crate) fn build(declaration: Pair<'_>, tokens: &Tokens, base: usize, end: usize) -> Result<Shape> {
    let mut builder = Builder { tokens, base, nodes: Vec::new(), stretches: Vec::new() };
    let kind = builder.declaration(declaration)?;
    let keyword = tokens.kinds[base].keyword().ok_or_else(|| Refused::whole("no keyword", 0, 0))?;
    let keyword_end = u32::from(keyword == Keyword::ModelingCurve);
    let span = Span { start: 0, end: (end - base - 1) as u32 };
    let keyword_span = Span { start: 0, end: keyword_end };
    let declaration = Declaration { keyword, span, keyword_span, doc: None, kind, nodes: builder.nodes };
    let powers = tokens.kinds[base..end].windows(3).enumerate();
    let powers = powers.filter(|(_, w)| **w == [Kind::Quantity, Kind::Caret, Kind::Number]).map(|(at, _)| at as u32).collect();
    Ok(Shape { declaration, stretches: builder.stretches.concat(), powers })
}

impl Builder<'_> {
    /// First and last token of a pair.
    pub fn extent(&self, pair: &Pair<'_>) -> Span {
        pair.extent()
    }

    pub fn kind(&self, token: u32) -> Kind {
        self.tokens.kinds[self.base + token as usize]
    }

    pub fn node(&mut self, span: Span, expr: Expr) -> ExprId {
        self.nodes.push(Node { span, expr });
        ExprId::at(self.nodes.len() - 1)
    }

    fn name(&self, pair: &Pair<'_>) -> (Name, Span) {
        let span = self.extent(pair);
        (Name(span.start), span)
    }

    fn bound(&self, pair: &Pair<'_>) -> Bound {
        let (name, span) = self.name(pair);
        Bound { name, span }
    }

    // ---- declarations

    fn declaration(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        match pair.as_rule() {
            Rule::units => Ok(DeclarationKind::Units(self.only_bound(pair, Rule::unit_name)?)),
            Rule::tolerance => Ok(DeclarationKind::Tolerance(self.exprs(pair)?)),
            Rule::snap => self.exprs(pair).map(|values| DeclarationKind::Snap(values[0])),
            Rule::load => self.load(pair),
            Rule::param => self.param(pair),
            Rule::fn_ => self.function(pair),
            Rule::value => self.value(pair),
            Rule::holder | Rule::mesh => self.collection(pair),
            _ => self.output(pair),
        }
    }

    fn only_bound(&self, pair: Pair<'_>, rule: Rule) -> Result<Bound> {
        let found = pair.into_inner().find(|p| p.as_rule() == rule);
        found.map(|p| self.bound(&p)).ok_or_else(|| Refused::whole("a name is missing", 0, 0))
    }

    /// All expressions that stand directly in a pair.
    fn exprs(&mut self, pair: Pair<'_>) -> Result<Vec<ExprId>> {
        pair.into_inner().filter(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p)).collect()
    }

    fn load(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut path, mut args) = (ExprId(0), Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::string => path = self.string(part)?,
                Rule::args => args = self.args(part)?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Load { path, args, bound })
    }

    fn param(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut ty, mut value, mut allowed) = (None, ExprId(0), None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::type_ => ty = Some(self.ty(part)),
                Rule::expr => value = self.expr(part)?,
                Rule::choices => allowed = Some(Allowed::Choices(self.exprs(part)?)),
                Rule::bounds => {
                    let ends = self.exprs(part)?;
                    allowed = Some(Allowed::Range(ends[0], ends[1]));
                }
                _ => {}
            }
        }
        Ok(DeclarationKind::Param { bound, ty, value, allowed })
    }

    fn ty(&self, pair: Pair<'_>) -> TypeName {
        let span = self.extent(&pair);
        let (mut lists, mut inner) = (0u8, pair);
        loop {
            let part = inner.into_inner().find(|p| matches!(p.as_rule(), Rule::type_ | Rule::word));
            match part {
                Some(part) if part.as_rule() == Rule::type_ => {
                    lists = lists.saturating_add(1);
                    inner = part;
                }
                Some(word) => return TypeName { name: self.name(&word).0, lists, span },
                None => return TypeName { name: Name(span.start), lists, span },
            }
        }
    }

    fn function(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut params, mut returns, mut body) = (Vec::new(), None, ExprId(0));
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::parameters => {
                    for one in part.into_inner().filter(|p| p.as_rule() == Rule::parameter) {
                        params.push(self.parameter(one)?);
                    }
                }
                Rule::type_ => returns = Some(self.ty(part)),
                Rule::expr => body = self.expr(part)?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Fn { bound, params, returns, body })
    }

    fn parameter(&mut self, pair: Pair<'_>) -> Result<FnParam> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut ty, mut default) = (None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::type_ => ty = Some(self.ty(part)),
                Rule::expr => default = Some(self.expr(part)?),
                _ => {}
            }
        }
        Ok(FnParam { bound, ty, default })
    }

    fn value(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut family, mut value) = (Vec::new(), ExprId(0));
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::for_clause => family.push(self.for_clause(part)?),
                Rule::expr => value = self.expr(part)?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Value { bound, family, value })
    }

    fn collection(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut family, mut things, mut settings, mut clauses) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::for_clause => family.push(self.for_clause(part)?),
                Rule::things => things = self.exprs(part)?,
                Rule::settings | Rule::mesh_settings => self.block(part, &mut settings, &mut clauses)?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Collection { bound, family, things, settings, clauses })
    }

    fn block(&mut self, pair: Pair<'_>, settings: &mut Vec<Setting>, clauses: &mut Vec<MeshClause>) -> Result<()> {
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::setting => settings.push(self.setting(part)?),
                Rule::clause => clauses.push(self.clause(part)?),
                _ => {}
            }
        }
        Ok(())
    }

    fn setting(&mut self, pair: Pair<'_>) -> Result<Setting> {
        let Bound { name: key, span: key_span } = self.only_bound(pair, Rule::word)?;
        let value = self.exprs(pair)?[0];
        Ok(Setting { key, key_span, value })
    }

    fn clause(&mut self, pair: Pair<'_>) -> Result<MeshClause> {
        let span = self.extent(&pair);
        let word = match self.kind(span.start) {
            Kind::On => ClauseWord::On,
            Kind::Near => ClauseWord::Near,
            _ => ClauseWord::In,
        };
        let (mut things, mut settings) = (Vec::new(), Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::things => things = self.exprs(part)?,
                Rule::settings => self.block(part, &mut settings, &mut Vec::new())?,
                _ => {}
            }
        }
        Ok(MeshClause { word, span, things, settings })
    }

    fn output(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let (mut label, mut things, mut family, mut to, mut settings) = (None, Vec::new(), Vec::new(), None, Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::label => {
                    if let Some(string) = part.into_inner().next() {
                        label = Some(self.string(string)?);
                    }
                }
                Rule::expr => things.push(self.expr(part)?),
                Rule::things => things = self.exprs(part)?,
                Rule::for_clause => family.push(self.for_clause(part)?),
                Rule::string => to = Some(self.string(part)?),
                Rule::settings => self.block(part, &mut settings, &mut Vec::new())?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Output { label, things, family, to, settings })
    }

    // ---- expressions

    pub fn expr(&mut self, pair: Pair<'_>) -> Result<ExprId> {
        self.term(pair).map(|t| t.id)
    }

    /// An expression with what its climber knows about it.
    fn term(&mut self, pair: Pair<'_>) -> Result<Term> {
        let mut climber = Climber::default();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::prefix => climber.prefix(self.extent(&part).start, self)?,
                Rule::infix => climber.infix(self.extent(&part).start, self)?,
                Rule::field | Rule::index => {
                    let of = climber.last()?;
                    let term = self.postfix(of, part)?;
                    climber.operand(term);
                }
                _ => {
                    let term = self.primary(part)?;
                    climber.operand(term);
                }
            }
        }
        climber.end(self)
    }

    fn primary(&mut self, pair: Pair<'_>) -> Result<Term> {
        let span = self.extent(&pair);
        let expr = match pair.as_rule() {
            Rule::number => Expr::Number(0.0),
            Rule::quantity => Expr::Quantity(0.0, Box::default()),
            Rule::string => return self.string(pair).map(|id| Term::new(id, span)),
            Rule::literal => match self.kind(span.start) {
                Kind::True => Expr::Bool(true),
                Kind::False => Expr::Bool(false),
                _ => Expr::None,
            },
            Rule::choice => {
                let parts = self.exprs(pair)?;
                Expr::If { condition: parts[0], then: parts[1], otherwise: parts[2] }
            }
            Rule::local => {
                let Bound { name, span: name_span } = self.only_bound(pair, Rule::name)?;
                let parts = self.exprs(pair)?;
                Expr::Let { name, name_span, value: parts[0], body: parts[1] }
            }
            Rule::list => Expr::List(self.exprs(pair)?),
            Rule::group => {
                let parts = self.exprs(pair)?;
                if let [one] = parts[..] {
                    return Ok(Term::new(one, span));
                }
                Expr::Tuple(parts)
            }
            Rule::record => Expr::Record(self.record(pair)?),
            Rule::comprehension => self.comprehension(pair)?,
            _ => self.reference(pair)?,
        };
        Ok(Term::new(self.node(span, expr), span))
    }

    fn reference(&mut self, pair: Pair<'_>) -> Result<Expr> {
        let Bound { name, span: name_span } = self.only_bound(pair, Rule::name)?;
        match pair.into_inner().find(|p| p.as_rule() == Rule::args) {
            Some(args) => Ok(Expr::Call { name, name_span, of: None, args: self.args(args)? }),
            None => Ok(Expr::Name(name)),
        }
    }

    fn record(&mut self, pair: Pair<'_>) -> Result<Vec<(Name, ExprId)>> {
        let mut pairs = Vec::new();
        for one in pair.into_inner().filter(|p| p.as_rule() == Rule::pair) {
            let setting = self.setting(one)?;
            pairs.push((setting.key, setting.value));
        }
        Ok(pairs)
    }

    fn comprehension(&mut self, pair: Pair<'_>) -> Result<Expr> {
        let (mut clauses, mut body) = (Vec::new(), ExprId(0));
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::for_clause => clauses.push(Clause::For(self.for_clause(part)?)),
                Rule::if_clause => clauses.push(Clause::If(self.exprs(part)?[0])),
                Rule::expr => body = self.expr(part)?,
                _ => {}
            }
        }
        Ok(Expr::Comprehension { clauses, body })
    }

    fn for_clause(&mut self, pair: Pair<'_>) -> Result<For> {
        let Bound { name, span: name_span } = self.only_bound(pair, Rule::name)?;
        let list = self.exprs(pair)?[0];
        Ok(For { name, name_span, list })
    }

    fn args(&mut self, pair: Pair<'_>) -> Result<Vec<Arg>> {
        let mut args = Vec::new();
        for arg in pair.into_inner().filter(|p| p.as_rule() == Rule::arg) {
            let mut name = None;
            for part in arg.into_inner() {
                match part.as_rule() {
                    Rule::word => name = Some(self.name(&part)),
                    Rule::expr => args.push(Arg { name, value: self.expr(part)? }),
                    _ => {}
                }
            }
        }
        Ok(args)
    }

    fn postfix(&mut self, of: Term, pair: Pair<'_>) -> Result<Term> {
        let span = Span { start: of.span.start, end: self.extent(&pair).end };
        let expr = if pair.as_rule() == Rule::field {
            let Bound { name, span: name_span } = self.only_bound(pair, Rule::word)?;
            match pair.into_inner().find(|p| p.as_rule() == Rule::args) {
                Some(args) => Expr::Call { name, name_span, of: Some(of.id), args: self.args(args)? },
                None => Expr::Field { of: of.id, name, name_span },
            }
        } else {
            let slice = pair
                .into_inner()
                .find(|p| p.as_rule() == Rule::slice)
                .ok_or_else(|| Refused::whole("an empty index", span.start, span.end))?;
            Expr::Index { of: of.id, index: self.slice(slice)? }
        };
        Ok(Term::new(self.node(span, expr), span))
    }

    /// `A..B` in an index is a slice, whichever ends are written.
    fn slice(&mut self, pair: Pair<'_>) -> Result<ExprId> {
        let span = self.extent(&pair);
        let (mut ends, mut run_at) = (Vec::new(), None);
        for part in pair.into_inner() {
            if part.as_rule() == Rule::run {
                run_at = Some(ends.len());
            } else {
                ends.push(self.term(part)?);
            }
        }
        let first = ends.first().map(|t| t.id);
        match (run_at, first) {
            (Some(0), to) => Ok(self.node(span, Expr::Slice { from: None, to })),
            (Some(_), from) => Ok(self.node(span, Expr::Slice { from, to: None })),
            (None, Some(id)) => {
                let run = ends[0].is_run;
                match self.nodes[id.index()].expr {
                    Expr::Binary { op: Binary::Run, a, b, .. } if run => {
                        self.nodes[id.index()].expr = Expr::Slice { from: Some(a), to: Some(b) };
                        Ok(id)
                    }
                    _ => Ok(id),
                }
            }
            (None, None) => Err(Refused::whole("an empty index", span.start, span.end)),
        }
    }

    /// Stretches and values in turn; the stretches are found among the tokens around the values.
    fn string(&mut self, pair: Pair<'_>) -> Result<ExprId> {
        let span = self.extent(&pair);
        let (mut parts, mut stretches) = (vec![TextPart::Literal(Box::default())], vec![span.start]);
        for part in pair.into_inner().filter(|p| p.as_rule() == Rule::expr) {
            let end = self.extent(&part).end;
            parts.push(TextPart::Value(self.expr(part)?));
            parts.push(TextPart::Literal(Box::default()));
            stretches.push(end + 1);
        }
        self.stretches.push(stretches);
        Ok(self.node(span, Expr::Text(parts)))
    }
}
