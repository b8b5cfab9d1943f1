//! Where things meet, and the runs of curves between such places: `a & b` and `c[A..B]`.

use super::cx::{Cx, Stop};
use super::eval::Code;
use super::syntax::ast::{Expr, ExprId};
use super::types::Ty;
use super::value::{Dim, Value};
use crate::base::fault::ValueFault;
use crate::network::Chain;
use crate::network::meet;

/// The one node where two curves meet; E507, E508, E509 name the candidates.
pub(super) fn meet_once(cx: &mut Cx, a: &Value, b: &Value) -> Result<Value, Stop> {
    let is_curve = |v: &Value| matches!(v, Value::Curve(_) | Value::Link(..));
    let has_geometry = |v: &Value| is_curve(v) || matches!(v, Value::Surface(_) | Value::Shell(_) | Value::Mesh(_) | Value::Plane(_));
    if !(has_geometry(a) && has_geometry(b)) {
        let found = if has_geometry(a) { cx.kind(b) } else { cx.kind(a) };
        let argument = if has_geometry(a) { "b" } else { "a" };
        return Err(ValueFault::WrongKind { argument, found, wanted: "a curve" }.into());
    }
    if !(is_curve(a) && is_curve(b)) {
        let what = format!("`&` of {} and {}", cx.kind(a), cx.kind(b));
        return Err(ValueFault::NotInThisVersion { what }.into());
    }
    let tolerance = cx.tolerance()?;
    let (a, b) = (cx.as_chain(a.clone())?, cx.as_chain(b.clone())?);
    Ok(Value::Node(meet::meet_once(&a, &b, &tolerance)?.point))
}

impl Cx<'_> {
    /// `c[A..B]`: the run from A to B.
    pub(super) fn slice_curve(&mut self, code: Code<'_>, id: ExprId, curve: Value, index: ExprId) -> Result<Value, Stop> {
        let (from, to) = match code.expr(index) {
            Expr::Slice { from, to } => (*from, *to),
            _ => {
                let (c, i) = (self.source(code, before(code, id)), self.source(code, index));
                let draft = self.error(code, "E211", "a curve has no members", code.span(index), "runs are written `[A .. B]`");
                return Err(draft.help(format!("`{c}.links[{i}]` is a link of it, `{c}.at({i})` a point")).stop());
            }
        };
        let tolerance = self.tolerance()?;
        let chain = self.as_chain(curve)?;
        let f0 = match from {
            Some(e) => self.fraction(code, e, &chain)?,
            None => 0.0,
        };
        let f1 = match to {
            Some(e) => self.fraction(code, e, &chain)?,
            None => 1.0,
        };
        self.machine.site.expr = id;
        let origin = self.origin();
        match chain.slice(f0, f1, &tolerance) {
            Ok(slice) => Ok(Value::Curve(slice.with_origin(origin))),
            Err(fault) => {
                let diagnostic = self.locate(&fault, code, code.span(id), &[]);
                self.sink.push(diagnostic);
                Err(Stop::Failed)
            }
        }
    }

    /// Where an end of a slice lies on the curve, as a fraction of its length.
    fn fraction(&mut self, code: Code<'_>, id: ExprId, chain: &Chain) -> Result<f64, Stop> {
        let tolerance = self.tolerance()?;
        let value = self.eval(code, id)?;
        self.machine.site.expr = id;
        let result = match value {
            Value::Curve(_) | Value::Link(..) => {
                let other = self.as_chain(value)?;
                meet::meet_once(chain, &other, &tolerance).map(|m| m.fa)
            }
            Value::Number(q) if q.dim.is_none() || q.dim == Dim::LENGTH => {
                let f = if q.dim.is_none() { q.value } else { q.value / chain.length() };
                if (0.0..=1.0).contains(&f) {
                    return Ok(f);
                }
                let found = self.quantity(q);
                let end = super::units::quantity_text(super::value::Quantity::new(chain.length(), Dim::LENGTH), self.unit);
                let text = format!("{found} is outside the curve");
                return Err(self.error(code, "E306", text, code.span(id), format!("between 0 and 100%, or 0 and {end}")).stop());
            }
            point @ (Value::Vector(..) | Value::Node(_) | Value::Vertex(..)) => {
                let Value::Vector(p, _) = self.point_value(code, id, point)? else { return Err(Stop::Bug("a point is a vector")) };
                chain.fraction_at(p, &tolerance)
            }
            other => {
                let found = self.kind(&other);
                let text = format!("a run ends at a node, a point, another curve, a fraction or a length, got {found}");
                return Err(self.error(code, "E211", text, code.span(id), found).stop());
            }
        };
        result.map_err(|fault| {
            let diagnostic = self.locate(&fault, code, code.span(id), &[]);
            self.sink.push(diagnostic);
            Stop::Failed
        })
    }

    fn point_value(&mut self, code: Code<'_>, id: ExprId, value: Value) -> Result<Value, Stop> {
        match self.fit_expr(code, id, value, Ty::Point, "this end")? {
            Value::Node(p) => Ok(Value::point(p)),
            other => Ok(other),
        }
    }
}

fn before(code: Code<'_>, id: ExprId) -> ExprId {
    match code.expr(id) {
        Expr::Index { of, .. } => *of,
        _ => id,
    }
}
