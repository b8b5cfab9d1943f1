//! The surface model and mapped meshes: topology, conformity, limits, and the same bytes on any number of threads.

use std::collections::BTreeSet;

use glam::DVec3;
use lofting::base::fault::{Fault, PlainWords};
use lofting::base::job::Job;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_through, circle, line, polyline, spline};
use lofting::geometry::{Curve, Ends, Spline};
use lofting::mesh::pipeline::build::build;
use lofting::mesh::request::settings::RuleSettings;
use lofting::mesh::{Built, Elements, Input, Mesh, Plan, Rule, Target};
use lofting::model::topology::Named;
use lofting::model::{Model, ShellRequest, SurfaceId};
use lofting::network::flow_chains::{ChainFlow, of_chains};
use lofting::network::graph::Input as NetInput;
use lofting::network::{Chain, Network};
use lofting::surface::blended::coons::{self, BlendMethod, CoonsSettings, Grid};
use lofting::surface::swept::revolve::{axis_of, revolve};
use lofting::surface::{Reparam, Surface};

use crate::support::invariants;

fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn tolerance() -> Tolerance {
    Tolerance::new(1e-5, 10.0)
}

fn straight(a: DVec3, b: DVec3) -> Curve {
    line(a, b, Origin::NONE).unwrap()
}

fn curved(points: &[DVec3]) -> Curve {
    spline(points, &Spline { start: Ends::Natural, end: Ends::Natural, closed: false }, Origin::NONE).unwrap()
}

fn chain(curve: &Curve) -> Chain {
    Chain::of_curve(curve)
}

fn over(chains: &[Chain], method: BlendMethod) -> Surface {
    let (flow, nodes) = of_chains(chains, &ChainFlow::default(), &tolerance()).unwrap();
    let poles = (flow.poles.0.map(|n| nodes[n]), flow.poles.1.map(|n| nodes[n]));
    let settings = CoonsSettings { method, reparam: Reparam::Smooth, origin: Origin::NONE };
    coons::build(&Grid { chains, flow: &flow, poles }, &settings, &tolerance()).unwrap().0
}

fn coons_of(chains: &[Chain]) -> Surface {
    over(chains, BlendMethod::Coons)
}

/// Curves in a network, surfaces over them, glued.
struct Scene {
    network: Network,
    model: Model,
}

impl Scene {
    fn new(curves: &[Curve], surfaces: Vec<Surface>) -> Self {
        let inputs =
            curves.iter().enumerate().map(|(k, c)| NetInput { name: format!("c{}", k + 1), curve: c.clone(), cuts: Vec::new() }).collect();
        let network = Network::build(inputs, &[], &tolerance(), &Job::new(), &mut Vec::new()).unwrap();
        network.check().unwrap();
        let named = surfaces.into_iter().enumerate().map(|(k, surface)| Named { name: format!("s{}", k + 1), surface }).collect();
        let model = Model::build(named, &network, &tolerance(), &Job::new()).unwrap();
        model.check().unwrap();
        Self { network, model }
    }

    fn plan(&self) -> Plan {
        Plan::of("m", (0..self.model.surfaces.len()).map(|k| (SurfaceId::at(k), false)).collect())
    }

    fn mesh(&self, plan: &Plan) -> Result<(Built, Vec<Fault>), Fault> {
        let mut sink = Vec::new();
        let input = Input { plan, model: &self.model, network: &self.network, tolerance: &tolerance() };
        build(&input, &Job::new(), &mut sink).map(|built| (built, sink))
    }

    fn sound(&self, plan: &Plan) -> Mesh {
        let mesh = self.mesh(plan).unwrap_or_else(|f| panic!("{f}")).0.mesh;
        check_mesh(&mesh);
        mesh
    }
}

/// Polygons of a mesh, corner nodes only.
fn cells(mesh: &Mesh) -> Vec<Vec<u32>> {
    mesh.triangles.iter().map(|t| t.to_vec()).chain(mesh.quads.iter().map(|q| q.to_vec())).collect()
}

