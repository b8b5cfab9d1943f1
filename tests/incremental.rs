//! A run that takes over what earlier runs found says, measures and writes the same as one that starts from nothing.

use std::fs;
use std::path::{Path, PathBuf};

use lofting::base::job::Job;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;
use lofting::session::json::report_text;
use lofting::session::kept::Kept;
use lofting::session::run::{Again, Outcome, Task, run, run_again};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::support::long::count;

/// What a run took over: results, and of these the faces of meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reused {
    all: usize,
    faces: usize,
}

/// A folder with the examples' data beside the script.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("incremental-{name}"));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("data")).unwrap();
        let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
        for entry in fs::read_dir(examples.join("data")).unwrap() {
            let path = entry.unwrap().path();
            fs::copy(&path, folder.join("data").join(path.file_name().unwrap())).unwrap();
        }
        fs::write(folder.join("post.loft"), POST).unwrap();
        Self(folder)
    }

    fn run(&self, text: &str, out: &str, kept: Option<&mut Kept>) -> (String, Vec<(String, Vec<u8>)>, Reused) {
        let script = self.0.join("model.loft");
        let out = self.0.join(out);
        let disk = Disk::new(Some(&script), Some(&out), &[], Outputs::Written).unwrap();
        let clock = || 0.0;
        let task = Task {
            name: "model.loft",
            text: text.as_bytes(),
            shared: None,
            sets: &[],
            row: None,
            strict: false,
            keep_going: true,
            full: true,
            curves: true,
            picture: None,
            clock: &clock,
        };
        let job = Job::default();
        let outcome: Outcome = match kept {
            Some(kept) => guarded(|| run_again(&task, &disk, &job, Again { kept, light: false, look: &mut |_| {}, shaped: None })).unwrap(),
            None => guarded(|| run(&task, &disk, &job)).unwrap(),
        };
        let mut files: Vec<(String, Vec<u8>)> =
            outcome.report.outputs.iter().map(|o| (o.path.clone(), fs::read(out.join(&o.path)).unwrap())).collect();
        files.sort();
        let said = format!(
            "{}\n{}\n{}\n{:?}",
            report_text(&outcome.report),
            outcome.drawn(false, true),
            outcome.notes.join("\n"),
            outcome.tolerance
        );
        (said, files, Reused { all: outcome.reused, faces: outcome.reused_faces })
    }

    /// Runs both ways and compares; the number of results that were taken over.
    fn check(&self, text: &str, kept: &mut Kept) -> usize {
        self.reused(text, kept).all
    }

    /// The same with what was taken over.
    fn reused(&self, text: &str, kept: &mut Kept) -> Reused {
        let (cold, cold_files, _) = self.run(text, "cold", None);
        let (warm, warm_files, reused) = self.run(text, "warm", Some(kept));
        if let Some((a, b)) = cold.lines().zip(warm.lines()).find(|(a, b)| a != b) {
            panic!("cold: {a}\nwarm: {b}\nof this script:\n{text}");
        }
        assert_eq!(cold.lines().count(), warm.lines().count(), "more was said in one of the runs of\n{text}");
        assert!(cold_files == warm_files, "files differ for\n{text}");
        reused
    }
}

fn example(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name)).unwrap()
}

