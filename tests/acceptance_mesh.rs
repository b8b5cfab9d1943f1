//! Models of the papers on meshing [Yoo & Yoon 2000; Jeong & Park 2000], as scripts with checks, and the same bytes on any number of
//! threads.

use std::path::{Path, PathBuf};
use std::process::Command;

use glam::{DVec2, DVec3};
use lofting::mesh::Mesh;
use lofting::mesh::data::face_geometry::FaceNodes;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;
use lofting::session::run::Outcome;
use serde_json::Value as Json;

use crate::support::invariants;
use crate::support::reference::reference;
use crate::support::script;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("acceptance-{name}"));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs a script whose checks all hold.
fn outcome(script: &Path) -> Outcome {
    outcome_with(script, &[])
}

/// The same with params set from outside.
fn outcome_with(script: &Path, sets: &[(String, String)]) -> Outcome {
    let text = std::fs::read(script).unwrap();
    let disk = Disk::new(Some(script), Some(&folder("out")), &[], Outputs::Written).unwrap();
    let name = script.file_name().unwrap().to_str().unwrap();
    let outcome = guarded(|| script::outcome(name, &text, sets, &disk)).unwrap_or_else(|bug| panic!("{bug:?}"));
    assert!(outcome.report.ok, "{name}:\n{}", outcome.drawn(false, false));
    assert!(!outcome.report.checks.is_empty(), "{name} checks nothing");
    outcome
}

/// The mesh is sound, and every triangle has an area.
fn sound(mesh: &Mesh) {
    invariants::edges(mesh);
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|n| mesh.nodes[n as usize]);
        assert!((b - a).cross(c - a).length() > 0.0, "{}: a triangle without area at {a}", mesh.name);
    }
}

/// The chord error, mm, that a script writes for a mesh whose name begins with `iso`.
fn written_limit(script: &Path, mesh: &str) -> Option<f64> {
    let text = std::fs::read_to_string(script).unwrap();
    let line = text.lines().find(|l| mesh.starts_with("iso") && l.starts_with(&format!("mesh {mesh} of")))?;
    line.split("chord_error: ").nth(1)?.split("mm").next()?.parse().ok()
}

/// The largest distance along their normals of triangles from their surface at 25 places in each.
fn sampled(mesh: &Mesh) -> f64 {
    let mut worst = 0.0_f64;
    for (geometry, face) in mesh.geometries.0.iter().zip(&mesh.faces) {
        let FaceNodes::Free(free, _) = &geometry.nodes else { panic!("{} is not made freely", mesh.name) };
        let own = &mesh.triangles[face.triangles.start as usize..face.triangles.end as usize];
        for (places, nodes) in free.triangles.iter().zip(own) {
            let uv = places.map(|n| DVec2::from(free.uv[n as usize]));
            let p = nodes.map(|n| mesh.nodes[n as usize]);
            let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize();
            for (i, j) in (0..7).flat_map(|i| (0..7 - i).map(move |j| (i, j))).filter(|(i, j)| (i + j) % 8 < 7).take(25) {
                let (s, t) = (f64::from(i) / 6.0, f64::from(j) / 6.0);
                let at = uv[0] + (uv[1] - uv[0]) * s + (uv[2] - uv[0]) * t;
                worst = worst.max((geometry.surface.point(at.x, at.y) - p[0]).dot(normal).abs());
            }
        }
    }
    worst
}

fn all_hold(folder: &str) {
    let entries = std::fs::read_dir(root().join(folder)).unwrap().map(|e| e.unwrap().path());
    let mut scripts: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "loft")).collect();
    scripts.sort();
    assert!(scripts.len() >= 2, "{folder}");
    for script in scripts {
        let outcome = outcome(&script);
        let text = std::fs::read_to_string(&script).unwrap();
        assert_eq!(invariants::look(&text, &outcome, &mut [0; 5]), Vec::<String>::new(), "{}", script.display());
        for ((_, mesh), report) in outcome.meshes.iter().zip(&outcome.report.meshes) {
            sound(mesh);
            if let Some(limit) = written_limit(&script, &mesh.name) {
                let seen = sampled(mesh);
                assert!(seen <= limit && report.chord_error.unwrap() <= limit, "{}: {} is {seen} off", script.display(), mesh.name);
            }
        }
    }
}

