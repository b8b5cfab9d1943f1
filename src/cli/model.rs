//! What `run` and `check` share: from the options to a report and an exit status.

use std::sync::Arc;
use std::time::Instant;

use super::options::{Options, script_path};
use super::progress::with_progress;
use super::variants::variants;
use super::{Exit, Terminal, cases, interrupt, summary};
use crate::base::job::Job;
use crate::base::limits;
use crate::io::FileError;
use crate::lang::declare::params::TableRow;
use crate::session::cache::Cache;
use crate::session::disk::{Disk, Outputs, read_limited, read_stream, words};
use crate::session::guard::{Bug, guarded};
use crate::session::json::{cases_text, report_text};
use crate::session::kept::Kept;
use crate::session::report::{Case, Cases, VERSION};
use crate::session::run::{self, Again, Outcome, Task};
use crate::session::task::ScriptBytes;

/// One script with all its rows.
pub struct Model<'a> {
    /// As named on the command line.
    pub name: &'a str,
    /// Its bytes.
    pub text: ScriptBytes,
    /// Where it may read and write.
    pub disk: Disk,
}

/// Runs all models of the command line; the worst exit status wins.
pub fn all(options: &Options, outputs: Outputs, terminal: &Terminal) -> Exit {
    let job = interrupt::job();
    let mut models = Vec::new();
    for name in &options.models {
        match open(name, options, outputs) {
            Ok(model) => models.push(model),
            Err(text) => return terminal.wrong_usage(&text),
        }
    }
    let cache = options.cache.as_deref().map(|folder| Arc::new(Cache::new(folder)));
    let several = models.len() > 1;
    let mut cases = Cases { loft: VERSION, cases: Vec::new() };
    let mut worst = Exit::Fine;
    for model in &models {
        let (exit, rows) = match &options.table {
            Some(table) => variants(model, table, cache.as_ref(), options, &job, terminal),
            None => one(model, several, options, cache.as_ref(), &job, terminal),
        };
        complain(cache.as_deref(), options, terminal);
        worst = worst.max(exit);
        cases.cases.extend(rows);
        if exit == Exit::Usage {
            return exit;
        }
        if exit == Exit::Interrupted {
            break;
        }
    }
    if options.table.is_some() && !options.json && !options.quiet {
        let gap = if options.each { "\n" } else { "" };
        terminal.print(&format!("{gap}{}", cases::text(&cases.cases, terminal.color_out)));
    }
    if options.json && worst != Exit::Interrupted && (several || options.table.is_some()) {
        terminal.print_data(&cases_text(&cases));
    }
    worst
}

/// Reads a script; the error is a sentence about the command line.
pub fn open<'a>(name: &'a str, options: &Options, outputs: Outputs) -> Result<Model<'a>, String> {
    let path = script_path(name);
    let cannot = |error: FileError| format!("cannot read {name:?}: {}", words(&error));
    let text = match path {
        Some(path) => read_limited(path, limits::SOURCE_BYTES + 1),
        None => read_stream(std::io::stdin().lock(), limits::SOURCE_BYTES + 1),
    };
    let text = match text {
        // The parser has the words for a script that is too large (E110), and looks at its size only.
        Err(FileError::TooLarge(bytes)) => vec![b'\n'; bytes.min(limits::DATA_BYTES) as usize],
        other => other.map_err(cannot)?,
    };
    let disk = Disk::new(path, options.out.as_deref(), &options.allow, outputs).map_err(|error| error.to_string())?;
    Ok(Model { name, text: text.into(), disk })
}

/// What the runs of one model differ in.
pub struct Variant<'a> {
    /// Where its outputs go.
    pub disk: &'a Disk,
    /// Params with the text of their values.
    pub sets: &'a [(String, String)],
    /// The row of a table that it is of.
    pub row: Option<&'a TableRow>,
}

