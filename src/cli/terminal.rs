//! Standard output and standard error: who writes where, and in which colours.

use std::io::{self, IsTerminal, Write};

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
        Self { color_out: color(out), color_err: color(err), watched: err }
    }

    /// Prints on standard output. A reader that has gone (`loft doc | head`) is no failure.
    pub fn print(&self, text: &str) {
        let mut out = io::stdout().lock();
        let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    }

    /// Prints on standard error.
    pub fn tell(&self, text: &str) {
        let _ = io::stderr().lock().write_all(text.as_bytes());
    }

    /// Says on standard error what is wrong with the command line.
    pub fn wrong_usage(&self, text: &str) -> super::Exit {
        self.tell(&format!("loft: {text}\n"));
        super::Exit::Usage
    }
}
