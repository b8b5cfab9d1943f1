//! Patterns of quads for a polygon with so many steps a side: rows and columns where opposite sides are alike, and three or five blocks about
//! one irregular node.

use glam::DVec2;

/// Quads inside a polygon of nodes.
pub(super) struct Pattern {
    /// Corners: numbers below that of the nodes of the polygon are theirs, from its first corner on, the others are new.
    pub faces: Vec<[u32; 4]>,
    /// Places of the new nodes.
    pub xy: Vec<DVec2>,
}

/// How many irregular nodes a pattern has for so many steps a side; `None` where there is none.
pub(super) fn irregular(steps: &[usize]) -> Option<usize> {
    match steps {
        [a, b, c, d] => (a == c && b == d).then_some(0),
        [_, _, _] | [_, _, _, _, _] => blocks(steps).map(|_| 1),
        _ => None,
    }
}

/// Steps from each corner to where the side is parted.
fn blocks(steps: &[usize]) -> Option<Vec<usize>> {
    let n = steps.len();
    // Side k has x[k] steps to its parting and x[k + 2] from there on, so that opposite sides of all blocks have as many.
    let double = |k: usize| (0..n).map(|i| steps[(k + 2 * i) % n] as i64 * if i % 2 == 0 { 1 } else { -1 }).sum::<i64>();
    let x: Vec<i64> = (0..n).map(double).collect();
    x.iter().all(|x| *x > 0 && x % 2 == 0).then(|| x.iter().map(|x| *x as usize / 2).collect())
}

/// The pattern of a polygon whose sides are places from corner to corner, both included.
pub(super) fn pattern(sides: &[Vec<DVec2>]) -> Option<Pattern> {
    let steps: Vec<usize> = sides.iter().map(|s| s.len() - 1).collect();
    irregular(&steps)?;
    let ring: Vec<DVec2> = sides.iter().flat_map(|s| s[..s.len() - 1].iter().copied()).collect();
    let n = ring.len() as u32;
    let mut start: Vec<u32> = vec![0];
    steps.iter().for_each(|s| start.push(start[start.len() - 1] + *s as u32));
    let along = |k: usize, from: usize, to: usize| -> Vec<u32> { (from..=to).map(|i| (start[k] + i as u32) % n).collect() };
    let mut made = Made { pattern: Pattern { faces: Vec::new(), xy: Vec::new() }, ring };
    if let [a, b, ..] = steps[..]
        && steps.len() == 4
    {
        let back = |mut row: Vec<u32>| {
            row.reverse();
            row
        };
        made.grid(&along(0, 0, a), &along(1, 0, b), &back(along(2, 0, a)), &back(along(3, 0, b)));
        return Some(made.pattern);
    }
    let x = blocks(&steps)?;
    let sides = steps.len();
    let middle = made.add(made.ring.iter().copied().sum::<DVec2>() / f64::from(n));
    // Side k is parted after as many steps as the block at its first corner has on the other side of it.
    let parting: Vec<u32> = (0..sides).map(|k| start[k] + x[k] as u32).collect();
    let spokes: Vec<Vec<u32>> = (0..sides).map(|k| made.line(parting[k] % n, middle, x[(k + 1) % sides])).collect();
    for k in 0..sides {
        let next = (k + 1) % sides;
        // The block at the corner between side k and the next one.
        let right = along(k, x[k], steps[k]);
        let up = along(next, 0, x[next]);
        let mut top = spokes[next].clone();
        top.reverse();
        made.grid(&right, &up, &top, &spokes[k]);
    }
    Some(made.pattern)
}

struct Made {
    pattern: Pattern,
    ring: Vec<DVec2>,
}

impl Made {
    fn place(&self, n: u32) -> DVec2 {
        let n = n as usize;
        if n < self.ring.len() { self.ring[n] } else { self.pattern.xy[n - self.ring.len()] }
    }

    fn add(&mut self, xy: DVec2) -> u32 {
        self.pattern.xy.push(xy);
        (self.ring.len() + self.pattern.xy.len()) as u32 - 1
    }