/// Free edges and the Euler number of a mesh that is sound.
fn edges_of(mesh: &Mesh) -> (usize, i64) {
    let edges = invariants::edges(mesh);
    let used: BTreeSet<u32> = edges.keys().flat_map(|(a, b)| [*a, *b]).collect();
    let free = edges.values().filter(|ways| ways.len() == 1).count();
    (free, used.len() as i64 - edges.len() as i64 + cells(mesh).len() as i64)
}

/// Everything that holds for every mesh.
fn check_mesh(mesh: &Mesh) {
    edges_of(mesh);
    // No two nodes in one place.
    let mut order: Vec<usize> = (0..mesh.nodes.len()).collect();
    order.sort_by(|a, b| mesh.nodes[*a].x.total_cmp(&mesh.nodes[*b].x));
    for (k, a) in order.iter().enumerate() {
        for b in order[k + 1..].iter().take_while(|b| mesh.nodes[**b].x - mesh.nodes[*a].x < 1e-9) {
            assert!(mesh.nodes[*a].distance(mesh.nodes[*b]) > 1e-9, "nodes {a} and {b} are one");
        }
    }
}

fn area(mesh: &Mesh) -> f64 {
    let node = |n: u32| mesh.nodes[n as usize];
    let triangle = |a: u32, b: u32, c: u32| 0.5 * (node(b) - node(a)).cross(node(c) - node(a)).length();
    mesh.triangles.iter().map(|t| triangle(t[0], t[1], t[2])).sum::<f64>()
        + mesh.quads.iter().map(|q| triangle(q[0], q[1], q[2]) + triangle(q[0], q[2], q[3])).sum::<f64>()
}

fn counts(scene: &Scene) -> (usize, usize, usize) {
    (scene.model.patches.len(), scene.model.edges.len(), scene.model.vertices.len())
}

/// A unit square of straight lines, shifted and scaled.
fn square(at: DVec3, size: f64) -> [Curve; 4] {
    let [a, b, c, d] = [p(0., 0., 0.), p(1., 0., 0.), p(1., 1., 0.), p(0., 1., 0.)].map(|q| at + q * size);
    [straight(a, b), straight(b, c), straight(d, c), straight(a, d)]
}

fn figure_2_2() -> Scene {
    let c = [
        straight(p(0., 0., 0.), p(8., 0., 0.)),
        straight(p(0., 6., 0.), p(4., 6., 2.)),
        straight(p(4., 6., 2.), p(8., 6., 0.)),
        straight(p(0., 0., 0.), p(0., 3., 1.5)),
        straight(p(0., 3., 1.5), p(0., 6., 0.)),
        straight(p(8., -6., -3.), p(8., 3., 1.5)),
        straight(p(8., 3., 1.5), p(8., 6., 0.)),
        arc_through(p(4., -2., -4.), p(4., 6., 2.), p(4., 0., 0.), Origin::NONE).unwrap(),
        straight(p(4., -2., -4.), p(4., -5., -6.)),
        straight(p(4., -5., -6.), p(8., -6., -3.)),
    ];
    let part = |k: usize, f0: f64, f1: f64| chain(&c[k]).slice(f0, f1, &tolerance()).unwrap();
    let join = |parts: &[Chain]| Chain::join(parts, Origin::NONE, &tolerance()).unwrap();
    // Where the arc passes (4, 0, 0), as a share of its length.
    let split = {
        let whole = chain(&c[7]);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if whole.point(middle).z > 0.0 { high = middle } else { low = middle }
        }
        low
    };
    let cross = 6.0 / 9.0;
    let upper = [
        join(&[chain(&c[3]), chain(&c[4])]),
        part(7, split, 1.0),
        join(&[part(5, cross, 1.0), chain(&c[6])]),
        chain(&c[0]),
        join(&[chain(&c[1]), chain(&c[2])]),
    ];
    let lower = [join(&[part(7, split, 0.0), chain(&c[8])]), part(5, cross, 0.0), part(0, 0.5, 1.0), chain(&c[9])];
    // Written first is a curve along u.
    let b = over(&[upper[3].clone(), upper[4].clone(), upper[0].clone(), upper[1].clone(), upper[2].clone()], BlendMethod::Lagrange);
    let a = over(&[lower[2].clone(), lower[3].clone(), lower[0].clone(), lower[1].clone()], BlendMethod::Lagrange);
    Scene::new(&c, vec![b, a])
}

