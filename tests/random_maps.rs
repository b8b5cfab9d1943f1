//! Ten bent surfaces with uneven rows that `benches/peers/random_maps.py --write tests/data/random-maps --cases 10` has written: roundings much smaller than
//! their profiles, waves, a slim ellipse, walls with a floor. Each script checks its chord error; `truth.json` has the quads and the least angle of each, degrees.

use lofting::session::disk::{Disk, Outputs};
use serde_json::Value;

use crate::support::long::root;
use crate::support::script;

/// Largest number of quads over that of `truth.json`.
const MORE: f64 = 1.1;

#[test]
fn maps_of_bent_surfaces_keep_their_limits_with_few_rows() {
    let folder = root().join("tests/data/random-maps");
    let truth: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("truth.json")).unwrap()).unwrap();
    let truth = truth.as_object().unwrap();
    assert_eq!(truth.len(), 10);
    for (name, known) in truth {
        let text = std::fs::read(folder.join(format!("{name}.loft"))).unwrap();
        let disk = Disk::new(None, Some(std::path::Path::new(env!("CARGO_TARGET_TMPDIR"))), &[], Outputs::Counted).unwrap();
        let outcome = script::outcome("map.loft", &text, &[], &disk);
        assert!(outcome.report.ok, "{name}: {}", outcome.drawn(false, false));
        let report = serde_json::to_value(&outcome.report).unwrap();
        let mesh = &report["meshes"][0];
        let quads = mesh["quads"].as_f64().unwrap();
        assert!(quads <= MORE * known["quads"].as_f64().unwrap(), "{name}: {quads} quads");
        let angle = mesh["min_angle"].as_f64().unwrap();
        assert!(angle >= known["least_angle"].as_f64().unwrap() - 1.0, "{name}: an angle of {angle}°");
    }
}
