//! The reference numbers of meshing (`data/reference/meshing.json`, `point_in_loop.json`): what weak methods miss is found here.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use lofting::base::job::Job;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::line;
use lofting::mesh::Mesh;
use lofting::mesh::chart::parametric_surface::{ParametricSurface, Spot, UniformSize};
use lofting::mesh::data::face_geometry::FaceNodes;
use lofting::mesh::quad::net::Net;
use lofting::mesh::quad::smooth::Smoother;
use lofting::network::Chain;
use lofting::session::live::{Depth, Live};
use lofting::surface::core::plane;
use lofting::surface::{closest, polynomial, trim};
use serde_json::Value;

use crate::support::reference::reference;

/// The plane z = 0.
struct Flat;

impl ParametricSurface for Flat {
    fn spot(&self, xy: DVec2) -> Spot {
        Spot { p: xy.extend(0.0), dx: DVec3::X, dy: DVec3::Y }
    }
    fn clamp(&self, xy: DVec2) -> DVec2 {
        xy
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect()
}

fn point(value: &Value) -> DVec3 {
    let n = numbers(value);
    DVec3::new(n[0], n[1], n.get(2).copied().unwrap_or(0.0))
}

/// The meshes of a script.
fn meshes(text: &str) -> Vec<Arc<Mesh>> {
    let mut live = Live::new("numbers.loft", None, &[], Arc::new(|| 0.0));
    let outcome = live.run(text, &[], Depth::Report, &Job::new(), &mut |_| {}).unwrap();
    assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
    outcome.meshes.iter().map(|m| m.1.clone()).collect()
}

/// Farthest that points of a curve are from the line elements of a mesh.
fn off(mesh: &Mesh, curve: impl Fn(f64) -> DVec3) -> f64 {
    let to_piece = |p: DVec3, l: &[u32; 2]| {
        let [a, b] = l.map(|n| mesh.nodes[n as usize]);
        let share = ((p - a).dot(b - a) / a.distance_squared(b)).clamp(0.0, 1.0);
        p.distance(a.lerp(b, share))
    };
    let at = |k: u32| curve(f64::from(k) / 2000.0);
    (0..=2000).map(|k| mesh.lines.iter().map(|l| to_piece(at(k), l)).fold(f64::INFINITY, f64::min)).fold(0.0, f64::max)
}

#[test]
fn two_faces_share_the_six_nodes_of_the_reference() {
    let fact = &reference("meshing")["boundary_pretreatment"];
    let (low, high) = (numbers(&fact["characteristic_points"]["face1"]), numbers(&fact["characteristic_points"]["face2"]));
    let mut text = "units m\ncurve spine = line((0, 0, 0), (10, 0, 0))\n".to_owned();
    let mut names = Vec::new();
    for (row, (stops, y)) in [(&low, -2.5), (&high, 2.5)].into_iter().enumerate() {
        text += &format!("curve outer{row} = line((0, {y}, 0), (10, {y}, 0))\n");
        for (k, x) in stops.iter().enumerate() {
            text += &format!("curve rib{row}_{k} = line(({x}, 0, 0), ({x}, {y}, 0))\n");
        }
        for k in 0..stops.len() - 1 {
            text += &format!("surface s{row}_{k} = coons(spine, rib{row}_{}, outer{row}, rib{row}_{k})\n", k + 1);
            names.push(format!("s{row}_{k}"));
        }
    }
    for method in ["mapped", "delaunay"] {
        let size = fact["max_edge"].as_f64().unwrap();
        // Steps of free faces are shorter than their size by the room that triangles take.
        let size = if method == "mapped" { size } else { size / 0.8 };
        let mesh =
            meshes(&format!("{text}mesh m of {} {{ size: {size}  method: {method}  elements: triangles }}\n", names.join(", "))).remove(0);
        let mut found: Vec<f64> = mesh.nodes.iter().filter(|p| p.y.abs() < 1e-9).map(|p| p.x).collect();
        found.sort_by(f64::total_cmp);
        let wanted = numbers(&fact["nodes"]);
        assert_eq!(found.len(), wanted.len(), "{method}: {found:?}");
        assert!(found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-9), "{method}: {found:?}");
    }
}

