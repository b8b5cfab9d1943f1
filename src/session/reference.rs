//! The reference of the language, made from the tables that the interpreter uses.

use std::collections::BTreeMap;

use crate::base::limits;
use crate::lang::eval::std::{Builtin, builtins, fields};
use crate::lang::syntax::keywords::{KeywordDoc, WORDS, openers};
use crate::lang::values::settings::{BLOCKS, Setting};
use crate::lang::values::types::TYPE_NAMES;
use crate::lang::values::units::{LENGTHS, OTHERS};

/// Every word in a line each.
pub fn overview() -> String {
    let mut out = String::new();
    let mut section = |title: &str, mut words: Vec<(String, &str)>| {
        out.push_str(&format!("{title}\n"));
        words.dedup_by(|a, b| a.0 == b.0);
        let width = words.iter().map(|w| w.0.len()).max().unwrap_or(0);
        words.iter().for_each(|(name, summary)| out.push_str(&format!("  {name:width$}  {summary}\n")));
    };
    let sorted = |of: &mut dyn Iterator<Item = &'static Builtin>| {
        let mut words: Vec<(String, &str)> = of.map(|b| (b.name.to_owned(), b.summary())).collect();
        words.sort();
        words
    };
    let line = |w: &'static KeywordDoc| (w.written().to_owned(), first_sentence(w.docs));
    section("declarations", openers().into_iter().map(line).collect());
    section("words inside them", WORDS.iter().filter(|w| w.keyword.is_none()).map(line).collect());
    section("settings", settings().map(|(_, s)| (s.key.to_owned(), first_sentence(s.docs))).collect());
    section("functions", sorted(&mut builtins()));
    section("fields, written x.name or name(x)", sorted(&mut fields()));
    out.push_str("\n`loft doc NAME` tells more about one of them, and `loft doc E501` about a code.\n");
    out
}

pub(super) fn first_sentence(docs: &str) -> &str {
    docs.split(". ").next().unwrap_or(docs).trim_end_matches('.')
}

/// All settings with their blocks.
pub(super) fn settings() -> impl Iterator<Item = (&'static str, &'static Setting)> {
    BLOCKS.iter().flat_map(|(block, table)| table.iter().map(|s| (*block, s)))
}

/// The reference manual in Markdown: `docs/guide/reference.md`.
pub fn manual() -> String {
    let mut out = String::from(
        "# Reference\n\nEvery word of the language, from the tables that the interpreter uses \
         (`loft doc --markdown` prints this page).\n",
    );
    out.push_str("\n## Declarations\n");
    openers().into_iter().for_each(|w| out.push_str(&format!("\n### `{}`\n\n```text\n{}\n```\n\n{}\n", w.written(), w.form, w.docs)));
    let inside: Vec<_> = WORDS.iter().filter(|w| w.keyword.is_none()).collect();
    let forms = |form: &str| form.lines().map(|line| format!("`{line}`")).collect::<Vec<_>>().join("<br>");
    let rows = inside.iter().map(|w| vec![format!("`{}`", w.word), forms(w.form), w.docs.to_owned()]);
    table(&mut out, "## Words inside declarations", &["word", "written", ""], rows.collect());
    for (block, settings) in BLOCKS.iter().filter(|b| !b.1.is_empty()) {
        let row = |s: &Setting| vec![format!("`{}`", s.key), s.ty.signature(), s.default.to_owned(), s.docs.to_owned()];
        table(&mut out, &format!("## Settings of `{block}`"), &["setting", "takes", "default", ""], settings.iter().map(row).collect());
    }
    units(&mut out);
    let names: Vec<String> = TYPE_NAMES.iter().map(|name| format!("`{name}`")).collect();
    out.push_str(&format!("\n## Types\n\nIn `fn` and `param`: {}; `[length]` is a list of lengths.\n", names.join(", ")));
    out.push_str(LISTS);
    let row = |(what, value): &(&str, f64)| vec![what.trim().trim_end_matches('.').to_owned(), plain(*value)];
    table(&mut out, "## Limits", &["", "at most"], limits::ALL.iter().map(row).collect());
    out.push_str("\n## Functions\n");
    let mut functions: Vec<&Builtin> = builtins().collect();
    functions.sort_by_key(|b| b.name);
    functions.iter().for_each(|b| out.push_str(&manual_entry(b)));
    members(&mut out);
    out
}

