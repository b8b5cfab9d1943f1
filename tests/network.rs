//! The curve network and chains against reference numbers, and what must never change them.

use glam::DVec3;
use lofting::base::fault::Fault;
use lofting::base::job::Job;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build;
use lofting::geometry::{Curve, Kind, Motion};
use lofting::network::flow_detection::detect;
use lofting::network::{Chain, ChainFlow, Flow, FlowFault, FlowOptions, Input, Network, NodeList, Run, meet, meet_once, of_chains};

#[path = "../benches/shared/nets.rs"]
mod nets;
use serde_json::Value;

use crate::support::reference::reference;

const O: Origin = Origin::NONE;

fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn point(value: &Value) -> DVec3 {
    let at = |k: usize| number(&value[k]);
    p(at(0), at(1), at(2))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
}

fn line(a: DVec3, b: DVec3) -> Curve {
    build::line(a, b, O).unwrap()
}

fn inputs(curves: &[(&str, Curve)]) -> Vec<Input> {
    curves.iter().map(|(name, curve)| Input { name: (*name).to_owned(), curve: curve.clone(), cuts: Vec::new() }).collect()
}

fn network_with(inputs: Vec<Input>, points: &[DVec3], tolerance: &Tolerance) -> (Network, Vec<Fault>) {
    let mut sink = Vec::new();
    let network = Network::build(inputs, points, tolerance, &Job::new(), &mut sink).unwrap();
    network.check().unwrap();
    (network, sink)
}

fn network(curves: &[(&str, Curve)]) -> Network {
    network_with(inputs(curves), &[], &tolerance()).0
}

fn tolerance() -> Tolerance {
    Tolerance::new(1e-6, 20.0)
}

fn codes(sink: &[Fault]) -> Vec<&'static str> {
    sink.iter().map(|f| f.code().0).collect()
}

/// The ten curves of the reference structure.
fn structure() -> Vec<(&'static str, Curve)> {
    vec![
        ("c1", line(p(0., 0., 0.), p(8., 0., 0.))),
        ("c2", line(p(0., 6., 0.), p(4., 6., 2.))),
        ("c3", line(p(4., 6., 2.), p(8., 6., 0.))),
        ("c4", line(p(0., 0., 0.), p(0., 3., 1.5))),
        ("c5", line(p(0., 3., 1.5), p(0., 6., 0.))),
        ("c6", line(p(8., -6., -3.), p(8., 3., 1.5))),
        ("c7", line(p(8., 3., 1.5), p(8., 6., 0.))),
        ("c8", build::arc_through(p(4., -2., -4.), p(4., 6., 2.), p(4., 0., 0.), O).unwrap()),
        ("c9", line(p(4., -2., -4.), p(4., -5., -6.))),
        ("c10", line(p(4., -5., -6.), p(8., -6., -3.))),
    ]
}

/// Everything about a network that must not depend on order: node points, and per curve by name its node points and link owners.
fn canonical(network: &Network) -> Vec<String> {
    let mut lines: Vec<String> =
        network.nodes.iter().zip(network.link_ends()).map(|(n, ends)| format!("node {:?} {}", n.point.to_array(), ends.len())).collect();
    for net in &network.curves {
        let nodes: Vec<[f64; 3]> = net.nodes.iter().map(|n| network.nodes[n.index()].point.to_array()).collect();
        let owners: Vec<(&str, bool)> =
            net.links.iter().map(|&(l, against)| (network.curves[network.links[l.index()].curve.index()].name.as_str(), against)).collect();
        lines.push(format!("{} {nodes:?} {:?} {owners:?}", net.name, net.stations));
    }
    lines.sort();
    lines
}

fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn shuffled<T: Clone>(items: &[T], next: &mut impl FnMut() -> f64) -> Vec<T> {
    let mut items = items.to_vec();
    for k in (1..items.len()).rev() {
        items.swap(k, (next() * (k + 1) as f64) as usize);
    }
    items
}

/// A tangle with everything in it: crossings, tangency, shared runs, rings, a node of many curves, a curve that crosses itself.
fn tangle() -> Vec<(&'static str, Curve)> {
    let mut curves = structure();
    let loop_points = [p(-4., -4., 0.), p(2., 2., 0.), p(-4., 2., 0.), p(2., -4., 0.)];
    curves.extend([
        ("ring", build::circle(p(4., 0., 0.), 4.0, p(0., 0., 1.), O).unwrap()),
        ("alone", build::circle(p(40., 0., 0.), 1.0, p(0., 0., 1.), O).unwrap()),
        ("over", line(p(2., 0., 0.), p(12., 0., 0.))),
        ("back", line(p(9., 0., 0.), p(5., 0., 0.))),
        ("touch", line(p(0., 4., 0.), p(9., 4., 0.))),
        ("knot", build::polyline(&loop_points, false, O).unwrap()),
        ("spoke", line(p(4., 0., 0.), p(4., 0., 9.))),
        ("wave", build::spline(&[p(0., -1., 0.), p(2., 1., 0.), p(4., -1., 0.), p(6., 1., 0.)], &SPLINE, O).unwrap()),
    ]);
    curves
}

const SPLINE: build::Spline = build::Spline { start: build::Ends::Natural, end: build::Ends::Natural, closed: false };

