//! `loft diff A B`: what changed between two models or two goldens.

use std::path::PathBuf;
use std::time::Instant;

use clap::{Arg, ArgMatches, value_parser};

use super::{Command, Exit, Terminal, interrupt, options};
use crate::session::golden::{Difference, NoDiff, diff};

/// Compares two models or goldens.
pub const COMMAND: Command = Command { name: "diff", about: "What changed between two models or goldens", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    let file = |name: &'static str, value: &'static str, help: &'static str| {
        Arg::new(name).value_name(value).required(true).value_parser(value_parser!(PathBuf)).help(help)
    };
    command
        .arg(file("old", "A", "A script or a golden"))
        .arg(file("new", "B", "The other one"))
        .args([options::most_elements(), options::most_work()])
        .after_help("Exit status: 0 no difference, 1 they differ, 2 wrong usage.")
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let (Some(old), Some(new)) = (matches.get_one::<PathBuf>("old"), matches.get_one::<PathBuf>("new")) else { return Exit::Usage };
    options::read_limits(matches);
    let (started, job) = (Instant::now(), interrupt::job());
    let clock = move || started.elapsed().as_secs_f64();
    match diff(old, new, &clock, &job) {
        Ok(found) if found.is_empty() => {
            terminal.print("no difference\n");
            Exit::Fine
        }
        Ok(found) => {
            terminal.print(&format!("  - {}\n  + {}\n", old.display(), new.display()));
            found.iter().for_each(|difference| terminal.print(&shown(difference, terminal.color_out)));
            Exit::Errors
        }
        Err(NoDiff::Unreadable(text)) => terminal.wrong_usage(&format!("cannot compare {text}")),
        Err(NoDiff::Interrupted) => Exit::Interrupted,
        Err(NoDiff::Bug(bug)) => {
            let place = interrupt::last_panic_place();
            terminal
                .eprint(&format!("E999 × a bug in loft: {} ({place})\n  help: please report it with both files and this text\n", bug.what));
            Exit::Bug
        }
    }
}

fn shown(difference: &Difference, color: bool) -> String {
    let head = difference.case.as_ref().map_or("\n".to_owned(), |case| format!("\n[{case}]\n"));
    difference.lines.iter().fold(head, |text, line| text + &line.text(color) + "\n")
}