#[test]
fn figure_2_2_has_its_patches_edges_and_vertices() {
    let scene = figure_2_2();
    assert_eq!((scene.network.links.len(), scene.network.nodes.len()), (13, 11));
    assert_eq!(counts(&scene), (6, 18, 13));
    let free = scene.model.vertices.iter().filter(|v| v.node.is_none()).map(|v| v.point);
    let mut free: Vec<DVec3> = free.collect();
    free.sort_by(|a, b| a.x.total_cmp(&b.x));
    assert!(free[0].distance(p(4.0, 2.763932022500211, 1.7082039324993694)) < 1e-9, "{}", free[0]);
    assert!(free[1].distance(p(8.0, -3.347491251019399, -1.6737456255096994)) < 1e-9, "{}", free[1]);
    let shared = scene.model.edges.iter().filter(|e| {
        let mut surfaces: Vec<_> = e.users.iter().map(|(p, _)| scene.model.patches[p.index()].surface).collect();
        surfaces.dedup();
        surfaces.len() == 2
    });
    assert_eq!(shared.count(), 1);
}

#[test]
fn figure_2_2_is_an_open_shell_and_meshes_conform() {
    let scene = figure_2_2();
    let request = ShellRequest {
        name: "hall".to_owned(),
        surfaces: vec![SurfaceId(0), SurfaceId(1)],
        snap: None,
        branches: false,
        touches: false,
        origin: Origin::NONE,
    };
    let mut sink = Vec::new();
    let shell = scene.model.shell(&request, &scene.network, &tolerance(), &mut sink).unwrap();
    assert!(!shell.closed);
    assert_eq!(sink[0].code().0, "N615");
    for elements in [Elements::Triangles, Elements::Quads] {
        let mut plan = scene.plan();
        plan.surfaces = shell.surfaces.clone();
        plan.settings.elements = Some((elements, Origin::NONE));
        plan.settings.size = Some((0.4, Origin::NONE));
        let mesh = scene.sound(&plan);
        assert_eq!(edges_of(&mesh).1, 1, "a disc");
    }
}

#[test]
fn loop_of_a_patch_lies_on_its_edges() {
    let scene = figure_2_2();
    for patch in 0..6 {
        let id = lofting::model::PatchId::at(patch);
        let around = scene.model.loop_of(id);
        let surface = &scene.model.surfaces[scene.model.patches[patch].surface.index()].surface;
        for k in 0..=40 {
            let ((u, v), point) = around.at(f64::from(k) / 40.0);
            assert!(surface.point(u, v).distance(point) < 1e-9);
        }
        let breaks = around.breakpoints();
        assert_eq!(breaks.len(), 5);
        assert!(breaks.windows(2).all(|w| w[0].0 < w[1].0) && breaks[4].0 == 1.0);
    }
}

#[test]
fn kinked_sides_split_a_surface_into_four() {
    let zig = |a: DVec3, m: DVec3, b: DVec3| polyline(&[a, m, b], false, Origin::NONE).unwrap();
    let curves = [
        zig(p(0., 0., 0.), p(1., -0.2, 0.), p(2., 0., 0.)),
        zig(p(2., 0., 0.), p(2.2, 1., 0.), p(2., 2., 0.)),
        zig(p(0., 2., 0.), p(1., 2.2, 0.), p(2., 2., 0.)),
        zig(p(0., 0., 0.), p(-0.2, 1., 0.), p(0., 2., 0.)),
    ];
    let scene = Scene::new(&curves, vec![coons_of(&curves.each_ref().map(chain))]);
    assert_eq!(counts(&scene), (4, 12, 9));
    let mut plan = scene.plan();
    plan.settings.elements = Some((Elements::Quads, Origin::NONE));
    plan.settings.size = Some((0.3, Origin::NONE));
    let mesh = scene.sound(&plan);
    for kink in [p(1., -0.2, 0.), p(2.2, 1., 0.), p(1., 2.2, 0.), p(-0.2, 1., 0.)] {
        assert!(mesh.nodes.iter().any(|n| n.distance(kink) < 1e-9), "a node at the kink {kink}");
    }
}