#[test]
fn figure_2_2_has_13_links_and_11_nodes() {
    let figure = reference("figure_2_2");
    let network = network(&structure());
    assert_eq!((network.curves.len(), network.links.len(), network.nodes.len()), (10, 13, 11));
    for (net, expected) in network.curves.iter().zip(figure["curves"].as_array().unwrap()) {
        assert_eq!(net.name, expected["id"].as_str().unwrap());
        assert_eq!(net.links.len() as u64, expected["links"].as_u64().unwrap(), "{}", net.name);
    }
    for expected in figure["nodes"].as_array().unwrap() {
        let expected = point(expected);
        let nearest = network.nodes.iter().map(|n| n.point.distance(expected)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-12, "{expected}: {nearest:e}");
    }
    assert_eq!(network.links.len() + 1 - network.nodes.len(), figure["graph_cycles"].as_u64().unwrap() as usize);
}

#[test]
fn figure_3_1_grows_in_stages() {
    let stages = reference("trim_marking")["stage_counts_figure_3_1"]["nodes_links"].clone();
    let z = p(0., 0., 1.);
    let curves = [
        ("arc", build::arc_center(p(5., 0., 0.), p(10., 0., 0.), std::f64::consts::PI, z, O).unwrap()),
        ("line", line(p(2., -1., 0.), p(2., 8., 0.))),
        ("ellipse", build::ellipse(p(5., 1., 0.), p(6., 0., 0.), p(0., 2., 0.), 0.0, std::f64::consts::PI, O).unwrap()),
    ];
    let mut network = Network::default();
    for (k, input) in inputs(&curves).into_iter().enumerate() {
        let map = network.insert(input, &tolerance(), &Job::new(), &mut Vec::new()).unwrap();
        network.check().unwrap();
        assert_eq!(
            (network.nodes.len() as u64, network.links.len() as u64),
            (stages[k][0].as_u64().unwrap(), stages[k][1].as_u64().unwrap())
        );
        // The old links are covered by new ones of the same curve, end to end.
        if k == 2 {
            assert_eq!(map.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2, 2, 1]);
        }
    }
}

#[test]
fn order_of_insertion_changes_neither_geometry_nor_names() {
    let curves = tangle();
    let expected = canonical(&network(&curves));
    let mut next = random(11);
    for round in 0..50 {
        let order = shuffled(&curves, &mut next);
        let mut network = Network::default();
        for input in inputs(&order) {
            network.insert(input, &tolerance(), &Job::new(), &mut Vec::new()).unwrap();
        }
        network.check().unwrap();
        assert_eq!(canonical(&network), expected, "round {round}");
    }
}

#[test]
fn removing_and_inserting_again_gives_the_same_network() {
    let curves = tangle();
    let built = network(&curves);
    let expected = canonical(&built);
    for k in 0..curves.len() {
        let mut network = built.clone();
        let map = network.remove(network.find(&curves[k].1).unwrap(), &[], &tolerance()).unwrap();
        network.check().unwrap();
        assert_eq!(map.len(), built.links.len());
        let rest: Vec<_> = curves.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, c)| c.clone()).collect();
        assert_eq!(canonical(&network), canonical(&self::network(&rest)), "without {}", curves[k].0);
        network.insert(inputs(&curves[k..=k]).remove(0), &tolerance(), &Job::new(), &mut Vec::new()).unwrap();
        assert_eq!(canonical(&network), expected, "{} again", curves[k].0);
    }
}

#[test]
fn a_curve_in_use_stays_and_names_its_users() {
    let mut network = network(&structure());
    let before = canonical(&network);
    let fault = network.remove(lofting::network::CurveId(3), &[Origin(7), Origin(8)], &tolerance()).unwrap_err();
    assert_eq!(fault.code().0, "E510");
    assert_eq!(canonical(&network), before);
}

#[test]
fn motions_and_scales_keep_the_topology() {
    let curves = tangle();
    let built = network(&curves);
    let topology = |network: &Network| {
        let mut rows: Vec<(usize, usize)> = network.links.iter().map(|l| (l.nodes.0.index(), l.nodes.1.index())).collect();
        rows.extend(network.curves.iter().map(|c| (c.nodes.len(), c.links.len())));
        (network.nodes.len(), rows)
    };
    let mut next = random(5);
    for round in 0..200 {
        let axis = p(next() - 0.5, next() - 0.5, next() - 0.5).normalize();
        let scale = lofting::base::math::pow(10.0, -3.0 + 9.0 * next());
        let motion = Motion::rotation(p(1., 2., 3.), axis, 6.0 * next())
            .then(&Motion::translation(p(next(), next(), next()) * 100.0))
            .then(&Motion::scaling(DVec3::ZERO, scale));
        let moved: Vec<(&str, Curve)> = curves.iter().map(|(name, c)| (*name, c.moved(&motion))).collect();
        let scaled = Tolerance::new(1e-6 * scale, 200.0 * scale);
        let (network, _) = network_with(inputs(&moved), &[], &scaled);
        assert_eq!(topology(&network), topology(&built), "round {round}, scale {scale:e}");
        for (a, b) in built.nodes.iter().zip(&network.nodes) {
            let distance = motion.point(a.point).distance(b.point);
            assert!(distance < 0.5 * scaled.point, "{:.3} tolerances", distance / scaled.point);
        }
    }
}

