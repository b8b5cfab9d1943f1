//! How many steps each segment gets: strips of opposite sides, written counts, sums of several segments.
//!
//! Unknown are whole numbers, one a segment. Opposite sides of a mapped face are equal sums of them. Written counts are
//! kept to the letter; all else is raised, never lowered below what limits ask, until every face is satisfied.

use std::collections::BTreeMap;

use crate::base::{job, work};
use crate::mesh::border::counts::{largest, share};
use crate::mesh::divide::parity::{self, Sum};
use crate::model::glue::root;

/// One segment (or one inner direction of a face without a side that could tell).
#[derive(Clone, Debug)]
pub struct Unknown {
    /// Least count that limits (chord, angle, shape) allow, with at least 1.
    pub least: u32,
    /// Wanted count: the largest of size and limits.
    pub demand: u32,
    /// A written count.
    pub written: Option<u32>,
    /// Length, model units; the longest step is the first to be halved.
    pub length: f64,
    /// The count is even, unless a written one leaves no way: quads that no map gives are best so.
    pub even: bool,
}

/// What a face asks.
#[derive(Clone, Debug)]
pub enum Relation {
    /// Both sums are equal.
    Equal(Vec<usize>, Vec<usize>),
    /// The border of quads that no map gives: an even sum.
    EvenSum(Vec<usize>),
    /// Three sides filled with quads: an even sum, each side less than the other two together.
    ThreeSides([Vec<usize>; 3]),
}

/// Why there is no solution. Indices are of segments and relations.
#[derive(Clone, Debug, PartialEq)]
pub enum Conflict {
    /// Two written counts meet: sums of both sides and a written segment behind each (`None` where only size speaks).
    Differ {
        /// The face's relation.
        relation: usize,
        /// Sum along one side and the written segment behind it.
        a: (u32, Option<usize>),
        /// Sum along the other.
        b: (u32, Option<usize>),
    },
    /// A written count makes a segment too coarse.
    TooCoarse {
        /// The written segment.
        written: usize,
        /// The segment that needs more.
        needs: usize,
        /// What it needs.
        least: u32,
    },
    /// Three sides that quads cannot fill.
    ThreeSides {
        /// The face's relation.
        relation: usize,
        /// Sums of the sides.
        counts: [u32; 3],
        /// Written segments behind them.
        written: Vec<usize>,
    },
    /// A written count is odd where quads that no map gives need an even one, or makes such a count odd.
    Odd {
        /// The written segment, where there is one.
        written: Option<usize>,
        /// The segment that needs an even count.
        needs: usize,
    },
    /// Counts would grow without end: a side is opposite to a part of itself.
    Endless {
        /// The face's relation.
        relation: usize,
    },
}

/// Strips: segments joined because each is the whole of one of two opposite sides.
struct Strip {
    least: (u32, usize),
    demand: u32,
    length: f64,
    /// The count, once it follows from a written one, and the written segment it follows from.
    fixed: Option<(u32, usize)>,
    /// A segment that needs an even count.
    even: Option<usize>,
    /// Whether the count is odd, where that is settled ahead.
    odd: Option<bool>,
}

impl Strip {
    /// The least count from `count` on that is as even or odd as it has to be.
    fn from(&self, count: u32) -> u32 {
        count + u32::from(self.odd.is_some_and(|odd| odd != (count % 2 == 1)))
    }

    /// What the count is raised by.
    fn step(&self) -> u32 {
        1 + u32::from(self.odd.is_some())
    }
}

struct Solver<'a> {
    strip_of: Vec<usize>,
    strips: Vec<Strip>,
    relations: &'a [Relation],
    count: Vec<u32>,
    limit: u32,
    /// Lengths that differ by no more are one, model units.
    near: f64,
}

/// Least counts that satisfy all relations, and the strip of each segment. Sums stay below `limit`; of steps whose lengths differ
/// by no more than `near` the first is raised.
pub fn solve(segments: &[Unknown], relations: &[Relation], (limit, near): (u32, f64)) -> Result<(Vec<u32>, Vec<usize>), Conflict> {
    let mut solver = Solver::new(segments, relations, (limit, near))?;
    solver.parities()?;
    solver.pass_on()?;
    for (n, strip) in solver.strips.iter().enumerate() {
        solver.count[n] = strip.fixed.map_or(strip.from(strip.demand.max(strip.least.0)), |f| f.0);
    }
    solver.raise()?;
    Ok((solver.strip_of.iter().map(|s| solver.count[*s]).collect(), solver.strip_of))
}

