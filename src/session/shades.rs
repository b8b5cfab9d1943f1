//! `shade:`: what the colours of faces show.

use std::sync::Arc;

use crate::base::math;
use crate::base::origin::Origin;
use crate::draw::color::{BACK, BAD_TO_GOOD, BELOW_TO_ABOVE, FRONT, LITTLE_TO_MUCH, NAMES};
use crate::draw::faces::{Bend, Show};
use crate::draw::meshes::{self, Measure};
use crate::draw::{Paint, Scale, Scene as Drawing, Sheet};
use crate::io::files::fault::FormatFault;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::plans::PictureSpec;
use crate::mesh::Mesh;

/// Share of the area that is bent whose curvature lies inside the scale: a few sharp places do not take all colours.
const MOST: f64 = 0.95;
/// The turn of the normal over the size of the model below which a place is flat, radians.
const FLAT: f64 = 1e-4;

fn word(spec: &PictureSpec) -> &str {
    spec.shade.as_ref().map_or("plain", |s| &s.0)
}

/// Whether the shade is a property of surfaces, so that these are drawn instead of their meshes.
pub(super) fn is_of_surfaces(spec: &PictureSpec) -> bool {
    bend(spec).is_some()
}

/// The curvature that is shown, if any.
fn bend(spec: &PictureSpec) -> Option<Bend> {
    match word(spec) {
        "curvature" => Some(Bend::Principal),
        "mean" => Some(Bend::Mean),
        "gauss" => Some(Bend::Gauss),
        _ => None,
    }
}

/// What the points of surfaces have to show.
pub(super) fn of_faces(spec: &PictureSpec) -> Show {
    match (word(spec), bend(spec)) {
        (_, Some(bend)) => Show::Curvature(bend),
        ("zebra" | "reflection" | "isophotes", _) => Show::Stripes,
        _ => Show::Light,
    }
}

/// A mesh as sheets that can be shaded as asked.
pub(super) fn mesh_sheets(spec: &PictureSpec, mesh: &Arc<Mesh>) -> Vec<Sheet> {
    match word(spec) {
        "quality" => vec![meshes::whole(mesh, Measure::Quality)],
        "size" => vec![meshes::whole(mesh, Measure::Size)],
        "zebra" | "reflection" | "isophotes" => meshes::by_face(mesh, true),
        "names" => meshes::by_face(mesh, false),
        _ => vec![meshes::whole(mesh, Measure::Light)],
    }
}

/// Paints the sheets of a scene and says what the colours mean.
///
/// Fails with E805 where a shade speaks of something that is not drawn.
pub(super) fn paint(cx: &Cx, spec: &PictureSpec, drawing: &mut Drawing) -> Result<(), Halt> {
    let of = spec.shade.as_ref().map_or(Origin::NONE, |s| s.1);
    let unit = cx.unit().name;
    match word(spec) {
        "names" => by_name(drawing),
        "side" => drawing.sheets.iter_mut().for_each(|s| s.paint = Paint::Sides(FRONT, BACK)),
        "zebra" => drawing.sheets.iter_mut().for_each(|s| s.paint = Paint::Zebra),
        "reflection" => drawing.sheets.iter_mut().for_each(|s| s.paint = Paint::Reflections),
        "isophotes" => drawing.sheets.iter_mut().for_each(|s| s.paint = Paint::Isophotes),
        "quality" => {
            needs(drawing, of, "`shade: quality` colours the elements of a mesh, and none is drawn", "draw a mesh")?;
            drawing.scale = Some(Scale { title: "quality".to_owned(), unit: String::new(), low: 0.0, high: 1.0, ramp: BAD_TO_GOOD });
        }
        "size" => {
            needs(drawing, of, "`shade: size` colours the elements of a mesh, and none is drawn", "draw a mesh")?;
            let (low, high) = values(drawing).fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), x| (l.min(x), h.max(x)));
            // Elements of one size all the same are shown by a scale from zero.
            let low = if high - low > 0.001 * high { low } else { 0.0 };
            let high = if high > low { high } else { low + 1.0 };
            drawing.scale = Some(Scale { title: "longest side".to_owned(), unit: unit.to_owned(), low, high, ramp: LITTLE_TO_MUCH });
        }
        "curvature" | "mean" | "gauss" => of_curvature(spec, drawing, of, unit)?,
        _ => {}
    }
    Ok(())
}

