//! Quads on faces that no map fits: only quads, conforming, none turned over, within their limits; or an error that says where.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use glam::DVec3;
use lofting::mesh::Mesh;
use lofting::mesh::data::quality::of_element;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::run::Outcome;

use crate::support::{invariants, script};

const PLATE: &str = "units mm
curve rim = polyline([(0, 0), (20, 0), (20, 10), (0, 10)], closed: true)
curve hole for k in 0..2 = circle(center: (5 + 9 * k, 5, 0), radius: 2mm)
surface plate = trim(plane(rim), holes: hole)
";

fn outcome(text: &str) -> Outcome {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    script::outcome("m.loft", text.as_bytes(), &[], &Disk::new(None, Some(folder), &[], Outputs::Written).unwrap())
}

fn meshes(text: &str) -> Vec<Arc<Mesh>> {
    let outcome = outcome(text);
    assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
    outcome.meshes.into_iter().map(|m| m.1).collect()
}

fn mesh(text: &str) -> Arc<Mesh> {
    meshes(text).remove(0)
}

fn refused(text: &str) -> String {
    let outcome = outcome(text);
    assert!(!outcome.report.ok);
    outcome.drawn(false, false)
}

/// Conforming and right side up all over; gives its Euler number.
fn sound(mesh: &Mesh, least: f64) -> i64 {
    let edges = invariants::edges(mesh);
    let mut used = vec![false; mesh.nodes.len()];
    for face in mesh.quads.iter().map(|q| q.as_slice()).chain(mesh.triangles.iter().map(|t| t.as_slice())) {
        let corners: Vec<DVec3> = face.iter().map(|n| mesh.nodes[*n as usize]).collect();
        let quality = of_element(&corners);
        assert!(quality > least, "{}: quality {quality} at {}", mesh.name, corners[0]);
        face.iter().for_each(|n| used[*n as usize] = true);
    }
    assert!(used.iter().all(|u| *u), "{}: a node of no element", mesh.name);
    used.len() as i64 - edges.len() as i64 + (mesh.quads.len() + mesh.triangles.len()) as i64
}

/// Only quads, of at least a quality and of an Euler number.
fn all_quads(mesh: &Mesh, least: f64, euler: i64) {
    assert!(mesh.triangles.is_empty() && !mesh.quads.is_empty(), "{}", mesh.triangles.len());
    assert_eq!(sound(mesh, least), euler, "{}", mesh.name);
}

fn longest(mesh: &Mesh) -> f64 {
    let side = |q: &[u32; 4], k: usize| mesh.nodes[q[k] as usize].distance(mesh.nodes[q[(k + 1) % 4] as usize]);
    mesh.quads.iter().flat_map(|q| (0..4).map(move |k| side(q, k))).fold(0.0, f64::max)
}

#[test]
fn a_plate_with_holes() {
    let fine = mesh(&format!("{PLATE}mesh fine of plate {{ size: 0.5mm  elements: quads }}"));
    all_quads(&fine, 0.6, -1);
    let quality = fine.quality().unwrap();
    assert!(quality.mean_quality > 0.95, "{}", quality.mean_quality);
    assert!(longest(&fine) <= 1.05 * 0.5 * (1.0 + 1e-9), "{}", longest(&fine));
    for (center, radius) in [(5.0, 2.0), (14.0, 2.0)] {
        let on = |p: &&DVec3| (p.distance(DVec3::new(center, 5.0, 0.0)) - radius).abs() < 1e-9;
        assert!(fine.nodes.iter().filter(on).count() >= 26);
    }
}

#[test]
fn poles_and_seams() {
    let turned = "units mm
let axis = line((0, 0, 0), (0, 0, 2))
curve slope = line((0, 0, 1), (1, 0, 0))
surface cone = revolve(slope, axis: axis)
curve half = arc(center: (0, 0, 0), start: (0, 0, -1), angle: 180deg, normal: (0, -1, 0))
surface ball = revolve(half, axis: axis)
curve ring = circle(center: (3, 0, 0), radius: 1mm, normal: (0, 1, 0))
surface torus = revolve(ring, axis: axis)
";
    let settings = "{ size: 0.3mm  elements: quads  method: delaunay }";
    let made = meshes(&format!("{turned}mesh a of cone {settings}\nmesh b of ball {settings}\nmesh c of torus {settings}"));
    for (mesh, euler) in made.iter().zip([1, 2, 0]) {
        all_quads(mesh, 0.4, euler);
        assert_eq!(mesh.is_watertight(), euler != 1, "{}", mesh.name);
        assert!(longest(mesh) <= 1.05 * 0.3 * (1.0 + 1e-9), "{}: {}", mesh.name, longest(mesh));
    }
}

