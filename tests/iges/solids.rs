//! Shells go out as solids and shells of faces that share their edges, and come back as such.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::{Command, Output};

use lofting::io::iges::Part;

use super::{OPTIONS, read};

/// A box, a can with two cavities, a cone, a ball, a ring, a net with poles, two bodies in one shell, a plate with a hole.
const MODEL: &str = r#"units mm
curve rim = polyline([(0, 0, 0), (10, 0, 0), (10, 20, 0), (0, 20, 0)], closed: true)
surface foot = plane(rim)
surface head = move(foot, by: (0, 0, 30))
surface walls = extrude(rim, by: (0, 0, 30))
shell crate of foot, head, walls
curve circle_a = circle(center: (50, 0, 0), radius: 5mm)
surface can_wall = extrude(circle_a, by: (0, 0, 30))
surface can_foot = plane(circle_a)
surface can_head = move(can_foot, by: (0, 0, 30))
surface bubble = revolve(arc((50, 0, 8), (50, 0, 12), through: (52, 0, 10)), axis: line((50, 0, 0), (50, 0, 1)))
surface upper = move(bubble, by: (0, 0, 10))
shell can of can_wall, can_foot, can_head, bubble, upper
surface hat = revolve(line((100, 0, 10), (105, 0, 0)), axis: line((100, 0, 0), (100, 0, 1)))
surface hat_foot = plane(circle(center: (100, 0, 0), radius: 5mm))
shell cone of hat, hat_foot
surface ring_face = revolve(circle(center: (150, 0, 0), radius: 2, normal: (0, 1, 0)), axis: line((140, 0, 0), (140, 0, 1)))
shell ring of ring_face
surface egg_face = revolve(spline([(120, 0, 0), (125, 0, 5), (120, 0, 12)]), axis: line((120, 0, 0), (120, 0, 1)))
shell egg of egg_face
shell both of ring_face, egg_face
surface sail = ruled(spline([(80, 0, 0), (85, 3, 2), (90, 0, 0)]), line((80, 10, 0), (90, 10, 5)))
surface plate = trim(sail, holes: project(circle(center: (85, 5, 0), radius: 1mm), onto: sail, along: (0, 0, 1)))
shell sheet of plate
group outer of crate, circle_a
group round of crate, can
"#;
const SHELLS: [&str; 7] = ["crate", "can", "cone", "ring", "egg", "both", "sheet"];

fn run(folder: &str, name: &str, script: &str) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join(name), script).unwrap();
    Command::new(env!("CARGO_BIN_EXE_loft")).args(["run", name]).current_dir(&folder).output().unwrap()
}

fn well(folder: &str, name: &str, script: &str) {
    let done = run(folder, name, script);
    assert!(done.status.success(), "{name}: {}{}", String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
}

fn file(folder: &str, name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder).join(name)).unwrap()
}

/// A script that writes each shell into a file of its own and all into one.
fn writing() -> String {
    let one = SHELLS.map(|name| format!("export {name} to \"{name}.igs\"\n")).concat();
    format!("{MODEL}{one}export {}, circle_a to \"all.igs\"\n", SHELLS.join(", "))
}

/// Entities by pointers: kind, form, level, status, and parameters as numbers, texts left out.
struct Entities(BTreeMap<i64, (u32, i32, i32, String, Vec<f64>)>);

impl Entities {
    fn of(text: &str) -> Self {
        let lines = |letter: char| text.lines().filter(move |line| line.as_bytes()[72] == letter as u8).collect::<Vec<&str>>();
        let mut parameters: BTreeMap<i64, String> = BTreeMap::new();
        for line in lines('P') {
            parameters.entry(line[64..72].trim().parse().unwrap()).or_default().push_str(&line[..64]);
        }
        let field = |line: &str, k: usize| line[8 * k..8 * k + 8].trim().parse::<i32>().unwrap_or(0);
        let mut all = BTreeMap::new();
        for (k, pair) in lines('D').chunks(2).enumerate() {
            let d = 2 * k as i64 + 1;
            let values = parameters[&d].trim_end().trim_end_matches(';').split(',').skip(1);
            let values = values.map(|value| value.trim().parse().unwrap_or(f64::NAN)).collect();
            all.insert(d, (field(pair[0], 0) as u32, field(pair[1], 4), field(pair[0], 4), pair[0][64..72].to_owned(), values));
        }
        Self(all)
    }

