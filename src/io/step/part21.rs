//! The clear text of STEP files (ISO 10303-21): bytes to records, without a copy of anything.
//!
//! A record is an entity with its parameters as tokens, each a span of the file. Records that break the grammar are left out with a
//! warning, and reading goes on behind them. Time and memory follow the size of the file.

use std::cell::OnceCell;

use crate::base::job;
use crate::io::files::fault::Malformed;
use crate::io::step::line_index::Places;
use crate::io::step::records::{File, Piece, Record, Token, TokenKind};

/// Lists inside each other.
const NESTED: usize = 256;
/// Bytes read again behind damaged records, for each byte of the file.
const READ_AGAIN: usize = 4;

/// Reads a file, or says why it is none.
pub fn read(bytes: &[u8]) -> Result<File<'_>, Malformed> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    crate::io::step::file_check::check(bytes)?;
    let mut reader = Part21Reader { bytes, at: 0, tokens: Vec::with_capacity(bytes.len() / 6), pieces: Vec::new(), open: Vec::new() };
    let (mut records, mut wrong) = (Vec::with_capacity(bytes.len() / 64), Vec::new());
    let mut again = READ_AGAIN * bytes.len();
    let (mut sections, mut ended) = (0, false);
    while reader.enter_data() {
        sections += 1;
        ended = reader.section(&mut records, &mut wrong, &mut again);
    }
    let Part21Reader { tokens, pieces, at, .. } = reader;
    let lines = OnceCell::new();
    let mut file = File { bytes, tokens, records, pieces, places: Places::default(), lines, warnings: Vec::new() };
    if sections == 0 {
        return Err(Malformed::line(file.line_of(at as u32), "the file has no DATA section"));
    }
    let mut warnings: Vec<Malformed> = wrong.into_iter().map(|(at, what)| Malformed::line(file.line_of(at), what)).collect();
    if !ended {
        warnings.push(Malformed::line(file.line_of(bytes.len() as u32), "the file ends before ENDSEC: its end may be missing"));
    }
    file.number(&mut warnings);
    file.warnings = warnings;
    Ok(file)
}

/// What is wrong at a byte.
type Wrong = (u32, String);

struct Part21Reader<'b> {
    bytes: &'b [u8],
    at: usize,
    tokens: Vec<Token>,
    pieces: Vec<Piece>,
    /// Lists that are not closed yet.
    open: Vec<u32>,
}

/// Where a byte stands first.
fn position(wanted: u8, bytes: &[u8]) -> Option<usize> {
    bytes.iter().position(|c| *c == wanted)
}

fn is_word(c: u8) -> bool {
    c.is_ascii_alphanumeric() || c == b'_'
}

impl<'b> Part21Reader<'b> {
    fn peek(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or(0)
    }

    /// Goes over blanks, comments and print controls.
    fn skip(&mut self) {
        loop {
            match self.peek() {
                b' ' | b'\n' | b'\r' | b'\t' | 0x0B | 0x0C => self.at += 1,
                b'/' if self.bytes.get(self.at + 1) == Some(&b'*') => {
                    let rest = &self.bytes[self.at + 2..];
                    self.at = rest.windows(2).position(|w| w == b"*/").map_or(self.bytes.len(), |n| self.at + n + 4);
                }
                b'\\' if matches!(self.bytes.get(self.at..self.at + 3), Some(b"\\N\\" | b"\\F\\")) => self.at += 3,
                _ => return,
            }
        }
    }

    fn word(&mut self) -> (u32, u32) {
        let from = self.at;
        while is_word(self.peek()) || (self.at == from && self.peek() == b'!') {
            self.at += 1;
        }
        (from as u32, self.at as u32)
    }

    /// Goes behind the head of the next DATA section.
    fn enter_data(&mut self) -> bool {
        while self.at < self.bytes.len() {
            job::poll();
            self.skip();
            let (a, b) = self.word();
            if &self.bytes[a as usize..b as usize] == b"DATA" {
                self.skip();
                while !matches!(self.peek(), b';' | 0) {
                    self.over();
                }
                self.at += 1;
                return true;
            }
            if a == b {
                self.over();
            }
        }
        false
    }

