//! Work that is counted while it runs: evaluations of curves and surfaces, and what other loops say of themselves, against a
//! budget. Counts decide, never the clock, so that what is refused on one machine and one thread is refused on all.
//!
//! Loops deep in the kernel return points, not results. What goes over its budget is therefore unwound to where the
//! budget was set ([`Budget::within`]), as rayon and std hand a panic on; the panic hook is not called. What is spent also counts
//! for the whole run ([`job::Job::run`]), whoever is charged for it, or nobody.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::convert::Infallible;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use super::{job, par};

/// Units that a thread counts by itself before it charges them.
const AT_A_TIME: u64 = 4096;

thread_local! {
    /// What the work of this thread is charged to.
    static BUDGET: RefCell<Option<Budget>> = const { RefCell::new(None) };
    /// What this thread spent and has not charged yet.
    static PENDING: Cell<u64> = const { Cell::new(0) };
}

/// More work than the budget allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exceeded;

#[derive(Debug, Default)]
struct Counts {
    limit: AtomicU64,
    spent: AtomicU64,
    /// The budget that is charged as well, where this one only measures a part of its work.
    whole: Option<Budget>,
}

/// A budget of work, shared by the threads that do it.
#[derive(Clone, Debug)]
pub struct Budget(Arc<Counts>);

impl Budget {
    /// So many units; one is about an evaluation of a curve.
    pub fn new(limit: u64) -> Self {
        Self(Arc::new(Counts { limit: AtomicU64::new(limit), ..Counts::default() }))
    }

    /// One that only measures a part of the work of another one, where there is one.
    fn part_of(whole: Option<Self>) -> Self {
        Self(Arc::new(Counts { limit: AtomicU64::new(u64::MAX), whole, ..Counts::default() }))
    }

    /// Adds to the budget of what is being done. The sum is the same in every run where this is not called by parallel work.
    pub fn allow(&self, more: u64) {
        if let Some(whole) = &self.0.whole {
            return whole.allow(more);
        }
        let sum = self.0.limit.load(Ordering::Relaxed).saturating_add(more);
        self.0.limit.store(sum, Ordering::Relaxed);
    }

    /// Units spent so far, but for the last few of other threads.
    pub fn spent(&self) -> u64 {
        self.0.spent.load(Ordering::Relaxed)
    }

    fn charge(&self, units: u64) {
        self.0.spent.fetch_add(units, Ordering::Relaxed);
        if let Some(whole) = &self.0.whole {
            whole.charge(units);
        }
    }

    /// Units that may still be spent.
    fn left(&self) -> u64 {
        let own = || self.0.limit.load(Ordering::Relaxed).saturating_sub(self.spent());
        self.0.whole.as_ref().map_or_else(own, Self::left)
    }

    fn is_exceeded(&self) -> bool {
        self.0.whole.as_ref().map_or_else(|| self.spent() > self.0.limit.load(Ordering::Relaxed), Self::is_exceeded)
    }

    /// Runs `work` within this budget, starting from nothing spent; a budget around it is not charged and goes on afterwards.
    ///
    /// Fails where the work goes over the budget, in its midst: what it changed is left as it then is.
    pub fn within<T>(&self, work: impl FnOnce() -> T) -> Result<T, Exceeded> {
        let before = self.0.spent.swap(0, Ordering::Relaxed);
        let limit = self.0.limit.load(Ordering::Relaxed);
        let charging = Charging::to(Some(self.clone()));
        let done = catch_unwind(AssertUnwindSafe(work));
        drop(charging);
        let exceeded = self.is_exceeded();
        self.0.spent.store(before, Ordering::Relaxed);
        self.0.limit.store(limit, Ordering::Relaxed);
        match done {
            Ok(_) if exceeded => Err(Exceeded),
            Ok(made) => Ok(made),
            Err(panic) if is_ours(panic.as_ref()) => Err(Exceeded),
            Err(panic) => resume_unwind(panic),
        }
    }
}

fn is_ours(panic: &(dyn Any + Send)) -> bool {
    panic.is::<Exceeded>()
}

