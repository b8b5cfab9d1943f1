//! Text to tokens: one pass over the bytes that never fails.
//!
//! What cannot be a token is reported and leaves a token all the same, so that the splitter sees where declarations
//! begin. Kinds, places and line starts lie in arrays of their own: the kinds of a declaration are the key under
//! which its shape is remembered.

use unicode_ident::{is_xid_continue, is_xid_start};

use crate::base::limits::NESTED_BRACKETS;
use crate::base::text::is_unseen;
use crate::lang::diag::span::Span;
use crate::lang::syntax::mistake::Mistake;
use crate::lang::syntax::number;
use crate::lang::syntax::token::{Kind, kind_of_word};

/// The tokens of a file.
#[derive(Debug, Default)]
pub(crate) struct Tokens {
    pub kinds: Vec<Kind>,
    pub starts: Vec<u32>,
    pub ends: Vec<u32>,
    /// Whether the token is the first of its line.
    pub first: Vec<bool>,
    /// `///` lines: the token they stand before and their stretch without the slashes.
    pub docs: Vec<(u32, Span)>,
    /// Comments other than `///`, in order.
    pub comments: Vec<Span>,
    /// What is wrong with single tokens.
    pub mistakes: Vec<Mistake>,
    /// Where a comment that never ends begins: what is wrong behind it says nothing.
    pub quiet_from: Option<u32>,
}

impl Tokens {
    /// Number of tokens.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Place of a token.
    pub fn span(&self, token: usize) -> Span {
        Span { start: self.starts[token], end: self.ends[token] }
    }

    /// From the first to the last of two tokens.
    pub fn stretch(&self, first: usize, last: usize) -> Span {
        Span { start: self.starts[first], end: self.ends[last] }
    }
}

/// An open `{` of a string: where the string began and how many `{` are open inside.
struct Interpolation {
    quote: u32,
    curly: u32,
}

struct Scanner<'a> {
    source: &'a str,
    bytes: &'a [u8],
    at: usize,
    fresh: bool,
    open: Vec<Interpolation>,
    tokens: Tokens,
}

/// The ASCII letters and digits and `_`.
static IN_WORD: [bool; 256] = {
    let (mut table, mut byte) = ([false; 256], 0);
    while byte < 128 {
        table[byte] = (byte as u8).is_ascii_alphanumeric() || byte as u8 == b'_';
        byte += 1;
    }
    table
};

/// Cuts a source of at most 32 MiB into tokens.
pub(crate) fn scan(source: &str) -> Tokens {
    let guess = source.len() / 3 + 8;
    let tokens = Tokens {
        kinds: Vec::with_capacity(guess),
        starts: Vec::with_capacity(guess),
        ends: Vec::with_capacity(guess),
        first: Vec::with_capacity(guess),
        ..Tokens::default()
    };
    let mut scanner = Scanner { source, bytes: source.as_bytes(), at: 0, fresh: true, open: Vec::new(), tokens };
    if source.starts_with('\u{feff}') {
        scanner.at = 3;
    }
    while scanner.at < scanner.bytes.len() {
        scanner.token();
    }
    scanner.close_interpolations();
    scanner.tokens
}

