//! Borders that face each other over less than the size: no angle is small that the geometry does not make so, no divided
//! border crosses another one, and few elements more are taken for it.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use lofting::mesh::Mesh;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::run::Outcome;

use crate::support::script;

fn outcome(text: &str) -> Outcome {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    script::outcome("m.loft", text.as_bytes(), &[], &Disk::new(None, Some(folder), &[], Outputs::Written).unwrap())
}

fn mesh(text: &str) -> Arc<Mesh> {
    let outcome = outcome(text);
    assert!(outcome.report.ok, "{}\n{text}", outcome.drawn(false, false));
    outcome.meshes.into_iter().next().unwrap().1
}

const CRESCENT: &str = "curve rim = circle(center: (0, 0, 0), radius: 10)
curve eye = circle(center: (5.9, 0, 0), radius: 4)
surface face = trim(plane(rim), holes: [eye])";
const RING: &str = "curve rim = circle(center: (0, 0, 0), radius: 100)
curve eye = circle(center: (0, 0, 0), radius: 98)
surface face = trim(plane(rim), holes: [eye])";
const NEAR_SIDE: &str = "curve rim = polyline([(0, 0), (100, 0), (100, 50), (0, 50)], closed: true)
curve eye = circle(center: (30, 15.2, 0), radius: 15)
surface face = trim(plane(rim), holes: [eye])";
const ON_A_CYLINDER: &str = "surface tube = extrude(circle(center: (0, 0, 0), radius: 20), by: (0, 0, 30))
curve eye = project(circle(center: (40, 0, 7.3), radius: 7, normal: (1, 0, 0)), onto: tube, along: (1, 0, 0))
surface face = trim(tube, holes: [eye])";

const ALMOST: &str = "curve rim = polyline([(0, 0), (100, 0), (100, 60), (0, 60)], closed: true)
curve eye = polyline([(26.6, 0.006), (33.4, 6.8), (23.2, 13.7)], closed: true)
surface face = trim(plane(rim), holes: [eye])";

/// Script, settings, least angle (degrees), most elements.
const CASES: [(&str, &str, f64, usize); 12] = [
    (CRESCENT, "size: 1mm", 20.0, 1000),
    (CRESCENT, "size: 4mm", 20.0, 150),
    (CRESCENT, "size: 1mm  elements: quads", 45.0, 600),
    (CRESCENT, "size: 4mm  elements: quads", 39.0, 130),
    // Steps of the size cross here.
    (RING, "size: 50mm", 20.0, 400),
    (RING, "size: 50mm  elements: quads", 25.0, 500),
    (RING, "size: 20mm  elements: mixed", 20.0, 500),
    (NEAR_SIDE, "size: 5mm", 20.0, 800),
    (NEAR_SIDE, "size: 5mm  method: quadtree", 20.0, 1200),
    (ALMOST, "size: 60mm", 20.0, 500),
    (ALMOST, "size: 5mm  method: quadtree", 20.0, 3000),
    (ON_A_CYLINDER, "size: 4mm  chord_error: 0.1mm", 18.0, 2000),
];

#[test]
fn gaps_are_filled_well() {
    for (script, settings, angle, most) in CASES {
        let mesh = mesh(&format!("units mm\n{script}\nmesh m of face {{ {settings} }}\n"));
        let least = mesh.quality().unwrap().min_angle.to_degrees();
        let elements = mesh.triangles.len() + mesh.quads.len();
        assert!(least >= angle && elements <= most, "{settings}: {least} degrees, {elements} elements\n{script}");
    }
}