/// Runs one case; a bug is caught.
pub fn case(model: &Model, variant: Variant, options: &Options, job: &Arc<Job>, kept: Option<&mut Kept>) -> Result<Outcome, Bug> {
    let Variant { disk, sets, row } = variant;
    interrupt::protect(disk.staging());
    let started = Instant::now();
    let clock = move || started.elapsed().as_secs_f64();
    let task = Task {
        name: model.name,
        text: model.text.as_bytes(),
        shared: model.text.shared(),
        sets,
        row,
        strict: options.strict,
        keep_going: options.keep_going,
        full: options.json || options.verbose,
        curves: options.json,
        picture: None,
        clock: &clock,
    };
    guarded(|| match kept {
        Some(kept) => run::run_again(&task, disk, job, Again { kept, light: false, look: &mut |_| {}, shaped: None }),
        None => run::run(&task, disk, job),
    })
}

/// Says that loft has a bug.
pub fn bug(bug: &Bug, model: &Model, terminal: &Terminal) -> Exit {
    let place = interrupt::last_panic_place();
    terminal.eprint(&format!(
        "E999 × a bug in loft: {} ({place})\n  help: nothing was written; please report it with the script ({}), the command line and this text\n",
        bug.what, model.name
    ));
    Exit::Bug
}

/// How the program ends after a run.
pub fn exit_of(outcome: &Outcome) -> Exit {
    if outcome.interrupted {
        Exit::Interrupted
    } else if outcome.bug {
        Exit::Bug
    } else if outcome.report.ok {
        Exit::Fine
    } else {
        Exit::Errors
    }
}

/// Says once that the folder of `--cache` is of no use; the results are the same without it.
fn complain(cache: Option<&Cache>, options: &Options, terminal: &Terminal) {
    if let (Some(why), Some(folder)) = (cache.and_then(Cache::trouble), &options.cache) {
        terminal.eprint(&format!("loft: nothing is kept in {:?} (--cache): {why}\n", folder.to_string_lossy()));
    }
}

fn one(
    model: &Model,
    several: bool,
    options: &Options,
    cache: Option<&Arc<Cache>>,
    job: &Arc<Job>,
    terminal: &Terminal,
) -> (Exit, Vec<Case>) {
    let watched = terminal.watched && !options.json && !options.quiet;
    let mut kept = cache.map(|cache| Kept::on(Some(cache.clone())));
    let own = Variant { disk: &model.disk, sets: &options.sets, row: None };
    let mut outcome = match with_progress(job, watched, || case(model, own, options, job, kept.as_mut())) {
        Ok(outcome) => outcome,
        Err(caught) => return (bug(&caught, model, terminal), Vec::new()),
    };
    show(&outcome, options, terminal);
    if !options.json && !options.quiet {
        terminal.print(&summary::text(&outcome.report, outcome.tolerance, terminal.color_out));
    } else if options.json && !several {
        terminal.print_data(&report_text(&outcome.report));
    }
    if !several {
        // The program ends: the system takes the memory back at once.
        std::mem::forget(std::mem::take(&mut outcome.remains));
    }
    (exit_of(&outcome), vec![Case { case: model.name.to_owned(), set: Vec::new(), report: outcome.report }])
}

/// Diagnostics, how things were found, and timings: all on standard error.
pub fn show(outcome: &Outcome, options: &Options, terminal: &Terminal) {
    terminal.eprint(&outcome.drawn(terminal.color_err, options.verbose));
    if options.verbose {
        outcome.notes.iter().for_each(|line| terminal.eprint(&format!("{line}\n")));
    }
    if options.timings {
        let t = &outcome.report.timings;
        let mut reused = if outcome.reused > 0 { format!("; {} results taken over from before", outcome.reused) } else { String::new() };
        if options.cache.is_some() {
            reused.push_str(&format!("; {} from the cache", outcome.from_cache));
        }
        let (parse, evaluate, mesh, write) = (t.parse, t.evaluate, t.mesh, t.write);
        let line = format!("parse {parse:.3} s, evaluate {evaluate:.3} s, mesh {mesh:.3} s, write {write:.3} s{reused}\n");
        terminal.eprint(&line);
    }
    if outcome.interrupted {
        terminal.eprint("interrupted: nothing was written\n");
    }
}