/// A measured sheet whose borders miss each other a little, beside a module with measured borders of its own.
const MEASURED: &str = r#"units m
use "post.loft" as post
snap 1mm
param rise = 2m
point A = (0, 0, 0)
point top = (2, 1.5, rise)
curve south = line(A, (4, 0, 0))
curve east = spline([(4, 0.0004, 0), (4.1, 1.5, 0.2), (4, 3, 0)])
curve north = line((4, 3.0002, 0), (0, 3, 0.0003))
curve west = line((0, 3, 0), (0, 0, 0.0002))
curve tie for i in 0..3 = line((6 + i, 0, 0), (7 + 1.0002 * i, 0.0001 * i, 0))
curve apart = line((9, 9, 9), top)
let corners = [for t in tie: t.end]
curve lead = spline([corners[0], corners[1], corners[2]])
curve stub = line(corners[1] + (0, 0.0003, 0), (8, 8, rise))
curve far = line(stub.end, lead.mid)
point hung = stub.start
let before = south.length + apart.length + post.foot.length
surface slab = coons(south, east, north, west)
let cut = east.at(50%)
curve rib = line(cut, west.at(50%))
let corner = east & north
use "post.loft" (height: before * 0.01) as other
curve lean = line(other.foot.end, lead.start)
curve stay = post.foot
shell skin of slab
group edges of east, tie[0], tie[2]
mesh fine of slab { size: 0.5 }
check "closed": (south & east).z == 0m within 1mm
check "rise": rise > 1m
check "area": area(slab) > 11m2
check "stands": hung == tie[1].end within 1um
check "leans": lean.start == other.rest.start within 1um
report "lengths": [{east: east.length, before: before, stay: post.foot.length + corner.x}]
export fine to "fine.obj"
"#;

/// The module of [`MEASURED`].
const POST: &str = "units mm\nsnap 2mm\nparam height = 500mm\ncurve foot = line((0, 0, 0), (0, 0, height))\ncurve rest = line((0, 1, height), (0, 400, height))\ncheck foot.end == (0, 0.5, height) within 1um\n";

/// Starts of declarations, as lines.
fn starts(lines: &[String]) -> Vec<usize> {
    const WORDS: &[&str] = &[
        "snap ",
        "param ",
        "let ",
        "point ",
        "curve ",
        "modeling ",
        "surface ",
        "shell ",
        "group ",
        "mesh ",
        "check ",
        "report ",
        "export ",
    ];
    (0..lines.len()).filter(|i| WORDS.iter().any(|w| lines[*i].starts_with(w))).collect()
}

/// One edit of a script, chosen by three numbers.
fn edited(text: &str, kind: u8, place: usize, amount: u32) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let starts = starts(&lines);
    if starts.is_empty() {
        return text.to_owned();
    }
    let nth = place % starts.len();
    let at = starts[nth];
    let end = starts.get(nth + 1).copied().unwrap_or(lines.len());
    match kind % 8 {
        // A number changes.
        0 | 1 => {
            if let Some(k) = lines[at].rfind(|c: char| c.is_ascii_digit()) {
                let digit = char::from_digit(amount % 9 + 1, 10).unwrap();
                lines[at].replace_range(k..=k, &digit.to_string());
            }
        }
        // A declaration goes.
        2 => {
            lines.drain(at..end);
        }
        // A declaration moves to the end.
        3 => {
            let moved: Vec<String> = lines.drain(at..end).collect();
            lines.extend(moved);
        }
        // A comment, above and inside.
        4 => {
            lines[at].push_str(" // changed");
            lines.insert(at, format!("// note {amount}"));
        }
        // Something new.
        5 => lines.insert(at, format!("curve new_{amount} = line(({amount}mm, 0, 0), (0, {amount}mm, 3mm))")),
        // A declaration breaks.
        6 => lines[at].push_str(" ("),
        // Blanks.
        _ => lines[at] = lines[at].replace(" = ", "  =  "),
    }
    lines.join("\n") + "\n"
}

