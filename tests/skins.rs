//! Faces as one skin: which side they show, and where they touch.

use std::path::Path;

use lofting::base::fault::Severity;
use lofting::io::mesh_files::stl_read;
use lofting::mesh::Mesh;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::run::Outcome;

use crate::support::script;

/// Runs a script that must succeed; files go to a folder of the test's own.
fn run(name: &str, text: &str) -> Outcome {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("skins").join(name);
    std::fs::create_dir_all(&out).unwrap();
    let disk = Disk::new(None, Some(&out), &[], Outputs::Written).unwrap();
    let outcome = script::outcome("model.loft", text.as_bytes(), &[], &disk);
    assert!(outcome.diagnostics.iter().all(|d| d.severity() != Severity::Error), "{text}\n{}", outcome.drawn(false, true));
    outcome
}

/// Volume that the elements enclose, negative where they face inwards.
fn volume(mesh: &Mesh) -> f64 {
    let p = |n: u32| mesh.nodes[n as usize];
    let one = |t: [u32; 3]| p(t[0]).dot(p(t[1]).cross(p(t[2]))) / 6.0;
    let quads = mesh.quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    mesh.triangles.iter().copied().chain(quads).map(one).sum()
}

fn mesh_volume(outcome: &Outcome, name: &str) -> f64 {
    volume(&outcome.meshes.iter().find(|m| m.0 == name).unwrap().1)
}

/// A cube of 10 mm from faces of its own: bottom, top and the four walls.
const CUBE: &str = "units mm
let base = polyline([(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)], closed: true)
let lid = move(base, by: (0, 0, 10))
surface b = plane(base)
surface t = plane(lid)
surface w = extrude(base, by: (0, 0, 10))
";

#[test]
fn a_cube_points_outwards_in_every_order_and_direction() {
    let mut text = CUBE.to_owned();
    let orders = ["b t w", "b w t", "t b w", "t w b", "w b t", "w t b"];
    for (k, order) in orders.iter().enumerate() {
        for signs in 0..8_usize {
            let faces: Vec<String> =
                order.split(' ').enumerate().map(|(n, f)| format!("{}{f}", if signs >> n & 1 == 1 { "-" } else { "" })).collect();
            let (faces, id) = (faces.join(", "), 8 * k + signs);
            text += &format!("shell s{id} of {faces}\nmesh m{id} of s{id} {{ size: 10mm }}\ncheck s{id}.volume == 1000mm3 within 1e-9%\n");
            text += &format!("mesh l{id} of {faces} {{ size: 10mm }}\n");
            if signs == 0 {
                text += &format!("shell f{id} of {faces} {{ flip: true }}\nmesh n{id} of f{id} {{ size: 10mm }}\n");
                text += &format!("mesh k{id} of {faces} {{ size: 10mm  flip: true }}\n");
                text += &format!("mesh t{id} of f{id} {{ size: 10mm  flip: true }}\n");
            }
        }
    }
    let outcome = run("cube", &text);
    assert!(outcome.report.checks.iter().all(|c| c.pass) && outcome.report.checks.len() == 48);
    for id in 0..48 {
        let turned = [("n", -1000.0), ("k", -1000.0), ("t", 1000.0)].into_iter().filter(|_| id % 8 == 0);
        for (name, wanted) in [("m", 1000.0), ("l", 1000.0)].into_iter().chain(turned) {
            let found = mesh_volume(&outcome, &format!("{name}{id}"));
            assert!((found - wanted).abs() < 1e-9, "{name}{id}: {found}");
        }
    }
}

#[test]
fn the_written_file_encloses_what_the_shell_does() {
    let text = format!("{CUBE}shell c of b, t, w\nmesh m of c {{ size: 5mm }}\nexport m to \"cube.stl\"\n");
    run("file", &text);
    let bytes = std::fs::read(Path::new(env!("CARGO_TARGET_TMPDIR")).join("skins/file/cube.stl")).unwrap();
    let (mesh, broken) = stl_read::read(&bytes, "cube").unwrap();
    assert!(broken.is_empty() && (volume(&mesh) - 1000.0).abs() < 1e-3, "{}", volume(&mesh));
}

