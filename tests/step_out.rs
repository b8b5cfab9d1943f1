//! STEP files that models write: references lead somewhere, faces share edges, names and units are kept, and the same model gives the same
//! bytes.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// A box and a can with two cavities, a plate with a hole, a curve and a point.
const MODEL: &str = r#"units mm
curve rim = polyline([(0, 0, 0), (10, 0, 0), (10, 20, 0), (0, 20, 0)], closed: true)
surface foot = plane(rim)
surface head = move(foot, by: (0, 0, 30))
surface walls = extrude(rim, by: (0, 0, 30))
shell 벽 of foot, head, walls
curve circle_a = circle(center: (50, 0, 0), radius: 5mm)
surface can_wall = extrude(circle_a, by: (0, 0, 30))
surface can_foot = plane(circle_a)
surface can_head = move(can_foot, by: (0, 0, 30))
surface bubble = revolve(arc((50, 0, 8), (50, 0, 12), through: (52, 0, 10)), axis: line((50, 0, 0), (50, 0, 1)))
surface upper = move(bubble, by: (0, 0, 10))
shell can of can_wall, can_foot, can_head, bubble, upper
surface sail = ruled(spline([(80, 0, 0), (85, 3, 2), (90, 0, 0)]), line((80, 10, 0), (90, 10, 5)))
surface plate = trim(sail, holes: project(circle(center: (85, 5, 0), radius: 1mm), onto: sail, along: (0, 0, 1)))
group outer of 벽, circle_a
export 벽, can, plate, circle_a, (1mm, 2mm, 3mm) to "all.step"
export 벽 to "inch.stp" { units: inch  schema: ap214 }
"#;

/// Runs a model into a folder of its own; gives the files it wrote.
pub(super) fn run(name: &str, model: &str) -> BTreeMap<String, String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("step_out_{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let script = folder.join("model.loft");
    fs::write(&script, model).unwrap();
    let done = Command::new(env!("CARGO_BIN_EXE_loft"))
        .arg("run")
        .arg(&script)
        .arg("-o")
        .arg(&folder)
        .arg("--allow")
        .arg(env!("CARGO_TARGET_TMPDIR"))
        .output()
        .unwrap();
    assert!(done.status.success(), "{}{}", String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
    let files = fs::read_dir(&folder).unwrap().map(|f| f.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e != "loft"));
    files.map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), fs::read_to_string(p).unwrap())).collect()
}

/// Records of a file by their numbers.
pub(super) fn records(text: &str) -> BTreeMap<u32, &str> {
    let data = text.split("DATA;\n").nth(1).unwrap().split("ENDSEC;").next().unwrap();
    let record = |line: &'_ str| {
        let (id, rest) = line.strip_suffix(';').unwrap().split_once('=').unwrap();
        (id[1..].parse().unwrap(), rest.len())
    };
    data.lines().map(|line| (record(line).0, &line[line.len() - 1 - record(line).1..line.len() - 1])).collect()
}

/// Numbers of the records that a record refers to, texts left out.
fn references(record: &str) -> Vec<u32> {
    let plain: String = record.split('\'').step_by(2).collect();
    plain.split('#').skip(1).map(|rest| rest.chars().take_while(char::is_ascii_digit).collect::<String>().parse().unwrap()).collect()
}

pub(super) fn of_type<'a>(all: &'a BTreeMap<u32, &'a str>, name: &str) -> Vec<(u32, &'a str)> {
    let open = format!("{name}(");
    all.iter().filter(|(_, r)| r.starts_with(&open)).map(|(id, r)| (*id, *r)).collect()
}

#[test]
fn references_lead_to_earlier_records() {
    for (name, text) in run("references", MODEL) {
        assert!(text.is_ascii(), "{name}");
        let all = records(&text);
        for (id, record) in &all {
            for other in references(record) {
                assert!(other < *id && all.contains_key(&other), "{name}: #{id} refers to #{other}");
            }
            assert!(!record.contains("NaN") && !record.contains("inf"), "{name}: #{id}={record}");
            assert!(*record != "DIRECTION('',(0.,0.,0.))", "{name}: #{id} has no length");
        }
    }
}

