//! `loft test [PATH]…`: golden tests of the user's own models.

use std::path::PathBuf;
use std::time::Instant;

use clap::{Arg, ArgAction, ArgMatches, value_parser};

use super::{Command, Exit, Terminal, interrupt, options};
use crate::session::golden::{self, CaseResult, Settings, Test, Verdict};
use crate::session::staging::Staging;

/// Compares models with their goldens.
pub const COMMAND: Command = Command { name: "test", about: "Golden tests of your own models", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    let flag = |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    let jobs = Arg::new("jobs").long("jobs").value_name("N").value_parser(value_parser!(u16).range(1..));
    let junit = Arg::new("junit").long("junit").value_name("FILE").value_parser(value_parser!(PathBuf));
    command
        .arg(
            Arg::new("path")
                .value_name("PATH")
                .num_args(0..)
                .default_value(".")
                .value_parser(value_parser!(PathBuf))
                .help("Folders with models, scripts or goldens"),
        )
        .arg(flag("accept", "Writes the goldens anew; for a named script that has none, makes one"))
        .arg(Arg::new("filter").long("filter").value_name("S").help("Only what has S in its name, `roof.loft [long]`"))
        .arg(jobs.help("How many models run at the same time [default: one per core]"))
        .arg(flag("list", "Prints the names and runs nothing"))
        .arg(junit.help("Also writes the results as JUnit XML"))
        .args([options::most_elements(), options::most_work()])
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let paths: Vec<PathBuf> = matches.get_many::<PathBuf>("path").into_iter().flatten().cloned().collect();
    let tests = match golden::discover(&paths) {
        Ok(tests) => tests,
        Err(text) => return terminal.wrong_usage(&text),
    };
    let filter = matches.get_one::<String>("filter").map(String::as_str);
    if matches.get_flag("list") {
        let names = tests.iter().flat_map(golden::names).filter(|name| filter.is_none_or(|f| name.contains(f)));
        terminal.print(&names.map(|name| format!("{name}\n")).collect::<String>());
        return Exit::Fine;
    }
    options::read_limits(matches);
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let jobs = matches.get_one::<u16>("jobs").map_or_else(cores, |n| usize::from(*n));
    let (started, job) = (Instant::now(), interrupt::job());
    let clock = move || started.elapsed().as_secs_f64();
    let settings = Settings { accept: matches.get_flag("accept"), filter, jobs, clock: &clock, job: &job };
    let results = all(&tests, &settings, terminal);
    if results.is_empty() && job.go_on().is_ok() {
        let where_ = paths.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ");
        return terminal.wrong_usage(&match filter {
            Some(filter) if !tests.is_empty() => format!("no golden test below {where_} has {filter:?} in its name"),
            _ => format!("there is no golden test below {where_}; `loft test --accept model.loft` makes one"),
        });
    }
    terminal.print(&format!("\n{}\n", counted(&results)));
    let mut exit = if job.go_on().is_err() { Exit::Interrupted } else { exit_of(&results) };
    if let Some(path) = matches.get_one::<PathBuf>("junit") {
        let text = golden::junit_text(&results);
        let staging = Staging::default();
        if let Err(error) = staging.write(path, &mut |out| out.write_all(text.as_bytes())).and_then(|_| staging.commit()) {
            terminal.eprint(&format!("loft: cannot write {}: {error}\n", path.display()));
            exit = exit.max(Exit::Errors);
        }
    }
    exit
}

fn all(tests: &[Test], settings: &Settings, terminal: &Terminal) -> Vec<CaseResult> {
    let mut results = Vec::new();
    golden::run_all(tests, settings, &mut |cases| {
        cases.iter().for_each(|case| terminal.print(&shown(case, terminal.color_out)));
        results.extend_from_slice(cases);
    });
    results
}

/// A result as text: its verdict, and what differs.
fn shown(case: &CaseResult, color: bool) -> String {
    let paint = |code: &str, text: &str| if color { format!("\u{1b}[{code}m{text}\u{1b}[0m") } else { text.to_owned() };
    let code = match case.verdict {
        Verdict::Passed => "32",
        Verdict::Accepted => "33",
        _ => "31",
    };
    let mut out = format!("{}  {}\n", paint(code, &format!("{:<10}", case.verdict.word())), case.name);
    if case.verdict.is_good() {
        return out;
    }
    out.push_str(&format!("{} {}\n", paint("31", "E902 ×"), case.message));
    case.lines.iter().for_each(|line| out.push_str(&format!("{}\n", line.text(color))));
    if let Some(help) = &case.help {
        out.push_str(&format!("  {} {help}\n", paint("36", "help:")));
    }
    out
}

/// `24 ok, 1 differs`.
fn counted(results: &[CaseResult]) -> String {
    let mut verdicts: Vec<Verdict> = results.iter().map(|r| r.verdict).collect();
    verdicts.sort_unstable();
    let counts = verdicts.chunk_by(|a, b| a == b).filter_map(|same| Some(format!("{} {}", same.len(), same.first()?.word())));
    counts.collect::<Vec<_>>().join(", ")
}

fn exit_of(results: &[CaseResult]) -> Exit {
    match results.iter().map(|r| r.verdict).max() {
        Some(Verdict::Interrupted) => Exit::Interrupted,
        Some(Verdict::Bug) => Exit::Bug,
        Some(verdict) if !verdict.is_good() => Exit::Errors,
        _ => Exit::Fine,
    }
}
