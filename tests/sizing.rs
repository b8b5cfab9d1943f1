//! Sizes of meshes: `near`, `in`, `growth` and `min_size` on faces, links and across borders.

use std::collections::BTreeMap;

use glam::DVec3;
use lofting::base::bbox::Box3;
use lofting::base::fault::Fault;
use lofting::base::job::Job;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::Curve;
use lofting::geometry::construct::build::line;
use lofting::mesh::cache::reuse::Reuse;
use lofting::mesh::pipeline::build::build;
use lofting::mesh::request::plan::{Place, Refine};
use lofting::mesh::{Built, Input, Mesh, MeshLayouts, Method, Plan};
use lofting::model::topology::Named;
use lofting::model::{Model, SurfaceId};
use lofting::network::graph::Input as NetInput;
use lofting::network::{Chain, Network};
use lofting::surface::Surface;
use lofting::surface::blended::plane_face;

use crate::support::script;

fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn tolerance() -> Tolerance {
    Tolerance::new(1e-5, 10.0)
}

struct Scene {
    network: Network,
    model: Model,
    /// Curves beside the borders.
    inner: Vec<Chain>,
}

/// A plate of 10 × 6 and a wall of 6 × 4 on its east side.
fn scene(faces: usize) -> Scene {
    scene_with(faces, Vec::new())
}

fn scene_with(faces: usize, inner: Vec<Curve>) -> Scene {
    let corners = [p(0.0, 0.0, 0.0), p(10.0, 0.0, 0.0), p(10.0, 6.0, 0.0), p(0.0, 6.0, 0.0), p(10.0, 0.0, 4.0), p(10.0, 6.0, 4.0)];
    let side = |a: usize, b: usize| line(corners[a], corners[b], Origin::NONE).unwrap();
    let curves: Vec<Curve> = [(0, 1), (1, 2), (2, 3), (3, 0), (1, 4), (4, 5), (5, 2)].into_iter().map(|(a, b)| side(a, b)).collect();
    let over = |which: &[usize]| -> Surface {
        let chains: Vec<Chain> = which.iter().map(|k| Chain::of_curve(&curves[*k])).collect();
        plane_face::bounded(&chains, Origin::NONE, &tolerance()).unwrap().0
    };
    let surfaces = [over(&[0, 1, 2, 3]), over(&[1, 4, 5, 6])];
    let lines: Vec<Chain> = inner.iter().map(Chain::of_curve).collect();
    let curves: Vec<Curve> = curves.into_iter().chain(inner).collect();
    let inputs = curves.iter().enumerate().map(|(k, c)| NetInput { name: format!("c{k}"), curve: c.clone(), cuts: Vec::new() }).collect();
    let network = Network::build(inputs, &[], &tolerance(), &Job::new(), &mut Vec::new()).unwrap();
    let named = surfaces.into_iter().take(faces).enumerate().map(|(k, surface)| Named { name: format!("s{k}"), surface }).collect();
    let model = Model::build(named, &network, &tolerance(), &Job::new()).unwrap();
    Scene { network, model, inner: lines }
}

impl Scene {
    fn plan(&self, size: f64, refines: Vec<Refine>) -> Plan {
        let mut plan = Plan::of("m", (0..self.model.surfaces.len()).map(|k| (SurfaceId::at(k), false)).collect());
        (plan.settings.size, plan.settings.method, plan.refines) =
            (Some((size, Origin::NONE)), Some((Method::Delaunay, Origin::NONE)), refines);
        plan
    }

    fn build(&self, plan: &Plan) -> Result<Built, Fault> {
        let tolerance = tolerance();
        let input = Input { plan, model: &self.model, network: &self.network, tolerance: &tolerance };
        build(&input, &Job::new(), &mut Vec::new())
    }
}

fn near(at: DVec3, radius: f64, size: f64) -> Refine {
    Refine { at: vec![Place::Point(at)], size: (size, Origin::NONE), radius, origin: Origin::NONE }
}

fn inside(a: DVec3, b: DVec3, size: f64) -> Refine {
    Refine { at: vec![Place::Box(Box3::of([a, b]))], size: (size, Origin::NONE), radius: 0.0, origin: Origin::NONE }
}

