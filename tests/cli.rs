//! The commands as a user runs them: transcripts in `tests/cli/*.md`, and runs that write files in folders of their own.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

#[test]
fn transcripts() {
    trycmd::TestCases::new().case("tests/cli/*.md");
}

/// A folder that goes when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("loft-cli-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
    fn with(self, name: &str, text: impl AsRef<[u8]>) -> Self {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
        self
    }
    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
    /// All files below it with their bytes, in order of their paths.
    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let mut found = Vec::new();
        let mut folders = vec![self.0.clone()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap().flatten() {
                if entry.path().is_dir() {
                    folders.push(entry.path());
                } else {
                    let name = entry.path().strip_prefix(&self.0).unwrap().to_string_lossy().into_owned();
                    found.push((name, fs::read(entry.path()).unwrap()));
                }
            }
        }
        found.sort();
        found
    }
    fn names(&self) -> Vec<String> {
        self.files().into_iter().map(|(name, _)| name).collect()
    }
    fn loft(&self, arguments: &[&str]) -> Run {
        run(&self.0, arguments, None)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

struct Run {
    status: i32,
    out: String,
    err: String,
}

impl Run {
    fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|e| panic!("{e}\n{}\n{}", self.out, self.err))
    }
}

fn run(folder: &Path, arguments: &[&str], input: Option<&[u8]>) -> Run {
    let mut command = Command::new(env!("CARGO_BIN_EXE_loft"));
    command.args(arguments).current_dir(folder).env_remove("NO_COLOR");
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // A program that ends before it has read everything closes the pipe.
    let _ = child.stdin.take().unwrap().write_all(input.unwrap_or_default());
    let Output { status, stdout, stderr } = child.wait_with_output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Run { status: status.code().unwrap_or(-1), out: text(stdout), err: text(stderr) }
}

const PLATE: &str = r#"units m
param width = 4m in 1m to 20m
param n: count = 4
curve south = line((0, 0), (width, 0))
curve east = line((width, 0), (width, 3))
curve north = line((width, 3), (0, 3))
curve west = line((0, 3), (0, 0))
surface plate = coons(south, east, north, west)
mesh m of plate { elements: quads  size: 1m  on south { count: n } }
check "area": m.area == plate.area within 1e-9%
export m to "plate.stl"
export m to "deck/plate.inp"
export [for i in 0..2: {i: i, x: i * width}] to "rows.csv"
export south, east to "edges.obj"
"#;

/// The curves of figure 2.2 of [Koh & Park 1990] with its two surfaces.
const FIGURE: &str = r#"units m
curve c1 = line((0, 0, 0), (8, 0, 0))
curve c2 = line((0, 6, 0), (4, 6, 2))
curve c3 = line((4, 6, 2), (8, 6, 0))
curve c4 = line((0, 0, 0), (0, 3, 1.5))
curve c5 = line((0, 3, 1.5), (0, 6, 0))
curve c6 = line((8, -6, -3), (8, 3, 1.5))
curve c7 = line((8, 3, 1.5), (8, 6, 0))
curve c8 = arc((4, -2, -4), (4, 6, 2), through: (4, 0, 0))
curve c9 = line((4, -2, -4), (4, -5, -6))
curve c10 = line((4, -5, -6), (8, -6, -3))
surface B = transfinite(u: [c1, c2 + c3], v: [c4 + c5, c8[c1..], c6[c1..] + c7])
surface A = transfinite(u: [c1[c8..], c10], v: [-c8[..c1] + c9, -c6[..c1]])
check B.at(0.25, 0.25) == (2.0m, 1.336889741548617m, 0.8237571625565923m) within 1e-9m
check B.at(0.6, 0.9) == (4.8m, 5.349625821917142m, 1.7040216674395747m) within 1e-9m
check A.at(0.5, 0.75) == (6.0m, -3.90174643594872m, -3.5594976239658127m) within 1e-9m
"#;

#[test]
fn the_figure_of_the_paper_has_its_counts() {
    let folder = Folder::new("figure").with("figure.loft", FIGURE);
    let run = folder.loft(&["run", "figure.loft", "--json"]);
    let report = run.json();
    assert_eq!(run.status, 0, "{}", run.err);
    assert_eq!(report["network"], serde_json::json!({ "curves": 10, "links": 13, "nodes": 11 }));
    assert_eq!(report["modeling"].as_array().unwrap().len(), 9);
    assert_eq!(report["topology"], serde_json::json!({ "patches": 6, "edges": 18, "vertices": 13, "shells": 0 }));
    assert!(report["checks"].as_array().unwrap().iter().all(|c| c["pass"] == true));
}

#[test]
fn a_run_writes_its_files_and_tells_about_them() {
    let folder = Folder::new("run").with("plate.loft", PLATE);
    let run = folder.loft(&["run", "plate.loft", "-o", "out"]);
    assert_eq!((run.status, run.err.as_str()), (0, ""), "{}", run.out);
    assert_eq!(folder.names(), ["out/deck/plate.inp", "out/edges.obj", "out/plate.stl", "out/rows.csv", "plate.loft"]);
    assert_eq!(folder.read("out/plate.stl").len(), 84 + 50 * 24);
    assert_eq!(String::from_utf8(folder.read("out/rows.csv")).unwrap(), "i,x\n0,0m\n1,4m\n");
    for part in ["4 curves, 4 links, 4 nodes", "plate    coons  quadrilateral", "pass  area", "wrote out/plate.stl  1.3 kB"] {
        assert!(run.out.contains(part), "{part} is missing in\n{}", run.out);
    }
}

#[test]
fn outputs_go_beside_the_script_by_default() {
    let folder = Folder::new("beside").with("models/plate.loft", PLATE);
    let run = folder.loft(&["run", "models/plate.loft"]);
    assert_eq!(run.status, 0);
    assert!(folder.path("models/plate.stl").exists());
    // Where a file went is told as seen from where the program was started, and in full from elsewhere.
    assert!(run.out.contains("wrote models/plate.stl") && run.out.contains("wrote models/deck/plate.inp"), "{}", run.out);
    let elsewhere = Folder::new("elsewhere");
    let script = folder.path("models/plate.loft");
    let run = elsewhere.loft(&["run", script.to_str().unwrap()]);
    let place = script.parent().unwrap().canonicalize().unwrap().join("plate.stl");
    assert!(run.out.contains(&format!("wrote {}", place.display())), "{}", run.out);
}

