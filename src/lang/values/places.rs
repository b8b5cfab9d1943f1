//! Places as messages tell them: with the digits that it takes to find them, in one unit.

use glam::DVec3;

use crate::base::math::log10;
use crate::base::tolerance::Tolerance;
use crate::lang::values::units::{LengthUnit, convert, engineering_unit};

/// Share of the model's size to which a coordinate is told.
const SHARE_OF_MODEL: f64 = 1e-3;
/// Digits of a coordinate that are told, however small it is beside the model.
const OWN_DIGITS: f64 = 3.0;
/// Most decimals that are told.
const MOST_DECIMALS: usize = 12;
/// Largest coordinates that are told in the model's unit, which is the one that the script is searched for.
const IN_MODEL_UNIT: std::ops::Range<f64> = 0.01..1e6;

/// Places in words: `(4, 0.35, 0) m`. Each coordinate has three digits, more where the model is that much larger, and none below
/// the tolerance; places that differ do so in words as well.
pub fn place_texts(places: &[DVec3], tolerance: Option<Tolerance>, model: LengthUnit) -> Vec<String> {
    let largest = places.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let unit = if largest == 0.0 || IN_MODEL_UNIT.contains(&largest) { model } else { engineering_unit(largest, model) };
    let size = tolerance.map_or(largest, |t| t.size().max(largest));
    let point = tolerance.map_or(size * SHARE_OF_MODEL * SHARE_OF_MODEL, |t| t.point);
    // Decimals of the tolerance and of the model's size in the unit of the text.
    let decimals = |length: f64| -log10(convert(length, model, unit, 1)).floor();
    let (finest, coarsest) = (decimals(point), decimals(size * SHARE_OF_MODEL));
    let tell = |p: &DVec3, more: usize| {
        let one = |x: f64| {
            let x = convert(x, model, unit, 1);
            let own = OWN_DIGITS - 1.0 - log10(x.abs()).floor();
            let wanted = if x == 0.0 { 0.0 } else { own.max(coarsest).min(finest) };
            coordinate(x, if wanted > 0.0 { wanted as usize } else { 0 } + more)
        };
        format!("({}, {}, {}) {}", one(p.x), one(p.y), one(p.z), unit.name)
    };
    let mut texts: Vec<String> = Vec::new();
    for more in 0..MOST_DECIMALS {
        texts = places.iter().map(|p| tell(p, more)).collect();
        let alike = |a: usize, b: usize| texts[a] == texts[b] && places[a].distance(places[b]) > point * SHARE_OF_MODEL;
        if !(0..places.len()).any(|b| (0..b).any(|a| alike(a, b))) {
            break;
        }
    }
    texts
}

/// A coordinate with so many decimals, zeros at its end left out.
fn coordinate(x: f64, decimals: usize) -> String {
    if x.abs() >= IN_MODEL_UNIT.end * IN_MODEL_UNIT.end {
        return format!("{x:.2e}");
    }
    crate::base::text::decimals(x, decimals.min(MOST_DECIMALS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::values::units::length_unit;

    fn told(places: &[[f64; 3]], (point, size): (f64, f64), unit: &str) -> Vec<String> {
        let places: Vec<DVec3> = places.iter().map(|p| DVec3::from(*p)).collect();
        place_texts(&places, (size > 0.0).then(|| Tolerance::new(point, size)), length_unit(unit).unwrap())
    }

    #[test]
    fn a_place_has_the_digits_that_find_it() {
        let roof = (1e-5, 12.0);
        assert_eq!(told(&[[1.2, 0.35, 0.0]], roof, "m"), ["(1.2, 0.35, 0) m"]);
        assert_eq!(told(&[[4.0 / 3.0, -0.034_567_8, 4.9e-16]], roof, "m"), ["(1.33, -0.0346, 0) m"]);
        assert_eq!(told(&[[1234.567, 0.012_345, -1e-9]], (1e-3, 2000.0), "mm"), ["(1235, 0.012, 0) mm"]);
        assert_eq!(told(&[[0.0, 0.0, 0.0]], (1e-3, 2000.0), "mm"), ["(0, 0, 0) mm"]);
        assert_eq!(told(&[[0.000_014, 499.999_958, 0.0]], (1e-3, 1000.0), "mm"), ["(0, 500, 0) mm"]);
        // Before the model has a tolerance its own digits decide.
        assert_eq!(told(&[[1.0 / 3.0, 2.0, 1e-9]], (0.0, 0.0), "m"), ["(0.333, 2, 0) m"]);
    }

    #[test]
    fn far_and_tiny_places_are_told_in_a_unit_that_fits() {
        assert_eq!(told(&[[0.0003, 0.0, 0.0]], (1e-9, 0.01), "m"), ["(0.3, 0, 0) mm"]);
        assert_eq!(told(&[[25e6, 1500.0, 0.0]], (10.0, 3e7), "mm"), ["(25, 0.0015, 0) km"]);
        assert_eq!(told(&[[1e60, 0.0, 0.0]], (0.0, 0.0), "mm"), ["(1.00e60, 0, 0) mm"]);
        assert_eq!(told(&[[0.001, 0.0, 0.0]], (1e-6, 0.1), "in"), ["(0.001, 0, 0) in"]);
    }

    #[test]
    fn places_that_differ_are_told_apart() {
        assert_eq!(told(&[[4.0, 3.0, 0.0], [4.0003, 3.0, 0.0]], (1e-5, 12.0), "m"), ["(4, 3, 0) m", "(4.0003, 3, 0) m"]);
        assert_eq!(told(&[[4.0, 3.0, 0.0], [4.0, 3.0, 0.0]], (1e-5, 12.0), "m"), ["(4, 3, 0) m", "(4, 3, 0) m"]);
    }
}
