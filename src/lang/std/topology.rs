//! Patches, edges, vertices and loops of surfaces and shells, and places on surfaces.

use std::sync::Arc;

use glam::DVec3;

use super::kinds::{EdgeKey, EdgeOf, PatchOf, VertexOf};
use super::surfaces::checked_uv;
use crate::base::fault::ValueFault;
use crate::base::origin::Origin;
use crate::lang::cx::{Cx, Stop};
use crate::lang::scene::Scene;
use crate::lang::types::{Direction, Length, Point};
use crate::lang::value::{ModuleId, ShellValue, Value};
use crate::model::{EdgeId, Model, PatchId, VertexId};
use crate::network::Chain;
use crate::surface::{IsoLine, Surface};
use crate::{builtins, fields};

/// The patches of a declared surface in the model of the script.
fn patches(cx: &mut Cx, surfaces: &[Surface]) -> Result<(ModuleId, Arc<Model>, Vec<PatchId>), Stop> {
    let module = cx.module();
    let model = cx.model(module)?;
    let scene = Scene { network: cx.network(module)?, model: model.clone() };
    let mut patches = Vec::new();
    for surface in surfaces {
        let undeclared = || ValueFault::NoPatches { of: surface.origin() };
        let (id, _) = scene.find(surface).ok_or_else(undeclared)?;
        patches.extend(model.patches_of(id));
    }
    Ok((module, model, patches))
}

fn edges(cx: &mut Cx, surfaces: &[Surface]) -> Result<Vec<EdgeOf>, Stop> {
    let (module, model, patches) = patches(cx, surfaces)?;
    Ok(model.edges_of(&patches).into_iter().map(|edge| EdgeOf(module, edge)).collect())
}

fn vertices(cx: &mut Cx, surfaces: &[Surface]) -> Result<Vec<VertexOf>, Stop> {
    let (module, model, patches) = patches(cx, surfaces)?;
    Ok(model.vertices_of(&patches).into_iter().map(|vertex| VertexOf(module, vertex)).collect())
}

/// Edges of each patch's loop in order.
fn loops(cx: &mut Cx, surfaces: &[Surface]) -> Result<Vec<Vec<EdgeOf>>, Stop> {
    let (module, model, patches) = patches(cx, surfaces)?;
    let of_patch = |patch: &PatchId| model.loop_of(*patch).pieces.iter().filter_map(|p| p.edge).map(|(e, _)| EdgeOf(module, e)).collect();
    Ok(patches.iter().map(of_patch).collect())
}

/// The geometry of an edge at the middle of its length.
fn middle(cx: &mut Cx, edge: EdgeOf) -> Result<DVec3, Stop> {
    let (model, network) = (cx.model(edge.0)?, cx.network(edge.0)?);
    Ok(model.track(edge.1, &network).point(0.5 * model.edges[edge.1.index()].length))
}

/// The one edge of some surfaces that lies on a curve or at a point.
fn edge_of(cx: &mut Cx, surfaces: &[Surface], key: &EdgeKey) -> Result<EdgeOf, Stop> {
    let tolerance = cx.tolerance()?;
    let (module, model, patches) = patches(cx, surfaces)?;
    let network = cx.network(module)?;
    let lies = |edge: &EdgeId| {
        let (track, length) = (model.track(*edge, &network), model.edges[edge.index()].length);
        match key {
            EdgeKey::Curve(chain) => {
                [0.0, 0.25, 0.5, 0.75, 1.0].iter().all(|f| chain.closest(track.point(f * length)).2 <= tolerance.point)
            }
            EdgeKey::Point(p) => on_track(|s| track.jet(s), length, *p) <= tolerance.point,
        }
    };
    let found: Vec<EdgeId> = model.edges_of(&patches).into_iter().filter(lies).collect();
    match found.as_slice() {
        [one] => Ok(EdgeOf(module, *one)),
        _ => {
            let of = surfaces.first().map_or(Origin::NONE, Surface::origin);
            let places = found.iter().map(|e| model.track(*e, &network).point(0.5 * model.edges[e.index()].length)).collect();
            Err(ValueFault::NotOneEdge { of, places }.into())
        }
    }
}

/// Distance of a point from a track of this length, by projection from the nearest of some samples.
fn on_track(jet: impl Fn(f64) -> (DVec3, DVec3), length: f64, p: DVec3) -> f64 {
    const SAMPLES: u32 = 64;
    const ROUNDS: u32 = 20;
    let stations = (0..=SAMPLES).map(|k| length * f64::from(k) / f64::from(SAMPLES));
    let nearest = stations.min_by(|a, b| jet(*a).0.distance_squared(p).total_cmp(&jet(*b).0.distance_squared(p))).unwrap_or(0.0);
    let foot = (0..ROUNDS).fold(nearest, |s, _| {
        let (point, tangent) = jet(s);
        (s + (p - point).dot(tangent)).clamp(0.0, length)
    });
    jet(foot).0.distance(p).min(jet(nearest).0.distance(p))
}

/// The modeling curve along an edge.
fn curve_of(cx: &mut Cx, edge: EdgeOf) -> Result<Chain, Stop> {
    let tolerance = cx.tolerance()?;
    let scene = Scene { model: cx.model(edge.0)?, network: cx.network(edge.0)? };
    let later = || ValueFault::NotInThisVersion { what: "an edge inside a surface as a curve".to_owned() };
    Ok(scene.edge_chain(&scene.model.edges[edge.1.index()], &tolerance)?.ok_or_else(later)?)
}

