//! Open files, what is asked about them, and when they are evaluated.
//!
//! Requests about the text alone are answered at once, also while a model runs. What needs the model waits for the run
//! of the text as it stands; a change stops that run, and requests that wait are answered that the text has changed.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::{Duration, Instant};

use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};

use super::answers::{Need, Others, SERVED, answer, need};
use super::document::Document;
use super::model::{Facts, Running, model};
use super::results;
use crate::session::disk::Unsaved;
use crate::session::live::{Depth, Live};

/// How long a text must rest before it is evaluated, and then before it is meshed.
const REST: (Duration, Duration) = (Duration::from_millis(150), Duration::from_millis(300));
/// How long a hover waits for the value of the text as it stands; then it shows the last one that is known.
const PATIENCE: Duration = Duration::from_millis(400);
/// How often a run is looked after.
const LOOK: Duration = Duration::from_millis(2);

struct Open {
    document: Document,
    /// Away while it runs.
    live: Option<Live>,
    facts: Facts,
    /// When values are due, and when meshes.
    due: [Option<Instant>; 2],
    /// Requests that wait for the model, some not longer than to a moment.
    waiting: Vec<(Request, Option<Instant>)>,
    /// Names that they ask for.
    wanted: BTreeSet<String>,
}

/// The server between two messages.
pub struct Server<'c> {
    connection: &'c Connection,
    open: BTreeMap<String, Open>,
    running: Option<Running>,
    bytes: bool,
    /// The editor can be told to ask for lenses again.
    refresh: bool,
    /// Requests of our own.
    sent: i32,
}

/// What runs at each of the two times that are due.
const DEPTHS: [Depth; 2] = [Depth::Values, Depth::Report];

impl Open {
    /// The facts are those of the text as it stands.
    fn is_current(&self) -> bool {
        self.facts.depth.is_some() && self.facts.revision == self.document.revision
    }

    /// Whether a request can be answered, or which of the two runs is needed first.
    fn knows(&self, need: &Need) -> Result<(), usize> {
        let full = self.facts.depth == Some(Depth::Report);
        match need {
            Need::Text => Ok(()),
            _ if !self.is_current() => Err(0),
            Need::Model => Ok(()),
            Need::Name(name) if !self.facts.covers(name) => Err(usize::from(full)),
            // A mesh is not waited for.
            Need::Name(_) => Ok(()),
        }
    }

    /// What was read from other files may be another thing now.
    fn touch(&mut self, now: Instant) {
        self.document.revision += 1;
        self.due = [Some(now), None];
    }
}

impl<'c> Server<'c> {
    pub fn new(connection: &'c Connection, bytes: bool, refresh: bool) -> Self {
        Self { connection, open: BTreeMap::new(), running: None, bytes, refresh, sent: 0 }
    }

    pub fn send(&self, message: Message) {
        // An editor that is gone needs no answer.
        let _ = self.connection.sender.send(message);
    }

    fn refuse(&self, id: RequestId, code: ErrorCode, words: &str) {
        self.send(Message::Response(Response::new_err(id, code as i32, words.to_owned())));
    }

    /// Takes over a run that is over, starts what is due, and says when to come back; `None` when a message must come first.
    pub fn go_on(&mut self, now: Instant) -> Option<Duration> {
        self.answer_impatient(now);
        if self.running.as_ref().is_some_and(Running::is_over)
            && let Some(running) = self.running.take()
        {
            self.take_over(running, now);
        }
        let [values, meshes] = [0, 1].map(|depth| self.due(depth).filter(|due| due.0 <= now));
        match (&self.running, values) {
            // Values go before meshes.
            (Some(running), Some(_)) if running.depth == DEPTHS[1] => running.stop(),
            (Some(_), _) => {}
            (None, values) => {
                let depth = usize::from(values.is_none());
                if let Some((_, uri)) = values.or(meshes) {
                    self.start(depth, &uri);
                }
            }
        }
        if self.running.is_some() {
            return Some(LOOK);
        }
        let patience = self.open.values().flat_map(|open| &open.waiting).filter_map(|waiting| waiting.1);
        let first = self.open.values().flat_map(|open| open.due).flatten().chain(patience).min();
        first.map(|at| at.saturating_duration_since(now))
    }

