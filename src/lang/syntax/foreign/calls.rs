//! Calls as other tools write them: `translate([1, 2, 3]) cube(10)`, `cq.Workplane("XY").box(1, 2, 3)`.

use crate::lang::syntax::foreign::{Refusal, opens};
use crate::lang::syntax::token::Kind;

/// One call, with the text of its arguments.
#[derive(Clone, Debug, Default)]
pub(crate) struct Call {
    /// The word before the bracket.
    pub name: String,
    /// Name, where there is one, and value of each argument.
    pub args: Vec<(Option<String>, String)>,
}

impl Call {
    /// The argument of one of these names, else the k-th without a name.
    pub fn get(&self, names: &[&str], k: usize) -> Option<&str> {
        let named = self.args.iter().find(|(name, _)| name.as_deref().is_some_and(|n| names.contains(&n)));
        named.map(|a| a.1.as_str()).or_else(|| self.unnamed().nth(k))
    }

    /// The argument of one of these names.
    pub fn named(&self, names: &[&str]) -> Option<&str> {
        self.get(names, usize::MAX)
    }

    /// The arguments without names.
    pub fn unnamed(&self) -> impl Iterator<Item = &str> {
        self.args.iter().filter(|a| a.0.is_none()).map(|a| a.1.as_str())
    }

    /// Whether every argument with a name has one of these.
    pub fn knows_only(&self, names: &[&str]) -> bool {
        self.args.iter().all(|(name, _)| name.as_deref().is_none_or(|n| names.contains(&n)))
    }
}

impl Refusal<'_> {
    /// The calls of a statement from a token on, in the order of writing, and the token behind them.
    pub(crate) fn calls(&self, from: usize) -> Option<(Vec<Call>, usize)> {
        let (mut calls, mut at) = (Vec::new(), from);
        loop {
            while self.is_word(at) && self.kind(at + 1) == Some(Kind::Dot) {
                at += 2;
            }
            let open = at + 1;
            if !self.is_word(at) || self.kind(open) != Some(Kind::OpenRound) {
                return None;
            }
            let close = self.closer(open)?;
            calls.push(Call { name: self.text(at, open).to_owned(), args: self.arguments(open, close) });
            at = close + 1;
            match self.kind(at) {
                Some(Kind::Dot) => at += 1,
                Some(Kind::Name) => {}
                _ => return Some((calls, at)),
            }
        }
    }

    /// The same where nothing stands between them and `end`.
    pub(crate) fn only_calls(&self, from: usize, end: usize) -> Option<Vec<Call>> {
        self.calls(from).filter(|(_, behind)| *behind == end).map(|(calls, _)| calls)
    }

    fn is_word(&self, at: usize) -> bool {
        self.kind(at).is_some_and(|kind| kind == Kind::Name || kind.is_reserved() && kind != Kind::For)
    }

    /// What stands between two brackets, parted by commas. Names behind a `$` set how round a shape is drawn: curves are exact here.
    pub(crate) fn arguments(&self, open: usize, close: usize) -> Vec<(Option<String>, String)> {
        let (mut args, mut from, mut depth) = (Vec::new(), open + 1, 0);
        for at in open + 1..=close {
            let kind = self.tokens.kinds[at];
            let ends = depth == 0 && (at == close || kind == Kind::Comma);
            depth += opens(kind);
            if !ends {
                continue;
            }
            let named = matches!(self.kind(from + 1), Some(Kind::Equals | Kind::Colon)) && from + 1 < at && self.is_word(from);
            if named {
                args.push((Some(self.text(from, from + 1).to_owned()), self.text(from + 2, at).to_owned()));
            } else if from < at && self.kind(from) != Some(Kind::Strange) {
                args.push((None, self.text(from, at).to_owned()));
            }
            from = at + 1;
        }
        args
    }
}

/// The members of a list or tuple: `[1, 2, 3]`, `(1, 2)`; `None` for anything else.
pub(crate) fn items(text: &str) -> Option<Vec<&str>> {
    let text = text.trim();
    let inner = text.strip_prefix('[').and_then(|t| t.strip_suffix(']')).or_else(|| text.strip_prefix('(')?.strip_suffix(')'))?;
    let (mut found, mut depth, mut from) = (Vec::new(), 0_i32, 0);
    for (at, c) in inner.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 => {
                found.push(inner[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
        if depth < 0 {
            return None;
        }
    }
    let last = inner[from..].trim();
    found.extend((!last.is_empty()).then_some(last));
    Some(found)
}

/// A list of two or three coordinates as a point; a name as it is.
pub(crate) fn point(text: &str) -> Option<String> {
    match items(text) {
        Some(parts) if matches!(parts.len(), 2 | 3) => Some(format!("({})", parts.join(", "))),
        Some(_) => None,
        None => is_simple(text).then(|| text.to_owned()),
    }
}

/// A list of points, each in round brackets.
pub(crate) fn points(text: &str) -> Option<String> {
    match items(text) {
        Some(parts) => {
            let written = |text: &str| point(text).filter(|_| !text.starts_with(|c: char| c.is_ascii_digit()));
            let all: Option<Vec<String>> = parts.into_iter().map(written).collect();
            all.map(|all| format!("[{}]", all.join(", ")))
        }
        None => is_simple(text).then(|| text.to_owned()),
    }
}

/// Whether a text needs no brackets around it: a name or a number.
fn is_simple(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '.'))
}

/// A text that stands beside an operator.
pub(crate) fn part(text: &str) -> String {
    if is_simple(text) { text.to_owned() } else { format!("({text})") }
}

/// Half of a number; the number itself where it is one.
pub(crate) fn half(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(number) => format!("{}", number / 2.0),
        Err(_) => format!("{} / 2", part(text)),
    }
}

/// Its negative.
pub(crate) fn negative(text: &str) -> String {
    match text.strip_prefix('-').filter(|t| is_simple(t)) {
        Some(positive) => positive.to_owned(),
        None => format!("-{}", part(text)),
    }
}

/// A number of degrees as an angle.
pub(crate) fn degrees(text: &str) -> String {
    let number = text.strip_prefix('-').unwrap_or(text);
    if number.parse::<f64>().is_ok() { format!("{text}deg") } else { format!("{} * 1deg", part(text)) }
}