impl<'a> Solver<'a> {
    fn new(segments: &[Unknown], relations: &'a [Relation], (limit, near): (u32, f64)) -> Result<Self, Conflict> {
        let mut parent: Vec<usize> = (0..segments.len()).collect();
        for relation in relations {
            if let Relation::Equal(a, b) = relation
                && let ([a], [b]) = (a.as_slice(), b.as_slice())
            {
                let (ra, rb) = (root(&mut parent, *a), root(&mut parent, *b));
                parent[ra.max(rb)] = ra.min(rb);
            }
        }
        let (mut strip_of, mut strips): (Vec<usize>, Vec<Strip>) = (vec![0; segments.len()], Vec::new());
        for (n, segment) in segments.iter().enumerate() {
            let r = root(&mut parent, n);
            if r == n {
                strip_of[n] = strips.len();
                strips.push(Strip { least: (0, n), demand: 0, length: 0.0, fixed: None, even: None, odd: None });
            } else {
                strip_of[n] = strip_of[r];
            }
            let strip = &mut strips[strip_of[n]];
            strip.demand = strip.demand.max(segment.demand);
            strip.length = strip.length.max(segment.length);
            strip.even = strip.even.or(segment.even.then_some(n));
            if segment.least > strip.least.0 {
                strip.least = (segment.least, n);
            }
            match (segment.written, strip.fixed) {
                (Some(count), None) => strip.fixed = Some((count, n)),
                (Some(count), Some((other, by))) if other != count => {
                    let joins = |r: &Relation| matches!(r, Relation::Equal(a, b) if a.contains(&n) || b.contains(&n));
                    let relation = relations.iter().position(joins).unwrap_or(0);
                    return Err(Conflict::Differ { relation, a: (other, Some(by)), b: (count, Some(n)) });
                }
                _ => {}
            }
        }
        for strip in &strips {
            if let Some((count, by)) = strip.fixed
                && count < strip.least.0
            {
                return Err(Conflict::TooCoarse { written: by, needs: strip.least.1, least: strip.least.0 });
            }
        }
        let count = vec![0; strips.len()];
        Ok(Self { strip_of, strips, relations, count, limit, near })
    }

    /// Settles which counts are even and which odd, where some have to be even.
    fn parities(&mut self) -> Result<(), Conflict> {
        let needed: Vec<usize> = (0..self.strips.len()).filter(|s| self.strips[*s].even.is_some()).collect();
        if needed.is_empty() {
            return Ok(());
        }
        let sums: Vec<Sum> = self.relations.iter().map(|relation| self.sum_of(relation)).collect();
        let written: Vec<Option<bool>> = self.strips.iter().map(|s| s.fixed.map(|f| f.0 % 2 == 1)).collect();
        let even: Vec<Option<bool>> = self.strips.iter().zip(&written).map(|(s, w)| w.or(s.even.map(|_| false))).collect();
        // All even where that can be; else as few as equations leave are not.
        let found = parity::solve(&even, &needed, &sums).or_else(|_| parity::solve(&written, &needed, &sums));
        let found = found.map_err(|relation| self.odd(&sums[relation]))?;
        self.strips.iter_mut().zip(found).for_each(|(strip, odd)| strip.odd = odd);
        for strip in &mut self.strips {
            strip.least.0 = strip.from(strip.least.0);
        }
        Ok(())
    }

    /// The strips that a relation has an odd number of times.
    fn sum_of(&self, relation: &Relation) -> Sum {
        let mut sum = Sum::new();
        let mut add = |n: &usize| {
            let strip = self.strip_of[*n];
            if !sum.remove(&strip) {
                sum.insert(strip);
            }
        };
        match relation {
            Relation::Equal(a, b) => a.iter().chain(b).for_each(&mut add),
            Relation::EvenSum(all) => all.iter().for_each(&mut add),
            Relation::ThreeSides(sides) => sides.iter().flatten().for_each(&mut add),
        }
        sum
    }

    /// What to say where a sum cannot be even: a written segment in it and one that needs to be even, of it or of any.
    fn odd(&self, sum: &Sum) -> Conflict {
        let strips = || sum.iter().map(|s| &self.strips[*s]).chain(&self.strips);
        let written = strips().find_map(|s| s.fixed.filter(|f| f.0 % 2 == 1).map(|f| f.1));
        Conflict::Odd { written, needs: strips().find_map(|s| s.even).unwrap_or(0) }
    }

    /// Strips of a side with how often each is on it.
    fn side(&self, side: &[usize]) -> BTreeMap<usize, i64> {
        let mut sum = BTreeMap::new();
        side.iter().for_each(|n| *sum.entry(self.strip_of[*n]).or_insert(0) += 1);
        sum
    }

    /// Left minus right of an equality, strips that cancel left out.
    fn balance(&self, a: &[usize], b: &[usize]) -> BTreeMap<usize, i64> {
        let mut sum = self.side(a);
        b.iter().for_each(|n| *sum.entry(self.strip_of[*n]).or_insert(0) -= 1);
        sum.retain(|_, c| *c != 0);
        sum
    }

