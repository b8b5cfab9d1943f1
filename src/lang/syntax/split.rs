//! Tokens to pieces: cuts a file at the keywords that start a line, before anything is parsed.
//!
//! The brackets of a piece are matched here, so that a missing `)` points at its `(`, and its nesting is counted, so
//! that no text can exhaust the stack of what comes after.

use std::ops::Range;

use crate::base::limits::{EXPRESSION_HEIGHT, NESTED_BRACKETS, OPERATORS_IN_A_ROW};
use crate::lang::diag::span::Span;
use crate::lang::syntax::mistake::Mistake;
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::token::Kind;

/// The tokens of one declaration, or of something that begins like none.
#[derive(Debug)]
pub(crate) struct Piece {
    pub tokens: Range<usize>,
    /// Something in it was reported already.
    pub broken: bool,
}

/// An open bracket, how many prefix operators and `if`s wait inside it, and how tall the trees of its items are: of the
/// one at hand, and of the tallest one before it.
#[derive(Default)]
struct OpenGroup {
    token: usize,
    prefixes: usize,
    choices: usize,
    height: usize,
    tallest: usize,
}

struct Splitter<'a> {
    tokens: &'a Tokens,
    open: Vec<OpenGroup>,
    start: usize,
    /// The piece at hand has a `=`.
    equals: bool,
    broken: bool,
    /// All that waits inside the open brackets together.
    waiting: usize,
    too_deep: bool,
    pieces: Vec<Piece>,
    mistakes: Vec<Mistake>,
    /// First mistake of the piece at hand.
    first_mistake: usize,
}

/// Cuts the tokens of a file into pieces; the mistakes are those of brackets, nesting and lines.
pub(crate) fn split(tokens: &Tokens) -> (Vec<Piece>, Vec<Mistake>) {
    let mut splitter = Splitter {
        tokens,
        open: vec![OpenGroup::default()],
        start: 0,
        equals: false,
        broken: false,
        waiting: 0,
        too_deep: false,
        pieces: Vec::new(),
        mistakes: Vec::new(),
        first_mistake: 0,
    };
    for at in 0..tokens.len() {
        if at > splitter.start && splitter.cuts(at) {
            splitter.finish(at, true);
        }
        splitter.step(at);
    }
    if splitter.start < tokens.len() {
        splitter.finish(tokens.len(), false);
    }
    (splitter.pieces, splitter.mistakes)
}

