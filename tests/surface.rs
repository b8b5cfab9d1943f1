//! Surfaces against the reference numbers, and the properties they must keep.

use glam::DVec3;
use lofting::base::fault::Fault;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_center, arc_through, circle, line, polyline, spline};
use lofting::geometry::construct::spline::{open_slopes, through};
use lofting::geometry::{Curve, Ends, Motion, Spline};
use lofting::model::measure;
use lofting::network::flow::Member;
use lofting::network::{Chain, ChainFlow, Flow, FlowKind, of_chains};
use lofting::surface::blended::coons::{BlendMethod, CoonsSettings, Grid, build};
use lofting::surface::blended::plane_face;
use lofting::surface::points::interpolate::{Tangents, fitted};
use lofting::surface::swept::extrude;
use lofting::surface::swept::revolve::{self, Axis};
use lofting::surface::{Domain, Nearest, NurbsSurface, OneSided, Reparam, Side, Surface, axis_of, extrude, revolve, ruled};
use serde_json::Value;

use crate::support::reference::reference;

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

fn built(chains: &[Chain], flow: &Flow, method: BlendMethod, reparam: Reparam) -> Surface {
    let settings = CoonsSettings { method, reparam, origin: Origin::NONE };
    build(&Grid { chains, flow, poles: (None, None) }, &settings, &tolerance()).unwrap().0
}

/// The nine curves of `coons_c1.json` as a surface: Ψ_0…Ψ_2, then Φ_0…Φ_2.
/// With it u_1, the mean fraction of the middle crossings.
fn coons_c1(reparam: Reparam) -> (Surface, f64) {
    let h = |x: f64, y: f64| 0.5 * (0.8 * x).sin() * (0.7 * y).cos();
    let psi = (0..3).map(f64::from).map(|y| sampled(400, move |w| DVec3::new(4.0 * w, y, h(4.0 * w, y))));
    let plan: [fn(f64) -> f64; 3] = [|_| 0.0, |w| 1.0 + 2.0 * w, |_| 4.0];
    let phi = plan.into_iter().map(|x| sampled(400, move |w| DVec3::new(x(w), 2.0 * w, h(x(w), 2.0 * w))));
    let chains: Vec<Chain> = psi.chain(phi).map(|c| Chain::of_curve(&c)).collect();
    // All nine rise in x + y.
    let at = |k: usize, p: DVec3| fraction_where(&chains[k], |q| q.x + q.y - p.x - p.y);
    let node = |m: usize, n: usize| {
        let (y, x) = (n as f64, plan[m](n as f64 / 2.0));
        DVec3::new(x, y, h(x, y))
    };
    let crossing = |n: usize| at(n, node(1, n));
    let u1 = (crossing(0) + crossing(1) + crossing(2)) / 3.0;
    let along_u = (0..3).map(|n| member(n, &[0.0, crossing(n), 1.0])).collect();
    let along_v = (0..3).map(|m| member(3 + m, &[0.0, at(3 + m, node(m, 1)), 1.0])).collect();
    (built(&chains, &quad_flow(along_u, along_v), BlendMethod::Coons, reparam), u1)
}

