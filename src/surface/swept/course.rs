//! The parameter of a section in pieces: how long each is in it, how smoothly one follows another, which are straight.

use std::ops::Range;

use glam::{DVec3, DVec4};

use crate::base::tolerance::{EPSILON, NUDGE, Tolerance};
use crate::geometry::shapes::nurbs::projected;
use crate::surface::swept::deform::Pieces;

/// The parameter of a section: how long each piece is in it, and how smoothly one piece follows another.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// Lengths of the pieces in the parameter; those of smoothly joined pieces are such that the derivative goes on.
    pub spans: Vec<f64>,
    /// Whether the tangent goes on where each piece begins; that of the first one tells of a closed section.
    pub smooth: Vec<bool>,
    /// Whether the curvature does, of cubics without weights.
    pub fair: Vec<bool>,
    /// Derivative after a joint over that before it, by the parameter: 1 but where a closed section comes back.
    pub return_ratio: f64,
    /// Whether each piece is a straight line.
    straight: Vec<bool>,
}

/// Derivatives of a piece at both ends by its own parameter from 0 to 1.
pub(super) fn end_slopes(piece: &[DVec4]) -> (DVec3, DVec3) {
    let n = piece.len() - 1;
    let leg = |a: usize, b: usize, own: f64, other: f64| (projected(piece[b]) - projected(piece[a])) * (n as f64 * own / other);
    (leg(0, 1, piece[1].w, piece[0].w), leg(n - 1, n, piece[n - 1].w, piece[n].w))
}

/// Second derivatives of a cubic without weights at both ends, by a parameter in which it is as long as `span`.
fn end_bends(piece: &[DVec4], span: f64) -> Option<(DVec3, DVec3)> {
    let plain = piece.len() == 4 && piece.iter().all(|q| q.w == 1.0);
    let bend = |k: usize| (piece[k + 1] - piece[k] * 2.0 + piece[k - 1]).truncate() * (6.0 / (span * span));
    plain.then(|| (bend(1), bend(2)))
}

/// Whether one second derivative goes on in another, but for what cutting a spline leaves.
fn bends_on(before: Option<(DVec3, DVec3)>, after: Option<(DVec3, DVec3)>) -> bool {
    let (Some((_, before)), Some((after, _))) = (before, after) else { return false };
    before.distance(after) <= NUDGE * (before.length() + after.length())
}

/// Shares of the chord at which points lie that are all on it; `None` for a piece that bends.
fn straight_shares(points: &[DVec3]) -> Option<Vec<f64>> {
    let (first, last) = (points[0], points[points.len() - 1]);
    let way = last - first;
    let share = |p: &DVec3| if way == DVec3::ZERO { 0.0 } else { (*p - first).dot(way) / way.length_squared() };
    let shares: Vec<f64> = points.iter().map(share).collect();
    let on = |(p, share): (&DVec3, &f64)| (*p - first - way * *share).length() <= EPSILON * way.length();
    points.iter().zip(&shares).all(on).then_some(shares)
}

impl Course {
    /// Of a section in pieces between `breaks`, fractions of its length.
    pub fn new(section: &Pieces, breaks: &[f64], closed: bool, tolerance: &Tolerance) -> Self {
        let n = section.len();
        let slopes: Vec<(DVec3, DVec3)> = section.iter().map(|piece| end_slopes(piece)).collect();
        let goes_on = |before: DVec3, after: DVec3| before != DVec3::ZERO && after != DVec3::ZERO && !tolerance.is_kink(before, after);
        let smooth: Vec<bool> = (0..n)
            .map(|k| match k {
                0 => closed && goes_on(slopes[n - 1].1, slopes[0].0),
                _ => goes_on(slopes[k - 1].1, slopes[k].0),
            })
            .collect();
        let mut spans = vec![1.0; n];
        let mut from = 0;
        while from < n {
            let to = (from + 1..n).find(|k| !smooth[*k]).unwrap_or(n);
            for k in from + 1..to {
                spans[k] = spans[k - 1] * (slopes[k].0.length() / slopes[k - 1].1.length());
            }
            let scale = (breaks[to] - breaks[from]) / spans[from..to].iter().sum::<f64>();
            spans[from..to].iter_mut().for_each(|span| *span *= scale);
            from = to;
        }
        let rate = |slope: DVec3, span: f64| slope.length() / span;
        let return_ratio = if smooth[0] { rate(slopes[0].0, spans[0]) / rate(slopes[n - 1].1, spans[n - 1]) } else { 1.0 };
        let seconds: Vec<Option<(DVec3, DVec3)>> = section.iter().zip(&spans).map(|(piece, span)| end_bends(piece, *span)).collect();
        let fair = (0..n).map(|k| smooth[k] && bends_on(seconds[(k + n - 1) % n], seconds[k])).collect();
        let points = |piece: &Vec<DVec4>| piece.iter().map(|q| projected(*q)).collect::<Vec<_>>();
        let straight = section.iter().map(|piece| straight_shares(&points(piece)).is_some()).collect();
        Self { spans, smooth, fair, return_ratio, straight }
    }

    /// Which pieces stay straight: those of straight lines that no anchor divides, nor ends where the section goes on smoothly beyond all.
    pub fn stiff(&self, anchors: &[usize], closed: bool) -> Vec<bool> {
        let n = self.spans.len();
        let mut stiff = self.straight.clone();
        let goes_on = |k: usize| self.straight[k] && self.straight[(k + n - 1) % n] && self.smooth[k];
        let outer = |k: usize| {
            !closed && k > 0 && k < n && self.smooth[k] && (anchors.iter().min() == Some(&k) || anchors.iter().max() == Some(&k))
        };
        let mut from = 0;
        while from < n {
            let to = (from + 1..n).find(|k| !goes_on(*k)).unwrap_or(n);
            // A closed section begins at an anchor.
            let over_start = (from == 0 || to == n) && goes_on(0);
            if over_start || outer(from) || outer(to) || anchors.iter().any(|a| from < *a && *a < to) {
                stiff[from..to].fill(false);
            }
            from = to;
        }
        stiff
    }

    /// Runs of pieces between anchors that are one member: straight ones in line, or bent ones.
    pub fn members(&self, anchors: &[usize], stiff: &[bool]) -> Vec<Range<usize>> {
        let n = self.spans.len();
        let ends = |k: usize| anchors.contains(&k) || stiff[k - 1] != stiff[k] || stiff[k] && !self.smooth[k];
        let mut starts: Vec<usize> = std::iter::once(0).chain((1..n).filter(|k| ends(*k))).collect();
        starts.push(n);
        starts.windows(2).map(|w| w[0]..w[1]).collect()
    }
}