/// What is taken where lists are wanted; said once for all functions and clauses.
const LISTS: &str = "
Where a list of things is wanted (`[curve]`, `curve…`, the things of `of`, `on`, `near` and of outputs), one thing is a list of one, and \
lists and families inside a list flatten: `holes: shaft`, `holes: [inner, bolts]`, `u: [west, ribs, east]`. Nets (`[[point]]`) and lists \
of anything (`[any]`) keep their rows.
";

/// A heading with a table; bars in cells are escaped.
fn table(out: &mut String, title: &str, head: &[&str], rows: Vec<Vec<String>>) {
    let line = |cells: &[String]| format!("| {} |\n", cells.iter().map(|c| c.replace('|', "\\|")).collect::<Vec<_>>().join(" | "));
    let head: Vec<String> = head.iter().map(|h| (*h).to_owned()).collect();
    out.push_str(&format!("\n{title}\n\n{}|{}\n", line(&head), "---|".repeat(head.len())));
    rows.iter().for_each(|row| out.push_str(&line(row)));
}

fn units(out: &mut String) {
    let length = LENGTHS.iter().map(|u| [u.name.to_owned(), format!("{}, also `{}2` and `{}3`", u.docs, u.name, u.name)]);
    let other = OTHERS.iter().map(|u| [u.name.to_owned(), u.docs.to_owned()]);
    let rows = length.chain(other).chain([["%".to_owned(), "hundredth".to_owned()]]);
    let rows = rows.map(|[name, docs]| vec![format!("`{name}`"), docs]).collect();
    table(out, "## Units", &["unit", ""], rows);
    out.push_str("\nGlued to a number: `3mm`, `2m2`, `7850kg/m3`. One `/` may stand between two of them.\n");
}

/// A limit in digits, grouped; powers of two above a megabyte in MiB.
fn plain(value: f64) -> String {
    const MIB: f64 = 1_048_576.0;
    if value >= 1e15 {
        return format!("{value:e}");
    }
    if value >= MIB && value % MIB == 0.0 {
        return format!("{} MiB", value / MIB);
    }
    let digits = format!("{value}");
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|group| std::str::from_utf8(group).ok()).collect();
    groups.join(" ")
}

/// Members of each kind of thing, a table each.
fn members(out: &mut String) {
    out.push_str("\n## Members\n\nWritten `x.name` or `name(x)`. Lengths are in model units, areas and volumes in their powers, angles in degrees.\n");
    let mut kinds: BTreeMap<String, Vec<&Builtin>> = BTreeMap::new();
    for field in fields() {
        let of = field.params.first().map(|p| p.ty.signature()).unwrap_or_default();
        kinds.entry(of).or_default().push(field);
    }
    for (kind, mut found) in kinds {
        found.sort_by_key(|b| b.name);
        let row = |field: &&Builtin| {
            let docs: Vec<&str> = field.docs.trim().lines().map(str::trim).filter(|line| !line.is_empty()).collect();
            vec![format!("`{}`", field.name), field.returns.signature(), unit_of(&field.returns.signature()).to_owned(), docs.join(" ")]
        };
        table(out, &format!("### Members of `{kind}`"), &["member", "gives", "unit", ""], found.iter().map(row).collect());
    }
}

/// The unit in which reports show a result of this type.
fn unit_of(signature: &str) -> &'static str {
    match signature.trim_matches(['[', ']', '?']) {
        "length" | "point" | "node" => "model unit",
        "area" => "model unit²",
        "volume" => "model unit³",
        "angle" => "degree",
        _ => "",
    }
}

fn manual_entry(builtin: &Builtin) -> String {
    let docs: Vec<&str> = builtin.docs.lines().map(|line| line.strip_prefix(' ').unwrap_or(line).trim_end()).collect();
    let mut out = format!("\n### `{}`\n\n```text\n{}\n```\n\n{}\n", builtin.name, builtin.signature(), docs.join("\n").trim());
    let params: Vec<_> = builtin.params.iter().filter(|p| !p.docs.trim().is_empty()).collect();
    if !params.is_empty() {
        out.push('\n');
    }
    for param in params {
        let words: Vec<&str> = param.docs.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        out.push_str(&format!("- `{}`: {}\n", param.name, words.join(" ")));
    }
    out
}