    /// Written counts determine what stands opposite to them, face after face.
    fn pass_on(&mut self) -> Result<(), Conflict> {
        loop {
            let mut changed = false;
            work::spend(self.relations.len() as u64);
            for r in 0..self.relations.len() {
                job::poll();
                changed |= match &self.relations[r] {
                    Relation::Equal(a, b) => self.pass_over(r, a, b)?,
                    Relation::EvenSum(_) => false,
                    Relation::ThreeSides(sides) => self.pass_corner(r, sides)?,
                };
            }
            if !changed {
                return Ok(());
            }
        }
    }

    fn pass_over(&mut self, relation: usize, a: &[usize], b: &[usize]) -> Result<bool, Conflict> {
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
        match self.settle(&open, target as u32, by) {
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
    fn settle(&mut self, open: &[(usize, i64)], target: u32, by: usize) -> Option<()> {
        if open.iter().any(|(s, _)| self.strips[*s].odd.is_some()) {
            return self.settle_by_two(open, target, by);
        }
        let weights: Vec<f64> = open.iter().map(|(s, c)| c.abs() as f64 * f64::from(self.strips[*s].demand)).collect();
        let least: Vec<u32> = open.iter().map(|(s, c)| c.unsigned_abs() as u32 * self.strips[*s].least.0).collect();
        let shares = share(target, (&weights, 0.0), &least)?;
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

    /// The same where counts are even or odd ahead: the strips with the longest steps get two more, until it is made up.
    fn settle_by_two(&mut self, open: &[(usize, i64)], target: u32, by: usize) -> Option<()> {
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
    fn pass_corner(&mut self, relation: usize, sides: &[Vec<usize>; 3]) -> Result<bool, Conflict> {
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
        self.settle(&free, (target - fixed) as u32, cause).ok_or(fail)?;
        Ok(true)
    }

    /// Raises strips that nothing fixes until every face is satisfied.
    fn raise(&mut self) -> Result<(), Conflict> {
        loop {
            let mut changed = false;
            work::spend(self.relations.len() as u64);
            for r in 0..self.relations.len() {
                job::poll();
                changed |= match &self.relations[r] {
                    Relation::Equal(a, b) => self.raise_over(r, a, b)?,
                    Relation::EvenSum(_) => false,
                    Relation::ThreeSides(sides) => self.raise_corner(r, sides)?,
                };
            }
            if !changed {
                return Ok(());
            }
        }
    }

    fn raise_over(&mut self, relation: usize, a: &[usize], b: &[usize]) -> Result<bool, Conflict> {
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

    fn raise_corner(&mut self, relation: usize, sides: &[Vec<usize>; 3]) -> Result<bool, Conflict> {
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
            let calm: Vec<_> = odd.iter().copied().filter(|(s, _)| fits(s) && self.strips[*s].fixed.is_none()).collect();
            self.lift(relation, if calm.is_empty() { &odd } else { &calm }, 1).map_err(|_| fail)?;
            return Ok(true);
        }
        Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn soft(demand: u32) -> Unknown {
        Unknown { least: 1, demand, written: None, length: f64::from(demand), even: false }
    }

    fn written(count: u32) -> Unknown {
        Unknown { written: Some(count), ..soft(3) }
    }

    fn check(segments: &[Unknown], relations: &[Relation], expected: Result<&[u32], Conflict>) {
        let found = solve(segments, relations, (10_000, 0.0)).map(|r| r.0);
        assert_eq!(found, expected.map(<[u32]>::to_vec));
        if let Ok(n) = found {
            let sum = |side: &Vec<usize>| side.iter().map(|k| n[*k]).sum::<u32>();
            for relation in relations {
                match relation {
                    Relation::Equal(a, b) => assert_eq!(sum(a), sum(b)),
                    Relation::EvenSum(all) => assert_eq!(sum(all) % 2, 0),
                    Relation::ThreeSides(s) => {
                        let [a, b, c] = [sum(&s[0]), sum(&s[1]), sum(&s[2])];
                        assert!((a + b + c) % 2 == 0 && a < b + c && b < a + c && c < a + b, "{a} {b} {c}");
                    }
                }
            }
        }
    }

    fn equal(a: &[usize], b: &[usize]) -> Relation {
        Relation::Equal(a.to_vec(), b.to_vec())
    }

    #[test]
    fn a_strip_takes_its_largest_wish() {
        check(&[soft(3), soft(7), soft(5)], &[equal(&[0], &[1]), equal(&[1], &[2])], Ok(&[7, 7, 7]));
    }

    #[test]
    fn a_written_count_sets_its_strip_against_any_size() {
        check(&[soft(30), written(4), soft(5)], &[equal(&[0], &[1]), equal(&[1], &[2])], Ok(&[4, 4, 4]));
    }

    #[test]
    fn two_written_counts_that_differ_are_refused() {
        let conflict = Conflict::Differ { relation: 0, a: (10, Some(0)), b: (12, Some(1)) };
        check(&[written(10), written(12)], &[equal(&[0], &[1])], Err(conflict));
    }

    #[test]
    fn a_written_count_below_a_limit_is_refused() {
        let fine = Unknown { least: 9, ..soft(9) };
        check(&[written(4), fine], &[equal(&[0], &[1])], Err(Conflict::TooCoarse { written: 0, needs: 1, least: 9 }));
    }

    #[test]
    fn several_segments_add_up() {
        check(&[soft(9), soft(4), soft(3)], &[equal(&[0], &[1, 2])], Ok(&[9, 5, 4]));
        check(&[soft(5), soft(4), soft(3)], &[equal(&[0], &[1, 2])], Ok(&[7, 4, 3]));
        check(&[written(5), soft(4), soft(4)], &[equal(&[0], &[1, 2])], Ok(&[5, 3, 2]));
        check(&[soft(50), written(4), written(3)], &[equal(&[0], &[1, 2])], Ok(&[7, 4, 3]));
    }

    #[test]
    fn sums_of_written_counts_are_kept_or_refused() {
        let conflict = Conflict::Differ { relation: 0, a: (2, Some(0)), b: (3, None) };
        check(&[written(2), soft(4), soft(3), soft(9)], &[equal(&[0], &[1, 2, 3])], Err(conflict));
        let conflict = Conflict::Differ { relation: 0, a: (9, Some(0)), b: (8, Some(1)) };
        check(&[written(9), written(4), written(4)], &[equal(&[0], &[1, 2])], Err(conflict));
    }

    #[test]
    fn a_side_opposite_to_a_part_of_itself_has_no_count() {
        check(&[soft(3), soft(2)], &[equal(&[0], &[0, 1])], Err(Conflict::Endless { relation: 0 }));
    }

    fn even(demand: u32) -> Unknown {
        Unknown { even: true, ..soft(demand) }
    }

    #[test]
    fn even_counts_pass_over_mapped_faces() {
        check(&[even(5)], &[], Ok(&[6]));
        check(&[even(5), soft(7), soft(3)], &[equal(&[0], &[1])], Ok(&[8, 8, 3]));
        check(&[even(9), soft(4), soft(3)], &[equal(&[0], &[1, 2])], Ok(&[10, 6, 4]));
        // What is written odd makes its neighbour odd.
        check(&[even(9), written(5), soft(3)], &[equal(&[0], &[1, 2])], Ok(&[10, 5, 5]));
        check(&[written(10), even(4), soft(4)], &[equal(&[0], &[1, 2])], Ok(&[10, 6, 4]));
        check(&[written(5)], &[], Ok(&[5]));
    }

    #[test]
    fn odd_counts_that_must_be_even_are_refused() {
        let border = |all: &[usize]| Relation::EvenSum(all.to_vec());
        check(&[even(5), written(7)], &[border(&[0, 1])], Ok(&[5, 7]));
        check(&[even(5), even(4), written(7)], &[border(&[0, 1, 2])], Ok(&[5, 4, 7]));
        check(&[even(4), written(7)], &[equal(&[0], &[1]), border(&[0])], Err(Conflict::Odd { written: Some(1), needs: 0 }));
        let both = [equal(&[0], &[1, 2]), border(&[0, 3])];
        check(&[even(4), written(7), written(4), written(6)], &both, Err(Conflict::Odd { written: Some(1), needs: 0 }));
        check(&[even(4), written(7), written(4), written(5)], &both, Ok(&[11, 7, 4, 5]));
    }

    #[test]
    fn three_sides_for_quads() {
        let face = |a, b, c| Relation::ThreeSides([vec![a], vec![b], vec![c]]);
        check(&[soft(4), soft(4), soft(4)], &[face(0, 1, 2)], Ok(&[4, 4, 4]));
        check(&[soft(5), soft(5), soft(5)], &[face(0, 1, 2)], Ok(&[6, 5, 5]));
        check(&[soft(9), soft(2), soft(2)], &[face(0, 1, 2)], Ok(&[9, 6, 5]));
        check(&[soft(9), written(3), written(3)], &[face(0, 1, 2)], Ok(&[4, 3, 3]));
        let conflict = Conflict::ThreeSides { relation: 0, counts: [9, 3, 3], written: vec![0, 1, 2] };
        check(&[written(9), written(3), written(3)], &[face(0, 1, 2)], Err(conflict));
    }
}
