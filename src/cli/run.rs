//! `loft run MODEL`.

use clap::ArgMatches;

use super::options::{self, Options};
use super::{Command, Exit, Terminal, model};
use crate::session::disk::Outputs;

/// Evaluates, checks, reports and writes.
pub const COMMAND: Command = Command { name: "run", about: "Evaluate a model, check it and write its files", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    options::add(command, false)
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    match Options::read(matches) {
        Ok(options) => model::all(&options, Outputs::Written, terminal),
        Err(text) => terminal.wrong_usage(&text),
    }
}
