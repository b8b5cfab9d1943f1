//! `loft fmt [--check] FILE…`.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches};

use super::rewrite::rewrite;
use super::{Command, Exit, Terminal};
use crate::base::limits;
use crate::base::visible::colored;
use crate::lang::diag::diagnostic::Sources;
use crate::lang::diag::render::render_all;
use crate::lang::fmt::{Formatted, format};
use crate::session::disk::{read_limited, read_stream, words};
use crate::session::guard::guarded;

/// Lays scripts out.
pub const COMMAND: Command = Command { name: "fmt", about: "Canonical layout of scripts, comments kept", arguments, run };

/// What was asked for.
struct Task<'a> {
    check: bool,
    terminal: &'a Terminal,
}

fn arguments(command: clap::Command) -> clap::Command {
    let file = Arg::new("file").value_name("FILE").required(true).num_args(1..);
    let check = Arg::new("check").long("check").action(ArgAction::SetTrue);
    command
        .arg(file.help("Scripts, folders with scripts, or `-` from standard input to standard output"))
        .arg(check.help("Writes nothing, lists what is not in canonical layout and fails if there is any"))
        .after_help(
            "A declaration with a mistake is left as it is and the mistake is reported; the others are formatted.\n\
             Exit status: 0 fine, 1 a mistake or, with --check, another layout, 2 wrong usage.",
        )
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    let task = Task { check: matches.get_flag("check"), terminal };
    let mut worst = Exit::Fine;
    for name in matches.get_many::<String>("file").into_iter().flatten() {
        let exit = if name == "-" {
            task.stream()
        } else {
            match scripts(Path::new(name)) {
                Ok(paths) => paths.iter().map(|path| task.file(path)).max().unwrap_or(Exit::Fine),
                Err(text) => terminal.wrong_usage(&text),
            }
        };
        worst = worst.max(exit);
    }
    worst
}

/// A file itself, or the scripts in and below a folder in order of their paths; hidden folders and linked ones are
/// passed over.
fn scripts(path: &Path) -> Result<Vec<PathBuf>, String> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let (mut found, mut folders) = (Vec::new(), vec![path.to_owned()]);
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(&folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
        for entry in entries.map_err(|error| format!("cannot read {:?}: {error}", folder.display().to_string()))? {
            let (path, hidden) = (entry.path(), entry.file_name().to_string_lossy().starts_with('.'));
            match entry.file_type() {
                Ok(kind) if kind.is_dir() && !hidden => folders.push(path),
                Ok(kind) if !kind.is_dir() && path.extension().is_some_and(|e| e == "loft") && path.is_file() => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    Ok(found)
}

impl Task<'_> {
    /// Standard input to standard output.
    fn stream(&self) -> Exit {
        let source = match read_stream(std::io::stdin().lock(), limits::SOURCE_BYTES).map(String::from_utf8) {
            Ok(Ok(source)) => source,
            Ok(Err(_)) => return self.terminal.wrong_usage("cannot read \"-\": it is not UTF-8"),
            Err(error) => return self.terminal.wrong_usage(&format!("cannot read \"-\": {}", words(&error))),
        };
        match self.formatted("-", &source) {
            Ok((formatted, exit)) if self.check => exit.max(self.differs("-", &source, &formatted)),
            Ok((formatted, exit)) => {
                self.terminal.print_data(&formatted.text);
                exit
            }
            Err(exit) => exit,
        }
    }

    fn file(&self, path: &Path) -> Exit {
        let name = path.display().to_string();
        let source = match read_limited(path, limits::SOURCE_BYTES).map(String::from_utf8) {
            Ok(Ok(source)) => source,
            Ok(Err(_)) => return self.terminal.wrong_usage(&format!("cannot read {name:?}: it is not UTF-8")),
            Err(error) => return self.terminal.wrong_usage(&format!("cannot read {name:?}: {}", words(&error))),
        };
        let (formatted, exit) = match self.formatted(&name, &source) {
            Ok(done) => done,
            Err(exit) => return exit,
        };
        if self.check {
            return exit.max(self.differs(&name, &source, &formatted));
        }
        if !formatted.changed {
            return exit;
        }
        match rewrite(path, &formatted.text) {
            Ok(()) => {
                self.terminal.print(&format!("{name}\n"));
                exit
            }
            Err(error) => {
                self.terminal.eprint(&format!("loft: cannot write {name:?}: {error}\n"));
                exit.max(Exit::Errors)
            }
        }
    }

    /// Lays a script out, bugs caught, and prints its mistakes.
    fn formatted(&self, name: &str, source: &str) -> Result<(Formatted, Exit), Exit> {
        let formatted = guarded(|| format(source)).map_err(|bug| {
            let place = super::interrupt::last_panic_place();
            let text =
                format!("E999 × a bug in loft: {} ({place})\n  help: {name} is as it was; please report it with this text\n", bug.what);
            self.terminal.eprint(&text);
            Exit::Bug
        })?;
        let errors = formatted.found.iter().any(|d| d.severity() == crate::base::fault::Severity::Error);
        if errors {
            let mut sources = Sources::default();
            sources.add(name, source);
            self.terminal.eprint(&render_all(&formatted.found, &sources, self.terminal.color_err));
        }
        Ok((formatted, if errors { Exit::Errors } else { Exit::Fine }))
    }

    /// Prints the first lines that would change.
    fn differs(&self, name: &str, source: &str, formatted: &Formatted) -> Exit {
        if !formatted.changed {
            return Exit::Fine;
        }
        self.terminal.print(&format!("{name}\n{}", first_difference(source, &formatted.text, self.terminal.color_out)));
        Exit::Errors
    }
}

/// Lines that are shown of one side of a difference.
const SHOWN: usize = 3;

/// The first lines that differ, old and new, with the number of the first.
fn first_difference(old: &str, new: &str, colours: bool) -> String {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.split('\n').collect(), new.split('\n').collect());
    let same = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let tail = old[same..].iter().rev().zip(new[same..].iter().rev()).take_while(|(a, b)| a == b).count();
    let side = |lines: &[&str], sign: char, colour: &str| {
        let lines = &lines[same..(lines.len() - tail).max(same)];
        let mut text = String::new();
        for line in lines.iter().take(SHOWN) {
            // Blanks at the end of a line, a carriage return among them, would not be seen.
            let bare = line.trim_end();
            let rest = line[bare.len()..].replace('\r', "␍").replace('\t', "⇥").replace(' ', "·").replace('\u{feff}', "");
            let line = format!("{sign} {bare}{rest}");
            text += &format!("{}\n", colored(&line, colour, colours));
        }
        if lines.len() > SHOWN {
            let more = lines.len() - SHOWN;
            text += &format!("{sign} … {more} more line{}\n", if more == 1 { "" } else { "s" });
        }
        text
    };
    format!("  line {}\n{}{}", same + 1, side(&old, '-', "31"), side(&new, '+', "32"))
}