    /// Goes over one byte, or one text.
    fn over(&mut self) {
        let quoted = self.peek() == b'\'';
        self.at += 1;
        if quoted {
            self.at = position(b'\'', &self.bytes[self.at.min(self.bytes.len())..]).map_or(self.bytes.len(), |n| self.at + n + 1);
        }
    }

    /// The records up to ENDSEC; whether it was there.
    fn section(&mut self, records: &mut Vec<Record>, wrong: &mut Vec<Wrong>, again: &mut usize) -> bool {
        loop {
            if records.len().is_multiple_of(1024) {
                job::poll();
            }
            self.skip();
            match self.peek() {
                b'#' => {}
                0 if self.at >= self.bytes.len() => return false,
                b'E' if self.bytes[self.at..].starts_with(b"ENDSEC") => {
                    self.at += b"ENDSEC".len();
                    return true;
                }
                b';' => {
                    self.at += 1;
                    continue;
                }
                _ => {
                    wrong.push((self.at as u32, "an entity is expected here, `#1 = NAME(…);`".to_owned()));
                    self.behind(self.at);
                    continue;
                }
            }
            let (from, tokens, pieces) = (self.at, self.tokens.len(), self.pieces.len());
            match self.record() {
                Ok(id) => records.push(Record { id, at: from as u32, first: pieces as u32, last: self.pieces.len() as u32 }),
                Err((at, what)) => {
                    wrong.push((at, what));
                    self.tokens.truncate(tokens);
                    self.pieces.truncate(pieces);
                    // A missing quote must not take what comes after it.
                    let read = self.at - from;
                    let back = read <= *again;
                    *again = again.saturating_sub(read);
                    self.behind(if back { from } else { self.at });
                }
            }
        }
    }

    /// Goes to the next place behind a semicolon where an entity or the end of the section stands, or to a line that begins with one.
    fn behind(&mut self, from: usize) {
        self.at = (from + 1).min(self.bytes.len());
        while let Some(n) = self.bytes[self.at..].iter().position(|c| matches!(c, b';' | b'\n' | b'\r')) {
            let is_line = self.bytes[self.at + n] != b';';
            self.at += n + 1;
            self.skip();
            if if is_line { self.is_head() } else { matches!(self.peek(), b'#' | b'E' | 0) } {
                return;
            }
        }
        self.at = self.bytes.len();
    }

    /// Whether `#1 =` stands here.
    fn is_head(&self) -> bool {
        let Some(rest) = self.bytes[self.at..].strip_prefix(b"#") else { return false };
        let digits = rest.iter().take_while(|c| c.is_ascii_digit()).count();
        digits > 0 && rest[digits..].trim_ascii_start().first() == Some(&b'=')
    }

    fn fail<T>(&self, what: impl Into<String>) -> Result<T, Wrong> {
        Err((self.at.min(self.bytes.len()) as u32, what.into()))
    }

    fn id(&mut self) -> Result<u32, Wrong> {
        let from = self.at + 1;
        self.at = from;
        let mut id = 0_u32;
        while self.peek().is_ascii_digit() {
            let next = id.checked_mul(10).and_then(|n| n.checked_add(u32::from(self.peek() - b'0')));
            let Some(next) = next.filter(|n| *n != Token::NONE) else { return self.fail("the number of an entity is too large") };
            id = next;
            self.at += 1;
        }
        if self.at == from { self.fail("a `#` has no number behind it") } else { Ok(id) }
    }

    fn record(&mut self) -> Result<u32, Wrong> {
        let id = self.id()?;
        self.skip();
        if self.peek() != b'=' {
            return self.fail(format!("#{id} has no `=`"));
        }
        self.at += 1;
        self.skip();
        // A name of a scope stands before the list in old files.
        if self.peek() == b'(' {
            self.at += 1;
            loop {
                self.skip();
                match self.peek() {
                    b')' => break,
                    c if is_word(c) || c == b'!' => self.piece()?,
                    _ => return self.fail(format!("#{id} is a complex entity whose names cannot be read")),
                }
            }
            self.at += 1;
        } else {
            self.piece().map_err(|(at, what)| (at, format!("#{id}: {what}")))?;
        }
        self.skip();
        if self.peek() != b';' {
            return self.fail(format!("#{id} does not end in `;`"));
        }
        self.at += 1;
        Ok(id)
    }

