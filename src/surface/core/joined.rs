//! Surfaces one after another as one: x runs across them, y along the borders that they share.
//!
//! Each is read through a turn of the unit square and a map of y, so that points of a common border have one y: the first one's y is
//! taken, and a later one's is where its border has the point that the border before it has there.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::math;
use crate::base::range::Interval;
use crate::base::tolerance::EPSILON;
use crate::geometry::Motion;
use crate::surface::core::joined_piece::{JoinedPiece, SidePair, foot};
use crate::surface::core::surface::Surface;
use crate::surface::data::breaks::tidy;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;

/// Places by which a map of y is begun.
pub(super) const PLACES: usize = 64;
/// Surfaces as one.
#[derive(Clone, Debug)]
pub struct Joined {
    pieces: Vec<JoinedPiece>,
    /// Where each begins in x, and 1.
    stops: Vec<f64>,
    /// x is v.
    across_v: bool,
    /// Whether first derivatives jump at some stop.
    rough: bool,
    /// Whether they jump at a seam of a piece that is none of all.
    bent: bool,
}

crate::content!(Joined { pieces, stops, across_v } but { rough, bent });

impl Joined {
    /// Pieces in order, each with its mean length along x; the borders between them are found to be common.
    pub fn new(pieces: Vec<JoinedPiece>, lengths: &[f64], across_v: bool) -> Self {
        let total: f64 = lengths.iter().sum();
        let mut stops = vec![0.0];
        stops.extend(lengths[..lengths.len() - 1].iter().scan(0.0, |sum, l| {
            *sum += l;
            Some(*sum / total)
        }));
        stops.push(1.0);
        let mut made = Self { pieces, stops, across_v, rough: false, bent: false };
        for k in 1..made.pieces.len() {
            made.pieces[k].follow = made.table(k);
        }
        made.bent = made.turned_seams().into_iter().any(|y| !made.is_even_along(y));
        made.rough = (1..made.pieces.len()).any(|k| !made.is_even(k));
        made
    }

    /// The surfaces in the order in which they were given.
    pub fn given(&self) -> Vec<Surface> {
        let mut order: Vec<&JoinedPiece> = self.pieces.iter().collect();
        order.sort_by_key(|p| p.given);
        order.into_iter().map(|p| p.surface.clone()).collect()
    }

    /// The pieces.
    pub fn pieces(&self) -> &[JoinedPiece] {
        &self.pieces
    }

    /// Where pieces meet, x.
    pub fn seams(&self) -> &[f64] {
        &self.stops[1..self.stops.len() - 1]
    }

    /// Jets on both sides of the seam before piece k at a y of all.
    pub fn beside(&self, k: usize, y: f64) -> (Jet2, Jet2) {
        let x = self.stops[k];
        let jet = |side: OneSided| self.xy_jet(x, y, (side, OneSided::After));
        (jet(OneSided::Before), jet(OneSided::After))
    }

    /// Whether first derivatives across the seam before piece k are the same on both sides.
    fn is_even(&self, k: usize) -> bool {
        (0..=PLACES).step_by(4).all(|n| {
            let (a, b) = self.beside(k, n as f64 / PLACES as f64);
            a.du.distance(b.du) <= EPSILON * PLACES as f64 * (a.du.length() + b.du.length())
        })
    }

    /// Whether first derivatives across a line of constant y are the same on both sides.
    fn is_even_along(&self, y: f64) -> bool {
        (0..=PLACES).step_by(4).all(|n| {
            let x = n as f64 / PLACES as f64;
            let [a, b] = [OneSided::Before, OneSided::After].map(|side| self.xy_jet(x, y, (OneSided::After, side)).dv);
            a.distance(b) <= EPSILON * PLACES as f64 * (a.length() + b.length())
        })
    }

    /// The y of piece k at even steps of the y of the one before; empty where they agree.
    fn table(&self, k: usize) -> Vec<f64> {
        let (a, b) = (&self.pieces[k - 1], &self.pieces[k]);
        let sides = (OneSided::After, OneSided::After);
        let point = |piece: &JoinedPiece, x: f64, y: f64| piece.jet(x, y, sides).p;
        let grid: Vec<DVec3> = (0..=4 * PLACES).map(|n| point(b, 0.0, n as f64 / (4 * PLACES) as f64)).collect();
        let mut from = 0;
        let mut table = Vec::with_capacity(PLACES + 1);
        for n in 0..=PLACES {
            let p = point(a, 1.0, n as f64 / PLACES as f64);
            let far = |m: &usize| grid[*m].distance_squared(p);
            let ahead = from..(from + grid.len() / 2).min(grid.len());
            from = ahead.min_by(|m, l| far(m).total_cmp(&far(l))).unwrap_or(from);
            table.push(match n {
                0 => 0.0,
                PLACES => 1.0,
                _ => foot(b, from as f64 / (4 * PLACES) as f64, p),
            });
        }
        let even = table.iter().enumerate().all(|(n, w)| (w - n as f64 / PLACES as f64).abs() <= EPSILON * PLACES as f64);
        if even { Vec::new() } else { table }
    }

