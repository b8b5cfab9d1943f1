//! A height over a plane, piecewise cubic over triangles: found, evaluated and bounded.
//!
//! Beyond the border the height goes on straight, in the direction of its gradient at the nearest place of the border: what
//! looks for feet may step over it.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::range::Interval;
use crate::base::tolerance::{BESIDE_TRIANGLE, EPSILON, NUDGE};
use crate::geometry::Motion;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::shapes::cubic_triangle::{Height, Heights, TrianglePiece};
use crate::surface::shapes::frame::Frame;

/// Cells of the table in each direction at most.
const MOST_CELLS: usize = 1 << 9;

/// A side of the border, counter-clockwise: the first two corners of a piece.
#[derive(Clone, Copy, Debug)]
struct TriangleRim {
    piece: usize,
    /// Its ends in model units.
    ends: [DVec2; 2],
    /// The unit vector from the first to the second one.
    along: DVec2,
    /// How far they are apart.
    length: f64,
}

impl TriangleRim {
    /// How far along it a place in model units is nearest.
    fn foot(&self, at: DVec2) -> f64 {
        (at - self.ends[0]).dot(self.along).clamp(0.0, self.length)
    }

    fn distance(&self, at: DVec2) -> f64 {
        at.distance(self.ends[0] + self.along * self.foot(at))
    }
}

/// Bézier ordinates of a part of a curve, by the blossom [Ramshaw 1989].
fn restricted<const N: usize>(ordinates: [f64; N], from: f64, to: f64) -> [f64; N] {
    std::array::from_fn(|k| {
        let mut row = ordinates;
        for (step, left) in (1..N).rev().enumerate() {
            let x = if step < k { to } else { from };
            (0..left).for_each(|i| row[i] += (row[i + 1] - row[i]) * x);
        }
        row[0]
    })
}

fn hull<const N: usize>(values: [f64; N]) -> Interval {
    values.into_iter().map(Interval::at).fold(Interval::at(values[0]), Interval::union)
}

/// The surface: a frame and a height along a vector.
#[derive(Clone, Debug)]
pub struct Field {
    frame: Frame,
    normal: DVec3,
    /// Lengths of the box in u and v in the units in which heights were made.
    size: DVec2,
    pieces: Arc<Vec<TrianglePiece>>,
    rims: Arc<Vec<TriangleRim>>,
    table: Arc<Table>,
    /// Heights over the square.
    reach: Interval,
}

crate::content!(Field { frame, normal, pieces } but { size, rims, table, reach });

/// Which pieces meet a cell of the square.
#[derive(Clone, Debug)]
struct Table {
    cells: usize,
    first: Vec<usize>,
    pieces: Vec<usize>,
}

impl Table {
    fn new(pieces: &[TrianglePiece]) -> Self {
        let cells = ((pieces.len() as f64).sqrt().ceil() as usize).clamp(1, MOST_CELLS);
        let mut lists: Vec<Vec<usize>> = vec![Vec::new(); cells * cells];
        for (k, piece) in pieces.iter().enumerate() {
            let (low, high) = piece.bounds();
            let ((i0, i1), (j0, j1)) = (span(cells, low.x, high.x), span(cells, low.y, high.y));
            for (i, j) in (j0..=j1).flat_map(|j| (i0..=i1).map(move |i| (i, j))) {
                let (x, y) = (i as f64 / cells as f64, j as f64 / cells as f64);
                let step = 1.0 / cells as f64 + EPSILON;
                if piece.meets(DVec2::new(x - EPSILON, y - EPSILON), DVec2::new(x + step, y + step)) {
                    lists[j * cells + i].push(k);
                }
            }
        }
        let mut first = vec![0];
        first.extend(lists.iter().scan(0, |sum, list| {
            *sum += list.len();
            Some(*sum)
        }));
        Self { cells, first, pieces: lists.concat() }
    }

    fn list(&self, i: usize, j: usize) -> &[usize] {
        let k = j * self.cells + i;
        &self.pieces[self.first[k]..self.first[k + 1]]
    }
}

/// The first and the last cell that an interval meets.
fn span(cells: usize, low: f64, high: f64) -> (usize, usize) {
    let cell = |x: f64| ((x * cells as f64).floor().max(0.0) as usize).min(cells - 1);
    (cell(low - EPSILON), cell(high + EPSILON))
}

