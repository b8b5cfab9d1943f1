//! Files with bytes, digits and lines changed at random: readers of OBJ, STL and tables, and the triangulation of outlines, end in time
//! with an error that has a place, or with a result that states its conditions. IGES and STEP are changed in the same way beside their
//! readers (`iges.rs`, `step.rs`), scripts in `edits.rs`, the syntax in `src/lang/syntax/fuzz.rs`.
//!
//! `LOFT_MUTATIONS` says how many. Every file of a folder of `tests/data/mutations` is also looked at as it is: one that a change has
//! made and that fails is left in the folder of temporary files and named, and is kept by a copy into that folder.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec2;
use lofting::base::job::Job;
use lofting::base::triangulate_points::{NO_TRIANGLE, Triangles, points};
use lofting::base::work::Budget;
use lofting::io::mesh_files::{obj_read, stl_read};
use lofting::io::tables::json::Json;
use lofting::io::tables::{json, table, table_read, table_write};
use lofting::mesh::chart::outline::{Outline, in_line};
use lofting::mesh::chart::parametric_surface::{ParametricSurface, UniformSize};
use lofting::mesh::tri::build::{Lattice, Task, triangulate};

use crate::support::mutate::{Random, mutated};
use crate::support::outlines::{CARE, Waves, sound};

/// Seconds of one file: of a release build, and of one with little optimisation beside other tests.
const SECONDS: f64 = if cfg!(debug_assertions) { 20.0 } else { 2.0 };
/// Work of one outline.
const WORK: u64 = 20_000_000;

fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(path)
}

/// Files of some folders with one of some endings, in the order of their names.
fn corpus(folders: &[&str], endings: &[&str]) -> Vec<(String, Vec<u8>)> {
    let mut paths: Vec<PathBuf> =
        folders.iter().flat_map(|folder| std::fs::read_dir(root(folder)).unwrap().flatten().map(|entry| entry.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|e| endings.iter().any(|ending| e == *ending)));
    paths.sort();
    assert!(!paths.is_empty(), "{folders:?}");
    paths.iter().map(|path| (path.display().to_string(), std::fs::read(path).unwrap())).collect()
}

/// Looks at each file as it is and at so many changed ones; `look` tells whether something was read, and panics for what may not be.
/// At least one changed file in `share` must leave something, or the changes test nothing.
fn mutate(name: &str, files: &[(String, Vec<u8>)], (seed, few, share): (u64, usize, usize), look: impl Fn(&[u8]) -> bool) {
    let cases = std::env::var("LOFT_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(few);
    let attempt = |what: &str, bytes: &[u8]| {
        let start = Instant::now();
        let read = catch_unwind(AssertUnwindSafe(|| look(bytes)));
        let slow = start.elapsed().as_secs_f64() >= SECONDS;
        if slow || read.is_err() {
            let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("failed-{name}"));
            std::fs::write(&kept, bytes).unwrap();
            println!("{what} of {name} took {:?} and is in {}", start.elapsed(), kept.display());
        }
        assert!(!slow, "{what} of {name} took {:?}", start.elapsed());
        read.unwrap_or_else(|why| resume_unwind(why))
    };
    files.iter().for_each(|(path, bytes)| _ = attempt(path, bytes));
    let mut random = Random(seed);
    let read =
        (0..cases).filter(|case| attempt(&format!("case {case}"), &mutated(&files[random.below(files.len())].1, &mut random))).count();
    assert!(read * share >= cases, "{read} of {cases} files of {name} were read");
}

/// An error has words and a line of the file, or in a binary one a column.
fn has_a_place((line, column, what): (u64, Option<u64>, &str), bytes: &[u8], is_text: bool) {
    let lines = bytes.iter().filter(|b| matches!(b, b'\n' | b'\r')).count() as u64 + 1;
    assert!(!what.is_empty() && line <= lines && (line > 0 || !is_text), "line {line} of {lines}: {what}");
    assert!(column != Some(0) && (line > 0 || column.is_some()), "column {column:?}: {what}");
}

