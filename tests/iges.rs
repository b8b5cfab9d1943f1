//! IGES files: what programs wrote reads as their facts say, each kind of entity is the curve or surface it describes, and no
//! damage to a file breaks the reader.

mod entities;
mod file;
mod loops;
mod solids;
mod written;

use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::time::Instant;

use lofting::base::bbox::Box3;
use lofting::base::origin::Origin;
use lofting::base::quadrature::gauss_legendre;
use lofting::base::tolerance::Tolerance;
use lofting::io::files::fault::Malformed;
use lofting::io::iges::{Part, ReadOptions, open};
use lofting::model::measure;
use lofting::surface::{Domain, Surface};
use serde_json::Value as Json;

use crate::support::long::count;
use crate::support::mutate::{Random, mutated};

const OPTIONS: ReadOptions = ReadOptions { model: 1.0, unit: "mm", file: None, origin: Origin::NONE };

/// Reads a file as a model in millimetres would.
fn read(bytes: &[u8], options: &ReadOptions) -> Result<Part, String> {
    let opened = open(bytes, options).map_err(|at| format!("line {}: {}", at.line, at.what))?;
    let tolerance = Tolerance::from_diagonal(opened.reach().diagonal(), 1e-3);
    let mut part = opened.part(tolerance);
    let mut notes = part.build(Origin::NONE, &tolerance);
    part.warnings.append(&mut notes);
    let left_out = part.unusable.drain(..).map(|face| Malformed::line(face.line, format!("{}: skipped: {}", face.entity, face.cause)));
    part.warnings.extend(left_out);
    Ok(part)
}

/// Area over 0…1 by Gauss' rule on every piece.
fn area(surface: &Surface) -> f64 {
    let rule = gauss_legendre(12);
    let (us, vs) = surface.breaks();
    let stops = |inner: &[f64]| [&[0.0], inner, &[1.0]].concat();
    let (us, vs) = (stops(&us), stops(&vs));
    let mut sum = 0.0;
    for (u, v) in us.windows(2).flat_map(|u| vs.windows(2).map(move |v| (u, v))) {
        for ((x, a), (y, b)) in rule.iter().flat_map(|p| rule.iter().map(move |q| (p, q))) {
            let at = |s: &[f64], x: f64| s[0] + (s[1] - s[0]) * 0.5 * (1.0 + x);
            let jet = surface.jet(at(u, *x), at(v, *y));
            sum += 0.25 * a * b * (u[1] - u[0]) * (v[1] - v[0]) * jet.du.cross(jet.dv).length();
        }
    }
    sum
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// Files of all folders with their facts.
fn facts() -> Vec<(String, Vec<u8>, Json)> {
    let mut found = Vec::new();
    let names = ["45-trimmed", "fuselage-solidworks", "lens-untrimmed", "nurbs-wings", "rhino-plane", "rounded-cube"];
    for folder in names.map(|name| folder(&format!("iges-{name}"))) {
        let truth: Json = serde_json::from_slice(&std::fs::read(folder.join("truth.json")).unwrap()).unwrap();
        for (name, facts) in truth.as_object().unwrap() {
            found.push((name.clone(), std::fs::read(folder.join(name)).unwrap(), facts.clone()));
        }
    }
    found
}

/// The file that its reference reader took for inches: a path in its global section says 38 characters and has 32, which
/// moves all later fields by one, the unit among them. The file itself says millimetres twice.
const MISREAD: &str = "testfile.igs";

fn options_for(name: &str) -> ReadOptions {
    ReadOptions { file: (name == MISREAD).then_some(25.4), ..OPTIONS }
}

fn numbers(list: &Json) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn files_of_other_programs_hold_what_their_facts_say() {
    for (name, bytes, facts) in facts() {
        let opened = open(&bytes, &options_for(&name)).unwrap();
        if let Some(counts) = facts["iges_entities"].as_object() {
            let found = opened.counts();
            // The reference reader counts what it knows.
            for (kind, n) in counts {
                assert_eq!(found.get(&kind.parse().unwrap()).copied(), n.as_u64().map(|n| n as usize), "{name}: entities {kind}");
            }
        }
        let part = read(&bytes, &options_for(&name)).unwrap();
        let faces = facts["faces"].as_u64().or(facts["surfaces"].as_u64()).unwrap();
        assert_eq!(part.surfaces.len() as u64, faces, "{name}: {:?}", part.warnings);
        if let Some(known) = facts.get("areas_file_units") {
            for (found, known) in part.surfaces.iter().map(|s| area(&s.value.base)).zip(numbers(known)) {
                // Figures have ten digits, in square inches.
                assert!((found / 645.16 / known - 1.0).abs() < 2e-9, "{name}: {found} {known}");
            }
            continue;
        }
        // Each face has its partner among the known areas, which their reader found to about 1e-5 of each.
        let known = numbers(&facts["face_areas_sorted"]);
        let built: Vec<&Surface> = part.built.iter().flatten().collect();
        let mut areas: Vec<f64> = built.iter().map(|s| measure::area(s)).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas.len(), known.len(), "{name}: {:?}", part.warnings);
        for (found, known) in areas.iter().zip(&known) {
            assert!((found / known - 1.0).abs() < 2e-5, "{name}: {found} {known}");
        }
        let total: f64 = areas.iter().sum();
        let known = facts["area"].as_f64().unwrap();
        assert!((total - known).abs() <= 2e-6 * known, "{name}: {total} {known}");
    }
}

