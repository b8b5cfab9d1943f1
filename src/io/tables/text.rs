//! Text of data files: decoded, without comments, and the character that separates its cells.

use std::borrow::Cow;

use crate::io::files::fault::Malformed;

/// The text of a data file without its byte order mark, or where it is no text.
pub(crate) fn decode(bytes: &[u8]) -> Result<&str, Malformed> {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(Malformed::at(1, 1, "this is UTF-16 text; save it as UTF-8"));
    }
    let body = bytes.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(bytes);
    let (valid, bad) = match std::str::from_utf8(body) {
        Ok(text) => (text, None),
        Err(e) => (std::str::from_utf8(&body[..e.valid_up_to()]).unwrap_or(""), body.get(e.valid_up_to()).copied()),
    };
    let control = valid.char_indices().find(|(_, c)| c.is_control() && !matches!(c, '\t' | '\n' | '\r' | '\x0C' | '\u{85}'));
    let (at, byte) = match (control, bad) {
        (Some((at, c)), _) => (at, c as u32),
        (None, Some(byte)) => (valid.len(), u32::from(byte)),
        (None, None) => return Ok(valid),
    };
    let before = &valid[..at];
    let line = before.bytes().filter(|b| *b == b'\n').count() as u64 + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() as u64 + 1;
    let what = if control.is_some() {
        format!("the byte {byte:#04x} does not belong in a text file")
    } else {
        format!("the byte {byte:#04x} is not UTF-8 text; save the file as UTF-8")
    };
    Err(Malformed::at(line, column, what))
}

/// The text with comments blanked out; lines and the places in them stay.
pub(crate) fn without_comments(text: &str) -> Cow<'_, str> {
    if !text.contains('#') {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    let (mut quoted, mut comment) = (false, false);
    for c in text.chars() {
        match c {
            '\n' => comment = false,
            '"' if !comment => quoted = !quoted,
            '#' if !quoted => comment = true,
            _ => {}
        }
        if !comment {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// The separator that most of the first lines agree on; tab before semicolon before comma.
pub(crate) fn separator(text: &str) -> u8 {
    let lines = || text.lines().filter(|line| !line.trim().is_empty()).take(20);
    let count = |line: &str, separator: u8| {
        let mut quoted = false;
        let found = line.bytes().filter(|b| {
            quoted ^= *b == b'"';
            !quoted && *b == separator
        });
        found.count()
    };
    let score = |separator: u8| {
        let counts: Vec<usize> = lines().map(|line| count(line, separator)).collect();
        let same = counts.first().is_some_and(|first| *first > 0 && counts.iter().all(|n| n == first));
        (same, counts.iter().filter(|n| **n > 0).count())
    };
    let mut best = (b',', (false, 0));
    for candidate in [b'\t', b';', b','] {
        let score = score(candidate);
        if score > best.1 {
            best = (candidate, score);
        }
    }
    best.0
}