    /// The file that is due first for one of the two runs.
    fn due(&self, depth: usize) -> Option<(Instant, String)> {
        let due = self.open.iter().filter_map(|(uri, open)| Some((open.due[depth]?, uri)));
        due.min().map(|(at, uri)| (at, uri.clone()))
    }

    fn start(&mut self, depth: usize, uri: &str) {
        let unsaved = self.unsaved();
        let Some(open) = self.open.get_mut(uri) else { return };
        // What is seen of all comes with what is seen of some.
        open.due[..=depth].fill(None);
        let live = open.live.take().unwrap_or_else(|| model(&open.document));
        self.running = Running::start(live, &open.document, DEPTHS[depth], unsaved, open.wanted.clone());
    }

    /// Texts of all open files, by resolved path.
    fn unsaved(&self) -> Unsaved {
        let text = |open: &Open| Some((open.document.path.as_ref()?.canonicalize().ok()?, Arc::from(open.document.text.as_str())));
        Arc::new(self.open.values().filter_map(text).collect())
    }

    fn take_over(&mut self, running: Running, now: Instant) {
        let (uri, revision, depth) = (running.uri.clone(), running.revision, running.depth);
        let finished = running.finish();
        let Some(open) = self.open.get_mut(&uri) else { return };
        let Some((live, facts)) = finished else { return };
        open.live = Some(live);
        if open.document.revision != revision {
            return;
        }
        let Some(facts) = facts else {
            // Stopped in favour of another file.
            open.due[usize::from(depth == DEPTHS[1])].get_or_insert(now);
            return;
        };
        let before = std::mem::replace(&mut open.facts, facts);
        results::remember(&mut open.facts, before);
        if depth == DEPTHS[0] {
            open.due[1].get_or_insert(now + REST.1);
        }
        let rows = results::diagnostics(&open.facts, &open.document);
        let params = json!({ "uri": uri, "version": open.document.version, "diagnostics": rows });
        self.send(Message::Notification(Notification::new("textDocument/publishDiagnostics".to_owned(), params)));
        self.answer_waiting(&uri, now);
        if self.refresh && depth == DEPTHS[1] {
            self.sent += 1;
            let request = Request { id: self.sent.into(), method: "workspace/codeLens/refresh".to_owned(), params: Value::Null };
            self.send(Message::Request(request));
        }
    }

    /// Answers what can be answered now; the rest waits on.
    fn answer_waiting(&mut self, uri: &str, now: Instant) {
        let Some(open) = self.open.get_mut(uri) else { return };
        open.wanted.clear();
        for (request, until) in std::mem::take(&mut open.waiting) {
            self.ask_at(request, until, now);
        }
    }

    /// Answers what has waited long enough from what is known.
    fn answer_impatient(&mut self, now: Instant) {
        let over = |waiting: &(Request, Option<Instant>)| waiting.1.is_some_and(|until| until <= now);
        let mut tired = Vec::new();
        for open in self.open.values_mut() {
            tired.extend(open.waiting.extract_if(.., |waiting| over(waiting)));
        }
        tired.into_iter().for_each(|(request, until)| self.ask_at(request, until, now));
    }

    pub fn note(&mut self, note: &Notification) {
        let now = Instant::now();
        let about = &note.params["textDocument"];
        let version = about["version"].as_i64().unwrap_or(0);
        match (note.method.as_str(), about["uri"].as_str()) {
            ("$/cancelRequest", _) => self.cancel(&note.params["id"]),
            ("workspace/didChangeWatchedFiles", _) => self.touch_all(None, now),
            ("textDocument/didOpen", Some(uri)) => {
                self.close(uri, "opened again");
                let document = Document::new(uri, about["text"].as_str().unwrap_or_default().to_owned(), version, self.bytes);
                let (live, facts) = (Some(model(&document)), Facts::default());
                let open = Open { document, live, facts, due: [Some(now), None], waiting: Vec::new(), wanted: BTreeSet::new() };
                self.open.insert(uri.to_owned(), open);
                self.touch_all(Some(uri), now + REST.0);
            }
            ("textDocument/didChange", Some(uri)) => {
                let Some(open) = self.open.get_mut(uri) else { return };
                note.params["contentChanges"].as_array().into_iter().flatten().for_each(|change| open.document.change(change));
                open.document.version = version;
                open.due = [Some(now + REST.0), None];
                let waiting = std::mem::take(&mut open.waiting);
                waiting.into_iter().for_each(|(r, _)| self.refuse(r.id, ErrorCode::ContentModified, "the text has changed"));
                self.stop(uri);
                self.touch_all(Some(uri), now + REST.0);
            }
            // Tables that are imported may have changed with it.
            ("textDocument/didSave", _) => self.touch_all(None, now),
            ("textDocument/didClose", Some(uri)) => {
                self.close(uri, "the file is closed");
                let params = json!({ "uri": uri, "diagnostics": [] });
                self.send(Message::Notification(Notification::new("textDocument/publishDiagnostics".to_owned(), params)));
                self.touch_all(None, now + REST.0);
            }
            _ => {}
        }
    }

