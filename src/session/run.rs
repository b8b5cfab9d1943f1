//! One run of a model: from text to report and files.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::collect;
use super::kept::Kept;
use super::picture_paths;
use super::report::{Report, Timings, VERSION};
use super::row_work::RowWork;
use super::stages::Stages;
use super::store::{Outputs, Store};
pub use super::task::{Outcome, Task, Wanted};
use crate::base::fault::{Fault, Severity};
use crate::base::job::{Job, TooMuchWork};
use crate::base::work;
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::memory::Memory;
use crate::lang::run::phases::Entry;
use crate::mesh::Mesh;

/// Runs it.
pub fn run(task: &Task, disk: &dyn Store, job: &Job) -> Outcome {
    run_seen(task, disk, job, &mut |_| {})
}

/// Runs it and shows `look` the evaluated model before it goes.
pub fn run_seen(task: &Task, disk: &dyn Store, job: &Job, look: &mut dyn FnMut(&mut Cx<'_>)) -> Outcome {
    let stages = Stages::new(task.clock);
    let (mut outcome, memory) = Run::new(task, Cx::new(disk, &stages, job), disk, &stages).whole(look, None);
    outcome.remains.memory = Some(Box::new(memory));
    outcome
}

/// How a run goes that follows another one.
pub struct Again<'k> {
    /// What the runs before left; holds what this one leaves when it is over.
    pub kept: &'k mut Kept,
    /// Nothing is written, and left out of the report are areas, volumes and the meshes that no check or report asks for.
    pub light: bool,
    /// Is shown the evaluated model.
    pub look: &'k mut (dyn FnMut(&mut Cx<'_>) + Send),
    /// Is shown the model while only its shapes are evaluated, where somebody wants that.
    pub shaped: Option<&'k mut (dyn FnMut(&mut Cx<'_>) + Send)>,
}

/// Runs it again: what did not change since the run before is taken over. The outcome is the same to the last bit as
/// that of [`run`].
pub fn run_again(task: &Task, disk: &dyn Store, job: &Job, again: Again) -> Outcome {
    let Again { kept, light, look, shaped } = again;
    let Kept { memory, stages } = std::mem::take(kept);
    let found = stages.cache.as_ref().map_or(0, |cache| cache.found());
    let stages = Stages::recalling(task.clock, stages);
    let mut cx = Cx::new(disk, &stages, job);
    cx.recall_from(memory);
    let (mut outcome, memory) = Run { light, ..Run::new(task, cx, disk, &stages) }.whole(look, shaped);
    (outcome.reused, outcome.reused_faces) = (memory.reused() + stages.reused(), stages.reused_faces());
    let mut stages = stages.into_kept();
    outcome.from_cache = stages.cache.as_ref().map_or(0, |cache| cache.found()) - found;
    stages.tidy();
    *kept = Kept { memory, stages };
    outcome
}

/// A run on its way.
pub(super) struct Run<'r> {
    pub(super) cx: Cx<'r>,
    pub(super) stages: &'r Stages<'r>,
    pub(super) task: &'r Task<'r>,
    pub(super) disk: &'r dyn Store,
    pub(super) report: Report,
    pub(super) meshes: Vec<(String, Arc<Mesh>)>,
    bug: Option<&'static str>,
    /// What has no place in the script.
    pub(super) said: Option<Diagnostic>,
    /// The flow found for each surface, a line each.
    pub(super) flows: Vec<String>,
    /// What the files do without, a line each.
    pub(super) unnamed: Vec<String>,
    /// Files that outputs of the script may not write.
    pub(super) barred: BTreeSet<String>,
    pub(super) light: bool,
    pub(super) rows: RowWork,
}

impl<'r> Run<'r> {
    fn new(task: &'r Task<'r>, mut cx: Cx<'r>, disk: &'r dyn Store, stages: &'r Stages<'r>) -> Self {
        let report = Report { loft: VERSION, model: task.name.to_owned(), ..Report::default() };
        cx.sink.whole = task.full;
        Self {
            cx,
            stages,
            task,
            disk,
            report,
            meshes: Vec::new(),
            bug: None,
            said: None,
            flows: Vec::new(),
            unnamed: Vec::new(),
            barred: BTreeSet::new(),
            light: false,
            rows: RowWork::new(),
        }
    }

