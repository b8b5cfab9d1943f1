//! Files: what is written reads back, what is read is what the file's own facts say, and no bytes break a reader.

use std::io::Write;
use std::path::{Path, PathBuf};

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::triangulate::newell;
use lofting::base::{math, par};
use lofting::io::files::loss::{Loss, Renamed};
use lofting::io::formats::choice::format_for;
use lofting::io::formats::list::FORMATS;
use lofting::io::mesh_files::deck::{Deck, Encoding, Options};
use lofting::io::mesh_files::format::{Format, Takes};
use lofting::io::mesh_files::{obj_read, stl_read};
use lofting::io::tables::{json, table, table_read, table_write};
use lofting::mesh::{FaceRange, Group, Mesh};
use lofting::session::disk::{Disk, Outputs};
use proptest::prelude::*;

use crate::support::script;

/// A wavy sheet of `nx` × `ny` cells: the left half of surface `left`, the right of `right[1]`, triangles or quads;
/// the lower rim as line elements of the curve `rim`; groups of faces, lines and nodes.
fn sheet(nx: u32, ny: u32, quads: bool, order: u8) -> Mesh {
    let at = |i: u32, j: u32| j * (nx + 1) + i;
    let point = |x: f64, y: f64| DVec3::new(x, y / 3.0, math::sin(x * 0.7) * math::cos(y * 0.4));
    let mut mesh = Mesh { name: "sheet".into(), order, ..Mesh::default() };
    mesh.nodes = (0..=ny).flat_map(|j| (0..=nx).map(move |i| point(f64::from(i), f64::from(j)))).collect();
    mesh.lines = (0..nx).map(|i| [at(i, 0), at(i + 1, 0)]).collect();
    let halves = [0..nx / 2, nx / 2..nx];
    for (name, columns) in ["left", "right[1]"].into_iter().zip(halves) {
        let (t, q) = (mesh.triangles.len() as u32, mesh.quads.len() as u32);
        for (i, j) in columns.flat_map(|i| (0..ny).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if quads { mesh.quads.push([a, b, c, d]) } else { mesh.triangles.extend([[a, b, c], [a, c, d]]) }
        }
        let face =
            FaceRange { name: name.into(), triangles: t..mesh.triangles.len() as u32, quads: q..mesh.quads.len() as u32, lines: 0..0 };
        mesh.groups.push(set(&mesh, name, face.triangles.clone(), face.quads.clone()));
        mesh.faces.push(face);
    }
    mesh.faces.push(FaceRange { name: "rim".into(), triangles: 0..0, quads: 0..0, lines: 0..nx });
    let (t, q) = (mesh.triangles.len() as u32, mesh.quads.len() as u32);
    mesh.groups.push(set(&mesh, "지붕 all", 0..t, 0..q));
    mesh.groups.push(Group { name: "rim_lines".into(), nodes: (0..=nx).collect(), lines: (0..nx).collect(), ..Group::default() });
    mesh.groups.push(Group { name: "corners".into(), nodes: vec![0, nx, at(0, ny), at(nx, ny)], ..Group::default() });
    if order == 2 {
        add_mids(&mut mesh);
    }
    mesh
}

fn set(mesh: &Mesh, name: &str, triangles: std::ops::Range<u32>, quads: std::ops::Range<u32>) -> Group {
    let of_triangles = triangles.clone().flat_map(|k| mesh.triangles[k as usize]);
    let mut nodes: Vec<u32> = of_triangles.chain(quads.clone().flat_map(|k| mesh.quads[k as usize])).collect();
    nodes.sort_unstable();
    nodes.dedup();
    Group { name: name.into(), nodes, lines: vec![], triangles: triangles.collect(), quads: quads.collect() }
}

fn add_mids(mesh: &mut Mesh) {
    let mut known = std::collections::BTreeMap::new();
    let mut nodes = mesh.nodes.clone();
    let mut mid = |a: u32, b: u32| {
        *known.entry((a.min(b), a.max(b))).or_insert_with(|| {
            nodes.push((nodes[a as usize] + nodes[b as usize]) / 2.0);
            nodes.len() as u32 - 1
        })
    };
    mesh.line_mids = mesh.lines.iter().map(|[a, b]| mid(*a, *b)).collect();
    mesh.triangle_mids = mesh.triangles.iter().map(|[a, b, c]| [mid(*a, *b), mid(*b, *c), mid(*c, *a)]).collect();
    mesh.quad_mids = mesh.quads.iter().map(|[a, b, c, d]| [mid(*a, *b), mid(*b, *c), mid(*c, *d), mid(*d, *a)]).collect();
    mesh.nodes = nodes;
}

