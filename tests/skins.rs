//! Faces as one skin: which side they show.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "support/script.rs"]
mod script;

use std::path::Path;

use lofting::base::fault::Severity;
use lofting::io::stl_read;
use lofting::mesh::Mesh;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::run::Outcome;

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