#[test]
fn random_edits_of_the_examples_give_what_a_fresh_run_gives() {
    let folder = Folder::new("edits");
    const EXAMPLES: &[&str] = &["porch.loft", "barrel_vault.loft", "tank.loft", "canopy.loft", "wing.loft", "greenhouse.loft", ""];
    // Sequences of edits in all.
    let wanted = count("LOFT_EDITS", 12, 200) as u32;
    let cases = wanted.div_ceil(EXAMPLES.len() as u32);
    let sequences = std::cell::Cell::new(0);
    for name in EXAMPLES {
        let base = if name.is_empty() { MEASURED.to_owned() } else { example(name) };
        let config = Config { cases, max_shrink_iters: 40, failure_persistence: None, ..Config::default() };
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
        let mut runner = TestRunner::new_with_rng(config, rng);
        let edits = proptest::collection::vec((0u8..8, 0usize..64, 0u32..100), 1..6);
        runner
            .run(&edits, |edits| {
                sequences.set(sequences.get() + 1);
                let mut kept = Kept::default();
                let mut states = vec![base.clone()];
                folder.check(&base, &mut kept);
                for (kind, place, amount) in edits {
                    // Some edits are taken back, as by an undo.
                    let from = if amount % 5 == 0 { 0 } else { states.len() - 1 };
                    let next = edited(&states[from], kind, place, amount);
                    folder.check(&next, &mut kept);
                    states.push(next);
                }
                Ok(())
            })
            .unwrap();
    }
    assert!(sequences.get() >= wanted, "{} sequences of edits", sequences.get());
}

#[test]
fn what_did_not_change_is_taken_over() {
    let folder = Folder::new("reuse");
    let base = example("porch.loft");
    let mut kept = Kept::default();
    assert_eq!(folder.check(&base, &mut kept), 0);
    let all = folder.check(&base, &mut kept);
    // Every declaration that can be kept, the network, the model and the mesh.
    assert!(all >= 20, "{all} results were taken over");
    let commented = base.replace("surface ", "// a comment\nsurface ");
    assert_eq!(folder.check(&commented, &mut kept), all);
}

#[test]
fn what_snap_moved_is_taken_over() {
    let folder = Folder::new("snap");
    let mut kept = Kept::default();
    let cold = folder.run(MEASURED, "cold", None).0;
    assert!(cold.contains("\"ok\": true"), "{cold}");
    assert!(cold.contains("N513"), "{cold}");
    folder.check(MEASURED, &mut kept);
    let all = folder.check(MEASURED, &mut kept);
    // All but the loaded script and the export, what stands on curves before and after; stages and the mesh.
    assert!(all >= 30, "{all} results were taken over");
    // An end that goes elsewhere changes what stands on it, and nothing else.
    let nudged = MEASURED.replace("(7 + 1.0002 * i,", "(7 + 1.0003 * i,");
    assert_ne!(nudged, MEASURED);
    let some = folder.check(&nudged, &mut kept);
    assert!(some < all && some >= 20, "{some} of {all} results were taken over");
    // Another distance, at which one corner stays open; then ends that cannot move.
    folder.check(&MEASURED.replace("snap 1mm", "snap 0.3mm"), &mut kept);
    folder.check(&MEASURED.replace("snap 1mm\n", ""), &mut kept);
    let stuck = "curve a = arc(center: (0, 0, 5), start: (1, 0, 5), angle: 90deg, normal: Z)\ncurve b = arc(center: (0, 0.0005, 5), start: (1, 0.0005, 5), angle: -90deg, normal: Z)\n";
    folder.check(&format!("{MEASURED}{stuck}"), &mut kept);
    // Of the stages only the last ones are kept.
    assert!(folder.check(MEASURED, &mut kept) + 2 >= all);
    assert_eq!(folder.check(MEASURED, &mut kept), all);
}

