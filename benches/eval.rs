//! Evaluation: a comprehension that adds numbers, calls of a script's function, many declarations.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use criterion::{Criterion, criterion_group, criterion_main};
use lofting::base::job::Job;
use lofting::io::Memory;
use lofting::lang::eval::context::Cx;
use lofting::lang::eval::machine::on_big_stack;
use lofting::lang::run::phases::Entry;
use lofting::session::stages::Stages;

/// Parses and evaluates a script that has no mistakes.
fn run(text: &str) {
    let (files, job, clock) = (Memory::new(), Job::new(), || 0.0);
    on_big_stack(|| {
        let stages = Stages::new(&clock);
        let mut cx = Cx::new(&files, &stages, &job);
        cx.load(Entry { name: "bench.loft", path: "bench.loft", text: text.into(), sets: &[], row: None });
        cx.evaluate_all();
        assert!(!cx.has_errors());
    });
}

fn evaluation(c: &mut Criterion) {
    let mut group = c.benchmark_group("eval");
    group.sample_size(10);
    group.bench_function("a comprehension adding 10^6 numbers", |b| b.iter(|| run("let s = sum([for i in 0..1000000: i + 1])\n")));
    let calls = "fn f(x) = x * x + 1\nlet s = sum([for i in 0..100000: f(i)])\n";
    group.bench_function("10^5 calls of a function", |b| b.iter(|| run(calls)));
    let points: String = (0..200_000).map(|i| format!("point p{i} = ({i}, {}, 0)\n", i % 977)).collect();
    group.bench_function("200 000 points, parsed and evaluated", |b| b.iter(|| run(&points)));
    let lines: String = (0..100_000).map(|i| format!("curve c{i} = line(({i}, 0, 0), ({i}, 1, 0))\n")).collect();
    group.bench_function("100 000 lines, parsed and evaluated", |b| b.iter(|| run(&lines)));
    group.finish();
}

criterion_group!(benches, evaluation);
criterion_main!(benches);
