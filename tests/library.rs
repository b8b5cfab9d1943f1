//! The names at the root of the crate, and nothing else of it.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use lofting::{Curve, Elements, Error, MeshPlan, Method, Model, Network, Script, Surface, Tolerance};

fn tolerance() -> Tolerance {
    Tolerance::new(1e-5, 10.0)
}

fn line(a: (f64, f64, f64), b: (f64, f64, f64), name: &str) -> Curve {
    Curve::line(a, b).unwrap().named(name)
}

/// Four curves round a roof, the north one an arch.
fn border() -> [Curve; 4] {
    let south = line((0., 0., 0.), (6., 0., 0.), "south");
    let north = Curve::arc((0., 8., 0.), (6., 8., 0.), (3., 8., 2.)).unwrap().named("north");
    let west = Curve::line(south.start(), north.start()).unwrap().named("west");
    let east = Curve::line(south.end(), north.end()).unwrap().named("east");
    [south, east, north, west]
}

fn roof() -> Model {
    let roof = Surface::coons(&border(), &tolerance()).unwrap().named("roof");
    Model::new([], [&roof], &tolerance()).unwrap().with_unit("m").unwrap()
}

/// A folder of its own, empty.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("loft-library-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn the_front_door_has_two_dozen_names_at_most() {
    let text = fs::read_to_string("src/lib.rs").unwrap();
    let doors = text.split(';').filter_map(|part| part.trim_start().rsplit_once("pub use ").map(|door| door.1));
    let names: Vec<&str> = doors.flat_map(|door| door.rsplit("::").next().unwrap().trim_matches(['{', '}']).split(',')).collect();
    assert!((9..=24).contains(&names.len()), "{names:?}");
    let hidden = text.lines().collect::<Vec<_>>();
    for (k, line) in hidden.iter().enumerate().filter(|(_, line)| line.starts_with("pub mod ")) {
        assert_eq!(hidden[k - 1], "#[doc(hidden)]", "{line}");
    }
}

