//! How far free borders of a mesh are off the curves that they follow.

use glam::DVec3;

use crate::base::par;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::request::sources::distance_to_segment;

/// Parts of a step at whose ends its curve is looked at.
const PLACES: u32 = 8;

/// Largest distance between the steps of borders that belong to one face only and their curves, model units.
///
/// Borders that two faces share are left out: what their steps are off, the faces beside them are off their surfaces, or the mesh is not
/// off at all where both go on smoothly.
pub fn of_free_borders(layout: &Layout, nodes: &Nodes) -> f64 {
    let mut uses = vec![0_u32; layout.pieces.segments.len()];
    for side in layout.faces.iter().flat_map(|face| &face.sides) {
        side.uses.iter().for_each(|used| uses[used.segment] += 1);
    }
    let free: Vec<usize> = (0..uses.len()).filter(|k| uses[*k] == 1).collect();
    par::map(free.len(), |k| of_segment(layout, nodes, free[k])).into_iter().fold(0.0, f64::max)
}

fn of_segment(layout: &Layout, nodes: &Nodes, segment: usize) -> f64 {
    let ends = nodes.fractions(segment, false);
    let between = |w: &[f64], k: u32| w[0] + (w[1] - w[0]) * f64::from(k) / f64::from(PLACES);
    let mut fractions: Vec<f64> = ends.windows(2).flat_map(|w| (0..PLACES).map(|k| between(w, k))).collect();
    fractions.push(1.0);
    let points = layout.points_along(segment, &fractions);
    let step = |step: &[DVec3]| {
        let (a, b) = (step[0], step[step.len() - 1]);
        step.iter().map(|p| distance_to_segment(*p, a, b)).fold(0.0, f64::max)
    };
    (0..ends.len() - 1).map(|k| step(&points[k * PLACES as usize..=(k + 1) * PLACES as usize])).fold(0.0, f64::max)
}
