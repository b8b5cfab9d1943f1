//! Entries that change the script: declarations put in, replaced and taken out.

use super::{ANSWER, Answer, ENTRY, Notebook, Part, State, ended};
use crate::base::fault::Severity;
use crate::lang::diag::diagnostic::{Diagnostic, FileId, Sources};
use crate::lang::diag::render::render_all;
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::run::symbols::{Condition, Symbol};
use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::outline::{Outline, outline};
use crate::lang::syntax::parse;
use crate::lang::values::plans::ReportTable;
use crate::lang::words::names::Names;
use crate::session::collect;
use crate::session::live::Depth;
use crate::session::report::Table;

/// Head lines that a script has once.
const SINGLE: &[Keyword] = &[Keyword::Units, Keyword::Tolerance, Keyword::Snap];

/// Whether an entry without a keyword can only be a declaration with a misspelt one: `curv a = …`.
pub(super) fn is_meant_as_declaration(entry: &str) -> bool {
    let mut words = entry.split_whitespace();
    let word = |text: Option<&str>| text.is_some_and(|t| t.chars().all(|c| c.is_alphanumeric() || c == '_'));
    word(words.next()) && word(words.next()) && matches!(words.next(), Some("=" | "of" | "for"))
}

fn slice(text: &str, span: Span) -> &str {
    &text[span.start as usize..span.end as usize]
}

fn name_in<'t>(text: &'t str, entry: &Outline) -> Option<&'t str> {
    entry.name.map(|span| slice(text, span))
}

/// The text with a declaration put where the one of its name stands, else at the end.
fn with_declaration(text: &str, piece: &str, entry: &Outline, of: &str) -> String {
    let name = name_in(of, entry);
    let same = |o: &Outline| match (name, o.keyword) {
        (Some(name), _) => name_in(text, o) == Some(name),
        (None, Some(keyword)) if SINGLE.contains(&keyword) => o.keyword == entry.keyword,
        // An output typed again is the same output.
        (None, _) => slice(text, o.span) == slice(of, entry.span),
    };
    match outline(text).iter().find(|o| same(o)) {
        Some(old) => {
            let kept = &text[old.whole.start as usize..old.span.start as usize];
            // The doc comment of the old one stays unless the new one has its own.
            let kept = if piece.trim_start().starts_with("//") { "" } else { kept };
            format!("{}{kept}{}{}", &text[..old.whole.start as usize], ended(piece.trim()), &text[old.whole.end as usize..])
        }
        None if entry.keyword.is_some_and(|k| SINGLE.contains(&k)) => format!("{}{text}", ended(piece.trim())),
        None => format!("{}{}", ended(text), ended(piece.trim())),
    }
}

impl Notebook {
    /// Declarations: a new name is added, a known one redefined. What does not parse changes nothing.
    pub(super) fn declare(&mut self, entry: &str) -> Answer {
        if let Some(answer) = self.mistakes(entry) {
            return answer;
        }
        let mut text = self.now.state.text.clone();
        let found = outline(entry);
        for piece in &found {
            text = with_declaration(&text, slice(entry, piece.whole), piece, entry);
        }
        let mut named: Vec<String> = Vec::new();
        for name in found.iter().filter_map(|piece| name_in(entry, piece)) {
            if !named.iter().any(|n| n == name) {
                named.push(name.to_owned());
            }
        }
        let entered: Vec<&str> = found.iter().map(|piece| slice(entry, piece.span)).collect();
        let before = self.now.clone();
        let mut answer = self.change_and_look(State { text, sets: self.now.state.sets.clone() }, &named, &entered);
        if answer.stopped || self.now.state == before.state || !self.has_failed(&named, &entered) {
            return answer;
        }
        // What has no value is no part of the model that `:save` writes.
        self.now = before;
        answer.parts.retain(|part| matches!(part, Part::Said(_)));
        answer.say("nothing was changed");
        answer
    }

    /// Whether a declaration among these, by name or by its text, came to nothing.
    fn has_failed(&self, named: &[String], entered: &[&str]) -> bool {
        let text = |s: &Symbol| self.now.state.text.get(s.span.start as usize..s.span.end as usize).unwrap_or("");
        let own = |s: &&Symbol| match &s.name {
            Some(name) => named.contains(name),
            None => entered.contains(&text(s)),
        };
        self.now.symbols.iter().filter(own).any(|s| s.condition != Condition::Sound)
    }

    /// What a text says that does not parse.
    fn mistakes(&self, entry: &str) -> Option<Answer> {
        let (_, said) = parse(entry, FileId(0), &mut Names::default());
        if !said.iter().any(|d| d.severity() == Severity::Error) {
            return None;
        }
        let mut sources = Sources::default();
        sources.add(ENTRY, entry);
        Some(Answer { parts: vec![Part::Said(render_all(&said, &sources, self.color))], failed: true, ..Answer::default() })
    }