/// Faces of a box from `(x, y, z)` with edges of `a`, named by `name`.
fn cube(name: &str, (x, y, z): (f64, f64, f64), a: f64) -> String {
    format!(
        "let {name}_base = polyline([({x}, {y}, {z}), ({x} + {a}, {y}, {z}), ({x} + {a}, {y} + {a}, {z}), ({x}, {y} + {a}, {z})], closed: true)
surface {name}_b = plane({name}_base)
surface {name}_t = plane(move({name}_base, by: (0, 0, {a})))
surface {name}_w = extrude({name}_base, by: (0, 0, {a}))
"
    )
}

fn faces(name: &str) -> String {
    format!("{name}_b, {name}_t, {name}_w")
}

#[test]
fn cavities_point_into_the_cavity_and_pieces_outwards() {
    let mut text = "units mm\n".to_owned();
    // Four inside each other, two beside them.
    for (name, at, a) in [
        ("a", (0.0, 0.0, 0.0), 10.0),
        ("b", (1.0, 1.0, 1.0), 8.0),
        ("c", (2.0, 2.0, 2.0), 6.0),
        ("d", (3.0, 3.0, 3.0), 4.0),
        ("e", (20.0, 0.0, 0.0), 5.0),
        ("f", (1.0, -4.0, 2.0), 3.0),
    ] {
        text += &cube(name, at, a);
    }
    let lists = [
        ("ab", "a b", 1000.0 - 512.0),
        ("ba", "b a", 1000.0 - 512.0),
        ("ae", "a e", 1125.0),
        ("ea", "e a", 1125.0),
        ("cabd", "c a b d", 1000.0 - 512.0 + 216.0 - 64.0),
        ("all", "d f c b a e", 1000.0 - 512.0 + 216.0 - 64.0 + 125.0 + 27.0),
    ];
    for (name, list, volume) in lists {
        let list = list.split(' ').map(faces).collect::<Vec<_>>().join(", ");
        text += &format!("shell {name} of {list}\nmesh m_{name} of {name} {{ size: 10mm }}\nmesh l_{name} of {list} {{ size: 10mm }}\n");
        text += &format!("check {name}.closed\ncheck {name}.volume == {volume}mm3 within 1e-9%\n");
    }
    let outcome = run("cavities", &text);
    assert!(outcome.report.checks.iter().all(|c| c.pass), "{:?}", outcome.report.checks);
    for (name, _, wanted) in lists {
        for kind in ["m", "l"] {
            let found = mesh_volume(&outcome, &format!("{kind}_{name}"));
            assert!((found - wanted).abs() < 1e-9, "{kind}_{name}: {found} {wanted}");
        }
    }
}

#[test]
fn faces_that_close_by_themselves_point_outwards() {
    let text = "units mm
let up = arc((0, 0, -10), (0, 0, 10), through: (10, 0, 0))
let axis = line((0, 0, 0), (0, 0, 1))
surface ball = revolve(up, axis: axis)
surface other_ball = revolve(-up, axis: axis)
surface ring = revolve(circle(center: (30, 0, 0), radius: 5, normal: (0, 1, 0)), axis: axis)
surface other_ring = revolve(circle(center: (30, 0, 0), radius: 5, normal: (0, -1, 0)), axis: axis)
surface hollow = revolve(circle(center: (30, 0, 0), radius: 2, normal: (0, 1, 0)), axis: axis)
shell tyre of hollow, ring
mesh a of ball { chord_error: 0.1mm }
mesh b of other_ball { chord_error: 0.1mm }
mesh c of -ball { chord_error: 0.1mm }
mesh d of ring { chord_error: 0.1mm }
mesh e of other_ring { chord_error: 0.1mm }
mesh f of -ring, ball { chord_error: 0.1mm }
mesh g of ball { chord_error: 0.1mm  flip: true }
mesh h of ring { chord_error: 0.1mm  method: delaunay }
mesh i of tyre { chord_error: 0.05mm }
mesh j of mirror(ball, normal: (1, 0, 0)) { chord_error: 0.1mm }
";
    let outcome = run("closed", text);
    let pi = std::f64::consts::PI;
    let (ball, ring, tyre) = (4.0 / 3.0 * pi * 1000.0, 2.0 * pi * pi * 30.0 * 25.0, 2.0 * pi * pi * 30.0 * 21.0);
    let wanted = [ball, ball, ball, ring, ring, ring + ball, -ball, ring, tyre, ball];
    for (name, wanted) in ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"].into_iter().zip(wanted) {
        let found = mesh_volume(&outcome, name);
        assert!((found / wanted - 1.0).abs() < 0.05, "{name}: {found} {wanted}");
    }
}