impl Field {
    /// A field over a frame whose vectors span the box of the pieces; `rim` are the pieces whose first two corners are a side of
    /// the border, counter-clockwise.
    pub fn new(frame: Frame, normal: DVec3, pieces: Vec<TrianglePiece>, rim: &[usize]) -> Self {
        let size = DVec2::new(frame.eu.length(), frame.ev.length());
        let side = |k: &usize| {
            let ends = [0, 1].map(|c| pieces[*k].corners[c] * size);
            let way = ends[1] - ends[0];
            TriangleRim { piece: *k, ends, along: way / way.length(), length: way.length() }
        };
        let rims = Arc::new(rim.iter().map(side).collect());
        let table = Arc::new(Table::new(&pieces));
        let mut made = Self { frame, normal, size, pieces: Arc::new(pieces), rims, table, reach: Interval::default() };
        made.reach = made.heights((0.0, 1.0), (0.0, 1.0)).h;
        made
    }

    /// The pieces.
    pub fn pieces(&self) -> &[TrianglePiece] {
        &self.pieces
    }

    /// The point over a place at a height.
    pub fn lifted(&self, uv: DVec2, h: f64) -> DVec3 {
        self.frame.origin + self.frame.eu * uv.x + self.frame.ev * uv.y + self.normal * h
    }

    /// Point and derivatives.
    pub fn jet(&self, u: f64, v: f64) -> Jet2 {
        let height = self.height(DVec2::new(u, v));
        let [uu, uv, vv] = height.d2;
        Jet2 {
            p: self.lifted(DVec2::new(u, v), height.h),
            du: self.frame.eu + self.normal * height.d1.x,
            dv: self.frame.ev + self.normal * height.d1.y,
            duu: self.normal * uu,
            duv: self.normal * uv,
            dvv: self.normal * vv,
        }
    }

    /// The piece that holds a place, or the nearest of those beside it, with the least of its weights there.
    fn piece_at(&self, p: DVec2) -> Option<(usize, f64)> {
        let ((i, _), (j, _)) = (span(self.table.cells, p.x, p.x), span(self.table.cells, p.y, p.y));
        let mut best: Option<(usize, f64)> = None;
        for k in self.table.list(i, j) {
            let least = self.pieces[*k].weights(p).into_iter().fold(f64::INFINITY, f64::min);
            if least >= 0.0 {
                return Some((*k, least));
            }
            if best.is_none_or(|b| least > b.1) {
                best = Some((*k, least));
            }
        }
        best
    }

    fn height(&self, p: DVec2) -> Height {
        match self.piece_at(p) {
            Some((k, least)) if least >= -BESIDE_TRIANGLE => self.pieces[k].height(p),
            _ => self.beyond(p),
        }
    }

    /// The height outside the border.
    fn beyond(&self, p: DVec2) -> Height {
        let at = p * self.size;
        let near = |rim: &TriangleRim| {
            let s = rim.foot(at);
            (at.distance_squared(rim.ends[0] + rim.along * s), s)
        };
        let mut best: Option<(f64, f64, &TriangleRim)> = None;
        for rim in self.rims.iter() {
            let (off, s) = near(rim);
            if best.is_none_or(|b| off < b.0) {
                best = Some((off, s, rim));
            }
        }
        let Some((_, s, rim)) = best else { return Height::default() };
        let foot = rim.ends[0] + rim.along * s;
        let own = self.pieces[rim.piece].height(foot / self.size);
        let (slope, [xx, xy, yy]) = (own.d1 / self.size, self.bends(own.d2));
        let arm = at - foot;
        let (mut d1, mut d2) = (slope, [0.0; 3]);
        if s > 0.0 && s < rim.length {
            let (t, n) = (rim.along, -rim.along.perp());
            let bend = DVec2::new(xx * t.x + xy * t.y, xy * t.x + yy * t.y);
            let (along, across) = (bend.dot(t), bend.dot(n));
            d1 += t * (across * arm.dot(n));
            let both = |a: usize, b: usize| along * t[a] * t[b] + across * (t[a] * n[b] + t[b] * n[a]);
            d2 = [both(0, 0), both(0, 1), both(1, 1)];
        }
        let (w, h) = (self.size.x, self.size.y);
        Height { h: own.h + slope.dot(arm), d1: d1 * self.size, d2: [d2[0] * w * w, d2[1] * w * h, d2[2] * h * h] }
    }

    /// Second derivatives in model units from those in (u, v).
    fn bends(&self, [uu, uv, vv]: [f64; 3]) -> [f64; 3] {
        let (w, h) = (self.size.x, self.size.y);
        [uu / (w * w), uv / (w * h), vv / (h * h)]
    }

