//! Measured points of a hull: faired, fitted within their noise, gone through.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::geometry::Ends;
use lofting::geometry::construct::spline::Spacing;
use lofting::surface::points::fair::{Fairing, Held, fair};
use lofting::surface::points::fit_net::{Near, NetFitting, fit};
use lofting::surface::points::interpolate::{BorderEnds, grid};

/// 169 × 81 points of a carrier of 168 m, half breadths scattered by 5 mm, metres: the hull of the same case for FITPACK's regrid.
fn carrier() -> Vec<Vec<DVec3>> {
    let half_breadth = |x: f64, z: f64| {
        let c = ((2.0 * x / 168.0).abs() - 0.45).max(0.0) / 0.55;
        let bilge = 1.0 - (1.0 - z / 4.0).clamp(0.0, 1.0).powf(2.5);
        15.2 * (1.0 - c.powf(2.2)) * bilge.powf(0.6)
    };
    let mut state = 88_172_645_463_325_252_u64;
    let mut chance = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    // The sum of twelve is as good as normal.
    let mut scatter = move || 0.005 * ((0..12).map(|_| chance()).sum::<f64>() - 6.0);
    let at = |i: usize, j: usize| (i as f64 - 84.0, j as f64 * 18.0 / 80.0);
    let mut point = |i: usize, j: usize| {
        let (x, z) = at(i, j);
        DVec3::new(x, half_breadth(x, z) + scatter(), z)
    };
    (0..81).map(|j| (0..169).map(|i| point(i, j)).collect()).collect()
}

fn measured(c: &mut Criterion) {
    let (rows, tolerance) = (carrier(), Tolerance::new(1e-4, 172.0));
    let held = Held::Ends;
    let how = Fairing { within: 0.005, held, order: 3, spacing: Spacing::Chord, kinks: None, corners: Vec::new(), along: None };
    let noisy = NetFitting { near: Near::Noise(0.005), ends: BorderEnds::alike(Ends::Bessel), degree: 3 };
    let faired = |rows: &[Vec<DVec3>]| fair(rows, &how, Origin::NONE, &tolerance).unwrap().0;
    let fitted = |rows: &[Vec<DVec3>]| fit(rows, &noisy, Origin::NONE, &tolerance).unwrap().0;
    c.bench_function("fair 169 x 81 points", |b| b.iter(|| faired(black_box(&rows))));
    c.bench_function("fair a row of 169 points", |b| b.iter(|| faired(black_box(&rows[40..41]))));
    c.bench_function("fit 169 x 81 points within their noise", |b| b.iter(|| fitted(black_box(&rows))));
    c.bench_function("fair and fit 169 x 81 points", |b| {
        b.iter(|| {
            let made = faired(black_box(&rows));
            fitted(&made.points.chunks_exact(169).map(<[DVec3]>::to_vec).collect::<Vec<_>>())
        });
    });
    c.bench_function("grid through 169 x 81 points", |b| b.iter(|| grid(black_box(&rows), Origin::NONE, &tolerance).unwrap()));
}

criterion_group!(benches, measured);
criterion_main!(benches);
