//! Parameters where a surface is less than smooth: where quadrature and bounds have to split.

use crate::base::tolerance::Tolerance;
use crate::network::Chain;

/// Fractions of a chain where it is not analytic: joints and distinct knots, 0 and 1 left out, ascending.
pub fn chain_breaks(chain: &Chain) -> Vec<f64> {
    let mut all = Vec::new();
    let joints = chain.joints();
    for (k, run) in chain.runs().iter().enumerate() {
        all.push(joints[k]);
        let (s0, s1) = (run.s0, run.s1);
        let whole = run.curve.length();
        for t in run.curve.knots() {
            let s = run.curve.length_at(t);
            // A run past the start of a closed curve sees the same knot one turn later.
            for s in [s, s + whole] {
                let share = (s - s0) / (s1 - s0);
                if share > 0.0 && share < 1.0 {
                    all.push(joints[k] + share * (joints[k + 1] - joints[k]));
                }
            }
        }
    }
    tidy(all, f64::EPSILON * 64.0)
}

/// Distinct knots strictly inside the domain of a clamped knot vector.
pub fn distinct_inner(knots: &[f64], degree: usize) -> Vec<f64> {
    let (first, last) = (knots[degree], knots[knots.len() - degree - 1]);
    let mut inner: Vec<f64> = knots.iter().copied().filter(|k| *k > first && *k < last).collect();
    inner.dedup();
    inner
}

/// Sorted values strictly inside 0…1, neighbours at least `apart` from each other.
pub fn tidy(mut values: Vec<f64>, apart: f64) -> Vec<f64> {
    values.retain(|x| *x > apart && *x < 1.0 - apart);
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| *b - *a <= apart);
    values
}

/// Kink lines of one direction: for each family member its kinks `(parameter, fraction)`, merged where they are one line.
///
/// `apart` says how far two parameters are in length. Returns the lines and, per member, `(line, fraction)`.
pub fn merge_kinks(
    members: &[Vec<(f64, f64)>],
    tolerance: &Tolerance,
    apart: impl Fn(f64, f64) -> f64,
) -> (Vec<f64>, Vec<Vec<(f64, f64)>>) {
    let mut all: Vec<f64> = members.iter().flatten().map(|k| k.0).collect();
    all.sort_by(f64::total_cmp);
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for x in all {
        match groups.last_mut() {
            Some(group) if x - group.1 <= tolerance.parameter || apart(group.0, x) <= tolerance.point => group.1 = x,
            _ => groups.push((x, x)),
        }
    }
    let lines: Vec<f64> = groups.iter().map(|(a, b)| if a == b { *a } else { 0.5 * (a + b) }).collect();
    let line_of = |x: f64| lines[groups.partition_point(|g| g.1 < x).min(groups.len() - 1)];
    let own = members.iter().map(|kinks| kinks.iter().map(|&(x, f)| (line_of(x), f)).collect()).collect();
    (lines, own)
}
