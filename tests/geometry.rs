//! Curves against numbers computed elsewhere.

use std::path::Path;

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::geometry::{Curve, Ends, Kind, Spline, build};
use serde_json::Value;

fn data(path: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(path);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A number, also one written as text with more digits than a double has.
fn number(value: &Value) -> f64 {
    value.as_str().map_or_else(|| value.as_f64().unwrap(), |s| s.parse().unwrap())
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

fn point(value: &Value) -> DVec3 {
    let c = numbers(value);
    DVec3::new(c[0], c[1], c.get(2).copied().unwrap_or(0.0))
}

fn points(value: &Value) -> Vec<DVec3> {
    value.as_array().unwrap().iter().map(point).collect()
}

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let ratio = (found - expected).abs() / (tolerance * expected.abs().max(1.0));
    assert!(ratio <= 1.0, "{what}: {found} instead of {expected}, {ratio} times the tolerance");
}

fn polynomial(coefficients: &[[f64; 4]; 2], t0: f64, t1: f64) -> Curve {
    // Bézier points of a cubic in x and y by blossoming its monomials.
    let blossom = |c: &[f64; 4], t: [f64; 3]| {
        c[0] + c[1] * (t[0] + t[1] + t[2]) / 3.0 + c[2] * (t[0] * t[1] + t[1] * t[2] + t[0] * t[2]) / 3.0 + c[3] * t[0] * t[1] * t[2]
    };
    let poles: Vec<DVec3> = (0..4)
        .map(|i| {
            let t = std::array::from_fn(|j| if j < i { t1 } else { t0 });
            DVec3::new(blossom(&coefficients[0], t), blossom(&coefficients[1], t), 0.0)
        })
        .collect();
    let knots = [t0, t0, t0, t0, t1, t1, t1, t1];
    build::bspline(&poles, 3, Some(&knots), false, Origin::NONE).unwrap()
}

/// The curve of an entry and the map from its parameter there to ours.
fn reference_curve(entry: &Value) -> Curve {
    let definition = &entry["definition"];
    let (none, zero) = (Origin::NONE, DVec3::ZERO);
    let poles = || points(&definition["control_points"]);
    match (entry["id"].as_str().unwrap(), definition["type"].as_str().unwrap()) {
        ("parabola", _) => polynomial(&[[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]], 0.0, 1.0),
        ("semicubical_cusp", _) => polynomial(&[[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]], -1.0, 1.0),
        ("quarter_ellipse", _) => build::ellipse(zero, DVec3::X * 2.0, DVec3::Y, 0.0, std::f64::consts::FRAC_PI_2, none).unwrap(),
        ("helix", _) => build::helix(zero, DVec3::Z, DVec3::X * 2.0, std::f64::consts::PI, 2.0, none).unwrap(),
        (_, "bezier") => build::bezier(&poles(), None, none).unwrap(),
        (_, "nurbs" | "bspline") => {
            let degree = definition["degree"].as_u64().unwrap() as usize;
            let knots = numbers(&definition["knots"]);
            match definition.get("weights") {
                Some(weights) => build::nurbs(&poles(), &numbers(weights), &knots, degree, none).unwrap(),
                None => build::bspline(&poles(), degree, Some(&knots), false, none).unwrap(),
            }
        }
        other => panic!("no such curve: {other:?} {definition}"),
    }
}

#[test]
fn arc_lengths_and_their_inverse() {
    let file = data("reference/arc_length.json");
    let curves = file["curves"].as_array().unwrap();
    assert_eq!(curves.len(), 9);
    for entry in curves {
        let id = entry["id"].as_str().unwrap();
        let curve = reference_curve(entry);
        close(curve.length(), number(&entry["length"]), 1e-12, id);
        for inverse in entry["inverse"].as_array().unwrap() {
            let s = number(&inverse["s"]);
            let t = curve.param_at_length(s * curve.length());
            let label = format!("{id} at {s}");
            close(t, number(&inverse["u"]), 1e-12, &label);
            assert!(curve.point(t).distance(point(&inverse["point"])) < 1e-12 * curve.length(), "{label}");
            close(curve.length_at(t), s * curve.length(), 1e-12, &label);
        }
    }
}

#[test]
fn spline_with_given_tangents() {
    let fit = &data("reference/nub_fit.json")["curve_fit"];
    let tangents = points(&fit["unit_end_tangents"]);
    let settings = Spline { start: Ends::Clamped(tangents[0] * 3.0), end: Ends::Clamped(tangents[1]), closed: false };
    let curve = build::spline(&points(&fit["data"]), &settings, Origin::NONE).unwrap();
    let nurbs = curve.to_nurbs(&lofting::base::tolerance::Tolerance::new(1e-6, 10.0)).unwrap();
    for (found, expected) in nurbs.knots.iter().zip(numbers(&fit["knots"])) {
        close(*found, expected, 1e-12, "knot");
    }
    let poles = points(&fit["control_points"]);
    assert_eq!(nurbs.poles.len(), poles.len());
    for (i, expected) in poles.iter().enumerate() {
        assert!(nurbs.pole(i).distance(*expected) < 1e-12, "pole {i}");
    }
    for sample in fit["samples"].as_array().unwrap() {
        assert!(curve.point(number(&sample["t"])).distance(point(&sample["point"])) < 1e-12);
    }
    close(curve.length(), number(&fit["arc_length"]), 1e-12, "length");
}

#[test]
fn arc_rule() {
    let example = &data("reference/sweep.json")["arc_rule"]["example"];
    let angle = number(&example["theta_deg"]).to_radians();
    let curve = build::arc_center(DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 2.0, 3.0), angle, DVec3::Z, Origin::NONE).unwrap();
    assert_eq!(curve.kind(), Kind::Arc);
    let nurbs = curve.to_nurbs(&lofting::base::tolerance::Tolerance::new(1e-6, 10.0)).unwrap();
    assert_eq!(nurbs.poles.len(), 2 * example["n"].as_u64().unwrap() as usize + 1);
    close(nurbs.poles[1].w, number(&example["weight"]), 1e-15, "weight");
    close(nurbs.pole(1).distance(DVec3::new(1.0, 2.0, 3.0)) / 3.0, number(&example["middle_radius_factor"]), 1e-15, "factor");
    for i in 0..=100 {
        let t = angle * f64::from(i) / 100.0;
        assert!((nurbs.jet(t).p.distance(DVec3::new(1.0, 2.0, 3.0)) - 3.0).abs() < 1e-14);
    }
}

#[test]
fn a_link_of_the_helix() {
    let maps = data("reference/parameter_maps.json");
    let link = &maps["link_of_curve"];
    let curves = data("reference/arc_length.json");
    let helix = curves["curves"].as_array().unwrap().iter().find(|c| c["id"] == "helix").map(reference_curve).unwrap();
    let at = helix.point(helix.param_at_length(number(&link["curve_s"]) * helix.length()));
    assert!(at.distance(point(&link["point"])) < 1e-12);
    let lengths: Vec<f64> = maps["modeling_curve_chain"]["links"].as_array().unwrap().iter().map(|l| number(&l["length"])).collect();
    let arc = build::arc_center(DVec3::new(3.0, 2.0, 0.0), DVec3::new(5.0, 2.0, 0.0), -std::f64::consts::FRAC_PI_2, DVec3::Z, Origin::NONE);
    let arc = arc.unwrap();
    close(arc.length(), lengths[1], 1e-14, "arc");
    assert!(arc.end().distance(DVec3::new(3.0, 0.0, 0.0)) < 1e-15);
}
