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
    // Of a few elements round a whole ball, a ring or the tip of a needle neither sides nor samples of the error mean anything; nor
    // do samples where the chord error that is asked for is larger than the surface.
    let coarse = |f: &str| {
        let (ball, ring) = (f.starts_with("closed.loft: ball_quads: "), f.starts_with("closed.loft: ring_large: "));
        let needle = f.starts_with("needles.loft: ");
        let loose = f.starts_with("loose.loft: ") && f.contains(" off at ");
        loose || (ball || ring || needle) && (f.contains("upside down") || f.contains(" off at "))
    };
    found.retain(|f| !coarse(f));
    assert_eq!(found, Vec::<String>::new());
    let enough = tally.iter().zip([50, 100, 3_000, 20, 5]).all(|(n, least)| *n >= least);
    assert!(enough, "too little was looked at: {tally:?}");
}

/// A square of four by four cells with a hole of one in the middle, in triangles: elements, border with the hole, own nodes from 100.
fn plate() -> (Vec<[u32; 3]>, Vec<[u32; 2]>) {
    let node = |i: u32, j: u32| if i == 0 || j == 0 || i == 5 || j == 5 { i + 6 * j } else { 100 + (i - 1) + 4 * (j - 1) };
    let hole = |n: u32| if [105, 106, 109, 110].contains(&n) { n - 50 } else { n };
    let id = |i: u32, j: u32| {
        let n = hole(node(i, j));
        if n >= 100 {
            100 + [100, 101, 102, 103, 104, 107, 108, 111, 112, 113, 114, 115].iter().position(|m| *m == n).unwrap() as u32
        } else {
            n
        }
    };
    let (mut triangles, mut border) = (Vec::new(), Vec::new());
    for j in 0..5 {
        for i in 0..5 {
            if (i, j) != (2, 2) {
                let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    for k in 0..5 {
        border.extend([[id(k, 0), id(k + 1, 0)], [id(5, k), id(5, k + 1)], [id(k + 1, 5), id(k, 5)], [id(0, k + 1), id(0, k)]]);
    }
    border.extend([[id(2, 2), id(2, 3)], [id(2, 3), id(3, 3)], [id(3, 3), id(3, 2)], [id(3, 2), id(2, 2)]]);
    (triangles, border)
}

/// What the check of every run finds in a mesh that is broken on purpose.
#[test]
fn a_broken_mesh_is_seen() {
    use lofting::mesh::Elements;
    use lofting::mesh::verify::{Claim, Defect};
    let (whole, border) = plate();
    let look = |triangles: &[[u32; 3]], border: &[[u32; 2]], euler: i64| {
        let kind = Elements::Triangles;
        Claim { triangles, quads: &[], kind, border, lines: &[], points: &[], own: (100, 12), euler: Some(euler) }.hold()
    };
    assert_eq!(look(&whole, &border, 0), Ok(()), "a disc with a hole");
    assert_eq!(look(&whole, &border, 1), Err(Defect::Euler(0, 1)));
    assert_eq!(look(&[], &border, 0), Err(Defect::Empty));
    // The hole is filled; so it is where its loop is there twice and counts as nothing.
    let filled: Vec<[u32; 3]> = [whole.as_slice(), &[[55, 56, 60], [55, 60, 59]]].concat();
    assert!(matches!(look(&filled, &border, 0), Err(Defect::Edge(_, [1, 1], _))), "{:?}", look(&filled, &border, 0));
    let twice = [border.as_slice(), &border[20..]].concat();
    assert!(matches!(look(&filled, &twice, -1), Err(Defect::Edge(_, [1, 1], _))), "{:?}", look(&filled, &twice, -1));
    // One triangle less, one twice, one turned over, one with a node of elsewhere: at every place.
    for k in 0..whole.len() {
        let mut less = whole.clone();
        let one = less.remove(k);
        assert!(matches!(look(&less, &border, 0), Err(Defect::Edge(..) | Defect::Torn)), "without {k}");
        let more = [whole.as_slice(), &[one]].concat();
        assert!(matches!(look(&more, &border, 0), Err(Defect::Edge(..) | Defect::Torn)), "{k} twice");
        let both = [whole.as_slice(), &[one, [one[0], one[2], one[1]]]].concat();
        assert!(look(&both, &border, 0).is_err(), "{k} with its back");
        let mut turned = whole.clone();
        turned[k].swap(1, 2);
        assert!(matches!(look(&turned, &border, 0), Err(Defect::Edge(..) | Defect::Torn)), "{k} turned");
        let mut foreign = whole.clone();
        foreign[k][0] = 77;
        assert!(look(&foreign, &border, 0).is_err(), "{k} elsewhere");
    }
    let mut loose = whole.clone();
    loose.retain(|t| !t.contains(&100));
    assert_eq!(look(&loose, &border, 0), Err(Defect::Loose(100)));
    // An edge of the border that no element has.
    assert!(matches!(look(&whole, &[border.as_slice(), &[[0, 55]]].concat(), 0), Err(Defect::Edge([0, 55], [0, 0], [1, 0]))));
}
