//! Standard output and standard error: who writes where, and in which colours.

use std::borrow::Cow;
use std::io::{self, IsTerminal, Write};
use std::sync::{Mutex, PoisonError};

use super::Exit;
use crate::base::visible::{visible, visible_beside_colors};
use crate::session::disk::plain;

/// The first text that standard output did not take.
static LOST: Mutex<Option<io::Error>> = Mutex::new(None);

/// Where a command prints.
#[derive(Clone, Copy, Debug)]
pub struct Terminal {
    /// Colours on standard output.
    pub color_out: bool,
    /// Colours on standard error.
    pub color_err: bool,
    /// Somebody watches standard error.
    pub watched: bool,
}

impl Terminal {
    /// `when` is `auto`, `always` or `never`; `auto` asks the streams, `NO_COLOR` and `TERM`.
    pub fn new(when: &str) -> Self {
        let plain = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty()) || std::env::var_os("TERM").is_some_and(|v| v == "dumb");
        let (out, err) = (io::stdout().is_terminal(), io::stderr().is_terminal());
        let color = |stream: bool| match when {
            "always" => true,
            "never" => false,
            _ => stream && !plain,
        };
        // The log of an automatic build is no place for what is drawn over itself.
        let automatic = std::env::var_os("CI").is_some_and(|v| !v.is_empty() && v != "false");
        Self { color_out: color(out), color_err: color(err), watched: err && !automatic }
    }

    /// Prints a text for people on standard output, with nothing in it that steers the terminal but colours; what standard output does not
    /// take is reported by [`Terminal::end`].
    pub fn print(&self, text: &str) {
        self.print_data(&shown(text, self.color_out));
    }

    /// Prints what programs read as it is: JSON, scripts, pages of a manual, pictures.
    pub fn print_data(&self, text: &str) {
        let mut out = io::stdout().lock();
        lose(out.write_all(text.as_bytes()).and_then(|()| out.flush()));
    }

    /// As [`Terminal::print`], in pieces, as long as `go_on` says so; whether it said so to the end.
    pub fn print_while(&self, text: &str, go_on: &dyn Fn() -> bool) -> bool {
        let mut out = io::stdout().lock();
        let (whole, written) = write_while(&mut out, shown(text, self.color_out).as_bytes(), go_on);
        lose(written);
        whole
    }

    /// How the program ends: a text that standard output did not take is an error of a run without others. A full disk
    /// is reported; a reader that has gone (`loft doc | head`) knows.
    pub fn end(&self, exit: Exit) -> Exit {
        let lost = LOST.lock().unwrap_or_else(PoisonError::into_inner).take();
        let status = match lost {
            None => return exit,
            Some(error) if error.kind() == io::ErrorKind::BrokenPipe => Exit::ClosedPipe,
            Some(error) => {
                self.eprint(&format!("loft: cannot write to standard output: {}\n", plain(&error)));
                Exit::Errors
            }
        };
        if exit == Exit::Fine { status } else { exit }
    }

    /// Prints a text for people on standard error.
    pub fn eprint(&self, text: &str) {
        let _ = io::stderr().lock().write_all(shown(text, self.color_err).as_bytes());
    }

    /// Says on standard error what is wrong with the command line.
    pub fn wrong_usage(&self, text: &str) -> Exit {
        self.eprint(&format!("loft: {text}\n"));
        Exit::Usage
    }
}

/// A text as people see it, with colours where there are some.
fn shown(text: &str, color: bool) -> Cow<'_, str> {
    if color { visible_beside_colors(text) } else { visible(text) }
}

/// Remembers that standard output did not take a text.
pub fn lose(written: io::Result<()>) {
    if let Err(error) = written {
        LOST.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}

/// Bytes that are written between two questions whether to go on.
const PIECE: usize = 4096;

/// Writes in pieces as long as `go_on` says so; whether it said so to the end, and how the writing went.
fn write_while(out: &mut impl Write, text: &[u8], go_on: &dyn Fn() -> bool) -> (bool, io::Result<()>) {
    for piece in text.chunks(PIECE) {
        if !go_on() {
            return (false, Ok(()));
        }
        if let Err(error) = out.write_all(piece).and_then(|()| out.flush()) {
            return (true, Err(error));
        }
    }
    (true, Ok(()))
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn a_long_text_is_written_as_long_as_it_is_wanted() {
        let text = vec![b'x'; 10 * PIECE + 1];
        for (wanted, written) in [(0u32, 0), (1, PIECE), (3, 3 * PIECE), (11, text.len()), (20, text.len())] {
            let (mut out, left) = (Vec::new(), Cell::new(wanted));
            let go_on = || left.replace(left.get().saturating_sub(1)) > 0;
            let (whole, ended) = write_while(&mut out, &text, &go_on);
            assert!(ended.is_ok());
            assert_eq!((out.len(), whole), (written, written == text.len()));
        }
    }
}
