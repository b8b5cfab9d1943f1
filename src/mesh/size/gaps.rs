//! How far glued borders run beside the faces they bound: what is left of a chord error there.
//!
//! An edge that two faces share lies on one of them, or on neither. Its nodes are then off the other face by up to the gap, and
//! a triangle at them is off by that and by the bend: steps beside the gap have the limit less the gap for the bend.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::par;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::chart::face_border::places;
use crate::mesh::request::fault::SizeFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::model::segments::SegmentUse;
use crate::surface::{Domain, Surface, foot_within};

/// Places along a segment at which gaps and bends are sampled, less one.
pub const PLACES: usize = 64;
/// Least share of a chord error that a gap has to leave to the bend: a tenth of the step that would do without a gap.
const MIN_LEFT_SHARE: f64 = 0.01;
/// Share of the tolerance up to which a distance is not refined.
pub const SLIGHT: f64 = 0.001;

/// A segment beside a face, from its start to its end.
pub struct SegmentBeside {
    /// Places in (u, v) of the face.
    pub places: Vec<(f64, f64)>,
    /// Points of the segment.
    pub points: Vec<DVec3>,
    /// How far these are from the surface, model units.
    pub off: Vec<f64>,
}

impl SegmentBeside {
    /// Of points of a segment with their places on the surface.
    pub fn new(surface: &Surface, places: Vec<(f64, f64)>, points: Vec<DVec3>, slight: f64) -> Self {
        let off = places.iter().zip(&points).map(|(uv, p)| distance(surface, *p, *uv, slight)).collect();
        Self { places, points, off }
    }
}

/// How far a point is from a surface near a place; one up to `slight` is not refined.
pub fn distance(surface: &Surface, p: DVec3, place: (f64, f64), slight: f64) -> f64 {
    let first = p.distance(surface.point(place.0, place.1));
    if first <= slight {
        return first;
    }
    let over = |closed: bool| if closed { (f64::NEG_INFINITY, f64::INFINITY) } else { (0.0, 1.0) };
    let (u, v) = if surface.domain() == Domain::Loop { surface.closed() } else { (false, false) };
    foot_within(surface.evaluator(), p, place, over(u), over(v)).0
}

/// A segment as one side of a face has it.
fn beside(input: &Input, layout: &Layout, own: &Face, side: usize, u: &SegmentUse) -> SegmentBeside {
    let surface = &input.model.surfaces[own.surface.index()].surface;
    let share = |i: usize| i as f64 / PLACES as f64;
    let points: Vec<DVec3> = (0..=PLACES).map(|i| layout.point(u.segment, share(i))).collect();
    let flat = points.iter().map(|p| surface.flat_uv(*p)).collect::<Option<Vec<_>>>();
    let places = flat.unwrap_or_else(|| {
        let lengths: Vec<f64> = (0..=PLACES).map(|i| u.s.0 + (u.s.1 - u.s.0) * share(i)).collect();
        let mut places = places(input, own, side, &lengths);
        if u.against {
            places.reverse();
        }
        places
    });
    SegmentBeside::new(surface, places, points, input.tolerance.point * SLIGHT)
}

/// What is left of a chord error for the bend where an edge is so far off the surface; never 0.
pub fn remaining_chord_error(limit: f64, off: f64) -> f64 {
    (limit - off).max(limit * MIN_LEFT_SHARE)
}

/// What runs beside each face, side by side, where limits depend on it: free faces with bends, and those whose borders
/// do not come from themselves.
pub fn rows(input: &Input, layout: &Layout, limits: &Limits) -> Vec<Vec<SegmentBeside>> {
    par::map(layout.faces.len(), |f| {
        let own = &layout.faces[f];
        let surface = &input.model.surfaces[own.surface.index()].surface;
        let bends = own.free && !surface.is_flat() && (limits.chord.is_some() || limits.angle.is_some());
        let needed = bends || limits.chord.is_some() && is_off(input, own, surface);
        // Converted once for all sides.
        let _power_form = if needed { surface.power_form() } else { None };
        let sides = own.sides.iter().enumerate().filter(|_| needed);
        sides.flat_map(|(k, side)| side.uses.iter().map(move |u| beside(input, layout, own, k, u))).collect()
    })
}

/// Whether borders of a face may run beside it.
fn is_off(input: &Input, own: &Face, surface: &Surface) -> bool {
    own.near > input.tolerance.point || surface.domain() == Domain::Loop
}

/// E703 where an edge is glued so far beside a face that nothing is left of the chord error.
pub fn refuse(input: &Input, layout: &Layout, limits: &Limits, rows: &[Vec<SegmentBeside>]) -> Result<()> {
    let (Some(limit), Some((_, written_at))) = (limits.chord, input.plan.settings.chord_error) else { return Ok(()) };
    for (face, rows) in layout.faces.iter().zip(rows) {
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let all = rows.iter().filter(|_| is_off(input, face, surface)).flat_map(|row| row.off.iter().zip(&row.points));
        let (gap, at) = all.fold((0.0, DVec3::ZERO), |found, (gap, at)| if *gap > found.0 { (*gap, *at) } else { found });
        if gap > limit * (1.0 - MIN_LEFT_SHARE) {
            return Err(SizeFault::GapTooWide { gap, limit: (limit, written_at), surface: surface.origin(), at }.into());
        }
    }
    Ok(())
}