#[test]
fn circles_take_the_segments_of_the_reference() {
    for fact in reference("meshing")["chord_error"].as_array().unwrap() {
        let radius = fact["radius"].as_f64().unwrap();
        if let (Some(error), Some(segments)) = (fact["error"].as_f64(), fact["segments_full_circle"].as_u64()) {
            let text = format!("units mm\ncurve c = circle((0, 0, 0), {radius})\nmesh m of c {{ size: 10m  chord_error: {error}mm }}\n");
            let mesh = meshes(&text).remove(0);
            assert_eq!(mesh.lines.len() as u64, segments, "{fact}");
            let [a, b] = mesh.lines[0].map(|n| mesh.nodes[n as usize]);
            assert!(a.distance(b) <= fact["max_chord"].as_f64().unwrap());
        } else {
            // An arc over that chord: its sagitta is the least error that one segment keeps.
            let (half, sagitta) = (0.5 * fact["chord"].as_f64().unwrap(), fact["exact_sagitta"].as_f64().unwrap());
            for (share, lines) in [(1.0 - 1e-6, 2), (1.0 + 1e-2, 1)] {
                let error = share * sagitta;
                let text = format!(
                    "units mm\ncurve c = arc(({}, 0, 0), ({half}, 0, 0), through: (0, {sagitta}, 0))\nmesh m of c {{ size: 10m  chord_error: {error}mm }}\n",
                    -half
                );
                assert_eq!(meshes(&text).remove(0).lines.len(), lines, "{share}");
            }
        }
    }
}

#[test]
fn what_samples_of_a_curve_miss_is_divided() {
    let fact = &reference("meshing");
    // The foot of the middle of the chord sees less than there is: limits between the two take two steps.
    let (seen, there) = (&fact["mid_chord_projection"]["epsilon"], &fact["mid_chord_projection"]["true_max_distance_to_chord"]);
    let (seen, there) = (seen.as_f64().unwrap(), there.as_f64().unwrap());
    for (limit, lines) in [(0.5 * (seen + there), 2), (1.001 * there, 1)] {
        let text = format!(
            "units m\ncurve c = bezier([(0, 0, 0), (0.5, 0, 0), (1, 1, 0)])\nmesh m of c {{ size: 100m  chord_error: {limit}m }}\n"
        );
        assert_eq!(meshes(&text).remove(0).lines.len(), lines, "{limit}");
    }
    // An inflection at the middle: y = x (1 − x) (1 − 2x).
    let there = fact["three_sample_test"]["midpoint_only_failure"]["true_deviation"].as_f64().unwrap();
    let cubic = |t: f64| DVec3::new(t, t * (1.0 - t) * (1.0 - 2.0 * t), 0.0);
    for limit in [0.9 * there, 0.1 * there] {
        let third = 1.0 / 3.0;
        let text = format!(
            "units m\ncurve c = bezier([(0, 0, 0), ({third}, {third}, 0), ({}, {}, 0), (1, 0, 0)])\nmesh m of c {{ size: 100m  chord_error: {limit}m }}\n",
            2.0 * third,
            -third
        );
        let mesh = meshes(&text).remove(0);
        assert!(mesh.lines.len() > 1 && off(&mesh, cubic) <= limit, "{limit}: {}", mesh.lines.len());
    }
    // Four waves of which samples at quarters see nothing.
    let wave = |t: f64| DVec3::new(t, 0.5 * (4.0 * std::f64::consts::PI * t).sin(), 0.0);
    let points: Vec<String> = (0..=64).map(|k| wave(f64::from(k) / 64.0)).map(|p| format!("({}, {}, 0)", p.x, p.y)).collect();
    let text = format!("units m\ncurve c = spline([{}])\nmesh m of c {{ size: 100m  chord_error: 20mm }}\n", points.join(", "));
    let mesh = meshes(&text).remove(0);
    assert!(mesh.lines.len() >= 8 && off(&mesh, wave) <= 0.0201, "{} {}", mesh.lines.len(), off(&mesh, wave));
}