    /// A name and its parameters.
    fn piece(&mut self) -> Result<(), Wrong> {
        let name = self.word();
        if name.0 == name.1 {
            return self.fail("it has no name");
        }
        self.skip();
        if self.peek() != b'(' {
            return self.fail("its name has no `(` behind it");
        }
        self.at += 1;
        let first = self.tokens.len() as u32;
        self.open.clear();
        self.values()?;
        self.pieces.push(Piece { name, tokens: (first, self.tokens.len() as u32) });
        Ok(())
    }

    fn put(&mut self, kind: TokenKind, start: usize, end: usize) {
        self.tokens.push(Token { kind, start: start as u32, end: end as u32 });
    }

    /// Values up to the bracket that closes the list.
    fn values(&mut self) -> Result<(), Wrong> {
        let mut wants_value = true;
        loop {
            self.skip();
            let from = self.at;
            let c = self.peek();
            if c == b')' {
                self.at += 1;
                let end = self.tokens.len() as u32;
                match self.open.pop() {
                    Some(list) => self.tokens[list as usize].end = end,
                    None => return Ok(()),
                }
                wants_value = false;
                continue;
            }
            if c == b',' {
                if wants_value {
                    return self.fail("a value is missing before a comma");
                }
                self.at += 1;
                wants_value = true;
                continue;
            }
            if !wants_value {
                return self.fail("a comma is missing between two values");
            }
            wants_value = false;
            match c {
                b'#' => {
                    let id = self.id()?;
                    self.tokens.push(Token { kind: TokenKind::Ref, start: id, end: Token::NONE });
                }
                b'+' | b'-' | b'.' | b'0'..=b'9' if c != b'.' || self.bytes.get(from + 1).is_some_and(u8::is_ascii_digit) => {
                    self.at += 1;
                    while matches!(self.peek(), b'0'..=b'9' | b'.' | b'E' | b'e' | b'+' | b'-') {
                        self.at += 1;
                    }
                    self.put(TokenKind::Number, from, self.at);
                }
                b'.' => {
                    self.at += 1;
                    self.word();
                    if self.peek() != b'.' {
                        return self.fail("an enumeration has no dot behind it");
                    }
                    self.put(TokenKind::Enum, from + 1, self.at);
                    self.at += 1;
                }
                b'\'' => self.quoted()?,
                b'"' => {
                    let end = position(b'"', &self.bytes[from + 1..]);
                    let Some(n) = end else { return self.fail("a binary value does not end") };
                    self.put(TokenKind::Binary, from + 1, from + 1 + n);
                    self.at = from + n + 2;
                }
                b'$' | b'*' => {
                    self.at += 1;
                    self.put(if c == b'$' { TokenKind::Omitted } else { TokenKind::Derived }, from, self.at);
                }
                b'(' => {
                    self.at += 1;
                    self.opened(TokenKind::List, from)?;
                    wants_value = true;
                }
                c if is_word(c) || c == b'!' => {
                    self.word();
                    self.skip();
                    if self.peek() != b'(' {
                        return self.fail("a value is a bare word");
                    }
                    self.at += 1;
                    self.opened(TokenKind::Typed, from)?;
                    wants_value = true;
                }
                0 if from >= self.bytes.len() => return self.fail("the file ends within it"),
                _ => return self.fail("a value cannot be read"),
            }
        }
    }

    fn opened(&mut self, kind: TokenKind, at: usize) -> Result<(), Wrong> {
        if self.open.len() >= NESTED {
            return self.fail(format!("more than {NESTED} lists are nested"));
        }
        self.open.push(self.tokens.len() as u32);
        self.put(kind, at, 0);
        Ok(())
    }

    /// A text; two quotes in it stand for one.
    fn quoted(&mut self) -> Result<(), Wrong> {
        let from = self.at + 1;
        let mut at = from;
        while let Some(n) = position(b'\'', &self.bytes[at..]) {
            at += n + 1;
            if self.bytes.get(at) != Some(&b'\'') {
                self.put(TokenKind::Text, from, at - 1);
                self.at = at;
                return Ok(());
            }
            at += 1;
        }
        self.at = self.bytes.len();
        self.fail("a text does not end")
    }
}
