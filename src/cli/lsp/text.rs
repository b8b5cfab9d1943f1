//! What is answered from the text alone: outline, folds, colours, layout, completion, signatures.

use std::path::Path;

use serde_json::{Value, json};

use super::answers::Others;
use super::document::Document;
use super::model::Facts;
use crate::cli::repl::complete::files;
use crate::lang::assist::{EditedScript, Sort};
use crate::lang::diag::span::Span;
use crate::lang::fmt::format;
use crate::lang::syntax::ast::Keyword;
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
    // The last place that was given, and its byte: counting from there, each line is read once.
    let (mut line, mut column, mut before) = (0, 0, 0);
    for (span, paint) in painted(&document.text) {
        let (mut start, end) = (span.start as usize, span.end as usize);
        // What runs over several lines is given line by line.
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

/// A document as the engine that helps while typing reads it, handed to `work`.
pub fn assisted<T>(document: &Document, facts: &Facts, others: &Others<'_>, work: impl FnOnce(&EditedScript<'_>) -> T) -> T {
    let open = |from: &str, written: &str| {
        let path = Path::new(from).parent()?.join(written).canonicalize().ok()?;
        let module = others.find(&path)?;
        Some((path.to_string_lossy().into_owned(), module.text))
    };
    let path = document.path.as_deref().map_or(String::new(), |path| path.to_string_lossy().into_owned());
    work(&EditedScript { text: &document.text, path: &path, open: &open, known: &facts.shapes, session: false })
}

/// The editor's number for what a candidate is.
fn candidate_kind(sort: Sort) -> u8 {
    match sort {
        Sort::Function => 3,
        Sort::Field => 5,
        Sort::Name => 6,
        Sort::Argument | Sort::Setting => 10,
        Sort::Keyword => 14,
        Sort::Word => 20,
    }
}

pub fn completion(document: &Document, facts: &Facts, params: &Value, others: &Others<'_>) -> Value {
    let at = document.byte(&params["position"]);
    let offer = assisted(document, facts, others, |script| script.complete(at));
    let range = document.range(Span { start: offer.start as u32, end: at as u32 });
    if offer.file {
        let folder = document.path.as_deref().and_then(Path::parent).unwrap_or(Path::new("."));
        let (start, found) = files(&document.text[..at], offer.start, folder);
        let range = document.range(Span { start: start as u32, end: at as u32 });
        let item = |name: String| json!({ "label": name, "kind": 17, "textEdit": { "range": range, "newText": name } });
        return found.into_iter().map(item).collect();
    }
    // A blank opens the list where few words are asked for, not wherever anything may stand.
    let few = offer.candidates.first().is_some_and(|best| matches!(best.sort, Sort::Setting | Sort::Word));
    if params["context"]["triggerCharacter"] == " " && !few {
        return json!([]);
    }
    let items = offer.candidates.iter().enumerate().map(|(place, candidate)| {
        let label = candidate.text.trim_end_matches(['(', ' ', ':']);
        json!({
            "label": label, "kind": candidate_kind(candidate.sort), "detail": candidate.about, "sortText": format!("{place:05}"),
            "textEdit": { "range": range, "newText": candidate.text },
        })
    });
    items.collect()
}

pub fn signature(document: &Document, facts: &Facts, position: &Value, others: &Others<'_>) -> Value {
    let at = document.byte(position);
    let Some((function, active)) = assisted(document, facts, others, |script| script.call(at)) else { return Value::Null };
    let parameters: Vec<Value> = function.params.iter().map(|p| json!({ "label": p.name, "documentation": p.docs })).collect();
    json!({
        "signatures": [{ "label": function.signature, "documentation": function.summary(), "parameters": parameters }],
        "activeSignature": 0, "activeParameter": active.unwrap_or(function.params.len()),
    })
}
