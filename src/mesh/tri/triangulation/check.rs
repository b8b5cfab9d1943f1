//! What must hold of a triangulation before and after every change.

use crate::base::job;
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::tri::triangulation::{Ring, Triangulation};

/// What is wrong, in a sentence.
type Checked = Result<(), String>;

impl Triangulation {
    /// Corners turn the right way, neighbours know each other and agree about their side, what has no neighbour is locked, every node
    /// knows a triangle of its own, those at an inner node go once round it, and the lists of free places hold what is not used.
    pub fn check(&self) -> Checked {
        self.check_lengths()?;
        let live: Vec<u32> = (0..self.tri.len() as u32).filter(|t| self.alive(*t)).collect();
        for t in job::looking(&live) {
            self.check_corners(*t)?;
        }
        for t in job::looking(&live) {
            (0..3).try_for_each(|k| self.check_side(*t, k))?;
        }
        self.check_nodes(&live)?;
        self.check_free()
    }

    fn check_lengths(&self) -> Checked {
        let (triangles, nodes) = (self.tri.len(), self.p.len());
        let of_triangles = [self.across.len(), self.locked.len(), self.stamp.len()];
        let of_nodes = [self.xy.len(), self.size.len(), self.at.len()];
        let fits = of_triangles == [triangles; 3] && of_nodes == [nodes; 3] && self.fixed as usize <= nodes;
        if fits { Ok(()) } else { Err("lists of triangles or nodes differ in length".to_owned()) }
    }

    fn check_corners(&self, t: u32) -> Checked {
        let c = self.tri[t as usize];
        if let Some(n) = c.into_iter().find(|n| *n as usize >= self.p.len()) {
            return Err(format!("triangle {t} has the node {n}, which is not there"));
        }
        if (0..3).any(|k| c[k] == c[(k + 1) % 3]) {
            return Err(format!("triangle {t} has a node twice"));
        }
        let is_there = |other: u32| other == NO_TRIANGLE || (other as usize) < self.tri.len() && self.alive(other);
        if let Some(other) = self.across[t as usize].into_iter().find(|other| !is_there(*other)) {
            return Err(format!("triangle {t} lies against triangle {other}, which is not there"));
        }
        // A place that is no number has no area either.
        if self.chart_area(t) > 0.0 { Ok(()) } else { Err(format!("triangle {t} is turned over")) }
    }

    fn check_side(&self, t: u32, k: usize) -> Checked {
        let (c, other) = (self.tri[t as usize], self.across[t as usize][k]);
        let is_locked = self.locked[t as usize] >> k & 1;
        if other == NO_TRIANGLE {
            return if is_locked == 1 { Ok(()) } else { Err(format!("triangle {t} has a side that is open and not locked")) };
        }
        let (j, d) = (self.side_to(other, t), self.tri[other as usize]);
        if self.across[other as usize][j] != t || d[(j + 1) % 3] != c[(k + 2) % 3] || d[(j + 2) % 3] != c[(k + 1) % 3] {
            return Err(format!("triangles {t} and {other} do not know each other"));
        }
        let agree = is_locked == self.locked[other as usize] >> j & 1;
        if agree { Ok(()) } else { Err(format!("triangles {t} and {other} differ about their side")) }
    }

    fn check_nodes(&self, live: &[u32]) -> Checked {
        let mut used = vec![0; self.p.len()];
        live.iter().flat_map(|t| self.tri[*t as usize]).for_each(|n| used[n as usize] += 1);
        let mut ring = Ring::default();
        for (n, used) in job::looking(used.into_iter().enumerate()) {
            let own = self.at[n];
            if used == 0 && own == NO_TRIANGLE {
                continue;
            }
            let knows = self.tri.get(own as usize).is_some_and(|c| self.alive(own) && c.contains(&(n as u32)));
            if !knows {
                return Err(format!("node {n} does not know its triangles"));
            }
            if self.is_free(n as u32) {
                self.ring(n as u32, &mut ring);
                if !ring.closed || ring.tri.len() != used {
                    return Err(format!("the triangles at the inner node {n} do not go once round it"));
                }
            }
        }
        Ok(())
    }

