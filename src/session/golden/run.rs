//! Runs models and compares what they say with their goldens, or writes the goldens anew.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread;

use super::compare::{Allowance, Change, compare};
use super::copies;
use super::discover::{State, Test};
use super::file::{Entry, Flaw, Golden, Head, Maker, Run, Section};
use super::line::Line;
use super::looks::{self, Looks};
use super::scratch::Scratch;
use super::section::{self, Found};
use super::tell::{self, Said};
use crate::base::job::Job;
use crate::base::limits;
use crate::io::FileError;
use crate::lang::eval::context::Cx;
use crate::session::disk::{Disk, Outputs, read_limited};
use crate::session::guard::guarded;
use crate::session::kept::Kept;
use crate::session::run::{self, Again, Outcome, Task};
use crate::session::staging::Staging;

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

/// What became of a run, from good to bad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// It is as its golden says.
    Passed,
    /// Its golden was written.
    Accepted,
    /// It is not as its golden says.
    Differs,
    /// It has no golden, or its golden no section for this case.
    Missing,
    /// A golden without script, a section without case or a stored file that nothing compares.
    Orphaned,
    /// The golden or the script cannot be read, or the golden not written.
    Unreadable,
    /// It was ended for its work, which `--max-work` limits: nothing is compared or accepted.
    Ended,
    /// A bug in loft, caught.
    Bug,
    /// Stopped from outside.
    Interrupted,
}

impl Verdict {
    /// One word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Passed => "ok",
            Self::Accepted => "accepted",
            Self::Differs => "differs",
            Self::Missing => "missing",
            Self::Orphaned => "orphaned",
            Self::Unreadable => "unreadable",
            Self::Ended => "ended",
            Self::Bug => "bug",
            Self::Interrupted => "interrupted",
        }
    }

    /// Whether all is well.
    pub fn is_good(self) -> bool {
        self <= Self::Accepted
    }
}

/// One run of one model.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseResult {
    /// The script, with its case behind it where there is one: `roof.loft [long]`.
    pub name: String,
    /// What became of it.
    pub verdict: Verdict,
    /// One sentence; empty when all is well.
    pub message: String,
    /// What differs.
    pub said: Vec<Said>,
    /// What to do about it.
    pub help: Option<String>,
    /// How long it took.
    pub seconds: f64,
}

impl CaseResult {
    fn new(name: impl Into<String>, verdict: Verdict, message: impl Into<String>) -> Self {
        Self { name: name.into(), verdict, message: message.into(), said: Vec::new(), help: None, seconds: 0.0 }
    }

    fn help(self, text: impl Into<String>) -> Self {
        Self { help: Some(text.into()), ..self }
    }
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
        let mut told = 0;
        for (k, results) in receive {
            waiting[k] = Some(results);
            while let Some(results) = waiting.get_mut(told).and_then(Option::take) {
                each(&results);
                told += 1;
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
        State::NoScript => {
            let message = format!("{golden_name} has no script: there is no {}", test.name);
            return alone(
                CaseResult::new(&test.name, Verdict::Orphaned, message).help(format!("remove {golden_name}, or bring the script back")),
            );
        }
        State::NoGolden if !settings.accept => {
            let message = format!("{} has no golden", test.name);
            return alone(CaseResult::new(&test.name, Verdict::Missing, message).help(format!("loft test --accept {}", test.name)));
        }
        _ => {}
    }
    let text = match read_limited(&test.script, limits::SOURCE_BYTES + 1) {
        Ok(text) => text,
        Err(error) => {
            return alone(CaseResult::new(&test.name, Verdict::Unreadable, format!("cannot read {}: {}", test.name, said(&error))));
        }
    };
    let read = match test.state {
        State::NoGolden => Ok((Golden { head: Head::fresh(), sections: Vec::new() }, Vec::new())),
        _ => match read_limited(&test.golden, limits::SOURCE_BYTES) {
            Ok(bytes) => Golden::parse(&bytes),
            Err(error) => Err(vec![Flaw { line: 0, what: said(&error) }]),
        },
    };
    let golden = match read {
        Ok((golden, flaws)) if flaws.is_empty() || settings.accept => golden,
        Ok((_, flaws)) | Err(flaws) => return alone(unreadable(test, &golden_name, &flaws, settings.accept)),
    };
    let before = RefCell::new(std::mem::take(kept));
    let model = Model { test, text: &text, settings, golden: &golden, scratch: Scratch::new(), kept: before };
    let runs: Vec<_> = golden.head.runs().into_iter().filter(|(case, _)| wanted(&name_of(test, case.as_deref()))).collect();
    let results = if settings.accept { model.accept(&runs) } else { model.compare_all(&runs) };
    *kept = model.kept.into_inner();
    results
}

/// Why a file cannot be read.
pub(super) fn said(error: &FileError) -> String {
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
    result.said = lines.take(tell::MOST).map(Said::Words).collect();
    if flaws.len() > tell::MOST + 1 {
        result.said.push(Said::Words(format!("and {} more", flaws.len() - tell::MOST - 1)));
    }
    if accept { result.help("the head is written by hand, and only you can fix it") } else { result }
}

/// A model on its way through its cases.
struct Model<'a> {
    test: &'a Test,
    text: &'a [u8],
    settings: &'a Settings<'a>,
    golden: &'a Golden,
    scratch: Scratch,
    /// What each case takes over from those before.
    kept: RefCell<Kept>,
}