#[test]
fn neighbours_share_nodes_where_one_side_meets_two() {
    // One wide square above two narrow ones: a non-conformal join.
    let [a, b, c, d] = [p(0., 0., 0.), p(2., 0., 0.), p(2., 1., 0.), p(0., 1., 0.)];
    let wide = [straight(a, b), straight(b, c), straight(d, c), straight(a, d)];
    let (e, f, g, m) = (p(0., -1., 0.), p(1., -1., 0.), p(2., -1., 0.), p(1., 0., 0.));
    let low = [straight(e, f), straight(f, g), straight(e, a), straight(f, m), straight(g, b)];
    let curves: Vec<Curve> = wide.iter().chain(&low).cloned().collect();
    let half = |f0: f64, f1: f64| chain(&wide[0]).slice(f0, f1, &tolerance()).unwrap();
    let surfaces = vec![
        coons_of(&wide.each_ref().map(chain)),
        coons_of(&[half(0.0, 0.5), chain(&low[3]), chain(&low[0]), chain(&low[2])]),
        coons_of(&[half(0.5, 1.0), chain(&low[4]), chain(&low[1]), chain(&low[3])]),
    ];
    let scene = Scene::new(&curves, surfaces);
    let request = ShellRequest {
        name: "s".to_owned(),
        surfaces: (0..3).map(SurfaceId).collect(),
        snap: None,
        branches: false,
        touches: false,
        origin: Origin::NONE,
    };
    let shell = scene.model.shell(&request, &scene.network, &tolerance(), &mut Vec::new()).unwrap();
    let mut plan = scene.plan();
    plan.surfaces = shell.surfaces;
    plan.settings.size = Some((0.3, Origin::NONE));
    let mesh = scene.sound(&plan);
    assert_eq!(edges_of(&mesh).1, 1);
    assert!((area(&mesh) - 4.0).abs() < 1e-9);
    plan.settings.conforming = Some((false, Origin::NONE));
    let apart = scene.mesh(&plan).unwrap().0.mesh;
    assert_eq!(edges_of(&apart).1, 3, "three discs that share nothing");
}

#[test]
fn strips_pass_a_count_on_and_refuse_two() {
    let curves = square(p(0., 0., 0.), 1.0);
    let scene = Scene::new(&curves, vec![coons_of(&curves.each_ref().map(chain))]);
    let mut plan = scene.plan();
    plan.settings.elements = Some((Elements::Quads, Origin::NONE));
    plan.settings.size = Some((0.1, Origin::NONE));
    assert_eq!(scene.sound(&plan).quads.len(), 100);
    let count = |k: usize, n: u32, origin: u32| Rule {
        settings: RuleSettings { count: Some((n, Origin(origin))), ..RuleSettings::default() },
        ..Rule::on(Target::Chain(chain(&curves[k])), Origin(origin))
    };
    plan.rules = vec![count(0, 4, 1)];
    assert_eq!(scene.sound(&plan).quads.len(), 40);
    plan.rules.push(count(2, 6, 2));
    let fault = scene.mesh(&plan).unwrap_err();
    assert_eq!(fault.code().0, "E702");
    let report = fault.describe(&PlainWords);
    assert!(report.labels.iter().any(|l| l.1 == "4 elements") && report.labels.iter().any(|l| l.1 == "6 elements"), "{report:?}");
}

#[test]
fn bias_grows_along_the_curve_and_stays_there() {
    let curves = square(p(0., 0., 0.), 1.0);
    let scene = Scene::new(&curves, vec![coons_of(&curves.each_ref().map(chain))]);
    let mut plan = scene.plan();
    plan.settings.elements = Some((Elements::Quads, Origin::NONE));
    plan.rules = vec![Rule {
        settings: RuleSettings { count: Some((10, Origin(1))), bias: Some((3.0, Origin(1))), ..RuleSettings::default() },
        ..Rule::on(Target::Chain(chain(&curves[0])), Origin(1))
    }];
    let mesh = scene.sound(&plan);
    let on = |y: f64| {
        let mut xs: Vec<f64> = mesh.nodes.iter().filter(|n| (n.y - y).abs() < 1e-12).map(|n| n.x).collect();
        xs.sort_by(f64::total_cmp);
        xs.windows(2).map(|w| w[1] - w[0]).collect::<Vec<_>>()
    };
    assert!((on(0.0)[9] / on(0.0)[0] - 3.0).abs() < 1e-9);
    assert!(on(1.0).iter().all(|d| (d - 0.1).abs() < 1e-12), "a strip does not pass a bias on");
}

