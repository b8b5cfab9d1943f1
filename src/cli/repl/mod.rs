//! `loft repl [MODEL]`: a session on a terminal, or the same from a pipe.

pub(super) mod complete;
mod helper;
mod history;
mod inline;
mod palette;
mod script;
mod sixel;
mod typed;
mod viewing;

use std::io::{IsTerminal, Read};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use clap::{Arg, ArgMatches};
use rustyline::error::ReadlineError;
use rustyline::history::FileHistory;
use rustyline::{CompletionType, Config, Editor};

use super::progress::with_progress;
use super::{Command, Exit, Terminal, interrupt, options, summary};
use crate::base::limits;
use crate::session::disk::{read_limited, words};
use crate::session::notebook::{Answer, Notebook, Part};

use helper::Line;
pub use script::transcript;
use typed::Typed;
use viewing::Viewing;

/// Explores a model.
pub const COMMAND: Command = Command { name: "repl", about: "Explore a model: define, change and ask", arguments, run };

const GREETING: &str = "loft session: declarations define, expressions ask, `:help` lists commands, Ctrl-D ends\n";
const PROMPT: &str = "loft> ";

fn arguments(command: clap::Command) -> clap::Command {
    command.arg(Arg::new("model").value_name("MODEL").help("A script to go on with")).args([options::most_elements(), options::most_work()])
}

fn notebook(color: bool) -> Notebook {
    let started = Instant::now();
    Notebook::new(Arc::new(move || started.elapsed().as_secs_f64()), color)
}

fn run(matches: &ArgMatches, terminal: &Terminal) -> Exit {
    options::read_limits(matches);
    let watched = std::io::stdin().is_terminal() && std::io::stdout().is_terminal();
    let mut book = notebook(terminal.color_out && watched);
    if let Some(model) = matches.get_one::<String>("model") {
        match read(model, terminal) {
            Ok(text) => {
                book.watch(interrupt::entry_job());
                print(&book.load(model, Path::new(model), &text), terminal, watched);
            }
            Err(exit) => return exit,
        }
    }
    if watched { on_terminal(book, terminal) } else { from_pipe(book, terminal) }
}

fn read(model: &str, terminal: &Terminal) -> Result<String, Exit> {
    match read_limited(Path::new(model), limits::SOURCE_BYTES) {
        Ok(bytes) => String::from_utf8(bytes).map_err(|_| terminal.wrong_usage(&format!("{model:?} is not UTF-8 text"))),
        Err(error) => Err(terminal.wrong_usage(&format!("cannot read {model:?}: {}", words(&error)))),
    }
}

/// A session with a script in it, what is wrong with it left unsaid.
pub(super) fn opened(model: &str, terminal: &Terminal) -> Result<Notebook, Exit> {
    let text = read(model, terminal)?;
    let mut book = notebook(terminal.color_out);
    book.load(model, Path::new(model), &text);
    Ok(book)
}

/// Shows an answer without its pictures; Ctrl-C stops a long one.
fn print(answer: &Answer, terminal: &Terminal, watched: bool) {
    let job = interrupt::entry_job();
    let text = job.watch(|| text_of(answer, terminal.color_out && watched));
    if !text.is_ok_and(|text| terminal.print_while(&text, &|| job.go_on().is_ok())) {
        terminal.print("\nstopped: the rest is not shown\n");
    }
}

/// Shows the pictures of an answer where the terminal can; it is asked for that once, and what is typed meanwhile is kept.
fn show_pictures(answer: &Answer, terminal: &Terminal, way: &mut Option<Option<inline::Way>>, typed: &mut Typed) {
    for part in &answer.parts {
        let Part::Picture(bytes) = part else { continue };
        let known = *way.get_or_insert_with(|| inline::Way::of_terminal().unwrap_or_else(|| inline::Way::asked(typed)));
        if let Some(way) = known {
            terminal.print_data(&way.text(bytes));
        }
    }
}

/// An answer as text.
pub(super) fn text_of(answer: &Answer, color: bool) -> String {
    let mut out = String::new();
    for part in &answer.parts {
        match part {
            Part::Text(text) | Part::Said(text) => out.push_str(text),
            Part::Table(table) => summary::print_table(table, &mut out, color),
            // Only a terminal that is watched shows pictures.
            Part::Picture(_) => {}
            Part::Summary(report, tolerance) => out.push_str(&summary::text(report, *tolerance, color)),
        }
        if !out.is_empty() && !out.ends_with('\n') {
            out.push('\n');
        }
    }
    out
}

