//! `loft view MODEL`: from the command line to a server, or to one file.

use std::path::{Path, PathBuf};
use std::process::{Command as Program, Stdio};
use std::sync::Arc;

use clap::{Arg, ArgAction, ArgMatches, value_parser};

use super::one_file;
use super::script_file::ScriptFile;
use super::server::{Server, Settings};
use super::shown_model::ShownModel;
use crate::cli::options::{self, Options};
use crate::cli::{Command, Exit, Terminal, interrupt};
use crate::session::disk::write_whole;

/// The page, with its scripts and styles inside.
pub const PAGE: &str = include_str!("page.html");

/// A page in the browser that follows the script.
pub const COMMAND: Command = Command { name: "view", about: "Show a model in the browser, and follow its script", arguments, run };

fn arguments(command: clap::Command) -> clap::Command {
    let command = command
        .arg(Arg::new("model").value_name("MODEL").required(true).help("A script"))
        .arg(
            Arg::new("port")
                .long("port")
                .value_name("N")
                .value_parser(value_parser!(u16))
                .help("Port of the page on this machine, 0 for any that is free [default: 7357, or the next that is free]"),
        )
        .arg(Arg::new("no-open").long("no-open").action(ArgAction::SetTrue).help("Prints the address and opens no browser"))
        .arg(
            Arg::new("html")
                .long("html")
                .value_name("FILE")
                .value_parser(value_parser!(PathBuf))
                .conflicts_with_all(["port", "no-open"])
                .help("Writes the page with the model inside into one file, and ends"),
        );
    options::add_inputs(command)
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let options = match Options::read_inputs(matches) {
        Ok(options) => options,
        Err(text) => return terminal.wrong_usage(&text),
    };
    let Some(name) = options.models.first().filter(|name| *name != "-") else {
        return terminal.wrong_usage("a page follows a file; standard input is none");
    };
    let script = Path::new(name);
    if !script.is_file() {
        return terminal.wrong_usage(&format!("cannot read {name:?}: there is no such file"));
    }
    let shown = script.file_name().map_or(name.clone(), |file| file.to_string_lossy().into_owned());
    let model = ShownModel::new(&shown, script, &options.allow, &options.sets);
    match matches.get_one::<PathBuf>("html") {
        Some(file) => write_file(model, script, file, terminal),
        None => serve(model, script, options.sets, matches, terminal),
    }
}

/// Serves the page until Ctrl-C.
fn serve(model: ShownModel, script: &Path, sets: Vec<(String, String)>, matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let settings = Settings {
        script: script.to_owned(),
        port: matches.get_one::<u16>("port").copied(),
        page: Arc::new(PAGE.as_bytes().to_vec()),
        sets,
    };
    let job = interrupt::job();
    let server = match Server::start(settings, Box::new(model), Arc::new(ScriptFile::new(script))) {
        Ok(server) => server,
        Err(error) => return terminal.wrong_usage(&error.to_string()),
    };
    terminal.print(&format!("{}\n", server.address()));
    if !matches.get_flag("no-open") {
        open(&server);
    }
    server.run(move || job.go_on().is_err());
    Exit::Interrupted
}

/// Opens the page in the user's browser; where that cannot be, its address was printed.
pub fn open(server: &Server) {
    let Ok(address) = server.address_for_once() else { return };
    let (program, arguments): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("cmd", &["/C", "start", ""])
    } else {
        ("xdg-open", &[])
    };
    let mut browser = Program::new(program);
    browser.args(arguments).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    #[cfg(unix)]
    // Ctrl-C ends the server and leaves the browser.
    std::os::unix::process::CommandExt::process_group(&mut browser, 0);
    let started = browser.spawn();
    if let Ok(mut child) = started {
        // Its end is awaited by nobody else.
        let waiting = std::thread::Builder::new().name("browser".to_owned()).spawn(move || child.wait());
        drop(waiting);
    }
}

/// Writes the page with the model inside.
fn write_file(mut model: ShownModel, script: &Path, file: &Path, terminal: &Terminal) -> Exit {
    let text = match std::fs::read(script) {
        Ok(text) => text,
        Err(error) => return terminal.wrong_usage(&format!("cannot read {:?}: {error}", script.display())),
    };
    let shown = match model.once(&String::from_utf8_lossy(&text), &interrupt::job()) {
        Ok(Some(shown)) => shown,
        Ok(None) => return Exit::Interrupted,
        Err(bug) => {
            terminal.eprint(&format!("a bug in loft; please report it with this script: {}\n", bug.what));
            return Exit::Bug;
        }
    };
    let (frame, ok) = shown;
    let same = |other: &Path| other.canonicalize().ok().zip(file.canonicalize().ok()).is_some_and(|(a, b)| a == b);
    if same(script) || model.files().iter().any(|read| same(read)) {
        return terminal.wrong_usage(&format!("{:?} is a file that the model reads", file.display().to_string()));
    }
    let mut page = Vec::new();
    let written = one_file::write(PAGE, &frame, &mut page).and_then(|()| write_whole(file, &page));
    if let Err(error) = written {
        terminal.eprint(&format!("cannot write {}: {error}\n", file.display()));
        return Exit::Errors;
    }
    terminal.print(&format!("{}  {} bytes\n", file.display(), page.len()));
    if ok {
        Exit::Fine
    } else {
        terminal.eprint("the model has errors or failed checks; the page tells them\n");
        Exit::Errors
    }
}
