//! Where reports go while a script is evaluated.

use crate::base::fault::Fault;
use crate::base::limits::{REPORTS_OF_A_KIND, REPORTS_TOLD};
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::eval::context::Cx;

/// Reports back to which a new one is looked for, so that equal ones are counted.
pub(crate) const SAID_JUST_NOW: usize = 64;

/// Reports in the order in which they were made.
#[derive(Debug, Default)]
pub struct Sink {
    /// Those that are kept.
    pub reports: Vec<Diagnostic>,
    /// Every report is kept in its own words, also where a screen shows one for many.
    pub whole: bool,
}

impl Sink {
    /// Takes a report. One that was made just before is counted, not kept, so that a loop that says the same a million times
    /// holds one; of one code a thousand are kept at most.
    pub fn say(&mut self, diagnostic: Diagnostic) {
        match self.reports.iter_mut().rev().take(SAID_JUST_NOW).find(|d| d.is_like(&diagnostic)) {
            Some(found) => found.fold(diagnostic, self.whole),
            None => self.keep(diagnostic),
        }
    }

    fn keep(&mut self, diagnostic: Diagnostic) {
        let of_this = |d: &&mut Diagnostic| d.code == diagnostic.code;
        let kept = if self.reports.len() < REPORTS_OF_A_KIND { 0 } else { self.reports.iter_mut().filter(of_this).count() };
        match self.reports.iter_mut().rev().find(of_this) {
            Some(last) if kept >= REPORTS_OF_A_KIND => last.fold(diagnostic, self.whole),
            _ => self.reports.push(diagnostic),
        }
    }
}

impl Cx<'_> {
    /// Says notes and warnings; of a kind that comes in thousands the first [`REPORTS_OF_A_KIND`] in words, the rest as a count.
    pub fn say_all(&mut self, faults: &[Fault]) {
        let mut kinds: Vec<(&Fault, usize)> = Vec::new();
        let kind_of: Vec<usize> = faults
            .iter()
            .map(|fault| {
                let kind = kinds.iter().position(|(first, _)| first.same_kind(fault)).unwrap_or(kinds.len());
                if kind == kinds.len() {
                    kinds.push((fault, 0));
                }
                kinds[kind].1 += 1;
                kind
            })
            .collect();
        let mut said = vec![0; kinds.len()];
        let most = if self.sink.whole { REPORTS_TOLD } else { REPORTS_OF_A_KIND };
        for (fault, kind) in faults.iter().zip(kind_of) {
            said[kind] += 1;
            let rest = kinds[kind].1.saturating_sub(most);
            match said[kind] {
                n if n == most => self.say_counted(fault, rest),
                n if n < most => self.say(fault),
                _ => {}
            }
        }
    }
}
