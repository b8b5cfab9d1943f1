//! What a run found, as the lines of a golden file.

use super::cells::{self, Entry, measure_of};
use super::compare::Allowance;
use super::line::{Line, on_one_line};
use super::words::{Measure, Value, unit_of};
use crate::base::tolerance::ROUNDING_SHARE;
use crate::lang::diag::{Diagnostic, Sources};
use crate::session::report::{Cell, Column, Corners, CurveRow, MeshRow, ModelingRow, Report, ShellRow, SurfaceRow, Table};
use crate::session::run::Outcome;

/// Characters of quoted source; a longer stretch is cut, with `…` for what is left out.
const SOURCE: usize = 100;
/// Rows of a reported table that stand in a golden; of longer ones the number is compared and the first rows are.
const ROWS: usize = 1000;
/// Significant digits of numbers in lists inside lists, which are compared as they are written.
const INNER: usize = 6;

/// The lines of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// In the order of writing.
    pub lines: Vec<Line>,
    /// Diagonal of the model's box, model units; 0 when nothing has a place.
    pub size: f64,
}

/// All that a golden holds of this run. `hide` is a folder that messages may name and a golden may not.
pub fn of(outcome: &Outcome, hide: &str) -> Found {
    let size = outcome.report.bounds.map_or(0.0, |[a, b]| (glam::DVec3::from(b) - glam::DVec3::from(a)).length());
    let mut lines = of_report(&outcome.report, size);
    let row = |d: &Diagnostic| diagnostic(d, &outcome.sources, hide);
    lines.extend(outcome.diagnostics.iter().map(row));
    Found { lines, size }
}

fn of_report(report: &Report, size: f64) -> Vec<Line> {
    let make = Maker { model: &report.units, size };
    let mut lines = Vec::new();
    if report.network.curves > 0 {
        let (n, modeling) = (&report.network, report.modeling.len());
        let counts = [("curves", n.curves), ("links", n.links), ("nodes", n.nodes), ("modeling", modeling)];
        lines.push(counts.into_iter().fold(line("network", ""), |line, (word, n)| line.count(word, n)));
    }
    lines.extend(report.curves.iter().map(|row| make.curve(row)));
    // A whole curve without kinks stands there already.
    let is_curve = |m: &&ModelingRow| m.kinks == 0 && report.curves.iter().any(|c| c.name == m.name && c.links == m.links);
    lines.extend(report.modeling.iter().filter(|row| !is_curve(row)).map(|row| make.modeling(row)));
    if !report.surfaces.is_empty() {
        let t = &report.topology;
        let counts = [("patches", t.patches), ("edges", t.edges), ("vertices", t.vertices), ("shells", t.shells)];
        lines.push(counts.into_iter().fold(line("topology", ""), |line, (word, n)| line.count(word, n)));
    }
    lines.extend(report.surfaces.iter().map(|row| make.surface(row)));
    lines.extend(report.shells.iter().map(|row| make.shell(row)));
    lines.extend(report.meshes.iter().map(|row| make.mesh(row)));
    lines.extend(report.reports.iter().flat_map(|table| make.table(table)));
    let check = |row: &crate::session::report::CheckRow| line("check", &row.label).word("", if row.pass { "pass" } else { "fail" });
    lines.extend(report.checks.iter().map(check));
    lines.into_iter().map(|line| line.0).collect()
}

/// A line that grows word by word.
struct Growing(Line);

fn line(kind: &str, name: &str) -> Growing {
    Growing(Line { kind: kind.to_owned(), name: name.to_owned(), pairs: Vec::new() })
}

impl Growing {
    fn put(mut self, word: &'static str, value: Value) -> Self {
        self.0.pairs.push((word, value));
        self
    }
    fn count(self, word: &'static str, n: usize) -> Self {
        self.put(word, Value::Count(n as u64))
    }
    fn word(self, word: &'static str, text: &str) -> Self {
        self.put(word, Value::Word(text.to_owned()))
    }
    fn maybe(self, word: &'static str, value: Option<Value>) -> Self {
        match value {
            Some(value) => self.put(word, value),
            None => self,
        }
    }
}

/// Makes lines in a model unit.
struct Maker<'m> {
    model: &'m str,
    /// Diagonal of the model's box, model units.
    size: f64,
}