#[test]
fn limits_on_a_trimmed_dome() {
    let dome = "units mm
surface dome = bezier_surface([
  [(0, 0, 0), (40, 0, 25), (80, 0, 25), (120, 0, 0)],
  [(0, 40, 25), (40, 40, 75), (80, 40, 75), (120, 40, 25)],
  [(0, 80, 25), (40, 80, 75), (80, 80, 75), (120, 80, 25)],
  [(0, 120, 0), (40, 120, 25), (80, 120, 25), (120, 120, 0)]
])
curve eye = project(circle(center: (50, 50, 80), radius: 18mm), onto: dome, along: (0, 0, 1))
surface top = trim(dome, holes: [eye])
mesh a of top { size: 60mm  chord_error: 0.5mm  elements: quads }
mesh b of top { size: 60mm  chord_error: 0.1mm  elements: quads }
mesh c of top { size: 60mm  angle_error: 15deg  elements: quads }
";
    let outcome = outcome(dome);
    assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
    let error = |k: usize| outcome.report.meshes[k].chord_error.unwrap();
    assert!(error(0) <= 0.5 && error(1) <= 0.1, "{} {}", error(0), error(1));
    outcome.meshes.iter().for_each(|m| all_quads(&m.1, 0.3, 0));
    assert!(outcome.meshes[0].1.quads.len() < outcome.meshes[1].1.quads.len());
}

#[test]
fn mapped_neighbours_take_even_counts() {
    let text = "units mm
let a = line((0, 0, 0), (10, 0, 0))
curve rim = polyline([(0, 0), (10, 0), (10, 6), (0, 6)], closed: true)
curve hole = circle(center: (5, 3, 0), radius: 1.5mm)
surface floor = trim(plane(rim), holes: [hole])
surface wall = extrude(rim[..10mm], (0, 0, 4))
mesh m of floor, wall { size: 0.95mm  elements: quads }
mesh n of floor, wall { size: 0.95mm  elements: quads  on hole { count: 14 } }
";
    for mesh in meshes(text) {
        all_quads(&mesh, 0.3, 0);
        let on = mesh.nodes.iter().filter(|p| p.z == 0.0 && p.y == 0.0).count();
        assert_eq!(on % 2, 1, "{on} nodes on the common edge");
    }
}

#[test]
fn curves_and_points_inside_stay() {
    let text = format!(
        "{PLATE}curve rib = line((0, 3.2mm, 0), (20, 1.1mm, 0))
point bolt = (9.3mm, 7.1mm, 0)
mesh m of plate, rib, bolt {{ size: 0.8mm  elements: quads }}"
    );
    let fine = mesh(&text);
    all_quads(&fine, 0.2, -1);
    assert!(fine.nodes.iter().any(|p| p.distance(DVec3::new(9.3, 7.1, 0.0)) < 1e-9));
    assert!(!fine.lines.is_empty());
    for [a, b] in &fine.lines {
        let side = |q: &[u32; 4]| (0..4).any(|k| [q[k], q[(k + 1) % 4]] == [*a, *b] || [q[(k + 1) % 4], q[k]] == [*a, *b]);
        assert_eq!(fine.quads.iter().filter(|q| side(q)).count(), 2);
    }
}

#[test]
fn mixed_leaves_triangles_where_pairs_are_bad() {
    for method in ["delaunay", "quadtree"] {
        let fine = mesh(&format!("{PLATE}mesh fine of plate {{ size: 0.5mm  elements: mixed  method: {method} }}"));
        assert_eq!(sound(&fine, 0.3), -1);
        assert!(fine.quads.len() > 8 * fine.triangles.len(), "{method}: {} {}", fine.quads.len(), fine.triangles.len());
    }
}

