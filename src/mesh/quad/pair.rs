//! Which triangles become quads together: the best pairs first, then exchanges along rows of triangles that leave fewer alone.

use glam::DVec3;

use crate::base::job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::quad::net::least_sine;
use crate::mesh::quad::settings::PAIRING;
use crate::mesh::tri::triangulation::Triangulation;

/// The value of triangles that stay single against pairs of them.
#[derive(Clone, Copy, Debug)]
pub struct SingleTriangles {
    /// Least quality of a pair.
    pub min_pair_quality: f64,
    /// Quality of a pair that counts like two single triangles.
    pub equal_pair_quality: f64,
}

struct Pairing<'a> {
    triangulation: &'a Triangulation,
    singles: SingleTriangles,
    /// Cost of the pair across each side; infinite where there may be none.
    cost: Vec<[f64; 3]>,
    mate: Vec<u32>,
    /// Triangles of the row that is tried.
    row: Vec<u32>,
    best: (f64, Vec<u32>),
}

/// The triangle that each is paired with, or [`NO_TRIANGLE`]; `normal` are those of the surface at the nodes, `flat`
/// triangles are left out.
pub fn pair(triangulation: &Triangulation, normal: &[DVec3], flat: &[bool], singles: SingleTriangles) -> Vec<u32> {
    let cost = costs(triangulation, normal, flat, singles);
    let mut order: Vec<(f64, u32, u8)> = Vec::new();
    for (t, sides) in cost.iter().enumerate() {
        job::poll();
        for (k, c) in sides.iter().enumerate() {
            if c.is_finite() && triangulation.across[t][k] > t as u32 {
                order.push((*c, t as u32, k as u8));
            }
        }
    }
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut mate = vec![NO_TRIANGLE; triangulation.tri.len()];
    for (_, t, k) in order {
        let other = triangulation.across[t as usize][k as usize];
        if mate[t as usize] == NO_TRIANGLE && mate[other as usize] == NO_TRIANGLE {
            (mate[t as usize], mate[other as usize]) = (other, t);
        }
    }
    let mut pairing = Pairing { triangulation, singles, cost, mate, row: Vec::new(), best: (0.0, Vec::new()) };
    for _ in 0..PAIRING.max_rounds {
        if !pairing.exchange(flat) {
            break;
        }
    }
    pairing.mate
}

/// Costs of all pairs: how far from a square.
fn costs(triangulation: &Triangulation, normal: &[DVec3], flat: &[bool], singles: SingleTriangles) -> Vec<[f64; 3]> {
    let cost = |t: usize, k: usize| {
        let other = triangulation.across[t][k];
        if other == NO_TRIANGLE || triangulation.locked[t] >> k & 1 == 1 || flat[t] || flat[other as usize] {
            return f64::INFINITY;
        }
        let c = triangulation.tri[t];
        let (a, b, d) = (c[k], c[(k + 1) % 3], c[(k + 2) % 3]);
        let Some(tip) = triangulation.tri[other as usize].into_iter().find(|n| *n != b && *n != d) else { return f64::INFINITY };
        let quad = [a, b, tip, d].map(|n| n as usize);
        let quality = least_sine(quad.map(|n| triangulation.p[n]), quad.map(|n| normal[n]));
        if quality < singles.min_pair_quality { f64::INFINITY } else { (loss(quality) * PAIRING.cost_steps).round() / PAIRING.cost_steps }
    };
    let mut all = vec![[f64::INFINITY; 3]; triangulation.tri.len()];
    for t in 0..triangulation.tri.len() {
        job::poll();
        for k in 0..3 {
            let other = triangulation.across[t][k];
            all[t][k] = match (other as usize) < t {
                true => triangulation.across[other as usize]
                    .iter()
                    .position(|o| *o == t as u32)
                    .map_or(f64::INFINITY, |j| all[other as usize][j]),
                false => cost(t, k),
            };
        }
    }
    all
}

/// What a pair of a quality costs.
fn loss(quality: f64) -> f64 {
    (1.0 - quality) * (1.0 - quality)
}

impl Pairing<'_> {
    /// Rows that start from triangles alone; whether any changed.
    fn exchange(&mut self, flat: &[bool]) -> bool {
        let mut changed = false;
        for t in 0..self.triangulation.tri.len() as u32 {
            job::poll();
            if self.mate[t as usize] != NO_TRIANGLE || flat[t as usize] {
                continue;
            }
            self.best = (-PAIRING.min_gain, Vec::new());
            self.row.clear();
            self.row.push(t);
            self.follow(t, 0.0);
            let row = std::mem::take(&mut self.best.1);
            if row.is_empty() {
                continue;
            }
            changed = true;
            for pair in row.chunks(2) {
                match *pair {
                    [a, b] => (self.mate[a as usize], self.mate[b as usize]) = (b, a),
                    [a] => self.mate[a as usize] = NO_TRIANGLE,
                    _ => {}
                }
            }
        }
        changed
    }

    /// Pairs the last triangle of the row with each neighbour in turn, whose own mate is the next one.
    fn follow(&mut self, t: u32, spent: f64) {
        for k in 0..3 {
            let other = self.triangulation.across[t as usize][k];
            let cost = self.cost[t as usize][k];
            if !cost.is_finite() || self.row.contains(&other) {
                continue;
            }
            let next = self.mate[other as usize];
            self.row.push(other);
            if next == NO_TRIANGLE {
                self.keep(spent + cost - 2.0 * loss(self.singles.equal_pair_quality));
            } else {
                let freed =
                    self.triangulation.across[other as usize].iter().position(|o| *o == next).map_or(0.0, |j| self.cost[other as usize][j]);
                let spent = spent + cost - freed;
                self.row.push(next);
                self.keep(spent);
                if self.row.len() < 2 * PAIRING.max_row_pairs {
                    self.follow(next, spent);
                }
                self.row.pop();
            }
            self.row.pop();
        }
    }

    /// Keeps the row if it is the best so far.
    fn keep(&mut self, spent: f64) {
        if spent < self.best.0 {
            self.best = (spent, self.row.clone());
        }
    }
}
