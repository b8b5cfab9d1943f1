//! Edges of surfaces and shells in meshes: sets hold every node along an edge, rules decide it, whatever the edge is made of.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec3;
use lofting::base::fault::Severity;
use lofting::base::origin::Origin;
use lofting::io::formats::choice::format_for;
use lofting::io::mesh_files::deck::{Deck, Options};
use lofting::mesh::Mesh;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::json::report_text;
use lofting::session::run::Outcome;

use crate::support::script;

/// Scripts that make `s`, each with how many edges it has.
const KINDS: [(&str, usize, &str); 17] = [
    ("extrude", 4, "surface s = extrude(arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 1m)), by: (0, 3m, 0))"),
    ("tube", 3, "surface s = extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 2m))"),
    ("cone", 4, "surface s = revolve(line((1m, 0, 0), (2m, 0, 2m)), axis: line((0, 0, 0), (0, 0, 1m)), angle: 200deg)"),
    ("full cone", 3, "surface s = revolve(line((1m, 0, 0), (2m, 0, 2m)), axis: line((0, 0, 0), (0, 0, 1m)))"),
    (
        "bowl",
        2,
        "surface s = revolve(arc((0, 0, -1m), (1m, 0, 0), through: (707.1067811865476mm, 0, -707.1067811865476mm)), axis: line((0, 0, 0), (0, 0, 1m)))",
    ),
    ("ruled", 4, "surface s = ruled(arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 1m)), line((0, 3m, 0), (4m, 3m, 1m)))"),
    (
        "coons",
        4,
        "curve a = arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 1m))\ncurve b = line((4m, 0, 0), (4m, 3m, 0))
curve c = arc((4m, 3m, 0), (0, 3m, 0), through: (2m, 3m, 1.5m))\ncurve d = line((0, 3m, 0), (0, 0, 0))\nsurface s = coons(a, b, c, d)",
    ),
    (
        "hermite",
        3,
        "curve a = arc((0, 0, 1m), (1m, 0, 0), through: (800mm, 0, 600mm))\ncurve b = arc((0, 0, 1m), (0, 1m, 0), through: (0, 800mm, 600mm))
curve c = arc((1m, 0, 0), (0, 1m, 0), through: (800mm, 600mm, 0))\nsurface s = hermite(a, b, c, pole: (0, 0, 1m), twist: similar)",
    ),
    (
        "transfinite",
        4,
        "surface s = transfinite(u: [line((0, 0, 0), (4m, 0, 0)), line((0, 3m, 1m), (4m, 3m, 0))],
  v: [line((0, 0, 0), (0, 3m, 1m)), line((4m, 0, 0), (4m, 3m, 0))])",
    ),
    ("net", 4, "surface s = bezier_surface([[(0, 0, 0), (1m, 0, 1m), (2m, 0, 0)], [(0, 2m, 0), (1m, 2m, 0), (2m, 2m, 1m)]])"),
    ("plane", 5, "surface s = plane(polyline([(0, 0), (3m, 0), (4m, 2m), (2m, 4m), (0, 3m)], closed: true))"),
    (
        "plate with holes",
        6,
        "surface plate = plane(polyline([(0, 0), (4m, 0), (4m, 3m), (0, 3m)], closed: true))
surface s = trim(plate, holes: [circle(center: (1m, 1m), radius: 0.5m), circle(center: (3m, 2m), radius: 0.4m)])",
    ),
    (
        "trimmed roof",
        5,
        "surface roof = extrude(arc((0, 0, 0), (4m, 0, 0), through: (2m, 0, 1m)), by: (0, 3m, 0))
surface s = trim(roof, holes: [project(circle(center: (2m, 1.5m, 2m), radius: 0.5m), onto: roof, along: (0, 0, -1))])",
    ),
    ("moved", 3, "surface w = extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 2m))\nsurface s = move(w, by: (5m, 0, 0))"),
    (
        "mirrored",
        3,
        "surface w = extrude(circle(center: (5m, 0, 0), radius: 1m), by: (0, 0, 2m))\nsurface s = mirror(w, normal: (1, 0, 0))",
    ),
    (
        "glued shell",
        10,
        "surface w = extrude(line((0, 0, 0), (4m, 0, 0)), by: (0, 0, 3m))
surface a = extrude(line((0, 0.1mm, 0), (2m, 0.1mm, 0)), by: (0, 2m, 0))
surface b = extrude(line((2m, 0.1mm, 0), (4m, 0.1mm, 0)), by: (0, 2m, 0))
shell s of w, a, b { snap: 1mm }",
    ),
    (
        "faces of a file",
        10,
        "import \"examples/data/fuselage.igs\" as part
surface face for k in 0..len(part.surfaces) = part.surfaces[k]
shell s of face",
    ),
];

