//! Operators in their order: a flat list of operands and operators to a tree, without recursion.

use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::*;
use crate::lang::syntax::mistake::Refused;
use crate::lang::syntax::token::Kind;
use crate::lang::syntax::tree::{Builder, Result};

/// A finished part of an expression, brackets included in its extent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub id: ExprId,
    /// First and last token.
    pub span: Span,
    /// It is `a..b` without brackets around it.
    pub is_run: bool,
    /// It is a comparison without brackets around it.
    compares: bool,
}

impl Term {
    pub fn new(id: ExprId, span: Span) -> Self {
        Self { id, span, is_run: false, compares: false }
    }
}

#[derive(Clone, Copy)]
struct Operator {
    kind: Kind,
    token: u32,
    prefix: bool,
}

impl Operator {
    /// How tightly it binds, from loose to tight.
    fn strength(self) -> u8 {
        match self.kind {
            Kind::OrWord => 1,
            Kind::AndWord => 2,
            Kind::Not => 3,
            Kind::EqualEqual | Kind::NotEqual | Kind::Less | Kind::LessEqual | Kind::Greater | Kind::GreaterEqual | Kind::Within => 4,
            Kind::DotDot => 5,
            Kind::Minus if self.prefix => 9,
            Kind::Plus | Kind::Minus => 6,
            Kind::Star | Kind::Slash => 7,
            Kind::And => 8,
            _ => 10,
        }
    }
}

/// Two stacks: operands, and operators that wait for their right side.
#[derive(Default)]
pub(crate) struct Climber {
    operands: Vec<Term>,
    operators: Vec<Operator>,
}

impl Climber {
    pub fn operand(&mut self, term: Term) {
        self.operands.push(term);
    }

    pub fn prefix(&mut self, token: u32, builder: &Builder<'_>) -> Result<()> {
        self.operators.push(Operator { kind: builder.kind(token), token, prefix: true });
        Ok(())
    }

    pub fn infix(&mut self, token: u32, builder: &mut Builder<'_>) -> Result<()> {
        let next = Operator { kind: builder.kind(token), token, prefix: false };
        let to_the_right = next.kind == Kind::Caret;
        while let Some(&top) = self.operators.last() {
            let stays = if to_the_right { top.strength() <= next.strength() } else { top.strength() < next.strength() };
            if stays {
                break;
            }
            self.reduce(builder)?;
        }
        self.operators.push(next);
        Ok(())
    }

    /// Takes the last operand back, to hang a field or index on it.
    pub fn last(&mut self) -> Result<Term> {
        self.operands.pop().ok_or_else(|| Refused::whole("an operand is missing", 0, 0))
    }

    pub fn end(mut self, builder: &mut Builder<'_>) -> Result<Term> {
        while !self.operators.is_empty() {
            self.reduce(builder)?;
        }
        self.last()
    }

    /// Applies the last operator.
    fn reduce(&mut self, builder: &mut Builder<'_>) -> Result<()> {
        let Some(op) = self.operators.pop() else { return Ok(()) };
        let b = self.last()?;
        if op.prefix {
            let unary = if op.kind == Kind::Not { Unary::Not } else { Unary::Minus };
            let span = Span { start: op.token, end: b.span.end };
            let id = builder.node(span, Expr::Unary(unary, b.id));
            self.operands.push(Term::new(id, span));
            return Ok(());
        }
        let a = self.last()?;
        let span = Span { start: a.span.start, end: b.span.end };
        let op_span = Span { start: op.token, end: op.token };
        if op.kind == Kind::Within {
            let equality = matches!(builder.nodes[a.id.index()].expr, Expr::Binary { op: Binary::Equal | Binary::NotEqual, .. });
            if !equality {
                return Err(Refused::Within { span: op_span, left: a.span });
            }
            let id = builder.node(span, Expr::Within { of: a.id, tolerance: b.id });
            self.operands.push(Term { compares: true, ..Term::new(id, span) });
            return Ok(());
        }
        let binary = binary(op.kind);
        let compares = op.strength() == 4;
        if compares && (a.compares || b.compares) {
            let middle = if a.compares { self.right_of(a.id, builder) } else { a.span };
            return Err(Refused::Chain { span: op_span, left: a.span, middle, right: b.span });
        }
        let id = builder.node(span, Expr::Binary { op: binary, op_span, a: a.id, b: b.id });
        self.operands.push(Term { id, span, is_run: binary == Binary::Run, compares });
        Ok(())
    }

    /// The right side of a comparison.
    fn right_of(&self, id: ExprId, builder: &Builder<'_>) -> Span {
        match builder.nodes[id.index()].expr {
            Expr::Binary { b, .. } | Expr::Within { tolerance: b, .. } => builder.nodes[b.index()].span,
            _ => builder.nodes[id.index()].span,
        }
    }
}

fn binary(kind: Kind) -> Binary {
    match kind {
        Kind::And => Binary::Meet,
        Kind::Star => Binary::Times,
        Kind::Slash => Binary::Divide,
        Kind::Plus => Binary::Plus,
        Kind::Minus => Binary::Minus,
        Kind::DotDot => Binary::Run,
        Kind::EqualEqual => Binary::Equal,
        Kind::NotEqual => Binary::NotEqual,
        Kind::Less => Binary::Less,
        Kind::LessEqual => Binary::LessEqual,
        Kind::Greater => Binary::Greater,
        Kind::GreaterEqual => Binary::GreaterEqual,
        Kind::AndWord => Binary::And,
        Kind::OrWord => Binary::Or,
        _ => Binary::Power,
    }
}
