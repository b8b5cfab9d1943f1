//! `loft explain CODE`.

use clap::{Arg, ArgMatches};

use super::{Command, Exit, Terminal};

/// The long form of a diagnostic.
pub const COMMAND: Command = Command { name: "explain", about: "What a diagnostic means and how to mend it", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    command.arg(Arg::new("what").value_name("CODE").required(true).num_args(1..=2).help("A code, for example E501"))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let what: Vec<&String> = matches.get_many("what").into_iter().flatten().collect();
    terminal.wrong_usage(&format!("there is no code {what:?}"))
}
