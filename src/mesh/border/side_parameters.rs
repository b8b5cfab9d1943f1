//! Where points along a side of a mapped face lie in (u, v).

use crate::mesh::border::layout::Face;
use crate::mesh::request::input::Input;
use crate::model::Trace;
use crate::surface::{Domain, Side, Surface};

/// A side of a mapped face under its arc length: shares 0…1 of the length, and values of u or v.
pub struct SideMap<'a> {
    surface: &'a Surface,
    side: usize,
    /// Range of the side's parameter.
    range: (f64, f64),
    line: SideLine,
}

/// What a side runs along.
enum SideLine {
    /// The part of a chain between two fractions of it.
    Chain(f64, f64),
    /// A line in (u, v).
    Trace(Trace),
}

impl<'a> SideMap<'a> {
    /// Of one side of a face.
    pub fn new(input: &'a Input, face: &Face, side: usize) -> Self {
        let record = &input.model.patches[face.patch.index()];
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let triangle = face.is_triangle();
        let ((u0, u1), (v0, v1)) = (record.u, record.v);
        let along_u = side == 0 || side == 2 && !triangle;
        let range = if along_u { record.u } else { record.v };
        let line = if is_on_chain(surface, side, record.u, record.v, triangle) {
            SideLine::Chain(surface.side_fraction(side, range.0), surface.side_fraction(side, range.1))
        } else {
            let (from, to) = match (triangle, side) {
                (true, 1) => ((1.0, 0.0), (0.0, 1.0)),
                (true, 2) | (false, 3) => ((u0, v0), (u0, v1)),
                (_, 0) => ((u0, v0), (u1, v0)),
                (_, 1) => ((u1, v0), (u1, v1)),
                _ => ((u0, v1), (u1, v1)),
            };
            SideLine::Trace(Trace::new(surface, from, to))
        };
        Self { surface, side, range, line }
    }

    /// The parameter at a share of the length.
    pub fn parameter(&self, share: f64) -> f64 {
        match &self.line {
            SideLine::Chain(from, to) => self.surface.side_parameter(self.side, from + (to - from) * share),
            SideLine::Trace(trace) => self.range.0 + (self.range.1 - self.range.0) * trace.at_length(share * trace.length()),
        }
    }

    /// The share of the length at a parameter.
    pub fn share(&self, parameter: f64) -> f64 {
        match &self.line {
            SideLine::Chain(from, to) => (self.surface.side_fraction(self.side, parameter) - from) / (to - from),
            SideLine::Trace(trace) => trace.length_at((parameter - self.range.0) / (self.range.1 - self.range.0)) / trace.length(),
        }
    }
}

/// Side parameters (u or v of the surface, ascending) at lengths along a side of a face.
pub fn side_parameters(input: &Input, face: &Face, side: usize, lengths: &[f64]) -> Vec<f64> {
    let map = SideMap::new(input, face, side);
    let (low, high) = map.range;
    let total = face.sides[side].length;
    let mut at: Vec<f64> = lengths.iter().map(|s| map.parameter(s / total)).collect();
    if let (Some(first), Some(s)) = (at.first_mut(), lengths.first())
        && *s == 0.0
    {
        *first = low;
    }
    if let (Some(last), Some(s)) = (at.last_mut(), lengths.last())
        && *s == total
    {
        *last = high;
    }
    at
}

/// Whether a side of a patch lies on a border of the surface that a chain carries.
fn is_on_chain(surface: &Surface, side: usize, u: (f64, f64), v: (f64, f64), triangle: bool) -> bool {
    let on_border = triangle && surface.domain() == Domain::Triangle
        || match side {
            0 => v.0 == 0.0,
            1 => u.1 == 1.0,
            2 => v.1 == 1.0,
            _ => u.0 == 0.0,
        };
    on_border && matches!(surface.side(side), Side::Chain { .. })
}
