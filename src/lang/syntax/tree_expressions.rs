//! Expressions of a declaration: what matched to nodes.

use crate::lang::diag::span::Span;
use crate::lang::syntax::Rule;
use crate::lang::syntax::ast::*;
use crate::lang::syntax::climb::{Climber, Term};
use crate::lang::syntax::matching::Pair;
use crate::lang::syntax::mistake::Refused;
use crate::lang::syntax::token::Kind;
use crate::lang::syntax::tree::{Builder, Result};
use crate::lang::words::names::Name;

impl Builder<'_> {
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

    pub(crate) fn for_clause(&mut self, pair: Pair<'_>) -> Result<For> {
        let Bound { name, span: name_span } = self.only_bound(pair, Rule::name)?;
        let list = self.exprs(pair)?[0];
        Ok(For { name, name_span, list })
    }

    pub(crate) fn args(&mut self, pair: Pair<'_>) -> Result<Vec<Arg>> {
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
    pub(crate) fn string(&mut self, pair: Pair<'_>) -> Result<ExprId> {
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