    /// y of piece k and its two derivatives at a y of all.
    fn own(&self, k: usize, y: f64, side: OneSided) -> [f64; 3] {
        let mut at = [y, 1.0, 0.0];
        for n in 1..=k {
            let (a, b) = (&self.pieces[n - 1], &self.pieces[n]);
            if b.follow.is_empty() {
                continue;
            }
            let w = Self::next(a, b, at[0]);
            let (from, to) = (a.jet(1.0, at[0], (OneSided::Before, side)), b.jet(0.0, w, (OneSided::After, side)));
            let square = to.dv.length_squared();
            if square <= 0.0 {
                at = [w, at[1], 0.0];
                continue;
            }
            // The same point of both borders for every y: a(y(t)) = b(w(t)).
            let (first, second) = (from.dv * at[1], from.dvv * (at[1] * at[1]) + from.dv * at[2]);
            let slope = first.dot(to.dv) / square;
            at = [w, slope, (second - to.dvv * (slope * slope)).dot(to.dv) / square];
        }
        at
    }

    /// The y of `b` where its first border has the point that the last border of `a` has at a y of its own.
    fn next(a: &JoinedPiece, b: &JoinedPiece, y: f64) -> f64 {
        if y <= 0.0 || y >= 1.0 {
            return y.clamp(0.0, 1.0);
        }
        let n = ((y * PLACES as f64) as usize).min(PLACES - 1);
        let share = y * PLACES as f64 - n as f64;
        let guess = b.follow[n] + (b.follow[n + 1] - b.follow[n]) * share;
        foot(b, guess, a.jet(1.0, y, (OneSided::Before, OneSided::After)).p)
    }

    /// The y of all at a y of piece k: by halving, as it rises.
    fn common(&self, k: usize, w: f64) -> f64 {
        if self.pieces[1..=k].iter().all(|p| p.follow.is_empty()) {
            return w;
        }
        let miss = |y: f64| {
            let [own, slope, _] = self.own(k, y, OneSided::After);
            (own - w, slope)
        };
        crate::base::solve::bracketed(0.0, 1.0, EPSILON, miss)
    }

    /// The piece at an x, and its own x.
    fn at(&self, x: f64, side: OneSided) -> (usize, f64) {
        let last = self.pieces.len() - 1;
        let inner = &self.stops[1..=last];
        let k = inner.partition_point(|s| if side == OneSided::Before { *s < x - EPSILON } else { *s <= x + EPSILON });
        let (low, high) = (self.stops[k], self.stops[k + 1]);
        // From the nearer end, so that both are met exactly.
        let share = if x - low <= high - x { (x - low) / (high - low) } else { 1.0 - (high - x) / (high - low) };
        (k, if share.abs() <= EPSILON { 0.0 } else { share })
    }

    fn xy_jet(&self, x: f64, y: f64, sides: SidePair) -> Jet2 {
        let (k, x) = self.at(x, sides.0);
        let [w, slope, bend] = self.own(k, y, sides.1);
        let jet = self.pieces[k].jet(x, w, sides);
        let s = 1.0 / (self.stops[k + 1] - self.stops[k]);
        Jet2 {
            p: jet.p,
            du: jet.du * s,
            dv: jet.dv * slope,
            duu: jet.duu * (s * s),
            duv: jet.duv * (s * slope),
            dvv: jet.dvv * (slope * slope) + jet.dv * bend,
        }
    }

    fn swapped(jet: Jet2) -> Jet2 {
        Jet2 { du: jet.dv, dv: jet.du, duu: jet.dvv, dvv: jet.duu, ..jet }
    }

    /// Point and derivatives.
    pub fn jet(&self, u: f64, v: f64, sides: SidePair) -> Jet2 {
        if self.across_v { Self::swapped(self.xy_jet(v, u, (sides.1, sides.0))) } else { self.xy_jet(u, v, sides) }
    }

    /// Where the formula changes along u or v, and whether first derivatives may jump there.
    pub fn changes(&self, along_u: bool) -> (Vec<f64>, bool) {
        if along_u == self.across_v { (self.turned_seams(), self.bent) } else { (self.seams().to_vec(), self.rough) }
    }