#[test]
fn a_narrow_bump_of_a_surface_is_found() {
    let bump = |u: f64, v: f64| (-((u - 0.37) * (u - 0.37) + (v - 0.37) * (v - 0.37)) / 0.0008).exp();
    let row = |j: u32| {
        let v = f64::from(j) / 100.0;
        let points: Vec<String> =
            (0..=100).map(|i| format!("({}, {v}, {})", f64::from(i) / 100.0, bump(f64::from(i) / 100.0, v))).collect();
        format!("[{}]", points.join(", "))
    };
    let rows: Vec<String> = (0..=100).map(row).collect();
    for (method, most) in [("isoline", 5_000), ("display", 1_500)] {
        let text =
            format!("units m\nsurface s = grid([{}])\nmesh m of s {{ size: 1m  chord_error: 100mm  method: {method} }}\n", rows.join(", "));
        let mesh = meshes(&text).remove(0);
        let top = mesh.nodes.iter().map(|p| p.z).fold(0.0, f64::max);
        assert!(top > 0.85 && mesh.chord_error(&Tolerance::new(1e-6, 1.0)).unwrap() <= 0.1, "{method}: {top}");
        assert!(mesh.triangles.len() < most, "{method}: {}", mesh.triangles.len());
    }
}

#[test]
fn feet_of_the_reference_are_the_nearest() {
    let coefficients =
        [vec![DVec3::ZERO, DVec3::Y, DVec3::Z], vec![DVec3::X, DVec3::ZERO, DVec3::ZERO], vec![DVec3::Z, DVec3::ZERO, DVec3::ZERO]];
    let bowl = polynomial(&coefficients, Origin::NONE, &Tolerance::new(1e-6, 1.0)).unwrap();
    let facts = reference("meshing");
    let fact = &facts["normal_projection"];
    let found = closest(&bowl, point(&fact["point"]));
    let result = &fact["result"];
    assert!((found.distance - result["distance"].as_f64().unwrap()).abs() < 1e-9, "{found:?}");
    assert!(found.point.distance(point(&result["foot"])) < 1e-8, "{found:?}");
    // Where Newton's method alone ends at a maximum.
    let fact = &facts["normal_projection_failure"];
    let found = closest(&bowl, point(&fact["point"]));
    assert!((found.distance - fact["true_distance"].as_f64().unwrap()).abs() < 1e-9, "{found:?}");
    let at = numbers(&fact["true_nearest"]);
    assert!((found.point.x - at[0]).abs() + (found.point.y - at[1]).abs() < 1e-6, "{found:?}");
}

#[test]
fn points_in_loops_are_those_of_the_reference() {
    let (fact, tolerance) = (reference("point_in_loop"), Tolerance::new(1e-6, 1.0));
    let ring = |points: &[DVec3]| -> Vec<Chain> {
        let side = |k: usize| Chain::of_curve(&line(points[k], points[(k + 1) % points.len()], Origin::NONE).unwrap());
        (0..points.len()).map(side).collect()
    };
    let flat = plane::unbounded(DVec3::ZERO, DVec3::Z, Origin::NONE).unwrap();
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let corner = |k: u32| {
        let angle = 2.0 * std::f64::consts::PI * (f64::from(k) + 0.5) / 32.0;
        DVec3::new(0.5 + 0.2 * angle.cos(), 0.5 + 0.2 * angle.sin(), 0.0)
    };
    let hole: Vec<DVec3> = (0..32).map(corner).collect();
    let plate = trim(&flat, &ring(&square), &[ring(&hole)], Origin::NONE, &tolerance).unwrap();
    for query in fact["queries"].as_array().unwrap() {
        let p = point(&query["point"]);
        let (u, v) = plate.flat_uv(p).unwrap();
        // Nearer to a border than the tolerance a point belongs to it.
        let wanted = if p.x.abs() < tolerance.point { continue } else { query["expected"] == "inside" };
        assert_eq!(plate.holds(u, v), wanted, "{query}");
    }
    let fact = &fact["unsigned_angle_counterexample"];
    let corners: Vec<DVec3> = fact["polygon"].as_array().unwrap().iter().map(point).collect();
    let horseshoe = trim(&flat, &ring(&corners), &[], Origin::NONE, &tolerance).unwrap();
    for (key, wanted) in [("inside_point", true), ("outside_point", false)] {
        let (u, v) = horseshoe.flat_uv(point(&fact[key])).unwrap();
        assert_eq!(horseshoe.holds(u, v), wanted, "{key}");
    }
}

