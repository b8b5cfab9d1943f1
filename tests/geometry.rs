//! Curves against numbers computed elsewhere, and against properties that hold for all of them.

use std::path::Path;

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::geometry::construct::build;
use lofting::geometry::construct::fit_curve::Fit;
use lofting::geometry::{Curve, Ends, Kind, Spline};
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
    let how = Fit { start: Some(Ends::Clamped(tangents[0])), end: Some(Ends::Clamped(tangents[1])), ..Fit::default() };
    let met = lofting::geometry::construct::fit_curve::fit(&points(&fit["data"]), &how, Origin::NONE).unwrap();
    let nurbs = met.to_nurbs(&lofting::base::tolerance::Tolerance::new(1e-6, 10.0)).unwrap();
    for (i, expected) in poles.iter().enumerate() {
        assert!(nurbs.pole(i).distance(*expected) < 1e-12, "pole {i} of a fit");
    }
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

/// The length that SciPy's adaptive quadrature gives for its own natural spline through the same points.
#[test]
fn length_of_a_spline_elsewhere() {
    use lofting::base::math::{cos, sin};
    let points: Vec<DVec3> = (0..40)
        .map(|i| {
            let a = 1.8 * std::f64::consts::PI * f64::from(i) / 39.0;
            DVec3::new(50.0 + 40.0 * cos(a) * (1.0 + 0.2 * cos(5.0 * a)), 50.0 + 40.0 * sin(a), 10.0 * sin(3.0 * a))
        })
        .collect();
    let curve = build::spline(&points, &Spline { start: Ends::Natural, end: Ends::Natural, closed: false }, Origin::NONE).unwrap();
    close(curve.length(), 270.145_192_417_000_7, 1e-12, "length");
    let (mut params, lengths) = (Vec::new(), [200.0, 10.0, -1.0, 10.5, 300.0]);
    curve.params_at_lengths(&lengths, &mut params);
    for (t, s) in params.iter().zip(lengths) {
        assert_eq!(*t, curve.param_at_length(s));
        close(curve.length_at(*t), s.clamp(0.0, curve.length()), 1e-12, "inverse");
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

mod meetings {
    use super::*;
    use lofting::base::tolerance::Tolerance;
    use lofting::geometry::{Hit, intersect, self_intersect};

    const TOLERANCE: f64 = 1e-6;

    fn tolerance() -> Tolerance {
        Tolerance::new(TOLERANCE, 10.0)
    }

    fn at(x: f64, y: f64) -> DVec3 {
        DVec3::new(x, y, 0.0)
    }

    fn line(a: (f64, f64), b: (f64, f64)) -> Curve {
        build::line(at(a.0, a.1), at(b.0, b.1), Origin::NONE).unwrap()
    }

    fn circle(x: f64, y: f64, r: f64) -> Curve {
        build::circle(at(x, y), r, DVec3::Z, Origin::NONE).unwrap()
    }

    fn arc(center: (f64, f64), start: (f64, f64), degrees: f64) -> Curve {
        build::arc_center(at(center.0, center.1), at(start.0, start.1), degrees.to_radians(), DVec3::Z, Origin::NONE).unwrap()
    }

    fn polyline(points: &[(f64, f64)], closed: bool) -> Curve {
        let points: Vec<DVec3> = points.iter().map(|p| at(p.0, p.1)).collect();
        build::polyline(&points, closed, Origin::NONE).unwrap()
    }

    fn spline(points: &[(f64, f64)]) -> Curve {
        let points: Vec<DVec3> = points.iter().map(|p| at(p.0, p.1)).collect();
        build::spline(&points, &Spline { start: Ends::Natural, end: Ends::Natural, closed: false }, Origin::NONE).unwrap()
    }

    /// Points (t = tangent) and stretches in short, each checked against the curves.
    fn describe(a: &Curve, b: &Curve, hits: &[Hit]) -> String {
        let mut out = Vec::new();
        for hit in hits {
            match *hit {
                Hit::Point { ta, tb, at, gap, tangent } => {
                    assert!(gap <= TOLERANCE && a.point(ta).distance(b.point(tb)) <= TOLERANCE * 1.001, "{hit:?}");
                    assert!(at.distance(a.point(ta)) <= TOLERANCE && at.distance(b.point(tb)) <= TOLERANCE);
                    out.push(if tangent { "touch" } else { "cross" });
                }
                Hit::Overlap { a: (a0, a1), b: (b0, b1) } => {
                    assert!(a0 < a1);
                    assert!(a.point(a0).distance(b.point(b0)) <= TOLERANCE && a.point(a1).distance(b.point(b1)) <= TOLERANCE, "{hit:?}");
                    out.push(if b0 < b1 { "along" } else { "against" });
                }
            }
        }
        out.join(" ")
    }

    fn check(a: &Curve, b: &Curve, expected: &str) {
        let hits = intersect(a, b, &tolerance()).unwrap();
        assert_eq!(describe(a, b, &hits), expected, "{hits:?}");
        let back = intersect(b, a, &tolerance()).unwrap();
        assert_eq!(back.len(), hits.len(), "the other way round: {back:?}");
        let _ = describe(b, a, &back);
    }

    #[test]
    fn lines() {
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.5, 0.5), (0.5, -1.5)), "cross");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.5, 0.5), (0.5, 1e-5)), "");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.5, 0.5), (0.5, 9e-7)), "cross");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((2.0, 0.0), (3.0, 1.0)), "cross");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((2.0, 0.0), (3.0, 0.0)), "touch");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((1.0, 0.0), (3.0, 0.0)), "along");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((3.0, 0.0), (1.0, 0.0)), "against");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.5, 0.0), (1.0, 0.0)), "along");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.0, 0.0), (2.0, 0.0)), "along");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.0, 1e-5), (2.0, 1e-5)), "");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.0, -1e-3), (2.0, 1e-3)), "cross");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.0, -1e-5), (2.0, 1e-5)), "cross");
        check(&line((0.0, 0.0), (2.0, 0.0)), &line((0.0, -1e-7), (2.0, 1e-7)), "along");
    }

    #[test]
    fn overlap_ends_are_exact() {
        let (a, b) = (line((0.0, 0.0), (2.0, 0.0)), line((3.0, 0.0), (0.5, 0.0)));
        let hits = intersect(&a, &b, &tolerance()).unwrap();
        let [Hit::Overlap { a: (a0, a1), b: (b0, b1) }] = hits[..] else { panic!("{hits:?}") };
        assert!((a0 - 0.25).abs() < 1e-14 && a1 == 1.0 && b0 == 1.0 && (b1 - 0.4).abs() < 1e-14, "{hits:?}");
    }

    #[test]
    fn circles_and_tangents() {
        let c = circle(0.0, 0.0, 1.0);
        check(&c, &line((-2.0, 0.5), (2.0, 0.5)), "cross cross");
        check(&c, &line((-2.0, 1.0), (2.0, 1.0)), "touch");
        check(&c, &line((-2.0, 1.0 - 1e-9), (2.0, 1.0 - 1e-9)), "cross cross");
        check(&c, &line((-2.0, 1.0 + 1e-5), (2.0, 1.0 + 1e-5)), "");
        check(&c, &line((-2.0, 1.0 + 5e-7), (2.0, 1.0 + 5e-7)), "touch");
        check(&c, &line((1.0, -2.0), (1.0, 2.0)), "touch");
        check(&c, &circle(2.0, 0.0, 1.0), "touch");
        check(&c, &circle(0.5, 0.0, 0.5), "touch");
        check(&c, &circle(1.0, 0.0, 1.0), "cross cross");
        check(&c, &circle(0.0, 0.0, 0.9), "");
        check(&c, &circle(0.0, 0.0, 1.0), "along");
        check(&c, &c.reversed(), "against");
        check(&c, &arc((0.0, 0.0), (0.0, 1.0), 90.0), "along");
        check(&arc((0.0, 0.0), (1.0, 0.0), 120.0), &arc((0.0, 0.0), (0.0, 1.0), 120.0), "along");
        check(&arc((0.0, 0.0), (1.0, 0.0), 90.0), &arc((0.0, 0.0), (0.0, 1.0), 90.0), "touch");
        // A fillet that leaves its line smoothly, and one that comes back over it.
        check(&line((0.0, 0.0), (1.0, 0.0)), &arc((1.0, 1.0), (1.0, 0.0), 90.0), "touch");
        check(&line((0.0, 0.0), (3.0, 0.0)), &arc((1.0, 1.0), (1.0, 0.0), 90.0), "touch");
    }

    #[test]
    fn splines_share_pieces() {
        let whole = spline(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 1.0), (4.0, 0.5)]);
        let (a, b) = whole.domain();
        let at = |f: f64| a + (b - a) * f;
        check(&whole, &whole.part(at(0.2), at(0.7)), "along");
        check(&whole.part(a, at(0.6)), &whole.part(at(0.3), b).reversed(), "against");
        check(&whole.part(a, at(0.5)), &whole.part(at(0.5), b), "touch");
        check(&whole, &line((-1.0, 0.5), (5.0, 0.5)), "cross cross cross cross");
        let other = spline(&[(0.0, 1.0), (1.0, 0.0), (2.0, 1.0), (3.0, 0.0), (4.0, 0.5)]);
        check(&whole, &other, "cross cross cross cross");
    }

    #[test]
    fn corners_meet_once() {
        let path = polyline(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 0.0), (4.0, 1.0)], false);
        check(&path, &line((1.0, -1.0), (1.0, 3.0)), "cross");
        check(&path, &line((0.0, 1.0), (2.0, 1.0)), "cross");
        check(&path, &line((-1.0, 0.0), (5.0, 0.0)), "cross along");
        let square = polyline(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], true);
        check(&square, &line((0.0, -1.0), (0.0, 2.0)), "against");
        check(&square, &line((-1.0, -1.0), (2.0, 2.0)), "cross cross");
        check(&square, &square.reversed(), "against");
    }

    #[test]
    fn curves_meet_themselves() {
        let check = |curve: &Curve, expected: &str| {
            let hits = self_intersect(curve, &tolerance()).unwrap();
            assert_eq!(describe(curve, curve, &hits), expected, "{hits:?}");
        };
        check(&line((0.0, 0.0), (1.0, 0.0)), "");
        check(&circle(0.0, 0.0, 1.0), "");
        check(&polyline(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], true), "");
        check(&polyline(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)], false), "cross");
        let loop_ = build::bezier(&[at(0.0, 0.0), at(3.0, 2.0), at(-2.0, 2.0), at(1.0, 0.0)], None, Origin::NONE).unwrap();
        check(&loop_, "cross");
        check(&spline(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 1.0), (4.0, 0.5)]), "");
        check(&polyline(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.0)], false), "against");
        let helix = build::helix(DVec3::ZERO, DVec3::Z, DVec3::X, 0.5, 4.0, Origin::NONE).unwrap();
        check(&helix, "");
        // A stretch of one point has no direction anywhere, however finely it is cut.
        let mut poles = vec![at(0.0, 0.0), at(1.0, 1.0)];
        poles.extend([at(2.0, 0.3); 5]);
        poles.extend([at(3.0, 1.0), at(4.0, 0.0)]);
        let rests = build::bspline(&poles, 3, None, false, Origin::NONE).unwrap();
        assert_eq!(self_intersect(&rests, &tolerance()).map(|hits| hits.len()).unwrap_or(0), 0);
    }

    #[test]
    fn space_curves() {
        let helix = build::helix(DVec3::ZERO, DVec3::Z, DVec3::X, 1.0, 3.0, Origin::NONE).unwrap();
        let upright = build::line(DVec3::new(0.0, 1.0, -1.0), DVec3::new(0.0, 1.0, 5.0), Origin::NONE).unwrap();
        check(&helix, &upright, "cross cross cross");
        let aside = build::line(DVec3::new(1e-5, 1.0, -1.0), DVec3::new(1e-5, 1.0, 5.0), Origin::NONE).unwrap();
        check(&helix, &aside, "cross cross cross");
        let outside = build::line(DVec3::new(0.0, 1.00001, -1.0), DVec3::new(0.0, 1.00001, 5.0), Origin::NONE).unwrap();
        check(&helix, &outside, "");
    }
}

