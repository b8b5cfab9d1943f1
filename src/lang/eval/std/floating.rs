//! What floats, as functions take it, and what they tell of it.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::{Say, ValueFault};
use crate::base::math;
use crate::hydrostatics::body::{Body, FreeEdge};
use crate::hydrostatics::particulars::{Particulars, Position};
use crate::hydrostatics::triangles::free_sides;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::kinds::Faces;
use crate::lang::eval::std::topology::skin;
use crate::lang::values::conversions::{Density, FromValue, Length};
use crate::lang::values::types::Ty;
use crate::lang::values::units::{CENTIMETRE, convert, radians};
use crate::lang::values::value::{Dim, MeshValue, ShellValue, Value};
use crate::surface::Surface;

/// Points along a free edge that are looked at.
const EDGE_POINTS: u32 = 64;

/// What floats.
#[derive(Clone, Debug)]
pub enum Floating {
    /// Faces: surfaces and shells.
    Faces(Vec<Value>),
    /// A mesh.
    Mesh(Arc<MeshValue>),
}

impl FromValue for Floating {
    const TY: Ty = Ty::OneOf(&[Ty::Shell, Ty::Surface, Ty::Mesh, Ty::List(&Ty::OneOf(&[Ty::Surface, Ty::Shell]))]);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Mesh(mesh) => Some(Self::Mesh(mesh)),
            Value::List(items) => Some(Self::Faces(items.to_vec())),
            one @ (Value::Surface(_) | Value::Shell(_)) => Some(Self::Faces(vec![one])),
            _ => None,
        }
    }
}

/// Trim by the stern.
#[derive(Clone, Copy, Debug)]
pub enum Trim {
    /// Radians.
    Angle(f64),
    /// Draft aft less draft forward, model units.
    Drafts(f64),
}

impl FromValue for Trim {
    const TY: Ty = Ty::OneOf(&[Ty::Quantity(Dim::ANGLE), Ty::Quantity(Dim::LENGTH)]);
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(q) if q.dim == Dim::ANGLE => Some(Self::Angle(radians(q.value))),
            Value::Number(q) => Some(Self::Drafts(q.value)),
            _ => None,
        }
    }
}

impl Trim {
    /// As an angle, radians; drafts differ over a length, the body's where none is given. E306 for a length that is not above 0.
    pub(super) fn angle(self, cx: &Cx, body: &Body, length: Option<Length>) -> Result<f64, Halt> {
        match (self, length) {
            (Self::Angle(angle), _) => Ok(angle),
            (Self::Drafts(apart), None) => Ok(math::atan2(apart, body.bounds.max.x - body.bounds.min.x)),
            (Self::Drafts(apart), Some(over)) => Ok(math::atan2(apart, above_zero("length", over.0, cx.length(over.0))?)),
        }
    }
}

/// What floats, made ready; of a shell once a run.
pub(super) fn body(cx: &mut Cx, what: &Floating) -> Result<Arc<Body>, Halt> {
    let tolerance = cx.tolerance()?.point;
    let origin = cx.origin();
    let values = match what {
        Floating::Mesh(mesh) => {
            let (nodes, corners) = triangles(cx, mesh)?;
            let edge = |side: &[u32; 2]| FreeEdge { of: origin, points: side.iter().map(|k| nodes[*k as usize]).collect() };
            let free = free_sides(&corners).iter().map(edge).collect();
            return Ok(Arc::new(Body::of_triangles(origin, nodes, corners, free, tolerance)?));
        }
        Floating::Faces(values) => values,
    };
    let whole = match values.as_slice() {
        [Value::Shell(shell)] => shell.clone(),
        _ => Arc::new(taken_together(cx, values)),
    };
    let module = cx.module();
    let glued = match cx.glued(module, &whole) {
        Err(Halt::Fault(fault)) if fault.code().0 == APART && values.len() > 1 => return bodies_apart(cx, values),
        glued => glued?,
    };
    glued.body(|| {
        let free = free_edges(cx, &whole)?;
        Ok(Body::of_faces(whole.origin, &glued.faces(), free, tolerance.max(glued.shell.near))?)
    })
}

/// Faces that share no edge with the others, as those of two hulls.
const APART: &str = "E618";

