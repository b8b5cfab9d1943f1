//! A place inside a face by its loops in (u, v): on a surface that closes the curves in space do not say which side is meant.

use glam::{DVec2, DVec3};

use crate::geometry::Curve;
use crate::io::cad::base_surface::Base;

/// Steps along each curve.
const STEPS: usize = 24;
/// Shares of the height at which a loop is looked through: no places that are special for anything.
const LEVELS: [f64; 3] = [0.4873, 0.2931, 0.7139];

/// A point of the surface inside the loops of a face, the outer one first, in the file's (u, v); none where curves are missing there.
pub fn inside(base: &Base, loops: &[Option<Vec<Curve>>]) -> Option<DVec3> {
    let outlines = loops.iter().map(|curves| outline(curves.as_deref()?)).collect::<Option<Vec<_>>>()?;
    let outer = outlines.first()?;
    let (low, high) = outer.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.y), b.max(p.y)));
    let widest = |level: f64| {
        let y = low + (high - low) * level;
        let mut crossed: Vec<f64> = outlines.iter().flat_map(|o| crossings(o, y)).collect();
        crossed.sort_by(f64::total_cmp);
        let runs = crossed.chunks_exact(2).map(|run| (run[1] - run[0], DVec2::new(0.5 * (run[0] + run[1]), y)));
        runs.reduce(|best, next| if next.0 > best.0 { next } else { best })
    };
    let (width, place) = LEVELS.into_iter().filter_map(widest).reduce(|best, next| if next.0 > best.0 { next } else { best })?;
    if width > 0.0 { base.point(place.x, place.y) } else { None }
}

/// The corners of a loop in (u, v): its curves end to end, each from where it is nearer to the end of the one before.
fn outline(curves: &[Curve]) -> Option<Vec<DVec2>> {
    let places = |curve: &Curve| {
        let (a, b) = curve.domain();
        (0..=STEPS).map(|k| curve.point(a + (b - a) * k as f64 / STEPS as f64).truncate()).collect::<Vec<DVec2>>()
    };
    let mut rows: Vec<Vec<DVec2>> = curves.iter().map(places).collect();
    let ends = |row: &[DVec2]| (row[0], row[row.len() - 1]);
    if let [first, second, ..] = rows.as_mut_slice() {
        let ((a, b), (c, d)) = (ends(first), ends(second));
        if a.distance(c).min(a.distance(d)) < b.distance(c).min(b.distance(d)) {
            first.reverse();
        }
    }
    let mut outline: Vec<DVec2> = Vec::new();
    for mut row in rows {
        if let Some(last) = outline.last() {
            let (a, b) = ends(&row);
            if last.distance(b) < last.distance(a) {
                row.reverse();
            }
        }
        outline.extend(row);
    }
    (!outline.is_empty()).then_some(outline)
}

/// Where a polygon crosses a height.
fn crossings(outline: &[DVec2], y: f64) -> Vec<f64> {
    let n = outline.len();
    let edges = (0..n).map(|k| (outline[k], outline[(k + 1) % n]));
    edges.filter(|(a, b)| (a.y > y) != (b.y > y)).map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)).collect()
}
