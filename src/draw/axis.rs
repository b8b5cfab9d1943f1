//! Axes of plots: round numbers along a range, and how they are written.

use super::annotate::number;
use crate::base::math;
use crate::base::tolerance::WHOLE_NUMBER;

/// Numbers from this size on are written in a multiple of a power of ten.
const LARGE: f64 = 1e5;
/// Numbers below this size too.
const SMALL: f64 = 0.001;

/// A range of values with round numbers along it.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The least value shown, a multiple of `step`.
    pub low: f64,
    /// The largest value shown, a multiple of `step`.
    pub high: f64,
    /// Distance of neighbouring numbers: 1, 2 or 5 times a power of ten.
    pub step: f64,
    /// What the numbers are divided by: a power of a thousand.
    pub factor: f64,
    count: usize,
}

impl Axis {
    /// An axis that holds some values, with at most about `most` steps. Values that are no numbers are passed over; of none at all it is from 0 to 1.
    pub fn holding(values: impl Iterator<Item = f64>, most: usize) -> Self {
        let (mut low, mut high) =
            values.filter(|x| x.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let size = low.abs().max(high.abs());
        // Values that are equal but for rounding have a neighbourhood.
        if high - low <= WHOLE_NUMBER * size || high == low {
            let around = if size > 0.0 { 0.1 * size } else { 1.0 };
            (low, high) = (low - around, high + around);
        }
        let step = round_step((high - low) / most.max(1) as f64);
        let (first, last) = ((low / step + WHOLE_NUMBER).floor(), (high / step - WHOLE_NUMBER).ceil());
        let (low, high) = (first * step, last * step);
        Self { low, high, step, factor: factor(low.abs().max(high.abs())), count: (last - first) as usize }
    }

    /// The numbers along it.
    pub fn ticks(&self) -> impl Iterator<Item = f64> + '_ {
        let first = (self.low / self.step).round();
        (0..=self.count).map(move |k| (first + k as f64) * self.step)
    }

    /// A number along it as written.
    pub fn text(&self, tick: f64) -> String {
        number(tick / self.factor, self.step / self.factor)
    }

    /// How far along it a value lies, 0…1.
    pub fn share(&self, x: f64) -> f64 {
        (x - self.low) / (self.high - self.low)
    }

    /// A name with the unit of the numbers.
    pub fn label(&self, name: &str, unit: &str) -> String {
        let factor = if self.factor == 1.0 { String::new() } else { format!("1e{}", math::log10(self.factor).round()) };
        let unit = [factor.as_str(), unit].into_iter().filter(|w| !w.is_empty()).collect::<Vec<_>>().join(" ");
        match (name.is_empty(), unit.is_empty()) {
            (_, true) => name.to_owned(),
            (true, false) => format!("[{unit}]"),
            (false, false) => format!("{name} [{unit}]"),
        }
    }
}

/// The least of 1, 2, 5 times a power of ten that is not below `least`.
fn round_step(least: f64) -> f64 {
    let power = math::powi(10.0, math::log10(least).floor() as i32);
    let rounded = |k: f64| if power < 1.0 { k / (1.0 / power).round() } else { k * power };
    [1.0, 2.0, 5.0, 10.0].into_iter().map(rounded).find(|x| *x >= least * (1.0 - WHOLE_NUMBER)).unwrap_or(10.0 * power)
}

fn factor(size: f64) -> f64 {
    if size > 0.0 && !(SMALL..LARGE).contains(&size) { math::powi(10.0, 3 * (math::log10(size) / 3.0).floor() as i32) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(values: &[f64], most: usize) -> Vec<String> {
        let axis = Axis::holding(values.iter().copied(), most);
        axis.ticks().map(|t| axis.text(t)).collect()
    }

    #[test]
    fn ticks_are_round_and_hold_the_values() {
        assert_eq!(texts(&[0.0, 90.0], 10), ["0", "10", "20", "30", "40", "50", "60", "70", "80", "90"]);
        assert_eq!(texts(&[0.03, 0.97], 5), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(texts(&[-1.0, 3.2], 5), ["-1", "0", "1", "2", "3", "4"]);
        assert_eq!(texts(&[-0.3, 0.3], 6), ["-0.3", "-0.2", "-0.1", "0", "0.1", "0.2", "0.3"]);
    }

    #[test]
    fn large_numbers_are_written_in_powers_of_a_thousand() {
        let axis = Axis::holding([0.0, 49e6].into_iter(), 5);
        assert_eq!((axis.factor, axis.label("volume", "m3").as_str()), (1e6, "volume [1e6 m3]"));
        assert_eq!(axis.text(20e6), "20");
        assert_eq!(Axis::holding([0.0, 1.0].into_iter(), 5).label("", ""), "");
    }

    #[test]
    fn one_value_has_a_neighbourhood() {
        let axis = Axis::holding([5.0, 5.0, f64::NAN].into_iter(), 5);
        assert!(axis.low < 5.0 && axis.high > 5.0);
        let none = Axis::holding(std::iter::empty(), 5);
        assert_eq!((none.low, none.high), (0.0, 1.0));
        let zero = Axis::holding([0.0].into_iter(), 5);
        assert_eq!((zero.low, zero.high), (-1.0, 1.0));
    }
}
