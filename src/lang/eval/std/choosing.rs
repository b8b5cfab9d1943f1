//! Edges chosen by where they lie: on a curve, a plane, a surface or a shell, at a point, inside a box.
//!
//! A few places along an edge refuse most. What they grant is looked at again piece by piece of the curve that carries the
//! edge and of what it may lie on: between knots both are polynomials, and those that agree at many places are one.

use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::ValueFault;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::eval::std::joins::apart;
use crate::lang::eval::std::kinds::{Carrier, EdgeKey, EdgeOf, Faces};
use crate::lang::eval::std::topology::{patches, skin_of};
use crate::lang::values::value::Value;
use crate::model::{PatchId, SharedEdge, SharedTrack, SurfaceId};
use crate::network::Chain;
use crate::surface::core::plane::unbounded;
use crate::surface::intersect::runs::inside as within_faces;
use crate::surface::{Nearest, Surface, chain_breaks, curve_bbox};

/// Places of an edge that are looked at first.
const PLACES: u32 = 16;
/// Places along the whole of an edge at least.
const ALONG: usize = 256;
/// Places in each piece of an edge, and for each piece of what it may lie on.
const A_PIECE: usize = 8;
/// Places of an edge that no curve carries.
const ALONE: u32 = 1024;

/// Places along an edge, its ends among them.
fn places(track: &SharedTrack, parts: u32) -> impl Iterator<Item = DVec3> + '_ {
    (0..=parts).map(move |k| track.point(track.length() * f64::from(k) / f64::from(parts)))
}

/// An edge under its arc length, and the curve that carries it, where one does.
struct Geometry<'a> {
    scene: &'a Scene,
    edge: &'a SharedEdge,
    track: SharedTrack,
    tolerance: Tolerance,
}

impl Geometry<'_> {
    /// Whether all of the edge is wanted: each of some places, and then the curve as a whole.
    fn all(&self, place: impl Fn(DVec3) -> bool, whole: impl Fn(&Chain) -> Result<bool, Halt>) -> Result<bool, Halt> {
        if !places(&self.track, PLACES).all(&place) {
            return Ok(false);
        }
        match self.scene.shared_chain(self.edge, &self.tolerance)? {
            Some(chain) => whole(&chain),
            None => Ok(places(&self.track, ALONE).all(place)),
        }
    }

    fn lies_on(&self, feet: &Feet) -> Result<bool, Halt> {
        let on = |p: DVec3| feet.distance(p) <= self.tolerance.point;
        self.all(on, |chain| {
            let mut stops = vec![0.0];
            stops.extend(chain_breaks(chain));
            stops.push(1.0);
            let parts = ALONG.max(A_PIECE * feet.pieces()).div_ceil(stops.len() - 1).max(A_PIECE);
            let share = |k: usize| (k as f64 + 0.5) / parts as f64;
            Ok(stops.windows(2).all(|w| (0..parts).all(|k| on(chain.point(w[0] + (w[1] - w[0]) * share(k))))))
        })
    }

    fn lies_inside(&self, around: &Box3) -> Result<bool, Halt> {
        let near = self.tolerance.point;
        let inside = |own: Box3| own.min.cmpge(around.min - near).all() && own.max.cmple(around.max + near).all();
        self.all(|p| inside(Box3::of([p])), |chain| Ok(inside(curve_bbox(chain))))
    }
}

/// What edges may lie on, ready for many points.
pub enum Feet {
    /// A curve.
    Curve(Chain),
    /// Surfaces, each made ready.
    Surfaces(Vec<Surface>, Vec<Arc<Nearest>>),
}

impl Feet {
    fn distance(&self, p: DVec3) -> f64 {
        match self {
            Self::Curve(chain) => chain.closest(p).2,
            Self::Surfaces(_, all) => all.iter().map(|nearest| nearest.at(p).distance).fold(f64::INFINITY, f64::min),
        }
    }

    /// Pieces between knots.
    fn pieces(&self) -> usize {
        match self {
            Self::Curve(chain) => chain_breaks(chain).len() + 1,
            Self::Surfaces(all, _) => all.iter().map(|surface| surface.breaks()).map(|(us, vs)| us.len() + vs.len() + 1).sum(),
        }
    }
}

impl Carrier {
    /// Ready for many points.
    pub fn feet(&self, cx: &mut Cx) -> Result<Feet, Halt> {
        let of = |cx: &mut Cx, surfaces: &[Surface]| {
            Feet::Surfaces(surfaces.to_vec(), surfaces.iter().map(|surface| cx.machine.feet.of(surface)).collect())
        };
        Ok(match self {
            Self::Curve(chain) => Feet::Curve(chain.clone()),
            Self::Surface(surface) => of(cx, std::slice::from_ref(surface)),
            Self::Shell(shell) => of(cx, &shell.surfaces),
            Self::Plane(plane) => {
                let plane = unbounded(plane.at, plane.normal, cx.origin())?;
                of(cx, &[plane])
            }
        })
    }
}

