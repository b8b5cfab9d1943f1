//! Where points along a side of a mapped face lie in (u, v).

use crate::mesh::border::layout::Face;
use crate::mesh::request::input::Input;
use crate::model::Trace;
use crate::surface::{Domain, Side, Surface};

/// Side parameters (u or v of the surface, ascending) at lengths along a side of a face.
pub fn side_parameters(input: &Input, face: &Face, side: usize, lengths: &[f64]) -> Vec<f64> {
    let record = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let triangle = face.is_triangle();
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    let along_u = side == 0 || side == 2 && !triangle;
    let (low, high) = if along_u { (u0, u1) } else { (v0, v1) };
    let total = face.sides[side].length;
    let mut at: Vec<f64> = if is_on_chain(surface, side, record.u, record.v, triangle) {
        let (from, to) = (surface.side_fraction(side, low), surface.side_fraction(side, high));
        lengths.iter().map(|s| surface.side_parameter(side, from + (to - from) * (s / total))).collect()
    } else {
        let (from, to) = match (triangle, side) {
            (true, 1) => ((1.0, 0.0), (0.0, 1.0)),
            (true, 2) | (false, 3) => ((u0, v0), (u0, v1)),
            (_, 0) => ((u0, v0), (u1, v0)),
            (_, 1) => ((u1, v0), (u1, v1)),
            _ => ((u0, v1), (u1, v1)),
        };
        let trace = Trace::new(surface, from, to);
        lengths.iter().map(|s| low + (high - low) * trace.at_length(s / total * trace.length())).collect()
    };
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
