//! The box that a surface just fits into.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::tolerance::{BOX, EPSILON};
use crate::surface::closest::boxed::{Boxed, MOST, Sample, extremes, halves};
use crate::surface::closest::curve_extent::curve_bbox;
use crate::surface::closest::samples::stations;
use crate::surface::closest::trimmed_extent::trimmed_bbox;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::rails::side::Side;

/// The smallest box along the axes that holds the surface, see [`boxed`].
pub fn bbox(surface: &Surface) -> Box3 {
    boxed(surface).bounds
}

/// The smallest box along the axes that holds the surface: no point of it stands out by more than [`BOX`] of the diagonal.
///
/// A descent from the extreme samples finds extreme points; bounds of the surface over ever smaller rectangles then show
/// that nothing lies further out, or find what does. What a trimmed one has inside its borders is found the same way (`trimmed_extent.rs`).
///
/// After a bounded number of rectangles what is left is taken by its bound: the box is then too large, and says by how much at most.
pub fn boxed(surface: &Surface) -> Boxed {
    if surface.domain() == Domain::Unbounded {
        return Boxed::of(Box3 { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY });
    }
    if surface.domain() == Domain::Loop {
        return trimmed_bbox(surface);
    }
    let chain = |k: usize| if let Side::Chain { chain, .. } = surface.side(k) { Some(chain) } else { None };
    // A flat face reaches no farther than its borders.
    if surface.is_flat()
        && let Some(chains) = (0..surface.n_sides()).map(chain).collect::<Option<Vec<_>>>()
    {
        return Boxed::of(chains.iter().fold(Box3::EMPTY, |bounds, chain| bounds.union(curve_bbox(chain))));
    }
    let (us, vs) = surface.cells();
    let (xs, ys) = (stations(&us), stations(&vs));
    let jets = surface.square_jets(&xs, &ys);
    let bounds = Box3::of(jets.iter().map(|jet| jet.p));
    let samples: Vec<Sample> = (0..jets.len()).map(|k| ((xs[k % xs.len()], ys[k / xs.len()]), jets[k].p)).collect();
    proved(surface, extremes(surface, &samples).into_iter().fold(bounds, |bounds, (_, p)| bounds.with(p)))
}

/// The side of a triangle along which u + v = 1.
const SLANT: usize = 1;

/// The box of what of a triangle lies over the corner of a rectangle, which the side with u + v = 1 cuts, by the box of that side: each
/// point is on the way along u, or along v, to that side, and on the way from the corner.
fn below_slant(surface: &Surface, corner: (f64, f64), slant: Box3) -> Box3 {
    let step = 1.0 - corner.0 - corner.1;
    // All ways there stay in the square over the corner.
    let enclosure = surface.enclosure((corner.0, 1.0 - corner.1), (corner.1, 1.0 - corner.0));
    let at = surface.point(corner.0, corner.1);
    let none = DVec3::ZERO;
    let (up, down) = ((enclosure.du.high.max(none), enclosure.dv.high.max(none)), (enclosure.du.low.min(none), enclosure.dv.low.min(none)));
    let high = (slant.max - down.0 * step).min(slant.max - down.1 * step).min(at + up.0.max(up.1) * step);
    let low = (slant.min - up.0 * step).max(slant.min - up.1 * step).max(at + down.0.min(down.1) * step);
    Box3 { min: low, max: high }
}

/// Grows a box of points of the surface until it holds the surface, by branch and bound.
fn proved(surface: &Surface, bounds: Box3) -> Boxed {
    let triangle = surface.domain() == Domain::Triangle;
    let slant = match surface.side(SLANT) {
        Side::Chain { chain, from, to } if triangle && from.min(to) <= 0.0 && from.max(to) >= 1.0 => Some(curve_bbox(&chain)),
        _ => None,
    };
    let mut grown = Boxed::of(slant.map_or(bounds, |slant| bounds.union(slant)));
    let (us, vs) = surface.cells();
    let stops = |inner: &[f64]| [&[0.0], inner, &[1.0]].concat();
    let (us, vs) = (stops(&us), stops(&vs));
    let mut open: std::collections::VecDeque<((f64, f64), (f64, f64))> =
        vs.windows(2).flat_map(|v| us.windows(2).map(move |u| ((u[0], u[1]), (v[0], v[1])))).collect();
    let (room, mut seen) = (DVec3::splat(BOX * grown.bounds.diagonal()), 0);
    while let Some((u, v)) = open.pop_front() {
        job::poll();
        if triangle && u.0 + v.0 >= 1.0 {
            continue;
        }
        let enclosure = surface.enclosure(u, v);
        // Points reached count at once; the middle of a rectangle over the slant is none.
        if !triangle || u.1 + v.1 <= 1.0 {
            grown = grown.with(enclosure.mid.p);
        }
        let mut hull = enclosure.p.bounds();
        if let Some(slant) = slant.filter(|_| u.1 + v.1 > 1.0) {
            let within = below_slant(surface, (u.0, v.0), slant);
            hull = Box3 { min: hull.min.max(within.min), max: hull.max.min(within.max) };
        }
        let over = (hull.max - grown.bounds.max).max(grown.bounds.min - hull.min);
        if (0..3).all(|k| over[k] <= room[k]) {
            continue;
        }
        seen += 1;
        let (a, b) = (u.1 - u.0, v.1 - v.0);
        if seen > MOST || a.max(b) <= EPSILON {
            grown = grown.held_by(hull);
            continue;
        }
        // In the direction in which the coordinate that stands out most runs most.
        let k = (0..3).max_by(|x, y| over[*x].total_cmp(&over[*y])).unwrap_or(0);
        open.extend(halves((u, v), enclosure.du.coordinate(k).reach() * a >= enclosure.dv.coordinate(k).reach() * b));
    }
    grown
}
