//! What must hold of every mesh (`support/invariants.rs`), of goldens and examples (an eighth of them in a short run); those of the papers' models are looked at in
//! `acceptance_mesh.rs`.

use std::path::{Path, PathBuf};

use glam::DVec2;
use lofting::mesh::verify::covered_area::{CoveredArea, LoopPlace, NodePlaces, agrees, inside, left_out};
use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;

use crate::support::invariants;
use crate::support::long::{is_long, root, sample, scripts};
use crate::support::script;

#[test]
fn every_mesh_of_every_model_is_sound() {
    let chosen = sample(scripts(&["examples", "tests/golden"]), 2);
    let mut paths: Vec<PathBuf> = chosen.into_iter().map(|path| root().join(path)).collect();
    paths.retain(|p| !p.parent().is_some_and(|p| p.ends_with("broken")));
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
    // do samples where the chord error that is asked for, or a step, is larger than the waves of the surface. Where a border turns back
    // along itself the surface bends without a radius. At the tip of a cusp triangles of a hair's breadth stand on edge. The nearest place of
    // a pipe that goes through itself may be on its other sheet.
    let coarse = |f: &str| {
        let (ball, ring) = (f.starts_with("closed.loft: ball_quads: "), f.starts_with("closed.loft: ring_large: "));
        let needle = f.starts_with("needles.loft: ");
        let turned = ["turned_back.loft: ", "round_corners.loft: tube: ", "cusp.loft: rows: "].iter().any(|s| f.starts_with(s))
            && f.contains("upside down");
        // A limit larger than the surface lets its two triangles be any.
        let loose = f.starts_with("loose.loft: ") && (f.contains(" off at ") || f.contains(" iso[4]: ") && f.contains("upside down"));
        // Three faces meet at the edges of a wall between two shells.
        let wall = f.starts_with("common_wall.loft: m: 3 uses of the edge");
        let wave_a_step = f.starts_with("free_borders.loft: coarse: ");
        loose || wall || wave_a_step || turned || (ball || ring || needle) && (f.contains("upside down") || f.contains(" off at "))
    };
    found.retain(|f| !coarse(f));
    assert_eq!(found, Vec::<String>::new());
    let least = if is_long() { [50, 100, 3_000, 20, 5] } else { [12, 25, 750, 3, 1] };
    let enough = tally.iter().zip(least).all(|(n, least)| *n >= least);
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
    use lofting::mesh::verify::connectivity::Claim;
    use lofting::mesh::verify::defect::Defect;
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

/// A square of six by six cells in the parameter plane with a hole of two by two, in triangles: places, elements, loops.
fn covered_square() -> (Vec<DVec2>, Vec<[u32; 3]>, Vec<Vec<LoopPlace>>) {
    let at = |i: u32, j: u32| i + 7 * j;
    let places = (0..49).map(|n| DVec2::new(f64::from(n % 7), f64::from(n / 7)) / 6.0).collect();
    let cells = (0..36).map(|k| (k % 6, k / 6)).filter(|(i, j)| !((2..4).contains(i) && (2..4).contains(j)));
    let halves = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let square = |low: f64, high: f64| [(low, low), (high, low), (high, high), (low, high)].map(|p| (DVec2::from(p), 0.0)).to_vec();
    let mut hole = square(1.0 / 3.0, 2.0 / 3.0);
    hole.reverse();
    (places, cells.flat_map(halves).collect(), vec![square(0.0, 1.0), hole])
}

/// What elements cover in the parameter plane is that inside the loops: nothing may be filled, missing, there twice or elsewhere.
#[test]
fn elements_that_cover_another_part_are_seen() {
    let (places, whole, loops) = covered_square();
    let cover = |places: &[DVec2], triangles: &[[u32; 3]]| {
        let mut covered = CoveredArea::default();
        triangles.iter().for_each(|t| covered.add(places[t[0] as usize], places[t[1] as usize], places[t[2] as usize]));
        covered
    };
    // Loops that are known to a thousandth see everything that is larger.
    let about: Vec<Vec<LoopPlace>> = loops.iter().map(|l| l.iter().map(|(p, _)| (*p, 1e-3)).collect()).collect();
    for loops in [&loops, &about] {
        let agrees = |places: &[DVec2], triangles: &[[u32; 3]]| agrees(cover(places, triangles), inside(loops));
        assert!(agrees(&places, &whole));
        let filled = [whole.as_slice(), &[[16, 18, 32], [16, 32, 30]]].concat();
        assert!(!agrees(&places, &filled), "the hole is filled");
        for k in 0..whole.len() {
            let mut less = whole.clone();
            let one = less.remove(k);
            assert!(!agrees(&places, &less), "without {k}");
            assert!(!agrees(&places, &[whole.as_slice(), &[one]].concat()), "{k} twice");
        }
        // The hole elsewhere, of the same area.
        for by in [DVec2::new(0.05, 0.0), DVec2::new(0.0, -0.05)] {
            let moved: Vec<DVec2> =
                places.iter().map(|p| if (*p - DVec2::splat(0.5)).abs().max_element() < 0.2 { *p + by } else { *p }).collect();
            assert!((cover(&moved, &whole).area - cover(&places, &whole).area).abs() < 1e-12);
            assert!(!agrees(&moved, &whole), "the hole moved by {by}");
        }
    }
    // Exact loops see a hole that moved by a millionth of the face.
    let moved: Vec<DVec2> =
        places.iter().map(|p| if (*p - DVec2::splat(0.5)).abs().max_element() < 0.2 { *p + DVec2::splat(2e-4) } else { *p }).collect();
    assert!(!agrees(cover(&moved, &whole), inside(&loops)));
}

/// A cap round a pole in six by six cells: u runs round it, with a seam at 0 and 1, and v = 1 is the pole, whose edge in (u, v) has
/// its tip in the middle of the row below. Places, nodes, number of border places, edges of the loop, elements; `quads` but beside the pole.
struct Cap {
    uv: Vec<(f64, f64)>,
    ids: Vec<u32>,
    border: usize,
    around: Vec<[u32; 2]>,
    elements: Vec<Vec<u32>>,
}

fn cap(quads: bool) -> Cap {
    let is_border = |(i, j): (u32, u32)| i == 0 || i == 6 || j == 0;
    let all: Vec<(u32, u32)> = (0..6).flat_map(|j| (0..7).map(move |i| (i, j))).collect();
    let mut order: Vec<(u32, u32)> = all.iter().copied().filter(|n| is_border(*n)).collect();
    order.extend([(0, 6), (6, 6)]);
    let border = order.len();
    order.extend(all.iter().copied().filter(|n| !is_border(*n)));
    let place = |i: u32, j: u32| order.iter().position(|n| *n == (i, j)).unwrap() as u32;
    let id = |(i, j): (u32, u32)| if j == 6 { 1000 } else { 10 * j + i % 6 };
    let mut around: Vec<[u32; 2]> = (0..6).map(|i| [place(i, 0), place(i + 1, 0)]).collect();
    around.extend((0..6).flat_map(|j| [[place(6, j), place(6, j + 1)], [place(0, j + 1), place(0, j)]]));
    around.push([place(6, 6), place(0, 6)]);
    let mut elements = Vec::new();
    for (i, j) in (0..5).flat_map(|j| (0..6).map(move |i| (i, j))) {
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        elements.extend(if quads { vec![vec![a, b, c, d]] } else { vec![vec![a, b, c], vec![a, c, d]] });
    }
    elements.extend((0..6).map(|i| vec![place(i, 5), place(i + 1, 5), if i < 3 { place(0, 6) } else { place(6, 6) }]));
    let uv = order.iter().map(|(i, j)| (f64::from(*i) / 6.0, f64::from(*j) / 6.0)).collect();
    let ids = order.iter().map(|n| id(*n)).collect();
    Cap { uv, ids, border, around, elements }
}

/// Beside a pole and at a seam what is no element in space is told from what is missing, there twice or elsewhere.
#[test]
fn caps_that_are_broken_are_seen() {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|p| (DVec2::from(p), 0.0)).to_vec();
    let loops = inside(&[corners]);
    for quads in [false, true] {
        let whole = cap(quads);
        let look = |elements: &[Vec<u32>], uv: &[(f64, f64)]| {
            let mut covered = CoveredArea::default();
            for e in elements {
                let at = |k: usize| DVec2::from(uv[e[k] as usize]);
                if e.len() == 3 { covered.add(at(0), at(1), at(2)) } else { covered.add_quad([at(0), at(1), at(2), at(3)]) }
            }
            let slices = elements.iter().map(|e| e.as_slice());
            left_out(slices, NodePlaces { uv, ids: &whole.ids }, whole.border, &whole.around)
                .is_some_and(|out| agrees(covered.and(out), loops))
        };
        assert!(look(&whole.elements, &whole.uv), "quads: {quads}");
        for k in 0..whole.elements.len() {
            let mut less = whole.elements.clone();
            let one = less.remove(k);
            assert!(!look(&less, &whole.uv), "quads: {quads}, without {k}");
            let twice = [whole.elements.as_slice(), std::slice::from_ref(&one)].concat();
            assert!(!look(&twice, &whole.uv), "quads: {quads}, {k} twice");
            // The cell with the next one, in which nothing is left of the row.
            less.retain(|e| e.iter().filter(|n| one.contains(n)).count() < 2);
            assert!(!look(&less, &whole.uv), "quads: {quads}, a hole round {k}");
        }
        // The triangle that is a line in space, filled in.
        let tip = whole.uv.iter().position(|p| *p == (0.5, 5.0 / 6.0)).unwrap() as u32;
        let [b, a] = whole.around[whole.around.len() - 1];
        let filled = [whole.elements.as_slice(), &[vec![tip, b, a]]].concat();
        assert!(look(&filled, &whole.uv), "it covers what was left out");
        // A place of the loop elsewhere; inner ones may be anywhere.
        for (k, p) in whole.uv.iter().enumerate() {
            let mut moved = whole.uv.clone();
            moved[k] = (p.0 + 0.02, p.1 + 0.03);
            assert_eq!(look(&whole.elements, &moved), k >= whole.border, "quads: {quads}, {p:?} moved");
        }
    }
}