#[test]
fn outputs_that_are_one_file_are_an_error_before_anything_is_written() {
    let head = "units m\ncurve s = line((0, 0), (2, 0))\ncurve n = line((0, 1), (2, 1))\nsurface p = ruled(s, n)\n\
                mesh a of p { size: 1m }\nmesh b of p { size: 500mm }\n";
    let folder = Folder::new("one-file").with("rows.csv", "x [m],y [m]\n0,0\n1,1\n").with("ribs.loft", "units m\nlet x = 1m\n");
    let check = |name: &str, outputs: &str, code: &str, words: &str| {
        let file = format!("{name}.loft");
        fs::write(folder.path(&file), format!("{head}{outputs}")).unwrap();
        let before = folder.files();
        for command in [&["run"][..], &["check"], &["run", "--json"], &["run", "--keep-going"]] {
            let run = folder.loft(&[command, &[file.as_str()]].concat());
            assert_eq!(run.status, 1, "{name}");
            assert!(run.err.contains(&format!("{code} ×")) && run.err.contains(words), "{name}: {}", run.err);
        }
        assert!(folder.files() == before, "{name} wrote something");
    };
    check("twice", "export a to \"x.inp\"\nexport b to \"x.inp\"\n", "E812", "2 outputs are one file, \"x.inp\"");
    check("case", "export a to \"x.inp\"\nexport b to \"X.INP\"\n", "E812", "upper and lower case");
    check("roundabout", "export a to \"x.inp\"\nexport b to \"d/../x.inp\"\n", "E812", "\"x.inp\" and \"d/../x.inp\" are one file");
    check("picture", "export s to \"x.svg\"\npicture p to \"./x.svg\"\n", "E812", "are one file");
    check("family", "export a for i in 0..3 to \"x.inp\"\n", "E812", "3 outputs of this family are one file, \"x.inp\"");
    check(
        "import",
        "import \"rows.csv\" as rows\nexport [{x: rows.points[0].x}] to \"rows.csv\"\n",
        "E813",
        "a file that this script reads",
    );
    let apart = format!("{head}export a for i in 0..3 to \"x_{{i}}.inp\"\nexport b to \"d/x_0.inp\"\n");
    let apart = folder.with("apart.loft", apart);
    assert_eq!(apart.loft(&["run", "apart.loft"]).status, 0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_text_that_standard_output_does_not_take_is_an_error() {
    let folder = Folder::new("full").with("plate.loft", PLATE).with("other.loft", PLATE.replace("4m in", "5m in"));
    let folder = folder.with("wide.loft", "let  x=1\n");
    assert_eq!(folder.loft(&["test", "--accept", "plate.loft"]).status, 0);
    let commands: &[&[&str]] = &[
        &["run", "plate.loft"],
        &["run", "plate.loft", "--json"],
        &["check", "plate.loft", "other.loft", "--json"],
        &["fmt", "-"],
        &["fmt", "--check", "wide.loft"],
        &["doc"],
        &["doc", "line"],
        &["doc", "--markdown"],
        &["explain", "E501"],
        &["explain", "plate.loft", "plate"],
        &["completions", "bash"],
        &["test"],
        &["test", "--list"],
        &["diff", "plate.loft", "plate.loft"],
        &["diff", "plate.loft", "other.loft"],
        &["render", "plate.loft", "-o", "x.png"],
        &["repl"],
        &["new", "fresh"],
        &["--version"],
        &["--help"],
        &["help", "run"],
    ];
    for arguments in commands {
        let started = |out: Stdio| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_loft"));
            command.args(*arguments).current_dir(&folder.0).stdin(Stdio::piped()).stdout(out).stderr(Stdio::piped());
            let mut child = command.spawn().unwrap();
            let typed: &[u8] = if arguments[0] == "repl" { b"1 + 1\n" } else { b"let x = 1\n" };
            let _ = child.stdin.take().unwrap().write_all(typed);
            let out = child.wait_with_output().unwrap();
            let _ = fs::remove_dir_all(folder.path("fresh"));
            (out.status.code(), String::from_utf8(out.stderr).unwrap())
        };
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let (status, told) = started(full.into());
        assert_eq!(status, Some(1), "{arguments:?}: {told}");
        assert_eq!(told, "loft: cannot write to standard output: no space left on device\n", "{arguments:?}");
        // A reader that has gone is told nothing, and the status is the one that shells know.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let (status, told) = started(writer.into());
        let expected =
            if arguments.contains(&"other.loft") && arguments[0] == "diff" || arguments.starts_with(&["fmt", "--check"]) { 1 } else { 141 };
        assert_eq!((status, told.as_str()), (Some(expected), ""), "{arguments:?}");
    }
}

#[test]
fn check_writes_nothing_but_finds_the_same() {
    let folder = Folder::new("check").with("plate.loft", PLATE);
    let (checked, ran) = (folder.loft(&["check", "plate.loft", "--json"]), folder.loft(&["run", "plate.loft", "--json", "-o", "out"]));
    assert_eq!((checked.status, ran.status), (0, 0));
    assert_eq!(checked.json()["meshes"], ran.json()["meshes"]);
    assert_eq!(checked.json()["outputs"], serde_json::json!([]));
    let bad = folder.with("bad.loft", PLATE.replace("plate.stl", "plate.xyz"));
    let run = bad.loft(&["check", "plate.loft", "bad.loft"]);
    assert_eq!(run.status, 1);
    assert!(run.err.contains("E804"), "{}", run.err);
    assert!(!bad.path("plate.stl").exists());
}

#[test]
fn the_json_report_has_its_keys_in_order() {
    let folder = Folder::new("json").with("plate.loft", PLATE);
    let run = folder.loft(&["run", "plate.loft", "--json", "-o", "out"]);
    let report = run.json();
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>().join(" ");
    assert_eq!(
        keys(&report),
        "loft model units ok network modeling curves surfaces topology shells meshes checks reports outputs renamed unwritten unmade diagnostics timings"
    );
    assert_eq!(keys(&report["surfaces"][0]), "name kind flow patches edges vertices area");
    assert_eq!(
        keys(&report["meshes"][0]),
        "name nodes triangles quads order min_angle max_angle mean_quality min_quality max_aspect area chord_error watertight parts hash groups"
    );
    assert_eq!(keys(&report["checks"][0]), "label pass line left right");
    assert_eq!((report["checks"][0]["line"].as_u64(), report["meshes"][0]["quads"].as_u64()), (Some(10), Some(12)));
    assert_eq!(report["outputs"][0], serde_json::json!({ "path": "plate.stl", "bytes": 1284 }));
    assert_eq!(keys(&report["timings"]), "parse evaluate mesh write");
    assert!(run.out.contains("\"area\": 12,"), "numbers are shortest: {}", run.out);
}

#[test]
fn the_json_report_tells_how_the_faces_of_shells_join() {
    let script = "units m\ncurve c = line((0, 0, 0), (4, 0, 0))\nsurface a = extrude(c, by: (0, 1, 0))\n\
        surface b = extrude(c, by: (0, -sqrt(3), 1))\nshell roof of a, b\nshell one of a\n";
    let folder = Folder::new("joins").with("roof.loft", script);
    let shells = folder.loft(&["check", "roof.loft", "--json"]).json()["shells"].clone();
    assert_eq!(shells[0]["gap"].as_f64(), Some(0.0), "{shells}");
    assert!((shells[0]["angle"].as_f64().unwrap() - 30.0).abs() < 1e-9, "{shells}");
    assert!(shells[1]["gap"].is_null() && shells[1]["angle"].is_null(), "no inner edge: {shells}");
}

#[test]
fn diagnostics_count_characters_from_one() {
    let folder = Folder::new("places").with("model.loft", "units m\n/* 지붕 */ let a = widht + 1m\n");
    let run = folder.loft(&["run", "model.loft", "--json"]);
    assert_eq!(run.status, 1);
    let label = &run.json()["diagnostics"][0]["labels"][0];
    assert_eq!((label["file"].as_str(), label["line"].as_u64()), (Some("model.loft"), Some(2)));
    assert_eq!((label["column"].as_u64(), label["length"].as_u64()), (Some(18), Some(5)), "{label}");
}

#[test]
fn params_are_set_from_outside() {
    let folder = Folder::new("set").with("plate.loft", PLATE);
    let run = folder.loft(&["run", "plate.loft", "--json", "--set", "width=8m", "--set", "n=8", "-o", "out"]);
    assert_eq!((run.status, run.json()["surfaces"][0]["area"].as_f64()), (0, Some(24.0)));
    let far = folder.loft(&["run", "plate.loft", "--set", "width=80m"]);
    assert_eq!(far.status, 1);
    assert!(far.err.contains("E218"), "{}", far.err);
    let unknown = folder.loft(&["run", "plate.loft", "--set", "widht=8m"]);
    assert!(unknown.err.contains("E219") && unknown.err.contains("width"), "{}", unknown.err);
    assert_eq!(folder.loft(&["run", "plate.loft", "--set", "width"]).status, 2);
}

#[test]
fn a_table_runs_each_row_and_one_failure_stops_no_other() {
    let table = "name,width,n\nshort,2m,2\nwide,80m,4\n,6m,6\n";
    let folder = Folder::new("table").with("plate.loft", PLATE).with("sizes.csv", table);
    let run = folder.loft(&["run", "plate.loft", "--table", "sizes.csv", "-o", "out"]);
    assert_eq!(run.status, 1);
    // One line a row, and nothing else on standard output.
    let lines: Vec<&str> = run.out.lines().collect();
    let starts = |k: usize, words: &[&str]| lines[k].split_whitespace().take(words.len()).eq(words.iter().copied());
    assert!(lines.len() == 4 && starts(0, &["case", "width", "n", "result"]), "{}", run.out);
    assert!(
        starts(1, &["short", "2m", "2", "fine"]) && starts(2, &["wide", "80m", "4", "FAILED"]) && starts(3, &["003", "6m", "6", "fine"])
    );
    let stl: Vec<String> = folder.names().into_iter().filter(|n| n.ends_with(".stl")).collect();
    assert_eq!(stl, ["out/003/plate.stl", "out/short/plate.stl"]);
    let cases = folder.loft(&["check", "plate.loft", "--table", "sizes.csv", "--json"]).json();
    let names: Vec<&str> = cases["cases"].as_array().unwrap().iter().map(|c| c["case"].as_str().unwrap()).collect();
    assert_eq!((cases["loft"].as_u64(), names), (Some(1), vec!["short", "wide", "003"]));
    assert_eq!(cases["cases"][0]["surfaces"][0]["area"].as_f64(), Some(6.0));
    let place = &cases["cases"][1]["diagnostics"][0]["labels"][0];
    let place = ["file", "line", "column", "length"].map(|key| place[key].to_string());
    assert_eq!(place, ["\"sizes.csv\"", "3", "6", "3"]);
    assert_eq!(cases["cases"][2]["set"][0], serde_json::json!({ "name": "width", "value": "6m" }));
}

#[test]
fn the_table_of_rows_has_what_they_set_check_and_report() {
    let more =
        "check \"wide\": width > 3m\ncheck \"long\": n > 1\nreport [{span: width, steps: n}]\nreport \"tall\": width * 2\nreport west\n";
    let table = "# a comment\nname;width [m];n\n\nsmall; 2 ;2\nlarge;\"6\";3 # seen\nbroken; 80 ;4\n";
    let folder = Folder::new("rows").with("plate.loft", format!("{PLATE}{more}")).with("sizes.csv", table);
    let run = folder.loft(&["check", "plate.loft", "--table", "sizes.csv"]);
    let rows: Vec<Vec<&str>> = run.out.lines().map(|line| line.split("  ").map(str::trim).filter(|c| !c.is_empty()).collect()).collect();
    let cell = |row: usize, name: &str| {
        let heads: Vec<usize> = run.out.lines().next().unwrap().match_indices(name).map(|(at, _)| at + name.len()).collect();
        let line = run.out.lines().nth(row).unwrap();
        line.get(..heads[0]).unwrap_or(line).rsplit("  ").next().unwrap().trim().to_owned()
    };
    assert_eq!(rows[0][..5], ["case", "width", "n", "result", "checks"], "{}", run.out);
    assert_eq!(
        (cell(1, "span [m]"), cell(2, "span [m]"), cell(2, "steps"), cell(2, "tall [m]")),
        ("2".into(), "6".into(), "3".into(), "12".into())
    );
    assert!(rows[1].contains(&"2 of 3") && rows[1].contains(&"wide") && rows[2].contains(&"3 of 3"), "{}", run.out);
    assert!(run.out.ends_with("reports of several rows are not in this table: `--each` prints them, `--json` holds them\n"), "{}", run.out);
    // An error names file, row and column, and shows the cell.
    for words in ["case broken (row 3 of sizes.csv: width = 80m, n = 4)", "[sizes.csv:6:9]", "row 3, column 2 (`width`) of sizes.csv"] {
        assert!(run.err.contains(words), "{words}: {}", run.err);
    }
    let each = folder.loft(&["check", "plate.loft", "--table", "sizes.csv", "--each"]);
    assert!(each.out.contains("case large\nplate.loft: ") && each.out.contains("\nmember"), "{}", each.out);
    let quiet = folder.loft(&["check", "plate.loft", "--table", "sizes.csv", "--quiet"]);
    assert_eq!((quiet.out.as_str(), quiet.status, quiet.err == run.err), ("", 1, true));
}

#[test]
fn a_wrong_column_is_told_once_and_quiet_runs_print_nothing() {
    let folder = Folder::new("quiet").with("plate.loft", PLATE).with("bad.csv", "name,widht\na,2m\nb,3m\n");
    let run = folder.loft(&["check", "plate.loft", "--table", "bad.csv"]);
    assert_eq!((run.status, run.err.matches("E219").count()), (1, 1), "{}", run.err);
    assert!(run.err.contains("[bad.csv:1:6]") && run.err.contains("  the same as in case a\n"), "{}", run.err);
    let quiet = folder.loft(&["run", "plate.loft", "-q"]);
    assert_eq!((quiet.status, quiet.out.as_str(), quiet.err.as_str()), (0, "", ""));
    assert!(folder.path("plate.stl").exists());
    assert_eq!(folder.loft(&["run", "plate.loft", "-q", "--json"]).status, 2);
    assert_eq!(folder.loft(&["run", "plate.loft", "--each"]).status, 2);
}

#[test]
fn standard_input_is_a_script() {
    let folder = Folder::new("stdin");
    let ran = run(&folder.0, &["run", "-", "-o", "out"], Some(PLATE.as_bytes()));
    assert_eq!(ran.status, 0, "{}", ran.err);
    assert!(folder.path("out/plate.stl").exists());
    let broken = run(&folder.0, &["run", "-"], Some(b"curve a = lin((0,0),(1,0))"));
    assert!(broken.status == 1 && broken.err.contains("<stdin>"), "{}", broken.err);
}

#[test]
fn a_failed_run_leaves_old_outputs_whole() {
    let folder = Folder::new("atomic").with("plate.loft", PLATE);
    assert_eq!(folder.loft(&["run", "plate.loft"]).status, 0);
    let before = folder.files();
    let failing = format!("{}check \"never\": 1 > 2\n", PLATE.replace("width = 4m", "width = 5m"));
    let folder = folder.with("plate.loft", &failing);
    let run = folder.loft(&["run", "plate.loft"]);
    assert_eq!(run.status, 1);
    assert!(run.err.contains("E901") && run.out.contains("FAIL  never"), "{}{}", run.err, run.out);
    let outputs = |files: Vec<(String, Vec<u8>)>| files.into_iter().filter(|(n, _)| n != "plate.loft").collect::<Vec<_>>();
    assert!(outputs(before.clone()) == outputs(folder.files()), "no output changed and nothing was left over");
    assert_eq!(folder.loft(&["run", "plate.loft", "--keep-going"]).status, 1);
    assert!(outputs(before) != outputs(folder.files()), "--keep-going writes what is sound");
}

#[test]
fn strict_makes_warnings_errors() {
    let text = PLATE.replace("export m to \"plate.stl\"", "group sides of east, west\nexport m to \"plate.stl\"");
    let folder = Folder::new("strict").with("plate.loft", text);
    let run = folder.loft(&["run", "plate.loft", "-o", "a"]);
    assert!(run.status == 0 && run.err.contains("W806"), "{}", run.err);
    assert_eq!(folder.loft(&["run", "plate.loft", "-o", "b", "--strict"]).status, 1);
    assert!(folder.path("a/plate.stl").exists() && !folder.path("b/plate.stl").exists());
}

#[test]
fn outputs_and_imports_stay_inside_their_folders() {
    let outside = Folder::new("outside").with("secret.csv", "x,y\n1,2\n3,4\n");
    let secret = outside.path("secret.csv");
    let import = |path: &str| format!("import {path:?} as t\nlet n = len(t.rows)\ncheck n == 2\n");
    let folder = Folder::new("inside")
        .with("abs.loft", import(secret.to_str().unwrap()))
        .with("up.loft", import("../x.csv"))
        .with("link.loft", import("link.csv"))
        .with("out.loft", PLATE.replace("plate.stl", "../plate.stl"));
    #[cfg(unix)]
    std::os::unix::fs::symlink(&secret, folder.path("link.csv")).unwrap();
    for script in ["abs.loft", "up.loft", "link.loft", "out.loft"] {
        let run = folder.loft(&["run", script]);
        assert_eq!(run.status, 1, "{script}");
        assert!(run.err.contains("E802"), "{script}: {}", run.err);
    }
    assert!(!folder.path("../plate.stl").exists());
    let allowed = folder.loft(&["run", "link.loft", "--allow", outside.0.to_str().unwrap()]);
    assert_eq!(allowed.status, 0, "{}", allowed.err);
}

#[cfg(unix)]
#[test]
fn a_linked_folder_is_no_way_out() {
    let outside = Folder::new("linked");
    let folder = Folder::new("linking").with("plate.loft", PLATE);
    std::os::unix::fs::symlink(&outside.0, folder.path("deck")).unwrap();
    let run = folder.loft(&["run", "plate.loft"]);
    assert!(run.status == 1 && run.err.contains("E802"), "{}", run.err);
    assert_eq!(outside.names(), Vec::<String>::new());
    assert!(!folder.path("plate.stl").exists());
}

#[test]
fn a_missing_import_names_what_is_there() {
    let folder =
        Folder::new("similar").with("m.loft", "import \"bow_offsets.csv\" as t\nlet n = t.rows\n").with("offsets_bow.csv", "1,2\n");
    let run = folder.loft(&["run", "m.loft"]);
    assert!(run.status == 1 && run.err.contains("E801") && run.err.contains("offsets_bow.csv"), "{}", run.err);
}

#[test]
fn bytes_do_not_depend_on_threads_or_runs() {
    let folder = Folder::new("bytes").with("plate.loft", PLATE).with("figure.loft", FIGURE);
    let outputs = |threads: &str, out: &str| {
        let run = folder.loft(&["run", "plate.loft", "--threads", threads, "-o", out, "--json"]);
        let figure = folder.loft(&["run", "figure.loft", "--threads", threads, "--json"]);
        let without_timings = |run: &Run| run.out.split("\"timings\"").next().unwrap().to_owned();
        let files: Vec<Vec<u8>> = ["plate.stl", "deck/plate.inp", "edges.obj"].iter().map(|f| folder.read(&format!("{out}/{f}"))).collect();
        (without_timings(&run), without_timings(&figure), files)
    };
    let first = outputs("1", "a");
    for (threads, out) in [("1", "b"), ("2", "c"), ("8", "d")] {
        assert!(outputs(threads, out) == first, "{threads} threads");
    }
}

#[test]
fn the_examples_give_the_same_bytes_on_any_number_of_threads() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let folder = Folder::new("same");
    let mut seen = 0;
    for name in ["barrel_vault", "canopy", "greenhouse", "porch", "tank", "wing"] {
        let outputs = |threads: &str, out: &str| {
            let to = folder.path(&format!("{name}/{out}"));
            let model = format!("{name}.loft");
            let run = run(&examples, &["run", &model, "--threads", threads, "-o", to.to_str().unwrap(), "--json"], None);
            assert_eq!(run.status, 0, "{name}: {}", run.err);
            let files: Vec<_> = folder
                .files()
                .into_iter()
                .filter_map(|(file, bytes)| Some((file.strip_prefix(&format!("{name}/{out}/"))?.to_owned(), bytes)))
                .collect();
            (run.out.split("\"timings\"").next().unwrap().replace(&format!("{name}/{out}/"), ""), files)
        };
        let first = outputs("1", "a");
        seen += first.1.len();
        for (threads, out) in [("1", "b"), ("2", "c"), ("8", "d")] {
            assert!(outputs(threads, out) == first, "{name} on {threads} threads, run {out}");
        }
    }
    assert!(seen >= 6, "{seen} files");
}

