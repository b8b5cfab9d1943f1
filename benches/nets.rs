//! Sweeps and nets: built, evaluated, measured and made B-splines.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

#[path = "../tests/support/networks.rs"]
mod networks;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::Motion;
use lofting::geometry::construct::build;
use lofting::geometry::construct::spline::{Ends, Spline, spline};
use lofting::model::measure;
use lofting::network::Chain;
use lofting::surface::Surface;
use lofting::surface::blended::skin::{Across, SkinSettings, skin};
use lofting::surface::blended::skin_align::SkinSection;
use lofting::surface::blended::skin_ends::Leaving;
use lofting::surface::swept::laws::Law;
use lofting::surface::swept::sweep::sweep;
use lofting::surface::swept::sweep_input::{Input, NetMethod};
use networks::{Curve, NETWORKS, as_given, network};

fn through(points: &[DVec3]) -> Chain {
    let settings = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
    Chain::of_curve(&spline(points, &settings, Origin::NONE).unwrap())
}

/// Lines of constant parameter of one bicubic surface of 50 × 50 spans: profiles, then guides. With `chords` each is a cubic spline
/// through its points at the knots and crossings instead, by chord length.
fn synthetic(n: usize, chords: bool) -> [Vec<Chain>; 2] {
    const SPANS: usize = 50;
    let knots: Vec<f64> = [vec![0.0; 3], (0..=SPANS).map(|k| k as f64 / SPANS as f64).collect(), vec![1.0; 3]].concat();
    let greville: Vec<f64> = (0..SPANS + 3).map(|i| knots[i + 1..i + 4].iter().sum::<f64>() / 3.0).collect();
    let at = |x: f64, y: f64| {
        let (sin, cos) = (f64::sin, f64::cos);
        10.0 * DVec3::new(x + 0.05 * sin(3.0 * y), y + 0.05 * cos(4.0 * x), 0.2 * sin(5.0 * x) * cos(4.0 * y) + 0.1 * x * y)
    };
    let curve = |poles: &[DVec3]| build::nurbs(poles, &vec![1.0; poles.len()], &knots, 3, Origin::NONE).unwrap();
    // A line of the surface has the points of curves across it as control points.
    let lines = |pole: &dyn Fn(usize, usize) -> DVec3| -> Vec<Chain> {
        let across: Vec<_> = (0..greville.len()).map(|k| curve(&(0..greville.len()).map(|i| pole(i, k)).collect::<Vec<_>>())).collect();
        let line = |j: usize| across.iter().map(|c| c.point(j as f64 / (n - 1) as f64)).collect::<Vec<_>>();
        let steps = |m: usize| (0..=m).map(move |k| k as f64 / m as f64);
        let mut stops: Vec<f64> = steps(SPANS).chain(steps(n - 1)).collect();
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|b, a| *b - *a < 1e-9);
        let made = |j: usize| {
            let exact = curve(&line(j));
            let points = || stops.iter().map(|x| exact.point(*x)).collect::<Vec<_>>();
            if chords { through(&points()) } else { Chain::of_curve(&exact) }
        };
        (0..n).map(made).collect()
    };
    [lines(&|i, k| at(greville[k], greville[i])), lines(&|i, k| at(greville[i], greville[k]))]
}

fn builds(c: &mut Criterion) {
    let chains = |name: &str| network(name).map(|family: Vec<Curve>| family.iter().map(|c| c.chain(1.0, false)).collect::<Vec<Chain>>());
    for (name, gap) in NETWORKS {
        c.bench_function(&format!("gordon {name}"), |b| {
            b.iter_batched(|| chains(name), |chains| networks::surface(chains, gap), criterion::BatchSize::LargeInput);
        });
    }
    let mut slow = c.benchmark_group("large");
    slow.sample_size(10);
    slow.bench_function("gordon 50x50 curves of 50 spans", |b| {
        b.iter_batched(|| synthetic(50, false), |chains| networks::surface(chains, 1e-6), criterion::BatchSize::LargeInput);
    });
    slow.bench_function("gordon 50x50 curves by chord length", |b| {
        b.iter_batched(|| synthetic(50, true), |chains| networks::surface(chains, 1e-6), criterion::BatchSize::LargeInput);
    });
}

