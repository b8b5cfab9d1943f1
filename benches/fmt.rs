//! Layout of 10 MB of script: many short declarations, declarations that must be broken, one list of points, and
//! declarations that are all of another shape.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use std::fmt::Write as _;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lofting::lang::fmt::format;

#[path = "shared/scripts.rs"]
mod scripts;

/// Bytes of each script.
const BYTES: usize = 10_000_000;

/// Points, curves and comments.
fn declarations() -> String {
    let mut text = String::new();
    for i in 0.. {
        let _ = writeln!(text, "point p{i}=( {:.3} , {:.3},0 )   // the {i}th", i as f64 * 0.001, (i * 7919 % 1000) as f64 / 1000.0);
        let _ = writeln!(text, "curve  c{i} = line(p{i},p{}+(0,0,1m))", i + 1);
        if text.len() > BYTES {
            break;
        }
    }
    text
}

/// Calls that do not fit on a line, settings, comprehensions.
fn long_declarations() -> String {
    let mut text = String::new();
    for i in 0.. {
        let _ = writeln!(
            text,
            "surface s{i} = transfinite(u: [front_{i}, ridge_west + ridge_east], v: [verge_low + verge_high, rafter[front..], mast[front..] + mast_top])\n\
             mesh m{i} of s{i} {{ size: 400mm, elements: quads /* only */\n on hem {{ bias: 2 }} }}\n\
             let t{i} = [for r in table.rows: (r.x, -r.width / 2, 0) + rotate((p.x, 0, p.y) * (chord / 1m), angle: twist, axis: (0, 1, 0))]"
        );
        if text.len() > BYTES {
            break;
        }
    }
    text
}

fn layout(c: &mut Criterion) {
    let mut group = c.benchmark_group("fmt");
    group.sample_size(10);
    let scripts = [
        ("short declarations", declarations()),
        ("long declarations", long_declarations()),
        ("one list", scripts::one_list(BYTES)),
        ("new shapes", scripts::new_sums(BYTES)),
    ];
    for (name, text) in scripts {
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(name, |b| b.iter(|| format(&text)));
    }
    group.finish();
}

criterion_group!(benches, layout);
criterion_main!(benches);