/// The scale of curvatures, as far to either side of zero as nearly all of the area that is bent is.
fn of_curvature(spec: &PictureSpec, drawing: &mut Drawing, of: Origin, unit: &str) -> Result<(), Halt> {
    needs(drawing, of, &format!("`shade: {}` colours surfaces, and none is drawn", word(spec)), "draw a surface or a shell")?;
    let (title, power) = match bend(spec) {
        Some(Bend::Gauss) => ("Gauss curvature", 2),
        Some(Bend::Mean) => ("mean curvature", 1),
        _ => ("curvature", 1),
    };
    // A plane has no curvature; its scale is from −1 to 1.
    let most = most(bent(drawing, math::powi(FLAT / drawn_size(drawing), power))).unwrap_or(1.0);
    let unit = if power == 1 { format!("1/{unit}") } else { format!("1/{unit}{power}") };
    drawing.scale = Some(Scale { title: title.to_owned(), unit, low: -most, high: most, ramp: BELOW_TO_ABOVE });
    Ok(())
}

/// Sizes of curvatures above `flat` with the areas that have them.
fn bent(drawing: &Drawing, flat: f64) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for sheet in &drawing.sheets {
        let Paint::OfPoints(values) = &sheet.paint else { continue };
        for corners in &sheet.triangles {
            let [a, b, c] = corners.map(|k| sheet.points[k as usize]);
            let area = (b - a).cross(c - a).length();
            found.extend(corners.map(|k| (f64::from(values[k as usize]).abs(), area)));
        }
    }
    found.retain(|(size, _)| size.is_finite() && *size > flat);
    found
}

/// The size that nearly all of the area is below; `None` without area.
fn most(mut places: Vec<(f64, f64)>) -> Option<f64> {
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    let wanted = MOST * places.iter().map(|(_, area)| area).sum::<f64>();
    let mut below = 0.0;
    let inside = |(_, area): &&(f64, f64)| {
        below += area;
        below >= wanted
    };
    places.iter().find(inside).map(|(size, _)| *size)
}

fn drawn_size(drawing: &Drawing) -> f64 {
    crate::base::bbox::Box3::of(drawing.sheets.iter().flat_map(|s| s.points.iter().copied())).diagonal().max(f64::MIN_POSITIVE)
}

fn values(drawing: &Drawing) -> impl Iterator<Item = f64> + '_ {
    let of = |sheet: &'_ Sheet| match &sheet.paint {
        Paint::OfTriangles(values) | Paint::OfPoints(values) => values.clone(),
        _ => Vec::new(),
    };
    drawing.sheets.iter().flat_map(of).map(f64::from).filter(|x| x.is_finite())
}

fn needs(drawing: &Drawing, of: Origin, what: &str, help: &str) -> Result<(), Halt> {
    match values(drawing).next() {
        Some(_) => Ok(()),
        None => Err(FormatFault::Unsupported { of, what: what.to_owned(), help: Some(help.to_owned()), edits: Vec::new() }.into()),
    }
}

/// A colour for each name, in order of appearance.
fn by_name(drawing: &mut Drawing) {
    let mut found: Vec<String> = Vec::new();
    for sheet in &mut drawing.sheets {
        let k = found.iter().position(|n| *n == sheet.name).unwrap_or_else(|| {
            found.push(sheet.name.clone());
            found.len() - 1
        });
        sheet.paint = Paint::Even(NAMES[k % NAMES.len()]);
    }
    drawing.keys = found.into_iter().enumerate().map(|(k, name)| (NAMES[k % NAMES.len()], name)).collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sharp edge has many points and hardly any area.
    #[test]
    fn the_scale_is_that_of_nearly_all_of_the_area() {
        let sharp = (0..900).map(|_| (50.0, 0.001));
        let places = sharp.chain((0..100).map(|k| (0.01 * f64::from(k), 1.0))).collect();
        assert!((most(places).unwrap() - 0.95).abs() < 0.02);
        assert_eq!(most(Vec::new()), None);
    }
}
