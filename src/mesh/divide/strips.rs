//! How many steps each segment gets: strips of opposite sides, written counts, sums of several segments.
//!
//! Unknowns are whole numbers, one for each segment. Opposite sides of a mapped face are equal sums of them. Written counts are
//! kept to the letter; all else is raised, never lowered below the limits, until every face is satisfied.

mod raised_counts;
mod written_counts;

use std::collections::BTreeMap;

use crate::base::{job, work};
use crate::mesh::divide::equations::{Conflict, Relation, Unknown};
use crate::mesh::divide::parity::{self, Sum};
use crate::model::glue::root;

/// Strips: segments joined because each is the whole of one of two opposite sides.
struct Strip {
    least: (u32, usize),
    demand: u32,
    length: f64,
    /// The count, once it follows from a written one, and the written segment it follows from.
    fixed: Option<(u32, usize)>,
    /// A segment that needs an even count.
    even: Option<usize>,
    /// Whether the count is odd, where that is known beforehand.
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
pub fn solve(segments: &[Unknown], relations: &[Relation], limit: u32, near: f64) -> Result<(Vec<u32>, Vec<usize>), Conflict> {
    let mut solver = Solver::new(segments, relations, limit, near)?;
    solver.parities()?;
    solver.propagate()?;
    for (n, strip) in solver.strips.iter().enumerate() {
        solver.count[n] = strip.fixed.map_or(strip.from(strip.demand.max(strip.least.0)), |f| f.0);
    }
    solver.raise()?;
    Ok((solver.strip_of.iter().map(|s| solver.count[*s]).collect(), solver.strip_of))
}

impl<'a> Solver<'a> {
    fn new(segments: &[Unknown], relations: &'a [Relation], limit: u32, near: f64) -> Result<Self, Conflict> {
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

    /// Decides which counts are even and which odd, where some have to be even.
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

    /// The conflict where a sum cannot be even: a written segment in it and one that needs to be even, of it or of any.
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

    /// Goes over all relations until neither step changes a strip; each says whether it did.
    fn until_unchanged(
        &mut self,
        equality: impl Fn(&mut Self, usize, &[usize], &[usize]) -> Result<bool, Conflict>,
        three_sides: impl Fn(&mut Self, usize, &[Vec<usize>; 3]) -> Result<bool, Conflict>,
    ) -> Result<(), Conflict> {
        loop {
            let mut changed = false;
            work::spend(self.relations.len() as u64);
            for (r, relation) in self.relations.iter().enumerate() {
                job::poll();
                changed |= match relation {
                    Relation::Equal(a, b) => equality(self, r, a, b)?,
                    Relation::EvenSum(_) => false,
                    Relation::ThreeSides(sides) => three_sides(self, r, sides)?,
                };
            }
            if !changed {
                return Ok(());
            }
        }
    }

    /// Left minus right of an equality, strips that cancel left out.
    fn balance(&self, a: &[usize], b: &[usize]) -> BTreeMap<usize, i64> {
        let mut sum = self.side(a);
        b.iter().for_each(|n| *sum.entry(self.strip_of[*n]).or_insert(0) -= 1);
        sum.retain(|_, c| *c != 0);
        sum
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
        let found = solve(segments, relations, 10_000, 0.0).map(|r| r.0);
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
    fn a_strip_takes_its_largest_demand() {
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