/// Edges with the number of triangles on them.
fn edges(mesh: &Mesh) -> BTreeMap<(u32, u32), usize> {
    let mut edges = BTreeMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += 1;
        }
    }
    edges
}

fn length(mesh: &Mesh, (a, b): (u32, u32)) -> f64 {
    mesh.nodes[a as usize].distance(mesh.nodes[b as usize])
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
}

/// Whether all of an edge is where a rule holds.
fn holds(refine: &Refine, a: DVec3, b: DVec3) -> bool {
    refine.at.iter().any(|place| {
        [a, b].iter().all(|q| match place {
            Place::Point(c) => c.distance(*q) <= refine.radius,
            Place::Box(around) => around.touches(&Box3::of([*q]), 0.0),
            Place::Chain(_) => false,
        })
    })
}

#[test]
fn edges_keep_every_rule_and_grow_from_there() {
    let scene = scene(2);
    let mut random = Random(11);
    for case in 0..4 {
        let mut refines = Vec::new();
        for k in 0..3 {
            let at = p(random.between(0.0, 10.0), random.between(0.0, 6.0), 0.0);
            let size = random.between(0.1, 0.4);
            refines.push(if k == 2 { inside(at, at + p(1.5, 1.0, 1.0), size) } else { near(at, random.between(0.0, 1.5), size) });
        }
        let built = scene.build(&scene.plan(1.0, refines.clone())).unwrap();
        let mesh = &built.mesh;
        let edges = edges(mesh);
        assert!(edges.values().all(|n| *n <= 2), "case {case}");
        let mut around: BTreeMap<u32, (f64, f64)> = BTreeMap::new();
        for &(a, b) in edges.keys() {
            let l = length(mesh, (a, b));
            assert!(l <= 1.05 + 1e-9, "case {case}: {l}");
            for refine in refines.iter().filter(|r| holds(r, mesh.nodes[a as usize], mesh.nodes[b as usize])) {
                assert!(l <= 1.05 * refine.size.0 + 1e-9, "case {case}: {l} where {} is asked for", refine.size.0);
            }
            for n in [a, b] {
                let slot = around.entry(n).or_insert((f64::INFINITY, 0.0));
                *slot = (slot.0.min(l), slot.1.max(l));
            }
        }
        // Steps of 1.3 either way of the wanted lengths, times what triangles are off from equilateral ones.
        let worst = around.values().map(|(low, high)| high / low).fold(0.0, f64::max);
        assert!(worst < 3.5, "case {case}: neighbouring edges differ by {worst}");
        assert!(mesh.quality().unwrap().min_angle.to_degrees() > 20.0, "case {case}");
        // The order of rules means nothing.
        refines.reverse();
        let turned = scene.build(&scene.plan(1.0, refines)).unwrap();
        assert_eq!(mesh.hash(), turned.mesh.hash(), "case {case}");
    }
}

#[test]
fn a_shared_border_is_fine_for_both_faces() {
    let scene = scene(2);
    let built = scene.build(&scene.plan(1.0, vec![near(p(10.0, 3.0, 0.0), 0.5, 0.1)])).unwrap();
    let mesh = &built.mesh;
    let on = |n: u32| (mesh.nodes[n as usize].x - 10.0).abs() < 1e-9 && mesh.nodes[n as usize].z.abs() < 1e-9;
    let shared: Vec<(u32, u32)> =
        edges(mesh).into_iter().filter(|((a, b), _)| on(*a) && on(*b)).inspect(|e| assert_eq!(e.1, 2)).map(|e| e.0).collect();
    assert!((17..40).contains(&shared.len()), "{}", shared.len());
    for y in [2.6, 3.0, 3.4] {
        let holding = |e: &&(u32, u32)| {
            let [a, b] = [mesh.nodes[e.0 as usize].y, mesh.nodes[e.1 as usize].y];
            a.min(b) <= y && y <= a.max(b)
        };
        assert!(shared.iter().filter(holding).all(|e| length(mesh, *e) <= 0.1 + 1e-9));
    }
    // Both sides are fine beside it.
    for probe in [p(9.8, 3.0, 0.0), p(10.0, 3.0, 0.2)] {
        let nearest = mesh.nodes.iter().map(|q| q.distance(probe)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.08, "{nearest}");
    }
}