#[test]
fn boxes_of_files_are_as_known() {
    for (name, bytes, facts) in facts() {
        let part = read(&bytes, &options_for(&name)).unwrap();
        let mut bounds = Box3::EMPTY;
        for face in part.surfaces.iter().map(|s| &s.value) {
            bounds = match &face.outer {
                Some(outer) => outer.iter().map(|b| b.space.bbox()).fold(bounds, Box3::union),
                None if facts.get("control_bbox").is_some() => bounds.union(face.base.hull()),
                None => bounds.union(lofting::surface::bbox(&face.base)),
            };
        }
        bounds = part.curves.iter().map(|c| c.value.bbox()).fold(bounds, Box3::union);
        let in_inches = facts.get("control_bbox").is_some();
        let known = numbers(if in_inches { &facts["control_bbox"] } else { &facts["bbox"] });
        let scale = if in_inches { 25.4 } else { 1.0 };
        let found = [bounds.min.to_array(), bounds.max.to_array()].concat();
        let size = bounds.diagonal();
        for (k, (found, known)) in found.iter().zip(&known).enumerate() {
            // Control points of trimming curves and of splines reach beyond them; what is known lies inside.
            let beyond = if k < 3 { known * scale - found } else { found - known * scale };
            let room =
                if name == "sample_curves.igs" || name.starts_with("example_45") || name == "fuse.igs" { 0.5 * size } else { 1e-5 * size };
            assert!(beyond > -1e-5 * size && beyond < room, "{name}: {found} against {known}, {beyond}");
        }
    }
}

#[test]
fn borders_lie_on_their_surfaces_and_close() {
    for (name, gap) in [
        ("45-trimmed/example_45_faces.iges", 3e-4),
        ("fuselage-solidworks/fuse.igs", 1e-6),
        ("rounded-cube/single_rounded_cube.iges", 1e-6),
    ] {
        let bytes = std::fs::read(folder(&format!("iges-{name}"))).unwrap();
        let part = read(&bytes, &OPTIONS).unwrap();
        for face in part.surfaces.iter().map(|s| &s.value) {
            assert!(face.off.distance <= gap, "{name}: {}", face.off.distance);
            for loop_of in face.outer.iter().chain(&face.holes) {
                for (k, border) in loop_of.iter().enumerate() {
                    let next = &loop_of[(k + 1) % loop_of.len()];
                    assert!(border.space.end().distance(next.space.start()) <= gap, "{name}");
                }
            }
        }
    }
}

