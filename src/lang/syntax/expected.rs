//! What pest expected, in words for people.

use pest::error::{Error, ErrorVariant, InputLocation};

use super::Rule;
use super::ast::Span;
use super::scan::Tokens;
use super::token::Kind;
use crate::lang::diag::{Diagnostic, FileId};

/// One declaration that pest refused.
pub(super) struct Failure<'a> {
    pub source: &'a str,
    pub file: FileId,
    pub tokens: &'a Tokens,
    /// First token of the declaration.
    pub base: usize,
    /// Token after its last one.
    pub end: usize,
}

impl Failure<'_> {
    /// The report for an error of pest.
    pub fn diagnose(&self, error: &Error<Rule>) -> Diagnostic {
        let ErrorVariant::ParsingError { positives, .. } = &error.variant else {
            let place = self.tokens.span(self.base);
            return Diagnostic::new("E109", "nested too deep", self.file, place, "this declaration needs more stack than there is")
                .help("give the inner parts names of their own with `let`");
        };
        let byte = match error.location {
            InputLocation::Pos(at) | InputLocation::Span((at, _)) => at as u32 + self.tokens.starts[self.base],
        };
        let at = self.base + self.tokens.starts[self.base..self.end].partition_point(|&start| start < byte);
        let wanted = words(positives);
        if at >= self.end {
            let last = self.tokens.span(self.end - 1);
            let place = Span { start: last.end, end: last.end };
            return Diagnostic::new(
                "E102",
                format!("expected {wanted}, but the declaration ends here"),
                self.file,
                place,
                format!("{wanted} is missing"),
            );
        }
        let place = self.tokens.span(at);
        let found = self.text(at);
        Diagnostic::new("E102", format!("expected {wanted}, found `{found}`"), self.file, place, format!("expected {wanted}"))
    }

    fn text(&self, token: usize) -> &str {
        let span = self.tokens.span(token);
        &self.source[span.start as usize..span.end as usize]
    }

    #[allow(dead_code)]
    fn kind(&self, token: usize) -> Option<Kind> {
        self.tokens.kinds.get(token).copied().filter(|_| token < self.end)
    }
}

/// Names of rules for people, each once, joined.
fn words(rules: &[Rule]) -> String {
    let mut words: Vec<&str> = Vec::new();
    for word in rules.iter().filter_map(|&rule| word(rule)) {
        if !words.contains(&word) {
            words.push(word);
        }
    }
    match words.as_slice() {
        [] => "something else".to_owned(),
        [one] => (*one).to_owned(),
        [most @ .., last] => format!("{} or {last}", most.join(", ")),
    }
}

/// What people call a rule; none for what says nothing.
fn word(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::EOI => "the end of the declaration",
        Rule::expr | Rule::things | Rule::slice | Rule::group | Rule::reference => "an expression",
        Rule::infix => "an operator",
        Rule::name => "a name",
        Rule::word => "a name",
        Rule::type_ => "a type",
        Rule::string => "a string",
        Rule::args => "`(`",
        Rule::comma => "`,`",
        Rule::colon => "`:`",
        Rule::eq => "`=`",
        Rule::rpar => "`)`",
        Rule::rbracket => "`]`",
        Rule::rbrace => "`}`",
        Rule::lpar | Rule::parameters => "`(`",
        Rule::lbrace | Rule::settings | Rule::mesh_settings => "`{`",
        Rule::kw_of => "`of`",
        Rule::kw_in | Rule::let_in => "`in`",
        Rule::kw_to => "`to`",
        Rule::kw_as => "`as`",
        Rule::kw_then => "`then`",
        Rule::kw_else => "`else`",
        Rule::for_clause | Rule::kw_for => "`for`",
        Rule::setting => "a setting",
        Rule::clause => "`on`, `near` or `in`",
        Rule::unit_name => "a unit",
        Rule::kw_curve => "`curve`",
        Rule::arg => "an argument",
        Rule::pair => "a field",
        Rule::parameter => "a parameter",
        _ => return None,
    })
}