impl Maker<'_> {
    /// The number, or zero where it is nothing but rounding.
    fn clean(&self, x: f64, measure: Measure) -> f64 {
        let noise = Allowance { tolerance: ROUNDING_SHARE, size: self.size }.of(measure, 0.0);
        if x.abs() <= noise { 0.0 } else { x }
    }
    fn real(&self, x: f64, measure: Measure) -> Value {
        Value::Real(self.clean(x, measure), unit_of(measure, self.model))
    }
    fn length(&self, x: Option<f64>, power: u8) -> Option<Value> {
        x.map(|x| self.real(x, Measure::Length(power)))
    }
    fn angle(&self, x: Option<f64>) -> Option<Value> {
        x.map(|x| self.real(x, Measure::Angle))
    }
    fn ratio(&self, x: Option<f64>) -> Option<Value> {
        x.map(|x| self.real(x, Measure::Ratio))
    }
    fn corners(&self, corners: Option<Corners>) -> Option<Value> {
        let clean = |p: [f64; 3]| p.map(|x| self.clean(x, Measure::Length(1)));
        corners.map(|corners| Value::Corners(corners.map(clean), self.model.to_owned()))
    }

    fn curve(&self, row: &CurveRow) -> Growing {
        line("curve", &row.name).word("kind", row.kind).maybe("length", self.length(Some(row.length), 1)).count("links", row.links)
    }

    fn modeling(&self, row: &ModelingRow) -> Growing {
        let made = line("modeling", &row.name).maybe("length", self.length(Some(row.length), 1));
        made.count("links", row.links).count("kinks", row.kinks)
    }

    fn surface(&self, row: &SurfaceRow) -> Growing {
        let made = line("surface", &row.name).word("kind", row.kind);
        let made = made.maybe("flow", row.flow.clone().map(Value::Word));
        let made = made.count("patches", row.patches).count("edges", row.edges).count("vertices", row.vertices);
        made.maybe("area", self.length(row.area, 2)).maybe("box", self.corners(row.corners))
    }

    fn shell(&self, row: &ShellRow) -> Growing {
        let made = line("shell", &row.name).count("faces", row.faces).word("closed", yes(row.closed));
        let made = made.maybe("area", self.length(row.area, 2)).maybe("volume", self.length(row.volume, 3));
        let made = made.maybe("gap", self.length(row.gap, 1)).maybe("angle", self.angle(row.angle));
        made.maybe("box", self.corners(row.corners))
    }

    /// A reported table and its rows.
    fn table(&self, table: &Table) -> Vec<Growing> {
        let column = |c: &Column| c.unit.as_ref().map_or_else(|| c.name.clone(), |unit| format!("{} [{unit}]", c.name));
        let columns: Vec<String> = table.columns.iter().map(column).collect();
        let head = line("report", &table.title).count("rows", table.rows.len()).word("columns", &columns.join(", "));
        let row = |(k, row): (usize, &Vec<Cell>)| {
            let unit = |c: usize| table.columns.get(c).and_then(|c| c.unit.as_deref()).unwrap_or("");
            let cells = row.iter().enumerate().map(|(c, cell)| self.cell(cell, unit(c))).collect();
            line("row", &format!("{} {}", table.title, k + 1)).put("cells", Value::Cells(cells))
        };
        std::iter::once(head).chain(table.rows.iter().take(ROWS).enumerate().map(row)).collect()
    }

    fn cell(&self, cell: &Cell, unit: &str) -> Entry {
        let measure = measure_of(unit);
        let numbers = |list: bool, all: Vec<f64>| {
            let all = all.into_iter().map(|x| self.clean(x, measure)).collect();
            Entry::Numbers { list, all, unit: unit.to_owned() }
        };
        match cell {
            Cell::Missing => Entry::Text("-".to_owned()),
            Cell::Bool(is) => Entry::Text(is.to_string()),
            Cell::Number(x) => numbers(false, vec![*x]),
            Cell::Text(text) => Entry::Text(text.clone()),
            Cell::List(items) => {
                let plain = |item: &Cell| if let Cell::Number(x) = item { Some(*x) } else { None };
                match items.iter().map(plain).collect::<Option<Vec<f64>>>() {
                    Some(all) if !all.is_empty() => numbers(true, all),
                    _ => {
                        let inside: Vec<Entry> = items.iter().map(|item| self.cell(item, unit)).collect();
                        Entry::Text(format!("({})", cells::text(&inside, INNER)))
                    }
                }
            }
        }
    }

    fn mesh(&self, row: &MeshRow) -> Growing {
        let made = line("mesh", &row.name).count("nodes", row.nodes).count("triangles", row.triangles).count("quads", row.quads);
        let made = made.maybe("order", (row.order != 1).then(|| Value::Count(u64::from(row.order))));
        let made = made.maybe("min_angle", self.angle(row.min_angle)).maybe("max_angle", self.angle(row.max_angle));
        let made = made.maybe("mean_quality", self.ratio(row.mean_quality)).maybe("min_quality", self.ratio(row.min_quality));
        let made = made.maybe("max_aspect", self.ratio(row.max_aspect)).maybe("area", self.length(row.area, 2));
        let made = made.maybe("chord_error", self.length(row.chord_error, 1));
        let made = made.maybe("watertight", row.watertight.map(|w| Value::Word(yes(w).to_owned())));
        let made = made.maybe("parts", (row.parts != 1).then(|| Value::Count(row.parts as u64)));
        let mut groups: Vec<(String, u64)> = row.groups.iter().map(|g| (g.name.clone(), g.nodes as u64)).collect();
        groups.sort();
        let made = made.maybe("groups", (!groups.is_empty()).then_some(Value::Groups(groups)));
        made.maybe("hash", row.hash.clone().map(Value::Word))
    }
}

fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

/// A diagnostic, which quotes the source at its foremost label instead of counting lines.
fn diagnostic(found: &Diagnostic, sources: &Sources, hide: &str) -> Line {
    let message = if hide.is_empty() { found.message.clone() } else { found.message.replace(hide, "") };
    let mut made = line(found.code.0, &with_sorted_names(&on_one_line(&message)));
    if let Some(label) = found.labels.first() {
        made = made.word("at", &shortened(&on_one_line(sources.text(label.file, label.span))));
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

fn shortened(text: &str) -> String {
    let n = text.chars().count();
    if n <= SOURCE {
        return text.to_owned();
    }
    let head: String = text.chars().take(SOURCE / 2).collect();
    let tail: String = text.chars().skip(n - SOURCE / 2).collect();
    format!("{head}…{tail}")
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
