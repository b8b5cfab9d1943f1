//! Where things meet, and the runs of curves between such places: `a & b` and `c[A..B]`.

use crate::base::fault::{Fault, ValueFault};
use crate::base::origin::Origin;
use crate::lang::eval::bind::Blame;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::eval::std::kinds::{Cutter, Meeting};
use crate::lang::syntax::ast::{Expr, ExprId};
use crate::lang::values::conversions::FromValue;
use crate::lang::values::types::Ty;
use crate::lang::values::value::{Dim, Value};
use crate::network::Chain;
use crate::network::meet;
use crate::surface::Surface;
use crate::surface::core::plane;
use crate::surface::faults::CrossingFault;
use crate::surface::intersect::{with_curve, with_surfaces};

/// The one place where two things meet; E507, E508, E509 name the candidates.
pub(crate) fn meet_once(cx: &mut Cx, a: &Value, b: &Value) -> Result<Value, Halt> {
    let sides = [(a, "a"), (b, "b")];
    let mut kinds = Vec::with_capacity(sides.len());
    for (value, argument) in sides {
        let Some(kind) = Meeting::from_value(plain(cx, value)?) else {
            let found = cx.kind(value);
            return Err(ValueFault::WrongKind { argument, found, wanted: "a curve or a surface" }.into());
        };
        kinds.push(kind);
    }
    let tolerance = cx.tolerance()?;
    match (&kinds[0], &kinds[1]) {
        (Meeting::Mesh(mesh), Meeting::Plane(plane)) | (Meeting::Plane(plane), Meeting::Mesh(mesh)) => {
            match crate::lang::eval::std::mesh::sections(cx, mesh, plane)?.as_slice() {
                [one] => Ok(Value::Curve(one.clone())),
                other => {
                    let curves = other.iter().map(|c| (c.point(0.5), c.length())).collect();
                    Err(Fault::from(CrossingFault::NotOneSection { of: cx.origin(), curves }).into())
                }
            }
        }
        (Meeting::Curve(a), Meeting::Curve(b)) => Ok(Value::Node(meet::meet_once(a, b, &tolerance)?.point)),
        (Meeting::Curve(curve), other) | (other, Meeting::Curve(curve)) => match faces(other)? {
            Some(faces) => Ok(Value::point(with_curve::with_curve_once(curve, &faces, &tolerance)?.point)),
            None => Err(later(cx, a, b)),
        },
        (x, y) => match (faces(x)?, faces(y)?) {
            (Some(x), Some(y)) => Ok(Value::Curve(with_surfaces::with_surfaces_once(&x, &y, cx.origin(), &tolerance)?)),
            _ => Err(later(cx, a, b)),
        },
    }
}

/// All places where two things meet.
pub(crate) fn meet_all(cx: &mut Cx, a: &Meeting, b: &Meeting) -> Result<Vec<Value>, Halt> {
    let tolerance = cx.tolerance()?;
    match (a, b) {
        (Meeting::Mesh(mesh), Meeting::Plane(plane)) | (Meeting::Plane(plane), Meeting::Mesh(mesh)) => {
            Ok(crate::lang::eval::std::mesh::sections(cx, mesh, plane)?.into_iter().map(Value::Curve).collect())
        }
        (Meeting::Curve(a), Meeting::Curve(b)) => {
            let mut places = Vec::new();
            for meeting in meet::meet(a, b, &tolerance)? {
                places.push(Value::Node(meeting.point));
                places.extend(meeting.overlap_end.map(|(fa, _)| Value::Node(a.point(fa))));
            }
            Ok(places)
        }
        (Meeting::Curve(curve), other) | (other, Meeting::Curve(curve)) => {
            let Some(faces) = faces(other)? else { return Err(ValueFault::NotInThisVersion { what: MESH.to_owned() }.into()) };
            let mut places = Vec::new();
            for meeting in with_curve::with_curve(curve, &faces, &tolerance)? {
                places.push(Value::point(meeting.point));
                places.extend(meeting.overlap_end.map(|f| Value::point(curve.point(f))));
            }
            Ok(places)
        }
        (a, b) => match (faces(a)?, faces(b)?) {
            (Some(a), Some(b)) => {
                Ok(with_surfaces::with_surfaces(&a, &b, cx.origin(), &tolerance)?.curves.into_iter().map(Value::Curve).collect())
            }
            _ => Err(ValueFault::NotInThisVersion { what: MESH.to_owned() }.into()),
        },
    }
}

