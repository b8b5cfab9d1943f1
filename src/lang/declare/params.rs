//! `param`: the only thing that may be set from outside, by a literal, inside its range.

use std::sync::Arc;

use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::module::{Given, Written};
use crate::lang::syntax::ast::{Allowed, Bound, DeclarationKind, Expr, ExprId, Keyword, Node, TextPart, TypeName, Unary};
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, ModuleId, Quantity, Value};
use crate::lang::words::names::nearest;

impl Cx<'_> {
    pub(crate) fn param(
        &mut self,
        code: Code<'_>,
        name: Bound,
        ty: Option<&TypeName>,
        value: ExprId,
        allowed: Option<&Allowed>,
    ) -> Result<Value, Halt> {
        let subject = format!("`{}`", self.program.names.text(name.name));
        let ty = match ty {
            Some(ty) => Some(self.written_type(code, ty)?),
            None => None,
        };
        let default = match ty {
            Some(ty) => self.eval_as(code, value, ty, &subject)?,
            None => self.eval(code, value)?,
        };
        let ty = match (ty, &default) {
            (Some(ty), _) => ty,
            (None, Value::Number(_) | Value::Bool(_) | Value::Text(_) | Value::Word(_)) => default.ty(),
            (None, other) => {
                let found = self.kind(other);
                let text = format!("a param is a number, quantity, bool, string or word, got {found}");
                return Err(self.error(code, "E211", text, code.span(value), found).help("`let` holds anything").stop());
            }
        };
        self.allowed(code, &subject, &default, (ty, allowed), None, code.span(value))?;
        let given = self.machine.at(code.module).given.iter().rev().find(|g| g.0 == name.name).map(|g| g.1.clone());
        match given {
            None => Ok(default),
            Some(given) => self.set_param(code, name, &subject, ty, allowed, given),
        }
    }

    /// A value from outside instead of the default.
    fn set_param(
        &mut self,
        code: Code<'_>,
        name: Bound,
        subject: &str,
        ty: Ty,
        allowed: Option<&Allowed>,
        given: Given,
    ) -> Result<Value, Halt> {
        let (value, file, span, words) = match given {
            Given::Value(value, file, span) => (Some(value), file, span, None),
            Given::Text(text, Written { file, value: span, cell: words, .. }) => {
                let literal = text.trim();
                let value = match ty {
                    Ty::Text if !literal.starts_with('"') => Some(Value::text(literal)),
                    Ty::Word => Some(Value::Word(literal.into())),
                    _ => self.literal_text(literal),
                };
                (value, file, span, words)
            }
        };
        let declared = self.machine.at(code.module).file;
        let fail = |cx: &mut Self, code: &'static str, message: String, label: &str| {
            let diagnostic = Diagnostic::new(code, message, file, span, label).label(declared, name.span, "declared here");
            cx.sink.reports.push(words.iter().fold(diagnostic, |d, words| d.note(words)));
            Halt::Failed
        };
        let Some(value) = value else {
            return Err(fail(
                self,
                "E211",
                format!("{subject} is set by a literal: a number with its unit, true, false or a word"),
                "not a literal",
            ));
        };
        let value = match self.coerce(value, ty, code.module) {
            Ok(value) => value,
            Err((value, _)) => {
                let (wanted, found) = (ty.words(), self.kind(&value));
                let label = found.clone();
                return Err(fail(self, "E211", format!("{subject} is {wanted}, got {found}"), &label));
            }
        };
        let said = self.sink.reports.len();
        let fits = self.allowed(code, subject, &value, (ty, allowed), Some((file, span)), name.span);
        if let (true, Some(words)) = (fits.is_err(), words) {
            self.sink.reports.iter_mut().skip(said).for_each(|d| d.notes.push(words.clone()));
        }
        fits?;
        Ok(value)
    }

    /// Whether a value is inside the range or among the choices.
    fn allowed(
        &mut self,
        code: Code<'_>,
        subject: &str,
        value: &Value,
        (ty, allowed): (Ty, Option<&Allowed>),
        outside: Option<(FileId, Span)>,
        span: Span,
    ) -> Result<(), Halt> {
        let (range, holds) = match allowed {
            None => return Ok(()),
            Some(Allowed::Range(a, b)) => {
                let (low, high) = (self.eval_as(code, *a, ty, "the range")?, self.eval_as(code, *b, ty, "the range")?);
                let (Value::Number(x), Value::Number(l), Value::Number(h)) = (value, &low, &high) else {
                    return Err(self.error(code, "E211", "a range goes from one number to another", code.span(*a), "not a number").stop());
                };
                if l.value > h.value {
                    return Err(self.error(code, "E306", "this range is empty", code.span(*a), "above the other end").stop());
                }
                (format!("{} to {}", self.show(&low), self.show(&high)), x.value >= l.value && x.value <= h.value)
            }
            Some(Allowed::Choices(items)) => {
                let mut choices = Vec::with_capacity(items.len());
                for item in items {
                    choices.push(self.eval_as(code, *item, ty, "a choice")?);
                }
                let near = |a: &Value, b: &Value| match (a, b) {
                    (Value::Number(x), Value::Number(y)) => x.value == y.value,
                    _ => crate::lang::eval::comparisons::same(a, b) == Some(true),
                };
                let texts: Vec<String> = choices.iter().map(|c| self.show_inside(c)).collect();
                (format!("one of {}", texts.join(", ")), choices.iter().any(|c| near(c, value)))
            }
        };
        if holds {
            return Ok(());
        }
        let message = format!("{subject} must be {range}, got {}", self.show_inside(value));
        match outside {
            None => Err(self.error(code, "E218", message, span, "outside").stop()),
            Some((file, place)) => {
                let declared = self.machine.at(code.module).file;
                self.sink.reports.push(Diagnostic::new("E218", message, file, place, "outside").label(declared, span, "declared here"));
                Err(Halt::Failed)
            }
        }
    }

    /// A literal as a value: a number, quantity, bool, text, word or one of these negated.
    pub(crate) fn literal_text(&mut self, text: &str) -> Option<Value> {
        if let Ok(value) = text.parse::<f64>()
            && value.is_finite()
            && text.starts_with(|c: char| c.is_ascii_digit() || c == '-')
        {
            return Some(Value::number(value));
        }
        let file = FileId(u32::MAX);
        let (script, mistakes) = crate::lang::syntax::parse(&format!("let x = {text}"), file, &mut self.program.names);
        if !mistakes.is_empty() {
            return None;
        }
        if script.declarations.len() != 1 {
            return None;
        }
        let only = script.declarations.whole(0);
        match &only.kind {
            DeclarationKind::Value { value, family, .. } if family.is_empty() => self.literal_value(&only.nodes, *value),
            _ => None,
        }
    }

    /// The value of an expression that is a literal.
    pub(crate) fn literal_value(&self, nodes: &[Node], id: ExprId) -> Option<Value> {
        Some(match &nodes[id.index()].expr {
            Expr::Number(x) if x.is_finite() => Value::number(*x),
            Expr::Quantity(x, unit) => Value::Number(units::quantity(*x, unit, self.program.unit)?),
            Expr::Bool(b) => Value::Bool(*b),
            Expr::Name(name) => Value::Word(self.program.names.text(*name).into()),
            Expr::Text(parts) => match parts.as_slice() {
                [] => Value::text(""),
                [TextPart::Literal(text)] => Value::text(text),
                _ => return None,
            },
            Expr::Unary(Unary::Minus, of) => match self.literal_value(nodes, *of)? {
                Value::Number(q) => Value::Number(Quantity { value: -q.value, ..q }),
                _ => return None,
            },
            Expr::Tuple(items) => {
                let mut v = [Quantity::bare(0.0); 3];
                for (slot, item) in v.iter_mut().zip(items) {
                    let Value::Number(q) = self.literal_value(nodes, *item)? else { return None };
                    *slot = q;
                }
                if v.iter().any(|q| !q.dim.is_none()) {
                    return None;
                }
                Value::Vector(glam::DVec3::new(v[0].value, v[1].value, v[2].value), Dim::NONE)
            }
            Expr::List(items) => Value::list(items.iter().map(|i| self.literal_value(nodes, *i)).collect::<Option<_>>()?),
            _ => return None,
        })
    }

    /// Params that a `--set`, a table or a `use` names, each checked to exist; E219 with the nearest one.
    pub(crate) fn give(&mut self, module: ModuleId, name: &str, given: Given) -> Result<(), Box<Diagnostic>> {
        let script = self.machine.at(module).script.clone();
        let params = || script.declarations.with_keyword(Keyword::Param).filter_map(|at| script.declarations.bound(at));
        if let Some(b) = params().find(|b| self.program.names.text(b.name) == name) {
            self.machine.at_mut(module).given.push((b.name, given));
            return Ok(());
        }
        let (file, span, words) = match given {
            Given::Text(_, Written { file, name, column: words, .. }) => (file, name, words),
            Given::Value(_, file, span) => (file, span, None),
        };
        let names: Vec<&str> = params().map(|b| self.program.names.text(b.name)).collect();
        let near = nearest(name, names.iter().copied());
        let label = near.map_or_else(|| "no such param".to_owned(), |n| format!("did you mean `{n}`?"));
        let diagnostic = Diagnostic::new("E219", format!("there is no param `{name}`"), file, span, label);
        let diagnostic = near.into_iter().fold(diagnostic, |d, near| d.put(span, near));
        let diagnostic = words.into_iter().fold(diagnostic, Diagnostic::note);
        Err(match names.is_empty() {
            true => diagnostic.note("this script has no params"),
            false => diagnostic.note(format!("its params are {}", names.join(", "))),
        }
        .into())
    }

    /// Params from outside by the texts of literals: of a table where their cells are known, else each with a file of its own.
    pub(crate) fn give_all(&mut self, module: ModuleId, sets: &[(String, String)], row: Option<&TableRow>) {
        let table = row.map(|row| (row, self.program.sources.add(&*row.file, &*row.text)));
        for (name, value) in sets {
            let cell = table.and_then(|(row, file)| Some((row, file, row.cells.iter().find(|cell| cell.name == *name)?)));
            let at = match cell {
                Some((row, file, cell)) => {
                    let column = format!("column {} of {}", cell.column, row.file);
                    let words = format!("row {}, column {} (`{name}`) of {}", row.number, cell.column, row.file);
                    Written { file, name: cell.head, value: cell.cell, column: Some(column), cell: Some(words) }
                }
                None => {
                    let text: Arc<str> = format!("{name}={value}").into();
                    let all = Span { start: 0, end: u32::try_from(text.len()).unwrap_or(u32::MAX) };
                    Written { file: self.program.sources.add("set", &*text), name: all, value: all, column: None, cell: None }
                }
            };
            if let Err(diagnostic) = self.give(module, name, Given::Text(value.as_str().into(), at)) {
                self.machine.filed.push((None, *diagnostic));
            }
        }
    }
}

/// A row of a table of variants: where its file says what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableRow {
    /// The table as named on the command line.
    pub file: Arc<str>,
    /// Its text.
    pub text: Arc<str>,
    /// Number of the row, from 1 below the header.
    pub number: usize,
    /// The cells that set params.
    pub cells: Vec<SetCell>,
}

/// A cell that sets a param.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetCell {
    /// Name of the param.
    pub name: String,
    /// Number of the column, from 1.
    pub column: usize,
    /// Where the head of the column stands in the text.
    pub head: Span,
    /// Where the cell stands.
    pub cell: Span,
}
