//! What a run said, checked and reported, as a page lists it.

use super::frame::{Check, Output, Place, Said, Table, Thing};
use super::places::place;
use crate::lang::diag::diagnostic::{Diagnostic, Sources};
use crate::lang::eval::context::Cx;
use crate::lang::run::symbols::Symbol;
use crate::lang::syntax::ast::Keyword;
use crate::session::report::Report;

/// Reports of one run.
pub(super) fn diagnostics(found: &[Diagnostic], sources: &Sources, things: &[Thing]) -> Vec<Said> {
    found.iter().map(|diagnostic| said(diagnostic, sources, things)).collect()
}

fn said(diagnostic: &Diagnostic, sources: &Sources, things: &[Thing]) -> Said {
    let places: Vec<Place> = diagnostic.labels.iter().filter_map(|l| place(sources, l.file, l.span, Some(&l.text))).collect();
    let speaks = |thing: &&Thing| thing.chain.first().is_some_and(|line| places.iter().any(|p| stands_in(p, line)));
    Said {
        severity: diagnostic.severity().word(),
        code: diagnostic.code.0.to_owned(),
        message: diagnostic.message.clone(),
        help: diagnostic.help.clone(),
        things: things.iter().filter(speaks).map(|thing| thing.name.clone()).collect(),
        places,
        points: diagnostic.spot.points.iter().filter(|p| p.is_finite()).map(|p| p.to_array()).collect(),
        size: match diagnostic.spot.points[..] {
            [a, b] => Some(a.distance(b)),
            _ => diagnostic.spot.length,
        }
        .filter(|x| x.is_finite()),
    }
}

/// Whether a place lies in the lines of another one.
fn stands_in(inner: &Place, outer: &Place) -> bool {
    inner.file == outer.file && inner.line >= outer.line && inner.line <= outer.end_line
}

/// What is known of checks, reports, pictures and exports only while the model is there.
#[derive(Default)]
pub(super) struct Statements {
    checks: Vec<Check>,
    reports: Vec<Place>,
    pub pictures: Vec<Output>,
    pub outputs: Vec<Output>,
}

/// The statements of the main script.
pub(super) fn statements(cx: &Cx, symbols: &[Symbol]) -> Statements {
    let sources = &cx.program.sources;
    let stands = |symbol: &Symbol| place(sources, symbol.file, symbol.span, None);
    let of = |keyword: Keyword| symbols.iter().filter(move |symbol| symbol.keyword == keyword);
    let check = |result: crate::lang::values::plans::CheckResult| {
        let own = place(sources, result.file, result.span, None).unwrap_or_default();
        let line = of(Keyword::Check)
            .find(|symbol| symbol.file == result.file && symbol.span.start <= result.span.start && result.span.end <= symbol.span.end);
        let needs = line.map(|symbol| &symbol.needs[..]).unwrap_or_default();
        Check {
            name: result.label.clone(),
            text: sources.text(result.file, result.span).to_owned(),
            pass: result.pass,
            found: result.left.clone(),
            place: own,
            things: needs.iter().filter_map(|k| symbols.get(*k)?.name.clone()).collect(),
        }
    };
    let at = |origin| cx.span_of(origin).and_then(|(file, span)| place(sources, file, span, None));
    Statements {
        checks: cx.checks().into_iter().map(check).collect(),
        reports: of(Keyword::Report).filter_map(stands).collect(),
        pictures: cx.pictures().into_iter().map(|spec| Output { place: at(spec.path_origin), path: spec.path }).collect(),
        outputs: cx.exports().into_iter().map(|spec| Output { place: at(spec.path_origin), path: spec.path }).collect(),
    }
}

impl Statements {
    /// Checks, and reports with their tables; those of one line are taken in turn.
    pub fn with(&self, report: &Report) -> (Vec<Check>, Vec<Table>) {
        let table = |(k, table): (usize, &crate::session::report::Table)| Table {
            name: table.title.clone(),
            title: table.title.clone(),
            columns: table.columns.iter().map(|column| column.name.clone()).collect(),
            units: table.columns.iter().map(|column| column.unit.clone().unwrap_or_default()).collect(),
            rows: table.rows.clone(),
            place: if self.reports.len() == report.reports.len() { self.reports.get(k).cloned() } else { None },
        };
        (self.checks.clone(), report.reports.iter().enumerate().map(table).collect())
    }
}
