//! All that is known of one word, for a terminal: declarations, settings, functions, members, and codes of reports.

use super::reference::{first_sentence, settings};
use super::similar::word_distance;
use crate::lang::diag::codes;
use crate::lang::eval::std::{Builtin, builtins, fields};
use crate::lang::syntax::keywords::{KeywordDoc, WORDS};
use crate::lang::values::settings::{Setting, blocks_of};
use crate::lang::values::types::TYPE_NAMES;

/// Words offered for one that is not known.
const OFFERED: usize = 3;

/// Words of a choice that the list of a block's settings shows.
const WORDS_SHOWN: usize = 16;

/// All that is known of a word or a code, or words that look like it.
pub fn entry(name: &str) -> Result<String, Vec<&'static str>> {
    if let Some(page) = codes::explain(&name.to_uppercase()) {
        return Ok(format!("{}\n", page.trim_end()));
    }
    let words = WORDS.iter().filter(|w| w.word == name || w.written() == name).map(text_of_word);
    let kind = (!WORDS.iter().any(|w| w.word == name)).then(|| text_of_kind(name)).flatten();
    let keys = settings().filter(|(_, s)| s.key == name).map(|(block, s)| text_of_setting(block, s));
    let calls = builtins().chain(fields()).filter(|b| b.name == name).map(text_of);
    let found: Vec<String> = words.chain(keys).chain(calls).chain(kind).collect();
    if found.is_empty() { Err(similar(name)) } else { Ok(found.join("\n")) }
}

/// What could have been meant: the code of that number, or words that are written alike.
fn similar(name: &str) -> Vec<&'static str> {
    let number = name.trim_start_matches(|c: char| !c.is_ascii_digit());
    if let Some(info) = codes::CODES.iter().find(|info| !number.is_empty() && &info.code[1..] == number) {
        return vec![info.code];
    }
    let all = builtins().chain(fields()).map(|b| b.name);
    let all = all.chain(WORDS.iter().map(KeywordDoc::written)).chain(settings().map(|(_, s)| s.key));
    let mut near: Vec<(usize, &'static str)> = all.filter_map(|w| word_distance(name, w).map(|d| (d, w))).collect();
    near.sort_unstable();
    near.dedup();
    near.into_iter().take(OFFERED).map(|(_, name)| name).collect()
}

/// A reserved word: how it is written, the settings of its block and the members of what it declares.
fn text_of_word(word: &KeywordDoc) -> String {
    let mut out = format!("{}\n\n  {}\n", word.form, word.docs);
    let mut blocks = blocks_of(word.word).peekable();
    if blocks.peek().is_none() && word.keyword.is_some() {
        out.push_str("\n  It takes no settings.\n");
    }
    for (form, table) in blocks {
        out.push_str(&format!("\n  settings of `{form}`\n"));
        table.iter().for_each(|setting| out.push_str(&line_of_setting(setting)));
    }
    if word.word == "mesh" {
        out.push_str("\n  clauses among them: `on things { … }`, `near points { … }`, `in box(a, b) { … }`\n");
    }
    out.push_str(&members_of(word.word));
    out
}

/// A setting in the list of its block.
fn line_of_setting(setting: &Setting) -> String {
    let default = if setting.default.is_empty() { String::new() } else { format!(" [default: {}]", setting.default) };
    let words = setting.ty.choices().filter(|words| words.len() > WORDS_SHOWN);
    let takes = words.map_or_else(
        || setting.ty.signature(),
        |words| format!("one of {} words, or a list of them (`loft doc {}`)", words.len(), setting.key),
    );
    format!("    {}: {takes}\n        {}{default}\n", setting.key, first_sentence(setting.docs))
}

/// A kind of thing that no reserved word declares: `edge`, `patch`.
fn text_of_kind(name: &str) -> Option<String> {
    let members = members_of(name);
    (TYPE_NAMES.contains(&name) && !members.is_empty()).then(|| format!("{name}, a type\n{members}"))
}

/// The fields of a thing of this kind; empty for words that are no kind.
fn members_of(kind: &str) -> String {
    let mut found: Vec<&Builtin> = fields().filter(|f| f.params.first().is_some_and(|p| p.ty.signature() == kind)).collect();
    if found.is_empty() {
        return String::new();
    }
    found.sort_by_key(|field| field.name);
    let width = found.iter().map(|field| field.name.len()).max().unwrap_or(0);
    let lines = found.iter().map(|field| format!("    {:width$}  {}\n", field.name, field.summary()));
    format!("\n  members, written x.name or name(x)\n{}", lines.collect::<String>())
}

/// A setting for a terminal.
fn text_of_setting(block: &str, setting: &Setting) -> String {
    let default = if setting.default.is_empty() { String::new() } else { format!(" [default: {}]", setting.default) };
    format!("{}: {}{default}\n\n  {}\n  Used in `{block}`.\n", setting.key, setting.ty.signature(), setting.docs)
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
