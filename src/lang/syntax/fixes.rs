//! Quick fixes: the help of a report as edits of the text.
//!
//! An edit is told where the help is made, by what it means ([`Edit`]); here it becomes bytes. Only tokens are looked
//! at, so that a script with mistakes elsewhere can be mended as well.

use crate::base::fault::Edit;
use crate::lang::diag::diagnostic::Fix;
use crate::lang::diag::span::Span;
use crate::lang::syntax::scan::{Tokens, scan};
use crate::lang::syntax::split::{Piece, split};
use crate::lang::syntax::token::Kind;

/// Most characters of a text in a title.
const SHOWN: usize = 40;

/// A fix as it is offered: what it does in words, the stretch that goes and the text that comes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// For example ``Change to `south` ``.
    pub title: String,
    /// What goes, in bytes of the text.
    pub span: Span,
    /// What comes.
    pub text: String,
}

impl Fix {
    /// The change of the text of its file; `None` when the text does not look as expected.
    pub fn change(&self, source: &str) -> Option<Change> {
        let text = Text { source, tokens: scan(source) };
        let (span, put) = text.edited(self.span, &self.edit)?;
        let old = source.get(span.start as usize..span.end as usize)?;
        let shown = |words: &str| {
            let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
            if words.chars().count() <= SHOWN { words } else { words.chars().take(SHOWN).chain(['…']).collect() }
        };
        let title = match (shown(old).as_str(), shown(&put).as_str()) {
            ("", "") => "Start a new line".to_owned(),
            ("", new) => format!("Add `{new}`"),
            (old, "") => format!("Remove `{}`", old.trim_matches(',').trim()),
            (_, new) => format!("Change to `{new}`"),
        };
        (old != put).then_some(Change { title, span, text: put })
    }
}

struct Text<'s> {
    source: &'s str,
    tokens: Tokens,
}

