//! The reference of the language, made from the tables that the interpreter uses.

use crate::lang::std::{Builtin, builtins, fields};

/// Every word in a line each.
pub fn overview() -> String {
    let mut out = String::new();
    let mut section = |title: &str, words: &mut dyn Iterator<Item = &'static Builtin>| {
        out.push_str(&format!("{title}\n"));
        let mut words: Vec<(String, &str)> = words.map(|b| (b.name.to_owned(), b.summary())).collect();
        words.sort();
        words.dedup_by(|a, b| a.0 == b.0);
        let width = words.iter().map(|w| w.0.len()).max().unwrap_or(0);
        words.iter().for_each(|(name, summary)| out.push_str(&format!("  {name:width$}  {summary}\n")));
    };
    section("functions", &mut builtins());
    section("fields, written x.name or name(x)", &mut fields());
    out.push_str("\n`loft doc NAME` tells more about one of them.\n");
    out
}

/// All that is known of a word, or words that look like it.
pub fn entry(name: &str) -> Result<String, Vec<&'static str>> {
    let found: Vec<&Builtin> = builtins().chain(fields()).filter(|b| b.name == name).collect();
    if found.is_empty() {
        let mut near: Vec<(usize, &'static str)> =
            builtins().chain(fields()).filter_map(|b| super::similar::word_distance(name, b.name).map(|d| (d, b.name))).collect();
        near.sort_unstable();
        near.dedup();
        return Err(near.into_iter().take(3).map(|(_, name)| name).collect());
    }
    Ok(found.into_iter().map(text_of).collect::<Vec<_>>().join("\n"))
}

/// A word for a terminal.
fn text_of(builtin: &Builtin) -> String {
    let mut out = format!("{}\n\n", builtin.signature());
    for line in builtin.docs.trim().lines().filter(|line| !line.trim_start().starts_with("```")) {
        let line = format!("  {}", line.strip_prefix(' ').unwrap_or(line));
        out.push_str(line.trim_end());
        out.push('\n');
    }
    for param in builtin.params.iter().filter(|p| !p.docs.trim().is_empty()) {
        let default = param.default.map(|d| format!(" [default: {d}]")).unwrap_or_default();
        out.push_str(&format!("\n  {}: {}\n      {}{default}\n", param.name, param.ty.signature(), param.docs.trim()));
    }
    out
}

/// The reference manual in Markdown: `docs/guide/reference.md`.
pub fn manual() -> String {
    let mut out = String::from(
        "# Reference\n\nEvery function and field of the language, from the declarations that the interpreter uses \
         (`loft doc --markdown` prints this page).\n\n## Functions\n",
    );
    let mut functions: Vec<&Builtin> = builtins().collect();
    functions.sort_by_key(|b| b.name);
    functions.iter().for_each(|b| out.push_str(&manual_entry(b)));
    out.push_str(
        "\n## Members\n\nWritten `x.name` or `name(x)`. Lengths are in model units, areas and volumes in their powers, angles in degrees.\n\n\
         | of | member | gives | unit | |\n|---|---|---|---|---|\n",
    );
    let mut all: Vec<(String, &Builtin)> = fields().map(|b| (b.params.first().map(|p| p.ty.signature()).unwrap_or_default(), b)).collect();
    all.sort_by(|a, b| (&a.0, a.1.name).cmp(&(&b.0, b.1.name)));
    for (of, field) in all {
        let cell = |text: &str| text.replace('|', "\\|");
        let docs: Vec<&str> = field.docs.trim().lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        let (gives, unit) = (field.returns.signature(), unit_of(&field.returns.signature()));
        let row = format!("| {} | `{}` | {} | {unit} | {} |\n", cell(&of), field.name, cell(&gives), cell(&docs.join(" ")));
        out.push_str(&row);
    }
    out
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