/// Facts found in the tests of the libraries verb and curvo; `data/peer-facts/README.md` tells more.
mod facts {
    use super::*;
    use lofting::base::tolerance::Tolerance;
    use lofting::geometry::{Hit, Motion, intersect};

    fn curve(value: &Value) -> Curve {
        if value["kind"].is_string() {
            let mut points = points(&value["points"]);
            if value["kind"].as_str().unwrap().starts_with("periodic") {
                points.push(points[0]);
                return centripetal(&points);
            }
            let path = build::polyline(&points, false, Origin::NONE).unwrap();
            let turn = Motion::rotation(DVec3::ZERO, DVec3::Z, number(&value["rotate_radians"]));
            return path.moved(&turn.then(&Motion::translation(point(&value["then_translate"]))));
        }
        let (poles, degree) = (points(&value["poles"]), value["degree"].as_u64().unwrap() as usize);
        build::bspline(&poles, degree, Some(&numbers(&value["knots"])), false, Origin::NONE).unwrap()
    }

    /// The periodic C2 cubic with spans √|ΔP|; ours has |ΔP| and bulges further, past the corner of the second curve.
    fn centripetal(points: &[DVec3]) -> Curve {
        let spans: Vec<f64> = points.windows(2).map(|p| p[0].distance(p[1]).sqrt()).collect();
        let slopes = lofting::geometry::construct::spline::periodic_slopes(points, &spans);
        let pieces: Vec<Curve> = (0..spans.len())
            .map(|i| {
                let (from, to, h) = (points[i], points[i + 1], spans[i] / 3.0);
                build::bezier(&[from, from + slopes[i] * h, to - slopes[i + 1] * h, to], None, Origin::NONE).unwrap()
            })
            .collect();
        build::composite(&pieces, Origin::NONE).unwrap()
    }

