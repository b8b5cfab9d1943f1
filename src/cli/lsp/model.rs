//! The evaluated model behind an open file: diagnostics, values for hovers, lenses.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use lsp_server::{Connection, Message};
use serde_json::{Value, json};

use super::document::Document;
use crate::base::fault::Severity;
use crate::base::job::Job;
use crate::lang::cx::Cx;
use crate::lang::diag::{Diagnostic, FileId, Sources};
use crate::lang::syntax::ast::{Keyword, Span};
use crate::session::live::{Clock, Depth, Live};
use crate::session::run::Outcome;

/// How often a running evaluation looks for changes that make it useless.
const LOOK: Duration = Duration::from_millis(10);
/// Lenses over one script.
const LENSES: usize = 500;

/// The model of one file.
pub struct Model {
    live: Live,
    /// Titles over declarations, from the last run.
    pub lenses: Vec<(Span, String)>,
    /// What was said last, with the words that a quick fix may put in.
    pub fixes: Vec<(Span, String, String)>,
}

impl Model {
    pub fn new(document: &Document) -> Self {
        let started = Instant::now();
        let clock: Clock = Arc::new(move || started.elapsed().as_secs_f64());
        let name = document.path.as_ref().and_then(|p| p.file_name()).map_or("untitled".to_owned(), |n| n.to_string_lossy().into_owned());
        // A file whose folder is not there yet imports from nowhere.
        let script = document.path.as_deref().filter(|path| path.parent().is_some_and(Path::is_dir));
        Self { live: Live::new(&name, script, &[], clock), lenses: Vec::new(), fixes: Vec::new() }
    }

    /// Runs the model; messages that arrive meanwhile are put in `waiting`, and one that changes the file stops the run.
    fn run(
        &mut self,
        document: &Document,
        (connection, waiting): (&Connection, &mut VecDeque<Message>),
        look: &mut (dyn FnMut(&mut Cx<'_>) + Send),
    ) -> Result<Outcome, String> {
        let job = Job::new();
        let live = &mut self.live;
        std::thread::scope(|scope| {
            let work = scope.spawn(|| live.run((&document.text, &[]), Depth::Values, &job, look));
            while !work.is_finished() {
                let Ok(message) = connection.receiver.recv_timeout(LOOK) else { continue };
                if matches!(&message, Message::Notification(n) if n.method.starts_with("textDocument/did")) {
                    job.cancel();
                }
                waiting.push_back(message);
            }
            let bug = || "a bug in loft; please report it with this script".to_owned();
            work.join().map_err(|_| bug())?.map_err(|caught| format!("{}: {}", bug(), caught.what))
        })
    }

    /// Evaluates, and tells the editor what was said.
    pub fn check(&mut self, document: &Document, connection: &Connection, waiting: &mut VecDeque<Message>) {
        let mut lenses: Vec<(Span, String)> = Vec::new();
        let outcome = self.run(document, (connection, waiting), &mut |cx| {
            let symbols = cx.symbols();
            let told = |k: Keyword| matches!(k, Keyword::Surface | Keyword::Shell);
            for symbol in symbols.iter().filter(|s| told(s.keyword)).take(LENSES) {
                if let Some(line) = symbol.name.as_deref().and_then(|name| cx.describe_name(name))
                    && let Some((_, about)) = line.split_once(": ")
                {
                    lenses.push((symbol.span, about.to_owned()));
                }
            }
        });
        let outcome = match outcome {
            Ok(outcome) if outcome.interrupted => return,
            Ok(outcome) => outcome,
            Err(words) => {
                let start = document.range(Span::default());
                return publish(
                    document,
                    connection,
                    vec![json!({ "range": start, "severity": 1, "code": "E999", "source": "loft", "message": words })],
                );
            }
        };
        let checks = &outcome.report.checks;
        if !checks.is_empty() {
            let passed = checks.iter().filter(|c| c.pass).count();
            let words = if passed == checks.len() {
                match passed {
                    1 => "1 check passes".to_owned(),
                    n => format!("{n} checks pass"),
                }
            } else {
                format!("{passed} of {} checks pass", checks.len())
            };
            lenses.push((Span::default(), words));
        }
        self.lenses = lenses;
        self.fixes = outcome.diagnostics.iter().filter_map(fix).collect();
        let rows: Vec<Value> = outcome.diagnostics.iter().map(|d| row(d, document, &outcome.sources)).collect();
        publish(document, connection, rows);
    }

    /// The line about a name, with its value.
    pub fn describe(&mut self, document: &Document, name: &str, with: (&Connection, &mut VecDeque<Message>)) -> Option<String> {
        let mut line = None;
        // Without a model there is nothing to tell.
        let _ = self.run(document, with, &mut |cx| {
            let doc = cx.symbols().into_iter().find(|s| s.name.as_deref() == Some(name)).and_then(|s| s.doc);
            let about = cx.describe_name(name);
            line = about.map(|about| format!("```text\n{about}\n```\n{}", doc.unwrap_or_default()));
        });
        line
    }
}

fn publish(document: &Document, connection: &Connection, rows: Vec<Value>) {
    let params = json!({ "uri": document.uri, "version": document.version, "diagnostics": rows });
    let note = lsp_server::Notification::new("textDocument/publishDiagnostics".to_owned(), params);
    // An editor that is gone needs no diagnostics.
    let _ = connection.sender.send(Message::Notification(note));
}

/// A report as the editor takes it.
fn row(diagnostic: &Diagnostic, document: &Document, sources: &Sources) -> Value {
    let own = diagnostic.labels.iter().find(|l| l.file == FileId(0));
    let mut message = diagnostic.message.clone();
    if let Some(label) = own.filter(|l| !l.text.is_empty()) {
        message.push_str(&format!(": {}", label.text));
    }
    for (word, lines) in [("help", diagnostic.help.iter().collect::<Vec<_>>()), ("note", diagnostic.notes.iter().collect())] {
        lines.into_iter().for_each(|line| message.push_str(&format!("\n{word}: {line}")));
    }
    let related: Vec<Value> = diagnostic
        .labels
        .iter()
        .filter(|l| l.file == FileId(0) && Some(*l) != own)
        .map(|l| json!({ "location": { "uri": document.uri, "range": document.range(l.span) }, "message": l.text }))
        .collect();
    if own.is_none()
        && let Some(label) = diagnostic.labels.first()
    {
        let name = sources.get(label.file).map_or("", |f| &f.name);
        let line = sources.place(label.file, label.span.start).map_or(0, |p| p.line);
        message.push_str(&format!("\nin {name}, line {line}"));
    }
    let severity = match diagnostic.severity() {
        Severity::Error => 1,
        Severity::Warning => 2,
        Severity::Note => 3,
    };
    let span = own.map_or(Span::default(), |l| l.span);
    json!({
        "range": document.range(span), "severity": severity, "code": diagnostic.code.0, "source": "loft",
        "message": message, "relatedInformation": related,
    })
}

/// What a report offers to put in the place of what it marks: place, new text, title.
fn fix(diagnostic: &Diagnostic) -> Option<(Span, String, String)> {
    let label = diagnostic.labels.first().filter(|l| l.file == FileId(0))?;
    let said = [Some(label.text.as_str()), diagnostic.help.as_deref()];
    let meant = said.into_iter().flatten().find_map(|text| text.split_once("did you mean `")?.1.split_once('`').map(|t| t.0))?;
    Some((label.span, meant.to_owned(), format!("Change to `{meant}`")))
}
