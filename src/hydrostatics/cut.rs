//! Cells cut by a plane: rectangles wholly below it, and strips in which its height rises or falls along one parameter, so that each
//! row has one crossing at most. Both are proven by bounds of points and derivatives.

use glam::DVec3;

use super::face::{Cell, Face, Rect, Span};
use crate::base::job;
use crate::base::solve::bracketed_from;
use crate::base::tolerance::EPSILON;
use crate::base::work;

/// A rectangle is halved at most so often.
const MAX_DEPTH: u32 = 40;
/// A side is halved at most so often in search of its crossings.
const SIDE_DEPTH: u32 = 40;

/// The plane n·p = d; below it is where n·p < d.
#[derive(Clone, Copy, Debug)]
pub struct CuttingPlane {
    /// Unit normal.
    pub normal: DVec3,
    /// Distance from the origin along it, model units.
    pub distance: f64,
    /// Heights up to this count as none, model units.
    pub none: f64,
    /// What is nowhere farther from the plane than this lies along it, model units: rows that cross beside such a side are cut at their ends.
    pub along: f64,
}

/// A part of a cell in which the plane is crossed once a row.
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    /// The parameter along which the height changes one way: 0 or 1.
    pub along: usize,
    /// Low and high of that parameter.
    pub reach: Span,
    /// Low and high of the other one.
    pub rows: Span,
    /// Whether the height rises.
    pub rising: bool,
}

impl Strip {
    /// Parameters of a place by the one along and the row.
    pub fn place(&self, along: f64, row: f64) -> (f64, f64) {
        if self.along == 0 { (along, row) } else { (row, along) }
    }

    /// The rectangle that it lies in.
    pub fn rect(&self) -> Rect {
        Rect { sides: if self.along == 0 { [self.reach, self.rows] } else { [self.rows, self.reach] } }
    }

    /// What is below of a row that crosses at a parameter.
    pub fn below(&self, crossing: f64) -> Span {
        if self.rising { (self.reach.0, crossing) } else { (crossing, self.reach.1) }
    }
}

/// What is below a plane.
#[derive(Clone, Copy, Debug)]
pub enum Piece {
    /// All of a rectangle.
    Whole(Rect),
    /// A part of a strip.
    Strip(Strip),
    /// A rectangle that lies in the plane but for what counts as beside it.
    Beside(Rect),
}

/// A face and the plane that cuts it.
#[derive(Clone, Copy)]
pub struct Cut<'a> {
    /// The face.
    pub face: &'a Face,
    /// The plane.
    pub plane: CuttingPlane,
}

impl CuttingPlane {
    /// Least and largest height of a box over the plane.
    pub fn heights(&self, cell: &Cell) -> Span {
        let (center, half) = (cell.bounds.center(), 0.5 * (cell.bounds.max - cell.bounds.min));
        let (middle, reach) = (self.normal.dot(center) - self.distance, self.normal.abs().dot(half));
        (middle - reach, middle + reach)
    }
}

