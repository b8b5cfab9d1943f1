//! Curves of one family as polynomials see them: in parts between knots, each halved until polynomials come near to all of them.

use std::sync::OnceLock;

use glam::DVec3;

use crate::base::math;
use crate::base::tolerance::{NEAREST, NUDGE, SLIVER};
use crate::surface::data::breaks::tidy;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::axis_powers::AxisPowers;
use crate::surface::shapes::polynomial_pieces::{N, chebyshev, through};
use crate::surface::shapes::weights::BlendAxis;

/// A part between two knots is halved at most so often; after that it has no polynomials.
const DEEPEST: u32 = 6;
/// Digits that one halving gains where a curve is smooth: 2^N.
const DIGITS: f64 = 3.0;
/// Places in a piece, −1 to 1, at which it is compared with its curve.
const COMPARED: [f64; 4] = [-0.996, -0.31, 0.45, 0.998];

/// A curve's second derivatives, as they are bounded over a piece, are at most so many times those its polynomial may have there: a bend that
/// no compared place sees would be sharper.
const SHARPER: f64 = 8.0;

/// Curves of one family by their parameter, in parts between knots.
#[derive(Debug)]
pub(super) struct Track {
    pub stops: Vec<f64>,
    /// The cell of the direction's blending functions that each part lies in.
    pub cells: Vec<usize>,
    pub parts: Vec<OnceLock<Option<Sampled>>>,
    /// Inner stops at which first derivatives jump.
    pub corners: Vec<f64>,
}

/// Points of all curves of a family over one part, curve by curve: at the Chebyshev points of each of its pieces.
#[derive(Debug)]
pub(super) struct Sampled {
    pub halvings: u32,
    pub points: Vec<Vec<DVec3>>,
}

impl Track {
    /// The parts of some curves, in the cells of their direction's blending functions.
    pub fn new(rails: &[Rail], axis: &BlendAxis, powers: &AxisPowers, size: f64) -> Self {
        let mut all = powers.ends.clone();
        rails.iter().for_each(|rail| rail.breaks(&mut all));
        let inner = tidy(all, SLIVER);
        let creases = axis.creases();
        let jumps = |x: f64| {
            let own = |rail: &Rail| rail.jet(x, OneSided::Before).d1.distance(rail.jet(x, OneSided::After).d1);
            creases.iter().any(|crease| (crease - x).abs() <= SLIVER) || rails.iter().any(|rail| own(rail) > NEAREST * size)
        };
        let corners = inner.iter().copied().filter(|x| jumps(*x)).collect();
        let stops = [vec![0.0], inner, vec![1.0]].concat();
        let last = powers.ends.len() - 2;
        let cell = |w: &[f64]| powers.ends[1..=last].partition_point(|end| *end <= 0.5 * (w[0] + w[1]));
        let parts = std::iter::repeat_with(OnceLock::new).take(stops.len() - 1).collect();
        Self { cells: stops.windows(2).map(cell).collect(), stops, parts, corners }
    }

    /// Parameters of the Chebyshev points of all pieces of a part, ascending.
    pub fn places(&self, part: usize, halvings: u32) -> Vec<f64> {
        self.spread(part, halvings, chebyshev())
    }

    fn spread(&self, part: usize, halvings: u32, places: &[f64]) -> Vec<f64> {
        let (a, b) = (self.stops[part], self.stops[part + 1]);
        let pieces = 1_u64 << halvings;
        let width = (b - a) / pieces as f64;
        (0..pieces).flat_map(|n| places.iter().map(move |x| a + width * (n as f64 + 0.5 * (x + 1.0)))).collect()
    }

    /// The curves over a part; `None` where polynomials do not come near to one of them, by what is allowed and the size of all, and over
    /// a part narrower than a millionth of the range: there second derivatives of polynomials are the rounding of their values.
    pub fn sampled(&self, rails: &[Rail], part: usize, (allowed, size): (f64, f64)) -> Option<Sampled> {
        if self.stops[part + 1] - self.stops[part] < NUDGE {
            return None;
        }
        let mut halvings = 0;
        while halvings <= DEEPEST {
            let (nodes, compared) = (self.places(part, halvings), self.spread(part, halvings, &COMPARED));
            let mut points = Vec::with_capacity(rails.len());
            let mut worst = 0.0_f64;
            for rail in rails {
                let own = rail.points(&nodes);
                let seen = rail.points(&compared);
                for (own, seen) in own.chunks_exact(N).zip(seen.chunks_exact(COMPARED.len())) {
                    let piece = through(own);
                    let at = |y: f64| piece.iter().rev().fold(DVec3::ZERO, |p, c| p * y + *c);
                    worst = COMPARED.iter().zip(seen).map(|(y, p)| at(*y).distance(*p)).fold(worst, f64::max);
                }
                points.push(own);
            }
            if worst <= allowed {
                if self.bends_are_seen(rails, part, halvings, &points, size) {
                    return Some(Sampled { halvings, points });
                }
                halvings += 1;
                continue;
            }
            if !worst.is_finite() {
                break;
            }
            halvings += (math::log10(worst / allowed) / DIGITS).ceil().clamp(1.0, 3.0) as u32;
        }
        None
    }

    /// Whether no curve can bend much more within a piece than its polynomial does.
    fn bends_are_seen(&self, rails: &[Rail], part: usize, halvings: u32, points: &[Vec<DVec3>], size: f64) -> bool {
        let ends = self.spread(part, halvings, &[-1.0 + NEAREST, 1.0 - NEAREST]);
        rails.iter().zip(points).all(|(rail, points)| {
            ends.chunks_exact(2).zip(points.chunks_exact(N)).all(|(ends, own)| {
                let half = 0.5 * (ends[1] - ends[0]);
                let seen: f64 = through(own).iter().enumerate().skip(2).map(|(j, c)| (j * (j - 1)) as f64 * c.length()).sum();
                rail.line(ends[0], ends[1]).d2.reach() * half * half <= SHARPER * seen + NEAREST * size
            })
        })
    }
}