/// A cube of `n`³ cells about (n, n, n)/2 with shared nodes: six surfaces, a group of all faces.
fn block(n: u32, quads: bool) -> Mesh {
    let mut known = std::collections::BTreeMap::new();
    let mut mesh = Mesh { name: "block".into(), order: 1, ..Mesh::default() };
    for (axis, far) in [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)] {
        let (t, q) = (mesh.triangles.len() as u32, mesh.quads.len() as u32);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
                let mut place = [0; 3];
                (place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3]) = (if far { n } else { 0 }, i, j);
                *known.entry(place).or_insert_with(|| {
                    mesh.nodes.push(DVec3::from_array(place.map(f64::from)));
                    mesh.nodes.len() as u32 - 1
                })
            });
            let [a, b, c, d] = if far { [a, b, c, d] } else { [a, d, c, b] };
            if quads { mesh.quads.push([a, b, c, d]) } else { mesh.triangles.extend([[a, b, c], [a, c, d]]) }
        }
        let name = format!("side[{}]", 2 * axis + usize::from(far));
        let (triangles, quads) = (t..mesh.triangles.len() as u32, q..mesh.quads.len() as u32);
        mesh.groups.push(set(&mesh, &name, triangles.clone(), quads.clone()));
        mesh.faces.push(FaceRange { name, triangles, quads, lines: 0..0 });
    }
    let (t, q) = (mesh.triangles.len() as u32, mesh.quads.len() as u32);
    mesh.groups.push(set(&mesh, "skin & all", 0..t, 0..q));
    mesh
}

fn write(format: &Format, mesh: &Mesh, options: &Options) -> (Vec<u8>, Vec<Loss>) {
    let deck = Deck { mesh, unit: "mm", options };
    format.check(Origin::NONE, &deck).unwrap();
    let mut out = Vec::new();
    let losses = (format.write)(&deck, &mut out).unwrap();
    (out, losses)
}

fn named(path: &str) -> &'static Format {
    format_for(Origin::NONE, path).unwrap()
}

fn text_of(path: &str, mesh: &Mesh) -> (String, Vec<Loss>) {
    let options = Options { encoding: Some(Encoding::Text), ..Options::default() };
    let (bytes, losses) = write(named(path), mesh, &options);
    (String::from_utf8(bytes).unwrap(), losses)
}

#[test]
fn every_format_writes_every_kind_of_mesh_the_same_on_any_number_of_threads() {
    // 20 000 cells are several blocks of records.
    let meshes = [sheet(200, 100, true, 1), sheet(100, 100, false, 2), block(60, true), Mesh::default()];
    let all = FORMATS.iter().flat_map(|format| meshes.iter().map(move |mesh| (format, mesh)));
    for (format, mesh) in all.filter(|(format, mesh)| format.takes != Takes::Bodies || mesh.name != "sheet") {
        for encoding in format.encodings {
            let options = Options { encoding: Some(*encoding), ..Options::default() };
            let (first, losses) = write(format, mesh, &options);
            par::set_threads(1);
            let (again, _) = write(format, mesh, &options);
            par::set_threads(0);
            assert!(first == again && !first.is_empty(), "{} {encoding:?}", format.name);
            assert!(losses.len() < 8);
        }
    }
}

