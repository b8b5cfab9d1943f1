//! Entities as the standard describes them: numbers and pointers, no geometry yet.
//!
//! Pointers stay pointers; who follows them bounds depth and loops. Lengths are in units of the file.

use glam::{DAffine3, DVec3};

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
    /// 184: solids with their matrices.
    SolidAssembly(Vec<(Pointer, Pointer)>),
    /// 308.
    Definition { name: String, members: Vec<Pointer> },
    /// 408.
    Instance { of: Pointer, at: DVec3, scale: f64 },
    /// 430.
    SolidInstance(Pointer),
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
