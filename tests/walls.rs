//! Offsets keep their distance and walls enclose what area and curvature say, on random faces.

use std::f64::consts::PI;

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build;
use lofting::model::measure;
use lofting::network::Chain;
use lofting::surface::offset::thicken::thicken;
use lofting::surface::{Surface, closest, grid, offset};

use crate::support::random::{Random, cases};

/// A number between two.
fn between(numbers: &mut Random, a: f64, b: f64) -> f64 {
    a + (b - a) * numbers.share()
}

/// A wavy net of 10 × 10, bent nowhere tighter than a radius of about 4.
fn net(random: &mut Random, tolerance: &Tolerance) -> Surface {
    let (a, b, tilt) = (between(random, -0.8, 0.8), between(random, -0.8, 0.8), between(random, -0.5, 0.5));
    let (p, q) = (between(random, 0.0, 6.0), between(random, 0.0, 6.0));
    let point = |i: usize, j: usize| {
        let (x, y) = (2.5 * i as f64, 2.5 * j as f64);
        DVec3::new(x, y + 0.1 * tilt * x, a * (0.5 * x + p).sin() + b * (0.5 * y + q).cos() + tilt * x)
    };
    let rows: Vec<Vec<DVec3>> = (0..5).map(|j| (0..5).map(|i| point(i, j)).collect()).collect();
    grid(&rows, Origin::NONE, tolerance).unwrap().0
}

#[test]
fn offsets_keep_their_distance_and_come_back() {
    let tolerance = Tolerance::new(1e-4, 20.0);
    let mut random = Random(1);
    for case in 0..cases(200) {
        let face = net(&mut random, &tolerance);
        let d = between(&mut random, 0.05, 0.6) * if random.share() < 0.5 { -1.0 } else { 1.0 };
        let (made, notes) = offset(&face, d, Origin::NONE, &tolerance).unwrap();
        assert!(notes.is_empty(), "case {case}: {notes:?}");
        for _ in 0..5 {
            let (u, v) = (random.share(), random.share());
            let (p, wanted) = (made.point(u, v), face.point(u, v) + face.normal(u, v) * d);
            assert!(p.distance(wanted) <= tolerance.point, "case {case}: {} at {u} {v}", p.distance(wanted));
            let off = closest(&face, p).distance;
            assert!((off - d.abs()).abs() <= tolerance.point, "case {case}: {off} for {d}");
        }
        if case % 8 == 0 {
            let (back, _) = offset(&made, -d, Origin::NONE, &tolerance).unwrap();
            let (u, v) = (random.share(), random.share());
            assert!(back.point(u, v).distance(face.point(u, v)) <= 3.0 * tolerance.point, "case {case}");
        }
    }
}

/// The integral of the Gaussian curvature, by many small rectangles.
fn total_curvature(face: &Surface) -> f64 {
    const N: usize = 60;
    let at = |k: usize| (k as f64 + 0.5) / N as f64;
    let one = |k: usize| {
        let jet = face.jet(at(k % N), at(k / N));
        let (mean, apart) = jet.curvatures(face.normal(at(k % N), at(k / N)));
        (mean + apart) * (mean - apart) * jet.du.cross(jet.dv).length()
    };
    (0..N * N).map(one).sum::<f64>() / (N * N) as f64
}

#[test]
fn walls_of_nets_enclose_area_times_thickness_and_a_twelfth_of_the_curvature() {
    let tolerance = Tolerance::new(1e-4, 20.0);
    let mut random = Random(7);
    for case in 0..cases(200) {
        let face = net(&mut random, &tolerance);
        let t = between(&mut random, 0.1, 1.0);
        let (faces, _) = thicken(&face, (-0.5 * t, 0.5 * t), Origin::NONE, &tolerance).unwrap();
        assert_eq!(faces.len(), 6);
        let solid = measure::solid(&faces.into_iter().map(|f| (f, false)).collect::<Vec<_>>());
        let wanted = measure::area(&face) * t + total_curvature(&face) * t * t * t / 12.0;
        // Both sides may be off by a quarter of the tolerance.
        assert!(
            (solid.volume - wanted).abs() <= measure::area(&face) * tolerance.point + 1e-5 * wanted,
            "case {case}: {} and {wanted}",
            solid.volume
        );
    }
}

#[test]
fn walls_of_turned_profiles_enclose_what_steiner_says() {
    let tolerance = Tolerance::new(1e-6, 20.0);
    let mut random = Random(11);
    for case in 0..cases(200) {
        // A cone, or a part of a sphere between its poles.
        let (r, h, t) = (between(&mut random, 3.0, 6.0), between(&mut random, 2.0, 8.0), between(&mut random, 0.1, 1.0));
        let axis = lofting::surface::swept::revolve::Axis { about: DVec3::ZERO, direction: DVec3::Z };
        let sphere = case % 2 == 1;
        let profile = if sphere {
            build::arc_through(DVec3::new(0.0, 0.0, -r), DVec3::new(0.0, 0.0, r), DVec3::new(r, 0.0, 0.0), Origin::NONE).unwrap()
        } else {
            build::line(DVec3::new(r, 0.0, 0.0), DVec3::new(r + between(&mut random, -2.0, 2.0), 0.0, h), Origin::NONE).unwrap()
        };
        let face = lofting::surface::revolve(&Chain::of_curve(&profile), &axis, 2.0 * PI, Origin::NONE, &tolerance).unwrap();
        let (faces, _) = thicken(&face, (-0.5 * t, 0.5 * t), Origin::NONE, &tolerance).unwrap();
        let solid = measure::solid(&faces.into_iter().map(|f| (f, false)).collect::<Vec<_>>());
        let wanted = measure::area(&face) * t + if sphere { 4.0 * PI * t * t * t / 12.0 } else { 0.0 };
        assert!((solid.volume - wanted).abs() <= 1e-8 * wanted, "case {case}: {} and {wanted}", solid.volume);
    }
}
