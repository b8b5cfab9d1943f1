//! Random trimmed faces: a valid mesh or a reason, never a panic and never half a face.
//!
//! Runs are longer in a long run; `PROPTEST_CASES` says how many cases.

use std::fmt::Write as _;
use std::path::Path;

use glam::{DVec2, DVec3};
use lofting::base::job::Job;
use lofting::base::math::sin_cos;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_through, circle, line};
use lofting::mesh::chart::outline::Outline;
use lofting::mesh::chart::parametric_surface::{SizeField, UniformSize};
use lofting::mesh::tri::build::{NodePlacement, Task, triangulate};
use lofting::mesh::tri::optimize::{FINEST, OptimizeSettings, SearchBudget};
use lofting::model::measure;
use lofting::network::Chain;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;
use lofting::surface::swept::revolve::Axis;
use lofting::surface::{Ground as Speaks, Outlined, extrude, outlined, revolve};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseResult, TestRng, TestRunner};

use crate::support::invariants;
use crate::support::outlines::{CARE, Waves, add_loop, sound, star};
use crate::support::random;
use crate::support::script;

/// Small at the origin.
struct Graded(f64);

impl SizeField for Graded {
    fn size(&self, xy: DVec2, _: DVec3) -> f64 {
        self.0 * (0.3 + 0.2 * xy.length()).min(1.0)
    }
}

fn check<S: Strategy>(cases: u32, strategy: &S, test: impl Fn(S::Value) -> TestCaseResult) {
    check_one_in(1, cases, strategy, test);
}

/// The same for what takes longer: one in so many of the cases that are asked for.
fn check_one_in<S: Strategy>(share: u32, cases: u32, strategy: &S, test: impl Fn(S::Value) -> TestCaseResult) {
    let cases = random::cases((cases * share) as usize).div_ceil(share as usize) as u32;
    let config = Config { cases, max_shrink_iters: 200, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[23; 32]));
    runner.run(strategy, test).unwrap_or_else(|error| panic!("{error}"));
}

/// Spiked outlines with a spiked hole in the middle that comes as near as it likes, on waves, with one size or graded.
#[test]
fn spiked_loops_make_sound_faces_or_say_why() {
    let radii = proptest::collection::vec(0.05_f64..1.0, 3..24);
    let hole = proptest::collection::vec(0.002_f64..1.0, 3..16);
    let shape = (radii, hole, 0.0_f64..6.0, 0.05_f64..0.9, 0.0_f64..0.6, any::<bool>());
    check(60, &shape, |(radii, hole, turn, size, height, graded)| {
        let chart_surface = Waves(height);
        let outer: Vec<f64> = radii.iter().map(|r| 4.0 * r).collect();
        let least = outer.iter().copied().fold(f64::INFINITY, f64::min);
        // The hole may touch or cross: then there is a reason.
        let inner: Vec<f64> = hole.iter().map(|r| least * r).collect();
        let mut outline = Outline::default();
        add_loop(&mut outline, &chart_surface, &star(DVec2::ZERO, &outer, 0.0), size);
        add_loop(&mut outline, &chart_surface, &star(DVec2::ZERO, &inner, turn), size);
        let (even, by_place) = (UniformSize(size), Graded(size));
        let field: &dyn SizeField = if graded { &by_place } else { &even };
        let task = Task {
            interpolated: None,
            chart_surface: &chart_surface,
            field,
            outline: &outline,
            lattice: NodePlacement::Triangles,
            settings: CARE,
            most: 100_000,
            limit_check: None,
            sliding: None,
        };
        match triangulate(&task, &Job::new()).unwrap() {
            Ok(made) => sound(&made.triangulation, &outline, None),
            Err(_) => Ok(()),
        }
    });
}

/// A square with small holes apart, down to holes inside one cell: always a face, with the right Euler number and fair angles.
#[test]
fn holes_of_any_size_are_kept() {
    let hole = (0.0_f64..1.0, 0.0_f64..1.0, 0.01_f64..0.3, 3_usize..12);
    let shape = (proptest::collection::vec(hole, 0..5), 0.1_f64..0.8);
    check(60, &shape, |(holes, size)| {
        let chart_surface = Waves(0.0);
        let mut outline = Outline::default();
        add_loop(&mut outline, &chart_surface, &[DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(4.0, 4.0), DVec2::new(0.0, 4.0)], size);
        for (k, (x, y, r, n)) in holes.iter().enumerate() {
            // One hole a quarter (the fifth in the middle), off its border.
            let cell = if k < 4 { DVec2::new((k % 2) as f64, (k / 2) as f64) * 2.0 + 0.4 } else { DVec2::splat(1.8) };
            let room = if k < 4 { 1.2 } else { 0.4 };
            let r = r.min(room / 2.5);
            let center = cell + DVec2::new(r + x * (room - 2.0 * r), r + y * (room - 2.0 * r));
            add_loop(&mut outline, &chart_surface, &star(center, &vec![r; *n], 0.3), size);
        }
        let task = Task {
            interpolated: None,
            chart_surface: &chart_surface,
            field: &UniformSize(size),
            outline: &outline,
            lattice: NodePlacement::Triangles,
            settings: CARE,
            most: 100_000,
            limit_check: None,
            sliding: None,
        };
        let triangulation = triangulate(&task, &Job::new()).unwrap().map_err(|t| TestCaseError::fail(format!("{t:?}")))?.triangulation;
        sound(&triangulation, &outline, Some(holes.len()))
    });
}