#[test]
fn curves_are_what_they_are_said_to_be() {
    let square = Curve::polyline([(0., 0., 0.), (2., 0., 0.), (2., 2., 0.), (0., 2., 0.)], true).unwrap();
    assert_eq!((square.length(), square.bounds()), (8.0, [[0., 0., 0.], [2., 2., 0.]]));
    assert_eq!(square.point(0.25), [2., 0., 0.]);
    let half = square.part(0.0, 0.5, &tolerance()).unwrap();
    assert_eq!((half.length(), half.end()), (4.0, [2., 2., 0.]));
    let whole = Curve::joined([&half, &square.part(0.5, 1.0, &tolerance()).unwrap()], &tolerance()).unwrap();
    assert_eq!((whole.length(), whole.points(5)[3]), (8.0, [0., 2., 0.]));
    let turned = half.rotated((0., 0., 0.), (0., 0., 1.), 90.0).unwrap().reversed();
    assert!(turned.end().iter().all(|x| x.abs() < 1e-12) && (turned.start()[0] + 2.0).abs() < 1e-12);
    assert_eq!(half.moved((0., 0., 1.)).unwrap().nearest((1., -3., 1.)).unwrap(), (0.25, 3.0));
    for curve in [
        Curve::circle((0., 0., 0.), 1.0, (0., 0., 2.)).unwrap(),
        Curve::spline([(1., 0., 0.), (0., 1., 0.), (-1., 0., 0.), (0., -1., 0.)], true).unwrap(),
    ] {
        assert_eq!(curve.start(), curve.end());
    }
    assert_eq!(Curve::bezier([(0., 0., 0.), (1., 2., 0.), (2., 0., 0.)]).unwrap().point(0.5), [1., 1., 0.]);
    let quarter =
        Curve::nurbs([(1., 0., 0.), (1., 1., 0.), (0., 1., 0.)], &[1., 0.5_f64.sqrt(), 1.], &[0., 0., 0., 1., 1., 1.], 2).unwrap();
    assert!((quarter.length() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
}

#[test]
fn what_cannot_be_is_an_error_with_a_code() {
    let code = |error: Error| (error.code(), error.to_string());
    assert_eq!(code(Curve::line((0., 0., 0.), (0., 0., f64::NAN)).unwrap_err()).0, "E306");
    assert_eq!(code(Curve::circle((0., 0., 0.), 1.0, (0., 0., 0.)).unwrap_err()).0, "E306");
    assert!(Curve::line((1., 0., 0.), (1., 0., 0.)).unwrap_err().code().starts_with("E4"));
    let [south, east, north, _] = border();
    let west = line((0., 8., 0.), (0., 0.3, 0.), "west");
    let (code, said) = code(Surface::coons([&south, &east, &north, &west], &tolerance()).unwrap_err());
    assert_eq!(code, "E501");
    assert!(said.starts_with("E501 `") && said.contains("`west`") && said.contains("`south`") && said.contains("0.3"), "{said}");
    assert!(Surface::coons([], &tolerance()).is_err() && Surface::skin([&south], &tolerance()).is_err());
    assert_eq!(Surface::coons([&south, &south], &tolerance()).unwrap_err().code(), "E663");
    let model = roof();
    assert_eq!(MeshPlan::new("m").size(0.0).mesh(&model).unwrap_err().to_string(), "E306 `size` must be more than 0, got 0");
    assert_eq!(MeshPlan::new("m").order(3).mesh(&model).unwrap_err().code(), "E306");
    assert_eq!(MeshPlan::new("m").count("weast", 3).mesh(&model).unwrap_err().code(), "E201");
    assert_eq!(MeshPlan::new("m").bias("roof", 2.0).mesh(&model).unwrap_err().to_string(), "E306 `bias` must be on a curve, got `roof`");
    assert_eq!(MeshPlan::new("m").method_on("south", Method::Mapped).mesh(&model).unwrap_err().code(), "E306");
    assert!(model.surfaces()[0].point(f64::NAN, 7.0).iter().all(|x| x.is_finite()));
    assert_eq!(model.with_unit("furlong").unwrap_err().code(), "E306");
}

#[test]
fn curves_meet_in_a_network() {
    let [south, east, north, west] = border();
    let ridge = line((3., 8., 2.), (3., 0., 0.), "ridge");
    let network = Network::of([&south, &east, &north, &west, &ridge], &tolerance()).unwrap();
    assert_eq!((network.nodes().len(), network.links().len()), (6, 7));
    let links = network.curves().into_iter().find(|curve| curve.0 == "south").unwrap().1;
    let length: f64 = links.iter().map(|link| network.link(*link).unwrap().length()).sum();
    assert_eq!((links.len(), length), (2, 6.0));
    assert!(network.link(7).is_none());
}

#[test]
fn surfaces_of_all_kinds_are_one_model() {
    let t = tolerance();
    let [south, east, north, west] = border();
    let surfaces = [
        Surface::coons([&south, &east, &north, &west], &t).unwrap().named("roof"),
        Surface::ruled(&south, &line((0., 0., -3.), (6., 0., -3.), "foot"), &t).unwrap().named("front"),
        Surface::extrude(&west, (0., 0., -3.), &t).unwrap().named("side"),
        Surface::plane([&north, &Curve::line(north.start(), north.end()).unwrap()], &t).unwrap().named("gable"),
        Surface::revolve(&line((20., 0., 0.), (20., 0., 2.), "profile"), (21., 0., 0.), (0., 0., 1.), 360.0, &t).unwrap().named("tower"),
    ];
    let areas: Vec<f64> = surfaces.iter().map(Surface::area).collect();
    for (k, area) in [(1, 18.0), (2, 24.0), (4, 4.0 * std::f64::consts::PI)] {
        assert!((areas[k] - area).abs() < 1e-9, "{areas:?}");
    }
    let model = Model::new([], &surfaces, &t).unwrap();
    assert!(model.curve("south").is_some() && model.surface("gable").is_some());
    let mesh = MeshPlan::new("all").size(0.5).mesh(&model).unwrap();
    assert!((mesh.quality().unwrap().area / areas.iter().sum::<f64>() - 1.0).abs() < 0.01);
    // Roof and front share the nodes of the south eaves.
    let nodes = |name: &str| mesh.group(name).unwrap().nodes.iter().copied().collect::<BTreeSet<u32>>();
    let points: Vec<[f64; 3]> = mesh.nodes().collect();
    let eaves = nodes("roof").into_iter().filter(|n| points[*n as usize][1].abs() < 1e-9).count();
    assert_eq!((eaves >= 13, nodes("roof").intersection(&nodes("front")).count()), (true, eaves));
    let lid = Surface::plane(&border()[..0], &t);
    assert!(lid.is_err());
    let rim = Curve::circle((0., 0., 0.), 2.0, (0., 0., 1.)).unwrap();
    let eye = Curve::circle((0.5, 0., 0.), 0.5, (0., 0., 1.)).unwrap();
    let ring = Surface::plane([&rim], &t).unwrap().with_holes([&eye], &t).unwrap();
    assert!((ring.area() - 3.75 * std::f64::consts::PI).abs() < 1e-6);
    let moved = ring.moved((0., 0., 1.)).unwrap().rotated((0., 0., 0.), (1., 0., 0.), 90.0).unwrap();
    assert!((moved.area() - ring.area()).abs() < 1e-9 && moved.bounds()[1][1] < -0.99);
}

#[test]
fn a_plan_says_what_a_script_says() {
    let model = roof();
    let plan = MeshPlan::new("fine").of(["roof"]).elements(Elements::Quads).method(Method::Mapped).count("south", 12).count("west", 9);
    let mesh = plan.clone().lines(["north"]).group("eaves", ["south", "west"]).mesh(&model).unwrap();
    assert_eq!((mesh.name(), mesh.quads().len(), mesh.triangles().len(), mesh.lines().len()), ("fine", 108, 0, 12));
    assert_eq!((mesh.nodes().len(), mesh.group("eaves").unwrap().nodes.len()), (130, 22));
    assert!(!mesh.is_watertight() && mesh.chord_error().unwrap() < 0.1);
    let second = plan.clone().order(2).mesh(&model).unwrap();
    assert_eq!((second.order(), second.quad_mids().len(), second.nodes().len()), (2, 108, 130 + 12 * 10 + 13 * 9));
    let script = "units m\ncurve south = line((0, 0, 0), (6, 0, 0))\ncurve north = arc((0, 8, 0), (6, 8, 0), through: (3, 8, 2))\n\
        curve west = line(south.start, north.start)\ncurve east = line(south.end, north.end)\n\
        surface roof = coons(south, east, north, west)\n\
        mesh fine of roof { elements: quads, method: mapped, on south { count: 12 }, on west { count: 9 } }\nexport fine to \"fine.inp\"";
    let same = Script::from_str(script).run().unwrap();
    let bytes = plan.mesh(&model).unwrap().to_bytes("fine.inp").unwrap();
    assert_eq!(same.output("fine.inp").unwrap().bytes(), Some(bytes.as_slice()), "the same mesh, to the last byte");
}

#[test]
fn meshes_are_written_by_the_name_of_the_file() {
    let mesh = MeshPlan::new("roof").size(1.0).mesh(&roof()).unwrap();
    let folder = folder("meshes");
    for ending in ["stl", "obj", "ply", "vtu", "msh", "inp", "bdf", "glb"] {
        let path = folder.join(format!("roof.{ending}"));
        mesh.write(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap(), mesh.to_bytes(&format!("roof.{ending}")).unwrap());
    }
    assert_eq!(mesh.to_bytes("roof.docx").unwrap_err().code(), "E804");
    assert_eq!(mesh.to_bytes("roof.3mf").unwrap_err().code(), "E805", "it is open");
    assert_eq!(mesh.write(folder.join("roof.stl").join("x.stl")).unwrap_err().code(), "E808");
    fs::remove_dir_all(folder).unwrap();
}

const BAY: &str = "units m\nparam width = 4m in 1m to 9m\nimport \"rows.csv\" as rows\nuse \"parts/post.loft\" (height: 3m) as post\n\
    curve base = line((0, 0, 0), (width, 0, 0))\nsurface wall = extrude(base, by: (0, 0, 3))\nmesh m of wall { size: 1m, elements: quads }\n\
    check \"rows\": len(rows) == 2\nexport m to \"out/wall.obj\"\nlet list = [{ width: width, rows: len(rows) }]\nexport list to \"rows.json\"\n";
const POST: &str = "units m\nparam height = 1m\ncurve axis = line((0, 0, 0), (0, 0, height))\n";

#[test]
fn a_script_runs_over_files_in_memory_or_on_disk() {
    let script = Script::from_str(BAY).named("bay.loft").file("rows.csv", "x,y\n1,2\n3,4\n").file("parts/post.loft", POST);
    let model = script.clone().set("width", "6m").run().unwrap();
    assert_eq!((model.unit(), model.curves().len(), model.mesh("m").unwrap().quads().len()), ("m", 1, 18));
    assert!(model.checks().iter().all(|check| check.pass) && model.to_json().contains("\"ok\": true"));
    let paths: Vec<&str> = model.outputs().iter().map(|output| output.path()).collect();
    assert_eq!(paths, ["out/wall.obj", "rows.json"]);
    assert!(model.output("rows.json").unwrap().text().unwrap().contains("\"rows\": 2"));

    let folder = folder("disk");
    fs::create_dir_all(folder.join("parts")).unwrap();
    fs::write(folder.join("bay.loft"), BAY).unwrap();
    fs::write(folder.join("parts/post.loft"), POST).unwrap();
    fs::write(folder.join("rows.csv"), "x,y\n1,2\n").unwrap();
    // One row on disk: the check does not hold, and nothing is written.
    let failed = Script::open(folder.join("bay.loft")).unwrap().out(folder.join("made")).run().unwrap_err();
    assert!(failed.message().contains("rows") && failed.place().is_some_and(|place| place.line == 8), "{failed}");
    assert!(failed.model().is_some_and(|model| !model.checks()[0].pass && model.outputs().is_empty()));
    assert!(!folder.join("made").join("rows.json").exists());
    // A file in memory hides it.
    let both = Script::open(folder.join("bay.loft")).unwrap().file("rows.csv", "x,y\n1,2\n3,4\n").out(folder.join("made"));
    let model = both.set("width", "6m").run().unwrap();
    let wall = model.output("out/wall.obj").unwrap();
    assert_eq!((wall.bytes(), fs::read(wall.file().unwrap()).unwrap().len() as u64), (None, wall.size()));
    assert_eq!(fs::read(folder.join("made/out/wall.obj")).unwrap(), script.set("width", "6m").run().unwrap().outputs()[0].bytes().unwrap());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_script_without_a_folder_reads_and_writes_nothing_on_disk() {
    let missing = Script::from_str("import \"rows.csv\" as all").run().unwrap_err();
    assert_eq!((missing.code(), missing.place().unwrap().line), ("E801", 1));
    for path in ["../roof.obj", "/tmp/roof.obj"] {
        let text = format!("surface s = plane(circle(center: (0, 0, 0), radius: 1m))\nmesh m of s {{}}\nexport m to \"{path}\"");
        let error = Script::from_str(&text).run().unwrap_err();
        assert_eq!((error.code(), error.place().unwrap().line), ("E802", 3));
    }
    assert_eq!(Script::open("no/such.loft").unwrap_err().code(), "E801");
    assert_eq!(Script::from_str("").folder("no/such/folder").run().unwrap_err().code(), "E801");
}

#[test]
fn a_failing_script_tells_code_and_place() {
    let text = "units mm\nlet load = 3m + 30deg\nlet half = widht / 2\ncurve rim = circle(center: (0, 0, 0), radius: 1m)\n";
    let error = Script::from_str(text).named("err.loft").run().unwrap_err();
    let place = error.place().unwrap();
    assert_eq!((error.code(), place.file.as_str(), place.line, place.column), ("E211", "err.loft", 2, 15));
    assert!(error.to_string().starts_with("err.loft:2:15: E211 "), "{error}");
    let codes: Vec<&str> = error.diagnostics().iter().map(|found| found.code).collect();
    assert_eq!(codes, ["E211", "E201"]);
    assert!(error.report().contains("let half = widht / 2") && format!("{error:?}").contains("E201"));
    assert!(error.model().unwrap().curve("rim").is_some(), "what is sound is there");
    let boxed: Box<dyn std::error::Error + Send + Sync> = Box::new(error);
    assert!(boxed.to_string().contains("E211"));
}

#[test]
fn warnings_are_told_and_strict_makes_them_errors() {
    let script =
        Script::from_str("units m\nlet unused = 3m\ncurve a = line((0, 0, 0), (1, 0, 0))\ncurve b = line((1.00002, 0, 0), (1, 1, 0))\n");
    let told = script.run().unwrap();
    if let Some(warning) = told.diagnostics().iter().find(|found| found.severity == "warning") {
        assert_eq!(script.strict(true).run().unwrap_err().code(), warning.code);
    }
}

#[test]
fn an_iges_file_is_meshed_anew() {
    let text = "units mm\nimport \"fuselage.igs\" as part\nshell hull of part.surfaces";
    let model = Script::from_str(text).file("fuselage.igs", fs::read("examples/data/fuselage.igs").unwrap()).run().unwrap();
    let plan = MeshPlan::new("hull").of(["hull"]);
    let meshes = [16.0, 4.0].map(|size| plan.clone().size(size).mesh(&model).unwrap());
    assert!(meshes.iter().all(lofting::Mesh::is_watertight) && meshes[0].triangles().len() < meshes[1].triangles().len());
    assert!((meshes[1].quality().unwrap().area / 13048.09883 - 1.0).abs() < 0.01);
}