    /// From the text to the end; `look` is shown what was evaluated, `shaped` the shapes before.
    fn whole(mut self, look: &mut dyn FnMut(&mut Cx<'_>), shaped: Option<&mut (dyn FnMut(&mut Cx<'_>) + Send)>) -> (Outcome, Memory) {
        match std::str::from_utf8(self.task.text) {
            Ok(text) => {
                let job = self.cx.job;
                // Whether it was stopped is checked at the end.
                let all = || {
                    self.evaluate(text, shaped);
                    look(&mut self.cx);
                };
                // What is pending at the end counts as well.
                let (_, over) = job.run(|| work::uncharged(all));
                let (mut outcome, memory) = self.finish(over.as_ref().map(too_much_work));
                if over.is_some() {
                    // All that was not reached: the one reason is reported already.
                    outcome.report.unmade.clear();
                }
                (Outcome { over, ..outcome }, memory)
            }
            Err(error) => {
                let message = format!("{} is not UTF-8 text (byte {})", self.task.name, error.valid_up_to() + 1);
                self.report.units = self.cx.unit().name.to_owned();
                self.finish(Some(Diagnostic::without_place("E801", message)))
            }
        }
    }

    /// Everything up to the outputs on their way.
    fn evaluate(&mut self, text: &str, shaped: Option<&mut (dyn FnMut(&mut Cx<'_>) + Send)>) {
        let clock = self.task.clock;
        let start = clock();
        let name = if self.task.name == "-" { "<stdin>" } else { self.task.name };
        let shared = self.task.shared.clone();
        let own = || shared.unwrap_or_else(|| text.into());
        let text: Arc<str> = match self.task.picture.map(|wanted| picture_paths::with_paths(text, wanted)).transpose() {
            Ok(Some(longer)) => longer.into(),
            Ok(None) => own(),
            Err(said) => {
                self.said = Some(*said);
                own()
            }
        };
        let phase = self.cx.job.phase("reading");
        self.cx.load(Entry { name, path: &self.disk.script_name(self.task.name), text, sets: self.task.sets, row: self.task.row });
        self.report.units = self.cx.unit().name.to_owned();
        let parsed = clock();
        drop(phase);
        let phase = self.cx.job.phase("curves");
        match shaped {
            Some(shaped) => self.cx.evaluate_shaped(Some(&mut |cx| shaped(cx))),
            None => self.cx.evaluate_all(),
        }
        self.cx.leave();
        drop(phase);
        let phase = self.cx.job.phase("measuring");
        self.collect();
        drop(phase);
        let evaluated = clock();
        if self.task.picture.is_none() {
            self.barred = super::places::one_file_each(&mut self.cx, self.disk, &self.disk.script_name(self.task.name));
        }
        if let Some(wanted) = self.task.picture {
            self.picture(wanted);
        } else if !self.light && self.disk.outputs() != Outputs::Skipped && (self.is_sound() || self.task.keep_going) {
            self.write();
        }
        self.report.timings = Timings { parse: parsed - start, evaluate: evaluated - parsed, mesh: 0.0, write: clock() - evaluated };
    }

    /// No errors so far, under `--strict` no warnings either.
    fn is_sound(&self) -> bool {
        !(self.cx.has_errors() || self.task.strict && self.cx.has_warnings() || self.bug.is_some())
    }

    /// The result, or `None` when it was reported why there is none.
    pub(super) fn take<T>(&mut self, result: Result<T, Halt>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(Halt::Fault(Fault::Interrupted) | Halt::Failed | Halt::Skipped(..) | Halt::Broken) => None,
            Err(Halt::Fault(fault)) => {
                self.cx.say(&fault);
                None
            }
            Err(Halt::NotYet) => {
                self.bug = Some("the tolerance was asked for after the evaluation and not known");
                None
            }
            Err(Halt::Bug(what)) => {
                self.bug = Some(what);
                None
            }
        }
    }

    /// Gives outputs their names when all is well, and puts the outcome together.
    fn finish(mut self, said: Option<Diagnostic>) -> (Outcome, Memory) {
        let interrupted = self.cx.job.go_on().is_err();
        self.report.unmade = self.cx.unmade().iter().map(|unmade| collect::unmade(unmade, &self.cx.program.sources)).collect();
        let mut diagnostics = self.cx.finish();
        let asked = self.task.picture.is_some_and(|wanted| picture_paths::about_paths(&mut diagnostics, wanted, self.task.text.len()));
        diagnostics.extend(said.or(self.said.take()).filter(|_| !asked));
        let wrong = |d: &Diagnostic| d.severity() == Severity::Error || (self.task.strict && d.severity() == Severity::Warning);
        let mut ok = !diagnostics.iter().any(wrong) && self.report.checks.iter().all(|c| c.pass) && !interrupted;
        if let Some(what) = self.bug {
            let text = format!("a bug in loft: {what}");
            diagnostics.push(Diagnostic::without_place("E999", text).help("please report it with this script and the command line"));
            ok = false;
        }
        if (ok || self.task.keep_going || self.task.picture.is_some()) && !interrupted {
            if let Err(error) = self.disk.commit() {
                diagnostics.push(Diagnostic::without_place("E808", format!("cannot write {error}")));
                ok = false;
                self.report.outputs.clear();
                self.report.renamed.clear();
            }
        } else {
            self.disk.discard();
            self.report.outputs.clear();
            self.report.renamed.clear();
        }
        let bug = diagnostics.iter().any(|d| d.code.0 == "E999") && !interrupted;
        if !ok && !interrupted && self.disk.outputs() == Outputs::Written {
            self.report.unwritten = self.unwritten();
        }
        self.report.ok = ok;
        self.report.diagnostics = diagnostics.iter().flat_map(|d| collect::diagnostic(d, &self.cx.program.sources)).collect();
        let tolerance = self.cx.tolerance_used().map(|t| t.point);
        let timings = &mut self.report.timings;
        timings.mesh = self.stages.mesh_seconds();
        timings.evaluate = (timings.evaluate - timings.mesh).max(0.0);
        let sources = std::mem::take(&mut self.cx.program.sources);
        let (memory, remains) = self.cx.into_memory();
        let outcome = Outcome {
            report: self.report,
            meshes: self.meshes,
            diagnostics,
            sources,
            notes: self.flows.into_iter().chain(self.stages.notes()).chain(self.unnamed).collect(),
            tolerance,
            interrupted,
            over: None,
            bug,
            reused: 0,
            reused_faces: 0,
            from_cache: 0,
            remains,
        };
        (outcome, memory)
    }
}

/// E217 of a run that goes over `--max-work`.
fn too_much_work(over: &TooMuchWork) -> Diagnostic {
    Diagnostic::without_place("E217", over.to_string())
        .help("set a larger limit, or use fewer parts, larger elements and larger errors; look for points that are far off by mistake")
}
