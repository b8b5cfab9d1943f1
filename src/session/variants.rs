//! Tables of variants: a header of param names, each row one run.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use crate::base::text::real;
use crate::io::tables::cell_places::CellPlaces;
use crate::io::tables::table::{Cell, Layout, Reading};
use crate::io::tables::table_read::read;
use crate::lang::declare::params::{SetCell, TableRow};
use crate::lang::diag::span::Span;

/// One row of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Name of the case, also of its output folder.
    pub name: String,
    /// Params and the texts of their literals: those of the command line, then those of the row.
    pub sets: Vec<(String, String)>,
    /// Where the file says it.
    pub at: TableRow,
}

/// Column that names the cases.
const NAME: &str = "name";

/// The rows of a csv of this name; `sets` are the params set for all rows. The error is a sentence about the table.
///
/// A case is called by its column `name`, or by its number from 001. An empty cell leaves a param at its default.
pub fn rows(file: &str, bytes: &[u8], sets: &[(String, String)]) -> Result<Vec<Row>, String> {
    let is_unit = |word: &str| crate::lang::values::units::quantity(1.0, word, crate::lang::values::units::MILLIMETRE).is_some();
    let reading = Reading { layout: Layout::Separated, header: Some(true), is_unit: &is_unit };
    let column = |at: Option<u64>| at.map_or_else(String::new, |column| format!(", column {column}"));
    let table = read(bytes, &reading).map_err(|at| format!("line {}{}: {}", at.line, column(at.column), at.what))?;
    let header = table.header.unwrap_or_default();
    let mut known = BTreeSet::new();
    if let Some(name) = header.iter().find(|name| !known.insert(name.as_str())) {
        return Err(format!("the column {name:?} is given twice"));
    }
    if let Some((name, _)) = sets.iter().find(|(name, _)| header.contains(name)) {
        return Err(format!("`{name}` is set by the table and by --set"));
    }
    let places = CellPlaces::new(bytes);
    let (file, text): (Arc<str>, Arc<str>) = (file.into(), places.text.into());
    let heads = places.row(places.first_line());
    let mut names = BTreeSet::new();
    let mut rows = Vec::new();
    for (number, cells) in table.rows.iter().enumerate() {
        let line = table.lines.get(number).copied().unwrap_or(0);
        let at = TableRow { file: file.clone(), text: text.clone(), number: number + 1, cells: Vec::new() };
        let stand = places.row(line);
        let mut row = Row { name: format!("{:03}", number + 1), sets: sets.to_vec(), at };
        for (k, (column, cell)) in header.iter().zip(cells).enumerate() {
            let Some(text) = literal(cell) else { continue };
            if column == NAME {
                row.name = text;
            } else {
                let (head, cell) = (span(heads.cell(k)), span(stand.cell(k)));
                row.at.cells.push(SetCell { name: column.clone(), column: k + 1, head, cell });
                row.sets.push((column.clone(), text));
            }
        }
        if !is_folder_name(&row.name) {
            return Err(format!("line {line}: {:?} cannot name an output folder", row.name));
        }
        if !names.insert(row.name.to_lowercase()) {
            return Err(format!("line {line}: there is a case {:?} already", row.name));
        }
        rows.push(row);
    }
    Ok(rows)
}

fn span(range: Range<usize>) -> Span {
    let place = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
    Span { start: place(range.start), end: place(range.end) }
}

/// The text of a cell as a literal of the language; `None` for an empty one.
fn literal(cell: &Cell) -> Option<String> {
    match cell {
        Cell::Number(x) => Some(real(*x)),
        Cell::Quantity(x, unit) => Some(format!("{}{unit}", real(*x))),
        Cell::Text(text) => Some(text.clone()),
        Cell::None => None,
    }
}

/// One component of a path on every system.
pub(super) fn is_folder_name(name: &str) -> bool {
    let forbidden = ['/', '\\', ':', '*', '?', '"', '<', '>', '|'];
    !name.is_empty() && !name.starts_with('.') && !name.contains(forbidden) && !name.chars().any(char::is_control)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_named_by_column_or_number() {
        let sets = [("n".to_owned(), "3".to_owned())];
        let found = rows("t.csv", b"name,span,kind\nlong,50m,quads\n,7.5,\n", &sets).unwrap();
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        let told: Vec<_> = found.iter().map(|row| (row.name.as_str(), row.sets.clone(), row.at.number)).collect();
        let long = vec![pair("n", "3"), pair("span", "50m"), pair("kind", "quads")];
        assert_eq!(told, [("long", long, 1), ("002", vec![pair("n", "3"), pair("span", "7.5")], 2)]);
        let cell = &found[1].at.cells[0];
        assert_eq!(
            (cell.name.as_str(), cell.column, &found[1].at.text[cell.cell.start as usize..cell.cell.end as usize]),
            ("span", 2, "7.5")
        );
    }

    #[test]
    fn names_are_folders_of_their_own() {
        let said = |text: &str| rows("t.csv", text.as_bytes(), &[]).unwrap_err();
        assert_eq!(said("name,n\na/b,1\n"), "line 2: \"a/b\" cannot name an output folder");
        assert_eq!(said("name,n\nA,1\na,2\n"), "line 3: there is a case \"a\" already");
        assert_eq!(said("n,n\n1,2\n"), "line 1, column 2: two columns are called `n`: 1 and 2");
        assert_eq!(rows("t.csv", b"n\n1\n", &[("n".into(), "2".into())]).unwrap_err(), "`n` is set by the table and by --set");
    }
}