    /// New nodes on a line between two, both included.
    fn line(&mut self, a: u32, b: u32, steps: usize) -> Vec<u32> {
        let (from, to) = (self.place(a), self.place(b));
        let mut line = vec![a];
        line.extend((1..steps).map(|k| self.add(from.lerp(to, k as f64 / steps as f64))));
        line.push(b);
        line
    }

    /// Rows and columns between four sides: bottom and top to the right, right and left upwards.
    fn grid(&mut self, bottom: &[u32], right: &[u32], top: &[u32], left: &[u32]) {
        let (w, h) = (bottom.len() - 1, left.len() - 1);
        let mut rows: Vec<Vec<u32>> = vec![bottom.to_vec()];
        for j in 1..h {
            let t = j as f64 / h as f64;
            let mut row = vec![left[j]];
            for i in 1..w {
                let s = i as f64 / w as f64;
                let across = self.place(left[j]).lerp(self.place(right[j]), s);
                let upwards = self.place(bottom[i]).lerp(self.place(top[i]), t);
                let low = self.place(bottom[0]).lerp(self.place(bottom[w]), s);
                let high = self.place(top[0]).lerp(self.place(top[w]), s);
                row.push(self.add(across + upwards - low.lerp(high, t)));
            }
            row.push(right[j]);
            rows.push(row);
        }
        rows.push(top.to_vec());
        for j in 0..h {
            for i in 0..w {
                self.pattern.faces.push([rows[j][i], rows[j][i + 1], rows[j + 1][i + 1], rows[j + 1][i]]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;

    /// A regular polygon with so many steps a side.
    fn polygon(steps: &[usize]) -> Vec<Vec<DVec2>> {
        let corner = |k: usize| DVec2::from_angle(std::f64::consts::TAU * (k % steps.len()) as f64 / steps.len() as f64);
        let side = |(k, n): (usize, &usize)| (0..=*n).map(|i| corner(k).lerp(corner(k + 1), i as f64 / *n as f64)).collect();
        steps.iter().enumerate().map(side).collect()
    }

    #[test]
    fn patterns_fill_their_polygon_with_one_irregular_node_at_most() {
        for steps in [&[3, 2, 3, 2][..], &[1, 4, 1, 4], &[2, 2, 2], &[3, 4, 5], &[2, 2, 2, 2, 2], &[3, 4, 4, 3, 4]] {
            let sides = polygon(steps);
            let made = pattern(&sides).unwrap();
            let n: usize = steps.iter().sum();
            let ring: Vec<DVec2> = sides.iter().flat_map(|s| s[..s.len() - 1].to_vec()).collect();
            let place = |k: u32| ring.iter().chain(&made.xy).nth(k as usize).copied().unwrap();
            let (mut edges, mut at) = (BTreeSet::new(), BTreeMap::new());
            let mut area = 0.0;
            for f in &made.faces {
                for k in 0..4 {
                    let (a, b) = (f[k], f[(k + 1) % 4]);
                    assert!(edges.insert((a, b)), "{steps:?}");
                    *at.entry(a).or_insert(0) += 1;
                    area += 0.5 * place(a).perp_dot(place(b));
                }
            }
            let open: Vec<_> = edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a))).collect();
            assert_eq!(open.len(), n, "{steps:?}");
            assert!(open.iter().all(|(a, b)| (a + 1) % n as u32 == *b), "{steps:?}");
            let whole: f64 = (0..n).map(|k| 0.5 * ring[k].perp_dot(ring[(k + 1) % n])).sum();
            assert!((area - whole).abs() < 1e-9, "{steps:?}: {area} and {whole}");
            let odd = at.iter().filter(|(k, count)| **k >= n as u32 && **count != 4).count();
            assert_eq!(Some(odd), irregular(steps), "{steps:?}");
        }
        assert!(irregular(&[3, 2, 4, 2]).is_none() && irregular(&[1, 1, 4]).is_none() && irregular(&[2, 2, 3]).is_none());
    }
}
