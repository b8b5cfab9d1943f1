//! Writes a golden and its stored files anew.

use super::copies;
use super::file::{CaseParams, Entry, Golden, Section};
use super::line::Line;
use super::model_test::ModelTest;
use super::verdict::{CaseResult, Verdict};
use crate::session::staging::Staging;

impl ModelTest<'_> {
    /// Writes the golden and its stored files anew; what was not run stays as it is.
    pub(super) fn accept(&self, runs: &[CaseParams]) -> Vec<CaseResult> {
        let mut results = Vec::new();
        let mut golden = Golden { head: self.golden.head.clone(), sections: Vec::new() };
        let (staging, mut changed) = (Staging::default(), false);
        for (case, _) in self.golden.head.runs() {
            let old = self.golden.section(case.as_deref());
            let Some((_, sets)) = runs.iter().find(|(name, _)| *name == case) else {
                golden.sections.extend(old.cloned());
                continue;
            };
            let start = (self.settings.clock)();
            let ran = match self.run(case.as_deref(), sets) {
                Ok(ran) => ran,
                Err(result) => return vec![result],
            };
            let (compares, stored) = (&self.golden.head.compares, Self::folder(&self.test.stored(), case.as_deref()));
            let name = self.name(case.as_deref());
            match copies::store(&stored, &ran.files, compares, &staging) {
                Ok(stored) => changed |= stored,
                Err(text) => return vec![CaseResult::new(name, Verdict::Missing, text)],
            }
            golden.sections.push(renewed(old, case, ran.found.lines));
            let seconds = (self.settings.clock)() - start;
            results.push(CaseResult { seconds, ..CaseResult::new(name, Verdict::Passed, "") });
        }
        if self.settings.job.go_on().is_err() {
            return vec![CaseResult::new(&self.test.name, Verdict::Interrupted, "interrupted")];
        }
        let whole = runs.len() == self.golden.head.runs().len();
        match self.write(golden, whole, changed, &staging) {
            Ok(true) => results.iter_mut().for_each(|r| r.verdict = Verdict::Accepted),
            Ok(false) => {}
            Err(error) => return vec![CaseResult::new(&self.test.name, Verdict::Unreadable, format!("cannot write {error}"))],
        }
        results
    }

    /// Writes what changed; whether anything did. A golden that would only be signed by another version stays as it is.
    fn write(&self, mut golden: Golden, whole: bool, mut changed: bool, staging: &Staging) -> std::io::Result<bool> {
        let old = std::fs::read(&self.test.golden).unwrap_or_default();
        changed |= golden.text().as_bytes() != old.as_slice();
        if changed {
            if whole {
                golden.head.set_producer();
            }
            let text = golden.text();
            let named = |error: std::io::Error| std::io::Error::new(error.kind(), format!("{}: {error}", self.test.golden.display()));
            staging.write(&self.test.golden, &mut |out| out.write_all(text.as_bytes())).map_err(named)?;
            staging.commit()?;
        }
        Ok(changed)
    }
}

/// New lines in the old section: comments stay with the line they stood at.
fn renewed(old: Option<&Section>, case: Option<String>, lines: Vec<Line>) -> Section {
    let mut rest: Vec<Entry> = old.map(|s| s.entries.clone()).unwrap_or_default();
    let mut section = Section { case, above: old.map(|s| s.above.clone()).unwrap_or_default(), ..Section::default() };
    for line in lines {
        let was = rest.iter().position(|e| e.line.kind == line.kind && e.line.name == line.name).map(|at| rest.remove(at));
        let (above, behind) = was.map_or((Vec::new(), None), |entry| (entry.above, entry.behind));
        section.entries.push(Entry { above, behind, line });
    }
    // Comments of lines that are gone stay at the end.
    section.below = rest.into_iter().flat_map(|e| e.above.into_iter().chain(e.behind)).collect();
    section.below.extend(old.map(|s| s.below.clone()).unwrap_or_default());
    section
}
