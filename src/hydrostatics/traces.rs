//! Curves in which a plane crosses the faces of a body.

use glam::{DVec2, DVec3};

use super::cut::{Cut, CuttingPlane, Piece, Strip};
use super::face::{Face, Span, Way};
use super::flat;
use crate::base::job;
use crate::model::measure::{Below, border_crossings as border_crossings_of};
use crate::surface::Nearest;

/// A curve of a face: a strip and the rows between which it lies in the face.
#[derive(Clone, Copy)]
pub struct Trace<'a> {
    /// The face with the plane.
    pub cut: Cut<'a>,
    /// The strip.
    pub strip: Strip,
    /// First and last row.
    pub rows: Span,
}

impl Trace<'_> {
    /// Parameters of the point of a row, near a guess of the parameter along.
    pub fn place(&self, row: f64, guess: f64) -> (f64, f64) {
        self.strip.place(self.cut.crossing(&self.strip, row, guess), row)
    }

    /// The point of a row.
    pub fn point(&self, row: f64) -> DVec3 {
        let (x, y) = self.place(row, 0.5 * (self.strip.reach.0 + self.strip.reach.1));
        self.cut.face.tangents(x, y)[0]
    }
}

/// The curves in which a plane crosses a face that is not flat.
pub fn traces<'a>(face: &'a Face, plane: CuttingPlane) -> Vec<Trace<'a>> {
    let cut = Cut { face, plane };
    let mut found = Vec::new();
    let surface = face.prepared.surface();
    let trimmed = face.way == Way::Rows;
    let below = Below { normal: plane.normal, distance: plane.distance };
    let crossings = if trimmed { border_crossings_of(surface, below) } else { Vec::new() };
    // Round a surface that closes, loops need not be polygons of its parameters: there the distance from the face tells.
    let nearest = (trimmed && surface.untrimmed().closed() != (false, false)).then(|| Nearest::new(surface));
    let inside = |u: f64, v: f64| match &nearest {
        Some(nearest) => nearest.at(surface.point(u, v)).distance <= plane.along,
        None => surface.holds(u, v),
    };
    for cell in &face.cells {
        let (low, high) = plane.heights(cell);
        if low >= -plane.none || high <= plane.none {
            continue;
        }
        let mut pieces = Vec::new();
        cut.pieces(cell.rect, 0, &mut pieces);
        for piece in pieces {
            job::poll();
            let Piece::Strip(strip) = piece else { continue };
            let whole = Trace { cut, strip, rows: strip.rows };
            if trimmed { kept(whole, &crossings, &inside, &mut found) } else { found.push(whole) }
        }
    }
    found
}

/// The parts of a curve inside a trimmed face, whose borders cross the plane at some places in (u, v).
fn kept<'a>(whole: Trace<'a>, crossings: &[DVec2], inside: &impl Fn(f64, f64) -> bool, out: &mut Vec<Trace<'a>>) {
    let (first, last) = whole.rows;
    // Round a surface that closes places may be whole turns away.
    let row = |at: &DVec2| if whole.strip.along == 0 { at.y } else { at.x };
    let turned = crossings.iter().map(row).flat_map(|row| [row, row - row.floor()]);
    let mut stops: Vec<f64> = turned.filter(|row| *row > first && *row < last).chain([first, last]).collect();
    stops.sort_by(f64::total_cmp);
    stops.dedup();
    for w in stops.windows(2) {
        let (u, v) = whole.place(0.5 * (w[0] + w[1]), 0.5 * (whole.strip.reach.0 + whole.strip.reach.1));
        if inside(u, v) {
            out.push(Trace { rows: (w[0], w[1]), ..whole });
        }
    }
}

/// Points of a flat face at which its border crosses a plane.
pub fn border_crossings(face: &Face, plane: CuttingPlane) -> Vec<DVec3> {
    flat::crossings(face, Below { normal: plane.normal, distance: plane.distance })
}

/// The difference of an antiderivative over the stretches in which a plane meets a flat face, whichever way its border is walked: a border
/// that only touches the plane adds nothing.
pub fn chord_sum(face: &Face, plane: CuttingPlane, antiderivative: &impl Fn(DVec3) -> f64) -> f64 {
    flat::chord_sum(face, Below { normal: plane.normal, distance: plane.distance }, antiderivative)
}