/// Each edge of a closed shell is used once each way; faces close round their vertices.
#[test]
fn faces_share_edges() {
    let files = run("edges", MODEL);
    let all = records(&files["all.step"]);
    let count = |name: &str| of_type(&all, name).len();
    assert_eq!((count("MANIFOLD_SOLID_BREP"), count("BREP_WITH_VOIDS"), count("ORIENTED_CLOSED_SHELL")), (1, 1, 2));
    assert_eq!((count("CLOSED_SHELL"), count("OPEN_SHELL"), count("SHELL_BASED_SURFACE_MODEL")), (4, 1, 1));
    assert_eq!((count("PLANE"), count("CYLINDRICAL_SURFACE"), count("SPHERICAL_SURFACE"), count("GEOMETRIC_CURVE_SET")), (8, 1, 2, 2));
    for (_, shell) in of_type(&all, "CLOSED_SHELL") {
        let mut uses: BTreeMap<u32, Vec<bool>> = BTreeMap::new();
        for face in references(shell) {
            for bound in references(all[&face]).into_iter().filter(|b| all[b].starts_with("FACE_")) {
                let around = references(all[&references(all[&bound])[0]]);
                let step = |use_of: u32| {
                    let forward = all[&use_of].ends_with(".T.)");
                    let edge = references(all[&use_of])[0];
                    let ends = references(all[&edge]);
                    (edge, forward, if forward { (ends[0], ends[1]) } else { (ends[1], ends[0]) })
                };
                let steps: Vec<_> = around.into_iter().map(step).collect();
                for (k, (edge, forward, ends)) in steps.iter().enumerate() {
                    assert_eq!(ends.1, steps[(k + 1) % steps.len()].2.0, "the loop of face #{face} closes");
                    uses.entry(*edge).or_default().push(*forward);
                }
            }
        }
        for (edge, mut uses) in uses {
            uses.sort_unstable();
            assert_eq!(uses, [false, true], "edge #{edge} of a closed shell");
        }
    }
    let (_, plate) = of_type(&all, "ADVANCED_FACE").into_iter().find(|(_, r)| r.contains("'plate'")).unwrap();
    assert_eq!(references(plate).len(), 3, "an outer and an inner bound on a surface: {plate}");
}

#[test]
fn names_layers_units_and_measures_are_kept() {
    let files = run("names", MODEL);
    let all = records(&files["all.step"]);
    let name = "'\\X2\\BCBD\\X0\\'";
    assert!(of_type(&all, "MANIFOLD_SOLID_BREP")[0].1.contains(name));
    let (_, layer) = of_type(&all, "PRESENTATION_LAYER_ASSIGNMENT")[0];
    assert!(layer.contains("'outer'") && references(layer).len() == 2, "{layer}");
    let measure = |all: &BTreeMap<u32, &str>, name: &str| -> f64 {
        let (_, item) = of_type(all, "MEASURE_REPRESENTATION_ITEM").into_iter().find(|(_, r)| r.contains(name)).unwrap();
        item.split("MEASURE(").nth(1).unwrap().split(')').next().unwrap().parse().unwrap()
    };
    let balls = 2.0 * 4.0 / 3.0 * std::f64::consts::PI * 8.0;
    let wanted = 6000.0 + 750.0 * std::f64::consts::PI - balls;
    assert!((measure(&all, "VOLUME_MEASURE") / wanted - 1.0).abs() < 1e-9);
    let inch = records(&files["inch.stp"]);
    assert!(inch.values().any(|r| r.contains("CONVERSION_BASED_UNIT('INCH'")));
    assert!(files["inch.stp"].contains("FILE_SCHEMA(('AUTOMOTIVE_DESIGN"));
    assert!((measure(&inch, "VOLUME_MEASURE") * 25.4_f64.powi(3) / 6000.0 - 1.0).abs() < 1e-9);
    // A file of one thing is named for it.
    assert!(of_type(&inch, "PRODUCT")[0].1.contains(name));
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    assert_eq!(run("first", MODEL), run("second", MODEL));
}

#[test]
fn corners_of_curves_that_miss_each_other_are_one_vertex() {
    let model = r#"units mm
let south = line((0, 0, 0), (400, 0, 0))
let north = line((0, 300, 0), (400, 300, 0.4))
let west = line(south.start, north.start)
let east = line(south.end, (400, 300, 0))
surface patch = gordon(profiles: [south, north], guides: [west, east], tolerance: 0.5mm)
export patch to "patch.step"
"#;
    let files = run("corners", model);
    let records = records(&files["patch.step"]);
    let of = |kind: &str| records.values().filter(|r| r.starts_with(kind)).count();
    assert_eq!((of("VERTEX_POINT"), of("EDGE_CURVE")), (4, 4));
}

