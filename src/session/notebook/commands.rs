//! The commands of a session, declared once: help, completion and dispatch read the table.

use std::path::Path;

use super::{Answer, Notebook, Part, State, bug_answer, ended, stopped, summary};
use crate::base::limits;
use crate::draw::View;
use crate::lang::run::symbols::Condition;
use crate::lang::values::plans::PictureSpec;
use crate::session::disk::{read_limited, write_whole};
use crate::session::live::Depth;
use crate::session::lookup;
use crate::session::run::Wanted;

/// One command.
#[derive(Debug)]
pub struct Command {
    /// Its word, without the colon.
    pub word: &'static str,
    /// What follows it.
    pub takes: &'static str,
    /// What it does, in a line.
    pub docs: &'static str,
    run: fn(&mut Notebook, &str) -> Answer,
}

/// All commands in the order of the help.
pub const COMMANDS: &[Command] = &[
    Command { word: "show", takes: "NAME", docs: "What a name stands for, and what it measures", run: Notebook::show },
    Command { word: "network", takes: "", docs: "Curves of the network with their links", run: Notebook::network },
    Command { word: "nodes", takes: "", docs: "Nodes with their places and what meets there", run: Notebook::nodes },
    Command { word: "links", takes: "CURVE", docs: "Links that a curve runs over", run: Notebook::links },
    Command { word: "why", takes: "NAME", docs: "What a name depends on, and what depends on it", run: Notebook::why },
    Command { word: "explain", takes: "NAME", docs: "How a name came about, in detail", run: |n, what| n.explain(what) },
    Command { word: "remove", takes: "NAME", docs: "Removes a declaration that nothing uses", run: |n, name| n.remove(name, false) },
    Command { word: "remove!", takes: "NAME", docs: "Removes a declaration and all that uses it", run: |n, name| n.remove(name, true) },
    Command { word: "undo", takes: "", docs: "Undoes the last change, and says which", run: |n, _| n.back(true) },
    Command { word: "redo", takes: "", docs: "Redoes the last undone change", run: |n, _| n.back(false) },
    Command { word: "set", takes: "PARAM=VALUE", docs: "Gives a param another value", run: Notebook::set },
    Command { word: "mesh", takes: "NAME", docs: "Builds a mesh and shows its counts and quality", run: Notebook::mesh },
    Command {
        word: "view",
        takes: "",
        docs: "The model in a browser; the page follows the session",
        run: |_, _| Answer { view: true, ..Answer::default() },
    },
    Command { word: "run", takes: "", docs: "Runs the whole model and writes its files", run: Notebook::whole_run },
    Command { word: "time", takes: "", docs: "How long the last entry took and what was reused", run: Notebook::time },
    Command {
        word: "render",
        takes: "NAME [FILE]",
        docs: "Draws a thing into a file, and on terminals that can, here",
        run: Notebook::render,
    },
    Command {
        word: "edit",
        takes: "",
        docs: "Opens the script in $VISUAL or $EDITOR and continues with what is saved",
        run: Notebook::edit,
    },
    Command { word: "reload", takes: "", docs: "Reads the loaded file again (`:undo` takes that back)", run: Notebook::reload },
    Command { word: "load", takes: "FILE", docs: "Continues with a script", run: |n, file| n.load_file(file) },
    Command { word: "save", takes: "FILE", docs: "Writes a script that gives this model", run: Notebook::save },
    Command {
        word: "reset",
        takes: "",
        docs: "Starts from nothing (`:undo` takes that back)",
        run: |n, _| n.change(State::default(), &[]),
    },
    Command { word: "help", takes: "[NAME]", docs: "These commands, or what a function or field does", run: Notebook::help },
    Command { word: "quit", takes: "", docs: "Ends the session", run: |_, _| Answer { quit: true, ..Answer::default() } },
];

impl Notebook {
    /// Carries out `word rest`.
    pub(super) fn command(&mut self, text: &str) -> Answer {
        let text = text.trim();
        let (word, rest) = text.split_once(char::is_whitespace).map_or((text, ""), |(word, rest)| (word, rest.trim()));
        let Some(command) = COMMANDS.iter().find(|c| c.word == word) else {
            let near = crate::lang::words::names::nearest(word, COMMANDS.iter().map(|c| c.word));
            let hint = near.map_or_else(String::new, |near| format!("; did you mean `:{near}`?"));
            return Answer::failure(format!("there is no command `:{word}`{hint} (`:help` lists all)"));
        };
        let needs = !command.takes.is_empty() && !command.takes.starts_with('[');
        if needs && rest.is_empty() {
            return Answer::failure(format!("`:{word}` takes {}", command.takes));
        }
        if command.takes.is_empty() && !rest.is_empty() {
            return Answer::failure(format!("`:{word}` takes nothing"));
        }
        (command.run)(self, rest)
    }