/// A sheet of 5 × 10 faces whose borders stay; inside one of them a curve is lifted by `lift`. A second mesh has chord and
/// angle limits, a third is of quads, a fourth of order 2 on three-sided faces.
fn sheet(lift: f64) -> String {
    // The mast keeps the size of the model, and with it the tolerance.
    let mut text = format!("units m\nparam lift = {lift}m\ncurve mast = line((9, 9, 0), (9, 9, 5))\n");
    for j in 0..=10 {
        for i in 0..=5 {
            let at = |i: usize, j: usize| format!("({i}, {j}, 0)");
            if i < 5 {
                text += &format!("curve u{i}_{j} = arc({}, {}, through: ({i}.5, {j}, 0.2))\n", at(i, j), at(i + 1, j));
            }
            if j < 10 {
                text += &format!("curve v{i}_{j} = arc({}, {}, through: ({i}, {j}.5, 0.2))\n", at(i, j), at(i, j + 1));
            }
        }
    }
    text += "curve inner = arc(v2_4.at(0.5), v3_4.at(0.5), through: (2.5, 4.5, 400mm + lift))\n";
    let mut names = Vec::new();
    for j in 0..10 {
        for i in 0..5 {
            let more = if (i, j) == (2, 4) { ", inner" } else { "" };
            text += &format!("surface s{i}_{j} = coons(u{i}_{j}, v{}_{j}, u{i}_{}, v{i}_{j}{more})\n", i + 1, j + 1);
            names.push(format!("s{i}_{j}"));
        }
    }
    let all = names.join(", ");
    text += "curve slant = line((0, 0, 0), (0.5, -1, 0))\ncurve back = line((0.5, -1, 0), (1, 0, 0))\nsurface beak = coons(u0_0, slant, back)\n";
    text += &format!("mesh plain of {all} {{ size: 0.5 }}\nmesh close of {all} {{ size: 0.6  chord_error: 10mm  angle_error: 20deg }}\n");
    text + &format!(
        "mesh squares of {all} {{ size: 0.5  elements: quads }}\nmesh six of {all}, beak {{ size: 0.5  order: 2 }}\nexport six to \"six.vtu\"\n"
    )
}

#[test]
fn faces_that_did_not_change_are_taken_over() {
    let folder = Folder::new("faces");
    let mut kept = Kept::default();
    // The rounds of one mesh share faces too.
    let first = folder.reused(&sheet(0.0), &mut kept);
    assert_eq!(first.all, first.faces);
    let same = folder.reused(&sheet(0.0), &mut kept);
    assert_eq!(same.faces, 0, "whole meshes are taken over");
    let changed = folder.reused(&sheet(0.01), &mut kept);
    // 49 of each of the first three and 50 of the last one; further rounds meet their faces again.
    assert!(changed.faces >= 49 * 3 + 50 && first.faces < 49 * 3, "{first:?} {changed:?}");
    assert!(changed.all - changed.faces > 160, "{changed:?}");
    // What was taken back is there as a whole.
    assert_eq!(folder.reused(&sheet(0.0), &mut kept).faces, 0);
}

/// A sheet of 3 × 3 faces that are made freely, in every way there is; inside one of them a curve is lifted by `lift`, and
/// `more` stands at the end of each mesh.
fn loose(lift: f64, more: &str) -> String {
    let mut text = format!("units m\nparam lift = {lift}m\ncurve mast = line((9, 9, 0), (9, 9, 5))\n");
    for j in 0..=3 {
        for i in 0..=3 {
            let at = |i: usize, j: usize| format!("({i}, {j}, 0)");
            if i < 3 {
                text += &format!("curve u{i}_{j} = arc({}, {}, through: ({i}.5, {j}, 0.2))\n", at(i, j), at(i + 1, j));
            }
            if j < 3 {
                text += &format!("curve v{i}_{j} = arc({}, {}, through: ({i}, {j}.5, 0.2))\n", at(i, j), at(i, j + 1));
            }
        }
    }
    text += "curve inner = arc(v1_1.at(0.5), v2_1.at(0.5), through: (1.5, 1.5, 400mm + lift))\npoint peg = (0.5, 0.5, 0)\n";
    let mut names = Vec::new();
    for (i, j) in (0..9).map(|k| (k % 3, k / 3)) {
        let rib = if (i, j) == (1, 1) { ", inner" } else { "" };
        text += &format!("surface s{i}_{j} = coons(u{i}_{j}, v{}_{j}, u{i}_{}, v{i}_{j}{rib})\n", i + 1, j + 1);
        names.push(format!("s{i}_{j}"));
    }
    let all = names.join(", ");
    for (k, says) in [
        "method: delaunay  near peg { size: 0.2 }",
        "method: delaunay  chord_error: 40mm",
        "method: quadtree  order: 2",
        "method: isoline  chord_error: 40mm",
        "method: delaunay  elements: quads",
        "method: delaunay  on s0_0 { method: mapped }  on s1_1 { method: mapped }",
    ]
    .into_iter()
    .enumerate()
    {
        text += &format!("mesh m{k} of {all} {{ size: 0.5  {says}  {more} }}\n");
    }
    text + "export m0 to \"m0.vtu\"\n"
}

