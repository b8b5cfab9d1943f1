//! Running a model again after a change: one number of 200 curves and 50 surfaces, beside a mesh of 200 000 elements.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::disallowed_methods,
    missing_docs,
    reason = "a benchmark is no product code"
)]

use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use lofting::base::job::Job;
use lofting::session::live::{Depth, Live};

/// Two fields of 5 × 5 patches between arcs, and lines beside them. The first field is meshed; `lift` moves one node of
/// the second one, or of the first.
fn model(lift: f64, of_mesh: bool) -> String {
    let mut text = "units m\nparam lift = ".to_owned();
    writeln!(text, "{lift}m").unwrap();
    for field in 0..2 {
        let x = |i: usize| 100 * field + 4 * i;
        let moved = |i: usize, j: usize| (i, j) == (2, 2) && (field == 0) == of_mesh;
        let at = |i: usize, j: usize| {
            let up = if moved(i, j) { " + lift" } else { "" };
            format!("({}, {}, {}m{up})", x(i), 4 * j, 1.0 + 0.1 * (i * j) as f64)
        };
        for j in 0..6 {
            for i in 0..5 {
                let z = 1.5 + 0.1 * i as f64 * j as f64;
                writeln!(text, "curve u{field}_{i}_{j} = arc({}, {}, through: ({}, {}, {z}))", at(i, j), at(i + 1, j), x(i) + 2, 4 * j)
                    .unwrap();
                let z = 1.5 + 0.1 * i as f64 * j as f64;
                writeln!(text, "curve v{field}_{j}_{i} = arc({}, {}, through: ({}, {}, {z}))", at(j, i), at(j, i + 1), x(j), 4 * i + 2)
                    .unwrap();
            }
        }
        for j in 0..5 {
            for i in 0..5 {
                let (up, right) = (j + 1, i + 1);
                writeln!(
                    text,
                    "surface s{field}_{i}_{j} = coons(u{field}_{i}_{j}, v{field}_{right}_{j}, u{field}_{i}_{up}, v{field}_{i}_{j})"
                )
                .unwrap();
            }
        }
    }
    for k in 0..80 {
        writeln!(text, "curve x{k} = line(({k}, 50, 0), ({k}.5, 60, {}))", k % 7).unwrap();
    }
    let members: Vec<String> = (0..25).map(|k| format!("s0_{}_{}", k % 5, k / 5)).collect();
    writeln!(text, "shell hall of {}\nmesh fine of hall {{ size: 67mm }}", members.join(", ")).unwrap();
    text
}

fn live() -> Live {
    let started = Instant::now();
    Live::new("bench.loft", None, &[], Arc::new(move || started.elapsed().as_secs_f64()))
}

/// Seconds of a run, and what it took over.
fn run(live: &mut Live, lift: f64, of_mesh: bool) -> (f64, usize) {
    let text = model(lift, of_mesh);
    let job = Job::new();
    let started = Instant::now();
    let outcome = live.run(&text, &[], Depth::Report, &job, &mut |_| {}).unwrap();
    let seconds = started.elapsed().as_secs_f64();
    assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
    let mesh = &outcome.report.meshes[0];
    assert!((190_000..200_001).contains(&mesh.triangles), "{} elements", mesh.triangles);
    (seconds, outcome.reused)
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

/// Medians of fresh runs and of runs after a change, in turn, so that both meet the same machine.
fn beside_a_fresh_run() {
    for (of_mesh, what) in [(false, "a curve beside the mesh"), (true, "one node of the mesh")] {
        let mut kept = live();
        run(&mut kept, 0.0, of_mesh);
        let (mut cold, mut warm) = (Vec::new(), Vec::new());
        for k in 1..16 {
            let lift = f64::from(k) * 0.01;
            cold.push(run(&mut live(), lift, of_mesh).0);
            warm.push(run(&mut kept, lift, of_mesh).0);
        }
        let (cold, warm) = (median(cold), median(warm));
        println!("{what} changed: {:.1} ms, a fresh run {:.1} ms, {:.1} times faster", 1e3 * warm, 1e3 * cold, cold / warm);
    }
}

fn again(c: &mut Criterion) {
    beside_a_fresh_run();
    let mut group = c.benchmark_group("again");
    group.sample_size(10);
    for (of_mesh, what) in [(false, "after a curve beside the mesh changed"), (true, "after one node of the mesh changed")] {
        let (mut kept, mut lift) = (live(), 0.0);
        group.bench_function(what, |b| {
            b.iter(|| {
                lift = if lift > 0.5 { 0.0 } else { lift + 0.001 };
                run(&mut kept, lift, of_mesh)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, again);
criterion_main!(benches);
