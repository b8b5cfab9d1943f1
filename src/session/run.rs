//! One run of a model: from text to report and files.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::collect;
use super::export;
use super::kept::Kept;
use super::picture_paths;
use super::pictures;
use super::report::{OutputRow, Report, Timings, VERSION};
use super::row_work::RowWork;
use super::stages::Stages;
use super::store::{Outputs, Store};
use crate::base::bbox::Box3;
use crate::base::fault::{Fault, Severity, ValueFault};
use crate::base::job::{Job, TooMuchWork};
use crate::base::tolerance::Tolerance;
use crate::base::work;
use crate::lang::declare::params::TableRow;
use crate::lang::diag::diagnostic::{Diagnostic, Sources};
use crate::lang::diag::render::render_all;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::memory::Memory;
use crate::lang::eval::pipeline::Sound;
use crate::lang::run::phases::Entry;
use crate::lang::values::plans::PictureSpec;
use crate::lang::values::value::{ModuleId, Value};
use crate::mesh::Mesh;
use crate::model::measure;
use crate::model::topology::Named;

/// What is to be run.
pub struct Task<'a> {
    /// The script as named on the command line.
    pub name: &'a str,
    /// Its bytes.
    pub text: &'a [u8],
    /// Params set from outside: name and the text of a literal.
    pub sets: &'a [(String, String)],
    /// The row of a table of variants that sets some of them.
    pub row: Option<&'a TableRow>,
    /// Warnings are errors.
    pub strict: bool,
    /// What is sound is written although something failed.
    pub keep_going: bool,
    /// Every number of the JSON report; without it the costly ones of meshes over 200 000 elements are left out.
    pub full: bool,
    /// One picture is all that is written, whatever the script exports, and also of a model that has errors.
    pub picture: Option<&'a Wanted>,
    /// Seconds since some moment.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
}

/// A picture asked for on the command line.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Names of the script to draw; everything where there are none.
    pub names: Vec<String>,
    /// What to fill the picture with; everything drawn where there are none.
    pub zoom: Vec<String>,
    /// The rest of it, without things.
    pub spec: PictureSpec,
}

/// What became of it.
#[derive(Debug, Default)]
pub struct Outcome {
    /// All that was found out.
    pub report: Report,
    /// The meshes by name, in the order of the report.
    pub meshes: Vec<(String, Arc<Mesh>)>,
    /// Everything said about the script.
    pub diagnostics: Vec<Diagnostic>,
    /// The texts that diagnostics point into.
    pub sources: Sources,
    /// How things were found, a line each.
    pub notes: Vec<String>,
    /// Distance within which two points are one, model units.
    pub tolerance: Option<f64>,
    /// Stopped from outside.
    pub interrupted: bool,
    /// Ended for its work, where that is limited: what was found out is a part, and no property of the model.
    pub over: Option<TooMuchWork>,
    /// Something that cannot happen did.
    pub bug: bool,
    /// Declarations, stages and faces of meshes whose results were taken over from the run before.
    pub reused: usize,
    /// Of these the faces of meshes that are otherwise new.
    pub reused_faces: usize,
    /// Results that came from the folder of `--cache`.
    pub from_cache: usize,
}

impl Outcome {
    /// The diagnostics under their source lines; notes only when `verbose`.
    pub fn drawn(&self, color: bool, verbose: bool) -> String {
        let shown: Vec<Diagnostic> = self.diagnostics.iter().filter(|d| verbose || d.severity() != Severity::Note).cloned().collect();
        if shown.is_empty() { String::new() } else { render_all(&shown, &self.sources, color) }
    }
}

/// Runs it.
pub fn run(task: &Task, disk: &dyn Store, job: &Job) -> Outcome {
    run_seen(task, disk, job, &mut |_| {})
}