#[test]
fn shared_runs_belong_to_the_first_by_name() {
    let curves =
        [("b", line(p(0., 0., 0.), p(10., 0., 0.))), ("a", line(p(7., 0., 0.), p(2., 0., 0.))), ("x", line(p(4., -1., 0.), p(4., 1., 0.)))];
    let (network, sink) = network_with(inputs(&curves), &[], &tolerance());
    assert_eq!(codes(&sink), ["N512"]);
    assert_eq!((network.nodes.len(), network.links.len()), (7, 6));
    let owners: Vec<&str> =
        network.curves[0].links.iter().map(|&(l, _)| network.curves[network.links[l.index()].curve.index()].name.as_str()).collect();
    assert_eq!(owners, ["b", "a", "a", "b"]);
    assert_eq!(network.curves[0].links.iter().map(|l| l.1).collect::<Vec<_>>(), [false, true, true, false]);
    assert_eq!(network.curves[1].links.len(), 2);
}

#[test]
fn a_cut_inside_a_shared_run_cuts_both_curves() {
    let mut inputs = inputs(&[("a", line(p(0., 0., 0.), p(10., 0., 0.))), ("b", line(p(2., 0., 0.), p(12., 0., 0.)))]);
    inputs[0].cuts = vec![5.0];
    let (network, _) = network_with(inputs, &[], &tolerance());
    assert_eq!((network.nodes.len(), network.links.len()), (5, 4));
    assert_eq!(network.curves[1].links.len(), 3);
}

#[test]
fn rings_have_a_node_at_their_start_only_when_nothing_meets_them() {
    let ring = || build::circle(p(0., 0., 0.), 2.0, p(0., 0., 1.), O).unwrap();
    let alone = network(&[("ring", ring())]);
    assert_eq!((alone.nodes.len(), alone.links.len(), alone.nodes[0].point), (1, 1, p(2., 0., 0.)));
    let crossed = network(&[("ring", ring()), ("line", line(p(0., -3., 0.), p(0., 3., 0.)))]);
    assert_eq!((crossed.nodes.len(), crossed.links.len()), (4, 5));
    let wrapping = &crossed.links[crossed.curves[0].links[1].0.index()];
    assert!(wrapping.s.1 > crossed.curves[0].curve.length());
    let chain = crossed.link_chain(crossed.curves[0].links[1].0);
    assert!(chain.point(0.5).distance(p(2., 0., 0.)) < 1e-12);
    let mut at_start = inputs(&[("ring", ring())]);
    at_start[0].cuts = vec![0.0, std::f64::consts::PI];
    let (cut, _) = network_with(at_start, &[], &tolerance());
    assert_eq!((cut.nodes.len(), cut.links.len(), cut.curves[0].stations[0]), (2, 2, 0.0));
    // Twice the same ring, begun elsewhere and run backwards: one set of links.
    let twice = network(&[("ring", ring()), ("ring2", build::circle_start(DVec3::ZERO, p(0., 2., 0.), p(0., 0., -1.), O).unwrap())]);
    assert_eq!((twice.nodes.len(), twice.links.len()), (2, 2));
    assert!(twice.curves[1].links.iter().all(|l| l.1));
}

#[test]
fn a_curve_that_crosses_itself_is_split_there() {
    let knot = build::polyline(&[p(0., 0., 0.), p(4., 4., 0.), p(4., 0., 0.), p(0., 4., 0.)], false, O).unwrap();
    let network = network(&[("knot", knot)]);
    assert_eq!((network.nodes.len(), network.links.len()), (3, 3));
    assert_eq!(network.curves[0].nodes[1], network.curves[0].nodes[2]);
}

#[test]
fn declared_points_give_nodes_their_place() {
    let curves = [("a", line(p(0., 0., 0.), p(1., 0., 0.))), ("b", line(p(1., 4e-7, 0.), p(1., 1., 0.)))];
    let declared = p(1., 2e-7, 0.);
    let (network, _) = network_with(inputs(&curves), &[declared, p(5., 5., 5.)], &tolerance());
    assert_eq!(network.nodes.len(), 3);
    assert_eq!(network.nodes[network.node_at(declared, &tolerance()).unwrap().index()].point, declared);
}

#[test]
fn near_misses_are_told_with_their_distance() {
    let miss = |gap: f64, y: f64| {
        let curves = [("a", line(p(0., 0., 0.), p(1., y, 0.))), ("b", line(p(1. + gap, -1., 0.), p(1. + gap, 1., 0.)))];
        network_with(inputs(&curves), &[], &tolerance()).1
    };
    assert_eq!(codes(&miss(5e-6, 0.0)), ["W514"]);
    assert!(miss(5e-6, 0.0)[0].to_string().contains("misses another by 0.000005"), "{}", miss(5e-6, 0.0)[0]);
    assert_eq!(codes(&miss(5e-6, 1.0)), ["W514"]);
    assert!(miss(5e-7, 0.0).is_empty());
    assert!(miss(5e-5, 0.0).is_empty());
    assert!(miss(-5e-6, 0.0).is_empty(), "an overhang is not a miss");
}

