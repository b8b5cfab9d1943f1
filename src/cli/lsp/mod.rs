//! `loft lsp`: the language server, over standard input and output.

mod document;
mod model;
mod names;
mod text;

use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};

use clap::ArgMatches;
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, Response};
use serde_json::{Value, json};

use super::{Command, Exit, Terminal};
use crate::lang::scopes::Binding;
use document::Document;
use model::Model;

/// Serves an editor.
pub const COMMAND: Command = Command { name: "lsp", about: "Language server for editors, over standard input and output", arguments, run };

/// How long a file must rest before it is evaluated.
const REST: Duration = Duration::from_millis(150);

fn arguments(command: clap::Command) -> clap::Command {
    // Editors like to say which way they talk.
    command.arg(clap::Arg::new("stdio").long("stdio").action(clap::ArgAction::SetTrue).hide(true))
}

fn run(_: &ArgMatches, terminal: &Terminal) -> Exit {
    let (connection, threads) = Connection::stdio();
    let served = serve(&connection);
    drop(connection);
    match (served, threads.join()) {
        (Ok(()), Ok(())) => Exit::Fine,
        (Err(text), _) => terminal.wrong_usage(&format!("the editor broke off: {text}")),
        (_, Err(error)) => terminal.wrong_usage(&format!("the editor broke off: {error}")),
    }
}

struct Open {
    document: Document,
    model: Model,
    /// When it is to be evaluated.
    due: Option<Instant>,
}

struct Server<'c> {
    connection: &'c Connection,
    open: BTreeMap<String, Open>,
    waiting: VecDeque<Message>,
    bytes: bool,
}

fn capabilities(bytes: bool) -> Value {
    json!({
        "positionEncoding": if bytes { "utf-8" } else { "utf-16" },
        "textDocumentSync": { "openClose": true, "change": 2, "save": true },
        "hoverProvider": true, "definitionProvider": true, "referencesProvider": true, "renameProvider": true,
        "documentSymbolProvider": true, "documentFormattingProvider": true, "foldingRangeProvider": true,
        "codeLensProvider": {}, "codeActionProvider": true,
        "completionProvider": { "triggerCharacters": [".", "\"", "/"] },
        "signatureHelpProvider": { "triggerCharacters": ["(", ","] },
        "semanticTokensProvider": { "legend": { "tokenTypes": text::COLOURS, "tokenModifiers": [] }, "full": true },
    })
}

fn serve(connection: &Connection) -> Result<(), String> {
    let (id, params) = connection.initialize_start().map_err(|e| e.to_string())?;
    let offered = params["capabilities"]["general"]["positionEncodings"].as_array();
    let bytes = offered.is_some_and(|list| list.iter().any(|e| e == "utf-8"));
    let answer = json!({ "capabilities": capabilities(bytes), "serverInfo": { "name": "loft", "version": env!("CARGO_PKG_VERSION") } });
    connection.initialize_finish(id, answer).map_err(|e| e.to_string())?;
    let mut server = Server { connection, open: BTreeMap::new(), waiting: VecDeque::new(), bytes };
    loop {
        let message = match server.waiting.pop_front() {
            Some(message) => message,
            None => {
                let due = server.open.values().filter_map(|o| o.due).min();
                let wait = due.map_or(Duration::from_secs(3600), |due| due.saturating_duration_since(Instant::now()));
                match connection.receiver.recv_timeout(wait) {
                    Ok(message) => message,
                    Err(error) if error.is_timeout() => {
                        server.evaluate();
                        continue;
                    }
                    // The editor is gone without a word.
                    Err(_) => return Ok(()),
                }
            }
        };
        match message {
            Message::Request(request) => {
                if connection.handle_shutdown(&request).map_err(|e| e.to_string())? {
                    return Ok(());
                }
                let response = server.answer(&request);
                if connection.sender.send(Message::Response(response)).is_err() {
                    return Ok(());
                }
            }
            Message::Notification(note) => server.note(&note),
            Message::Response(_) => {}
        }
    }
}

