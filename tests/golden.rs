//! The project's own goldens, through the runner that `loft test` uses, and proof that goldens catch what they should.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use lofting::base::job::Job;
use lofting::session::golden::{CaseResult, Golden, Settings, Verdict, discover, run_all};

use crate::support::long::{sample, scripts};

/// Runs the goldens below a path.
fn test(path: &Path, accept: bool, jobs: usize) -> Vec<CaseResult> {
    let (job, clock) = (Job::new(), || 0.0);
    let tests = discover(&[path.to_owned()]).unwrap();
    let settings = Settings { accept, filter: None, jobs, clock: &clock, job: &job };
    let mut results = Vec::new();
    run_all(&tests, &settings, &mut |cases| results.extend_from_slice(cases));
    results
}

fn said(result: &CaseResult) -> String {
    let lines: Vec<String> = result.lines.iter().map(|said| said.text(false)).collect();
    format!("{}: {}\n{}\n", result.name, result.message, lines.join("\n"))
}

fn failures(results: &[CaseResult]) -> String {
    results.iter().filter(|r| !r.verdict.is_good()).map(said).collect()
}

#[test]
fn golden_models() {
    let results = test(Path::new("tests/golden"), false, 2);
    assert!(results.len() >= 25, "{} goldens", results.len());
    assert_eq!(failures(&results), "");
}

#[test]
fn examples_are_as_their_goldens_say() {
    let results = test(Path::new("examples"), false, 2);
    let scripts = fs::read_dir("examples").unwrap().flatten().filter(|e| e.path().extension().is_some_and(|e| e == "loft")).count();
    assert!(results.len() >= scripts, "an example has no golden");
    assert_eq!(failures(&results), "");
}

/// Whatever a run leaves: its files and its report, the seconds apart.
fn traces(model: &Path, threads: usize) -> Vec<(PathBuf, Vec<u8>)> {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("threads-{threads}")).join(model.with_extension(""));
    let _ = fs::remove_dir_all(&out);
    let loft = Command::new(env!("CARGO_BIN_EXE_loft"))
        .args(["run", "--json", "--keep-going", "--threads", &threads.to_string(), "-o"])
        .args([&out, model])
        .output()
        .unwrap();
    let mut report: serde_json::Value = serde_json::from_slice(&loft.stdout).unwrap_or_else(|e| panic!("{model:?}: {e}"));
    assert!(report.as_object_mut().unwrap().remove("timings").is_some());
    let mut found = vec![(PathBuf::from("report"), report.to_string().into_bytes()), (PathBuf::from("said"), loft.stderr)];
    let mut folders = vec![out.clone()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            match entry.file_type().unwrap().is_dir() {
                true => folders.push(entry.path()),
                false => found.push((entry.path().strip_prefix(&out).unwrap().to_owned(), fs::read(entry.path()).unwrap())),
            }
        }
    }
    found.sort();
    found
}

/// Reports, messages, meshes, decks and pictures have the same bytes on one thread and on eight; the shell of 32 faces on two as
/// well. An eighth of the scripts in a short run.
#[test]
fn threads_change_nothing() {
    let all = sample(scripts(&["examples", "tests/golden"]), 1);
    for model in &all {
        let one = traces(model, 1);
        let exports = fs::read_to_string(model).unwrap().lines().any(|line| line.starts_with("export "));
        assert!(!exports || one.len() > 2, "{} leaves no file", model.display());
        let counts: &[usize] = if model.ends_with("block.loft") { &[2, 8] } else { &[8] };
        for &threads in counts {
            for (a, b) in one.iter().zip(traces(model, threads)) {
                assert!(*a == b, "{}: {} is another one on {threads} threads", model.display(), a.0.display());
            }
        }
    }
    assert!(!all.is_empty());
}

