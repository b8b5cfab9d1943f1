//! How a skin leaves its first section and arrives at its last one.
//!
//! A spline through sections with a given slope at an end is, in its first span, a cubic of known values and slopes. One
//! more curve of it in the middle of that span makes the spline whose first two pieces are one cubic the same one.

use glam::DVec3;

use crate::base::math;
use crate::base::tolerance::Tolerance;
use crate::surface::rails::mixed::{Mixed, Part};
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::cardinal::{self, End};

/// Places along a section at which its distance from a pole is looked at.
const MAX_SAMPLES: usize = 32;

/// What a skin does at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leaving {
    /// Its first two pieces are one cubic.
    Plain,
    /// It does not bend.
    Natural,
    /// It runs in this direction, of length one; at a point it is flat across it.
    Along(DVec3),
}

/// Curves with their parameters across, and the two ends.
pub struct Spanned {
    /// v of each.
    pub nodes: Vec<f64>,
    /// The curves.
    pub rails: Vec<Rail>,
}

/// The same spline with other ends: a curve more for each end that is not plain. `length` is how far it runs in all.
pub fn ended(given: Spanned, ends: (Leaving, Leaving), length: f64, tolerance: &Tolerance) -> Spanned {
    let word = |leaving: Leaving| match leaving {
        Leaving::Plain => End::Plain,
        Leaving::Natural => End::Natural,
        Leaving::Along(_) => End::Slope,
    };
    let words = (word(ends.0), word(ends.1));
    let Spanned { nodes, rails } = given;
    let n = nodes.len();
    let slopes = cardinal::ended(&nodes, words);
    let fields = [slope(&rails, &nodes, false, ends.0, length), slope(&rails, &nodes, true, ends.1, length)];
    let both = words.0 != End::Plain && words.1 != End::Plain;
    // Both in one span share it in thirds.
    let share = if n == 2 && both { 1.0 / 3.0 } else { 0.5 };
    let at = |cell: usize, t: f64| {
        let h = nodes[cell + 1] - nodes[cell];
        let mut shares = vec![0.0; n + 2];
        shares[cell] += (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t);
        shares[cell + 1] += t * t * (3.0 - 2.0 * t);
        let by = (h * t * (1.0 - t) * (1.0 - t), h * t * t * (t - 1.0));
        for (share, (first, second)) in shares.iter_mut().zip(slopes[cell].iter().zip(&slopes[cell + 1])) {
            *share += by.0 * first + by.1 * second;
        }
        let mut parts: Vec<Part> = Vec::new();
        parts.extend(rails.iter().zip(&shares).map(|(rail, by)| Part { by: *by, rail: rail.clone(), onto: None }));
        for (field, by) in fields.iter().zip(&shares[n..]) {
            parts.extend(field.iter().map(|part| Part { by: part.by * by, ..part.clone() }));
        }
        (nodes[cell] + h * t, Rail::Mixed(Box::new(Mixed::new(parts, tolerance))))
    };
    let (first, last) = (at(0, share), at(n - 2, 1.0 - share));
    let (mut all, mut curves) = (nodes.clone(), rails.clone());
    if words.1 != End::Plain {
        all.insert(n - 1, last.0);
        curves.insert(n - 1, last.1);
    }
    if words.0 != End::Plain {
        all.insert(1, first.0);
        curves.insert(1, first.1);
    }
    Spanned { nodes: all, rails: curves }
}

/// The slope across at an end as a sum of curves whose shares sum to 0; none unless it is given.
fn slope(rails: &[Rail], nodes: &[f64], last: bool, leaving: Leaving, length: f64) -> Vec<Part> {
    let Leaving::Along(direction) = leaving else { return Vec::new() };
    let n = nodes.len();
    let (end, next) = if last { (n - 1, n - 2) } else { (0, 1) };
    let part = |by: f64, rail: Rail, onto: Option<(DVec3, DVec3)>| Part { by, rail, onto };
    let Rail::Point(pole) = &rails[end] else {
        let from = rails[end].point(0.0);
        return vec![part(1.0, Rail::Point(from + direction * length), None), part(-1.0, Rail::Point(from), None)];
    };
    // Away from the point, flat, as fast as an arc that leaves it so and passes the next section.
    let mut speed = 0.0;
    for k in 0..MAX_SAMPLES {
        let chord = rails[next].point(k as f64 / MAX_SAMPLES as f64) - *pole;
        let flat = chord.reject_from_normalized(direction).length();
        let angle = math::atan2(chord.dot(direction).abs(), flat);
        let arc = if angle > 0.0 { chord.length() * angle / math::sin(angle) } else { chord.length() };
        speed += if flat > 0.0 { arc / flat } else { 0.0 };
    }
    let span = if last { nodes[n - 1] - nodes[n - 2] } else { nodes[1] - nodes[0] };
    let by = speed / MAX_SAMPLES as f64 / span * if last { -1.0 } else { 1.0 };
    vec![part(by, rails[next].clone(), Some((*pole, direction))), part(-by, rails[end].clone(), None)]
}
