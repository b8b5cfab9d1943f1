//! Ctrl-C and other signals that end a run, and what becomes of a panic.

use std::io::{IsTerminal, Write};
use std::panic;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::Duration;

use super::Exit;
use crate::base::job::Job;
use crate::session::staging::Staging;

/// How long work may take to notice that it should stop.
const PATIENCE: Duration = Duration::from_secs(2);

/// What Ctrl-C ends: the work and the outputs on their way.
#[derive(Default)]
struct Watched {
    job: Arc<Job>,
    outputs: Vec<Staging>,
    /// The program goes on after an interrupted job.
    session: bool,
    /// Elements that a mesh may have, and evaluations that a run may take, where the command line says so.
    limits: [Option<u64>; 2],
}

impl Watched {
    /// A job within the limits of the command line.
    fn new_job(&self) -> Arc<Job> {
        let [elements, work] = self.limits;
        let job = elements.into_iter().fold(Job::new(), Job::with_most_elements);
        Arc::new(work.into_iter().fold(job, Job::with_most_work))
    }
}

static WATCHED: OnceLock<Mutex<Watched>> = OnceLock::new();

fn watched() -> std::sync::MutexGuard<'static, Watched> {
    WATCHED.get_or_init(Mutex::default).lock().unwrap_or_else(PoisonError::into_inner)
}

/// The job that Ctrl-C stops. Work that does not notice in time is ended without leaving a half file.
pub fn job() -> Arc<Job> {
    handle();
    watched().job.clone()
}

/// The job of the next entry of a session; Ctrl-C stops it and nothing else.
pub fn entry_job() -> Arc<Job> {
    handle();
    let mut watched = watched();
    watched.session = true;
    watched.job = watched.new_job();
    watched.job.clone()
}

/// A job within the limits of the command line that Ctrl-C does not stop.
pub fn own_job() -> Arc<Job> {
    watched().new_job()
}

/// Says how many elements a mesh may have and how many evaluations a run may take, before any job is asked for.
pub fn set_limits(elements: Option<u64>, work: Option<u64>) {
    let mut watched = watched();
    watched.limits = [elements, work];
    watched.job = watched.new_job();
}

fn handle() {
    // Without a handler the system ends the program at Ctrl-C; only temporary files stay then. A second call changes
    // nothing.
    let first = ctrlc::set_handler(|| {
        watched().job.cancel();
        if !watched().session {
            end(Exit::Interrupted as i32);
        }
    });
    if first.is_ok() {
        end_when_told();
    }
}

/// Ends the program once its work had time to end by itself, without a half file.
fn end(status: i32) {
    thread::sleep(PATIENCE);
    watched().outputs.iter().for_each(Staging::discard);
    if std::io::stderr().is_terminal() {
        // The line of progress goes, whatever it shows.
        let _ = std::io::stderr().write_all(b"\r\x1b[2K\x1b[?25h");
    }
    std::process::exit(status);
}

/// SIGTERM, and SIGHUP of a terminal that is gone, end sessions too.
#[cfg(unix)]
fn end_when_told() {
    use signal_hook::consts::{SIGHUP, SIGTERM};
    // Shells report a program that a signal ended as 128 and the number of the signal.
    const KILLED: i32 = 128;
    let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGTERM, SIGHUP]) else { return };
    thread::spawn(move || {
        for signal in signals.forever() {
            watched().job.cancel();
            end(KILLED + signal);
        }
    });
}

#[cfg(not(unix))]
fn end_when_told() {}

/// Registers outputs that must not stay half written.
pub fn protect(outputs: &Staging) {
    watched().outputs.push(outputs.clone());
}

/// A panic is reported by what catches it, in one message; the standard hook would print before.
pub fn keep_panics_quiet() {
    panic::set_hook(Box::new(|info| {
        let place = info.location().map(|l| format!("{}:{}", l.file(), l.line())).unwrap_or_default();
        *LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner) = place;
    }));
}

static LAST_PANIC: Mutex<String> = Mutex::new(String::new());

/// Where in the program the last panic happened.
pub fn last_panic_place() -> String {
    LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner).clone()
}
