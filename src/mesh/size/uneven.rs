//! Mapped faces that are better meshed freely: where a short piece of border would run through the whole face as a row of that
//! width, where their even rows meet borders of a free face that have, or need, much shorter steps, and where rows crowd.

use crate::mesh::border::layout::{Face, FaceSide, Layout, Uneven};
use crate::mesh::border::nodes::Nodes;
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::size::sizing::Sizing;

/// A step next to one shorter than this share of it makes angles below 7°.
const MIN_STEP_RATIO: f64 = 0.125;
/// Rows crowd where their cells are this many times those of the first division: a part of a side of the map is nearly one point.
const CROWDED: f64 = 20.0;
/// Fewer cells do not crowd.
const FEW_CELLS: f64 = 10_000.0;

/// Faces of triangles, mapped because no method is written, that are better meshed freely. What is written stays.
pub fn find(layout: &Layout, nodes: &Nodes, near: f64, sizing: &Sizing) -> Vec<(usize, Uneven)> {
    let mut required_on_mapped: Vec<Option<f64>> = vec![None; layout.pieces.segments.len()];
    for (k, spacing) in sizing.required_on_mapped.iter().enumerate() {
        let least = spacing.as_ref().map_or(f64::INFINITY, |spacing| spacing.least());
        required_on_mapped[k] = (least + near < MIN_STEP_RATIO * layout.length(k) / f64::from(nodes.count(k))).then_some(least);
    }
    let of = |face: &Face| {
        if face.free || face.method != Method::Auto || face.elements != Elements::Triangles || counted(face, sizing) {
            return None;
        }
        let beside = face.segments().filter_map(|k| required_on_mapped[k]).reduce(f64::min);
        row(face, nodes, near).map(Uneven::Row).or(beside.map(Uneven::Beside))
    };
    layout.faces.iter().enumerate().filter_map(|(f, face)| Some((f, of(face)?))).collect()
}

/// Faces mapped because no method is written of which rows have to be many times those of the first division to keep the size, where
/// only sizes limit their elements. Faces that keep their map after a free mesh had smaller angles are among them: the map has so many cells only now.
///
/// `rows_of_face` are the rows of each face, as in [`crate::mesh::divide::relations::Relations::of_face`].
pub fn crowded(input: &Input, layout: &Layout, rows_of_face: &[Vec<usize>], [first, now]: [&[u32]; 2]) -> Vec<(usize, Uneven)> {
    let settings = &input.plan.settings;
    if settings.chord_error.is_some() || settings.angle_error.is_some() {
        return Vec::new();
    }
    let of = |(f, (face, rows)): (usize, (&Face, &Vec<usize>))| {
        if face.free || face.method != Method::Auto || face.is_triangle() {
            return None;
        }
        let cells = |counts: &[u32]| f64::from(counts[rows[0]]) * f64::from(counts[rows[1]]);
        let (few, many) = (cells(first), cells(now));
        (many > FEW_CELLS && many > CROWDED * few).then_some((f, Uneven::Crowded(many / few)))
    };
    layout.faces.iter().zip(rows_of_face).enumerate().filter_map(of).collect()
}

/// Whether all steps of a side are written: rows are what is meant.
fn counted(face: &Face, sizing: &Sizing) -> bool {
    let all = |side: &FaceSide| !side.uses.is_empty() && side.uses.iter().all(|u| sizing.decisions[u.segment].count.is_some());
    face.sides.iter().any(all)
}

/// The shortest step of a side next to much longer ones.
fn row(face: &Face, nodes: &Nodes, near: f64) -> Option<f64> {
    let n = face.sides.len();
    let steps = |side: &FaceSide| -> Vec<f64> { side.uses.iter().map(|u| (u.s.1 - u.s.0) / f64::from(nodes.count(u.segment))).collect() };
    let all: Vec<Vec<f64>> = face.sides.iter().map(steps).collect();
    let longest = |k: usize| all[k].iter().copied().fold(0.0, f64::max);
    let mut found: Option<f64> = None;
    for (k, own) in all.iter().enumerate() {
        // A row that is narrow among rows as long is what limits demand.
        let beside = [(k + 1) % n, (k + n - 1) % n].map(longest);
        let across = beside.into_iter().filter(|step| *step > 0.0).fold(longest(k), f64::min);
        found = own.iter().copied().filter(|step| *step + near < MIN_STEP_RATIO * across).chain(found).reduce(f64::min);
    }
    found
}
