//! Mapped meshes: a Coons face between two arcs and two splines, as `benches/peers/p1_gmsh.py` meshes it.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use lofting::base::job::Job;
use lofting::base::origin::Origin;
use lofting::base::par;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_through, spline};
use lofting::geometry::{Curve, Ends, Spline};
use lofting::mesh::pipeline::build::build;
use lofting::mesh::request::settings::RuleSettings;
use lofting::mesh::{Elements, Input, Plan, Rule, Target};
use lofting::model::topology::Named;
use lofting::model::{Model, SurfaceId};
use lofting::network::flow_chains::{ChainFlow, of_chains};
use lofting::network::graph::Input as NetInput;
use lofting::network::{Chain, Network};
use lofting::surface::Reparam;
use lofting::surface::blended::coons::{self, BlendMethod, CoonsSettings, Grid};

/// Two arcs and two splines round a square of 100.
fn border() -> [Curve; 4] {
    let p = DVec3::new;
    let natural = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
    let (a, b, c, d) = (p(0., 0., 0.), p(100., 0., 0.), p(100., 100., 0.), p(0., 100., 0.));
    let arc = |a, b, m| arc_through(a, b, m, Origin::NONE).expect("three points off a line");
    let through = |points: &[DVec3]| spline(points, &natural, Origin::NONE).expect("four different points");
    [
        arc(a, b, p(50., -10., 8.)),
        through(&[b, p(108., 33., 6.), p(95., 66., -4.), c]),
        arc(d, c, p(50., 112., 10.)),
        through(&[a, p(-6., 33., 5.), p(7., 66., 12.), d]),
    ]
}

fn coons_face(c: &mut Criterion) {
    par::set_threads(1);
    let tolerance = Tolerance::new(1e-4, 150.0);
    let curves = border();
    let chains: Vec<Chain> = curves.iter().map(Chain::of_curve).collect();
    let (flow, _) = of_chains(&chains, &ChainFlow::default(), &tolerance).expect("a closed border");
    let settings = CoonsSettings { method: BlendMethod::Coons, reparam: Reparam::Smooth, origin: Origin::NONE };
    let (surface, _) = coons::build(&Grid { chains: &chains, flow: &flow, poles: (None, None) }, &settings, &tolerance).expect("a face");
    let inputs = curves.iter().enumerate().map(|(k, curve)| NetInput { name: format!("c{k}"), curve: curve.clone(), cuts: Vec::new() });
    let network = Network::build(inputs.collect(), &[], &tolerance, &Job::new(), &mut Vec::new()).expect("a network");
    let model = Model::build(vec![Named { name: "s".to_owned(), surface }], &network, &tolerance, &Job::new()).expect("a model");
    let mut group = c.benchmark_group("coons");
    for n in [100_u32, 1000] {
        let mut plan = Plan::of("m", vec![(SurfaceId(0), false)]);
        plan.settings.elements = Some((Elements::Quads, Origin::NONE));
        plan.rules = (0..2)
            .map(|k| Rule {
                settings: RuleSettings { count: Some((n, Origin::NONE)), ..RuleSettings::default() },
                ..Rule::on(Target::Chain(chains[k].clone()), Origin::NONE)
            })
            .collect();
        group.throughput(Throughput::Elements(u64::from(n) * u64::from(n)));
        group.sample_size(20).bench_function(format!("{n} by {n} quads"), |b| {
            b.iter(|| {
                let input = Input { plan: &plan, model: &model, network: &network, tolerance: &tolerance };
                build(&input, &Job::new(), &mut Vec::new()).expect("a mesh").mesh.quads.len()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, coons_face);
criterion_main!(benches);