/// What `min_size` leaves of it, and what is written, holds.
#[test]
fn floors_and_counts_are_kept() {
    let coarse = mesh(&format!("units mm\n{NEAR_SIDE}\nmesh m of face {{ size: 5mm  min_size: 2mm }}\n"));
    let fine = mesh(&format!("units mm\n{NEAR_SIDE}\nmesh m of face {{ size: 5mm }}\n"));
    assert!(coarse.triangles.len() < fine.triangles.len());
    let counted = format!("units mm\n{RING}\nmesh m of face {{ size: 50mm  on rim {{ count: 60 }} }}\n");
    let mesh = mesh(&counted);
    let on = |radius: f64| mesh.nodes.iter().filter(|p| (p.length() - radius).abs() < 1e-9).count();
    assert!(on(100.0) == 60 && on(98.0) > 6, "{} and {}", on(100.0), on(98.0));
    let told = outcome(&format!("units mm\n{RING}\nmesh m of face {{ on rim {{ count: 5 }}  on eye {{ count: 60 }} }}\n"));
    assert!(!told.report.ok && told.drawn(false, false).contains("E713"));
}

#[test]
fn what_decides_is_told() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("narrow.loft");
    std::fs::write(&file, format!("units mm\n{NEAR_SIDE}\nmesh m of face {{ size: 5mm }}\n")).unwrap();
    let told = Command::new(env!("CARGO_BIN_EXE_loft")).arg("explain").arg(&file).arg("m").output().unwrap();
    let lines = String::from_utf8(told.stdout).unwrap();
    assert!(lines.contains("by the border facing it"), "{lines}");
}

/// Where the geometry makes an angle small, it is told what does.
#[test]
fn small_angles_have_their_reasons() {
    let sliver = "curve rim = polyline([(0, 0), (10, 0), (10, 5), (5, 5), (4.99, 5.002), (0, 5)], closed: true)
surface face = trim(plane(rim), holes: [])";
    let wedge = "curve rim = polyline([(0, 0), (10, 0), (9, 0.5)], closed: true)\nsurface face = trim(plane(rim), holes: [])";
    for (script, settings, reason) in [
        (wedge, "size: 1mm", "in a corner of the border of 3.18°"),
        (sliver, "size: 1mm  on face { count: 6 }", "a piece of the border of 0.0102"),
        (NEAR_SIDE, "size: 5mm  on rim { count: 60 }", "by a written count"),
        (NEAR_SIDE, "size: 5mm  min_size: 4mm", "that is not made less than 4"),
    ] {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("blamed.loft");
        std::fs::write(&file, format!("units mm\n{script}\nmesh m of face {{ {settings} }}\n")).unwrap();
        let told = Command::new(env!("CARGO_BIN_EXE_loft")).arg("explain").arg(&file).arg("m").output().unwrap();
        let lines = String::from_utf8(told.stdout).unwrap();
        assert!(lines.contains("; least angle ") && lines.contains(reason), "{settings}: {lines}");
    }
}

/// A side with a piece of 0.01 between the corners of its neighbours.
const SHORT_PIECE: &str = "surface a = ruled(line((0, 0, 0), (100, 0, 0)), line((0, 50, 0), (100, 50, 0)))
surface b = ruled(line((0, 0, 0), (40, 0, 0)), line((0, 0, 20), (40, 0, 20)))
surface c = ruled(line((40.01, 0, 0), (100, 0, 0)), line((40.01, 0, -20), (100, 0, -20)))
shell all of [a, b, c]";
/// A free face with a cut corner of 0.07 at the end of a mapped one.
const CUT_CORNER: &str = "surface a = extrude(line((0, 0, 0), (100, 0, 0)), by: (0, 0, 30))
surface top = trim(plane(polyline([(0, 0), (100, 0), (100.05, 0.05), (100.05, 60), (0, 60)], closed: true)), holes: [])
shell all of [a, top]";
/// A free face with a hole 0.1 from the side of a mapped one.
const NEAR_ROWS: &str = "surface a = extrude(line((0, 0, 0), (100, 0, 0)), by: (0, 0, 30))
curve eye = circle(center: (50, 10.1, 0), radius: 10)
surface top = trim(plane(polyline([(0, 0), (100, 0), (100, 60), (0, 60)], closed: true)), holes: [eye])
shell all of [a, top]";

