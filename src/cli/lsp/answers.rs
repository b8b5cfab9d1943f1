//! Requests and their answers.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lsp_server::Request;
use serde_json::{Value, json};

use super::document::Document;
use super::model::Facts;
use super::{names, results, text};
use crate::lang::assist::About;

/// What is needed before a request can be answered.
pub enum Need {
    Text,
    Model,
    /// The value of a name.
    Name(String),
}

/// All that is served.
pub const SERVED: [&str; 12] = [
    "textDocument/hover",
    "textDocument/definition",
    "textDocument/references",
    "textDocument/rename",
    "textDocument/documentSymbol",
    "textDocument/formatting",
    "textDocument/foldingRange",
    "textDocument/semanticTokens/full",
    "textDocument/completion",
    "textDocument/signatureHelp",
    "textDocument/codeLens",
    "textDocument/codeAction",
];

/// Files beside one: open ones as they stand in the editor, others as they are on the disk.
pub struct Others<'o> {
    open: BTreeMap<PathBuf, &'o Document>,
}

impl<'o> Others<'o> {
    pub fn new(open: impl Iterator<Item = &'o Document>) -> Self {
        Self { open: open.filter_map(|d| Some((d.path.as_ref()?.canonicalize().ok()?, d))).collect() }
    }

    /// The file of a resolved path.
    pub fn find(&self, path: &Path) -> Option<Document> {
        match self.open.get(path) {
            Some(document) => Some((*document).clone()),
            None => names::on_disk(path),
        }
    }

    /// Resolved paths of all open files.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.open.keys().map(PathBuf::as_path)
    }
}

/// What a request is about.
pub fn need(document: &Document, facts: &Facts, request: &Request, others: &Others<'_>) -> Need {
    match request.method.as_str() {
        "textDocument/codeLens" | "textDocument/codeAction" => Need::Model,
        "textDocument/hover" => match about(document, facts, &request.params["position"], others) {
            Some(About::Declared { name, .. }) => Need::Name(name),
            _ => Need::Text,
        },
        _ => Need::Text,
    }
}

fn about(document: &Document, facts: &Facts, position: &Value, others: &Others<'_>) -> Option<About> {
    text::assisted(document, facts, others, |script| script.hover(document.byte(position)))
}

/// The answer, or why there is none. What the request needs is known.
pub fn answer(document: &Document, facts: &Facts, request: &Request, others: &Others<'_>) -> Result<Value, String> {
    let position = &request.params["position"];
    Ok(match request.method.as_str() {
        "textDocument/hover" => hover(document, facts, position, others),
        "textDocument/definition" => names::definition(document, position, others),
        "textDocument/references" => names::references(document, position, others),
        "textDocument/rename" => names::rename(document, position, request.params["newName"].as_str().unwrap_or_default(), others)?,
        "textDocument/documentSymbol" => text::symbols(document),
        "textDocument/formatting" => text::layout(document),
        "textDocument/foldingRange" => text::folds(document),
        "textDocument/semanticTokens/full" => text::colours(document),
        "textDocument/completion" => text::completion(document, facts, &request.params, others),
        "textDocument/signatureHelp" => text::signature(document, facts, position, others),
        "textDocument/codeLens" => results::lenses(facts, document),
        _ => results::actions(facts, document, &request.params["range"]),
    })
}

/// What is known of the word at a place; of a name also its value, as far as that is known already.
fn hover(document: &Document, facts: &Facts, position: &Value, others: &Others<'_>) -> Value {
    let text = match about(document, facts, position, others) {
        Some(About::Words(words)) => words,
        Some(About::Declared { name, line, docs }) => results::hover(facts, document, &name, &line, &docs),
        None => return Value::Null,
    };
    json!({ "contents": { "kind": "markdown", "value": text.trim_end() } })
}
