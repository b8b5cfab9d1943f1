//! Cells, columns and rows of a table from their text.

use std::collections::BTreeMap;

use crate::base::limits;
use crate::base::text::parse_real;
use crate::io::files::fault::Malformed;
use crate::io::tables::table::{Cell, Table};

/// One cell; `unit` is its column's.
pub(crate) fn cell(text: &str, unit: Option<&str>, is_unit: &dyn Fn(&str) -> bool) -> Result<Cell, String> {
    let text = text.trim();
    if text.is_empty() {
        return Ok(Cell::None);
    }
    if let Some(x) = parse_real(text) {
        if !x.is_finite() {
            return Err(format!("{text} is too large a number"));
        }
        return Ok(unit.map_or(Cell::Number(x), |unit| Cell::Quantity(x, unit.to_owned())));
    }
    if !text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.')) {
        return Ok(Cell::Text(text.to_owned()));
    }
    // The number is the longest beginning that reads as one: `5e3m` has the exponent 3, `5em` none.
    let ends = text.char_indices().map(|(k, _)| k).filter(|k| *k > 0);
    let candidates = ends.filter(|k| text[..*k].ends_with(|c: char| c.is_ascii_digit() || c == '.'));
    for end in candidates.collect::<Vec<_>>().into_iter().rev().take(4) {
        if let Some(x) = parse_real(&text[..end])
            && is_unit(&text[end..])
        {
            return if x.is_finite() { Ok(Cell::Quantity(x, text[end..].to_owned())) } else { Err(format!("{text} is too large")) };
        }
    }
    Ok(Cell::Text(text.to_owned()))
}

pub(crate) fn is_number(text: &str, is_unit: &dyn Fn(&str) -> bool) -> bool {
    !matches!(cell(text, None, is_unit), Ok(Cell::Text(_) | Cell::None))
}

/// Names and units of a header: `x [mm]` is `x` in mm, `n [-]` a plain `n`.
pub(crate) type Columns = (Vec<String>, Vec<Option<String>>);

pub(crate) fn columns(cells: &[String], line: u64, is_unit: &dyn Fn(&str) -> bool) -> Result<Columns, Malformed> {
    let (mut names, mut units): Columns = (Vec::new(), Vec::new());
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    for (k, text) in cells.iter().enumerate() {
        let text = text.trim();
        let split = text.strip_suffix(']').and_then(|head| head.rsplit_once('[')).map(|(name, unit)| (name.trim(), unit.trim()));
        let (name, unit) = match split {
            Some((name, unit)) if is_unit(unit) => (name, Some(unit.to_owned())),
            Some((name, "-" | "1" | "")) => (name, None),
            _ => (text, None),
        };
        if !name.is_empty()
            && let Some(first) = known.insert(name, k)
        {
            let what = format!("two columns are called `{name}`: {} and {}", first + 1, k + 1);
            return Err(Malformed::at(line, k as u64 + 1, what));
        }
        names.push(name.to_owned());
        units.push(unit);
    }
    Ok((names, units))
}

/// Collects rows and keeps the limits.
pub(crate) struct Rows<'a> {
    pub(super) table: Table,
    pub(super) units: Vec<Option<String>>,
    pub(super) cells: usize,
    pub(super) is_unit: &'a dyn Fn(&str) -> bool,
}

impl<'a> Rows<'a> {
    pub(super) fn new(is_unit: &'a dyn Fn(&str) -> bool) -> Self {
        Self { table: Table::default(), units: Vec::new(), cells: 0, is_unit }
    }

    pub(super) fn header(&mut self, cells: &[String], line: u64) -> Result<(), Malformed> {
        let (names, units) = columns(cells, line, self.is_unit)?;
        self.table.header = Some(names);
        self.units = units;
        Ok(())
    }

    pub(super) fn row<'c>(&mut self, cells: impl Iterator<Item = &'c str>, line: u64) -> Result<(), Malformed> {
        let mut row = Vec::with_capacity(self.table.rows.last().map_or(8, Vec::len));
        for (k, text) in cells.enumerate() {
            let unit = self.units.get(k).and_then(Option::as_deref);
            row.push(cell(text, unit, self.is_unit).map_err(|what| Malformed::at(line, k as u64 + 1, what))?);
        }
        if row.iter().all(|cell| *cell == Cell::None) {
            return Ok(());
        }
        self.cells += row.len();
        if self.cells > limits::LIST_MEMBERS {
            return Err(Malformed::line(line, format!("the table has more than {} cells", limits::LIST_MEMBERS)));
        }
        self.table.rows.push(row);
        self.table.lines.push(line);
        Ok(())
    }
}
