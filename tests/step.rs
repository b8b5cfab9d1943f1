//! STEP files: what programs wrote reads as their facts say, each kind of entity is the curve or surface it describes, the text may be
//! laid out in any way, and no damage to a file breaks the reader.

mod entities;
mod file;
mod malformed;

use std::path::Path;
use std::time::Instant;

use file::{can, file};
use lofting::base::bbox::Box3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::io::cad::part::{Part, ReadOptions};
use lofting::io::files::fault::Malformed;
use lofting::io::step::open;
use lofting::model::measure;
use serde_json::Value as Json;

use crate::support::long::count;
use crate::support::mutate::{Random, mutated};

const OPTIONS: ReadOptions = ReadOptions { model: 1.0, unit: "mm", file: None, origin: Origin::NONE };

/// A file as a model in millimetres would read it, with the faces that it lacks.
fn whole(bytes: &[u8]) -> Part {
    let opened = open(bytes, &OPTIONS).unwrap();
    let tolerance = Tolerance::from_diagonal(opened.reach().diagonal(), 1e-3);
    let mut part = opened.part(tolerance);
    part.build(Origin::NONE, &tolerance);
    part
}

/// Reads a file as a model in millimetres would.
fn read(bytes: &[u8]) -> Result<Part, String> {
    let opened = open(bytes, &OPTIONS).map_err(|at| format!("line {}: {}", at.line, at.what))?;
    let tolerance = Tolerance::from_diagonal(opened.reach().diagonal(), 1e-3);
    let mut part = opened.part(tolerance);
    let mut notes = part.build(Origin::NONE, &tolerance);
    part.warnings.append(&mut notes);
    let left_out = part.unusable.drain(..).map(|face| Malformed::line(face.line, format!("{}: skipped: {}", face.entity, face.cause)));
    part.warnings.extend(left_out);
    Ok(part)
}

fn areas(part: &Part) -> Vec<f64> {
    part.built.iter().flatten().map(measure::area).collect()
}

fn folder(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/imports").join(name)
}

#[test]
fn files_of_other_programs_hold_what_their_facts_say() {
    for (folder_name, name) in [("step-plate-cylinders", "io1-ug-214.stp")] {
        let folder = folder(folder_name);
        let truth: Json = serde_json::from_slice(&std::fs::read(folder.join("truth.json")).unwrap()).unwrap();
        let facts = &truth[name];
        let part = read(&std::fs::read(folder.join(name)).unwrap()).unwrap();
        assert_eq!(part.warnings, [], "{name}");
        assert_eq!(part.surfaces.len() as u64, facts["faces"].as_u64().unwrap(), "{name}");
        assert_eq!((part.solids.len(), part.shells.len()), (1, 1), "{name}");
        let mut found = areas(&part);
        found.sort_by(f64::total_cmp);
        let known: Vec<f64> = facts["face_areas_sorted"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        for (found, known) in found.iter().zip(&known) {
            assert!((found / known - 1.0).abs() < 1e-7, "{name}: {found} {known}");
        }
        let known = facts["bbox"].as_array().unwrap();
        let bounds = part.built.iter().flatten().map(lofting::surface::bbox).fold(Box3::EMPTY, Box3::union);
        for (found, known) in [bounds.min.to_array(), bounds.max.to_array()].concat().iter().zip(known) {
            assert!((found - known.as_f64().unwrap()).abs() < 1e-6, "{name}: {found} {known}");
        }
    }
}

/// The same part however the text is laid out.
#[test]
fn text_may_be_laid_out_in_any_way() {
    let plain = file(&can(".T."), "#21");
    let same = areas(&read(plain.as_bytes()).unwrap());
    assert_eq!(same.len(), 3);
    let no_blanks = plain.replace('\n', "");
    let commented = plain.replace("=", "/* a comment; with ' and #7 = X(); */ = ").replace(",", " /**/ , ");
    let enclosure = plain.replace("(", "\n(\n").replace(",", "\n,\n");
    let long = format!("{}{}", " ".repeat(1 << 20), no_blanks);
    for (what, text) in [
        ("CR LF", plain.replace('\n', "\r\n")),
        ("CR", plain.replace('\n', "\r")),
        ("one line", no_blanks.clone()),
        ("comments", commented),
        ("enclosure", enclosure),
        ("byte order mark", format!("\u{FEFF}{plain}")),
        ("a long line", long),
        ("no end", plain.replace("END-ISO-10303-21;", "")),
        ("lower exponents", plain.replace("1.E-05", "1.e-05")),
    ] {
        let part = read(text.as_bytes()).unwrap_or_else(|why| panic!("{what}: {why}"));
        assert_eq!(areas(&part), same, "{what}: {:?}", part.warnings);
        assert_eq!(part.warnings, [], "{what}");
        let names: Vec<&str> = part.surfaces.iter().map(|s| s.name.as_str()).collect();
        assert_eq!(names, ["side", "foot", "head"], "{what}");
    }
}

/// 300 changed files, 10 000 in a long run; `LOFT_MUTATIONS` says how many.
#[test]
fn mutated_files_never_break_the_reader() {
    let cases = count("LOFT_MUTATIONS", 300, 10_000);
    let mut files: Vec<Vec<u8>> = entities::all().into_iter().map(|(_, text)| text.into_bytes()).collect();
    files.push(std::fs::read(folder("step-plate-cylinders/io1-ug-214.stp")).unwrap());
    let mut random = Random(0x0103_0321);
    // What tests before this one took does not count.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    let mut read_as_parts = 0;
    for case in 0..cases {
        let bytes = mutated(&files[random.below(files.len())], &mut random);
        let start = Instant::now();
        let part = read(&bytes);
        // Slower without optimisation, and beside other tests.
        let seconds = if cfg!(debug_assertions) { 20.0 } else { 2.0 };
        assert!(start.elapsed().as_secs_f64() < seconds, "case {case} took {:?}", start.elapsed());
        read_as_parts += usize::from(part.is_ok_and(|p| !p.surfaces.is_empty() || !p.curves.is_empty()));
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().trim_end_matches("kB").trim().parse::<u64>().ok());
    assert!(peak.is_none_or(|kb| kb < 1 << 20), "{peak:?} kB");
    assert!(read_as_parts * 4 > cases, "most damage leaves something: {read_as_parts} of {cases}");
}

#[test]
fn a_border_far_off_its_surface_is_none_of_it() {
    let fat = |radius: &str| whole(file(&can(".T.").replace("SURFACE('',#4,2.)", &format!("SURFACE('',#4,{radius})")), "#21").as_bytes());
    let (near, far) = (fat("2.1"), fat("3."));
    assert!(near.unusable.is_empty() && near.repairs.len() == 1, "{:?}", near.unusable);
    let causes: Vec<(&str, &str)> = far.unusable.iter().map(|face| (face.entity.as_str(), face.cause.as_str())).collect();
    assert_eq!(causes, [("side at #36", "its border is off its surface by 13 % of its size")]);
    assert_eq!(areas(&far).len(), 2);
}