/// A curve that closes in itself turns all the way round: its steps share that out, also where nothing else divides it.
#[test]
fn angles_divide_closed_curves() {
    let text = "units m\ncurve c = circle(center: (0, 0), radius: 1)\nsurface s = plane([c])\n\
                mesh alone of c { size: 1m  angle_error: 1deg }\nmesh round of s { size: 1m  angle_error: 1deg }\n";
    let [alone, round] = &meshes(text)[..] else { panic!("two meshes") };
    assert_eq!(alone.nodes.len(), 360);
    assert!(round.nodes.len() > 360, "{}", round.nodes.len());
}

/// One cubic span over its chord, d(t) = t (1 − t) (a + b t), of which three samples see the least share.
#[test]
fn the_worst_cubic_for_three_samples_is_divided() {
    let wanted = reference("meshing")["three_sample_test"]["single_cubic_span_worst_ratio_true_over_sampled"].as_f64().unwrap();
    let ratio = |angle: f64| {
        let d = |t: f64| (t * (1.0 - t) * (angle.cos() + angle.sin() * t)).abs();
        let seen = [0.25, 0.5, 0.75].map(d).into_iter().fold(0.0, f64::max);
        let there = (0..=4000).map(|k| d(f64::from(k) / 4000.0)).fold(0.0, f64::max);
        (there / seen, seen, there)
    };
    let angles = (0..20_000).map(|k| std::f64::consts::PI * f64::from(k) / 20_000.0);
    let worst = angles.max_by(|a, b| ratio(*a).0.total_cmp(&ratio(*b).0)).unwrap();
    let (found, seen, there) = ratio(worst);
    assert!((found - wanted).abs() < 1e-4, "{found}");
    let (a, b) = (worst.cos(), worst.sin());
    // y = a t + (b − a) t² − b t³ over x = t, by its Bézier points.
    let (first, second) = (a / 3.0, (a + b) / 3.0);
    // Above the farthest control point one step is sure.
    for (limit, divided) in [(0.5 * (seen + there), true), (1.001 * first.abs().max(second.abs()), false)] {
        let text = format!(
            "units m\ncurve c = bezier([(0, 0, 0), ({}, {first}, 0), ({}, {second}, 0), (1, 0, 0)])\nmesh m of c {{ size: 100m  chord_error: {limit}m }}\n",
            1.0 / 3.0,
            2.0 / 3.0
        );
        assert_eq!(meshes(&text).remove(0).lines.len() > 1, divided, "{limit}");
    }
}

/// The plane with a node in the middle of four quads, smoothed once: it goes to the area-weighted mean of their centroids.
#[test]
fn a_node_goes_to_the_weighted_centroid_of_the_reference() {
    let fact = &reference("meshing")["centroid_smoothing"]["planar"];
    let mut net = Net::default();
    let add = |p: DVec3, net: &mut Net| -> u32 {
        let known = net.p.iter().position(|q| q.distance(p) < 1e-12);
        known.unwrap_or_else(|| {
            net.p.push(p);
            net.xy.push(p.truncate());
            net.normal.push(DVec3::Z);
            net.size.push(1.0);
            net.p.len() - 1
        }) as u32
    };
    let rings: Vec<Vec<DVec3>> =
        fact["polygons"].as_array().unwrap().iter().map(|ring| ring.as_array().unwrap().iter().map(point).collect()).collect();
    // The border first, the node in the middle last.
    for p in rings.iter().flat_map(|ring| &ring[1..]) {
        add(*p, &mut net);
    }
    net.fixed = net.p.len() as u32;
    for ring in &rings {
        let corners: Vec<u32> = ring.iter().map(|p| add(*p, &mut net)).collect();
        net.face.push([corners[0], corners[1], corners[2], corners[3]]);
    }
    let middle = net.fixed as usize;
    assert_eq!(net.p.len(), middle + 1);
    Smoother::new(&mut net, &Flat, &UniformSize(1.0)).smooth(1, &Job::new()).unwrap();
    assert!(net.p[middle].distance(point(&fact["new_position"])) < 1e-12, "{}", net.p[middle]);
}

