//! The evaluated model behind an open file: runs in a thread of its own, and what they find.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use super::document::Document;
use crate::base::job::Job;
use crate::cli::interrupt;
use crate::lang::assist::{Known, KnownType};
use crate::lang::diag::diagnostic::{Diagnostic, Sources};
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::syntax::ast::Keyword;
use crate::session::disk::Unsaved;
use crate::session::live::{Clock, Depth, Live};
use crate::session::report::MeshRow;
use crate::session::run::Outcome;

/// Names that are described in every run; in a larger script only those that were asked for are.
const DESCRIBED: usize = 500;

/// A declared name: its keyword, its place and a line about it.
#[derive(Clone, Debug)]
pub struct About {
    pub keyword: Keyword,
    pub span: Span,
    pub line: String,
}

/// A line about a name, and the text's count of changes then.
#[derive(Clone, Debug)]
pub struct Seen {
    pub line: String,
    pub revision: u64,
}

/// What a run found about a text.
#[derive(Debug, Default)]
pub struct Facts {
    /// The text's count of changes.
    pub revision: u64,
    /// How much was run; `None` before the first run.
    pub depth: Option<Depth>,
    pub names: BTreeMap<String, About>,
    /// Kinds of the values of all names.
    pub shapes: Known,
    /// The last line about each name, also of earlier runs.
    pub seen: BTreeMap<String, Seen>,
    /// Names that were asked for; all of them where there are few.
    asked: Option<BTreeSet<String>>,
    pub meshes: BTreeMap<String, MeshRow>,
    /// Checks that passed, and all of them.
    pub checks: (usize, usize),
    pub diagnostics: Vec<Diagnostic>,
    pub sources: Sources,
    /// A bug in loft, in words.
    pub bug: Option<String>,
}

/// A run on its way.
pub struct Running {
    pub uri: String,
    pub revision: u64,
    pub depth: Depth,
    job: Arc<Job>,
    thread: JoinHandle<(Live, Option<Facts>)>,
}

/// The model of a file.
pub fn model(document: &Document) -> Live {
    let started = Instant::now();
    let clock: Clock = Arc::new(move || started.elapsed().as_secs_f64());
    let name = document.path.as_ref().and_then(|p| p.file_name()).map_or("untitled".to_owned(), |n| n.to_string_lossy().into_owned());
    // A file whose folder is not there yet imports from nowhere.
    let script = document.path.as_deref().filter(|path| path.parent().is_some_and(Path::is_dir));
    Live::new(&name, script, &[], clock)
}

impl Facts {
    /// What there is to know of a name is known.
    pub fn covers(&self, name: &str) -> bool {
        self.asked.as_ref().is_none_or(|asked| asked.contains(name))
    }

    /// There are lines about all names.
    pub fn knows_all(&self) -> bool {
        self.asked.is_none()
    }

    pub fn is_mesh(&self, name: &str) -> bool {
        self.names.get(name).is_some_and(|about| about.keyword == Keyword::Mesh)
    }
}

impl Running {
    /// Starts a run; gives the model back when there can be no thread.
    pub fn start(mut live: Live, document: &Document, depth: Depth, unsaved: Unsaved, wanted: BTreeSet<String>) -> Option<Self> {
        let job = interrupt::own_job();
        let (uri, revision, text, watched) = (document.uri.clone(), document.revision, document.text.clone(), job.clone());
        live.set_unsaved(unsaved);
        let work = move || {
            let (mut names, mut all) = (Described::default(), true);
            let ran = live.run(&text, &[], depth, &watched, &mut |cx| (names, all) = described(cx, &wanted));
            let facts = match ran {
                Ok(outcome) if outcome.interrupted => None,
                Ok(outcome) => Some(facts(outcome, names)),
                Err(caught) => {
                    let words = format!("a bug in loft; please report it with this script: {}", caught.what);
                    Some(Facts { bug: Some(words), ..Facts::default() })
                }
            };
            let asked = (!all).then_some(wanted);
            (live, facts.map(|facts| Facts { revision, depth: Some(depth), asked, ..facts }))
        };
        let thread = std::thread::Builder::new().name("model".to_owned()).spawn(work).ok()?;
        Some(Self { uri, revision, depth, job, thread })
    }

    /// Asks it to stop; it ends soon and gives no facts.
    pub fn stop(&self) {
        self.job.cancel();
    }

    pub fn is_over(&self) -> bool {
        self.thread.is_finished()
    }

    /// The model, and what the run found if it was not stopped; nothing after a bug that nobody caught.
    pub fn finish(self) -> Option<(Live, Option<Facts>)> {
        self.thread.join().ok()
    }
}

fn facts(outcome: Outcome, (names, shapes): Described) -> Facts {
    let checks = &outcome.report.checks;
    Facts {
        names,
        shapes,
        checks: (checks.iter().filter(|c| c.pass).count(), checks.len()),
        meshes: outcome.report.meshes.into_iter().map(|row| (row.name.clone(), row)).collect(),
        diagnostics: outcome.diagnostics,
        sources: outcome.sources,
        ..Facts::default()
    }
}

/// Lines about names, and the kinds of their values.
type Described = (BTreeMap<String, About>, Known);

/// The names of a script, and whether there are lines about all of them.
fn described(cx: &mut Cx<'_>, wanted: &BTreeSet<String>) -> (Described, bool) {
    let symbols = cx.symbols();
    let all = symbols.len() <= DESCRIBED;
    let (mut out, mut shapes) = (BTreeMap::new(), Known::new());
    for symbol in symbols {
        if let Some(name) = symbol.name.clone().filter(|_| symbol.shape != KnownType::Unknown) {
            shapes.entry(name).or_insert(symbol.shape);
        }
        let Some(name) = symbol.name.filter(|name| all || wanted.contains(name)) else { continue };
        if let Some(line) = cx.describe_name(&name) {
            let about = About { keyword: symbol.keyword, span: symbol.span, line };
            // Of two declarations of a name the first one counts.
            out.entry(name).or_insert(about);
        }
    }
    ((out, shapes), all)
}
