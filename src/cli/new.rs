//! `loft new DIR`: a starter model.

use std::path::PathBuf;

use clap::{Arg, ArgMatches, value_parser};

use super::{Command, Exit, Terminal};
use crate::session::starter;

/// Writes a starter model.
pub const COMMAND: Command = Command { name: "new", about: "A starter model in a new folder", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    let folder = Arg::new("folder").value_name("DIR").required(true).value_parser(value_parser!(PathBuf));
    command.arg(folder.help("Folder to make; it must not hold a model of the same name"))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let Some(folder) = matches.get_one::<PathBuf>("folder") else { return Exit::Usage };
    match starter::write(folder) {
        Ok(script) => {
            let script = script.display();
            terminal.print(&format!("wrote {script}\nrun it: loft run {script}\n"));
            Exit::Fine
        }
        Err(error) => {
            terminal.tell(&format!("loft: cannot write a model in {}: {error}\n", folder.display()));
            Exit::Errors
        }
    }
}
