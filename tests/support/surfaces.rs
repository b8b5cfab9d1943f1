//! Surfaces compared.

use lofting::surface::Surface;

/// The largest distance of two surfaces over a grid of so many cells each way, the second one perhaps run backwards.
pub fn apart(a: &Surface, b: &Surface, cells: u32) -> f64 {
    let at = |k: u32| f64::from(k) / f64::from(cells);
    let far = |turn: (bool, bool)| {
        let place = |x: f64, back: bool| if back { 1.0 - x } else { x };
        let each = (0..=cells).flat_map(|i| (0..=cells).map(move |j| (at(i), at(j))));
        each.map(|(u, v)| a.point(u, v).distance(b.point(place(u, turn.0), place(v, turn.1)))).fold(0.0, f64::max)
    };
    [(false, false), (true, false), (false, true), (true, true)].into_iter().map(far).fold(f64::INFINITY, f64::min)
}