    fn check_free(&self) -> Checked {
        let mut free = vec![false; self.tri.len()];
        for t in &self.free_tri {
            match free.get_mut(*t as usize) {
                Some(free) if !*free && !self.alive(*t) => *free = true,
                _ => return Err(format!("triangle {t} is in the list of free ones by mistake")),
            }
        }
        if let Some(t) = (0..self.tri.len() as u32).find(|t| !self.alive(*t) && !free[*t as usize]) {
            return Err(format!("triangle {t} is dead and not in the list of free ones"));
        }
        let mut free = vec![false; self.p.len()];
        for n in &self.free_node {
            match free.get_mut(*n as usize) {
                Some(free) if !*free && self.is_free(*n) && self.at[*n as usize] == NO_TRIANGLE => *free = true,
                _ => return Err(format!("node {n} is in the list of free ones by mistake")),
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::base::triangulate_points::points;
    use crate::mesh::tri::triangulation::Patch;

    /// A square of 4 × 4 nodes, the border first; one inner node was taken out, so that there are free places.
    fn sample() -> Triangulation {
        let is_inner = |k: &usize| [5, 6, 9, 10].contains(k);
        let (inner, border): (Vec<usize>, Vec<usize>) = (0..16).partition(is_inner);
        let place = |k: &usize| DVec2::new((k % 4) as f64 + 0.1 * (k * k % 7) as f64, (k / 4) as f64 + 0.1 * (k * k % 5) as f64);
        let xy: Vec<DVec2> = border.iter().chain(&inner).map(place).collect();
        let all = points(&xy, &[]).unwrap();
        let p = xy.iter().map(|p| p.extend(0.0)).collect();
        let mut triangulation = Triangulation::new(p, xy, vec![1.0; 16], 12, &all, &vec![true; all.corners.len()]);
        let (mut ring, mut patch) = (Ring::default(), Patch::default());
        triangulation.ring(12, &mut ring);
        triangulation.patch(&ring.tri, &mut patch).unwrap();
        let left = |a: usize, b: usize, c: usize| {
            let [a, b, c] = [a, b, c].map(|k| triangulation.xy[patch.rim[k % patch.rim.len()] as usize]);
            crate::mesh::chart::outline::is_left(a, b, c)
        };
        let n = patch.rim.len();
        let k = (0..n).find(|k| (1..n - 1).all(|i| left(*k, k + i, k + i + 1))).unwrap();
        triangulation.refan(&patch, k);
        triangulation
    }

    /// A triangle with no side on the border.
    fn inside(triangulation: &Triangulation) -> usize {
        (0..triangulation.tri.len()).find(|t| triangulation.alive(*t as u32) && !triangulation.across[*t].contains(&NO_TRIANGLE)).unwrap()
    }

    #[track_caller]
    fn is_told(what: &str, damage: impl FnOnce(&mut Triangulation)) {
        let mut triangulation = sample();
        assert_eq!(triangulation.check(), Ok(()));
        damage(&mut triangulation);
        let told = triangulation.check().unwrap_err();
        assert!(told.contains(what), "{told}");
    }

    #[test]
    fn each_condition_on_lists_and_corners_is_seen_to_fail() {
        is_told("differ in length", |t| _ = t.across.pop());
        is_told("differ in length", |t| _ = t.locked.pop());
        is_told("differ in length", |t| _ = t.stamp.pop());
        is_told("differ in length", |t| _ = t.xy.pop());
        is_told("differ in length", |t| _ = t.size.pop());
        is_told("differ in length", |t| _ = t.at.pop());
        is_told("differ in length", |t| t.fixed = 99);
        is_told("has the node 99", |t| t.tri[inside(&sample())][2] = 99);
        is_told("has a node twice", |t| {
            let k = inside(t);
            t.tri[k][2] = t.tri[k][1];
        });
        is_told("is turned over", |t| t.xy[15] = DVec2::splat(9.0));
        is_told("is turned over", |t| t.xy[15].x = f64::NAN);
    }

    #[test]
    fn each_condition_on_sides_is_seen_to_fail() {
        is_told("is open and not locked", |t| {
            let at = t.across.iter().position(|a| a[0] == NO_TRIANGLE && a != &[NO_TRIANGLE; 3]).unwrap();
            t.locked[at] &= !1;
        });
        is_told("which is not there", |t| t.across[inside(&sample())][0] = 99);
        is_told("which is not there", |t| {
            let dead = (0..t.tri.len() as u32).find(|k| !t.alive(*k)).unwrap();
            t.across[inside(&sample())][0] = dead;
        });
        is_told("do not know each other", |t| {
            let k = inside(t);
            t.across[k].swap(0, 1);
        });
        is_told("do not know each other", |t| {
            // A neighbour that lies elsewhere.
            let k = inside(t);
            let other = (0..t.tri.len() as u32).find(|o| t.alive(*o) && *o as usize != k && !t.across[k].contains(o)).unwrap();
            t.across[k][0] = other;
        });
        is_told("differ about their side", |t| t.locked[inside(&sample())] ^= 1);
    }

    #[test]
    fn each_condition_on_nodes_is_seen_to_fail() {
        is_told("node 13 does not know", |t| t.at[13] = NO_TRIANGLE);
        is_told("node 13 does not know", |t| {
            t.at[13] = (0..t.tri.len() as u32).find(|k| t.alive(*k) && !t.tri[*k as usize].contains(&13)).unwrap();
        });
        // A node that was taken out and still has a triangle.
        is_told("node 12 does not know", |t| t.at[12] = 0);
        is_told("do not go once round", |t| t.fixed = 0);
        // Two fans that meet in one inner node.
        let xy: Vec<DVec2> = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (0.0, 0.0)].map(DVec2::from).to_vec();
        let fans = Triangulation {
            p: xy.iter().map(|p| p.extend(0.0)).collect(),
            size: vec![1.0; 5],
            fixed: 4,
            tri: vec![[4, 0, 1], [4, 2, 3]],
            across: vec![[NO_TRIANGLE; 3]; 2],
            locked: vec![7; 2],
            at: vec![0, 0, 1, 1, 0],
            stamp: vec![0; 2],
            xy,
            ..Triangulation::default()
        };
        assert!(fans.check().unwrap_err().contains("do not go once round"));
    }

    #[test]
    fn each_condition_on_free_places_is_seen_to_fail() {
        is_told("free ones by mistake", |t| t.free_tri.push(inside(&sample()) as u32));
        is_told("free ones by mistake", |t| t.free_tri.push(99));
        is_told("free ones by mistake", |t| t.free_tri.push(t.free_tri[0]));
        is_told("is dead and not in the list", |t| _ = t.free_tri.pop());
        is_told("node 13 is in the list", |t| t.free_node.push(13));
        is_told("node 0 is in the list", |t| t.free_node.push(0));
        is_told("node 12 is in the list", |t| t.free_node.push(12));
    }
}