#[test]
fn the_flow_that_was_found_is_told() {
    let folder = Folder::new("flow").with("plate.loft", PLATE).with("figure.loft", FIGURE);
    let run = folder.loft(&["run", "plate.loft", "-v", "-o", "out"]);
    assert!(
        run.err.contains("surface plate: coons, quadrilateral; along u: south, north; along v: west, east; linear blend\n"),
        "{}",
        run.err
    );
    assert!(!folder.loft(&["run", "plate.loft", "-o", "out"]).err.contains("along u"));
}

/// Near misses by the thousand: the text counts those beyond the first thousand exactly, and the JSON has them all.
#[test]
fn thousands_of_warnings_are_counted_to_the_last() {
    const PAIRS: usize = 1300;
    let pair = |i: usize| format!("curve a{i} = line(({i}, 0), ({i}, 1))\ncurve b{i} = line(({i}, 1.002), ({i}, 2))\n");
    let apart: String = (0..PAIRS).map(pair).collect();
    let family = format!("curve a for i in 0..{PAIRS} = line((i, 0), (i, 1))\ncurve b for i in 0..{PAIRS} = line((i, 1.002), (i, 2))\n");
    let head = "units m\ntolerance 1mm\n";
    let folder = Folder::new("warnings").with("apart.loft", format!("{head}{apart}")).with("family.loft", format!("{head}{family}"));
    for script in ["apart.loft", "family.loft"] {
        let report = folder.loft(&["check", script, "--json"]).json();
        let said = report["diagnostics"].as_array().unwrap();
        assert!(said.iter().all(|row| row["code"] == "W514" && !row["message"].as_str().unwrap().contains("more like")));
        let counted: u64 = said.iter().map(|row| row["count"].as_u64().unwrap()).sum();
        let places: std::collections::BTreeSet<&str> = said.iter().map(|row| row["message"].as_str().unwrap()).collect();
        assert_eq!((said.len(), counted as usize, places.len()), (PAIRS, PAIRS, PAIRS), "{script}");
        let run = folder.loft(&["check", script]);
        let last = run.err.trim_end().lines().last().unwrap_or("").to_owned();
        assert_eq!(last, format!("… and {} more warnings", PAIRS - 20), "{script}");
    }
}

