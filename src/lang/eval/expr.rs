//! Expressions: one walk over the tree of a declaration.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::base::limits;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::eval::module::State;
use crate::lang::eval::room::LIST_COST;
use crate::lang::syntax::ast::{Clause, Expr, ExprId, For, Keyword, TextPart, Unary};
use crate::lang::values::types::dim_words;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, ModuleId, Quantity, Record, Value};
use crate::lang::words::names::Name;

impl Cx<'_> {
    /// The value of an expression.
    pub(crate) fn eval(&mut self, code: Code<'_>, id: ExprId) -> Result<Value, Halt> {
        self.step()?;
        match code.expr(id) {
            Expr::Number(value) if value.is_finite() => Ok(Value::number(*value)),
            Expr::Quantity(value, unit) => self.literal(code, id, *value, unit),
            Expr::Bool(b) => Ok(Value::Bool(*b)),
            Expr::None => Ok(Value::None),
            Expr::Name(name) => self.name(code, id, *name),
            Expr::Number(_) => Err(self.error(code, "E408", "this number is too large", code.span(id), "not a finite number").stop()),
            _ => {
                self.deeper(code, id)?;
                let value = self.compound(code, id);
                self.machine.depth -= 1;
                value
            }
        }
    }

    fn compound(&mut self, code: Code<'_>, id: ExprId) -> Result<Value, Halt> {
        match code.expr(id) {
            Expr::Binary { op, op_span, a, b } => self.binary(code, id, *op, *op_span, *a, *b),
            Expr::Unary(op, of) => self.unary(code, *op, *of),
            Expr::Tuple(items) => self.tuple(code, id, items),
            Expr::Call { name, name_span, of, args } => self.call(code, id, *name, *name_span, *of, args),
            Expr::Field { of, name, name_span } => self.field(code, id, *of, *name, *name_span),
            Expr::Index { of, index } => self.index(code, id, *of, *index),
            Expr::List(items) => {
                let items = self.items(code, items)?;
                self.made(code, id, LIST_COST + items.len())?;
                self.shallow(code, id, items)
            }
            Expr::Comprehension { clauses, body } => {
                let mut out = Vec::new();
                self.made(code, id, LIST_COST)?;
                self.comprehension(code, id, clauses, *body, &mut out)?;
                self.shallow(code, id, out)
            }
            Expr::Record(fields) => {
                self.made(code, id, LIST_COST + fields.len())?;
                let record = self.record_literal(code, fields)?;
                self.shallow(code, id, vec![record.clone()])?;
                Ok(record)
            }
            Expr::Within { of, tolerance } => self.within(code, *of, *tolerance).map(|c| Value::Bool(c.holds)),
            Expr::If { condition, then, otherwise } => {
                let chosen = if self.condition(code, *condition)? { *then } else { *otherwise };
                self.eval(code, chosen)
            }
            Expr::Let { name, value, body, .. } => {
                let value = self.eval(code, *value)?;
                self.with_local(*name, value, |cx| cx.eval(code, *body))
            }
            Expr::Text(parts) => {
                let text = self.interpolate(code, parts)?;
                self.made_text(code, id, &text)?;
                Ok(Value::Text(text.into()))
            }
            Expr::Slice { .. } => {
                Err(self.error(code, "E102", "a run is written inside `[ ]`", code.span(id), "runs from where to where").stop())
            }
            _ => Err(Halt::Bug("a simple expression in the wrong place")),
        }
    }

    /// Runs `work` with one more local name.
    pub(crate) fn with_local<T>(&mut self, name: Name, value: Value, work: impl FnOnce(&mut Self) -> T) -> T {
        self.machine.locals.push((name, value));
        let result = work(self);
        self.machine.locals.pop();
        result
    }

    fn literal(&mut self, code: Code<'_>, id: ExprId, value: f64, unit: &str) -> Result<Value, Halt> {
        match units::quantity(value, unit, self.program.unit) {
            Some(q) if q.value.is_finite() => Ok(Value::Number(q)),
            Some(_) => Err(self.error(code, "E408", "this number is too large", code.span(id), "not a finite number").stop()),
            // The parser lets known units through alone.
            None => Err(self.error(code, "E107", format!("`{unit}` is not a unit"), code.span(id), "no such unit").stop()),
        }
    }

    fn name(&mut self, code: Code<'_>, id: ExprId, name: Name) -> Result<Value, Halt> {
        let locals = &self.machine.locals[self.machine.base..];
        if let Some((_, value)) = locals.iter().rev().find(|l| l.0 == name) {
            return Ok(value.clone());
        }
        let module = self.machine.at(code.module);
        match module.find(name) {
            Some(declaration) => match &module.states[declaration as usize] {
                State::Done(value) if !matches!(value, Value::None) => Ok(value.clone()),
                _ => self.declared(code, id, declaration),
            },
            None => self.unbound(code, id, name),
        }
    }

    #[cold]
    fn declared(&mut self, code: Code<'_>, id: ExprId, declaration: u32) -> Result<Value, Halt> {
        if self.machine.at(code.module).script.declarations.keyword(declaration as usize) == Keyword::Fn {
            let name = self.declaration_name(code.module, declaration);
            let draft = self.error(code, "E211", format!("`{name}` is a function"), code.span(id), "functions are not values");
            return Err(draft.help(format!("call it: `{name}(…)`")).stop());
        }
        self.machine.site.expr = id;
        self.ensure(code.module, declaration)
    }

    /// Whether a name means something here other than a bare word.
    pub(crate) fn is_bound(&self, module: ModuleId, name: Name) -> bool {
        self.machine.locals[self.machine.base..].iter().any(|l| l.0 == name) || self.machine.at(module).find(name).is_some()
    }

    pub(crate) fn items(&mut self, code: Code<'_>, items: &[ExprId]) -> Result<Vec<Value>, Halt> {
        let mut gather = Gather::default();
        let values = items.iter().filter_map(|item| gather.take(self.eval(code, *item))).collect();
        gather.done().map(|()| values)
    }

    fn record_literal(&mut self, code: Code<'_>, fields: &[(Name, ExprId)]) -> Result<Value, Halt> {
        let mut gather = Gather::default();
        let mut keys: Vec<Name> = Vec::with_capacity(fields.len());
        let mut values = Vec::with_capacity(fields.len());
        for (key, value) in fields {
            if keys.contains(key) {
                let text = format!("`{}` is given twice", self.program.names.text(*key));
                return Err(self.error(code, "E304", text, code.span(*value), "the second one").stop());
            }
            keys.push(*key);
            values.extend(gather.take(self.eval(code, *value)));
        }
        gather.done()?;
        Ok(Value::Record(Arc::new(Record { keys: Arc::new(keys), values, row: false, part: None })))
    }

    /// `(a, b)` and `(a, b, c)`: one length among them makes them lengths.
    fn tuple(&mut self, code: Code<'_>, id: ExprId, items: &[ExprId]) -> Result<Value, Halt> {
        if !(2..=3).contains(&items.len()) {
            let text = format!("a point has two or three coordinates, this has {}", items.len());
            return Err(self.error(code, "E211", text, code.span(id), "a list is written with [ ]").stop());
        }
        let (mut numbers, mut gather) = ([Quantity::bare(0.0); 3], Gather::default());
        for (slot, item) in numbers.iter_mut().zip(items) {
            let value = self.eval(code, *item);
            let number = value.and_then(|v| match v {
                Value::Number(q) => Ok(q),
                other => {
                    let found = self.kind(&other);
                    Err(self
                        .error(code, "E211", format!("a coordinate is a number or a length, got {found}"), code.span(*item), found)
                        .stop())
                }
            });
            if let Some(q) = gather.take(number) {
                *slot = q;
            }
        }
        gather.done()?;
        let dim = numbers.iter().map(|q| q.dim).find(|d| !d.is_none()).unwrap_or(Dim::NONE);
        let bare = self.bare_unit(code.module);
        let mut coordinates = [0.0; 3];
        for (k, q) in numbers.iter().enumerate() {
            coordinates[k] = if q.dim == dim || q.value == 0.0 {
                q.value
            } else if q.dim.is_none() && dim == Dim::LENGTH {
                q.value * bare
            } else {
                let item = items.get(k).copied().unwrap_or(id);
                let text = format!("the coordinates of a point have one dimension, got {} beside {}", dim_words(q.dim), dim_words(dim));
                return Err(self.error(code, "E211", text, code.span(item), dim_words(q.dim)).stop());
            };
        }
        Ok(Value::Vector(DVec3::from_array(coordinates), dim))
    }

    pub(crate) fn condition(&mut self, code: Code<'_>, id: ExprId) -> Result<bool, Halt> {
        match self.eval(code, id)? {
            Value::Bool(b) => Ok(b),
            other => {
                let found = self.kind(&other);
                Err(self.error(code, "E211", format!("a condition is true or false, got {found}"), code.span(id), found).stop())
            }
        }
    }

    fn unary(&mut self, code: Code<'_>, op: Unary, of: ExprId) -> Result<Value, Halt> {
        if op == Unary::Not {
            return self.condition(code, of).map(|b| Value::Bool(!b));
        }
        match self.eval(code, of)? {
            Value::Number(q) => Ok(Value::Number(Quantity { value: -q.value, ..q })),
            Value::Vector(v, dim) => Ok(Value::Vector(-v, dim)),
            Value::Node(p) => Ok(Value::point(-p)),
            Value::Surface(s) => Ok(Value::Surface(s.flipped())),
            curve @ (Value::Curve(_) | Value::Link(..)) => self.as_chain(curve).map(|c| Value::Curve(c.reversed())),
            other => {
                let found = self.kind(&other);
                Err(self.error(code, "E211", format!("{found} cannot be negated"), code.span(of), found).stop())
            }
        }
    }

    /// Runs nested `for`s and `if`s, collecting the body's values.
    fn comprehension(&mut self, code: Code<'_>, id: ExprId, clauses: &[Clause], body: ExprId, out: &mut Vec<Value>) -> Result<(), Halt> {
        match clauses.split_first() {
            None => {
                if out.len() >= limits::LIST_MEMBERS {
                    return Err(self.too_long(code, id, "this list"));
                }
                self.made(code, id, 1)?;
                let before = self.machine.room;
                let value = self.eval(code, body)?;
                self.machine.room.give_back(before, Some(&value));
                out.push(value);
                Ok(())
            }
            Some((Clause::If(condition), rest)) => {
                if self.condition(code, *condition)? {
                    self.comprehension(code, id, rest, body, out)?;
                }
                Ok(())
            }
            Some((Clause::For(f), rest)) => {
                let list = self.list_of(code, f)?;
                if let (true, Some(n)) = (rest.is_empty(), list.len()) {
                    self.has_room(code, id, n.saturating_mul(members_of_each(code, body)))?;
                    out.reserve(n.min(limits::LIST_MEMBERS));
                }
                self.each(f.name, &list, |cx, _| cx.comprehension(code, id, rest, body, out))
            }
        }
    }

    /// The list that a `for` runs over, not longer than the limit.
    pub(crate) fn list_of(&mut self, code: Code<'_>, f: &For) -> Result<Value, Halt> {
        let list = self.eval(code, f.list)?;
        let list = if let Value::Table(t) = list { Value::List(t.rows.clone()) } else { list };
        match list.len() {
            Some(n) if n <= limits::LIST_MEMBERS => Ok(list),
            Some(_) => Err(self.too_long(code, f.list, "this range")),
            None => {
                let found = self.kind(&list);
                let draft = self.error(code, "E211", format!("`for` runs over a list or a range, got {found}"), code.span(f.list), found);
                Err(draft.help("`for i in 0..5`, or `for x in [a, b]`").stop())
            }
        }
    }

    /// A list, unless lists inside it stand deeper than the limit: what walks them must not overflow the stack.
    fn shallow(&mut self, code: Code<'_>, id: ExprId, items: Vec<Value>) -> Result<Value, Halt> {
        let list = Value::list(items);
        let mut level = inner(&list);
        for _ in 0..limits::LIST_NESTING {
            match level.and_then(|values| values.iter().rev().take(INNER_LOOKED_AT).find_map(inner)) {
                Some(values) => level = Some(values),
                None => return Ok(list),
            }
        }
        let draft = self.error(code, "E217", "lists are nested too deep", code.span(id), "one level more here");
        Err(draft.help(format!("the limit is {} nested lists", limits::LIST_NESTING)).stop())
    }

    /// Binds the name to each member in turn.
    pub(crate) fn each(
        &mut self,
        name: Name,
        list: &Value,
        mut work: impl FnMut(&mut Self, usize) -> Result<(), Halt>,
    ) -> Result<(), Halt> {
        let slot = self.machine.locals.len();
        self.machine.locals.push((name, Value::None));
        let mut result = Ok(());
        for i in 0..list.len().unwrap_or(0) {
            self.machine.locals[slot].1 = list.item(i).unwrap_or_default();
            result = work(self, i);
            if result.is_err() {
                break;
            }
        }
        self.machine.locals.truncate(slot);
        result
    }

    /// A text with its interpolations.
    pub(crate) fn interpolate(&mut self, code: Code<'_>, parts: &[TextPart]) -> Result<String, Halt> {
        let (mut text, mut gather) = (String::new(), Gather::default());
        for part in parts {
            match part {
                TextPart::Literal(literal) => text.push_str(literal),
                TextPart::Value(id) => {
                    if let Some(value) = gather.take(self.eval(code, *id)) {
                        text.push_str(&self.show(&value));
                    }
                }
            }
            if text.len() as u64 > limits::DATA_BYTES {
                return Err(ValueFault::Limit { what: "this text".into(), limit: "256 MiB".into() }.into());
            }
        }
        gather.done().map(|()| text)
    }

    /// Model units in one unit of the script: what a bare number is multiplied by where a length is wanted.
    pub(crate) fn bare_unit(&self, module: ModuleId) -> f64 {
        units::convert(1.0, self.machine.at(module).unit, self.program.unit, 1)
    }
}