#[test]
fn an_open_shell_follows_its_first_face_and_a_list_stays_as_it_is() {
    let text = format!(
        "{CUBE}shell up of t, w
shell down of -t, w
shell turned of t, w {{ flip: true }}
shell whole of turned, b
mesh m_up of up {{ size: 10mm }}
mesh m_down of down {{ size: 10mm }}
mesh m_turned of turned {{ size: 10mm }}
mesh m_whole of turned, b {{ size: 10mm }}
mesh m_shell of whole {{ size: 10mm }}
mesh m_list of t, -b {{ size: 10mm }}
"
    );
    let outcome = run("open", &text);
    let upwards = |name: &str| {
        let mesh = &outcome.meshes.iter().find(|m| m.0 == name).unwrap().1;
        let up = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|n| mesh.nodes[n as usize]);
            (b - a).cross(c - a).z
        };
        0.5 * mesh.triangles.iter().map(up).sum::<f64>()
    };
    for (name, wanted) in [("m_up", 100.0), ("m_down", -100.0), ("m_turned", -100.0), ("m_list", 0.0)] {
        assert!((upwards(name) - wanted).abs() < 1e-9, "{name}: {}", upwards(name));
    }
    for name in ["m_whole", "m_shell"] {
        assert!((mesh_volume(&outcome, name) - 1000.0).abs() < 1e-9, "{name}");
    }
}

#[test]
fn pieces_of_which_one_is_open_are_no_shell() {
    let text = format!("units mm\n{}{}shell s of {}, b_b, b_w\n", cube("a", (0., 0., 0.), 1.0), cube("b", (5., 0., 0.), 1.0), faces("a"));
    let disk = Disk::new(None, None, &[], Outputs::Counted).unwrap();
    let outcome = script::outcome("model.loft", text.as_bytes(), &[], &disk);
    assert!(outcome.drawn(false, false).contains("E618"), "{}", outcome.drawn(false, true));
}

/// What is said about the contacts of a mesh of these declarations and the number of its parts.
fn contacts(name: &str, text: &str) -> (Vec<String>, usize) {
    let outcome = run(name, text);
    let said = outcome.diagnostics.iter().filter(|d| d.code.0 == "W667").map(|d| d.message.clone()).collect();
    (said, outcome.report.meshes[0].parts)
}

