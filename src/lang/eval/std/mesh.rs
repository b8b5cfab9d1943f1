//! What a mesh tells about itself.

use std::sync::Arc;

use crate::base::fault::ValueFault;
use crate::base::job;
use crate::geometry::construct::build;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::conversions::{Angle, Length, Point};
use crate::lang::values::value::{MeshValue, Plane, Value};
use crate::mesh::Mesh;
use crate::mesh::data::quality::Quality;
use crate::mesh::data::section::section;
use crate::network::Chain;
use crate::{builtins, fields};

/// Shape of the elements; a mesh without faces has none.
fn quality(cx: &mut Cx, mesh: &MeshValue) -> Result<Quality, Halt> {
    let mesh = cx.mesh(mesh)?;
    mesh.quality().ok_or_else(|| ValueFault::NoFaces { mesh: mesh.name.clone() }.into())
}

/// Elements as lists of node numbers, from 1 as in files.
fn elements<const N: usize>(elements: &[[u32; N]]) -> Vec<Value> {
    job::looking(elements).map(|e| Value::list(e.iter().map(|n| Value::number(f64::from(*n) + 1.0)).collect())).collect()
}

fn points(mesh: &Mesh) -> Vec<Point> {
    job::looking(&mesh.nodes).map(|p| Point(*p)).collect()
}

builtins! {
    /// Plane section of a mesh: the polylines in which its faces meet a plane.
    ///
    /// They are closed, or open where they run into a free edge of the mesh, and joined by its edges, so they have no gaps. What
    /// lies in the plane counts as above it. Around material they run counter-clockwise seen against the normal.
    /// ```loft
    /// surface tube = extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 3m))
    /// mesh skin of tube { size: 300mm }
    /// let rings = [for k in 1..3: section(skin, plane(at: (0, 0, k * 1m), normal: (0, 0, 1)))[0]]
    /// check rings[0].closed and rings[1].closed
    /// ```
    fn section(
        /// The mesh.
        of: Arc<MeshValue>,
        /// The plane: `plane(at:, normal:)`.
        by: Arc<Plane>,
    ) -> Vec<Chain> = |cx, of, by| sections(cx, &of, &by);
}

/// The sections of a mesh as curves.
pub(crate) fn sections(cx: &mut Cx, of: &MeshValue, by: &Plane) -> Result<Vec<Chain>, Halt> {
    let tolerance = cx.tolerance()?;
    let mesh = cx.mesh(of)?;
    let rows = section(&mesh, by.at, by.normal, tolerance.rounding, tolerance.point);
    cx.room(rows.iter().map(|row| row.points.len()).sum())?;
    let origin = cx.origin();
    rows.iter().map(|row| Ok(Chain::of_curve(&build::polyline(&row.points, row.closed, origin)?))).collect()
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
    ///
    /// Free borders count with their distance from the curves that they follow. A limit that is asked of the mesh is proved; the
    /// reported value is measured where each triangle is likely farthest off, and may be about one per cent too low. Quads
    /// count as the two triangles that STL files have for them, along the diagonal from their first corner.
    fn chord_error(of: Arc<MeshValue>) -> Length = |cx, of| {
        let tolerance = cx.tolerance()?;
        let mesh = cx.mesh(&of)?;
        mesh.chord_error(&tolerance).map(Length).ok_or_else(|| ValueFault::NoFaces { mesh: mesh.name.clone() }.into())
    };
    /// Whether a mesh is closed.
    ///
    /// Each edge is then used by two faces, in opposite senses.
    fn watertight(of: Arc<MeshValue>) -> bool = |cx, of| Ok(cx.mesh(&of)?.is_watertight());
    /// Number of parts of a mesh that share no node with each other.
    fn parts(of: Arc<MeshValue>) -> usize = |cx, of| Ok(cx.mesh(&of)?.parts());
    /// Lengths of all edges, each once.
    fn edge_lengths(of: Arc<MeshValue>) -> Vec<Length> = |cx, of| Ok(cx.mesh(&of)?.edge_lengths().into_iter().map(Length).collect());
}
