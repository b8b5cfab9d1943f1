//! How far curves and surfaces may reach: what is computed from their coordinates must not overflow.

use glam::DVec3;

use crate::base::fault::{LengthRange, ValueFault};
use crate::base::limits::COORDINATE;
use crate::base::work;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::std::Builtin;
use crate::lang::syntax::ast::ExprId;
use crate::lang::values::types::Ty;
use crate::lang::values::units::told_length;
use crate::lang::values::value::{Dim, Value};

/// The fault of an argument that is too large for a curve or surface to be made from it.
pub(crate) fn given_beyond(builtin: &Builtin, values: &[Value]) -> Option<ValueFault> {
    if !matches!(builtin.returns, Ty::Curve | Ty::Surface) {
        return None;
    }
    let beyond = |(k, value): (usize, &Value)| given(value).map(|found| (builtin.params[k].name, found));
    let (argument, found) = values.iter().enumerate().find_map(beyond)?;
    Some(ValueFault::LengthOutside { argument, found, range: LengthRange::Within(COORDINATE) })
}

/// A length or coordinate in a value that is too large; what is not finite has an error of its own.
fn given(value: &Value) -> Option<f64> {
    match value {
        Value::Number(q) if q.dim == Dim::LENGTH => large(q.value),
        Value::Vector(v, Dim::LENGTH) => large_point(*v),
        Value::List(items) => items.iter().find_map(given),
        _ => None,
    }
}

fn large(x: f64) -> Option<f64> {
    (x.is_finite() && x.abs() > COORDINATE).then_some(x)
}

fn large_point(p: DVec3) -> Option<f64> {
    p.to_array().into_iter().find_map(large)
}

/// How far a curve or surface reaches, or those of a list, where that is too far: looked at in a few places.
fn made(value: &Value) -> Option<f64> {
    let beyond = |p: DVec3| large_point(p).or_else(|| (!p.is_finite()).then_some(f64::INFINITY));
    match value {
        Value::Curve(chain) => chain.runs().iter().find_map(|run| {
            let (first, last) = run.curve.domain();
            [first, 0.5 * (first + last), last].into_iter().find_map(|t| beyond(run.curve.point(t)))
        }),
        Value::Surface(surface) => {
            [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5)].into_iter().find_map(|(u, v)| beyond(surface.point(u, v)))
        }
        Value::List(items) => items.iter().find_map(made),
        _ => None,
    }
}

impl Cx<'_> {
    /// E306 where a curve or surface that a call has made, as by `scale`, reaches too far.
    pub(crate) fn made_in_reach(&mut self, code: Code<'_>, id: ExprId, builtin: &Builtin, value: &Value) -> Result<(), Halt> {
        let Some(found) = work::uncharged(|| made(value)) else { return Ok(()) };
        let say = |length: f64| {
            let (text, unit) = told_length(length, self.unit());
            format!("{text} {}", unit.name)
        };
        let reaches = if found.is_finite() { format!("as far as {}", say(found)) } else { "farther than a number can say".to_owned() };
        let (text, label) = (format!("what `{}` makes reaches {reaches}", builtin.name), format!("the limit is {}", say(COORDINATE)));
        Err(self.error(code, "E306", text, code.span(id), label).stop())
    }
}