fn sections() -> Vec<SkinSection> {
    let at = |j: usize, k: usize| {
        let (x, y) = (k as f64 / 14.0, j as f64 / 99.0);
        DVec3::new(10.0 * x, 40.0 * y, (1.5 + y) * (2.5 * x + y).sin() + 0.4 * (5.0 * x - 3.0 * y).sin())
    };
    (0..100).map(|j| SkinSection::Curve(through(&(0..15).map(|k| at(j, k)).collect::<Vec<_>>()))).collect()
}

/// Twenty sections across one spine, and it.
fn spine() -> (Vec<Chain>, Chain) {
    let at = |x: f64| DVec3::new(40.0 * x, 3.0 * (3.0 * x).sin(), 2.0 * x * x);
    let spine = through(&(0..20).map(|k| at(f64::from(k) / 19.0)).collect::<Vec<_>>());
    let section = |k: usize| {
        let foot = at(k as f64 / 19.0);
        let wide = 2.0 + 0.1 * k as f64;
        through(
            &(0..15)
                .map(|i| foot + DVec3::new(0.0, wide * (f64::from(i) / 7.0 - 1.0), (f64::from(i) - 7.0).powi(2) / 49.0))
                .collect::<Vec<_>>(),
        )
    };
    ((0..20).map(section).collect(), spine)
}

fn swept() -> Surface {
    let (sections, spine) = spine();
    let input = Input { sections: &sections, guides: &[spine], law: Law::Parallel, method: NetMethod::Gordon, origin: Origin::NONE };
    sweep(&input, &Tolerance::new(1e-5, 40.0)).unwrap_or_else(|fault| panic!("{fault}")).0
}

fn sweeps(c: &mut Criterion) {
    let tolerance = Tolerance::new(1e-5, 40.0);
    let settings =
        SkinSettings { across: Across::Cubic, closed: false, ends: (Leaving::Plain, Leaving::Plain), smooth: None, origin: Origin::NONE };
    let all = || skin(&sections(), &settings, &tolerance).unwrap().0;
    c.bench_function("skin 100 sections", |b| {
        b.iter_batched(sections, |s| skin(&s, &settings, &tolerance).unwrap(), criterion::BatchSize::LargeInput);
    });
    c.bench_function("sweep 20 sections on a spine", |b| b.iter(|| black_box(swept())));
    let surface = swept();
    let stations: Vec<f64> = (0..=1000).map(|k| f64::from(k) / 1000.0).collect();
    let mut points = vec![DVec3::ZERO; 1001 * 1001];
    c.bench_function("sweep grid 1000x1000", |b| b.iter(|| surface.grid(black_box(&stations), &stations, &mut points)));
    let mut slow = c.benchmark_group("large");
    slow.sample_size(10);
    let fuselage = as_given("fuselage1", 1e-6, 1.0);
    let fine = Tolerance::new(1e-7 * fuselage.1, fuselage.1);
    slow.bench_function("skin 100 sections to a net", |b| b.iter(|| all().to_net(&Tolerance::new(1e-7 * 40.0, 40.0)).unwrap()));
    slow.bench_function("fuselage1 to a net", |b| b.iter(|| fuselage.0.to_net(&fine).unwrap()));
    // A surface knows its area once it is measured: each time it is another one.
    let moved = || fuselage.0.moved(&Motion::translation(DVec3::X));
    slow.bench_function("fuselage1 area", |b| b.iter_batched(moved, |s| measure::area(&s), criterion::BatchSize::LargeInput));
}

criterion_group!(benches, builds, sweeps);
criterion_main!(benches);
