//! Surfaces one after another as one: nothing moves, common borders have one parameter, order and direction change nothing.

use glam::DVec3;
use lofting::base::math;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::line;
use lofting::network::Chain;
use lofting::surface::points::control_net::{Net, nurbs};
use lofting::surface::swept::revolve::{Axis, revolve};
use lofting::surface::{Nearest, OneSided, Surface, join};

use crate::support::random::{Random, cases};

const AFTER: OneSided = OneSided::After;

fn tolerance() -> Tolerance {
    Tolerance::new(1e-7, 5.0)
}

/// A net between two rows of points with weights, the second border the same curve with other weights: another parameter.
fn between(a: &[DVec3], b: &[DVec3], twist: f64) -> Surface {
    let middle: Vec<DVec3> = a.iter().zip(b).map(|(p, q)| 0.5 * (*p + *q) + DVec3::Z * 0.2).collect();
    let rows: Vec<Vec<DVec3>> = (0..a.len()).map(|k| vec![a[k], middle[k], b[k]]).collect();
    // Weights w, wt, wt², … leave a Bezier curve where it is and change its parameter.
    let mut weight = 1.0;
    let weights: Vec<Vec<f64>> = rows
        .iter()
        .map(|_| {
            let row = vec![weight; 3];
            weight *= twist;
            row
        })
        .collect();
    nurbs(&Net { rows: &rows, weights: Some(&weights) }, (2, 3), (None, None), Origin::NONE, &tolerance()).unwrap()
}

fn row(numbers: &mut Random, n: usize) -> Vec<Surface> {
    let line = |k: usize, numbers: &mut Random| -> Vec<DVec3> {
        (0..4).map(|j| DVec3::new(k as f64 + 0.4 * numbers.share(), j as f64 * 0.7, numbers.share() - 0.5)).collect()
    };
    let lines: Vec<Vec<DVec3>> = (0..=n).map(|k| line(k, numbers)).collect();
    (0..n).map(|k| between(&lines[k], &lines[k + 1], 0.7 + 0.7 * numbers.share())).collect()
}

#[test]
fn nothing_moves_and_borders_have_one_parameter() {
    let mut numbers = Random(0x701_1ed);
    for case in 0..cases(200) {
        let parts = row(&mut numbers, 2 + case % 4);
        let whole = join(&parts, Origin::NONE, &tolerance()).unwrap();
        let (stops, _) = whole.breaks();
        assert!(stops.len() + 1 >= parts.len());
        for _ in 0..20 {
            let v = numbers.share();
            // The first one's v stays.
            assert!(whole.point(0.0, v).distance(parts[0].point(0.0, v)) < 1e-13, "case {case}");
            for u in whole.kinks().0 {
                let [a, b] = [OneSided::Before, OneSided::After].map(|lean| whole.jet_one_sided(*u, v, (lean, AFTER)));
                assert!(a.p.distance(b.p) < 1e-13, "case {case}: {:e}", a.p.distance(b.p));
                assert!(a.dv.distance(b.dv) < 1e-10, "case {case}: {:e}", a.dv.distance(b.dv));
                assert!(a.dvv.distance(b.dvv) < 1e-8 * (1.0 + a.dvv.length()), "case {case}: {:e}", a.dvv.distance(b.dvv));
            }
            // Derivatives are those of the points.
            let (u, step) = (0.01 + 0.98 * numbers.share(), 1e-5);
            let v = 0.01 + 0.98 * v;
            if stops.iter().all(|s| (s - u).abs() > 2.0 * step) {
                let jet = whole.jet(u, v);
                let dv = (whole.point(u, v + step) - whole.point(u, v - step)) / (2.0 * step);
                let duv = (whole.jet(u + step, v).dv - whole.jet(u - step, v).dv) / (2.0 * step);
                let dvv = (whole.jet(u, v + step).dv - whole.jet(u, v - step).dv) / (2.0 * step);
                for (what, found, wanted) in [("dv", jet.dv, dv), ("duv", jet.duv, duv), ("dvv", jet.dvv, dvv)] {
                    assert!(found.distance(wanted) <= 1e-6 * (1.0 + 10.0 * wanted.length()), "case {case}: {what} {found} {wanted}");
                }
            }
        }
        let (u, v) = (numbers.share() * 0.7, numbers.share() * 0.7);
        let bounds = whole.enclosure((u, u + 0.2), (v, v + 0.2));
        for _ in 0..30 {
            let jet = whole.jet(u + 0.2 * numbers.share(), v + 0.2 * numbers.share());
            for (value, range) in
                [(jet.p, bounds.p), (jet.du, bounds.du), (jet.dv, bounds.dv), (jet.duv, bounds.duv), (jet.dvv, bounds.dvv)]
            {
                let room = DVec3::splat(1e-9 * (1.0 + value.length()));
                assert!(value.cmpge(range.low - room).all() && value.cmple(range.high + room).all(), "case {case}: {value} {range:?}");
            }
        }
    }
}