impl Cut<'_> {
    /// Height and its derivative by a parameter.
    fn level(&self, place: (f64, f64), by: usize) -> (f64, f64) {
        let jet = self.face.tangents(place.0, place.1);
        (self.plane.normal.dot(jet[0]) - self.plane.distance, self.plane.normal.dot(jet[1 + by]))
    }

    /// Ranges of the height and of its derivatives over a rectangle.
    fn ranges(&self, rect: &Rect) -> [Span; 3] {
        work::spend(8);
        let [p, du, dv] = self.face.ranges(rect).map(|range| range.along(self.plane.normal));
        [(p.low - self.plane.distance, p.high - self.plane.distance), (du.low, du.high), (dv.low, dv.high)]
    }

    /// Takes a rectangle apart.
    pub fn pieces(&self, rect: Rect, depth: u32, out: &mut Vec<Piece>) {
        job::poll();
        let [height, by_x, by_y] = self.ranges(&rect);
        if height.0 >= -self.plane.none {
            return;
        }
        if height.1 <= self.plane.none {
            out.push(Piece::Whole(rect));
            return;
        }
        // The share of a change of height that is sure, along each parameter.
        let sure = |(low, high): Span, (a, b): Span| if low > 0.0 { low * (b - a) } else { -high * (b - a) };
        let (along_x, along_y) = (sure(by_x, rect.sides[0]), sure(by_y, rect.sides[1]));
        if along_x > 0.0 || along_y > 0.0 {
            let along = usize::from(along_y > along_x);
            let rising = if along == 0 { by_x.0 > 0.0 } else { by_y.0 > 0.0 };
            self.strips(&rect, along, rising, out);
        } else if depth >= MAX_DEPTH || height.1.max(-height.0) <= self.plane.along {
            let middle = rect.middle();
            if self.level(middle, 0).0 < 0.0 {
                out.push(Piece::Beside(rect));
            }
        } else {
            // Along a pole the height changes along one parameter alone.
            let change = |(low, high): Span, (a, b): Span| high.max(-low) * (b - a);
            let along = usize::from(change(by_y, rect.sides[1]) > change(by_x, rect.sides[0]));
            rect.halves(along).into_iter().for_each(|half| self.pieces(half, depth + 1, out));
        }
    }

    /// Divides a rectangle where the plane crosses its two sides at the ends of the rows.
    fn strips(&self, rect: &Rect, along: usize, rising: bool, out: &mut Vec<Piece>) {
        let (reach, rows) = (rect.sides[along], rect.sides[1 - along]);
        let mut stops = vec![rows.0, rows.1];
        for end in [reach.0, reach.1] {
            self.side_crossings(along, end, rows, SIDE_DEPTH, &mut stops);
        }
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        for w in stops.windows(2) {
            let strip = Strip { along, reach, rows: (w[0], w[1]), rising };
            let middle = 0.5 * (w[0] + w[1]);
            let height = |end: f64| self.level(strip.place(end, middle), along).0;
            let (first, last) = (height(reach.0), height(reach.1));
            let (low, high) = if rising { (first, last) } else { (last, first) };
            if low >= 0.0 {
                continue;
            }
            out.push(if high <= 0.0 { Piece::Whole(strip.rect()) } else { Piece::Strip(strip) });
        }
    }

    /// Where the plane crosses a side on which one parameter is fixed, between two values of the other.
    fn side_crossings(&self, along: usize, fixed: f64, (a, b): Span, depth: u32, out: &mut Vec<f64>) {
        let sides = if along == 0 { [(fixed, fixed), (a, b)] } else { [(a, b), (fixed, fixed)] };
        let ranges = self.ranges(&Rect { sides });
        let (height, slope) = (ranges[0], ranges[2 - along]);
        if height.0 >= -self.plane.none || height.1 <= self.plane.none || height.1.max(-height.0) <= self.plane.along {
            return;
        }
        let place = |t: f64| if along == 0 { (fixed, t) } else { (t, fixed) };
        if slope.0 > 0.0 || slope.1 < 0.0 {
            let level = |t: f64| self.level(place(t), 1 - along);
            let (first, last) = (level(a).0, level(b).0);
            if first * last < 0.0 {
                out.push(bracketed_from((a, b), slope.0 > 0.0, 0.5 * (a + b), EPSILON * (b - a), level));
            }
            return;
        }
        let middle = 0.5 * (a + b);
        if depth == 0 {
            out.push(middle);
            return;
        }
        self.side_crossings(along, fixed, (a, middle), depth - 1, out);
        self.side_crossings(along, fixed, (middle, b), depth - 1, out);
    }

    /// Where a row of a strip crosses the plane, from a first guess.
    pub fn crossing(&self, strip: &Strip, row: f64, guess: f64) -> f64 {
        let (low, high) = strip.reach;
        let level = |t: f64| self.level(strip.place(t, row), strip.along);
        bracketed_from(strip.reach, strip.rising, guess.clamp(low, high), EPSILON * (high - low), level)
    }
}
