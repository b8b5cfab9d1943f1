//! The last table of a run over variants: a line for each row with what it sets, whether it holds, and what it reports.

use super::summary::{Grid, cell, maybe};
use crate::session::report::{Case, Cell, Report, Table};

/// Names and texts of the cells of one line.
type CaseCells = Vec<(String, String)>;

/// The table of all cases.
pub fn text(cases: &[Case], color: bool) -> String {
    let lines: Vec<CaseCells> = cases.iter().map(line).collect();
    let mut head: Vec<String> = Vec::new();
    for line in &lines {
        let mut at = 0;
        for (name, _) in line {
            // A column that an earlier line does not have stands behind those that both have.
            match head.iter().position(|h| h == name) {
                Some(found) => at = found + 1,
                None => {
                    head.insert(at, name.clone());
                    at += 1;
                }
            }
        }
    }
    let mut grid = Grid::new(&head.iter().map(String::as_str).collect::<Vec<_>>());
    for line in &lines {
        let text = |name: &String| line.iter().find(|(n, _)| n == name).map_or_else(String::new, |(_, text)| text.clone());
        grid.rows.push(head.iter().map(text).collect());
    }
    let mut out = String::new();
    grid.print(&mut out, color);
    let long = |case: &Case| case.report.reports.iter().any(|table| table.rows.len() != 1);
    if cases.iter().any(long) {
        out.push_str("reports of several rows are not in this table: `--each` prints them, `--json` holds them\n");
    }
    out
}

/// One line: the row, its params, how it went, counts, and the reports of one row. Columns of numbers begin with `>`.
fn line(case: &Case) -> CaseCells {
    let report = &case.report;
    let said = |severity: &str| report.diagnostics.iter().filter(|d| d.severity == severity).map(|d| d.count).sum();
    let nonzero = |n: usize| if n == 0 { String::new() } else { n.to_string() };
    let mut line: CaseCells = vec![("case".to_owned(), case.case.clone())];
    line.extend(case.set.iter().map(|set| (format!(">{}", set.name), set.value.clone())));
    line.push(("result".to_owned(), if report.ok { "fine" } else { "FAILED" }.to_owned()));
    let failed: Vec<&str> = report.checks.iter().filter(|c| !c.pass).map(|c| c.label.as_str()).collect();
    let checks =
        if report.checks.is_empty() { String::new() } else { format!("{} of {}", report.checks.len() - failed.len(), report.checks.len()) };
    line.push((">checks".to_owned(), checks));
    line.push(("failed checks".to_owned(), failed.join(", ")));
    let areas: Vec<f64> = report.surfaces.iter().filter_map(|s| s.area).collect();
    let area = (!areas.is_empty()).then(|| areas.iter().sum());
    let counts = [
        (">errors", nonzero(said("error"))),
        (">warnings", nonzero(said("warning"))),
        (">nodes", nonzero(report.meshes.iter().map(|m| m.nodes).sum())),
        (">elements", nonzero(report.meshes.iter().map(|m| m.triangles + m.quads).sum())),
        (">area", maybe(area, &format!("{}2", report.units))),
    ];
    line.extend(counts.map(|(name, text)| (name.to_owned(), text)));
    reported(report, &mut line);
    line.push((">outputs".to_owned(), nonzero(report.outputs.len())));
    line
}

/// The cells of reports that have one row; a single value goes by the title of its report, as does what has the name of another column.
fn reported(report: &Report, line: &mut CaseCells) {
    for table in report.reports.iter().filter(|table| table.rows.len() == 1) {
        for (k, column) in table.columns.iter().enumerate() {
            let Some(value) = table.rows[0].get(k) else { continue };
            let unit = column.unit.as_ref().map(|unit| format!(" [{unit}]")).unwrap_or_default();
            let number = if matches!(value, Cell::Number(_)) { ">" } else { "" };
            let plain = format!("{number}{}{unit}", column.name);
            let taken = line.iter().any(|(name, _)| name.trim_start_matches('>') == plain.trim_start_matches('>'));
            let name = match (is_single(table), taken) {
                (true, _) => format!("{number}{}{unit}", table.title),
                (false, true) => format!("{number}{}: {}{unit}", table.title, column.name),
                (false, false) => plain,
            };
            line.push((name, cell(value)));
        }
    }
}

/// Whether a table is one value without a name of its own.
fn is_single(table: &Table) -> bool {
    matches!(table.columns.as_slice(), [column] if column.name == "value")
}
