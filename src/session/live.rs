//! A model that is run again after every change: what REPL, language server and viewer share.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::disk::{Disk, Outputs, Unsaved};
use super::guard::{Bug, guarded};
use super::kept::Kept;
use super::run::{Again, Outcome, Task, Wanted, run_again};
use crate::base::job::Job;
use crate::lang::eval::context::Cx;

/// Seconds since some moment.
pub type Clock = Arc<dyn Fn() -> f64 + Send + Sync>;

/// What one run is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Values, network, surfaces and checks; meshes that nothing asks for, areas and volumes are left out.
    Values,
    /// Everything but writing: what exports and pictures say is said.
    Report,
    /// Everything; outputs are written.
    Files,
}

/// What a run writes, and where.
struct Destination<'a> {
    /// The folder of outputs; the script's own where none is given.
    folder: Option<&'a Path>,
    /// The one picture that is written instead of the outputs of the script.
    picture: Option<&'a Wanted>,
    outputs: Outputs,
}

/// Who is shown a model that is being run.
pub struct Looks<'l> {
    /// When everything is evaluated.
    pub whole: &'l mut (dyn FnMut(&mut Cx<'_>) + Send),
    /// When only the shapes are.
    pub shaped: Option<&'l mut (dyn FnMut(&mut Cx<'_>) + Send)>,
}

/// One script and what its last run left.
pub struct Live {
    name: String,
    script: Option<PathBuf>,
    allow: Vec<PathBuf>,
    kept: Kept,
    clock: Clock,
    unsaved: Unsaved,
    read: Vec<PathBuf>,
}

impl Live {
    /// A model shown as `name`; its imports are looked for beside `script`, or in the current folder.
    pub fn new(name: &str, script: Option<&Path>, allow: &[PathBuf], clock: Clock) -> Self {
        let (name, script, allow) = (name.to_owned(), script.map(Path::to_owned), allow.to_vec());
        Self { name, script, allow, kept: Kept::default(), clock, unsaved: Unsaved::default(), read: Vec::new() }
    }

    /// Texts that the next runs read instead of the files of their names.
    pub fn set_unsaved(&mut self, unsaved: Unsaved) {
        self.unsaved = unsaved;
    }

    /// The file beside which its imports are looked for.
    pub fn script(&self) -> Option<&Path> {
        self.script.as_deref()
    }

    /// The files that the last run read, or looked for and did not find.
    pub fn files(&self) -> &[PathBuf] {
        &self.read
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Runs the text, and shows the evaluated model to `look`. A bug is caught; then the next run starts from nothing.
    ///
    /// Fails when the folder of the script cannot be read.
    pub fn run(
        &mut self,
        text: &str,
        sets: &[(String, String)],
        depth: Depth,
        job: &Job,
        look: &mut (dyn FnMut(&mut Cx<'_>) + Send),
    ) -> Result<Outcome, Bug> {
        let outputs = match depth {
            Depth::Files => Outputs::Written,
            Depth::Values | Depth::Report => Outputs::Counted,
        };
        self.evaluate(text, sets, Destination { folder: None, picture: None, outputs }, depth, job, Looks { whole: look, shaped: None })
    }

    /// Runs the text for somebody who watches it, with everything but exports and pictures: `shaped` is shown the model as soon as its shapes are evaluated,
    /// `whole` when all is.
    ///
    /// Fails as [`Live::run`].
    pub fn run_shown(&mut self, text: &str, sets: &[(String, String)], job: &Job, looks: Looks) -> Result<Outcome, Bug> {
        let to = Destination { folder: None, picture: None, outputs: Outputs::Skipped };
        self.evaluate(text, sets, to, Depth::Report, job, looks)
    }

    /// Runs the text and writes one picture into a folder, and nothing else.
    ///
    /// Fails as [`Live::run`].
    pub fn draw(&mut self, text: &str, sets: &[(String, String)], folder: &Path, wanted: &Wanted, job: &Job) -> Result<Outcome, Bug> {
        let to = Destination { folder: Some(folder), picture: Some(wanted), outputs: Outputs::Written };
        self.evaluate(text, sets, to, Depth::Values, job, Looks { whole: &mut |_| {}, shaped: None })
    }

    fn evaluate(
        &mut self,
        text: &str,
        sets: &[(String, String)],
        to: Destination,
        depth: Depth,
        job: &Job,
        looks: Looks,
    ) -> Result<Outcome, Bug> {
        let Destination { folder, picture, outputs } = to;
        let disk = Disk::new(self.script.as_deref(), folder, &self.allow, outputs).map_err(|error| Bug { what: error.to_string() })?;
        let disk = disk.with_unsaved(self.unsaved.clone());
        let clock = self.clock.clone();
        let clock = move || clock();
        let task = Task { picture, ..Task::new(&self.name, text.as_bytes(), sets, &clock) };
        let mut kept = std::mem::take(&mut self.kept);
        let result = guarded(|| {
            let Looks { whole: look, shaped } = looks;
            let shaped = shaped.map(|shaped| shaped as &mut (dyn FnMut(&mut Cx<'_>) + Send));
            let again = Again { kept: &mut kept, light: depth == Depth::Values, look, shaped };
            run_again(&task, &disk, job, again)
        });
        self.read = disk.paths_read();
        // After a bug there may be half of something in it.
        self.kept = if result.is_ok() { kept } else { Kept::default() };
        result
    }
}
