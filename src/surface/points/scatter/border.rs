//! The border of a triangulation: what is thin along the hull is peeled off, sides on one line are one, and the surface gets its loop.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::network::Chain;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::BorderFault;
use crate::surface::rails::side::{Border, Side as Edge};
use crate::surface::rails::trim_curve::{Pcurve, TrimCurve};
use crate::surface::shapes::height_field::Field;
use crate::surface::trims::trim_loop::{TrimLoop, assembled};

/// A side of the border: its two points, and the piece that lies along it.
#[derive(Clone, Copy, Debug)]
pub struct TriangleSide {
    /// Its first point, counter-clockwise.
    pub from: usize,
    /// Its last point.
    pub to: usize,
    /// The piece of the field that has it as its first side.
    pub piece: usize,
}

/// A triangle over a side of the border whose angles there have no larger tangent (about 3°) is no part of the surface: its points are
/// about in a row, as those of a grid are where the plane is tilted, and in its narrow height the surface would bend without bounds.
const THIN: f64 = 0.05;

/// The triangles without thin ones along the border, and those no higher than `least` (points that are in a row but for rounding), and
/// the sides of the border counter-clockwise, beginning with the first point.
pub fn peeled(triangles: Vec<[usize; 3]>, flat: &[DVec2], least: f64) -> (Vec<[usize; 3]>, Vec<TriangleSide>) {
    let left = without_thin(triangles, flat, least);
    let mut next: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
    for ((from, to), t) in outer(&left) {
        let k = left[t].iter().position(|p| *p == from).unwrap_or(0);
        next.insert(from, (to, 3 * t + k));
    }
    let mut sides = Vec::with_capacity(next.len());
    let Some(&first) = next.keys().next() else { return (left, sides) };
    let mut from = first;
    while let Some((to, piece)) = next.remove(&from) {
        sides.push(TriangleSide { from, to, piece });
        from = to;
    }
    (left, sides)
}

/// The triangles that are left where thin ones go from the border inwards, one at a time: each takes a point to the border.
fn without_thin(triangles: Vec<[usize; 3]>, flat: &[DVec2], least: f64) -> Vec<[usize; 3]> {
    let of_side: BTreeMap<(usize, usize), usize> =
        triangles.iter().enumerate().flat_map(|(n, t)| [((t[0], t[1]), n), ((t[1], t[2]), n), ((t[2], t[0]), n)]).collect();
    let mut open: BTreeSet<(usize, usize)> = outer(&triangles).into_keys().collect();
    let mut on_border: BTreeSet<usize> = open.iter().map(|side| side.0).collect();
    let mut gone = vec![false; triangles.len()];
    while let Some((a, b)) = open.pop_first() {
        job::poll();
        let Some(&t) = of_side.get(&(a, b)) else { continue };
        let Some(&apex) = triangles[t].iter().find(|p| **p != a && **p != b) else { continue };
        let (side, arm) = (flat[b] - flat[a], flat[apex] - flat[a]);
        let length = side.length();
        let (height, foot) = (side.perp_dot(arm) / length, side.dot(arm) / length);
        if height <= least.max(THIN * foot.min(length - foot)) && on_border.insert(apex) {
            gone[t] = true;
            open.extend([(a, apex), (apex, b)]);
        }
    }
    triangles.into_iter().zip(gone).filter_map(|(t, gone)| (!gone).then_some(t)).collect()
}

/// Sides that one triangle has alone, as it turns, with that triangle.
fn outer(triangles: &[[usize; 3]]) -> BTreeMap<(usize, usize), usize> {
    let mut found = BTreeMap::new();
    for (n, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if found.remove(&(b, a)).is_none() {
                found.insert((a, b), n);
            }
        }
    }
    found
}

/// Of each triangle the points across its sides, of the triangles there; the sides in the order of their first corners.
pub fn opposite(triangles: &[[usize; 3]]) -> Vec<[Option<usize>; 3]> {
    let mut apex = BTreeMap::new();
    for t in triangles {
        (0..3).for_each(|k| {
            apex.insert((t[k], t[(k + 1) % 3]), t[(k + 2) % 3]);
        });
    }
    let across = |t: &[usize; 3]| [0, 1, 2].map(|k| apex.get(&(t[(k + 1) % 3], t[k])).copied());
    triangles.iter().map(across).collect()
}

