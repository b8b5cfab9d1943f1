//! Stops work that takes long, and reports its progress.
//!
//! Work that a [`Job`] watches ([`Job::watch`]) asks at each row, face or round whether it should go on: by [`Job::go_on`]
//! where it has the job and may fail, by [`poll`] anywhere else. A look at a cancelled job unwinds to the watch around
//! the work, so that functions without errors can be stopped as well, and no half result gets anywhere.
//!
//! A job may also say how much work a run of it may do ([`Job::run`]), in evaluations of curves and surfaces; a run that does more ends
//! in the same way.

use std::cell::{Cell, RefCell};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::fault::{Fault, Result};
use super::limits::MESH_ELEMENTS;
use super::par;

#[derive(Debug, Default)]
struct Shared {
    stop: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
    /// What is done now, and how many of these there were.
    phase: Mutex<(String, u64)>,
}

impl Shared {
    /// Begins a phase or goes back to one; gives the one before.
    fn turn_to(&self, phase: String) -> String {
        let mut now = self.phase.lock().unwrap_or_else(PoisonError::into_inner);
        now.1 += 1;
        self.done.store(0, Ordering::Relaxed);
        self.total.store(0, Ordering::Relaxed);
        std::mem::replace(&mut now.0, phase)
    }

    fn phase_now(&self) -> (String, u64) {
        self.phase.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A phase of a job, which goes back to the one before when this is dropped.
#[derive(Debug)]
pub struct Phase {
    of: Arc<Shared>,
    before: String,
}

impl Drop for Phase {
    fn drop(&mut self) {
        self.of.turn_to(std::mem::take(&mut self.before));
    }
}

/// A stop flag, the phase the work is in and two counters, shared between the work and whoever waits for it; and how much it may make
/// and do.
///
/// The counters of progress never change a result.
#[derive(Debug, Default)]
pub struct Job {
    shared: Arc<Shared>,
    most_elements: Option<u64>,
    most_work: Option<u64>,
}

/// What unwinds from a look to the watch.
struct Cancelled;

/// The work of one run: what it may do, what it did, and the phase in which that became too much.
#[derive(Debug)]
struct Work {
    limit: u64,
    spent: AtomicU64,
    phase: OnceLock<String>,
}

/// A run did more work than its job allows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TooMuchWork {
    /// What it may do, evaluations of curves and surfaces.
    pub limit: u64,
    /// What was done then, in a few words; empty where nothing was said.
    pub phase: String,
}

impl fmt::Display for TooMuchWork {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "this run takes more work than `--max-work {}` allows", self.limit)?;
        if self.phase.is_empty() { Ok(()) } else { write!(f, " ({})", self.phase) }
    }
}

thread_local! {
    static WATCHED: RefCell<Watched> = const { RefCell::new(Watched { job: None, work: None }) };
}

/// The job that watches the work of a thread and the run that it belongs to, to be handed to the threads that help it.
#[derive(Clone, Debug, Default)]
pub struct Watched {
    job: Option<Arc<Shared>>,
    work: Option<Arc<Work>>,
}

/// Work of this thread belongs to a job until this is dropped.
#[derive(Debug)]
pub struct Entered {
    before: Watched,
}

/// The job of this thread's work.
pub fn watched() -> Watched {
    WATCHED.with_borrow(Clone::clone)
}

impl Watched {
    fn is_ended(&self) -> bool {
        self.job.as_ref().is_some_and(|job| job.stop.load(Ordering::Relaxed))
            || self.work.as_ref().is_some_and(|work| work.phase.get().is_some())
    }

    fn charge(&self, units: u64) {
        let Some(work) = &self.work else { return };
        if work.spent.fetch_add(units, Ordering::Relaxed).saturating_add(units) > work.limit {
            work.phase.get_or_init(|| self.job.as_ref().map_or_else(String::new, |job| job.phase_now().0));
        }
    }

    /// Work of this thread belongs to the job from now on.
    pub fn enter(self) -> Entered {
        Entered { before: WATCHED.replace(self) }
    }
}

impl Drop for Entered {
    fn drop(&mut self) {
        WATCHED.replace(std::mem::take(&mut self.before));
    }
}

/// Charges the run of this thread, where its job limits its work.
pub(super) fn charge(units: u64) {
    WATCHED.with_borrow(|watched| watched.charge(units));
}

