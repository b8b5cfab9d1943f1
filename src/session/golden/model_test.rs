//! A model in all its cases, each compared with its section of the golden.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use super::compare::{Allowance, Change, compare};
use super::copies;
use super::describe::{self, DiffLine};
use super::details::{self, Details};
use super::discover::Test;
use super::file::{CaseParams, Golden, Producer, Section};
use super::line::Line;
use super::run::{Settings, name_of};
use super::scratch::Scratch;
use super::section::{self, CaseLines};
use super::verdict::{CaseResult, Verdict};
use crate::lang::eval::context::Cx;
use crate::session::disk::{Disk, Outputs};
use crate::session::guard::guarded;
use crate::session::kept::Kept;
use crate::session::run::{self, Again, Outcome, Task};

/// A model on its way through its cases.
pub(super) struct ModelTest<'a> {
    pub(super) test: &'a Test,
    pub(super) text: &'a [u8],
    pub(super) settings: &'a Settings<'a>,
    pub(super) golden: &'a Golden,
    pub(super) scratch: Scratch,
    /// What each case takes over from those before.
    pub(super) kept: RefCell<Kept>,
}

/// One run: what it found and where its files are.
pub(super) struct CaseRun {
    pub(super) found: CaseLines,
    pub(super) files: copies::CaseFiles,
}