#[test]
fn only_free_ends_of_curves_longer_than_the_reach_miss() {
    let faults = |curves: &[(&str, Curve)]| network_with(inputs(curves), &[], &tolerance()).1;
    let wall = ("wall", line(p(1. + 5e-6, -1., 0.), p(1. + 5e-6, 1., 0.)));
    let to_wall = ("a", line(p(0., 0., 0.), p(1., 0., 0.)));
    assert_eq!(codes(&faults(&[to_wall.clone(), wall.clone()])), ["W514"]);
    let joined = ("b", line(p(1., 0., 0.), p(0., 1., 0.)));
    assert!(faults(&[to_wall.clone(), joined, wall.clone()]).is_empty(), "the end is joined to a neighbour");
    let short = |x: f64| ("b", line(p(1. + 5e-6, x, 0.), p(1. + 5e-6, x + 5e-6, 0.)));
    assert!(faults(&[to_wall, short(0.0)]).is_empty(), "too short to be missed");
    assert!(faults(&[short(0.0), ("c", line(p(1. + 1e-5, -1., 0.), p(1. + 1e-5, 1., 0.)))]).is_empty(), "too short to miss");
}

#[test]
fn clusters_wider_than_two_tolerances_are_refused() {
    let curves: Vec<(String, Curve)> =
        (0..5).map(|k| (format!("c{k}"), line(p(8e-7 * f64::from(k), 0., 0.), p(f64::from(k) - 2., 5., 1.)))).collect();
    let inputs = curves.iter().map(|(name, curve)| Input { name: name.clone(), curve: curve.clone(), cuts: Vec::new() }).collect();
    let fault = Network::build(inputs, &[], &tolerance(), &Job::new(), &mut Vec::new()).unwrap_err();
    assert_eq!(fault.code().0, "E506");
}

#[test]
fn curves_of_no_length_are_refused() {
    let dot = inputs(&[("dot", line(p(1., 1., 1.), p(1. + 5e-7, 1., 1.)))]);
    assert_eq!(Network::build(dot, &[], &tolerance(), &Job::new(), &mut Vec::new()).unwrap_err().code().0, "E401");
}

#[test]
fn chains_know_their_links() {
    let network = network(&structure());
    let chain = |k: usize| Chain::of_curve(&network.curves[k].curve);
    let links = |c: &Chain| network.links_of(c, &tolerance()).map(|l| l.into_iter().map(|(l, r)| (l.index(), r)).collect::<Vec<_>>());
    assert_eq!(links(&chain(0)).unwrap(), [(0, false), (1, false)]);
    assert_eq!(links(&chain(0).reversed()).unwrap(), [(1, true), (0, true)]);
    let half = chain(0).slice(0.5, 1.0, &tolerance()).unwrap();
    assert_eq!(links(&half).unwrap(), [(1, false)]);
    assert_eq!(links(&chain(0).slice(0.25, 1.0, &tolerance()).unwrap()), None);
    assert_eq!(links(&Chain::of_curve(&line(p(0., 0., 0.), p(1., 1., 1.)))), None);
    assert_eq!(links(&Chain::join(&[chain(3), chain(4)], O, &tolerance()).unwrap()).unwrap().len(), 2);
}

#[test]
fn chains_of_the_reference_have_its_numbers() {
    let maps = reference("parameter_maps");
    let reference = &maps["modeling_curve_chain"];
    let parabola = build::bezier(&[p(5., 2., 0.), p(5.5, 2., 0.), p(6., 3., 0.)], None, O).unwrap();
    let arc = build::arc_center(p(3., 2., 0.), p(5., 2., 0.), -std::f64::consts::FRAC_PI_2, p(0., 0., 1.), O).unwrap();
    let parts = [Chain::of_curve(&line(DVec3::ZERO, p(3., 0., 0.))), Chain::of_curve(&arc).reversed(), Chain::of_curve(&parabola)];
    let chain = Chain::join(&parts, O, &tolerance()).unwrap();
    assert!((chain.length() / number(&reference["total_length"]) - 1.0).abs() < 1e-12);
    for (joint, expected) in chain.joints().iter().zip(reference["t_joint"].as_array().unwrap()) {
        assert!((joint - number(expected)).abs() < 1e-12);
    }
    for sample in reference["samples"].as_array().unwrap() {
        let f = number(&sample["t"]);
        let (run, s) = chain.locate(f);
        let link = sample["link"].as_u64().unwrap() as usize;
        assert_eq!(run + 1, link, "{f}");
        let curve = &chain.runs()[run].curve;
        assert!((s / curve.length() - number(&sample["r"])).abs() < 1e-12, "{f}");
        assert!(chain.point(f).distance(point(&sample["point"])) < 1e-12, "{f}");
    }
    // One curve with the same points, and the same when moved.
    let curve = chain.to_curve().unwrap();
    assert_eq!(curve.kind(), Kind::Composite);
    let motion = Motion::scaling(DVec3::ONE, 3.0);
    let moved = chain.moved(&motion);
    for k in 0..=20 {
        let f = f64::from(k) / 20.0;
        assert!(Chain::of_curve(&curve).point(f).distance(chain.point(f)) < 1e-12);
        assert!(moved.point(f).distance(motion.point(chain.point(f))) < 1e-12);
    }
}

