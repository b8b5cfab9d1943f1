//! Integrals over the parts of cells below the water plane.

use super::cut::{Cut, CuttingPlane, Piece, Strip};
use super::face::{Face, Rect};
use super::sums::{WET, Wet, wet_densities};
use super::water::Water;
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::base::tolerance::FLOAT_WET;
use crate::base::work;

/// Orders of the two rules compared.
const ORDERS: [usize; 2] = [6, 9];
/// A piece whose rules differ is quartered at most so often.
const MAX_DEPTH: u32 = 10;
/// Pieces of a cell in all; what then is left counts with its error.
const MOST_PIECES: usize = 256;

/// How far a body reaches, for what a difference is compared with.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Area of the body's outside, square model units.
    pub area: f64,
    /// Largest |ξ|, |η| and |ζ| of the body, model units.
    pub reach: [f64; 3],
}

impl Scale {
    /// How large the integrals of an area may be.
    pub fn sizes(&self, area: f64) -> [f64; WET] {
        let [x, y, z] = self.reach;
        [1.0, 1.0, x, y, z, x * x, x * y, y * y, x * z, y * z, z * z, 1.0, x].map(|size| area * size)
    }

    /// What each difference may be.
    pub fn allowed(&self) -> [f64; WET] {
        self.sizes(FLOAT_WET * self.area)
    }
}

/// The rules, made once.
pub struct WetRules([Vec<(f64, f64)>; 2]);

impl Default for WetRules {
    fn default() -> Self {
        Self::new()
    }
}

impl WetRules {
    /// The rules.
    pub fn new() -> Self {
        Self(ORDERS.map(gauss_legendre))
    }

    /// Points and weights over −1…1, the rougher rule first.
    pub fn rules(&self) -> &[Vec<(f64, f64)>; 2] {
        &self.0
    }
}

/// Adds what is below the water of one cell that its plane crosses.
pub fn wet_of_cell(face: &Face, rect: Rect, water: &Water, plane: CuttingPlane, scale: &Scale, rules: &WetRules, to: &mut Wet) {
    let cut = Cut { face, plane };
    let allowed = scale.allowed();
    let mut pieces = Vec::new();
    cut.pieces(rect, 0, &mut pieces);
    let mut open: Vec<(Piece, u32)> = pieces.iter().map(|piece| (*piece, 0)).collect();
    let mut seen = 0;
    while let Some((piece, depth)) = open.pop() {
        job::poll();
        work::spend(16);
        seen += 1;
        let by = |rule: &[(f64, f64)]| match piece {
            Piece::Whole(rect) | Piece::Beside(rect) => face.product(&rect, rule, &|p, n| wet_densities(water, p, n)),
            Piece::Strip(strip) => strip_product(&cut, &strip, rule, water),
        };
        if let Piece::Beside(_) = piece {
            // Its middle is below the plane: what of it is not counts as an error.
            let whole = by(&rules.0[0]);
            to.add(&whole, &whole.map(f64::abs));
            continue;
        }
        let (rough, fine) = (by(&rules.0[0]), by(&rules.0[1]));
        let apart: [f64; WET] = std::array::from_fn(|k| (fine[k] - rough[k]).abs());
        if depth == MAX_DEPTH || seen >= MOST_PIECES || apart.iter().zip(allowed).all(|(a, most)| *a <= most) {
            to.add(&fine, &apart);
            continue;
        }
        let rect = match piece {
            Piece::Whole(rect) | Piece::Beside(rect) => rect,
            Piece::Strip(strip) => strip.rect(),
        };
        for quarter in rect.quarters() {
            pieces.clear();
            match piece {
                Piece::Strip(_) => cut.pieces(quarter, depth, &mut pieces),
                _ => pieces.push(Piece::Whole(quarter)),
            }
            open.extend(pieces.iter().map(|piece| (*piece, depth + 1)));
        }
    }
}

/// A rule over the part of a strip below the plane: rows from an end to their crossings.
fn strip_product(cut: &Cut, strip: &Strip, rule: &[(f64, f64)], water: &Water) -> [f64; WET] {
    let mut sum = [0.0; WET];
    let mut guess = 0.5 * (strip.reach.0 + strip.reach.1);
    let half = 0.5 * (strip.rows.1 - strip.rows.0);
    for (t, weight) in rule {
        let row = 0.5 * (strip.rows.0 + strip.rows.1) + half * t;
        guess = cut.crossing(strip, row, guess);
        let (low, high) = strip.below(guess);
        let reach = 0.5 * (high - low);
        for (s, own) in rule {
            let (x, y) = strip.place(0.5 * (low + high) + reach * s, row);
            let (p, n) = cut.face.element(x, y);
            let value = wet_densities(water, p, n);
            let weight = weight * own * half * reach;
            (0..WET).for_each(|k| sum[k] += weight * value[k]);
        }
    }
    sum
}
