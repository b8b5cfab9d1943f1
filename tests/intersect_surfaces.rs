//! Where surfaces meet curves and each other, against closed forms and dense samples.
//!
//! `PROPTEST_CASES` makes the runs longer.

use std::slice::from_ref;

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build;
use lofting::geometry::curves::curve::Shape;
use lofting::network::Chain;
use lofting::surface::core::plane;
use lofting::surface::intersect::{with_curve, with_surfaces};
use lofting::surface::points::control_net::{self, Net};
use lofting::surface::swept::revolve::{Axis, revolve};
use lofting::surface::{Nearest, Surface, divide, extrude};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

const TOLERANCE: f64 = 1e-6;

fn tolerance() -> Tolerance {
    Tolerance::new(TOLERANCE, 3.0)
}

fn runner(cases: u32) -> TestRunner {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(cases);
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]))
}

fn chain(a: DVec3, b: DVec3) -> Chain {
    Chain::of_curve(&build::line(a, b, Origin::NONE).unwrap())
}

fn ball() -> Surface {
    let arc = build::arc_through(DVec3::NEG_Z, DVec3::Z, DVec3::X, Origin::NONE).unwrap();
    let axis = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    revolve(&Chain::of_curve(&arc), &axis, std::f64::consts::TAU, Origin::NONE, &tolerance()).unwrap()
}

/// A bicubic over the unit square with these heights.
fn sheet(heights: &[f64]) -> Surface {
    let row = |j: usize| (0..4).map(|i| DVec3::new(i as f64 / 3.0, j as f64 / 3.0, heights[4 * j + i])).collect();
    let rows: Vec<Vec<DVec3>> = (0..4).map(row).collect();
    control_net::bezier(&Net { rows: &rows, weights: None }, Origin::NONE, &tolerance()).unwrap()
}

fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
    (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Fractions at which a straight way meets the unit sphere.
fn on_sphere(a: DVec3, b: DVec3) -> Vec<f64> {
    let d = b - a;
    let (p, q) = (a.dot(d) / d.length_squared(), (a.length_squared() - 1.0) / d.length_squared());
    let root = p * p - q;
    if root < 0.0 {
        return Vec::new();
    }
    [-p - root.sqrt(), -p + root.sqrt()].into_iter().filter(|f| (0.0..=1.0).contains(f)).collect()
}

#[test]
fn lines_meet_spheres_where_the_closed_form_says() {
    let ball = ball();
    let run = runner(200).run(&(vector(2.0), vector(2.0)), |(a, b)| {
        let (line, length) = (chain(a, b), a.distance(b));
        let closest = a + (b - a) * (-a.dot(b - a) / (b - a).length_squared());
        // Near a touch, or with an end on the sphere, the tolerance decides.
        prop_assume!(length > 0.1 && (closest.length() - 1.0).abs() > 1e-4);
        prop_assume!((a.length() - 1.0).abs() > 1e-4 && (b.length() - 1.0).abs() > 1e-4);
        let found = with_curve::with_curve(&line, from_ref(&ball), &tolerance()).unwrap();
        let wanted = on_sphere(a, b);
        prop_assert_eq!(found.len(), wanted.len());
        for (m, f) in found.iter().zip(&wanted) {
            prop_assert!((m.f - f).abs() * length < 1e-9, "{} {}", m.f, f);
            prop_assert!(ball.point(m.uv.0, m.uv.1).distance(m.point) < 1e-9);
        }
        Ok(())
    });
    run.unwrap();
}

/// Touching lines: one meeting; a hair outside the tolerance none, a hair inside the sphere two.
#[test]
fn a_touch_is_one_meeting() {
    let ball = ball();
    for (turn, (height, count)) in [(1.0, 1), (1.0 + 0.5e-6, 1), (1.0 + 2e-6, 0), (1.0 - 1e-4, 2)].into_iter().enumerate() {
        for way in [DVec3::X, DVec3::Y, DVec3::new(0.6, 0.8, 0.0)] {
            for up in [DVec3::Z, DVec3::new(-way.y, way.x, 0.0), DVec3::NEG_Z] {
                let line = chain(up * height - way * 1.3, up * height + way * 1.7);
                let found = with_curve::with_curve(&line, from_ref(&ball), &tolerance()).unwrap();
                assert_eq!(found.len(), count, "{turn} {way} {up}: {found:?}");
            }
        }
    }
}

/// Straight ways through a bicubic above its plane: as many meetings as a dense row of places has changes of sign.
#[test]
fn lines_meet_bicubics_as_often_as_dense_samples_say() {
    let heights = prop::collection::vec(-0.4..0.4_f64, 16);
    let run = runner(100).run(&(heights, 0.05..0.95_f64, 0.05..0.95_f64, -0.2..0.2_f64, -0.2..0.2_f64), |(heights, y0, y1, z0, z1)| {
        let sheet = sheet(&heights);
        let (a, b) = (DVec3::new(-0.1, y0, z0), DVec3::new(1.1, y1, z1));
        let found = with_curve::with_curve(&chain(a, b), from_ref(&sheet), &tolerance()).unwrap();
        // Over the unit square the surface is z(x, y) with u = x, v = y.
        let height = |k: usize| {
            let p = a.lerp(b, k as f64 / 4000.0);
            (0.0..=1.0).contains(&p.x).then(|| p.z - sheet.point(p.x, p.y).z)
        };
        let heights: Vec<f64> = (0..=4000).filter_map(height).collect();
        prop_assume!(heights.windows(3).all(|w| w[1].abs() > 1e-5 || (w[0] > w[1]) == (w[1] > w[2])));
        let changes = heights.windows(2).filter(|w| w[0] * w[1] < 0.0).count();
        prop_assert_eq!(found.len(), changes);
        let near = Nearest::new(&sheet);
        prop_assert!(found.iter().all(|m| near.at(m.point).distance < TOLERANCE));
        Ok(())
    });
    run.unwrap();
}

#[test]
fn a_curve_on_a_surface_is_one_stretch() {
    let ball = ball();
    let flat = plane::unbounded(DVec3::ZERO, DVec3::Z, Origin::NONE).unwrap();
    let circle = |normal: DVec3| Chain::of_curve(&build::circle(DVec3::ZERO, 1.0, normal, Origin::NONE).unwrap());
    for normal in [DVec3::Z, DVec3::X, DVec3::new(1.0, 2.0, 3.0).normalize()] {
        let found = with_curve::with_curve(&circle(normal), from_ref(&ball), &tolerance()).unwrap();
        assert!(matches!(found.as_slice(), [m] if m.f == 0.0 && m.overlap_end == Some(1.0)), "{normal}: {found:?}");
    }
    let found = with_curve::with_curve(&circle(DVec3::Z), &[flat], &tolerance()).unwrap();
    assert!(matches!(found.as_slice(), [m] if m.overlap_end == Some(1.0)), "{found:?}");
}

/// A tube about an axis through the origin.
fn tube(axis: DVec3, radius: f64, length: f64) -> Surface {
    let circle = build::circle(-axis * (0.5 * length), radius, axis, Origin::NONE).unwrap();
    extrude(&Chain::of_curve(&circle), axis * length, Origin::NONE, &tolerance()).unwrap()
}

fn flat(at: DVec3, normal: DVec3) -> Surface {
    plane::unbounded(at, normal, Origin::NONE).unwrap()
}

fn cut(a: &Surface, b: &Surface) -> Vec<Chain> {
    with_surfaces::with_surfaces(from_ref(a), from_ref(b), Origin::NONE, &tolerance()).unwrap().curves
}

/// Every one of many places of each curve is on both surfaces, within the quarter of the tolerance that is promised.
fn assert_on_both(curves: &[Chain], surfaces: [&Surface; 2]) {
    for surface in surfaces {
        let near = Nearest::new(surface);
        for curve in curves {
            for k in 0..=60 {
                let p = curve.point(f64::from(k) / 60.0);
                let off = near.at(p).distance;
                assert!(off <= 0.3 * TOLERANCE, "{p} is off by {off}");
            }
        }
    }
}

#[test]
fn planes_cut_spheres_in_circles() {
    let ball = ball();
    let strategy = (vector(1.0), -0.95..0.95_f64);
    let run = runner(30).run(&strategy, |(normal, height)| {
        prop_assume!(normal.length() > 0.1);
        let normal = normal.normalize();
        let plane = flat(normal * height, normal);
        let curves = cut(&ball, &plane);
        prop_assert_eq!(curves.len(), 1);
        prop_assert!(curves[0].is_closed(&tolerance()));
        let round = std::f64::consts::TAU * (1.0 - height * height).sqrt();
        prop_assert!((curves[0].length() - round).abs() < 1e-5, "{} {round}", curves[0].length());
        assert_on_both(&curves, [&ball, &plane]);
        Ok(())
    });
    run.unwrap();
}

/// Through the axis, through the seam, along the equator, a hair beside the pole, touching the pole.
#[test]
fn seams_and_poles_are_nothing_special() {
    let ball = ball();
    for normal in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.6, 0.8, 0.0), DVec3::new(0.6, 0.0, 0.8)] {
        for height in [0.0, 1e-4, 0.6, 0.999] {
            let plane = flat(normal * height, normal);
            let curves = cut(&ball, &plane);
            assert_eq!(curves.len(), 1, "{normal} {height}");
            assert!(curves[0].is_closed(&tolerance()), "{normal} {height}");
            let round = std::f64::consts::TAU * (1.0 - height * height).sqrt();
            assert!((curves[0].length() - round).abs() < 1e-5, "{normal} {height}: {} {round}", curves[0].length());
            assert_on_both(&curves, [&ball, &plane]);
        }
        for sign in [1.0, -1.0] {
            let common = with_surfaces::with_surfaces(from_ref(&ball), &[flat(normal * sign, normal)], Origin::NONE, &tolerance()).unwrap();
            assert!(common.curves.is_empty() && common.touches.len() == 1, "{normal}: {common:?}");
            assert!(common.touches[0].distance(normal * sign) < 1e-3);
        }
    }
    let tube = tube(DVec3::Z, 1.0, 2.0);
    // The seam is at y = 0, the lower border at z = -1.
    for (normal, height, count, length) in [
        (DVec3::Y, 0.0, 2, 4.0),
        (DVec3::X, 0.0, 2, 4.0),
        (DVec3::Z, -1.0, 1, std::f64::consts::TAU),
        (DVec3::Z, 1.0, 1, std::f64::consts::TAU),
        (DVec3::Z, 0.25, 1, std::f64::consts::TAU),
    ] {
        let curves = cut(&tube, &flat(normal * height, normal));
        assert_eq!(curves.len(), count, "{normal} {height}");
        assert!((curves.iter().map(Chain::length).sum::<f64>() - length).abs() < 1e-5);
        if count == 2 {
            assert!(curves.iter().all(|c| matches!(c.runs()[0].curve.shape(), Shape::Line(..))), "straight ones are lines");
        }
    }
}

