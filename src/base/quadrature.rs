//! Numerical integration: the Gauss–Kronrod pair 7/15 of QUADPACK [Piessens et al. 1983] and Gauss–Legendre rules.

use std::sync::OnceLock;

use super::job;
use super::math;
use super::solve;

/// Number of nodes of the Kronrod rule.
pub const KRONROD: usize = 15;
/// Number of Chebyshev coefficients of the running integral through these nodes.
pub const RUNNING: usize = KRONROD + 1;

/// Kronrod nodes, ascending over −1…1; every second one (from index 1) is a Gauss node.
pub const NODES: [f64; KRONROD] = [
    -0.991_455_371_120_812_6,
    -0.949_107_912_342_758_5,
    -0.864_864_423_359_769_1,
    -0.741_531_185_599_394_4,
    -0.586_087_235_467_691_1,
    -0.405_845_151_377_397_2,
    -0.207_784_955_007_898_47,
    0.0,
    0.207_784_955_007_898_47,
    0.405_845_151_377_397_2,
    0.586_087_235_467_691_1,
    0.741_531_185_599_394_4,
    0.864_864_423_359_769_1,
    0.949_107_912_342_758_5,
    0.991_455_371_120_812_6,
];
/// Kronrod weights of the first eight nodes; the rest mirror them.
const WEIGHTS: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
/// Gauss weights of the nodes 1, 3, 5, 7; the rest mirror them.
const GAUSS_WEIGHTS: [f64; 4] = [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// One interval integrated by both rules.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// The Kronrod value.
    pub integral: f64,
    /// |Gauss − Kronrod|, an error estimate.
    pub error: f64,
    /// The integrand at [`NODES`] mapped to the interval.
    pub values: [f64; KRONROD],
}

