//! Fewer irregular nodes: the side between two faces of a net is put elsewhere across the polygon they fill.

use crate::base::{job, math};
use crate::mesh::chart::halves::NONE;
use crate::mesh::quad::net::{Net, least_sine, least_sine_of_triangle};
use crate::mesh::quad::settings::SWAPS;

/// A right angle, radians.
const RIGHT: f64 = std::f64::consts::FRAC_PI_2;

/// A side of the polygon of two faces: its first node, the side beyond it, whether it is locked, and its middle.
type PolygonSide = (u32, u32, bool, u32);

/// Swaps sides of a net.
pub struct Swapper<'a> {
    net: &'a mut Net,
    /// Faces round each node, and how many there should be.
    valence: Vec<u32>,
    wanted: Vec<u32>,
    polygon: Vec<PolygonSide>,
}

impl<'a> Swapper<'a> {
    /// Takes a net whose faces know their neighbours.
    pub fn new(net: &'a mut Net) -> Self {
        let (mut valence, mut angle) = (vec![0; net.p.len()], vec![0.0; net.fixed as usize]);
        for f in 0..net.face.len() {
            job::poll();
            let c = net.corners(f);
            for (k, n) in c.iter().enumerate() {
                valence[*n as usize] += 1;
                if let Some(angle) = angle.get_mut(*n as usize) {
                    let side = |other: u32| net.p[other as usize] - net.p[*n as usize];
                    *angle += math::angle_between(side(c[(k + 1) % c.len()]), side(c[(k + c.len() - 1) % c.len()]));
                }
            }
        }
        let mut wanted = vec![4; net.p.len()];
        angle.iter().zip(&mut wanted).for_each(|(angle, wanted)| *wanted = (angle / RIGHT).round().max(1.0) as u32);
        Self { net, valence, wanted, polygon: Vec::new() }
    }

    /// Swaps until nothing gets better.
    pub fn swap(&mut self) {
        for _ in 0..SWAPS.max_rounds {
            let (mut swapped, mut f) = (false, 0);
            // A merge takes a face out.
            while f < self.net.face.len() {
                if !self.is_regular(f) {
                    swapped |= (0..self.net.corners(f).len()).any(|k| self.swap_at(f, k));
                }
                f += 1;
            }
            if !swapped {
                return;
            }
        }
    }

    /// A quad whose nodes have as many faces as they should.
    fn is_regular(&self, f: usize) -> bool {
        self.net.face[f][3] != NONE && self.net.face[f].iter().all(|n| self.valence[*n as usize] == self.wanted[*n as usize])
    }

    /// The polygon of a face and the one across its side `k`, from the node where that side ends.
    fn fill(&mut self, f: usize, k: usize) -> Option<usize> {
        let across = self.net.across[f][k];
        if across == NONE || self.net.locked[f] >> k & 1 == 1 {
            return None;
        }
        let (g, j) = (across as usize / 4, across as usize % 4);
        self.polygon.clear();
        for (face, skip) in [(f, k), (g, j)] {
            let c = self.net.corners(face);
            for i in 1..c.len() {
                let side = (skip + i) % c.len();
                let beyond = self.net.across[face][side];
                if beyond != NONE && [f, g].contains(&(beyond as usize / 4)) {
                    return None;
                }
                let locked = self.net.locked[face] >> side & 1 == 1;
                self.polygon.push((c[side], beyond, locked, self.net.mid[face][side]));
            }
        }
        let n = self.polygon.len();
        let twice = (0..n).any(|a| (0..a).any(|b| self.polygon[a].0 == self.polygon[b].0));
        (g != f && !twice).then_some(g)
    }

    /// What a node with so many faces more costs.
    fn odd(&self, node: u32, more: i64) -> f64 {
        let off = (i64::from(self.valence[node as usize]) + more - i64::from(self.wanted[node as usize])) as f64;
        off * off
    }

