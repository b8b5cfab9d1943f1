//! Long scripts that several benchmarks read.

use std::fmt::Write as _;

/// At least so many bytes of sums of which hardly two have the same tokens in the same order.
pub fn new_sums(bytes: usize) -> String {
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
        if text.len() > bytes {
            break;
        }
    }
    text
}

/// One declaration of at least so many bytes: a list of points.
pub fn one_list(bytes: usize) -> String {
    let mut text = "let points = [".to_owned();
    while text.len() < bytes {
        text += "(1.5, 22.25, 3m), ";
    }
    text += "(0, 0, 0)]\n";
    text
}