    #[test]
    fn hold_where_they_touch_curves() {
        let tolerance = Tolerance::new(1e-6, 10.0);
        let mut counted = 0;
        for fact in data("peer-facts/facts.json").as_array().unwrap() {
            let label = fact["source"].as_str().unwrap();
            let within = fact["tol"].as_f64().unwrap_or(1e-6);
            match fact["op"].as_str().unwrap() {
                "length" => close(curve(&fact["curve"]).length(), number(&fact["expect"]), within, label),
                "point_at_arc_length" => {
                    let c = curve(&fact["curve"]);
                    let found = c.point(c.param_at_length(number(&fact["length"])));
                    assert!(found.distance(point(&fact["expect"])) < 1e-12, "{label}");
                }
                "divide_equal_arc" => {
                    let expected = numbers(&fact["expect_x"]);
                    let found = curve(&fact["curve"]).points_along(expected.len());
                    for (p, x) in found.iter().zip(&expected) {
                        close(p.x, *x, 1e-12, label);
                    }
                    assert_eq!(found.len(), fact["n"].as_u64().unwrap() as usize + 1);
                }
                "intersect" | "intersect_count" => {
                    let hits = intersect(&curve(&fact["a"]), &curve(&fact["b"]), &tolerance).unwrap();
                    assert_eq!(hits.len(), fact["expect_count"].as_u64().unwrap() as usize, "{label}: {hits:?}");
                    let expected = fact["expect"].as_array().map(|all| numbers(&all[0]));
                    if let (Some(expected), Hit::Point { ta, tb, .. }) = (expected, hits[0]) {
                        close(ta, expected[0], 1e-9, label);
                        close(tb, expected[1], 1e-9, label);
                    }
                }
                // Surfaces have their own tests.
                "closest_on_surface" | "intersect_curve_surface" => continue,
                other => panic!("{other}"),
            }
            counted += 1;
        }
        assert_eq!(counted, 11);
    }
}

