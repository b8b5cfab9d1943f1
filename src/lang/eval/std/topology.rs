//! Patches, edges, vertices and loops of surfaces and shells, and places on surfaces.

use std::sync::Arc;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::fault::{EdgePlace, ValueFault};
use crate::base::origin::Origin;
use crate::builtins;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::eval::std::choosing;
use crate::lang::eval::std::kinds::{Carrier, EdgeKey, EdgeOf, Edged, EdgesOrCurves, Faces, VertexOf};
use crate::lang::values::conversions::{Angle, FromValue, IntoValue, Length};
use crate::lang::values::value::{EntityHome, Value};
use crate::model::contact::Turn;
use crate::model::{EdgeCurve, EdgeId, Model, PatchId, SharedEdge, SharedEdges, SurfaceId};
use crate::network::Chain;
use crate::surface::{IsoLine, Surface, SurfaceKind};

/// The patches of a declared surface in the model of the script.
pub(crate) fn patches(cx: &mut Cx, surfaces: &[Surface]) -> Result<(EntityHome, Arc<Model>, Vec<PatchId>), Halt> {
    let module = cx.module();
    let (scene, home) = Scene::at_home(cx, module, surfaces)?;
    let places = scene.find_all(surfaces)?;
    let patches = places.iter().flat_map(|(id, _)| scene.model.patches_of(*id)).collect();
    Ok((home, scene.model, patches))
}

/// An edge of the model as a value.
pub(crate) fn whole(home: &EntityHome, model: &Model, edge: EdgeId) -> EdgeOf {
    EdgeOf(home.clone(), Arc::new(model.whole_edge(edge)))
}

/// Edges of some surfaces, along the border of each patch.
pub(crate) fn edges(cx: &mut Cx, surfaces: &[Surface]) -> Result<Vec<EdgeOf>, Halt> {
    let (home, model, patches) = patches(cx, surfaces)?;
    Ok(model.edges_along(&patches).into_iter().map(|edge| whole(&home, &model, edge)).collect())
}

pub(crate) fn vertices(cx: &mut Cx, surfaces: &[Surface]) -> Result<Vec<VertexOf>, Halt> {
    let (home, model, patches) = patches(cx, surfaces)?;
    Ok(model.vertices_of(&patches).into_iter().map(|vertex| VertexOf(home.clone(), vertex)).collect())
}

/// Edges of each patch's loop in order.
pub(crate) fn loops(cx: &mut Cx, surfaces: &[Surface]) -> Result<Vec<Vec<EdgeOf>>, Halt> {
    let (home, model, patches) = patches(cx, surfaces)?;
    let of_patch = |patch: &PatchId| model.border_of(*patch).into_iter().map(|(e, _)| whole(&home, &model, e)).collect();
    Ok(patches.iter().map(of_patch).collect())
}

/// The edges of a shell, as values in the order of its skin, and the skin.
pub(crate) fn skin(cx: &mut Cx, faces: &Faces) -> Result<(Vec<EdgeOf>, SharedEdges), Halt> {
    skin_of(cx, &faces.surfaces(), faces.snap())
}

/// The edges of surfaces as they are glued over a stated distance, or as a shell glues them.
pub(crate) fn skin_of(cx: &mut Cx, surfaces: &[Surface], stated: Option<f64>) -> Result<(Vec<EdgeOf>, SharedEdges), Halt> {
    let (home, model, _) = patches(cx, surfaces)?;
    let (tolerance, network) = (cx.tolerance()?, cx.network_of(&home)?);
    let scene = Scene { model, network };
    let places: Vec<SurfaceId> = scene.find_all(surfaces)?.into_iter().map(|place| place.0).collect();
    let near = scene.model.reach(places.iter().copied(), stated, &tolerance);
    let skin = scene.model.shared_edges(&places, near, &scene.network, &tolerance);
    Ok((skin.edges.iter().map(|edge| EdgeOf(home.clone(), Arc::new(edge.clone()))).collect(), skin))
}

