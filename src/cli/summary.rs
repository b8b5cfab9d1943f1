//! The report of a run for people: aligned tables on standard output.

use crate::base::job;
use crate::base::text::columns as width;
use crate::base::tolerance::Tolerance;
use crate::base::visible::{colored, visible};
use crate::session::report::{Cell, Report, Table};

/// Significant digits of a number in a summary; the JSON report has all.
const DIGITS: usize = 6;

/// A table as text: the first column and texts to the left, numbers to the right.
pub(super) struct Grid {
    head: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
    right: Vec<bool>,
}

impl Grid {
    /// Column names; those that begin with `>` hold numbers.
    pub(super) fn new(head: &[&str]) -> Self {
        let right = head.iter().map(|h| h.starts_with('>')).collect();
        Self { head: head.iter().map(|h| h.trim_start_matches('>').to_owned()).collect(), rows: Vec::new(), right }
    }

    pub(super) fn print(&self, out: &mut String, color: bool) {
        let columns = self.head.len();
        let seen = |row: &Vec<String>| row.iter().map(|cell| visible(cell).into_owned()).collect::<Vec<String>>();
        let all: Vec<Vec<String>> = job::looking(std::iter::once(&self.head).chain(&self.rows)).map(seen).collect();
        let lines = || all.iter();
        // A column without any value says nothing.
        let shown: Vec<usize> = (0..columns).filter(|&c| self.rows.iter().any(|r| !r[c].is_empty())).collect();
        let widths: Vec<usize> = (0..columns).map(|c| job::looking(lines()).map(|r| width(&r[c])).max().unwrap_or(0)).collect();
        for (number, row) in job::looking(lines().enumerate()) {
            let mut line = String::new();
            for (k, &c) in shown.iter().enumerate() {
                let pad = " ".repeat(widths[c] - width(&row[c]));
                let gap = if k == 0 { "" } else { "  " };
                line += &if self.right[c] { format!("{gap}{pad}{}", row[c]) } else { format!("{gap}{}{pad}", row[c]) };
            }
            let line = line.trim_end();
            out.push_str(&if number == 0 { dim(line, color) } else { line.to_owned() });
            out.push('\n');
        }
    }
}

fn dim(text: &str, color: bool) -> String {
    colored(text, "2", color)
}