#[test]
fn deck_of_a_solver_word_by_word() {
    let mut mesh = sheet(2, 1, true, 1);
    mesh.nodes[0] = DVec3::new(-0.0, -0.001_234_567_890_123_456_7, 1e-7);
    let (text, losses) = text_of("a.inp", &mesh);
    let expected = "*NODE\n1, 0, -.001234567890123457, 1e-7\n2, 1, 0, 0.644217687237691\n";
    assert!(text.starts_with("** sheet: made by loft, lengths in mm\n") && text.contains(expected), "{text}");
    for part in [
        "** set right_1: right[1]\n** set jibung_all: 지붕 all\n*NODE",
        "*ELEMENT, TYPE=B31, ELSET=rim\n1, 1, 2\n2, 2, 3\n",
        "*ELEMENT, TYPE=S4, ELSET=left\n3, 1, 2, 5, 4\n*ELEMENT, TYPE=S4, ELSET=right_1\n4, 2, 3, 6, 5\n",
        "*NSET, NSET=left\n1, 2, 4, 5\n",
        "*ELSET, ELSET=jibung_all\n3, 4\n",
        "*ELSET, ELSET=rim_lines\n1, 2\n*NSET, NSET=rim_lines\n1, 2, 3\n",
        "*NSET, NSET=corners\n1, 3, 4, 6\n",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let renamed = |from: &str, to: &str, family| Loss::Renamed(Renamed { from: from.into(), to: to.into(), family });
    assert_eq!(losses, [renamed("right[1]", "right_1", true), renamed("지붕 all", "jibung_all", false)]);
    // Of a line of three nodes the middle one stands second, in no other format.
    let mesh = sheet(2, 1, true, 2);
    let mid = mesh.line_mids[0] + 1;
    assert!(text_of("a.inp", &mesh).0.contains(&format!("*ELEMENT, TYPE=B32, ELSET=rim\n1, 1, {mid}, 2\n")));
    assert!(text_of("a.bdf", &mesh).0.contains(&format!("CBEAM3  1       1       1       2       {mid:<8}0.0     0.0     1.0\n")));
    assert!(text_of("a.vtu", &mesh).0.contains(&format!("\n0 1 {} \n", mid - 1)));
}

#[test]
fn bulk_data_word_by_word() {
    let (text, losses) = text_of("a.bdf", &sheet(2, 1, true, 2));
    for part in [
        "SOL 101\nCEND\n$ SET 1: elements of left\nSET 1 = 3\n$ SET 2: nodes of left\nSET 2 = 1, 2, 4, 5\n",
        "$ PSHELL 2: left\nPSHELL  2       1\n",
        "GRID*   2                               1.0             0.0             *\n*       .644217687237691\n",
        "$ PBEAM3 1: rim, to be written with its section\n",
        "CQUAD8  3       2       1       2       5       4       7       9       +\n+       10      11\n",
        "ENDDATA\n",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    assert!(losses.iter().all(|loss| matches!(loss, Loss::Renamed(_))), "{losses:?}");
    let (text, _) = text_of("a.nas", &sheet(30, 20, false, 1));
    assert!(text.contains("SET 1 = 31 THRU 630\n") && text.lines().all(|line| line.len() <= 73));
}

/// Line elements of one curve through points, of order 2 with each middle node off its chord by a share of its length.
fn frame(points: &[DVec3], bow: Option<DVec3>) -> Mesh {
    let n = points.len() as u32 - 1;
    let mut mesh = Mesh { name: "frame".into(), order: if bow.is_some() { 2 } else { 1 }, nodes: points.to_vec(), ..Mesh::default() };
    mesh.lines = (0..n).map(|k| [k, k + 1]).collect();
    for (k, w) in points.windows(2).enumerate().filter(|_| bow.is_some()) {
        mesh.line_mids.push(n + 1 + k as u32);
        mesh.nodes.push((w[0] + w[1]) / 2.0 + bow.unwrap_or_default() * w[0].distance(w[1]));
    }
    mesh.faces.push(FaceRange { name: "leg".into(), triangles: 0..0, quads: 0..0, lines: 0..n });
    mesh
}

#[test]
fn no_beam_of_nastran_runs_along_its_orientation() {
    let legs: &[&[[f64; 3]]] = &[
        &[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0]],
        &[[0.0, 0.0, 0.0], [0.1, 0.0, 1.0], [0.2, 1.0, 1.05], [-1.0, 1.1, 1.1], [-2.0, 0.0, 1.0]],
        &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
        &[[0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [0.0, 2.0, 3.0]],
    ];
    let axis = |line: &str| {
        let fields: Vec<&str> = line.as_bytes().chunks(8).map(|f| std::str::from_utf8(f).unwrap().trim()).collect();
        let first = fields.iter().position(|f| *f == "0.0" || *f == "1.0").unwrap();
        DVec3::from_slice(&fields[first..].iter().map(|f| f.parse().unwrap()).collect::<Vec<f64>>())
    };
    for (leg, bow) in legs.iter().flat_map(|leg| [None, Some(DVec3::ZERO), Some(DVec3::new(0.2, 0.1, 0.25))].map(|bow| (leg, bow))) {
        let points: Vec<DVec3> = leg.iter().map(|p| DVec3::from(*p)).collect();
        let mesh = frame(&points, bow);
        let (text, losses) = text_of("a.bdf", &mesh);
        assert!(losses.is_empty(), "{losses:?}");
        let axes: Vec<DVec3> = text.lines().filter(|line| line.starts_with("CB")).map(axis).collect();
        assert_eq!(axes.len(), mesh.lines.len(), "{text}");
        for (k, [a, b]) in mesh.lines.iter().enumerate() {
            let (a, b) = (mesh.nodes[*a as usize], mesh.nodes[*b as usize]);
            let mid = mesh.line_mids.get(k).map_or((a + b) / 2.0, |mid| mesh.nodes[*mid as usize]);
            for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let along = (4.0 * t - 3.0) * a + 4.0 * (1.0 - 2.0 * t) * mid + (4.0 * t - 1.0) * b;
                let angle = math::angle_between(along, axes[k]).to_degrees();
                assert!(angle.min(180.0 - angle) >= 14.9, "element {}: {along} along {}\n{text}", k + 1, axes[k]);
            }
        }
    }
    // One direction does for what leaves an axis free, whatever way each part runs.
    let flat = frame(&[DVec3::ZERO, DVec3::X, DVec3::ONE], None);
    assert_eq!(text_of("a.bdf", &flat).0.matches("0.0     0.0     1.0").count(), 2);
}

#[test]
fn settings_that_do_not_fit_are_errors() {
    let mesh = sheet(2, 1, true, 1);
    let check = |path: &str, options: Options| {
        let fault = named(path).check(Origin::NONE, &Deck { mesh: &mesh, unit: "mm", options: &options });
        fault.err().map(|fault| lofting::base::fault::Fault::from(fault).to_string())
    };
    let elements =
        |names: &[&str]| Options { elements: names.iter().map(|name| ((*name).into(), Origin::NONE)).collect(), ..Options::default() };
    let element = |name: &str| elements(&[name]);
    assert_eq!(check("a.inp", element("s4r")), None);
    assert_eq!(
        check("a.inp", element("S8R")).unwrap(),
        "`element: S8R` is for 8-node quads, but `sheet` has 2-node lines and 4-node quads"
    );
    assert_eq!(check("a.inp", element("HEX")).unwrap(), "INP has no element `HEX`");
    assert_eq!(check("a.stl", element("S4R")).unwrap(), "STL has no element names, got `element: S4R`");
    assert_eq!(check("a.inp", elements(&["S4R", "T3D2"])), None);
    assert_eq!(check("a.bdf", elements(&["CQUADR", "CROD"])), None);
    assert_eq!(
        check("a.inp", elements(&["S4R", "B31", "S4"])).unwrap(),
        "`S4R` and `S4` are both for 4-node quads, which can be only one of them"
    );
    assert_eq!(check("a.inp", elements(&["S4", "S4"])).unwrap(), "`S4` is named twice in `element:`");
    let (bytes, _) = write(named("a.inp"), &mesh, &elements(&["T3D2", "S4R"]));
    let text = String::from_utf8(bytes).unwrap();
    assert!(text.contains("TYPE=T3D2, ELSET=rim") && text.contains("TYPE=S4R, ELSET=left"), "{text}");
    let binary = Options { encoding: Some(Encoding::Binary), ..Options::default() };
    assert_eq!(check("a.obj", binary).unwrap(), "OBJ has no binary encoding");
    let (bytes, _) = write(named("a.inp"), &mesh, &element("S4R"));
    assert!(String::from_utf8(bytes).unwrap().contains("TYPE=S4R, ELSET=left"));
    let metres = Options { units_per_file_unit: Some(1000.0), ..Options::default() };
    assert!(String::from_utf8(write(named("a.obj"), &mesh, &metres).0).unwrap().contains("v 0.002 0 "));
    assert_eq!(check("a.glb", Options { encoding: Some(Encoding::Text), ..Options::default() }).unwrap(), "GLB has no text encoding");
    assert_eq!(
        check("a.3mf", Options::default()).unwrap(),
        "3MF holds closed bodies, and `sheet` has 6 edges of one face only, the first at (0.5, 0, 0.322109) mm"
    );
    assert_eq!(format_for(Origin::NONE, "x.gltf").err().map(|f| lofting::base::fault::Fault::from(f).code().0), Some("E230"));
    assert_eq!(format_for(Origin::NONE, "dir.x/mesh").err().map(|f| lofting::base::fault::Fault::from(f).code().0), Some("E804"));
}

#[test]
fn what_a_format_cannot_hold_is_said() {
    let mesh = sheet(4, 2, true, 2);
    let declared: Vec<String> = mesh.groups.iter().skip(2).map(|group| group.name.clone()).collect();
    let count = |path: &str, encoding| {
        let options = Options { encoding: Some(encoding), groups: declared.clone(), ..Options::default() };
        write(named(path), &mesh, &options).1.iter().filter(|loss| matches!(loss, Loss::LeftOut(_))).count()
    };
    // Mid nodes, line elements, sets; text STL and OBJ keep part of the sets.
    assert_eq!((count("a.stl", Encoding::Binary), count("a.stl", Encoding::Text)), (3, 3));
    assert_eq!((count("a.ply", Encoding::Binary), count("a.obj", Encoding::Text)), (2, 2));
    assert_eq!((count("a.vtu", Encoding::Binary), count("a.msh", Encoding::Text), count("a.inp", Encoding::Text)), (0, 0, 0));
    assert_eq!(count("a.glb", Encoding::Binary), 2);
    // The names of surfaces are lost without a warning.
    let mut plain = sheet(4, 2, true, 1);
    plain.groups.truncate(2);
    plain.lines.clear();
    for path in ["a.stl", "a.ply"] {
        let losses = write(named(path), &plain, &Options::default()).1;
        assert_eq!(losses, [Loss::Unnamed("the names of the sets `left`, `right[1]`".into())], "{path}");
    }
    // Nastran's cards of two nodes leave out mid nodes, which is said.
    let rods = Options { elements: vec![("CROD".into(), Origin::NONE)], ..Options::default() };
    let (text, losses) = write(named("a.bdf"), &mesh, &rods);
    assert!(losses.contains(&Loss::LeftOut("the mid nodes of line elements of order 2".into())));
    assert!(String::from_utf8(text).unwrap().contains("CROD    1       1       1       2\n"));
}

/// The JSON and the binary chunk of a GLB.
fn chunks(bytes: &[u8]) -> (serde_json::Value, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert!(bytes.starts_with(b"glTF") && word(4) == 2 && word(8) == bytes.len() && &bytes[16..20] == b"JSON");
    let text = word(12);
    let rest = &bytes[20 + text..];
    assert!(rest.is_empty() || word(20 + text) == rest.len() - 8 && &rest[4..8] == b"BIN\0");
    (serde_json::from_slice(&bytes[20..20 + text]).unwrap(), rest.get(8..).unwrap_or_default())
}

#[test]
fn glb_has_a_primitive_a_material_and_a_name_for_each_surface_and_curve() {
    let mut mesh = sheet(4, 2, true, 1);
    mesh.nodes.iter_mut().for_each(|p| *p += DVec3::new(1e7, 2e7, 3e7));
    let colors = vec![("right[1]".to_owned(), [1.0, 0.5, 0.0])];
    let (bytes, losses) = write(named("a.glb"), &mesh, &Options { colors, ..Options::default() });
    assert!(losses.iter().all(|loss| !matches!(loss, Loss::LeftOut(_))), "far from the origin nothing is lost: {losses:?}");
    let (json, binary) = chunks(&bytes);
    assert_eq!(json["asset"]["version"], "2.0");
    assert_eq!(json["nodes"][0]["name"], "sheet");
    let names: Vec<&str> = json["materials"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["left", "right_1", "rim"]);
    let color = &json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"];
    assert!(color[0] == 1 && (color[1].as_f64().unwrap() - 0.214).abs() < 1e-3 && color[2] == 0, "{color}");
    let primitives = json["meshes"][0]["primitives"].as_array().unwrap();
    assert_eq!(primitives.iter().map(|p| p["mode"].as_u64().unwrap()).collect::<Vec<_>>(), [4, 4, 1]);
    assert_eq!((&primitives[1]["extras"]["name"], &primitives[1]["extras"]["quads_from"]), (&"right_1".into(), &0.into()));
    // Of the first surface 4 quads are 8 triangles; the group of all has both surfaces.
    let accessor = |n: &serde_json::Value| &json["accessors"][n.as_u64().unwrap() as usize];
    assert_eq!(accessor(&primitives[0]["indices"])["count"], 24);
    let groups = json["meshes"][0]["extras"]["groups"].as_array().unwrap();
    let all = groups.iter().find(|group| group["name"] == "지붕 all").unwrap();
    assert_eq!(all["elements"].to_string(), r#"[{"primitive":0,"first":0,"count":8},{"primitive":1,"first":0,"count":8}]"#);
    assert_eq!(groups.len(), 5, "two surfaces, a curve, a group of faces and one of lines");
    // The first vertex is the first node: x, z, -y from the centre of the box.
    let translation: Vec<f64> = json["nodes"][0]["translation"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let first: Vec<f64> =
        (0..3).map(|k| f64::from(f32::from_le_bytes(binary[4 * k..4 * k + 4].try_into().unwrap())) + translation[k]).collect();
    let p = mesh.nodes[0];
    assert!(DVec3::from_slice(&first).distance(DVec3::new(p.x, p.z, -p.y)) < 1e-6, "{first:?} {p}");
}

#[test]
fn a_3mf_holds_each_body_as_an_object_with_its_surfaces_and_sets() {
    let part = |bytes: &[u8], name: &str| {
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes.to_vec())).unwrap();
        std::io::read_to_string(archive.by_name(name).unwrap()).unwrap()
    };
    for quads in [true, false] {
        let mut mesh = block(2, quads);
        let mut second = block(1, quads);
        second.nodes.iter_mut().for_each(|p| *p += 5.0);
        second.faces.iter_mut().for_each(|face| face.name = "ball".into());
        mesh.append(second);
        let (bytes, losses) = write(named("a.3mf"), &mesh, &Options::default());
        assert!(losses.iter().all(|loss| matches!(loss, Loss::Renamed(renamed) if renamed.family)), "{losses:?}");
        assert!(part(&bytes, "[Content_Types].xml").contains("3dmanufacturing-3dmodel+xml"));
        assert!(part(&bytes, "_rels/.rels").contains("Target=\"/3D/3dmodel.model\""));
        let text = part(&bytes, "3D/3dmodel.model");
        let has = |n: usize, what: &str| assert_eq!(text.matches(what).count(), n, "{what}\n{text}");
        has(1, "<model unit=\"millimeter\"");
        has(1, "<base name=\"side_5\" displaycolor=\"#B6CEE8\"/>");
        has(1, "<object id=\"2\" type=\"model\" name=\"skin &amp; all\" pid=\"1\" pindex=\"0\">");
        has(1, "<object id=\"3\" type=\"model\" name=\"ball\" pid=\"1\" pindex=\"6\">");
        has(26 + 8, "<vertex ");
        has(48 + 12, "<triangle ");
        has(8, "pid=\"1\" p1=\"5\"/>");
        has(1, "<t:triangleset name=\"skin &amp; all\" identifier=\"skin &amp; all\">\n<t:ref index=\"0\"/>\n<t:ref index=\"1\"/>\n");
        // Of the larger body each triangle is in two sets: its side and all; the smaller one is a set by its name.
        has(2, "<t:ref index=\"47\"/>");
        has(1, "<item objectid=\"3\"/>");
    }
    // What points inwards is turned, as the outside of a 3MF is where its triangles point.
    let mut inward = block(1, false);
    inward.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    let inward = write(named("a.3mf"), &inward, &Options::default()).0;
    assert!(part(&inward, "3D/3dmodel.model").contains("<triangle v1=\"0\" v2=\"3\" v3=\"2\"/>"));
}

/// Sum of the areas of triangles and quads, a quad as its two triangles.
fn area(mesh: &Mesh) -> f64 {
    let half = |[a, b, c]: [u32; 3]| newell(&[a, b, c].map(|n| mesh.nodes[n as usize])).length() / 2.0;
    let quads = mesh.quads.iter().map(|[a, b, c, d]| half([*a, *b, *c]) + half([*a, *c, *d]));
    mesh.triangles.iter().map(|t| half(*t)).chain(quads).sum()
}

#[test]
fn our_own_files_read_back() {
    for quads in [true, false] {
        let mesh = sheet(12, 8, quads, 1);
        let (text, _) = text_of("a.obj", &mesh);
        let obj = obj_read::read(text.as_bytes()).unwrap();
        assert_eq!((obj.points.as_slice(), obj.polylines.len(), obj.skipped.len()), (mesh.nodes.as_slice(), 12, 0));
        let (again, skipped) = obj.mesh("again");
        assert!(skipped.is_empty());
        assert_eq!((again.triangles.len(), again.quads.len()), (mesh.triangles.len(), mesh.quads.len()));
        let corners = |mesh: &Mesh| -> Vec<DVec3> {
            mesh.triangles.as_flattened().iter().chain(mesh.quads.as_flattened()).map(|n| mesh.nodes[*n as usize]).collect()
        };
        assert_eq!(corners(&again), corners(&mesh));
        let names: Vec<&str> = again.faces.iter().map(|face| face.name.as_str()).collect();
        assert_eq!(names, ["left 지붕_all", "right_1 지붕_all"]);
    }
    let mesh = sheet(12, 8, false, 1);
    let (text, _) = text_of("a.stl", &mesh);
    let (again, skipped) = stl_read::read(text.as_bytes(), "x").unwrap();
    assert!(skipped.is_empty() && (area(&again) - area(&mesh)).abs() < 1e-12 * area(&mesh));
    assert_eq!((again.nodes.len(), again.triangles.len(), again.faces.len()), (mesh.nodes.len(), mesh.triangles.len(), 2));
    assert_eq!(again.faces[1].name, "right_1");
    let (bytes, _) = write(named("a.stl"), &mesh, &Options::default());
    let (again, _) = stl_read::read(&bytes, "x").unwrap();
    assert_eq!(
        (again.nodes.len(), again.triangles.len(), bytes.len()),
        (mesh.nodes.len(), mesh.triangles.len(), 84 + 50 * mesh.triangles.len())
    );
    assert!((area(&again) - area(&mesh)).abs() < 1e-6 * area(&mesh));
}

/// Parts that share no node have their mid nodes after the corner nodes of all, so that a format without mid nodes holds every element.
#[test]
fn parts_of_order_2_are_whole_in_formats_without_mid_nodes() {
    let script = "units mm\nsurface a = extrude(line((0, 0, 0), (4, 0, 0)), by: (0, 4, 0))\n\
        surface b = extrude(line((9, 0, 0), (13, 0, 0)), by: (0, 4, 0))\n\
        mesh m of a, b { size: 1mm  order: 2  conforming: false }\n";
    let disk = Disk::new(None, Some(Path::new(env!("CARGO_TARGET_TMPDIR"))), &[], Outputs::Counted).unwrap();
    let outcome = script::outcome("parts.loft", script.as_bytes(), &[], &disk);
    assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
    let mesh = &outcome.meshes[0].1;
    mesh.check().unwrap();
    assert!(mesh.order == 2 && mesh.corner_count() == 50, "{} corner nodes", mesh.corner_count());
    let read = obj_read::read(text_of("a.obj", mesh).0.as_bytes()).unwrap();
    assert_eq!((read.polygons.len(), read.vertices.len()), (mesh.triangles.len() + mesh.quads.len(), 50));
    assert!((area(&read.mesh("m").0) - 32.0).abs() < 1e-9);
    assert!(text_of("a.ply", mesh).0.contains("element vertex 50"));
}

fn data(folder: &str) -> (PathBuf, serde_json::Value) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(folder);
    let truth = serde_json::from_slice(&std::fs::read(folder.join("truth.json")).unwrap()).unwrap();
    (folder, truth)
}

