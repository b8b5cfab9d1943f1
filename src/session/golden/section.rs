//! What a run found, as the lines of a golden file.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use super::cells::{CellValue, measure_of, together};
use super::compare::{Allowance, one_thing};
use super::details::{Detail, Details, Pairs};
use super::diff::size_of;
use super::line::{Line, on_one_line};
use super::line_builder::{LineBuilder, line, yes};
use super::quote;
use super::values::Value;
use super::words::{Kind, Measure, fields_of, unit_of};
use crate::base::tolerance::ROUNDING_SHARE;
use crate::lang::diag::diagnostic::{Diagnostic, FileId, Sources};
use crate::session::report::{Cell, Column, Corners, CurveRow, MeshRow, ModelingRow, Report, ShellRow, SurfaceRow, Table};
use crate::session::run::Outcome;

/// Rows of a table that stand in a golden one by one; those of a longer one behind them stand there together, without tolerance.
const ROWS: usize = 10_000;

/// The lines of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaseLines {
    /// In the order of writing.
    pub lines: Vec<Line>,
    /// Diagonal of the model's box, model units; 0 when nothing has a place.
    pub size: f64,
    /// Names that the script and its modules use.
    pub names: BTreeSet<String>,
}

/// All that a golden holds of this run. `hide` is a folder that messages may name and a golden may not.
pub fn of(outcome: &Outcome, details: Details, hide: &str) -> CaseLines {
    let of_curves = outcome.report.bounds.map_or(0.0, |[a, b]| (glam::DVec3::from(b) - glam::DVec3::from(a)).length());
    // Without curves the boxes of what there is give the size.
    let size = if of_curves > 0.0 { of_curves } else { size_of(&of_report(&outcome.report, details.clone(), 0.0)) };
    let mut lines = of_report(&outcome.report, details, size);
    lines.iter_mut().for_each(|line| clean(line, size));
    let row = |d: &Diagnostic| diagnostic(d, &outcome.sources, hide);
    lines.extend(outcome.diagnostics.iter().map(row));
    let texts = (0..).map_while(|k| outcome.sources.get(FileId::at(k)));
    let names = texts.flat_map(|file| quote::tokens(&file.text).into_iter().filter(|t| quote::is_name(t)).map(Cow::into_owned)).collect();
    CaseLines { lines, size, names }
}

fn of_report(report: &Report, details: Details, size: f64) -> Vec<Line> {
    let make = LineMaker { model: &report.units };
    let mut lines = Vec::new();
    if report.network.curves > 0 {
        let (n, modeling) = (&report.network, report.modeling.len());
        let counts = [("curves", n.curves), ("links", n.links), ("nodes", n.nodes), ("modeling", modeling)];
        lines.push(counts.into_iter().fold(line("network", ""), |line, (word, n)| line.count(word, n)));
    }
    // A run that failed early has no details.
    let beside = |all: &[Detail], k: usize| all.get(k).cloned().unwrap_or_default();
    let with_detail = |made: LineBuilder, detail: Detail| made.all(detail.pairs).unnamed(detail.unnamed);
    lines.extend(details.points.into_iter().map(LineBuilder));
    lines.extend(report.curves.iter().enumerate().map(|(k, row)| with_detail(make.curve(row), beside(&details.curves, k))));
    // A whole curve without kinks stands there already, under its name or without one.
    let whole: Vec<Line> = lines.iter().filter(|line| line.0.kind == "curve").map(|line| line.0.clone()).collect();
    let is_curve = |(row, line): &(&ModelingRow, LineBuilder)| {
        let there = |c: &Line| if line.0.unnamed { c.unnamed && one_thing(c, &line.0, size) } else { c.name == line.0.name };
        row.kinks == 0 && whole.iter().any(|c| there(c) && c.get("links") == line.0.get("links"))
    };
    let modeling = report.modeling.iter().enumerate().map(|(k, row)| (row, with_detail(make.modeling(row), beside(&details.modeling, k))));
    lines.extend(modeling.filter(|found| !is_curve(found)).map(|found| found.1));
    if !report.surfaces.is_empty() {
        let t = &report.topology;
        let counts = [("patches", t.patches), ("edges", t.edges), ("vertices", t.vertices), ("shells", t.shells)];
        lines.push(counts.into_iter().fold(line("topology", ""), |line, (word, n)| line.count(word, n)));
    }
    lines.extend(report.surfaces.iter().enumerate().map(|(k, row)| with_detail(make.surface(row), beside(&details.surfaces, k))));
    let by_name = |all: &BTreeMap<String, Pairs>, name: &str| all.get(name).cloned().unwrap_or_default();
    lines.extend(report.shells.iter().map(|row| make.shell(row).all(by_name(&details.shells, &row.name))));
    lines.extend(details.groups.into_iter().chain(details.settings).map(LineBuilder));
    lines.extend(report.meshes.iter().map(|row| make.mesh(row, &details.declared).all(by_name(&details.meshes, &row.name))));
    lines.extend(details.sets.into_iter().map(LineBuilder));
    let tables = report.reports.iter().enumerate();
    lines.extend(tables.flat_map(|(k, table)| make.table(table, !details.labelled.get(k).copied().unwrap_or(true))));
    let check = |row: &crate::session::report::CheckRow| line("check", &row.label).word("", if row.pass { "pass" } else { "fail" });
    lines.extend(report.checks.iter().enumerate().map(|(k, row)| with_detail(check(row), beside(&details.checks, k))));
    lines.extend(details.outputs.into_iter().map(LineBuilder));
    for (path, table) in details.exported {
        lines.extend(make.rows(&Table { title: path, ..table }));
    }
    lines.into_iter().map(|line| line.0).collect()
}