const MESH: &str = "`meet` of a mesh";

/// The curves by which things cut a surface: curves themselves, of surfaces those in which they meet it.
pub(crate) fn cutters(cx: &mut Cx, surface: &Surface, by: Vec<Cutter>) -> Result<Vec<Chain>, Halt> {
    let tolerance = cx.tolerance()?;
    let mut chains = Vec::new();
    for cutter in by {
        let faces = match cutter {
            Cutter::Curve(chain) => {
                chains.push(chain);
                continue;
            }
            Cutter::Surface(surface) => vec![surface],
            Cutter::Shell(shell) => shell.surfaces.clone(),
            Cutter::Plane(p) => vec![plane::unbounded(p.at, p.normal, Origin::NONE)?],
        };
        let found = with_surfaces::with_surfaces(::std::slice::from_ref(surface), &faces, cx.origin(), &tolerance)?.curves;
        if found.is_empty() {
            let b = faces.first().map_or(Origin::NONE, Surface::origin);
            return Err(Fault::from(CrossingFault::NoCurve { a: surface.origin(), b, touch: None, tolerance: tolerance.point }).into());
        }
        chains.extend(found);
    }
    Ok(chains)
}

/// A link as the curve it is.
fn plain(cx: &mut Cx, value: &Value) -> Result<Value, Halt> {
    match value {
        Value::Link(..) => cx.as_chain(value.clone()).map(Value::Curve),
        other => Ok(other.clone()),
    }
}

/// The surfaces of a thing; `None` for a mesh or a curve.
fn faces(of: &Meeting) -> Result<Option<Vec<Surface>>, Halt> {
    Ok(match of {
        Meeting::Surface(surface) => Some(vec![surface.clone()]),
        Meeting::Shell(shell) => Some(shell.surfaces.clone()),
        Meeting::Plane(p) => Some(vec![plane::unbounded(p.at, p.normal, Origin::NONE)?]),
        Meeting::Curve(_) | Meeting::Mesh(_) => None,
    })
}

fn later(cx: &Cx, a: &Value, b: &Value) -> Halt {
    let what = format!("`&` of {} and {}", cx.kind(a), cx.kind(b));
    ValueFault::NotInThisVersion { what }.into()
}

impl Cx<'_> {
    /// `c[A..B]`: the run from A to B.
    pub(crate) fn slice_curve(&mut self, code: Code<'_>, id: ExprId, curve: Value, index: ExprId) -> Result<Value, Halt> {
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
                let diagnostic = self.locate(&fault, code, code.span(id), &Blame::default());
                self.sink.reports.push(diagnostic);
                Err(Halt::Failed)
            }
        }
    }

    /// Where an end of a slice lies on the curve, as a fraction of its length.
    fn fraction(&mut self, code: Code<'_>, id: ExprId, chain: &Chain) -> Result<f64, Halt> {
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
                let end = crate::lang::values::units::quantity_text(
                    crate::lang::values::value::Quantity::new(chain.length(), Dim::LENGTH),
                    self.program.unit,
                );
                let text = format!("{found} is outside the curve");
                return Err(self.error(code, "E306", text, code.span(id), format!("between 0 and 100%, or 0 and {end}")).stop());
            }
            point @ (Value::Vector(..) | Value::Node(_) | Value::Vertex(..)) => {
                let Value::Vector(p, _) = self.point_value(code, id, point)? else { return Err(Halt::Bug("a point is a vector")) };
                chain.fraction_at(p, &tolerance)
            }
            other => {
                let found = self.kind(&other);
                let text = format!("a run ends at a node, a point, another curve, a fraction or a length, got {found}");
                return Err(self.error(code, "E211", text, code.span(id), found).stop());
            }
        };
        result.map_err(|fault| {
            let diagnostic = self.locate(&fault, code, code.span(id), &Blame::default());
            self.sink.reports.push(diagnostic);
            Halt::Failed
        })
    }

    fn point_value(&mut self, code: Code<'_>, id: ExprId, value: Value) -> Result<Value, Halt> {
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
