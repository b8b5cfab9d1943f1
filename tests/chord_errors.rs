//! Chord errors that are asked for are kept, by the distances of triangles and not by what the mesher tells.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use lofting::base::tolerance::Tolerance;
use lofting::mesh::Mesh;
use lofting::session::disk::{Disk, Outputs};
use lofting::surface::closest;

use crate::support::long::count;
use crate::support::random::Random;
use crate::support::script;

fn mesh(text: &str) -> Arc<Mesh> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let disk = Disk::new(None, Some(folder), &[], Outputs::Counted).unwrap();
    let outcome = script::outcome("m.loft", text.as_bytes(), &[], &disk);
    assert!(outcome.report.ok, "{}\n{}", outcome.drawn(false, false), &text[..text.len().min(400)]);
    outcome.meshes.into_iter().next().unwrap().1
}

/// Distance of a triangle from the origin.
fn distance(t: [DVec3; 3]) -> f64 {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize_or_zero();
    let under = normal * normal.dot(t[0]);
    let is_inside = (0..3).all(|k| (t[(k + 1) % 3] - t[k]).cross(under - t[k]).dot(normal) >= 0.0);
    let side = |k: usize| {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        let share = -a.dot(b - a) / (b - a).length_squared();
        a.lerp(b, share.clamp(0.0, 1.0)).length()
    };
    if is_inside && normal != DVec3::ZERO { under.length() } else { side(0).min(side(1)).min(side(2)) }
}

#[test]
fn triangles_at_poles_keep_the_chord_error() {
    let slanted = "trim(ball, by: plane(at: (0, 0, 30), normal: (0.5, 0.2, 1)), keep: (0, 0, 50))";
    let level = "trim(ball, by: plane(at: (0, 0, 35), normal: (0, 0, 1)), keep: (0, 0, 50))";
    let large = "trim(ball, by: plane(at: (5, 0, -20), normal: (0.2, 0.5, 1)), keep: (0, 0, 50))";
    for (part, limit) in [(slanted, 2.0), (level, 0.3), (large, 0.1), (large, 0.05), ("ball", 0.1)] {
        let mesh = mesh(&format!(
            "units mm\nsurface ball = revolve(arc((0, 0, -50), (0, 0, 50), through: (50, 0, 0)))\nsurface part = {part}
mesh m of part {{ chord_error: {limit}  method: display }}"
        ));
        let nearest = mesh.triangles.iter().map(|t| distance(t.map(|n| mesh.nodes[n as usize]))).fold(50.0, f64::min);
        assert!(50.0 - nearest <= limit * (1.0 + 1e-9), "{part}: {} of {limit}", 50.0 - nearest);
    }
}

/// Distance of a point from the profile of a bent sheet: along x, round a corner of radius 0.3 at (20, 0), along y.
fn from_bend(p: DVec3) -> f64 {
    let (r, middle) = (0.3, DVec3::new(19.7, 0.3, p.z));
    if p.x > middle.x && p.y < middle.y {
        (p.distance(middle) - r).abs()
    } else {
        let along_x = (p.x - p.x.clamp(0.0, middle.x)).abs().max(p.y.abs());
        along_x.min((p.x - 20.0).abs().max((p.y - p.y.clamp(middle.y, 15.0)).abs()))
    }
}

#[test]
fn triangles_that_stand_on_edge_beside_a_fillet_keep_the_chord_error() {
    let places = (0..=12).flat_map(|i| (0..=12 - i).map(move |j| (f64::from(i) / 12.0, f64::from(j) / 12.0)));
    for limit in [0.3, 0.1, 0.03, 0.01, 0.003] {
        let mesh = mesh(&format!(
            "units mm\ncurve bend = fillet(polyline([(0, 0, 0), (20, 0, 0), (20, 15, 0)]), radius: 0.3mm)
surface sheet = extrude(bend, by: (0, 0, 40))
surface bore = extrude(circle(center: (16, -10, 20), radius: 6, normal: (0, 1, 0)), by: (0, 40, 0))
mesh m of trim(sheet, by: bore, keep: (1, 0, 1)) {{ chord_error: {limit}  method: display }}"
        ));
        let corners = mesh.triangles.iter().map(|t| t.map(|n| mesh.nodes[n as usize]));
        let points = corners.flat_map(|t| places.clone().map(move |(i, j)| t[0] + (t[1] - t[0]) * i + (t[2] - t[0]) * j));
        let is = points.map(from_bend).fold(0.0, f64::max);
        assert!(is <= limit * (1.0 + 1e-9), "{is} of {limit}");
    }
}

#[test]
fn reported_chord_errors_are_nearly_the_largest_distances() {
    for settings in ["size: 12", "size: 12  method: delaunay", "chord_error: 1", "size: 20  method: delaunay", "size: 9  method: mapped"] {
        let mesh = mesh(&format!(
            "units mm\nsurface ball = revolve(arc((0, 0, -50), (0, 0, 50), through: (50, 0, 0)))\nmesh m of ball {{ {settings} }}"
        ));
        let nearest = mesh.triangles.iter().map(|t| distance(t.map(|n| mesh.nodes[n as usize]))).fold(50.0, f64::min);
        let (is, reported) = (50.0 - nearest, mesh.chord_error(&Tolerance::new(1e-6, 100.0)).unwrap());
        assert!((is - reported).abs() <= 0.006 * is, "{settings}: {is}, reported {reported}");
    }
}

