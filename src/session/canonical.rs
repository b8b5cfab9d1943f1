//! The order in which curves and surfaces go into the network and the surface model: by where they are, then by name.
//!
//! Numbers of nodes, links, patches and edges follow from it, and so do meshes, where faces that compete are taken in turn: a
//! script whose declarations stand in another order gives the same bits. Places are compared on a grid of the tolerance, so
//! that rounding decides nothing where coordinates are round.

use std::cmp::Ordering;

use glam::DVec3;

use crate::base::math::compare_points;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::model::topology::Named;
use crate::network::Chain;
use crate::network::graph::Input;
use crate::surface::Surface;

/// Places in the (u, v) square by which surfaces are ordered.
const PLACES: [(f64, f64); 3] = [(0.5, 0.5), (0.0, 0.0), (1.0, 1.0)];

/// Puts curves in order.
pub fn sort_curves(inputs: &mut Vec<Input>, tolerance: &Tolerance) {
    sort_by(inputs, |input| of_curve(&input.curve, tolerance), |input| &input.name);
}

/// Puts curves with names in order.
pub fn sort_named(curves: &mut Vec<(Curve, String)>, tolerance: &Tolerance) {
    sort_by(curves, |named| of_curve(&named.0, tolerance), |named| &named.1);
}

/// Puts surfaces in order.
pub fn sort_surfaces(surfaces: &mut Vec<Named>, tolerance: &Tolerance) {
    sort_by(surfaces, |named| of_surface(&named.surface, tolerance), |named| &named.name);
}

fn sort_by<T, P: AsRef<[DVec3]>>(items: &mut Vec<T>, place: impl Fn(&T) -> P, name: impl Fn(&T) -> &str) {
    let places: Vec<P> = items.iter().map(place).collect();
    let mut order: Vec<usize> = (0..items.len()).collect();
    order.sort_by(|&a, &b| compare(places[a].as_ref(), places[b].as_ref()).then_with(|| name(&items[a]).cmp(name(&items[b]))));
    drop(places);
    let mut items_left: Vec<Option<T>> = std::mem::take(items).into_iter().map(Some).collect();
    items.extend(order.into_iter().filter_map(|k| items_left[k].take()));
}

fn compare(a: &[DVec3], b: &[DVec3]) -> Ordering {
    let first = a.iter().zip(b).map(|(a, b)| compare_points(*a, *b)).find(|order| order.is_ne());
    first.unwrap_or_else(|| a.len().cmp(&b.len()))
}

/// Both ends, the lower one first, and the middle.
fn of_curve(curve: &Curve, tolerance: &Tolerance) -> [DVec3; 3] {
    let (first, last) = curve.domain();
    let [mut low, mut high, middle] = [curve.start(), curve.end(), curve.point(0.5 * (first + last))].map(|p| on_grid(p, tolerance));
    if compare_points(low, high).is_gt() {
        std::mem::swap(&mut low, &mut high);
    }
    [low, high, middle]
}

/// Some of its points and the curves it stands on.
fn of_surface(surface: &Surface, tolerance: &Tolerance) -> Vec<DVec3> {
    let own = PLACES.iter().map(|(u, v)| on_grid(surface.point(*u, *v), tolerance));
    let runs = surface.chains().iter().flat_map(Chain::runs);
    own.chain(runs.flat_map(|run| of_curve(&run.curve, tolerance))).collect()
}

fn on_grid(p: DVec3, tolerance: &Tolerance) -> DVec3 {
    // Adding zero makes the two zeros one.
    (p / tolerance.point).round() + DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::geometry::construct::build;

    #[test]
    fn curves_are_in_order_of_place_then_of_name() {
        let tolerance = Tolerance::new(1e-6, 10.0);
        let line = |name: &str, from: f64, to: f64| Input {
            name: name.to_owned(),
            curve: build::line(DVec3::new(from, 0.0, 0.0), DVec3::new(to, 0.0, 0.0), Origin::NONE).unwrap(),
            cuts: Vec::new(),
        };
        let mut all = vec![line("d", 3.0, 1.0), line("c", 1.0, 3.0), line("b", -0.0, 2.0), line("a", 1e-12, 2.0), line("e", -1.0, 9.0)];
        sort_curves(&mut all, &tolerance);
        let names: Vec<&str> = all.iter().map(|input| &*input.name).collect();
        assert_eq!(names, ["e", "a", "b", "c", "d"]);
    }
}