mod properties {
    use super::*;
    use lofting::base::predicates::orient;
    use lofting::base::tolerance::Tolerance;
    use lofting::geometry::{Hit, Motion, intersect};
    use proptest::prelude::*;
    use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

    /// Runs a property on the same random cases every time.
    fn run<S: Strategy>(cases: u32, strategy: S, check: impl Fn(S::Value)) {
        let config = Config { cases, failure_persistence: None, ..Config::default() };
        let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
        let result = runner.run(&strategy, |value| {
            check(value);
            Ok(())
        });
        result.unwrap();
    }

    fn made(kind: usize, x: &[f64], plane: bool) -> Curve {
        let p = |i: usize| DVec3::new(x[3 * i], x[3 * i + 1], if plane { 0.0 } else { x[3 * i + 2] });
        let some: Vec<DVec3> = (0..6).map(p).collect();
        let settings = |closed| Spline { start: Ends::Natural, end: Ends::Clamped(DVec3::X), closed };
        let none = Origin::NONE;
        match kind {
            0 => build::line(p(0), p(1), none),
            1 => build::arc_through(p(0), p(1), p(2), none),
            2 => build::ellipse(p(0), DVec3::X * 0.9, DVec3::Y * (0.2 + x[4].abs()), x[5], 1.0 + 5.0 * x[6].abs(), none),
            3 => build::spline(&some, &settings(false), none),
            4 => build::spline(&some, &settings(true), none),
            5 => build::bezier(&some[..4], None, none),
            6 => build::bezier(&some, Some(&[1.0, 0.7, 1.6, 1.0, 0.9, 1.2]), none),
            7 => build::bspline(&some, 3, None, false, none),
            8 => build::bspline(&some, 2, None, true, none),
            9 => build::polyline(&some, false, none),
            10 => build::conic(p(0), p(1), p(2), 0.3 + 0.3 * x[9].abs(), Kind::Conic, none),
            11 => build::composite(&[made(5, x, plane), build::line(p(3), p(4), none).unwrap()], none),
            _ => build::helix(p(0), DVec3::Z, p(0) + DVec3::X * 0.5, 0.3, 1.0 + x[7].abs(), none),
        }
        .unwrap()
    }

    fn numbers_of(n: usize) -> impl Strategy<Value = Vec<f64>> {
        proptest::collection::vec(-1.0..1.0_f64, n)
    }

    fn any_curve() -> impl Strategy<Value = Curve> {
        (0..13_usize, numbers_of(18)).prop_map(|(kind, x)| made(kind, &x, false))
    }

    fn plane_curve() -> impl Strategy<Value = Curve> {
        (0..12_usize, numbers_of(18)).prop_map(|(kind, x)| made(kind, &x, true))
    }

    fn motion() -> impl Strategy<Value = Motion> {
        (numbers_of(7), -3.0..6.0_f64).prop_map(|(x, size)| {
            let axis = DVec3::new(x[0], x[1], 1.5 + x[2]).normalize();
            let turn = Motion::rotation(DVec3::ONE, axis, 3.0 * x[3]);
            let scale = Motion::scaling(DVec3::ZERO, lofting::base::math::pow(10.0, size));
            turn.then(&Motion::translation(DVec3::new(x[4], x[5], x[6]))).then(&scale)
        })
    }