/// The plate of a published benchmark: twenty holes, one size.
#[test]
fn a_plate_with_holes_is_better_than_frontal_meshers() {
    let chart_surface = Waves(0.0);
    let mut outline = Outline::default();
    let size = 2.0;
    let corners = [DVec2::ZERO, DVec2::new(200.0, 0.0), DVec2::new(200.0, 100.0), DVec2::new(0.0, 100.0)];
    add_loop(&mut outline, &chart_surface, &corners, size);
    for j in 0..4 {
        for i in 0..5 {
            let (x, y, r) = (20.0 + 40.0 * f64::from(i), 12.5 + 25.0 * f64::from(j), 4.0 + 0.5 * f64::from((i + 2 * j) % 5));
            let n = (std::f64::consts::TAU * r / size).ceil() as usize;
            add_loop(&mut outline, &chart_surface, &star(DVec2::new(x, y), &vec![r; n], 0.0), 2.0 * size);
        }
    }
    let settings = OptimizeSettings {
        smoothing_rounds: 30,
        relaxation: 1.0,
        still_quality: FINEST,
        min_quality: 0.92,
        fair_quality: 1.0,
        max_length_ratio: 1.4,
        searches: SearchBudget::FEW,
    };
    let task = Task {
        interpolated: None,
        chart_surface: &chart_surface,
        field: &UniformSize(size),
        outline: &outline,
        lattice: NodePlacement::Triangles,
        settings,
        most: 100_000,
        limit_check: None,
        sliding: None,
    };
    let triangulation = triangulate(&task, &Job::new()).unwrap().unwrap().triangulation;
    sound(&triangulation, &outline, Some(20)).unwrap();
    let all: Vec<f64> = (0..triangulation.tri.len() as u32).map(|t| triangulation.quality(t)).collect();
    let (mean, worst) = (all.iter().sum::<f64>() / all.len() as f64, all.iter().copied().fold(1.0, f64::min));
    assert!(mean > 0.985 && worst > 0.85, "mean {mean}, worst {worst}");
}

/// Closed surfaces about the z axis, all of them near 100 mm across: the script, whether a mesh of all of it is closed, and the
/// largest slope of places that loops are aimed at.
const CLOSED: [(&str, bool, f64); 4] = [
    (
        "revolve(arc((0, 0, -100), (0, 0, 100), through: (100, 0, 0)), axis: line((0, 0, -100), (0, 0, 100)))",
        true,
        std::f64::consts::FRAC_PI_2,
    ),
    ("extrude(circle(center: (0, 0, -100), radius: 100), by: (0, 0, 200))", false, 0.3),
    ("revolve(line((100, 0, -100), (0, 0, 100)), axis: line((0, 0, -100), (0, 0, 100)))", false, std::f64::consts::FRAC_PI_2),
    ("revolve(circle(center: (80, 0, 0), radius: 40, normal: (0, 1, 0)), axis: line((0, 0, -100), (0, 0, 100)))", true, 0.0),
];

/// A loop in the plane across a direction: a circle for no corners, else a polygon.
fn aimed(round: f64, up: f64, radius: f64, corners: &[f64]) -> String {
    let ((sa, ca), (sb, cb)) = (sin_cos(round), sin_cos(up));
    let d = DVec3::new(ca * cb, sa * cb, sb);
    let (x, y) = (DVec3::new(-sa, ca, 0.0), DVec3::new(-ca * sb, -sa * sb, cb));
    let at = |p: DVec3| format!("({:.9}, {:.9}, {:.9})", p.x, p.y, p.z);
    let center = d * 130.0;
    if corners.len() < 3 {
        return format!("project(circle(center: {}, radius: {radius:.9}, normal: {}), onto: s, along: {})", at(center), at(d), at(d));
    }
    let flat = star(DVec2::ZERO, corners, 0.1);
    let points: Vec<String> = flat.iter().map(|p| at(center + (x * p.x + y * p.y) * radius)).collect();
    format!("project(polyline([{}], closed: true), onto: s, along: {})", points.join(", "), at(d))
}