/// One run: what it found and where its files are.
struct Ran {
    found: Found,
    files: copies::Written,
}

impl Model<'_> {
    fn name(&self, case: Option<&str>) -> String {
        name_of(self.test, case)
    }

    /// Where the outputs of a case go, and its stored copies lie.
    fn folder(base: &Path, case: Option<&str>) -> PathBuf {
        case.map_or_else(|| base.to_owned(), |case| base.join(case))
    }

    /// Runs one case; the error says why there is nothing to compare.
    fn run(&self, case: Option<&str>, sets: &[(String, String)]) -> Result<Ran, CaseResult> {
        let name = self.name(case);
        let out = Self::folder(self.scratch.path(), case);
        let cannot =
            |error: std::io::Error| CaseResult::new(&name, Verdict::Unreadable, format!("cannot read {}: {error}", self.test.name));
        let disk = Disk::new(Some(&self.test.script), Some(&out), &[], Outputs::Written).map_err(cannot)?.seen_from_home();
        let file = self.test.script.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let task = Task {
            name: &file,
            text: self.text,
            sets,
            row: None,
            strict: false,
            keep_going: false,
            full: true,
            picture: None,
            clock: self.settings.clock,
        };
        let mut seen = Looks::default();
        let look = &mut |cx: &mut Cx<'_>| seen = looks::of(cx);
        // A bug may leave half of something: then the next case starts from nothing.
        let mut kept = self.kept.take();
        let again = || run::run_again(&task, &disk, self.settings.job, Again { kept: &mut kept, light: false, look });
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
        let found = section::of(&outcome, seen, &hide);
        Ok(Ran { found, files: copies::Written { folder: out, outputs: outcome.report.outputs } })
    }

    fn compare_all(&self, runs: &[Run]) -> Vec<CaseResult> {
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
        let mut said = self.other_maker();
        said.extend(tell::changes(&changes, allowance));
        said.extend(files.iter().map(|file| Said::Words(file.text.clone())));
        let missing = changes.is_empty() && files.iter().all(|file| file.missing);
        let verdict = if missing { Verdict::Missing } else { Verdict::Differs };
        let message = format!("{name} differs from its golden{}", counted(&changes, files.len()));
        CaseResult { said, ..CaseResult::new(name, verdict, message).help(format!("if this is as it should be: {accept}")) }
    }

    /// A golden without any line is one of a model that finds nothing: an empty script.
    fn nothing_expected(&self, case: Option<&str>) -> Option<&Section> {
        static NOTHING: Section = Section { case: None, above: Vec::new(), entries: Vec::new(), below: Vec::new() };
        (case.is_none() && self.golden.sections.is_empty()).then_some(&NOTHING)
    }

    /// What is said first when another program made the golden.
    fn other_maker(&self) -> Vec<Said> {
        let this = Maker::this();
        match &self.golden.head.made_by {
            Some(maker) if *maker != this => {
                let mesher = if maker.mesher == this.mesher { "" } else { "; the mesher has another version, so meshes may differ" };
                vec![Said::Words(format!("made by {}, compared by {}{mesher}", maker.text(), this.text()))]
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

    /// Writes the golden and its stored files anew; what was not run stays as it is.
    fn accept(&self, runs: &[Run]) -> Vec<CaseResult> {
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
        match self.write(golden, (whole, changed), &staging) {
            Ok(true) => results.iter_mut().for_each(|r| r.verdict = Verdict::Accepted),
            Ok(false) => {}
            Err(error) => return vec![CaseResult::new(&self.test.name, Verdict::Unreadable, format!("cannot write {error}"))],
        }
        results
    }

    /// Writes what changed; whether anything did. A golden that would only be signed by another version stays as it is.
    fn write(&self, mut golden: Golden, (whole, mut changed): (bool, bool), staging: &Staging) -> std::io::Result<bool> {
        let old = std::fs::read(&self.test.golden).unwrap_or_default();
        changed |= golden.text().as_bytes() != old.as_slice();
        if changed {
            if whole {
                golden.head.sign();
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

fn counted(changes: &[Change], files: usize) -> String {
    let plural = |n: usize, one: &str| format!("{n} {one}{}", if n == 1 { "" } else { "s" });
    let parts = [(changes.len(), "line"), (files, "file")];
    let parts: Vec<String> = parts.iter().filter(|p| p.0 > 0).map(|p| plural(p.0, p.1)).collect();
    if parts.is_empty() { String::new() } else { format!(" in {}", parts.join(" and ")) }
}
