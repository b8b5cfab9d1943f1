//! Infix operators: arithmetic with dimensions, comparison, and the joining and meeting of curves.

use glam::DVec3;

use crate::base::limits;
use crate::lang::diag::span::Span;
use crate::lang::eval::bind::Blame;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::room::LIST_COST;
use crate::lang::syntax::ast::{Binary, Expr, ExprId};
use crate::lang::values::types::dim_words;
use crate::lang::values::value::{Dim, Quantity, Value};
use crate::network::Chain;

pub(crate) fn symbol(op: Binary) -> &'static str {
    match op {
        Binary::Power => "^",
        Binary::Meet => "&",
        Binary::Times => "*",
        Binary::Divide => "/",
        Binary::Plus => "+",
        Binary::Minus => "-",
        Binary::Run => "..",
        Binary::Equal => "==",
        Binary::NotEqual => "!=",
        Binary::Less => "<",
        Binary::LessEqual => "<=",
        Binary::Greater => ">",
        Binary::GreaterEqual => ">=",
        Binary::And => "and",
        Binary::Or => "or",
    }
}

/// An operator with its operands, for messages.
#[derive(Clone, Copy)]
pub(crate) struct At<'c> {
    pub code: Code<'c>,
    pub op: Binary,
    pub op_span: Span,
    pub id: ExprId,
    pub a: ExprId,
    pub b: ExprId,
}