#[test]
fn second_order_lies_on_the_surface() {
    let text = "units mm
let axis = line((0, 0, 0), (0, 0, 2))
curve half = arc(center: (0, 0, 0), start: (0, 0, -1), angle: 180deg, normal: (0, -1, 0))
surface ball = revolve(half, axis: axis)
mesh m of ball { size: 0.3mm  elements: quads  order: 2  method: delaunay }
";
    let fine = mesh(text);
    assert_eq!(fine.quad_mids.len(), fine.quads.len());
    assert!(fine.nodes.iter().all(|p| (p.length() - 1.0).abs() < 1e-9));
    for (quad, mids) in fine.quads.iter().zip(&fine.quad_mids) {
        for k in 0..4 {
            let [a, b, m] = [quad[k], quad[(k + 1) % 4], mids[k]].map(|n| fine.nodes[n as usize]);
            assert!(m.distance(0.5 * (a + b)) < 0.2 * a.distance(b), "{m} between {a} and {b}");
        }
    }
}

#[test]
fn quadtrees_and_growing_sizes() {
    let grown = format!("{PLATE}mesh m of plate {{ size: 1.5mm  elements: quads  near (0, 0, 0) {{ size: 0.1mm  radius: 0.5mm }} }}");
    all_quads(&mesh(&grown), 0.3, -1);
    let tree = format!("{PLATE}mesh m of plate {{ size: 1mm  elements: quads  method: quadtree }}");
    all_quads(&mesh(&tree), 0.2, -1);
}

#[test]
fn what_cannot_be_is_said_with_its_place() {
    let odd = format!(
        "{PLATE}mesh m of plate {{ size: 1mm  elements: quads  on rim {{ count: 60 }}  on hole[0] {{ count: 13 }}  on hole[1] {{ count: 14 }} }}"
    );
    let said = refused(&odd);
    assert!(said.contains("E704") && said.contains("13 elements") && said.contains("count: 14"), "{said}");
    let few = format!("{PLATE}mesh m of plate {{ size: 1mm  elements: quads  on hole[0] {{ count: 4 }} }}");
    let said = refused(&few);
    assert!(said.contains("E703") && said.contains("count: 5"), "{said}");
    let shown = format!("{PLATE}mesh m of plate {{ size: 1mm  elements: quads  method: display }}");
    let said = refused(&shown);
    assert!(said.contains("E704") && said.contains("method: display"), "{said}");
}

#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("quads-threads");
    std::fs::create_dir_all(&folder).unwrap();
    let script = folder.join("m.loft");
    let text = "mesh m of plate { size: 0.6mm  elements: quads }\nmesh b of plate { size: 0.7mm  elements: mixed }\nexport m to \"m.vtu\"\nexport b to \"b.vtu\"\n";
    std::fs::write(&script, format!("{PLATE}{text}")).unwrap();
    let mut known = None;
    for threads in ["1", "2", "8"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_loft"));
        let done = command.args(["run", "--threads", threads]).arg(&script).arg("-o").arg(&folder).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let found = ["m.vtu", "b.vtu"].map(|name| std::fs::read(folder.join(name)).unwrap());
        assert!(*known.get_or_insert_with(|| found.clone()) == found, "{threads} threads make another file");
    }
}

const BOX: &str = "units mm
curve s = line((0, 0), (20, 0))
curve e = line((20, 0), (20, 10))
curve n = line((20, 10), (0, 10))
curve w = line((0, 10), (0, 0))
curve eye = circle(center: (10, 5, 0), radius: 2mm)
surface p = trim(plane([s, e, n, w]), holes: [eye])
";

