//! Work on several threads with results in order: the same bytes whatever the number of threads.
//!
//! Whoever helps works for the job and the budget of the thread that asked, and looks at the job before each item. The only place that knows rayon. Without the feature `parallel` every function here is a plain loop.

use std::sync::atomic::{AtomicUsize, Ordering};

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
        let job = self.watched.enter();
        HelpingThread { _budget: work::Charging::to(self.budget.clone()), _job: job }
    }
}

/// `[f(0), f(1), … f(n - 1)]`, made on several threads when `n > 1`.
pub fn map<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "parallel")]
    if n > 1 {
        use rayon::prelude::*;
        if let Some(pool) = pool() {
            let helper = Helper::of_this_thread();
            let item = |_: &mut HelpingThread, k: usize| {
                job::poll();
                f(k)
            };
            return pool.install(|| (0..n).into_par_iter().map_init(|| helper.enter(), item).collect());
        }
    }
    let item = |k: usize| {
        job::poll();
        f(k)
    };
    (0..n).map(item).collect()
}

/// Like [`map`] for work that may fail; the failure of the smallest index wins.
pub fn try_map<T: Send, E: Send>(n: usize, f: impl Fn(usize) -> Result<T, E> + Sync + Send) -> Result<Vec<T>, E> {
    map(n, f).into_iter().collect()
}

/// Calls `f(k, part)` on consecutive parts of `items` of `size` items (the last may be shorter).
pub fn chunks_mut<T: Send>(items: &mut [T], size: usize, f: impl Fn(usize, &mut [T]) + Sync + Send) {
    let size = size.max(1);
    #[cfg(feature = "parallel")]
    if items.len() > size {
        use rayon::prelude::*;
        if let Some(pool) = pool() {
            let helper = Helper::of_this_thread();
            let one = |_: &mut HelpingThread, (k, part): (usize, &mut [T])| {
                job::poll();
                f(k, part);
            };
            pool.install(|| items.par_chunks_mut(size).enumerate().for_each_init(|| helper.enter(), one));
            return;
        }
    }
    for (k, part) in items.chunks_mut(size).enumerate() {
        job::poll();
        f(k, part);
    }
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
