//! Curves: meetings of many planar curves, and parameters at given arc lengths.
//!
//! The same problems are posed to other programs by `benches/peers/curves.py`.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::{Curve, Ends, Hit, Spline, build, intersect};

/// Reproducible numbers in [0, 1).
struct Lcg(u64);

impl Lcg {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Lines, arcs and cubic Bézier curves across a square of side 100, in turn from side to side and from bottom to top.
fn planar(count: usize) -> Vec<Curve> {
    let mut random = Lcg(7);
    (0..count)
        .map(|k| {
            let (a, b) = (100.0 * random.next(), 100.0 * random.next());
            let (c, d) = (16.0 * random.next() - 8.0, 16.0 * random.next() - 8.0);
            let at = |s: f64, t: f64| if (k / 3) % 2 == 0 { DVec3::new(s, t, 0.0) } else { DVec3::new(t, s, 0.0) };
            match k % 3 {
                0 => build::line(at(0.0, a), at(100.0, b), Origin::NONE),
                1 => {
                    let rise = c + if c >= 0.0 { 1.0 } else { -1.0 };
                    build::arc_through(at(0.0, a), at(100.0, b), at(50.0, 0.5 * (a + b) + rise), Origin::NONE)
                }
                _ => {
                    let poles = [at(0.0, a), at(33.0, a + (b - a) / 3.0 + 2.0 * c), at(66.0, b - (b - a) / 3.0 + 2.0 * d), at(100.0, b)];
                    build::bezier(&poles, None, Origin::NONE)
                }
            }
            .expect("the generator makes sound curves")
        })
        .collect()
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