/// Steps of every edge that a rule asks for.
const COUNT: usize = 12;

fn run(name: &str, text: &str) -> Outcome {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = root.join("edges.loft");
    let disk = Disk::new(Some(&path), None, &[], Outputs::Counted).unwrap();
    let outcome = script::outcome("edges.loft", text.as_bytes(), &[], &disk);
    let errors: Vec<String> =
        outcome.diagnostics.iter().filter(|d| d.severity() == Severity::Error).map(|d| format!("{} {}", d.code.0, d.message)).collect();
    assert!(errors.is_empty() && !outcome.bug, "{name}: {errors:?}\n{text}");
    outcome
}

/// Edges of elements by their nodes, with the mid node in order 2.
fn steps(mesh: &Mesh) -> BTreeMap<(u32, u32), Option<u32>> {
    let mut found = BTreeMap::new();
    let mut add = |corners: &[u32], mids: Option<&[u32]>| {
        for k in 0..corners.len() {
            let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
            found.insert((a.min(b), a.max(b)), mids.map(|m| m[k]));
        }
    };
    mesh.triangles.iter().enumerate().for_each(|(k, t)| add(t, mesh.triangle_mids.get(k).map(|m| &m[..])));
    mesh.quads.iter().enumerate().for_each(|(k, q)| add(q, mesh.quad_mids.get(k).map(|m| &m[..])));
    found
}

/// Length of the way along all nodes of a set, each step an edge of an element; the shortest tree, which is the line itself
/// where steps are short, and one step more where it is a ring.
fn way(mesh: &Mesh, nodes: &[u32], ring: bool) -> f64 {
    let set: BTreeSet<u32> = nodes.iter().copied().collect();
    let at = |n: u32| mesh.nodes[n as usize];
    let mut all: Vec<(f64, u32, u32)> = Vec::new();
    for ((a, b), mid) in steps(mesh) {
        match mid {
            Some(m) if [a, b, m].iter().all(|n| set.contains(n)) => {
                all.extend([(at(a).distance(at(m)), a, m), (at(m).distance(at(b)), m, b)]);
            }
            None if set.contains(&a) && set.contains(&b) => all.push((at(a).distance(at(b)), a, b)),
            _ => {}
        }
    }
    all.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut root: BTreeMap<u32, u32> = set.iter().map(|n| (*n, *n)).collect();
    fn find(root: &BTreeMap<u32, u32>, mut n: u32) -> u32 {
        while root[&n] != n {
            n = root[&n];
        }
        n
    }
    let (mut length, mut longest, mut taken) = (0.0, 0.0_f64, 0);
    for (step, a, b) in &all {
        let (x, y) = (find(&root, *a), find(&root, *b));
        if x != y {
            root.insert(x, y);
            (length, longest, taken) = (length + step, longest.max(*step), taken + 1);
        }
    }
    assert_eq!(taken + 1, set.len(), "the set is in pieces");
    if ring { length + longest } else { length }
}

/// Lengths of the edges of `s`, and whether each is a ring.
fn measured(kind: &str, text: &str) -> Vec<(f64, bool)> {
    let outcome = run(kind, &format!("{text}\nreport [for e in s.edges: {{l: e.length / 1m, ring: e.vertices[0] == e.vertices[1]}}]\n"));
    let json: serde_json::Value = serde_json::from_str(&report_text(&outcome.report)).unwrap();
    let rows = json["reports"][0]["rows"].as_array().unwrap_or_else(|| panic!("{kind}: no rows in {}", json["reports"])).clone();
    rows.iter().map(|row| (1e3 * row[0].as_f64().unwrap(), row[1].as_bool().unwrap())).collect()
}

/// The numbers of each node set of an INP file, by name.
fn sets_of_deck(mesh: &Mesh) -> BTreeMap<String, Vec<u32>> {
    let format = format_for(Origin::NONE, "m.inp").unwrap();
    let mut bytes = Vec::new();
    let options = Options::default();
    (format.write)(&Deck { mesh, unit: "mm", options: &options }, &mut bytes).unwrap();
    let mut sets: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    let mut current: Option<String> = None;
    for line in String::from_utf8(bytes).unwrap().lines() {
        if line.starts_with('*') {
            let name = line.split_once("*NSET, NSET=").or(line.split_once("*Nset, nset=")).map(|(_, name)| name.trim().to_owned());
            current = name;
        } else if let Some(name) = &current {
            sets.entry(name.clone()).or_default().extend(line.split(',').filter_map(|n| n.trim().parse::<u32>().ok()));
        }
    }
    sets
}