#[test]
fn a_link_of_a_split_curve_has_the_numbers_of_the_reference() {
    let reference = reference("parameter_maps")["link_of_curve"].clone();
    let helix = build::helix(DVec3::ZERO, p(0., 0., 1.), p(2., 0., 0.), std::f64::consts::PI, 2.0, O).unwrap();
    let length = helix.length();
    let mut inputs = inputs(&[("helix", helix)]);
    inputs[0].cuts = vec![0.2 * length, 0.5 * length];
    let (network, _) = network_with(inputs, &[], &tolerance());
    assert_eq!(network.links.len(), 3);
    let chain = network.link_chain(network.curves[0].links[1].0);
    assert!((chain.length() / length - 0.3).abs() < 1e-12);
    let _: &Run = &chain.runs()[0];
    assert!((chain.locate(0.25).1 / length - number(&reference["curve_s"])).abs() < 1e-12);
}

/// Node lists of a reference case, in the order of the letters given.
fn case(name: &str, order: &[&str]) -> (Vec<NodeList>, Value) {
    let types = reference("flow_types");
    let case = types["detection_cases"].as_array().unwrap().iter().find(|c| c["name"] == name).unwrap().clone();
    assert_eq!(order.len(), case["node_lists"].as_object().unwrap().len(), "{name}");
    let letters = |key: &str| -> Vec<usize> {
        case["node_lists"][key].as_array().unwrap().iter().map(|n| usize::from(n.as_str().unwrap().as_bytes()[0])).collect()
    };
    (order.iter().map(|key| NodeList::evenly(&letters(key))).collect(), case)
}

fn found(name: &str, order: &[&str], options: &FlowOptions) -> Flow {
    let (lists, case) = case(name, order);
    let flow = detect(&lists, options).unwrap_or_else(|fault| panic!("{name}: {fault:?}"));
    if let (Some(m), Some(n)) = (case["orders"]["M"].as_u64(), case["orders"]["N"].as_u64())
        && *options == FlowOptions::default()
    {
        assert_eq!(flow.orders(), (m as usize, n as usize), "{name}");
    }
    flow
}

#[test]
fn the_twelve_flow_cases() {
    let plain = FlowOptions::default();
    let phrase = |name: &str, order: &[&str]| found(name, order, &plain).phrase();
    assert_eq!(phrase("quadrilateral bilinear", &["a", "b", "c", "d"]), "quadrilateral");
    assert_eq!(phrase("linear-quadratic", &["q0", "p0", "p1", "p2", "q1"]), "quadrilateral");
    assert_eq!(phrase("triangle", &["a", "b", "c"]), "uniform trilateral");
    assert_eq!(phrase("fan", &["m0", "m1", "m2", "e"]), "degenerate trilateral");
    assert_eq!(phrase("lune", &["m0", "m1"]), "degenerate bilateral");
    assert_eq!(phrase("lune with equator", &["m0", "m1", "m2", "e"]), "degenerate bilateral");
    assert_eq!(phrase("tube", &["r0", "r1", "l0", "l1", "l2"]), "quadrilateral closed in u");
    assert_eq!(phrase("cap", &["m0", "m1", "m2", "e"]), "degenerate trilateral closed in u");
    assert_eq!(phrase("globe", &["m0", "m1", "m2", "e"]), "degenerate bilateral closed in u");
    assert_eq!(phrase("two meridians, closure asked by lists only", &["m0", "m1"]), "degenerate bilateral");
    assert_eq!(phrase("torus", &["r0", "r1", "l0", "l1"]), "quadrilateral closed in u and v");
    let (lists, _) = case("missing middle node", &["p0", "p1", "p2", "q0", "q1"]);
    assert_eq!(detect(&lists, &plain), Err(FlowFault::Incomplete { a: 1, b: 4, found: 5, wanted: 6 }));
}

#[test]
fn poles_words_and_closure_decide_what_node_lists_cannot() {
    let pole = FlowOptions { pole: Some(usize::from(b'A')), ..FlowOptions::default() };
    let flow = found("triangle", &["a", "b", "c"], &pole);
    assert_eq!((flow.phrase().as_str(), flow.poles), ("degenerate trilateral", (Some(usize::from(b'A')), None)));
    assert_eq!((flow.along_u[0].curve, flow.along_v.len()), (1, 2));
    let words = FlowOptions { along_u: vec![1], along_v: vec![0, 2], ..FlowOptions::default() };
    assert_eq!(found("triangle", &["a", "b", "c"], &words).phrase(), "degenerate trilateral");
    let closed = FlowOptions { closed: true, ..FlowOptions::default() };
    let lunes = found("lune", &["m0", "m1"], &closed);
    assert_eq!((lunes.phrase().as_str(), lunes.orders()), ("degenerate bilateral closed in u", (2, 1)));
    let (lists, _) = case("quadrilateral bilinear", &["a", "b", "c", "d"]);
    assert!(matches!(detect(&lists, &closed), Err(FlowFault::NotClosed { .. })));
    assert!(detect(&lists, &pole).is_err());
}

