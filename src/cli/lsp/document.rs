//! One open file: its text, its places in both counts, and the model behind it.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::lang::diag::span::Span;

/// An open file.
#[derive(Clone)]
pub struct Document {
    /// As the editor names it.
    pub uri: String,
    /// On the disk; `None` for a file that was never saved.
    pub path: Option<PathBuf>,
    /// Its text as edited.
    pub text: String,
    /// The editor's count of changes.
    pub version: i64,
    /// Our own count of changes, of what it reads from other files too.
    pub revision: u64,
    /// First byte of each line: behind `\n`, `\r\n` and, as editors count, `\r` alone.
    lines: Vec<usize>,
    /// A column is a byte either way.
    plain: bool,
    /// Columns count bytes, as was agreed on; UTF-16 units otherwise.
    bytes: bool,
}

impl Document {
    pub fn new(uri: &str, text: String, version: i64, bytes: bool) -> Self {
        let (uri, path) = (uri.to_owned(), path_of(uri));
        let mut document = Self { uri, path, text, version, revision: 0, lines: Vec::new(), plain: false, bytes };
        document.count();
        document
    }

    fn count(&mut self) {
        let letters = self.text.as_bytes();
        let is_end = |at: &usize| letters[*at] == b'\n' || letters[*at] == b'\r' && letters.get(at + 1) != Some(&b'\n');
        self.lines = std::iter::once(0).chain((0..letters.len()).filter(is_end).map(|at| at + 1)).collect();
        self.plain = self.bytes || self.text.is_ascii();
    }

    /// Takes over a change: a stretch of text, or the whole.
    pub fn change(&mut self, change: &Value) {
        let text = change["text"].as_str().unwrap_or_default();
        match change.get("range") {
            Some(range) if !range.is_null() => {
                let (start, end) = (self.byte(&range["start"]), self.byte(&range["end"]));
                self.text.replace_range(start..end.max(start), text);
            }
            _ => self.text = text.to_owned(),
        }
        self.count();
        self.revision += 1;
    }

    /// The byte at a place as the editor counts; places beyond a line's end are its end.
    pub fn byte(&self, position: &Value) -> usize {
        let line = position["line"].as_u64().unwrap_or(0) as usize;
        let column = position["character"].as_u64().unwrap_or(0) as usize;
        let Some(&start) = self.lines.get(line) else { return self.text.len() };
        let whole = &self.text[start..self.lines.get(line + 1).copied().unwrap_or(self.text.len())];
        let end = start + whole.trim_end_matches(['\n', '\r']).len();
        let mut counted = 0;
        for (at, c) in self.text[start..end].char_indices() {
            if counted >= column {
                return start + at;
            }
            counted += if self.bytes { c.len_utf8() } else { c.len_utf16() };
        }
        end
    }

    /// A byte as line and column from 0.
    pub fn place(&self, byte: usize) -> (usize, usize) {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        let line = self.lines.partition_point(|start| *start <= byte).saturating_sub(1);
        let before = &self.text[self.lines[line]..byte];
        (line, if self.plain { before.len() } else { before.encode_utf16().count() })
    }

    /// A stretch as the editor writes it.
    pub fn range(&self, span: Span) -> Value {
        let position = |byte: u32| {
            let (line, character) = self.place(byte as usize);
            json!({ "line": line, "character": character })
        };
        json!({ "start": position(span.start), "end": position(span.end) })
    }

    /// A stretch of the text.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// How many columns a stretch of one line has.
    pub fn width(&self, text: &str) -> usize {
        if self.plain { text.len() } else { text.encode_utf16().count() }
    }

    /// First byte of the line behind a byte; the end of the text behind the last line.
    pub fn next_line(&self, byte: usize) -> usize {
        let next = self.lines.partition_point(|start| *start <= byte);
        self.lines.get(next).copied().unwrap_or(self.text.len())
    }
}

/// The path of a `file:` address.
pub fn path_of(uri: &str) -> Option<PathBuf> {
    let rest = uri.strip_prefix("file://")?;
    let rest = &rest[rest.find('/')?..];
    let mut bytes = Vec::with_capacity(rest.len());
    let mut letters = rest.bytes();
    while let Some(b) = letters.next() {
        let hex = |b: Option<u8>| b.and_then(|b| (b as char).to_digit(16));
        match b {
            b'%' => bytes.push((hex(letters.next())? * 16 + hex(letters.next())?) as u8),
            _ => bytes.push(b),
        }
    }
    let path = String::from_utf8(bytes).ok()?;
    // `/c:/models` is `c:/models` where disks have letters.
    let disk = cfg!(windows) && path.as_bytes().get(2) == Some(&b':');
    Some(PathBuf::from(if disk { &path[1..] } else { &path }))
}

/// The `file:` address of a path.
pub fn uri_of(path: &Path) -> String {
    let mut out = String::from("file://");
    let text = path.to_string_lossy().replace('\\', "/");
    if !text.starts_with('/') {
        out.push('/');
    }
    for b in text.bytes() {
        match b {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' => out.push(b as char),
            _ => out.push_str(&format!("%{b:02X}")),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_what_was_agreed_on() {
        let wide = Document::new("file:///a.loft", "let 지붕 = \"𝄞\" + x\nlet b".to_owned(), 1, false);
        let x = wide.text.find("x\n").unwrap_or(0);
        assert_eq!(wide.place(x), (0, 16));
        assert_eq!(wide.byte(&json!({ "line": 0, "character": 16 })), x);
        assert_eq!(wide.byte(&json!({ "line": 9, "character": 0 })), wide.text.len());
        let bytes = Document::new("file:///a.loft", wide.text.clone(), 1, true);
        assert_eq!(bytes.place(x), (0, x));
    }

    #[test]
    fn all_line_ends_of_editors_count() {
        let document = Document::new("file:///a.loft", "a\r\nb\rc\n😀d".to_owned(), 1, false);
        let at = |line: u64, character: u64| document.byte(&json!({ "line": line, "character": character }));
        // Nothing is put between the two letters of a line end, or inside a letter.
        assert_eq!([at(0, 9), at(1, 0), at(1, 9), at(2, 0), at(3, 1), at(3, 2), at(3, 9)], [1, 3, 4, 5, 11, 11, 12]);
        assert_eq!([document.place(5), document.place(9), document.place(11)], [(2, 0), (3, 0), (3, 2)]);
    }

    #[test]
    fn addresses_and_paths_are_turned_into_each_other() {
        let path = Path::new("/models/hall 1/지붕.loft");
        assert_eq!(path_of(&uri_of(path)).as_deref(), Some(path));
        assert_eq!(path_of("untitled:1"), None);
    }

    #[test]
    fn changes_are_taken_over_in_place() {
        let mut document = Document::new("file:///a.loft", "let a = 1\nlet b = 2\n".to_owned(), 1, false);
        let range = json!({ "start": { "line": 1, "character": 8 }, "end": { "line": 1, "character": 9 } });
        document.change(&json!({ "range": range, "text": "a +\n3" }));
        assert_eq!(document.text, "let a = 1\nlet b = a +\n3\n");
        assert_eq!(document.place(document.text.len()), (3, 0));
    }
}