    /// The y at which pieces have a seam inside.
    pub fn turned_seams(&self) -> Vec<f64> {
        let one = |(k, piece): (usize, &JoinedPiece)| piece.seam().map(|seam| self.common(k, seam));
        tidy(self.pieces.iter().enumerate().filter_map(one).collect(), EPSILON * PLACES as f64)
    }

    /// How normals turn at most over a line of constant y.
    pub fn fold_at(&self, y: f64) -> f64 {
        let normal = |x: f64, side: OneSided| {
            let jet = self.xy_jet(x, y, (OneSided::After, side));
            jet.du.cross(jet.dv).normalize_or_zero()
        };
        let at = |n: usize| (n as f64 + 0.5) / PLACES as f64;
        (0..PLACES).map(|n| math::angle_between(normal(at(n), OneSided::Before), normal(at(n), OneSided::After))).fold(0.0, f64::max)
    }

    /// Bounds over a rectangle that no seam crosses.
    pub fn enclosure(&self, u: (f64, f64), v: (f64, f64)) -> Enclosure {
        let (x, y) = if self.across_v { (v, u) } else { (u, v) };
        let (k, _) = self.at(0.5 * (x.0 + x.1), OneSided::After);
        let (low, width) = (self.stops[k], self.stops[k + 1] - self.stops[k]);
        let own = |x: f64| ((x - low) / width).clamp(0.0, 1.0);
        let mut slope = Interval::at(1.0);
        let mut bend = Interval::at(0.0);
        let mut at = y;
        for n in 1..=k {
            let (a, b) = (&self.pieces[n - 1], &self.pieces[n]);
            if b.follow.is_empty() {
                continue;
            }
            let next = (Self::next(a, b, at.0), Self::next(a, b, at.1));
            let (from, to) = (a.enclosure((1.0, 1.0), at), b.enclosure((0.0, 0.0), next));
            let over = to.dv.dot(&to.dv).inverse();
            let second = from.dvv * slope.square() + from.dv * bend;
            slope = from.dv.dot(&to.dv) * over * slope;
            bend = (second - to.dvv * slope.square()).dot(&to.dv) * over;
            at = next;
        }
        let s = self.pieces[k].enclosure((own(x.0), own(x.1)), at);
        let scale = 1.0 / width;
        let mid = self.xy_jet(0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1), (OneSided::After, OneSided::After));
        let half = (0.5 * (x.1 - x.0), 0.5 * (y.1 - y.0));
        let (du, dv) = (s.du * scale, s.dv * slope);
        let (duu, duv, dvv) = (s.duu * (scale * scale), s.duv * (slope * scale), s.dvv * slope.square() + s.dv * bend);
        if self.across_v {
            let half = (half.1, half.0);
            return Enclosure { mid: Self::swapped(mid), half, p: s.p, du: dv, dv: du, duu: dvv, duv, dvv: duu };
        }
        Enclosure { mid, half, p: s.p, du, dv, duu, duv, dvv }
    }

    /// Lines of all pieces and the seams between and in them, of u and of v.
    pub fn all_lines(&self, of: impl Fn(&Surface) -> (Vec<f64>, Vec<f64>)) -> (Vec<f64>, Vec<f64>) {
        let (mut us, mut vs) = self.lines(of);
        let along = if self.across_v { &mut us } else { &mut vs };
        along.extend(self.turned_seams());
        *along = tidy(std::mem::take(along), EPSILON * PLACES as f64);
        (us, vs)
    }

    /// Lines of all pieces and the seams between them, of u and of v.
    pub fn lines(&self, of: impl Fn(&Surface) -> (Vec<f64>, Vec<f64>)) -> (Vec<f64>, Vec<f64>) {
        let (mut xs, mut ys) = (self.seams().to_vec(), Vec::new());
        for (k, piece) in self.pieces.iter().enumerate() {
            let (own_x, own_y) = piece.lines(of(&piece.surface));
            let (low, high) = (self.stops[k], self.stops[k + 1]);
            xs.extend(own_x.into_iter().map(|x| low + (high - low) * x));
            ys.extend(own_y.into_iter().map(|w| self.common(k, w)));
        }
        let near = EPSILON * PLACES as f64;
        let (xs, ys) = (tidy(xs, near), tidy(ys, near));
        if self.across_v { (ys, xs) } else { (xs, ys) }
    }

    /// A box that holds the surface.
    pub fn hull(&self) -> Box3 {
        self.pieces.iter().fold(Box3::EMPTY, |all, piece| all.union(piece.surface.hull()))
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let piece = |p: &JoinedPiece| JoinedPiece { surface: p.surface.moved(motion), ..p.clone() };
        Self { pieces: self.pieces.iter().map(piece).collect(), ..self.clone() }
    }
}
