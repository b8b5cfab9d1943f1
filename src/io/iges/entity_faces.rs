//! Parameters of trimmed surfaces and of solids given by their borders.

use crate::io::cad::defect::Defect;
use crate::io::iges::entity_data::{BoundaryCurve, Data, EdgeData, LoopEdge};
use crate::io::iges::params::ParameterReader;

/// 141.
pub fn boundary(r: &mut ParameterReader) -> Result<Data, Defect> {
    r.int("kind of boundary")?;
    r.int("preference")?;
    let surface = r.pointer("surface")?;
    let n = r.count("count of curves")?;
    r.needs(n, 3, "curves")?;
    let mut curve = || {
        let space = r.pointer("curve")?;
        let reversed = r.int("sense")? == 2;
        let k = r.count("count of curves in (u, v)")?;
        Ok(BoundaryCurve { space, reversed, uv: r.pointers(k, "curves in (u, v)")? })
    };
    let curves = (0..n).map(|_| curve()).collect::<Result<_, Defect>>()?;
    Ok(Data::Boundary { surface, curves })
}

/// 142.
pub fn curve_on_surface(r: &mut ParameterReader) -> Result<Data, Defect> {
    r.int("way of making")?;
    let (surface, uv, space) = (r.pointer("surface")?, r.pointer("curve in (u, v)")?, r.pointer("curve in space")?);
    if r.left() > 0 {
        r.int("preference")?;
    }
    Ok(Data::CurveOnSurface { surface, uv, space })
}

/// 143.
pub fn bounded(r: &mut ParameterReader) -> Result<Data, Defect> {
    r.int("kind of boundaries")?;
    let surface = r.pointer("surface")?;
    let n = r.count("count of boundaries")?;
    Ok(Data::Bounded { surface, borders: r.pointers(n, "boundaries")? })
}

/// 144.
pub fn trimmed(r: &mut ParameterReader) -> Result<Data, Defect> {
    let surface = r.pointer("surface")?;
    let given = r.int("kind of outer border")? != 0;
    let n = r.count("count of inner borders")?;
    let outer = r.pointer("outer border")?;
    let inner = r.pointers(n, "inner borders")?;
    Ok(Data::Trimmed { surface, outer: (given && outer != 0).then_some(outer), inner })
}

/// 186: the outer shell, then the voids, each with its sense.
pub fn solid(r: &mut ParameterReader) -> Result<Data, Defect> {
    let mut shells = vec![r.pointer("shell")?];
    r.int("orientation")?;
    let n = if r.left() > 0 { r.count("count of voids")? } else { 0 };
    r.needs(n, 2, "voids")?;
    for _ in 0..n {
        shells.push(r.pointer("void")?);
        r.int("orientation")?;
    }
    Ok(Data::Solid { shells })
}

/// 184: the solids, then a matrix for each.
pub fn assembly(r: &mut ParameterReader) -> Result<Data, Defect> {
    let n = r.count("count of solids")?;
    r.needs(n, 2, "solids with matrices")?;
    let items = r.pointers(n, "solids")?;
    Ok(Data::SolidAssembly(items.into_iter().zip(r.pointers(n, "matrices")?).collect()))
}

/// 308.
pub fn definition(r: &mut ParameterReader) -> Result<Data, Defect> {
    r.int("depth")?;
    let name = r.text();
    let n = r.count("count of members")?;
    Ok(Data::Definition { name, members: r.pointers(n, "members")? })
}

/// 502.
pub fn vertices(r: &mut ParameterReader) -> Result<Data, Defect> {
    let n = r.count("count of vertices")?;
    Ok(Data::Vertices(r.points(n, "vertices")?))
}

/// 504.
pub fn edges(r: &mut ParameterReader) -> Result<Data, Defect> {
    let n = r.count("count of edges")?;
    r.needs(n, 5, "edges")?;
    let mut edge = || {
        Ok(EdgeData {
            curve: r.pointer("curve")?,
            start: (r.pointer("vertex list")?, r.count("vertex")?),
            end: (r.pointer("vertex list")?, r.count("vertex")?),
        })
    };
    Ok(Data::Edges((0..n).map(|_| edge()).collect::<Result<_, Defect>>()?))
}

/// 508.
pub fn loop_of(r: &mut ParameterReader) -> Result<Data, Defect> {
    let n = r.count("count of edges")?;
    r.needs(n, 5, "edges")?;
    let mut edge = || {
        let is_vertex = r.int("kind of edge")? == 1;
        let edge = (r.pointer("edge list")?, r.count("edge")?);
        let reversed = r.int("orientation")? == 0;
        let k = r.count("count of curves in (u, v)")?;
        r.needs(k, 2, "curves in (u, v)")?;
        let mut uv = || {
            r.int("isoparametric")?;
            r.pointer("curve in (u, v)")
        };
        let uv = (0..k).map(|_| uv()).collect::<Result<_, Defect>>()?;
        Ok(LoopEdge { is_vertex, edge, reversed, uv })
    };
    Ok(Data::Loop((0..n).map(|_| edge()).collect::<Result<_, Defect>>()?))
}

/// 510.
pub fn face(r: &mut ParameterReader) -> Result<Data, Defect> {
    let surface = r.pointer("surface")?;
    let n = r.count("count of loops")?;
    let has_outer = r.int("outer loop")? != 0;
    Ok(Data::Face { surface, has_outer, loops: r.pointers(n, "loops")? })
}

/// 514.
pub fn shell(r: &mut ParameterReader) -> Result<Data, Defect> {
    let n = r.count("count of faces")?;
    r.needs(n, 2, "faces")?;
    let mut face = || Ok((r.pointer("face")?, r.int("orientation")? != 0));
    Ok(Data::Shell((0..n).map(|_| face()).collect::<Result<_, Defect>>()?))
}
