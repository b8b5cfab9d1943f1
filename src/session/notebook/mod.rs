//! A model grown line by line: what a REPL does, without a terminal.
//!
//! The notebook's state is the text of a script and the params set from outside; every entry makes another text, which
//! is run again. So undo is going back to a text, and what is shown is what `loft run` of the saved script shows.

mod commands;
mod edit;
mod explain;
mod show;
mod summary;
mod tables;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::guard::Bug;
use super::live::{Clock, Depth, Live};
use super::report::{Report, Table};
use super::run::Outcome;
use crate::base::fault::Severity;
use crate::base::job::Job;
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::diag::render::render_all;
use crate::lang::eval::context::Cx;
use crate::lang::run::symbols::{Condition, Symbol};
use crate::lang::syntax::outline::{is_unfinished, outline};

pub use commands::{COMMANDS, Command};

/// A part of an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// Lines of text.
    Text(String),
    /// Diagnostics under their source lines.
    Said(String),
    /// A table.
    Table(Table),
    /// The summary of a run, with the tolerance.
    Summary(Box<Report>, Option<f64>),
    /// A picture, as the bytes of a PNG file; nothing where none can be shown.
    Picture(Vec<u8>),
}

/// What an entry leads to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// To be shown, in order.
    pub parts: Vec<Part>,
    /// The entry could not be carried out, or what it asked for failed.
    pub failed: bool,
    /// The session ends.
    pub quit: bool,
    /// It was interrupted.
    pub stopped: bool,
    /// The model is to be shown in a browser.
    pub view: bool,
}

impl Answer {
    fn text(text: impl Into<String>) -> Self {
        Self { parts: vec![Part::Text(text.into())], ..Self::default() }
    }

    fn failure(text: impl Into<String>) -> Self {
        Self { failed: true, ..Self::text(text) }
    }

    fn say(&mut self, text: impl Into<String>) {
        self.parts.push(Part::Text(text.into()));
    }
}

/// What undo goes back to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct State {
    text: String,
    sets: Vec<(String, String)>,
}

/// A session.
pub struct Notebook {
    live: Live,
    now: Snapshot,
    last: Option<Last>,
    clock: Clock,
    color: bool,
    job: Arc<Job>,
    /// The file that was loaded last.
    loaded: Option<PathBuf>,
    editor: Option<Edits>,
}

/// Lets the user edit a text; the error says why not.
pub type Edits = Box<dyn Fn(&str) -> Result<String, String>>;

/// Everything that an entry may change: put back as it was where the entry changes nothing.
#[derive(Clone, Debug, Default)]
struct Snapshot {
    state: State,
    past: Vec<State>,
    future: Vec<State>,
    /// Declarations of the last run.
    symbols: Vec<Symbol>,
    /// How the declared names were after the last run.
    conditions: BTreeMap<String, Condition>,
    /// What was said in the last run: code and message of each report.
    said: Vec<(String, String)>,
}

/// How the last run went, for `:time`.
#[derive(Clone, Copy, Debug, Default)]
struct Last {
    seconds: f64,
    parse: f64,
    evaluate: f64,
    mesh: f64,
    reused: usize,
}

/// Name of the pseudo-file that an entry stands in.
const ENTRY: &str = "entry";
/// What an interrupted entry is answered.
const INTERRUPTED: &str = "interrupted; the session is as it was before";
/// The name that an expression gets while it is evaluated.
const ANSWER: &str = "answer_of_this_entry";

impl Notebook {
    /// An empty session; `color` decides how diagnostics are drawn.
    pub fn new(clock: Clock, color: bool) -> Self {
        Self {
            live: Live::new("session", None, &[], clock.clone()),
            now: Snapshot::default(),
            last: None,
            clock,
            color,
            job: Arc::new(Job::new()),
            loaded: None,
            editor: None,
        }
    }

    /// `:edit` asks `editor` for another text.
    pub fn edit_with(&mut self, editor: Edits) {
        self.editor = Some(editor);
    }

    /// The session goes on with a script read from a file.
    pub fn load(&mut self, name: &str, path: &Path, text: &str) -> Answer {
        let live = Live::new(name, Some(path), &[] as &[PathBuf], self.clock.clone());
        let live = std::mem::replace(&mut self.live, live);
        let (said, conditions) = (std::mem::take(&mut self.now.said), std::mem::take(&mut self.now.conditions));
        let answer = self.change(State { text: ended(text), sets: Vec::new() }, &[]);
        if answer.stopped {
            (self.live, self.now.said, self.now.conditions) = (live, said, conditions);
        } else {
            self.loaded = Some(path.to_owned());
        }
        answer
    }

    /// The flag that stops what is being computed; a new one for each entry.
    pub fn watch(&mut self, job: Arc<Job>) {
        self.job = job;
    }

    /// The script as it stands.
    pub fn text(&self) -> &str {
        &self.now.state.text
    }

    /// The file that the session went on with.
    pub fn script(&self) -> Option<&Path> {
        self.live.script()
    }

    /// Declarations of the last run.
    pub fn symbols(&self) -> &[Symbol] {
        &self.now.symbols
    }