/// A square with a colour, as another program writes it.
const COLOURED: &str = "ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('','',(''),(''),'','','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));
ENDSEC;
DATA;
#1=CARTESIAN_POINT('',(0.,0.,0.));
#2=DIRECTION('',(0.,0.,1.));
#3=DIRECTION('',(1.,0.,0.));
#4=AXIS2_PLACEMENT_3D('',#1,#2,#3);
#5=PLANE('',#4);
#6=RECTANGULAR_TRIMMED_SURFACE('lid',#5,0.,2.,0.,2.,.T.,.T.);
#7=RECTANGULAR_TRIMMED_SURFACE('bare',#5,3.,4.,0.,2.,.T.,.T.);
#8=GEOMETRIC_SET('',(#6,#7));
#10=COLOUR_RGB('',0.25,0.5,1.);
#11=FILL_AREA_STYLE_COLOUR('',#10);
#12=FILL_AREA_STYLE('',(#11));
#13=SURFACE_STYLE_FILL_AREA(#12);
#14=SURFACE_SIDE_STYLE('',(#13));
#15=SURFACE_STYLE_USAGE(.BOTH.,#14);
#16=PRESENTATION_STYLE_ASSIGNMENT((#15));
#17=STYLED_ITEM('',(#16),#6);
#20=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#21=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#20))REPRESENTATION_CONTEXT('',''));
#22=SHAPE_REPRESENTATION('',(#4,#8),#21);
ENDSEC;
END-ISO-10303-21;
";

#[test]
fn colours_of_imported_faces_go_out_again() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("coloured");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("part.step"), COLOURED).unwrap();
    let model = |file: &str| format!("units mm\nimport \"{}\" as part\n", folder.join(file).display());
    let out =
        "surface lid = part[\"lid\"]\nsurface bare = part[\"bare\"]\nexport lid, bare to \"out.step\"\nexport lid, bare to \"out.igs\"\n";
    let files = run("colours", &format!("{}{out}", model("part.step")));
    assert_eq!(files["out.step"].matches("STYLED_ITEM").count(), 1);
    assert!(files["out.step"].contains("COLOUR_RGB('',0.25,0.5,1.)"));
    assert!(files["out.igs"].contains("314,25.,50.,100.;"));
    for name in ["out.step", "out.igs"] {
        fs::write(folder.join(name), &files[name]).unwrap();
        let check = "check \"one colour\": len(part.colors) == 1 and len(part.colors[0].surfaces) == 1 and part.colors[0].rgb[1] == 0.5\n";
        run(&format!("colours_{name}"), &format!("{}{check}", model(name)));
    }
}

#[test]
fn names_layers_and_colours_of_an_imported_assembly_go_out_again() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("painted");
    fs::create_dir_all(&folder).unwrap();
    let part = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/imports/parts/painted.step");
    fs::copy(part, folder.join("part.step")).unwrap();
    let import = format!("units mm\nimport \"{}\" as part\n", folder.join("part.step").display());
    let files = run("painted", &format!("{import}export part to \"out.step\"\nexport part to \"out.igs\"\n"));
    let all = records(&files["out.step"]);
    let count = |kind: &str, what: &str| of_type(&all, kind).iter().filter(|(_, record)| record.contains(what)).count();
    // One product stands at five places; its solid is named as it is, the one that a mapped item places as that.
    assert_eq!((count("MANIFOLD_SOLID_BREP", "'block'"), count("MANIFOLD_SOLID_BREP", "'mapped'")), (1, 1));
    assert_eq!((count("ADVANCED_FACE", "'wall'"), count("ADVANCED_FACE", "'sides'")), (2, 8));
    let on =
        |layer: &str| references(of_type(&all, "PRESENTATION_LAYER_ASSIGNMENT").iter().find(|(_, r)| r.contains(layer)).unwrap().1).len();
    assert_eq!((on("'blocks'"), on("'bores'")), (2, 2), "solids on the one, faces on the other");
    // A style for each solid, one for its bore, and one for each place where a solid has another colour.
    assert_eq!((of_type(&all, "STYLED_ITEM").len(), of_type(&all, "OVER_RIDING_STYLED_ITEM").len()), (2, 6));
    assert_eq!(of_type(&all, "PRESENTATION_STYLE_BY_CONTEXT").len(), 4);
    for (id, record) in &all {
        assert!(references(record).iter().all(|other| other < id && all.contains_key(other)), "#{id}={record}");
    }
    for name in ["left", "left_2", "single", "wall"] {
        assert!(files["out.igs"].contains(&format!("406,1,{}H{name};", name.len())), "{name}");
    }
}

