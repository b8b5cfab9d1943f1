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

/// Where the cells of one line stand.
#[derive(Clone, Debug)]
pub struct RowPlaces {
    cells: Vec<Range<usize>>,
    whole: Range<usize>,
}

impl RowPlaces {
    /// One of them; the whole line where it has no such cell.
    pub fn cell(&self, column: usize) -> Range<usize> {
        self.cells.get(column).unwrap_or(&self.whole).clone()
    }
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

    /// Where the cells of a line stand, quotes included, blanks around them not, and the whole line; read once, however many they are.
    pub fn row(&self, line: u64) -> RowPlaces {
        let index = usize::try_from(line).unwrap_or(1).saturating_sub(1);
        let start = self.lines.get(index).copied().unwrap_or(0);
        let (mut quoted, mut from, mut end) = (false, start, self.text.len());
        let mut cells = Vec::new();
        for (at, c) in self.text[start..].char_indices() {
            quoted ^= c == '"';
            if quoted {
                continue;
            }
            if c == self.separator {
                cells.push(trimmed(self.text, from..start + at));
                from = start + at + c.len_utf8();
            } else if matches!(c, '\n' | '#') {
                end = start + at;
                break;
            }
        }
        cells.push(trimmed(self.text, from..end));
        RowPlaces { cells, whole: trimmed(self.text, start..end) }
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
        let cell = |line, column| &text[places.row(line).cell(column)];
        assert_eq!(places.first_line(), 3);
        assert_eq!([cell(3, 0), cell(3, 1), cell(3, 2)], ["name", "width [mm]", "n"]);
        assert_eq!([cell(4, 0), cell(4, 1), cell(4, 2)], ["\"a;b\"", "80", "4"]);
        assert_eq!([cell(5, 0), cell(5, 1), cell(5, 2)], ["last", "", "7"]);
        assert_eq!(cell(4, 9), "\"a;b\"; 80 ;4");
    }
}