/// A square of 100 × 100 with one hill that is highest at (30, 64), as a Bézier surface whose x and y are 100 u and 100 v.
const HILL: &str = "units mm
let net = [for j in 0..7: [for i in 0..7: (100 * i / 6, 100 * j / 6, 40 * exp(0 - ((i - 1.8)^2 + (j - 3.9)^2)))]]
surface hill = bezier_surface(net)";

/// Triangles, of quads their halves, as they are measured.
fn halves(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    let node = |n: u32| mesh.nodes[n as usize];
    let quads = mesh.quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    mesh.triangles.iter().copied().chain(quads).map(|t| t.map(node)).collect()
}

#[test]
fn no_point_of_a_triangle_is_farther_than_the_reported_chord_error() {
    let settings = ["size: 3  method: mapped", "size: 3  elements: quads", "size: 3  method: delaunay", "chord_error: 0.1"];
    for settings in settings {
        let mesh = mesh(&format!("{HILL}\nmesh m of hill {{ {settings} }}"));
        let surface = &mesh.geometries.0[0].surface;
        let reported = mesh.chord_error(&Tolerance::new(1e-6, 100.0)).unwrap();
        let mut most = 0.0_f64;
        for t in halves(&mesh) {
            for (i, j) in (0..=6).flat_map(|i| (0..=6 - i).map(move |j| (f64::from(i) / 6.0, f64::from(j) / 6.0))) {
                let p = t[0] + (t[1] - t[0]) * i + (t[2] - t[0]) * j;
                // What is off upwards is more than the distance.
                if (surface.point(p.x / 100.0, p.y / 100.0).z - p.z).abs() > 0.98 * reported {
                    most = most.max(closest(surface, p).distance);
                }
            }
        }
        assert!(most <= reported * (1.0 + 1e-9), "{settings}: {most}, reported {reported}");
        assert!(most >= 0.95 * reported, "{settings}: {most}, reported {reported}");
    }
}

/// A body of revolution with a waist: without flips beside the seam cells are cut until the work limit is reached.
#[test]
fn a_waist_is_meshed_between_isolines() {
    let mesh = mesh(
        "units mm\nsurface s = revolve(spline([(0, 0, -50), (30, 0, -20), (3, 0, 0), (40, 0, 30), (0, 0, 50)]), axis: line((0, 0, 0), (0, 0, 1)))
mesh m of s { size: 2000  method: isoline  angle_error: 20deg }",
    );
    assert!((500..2000).contains(&mesh.nodes.len()), "{} nodes", mesh.nodes.len());
}

/// A spline through seven points that wave by up to `high` about the line from (0, y, 0) to (100, y, 0).
fn wave(random: &mut Random, y: f64, high: f64) -> String {
    let points: Vec<String> = (0..7)
        .map(|k| {
            let off = [0, 1].map(|_| high * (2.0 * random.share() - 1.0));
            let along = if k % 6 == 0 { 0.0 } else { 4.0 * random.share() };
            format!("({}, {}, {})", 100.0 / 6.0 * f64::from(k) + along, y + 0.3 * off[0], off[1])
        })
        .collect();
    format!("spline([{}])", points.join(", "))
}

/// Every method makes a mesh of steep waves that keeps its limit.
#[test]
fn steep_waves_keep_the_chord_error_by_every_method() {
    for seed in 0..count("LOFT_WAVES", 2, 8) as u64 {
        let mut random = Random(seed);
        let high = [4.0, 10.0, 25.0][seed as usize % 3];
        let limit = [0.1, 0.3][seed as usize / 3 % 2];
        let [a, b, c] = [0.0, 30.0, 60.0].map(|y| wave(&mut random, y, high));
        let surface = if seed % 2 == 0 { format!("ruled({a}, {c})") } else { format!("skin([{a}, {b}, {c}])") };
        for method in ["auto", "delaunay", "mapped", "isoline", "display"] {
            let text = format!("units mm\nsurface s = {surface}\nmesh m of s {{ size: 20  method: {method}  chord_error: {limit} }}");
            let mesh = mesh(&text);
            let (reported, surface) = (mesh.chord_error(&Tolerance::new(1e-6, 100.0)).unwrap(), &mesh.geometries.0[0].surface);
            assert!(reported <= limit, "seed {seed}, {method}: {reported} of {limit}");
            let middles = halves(&mesh).into_iter().step_by(7).map(|t| (t[0] + t[1] + t[2]) / 3.0);
            let farthest = middles.map(|p| closest(surface, p).distance).fold(0.0, f64::max);
            assert!(farthest <= reported * (1.0 + 1e-9), "seed {seed}, {method}: {farthest}, reported {reported}");
        }
    }
}
