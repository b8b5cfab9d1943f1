//! Entities as the standard describes them: numbers and pointers, no geometry yet.
//!
//! Pointers stay pointers; who follows them bounds depth and loops. Lengths are in units of the file.

use glam::{DAffine3, DVec3};

use super::params::Reader;
use super::records::Entry;
use super::{entity_curves as curves, entity_faces as faces, entity_surfaces as surfaces};
use crate::io::cad::damage::{Damage, damage};

/// Pointer to an entity: the number of its first directory line.
pub type Pointer = u32;

/// Coefficients of conic sections: A x² + B xy + C y² + D x + E y + F = 0.
pub type Conic = [f64; 6];

/// A rational B-spline as the standard has it.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineData {
    /// Degree.
    pub degree: usize,
    /// Knots, as many as weights + degree + 1.
    pub knots: Vec<f64>,
    /// Weights of the control points.
    pub weights: Vec<f64>,
    /// Control points.
    pub points: Vec<DVec3>,
    /// First and last parameter.
    pub range: (f64, f64),
}

/// A rational B-spline surface; first index of the net fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct NetData {
    /// Degrees in u and v.
    pub degree: (usize, usize),
    /// Control points along u and v.
    pub counts: (usize, usize),
    /// Knots in u and v.
    pub knots: (Vec<f64>, Vec<f64>),
    /// Weights.
    pub weights: Vec<f64>,
    /// Control points.
    pub points: Vec<DVec3>,
    /// First and last u, first and last v.
    pub range: [f64; 4],
}

/// One curve of a boundary (141) with its curves in parameter space.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryCurve {
    /// The space curve.
    pub space: Pointer,
    /// It is run backwards.
    pub reversed: bool,
    /// Curves in (u, v).
    pub uv: Vec<Pointer>,
}

/// One edge of an edge list (504).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeData {
    /// The space curve.
    pub curve: Pointer,
    /// List and index (from 1) of the first vertex.
    pub start: (Pointer, usize),
    /// List and index (from 1) of the last vertex.
    pub end: (Pointer, usize),
}

/// One use of an edge in a loop (508).
#[derive(Clone, Debug, PartialEq)]
pub struct LoopEdge {
    /// A vertex stands in the place of an edge: a pole.
    pub is_vertex: bool,
    /// List of edges (or vertices) and the index in it, from 1.
    pub edge: (Pointer, usize),
    /// The edge is run backwards.
    pub reversed: bool,
    /// Curves in (u, v).
    pub uv: Vec<Pointer>,
}

/// One entity.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Data {
    /// 100: centre, first and last point in the plane z.
    Arc { z: f64, center: [f64; 2], start: [f64; 2], end: [f64; 2] },
    /// 102: curves in a row.
    Composite(Vec<Pointer>),
    /// 104: coefficients, first and last point in the plane z.
    ConicArc { conic: Conic, z: f64, start: [f64; 2], end: [f64; 2] },
    /// 106: points, or a polyline.
    Points { points: Vec<DVec3>, is_line: bool },
    /// 108: A x + B y + C z = D, and its border.
    Plane { coefficients: [f64; 4], border: Pointer },
    /// 110: a segment; 1: without end, 2: without start or end.
    Line { start: DVec3, end: DVec3, unbounded: bool },
    /// 112: parameters of the joints; per piece the coefficients of x, y, z by ascending power.
    Polynomials { breaks: Vec<f64>, pieces: Vec<[[f64; 4]; 3]> },
    /// 114: parameters of the joints; per patch (v fastest) 16 coefficients of x, y, z, powers of u fastest.
    Patches { u: Vec<f64>, v: Vec<f64>, patches: Vec<f64>, dummies: bool },
    /// 116.
    Point(DVec3),
    /// 118.
    Ruled { rails: [Pointer; 2], crossed: bool, by_length: bool },
    /// 120: angles in radians.
    Revolution { axis: Pointer, profile: Pointer, start: f64, end: f64 },
    /// 122: where the start of the profile ends up.
    Tabulated { profile: Pointer, end: DVec3 },
    /// 123.
    Direction(DVec3),
    /// 124.
    Matrix(DAffine3),
    /// 126.
    Spline(SplineData),
    /// 128.
    Net(NetData),
    /// 130: constant distance along normal × tangent.
    OffsetCurve { base: Pointer, distance: f64, normal: DVec3, range: (f64, f64) },
    /// 140.
    OffsetSurface { indicator: DVec3, distance: f64, base: Pointer },
    /// 141.
    Boundary { surface: Pointer, curves: Vec<BoundaryCurve> },
    /// 142: curve in (u, v) and in space.
    CurveOnSurface { surface: Pointer, uv: Pointer, space: Pointer },
    /// 143.
    Bounded { surface: Pointer, borders: Vec<Pointer> },
    /// 144: no outer curve: the surface's own border.
    Trimmed { surface: Pointer, outer: Option<Pointer>, inner: Vec<Pointer> },
    /// 186.
    Solid { shells: Vec<Pointer> },
    /// 190: point, normal, reference direction.
    PlaneSurface { at: Pointer, normal: Pointer, reference: Pointer },
    /// 192, 194 (half angle in degrees), 196, 198: point, axis, radii.
    Round { kind: u32, at: Pointer, axis: Pointer, sizes: [f64; 2], reference: Pointer },
    /// 314: parts of red, green and blue in percent, and a name.
    Color { rgb: [f64; 3], name: String },
    /// 402.
    Group(Vec<Pointer>),
    /// 406 form 1: numbers of levels.
    Levels(Vec<i32>),
    /// 406 form 3: the name of the level that it is on.
    LevelName(String),
    /// 406 form 15.
    Name(String),
    /// 502.
    Vertices(Vec<DVec3>),
    /// 504.
    Edges(Vec<EdgeData>),
    /// 508.
    Loop(Vec<LoopEdge>),
    /// 510.
    Face { surface: Pointer, has_outer: bool, loops: Vec<Pointer> },
    /// 514: faces with their orientation.
    Shell(Vec<(Pointer, bool)>),
    /// What says nothing about geometry.
    Silent,
    /// An entity type that is not read.
    Unknown,
    /// Its parameters make no sense.
    Damaged,
    /// It is just being made into something: who meets it again has gone round in a circle.
    Busy,
}