/// Runs it and shows `look` the evaluated model before it goes.
pub fn run_seen(task: &Task, disk: &dyn Store, job: &Job, look: &mut dyn FnMut(&mut Cx<'_>)) -> Outcome {
    let stages = Stages::new(task.clock);
    Run::new(task, Cx::new(disk, &stages, job), disk, &stages).whole(look).0
}

/// How a run goes that follows another one.
pub struct Again<'k> {
    /// What the runs before left; holds what this one leaves when it is over.
    pub kept: &'k mut Kept,
    /// Nothing is written, and left out of the report are areas, volumes and the meshes that no check or report asks for.
    pub light: bool,
    /// Is shown the evaluated model.
    pub look: &'k mut (dyn FnMut(&mut Cx<'_>) + Send),
}

/// Runs it again: what did not change since the run before is taken over. The outcome is the same to the last bit as
/// that of [`run`].
pub fn run_again(task: &Task, disk: &dyn Store, job: &Job, again: Again) -> Outcome {
    let Again { kept, light, look } = again;
    let Kept { memory, stages } = std::mem::take(kept);
    let found = stages.cache.as_ref().map_or(0, |cache| cache.found());
    let stages = Stages::recalling(task.clock, stages);
    let mut cx = Cx::new(disk, &stages, job);
    cx.recall_from(memory);
    let (mut outcome, memory) = Run { light, ..Run::new(task, cx, disk, &stages) }.whole(look);
    (outcome.reused, outcome.reused_faces) = (memory.reused() + stages.reused(), stages.reused_faces());
    let mut stages = stages.into_kept();
    outcome.from_cache = stages.cache.as_ref().map_or(0, |cache| cache.found()) - found;
    stages.tidy();
    *kept = Kept { memory, stages };
    outcome
}