    #[test]
    fn derivatives_are_difference_quotients() {
        run(60, (any_curve(), 0.01..0.99_f64), |(curve, f)| {
            let (a, b) = curve.domain();
            let (t, h) = (a + (b - a) * f, 1e-6 * (b - a));
            if curve.knots().iter().any(|k| (k - t).abs() < 2.0 * h) {
                return;
            }
            let (before, here, after) = (curve.jet(t - h), curve.jet(t), curve.jet(t + h));
            assert!(((after.p - before.p) / (2.0 * h)).distance(here.d1) < 1e-6 * (1.0 + here.d1.length() + here.d2.length()));
            assert!(((after.d1 - before.d1) / (2.0 * h)).distance(here.d2) < 1e-3 * (1.0 + here.d2.length() / (b - a)));
        });
    }

    #[test]
    fn parts_reversal_and_lengths_agree() {
        run(80, (any_curve(), 0.1..0.9_f64, 0.0..1.0_f64), |(curve, cut, f)| {
            let (a, b) = curve.domain();
            let m = a + (b - a) * cut;
            let (left, right) = (curve.part(a, m), curve.part(m, b));
            let length = curve.length();
            assert!((left.length() + right.length() - length).abs() < 1e-11 * length);
            assert!((curve.length_at(m) - left.length()).abs() < 1e-11 * length);
            let both = build::composite(&[left, right], Origin::NONE).unwrap();
            let back = curve.reversed();
            let s = f * length;
            let p = curve.point(curve.param_at_length(s));
            assert!((curve.length_at(curve.param_at_length(s)) - s).abs() < 1e-12 * length);
            assert!(both.point(both.param_at_length(s)).distance(p) < 1e-10);
            assert!(back.point(back.param_at_length(length - s)).distance(p) < 1e-10);
            assert!(back.reversed().point(m).distance(curve.point(m)) < 1e-12);
            assert!(back.start().distance(curve.end()) < 1e-14 && back.end().distance(curve.start()) < 1e-14);
        });
    }

    #[test]
    fn spline_forms_keep_the_points() {
        let tolerance = Tolerance::new(1e-7, 2.0);
        run(40, (any_curve(), 0.0..1.0_f64), |(curve, f)| {
            let nurbs = curve.to_nurbs(&tolerance).unwrap();
            let form = build::nurbs(
                &(0..nurbs.poles.len()).map(|i| nurbs.pole(i)).collect::<Vec<_>>(),
                &nurbs.poles.iter().map(|q| q.w).collect::<Vec<_>>(),
                &nurbs.knots,
                nurbs.degree,
                Origin::NONE,
            )
            .unwrap();
            let p = form.point(form.domain().0 + (form.domain().1 - form.domain().0) * f);
            assert!(lofting::geometry::closest(&curve, p).distance < 1e-7);
            let (bounds, slack) = (curve.bbox(), DVec3::splat(1e-7));
            assert!((bounds.min - slack).cmple(p).all() && p.cmple(bounds.max + slack).all(), "{p} outside {bounds:?}");
            if matches!(curve.kind(), Kind::Arc | Kind::Ellipse) {
                let exact = lofting::base::bbox::Box3::of(curve.points_along(4000));
                assert!((exact.min - bounds.min).abs().max_element() < 1e-5 && (exact.max - bounds.max).abs().max_element() < 1e-5);
            }
        });
    }

    fn places(hits: &[Hit], a: &Curve) -> Vec<DVec3> {
        let mut all: Vec<DVec3> = hits
            .iter()
            .flat_map(|hit| match *hit {
                Hit::Point { at, .. } => vec![at],
                Hit::Overlap { a: (from, to), .. } => vec![a.point(from), a.point(to)],
            })
            .collect();
        all.sort_by(|p, q| lofting::base::math::compare_points(*p, *q));
        all
    }

    #[test]
    fn motions_and_scales_commute() {
        let tolerance = Tolerance::new(1e-6, 3.0);
        run(80, (plane_curve(), plane_curve(), motion()), |(a, b, motion)| {
            let scale = motion.scale();
            let (moved_a, moved_b) = (a.moved(&motion), b.moved(&motion));
            assert!((moved_a.length() - a.length() * scale).abs() < 1e-11 * moved_a.length());
            let here = intersect(&a, &b, &tolerance).unwrap();
            let there = intersect(&moved_a, &moved_b, &Tolerance::new(1e-6 * scale, 3.0 * scale)).unwrap();
            assert_eq!(here.len(), there.len(), "{here:?} {there:?}");
            for (x, y) in here.iter().zip(&there) {
                let (Hit::Point { ta, tb, .. }, Hit::Point { ta: ua, tb: ub, .. }) = (x, y) else { continue };
                assert!(a.point(*ta).distance(a.point(*ua)) < 1e-8 && b.point(*tb).distance(b.point(*ub)) < 1e-8, "{x:?} {y:?}");
            }
        });
    }