/// An entity with the groups and properties that point at it or belong to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// What it is.
    pub data: Data,
    /// Its properties: names among them.
    pub properties: Vec<Pointer>,
}

/// Reads the parameters of an entity; the reader stands behind the entity type.
pub fn decode(entry: &Entry, reader: &mut Reader) -> Result<Decoded, Damage> {
    let form = entry.form;
    let data = match entry.kind {
        100 => curves::arc(reader)?,
        102 => {
            let n = reader.count("count of curves")?;
            Data::Composite(reader.pointers(n, "curves")?)
        }
        104 => curves::conic(reader)?,
        106 => curves::points(form, reader)?,
        108 => surfaces::plane(reader)?,
        110 => Data::Line { start: reader.point("start")?, end: reader.point("end")?, unbounded: form != 0 },
        112 => curves::polynomials(reader)?,
        114 => surfaces::patches(reader)?,
        116 => {
            let point = reader.point("point")?;
            // A symbol to show it by.
            reader.real_or(0.0);
            Data::Point(point)
        }
        118 => surfaces::ruled(form, reader)?,
        120 => surfaces::revolution(reader)?,
        122 => Data::Tabulated { profile: reader.pointer("profile")?, end: reader.point("end")? },
        123 => Data::Direction(reader.point("direction")?),
        124 => Data::Matrix(matrix(reader)?),
        126 => curves::spline(reader)?,
        128 => surfaces::net(reader)?,
        130 => curves::offset(reader)?,
        140 => surfaces::offset(reader)?,
        141 => faces::boundary(reader)?,
        142 => faces::curve_on_surface(reader)?,
        143 => faces::bounded(reader)?,
        144 => faces::trimmed(reader)?,
        186 => faces::solid(reader)?,
        190 => surfaces::plane_surface(form, reader)?,
        192 | 194 | 196 | 198 => surfaces::round(entry.kind, form, reader)?,
        314 => {
            let rgb = [reader.real("red")?, reader.real("green")?, reader.real("blue")?];
            Data::Color { rgb, name: reader.text() }
        }
        402 if matches!(form, 1 | 7 | 14 | 15) => {
            let n = reader.count("count of members")?;
            Data::Group(reader.pointers(n, "members")?)
        }
        // Geometry without its levels is geometry all the same.
        406 if form == 1 => levels(reader).map_or(Data::Silent, Data::Levels),
        406 if form == 3 => {
            let (_count, _function) = (reader.real_or(0.0), reader.real_or(0.0));
            Data::LevelName(reader.text())
        }
        406 if form == 15 => {
            reader.count("count of values")?;
            Data::Name(reader.text())
        }
        502 => faces::vertices(reader)?,
        504 => faces::edges(reader)?,
        508 => faces::loop_of(reader)?,
        510 => faces::face(reader)?,
        514 => faces::shell(reader)?,
        // Structure of drawings and tables of properties.
        0 | 132 | 134 | 136 | 138 | 302 | 304 | 310 | 312 | 316 | 402 | 404 | 406 | 410 => Data::Silent,
        _ => Data::Unknown,
    };
    let (_, properties) = if matches!(data, Data::Silent | Data::Unknown) { Default::default() } else { reader.attached() };
    Ok(Decoded { data, properties })
}

fn levels(reader: &mut Reader) -> Result<Vec<i32>, Damage> {
    let n = reader.count("count of levels")?;
    reader.needs(n, 1, "levels")?;
    (0..n).map(|_| Ok(reader.int("level")? as i32)).collect()
}

/// Rows of a rotation, each followed by its part of the translation.
fn matrix(reader: &mut Reader) -> Result<DAffine3, Damage> {
    let m = reader.reals(12, "matrix elements")?;
    let row = |k: usize| DVec3::new(m[4 * k], m[4 * k + 1], m[4 * k + 2]);
    let rows = glam::DMat3::from_cols(row(0), row(1), row(2));
    if rows.determinant().abs() <= f64::MIN_POSITIVE {
        return Err(damage("the matrix flattens space"));
    }
    Ok(DAffine3::from_mat3_translation(rows.transpose(), DVec3::new(m[3], m[7], m[11])))
}
