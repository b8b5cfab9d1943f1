//! Ten shells of 10 to 60 faces that `benches/peers/random_shells.py --write tests/data/random-shells` has written: mapped, trimmed and turned
//! faces, poles, faces of three sides, sweeps. `truth.json` has the Euler number of each, its area where it is known without the program, and the least
//! angle away from sharp corners.

use std::collections::BTreeMap;

use glam::DVec3;
use lofting::mesh::Mesh;
use lofting::session::disk::{Disk, Outputs};
use serde_json::Value;

use crate::support::long::root;
use crate::support::script;

/// Corners of faces sharper than this make sharp elements whatever the mesh, degrees.
const SHARP_CORNER: f64 = 45.0;

/// Uses of each edge by the triangles of a mesh, upwards and downwards in the numbers of its nodes.
fn edges(triangles: &[[u32; 3]]) -> BTreeMap<(u32, u32), [u32; 2]> {
    let mut uses: BTreeMap<(u32, u32), [u32; 2]> = BTreeMap::new();
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            uses.entry((*from.min(to), *from.max(to))).or_default()[usize::from(from > to)] += 1;
        }
    }
    uses
}

fn angle(mesh: &Mesh, t: &[u32; 3], k: usize) -> f64 {
    let [a, b, c] = [0, 1, 2].map(|j| mesh.nodes[t[(k + j) % 3] as usize]);
    (b - a).angle_between(c - a).to_degrees()
}

/// The least angle of the triangles that touch no sharp corner of their face.
fn least_angle(mesh: &Mesh) -> f64 {
    let mut least = 180.0_f64;
    for face in &mesh.faces {
        let own = &mesh.triangles[face.triangles.start as usize..face.triangles.end as usize];
        let mut fans: BTreeMap<u32, f64> = BTreeMap::new();
        for t in own {
            (0..3).for_each(|k| *fans.entry(t[k]).or_default() += angle(mesh, t, k));
        }
        let border = edges(own).into_iter().filter(|(_, uses)| uses[0] + uses[1] == 1).flat_map(|((a, b), _)| [a, b]);
        let sharp: Vec<u32> = border.filter(|n| fans[n] < SHARP_CORNER).collect();
        let away = own.iter().filter(|t| !t.iter().any(|n| sharp.contains(n)));
        least = away.flat_map(|t| (0..3).map(move |k| angle(mesh, t, k))).fold(least, f64::min);
    }
    least
}

#[test]
fn shells_are_conforming_and_well_shaped() {
    let folder = root().join("tests/data/random-shells");
    let truth: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("truth.json")).unwrap()).unwrap();
    let truth = truth.as_object().unwrap();
    assert_eq!(truth.len(), 10);
    for (name, known) in truth {
        let text = std::fs::read(folder.join(format!("{name}.loft"))).unwrap();
        let disk = Disk::new(None, Some(std::path::Path::new(env!("CARGO_TARGET_TMPDIR"))), &[], Outputs::Counted).unwrap();
        let outcome = script::outcome("shell.loft", &text, &[], &disk);
        assert!(outcome.report.ok, "{name}: {}", outcome.drawn(false, false));
        let mesh = outcome.meshes.into_iter().next().unwrap().1;
        let edges = edges(&mesh.triangles);
        assert!(edges.values().all(|uses| uses[0] <= 1 && uses[1] <= 1), "{name}: an edge is used twice in one sense");
        let euler = mesh.nodes.len() as i64 - edges.len() as i64 + mesh.triangles.len() as i64;
        assert_eq!(Some(euler), known["euler"].as_i64(), "{name}");
        let node = |n: u32| mesh.nodes[n as usize];
        let double = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length();
        let area = mesh.triangles.iter().map(|t| 0.5 * double(t.map(node))).sum::<f64>();
        if let Some(known) = known["area"].as_f64() {
            assert!((area / known - 1.0).abs() < 0.03, "{name}: {area} instead of {known}");
        }
        let least = least_angle(&mesh);
        assert!(least >= known["least_angle"].as_f64().unwrap(), "{name}: an angle of {least}°");
    }
}