/// Makes what is nothing but rounding zero.
fn clean(line: &mut Line, size: f64) {
    let noise = Allowance { tolerance: ROUNDING_SHARE, size };
    let put = |x: &mut f64, measure: Measure| {
        if x.abs() <= noise.of(measure, 0.0) {
            *x = 0.0;
        }
    };
    for (word, value) in &mut line.pairs {
        let kind = fields_of(&line.kind).find(|field| field.word == *word).map(|field| field.kind);
        match (value, kind) {
            (Value::Real(x, _), Some(Kind::Real(measure))) => put(x, measure),
            (Value::List(all, _), Some(Kind::List(measure))) => all.iter_mut().for_each(|x| put(x, measure)),
            (Value::Corners(corners, _), _) => corners.iter_mut().flatten().for_each(|x| put(x, Measure::Length(1))),
            // A tolerance may be as small as one likes.
            (Value::Cells(_), Some(Kind::Limit)) => {}
            (Value::Cells(row), _) => row.iter_mut().for_each(|entry| {
                if let CellValue::Numbers { all, unit, .. } = entry {
                    let measure = measure_of(unit);
                    all.iter_mut().for_each(|x| put(x, measure));
                }
            }),
            _ => {}
        }
    }
}

/// Makes lines in a model unit.
struct LineMaker<'m> {
    model: &'m str,
}

