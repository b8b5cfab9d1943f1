//! What stands around a place: the operand before a dot, and the names that hold in its declaration alone.

use crate::lang::assist::scripts::{Locals, Scripts};
use crate::lang::assist::shape::KnownType;
use crate::lang::syntax::{Kind, Tokens, scan, split};
use crate::lang::values::types::Ty;

/// The first token of the operand that ends before `end`: names, fields, calls, indices.
pub(crate) fn operand(tokens: &Tokens, start: usize, end: usize) -> Option<usize> {
    let mut at = end.checked_sub(1).filter(|at| *at >= start)?;
    loop {
        let kind = tokens.kinds[at];
        let bound = |at: usize| at > start && tokens.kinds[at - 1].ends_operand();
        match kind {
            Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail => {
                let opener = opener(tokens, start, at)?;
                let call = tokens.kinds[opener] == Kind::OpenRound && opener > start && tokens.kinds[opener - 1] == Kind::Name;
                let index = tokens.kinds[opener] == Kind::OpenSquare && bound(opener);
                if !call && !index {
                    return Some(opener);
                }
                at = opener - 1;
            }
            Kind::Number | Kind::Quantity | Kind::Text | Kind::True | Kind::False => return Some(at),
            kind if kind == Kind::Name || kind.is_reserved() => {
                if at < start + 2 || tokens.kinds[at - 1] != Kind::Dot {
                    return (kind == Kind::Name).then_some(at);
                }
                at -= 2;
            }
            _ => return None,
        }
    }
}

/// The bracket that this one closes.
fn opener(tokens: &Tokens, start: usize, close: usize) -> Option<usize> {
    let mut depth = 0usize;
    for at in (start..=close).rev() {
        match tokens.kinds[at] {
            Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail => depth += 1,
            Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly | Kind::TextHead => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    return Some(at);
                }
            }
            _ => {}
        }
    }
    None
}

/// Names of `for`, `let … in` and parameters in the declaration around a place, also where these stand behind it.
pub(crate) fn locals(scripts: &Scripts<'_>, at: usize) -> Locals {
    let home = scripts.unit(0);
    let tokens = scan(&home.text);
    let (pieces, _) = split(&tokens);
    let mut out = Locals::new();
    let Some(piece) = pieces.iter().rev().find(|piece| (tokens.starts[piece.tokens.start] as usize) < at) else { return out };
    let (start, end) = (piece.tokens.start, piece.tokens.end);
    let text = |from: usize, to: usize| &home.text[tokens.starts[from] as usize..tokens.ends[to] as usize];
    let is = |at: usize, kind: Kind| at < end && tokens.kinds[at] == kind;
    for at in start + 1..end {
        if tokens.kinds[at] != Kind::Name {
            continue;
        }
        if is(at - 1, Kind::For) && is(at + 1, Kind::In) {
            let list = expression(&tokens, at + 2, end);
            let member = list.map(|last| scripts.shape_of_text(0, text(at + 2, last), &mut out).member());
            out.push((text(at, at).to_owned(), member.unwrap_or_default()));
        } else if at > start + 1 && is(at - 1, Kind::Let) && is(at + 1, Kind::Equals) {
            let value = expression(&tokens, at + 2, end).map(|last| scripts.shape_of_text(0, text(at + 2, last), &mut out));
            out.push((text(at, at).to_owned(), value.unwrap_or_default()));
        } else if is(start, Kind::Fn) && (is(at - 1, Kind::OpenRound) || is(at - 1, Kind::Comma)) {
            let before_body = !(start..at).any(|k| is(k, Kind::Equals) && depth(&tokens, start, k) == 0);
            if before_body && depth(&tokens, start, at) == 1 {
                out.push((text(at, at).to_owned(), parameter(&tokens, at, end, &text)));
            }
        }
    }
    out
}

/// The type that is written behind a parameter.
fn parameter<'t>(tokens: &Tokens, at: usize, end: usize, text: &impl Fn(usize, usize) -> &'t str) -> KnownType {
    let is = |at: usize, kind: Kind| at < end && tokens.kinds[at] == kind;
    if !is(at + 1, Kind::Colon) {
        return KnownType::Unknown;
    }
    let lists = (at + 2..end).take_while(|k| matches!(tokens.kinds[*k], Kind::OpenSquare | Kind::LineSquare)).count();
    let name = at + 2 + lists;
    if name >= end {
        return KnownType::Unknown;
    }
    Ty::written(text(name, name), lists.min(2) as u8).map_or(KnownType::Unknown, KnownType::of)
}

/// How many brackets are open before a token.
fn depth(tokens: &Tokens, start: usize, at: usize) -> i64 {
    let step = |k: usize| match tokens.kinds[k] {
        Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly | Kind::TextHead => 1,
        Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail => -1,
        _ => 0,
    };
    (start..at).map(step).sum()
}

/// The last token of the expression that begins at a token and ends where a clause goes on.
fn expression(tokens: &Tokens, first: usize, end: usize) -> Option<usize> {
    let mut open = 0i64;
    for at in first..end {
        let kind = tokens.kinds[at];
        let ends =
            open == 0 && matches!(kind, Kind::Colon | Kind::If | Kind::For | Kind::Equals | Kind::Of | Kind::To | Kind::In | Kind::Comma);
        let closes = open == 0 && matches!(kind, Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail);
        let block = open == 0 && at > first && kind == Kind::OpenCurly;
        if ends || closes || block {
            return (at > first).then(|| at - 1);
        }
        open += depth(tokens, at, at + 1);
    }
    (end > first).then(|| end - 1)
}