#[test]
fn a_flow_depends_on_its_first_curve_alone() {
    // A 3 × 4 grid with every curve in any direction: columns of nodes 0..4, rows of nodes 0..3.
    let node = |i: usize, j: usize| 10 * j + i;
    let mut curves: Vec<Vec<usize>> = (0..3).map(|j| (0..4).map(|i| node(i, j)).collect()).collect();
    curves.extend((0..4).map(|i| (0..3).map(|j| node(i, j)).collect::<Vec<_>>()));
    let first = curves[0].clone();
    let mut next = random(3);
    for _ in 0..100 {
        let mut rest = shuffled(&curves[1..], &mut next);
        for list in &mut rest {
            if next() < 0.5 {
                list.reverse();
            }
        }
        rest.insert(0, first.clone());
        let lists: Vec<NodeList> = rest.iter().map(|l| NodeList::evenly(l)).collect();
        let flow = detect(&lists, &FlowOptions::default()).unwrap();
        let oriented = |curve: usize, reversed: bool| {
            let mut nodes = rest[curve].clone();
            if reversed {
                nodes.reverse();
            }
            nodes
        };
        let rows: Vec<Vec<usize>> = flow.along_u.iter().map(|m| oriented(m.curve, m.reversed)).collect();
        let columns: Vec<Vec<usize>> = flow.along_v.iter().map(|m| oriented(m.curve, m.reversed)).collect();
        assert_eq!(rows, curves[..3]);
        assert_eq!(columns, curves[3..]);
    }
}

fn chains(curves: &[Curve]) -> Vec<Chain> {
    curves.iter().map(Chain::of_curve).collect()
}

fn flow(chains: &[Chain]) -> Flow {
    of_chains(chains, &ChainFlow::default(), &tolerance()).unwrap().0
}

#[test]
fn crossings_carry_raw_fractions_and_flags() {
    let numbers = reference("parameter_maps")["grid_parameters"].clone();
    let mut curves = vec![line(p(0., 0., 0.), p(4., 0., 0.)), line(p(0., 1., 0.), p(4., 1., 0.)), line(p(4., 2., 0.), p(0., 2., 0.))];
    curves.push(line(p(0., 0., 0.), p(0., 2., 0.)));
    // The middle curve passes the three at x = 1, 2 and 3.
    curves.push(build::polyline(&[p(1., 0., 0.), p(2., 1., 0.), p(3., 2., 0.)], false, O).unwrap());
    curves.push(line(p(4., 2., 0.), p(4., 0., 0.)));
    let flow = flow(&chains(&curves));
    assert_eq!((flow.phrase().as_str(), flow.orders()), ("quadrilateral", (2, 2)));
    for (n, member) in flow.along_u.iter().enumerate() {
        assert!((member.crossings[1] - number(&numbers["raw_s_1n"][n])).abs() < 1e-12);
        assert_eq!(u64::from(member.reversed), numbers["Q"][n].as_u64().unwrap());
    }
    assert_eq!(flow.along_v.iter().map(|m| (m.curve, m.reversed)).collect::<Vec<_>>(), [(3, false), (4, false), (5, true)]);
    assert!(flow.overhangs.is_empty());
}

#[test]
fn the_surfaces_of_figure_2_2_are_quadrilateral() {
    let c = chains(&structure().into_iter().map(|(_, c)| c).collect::<Vec<_>>());
    let t = tolerance();
    let join = |parts: &[Chain]| Chain::join(parts, O, &t).unwrap();
    let arc_at = meet_once(&c[7], &c[0], &t).unwrap().fa;
    let c6_at = meet_once(&c[5], &c[0], &t).unwrap().fa;
    let upper_arc = c[7].slice(arc_at, 1.0, &t).unwrap();
    let (lower_c6, upper_c6) = (c[5].slice(0.0, c6_at, &t).unwrap(), c[5].slice(c6_at, 1.0, &t).unwrap());
    let b = [
        c[0].clone(),
        join(&[c[1].clone(), c[2].clone()]),
        join(&[c[3].clone(), c[4].clone()]),
        upper_arc,
        join(&[upper_c6, c[6].clone()]),
    ];
    let found = flow(&b);
    assert_eq!((found.phrase().as_str(), found.orders()), ("quadrilateral", (2, 1)));
    assert!((found.along_u[0].crossings[1] - 0.5).abs() < 1e-12);
    let lower_arc = c[7].slice(0.0, arc_at, &t).unwrap();
    let a = [c[0].slice(0.5, 1.0, &t).unwrap(), c[9].clone(), lower_c6, join(&[lower_arc.reversed(), c[8].clone()])];
    assert_eq!(flow(&a).phrase(), "quadrilateral");
}