/// Goes on unless the job of this thread was cancelled or its run did too much; costs a few nanoseconds. To be called at least every few
/// milliseconds of work.
#[inline]
pub fn poll() {
    if WATCHED.with_borrow(Watched::is_ended) {
        leave();
    }
}

#[cold]
fn leave() {
    // What is dropped on the way, such as a full buffer, is let through.
    if !par::is_unwinding() {
        resume_unwind(Box::new(Cancelled));
    }
}

/// The items of a long loop whose rounds are short: looks now and then ([`poll`]).
pub fn looking<I: IntoIterator>(items: I) -> impl Iterator<Item = I::Item> {
    const ROUNDS: usize = 1024;
    items.into_iter().enumerate().map(|(k, item)| {
        if k % ROUNDS == 0 {
            poll();
        }
        item
    })
}

/// Sorts a long list; looks now and then ([`poll`]). What is equal may change places.
pub fn sort<T: Ord>(items: &mut [T]) {
    const COMPARISONS: u32 = 1 << 14;
    let done = Cell::new(0_u32);
    items.sort_unstable_by(|a, b| {
        done.set(done.get().wrapping_add(1));
        if done.get().is_multiple_of(COMPARISONS) {
            poll();
        }
        a.cmp(b)
    });
}

impl Job {
    /// A job that nobody watches.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same for work whose meshes may have so many elements each.
    pub fn with_most_elements(self, most: u64) -> Self {
        Self { most_elements: Some(most), ..self }
    }

    /// The same for work whose runs may take so many evaluations of curves and surfaces each.
    pub fn with_most_work(self, most: u64) -> Self {
        Self { most_work: Some(most), ..self }
    }

    /// Elements that a mesh may have.
    pub fn most_elements(&self) -> u64 {
        self.most_elements.unwrap_or(MESH_ELEMENTS)
    }

    /// Asks the work to stop at its next question.
    pub fn cancel(&self) {
        self.shared.stop.store(true, Ordering::Relaxed);
    }

    /// Does work that every [`look`] in it may end; then it is [`Fault::Interrupted`].
    pub fn watch<T>(&self, work: impl FnOnce() -> T) -> Result<T> {
        self.watch_run(WATCHED.with_borrow(|watched| watched.work.clone()), work)
    }

    /// Does the work of one run, which [`Job::with_most_work`] limits: [`Fault::Interrupted`] where it was ended, and whether that was for
    /// the limit.
    pub fn run<T>(&self, work: impl FnOnce() -> T) -> (Result<T>, Option<TooMuchWork>) {
        let limit = self.most_work.map(|limit| Arc::new(Work { limit, spent: AtomicU64::new(0), phase: OnceLock::new() }));
        let done = self.watch_run(limit.clone(), work);
        let over = limit.and_then(|work| Some(TooMuchWork { limit: work.limit, phase: work.phase.get()?.clone() }));
        (done, over)
    }

    fn watch_run<T>(&self, run: Option<Arc<Work>>, work: impl FnOnce() -> T) -> Result<T> {
        let _entered = Watched { job: Some(self.shared.clone()), work: run }.enter();
        match catch_unwind(AssertUnwindSafe(work)) {
            Ok(done) => Ok(done),
            Err(payload) if payload.is::<Cancelled>() => Err(Fault::Interrupted),
            Err(payload) => resume_unwind(payload),
        }
    }

    /// `Ok` to go on, or [`Fault::Interrupted`].
    pub fn go_on(&self) -> Result<()> {
        let ended = self.shared.stop.load(Ordering::Relaxed) || WATCHED.with_borrow(Watched::is_ended);
        if ended { Err(Fault::Interrupted) } else { Ok(()) }
    }

    /// Counts work that no [`super::work::spend`] counts for the run of this thread.
    pub fn charge(&self, units: u64) {
        charge(units);
    }

    /// Says what is done from now on, in a few words (`meshing roof (1 of 2)`), until what is given back is dropped. Counters
    /// begin anew.
    pub fn phase(&self, words: impl Into<String>) -> Phase {
        Phase { of: self.shared.clone(), before: self.shared.turn_to(words.into()) }
    }

    /// What is done now, and the number of this phase.
    pub fn now(&self) -> (String, u64) {
        self.shared.phase_now()
    }

