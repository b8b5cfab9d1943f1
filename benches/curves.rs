//! Curves: meetings of many planar curves, and parameters at given arc lengths.
//!
//! The same problems are posed to other programs by `benches/peers/curves.py`.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::construct::build;
use lofting::geometry::intersect;
use lofting::geometry::{Curve, Ends, Hit, Spline};

#[allow(dead_code, reason = "the benchmark of networks uses the rest")]
#[path = "shared/nets.rs"]
mod nets;

/// The curves of the planar network.
fn planar(count: usize) -> Vec<Curve> {
    nets::planar(count).into_iter().map(|input| input.curve).collect()
}

fn meetings(curves: &[Curve], tolerance: &Tolerance) -> usize {
    let mut points = 0;
    for (i, a) in curves.iter().enumerate() {
        for b in &curves[i + 1..] {
            let hits = intersect(a, b, tolerance).expect("no curve of the generator is degenerate");
            points += hits.iter().filter(|hit| matches!(hit, Hit::Point { .. })).count();
        }
    }
    points
}

/// The closed space curve through 40 points that the peers measure.
fn wavy_spline() -> Curve {
    let points: Vec<DVec3> = (0..40)
        .map(|i| {
            let a = 1.8 * std::f64::consts::PI * f64::from(i) / 39.0;
            let sine = lofting::base::math::sin;
            let cosine = lofting::base::math::cos(a);
            DVec3::new(50.0 + 40.0 * cosine * (1.0 + 0.2 * lofting::base::math::cos(5.0 * a)), 50.0 + 40.0 * sine(a), 10.0 * sine(3.0 * a))
        })
        .collect();
    let ends = Spline { start: Ends::Natural, end: Ends::Natural, closed: false };
    build::spline(&points, &ends, Origin::NONE).expect("the points differ")
}

fn bench(c: &mut Criterion) {
    let tolerance = Tolerance::from_diagonal(141.4, 1e-3);
    c.bench_function("meetings of 300 planar curves", |b| {
        b.iter_batched(|| planar(300), |curves| assert_eq!(meetings(&curves, &tolerance), 33_864), criterion::BatchSize::LargeInput)
    });
    let curve = wavy_spline();
    let length = curve.length();
    let lengths: Vec<f64> = (0..100_000).map(|i| length * f64::from(i) / 99_999.0).collect();
    let mut params = Vec::with_capacity(lengths.len());
    c.bench_function("100 000 parameters at arc lengths, ascending", |b| {
        b.iter(|| {
            params.clear();
            curve.params_at_lengths(&lengths, &mut params);
        })
    });
    c.bench_function("100 000 parameters at arc lengths, one by one", |b| {
        b.iter(|| lengths.iter().map(|s| curve.param_at_length(*s)).sum::<f64>())
    });
    c.bench_function("length table of a spline through 40 points", |b| {
        b.iter_batched(wavy_spline, |curve| curve.length(), criterion::BatchSize::SmallInput)
    });
    c.bench_function("100 000 lines made and measured", |b| {
        b.iter(|| {
            (0..100_000)
                .map(|i| build::line(DVec3::ZERO, DVec3::splat(1.0 + f64::from(i)), Origin::NONE).expect("ends differ").length())
                .sum::<f64>()
        })
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