#[test]
fn boundaries_that_miss_say_by_how_much() {
    let square = |gap: f64| {
        chains(&[
            line(p(0., 0., 0.), p(4., 0., 0.)),
            line(p(4., 0., 0.), p(4., 4., 0.)),
            line(p(4., 4., 0.), p(0., 4., 0.)),
            line(p(0., 4., 0.), p(gap, 0., 0.)),
        ])
    };
    assert!(of_chains(&square(0.0), &ChainFlow::default(), &tolerance()).is_ok());
    // Along the first curve the gap closes by itself: the curve only overhangs.
    let overhang = flow(&square(0.3));
    assert_eq!(overhang.overhangs.len(), 1);
    assert!((overhang.overhangs[0].piece.1 - 0.075).abs() < 1e-12);
    let fault = of_chains(&square(-0.3), &ChainFlow::default(), &tolerance()).unwrap_err();
    assert_eq!(fault.code().0, "E501");
    assert!(fault.to_string().contains("miss each other by 0.300000 at (0.000000, 0.000000, 0.000000)"), "{fault}");
    // Two corners open.
    let mut loose = square(-0.3);
    loose[1] = Chain::of_curve(&line(p(4.2, 0., 0.), p(4., 4., 0.)));
    assert_eq!(of_chains(&loose, &ChainFlow::default(), &tolerance()).unwrap_err().code().0, "E501");
    // An inner curve that ends short of a border.
    let mut short = square(0.0);
    short.push(Chain::of_curve(&line(p(2., 0., 0.), p(2., 3.7, 0.))));
    let fault = of_chains(&short, &ChainFlow::default(), &tolerance()).unwrap_err();
    assert_eq!(fault.code().0, "E602");
    assert!(fault.to_string().contains("0.3"), "{fault}");
}

#[test]
fn overhanging_ends_are_trimmed_to_the_border() {
    let hash = chains(&[
        line(p(-1., 0., 0.), p(5., 0., 0.)),
        line(p(-1., 4., 0.), p(5., 4., 0.)),
        line(p(0., -1., 0.), p(0., 5., 0.)),
        line(p(4., -1., 0.), p(4., 5., 0.)),
    ]);
    let flow = flow(&hash);
    assert_eq!((flow.phrase().as_str(), flow.overhangs.len()), ("quadrilateral", 8));
}

#[test]
fn rings_run_the_same_way_whatever_was_drawn() {
    let z = p(0., 0., 1.);
    let low = build::circle(DVec3::ZERO, 2.0, z, O).unwrap();
    let seam = line(p(2., 0., 0.), p(2., 0., 5.));
    for (normal, reversed) in [(z, false), (-z, true)] {
        let high = build::circle_start(p(0., 0., 5.), p(0., 2., 5.), normal, O).unwrap();
        let flow = flow(&chains(&[low.clone(), high, seam.clone()]));
        assert_eq!((flow.phrase().as_str(), flow.orders()), ("quadrilateral closed in u", (1, 1)));
        assert_eq!(flow.along_u.iter().map(|m| m.reversed).collect::<Vec<_>>(), [false, reversed]);
        let other_seam = line(p(-2., 0., 5.), p(-2., 0., 0.));
        let high = build::circle_start(p(0., 0., 5.), p(0., 2., 5.), normal, O).unwrap();
        let flow = self::flow(&chains(&[low.clone(), seam.clone(), other_seam, high]));
        assert_eq!(flow.along_u.iter().map(|m| m.reversed).collect::<Vec<_>>(), [false, reversed]);
        assert_eq!(flow.along_v.iter().map(|m| m.reversed).collect::<Vec<_>>(), [false, true]);
    }
}

#[test]
fn a_named_pole_must_be_one() {
    let arc = |a: DVec3, b: DVec3| build::arc_center(DVec3::ZERO, a, std::f64::consts::FRAC_PI_2, a.cross(b), O).unwrap();
    let (x, y, z) = (p(1., 0., 0.), p(0., 1., 0.), p(0., 0., 1.));
    let octant = chains(&[arc(x, y), arc(y, z), arc(z, x)]);
    assert_eq!(flow(&octant).phrase(), "uniform trilateral");
    let with_pole = |pole| of_chains(&octant, &ChainFlow { pole: Some(pole), ..ChainFlow::default() }, &tolerance());
    let (found, nodes) = with_pole(z).unwrap();
    assert_eq!(found.phrase(), "degenerate trilateral");
    assert!(nodes[found.poles.0.unwrap()].distance(z) < 1e-12);
    // The pole is v = 0: the arc from y to z runs against +v, the one from z to x with it.
    assert_eq!(found.along_v.iter().map(|m| (m.curve, m.reversed)).collect::<Vec<_>>(), [(2, false), (1, true)]);
    assert_eq!(with_pole(p(0.5, 0.5, 0.5)).unwrap_err().code().0, "E601");
}

#[test]
fn meetings_are_ordered_and_each_node_is_one() {
    let t = tolerance();
    let circle = Chain::of_curve(&build::circle(DVec3::ZERO, 2.0, p(0., 0., 1.), O).unwrap());
    let chord = Chain::of_curve(&line(p(3., 0., 0.), p(-3., 0., 0.)));
    let found = meet(&chord, &circle, &t).unwrap();
    assert_eq!(found.iter().map(|m| m.fb).collect::<Vec<_>>(), [0.0, 0.5]);
    assert!(found[0].fa < found[1].fa && found.iter().all(|m| !m.tangent));
    assert_eq!(meet_once(&chord, &circle, &t).unwrap_err().code().0, "E508");
    let tangent = Chain::of_curve(&line(p(-3., 2., 0.), p(3., 2., 0.)));
    let touch = meet_once(&tangent, &circle, &t).unwrap();
    assert!(touch.tangent && touch.point.distance(p(0., 2., 0.)) < 1e-6);
    let far = Chain::of_curve(&line(p(-3., 2.5, 0.), p(3., 2.5, 0.)));
    let fault = meet_once(&far, &circle, &t).unwrap_err();
    assert_eq!(fault.code().0, "E507");
    assert!(fault.to_string().ends_with("0.500000 apart"), "{fault}");
    let over = Chain::of_curve(&line(p(2., 2., 0.), p(9., 2., 0.)));
    assert_eq!(meet_once(&tangent, &over, &t).unwrap_err().code().0, "E509");
    // A corner of a chain that lies on another curve is one meeting, at the corner.
    let corner =
        Chain::join(&[Chain::of_curve(&line(p(-1., 0., 0.), p(0., 2., 0.))), Chain::of_curve(&line(p(0., 2., 0.), p(1., 0., 0.)))], O, &t)
            .unwrap();
    let found = meet_once(&corner, &tangent, &t).unwrap();
    assert_eq!(found.point, p(0., 2., 0.));
}