/// Every step of every curve is an edge of the triangles, and every point one of their nodes.
fn holds_lines(mesh: &Mesh) {
    let edges = edges(mesh);
    assert!(!mesh.lines.is_empty());
    for [a, b] in &mesh.lines {
        assert!(edges.contains_key(&(*a.min(b), *a.max(b))), "{} {}", mesh.nodes[*a as usize], mesh.nodes[*b as usize]);
    }
    let used: std::collections::BTreeSet<u32> = mesh.triangles.iter().flatten().copied().collect();
    assert!(mesh.points.iter().all(|n| used.contains(n)));
    assert!(edges.values().all(|n| *n <= 2));
}

#[test]
fn lines_and_points_inside_are_built_in() {
    // A rib that starts on the border, a ring across it, one that runs over the shared edge up the wall, one that only touches.
    let rib = line(p(0.0, 2.0, 0.0), p(7.0, 4.0, 0.0), Origin::NONE).unwrap();
    let ring = lofting::geometry::construct::build::circle_start(p(5.0, 3.0, 0.0), p(6.0, 3.0, 0.0), DVec3::Z, Origin::NONE).unwrap();
    let over =
        lofting::geometry::construct::build::polyline(&[p(8.0, 1.0, 0.0), p(10.0, 2.0, 0.0), p(10.0, 3.0, 3.0)], false, Origin::NONE)
            .unwrap();
    let stem = line(p(3.0, 6.0, 0.0), p(3.0, 4.5, 0.0), Origin::NONE).unwrap();
    let scene = scene_with(2, vec![rib, ring, over, stem]);
    for order in [1, 2] {
        let mut plan = scene.plan(0.7, Vec::new());
        (plan.settings.method, plan.settings.order) = (Some((Method::Auto, Origin::NONE)), Some((order, Origin::NONE)));
        plan.curves = scene.inner.iter().enumerate().map(|(k, c)| (format!("inner{k}"), c.clone())).collect();
        plan.points = vec![p(8.0, 5.0, 0.0), p(10.0, 5.0, 3.0), p(0.0, 0.0, 0.0), p(7.0, 4.0, 0.0)];
        let built = scene.build(&plan).unwrap();
        holds_lines(&built.mesh);
        assert_eq!(built.mesh.points.len(), 4);
        assert!((built.mesh.quality().unwrap().area - 84.0).abs() < 1e-9);
        let alone = Plan { curves: Vec::new(), points: Vec::new(), ..plan.clone() };
        assert!(scene.build(&alone).unwrap().explanation.faces.iter().all(|f| f.method == "mapped"));
        plan.settings.method = Some((Method::Mapped, Origin::NONE));
        assert_eq!(scene.build(&plan).unwrap_err().code().0, "E705");
    }
}

#[test]
fn any_line_on_a_plate_is_built_in() {
    let mut random = Random(5);
    for case in 0..12 {
        let mut place = || p(random.between(0.0, 10.0), random.between(0.0, 6.0), 0.0);
        let lines: Vec<Curve> = (0..4).map(|_| line(place(), place(), Origin::NONE).unwrap()).collect();
        let scene = scene_with(1, lines);
        let mut plan = scene.plan(1.0, Vec::new());
        plan.curves = scene.inner.iter().enumerate().map(|(k, c)| (format!("inner{k}"), c.clone())).collect();
        let built = scene.build(&plan).unwrap_or_else(|e| panic!("case {case}: {e}"));
        holds_lines(&built.mesh);
        assert!((built.mesh.quality().unwrap().area - 60.0).abs() < 1e-9, "case {case}");
    }
}