/// Some edges of a skin by their places.
pub(crate) fn picked(all: &[EdgeOf], places: &[usize]) -> Vec<EdgeOf> {
    places.iter().map(|k| all[*k].clone()).collect()
}

/// Edges at which faces turn by more than an angle, radians.
fn creases(cx: &mut Cx, faces: &Faces, angle: f64) -> Result<Vec<EdgeOf>, Halt> {
    let (all, _) = skin(cx, faces)?;
    let Some(home) = all.first().map(|edge| edge.0.clone()) else { return Ok(all) };
    let (model, network, tolerance) = (cx.model(&home)?, cx.network_of(&home)?, cx.tolerance()?);
    let scene = Scene { model, network };
    let surfaces = faces.surfaces();
    let places: Vec<SurfaceId> = scene.find_all(&surfaces)?.into_iter().map(|place| place.0).collect();
    let near = scene.model.reach(places.iter().copied(), faces.snap(), &tolerance);
    let turns = scene.model.turns(&places, near, &scene.network, &tolerance);
    let on = |edge: &EdgeOf, turn: &Turn| {
        edge.1.courses.iter().flatten().any(|part| part.edge == turn.edge && part.s.0 <= turn.s && turn.s <= part.s.1)
    };
    let turns = |edge: &EdgeOf| turns.iter().any(|turn| turn.turn > angle && on(edge, turn));
    Ok(all.into_iter().filter(turns).collect())
}

/// The box that a record with the points `min` and `max` is.
fn corners(cx: &mut Cx, value: &Value) -> Result<Box3, Halt> {
    let (min, max) = (cx.program.names.intern("min"), cx.program.names.intern("max"));
    let point = |value: Option<&Value>| match value {
        Some(Value::Vector(p, _) | Value::Node(p)) => Some(*p),
        _ => None,
    };
    let ends = if let Value::Record(record) = value { [min, max].map(|key| point(record.get(key))) } else { [None, None] };
    match ends {
        [Some(a), Some(b)] => Ok(Box3::of([a, b])),
        _ => Err(ValueFault::WrongKind { argument: "of", wanted: "a box, or faces", found: cx.kind(value) }.into()),
    }
}

/// The geometry of an edge at the middle of its length.
pub(crate) fn middle(cx: &mut Cx, edge: &EdgeOf) -> Result<DVec3, Halt> {
    let (model, network) = (cx.model(&edge.0)?, cx.network_of(&edge.0)?);
    let track = model.shared_track(&edge.1, &network).ok_or(Halt::Bug("an edge without geometry"))?;
    Ok(track.point(0.5 * track.length()))
}

/// The one edge of some faces that lies on a curve or at a point: of one surface as the model has it, of several as their faces are glued.
/// Edges of one surface that are glued to each other are one too.
fn edge_of(cx: &mut Cx, faces: &Faces, key: &EdgeKey) -> Result<EdgeOf, Halt> {
    let surfaces = faces.surfaces();
    let alone = surfaces.len() == 1 && !faces.has_shell();
    let (home, model, patches) = patches(cx, &surfaces)?;
    let scene = Scene { model: model.clone(), network: cx.network_of(&home)? };
    let mut found: Vec<EdgeOf> = Vec::new();
    if alone {
        let mut own: Vec<EdgeId> = Vec::new();
        for edge in model.edges_of(&patches) {
            if choosing::lies(cx, &scene, &model.whole_edge(edge), key)? {
                own.push(edge);
            }
        }
        let swept: Vec<EdgeId> = match key {
            EdgeKey::Point(_) => own.iter().copied().filter(|edge| is_swept(&model, &patches, *edge)).collect(),
            EdgeKey::Curve(_) => Vec::new(),
        };
        if let ([one], _) | (_, [one]) = (own.as_slice(), swept.as_slice()) {
            return Ok(whole(&home, &model, *one));
        }
        found = own.into_iter().map(|edge| whole(&home, &model, edge)).collect();
    }
    if !alone || found.len() > 1 {
        let (glued, _) = skin(cx, faces)?;
        let mut shared = Vec::new();
        for edge in glued {
            if choosing::lies(cx, &scene, &edge.1, key)? {
                shared.push(edge);
            }
        }
        if let [one] = shared.as_slice() {
            return Ok(one.clone());
        }
        if !alone {
            found = shared;
        }
    }
    let of = if alone { surfaces.first().map_or(Origin::NONE, Surface::origin) } else { faces.origin() };
    let found = found.iter().map(|edge| edge_place(&scene, &edge.1)).collect();
    Err(ValueFault::NotOneEdge { of, found }.into())
}