#[test]
fn free_faces_that_did_not_change_are_taken_over() {
    let folder = Folder::new("free-faces");
    let mut kept = Kept::default();
    let first = folder.reused(&loose(0.0, ""), &mut kept);
    let changed = folder.reused(&loose(0.01, ""), &mut kept);
    // All but the face in the middle; under a chord error its bends pace the borders of its neighbours too.
    assert!(changed.faces >= 4 * 8 && first.faces < 8, "{first:?} {changed:?}");
    assert_eq!(folder.reused(&loose(0.0, ""), &mut kept).faces, 0, "what was taken back is there as a whole");
    // What a free face depends on, and what it does not.
    let other = folder.reused(&loose(0.0, "smooth: 2"), &mut kept);
    assert!(other.faces < 14, "mapped ones alone: {other:?}");
    let named = folder.reused(&loose(0.0, "").replace("s2_2", "corner"), &mut kept);
    assert!(named.faces >= 4 * 8, "{named:?}");
}

/// What a run says, by report: the message, the first label, help and notes.
fn told(text: &str, kept: Option<&mut Kept>) -> Vec<(String, String, Option<String>, usize)> {
    let disk = Disk::new(Some(Path::new("model.loft")), None, &[], Outputs::Counted).unwrap();
    let (clock, job) = (|| 0.0, Job::default());
    let task = Task {
        name: "model.loft",
        text: text.as_bytes(),
        shared: None,
        sets: &[],
        row: None,
        strict: false,
        keep_going: false,
        full: true,
        curves: true,
        picture: None,
        clock: &clock,
    };
    let outcome = match kept {
        Some(kept) => run_again(&task, &disk, &job, Again { kept, light: false, look: &mut |_| {}, shaped: None }),
        None => run(&task, &disk, &job),
    };
    let line =
        |d: &lofting::lang::diag::diagnostic::Diagnostic| (d.message.clone(), d.labels[0].text.clone(), d.help.clone(), d.fixes.len());
    outcome.diagnostics.iter().map(line).collect()
}

/// Names that an unknown one is compared with are counted: beyond the first reports their number has a bound, and which
/// reports say what was meant depends on places alone, not on what is evaluated first or was taken over.
#[test]
fn unknown_names_are_compared_a_bounded_number_of_times() {
    const BOUND: usize = 50_000;
    let scripts: [fn(usize) -> String; 2] = [
        |n| (0..n).map(|k| format!("let a{k:05} = b{k:05}\n")).collect(),
        |n| (0..n).map(|k| format!("fn a{k:05}(x: number): number = x\nlet v{k} = b{k:05}(1)\n")).collect(),
    ];
    for script in scripts {
        for n in [15, 300, 2400] {
            // The first one asks for what stands behind all others, and for the tolerance.
            let text = format!("units m\nlet first = [curve_of(z), line((0, 0, 0), (1, 0, 0)).length]\n{}", script(n));
            let text = format!("{}let z = first_z\n", text.replace("curve_of(z)", "z"));
            let found = told(&text, None);
            let near = |d: &(String, String, Option<String>, usize)| d.1.starts_with("did you mean `a");
            let said = found.iter().filter(|d| near(d)).count();
            assert_eq!(found.len(), n + 1, "{:?}", found.last());
            assert!(found.iter().take(20.min(n)).all(near), "{n}: {:?}", &found[..3]);
            assert!(said >= 20.min(n) && said * n <= BOUND + 30 * n, "{said} of {n}");
            assert!(found.iter().all(|d| d.1.starts_with("did you mean") == (d.3 == 1)));
            let mut kept = Kept::default();
            assert!((0..2).all(|_| told(&text, Some(&mut kept)) == found), "{n}");
        }
    }
}