/// While it lives, work of this thread is charged to its budget, or to none; what is pending is charged when it is dropped.
#[derive(Debug)]
pub struct Charging {
    before: Option<Budget>,
    pending: u64,
}

impl Charging {
    /// Charges `budget` from now on.
    pub fn to(budget: Option<Budget>) -> Self {
        Self { before: BUDGET.replace(budget), pending: PENDING.replace(0) }
    }
}

impl Drop for Charging {
    fn drop(&mut self) {
        let spent = PENDING.replace(self.pending);
        if let Some(budget) = BUDGET.replace(self.before.take()) {
            budget.charge(spent);
        }
        job::charge(spent);
    }
}

/// Units that this thread may still spend; without a budget as many as there are. The same in every run where no parallel work is charged to
/// the same budget at the time.
pub fn left() -> u64 {
    BUDGET.with_borrow(|budget| budget.as_ref().map_or(u64::MAX, |budget| budget.left().saturating_sub(PENDING.get())))
}

/// Says that `units` of work are done or about to be done.
#[inline]
pub fn spend(units: u64) {
    let pending = PENDING.get().saturating_add(units);
    PENDING.set(pending);
    if pending >= AT_A_TIME {
        settle();
    }
}

#[cold]
fn settle() {
    let spent = PENDING.replace(0);
    let exceeded = BUDGET.with_borrow(|budget| {
        let Some(budget) = budget else { return false };
        budget.charge(spent);
        budget.is_exceeded()
    });
    job::charge(spent);
    if exceeded && !par::is_unwinding() {
        resume_unwind(Box::new(Exceeded));
    }
    job::poll();
}

/// Runs `work` without charging anyone: what is made once for everyone, and what has a budget of its own inside.
pub fn uncharged<T>(work: impl FnOnce() -> T) -> T {
    let _charging = Charging::to(None);
    work()
}

/// Runs `work` without charging anyone, with a budget that counts what it has spent so far and is never exceeded.
pub fn metered<T>(work: impl FnOnce(&Budget) -> T) -> T {
    let meter = Budget::new(u64::MAX);
    let _charging = Charging::to(Some(meter.clone()));
    work(&meter)
}

/// Runs `work` at the charge of whoever is charged already, and says how many units it took.
pub fn measured<T>(work: impl FnOnce() -> T) -> (T, u64) {
    let part = Budget::part_of(budget());
    let charging = Charging::to(Some(part.clone()));
    let made = work();
    drop(charging);
    (made, part.spent())
}

/// A value that is made once, whoever asks for it: each is charged what it takes, so that the order of asking decides nothing, and a budget
/// that it has been too much for is known to be exceeded without making it again.
#[derive(Debug)]
pub struct Once<T> {
    /// With the work that it took.
    made: OnceLock<(T, u64)>,
    /// Work that a budget was exceeded with before it was made; 0: none was.
    least: AtomicU64,
}

impl<T> Default for Once<T> {
    fn default() -> Self {
        Self { made: OnceLock::new(), least: AtomicU64::new(0) }
    }
}

impl<T: Clone> Once<T> {
    /// The value.
    pub fn get(&self, make: impl FnOnce() -> T) -> T {
        self.try_get(|| Ok::<T, Infallible>(make())).unwrap_or_else(|never| match never {})
    }

    /// The same of what may fail, which is tried again each time.
    pub fn try_get<E>(&self, make: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        if let Some((value, units)) = self.made.get() {
            spend(*units);
            return Ok(value.clone());
        }
        let (charged, least) = (budget(), self.least.load(Ordering::Relaxed));
        if charged.as_ref().is_some_and(|budget| budget.left() < least) {
            spend(least.max(AT_A_TIME));
        }
        let part = Budget::part_of(charged);
        let charging = Charging::to(Some(part.clone()));
        let made = catch_unwind(AssertUnwindSafe(make));
        drop(charging);
        match made {
            Ok(made) => made.map(|value| self.made.get_or_init(|| (value, part.spent())).0.clone()),
            Err(panic) => {
                if is_ours(panic.as_ref()) {
                    self.least.fetch_max(part.spent(), Ordering::Relaxed);
                }
                resume_unwind(panic)
            }
        }
    }
}