struct Run<'r> {
    cx: Cx<'r>,
    stages: &'r Stages<'r>,
    task: &'r Task<'r>,
    disk: &'r dyn Store,
    report: Report,
    meshes: Vec<(String, Arc<Mesh>)>,
    bug: Option<&'static str>,
    /// What has no place in the script.
    said: Option<Diagnostic>,
    /// The flow found for each surface, a line each.
    flows: Vec<String>,
    /// What the files do without, a line each.
    unnamed: Vec<String>,
    /// Files that outputs of the script may not write.
    barred: BTreeSet<String>,
    light: bool,
    rows: RowWork,
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

    /// From the text to the end; `look` is shown what was evaluated.
    fn whole(mut self, look: &mut dyn FnMut(&mut Cx<'_>)) -> (Outcome, Memory) {
        match std::str::from_utf8(self.task.text) {
            Ok(text) => {
                let job = self.cx.job;
                // Whether it was stopped is asked at the end.
                let all = || {
                    self.evaluate(text);
                    look(&mut self.cx);
                };
                // What is pending at the end counts as well.
                let (_, over) = job.run(|| work::uncharged(all));
                let (mut outcome, memory) = self.finish(over.as_ref().map(too_much_work));
                if over.is_some() {
                    // All that was not reached: the one reason is told already.
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
    fn evaluate(&mut self, text: &str) {
        let clock = self.task.clock;
        let start = clock();
        let name = if self.task.name == "-" { "<stdin>" } else { self.task.name };
        let text = match self.task.picture.map_or(Ok(text.to_owned()), |wanted| picture_paths::with_paths(text, wanted)) {
            Ok(text) => text,
            Err(said) => {
                self.said = Some(*said);
                text.to_owned()
            }
        };
        let text = text.as_str();
        let phase = self.cx.job.phase("reading");
        self.cx.load(&Entry { name, path: &self.disk.script_name(self.task.name), text, sets: self.task.sets, row: self.task.row });
        self.report.units = self.cx.unit().name.to_owned();
        let parsed = clock();
        drop(phase);
        let phase = self.cx.job.phase("curves");
        self.cx.evaluate_all();
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
        } else if !self.light && (self.is_sound() || self.task.keep_going) {
            self.write();
        }
        self.report.timings = Timings { parse: parsed - start, evaluate: evaluated - parsed, mesh: 0.0, write: clock() - evaluated };
    }

    /// No errors so far, under `--strict` no warnings either.
    fn is_sound(&self) -> bool {
        !(self.cx.has_errors() || self.task.strict && self.cx.has_warnings() || self.bug.is_some())
    }

    /// The result, or `None` when it was reported why there is none.
    fn take<T>(&mut self, result: Result<T, Halt>) -> Option<T> {
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

    /// Rows of the report: all stages are made, and all meshes.
    fn collect(&mut self) {
        let main = ModuleId::MAIN;
        let Some(tolerance) = self.cx.tolerance_used() else { return };
        let whole = self.cx.model(main);
        self.take(whole);
        let bounds = match self.cx.sound(main) {
            Ok(sound) => self.geometry(&sound, &tolerance),
            Err(_) => Box3::EMPTY,
        };
        self.report.bounds = collect::corners(bounds);
        if !self.light {
            self.shells(&tolerance);
            self.meshes(&tolerance);
        }
        if let Some(fault) = &self.rows.exceeded {
            self.cx.say(fault);
        }
        self.report.reports = self.cx.reports().iter().map(collect::table).collect();
        self.report.checks = self.cx.checks().iter().map(|check| collect::check(check, &self.cx.program.sources)).collect();
    }

    /// Rows of network and surface model, where something failed of what is sound; gives the box of all, where it is asked for.
    fn geometry(&mut self, sound: &Sound, tolerance: &Tolerance) -> Box3 {
        let Sound { parts, network, model, .. } = sound;
        self.report.network = collect::network_counts(network);
        self.report.curves = collect::curves(parts, network);
        self.report.modeling = collect::modeling(&self.cx, parts, network, tolerance);
        let (rows, light) = (&mut self.rows, self.light);
        rows.allow_surfaces(model.surfaces.iter().map(|named| &named.surface));
        let mut area = |named: &Named| {
            let what = || format!("the area of `{}`", named.name);
            if light { None } else { rows.part(named.surface.origin(), what, || measure::area(&named.surface)) }
        };
        self.report.surfaces = collect::surfaces(parts, model, &mut area);
        self.flows = collect::flows(&self.cx, parts, model);
        self.report.topology = collect::topology(model, 0);
        if !self.task.full {
            return Box3::EMPTY;
        }
        let mut bounds = network.curves.iter().fold(Box3::EMPTY, |bounds, c| bounds.union(c.curve.bbox()));
        let rows = &mut self.rows;
        let mut own = |named: &Named| {
            let what = || format!("the box of `{}`", named.name);
            rows.part(named.surface.origin(), what, || measure::bounds(std::slice::from_ref(&named.surface)))
        };
        for (row, found) in self.report.surfaces.iter_mut().zip(collect::boxes(parts, model, &mut own)) {
            let found = found.unwrap_or(Box3::EMPTY);
            row.corners = collect::corners(found);
            bounds = row.corners.map_or(bounds, |_| bounds.union(found));
        }
        bounds
    }

    fn meshes(&mut self, tolerance: &Tolerance) {
        for (name, value) in self.cx.mesh_values() {
            let mesh = self.cx.mesh(&value);
            if let Some(mesh) = self.take(mesh) {
                self.report.meshes.push(self.stages.row(&name, &mesh, tolerance, self.task.full));
                self.meshes.push((name.to_string(), mesh));
            }
        }
    }

    fn shells(&mut self, tolerance: &Tolerance) {
        let shells = self.cx.shells(ModuleId::MAIN);
        for shell in self.take(shells).unwrap_or_default() {
            let (cx, full, mut said) = (&mut self.cx, self.task.full, Vec::new());
            self.rows.allow_surfaces(shell.value.surfaces.iter());
            let what = || format!("what the shell `{}` measures", shell.value.name);
            let row = self.rows.part(shell.value.origin, what, || collect::shell(cx, &shell.value, tolerance, full, &mut said));
            if let Some(row) = row.and_then(|row| self.take(row)) {
                said.iter().for_each(|fault| self.cx.say(fault));
                self.report.shells.push(row);
            }
        }
        self.report.topology.shells = self.report.shells.len();
    }

    /// Writes all outputs under temporary names.
    fn write(&mut self) {
        for spec in self.cx.exports() {
            if self.cx.job.go_on().is_err() {
                return;
            }
            if self.is_barred(&spec.path) {
                continue;
            }
            let _phase = self.cx.job.phase(format!("writing {}", spec.path));
            let row = export::write(&mut self.cx, &spec, self.disk);
            self.written(row);
        }
        self.say_absent_groups();
        let model = self.model_name();
        for spec in self.cx.pictures() {
            if self.cx.job.go_on().is_err() {
                return;
            }
            if self.is_barred(&spec.path) {
                continue;
            }
            let _phase = self.cx.job.phase(format!("drawing {}", spec.path));
            let row = pictures::write(&mut self.cx, &spec, &model, self.disk, self.disk.outputs());
            self.written(row);
        }
    }

    /// W224: groups of which no mesh that is written holds anything.
    fn say_absent_groups(&mut self) {
        let exports = self.cx.exports();
        let values = exports.iter().flat_map(|spec| &spec.things);
        let mut meshes: Vec<Arc<Mesh>> = Vec::new();
        for value in values.filter_map(|(value, _)| if let Value::Mesh(mesh) = value { Some(mesh) } else { None }) {
            let mesh = self.cx.mesh(value);
            meshes.extend(self.take(mesh));
        }
        if meshes.is_empty() {
            return;
        }
        meshes.dedup_by(|a, b| Arc::ptr_eq(a, b));
        let groups = self.cx.groups(ModuleId::MAIN);
        for group in self.take(groups).unwrap_or_default() {
            let own = |mesh: &Arc<Mesh>| mesh.groups.iter().any(|g| *g.name == *group.name && !g.is_empty());
            if !group.value.is_empty() && !meshes.iter().any(own) {
                let mut names: Vec<String> = meshes.iter().map(|mesh| mesh.name.clone()).collect();
                names.dedup();
                let fault = ValueFault::NotMeshed { of: group.origin, group: group.name.to_string(), meshes: names };
                self.cx.say(&fault.into());
            }
        }
    }

    /// Whether an output would take the place of another one or of something that is read.
    fn is_barred(&self, path: &str) -> bool {
        !self.barred.is_empty() && self.disk.file_of(path).is_some_and(|file| self.barred.contains(&file))
    }

    fn written(&mut self, row: Result<OutputRow, Halt>) {
        let Some(mut row) = self.take(row) else { return };
        self.report.renamed.append(&mut row.renamed);
        self.unnamed.extend(row.unnamed.drain(..).map(|what| format!("\"{}\" does without {what}", row.path)));
        if self.disk.outputs() == Outputs::Written {
            row.place = self.disk.told_place(&row.path);
            self.report.outputs.push(row);
        }
    }

    /// Files that the script asks for and that were not written.
    fn unwritten(&self) -> Vec<String> {
        if self.task.picture.is_some() || self.light {
            return Vec::new();
        }
        let (exports, pictures) = (self.cx.exports(), self.cx.pictures());
        let all = exports.iter().map(|spec| &spec.path).chain(pictures.iter().map(|spec| &spec.path));
        let written = |path: &String| self.report.outputs.iter().any(|row| row.path == *path);
        all.filter(|path| !written(path)).map(|path| path.to_string()).collect()
    }

    /// The script's name without folder and ending.
    fn model_name(&self) -> String {
        let name = std::path::Path::new(self.task.name).file_stem().unwrap_or_default().to_string_lossy();
        if name == "-" { "model".to_owned() } else { name.into_owned() }
    }

    /// The one picture that was asked for.
    fn picture(&mut self, wanted: &Wanted) {
        if self.cx.job.go_on().is_err() || self.said.is_some() {
            return;
        }
        let model = self.model_name();
        let _phase = self.cx.job.phase(format!("drawing {}", wanted.spec.path));
        match pictures::request(&mut self.cx, wanted) {
            Ok(spec) => {
                let row = pictures::write(&mut self.cx, &spec, &model, self.disk, self.disk.outputs());
                self.written(row);
            }
            Err(message) => self.said = Some(*message),
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
        };
        (outcome, self.cx.into_memory())
    }
}

/// E217 of a run that goes over `--max-work`.
fn too_much_work(over: &TooMuchWork) -> Diagnostic {
    Diagnostic::without_place("E217", over.to_string())
        .help("set a larger limit, or use fewer parts, larger elements and larger errors; look for points that are far off by mistake")
}
