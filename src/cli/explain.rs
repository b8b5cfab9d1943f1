//! `loft explain CODE` and `loft explain MODEL NAME`.

use clap::{Arg, ArgMatches};

use super::{Command, Exit, Terminal};

/// The long form of a diagnostic.
pub const COMMAND: Command =
    Command { name: "explain", about: "What a diagnostic means, or how a name of a model came about", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    command.arg(
        Arg::new("what")
            .value_name("CODE | WORD | MODEL NAME")
            .required(true)
            .num_args(1..=2)
            .help("A code, for example E501, or a word of the language; or a script and a name or expression of it"),
    )
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let what: Vec<&String> = matches.get_many("what").into_iter().flatten().collect();
    let code = match what.as_slice() {
        [model, name] => return explain_name(model, name, terminal),
        what => what[0],
    };
    super::doc::word(code, terminal)
}

/// How a name of a model came about.
fn explain_name(model: &str, name: &str, terminal: &Terminal) -> Exit {
    match super::repl::opened(model, terminal) {
        Ok(mut notebook) => {
            let answer = notebook.explain(name);
            terminal.print(&super::repl::text_of(&answer, terminal.color_out));
            if answer.failed { Exit::Errors } else { Exit::Fine }
        }
        Err(exit) => exit,
    }
}