    #[test]
    fn meetings_do_not_depend_on_the_order() {
        let tolerance = Tolerance::new(1e-6, 3.0);
        run(150, (plane_curve(), plane_curve()), |(a, b)| {
            let (there, back) = (intersect(&a, &b, &tolerance).unwrap(), intersect(&b, &a, &tolerance).unwrap());
            let (p, q) = (places(&there, &a), places(&back, &b));
            assert_eq!(p.len(), q.len(), "{there:?} {back:?}");
            assert!(p.iter().zip(&q).all(|(p, q)| p.distance(*q) < 1e-7), "{there:?} {back:?}");
            assert!(there.windows(2).all(|h| h[0].start() <= h[1].start()));
        });
    }

    /// Every proper crossing of two fine polylines is near a meeting, and meetings lie on both curves.
    #[test]
    fn no_crossing_is_missed() {
        let tolerance = Tolerance::new(1e-6, 3.0);
        let sampled = |c: &Curve| {
            let (a, b) = c.domain();
            (0..=400).map(|i| c.point(a + (b - a) * f64::from(i) / 400.0).truncate()).collect::<Vec<_>>()
        };
        run(120, (plane_curve(), plane_curve()), |(a, b)| {
            let hits = intersect(&a, &b, &tolerance).unwrap();
            for hit in &hits {
                if let Hit::Point { ta, tb, gap, .. } = hit {
                    assert!(*gap <= 1e-6 && a.point(*ta).distance(b.point(*tb)) <= 1.001e-6);
                }
            }
            let (p, q) = (sampled(&a), sampled(&b));
            let places = places(&hits, &a);
            for x in p.windows(2) {
                for y in q.windows(2) {
                    let apart = |u: glam::DVec2, v: glam::DVec2, w: &[glam::DVec2]| orient(u, v, w[0]) * orient(u, v, w[1]) < 0.0;
                    if apart(x[0], x[1], y) && apart(y[0], y[1], x) {
                        let near = places.iter().any(|h| h.truncate().distance(x[0]) < 0.05);
                        assert!(near, "a crossing near {} is missed: {hits:?}", x[0]);
                    }
                }
            }
        });
    }
}

/// What each mistake is told as.
mod mistakes {
    use super::*;
    use lofting::base::fault::{Fault, PlainWords};
    use lofting::base::tolerance::Tolerance;

    const NONE: Origin = Origin::NONE;

    fn at(x: f64, y: f64) -> DVec3 {
        DVec3::new(x, y, 0.0)
    }

    fn check<T: std::fmt::Debug>(result: Result<T, Fault>, code: &str, words: &[&str]) {
        let fault = result.unwrap_err();
        let report = fault.describe(&PlainWords);
        assert_eq!(fault.code().0, code, "{report:?}");
        let all = format!("{} {:?} {:?}", report.message, report.help, report.labels);
        for word in words {
            assert!(all.contains(word), "no {word} in {all}");
        }
    }

