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
use lofting::mesh::tri::build::{NodePlacement, Task, triangulate};
use lofting::mesh::tri::front::HolesInLattice;

use crate::support::long::count;
use crate::support::mutate::{Random, mutated};
use crate::support::outlines::{CARE, Waves, add_loop, sound};

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
    let cases = count("LOFT_MUTATIONS", few, 10_000);
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

/// The same tree, every number to its last bit.
fn alike(a: &Json, b: &Json) -> bool {
    match (a, b) {
        (Json::Number(x), Json::Number(y)) => x == y,
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

/// A polygon (`true`) or a polyline.
type Course = (bool, Vec<DVec2>);

/// Loops and lines of an outline: `loop` or `line` begins one, each line after it has x and y. What is none of these is left out,
/// and so are numbers far beyond those of a chart.
fn courses_of(bytes: &[u8]) -> Vec<Course> {
    let mut courses: Vec<Course> = Vec::new();
    for line in String::from_utf8_lossy(bytes).lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let numbers = words.iter().map(|word| word.parse::<f64>()).collect::<Vec<_>>();
        if let ["loop" | "line"] = words[..] {
            courses.push((words == ["loop"], Vec::new()));
        } else if let ([Ok(x), Ok(y)], Some((_, places))) = (&numbers[..], courses.last_mut())
            && x.abs().max(y.abs()) <= 1e6
        {
            places.push(DVec2::new(*x, *y));
        }
    }
    courses.retain(|(is_loop, places)| places.len() > if *is_loop { 2 } else { 1 });
    courses
}

/// The outline with steps of about a size along its loops.
fn outline_of(courses: &[Course], surface: &dyn ParametricSurface, size: f64) -> Outline {
    let mut outline = Outline::default();
    for (is_loop, places) in courses {
        if *is_loop {
            add_loop(&mut outline, surface, places, size);
            continue;
        }
        let first = outline.xy.len() as u32;
        outline.xy.extend(places);
        outline.p.extend(places.iter().map(|xy| surface.point(*xy)));
        outline.lines.extend((first..first + places.len() as u32 - 1).map(|n| [n, n + 1]));
    }
    outline
}

/// Whether an edge runs through a node, but for rounding.
fn is_met(outline: &Outline, edge: [u32; 2]) -> bool {
    let [p, q] = edge.map(|n| outline.xy[n as usize]);
    outline.xy.iter().any(|r| *r != p && *r != q && in_line(p, *r, q) && (*r - p).dot(*r - q) < 0.0)
}

/// Triangles of points and edges: neighbours know each other, the edges are there, and they count as a disc does. Whether each edge is
/// one side; one that runs through a point but for rounding need not be.
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
        assert!(is_met(outline, [a, b]), "the edge from {a} to {b} is not there");
        whole = false;
    }
    whole
}

/// Whether each edge of an outline is one side of its triangulation; `None` where it has none.
fn edges_are_sides(outline: &Outline) -> Option<bool> {
    let all = points(&outline.xy, &outline.edges().collect::<Vec<_>>()).ok()?;
    Some(fills_its_hull(&all, outline))
}

/// Taken in parts, such edges would leave loops that bound nothing.
#[test]
fn an_edge_through_a_node_is_refused() {
    for name in ["edge_through_a_node.txt", "loop_through_its_node.txt"] {
        let bytes = std::fs::read(root("data/mutations/outlines").join(name)).unwrap();
        let outline = outline_of(&courses_of(&bytes), &Waves(0.0), f64::INFINITY);
        assert_eq!(edges_are_sides(&outline), None, "{name}");
    }
}

/// Whether an outline was triangulated; panics where the triangulation is not sound.
fn triangulated(bytes: &[u8]) -> bool {
    let surface = Waves(if bytes.len().is_multiple_of(2) { 0.0 } else { 0.3 });
    let courses = courses_of(bytes);
    if !courses.iter().any(|course| course.0) {
        return false;
    }
    let given = outline_of(&courses, &surface, f64::INFINITY);
    let all = courses.iter().flat_map(|course| &course.1);
    let (low, high) = all.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), q| (a.min(*q), b.max(*q)));
    let size = (high - low).max_element() / 12.0;
    let (outline, field) = (outline_of(&courses, &surface, size), UniformSize(size));
    edges_are_sides(&given);
    edges_are_sides(&outline);
    // An edge through a node is refused (`an_edge_through_a_node_is_refused`); by rounding it may pass beside the node, on the wrong
    // side for the loops to bound anything. Layouts cut borders where they touch, so that the mesher has none.
    let meets = |outline: &Outline| outline.edges().any(|edge| is_met(outline, edge));
    if meets(&given) || meets(&outline) {
        return false;
    }
    let task = Task {
        interpolated: None,
        chart_surface: &surface,
        field: &field,
        outline: &outline,
        lattice: [NodePlacement::Triangles, NodePlacement::Squares(HolesInLattice::WithRoom), NodePlacement::Tree][bytes.len() % 3],
        settings: CARE,
        most: 20_000,
        limit_check: None,
        sliding: None,
    };
    // Too much work is an answer, too.
    match Budget::new(WORK).within(|| triangulate(&task, &Job::new()).unwrap()) {
        Ok(Ok(made)) => {
            made.triangulation.check().unwrap();
            // A line may be anywhere here, in the mesher only inside.
            if outline.lines.is_empty() {
                sound(&made.triangulation, &outline, None).unwrap();
            }
            true
        }
        Ok(Err(_)) | Err(_) => false,
    }
}

#[test]
fn mutated_outlines_make_sound_triangulations_or_say_why() {
    let files = corpus(&["data/mutations/outlines"], &["txt"]);
    mutate("outlines", &files, (0x07A1, 150, 8), triangulated);
}

/// A node grows on the border itself, of which the triangulation then has a part on each side of it.
#[test]
#[ignore = "a node grows on the border of a spike that is far longer than wide"]
fn a_thin_spike_has_a_sound_triangulation() {
    triangulated(&std::fs::read(root("data/mutations/open/thin_spike.txt")).unwrap());
}
