//! Fields of surfaces, shells, patches, edges and vertices.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::fields;
use crate::lang::eval::std::kinds::{EdgeOf, Edged, Faces, PatchOf, VertexOf};
use crate::lang::eval::std::topology::{curve_of, edges, iso_line, loops, middle, patches, picked, skin, vertices, whole};
use crate::lang::values::conversions::{Length, Point};
use crate::lang::values::value::{ShellValue, Value};
use crate::model::EdgeId;
use crate::network::Chain;
use crate::surface::{IsoLine, Surface};

fields! {
    /// The patches of a surface: its smooth pieces.
    fn patches(of: Surface) -> Vec<PatchOf> = |cx, of| {
        let (home, _, patches) = patches(cx, &[of])?;
        Ok(patches.into_iter().map(|p| PatchOf(home.clone(), p)).collect())
    };
    /// The edges of a surface, patch by patch along the border of each.
    fn edges(of: Surface) -> Vec<EdgeOf> = |cx, of| edges(cx, &[of]);
    /// The vertices of a surface: the corners of its patches.
    fn vertices(of: Surface) -> Vec<VertexOf> = |cx, of| vertices(cx, &[of]);
    /// For each patch of a surface the edges around it, in order.
    fn loops(of: Surface) -> Vec<Vec<EdgeOf>> = |cx, of| loops(cx, &[of]);
    /// The side of a surface at u 0, a curve: of a sweep its first section.
    fn start(of: Surface) -> Chain = |cx, of| iso_line(cx, &of, IsoLine::U(0.0), "start");
    /// The side at u 1: the last section.
    fn end(of: Surface) -> Chain = |cx, of| iso_line(cx, &of, IsoLine::U(1.0), "end");
    /// The side at v 0; along it u ascends.
    fn left(of: Surface) -> Chain = |cx, of| iso_line(cx, &of, IsoLine::V(0.0), "left");
    /// The side at v 1.
    fn right(of: Surface) -> Chain = |cx, of| iso_line(cx, &of, IsoLine::V(1.0), "right");
    /// The faces of a shell: the patches of its surfaces.
    fn faces(of: Arc<ShellValue>) -> Vec<PatchOf> = |cx, of| {
        let (home, _, patches) = patches(cx, &of.surfaces)?;
        Ok(patches.into_iter().map(|p| PatchOf(home.clone(), p)).collect())
    };
    /// The edges of a shell, as they are after its faces were glued.
    ///
    /// They come by the faces of the shell as listed, then along the border of each face; where a long border meets several
    /// shorter ones, each of these is an edge. `.faces` are the faces of the shell on it, one at a free edge.
    fn edges(of: Arc<ShellValue>) -> Vec<EdgeOf> = |cx, of| Ok(skin(cx, &Faces::of_shell(of))?.0);
    /// The vertices of a shell: the ends of its edges.
    fn vertices(of: Arc<ShellValue>) -> Vec<VertexOf> = |cx, of| {
        let (edges, mut seen) = (skin(cx, &Faces::of_shell(of))?.0, BTreeSet::new());
        let ends = edges.iter().flat_map(|edge| [edge.1.ends.0, edge.1.ends.1].map(|vertex| VertexOf(edge.0.clone(), vertex)));
        Ok(ends.filter(|vertex| seen.insert(vertex.1)).collect())
    };
    /// For each face of a shell the edges around it, in order.
    fn loops(of: Arc<ShellValue>) -> Vec<Vec<EdgeOf>> = |cx, of| {
        let (all, skin) = skin(cx, &Faces::of_shell(of))?;
        Ok(skin.borders.iter().map(|(_, around)| picked(&all, around)).collect())
    };
    /// The free edges of a surface, a shell or a list of them, loop by loop.
    ///
    /// A tube has two rims of one edge each, a closed shell none. The first loop begins with the first free edge (`.edges`
    /// says in which order they come), the next one with the first that is left.
    fn rims(of: Edged) -> Vec<Vec<EdgeOf>> = |cx, Edged(of)| {
        let (all, skin) = skin(cx, &of)?;
        Ok(skin.rims().iter().map(|around| picked(&all, around)).collect())
    };
    /// Whether no edge of a shell is free.
    fn closed(of: Arc<ShellValue>) -> bool = |cx, of| {
        let module = cx.module();
        Ok(cx.glued(module, &of)?.shell.closed)
    };
    /// The edges around a patch, in order.
    fn edges(of: PatchOf) -> Vec<EdgeOf> = |cx, of| {
        let model = cx.model(&of.0)?;
        Ok(model.border_of(of.1).into_iter().map(|(e, _)| whole(&of.0, &model, e)).collect())
    };
    /// The corners of a patch.
    fn vertices(of: PatchOf) -> Vec<VertexOf> = |cx, of| {
        Ok(cx.model(&of.0)?.vertices_of(&[of.1]).into_iter().map(|v| VertexOf(of.0.clone(), v)).collect())
    };
    /// The surface a patch lies on.
    fn surface(of: PatchOf) -> Surface = |cx, of| {
        let model = cx.model(&of.0)?;
        Ok(model.surfaces[model.patches[of.1.index()].surface.index()].surface.clone())
    };
    /// Arc length of an edge.
    fn length(of: EdgeOf) -> Length = |_, of| Ok(Length(of.1.length()));
    /// The patches on both sides of an edge.
    fn faces(of: EdgeOf) -> Vec<PatchOf> = |_, of| Ok(of.1.faces.iter().map(|p| PatchOf(of.0.clone(), *p)).collect());
    /// The two ends of an edge.
    fn vertices(of: EdgeOf) -> Vec<VertexOf> = |_, of| Ok([of.1.ends.0, of.1.ends.1].map(|v| VertexOf(of.0.clone(), v)).to_vec());
    /// First point of the curve of an edge.
    fn start(of: EdgeOf) -> Point = |cx, of| Ok(Point(curve_of(cx, of)?.start()));
    /// Last point of the curve of an edge.
    fn end(of: EdgeOf) -> Point = |cx, of| Ok(Point(curve_of(cx, of)?.end()));
    /// The point halfway along an edge.
    fn mid(of: EdgeOf) -> Point = |cx, of| Ok(Point(middle(cx, &of)?));
    /// The curve that an edge lies on.
    fn curve(of: EdgeOf) -> Chain = |cx, of| curve_of(cx, of);
    /// The edges that end in a vertex.
    fn edges(of: VertexOf) -> Vec<EdgeOf> = |cx, of| {
        let model = cx.model(&of.0)?;
        let ends = |e: &usize| model.edges[*e].vertices.0 == of.1 || model.edges[*e].vertices.1 == of.1;
        Ok((0..model.edges.len()).filter(ends).map(|e| whole(&of.0, &model, EdgeId::at(e))).collect())
    };
    /// Where a vertex is.
    fn point(of: VertexOf) -> Value = |cx, of| Ok(Value::point(cx.model(&of.0)?.vertices[of.1.index()].point));
}
