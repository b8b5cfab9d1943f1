//! How long work is told to stop and tells how far it is.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::fault::{Fault, Result};

/// A stop flag and two counters, shared between the work and whoever waits for it.
///
/// Work asks [`Job::go_on`] at each row, face or round. Counters never change a result.
#[derive(Debug, Default)]
pub struct Job {
    stop: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
}

impl Job {
    /// A job that nobody watches.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the work to stop at its next question.
    pub fn cancel(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// `Ok` to go on, or [`Fault::Interrupted`].
    pub fn go_on(&self) -> Result<()> {
        if self.stop.load(Ordering::Relaxed) { Err(Fault::Interrupted) } else { Ok(()) }
    }

    /// Announces `n` more steps of work.
    pub fn expect(&self, n: u64) {
        self.total.fetch_add(n, Ordering::Relaxed);
    }

    /// Says that `n` steps are done.
    pub fn advance(&self, n: u64) {
        self.done.fetch_add(n, Ordering::Relaxed);
    }

    /// Steps done and steps announced.
    pub fn progress(&self) -> (u64, u64) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }
}
