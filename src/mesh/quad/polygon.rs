//! The best quads of a small polygon in the plane, with no, one or two nodes inside.
//!
//! Without nodes inside, the quads over every chord follow from those over shorter ones [Klincsek 1980]. A node inside has a side to a
//! corner of the polygon: cut along it, the polygon has no node inside, and every way to cut is tried.

use glam::DVec2;

use crate::mesh::quad::plane::least_sine;
use crate::mesh::quad::settings::POLYGON;

/// Quads of a polygon.
#[derive(Clone, Debug)]
pub(super) struct Filling {
    /// Corners of quads: numbers below that of the polygon's corners are theirs, the others of nodes inside.
    pub faces: Vec<[u32; 4]>,
    /// Sum of the costs of the quads.
    pub cost: f64,
}

/// The chords of a polygon that is cut along sides to nodes inside.
struct Chords<'a> {
    /// Places by number.
    xy: &'a [DVec2],
    /// Numbers of its corners, one cut along twice.
    round: Vec<u32>,
    /// Least costs of the quads over each chord, and the other two corners of the quad at it.
    best: Vec<(f64, [u8; 2])>,
    /// Costs of quads by their corners, NaN where unknown; empty where each is needed hardly more than once.
    known: Vec<f64>,
}

/// What a quad of a quality costs; none may be below the least one.
fn cost(quality: f64) -> f64 {
    if quality < POLYGON.min_quality {
        return f64::INFINITY;
    }
    let off = (1.0 - quality) / quality;
    off * off
}

impl Chords<'_> {
    fn solve(&mut self, most: f64) -> f64 {
        let n = self.round.len();
        self.best.clear();
        self.best.resize(n * n, (f64::INFINITY, [0; 2]));
        for a in 0..n - 1 {
            self.best[a * n + a + 1].0 = 0.0;
        }
        for span in (3..n).step_by(2) {
            for a in 0..n - span {
                let b = a + span;
                let mut best = (most, [0; 2]);
                for k in (a + 1..b).step_by(2) {
                    let left = self.best[a * n + k].0;
                    if left >= best.0 {
                        continue;
                    }
                    for l in (k + 1..b).step_by(2) {
                        let parts = left + self.best[k * n + l].0 + self.best[l * n + b].0;
                        if parts >= best.0 {
                            continue;
                        }
                        let of = [a, k, l, b].map(|i| self.round[i]);
                        if of[0] == of[2] || of[1] == of[3] {
                            continue;
                        }
                        let whole = parts + self.cost(of.map(|n| n as usize));
                        if whole < best.0 {
                            best = (whole, [k as u8, l as u8]);
                        }
                    }
                }
                if best.0 < most {
                    self.best[a * n + b] = best;
                }
            }
        }
        self.best[n - 1].0
    }

    /// What a quad of some corners costs.
    fn cost(&mut self, of: [usize; 4]) -> f64 {
        let place = of.into_iter().fold(0, |place, n| place * self.xy.len() + n);
        match self.known.get(place) {
            Some(known) if !known.is_nan() => *known,
            known => {
                let is_kept = known.is_some();
                let found = cost(least_sine(of.map(|n| self.xy[n])));
                if is_kept {
                    self.known[place] = found;
                }
                found
            }
        }
    }

    fn faces(&self) -> Vec<[u32; 4]> {
        let n = self.round.len();
        let (mut faces, mut open) = (Vec::new(), vec![(0, n - 1)]);
        while let Some((a, b)) = open.pop() {
            if b == a + 1 {
                continue;
            }
            let [k, l] = self.best[a * n + b].1.map(usize::from);
            faces.push([a, k, l, b].map(|i| self.round[i]));
            open.extend([(a, k), (k, l), (l, b)]);
        }
        faces
    }
}

/// The best quads of a polygon with an even number of corners and so many nodes inside, whose places follow those of the corners; those that
/// cost less than `most`, one for each way to cut.
pub(super) fn fillings(xy: &[DVec2], corners: usize, most: f64, found: &mut Vec<Filling>) {
    let inner = xy.len() - corners;
    let known = vec![f64::NAN; if inner > 1 { xy.len().pow(4) } else { 0 }];
    let mut chords = Chords { xy, round: Vec::new(), best: Vec::new(), known };
    let mut take = |chords: &mut Chords| {
        let cost = chords.solve(most);
        if cost < most {
            found.push(Filling { faces: chords.faces(), cost });
        }
    };
    let whole = || (0..corners as u32).collect::<Vec<u32>>();
    let cut = |round: &[u32], at: usize, node: u32| {
        let mut round = round.to_vec();
        round.splice(at + 1..at + 1, [node, round[at]]);
        round
    };
    match inner {
        0 => {
            chords.round = whole();
            take(&mut chords);
        }
        // A node inside has three quads at least, with sides to corners of one colour: half of these need not be tried.
        1 => {
            for at in 0..corners {
                chords.round = cut(&whole(), at, corners as u32);
                take(&mut chords);
            }
        }
        _ => {
            for at in 0..corners {
                for other in 0..corners {
                    let first = cut(&whole(), at, corners as u32);
                    let place = if other > at { other + 2 } else { other };
                    chords.round = cut(&first, place, corners as u32 + 1);
                    take(&mut chords);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// The corners of a square of four cells, counter-clockwise.
    fn square() -> Vec<DVec2> {
        [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)].map(|(x, y)| DVec2::new(f64::from(x), f64::from(y))).to_vec()
    }

    fn best(xy: &[DVec2], corners: usize) -> Option<Filling> {
        let mut found = Vec::new();
        fillings(xy, corners, 1e3, &mut found);
        found.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    #[test]
    fn a_square_with_its_middle_is_four_squares() {
        let mut xy = square();
        // Three quads without a node inside would have a straight corner.
        assert!(best(&xy, 8).is_none());
        xy.push(DVec2::ONE);
        let found = best(&xy, 8).unwrap();
        assert!(found.cost < 1e-20 && found.faces.len() == 4 && found.faces.iter().all(|f| f.contains(&8)));
    }

    #[test]
    fn quads_cover_a_polygon_once() {
        for (corners, inner) in [(6, 0), (8, 0), (8, 1), (10, 1), (10, 2), (12, 2)] {
            let at = |k: usize| DVec2::from_angle(std::f64::consts::TAU * k as f64 / corners as f64);
            let mut xy: Vec<DVec2> = (0..corners).map(at).collect();
            xy.extend(
                [DVec2::new(0.35, 0.03), DVec2::new(-0.35, 0.02)].into_iter().take(inner).map(|p| if inner == 1 { p * 0.1 } else { p }),
            );
            let found = best(&xy, corners).unwrap();
            assert_eq!(2 * found.faces.len() + 2, corners + 2 * inner);
            let (mut sides, mut area) = (BTreeSet::new(), 0.0);
            for f in &found.faces {
                for k in 0..4 {
                    let (a, b) = (f[k], f[(k + 1) % 4]);
                    assert!(sides.insert((a, b)), "{corners} {inner}");
                    area += 0.5 * xy[a as usize].perp_dot(xy[b as usize]);
                }
            }
            let open: Vec<_> = sides.iter().filter(|(a, b)| !sides.contains(&(*b, *a))).collect();
            assert!(open.len() == corners && open.iter().all(|(a, b)| (a + 1) % corners as u32 == *b), "{corners} {inner}: {open:?}");
            let whole: f64 = (0..corners).map(|k| 0.5 * xy[k].perp_dot(xy[(k + 1) % corners])).sum();
            assert!((area - whole).abs() < 1e-12, "{corners} {inner}: {area} and {whole}");
        }
    }
}