    #[test]
    fn say_what_and_where() {
        let open = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
        let closed = Spline { closed: true, ..open };
        let three = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)];
        check(build::line(at(1.0, 2.0), at(1.0, 2.0), NONE), "E401", &["no length"]);
        check(build::bezier(&[at(1.0, 2.0); 3], None, NONE), "E401", &[]);
        check(build::spline(&three[..1], &open, NONE), "E402", &["a spline needs at least 2 points, got 1"]);
        check(build::spline(&three[..2], &closed, NONE), "E402", &["a closed spline needs at least 3 points, got 2"]);
        check(
            build::polyline(&[at(0.0, 0.0), three[1], three[1]], false, NONE),
            "E403",
            &["points 1 and 2", "(1.000000", "leave point 2 out"],
        );
        check(
            build::spline(&[three[0], three[1], three[2], three[0]], &closed, NONE),
            "E403",
            &["points 3 and 0", "leave the last point out"],
        );
        check(build::arc_through(at(0.0, 0.0), at(2.0, 0.0), at(1.0, 0.0), NONE), "E404", &["three collinear points", "line((0"]);
        for rho in [0.0, 1.0, -0.2, f64::NAN] {
            check(build::conic(three[0], three[1], three[2], rho, Kind::Conic, NONE), "E405", &["rho"]);
        }
        let knots = |k: &[f64]| build::bspline(&three, 2, Some(k), false, NONE);
        check(knots(&[0.0, 0.0, 0.0, 1.0, 0.5, 1.0]), "E406", &["knot 4", "below the 1 before"]);
        check(knots(&[0.0, 0.0, 0.0, 1.0, 1.0]), "E406", &["3 points of degree 2 need 6 knots, got 5"]);
        check(knots(&[0.0; 6]), "E406", &["the domain of"]);
        check(build::bspline(&three, 1, Some(&[0.0, 0.5, 0.5, 0.5, 1.0]), false, NONE), "E406", &[]);
        let ones = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        check(build::nurbs(&three, &[1.0, -2.0, 1.0], &ones, 2, NONE), "E407", &["weight 1", "-2"]);
        check(build::nurbs(&three, &[1.0, 1.0], &ones, 2, NONE), "E306", &["as many as points, 3"]);
        check(build::line(at(f64::NAN, 0.0), at(1.0, 0.0), NONE), "E408", &["`a`"]);
        check(build::spline(&[three[0], at(0.0, f64::INFINITY)], &open, NONE), "E408", &["number 1 of `points`"]);
        check(build::line(at(1e308, 0.0), at(1.0, 0.0), NONE), "E306", &["`a`", "between -"]);
        check(build::arc_center(three[0], three[1], 1.0, DVec3::ZERO, NONE), "E409", &["normal"]);
        check(build::arc_center(three[0], three[1], 1.0, DVec3::new(1.0, 0.0, 1.0), NONE), "E306", &["normal", "45.0000°"]);
        check(build::spline(&three, &Spline { start: Ends::Clamped(DVec3::ZERO), ..open }, NONE), "E409", &["start"]);
        check(build::helix(three[0], DVec3::Z, DVec3::Z, 1.0, 1.0, NONE), "E409", &["away from the axis"]);
        check(build::arc_center(three[0], three[1], 0.0, DVec3::Z, NONE), "E411", &["angle"]);
        check(build::arc_center(three[0], three[1], 7.0, DVec3::Z, NONE), "E412", &["401.0705°", "360deg"]);
        check(build::circle(three[0], -1.0, DVec3::Z, NONE), "E306", &["radius", "-1"]);
        check(build::bezier(&[at(0.0, 0.0); 27], None, NONE), "E306", &["27", "bspline"]);
    }

    #[test]
    fn checks_with_a_tolerance() {
        let tolerance = Tolerance::new(1e-3, 10.0);
        let short = build::line(at(0.0, 0.0), at(5e-4, 0.0), NONE).unwrap();
        check(short.check(&tolerance), "E401", &["0.000500", "0.001000"]);
        let close = build::polyline(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 5e-4), at(2.0, 0.0)], false, NONE).unwrap();
        check(close.check(&tolerance), "E403", &["points 1 and 2", "0.000500 apart"]);
        close.check(&Tolerance::new(1e-4, 10.0)).unwrap();
    }

    #[test]
    fn whole_turns_are_exact() {
        let circle = build::circle(at(1.0, 0.0), 2.0, DVec3::Z, NONE).unwrap();
        assert_eq!((circle.start(), circle.end()), (at(3.0, 0.0), at(3.0, 0.0)));
        let side = build::circle(at(0.0, 0.0), 2.0, DVec3::X, NONE).unwrap();
        assert_eq!(side.start(), at(0.0, 2.0));
        let square = build::polyline(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)], true, NONE).unwrap();
        assert_eq!(square.kinks(&Tolerance::new(1e-6, 1.0)).len(), 3);
        assert!(circle.kinks(&Tolerance::new(1e-6, 1.0)).is_empty());
        let five: Vec<DVec3> = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 3.0), (0.0, 1.0)].map(|(x, y)| at(x, y)).to_vec();
        for degree in 2..5 {
            let ring = build::bspline(&five, degree, None, true, NONE).unwrap();
            assert!(ring.start().distance(ring.end()) < 1e-14 && ring.kinks(&Tolerance::new(1e-6, 1.0)).is_empty(), "{degree}");
        }
    }
}

/// Points of cubics with few spans are fitted by few spans, near all of them, forwards and backwards alike.
#[test]
fn fits_are_near_their_points_with_few_spans() {
    let spans = |curve: &Curve| curve.knots().len() - 1;
    let far = |curve: &Curve, points: &[DVec3]| points.iter().map(|p| lofting::geometry::closest(curve, *p).distance).fold(0.0, f64::max);
    for (bends, most) in [(1, 2), (2, 5), (4, 11), (8, 22)] {
        let turn = std::f64::consts::PI * f64::from(bends) / 120.0;
        let points: Vec<DVec3> =
            (0..=120).map(|i| DVec3::new(0.1 * f64::from(i), lofting::base::math::sin(turn * f64::from(i)), 0.0)).collect();
        let backwards: Vec<DVec3> = points.iter().rev().copied().collect();
        for tolerance in [0.1, 0.01] {
            let how = Fit { tolerance: Some(tolerance), ..Fit::default() };
            let curve = lofting::geometry::construct::fit_curve::fit(&points, &how, Origin::NONE).unwrap();
            assert!(far(&curve, &points) <= tolerance * (1.0 + 1e-9), "{bends} {tolerance}: {}", far(&curve, &points));
            assert!(curve.start().distance(points[0]) < 1e-12 && curve.end().distance(points[120]) < 1e-12);
            assert!(spans(&curve) <= most, "{bends} bends, {tolerance}: {} spans", spans(&curve));
            let other = lofting::geometry::construct::fit_curve::fit(&backwards, &how, Origin::NONE).unwrap();
            assert!(far(&other, &points) <= tolerance * (1.0 + 1e-9) && spans(&other) <= most, "{bends} {tolerance}: {}", spans(&other));
            let larger: Vec<DVec3> = points.iter().map(|p| *p * 1024.0).collect();
            let how = Fit { tolerance: Some(tolerance * 1024.0), ..Fit::default() };
            let large = lofting::geometry::construct::fit_curve::fit(&larger, &how, Origin::NONE).unwrap();
            assert_eq!(spans(&large), spans(&curve));
        }
    }
}

