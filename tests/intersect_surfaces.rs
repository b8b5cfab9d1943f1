//! Where surfaces meet curves and each other, against closed forms and dense samples.
//!
//! `PROPTEST_CASES` makes the runs longer.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::slice::from_ref;

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::build;
use lofting::network::Chain;
use lofting::surface::meet;
use lofting::surface::nurbs::{self, Net};
use lofting::surface::revolve::{Axis, revolve};
use lofting::surface::{Nearest, Surface, plane};
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
    nurbs::bezier(&Net { rows: &rows, weights: None }, Origin::NONE, &tolerance()).unwrap()
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
        let found = meet::with_curve(&line, from_ref(&ball), &tolerance()).unwrap();
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
                let found = meet::with_curve(&line, from_ref(&ball), &tolerance()).unwrap();
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
        let found = meet::with_curve(&chain(a, b), from_ref(&sheet), &tolerance()).unwrap();
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
        let found = meet::with_curve(&circle(normal), from_ref(&ball), &tolerance()).unwrap();
        assert!(matches!(found.as_slice(), [m] if m.f == 0.0 && m.shared_to == Some(1.0)), "{normal}: {found:?}");
    }
    let found = meet::with_curve(&circle(DVec3::Z), &[flat], &tolerance()).unwrap();
    assert!(matches!(found.as_slice(), [m] if m.shared_to == Some(1.0)), "{found:?}");
}
