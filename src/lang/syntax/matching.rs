//! Matching the tokens of a declaration against the rules of [`super::token_rules`].

use crate::lang::diag::span::Span;
use crate::lang::syntax::Rule;
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::token::Kind;
use crate::lang::syntax::token_rules::{Op, RULES, TokenRule, bit};

/// A rule that matched.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mark {
    rule: Rule,
    /// Its tokens, counted from the declaration's first.
    start: u32,
    end: u32,
    /// Marks of it and all inside it.
    size: u32,
}

/// All that matched, each rule before what is inside it; kept between declarations for its room.
#[derive(Debug, Default)]
pub(crate) struct Marks(Vec<Mark>);

/// A rule that matched, with what matched inside it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<'m> {
    marks: &'m [Mark],
}

impl<'m> Pair<'m> {
    pub fn as_rule(&self) -> Rule {
        self.marks[0].rule
    }

    /// First and last token, counted from the declaration's first.
    pub fn extent(&self) -> Span {
        let Mark { start, end, .. } = self.marks[0];
        Span { start, end: end.saturating_sub(1) }
    }

    /// What matched directly inside.
    pub fn into_inner(self) -> impl Iterator<Item = Pair<'m>> + Clone {
        pairs(&self.marks[1..])
    }
}

fn pairs(mut rest: &[Mark]) -> impl Iterator<Item = Pair<'_>> + Clone {
    std::iter::from_fn(move || {
        let size = rest.first()?.size as usize;
        let (own, behind) = rest.split_at(size);
        rest = behind;
        Some(Pair { marks: own })
    })
}

impl Marks {
    /// Matches the tokens `base..end` as one declaration; gives its rule, or `None` when it is none.
    pub fn declaration(&mut self, tokens: &Tokens, base: usize, end: usize) -> Option<Pair<'_>> {
        let rules = RULES.as_ref()?;
        self.0.clear();
        let kinds = &tokens.kinds[base..end];
        let mut matcher = Matcher { rules, kinds, first: &tokens.first[base..end], at: 0, has_pairs: true, marks: &mut self.0 };
        if !matcher.rule(0) {
            return None;
        }
        pairs(&self.0).next()
    }
}

struct Matcher<'a> {
    rules: &'a [TokenRule],
    kinds: &'a [Kind],
    first: &'a [bool],
    at: usize,
    /// Whether matches produce pairs; not inside an atomic rule.
    has_pairs: bool,
    marks: &'a mut Vec<Mark>,
}

impl Matcher<'_> {
    fn takes(&mut self, kinds: u128) -> bool {
        let found = self.kinds.get(self.at).is_some_and(|kind| bit(*kind) & kinds != 0);
        self.at += usize::from(found);
        found
    }

    fn rule(&mut self, number: usize) -> bool {
        let rules = self.rules;
        let rule = &rules[number];
        let (Some(produced), true) = (rule.pair, self.has_pairs) else { return self.step(&rule.op) };
        let (start, mark) = (self.at, self.marks.len());
        self.marks.push(Mark { rule: produced, start: start as u32, end: 0, size: 0 });
        self.has_pairs = !rule.atomic;
        let found = self.step(&rule.op);
        self.has_pairs = true;
        if found {
            let size = (self.marks.len() - mark) as u32;
            self.marks[mark] = Mark { rule: produced, start: start as u32, end: self.at as u32, size };
        } else {
            self.marks.truncate(mark);
        }
        found
    }

    /// Matches, or leaves everything as it was.
    fn step(&mut self, op: &Op) -> bool {
        match op {
            Op::Kinds(kinds) => self.takes(*kinds),
            Op::Rule(number) => self.rule(*number),
            Op::Sequence(parts) => {
                let (at, mark) = (self.at, self.marks.len());
                let found = parts.iter().all(|part| self.step(part));
                if !found {
                    self.back(at, mark);
                }
                found
            }
            Op::Choice(parts) => parts.iter().any(|part| self.step(part)),
            Op::Repeat(part) => {
                let mut before = self.at;
                while self.step(part) && self.at > before {
                    before = self.at;
                }
                true
            }
            Op::Maybe(part) => {
                self.step(part);
                true
            }
            Op::NotAhead(part) => !self.is_ahead(part),
            Op::SameLine => !self.first.get(self.at).is_some_and(|first| *first),
            Op::Nothing => true,
            Op::End => self.at == self.kinds.len(),
            Op::Text(value) => self.text(*value),
        }
    }

    fn is_ahead(&mut self, op: &Op) -> bool {
        let (at, mark) = (self.at, self.marks.len());
        let found = self.step(op);
        self.back(at, mark);
        found
    }

    fn back(&mut self, at: usize, mark: usize) {
        self.at = at;
        self.marks.truncate(mark);
    }

    /// `"…"`, or `"…{`, a value, `}…{`, a value, `}…"`.
    fn text(&mut self, value: usize) -> bool {
        if self.takes(bit(Kind::Text)) {
            return true;
        }
        let (at, mark) = (self.at, self.marks.len());
        let mut found = self.takes(bit(Kind::TextHead)) && self.rule(value);
        while found && self.takes(bit(Kind::TextMid)) {
            found = self.rule(value);
        }
        found = found && self.takes(bit(Kind::TextTail));
        if !found {
            self.back(at, mark);
        }
        found
    }
}
