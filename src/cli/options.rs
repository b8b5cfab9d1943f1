//! Options that `run` and `check` share.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches, value_parser};

use super::interrupt;
use crate::base::limits::{MESH_ELEMENTS, MESH_ELEMENTS_MOST};

/// What was asked for on the command line of a model.
#[derive(Default)]
pub struct Options {
    /// Scripts; `-` is standard input.
    pub models: Vec<String>,
    /// Folder for outputs; the script's by default.
    pub out: Option<PathBuf>,
    /// `--set name=value`, in order.
    pub sets: Vec<(String, String)>,
    /// Table of variants.
    pub table: Option<PathBuf>,
    /// Folder where results are kept between runs.
    pub cache: Option<PathBuf>,
    /// Warnings are errors.
    pub strict: bool,
    /// Seconds of each phase are shown.
    pub timings: bool,
    /// The report as JSON on standard output.
    pub json: bool,
    /// How things were found: flows, methods, counts, notes.
    pub verbose: bool,
    /// Nothing on standard output; errors are printed all the same.
    pub quiet: bool,
    /// The whole summary of each row of a table, not only its line.
    pub each: bool,
    /// Further places that may be read.
    pub allow: Vec<PathBuf>,
    /// What is sound is written although something failed.
    pub keep_going: bool,
}

/// Adds the options of a model to a subcommand.
pub fn add(command: clap::Command, several: bool) -> clap::Command {
    let model = Arg::new("model").value_name("MODEL").required(true).help("A script, `-` for standard input");
    let flag = |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    let path = |name: &'static str, value: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name(value).value_parser(value_parser!(PathBuf)).help(help)
    };
    let command = command
        .arg(if several { model.num_args(1..) } else { model })
        .arg(path("out", "DIR", "Folder for outputs [default: the script's]").short('o'))
        .arg(path("table", "FILE.csv", "One run for each row; the header names params"))
        .arg(path("cache", "DIR", "Keeps meshes there from run to run; made when it does not exist"))
        .arg(flag("each", "With --table: prints the whole summary of each row as well").requires("table").conflicts_with("json"))
        .arg(flag("json", "Prints the report as JSON"))
        .arg(flag("quiet", "Prints nothing but errors and warnings").short('q').conflicts_with_all(["json", "verbose", "each", "timings"]))
        .arg(flag("keep-going", "Writes what could be made although something failed"));
    add_shared(command)
}

/// Adds the options of everything that evaluates a script and prints what it found.
pub fn add_shared(command: clap::Command) -> clap::Command {
    let flag = |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    add_inputs(command)
        .arg(flag("strict", "Warnings count as errors"))
        .arg(flag("timings", "Shows the seconds of each phase"))
        .arg(flag("verbose", "Shows how things were found: flows, methods, counts, notes").short('v'))
}

/// Adds the options of everything that evaluates a script.
pub fn add_inputs(command: clap::Command) -> clap::Command {
    command
        .arg(
            Arg::new("set")
                .long("set")
                .value_name("NAME=VALUE")
                .action(ArgAction::Append)
                .value_parser(assignment)
                .help("Gives a param another value"),
        )
        .arg(
            Arg::new("threads")
                .long("threads")
                .value_name("N")
                .value_parser(value_parser!(u16).range(1..))
                .help("How many threads may work [default: one per core]; results do not depend on it"),
        )
        .args([most_elements(), most_work()])
        .arg(
            Arg::new("allow")
                .long("allow")
                .value_name("PATH")
                .value_parser(value_parser!(PathBuf))
                .action(ArgAction::Append)
                .help("A further place that imports and modules may be read from"),
        )
}

/// The limit on meshes of whatever runs a model.
pub fn most_elements() -> Arg {
    let most = Arg::new("max-elements").long("max-elements").value_name("N");
    let most = most.value_parser(value_parser!(u64).range(1..=MESH_ELEMENTS_MOST));
    most.help(format!("Elements that a mesh may have before it is refused (E217) [default: {MESH_ELEMENTS}]"))
}

/// The limit on the work of whatever runs a model.
pub fn most_work() -> Arg {
    let most = Arg::new("max-work").long("max-work").value_name("N").value_parser(value_parser!(u64).range(1..));
    most.help("Evaluations of curves and surfaces that a run may take before it is ended (E217) [default: as many as its parts may]")
}

/// Sets the limits of all runs of this command.
pub fn read_limits(matches: &ArgMatches) {
    let limit = |name| matches.get_one::<u64>(name).copied();
    interrupt::set_limits(limit("max-elements"), limit("max-work"));
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => Ok((name.trim().to_owned(), value.trim().to_owned())),
        _ => Err("expected NAME=VALUE, for example span=50m".to_owned()),
    }
}

impl Options {
    /// Reads them; the error is a sentence about the command line.
    pub fn read(matches: &ArgMatches) -> Result<Self, String> {
        Ok(Self {
            out: matches.get_one::<PathBuf>("out").cloned(),
            table: matches.get_one::<PathBuf>("table").cloned(),
            cache: matches.get_one::<PathBuf>("cache").cloned(),
            json: matches.get_flag("json"),
            quiet: matches.get_flag("quiet"),
            each: matches.get_flag("each"),
            keep_going: matches.get_flag("keep-going"),
            ..Self::read_shared(matches)?
        })
    }

    /// Reads those of [`add_shared`]; outputs go to the folder that holds `--out`.
    pub fn read_shared(matches: &ArgMatches) -> Result<Self, String> {
        let folder = |file: &PathBuf| file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        Ok(Self {
            out: matches.get_one::<PathBuf>("out").map(folder),
            strict: matches.get_flag("strict"),
            timings: matches.get_flag("timings"),
            verbose: matches.get_flag("verbose"),
            ..Self::read_inputs(matches)?
        })
    }

    /// Reads those of [`add_inputs`].
    pub fn read_inputs(matches: &ArgMatches) -> Result<Self, String> {
        let options = Self {
            models: matches.get_many::<String>("model").into_iter().flatten().cloned().collect(),
            sets: matches.get_many::<(String, String)>("set").into_iter().flatten().cloned().collect(),
            allow: matches.get_many::<PathBuf>("allow").into_iter().flatten().cloned().collect(),
            ..Self::default()
        };
        if let Some((name, _)) =
            options.sets.iter().enumerate().find(|(i, s)| options.sets[..*i].iter().any(|o| o.0 == s.0)).map(|(_, s)| s)
        {
            return Err(format!("`--set {name}` is given twice"));
        }
        read_limits(matches);
        crate::base::par::set_threads(matches.get_one::<u16>("threads").map_or(0, |n| usize::from(*n)));
        Ok(options)
    }
}

/// The script on disk, or `None` for standard input.
pub fn script_path(model: &str) -> Option<&Path> {
    (model != "-").then(|| Path::new(model))
}
