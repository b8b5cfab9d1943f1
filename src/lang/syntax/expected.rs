//! What pest expected, in words for people.
//!
//! pest tells the furthest byte it reached and the rules it would have gone on with. The token there, its neighbours
//! and these rules say what was meant more often than not; a repair is only offered when the repaired text parses.

use pest::error::{Error, ErrorVariant, InputLocation};

use crate::lang::diag::diagnostic::{Diagnostic, FileId};
use crate::lang::diag::span::Span;
use crate::lang::syntax::Rule;
use crate::lang::syntax::expected_words::{is_value, shortened, words};
use crate::lang::syntax::foreign::fresh_names::FreshNames;
use crate::lang::syntax::number::{is_unit, split_unit};
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::token::Kind;

/// One declaration that pest refused.
pub(crate) struct Failure<'a> {
    pub source: &'a str,
    pub file: FileId,
    pub tokens: &'a Tokens,
    pub fresh: &'a FreshNames,
    /// First token of the declaration.
    pub base: usize,
    /// Token after its last one.
    pub end: usize,
}

/// Where pest stopped and what it wanted there.
struct Stop<'a> {
    /// Token that it stopped at; `end` when the declaration ended.
    at: usize,
    wanted: &'a [Rule],
}

impl Stop<'_> {
    fn wants(&self, rule: Rule) -> bool {
        self.wanted.contains(&rule)
    }

    fn wants_value(&self) -> bool {
        is_value(self.wanted) || self.wants(Rule::arg)
    }
}

