//! `loft explain CODE`.

use clap::{Arg, ArgMatches};

use super::{Command, Exit, Terminal};
use crate::lang::codes;

/// The long form of a diagnostic.
pub const COMMAND: Command = Command { name: "explain", about: "What a diagnostic means and how to mend it", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    command.arg(Arg::new("what").value_name("CODE").required(true).num_args(1..=2).help("A code, for example E501"))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let what: Vec<&String> = matches.get_many("what").into_iter().flatten().collect();
    let [code] = what.as_slice() else {
        return terminal.wrong_usage("explaining a name of a model is not in this version");
    };
    let wanted = code.to_uppercase();
    if let Some(page) = codes::explain(&wanted) {
        terminal.print(&format!("{}\n", page.trim_end()));
        return Exit::Fine;
    }
    // The same number under another letter is what was meant.
    let number = wanted.trim_start_matches(|c: char| !c.is_ascii_digit());
    match codes::CODES.iter().find(|info| !number.is_empty() && &info.code[1..] == number) {
        Some(info) => terminal.wrong_usage(&format!("there is no code {wanted}; did you mean {}?", info.code)),
        None => terminal.wrong_usage(&format!("there is no code {wanted}")),
    }
}
