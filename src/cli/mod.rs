//! Floor 9: the commands; the only place with stdout, exit codes, arguments, the clock and the number of threads.

mod cases;
mod check;
mod completions;
mod diff;
mod doc;
mod examples;
mod explain;
mod fmt;
mod interrupt;
mod lsp;
mod man;
mod model;
mod new;
mod options;
mod progress;
mod render;
pub mod repl;
mod rewrite;
mod run;
mod summary;
mod terminal;
mod test;
mod variants;
pub mod view;

use std::process::ExitCode;

use clap::ArgMatches;

use terminal::Terminal;

/// One subcommand.
pub struct Command {
    /// The word on the command line.
    name: &'static str,
    /// One line for the list of commands.
    about: &'static str,
    /// Adds its arguments.
    arguments: fn(clap::Command) -> clap::Command,
    /// Does it; gives the exit status.
    run: fn(&ArgMatches, &Terminal) -> Exit,
}

/// All subcommands, in the order of the help.
const COMMANDS: &[Command] = &[
    run::COMMAND,
    check::COMMAND,
    repl::COMMAND,
    view::command::COMMAND,
    lsp::COMMAND,
    render::COMMAND,
    test::COMMAND,
    diff::COMMAND,
    new::COMMAND,
    fmt::COMMAND,
    explain::COMMAND,
    doc::COMMAND,
    completions::COMMAND,
    man::COMMAND,
];

/// How the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// All is well.
    Fine = 0,
    /// The model has errors or failed checks.
    Errors = 1,
    /// The command line is wrong.
    Usage = 2,
    /// A bug in loft, caught.
    Bug = 3,
    /// Stopped by Ctrl-C.
    Interrupted = 130,
    /// All is well, but the reader of standard output is gone: the status of a process ended by SIGPIPE.
    ClosedPipe = 141,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// The command line as clap knows it: options for all, then the subcommands.
fn command_line() -> clap::Command {
    let color = clap::Arg::new("color")
        .long("color")
        .global(true)
        .value_name("WHEN")
        .value_parser(["auto", "always", "never"])
        .default_value("auto")
        .help("Colours in what is printed");
    let root = clap::Command::new("loft")
        .version(env!("CARGO_PKG_VERSION"))
        .about("Curves, networks, surfaces and meshes from a short text file")
        .after_help("Exit status: 0 fine, 1 errors or failed checks, 2 wrong usage, 3 a bug in loft, 130 interrupted.")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .arg(color);
    let subcommand = |c: &Command| {
        let made = (c.arguments)(clap::Command::new(c.name).about(c.about));
        // What a command says behind its options stays, the examples come first.
        let after = made.get_after_help().map(|text| format!("\n\n{text}")).unwrap_or_default();
        if examples::of(c.name).is_empty() { made } else { made.after_help(format!("{}{after}", examples::text(c.name))) }
    };
    COMMANDS.iter().fold(root, |root, c| root.subcommand(subcommand(c)))
}

/// Runs the program.
pub fn main() -> ExitCode {
    let matches = match command_line().try_get_matches() {
        Ok(matches) => matches,
        Err(error) => {
            // Help and version come this way as well.
            let printed = error.print();
            if error.use_stderr() {
                return Exit::Usage.into();
            }
            terminal::lose(printed);
            return Terminal::new("auto").end(Exit::Fine).into();
        }
    };
    let terminal = Terminal::new(matches.get_one::<String>("color").map_or("auto", String::as_str));
    interrupt::keep_panics_quiet();
    let Some((name, arguments)) = matches.subcommand() else { return Exit::Usage.into() };
    match COMMANDS.iter().find(|c| c.name == name) {
        Some(command) => terminal.end((command.run)(arguments, &terminal)).into(),
        None => Exit::Usage.into(),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_is_sound() {
        super::command_line().debug_assert();
    }
}
