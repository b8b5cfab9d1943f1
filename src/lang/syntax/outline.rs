//! A script as an editor sees it: its declarations as stretches of text, broken ones included, and whether it is
//! written to its end.

use std::ops::Range;

use crate::lang::diag::span::Span;
use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::mistake::Mistake;
use crate::lang::syntax::scan::{Tokens, scan};
use crate::lang::syntax::split::split;
use crate::lang::syntax::token::Kind;

/// One declaration as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outline {
    /// From its first to its last token.
    pub span: Span,
    /// With the comments above it and behind it on its last line; the stretches of a file follow each other without gap.
    pub whole: Span,
    /// What it starts with; `None` when that is no keyword.
    pub keyword: Option<Keyword>,
    /// Where the name stands that it binds.
    pub name: Option<Span>,
    /// Its brackets do not match.
    pub broken: bool,
}

/// The declarations of a text in order. Never fails; what is no declaration is one without keyword.
pub fn outline(source: &str) -> Vec<Outline> {
    let tokens = scan(source);
    let (pieces, _) = split(&tokens);
    let mut from = 0;
    let last = pieces.len().wrapping_sub(1);
    let entry = |(k, piece): (usize, crate::lang::syntax::split::Piece)| {
        let span = tokens.stretch(piece.tokens.start, piece.tokens.end - 1);
        let end = if k == last { source.len() as u32 } else { line_end(source, span.end, tokens.starts.get(piece.tokens.end).copied()) };
        let whole = Span { start: from, end };
        from = end;
        Outline {
            span,
            whole,
            keyword: tokens.kinds[piece.tokens.start].keyword(),
            name: name_of(&tokens, &piece.tokens),
            broken: piece.broken,
        }
    };
    pieces.into_iter().enumerate().map(entry).collect()
}

/// The byte behind the line end after `at`, but not beyond the next token.
fn line_end(source: &str, at: u32, next: Option<u32>) -> u32 {
    let limit = next.unwrap_or(source.len() as u32);
    let end = source[at as usize..].find('\n').map_or(source.len() as u32, |n| at + n as u32 + 1);
    // A comment that begins here may be longer than its line: then it goes with what follows.
    end.min(limit)
}

fn name_of(tokens: &Tokens, piece: &Range<usize>) -> Option<Span> {
    let kinds = &tokens.kinds[piece.clone()];
    let at = match kinds[0] {
        Kind::Modeling => 2,
        Kind::Use | Kind::Import => kinds.iter().rposition(|k| *k == Kind::As)? + 1,
        Kind::Param | Kind::Let | Kind::Fn | Kind::Point | Kind::Curve | Kind::Surface | Kind::Shell | Kind::Group | Kind::Mesh => 1,
        _ => return None,
    };
    (*kinds.get(at)? == Kind::Name).then(|| tokens.span(piece.start + at))
}

/// Whether more must follow before a text makes sense: an open bracket or comment, or a declaration that stops short.
pub fn is_unfinished(source: &str) -> bool {
    let tokens = scan(source);
    if tokens.quiet_from.is_some() {
        return true;
    }
    let (pieces, mistakes) = split(&tokens);
    if mistakes.iter().any(|m| matches!(m, Mistake::OpenBracket { ended: None, .. })) {
        return true;
    }
    let Some(piece) = pieces.last().filter(|piece| !piece.broken) else { return false };
    let kinds = &tokens.kinds[piece.tokens.clone()];
    let last = kinds[kinds.len() - 1];
    let hanging = matches!(last, Kind::Of | Kind::For | Kind::To | Kind::As | Kind::On | Kind::Near | Kind::Let);
    kinds[0].keyword().is_some() && (kinds.len() == 1 || hanging || last.wants_value())
}

/// What a stretch of a script is, for colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Paint {
    Keyword,
    Name,
    /// A name before `(`.
    Function,
    /// A name before `:` or after a dot.
    Property,
    Number,
    Text,
    Comment,
    Operator,
    Constant,
}

/// Stretches of a text with their colours, in order.
pub fn painted(source: &str) -> Vec<(Span, Paint)> {
    let tokens = scan(source);
    let kind = |k: usize| tokens.kinds.get(k).copied();
    let paint = |k: usize| match tokens.kinds[k] {
        Kind::Name => match (k.checked_sub(1).and_then(kind), kind(k + 1)) {
            (_, Some(Kind::OpenRound)) => Paint::Function,
            (Some(Kind::Dot), _) | (_, Some(Kind::Colon)) => Paint::Property,
            _ => Paint::Name,
        },
        Kind::Number | Kind::Quantity => Paint::Number,
        Kind::Text | Kind::TextHead | Kind::TextMid | Kind::TextTail => Paint::Text,
        Kind::True | Kind::False | Kind::None => Paint::Constant,
        kind if kind >= Kind::Units => match (k.checked_sub(1).map(|b| tokens.kinds[b]), tokens.kinds.get(k + 1)) {
            (Some(Kind::Dot), _) | (_, Some(Kind::Colon)) => Paint::Property,
            _ => Paint::Keyword,
        },
        _ => Paint::Operator,
    };
    let docs = tokens.docs.iter().map(|(_, span)| Span { start: span.start.saturating_sub(3), end: span.end });
    let mut out: Vec<(Span, Paint)> = (0..tokens.len()).map(|k| (tokens.span(k), paint(k))).collect();
    out.extend(tokens.comments.iter().copied().chain(docs).map(|span| (span, Paint::Comment)));
    out.sort_by_key(|(span, _)| span.start);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_cover_the_file() {
        let text =
            "// head\nunits m // metres\n\n/// The first.\ncurve a = line(A,\n  B) // end\nsurface s = coons(\ncurve k = s\n  // tail\n";
        let found = outline(text);
        let names: Vec<&str> = found.iter().map(|o| o.name.map_or("", |n| &text[n.start as usize..n.end as usize])).collect();
        assert_eq!(names, ["", "a", "s", "k"]);
        let joined: String = found.iter().map(|o| &text[o.whole.start as usize..o.whole.end as usize]).collect();
        assert_eq!(joined, text);
        assert_eq!(&text[found[1].whole.start as usize..found[1].whole.end as usize], "\n/// The first.\ncurve a = line(A,\n  B) // end\n");
        assert_eq!(found.iter().map(|o| o.broken).collect::<Vec<_>>(), [false, false, true, false]);
    }

    #[test]
    fn it_is_known_when_more_must_follow() {
        for text in [
            "curve a = line(",
            "curve a =",
            "let x = 1 +",
            "mesh m of roof {\n size: 2",
            "/* note",
            "shell s of",
            "curve",
            "check \"a\": x ==",
        ] {
            assert!(is_unfinished(text), "{text}");
        }
        for text in ["curve a = line(A, B)", "let x = (1))", "3 + 2mm", "", "let x = \"open", ":show a", "x -"] {
            assert!(!is_unfinished(text), "{text}");
        }
    }

    #[test]
    fn everything_has_its_colour() {
        let text = "// c\ncurve a = line(A, through: 2mm) + \"t\"";
        let found: Vec<(&str, Paint)> = painted(text).iter().map(|(s, p)| (&text[s.start as usize..s.end as usize], *p)).collect();
        assert!(found.contains(&("// c", Paint::Comment)) && found.contains(&("curve", Paint::Keyword)));
        assert!(found.contains(&("line", Paint::Function)) && found.contains(&("through", Paint::Property)));
        assert!(found.contains(&("2mm", Paint::Number)) && found.contains(&("\"t\"", Paint::Text)) && found.contains(&("A", Paint::Name)));
    }
}