fn from_pipe(mut notebook: Notebook, terminal: &Terminal) -> Exit {
    let mut text = String::new();
    if let Err(error) = std::io::stdin().lock().take(limits::SOURCE_BYTES).read_to_string(&mut text) {
        return terminal.wrong_usage(&format!("cannot read standard input: {error}"));
    }
    let mut exit = Exit::Fine;
    for entry in script::entries(&text) {
        notebook.watch(interrupt::entry_job());
        let mut answer = notebook.enter(&entry);
        if answer.view {
            answer.parts.push(Part::Text(viewing::WITHOUT_TERMINAL.to_owned()));
            answer.failed = true;
        }
        print(&answer, terminal, false);
        if answer.failed {
            exit = Exit::Errors;
        }
        if answer.quit {
            break;
        }
    }
    exit
}

/// A text after the user's editor; the error says why there is none.
fn edited(text: &str) -> Result<String, String> {
    let set = |name: &str| std::env::var(name).ok().filter(|editor| !editor.trim().is_empty());
    let editor = set("VISUAL").or_else(|| set("EDITOR")).ok_or("no editor is known: set VISUAL or EDITOR, as in `export EDITOR=vi`")?;
    let path = std::env::temp_dir().join(format!("loft-session-{}.loft", std::process::id()));
    let cannot = |error: std::io::Error| format!("cannot use {}: {error}", path.display());
    std::fs::write(&path, text).map_err(cannot)?;
    let mut words = editor.split_whitespace();
    let program = words.next().unwrap_or_default();
    let ended = std::process::Command::new(program).args(words).arg(&path).status();
    let read = std::fs::read_to_string(&path);
    // Nothing can be done about a temporary file that does not go.
    let _ = std::fs::remove_file(&path);
    match ended {
        Ok(status) if status.success() => read.map_err(|error| format!("cannot read what {program} left: {error}")),
        Ok(_) => Err(format!("{program} failed; nothing was changed")),
        Err(error) => Err(format!("cannot start {program} (from VISUAL or EDITOR): {error}")),
    }
}

fn on_terminal(mut notebook: Notebook, terminal: &Terminal) -> Exit {
    let config = Config::builder().completion_type(CompletionType::List).auto_add_history(false).build();
    let mut editor: Editor<Line, FileHistory> = match Editor::with_config(config) {
        Ok(editor) => editor,
        Err(error) => return terminal.wrong_usage(&format!("this terminal cannot be used: {error}")),
    };
    editor.set_helper(Some(Line::new(terminal.color_out)));
    let history = history::path();
    if let Some(path) = &history {
        // Without a history of earlier sessions this one begins.
        let _ = editor.load_history(path);
    }
    notebook.edit_with(Box::new(edited));
    terminal.print(GREETING);
    let (mut way, mut typed) = (None, Typed::default());
    let mut viewing: Option<Viewing> = None;
    loop {
        let columns = editor.dimensions().map_or(usize::MAX, |(columns, _)| usize::from(columns).saturating_sub(PROMPT.len()));
        if let Some(line) = editor.helper_mut() {
            line.learn(&notebook, columns);
        }
        let entry = match typed.entry() {
            Some(entry) => {
                terminal.print(&format!("{PROMPT}{entry}\n"));
                Ok(entry)
            }
            None => editor.readline_with_initial(PROMPT, (&typed.rest(), "")),
        };
        match entry {
            Ok(entry) => {
                if entry.trim().is_empty() {
                    continue;
                }
                let added = editor.add_history_entry(entry.as_str()).unwrap_or(false);
                if let Some(path) = history.as_ref().filter(|_| added) {
                    // A history that cannot be written is no reason to stop.
                    let _ = editor.append_history(path);
                }
                let job = interrupt::entry_job();
                notebook.watch(job.clone());
                // An editor has the terminal for itself.
                let watched = terminal.watched && !entry.trim().starts_with(":edit");
                let answer = with_progress(&job, watched, || notebook.enter(&entry));
                print(&answer, terminal, true);
                show_pictures(&answer, terminal, &mut way, &mut typed);
                match (&viewing, answer.view) {
                    (Some(page), true) => page.open(terminal),
                    (None, true) => viewing = Viewing::start(&notebook, terminal),
                    (Some(page), false) => page.follow(&notebook),
                    (None, false) => {}
                }
                if answer.quit {
                    return Exit::Fine;
                }
            }
            // Ctrl-C at the prompt leaves the line.
            Err(ReadlineError::Interrupted) => {}
            Err(ReadlineError::Eof) => return Exit::Fine,
            Err(error) => return terminal.wrong_usage(&format!("the terminal failed: {error}")),
        }
    }
}