#[test]
fn colours_are_asked_for() {
    let folder = Folder::new("colour").with("m.loft", "check 1 > 2\n");
    assert!(!folder.loft(&["run", "m.loft"]).err.contains('\u{1b}'));
    assert!(folder.loft(&["--color", "always", "run", "m.loft"]).err.contains('\u{1b}'));
}

#[test]
fn a_new_model_runs() {
    let folder = Folder::new("new");
    assert_eq!(folder.loft(&["new", "hall"]).status, 0);
    let test = folder.loft(&["test", "hall"]);
    assert_eq!((test.status, test.out.as_str(), test.err.as_str()), (0, "ok          hall/model.loft\n\n1 ok\n", ""));
    let run = folder.loft(&["run", "hall/model.loft"]);
    assert_eq!((run.status, run.err.as_str()), (0, ""));
    assert_eq!(folder.names(), ["hall/model.golden", "hall/model.inp", "hall/model.loft", "hall/model.vtu"]);
    let again = folder.loft(&["new", "hall"]);
    assert!(again.status == 1 && again.err.contains("there is a model.loft already"), "{}", again.err);
}

#[test]
fn curves_go_to_csv_and_svg() {
    let text = "curve a = arc((0, 0), (2m, 0), through: (1m, 1m))\nexport a to \"a.csv\" { units: m }\nexport a to \"a.svg\"\n";
    let folder = Folder::new("curves").with("m.loft", text);
    let run = folder.loft(&["run", "m.loft"]);
    assert_eq!(run.status, 0, "{}", run.err);
    let csv = String::from_utf8(folder.read("a.csv")).unwrap();
    assert!(csv.starts_with("curve,x [m],y [m],z [m]\na,0,0,0\n") && csv.lines().count() > 30, "{csv}");
}

