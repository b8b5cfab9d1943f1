//! `loft doc [NAME]`.

use clap::{Arg, ArgAction, ArgMatches};

use super::{Command, Exit, Terminal};
use crate::session::{reference, textmate};

/// Prints the reference of the language.
pub const COMMAND: Command = Command { name: "doc", about: "The reference of the language", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    let markdown = Arg::new("markdown").long("markdown").action(ArgAction::SetTrue).conflicts_with("name");
    let textmate = Arg::new("textmate").long("textmate").action(ArgAction::SetTrue).conflicts_with_all(["name", "markdown"]).hide(true);
    command
        .arg(textmate)
        .arg(Arg::new("name").value_name("NAME").help("A word of the language; without one, all words in a line each"))
        .arg(markdown.help("The whole reference as a Markdown page"))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    match matches.get_one::<String>("name") {
        None if matches.get_flag("textmate") => terminal.print(&textmate::grammar()),
        None if matches.get_flag("markdown") => terminal.print(&reference::manual()),
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