#[test]
fn mutated_files_never_break_the_reader_of_obj() {
    let files = corpus(&["data/obj-valid-a", "data/obj-odd-a", "data/mutations/obj"], &["obj"]);
    mutate("obj", &files, (0x0B1, 400, 6), |bytes| match obj_read::read(bytes) {
        Ok(obj) => {
            let (mesh, skipped) = obj.mesh("m");
            mesh.check().unwrap();
            skipped.iter().chain(&obj.skipped).for_each(|told| has_a_place((told.line, told.column, &told.what), bytes, true));
            let corners = obj.polygons.iter().flatten().all(|n| (*n as usize) < obj.vertices.len());
            let of_groups: usize = obj.groups.iter().map(|group| group.polygons.len()).sum();
            assert!(corners && of_groups == obj.polygons.len(), "each polygon is of one group");
            !mesh.faces.is_empty() || !obj.points.is_empty()
        }
        Err(error) => {
            has_a_place((error.line, error.column, &error.what), bytes, true);
            false
        }
    });
}

#[test]
fn mutated_files_never_break_the_reader_of_stl() {
    let files = corpus(&["golden/meshes/conforming.golden.d", "data/mutations/stl"], &["stl"]);
    mutate("stl", &files, (0x571, 400, 8), |bytes| match stl_read::read(bytes, "m") {
        Ok((mesh, skipped)) => {
            mesh.check().unwrap();
            assert!(skipped.iter().all(|told| !told.what.is_empty()));
            !mesh.triangles.is_empty()
        }
        Err(error) => {
            has_a_place((error.line, error.column, &error.what), bytes, false);
            false
        }
    });
}

#[test]
fn mutated_files_never_break_the_reader_of_tables() {
    let unit = |word: &str| ["m", "mm", "deg", "%"].contains(&word);
    let files = corpus(&["golden/cases", "broken", "data/mutations/tables"], &["csv", "dat", "txt"]);
    mutate("tables", &files, (0x7AB, 800, 4), |bytes| {
        let mut read = false;
        for layout in [table::Layout::Separated, table::Layout::Blanks] {
            for header in [None, Some(true), Some(false)] {
                match table_read::read(bytes, &table::Reading { layout, header, is_unit: &unit }) {
                    Ok(table) => {
                        let lines = bytes.iter().filter(|b| matches!(b, b'\n' | b'\r')).count() as u64 + 1;
                        let in_order = table.lines.is_sorted_by(|a, b| a < b) && table.lines.last().is_some_and(|line| *line <= lines);
                        assert!(!table.rows.is_empty() && table.rows.len() == table.lines.len() && in_order, "{:?}", table.lines);
                        assert!(table.rows.iter().flatten().filter_map(table::Cell::number).all(f64::is_finite));
                        let even = table.rows.iter().all(|row| row.len() == table.rows[0].len());
                        assert!(even || layout == table::Layout::Blanks, "rows of a csv are of one length");
                        table_write::write_csv(&table, &mut std::io::sink()).unwrap();
                        read = true;
                    }
                    Err(error) => has_a_place((error.line, error.column, &error.what), bytes, true),
                }
            }
        }
        read
    });
}

/// The same tree, with numbers that differ by their last bits at most: those of JSON are read so.
fn alike(a: &Json, b: &Json) -> bool {
    match (a, b) {
        (Json::Number(x), Json::Number(y)) => (x - y).abs() <= 4.0 * f64::EPSILON * y.abs(),
        (Json::List(x), Json::List(y)) => x.len() == y.len() && x.iter().zip(y).all(|(x, y)| alike(x, y)),
        (Json::Record(x), Json::Record(y)) => x.len() == y.len() && x.iter().zip(y).all(|(x, y)| x.0 == y.0 && alike(&x.1, &y.1)),
        _ => a == b,
    }
}

#[test]
fn mutated_files_never_break_the_reader_of_json() {
    let files = corpus(&["golden/trims", "data/mutations/tables"], &["json"]);
    mutate("json", &files, (0x150, 600, 8), |bytes| match json::read(bytes) {
        Ok(tree) => {
            let mut written = Vec::new();
            json::write(&tree, &mut written).unwrap();
            let again = json::read(&written).unwrap();
            assert!(alike(&again, &tree), "what is written reads back: {again:?} of {tree:?}");
            true
        }
        Err(error) => {
            has_a_place((error.line, error.column, &error.what), bytes, true);
            false
        }
    });
}

