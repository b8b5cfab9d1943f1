//! Points of many borders that are one within what each of them allows.

use glam::DVec3;

use super::glue::{join, root};
use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::job;
use crate::base::math::compare_points;

/// A cluster wider than this many reaches of its points is a chain of near ones, not one place.
const WIDEST: f64 = 2.0;

/// A point with how near another one must be to be the same.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// The point.
    pub point: DVec3,
    /// Its reach, model units; of two points the smaller one counts.
    pub reach: f64,
}

/// The group of each point; groups are numbered by first appearance.
///
/// Closeness is passed on as long as the group stays within two reaches. A wider one is a row of short edges: there points
/// must be nearer, by halves, down to `least` (a reach for which the passing on has no end).
pub fn gather(points: &[Station], least: f64) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..points.len()).collect();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| compare_points(points[a].point, points[b].point).then(a.cmp(&b)));
    let mut open = vec![(order, 1.0)];
    while let Some((ids, share)) = open.pop() {
        job::poll();
        let groups = linked(points, &ids, share, least);
        for group in groups {
            let reach = group.iter().map(|n| points[*n].reach).fold(0.0, f64::max);
            let wide = Box3::of(group.iter().map(|n| points[*n].point)).diagonal() > WIDEST * reach;
            if wide && share * reach > least {
                open.push((group, 0.5 * share));
                continue;
            }
            for pair in group.windows(2) {
                join(&mut parent, pair[0], pair[1]);
            }
        }
    }
    let mut number = vec![usize::MAX; points.len()];
    let mut count = 0;
    for n in 0..points.len() {
        let r = root(&mut parent, n);
        if r == n {
            number[n] = count;
            count += 1;
        }
        number[n] = number[r];
    }
    number
}

/// Groups of points linked by a share of their reaches, each in the order of the list, which is by coordinates.
fn linked(points: &[Station], ids: &[usize], share: f64, least: f64) -> Vec<Vec<usize>> {
    let mut parent: Vec<usize> = (0..ids.len()).collect();
    let boxes: Vec<Box3> = ids.iter().map(|a| Box3::of([points[*a].point])).collect();
    let tree = BoxTree::build(&boxes);
    for (n, &a) in ids.iter().enumerate() {
        job::poll();
        let reach = (share * points[a].reach).max(least);
        tree.query(&boxes[n], reach, |m| {
            // Each pair once, and what is one already is not looked at again.
            if m <= n || root(&mut parent, n) == root(&mut parent, m) {
                return;
            }
            let b = ids[m];
            let both = reach.min((share * points[b].reach).max(least));
            if points[a].point.distance_squared(points[b].point) <= both * both {
                let (ra, rb) = (root(&mut parent, n), root(&mut parent, m));
                parent[ra.max(rb)] = ra.min(rb);
            }
        });
    }
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); ids.len()];
    for n in 0..ids.len() {
        groups[root(&mut parent, n)].push(ids[n]);
    }
    groups.retain(|g| !g.is_empty());
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, reach: f64) -> Station {
        Station { point: DVec3::new(x, 0.0, 0.0), reach }
    }

    #[test]
    fn points_within_the_smaller_reach_are_one() {
        for (gap, reach, one) in [(1.0, 1.0, true), (1.0 + 1e-9, 1.0, false), (0.5, 0.4, false)] {
            let found = gather(&[at(0.0, 1.0), at(gap, reach)], 1e-3);
            assert_eq!(found[0] == found[1], one, "{gap} {reach}");
        }
    }

    #[test]
    fn a_row_of_short_edges_is_not_one_point() {
        // Corners 0.3 apart, each brought by two faces that miss each other by 0.01.
        let corners = 40;
        let points: Vec<Station> = (0..2 * corners).map(|k| at(0.3 * f64::from(k / 2) + 0.01 * f64::from(k % 2), 1.0)).collect();
        let found = gather(&points, 1e-3);
        assert!((0..corners as usize).all(|k| found[2 * k] == found[2 * k + 1]));
        assert_eq!(found.iter().max(), Some(&(corners as usize - 1)));
    }

    #[test]
    fn groups_are_those_of_all_pairs() {
        // Against every pair, with reaches that differ and points in bands of one x.
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..40 {
            let points: Vec<Station> = (0..60)
                .map(|k| Station { point: DVec3::new(f64::from(k % 3), 6.0 * random(), 6.0 * random()), reach: 0.1 + random() })
                .collect();
            let mut ids: Vec<usize> = (0..points.len()).collect();
            ids.sort_by(|a, b| compare_points(points[*a].point, points[*b].point));
            let mut group: Vec<usize> = (0..ids.len()).collect();
            for (n, m) in (0..ids.len()).flat_map(|n| (0..ids.len()).map(move |m| (n, m))) {
                let (a, b) = (points[ids[n]], points[ids[m]]);
                if a.point.distance(b.point) <= a.reach.min(b.reach) {
                    let (x, y) = (group[n].min(group[m]), group[n].max(group[m]));
                    group.iter_mut().filter(|g| **g == y).for_each(|g| *g = x);
                }
            }
            for found in linked(&points, &ids, 1.0, 1e-3) {
                let place = |id: &usize| group[ids.iter().position(|i| i == id).unwrap()];
                assert!(found.iter().all(|id| place(id) == place(&found[0])));
                assert_eq!(found.len(), group.iter().filter(|g| **g == place(&found[0])).count());
            }
        }
    }

    #[test]
    fn a_wall_of_points_in_one_plane_takes_no_time() {
        // 40 000 pairs that all lie in one band of x: 1.6e9 pairs if each met each.
        let points: Vec<Station> = (0..80_000)
            .map(|k| {
                let (i, j) = (k / 2 % 200, k / 400);
                Station { point: DVec3::new(0.0, f64::from(i), f64::from(j) + 0.001 * f64::from(k % 2)), reach: 0.01 }
            })
            .collect();
        let found = gather(&points, 1e-3);
        assert!((0..40_000).all(|k| found[2 * k] == found[2 * k + 1]));
        assert_eq!(found.iter().max(), Some(&39_999));
    }

    #[test]
    fn groups_are_the_same_in_any_order() {
        let xs = [3.0, 0.0, 0.9, 7.0, 3.5, 7.9, 8.8];
        let forth = gather(&xs.map(|x| at(x, 1.0)), 1e-3);
        let mut back = xs;
        back.reverse();
        let back = gather(&back.map(|x| at(x, 1.0)), 1e-3);
        for (i, j) in (0..7).flat_map(|i| (0..7).map(move |j| (i, j))) {
            assert_eq!(forth[i] == forth[j], back[6 - i] == back[6 - j], "{i} {j}");
        }
    }
}
