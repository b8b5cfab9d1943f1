//! Where curves meet in space.
//!
//! `search` isolates meetings with guaranteed bounds and settles crossings, `contact` works out where curves run
//! along each other, `merge` makes each meeting one hit.

pub mod circles;
pub mod contact;
pub mod merge;
pub mod newton;
pub mod search;

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::tolerance::Tolerance;
use crate::base::work;
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::fault::CurveFault;
use crate::geometry::query::intersect::newton::segments;
use crate::geometry::query::intersect::search::{Found, Rect, Search, Side};

/// Pairs of parts that are looked at in the time of an evaluation of a curve.
const PER_EVALUATION: u64 = 2;

/// One meeting of two curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hit {
    /// They come within the tolerance at one place.
    Point {
        /// Parameter on the first curve.
        ta: f64,
        /// Parameter on the second curve.
        tb: f64,
        /// The mean of the two points.
        at: DVec3,
        /// Distance of the two points, model units.
        gap: f64,
        /// Whether they touch without crossing; at an end, whether their directions are parallel.
        tangent: bool,
    },
    /// They run within the tolerance of each other.
    Overlap {
        /// Ascending parameters on the first curve.
        a: (f64, f64),
        /// Parameters on the second curve at the same ends; descending when it runs the other way.
        b: (f64, f64),
    },
}

impl Hit {
    /// First parameter on the first curve.
    pub fn start(&self) -> f64 {
        match self {
            Self::Point { ta, .. } => *ta,
            Self::Overlap { a, .. } => a.0,
        }
    }
}

/// All meetings of two curves within `tolerance.point`, ordered along `a`.
///
/// A tangential contact is one hit; two crossings are two as long as they are further apart than the tolerance. An
/// end that lies on the other curve within the tolerance is a hit at exactly that end. On a closed curve the first
/// parameter stands for the last one too. E413 when the work exceeds its limit.
pub fn intersect(a: &Curve, b: &Curve, tolerance: &Tolerance) -> Result<Vec<Hit>> {
    let mut buffers = SearchBuffers::default();
    intersect_with(a, b, tolerance, &mut buffers)?;
    Ok(buffers.hits)
}

/// The lists of a search, kept from pair to pair so that they are allocated once.
#[derive(Default)]
pub(crate) struct SearchBuffers {
    found: Vec<Found>,
    near: Vec<Rect>,
    /// All meetings, ordered along the first curve.
    pub(crate) hits: Vec<Hit>,
}

/// As [`intersect`], with the hits in `buffers`, which are emptied first.
pub(crate) fn intersect_with(a: &Curve, b: &Curve, tolerance: &Tolerance, buffers: &mut SearchBuffers) -> Result<()> {
    buffers.hits.clear();
    if let (&Shape::Line(a0, a1), &Shape::Line(b0, b1)) = (a.shape(), b.shape()) {
        let apart = segments((a0, a1), (b0, b1)).0;
        if apart > tolerance.point * tolerance.point || apart.is_nan() {
            return Ok(());
        }
    }
    let (mut own_a, mut own_b) = (None, None);
    let mut search = Search::new(Side::passing(a, &mut own_a), Side::passing(b, &mut own_b), tolerance.point, buffers);
    search.run();
    finish(&mut search, tolerance, buffers)
}

/// Where a curve meets itself, other than the common ends of a closed one.
pub fn self_intersect(curve: &Curve, tolerance: &Tolerance) -> Result<Vec<Hit>> {
    let side = Side::of(curve);
    let mut buffers = SearchBuffers::default();
    let mut search = Search::new(side, side, tolerance.point, &mut buffers);
    search.run_self();
    finish(&mut search, tolerance, &mut buffers)?;
    let mut hits = buffers.hits;
    hits.retain(|hit| match hit {
        Hit::Point { ta, tb, .. } => !merge::same_place(curve, *ta, *tb, tolerance.point),
        Hit::Overlap { .. } => true,
    });
    Ok(hits)
}

/// Turns what a search found into hits and gives its buffers back.
fn finish(search: &mut Search, tolerance: &Tolerance, buffers: &mut SearchBuffers) -> Result<()> {
    work::spend(search.looked_at as u64 / PER_EVALUATION);
    if let Some(at) = search.exhausted {
        let what = "where two curves meet".to_owned();
        return Err(CurveFault::NotConverged { of: search.a.curve.origin(), what, at }.into());
    }
    let shared = if search.near.is_empty() { Vec::new() } else { contact::resolve(search, tolerance) };
    merge::hits(search, &shared, tolerance, &mut buffers.hits);
    (buffers.found, buffers.near) = (std::mem::take(&mut search.found), std::mem::take(&mut search.near));
    Ok(())
}