#[test]
fn faces_that_touch_without_a_shared_border_are_told() {
    let slab = "units m\nlet ring = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]\nsurface slab = plane(polyline(ring, closed: true))\n";
    let column = "surface column = extrude(circle(center: (5, 5, 0), radius: 1), by: (0, 0, -3))\n";
    let wall = |y0: f64, y1: f64| format!("surface wall = extrude(line((5, {y0}, 0), (5, {y1}, 0)), by: (0, 0, 3))\n");
    let cases: [(&str, String, &str, &[&str], usize); 13] = [
        ("column", column.to_owned(), "slab, column", &["an edge of `column` lies on `slab`"], 2),
        ("turned", column.to_owned(), "column, slab", &["an edge of `column` lies on `slab`"], 2),
        ("middle", wall(2.0, 8.0), "slab, wall", &["an edge of `wall` lies on `slab`", "6 m long"], 2),
        ("across", wall(0.0, 10.0), "slab, wall", &["an edge of `wall` lies on `slab`"], 1),
        ("outside", wall(-2.0, 5.0), "slab, wall", &["an edge of `wall` lies on `slab`"], 1),
        (
            "crossing",
            "surface plate = extrude(line((2, 5, -1), (8, 5, -1)), by: (0, 0, 2))\n".to_owned(),
            "slab, plate",
            &["`slab`", "cross without sharing nodes"],
            2,
        ),
        (
            "flush",
            "surface plate = extrude(line((0, 5, -1), (10, 5, -1)), by: (0, 0, 2))\n".to_owned(),
            "slab, plate",
            &["`slab`", "`plate`"],
            2,
        ),
        (
            "pipe",
            "surface pipe = extrude(circle(center: (5, 5, -1), radius: 1), by: (0, 0, 2))\n".to_owned(),
            "slab, pipe",
            &["`pipe`", "cross"],
            2,
        ),
        (
            "dome",
            "surface ball = revolve(arc((5, 5, -2), (5, 5, 2), through: (7, 5, 0)), axis: line((5, 5, 0), (5, 5, 1)))\n".to_owned(),
            "slab, ball",
            &["`ball`", "`slab`"],
            2,
        ),
        (
            "tubes",
            "surface a = extrude(circle(center: (0, 0, 5), start: (0, 3, 5), normal: (1, 0, 0)), by: (9, 0, 0))
surface b = extrude(circle(center: (4, -9, 5), start: (4, -9, 7), normal: (0, 1, 0)), by: (0, 18, 0))\n"
                .to_owned(),
            "a, b",
            &["`a`", "`b`", "cross"],
            2,
        ),
        (
            "cover",
            "surface other = plane(polyline([(4, 4, 0), (14, 4, 0), (14, 14, 0), (4, 14, 0)], closed: true))\n".to_owned(),
            "slab, other",
            &["`slab`", "`other`", "overlap"],
            2,
        ),
        ("twice", "surface other = plane(polyline(ring, closed: true))\n".to_owned(), "slab, other", &["`slab`", "`other`", "overlap"], 1),
        (
            "corner",
            "surface fin = plane(polyline([(5, 5, 0), (6, 5, 2), (4, 5, 2)], closed: true))\n".to_owned(),
            "slab, fin",
            &["an edge of `fin` meets `slab`"],
            2,
        ),
    ];
    for (name, text, list, words, parts) in cases {
        let (said, found) = contacts(name, &format!("{slab}{text}mesh m of {list} {{ size: 0.7m }}\n"));
        assert!(said.len() == 1 && words.iter().all(|w| said[0].contains(w)), "{name}: {said:?}");
        assert_eq!(found, parts, "{name}");
    }
}

#[test]
fn faces_that_share_their_borders_or_lie_apart_are_not_told() {
    let block = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/block.loft")).unwrap();
    let slab = "units m\nlet ring = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]\nsurface slab = plane(polyline(ring, closed: true))\n";
    let cases = [
        ("block", block.replace("bores = [", "bores = [ ")),
        (
            "half",
            format!("{slab}surface next = extrude(line((10, 2, 0), (10, 5, 0)), by: (3, 0, 1))\nmesh m of slab, next {{ size: 0.7m }}\n"),
        ),
        ("above", format!("{slab}surface lid = move(slab, by: (0, 0, 0.001))\nmesh m of slab, lid {{ size: 0.7m }}\n")),
        (
            "line",
            format!(
                "{slab}curve rim = circle(center: (5, 5, 0), radius: 1)\nsurface column = extrude(rim, by: (0, 0, -3))\nmesh m of slab, column, rim {{ size: 0.7m }}\n"
            ),
        ),
        (
            "asked",
            format!(
                "{slab}surface column = extrude(circle(center: (5, 5, 0), radius: 1), by: (0, 0, -3))\nmesh m of slab, column {{ size: 0.7m  conforming: false }}\n"
            ),
        ),
    ];
    for (name, text) in cases {
        let (said, _) = contacts(name, &text);
        assert!(said.is_empty(), "{name}: {said:?}");
    }
}