fn keyword(facts: &serde_json::Value, word: &str) -> usize {
    facts["keywords"][word].as_u64().unwrap_or(0) as usize
}

/// Counts, box and area of an OBJ against the facts that came with it.
fn check_obj(name: &str, obj: &obj_read::Obj, facts: &serde_json::Value) {
    let polygon = |k: &Vec<u32>| k.iter().map(|n| obj.vertices[*n as usize]).collect::<Vec<_>>();
    if keyword(facts, "p") == 0 {
        assert_eq!(obj.points.len(), keyword(facts, "v"), "{name}");
    }
    assert_eq!((obj.polygons.len(), obj.polylines.len()), (keyword(facts, "f"), keyword(facts, "l")), "{name}");
    for (size, n) in facts["face_sizes"].as_object().unwrap() {
        let found = obj.polygons.iter().filter(|polygon| polygon.len().to_string() == *size).count();
        assert_eq!(found as u64, n.as_u64().unwrap(), "{name} {size}");
    }
    let expected = facts["area_vector_faces"].as_f64().unwrap();
    let area: f64 = obj.polygons.iter().map(|p| newell(&polygon(p)).length() / 2.0).sum();
    assert!((area - expected).abs() <= 1e-8 * expected.max(1.0), "{name}: {area} {expected}");
    let bounds = lofting::base::bbox::Box3::of(obj.points.iter().copied());
    for (k, x) in bounds.min.to_array().into_iter().chain(bounds.max.to_array()).enumerate() {
        assert!((x - facts["bbox"][k].as_f64().unwrap()).abs() < 1e-6, "{name}");
    }
}

