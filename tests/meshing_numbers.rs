//! The numbers of the reference notes on meshing (§14.2, §14.3, §14.5, §14.7): what weak methods miss is found here.

#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a test fails by panicking")]

#[path = "support/reference.rs"]
mod reference;

use std::sync::Arc;

use glam::{DVec2, DVec3};
use lofting::base::job::Job;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::build::line;
use lofting::mesh::Mesh;
use lofting::mesh::free::ground::{Even, Ground, Spot};
use lofting::mesh::free::quads::net::Net;
use lofting::mesh::free::quads::smooth::Smoother;
use lofting::network::Chain;
use lofting::session::live::{Depth, Live};
use lofting::surface::{closest, plane, polynomial, trim};
use reference::reference;
use serde_json::Value;

/// The plane z = 0.
struct Flat;

impl Ground for Flat {
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
    let outcome = live.run((text, &[]), Depth::Report, &Job::new(), &mut |_| {}).unwrap();
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
    Smoother::new(&mut net, &Flat, &Even(1.0)).smooth(1, &Job::new()).unwrap();
    assert!(net.p[middle].distance(point(&fact["new_position"])) < 1e-12, "{}", net.p[middle]);
}
