//! A curve in (u, v) where it meets kink lines of a surface: the fractions, and derivatives of the side it is on.

use glam::DVec2;

use crate::base::tolerance::SLIVER;
use crate::network::Chain;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::trims::compose::{rational, where_it_is};

/// Curves that wind round a closed surface more often than this have no stops at its lines.
const MOST_TURNS: f64 = 1024.0;

/// The kink lines of a surface, with its seams.
pub(super) struct Lines<'a> {
    surface: &'a Surface,
    /// Values of u (first) and v.
    at: [Vec<f64>; 2],
    closed: [bool; 2],
}

impl<'a> Lines<'a> {
    pub fn of(surface: &'a Surface) -> Self {
        let ((us, vs), closed) = (surface.kinks(), surface.closed());
        let (mut us, mut vs) = (us.to_vec(), vs.to_vec());
        for (lines, closed) in [(&mut us, closed.0), (&mut vs, closed.1)] {
            if closed {
                lines.insert(0, 0.0);
            }
        }
        Self { surface, at: [us, vs], closed: closed.into() }
    }

    /// Fractions of a curve in (u, v) at which it meets the lines, in no order. Offsets and helices, which no polynomials describe, say none.
    pub fn met(&self, chain: &Chain) -> Vec<f64> {
        let mut found = Vec::new();
        for (k, run) in chain.runs().iter().enumerate() {
            let Some(curve) = rational(&run.curve) else { continue };
            let whole = run.curve.length();
            for piece in curve.beziers() {
                for (axis, lines) in self.at.iter().enumerate() {
                    let values = piece.poles.iter().map(|b| b[axis] / b.w);
                    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
                    if self.closed[axis] && !(high - low <= MOST_TURNS && low.abs() <= 1.0 / SLIVER) {
                        continue;
                    }
                    let turns = if self.closed[axis] { low.floor() as i64..=high.floor() as i64 } else { 0..=0 };
                    for line in turns.flat_map(|turn| lines.iter().map(move |line| line + turn as f64)) {
                        let lengths = where_it_is(&piece, line, axis == 0).into_iter().map(|t| run.curve.length_at(t));
                        // A run past the start of a closed curve sees the same place one turn later.
                        let stations = lengths.flat_map(|s| [s, s + whole]).filter(|s| *s > run.s0 && *s < run.s1);
                        found.extend(stations.map(|s| chain.fraction(k, s)));
                    }
                }
            }
        }
        found
    }

    /// Point and derivatives of the surface at a place of a curve that moves there in a direction: on a line those of the side it comes
    /// from (`before`) or goes to.
    pub fn jet(&self, uv: DVec2, way: DVec2, before: bool) -> Jet2 {
        let on = |axis: usize| {
            let (x, turn) = (uv[axis], if self.closed[axis] { uv[axis].round() } else { 0.0 });
            let side = if (way[axis] > 0.0) == before { OneSided::Before } else { OneSided::After };
            // The seam is 0 for what follows it and 1 for what comes before.
            if self.closed[axis] && (x - turn).abs() <= SLIVER {
                return (if side == OneSided::Before { 1.0 } else { 0.0 }, side);
            }
            let x = if self.closed[axis] { x - x.floor() } else { x };
            match self.at[axis].iter().find(|line| (x - **line).abs() <= SLIVER) {
                Some(line) => (*line, side),
                None => (x, OneSided::After),
            }
        };
        let ((u, side_u), (v, side_v)) = (on(0), on(1));
        self.surface.jet_one_sided(u, v, (side_u, side_v))
    }
}
