//! Fitting a value to a type: bare numbers become lengths, tuples points, nested lists flat ones.

use std::sync::Arc;

use glam::DVec3;

use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::std::kinds::EdgeOf;
use crate::lang::eval::std::topology::curve_of;
use crate::lang::syntax::ast::{Expr, ExprId};
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, ModuleId, Quantity, Value};
use crate::network::Chain;

/// Why a value does not fit a type.
#[derive(Clone, Debug)]
pub(crate) enum Misfit {
    /// Another kind.
    Kind,
    /// A bare number where the unit must be written.
    Bare,
    /// A number that is not whole, or negative.
    NotWhole,
    /// A word, but none of those allowed.
    Choice,
    /// A member of a list: which, what it is, and why.
    Member(usize, Box<Value>, Box<Misfit>),
    /// Something it depends on.
    Halt(Halt),
}

impl From<Halt> for Misfit {
    fn from(stop: Halt) -> Self {
        Self::Halt(stop)
    }
}

impl Cx<'_> {
    /// The value as this type; bare lengths are in the units of `module`.
    pub(crate) fn coerce(&mut self, value: Value, ty: Ty, module: ModuleId) -> Result<Value, (Value, Misfit)> {
        match self.fit(&value, ty, module) {
            Ok(None) => Ok(value),
            Ok(Some(other)) => Ok(other),
            Err(misfit) => Err((value, misfit)),
        }
    }

    /// `Ok(None)`: fits as it is; `Ok(Some(v))`: fits as `v`.
    fn fit(&mut self, value: &Value, ty: Ty, module: ModuleId) -> Result<Option<Value>, Misfit> {
        let ok = |fits: bool| if fits { Ok(None) } else { Err(Misfit::Kind) };
        match (ty, value) {
            (Ty::Any, _) => Ok(None),
            (Ty::Optional(_) | Ty::None, Value::None) => Ok(None),
            (Ty::Optional(of), v) => self.fit(v, *of, module),
            (Ty::OneOf(of), v) => self.fit_one(v, of, module),
            (Ty::Number, Value::Number(q)) => ok(q.dim.is_none()),
            (Ty::Count | Ty::Whole, Value::Number(q)) if q.dim.is_none() => {
                let whole = q.value == q.value.trunc() && q.value.abs() <= 9e15 && (ty == Ty::Whole || q.value >= 0.0);
                if whole { Ok(None) } else { Err(Misfit::NotWhole) }
            }
            (Ty::Quantity(dim), Value::Number(q)) => match q.dim {
                d if d == dim => Ok(None),
                Dim::NONE if dim.is_length_power() && !q.percent => {
                    let factor = units::convert(1.0, self.machine.at(module).unit, self.program.unit, dim.length);
                    Ok(Some(Value::quantity(q.value * factor, dim)))
                }
                Dim::NONE => Err(Misfit::Bare),
                _ => Err(Misfit::Kind),
            },
            (Ty::Size, Value::Number(q)) if q.percent => Ok(None),
            (Ty::Size, v) => self.fit(v, Ty::Quantity(Dim::LENGTH), module),
            (Ty::Measure, Value::Number(_)) => Ok(None),
            (Ty::Station, Value::Number(q)) => ok(q.dim.is_none() || q.dim == Dim::LENGTH),
            (Ty::Choice(words), Value::Word(w)) => {
                if words.contains(&&**w) {
                    Ok(None)
                } else {
                    Err(Misfit::Choice)
                }
            }
            (Ty::Point, Value::Vector(_, Dim::LENGTH) | Value::Node(_)) => Ok(None),
            (Ty::Point, Value::Vector(v, Dim::NONE)) => Ok(Some(Value::point(*v * self.bare_unit(module)))),
            (Ty::Point, Value::Vertex(..)) => Ok(Some(Value::point(self.as_vector(value.clone())?.0))),
            (Ty::Node, Value::Node(_)) => Ok(None),
            (Ty::Node, Value::Vector(..) | Value::Vertex(..)) => match self.fit(value, Ty::Point, module)? {
                Some(Value::Vector(p, _)) => Ok(Some(Value::Node(p))),
                _ => Ok(Some(Value::Node(self.as_vector(value.clone())?.0))),
            },
            (Ty::Vector | Ty::Direction | Ty::Axis, Value::Vector(..)) => Ok(None),
            (Ty::Vector | Ty::Direction | Ty::Axis, Value::Node(p)) => Ok(Some(Value::point(*p))),
            (Ty::Vector | Ty::Direction, Value::Vertex(..)) => Ok(Some(Value::point(self.as_vector(value.clone())?.0))),
            (Ty::Curve | Ty::Axis, Value::Curve(_)) => Ok(None),
            (Ty::Curve | Ty::Axis, Value::Link(..) | Value::Edge(..)) => Ok(Some(Value::Curve(self.as_chain(value.clone())?))),
            (Ty::List(of) | Ty::Rest(of), Value::Table(t)) => self.fit(&Value::List(t.rows.clone()), Ty::List(of), module),
            (Ty::List(of) | Ty::Rest(of), v) => self.fit_things(v, *of, module),
            (wanted, v) => ok(plain(wanted, v)),
        }
    }

    fn fit_one(&mut self, value: &Value, types: &[Ty], module: ModuleId) -> Result<Option<Value>, Misfit> {
        // An edge is a curve only where edges as such are not taken.
        if matches!(value, Value::Edge(..)) && types.contains(&Ty::Edge) {
            return Ok(None);
        }
        let mut first = None;
        for ty in types {
            match self.fit(value, *ty, module) {
                Ok(fitted) => return Ok(fitted),
                Err(Misfit::Halt(stop)) => return Err(Misfit::Halt(stop)),
                Err(misfit) => {
                    if first.is_none() || matches!(misfit, Misfit::Member(..) | Misfit::Choice | Misfit::NotWhole) {
                        first = Some(misfit);
                    }
                }
            }
        }
        Err(first.unwrap_or(Misfit::Kind))
    }

    /// A list; where a list of things is wanted one thing is a list of one.
    fn fit_things(&mut self, value: &Value, of: Ty, module: ModuleId) -> Result<Option<Value>, Misfit> {
        let one = |v: Value| Some(Value::list(vec![v]));
        // A part stands for its faces where things are wanted that it is none of.
        if let (Some(part), true) = (value.part(), of.is_thing() && of != Ty::Any && !accepts(of, value)) {
            let faces = part.list();
            return Ok(Some(self.fit_list(&faces, of, module)?.unwrap_or(faces)));
        }
        match (of.is_thing(), value.len().is_some()) {
            // A row of a table is a record and a list.
            (true, true) if !matches!(value, Value::Record(_)) => self.fit_list(value, of, module),
            (true, many) => match self.fit(value, of, module) {
                Ok(fitted) => Ok(one(fitted.unwrap_or_else(|| value.clone()))),
                Err(Misfit::Halt(stop)) => Err(Misfit::Halt(stop)),
                Err(_) if many => self.fit_list(value, of, module),
                Err(misfit) => Err(misfit),
            },
            (false, true) => self.fit_list(value, of, module),
            (false, false) => Err(Misfit::Kind),
        }
    }

    /// The members of a list as this type; where they are things lists inside it flatten.
    fn fit_list(&mut self, list: &Value, of: Ty, module: ModuleId) -> Result<Option<Value>, Misfit> {
        if of == Ty::Any && matches!(list, Value::List(_)) {
            return Ok(None);
        }
        let n = list.len().unwrap_or(0);
        // A list is copied only from the first member that changes.
        let mut changed = (!matches!(list, Value::List(_))).then(|| Vec::with_capacity(n));
        for i in 0..n {
            let held;
            let item = match list {
                Value::List(items) => &items[i],
                other => {
                    held = other.item(i).unwrap_or_default();
                    &held
                }
            };
            // A row of a net is written as a list.
            let fits = if of.is_list() && item.len().is_none() { Err(Misfit::Kind) } else { self.fit(item, of, module) };
            let (fitted, nested) = match fits {
                Ok(fitted) => (fitted, false),
                Err(Misfit::Halt(stop)) => return Err(Misfit::Halt(stop)),
                Err(_) if of.is_thing() && item.part().is_some() => {
                    let faces = item.part().map_or(Value::None, |part| part.list());
                    let inner = self.fit_list(&faces, of, module).map_err(|m| member(i, item, m))?;
                    (Some(inner.unwrap_or(faces)), true)
                }
                Err(_) if of.is_thing() && item.len().is_some() && !is_coordinates(item, of) => {
                    let inner = self.fit_list(item, of, module).map_err(|m| member(i, item, m))?;
                    (Some(inner.unwrap_or_else(|| item.clone())), true)
                }
                Err(misfit) => return Err(member(i, item, misfit)),
            };
            if changed.is_none() && fitted.is_some() {
                changed = Some((0..i).filter_map(|k| list.item(k)).collect());
            }
            match (&mut changed, fitted) {
                (None, _) => {}
                (Some(out), Some(inner)) if nested => out.extend((0..inner.len().unwrap_or(0)).filter_map(|k| inner.item(k))),
                (Some(out), fitted) => out.push(fitted.unwrap_or_else(|| item.clone())),
            }
        }
        Ok(changed.map(Value::list))
    }

    /// A point, node, vertex or tuple as a vector with its dimension.
    pub(crate) fn as_vector(&mut self, value: Value) -> Result<(DVec3, Dim), Halt> {
        match value {
            Value::Vector(v, dim) => Ok((v, dim)),
            Value::Node(p) => Ok((p, Dim::LENGTH)),
            Value::Vertex(home, id) => {
                let model = self.model(&home)?;
                Ok((model.vertices.get(id.index()).map_or(DVec3::ZERO, |v| v.point), Dim::LENGTH))
            }
            _ => Err(Halt::Bug("not a vector")),
        }
    }

    /// A curve or link as a chain.
    pub(crate) fn as_chain(&mut self, value: Value) -> Result<Chain, Halt> {
        match value {
            Value::Curve(chain) => Ok(chain),
            Value::Link(module, id) => Ok(self.network(module)?.link_chain(id)),
            Value::Edge(home, edge) => curve_of(self, EdgeOf(home, edge)),
            _ => Err(Halt::Bug("not a curve")),
        }
    }

    /// Fits the value of an expression, reporting what does not; `subject` is what wants it: "`h`".
    pub(crate) fn fit_expr(&mut self, code: Code<'_>, id: ExprId, value: Value, ty: Ty, subject: &str) -> Result<Value, Halt> {
        if crate::lang::eval::operators::is_zero(code, id)
            && let Some(dim) = zero_dim(ty)
        {
            return Ok(Value::quantity(0.0, dim));
        }
        match self.coerce(value, ty, code.module) {
            Ok(value) => Ok(value),
            Err((_, Misfit::Halt(Halt::Fault(fault)))) => Err(Halt::Fault(fault)),
            Err((_, Misfit::Halt(stop))) => Err(stop),
            Err((value, misfit)) => Err(self.misfit(code, id, &value, ty, subject, &misfit)),
        }
    }

    /// Evaluates an expression where this type is wanted: a name that is one of its words is the word.
    pub(crate) fn eval_as(&mut self, code: Code<'_>, id: ExprId, ty: Ty, subject: &str) -> Result<Value, Halt> {
        let value = match ty.choices() {
            Some(words) => self.eval_choice(code, id, words, subject)?,
            None => self.eval(code, id)?,
        };
        self.fit_expr(code, id, value, ty, subject)
    }

    fn eval_choice(&mut self, code: Code<'_>, id: ExprId, words: &[&str], subject: &str) -> Result<Value, Halt> {
        match code.expr(id) {
            Expr::Name(name) => {
                let text = self.program.names.text(*name);
                if words.contains(&text) {
                    return Ok(Value::Word(text.into()));
                }
                if self.is_bound(code.module, *name) || self.machine.at(code.module).is_broken(*name) {
                    return self.eval(code, id);
                }
                let text = text.to_owned();
                Err(self.no_choice(code, id, &text, words, subject))
            }
            Expr::If { condition, then, otherwise } => {
                let chosen = if self.condition(code, *condition)? { *then } else { *otherwise };
                self.eval_choice(code, chosen, words, subject)
            }
            Expr::Let { name, value, body, .. } => {
                let value = self.eval(code, *value)?;
                self.with_local(*name, value, |cx| cx.eval_choice(code, *body, words, subject))
            }
            Expr::List(items) => {
                let items = items.iter().map(|item| self.eval_choice(code, *item, words, subject));
                items.collect::<Result<Vec<_>, _>>().map(Value::list)
            }
            _ => self.eval(code, id),
        }
    }
}