impl LineMaker<'_> {
    fn length(&self, x: Option<f64>, power: u8) -> Option<Value> {
        x.map(|x| Value::Real(x, unit_of(Measure::Length(power), self.model)))
    }
    fn angle(&self, x: Option<f64>) -> Option<Value> {
        x.map(|x| Value::Real(x, unit_of(Measure::Angle, self.model)))
    }
    fn ratio(&self, x: Option<f64>) -> Option<Value> {
        x.map(|x| Value::Real(x, String::new()))
    }
    fn corners(&self, corners: Option<Corners>) -> Option<Value> {
        corners.map(|corners| Value::Corners(corners, self.model.to_owned()))
    }

    fn curve(&self, row: &CurveRow) -> LineBuilder {
        line("curve", &row.name).word("kind", row.kind).maybe("length", self.length(Some(row.length), 1)).count("links", row.links)
    }

    fn modeling(&self, row: &ModelingRow) -> LineBuilder {
        let made = line("modeling", &row.name).maybe("length", self.length(Some(row.length), 1));
        made.count("links", row.links).count("kinks", row.kinks)
    }

    fn surface(&self, row: &SurfaceRow) -> LineBuilder {
        let made = line("surface", &row.name).word("kind", row.kind);
        let made = made.maybe("flow", row.flow.clone().map(Value::Word));
        let made = made.count("patches", row.patches).count("edges", row.edges).count("vertices", row.vertices);
        made.maybe("area", self.length(row.area, 2)).maybe("box", self.corners(row.corners))
    }

    fn shell(&self, row: &ShellRow) -> LineBuilder {
        let made = line("shell", &row.name).count("faces", row.faces).word("closed", yes(row.closed));
        let made = made.maybe("area", self.length(row.area, 2)).maybe("volume", self.length(row.volume, 3));
        let made = made.maybe("gap", self.length(row.gap, 1)).maybe("angle", self.angle(row.angle));
        made.maybe("box", self.corners(row.corners))
    }

    /// A reported table and its rows.
    fn table(&self, table: &Table, unnamed: bool) -> Vec<LineBuilder> {
        let column = |c: &Column| c.unit.as_ref().map_or_else(|| c.name.clone(), |unit| format!("{} [{unit}]", c.name));
        let columns: Vec<String> = table.columns.iter().map(column).collect();
        let head = line("report", &table.title).count("rows", table.rows.len()).word("columns", &columns.join(", "));
        std::iter::once(head).chain(self.rows(table)).map(|line| line.unnamed(unnamed)).collect()
    }

    /// The rows of a table; of a long one the first, and one that is made of all the others.
    fn rows(&self, table: &Table) -> Vec<LineBuilder> {
        let unit = |c: usize| table.columns.get(c).and_then(|c| c.unit.as_deref()).unwrap_or("");
        let cells = |row: &[Cell]| row.iter().enumerate().map(|(c, cell)| CellValue::of(cell, unit(c))).collect();
        let row = |name: String, row: &[Cell]| line("row", &format!("{} {name}", table.title)).put("cells", Value::Cells(cells(row)));
        let (first, rest) = table.rows.split_at(table.rows.len().min(ROWS));
        let mut made: Vec<LineBuilder> = first.iter().enumerate().map(|(k, cells)| row((k + 1).to_string(), cells)).collect();
        if !rest.is_empty() {
            made.push(row("rest".to_owned(), &together(rest)));
        }
        made
    }

    fn mesh(&self, row: &MeshRow, declared: &BTreeSet<String>) -> LineBuilder {
        let made = line("mesh", &row.name).count("nodes", row.nodes).count("triangles", row.triangles).count("quads", row.quads);
        let made = made.maybe("order", (row.order != 1).then(|| Value::Count(u64::from(row.order))));
        let made = made.maybe("min_angle", self.angle(row.min_angle)).maybe("max_angle", self.angle(row.max_angle));
        let made = made.maybe("mean_quality", self.ratio(row.mean_quality)).maybe("min_quality", self.ratio(row.min_quality));
        let made = made.maybe("max_aspect", self.ratio(row.max_aspect)).maybe("area", self.length(row.area, 2));
        let made = made.maybe("chord_error", self.length(row.chord_error, 1));
        let made = made.maybe("watertight", row.watertight.map(|w| Value::Word(yes(w).to_owned())));
        let made = made.maybe("parts", (row.parts != 1).then_some(Value::Count(row.parts as u64)));
        let mut groups: Vec<(String, u64)> =
            row.groups.iter().filter(|g| declared.contains(&g.name)).map(|g| (g.name.clone(), g.nodes as u64)).collect();
        groups.sort();
        let made = made.maybe("groups", (!groups.is_empty()).then_some(Value::Groups(groups)));
        made.maybe("hash", row.hash.clone().map(Value::Word))
    }
}

/// A diagnostic, which quotes the source at its foremost label instead of counting lines.
fn diagnostic(found: &Diagnostic, sources: &Sources, hide: &str) -> Line {
    let message = if hide.is_empty() { found.message.clone() } else { found.message.replace(hide, "") };
    let mut made = line(found.code.0, &with_sorted_names(&on_one_line(&message)));
    if let Some(label) = found.labels.first() {
        made = made.word("at", &quote::on_one_line(sources.text(label.file, label.span)));
        if label.file.index() > 0
            && let Some(file) = sources.get(label.file)
        {
            made = made.word("in", &on_one_line(&file.name));
        }
    }
    if found.more > 0 {
        made = made.count("more", found.more);
    }
    made.0
}

/// Lists of names between backquotes in order of the names: a message may list them as declared.
fn with_sorted_names(message: &str) -> String {
    const BETWEEN: &str = "`, `";
    let mut out = String::new();
    let mut rest = message;
    while let Some(start) = rest.find('`') {
        let (before, list) = rest.split_at(start + 1);
        let mut end = 0;
        while let Some(close) = list[end..].find('`') {
            end += close;
            if !list[end..].starts_with(BETWEEN) {
                break;
            }
            end += BETWEEN.len();
        }
        let mut names: Vec<&str> = list[..end].split(BETWEEN).collect();
        names.sort_unstable();
        out.push_str(before);
        out.push_str(&names.join(BETWEEN));
        let after = list[end..].strip_prefix('`');
        out.push_str(if after.is_some() { "`" } else { "" });
        rest = after.unwrap_or(&list[end..]);
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_messages_have_an_order_of_their_own() {
        let check = |message, expected| assert_eq!(with_sorted_names(message), expected);
        check("cannot hold `b`, `a`, `c` here", "cannot hold `a`, `b`, `c` here");
        check("`b` and `a`", "`b` and `a`");
        check("`b`, `a` and `d`, `c`", "`a`, `b` and `c`, `d`");
        check("an open ` here", "an open ` here");
        check("none", "none");
    }
}
