//! Rows of points on surfaces: what a mapped mesh asks for.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::build::{arc_through, spline};
use lofting::geometry::{Ends, Spline};
use lofting::model::measure;
use lofting::network::{Chain, ChainFlow, of_chains};
use lofting::surface::coons::{Grid, Method, Settings, build};
use lofting::surface::{Nearest, Reparam, Surface};

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
    let settings = Settings { method: Method::Composite, reparam: Reparam::Smooth, origin: Origin::NONE };
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

criterion_group!(benches, grids);
criterion_main!(benches);
