//! Gordon surfaces through networks of real parts: built from curves in any order, direction and size, exact on the net.

use std::fmt::Write as _;
use std::path::Path;

use glam::DVec3;
use lofting::base::tolerance::Tolerance;
use lofting::model::measure::area_within;
use lofting::session::disk::{Disk, Outputs};
use lofting::surface::Surface;
use lofting::surface::blended::gordon::NetCheck;

use crate::support::networks::{NETWORKS, as_given, network, surface};
use crate::support::script;

#[test]
fn every_network_is_contained_and_smooth() {
    for (name, gap) in NETWORKS {
        for scale in [1.0, 1e-3, 1e3] {
            let (surface, size) = as_given(name, gap, scale);
            let NetCheck { residual, gap, turn } = surface.net_check(&Tolerance::new(1e-6 * size, size)).unwrap();
            assert!(residual <= gap.max(1e-12 * size), "{name} × {scale}: {:e} of the size", residual / size);
            assert!(turn.to_degrees() <= 1e-3, "{name} × {scale}: {}°", turn.to_degrees());
        }
    }
}

/// Largest distance of two surfaces at equal (u, v), u and v turned round as it suits best, as a share of the size.
fn same_points(a: &Surface, b: &Surface, size: f64) -> f64 {
    let places: Vec<(f64, f64)> = (0..=6).flat_map(|i| (0..=6).map(move |j| (f64::from(i) / 6.0, f64::from(j) / 6.0))).collect();
    let off = |turned: (bool, bool)| {
        let one = |x: f64, turned: bool| if turned { 1.0 - x } else { x };
        places.iter().map(|&(u, v)| a.point(u, v).distance(b.point(one(u, turned.0), one(v, turned.1)))).fold(0.0, f64::max)
    };
    [(false, false), (true, false), (false, true), (true, true)].map(off).into_iter().fold(f64::INFINITY, f64::min) / size
}

#[test]
fn order_and_direction_change_nothing() {
    let mut chance: u64 = 11;
    let mut next = |n: usize| {
        chance = chance.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (chance >> 33) as usize % n
    };
    for (name, gap) in NETWORKS {
        let (first, size) = as_given(name, gap, 1.0);
        for round in 0..20 {
            let families = network(name).map(|mut family| {
                (1..family.len()).rev().for_each(|k| family.swap(k, next(k + 1)));
                family.iter().map(|c| c.chain(1.0, next(2) == 1)).collect()
            });
            let off = same_points(&first, &surface(families, gap).0, size);
            assert!(off <= 1e-12, "{name}, round {round}: {off:e} of the size");
        }
    }
}

/// Sum of the flat triangles of n × m cells.
fn flat_area(surface: &Surface, (n, m): (usize, usize)) -> f64 {
    let row = |j: usize| (0..=n).map(|i| surface.point(i as f64 / n as f64, j as f64 / m as f64)).collect::<Vec<DVec3>>();
    let rows: Vec<Vec<DVec3>> = (0..=m).map(row).collect();
    let triangle = |a: DVec3, b: DVec3, c: DVec3| 0.5 * (b - a).cross(c - a).length();
    let cell = |a: &[DVec3], b: &[DVec3], i: usize| triangle(a[i], a[i + 1], b[i]) + triangle(b[i + 1], b[i], a[i + 1]);
    rows.windows(2).flat_map(|w| (0..n).map(move |i| cell(&w[0], &w[1], i))).sum()
}

#[test]
fn the_area_of_a_net_with_many_knots_is_as_exact_as_any() {
    let surface = as_given("spiralwing", 3e-4, 1.0).0;
    let (area, error) = area_within(&surface);
    assert!(error <= 1e-10 * area, "{area} with {error:e}");
    let (rough, fine) = (flat_area(&surface, (240, 60)), flat_area(&surface, (480, 120)));
    let off = (fine + (fine - rough) / 3.0 - area).abs() / area;
    assert!(off < 1e-4 && off < (fine - rough).abs() / area, "{area}, triangles {rough}, {fine}: {off:e}");
}

#[test]
fn a_script_builds_a_network() {
    let mut text = String::new();
    let mut names = [String::new(), String::new()];
    for ((family, letter), names) in network("test_surface4").iter().zip(["p", "g"]).zip(&mut names) {
        for (k, c) in family.iter().enumerate() {
            let poles: Vec<String> = c.poles.iter().map(|p| format!("({}, {}, {})", p.x, p.y, p.z)).collect();
            let weights = vec!["1"; c.poles.len()].join(", ");
            writeln!(
                text,
                "curve {letter}{k} = nurbs([{}], weights: [{weights}], knots: {:?}, degree: {})",
                poles.join(", "),
                c.knots,
                c.degree
            )
            .unwrap();
            write!(names, "{letter}{k}, ").unwrap();
        }
    }
    writeln!(text, "surface s = gordon(profiles: [{}], guides: [{}])", names[0], names[1]).unwrap();
    // The area that another program's surface through the net has, which misses it by 2e-4 of its size.
    writeln!(text, "check s.area == 496.33mm2 within 3%").unwrap();
    writeln!(text, "check distance(p2.at(37%), s) < 1e-7mm").unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let outcome = script::outcome("m.loft", text.as_bytes(), &[], &Disk::new(None, Some(folder), &[], Outputs::Written).unwrap());
    assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
}
