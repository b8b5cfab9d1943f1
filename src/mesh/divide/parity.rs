//! Which counts are even and which odd: equations between counts, taken modulo two.
//!
//! Freely meshed faces of quads have an even number of elements on every segment of their border. What is joined to such a segment
//! by mapped faces follows; where there is a choice, even it is.

use std::collections::BTreeSet;

/// Sums of unknowns that are even; an unknown that is in a sum twice is left out.
pub type Sum = BTreeSet<usize>;

/// Parities (`true`: odd) of `n` unknowns of which some are known, so that all sums are even; unknowns that no sum joins to
/// one of `needed` stay `None`.
///
/// Fails with the sum that cannot be even.
pub fn solve(known: &[Option<bool>], needed: &[usize], sums: &[Sum]) -> Result<Vec<Option<bool>>, usize> {
    let reached = reached(known.len(), needed, sums);
    // Each row: unknowns, whether they add up to an odd number, and the sum it comes from. Reduced rows have a first unknown
    // of their own, which no other row has.
    let mut rows: Vec<(usize, Sum, bool)> = Vec::new();
    for (from, sum) in sums.iter().enumerate().filter(|(_, sum)| sum.iter().any(|n| reached[*n])) {
        let mut row: Sum = sum.iter().copied().filter(|n| known[*n].is_none()).collect();
        let mut odd = sum.iter().filter(|n| known[**n] == Some(true)).count() % 2 == 1;
        for (first, other, other_odd) in &rows {
            if row.contains(first) {
                row = row.symmetric_difference(other).copied().collect();
                odd ^= other_odd;
            }
        }
        let Some(first) = row.first().copied() else {
            if odd {
                return Err(from);
            }
            continue;
        };
        for (_, other, other_odd) in rows.iter_mut().filter(|r| r.1.contains(&first)) {
            *other = other.symmetric_difference(&row).copied().collect();
            *other_odd ^= odd;
        }
        rows.push((first, row, odd));
    }
    let mut parity: Vec<Option<bool>> =
        known.iter().zip(&reached).map(|(known, reached)| if *reached { Some(known.unwrap_or(false)) } else { None }).collect();
    for (first, _, odd) in rows {
        parity[first] = Some(odd);
    }
    Ok(parity)
}

/// Unknowns that sums join to one of `needed`.
fn reached(n: usize, needed: &[usize], sums: &[Sum]) -> Vec<bool> {
    let mut of: Vec<Vec<usize>> = vec![Vec::new(); n];
    sums.iter().enumerate().for_each(|(k, sum)| sum.iter().for_each(|s| of[*s].push(k)));
    let (mut reached, mut seen) = (vec![false; n], vec![false; sums.len()]);
    let mut open: Vec<usize> = needed.to_vec();
    while let Some(s) = open.pop() {
        if !std::mem::replace(&mut reached[s], true) {
            for k in &of[s] {
                if !std::mem::replace(&mut seen[*k], true) {
                    open.extend(sums[*k].iter().copied());
                }
            }
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(of: &[usize]) -> Sum {
        of.iter().copied().collect()
    }

    #[test]
    fn what_is_joined_follows_and_the_rest_is_left_alone() {
        let free = [None; 5];
        let even = Some(false);
        let known = [even, None, None, None, None];
        assert_eq!(solve(&known, &[0], &[sum(&[0, 1, 2])]), Ok(vec![even, even, even, None, None]));
        // 0 is even and 1 is written odd, so 2 is odd.
        let known = [even, Some(true), None, None, None];
        assert_eq!(solve(&known, &[0], &[sum(&[0, 1, 2]), sum(&[2, 3])]), Ok(vec![even, Some(true), Some(true), Some(true), None]));
        assert_eq!(solve(&free, &[], &[sum(&[0, 1])]), Ok(free.to_vec()));
    }

    #[test]
    fn a_contradiction_is_named() {
        let known = [Some(false), Some(true), None];
        assert_eq!(solve(&known, &[0], &[sum(&[0, 2]), sum(&[1, 2])]), Err(1));
    }
}
