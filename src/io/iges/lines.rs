//! The physical layer of IGES: 80-column lines sorted into their sections.
//!
//! Columns 1–72 are content, column 73 the letter of the section, columns 74–80 a number. Lines that keep these columns only
//! roughly (too long, too short, shifted, without letter) are read where it is clear what they mean, with a warning each.

use crate::io::files::fault::Malformed;

/// Columns of content.
pub const CONTENT: usize = 72;
/// Columns of parameter data before the pointer back to the entity.
pub const DATA: usize = 64;

/// One line of a section.
#[derive(Clone, Copy, Debug)]
pub struct Line<'a> {
    /// What stands before the letter: 72 columns, fewer where the line is short.
    pub content: &'a [u8],
    /// The number behind the letter, 0 when it cannot be read.
    pub sequence: u32,
    /// Line of the file, from 1.
    pub line: u64,
    /// Columns by which the letter stands off column 73.
    pub shift: isize,
}

/// The lines of a file by section, in file order.
#[derive(Debug, Default)]
pub struct Sections<'a> {
    /// Lines of the start section.
    pub start: usize,
    /// Global parameters.
    pub global: Vec<Line<'a>>,
    /// Directory entries, two lines each.
    pub directory: Vec<Line<'a>>,
    /// Parameter data.
    pub parameters: Vec<Line<'a>>,
    /// The terminating line was there.
    pub terminated: bool,
    /// Last line of the file, from 1.
    pub last_line: u64,
}

const LETTERS: &[u8] = b"SGDPT";

/// Sorts a file into sections; fails when it is none of IGES, or one of its binary or compressed forms.
pub fn sections<'a>(bytes: &'a [u8], warnings: &mut Vec<Malformed>) -> Result<Sections<'a>, Malformed> {
    let mut found = Sections::default();
    let mut before = None;
    let mut number = 0;
    for text in lines_of(bytes) {
        number += 1;
        if text.iter().all(u8::is_ascii_whitespace) {
            continue;
        }
        let (letter, line) = match tail(text) {
            Some((b'C' | b'B', _)) if before.is_none() => {
                let what = "this is a compressed or binary IGES file; only the form of 80 columns is read";
                return Err(Malformed::line(number, what));
            }
            Some((letter, column)) if LETTERS.contains(&letter) => {
                let sequence = number_of(&text[column + 1..]);
                let shift = column as isize - CONTENT as isize;
                if shift != 0 {
                    warnings.push(Malformed::at(
                        number,
                        column as u64 + 1,
                        format!("the section letter {} is in column {}, not 73", letter as char, column + 1),
                    ));
                }
                (letter, Line { content: &text[..column], sequence, line: number, shift })
            }
            _ => {
                let Some(letter) = before.filter(|_| found.start + found.global.len() > 0) else {
                    return Err(Malformed::line(number, "this is not an IGES file: column 73 holds none of the letters S, G, D, P and T"));
                };
                warnings.push(Malformed::line(number, format!("the line has no section letter and is taken for {}", letter as char)));
                (letter, Line { content: &text[..text.len().min(CONTENT)], sequence: 0, line: number, shift: 0 })
            }
        };
        match letter {
            b'S' => found.start += 1,
            b'G' => found.global.push(line),
            b'D' => found.directory.push(line),
            b'P' => found.parameters.push(line),
            _ => found.terminated = true,
        }
        before = Some(letter);
        found.last_line = number;
    }
    if before.is_none() {
        return Err(Malformed::line(1, "the file is empty"));
    }
    if !found.terminated {
        warnings.push(Malformed::line(number, "the file ends without its terminating line (T)"));
    }
    Ok(found)
}

/// Lines however they end: `\n`, `\r\n` or `\r`.
fn lines_of(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let only_returns = !bytes.contains(&b'\n');
    bytes.split(move |b| *b == if only_returns { b'\r' } else { b'\n' }).map(|line| match line {
        [head @ .., b'\r'] => head,
        _ => line,
    })
}

/// The section letter of a line with its index: in column 73, or before a number at the end of the line.
fn tail(text: &[u8]) -> Option<(u8, usize)> {
    let is_number = |rest: &[u8]| rest.iter().all(|c| c.is_ascii_digit() || *c == b' ' || *c == b'\t');
    let known = |c: u8| LETTERS.contains(&c) || c == b'C' || c == b'B';
    if let Some(&letter) = text.get(CONTENT)
        && known(letter)
        && is_number(&text[CONTENT + 1..])
    {
        return Some((letter, CONTENT));
    }
    let column = text.iter().rposition(|c| !(c.is_ascii_digit() || c.is_ascii_whitespace()))?;
    let rest = &text[column + 1..];
    let numbered = rest.iter().any(u8::is_ascii_digit);
    // Anything else that ends in a letter is content, not a shifted line.
    (LETTERS.contains(&text[column]) && numbered && (DATA - 8..=2 * CONTENT).contains(&column)).then_some((text[column], column))
}

/// A number with blanks around it, 0 when there is none.
pub fn number_of(text: &[u8]) -> u32 {
    std::str::from_utf8(text).ok().and_then(|t| t.trim().parse().ok()).unwrap_or(0)
}
