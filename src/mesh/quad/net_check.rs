//! What must hold of a net while sides are swapped, and of the pairs that it is made of.

use std::collections::BTreeSet;

use crate::base::job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::chart::halves::NONE;
use crate::mesh::chart::outline::area2;
use crate::mesh::quad::net::Net;
use crate::mesh::tri::triangulation::Triangulation;

/// What is wrong, in a sentence.
type Checked = Result<(), String>;

impl Net {
    /// No two cells run along one side the same way, neighbours know each other and agree about their side, and what has no neighbour is
    /// locked. Of nets whose neighbours are noted.
    ///
    /// The two ends of a side may be other nodes for its neighbour: the same points at another place of the chart, where cells between
    /// them were lines in space.
    pub fn check(&self) -> Checked {
        self.check_lengths()?;
        let mut sides = BTreeSet::new();
        for f in job::looking(0..self.face.len()) {
            self.check_corners(f)?;
            let c = self.corners(f);
            for k in 0..c.len() {
                if !sides.insert((c[k], c[(k + 1) % c.len()])) {
                    return Err(format!("two cells run along the side from node {} the same way", c[k]));
                }
            }
        }
        (0..self.face.len()).try_for_each(|f| (0..4).try_for_each(|k| self.check_side(f, k)))
    }

    /// Cells turn the right way in the chart. So they do when they are made of triangles, and after each swap in a chart that is nearly
    /// even; nodes that were smoothed since, in space, may turn one over in a chart that is not.
    pub fn check_upright(&self) -> Checked {
        for f in job::looking(0..self.face.len()) {
            let c = self.corners(f);
            let at = |k: usize| self.xy[c[k] as usize];
            let area: f64 = (2..c.len()).map(|k| area2(at(0), at(k - 1), at(k))).sum();
            // A place that is no number has no area either.
            if area.is_nan() || area <= 0.0 {
                return Err(format!("cell {f} is turned over"));
            }
        }
        Ok(())
    }

    fn check_lengths(&self) -> Checked {
        let (cells, nodes) = (self.face.len(), self.p.len());
        let of_cells = [self.across.len(), self.locked.len(), self.mid.len()];
        let of_nodes = [self.xy.len(), self.normal.len(), self.size.len()];
        let fits = of_cells == [cells; 3] && of_nodes == [nodes; 3] && self.fixed as usize <= nodes;
        if fits { Ok(()) } else { Err("lists of cells or nodes differ in length".to_owned()) }
    }

    fn check_corners(&self, f: usize) -> Checked {
        let c = self.corners(f);
        if let Some(n) = c.iter().find(|n| **n as usize >= self.p.len()) {
            return Err(format!("cell {f} has the node {n}, which is not there"));
        }
        if (1..c.len()).any(|k| c[..k].contains(&c[k])) {
            return Err(format!("cell {f} has a node twice"));
        }
        Ok(())
    }

    fn check_side(&self, f: usize, k: usize) -> Checked {
        let (n, across, mid) = (self.corners(f).len(), self.across[f][k], self.mid[f][k]);
        let locked = self.locked[f] >> k & 1 == 1;
        if k >= n {
            let empty = across == NONE && mid == NONE && !locked;
            return if empty { Ok(()) } else { Err(format!("cell {f} has something at a fourth side")) };
        }
        if mid != NONE && (mid >= self.fixed || !locked) {
            return Err(format!("cell {f} has a middle on a side that is no border"));
        }
        if across == NONE {
            return if locked { Ok(()) } else { Err(format!("cell {f} has a side that is open and not locked")) };
        }
        let (g, j) = (across as usize / 4, across as usize % 4);
        if g >= self.face.len() || j >= self.corners(g).len() {
            return Err(format!("cell {f} lies against cell {g}, which is not there"));
        }
        let (c, d) = (self.corners(f), self.corners(g));
        let same = |a: u32, b: u32| a == b || self.p[a as usize] == self.p[b as usize];
        let together = same(c[k], d[(j + 1) % d.len()]) && same(c[(k + 1) % n], d[j]);
        if self.across[g][j] as usize != 4 * f + k || !together {
            return Err(format!("cells {f} and {g} do not know each other"));
        }
        let agree = locked == (self.locked[g] >> j & 1 == 1) && mid == self.mid[g][j];
        if agree { Ok(()) } else { Err(format!("cells {f} and {g} differ about their side")) }
    }
}