#[test]
fn coons_patches_meet_smoothly() {
    let data = reference("coons_c1");
    for case in data["cases"].as_array().unwrap() {
        let linear = case["reparameterisation"] == "linear";
        let (surface, u1) = coons_c1(if linear { Reparam::Linear } else { Reparam::Smooth });
        for sample in case["samples"].as_array().unwrap() {
            let p = surface.point(number(&sample["u"]), number(&sample["v"]));
            close(p, vec3(&sample["point"]), 2e-6, &format!("linear {linear} {sample}"));
        }
        assert!((u1 - number(&data["parameters"]["u"][1])).abs() < 1e-9);
        let mut turn: f64 = 0.0;
        for row in case["rows"].as_array().unwrap() {
            let v = number(&row["v"]);
            let left = surface.jet_one_sided(u1, v, (OneSided::Before, OneSided::After));
            let right = surface.jet_one_sided(u1, v, (OneSided::After, OneSided::After));
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
    let surface = built(&chains, &flow, BlendMethod::Lagrange, Reparam::Smooth);
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
    assert!(surface.validate(&tolerance()).is_empty());
}

/// The surface over chains, its flow found from their meetings.
fn spanned(chains: &[Chain], options: &ChainFlow, method: BlendMethod) -> (Surface, Vec<Fault>) {
    let (flow, nodes) = of_chains(chains, options, &tolerance()).unwrap();
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    let settings = CoonsSettings { method, reparam: Reparam::Smooth, origin: Origin::NONE };
    build(&Grid { chains, flow: &flow, poles }, &settings, &tolerance()).unwrap()
}

fn straight(a: [f64; 3], b: [f64; 3]) -> Chain {
    Chain::of_curve(&line(a.into(), b.into(), Origin::NONE).unwrap())
}

/// Quarter of a great circle between unit axis points.
fn quarter(a: DVec3, b: DVec3) -> Chain {
    Chain::of_curve(&arc_through(a, b, (a + b).normalize(), Origin::NONE).unwrap())
}

#[test]
fn three_great_circles_give_the_uniform_trilateral() {
    let data = reference("flow_types");
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let chains = [quarter(x, y), quarter(y, z), quarter(x, z)];
    let (surface, _) = spanned(&chains, &ChainFlow::default(), BlendMethod::Coons);
    assert_eq!((surface.domain(), surface.flow().as_str()), (Domain::Triangle, "uniform trilateral"));
    for sample in data["uniform_trilateral"]["samples"].as_array().unwrap() {
        let l = vec3(&sample["l"]);
        close(surface.point(l.y, l.z), vec3(&sample["point"]), 1e-12, "sample");
    }
    for k in 0..=20 {
        let t = f64::from(k) / 20.0;
        close(surface.point(t, 0.0), chains[0].point(t), 1e-15, "v = 0");
        close(surface.point(1.0 - t, t), chains[1].point(t), 1e-15, "slant");
        close(surface.point(0.0, t), chains[2].point(t), 1e-15, "u = 0");
    }
    derivatives(&surface);
    derivatives(&surface.flipped());
}

#[test]
fn a_named_pole_gives_the_degenerate_trilateral() {
    let data = reference("flow_types");
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let chains = [quarter(x, y), quarter(z, y), quarter(z, x)];
    let options = ChainFlow { pole: Some(z), ..ChainFlow::default() };
    let (surface, _) = spanned(&chains, &options, BlendMethod::Lagrange);
    assert_eq!(surface.flow(), "degenerate trilateral");
    for sample in data["degenerate_trilateral_bilinear"]["samples"].as_array().unwrap() {
        close(surface.point(number(&sample["u"]), number(&sample["v"])), vec3(&sample["point"]), 1e-12, "sample");
    }
    // Every way along the collapsed side is the pole; its normal is the limit.
    for u in [0.0, 0.3, 1.0] {
        close(surface.point(u, 0.0), z, 1e-15, "pole");
        assert!(surface.normal(u, 0.0).dot(z).abs() > 1.0 - 1e-12);
    }
    assert!(matches!(surface.side(0), Side::Pole(p) if p == z));
    assert!(surface.validate(&tolerance()).is_empty());
    derivatives(&surface);
}

#[test]
fn grid_parameters_of_a_reversed_curve() {
    let data = &reference("parameter_maps")["grid_parameters"];
    let chains = [
        straight([0.0, 0.0, 0.0], [4.0, 0.0, 0.0]),
        straight([0.0, 1.0, 0.0], [4.0, 1.0, 0.0]),
        straight([4.0, 2.0, 0.0], [0.0, 2.0, 0.0]),
        straight([0.0, 0.0, 0.0], [0.0, 2.0, 0.0]),
        straight([1.0, 0.0, 0.0], [3.0, 2.0, 0.0]),
        straight([4.0, 0.0, 0.0], [4.0, 2.0, 0.0]),
    ];
    let (flow, _) = of_chains(&chains, &ChainFlow::default(), &tolerance()).unwrap();
    let surface = built(&chains, &flow, BlendMethod::Coons, Reparam::Linear);
    assert_eq!(surface.breaks().0, [number(&data["u_1"])]);
    for (key, value) in data["f_2"].as_object().unwrap() {
        let u: f64 = key.trim_start_matches("u=").parse().unwrap();
        assert!((surface.side_fraction(2, u) - number(value)).abs() < 1e-12, "f_2({u})");
        assert!((surface.side_parameter(2, number(value)) - u).abs() < 1e-12, "inverse of f_2({u})");
    }
    for (key, value) in data["f_0"].as_object().unwrap() {
        let u: f64 = key.trim_start_matches("u=").parse().unwrap();
        assert!((surface.side_fraction(0, u) - number(value)).abs() < 1e-12, "f_0({u})");
    }
}

/// The two surfaces of figure 2.2 of [Koh & Park 1990] from its ten curves.
fn figure() -> (Surface, Surface) {
    let t = tolerance();
    let c = |a: [f64; 3], b: [f64; 3]| straight(a, b);
    let (c1, c6) = (c([0.0, 0.0, 0.0], [8.0, 0.0, 0.0]), c([8.0, -6.0, -3.0], [8.0, 3.0, 1.5]));
    let (c2, c3) = (c([0.0, 6.0, 0.0], [4.0, 6.0, 2.0]), c([4.0, 6.0, 2.0], [8.0, 6.0, 0.0]));
    let (c4, c5) = (c([0.0, 0.0, 0.0], [0.0, 3.0, 1.5]), c([0.0, 3.0, 1.5], [0.0, 6.0, 0.0]));
    let c7 = c([8.0, 3.0, 1.5], [8.0, 6.0, 0.0]);
    let (p, q) = (DVec3::new(4.0, -2.0, -4.0), DVec3::new(4.0, 6.0, 2.0));
    let c8 = Chain::of_curve(&arc_through(p, q, DVec3::new(4.0, 0.0, 0.0), Origin::NONE).unwrap());
    let (c9, c10) = (c([4.0, -2.0, -4.0], [4.0, -5.0, -6.0]), c([4.0, -5.0, -6.0], [8.0, -6.0, -3.0]));
    let on_arc = c8.fraction_at(DVec3::new(4.0, 0.0, 0.0), &t).unwrap();
    let joint = |parts: &[Chain]| Chain::join(parts, Origin::NONE, &t).unwrap();
    let b = [
        c1.clone(),
        joint(&[c2, c3]),
        joint(&[c4, c5]),
        c8.slice(on_arc, 1.0, &t).unwrap(),
        joint(&[c6.slice(2.0 / 3.0, 1.0, &t).unwrap(), c7]),
    ];
    let a = [c1.slice(0.5, 1.0, &t).unwrap(), c10, joint(&[c8.slice(on_arc, 0.0, &t).unwrap(), c9]), c6.slice(2.0 / 3.0, 0.0, &t).unwrap()];
    (spanned(&b, &ChainFlow::default(), BlendMethod::Lagrange).0, spanned(&a, &ChainFlow::default(), BlendMethod::Lagrange).0)
}

#[test]
fn the_two_surfaces_of_figure_2_2() {
    let data = reference("figure_2_2");
    let (b, a) = figure();
    for (surface, key) in [(&b, "surface_B"), (&a, "surface_A")] {
        for sample in data[key]["samples"].as_array().unwrap() {
            close(surface.point(number(&sample["u"]), number(&sample["v"])), vec3(&sample["point"]), 1e-12, key);
        }
        for (own, direction) in [(surface.kinks().0, "u"), (surface.kinks().1, "v")] {
            let expected: Vec<f64> = data[key]["kink_lines"][direction].as_array().unwrap().iter().map(number).collect();
            assert_eq!(own.len(), expected.len(), "{key} {direction}");
            assert!(own.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{key} {own:?}");
        }
        assert!(surface.validate(&tolerance()).is_empty());
        derivatives(surface);
    }
    // The kink of the border is met from the side that is asked for.
    let v = a.kinks().1[0];
    let side = |lean| a.jet_one_sided(0.0, v, (OneSided::After, lean)).dv.normalize();
    assert!(side(OneSided::Before).distance(side(OneSided::After)) > 0.1);
    let far = |lean, h| a.jet_one_sided(0.0, v + h, (OneSided::After, lean)).dv.normalize();
    close(side(OneSided::Before), far(OneSided::After, -1e-9), 1e-6, "before");
    close(side(OneSided::After), far(OneSided::After, 1e-9), 1e-6, "after");
}

/// First and second derivatives are difference quotients of points, away from lines where they jump.
fn derivatives(surface: &Surface) {
    let h = 1e-5;
    let (us, vs) = surface.breaks();
    let away = |x: f64, lines: &[f64]| lines.iter().all(|line| (line - x).abs() > 3.0 * h);
    let size = surface.hull().diagonal();
    for i in 1..8 {
        for j in 1..8 {
            let (mut u, v) = (f64::from(i) / 8.0 + 0.003, f64::from(j) / 8.0 + 0.004);
            if surface.domain() == Domain::Triangle {
                u *= 1.0 - v;
            }
            if !away(u, &us) || !away(v, &vs) {
                continue;
            }
            let jet = surface.jet(u, v);
            let at = |a: f64, b: f64| surface.jet(u + a * h, v + b * h);
            let quotient = |a: DVec3, b: DVec3| (b - a) / (2.0 * h);
            let check = |name: &str, exact: DVec3, a: DVec3, b: DVec3, within: f64| {
                close(quotient(a, b), exact, within * (size + exact.length()), &format!("{name} at {u}, {v}"));
            };
            check("du", jet.du, at(-1.0, 0.0).p, at(1.0, 0.0).p, 1e-7);
            check("dv", jet.dv, at(0.0, -1.0).p, at(0.0, 1.0).p, 1e-7);
            check("duu", jet.duu, at(-1.0, 0.0).du, at(1.0, 0.0).du, 1e-5);
            check("duv", jet.duv, at(0.0, -1.0).du, at(0.0, 1.0).du, 1e-5);
            check("dvv", jet.dvv, at(0.0, -1.0).dv, at(0.0, 1.0).dv, 1e-5);
        }
    }
}

#[test]
fn sweeps_have_the_exact_nets() {
    let data = reference("sweep");
    let z_axis = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let turn = std::f64::consts::TAU;
    let ring = |center: [f64; 3], normal: DVec3, start: [f64; 3], angle: f64| {
        arc_center(center.into(), start.into(), angle, normal, Origin::NONE).unwrap()
    };
    let nurbs = |curve: &Curve| curve.to_nurbs(&tolerance()).unwrap();
    let torus = ring([3.0, 0.0, 0.0], -DVec3::Y, [4.0, 0.0, 0.0], turn);
    let sphere = ring([0.0; 3], -DVec3::Y, [0.0, 0.0, -1.0], 0.5 * turn);
    let cone = line(DVec3::new(0.0, 0.0, 2.0), DVec3::X, Origin::NONE).unwrap();
    let circle = ring([0.0; 3], DVec3::Z, [2.0, 0.0, 0.0], turn);
    let turned = |curve: &Curve| revolve::net(&nurbs(curve), &z_axis, turn);
    check_net(&data["torus_ROT"], &turned(&torus), false, |p| (p.truncate().length() - 3.0).powi(2) + p.z * p.z - 1.0);
    check_net(&data["sphere_ROT"], &turned(&sphere), false, |p| p.length() - 1.0);
    check_net(&data["cone_ROT"], &turned(&cone), false, |p| p.truncate().length_squared() - (1.0 - p.z / 2.0).powi(2));
    let cylinder = extrude::net(&nurbs(&circle), DVec3::new(0.0, 0.0, 5.0));
    check_net(&data["cylinder_PAR"], &cylinder, true, |p| p.truncate().length_squared() - 4.0);

    // The surfaces themselves run by arc length; they are the same sets of points.
    let surface = |curve: &Curve| revolve(&Chain::of_curve(curve), &z_axis, turn, Origin::NONE, &tolerance()).unwrap();
    let (torus, sphere, cone) = (surface(&torus), surface(&sphere), surface(&cone));
    assert_eq!(torus.flow(), "quadrilateral closed in u and v");
    assert_eq!(sphere.flow(), "degenerate bilateral closed in u");
    assert_eq!(cone.flow(), "degenerate trilateral closed in u");
    for i in 0..=17 {
        for j in 0..=17 {
            let (u, v) = (f64::from(i) / 17.0, f64::from(j) / 17.0);
            let p = torus.point(u, v);
            assert!(((p.truncate().length() - 3.0).powi(2) + p.z * p.z - 1.0).abs() < 4e-15);
            assert!((sphere.point(u, v).length() - 1.0).abs() < 1e-15);
        }
    }
    for s in [&torus, &sphere, &cone] {
        derivatives(s);
        derivatives(&s.flipped());
        assert!(s.validate(&tolerance()).is_empty());
    }
    // A cone's tip has no tangent plane: the mean of the normals is its axis.
    assert!(cone.normal(0.3, 0.0).dot(DVec3::Z).abs() > 1.0 - 1e-12);
}

fn check_net(data: &Value, net: &NurbsSurface, exchanged: bool, residual: impl Fn(DVec3) -> f64) {
    let rows = data["control_net"].as_array().unwrap();
    for (i, row) in rows.iter().enumerate() {
        for (j, p) in row.as_array().unwrap().iter().enumerate() {
            let q = if exchanged { net.pole(j, i) } else { net.pole(i, j) };
            close(q.truncate() / q.w, vec3(p), 1e-12, "pole");
            assert!((q.w - number(&data["weights"][i][j])).abs() < 1e-12, "weight {i} {j}");
        }
    }
    let place = |u: f64, v: f64| if exchanged { (v, u) } else { (u, v) };
    let at = |u: f64, v: f64| {
        let (u, v) = place(u, v);
        net.jet(u, v, (OneSided::After, OneSided::After)).p
    };
    for sample in data["samples"].as_array().unwrap() {
        close(at(number(&sample["u"]), number(&sample["v"])), vec3(&sample["point"]), 1e-12, "sample");
    }
    for i in 0..18 {
        for j in 0..18 {
            let off = residual(at(f64::from(i) / 17.0, f64::from(j) / 17.0));
            assert!(off.abs() < 5e-15, "{off}");
        }
    }
}

#[test]
fn gridded_points_with_given_tangents() {
    let data = &reference("nub_fit")["surface_fit"];
    let points = |value: &Value| value.as_array().unwrap().iter().map(vec3).collect::<Vec<DVec3>>();
    // The reference has the first index along u.
    let by_u: Vec<Vec<DVec3>> = data["data"].as_array().unwrap().iter().map(points).collect();
    let rows: Vec<Vec<DVec3>> = (0..4).map(|j| by_u.iter().map(|column| column[j]).collect()).collect();
    let span = |key: &str| data[key].as_array().unwrap().iter().map(number).collect::<Vec<f64>>();
    let (su, sv) = (span("spans_u"), span("spans_v"));
    let local = |key: &str, h: f64| points(&data["tangents"][key]).into_iter().map(|t| t / h).collect::<Vec<DVec3>>();
    let (h, k) = ((su[0], su[1]), (sv[0], sv[2]));
    let twist = |key: &str, area: f64| vec3(&data["twists"][key]) / area;
    let tangents = Tangents {
        across_u: [Some(local("s0", h.0)), Some(local("sm", h.1))],
        across_v: [Some(local("t0", k.0)), Some(local("tn", k.1))],
        twists: [twist("x00", h.0 * k.0), twist("xm0", h.1 * k.0), twist("x0n", h.0 * k.1), twist("xmn", h.1 * k.1)],
    };
    let (net, notes) = fitted(&rows, &tangents, Origin::NONE, &tolerance()).unwrap();
    assert!(notes.is_empty());
    for (i, column) in data["control_net"].as_array().unwrap().iter().enumerate() {
        for (j, p) in column.as_array().unwrap().iter().enumerate() {
            close(net.pole(i, j).truncate(), vec3(p), 1e-12, &format!("pole {i} {j}"));
        }
    }
    for sample in data["samples"].as_array().unwrap() {
        let (u, v) = (number(&sample["u_fraction"]), number(&sample["v_fraction"]));
        close(net.jet(u, v, (OneSided::After, OneSided::After)).p, vec3(&sample["point"]), 1e-12, "sample");
    }
}

#[test]
fn lines_of_a_grid_with_given_tangents_and_twists() {
    let data = &reference("nub_fit")["surface_fit"];
    let points = |value: &Value| value.as_array().unwrap().iter().map(vec3).collect::<Vec<DVec3>>();
    let spans = |key: &str| data[key].as_array().unwrap().iter().map(number).collect::<Vec<f64>>();
    let su = spans("spans_u");
    let poles = |row: &[DVec3], ends: [DVec3; 2]| {
        let curve = through(row, &su, &open_slopes(row, &su, ends.map(Some)));
        curve.poles.iter().map(|p| p.truncate()).collect::<Vec<DVec3>>()
    };
    let same = |found: &[DVec3], expected: &[DVec3], what: &str| {
        assert_eq!(found.len(), expected.len());
        found.iter().zip(expected).for_each(|(a, b)| close(*a, *b, 1e-12, what));
    };
    // Of each column of data, first index along u, the poles along u.
    let by_u: Vec<Vec<DVec3>> = data["data"].as_array().unwrap().iter().map(points).collect();
    let lines: Vec<Vec<DVec3>> = data["intermediate_C"].as_array().unwrap().iter().map(points).collect();
    let (s0, sm) = (points(&data["tangents"]["s0"]), points(&data["tangents"]["sm"]));
    for j in 0..4 {
        let row: Vec<DVec3> = by_u.iter().map(|column| column[j]).collect();
        let expected: Vec<DVec3> = lines.iter().map(|line| line[j]).collect();
        same(&poles(&row, [s0[j] / su[0], sm[j] / su[1]]), &expected, "C");
    }
    // The derivatives along v at both borders, with the twists at their ends.
    for (rows, [first, last], expected) in [("t0", ["x00", "xm0"], "d"), ("tn", ["x0n", "xmn"], "e")] {
        let ends = [vec3(&data["twists"][first]) / su[0], vec3(&data["twists"][last]) / su[1]];
        same(&poles(&points(&data["tangents"][rows]), ends), &points(&data[expected]), expected);
    }
}

#[test]
fn a_grid_passes_through_its_points() {
    let h = |x: f64, y: f64| (x * 1.3).sin() * (y * 0.7).cos();
    let xs = [0.0, 0.7, 1.1, 2.0, 3.2];
    let ys = [0.0, 1.0, 1.6, 3.0];
    let rows: Vec<Vec<DVec3>> = ys.iter().map(|&y| xs.iter().map(|&x| DVec3::new(x, y, h(x, y))).collect()).collect();
    let (surface, notes) = lofting::surface::grid(&rows, Origin::NONE, &tolerance()).unwrap();
    assert!(notes.is_empty());
    let (us, vs) = surface.breaks();
    let (us, vs) = ([&[0.0], us.as_slice(), &[1.0]].concat(), [&[0.0], vs.as_slice(), &[1.0]].concat());
    for (j, v) in vs.iter().enumerate() {
        for (i, u) in us.iter().enumerate() {
            close(surface.point(*u, *v), rows[j][i], 1e-13, "grid point");
        }
    }
    // Natural ends: nothing bends across the border.
    assert!(surface.jet(0.0, 0.4).duu.length() < 1e-10 && surface.jet(0.3, 1.0).dvv.length() < 1e-10);
    assert!(surface.kinks().0.is_empty() && surface.kinks().1.is_empty());
    derivatives(&surface);
}

#[test]
fn curves_in_any_order_and_direction_give_one_surface() {
    let h = |x: f64, y: f64| 0.5 * (0.8 * x).sin() * (0.7 * y).cos();
    let plan: [fn(f64) -> f64; 3] = [|_| 0.0, |w| 1.0 + 2.0 * w, |_| 4.0];
    let psi = [0.0, 1.0, 2.0].map(|y| sampled(40, move |w| DVec3::new(4.0 * w, y, h(4.0 * w, y))));
    let phi = plan.map(|x| sampled(40, move |w| DVec3::new(x(w), 2.0 * w, h(x(w), 2.0 * w))));
    // Curves must share nodes: the crossings are made good by a loose tolerance.
    let t = Tolerance::new(1e-3, 10.0);
    let chains: Vec<Chain> = psi.iter().chain(&phi).map(Chain::of_curve).collect();
    let surface = |chains: &[Chain]| {
        let (flow, nodes) = of_chains(chains, &ChainFlow::default(), &t).unwrap();
        assert!(nodes.len() == 9 && flow.poles == (None, None));
        let settings = CoonsSettings { method: BlendMethod::Coons, reparam: Reparam::Smooth, origin: Origin::NONE };
        build(&Grid { chains, flow: &flow, poles: (None, None) }, &settings, &t).unwrap().0
    };
    let original = surface(&chains);
    let mut state = 7_u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    for _ in 0..40 {
        // The first curve and the first of the outer ones along u say where u and v begin; the rest may come anyhow.
        let mut rest = chains[1..].to_vec();
        for k in (1..rest.len()).rev() {
            rest.swap(k, random(k + 1));
        }
        for chain in &mut rest {
            if random(2) == 1 {
                *chain = chain.reversed();
            }
        }
        let shuffled = surface(&[vec![chains[0].clone()], rest].concat());
        for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.77, 0.31), (0.9, 0.95), (0.0, 0.6), (1.0, 1.0)] {
            close(shuffled.point(u, v), original.point(u, v), 1e-9, "point");
            close(shuffled.normal(u, v), original.normal(u, v), 1e-7, "normal");
        }
    }
}

#[test]
fn motions_and_flips_commute_with_everything() {
    let (b, a) = figure();
    let torus = {
        let circle = circle(DVec3::new(3.0, 0.0, 0.0), 1.0, DVec3::Y, Origin::NONE).unwrap();
        revolve(&Chain::of_curve(&circle), &Axis { about: DVec3::ZERO, direction: DVec3::Z }, 1.2, Origin::NONE, &tolerance()).unwrap()
    };
    let (fan, _) = spanned(
        &[quarter(DVec3::X, DVec3::Y), quarter(DVec3::Y, DVec3::Z), quarter(DVec3::X, DVec3::Z)],
        &ChainFlow::default(),
        BlendMethod::Coons,
    );
    let wall = extrude(&straight([0.0, 0.0, 0.0], [1.0, 2.0, 0.0]), DVec3::new(0.0, 0.3, 2.0), Origin::NONE, &tolerance()).unwrap();
    let rotation = Motion::rotation(DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 2.0, -1.0).normalize(), 0.83);
    let motions = [
        rotation.then(&Motion::scaling(DVec3::new(0.0, 1.0, 0.0), 37.0)),
        Motion::mirror(DVec3::new(0.0, 1.0, 0.5), DVec3::new(1.0, 1.0, 0.2).normalize()),
        Motion::translation(DVec3::new(1e3, -2e3, 5.0)),
    ];
    for surface in [&a, &b, &torus, &fan, &wall] {
        for motion in &motions {
            let (moved, size) = (surface.moved(motion), surface.hull().diagonal() * motion.scale() + 2e3);
            for (u, v) in [(0.0, 0.0), (0.2, 0.3), (0.05, 0.9), (0.4, 0.6)] {
                let (j, m) = (surface.jet(u, v), moved.jet(u, v));
                close(m.p, motion.point(j.p), 1e-13 * size, "point");
                close(m.du, motion.vector(j.du), 1e-11 * size, "du");
                close(m.duv, motion.vector(j.duv), 1e-9 * size, "duv");
                let sign = if motion.mirrors() { -1.0 } else { 1.0 };
                close(moved.normal(u, v), motion.vector(surface.normal(u, v)) * (sign / motion.scale()), 1e-9, "normal");
            }
            assert_eq!(surface.kinks(), moved.kinks());
        }
        let (flipped, twice) = (surface.flipped(), surface.flipped().flipped());
        for (u, v) in [(0.1, 0.2), (0.3, 0.6)] {
            let there = if surface.domain() == Domain::Triangle { (v, u) } else { (u, 1.0 - v) };
            close(flipped.point(there.0, there.1), surface.point(u, v), 1e-13, "flipped point");
            close(flipped.normal(there.0, there.1), -surface.normal(u, v), 1e-12, "flipped normal");
            assert_eq!(twice.jet(u, v), surface.jet(u, v));
        }
        sides_lie_on_chains(surface);
        sides_lie_on_chains(&flipped);
    }
}