    /// Cost of a face of the polygon; infinite where it may not be.
    fn shape(&self, places: &[usize]) -> f64 {
        let node = |i: usize| self.polygon[places[i]].0 as usize;
        let (p, n) = (|i: usize| self.net.p[node(i)], |i: usize| self.net.normal[node(i)]);
        let quality = if places.len() == 3 {
            least_sine_of_triangle([p(0), p(1), p(2)], [n(0), n(1), n(2)])
        } else {
            least_sine([p(0), p(1), p(2), p(3)], [n(0), n(1), n(2), n(3)])
        };
        if quality < SWAPS.min_quality { f64::INFINITY } else { SWAPS.shape_cost * (1.0 - quality) * (1.0 - quality) }
    }

    fn swap_at(&mut self, f: usize, k: usize) -> bool {
        let Some(g) = self.fill(f, k) else { return false };
        let n = self.polygon.len();
        let first = self.net.corners(f).len() - 1;
        // The two faces with a diagonal between two places of the polygon.
        let parts = |a: usize, b: usize| -> [Vec<usize>; 2] { [(a..=b).collect(), (b..n).chain(0..=a).collect()] };
        // Now: the side runs between the places 0 and `first`.
        let ends = |a: usize, b: usize| {
            let more = |node: usize| i64::from(node == a || node == b) - i64::from(node == 0 || node == first);
            (0..n).map(|i| self.odd(self.polygon[i].0, more(i))).sum::<f64>()
        };
        let cost = |a: usize, b: usize| {
            let [x, y] = parts(a, b);
            ends(a, b) + self.shape(&x) + self.shape(&y)
        };
        let now = cost(0, first);
        let now = if now.is_finite() { now } else { ends(0, first) + 2.0 * SWAPS.shape_cost };
        if n == 4 {
            return self.merge(f, g, now);
        }
        let mut best = (now - SWAPS.min_gain, None);
        for a in 0..n {
            for b in a + 2..n {
                let smaller = (b - a).min(n - b + a);
                // A triangle and a quad, or two quads.
                if smaller != n - 3 || (a, b) == (0, first) {
                    continue;
                }
                let cost = cost(a, b);
                if cost < best.0 {
                    best = (cost, Some((a, b)));
                }
            }
        }
        let Some((a, b)) = best.1 else { return false };
        for (i, more) in [(0, -1_i64), (first, -1), (a, 1), (b, 1)] {
            let valence = &mut self.valence[self.polygon[i].0 as usize];
            *valence = (i64::from(*valence) + more) as u32;
        }
        let [x, y] = parts(a, b);
        self.put(f, &x);
        self.put(g, &y);
        let (last_x, last_y) = (x.len() - 1, y.len() - 1);
        self.net.across[f][last_x] = (4 * g + last_y) as u32;
        self.net.across[g][last_y] = (4 * f + last_x) as u32;
        true
    }

    /// Two triangles as one quad, where that is better; whether it is.
    fn merge(&mut self, f: usize, g: usize, now: f64) -> bool {
        let whole: Vec<usize> = (0..4).collect();
        let ends = |i: usize| if i == 0 || i == 2 { -1 } else { 0 };
        let merged = self.shape(&whole) + (0..4).map(|i| self.odd(self.polygon[i].0, ends(i))).sum::<f64>();
        if merged >= now + 2.0 * SWAPS.triangle_cost {
            return false;
        }
        for i in [0, 2] {
            self.valence[self.polygon[i].0 as usize] -= 1;
        }
        self.put(f, &whole);
        let (node, beyond, locked, mid) = self.polygon[3];
        (self.net.across[f][3], self.net.mid[f][3]) = (beyond, mid);
        self.net.face[f][3] = node;
        self.net.locked[f] |= u8::from(locked) << 3;
        if beyond != NONE {
            self.net.across[beyond as usize / 4][beyond as usize % 4] = (4 * f + 3) as u32;
        }
        self.net.remove(g);
        true
    }

