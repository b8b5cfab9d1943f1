//! The fairest places of points that may move a stated distance: a convex problem, solved by the alternating direction method of
//! multipliers [Boyd et al. 2010] with one copy of the points for each direction of lines.
//!
//! Each copy takes a banded solve along its lines; the points themselves are the mean of the copies drawn back to their balls.
//! The gap of Frank and Wolfe [Jaggi 2013] at these points bounds how much lower any energy in the balls can be.

use glam::DVec3;

use crate::base::job;
use crate::base::tolerance::EPSILON;
use crate::surface::points::fair_lines::Lines;

/// Rounds between two looks at the gap.
const EVERY: usize = 10;
/// How far each copy is taken beyond itself [Eckstein & Bertsekas 1992].
const RELAXED: f64 = 1.6;
/// The first penalty as a share of the stiffness.
const PENALTY: f64 = 0.05;
/// Factors between the residuals that leave the penalty as it is.
const BALANCED: std::ops::RangeInclusive<f64> = 0.5..=2.0;
/// The largest step of the penalty.
const STEP: f64 = 5.0;

/// When the search ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enough {
    /// The gap as a share of the energy before.
    pub gap: f64,
    /// Rounds at most.
    pub rounds: usize,
}

/// Where the points come to rest.
#[derive(Clone, Debug)]
pub struct AtRest {
    /// How each point moved.
    pub moves: Vec<DVec3>,
    /// About how far each point stood off the run of its neighbours: the gradient of the energy over how much of it the point makes.
    pub off: Vec<f64>,
    /// No energy in the balls is lower than the one found by more than this share of the energy before.
    pub gap: f64,
}

/// One direction of lines with its copy of the moves; all x, then all y, then all z.
struct SplitCopy {
    lines: Lines,
    /// The gradient of the energy before anything moved, and over the penalty.
    slope: Vec<f64>,
    push: Vec<f64>,
    moves: Vec<f64>,
    /// Scaled multipliers: what the copy still is off.
    off: Vec<f64>,
}

/// Vectors as all x, then all y, then all z.
fn apart(all: &[DVec3]) -> Vec<f64> {
    (0..3).flat_map(|axis| all.iter().map(move |p| p[axis])).collect()
}

/// Vectors of these.
fn together(all: &[f64]) -> impl Iterator<Item = DVec3> + use<'_> {
    let n = all.len() / 3;
    (0..n).map(move |i| DVec3::new(all[i], all[n + i], all[2 * n + i]))
}

/// The moves of least energy with each no longer than its reach; the lines come back. The energy never rises; points that are fair but
/// for rounding stay.
pub fn at_rest(points: &[DVec3], reach: &[f64], directions: Vec<Lines>, enough: Enough) -> (AtRest, Vec<Lines>) {
    let n = points.len();
    let none = || vec![DVec3::ZERO; n];
    let placed: Vec<DVec3> = points.iter().map(|p| *p - points[0]).collect();
    let stiffness = directions.iter().map(Lines::stiffness).fold(0.0, f64::max);
    let rounding = EPSILON * points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let before = energy(&directions, &placed);
    let mut found = AtRest { moves: none(), off: vec![0.0; n], gap: 0.0 };
    if before <= 0.5 * stiffness * rounding * rounding * n as f64 {
        return (found, directions);
    }
    let copies = directions.into_iter().map(|lines| {
        let mut slope = none();
        lines.add_gradient(&placed, &mut slope);
        let flat = || vec![0.0; 3 * n];
        SplitCopy { lines, slope: apart(&slope), push: flat(), moves: flat(), off: flat() }
    });
    let mut search = Search { reach, penalty: 0.0, copies: copies.collect(), moves: vec![0.0; 3 * n], mean: vec![0.0; 3 * n] };
    search.stand_off(&mut found.off);
    search.set_penalty(PENALTY * stiffness);
    let (mut least, mut at, mut pull) = (before, none(), none());
    found.gap = 1.0;
    // The penalty changes at rounds that are farther and farther apart: one that never settled would not converge.
    let mut settled = EVERY;
    for round in 1..=enough.rounds {
        job::poll();
        let look = round % EVERY == 0 || round == enough.rounds;
        search.step();
        if !look {
            continue;
        }
        at.iter_mut().zip(&placed).zip(together(&search.moves)).for_each(|((at, p), d)| *at = *p + d);
        pull.fill(DVec3::ZERO);
        search.copies.iter().for_each(|copy| copy.lines.add_gradient(&at, &mut pull));
        let gap: f64 = pull.iter().zip(together(&search.moves)).zip(reach).map(|((f, d), r)| f.length() * r + f.dot(d)).sum();
        let now: f64 = search.copies.iter().map(|copy| 0.5 * copy.lines.energy(&at)).sum();
        if now <= least {
            (least, found.gap) = (now, (gap / before).min(1.0));
            found.moves.iter_mut().zip(together(&search.moves)).for_each(|(to, d)| *to = d);
        }
        if gap <= enough.gap * before {
            break;
        }
        if round >= settled {
            search.balance();
            settled = round + round / 2;
        }
    }
    (found, search.copies.into_iter().map(|copy| copy.lines).collect())
}

