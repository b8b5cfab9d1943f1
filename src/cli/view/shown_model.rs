//! The model behind the page: evaluations by the session, and frames as JSON and bytes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use super::model::{Buffer, Compare, Evaluated, Evaluation, Frame, Model, Progress, Request, Watched};
use super::revision::Revision;
use crate::base::job::Job;
use crate::cli::interrupt;
use crate::session::guard::Bug;
use crate::session::live::Clock;
use crate::session::view::frame::{self, Said};
use crate::session::view::viewer::{View, Viewer, Wanted};
use crate::session::view::write_back::{defaults_of, joined};

/// A script that is shown.
pub struct ShownModel {
    viewer: Viewer,
    /// The other state that it is compared with, and what it was made of.
    other: Option<(OtherState, View)>,
    /// A commit that was checked out, and the one that wrote the golden then.
    golden: Option<(Revision, Revision)>,
    name: String,
    script: PathBuf,
    allow: Vec<PathBuf>,
    /// Params set on the command line.
    sets: Vec<(String, String)>,
    clock: Clock,
}

/// What another state of the model is made of.
#[derive(PartialEq)]
struct OtherState {
    revision: Revision,
    sets: Vec<(String, String)>,
    chord_error: Option<f64>,
}

/// Another state of the model.
enum Other {
    /// As it is known: it may be pending, or have failed.
    Known(frame::Compare),
    Stopped,
}

/// A job that the server may stop and ask.
struct WatchedJob(Arc<Job>);

impl Watched for WatchedJob {
    fn stop(&self) {
        self.0.cancel();
    }

    fn progress(&self) -> Progress {
        let ((phase, _), (done, of)) = (self.0.now(), self.0.progress());
        Progress { phase, done, of }
    }
}

impl ShownModel {
    /// Of a script, with the name under which pages show it.
    ///
    /// `allow` are further places that may be read, `sets` the params that the command line sets.
    pub fn new(name: &str, script: &Path, allow: &[PathBuf], sets: &[(String, String)]) -> Self {
        let started = Instant::now();
        let clock: Clock = Arc::new(move || started.elapsed().as_secs_f64());
        let shown = name.to_owned();
        let viewer = Viewer::new(&shown, Some(script), allow, clock.clone());
        let (allow, sets) = (allow.to_vec(), sets.to_vec());
        Self { viewer, other: None, golden: None, name: shown, script: script.to_owned(), allow, sets, clock }
    }

    /// The files that the model read, or looked for and did not find.
    pub fn files(&self) -> &[PathBuf] {
        self.viewer.files()
    }

    /// The model as it is, and whether it has neither errors nor failed checks; `None` when it was stopped.
    ///
    /// Fails with a bug that was caught.
    pub fn once(&mut self, text: &str, job: &Job) -> Result<Option<(Frame, bool)>, Bug> {
        let wanted = Wanted { number: 1, text: text.to_owned(), sets: self.sets.clone(), chord_error: None };
        let view = self.viewer.show(&wanted, job)?;
        Ok(view.map(|view| (packed(&view), view.frame.ok)))
    }

    /// The state to compare with, under the same params; evaluated only where `may_evaluate`.
    fn other(&mut self, compare: &Compare, wanted: &Wanted, job: &Job, may_evaluate: bool) -> Other {
        let with = match compare {
            Compare::Golden => "golden".to_owned(),
            Compare::Revision(name) => format!("revision:{name}"),
        };
        let failed = |why: String| Other::Known(frame::Compare { with: with.clone(), failed: Some(why), ..frame::Compare::default() });
        let revision = match self.revision(compare) {
            Ok(revision) => revision,
            Err(why) => return failed(why),
        };
        let state = OtherState { revision, sets: wanted.sets.clone(), chord_error: wanted.chord_error };
        if self.other.as_ref().is_none_or(|(known, _)| *known != state) {
            let text = match state.revision.text(&self.script) {
                Ok(text) => text,
                Err(why) => return failed(why),
            };
            if !may_evaluate {
                return Other::Known(frame::Compare { with, pending: true, ..frame::Compare::default() });
            }
            match self.at_revision(&state.revision, &Wanted { text, ..wanted.clone() }, job) {
                Ok(Some(view)) => self.other = Some((state, view)),
                Ok(None) => return Other::Stopped,
                Err(bug) => return failed(bug.what),
            }
        }
        let Some((_, View { frame, .. })) = &self.other else { return Other::Stopped };
        let error = frame.diagnostics.iter().find(|said| said.severity == "error");
        match error {
            Some(error) if frame.things.is_empty() => failed(format!("the script of then is wrong today: {}", error.message)),
            _ => Other::Known(frame::Compare { with, things: frame.things.clone(), ..frame::Compare::default() }),
        }
    }