#[test]
fn order_direction_and_nesting_change_nothing() {
    let mut numbers = Random(0x0_de8);
    for case in 0..cases(100) {
        let parts = row(&mut numbers, 3 + case % 3);
        let whole = join(&parts, Origin::NONE, &tolerance()).unwrap();
        let mut others: Vec<Surface> = parts[1..].iter().map(|s| if numbers.share() < 0.5 { s.flipped() } else { s.clone() }).collect();
        others.reverse();
        let turned = join(&[&parts[..1], &others].concat(), Origin::NONE, &tolerance()).unwrap();
        let first = join(&parts[..2], Origin::NONE, &tolerance()).unwrap();
        let nested = join(&[&[first], &parts[2..]].concat(), Origin::NONE, &tolerance()).unwrap();
        for _ in 0..20 {
            let (u, v) = (numbers.share(), numbers.share());
            assert_eq!(nested.jet(u, v), whole.jet(u, v), "case {case}");
            assert!(turned.point(u, v).distance(whole.point(u, v)) < 1e-12, "case {case}");
        }
    }
}

/// Cones, each on the circle where the one before ends, with their seams at any angle and either way round.
fn tower(numbers: &mut Random, n: usize) -> Vec<Surface> {
    let radius: Vec<f64> = (0..=n).map(|_| 0.5 + numbers.share()).collect();
    let cone = |k: usize, numbers: &mut Random| {
        let (sin, cos) = math::sin_cos(numbers.share() * std::f64::consts::TAU);
        let at = |k: usize| DVec3::new(radius[k] * cos, radius[k] * sin, k as f64);
        let ends = if numbers.share() < 0.5 { (at(k), at(k + 1)) } else { (at(k + 1), at(k)) };
        let direction = if numbers.share() < 0.5 { DVec3::Z } else { -DVec3::Z };
        let profile = Chain::of_curve(&line(ends.0, ends.1, Origin::NONE).unwrap());
        revolve(&profile, &Axis { about: DVec3::ZERO, direction }, std::f64::consts::TAU, Origin::NONE, &tolerance()).unwrap()
    };
    (0..n).map(|k| cone(k, numbers)).collect()
}

#[test]
fn seams_of_closed_borders_may_lie_anywhere() {
    let mut numbers = Random(0x5ea0);
    for case in 0..cases(60) {
        let parts = tower(&mut numbers, 2 + case % 3);
        let whole = join(&parts, Origin::NONE, &tolerance()).unwrap();
        assert_eq!(whole.closed(), (true, false), "case {case}");
        let near = Nearest::new(&whole);
        for part in &parts {
            for _ in 0..20 {
                let p = part.point(numbers.share(), numbers.share());
                assert!(near.at(p).distance < 1e-9, "case {case}: {p} is {} off", near.at(p).distance);
            }
        }
        for _ in 0..20 {
            let (u, v) = (numbers.share(), numbers.share());
            // No step is at the seam of all, nor at that of a part.
            assert!(whole.point(0.0, v).distance(whole.point(1.0, v)) < 1e-12, "case {case}");
            for line in whole.breaks().0 {
                let [a, b] = [OneSided::Before, OneSided::After].map(|lean| whole.jet_one_sided(line, v, (lean, AFTER)));
                assert!(a.p.distance(b.p) < 1e-9 && a.du.distance(b.du) < 1e-6, "case {case}: {line}");
            }
            // Every point is on a cone of the tower.
            let p = whole.point(u, v);
            let off = parts.iter().map(|part| Nearest::new(part).at(p).distance).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-9, "case {case}: {p} is {off} off");
        }
        let (u, v) = (numbers.share() * 0.8, numbers.share() * 0.8);
        let bounds = whole.enclosure((u, u + 0.2), (v, v + 0.2));
        for _ in 0..30 {
            let jet = whole.jet(u + 0.2 * numbers.share(), v + 0.2 * numbers.share());
            for (value, range) in [(jet.p, bounds.p), (jet.du, bounds.du), (jet.dv, bounds.dv), (jet.duu, bounds.duu)] {
                let room = DVec3::splat(1e-9 * (1.0 + value.length()));
                assert!(value.cmpge(range.low - room).all() && value.cmple(range.high + room).all(), "case {case}: {value} {range:?}");
            }
        }
    }
}