impl Cx<'_> {
    pub(crate) fn binary(&mut self, code: Code<'_>, id: ExprId, op: Binary, op_span: Span, a: ExprId, b: ExprId) -> Result<Value, Halt> {
        match op {
            Binary::And => return Ok(Value::Bool(self.condition(code, a)? && self.condition(code, b)?)),
            Binary::Or => return Ok(Value::Bool(self.condition(code, a)? || self.condition(code, b)?)),
            _ => {}
        }
        let left = self.eval(code, a);
        let right = self.eval(code, b);
        let (left, right) = match (left, right) {
            (Ok(left), Ok(right)) => (left, right),
            (Err(stop), Ok(_)) | (Ok(_), Err(stop)) => return Err(stop),
            (Err(x), Err(y)) => return Err(x.or(y)),
        };
        let at = At { code, op, op_span, id, a, b };
        match op {
            Binary::Plus | Binary::Minus => self.sum(at, left, right),
            Binary::Times | Binary::Divide => self.product(at, left, right),
            Binary::Power => self.power(at, left, right),
            Binary::Run => self.range(at, &left, &right),
            Binary::Meet => {
                self.machine.site.expr = id;
                crate::lang::eval::meetings::meet_once(self, &left, &right).map_err(|stop| self.at_operator(at, stop))
            }
            Binary::Equal | Binary::NotEqual => self.equality(at, &left, &right).map(Value::Bool),
            _ => self.order(at, &left, &right).map(Value::Bool),
        }
    }

    /// A fault of an operator, shown at it.
    pub(crate) fn at_operator(&mut self, at: At<'_>, stop: Halt) -> Halt {
        match stop {
            Halt::Fault(fault) => {
                let sides = vec![("a", at.code.span(at.a)), ("b", at.code.span(at.b))];
                let blame = Blame { items: sides.clone(), whole: sides };
                let mut diagnostic = self.locate(&fault, at.code, at.code.span(at.id), &blame);
                self.advise(&fault, at.code, at.id, &blame, &mut diagnostic);
                self.sink.reports.push(diagnostic);
                Halt::Failed
            }
            other => other,
        }
    }

    fn sum(&mut self, at: At<'_>, left: Value, right: Value) -> Result<Value, Halt> {
        let sign = if at.op == Binary::Plus { 1.0 } else { -1.0 };
        match (left, right) {
            (Value::Number(x), Value::Number(y)) => {
                let (x, y) = self.same_dim(at, x, y)?;
                self.finite(at, Quantity::new(x.value + sign * y.value, x.dim))
            }
            (
                a @ (Value::Vector(..) | Value::Node(_) | Value::Vertex(..)),
                b @ (Value::Vector(..) | Value::Node(_) | Value::Vertex(..)),
            ) => {
                let ((a, da), (b, db)) = (self.as_vector(a)?, self.as_vector(b)?);
                let (a, b, dim) = self.same_vectors(at, (a, da), (b, db))?;
                self.finite_vector(at, a + b * sign, dim)
            }
            (Value::List(a), Value::List(b)) if at.op == Binary::Plus => {
                if a.len() + b.len() > limits::LIST_MEMBERS {
                    return Err(self.too_long(at.code, at.id, "this list"));
                }
                self.made(at.code, at.id, LIST_COST + a.len() + b.len())?;
                self.steps(a.len() + b.len())?;
                Ok(Value::list(a.iter().chain(b.iter()).cloned().collect()))
            }
            (a @ (Value::Curve(_) | Value::Link(..)), b @ (Value::Curve(_) | Value::Link(..))) if at.op == Binary::Plus => {
                let tolerance = self.tolerance()?;
                let parts = [self.as_chain(a)?, self.as_chain(b)?];
                self.machine.site.expr = at.id;
                let origin = self.origin();
                Chain::join(&parts, origin, &tolerance).map(Value::Curve).map_err(|f| self.at_operator(at, f.into()))
            }
            (Value::Text(a), Value::Text(_) | Value::Number(_)) if at.op == Binary::Plus => {
                let draft = self.error(at.code, "E211", "texts are joined by interpolation", at.op_span, "not by `+`");
                Err(draft.help(format!("\"{}{{…}}\"", a.replace('"', "\\\""))).stop())
            }
            (a, b) => Err(self.misfit_operands(at, &a, &b)),
        }
    }

    fn product(&mut self, at: At<'_>, left: Value, right: Value) -> Result<Value, Halt> {
        let times = at.op == Binary::Times;
        match (left, right) {
            (Value::Number(x), Value::Number(y)) => {
                let dim = if times { x.dim.times(y.dim) } else { x.dim.over(y.dim) };
                let value = if times { x.value * y.value } else { x.value / y.value };
                if !times && y.value == 0.0 {
                    let span = at.code.span(at.b);
                    return Err(self.error(at.code, "E306", "division by zero", at.op_span, "divides here").and(span, "this is 0").stop());
                }
                let dim = self.dim_of(at, dim)?;
                self.finite(at, Quantity::new(value, dim))
            }
            (Value::Number(x), v @ (Value::Vector(..) | Value::Node(_))) if times => self.scale(at, v, x, true),
            (v @ (Value::Vector(..) | Value::Node(_)), Value::Number(x)) => self.scale(at, v, x, times),
            (Value::Vector(..), Value::Vector(..)) if times => {
                let (a, b) = (self.source(at.code, at.a), self.source(at.code, at.b));
                let draft = self.error(at.code, "E211", "two vectors have two products", at.op_span, "which one?");
                let (dot, cross) = (format!("dot({a}, {b})"), format!("cross({a}, {b})"));
                let (whole, help) = (at.code.span(at.id), format!("`{dot}` or `{cross}`"));
                Err(draft.help(help).put(whole, dot).put(whole, cross).stop())
            }
            (a, b) => Err(self.misfit_operands(at, &a, &b)),
        }
    }

    fn scale(&mut self, at: At<'_>, vector: Value, by: Quantity, times: bool) -> Result<Value, Halt> {
        let (v, dim) = self.as_vector(vector)?;
        let out = if times { dim.times(by.dim) } else { dim.over(by.dim) };
        let v = if times { v * by.value } else { v / by.value };
        let dim = self.dim_of(at, out)?;
        self.finite_vector(at, v, dim)
    }

    fn dim_of(&mut self, at: At<'_>, dim: Option<Dim>) -> Result<Dim, Halt> {
        dim.ok_or_else(|| self.error(at.code, "E211", "the dimension of this is out of range", at.op_span, "here").stop())
    }

    fn power(&mut self, at: At<'_>, left: Value, right: Value) -> Result<Value, Halt> {
        let (Value::Number(x), Value::Number(n)) = (&left, &right) else { return Err(self.misfit_operands(at, &left, &right)) };
        if !n.dim.is_none() {
            let found = dim_words(n.dim);
            return Err(self.error(at.code, "E211", format!("an exponent is a number, got {found}"), at.code.span(at.b), found).stop());
        }
        let whole = (n.value == n.value.trunc() && n.value.abs() <= 127.0).then_some(n.value as i8);
        let dim = match whole {
            _ if x.dim.is_none() => Some(Dim::NONE),
            Some(n) => x.dim.power(n),
            // A root leaves whole exponents or none.
            None => [2_i8, 3, 4]
                .into_iter()
                .find(|k| n.value * f64::from(*k) == (n.value * f64::from(*k)).trunc() && (n.value * f64::from(*k)).abs() < 127.0)
                .and_then(|k| x.dim.power((n.value * f64::from(k)) as i8)?.root(k)),
        };
        let Some(dim) = dim else {
            let text = format!("{} to the power {} has no dimension", dim_words(x.dim), crate::lang::values::units::number_text(n.value));
            return Err(self.error(at.code, "E211", text, at.op_span, "here").stop());
        };
        let value = match whole {
            Some(n) => crate::base::math::powi(x.value, i32::from(n)),
            None => crate::base::math::pow(x.value, n.value),
        };
        self.finite(at, Quantity::new(value, dim))
    }

    fn range(&mut self, at: At<'_>, left: &Value, right: &Value) -> Result<Value, Halt> {
        let end = |cx: &mut Self, value: &Value, id: ExprId| match value {
            Value::Number(q) if q.dim.is_none() && q.value == q.value.trunc() && q.value.abs() < 9e15 => Ok(q.value as i64),
            Value::Number(q) if !q.dim.is_none() => {
                let found = dim_words(q.dim);
                let draft = cx.error(at.code, "E211", format!("a range runs over whole numbers, got {found}"), at.code.span(id), found);
                Err(draft.help("`linspace(a, b, n)` gives n quantities from a to b").stop())
            }
            other => {
                let found = cx.show_inside(other);
                Err(cx.error(at.code, "E211", format!("a range runs over whole numbers, got {found}"), at.code.span(id), found).stop())
            }
        };
        let a = end(self, left, at.a)?;
        let range = Value::Range(a, end(self, right, at.b)?);
        match range.len() {
            Some(n) if n > limits::LIST_MEMBERS => Err(self.too_long(at.code, at.id, "this range")),
            _ => Ok(range),
        }
    }

    /// Two numbers to be added or compared: of one dimension, a literal 0 fitting any.
    pub(crate) fn same_dim(&mut self, at: At<'_>, x: Quantity, y: Quantity) -> Result<(Quantity, Quantity), Halt> {
        if x.dim == y.dim {
            return Ok((x, y));
        }
        if is_zero(at.code, at.a) {
            return Ok((Quantity::new(0.0, y.dim), y));
        }
        if is_zero(at.code, at.b) {
            return Ok((x, Quantity::new(0.0, x.dim)));
        }
        if x.dim.is_none() || y.dim.is_none() {
            return Err(self.bare_beside(at, x, y));
        }
        Err(self.misfit_operands(at, &Value::Number(x), &Value::Number(y)))
    }

    /// E212: a bare number beside a quantity, with the text that would do.
    #[cold]
    fn bare_beside(&mut self, at: At<'_>, x: Quantity, y: Quantity) -> Halt {
        let (bare, other, dim) = if x.dim.is_none() { (at.a, at.b, y.dim) } else { (at.b, at.a, x.dim) };
        let value = if x.dim.is_none() { x.value } else { y.value };
        let text = self.source(at.code, bare);
        let typed = |unit: &String| match at.code.expr(bare) {
            Expr::Number(_) => format!("{text}{unit}"),
            Expr::Name(_) | Expr::Field { .. } | Expr::Index { .. } | Expr::Call { .. } => format!("{text} * 1{unit}"),
            _ => format!("({text}) * 1{unit}"),
        };
        let (a, b) = (self.source(at.code, at.a), self.source(at.code, at.b));
        let within = if matches!(at.op, Binary::Equal | Binary::NotEqual) && !self.machine.in_within { " within 0.1%" } else { "" };
        let whole = |unit: &String| {
            let (a, b) = if bare == at.a { (typed(unit), b.clone()) } else { (a.clone(), typed(unit)) };
            format!("{a} {} {b}{within}", symbol(at.op))
        };
        let meant = crate::lang::values::units::meant_units(value, dim, self.machine.at(at.code.module).unit);
        if let Some((call, unit)) = self.empty_sum(at.code, bare, value).zip(meant.first()) {
            let typed = format!("{}, start: 0{unit})", call.1.trim_end_matches(')'));
            let draft =
                self.error(at.code, "E212", format!("a bare number beside {}", dim_words(dim)), at.op_span, "one dimension is needed");
            let draft = draft.and(at.code.span(bare), "the sum of an empty list is a bare 0").and(at.code.span(other), dim_words(dim));
            return draft.ways(call.0, &[typed]).stop();
        }
        let ways: Vec<String> = meant.iter().map(whole).collect();
        let help: Vec<String> = ways.iter().map(|way| format!("`{way}`")).collect();
        let words = dim_words(dim);
        let draft = self
            .error(at.code, "E212", format!("a bare number beside {words}"), at.op_span, format!("`{}` needs one dimension", symbol(at.op)))
            .and(at.code.span(bare), "a bare number")
            .and(at.code.span(other), words)
            .help(help.join(" or "));
        ways.into_iter().fold(draft, |draft, way| draft.put(at.code.span(at.id), way)).stop()
    }

    /// Where the sum of an empty list was made, and its text: the operand itself, or what the name that it is was declared as.
    fn empty_sum(&self, code: Code<'_>, id: ExprId, value: f64) -> Option<(Span, String)> {
        let is_sum = |nodes: &[crate::lang::syntax::ast::Node], id: ExprId| match &nodes[id.index()].expr {
            Expr::Call { name, args, .. } => self.program.names.text(*name) == "sum" && args.iter().all(|a| a.name.is_none()),
            _ => false,
        };
        if value != 0.0 {
            return None;
        }
        if is_sum(code.nodes, id) {
            return Some((code.span(id), self.source(code, id)));
        }
        let Expr::Name(name) = code.expr(id) else { return None };
        let module = self.machine.at(code.module);
        let declaration = module.script.declarations.whole(module.find(*name)? as usize);
        match &declaration.kind {
            crate::lang::syntax::ast::DeclarationKind::Value { value, .. } if is_sum(&declaration.nodes, *value) => {
                let span = declaration.nodes[value.index()].span;
                Some((span, self.program.sources.text(module.file, span).to_owned()))
            }
            _ => None,
        }
    }

    pub(crate) fn same_vectors(&mut self, at: At<'_>, a: (DVec3, Dim), b: (DVec3, Dim)) -> Result<(DVec3, DVec3, Dim), Halt> {
        let bare = self.bare_unit(at.code.module);
        match (a.1, b.1) {
            (x, y) if x == y => Ok((a.0, b.0, x)),
            (Dim::NONE, Dim::LENGTH) => Ok((a.0 * bare, b.0, Dim::LENGTH)),
            (Dim::LENGTH, Dim::NONE) => Ok((a.0, b.0 * bare, Dim::LENGTH)),
            _ => Err(self.misfit_operands(at, &Value::Vector(a.0, a.1), &Value::Vector(b.0, b.1))),
        }
    }

    /// E211 at an operator: what stands on its two sides.
    #[cold]
    pub(crate) fn misfit_operands(&mut self, at: At<'_>, left: &Value, right: &Value) -> Halt {
        let words = |cx: &Self, v: &Value| match v {
            Value::Vector(_, dim) if !dim.is_none() && *dim != Dim::LENGTH => format!("a vector of {}", dim_words(*dim)),
            other => cx.kind(other),
        };
        let (a, b) = (words(self, left), words(self, right));
        let doing = match at.op {
            Binary::Plus => format!("{a} and {b} cannot be added"),
            Binary::Minus => format!("{b} cannot be subtracted from {a}"),
            Binary::Times => format!("{a} and {b} cannot be multiplied"),
            Binary::Divide => format!("{a} cannot be divided by {b}"),
            Binary::Power => format!("{a} cannot be raised to the power of {b}"),
            Binary::Meet => format!("{a} and {b} do not meet"),
            _ => format!("{a} and {b} cannot be compared"),
        };
        let (sa, sb) = (at.code.span(at.a), at.code.span(at.b));
        let cell = [left, right].into_iter().find_map(|v| if let Value::Text(text) = v { self.cell_of(text) } else { None });
        let ways = self.along_axes(at, left, right);
        let cut = self.cut_off(at, left, right);
        let draft = self.error(at.code, "E211", doing, at.op_span, format!("`{}` here", symbol(at.op))).and(sb, b).and(sa, a).notes(cell);
        match cut {
            Some(cut) => draft.help(cut).stop(),
            None if ways.is_empty() => draft.stop(),
            None => draft.ways(at.code.span(at.id), &ways).stop(),
        }
    }

    /// What is written where a surface is taken from another one as bodies are elsewhere.
    fn cut_off(&self, at: At<'_>, left: &Value, right: &Value) -> Option<String> {
        let cuts = matches!(left, Value::Surface(_)) && matches!(right, Value::Surface(_) | Value::Shell(_));
        let (a, b) = (self.source(at.code, at.a), self.source(at.code, at.b));
        (at.op == Binary::Minus && cuts).then(|| format!("`trim({a}, by: {b}, keep: P)`, where `P` is a point of the part that stays"))
    }

    /// `A + 2m` as a step along each axis.
    fn along_axes(&self, at: At<'_>, left: &Value, right: &Value) -> Vec<String> {
        let point = matches!(left, Value::Vector(_, Dim::LENGTH) | Value::Node(_) | Value::Vertex(..));
        let length = matches!(right, Value::Number(q) if q.dim == Dim::LENGTH);
        if !point || !length || !matches!(at.op, Binary::Plus | Binary::Minus) {
            return Vec::new();
        }
        let (a, b) = (self.source(at.code, at.a), self.source(at.code, at.b));
        ["({b}, 0, 0)", "(0, {b}, 0)", "(0, 0, {b})"]
            .iter()
            .map(|way| format!("{a} {} {}", symbol(at.op), way.replace("{b}", &b)))
            .collect()
    }

    #[inline]
    fn finite(&mut self, at: At<'_>, q: Quantity) -> Result<Value, Halt> {
        if q.value.is_finite() { Ok(Value::Number(q)) } else { Err(self.not_finite(at)) }
    }

    fn finite_vector(&mut self, at: At<'_>, v: DVec3, dim: Dim) -> Result<Value, Halt> {
        if v.is_finite() { Ok(Value::Vector(v, dim)) } else { Err(self.not_finite(at)) }
    }

    #[cold]
    fn not_finite(&mut self, at: At<'_>) -> Halt {
        self.error(at.code, "E408", "the result is not a finite number", at.op_span, "too large, or undefined, here").stop()
    }

    /// The text of an expression.
    pub(crate) fn source(&self, code: Code<'_>, id: ExprId) -> String {
        self.program.sources.text(self.machine.at(code.module).file, code.span(id)).to_owned()
    }
}

/// Whether the expression is a literal 0, which fits any dimension.
pub(crate) fn is_zero(code: Code<'_>, id: ExprId) -> bool {
    match code.expr(id) {
        Expr::Number(value) => *value == 0.0,
        Expr::Unary(crate::lang::syntax::ast::Unary::Minus, of) => is_zero(code, *of),
        _ => false,
    }
}
