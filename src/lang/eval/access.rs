//! Fields, members of modules and records, and indices.

use crate::lang::diag::span::Span;
use crate::lang::eval::coerce::accepts;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::misspelt::{Among, Unknown};
use crate::lang::eval::room::LIST_COST;
use crate::lang::eval::std;
use crate::lang::syntax::ast::{Expr, ExprId, Keyword};
use crate::lang::values::types::Ty;
use crate::lang::values::value::{ModuleId, Record, Value};
use crate::lang::words::elsewhere::meant;
use crate::lang::words::lookalikes;
use crate::lang::words::names::Name;

impl Cx<'_> {
    /// `of.name`: a record's field, a name of a module, a field of the kind, then a function of one value.
    pub(crate) fn field(&mut self, code: Code<'_>, id: ExprId, of: ExprId, name: Name, span: Span) -> Result<Value, Halt> {
        let value = self.eval(code, of)?;
        match &value {
            Value::Record(r) => {
                if let Some(value) = r.get(name) {
                    return Ok(value.clone());
                }
            }
            Value::Module(module) => return self.member_of(code, id, *module, name, span),
            _ => {}
        }
        let (function, has_fields) = self.word(name);
        if has_fields && let Some(field) = self.field_for(name, &value) {
            return self.run(code, id, field, Some(value), &[]);
        }
        if let Some(declaration) = self.script_fn(code.module, name) {
            return self.call_fn(code, id, code.module, declaration, Some(value), &[]);
        }
        match function {
            Some(function) if !matches!(value, Value::Record(_)) || accepts(function.params.first().map_or(Ty::None, |p| p.ty), &value) => {
                self.run(code, id, function, Some(value), &[])
            }
            _ => Err(self.no_field(code, &value, name, span)),
        }
    }

    /// `ribs.arch`: what a module declares.
    fn member_of(&mut self, code: Code<'_>, id: ExprId, module: ModuleId, name: Name, span: Span) -> Result<Value, Halt> {
        match self.machine.at(module).find(name) {
            Some(declaration) if self.machine.at(module).script.declarations.keyword(declaration as usize) != Keyword::Fn => {
                self.machine.site.expr = id;
                self.ensure(module, declaration)
            }
            None if self.machine.at(module).is_broken(name) => Err(Halt::Broken),
            found => {
                let label = self.machine.at(module).label.clone();
                let text = self.program.names.text(name).to_owned();
                if found.is_some() {
                    let draft = self.error(code, "E211", format!("`{label}.{text}` is a function"), span, "functions are not values");
                    return Err(draft.help(format!("call it: `{label}.{text}(…)`")).stop());
                }
                self.note_unknown(code.module, span, Unknown { name, of: module, among: Among::Members });
                Err(self.error(code, "E214", format!("`{label}` declares no `{text}`"), span, "not in that script").stop())
            }
        }
    }

    /// E214: nothing of that name for this kind.
    #[cold]
    pub(crate) fn no_field(&mut self, code: Code<'_>, value: &Value, name: Name, span: Span) -> Halt {
        let text = self.program.names.text(name).to_owned();
        let kind = self.kind(value);
        let fields: Vec<String> = match value {
            Value::Record(r) => r.keys.iter().map(|k| self.program.names.text(*k).to_owned()).collect(),
            _ => std::fields().filter(|f| f.params.first().is_some_and(|p| accepts(p.ty, value))).map(|f| f.name.to_owned()).collect(),
        };
        let near = meant(&text, fields.iter().map(String::as_str)).map(str::to_owned);
        let alike = near.as_deref().and_then(|near| lookalikes::difference(&text, near));
        let draft = self.error(code, "E214", format!("{kind} has no `{text}`"), span, "no such field").notes(alike);
        match near {
            Some(near) => draft.help(format!("`.{near}`")).put(span, near).stop(),
            None if fields.is_empty() || fields.len() > 24 => draft.stop(),
            None => draft.note(format!("it has {}", fields.join(", "))).stop(),
        }
    }

    /// `of[index]`.
    pub(crate) fn index(&mut self, code: Code<'_>, id: ExprId, of: ExprId, index: ExprId) -> Result<Value, Halt> {
        let value = self.eval(code, of)?;
        if matches!(value, Value::Curve(_) | Value::Link(..)) {
            return self.slice_curve(code, id, value, index);
        }
        let value = if let Value::Table(t) = value { Value::List(t.rows.clone()) } else { value };
        if let Value::Record(record) = &value
            && !record.row
            && !matches!(code.expr(index), Expr::Slice { .. })
        {
            return match self.eval(code, index)? {
                Value::Text(key) => self.member(code, record, &key, index),
                other => {
                    let found = self.show_inside(&other);
                    Err(self
                        .error(code, "E211", format!("a record is indexed by a name in quotes, got {found}"), code.span(index), found)
                        .stop())
                }
            };
        }
        let Some(n) = value.len() else {
            let found = self.kind(&value);
            let axis = match (&value, code.expr(index)) {
                (Value::Vector(..) | Value::Node(_) | Value::Vertex(..), Expr::Number(k)) => ["x", "y", "z"].get(*k as usize),
                _ => None,
            };
            let typed: Vec<String> = axis.map(|axis| format!("{}.{axis}", self.source(code, of))).into_iter().collect();
            let draft = self.error(code, "E211", format!("{found} has no members to index"), code.span(of), found);
            return Err(if typed.is_empty() { draft.stop() } else { draft.ways(code.span(id), &typed).stop() });
        };
        match code.expr(index) {
            Expr::Slice { from, to } => {
                let a = from.map_or(Ok(0), |e| self.bound_of(code, e, n))?;
                let b = to.map_or(Ok(n), |e| self.bound_of(code, e, n))?;
                self.made(code, id, LIST_COST + b.saturating_sub(a))?;
                Ok(Value::list((a..b.max(a)).filter_map(|i| value.item(i)).collect()))
            }
            _ => match self.eval(code, index)? {
                Value::Number(q) if q.dim.is_none() && q.value == q.value.trunc() => {
                    let k = if q.value < 0.0 { q.value + n as f64 } else { q.value };
                    match (k >= 0.0 && k < n as f64).then(|| value.item(k as usize)).flatten() {
                        Some(item) => Ok(item),
                        None => Err(self.outside(code, index, q.value, n)),
                    }
                }
                Value::Range(a, b) => {
                    let clip = |k: i64| usize::try_from(k.clamp(0, n as i64)).unwrap_or(0);
                    self.made(code, id, LIST_COST + clip(b).saturating_sub(clip(a)))?;
                    Ok(Value::list((clip(a)..clip(b).max(clip(a))).filter_map(|i| value.item(i)).collect()))
                }
                Value::Text(key) => match &value {
                    Value::Record(record) => self.member(code, record, &key, index),
                    _ => Err(self.error(code, "E214", format!("there is no \"{key}\""), code.span(index), "no such name").stop()),
                },
                other => {
                    let found = self.show_inside(&other);
                    Err(self.error(code, "E211", format!("an index is a whole number, got {found}"), code.span(index), found).stop())
                }
            },
        }
    }

    /// `part["deck"]`.
    pub(crate) fn member(&mut self, code: Code<'_>, record: &Record, key: &str, index: ExprId) -> Result<Value, Halt> {
        if let Some(value) = self.program.names.find(key).and_then(|name| record.get(name)) {
            return Ok(value.clone());
        }
        let near =
            crate::lang::words::names::nearest(key, record.keys.iter().map(|name| self.program.names.text(*name))).map(str::to_owned);
        let draft = self.error(code, "E214", format!("there is no \"{key}\""), code.span(index), "no such name");
        Err(match near {
            Some(near) => draft.help(format!("[\"{near}\"]")).stop(),
            None => draft.stop(),
        })
    }

    fn bound_of(&mut self, code: Code<'_>, id: ExprId, n: usize) -> Result<usize, Halt> {
        match self.eval(code, id)? {
            Value::Number(q) if q.dim.is_none() && q.value == q.value.trunc() => {
                let k = if q.value < 0.0 { q.value + n as f64 } else { q.value };
                if (0.0..=n as f64).contains(&k) { Ok(k as usize) } else { Err(self.outside(code, id, q.value, n)) }
            }
            other => {
                let found = self.show_inside(&other);
                Err(self.error(code, "E211", format!("a place in a list is a whole number, got {found}"), code.span(id), found).stop())
            }
        }
    }

    #[cold]
    fn outside(&mut self, code: Code<'_>, id: ExprId, k: f64, n: usize) -> Halt {
        let k = crate::lang::values::units::number_text(k);
        let text = match n {
            0 => format!("index {k} of an empty list"),
            1 => format!("index {k} of a list with one member"),
            _ => format!("index {k} of a list with {n} members"),
        };
        let draft = self.error(code, "E215", text, code.span(id), "outside");
        match n {
            0 => draft.stop(),
            _ => draft.help(format!("0 to {}, or -1 to -{n} from the end", n - 1)).stop(),
        }
    }
}
