//! What is to be evaluated next, and the evaluation that is running.
//!
//! Whoever wants something else changes the request; the thread of the model takes the newest one when it is free. A save stops what is
//! running. A param that is moved lets a short evaluation end, so that the picture follows while it moves.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::model::{Compare, Evaluation, Request};

/// How long an evaluation may go on when a param moved.
const SHORT: Duration = Duration::from_millis(300);

/// How long an evaluation runs before its progress is announced to the pages.
const ANNOUNCED_AFTER: Duration = Duration::from_millis(100);

/// How long the file has to change after a default was written into it.
const WRITTEN: Duration = Duration::from_millis(100);

/// From the number of one whole frame to the next: its partial frame has the number between.
const STEP: u64 = 2;

/// Params that can be set at once.
const MOST_SETS: usize = 1000;

/// What is wanted and what is done about it.
#[derive(Default)]
pub struct Work {
    state: Mutex<State>,
    wake: Condvar,
    /// Held while pages are told, so that an end comes last.
    telling: Mutex<()>,
}

#[derive(Default)]
struct State {
    wanted: Request,
    /// The script is there.
    there: bool,
    /// Counts changes of what is wanted, and how many of them the last evaluation has.
    changes: u64,
    taken: u64,
    running: Option<Arc<Running>>,
    /// The running evaluation ends when it is no longer short.
    hurry: bool,
    /// Since when a changed file is expected.
    expected: Option<Instant>,
    over: bool,
}

/// An evaluation that is running.
pub struct Running {
    /// Number of its frame.
    pub number: u64,
    /// What its model sees of it.
    pub evaluation: Evaluation,
    started: Instant,
    announced: AtomicBool,
}

impl Work {
    /// Nothing to do yet; these params are set.
    pub fn new(sets: Vec<(String, String)>) -> Self {
        let state = State { wanted: Request { sets, ..Request::default() }, ..State::default() };
        Self { state: Mutex::new(state), ..Self::default() }
    }

    /// The script was saved with this text.
    pub fn saved(&self, text: Vec<u8>) {
        self.change(true, |state| {
            state.wanted.text = Arc::new(text);
            state.there = true;
        });
    }

    /// The script is not there; nothing is evaluated until it is.
    pub fn gone(&self) {
        let mut state = self.state();
        state.there = false;
        state.stop();
    }

    /// A file that the script reads was saved.
    pub fn file_saved(&self) {
        self.change(true, |_| {});
    }

    /// Sets a param, or goes back to its default.
    ///
    /// Fails when too many are set.
    pub fn set(&self, name: &str, text: Option<&str>) -> Result<(), String> {
        let mut fits = true;
        self.change(false, |state| {
            let sets = &mut state.wanted.sets;
            let known = sets.iter().position(|(n, _)| n == name);
            match (known, text) {
                (Some(i), Some(text)) => text.clone_into(&mut sets[i].1),
                (None, Some(text)) if sets.len() < MOST_SETS => sets.push((name.to_owned(), text.to_owned())),
                (None, Some(_)) => fits = false,
                (_, None) => sets.retain(|(n, _)| n != name),
            }
        });
        if fits { Ok(()) } else { Err(format!("more than {MOST_SETS} params are set")) }
    }

    /// A param is no longer set, as its default in the script became the same; the changed file starts the evaluation.
    pub fn forget(&self, name: &str) {
        let mut state = self.state();
        state.wanted.sets.retain(|(n, _)| n != name);
        state.expected = Some(Instant::now());
    }

    /// Display triangles have this chord error from now on, model units.
    pub fn refine(&self, error: f64) {
        self.change(false, |state| state.wanted.chord_error = Some(error));
    }

    /// The model is compared with this from now on. Gives the number of the first whole frame that knows of it.
    pub fn compare(&self, with: Option<Compare>) -> u64 {
        let mut first = 0;
        self.change(false, |state| {
            state.wanted.compare = with;
            first = state.wanted.number + STEP;
        });
        first
    }

    /// The model of a request was shown before its comparison, which follows unless something changed.
    pub fn again(&self) {
        let mut state = self.state();
        if !state.is_due() {
            state.wanted.again = true;
            state.changes += 1;
        }
    }

    /// Stops the running evaluation; the next one starts when something changes.
    pub fn stop(&self) {
        self.state().stop();
    }

    /// Whether another evaluation is to follow.
    pub fn is_due(&self) -> bool {
        self.state().is_due()
    }

    /// Ends the thread of the model.
    pub fn end(&self) {
        let mut state = self.state();
        state.over = true;
        state.stop();
        self.wake.notify_all();
    }

    /// Waits for something to evaluate; `None` at the end.
    pub fn next(&self) -> Option<(Request, Arc<Running>)> {
        let mut state = self.state();
        while !state.over && !state.is_due() {
            state = self.wake.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        if state.over {
            return None;
        }
        state.taken = state.changes;
        state.hurry = false;
        state.expected = None;
        state.wanted.number += STEP;
        let (number, started) = (state.wanted.number, Instant::now());
        let running = Arc::new(Running { number, evaluation: Evaluation::default(), started, announced: AtomicBool::new(false) });
        state.running = Some(running.clone());
        let request = state.wanted.clone();
        state.wanted.again = false;
        Some((request, running))
    }

    /// The evaluation has ended. `tell` is called with what the pages must know of that, where they know that it ran.
    pub fn finished(&self, tell: impl FnOnce(&Value)) {
        let _one_after_the_other = self.telling.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(running) = self.state().running.take() else { return };
        if running.announced.load(Ordering::Relaxed) {
            tell(&json!({ "number": running.number, "phase": null }));
        }
    }

    /// Does what is due. To be called some times a second.
    pub fn tick(&self) {
        let mut state = self.state();
        if state.hurry && state.running.as_ref().is_some_and(|running| running.started.elapsed() >= SHORT) {
            state.stop();
        }
        if state.expected.is_some_and(|since| since.elapsed() >= WRITTEN) {
            state.expected = None;
            state.changes += 1;
            self.wake.notify_all();
        }
    }

    /// Calls `tell` with how far the running evaluation is, where it runs long enough to be announced. To be called ten times a second at most.
    pub fn progress(&self, tell: impl FnOnce(&Value)) {
        let _one_after_the_other = self.telling.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(running) = self.state().running.clone() else { return };
        let seconds = running.started.elapsed();
        if seconds < ANNOUNCED_AFTER {
            return;
        }
        running.announced.store(true, Ordering::Relaxed);
        let progress = running.evaluation.progress();
        let phase = if progress.phase.is_empty() { "evaluating" } else { &progress.phase };
        let seconds = (seconds.as_secs_f64() * 100.0).round() / 100.0;
        tell(&json!({ "number": running.number, "phase": phase, "done": progress.done, "of": progress.of, "seconds": seconds }));
    }

    fn change(&self, save: bool, change: impl FnOnce(&mut State)) {
        let mut state = self.state();
        change(&mut state);
        state.wanted.again = false;
        state.changes += 1;
        let short = state.running.as_ref().is_some_and(|running| running.started.elapsed() < SHORT);
        if save || !short {
            state.stop();
        } else {
            state.hurry = true;
        }
        self.wake.notify_all();
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// There is something to evaluate.
    fn is_due(&self) -> bool {
        self.there && self.changes > self.taken
    }

    fn stop(&self) {
        if let Some(running) = &self.running {
            running.evaluation.stop();
        }
    }
}
