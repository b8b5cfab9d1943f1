//! `shade:`: what the colours of faces show.

use std::sync::Arc;

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

/// Share of places whose curvature lies inside the scale: a few sharp places do not take all colours.
const MOST_PLACES: f64 = 0.98;

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

/// The scale of curvatures, as far to either side of zero as nearly all places are.
fn of_curvature(spec: &PictureSpec, drawing: &mut Drawing, of: Origin, unit: &str) -> Result<(), Halt> {
    needs(drawing, of, &format!("`shade: {}` colours surfaces, and none is drawn", word(spec)), "draw a surface or a shell")?;
    let mut sizes: Vec<f64> = values(drawing).map(f64::abs).collect();
    sizes.sort_by(f64::total_cmp);
    let most = sizes.get(((sizes.len() as f64 - 1.0) * MOST_PLACES) as usize).copied().unwrap_or(0.0);
    let (title, power) = match bend(spec) {
        Some(Bend::Gauss) => ("Gauss curvature", 2),
        Some(Bend::Mean) => ("mean curvature", 1),
        _ => ("curvature", 1),
    };
    // A plane has no curvature; its scale is from −1 to 1.
    let least = f64::from(f32::EPSILON) / crate::base::math::powi(drawn_size(drawing), power);
    let most = if most > least { most } else { 1.0 };
    let unit = if power == 1 { format!("1/{unit}") } else { format!("1/{unit}{power}") };
    drawing.scale = Some(Scale { title: title.to_owned(), unit, low: -most, high: most, ramp: BELOW_TO_ABOVE });
    Ok(())
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
