//! What the server asks of the model behind the page, and what it gets.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The model behind the page. It is asked by one thread, one evaluation after the other.
pub trait Model: Send {
    /// Evaluates the script as `request` has it.
    ///
    /// Long work registers itself with [`Evaluation::watch`], so that it can be stopped; a stopped evaluation gives no frame. A script with
    /// errors gives a frame that tells them. A panic is caught; the page then keeps what it shows and tells that there is a bug.
    fn evaluate(&mut self, request: &Request, evaluation: &Evaluation) -> Evaluated;
}

/// What the page asks about the script while an evaluation may be running; asked from several threads.
pub trait Script: Send + Sync {
    /// Writes the default of a param into the script, exactly at its place.
    ///
    /// Fails with a sentence for the user, for example when there is no such param or the file cannot be written.
    fn write(&self, name: &str, text: &str) -> Result<(), String>;

    /// Shows a place in an attached editor; `false` where none is attached or the file is none of the model's. Lines and columns count
    /// from 1.
    fn show(&self, file: &str, line: u32, column: u32) -> bool;
}

/// A state of the model to compare with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Compare {
    /// The golden beside the script.
    Golden,
    /// The script at a revision of its repository, such as `HEAD`; it never begins with `-`.
    Revision(String),
}

/// What is to be evaluated.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// The number that the frame must have; a partial one before it has the number before.
    pub number: u64,
    /// The text of the script as it was read when it was seen to have changed.
    pub text: Arc<Vec<u8>>,
    /// Params that are set, by name, as after `--set`.
    pub sets: Vec<(String, String)>,
    /// Chord error of display triangles, model units, above 0; `None`: whatever suits the size of the model.
    pub chord_error: Option<f64>,
    /// What to lay over the model.
    pub compare: Option<Compare>,
    /// The model alone was shown already; now the state to compare with is evaluated too.
    pub again: bool,
}

/// What an evaluation gave.
#[derive(Clone, Debug, Default)]
pub struct Evaluated {
    /// What the page is to show; `None` where the evaluation was stopped.
    pub frame: Option<Frame>,
    /// The files that it read or looked for in vain, besides the script: a change of one of them asks for a new evaluation. `None`: as
    /// before.
    pub files: Option<Vec<PathBuf>>,
    /// The state to compare with is not evaluated yet: the same request has to follow with [`Request::again`].
    pub more: bool,
}

/// What the page shows.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// The JSON object of a frame.
    pub json: String,
    /// All the buffers that it names, also those that an earlier frame had.
    pub buffers: Vec<Buffer>,
}

/// Numbers for the page: positions, triangles and the like.
#[derive(Clone, Debug)]
pub struct Buffer {
    /// 32 hex digits in lower case that stand for the content.
    pub key: String,
    /// The content.
    pub bytes: Arc<Vec<u8>>,
}

/// How far some work is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// What is done now, in a word or a few.
    pub phase: String,
    /// Steps done.
    pub done: u64,
    /// All steps; 0 where their number is not known.
    pub of: u64,
}

/// Work that can be stopped and asked how far it is, by other threads than the one that does it.
pub trait Watched: Send + Sync {
    /// Makes the work end soon; returns at once.
    fn stop(&self);

    /// How far the work is; asked at most ten times a second, answers at once.
    fn progress(&self) -> Progress;
}

/// An evaluation on its way.
#[derive(Default)]
pub struct Evaluation {
    state: Mutex<State>,
    partial: OnceLock<ShowPartial>,
}

#[derive(Default)]
struct State {
    stopped: bool,
    work: Option<Arc<dyn Watched>>,
}

/// Shows a frame of what is evaluated so far.
type ShowPartial = Box<dyn Fn(Frame) + Send + Sync>;

impl Evaluation {
    /// Frames of a part of the model go here from now on.
    pub fn show_partial_by(&self, show: ShowPartial) {
        // Nobody sets it again.
        let _ = self.partial.set(show);
    }

    /// Shows a frame of what is evaluated so far, while the rest goes on; nobody sees it where nobody wants one.
    pub fn show_partial(&self, frame: Frame) {
        if let (Some(show), false) = (self.partial.get(), self.is_stopped()) {
            show(frame);
        }
    }

    /// Nobody wants the result any more.
    pub fn is_stopped(&self) -> bool {
        self.state().stopped
    }

    /// Names the work that a stop must reach. It is stopped at once where the evaluation has been stopped already.
    pub fn watch(&self, work: Arc<dyn Watched>) {
        let stopped = {
            let mut state = self.state();
            state.work = Some(work.clone());
            state.stopped
        };
        if stopped {
            work.stop();
        }
    }

    /// Asks the work to end.
    pub fn stop(&self) {
        let work = {
            let mut state = self.state();
            state.stopped = true;
            state.work.clone()
        };
        if let Some(work) = work {
            work.stop();
        }
    }

    /// How far the work is, where it can be asked.
    pub fn progress(&self) -> Progress {
        let work = self.state().work.clone();
        work.map(|work| work.progress()).unwrap_or_default()
    }

    fn state(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