#[test]
fn valid_obj_files_hold_what_is_known_of_them() {
    let (folder, truth) = data("obj-valid-a");
    for (name, facts) in truth.as_object().unwrap() {
        let obj = obj_read::read(&std::fs::read(folder.join(name)).unwrap()).unwrap();
        check_obj(name, &obj, facts);
        let (mesh, skipped) = obj.mesh("x");
        assert!(skipped.is_empty(), "{name} {skipped:?}");
        assert_eq!(mesh.triangles.len() + 2 * mesh.quads.len(), facts["triangles_after_fan"].as_u64().unwrap() as usize, "{name}");
        // `t` lines of the torus are no part of OBJ and are told once.
        assert_eq!(obj.skipped.len(), usize::from(keyword(facts, "t") > 0), "{name}");
    }
    let read = |name: &str| obj_read::read(&std::fs::read(folder.join(name)).unwrap()).unwrap();
    // One of its nine objects, the front wall, has no face.
    assert_eq!(read("cornell_box.obj").groups.len(), 8);
    assert_eq!(read("cube.obj").groups.len(), 6);
    assert_eq!(read("line-prim.obj").polylines.iter().map(Vec::len).sum::<usize>(), 8);
    assert_eq!(read("points-prim.obj").points.len(), 8);
}

