//! Comparisons: equality, order, and both within a tolerance.

use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::operators::{At, is_zero, symbol};
use crate::lang::syntax::ast::{Binary, Expr, ExprId};
use crate::lang::values::types::dim_words;
use crate::lang::values::value::{Dim, Quantity, Value};

/// A comparison with what it compared.
#[derive(Clone, Debug)]
pub(crate) struct Comparison {
    pub left: Value,
    pub right: Value,
    pub holds: bool,
    /// The largest allowed difference, when there was a `within`.
    pub allowed: Option<Quantity>,
    /// The difference found.
    pub difference: Option<Quantity>,
}

pub(crate) fn compares(op: Binary) -> bool {
    use Binary::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    matches!(op, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
}

/// Whether equality of such a value needs a tolerance.
pub(crate) fn measured(value: &Value) -> bool {
    matches!(value, Value::Number(_) | Value::Vector(..) | Value::Node(_) | Value::Vertex(..))
}

/// Equality of values that compare as they are; `None` when they do not compare.
pub(crate) fn same(left: &Value, right: &Value) -> Option<bool> {
    Some(match (left, right) {
        (Value::None, Value::None) => true,
        (Value::None, _) | (_, Value::None) => false,
        (Value::Bool(a), Value::Bool(b)) => a == b,
        (Value::Number(a), Value::Number(b)) if a.dim.is_none() && b.dim.is_none() => a.value == b.value,
        (Value::Vector(a, Dim::NONE), Value::Vector(b, Dim::NONE)) => a == b,
        (Value::Text(a), Value::Text(b)) | (Value::Word(a), Value::Word(b)) => a == b,
        (Value::Link(m, a), Value::Link(n, b)) => (m, a) == (n, b),
        (Value::Edge(m, a), Value::Edge(n, b)) => (m, a) == (n, b),
        (Value::Vertex(m, a), Value::Vertex(n, b)) => (m, a) == (n, b),
        (Value::Patch(m, a), Value::Patch(n, b)) => (m, a) == (n, b),
        (Value::Record(a), Value::Record(b)) if !a.row && !b.row => {
            if a.keys.len() != b.keys.len() {
                return Some(false);
            }
            for (key, x) in a.keys.iter().zip(&a.values) {
                match b.get(*key) {
                    None => return Some(false),
                    Some(y) if !same(x, y)? => return Some(false),
                    _ => {}
                }
            }
            true
        }
        (a, b) => {
            let (Some(n), Some(m)) = (a.len(), b.len()) else { return None };
            if n != m {
                return Some(false);
            }
            for i in 0..n {
                if !same(&a.item(i)?, &b.item(i)?)? {
                    return Some(false);
                }
            }
            true
        }
    })
}

impl Cx<'_> {
    /// `==` and `!=` without `within`.
    pub(crate) fn equality(&mut self, at: At<'_>, left: &Value, right: &Value) -> Result<bool, Halt> {
        if let Err(stop) = self.comparable(&[left, right]) {
            return Err(self.at_operator(at, stop));
        }
        let equal = match (left, right) {
            (Value::Number(x), Value::Number(y)) if x.dim.is_none() && y.dim.is_none() => Some(x.value == y.value),
            (Value::Number(x), Value::Number(y)) => {
                self.same_dim(at, *x, *y)?;
                None
            }
            _ => same(left, right),
        };
        match equal {
            Some(equal) => Ok(equal == (at.op == Binary::Equal)),
            None if measured(left) && measured(right) => {
                let help = format!("`{} within 0.1%`", self.source(at.code, at.id));
                let draft = self.error(at.code, "E221", "two measured values are never equal", at.op_span, "needs `within`");
                let end = at.code.span(at.id).end;
                Err(draft.help(help).put(Span { start: end, end }, " within 0.1%").stop())
            }
            None => Err(self.misfit_operands(at, left, right)),
        }
    }

    pub(crate) fn order(&mut self, at: At<'_>, left: &Value, right: &Value) -> Result<bool, Halt> {
        let order = match (left, right) {
            (Value::Number(x), Value::Number(y)) => {
                let (x, y) = self.same_dim(at, *x, *y)?;
                x.value.partial_cmp(&y.value)
            }
            (Value::Text(x), Value::Text(y)) => Some(x.cmp(y)),
            _ => return Err(self.misfit_operands(at, left, right)),
        };
        Ok(order.is_some_and(|o| match at.op {
            Binary::Less => o.is_lt(),
            Binary::LessEqual => o.is_le(),
            Binary::Greater => o.is_gt(),
            _ => o.is_ge(),
        }))
    }

    /// `a == b within t`.
    pub(crate) fn within(&mut self, code: Code<'_>, of: ExprId, tolerance: ExprId) -> Result<Comparison, Halt> {
        let Expr::Binary { op, op_span, a, b } = *code.expr(of) else {
            return Err(self.error(code, "E102", "`within` follows `==`", code.span(of), "compare with `==` here").stop());
        };
        if !matches!(op, Binary::Equal | Binary::NotEqual) {
            let text = format!("`within` follows `==`, not `{}`", symbol(op));
            return Err(self.error(code, "E102", text, op_span, "use `==` here").stop());
        }
        let before = std::mem::replace(&mut self.machine.in_within, true);
        let result = self.near(At { code, op, op_span, id: of, a, b }, tolerance);
        self.machine.in_within = before;
        result
    }

    fn near(&mut self, at: At<'_>, tolerance: ExprId) -> Result<Comparison, Halt> {
        let code = at.code;
        let (left, right, limit) = (self.eval(code, at.a)?, self.eval(code, at.b)?, self.eval(code, tolerance)?);
        let (difference, size) = match (&left, &right) {
            (Value::Number(x), Value::Number(y)) => {
                let (x, y) = self.same_dim(at, *x, *y)?;
                (Quantity::new((x.value - y.value).abs(), x.dim), y.value.abs())
            }
            (
                a @ (Value::Vector(..) | Value::Node(_) | Value::Vertex(..)),
                b @ (Value::Vector(..) | Value::Node(_) | Value::Vertex(..)),
            ) => {
                let (a, b) = (self.as_vector(a.clone())?, self.as_vector(b.clone())?);
                let (a, b, dim) = self.same_vectors(at, a, b)?;
                (Quantity::new(a.distance(b), dim), b.length())
            }
            (a, b) => return Err(self.misfit_operands(at, a, b)),
        };
        let Value::Number(t) = limit else {
            let found = self.kind(&limit);
            return Err(self.error(code, "E211", format!("`within` takes a tolerance, got {found}"), code.span(tolerance), found).stop());
        };
        let allowed = if t.percent {
            t.value * size
        } else if t.dim == difference.dim || is_zero(code, tolerance) {
            t.value
        } else if t.dim.is_none() && difference.dim.is_length_power() {
            t.value * crate::lang::values::units::convert(1.0, self.machine.at(code.module).unit, self.program.unit, difference.dim.length)
        } else {
            let (found, wanted) = (dim_words(t.dim), dim_words(difference.dim));
            let draft =
                self.error(code, "E211", format!("this tolerance is {found}, the values differ by {wanted}"), code.span(tolerance), found);
            return Err(draft.help("a tolerance in the same unit, or relative like `0.1%`").stop());
        };
        let holds = (difference.value <= allowed) == (at.op == Binary::Equal);
        let allowed = Quantity::new(allowed, difference.dim);
        Ok(Comparison { left, right, holds, allowed: Some(allowed), difference: Some(difference) })
    }

    /// A comparison with its sides, for checks; `None` for any other expression.
    pub(crate) fn comparison(&mut self, code: Code<'_>, id: ExprId) -> Option<Result<Comparison, Halt>> {
        match *code.expr(id) {
            Expr::Within { of, tolerance } => Some(self.within(code, of, tolerance)),
            Expr::Binary { op, op_span, a, b } if compares(op) => Some(self.compared(At { code, op, op_span, id, a, b })),
            _ => None,
        }
    }

    fn compared(&mut self, at: At<'_>) -> Result<Comparison, Halt> {
        let (left, right) = match (self.eval(at.code, at.a), self.eval(at.code, at.b)) {
            (Ok(left), Ok(right)) => (left, right),
            (Err(x), Err(y)) => return Err(x.or(y)),
            (Err(stop), _) | (_, Err(stop)) => return Err(stop),
        };
        let holds = match at.op {
            Binary::Equal | Binary::NotEqual => self.equality(at, &left, &right)?,
            _ => self.order(at, &left, &right)?,
        };
        let difference = match (&left, &right) {
            (Value::Number(x), Value::Number(y)) => {
                Some(Quantity::new((x.value - y.value).abs(), if x.dim.is_none() { y.dim } else { x.dim }))
            }
            _ => None,
        };
        Ok(Comparison { left, right, holds, allowed: None, difference })
    }
}