/// One body of several, each a shell or what the surfaces among the values are together.
fn bodies_apart(cx: &mut Cx, values: &[Value]) -> Result<Arc<Body>, Halt> {
    let (tolerance, module) = (cx.tolerance()?.point, cx.module());
    let is_shell = |value: &&Value| matches!(value, Value::Shell(_));
    let loose: Vec<Value> = values.iter().filter(|value| !is_shell(value)).cloned().collect();
    let shells = values.iter().filter_map(|value| if let Value::Shell(shell) = value { Some(shell.clone()) } else { None });
    let mut parts: Vec<Arc<ShellValue>> = shells.collect();
    parts.extend((!loose.is_empty()).then(|| Arc::new(taken_together(cx, &loose))));
    let (mut faces, mut free, mut near) = (Vec::new(), Vec::new(), tolerance);
    for shell in &parts {
        let glued = cx.glued(module, shell)?;
        let edges = free_edges(cx, shell)?;
        let reach = tolerance.max(glued.shell.near);
        let own = glued.body(|| Ok(Body::of_faces(shell.origin, &glued.faces(), edges.clone(), reach)?))?;
        faces.extend(glued.faces().into_iter().map(|(surface, other)| (surface, other != own.turned_inwards())));
        free.extend(edges);
        near = near.max(glued.shell.near);
    }
    Ok(Arc::new(Body::of_faces(cx.origin(), &faces, free, near)?))
}

/// The nodes of a mesh and the corners of its elements as triangles.
pub(super) fn triangles(cx: &mut Cx, mesh: &MeshValue) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), Halt> {
    let mesh = cx.mesh(mesh)?;
    let quads = mesh.quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    Ok((mesh.nodes.clone(), mesh.triangles.iter().copied().chain(quads).collect()))
}

/// The surfaces of surfaces and shells.
pub(super) fn surfaces(values: &[Value]) -> Vec<Surface> {
    let of = |value: &Value| match value {
        Value::Surface(surface) => vec![surface.clone()],
        Value::Shell(shell) => shell.surfaces.clone(),
        _ => Vec::new(),
    };
    values.iter().flat_map(of).collect()
}

/// Surfaces and shells as one shell.
fn taken_together(cx: &mut Cx, values: &[Value]) -> ShellValue {
    let surfaces = surfaces(values);
    ShellValue { name: "".into(), module: cx.module(), origin: cx.origin(), surfaces, snap: None, imprint: None, flip: false, body: None }
}

/// The edges of one face alone, as points along them.
fn free_edges(cx: &mut Cx, shell: &Arc<ShellValue>) -> Result<Vec<FreeEdge>, Halt> {
    let (edges, _) = skin(cx, &Faces::of_shell(shell.clone()))?;
    let mut free = Vec::new();
    for edge in edges.iter().filter(|edge| edge.1.faces.len() == 1) {
        let (model, network) = (cx.model(&edge.0)?, cx.network_of(&edge.0)?);
        let Some(track) = model.shared_track(&edge.1, &network) else { continue };
        let at = |k: u32| track.point(track.length() * f64::from(k) / f64::from(EDGE_POINTS));
        let of = model.surfaces[model.patches[edge.1.faces[0].index()].surface.index()].surface.origin();
        free.push(FreeEdge { of, points: (0..=EDGE_POINTS).map(at).collect() });
    }
    Ok(free)
}

/// What particulars refer to beside the position.
#[derive(Clone, Copy)]
pub(super) struct Reference {
    /// Density of the water, kg a cubic model unit.
    pub density: f64,
    /// Length of the coefficients, model units.
    pub length: Option<f64>,
    /// Beam of the coefficients, model units.
    pub beam: Option<f64>,
}

