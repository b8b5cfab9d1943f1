//! Quantities in advice: round numbers, and lengths as they are typed.

use super::Say;
use crate::base::math;

/// The next number of the row 1, 2, 5, 10, … at or above a positive length.
pub fn round_up(length: f64) -> f64 {
    let decade = math::pow(10.0, math::log10(length).floor());
    let share = length / decade;
    // A whole multiple of a decade may come out a hair above itself.
    let step = [1.0, 2.0, 5.0].into_iter().find(|step| share <= step * (1.0 + crate::base::tolerance::EPSILON)).unwrap_or(10.0);
    step * decade
}

/// The next number of the row 1, 2, 5, 10, … above a positive length: ends closer than it are joined.
pub fn round_above(length: f64) -> f64 {
    let up = round_up(length);
    if up > length * (1.0 + crate::base::tolerance::EPSILON) { up } else { round_up(up * 1.5) }
}

/// The next number of the row 1, 2, 5, 10, … below a positive length.
pub fn round_down(length: f64) -> f64 {
    let decade = math::pow(10.0, math::log10(length).floor());
    let share = length / decade;
    let step = [5.0, 2.0].into_iter().find(|step| share > *step).unwrap_or(if share > 1.0 { 1.0 } else { 0.5 });
    step * decade
}

/// The note that states the model's tolerance.
pub fn tolerance_note(say: &dyn Say, tolerance: f64) -> String {
    format!("the model's tolerance is {}", say.length(tolerance))
}

/// A length as it is typed: the unit sticks to the number, without trailing zeros.
pub fn typed(say: &dyn Say, length: f64) -> String {
    let said = say.length(length);
    let (number, unit) = said.split_once(' ').unwrap_or((&said, ""));
    let number = if number.contains('.') && !number.contains('e') { number.trim_end_matches('0').trim_end_matches('.') } else { number };
    // A unit that shows too few digits must not turn the advice into a zero.
    if number.parse::<f64>().is_ok_and(|shown| shown == 0.0) { format!("{length:?}") } else { format!("{number}{unit}") }
}

/// A point as it is typed, from the words of a message: the unit sticks to each coordinate that is not 0.
pub fn typed_point(said: &str) -> String {
    let (inside, unit) = said.rsplit_once(") ").unwrap_or((said.trim_end_matches(')'), ""));
    let one = |x: &str| if x == "0" { x.to_owned() } else { format!("{x}{unit}") };
    let all: Vec<String> = inside.trim_start_matches('(').split(", ").map(one).collect();
    format!("({})", all.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_numbers_bracket_their_length() {
        for (length, up, down) in [(0.3, 0.5, 0.2), (0.5, 0.5, 0.2), (1.0, 1.0, 0.5), (7.0, 10.0, 5.0), (1.5e-4, 2e-4, 1e-4)] {
            assert!((round_up(length) / up - 1.0).abs() < 1e-12, "{length} up to {}", round_up(length));
            assert!(round_above(length) > length && round_above(up) > up);
            assert!((round_down(length) / down - 1.0).abs() < 1e-12, "{length} down to {}", round_down(length));
        }
    }

    #[test]
    fn points_are_typed_with_their_unit() {
        assert_eq!(typed_point("(0, -2.5, 50) mm"), "(0, -2.5mm, 50mm)");
        assert_eq!(typed_point("(0, 1e-7, 50)"), "(0, 1e-7, 50)");
    }
}
