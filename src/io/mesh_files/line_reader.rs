//! Lines that lie apart in memory, read as one text.

use std::borrow::Cow;
use std::io::{BufRead, Read, Result};

use crate::base::job;

/// Reads lines one after the other, a new line behind each; nothing is copied.
pub(crate) struct LineReader<'a> {
    lines: std::slice::Iter<'a, Cow<'a, str>>,
    /// What is left of the current line.
    rest: &'a [u8],
    /// Whether the end of the current line is still to come.
    is_open: bool,
}

impl<'a> LineReader<'a> {
    pub fn new(lines: &'a [Cow<'a, str>]) -> Self {
        Self { lines: lines.iter(), rest: &[], is_open: false }
    }
}

impl BufRead for LineReader<'_> {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        while self.rest.is_empty() {
            if std::mem::take(&mut self.is_open) {
                self.rest = b"\n";
            } else if let Some(line) = self.lines.next() {
                job::poll();
                (self.rest, self.is_open) = (line.as_bytes(), true);
            } else {
                break;
            }
        }
        Ok(self.rest)
    }

    fn consume(&mut self, n: usize) {
        self.rest = &self.rest[n..];
    }
}

impl Read for LineReader<'_> {
    fn read(&mut self, out: &mut [u8]) -> Result<usize> {
        let n = self.fill_buf()?.read(out)?;
        self.consume(n);
        Ok(n)
    }
}
