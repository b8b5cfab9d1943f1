//! How faces join along the edges they share.

use std::sync::Arc;

use crate::base::bbox::Box3;
use crate::base::fault::{Say, ValueFault};
use crate::base::tolerance::Tolerance;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::eval::std::kinds::{EdgeOf, EdgeOrSurface, Faces};
use crate::lang::values::conversions::{Angle, FromValue, Length};
use crate::lang::values::types::Ty;
use crate::lang::values::value::{Dim, Quantity, Record, Value};
use crate::model::fault::ShellFault;
use crate::model::{Contact, EdgeId, SurfaceId};
use crate::surface::Surface;
use crate::{builtins, fields};

/// What is told of each joint.
const QUANTITIES: [[&str; 5]; 3] = [
    ["gap", "gap_min", "gap_max", "gap_mean", "gap_at"],
    ["angle", "angle_min", "angle_max", "angle_mean", "angle_at"],
    ["curvature", "curvature_min", "curvature_max", "curvature_mean", "curvature_at"],
];

/// The records that `connection` gives.
#[derive(Clone, Debug)]
pub struct Joints(Vec<Arc<Record>>);

impl FromValue for Joints {
    const TY: Ty = Ty::List(&Ty::Record);
    fn from_value(value: Value) -> Option<Self> {
        Vec::from_value(value).map(Self)
    }
}

impl Joints {
    /// A field of each joint with its length, where it is known; E211 for other records.
    fn each(&self, cx: &Cx, key: &str) -> Result<Vec<(Quantity, f64, Arc<Record>)>, Halt> {
        let field = |record: &Arc<Record>, key: &str| cx.program.names.find(key).and_then(|key| record.get(key)).cloned();
        let mut out = Vec::new();
        for record in &self.0 {
            match (field(record, key), field(record, "length")) {
                (Some(Value::Number(q)), Some(Value::Number(length))) => out.push((q, length.value, Arc::clone(record))),
                (Some(Value::None), Some(_)) => {}
                _ => {
                    let (wanted, found) = ("the joints that `connection` gives", "other records".to_owned());
                    return Err(ValueFault::WrongKind { argument: "of", wanted, found }.into());
                }
            }
        }
        Ok(out)
    }

    /// The largest of a field, with its joint.
    fn largest(&self, cx: &Cx, key: &str) -> Result<Option<(Quantity, Arc<Record>)>, Halt> {
        let found = self.each(cx, key)?.into_iter().map(|(q, _, record)| (q, record));
        Ok(found.reduce(|a, b| if b.0.value > a.0.value { b } else { a }))
    }

    /// The least of a field.
    fn least(&self, cx: &Cx, key: &str) -> Result<Value, Halt> {
        let found = self.each(cx, key)?.into_iter().map(|(q, ..)| q);
        Ok(found.reduce(|a, b| if b.value < a.value { b } else { a }).map_or(Value::None, Value::Number))
    }

    /// Ranges of the least and of the largest values over the joints, the mean by length, and where the largest is.
    fn summary(&self, cx: &mut Cx) -> Result<Vec<Value>, Halt> {
        let mut out = Vec::new();
        for [name, min, max, mean, at] in QUANTITIES {
            let most = self.largest(cx, max)?;
            let place = most.as_ref().and_then(|(_, record)| record.get(cx.program.names.find(at)?).cloned());
            let number = |found: Option<(Quantity, Arc<Record>)>| found.map_or(Value::None, |(q, _)| Value::Number(q));
            let parts = self.each(cx, mean)?;
            let whole: f64 = parts.iter().map(|part| part.1).sum();
            let sum: f64 = parts.iter().map(|(q, length, _)| q.value * length).sum();
            let mean = parts.first().filter(|_| whole > 0.0).map_or(Value::None, |(q, ..)| Value::quantity(sum / whole, q.dim));
            let (lowest, highest, lowest_max) = (self.least(cx, min)?, number(self.largest(cx, min)?), self.least(cx, max)?);
            out.push(cx.record([
                ("of", Value::text(name)),
                ("joints", Value::number(self.0.len() as f64)),
                ("min_from", lowest),
                ("min_to", highest),
                ("max_from", lowest_max),
                ("max_to", number(most)),
                ("mean", mean),
                ("at", place.unwrap_or_default()),
            ]));
        }
        Ok(out)
    }
}

/// The segments that faces of two lists share; without a second list all that the first one's share.
fn shared(scene: &Scene, a: &[Surface], b: Option<&[Surface]>, near: f64, tolerance: &Tolerance) -> Result<Vec<Contact>, Halt> {
    let places = |list: &[Surface]| Ok::<_, Halt>(scene.find_all(list)?.into_iter().map(|(id, _)| id).collect::<Vec<_>>());
    let ours = places(a)?;
    let theirs = b.map(places).transpose()?;
    let members: Vec<SurfaceId> = ours.iter().chain(theirs.iter().flatten()).copied().collect();
    let of = |face: crate::model::PatchId| scene.model.patches[face.index()].surface;
    let contacts = scene.model.contacts(&members, near, &scene.network, tolerance, |one, other| match &theirs {
        None => true,
        Some(theirs) => {
            let (one, other) = (of(one.0), of(other.0));
            ours.contains(&one) && theirs.contains(&other) || ours.contains(&other) && theirs.contains(&one)
        }
    });
    match theirs {
        Some(theirs) if contacts.is_empty() => Err(apart(scene, [&ours, &theirs])),
        _ => Ok(contacts),
    }
}