/// Where an edge lies, for whoever must choose among several.
fn edge_place(scene: &Scene, edge: &SharedEdge) -> EdgePlace {
    let (model, network) = (&scene.model, &scene.network);
    let middle = model.shared_track(edge, network).map_or(DVec3::ZERO, |track| track.point(0.5 * track.length()));
    let mut faces: Vec<Origin> = Vec::new();
    for patch in &edge.faces {
        let surface = model.patches[patch.index()].surface;
        let origin = model.surfaces[surface.index()].surface.origin();
        if !faces.contains(&origin) {
            faces.push(origin);
        }
    }
    let curve = edge.first().map(|part| &model.edges[part.edge.index()].curve);
    let curve = match curve {
        Some(EdgeCurve::Links { links, .. }) => links.first().map(|(link, _)| network.links[link.index()].curve),
        _ => None,
    };
    EdgePlace { middle, curve: curve.map_or(Origin::NONE, |curve| network.curves[curve.index()].curve.origin()), faces }
}

/// Whether an edge is the way of one point of a profile that was moved or turned: v stands still along it.
fn is_swept(model: &Model, patches: &[PatchId], edge: EdgeId) -> bool {
    patches.iter().map(|p| &model.patches[p.index()]).any(|patch| {
        let kind = model.surfaces[patch.surface.index()].surface.kind();
        let along = |side: usize| patch.sides.get(side).is_some_and(|s| s.edges.iter().any(|(e, _)| *e == edge));
        matches!(kind, SurfaceKind::Extrude | SurfaceKind::Revolve | SurfaceKind::Along | SurfaceKind::Sweep) && (along(0) || along(2))
    })
}

/// The modeling curve along an edge.
pub(crate) fn curve_of(cx: &mut Cx, edge: EdgeOf) -> Result<Chain, Halt> {
    let tolerance = cx.tolerance()?;
    let scene = Scene { model: cx.model(&edge.0)?, network: cx.network_of(&edge.0)? };
    let later = || ValueFault::NotInThisVersion { what: "a line across a trimmed surface as a curve".to_owned() };
    Ok(scene.shared_chain(&edge.1, &tolerance)?.ok_or_else(later)?)
}

/// The line of constant u or v.
pub(crate) fn iso_line(cx: &mut Cx, of: &Surface, at: IsoLine, argument: &'static str) -> Result<Chain, Halt> {
    let tolerance = cx.tolerance()?;
    if !(0.0..=1.0).contains(&at.value()) {
        let (found, range) = (at.value().to_string(), "between 0 and 1".to_owned());
        return Err(ValueFault::OutsideRange { argument, found, range }.into());
    }
    let word = if matches!(at, IsoLine::U(_)) { "u" } else { "v" };
    let what = format!("a line of constant {word} inside a surface by `{}`", of.kind().name());
    let curve = of.iso(at, cx.origin(), &tolerance)?.ok_or(ValueFault::NotInThisVersion { what })?;
    Ok(Chain::of_curve(&curve))
}