/// Rows give way where they would be as narrow as a short piece, or keep a free face from short steps; where they are written,
/// and where they are of quads, they do not.
#[test]
fn rows_give_way() {
    for (script, angle, most) in [(SHORT_PIECE, 29.5, 1700), (CUT_CORNER, 35.0, 1700), (NEAR_ROWS, 28.0, 1500)] {
        let free = mesh(&format!("units mm\n{script}\nmesh m of all {{ size: 5mm }}\n"));
        let least = free.quality().unwrap().min_angle.to_degrees();
        assert!(least >= angle && free.triangles.len() <= most, "{least} degrees, {} triangles\n{script}", free.triangles.len());
        for settings in ["on a { method: mapped }", "on a { count: 20 }"] {
            let rows = mesh(&format!("units mm\n{script}\nmesh m of all {{ size: 5mm  {settings} }}\n"));
            let least = rows.quality().unwrap().min_angle.to_degrees();
            assert!(least < 10.0, "{settings}: {least} degrees\n{script}");
        }
    }
    let quads = mesh(&format!("units mm\n{SHORT_PIECE}\nmesh m of all {{ size: 5mm  elements: quads }}\n"));
    assert!(quads.triangles.is_empty() && quads.quads.len() < 400, "{} quads", quads.quads.len());
}

/// Lines of a cone run together at its tip: cells there are as few as anywhere, and no triangle lies along a line.
#[test]
fn cells_at_the_tip_of_a_cone() {
    let cone = "surface cone = revolve(line((20, 0, 0), (0, 0, 30)), axis: (0, 0, 1))";
    // Settings, least angle (degrees), most triangles.
    for (settings, angle, most) in [
        ("size: 3mm  method: isoline  chord_error: 0.1mm", 5.0, 1000),
        ("size: 5mm  method: isoline  chord_error: 0.1mm", 3.0, 550),
        ("size: 3mm  method: isoline  chord_error: 0.05mm", 3.0, 1200),
        ("size: 30mm  method: display  chord_error: 0.02mm", 0.5, 250),
    ] {
        let outcome = outcome(&format!("units mm\n{cone}\nmesh m of cone {{ {settings} }}\n"));
        assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
        let mesh = &outcome.meshes[0].1;
        let least = mesh.quality().unwrap().min_angle.to_degrees();
        assert!(least >= angle && mesh.triangles.len() <= most, "{settings}: {least} degrees, {} triangles", mesh.triangles.len());
        let limit: f64 = settings.split("chord_error: ").nth(1).unwrap().trim_end_matches("mm").parse().unwrap();
        assert!(outcome.report.meshes[0].chord_error.unwrap() <= limit, "{settings}");
    }
}

/// The seam of a tube passes a corner of a hole at a hair's breadth.
#[test]
fn a_seam_beside_a_corner() {
    let mut all = Vec::new();
    for off in ["0.05", "0.03", "0.02", "0.015", "0.01", "0.007", "0.005", "0.003", "0.002", "0.001"] {
        let tube = format!(
            "surface tube = extrude(circle(center: (0, 0, 0), radius: 20), by: (0, 0, 30))
curve eye = project(polyline([(40, {off}, 8), (40, 6, 15), (40, {off}, 22), (40, -6, 15)], closed: true), onto: tube, along: (1, 0, 0))
surface face = trim(tube, holes: [eye])"
        );
        let mesh = mesh(&format!("units mm\n{tube}\nmesh m of face {{ size: 3mm }}\n"));
        assert!(mesh.triangles.len() < 2600, "{off}: {}", mesh.triangles.len());
        all.push(mesh.quality().unwrap().min_angle.to_degrees());
    }
    all.sort_by(f64::total_cmp);
    assert!(all[0] >= 15.0 && all[3] >= 25.0, "{all:?}");
}