/// A script with the end of its line moved: no count may change while it moves by less than half the tolerance.
fn keeps_counts(text: &str) {
    let nodes = |x: f64, y: f64| -> Vec<Vec<DVec3>> {
        let moved = text.replace("DX", &format!("{x:e}")).replace("DY", &format!("{y:e}"));
        meshes(&moved).iter().map(|m| m.nodes.clone()).collect()
    };
    let plain = nodes(0.0, 0.0);
    for (x, y) in [(4.9, 0.0), (-4.9, 0.0), (0.0, 4.9), (0.0, -4.9), (3.4, 3.4), (-3.4, 3.4), (0.01, 0.0), (0.0, -0.01)] {
        let found = nodes(x * 1e-7, y * 1e-7);
        for (a, b) in plain.iter().zip(&found) {
            assert_eq!(a.len(), b.len(), "{text} moved by {x} {y} tenths of the tolerance");
            // What is grown inside a free face follows the least of its border's digits.
            let grown = text.contains("delaunay");
            let off = a.iter().zip(b).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
            assert!(grown || off < 1e-4, "{text} moved by {x} {y} tenths of the tolerance: nodes by {off}");
        }
    }
}

#[test]
fn ends_that_move_within_the_tolerance_change_no_count() {
    let rims = "point P = (4 + DX, DY, 0)\ncurve south = line((0, 0, 0), P)\ncurve east = line(P, (4, 3, 0))\n\
                curve north = line((4, 3, 0), (0, 3, 0))\ncurve west = line((0, 3, 0), (0, 0, 0))\n";
    let plate = format!("units m\n{rims}surface s = coons(south, east, north, west)\n");
    for settings in [
        "size: 500mm",
        "size: 100mm",
        "size: 250mm  elements: quads",
        "size: 500mm  on south { bias: 3 }",
        "size: 100mm  on south { bias: 0.5 }",
        "size: 500mm  method: delaunay",
        "size: 1m  near (0, 0, 0) { size: 250mm  radius: 1m }",
    ] {
        keeps_counts(&format!("{plate}mesh m of s {{ {settings} }}\n"));
    }
    keeps_counts(&format!("units m\n{rims}mesh m of south, east {{ size: 100mm }}\n"));
    // An arc of a right angle, by its end and by a point on it, and a circle.
    for arc in
        ["(2, 0, 0), (DX, 2 + DY, 0), through: (sqrt(2), sqrt(2), 0)", "(2, 0, 0), (0, 2, 0), through: (sqrt(2) + DX, sqrt(2) + DY, 0)"]
    {
        for limit in ["angle_error: 10deg", "angle_error: 15deg", "angle_error: 90deg", "chord_error: 2 * (1 - cos(5deg))"] {
            keeps_counts(&format!(
                "units m\ncurve a = arc({arc})\nsurface s = extrude(a, by: (0, 0, 3))\nmesh m of s {{ size: 10m  {limit} }}\n"
            ));
        }
    }
    // Ties: a count over three links of one length, and a side of two pieces opposite to nine steps.
    let links =
        "curve a = line((0, 0, 0), (1, 0, 0))\ncurve b = line((1, 0, 0), (2 + DX, DY, 0))\ncurve c = line((2 + DX, DY, 0), (3, 0, 0))\n";
    keeps_counts(&format!(
        "units m\n{links}modeling curve all = a + b + c\nsurface s = extrude(all, by: (0, 0, 2))\nmesh m of s {{ size: 1m  on all {{ count: 10 }} }}\n"
    ));
    let halves = "let P = (2 + DX, DY, 0)\ncurve a = line((0, 0, 0), P)\ncurve b = line(P, (4, 0, 0))\nmodeling curve south = a + b\n\
                  curve north = line((0, 3, 0), (4, 3, 0))\nsurface s = ruled(south, north)\n";
    keeps_counts(&format!("units m\n{halves}mesh m of s {{ size: 500mm }}\n"));
    let south = "curve a = line((0, 0, 0), (2 + DX, DY, 0))\ncurve b = line((2 + DX, DY, 0), (4, 0, 0))\n";
    let faces = "curve low = line((0, -2, 0), (2, -2, 0))\ncurve other = line((2, -2, 0), (4, -2, 0))\ncurve north = line((0, 3, 0), (4, 3, 0))\n\
                 surface p = ruled(a, low)\nsurface q = ruled(b, other)\ncurve whole = line((0, 0, 0), (4, 0, 0))\nsurface r = ruled(whole, north)\n";
    keeps_counts(&format!(
        "units m\n{south}{faces}mesh m of p, q {{ size: 500mm }}\nmesh n of r {{ size: 500mm  on north {{ count: 9 }} }}\n"
    ));
}