impl Splitter<'_> {
    fn kind(&self, at: usize) -> Option<Kind> {
        self.tokens.kinds.get(at).copied()
    }

    /// Whether a new declaration begins with this token.
    fn cuts(&mut self, at: usize) -> bool {
        let (kind, before) = (self.tokens.kinds[at], self.tokens.kinds[at - 1]);
        let first = self.tokens.first[at];
        let inside = self.open.len() > 1;
        if (!first && inside) || before == Kind::Dot || self.kind(at + 1) == Some(Kind::Colon) {
            return false;
        }
        if kind.keyword().is_none() {
            // A line that ends with a sign of other languages, as `;`, ends there.
            let sign = before == Kind::Strange && self.tokens.ends[at - 1] == self.tokens.starts[at - 1] + 1;
            // `with BuildPart() as part:` opens a block of Python.
            let block = before == Kind::Colon && !inside && self.tokens.kinds[self.start..at].contains(&Kind::As);
            let ends = before.ends_operand() || sign || block;
            return first && ends && self.strays(at, inside);
        }
        if (kind == Kind::Let && before.wants_value()) || (kind == Kind::Curve && before == Kind::Modeling) {
            return false;
        }
        let head = self.head_follows(at);
        match (inside, first) {
            (true, _) => head,
            (false, true) => head || before != Kind::Colon,
            (false, false) => {
                let second = head && before.ends_operand() && (at > self.start + 1 || self.tokens.kinds[self.start].keyword().is_some());
                if second {
                    self.two_on_line(at);
                }
                second
            }
        }
    }

    /// Whether a line that starts with no keyword can only be a declaration with a misspelt or missing one.
    fn strays(&self, at: usize, inside: bool) -> bool {
        let kind = self.tokens.kinds[at];
        if inside {
            return kind == Kind::Name && self.kind(at + 1) == Some(Kind::Name) && self.kind(at + 2) == Some(Kind::Equals);
        }
        // A statement of other languages, behind a declaration that is whole.
        if kind == Kind::If || kind == Kind::For && (self.equals || self.kind(at + 1) == Some(Kind::OpenRound)) {
            return true;
        }
        matches!(kind, Kind::Name | Kind::Number | Kind::Quantity | Kind::Text | Kind::TextHead | Kind::True | Kind::False | Kind::None)
    }

    /// Whether what follows the keyword can be its head.
    fn head_follows(&self, at: usize) -> bool {
        let Some(next) = self.kind(at + 1) else { return false };
        match self.tokens.kinds[at] {
            Kind::Units => matches!(next, Kind::Name | Kind::In),
            Kind::Tolerance | Kind::Snap => matches!(next, Kind::Number | Kind::Quantity | Kind::Name),
            Kind::Use | Kind::Import => matches!(next, Kind::Text | Kind::TextHead),
            Kind::Modeling => next == Kind::Curve,
            Kind::Check | Kind::Report | Kind::Export | Kind::Picture => {
                matches!(next, Kind::Name | Kind::Text | Kind::TextHead | Kind::Number | Kind::Quantity)
            }
            _ => next == Kind::Name,
        }
    }

    fn two_on_line(&mut self, at: usize) {
        let first = self.tokens.span(self.start);
        self.mistakes.push(Mistake::TwoOnLine { first, second: self.tokens.span(at) });
    }

    fn step(&mut self, at: usize) {
        let kind = self.tokens.kinds[at];
        self.equals |= kind == Kind::Equals;
        match kind {
            Kind::OpenSquare if at > self.start && self.tokens.kinds[at - 1].ends_operand() => {
                self.grow(at, 0);
                self.enter(at);
            }
            Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly | Kind::TextHead => self.enter(at),
            Kind::Dot => self.grow(at, 0),
            Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail => self.leave(at),
            Kind::TextMid => {
                self.leave(at);
                self.enter(at);
            }
            Kind::Not | Kind::Caret => self.wait(at, true),
            Kind::Minus if at == self.start || !self.tokens.kinds[at - 1].ends_operand() => self.wait(at, true),
            Kind::If => self.wait(at, false),
            Kind::Let if at > self.start => self.wait(at, false),
            Kind::Comma | Kind::Colon => self.rest(true),
            Kind::For => self.rest(true),
            _ if kind.is_infix() => {
                self.grow(at, 0);
                self.rest(false);
            }
            _ => {}
        }
    }

    fn enter(&mut self, at: usize) {
        self.open.push(OpenGroup { token: at, ..OpenGroup::default() });
        if self.open.len() == NESTED_BRACKETS + 2 {
            self.deep(at, "brackets", NESTED_BRACKETS);
        }
    }

    /// One more prefix or right-associative operator, `if` or `let` that waits for what follows.
    fn wait(&mut self, at: usize, prefix: bool) {
        let Some(inner) = self.open.last_mut() else { return };
        let count = if prefix { &mut inner.prefixes } else { &mut inner.choices };
        *count += 1;
        self.waiting += 1;
        if *count > OPERATORS_IN_A_ROW {
            self.deep(at, "operators in a row", OPERATORS_IN_A_ROW);
        } else if self.waiting > 4 * NESTED_BRACKETS {
            self.deep(at, "operators nested in each other", 4 * NESTED_BRACKETS);
        }
    }

    /// Prefix operators end at an infix one, `if` and `let` at a comma.
    fn rest(&mut self, all: bool) {
        let Some(inner) = self.open.last_mut() else { return };
        self.waiting -= inner.prefixes;
        inner.prefixes = 0;
        if all {
            inner.tallest = inner.tallest.max(inner.height);
            inner.height = 0;
            self.waiting -= inner.choices;
            inner.choices = 0;
        }
    }

    /// The tree of the item at hand grows by one, and is taller than `inner`, a bracket in it.
    fn grow(&mut self, at: usize, inner: usize) {
        let Some(item) = self.open.last_mut() else { return };
        item.height = (item.height + usize::from(inner == 0)).max(inner);
        if item.height > EXPRESSION_HEIGHT {
            self.deep(at, "operators, fields and indices nested in each other", EXPRESSION_HEIGHT);
        }
    }

    fn deep(&mut self, at: usize, what: &'static str, limit: usize) {
        if !self.too_deep {
            self.mistakes.push(Mistake::TooDeep { span: self.tokens.span(at), what, limit });
        }
        self.too_deep = true;
        self.broken = true;
    }

    fn pop(&mut self, at: usize) {
        if let Some(open) = self.open.pop() {
            self.waiting -= open.prefixes + open.choices;
            self.grow(at, open.height.max(open.tallest) + 1);
        }
    }

    fn leave(&mut self, at: usize) {
        let kind = self.tokens.kinds[at];
        let matches = |open: &OpenGroup| closer(self.tokens.kinds[open.token]) == Some(plain(kind));
        let Some(depth) = self.open.iter().skip(1).rposition(matches) else {
            if !self.broken {
                let inside = (self.open.len() > 1).then(|| self.open.last().map(|o| self.tokens.span(o.token))).flatten();
                self.mistakes.push(Mistake::StrayBracket { span: self.tokens.span(at), inside, piece: Span::default() });
            }
            self.broken = true;
            return;
        };
        let unclosed = self.open.len() - 1 - (depth + 1);
        if unclosed > 0 {
            if !self.broken {
                let opener = self.open[depth + 2].token;
                let closers = self.closers(depth + 2);
                let (span, last) = (self.tokens.span(opener), self.last_item(opener, at));
                let ended = Some((self.tokens.span(at), false));
                self.mistakes.push(Mistake::OpenBracket { span, ended, closers, last, piece: Span::default() });
            }
            self.broken = true;
        }
        for _ in 0..=unclosed {
            self.pop(at);
        }
    }

    /// What closes the open brackets from `from` on, innermost first.
    fn closers(&self, from: usize) -> String {
        self.open[from..].iter().rev().filter_map(|o| closer(self.tokens.kinds[o.token])).map(text_of_closer).collect()
    }

    /// The last item before `end` in the bracket opened by `opener`; its last token when the item is long.
    fn last_item(&self, opener: usize, end: usize) -> Span {
        let (mut depth, mut first) = (0usize, end);
        for at in (opener + 1..end).rev() {
            match self.tokens.kinds[at] {
                Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly | Kind::TextTail => depth += 1,
                Kind::OpenRound | Kind::LineRound | Kind::OpenSquare | Kind::LineSquare | Kind::OpenCurly | Kind::TextHead => {
                    if depth == 0 {
                        break;
                    }
                    depth -= 1;
                }
                Kind::Comma if depth == 0 => break,
                _ => {}
            }
            first = at;
        }
        let whole = self.tokens.stretch(first.min(end - 1), end - 1);
        if whole.end - whole.start <= 40 { whole } else { self.tokens.span(end - 1) }
    }

    /// Ends the piece before token `end`; `cut` tells whether another declaration begins there.
    fn finish(&mut self, end: usize, cut: bool) {
        if self.open.len() > 1 && !self.broken {
            let opener = self.open[1].token;
            let ended = cut.then(|| (self.tokens.span(end), true));
            let closers = self.closers(1);
            let innermost = self.open.last().map_or(opener, |o| o.token);
            let last = self.last_item(innermost, end);
            self.mistakes.push(Mistake::OpenBracket { span: self.tokens.span(opener), ended, closers, last, piece: Span::default() });
            self.broken = true;
        }
        let whole = self.tokens.stretch(self.start, end - 1);
        for mistake in &mut self.mistakes[self.first_mistake..] {
            mistake.stands_in(whole);
        }
        self.first_mistake = self.mistakes.len();
        self.pieces.push(Piece { tokens: self.start..end, broken: self.broken });
        self.start = end;
        self.equals = false;
        self.broken = false;
        self.too_deep = false;
        self.waiting = 0;
        self.open.truncate(1);
        self.open[0] = OpenGroup { token: end, ..OpenGroup::default() };
    }
}

/// What closes an opening token.
fn closer(kind: Kind) -> Option<Kind> {
    match kind {
        Kind::OpenRound | Kind::LineRound => Some(Kind::CloseRound),
        Kind::OpenSquare | Kind::LineSquare => Some(Kind::CloseSquare),
        Kind::OpenCurly => Some(Kind::CloseCurly),
        Kind::TextHead | Kind::TextMid => Some(Kind::TextTail),
        _ => None,
    }
}

/// The middle of a string closes what its end closes.
fn plain(kind: Kind) -> Kind {
    if kind == Kind::TextMid { Kind::TextTail } else { kind }
}

fn text_of_closer(kind: Kind) -> &'static str {
    match kind {
        Kind::CloseRound => ")",
        Kind::CloseSquare => "]",
        Kind::CloseCurly => "}",
        _ => "}\"",
    }
}
