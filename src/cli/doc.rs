//! `loft doc [NAME]`.

use clap::{Arg, ArgAction, ArgMatches};

use super::{Command, Exit, Terminal};
use crate::session::{lookup, reference, textmate};

/// Prints the reference of the language.
pub const COMMAND: Command = Command { name: "doc", about: "The reference of the language", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    let markdown = Arg::new("markdown").long("markdown").action(ArgAction::SetTrue).conflicts_with("name");
    let textmate = Arg::new("textmate").long("textmate").action(ArgAction::SetTrue).conflicts_with_all(["name", "markdown"]).hide(true);
    command
        .arg(textmate)
        .arg(Arg::new("name").value_name("NAME").help("A word of the language or a code; without one, all words in a line each"))
        .arg(markdown.help("The whole reference as a Markdown page"))
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    match matches.get_one::<String>("name") {
        None if matches.get_flag("textmate") => terminal.print_data(&textmate::grammar()),
        None if matches.get_flag("markdown") => terminal.print_data(&reference::manual()),
        None => terminal.print(&reference::overview()),
        Some(name) => return word(name, terminal),
    }
    Exit::Fine
}

/// Prints what is known of a word or a code; also for `loft explain`.
pub fn word(name: &str, terminal: &Terminal) -> Exit {
    match lookup::entry(name) {
        Ok(text) => {
            terminal.print(&text);
            Exit::Fine
        }
        Err(similar) => {
            let hint = if similar.is_empty() { String::new() } else { format!("; did you mean {}?", similar.join(" or ")) };
            let is_code = matches!(name.as_bytes(), [b'e' | b'w' | b'n' | b'E' | b'W' | b'N', digits @ ..] if digits.iter().all(u8::is_ascii_digit) && !digits.is_empty());
            let text = if is_code {
                format!("there is no code {}", name.to_uppercase())
            } else {
                format!("no word of the language is called `{name}`")
            };
            terminal.wrong_usage(&format!("{text}{hint}"))
        }
    }
}