/// Random numbers from 0 to 1, the same in every run.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// Largest turn of the normal over the cells of a mapped face, at places between nodes too.
fn turn(mesh: &Mesh) -> f64 {
    let mut most = 0.0_f64;
    for geometry in &mesh.geometries.0 {
        let FaceNodes::Grid(grid, _) = &geometry.nodes else { panic!("not mapped") };
        let (nu, nv) = grid.size();
        for (i, j) in (0..nv).flat_map(|j| (0..nu).map(move |i| (i, j))) {
            let (a, c) = (grid.uv(i, j), grid.uv(i + 1, j + 1));
            let share = |k: usize| 0.001 + 0.998 * k as f64 / 4.0;
            let normal = |k: usize| {
                let (x, y) = (share(k % 5), share(k / 5));
                geometry.surface.normal(a.0 + (c.0 - a.0) * x, a.1 + (c.1 - a.1) * y)
            };
            let all: Vec<DVec3> = (0..25).map(normal).collect();
            let pairs = (0..25).flat_map(|i| (0..i).map(move |j| (i, j)));
            most = pairs.map(|(i, j)| all[i].angle_between(all[j])).fold(most, f64::max);
        }
    }
    most
}

/// Steps along a profile that is extruded: half the triangles of a mesh of one row.
fn steps_of(profile: &str, limit: &str) -> (usize, Arc<Mesh>) {
    let text = format!("units m\n{profile}surface s = extrude(p, by: (0, 0, 20))\nmesh m of s {{ size: 100m  {limit}  method: mapped }}\n");
    let mesh = meshes(&text).remove(0);
    (mesh.triangles.len() / 2, mesh)
}

#[test]
fn a_chain_of_kinked_arcs_takes_the_steps_of_its_arcs() {
    // Nine waves of two arcs: where one ends the next begins in another direction, and rounding must not count that as a turn.
    for height in [0.04_f64, 0.015, 0.09] {
        let arc = |i: usize| {
            let (a, z) = (0.2 * i as f64, if i.is_multiple_of(2) { height } else { -height });
            format!("curve a{i} = arc(({a:.1}, 0, 0), ({:.1}, 0, 0), through: ({:.1}, {z}, 0))\n", a + 0.2, a + 0.1)
        };
        let names: Vec<String> = (0..18).map(|i| format!("a{i}")).collect();
        let profile = (0..18).map(arc).collect::<String>() + &format!("modeling curve p = {}\n", names.join(" + "));
        let radius = (0.01 + height * height) / (2.0 * height);
        let whole = 2.0 * (0.1 / radius).asin().to_degrees();
        for limit in [2.0, 5.0, 9.7, 15.5, 20.0, 33.0, 60.0] {
            let (steps, _) = steps_of(&profile, &format!("angle_error: {limit}deg"));
            assert_eq!(steps, 18 * (whole / limit).ceil() as usize, "{height} {limit}");
        }
    }
}

