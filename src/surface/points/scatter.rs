//! `scatter`: a smooth surface through scattered points, a height over their mean plane or along a direction.
//!
//! The points are triangulated in that plane [Delaunay 1934]; over each triangle lie three cubics [Clough & Tocher 1965] that meet
//! the gradients estimated at its corners. The border is the convex hull of the points, without thin triangles along it.

use glam::{DVec2, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::base::triangulate::delaunay;
use crate::geometry::data::fault::CurveFault;
use crate::surface::core::surface::Surface;
use crate::surface::faults::ScatterFault;
use crate::surface::points::scatter::plane::{Cloud, cloud, on_one_line};
use crate::surface::shapes::cubic_triangle::{Corner, pieces};
use crate::surface::shapes::frame::Frame;
use crate::surface::shapes::height_field::Field;

pub mod border;
pub mod plane;
pub mod slopes;

/// Steeper than this, rise over run, a side of a triangle deserves a word: the points may be of two sheets.
const STEEP: f64 = 10.0;

/// The surface through points, over the plane that comes nearest to them or across `along`; warnings too (W225, W226, W668).
///
/// Points within the tolerance of each other count once. Their order changes nothing. Fails with E402 below three points, E409
/// for an `along` without length, E665 where all points lie on one line of the plane, E675 where two lie over one another.
pub fn scatter(points: &[DVec3], along: Option<DVec3>, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let mut notes = Vec::new();
    let few = |given: usize| -> Fault {
        CurveFault::TooFewPoints { of: origin, what: "a surface through scattered points", argument: "points", needed: 3, given }.into()
    };
    if points.len() < 3 {
        return Err(few(points.len()));
    }
    let Cloud { plane, places, merged } = cloud(points, along, origin, tolerance)?;
    if let Some((count, at)) = merged {
        notes.push(ScatterFault::Merged { surface: origin, count, at, tolerance: tolerance.point }.into());
    }
    if places.len() < 3 {
        return Err(few(places.len()));
    }
    let flat: Vec<DVec2> = places.iter().map(|p| p.truncate()).collect();
    let (low, high) = flat.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    let size = high - low;
    let unit = size.max_element();
    let scaled: Vec<DVec2> = flat.iter().map(|p| (*p - low) / unit).collect();
    let (triangles, sides) = border::peeled(delaunay(&scaled), &flat, tolerance.point);
    if triangles.is_empty() {
        return Err(on_one_line(points, &flat, origin));
    }
    notes.extend(steepest(&places, &triangles, origin, |p| plane.place(p)));
    let gradients = slopes::slopes(&places, &triangles);
    let corner = |k: usize| Corner { at: flat[k] - low, h: places[k].z, slope: gradients[k] };
    let beside = border::opposite(&triangles);
    let made = triangles.iter().zip(beside).flat_map(|(t, others)| {
        job::poll();
        pieces(&t.map(corner), others.map(|other| other.map(|k| flat[k] - low)), size)
    });
    let made = made.collect();
    let [ex, ey] = plane.axes;
    let frame = Frame { origin: plane.place(low.extend(0.0)), eu: ex * size.x, ev: ey * size.y };
    let rim: Vec<usize> = sides.iter().map(|side| side.piece).collect();
    let field = Field::new(frame, plane.normal, made, &rim);
    notes.extend(standing_out(&places, &field, origin));
    let count = places.len();
    let surface = border::surface(field, &border::runs(&sides, &flat, tolerance), count, origin, tolerance)?;
    Ok((surface, notes))
}

/// Share of the range of all heights beyond which a surface that stands out over it deserves a word.
const OUT: f64 = 0.5;

/// W226 for the place that is farthest beyond the heights of all points, where that is far.
fn standing_out(places: &[DVec3], field: &Field, origin: Origin) -> Option<Fault> {
    let (low, high) = places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.z), b.max(p.z)));
    let (off, at) = field.beyond_heights(low, high)?;
    (off > OUT * (high - low)).then(|| ScatterFault::StandsOut { surface: origin, at, off, range: high - low }.into())
}

/// W668 for the steepest side of all triangles, where it is very steep.
fn steepest(places: &[DVec3], triangles: &[[usize; 3]], origin: Origin, place: impl Fn(DVec3) -> DVec3) -> Option<Fault> {
    let sides = triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    let rise = |(a, b): (usize, usize)| {
        let d = places[b] - places[a];
        d.z.abs() / d.truncate().length()
    };
    let worst = sides.map(|side| (side.0.min(side.1), side.0.max(side.1))).max_by(|a, b| rise(*a).total_cmp(&rise(*b)))?;
    let steep = rise(worst);
    (steep > STEEP).then(|| ScatterFault::Steep { surface: origin, a: place(places[worst.0]), b: place(places[worst.1]), steep }.into())
}
