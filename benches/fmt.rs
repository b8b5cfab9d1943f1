//! Layout of 10 MB of script: many short declarations, declarations that must be broken, one list of points, and
//! declarations that are all of another shape.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, missing_docs, reason = "a benchmark is no product code")]

use std::fmt::Write as _;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lofting::lang::fmt::format;

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

/// One declaration.
fn points() -> String {
    let mut text = "let points = [".to_owned();
    while text.len() < BYTES {
        text += "(1.5, 22.25, 3m), ";
    }
    text += "(0, 0, 0)]\n";
    text
}

/// Declarations of which hardly two have the same tokens in the same order.
fn new_shapes() -> String {
    let (mut text, mut seed) = (String::new(), 1_u64);
    let mut random = |below: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % below
    };
    for i in 0.. {
        let _ = write!(text, "let v{i} = a");
        for _ in 0..random(40) {
            let operator = ["+", "-", "*", "/"][random(4) as usize];
            let operand = ["b1", "2.5", "3m", "(1, 2, 3m)", "p.x", "f(a, of: b)", "[a, b]", "c[i]", "(a - 1)"][random(9) as usize];
            let _ = write!(text, " {operator} {operand}");
        }
        text.push('\n');
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
        ("one list", points()),
        ("new shapes", new_shapes()),
    ];
    for (name, text) in scripts {
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(name, |b| b.iter(|| format(&text)));
    }
    group.finish();
}

criterion_group!(benches, layout);
criterion_main!(benches);