/// Counts that are odd are kept on whatever loops they are; where the written ones are odd in all, another becomes odd.
#[test]
fn odd_counts() {
    for (counts, steps) in [
        ("on s { count: 15 }  on n { count: 17 }", vec![(0.0, 15), (10.0, 17)]),
        ("on s { count: 15 }  on e { count: 9 }  on n { count: 13 }  on w { count: 7 }", vec![(0.0, 15), (10.0, 13)]),
        // Beside each other; on two loops; alone.
        ("on s { count: 21 }  on e { count: 11 }", vec![(0.0, 21)]),
        ("on s { count: 15 }  on eye { count: 17 }", vec![(0.0, 15)]),
        ("on s { count: 21 }  on e { count: 11 }  on eye { count: 17 }  on n { count: 27 }", vec![(0.0, 21), (10.0, 27)]),
        ("on eye { count: 13 }", vec![]),
    ] {
        let mesh = mesh(&format!("{BOX}mesh a of p {{ size: 1mm  elements: quads  {counts} }}"));
        all_quads(&mesh, 0.6, 0);
        assert!(mesh.quads.len() < 350 && longest(&mesh) < 1.26 * 10.0 / 7.0, "{counts}: {}", mesh.quads.len());
        for (y, n) in steps {
            assert_eq!(mesh.nodes.iter().filter(|p| p.y == y).count(), n + 1, "{counts}");
        }
        if counts.contains("eye") {
            let n = if counts.contains("17") { 17 } else { 13 };
            let on = |p: &&DVec3| (p.distance(DVec3::new(10.0, 5.0, 0.0)) - 2.0).abs() < 1e-9;
            assert_eq!(mesh.nodes.iter().filter(on).count(), n, "{counts}");
        }
    }
    let all = "on s { count: 15 }  on n { count: 20 }  on e { count: 10 }  on w { count: 10 }  on eye { count: 16 }";
    let told = refused(&format!("{BOX}mesh a of p {{ size: 1mm  elements: quads  {all} }}"));
    assert!(told.contains("E704") && told.contains("count: 16"), "{told}");
}

/// A line inside that parts odd counts from each other is told; one that is odd itself is crossed.
#[test]
fn odd_counts_and_lines_inside() {
    let ring = format!("{BOX}curve ring = circle(center: (10, 5, 0), radius: 3.5mm)\n");
    let told = refused(&format!("{ring}mesh a of p, ring {{ size: 1mm  elements: quads  on s {{ count: 21 }}  on eye {{ count: 13 }} }}"));
    assert!(told.contains("E704"), "{told}");
    let odd = "on s { count: 21 }  on ring { count: 23 }  on eye { count: 13 }";
    all_quads(&mesh(&format!("{ring}mesh a of p, ring {{ size: 1mm  elements: quads  {odd} }}")), 0.3, 0);
}

/// A sharp corner, and cells that are triangles there.
#[test]
fn odd_counts_of_a_slender_triangle() {
    let triangle = "units mm
curve a = line((0, 0, 0), (20, 2, 0))
curve b = line((20, 2, 0), (5, 9, 0))
curve c = line((5, 9, 0), (0, 0, 0))
surface p = trim(plane([a, b, c]), holes: [])
";
    for (x, y, z) in [(20, 15, 11), (21, 16, 11), (21, 17, 10), (13, 17, 12), (25, 25, 14)] {
        let counts = format!("on a {{ count: {x} }}  on b {{ count: {y} }}  on c {{ count: {z} }}");
        all_quads(&mesh(&format!("{triangle}mesh m of p {{ size: 1.2mm  elements: quads  {counts} }}")), 0.2, 1);
    }
}

/// A written count with steps twice as long as the size takes longer sides beside it, not thousands of quads or an error.
#[test]
fn coarse_written_counts_are_left_step_by_step() {
    for (s, e) in [(8, 10), (10, 8), (9, 11), (11, 7), (31, 5)] {
        let counts = format!("on s {{ count: {s} }}  on e {{ count: {e} }}");
        let mesh = mesh(&format!(
            "{BOX}surface b = plane([s, e, n, w])\nmesh a of b {{ size: 1mm  elements: quads  method: delaunay  {counts} }}"
        ));
        all_quads(&mesh, 0.5, 1);
        assert!(mesh.quads.len() < 400, "{counts}: {}", mesh.quads.len());
        let step = (20.0 / f64::from(s)).max(10.0 / f64::from(e));
        assert!(longest(&mesh) <= 1.2 * 1.05 * step, "{counts}: {}", longest(&mesh));
        // Away from them the size holds.
        for q in &mesh.quads {
            for k in 0..4 {
                let [a, b] = [q[k], q[(k + 1) % 4]].map(|n| mesh.nodes[n as usize]);
                let away = a.y.min(20.0 - a.x).max(b.y.min(20.0 - b.x));
                let most = 1.05 * f64::max(1.0, step) - 0.3 * (away - 1e-9);
                assert!(a.distance(b) <= 1.2 * most.max(1.05), "{counts}: {} at {a}", a.distance(b));
            }
        }
    }
}