    fn help(&mut self, name: &str) -> Answer {
        if let Some(command) = COMMANDS.iter().find(|c| c.word == name.trim_start_matches(':')) {
            return Answer::text(format!(":{} {}\n  {}", command.word, command.takes, command.docs).replace(" \n", "\n"));
        }
        if !name.is_empty() {
            return match lookup::entry(name) {
                Ok(text) => Answer::text(text.trim_end()),
                Err(near) if near.is_empty() => Answer::failure(format!("there is no `{name}` in the language")),
                Err(near) => Answer::failure(format!("there is no `{name}` in the language; did you mean `{}`?", near.join("`, `"))),
            };
        }
        let width = COMMANDS.iter().map(|c| c.word.len() + c.takes.len() + 2).max().unwrap_or(0);
        let line = |c: &Command| format!("  {:width$}  {}", format!(":{} {}", c.word, c.takes).trim_end(), c.docs);
        let commands: Vec<String> = COMMANDS.iter().map(line).collect();
        Answer::text(format!(
            "A declaration (`curve a = line((0, 0, 0), (4, 0, 0))`) defines or redefines; an expression (`a.length`) shows its value.\n{}",
            commands.join("\n")
        ))
    }

    /// Undo or redo.
    fn back(&mut self, undo: bool) -> Answer {
        let from = if undo { &mut self.now.past } else { &mut self.now.future };
        let Some(state) = from.pop() else {
            return Answer::failure(if undo { "nothing to undo" } else { "nothing to redo" });
        };
        let (mut past, mut future) = (std::mem::take(&mut self.now.past), std::mem::take(&mut self.now.future));
        let before = self.now.state.clone();
        let words = if undo {
            format!("undid: {}", summary::change(&state, &before))
        } else {
            format!("redid: {}", summary::change(&before, &state))
        };
        let names = summary::changed_names(&before.text, &state.text);
        let mut answer = self.change(state.clone(), &names);
        if answer.stopped {
            if undo { &mut past } else { &mut future }.push(state);
            (self.now.past, self.now.future) = (past, future);
            return answer;
        }
        if undo { &mut future } else { &mut past }.push(before);
        self.now.past = past;
        self.now.future = future;
        answer.parts.insert(0, Part::Text(words));
        answer
    }

    fn set(&mut self, text: &str) -> Answer {
        let Some((name, value)) = text.split_once('=').map(|(n, v)| (n.trim().to_owned(), v.trim().to_owned())) else {
            return Answer::failure("`:set` takes PARAM=VALUE, as in `:set span=50m`");
        };
        let mut sets = self.now.state.sets.clone();
        sets.retain(|(n, _)| *n != name);
        sets.push((name.clone(), value));
        let before = self.now.clone();
        let mut answer = self.change(State { text: before.state.text.clone(), sets }, std::slice::from_ref(&name));
        let refused = self.now.conditions.get(&name) != Some(&Condition::Sound);
        if answer.failed && refused && self.now.state != before.state {
            // A value that the param refuses changes nothing.
            self.now = before;
            answer.parts.retain(|part| matches!(part, Part::Said(_)));
            answer.say("nothing was changed");
        }
        answer
    }

    fn whole_run(&mut self, _: &str) -> Answer {
        let state = self.now.state.clone();
        let outcome = match self.run(&state, Depth::Files, &mut |_| {}) {
            Ok(outcome) => outcome,
            Err(answer) => return answer,
        };
        let mut answer = Answer { failed: !outcome.report.ok, ..Answer::default() };
        let drawn = outcome.drawn(self.color, false);
        if !drawn.is_empty() {
            answer.parts.push(Part::Said(drawn));
        }
        answer.parts.push(Part::Summary(Box::new(outcome.report), outcome.tolerance));
        answer
    }

    fn time(&mut self, _: &str) -> Answer {
        let Some(last) = self.last else { return Answer::failure("nothing was computed yet") };
        let of = self.now.symbols.len();
        let n = last.reused;
        Answer::text(format!(
            "{:.4} s: parse {:.4}, evaluate {:.4}, mesh {:.4}; {n} results taken over from before, {of} declarations",
            last.seconds, last.parse, last.evaluate, last.mesh
        ))
    }

