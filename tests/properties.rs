//! Properties that hold for every model, asked in the language itself: random scripts whose checks must pass.
//!
//! `PROPTEST_CASES` makes the runs longer.

use std::fs;
use std::path::{Path, PathBuf};

use lofting::session::disk::{Disk, Outputs};
use lofting::session::guard::guarded;
use lofting::session::report::Report;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseResult, TestRng, TestRunner};

use crate::support::script;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("properties-{name}"));
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs a script in a folder; fails with what it said unless all is well.
fn sound(folder: &Path, text: &str) -> Result<Report, TestCaseError> {
    let disk = Disk::new(Some(&folder.join("model.loft")), None, &[], Outputs::Written).unwrap();
    let run = || script::outcome("model.loft", text.as_bytes(), &[], &disk);
    let outcome = guarded(run).map_err(|bug| TestCaseError::fail(format!("{bug:?}\n{text}")))?;
    if outcome.report.ok { Ok(outcome.report) } else { Err(TestCaseError::fail(format!("{}\n{text}", outcome.drawn(false, false)))) }
}

fn check<S: Strategy>(cases: u32, strategy: &S, test: impl Fn(S::Value) -> TestCaseResult) {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(cases);
    let config = Config { cases, max_shrink_iters: 100, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[11; 32]));
    runner.run(strategy, test).unwrap_or_else(|error| panic!("{error}"));
}

type P = (f64, f64, f64);

fn coordinate() -> impl Strategy<Value = f64> {
    (-400i32..400).prop_map(|n| f64::from(n) / 40.0)
}

/// Points that no two of which are near each other, so that curves through them are sound.
fn points(n: std::ops::Range<usize>) -> impl Strategy<Value = Vec<P>> {
    proptest::collection::vec((coordinate(), coordinate(), coordinate()), n).prop_filter("points apart", |list| {
        let apart = |a: &P, b: &P| (a.0 - b.0).abs() + (a.1 - b.1).abs() + (a.2 - b.2).abs() > 1.5;
        list.iter().enumerate().all(|(i, a)| list[..i].iter().all(|b| apart(a, b)))
    })
}

fn tuple(p: &P) -> String {
    format!("({}m, {}m, {}m)", p.0, p.1, p.2)
}

fn list(points: &[P]) -> String {
    format!("[{}]", points.iter().map(tuple).collect::<Vec<_>>().join(", "))
}

/// A curve of each kind that takes points.
fn curve(kind: u8, p: &[P]) -> String {
    match kind % 6 {
        0 => format!("line({}, {})", tuple(&p[0]), tuple(&p[1])),
        1 => format!("polyline({})", list(p)),
        2 => format!("spline({})", list(p)),
        3 => format!("bezier({})", list(p)),
        4 => format!("bspline({}, degree: 3)", list(p)),
        _ => format!("circle(center: {}, radius: {}m, normal: (0, 1, 2))", tuple(&p[0]), p[1].0.abs() + 0.5),
    }
}

#[test]
fn curves_keep_their_lengths_and_points() {
    let folder = folder("curves");
    check(60, &(0u8..6, points(4..7), 5u32..95, (coordinate(), -170i32..170, 1u32..40)), |(kind, p, f, (by, angle, scale))| {
        let scale = f64::from(scale) / 8.0;
        let text = format!(
            "units m\nlet c = {}\nlet length = c.length
let moved = rotate(move(c, by: ({by}m, 1m, 2m)), angle: {angle}deg, axis: (1, 2, 3), about: (0, 1m, 0))
check \"parts add up\": c[..{f}%].length + c[{f}%..].length == length within 1e-9
check \"reversed twice\": distance((-(-c)).at({f}%), c.at({f}%)) == 0m within 1e-9m
check \"reversed\": distance((-c).at({f}%), c.at({}%)) == 0m within 1e-9m
check \"moved\": moved.length == length within 1e-9
check \"moved point\": distance(moved.at({f}%), rotate(move(c.at({f}%), by: ({by}m, 1m, 2m)), angle: {angle}deg, axis: (1, 2, 3), about: (0, 1m, 0))) == 0m within 1e-9m
check \"scaled\": scale(c, by: {scale}, about: (0, 0, 0)).length == length * {scale} within 1e-9
check \"on itself\": distance(c.at({f}%), c) == 0m within 1e-9m
",
            curve(kind, &p),
            100 - f
        );
        sound(&folder, &text).map(|_| ())
    });
}

/// A four-sided boundary whose sides bulge.
fn boundary(bulge: &[f64]) -> String {
    let corner = ["(0, 0, 0)", "(6m, 0, 0.5m)", "(6m, 5m, 0)", "(0, 5m, 1m)"];
    let middle = [(3.0, -1.0), (7.0, 2.5), (3.0, 6.0), (-1.0, 2.5)];
    let side = |k: usize, name: &str| {
        let (x, y) = middle[k];
        format!("curve {name} = spline([{}, ({x}m, {y}m, {}m), {}])\n", corner[k], bulge[k], corner[(k + 1) % 4])
    };
    ["south", "east", "north", "west"].iter().enumerate().map(|(k, name)| side(k, name)).collect()
}