#[test]
fn models_of_the_papers_hold() {
    all_hold("tests/acceptance");
}

/// Those that take longer; for `.ci/run`.
#[test]
#[ignore = "takes longer"]
fn long_models_of_the_papers_hold() {
    all_hold("tests/acceptance/long");
}

fn facts(model: &str) -> Json {
    reference("acceptance_models")[model].clone()
}

/// Figure 16 of [Yoo & Yoon 2000], with points that were measured once for all faces and with errors of each: no node of an edge belongs to one
/// face alone, and the mesh is within 0.1 mm of every face.
#[test]
fn the_fender_has_no_unmatched_nodes() {
    for error in ["0mm", "0.02mm"] {
        let sets = [("error".to_owned(), error.to_owned())];
        let outcome = outcome_with(&root().join("examples/fender.loft"), &sets);
        let mesh = &outcome.meshes[0].1;
        sound(mesh);
        assert_eq!(mesh.faces.len(), 14);
        assert!(outcome.report.meshes[0].chord_error.unwrap() <= facts("fender_14")["settings"]["chord_error"].as_f64().unwrap());
    }
}

/// Figure 17 of [Yoo & Yoon 2000]: 8 planes and 24 curved faces; what the triangles enclose differs from the block by the chord error at most.
#[test]
fn the_block_encloses_what_it_should() {
    let outcome = outcome(&root().join("examples/block.loft"));
    let facts = facts("filleted_L_block");
    let (volume, area) = (facts["volume"].as_f64().unwrap(), facts["area"].as_f64().unwrap());
    let shell = &outcome.report.shells[0];
    assert!((shell.volume.unwrap() / volume - 1.0).abs() < 1e-9, "{:?}", shell.volume);
    assert!((shell.area.unwrap() / area - 1.0).abs() < 1e-9, "{:?}", shell.area);
    let topology = &outcome.report.topology;
    let known = |key: &str| facts["euler"][key].as_u64().unwrap() as usize;
    assert_eq!((topology.vertices, topology.edges, topology.patches), (known("V"), known("E"), known("F")));
    let mesh = &outcome.meshes[0].1;
    sound(mesh);
    assert!(mesh.is_watertight());
    let corners = |t: &[u32; 3]| t.map(|n| mesh.nodes[n as usize]);
    let six: f64 = mesh.triangles.iter().map(corners).map(|[a, b, c]: [DVec3; 3]| a.dot(b.cross(c))).sum();
    let chord = 0.1;
    assert!((six.abs() / 6.0 - volume).abs() <= chord * area, "{}", six / 6.0);
    let twice: f64 = mesh.triangles.iter().map(corners).map(|[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length()).sum();
    // Of a convex quarter circle of 4 mm, the smallest radius, a chord error of 0.1 mm takes 1.7 % of the length.
    assert!(0.5 * twice <= area && 0.5 * twice >= 0.983 * area, "{}", 0.5 * twice);
    assert_eq!(mesh.nodes.len() as i64 - mesh.triangles.len() as i64 / 2, 2 - 2 * facts["euler"]["genus"].as_i64().unwrap());
}

#[test]
fn the_block_has_the_same_bytes_on_any_number_of_threads() {
    let mut known: Option<(Vec<u8>, Vec<u8>)> = None;
    for threads in ["1", "2", "8"] {
        let out = folder(&format!("threads-{threads}"));
        let mut command = Command::new(env!("CARGO_BIN_EXE_loft"));
        command.args(["run", "--json", "--threads", threads, "--set", "size=7mm", "examples/block.loft", "-o"]).arg(&out);
        let done = command.current_dir(root()).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let report: Json = serde_json::from_slice(&done.stdout).unwrap();
        let meshes = serde_json::to_vec(&report["meshes"]).unwrap();
        let found = (std::fs::read(out.join("block.inp")).unwrap(), meshes);
        assert!(*known.get_or_insert_with(|| found.clone()) == found, "{threads} threads make another file");
    }
}
