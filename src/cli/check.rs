//! `loft check MODEL…`.

use clap::ArgMatches;

use super::options::{self, Options};
use super::{Command, Exit, Terminal, model};
use crate::session::disk::Outputs;

/// Everything but writing files.
pub const COMMAND: Command = Command { name: "check", about: "Evaluate and check models without writing files", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    options::add(command, true)
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    match Options::read(matches) {
        Ok(options) => model::all(&options, Outputs::Counted, terminal),
        Err(text) => terminal.wrong_usage(&text),
    }
}