#[test]
fn revolved_surfaces_close_and_have_one_node_a_pole() {
    let axis = axis_of(&chain(&straight(p(0., 0., -1.), p(0., 0., 1.))), &tolerance()).unwrap();
    let half = arc_through(p(0., 0., -1.), p(0., 0., 1.), p(1., 0., 0.), Origin::NONE).unwrap();
    let sphere = revolve(&chain(&half), &axis, std::f64::consts::TAU, Origin::NONE, &tolerance()).unwrap();
    let scene = Scene::new(&[half], vec![sphere]);
    for (elements, order) in [(Elements::Triangles, 1), (Elements::Mixed, 1), (Elements::Triangles, 2), (Elements::Mixed, 2)] {
        let mut plan = scene.plan();
        plan.settings.elements = Some((elements, Origin::NONE));
        plan.settings.order = Some((order, Origin::NONE));
        plan.settings.size = Some((0.2, Origin::NONE));
        let mesh = scene.sound(&plan);
        assert_eq!(edges_of(&mesh), (0, 2), "a closed ball");
        assert!(mesh.nodes.iter().all(|n| (n.length() - 1.0).abs() < 1e-9), "also mid nodes lie on it");
        assert!((area(&mesh) / (4.0 * std::f64::consts::PI) - 1.0).abs() < 0.02);
    }
    let mut plan = scene.plan();
    (plan.settings.elements, plan.settings.size) = (Some((Elements::Quads, Origin::NONE)), Some((0.2, Origin::NONE)));
    let mesh = scene.sound(&plan);
    assert!(mesh.triangles.is_empty() && edges_of(&mesh) == (0, 2), "no map, no triangles");
    plan.settings.method = Some((lofting::mesh::request::methods::Method::Mapped, Origin::NONE));
    assert_eq!(scene.mesh(&plan).unwrap_err().code().0, "E704");
    // A tube round the axis: seams are welded, rings have at least three steps.
    let profile = straight(p(1., 0., 0.), p(1., 0., 3.));
    let tube = revolve(&chain(&profile), &axis, std::f64::consts::TAU, Origin::NONE, &tolerance()).unwrap();
    let scene = Scene::new(&[profile], vec![tube]);
    assert_eq!(counts(&scene), (1, 3, 2));
    let mut plan = scene.plan();
    plan.settings.elements = Some((Elements::Quads, Origin::NONE));
    plan.settings.size = Some((50.0, Origin::NONE));
    let mesh = scene.sound(&plan);
    assert_eq!((mesh.quads.len(), edges_of(&mesh)), (3, (6, 0)));
    plan.settings.angle_error = Some((15.0_f64.to_radians(), Origin(1)));
    assert_eq!(scene.sound(&plan).quads.len(), 24);
    plan.settings.angle_error = None;
    plan.settings.chord_error = Some((0.0005, Origin(1)));
    // Radius 100 with error 0.05 takes 100 steps.
    assert_eq!(scene.sound(&plan).quads.len(), 100);
    let ring = circle(p(0., 0., 9.), 1.0, DVec3::Z, Origin::NONE).unwrap();
    plan.rules = vec![Rule {
        settings: RuleSettings { count: Some((40, Origin(2))), ..RuleSettings::default() },
        ..Rule::on(Target::Chain(chain(&ring)), Origin(2))
    }];
    let fault = scene.mesh(&plan).map(|m| m.1.iter().map(|f| f.code().0).collect::<Vec<_>>());
    assert!(matches!(&fault, Ok(codes) if codes == &["W701"]), "that circle is on no edge of the mesh: {fault:?}");
}

