//! Surfaces against the reference numbers, and the properties they must keep.

use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::build::{line, spline};
use lofting::geometry::{Curve, Ends, Spline};
use lofting::network::flow::Member;
use lofting::network::{Chain, Flow, FlowKind};
use lofting::surface::coons::{Grid, Method, Settings, build};
use lofting::surface::{Lean, Reparam, Surface};
use serde_json::Value;

fn reference(name: &str) -> Value {
    let path = format!("{}/tests/data/reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn vec3(value: &Value) -> DVec3 {
    let number = |v: &Value| v.as_f64().unwrap_or_else(|| v.as_str().unwrap().parse().unwrap());
    DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
}

fn tolerance() -> Tolerance {
    Tolerance::new(1e-6, 10.0)
}

fn close(a: DVec3, b: DVec3, within: f64, what: &str) {
    assert!(a.distance(b) <= within, "{what}: {a} is not {b}, {} off", a.distance(b));
}

/// A curve through points of a formula, with its exact end tangents: fourth order in the spacing.
fn sampled(n: usize, f: impl Fn(f64) -> DVec3) -> Curve {
    let points: Vec<DVec3> = (0..=n).map(|k| f(k as f64 / n as f64)).collect();
    let h = 1e-6;
    let (start, end) = ((f(h) - f(0.0)) / h, (f(1.0) - f(1.0 - h)) / h);
    spline(&points, &Spline { start: Ends::Clamped(start), end: Ends::Clamped(end), closed: false }, Origin::NONE).unwrap()
}

/// Fraction at which a rising function of the point passes zero.
fn fraction_where(chain: &Chain, f: impl Fn(DVec3) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(chain.point(middle)) > 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

fn member(curve: usize, crossings: &[f64]) -> Member {
    Member { curve, reversed: crossings.len() > 1 && crossings[0] > crossings[crossings.len() - 1], crossings: crossings.to_vec() }
}

fn quad_flow(along_u: Vec<Member>, along_v: Vec<Member>) -> Flow {
    Flow { kind: FlowKind::Quadrilateral, along_u, along_v, closed_u: false, closed_v: false, poles: (None, None), overhangs: Vec::new() }
}

fn built(chains: &[Chain], flow: &Flow, method: Method, reparam: Reparam) -> Surface {
    let settings = Settings { method, reparam, origin: Origin::NONE };
    build(&Grid { chains, flow, poles: (None, None) }, &settings, &tolerance()).unwrap().0
}

/// The nine curves of `coons_c1.json` as a surface: Ψ_0…Ψ_2, then Φ_0…Φ_2.
fn coons_c1(reparam: Reparam) -> Surface {
    let h = |x: f64, y: f64| 0.5 * (0.8 * x).sin() * (0.7 * y).cos();
    let psi = (0..3).map(|n| f64::from(n)).map(|y| sampled(400, move |w| DVec3::new(4.0 * w, y, h(4.0 * w, y))));
    let plan: [fn(f64) -> f64; 3] = [|_| 0.0, |w| 1.0 + 2.0 * w, |_| 4.0];
    let phi = plan.into_iter().map(|x| sampled(400, move |w| DVec3::new(x(w), 2.0 * w, h(x(w), 2.0 * w))));
    let chains: Vec<Chain> = psi.chain(phi).map(|c| Chain::of_curve(&c)).collect();
    // All nine rise in x + y.
    let at = |k: usize, p: DVec3| fraction_where(&chains[k], |q| q.x + q.y - p.x - p.y);
    let node = |m: usize, n: usize| {
        let (y, x) = (n as f64, plan[m](n as f64 / 2.0));
        DVec3::new(x, y, h(x, y))
    };
    let along_u = (0..3).map(|n| member(n, &[0.0, at(n, node(1, n)), 1.0])).collect();
    let along_v = (0..3).map(|m| member(3 + m, &[0.0, at(3 + m, node(m, 1)), 1.0])).collect();
    built(&chains, &quad_flow(along_u, along_v), Method::Composite, reparam)
}

#[test]
fn coons_patches_meet_smoothly() {
    let data = reference("coons_c1");
    let u1 = number(&data["parameters"]["u"][1]);
    for case in data["cases"].as_array().unwrap() {
        let linear = case["reparameterisation"] == "linear";
        let surface = coons_c1(if linear { Reparam::Linear } else { Reparam::Smooth });
        for sample in case["samples"].as_array().unwrap() {
            let p = surface.point(number(&sample["u"]), number(&sample["v"]));
            close(p, vec3(&sample["point"]), 2e-6, &format!("linear {linear} {sample}"));
        }
        // The reference parameter has rounding of its own: take the surface's.
        let u1 = surface.breaks().0.into_iter().min_by(|a, b| (a - u1).abs().total_cmp(&(b - u1).abs())).unwrap();
        let mut turn: f64 = 0.0;
        for row in case["rows"].as_array().unwrap() {
            let v = number(&row["v"]);
            let left = surface.jet_lean(u1, v, (Lean::Before, Lean::After));
            let right = surface.jet_lean(u1, v, (Lean::After, Lean::After));
            close(left.du, vec3(&row["dU_du_left"]), 1e-4, "left derivative");
            close(right.du, vec3(&row["dU_du_right"]), 1e-4, "right derivative");
            let (a, b) = (left.du.cross(left.dv), right.du.cross(right.dv));
            let angle = a.cross(b).length().atan2(a.dot(b)).to_degrees();
            assert!((angle - number(&row["normal_angle_deg"])).abs() < 1e-4, "{angle} {row}");
            turn = turn.max(angle);
        }
        if linear {
            assert!((turn - 5.88).abs() < 0.005, "{turn}");
        } else {
            assert!(turn < 1e-6, "{turn}");
        }
    }
}

#[test]
fn four_lines_span_the_bilinear_patch() {
    let [a, b, c, d] = [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(4.0, 3.0, 1.0), DVec3::new(0.0, 3.0, 0.0)];
    let chains: Vec<Chain> = [(a, b), (b, c), (d, c), (a, d)].map(|(p, q)| Chain::of_curve(&line(p, q, Origin::NONE).unwrap())).to_vec();
    let flow = quad_flow(vec![member(0, &[0.0, 1.0]), member(2, &[0.0, 1.0])], vec![member(3, &[0.0, 1.0]), member(1, &[0.0, 1.0])]);
    let surface = built(&chains, &flow, Method::Lagrange, Reparam::Smooth);
    let mut grid = vec![DVec3::ZERO; 12];
    let (us, vs) = ([0.0, 0.25, 0.5, 1.0], [0.0, 0.3, 1.0]);
    surface.grid(&us, &vs, &mut grid);
    for (j, v) in vs.into_iter().enumerate() {
        for (i, u) in us.into_iter().enumerate() {
            let exact = (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v;
            close(surface.point(u, v), exact, 1e-14, "point");
            close(grid[j * 4 + i], exact, 1e-14, "grid");
        }
    }
    assert!(surface.review(&tolerance()).is_empty());
}