impl ModelTest<'_> {
    pub(super) fn name(&self, case: Option<&str>) -> String {
        name_of(self.test, case)
    }

    /// Where the outputs of a case go, and its stored copies lie.
    pub(super) fn folder(base: &Path, case: Option<&str>) -> PathBuf {
        case.map_or_else(|| base.to_owned(), |case| base.join(case))
    }

    /// Runs one case; the error says why there is nothing to compare.
    pub(super) fn run(&self, case: Option<&str>, sets: &[(String, String)]) -> Result<CaseRun, CaseResult> {
        let name = self.name(case);
        let out = Self::folder(self.scratch.path(), case);
        let cannot =
            |error: std::io::Error| CaseResult::new(&name, Verdict::Unreadable, format!("cannot read {}: {error}", self.test.name));
        let disk = Disk::new(Some(&self.test.script), Some(&out), &[], Outputs::Written).map_err(cannot)?.seen_from_home();
        let file = self.test.script.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let task = Task { full: true, ..Task::new(&file, self.text, sets, self.settings.clock) };
        let mut details = Details::default();
        let look = &mut |cx: &mut Cx<'_>| details = details::of(cx);
        // A bug may leave half of something: then the next case starts from nothing.
        let mut kept = self.kept.take();
        let again = || run::run_again(&task, &disk, self.settings.job, Again { kept: &mut kept, light: false, look, shaped: None });
        let outcome: Outcome = guarded(again).map_err(|bug| {
            let help = "please report it with the script and this text";
            CaseResult::new(&name, Verdict::Bug, format!("a bug in loft: {}", bug.what)).help(help)
        })?;
        if outcome.interrupted {
            return Err(CaseResult::new(&name, Verdict::Interrupted, "interrupted"));
        }
        if let Some(over) = outcome.over {
            return Err(CaseResult::new(&name, Verdict::Ended, over.to_string()).help("a larger `--max-work`, or none"));
        }
        self.kept.replace(kept);
        if let Some(bug) = outcome.diagnostics.iter().find(|d| d.code.0 == "E999") {
            return Err(CaseResult::new(&name, Verdict::Bug, bug.message.clone()).help("please report it with the script and this text"));
        }
        let hide = format!("{}{}", out.display(), std::path::MAIN_SEPARATOR);
        let found = section::of(&outcome, details, &hide);
        Ok(CaseRun { found, files: copies::CaseFiles { folder: out, outputs: outcome.report.outputs } })
    }

    pub(super) fn compare_all(&self, runs: &[CaseParams]) -> Vec<CaseResult> {
        let mut results = Vec::new();
        for (case, sets) in runs {
            let start = (self.settings.clock)();
            let mut result = self.compare_one(case.as_deref(), sets);
            result.seconds = (self.settings.clock)() - start;
            results.push(result);
        }
        if self.settings.filter.is_none() {
            results.extend(self.orphans());
        }
        results
    }

    fn compare_one(&self, case: Option<&str>, sets: &[(String, String)]) -> CaseResult {
        let name = self.name(case);
        let accept = format!("loft test --accept {}", self.test.name);
        let Some(section) = self.golden.section(case).or_else(|| self.nothing_expected(case)) else {
            let message = match case {
                Some(case) => format!("the golden has no section [{case}]"),
                None => "the golden has sections of cases, and its head names none".to_owned(),
            };
            return CaseResult::new(name, Verdict::Missing, message).help(accept);
        };
        let ran = match self.run(case, sets) {
            Ok(ran) => ran,
            Err(result) => return result,
        };
        let tolerance = self.golden.head.tolerance();
        let allowance = Allowance { tolerance, size: ran.found.size };
        let old: Vec<Line> = section.entries.iter().map(|entry| entry.line.clone()).collect();
        let changes = compare(&old, &ran.found.lines, &ran.found.names, allowance);
        let stored = Self::folder(&self.test.stored(), case);
        let files = copies::compare(&stored, &ran.files, &self.golden.head.compares);
        if changes.is_empty() && files.is_empty() {
            return CaseResult::new(name, Verdict::Passed, "");
        }
        let mut lines = self.other_producer();
        lines.extend(describe::changes(&changes, allowance));
        lines.extend(files.iter().map(|file| DiffLine::Words(file.text.clone())));
        let missing = changes.is_empty() && files.iter().all(|file| file.missing);
        let verdict = if missing { Verdict::Missing } else { Verdict::Differs };
        let message = format!("{name} differs from its golden{}", counted(&changes, files.len()));
        CaseResult { lines, ..CaseResult::new(name, verdict, message).help(format!("if this is as it should be: {accept}")) }
    }

    /// A golden without any line is one of a model that finds nothing: an empty script.
    fn nothing_expected(&self, case: Option<&str>) -> Option<&Section> {
        static NOTHING: Section = Section { case: None, above: Vec::new(), entries: Vec::new(), below: Vec::new() };
        (case.is_none() && self.golden.sections.is_empty()).then_some(&NOTHING)
    }

    /// What is said first when another program made the golden.
    fn other_producer(&self) -> Vec<DiffLine> {
        let this = Producer::this();
        match &self.golden.head.made_by {
            Some(producer) if *producer != this => {
                let mesher = if producer.mesher == this.mesher { "" } else { "; the mesher has another version, so meshes may differ" };
                vec![DiffLine::Words(format!("made by {}, compared by {}{mesher}", producer.text(), this.text()))]
            }
            _ => Vec::new(),
        }
    }

    /// Sections whose case is gone, and stored files that nothing compares.
    fn orphans(&self) -> Vec<CaseResult> {
        let runs = self.golden.head.runs();
        let is_run = |case: Option<&str>| runs.iter().any(|(name, _)| name.as_deref() == case);
        let mut found = Vec::new();
        for section in self.golden.sections.iter().filter(|s| !is_run(s.case.as_deref())) {
            let (name, what) = match &section.case {
                Some(case) => (self.name(Some(case)), format!("the section [{case}] belongs to no `case` of the head")),
                None => (self.test.name.clone(), "there are lines above the first section, and the head names cases".to_owned()),
            };
            found.push(CaseResult::new(name, Verdict::Orphaned, what).help(format!("loft test --accept {} drops it", self.test.name)));
        }
        let folders: Vec<_> = runs.iter().map(|(case, _)| case.as_deref().map_or_else(PathBuf::new, PathBuf::from)).collect();
        for file in copies::orphans(&self.test.stored(), &folders, &self.golden.head.compares) {
            let message = format!("{} is stored, but no `compare` names it", file.display());
            found.push(CaseResult::new(&self.test.name, Verdict::Orphaned, message).help("remove it, or name it in the head"));
        }
        found
    }
}

fn counted(changes: &[Change], files: usize) -> String {
    let plural = |n: usize, one: &str| format!("{n} {one}{}", if n == 1 { "" } else { "s" });
    let parts = [(changes.len(), "line"), (files, "file")];
    let parts: Vec<String> = parts.iter().filter(|p| p.0 > 0).map(|p| plural(p.0, p.1)).collect();
    if parts.is_empty() { String::new() } else { format!(" in {}", parts.join(" and ")) }
}