#[test]
fn a_ball_of_two_lunes_is_a_closed_shell() {
    let (n, s) = (p(0., 0., 1.), p(0., 0., -1.));
    let meridian = |m: DVec3| arc_through(s, n, m, Origin::NONE).unwrap();
    let curves = [meridian(p(1., 0., 0.)), meridian(p(-1., 0., 0.))];
    let axis = axis_of(&chain(&straight(s, n)), &tolerance()).unwrap();
    let half = |k: usize| revolve(&chain(&curves[k]), &axis, std::f64::consts::PI, Origin(k as u32 + 1), &tolerance()).unwrap();
    let scene = Scene::new(&curves, vec![half(0), half(1)]);
    let request = ShellRequest {
        name: "ball".to_owned(),
        surfaces: vec![SurfaceId(0), SurfaceId(1)],
        snap: None,
        branches: false,
        touches: false,
        origin: Origin::NONE,
    };
    let shell = scene.model.shell(&request, &scene.network, &tolerance(), &mut Vec::new()).unwrap();
    assert!(shell.closed);
    let mut plan = scene.plan();
    plan.surfaces = shell.surfaces;
    plan.settings.size = Some((0.3, Origin::NONE));
    let mesh = scene.sound(&plan);
    assert!(edges_of(&mesh) == (0, 2) && mesh.is_watertight());
}

#[test]
fn shells_refuse_three_faces_at_an_edge_and_apart_ones() {
    let (a, b) = (p(0., 0., 0.), p(1., 0., 0.));
    let spine = straight(a, b);
    let mut curves = vec![spine.clone()];
    let mut surfaces = Vec::new();
    for out in [p(0., 1., 0.), p(0., -1., 0.), p(0., 0., 1.)] {
        let own = [straight(a, a + out), straight(b, b + out), straight(a + out, b + out)];
        surfaces.push(coons_of(&[chain(&spine), chain(&own[2]), chain(&own[0]), chain(&own[1])]));
        curves.extend(own);
    }
    let far = square(p(5., 5., 5.), 1.0);
    surfaces.push(coons_of(&far.each_ref().map(chain)));
    curves.extend(far);
    let scene = Scene::new(&curves, surfaces);
    let shell = |list: &[u32]| {
        let request = ShellRequest {
            name: "s".to_owned(),
            surfaces: list.iter().map(|k| SurfaceId(*k)).collect(),
            snap: None,
            branches: false,
            touches: false,
            origin: Origin::NONE,
        };
        scene.model.shell(&request, &scene.network, &tolerance(), &mut Vec::new()).map(|s| s.surfaces).map_err(|f| f.code().0)
    };
    assert_eq!(shell(&[0, 1, 2]), Err("E617"));
    assert_eq!(shell(&[0, 3]), Err("E618"));
    assert!(shell(&[0, 1]).is_ok() && shell(&[1, 2]).is_ok());
}

#[test]
fn rules_that_decide_nothing_or_twice_are_warned_of() {
    let curves = square(p(0., 0., 0.), 1.0);
    let scene = Scene::new(&curves, vec![coons_of(&curves.each_ref().map(chain))]);
    let mut plan = scene.plan();
    plan.settings.size = Some((0.1, Origin::NONE));
    let size = |k: usize, size: f64, origin: u32| Rule {
        settings: RuleSettings { size: Some((size, Origin(origin))), ..RuleSettings::default() },
        ..Rule::on(Target::Chain(chain(&curves[k])), Origin(origin))
    };
    let codes = |plan: &Plan| scene.mesh(plan).unwrap().1.iter().map(|f| f.code().0).collect::<Vec<_>>();
    plan.rules = vec![size(0, 0.05, 1)];
    assert_eq!(codes(&plan), Vec::<&str>::new());
    plan.rules = vec![size(0, 0.5, 1)];
    assert_eq!(codes(&plan), ["W701"], "the opposite side wants more");
    plan.rules = vec![size(0, 0.5, 1), size(0, 0.05, 2)];
    assert_eq!(codes(&plan), ["W706"]);
    plan.settings.chord_error = Some((0.01, Origin(9)));
    plan.rules = vec![Rule {
        settings: RuleSettings { count: Some((1, Origin(1))), ..RuleSettings::default() },
        ..Rule::on(Target::Surface(SurfaceId(0)), Origin(1))
    }];
    assert_eq!(scene.sound(&plan).triangles.len(), 2, "one count for each side");
}

