//! Units: the only converter between what scripts say and model units, degrees and kilograms.

use crate::lang::values::value::{Dim, Quantity};

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthUnit {
    /// As written.
    pub name: &'static str,
    /// How many micrometres it has; whole, so that conversions round once.
    pub micrometres: u64,
    /// What it is called in the reference.
    pub docs: &'static str,
}

/// All units of length.
pub const LENGTHS: &[LengthUnit] = &[
    LengthUnit { name: "um", micrometres: 1, docs: "micrometre" },
    LengthUnit { name: "mm", micrometres: 1_000, docs: "millimetre" },
    LengthUnit { name: "cm", micrometres: 10_000, docs: "centimetre" },
    LengthUnit { name: "m", micrometres: 1_000_000, docs: "metre" },
    LengthUnit { name: "km", micrometres: 1_000_000_000, docs: "kilometre" },
    LengthUnit { name: "in", micrometres: 25_400, docs: "inch" },
    LengthUnit { name: "ft", micrometres: 304_800, docs: "foot" },
];

/// A unit of something else.
#[derive(Clone, Copy, Debug)]
pub struct OtherUnit {
    /// As written.
    pub name: &'static str,
    /// What it measures.
    pub dim: Dim,
    /// Its value in degrees or kg.
    pub ratio: f64,
    /// What it is called in the reference.
    pub docs: &'static str,
}

/// All units of angle and mass.
pub const OTHERS: &[OtherUnit] = &[
    OtherUnit { name: "deg", dim: Dim::ANGLE, ratio: 1.0, docs: "degree" },
    OtherUnit { name: "rad", dim: Dim::ANGLE, ratio: 180.0 / std::f64::consts::PI, docs: "radian" },
    OtherUnit { name: "kg", dim: Dim::MASS, ratio: 1.0, docs: "kilogram" },
    OtherUnit { name: "t", dim: Dim::MASS, ratio: 1000.0, docs: "tonne" },
];

/// Lengths in model units from which no unit makes a number that is read.
const BEYOND_UNITS: f64 = 1e15;

/// The default model unit.
pub const MILLIMETRE: LengthUnit = LENGTHS[1];
/// Centimetres.
pub const CENTIMETRE: LengthUnit = LENGTHS[2];

/// The unit of length of that name.
pub fn length_unit(name: &str) -> Option<LengthUnit> {
    LENGTHS.iter().copied().find(|u| u.name == name)
}

/// The unit of a word of `units:` or `unit:`; `in` is a keyword, so that inches are `inch` there.
pub fn file_unit(word: &str) -> Option<LengthUnit> {
    length_unit(if word == "inch" { "in" } else { word })
}

/// Degrees of an angle in radians.
pub fn degrees(radians: f64) -> f64 {
    radians * 180.0 / std::f64::consts::PI
}

/// Radians of an angle in degrees.
pub fn radians(degrees: f64) -> f64 {
    degrees * std::f64::consts::PI / 180.0
}

