//! Work of the rows of a report: areas, volumes, boxes and errors of meshes, all of them together within one budget.

use crate::base::fault::{Fault, ValueFault};
use crate::base::limits::{REPORT_WORK, WORK_OF_A_SURFACE};
use crate::base::origin::Origin;
use crate::base::work::{self, Budget, Exceeded};
use crate::surface::Surface;

/// What the rows of a report may still take, in evaluations of curves and surfaces.
#[derive(Debug)]
pub struct RowWork {
    left: u64,
    /// E217 of the part that went over it; nothing is measured any more.
    pub exceeded: Option<Fault>,
}

impl RowWork {
    /// What the rows of a report may take beside what their things are worth.
    pub fn new() -> Self {
        Self { left: REPORT_WORK, exceeded: None }
    }

    /// Adds what some surfaces are worth: one of which a point is made of many curves as many times as there are curves.
    pub fn allow_surfaces<'a>(&mut self, surfaces: impl Iterator<Item = &'a Surface>) {
        let worth = |surface: &Surface| {
            let (across, along) = surface.curves_of_a_point();
            WORK_OF_A_SURFACE * across.max(along).max(1) as u64
        };
        self.left = surfaces.map(worth).fold(self.left, u64::saturating_add);
    }

    /// A part of a row, measured within what is left, `None` where that is too much; `what` is the part with its name, as in "the
    /// area of `roof`", and `of` where it was declared.
    pub fn part<T>(&mut self, of: Origin, what: impl FnOnce() -> String, measure: impl FnOnce() -> T) -> Option<T> {
        if self.exceeded.is_some() {
            return None;
        }
        match Budget::new(self.left).within(|| work::measured(measure)) {
            Ok((measured, units)) => {
                self.left -= units;
                Some(measured)
            }
            Err(Exceeded) => {
                self.exceeded = Some(ValueFault::RowWork { of, what: what() }.into());
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_share_one_budget_and_the_first_that_goes_over_it_is_told() {
        let mut rows = RowWork::new();
        rows.left += WORK_OF_A_SURFACE;
        let mut part = |units: u64| rows.part(Origin::NONE, || "the area of `roof`".to_owned(), || work::spend(units));
        assert_eq!([part(REPORT_WORK), part(WORK_OF_A_SURFACE), part(1), part(0)], [Some(()), Some(()), None, None]);
        let told = rows.exceeded.unwrap();
        assert_eq!((told.code().0, told.to_string().contains("the area of `roof`")), ("E217", true));
    }
}