    /// How far heights are beyond two at most, and where; `None` where none is. Looked at are places of the pieces whose bounds are.
    pub fn beyond_heights(&self, low: f64, high: f64) -> Option<(f64, DVec3)> {
        /// Steps along the sides of a piece.
        const STEPS: usize = 8;
        let mut most: Option<(f64, DVec3)> = None;
        for piece in self.pieces.iter().filter(|piece| piece.ordinates.iter().any(|h| *h < low || *h > high)) {
            let [a, b, c] = piece.corners;
            for (i, j) in (0..=STEPS).flat_map(|i| (0..=STEPS - i).map(move |j| (i, j))) {
                let uv = a + (b - a) * (i as f64 / STEPS as f64) + (c - a) * (j as f64 / STEPS as f64);
                let h = piece.height(uv).h;
                let off = (h - high).max(low - h);
                if off > most.map_or(0.0, |known| known.0) {
                    most = Some((off, self.lifted(uv, h)));
                }
            }
        }
        most
    }

    /// Bounds over a rectangle.
    pub fn enclosure(&self, u: (f64, f64), v: (f64, f64)) -> Enclosure {
        let middle = DVec2::new(0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
        let found = self.heights(u, v);
        let up = |range: Interval| range * self.normal;
        let level = |low: f64, high: f64, vector: DVec3| Interval { low, high } * vector;
        Enclosure {
            mid: self.jet(middle.x, middle.y),
            half: (0.5 * (u.1 - u.0), 0.5 * (v.1 - v.0)),
            p: up(found.h) + level(u.0, u.1, self.frame.eu) + level(v.0, v.1, self.frame.ev) + self.frame.origin,
            du: up(found.d1[0]) + self.frame.eu,
            dv: up(found.d1[1]) + self.frame.ev,
            duu: up(found.d2[0]),
            duv: up(found.d2[1]),
            dvv: up(found.d2[2]),
        }
    }

    /// Ranges of the height over a rectangle: those of every piece that meets it, and of what is beyond the border there.
    fn heights(&self, u: (f64, f64), v: (f64, f64)) -> Heights {
        let (low, high) = (DVec2::new(u.0, v.0), DVec2::new(u.1, v.1));
        let ((i0, i1), (j0, j1)) = (span(self.table.cells, u.0, u.1), span(self.table.cells, v.0, v.1));
        let lists = (j0..=j1).flat_map(|j| (i0..=i1).map(move |i| (i, j))).flat_map(|(i, j)| self.table.list(i, j));
        let mut met: Vec<usize> = lists.copied().collect();
        met.sort_unstable();
        met.dedup();
        let mut whole: Option<Heights> = None;
        let mut add = |own: Heights| whole = Some(whole.map_or(own, |w| w.union(own)));
        met.iter().filter(|k| self.pieces[**k].meets(low, high)).for_each(|k| add(self.pieces[*k].heights(low, high)));
        let corners = [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)].map(|p| p * self.size);
        let middle = 0.5 * (corners[0] + corners[1]);
        // Of the sides only those that are nearest to some place of the rectangle.
        let nearest = self.rims.iter().map(|rim| rim.distance(middle)).fold(f64::INFINITY, f64::min);
        for rim in self.rims.iter().filter(|rim| rim.distance(middle) <= (1.0 + NUDGE) * (nearest + corners[0].distance(corners[1]))) {
            let off = corners.map(|p| (p - rim.ends[0]).dot(-rim.along.perp()));
            if off.iter().any(|d| *d > NUDGE * NUDGE * rim.length) {
                add(self.outside(rim, &corners, off.into_iter().fold(0.0, f64::max)));
            }
        }
        whole.unwrap_or(Heights { h: Interval::default(), d1: [Interval::default(); 2], d2: [Interval::default(); 3] })
    }