impl Failure<'_> {
    /// The report for an error of pest.
    pub fn diagnose(&self, error: &Error<Rule>) -> Diagnostic {
        let ErrorVariant::ParsingError { positives, .. } = &error.variant else {
            let place = self.tokens.span(self.base);
            return Diagnostic::new("E109", "nested too deep", self.file, place, "this declaration needs more stack than is available")
                .help("give the inner parts names of their own with `let`");
        };
        let byte = match error.location {
            InputLocation::Pos(at) | InputLocation::Span((at, _)) => at as u32 + self.tokens.starts[self.base],
        };
        let at = self.base + self.tokens.starts[self.base..self.end].partition_point(|&start| start < byte);
        let stop = Stop { at, wanted: positives };
        let special = self.let_without_in(&stop).or_else(|| self.bracket_on_its_line(&stop)).or_else(|| self.reserved_word(&stop));
        let special = special.or_else(|| self.equals(&stop)).or_else(|| self.colon(&stop)).or_else(|| self.unit_apart(&stop));
        special.unwrap_or_else(|| {
            let refusal = crate::lang::syntax::foreign::Refusal::new(self.source, self.tokens, self.base..self.end, at, self.fresh);
            match refusal.meant() {
                Some(meant) => crate::lang::syntax::foreign::say(self.found(&stop), Some(meant)),
                None => self.general(&stop),
            }
        })
    }

    fn text(&self, token: usize) -> &str {
        self.slice(self.tokens.span(token))
    }

    fn slice(&self, span: Span) -> &str {
        &self.source[span.start as usize..span.end as usize]
    }

    fn kind(&self, token: usize) -> Option<Kind> {
        (self.base..self.end).contains(&token).then(|| self.tokens.kinds[token])
    }

    /// The kind of the token before.
    fn before(&self, token: usize) -> Option<Kind> {
        token.checked_sub(1).and_then(|t| self.kind(t))
    }

    fn e102(&self, message: String, token: usize, label: &str) -> Diagnostic {
        Diagnostic::new("E102", message, self.file, self.place(token), label)
    }

    /// Place of a token, or the end of the declaration.
    fn place(&self, token: usize) -> Span {
        if token < self.end {
            return self.tokens.span(token);
        }
        let last = self.tokens.span(self.end - 1);
        Span { start: last.end, end: last.end }
    }

    /// Whether the declaration parses once `text` replaces the bytes of `span`.
    fn parses_with(&self, span: Span, text: &str) -> bool {
        let whole = self.tokens.stretch(self.base, self.end - 1);
        let (before, behind) = (Span { start: whole.start, end: span.start }, Span { start: span.end, end: whole.end });
        crate::lang::syntax::is_declaration(&format!("{}{text}{}", self.slice(before), self.slice(behind)))
    }

    /// Adds the first repair that makes the declaration parse.
    fn repaired(&self, report: Diagnostic, repairs: &[(Span, &str, String)]) -> Diagnostic {
        let Some((span, text, help)) = repairs.iter().find(|(span, text, _)| self.parses_with(*span, text)) else { return report };
        let (report, word) = (report.help(help.clone()), text.trim());
        if span.start < span.end {
            return report.put(*span, word);
        }
        // Behind the token before it.
        let before = self.tokens.starts.partition_point(|start| *start < span.start).saturating_sub(1);
        let end = self.tokens.ends[before];
        let blank = if matches!(word, "," | ":") { "" } else { " " };
        report.put(Span { start: end, end }, format!("{blank}{word}"))
    }

    fn let_without_in(&self, stop: &Stop<'_>) -> Option<Diagnostic> {
        if !stop.wants(Rule::let_in) {
            return None;
        }
        // The innermost `let` whose `in` is not there yet.
        let (mut open, mut depth) = (0usize, 0usize);
        let token = (self.base + 1..stop.at).rev().find(|&t| match self.tokens.kinds[t] {
            Kind::In if depth == 0 && !self.is_loop_in(t) => {
                open += 1;
                false
            }
            Kind::CloseRound | Kind::CloseSquare | Kind::CloseCurly => {
                depth += 1;
                false
            }
            Kind::OpenRound | Kind::OpenSquare | Kind::OpenCurly | Kind::LineRound | Kind::LineSquare => {
                depth = depth.saturating_sub(1);
                false
            }
            Kind::Let if depth == 0 && open == 0 => true,
            Kind::Let if depth == 0 => {
                open -= 1;
                false
            }
            _ => false,
        })?;
        let name = self.text(token + 1);
        let label = if stop.at < self.end {
            format!("`in` is missing before `{}`", self.text(stop.at))
        } else {
            "`in` and the result are missing here".to_owned()
        };
        let report = Diagnostic::new("E108", "this `let` has no `in`", self.file, self.tokens.span(token), "a `let` inside an expression")
            .label(self.file, self.place(stop.at), label);
        let report = report.help(format!("let {name} = … in …"));
        let place = self.place(stop.at);
        let gap = Span { start: place.start, end: place.start };
        Some(if self.parses_with(gap, " in ") { report.put(gap, "in ") } else { report })
    }

    /// Whether an `in` belongs to `for name in`.
    fn is_loop_in(&self, token: usize) -> bool {
        token >= self.base + 2 && self.tokens.kinds[token - 2] == Kind::For
    }

    fn bracket_on_its_line(&self, stop: &Stop<'_>) -> Option<Diagnostic> {
        let what = match self.kind(stop.at)? {
            Kind::LineRound => "(",
            Kind::LineSquare => "[",
            _ => return None,
        };
        let before = self.before(stop.at).filter(|k| k.ends_operand())?;
        let owner = self.text(stop.at - 1);
        let call = what == "(" && before == Kind::Name;
        let message = if call {
            "the `(` of a call must be on the line of its function".to_owned()
        } else {
            format!("the `{what}` of an index must be on the line of what it belongs to")
        };
        let message = if what == "(" && !call { "something is missing before this `(`".to_owned() } else { message };
        let report = self
            .e102(message, stop.at, "on a line of its own")
            .help(format!("write `{owner}{what}` on one line, or an operator or `,` between them"));
        let between = Span { start: self.tokens.ends[stop.at - 1], end: self.tokens.starts[stop.at] };
        let joins = self.slice(between).trim().is_empty() && self.parses_with(between, "");
        Some(if joins { report.put(between, "") } else { report })
    }

    fn reserved_word(&self, stop: &Stop<'_>) -> Option<Diagnostic> {
        let kind = self.kind(stop.at).filter(|k| k.is_reserved())?;
        let word = self.text(stop.at);
        let called = matches!(self.kind(stop.at + 1), Some(Kind::OpenRound));
        if (stop.wants(Rule::name) || stop.wants(Rule::parameter)) && !stop.wants_value() {
            return Some(
                self.e102(format!("`{word}` is a reserved word and cannot be a name"), stop.at, "reserved")
                    .help(format!("call it `{word}_1`, or anything else"))
                    .put(self.place(stop.at), format!("{word}_1")),
            );
        }
        if !stop.wants_value() || matches!(kind, Kind::Then | Kind::Else | Kind::In | Kind::To | Kind::As | Kind::Of | Kind::On) {
            return None;
        }
        let report = self.e102(format!("`{word}` is a reserved word, not a value"), stop.at, "a value is wanted here");
        Some(match kind {
            Kind::Point if called => report.help("a point is written without a word: (x, y, z)"),
            Kind::Curve if called => report.help("curves are made by `line`, `arc`, `spline` …"),
            Kind::Surface if called => report.help("surfaces are made by `coons`, `ruled`, `revolve` …"),
            Kind::For => report.help("a list is made by `[for i in 0..5: …]`; a family by `curve ribs for i in 0..5 = …`"),
            kind if kind.keyword().is_some() => report.help(format!("declare it on a line of its own: {word} name …")),
            _ => report,
        })
    }

    /// `=` where `==` or `:` is meant.
    fn equals(&self, stop: &Stop<'_>) -> Option<Diagnostic> {
        let found = self.kind(stop.at)?;
        if found != Kind::Equals {
            return None;
        }
        let place = self.tokens.span(stop.at);
        let wanted = words(stop.wanted);
        let report = self.e102(format!("expected {wanted}, found `=`"), stop.at, &format!("expected {wanted}"));
        let key = self.text(stop.at - 1);
        let colon = (place, ":", format!("arguments, fields and settings take a colon: `{key}: …`"));
        let equal = (place, "==", "two values are compared by `==`".to_owned());
        let loop_in = (place, " in ", "a loop is written with `in`: `for i in 0..5`".to_owned());
        // Outside brackets it is a setting that stands without its braces.
        let set =
            stop.at > self.base + 2 && matches!(self.tokens.kinds[self.base], Kind::Mesh | Kind::Shell | Kind::Export | Kind::Picture);
        let repairs = [colon, loop_in, equal];
        Some(self.repaired(report, &repairs[..repairs.len() - usize::from(set)])).filter(|r| r.help.is_some())
    }

    /// `:` or `==` where the `=` of a declaration is meant.
    fn colon(&self, stop: &Stop<'_>) -> Option<Diagnostic> {
        if !matches!(self.kind(stop.at)?, Kind::Colon | Kind::EqualEqual) || !stop.wants(Rule::eq) {
            return None;
        }
        let report = self.as_found(stop);
        let equals = (self.tokens.span(stop.at), "=", format!("a name gets its value by `=`: `{} = …`", self.text(stop.at - 1)));
        Some(self.repaired(report, &[equals])).filter(|r| r.help.is_some())
    }

    /// `8 m` where `8m` is meant.
    fn unit_apart(&self, stop: &Stop<'_>) -> Option<Diagnostic> {
        if self.kind(stop.at) != Some(Kind::Name) || self.before(stop.at) != Some(Kind::Number) {
            return None;
        }
        let (number, unit) = (stop.at - 1, self.text(stop.at));
        if !is_unit(unit) || !split_unit(self.text(number)).1.is_empty() {
            return None;
        }
        let gap = Span { start: self.tokens.ends[number], end: self.tokens.starts[stop.at] };
        if !self.slice(gap).chars().all(|c| c == ' ' || c == '\t') {
            return None;
        }
        let (unit, behind) = self.unit_from(stop.at)?;
        let typed = format!("{}{unit}", self.text(number));
        let report = self.as_found(stop).help(format!("a unit directly follows its number: `{typed}`"));
        let stretch = self.tokens.stretch(number, behind - 1);
        Some(if self.parses_with(stretch, &typed) { report.put(stretch, typed) } else { report })
    }

    /// The unit that begins at a token, written as it must be, and the token behind it: `kg / m^3` is `kg/m3`.
    fn unit_from(&self, first: usize) -> Option<(String, usize)> {
        let plain = |at: usize| {
            let word = (self.kind(at) == Some(Kind::Name)).then(|| self.text(at)).filter(|word| is_unit(word))?;
            let power = (self.kind(at + 1) == Some(Kind::Caret) && self.kind(at + 2) == Some(Kind::Number)).then(|| self.text(at + 2));
            match power.map(|power| format!("{word}{power}")).filter(|unit| is_unit(unit)) {
                Some(unit) => Some((unit, at + 3)),
                None => Some((word.to_owned(), at + 1)),
            }
        };
        let (above, end) = plain(first)?;
        let below = (self.kind(end) == Some(Kind::Slash)).then(|| plain(end + 1)).flatten();
        match below.map(|(below, end)| (format!("{above}/{below}"), end)).filter(|(unit, _)| is_unit(unit)) {
            Some(quotient) => Some(quotient),
            None => Some((above, end)),
        }
    }

    /// What was expected and what stands there.
    fn as_found(&self, stop: &Stop<'_>) -> Diagnostic {
        let (wanted, found) = (words(stop.wanted), shortened(self.text(stop.at)));
        self.e102(format!("expected {wanted}, found `{found}`"), stop.at, &format!("expected {wanted}"))
    }

    /// What was expected, where something else stands or nothing does.
    fn found(&self, stop: &Stop<'_>) -> Diagnostic {
        if stop.at < self.end {
            return self.as_found(stop);
        }
        let wanted = words(stop.wanted);
        self.e102(format!("expected {wanted}, but the declaration ends here"), stop.at, &format!("{wanted} is missing"))
    }

    fn general(&self, stop: &Stop<'_>) -> Diagnostic {
        let place = self.place(stop.at);
        let report = self.found(stop);
        if let Some(help) = self.usual(stop) {
            // The whole declaration, where nothing is left to be filled in.
            let whole = self.tokens.stretch(self.base, self.end - 1);
            let typed = crate::lang::syntax::is_declaration(&help);
            return if typed { report.help(help.clone()).put(whole, help) } else { report.help(help) };
        }
        let before = if stop.at > self.base { self.text(stop.at - 1) } else { "" };
        let gap = Span { start: place.start, end: place.start };
        let mut insertions = [
            (Rule::comma, " , "),
            (Rule::colon, " : "),
            (Rule::eq, " = "),
            (Rule::kw_of, " of "),
            (Rule::kw_to, " to "),
            (Rule::kw_in, " in "),
            (Rule::kw_curve, " curve "),
        ];
        if matches!(self.tokens.kinds[self.base], Kind::Use | Kind::Import) {
            insertions.swap(0, 1);
        }
        let wanted = insertions.iter().filter(|(rule, _)| stop.wants(*rule));
        let repairs: Vec<(Span, &str, String)> =
            wanted.map(|&(_, text)| (gap, text, format!("add `{}` after `{}`", text.trim(), shortened(before)))).collect();
        self.repaired(report, &repairs)
    }

    /// Help for mistakes that come often.
    fn usual(&self, stop: &Stop<'_>) -> Option<String> {
        let keyword = self.tokens.kinds[self.base];
        let name = |at: usize| self.kind(at).filter(|&k| k == Kind::Name).map_or("name", |_| self.text(at));
        let own = name(self.base + 1);
        let found = self.kind(stop.at);
        match (keyword, found) {
            _ if stop.wants(Rule::kw_else) => Some("if … then … else …".to_owned()),
            (Kind::Use | Kind::Import, _) if stop.wants(Rule::kw_as) => {
                Some(format!("{} {} as name", self.text(self.base), self.text(self.base + 1)))
            }
            (Kind::Param, _) if stop.wants(Rule::kw_to) => Some("what is allowed is written `in 1 to 10` or `in [a, b]`".to_owned()),
            (Kind::Use | Kind::Import, _) if stop.wants(Rule::string) => Some(format!("{} \"file.loft\" as name", self.text(self.base))),
            (Kind::Export | Kind::Picture, None) if stop.wants(Rule::kw_to) => {
                let ending = if keyword == Kind::Export { "vtu" } else { "png" };
                Some(format!("{} to \"{own}.{ending}\"", self.slice(self.tokens.stretch(self.base, self.end - 1))))
            }
            (Kind::Let | Kind::Curve | Kind::Surface | Kind::Point, Some(Kind::OpenRound))
                if stop.wants(Rule::eq) && stop.at == self.base + 2 =>
            {
                let text = self.slice(self.tokens.stretch(self.base + 1, self.end - 1));
                Some(if text.contains('=') && keyword == Kind::Let {
                    format!("a function is declared by `fn {own}(…) = …`")
                } else {
                    format!("{} {own} = …", self.text(self.base))
                })
            }
            (Kind::Fn, Some(Kind::OpenCurly)) if stop.wants(Rule::eq) => Some(format!("the body follows `=`: fn {own}(…) = …")),
            (Kind::Fn, _) if stop.wants(Rule::parameters) || stop.wants(Rule::lpar) => Some(format!("fn {own}(x) = …")),
            (Kind::Point, Some(Kind::Comma)) if stop.wants(Rule::EOI) => Some("a point has brackets around it: (x, y, z)".to_owned()),
            (_, Some(Kind::For)) if stop.wants(Rule::EOI) => {
                Some("the `for` of a family follows its name: curve ribs for i in 0..5 = …".to_owned())
            }
            (_, Some(Kind::If)) if stop.wants(Rule::EOI) => {
                Some("a choice is a value that starts with `if`: let height = if wide then 3m else 2m".to_owned())
            }
            (_, Some(Kind::In)) if keyword == Kind::Let && stop.wants(Rule::EOI) => {
                Some("only a `let` inside an expression has an `in`; this one applies to the whole script".to_owned())
            }
            _ => None,
        }
    }
}