impl Text<'_> {
    fn edited(&self, at: Span, edit: &Edit) -> Option<(Span, String)> {
        match edit {
            Edit::Put(text) => Some((at, self.apart(at, text))),
            Edit::Instead { of, put } => self.instead(at, of).map(|span| (span, put.clone())),
            Edit::Set(key, value) => self.value_of(self.declaration(at)?, key).map(|span| (span, value.clone())),
            Edit::Member(k, Some(text)) => self.member(at, *k).map(|tokens| (self.span(tokens), text.clone())),
            Edit::Member(k, None) => Some((self.without(self.member(at, *k)?), String::new())),
            Edit::Add(argument) => self.added(at, argument),
            Edit::DropArgument => Some((self.without(self.argument(at)?), String::new())),
            Edit::DropSetting => Some((self.setting(self.first(at)?)?, String::new())),
            Edit::DropRule(key) => Some((self.rule(at, *key)?, String::new())),
            Edit::Declare(keyword, value) => self.declared(keyword, value),
        }
    }

    fn kind(&self, token: usize) -> Option<Kind> {
        self.tokens.kinds.get(token).copied()
    }

    fn text(&self, token: usize) -> &str {
        let span = self.tokens.span(token);
        &self.source[span.start as usize..span.end as usize]
    }

    /// From the first to the last token.
    fn span(&self, (first, last): (usize, usize)) -> Span {
        self.tokens.stretch(first, last)
    }

    /// The token that begins at a place.
    fn first(&self, at: Span) -> Option<usize> {
        self.tokens.starts.binary_search(&at.start).ok()
    }

    /// First and last token of a stretch.
    fn inside(&self, at: Span) -> Option<(usize, usize)> {
        let first = self.tokens.starts.partition_point(|start| *start < at.start);
        let end = self.tokens.ends.partition_point(|end| *end <= at.end);
        (first < end).then(|| (first, end - 1))
    }

    /// The text with blanks where it would grow together with a word beside it.
    fn apart(&self, at: Span, text: &str) -> String {
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let (before, behind) = (self.source.get(..at.start as usize).unwrap_or(""), self.source.get(at.end as usize..).unwrap_or(""));
        let joins = |a: Option<char>, b: Option<char>| a.zip(b).is_some_and(|(a, b)| is_word(a) && is_word(b));
        // A number keeps the unit that is glued to it, and digits are put before their dot.
        let glued = text.chars().all(|c| c.is_ascii_digit() || c == '.');
        let left = if !glued && joins(before.chars().next_back(), text.chars().next()) { " " } else { "" };
        let right = if !glued && joins(text.chars().next_back(), behind.chars().next()) { " " } else { "" };
        format!("{left}{text}{right}")
    }

    /// First and last token of the declaration around a place.
    fn declaration(&self, at: Span) -> Option<(usize, usize)> {
        let (pieces, _) = split(&self.tokens);
        let around = |p: &Piece| {
            let span = self.tokens.stretch(p.tokens.start, p.tokens.end - 1);
            span.start <= at.start && at.start <= span.end
        };
        pieces.into_iter().rev().find(around).map(|p| (p.tokens.start, p.tokens.end - 1))
    }

    fn instead(&self, at: Span, of: &str) -> Option<Span> {
        let wanted = scan(of);
        let word = |k: usize| &of[wanted.starts[k] as usize..wanted.ends[k] as usize];
        let once = |(first, last): (usize, usize)| {
            let fits = |k: &usize| k + wanted.len() <= last + 1 && (0..wanted.len()).all(|j| self.text(k + j) == word(j));
            // A name that is a field, or is being declared, is another one.
            let other = |k: &usize| {
                *k > first && matches!(self.tokens.kinds[k - 1], Kind::Dot) || self.kind(k + wanted.len()) == Some(Kind::Equals)
            };
            let mut found = (first..=last).filter(|k| fits(k) && !other(k));
            match (found.next(), found.next()) {
                (Some(k), None) => Some(self.span((k, k + wanted.len() - 1))),
                _ => None,
            }
        };
        if wanted.len() == 0 {
            return None;
        }
        self.inside(at).and_then(once).or_else(|| once(self.declaration(at)?))
    }

    /// An argument more before the bracket that closes a call.
    fn added(&self, call: Span, argument: &str) -> Option<(Span, String)> {
        let (_, last) = self.inside(call)?;
        let at = self.tokens.starts[last];
        let bare = matches!(self.kind(last.checked_sub(1)?), Some(Kind::OpenRound | Kind::Comma));
        let text = if bare { argument.to_owned() } else { format!(", {argument}") };
        (self.kind(last) == Some(Kind::CloseRound)).then_some((Span { start: at, end: at }, text))
    }

    /// How deep the brackets are open behind each token, from the first one.
    fn step(&self, token: usize) -> i32 {
        match self.tokens.kinds[token] {
            Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly => 1,
            Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly => -1,
            _ => 0,
        }
    }

    /// The last token of what begins at a token and ends before a comma, another setting or a closing bracket.
    fn value_end(&self, first: usize) -> usize {
        let (mut depth, mut at) = (0, first);
        while let Some(kind) = self.kind(at) {
            let next = |k: usize| self.kind(k);
            let names = depth == 0 && at > first && next(at + 1) == Some(Kind::Colon);
            let clause = depth == 0 && at > first && matches!(kind, Kind::On | Kind::Near | Kind::In) && next(at + 1) != Some(Kind::Colon);
            if depth == 0 && (matches!(kind, Kind::Comma) || self.step(at) < 0) || names || clause {
                break;
            }
            depth += self.step(at);
            at += 1;
        }
        at.max(first + 1) - 1
    }

    /// The value behind `key:` in a declaration.
    fn value_of(&self, (first, last): (usize, usize), key: &str) -> Option<Span> {
        let token = (first..last).find(|&k| self.text(k) == key && self.kind(k + 1) == Some(Kind::Colon))?;
        (token + 2 <= last).then(|| self.span((token + 2, self.value_end(token + 2))))
    }

    /// First and last token of a member of a list.
    fn member(&self, list: Span, k: usize) -> Option<(usize, usize)> {
        let (open, close) = self.inside(list)?;
        let lists = matches!(self.tokens.kinds[open], Kind::OpenSquare | Kind::LineSquare | Kind::OpenRound);
        // Of a call the list is the one argument that is one.
        let open =
            if lists { open } else { (open..close).find(|&t| matches!(self.tokens.kinds[t], Kind::OpenSquare | Kind::LineSquare))? };
        let mut first = open + 1;
        for _ in 0..k {
            first = self.value_end(first) + 2;
            if first >= close || self.kind(first - 1) != Some(Kind::Comma) {
                return None;
            }
        }
        let made = self.kind(open + 1) == Some(Kind::For);
        (!made).then(|| (first, self.value_end(first)))
    }

    /// The argument with its name whose value begins at a place.
    fn argument(&self, at: Span) -> Option<(usize, usize)> {
        let (first, last) = self.inside(at)?;
        let named = first >= 2 && self.kind(first - 1) == Some(Kind::Colon);
        Some((if named { first - 2 } else { first }, last))
    }

    /// An item of a list with the comma that goes with it.
    fn without(&self, (first, last): (usize, usize)) -> Span {
        if first > 0 && self.kind(first - 1) == Some(Kind::Comma) {
            return Span { start: self.tokens.ends[first - 2], end: self.tokens.ends[last] };
        }
        match self.kind(last + 1) {
            Some(Kind::Comma) if last + 2 < self.tokens.len() => {
                Span { start: self.tokens.starts[first], end: self.tokens.starts[last + 2] }
            }
            _ => self.span((first, last)),
        }
    }

    /// The setting around its value, or its whole clause.
    fn setting(&self, value: usize) -> Option<Span> {
        let key = value.checked_sub(2).filter(|_| self.kind(value - 1) == Some(Kind::Colon))?;
        let last = self.value_end(value);
        if self.kind(key.checked_sub(1)?) == Some(Kind::OpenCurly) && self.kind(last + 1) == Some(Kind::CloseCurly) {
            return self.clause(key - 1).or_else(|| Some(self.with_blanks((key - 1, last + 1))));
        }
        Some(self.with_blanks((key, last)))
    }

    /// The clause whose block opens at a token.
    fn clause(&self, curly: usize) -> Option<Span> {
        let (mut depth, mut on) = (0, curly);
        loop {
            on = on.checked_sub(1)?;
            depth += self.step(on);
            match self.tokens.kinds[on] {
                Kind::OpenCurly | Kind::CloseCurly => return None,
                Kind::On | Kind::Near if depth == 0 => break,
                kind if kind.keyword().is_some() && self.kind(on + 1) != Some(Kind::Colon) => return None,
                _ => {}
            }
        }
        Some(self.with_blanks((on, self.closing(curly)?)))
    }

    /// The bracket that closes the one at a token.
    fn closing(&self, open: usize) -> Option<usize> {
        let mut depth = 0;
        (open..self.tokens.len()).find(|&k| {
            depth += self.step(k);
            depth == 0
        })
    }

    /// The clause about a place, or a setting of it.
    fn rule(&self, at: Span, key: Option<&str>) -> Option<Span> {
        let (first, last) = self.inside(at)?;
        if first > 0 && self.kind(first - 1) == Some(Kind::Colon) {
            // The rule is about one setting.
            return self.setting(first);
        }
        let curly = (last + 1..self.tokens.len()).find(|&k| self.tokens.kinds[k] == Kind::OpenCurly)?;
        let Some(key) = key else { return self.clause(curly) };
        let close = self.closing(curly)?;
        let value = (curly + 1..close).find(|&k| self.text(k) == key && self.kind(k + 1) == Some(Kind::Colon))? + 2;
        self.setting(value)
    }

    /// Tokens with the blanks before them, and their line where nothing else stands on it.
    fn with_blanks(&self, tokens: (usize, usize)) -> Span {
        let span = self.span(tokens);
        let before = &self.source[..span.start as usize];
        let blank = before.len() - before.trim_end_matches([' ', '\t']).len();
        let start = span.start - blank as u32;
        let behind = &self.source[span.end as usize..];
        let own_line = before[..start as usize].ends_with('\n') || start == 0;
        let rest = behind.len() - behind.trim_start_matches([' ', '\t', '\r']).len();
        match own_line && behind[rest..].starts_with('\n') {
            true => Span { start, end: span.end + rest as u32 + 1 },
            // The blanks before what follows stay.
            false => Span { start, end: span.end },
        }
    }

    /// `snap 0.5mm` in the place of the one there is, or behind the head of the script.
    fn declared(&self, keyword: &str, value: &str) -> Option<(Span, String)> {
        let (pieces, _) = split(&self.tokens);
        let head = |p: &&Piece| matches!(self.tokens.kinds[p.tokens.start], Kind::Units | Kind::Tolerance | Kind::Snap);
        if let Some(piece) = pieces.iter().filter(head).find(|p| self.text(p.tokens.start) == keyword) {
            // The angle of a tolerance stays.
            let first = piece.tokens.start + 1;
            let last = self.value_end(first).min(piece.tokens.end - 1);
            return (first <= last).then(|| (self.span((first, last)), value.to_owned()));
        }
        let line = format!("{keyword} {value}\n");
        let at = match pieces.iter().rfind(head) {
            Some(piece) => {
                let end = self.tokens.ends[piece.tokens.end - 1] as usize;
                match self.source[end..].find('\n') {
                    Some(n) => (end + n + 1) as u32,
                    None => return Some((Span { start: end as u32, end: end as u32 }, format!("\n{}", line.trim_end()))),
                }
            }
            // Before the first declaration and its comments, behind a mark of the order of bytes.
            None => {
                if self.source.starts_with('\u{feff}') {
                    3
                } else {
                    0
                }
            }
        };
        Some((Span { start: at, end: at }, line))
    }
}