/// A number in few digits.
pub fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let rounded: f64 = format!("{x:.*e}", DIGITS - 1).parse().unwrap_or(x);
    let text = format!("{rounded:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

pub(super) fn maybe(x: Option<f64>, unit: &str) -> String {
    x.map_or_else(String::new, |x| with_unit(x, unit))
}

fn with_unit(x: f64, unit: &str) -> String {
    if unit.is_empty() || unit.starts_with('°') { format!("{}{unit}", short(x)) } else { format!("{} {unit}", short(x)) }
}

fn yes(b: bool) -> String {
    if b { "yes" } else { "no" }.to_owned()
}

/// The whole summary of one run.
pub fn text(report: &Report, tolerance: Option<f64>, color: bool) -> String {
    let mut out = String::new();
    out.push_str(&counts(report));
    if let Some(tolerance) = tolerance {
        out.push_str(&dim(&format!("units {}, tolerance {}\n", report.units, with_unit(tolerance, &report.units)), color));
    }
    for block in [surfaces(report), shells(report), meshes(report)].into_iter().flatten() {
        out.push('\n');
        block.print(&mut out, color);
    }
    for table in &report.reports {
        out.push('\n');
        match tolerance {
            Some(point) => print_table(&table.clone().rounded(&Tolerance::new(point, 0.0), &report.units), &mut out, color),
            None => print_table(table, &mut out, color),
        }
    }
    if !report.checks.is_empty() {
        out.push('\n');
        checks(report, &mut out, color);
    }
    if let Some(grid) = unmade(report) {
        out.push('\n');
        grid.print(&mut out, color);
    }
    if !report.unwritten.is_empty() {
        out.push('\n');
        report.unwritten.iter().for_each(|path| out.push_str(&format!("not written, as the run failed: {path}\n")));
    }
    if !report.outputs.is_empty() {
        out.push('\n');
        report.outputs.iter().for_each(|o| out.push_str(&format!("wrote {}  {}\n", o.place, bytes(o.bytes))));
    }
    out
}

fn counts(report: &Report) -> String {
    let (n, t) = (&report.network, &report.topology);
    let plural = |count: usize, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
    let mut line = vec![
        plural(n.curves, "curve", "curves"),
        plural(n.links, "link", "links"),
        plural(n.nodes, "node", "nodes"),
        plural(report.modeling.len(), "modeling curve", "modeling curves"),
    ];
    if !report.surfaces.is_empty() {
        line.push(plural(t.patches, "patch", "patches"));
        line.push(plural(t.edges, "edge", "edges"));
        line.push(plural(t.vertices, "vertex", "vertices"));
    }
    format!("{}: {}\n", report.model, line.join(", "))
}

fn surfaces(report: &Report) -> Option<Grid> {
    let mut grid = Grid::new(&["surface", "kind", "flow", ">patches", ">edges", ">vertices", ">area"]);
    let unit = format!("{}2", report.units);
    for s in &report.surfaces {
        let counts = [s.patches, s.edges, s.vertices].map(|n| n.to_string());
        let [patches, edges, vertices] = counts;
        let flow = s.flow.clone().unwrap_or_default();
        grid.rows.push(vec![s.name.clone(), s.kind.to_owned(), flow, patches, edges, vertices, maybe(s.area, &unit)]);
    }
    (!grid.rows.is_empty()).then_some(grid)
}

fn shells(report: &Report) -> Option<Grid> {
    let mut grid = Grid::new(&["shell", ">faces", "closed", ">area", ">volume", ">gap", ">angle"]);
    let unit = |power: &str| format!("{}{power}", report.units);
    for s in &report.shells {
        let (area, volume, gap) = (maybe(s.area, &unit("2")), maybe(s.volume, &unit("3")), maybe(s.gap, &unit("")));
        grid.rows.push(vec![s.name.clone(), s.faces.to_string(), yes(s.closed), area, volume, gap, maybe(s.angle, "°")]);
    }
    (!grid.rows.is_empty()).then_some(grid)
}

fn meshes(report: &Report) -> Option<Grid> {
    let head = ["mesh", ">nodes", ">triangles", ">quads", ">min angle", ">max angle", ">quality", ">worst", ">area", ">chord error"];
    let mut grid = Grid::new(&[&head[..], &["watertight", ">parts", "groups"]].concat());
    for m in &report.meshes {
        let count = |n: usize| if n == 0 { String::new() } else { n.to_string() };
        let mut row = vec![m.name.clone(), m.nodes.to_string(), count(m.triangles), count(m.quads)];
        row.extend([maybe(m.min_angle, "°"), maybe(m.max_angle, "°"), maybe(m.mean_quality, ""), maybe(m.min_quality, "")]);
        row.extend([maybe(m.area, &format!("{}2", report.units)), maybe(m.chord_error, &report.units)]);
        row.push(m.watertight.map(yes).unwrap_or_default());
        row.push(m.parts.to_string());
        row.push(m.groups.len().to_string());
        grid.rows.push(row);
    }
    (!grid.rows.is_empty()).then_some(grid)
}

/// What failed, and what waits for it.
fn unmade(report: &Report) -> Option<Grid> {
    let mut grid = Grid::new(&["not made", "what", ">line", "because of"]);
    for row in &report.unmade {
        let line = if row.file == report.model { row.line.to_string() } else { format!("{}:{}", row.file, row.line) };
        let because = match row.because.as_deref() {
            None => "an error of its own".to_owned(),
            Some("") => "an error in what it uses".to_owned(),
            Some(name) => name.to_owned(),
        };
        grid.rows.push(vec![row.name.clone(), row.what.clone(), line, because]);
    }
    (!grid.rows.is_empty()).then_some(grid)
}

fn checks(report: &Report, out: &mut String, color: bool) {
    for check in &report.checks {
        let sides = match (cell(&check.left), cell(&check.right)) {
            (left, right) if left.is_empty() || right.is_empty() || check.pass => String::new(),
            (left, right) => format!("  ({left} against {right})"),
        };
        let word = if check.pass { colored("pass", "32", color) } else { colored("FAIL", "31", color) };
        out.push_str(&format!("{word}  {}\n", visible(&format!("{}{sides}", check.label))));
    }
}

/// A table under its title.
pub fn print_table(table: &Table, out: &mut String, color: bool) {
    if !table.title.is_empty() {
        out.push_str(&format!("{}\n", visible(&table.title)));
    }
    let number = |c: usize| table.rows.iter().any(|r| matches!(r.get(c), Some(Cell::Number(_))));
    let head: Vec<String> = table
        .columns
        .iter()
        .enumerate()
        .map(|(c, column)| {
            let unit = column.unit.as_ref().map(|u| format!(" [{u}]")).unwrap_or_default();
            format!("{}{}{unit}", if number(c) { ">" } else { "" }, column.name)
        })
        .collect();
    let mut grid = Grid::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for row in job::looking(&table.rows) {
        grid.rows.push((0..head.len()).map(|c| row.get(c).map(cell).unwrap_or_default()).collect());
    }
    grid.print(out, color);
}

pub(super) fn cell(cell: &Cell) -> String {
    match cell {
        Cell::Missing => String::new(),
        Cell::Bool(b) => b.to_string(),
        Cell::Number(x) => short(*x),
        Cell::Text(t) => t.clone(),
        Cell::List(items) => format!("({})", items.iter().map(self::cell).collect::<Vec<_>>().join(", ")),
    }
}

fn bytes(n: u64) -> String {
    const STEPS: [&str; 4] = ["B", "kB", "MB", "GB"];
    let mut size = n as f64;
    let mut step = 0;
    while size >= 1000.0 && step + 1 < STEPS.len() {
        size /= 1000.0;
        step += 1;
    }
    if step == 0 { format!("{n} B") } else { format!("{size:.1} {}", STEPS[step]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (x, expected) in [(0.1 + 0.2, "0.3"), (1234.56789, "1234.57"), (-0.0, "0"), (1e300, "1e300"), (12345678.0, "12345700")] {
            assert_eq!(short(x), expected);
        }
        assert_eq!(bytes(999), "999 B");
        assert_eq!(bytes(84_000_084), "84.0 MB");
    }
}