/// The sides in runs along one line each, beginning at a corner.
pub fn runs(sides: &[TriangleSide], flat: &[DVec2], tolerance: &Tolerance) -> Vec<Vec<TriangleSide>> {
    let n = sides.len();
    let corner = |k: usize| {
        let (before, after) = (&sides[(k + n - 1) % n], &sides[k]);
        let (a, b, c) = (flat[before.from], flat[after.from], flat[after.to]);
        let off = (c - a).perp_dot(b - a).abs() / a.distance(c);
        off > tolerance.point
    };
    let start = (0..n).find(|k| corner(*k)).unwrap_or(0);
    let mut found: Vec<Vec<TriangleSide>> = Vec::new();
    for k in (0..n).map(|k| (start + k) % n) {
        match found.last_mut() {
            Some(run) if !corner(k) => run.push(sides[k]),
            _ => found.push(vec![sides[k]]),
        }
    }
    found
}

/// The surface of a field inside its border. Where that is the whole square it has four sides and no loop.
pub fn surface(field: Field, runs: &[Vec<TriangleSide>], points: usize, origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let curves: Vec<Curve> = runs.iter().map(|run| curve(&field, run, origin)).collect();
    let corner = |run: &Vec<TriangleSide>| field.pieces()[run[0].piece].corners[0];
    let corners: Vec<DVec2> = runs.iter().map(corner).collect();
    let square = corners.len() == 4 && corners.iter().all(|c| c.distance(c.round()) <= NUDGE * NUDGE);
    let triangles = field.pieces().len() / 3;
    let base = Surface::new(Parts {
        origin,
        kind: SurfaceKind::Scatter,
        flow: format!("{points} points, {triangles} triangles"),
        domain: Domain::Square,
        closed: (false, false),
        borders: (0..4).map(|_| Border::straight(Edge::Free)).collect(),
        kinks: (Vec::new(), Vec::new()),
        shape: Shape::Scatter(field),
        chains: Vec::new(),
        generated: Vec::new(),
        trim: None,
        flipped: false,
    });
    if square {
        return Ok(base);
    }
    let mut trim_loop = TrimLoop { borders: Vec::new(), trim_curves: Vec::new(), chains: Vec::new() };
    for (curve, start) in curves.iter().zip(corners) {
        let chain = Chain::of_curve(curve);
        let pcurve = Pcurve::follow(&base, &chain, (0.0, 1.0), start, tolerance.point).map_err(|off| {
            let (off, at) = (off.distance, off.at);
            Fault::from(BorderFault::LoopOutsideSurface { of: origin, surface: origin, off, at, tolerance: tolerance.point })
        })?;
        trim_loop.borders.push(Border::chain(chain.clone(), false));
        trim_loop.trim_curves.push(TrimCurve::Pcurve(Arc::new(pcurve)));
        trim_loop.chains.push(chain);
    }
    let made = assembled(&base, vec![trim_loop], origin)?;
    Ok(Surface::new(Parts { kind: SurfaceKind::Scatter, ..made.parts().clone() }))
}

/// The curve of the surface over a run of sides: the cubics of the pieces along it.
fn curve(field: &Field, run: &[TriangleSide], origin: Origin) -> Curve {
    let mut t = 0.0;
    let cubic = |side: &TriangleSide| {
        let piece = &field.pieces()[side.piece];
        let (a, b) = (piece.corners[0], piece.corners[1]);
        let poles: Vec<DVec3> = (0..4).zip(piece.side_heights()).map(|(k, h)| field.lifted(a.lerp(b, f64::from(k) / 3.0), h)).collect();
        let from = t;
        t += poles[0].distance(poles[3]);
        Nurbs::bezier(from, t, poles.iter().map(|p| p.extend(1.0)).collect())
    };
    let cubics: Vec<Nurbs> = run.iter().map(cubic).collect();
    Curve::new(CurveShape::Nurbs(Arc::new(Nurbs::joined(&cubics))), Kind::Iso, origin)
}