impl Scanner<'_> {
    fn peek(&self, ahead: usize) -> u8 {
        self.bytes.get(self.at + ahead).copied().unwrap_or(0)
    }

    fn push(&mut self, kind: Kind, start: usize) {
        self.tokens.kinds.push(kind);
        self.tokens.starts.push(start as u32);
        self.tokens.ends.push(self.at as u32);
        self.tokens.first.push(self.fresh);
        self.fresh = false;
    }

    fn sign(&mut self, kind: Kind, bytes: usize) {
        let start = self.at;
        self.at += bytes;
        self.push(kind, start);
    }

    fn mistake(&mut self, mistake: Mistake) {
        self.tokens.mistakes.push(mistake);
    }

    fn span_from(&self, start: usize) -> Span {
        Span { start: start as u32, end: self.at as u32 }
    }

    fn token(&mut self) {
        let next = self.peek(1);
        match self.bytes[self.at] {
            b' ' | b'\t' | b'\r' => self.at += 1,
            b'\n' => self.new_line(),
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => self.word(),
            b'0'..=b'9' => self.number(),
            b'"' => self.string(),
            b'/' if next == b'/' => self.line_comment(),
            b'/' if next == b'*' => self.block_comment(),
            b'(' if self.fresh => self.sign(Kind::LineRound, 1),
            b'(' => self.sign(Kind::OpenRound, 1),
            b')' => self.sign(Kind::CloseRound, 1),
            b'[' if self.fresh => self.sign(Kind::LineSquare, 1),
            b'[' => self.sign(Kind::OpenSquare, 1),
            b']' => self.sign(Kind::CloseSquare, 1),
            b'{' => self.open_curly(),
            b'}' => self.close_curly(),
            b',' => self.sign(Kind::Comma, 1),
            b':' => self.sign(Kind::Colon, 1),
            b'=' if next == b'=' => self.sign(Kind::EqualEqual, 2),
            b'=' if next == b'>' => self.strange(2),
            b'=' => self.sign(Kind::Equals, 1),
            b'.' if next == b'.' => self.sign(Kind::DotDot, 2),
            b'.' if next.is_ascii_digit() => self.leading_dot(),
            b'.' => self.sign(Kind::Dot, 1),
            b'+' => self.sign(Kind::Plus, 1),
            b'-' if next == b'>' => self.strange(2),
            b'-' => self.sign(Kind::Minus, 1),
            b'*' if next == b'*' => self.strange(2),
            b'*' => self.sign(Kind::Star, 1),
            b'/' => self.sign(Kind::Slash, 1),
            b'^' => self.sign(Kind::Caret, 1),
            b'&' if next == b'&' => self.strange(2),
            b'&' => self.sign(Kind::And, 1),
            b'|' if next == b'|' => self.strange(2),
            b'!' if next == b'=' => self.sign(Kind::NotEqual, 2),
            b'<' if next == b'=' => self.sign(Kind::LessEqual, 2),
            b'<' => self.sign(Kind::Less, 1),
            b'>' if next == b'=' => self.sign(Kind::GreaterEqual, 2),
            b'>' => self.sign(Kind::Greater, 1),
            byte if byte.is_ascii() => self.strange(1),
            _ => self.wide(),
        }
    }

    fn new_line(&mut self) {
        self.close_interpolations();
        self.at += 1;
        self.fresh = true;
    }

    /// A string ends on its line, so do the values in it.
    fn close_interpolations(&mut self) {
        if let Some(outer) = self.open.first() {
            let span = Span { start: outer.quote, end: self.line_end() as u32 };
            self.mistake(Mistake::OpenString { span, inside: true });
            self.open.clear();
        }
    }

    /// End of the line that `at` stands on or just behind, without the carriage return.
    fn line_end(&self) -> usize {
        let end = self.bytes[self.at..].iter().position(|&b| b == b'\n').map_or(self.bytes.len(), |n| self.at + n);
        if end > 0 && self.bytes[end - 1] == b'\r' { end - 1 } else { end }
    }

    /// Moves over a word; ASCII first, the rest by the Unicode tables.
    fn skip_word(&mut self) {
        loop {
            let rest = &self.bytes[self.at..];
            let ascii = rest.iter().position(|byte| !IN_WORD[usize::from(*byte)]).unwrap_or(rest.len());
            self.at += ascii;
            match rest.get(ascii) {
                Some(byte) if !byte.is_ascii() => match self.source[self.at..].chars().next() {
                    Some(c) if is_xid_continue(c) && !is_unseen(c) => self.at += c.len_utf8(),
                    _ => return,
                },
                _ => return,
            }
        }
    }

    fn word(&mut self) {
        let start = self.at;
        self.skip_word();
        let kind = kind_of_word(&self.source[start..self.at]);
        self.push(kind, start);
    }

    /// A character beyond ASCII: a word, or nothing that belongs here.
    fn wide(&mut self) {
        let Some(c) = self.source[self.at..].chars().next() else { return };
        if is_xid_start(c) && !is_unseen(c) { self.word() } else { self.strange(c.len_utf8()) }
    }

    fn strange(&mut self, bytes: usize) {
        let start = self.at;
        self.at += bytes;
        self.push(Kind::Strange, start);
        let span = self.span_from(start);
        self.mistake(Mistake::StrangeSign { span });
    }

    fn number(&mut self) {
        let start = self.at;
        let read = number::read(self.source, start);
        self.at = read.end;
        self.push(if read.unit_start < read.end { Kind::Quantity } else { Kind::Number }, start);
        if let Some(fault) = read.fault {
            let span = self.span_from(start);
            self.mistake(Mistake::BadNumber { span, unit: read.unit_start as u32, fault });
        }
    }

    /// `.5` where a number is meant; `a.5` is left to the grammar.
    fn leading_dot(&mut self) {
        let after_operand =
            self.tokens.kinds.last().is_some_and(|k| k.ends_operand()) && self.tokens.ends.last() == Some(&(self.at as u32));
        if after_operand {
            return self.sign(Kind::Dot, 1);
        }
        let start = self.at;
        self.at = number::read(self.source, start + 1).end;
        self.push(Kind::Number, start);
        let span = self.span_from(start);
        self.mistake(Mistake::BadNumber { span, unit: span.end, fault: number::Fault::LeadingDot });
    }

    fn string(&mut self) {
        let start = self.at;
        self.at += 1;
        let kind = self.string_stretch(start, start as u32, Kind::TextHead, Kind::Text);
        self.push(kind, start);
    }

    /// Moves to the end of a stretch of a string; `quote` is where the string began.
    fn string_stretch(&mut self, start: usize, quote: u32, opens: Kind, ends: Kind) -> Kind {
        while self.at < self.bytes.len() {
            match self.bytes[self.at] {
                b'"' => {
                    self.at += 1;
                    return ends;
                }
                b'{' => {
                    self.at += 1;
                    self.open.push(Interpolation { quote, curly: 0 });
                    return opens;
                }
                b'\n' => break,
                b'\\' => self.escape(),
                _ => self.at += 1,
            }
        }
        if self.at > start && self.bytes[self.at - 1] == b'\r' {
            self.at -= 1;
        }
        let span = Span { start: quote, end: self.at as u32 };
        self.mistake(Mistake::OpenString { span, inside: false });
        self.open.clear();
        ends
    }

    fn escape(&mut self) {
        let start = self.at;
        self.at += 1;
        match self.peek(0) {
            b'"' | b'\\' | b'n' | b'{' => self.at += 1,
            b'u' if self.peek(1) == b'{' => {
                self.at += 2;
                let digits = self.at;
                while self.peek(0).is_ascii_hexdigit() {
                    self.at += 1;
                }
                let value = u32::from_str_radix(&self.source[digits..self.at], 16).ok().filter(|_| self.at - digits <= 6);
                let closed = self.peek(0) == b'}';
                self.at += usize::from(closed);
                if !closed || value.and_then(char::from_u32).is_none() {
                    let span = self.span_from(start);
                    self.mistake(Mistake::BadEscape { span });
                }
            }
            b'\n' | b'\r' | 0 => {
                let span = self.span_from(start);
                self.mistake(Mistake::BadEscape { span });
            }
            _ => {
                self.at += self.source[self.at..].chars().next().map_or(0, char::len_utf8);
                let span = self.span_from(start);
                self.mistake(Mistake::BadEscape { span });
            }
        }
    }

    fn open_curly(&mut self) {
        if let Some(last) = self.open.last_mut() {
            last.curly += 1;
        }
        self.sign(Kind::OpenCurly, 1);
    }

    fn close_curly(&mut self) {
        match self.open.last_mut() {
            Some(last) if last.curly == 0 => {
                let (start, quote) = (self.at, last.quote);
                self.open.pop();
                self.at += 1;
                let kind = self.string_stretch(start, quote, Kind::TextMid, Kind::TextTail);
                self.push(kind, start);
            }
            Some(last) => {
                last.curly -= 1;
                self.sign(Kind::CloseCurly, 1);
            }
            None => self.sign(Kind::CloseCurly, 1),
        }
    }

    fn line_comment(&mut self) {
        let start = self.at;
        self.at = self.bytes[start..].iter().position(|&b| b == b'\n').map_or(self.bytes.len(), |n| start + n);
        let end = if self.bytes[self.at - 1] == b'\r' { self.at - 1 } else { self.at };
        let documents = self.fresh && self.bytes[start..].starts_with(b"///") && !self.bytes[start..].starts_with(b"////");
        if documents {
            let next = self.tokens.len() as u32;
            self.tokens.docs.push((next, Span { start: start as u32 + 3, end: end as u32 }));
        } else {
            self.tokens.comments.push(Span { start: start as u32, end: end as u32 });
        }
    }

    fn block_comment(&mut self) {
        let start = self.at;
        let (mut depth, mut lines) = (0usize, false);
        while self.at < self.bytes.len() {
            match (self.bytes[self.at], self.peek(1)) {
                (b'/', b'*') => {
                    depth += 1;
                    self.at += 2;
                    if depth == NESTED_BRACKETS + 1 {
                        let span = Span { start: self.at as u32 - 2, end: self.at as u32 };
                        self.mistake(Mistake::DeepComment { span });
                    }
                }
                (b'*', b'/') => {
                    depth -= 1;
                    self.at += 2;
                    if depth == 0 {
                        break;
                    }
                }
                (byte, _) => {
                    lines |= byte == b'\n';
                    self.at += 1;
                }
            }
        }
        if depth > 0 {
            let span = Span { start: start as u32, end: start as u32 + 2 };
            self.mistake(Mistake::OpenComment { span });
            self.tokens.quiet_from.get_or_insert(start as u32);
            self.at = self.bytes[start..].iter().position(|&b| b == b'\n').map_or(self.bytes.len(), |n| start + n);
            return;
        }
        let span = self.span_from(start);
        self.tokens.comments.push(span);
        if lines {
            if let Some(outer) = self.open.first() {
                let end = self.source[start..].find('\n').map_or(self.at, |n| start + n);
                let span = Span { start: outer.quote, end: end as u32 };
                self.mistake(Mistake::OpenString { span, inside: true });
                self.open.clear();
            }
            self.fresh = true;
        }
    }
}