#[test]
fn many_points_cost_little_and_one_rule_of_many_is_many_rules() {
    let scene = scene(1);
    let points: Vec<DVec3> = (0..10_000).map(|k| p(f64::from(k % 100) * 0.1, f64::from(k / 100) * 0.06, 0.0)).collect();
    let one = Refine { at: points.iter().map(|q| Place::Point(*q)).collect(), ..near(p(0.0, 0.0, 0.0), 0.0, 0.2) };
    let many: Vec<Refine> = points.iter().rev().map(|q| near(*q, 0.0, 0.2)).collect();
    let (a, b) = (scene.build(&scene.plan(1.0, vec![one])).unwrap(), scene.build(&scene.plan(1.0, many)).unwrap());
    assert_eq!(a.mesh.hash(), b.mesh.hash());
    assert!(a.mesh.nodes.len() > 1500);
}

#[test]
fn what_cannot_be_is_refused_and_what_decides_nothing_is_said() {
    let scene = scene(1);
    let endless = scene.build(&scene.plan(1.0, vec![near(p(5.0, 3.0, 0.0), 1.0, 1e-5)])).unwrap_err();
    assert_eq!(endless.code().0, "E217", "{endless}");
    for idle in [near(p(50.0, 3.0, 0.0), 1.0, 0.1), near(p(5.0, 3.0, 0.0), 1.0, 2.0), inside(p(0.0, 0.0, 5.0), p(9.0, 9.0, 6.0), 0.1)] {
        let built = scene.build(&scene.plan(1.0, vec![idle])).unwrap();
        assert_eq!(built.remarks.len(), 1);
        assert_eq!(built.mesh.hash(), scene.build(&scene.plan(1.0, Vec::new())).unwrap().mesh.hash());
    }
    let mut plan = scene.plan(1.0, vec![near(p(5.0, 3.0, 0.0), 1.0, 0.1)]);
    assert!(scene.build(&plan).unwrap().remarks.is_empty());
    plan.settings.min_size = Some((0.2, Origin::NONE));
    assert_eq!(scene.build(&plan).unwrap_err().code().0, "E707");
}

#[test]
fn growth_and_smoothing_are_followed() {
    let scene = scene(1);
    let nodes = |growth: Option<f64>| {
        let mut plan = scene.plan(2.0, vec![near(p(5.0, 3.0, 0.0), 0.2, 0.05)]);
        plan.settings.growth = growth.map(|g| (g, Origin::NONE));
        let built = scene.build(&plan).unwrap();
        built.mesh.nodes.len()
    };
    let (slow, plain, fast) = (nodes(Some(1.1)), nodes(None), nodes(Some(1.8)));
    assert!(slow > 2 * plain && 7 * plain > 8 * fast, "{slow} {plain} {fast}");
    let smoothed = |rounds: u32| {
        let mut plan = scene.plan(0.5, vec![near(p(5.0, 3.0, 0.0), 0.2, 0.4)]);
        plan.settings.smooth = Some((rounds, Origin::NONE));
        scene.build(&plan).unwrap().mesh.quality().unwrap().mean_quality
    };
    let (raw, once, more) = (smoothed(0), smoothed(1), smoothed(8));
    assert!(raw < once && once != more, "{raw} {once} {more}");
}

#[test]
fn it_is_told_what_decided_where() {
    let scene = scene(2);
    let mut plan = scene.plan(1.0, vec![near(p(10.0, 3.0, 0.0), 0.3, 0.1), inside(p(0.0, 0.0, -1.0), p(1.0, 1.0, 1.0), 0.5)]);
    let lines = scene.build(&plan).unwrap().explanation.lines;
    let told = |what: &str, words: &[&str]| {
        let line = lines.iter().find(|l| l.contains(what)).unwrap();
        words.iter().for_each(|w| assert!(line.contains(w), "{line}"));
    };
    told("face 0 of s0", &["delaunay", " by size 0.1 near (10, 3, 0), one at (", " by size 0.5 in the box (0, 0, -1)"]);
    told("strip of c1", &["by sizes along it", "lengths of 0.100 to", "% by size 0.1 near (10, 3, 0)"]);
    told("strip of c0", &["% by the size", "% by size 0.5 in the box"]);
    told("strip of c5", &["8 steps, by the size"]);
    plan.settings.method = Some((Method::Mapped, Origin::NONE));
    let lines = scene.build(&plan).unwrap().explanation.lines;
    assert!(lines[0].contains("mapped") && lines[0].contains("; by size 0.1 near"), "{}", lines[0]);
}