/// Points of the border are the points of the chain that the side names, at the fraction that it says.
fn sides_lie_on_chains(surface: &Surface) {
    for k in 0..surface.n_sides() {
        let Side::Chain { chain, from, to } = surface.side(k) else { continue };
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            let (u, v) = match (surface.domain(), k) {
                (_, 0) => (t, 0.0),
                (Domain::Triangle, 1) => (1.0 - t, t),
                (_, 1) => (1.0, t),
                (Domain::Square, 2) => (t, 1.0),
                _ => (0.0, t),
            };
            let fraction = surface.side_fraction(k, t);
            close(surface.point(u, v), chain.point(fraction), 1e-12, &format!("side {k} at {t}"));
            assert!((surface.side_parameter(k, fraction) - t).abs() < 1e-12);
        }
        assert!((surface.side_fraction(k, 0.0) - from).abs() < 1e-15 && (surface.side_fraction(k, 1.0) - to).abs() < 1e-15);
    }
}

#[test]
fn closed_flows_have_a_seam() {
    // A tube with four lines; one ring begins elsewhere and runs the other way.
    let ring = |z: f64, start: f64, way: f64, r: f64| {
        let p = DVec3::new(r * start.cos(), r * start.sin(), z);
        Chain::of_curve(&arc_center(DVec3::new(0.0, 0.0, z), p, way * std::f64::consts::TAU, DVec3::Z, Origin::NONE).unwrap())
    };
    let quarter_turn = std::f64::consts::FRAC_PI_2;
    let mut chains = vec![ring(0.0, 0.0, 1.0, 1.0), ring(2.0, 0.3, -1.0, 1.5)];
    for k in 0..4 {
        let (s, c) = (quarter_turn * f64::from(k) + 0.1).sin_cos();
        chains.push(straight([c, s, 0.0], [1.5 * c, 1.5 * s, 2.0]));
    }
    let (surface, notes) = spanned(&chains, &ChainFlow::default(), BlendMethod::Coons);
    assert!(notes.is_empty());
    assert_eq!((surface.flow().as_str(), surface.closed()), ("quadrilateral closed in u", (true, false)));
    for v in [0.0, 0.4, 1.0] {
        let (a, b) = (surface.jet(0.0, v), surface.jet_one_sided(1.0, v, (OneSided::Before, OneSided::After)));
        close(a.p, b.p, 1e-12, "seam");
        close(a.du, b.du, 1e-9, "C1 across the seam");
    }
    for i in 0..=40 {
        let p = surface.point(f64::from(i) / 40.0, 0.5);
        assert!((p.truncate().length() - 1.25).abs() < 1e-12 && (p.z - 1.0).abs() < 1e-12);
    }
    sides_lie_on_chains(&surface);
    derivatives(&surface);
}