/// The mesh of these declarations with `imprint: true`: conforming, without overlap or loose nodes, of so many parts.
fn imprinted(name: &str, text: &str) -> Outcome {
    let outcome = run(name, text);
    let said: Vec<_> = outcome.diagnostics.iter().filter(|d| d.code.0 == "W667").map(|d| &d.message).collect();
    assert!(said.is_empty(), "{name}: {said:?}");
    for (_, mesh) in &outcome.meshes {
        let mut at: Vec<_> = mesh.nodes.iter().map(|p| p.to_array().map(|x| (x * 1e6).round() as i64)).collect();
        let all = at.len();
        at.sort_unstable();
        at.dedup();
        assert_eq!(at.len(), all, "{name}: two nodes in one place");
    }
    outcome
}

/// Area of the elements of a face, by its set.
fn area(mesh: &Mesh, name: &str) -> f64 {
    let p = |n: u32| mesh.nodes[n as usize];
    let triangle = |t: [u32; 3]| 0.5 * (p(t[1]) - p(t[0])).cross(p(t[2]) - p(t[0])).length();
    let own = |f: &&lofting::mesh::FaceRange| f.name == name;
    let of = |f: &lofting::mesh::FaceRange| -> f64 {
        let quads = &mesh.quads[f.quads.start as usize..f.quads.end as usize];
        let halves = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
        mesh.triangles[f.triangles.start as usize..f.triangles.end as usize].iter().copied().chain(halves).map(triangle).sum()
    };
    mesh.faces.iter().filter(own).map(of).sum()
}

/// Length of the edges that three elements or more have.
fn joined(mesh: &Mesh) -> f64 {
    let mut uses = std::collections::BTreeMap::<(u32, u32), usize>::new();
    let corners = mesh.triangles.iter().map(|t| t.to_vec()).chain(mesh.quads.iter().map(|q| q.to_vec()));
    for c in corners {
        (0..c.len()).for_each(|k| {
            let (a, b) = (c[k], c[(k + 1) % c.len()]);
            *uses.entry((a.min(b), a.max(b))).or_default() += 1;
        });
    }
    let length = |(a, b): &(u32, u32)| mesh.nodes[*a as usize].distance(mesh.nodes[*b as usize]);
    uses.iter().filter(|(_, n)| **n > 2).map(|(e, _)| length(e)).sum()
}