/// E618 with where the faces of two lists are nearest.
pub(crate) fn apart(scene: &Scene, [ours, theirs]: [&[SurfaceId]; 2]) -> Halt {
    let found = scene.model.apart(ours, theirs);
    let origin = |id: SurfaceId| scene.model.surfaces[id.index()].surface.origin();
    let (first, last) = found.map_or((ours.first().copied(), theirs.first().copied()), |f| (Some(f.surfaces.0), Some(f.surfaces.1)));
    let (a, b) = (first.map(origin).unwrap_or_default(), last.map(origin).unwrap_or_default());
    let (gap, at) = found.map_or((0.0, glam::DVec3::ZERO), |f| (f.gap, f.at));
    ShellFault::NotAdjacent { a, b, gap, at, near: false, snap: None }.into()
}

/// A stretch as a record.
fn record_of(cx: &mut Cx, scene: &Scene, contact: &Contact, tolerance: &Tolerance) -> Value {
    let name = |cx: &Cx, face: crate::model::PatchId| {
        let surface = scene.model.patches[face.index()].surface;
        Value::text(&cx.surface_name(&scene.model.surfaces[surface.index()].surface))
    };
    let (a, b) = (name(cx, contact.faces.0), name(cx, contact.faces.1));
    let angle = |pick: fn(&crate::model::Spread) -> f64| contact.angle.as_ref().map_or(Value::None, |s| Value::angle(pick(s)));
    let curvature = |pick: fn(&crate::model::Spread) -> f64| {
        contact.curvature.as_ref().map_or(Value::None, |s| Value::quantity(pick(s), Dim::CURVATURE))
    };
    let g1 = contact.angle.map_or(Value::None, |s| Value::Bool(s.max <= tolerance.angle));
    cx.record([
        ("a", a),
        ("b", b),
        ("length", Value::length(contact.length)),
        ("mid", Value::point(contact.middle)),
        ("gap_min", Value::length(contact.gap.min)),
        ("gap_max", Value::length(contact.gap.max)),
        ("gap_mean", Value::length(contact.gap.mean)),
        ("gap_at", Value::point(contact.gap.at)),
        ("angle_min", angle(|s| s.min)),
        ("angle_max", angle(|s| s.max)),
        ("angle_mean", angle(|s| s.mean)),
        ("angle_at", contact.angle.map_or(Value::None, |s| Value::point(s.at))),
        ("curvature_min", curvature(|s| s.min)),
        ("curvature_max", curvature(|s| s.max)),
        ("curvature_mean", curvature(|s| s.mean)),
        ("curvature_at", contact.curvature.map_or(Value::None, |s| Value::point(s.at))),
        ("c0", Value::Bool(contact.gap.max <= tolerance.point)),
        ("g1", g1),
    ])
}

/// The stretches along which an edge of the model joins two faces.
fn along(cx: &mut Cx, edge: &EdgeOf) -> Result<Vec<Contact>, Halt> {
    let tolerance = cx.tolerance()?;
    let (model, network) = (cx.model(&edge.0)?, cx.network_of(&edge.0)?);
    const SAMPLES: u32 = 32;
    let Some(track) = model.shared_track(&edge.1, &network) else { return Ok(Vec::new()) };
    let length = track.length();
    let around = Box3::of((0..=SAMPLES).map(|k| track.point(length * f64::from(k) / f64::from(SAMPLES))));
    // No point of the edge is farther from a sample than half a step.
    let reach = tolerance.point + length / f64::from(SAMPLES);
    let near = |n: &usize| model.surfaces[*n].surface.hull().touches(&around, reach);
    let own: Vec<SurfaceId> = edge.1.faces.iter().map(|face| model.patches[face.index()].surface).collect();
    // What a shell glued is one over its distance, faces beside it are not asked.
    let glued = edge.1.courses.len() > 1;
    let members: Vec<SurfaceId> = if glued { own } else { (0..model.surfaces.len()).filter(near).map(SurfaceId::at).collect() };
    let reach = if glued { edge.1.near } else { tolerance.point };
    let on = |at: EdgeId| edge.1.courses.iter().flatten().any(|part| part.edge == at);
    let mut found = model.contacts(&members, reach, &network, &tolerance, |a, b| on(a.1) || on(b.1));
    // Of a long border that several shorter ones meet, what lies beside this edge.
    found.retain(|contact| track.distance(contact.middle) <= reach.max(tolerance.point));
    Ok(found)
}

