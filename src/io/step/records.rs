//! Records of a STEP file: entities with their names, and their parameters as tokens, each a span of the file.

use std::cell::OnceCell;

use crate::base::job;
use crate::io::files::fault::Malformed;
use crate::io::step::line_index::{Lines, Places};

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// A number; the span is its text.
    Number,
    /// A text; the span is what stands between the quotes.
    Text,
    /// An enumeration; the span is what stands between the dots.
    Enum,
    /// Hexadecimal digits.
    Binary,
    /// `#17`: the start is the number, the end the index of the record or [`Token::NONE`].
    Ref,
    /// `$`.
    Omitted,
    /// `*`.
    Derived,
    /// A list; the end is the index of the token behind it.
    List,
    /// A list with a name before it: the start is where the name stands, the end the index of the token behind the list.
    Typed,
}

/// A value of a parameter list.
#[derive(Clone, Copy, Debug)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// First byte.
    pub start: u32,
    /// Byte behind the last one.
    pub end: u32,
}

impl Token {
    /// The record of a reference to nothing.
    pub const NONE: u32 = u32::MAX;
}

/// An entity: its names and parameter lists are parts `first..last`, one but for complex entities.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    /// Its number.
    pub id: u32,
    /// Byte where it starts.
    pub at: u32,
    pub(super) first: u32,
    pub(super) last: u32,
}

/// A name with its parameter list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(super) name: (u32, u32),
    pub(super) tokens: (u32, u32),
}

/// The records of a file.
#[derive(Debug)]
pub struct File<'b> {
    /// All of it.
    pub bytes: &'b [u8],
    /// Values of all records.
    pub tokens: Vec<Token>,
    /// Entities in file order.
    pub records: Vec<Record>,
    pub(super) pieces: Vec<Piece>,
    pub(super) places: Places,
    pub(super) lines: OnceCell<Lines>,
    /// What could not be read.
    pub warnings: Vec<Malformed>,
}

impl<'b> File<'b> {
    /// Sorts the numbers and follows references to records.
    pub(super) fn number(&mut self, warnings: &mut Vec<Malformed>) {
        let (places, doubled) = Places::of(self.records.iter().map(|r| r.id));
        for k in doubled {
            let record = self.records[k as usize];
            let what = format!("#{} is defined again; the first definition is used", record.id);
            warnings.push(Malformed::line(self.line_of(record.at), what));
        }
        self.places = places;
        for token in job::looking(&mut self.tokens) {
            if token.kind == TokenKind::Ref {
                token.end = self.places.find(token.start).unwrap_or(Token::NONE);
            }
        }
    }

    /// The line of a byte, from 1.
    pub fn line_of(&self, at: u32) -> u64 {
        self.lines.get_or_init(|| Lines::of(self.bytes)).of_byte(at)
    }

    /// The line of a record.
    pub fn line(&self, k: u32) -> u64 {
        self.records.get(k as usize).map_or(0, |r| self.line_of(r.at))
    }

    /// Its number.
    pub fn id(&self, k: u32) -> u32 {
        self.records.get(k as usize).map_or(0, |r| r.id)
    }

    pub(super) fn pieces_of(&self, k: u32) -> &[Piece] {
        self.records.get(k as usize).map_or(&[], |r| &self.pieces[r.first as usize..r.last as usize])
    }

    pub(super) fn text(&self, (a, b): (u32, u32)) -> &'b [u8] {
        &self.bytes[a as usize..b as usize]
    }

    /// The name of a simple entity; the first one of a complex entity.
    pub fn name(&self, k: u32) -> &'b [u8] {
        self.pieces_of(k).first().map_or(&[], |p| self.text(p.name))
    }

    /// All names of an entity.
    pub fn names(&self, k: u32) -> impl Iterator<Item = &'b [u8]> {
        self.pieces_of(k).iter().map(|p| self.text(p.name))
    }

    /// Whether one of its names is this one.
    pub fn is(&self, k: u32, name: &[u8]) -> bool {
        self.names(k).any(|n| n == name)
    }

    /// The entities that it refers to.
    pub fn references(&self, k: u32) -> impl Iterator<Item = u32> {
        let tokens = self.pieces_of(k).iter().flat_map(|p| &self.tokens[p.tokens.0 as usize..p.tokens.1 as usize]);
        tokens.filter(|t| t.kind == TokenKind::Ref && t.end != Token::NONE).map(|t| t.end)
    }

    /// Whether it is written with several names.
    pub fn is_complex(&self, k: u32) -> bool {
        self.pieces_of(k).len() > 1
    }
}