#[test]
fn odd_obj_files_are_read_or_refused_by_line() {
    let (folder, truth) = data("obj-odd-a");
    let refused = [
        ("invalid-face-definition.obj", "line 15: a face needs at least 3 vertex indices, got 1"),
        ("invalid-relative-texture-index.obj", "line 2: there is no vertex 1, the file has 0"),
        ("invalid-relative-vertex-index.obj", "line 1: index -4 counts back beyond the 0 vertices so far"),
        ("issue-140-zero-face-idx.obj", "line 16: vertex indices start at 1, got 0"),
        ("test-nan.obj", "line 12: `nan` is not a coordinate"),
        ("tobj-invalid_index.obj", "line 12: there is no vertex 7, the file has 6"),
    ];
    for (name, facts) in truth.as_object().unwrap() {
        let read = obj_read::read(&std::fs::read(folder.join(name)).unwrap());
        match (read, refused.iter().find(|(refused, _)| refused == name)) {
            (Err(e), Some((_, expected))) => assert_eq!(format!("line {}: {}", e.line, e.what), *expected, "{name}"),
            (Ok(obj), None) => {
                check_obj(name, &obj, facts);
                let (mesh, skipped) = obj.mesh("x");
                let polygons: f64 = facts["area_vector_faces"].as_f64().unwrap();
                assert!(skipped.is_empty() && area(&mesh) >= polygons * (1.0 - 1e-8), "{name} {} {polygons} {skipped:?}", area(&mesh));
            }
            (read, expected) => panic!("{name}: {:?} {expected:?}", read.err()),
        }
    }
}