#[test]
fn measured_ends_are_snapped_and_told() {
    let text = PLATE
        .replace("curve east = line((width, 0)", "snap 10mm\ncurve east = spline([(width + 4mm, 0), (width, 1)")
        .replace("(width, 3))\n", "(width, 3)])\n");
    let text = text.replace("within 1e-9%", "within 1%");
    let folder = Folder::new("snap").with("plate.loft", text);
    let run = folder.loft(&["run", "plate.loft", "-v", "-o", "out"]);
    assert_eq!(run.status, 0, "{}", run.err);
    assert!(run.err.contains("N513") && run.out.contains("4 curves, 4 links, 4 nodes"), "{}{}", run.err, run.out);
}

#[test]
fn text_that_is_none_is_told() {
    let folder = Folder::new("utf8").with("m.loft", [b'l', b'e', b't', 0xFF]);
    let run = folder.loft(&["run", "m.loft"]);
    assert!(run.status == 1 && run.err.contains("UTF-8"), "{}", run.err);
    let missing = folder.loft(&["run", "n.loft"]);
    assert!(missing.status == 2 && missing.err.contains("there is a \"m.loft\""), "{}", missing.err);
}

#[test]
fn a_limit_of_elements_holds_in_every_command_and_method() {
    let methods = ["", "method: delaunay", "method: quadtree", "method: isoline", "elements: quads", "elements: quads method: delaunay"];
    let meshes: Vec<String> = methods.iter().enumerate().map(|(k, m)| format!("mesh m{k} of plate {{ size: 10mm  {m} }}\n")).collect();
    let text = format!("{MANY_STEPS}{}", meshes.concat());
    let folder = Folder::new("limit").with("m.loft", &text);
    let refused = |run: &Run, least: usize| {
        let named = run.err.matches("elements; the limit is 50").count();
        assert!(run.status == 1 && named >= least, "status {}: {}", run.status, run.err);
    };
    for rest in [&["run"][..], &["check"]] {
        let all = |most: &[&str]| folder.loft(&[rest, most, &["m.loft"]].concat());
        refused(&all(&["--max-elements", "50"]), methods.len());
        assert_eq!(all(&["--max-elements", "5000"]).status, 0);
        assert_eq!(all(&[]).status, 0);
    }
    refused(&folder.loft(&["render", "m.loft", "--of", "m0", "-o", "m.png", "--max-elements", "50"]), 1);
    assert_eq!(folder.loft(&["test", "--accept", "m.loft"]).status, 0);
    assert_eq!(folder.loft(&["test", "m.loft"]).status, 0);
    let tested = folder.loft(&["test", "--max-elements", "50", "m.loft"]);
    assert!(tested.status == 1 && tested.out.contains("E217"), "{}", tested.out);
    let asked = |most: &[&str]| run(&folder.0, &[&["repl"][..], most, &["m.loft"]].concat(), Some(b"len(m0.triangles)\n"));
    assert!(asked(&[]).out.contains("200"));
    let asked = asked(&["--max-elements", "50"]);
    assert!((asked.out.clone() + &asked.err).contains("elements; the limit is 50"), "{}{}", asked.out, asked.err);
    let zero = folder.loft(&["check", "--max-elements", "0", "m.loft"]);
    assert!(zero.status == 2 && zero.err.contains("1..=1000000000"), "{}", zero.err);
}