#[test]
fn written_counts_too_coarse_for_a_limit_name_both() {
    let arch = |y: f64| arc_through(p(0., y, 0.), p(4., y, 0.), p(2., y, 1.), Origin::NONE).unwrap();
    let curves = [arch(0.0), straight(p(4., 0., 0.), p(4., 5., 0.)), arch(5.0), straight(p(0., 0., 0.), p(0., 5., 0.))];
    let scene = Scene::new(&curves, vec![coons_of(&curves.each_ref().map(chain))]);
    let mut plan = scene.plan();
    plan.settings.chord_error = Some((0.01, Origin(7)));
    plan.rules = vec![Rule {
        settings: RuleSettings { count: Some((3, Origin(8))), ..RuleSettings::default() },
        ..Rule::on(Target::Chain(chain(&curves[0])), Origin(8))
    }];
    let fault = scene.mesh(&plan).unwrap_err();
    let report = fault.describe(&PlainWords);
    assert_eq!(fault.code().0, "E703");
    assert!(report.labels.len() == 2 && report.help.as_deref() == Some("count: 11"), "{report:?}");
    plan.rules[0].settings.count = Some((11, Origin(8)));
    assert!(scene.sound(&plan).chord_error(&tolerance()).unwrap() <= 0.01);
}

#[test]
fn measured_error_keeps_the_setting_on_many_surfaces() {
    let mut state = 12345_u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    for round in 0..12 {
        let mut bump = |q: DVec3| q + p(0.3 * random(), 0.3 * random(), 1.2 * random());
        let corners = [p(0., 0., 0.), p(4., 0., 0.), p(4., 4., 0.), p(0., 4., 0.)].map(&mut bump);
        let mut side = |a: usize, b: usize| {
            let (a, b) = (corners[a], corners[b]);
            curved(&[a, bump(a.lerp(b, 0.3)), bump(a.lerp(b, 0.7)), b])
        };
        let curves = [side(0, 1), side(1, 2), side(3, 2), side(0, 3)];
        let scene = Scene::new(&curves, vec![coons_of(&curves.each_ref().map(chain))]);
        let mut plan = scene.plan();
        plan.settings.chord_error = Some((0.02, Origin::NONE));
        plan.settings.size = Some((2.0, Origin::NONE));
        plan.settings.elements = Some((if round % 2 == 0 { Elements::Triangles } else { Elements::Mixed }, Origin::NONE));
        let mesh = scene.sound(&plan);
        let measured = mesh.chord_error(&tolerance()).unwrap();
        assert!(measured <= 0.02, "round {round}: {measured}");
    }
}

#[test]
fn area_converges_with_size_and_measured_error_keeps_the_setting() {
    let arch = |y: f64, h: f64| arc_through(p(0., y, 0.), p(4., y, 0.), p(2., y, h), Origin::NONE).unwrap();
    let curves =
        [arch(0.0, 1.0), curved(&[p(4., 0., 0.), p(4.3, 2., 0.4), p(4., 5., 0.)]), arch(5.0, 1.6), straight(p(0., 0., 0.), p(0., 5., 0.))];
    let scene = Scene::new(&curves, vec![coons_of(&curves.each_ref().map(chain))]);
    let mut areas = Vec::new();
    for size in [1.0, 0.5, 0.25, 0.125] {
        let mut plan = scene.plan();
        plan.settings.size = Some((size, Origin::NONE));
        areas.push(area(&scene.sound(&plan)));
    }
    let steps: Vec<f64> = areas.windows(2).map(|w| w[1] - w[0]).collect();
    assert!(steps[1] / steps[0] < 0.4 && steps[2] / steps[1] < 0.4, "second order: {steps:?}");
    for chord in [0.1, 0.02, 0.003] {
        for elements in [Elements::Triangles, Elements::Quads] {
            let mut plan = scene.plan();
            plan.settings.size = Some((10.0, Origin::NONE));
            plan.settings.elements = Some((elements, Origin::NONE));
            plan.settings.chord_error = Some((chord, Origin::NONE));
            let mesh = scene.sound(&plan);
            let measured = mesh.chord_error(&tolerance()).unwrap();
            assert!(measured <= chord && measured > 0.2 * chord, "{measured} for {chord}");
        }
    }
}