/// Members of a list that are looked at for further lists.
const INNER_LOOKED_AT: usize = 16;

/// Members of a list, values of a record.
fn inner(value: &Value) -> Option<&[Value]> {
    match value {
        Value::List(items) => Some(items.as_slice()),
        Value::Record(record) => Some(record.values.as_slice()),
        _ => None,
    }
}

/// Members that each evaluation of an expression makes, as far as its text tells: those of `[for i in 0..1000: …]`, and 1
/// for what is not known.
fn members_of_each(code: Code<'_>, id: ExprId) -> usize {
    let expr = |id: ExprId| code.nodes.get(id.index()).map(|node| &node.expr);
    let mut members: usize = 1;
    let mut body = id;
    while let Some(Expr::Comprehension { clauses, body: inner }) = expr(body) {
        for clause in clauses.iter() {
            let Clause::For(f) = clause else { return members };
            let Some(Expr::Binary { op: crate::lang::syntax::ast::Binary::Run, a: from, b: to, .. }) = expr(f.list) else { return members };
            let (Some(Expr::Number(from)), Some(Expr::Number(to))) = (expr(*from), expr(*to)) else { return members };
            // A cast to whole numbers saturates.
            members = members.saturating_mul((to - from).max(0.0) as usize);
        }
        body = *inner;
    }
    members
}
