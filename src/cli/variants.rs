//! `--table`: one run of a model for each row.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::model::{Model, Variant, bug, case, exit_of, show};
use super::options::Options;
use super::progress::with_progress;
use super::{Exit, Terminal, summary};
use crate::base::job::Job;
use crate::base::limits;
use crate::session::cache::Cache;
use crate::session::disk::{read_limited, words};
use crate::session::guard::Bug;
use crate::session::kept::Kept;
use crate::session::report::{Case, DiagnosticRow, Report, SetRow, VERSION};
use crate::session::run::Outcome;
use crate::session::variants::{Row, rows};

/// Runs all rows; one that fails does not stop the others, even by a bug.
pub fn variants(
    model: &Model,
    table: &Path,
    cache: Option<&Arc<Cache>>,
    options: &Options,
    job: &Arc<Job>,
    terminal: &Terminal,
) -> (Exit, Vec<Case>) {
    let name = table.display().to_string();
    let rows = match read_limited(table, limits::DATA_BYTES) {
        Ok(bytes) => rows(&name, &bytes, &options.sets),
        Err(error) => return (terminal.wrong_usage(&format!("cannot read {:?}: {}", table.to_string_lossy(), words(&error))), Vec::new()),
    };
    let rows = match rows {
        Ok(rows) => rows,
        Err(text) => return (terminal.wrong_usage(&format!("{name}: {text}")), Vec::new()),
    };
    let (mut worst, mut cases, mut printed) = (Exit::Fine, Vec::new(), BTreeMap::new());
    // Rows differ in few params: what does not depend on those is taken over.
    let mut kept = Kept::on(cache.cloned());
    for row in rows {
        let disk = model.disk.with_subfolder(&row.name);
        let watched = terminal.watched && !options.json && !options.quiet;
        let variant = Variant { disk: &disk, sets: &row.sets, row: Some(&row.at) };
        let run = || case(model, variant, options, job, Some(&mut kept));
        let (exit, report) = match with_progress(job, watched, run) {
            Ok(outcome) => {
                print_row(&outcome, &row, &mut printed, options, terminal);
                if options.each {
                    let summary = summary::text(&outcome.report, outcome.tolerance, terminal.color_out);
                    terminal.print(&format!("{}case {}\n{summary}", if cases.is_empty() { "" } else { "\n" }, row.name));
                }
                (exit_of(&outcome), outcome.report)
            }
            Err(caught) => {
                terminal.eprint(&heading(&row));
                (bug(&caught, model, terminal), of_bug(&caught, model))
            }
        };
        worst = worst.max(exit);
        let set = row.at.cells.iter().filter_map(|cell| row.sets.iter().find(|set| set.0 == cell.name));
        let set = set.map(|(name, value)| SetRow { name: name.clone(), value: value.clone() }).collect();
        cases.push(Case { case: row.name, set, report });
        if worst == Exit::Interrupted {
            break;
        }
    }
    (worst, cases)
}

/// Which row is spoken of: its name, place and params.
fn heading(row: &Row) -> String {
    let value = |name: &str| row.sets.iter().find(|set| set.0 == name).map_or("", |set| set.1.as_str());
    let params: Vec<String> = row.at.cells.iter().map(|cell| format!("{} = {}", cell.name, value(&cell.name))).collect();
    let params = if params.is_empty() { String::new() } else { format!(": {}", params.join(", ")) };
    format!("case {} (row {} of {}{params})\n", row.name, row.at.number, row.at.file)
}

/// What a row has to say, on standard error under its name; what an earlier one said in the same words is not repeated.
fn print_row(outcome: &Outcome, row: &Row, printed: &mut BTreeMap<String, String>, options: &Options, terminal: &Terminal) {
    let drawn = outcome.drawn(false, options.verbose);
    if drawn.is_empty() && !options.verbose && !options.timings && !outcome.interrupted {
        return;
    }
    terminal.eprint(&heading(row));
    match printed.get(&drawn).filter(|_| !drawn.is_empty() && !options.verbose && !options.timings && !outcome.interrupted) {
        Some(before) => terminal.eprint(&format!("  the same as in case {before}\n")),
        None => show(outcome, options, terminal),
    }
    printed.entry(drawn).or_insert_with(|| row.name.clone());
}

/// The report of a row that ended in a bug.
fn of_bug(bug: &Bug, model: &Model) -> Report {
    let said = DiagnosticRow {
        code: "E999",
        severity: "error",
        message: format!("a bug in loft: {}", bug.what),
        count: 1,
        ..DiagnosticRow::default()
    };
    Report { loft: VERSION, model: model.name.to_owned(), diagnostics: vec![said], ..Report::default() }
}
