//! Params as a page moves them: numbers in the unit in which the script writes their default.

use super::frame::Param;
use super::places::place;
use crate::lang::eval::context::Cx;
use crate::lang::run::declared::DeclaredParam;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, Quantity, Value};

/// The params of the main script.
pub(super) fn params(cx: &Cx) -> Vec<Param> {
    cx.declared_params().iter().map(|param| row(cx, param)).collect()
}

fn row(cx: &Cx, param: &DeclaredParam) -> Param {
    let (file, span) = param.default;
    let written = cx.program.sources.text(file, span);
    let value = param.value.clone().unwrap_or_default();
    let number = if let Value::Number(q) = &value { Some(*q) } else { None };
    let dim = number.map_or(Dim::NONE, |q| q.dim);
    let (unit, factor) = unit_of(cx, written, dim);
    let whole = |x: f64| x.fract() == 0.0 && x.abs() < 1e9;
    let kind = match &value {
        _ if !param.choices.is_empty() => "choice",
        Value::Bool(_) => "bool",
        Value::Number(q) if q.dim == Dim::LENGTH => "length",
        Value::Number(q) if q.dim == Dim::ANGLE => "angle",
        Value::Number(q) if whole(q.value) && param.range.is_none_or(|(l, h)| whole(l.value) && whole(h.value)) && is_count(written) => {
            "count"
        }
        Value::Number(_) => "number",
        _ => "text",
    };
    let range = param.range.map(|(low, high)| (low.value / factor, high.value / factor));
    Param {
        name: param.name.clone(),
        text: if param.set { cx.show_inside(&value) } else { written.to_owned() },
        value: number.map(|q: Quantity| q.value / factor),
        unit,
        kind,
        min: range.map(|r| r.0),
        max: range.map(|r| r.1),
        choices: param.choices.clone(),
        set: param.set,
        place: place(&cx.program.sources, file, span, None).unwrap_or_default(),
    }
}

/// Whether a default is written as a whole number without a unit.
fn is_count(written: &str) -> bool {
    !written.is_empty() && written.chars().all(|c| c.is_ascii_digit())
}

/// The unit in which a default is written, and how many of the model's units (degrees for angles) it is; the model's where none is
/// written.
fn unit_of(cx: &Cx, written: &str, dim: Dim) -> (String, f64) {
    if dim.is_none() {
        return (String::new(), 1.0);
    }
    let suffix = written.trim_start_matches(|c: char| c.is_ascii_digit() || ".-+_ ".contains(c));
    match units::quantity(1.0, suffix, cx.unit()) {
        Some(q) if q.dim == dim && q.value > 0.0 => (suffix.to_owned(), q.value),
        _ => (units::unit_text(dim, cx.unit()), 1.0),
    }
}
