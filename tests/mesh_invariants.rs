//! What must hold of every mesh (`support/invariants.rs`), of all goldens and examples; those of the papers' models are looked at in
//! `acceptance_mesh.rs`.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test fails by panicking and checks with the platform's functions"
)]

#[path = "support/invariants.rs"]
mod invariants;
#[path = "support/script.rs"]
mod script;

use std::path::{Path, PathBuf};

use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;

fn models(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            models(&path, found);
        } else if path.extension().is_some_and(|e| e == "loft") {
            found.push(path);
        }
    }
}

#[test]
fn every_mesh_of_every_model_is_sound() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    ["examples", "tests/golden"].iter().for_each(|folder| models(&root.join(folder), &mut paths));
    paths.retain(|p| !p.parent().is_some_and(|p| p.ends_with("broken")));
    paths.sort();
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("invariants");
    std::fs::create_dir_all(&out).unwrap();
    let (mut found, mut tally) = (Vec::new(), [0; 5]);
    for path in &paths {
        let text = std::fs::read_to_string(path).unwrap();
        if !text.contains("\nmesh ") {
            continue;
        }
        let disk = Disk::new(Some(path), Some(&out), &[], Outputs::Counted).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap();
        let outcome = guarded(|| script::outcome(name, text.as_bytes(), &[], &disk)).unwrap_or_else(|bug| panic!("{bug:?}"));
        found.extend(invariants::look(&text, &outcome, &mut tally).into_iter().map(|f| format!("{name}: {f}")));
    }
    assert_eq!(found, Vec::<String>::new());
    let enough = tally.iter().zip([50, 100, 3_000, 20, 5]).all(|(n, least)| *n >= least);
    assert!(enough, "too little was looked at: {tally:?}");
}