#[test]
fn a_limit_of_work_ends_a_run_as_a_whole_and_leaves_no_file() {
    let text =
        format!("{MANY_STEPS}param n = 1\nmesh m of plate {{ chord_error: 1mm  size: 1mm  method: delaunay }}\nexport m to \"m.inp\"\n");
    let folder = Folder::new("work").with("m.loft", &text);
    let all = |rest: &[&str]| folder.loft(&[rest, &["m.loft"]].concat());
    for threads in ["1", "2"] {
        let ended = all(&["run", "--threads", threads, "--max-work", "20000"]);
        let told = ended.err.contains("E217") && ended.err.contains("--max-work 20000") && ended.err.contains("meshing m (1 of 1)");
        assert!(ended.status == 1 && told, "status {}: {}", ended.status, ended.err);
        assert!(!folder.0.join("m.inp").exists());
        assert!(!ended.out.contains("not made"), "{}", ended.out);
    }
    let json = all(&["check", "--json", "--max-work", "20000"]);
    let report: Value = serde_json::from_str(&json.out).unwrap();
    assert!(report["ok"] == false && report["diagnostics"][0]["code"] == "E217", "{}", json.out);
    assert_eq!(all(&["run", "--max-work", "1000000000"]).status, 0);
    assert!(folder.0.join("m.inp").exists());
    // Each row of a table is a run.
    std::fs::write(folder.0.join("rows.csv"), "n\n1\n2\n").unwrap();
    let rows = all(&["check", "--table", "rows.csv", "--max-work", "20000"]);
    assert!(
        rows.status == 1 && rows.err.contains("E217") && rows.err.contains("case 002"),
        "status {}: {}{}",
        rows.status,
        rows.out,
        rows.err
    );
    assert_eq!(all(&["check", "--max-work", "0"]).status, 2);
    // What was ended is no golden, equals nothing, and says why it has no value.
    let told = |run: &Run| (run.out.clone() + &run.err).contains("this run takes more work than `--max-work 20000` allows");
    let accepted = all(&["test", "--accept", "--max-work", "20000"]);
    assert!(accepted.status == 1 && told(&accepted) && !folder.0.join("m.golden").exists(), "{}{}", accepted.out, accepted.err);
    assert_eq!(all(&["test", "--accept"]).status, 0);
    let tested = all(&["test", "--max-work", "20000"]);
    assert!(tested.status == 1 && told(&tested) && tested.out.contains("ended"), "{}{}", tested.out, tested.err);
    let differs = folder.loft(&["diff", "m.loft", "m.loft", "--max-work", "20000"]);
    assert!(differs.status == 2 && told(&differs), "status {}: {}{}", differs.status, differs.out, differs.err);
    let asked = run(&folder.0, &["repl", "--max-work", "20000", "m.loft"], Some(b"len(m.triangles)\n"));
    assert!(told(&asked), "{}{}", asked.out, asked.err);
}

/// A square with room for many elements.
const MANY_STEPS: &str = r#"units mm
curve south = line((0, 0), (100, 0))
curve east = line((100, 0), (100, 100))
curve north = line((100, 100), (0, 100))
curve west = line((0, 100), (0, 0))
surface plate = coons(south, east, north, west)
"#;

#[test]
fn the_reference_manual_is_current() {
    let folder = Folder::new("reference");
    let manual = folder.loft(&["doc", "--markdown"]).out;
    let kept = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/reference.md")).unwrap();
    assert!(manual == kept, "docs/guide/reference.md is not current: loft doc --markdown > docs/guide/reference.md");
}