/// Equal tubes at right angles cross in two ellipses that cross each other; unequal ones in two loops.
#[test]
fn tubes_cross_tubes() {
    let a = tube(DVec3::Z, 1.0, 4.0);
    for radius in [0.3, 0.9, 0.999] {
        let b = tube(DVec3::X, radius, 4.0);
        let curves = cut(&a, &b);
        assert_eq!(curves.len(), 2, "{radius}");
        assert!(curves.iter().all(|c| c.is_closed(&tolerance())));
        assert_on_both(&curves, [&a, &b]);
    }
    let b = tube(DVec3::X, 1.0, 4.0);
    match with_surfaces::with_surfaces(from_ref(&a), from_ref(&b), Origin::NONE, &tolerance()) {
        Ok(common) => {
            // Semi-axes 1 and √2.
            let length: f64 = common.curves.iter().map(Chain::length).sum();
            assert!((length - 2.0 * 7.640_395_578).abs() < 1e-4, "{length} {}", common.curves.len());
            assert_on_both(&common.curves, [&a, &b]);
        }
        Err(fault) => assert!(matches!(fault.code().0, "E413" | "E657"), "{fault}"),
    }
}

#[test]
fn surfaces_on_each_other_are_told() {
    let a = tube(DVec3::Z, 1.0, 4.0);
    for b in [tube(DVec3::Z, 1.0, 3.0), tube(DVec3::Z, 1.0, 4.0)] {
        let fault = with_surfaces::with_surfaces(from_ref(&a), &[b], Origin::NONE, &tolerance()).unwrap_err();
        assert_eq!(fault.code().0, "E657", "{fault}");
    }
    // A plane that touches it along a line meets it there.
    let ruling = with_surfaces::with_surfaces(from_ref(&a), &[flat(DVec3::X, DVec3::X)], Origin::NONE, &tolerance()).unwrap();
    assert_eq!(ruling.curves.len(), 1);
    assert!((ruling.curves[0].length() - 4.0).abs() < 1e-12);
}

