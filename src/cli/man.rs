//! `loft man`: the manual page, from what clap knows of the command line.

use clap::ArgMatches;

use super::{Command, Exit, Terminal, examples};

/// Prints the manual page as roff.
pub const COMMAND: Command = Command { name: "man", about: "The manual page of loft, as roff", arguments, run };

/// What the page says of how the program ends.
const STATUS: &[(&str, &str)] = &[
    ("0", "no error; warnings do not change it unless --strict makes them errors"),
    ("1", "the model has errors or failed checks, goldens differ, or a file could not be written"),
    ("2", "wrong usage"),
    ("3", "a bug in loft, caught"),
    ("130", "stopped by Ctrl-C"),
    ("141", "standard output was closed"),
];

fn arguments(command: clap::Command) -> clap::Command {
    command.hide(true)
}

fn run(_: &ArgMatches, terminal: &Terminal) -> Exit {
    terminal.print_data(&page());
    Exit::Fine
}

/// The page.
fn page() -> String {
    let mut root = super::command_line();
    root.build();
    let about = root.get_about().map(ToString::to_string).unwrap_or_default();
    let mut out = format!(".TH LOFT 1 \"\" \"loft {}\" \"User Commands\"\n", env!("CARGO_PKG_VERSION"));
    out.push_str(&format!(".SH NAME\nloft \\- {}\n", escaped(&about)));
    out.push_str(".SH SYNOPSIS\n.B loft\n.I COMMAND\n[\\fIOPTIONS\\fR]\n.SH OPTIONS\n");
    root.get_arguments().for_each(|arg| out.push_str(&argument(arg)));
    out.push_str(".SH COMMANDS\n");
    for command in root.get_subcommands().filter(|c| !c.is_hide_set() && c.get_name() != "help") {
        out.push_str(&section(command));
    }
    out.push_str(".SH EXIT STATUS\n");
    STATUS.iter().for_each(|(code, what)| out.push_str(&format!(".TP\n.B {code}\n{}\n", escaped(what))));
    out.push_str(".SH SEE ALSO\n\\fBloft doc\\fR describes the words of the language, \\fBloft explain\\fR the codes of its reports.\n");
    out
}

/// A command with its arguments and examples.
fn section(command: &clap::Command) -> String {
    let mut command = command.clone();
    let usage = command.render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ").split_whitespace().collect::<Vec<_>>().join(" ");
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    let mut out = format!(".SS {}\n{}.\n", escaped(&usage), escaped(&about));
    let own = |arg: &&clap::Arg| !arg.is_hide_set() && !arg.is_global_set() && arg.get_id() != "help";
    command.get_arguments().filter(own).for_each(|arg| out.push_str(&argument(arg)));
    for (line, what) in examples::of(command.get_name()) {
        out.push_str(&format!(".PP\n{}:\n.RS 4\n.nf\n{}\n.fi\n.RE\n", escaped(what), escaped(line)));
    }
    out
}

/// An option or a word of the command line.
fn argument(arg: &clap::Arg) -> String {
    let values: Vec<String> = arg.get_value_names().unwrap_or_default().iter().map(ToString::to_string).collect();
    let takes = arg.get_action().takes_values();
    let value = if takes && !values.is_empty() { format!(" \\fI{}\\fR", escaped(&values.join(" "))) } else { String::new() };
    let names: Vec<String> = [arg.get_short().map(|c| format!("-{c}")), arg.get_long().map(|name| format!("--{name}"))]
        .into_iter()
        .flatten()
        .map(|name| format!("\\fB{}\\fR", escaped(&name)))
        .collect();
    let head = if names.is_empty() { value.trim_start().to_owned() } else { format!("{}{value}", names.join(", ")) };
    let mut help = arg.get_help().map(ToString::to_string).unwrap_or_default().replace('\n', " ");
    let words: Vec<String> = arg.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    if takes && !words.is_empty() {
        help.push_str(&format!(" [words: {}]", words.join(", ")));
    }
    format!(".TP\n{head}\n{}\n", escaped(&help))
}

/// A text without what roff would take for its own.
fn escaped(text: &str) -> String {
    let plain = text.replace('\\', "\\e").replace('-', "\\-").replace('—', "\\(em").replace('×', "x");
    if plain.starts_with(['.', '\'']) { format!("\\&{plain}") } else { plain }
}