#[test]
fn runs_of_one_curve_meet_where_they_join() {
    let t = tolerance();
    let circle = Chain::of_curve(&build::circle(DVec3::ZERO, 2.0, p(0., 0., 1.), O).unwrap());
    let (a, b) = (circle.slice(0.875, 0.25, &t).unwrap(), circle.slice(0.25, 0.5, &t).unwrap());
    let joint = meet_once(&a, &b, &t).unwrap();
    assert!(joint.point.distance(p(0., 2., 0.)) < 1e-12 && joint.fa == 1.0 && joint.fb == 0.0);
    let c = circle.slice(0.125, 0.375, &t).unwrap();
    assert_eq!(meet_once(&a, &c, &t).unwrap_err().code().0, "E509");
    assert_eq!(meet(&a, &c, &t).unwrap().len(), 1);
    assert!(meet(&b, &circle.slice(0.625, 0.75, &t).unwrap(), &t).unwrap().is_empty());
}

#[test]
fn networks_of_known_size_are_counted_exactly() {
    type Case = (fn(usize) -> Vec<Input>, usize, (usize, usize));
    let cases: [Case; 5] = [
        (nets::planar, 30, (372, 654)),
        (nets::planar, 100, (4_027, 7_754)),
        (nets::ruled, 10, (310, 530)),
        (nets::ruled, 33, (2_921, 5_545)),
        (nets::row, 2_000, (2_001, 2_000)),
    ];
    for (make, n, expected) in cases {
        let (network, sink) = network_with(make(n), &[], &Tolerance::new(1e-4, 200.0));
        assert_eq!((network.nodes.len(), network.links.len()), expected, "{n}");
        assert!(codes(&sink).iter().all(|c| *c == "W514"));
    }
    let (scattered, _) = network_with(nets::scattered(1_000), &[], &Tolerance::new(1e-7, 1414.0));
    assert_eq!(scattered.links.len() + 2_000, 1_000 + 2 * scattered.nodes.len() - 2_000, "each crossing adds a node and two links");
}

/// The largest ones of `cargo bench --bench network`, at its tolerance.
#[test]
fn large_networks_are_counted_exactly() {
    type Case = (fn(usize) -> Vec<Input>, usize, f64, (usize, usize));
    let cases: [Case; 2] = [(nets::planar, 300, 141.0, (34_464, 68_028)), (nets::ruled, 100, 245.0, (25_600, 50_300))];
    for (make, n, diagonal, expected) in cases {
        let (network, _) = network_with(make(n), &[], &Tolerance::new(1e-8 * diagonal, diagonal));
        assert_eq!((network.nodes.len(), network.links.len()), expected, "{n}");
    }
}

#[test]
fn derivatives_of_chains_are_by_arc_length() {
    let ellipse = build::ellipse(p(5., 1., 0.), p(6., 0., 0.), p(0., 2., 0.), 0.0, 2.0, O).unwrap();
    let spline = build::spline(&[ellipse.end(), p(3., 5., 1.), p(1., 6., 2.), p(0., 9., 0.)], &SPLINE, O).unwrap();
    let arc = build::arc_through(p(20., 0., 0.), ellipse.start(), p(15., 4., 0.), O).unwrap();
    let parts = [Chain::of_curve(&arc), Chain::of_curve(&ellipse.reversed()).reversed(), Chain::of_curve(&spline)];
    let chain = Chain::join(&parts, O, &tolerance()).unwrap();
    for chain in [chain.clone(), chain.reversed()] {
        let (h, length) = (1e-5, chain.length());
        for k in 1..60 {
            let f = f64::from(k) / 60.0;
            if chain.joints().iter().any(|j| (j - f).abs() <= h) {
                continue;
            }
            let (jet, before, after) = (chain.jet(f), chain.jet(f - h), chain.jet(f + h));
            assert!((jet.d1.length() / length - 1.0).abs() < 1e-12, "constant speed at {f}");
            assert!(jet.d1.distance((after.p - before.p) / (2.0 * h)) < 1e-6 * length, "first derivative at {f}");
            assert!(jet.d2.distance((after.d1 - before.d1) / (2.0 * h)) < 1e-4 * length * length, "second derivative at {f}");
        }
        for &joint in &chain.joints()[1..3] {
            let before = chain.jet(joint - 1e-9);
            assert!(chain.jet_before(joint).d1.distance(before.d1) < 1e-6 * length);
        }
    }
}