/// Loops over seams, round poles and away from both, smooth and spiked, down to holes far smaller than a cell: what is cut out
/// and what is left are the surface again, and so are their meshes; or a reason with its place.
#[test]
fn loops_on_closed_surfaces_part_them_or_say_why() {
    let round = prop_oneof![Just(0.0), -0.3_f64..0.3, 0.0_f64..6.3];
    let up = prop_oneof![Just(1.0), Just(-1.0), Just(0.0), -1.0_f64..1.0];
    let radius = prop_oneof![0.3_f64..1.0, 1.0_f64..30.0];
    let corners = prop_oneof![Just(Vec::new()), proptest::collection::vec(0.3_f64..1.0, 3..9)];
    let shape = (0..CLOSED.len(), round, up, radius, corners, 0..3_usize);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("trims");
    std::fs::create_dir_all(&folder).unwrap();
    check_one_in(10, 8, &shape, |(kind, round, up, radius, corners, settings)| {
        let (surface, closed, steep) = CLOSED[kind];
        let settings = ["size: 40", "size: 30  chord_error: 3", "size: 60  method: quadtree"][settings];
        let mut script = format!("units mm\nsurface s = {surface}\n");
        writeln!(script, "curve e = {}", aimed(round, up * steep, radius, &corners)).unwrap();
        script += "surface rest = trim(s, holes: [e])\nsurface lid = trim(s, outer: e)\n";
        writeln!(script, "mesh m of rest, lid {{ {settings} }}").unwrap();
        script += "check \"parts\": rest.area + lid.area == s.area within 1e-3%\ncheck \"mesh\": m.area == s.area within 15%\n";
        if closed {
            script += "check \"closed\": m.watertight\n";
        }
        let disk = Disk::new(None, Some(&folder), &[], Outputs::Written).unwrap();
        let run = || script::outcome("trim.loft", script.as_bytes(), &[], &disk);
        let outcome = guarded(run).map_err(|bug| TestCaseError::fail(format!("{bug:?}\n{script}")))?;
        let told = outcome.drawn(false, false);
        let reason = !told.contains("E901") && !told.contains("E999") && told.contains("trim.loft:");
        prop_assert!(outcome.report.ok || reason, "{}\n{}", told, script);
        Ok(())
    });
}

/// Loops that come as near to themselves, to a hole or to another loop as a thousandth of their size, and touch or cross a little:
/// on a plane and over a bent surface, by several methods, a mesh with the area of its face or a reason with its place.
#[test]
fn loops_that_nearly_touch_are_meshed_or_say_why() {
    let gap = (-3.0_f64..-1.0).prop_map(|e| 100.0 * libm::pow(10.0, e));
    let gap = prop_oneof![9 => gap.clone(), 1 => gap.prop_map(|g| -g), 1 => Just(0.0)];
    let shape = (gap, 0..5_usize, 20.0_f64..80.0, 4.0_f64..12.0, 0..4_usize, any::<bool>());
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("near");
    std::fs::create_dir_all(&folder).unwrap();
    check_one_in(10, 14, &shape, |(gap, kind, along, radius, settings, bent)| {
        let square = "(0, 0, 0), (100, 0, 0), (100, 60, 0), (0, 60, 0)".to_owned();
        let circle = |x: f64, y: f64| format!("circle(center: ({x:.9}, {y:.9}, 0), radius: {radius:.9})");
        let (outer, holes) = match kind {
            // A slot from one side that ends before the other, and one whose lips nearly close.
            0 => {
                let (a, b) = (along, along + 6.0);
                (
                    format!(
                        "(0, 0, 0), ({a}, 0, 0), ({a}, {}, 0), ({b}, {}, 0), ({b}, 0, 0), (100, 0, 0), (100, 60, 0), (0, 60, 0)",
                        60.0 - gap,
                        60.0 - gap
                    ),
                    vec![],
                )
            }
            1 => {
                let (a, b) = (along, along + gap);
                (format!("(0, 0, 0), ({a}, 0, 0), ({a}, 40, 0), ({b}, 40, 0), ({b}, 0, 0), (100, 0, 0), (100, 60, 0), (0, 60, 0)"), vec![])
            }
            2 => (square, vec![circle(along, radius + gap)]),
            3 => (square, vec![circle(30.0, 30.0), circle(30.0 + 2.0 * radius + gap, 30.0)]),
            // A corner that points at a hole.
            _ => {
                let tip = 30.0 - radius - gap;
                (
                    format!("(0, 0, 0), (40, 0, 0), (50, {tip}, 0), (60, 0, 0), (100, 0, 0), (100, 60, 0), (0, 60, 0)"),
                    vec![circle(50.0, 30.0)],
                )
            }
        };
        let settings = ["size: 10", "size: 25  method: quadtree", "size: 15  elements: mixed", "size: 12  chord_error: 1"][settings];
        let mut script = "units mm\n".to_owned();
        let flat = "let chart_surface = plane(at: (0, 0, 0), normal: (0, 0, 1))\nfn laid(c: curve) = c\n";
        let wave = "let chart_surface = extrude(arc((-10, -10, -5), (-10, 70, -5), through: (-10, 30, 10)), by: (120, 0, 0))\nfn laid(c: curve) = project(c, onto: chart_surface, along: (0, 0, 1))\n";
        script += if bent { wave } else { flat };
        writeln!(script, "curve rim = laid(polyline([{outer}], closed: true))").unwrap();
        let names: Vec<String> = (0..holes.len()).map(|k| format!("hole{k}")).collect();
        for (name, hole) in names.iter().zip(&holes) {
            writeln!(script, "curve {name} = laid({hole})").unwrap();
        }
        writeln!(script, "surface s = trim(chart_surface, outer: rim, holes: [{}])", names.join(", ")).unwrap();
        writeln!(script, "mesh m of s {{ {settings} }}\ncheck \"area\": m.area == s.area within 15%").unwrap();
        let disk = Disk::new(None, Some(&folder), &[], Outputs::Written).unwrap();
        let run = || script::outcome("near.loft", script.as_bytes(), &[], &disk);
        let outcome = guarded(run).map_err(|bug| TestCaseError::fail(format!("{bug:?}\n{script}")))?;
        let told = outcome.drawn(false, false);
        let reason = !told.contains("E901") && !told.contains("E999") && told.contains("near.loft:");
        prop_assert!(outcome.report.ok || reason && gap <= 0.01, "{}\n{}", told, script);
        let wrong = invariants::look(&script, &outcome, &mut [0; 5]);
        prop_assert!(wrong.is_empty(), "{:?}\n{}", wrong, script);
        Ok(())
    });
}

