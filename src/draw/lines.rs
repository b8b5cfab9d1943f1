//! Curves and edges as points close enough together for the picture.

use std::collections::BTreeSet;

use glam::DVec3;

use super::scene::{Kind, Line};
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::model::{EdgePiece, Meeting, Model, SurfaceId, Track};
use crate::network::{Chain, Network};

/// Parts in which a smooth piece is checked before it may count as straight.
const PARTS: usize = 4;
/// Halvings of a part.
const DEPTH: u32 = 7;

/// Points of a way from `a` to `b`, none farther than `fine` from its chords; the first point is left out.
fn follow(at: &dyn Fn(f64) -> DVec3, (a, b): (f64, f64), fine: f64, depth: u32, out: &mut Vec<DVec3>) {
    let middle = 0.5 * (a + b);
    let (p, q, m) = (at(a), at(b), at(middle));
    if depth > 0 && m.distance(0.5 * (p + q)) > fine && p.distance(q).max(p.distance(m)) > fine {
        follow(at, (a, middle), fine, depth - 1, out);
        follow(at, (middle, b), fine, depth - 1, out);
    } else {
        out.push(q);
    }
}

fn smooth(at: &dyn Fn(f64) -> DVec3, (a, b): (f64, f64), fine: f64, out: &mut Vec<DVec3>) {
    let mut own = Vec::new();
    for k in 0..PARTS {
        let part = |k: usize| if k == PARTS { b } else { a + (b - a) * k as f64 / PARTS as f64 };
        follow(at, (part(k), part(k + 1)), fine, DEPTH, &mut own);
    }
    // What is straight needs its ends only.
    let (first, last) = (at(a), at(b));
    let along = last - first;
    // What comes back to where it began is straight only where it stays there.
    let closed = along.length() <= fine;
    let off = |p: &DVec3| if closed { p.distance(first) > fine } else { along.cross(*p - first).length() > fine * along.length() };
    if own.iter().any(off) {
        out.extend(own);
    } else {
        out.push(last);
    }
}

/// Points along a chain, its kinks and joints among them.
pub fn chain(chain: &Chain, fine: f64, tolerance: &Tolerance) -> Vec<DVec3> {
    let mut corners: Vec<f64> = chain.joints().iter().copied().chain(chain.kinks(tolerance)).collect();
    corners.sort_by(f64::total_cmp);
    corners.dedup();
    let at = |f: f64| chain.point(f);
    let mut points = vec![at(corners[0])];
    corners.windows(2).for_each(|w| smooth(&at, (w[0], w[1]), fine, &mut points));
    points
}

/// Points along a part of an edge.
pub fn track(track: &Track, (from, to): (f64, f64), fine: f64) -> Vec<DVec3> {
    let at = |s: f64| track.point(s);
    let mut points = vec![at(from)];
    // A run of several links may bend where they join: each part is checked.
    let n = PARTS * 4;
    let part = |k: usize| if k == n { to } else { from + (to - from) * k as f64 / n as f64 };
    (0..n).for_each(|k| follow(&at, (part(k), part(k + 1)), fine, DEPTH, &mut points));
    points
}

/// The edges of some surfaces: free ones, kinks, and where surfaces meet; borders up to `near` apart meet.
pub fn borders(model: &Model, network: &Network, members: &BTreeSet<SurfaceId>, near: f64, fine: f64, tolerance: &Tolerance) -> Vec<Line> {
    let pieces = model.edge_pieces(members, near, network, tolerance);
    par::map(pieces.len(), |k| Line { kind: kind_of(&pieces[k], tolerance), points: track(&pieces[k].track, pieces[k].s, fine) })
}

/// How a piece of an edge is drawn: a fold is a kink, between surfaces and at a seam too.
fn kind_of(piece: &EdgePiece, tolerance: &Tolerance) -> Kind {
    match (piece.meeting, piece.turn) {
        (Meeting::Free, _) => Kind::Free,
        (Meeting::Crowded, _) => Kind::Crowded,
        // Faces that lie on each other end there, both.
        (Meeting::Joined, Some(turn)) if turn > std::f64::consts::PI - tolerance.angle => Kind::Free,
        (_, Some(turn)) if turn > tolerance.angle => Kind::Kink,
        (Meeting::Kink, _) => Kind::Kink,
        (Meeting::Seam | Meeting::Joined, _) => Kind::Border,
    }
}

/// Where the faces of meshes fold: what the borders of their surfaces show, for the edges of elements along them.
#[derive(Debug, Default)]
pub struct Folds {
    /// Names of two surfaces, the first not after the second; what the border shows, and points along it.
    borders: Vec<(String, String, Kind, Vec<DVec3>)>,
}

/// Places along a border that are compared with edges of elements.
const COMPARED: usize = 33;

impl Folds {
    /// Of some surfaces; borders up to `near` apart meet.
    pub fn new(model: &Model, network: &Network, members: &BTreeSet<SurfaceId>, near: f64, tolerance: &Tolerance) -> Self {
        let pieces = model.edge_pieces(members, near, network, tolerance);
        let name = |id: SurfaceId| model.surfaces[id.index()].name.clone();
        let border = |piece: &EdgePiece| {
            let [a, b] = piece.surfaces.as_slice() else { return None };
            let (a, b) = (name(*a).min(name(*b)), name(*a).max(name(*b)));
            let place = |k: usize| piece.s.0 + (piece.s.1 - piece.s.0) * k as f64 / (COMPARED - 1) as f64;
            Some((a, b, kind_of(piece, tolerance), (0..COMPARED).map(|k| piece.track.point(place(k))).collect()))
        };
        Self { borders: pieces.iter().filter_map(border).collect() }
    }

    /// What the border of two surfaces shows at a place; `None` where they are not known to meet.
    pub fn at(&self, (a, b): (&str, &str), place: DVec3) -> Option<Kind> {
        let (a, b) = (a.min(b), a.max(b));
        let own = || self.borders.iter().filter(|border| border.0 == a && border.1 == b);
        let first = own().next()?.2;
        if own().all(|border| border.2 == first) {
            return Some(first);
        }
        let distance = |points: &[DVec3]| points.iter().map(|p| p.distance_squared(place)).fold(f64::INFINITY, f64::min);
        own().min_by(|x, y| distance(&x.3).total_cmp(&distance(&y.3))).map(|border| border.2)
    }
}