/// Those of some edges that are wanted, told the geometry of each; lists of edges flatten.
fn chosen(cx: &mut Cx, edges: Vec<Value>, wanted: impl Fn(&Geometry) -> Result<bool, Halt>) -> Result<Vec<EdgeOf>, Halt> {
    let tolerance = cx.tolerance()?;
    let (mut found, mut open) = (Vec::new(), edges);
    open.reverse();
    while let Some(value) = open.pop() {
        match value {
            Value::List(items) => open.extend(items.iter().rev().cloned()),
            Value::Edge(home, edge) => {
                let scene = Scene { model: cx.model(&home)?, network: cx.network_of(&home)? };
                let Some(track) = scene.model.shared_track(&edge, &scene.network) else { continue };
                if wanted(&Geometry { scene: &scene, edge: &edge, track, tolerance })? {
                    found.push(EdgeOf(home, edge));
                }
            }
            other => {
                return Err(ValueFault::WrongKind { argument: "edges", wanted: "edges", found: cx.kind(&other) }.into());
            }
        }
    }
    Ok(found)
}

/// Edges all of which lies on something, within the tolerance.
pub fn on(cx: &mut Cx, edges: Vec<Value>, carrier: &Carrier) -> Result<Vec<EdgeOf>, Halt> {
    let feet = carrier.feet(cx)?;
    chosen(cx, edges, |edge| edge.lies_on(&feet))
}

/// Edges all of which lies in a box, its border and the tolerance included.
pub fn inside(cx: &mut Cx, edges: Vec<Value>, around: &Box3) -> Result<Vec<EdgeOf>, Halt> {
    chosen(cx, edges, |edge| edge.lies_inside(around))
}

/// The runs of curves that lie inside faces.
pub fn runs_inside(cx: &mut Cx, curves: Vec<Value>, faces: &Faces) -> Result<Vec<Value>, Halt> {
    if let Some(other) = faces.clone().members().iter().find(|v| !matches!(v, Value::Surface(_) | Value::Shell(_))) {
        return Err(ValueFault::WrongKind { argument: "of", wanted: "a box, or faces", found: cx.kind(other) }.into());
    }
    let (tolerance, surfaces) = (cx.tolerance()?, faces.surfaces());
    let mut runs = Vec::new();
    for curve in curves {
        if !matches!(curve, Value::Curve(_) | Value::Link(..) | Value::Edge(..)) {
            return Err(ValueFault::WrongKind { argument: "edges", wanted: "a curve", found: cx.kind(&curve) }.into());
        }
        let chain = cx.as_chain(curve)?;
        runs.extend(within_faces(&chain, &surfaces, &tolerance)?.into_iter().map(Value::Curve));
    }
    Ok(runs)
}

/// Edges whose length is one of the wanted.
pub fn by_length(cx: &mut Cx, edges: Vec<Value>, wanted: impl Fn(f64) -> bool) -> Result<Vec<EdgeOf>, Halt> {
    chosen(cx, edges, |edge| Ok(wanted(edge.track.length())))
}

/// Whether an edge lies on a curve, or a point on it: on any of the borders that are glued there.
pub fn lies(cx: &mut Cx, scene: &Scene, edge: &SharedEdge, key: &EdgeKey) -> Result<bool, Halt> {
    let tolerance = cx.tolerance()?;
    let Some(track) = scene.model.shared_track(edge, &scene.network) else { return Ok(false) };
    match key {
        EdgeKey::Curve(chain) => Geometry { scene, edge, track, tolerance }.lies_on(&Feet::Curve(chain.clone())),
        EdgeKey::Point(p) => Ok(track.distance(*p) <= tolerance.point.max(edge.near)),
    }
}

/// The edges at which a face of some surfaces meets a face of others, as all of them are glued; E618 where there are none, unless it is
/// one list with itself.
pub(crate) fn between(cx: &mut Cx, a: &Faces, b: &Faces) -> Result<Vec<EdgeOf>, Halt> {
    let both = [a.surfaces(), b.surfaces()];
    let snap = a.snap().into_iter().chain(b.snap()).reduce(f64::max);
    let (all, _) = skin_of(cx, &both.concat(), snap)?;
    let (home, model, _) = patches(cx, &both.concat())?;
    let scene = Scene { network: cx.network_of(&home)?, model };
    let mut own: [Vec<SurfaceId>; 2] = [Vec::new(), Vec::new()];
    for (ids, surfaces) in own.iter_mut().zip(&both) {
        *ids = scene.find_all(surfaces)?.into_iter().map(|place| place.0).collect();
    }
    let of = |face: &PatchId, side: usize| own[side].contains(&scene.model.patches[face.index()].surface);
    // Two different faces of it, or both sides of a seam, one of each list.
    let joins = |edge: &&EdgeOf| {
        let faces = &edge.1.faces;
        (0..faces.len()).any(|i| (0..faces.len()).any(|j| i != j && of(&faces[i], 0) && of(&faces[j], 1)))
    };
    let found: Vec<EdgeOf> = all.iter().filter(joins).cloned().collect();
    if found.is_empty() && own[0] != own[1] { Err(apart(&scene, [&own[0], &own[1]])) } else { Ok(found) }
}