    /// The value of an expression.
    pub(super) fn ask(&mut self, entry: &str) -> Answer {
        if let Some(answer) = self.mistakes(&format!("let {ANSWER} = {entry}")).map(|a| self.mistakes_of_expression(entry).unwrap_or(a)) {
            return answer;
        }
        let head = format!("let {ANSWER} = ");
        let base = ended(&self.now.state.text).len();
        let state = self.with_answer(entry);
        let (mut shown, mut table) = (None, None);
        let result = self.run(&state, Depth::Values, &mut |cx| {
            if let Some(value) = cx.value_of(ANSWER) {
                let about = cx.describe(&value);
                let kind = cx.kind(&value);
                shown = Some(if about.is_empty() { kind } else { about });
                table = cx.table_of(&value).map(|t| shown_table(cx, &t));
            }
        });
        let outcome = match result {
            Ok(outcome) => outcome,
            Err(answer) => return answer,
        };
        let own = (base + head.len()) as u32;
        let said: Vec<Diagnostic> = outcome
            .diagnostics
            .iter()
            .filter(|d| d.labels.iter().any(|l| l.file == FileId(0) && l.span.start >= base as u32))
            .cloned()
            .collect();
        let mut answer = Answer { failed: said.iter().any(|d| d.severity() == Severity::Error), ..Answer::default() };
        if !said.is_empty() {
            let (said, sources) = self.moved(said, own, entry);
            answer.parts.push(Part::Said(render_all(&said, &sources, self.color)));
        }
        if let Some(text) = shown {
            answer.say(text);
        } else if answer.parts.is_empty() {
            answer.failed = true;
            let because = "what it asks for was not built";
            answer.say(format!("no value: {because} (`:why NAME` tells more)"));
        }
        answer.parts.extend(table.map(Part::Table));
        answer
    }

    /// The script with an expression as a declaration at its end.
    pub(super) fn with_answer(&self, entry: &str) -> State {
        State { text: format!("{}let {ANSWER} = {entry}\n", ended(&self.now.state.text)), sets: self.now.state.sets.clone() }
    }

    /// The mistakes of an expression, with places in the entry.
    fn mistakes_of_expression(&self, entry: &str) -> Option<Answer> {
        let head = format!("let {ANSWER} = ");
        let (_, said) = parse(&format!("{head}{entry}"), FileId(0), &mut Names::default());
        let mut sources = Sources::default();
        let file = sources.add(ENTRY, entry);
        let said: Vec<Diagnostic> = said.iter().map(|d| relabelled(d, head.len() as u32, file)).collect();
        (!said.is_empty()).then(|| Answer {
            parts: vec![Part::Said(render_all(&said, &sources, self.color))],
            failed: true,
            ..Answer::default()
        })
    }

    /// Reports about the hidden declaration of an expression, as reports about the entry; others keep their places.
    fn moved(&self, said: Vec<Diagnostic>, own: u32, entry: &str) -> (Vec<Diagnostic>, Sources) {
        let mut sources = Sources::default();
        sources.add(self.live.name(), &*self.now.state.text);
        let file = sources.add(ENTRY, entry);
        (said.iter().map(|d| relabelled(d, own, file)).collect(), sources)
    }

    /// Takes declarations out of the script.
    pub(super) fn without(&self, names: &[String], spans: &[(u32, u32)]) -> State {
        let text = &self.now.state.text;
        let gone = |o: &Outline| spans.iter().any(|s| s.0 == o.span.start);
        let kept: String = outline(text).iter().filter(|o| !gone(o)).map(|o| slice(text, o.whole)).collect();
        let sets = self.now.state.sets.iter().filter(|s| !names.contains(&s.0)).cloned().collect();
        State { text: kept, sets }
    }
}

/// A table as it is shown.
pub(super) fn shown_table(cx: &Cx<'_>, table: &ReportTable) -> Table {
    let made = collect::table(table);
    match cx.tolerance_used() {
        Some(tolerance) => made.rounded(&tolerance, cx.unit().name),
        None => made,
    }
}

/// Results of the checks and reports that were just entered, their texts given.
pub(super) fn outputs(cx: &Cx<'_>, entered: &[&str]) -> Vec<Part> {
    let symbols = cx.symbols();
    let own = |keyword: Keyword| {
        let of_kind = symbols.iter().filter(move |s| s.keyword == keyword);
        of_kind.map(|s| entered.contains(&cx.sources.text(s.file, s.span))).collect::<Vec<bool>>()
    };
    let (own_checks, own_reports) = (own(Keyword::Check), own(Keyword::Report));
    // One `check … for` gives several results; with any of those all results are shown.
    let shown = |own: &[bool], all: usize, k: usize| own.contains(&true) && (own.len() != all || own[k]);
    let all = cx.checks();
    let checks = all.iter().enumerate().filter(|(k, _)| shown(&own_checks, all.len(), *k));
    let mut parts: Vec<Part> =
        checks.map(|(_, c)| Part::Text(format!("check {}: {}", c.label, if c.pass { "holds" } else { "fails" }))).collect();
    let all = cx.reports();
    let tables = all.iter().enumerate().filter(|(k, _)| shown(&own_reports, all.len(), *k));
    parts.extend(tables.map(|(_, t)| Part::Table(shown_table(cx, t))));
    parts
}

/// Labels behind byte `own` of the main script are moved to the entry.
fn relabelled(diagnostic: &Diagnostic, own: u32, file: FileId) -> Diagnostic {
    diagnostic.moved(|at, span| match at == FileId(0) && span.start >= own {
        true => (file, Span { start: span.start - own, end: span.end.saturating_sub(own) }),
        false => (at, span),
    })
}