/// A folder with one model, which goes when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, script: &str, head: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("golden-{name}"));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("model.loft"), script).unwrap();
        fs::write(folder.join("model.golden"), format!("loft golden 1\n{head}")).unwrap();
        Self(folder)
    }
    fn accepted(name: &str, script: &str, head: &str) -> Self {
        let folder = Self::new(name, script, head);
        let results = test(&folder.0, true, 1);
        assert_eq!(failures(&results), "");
        assert_eq!(failures(&test(&folder.0, false, 1)), "", "{}", folder.golden());
        folder
    }
    fn golden(&self) -> String {
        fs::read_to_string(self.0.join("model.golden")).unwrap()
    }
    fn write(&self, script: &str) {
        fs::write(self.0.join("model.loft"), script).unwrap();
    }
    fn said(&self) -> String {
        test(&self.0, false, 1).iter().filter(|r| !r.verdict.is_good()).map(said).collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const MODEL: &str = r#"units m
param span = 4m
curve south = line((0, 0, 0), (span, 0, 0))
curve east = line((span, 0, 0), (span, 3, 0))
curve north = arc((span, 3, 0), (0, 3, 0), through: (span / 2, 3, 1))
curve west = line((0, 3, 0), (0, 0, 0))
modeling curve eave = south + east
surface roof = coons(south, east, north, west)
shell cover of roof
group supports of south
group corner of west
mesh fine of roof { elements: triangles  size: 500mm }
check "long enough": south.length >= 3m
report "sides": [for c in [south, north]: {long: c.length, ends: c.end, name: "side"}]
export fine to "fine.obj"
export fine to "fine.inp"
"#;

/// Each kind of line, broken on purpose: what is replaced in the model, and the words that must be said.
const BREAKS: &[(&str, &str, &str)] = &[
    ("curve west", "curve extra = line((0, 0, 5), (1, 0, 5))\ncurve west", "network: curves 4 → 5"),
    ("curve west", "curve extra = line((0, 0, 5), (1, 0, 5))\ncurve west", "extra is new"),
    ("through: (span / 2, 3, 1)", "through: (span / 2, 3, 1.1)", "north: length 4.63648 → 4.76330"),
    ("curve south = line((0, 0, 0), (span, 0, 0))", "curve south = spline([(0, 0, 0), (span, 0, 0)])", "south: kind"),
    ("modeling curve eave = south + east\n", "", "modeling eave is gone"),
    ("eave = south + east", "eave = south + east + north", "modeling eave: kinks 1 → 2"),
    ("through: (span / 2, 3, 1)", "through: (span / 2, 3, 1.1)", "roof: area"),
    ("through: (span / 2, 3, 1)", "through: (span / 2, 3, 1.1)", "roof: box, upper z 1.0 → 1.1 m"),
    ("coons(south, east, north, west)", "plane(south, east, line((span, 3, 0), (0, 3, 0)), west)", "roof: kind coons → plane"),
    ("coons(south, east, north, west)", "coons(south, east, line((span, 3, 0), (0, 0, 0)))", "roof: flow quadrilateral → "),
    ("through: (span / 2, 3, 1)", "through: (span / 2, 3, 1.1)", "row \"sides 2\": cells 4.63648 m | (0, 3, 0) m | side → 4.7633 m | "),
    ("[south, north]", "[south, north, east]", "report sides: rows 2 → 3"),
    ("[south, north]", "[south, north, east]", "row \"sides 3\" is new"),
    ("name: \"side\"", "name: \"edge\"", "row \"sides 1\": cells"),
    ("long: c.length", "length: c.length", "report sides: columns long [m]"),
    ("shell cover of roof\n", "", "cover is gone"),
    ("shell cover of roof\n", "", "topology: shells 1 → 0"),
    ("through: (span / 2, 3, 1)", "through: (span / 2, 3, 1.1)", "cover: area"),
    ("size: 500mm", "size: 400mm", "mesh fine: nodes"),
    ("size: 500mm", "size: 400mm", "mesh fine: hash"),
    ("elements: triangles", "elements: quads", "mesh fine: triangles"),
    ("group corner of west\n", "", "mesh fine: group corner is gone"),
    (
        "group corner of west",
        "group corner of east",
        "mesh fine: the counts are the same, but an edge runs elsewhere or a group holds other parts",
    ),
    ("through: (span / 2, 3, 1)", "through: (span / 2, 3, 1.01)", "mesh fine: min_angle"),
    ("south.length >= 3m", "south.length >= 5m", "check \"long enough\": passed before, fails now"),
    ("south.length >= 3m", "south.length >= 5m", "error E901 is new"),
    ("size: 500mm }", "size: 500mm  on south { elements: quads } }", "warning W701 is new"),
    ("curve west", "curve south_ = lin((0, 0, 5), (1, 0, 5))\ncurve west", "error E201 is new"),
];

#[test]
fn every_kind_of_line_catches_its_break() {
    let folder = Folder::accepted("breaks", MODEL, "");
    let mut wrong = Vec::new();
    for (old, new, words) in BREAKS {
        assert!(MODEL.contains(old), "{old}");
        folder.write(&MODEL.replace(old, new));
        let said = folder.said();
        if !said.contains(words) {
            wrong.push(format!("{new}: expected {words:?} in\n{said}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn order_of_declarations_changes_nothing() {
    let folder = Folder::accepted("order", MODEL, "compare \"fine.obj\" within 1e-6mm\n");
    let mut lines: Vec<&str> = MODEL.lines().collect();
    lines[1..].reverse();
    folder.write(&format!("{}\n", lines.join("\n")));
    assert_eq!(folder.said(), "");
}

#[test]
fn a_compared_mesh_catches_a_move_of_two_tolerances() {
    let folder =
        Folder::accepted("moved", MODEL, "compare \"fine.obj\" within 2e-3mm\ncompare \"fine.inp\" within 2e-3mm\ntolerance 1e-3\n");
    folder.write(&MODEL.replace("(span / 2, 3, 1)", "(span / 2, 3, 1.000004)"));
    let said = folder.said();
    assert!(said.contains("fine.obj: ") && said.contains("nodes moved, farthest 4e-6 m at (2.0, 3.0, 1.0) (2 tolerances)"), "{said}");
    assert!(said.contains("fine.inp: line "), "{said}");
    folder.write(&MODEL.replace("(span / 2, 3, 1)", "(span / 2, 3, 1.000001)"));
    assert_eq!(folder.said(), "");
    folder.write(&MODEL.replace("size: 500mm", "size: 400mm"));
    let said = folder.said();
    assert!(said.contains("fine.obj: 88 → 117 nodes, 140 → 192 elements") && said.contains("Hausdorff distance"), "{said}");
}

/// Changes the stored copy of `fine.obj` and gives what is said about it.
fn with_copy(name: &str, within: &str, change: &dyn Fn(&mut Vec<String>)) -> String {
    let folder = Folder::accepted(name, MODEL, &format!("compare \"fine.obj\" within {within}\n"));
    let copy = folder.0.join("model.golden.d/fine.obj");
    let mut lines: Vec<String> = fs::read_to_string(&copy).unwrap().lines().map(str::to_owned).collect();
    change(&mut lines);
    fs::write(&copy, lines.join("\n") + "\n").unwrap();
    folder.said()
}

/// Lines that begin with a word: their places.
fn places(lines: &[String], word: &str) -> Vec<usize> {
    (0..lines.len()).filter(|k| lines[*k].split(' ').next() == Some(word)).collect()
}

#[test]
fn one_node_moved_by_two_tolerances_is_caught() {
    let moved = |by: f64| {
        move |lines: &mut Vec<String>| {
            let at = places(lines, "v")[40];
            let mut xyz: Vec<f64> = lines[at].split(' ').skip(1).map(|x| x.parse().unwrap()).collect();
            xyz[2] += by;
            lines[at] = format!("v {} {} {}", xyz[0], xyz[1], xyz[2]);
        }
    };
    let said = with_copy("node", "1e-3mm", &moved(2e-6));
    assert!(said.contains("fine.obj: 1 node moved") && said.contains("(2 tolerances)"), "{said}");
    assert_eq!(with_copy("node", "1e-3mm", &moved(0.5e-6)), "");
}

#[test]
fn one_flipped_edge_is_caught() {
    let said = with_copy("flipped", "1e-3mm", &|lines| {
        let faces = places(lines, "f");
        let nodes = |k: usize| -> Vec<String> { lines[k].split(' ').skip(1).map(str::to_owned).collect() };
        // Two triangles with a common edge get the other diagonal of their quadrilateral.
        let (a, b, common) = faces
            .iter()
            .flat_map(|&a| faces.iter().map(move |&b| (a, b)))
            .map(|(a, b)| (a, b, nodes(a).into_iter().filter(|n| nodes(b).contains(n)).collect::<Vec<_>>()))
            .find(|(a, b, common)| a < b && common.len() == 2)
            .unwrap();
        let other = |k: usize| nodes(k).into_iter().find(|n| !common.contains(n)).unwrap();
        let (p, q) = (other(a), other(b));
        let at = nodes(a).iter().position(|n| *n == p).unwrap();
        let (next, last) = (nodes(a)[(at + 1) % 3].clone(), nodes(a)[(at + 2) % 3].clone());
        (lines[a], lines[b]) = (format!("f {p} {next} {q}"), format!("f {p} {q} {last}"));
    });
    assert!(said.contains("fine.obj: the nodes are the same, but 2 elements became 2 others"), "{said}");
}

#[test]
fn a_lost_group_is_caught() {
    let said = with_copy("group", "1e-3mm", &|lines| {
        let at = *places(lines, "g").last().unwrap();
        lines[at] = "g other".to_owned();
    });
    assert!(said.contains("fine.obj: ") && said.contains("other"), "{said}");
}

#[test]
fn other_numbers_of_nodes_and_elements_change_nothing() {
    let said = with_copy("renumbered", "1e-6mm", &|lines| {
        let (nodes, faces) = (places(lines, "v"), places(lines, "f"));
        let n = nodes.len();
        // 7 and the number of nodes have no factor in common, so this is a permutation.
        assert!(n % 7 != 0);
        let to = |k: usize| (7 * k + 3) % n;
        let old = lines.clone();
        nodes.iter().enumerate().for_each(|(k, at)| lines[nodes[to(k)]] = old[*at].clone());
        for (k, at) in faces.iter().rev().enumerate() {
            let corners: Vec<usize> = old[*at].split(' ').skip(1).map(|x| to(x.parse::<usize>().unwrap() - 1) + 1).collect();
            lines[faces[k]] = format!("f {} {} {}", corners[1], corners[2], corners[0]);
        }
    });
    assert_eq!(said, "");
}

#[test]
fn cases_have_sections_and_tell_what_is_missing_or_orphaned() {
    let head = "case \"long\": span = 6m\ncase \"short\": span = 3m // the least\n";
    let folder = Folder::accepted("cases", MODEL, head);
    let golden = folder.golden();
    assert!(golden.contains("case \"short\": span = 3m // the least\n") && golden.contains("\n[long]\n") && golden.contains("\n[short]\n"));
    let put = |text: &str| fs::write(folder.0.join("model.golden"), text).unwrap();
    put(&golden.replace("case \"long\": span = 6m\n", "case \"longer\": span = 7m\n"));
    let verdicts: Vec<Verdict> = test(&folder.0, false, 1).iter().map(|r| r.verdict).collect();
    assert_eq!(verdicts, [Verdict::Missing, Verdict::Passed, Verdict::Orphaned]);
    put(&golden.replace("span = 6m", "span = 6.1m"));
    let said = folder.said();
    assert!(said.contains("model.loft [long]") && said.contains("south: length 6.0 → 6.1 m") && !said.contains("[short]"), "{said}");
}

#[test]
fn the_maker_is_named_first_when_something_differs() {
    let folder = Folder::accepted("maker", MODEL, "made by loft 0.0.9 mesher 0\n");
    let signed = folder.golden();
    assert!(signed.contains(&format!("made by loft {} mesher {}\n", env!("CARGO_PKG_VERSION"), lofting::mesh::VERSION)), "{signed}");
    let old = signed.replace(&format!("loft {} mesher {}", env!("CARGO_PKG_VERSION"), lofting::mesh::VERSION), "loft 0.0.9 mesher 0");
    fs::write(folder.0.join("model.golden"), &old).unwrap();
    assert_eq!(folder.said(), "", "the maker alone is no difference");
    folder.write(&MODEL.replace("size: 500mm", "size: 400mm"));
    let said = folder.said();
    assert!(said.lines().nth(1).unwrap().contains("made by loft 0.0.9 mesher 0, compared by loft"), "{said}");
    assert!(said.lines().nth(1).unwrap().contains("the mesher has another version"), "{said}");
}

#[test]
fn comments_and_head_survive_accepting() {
    let folder = Folder::accepted("comments", MODEL, "// why\ntolerance 1e-6 // enough\n");
    let text = folder.golden().replace("curve south", "// the long side\ncurve south").replace("\ncurve north", "  // east\ncurve north");
    fs::write(folder.0.join("model.golden"), format!("{text}// the end\n")).unwrap();
    folder.write(&MODEL.replace("span = 4m", "span = 5m"));
    test(&folder.0, true, 1);
    let golden = folder.golden();
    for part in [
        "// why\n",
        "tolerance 1e-6 // enough\n",
        "\n// the long side\ncurve south  kind line  length 5 m",
        "  // east\n",
        "\n// the end\n",
    ] {
        assert!(golden.contains(part), "{part} in\n{golden}");
    }
    let results = test(&folder.0, true, 1);
    assert!(results.iter().all(|r| r.verdict == Verdict::Passed) && folder.golden() == golden, "accepting again changes nothing");
}

#[test]
fn hand_edited_goldens_are_told_where_they_are_wrong() {
    let check = |head: &str, body: &str, expected: &str| {
        let folder = Folder::new("flaws", "curve c = line((0, 0, 0), (1mm, 0, 0))\n", &format!("{head}\n{body}\n"));
        let said = folder.said();
        assert!(said.contains(expected), "expected {expected:?} in {said}");
    };
    check("tolerance small", "", "model.golden:2: expected a number of at least 0");
    check("compare hall.obj within 1mm", "", "model.golden:2: expected `compare \"hall.obj\" within 1e-6mm`");
    check("compare \"../hall.obj\" within 1mm", "", "does not lie in the folder of outputs");
    check("case \"a\": n 4", "", "model.golden:2: expected `case \"long\": span = 50m, n = 4`");
    check("case \"../a\": n = 4", "", "cannot name a case");
    check("case \"a\": n = 4\ncase \"A\": n = 5", "", "model.golden:3: there is a case \"A\" already");
    check("made of loft", "", "model.golden:2: expected `made by loft");
    check("", "curve c  length 1", "model.golden:3: `length` needs a number and its unit like `12.5 m`");
    check("", "curve c  lenght 1 mm", "model.golden:3: `lenght` is not a word of a curve line");
    check("", "curv c  length 1 mm", "model.golden:3: no line of a golden file begins with `curv`");
    check("", "curve c  length 1 mm\ntolerance 1e-6", "model.golden:4: `tolerance` belongs into the head");
    check("", "[a", "model.golden:3: expected the name of a case");
    for (text, expected) in [("", ":1: a golden file begins with"), ("loft golden 2\n", "version 2, and this loft reads version 1")] {
        let folder = Folder::new("flaws", "", "");
        fs::write(folder.0.join("model.golden"), text).unwrap();
        assert!(folder.said().contains(expected), "{}", folder.said());
    }
    let folder = Folder::new("flaws", "", "");
    fs::write(folder.0.join("model.golden"), b"loft golden 1\n\n\xff\n").unwrap();
    assert!(folder.said().contains(":3: this is not UTF-8 text"), "{}", folder.said());
}

/// The page of E902 shows what is said, to the letter.
#[test]
fn the_page_of_the_code_is_true() {
    let page = fs::read_to_string("docs/codes/E902.md").unwrap();
    let block = |kind: &str| page.split(&format!("```{kind}\n")).nth(1).unwrap().split("```").next().unwrap();
    let folder = Folder::new("page", block("loft"), "");
    fs::write(folder.0.join("model.golden"), block("golden")).unwrap();
    let results = test(&folder.0, false, 1);
    let lines: Vec<String> = results[0].lines.iter().map(|s| s.text(false)).collect();
    let text = format!("E902 × {}\n{}\n  help: {}\n", results[0].message, lines.join("\n"), results[0].help.as_deref().unwrap());
    assert_eq!(text.replace(&format!("{}/", folder.0.display()), ""), block("text"));
}

/// The golden file that the guide shows is one.
#[test]
fn the_guide_shows_a_golden() {
    let guide = fs::read_to_string("docs/guide/checks-and-goldens.md").unwrap();
    let text = guide.split("```golden\n").nth(1).unwrap().split("```").next().unwrap();
    let (golden, flaws) = Golden::parse(text.as_bytes()).unwrap();
    assert_eq!((flaws.as_slice(), golden.sections.len(), golden.text().lines().count()), (&[][..], 1, text.lines().count()));
}