    /// Whether an entry goes on in the next line.
    pub fn is_unfinished(entry: &str) -> bool {
        !entry.trim_start().starts_with(':') && is_unfinished(entry)
    }

    /// Carries out one entry: a command, declarations, or an expression.
    pub fn enter(&mut self, entry: &str) -> Answer {
        let trimmed = entry.trim();
        if trimmed.is_empty() {
            return Answer::default();
        }
        if let Some(command) = trimmed.strip_prefix(':') {
            return self.command(command);
        }
        let found = outline(trimmed);
        if found.is_empty() {
            return Answer::default();
        }
        if found[0].keyword.is_some() || edit::is_meant_as_declaration(trimmed) { self.declare(trimmed) } else { self.ask(trimmed) }
    }

    /// Runs a text in the place of the present one; where it was stopped or met a bug, the answer says so.
    fn run(&mut self, state: &State, depth: Depth, look: &mut (dyn FnMut(&mut Cx<'_>) + Send)) -> Result<Outcome, Answer> {
        let start = (self.clock)();
        let job = self.job.clone();
        let outcome = self.live.run(&state.text, &state.sets, depth, &job, look).map_err(|bug| bug_answer(&bug))?;
        if outcome.interrupted {
            return Err(stopped());
        }
        if let Some(over) = outcome.over {
            return Err(Answer::failure(over.to_string()));
        }
        let timings = outcome.report.timings;
        self.last = Some(Last {
            seconds: (self.clock)() - start,
            parse: timings.parse,
            evaluate: timings.evaluate,
            mesh: timings.mesh,
            reused: outcome.reused,
        });
        Ok(outcome)
    }

    /// Goes over to another state; the answer describes `named` and what the change broke or repaired.
    fn change(&mut self, next: State, named: &[String]) -> Answer {
        self.change_and_look(next, named, &[])
    }

    /// The same, with what became of the checks and reports among `entered`, texts of declarations.
    fn change_and_look(&mut self, next: State, named: &[String], entered: &[&str]) -> Answer {
        let mut lines: Vec<String> = Vec::new();
        let mut results: Vec<Part> = Vec::new();
        let mut symbols: Vec<Symbol> = Vec::new();
        let result = self.run(&next, Depth::Values, &mut |cx| {
            symbols = cx.symbols();
            lines = named.iter().filter_map(|name| cx.describe_name(name)).collect();
            results = edit::outputs(cx, entered);
        });
        let outcome = match result {
            Ok(outcome) => outcome,
            Err(answer) => return answer,
        };
        let mut answer = Answer::default();
        self.tell_new(&outcome, &mut answer);
        lines.into_iter().for_each(|line| answer.say(line));
        self.tell_conditions(&symbols, named, &mut answer);
        if !answer.failed {
            answer.parts.extend(results);
        }
        self.now.symbols = symbols;
        if next != self.now.state {
            self.now.past.push(std::mem::replace(&mut self.now.state, next));
            self.now.future.clear();
        }
        answer
    }

    /// Diagnostics that the run before did not have.
    fn tell_new(&mut self, outcome: &Outcome, answer: &mut Answer) {
        let key = |d: &Diagnostic| (d.code.0.to_owned(), d.message.clone());
        let fresh: Vec<Diagnostic> = outcome.diagnostics.iter().filter(|d| !self.now.said.contains(&key(d))).cloned().collect();
        answer.failed |= fresh.iter().any(|d| d.severity() == Severity::Error);
        if !fresh.is_empty() {
            answer.parts.push(Part::Said(render_all(&fresh, &outcome.sources, self.color)));
        }
        self.now.said = outcome.diagnostics.iter().map(key).collect();
    }

    /// Names that were sound and are no longer, or are again.
    fn tell_conditions(&mut self, symbols: &[Symbol], named: &[String], answer: &mut Answer) {
        let now: BTreeMap<String, Condition> = symbols.iter().filter_map(|s| Some((s.name.clone()?, s.condition))).collect();
        let was = |name: &String| self.now.conditions.get(name).copied();
        let others = || now.iter().filter(|(name, _)| !named.contains(name));
        let broken: Vec<&str> =
            others().filter(|(n, c)| **c != Condition::Sound && was(n) == Some(Condition::Sound)).map(|(n, _)| n.as_str()).collect();
        let repaired: Vec<&str> = others()
            .filter(|(n, c)| **c == Condition::Sound && was(n).is_some_and(|before| before != Condition::Sound))
            .map(|(n, _)| n.as_str())
            .collect();
        if !broken.is_empty() {
            answer.say(format!("no longer there: {}", broken.join(", ")));
        }
        if !repaired.is_empty() {
            answer.say(format!("there again: {}", repaired.join(", ")));
        }
        self.now.conditions = now;
    }
}

fn stopped() -> Answer {
    Answer { stopped: true, ..Answer::failure(INTERRUPTED) }
}

fn bug_answer(bug: &Bug) -> Answer {
    Answer::failure(format!(
        "E999 × a bug in loft: {}\n  help: the session goes on; please report it with what you entered (`:save` writes the model)",
        bug.what
    ))
}

/// With a line end at its end.
fn ended(text: &str) -> String {
    if text.is_empty() || text.ends_with('\n') { text.to_owned() } else { format!("{text}\n") }
}