/// Loops and lines of an outline: `loop` or `line` begins one, each line after it has x and y. What is none of these is left out,
/// and so are numbers far beyond those of a chart.
fn outline_of(bytes: &[u8], surface: &dyn ParametricSurface) -> Outline {
    let mut outline = Outline::default();
    let (mut first, mut is_loop) = (0, true);
    let end = |outline: &mut Outline, first: u32, is_loop: bool| {
        let last = outline.xy.len() as u32;
        if last <= first + if is_loop { 2 } else { 1 } {
            outline.xy.truncate(first as usize);
            outline.p.truncate(first as usize);
            return;
        }
        let ways = (first..last - 1).map(|n| [n, n + 1]);
        if is_loop { outline.loops.extend(ways.chain([[last - 1, first]])) } else { outline.lines.extend(ways) }
    };
    for line in String::from_utf8_lossy(bytes).lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let ["loop" | "line"] = words[..] {
            end(&mut outline, first, is_loop);
            (first, is_loop) = (outline.xy.len() as u32, words == ["loop"]);
        } else if let [Ok(x), Ok(y)] = words.iter().map(|word| word.parse::<f64>()).collect::<Vec<_>>()[..]
            && x.abs().max(y.abs()) <= 1e6
        {
            outline.xy.push(DVec2::new(x, y));
            outline.p.push(surface.point(DVec2::new(x, y)));
        }
    }
    end(&mut outline, first, is_loop);
    outline
}

/// Triangles of points and edges: neighbours know each other, the edges are there, and they count as a disc does. Whether each edge is
/// one side; one that runs through a point is there in parts.
fn fills_its_hull(all: &Triangles, outline: &Outline) -> bool {
    let mut open = 0;
    for (t, c) in all.corners.iter().enumerate() {
        for k in 0..3 {
            let other = all.across[t][k];
            if other == NO_TRIANGLE {
                open += 1;
                continue;
            }
            let j = (0..3).find(|j| all.across[other as usize][*j] as usize == t).expect("a neighbour knows its neighbour");
            let d = all.corners[other as usize];
            assert!([d[(j + 2) % 3], d[(j + 1) % 3]] == [c[(k + 1) % 3], c[(k + 2) % 3]], "neighbours share a side");
            assert_eq!(all.given[t] >> k & 1, all.given[other as usize] >> j & 1, "both say whether their side was given");
        }
    }
    assert_eq!(all.corners.len() + 2 + open, 2 * outline.xy.len(), "triangles, sides of the hull and points");
    let given: BTreeSet<(u32, u32)> = (0..all.corners.len())
        .flat_map(|t| (0..3).map(move |k| (t, k)))
        .filter(|(t, k)| all.given[*t] >> k & 1 == 1)
        .map(|(t, k)| (all.corners[t][(k + 1) % 3], all.corners[t][(k + 2) % 3]))
        .flat_map(|(a, b)| [(a, b), (b, a)])
        .collect();
    let mut whole = true;
    for [a, b] in outline.edges().filter(|[a, b]| !given.contains(&(*a, *b))) {
        let [p, q] = [a, b].map(|n| outline.xy[n as usize]);
        let on = |r: &DVec2| *r != p && *r != q && in_line(p, *r, q) && (*r - p).dot(*r - q) < 0.0;
        assert!(outline.xy.iter().any(on), "the edge from {a} to {b} is not there");
        whole = false;
    }
    whole
}

#[test]
fn mutated_files_never_break_the_triangulation() {
    let files = corpus(&["data/mutations/outlines"], &["txt"]);
    mutate("outlines", &files, (0x07A1, 150, 8), |bytes| {
        let surface = Waves(if bytes.len() % 2 == 0 { 0.0 } else { 0.3 });
        let outline = outline_of(bytes, &surface);
        if outline.loops.is_empty() {
            return false;
        }
        let whole = points(&outline.xy, &outline.edges().collect::<Vec<_>>()).is_ok_and(|all| fills_its_hull(&all, &outline));
        let (low, high) = outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), q| (a.min(*q), b.max(*q)));
        let field = UniformSize((high - low).max_element() / 12.0);
        let task = Task {
            chart_surface: &surface,
            field: &field,
            outline: &outline,
            lattice: [Lattice::Triangles, Lattice::Squares, Lattice::Tree][bytes.len() % 3],
            settings: CARE,
            most: 20_000,
            limit_check: None,
        };
        // Too much work is an answer, too.
        match Budget::new(WORK).within(|| triangulate(&task, &Job::new()).unwrap()) {
            Ok(Ok(made)) => {
                // Where an edge runs through a node the loops bound nothing, which the check of the face tells; layouts cut borders there. A
                // line may be anywhere here, in the mesher only inside.
                if whole {
                    made.triangulation.check().unwrap();
                }
                if whole && outline.lines.is_empty() {
                    sound(&made.triangulation, &outline, None).unwrap();
                }
                true
            }
            Ok(Err(_)) | Err(_) => false,
        }
    });
}