    fn of_kind(&self, kind: u32) -> Vec<(i64, &[f64])> {
        self.0.iter().filter(|(_, e)| e.0 == kind).map(|(d, e)| (*d, e.4.as_slice())).collect()
    }

    fn count(&self, kind: u32) -> usize {
        self.of_kind(kind).len()
    }

    fn values(&self, d: f64) -> &[f64] {
        &self.0[&(d as i64)].4
    }
}

/// The uses of a loop: vertex or edge, pointer and place, forward, count of curves in (u, v).
fn uses(values: &[f64]) -> Vec<(bool, (i64, i64), bool, usize)> {
    let (mut all, mut at) = (Vec::new(), 1);
    for _ in 0..values[0] as usize {
        let n = values[at + 4] as usize;
        all.push((values[at] == 1.0, (values[at + 1] as i64, values[at + 2] as i64), values[at + 3] == 1.0, n));
        at += 5 + 2 * n;
    }
    assert_eq!(at, values.len(), "nothing stands behind the last use of a loop");
    all
}

#[test]
fn edges_of_closed_shells_are_used_once_each_way() {
    well("iges-solids-edges", "model.loft", &writing());
    let all = Entities::of(&file("iges-solids-edges", "all.igs"));
    // A solid each of five shells and two of one, one of them with two cavities, and an open shell.
    assert_eq!((all.count(186), all.count(514), all.count(144), all.count(402)), (7, 10, 0, 1));
    assert_eq!([192, 194, 196, 198].map(|kind| all.count(kind)), [1, 1, 2, 2]);
    let (_, can) = all.of_kind(186)[1];
    // Behind its cavities stand no groups and one property, the name.
    assert_eq!((can[2], &can[7..9], can.len()), (2.0, &[0.0, 1.0][..], 10), "a can has two cavities: {can:?}");
    for (d, shell) in all.of_kind(514) {
        let form = all.0[&d].1;
        let mut seen: BTreeMap<(i64, i64), Vec<bool>> = BTreeMap::new();
        for face in shell[1..1 + 2 * shell[0] as usize].chunks(2) {
            let (face, along) = (all.values(face[0]), face[1] == 1.0);
            assert_eq!(
                (face[1] as usize, face[2]),
                (face[3..].iter().take_while(|d| all.0.get(&(**d as i64)).is_some_and(|e| e.0 == 508)).count(), 1.0)
            );
            for around in &face[3..3 + face[1] as usize] {
                let mut ends = Vec::new();
                for (is_vertex, of, forward, _) in uses(all.values(*around)) {
                    if is_vertex {
                        ends.push((of.1, of.1));
                        continue;
                    }
                    let edge = &all.values(of.0 as f64)[1 + 5 * (of.1 as usize - 1)..][..5];
                    assert_eq!(edge[1], edge[3], "one list of vertices");
                    let (a, b) = (edge[2] as i64, edge[4] as i64);
                    ends.push(if forward { (a, b) } else { (b, a) });
                    seen.entry(of).or_default().push(forward == along);
                }
                for (k, (_, end)) in ends.iter().enumerate() {
                    assert_eq!(*end, ends[(k + 1) % ends.len()].0, "the loop at D{around} closes");
                }
            }
        }
        for (edge, mut uses) in seen {
            uses.sort_unstable();
            assert!(if form == 1 { uses == [false, true] } else { uses.len() <= 2 }, "edge {edge:?} of shell D{d}: {uses:?}");
        }
        let status = all.0[&d].3.as_str();
        assert_eq!(
            status,
            if form == 1 { "00010001" } else { "00000001" },
            "a shell of a solid is a part of it, an open one stands for itself"
        );
    }
    // The cone has its apex in the loop, the net two poles, each with its way in (u, v).
    let poles = |name: &str| {
        let own = Entities::of(&file("iges-solids-edges", name));
        own.of_kind(508).into_iter().flat_map(|(_, values)| uses(values)).filter(|of| of.0).map(|of| of.3).collect::<Vec<usize>>()
    };
    assert_eq!((poles("cone.igs"), poles("egg.igs")), (vec![0], vec![1, 1]));
}

/// Parts with names of bodies, faces of each, and layers.
fn part(folder: &str, name: &str) -> Part {
    let part = read(file(folder, name).as_bytes(), &OPTIONS).unwrap();
    assert_eq!(part.warnings, [], "{name}: nothing to remark");
    part
}