/// Two rings on a ball bound a belt where one runs each way. Where both run the same way the longer one decides, and that is told.
#[test]
fn loops_that_do_not_agree_are_told() {
    let tolerance = Tolerance::new(1e-6, 20.0);
    let half = arc_through(DVec3::new(0.0, 0.0, -10.0), DVec3::new(0.0, 0.0, 10.0), DVec3::new(10.0, 0.0, 0.0), Origin::NONE).unwrap();
    let axis = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let ball = revolve(&Chain::of_curve(&half), &axis, std::f64::consts::TAU, Origin::NONE, &tolerance).unwrap();
    let ring = |z: f64, way: f64| {
        let radius = (100.0 - z * z).sqrt();
        vec![Chain::of_curve(&circle(DVec3::new(0.0, 0.0, z), radius, DVec3::Z * way, Origin::NONE).unwrap())]
    };
    let known = Outlined { has_outer: true, inside: None, against: false };
    let made = |loops: [Vec<Chain>; 2]| outlined(&ball, &loops, known, Origin::NONE, &tolerance).unwrap();
    let (belt, doubts) = made([ring(-3.0, 1.0), ring(6.0, -1.0)]);
    assert!(doubts.is_empty() && belt.len() == 1, "{doubts:?}");
    let (_, doubts) = made([ring(-3.0, 1.0), ring(6.0, 1.0)]);
    let [one] = doubts[..] else { panic!("{doubts:?}") };
    assert!(one.by == Speaks::Directions && one.share > 0.5 && one.share < 0.6, "{one:?}");
    assert!((one.at.length() - 10.0).abs() < 1e-6, "{one:?}");
}

/// What `split` and `trim(by:)` ask of their parts. No script is known whose parts fail it, so the question itself is tested.
#[test]
fn parts_that_do_not_add_up_are_told() {
    let tolerance = Tolerance::new(1e-3, 10.0);
    let side = Chain::of_curve(&line(DVec3::ZERO, DVec3::X * 10.0, Origin::NONE).unwrap());
    let square = extrude(&side, DVec3::Y * 10.0, Origin::NONE, &tolerance).unwrap();
    let cut = Chain::of_curve(&line(DVec3::new(0.0, 4.0, 0.0), DVec3::new(10.0, 4.0, 0.0), Origin::NONE).unwrap());
    let told = |parts: &[f64]| {
        measure::adds_up(&square, std::slice::from_ref(&cut), &parts.iter().map(|area| (*area, 0.0)).collect::<Vec<_>>(), &tolerance)
            .map_err(|fault| fault.code().0)
    };
    assert_eq!(told(&[40.0, 60.0]), Ok(()));
    // A strip as wide as the tolerance along the cut may be missing, or be in both parts.
    assert_eq!((told(&[40.0, 59.991]), told(&[40.009, 60.0])), (Ok(()), Ok(())));
    assert_eq!((told(&[40.0, 59.9]), told(&[40.0, 60.1]), told(&[60.0])), (Err("E721"), Err("E721"), Err("E721")));
}
