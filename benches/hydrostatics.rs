//! Hulls in the water: bodies made ready, states, equilibrium; of a Bézier patch and of triangles.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lofting::base::origin::Origin;
use lofting::base::tolerance::Tolerance;
use lofting::hydrostatics::body::{Body, FreeEdge};
use lofting::hydrostatics::equilibrium::{Load, equilibrium};
use lofting::hydrostatics::particulars::{Position, particulars};
use lofting::hydrostatics::triangles::free_sides;
use lofting::surface::points::control_net::{Net, bezier};

const HALF_LENGTH: f64 = 5.0;
const DRAFT: f64 = 0.625;

/// The side of the Wigley hull of length 10, beam 1 and draft 0.625, its water plane at z = 0.
fn wigley() -> Body {
    let row = |z: f64, y: f64| vec![DVec3::new(-HALF_LENGTH, 0.0, z), DVec3::new(0.0, y, z), DVec3::new(HALF_LENGTH, 0.0, z)];
    let rows = [row(-DRAFT, 0.0), row(-0.5 * DRAFT, 1.0), row(0.0, 1.0)];
    let tolerance = Tolerance::from_diagonal(10.0, 1.0);
    let side = bezier(&Net { rows: &rows, weights: None }, Origin::NONE, &tolerance).unwrap();
    let edge = |points: Vec<DVec3>| FreeEdge { of: Origin::NONE, points };
    let along = |z: f64| edge((0..=64).map(|k| point(f64::from(k) / 32.0 - 1.0, z)).collect());
    let up = |x: f64| edge((0..=64).map(|k| point(x, -DRAFT * (1.0 - f64::from(k) / 64.0))).collect());
    Body::of_faces(Origin::NONE, &[(side, true)], vec![along(-DRAFT), along(0.0), up(-1.0), up(1.0)], tolerance.point).unwrap()
}

/// A point of it at x as a share of the half length.
fn point(x: f64, z: f64) -> DVec3 {
    DVec3::new(x * HALF_LENGTH, 0.5 * (1.0 - x * x) * (1.0 - (z / DRAFT) * (z / DRAFT)), z)
}

/// Both sides as triangles, the deck in the water plane open.
fn triangles((along, up): (u32, u32)) -> Body {
    let mut nodes = Vec::new();
    for side in [1.0, -1.0] {
        for j in 0..=up {
            for i in 0..=along {
                let p = point(2.0 * f64::from(i) / f64::from(along) - 1.0, DRAFT * (f64::from(j) / f64::from(up) - 1.0));
                nodes.push(DVec3::new(p.x, side * p.y, p.z));
            }
        }
    }
    let mut corners = Vec::new();
    for side in 0..2 {
        let first = side * (along + 1) * (up + 1);
        for (j, i) in (0..up).flat_map(|j| (0..along).map(move |i| (j, i))) {
            let a = first + j * (along + 1) + i;
            let (b, c, d) = (a + 1, a + along + 2, a + along + 1);
            corners.extend(if side == 0 { [[a, c, b], [a, d, c]] } else { [[a, b, c], [a, c, d]] });
        }
    }
    let edge = |side: &[u32; 2]| FreeEdge { of: Origin::NONE, points: side.iter().map(|k| nodes[*k as usize]).collect() };
    let free = free_sides(&corners).iter().map(edge).filter(|edge| edge.points.iter().any(|p| p.y != 0.0)).collect();
    Body::of_triangles(Origin::NONE, nodes, corners, free, 1e-6).unwrap()
}

fn level(draft: f64) -> Position {
    let upright = Position { depth: 0.0, trim: 0.0, heel: 0.0, base: -DRAFT, midship: 0.0 };
    upright.with_draft(draft)
}

fn floating(c: &mut Criterion) {
    let mut group = c.benchmark_group("hydrostatics");
    let side = wigley();
    group.bench_function("Wigley made ready", |b| b.iter(wigley));
    group.bench_function("Wigley, a draft", |b| b.iter(|| particulars(black_box(&side), &level(0.4)).unwrap()));
    let inclined = Position { trim: 0.01, heel: 0.05, ..level(0.4) };
    group.bench_function("Wigley, heeled and trimmed", |b| b.iter(|| particulars(black_box(&side), &inclined).unwrap()));
    let load = Load { volume: 1.5, center: DVec3::new(0.1, 0.0, -0.3) };
    group.bench_function("Wigley, equilibrium", |b| b.iter(|| equilibrium(black_box(&side), &load, None, level(0.4)).unwrap()));
    group.sample_size(10);
    let mesh = triangles((580, 50));
    group.bench_function("116 000 triangles made ready", |b| b.iter(|| triangles((580, 50))));
    group.bench_function("116 000 triangles, a draft", |b| b.iter(|| particulars(black_box(&mesh), &level(0.4)).unwrap()));
    group.finish();
}

criterion_group!(benches, floating);
criterion_main!(benches);
