//! Surfaces that turn back within a step, as a wing at its leading edge: nothing is cut off, elements are well shaped and few, and the
//! chord error is that of the tip as well.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use lofting::mesh::Mesh;
use lofting::session::disk::{Disk, Outputs};

use crate::support::script;

/// The mesh of a script, with the area of its surface `face` and the chord error of the report, model units.
fn mesh(text: &str) -> (Arc<Mesh>, f64, f64) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let disk = Disk::new(None, Some(folder), &[], Outputs::Written).unwrap();
    let outcome = script::outcome("m.loft", text.as_bytes(), &[], &disk);
    assert!(outcome.report.ok, "{}\n{text}", outcome.drawn(false, false));
    let report = serde_json::to_value(&outcome.report).unwrap();
    let area = report["surfaces"].as_array().unwrap().iter().find(|s| s["name"] == "face").unwrap()["area"].as_f64().unwrap();
    let chord = report["meshes"][0]["chord_error"].as_f64().unwrap();
    (outcome.meshes.into_iter().next().unwrap().1, area, chord)
}

/// Sides of a thin sheet bent about a tip at x = 2, 3 long, with a slot whose corners lie on the tip line.
fn hairpin(half: f64) -> String {
    format!(
        "units m
surface bent = extrude(spline([(0, 0, {half}), (1, 0, {wide}), (2, 0, 0), (1, 0, -{wide}), (0, 0, -{half})]), by: (0, 3, 0))
surface face = trim(bent, holes: [polyline([(0.1, 0.3), (0.2, 0.3), (0.2, 0.5), (0.15, 0.6), (0.1, 0.5), (0.1, 0.3)])], uv: true)",
        wide = 1.5 * half
    )
}

const PROFILE: &str = "spline([(1, 0, 0.001), (0.7, 0, 0.04), (0.3, 0, 0.06), (0.1, 0, 0.045), (0, 0, 0), (0.1, 0, -0.03), (0.3, 0, -0.04),
  (0.7, 0, -0.02), (1, 0, -0.001)])";

/// A wing with a slot across its leading edge and one that ends beside it.
fn wing() -> String {
    format!(
        "units m
surface skin = extrude({PROFILE}, by: (0, 3, 0))
surface face = trim(skin, uv: true, holes: [
  polyline([(0.3, 0.45), (0.4, 0.45), (0.4, 0.55), (0.3, 0.55), (0.3, 0.45)]),
  polyline([(0.6, 0.5), (0.7, 0.5), (0.7, 0.55), (0.6, 0.55), (0.6, 0.5)])])"
    )
}

/// Three layers, nearer to each other than a step.
const PLEAT: &str = "units m
surface bent = extrude(spline([(0, 0, 0), (1, 0, 0), (0.8, 0, 0.04), (0.2, 0, 0.04), (0, 0, 0.08), (1, 0, 0.08)]), by: (0, 2, 0))
surface face = trim(bent, uv: true, holes: [polyline([(0.1, 0.3), (0.2, 0.3), (0.2, 0.5), (0.15, 0.6), (0.1, 0.5), (0.1, 0.3)])])";
const WHOLE: &str = "units m
curve profile = spline([(0, 0, 0.02), (1, 0, 0.03), (2, 0, 0), (1, 0, -0.03), (0, 0, -0.02)])
surface face = extrude(profile, by: (0, 3, 0))";

/// Script, settings, largest share of the area that chords may miss, largest chord error (m), least angle (degrees), elements.
type Case = (String, &'static str, f64, f64, f64, Range<usize>);

fn cases() -> Vec<Case> {
    vec![
        (hairpin(0.05), "size: 0.3", 0.003, 0.02, 30.0, 300..700),
        (hairpin(0.02), "size: 0.3", 0.001, 0.01, 30.0, 300..700),
        (hairpin(0.005), "size: 0.3", 0.001, 0.01, 30.0, 300..700),
        (hairpin(0.02), "size: 0.1", 0.001, 0.01, 30.0, 3500..5000),
        (hairpin(0.02), "size: 0.3  method: quadtree", 0.001, 0.01, 30.0, 600..1200),
        (hairpin(0.02), "size: 0.3  elements: quads", 0.001, 0.01, 35.0, 150..400),
        (hairpin(0.02), "size: 0.3  chord_error: 5mm", 0.001, 0.005, 25.0, 5000..16_000),
        (wing(), "size: 0.1", 0.005, 0.03, 28.0, 1500..3000),
        (wing(), "size: 0.1  elements: quads", 0.005, 0.03, 35.0, 600..1400),
        (wing(), "size: 0.1  chord_error: 1mm", 0.001, 0.001, 25.0, 6000..11_000),
        (PLEAT.to_owned(), "size: 0.15", 0.005, 0.02, 30.0, 700..1400),
        (PLEAT.to_owned(), "size: 0.15  elements: quads", 0.005, 0.02, 35.0, 300..900),
        (WHOLE.to_owned(), "size: 0.3", 0.001, 0.01, 30.0, 150..400),
        (WHOLE.to_owned(), "size: 0.3  method: delaunay", 0.001, 0.01, 30.0, 200..500),
        (WHOLE.to_owned(), "size: 0.3  method: delaunay  elements: quads", 0.001, 0.01, 35.0, 100..400),
    ]
}

#[test]
fn tips_of_folds_are_not_cut_off() {
    let mut failed = Vec::new();
    for (script, settings, missed, chord, angle, elements) in cases() {
        let (mesh, area, reported) = mesh(&format!("{script}\nmesh m of face {{ {settings} }}\n"));
        let quality = mesh.quality().unwrap();
        let (lost, count) = (1.0 - quality.area / area, mesh.triangles.len() + mesh.quads.len());
        let least = quality.min_angle.to_degrees();
        if lost.abs() > missed || reported > chord || least < angle || !elements.contains(&count) {
            failed.push(format!("{settings}: lost {lost:.4}, chord error {reported:.4}, {least:.1} degrees, {count}\n{script}"));
        }
    }
    assert_eq!(failed, Vec::<String>::new(), "{}", failed.join("\n\n"));
}

/// Rows of a mapped mesh may pass over a tip: the report says how far it is from them.
#[test]
fn the_chord_error_counts_what_rows_cut_off() {
    for (count, least, most) in [(15, 0.06, 0.16), (14, 0.0, 0.01)] {
        let (_, _, reported) = mesh(&format!("{WHOLE}\nmesh m of face {{ size: 0.3  on profile {{ count: {count} }} }}\n"));
        assert!(reported > least && reported < most, "{count} rows: {reported}");
    }
}