    /// Announces `n` more steps of work.
    pub fn expect(&self, n: u64) {
        self.shared.total.fetch_add(n, Ordering::Relaxed);
    }

    /// Says that `n` steps are done.
    pub fn advance(&self, n: u64) {
        self.shared.done.fetch_add(n, Ordering::Relaxed);
    }

    /// Steps done and steps announced.
    pub fn progress(&self) -> (u64, u64) {
        (self.shared.done.load(Ordering::Relaxed), self.shared.total.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::work;

    #[test]
    fn a_look_ends_cancelled_work_on_every_thread() {
        let job = Job::new();
        assert_eq!(job.watch(|| par::map(9, |k| k * k).len()).ok(), Some(9));
        let ended = job.watch(|| {
            par::map(1_000, |k| {
                if k == 500 {
                    job.cancel();
                }
                (0..1_000_000).map(|n| std::hint::black_box(n) + k).sum::<usize>()
            })
        });
        assert!(matches!(ended, Err(Fault::Interrupted)));
        // Another job, and none, go on.
        poll();
        assert!(matches!(Job::new().watch(poll), Ok(())));
        assert!(matches!(job.watch(poll), Err(Fault::Interrupted)));
    }

    #[test]
    fn long_loops_and_sorts_look() {
        let job = Job::new();
        let sum = || looking(0..5_000_u32).sum::<u32>();
        // Sorting what is sorted backwards takes few comparisons.
        let mut list: Vec<u32> = (0..100_000).map(|n: u32| n.wrapping_mul(2_654_435_761)).collect();
        assert_eq!(job.watch(sum).ok(), Some(12_497_500));
        assert!(job.watch(|| sort(&mut list)).is_ok() && list.is_sorted());
        job.cancel();
        assert!(job.watch(sum).is_err());
        list.iter_mut().for_each(|n| *n = n.wrapping_mul(2_246_822_519).rotate_left(7));
        assert!(job.watch(|| sort(&mut list)).is_err());
    }

    #[test]
    fn a_phase_ends_where_it_goes_out_of_scope() {
        let job = Job::new();
        let outer = job.phase("curves");
        {
            let _inner = job.phase("meshing roof (1 of 2)");
            job.expect(4);
            job.advance(1);
            assert_eq!((job.now().0.as_str(), job.progress()), ("meshing roof (1 of 2)", (1, 4)));
        }
        assert_eq!((job.now(), job.progress()), (("curves".to_owned(), 3), (0, 0)));
        drop(outer);
        assert_eq!(job.now().0, "");
    }

    #[test]
    fn a_run_that_does_too_much_is_ended_wherever_it_is_charged() {
        let job = Job::new().with_most_work(1_000_000);
        let each = |units: u64| {
            job.run(|| {
                let _phase = job.phase("meshing roof");
                par::map(100, |_| work::uncharged(|| work::spend(units))).len()
            })
        };
        assert!(matches!(each(10_000), (Ok(100), None)));
        let too_much = Some(TooMuchWork { limit: 1_000_000, phase: "meshing roof".to_owned() });
        let (ended, over) = each(10_001);
        assert!(matches!(ended, Err(Fault::Interrupted) | Ok(_)) && over == too_much);
        // A watch and a budget inside, and what fails there, do not hide it.
        let (ended, over) = job.run(|| {
            let done = work::Budget::new(10_000_000).within(|| job.watch(|| work::spend(2_000_000)).is_err());
            (done, job.go_on().is_err())
        });
        assert!(over.is_some() && matches!(ended, Ok((Ok(true), true))), "{ended:?}");
        assert!(matches!(each(1), (Ok(100), None)));
        // What each thread counts by itself is charged when it is done.
        let small = |n: usize| {
            let all = || par::map(n, |_| work::spend(10)).len();
            job.run(|| work::uncharged(all)).1.is_some()
        };
        assert_eq!([100_000, 100_001].map(small), [false, true]);
        assert!(matches!(Job::new().run(|| work::spend(2_000_000)), (Ok(()), None)));
    }

    #[test]
    fn other_panics_pass_a_watch() {
        let caught = catch_unwind(|| Job::new().watch(|| resume_unwind(Box::new("seven"))).is_ok());
        assert_eq!(caught.unwrap_err().downcast_ref::<&str>(), Some(&"seven"));
    }
}