    /// A face of places of the polygon; its last side is the diagonal.
    fn put(&mut self, f: usize, places: &[usize]) {
        let net = &mut *self.net;
        (net.face[f], net.across[f], net.mid[f], net.locked[f]) = ([NONE; 4], [NONE; 4], [NONE; 4], 0);
        for (k, place) in places.iter().enumerate() {
            let (node, beyond, locked, mid) = self.polygon[*place];
            net.face[f][k] = node;
            if k + 1 < places.len() {
                (net.across[f][k], net.mid[f][k]) = (beyond, mid);
                net.locked[f] |= u8::from(locked) << k;
                if beyond != NONE {
                    net.across[beyond as usize / 4][beyond as usize % 4] = (4 * f + k) as u32;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::triangulate_points::NO_TRIANGLE;
    use crate::mesh::quad::net_check::check_pairs;
    use crate::mesh::quad::net_check::tests::{Random, net_of, random_pairs, sheet};
    use crate::mesh::quad::pair::{SingleTriangles, pair};

    /// What no swap may change: the nodes, the locked sides with their middles, and the area in the chart.
    fn kept(net: &Net) -> (Vec<(u32, u32, u32)>, f64) {
        let (mut border, mut area) = (Vec::new(), 0.0);
        for f in 0..net.face.len() {
            let c = net.corners(f);
            let sides = (0..c.len()).filter(|k| net.locked[f] >> k & 1 == 1);
            border.extend(sides.map(|k| (c[k], c[(k + 1) % c.len()], net.mid[f][k])));
            area += (0..c.len()).map(|k| net.xy[c[k] as usize].perp_dot(net.xy[c[(k + 1) % c.len()] as usize])).sum::<f64>();
        }
        border.sort_unstable();
        (border, area)
    }

    fn holds(net: &Net, before: &(Vec<(u32, u32, u32)>, f64)) {
        net.check().and(net.check_upright()).unwrap();
        let now = kept(net);
        assert!(now.0 == before.0 && (now.1 - before.1).abs() <= 1e-9 * before.1, "{} and {}", now.1, before.1);
    }

    /// Random pairs, then sides swapped one by one in a random order: the net is sound after each.
    #[test]
    fn random_pairs_and_swaps_leave_a_sound_net() {
        let (mut pairs, mut swaps, mut merges) = (0, 0, 0);
        for case in 0..12 {
            let mut random = Random(17 + case);
            let (triangulation, normal, halves) = sheet(9, [0.0, 0.05, 0.15][case as usize % 3], &mut random);
            triangulation.check().unwrap();
            let mate = random_pairs(&triangulation, 40 * (1 + case as usize % 4), &mut random);
            check_pairs(&triangulation, &vec![false; mate.len()], &mate).unwrap();
            pairs += mate.iter().filter(|m| **m != NO_TRIANGLE).count() / 2;
            let mut net = net_of(&triangulation, &mate, &normal, &halves);
            let before = kept(&net);
            holds(&net, &before);
            for _ in 0..600 {
                let f = random.below(net.face.len());
                let (k, cells) = (random.below(net.corners(f).len()), net.face.len());
                let mut swapper = Swapper::new(&mut net);
                let valence: u32 = swapper.valence.iter().sum();
                if swapper.swap_at(f, k) {
                    // Where a merge takes two corners away, it says so of their nodes.
                    let left: u32 = swapper.valence.iter().sum();
                    let merged = cells - net.face.len();
                    assert_eq!(left + 2 * merged as u32, valence);
                    (swaps, merges) = (swaps + 1, merges + merged);
                    holds(&net, &before);
                }
            }
        }
        assert!(pairs > 400 && swaps > 600 && merges > 200, "{pairs} pairs, {swaps} swaps, {merges} merges");
    }

    /// The pairs that are chosen are sound, and so is what is left when nothing gets better by a swap.
    #[test]
    fn chosen_pairs_and_all_swaps_leave_a_sound_net() {
        for case in 0..20 {
            let mut random = Random(170 + case);
            let (triangulation, normal, halves) = sheet(9, [0.0, 0.05, 0.15][case as usize % 3], &mut random);
            let mut flat = vec![false; triangulation.tri.len()];
            // What is left out stays alone.
            flat.iter_mut().step_by(23).for_each(|flat| *flat = case % 2 == 1);
            let mate = pair(&triangulation, &normal, &flat, SingleTriangles { min_pair_quality: 0.2, equal_pair_quality: 0.45 });
            check_pairs(&triangulation, &flat, &mate).unwrap();
            let mut net = net_of(&triangulation, &mate, &normal, &halves);
            let before = kept(&net);
            holds(&net, &before);
            Swapper::new(&mut net).swap();
            holds(&net, &before);
        }
    }
}