    fn load_file(&mut self, file: &str) -> Answer {
        let path = Path::new(unquoted(file));
        let text = match read_limited(path, limits::SOURCE_BYTES) {
            Ok(bytes) => String::from_utf8(bytes),
            Err(error) => return Answer::failure(format!("cannot read {}: {}", path.display(), crate::session::disk::words(&error))),
        };
        let Ok(text) = text else { return Answer::failure(format!("{} is not UTF-8 text", path.display())) };
        let mut answer = self.load(&path.to_string_lossy(), path, &text);
        if answer.stopped {
            return answer;
        }
        let sound = self.now.symbols.iter().filter(|s| s.name.is_some() && s.condition == Condition::Sound).count();
        answer.say(format!("{}: {sound} names", path.display()));
        answer
    }

    /// Reads the loaded file again; `:undo` takes that back.
    fn reload(&mut self, _: &str) -> Answer {
        let Some(path) = self.loaded.clone() else {
            return Answer::failure("no file was loaded: `:load FILE` goes on with one");
        };
        let text = match read_limited(&path, limits::SOURCE_BYTES) {
            Ok(bytes) => String::from_utf8(bytes),
            Err(error) => return Answer::failure(format!("cannot read {}: {}", path.display(), crate::session::disk::words(&error))),
        };
        let Ok(text) = text else { return Answer::failure(format!("{} is not UTF-8 text", path.display())) };
        self.go_over(&text, &format!("{} is read again", path.display()))
    }

    /// Another text of the session from the user's editor.
    fn edit(&mut self, _: &str) -> Answer {
        let Some(editor) = &self.editor else {
            return Answer::failure("`:edit` needs a terminal");
        };
        match editor(&self.saved_text()) {
            Ok(text) => self.go_over(&text, "edited"),
            Err(why) => Answer::failure(why),
        }
    }

    /// Goes over to another text, whatever is wrong with it, and says what changed.
    fn go_over(&mut self, text: &str, what: &str) -> Answer {
        let next = State { text: ended(text), sets: Vec::new() };
        if next == self.now.state {
            return Answer::text(format!("{what}: nothing changed"));
        }
        let before = self.now.state.clone();
        let names = summary::changed_names(&before.text, &next.text);
        let mut answer = self.change(next, &names);
        if !answer.stopped {
            answer.parts.insert(0, Part::Text(format!("{what}: {}", summary::change(&before, &self.now.state))));
        }
        answer
    }

    /// `:render NAME [FILE]`.
    fn render(&mut self, text: &str) -> Answer {
        let (name, file) = text.split_once(char::is_whitespace).map_or((text, ""), |(name, file)| (name, file.trim()));
        let plain: String = name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
        let file = if file.is_empty() { format!("{}.png", plain.trim_end_matches('_')) } else { unquoted(file).to_owned() };
        let path = Path::new(&file);
        let Some(end) = path.file_name() else { return Answer::failure(format!("{file} is not a file name")) };
        let Some(view) = View::named("isometric") else { return Answer::failure("there is no view") };
        let wanted = Wanted { names: vec![name.to_owned()], zoom: Vec::new(), spec: PictureSpec::of_file(&end.to_string_lossy(), view) };
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let (state, job) = (self.now.state.clone(), self.job.clone());
        let outcome = match self.live.draw(&state.text, &state.sets, folder, &wanted, &job) {
            Ok(outcome) if outcome.interrupted => return stopped(),
            Ok(outcome) => outcome,
            Err(bug) => return bug_answer(&bug),
        };
        let Some(row) = outcome.report.outputs.first() else {
            return Answer { parts: vec![Part::Said(outcome.drawn(self.color, false))], failed: true, ..Answer::default() };
        };
        let (width, height) = wanted.spec.size;
        let mut answer = Answer::text(format!("{}: {width} × {height} pixels, {} bytes", path.display(), row.bytes));
        if crate::io::extension(&file) == "png" {
            answer.parts.extend(read_limited(path, limits::DATA_BYTES).ok().map(Part::Picture));
        }
        answer
    }

    fn save(&mut self, file: &str) -> Answer {
        let path = Path::new(unquoted(file));
        let text = self.saved_text();
        match write_whole(path, text.as_bytes()) {
            Ok(()) => Answer::text(format!("wrote {}", path.display())),
            Err(error) => Answer::failure(format!("cannot write {}: {error}", path.display())),
        }
    }
}

fn unquoted(text: &str) -> &str {
    text.strip_prefix('"').and_then(|t| t.strip_suffix('"')).unwrap_or(text)
}
