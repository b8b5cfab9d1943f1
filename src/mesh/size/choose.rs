//! How each face is made: mapped where it can be and no other method is written, else freely.

use crate::base::fault::Result;
use crate::base::text::real;
use crate::base::tolerance::Tolerance;
use crate::mesh::border::layout::{Face, Layout, Uneven, middle};
use crate::mesh::request::fault::FaceFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::{Elements, Method};
use crate::surface::{Domain, Surface};

/// Chooses how each face is made: mapped where it can be and no other method is written, else freely.
///
/// Fails with E705 for faces that cannot be mapped but must, or have no border.
pub fn choose(input: &Input, layout: &mut Layout) -> Result<()> {
    for face in &mut layout.faces {
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let crossed = || (!face.lines.is_empty() || !face.points.is_empty()).then(|| crossed(face));
        let uneven = || {
            face.uneven.map(|why| match why {
                Uneven::Row(step) => format!("with a piece of border of {}, as narrow as a row would be", short(step)),
                Uneven::Beside(step) => format!("beside a free one that needs steps of {}, which rows do not follow", short(step)),
                Uneven::Crowded(times) => {
                    format!("whose map is nearly one point along a part of a side: {} times the elements", short(times))
                }
                Uneven::Together => "whose map would coincide with that of another face".to_owned(),
                Uneven::Sharp(angle) => format!("whose map would have angles of {}°", short(angle.to_degrees())),
            })
        };
        let why = unmappable(surface, face, input.tolerance).or_else(crossed).or_else(uneven).or_else(|| pole(face));
        let (of, at) = (surface.origin(), middle(input, face));
        let borderless = face.sides.iter().all(|s| s.uses.is_empty());
        if let Some(why) = why.clone().filter(|_| face.method == Method::Mapped || borderless) {
            let help = (face.method == Method::Mapped).then(|| match surface.sides_without_map(input.tolerance) {
                Some(_) => "without `method: mapped` the face is meshed freely; to map it, divide it into faces of three or four sides without inner corners",
                None => "without `method: mapped` the face is meshed freely",
            });
            return Err(FaceFault::CannotMap { surface: of, why, at, help }.into());
        }
        face.free = face.method.is_free() || why.is_some();
        face.why = why.filter(|_| !face.method.is_free());
        if let Some(method) = face.method.of_triangles().filter(|_| face.takes_quads()) {
            return Err(FaceFault::TrianglesOnly { of: input.plan.origin, method, surface: of, at }.into());
        }
    }
    Ok(())
}

/// Why a face of quads without a written method is not mapped, in words that follow "a face".
pub(crate) fn pole(face: &Face) -> Option<String> {
    let is_quads = face.method == Method::Auto && face.elements == Elements::Quads && !face.is_triangle();
    (is_quads && face.sides.iter().any(|side| side.uses.is_empty())).then(|| "with a pole, where a map would make triangles".to_owned())
}

/// A length with three digits that count.
pub(crate) fn short(x: f64) -> String {
    real(format!("{x:.2e}").parse().unwrap_or(x))
}

/// What lies inside a face, in words that follow "a face".
pub(crate) fn crossed(face: &Face) -> String {
    let some = |n: usize, one: &str, many: &str| if n == 1 { one.to_owned() } else { format!("{n} {many}") };
    let lines = some(face.lines.len(), "a curve", "pieces of curves");
    let points = some(face.points.len(), "a point", "points");
    match (face.lines.is_empty(), face.points.is_empty()) {
        (false, true) => format!("with {lines} inside, off its mesh lines"),
        (true, _) => format!("with {points} inside, off its mesh lines"),
        (false, false) => format!("with {lines} and {points} inside, off its mesh lines"),
    }
}

/// Why a face cannot be mapped, in words that follow "a face".
fn unmappable(surface: &Surface, face: &Face, tolerance: &Tolerance) -> Option<String> {
    if let Some(sides) = surface.sides_without_map(tolerance) {
        return Some(format!("with {sides} sides between which a map folds over or nearly does"));
    }
    if matches!(surface.domain(), Domain::Loop | Domain::Unbounded) {
        return Some(match surface.domain() {
            Domain::Loop if face.sides.len() == 1 => "with one side and no map".to_owned(),
            Domain::Loop => format!("with {} sides and no map between them", face.sides.len()),
            _ => "without borders".to_owned(),
        });
    }
    let empty = |k: usize| face.sides[k].uses.is_empty();
    if face.is_triangle() {
        return (0..3).any(empty).then(|| "with three sides of which one is a point".to_owned());
    }
    (0..4).any(|k| empty(k) && empty((k + 1) % 4)).then(|| "with two neighbouring sides that are points".to_owned())
}
