//! Several curves in a row under one parameter.

use std::sync::OnceLock;

use crate::base::tolerance::SLIVER;
use crate::geometry::curves::curve::Curve;

/// Pieces one after the other; piece `i` keeps its own parameter, moved so that it starts where the one before ends.
#[derive(Clone, Debug)]
pub struct Composite {
    /// The pieces, none of them composite.
    pub pieces: Vec<Curve>,
    /// Parameters of the joints, ends included: `pieces.len() + 1` of them, from 0.
    pub breaks: Vec<f64>,
    starts: OnceLock<Vec<f64>>,
}

crate::content!(Composite { pieces, breaks } but { starts });

impl Composite {
    /// Pieces in a row; composite ones are taken apart.
    pub fn new(pieces: impl IntoIterator<Item = Curve>) -> Self {
        let pieces: Vec<Curve> = pieces
            .into_iter()
            .flat_map(|c| match c.composite() {
                Some(inner) => inner.pieces.clone(),
                None => vec![c],
            })
            .collect();
        let mut breaks = vec![0.0];
        for piece in &pieces {
            let (a, b) = piece.domain();
            breaks.push(breaks[breaks.len() - 1] + (b - a));
        }
        Self { pieces, breaks, starts: OnceLock::new() }
    }

    /// The piece that follows parameter `t` (the last one at the end) and its own parameter there.
    pub fn locate(&self, t: f64) -> (usize, f64) {
        let inner = &self.breaks[1..self.breaks.len() - 1];
        let i = inner.partition_point(|x| *x <= t);
        (i, self.own(i, t))
    }

    /// The piece before parameter `t` (the first one at the start) and its own parameter there.
    pub fn locate_before(&self, t: f64) -> (usize, f64) {
        let inner = &self.breaks[1..self.breaks.len() - 1];
        let i = inner.partition_point(|x| *x < t);
        (i, self.own(i, t))
    }

    /// Parameter of piece `i` at the common parameter `t`, kept inside its domain.
    pub fn own(&self, i: usize, t: f64) -> f64 {
        let (a, b) = self.pieces[i].domain();
        if t >= self.breaks[i + 1] { b } else { (a + (t - self.breaks[i])).clamp(a, b) }
    }

    /// Common parameter at the own parameter `t` of piece `i`.
    pub fn common(&self, i: usize, t: f64) -> f64 {
        let (a, b) = self.pieces[i].domain();
        if t == b { self.breaks[i + 1] } else { self.breaks[i] + (t - a) }
    }

    /// Arc length before each piece, and of all of them at the end.
    pub fn starts(&self) -> &[f64] {
        self.starts.get_or_init(|| {
            let mut starts = vec![0.0];
            for piece in &self.pieces {
                starts.push(starts[starts.len() - 1] + piece.length());
            }
            starts
        })
    }

    /// Common parameter at arc length `s`.
    pub fn param_at_length(&self, s: f64) -> f64 {
        let starts = self.starts();
        let i = starts[1..starts.len() - 1].partition_point(|x| *x <= s);
        self.common(i, self.pieces[i].param_at_length(s - starts[i]))
    }

    /// Arc length at the common parameter `t`.
    pub fn length_at(&self, t: f64) -> f64 {
        let (i, own) = self.locate(t);
        self.starts()[i] + self.pieces[i].length_at(own)
    }

    /// The run between two parameters, piece by piece.
    pub fn part(&self, t0: f64, t1: f64) -> Vec<Curve> {
        let (first, _) = self.locate(t0);
        let (last, _) = self.locate_before(t1);
        // What rounding left of a piece beside a joint is none.
        let room = SLIVER * (self.breaks[self.pieces.len()] - self.breaks[0]);
        let is_piece = |i: &usize| t1.min(self.breaks[i + 1]) - t0.max(self.breaks[*i]) > room;
        let mut range: Vec<usize> = (first..=last.max(first)).filter(is_piece).collect();
        if range.is_empty() {
            range.push(first);
        }
        range
            .into_iter()
            .map(|i| {
                let (a, b) = (self.own(i, t0.max(self.breaks[i])), self.own(i, t1.min(self.breaks[i + 1])));
                if (a, b) == self.pieces[i].domain() { self.pieces[i].clone() } else { self.pieces[i].part(a, b) }
            })
            .collect()
    }
}