/// Integrates `f` over `a…b` with 15 evaluations.
pub fn kronrod(a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> Panel {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let values = NODES.map(|x| f(middle + half * x));
    let (mut wide, mut narrow) = (values[7] * WEIGHTS[7], values[7] * GAUSS_WEIGHTS[3]);
    for i in 0..7 {
        let pair = values[i] + values[KRONROD - 1 - i];
        wide += pair * WEIGHTS[i];
        if i % 2 == 1 {
            narrow += pair * GAUSS_WEIGHTS[i / 2];
        }
    }
    Panel { integral: wide * half, error: ((wide - narrow) * half).abs(), values }
}

/// Integrates `f` over `a…b`, halving where the estimated error exceeds its share of `relative` × |integral so far| + `absolute`.
///
/// Returns the integral and the sum of the error estimates; intervals are halved at most `depth` times.
pub fn integrate(a: f64, b: f64, relative: f64, absolute: f64, depth: u32, mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    let (mut total, mut error) = (0.0, 0.0);
    let mut open = vec![(a, b, depth)];
    while let Some((a, b, left)) = open.pop() {
        job::poll();
        let panel = kronrod(a, b, &mut f);
        let middle = 0.5 * (a + b);
        if left == 0 || panel.error <= relative * f64::abs(total + panel.integral) + absolute || !(a < middle && middle < b) {
            total += panel.integral;
            error += panel.error;
        } else {
            open.push((middle, b, left - 1));
            open.push((a, middle, left - 1));
        }
    }
    (total, error)
}

/// Chebyshev coefficients of x ↦ ∫₋₁ˣ of the polynomial through the values at [`NODES`].
pub fn running_integral(values: &[f64; KRONROD]) -> [f64; RUNNING] {
    static MATRIX: OnceLock<Vec<[f64; RUNNING]>> = OnceLock::new();
    let matrix = MATRIX.get_or_init(running_matrix);
    let mut sum = [0.0; RUNNING];
    for (row, value) in matrix.iter().zip(values) {
        for (s, m) in sum.iter_mut().zip(row) {
            *s += m * value;
        }
    }
    sum
}

/// Row `i`: the coefficients for the value 1 at node `i` and 0 at all others.
fn running_matrix() -> Vec<[f64; RUNNING]> {
    let mut vandermonde = vec![0.0; KRONROD * KRONROD];
    for (i, x) in NODES.iter().enumerate() {
        let (mut now, mut next) = (1.0, *x);
        for j in 0..KRONROD {
            vandermonde[i * KRONROD + j] = now;
            (now, next) = (next, 2.0 * x * next - now);
        }
    }
    (0..KRONROD)
        .map(|i| {
            let mut a = vec![0.0; KRONROD];
            a[i] = 1.0;
            // The nodes differ, so the matrix is regular.
            solve::dense(&mut vandermonde.clone(), &mut a);
            let at = |k: usize| a.get(k).copied().unwrap_or(0.0);
            let mut b = [0.0; RUNNING];
            b[1] = at(0) - 0.5 * at(2);
            for (k, b) in b.iter_mut().enumerate().skip(2) {
                *b = (at(k - 1) - at(k + 1)) / (2 * k) as f64;
            }
            b[0] = -(1..RUNNING).map(|k| if k % 2 == 0 { b[k] } else { -b[k] }).sum::<f64>();
            b
        })
        .collect()
}

/// Value and derivative of Σ cₖ Tₖ(x) at x in −1…1, by Clenshaw's recurrence and its derivative; at least one coefficient.
#[inline]
pub fn chebyshev(c: &[f64], x: f64) -> (f64, f64) {
    let (mut b1, mut b2, mut d1, mut d2) = (0.0, 0.0, 0.0, 0.0);
    let twice = 2.0 * x;
    for k in (1..c.len()).rev() {
        (d1, d2) = (2.0 * b1 + twice * d1 - d2, d1);
        (b1, b2) = (c[k] + twice * b1 - b2, b1);
    }
    (c[0] + x * b1 - b2, b1 + x * d1 - d2)
}

/// Nodes (ascending over −1…1) and weights of the n-point Gauss–Legendre rule, exact to degree 2n − 1.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = -math::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            let mut slope = 1.0;
            // Newton from Tricomi's estimate gains all digits in four steps; six are safe.
            for _ in 0..6 {
                let (mut p0, mut p1) = (1.0, x);
                for k in 2..=n {
                    (p0, p1) = (p1, ((2 * k - 1) as f64 * x * p1 - (k - 1) as f64 * p0) / k as f64);
                }
                if n == 1 {
                    (p0, p1) = (1.0, x);
                }
                slope = n as f64 * (x * p1 - p0) / (x * x - 1.0);
                x -= p1 / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kronrod_is_exact_to_degree_22_and_gauss_to_13() {
        for degree in 0..=22 {
            let panel = kronrod(0.0, 1.0, |x| math::powi(x, degree));
            assert!((panel.integral - 1.0 / f64::from(degree + 1)).abs() < 1e-15, "{degree}");
            assert_eq!(panel.error < 1e-15, degree <= 13, "{degree} {}", panel.error);
        }
    }

    #[test]
    fn running_integral_is_the_integral_up_to_x() {
        let values = NODES.map(math::exp);
        let c = running_integral(&values);
        for x in [-1.0, -0.7, 0.0, 0.3, 1.0] {
            let (s, speed) = chebyshev(&c, x);
            assert!((s - (math::exp(x) - math::exp(-1.0))).abs() < 3e-15, "{x} {s}");
            assert!((speed - math::exp(x)).abs() < 1e-12, "{x} {speed}");
        }
    }

    #[test]
    fn adaptive_rule_meets_a_kink() {
        let (value, error) = integrate(-1.0, 2.0, 1e-13, 1e-16, 50, |x| (x - 0.1).abs());
        assert!((value - (1.1 * 1.1 + 1.9 * 1.9) / 2.0).abs() < 1e-12 && error < 1e-11);
    }

    #[test]
    fn gauss_rules_are_exact() {
        for n in 1..=20_usize {
            let rule = gauss_legendre(n);
            let degree = (2 * n - 2) as i32;
            let sum: f64 = rule.iter().map(|(x, w)| w * math::powi(*x, degree)).sum();
            assert!((sum - 2.0 / f64::from(degree + 1)).abs() < 1e-14, "{n} {sum}");
        }
    }
}
