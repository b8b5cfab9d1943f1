//! Shares whole numbers out: a count over segments by length, steps along a segment with a bias.

use crate::base::math;
use crate::base::tolerance::WHOLE_NUMBER;

/// Shares `total` out to segments by weight: largest remainder, at least `least[i]` each; ties go to the earlier one.
/// Weights that differ by no more than `near` are a tie.
///
/// `None` when `total` is below the sum of the least shares.
pub fn share(total: u32, weights: &[f64], near: f64, least: &[u32]) -> Option<Vec<u32>> {
    let floor: u32 = least.iter().sum();
    if total < floor {
        return None;
    }
    let sum: f64 = weights.iter().sum();
    let quota: Vec<f64> = weights.iter().map(|w| if sum > 0.0 { w / sum * f64::from(total) } else { 0.0 }).collect();
    let near = WHOLE_NUMBER + if sum > 0.0 { near / sum * f64::from(total) } else { 0.0 };
    let mut shares: Vec<u32> = quota.iter().zip(least).map(|(q, l)| ((q + near).floor() as u32).max(*l)).collect();
    // What the least shares took from the others is given back where the shares exceed their quotas most.
    while shares.iter().sum::<u32>() > total {
        let over = |i: &usize| f64::from(shares[*i]) - quota[*i];
        let i = largest((0..shares.len()).filter(|i| shares[*i] > least[*i]), over, near)?;
        shares[i] -= 1;
    }
    while shares.iter().sum::<u32>() < total {
        let short = |i: &usize| quota[*i] - f64::from(shares[*i]);
        let i = largest(0..shares.len(), short, near)?;
        shares[i] += 1;
    }
    Some(shares)
}

/// The first of those whose value is the largest or less by no more than `near`.
pub fn largest(among: impl Iterator<Item = usize> + Clone, value: impl Fn(&usize) -> f64, near: f64) -> Option<usize> {
    let most = among.clone().map(|i| value(&i)).fold(f64::NEG_INFINITY, f64::max);
    among.into_iter().find(|i| value(i) >= most - near)
}

/// Fractions 0…1 of the ends of `n` steps that grow geometrically, the last `bias` times the first.
pub fn steps(n: u32, bias: f64) -> Vec<f64> {
    let last = f64::from(n);
    if n < 2 || bias == 1.0 {
        return (0..=n).map(|i| f64::from(i) / last).collect();
    }
    let log = math::log(bias) / (last - 1.0);
    let all = math::exp(log * last) - 1.0;
    let mut at: Vec<f64> = (0..=n).map(|i| (math::exp(log * f64::from(i)) - 1.0) / all).collect();
    at[n as usize] = 1.0;
    at
}

/// The largest of these steps, as a fraction of the whole.
pub fn largest_step(n: u32, bias: f64) -> f64 {
    let last = f64::from(n);
    if n < 2 || bias == 1.0 {
        return 1.0 - (last - 1.0) / last;
    }
    let log = math::log(bias) / (last - 1.0);
    let at = |i: f64| (math::exp(log * i) - 1.0) / (math::exp(log * last) - 1.0);
    if bias >= 1.0 { 1.0 - at(last - 1.0) } else { at(1.0) }
}

/// The least number of steps none of which exceeds `size`; a quotient within 1e-9 of a whole number is that number.
pub fn for_size(length: f64, size: f64, bias: f64) -> f64 {
    let even = (length / size - WHOLE_NUMBER).ceil().max(1.0);
    if bias == 1.0 || even > f64::from(u32::MAX / 4) {
        return even;
    }
    let fits = |n: u32| largest_step(n, bias) * length <= size * (1.0 + WHOLE_NUMBER);
    let (mut low, mut high) = (even as u32, even as u32);
    while !fits(high) {
        // A strong bias leaves a last step that no number of steps makes smaller than 1 − 1/ratio of the whole.
        if high > u32::MAX / 8 {
            return f64::from(high);
        }
        (low, high) = (high + 1, high * 2);
    }
    while low < high {
        let middle = low + (high - low) / 2;
        (low, high) = if fits(middle) { (low, middle) } else { (middle + 1, high) };
    }
    f64::from(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_by_largest_remainder() {
        assert_eq!(share(10, &[3.0, 3.0, 4.0], 0.0, &[1; 3]), Some(vec![3, 3, 4]));
        assert_eq!(share(10, &[1.0, 1.0, 1.0], 0.0, &[1; 3]), Some(vec![4, 3, 3]));
        assert_eq!(share(5, &[100.0, 1.0, 1.0], 0.0, &[1; 3]), Some(vec![3, 1, 1]));
        assert_eq!(share(3, &[100.0, 1.0, 1.0], 0.0, &[1; 3]), Some(vec![1, 1, 1]));
        assert_eq!(share(2, &[100.0, 1.0, 1.0], 0.0, &[1; 3]), None);
        assert_eq!(share(7, &[0.5, 0.5], 0.0, &[1, 5]), Some(vec![2, 5]));
    }

    #[test]
    fn steps_grow_by_one_ratio_and_the_last_is_bias_times_the_first() {
        for bias in [0.25, 1.0, 1.2, 7.0] {
            let at = steps(9, bias);
            let lengths: Vec<f64> = at.windows(2).map(|w| w[1] - w[0]).collect();
            assert!((lengths[8] / lengths[0] - bias).abs() < 1e-12, "{bias}");
            let ratio = lengths[1] / lengths[0];
            assert!(lengths.windows(2).all(|w| (w[1] / w[0] - ratio).abs() < 1e-12), "{bias}");
            assert_eq!((at[0], at[9]), (0.0, 1.0));
            assert!((largest_step(9, bias) - lengths[0].max(lengths[8])).abs() < 1e-15);
        }
    }

    #[test]
    fn size_is_never_exceeded_and_whole_quotients_stay() {
        assert_eq!(for_size(10.0, 0.1, 1.0), 100.0);
        assert_eq!(for_size(10.0, 0.3, 1.0), 34.0);
        assert_eq!(for_size(0.1, 3.0, 1.0), 1.0);
        for bias in [0.3, 1.5, 4.0] {
            let n = for_size(10.0, 0.37, bias) as u32;
            assert!(largest_step(n, bias) * 10.0 <= 0.37 + 1e-9 && largest_step(n - 1, bias) * 10.0 > 0.37, "{bias} {n}");
        }
    }
}
