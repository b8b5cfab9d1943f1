//! Written counts propagated over equations: what stands opposite to them is fixed, face after face.

use std::collections::BTreeMap;

use crate::base::work;
use crate::mesh::border::counts::share;
use crate::mesh::divide::equations::Conflict;
use crate::mesh::divide::strips::{Solver, Strip};

impl Solver<'_> {
    /// Fixes the strips whose counts follow from written ones, until nothing changes.
    pub(super) fn propagate(&mut self) -> Result<(), Conflict> {
        self.until_unchanged(Self::over_equality, Self::over_three_sides)
    }

    /// One strip or several on one side of an equality are fixed where all others are; whether some were.
    fn over_equality(&mut self, relation: usize, a: &[usize], b: &[usize]) -> Result<bool, Conflict> {
        let balance = self.balance(a, b);
        let known: i64 = balance.iter().filter_map(|(s, c)| self.strips[*s].fixed.map(|f| c * i64::from(f.0))).sum();
        let open: Vec<(usize, i64)> = balance.iter().filter(|(s, _)| self.strips[**s].fixed.is_none()).map(|(s, c)| (*s, *c)).collect();
        if open.is_empty() {
            return if known == 0 { Ok(false) } else { Err(self.differ(relation, a, b)) };
        }
        let sign = open[0].1.signum();
        if balance.len() == open.len() || open.iter().any(|(_, c)| c.signum() != sign) {
            // Nothing written here, or both sides still have room.
            return if balance.len() == open.len() && open.iter().all(|(_, c)| c.signum() == sign) {
                Err(Conflict::Endless { relation })
            } else {
                Ok(false)
            };
        }
        let target = -known * sign;
        let Some(by) = self.cause(&balance, -sign).or_else(|| self.cause(&balance, sign)) else {
            return Ok(false);
        };
        let least: i64 = open.iter().map(|(s, c)| c.abs() * i64::from(self.strips[*s].least.0)).sum();
        if target < least {
            let limiting = open.iter().find(|(s, _)| self.strips[*s].least.0 > 1);
            return Err(match limiting {
                Some((s, _)) if target > 0 => {
                    Conflict::TooCoarse { written: by, needs: self.strips[*s].least.1, least: self.strips[*s].least.0 }
                }
                _ => self.differ(relation, a, b),
            });
        }
        match self.share_out(&open, target as u32, by) {
            Some(()) => Ok(true),
            None => Err(self.differ(relation, a, b)),
        }
    }

    /// A written segment behind the strips on one side (the sign) of an equality.
    fn cause(&self, balance: &BTreeMap<usize, i64>, sign: i64) -> Option<usize> {
        balance.iter().filter(|(_, c)| **c * sign > 0).find_map(|(s, _)| self.strips[*s].fixed.map(|f| f.1))
    }

    /// Both sums as far as they are known; where nothing is written the least that is possible.
    fn differ(&self, relation: usize, a: &[usize], b: &[usize]) -> Conflict {
        let balance = self.balance(a, b);
        let sum = |side: &[usize]| -> u32 {
            self.side(side).iter().map(|(s, c)| *c as u32 * self.strips[*s].fixed.map_or(self.strips[*s].least.0, |f| f.0)).sum()
        };
        Conflict::Differ { relation, a: (sum(a), self.cause(&balance, 1)), b: (sum(b), self.cause(&balance, -1)) }
    }

    /// Gives strips counts whose weighted sum is `target`, by their demands.
    fn share_out(&mut self, open: &[(usize, i64)], target: u32, by: usize) -> Option<()> {
        if open.iter().any(|(s, _)| self.strips[*s].odd.is_some()) {
            return self.share_out_by_parity(open, target, by);
        }
        let weights: Vec<f64> = open.iter().map(|(s, c)| c.abs() as f64 * f64::from(self.strips[*s].demand)).collect();
        let least: Vec<u32> = open.iter().map(|(s, c)| c.unsigned_abs() as u32 * self.strips[*s].least.0).collect();
        let shares = share(target, &weights, 0.0, &least)?;
        let mut counts: Vec<u32> = shares.iter().zip(open).map(|(n, (_, c))| n / c.unsigned_abs() as u32).collect();
        let mut left = target - counts.iter().zip(open).map(|(n, (_, c))| n * c.unsigned_abs() as u32).sum::<u32>();
        while left > 0 {
            work::spend(open.len() as u64);
            // A strip that lies on the side twice takes two at a time.
            let fits = |i: &usize| open[*i].1.unsigned_abs() as u32 <= left;
            let room = |i: &usize| weights[*i] / f64::from(counts[*i] + 1);
            let i = (0..open.len()).filter(fits).max_by(|x, y| room(x).total_cmp(&room(y)).then(y.cmp(x)))?;
            counts[i] += 1;
            left -= open[i].1.unsigned_abs() as u32;
        }
        for (n, (s, _)) in counts.iter().zip(open) {
            self.strips[*s].fixed = Some((*n, by));
        }
        Some(())
    }

    /// The same where parities are known: the strips with the longest steps get two more, until the target is reached.
    fn share_out_by_parity(&mut self, open: &[(usize, i64)], target: u32, by: usize) -> Option<()> {
        let mut counts: Vec<u32> = open.iter().map(|(s, _)| self.strips[*s].least.0).collect();
        let sum: u32 = counts.iter().zip(open).map(|(n, (_, c))| n * c.unsigned_abs() as u32).sum();
        let mut left = target.checked_sub(sum)?;
        while left > 0 {
            work::spend(open.len() as u64);
            let more = |i: usize| open[i].1.unsigned_abs() as u32 * self.strips[open[i].0].step();
            let room = |i: &usize| f64::from(self.strips[open[*i].0].demand) / f64::from(counts[*i]);
            let fits = (0..open.len()).filter(|i| more(*i) <= left);
            let i = fits.max_by(|x, y| room(x).total_cmp(&room(y)).then(y.cmp(x)))?;
            left -= more(i);
            counts[i] += self.strips[open[i].0].step();
        }
        for (n, (s, _)) in counts.iter().zip(open) {
            self.strips[*s].fixed = Some((*n, by));
        }
        Some(())
    }

    /// Two written sides of three leave a range for the third.
    fn over_three_sides(&mut self, relation: usize, sides: &[Vec<usize>; 3]) -> Result<bool, Conflict> {
        let maps: Vec<_> = sides.iter().map(|s| self.side(s)).collect();
        let known: Vec<Option<u32>> =
            maps.iter().map(|m| m.iter().map(|(s, c)| self.strips[*s].fixed.map(|f| f.0 * *c as u32)).sum::<Option<u32>>()).collect();
        let open: Vec<usize> = (0..3).filter(|k| known[*k].is_none()).collect();
        let [k] = open.as_slice() else {
            return Ok(false);
        };
        let others: Vec<u32> = (0..3).filter(|o| o != k).filter_map(|o| known[o]).collect();
        let fixed: i64 = maps[*k].iter().filter_map(|(s, c)| self.strips[*s].fixed.map(|f| i64::from(f.0) * c)).sum();
        let free: Vec<(usize, i64)> = maps[*k].iter().filter(|(s, _)| self.strips[**s].fixed.is_none()).map(|(s, c)| (*s, *c)).collect();
        let sum = |f: &dyn Fn(&Strip) -> u32| fixed + free.iter().map(|(s, c)| c * i64::from(f(&self.strips[*s]))).sum::<i64>();
        let (demand, least) = (sum(&|s| s.demand.max(s.least.0)), sum(&|s| s.least.0));
        let (low, high) = (i64::from(others[0].abs_diff(others[1])) + 2, i64::from(others[0] + others[1]) - 2);
        let even = |n: i64| n + (n + i64::from(others[0] + others[1])).rem_euclid(2);
        let target = if even(demand.max(low)) <= high { even(demand.max(low)) } else { high };
        let by: Vec<usize> = (0..3).flat_map(|o| maps[o].keys()).filter_map(|s| self.strips[*s].fixed.map(|f| f.1)).collect();
        let fail =
            Conflict::ThreeSides { relation, counts: [0, 1, 2].map(|o| known[o].unwrap_or(least.max(0) as u32)), written: by.clone() };
        if target < least || target < low {
            return Err(fail);
        }
        let Some(&cause) = by.first() else {
            return Ok(false);
        };
        self.share_out(&free, (target - fixed) as u32, cause).ok_or(fail)?;
        Ok(true)
    }
}