#[test]
fn solids_come_back_with_names_and_layers() {
    well("iges-solids-back", "model.loft", &writing());
    let found = part("iges-solids-back", "all.igs");
    let names = |groups: &[lofting::io::iges::Group]| groups.iter().map(|g| (g.name.clone(), g.surfaces.len())).collect::<Vec<_>>();
    let said = |list: &[(&str, usize)]| list.iter().map(|(name, n)| ((*name).to_owned(), *n)).collect::<Vec<_>>();
    let solids = [("crate", 6), ("can", 5), ("cone", 2), ("ring", 1), ("egg", 1), ("both_1", 1), ("both_2", 1)];
    assert_eq!(names(&found.solids), said(&solids));
    assert!(names(&found.groups).contains(&("both".to_owned(), 2)), "several bodies are a group");
    assert_eq!(names(&found.shells).last(), said(&[("sheet", 1)]).first());
    let faces: BTreeSet<&str> = found.surfaces.iter().map(|s| s.name.as_str()).collect();
    assert!(["foot", "head", "can_wall", "bubble", "hat", "plate"].iter().all(|name| faces.contains(name)), "{faces:?}");
    let layers: Vec<(&str, usize, usize)> = found.layers.iter().map(|l| (l.name.as_str(), l.surfaces.len(), l.curves.len())).collect();
    assert_eq!(layers, [("outer", 6, 1), ("round", 11, 0)]);
    // Areas and volumes as they were.
    let checks = SHELLS.map(|name| {
        // The hole of the sheet is a curve within the tolerance.
        if name == "sheet" {
            return format!("check area(part_{name}) == area(model.{name}) within 0.00005%\n");
        }
        ["area", "volume"].map(|of| format!("check {of}(part_{name}) == {of}(model.{name}) within 0.0000001%\n")).concat()
    });
    let imports = SHELLS.map(|name| format!("import \"{name}.igs\" as part_{name}\n"));
    well("iges-solids-back", "reads.loft", &format!("units mm\nuse \"model.loft\" as model\n{}{}", imports.concat(), checks.concat()));
}

#[test]
fn colours_and_layers_of_an_imported_part_are_kept() {
    let folder = "iges-solids-looks";
    let imported = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/imports/parts/painted.step");
    let into = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    std::fs::create_dir_all(&into).unwrap();
    std::fs::copy(imported, into.join("painted.step")).unwrap();
    well(folder, "model.loft", "units mm\nimport \"painted.step\" as part\nexport part to \"once.igs\"\n");
    well(folder, "again.loft", "units mm\nimport \"once.igs\" as part\nexport part to \"twice.igs\"\n");
    let (once, twice) = (part(folder, "once.igs"), part(folder, "twice.igs"));
    let looks = |part: &Part| {
        let faces = part.surfaces.iter().map(|s| (s.own.clone(), s.color.map(|rgb| rgb.map(|x| (1e6 * x).round() as i64))));
        let layers = part.layers.iter().map(|l| (l.name.clone(), l.surfaces.len()));
        (faces.collect::<Vec<_>>(), layers.collect::<Vec<_>>(), part.solids.len())
    };
    assert!(once.surfaces.iter().any(|s| s.color.is_some()) && !once.solids.is_empty());
    assert_eq!(looks(&once), looks(&twice));
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    well("iges-solids-bytes", "model.loft", &writing());
    let first = file("iges-solids-bytes", "all.igs");
    well("iges-solids-bytes", "model.loft", &writing());
    assert_eq!(first, file("iges-solids-bytes", "all.igs"));
}

#[test]
fn shells_go_out_as_trimmed_surfaces_where_that_is_asked_for() {
    well("iges-solids-faces", "model.loft", &format!("{MODEL}export can to \"can.igs\" {{ shells: faces }}\n"));
    let all = Entities::of(&file("iges-solids-faces", "can.igs"));
    assert_eq!((all.count(186), all.count(514), all.count(128), all.count(144), all.count(402)), (0, 0, 5, 2, 1));
    let done = run("iges-solids-faces", "model.loft", &format!("{MODEL}export can to \"can.step\" {{ shells: faces }}\n"));
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(!done.status.success() && said.contains("`shells:` is for IGES files"), "{said}");
}