#[test]
fn lines_are_joined_and_comments_dropped() {
    let obj =
        obj_read::read(b"v 0 0 0 # a\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\n  3 4 # c\ncurv 0 1\n\ncurv 2 3\nl 1 2 3\np 2 -1\n").unwrap();
    assert_eq!((obj.polygons.len(), obj.polylines[0].len(), obj.points.len()), (1, 3, 2));
    assert_eq!((obj.skipped[0].line, obj.skipped[0].what.as_str()), (7, "`curv` is skipped (2 lines)"));
    let e = obj_read::read(b"v 0 0 0\nv 1 0 0\n\nf 1 \\\n 2 \\\n 9\n").unwrap_err();
    assert_eq!((e.line, e.column), (4, Some(4)));
}

#[test]
fn broken_stl_files_are_refused_by_place() {
    let check = |bytes: &[u8], line: u64, words: &str| {
        let e = stl_read::read(bytes, "x").unwrap_err();
        assert!(e.line == line && e.what.contains(words), "{e:?}");
    };
    check(b"", 0, "neither");
    check(b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", 4, "three coordinates");
    check(b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n", 5, "three vertices, got 1");
    check(b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", 4, "three coordinates");
    let mut bytes = write(named("a.stl"), &sheet(2, 2, true, 1), &Options::default()).0;
    check(&bytes[..bytes.len() - 1], 0, "needs 484 bytes, but it has 483");
    bytes[100..104].copy_from_slice(&f32::NAN.to_le_bytes());
    check(&bytes, 0, "triangle 1 has a coordinate that is not a number");
    // A binary file may begin with the word of the other form.
    bytes[100..104].copy_from_slice(&1_f32.to_le_bytes());
    bytes[..5].copy_from_slice(b"solid");
    assert_eq!(stl_read::read(&bytes, "x").unwrap().0.triangles.len(), 8);
}

#[test]
fn binary_junk_in_a_table_is_refused_at_once() {
    let mut seed = 1_u64;
    let junk: Vec<u8> = (0..20_000_000)
        .map(|_| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 56) as u8
        })
        .collect();
    let never = |_: &str| false;
    for layout in [table::Layout::Separated, table::Layout::Blanks] {
        let e = table_read::read(&junk, &table::Reading { layout, header: None, is_unit: &never }).unwrap_err();
        assert!(e.line <= 2 && e.column.is_some() && e.what.contains("byte"), "{e:?}");
    }
    assert!(json::read(&junk).is_err() && obj_read::read(&junk).is_err() && stl_read::read(&junk, "x").is_err());
}

/// Not a test by itself: `tests/interop/run` gives these files to other programs and compares what they read with the facts.
#[test]
fn decks_for_other_programs() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("decks");
    std::fs::create_dir_all(&folder).unwrap();
    for (kind, order) in [("triangles", 1), ("triangles", 2), ("quads", 1), ("quads", 2)] {
        let mesh = sheet(12, 8, kind == "quads", order);
        let name = format!("{kind}_{order}");
        let formats = FORMATS.iter().filter(|format| format.takes != Takes::Bodies);
        for (format, encoding) in formats.flat_map(|format| format.encodings.iter().map(move |encoding| (format, encoding))) {
            let options = Options { encoding: Some(*encoding), ..Options::default() };
            let file = format!("{name}_{}.{}", if *encoding == Encoding::Text { "text" } else { "binary" }, format.extensions[0]);
            std::fs::write(folder.join(file), write(format, &mesh, &options).0).unwrap();
        }
        std::fs::write(folder.join(format!("{name}.json")), facts(&mesh, 13 * 9).to_string()).unwrap();
    }
    for quads in [false, true] {
        let mesh = block(5, quads);
        let name = if quads { "block_quads" } else { "block_triangles" };
        for format in ["glb", "3mf"] {
            let bytes = write(named(&format!("a.{format}")), &mesh, &Options::default()).0;
            std::fs::write(folder.join(format!("{name}_binary.{format}")), bytes).unwrap();
        }
        std::fs::write(folder.join(format!("{name}.json")), facts(&mesh, mesh.nodes.len()).to_string()).unwrap();
    }
}

