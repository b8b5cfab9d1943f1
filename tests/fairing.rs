//! Measured points that are faired: what must hold of any of them.

use glam::{DMat3, DVec3};
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::spline::Spacing;
use lofting::surface::points::fair::{Faired, Fairing, Held, fair};

const SIGMA: f64 = 5.0;

fn how(within: f64) -> Fairing {
    Fairing { within, held: Held::Ends, order: 3, spacing: Spacing::Chord, kinks: None, corners: Vec::new(), along: None }
}

fn made(rows: &[Vec<DVec3>], how: &Fairing) -> Faired {
    fair(rows, how, Origin::NONE, &Tolerance::new(1e-3, 1e4)).unwrap().0
}

/// Normal deviates, always the same ones.
struct Deviates(u64);

impl Deviates {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

fn curve(n: usize) -> Vec<DVec3> {
    (0..n).map(|i| i as f64 / (n - 1) as f64).map(|s| DVec3::new(10_000.0 * s, 1000.0 * (3.0 * s).sin(), 200.0 * s * s)).collect()
}

fn sheet(n: usize, m: usize) -> Vec<Vec<DVec3>> {
    let at = |i: usize, j: usize| {
        let (s, t) = (i as f64 / (n - 1) as f64, j as f64 / (m - 1) as f64);
        DVec3::new(10_000.0 * s, 5000.0 * t, 800.0 * (2.0 * s).sin() * (1.5 * t).cos())
    };
    (0..m).map(|j| (0..n).map(|i| at(i, j)).collect()).collect()
}

fn scattered(rows: &[Vec<DVec3>], seed: u64) -> Vec<Vec<DVec3>> {
    let mut by = Deviates(seed);
    rows.iter().map(|row| row.iter().map(|p| *p + DVec3::Z * SIGMA * by.next()).collect()).collect()
}

fn rms(a: &[DVec3], b: &[DVec3]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn nothing_moves_farther_and_no_energy_rises() {
    for (k, rows) in [vec![curve(41)], vec![curve(200)], sheet(31, 21), sheet(12, 60)].iter().enumerate() {
        let rows = scattered(rows, 1 + k as u64);
        for order in 2..=4 {
            for within in [0.1, 1.0, 5.0, 15.0] {
                let found = made(&rows, &Fairing { order, ..how(within) });
                let measured = rows.concat();
                let farthest = found.points.iter().zip(&measured).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
                assert!(farthest <= within * (1.0 + 1e-12), "case {k}, order {order}, within {within}: {farthest}");
                assert!(found.rough[1] <= found.rough[0], "case {k}, order {order}, within {within}: {:?}", found.rough);
                let (first, last) = (measured[0], measured[measured.len() - 1]);
                assert!(found.points[0] == first && found.points[measured.len() - 1] == last, "ends stay");
                let gap = if rows.len() == 1 { 1e-6 } else { 1e-3 };
                assert!(found.gap <= gap, "case {k}, order {order}, within {within}: gap {:.2e}", found.gap);
            }
        }
    }
}

#[test]
fn the_gap_of_a_row_is_kept_by_any_other_points_within_reach() {
    let rows = scattered(&[curve(60)], 7);
    let found = made(&rows, &how(5.0));
    let energy = |rough: f64| rough * rough;
    let mut by = Deviates(11);
    for round in 0..200 {
        // Other points in the same balls: towards the ones found, off by less and less.
        let share = 1.0 / f64::from(1 + round);
        let nudged = |(p, q): (&DVec3, &DVec3)| {
            let step = *q - *p + DVec3::new(by.next(), by.next(), by.next()) * share;
            *p + step.clamp_length_max(5.0)
        };
        let mut other: Vec<DVec3> = rows[0].iter().zip(&found.points).map(nudged).collect();
        (other[0], other[59]) = (rows[0][0], rows[0][59]);
        let rough = roughness(&rows[0], &other);
        assert!(energy(rough) >= energy(found.rough[1]) - 1e-6 * energy(found.rough[0]), "{rough} {:?}", found.rough);
    }
}

/// The root of the mean square of the third derivatives of points over the chord lengths of others, mean step 1.
fn roughness(measured: &[DVec3], points: &[DVec3]) -> f64 {
    let chords: Vec<f64> = measured.windows(2).map(|p| p[0].distance(p[1])).collect();
    let mean = chords.iter().sum::<f64>() / chords.len() as f64;
    let at = |i: usize| chords[..i].iter().sum::<f64>() / mean;
    let third = |i: usize| {
        let t: Vec<f64> = (i..i + 4).map(at).collect();
        let share = |k: usize| 6.0 / (0..4).filter(|l| *l != k).map(|l| t[k] - t[l]).product::<f64>();
        let d: DVec3 = (0..4).map(|k| points[i + k] * share(k)).sum();
        d.length_squared() * (t[3] - t[0]) / 3.0
    };
    let count = points.len() - 3;
    ((0..count).map(third).sum::<f64>() / count as f64).sqrt()
}

#[test]
fn scatter_about_a_known_curve_and_sheet_is_less() {
    for (rows, within, most) in [(vec![curve(41)], 7.5, 0.75), (vec![curve(200)], 10.0, 0.6), (sheet(41, 31), 10.0, 0.5)] {
        let measured = scattered(&rows, 3);
        let found = made(&measured, &Fairing { along: Some(DVec3::Z), ..how(within) });
        let (before, after) = (rms(&measured.concat(), &rows.concat()), rms(&found.points, &rows.concat()));
        assert!(after < most * before, "{} rows: {before} → {after}", rows.len());
        assert!(found.rough[1] < 0.2 * found.rough[0], "{:?}", found.rough);
    }
}

#[test]
fn what_is_fair_stays() {
    let of = |f: &dyn Fn(f64) -> DVec3| vec![(0..50).map(|i| f(f64::from(i))).collect::<Vec<DVec3>>()];
    let uniform = |order| Fairing { order, spacing: Spacing::Uniform, held: Held::None, ..how(5.0) };
    let parabola = of(&|t| DVec3::new(100.0 * t, 3.0 * t * t, 7.0 - t * t));
    let cubic = of(&|t| DVec3::new(100.0 * t, 0.1 * t * t * t, 2.0 * t * t));
    for (rows, order) in [(&parabola, 3), (&parabola, 4), (&cubic, 4)] {
        let found = made(rows, &uniform(order));
        assert!(found.moved.iter().all(|d| *d <= 1e-9) && found.limited == 0 && found.outlier.is_none(), "order {order}");
    }
    assert!(made(&cubic, &uniform(3)).moved.iter().any(|d| *d > 1.0), "a cubic has a third derivative");
    let straight = of(&|t| DVec3::new(t * t, t * t, 0.0));
    assert!(made(&straight, &how(5.0)).moved.iter().all(|d| *d <= 1e-9), "chord lengths of a straight line");
}

#[test]
fn a_wider_reach_is_no_rougher() {
    for rows in [scattered(&[curve(80)], 5), scattered(&sheet(25, 15), 5)] {
        let found: Vec<Faired> = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0].iter().map(|r| made(&rows, &how(*r))).collect();
        for pair in found.windows(2) {
            let energy = |f: &Faired| f.rough[1] * f.rough[1];
            let slack = pair[1].gap * pair[1].rough[0] * pair[1].rough[0];
            assert!(energy(&pair[1]) <= energy(&pair[0]) + slack, "{:?} {:?}", pair[0].rough, pair[1].rough);
        }
    }
}

#[test]
fn a_model_that_is_scaled_and_moved_is_faired_alike() {
    for rows in [scattered(&[curve(41)], 9), scattered(&sheet(21, 11), 9)] {
        let found = made(&rows, &how(5.0));
        let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
        for (scale, by) in [(1e-3, DVec3::ZERO), (8.0, DVec3::new(300.0, -20.0, 50.0))] {
            let other: Vec<Vec<DVec3>> = rows.iter().map(|row| row.iter().map(|p| turn * *p * scale + by).collect()).collect();
            let (again, _) = fair(&other, &how(5.0 * scale), Origin::NONE, &Tolerance::new(1e-3 * scale, 1e4 * scale)).unwrap();
            for (a, b) in found.points.iter().zip(&again.points) {
                let off = (turn * *a * scale + by).distance(*b) / scale;
                assert!(off <= 1e-6, "{off}");
            }
            assert_eq!(found.limited, again.limited);
        }
    }
}

#[test]
fn a_slip_is_told_and_a_corner_kept() {
    let mut rows = scattered(&[curve(41)], 13);
    rows[0][17].y += 50.0;
    let (found, notes) = fair(&rows, &how(5.0), Origin::NONE, &Tolerance::new(1e-3, 1e4)).unwrap();
    assert_eq!(found.outlier.map(|(k, _)| k), Some(17));
    assert!(found.outlier.is_some_and(|(_, off)| (30.0..70.0).contains(&off)), "{:?}", found.outlier);
    assert_eq!(notes.iter().map(|note| note.code().0).collect::<Vec<_>>(), ["W679"]);

    let bent: Vec<DVec3> = (0..31).map(|i| DVec3::new(100.0 * f64::from(i), 40.0 * f64::from((i - 15).max(0)), 0.0)).collect();
    let rows = scattered(&[bent], 17);
    for told in [Fairing { corners: vec![15], ..how(6.0) }, Fairing { kinks: Some(0.25), ..how(6.0) }] {
        let (found, notes) = fair(&rows, &told, Origin::NONE, &Tolerance::new(1e-3, 1e4)).unwrap();
        assert_eq!(found.points[15], rows[0][15]);
        assert!(notes.is_empty() && found.rough[1] < 0.3 * found.rough[0], "{:?}", found.rough);
    }
}

#[test]
fn a_pole_stays_one_point() {
    let mut rows = scattered(&sheet(15, 9), 19);
    rows[0] = vec![DVec3::new(5000.0, -2000.0, 0.0); 15];
    let found = made(&rows, &how(5.0));
    assert!(found.points[..15].iter().all(|p| *p == rows[0][0]));
    assert!(found.rough[1] < found.rough[0]);
}