#[test]
fn ends_over_the_border_are_trimmed_with_a_note() {
    let chains = [
        straight([-0.5, 0.0, 0.0], [4.0, 0.0, 0.0]),
        straight([4.0, 2.0, 0.0], [0.0, 2.0, 0.0]),
        straight([0.0, 0.0, 0.0], [0.0, 2.0, 0.0]),
        straight([4.0, 0.0, 0.0], [4.0, 2.0, 0.0]),
    ];
    let (surface, notes) = spanned(&chains, &ChainFlow::default(), BlendMethod::Coons);
    let codes: Vec<&str> = notes.iter().map(|n| n.code().0).collect();
    assert_eq!(codes, ["N609"]);
    close(surface.point(0.5, 0.0), DVec3::new(2.0, 0.0, 0.0), 1e-12, "half of what is left");
}

#[test]
fn planes_between_curves() {
    let t = tolerance();
    let slab = |chains: &[Chain]| plane_face::bounded(chains, Origin::NONE, &t);
    let code = |chains: &[Chain]| slab(chains).unwrap_err().code().0;
    let p = |x: f64, y: f64| [x, y, 0.5];
    let four = [
        straight(p(0.0, 0.0), p(4.0, 0.0)),
        straight(p(4.0, 3.0), p(4.0, 0.0)),
        straight(p(0.0, 2.0), p(4.0, 3.0)),
        straight(p(0.0, 2.0), p(0.0, 0.0)),
    ];
    let (surface, _) = slab(&four).unwrap();
    assert_eq!((surface.domain(), surface.flow().as_str()), (Domain::Square, "quadrilateral"));
    close(surface.normal(0.3, 0.8), DVec3::Z, 1e-12, "normal by the sense of the first curve");
    sides_lie_on_chains(&surface);
    let triangle =
        slab(&[straight(p(0.0, 0.0), p(4.0, 0.0)), straight(p(0.0, 2.0), p(4.0, 0.0)), straight(p(0.0, 2.0), p(0.0, 0.0))]).unwrap().0;
    assert_eq!(triangle.domain(), Domain::Triangle);
    close(triangle.normal(0.2, 0.2), DVec3::Z, 1e-12, "normal");
    sides_lie_on_chains(&triangle);
    // One closed polyline with four corners is mapped on them; a disc and a hexagon are faces without a map.
    let outline = |n: usize| {
        let at = |k: usize| (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
        let points: Vec<DVec3> = (0..n).map(|k| DVec3::new(at(k).1, at(k).0, 0.0)).collect();
        Chain::of_curve(&polyline(&points, true, Origin::NONE).unwrap())
    };
    assert_eq!(slab(&[outline(4)]).unwrap().0.domain(), Domain::Square);
    assert_eq!(slab(&[outline(3)]).unwrap().0.domain(), Domain::Triangle);
    let hexagon = slab(&[outline(6)]).unwrap().0;
    assert_eq!((hexagon.domain(), hexagon.n_sides()), (Domain::Loop, 1));
    let disc = Chain::of_curve(&circle(DVec3::ZERO, 2.0, DVec3::Z, Origin::NONE).unwrap());
    assert_eq!(slab(std::slice::from_ref(&disc)).unwrap().0.domain(), Domain::Loop);
    // A half disc is ruled between its two sides.
    let half = [straight([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]), disc.slice(0.0, 0.5, &t).unwrap()];
    let half = slab(&half).unwrap().0;
    assert!(matches!((half.side(1), half.side(3)), (Side::Pole(_), Side::Pole(_))));
    close(half.normal(0.5, 0.5), DVec3::Z, 1e-12, "normal");
    assert!(half.validate(&t).is_empty());

    let mut lifted = four.to_vec();
    lifted[2] = straight([0.0, 2.0, 0.5], [4.0, 3.0, 0.9]);
    lifted[1] = straight([4.0, 3.0, 0.9], p(4.0, 0.0));
    assert_eq!(code(&lifted), "E655");
    assert_eq!(code(&four[..3]), "E502");
    let bow = [
        straight(p(0.0, 0.0), p(1.0, 1.0)),
        straight(p(1.0, 1.0), p(1.0, 0.0)),
        straight(p(1.0, 0.0), p(0.0, 1.0)),
        straight(p(0.0, 1.0), p(0.0, 0.0)),
    ];
    assert_eq!(code(&bow), "E611");
}

#[test]
fn ruled_surfaces_read_the_second_curve_the_shorter_way() {
    let t = tolerance();
    let (a, b) = (straight([0.0, 0.0, 0.0], [4.0, 0.0, 0.0]), straight([4.0, 3.0, 1.0], [0.0, 3.0, 0.0]));
    let (surface, notes) = ruled(&a, &b, Origin::NONE, &t).unwrap();
    assert!(notes.is_empty());
    close(surface.point(0.25, 0.5), DVec3::new(1.0, 1.5, 0.125), 1e-14, "point");
    sides_lie_on_chains(&surface);
    derivatives(&surface);
    assert_eq!((surface.chains().len(), surface.generated().len()), (2, 2));
}

#[test]
fn sweeps_refuse_what_has_no_area() {
    let t = tolerance();
    let z = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let turned = |profile: &Chain, angle: f64| revolve(profile, &z, angle, Origin::NONE, &t).map(|s| s.flow()).map_err(|f| f.code().0);
    let slope = straight([1.0, 0.0, 0.0], [2.0, 0.0, 1.0]);
    assert_eq!(turned(&slope, 1.0).unwrap(), "quadrilateral");
    assert_eq!(turned(&slope, 0.0), Err("E411"));
    assert_eq!(turned(&slope, 7.0), Err("E412"));
    assert_eq!(turned(&straight([0.0, 0.0, 1.0], [0.0, 0.0, 3.0]), 1.0), Err("E622"));
    assert_eq!(turned(&straight([-1.0, 0.0, 1.0], [1.0, 0.0, 3.0]), 1.0), Err("E623"));
    assert_eq!(turned(&straight([0.0, 0.0, 1.0], [1.0, 0.0, 3.0]), 1.0).unwrap(), "degenerate trilateral");
    let along = extrude(&slope, DVec3::new(1.0, 0.0, 1.0), Origin::NONE, &t).unwrap_err();
    assert_eq!(along.code().0, "E624");
    assert_eq!(axis_of(&straight([1.0, 1.0, 1.0], [1.0, 1.0, 5.0]), &t).unwrap().direction, DVec3::Z);
    assert_eq!(axis_of(&quarter(DVec3::X, DVec3::Y), &t).unwrap_err().code().0, "E621");
    for s in [revolve(&slope, &z, 1.0, Origin::NONE, &t).unwrap(), extrude(&slope, DVec3::Y, Origin::NONE, &t).unwrap()] {
        sides_lie_on_chains(&s);
        sides_lie_on_chains(&s.flipped());
        derivatives(&s);
    }
}

#[test]
fn areas_volumes_and_moments_of_known_bodies() {
    let t = tolerance();
    let z = Axis { about: DVec3::new(1.0, 2.0, 0.0), direction: DVec3::Z };
    let turn = std::f64::consts::TAU;
    let near = |found: f64, exact: f64, what: &str| assert!((found - exact).abs() <= 1e-10 * exact.abs(), "{what}: {found} is not {exact}");
    let o = z.about;
    let revolved = |curve: &Curve| revolve(&Chain::of_curve(curve), &z, turn, Origin::NONE, &t).unwrap();
    let pi = std::f64::consts::PI;

    // Ball of radius 3: the profile runs up on the outside, so that du × dv points outwards.
    let half = arc_center(o, o - DVec3::Z * 3.0, pi, -DVec3::Y, Origin::NONE).unwrap();
    let ball = revolved(&half);
    near(measure::area(&ball), 36.0 * pi, "area of a sphere");
    let solid = measure::solid(&[(ball.clone(), false)]);
    near(solid.volume, 36.0 * pi, "volume of a ball");
    close(solid.centroid, o, 1e-9, "centroid");
    near(solid.inertia.x_axis.x, 0.4 * 36.0 * pi * 9.0, "inertia of a ball");
    near(solid.inertia.z_axis.z, 0.4 * 36.0 * pi * 9.0, "inertia of a ball");
    assert!(solid.inertia.x_axis.y.abs() < 1e-7);
    near(measure::solid(&[(ball.clone(), true)]).volume, -36.0 * pi, "inside out");
    let bounds = measure::bounds(std::slice::from_ref(&ball));
    close(bounds.min, o - DVec3::splat(3.0), 1e-9, "box");
    close(bounds.max, o + DVec3::splat(3.0), 1e-9, "box");
    let sheet = measure::sheet(&[ball]);
    near(sheet.inertia.z_axis.z, 2.0 / 3.0 * 36.0 * pi * 9.0, "inertia of a spherical sheet");

    // Torus 3, 1 by Pappus.
    let ring = arc_center(o + DVec3::X * 3.0, o + DVec3::X * 4.0, turn, -DVec3::Y, Origin::NONE).unwrap();
    let torus = revolved(&ring);
    near(measure::area(&torus), 4.0 * pi * pi * 3.0, "area of a torus");
    near(measure::solid(&[(torus, false)]).volume, 2.0 * pi * pi * 3.0, "volume of a torus");

    // A disc without a map, and a half disc with one, by their borders.
    let disc = Chain::of_curve(&circle(o, 2.0, DVec3::Z, Origin::NONE).unwrap());
    let flat = plane_face::bounded(std::slice::from_ref(&disc), Origin::NONE, &t).unwrap().0;
    let properties = measure::sheet(std::slice::from_ref(&flat));
    near(properties.area, 4.0 * pi, "area of a disc");
    close(properties.centroid, o, 1e-12, "centroid of a disc");
    near(properties.inertia.z_axis.z, 8.0 * pi, "inertia of a disc");
    near(properties.inertia.x_axis.x, 4.0 * pi, "inertia of a disc");
    close(measure::bounds(&[flat]).max, o + DVec3::new(2.0, 2.0, 0.0), 1e-9, "box of a disc");
    let half = [straight([-1.0, 2.0, 0.0], [3.0, 2.0, 0.0]), disc.slice(0.0, 0.5, &t).unwrap()];
    near(measure::area(&plane_face::bounded(&half, Origin::NONE, &t).unwrap().0), 2.0 * pi, "area of a half disc");

    // A cylinder with two lids: lids and wall together are closed.
    let up = DVec3::new(0.0, 0.0, 5.0);
    let wall = extrude(&disc, up, Origin::NONE, &t).unwrap();
    let lid = plane_face::bounded(std::slice::from_ref(&disc), Origin::NONE, &t).unwrap().0;
    let top = lid.moved(&Motion::translation(up));
    let can = measure::solid(&[(wall, true), (lid, true), (top, false)]);
    near(can.volume, 20.0 * pi, "volume of a can");
    close(can.centroid, o + up * 0.5, 1e-9, "centroid of a can");
    near(can.inertia.z_axis.z, 0.5 * 20.0 * pi * 4.0, "inertia of a can");

    // Curved borders: a paraboloid-like patch against its closed area is in the model tests; a spherical triangle here.
    let octant = spanned(
        &[quarter(DVec3::X, DVec3::Y), quarter(DVec3::Y, DVec3::Z), quarter(DVec3::X, DVec3::Z)],
        &ChainFlow::default(),
        BlendMethod::Coons,
    )
    .0;
    let (whole, moved) = (measure::area(&octant), measure::area(&octant.moved(&Motion::scaling(DVec3::ONE, 10.0))));
    near(moved, 100.0 * whole, "scaled area");
}

#[test]
fn nearest_points_of_surfaces() {
    let t = tolerance();
    let z = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let ring = arc_center(DVec3::X * 3.0, DVec3::X * 4.0, std::f64::consts::TAU, -DVec3::Y, Origin::NONE).unwrap();
    let torus = revolve(&Chain::of_curve(&ring), &z, std::f64::consts::TAU, Origin::NONE, &t).unwrap();
    let nearest = Nearest::new(&torus);
    let mut state = 11_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..200 {
        let p = DVec3::new(10.0 * random() - 5.0, 10.0 * random() - 5.0, 6.0 * random() - 3.0);
        let exact = ((p.truncate().length() - 3.0).hypot(p.z) - 1.0).abs();
        let found = nearest.at(p);
        assert!((found.distance - exact).abs() < 1e-9, "{p}: {} is not {exact}", found.distance);
        close(torus.point(found.uv.0, found.uv.1), found.point, 1e-12, "place");
    }
    // Flat faces: inside the foot, outside the border; a bilinear patch at its border and inside.
    let disc = Chain::of_curve(&circle(DVec3::ZERO, 2.0, DVec3::Z, Origin::NONE).unwrap());
    let flat = plane_face::bounded(&[disc], Origin::NONE, &t).unwrap().0;
    for (p, distance) in [(DVec3::new(0.3, 0.4, 2.0), 2.0), (DVec3::new(6.0, 8.0, 0.0), 8.0), (DVec3::new(3.2, 2.4, 2.0), 8f64.sqrt())] {
        assert!((lofting::surface::closest(&flat, p).distance - distance).abs() < 1e-9, "{p}");
    }
    let (b, _) = figure();
    for (u, v) in [(0.2, 0.3), (0.7, 0.9), (0.05, 0.5), (0.5, 0.5)] {
        let p = b.point(u, v) + b.normal(u, v) * 0.01;
        assert!((lofting::surface::closest(&b, p).distance - 0.01).abs() < 1e-9, "{u} {v}");
    }
}

/// Beside poles one parameter moves the point by next to nothing: whatever side the point is on, the foot is found.
#[test]
fn nearest_points_beside_poles() {
    let t = tolerance();
    let z = Axis { about: DVec3::ZERO, direction: DVec3::Z };
    let mut state = 5_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut tried = 0;
    for case in 0..60 {
        // A profile from a rim to the axis, which it meets steeply, flatly or squarely.
        let tip = 40.0 * random() - 20.0;
        let ends = [DVec3::X * (1.0 + 9.0 * random()), DVec3::Z * tip];
        let through = DVec3::new(ends[0].x * (0.2 + 0.6 * random()), 0.0, tip * random() + random());
        let points = if case % 3 == 0 { ends.to_vec() } else { vec![ends[0], through, ends[1]] };
        let profile = if case % 3 == 0 {
            line(ends[0], ends[1], Origin::NONE)
        } else {
            spline(&points, &Spline { start: Ends::Natural, end: Ends::Natural, closed: false }, Origin::NONE)
        };
        let profile = Chain::of_curve(&profile.unwrap());
        let profile = if case % 2 == 0 { profile } else { profile.reversed() };
        let angle = if case % 4 < 2 { std::f64::consts::TAU } else { 2.0 };
        let Ok(face) = revolve(&profile, &z, angle, Origin::NONE, &t) else { continue };
        tried += 1;
        let scale = [1.0, 1e-3, 1e3][case % 3];
        let face = face.moved(&Motion::scaling(DVec3::ONE, scale)).moved(&Motion::translation(DVec3::new(3.0, 2.0, 1.0) * scale));
        let (nearest, at_start) = (Nearest::new(&face), case % 2 == 1);
        for _ in 0..40 {
            // The foot lies on the surface, so the distance is at most the height above it.
            let (u, near) = (random(), 10f64.powf(-4.0 * random()));
            let v = if at_start { near } else { 1.0 - near };
            let height = near * 10f64.powf(-3.0 * random()) * scale * (if random() < 0.5 { 1.0 } else { -1.0 });
            let p = face.point(u, v) + face.normal(u, v) * height;
            let found = nearest.at(p);
            assert!(found.distance <= height.abs() + 1e-9 * scale, "case {case}, ({u}, {v}), {height} above: {} found", found.distance);
        }
    }
    assert!(tried >= 40, "{tried} profiles keep off the axis");
}