    /// Ranges of what goes on beyond a side and its ends, as far as a rectangle with these corners (model units) reaches.
    fn outside(&self, rim: &TriangleRim, corners: &[DVec2; 4], far: f64) -> Heights {
        let piece = &self.pieces[rim.piece];
        let (t, n) = (rim.along, -rim.along.perp());
        // The part of the side that is nearest to places of the rectangle.
        let along_it = corners.map(|p| rim.foot(p) / rim.length);
        let (from, to) = along_it.into_iter().fold((1.0, 0.0), |(a, b): (f64, f64), s| (a.min(s), b.max(s)));
        // Along a side the height is cubic and its slope across linear: second derivatives lie between those at the ends.
        let ends = [0, 1].map(|c| piece.height(piece.corners[c]));
        let bend = |k: usize| {
            let [xx, xy, yy] = self.bends(ends[k].d2);
            let bend = DVec2::new(xx * t.x + xy * t.y, xy * t.x + yy * t.y);
            DVec2::new(bend.dot(t), bend.dot(n))
        };
        let (a, b) = (bend(0).lerp(bend(1), from), bend(0).lerp(bend(1), to));
        let (along, across) = (Interval::between(a.x, b.x), Interval::between(a.y, b.y));
        let slopes = piece.side_slopes().map(|d| d / self.size);
        let slope = |axis: usize| hull(restricted(slopes.map(|d| d[axis]), from, to));
        let depth = Interval { low: 0.0, high: far };
        let d1 = [0, 1].map(|k| slope(k) + across * depth * t[k]);
        let d2 =
            [(0, 0), (0, 1), (1, 1)].map(|(i, j)| (along * (t[i] * t[j]) + across * (t[i] * n[j] + t[j] * n[i])).union(Interval::at(0.0)));
        // From feet to the rectangle.
        let feet = [from, to].map(|s| rim.ends[0].lerp(rim.ends[1], s));
        let arms = corners.iter().flat_map(|p| feet.map(|foot| *p - foot));
        let arm = |k: usize| arms.clone().map(|d| Interval::at(d[k])).fold(Interval::at(0.0), Interval::union);
        let h = hull(restricted(piece.side_heights(), from, to)) + slope(0) * arm(0) + slope(1) * arm(1);
        let (w, l) = (self.size.x, self.size.y);
        Heights { h, d1: [d1[0] * w, d1[1] * l], d2: [d2[0] * (w * w), d2[1] * (w * l), d2[2] * (l * l)] }
    }

    /// Lines between the cells in which the surface is sampled: about one cell a piece.
    pub fn lines(&self) -> (Vec<f64>, Vec<f64>) {
        const MOST: usize = 32;
        let cells = ((self.pieces.len() as f64).sqrt().ceil() as usize).clamp(1, MOST);
        let inner: Vec<f64> = (1..cells).map(|k| k as f64 / cells as f64).collect();
        (inner.clone(), inner)
    }

    /// About how many strips of bicubic pieces each way keep `within`, and the point that asks for most of them: second derivatives
    /// jump across the sides of triangles, which strips cross.
    pub fn strips(&self, within: f64) -> (f64, DVec3) {
        /// A cubic over a step h is off by this share of a jump of the second derivative times h².
        const OFF: f64 = 1.0 / 64.0;
        let mut around: BTreeMap<[u64; 2], (DVec2, [Interval; 3])> = BTreeMap::new();
        for piece in self.pieces.iter() {
            for corner in &piece.corners[..2] {
                let own = piece.height(*corner).d2.map(Interval::at);
                let known = around.entry([corner.x.to_bits(), corner.y.to_bits()]).or_insert((*corner, own));
                known.1 = [0, 1, 2].map(|k| known.1[k].union(own[k]));
            }
        }
        let jump = |ranges: &[Interval; 3]| ranges.iter().map(|r| r.high - r.low).fold(0.0, f64::max) * self.normal.length();
        let worst = around.values().max_by(|a, b| jump(&a.1).total_cmp(&jump(&b.1)));
        let inside = worst.map_or((0.0, self.frame.origin), |(at, ranges)| ((OFF * jump(ranges) / within).sqrt(), self.jet(at.x, at.y).p));
        let outside = self.rims.iter().map(|rim| self.creases(rim, within));
        outside.fold(inside, |most, next| if next.0 > most.0 { next } else { most })
    }

    /// The same beyond a side of the border, where the slope jumps across the lines from its ends outwards.
    fn creases(&self, rim: &TriangleRim, within: f64) -> (f64, DVec3) {
        /// A cubic over a step h is off by this share of a jump of the slope times h.
        const OFF: f64 = 1.0 / 8.0;
        let (t, n) = (rim.along, -rim.along.perp());
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(|p| p * self.size);
        let far = corners.iter().map(|p| (*p - rim.ends[0]).dot(n)).fold(0.0, f64::max);
        let piece = &self.pieces[rim.piece];
        let turn = |c: usize| {
            let [xx, xy, yy] = self.bends(piece.height(piece.corners[c]).d2);
            (t.x * (xx * n.x + xy * n.y) + t.y * (xy * n.x + yy * n.y)).abs()
        };
        let jump = turn(0).max(turn(1)) * far * self.normal.length();
        let at = piece.corners[0];
        (OFF * jump * self.size.max_element() / within, self.jet(at.x, at.y).p)
    }

    /// A box that holds the surface.
    pub fn hull(&self) -> Box3 {
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
        Box3::of(corners.into_iter().flat_map(|uv| [self.reach.low, self.reach.high].map(|h| self.lifted(uv, h))))
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        Self { frame: self.frame.moved(motion), normal: motion.vector(self.normal), ..self.clone() }
    }
}