/// Why a list does not fit: its i-th member.
fn member(i: usize, item: &Value, misfit: Misfit) -> Misfit {
    match misfit {
        Misfit::Halt(stop) => Misfit::Halt(stop),
        other => Misfit::Member(i, Box::new(item.clone()), Box::new(other)),
    }
}

/// Whether a list of numbers stands where points are wanted: `[0, 0, 0]` is no list of points.
pub(crate) fn is_coordinates(item: &Value, of: Ty) -> bool {
    let numbers = || (0..item.len().unwrap_or(0)).all(|k| matches!(item.item(k), Some(Value::Number(_))));
    matches!(of, Ty::Point | Ty::Node | Ty::Vector | Ty::Direction) && matches!(item.len(), Some(2 | 3)) && numbers()
}

/// `Z` and `z` as the direction that they name.
pub(crate) fn axis_of_word(word: &str) -> Option<&'static str> {
    Some(match word {
        "x" | "X" => "(1, 0, 0)",
        "y" | "Y" => "(0, 1, 0)",
        "z" | "Z" => "(0, 0, 1)",
        _ => return None,
    })
}

/// Dimension that a literal 0 takes where this type is wanted.
pub(crate) fn zero_dim(ty: Ty) -> Option<Dim> {
    match ty {
        Ty::Quantity(dim) => Some(dim),
        Ty::Size => Some(Dim::LENGTH),
        Ty::Optional(of) => zero_dim(*of),
        _ => None,
    }
}