    /// Evaluates all files again but the one that changed itself.
    fn touch_all(&mut self, but: Option<&str>, at: Instant) {
        let touched: Vec<String> = self.open.keys().filter(|uri| Some(uri.as_str()) != but).cloned().collect();
        for uri in touched {
            self.stop(&uri);
            if let Some(open) = self.open.get_mut(&uri) {
                open.touch(at);
            }
        }
    }

    /// Stops the run of a file.
    fn stop(&self, uri: &str) {
        self.running.iter().filter(|running| running.uri == uri).for_each(Running::stop);
    }

    fn close(&mut self, uri: &str, why: &str) {
        let Some(open) = self.open.remove(uri) else { return };
        open.waiting.into_iter().for_each(|(r, _)| self.refuse(r.id, ErrorCode::ContentModified, why));
        if let Some(running) = self.running.as_mut().filter(|running| running.uri == uri) {
            running.stop();
            // Its model goes with it, also when a file of this name is opened soon.
            running.uri.clear();
        }
    }

    pub fn close_all(&mut self) {
        let all: Vec<String> = self.open.keys().cloned().collect();
        all.iter().for_each(|uri| self.close(uri, "the server is shut down"));
    }

    fn cancel(&mut self, id: &Value) {
        let Ok(id) = serde_json::from_value::<RequestId>(id.clone()) else { return };
        let waited = |open: &mut Open| open.waiting.iter().position(|(request, _)| request.id == id).map(|k| open.waiting.remove(k));
        if self.open.values_mut().find_map(waited).is_some() {
            self.refuse(id, ErrorCode::RequestCanceled, "taken back");
        }
    }

    pub fn ask(&mut self, request: Request) {
        self.ask_at(request, None, Instant::now());
    }

    /// Answers a request, or lets it wait: a hover until some moment, given when it waited before.
    fn ask_at(&mut self, request: Request, until: Option<Instant>, now: Instant) {
        let uri = request.params["textDocument"]["uri"].as_str().unwrap_or_default();
        if !SERVED.contains(&request.method.as_str()) {
            return self.refuse(request.id, ErrorCode::MethodNotFound, &format!("{} is not served", request.method));
        }
        let Some(open) = self.open.get(uri) else {
            let words = format!("{uri:?} is not open");
            return self.refuse(request.id, ErrorCode::InvalidParams, &words);
        };
        let need = need(&open.document, &open.facts, &request, &Others::new(self.open.values().map(|open| &open.document)));
        let Some(open) = self.open.get_mut(uri) else { return };
        let tired = until.is_some_and(|until| until <= now);
        if let (false, Err(depth)) = (tired, open.knows(&need)) {
            // A text that still changes is waited for.
            open.due[depth].get_or_insert(now);
            let until = matches!(need, Need::Name(_)).then_some(until.unwrap_or(now + PATIENCE));
            if let Need::Name(name) = need {
                open.wanted.insert(name);
            }
            return open.waiting.push((request, until));
        }
        let Some(open) = self.open.get(uri) else { return };
        let others = Others::new(self.open.values().map(|open| &open.document));
        let answer = match answer(&open.document, &open.facts, &request, &others) {
            Ok(result) => Response::new_ok(request.id, result),
            Err(words) => Response::new_err(request.id, ErrorCode::RequestFailed as i32, words),
        };
        self.send(Message::Response(answer));
    }
}