    /// The commit to compare with; that of the golden is looked for once for each commit that is checked out.
    fn revision(&mut self, compare: &Compare) -> Result<Revision, String> {
        let Compare::Revision(name) = compare else {
            let head = Revision::named(&self.script, "HEAD")?;
            if self.golden.as_ref().is_none_or(|(known, _)| *known != head) {
                self.golden = Some((head, Revision::of_golden(&self.script)?));
            }
            return self.golden.as_ref().map(|(_, of)| of.clone()).ok_or_else(String::new);
        };
        Revision::named(&self.script, name)
    }

    /// The model with all files that it reads as they were then; those of no repository, and what is no text, as they are.
    fn at_revision(&self, revision: &Revision, wanted: &Wanted, job: &Job) -> Result<Option<View>, Bug> {
        let texts_of = |files: &mut dyn Iterator<Item = &PathBuf>| -> BTreeMap<PathBuf, Option<Arc<str>>> {
            files.map(|file| (file.clone(), revision.text(file).ok().map(Arc::from))).collect()
        };
        // Most files of then are those of today.
        let mut texts = texts_of(&mut self.viewer.files().iter());
        loop {
            let mut viewer = Viewer::new(&self.name, Some(&self.script), &self.allow, self.clock.clone());
            viewer.set_unsaved(texts.iter().filter_map(|(file, text)| Some((file.clone(), text.clone()?))).collect());
            let view = viewer.show(wanted, job)?;
            let more = texts_of(&mut viewer.files().iter().filter(|file| !texts.contains_key(*file)));
            if view.is_none() || more.values().all(Option::is_none) {
                return Ok(view);
            }
            texts.extend(more);
        }
    }
}

impl Model for ShownModel {
    fn evaluate(&mut self, request: &Request, evaluation: &Evaluation) -> Evaluated {
        let job = interrupt::own_job();
        evaluation.watch(Arc::new(WatchedJob(job.clone())));
        let text = String::from_utf8_lossy(&request.text).into_owned();
        // A param that was moved and is no longer there is forgotten; what the command line sets must be there.
        let is_known = |name: &str| !defaults_of(&text, name).is_empty() || self.sets.iter().any(|set| set.0 == name);
        let moved = request.sets.iter().filter(|(name, _)| is_known(name));
        let sets = moved.map(|(name, text)| (name.clone(), joined(text))).collect();
        let wanted = Wanted { number: request.number, text, sets, chord_error: request.chord_error };
        let mut early = |view: View| evaluation.show_partial(packed(&view));
        let mut view = match self.viewer.show_early(&wanted, &job, &mut early) {
            Ok(Some(view)) => view,
            Ok(None) => return Evaluated::default(),
            Err(bug) => after_bug(request.number, self.viewer.last().clone(), &self.name, &bug),
        };
        let mut more = false;
        if let Some(compare) = &request.compare {
            match self.other(compare, &wanted, &job, request.again) {
                Other::Known(other) => {
                    if let (false, Some((_, other))) = (other.things.is_empty(), &self.other) {
                        view.buffers.extend(other.buffers.iter().map(|(key, buffer)| (key.clone(), buffer.clone())));
                    }
                    // The model is seen before what it is compared with is made.
                    more = other.pending;
                    view.frame.compare = Some(other);
                }
                Other::Stopped => return Evaluated::default(),
            }
        }
        Evaluated { frame: Some(packed(&view)), files: Some(self.viewer.files().to_vec()), more }
    }
}

/// A frame as the server sends it.
fn packed(view: &View) -> Frame {
    let json = serde_json::to_string(&view.frame).unwrap_or_default();
    let buffers = view.buffers.values().map(|buffer| Buffer { key: buffer.key.clone(), bytes: buffer.bytes.clone() });
    Frame { json, buffers: buffers.collect() }
}

/// What is shown after a bug that was caught: what was shown before, and the bug.
fn after_bug(number: u64, last: View, name: &str, bug: &Bug) -> View {
    let message = format!("a bug in loft; please report it with this script: {}", bug.what);
    let said = Said { severity: "error", code: "E999".to_owned(), message, ..Said::default() };
    let mut things = last.frame.things;
    things.iter_mut().for_each(|thing| thing.stale = true);
    let (model, title) = (name.to_owned(), name.to_owned());
    let stale = !things.is_empty();
    let diagnostics = vec![said];
    View { frame: frame::Frame { loft: frame::VERSION, number, ok: false, stale, model, title, things, diagnostics, ..last.frame }, ..last }
}