/// An assembly goes out as the tree that it was; what is read of that goes out as the same again.
/// Whether two lines have the same words, and numbers that differ by rounding alone.
fn are_alike(one: &str, other: &str) -> bool {
    let pieces = |line: &str| line.split([',', '(', ')']).map(str::to_owned).collect::<Vec<_>>();
    let (one, other) = (pieces(one), pieces(other));
    let near = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() < 1e-12 * (1.0 + a.abs()),
        _ => false,
    };
    one.len() == other.len() && one.iter().zip(&other).all(|(a, b)| a == b || near(a, b))
}

#[test]
fn assemblies_keep_their_trees() {
    let parts = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/imports/parts");
    let painted =
        "export [for c in part.colors: {red: c.rgb[0], green: c.rgb[1], blue: c.rgb[2], faces: len(c.surfaces)}] to \"colors.json\"
export [for g in part.groups: {name: g.name, faces: len(g.surfaces)}] to \"groups.json\"
";
    // Products, and the places at which they stand.
    for (name, products, places) in [("assembly", 8, 8), ("painted", 4, 7)] {
        let looks = if name == "painted" { painted } else { "" };
        let model = |path: &Path| format!("units mm\nimport \"{}\" as part\nexport part to \"out.step\"\n{looks}", path.display());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("tree_{name}.step"));
        fs::copy(parts.join(format!("{name}.step")), &path).unwrap();
        let mut files = run(&format!("tree_{name}"), &model(&path));
        let once = files.remove("out.step").unwrap();
        let count = |kind: &str| once.matches(kind).count();
        assert_eq!((count("=PRODUCT("), count("=NEXT_ASSEMBLY_USAGE_OCCURRENCE(")), (products, places), "{name}");
        fs::write(&path, &once).unwrap();
        let mut again = run(&format!("tree_{name}_again"), &model(&path));
        let twice = again.remove("out.step").unwrap();
        assert_eq!(twice.lines().count(), once.lines().count(), "{name}: the same again");
        if name == "painted" {
            // No frame is turned there: only last bits of coordinates may differ.
            let differing = once.lines().zip(twice.lines()).find(|(one, other)| !are_alike(one, other));
            assert_eq!(differing, None, "{name}: the same again");
        }
        assert_eq!(again, files, "{name}: the same colours and groups");
    }
}

/// One solid of an assembly is no assembly, and a copy that was moved is a product of its own.
#[test]
fn parts_of_assemblies_go_out_by_themselves() {
    let part = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tree_parts.step");
    fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/imports/parts/painted.step"), &part).unwrap();
    let model = format!(
        "units mm\nimport \"{}\" as part\nexport part.solids[0] to \"one.step\"\nexport part.left, move(part.right, by: (0, 0, 9)) to \"two.step\"\n",
        part.display()
    );
    let files = run("tree_parts", &model);
    let count = |name: &str, kind: &str| files[name].matches(kind).count();
    assert_eq!((count("one.step", "=PRODUCT("), count("one.step", "NEXT_ASSEMBLY")), (1, 0));
    assert_eq!((count("two.step", "=MANIFOLD_SOLID_BREP("), count("two.step", "=NEXT_ASSEMBLY_USAGE_OCCURRENCE(")), (2, 3));
}

#[test]
fn a_parted_seam_is_one_edge() {
    let model = "units mm
surface ball = revolve(arc((0, 0, -10), (0, 0, 10), through: (10, 0, 0)))
curve mark = arc(center: (0, 0, 0), start: (10, 0, 0), angle: 90deg, normal: (0, -1, 0))
export ball to \"ball.step\"
";
    let files = run("seam", model);
    assert_eq!(files["ball.step"].matches("EDGE_CURVE").count(), 1);
    assert_eq!(files["ball.step"].matches("ORIENTED_EDGE").count(), 2);
}