/// The budget that work of this thread is charged to.
pub fn budget() -> Option<Budget> {
    BUDGET.with_borrow(Clone::clone)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_ends_where_its_budget_is_spent_whatever_the_threads() {
        let budget = Budget::new(100_000);
        let each = |n: u64| budget.within(|| par::map(1000, |_| spend(n)).len());
        assert_eq!(each(100), Ok(1000));
        assert_eq!(each(101), Err(Exceeded));
        assert_eq!(each(100), Ok(1000));
        let mut items = vec![0_u8; 1000];
        assert_eq!(budget.within(|| par::chunks_mut(&mut items, 10, |_, _| spend(1001))), Err(Exceeded));
        assert_eq!(budget.within(|| par::chunks_mut(&mut items, 10, |_, _| spend(1000))), Ok(()));
    }

    #[test]
    fn what_is_left_of_a_budget_is_known_to_a_unit() {
        assert_eq!(left(), u64::MAX);
        let after = |units: u64| {
            Budget::new(100_000).within(|| {
                spend(units);
                left()
            })
        };
        assert_eq!(after(10), Ok(99_990));
        assert_eq!(after(50_001), Ok(49_999));
        assert_eq!(after(100_000), Ok(0));
    }

    #[test]
    fn an_endless_loop_is_left() {
        let endless = || loop {
            spend(1);
        };
        assert_eq!(Budget::new(1000).within(endless), Err::<(), Exceeded>(Exceeded));
    }

    #[test]
    fn a_budget_inside_another_is_charged_alone_and_uncharged_work_costs_nothing() {
        let (outer, inner) = (Budget::new(10), Budget::new(10_000));
        let work = || {
            spend(10);
            uncharged(|| spend(1_000_000));
            inner.within(|| spend(10_000))
        };
        assert_eq!(outer.within(work), Ok(Ok(())));
        assert_eq!(outer.within(|| inner.within(|| spend(10_001))), Ok(Err(Exceeded)));
        assert_eq!(outer.within(|| spend(11)), Err(Exceeded));
    }

    #[test]
    fn measured_work_is_told_exactly_and_charged_to_the_whole() {
        let all = || {
            spend(1);
            let part = measured(|| par::map(100, |k| spend(k as u64)).len());
            spend(49);
            part
        };
        assert_eq!(all(), (100, 4950));
        assert_eq!(Budget::new(5000).within(all), Ok((100, 4950)));
        assert_eq!(Budget::new(4999).within(all), Err(Exceeded));
        let raised = || {
            measured(|| budget().map(|budget| budget.allow(5000)));
            all()
        };
        assert_eq!(Budget::new(0).within(raised), Ok((100, 4950)));
        let endless = || {
            measured(|| {
                loop {
                    spend(1)
                }
            })
        };
        assert_eq!(Budget::new(5000).within(endless), Err::<((), u64), Exceeded>(Exceeded));
    }

    #[test]
    fn a_value_is_made_once_and_charged_to_all_and_a_failure_is_known() {
        let (once, made) = (Once::default(), AtomicU64::new(0));
        let get = || {
            once.get(|| {
                made.fetch_add(1, Ordering::Relaxed);
                spend(10_000);
                7
            })
        };
        assert_eq!(Budget::new(9000).within(get), Err(Exceeded));
        assert_eq!(made.load(Ordering::Relaxed), 1);
        // It is known to take more.
        assert_eq!(Budget::new(8000).within(get), Err(Exceeded));
        assert_eq!(made.load(Ordering::Relaxed), 1);
        assert_eq!(Budget::new(10_000).within(get), Ok(7));
        assert_eq!(Budget::new(10_000).within(|| measured(get)), Ok((7, 10_000)));
        assert_eq!(Budget::new(9999).within(get), Err(Exceeded));
        assert_eq!(made.load(Ordering::Relaxed), 2);
    }

    #[test]
    fn a_bug_goes_on_through_a_budget() {
        let caught = catch_unwind(|| Budget::new(10).within(|| assert_eq!(1, 2)));
        assert!(caught.is_err());
    }
}
