//! Matrices that depend on one parameter: polynomials between stops, fitted once to rounding.
//!
//! A piece of degree 8 meets the function in the nine Chebyshev points of its interval, ends included; intervals are halved
//! until what is checked between them agrees.

use glam::{DMat3, DVec3};

use crate::base::digest::{StableHash, StableHasher};
use crate::base::range::Interval3;
use crate::base::tolerance::{EPSILON, FRAME};
use crate::base::{job, math};
use crate::surface::data::one_sided::OneSided;

/// Degree of a fitted piece.
const DEGREE: usize = 8;
/// An interval is halved this often, at most.
const DEPTH: usize = 12;

/// Coefficients of the powers of x, −1…1 over the piece.
type MatrixPiece = Vec<DMat3>;

/// K(u) for u from the first stop to the last one.
#[derive(Clone, Debug)]
pub struct Matrices {
    stops: Vec<f64>,
    pieces: Vec<MatrixPiece>,
}

/// A matrix and its first two derivatives: values at one parameter.
pub type MatrixJet = [DMat3; 3];

/// The same over an interval: bounds of the columns, then of those of both derivatives.
pub type Over = [[Interval3; 3]; 3];

impl StableHash for Matrices {
    fn hash_into(&self, to: &mut StableHasher) {
        self.stops.hash_into(to);
        for piece in &self.pieces {
            piece.len().hash_into(to);
            piece.iter().for_each(|m| (m.x_axis, m.y_axis, m.z_axis).hash_into(to));
        }
    }
}

impl Matrices {
    /// Nothing yet; pieces follow by [`Matrices::fit`].
    pub fn empty() -> Self {
        Self { stops: Vec::new(), pieces: Vec::new() }
    }

    /// Appends the interval `a…b`, which goes on from the last one. False where no polynomial fits.
    ///
    /// `of` gives the matrix at ascending parameters: it is asked for one interval after the other, each from left to right.
    pub fn fit(&mut self, (a, b): (f64, f64), of: &mut dyn FnMut(f64) -> DMat3) -> bool {
        if self.stops.is_empty() {
            self.stops.push(a);
        }
        self.halved((a, b), of, DEPTH)
    }

    fn halved(&mut self, (a, b): (f64, f64), of: &mut dyn FnMut(f64) -> DMat3, depth: usize) -> bool {
        job::poll();
        let piece = interpolated((a, b), of);
        let off = (0..DEGREE).map(|k| {
            let x = 0.5 * (node(k) + node(k + 1));
            largest(value(&piece, x) - of(0.5 * (a + b) + 0.5 * (b - a) * x))
        });
        if off.fold(0.0, f64::max) <= FRAME {
            self.pieces.push(trimmed(piece));
            self.stops.push(b);
            return true;
        }
        let middle = 0.5 * (a + b);
        depth > 0 && self.halved((a, middle), of, depth - 1) && self.halved((middle, b), of, depth - 1)
    }

    fn piece_at(&self, u: f64, side: OneSided) -> usize {
        let inner = &self.stops[1..self.stops.len() - 1];
        inner.partition_point(|&x| if side == OneSided::Before { x < u - EPSILON } else { x <= u + EPSILON })
    }

    /// Value and derivatives, from the given side at a stop.
    pub fn at(&self, u: f64, side: OneSided) -> MatrixJet {
        let k = self.piece_at(u, side);
        let (a, b) = (self.stops[k], self.stops[k + 1]);
        let by = 2.0 / (b - a);
        // From the nearer end, so that both ends are met exactly.
        let x = if u - a < b - u { (u - a) * by - 1.0 } else { 1.0 - (b - u) * by };
        let [p, d1, d2] = taylor(&self.pieces[k], x);
        [p, d1 * by, d2 * (2.0 * by * by)]
    }

    /// Inner stops.
    pub fn stops(&self) -> &[f64] {
        &self.stops[1..self.stops.len() - 1]
    }