#[test]
fn every_edge_of_every_kind_is_a_member_of_groups_and_rules() {
    for (kind, edges, text) in KINDS {
        let lengths = measured(kind, text);
        assert_eq!(lengths.len(), edges, "{kind}");
        let longest = lengths.iter().map(|l| l.0).fold(0.0, f64::max);
        for (k, (length, ring)) in lengths.iter().enumerate() {
            for order in [1, 2] {
                let mesh = format!(
                    "{text}\nlet e = s.edges[{k}]\ngroup g of e\nmesh m of s {{ size: {}mm order: {order} method: delaunay on e {{ count: {COUNT} }} }}\n",
                    longest / 15.0
                );
                let outcome = run(kind, &mesh);
                let codes: Vec<&str> = outcome.diagnostics.iter().map(|d| d.code.0).filter(|c| c.starts_with('W')).collect();
                assert!(codes.is_empty(), "{kind} {k}: {codes:?}");
                let mesh = &outcome.meshes[0].1;
                let group = mesh.groups.iter().find(|g| g.name == "g").unwrap();
                let corners = COUNT + usize::from(!ring);
                assert_eq!(group.nodes.len(), corners + (order - 1) * COUNT, "{kind}, edge {k}, order {order}");
                let along = way(mesh, &group.nodes, *ring);
                // A step of an arc is shorter by a share of a 24th of the square of its angle.
                assert!(along <= length * 1.000_1 && along >= length * 0.98, "{kind}, edge {k}: {along} for {length}");
                let written = &sets_of_deck(mesh)["g"];
                assert_eq!(*written, group.nodes.iter().map(|n| n + 1).collect::<Vec<u32>>(), "{kind}, edge {k}");
                let json: serde_json::Value = serde_json::from_str(&report_text(&outcome.report)).unwrap();
                let rows = json["meshes"][0]["groups"].as_array().unwrap();
                let row = rows.iter().find(|row| row["name"] == "g").unwrap();
                assert_eq!(row["nodes"], group.nodes.len(), "{kind}, edge {k}");
            }
        }
    }
}

#[test]
fn edges_come_in_one_order_whatever_the_order_of_curves() {
    let lines = [
        "curve south = line((0, 0, 0), (4m, 0, 0))",
        "curve east = line((4m, 0, 0), (4m, 3m, 0))",
        "curve north = line((4m, 3m, 0), (0, 3m, 0))",
        "curve west = line((0, 3m, 0), (0, 0, 0))",
        "surface roof = coons(south, east, north, west)",
        "surface wall = extrude(south, by: (0, 0, -2m))",
        "surface gable = extrude(east, by: (0, 0, -2m))",
    ];
    let tail = "shell s of roof, wall, gable\nreport [for e in s.edges: e.mid]\nreport [for r in s.rims: [for e in r: e.mid]]
report [for e in s.creases(angle: 30deg): e.mid]\nreport [for c in connection(s): c.mid]\nreport [for e in roof.edges: e.mid]\n";
    let of = |order: &[usize]| {
        let text: Vec<&str> = order.iter().map(|k| lines[*k]).collect();
        let json: serde_json::Value =
            serde_json::from_str(&report_text(&run("order", &format!("{}\n{tail}", text.join("\n"))).report)).unwrap();
        json["reports"].clone()
    };
    let first = of(&[0, 1, 2, 3, 4, 5, 6]);
    assert_eq!(first[0]["rows"].as_array().unwrap().len(), 9);
    for order in [[6, 5, 4, 3, 2, 1, 0], [3, 1, 0, 2, 6, 4, 5], [5, 0, 6, 1, 4, 2, 3]] {
        assert_eq!(of(&order), first, "{order:?}");
    }
}

#[test]
fn sets_lie_where_the_edge_is() {
    let text = "surface w = extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 2m))
group low of w.rims.on(plane(at: (0, 0, 0), normal: (0, 0, 1)))\ngroup high of w.rims.inside(box((-1m, -1m, 2m), (1m, 1m, 2m)))
group both of w.edges.by_length(least: 5m)\nmesh m of w { size: 300mm }\n";
    let outcome = run("tube", text);
    let mesh = &outcome.meshes[0].1;
    let of = |name: &str| -> Vec<DVec3> {
        mesh.groups.iter().find(|g| g.name == name).unwrap().nodes.iter().map(|n| mesh.nodes[*n as usize]).collect()
    };
    let (low, high, both) = (of("low"), of("high"), of("both"));
    assert!(low.len() > 18 && low.iter().all(|p| p.z.abs() < 1e-9));
    assert!(high.len() > 18 && high.iter().all(|p| (p.z - 2000.0).abs() < 1e-9));
    assert_eq!(both.len(), low.len() + high.len());
}