fn energy(directions: &[Lines], points: &[DVec3]) -> f64 {
    directions.iter().map(|lines| 0.5 * lines.energy(points)).sum()
}

struct Search<'a> {
    reach: &'a [f64],
    penalty: f64,
    copies: Vec<SplitCopy>,
    moves: Vec<f64>,
    /// The mean of the copies; then the moves of the round before.
    mean: Vec<f64>,
}

impl Search<'_> {
    fn set_penalty(&mut self, penalty: f64) {
        self.penalty = penalty;
        for copy in &mut self.copies {
            copy.lines.decompose(penalty);
            copy.push.iter_mut().zip(&copy.slope).for_each(|(push, slope)| *push = slope / penalty);
        }
    }

    /// One round.
    fn step(&mut self) {
        let share = 1.0 / self.copies.len() as f64;
        self.mean.fill(0.0);
        for copy in &mut self.copies {
            let all = copy.moves.iter_mut().zip(&self.moves).zip(&copy.off).zip(&copy.push);
            all.for_each(|(((x, z), u), g)| *x = z - u - g);
            copy.lines.solve(&mut copy.moves);
            let all = copy.off.iter_mut().zip(&copy.moves).zip(&self.moves).zip(&mut self.mean);
            all.for_each(|(((u, x), z), mean)| {
                *u += z + (x - z) * RELAXED;
                *mean += *u * share;
            });
        }
        let n = self.reach.len();
        let (x, rest) = self.mean.split_at_mut(n);
        let (y, z) = rest.split_at_mut(n);
        for (((x, y), z), reach) in x.iter_mut().zip(y).zip(z).zip(self.reach) {
            let far = *x * *x + *y * *y + *z * *z;
            if far > reach * reach {
                let by = reach / far.sqrt();
                (*x, *y, *z) = (*x * by, *y * by, *z * by);
            }
        }
        std::mem::swap(&mut self.mean, &mut self.moves);
        for copy in &mut self.copies {
            copy.off.iter_mut().zip(&self.moves).for_each(|(u, z)| *u -= z);
        }
    }

    /// Another penalty where one residual is much larger than the other, each over what it is a part of: how far the copies are from
    /// the points, and how far these moved in the last round.
    fn balance(&mut self) {
        let squares = |all: &[f64]| all.iter().map(|x| x * x).sum::<f64>();
        let between = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let count = self.copies.len() as f64;
        let apart: f64 = self.copies.iter().map(|copy| between(&copy.moves, &self.moves)).sum();
        let multipliers: f64 = self.copies.iter().map(|copy| squares(&copy.off)).sum();
        let (moved, sizes) = (count * between(&self.moves, &self.mean), count * squares(&self.moves));
        let ratio = ((apart / sizes) / (moved / multipliers)).sqrt().sqrt();
        if !ratio.is_finite() || BALANCED.contains(&ratio) {
            return;
        }
        let by = ratio.clamp(1.0 / STEP, STEP);
        self.copies.iter_mut().flat_map(|copy| &mut copy.off).for_each(|u| *u /= by);
        self.set_penalty(self.penalty * by);
    }

    fn stand_off(&self, to: &mut [f64]) {
        let n = to.len();
        for (i, off) in to.iter_mut().enumerate() {
            let stiffness: f64 = self.copies.iter().map(|copy| copy.lines.stiffness_at(i)).sum();
            let part = |axis: usize| self.copies.iter().map(|copy| copy.slope[axis * n + i]).sum::<f64>();
            let slope = DVec3::new(part(0), part(1), part(2));
            *off = if stiffness > 0.0 { slope.length() / stiffness } else { 0.0 };
        }
    }
}