/// Each triangle is alone or with one neighbour across a side that may go, which is with it.
pub fn check_pairs(triangulation: &Triangulation, flat: &[bool], mate: &[u32]) -> Checked {
    if mate.len() != triangulation.tri.len() {
        return Err("lists of triangles differ in length".to_owned());
    }
    for (t, other) in mate.iter().enumerate().filter(|m| *m.1 != NO_TRIANGLE) {
        job::poll();
        if mate.get(*other as usize) != Some(&(t as u32)) {
            return Err(format!("triangle {t} is with triangle {other}, which is not with it"));
        }
        let Some(k) = triangulation.across[t].iter().position(|o| o == other) else {
            return Err(format!("triangles {t} and {other} are together and no neighbours"));
        };
        if triangulation.locked[t] >> k & 1 == 1 {
            return Err(format!("triangles {t} and {other} are together across a side that stays"));
        }
        if flat[t] {
            return Err(format!("triangle {t} is a line in space and not alone"));
        }
    }
    Ok(())
}

#[cfg(test)]
pub(crate) mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::base::triangulate_points::points;
    use crate::mesh::chart::halves::Halves;
    use crate::mesh::chart::outline::Outline;
    use crate::mesh::quad::net::Raw;

    /// A generator of numbers (xorshift*).
    pub(crate) struct Random(pub u64);

    impl Random {
        /// A whole number below `n`.
        pub(crate) fn below(&mut self, n: usize) -> usize {
            self.0 ^= self.0 >> 12;
            self.0 ^= self.0 << 25;
            self.0 ^= self.0 >> 27;
            ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) % n.max(1) as u64) as usize
        }
    }

    /// A sheet of `n` × `n` nodes, z = bend · x y, moved aside at random, with a line of border nodes inside: its triangles and border.
    pub(crate) fn sheet(n: usize, bend: f64, random: &mut Random) -> (Triangulation, Vec<DVec3>, Halves) {
        let is_border = |k: &usize| [0, n - 1].contains(&(k % n)) || [0, n - 1].contains(&(k / n));
        let is_line = |k: &usize| k / n == n / 2 && (2..n - 2).contains(&(k % n));
        let (fixed, inner): (Vec<usize>, Vec<usize>) = (0..n * n).partition(|k| is_border(k) || is_line(k));
        let mut aside = |k: usize| if is_border(&k) { 0.0 } else { (random.below(100) as f64 - 50.0) / 150.0 };
        let xy: Vec<DVec2> =
            fixed.iter().chain(&inner).map(|k| DVec2::new((k % n) as f64 + aside(*k), (k / n) as f64 + aside(*k))).collect();
        let p: Vec<DVec3> = xy.iter().map(|q| q.extend(bend * q.x * q.y)).collect();
        let normal = xy.iter().map(|q| DVec3::new(-bend * q.y, -bend * q.x, 1.0).normalize()).collect();
        let place = |k: usize| fixed.iter().position(|f| *f == k).unwrap() as u32;
        let line: Vec<[u32; 2]> = (2..n - 3).map(|i| [place(n * (n / 2) + i), place(n * (n / 2) + i + 1)]).collect();
        let all = points(&xy, &line).unwrap();
        let outline = Outline { xy: xy[..fixed.len()].to_vec(), p: p[..fixed.len()].to_vec(), loops: Vec::new(), lines: line };
        let ids: Vec<u32> = (0..fixed.len() as u32).collect();
        let halves = Halves::whole(&outline, &ids);
        let size = vec![1.0; xy.len()];
        (Triangulation::new(p, xy, size, fixed.len() as u32, &all, &vec![true; all.corners.len()]), normal, halves)
    }

    /// Neighbours put together at random, as many as there are tries.
    pub(crate) fn random_pairs(triangulation: &Triangulation, tries: usize, random: &mut Random) -> Vec<u32> {
        let mut mate = vec![NO_TRIANGLE; triangulation.tri.len()];
        for _ in 0..tries {
            let (t, k) = (random.below(mate.len()), random.below(3));
            let other = triangulation.across[t][k];
            let may = other != NO_TRIANGLE && triangulation.locked[t] >> k & 1 == 0;
            if may && mate[t] == NO_TRIANGLE && mate[other as usize] == NO_TRIANGLE {
                (mate[t], mate[other as usize]) = (other, t as u32);
            }
        }
        mate
    }

    /// A net of some pairs of a sheet.
    pub(crate) fn net_of(triangulation: &Triangulation, mate: &[u32], normal: &[DVec3], halves: &Halves) -> Net {
        let flat = vec![false; triangulation.tri.len()];
        Raw { triangulation, mate, flat: &flat, normal, halves }.net()
    }

    fn sample() -> Net {
        let mut random = Random(3);
        let (triangulation, normal, halves) = sheet(7, 0.1, &mut random);
        let mate = random_pairs(&triangulation, 60, &mut random);
        net_of(&triangulation, &mate, &normal, &halves)
    }

    #[track_caller]
    fn is_told(what: &str, damage: impl FnOnce(&mut Net)) {
        let mut net = sample();
        assert_eq!(net.check().and(net.check_upright()), Ok(()));
        damage(&mut net);
        let told = net.check().and_then(|()| net.check_upright()).unwrap_err();
        assert!(told.contains(what), "{told}");
    }

    /// A side with a neighbour: its cell and place.
    fn shared(net: &Net) -> (usize, usize) {
        (0..net.face.len()).flat_map(|f| (0..4).map(move |k| (f, k))).find(|(f, k)| net.across[*f][*k] != NONE).unwrap()
    }

    fn open(net: &Net) -> (usize, usize) {
        let sides = (0..net.face.len()).flat_map(|f| (0..net.corners(f).len()).map(move |k| (f, k)));
        sides.into_iter().find(|(f, k)| net.across[*f][*k] == NONE).unwrap()
    }

    #[test]
    fn each_condition_on_cells_is_seen_to_fail() {
        is_told("differ in length", |net| _ = net.across.pop());
        is_told("differ in length", |net| _ = net.locked.pop());
        is_told("differ in length", |net| _ = net.mid.pop());
        is_told("differ in length", |net| _ = net.normal.pop());
        is_told("has the node 999", |net| net.face[0][0] = 999);
        is_told("has a node twice", |net| net.face[0][1] = net.face[0][0]);
        is_told("is turned over", |net| net.xy[net.face[0][0] as usize] = DVec2::splat(60.0));
        is_told("is turned over", |net| net.xy[net.face[0][0] as usize].y = f64::NAN);
        is_told("the same way", |net| {
            net.face.push(net.face[0]);
            net.across.push(net.across[0]);
            net.locked.push(net.locked[0]);
            net.mid.push(net.mid[0]);
        });
        let triangle = |net: &Net| net.face.iter().position(|c| c[3] == NONE).unwrap();
        is_told("something at a fourth side", |net| net.across[triangle(&sample())][3] = 0);
        is_told("something at a fourth side", |net| net.locked[triangle(&sample())] |= 8);
    }

    #[test]
    fn each_condition_on_sides_is_seen_to_fail() {
        let ((f, k), (g, j)) = (shared(&sample()), open(&sample()));
        is_told("that is no border", |net| net.mid[f][k] = 0);
        is_told("that is no border", |net| net.mid[g][j] = net.fixed);
        is_told("open and not locked", |net| net.locked[g] &= !(1 << j));
        is_told("which is not there", |net| net.across[f][k] = 4 * 9999);
        is_told("do not know each other", |net| {
            let other = net.across[f][k] as usize / 4;
            net.across[f][k] = 4 * (0..net.face.len()).find(|h| *h != f && *h != other).unwrap() as u32;
        });
        is_told("do not know each other", |net| {
            let other = net.across[f][k] as usize;
            net.across[other / 4][other % 4] = NONE;
            net.locked[other / 4] |= 1 << (other % 4);
            net.locked[f] |= 1 << k;
        });
        is_told("differ about their side", |net| net.locked[f] ^= 1 << k);
    }

    #[test]
    fn each_condition_on_pairs_is_seen_to_fail() {
        let mut random = Random(5);
        let (mut triangulation, ..) = sheet(7, 0.0, &mut random);
        let mut flat = vec![false; triangulation.tri.len()];
        let mate = random_pairs(&triangulation, 200, &mut random);
        assert_eq!(check_pairs(&triangulation, &flat, &mate), Ok(()));
        let told = |mate: &[u32], triangulation: &Triangulation, flat: &[bool]| check_pairs(triangulation, flat, mate).unwrap_err();
        assert!(told(&mate[1..], &triangulation, &flat).contains("differ in length"));
        let t = mate.iter().position(|m| *m != NO_TRIANGLE).unwrap();
        let other = mate[t] as usize;
        let mut one = mate.clone();
        one[other] = NO_TRIANGLE;
        assert!(told(&one, &triangulation, &flat).contains("which is not with it"));
        let far = (0..mate.len()).find(|f| *f != t && !triangulation.across[t].contains(&(*f as u32))).unwrap();
        let mut apart = vec![NO_TRIANGLE; mate.len()];
        (apart[t], apart[far]) = (far as u32, t as u32);
        assert!(told(&apart, &triangulation, &flat).contains("no neighbours"));
        flat[t] = true;
        assert!(told(&mate, &triangulation, &flat).contains("a line in space"));
        triangulation.locked[t] = 7;
        assert!(told(&mate, &triangulation, &flat).contains("a side that stays"));
    }
}