/// What is known of a mesh, for other programs.
fn facts(mesh: &Mesh, corners: usize) -> serde_json::Value {
    let groups: serde_json::Map<String, serde_json::Value> = mesh
        .groups
        .iter()
        .map(|g| {
            let elements = g.lines.len() + g.triangles.len() + g.quads.len();
            (g.name.clone(), serde_json::json!({ "nodes": g.nodes.len(), "elements": elements, "dimension": g.dimension() }))
        })
        .collect();
    let surfaces: std::collections::BTreeSet<&str> =
        mesh.faces.iter().filter(|face| face.lines.is_empty()).map(|face| face.name.as_str()).collect();
    serde_json::json!({
        "nodes": mesh.nodes.len(), "corners": corners, "lines": mesh.lines.len(), "triangles": mesh.triangles.len(),
        "quads": mesh.quads.len(), "order": mesh.order, "area": area(mesh), "groups": groups, "surfaces": surfaces,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn readers_survive_any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..400), header in any::<Option<bool>>()) {
        survive(&bytes, header);
    }

    #[test]
    fn readers_survive_almost_good_text(lines in proptest::collection::vec("(v|f|l|p|g|vertex|solid|endloop|outer loop|\\{|\\[|\"|1,2;3|# x)[ ,;\\\\\"0-9eE.+/-]{0,12}", 0..30)) {
        survive(lines.join("\n").as_bytes(), None);
    }

    #[test]
    fn any_coordinates_come_back_bit_by_bit(xs in proptest::collection::vec(proptest::num::f64::NORMAL, 9)) {
        let mut mesh = Mesh { name: "m".into(), order: 1, ..Mesh::default() };
        mesh.nodes = xs.as_chunks::<3>().0.iter().map(|p| DVec3::from_array(*p)).collect();
        mesh.triangles.push([0, 1, 2]);
        let obj = obj_read::read(text_of("a.obj", &mesh).0.as_bytes()).unwrap();
        prop_assert_eq!(obj.points, mesh.nodes.clone());
        let (again, _) = stl_read::read(text_of("a.stl", &mesh).0.as_bytes(), "m").unwrap();
        prop_assert_eq!(again.nodes, mesh.nodes);
    }
}

fn survive(bytes: &[u8], header: Option<bool>) {
    let unit = |word: &str| word == "m";
    for layout in [table::Layout::Separated, table::Layout::Blanks] {
        if let Ok(table) = table_read::read(bytes, &table::Reading { layout, header, is_unit: &unit }) {
            assert_eq!(table.rows.len(), table.lines.len());
            table_write::write_csv(&table, &mut std::io::sink()).unwrap();
        }
    }
    let _ = json::read(bytes);
    if let Ok(obj) = obj_read::read(bytes) {
        let (mesh, _) = obj.mesh("x");
        assert!(mesh.triangles.as_flattened().iter().all(|n| (*n as usize) < mesh.nodes.len()));
    }
    let _ = stl_read::read(bytes, "x");
    std::io::sink().flush().unwrap();
}

/// The guide's table of formats says of each what the format says of itself.
#[test]
fn the_guide_lists_what_each_format_holds() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/files.md")).unwrap();
    for format in FORMATS {
        let endings: Vec<String> = format.extensions.iter().map(|ending| format!("`.{ending}`")).collect();
        let word = |encoding: &Encoding| if *encoding == Encoding::Text { "text" } else { "binary" };
        let others = format.encodings.iter().filter(|other| **other != format.encoding);
        let encodings: Vec<&str> = std::iter::once(&format.encoding).chain(others).map(word).collect();
        let row = format!("| {} | meshes | {} | {} |", endings.join(" "), format.holds, encodings.join(", "));
        assert!(page.contains(&row), "{row}");
    }
}
