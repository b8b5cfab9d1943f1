//! What is answered from the text alone: outline, folds, colours, layout, completion, signatures.

use std::path::Path;

use serde_json::{Value, json};

use super::document::Document;
use crate::cli::repl::complete::{Known, call_at, candidates_in_script};
use crate::lang::fmt::format;
use crate::lang::syntax::ast::{Keyword, Span};
use crate::lang::syntax::keywords::written;
use crate::lang::syntax::outline::{Outline, Paint, outline, painted};

/// Colours as the editor knows them, in the order of [`colour`].
pub const COLOURS: [&str; 9] = ["keyword", "variable", "function", "property", "number", "string", "comment", "operator", "enumMember"];

fn colour(paint: Paint) -> usize {
    match paint {
        Paint::Keyword => 0,
        Paint::Name => 1,
        Paint::Function => 2,
        Paint::Property => 3,
        Paint::Number => 4,
        Paint::Text => 5,
        Paint::Comment => 6,
        Paint::Operator => 7,
        Paint::Constant => 8,
    }
}

/// The editor's number for what a keyword declares.
fn symbol_kind(keyword: Keyword) -> u8 {
    match keyword {
        Keyword::Fn => 12,
        Keyword::Param | Keyword::Let => 13,
        Keyword::Use | Keyword::Import => 2,
        Keyword::Point | Keyword::Curve | Keyword::ModelingCurve => 8,
        Keyword::Surface | Keyword::Shell => 5,
        Keyword::Mesh => 23,
        Keyword::Group => 18,
        _ => 14,
    }
}

pub fn symbols(document: &Document) -> Value {
    let symbol = |o: &Outline| {
        let keyword = o.keyword?;
        let name = match o.name {
            Some(name) => document.slice(name).to_owned(),
            None => document.slice(o.span).lines().next().unwrap_or("").to_owned(),
        };
        Some(json!({
            "name": name, "detail": written(keyword), "kind": symbol_kind(keyword),
            "range": document.range(o.span), "selectionRange": document.range(o.name.unwrap_or(o.span)),
        }))
    };
    outline(&document.text).iter().filter_map(symbol).collect()
}

pub fn folds(document: &Document) -> Value {
    let mut out = Vec::new();
    for o in outline(&document.text) {
        let (first, last) = (document.place(o.span.start as usize).0, document.place(o.span.end as usize).0);
        if last > first {
            out.push(json!({ "startLine": first, "endLine": last }));
        }
    }
    Value::Array(out)
}

pub fn colours(document: &Document) -> Value {
    let mut data: Vec<usize> = Vec::new();
    // The last place that was told, and its byte: counting from there, a line is walked over once.
    let (mut line, mut column, mut before) = (0, 0, 0);
    for (span, paint) in painted(&document.text) {
        let (mut start, end) = (span.start as usize, span.end as usize);
        // What runs over several lines is told line by line.
        while start < end {
            let next = document.next_line(start).min(end);
            let text = document.text[start..next].trim_end_matches(['\n', '\r']);
            if !text.is_empty() && start >= before {
                let here = match document.text[before..start].contains(['\n', '\r']) {
                    true => document.place(start),
                    false => (line, column + document.width(&document.text[before..start])),
                };
                data.extend([here.0 - line, here.1 - if here.0 == line { column } else { 0 }, document.width(text), colour(paint), 0]);
                (line, column, before) = (here.0, here.1, start);
            }
            start = next;
        }
    }
    json!({ "data": data })
}

pub fn layout(document: &Document) -> Value {
    let formatted = format(&document.text);
    if !formatted.changed {
        return json!([]);
    }
    let whole = Span { start: 0, end: document.text.len() as u32 };
    json!([{ "range": document.range(whole), "newText": formatted.text }])
}

pub fn completion(document: &Document, position: &Value) -> Value {
    let at = document.byte(position);
    let before = &document.text[..at];
    let known: Vec<Known> = outline(&document.text)
        .iter()
        .filter_map(|o| Some(Known { name: document.slice(o.name?).to_owned(), keyword: written(o.keyword?) }))
        .collect();
    let folder = document.path.as_deref().and_then(Path::parent).unwrap_or(Path::new("."));
    let (start, found) = candidates_in_script(before, &known, folder);
    let range = document.range(Span { start: start as u32, end: at as u32 });
    let items = found.into_iter().map(|pair| {
        let label = pair.replacement.trim_end_matches(['(', ' ', ':']).to_owned();
        let kind = if pair.replacement.ends_with('(') { 3 } else { 6 };
        json!({ "label": label, "kind": kind, "detail": pair.display, "textEdit": { "range": range, "newText": pair.replacement } })
    });
    items.collect()
}

pub fn signature(document: &Document, position: &Value) -> Value {
    let before = &document.text[..document.byte(position)];
    let Some((builtin, active)) = call_at(before) else { return Value::Null };
    let parameters: Vec<Value> = builtin.params.iter().map(|p| json!({ "label": p.name, "documentation": p.docs.trim() })).collect();
    json!({
        "signatures": [{ "label": builtin.signature(), "documentation": builtin.summary(), "parameters": parameters }],
        "activeSignature": 0, "activeParameter": active.min(builtin.params.len().saturating_sub(1)),
    })
}