#[test]
fn curves_of_a_file_are_exact() {
    let bytes = std::fs::read(folder("iges-rounded-cube/sample_curves.igs")).unwrap();
    let part = read(&bytes, &OPTIONS).unwrap();
    let kinds: Vec<&str> = part.curves.iter().map(|c| c.value.kind().name()).collect();
    assert_eq!(kinds, ["nurbs", "line", "line", "line", "circle", "arc", "composite", "ellipse", "polyline"]);
    let integral = |a: f64, b: f64, speed: &dyn Fn(f64) -> f64| {
        gauss_legendre(64).iter().map(|(x, w)| 0.5 * (b - a) * w * speed(0.5 * (a + b) + 0.5 * (b - a) * x)).sum::<f64>()
    };
    // The cubic (−4,−4) (−1.5,7,3.5) (4,−3,1) (4,4); 4x² + 9y² = 36 from −135° to 30° of its angle.
    let cubic = integral(0.0, 1.0, &|t| {
        let s = 1.0 - t;
        let side = |a: f64, b: f64, c: f64| 3.0 * (a * s * s + 2.0 * b * s * t + c * t * t);
        (side(2.5, 5.5, 0.0).powi(2) + side(11.0, -10.0, 7.0).powi(2) + side(3.5, -2.5, -1.0).powi(2)).sqrt()
    });
    let ellipse = integral(-0.75 * PI, PI / 6.0, &|t| (9.0 * t.sin().powi(2) + 4.0 * t.cos().powi(2)).sqrt());
    let five = 5.0_f64.sqrt();
    let polyline = 2.0 * 6.0_f64.sqrt() + 2.0_f64.sqrt() + 3.0_f64.sqrt();
    let expected = [cubic, five, five, five, 2.0 * PI, 7.0 * PI / 6.0, 3.0 * PI + 8.0_f64.sqrt(), ellipse, polyline];
    for (curve, expected) in part.curves.iter().zip(expected) {
        assert!((curve.value.length() / expected - 1.0).abs() < 1e-11, "{}: {} {expected}", curve.name, curve.value.length());
    }
    assert_eq!(part.points.iter().map(|p| p.value.len()).collect::<Vec<_>>(), [5]);
    assert_eq!(part.warnings.len(), 2, "two lines without end: {:?}", part.warnings);
}

#[test]
fn names_and_colours_of_a_file_are_kept() {
    let bytes = std::fs::read(folder("iges-rhino-plane/testfile.igs")).unwrap();
    let part = read(&bytes, &OPTIONS).unwrap();
    assert_eq!((part.unit, part.surfaces[0].name.as_str()), ("MM", "test"));
    let bytes = std::fs::read(folder("iges-fuselage-solidworks/fuse.igs")).unwrap();
    let part = read(&bytes, &OPTIONS).unwrap();
    assert_eq!((part.colors.len(), part.colors[0].0.surfaces.len()), (1, 5));
}

#[test]
fn files_that_stop_early_say_where() {
    let cases = [
        ("first_line_82_cols.iges", "line 1: the file ends before its global section (G)"),
        ("first_line_without_80_cols.iges", "line 5: the file has no directory section (D)"),
        ("up_to_line_7_of_DE_section.iges", "line 12: the file ends in its directory section: there is no parameter section (P)"),
    ];
    for (name, expected) in cases {
        let bytes = std::fs::read(folder("iges-malformed-small").join(name)).unwrap();
        assert_eq!(read(&bytes, &OPTIONS).err().as_deref(), Some(expected), "{name}");
    }
    for (bytes, expected) in [
        (&b""[..], "line 1: the file is empty"),
        (b"\n\n", "line 1: the file is empty"),
        (b"solid cube\n facet normal 0 0 1\n", "line 1: this is not an IGES file: column 73 holds none of the letters S, G, D, P and T"),
    ] {
        assert_eq!(read(bytes, &OPTIONS).err().as_deref(), Some(expected));
    }
}

