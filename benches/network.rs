//! Networks from curves, counts checked: planar and spatial ones with tens of thousands of crossings, rows of lines,
//! one curve inserted among five thousand. Beside the peers: `benches/peers/network.py`.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

#[path = "shared/nets.rs"]
mod nets;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use lofting::base::job::Job;
use lofting::base::tolerance::Tolerance;
use lofting::network::{Input, Network};

/// Tolerance as a share of the diagonal.
const COUNTED: f64 = 1e-8;

fn build(inputs: Vec<Input>, diagonal: f64) -> Network {
    // Tight enough that no two crossings of a near tangency are one node.
    let tolerance = Tolerance::new(COUNTED * diagonal, diagonal);
    Network::build(inputs, &[], &tolerance, &Job::new(), &mut Vec::new()).expect("the network is sound")
}

fn counts(network: &Network) -> (usize, usize) {
    (network.nodes.len(), network.links.len())
}

/// Name, maker, size, nodes and links where known, diagonal.
type Case = (&'static str, fn(usize) -> Vec<Input>, usize, (usize, usize), f64);

fn networks(c: &mut Criterion) {
    // One thread: the wall time is the CPU time.
    lofting::base::par::set_threads(1);
    let mut group = c.benchmark_group("network");
    group.sample_size(10);
    let cases: [Case; 8] = [
        ("planar", nets::planar, 30, (372, 654), 141.0),
        ("planar", nets::planar, 100, (4_027, 7_754), 141.0),
        ("planar", nets::planar, 300, (34_464, 68_028), 141.0),
        ("ruled", nets::ruled, 10, (310, 530), 245.0),
        ("ruled", nets::ruled, 33, (2_921, 5_545), 245.0),
        ("ruled", nets::ruled, 100, (25_600, 50_300), 245.0),
        ("row", nets::row, 100_000, (100_001, 100_000), 100_000.0),
        ("scattered", nets::scattered, 5_000, (0, 0), 1414.0),
    ];
    for (name, make, n, expected, diagonal) in cases {
        if expected.0 > 0 {
            assert_eq!(counts(&build(make(n), diagonal)), expected, "{name} {n}");
        }
        // Curves are made afresh, so that nothing they keep is measured away.
        group
            .bench_function(format!("{name} {n}"), |b| b.iter_batched(|| make(n), |inputs| build(inputs, diagonal), BatchSize::LargeInput));
    }
    let mut inputs = nets::scattered(5_001);
    let one = inputs.pop().expect("there are 5 001");
    let tolerance = Tolerance::new(COUNTED * 1414.0, 1414.0);
    let network = build(inputs, 1414.0);
    group.bench_function("insert one among 5000", |b| {
        b.iter_batched(
            || (network.clone(), one.clone()),
            |(mut network, one)| network.insert(one, &tolerance, &Job::new(), &mut Vec::new()).expect("the network is sound"),
            BatchSize::LargeInput,
        )
    });
    group.finish();
}

criterion_group!(benches, networks);
criterion_main!(benches);
