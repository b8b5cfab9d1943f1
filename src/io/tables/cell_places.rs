//! Where the cells of a csv stand in its text.

use std::ops::Range;

use crate::io::tables::text::{decode, separator, without_comments};

/// The text of a csv with the places of its cells.
#[derive(Clone, Debug)]
pub struct CellPlaces<'a> {
    /// The text, without a byte order mark; empty where the file is no text.
    pub text: &'a str,
    separator: char,
    /// Where each line begins.
    lines: Vec<usize>,
}

impl<'a> CellPlaces<'a> {
    /// Those of a file that was read as a csv.
    pub fn new(bytes: &'a [u8]) -> Self {
        let text = decode(bytes).unwrap_or("");
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { text, separator: char::from(separator(&without_comments(text))), lines }
    }

    /// The first line with anything but a comment on it, from 1.
    pub fn first_line(&self) -> u64 {
        let filled = without_comments(self.text).lines().position(|line| !line.trim().is_empty());
        filled.map_or(1, |k| k as u64 + 1)
    }

    /// Where a cell of a line stands, quotes included, blanks around it not; the whole line where it has no such cell.
    pub fn cell(&self, line: u64, column: usize) -> Range<usize> {
        let index = usize::try_from(line).unwrap_or(1).saturating_sub(1);
        let start = self.lines.get(index).copied().unwrap_or(0);
        let rest = &self.text[start..];
        let (mut quoted, mut from, mut k) = (false, 0, 0);
        for (at, c) in rest.char_indices() {
            quoted ^= c == '"';
            if !quoted && (c == self.separator || matches!(c, '\n' | '#')) {
                if k == column {
                    return trimmed(self.text, start + from..start + at);
                }
                if c != self.separator {
                    return trimmed(self.text, start..start + at);
                }
                (k, from) = (k + 1, at + c.len_utf8());
            }
        }
        trimmed(self.text, if k == column { start + from } else { start }..self.text.len())
    }
}

/// A stretch without the blanks at its ends.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let part = &text[range.clone()];
    let start = range.start + part.len() - part.trim_start().len();
    start..start + part.trim().len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_found() {
        let text = "# sizes\n\nname ; width [mm];n\n\"a;b\"; 80 ;4 # high\nlast;;7";
        let places = CellPlaces::new(text.as_bytes());
        let cell = |line, column| &text[places.cell(line, column)];
        assert_eq!(places.first_line(), 3);
        assert_eq!([cell(3, 0), cell(3, 1), cell(3, 2)], ["name", "width [mm]", "n"]);
        assert_eq!([cell(4, 0), cell(4, 1), cell(4, 2)], ["\"a;b\"", "80", "4"]);
        assert_eq!([cell(5, 0), cell(5, 1), cell(5, 2)], ["last", "", "7"]);
        assert_eq!(cell(4, 9), "\"a;b\"; 80 ;4");
    }
}