impl Server<'_> {
    fn note(&mut self, note: &Notification) {
        let about = &note.params["textDocument"];
        let Some(uri) = about["uri"].as_str() else { return };
        let version = about["version"].as_i64().unwrap_or(0);
        match note.method.as_str() {
            "textDocument/didOpen" => {
                let document = Document::new(uri, about["text"].as_str().unwrap_or_default().to_owned(), version, self.bytes);
                let model = Model::new(&document);
                self.open.insert(uri.to_owned(), Open { document, model, due: Some(Instant::now()) });
            }
            "textDocument/didChange" => {
                let Some(open) = self.open.get_mut(uri) else { return };
                note.params["contentChanges"].as_array().into_iter().flatten().for_each(|change| open.document.change(change));
                open.document.version = version;
                open.due = Some(Instant::now() + REST);
            }
            // What others use may have changed with it.
            "textDocument/didSave" => self.open.values_mut().for_each(|open| open.due = Some(Instant::now())),
            "textDocument/didClose" => {
                self.open.remove(uri);
            }
            _ => {}
        }
    }

    /// Evaluates the files that have rested long enough.
    fn evaluate(&mut self) {
        let now = Instant::now();
        let Self { open, connection, waiting, .. } = self;
        for open in open.values_mut() {
            if open.due.is_some_and(|due| due <= now) {
                open.due = None;
                open.model.check(&open.document, connection, waiting);
            }
        }
    }

    fn answer(&mut self, request: &Request) -> Response {
        let uri = request.params["textDocument"]["uri"].as_str().unwrap_or_default();
        let position = &request.params["position"];
        let Self { open, connection, waiting, .. } = self;
        let Some(open) = open.get_mut(uri) else {
            return Response::new_err(request.id.clone(), ErrorCode::InvalidParams as i32, format!("{uri:?} is not open"));
        };
        let document = &open.document;
        let result = match request.method.as_str() {
            "textDocument/hover" => hover(document, &mut open.model, position, (connection, waiting)),
            "textDocument/definition" => names::definition(document, position),
            "textDocument/references" => names::references(document, position),
            "textDocument/rename" => match names::rename(document, position, request.params["newName"].as_str().unwrap_or_default()) {
                Ok(edits) => edits,
                Err(words) => return Response::new_err(request.id.clone(), ErrorCode::RequestFailed as i32, words),
            },
            "textDocument/documentSymbol" => text::symbols(document),
            "textDocument/formatting" => text::layout(document),
            "textDocument/foldingRange" => text::folds(document),
            "textDocument/semanticTokens/full" => text::colours(document),
            "textDocument/completion" => text::completion(document, position),
            "textDocument/signatureHelp" => text::signature(document, position),
            "textDocument/codeLens" => {
                let lens = |(span, title): &(crate::lang::syntax::ast::Span, String)| json!({ "range": document.range(*span), "command": { "title": title, "command": "" } });
                open.model.lenses.iter().map(lens).collect()
            }
            "textDocument/codeAction" => actions(document, &open.model, &request.params["range"]),
            other => return Response::new_err(request.id.clone(), ErrorCode::MethodNotFound as i32, format!("{other} is not served")),
        };
        Response::new_ok(request.id.clone(), result)
    }
}

/// What is known of the word at a place.
fn hover(document: &Document, model: &mut Model, position: &Value, with: (&Connection, &mut VecDeque<Message>)) -> Value {
    let at = document.byte(position);
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let start = document.text[..at].char_indices().rev().take_while(|(_, c)| is_word(*c)).last().map_or(at, |(k, _)| k);
    let end = document.text[at..].find(|c: char| !is_word(c)).map_or(document.text.len(), |n| at + n);
    let word = &document.text[start..end];
    if word.is_empty() {
        return Value::Null;
    }
    let read = names::Read::new(&document.text);
    let declared = read.at(start).filter(|o| matches!(o.binding, Binding::Declaration(_))).map(|o| read.text_of(o).to_owned());
    let behind_dot = document.text[..start].trim_end().ends_with('.');
    let before_colon = document.text[end..].trim_start().starts_with(':');
    let about = match declared {
        Some(name) => model.describe(document, &name, with),
        None => names::about_word(word, behind_dot, before_colon),
    };
    match about {
        Some(text) => json!({ "contents": { "kind": "markdown", "value": text.trim_end() } }),
        None => Value::Null,
    }
}

/// Quick fixes of reports in a stretch.
fn actions(document: &Document, model: &Model, range: &Value) -> Value {
    let (start, end) = (document.byte(&range["start"]), document.byte(&range["end"]));
    let near = |span: &crate::lang::syntax::ast::Span| span.start as usize <= end && start <= span.end as usize;
    let action = |(span, text, title): &(crate::lang::syntax::ast::Span, String, String)| {
        let edit = json!({ "range": document.range(*span), "newText": text });
        json!({ "title": title, "kind": "quickfix", "edit": { "changes": { document.uri.clone(): [edit] } } })
    };
    model.fixes.iter().filter(|f| near(&f.0)).map(action).collect()
}
