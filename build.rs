//! Writes the rules of `grammar/loft.pest` as a table for the matcher over tokens (`src/lang/syntax/token_rules.rs`).
#![allow(clippy::panic, clippy::expect_used, clippy::print_stdout, reason = "a build stops at what it cannot read and speaks to cargo")]

use std::fmt::Write as _;
use std::path::Path;

use pest_meta::ast::{Expr, RuleType};
use pest_meta::parser::{self, consume_rules, parse};

fn main() {
    println!("cargo::rerun-if-changed=grammar/loft.pest");
    let grammar = std::fs::read_to_string("grammar/loft.pest").expect("the grammar can be read");
    let pairs = parse(parser::Rule::grammar_rules, &grammar).unwrap_or_else(|error| panic!("{error}"));
    let rules = consume_rules(pairs).unwrap_or_else(|errors| panic!("{errors:?}"));
    let mut table = "&[\n".to_owned();
    for rule in rules {
        let (silent, atomic) = (rule.ty == RuleType::Silent, rule.ty == RuleType::Atomic);
        let expr = written(&rule.expr);
        let _ = writeln!(table, "    GrammarRule {{ name: {:?}, silent: {silent}, atomic: {atomic}, expr: {expr} }},", rule.name);
    }
    table.push(']');
    let folder = std::env::var("OUT_DIR").expect("cargo names a folder");
    std::fs::write(Path::new(&folder).join("grammar.rs"), table).expect("the table can be written");
}

/// An expression as a value of `GrammarExpr`.
fn written(expr: &Expr) -> String {
    let one = |kind: &str, inner: &Expr| format!("GrammarExpr::{kind}(&{})", written(inner));
    let many = |kind: &str, parts: Vec<&Expr>| {
        format!("GrammarExpr::{kind}(&[{}])", parts.into_iter().map(written).collect::<Vec<String>>().join(", "))
    };
    match expr {
        Expr::Str(text) => format!("GrammarExpr::Text({text:?})"),
        Expr::Ident(name) => format!("GrammarExpr::Name({name:?})"),
        Expr::Seq(..) => many("Sequence", parts(expr, |e| if let Expr::Seq(a, b) = e { Some((a, b)) } else { None })),
        Expr::Choice(..) => many("Choice", parts(expr, |e| if let Expr::Choice(a, b) = e { Some((a, b)) } else { None })),
        Expr::Rep(inner) => one("Repeat", inner),
        Expr::RepOnce(inner) => one("RepeatOnce", inner),
        Expr::Opt(inner) => one("Maybe", inner),
        Expr::NegPred(inner) => one("NotAhead", inner),
        _ => "GrammarExpr::Other".to_owned(),
    }
}

/// The parts of a sequence or choice, which `pest_meta` holds as pairs of pairs.
fn parts(expr: &Expr, halves: fn(&Expr) -> Option<(&Expr, &Expr)>) -> Vec<&Expr> {
    let Some((first, second)) = halves(expr) else { return vec![expr] };
    let mut all = parts(first, halves);
    all.extend(parts(second, halves));
    all
}