/// A value in `from`^power as a value in `to`^power, rounded once where the ratio of the two is whole.
pub fn convert(value: f64, from: LengthUnit, to: LengthUnit, power: i8) -> f64 {
    if from.micrometres == to.micrometres || power == 0 {
        return value;
    }
    let (mut up, mut down) = (from.micrometres, to.micrometres);
    let common = gcd(up, down);
    up /= common;
    down /= common;
    let (up, down) = if power < 0 { (down, up) } else { (up, down) };
    let times = i32::from(power.unsigned_abs());
    let (up, down) = (crate::base::math::powi(up as f64, times), crate::base::math::powi(down as f64, times));
    if up == 1.0 { value / down } else { value * up / down }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// One side of a unit: its dimension and the value of one in model units, degrees, kg.
fn factor(text: &str) -> Option<(Dim, Factor)> {
    Some(match OTHERS.iter().find(|u| u.name == text) {
        Some(unit) => (unit.dim, Factor::Ratio(unit.ratio)),
        None => {
            let (name, power) = match text.as_bytes().last()? {
                b'2' => (&text[..text.len() - 1], 2),
                b'3' => (&text[..text.len() - 1], 3),
                _ => (text, 1),
            };
            (Dim { length: power, ..Dim::NONE }, Factor::Length(length_unit(name)?, power))
        }
    })
}

enum Factor {
    Ratio(f64),
    Length(LengthUnit, i8),
}

impl Factor {
    fn apply(&self, value: f64, model: LengthUnit, below: bool) -> f64 {
        match *self {
            Self::Ratio(r) if below => value / r,
            Self::Ratio(r) => value * r,
            Self::Length(unit, power) => convert(value, unit, model, if below { -power } else { power }),
        }
    }
}

/// A number with a unit text (`mm2`, `kg/m3`, `%`) as a quantity; `None` when there is no such unit.
pub fn quantity(value: f64, unit: &str, model: LengthUnit) -> Option<Quantity> {
    if unit == "%" {
        return Some(Quantity { value: value / 100.0, dim: Dim::NONE, percent: true });
    }
    let (above, below) = match unit.split_once('/') {
        Some((a, b)) => (a, Some(b)),
        None => (unit, None),
    };
    let (mut dim, above) = factor(above)?;
    let mut value = above.apply(value, model, false);
    if let Some(below) = below {
        let (other, below) = factor(below)?;
        dim = dim.over(other)?;
        value = below.apply(value, model, true);
    }
    Some(Quantity::new(value, dim))
}

/// The unit that a quantity of this dimension is shown in: `mm`, `deg`, `kg/m3`; empty for bare numbers.
pub fn unit_text(dim: Dim, model: LengthUnit) -> String {
    let part = |name: &str, power: i8| match power {
        1 => name.to_owned(),
        _ => format!("{name}{power}"),
    };
    let parts = [("kg", dim.mass), (model.name, dim.length), ("deg", dim.angle)];
    let above: Vec<String> = parts.iter().filter(|p| p.1 > 0).map(|p| part(p.0, p.1)).collect();
    let below: Vec<String> = parts.iter().filter(|p| p.1 < 0).map(|p| part(p.0, -p.1)).collect();
    match (above.is_empty(), below.is_empty()) {
        (_, true) => above.join("*"),
        (true, false) => format!("1/{}", below.join("/")),
        (false, false) => format!("{}/{}", above.join("*"), below.join("/")),
    }
}

/// The fewest digits that read back to the same bits, with an exponent outside 1e-5…1e16; negative zero is zero.
pub fn number_text(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A quantity as shortest number and unit, in model units or degrees.
pub fn quantity_text(q: Quantity, model: LengthUnit) -> String {
    if q.percent {
        return format!("{}%", number_text(q.value * 100.0));
    }
    format!("{}{}", number_text(q.value), unit_text(q.dim, model))
}

/// A length in model units as messages tell it: three digits, in the model's unit where that takes at most four places before
/// the dot and one zero behind it, else in the metric unit that engineers would take: `0.3 mm`, never `0.000300 m`.
pub fn told_length(x: f64, model: LengthUnit) -> (String, LengthUnit) {
    let fits = x == 0.0 || !x.is_finite() || (0.1..1e4).contains(&x.abs());
    let unit = if fits { model } else { engineering_unit(x, model) };
    (three_digits(convert(x, model, unit, 1)), unit)
}

/// The metric unit that engineers would take for a length; the model's where that is none of theirs, or none fits.
pub fn engineering_unit(x: f64, model: LengthUnit) -> LengthUnit {
    if matches!(model.name, "in" | "ft") || x.abs() >= BEYOND_UNITS {
        return model;
    }
    let metric = |name: &str| LENGTHS.iter().find(|u| u.name == name);
    // Up to a whole number of the larger unit, down to a tenth of the smaller one.
    let least = if x.abs() < 1.0 { 0.1 } else { 1.0 };
    let units = ["km", "m", "mm", "um"].into_iter().filter_map(metric);
    units.clone().find(|u| convert(x, model, **u, 1).abs() >= least).or(metric("um")).copied().unwrap_or(model)
}

/// An angle in radians as messages tell it: degrees with two decimals, or three digits where it is smaller than those show.
pub fn angle_text(radians: f64) -> String {
    let degrees = degrees(radians);
    let text = if degrees.abs() < 1.0 { three_digits(degrees) } else { format!("{degrees:.2}") };
    let text = if text.contains('.') && !text.contains('e') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text}°")
}

/// A number with three digits, all those before the dot, and no zeros at its end.
fn three_digits(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return number_text(x);
    }
    let size = crate::base::math::log10(x.abs()).floor();
    if !(-4.0..15.0).contains(&size) {
        let text = format!("{x:.2e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'));
    }
    let places = (2.0 - size).max(0.0) as usize;
    let text = format!("{x:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A quantity as messages tell it: a length with three digits, anything else as it is.
pub fn in_words(q: Quantity, model: LengthUnit) -> String {
    if q.dim != Dim::LENGTH {
        return quantity_text(q, model);
    }
    let (text, unit) = told_length(q.value, model);
    format!("{text}{}", unit.name)
}

/// The units that a bare number may have meant where this dimension is wanted, the likelier first. An angle is in radians when
/// its digits are those of a simple share of pi, else in degrees.
pub fn meant_units(value: f64, dim: Dim, unit: LengthUnit) -> Vec<String> {
    match dim {
        Dim::ANGLE if is_share_of_pi(value) => vec!["rad".into(), "deg".into()],
        Dim::ANGLE => vec!["deg".into(), "rad".into()],
        dim => vec![unit_text(dim, unit)],
    }
}

/// Whether a number with three digits or more is k/12 or k/8 of pi, up to two turns, as far as its digits go: 1.57, 2.0944, 3.1416.
fn is_share_of_pi(value: f64) -> bool {
    let text = number_text(value.abs());
    let Some((whole, decimals)) = text.split_once('.') else { return false };
    let digits = whole.trim_start_matches('0').len() + decimals.len();
    let places = decimals.len();
    // The last digits of a computed value are rounding.
    const COMPUTED: usize = 12;
    let shown = places.min(COMPUTED);
    let rounded = format!("{:.shown$}", value.abs());
    let alike = |share: f64| format!("{share:.shown$}") == rounded;
    digits >= 3 && !text.contains('e') && (1..=96).any(|k| (k % 2 == 0 || k % 3 == 0) && alike(f64::from(k) * std::f64::consts::PI / 24.0))
}

#[cfg(test)]
mod tests {
    #[test]
    fn lengths_are_told_in_three_digits() {
        let told = |x: f64, unit: &str| super::in_words(super::Quantity::new(x, super::Dim::LENGTH), super::length_unit(unit).unwrap());
        assert_eq!(told(0.0003, "m"), "0.3mm");
        assert_eq!(told(0.3, "mm"), "0.3mm");
        assert_eq!([told(5000.0, "mm"), told(1234.567, "mm"), told(25_000.0, "mm")], ["5000mm", "1235mm", "25m"]);
        assert_eq!([told(1e60, "mm"), told(1.5e-30, "m")], ["1e60mm", "1.5e-24um"]);
        assert_eq!([super::angle_text(0.5), super::angle_text(std::f64::consts::FRAC_PI_6)], ["28.65°", "30°"]);
        assert_eq!([super::angle_text(1e-3), super::angle_text(-1e-9), super::angle_text(0.0)], ["0.0573°", "-5.73e-8°", "0°"]);
        assert_eq!([told(-1e-3, "mm"), told(0.0, "m"), told(0.31, "in"), told(4.0 / 3.0, "cm")], ["-1um", "0m", "0.31in", "1.33cm"]);
    }

    #[test]
    #[allow(clippy::approx_constant, reason = "numbers as they are typed")]
    fn shares_of_pi_are_radians() {
        let radians = [1.5708, 3.14, 0.785, 2.094, 6.2832, std::f64::consts::FRAC_PI_3];
        assert!(
            radians.iter().all(|x| super::is_share_of_pi(*x))
                && ![45.0, 1.5, 30.0, 0.5, 22.5, 2.25].iter().any(|x| super::is_share_of_pi(*x))
        );
    }

    use super::*;

    fn check(value: f64, unit: &str, model: &str, expected: &str) {
        let model = length_unit(model).expect("a unit of the table");
        let got = quantity(value, unit, model).map(|q| quantity_text(q, model));
        assert_eq!(got.as_deref(), Some(expected), "{value}{unit}");
    }

    #[test]
    fn literals_convert_with_one_rounding() {
        check(3.0, "mm", "mm", "3mm");
        check(0.3, "mm", "m", "0.0003m");
        check(2.0, "m2", "mm", "2000000mm2");
        check(1.0, "in", "mm", "25.4mm");
        check(1.0, "ft", "in", "12in");
        check(7850.0, "kg/m3", "m", "7850kg/m3");
        check(7850.0, "kg/m3", "mm", "7.85e-6kg/mm3");
        check(30.0, "deg", "mm", "30deg");
        check(12.5, "%", "mm", "12.5%");
        check(1.0, "t", "mm", "1000kg");
        check(5.0, "deg/mm", "mm", "5deg/mm");
        assert!(quantity(1.0, "mm4", MILLIMETRE).is_none());
        assert!(quantity(1.0, "kg/m/m", MILLIMETRE).is_none());
    }
}
