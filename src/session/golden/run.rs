//! Runs models and compares what they say with their goldens, or writes the goldens anew.

use std::cell::RefCell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread;

use super::describe::{self, DiffLine};
use super::discover::{Test, TestState};
use super::file::{Flaw, Golden, Head};
use super::model_test::ModelTest;
use super::scratch::Scratch;
use super::verdict::{CaseResult, Verdict};
use crate::base::job::Job;
use crate::base::limits;
use crate::io::FileError;
use crate::session::disk::read_limited;
use crate::session::kept::Kept;

/// How tests are run.
#[derive(Clone, Copy)]
pub struct Settings<'a> {
    /// Goldens are written anew instead of compared.
    pub accept: bool,
    /// Only runs whose name holds this.
    pub filter: Option<&'a str>,
    /// Models that run at the same time; at least 1.
    pub jobs: usize,
    /// Seconds since some moment.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
    /// Stops everything.
    pub job: &'a Job,
}

/// The name of a run of a test.
pub fn name_of(test: &Test, case: Option<&str>) -> String {
    case.map_or_else(|| test.name.clone(), |case| format!("{} [{case}]", test.name))
}

/// Runs tests; `each` gets the results of one after the other in the order of the tests, whichever ends first.
pub fn run_all(tests: &[Test], settings: &Settings, each: &mut dyn FnMut(&[CaseResult])) {
    let next = AtomicUsize::new(0);
    let (send, receive) = channel();
    thread::scope(|scope| {
        for _ in 0..settings.jobs.clamp(1, tests.len().max(1)) {
            let (send, next) = (send.clone(), &next);
            scope.spawn(move || {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    let Some(test) = tests.get(k).filter(|_| settings.job.go_on().is_ok()) else { return };
                    // Whoever listens has gone only when everything ends.
                    let _ = send.send((k, watched_one(test, settings)));
                }
            });
        }
        drop(send);
        let mut waiting: Vec<Option<Vec<CaseResult>>> = vec![None; tests.len()];
        let mut reported = 0;
        for (k, results) in receive {
            waiting[k] = Some(results);
            while let Some(results) = waiting.get_mut(reported).and_then(Option::take) {
                each(&results);
                reported += 1;
            }
        }
        waiting.into_iter().flatten().for_each(|results| each(&results));
    });
}

/// The names of the runs of a test; its own where its golden cannot be read.
pub fn names(test: &Test) -> Vec<String> {
    let read = read_limited(&test.golden, limits::SOURCE_BYTES).ok().and_then(|bytes| Golden::parse(&bytes).ok());
    match read {
        Some((golden, _)) => golden.head.runs().iter().map(|(case, _)| name_of(test, case.as_deref())).collect(),
        None => vec![test.name.clone()],
    }
}

/// The same as [`run_one`], also stopped while it compares.
fn watched_one(test: &Test, settings: &Settings) -> Vec<CaseResult> {
    let stopped = |_| vec![CaseResult::new(&test.name, Verdict::Interrupted, "interrupted")];
    settings.job.watch(|| run_one(test, settings)).unwrap_or_else(stopped)
}

/// Runs one model in all its cases.
pub fn run_one(test: &Test, settings: &Settings) -> Vec<CaseResult> {
    run_one_again(test, settings, &mut Kept::default())
}

/// Runs one model in all its cases; `kept` holds what runs before left, and what these leave when they are over.
pub fn run_one_again(test: &Test, settings: &Settings, kept: &mut Kept) -> Vec<CaseResult> {
    let wanted = |name: &str| settings.filter.is_none_or(|filter| name.contains(filter));
    let alone = |result: CaseResult| if wanted(&result.name) { vec![result] } else { Vec::new() };
    let golden_name = test.golden.to_string_lossy().replace('\\', "/");
    match test.state {
        TestState::NoScript => {
            let message = format!("{golden_name} has no script: there is no {}", test.name);
            return alone(
                CaseResult::new(&test.name, Verdict::Orphaned, message).help(format!("remove {golden_name}, or bring the script back")),
            );
        }
        TestState::NoGolden if !settings.accept => {
            let message = format!("{} has no golden", test.name);
            return alone(CaseResult::new(&test.name, Verdict::Missing, message).help(format!("loft test --accept {}", test.name)));
        }
        _ => {}
    }
    let text = match read_limited(&test.script, limits::SOURCE_BYTES + 1) {
        Ok(text) => text,
        Err(error) => {
            return alone(CaseResult::new(
                &test.name,
                Verdict::Unreadable,
                format!("cannot read {}: {}", test.name, why_unreadable(&error)),
            ));
        }
    };
    let read = match test.state {
        TestState::NoGolden => Ok((Golden { head: Head::fresh(), sections: Vec::new() }, Vec::new())),
        _ => match read_limited(&test.golden, limits::SOURCE_BYTES) {
            Ok(bytes) => Golden::parse(&bytes),
            Err(error) => Err(vec![Flaw { line: 0, what: why_unreadable(&error) }]),
        },
    };
    let golden = match read {
        Ok((golden, flaws)) if flaws.is_empty() || settings.accept => golden,
        Ok((_, flaws)) | Err(flaws) => return alone(unreadable(test, &golden_name, &flaws, settings.accept)),
    };
    let before = RefCell::new(std::mem::take(kept));
    let model = ModelTest { test, text: &text, settings, golden: &golden, scratch: Scratch::new(), kept: before };
    let runs: Vec<_> = golden.head.runs().into_iter().filter(|(case, _)| wanted(&name_of(test, case.as_deref()))).collect();
    let results = if settings.accept { model.accept(&runs) } else { model.compare_all(&runs) };
    *kept = model.kept.into_inner();
    results
}

/// Why a file cannot be read.
pub(super) fn why_unreadable(error: &FileError) -> String {
    match error {
        FileError::Missing { .. } => "there is no such file".to_owned(),
        FileError::Outside => "it lies outside the allowed folders".to_owned(),
        FileError::TooLarge(bytes) => format!("it has {bytes} bytes, the limit is {}", limits::SOURCE_BYTES),
        FileError::Other(text) => text.clone(),
    }
}

fn unreadable(test: &Test, golden: &str, flaws: &[Flaw], accept: bool) -> CaseResult {
    let place = |f: &Flaw| if f.line == 0 { format!("{golden}: {}", f.what) } else { format!("{golden}:{}: {}", f.line, f.what) };
    let mut lines = flaws.iter().map(place);
    let mut result = CaseResult::new(&test.name, Verdict::Unreadable, lines.next().unwrap_or_default());
    result.lines = lines.take(describe::MOST).map(DiffLine::Words).collect();
    if flaws.len() > describe::MOST + 1 {
        result.lines.push(DiffLine::Words(format!("and {} more", flaws.len() - describe::MOST - 1)));
    }
    if accept { result.help("the head is written by hand, and only you can fix it") } else { result }
}