/// Particulars as a record; with a centre of gravity also the metacentric heights.
pub(super) fn record(cx: &mut Cx, at: &Position, found: &Particulars, to: Reference, gravity: Option<DVec3>) -> Value {
    let maybe = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or(Value::None, Value::length);
    let ratio = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or(Value::None, Value::number);
    let (per_area, moment) = (Dim { length: -1, ..Dim::MASS }, Dim { length: 1, ..Dim::MASS });
    let afloat = found.volume > 0.0;
    let ((bmt, bml), up) = (found.bm(), at.water().up);
    let over_gravity = gravity.filter(|_| afloat).map(|g| up.dot(found.buoyancy - g));
    let waterline = found.outline.map(|o| (o.along.1 - o.along.0, o.across.1 - o.across.0));
    let (lwl, bwl) = (waterline.map(|w| w.0), waterline.map(|w| w.1));
    let (l, b) = (to.length.or(lwl), to.beam.or(bwl));
    let over = |value: f64, by: Option<f64>| by.map(|by| value / by);
    let box_of = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a * b);
    let centimetre = convert(1.0, CENTIMETRE, cx.unit(), 1);
    let when = |x: f64| afloat.then_some(x);
    let errors = cx.record([
        ("volume", Value::quantity(found.volume_error, Dim::VOLUME)),
        ("wetted_surface", Value::quantity(found.wetted_error, Dim::AREA)),
        ("waterplane_area", Value::quantity(found.plane_error, Dim::AREA)),
        ("bmt", maybe(when(found.inertia_error.0 / found.volume))),
        ("bml", maybe(when(found.inertia_error.1 / found.volume))),
    ]);
    let mct = over_gravity.zip(l).map(|(arm, l)| to.density * found.volume * (bml + arm) * centimetre / l);
    cx.record([
        ("draft", maybe(at.draft())),
        ("trim", Value::angle(at.trim)),
        ("heel", Value::angle(at.heel)),
        ("displacement", Value::quantity(to.density * found.volume, Dim::MASS)),
        ("volume", Value::quantity(found.volume, Dim::VOLUME)),
        ("wetted_surface", Value::quantity(found.wetted, Dim::AREA)),
        ("waterplane_area", Value::quantity(found.plane_area, Dim::AREA)),
        ("midship_area", Value::quantity(found.midship_area, Dim::AREA)),
        ("buoyancy", if afloat { Value::point(found.buoyancy) } else { Value::None }),
        ("lcb", maybe(when(found.buoyancy.x - at.midship))),
        ("lcf", maybe((found.plane_area > 0.0).then_some(found.flotation.x - at.midship))),
        ("kb", maybe(when(found.kb))),
        ("bmt", maybe(when(bmt))),
        ("bml", maybe(when(bml))),
        ("kmt", maybe(when(found.kb + bmt))),
        ("kml", maybe(when(found.kb + bml))),
        ("gmt", maybe(over_gravity.map(|arm| bmt + arm))),
        ("gml", maybe(over_gravity.map(|arm| bml + arm))),
        ("lwl", maybe(lwl)),
        ("bwl", maybe(bwl)),
        ("cb", ratio(over(found.volume, box_of(l, b)).zip(at.draft()).map(|(x, draft)| x / draft))),
        ("cp", ratio(over(found.volume, l).map(|x| x / found.midship_area))),
        ("cm", ratio(over(found.midship_area, b).zip(at.draft()).map(|(x, draft)| x / draft))),
        ("cw", ratio(over(found.plane_area, box_of(l, b)))),
        ("tpc", Value::quantity(to.density * found.plane_area * centimetre, Dim::MASS)),
        ("immersion", Value::quantity(to.density * found.plane_area, per_area)),
        ("mct", mct.map_or(Value::None, |x| Value::quantity(x, moment))),
        ("errors", errors),
    ])
}

/// Where drafts and lengths are counted from.
pub(super) fn reference(body: &Body, base: Length, midship: Option<Length>) -> Position {
    let middle = 0.5 * (body.bounds.min.x + body.bounds.max.x);
    Position { depth: 0.0, trim: 0.0, heel: 0.0, base: base.0, midship: midship.map_or(middle, |x| x.0) }
}

/// E306 for a value that must be above 0.
pub(super) fn above_zero(argument: &'static str, value: f64, found: String) -> Result<f64, Halt> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(ValueFault::OutsideRange { argument, found, range: "above 0".to_owned() }.into())
}

/// The density of the water; E306 where it is not above 0.
pub(super) fn density_of(cx: &Cx, density: Density) -> Result<f64, Halt> {
    above_zero("density", density.0, format!("{} kg a cubic {}", density.0, cx.unit().name))
}