#[test]
fn looser_limits_never_take_more_steps_along_a_curve() {
    // Where uneven rows become even again there may be twice as many.
    let even = |limit: &str| format!("{limit}  on p {{ bias: 1 }}");
    let mut state = 3;
    for case in 0..2 {
        let waves = 2 + 2 * case;
        let at = |k: usize, state: &mut u64| format!("({:.4}, {:.4}, 0)", k as f64 * 0.5, random(state) * 1.2);
        let points: Vec<String> = (0..2 * waves).map(|k| at(k, &mut state)).collect();
        let profile = format!("curve p = spline([{}])\n", points.join(", "));
        let mut before = usize::MAX;
        for limit in [12.0, 15.5, 20.0, 27.0, 40.0, 61.0, 90.0_f64] {
            let (steps, mesh) = steps_of(&profile, &even(&format!("angle_error: {limit}deg")));
            assert!(steps <= before, "{profile}{limit}°: {steps} after {before}");
            before = steps;
            assert!(turn(&mesh) <= limit.to_radians() * 1.0001, "{profile}{limit}°: {}", turn(&mesh).to_degrees());
            // Even steps over samples of the tangent.
            let geometry = &mesh.geometries.0[0];
            let jets: Vec<(DVec3, DVec3)> = (0..=1000)
                .map(|k| f64::from(k) / 1000.0)
                .map(|v| (geometry.surface.point(0.0, v), geometry.surface.normal(0.5, v)))
                .collect();
            let mut run = vec![0.0];
            jets.windows(2).for_each(|w| run.push(run[run.len() - 1] + w[0].0.distance(w[1].0)));
            let keeps = |n: usize| {
                (0..n).all(|k| {
                    let place = |k: usize| run.partition_point(|s| *s < run[run.len() - 1] * k as f64 / n as f64).min(run.len() - 1);
                    let own = &jets[place(k)..=place(k + 1)];
                    let far = |from: DVec3| own.iter().map(|j| j.1).min_by(|a, b| from.dot(*a).total_cmp(&from.dot(*b))).unwrap();
                    let a = far(own[0].1);
                    a.angle_between(far(a)) <= limit.to_radians()
                })
            };
            let best = (1..).find(|n| keeps(*n)).unwrap();
            assert!(steps as f64 <= 1.5 * best as f64 + 1.0, "{profile}{limit}°: {steps} where {best} do");
        }
        let mut before = usize::MAX;
        for limit in [2.0, 4.0, 7.0, 11.0, 20.0, 35.0, 60.0, 200.0] {
            let (steps, _) = steps_of(&profile, &even(&format!("chord_error: {limit}mm")));
            assert!(steps <= before, "{profile}{limit} mm: {steps} after {before}");
            before = steps;
        }
    }
}

#[test]
fn looser_limits_never_take_more_elements_of_a_mapped_face() {
    let mut state = 11;
    for _ in 0..3 {
        let row = |j: usize, state: &mut u64| {
            let one: Vec<String> = (0..7).map(|i| format!("({i}, {j}, {:.3})", random(state) * 0.8)).collect();
            format!("[{}]", one.join(", "))
        };
        let rows: Vec<String> = (0..6).map(|j| row(j, &mut state)).collect();
        let surface = format!("units m\nsurface s = grid([{}])\n", rows.join(", "));
        for (setting, unit, limits) in
            [("angle_error", "deg", [8.0, 11.0, 15.5, 20.0, 30.0, 45.0]), ("chord_error", "mm", [12.0, 20.0, 40.0, 80.0, 150.0, 300.0])]
        {
            let mut before = usize::MAX;
            for limit in limits {
                let text = format!("{surface}mesh m of s {{ size: 100m  {setting}: {limit}{unit}  method: mapped }}\n");
                let mesh = meshes(&text).remove(0);
                let count = mesh.triangles.len();
                assert!(count <= before, "{text}{count} after {before}");
                before = count;
                if unit == "deg" {
                    assert!(turn(&mesh) <= f64::to_radians(limit) * 1.05, "{text}{}", turn(&mesh).to_degrees());
                }
            }
        }
    }
}

#[test]
fn every_pair_of_places_of_a_cell_keeps_the_angle() {
    // a x² + b y² + t x y: the normals are farthest apart between two corners, neither of them the first or the farthest from it.
    let mut state = 5;
    for case in 0..8 {
        let mut of = |least: f64, most: f64| least + (most - least) * random(&mut state);
        let (a, b, t) = if case == 0 { (0.2, 0.2, -0.08) } else { (of(0.1, 0.3), of(0.1, 0.3), of(-0.15, 0.15)) };
        let pole = |x: f64, y: f64| format!("({x}, {y}, {:.6})", a * x.floor() + b * y.floor() + t * x * y);
        let row = |x: f64| format!("[{}, {}, {}]", pole(x, 0.0), pole(x, 0.5), pole(x, 1.0));
        let surface = format!("surface s = bezier_surface([{}, {}, {}])\n", row(0.0), row(0.5), row(1.0));
        for limit in [1.0, 2.0, 5.0, 9.0] {
            let text = format!("units m\n{surface}mesh m of s {{ size: 10m  angle_error: {limit}deg  method: mapped  elements: quads }}\n");
            let mesh = meshes(&text).remove(0);
            assert!(turn(&mesh) <= f64::to_radians(limit) * 1.002, "{text}{}", turn(&mesh).to_degrees());
        }
    }
}
