//! `loft completions SHELL`.

use clap::{Arg, ArgMatches, value_parser};
use clap_complete::Shell;

use super::{Command, Exit, Terminal};

/// Prints a completion script.
pub const COMMAND: Command = Command { name: "completions", about: "Completions for a shell", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    command.arg(Arg::new("shell").value_name("SHELL").required(true).value_parser(value_parser!(Shell)).help("Which shell"))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let Some(shell) = matches.get_one::<Shell>("shell") else { return Exit::Usage };
    let mut script = Vec::new();
    clap_complete::generate(*shell, &mut super::command_line(), "loft", &mut script);
    terminal.print_data(&String::from_utf8_lossy(&script));
    Exit::Fine
}
