//! Values of parameter lists, with what is wrong with them in words.

use crate::io::cad::defect::{Defect, defect};
use crate::io::step::records::{File, Piece, Token, TokenKind};
use crate::io::step::strings::decoded;

/// A parameter list or a list in one.
#[derive(Clone, Copy, Debug)]
pub struct Row<'f> {
    /// Where it stands.
    pub file: &'f File<'f>,
    /// First token.
    pub first: u32,
    /// Token behind the last one.
    pub end: u32,
}

/// One value.
#[derive(Clone, Copy, Debug)]
pub struct ParameterValue<'f> {
    row: Row<'f>,
    at: u32,
}

impl File<'_> {
    /// The parameters under a name.
    pub fn under(&self, k: u32, name: &[u8]) -> Option<Row<'_>> {
        self.pieces_of(k).iter().find(|p| self.text(p.name) == name).map(|p| self.row(p))
    }

    /// The parameters of a simple entity; those under the first name of a complex one.
    pub fn parameters(&self, k: u32) -> Row<'_> {
        self.pieces_of(k).first().map_or(Row { file: self, first: 0, end: 0 }, |p| self.row(p))
    }

    fn row(&self, piece: &Piece) -> Row<'_> {
        Row { file: self, first: piece.tokens.0, end: piece.tokens.1 }
    }
}

impl<'f> Row<'f> {
    /// Its values.
    pub fn values(self) -> impl Iterator<Item = ParameterValue<'f>> {
        let mut at = self.first;
        std::iter::from_fn(move || {
            (at < self.end).then(|| {
                let value = ParameterValue { row: self, at };
                at = value.behind();
                value
            })
        })
    }

    /// Value `k` from 0.
    pub fn get(self, k: usize) -> Option<ParameterValue<'f>> {
        self.values().nth(k)
    }

    fn value(self, k: usize) -> Result<ParameterValue<'f>, Defect> {
        self.get(k).ok_or_else(|| defect(format!("its parameter {} is missing", k + 1)))
    }

    /// The entity at `k`.
    pub fn entity(self, k: usize) -> Result<u32, Defect> {
        self.value(k)?.entity().map_err(|Defect(why)| defect(format!("its parameter {}: {why}", k + 1)))
    }

    /// The entity at `k`, none for `$` and `*`.
    pub fn maybe(self, k: usize) -> Result<Option<u32>, Defect> {
        match self.get(k) {
            Some(value) if !value.is_none() => value.entity().map(Some),
            _ => Ok(None),
        }
    }

    /// The entities of the list at `k`.
    pub fn entities(self, k: usize) -> Result<Vec<u32>, Defect> {
        self.list(k)?.values().map(ParameterValue::entity).collect::<Result<Vec<u32>, Defect>>()
    }

    /// The list at `k`.
    pub fn list(self, k: usize) -> Result<Row<'f>, Defect> {
        let value = self.value(k)?;
        value.list().ok_or_else(|| defect(format!("its parameter {} is not a list", k + 1)))
    }

    /// The number at `k`.
    pub fn number(self, k: usize) -> Result<f64, Defect> {
        self.value(k)?.number().map_err(|Defect(why)| defect(format!("its parameter {}: {why}", k + 1)))
    }

    /// The numbers of the list at `k`.
    pub fn numbers(self, k: usize) -> Result<Vec<f64>, Defect> {
        self.list(k)?.values().map(ParameterValue::number).collect()
    }

    /// The whole number from 0 at `k`.
    pub fn count(self, k: usize) -> Result<usize, Defect> {
        let x = self.number(k)?;
        if x >= 0.0 && x <= f64::from(u32::MAX) && x.trunc() == x {
            Ok(x as usize)
        } else {
            Err(defect(format!("{x} is not a valid count")))
        }
    }

    /// The truth value at `k`; what is unknown counts as `otherwise`.
    pub fn flag(self, k: usize, otherwise: bool) -> bool {
        match self.get(k).and_then(ParameterValue::word) {
            Some(b"T") => true,
            Some(b"F") => false,
            _ => otherwise,
        }
    }

    /// The text at `k`; empty for what is none.
    pub fn text(self, k: usize) -> String {
        self.get(k).and_then(ParameterValue::text).unwrap_or_default()
    }
}

impl<'f> ParameterValue<'f> {
    fn token(self) -> Token {
        self.row.file.tokens[self.at as usize]
    }

    fn behind(self) -> u32 {
        let token = self.token();
        if matches!(token.kind, TokenKind::List | TokenKind::Typed) { token.end.max(self.at + 1) } else { self.at + 1 }
    }

    fn span(self) -> &'f [u8] {
        let token = self.token();
        &self.row.file.bytes[token.start as usize..token.end as usize]
    }

    /// Whether it is `$` or `*`.
    pub fn is_none(self) -> bool {
        matches!(self.token().kind, TokenKind::Omitted | TokenKind::Derived)
    }

    /// The record it refers to.
    pub fn entity(self) -> Result<u32, Defect> {
        let token = self.token();
        match token.kind {
            TokenKind::Ref if token.end != Token::NONE => Ok(token.end),
            TokenKind::Ref => Err(defect(format!("there is no entity #{}", token.start))),
            _ => Err(defect("an entity is missing")),
        }
    }

    /// The list it is, with or without a name before it.
    pub fn list(self) -> Option<Row<'f>> {
        let token = self.token();
        matches!(token.kind, TokenKind::List | TokenKind::Typed).then(|| Row { first: self.at + 1, end: token.end, ..self.row })
    }

    /// The number it is, with or without a name before it.
    pub fn number(self) -> Result<f64, Defect> {
        match self.token().kind {
            TokenKind::Number => {
                let text = std::str::from_utf8(self.span()).unwrap_or_default();
                let x: Result<f64, _> = text.parse();
                match x {
                    Ok(x) if x.is_finite() => Ok(x),
                    Ok(_) => Err(defect(format!("the number {text} is too large"))),
                    Err(_) => Err(defect(format!("`{text}` is not a number"))),
                }
            }
            TokenKind::Typed => match self.list().and_then(|row| row.get(0)) {
                Some(inner) if inner.token().kind == TokenKind::Number => inner.number(),
                _ => Err(defect("a number is missing")),
            },
            _ => Err(defect("a number is missing")),
        }
    }

    /// The enumeration it is, without dots.
    pub fn word(self) -> Option<&'f [u8]> {
        (self.token().kind == TokenKind::Enum).then(|| self.span())
    }

    /// The text it is.
    pub fn text(self) -> Option<String> {
        match self.token().kind {
            TokenKind::Text => Some(decoded(self.span())),
            TokenKind::Typed => {
                self.list().and_then(|row| row.get(0)).filter(|v| v.token().kind == TokenKind::Text).map(|v| decoded(v.span()))
            }
            _ => None,
        }
    }
}
