//! Rows of points on surfaces: what a mapped mesh asks for.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build::{arc_through, spline};
use lofting::geometry::{Ends, Spline};
use lofting::model::measure;
use lofting::network::{Chain, ChainFlow, of_chains};
use lofting::surface::blended::coons::{BlendMethod, CoonsSettings, Grid, build};
use lofting::surface::points::control_net::{Net, nurbs};
use lofting::surface::{Nearest, Reparam, Surface, foot_within};

/// Two arcs and two splines round a square of side 100.
fn roof() -> Surface {
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let (a, b, c, d) = (p(0.0, 0.0, 0.0), p(100.0, 0.0, 0.0), p(100.0, 100.0, 0.0), p(0.0, 100.0, 0.0));
    let arc = |a, b, m| Chain::of_curve(&arc_through(a, b, m, Origin::NONE).expect("three points off a line"));
    let settings = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
    let through = |points: [DVec3; 4]| Chain::of_curve(&spline(&points, &settings, Origin::NONE).expect("four points"));
    let chains = [
        arc(a, b, p(50.0, -10.0, 8.0)),
        through([b, p(108.0, 33.0, 6.0), p(95.0, 66.0, -4.0), c]),
        arc(d, c, p(50.0, 112.0, 10.0)),
        through([a, p(-6.0, 33.0, 5.0), p(7.0, 66.0, 12.0), d]),
    ];
    let tolerance = Tolerance::new(1e-4, 150.0);
    let (flow, _) = of_chains(&chains, &ChainFlow::default(), &tolerance).expect("a closed boundary");
    let settings = CoonsSettings { method: BlendMethod::Coons, reparam: Reparam::Smooth, origin: Origin::NONE };
    build(&Grid { chains: &chains, flow: &flow, poles: (None, None) }, &settings, &tolerance).expect("a quadrilateral").0
}

fn grids(c: &mut Criterion) {
    let surface = roof();
    let stations: Vec<f64> = (0..=1000).map(|k| f64::from(k) / 1000.0).collect();
    let mut points = vec![DVec3::ZERO; 1001 * 1001];
    c.bench_function("coons grid 1000x1000", |b| b.iter(|| surface.grid(black_box(&stations), &stations, &mut points)));
    c.bench_function("coons jet", |b| b.iter(|| surface.jet(black_box(0.3), black_box(0.7))));
    c.bench_function("coons area", |b| b.iter(|| measure::area(black_box(&surface))));
    let nearest = Nearest::new(&surface);
    c.bench_function("coons nearest point", |b| b.iter(|| nearest.at(black_box(DVec3::new(30.0, 40.0, 20.0)))));
}

/// A rational bicubic net of 20 × 20 points over a square of side 100, as in `models/nurbs.loft`.
fn net() -> Surface {
    let greville = |i: usize| {
        let sum: usize = (0..3).map(|k| (i + 1 + k).saturating_sub(3).min(17)).sum();
        sum as f64 / 51.0 * 100.0
    };
    let height = |x: f64, y: f64| {
        let turn = |share: f64| (std::f64::consts::TAU * share).sin();
        8.0 * turn(x / 50.0) * (std::f64::consts::TAU * y / 40.0).cos() + 3.0 * turn((x + y) / 70.0)
    };
    let at = |j: usize, i: usize| DVec3::new(greville(i), greville(j), height(greville(i), greville(j)));
    let rows: Vec<Vec<DVec3>> = (0..20).map(|j| (0..20).map(|i| at(j, i)).collect()).collect();
    let weight = |j: i32, i: i32| 1.0 + 0.15 * (1.3 * f64::from(i) + 0.7 * f64::from(j)).sin();
    let weights: Vec<Vec<f64>> = (0..20).map(|j| (0..20).map(|i| weight(j, i)).collect()).collect();
    let net = Net { rows: &rows, weights: Some(&weights) };
    nurbs(&net, (3, 3), (None, None), Origin::NONE, &Tolerance::new(1e-4, 150.0)).expect("a net")
}

/// Points half a millimetre over the net: the nearest one anywhere, and the foot from a place 0.3 mm away.
fn projections(c: &mut Criterion) {
    let surface = net();
    let place = |k: usize| (0.05 + 0.9 * (k as f64 * 0.618_034).fract(), 0.05 + 0.9 * (k as f64 * 0.754_878).fract());
    let lifted = |(u, v): (f64, f64)| surface.point(u, v) + 0.5 * surface.normal(u, v);
    let places: Vec<((f64, f64), DVec3)> = (0..10_000).map(place).map(|uv| (uv, lifted(uv))).collect();
    let nearest = Nearest::new(&surface);
    let far = |distance: f64| assert!(distance < 0.5 + 1e-9, "{distance}");
    c.bench_function("net nearest points, 10 000", |b| b.iter(|| places.iter().for_each(|(_, p)| far(nearest.at(*p).distance))));
    let prepared = surface.prepared();
    let foot = |(uv, p): &((f64, f64), DVec3)| foot_within(prepared.evaluator(), *p, (uv.0 + 0.003, uv.1 - 0.002), (0.0, 1.0), (0.0, 1.0));
    c.bench_function("net feet from a guess, 10 000", |b| b.iter(|| places.iter().for_each(|place| far(foot(place).0))));
}

criterion_group!(benches, grids, projections);
criterion_main!(benches);