builtins! {
    /// The edge of faces that lies along a curve, or on which a point lies.
    ///
    /// Of the edges of one extruded or turned surface that meet in a point it is the one that this point of the profile sweeps.
    /// Of a shell or of several surfaces it is an edge as they are glued: a border that two faces share is one edge.
    /// Where several edges lie, the error (E215) says where each has its middle and which faces are on it.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// surface slab = extrude(south, by: (0, 2m, 0))
    /// let foot = wall.edge(south).length // => 4000mm
    /// let post = wall.edge(south.end).length // => 3000mm
    /// let corner = [wall, slab].edge((2m, 0, 0)).angle // => 90deg
    /// ```
    fn edge(
        /// A surface, a shell, or several.
        of: Edged,
        /// A curve it lies on, or a point of it.
        on: EdgeKey,
    ) -> EdgeOf = |cx, of, on| edge_of(cx, &of.0, &on);

    /// Edges at which the faces of surfaces or shells turn by more than an angle.
    ///
    /// The angle is that between the normals of the two faces, 0 where they join smoothly and 180 degrees where they fold
    /// back; the largest of 200 or more places along the edge counts, and of more than two faces the largest of all pairs.
    /// Free edges have none (`.rims`).
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// surface slab = extrude(south, by: (0, 2m, 0))
    /// shell s of wall, slab
    /// let corner = s.creases(angle: 30deg)[0].length // => 4000mm
    /// ```
    fn creases(
        /// A surface, a shell, or several.
        of: Edged,
        /// How far the normal turns at least.
        angle: Angle,
    ) -> Vec<EdgeOf> = |cx, of, angle| creases(cx, &of.0, angle.0);

    /// Edges that lie on a plane, surface, shell or curve.
    ///
    /// An edge lies on it when all of it does, within the tolerance.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let top = wall.edges.on(plane(at: (0, 0, 3m), normal: (0, 0, 1)))[0].length // => 4000mm
    /// ```
    fn on(
        /// Edges; lists of them flatten.
        edges: Vec<Value>,
        /// A plane, surface, shell or curve.
        carrier: Carrier,
    ) -> Vec<EdgeOf> = |cx, edges, carrier| choosing::on(cx, edges, &carrier);

    /// Edges inside a box, or the runs of curves inside faces.
    ///
    /// A box lies along the axes; an edge is inside when all of it is. Of a curve it is what lies on a surface or shell, within the tolerance and
    /// inside of its loops: runs of the curve in their order, each a curve, none where no part of it lies there. A run goes on where faces join, and past
    /// the start of a closed curve. `project` brings a curve onto a surface before. The borders of box and faces belong to them.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let low = wall.edges.inside(box((0, 0, 0), (4m, 0, 1m)))[0].length // => 4000mm
    /// let rail = line((-1m, 0, 1m), (6m, 0, 1m))
    /// curve held = rail.inside(wall)[0]
    /// check held.length == 4m within 1e-9%
    /// ```
    fn inside(
        /// Edges, of a box; curves, of faces. Lists of them flatten.
        edges: EdgesOrCurves,
        /// A box, as `box` and `bbox` give it; or a surface, a shell, or several.
        of: Value,
    ) -> Vec<Value> = |cx, edges, of| {
        if let Some(faces) = Edged::from_value(of.clone()) {
            return choosing::runs_inside(cx, edges.0, &faces.0);
        }
        let around = corners(cx, &of)?;
        Ok(choosing::inside(cx, edges.0, &around)?.into_iter().map(IntoValue::into_value).collect())
    };

    /// The edges that faces of one list share with faces of another.
    ///
    /// All of them are glued as a shell would glue them, so a border that two faces share is one edge; of a corner that the two have in common there is none.
    /// They are a list in the order of the faces of `a`, for groups, rules of meshes and checks; `edge_between(s, s)` are the inner edges and
    /// seams of `s`, if it has some. Other faces that share no edge are E618.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// surface slab = extrude(south, by: (0, 2m, 0))
    /// let foot = edge_between(wall, slab)
    /// check len(foot) == 1 and foot[0].length == 4m within 1e-9%
    /// group joint of foot
    /// mesh fine of wall, slab { size: 500mm  on foot { count: 10 } }
    /// ```
    fn edge_between(
        /// A surface, a shell, or several.
        a: Edged,
        /// What it shares edges with.
        b: Edged,
    ) -> Vec<EdgeOf> = |cx, a, b| choosing::between(cx, &a.0, &b.0);

    /// Edges whose length is between two lengths.
    ///
    /// Both bounds are included, within the tolerance.
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let long = len(wall.edges.by_length(least: 3.5m)) // => 2
    /// ```
    fn by_length(
        /// Edges; lists of them flatten.
        edges: Vec<Value>,
        /// The least length.
        least: Option<Length>,
        /// The largest length.
        most: Option<Length>,
    ) -> Vec<EdgeOf> = |cx, edges, least, most| {
        if least.is_none() && most.is_none() {
            let (what, example) = ("`least:` or `most:`", "edges.by_length(least: 1m)");
            return Err(ValueFault::Missing { function: "by_length", what, example }.into());
        }
        let tolerance = cx.tolerance()?;
        let (least, most) = (least.map_or(0.0, |l| l.0), most.map_or(f64::INFINITY, |l| l.0));
        choosing::by_length(cx, edges, |length| length >= least - tolerance.point && length <= most + tolerance.point)
    };

    /// The line of constant u or v of a surface, as a curve.
    ///
    /// It runs with the other parameter ascending and may join the network (`curve seam = iso(roof, u: 0.5)`); in a mesh
    /// `of roof, seam` it lies on mesh lines. `roof.u(0.5)` and `roof.v(0.5)` say the same. It is exact on `extrude`,
    /// `revolve`, `bezier_surface`, `nurbs_surface` and `grid`, along the straight lines of `ruled`, and on every surface for
    /// its borders and the curves of its grid; elsewhere it is a cubic within a quarter of the tolerance.
    /// ```loft
    /// curve south = arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 1m))
    /// surface roof = extrude(south, by: (0, 9m, 0))
    /// curve ridge = iso(roof, v: 0.5)
    /// let length = ridge.length // => 9000mm
    /// ```
    fn iso(
        /// A surface.
        of: Surface,
        /// From 0 to 1; give this or `v`.
        u: Option<f64>,
        /// From 0 to 1.
        v: Option<f64>,
    ) -> Chain = |cx, of, u, v| match (u, v) {
        (Some(u), None) => iso_line(cx, &of, IsoLine::U(u), "u"),
        (None, Some(v)) => iso_line(cx, &of, IsoLine::V(v), "v"),
        (Some(_), Some(_)) => {
            Err(ValueFault::Exclusive {
                function: "iso",
                what: "a constant u or a constant v, not both",
                arguments: vec!["u", "v"],
                example: "iso(roof, u: 0.5)",
            }
            .into())
        }
        (None, None) => Err(ValueFault::Missing { function: "iso", what: "`u:` or `v:`", example: "iso(roof, u: 0.5)" }.into()),
    };

    /// The line of constant u of a surface, see `iso`.
    ///
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let belt = wall.u(0.5).length // => 4000mm
    /// ```
    fn u(
        /// A surface.
        of: Surface,
        /// From 0 to 1.
        at: f64,
    ) -> Chain = |cx, of, at| iso_line(cx, &of, IsoLine::U(at), "at");

    /// The line of constant v of a surface, see `iso`.
    ///
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let post = wall.v(0.5).length // => 3000mm
    /// ```
    fn v(
        /// A surface.
        of: Surface,
        /// From 0 to 1.
        at: f64,
    ) -> Chain = |cx, of, at| iso_line(cx, &of, IsoLine::V(at), "at");
}
