//! `loft lsp`: the language server, over standard input and output.

mod answers;
mod document;
mod model;
mod names;
mod results;
mod server;
mod text;
mod wires;

use std::time::{Duration, Instant};

use clap::ArgMatches;
use lsp_server::{Connection, ErrorCode, Message, Response};
use serde_json::{Value, json};

use super::{Command, Exit, Terminal, options};
use server::Server;

/// Serves an editor.
pub const COMMAND: Command = Command { name: "lsp", about: "Language server for editors, over standard input and output", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    // Editors like to say which way they talk.
    command
        .args([options::most_elements(), options::most_work()])
        .arg(clap::Arg::new("stdio").long("stdio").action(clap::ArgAction::SetTrue).hide(true))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    options::read_limits(matches);
    let (connection, wires) = wires::stdio();
    let served = serve(&connection);
    drop(connection);
    match (served, wires.join()) {
        (Ok(true), Ok(())) => Exit::Fine,
        // The protocol asks for 1 when nobody said `shutdown`.
        (Ok(false), Ok(())) => Exit::Errors,
        (Err(text), _) | (_, Err(text)) => terminal.wrong_usage(&format!("the editor broke off: {text}")),
    }
}

fn capabilities(bytes: bool) -> Value {
    json!({
        "positionEncoding": if bytes { "utf-8" } else { "utf-16" },
        "textDocumentSync": { "openClose": true, "change": 2, "save": true },
        "hoverProvider": true, "definitionProvider": true, "referencesProvider": true, "renameProvider": true,
        "documentSymbolProvider": true, "documentFormattingProvider": true, "foldingRangeProvider": true,
        "codeLensProvider": {}, "codeActionProvider": { "codeActionKinds": ["quickfix"] },
        "completionProvider": { "triggerCharacters": [".", "\"", "/", ":", "{", " "] },
        "signatureHelpProvider": { "triggerCharacters": ["(", ","] },
        "semanticTokensProvider": { "legend": { "tokenTypes": text::COLOURS, "tokenModifiers": [] }, "full": true },
    })
}

/// Serves until the editor says `exit` or is gone; whether it said `shutdown` before, or left without a word.
fn serve(connection: &Connection) -> Result<bool, String> {
    let (id, params) = connection.initialize_start().map_err(|e| e.to_string())?;
    let offered = params["capabilities"]["general"]["positionEncodings"].as_array();
    let bytes = offered.is_some_and(|list| list.iter().any(|e| e == "utf-8"));
    let refresh = params["capabilities"]["workspace"]["codeLens"]["refreshSupport"] == true;
    let answer = json!({ "capabilities": capabilities(bytes), "serverInfo": { "name": "loft", "version": env!("CARGO_PKG_VERSION") } });
    connection.initialize_finish(id, answer).map_err(|e| e.to_string())?;
    let mut server = Server::new(connection, bytes, refresh);
    let mut down = false;
    loop {
        let wait = server.go_on(Instant::now()).unwrap_or(Duration::from_secs(3600));
        let message = match connection.receiver.recv_timeout(wait) {
            Ok(message) => message,
            Err(error) if error.is_timeout() => continue,
            // The editor is gone without a word.
            Err(_) => return Ok(true),
        };
        match message {
            Message::Request(request) if request.method == "shutdown" => {
                down = true;
                server.close_all();
                server.send(Message::Response(Response::new_ok(request.id, ())));
            }
            Message::Request(request) if down => {
                let words = "the server is shut down".to_owned();
                server.send(Message::Response(Response::new_err(request.id, ErrorCode::InvalidRequest as i32, words)));
            }
            Message::Request(request) => server.ask(request),
            Message::Notification(note) if note.method == "exit" => return Ok(down),
            Message::Notification(note) if !down => server.note(&note),
            _ => {}
        }
    }
}