/// Types that a value has or has not, without conversion.
fn plain(ty: Ty, value: &Value) -> bool {
    if ty == Ty::Part {
        return value.part().is_some();
    }
    matches!(
        (ty, value),
        (Ty::Bool, Value::Bool(_))
            | (Ty::Text, Value::Text(_))
            | (Ty::Word, Value::Word(_))
            | (Ty::Link, Value::Link(..))
            | (Ty::Edge, Value::Edge(..))
            | (Ty::Vertex, Value::Vertex(..))
            | (Ty::Patch, Value::Patch(..))
            | (Ty::Surface, Value::Surface(_))
            | (Ty::Shell, Value::Shell(_))
            | (Ty::Mesh, Value::Mesh(_))
            | (Ty::Plane, Value::Plane(_))
            | (Ty::Record, Value::Record(_))
            | (Ty::Range, Value::Range(..))
            | (Ty::Table, Value::Table(_))
            | (Ty::Module, Value::Module(_))
            | (Ty::Network, Value::Network(_))
            | (Ty::Drawing, Value::Drawing(_))
    )
}

/// Whether a field of this type's values is meant: the kind decides, without conversion but those of points.
pub(crate) fn accepts(ty: Ty, value: &Value) -> bool {
    match (ty, value) {
        (Ty::Any, _) => true,
        (Ty::Point | Ty::Vector | Ty::Direction, Value::Vector(..) | Value::Node(_) | Value::Vertex(..)) => true,
        (Ty::Node, Value::Node(_)) => true,
        (Ty::Curve, Value::Curve(_) | Value::Link(..)) => true,
        (Ty::Measure, Value::Number(_)) => true,
        (Ty::Number, Value::Number(Quantity { dim, .. })) => dim.is_none(),
        (Ty::List(_) | Ty::Rest(_), v) => v.len().is_some(),
        (Ty::OneOf(of), v) => of.iter().any(|t| accepts(*t, v)),
        (ty, v) => plain(ty, v),
    }
}

/// Nested lists flattened into one.
pub(crate) fn flatten_into(value: Value, out: &mut Vec<Value>) {
    match value {
        Value::List(items) => match Arc::try_unwrap(items) {
            Ok(items) => items.into_iter().for_each(|v| flatten_into(v, out)),
            Err(shared) => shared.iter().for_each(|v| flatten_into(v.clone(), out)),
        },
        range @ Value::Range(..) => out.extend((0..range.len().unwrap_or(0)).filter_map(|i| range.item(i))),
        other => out.push(other),
    }
}
