//! `loft new DIR`: a starter model with a golden test.

use std::path::PathBuf;
use std::time::Instant;

use clap::{Arg, ArgMatches, value_parser};

use super::{Command, Exit, Terminal, interrupt};
use crate::session::starter;

/// Writes a starter model.
pub const COMMAND: Command = Command { name: "new", about: "A starter model with a golden test in a new folder", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    let folder = Arg::new("folder").value_name("DIR").required(true).value_parser(value_parser!(PathBuf));
    command.arg(folder.help("Folder to make; it must not hold a model of the same name"))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let Some(folder) = matches.get_one::<PathBuf>("folder") else { return Exit::Usage };
    let (started, job) = (Instant::now(), interrupt::job());
    let clock = move || started.elapsed().as_secs_f64();
    let written = starter::write(folder).and_then(|script| {
        let golden = starter::write_golden(&script, &clock, &job).map_err(std::io::Error::other)?;
        Ok((script, golden))
    });
    match written {
        Ok((script, golden)) => {
            let (script, golden) = (script.display(), golden.display());
            terminal
                .print(&format!("wrote {script}\nwrote {golden}\nrun it:  loft run {script}\ntest it: loft test {}\n", folder.display()));
            Exit::Fine
        }
        Err(error) => {
            terminal.eprint(&format!("loft: cannot write a model in {}: {error}\n", folder.display()));
            Exit::Errors
        }
    }
}