#[test]
fn surfaces_hold_their_borders_and_meshes_hold_surfaces() {
    let folder = folder("surfaces");
    let bulges = proptest::collection::vec(-2.0f64..2.0, 4);
    check(24, &(bulges, 2u32..98, 3u32..9, any::<bool>()), |(bulge, f, n, quads)| {
        let elements = if quads { "quads" } else { "triangles" };
        let text = format!(
            "units m\n{}surface roof = coons(south, east, north, west)
surface other = move(rotate(roof, angle: 40deg, axis: (1, 1, 0), about: (0, 0, 0)), by: (20m, 3m, 1m))
check \"south\": distance(roof.at({f}%, 0), south) == 0m within 1e-8m
check \"east\": distance(roof.at(1, {f}%), east) == 0m within 1e-8m
check \"moved\": other.area == roof.area within 1e-8
mesh fine of roof {{ size: {}mm  elements: {elements} }}
mesh finer of roof {{ size: {}mm  elements: {elements} }}
check \"area\": finer.area == roof.area within 3%
export finer to \"finer.obj\"
export finer to \"finer.stl\"
",
            boundary(&bulge),
            n * 200,
            n * 50
        );
        let report = sound(&folder, &text)?;
        let finer = report.meshes.iter().find(|m| m.name == "finer").unwrap();
        prop_assert!(finer.min_angle.is_some_and(|a| a > 0.0), "an inverted element in\n{text}");
        let back = sound(
            &folder,
            &format!(
                "units m\nimport \"finer.obj\" (unit: m) as obj\nimport \"finer.stl\" (unit: m) as stl\nlet area = {:?} * 1m2\ncheck obj.mesh.area == area within 1e-9\ncheck stl.mesh.area == area within 1e-4\n",
                finer.area.unwrap()
            ),
        );
        back.map(|_| ())
    });
}

#[test]
fn closed_shells_have_the_euler_number_of_a_ball() {
    let folder = folder("closed");
    check(16, &(5u32..40, 1u32..8, 4u32..12), |(radius, height, size)| {
        let (r, h) = (f64::from(radius) / 10.0, f64::from(height) / 2.0);
        let text = format!(
            "units m\nlet axis = line((0, 0, 0), (0, 0, 1m))
curve bottom = line((0, 0, 0), ({r}m, 0, 0))
curve wall = line(bottom.end, ({r}m, 0, {h}m))
curve cap = line(wall.end, (0, 0, {}m))
surface floor = revolve(bottom, axis: axis)
surface side = revolve(wall, axis: axis)
surface top = revolve(cap, axis: axis)
shell can of floor, side, top
mesh m of can {{ size: {}mm }}
check \"closed\": can.closed and m.watertight
check \"euler\": len(m.nodes) - len(m.triangles) / 2 == 2
",
            h + 0.3,
            size * 50
        );
        sound(&folder, &text).map(|_| ())
    });
}

/// The rows of a report by name, in an order of their own.
fn rows(report: &Report) -> Vec<String> {
    let mut out: Vec<String> = report.curves.iter().map(|c| format!("{} {} {:?} {}", c.name, c.kind, c.length, c.links)).collect();
    out.extend(report.surfaces.iter().map(|s| format!("{} {:?} {:?} {} {} {}", s.name, s.flow, s.area, s.patches, s.edges, s.vertices)));
    out.extend(report.meshes.iter().map(|m| format!("{} {} {} {} {:?}", m.name, m.nodes, m.triangles, m.quads, m.hash)));
    out.push(format!("{:?} {:?}", report.network, report.topology));
    out.sort();
    out
}

#[test]
fn the_order_of_declarations_changes_no_geometry() {
    let folder = folder("order");
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let porch = fs::read_to_string(examples.join("porch.loft")).unwrap();
    let head: Vec<&str> = porch.split_inclusive('\n').take_while(|l| !l.starts_with("curve")).collect();
    let rest = &porch[head.iter().map(|l| l.len()).sum()..];
    let mut pieces: Vec<String> = Vec::new();
    for line in rest.split_inclusive('\n') {
        let starts = ["curve", "surface", "shell", "group", "mesh", "check"].iter().any(|w| line.starts_with(w));
        let leaves = ["export", "picture"].iter().any(|w| line.starts_with(w));
        if starts || leaves {
            pieces.push(String::new());
        }
        if let Some(last) = pieces.last_mut() {
            last.push_str(line);
        }
    }
    pieces.retain(|p| !p.starts_with("export") && !p.starts_with("picture"));
    let base = rows(&sound(&folder, &format!("{}{}", head.concat(), pieces.concat())).unwrap());
    let n = pieces.len();
    check(12, &Just((0..n).collect::<Vec<usize>>()).prop_shuffle(), |order| {
        let shuffled: String = order.iter().map(|k| format!("{}\n", pieces[*k].trim_end())).collect();
        let found = rows(&sound(&folder, &format!("{}{shuffled}", head.concat()))?);
        prop_assert_eq!(&found, &base);
        Ok(())
    });
}
