//! Text to tree: 100 000 points and 100 000 lines of two shapes, and a script where every shape is new; then 10 MB of
//! declarations, parsed as scripts are and by the parser that pest generates, which gives its pairs and no tree.
//!
//! The peer of the first is `benches/peers/p6_startup.py`; what the last shows is in `docs/notes/syntax.md`.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use std::fmt::Write as _;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use lofting::lang::diag::diagnostic::FileId;
use lofting::lang::syntax::parse;
use lofting::lang::words::names::Names;
use pest::Parser as _;

/// The generated parser alone.
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/loft.pest"]
    pub struct Grammar;
}

#[path = "shared/scripts.rs"]
mod scripts;

/// Bytes of a long script.
const BYTES: usize = 10_000_000;

/// The script of the peer.
fn points_and_lines(n: usize) -> String {
    let mut text = String::new();
    for i in 0..n {
        let _ = writeln!(text, "point p{i} = ({:.3}, {:.3}, 0)", i as f64 * 0.001, (i * 7919 % 1000) as f64 / 1000.0);
    }
    for i in 0..n {
        let _ = writeln!(text, "curve c{i} = line(p{i}, p{})", (i + 1) % n);
    }
    text
}

/// Lists whose lengths and items differ, so that no shape comes twice.
fn new_shapes(n: usize) -> String {
    let mut text = String::new();
    for i in 0..n {
        let items: Vec<&str> = (0..14).map(|bit| if i >> bit & 1 == 1 { "a" } else { "1mm" }).collect();
        let _ = writeln!(text, "let v{i} = [{}]", items.join(", "));
    }
    text
}

fn parsing(c: &mut Criterion) {
    let mut group = c.benchmark_group("parse");
    group.sample_size(10);
    for (name, text) in [
        ("200 000 declarations of two shapes", points_and_lines(100_000)),
        ("16 000 declarations, each of a new shape", new_shapes(16_000)),
    ] {
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(name, |b| {
            b.iter_batched_ref(Names::default, |names| parse(&text, FileId(0), names), BatchSize::PerIteration);
        });
    }
    group.finish();
}

fn parsers(c: &mut Criterion) {
    let mut group = c.benchmark_group("10 MB");
    group.sample_size(10);
    for (name, text) in
        [("two shapes", points_and_lines(150_000)), ("new shapes", scripts::new_sums(BYTES)), ("one list", scripts::one_list(BYTES))]
    {
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(format!("{name}, tree"), |b| {
            b.iter_batched_ref(Names::default, |names| parse(&text, FileId(0), names), BatchSize::PerIteration);
        });
        group.bench_function(format!("{name}, pairs of pest"), |b| {
            b.iter(|| grammar::Grammar::parse(grammar::Rule::script, &text).unwrap().len());
        });
    }
    group.finish();
}

criterion_group!(benches, parsing, parsers);
criterion_main!(benches);
