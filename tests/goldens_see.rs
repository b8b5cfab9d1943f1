//! Goldens see every change of place, size, side and membership, and nothing else.

use std::fs;
use std::path::{Path, PathBuf};

use lofting::base::job::Job;
use lofting::session::golden::{Settings, diff, discover, run_all};

/// A folder with one model, which goes when the test ends.
struct Folder(PathBuf);

impl Folder {
    /// A model whose golden was just accepted.
    fn accepted(name: &str, script: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("see-{name}"));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let folder = Self(folder);
        folder.write(script);
        folder.run(true);
        assert_eq!(folder.run(false), "", "what was just accepted holds");
        let golden = fs::read_to_string(folder.0.join("model.golden")).unwrap();
        assert!(!golden.contains("\nE"), "{golden}");
        folder
    }
    fn write(&self, script: &str) {
        fs::write(self.0.join("model.loft"), script).unwrap();
    }
    /// What a run says about the golden; empty when it is as it should be.
    fn run(&self, accept: bool) -> String {
        let (job, clock) = (Job::new(), || 0.0);
        let tests = discover(&[self.0.join("model.loft")]).unwrap();
        let settings = Settings { accept, filter: None, jobs: 1, clock: &clock, job: &job };
        let mut said = String::new();
        run_all(&tests, &settings, &mut |cases| {
            for case in cases.iter().filter(|case| !case.verdict.is_good()) {
                let lines: Vec<String> = case.lines.iter().map(|said| said.text(false)).collect();
                said.push_str(&format!("{}\n{}\n", case.message, lines.join("\n")));
            }
        });
        said
    }
    fn after(&self, script: &str) -> String {
        self.write(script);
        self.run(false)
    }
    /// What `loft diff` says between the model and another script.
    fn diff(&self, script: &str) -> String {
        let (old, new) = (self.0.join("model.loft"), self.0.join("other.loft"));
        fs::write(&new, script).unwrap();
        let found = diff(&old, &new, &|| 0.0, &Job::new()).unwrap();
        found.iter().flat_map(|one| &one.lines).map(|said| said.text(false) + "\n").collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const PLATE: &str = r#"units mm
param width = 200mm
let inset = 30mm
fn ring(at, r) = circle(at, radius: r)
point mark = (10, 20, 0)
curve rim = polyline([(0, 0, 0), (width, 0, 0), (width, 100, 0), (0, 100, 0)], closed: true)
curve hole = ring((60, 50, 0), inset - 10mm)
curve bow = arc((0, 0, 0), (width, 0, 0), through: (width / 2, -40, 0))
curve brace = line((0, 100, 0), (0, 100, 80))
surface plate = trim(plane(rim), holes: [hole])
surface skirt = ruled(bow, line((0, 0, 50), (width, 0, 50)))
shell lone of skirt
group west of hole
group south of bow, mark
mesh fine of plate, skirt { size: 20mm  on hole { count: 24 } }
check "wide": width > 100mm
check bow.length > 3mm
report "parts": [{length: bow.length, at: bow.at(30%)}]
export fine to "fine.inp"
"#;

/// What goldens were silent about once: what is replaced, and a word that must be said in turn.
const SEEN: &[(&str, &str, &str, &str)] = &[
    ("a moved hole", "ring((60, 50, 0)", "ring((70, 50, 0)", "hole: centroid, x 60"),
    ("a mirrored arc", "-40, 0))", "40, 0))", "bow: centroid, y -"),
    ("a moved point", "point mark = (10, 20, 0)", "point mark = (10, 21, 0)", "mark: at, y 20 → 21 mm"),
    ("an edge that runs back", "line((0, 100, 0), (0, 100, 80))", "line((0, 100, 80), (0, 100, 0))", "brace: from, z 0 → 80 mm"),
    ("a circle that runs back", "circle(at, radius: r)", "circle(at, radius: r, normal: (0, 0, -1))", "hole: round, z "),
    (
        "a surface turned over",
        "ruled(bow, line((0, 0, 50), (width, 0, 50)))",
        "ruled(line((0, 0, 50), (width, 0, 50)), bow)",
        "skirt: its normals are reversed",
    ),
    ("a shell of another side", "shell lone of skirt", "shell lone of skirt { flip: true }", "lone: its normals are reversed"),
    ("swapped groups", "west of hole\ngroup south of bow, mark", "south of hole\ngroup west of bow, mark", "group west: points 1 is new"),
    ("a group of another member", "group west of hole", "group west of brace", "group west: centroid"),
    ("a count of a rule", "count: 24", "count: 25", "settings \"fine on 1\": count 24 → 25"),
    ("a size that makes the same mesh", "size: 20mm", "size: 20.001mm", "settings fine: size 20.000 → 20.001 mm"),
    ("the side of a check", "width > 100mm", "width > 101mm", "check \"wide\": right 100 mm → 101 mm"),
    ("the side of a check without a label", "bow.length > 3mm", "bow.length > 4mm", "right 3 mm → 4 mm"),
    ("a setting of an export", "\"fine.inp\"", "\"fine.inp\" { units: m }", "export fine.inp: units m is new"),
    ("a point on a curve", "bow.at(30%)", "bow.at(31%)", "row \"parts 1\": cells"),
];

#[test]
fn every_change_is_seen() {
    let folder = Folder::accepted("changes", PLATE);
    for (what, old, new, words) in SEEN {
        assert!(PLATE.contains(old), "{old}");
        let changed = PLATE.replace(old, new);
        folder.write(PLATE);
        let (differing, tested) = (folder.diff(&changed), folder.after(&changed));
        for (by, said) in [("test", &tested), ("diff", &differing)] {
            assert!(said.contains(words), "{what} is not seen by {by}: expected {words:?} in\n{said}");
        }
    }
}

#[test]
fn a_rename_is_a_rename() {
    let folder = Folder::accepted("renamed", PLATE);
    for (old, new, words) in [
        ("bow", "arch", "curve bow is called arch now; nothing else about it changed"),
        ("west", "ring_group", "group west is called ring_group now; nothing else about it changed"),
        ("plate", "slab", "surface plate is called slab now; nothing else about it changed"),
        ("fine", "net", "mesh fine is called net now; nothing else about it changed"),
        ("mark", "spot", "point mark is called spot now; nothing else about it changed"),
    ] {
        let renamed = PLATE.replace(old, new).replace(&format!("\"{new}.inp\""), "\"fine.inp\"");
        folder.write(PLATE);
        let (differing, tested) = (folder.diff(&renamed), folder.after(&renamed));
        for (by, said) in [("test", &tested), ("diff", &differing)] {
            assert_eq!(said.lines().filter(|l| l.starts_with("    ")).count(), 1, "{by} says more than one thing about {old}:\n{said}");
            assert!(said.contains(words), "{by} of {old}: expected {words:?} in\n{said}");
        }
    }
    folder.write(PLATE);
    let swapped = PLATE.replace("hole", "#").replace("bow", "hole").replace('#', "bow");
    assert!(!folder.after(&swapped).contains("is called"), "two names that changed places are no rename");
}

#[test]
fn names_inside_layout_and_order_are_nothing() {
    let folder = Folder::accepted("same", PLATE);
    let mut lines: Vec<&str> = PLATE.lines().collect();
    lines[1..].reverse();
    for (what, script) in [
        ("the order of declarations", lines.join("\n") + "\n"),
        ("a renamed let", PLATE.replace("inset", "margin")),
        ("a renamed function", PLATE.replace("ring(", "round_hole(")),
        ("renamed parameters", PLATE.replace("ring(at, r) = circle(at, radius: r)", "ring(middle, reach) = circle(middle, radius: reach)")),
        ("blanks", PLATE.replace(", ", " ,   ").replace(" = ", "=")),
        ("comments", PLATE.lines().map(|line| format!("// said before\n{line} // said behind\n")).collect()),
    ] {
        assert_eq!(folder.after(&script), "", "{what}");
    }
}

/// Quoted expressions are compared as tokens: a layout as `loft fmt` makes it changes no golden.
#[test]
fn formatting_changes_no_golden() {
    let script = "units m\nsurface s=coons(line((0,0,0),(4,0,0)),line((4,0,0),(4,3,1)),line((4,3,1),(0,3,0)),line((0,3,0),(0,0,0)))\n\
                  mesh m of s{size:500mm on s.edges[ 0 ]{count:9 elements:quads}}\ncheck area(s)>1m2\nreport area( s )\n";
    let folder = Folder::accepted("formatted", script);
    let golden = fs::read_to_string(folder.0.join("model.golden")).unwrap();
    assert!(golden.contains("curve `line((0,0,0),(4,0,0))`") && golden.contains("check `area(s)>1m2`"), "{golden}");
    let formatted = lofting::lang::fmt::format(script).text;
    assert_ne!(formatted, script);
    assert_eq!(folder.after(&formatted), "");
}

/// A tolerance of a check is compared as a share of itself: it may be far below the golden's own.
#[test]
fn a_tiny_tolerance_of_a_check_is_seen() {
    let script = |share: &str, length: &str| {
        let lines = "units m\ncurve a = line((0, 0, 0), (4, 0, 0))\n";
        format!("{lines}check \"share\": a.length == 4m within {share}\ncheck \"length\": a.length == 4m within {length}\n")
    };
    let folder = Folder::accepted("tiny", &script("1e-6%", "1e-14m"));
    assert_eq!(folder.after(&script("0.000001%", "1e-11mm")), "");
    for (share, length) in [("1.001e-6%", "1e-14m"), ("1e-6%", "1.001e-14m"), ("1e-9%", "1e-14m")] {
        assert!(folder.after(&script(share, length)).contains("within"), "{share} {length}");
    }
}
