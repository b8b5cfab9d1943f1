//! Counts that nothing fixes, raised until every face is satisfied.

use std::collections::BTreeMap;

use crate::base::work;
use crate::mesh::border::counts::largest;
use crate::mesh::divide::equations::Conflict;
use crate::mesh::divide::strips::Solver;

impl Solver<'_> {
    /// Raises strips that nothing fixes until every face is satisfied.
    pub(super) fn raise(&mut self) -> Result<(), Conflict> {
        self.until_unchanged(Self::raise_equality, Self::raise_three_sides)
    }

    /// Raises the side of an equality that is short; whether it was.
    fn raise_equality(&mut self, relation: usize, a: &[usize], b: &[usize]) -> Result<bool, Conflict> {
        let balance = self.balance(a, b);
        let miss: i64 = balance.iter().map(|(s, c)| c * i64::from(self.count[*s])).sum();
        if miss == 0 {
            return Ok(false);
        }
        // A side that is short by less than a strip counts on it overshoots, and the other side follows.
        let candidates: Vec<(usize, i64)> = balance.iter().filter(|(_, c)| **c * miss < 0).map(|(s, c)| (*s, c.abs())).collect();
        self.lift(relation, &candidates, miss.abs())?;
        Ok(true)
    }

    /// Raises the strips with the longest steps until `deficit` is made up.
    fn lift(&mut self, relation: usize, candidates: &[(usize, i64)], mut deficit: i64) -> Result<(), Conflict> {
        while deficit > 0 {
            work::spend(candidates.len() as u64);
            let step = |k: &usize| self.strips[candidates[*k].0].length / f64::from(self.count[candidates[*k].0]);
            let free = (0..candidates.len()).filter(|k| self.strips[candidates[*k].0].fixed.is_none());
            let Some((s, c)) = largest(free, step, self.near).map(|k| candidates[k]) else {
                return Err(Conflict::Endless { relation });
            };
            if self.count[s] >= self.limit {
                return Err(Conflict::Endless { relation });
            }
            let step = self.strips[s].step();
            self.count[s] += step;
            deficit -= c * i64::from(step);
        }
        Ok(())
    }

    /// Raises the sides of a triangle of quads until each is less than the others and the sum is even; whether any was.
    fn raise_three_sides(&mut self, relation: usize, sides: &[Vec<usize>; 3]) -> Result<bool, Conflict> {
        let maps: Vec<_> = sides.iter().map(|s| self.side(s)).collect();
        let sums: Vec<i64> = maps.iter().map(|m| m.iter().map(|(s, c)| c * i64::from(self.count[*s])).sum()).collect();
        let counts = [0, 1, 2].map(|k| sums[k] as u32);
        let written = || maps.iter().flat_map(|m| m.keys()).filter_map(|s| self.strips[*s].fixed.map(|f| f.1)).collect();
        let fail = Conflict::ThreeSides { relation, counts, written: written() };
        let total: i64 = sums.iter().sum();
        for (k, sum) in sums.iter().enumerate() {
            if 2 * sum >= total {
                let mut net: BTreeMap<usize, i64> = BTreeMap::new();
                for (o, map) in maps.iter().enumerate() {
                    map.iter().for_each(|(s, c)| *net.entry(*s).or_insert(0) += if o == k { -c } else { *c });
                }
                let rising: Vec<(usize, i64)> = net.into_iter().filter(|(_, c)| *c > 0).collect();
                self.lift(relation, &rising, 2 * sum - total + 1).map_err(|_| fail)?;
                return Ok(true);
            }
        }
        if total % 2 != 0 {
            let mut all: BTreeMap<usize, i64> = BTreeMap::new();
            maps.iter().flatten().for_each(|(s, c)| *all.entry(*s).or_insert(0) += c);
            let odd: Vec<(usize, i64)> = all.into_iter().filter(|(_, c)| c % 2 != 0).collect();
            // One more on the longest side of a slender face would have to be answered on the others.
            let fits = |s: &usize| (0..3).all(|k| 2 * (sums[k] + maps[k].get(s).unwrap_or(&0)) <= total);
            let kept: Vec<_> = odd.iter().copied().filter(|(s, _)| fits(s) && self.strips[*s].fixed.is_none()).collect();
            self.lift(relation, if kept.is_empty() { &odd } else { &kept }, 1).map_err(|_| fail)?;
            return Ok(true);
        }
        Ok(false)
    }
}