/// A name, declarations, faces, the length of what was joined, and areas of faces with how exact they are.
type Case = (&'static str, String, &'static str, f64, Vec<(&'static str, f64, f64)>);

#[test]
fn faces_that_touch_are_joined_where_that_is_asked() {
    let slab = "units m\nlet ring = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]\nsurface slab = plane(polyline(ring, closed: true))\n";
    let wall = |name: &str, from: &str, to: &str| format!("surface {name} = extrude(line({from}, {to}), by: (0, 0, 3))\n");
    let pi = std::f64::consts::PI;
    // Declarations, faces, edges of three elements or more along what was joined, areas of faces and how exact they are.
    let cases: Vec<Case> = vec![
        (
            "column",
            "surface column = extrude(circle(center: (5, 5, 0), radius: 1), by: (0, 0, -3))\n".to_owned(),
            "slab, column",
            2.0 * pi,
            vec![("slab", 100.0, 1e-9), ("column", 6.0 * pi, 0.02)],
        ),
        ("middle", wall("wall", "(5, 2, 0)", "(5, 8, 0)"), "slab, wall", 6.0, vec![("slab", 100.0, 1e-9), ("wall", 18.0, 1e-9)]),
        ("across", wall("wall", "(5, 0, 0)", "(5, 10, 0)"), "slab, wall", 10.0, vec![("slab", 100.0, 1e-9), ("wall", 30.0, 1e-9)]),
        ("outside", wall("wall", "(5, -2, 0)", "(5, 5, 0)"), "slab, wall", 5.0, vec![("slab", 100.0, 1e-9), ("wall", 21.0, 1e-9)]),
        (
            "walls",
            wall("one", "(2, 5, 0)", "(8, 5, 0)") + &wall("two", "(5, 2, 0)", "(5, 8, 0)"),
            "slab, one, two",
            15.0,
            vec![("slab", 100.0, 1e-9), ("one", 18.0, 1e-9), ("two", 18.0, 1e-9)],
        ),
        (
            "crossing",
            "surface plate = extrude(line((2, 5, -1), (8, 5, -1)), by: (0, 0, 2))\n".to_owned(),
            "slab, plate",
            6.0,
            vec![("slab", 100.0, 1e-9), ("plate", 12.0, 1e-9)],
        ),
        (
            "flush",
            "surface plate = extrude(line((0, 5, -1), (10, 5, -1)), by: (0, 0, 2))\n".to_owned(),
            "slab, plate",
            10.0,
            vec![("slab", 100.0, 1e-9), ("plate", 20.0, 1e-9)],
        ),
        (
            "pipe",
            "surface pipe = extrude(circle(center: (5, 5, -1), radius: 1), by: (0, 0, 2))\n".to_owned(),
            "slab, pipe",
            2.0 * pi,
            vec![("slab", 100.0, 1e-9), ("pipe", 4.0 * pi, 0.02)],
        ),
        (
            "ball",
            "surface ball = revolve(arc((5, 5, -2), (5, 5, 2), through: (7, 5, 0)), axis: line((5, 5, 0), (5, 5, 1)))\n".to_owned(),
            "slab, ball",
            4.0 * pi,
            vec![("slab", 100.0, 1e-9), ("ball", 16.0 * pi, 0.05)],
        ),
    ];
    for (name, text, list, seam, areas) in cases {
        for elements in ["triangles", "quads"] {
            let name = format!("{name}_{elements}");
            let text = format!("{slab}{text}mesh m of {list} {{ size: 0.5m  elements: {elements}  imprint: true }}\n");
            let outcome = imprinted(&name, &text);
            assert_eq!(outcome.report.meshes[0].parts, 1, "{name}");
            let mesh = &outcome.meshes[0].1;
            let joined = joined(mesh);
            assert!((joined / seam - 1.0).abs() < 0.02, "{name}: {joined} {seam}");
            for (face, wanted, within) in &areas {
                let found = area(mesh, face);
                assert!((found / wanted - 1.0).abs() < *within, "{name}: {face} {found} {wanted}");
            }
        }
    }
}

#[test]
fn surfaces_are_cut_by_each_other() {
    let slab = "units m\nlet ring = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]\nsurface slab = plane(polyline(ring, closed: true))\n";
    let pi = std::f64::consts::PI;
    // Declarations, the list, areas of the pieces, parts of the mesh and length of edges of three elements or more.
    let cases: Vec<(&str, &str, &str, Vec<f64>, f64)> = vec![
        (
            "pieces_column",
            "surface column = extrude(circle(center: (5, 5, 0), radius: 1), by: (0, 0, -3))\n",
            "slab, column",
            vec![pi, 6.0 * pi, 100.0 - pi],
            2.0 * pi,
        ),
        ("pieces_wall", "surface wall = extrude(line((5, 0, 0), (5, 10, 0)), by: (0, 0, 3))\n", "slab, wall", vec![30.0, 50.0, 50.0], 10.0),
        (
            "pieces_crossing",
            "surface plate = extrude(line((0, 5, -1), (10, 5, -1)), by: (0, 0, 2))\n",
            "slab, plate",
            vec![10.0, 10.0, 50.0, 50.0],
            10.0,
        ),
        (
            "pieces_pipe",
            "surface pipe = extrude(circle(center: (5, 5, -1), radius: 1), by: (0, 0, 2))\n",
            "slab, pipe",
            vec![2.0 * pi, 2.0 * pi, pi, 100.0 - pi],
            2.0 * pi,
        ),
        (
            "pieces_cover",
            "surface other = plane(polyline([(4, 4, 0), (14, 4, 0), (14, 14, 0), (4, 14, 0)], closed: true))\n",
            "slab, other",
            vec![36.0, 64.0, 64.0],
            0.0,
        ),
        ("pieces_twice", "surface other = plane(polyline(ring, closed: true))\n", "slab, other", vec![100.0], 0.0),
    ];
    for (name, text, list, mut areas, seam) in cases {
        let script = format!(
            "{slab}{text}let pieces = imprint({list})\ngroup floor of slab\nmesh m of pieces {{ size: 0.5m }}\nreport \"areas\": [for p in pieces: {{area: p.area}}]\n"
        );
        let outcome = imprinted(name, &script);
        let mut found: Vec<f64> = outcome.report.reports[0]
            .rows
            .iter()
            .map(|row| match row[0] {
                lofting::session::report::Cell::Number(x) => x,
                _ => f64::NAN,
            })
            .collect();
        found.sort_by(f64::total_cmp);
        areas.sort_by(f64::total_cmp);
        let same = found.len() == areas.len() && found.iter().zip(&areas).all(|(a, b)| (a / b - 1.0).abs() < 1e-5);
        assert!(same, "{name}: {found:?} {areas:?}");
        assert_eq!(outcome.report.meshes[0].parts, 1, "{name}");
        let mesh = &outcome.meshes[0].1;
        assert!((joined(mesh) - seam).abs() <= 0.02 * seam, "{name}: {} {seam}", joined(mesh));
        // The set of the surface is all of its pieces.
        let sets: Vec<_> = mesh.groups.iter().filter(|g| g.name == "slab" || g.name == "floor").collect();
        assert!(sets.len() == 2 && sets[0].triangles == sets[1].triangles, "{name}");
        assert!((area(mesh, "slab") / 100.0 - 1.0).abs() < 1e-9, "{name}: {}", area(mesh, "slab"));
    }
}

#[test]
fn shells_are_cut_where_that_is_asked() {
    let text = "units m
let ring = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]
surface slab = plane(polyline(ring, closed: true))
surface column = extrude(circle(center: (5, 5, 0), radius: 1), by: (0, 0, -3))
surface wall = extrude(line((2, 2, 0), (8, 2, 0)), by: (0, 0, 3))
shell frame of slab, column, wall { imprint: true }
group floor of slab
mesh m of frame { size: 0.5m }
check \"branches\": not frame.closed
";
    let outcome = imprinted("frame", text);
    assert!(outcome.report.checks.iter().all(|c| c.pass), "{:?}", outcome.report.checks);
    assert_eq!(outcome.report.meshes[0].parts, 1);
    let mesh = &outcome.meshes[0].1;
    assert!((area(mesh, "slab") / 100.0 - 1.0).abs() < 1e-9 && (joined(mesh) - 6.0 - 2.0 * std::f64::consts::PI).abs() < 0.2);
    let refused = text.replace(" { imprint: true }", "");
    let disk = Disk::new(None, None, &[], Outputs::Counted).unwrap();
    let outcome = script::outcome("model.loft", refused.as_bytes(), &[], &disk);
    assert!(outcome.drawn(false, false).contains("E618"), "{}", outcome.drawn(false, true));
}

#[test]
fn skins_of_a_shell_that_touch_are_told() {
    let shell = |b: (f64, f64, f64)| {
        let text = format!("units mm\n{}{}shell s of {}, {}\n", cube("a", (0., 0., 0.), 10.0), cube("b", b, 5.0), faces("a"), faces("b"));
        let outcome = run("touching", &text);
        outcome.diagnostics.iter().filter(|d| d.code.0 == "W667").map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    for apart in [(2.0, 2.0, 2.0), (12.0, 0.0, 0.0)] {
        assert_eq!(shell(apart), Vec::<String>::new(), "{apart:?}");
    }
    for near in [(10.0, 2.0, 2.0), (8.0, 2.0, 2.0)] {
        let said = shell(near);
        assert!(said.len() == 1 && said[0].starts_with("`a_w` and `b_"), "{near:?}: {said:?}");
    }
}

#[test]
fn skins_that_touch_in_a_point_are_told() {
    let text = |at: f64| {
        let ball = "let ball = revolve(arc((0, 0, -1), (0, 0, 1), through: (1, 0, 0)))";
        format!("units m\n{ball}\nsurface a = move(ball, by: (3, 0, 0))\nsurface b = move(ball, by: ({at}, 0, 0))\nshell s of a, b\n")
    };
    for (at, wanted) in [(5.0, 1), (5.01, 0), (4.9, 1)] {
        let outcome = run("point", &text(at));
        assert_eq!(outcome.diagnostics.iter().filter(|d| d.code.0 == "W667").count(), wanted, "{at}");
    }
}

/// Surfaces that one expression makes, or that have no short name, have sets of their own, in the mesh and by its faces.
#[test]
fn sets_of_different_surfaces_stay_apart() {
    let text = "units m
surface a = plane(polyline([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], closed: true))
mesh two of [for k in 1..3: move(a, by: (2 * k, 0, 0))] { size: 500mm }
mesh lines of move(a,
  by: (2, 0, 0)), move(a,
  by: (4, 0, 0)) { size: 500mm }
mesh parts of split(a, by: line((0, 0.5, 0), (1, 0.5, 0))) { size: 500mm }
";
    let outcome = run("apart", text);
    let mesh = |name: &str| &outcome.meshes.iter().find(|m| m.0 == name).unwrap().1;
    for (name, wanted) in [("two", 2), ("lines", 2), ("parts", 2)] {
        let mesh = mesh(name);
        assert_eq!(mesh.groups.len(), wanted, "{name}: {:?}", mesh.groups.iter().map(|g| &g.name).collect::<Vec<_>>());
        let mut of_groups: Vec<(&str, Vec<u32>)> = mesh.groups.iter().map(|g| (g.name.as_str(), g.triangles.clone())).collect();
        let mut of_faces = std::collections::BTreeMap::<&str, Vec<u32>>::new();
        mesh.faces.iter().for_each(|face| of_faces.entry(&face.name).or_default().extend(face.triangles.clone()));
        of_groups.sort();
        assert_eq!(of_groups, of_faces.into_iter().collect::<Vec<_>>(), "{name}");
        assert!(mesh.groups.iter().all(|group| !group.name.is_empty()), "{name}");
        assert_eq!(mesh.groups.iter().map(|group| group.triangles.len()).sum::<usize>(), mesh.triangles.len(), "{name}");
    }
}

/// Groups of edges that no declared curve follows: of a trimmed surface, its mirrored copy and an imprinted shell.
#[test]
fn groups_of_edges_hold_all_nodes_on_them_and_no_others() {
    let text = "units m
curve c = circle(center: (2, 2, 0), radius: 0.5)
surface plate = trim(plane(polyline([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)], closed: true)), holes: [c])
let other = mirror(plate, normal: (1, 0, 0))
group rim of plate.edge(c)
group copy of other.edge(mirror(c, normal: (1, 0, 0)))
mesh plates of plate, other { size: 300mm  order: 2 }
surface slab = plane(polyline([(10, 0, 0), (14, 0, 0), (14, 4, 0), (10, 4, 0)], closed: true))
surface tube = extrude(circle(center: (12, 2, -1), radius: 0.5), by: (0, 0, 2))
shell s of slab, tube { imprint: true }
group seam of s.edges.on(circle(center: (12, 2, 0), radius: 0.5))
group low of s.edges.on(plane(at: (0, 0, -1), normal: (0, 0, 1)))
mesh joined of s { size: 300mm }
";
    let outcome = run("edges", text);
    let circles = [
        ("plates", "rim", [2.0, 2.0, 0.0]),
        ("plates", "copy", [-2.0, 2.0, 0.0]),
        ("joined", "seam", [12.0, 2.0, 0.0]),
        ("joined", "low", [12.0, 2.0, -1.0]),
    ];
    for (mesh, group, [x, y, z]) in circles {
        let mesh = &outcome.meshes.iter().find(|m| m.0 == mesh).unwrap().1;
        let held = &mesh.groups.iter().find(|g| g.name == group).unwrap().nodes;
        let lies = |p: &glam::DVec3| (glam::DVec2::new(p.x - x, p.y - y).length() - 0.5).abs() < 1e-6 && (p.z - z).abs() < 1e-6;
        let there: Vec<u32> = (0..mesh.nodes.len() as u32).filter(|n| lies(&mesh.nodes[*n as usize])).collect();
        assert!(there.len() >= 12, "{group}: {there:?}");
        assert_eq!(*held, there, "{group}");
    }
}