    /// Bounds between two parameters of one piece.
    pub fn over(&self, (u0, u1): (f64, f64)) -> Over {
        let k = self.piece_at(0.5 * (u0 + u1), OneSided::After);
        let (a, b) = (self.stops[k], self.stops[k + 1]);
        let by = 2.0 / (b - a);
        let (middle, half) = ((0.5 * (u0 + u1) - 0.5 * (a + b)) * by, 0.5 * (u1 - u0) * by);
        let shifted = shifted(&self.pieces[k], middle);
        [0, 1, 2].map(|order| {
            let scale = math::powi(by, order);
            [0, 1, 2].map(|column| {
                let mut range = Interval3::default();
                let mut power = 1.0;
                for (n, c) in shifted.iter().enumerate().skip(order as usize) {
                    // n (n − 1) … over the order of the derivative.
                    let factor: f64 = (0..order as usize).map(|j| (n - j) as f64).product();
                    let share = c.col(column) * (factor * power * scale);
                    range = range + if n == order as usize { Interval3::at(share) } else { Interval3::around_zero(share.abs()) };
                    power *= half;
                }
                range
            })
        })
    }

    /// Whether it is the identity everywhere.
    pub fn is_identity(&self) -> bool {
        self.pieces
            .iter()
            .all(|piece| piece.iter().enumerate().all(|(k, m)| largest(*m - if k == 0 { DMat3::IDENTITY } else { DMat3::ZERO }) == 0.0))
    }

    /// Largest factor by which a vector gets longer, at most: the largest sum of squares of all entries.
    pub fn reach(&self) -> f64 {
        let norm = |m: &DMat3| (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt();
        self.pieces.iter().map(|piece| piece.iter().map(norm).sum()).fold(0.0, f64::max)
    }

    /// Q K Q⁻¹ for every matrix.
    pub fn conjugated(&self, q: DMat3) -> Self {
        let back = q.inverse();
        let pieces = self.pieces.iter().map(|piece| piece.iter().map(|m| q * *m * back).collect()).collect();
        Self { stops: self.stops.clone(), pieces }
    }
}

/// The Chebyshev points from −1 to 1.
fn node(k: usize) -> f64 {
    -math::cos(std::f64::consts::PI * k as f64 / DEGREE as f64)
}

fn largest(m: DMat3) -> f64 {
    m.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// The polynomial through the Chebyshev points, by divided differences and then by powers.
fn interpolated((a, b): (f64, f64), of: &mut dyn FnMut(f64) -> DMat3) -> MatrixPiece {
    let at = |k: usize| match k {
        0 => a,
        DEGREE => b,
        _ => 0.5 * (a + b) + 0.5 * (b - a) * node(k),
    };
    let mut d: Vec<DMat3> = (0..=DEGREE).map(|k| of(at(k))).collect();
    for r in 1..=DEGREE {
        for k in (r..=DEGREE).rev() {
            d[k] = (d[k] - d[k - 1]) * (1.0 / (node(k) - node(k - r)));
        }
    }
    // Horner's scheme over the Newton form.
    let mut powers = vec![d[DEGREE]];
    for k in (0..DEGREE).rev() {
        let mut next = vec![d[k]];
        next.extend(powers.iter().copied());
        for (n, c) in powers.iter().enumerate() {
            next[n] -= *c * node(k);
        }
        powers = next;
    }
    powers
}

/// Without the highest powers that are rounding alone.
fn trimmed(mut piece: MatrixPiece) -> MatrixPiece {
    while piece.len() > 1 && piece.last().is_some_and(|m| largest(*m) <= EPSILON) {
        piece.pop();
    }
    piece
}

fn value(piece: &MatrixPiece, x: f64) -> DMat3 {
    piece.iter().rev().fold(DMat3::ZERO, |sum, c| sum * x + *c)
}

/// Value, first derivative and half the second one.
fn taylor(piece: &MatrixPiece, x: f64) -> [DMat3; 3] {
    let mut t = [DMat3::ZERO; 3];
    for c in piece.iter().rev() {
        t[2] = t[2] * x + t[1];
        t[1] = t[1] * x + t[0];
        t[0] = t[0] * x + *c;
    }
    t
}

/// The same polynomial in powers of x − middle.
fn shifted(piece: &MatrixPiece, middle: f64) -> MatrixPiece {
    let mut c = piece.clone();
    for k in 0..c.len() {
        for n in (k..c.len() - 1).rev() {
            let next = c[n + 1];
            c[n] += next * middle;
        }
    }
    c
}

/// Bounds of K·w for columns known within ranges about `middle` and a vector within ranges about `at`.
pub fn times(columns: &[Interval3; 3], middle: &DMat3, w: &Interval3, at: DVec3) -> Interval3 {
    let (rest, still) = (*w + -at, *middle * at);
    let part = |k: usize| rest.coordinate(k) * middle.col(k) + (columns[k] + -middle.col(k)) * w.coordinate(k);
    part(0) + part(1) + part(2) + still
}