builtins! {
    /// How the faces of two surfaces join along the edges they share.
    ///
    /// One record for each stretch that they share: by the faces of the first list, then along the border of each. `gap` is the distance of the first face's border from the second one's, `angle` the angle between the normals,
    /// 0 to 90 degrees whatever their sides, `curvature` the size of the difference of their curvatures across the edge, seen from one side; of each the least, the largest, the mean and the place of the largest. They are
    /// taken at 200 or more equally spaced points and refined round the extremes. `c0` says that the gap stays within
    /// the tolerance, `g1` that the angle is below that of a kink. With one argument all inner edges are listed. Where more
    /// than two faces meet, each pair has a record.
    /// Of a shell these are its edges between two faces, glued as the shell glues them. Faces that share no edge are E618;
    /// `within:` counts borders up to this distance apart as shared. `connection(a, b).gap`, `.angle` and `.curvature` are the largest
    /// of all records, `.summary` their ranges.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// surface slab = extrude(south, by: (0, 2m, 0))
    /// let join = connection(wall, slab)[0]
    /// let angle = join.angle_max // => 90deg
    /// check connection(wall, slab).gap <= 1um
    /// report connection(wall, slab)
    /// report connection(wall, slab).summary
    /// ```
    fn connection(
        /// A surface, a shell, or several.
        a: Faces,
        /// What it joins; left out, the inner edges of `a` are listed.
        b: Option<Faces>,
        /// Largest distance of borders that count as shared; when left out that of the shell, else the model's tolerance.
        within: Option<Length>,
    ) -> Vec<Value> = |cx, a, b, within| {
        let (module, tolerance) = (cx.module(), cx.tolerance()?);
        let stated = match within {
            None => None,
            Some(d) if d.0 >= tolerance.point => Some(d.0),
            Some(d) => {
                let (found, range) = (cx.length(d.0), format!("at least the tolerance, {}", cx.length(tolerance.point)));
                return Err(ValueFault::OutsideRange { argument: "within", found, range }.into());
            }
        };
        let glued = a.has_shell() || b.as_ref().is_some_and(Faces::has_shell);
        let snap = a.snap().into_iter().chain(b.as_ref().and_then(Faces::snap)).reduce(f64::max);
        let (a, b) = (a.surfaces(), b.map(|b| b.surfaces()));
        let scene = Scene::of(cx, module, a.iter().chain(b.iter().flatten()))?;
        let near = match stated {
            Some(near) => near,
            None if glued => {
                let places = scene.find_all(a.iter().chain(b.iter().flatten()))?;
                scene.model.reach(places.into_iter().map(|place| place.0), snap, &tolerance)
            }
            None => tolerance.point,
        };
        let contacts = shared(&scene, &a, b.as_deref(), near, &tolerance)?;
        Ok(contacts.iter().map(|contact| record_of(cx, &scene, contact, &tolerance)).collect())
    };
}

fields! {
    /// The largest distance between the faces at an edge, or in a surface's net.
    ///
    /// Of the borders of the faces, or of the curves of the net where they should meet. `none` where only one face is at an edge; where more than two meet it is the largest of all pairs. `none` too of a surface that
    /// was not made through a net.
    fn gap(of: EdgeOrSurface) -> Option<Length> = |cx, of| {
        Ok(match of {
            EdgeOrSurface::Edge(edge) => along(cx, &edge)?.iter().map(|c| c.gap.max).reduce(f64::max).map(Length),
            EdgeOrSurface::Surface(s) => s.net_gaps().first().map(|gap| Length(gap.by)),
        })
    };
    /// Largest angle between the normals of the faces at an edge.
    ///
    /// From 0 to 90 degrees, whatever their sides; `none` where only one face is; where more than two meet, the largest of
    /// all pairs.
    fn angle(of: EdgeOf) -> Option<Angle> = |cx, of| {
        Ok(along(cx, &of)?.iter().filter_map(|c| c.angle).map(|a| a.max).reduce(f64::max).map(Angle))
    };
    /// The largest gap of the joints that `connection` gives; `none` of none.
    fn gap(of: Joints) -> Option<Quantity> = |cx, of| Ok(of.largest(cx, "gap_max")?.map(|found| found.0));
    /// The largest angle between normals at the joints that `connection` gives.
    ///
    /// `none` where no face has a normal there.
    fn angle(of: Joints) -> Option<Quantity> = |cx, of| Ok(of.largest(cx, "angle_max")?.map(|found| found.0));
    /// The largest jump of curvature across joints of `connection`, 1/length.
    ///
    /// `none` where no face has a curvature there.
    fn curvature(of: Joints) -> Option<Quantity> = |cx, of| Ok(of.largest(cx, "curvature_max")?.map(|found| found.0));
    /// The joints of `connection` as a group: gap, angle and jump of curvature.
    ///
    /// Over all joints: the range of the least values (`min_from`, `min_to`), the range of the largest (`max_from`, `max_to`), the mean by length, and where
    /// the largest is (`at`).
    fn summary(of: Joints) -> Vec<Value> = |cx, of| of.summary(cx);
}
