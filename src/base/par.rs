//! Work on several threads with results in order: the same bytes whatever the number of threads.
//!
//! Whoever helps works for the job and the budget of the thread that asked, and looks at the job before each item. The only place that knows rayon. Without the feature `parallel` every function here is a plain loop.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::{job, work};

static THREADS: AtomicUsize = AtomicUsize::new(0);

/// Sets how many threads later work may use; 0 means one per core. Takes effect before the first parallel work.
pub fn set_threads(n: usize) {
    THREADS.store(n, Ordering::Relaxed);
}

#[cfg(feature = "parallel")]
fn pool() -> Option<&'static rayon::ThreadPool> {
    static POOL: std::sync::OnceLock<Option<rayon::ThreadPool>> = std::sync::OnceLock::new();
    let n = THREADS.load(Ordering::Relaxed);
    if n == 1 {
        return None;
    }
    POOL.get_or_init(|| rayon::ThreadPoolBuilder::new().num_threads(n).build().ok()).as_ref()
}

/// What a thread that helps works for: the job and the budget of the thread that asked.
struct Helper {
    watched: job::Watched,
    budget: Option<work::Budget>,
}

/// A thread helps until this is dropped.
struct HelpingThread {
    // First: what is pending is charged while the thread still helps the job.
    _budget: work::Charging,
    _job: job::Entered,
}

impl Helper {
    fn of_this_thread() -> Self {
        Self { watched: job::watched(), budget: work::budget() }
    }

    fn enter(&self) -> HelpingThread {
        let job = self.watched.clone().enter();
        HelpingThread { _budget: work::Charging::to(self.budget.clone()), _job: job }
    }
}

/// Pieces of work for each thread: many enough that none waits long for another one.
#[cfg(feature = "parallel")]
const PIECES_PER_THREAD: usize = 32;

/// Consecutive ranges of `0..n` for several threads; one for all of it where there is one thread.
fn ranges(n: usize) -> impl ExactSizeIterator<Item = Range<usize>> {
    #[cfg(feature = "parallel")]
    let pieces = pool().map_or(1, |pool| n.min(PIECES_PER_THREAD * pool.current_num_threads())).max(1);
    #[cfg(not(feature = "parallel"))]
    let pieces = 1;
    (0..pieces).map(move |k| n * k / pieces..n * (k + 1) / pieces)
}

/// Calls `work` with each number below `n`. Not generic: what a caller adds to the program is its closure alone.
fn for_each(n: usize, work: &(dyn Fn(usize) + Sync)) {
    #[cfg(feature = "parallel")]
    if n > 1
        && let Some(pool) = pool()
    {
        use rayon::prelude::*;
        let helper = Helper::of_this_thread();
        pool.install(|| (0..n).into_par_iter().for_each_init(|| helper.enter(), |_, k| work(k)));
        return;
    }
    (0..n).for_each(work);
}

/// `[f(0), f(1), … f(n - 1)]`, made on several threads when `n > 1`.
pub fn map<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    let piece = |range: Range<usize>| -> Vec<T> {
        let item = |k: usize| {
            job::poll();
            f(k)
        };
        range.map(item).collect()
    };
    let ranges = ranges(n);
    if ranges.len() == 1 {
        return piece(0..n);
    }
    let pieces: Vec<_> = ranges.map(|range| Mutex::new((range, Vec::new()))).collect();
    for_each(pieces.len(), &|k| {
        let mut own = pieces[k].lock().unwrap_or_else(PoisonError::into_inner);
        own.1 = piece(own.0.clone());
    });
    let mut all = Vec::with_capacity(n);
    pieces.into_iter().for_each(|own| all.append(&mut own.into_inner().unwrap_or_else(PoisonError::into_inner).1));
    all
}

/// Like [`map`] for work that may fail; the failure of the smallest index wins.
pub fn try_map<T: Send, E: Send>(n: usize, f: impl Fn(usize) -> Result<T, E> + Sync + Send) -> Result<Vec<T>, E> {
    map(n, f).into_iter().collect()
}

/// Calls `f(k, part)` on consecutive parts of `items` of `size` items (the last may be shorter).
pub fn chunks_mut<T: Send>(items: &mut [T], size: usize, f: impl Fn(usize, &mut [T]) + Sync + Send) {
    let parts: Vec<_> = items.chunks_mut(size.max(1)).map(Mutex::new).collect();
    for_each(parts.len(), &|k| {
        job::poll();
        f(k, &mut parts[k].lock().unwrap_or_else(PoisonError::into_inner));
    });
}

/// Whether this thread leaves its work by unwinding: another reason to leave would end the program.
pub fn is_unwinding() -> bool {
    std::thread::panicking()
}

/// Runs `work` on a thread of its own with a stack of so many bytes; on this one when no thread can be had.
///
/// A panic of the work goes on in the caller.
pub fn on_stack<T: Send>(bytes: usize, work: impl FnOnce() -> T + Send) -> T {
    let mut work = Some(work);
    let mut result = None;
    let helper = Helper::of_this_thread();
    let started = std::thread::scope(|scope| {
        let (work, result, helper) = (&mut work, &mut result, &helper);
        let body = move || {
            let _entered = helper.enter();
            *result = work.take().map(|w| w());
        };
        match std::thread::Builder::new().stack_size(bytes).spawn_scoped(scope, body) {
            Ok(handle) => handle.join(),
            Err(_) => Ok(()),
        }
    });
    if let Err(panic) = started {
        std::panic::resume_unwind(panic);
    }
    match result {
        Some(value) => value,
        None => work.take().expect("the work is taken only by a thread that ran")(),
    }
}