#[test]
fn the_examples_of_all_functions_run() {
    use lofting::lang::eval::std::builtins;
    let folder = Folder::new("examples");
    let mut wrong = Vec::new();
    for builtin in builtins() {
        let mut parts = builtin.docs.split("```loft\n").skip(1);
        let Some(example) = parts.next().and_then(|rest| rest.split("```").next()) else {
            wrong.push(format!("{} has no example", builtin.name));
            continue;
        };
        let lines: Vec<&str> = example.lines().map(|line| line.strip_prefix(' ').unwrap_or(line)).collect();
        let run = run(&folder.0, &["check", "-"], Some(lines.join("\n").as_bytes()));
        if run.status != 0 || run.err.contains('⚠') {
            wrong.push(format!("{}: {}", builtin.name, run.err));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn golden_tests_end_with_the_right_status() {
    let folder = Folder::new("golden").with("a/plate.loft", PLATE).with("a/plain.loft", "curve c = line((0, 0), (1, 0))\n");
    assert_eq!(folder.loft(&["test"]).status, 2, "there is nothing to test");
    let missing = folder.loft(&["test", "a/plate.loft"]);
    assert!(missing.status == 1 && missing.out.contains("missing     a/plate.loft\nE902 × a/plate.loft has no golden"), "{}", missing.out);
    assert_eq!(folder.loft(&["test", "--accept", "a/plate.loft", "a/plain.loft"]).status, 0);
    let list = folder.loft(&["test", "--list"]);
    assert_eq!((list.status, list.out.as_str()), (0, "a/plain.loft\na/plate.loft\n"));
    let before = folder.files();
    let same = folder.loft(&["test", "--jobs", "2", "--junit", "report.xml"]);
    assert_eq!((same.status, same.out.as_str()), (0, "ok          a/plain.loft\nok          a/plate.loft\n\n2 ok\n"));
    assert!(String::from_utf8(folder.read("report.xml")).unwrap().contains("tests=\"2\" failures=\"0\" errors=\"0\""));
    fs::remove_file(folder.path("report.xml")).unwrap();
    assert_eq!(folder.files(), before, "a test writes nothing beside the script");
    fs::write(folder.path("a/plate.loft"), PLATE.replace("(width, 3)", "(width, 4)")).unwrap();
    let differs = folder.loft(&["test", "--filter", "plate"]);
    assert!(differs.status == 1 && differs.out.contains("plate: area 12 → 14 m² (+17 %, allowed 1e-9"), "{}", differs.out);
    assert_eq!(folder.loft(&["test", "--filter", "plain"]).status, 0);
    assert_eq!(folder.loft(&["test", "--filter", "nothing"]).status, 2);
    fs::remove_file(folder.path("a/plain.loft")).unwrap();
    let orphan = folder.loft(&["test", "a"]);
    assert!(orphan.status == 1 && orphan.out.contains("orphaned    a/plain.loft\nE902 × a/plain.golden has no script"), "{}", orphan.out);
    assert!(orphan.out.ends_with("\n1 differs, 1 orphaned\n"), "{}", orphan.out);
    let gone = folder.loft(&["test", "b.loft"]);
    assert_eq!((gone.status, gone.err.as_str()), (2, "loft: cannot test \"b.loft\": there is no such file\n"));
    let colors = folder.loft(&["--color", "always", "test", "a/plate.loft"]);
    assert!(colors.out.contains("\u{1b}[31m  - surface plate") && colors.out.contains("\u{1b}[32m  + surface plate"), "{}", colors.out);
}

#[test]
fn diff_says_what_changed() {
    let plate = PLATE.replace("size: 1m", "size: 1.1m");
    let folder = Folder::new("diff").with("a.loft", &plate).with("b.loft", plate.replace("(width, 3)", "(width, 3, 10mm)"));
    let lines: Vec<&str> = plate.lines().collect();
    let (head, tail) = lines.split_at(3);
    let mut turned: Vec<&str> = tail.to_vec();
    turned.reverse();
    let folder = folder.with("c.loft", [head, &turned].concat().join("\n")).with("d.txt", "");
    let same = folder.loft(&["diff", "a.loft", "c.loft"]);
    assert_eq!((same.status, same.out.as_str(), same.err.as_str()), (0, "no difference\n", ""));
    let moved = folder.loft(&["diff", "a.loft", "b.loft"]);
    assert_eq!(moved.status, 1, "{}", moved.out);
    for part in
        ["  - a.loft\n  + b.loft\n", "plate: box, upper z 0.00 → 0.01 m", "mesh m: ", " nodes moved, farthest 0.01 m at (4.0, 3.0, 0.01)"]
    {
        assert!(moved.out.contains(part), "{part} in\n{}", moved.out);
    }
    folder.loft(&["test", "--accept", "a.loft", "b.loft"]);
    let goldens = folder.loft(&["diff", "a.golden", "b.golden"]);
    assert!(goldens.status == 1 && goldens.out.contains("east: length 3.00000 → 3.00002 m"), "{}", goldens.out);
    assert_eq!(folder.loft(&["diff", "a.golden", "a.loft"]).status, 0);
    assert_eq!(folder.loft(&["diff", "a.golden", "a.golden"]).status, 0);
    for (a, b) in [("a.loft", "none.loft"), ("d.txt", "a.loft"), ("a.golden", "")] {
        assert_eq!(folder.loft(&["diff", a, b]).status, 2, "{a} {b}");
    }
    assert_eq!(folder.names().len(), 6, "nothing else is written");
}

/// Every unit that a file may be asked for in can be written, and is that unit.
#[test]
fn files_are_written_and_read_in_any_unit() {
    let folder = Folder::new("units");
    for (word, metres) in [("um", 1e-6), ("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("km", 1e3), ("inch", 0.0254), ("ft", 0.3048)] {
        let script = format!(
            "units m\ncurve s = line((0, 0), (3, 0))\ncurve n = line((0, 1), (3, 1))\nsurface p = ruled(s, n)\n\
             mesh m of p {{ size: 1m }}\nexport m to \"p.obj\" {{ units: {word} }}\n"
        );
        let again = format!("units m\nimport \"p.obj\" (unit: {word}) as p\ncheck area(p.mesh) == 3m2 within 1e-9%\n");
        let folder_of = |name: &str, text: &str| fs::write(folder.path(name), text).unwrap();
        folder_of("write.loft", &script);
        folder_of("read.loft", &again);
        let run = folder.loft(&["run", "write.loft"]);
        assert_eq!((run.status, run.err.as_str()), (0, ""), "{word}");
        let text = String::from_utf8(folder.read("p.obj")).unwrap();
        let largest = text.lines().filter_map(|line| line.strip_prefix("v ")?.split(' ').next()?.parse::<f64>().ok()).fold(0.0, f64::max);
        assert!((largest * metres - 3.0).abs() < 1e-9, "{word}: {largest}");
        assert_eq!(folder.loft(&["check", "read.loft"]).status, 0, "{word}");
    }
}

/// What is sound of a model is told although a surface, a mesh or a check failed; what failed and what waits for it is named, and no
/// file is written.
#[test]
fn failed_runs_tell_what_is_sound() {
    let script = "curve a = line((0, 0), (10, 0))\ncurve b = line((0, 10), (10, 10, 3))\nsurface good = ruled(a, b)\n\
                  surface bad = plane(a, b)\nshell skin of good\ngroup all of good, bad\nmesh fine of good { size: 1mm }\n\
                  mesh coarse of bad { size: 1mm }\nreport good\nreport \"nodes\": {nodes: len(fine.nodes)}\n\
                  check area(good) > 0mm2\ncheck bad.area > 0mm2\nexport fine to \"fine.obj\"\nexport coarse to \"coarse.obj\"\n";
    let folder = Folder::new("waiting").with("a.loft", script);
    for command in ["run", "check"] {
        let run = folder.loft(&[command, "a.loft"]);
        assert_eq!(run.status, 1);
        let notes =
            ["nothing that depends on `bad` was built: all, coarse (1 group, 1 mesh, 1 check, 1 export)\n", "meshed without `bad`: fine\n"];
        for note in notes {
            assert!(run.err.contains(note), "{note} in\n{}", run.err);
        }
        let rows = ["\nskin ", "\nfine ", "\ngood\n", "\nnodes\n", "pass area(good) > 0mm2\n", "\nbad surface 4 an error of its own\n"];
        for row in rows.into_iter().chain(["\ncoarse mesh 8 bad\n", "\nbad.area > 0mm2 check 12 bad\n"]) {
            let out: Vec<String> = run.out.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
            assert!(format!("\n{}\n", out.join("\n")).contains(row), "{row} in\n{}", run.out);
        }
        assert_eq!(run.out.contains("not written, as the run failed: fine.obj\n"), command == "run", "{}", run.out);
    }
    assert!(!fs::exists(folder.path("fine.obj")).unwrap());
    let json = folder.loft(&["run", "--json", "a.loft"]);
    for row in [
        "\"unwritten\": [\n    \"fine.obj\"\n  ]",
        "{ \"name\": \"coarse\", \"what\": \"mesh\", \"file\": \"a.loft\", \"line\": 8, \"because\": \"bad\" }",
    ] {
        assert!(json.status == 1 && json.out.contains(row), "{row} in\n{}", json.out);
    }
}

/// Texts of scripts and files do not steer the terminal: they are shown, and stand as they are in JSON.
#[test]
fn nothing_that_is_printed_steers_the_terminal() {
    let text = "units mm\nlet t = \"a\\u{1b}]0;x\\u{7}b\\u{202e}c\"\nreport \"\\u{1b}[2J\": t\ncheck \"\\u{9b}31m\": 1 > 2\n\
        import \"rows.csv\" as rows\nreport rows\nlet y = \"raw \u{1b}[31m\" + 1 // \u{7}\n";
    let folder = Folder::new("steers").with("m.loft", text).with("rows.csv", "name,x\n\"p\u{202e}q\",1\n");
    let steers = |c: char| c.is_control() && c != '\n' || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let plain = folder.loft(&["run", "m.loft"]);
    assert!(!plain.out.contains(steers) && !plain.err.contains(steers), "{:?}\n{:?}", plain.out, plain.err);
    for shown in ["a\\u{1b}]0;x\\u{7}b\\u{202e}c", "\\u{1b}[2J", "\\u{9b}31m", "p\\u{202e}q"] {
        assert!(plain.out.contains(shown), "{shown} {}", plain.out);
    }
    // The marks stand under what they mark.
    let (line, marks) =
        (plain.err.lines().find(|l| l.contains("raw")).unwrap(), plain.err.lines().find(|l| l.contains("not by `+`")).unwrap());
    let column = |line: &str, sign: char| line.chars().position(|c| c == sign);
    assert_eq!(column(line, '+'), column(marks, '┬'), "{}", plain.err);
    let colored = folder.loft(&["--color", "always", "run", "m.loft"]);
    let bare =
        |text: &str| ["0", "1;31", "2", "31", "32", "36"].iter().fold(text.to_owned(), |t, code| t.replace(&format!("\u{1b}[{code}m"), ""));
    assert_eq!((bare(&colored.out), bare(&colored.err)), (plain.out, plain.err));
    assert_eq!(folder.loft(&["run", "m.loft", "--json"]).json()["reports"][0]["rows"][0][0], "a\u{1b}]0;x\u{7}b\u{202e}c");
    assert_eq!(run(&folder.0, &["fmt", "-"], Some(b"let a = \"\x1b\"\n")).out, "let a = \"\u{1b}\"\n");
}

#[test]
fn names_of_files_hold_nothing_that_steers_a_terminal() {
    let folder = Folder::new("unfit").with("m.loft", "units mm\ncurve c = line((0, 0, 0), (1, 0, 0))\nexport c to \"a\\u{1b}b.csv\"\n");
    let told = folder.loft(&["run", "m.loft"]);
    assert!(told.status == 1 && told.err.contains("E808 × cannot write \"a\\u{1b}b.csv\": its name holds U+001B"), "{}", told.err);
    let folder = folder.with("m.loft", "import \"x\\u{202e}y.csv\" as q\n");
    assert!(folder.loft(&["run", "m.loft"]).err.contains("E801 × cannot read \"x\\u{202e}y.csv\": its name holds U+202E"));
    let folder = folder.with("m.loft", "units mm\ncurve c = line((0, 0, 0), (1, 0, 0))\npicture c to \"p\\u{7}.svg\"\n");
    assert!(folder.loft(&["run", "m.loft"]).err.contains("E808 × cannot write \"p\\u{7}.svg\": its name holds U+0007"));
    assert_eq!(folder.names(), ["m.loft"]);
}
