//! Points of many borders that are one within what each of them allows.

use glam::DVec3;

use super::glue::root;
use crate::base::bbox::Box3;
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
        let groups = linked(points, &ids, share, least);
        for group in groups {
            let reach = group.iter().map(|n| points[*n].reach).fold(0.0, f64::max);
            let wide = Box3::of(group.iter().map(|n| points[*n].point)).diagonal() > WIDEST * reach;
            if wide && share * reach > least {
                open.push((group, 0.5 * share));
                continue;
            }
            for pair in group.windows(2) {
                let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
                parent[a.max(b)] = a.min(b);
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
    for (n, &a) in ids.iter().enumerate() {
        let reach = (share * points[a].reach).max(least);
        for (m, &b) in ids.iter().enumerate().skip(n + 1) {
            if points[b].point.x - points[a].point.x > reach {
                break;
            }
            let both = reach.min((share * points[b].reach).max(least));
            if points[a].point.distance_squared(points[b].point) <= both * both {
                let (ra, rb) = (root(&mut parent, n), root(&mut parent, m));
                parent[ra.max(rb)] = ra.min(rb);
            }
        }
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