const TOLD: &str = r#"units mm
curve rim = polyline([(0, 0), (200, 0), (200, 100), (0, 100)], closed: true)
curve eye = circle(center: (50, 50, 0), radius: 20)
curve next = circle(center: (90.5, 50, 0), radius: 20)
surface plate = trim(plane(rim), holes: [eye, next])
surface strip = trim(plane([polyline([(300, 0), (400, 0), (400, 2), (300, 2)], closed: true)]))
surface dome = bezier_surface([
  [(300, 50, 0), (350, 50, 30), (400, 50, 0)],
  [(300, 100, 20), (350, 100, 80), (400, 100, 20)],
  [(300, 150, 0), (350, 150, 0), (400, 150, 0)]
])
mesh size of plate { size: 20mm }
mesh refined of plate { size: 20mm  near (150, 50, 0) { size: 3mm  radius: 10mm }  in box((160, 0, -1), (200, 20, 1)) { size: 4mm } }
mesh ruled of plate { size: 20mm  on eye { size: 2mm }  on next { count: 64 } }
mesh chord of dome { size: 20mm  chord_error: 0.1mm  method: delaunay }
mesh angle of dome { size: 20mm  angle_error: 4deg  method: delaunay }
mesh floor of strip { size: 20mm  min_size: 8mm }
"#;

/// Each setting is told where it decided, in the words of the script.
#[test]
fn each_setting_is_told_where_it_decides() {
    let disk = lofting::session::disk::Disk::new(None, None, &[], lofting::session::disk::Outputs::Counted).unwrap();
    let outcome = script::outcome("told.loft", TOLD.as_bytes(), &[], &disk);
    assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
    let told = |mesh: &str, part: &str, words: &str| {
        let mut lines = outcome.notes.iter().filter(|n| n.contains(&format!("mesh {mesh}: {part}")));
        assert!(lines.any(|l| l.contains(words)), "{mesh}: {part}: {words}\n{}", outcome.notes.join("\n"));
    };
    for (mesh, part, words) in [
        ("size", "face 0 of plate", " by the size"),
        ("size", "face 0 of plate", " by growth from shorter edges, one at ("),
        ("size", "strip of eye", "% by the border facing it"),
        ("size", "strip of rim", " by the size"),
        ("refined", "face 0 of plate", " by size 3 near (150, 50, 0), one at ("),
        ("refined", "face 0 of plate", " by size 4 in the box (160, 0, -1)"),
        ("refined", "strip of rim", "% by size 4 in the box"),
        ("ruled", "strip of eye", "by the size"),
        ("ruled", "strip of next", "by count 64 on next"),
        ("chord", "face 0 of dome", " by chord_error, one at ("),
        ("chord", "strip of", "% by chord_error"),
        ("angle", "face 0 of dome", " by angle_error, one at ("),
        ("angle", "strip of", "% by angle_error"),
        ("floor", "strip of", "% by min_size"),
    ] {
        told(mesh, part, words);
    }
}

/// A mesh that is refused for its work must be refused whatever was made before: what is taken over is charged as if it were made.
#[test]
fn work_is_the_same_whatever_was_made_before() {
    let scene = scene(2);
    let (tolerance, mut reuse) = (tolerance(), Reuse::default());
    for method in [Method::Mapped, Method::Delaunay] {
        let mut plan = scene.plan(0.5, vec![]);
        (plan.settings.method, plan.settings.angle_error) = (Some((method, Origin::NONE)), Some((0.1, Origin::NONE)));
        let input = Input { plan: &plan, model: &scene.model, network: &scene.network, tolerance: &tolerance };
        let work = |reuse: Option<&Reuse>| {
            let (built, work) = MeshLayouts::new(&input).unwrap().measured(&input, reuse, &Job::new());
            (built.unwrap().mesh.triangles.len(), work)
        };
        let cold = work(None);
        assert!(cold.1 > 100, "{cold:?}");
        let (first, faces) = (work(Some(&reuse)), reuse.faces());
        let again = work(Some(&reuse));
        assert!(reuse.faces() > faces, "nothing was taken over");
        assert_eq!([first, again], [cold; 2], "{method:?}");
        reuse.end_run();
    }
}