/// Rows of signs over a fine grid: how many lines of zeros a height over the unit square has, by runs of cells that touch.
fn lines_of_zeros(height: impl Fn(f64, f64) -> f64) -> (usize, f64) {
    const N: usize = 160;
    let value = |i: usize, j: usize| height(i as f64 / N as f64, j as f64 / N as f64);
    let values: Vec<f64> = (0..=N).flat_map(|j| (0..=N).map(move |i| (i, j))).map(|(i, j)| value(i, j)).collect();
    let at = |i: usize, j: usize| values[j * (N + 1) + i];
    let mixed = |i: usize, j: usize| {
        let corners = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        corners.iter().any(|z| *z > 0.0) && corners.iter().any(|z| *z <= 0.0)
    };
    let mut seen = vec![false; N * N];
    let mut count = 0;
    for start in 0..N * N {
        if seen[start] || !mixed(start % N, start / N) {
            continue;
        }
        count += 1;
        let mut open = vec![start];
        seen[start] = true;
        while let Some(k) = open.pop() {
            let (i, j) = (k % N, k / N);
            for (x, y) in [(i.wrapping_sub(1), j), (i + 1, j), (i, j.wrapping_sub(1)), (i, j + 1)] {
                if x < N && y < N && !seen[y * N + x] && mixed(x, y) {
                    seen[y * N + x] = true;
                    open.push(y * N + x);
                }
            }
        }
    }
    // The least slope where the height is near zero says whether the grid can be trusted.
    let steep = (0..N * N).filter(|k| mixed(k % N, k / N)).map(|k| {
        let (i, j) = (k % N, k / N);
        (at(i + 1, j) - at(i, j)).abs().max((at(i, j + 1) - at(i, j)).abs()) * N as f64
    });
    (count, steep.fold(f64::INFINITY, f64::min))
}

#[test]
fn planes_cut_bicubics_in_as_many_curves_as_dense_samples_say() {
    let heights = prop::collection::vec(-0.6..0.6_f64, 16);
    let run = runner(40).run(&(heights, vector(0.6), -0.3..0.3_f64), |(heights, tilt, height)| {
        let sheet = sheet(&heights);
        let (at, normal) = (DVec3::new(0.5, 0.5, height), (DVec3::Z + tilt * DVec3::new(1.0, 1.0, 0.0)).normalize());
        let plane = flat(at, normal);
        let (count, steep) = lines_of_zeros(|x, y| (sheet.point(x, y) - at).dot(normal));
        let curves = cut(&sheet, &plane);
        assert_on_both(&curves, [&sheet, &plane]);
        prop_assume!(steep > 0.08);
        prop_assert_eq!(curves.len(), count);
        Ok(())
    });
    run.unwrap();
}

#[test]
fn bicubics_cut_bicubics() {
    let heights = || prop::collection::vec(-0.5..0.5_f64, 16);
    let run = runner(25).run(&(heights(), heights()), |(first, second)| {
        let (a, b) = (sheet(&first), sheet(&second));
        let (count, steep) = lines_of_zeros(|x, y| a.point(x, y).z - b.point(x, y).z);
        let curves = cut(&a, &b);
        assert_on_both(&curves, [&a, &b]);
        prop_assume!(steep > 0.08);
        prop_assert_eq!(curves.len(), count);
        Ok(())
    });
    run.unwrap();
}

/// A loop that no border meets, down to a few tolerances.
#[test]
fn small_loops_inside_are_found() {
    let heights: Vec<f64> = (0..16).map(|k| if [5, 6, 9, 10].contains(&k) { 1.0 } else { 0.0 }).collect();
    let sheet = sheet(&heights);
    let top = sheet.point(0.5, 0.5).z;
    for below in [0.1, 1e-2, 1e-3, 1e-4] {
        let curves = cut(&sheet, &flat(DVec3::Z * (top - below), DVec3::Z));
        assert_eq!(curves.len(), 1, "{below}");
        assert!(curves[0].is_closed(&tolerance()));
    }
}

/// One plane that cuts a bicubic in two: the part that is kept is the side of the point, place by place.
#[test]
fn the_part_with_the_point_stays() {
    let heights = prop::collection::vec(-0.6..0.6_f64, 16);
    let run = runner(40).run(&(heights, vector(0.6), -0.3..0.3_f64, (0.1..0.9_f64, 0.1..0.9_f64)), |(heights, tilt, height, (u, v))| {
        let sheet = sheet(&heights);
        let (at, normal) = (DVec3::new(0.5, 0.5, height), (DVec3::Z + tilt * DVec3::new(1.0, 1.0, 0.0)).normalize());
        let side = |u: f64, v: f64| (sheet.point(u, v) - at).dot(normal);
        let (_, steep) = lines_of_zeros(side);
        let curves = cut(&sheet, &flat(at, normal));
        prop_assume!(curves.len() == 1 && steep > 0.08 && side(u, v).abs() > 1e-3);
        let kept = divide(&sheet, &curves, sheet.point(u, v), Origin::NONE, &tolerance()).unwrap();
        for k in 0..400 {
            let (x, y) = ((f64::from(k % 20) + 0.5) / 20.0, (f64::from(k / 20) + 0.5) / 20.0);
            if side(x, y).abs() > 1e-4 {
                prop_assert_eq!(kept.holds(x, y), side(x, y) * side(u, v) > 0.0, "{} {}", x, y);
            }
        }
        Ok(())
    });
    run.unwrap();
}