#[test]
fn trilateral_faces_take_triangles_or_three_blocks_of_quads() {
    let [x, y, z] = [p(1., 0., 0.), p(0., 1., 0.), p(0., 0., 1.)];
    let s = 0.5_f64.sqrt();
    let great = |a, b, m| arc_through(a, b, m, Origin::NONE).unwrap();
    let curves = [great(x, y, p(s, s, 0.)), great(y, z, p(0., s, s)), great(z, x, p(s, 0., s))];
    let scene = Scene::new(&curves, vec![coons_of(&curves.each_ref().map(chain))]);
    assert_eq!(counts(&scene), (1, 3, 3));
    for order in [1, 2] {
        let mut plan = scene.plan();
        plan.settings.order = Some((order, Origin::NONE));
        plan.settings.size = Some((0.2, Origin::NONE));
        let mesh = scene.sound(&plan);
        let longest = |mesh: &Mesh| mesh.edge_lengths().into_iter().fold(0.0, f64::max);
        let (free, euler) = edges_of(&mesh);
        assert_eq!((mesh.triangles.len(), euler), ((free / 3) * (free / 3), 1));
        assert!(longest(&mesh) <= 0.2 * 1.05 && longest(&mesh) > 0.15, "{}", longest(&mesh));
        plan.settings.elements = Some((Elements::Quads, Origin::NONE));
        let mesh = scene.sound(&plan);
        assert!(mesh.triangles.is_empty() && edges_of(&mesh).1 == 1, "{} quads", mesh.quads.len());
        assert!(longest(&mesh) <= 0.2 * 1.05, "{}", longest(&mesh));
        assert!(mesh.quality().unwrap().min_quality > 0.3);
        for (mids, corners) in mesh.quad_mids.iter().zip(&mesh.quads) {
            for k in 0..4 {
                let [m, a, b] = [mids[k], corners[k], corners[(k + 1) % 4]].map(|n| mesh.nodes[n as usize]);
                let edge = a.distance(b);
                assert!(
                    m.distance((a + b) * 0.5) < 0.15 * edge && m != (a + b) * 0.5,
                    "a mid node lies on the surface, between its corners"
                );
            }
        }
    }
}

#[test]
fn curves_and_points_share_nodes_with_faces() {
    let mut curves: Vec<Curve> = square(p(0., 0., 0.), 1.0).to_vec();
    let faces: Vec<Chain> = curves.iter().map(chain).collect();
    curves.push(straight(p(1., 1., 0.), p(1., 1., 2.)));
    let scene = Scene::new(&curves, vec![coons_of(&faces)]);
    let mut plan = scene.plan();
    plan.settings.size = Some((0.25, Origin::NONE));
    plan.curves = vec![("c1".to_owned(), chain(&curves[0])), ("c5".to_owned(), chain(&curves[4]))];
    plan.points = vec![p(0.4, 1.0, 0.0), p(5.0, 5.0, 5.0)];
    plan.settings.order = Some((2, Origin::NONE));
    let mesh = scene.sound(&plan);
    // The point cuts the opposite side into 0.4 and 0.6: 2 + 3 steps, which the strip passes on.
    assert_eq!(mesh.lines.len(), 5 + 8);
    assert_eq!(mesh.points.len(), 2);
    assert!(mesh.nodes[mesh.points[0] as usize].distance(p(0.4, 1.0, 0.0)) < 1e-12);
    assert_eq!(mesh.line_mids.len(), 13);
    let in_faces = mesh.lines.iter().filter(|l| cells(&mesh).iter().any(|c| l.iter().all(|n| c.contains(n))));
    assert_eq!(in_faces.count(), 5);
    plan.points = vec![p(0.5, 0.5, 0.0)];
    let built = scene.mesh(&plan).unwrap().0;
    assert!(built.mesh.triangles.iter().any(|t| t.contains(&built.mesh.points[0])));
}
