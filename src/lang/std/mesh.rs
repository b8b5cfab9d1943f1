//! What a mesh tells about itself.

use std::sync::Arc;

use crate::base::fault::ValueFault;
use crate::fields;
use crate::lang::cx::{Cx, Stop};
use crate::lang::types::{Angle, Length, Point};
use crate::lang::value::{MeshValue, Value};
use crate::mesh::Mesh;
use crate::mesh::quality::Quality;

/// Shape of the elements; a mesh without faces has none.
fn quality(cx: &mut Cx, mesh: &MeshValue) -> Result<Quality, Stop> {
    let mesh = cx.mesh(mesh)?;
    mesh.quality().ok_or_else(|| ValueFault::NoFaces { mesh: mesh.name.clone() }.into())
}

/// Elements as lists of node numbers, from 1 as in files.
fn elements<const N: usize>(elements: &[[u32; N]]) -> Vec<Value> {
    elements.iter().map(|e| Value::list(e.iter().map(|n| Value::number(f64::from(*n) + 1.0)).collect())).collect()
}

fn points(mesh: &Mesh) -> Vec<Point> {
    mesh.nodes.iter().map(|p| Point(*p)).collect()
}

fields! {
    /// The nodes of a mesh.
    fn nodes(of: Arc<MeshValue>) -> Vec<Point> = |cx, of| Ok(points(&*cx.mesh(&of)?));
    /// The triangles of a mesh: lists of three node numbers, from 1.
    fn triangles(of: Arc<MeshValue>) -> Vec<Value> = |cx, of| Ok(elements(&cx.mesh(&of)?.triangles));
    /// The quads of a mesh: lists of four node numbers, from 1.
    fn quads(of: Arc<MeshValue>) -> Vec<Value> = |cx, of| Ok(elements(&cx.mesh(&of)?.quads));
    /// The smallest corner angle of all elements.
    fn min_angle(of: Arc<MeshValue>) -> Angle = |cx, of| Ok(Angle(quality(cx, &of)?.min_angle));
    /// The largest corner angle of all elements.
    fn max_angle(of: Arc<MeshValue>) -> Angle = |cx, of| Ok(Angle(quality(cx, &of)?.max_angle));
    /// Mean quality of the elements, 1 at best.
    ///
    /// Of a triangle twice the ratio of inscribed to circumscribed radius, of a quad the least sine of its corners.
    fn quality(of: Arc<MeshValue>) -> f64 = |cx, of| Ok(quality(cx, &of)?.mean_quality);
    /// The least quality of all elements.
    fn min_quality(of: Arc<MeshValue>) -> f64 = |cx, of| Ok(quality(cx, &of)?.min_quality);
    /// Longest over shortest side of an element, the largest of all.
    fn max_aspect(of: Arc<MeshValue>) -> f64 = |cx, of| Ok(quality(cx, &of)?.max_aspect);
    /// The largest distance between the mesh and its surfaces.
    fn chord_error(of: Arc<MeshValue>) -> Length = |cx, of| {
        let tolerance = cx.tolerance()?;
        let mesh = cx.mesh(&of)?;
        mesh.chord_error(&tolerance).map(Length).ok_or_else(|| ValueFault::NoFaces { mesh: mesh.name.clone() }.into())
    };
    /// Whether a mesh is a closed skin.
    ///
    /// Each edge is then used by two faces, in opposite senses.
    fn watertight(of: Arc<MeshValue>) -> bool = |cx, of| Ok(cx.mesh(&of)?.is_watertight());
    /// Lengths of all edges, each once.
    fn edge_lengths(of: Arc<MeshValue>) -> Vec<Length> = |cx, of| Ok(cx.mesh(&of)?.edge_lengths().into_iter().map(Length).collect());
}