/// The line of constant u or v.
fn iso_line(cx: &mut Cx, of: &Surface, at: IsoLine, argument: &'static str) -> Result<Chain, Stop> {
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
    /// The edge of a surface that lies along a curve, or on which a point lies.
    ///
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let foot = wall.edge(south).length // => 4000mm
    /// ```
    fn edge(
        /// A surface.
        of: Surface,
        /// A curve it lies on, or a point of it.
        on: EdgeKey,
    ) -> EdgeOf = |cx, of, on| edge_of(cx, &[of], &on);

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

    /// The unit normal of a surface at u and v.
    ///
    /// ```loft
    /// curve south = line((0, 0, 0), (4m, 0, 0))
    /// surface wall = extrude(south, by: (0, 0, 3m))
    /// let n = wall.normal(0.5, 0.5)
    /// ```
    fn normal(
        /// A surface.
        of: Surface,
        /// From 0 to 1.
        u: f64,
        /// From 0 to 1.
        v: f64,
    ) -> Direction = |_, of, u, v| {
        let (u, v) = checked_uv(&of, (u, "u"), (v, "v"))?;
        Ok(Direction(of.normal(u, v)))
    };
}

fields! {
    /// The patches of a surface: its smooth pieces.
    fn patches(of: Surface) -> Vec<PatchOf> = |cx, of| {
        let (module, _, patches) = patches(cx, &[of])?;
        Ok(patches.into_iter().map(|p| PatchOf(module, p)).collect())
    };
    /// The edges of a surface: the borders of its patches.
    fn edges(of: Surface) -> Vec<EdgeOf> = |cx, of| edges(cx, &[of]);
    /// The vertices of a surface: the corners of its patches.
    fn vertices(of: Surface) -> Vec<VertexOf> = |cx, of| vertices(cx, &[of]);
    /// For each patch of a surface the edges around it, in order.
    fn loops(of: Surface) -> Vec<Vec<EdgeOf>> = |cx, of| loops(cx, &[of]);
    /// The faces of a shell: the patches of its surfaces.
    fn faces(of: Arc<ShellValue>) -> Vec<PatchOf> = |cx, of| {
        let (module, _, patches) = patches(cx, &of.surfaces)?;
        Ok(patches.into_iter().map(|p| PatchOf(module, p)).collect())
    };
    /// The edges of a shell.
    fn edges(of: Arc<ShellValue>) -> Vec<EdgeOf> = |cx, of| edges(cx, &of.surfaces);
    /// The vertices of a shell.
    fn vertices(of: Arc<ShellValue>) -> Vec<VertexOf> = |cx, of| vertices(cx, &of.surfaces);
    /// For each face of a shell the edges around it, in order.
    fn loops(of: Arc<ShellValue>) -> Vec<Vec<EdgeOf>> = |cx, of| loops(cx, &of.surfaces);
    /// Whether no edge of a shell is free.
    fn closed(of: Arc<ShellValue>) -> bool = |cx, of| {
        let (module, tolerance) = (cx.module(), cx.tolerance()?);
        let scene = Scene::of(cx, module, &of.surfaces)?;
        Ok(scene.shell(&of, &tolerance, &mut Vec::new())?.closed)
    };
    /// The edges around a patch, in order.
    fn edges(of: PatchOf) -> Vec<EdgeOf> = |cx, of| {
        let model = cx.model(of.0)?;
        Ok(model.loop_of(of.1).pieces.iter().filter_map(|p| p.edge).map(|(e, _)| EdgeOf(of.0, e)).collect())
    };
    /// The corners of a patch.
    fn vertices(of: PatchOf) -> Vec<VertexOf> = |cx, of| {
        Ok(cx.model(of.0)?.vertices_of(&[of.1]).into_iter().map(|v| VertexOf(of.0, v)).collect())
    };
    /// The surface a patch lies on.
    fn surface(of: PatchOf) -> Surface = |cx, of| {
        let model = cx.model(of.0)?;
        Ok(model.surfaces[model.patches[of.1.index()].surface.index()].surface.clone())
    };
    /// Arc length of an edge.
    fn length(of: EdgeOf) -> Length = |cx, of| Ok(Length(cx.model(of.0)?.edges[of.1.index()].length));
    /// The patches on both sides of an edge.
    fn faces(of: EdgeOf) -> Vec<PatchOf> = |cx, of| {
        Ok(cx.model(of.0)?.edges[of.1.index()].users.iter().map(|(p, _)| PatchOf(of.0, *p)).collect())
    };
    /// The two ends of an edge.
    fn vertices(of: EdgeOf) -> Vec<VertexOf> = |cx, of| {
        let (a, b): (VertexId, VertexId) = cx.model(of.0)?.edges[of.1.index()].vertices;
        Ok(vec![VertexOf(of.0, a), VertexOf(of.0, b)])
    };
    /// The point halfway along an edge.
    fn mid(of: EdgeOf) -> Point = |cx, of| Ok(Point(middle(cx, of)?));
    /// The curve that an edge lies on.
    fn curve(of: EdgeOf) -> Chain = |cx, of| curve_of(cx, of);
    /// The edges that end in a vertex.
    fn edges(of: VertexOf) -> Vec<EdgeOf> = |cx, of| {
        let model = cx.model(of.0)?;
        let ends = |e: &usize| model.edges[*e].vertices.0 == of.1 || model.edges[*e].vertices.1 == of.1;
        Ok((0..model.edges.len()).filter(ends).map(|e| EdgeOf(of.0, EdgeId::at(e))).collect())
    };
    /// Where a vertex is.
    fn point(of: VertexOf) -> Value = |cx, of| Ok(Value::point(cx.model(of.0)?.vertices[of.1.index()].point));
}
