//! One section on one guide: exact surfaces.

use glam::DMat3;

use crate::base::fault::{Fault, Result};
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::geometry::curves::curve::Shape;
use crate::network::Chain;
use crate::surface::core::surface::Surface;
use crate::surface::swept::along::{AlongSettings, along, moved_by};
use crate::surface::swept::laws::{Law, Main, check_section, plane_normal};
use crate::surface::swept::revolve::{Axis, revolve};
use crate::surface::swept::sections::{Guide, Section, apart};
use crate::surface::swept::sweep_input::{Input, renamed};

/// The surface where it starts at the guide's start, after the law's checks; none where the section stands elsewhere.
pub fn single(section: &Chain, guide: &Chain, input: &Input, tolerance: &Tolerance) -> Result<Option<(Surface, Vec<Fault>)>> {
    let given = Guide::new(guide);
    let Ok(met) = Section::meeting(section, std::slice::from_ref(&given), tolerance)? else {
        return Err(apart(section, &given));
    };
    let near = tolerance.point / guide.length();
    let (at, closed) = (met.on_guides[0], guide.is_closed(tolerance));
    let path = match (at <= near, at >= 1.0 - near) {
        (true, _) => guide.clone(),
        (_, true) => guide.reversed(),
        _ if closed => guide.slice(at, at, tolerance)?,
        _ => return Ok(None),
    };
    let normal = plane_normal(section);
    let mut main = Main::new(&path, input.law, normal, tolerance)?;
    if input.law != Law::Synchronized {
        check_section(section, &main.station(0.0), input.law, (section, guide), tolerance)?;
    }
    let settings = AlongSettings { twist: 0.0, round: false, origin: input.origin };
    let (surface, notes) = match input.law {
        Law::Normal => along(section, &path, &settings, tolerance)?,
        Law::Parallel | Law::Synchronized => moved_by(section, &path, &settings, &mut |_| DMat3::IDENTITY, tolerance)?,
        Law::Rotational(axis) => match turned(section, &path, &axis, input, tolerance)? {
            Some(surface) => (surface, Vec::new()),
            None => moved_by(section, &path, &settings, &mut |u| main.station(u).turn, tolerance)?,
        },
    };
    Ok(Some((renamed(&surface, input), notes)))
}

/// The surface of revolution where the guide is an arc about the axis.
fn turned(section: &Chain, path: &Chain, axis: &Axis, input: &Input, tolerance: &Tolerance) -> Result<Option<Surface>> {
    let curve = path.to_curve()?;
    let Shape::Arc(arc) = curve.shape() else { return Ok(None) };
    let normal = arc.u.cross(arc.v).normalize_or_zero();
    let about = (arc.center - axis.about).reject_from_normalized(axis.direction).length() <= tolerance.point;
    if arc.radius.is_none() || !about || normal.cross(axis.direction).length() > PARALLEL {
        return Ok(None);
    }
    let angle = if normal.dot(axis.direction) < 0.0 { -arc.sweep } else { arc.sweep };
    revolve(section, axis, angle, input.origin, tolerance).map(Some)
}