/// Corners of random sides made round: the arc touches both, and the largest radius that is told is the largest.
mod roundings {
    use super::*;
    use lofting::base::fault::Fault;
    use lofting::geometry::closest;
    use lofting::geometry::construct::fillet::{Treatment, treat};
    use lofting::geometry::curves::curve::Shape;
    use lofting::geometry::data::corner_fault::CornerFault;

    /// Numbers from 0 to 1, always the same.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// A side from the origin along a direction: a line, an arc or a cubic in the plane.
    fn side(numbers: &mut Numbers, angle: f64) -> Curve {
        let turned = |along: f64, across: f64| {
            let (s, c) = lofting::base::math::sin_cos(angle);
            DVec3::new(along * c - across * s, along * s + across * c, 0.0)
        };
        let (length, bend) = (1.0 + 4.0 * numbers.next(), numbers.next() - 0.5);
        match (numbers.next() * 3.0) as usize {
            0 => build::line(DVec3::ZERO, turned(length, 0.0), Origin::NONE),
            1 => build::arc_through(DVec3::ZERO, turned(length, 1.5 * bend), turned(0.5 * length, 0.3 * bend), Origin::NONE),
            _ => {
                let poles = [turned(0.0, 0.0), turned(0.3 * length, 0.0), turned(0.7 * length, bend), turned(length, 2.0 * bend)];
                build::bezier(&poles, None, Origin::NONE)
            }
        }
        .unwrap()
    }

    fn round(corner: &Curve, radius: f64) -> Result<Curve, Fault> {
        treat(corner, None, (Treatment::Round(radius), "radius"), Origin::NONE)
    }

    #[test]
    fn arcs_touch_both_sides() {
        let (mut numbers, mut fitted, mut refused) = (Numbers(7), 0, 0);
        for case in 0..1000 {
            let angle = 6.0 * numbers.next();
            let first = side(&mut numbers, angle).reversed();
            let angle = 6.0 * numbers.next();
            let after = side(&mut numbers, angle);
            let corner = build::composite(&[first, after], Origin::NONE).unwrap();
            let radius = 0.05 + 2.0 * numbers.next();
            let (radius, rounded) = match round(&corner, radius) {
                Ok(curve) => (radius, curve),
                Err(fault) => match fault.of() {
                    Some(&CornerFault::TooNarrow { largest, .. }) => {
                        refused += 1;
                        assert!(round(&corner, largest * 1.001).is_err(), "{case}: {largest} is not the largest");
                        if largest < 1e-3 {
                            continue;
                        }
                        (largest, round(&corner, largest).unwrap_or_else(|_| panic!("{case}: {largest} does not fit")))
                    }
                    Some(CornerFault::NoCorner { .. }) => continue,
                    _ => panic!("{case}: {fault:?}"),
                },
            };
            fitted += 1;
            let Some(pieces) = rounded.composite() else { continue };
            for (i, piece) in pieces.pieces.iter().enumerate() {
                let Shape::Arc(arc) = piece.shape() else { continue };
                if arc.radius != Some(radius) {
                    continue;
                }
                for end in [piece.start(), piece.end()] {
                    assert!(closest(&corner, end).distance < 1e-11, "{case}: {}", closest(&corner, end).distance);
                }
                let neighbours = [i.checked_sub(1).map(|k| (k, true)), (i + 1 < pieces.pieces.len()).then_some((i + 1, false))];
                for (k, before) in neighbours.into_iter().flatten() {
                    let other = &pieces.pieces[k];
                    let (t, s) = if before { (other.domain().1, 0.0) } else { (other.domain().0, piece.domain().1) };
                    assert!(other.point(t).distance(piece.point(s)) < 1e-11, "{case}");
                    assert!(other.jet(t).d1.normalize().distance(piece.jet(s).d1.normalize()) < 1e-9, "{case}");
                }
            }
        }
        assert!(fitted > 900 && refused > 100 && refused < 900, "{fitted} {refused}");
    }
}