/// The same geometry however the columns suffered, with a word about it.
#[test]
fn broken_columns_are_read_with_a_warning() {
    let bytes = std::fs::read(folder("iges-rounded-cube/single_rounded_cube.iges")).unwrap();
    let text = String::from_utf8(bytes).unwrap().replace('\r', "");
    let lines: Vec<&str> = text.lines().collect();
    let edit =
        |f: &dyn Fn(usize, &str) -> Option<String>| lines.iter().enumerate().filter_map(|(k, l)| f(k, l)).collect::<Vec<_>>().join("\n");
    let letter = |line: &str| line.as_bytes().get(72).copied().unwrap_or(b' ');
    let first_p = lines.iter().position(|l| letter(l) == b'P').unwrap();
    let cases: Vec<(&str, String, &str)> = vec![
        ("\\r\\n", edit(&|_, l| Some(format!("{l}\r"))), ""),
        ("only \\r", lines.join("\r"), ""),
        ("no T", edit(&|_, l| (letter(l) != b'T').then(|| l.to_owned())), "terminating line"),
        (
            "over-long first line",
            edit(&|k, l| Some(if k == 0 { format!("{}  {}", &l[..72], &l[72..]) } else { l.to_owned() })),
            "column 75",
        ),
        (
            "a column lost in a P line",
            edit(&|k, l| Some(if k == first_p + 4 { l.replacen("  ", " ", 1) } else { l.to_owned() })),
            "column 72",
        ),
        ("numbers of D lines lost", edit(&|_, l| Some(if letter(l) == b'D' { l[..73].to_owned() } else { l.to_owned() })), "do not ascend"),
        (
            "pointers back lost",
            edit(&|_, l| Some(if letter(l) == b'P' { format!("{:<72}{}", &l[..64], &l[72..]) } else { l.to_owned() })),
            "",
        ),
        (
            "line counts wrong",
            edit(&|_, l| Some(l.replacen("       0       0       2       0  ", "       0       0       9       0  ", 1))),
            "9 lines",
        ),
    ];
    let same = |part: &Part| part.surfaces.iter().map(|s| s.value.base.hull().diagonal()).collect::<Vec<_>>();
    let whole = read(text.as_bytes(), &OPTIONS).unwrap();
    for (what, text, expected) in cases {
        let part = read(text.as_bytes(), &OPTIONS).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert_eq!(same(&part), same(&whole), "{what}: {:?}", part.warnings);
        assert!(part.warnings.iter().any(|w| w.what.contains(expected)) || expected.is_empty(), "{what}: {:?}", part.warnings);
    }
}

/// A damaged entity costs itself and what stands on it.
#[test]
fn the_rest_of_a_damaged_file_is_usable() {
    let bytes = std::fs::read(folder("iges-45-trimmed/example_45_faces.iges")).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let parameters = text.lines().position(|l| l.as_bytes().get(72) == Some(&b'P')).unwrap();
    let damaged: Vec<String> = text
        .lines()
        .enumerate()
        .map(|(k, l)| if k == parameters + 3 { l.replacen("128,", "12x,", 1).replacen('.', "x", 2) } else { l.to_owned() })
        .collect();
    let part = read(damaged.join("\n").as_bytes(), &OPTIONS).unwrap();
    assert_eq!(part.surfaces.len(), 44, "{:?}", part.warnings);
    assert!(part.warnings.iter().any(|w| w.what.contains("entity 128 at D3") && w.line > 0), "{:?}", part.warnings);
}

/// 400 changed files, 10 000 in a long run; `LOFT_MUTATIONS` says how many.
#[test]
fn mutated_files_never_break_the_reader() {
    let cases = count("LOFT_MUTATIONS", 400, 10_000);
    let mut files: Vec<Vec<u8>> = facts().into_iter().map(|f| f.1).collect();
    files.extend(entities::all().into_iter().map(|(_, text)| text.into_bytes()));
    let mut random = Random(0x1005_5EED);
    // What tests before this one took does not count.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    let mut read_as_parts = 0;
    for case in 0..cases {
        let bytes = mutated(&files[random.below(files.len())], &mut random);
        let start = Instant::now();
        let part = read(&bytes, &OPTIONS);
        // Slower without optimisation, and beside other tests.
        let seconds = if cfg!(debug_assertions) { 20.0 } else { 2.0 };
        assert!(start.elapsed().as_secs_f64() < seconds, "case {case} took {:?}", start.elapsed());
        if let Ok(part) = part {
            read_as_parts += 1;
            assert!(part.surfaces.iter().all(|s| s.value.base.domain() != Domain::Square || !s.value.base.hull().diagonal().is_nan()));
        }
    }
    // 2 GiB, with all tests that run beside this one.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().trim_end_matches("kB").trim().parse::<u64>().ok());
    assert!(peak.is_none_or(|kb| kb < 2 << 20), "{peak:?} kB");
    assert!(read_as_parts * 4 > cases, "most damage leaves something: {read_as_parts} of {cases}");
}
