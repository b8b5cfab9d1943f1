//! Requests and their answers.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lsp_server::Request;
use serde_json::{Value, json};

use super::document::Document;
use super::model::Facts;
use super::{names, text, told};
use crate::lang::scopes::Binding;

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
pub fn need(document: &Document, request: &Request) -> Need {
    match request.method.as_str() {
        "textDocument/codeLens" | "textDocument/codeAction" => Need::Model,
        "textDocument/hover" => word(document, &request.params["position"]).and_then(|w| w.declared).map_or(Need::Text, Need::Name),
        _ => Need::Text,
    }
}

/// The answer, or why there is none. What the request needs is known.
pub fn answer(document: &Document, facts: &Facts, request: &Request, others: &Others<'_>) -> Result<Value, String> {
    let position = &request.params["position"];
    Ok(match request.method.as_str() {
        "textDocument/hover" => hover(document, facts, position),
        "textDocument/definition" => names::definition(document, position, others),
        "textDocument/references" => names::references(document, position, others),
        "textDocument/rename" => names::rename(document, position, request.params["newName"].as_str().unwrap_or_default(), others)?,
        "textDocument/documentSymbol" => text::symbols(document),
        "textDocument/formatting" => text::layout(document),
        "textDocument/foldingRange" => text::folds(document),
        "textDocument/semanticTokens/full" => text::colours(document),
        "textDocument/completion" => text::completion(document, position),
        "textDocument/signatureHelp" => text::signature(document, position),
        "textDocument/codeLens" => told::lenses(facts, document),
        _ => told::actions(facts, document, &request.params["range"]),
    })
}

/// The word at a place.
struct Word<'d> {
    text: &'d str,
    /// The name of the script that it is.
    declared: Option<String>,
    behind_dot: bool,
    before_colon: bool,
}

fn word<'d>(document: &'d Document, position: &Value) -> Option<Word<'d>> {
    let text = document.text.as_str();
    let at = document.byte(position);
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let start = text[..at].char_indices().rev().take_while(|(_, c)| is_word(*c)).last().map_or(at, |(k, _)| k);
    let end = text[at..].find(|c: char| !is_word(c)).map_or(text.len(), |n| at + n);
    if start == end {
        return None;
    }
    let read = names::Read::new(text);
    let declared = read.at(start).filter(|o| matches!(o.binding, Binding::Declaration(_))).map(|o| read.text_of(o).to_owned());
    let (before, behind) = (text[..start].trim_end(), text[end..].trim_start());
    Some(Word { text: &text[start..end], declared, behind_dot: before.ends_with('.'), before_colon: behind.starts_with(':') })
}

/// What is known of the word at a place.
fn hover(document: &Document, facts: &Facts, position: &Value) -> Value {
    let about = word(document, position).and_then(|word| match word.declared {
        Some(name) => told::hover(facts, &name),
        None => names::about_word(word.text, word.behind_dot, word.before_colon),
    });
    about.map_or(Value::Null, |text| json!({ "contents": { "kind": "markdown", "value": text.trim_end() } }))
}
