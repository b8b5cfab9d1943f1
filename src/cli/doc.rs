//! `loft doc [NAME]`.

use clap::{Arg, ArgMatches};

use super::{Command, Exit, Terminal};
use crate::session::reference;

/// Prints the reference of the language.
pub const COMMAND: Command = Command { name: "doc", about: "The reference of the language", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    command.arg(Arg::new("name").value_name("NAME").help("A word of the language; without one, all words in a line each"))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    match matches.get_one::<String>("name") {
        None => terminal.print(&reference::overview()),
        Some(name) => match reference::entry(name) {
            Ok(text) => terminal.print(&text),
            Err(similar) => {
                let hint = if similar.is_empty() { String::new() } else { format!("; did you mean {}?", similar.join(" or ")) };
                return terminal.wrong_usage(&format!("no word of the language is called `{name}`{hint}"));
            }
        },
    }
    Exit::Fine
}
