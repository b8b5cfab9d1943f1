//! Commands of later versions: known words with an honest answer.

use super::{Command, Exit};

const fn later(name: &'static str, about: &'static str) -> Command {
    Command { name, about, arguments: anything, run }
}

/// Words that answer "not in this version".
pub const COMMANDS: &[Command] = &[later("view", "Live page in the browser (not in this version)")];

fn anything(command: clap::Command) -> clap::Command {
    let rest = clap::Arg::new("rest").num_args(0..).trailing_var_arg(true).allow_hyphen_values(true).hide(true);
    command.hide(true).disable_help_flag(true).arg(rest)
}

fn run(arguments: &clap::ArgMatches, terminal: &super::Terminal) -> Exit {
    let _ = arguments;
    terminal.wrong_usage("this command is not in this version; `loft help` lists what is")
}
