//! Work that is weighed while it runs: evaluations of curves and surfaces, and what other loops say of themselves, against an
//! allowance. Counts decide, never the clock, so that what is refused on one machine and one thread is refused on all.
//!
//! Loops deep in the kernel return points, not results. What goes over its allowance is therefore unwound to where the
//! allowance was given ([`Purse::within`]), as rayon and std hand a panic on; the panic hook is not called.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Units that a thread counts by itself before it takes them from the purse.
const AT_A_TIME: u64 = 4096;

thread_local! {
    /// What this thread spends from.
    static PURSE: RefCell<Option<Purse>> = const { RefCell::new(None) };
    /// What it spent and has not taken from there yet.
    static LOOSE: Cell<u64> = const { Cell::new(0) };
}

/// More work than was allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exceeded;

#[derive(Debug, Default)]
struct Counts {
    allowed: AtomicU64,
    spent: AtomicU64,
}

/// An allowance of work, shared by the threads that do it.
#[derive(Clone, Debug)]
pub struct Purse(Arc<Counts>);

impl Purse {
    /// So many units; one is about an evaluation of a curve.
    pub fn new(allowed: u64) -> Self {
        Self(Arc::new(Counts { allowed: AtomicU64::new(allowed), spent: AtomicU64::new(0) }))
    }

    /// Adds to the allowance of what is being done. The sum is the same in every run where this is not called by parallel work.
    pub fn allow(&self, more: u64) {
        let sum = self.0.allowed.load(Ordering::Relaxed).saturating_add(more);
        self.0.allowed.store(sum, Ordering::Relaxed);
    }

    /// Units spent so far, but for the last few of other threads.
    pub fn spent(&self) -> u64 {
        self.0.spent.load(Ordering::Relaxed)
    }

    fn is_empty(&self) -> bool {
        self.spent() > self.0.allowed.load(Ordering::Relaxed)
    }

    /// Runs `work` at the cost of this purse, starting from nothing spent; what another purse pays around it goes on afterwards.
    ///
    /// Fails where the work goes over the allowance, in its midst: what it changed is left as it then is.
    pub fn within<T>(&self, work: impl FnOnce() -> T) -> Result<T, Exceeded> {
        let before = self.0.spent.swap(0, Ordering::Relaxed);
        let allowed = self.0.allowed.load(Ordering::Relaxed);
        let paid = Paid::by(Some(self.clone()));
        let done = catch_unwind(AssertUnwindSafe(work));
        drop(paid);
        let empty = self.is_empty();
        self.0.spent.store(before, Ordering::Relaxed);
        self.0.allowed.store(allowed, Ordering::Relaxed);
        match done {
            Ok(_) if empty => Err(Exceeded),
            Ok(made) => Ok(made),
            Err(panic) if is_ours(panic.as_ref()) => Err(Exceeded),
            Err(panic) => resume_unwind(panic),
        }
    }
}

fn is_ours(panic: &(dyn Any + Send)) -> bool {
    panic.is::<Exceeded>()
}

/// While it lives the thread spends from another purse.
struct Paid {
    before: Option<Purse>,
    loose: u64,
}

impl Paid {
    fn by(purse: Option<Purse>) -> Self {
        Self { before: PURSE.replace(purse), loose: LOOSE.replace(0) }
    }
}

impl Drop for Paid {
    fn drop(&mut self) {
        let spent = LOOSE.replace(self.loose);
        if let Some(purse) = PURSE.replace(self.before.take()) {
            purse.0.spent.fetch_add(spent, Ordering::Relaxed);
        }
    }
}

/// Says that `units` of work are done or about to be done.
#[inline]
pub fn spend(units: u64) {
    let loose = LOOSE.get() + units;
    LOOSE.set(loose);
    if loose >= AT_A_TIME {
        settle();
    }
}

#[cold]
fn settle() {
    let spent = LOOSE.replace(0);
    let empty = PURSE.with_borrow(|purse| {
        let Some(purse) = purse else { return false };
        purse.0.spent.fetch_add(spent, Ordering::Relaxed);
        purse.is_empty()
    });
    if empty && !super::par::is_unwinding() {
        resume_unwind(Box::new(Exceeded));
    }
}

/// Runs `work` at nobody's cost: what is made once for everyone, and what has a purse of its own inside.
pub fn free<T>(work: impl FnOnce() -> T) -> T {
    let _paid = Paid::by(None);
    work()
}

/// The purse this thread spends from.
pub fn purse() -> Option<Purse> {
    PURSE.with_borrow(Clone::clone)
}

/// Runs a part of parallel work at the cost of the purse of the whole.
pub fn paid<T>(purse: Option<&Purse>, work: impl FnOnce() -> T) -> T {
    let _paid = Paid::by(purse.cloned());
    work()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::par;

    #[test]
    fn work_ends_where_its_purse_is_empty_whatever_the_threads() {
        let purse = Purse::new(100_000);
        let each = |n: u64| purse.within(|| par::map(1000, |_| spend(n)).len());
        assert_eq!(each(100), Ok(1000));
        assert_eq!(each(101), Err(Exceeded));
        assert_eq!(each(100), Ok(1000));
    }

    #[test]
    fn an_endless_loop_is_left() {
        let endless = || loop {
            spend(1);
        };
        assert_eq!(Purse::new(1000).within(endless), Err::<(), Exceeded>(Exceeded));
    }

    #[test]
    fn a_purse_inside_another_pays_for_itself_and_free_work_costs_nothing() {
        let (outer, inner) = (Purse::new(10), Purse::new(10_000));
        let work = || {
            spend(10);
            free(|| spend(1_000_000));
            inner.within(|| spend(10_000))
        };
        assert_eq!(outer.within(work), Ok(Ok(())));
        assert_eq!(outer.within(|| inner.within(|| spend(10_001))), Ok(Err(Exceeded)));
        assert_eq!(outer.within(|| spend(11)), Err(Exceeded));
    }

    #[test]
    fn a_bug_goes_on_through_a_purse() {
        let caught = catch_unwind(|| Purse::new(10).within(|| assert_eq!(1, 2)));
        assert!(caught.is_err());
    }
}
