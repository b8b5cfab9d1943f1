//! Tables: csv (comma, semicolon or tab), dat and txt (blanks), in and out.
//!
//! `#` starts a comment outside quotes. A cell is a number, a quantity (`50m`), text, or nothing. A csv's first line is
//! its header when no cell of it is a number; in dat and txt the lines above the first one all of numbers are the title.
//! A line without any value is no row.

use std::borrow::Cow;
use std::io::{self, Write};

use crate::base::fault::Malformed;
use crate::base::text::{parse_real, push_real};
use crate::base::{job, limits};

/// What stands in a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A bare number, finite.
    Number(f64),
    /// A number with a unit glued to it or in the column's header, for example `(50.0, "m")`.
    Quantity(f64, String),
    /// Anything else.
    Text(String),
    /// Empty.
    None,
}

impl Cell {
    /// The number of a number or quantity, in the unit it is written in.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(x) | Self::Quantity(x, _) => Some(*x),
            Self::Text(_) | Self::None => None,
        }
    }
}

/// A table as it stands in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Lines above the numbers (dat and txt only).
    pub title: Vec<String>,
    /// Names of the columns, without the unit in brackets.
    pub header: Option<Vec<String>>,
    /// Cells; all rows of a csv have the same length.
    pub rows: Vec<Vec<Cell>>,
    /// Line of each row in the file, from 1.
    pub lines: Vec<u64>,
}

/// How cells are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// csv: comma, semicolon or tab, whichever the file has; quotes.
    Separated,
    /// dat, txt: blanks.
    Blanks,
}

impl Layout {
    /// By a path's ending, or `None` when it is no table's.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension {
            "csv" => Some(Self::Separated),
            "dat" | "txt" => Some(Self::Blanks),
            _ => None,
        }
    }
}

/// What the language says about an import.
pub struct Reading<'a> {
    /// How cells are told apart.
    pub layout: Layout,
    /// `header: true` or `false`; `None` finds out.
    pub header: Option<bool>,
    /// Whether a word is a unit of the language (`mm`, `kg/m3`).
    pub is_unit: &'a dyn Fn(&str) -> bool,
}

/// Reads a table; the error has the line and the character or cell where it stops being one.
pub fn read(bytes: &[u8], reading: &Reading) -> Result<Table, Malformed> {
    let text = decode(bytes)?;
    let table = match reading.layout {
        Layout::Separated => read_separated(text, reading)?,
        Layout::Blanks => read_blanks(text, reading)?,
    };
    if table.rows.is_empty() {
        return Err(Malformed::line(1, "there is no row of values"));
    }
    Ok(table)
}

/// The text of a data file without its byte order mark, or where it is no text.
pub(crate) fn decode(bytes: &[u8]) -> Result<&str, Malformed> {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(Malformed::at(1, 1, "this is UTF-16 text; save it as UTF-8"));
    }
    let body = bytes.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(bytes);
    let (valid, bad) = match std::str::from_utf8(body) {
        Ok(text) => (text, None),
        Err(e) => (std::str::from_utf8(&body[..e.valid_up_to()]).unwrap_or(""), body.get(e.valid_up_to()).copied()),
    };
    let control = valid.char_indices().find(|(_, c)| c.is_control() && !matches!(c, '\t' | '\n' | '\r' | '\x0C' | '\u{85}'));
    let (at, byte) = match (control, bad) {
        (Some((at, c)), _) => (at, c as u32),
        (None, Some(byte)) => (valid.len(), u32::from(byte)),
        (None, None) => return Ok(valid),
    };
    let before = &valid[..at];
    let line = before.bytes().filter(|b| *b == b'\n').count() as u64 + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() as u64 + 1;
    let what = if control.is_some() {
        format!("the byte {byte:#04x} does not belong in a text file")
    } else {
        format!("the byte {byte:#04x} is not UTF-8 text; save the file as UTF-8")
    };
    Err(Malformed::at(line, column, what))
}

/// One cell; `unit` is its column's.
fn cell(text: &str, unit: Option<&str>, is_unit: &dyn Fn(&str) -> bool) -> Result<Cell, String> {
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

fn is_number(text: &str, is_unit: &dyn Fn(&str) -> bool) -> bool {
    !matches!(cell(text, None, is_unit), Ok(Cell::Text(_) | Cell::None))
}

/// Names and units of a header: `x [mm]` is `x` in mm, `n [-]` a plain `n`.
type Columns = (Vec<String>, Vec<Option<String>>);

fn columns(cells: &[String], line: u64, is_unit: &dyn Fn(&str) -> bool) -> Result<Columns, Malformed> {
    let (mut names, mut units): Columns = (Vec::new(), Vec::new());
    for (k, text) in cells.iter().enumerate() {
        let text = text.trim();
        let split = text.strip_suffix(']').and_then(|head| head.rsplit_once('[')).map(|(name, unit)| (name.trim(), unit.trim()));
        let (name, unit) = match split {
            Some((name, unit)) if is_unit(unit) => (name, Some(unit.to_owned())),
            Some((name, "-" | "1" | "")) => (name, None),
            _ => (text, None),
        };
        if !name.is_empty()
            && let Some(first) = names.iter().position(|known| known == name)
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
struct Rows<'a> {
    table: Table,
    units: Vec<Option<String>>,
    cells: usize,
    is_unit: &'a dyn Fn(&str) -> bool,
}

impl<'a> Rows<'a> {
    fn new(is_unit: &'a dyn Fn(&str) -> bool) -> Self {
        Self { table: Table::default(), units: Vec::new(), cells: 0, is_unit }
    }

    fn header(&mut self, cells: &[String], line: u64) -> Result<(), Malformed> {
        let (names, units) = columns(cells, line, self.is_unit)?;
        self.table.header = Some(names);
        self.units = units;
        Ok(())
    }

    fn row<'c>(&mut self, cells: impl Iterator<Item = &'c str>, line: u64) -> Result<(), Malformed> {
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

/// The text with comments blanked out; lines and the places in them stay.
pub(crate) fn without_comments(text: &str) -> Cow<'_, str> {
    if !text.contains('#') {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    let (mut quoted, mut comment) = (false, false);
    for c in text.chars() {
        match c {
            '\n' => comment = false,
            '"' if !comment => quoted = !quoted,
            '#' if !quoted => comment = true,
            _ => {}
        }
        if !comment {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// The separator that most of the first lines agree on; tab before semicolon before comma.
pub(crate) fn separator(text: &str) -> u8 {
    let lines = || text.lines().filter(|line| !line.trim().is_empty()).take(20);
    let count = |line: &str, separator: u8| {
        let mut quoted = false;
        let found = line.bytes().filter(|b| {
            quoted ^= *b == b'"';
            !quoted && *b == separator
        });
        found.count()
    };
    let score = |separator: u8| {
        let counts: Vec<usize> = lines().map(|line| count(line, separator)).collect();
        let same = counts.first().is_some_and(|first| *first > 0 && counts.iter().all(|n| n == first));
        (same, counts.iter().filter(|n| **n > 0).count())
    };
    let mut best = (b',', (false, 0));
    for candidate in [b'\t', b';', b','] {
        let score = score(candidate);
        if score > best.1 {
            best = (candidate, score);
        }
    }
    best.0
}

/// Line numbers of growing places; a row starts behind the empty lines before it.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
}

impl Lines<'_> {
    fn of(&mut self, place: usize) -> u64 {
        while let Some(byte) = self.bytes.get(self.at)
            && (self.at < place || matches!(byte, b'\r' | b'\n'))
        {
            self.line += u64::from(*byte == b'\n');
            self.at += 1;
        }
        self.line
    }
}

fn read_separated(text: &str, reading: &Reading) -> Result<Table, Malformed> {
    let text = without_comments(text);
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator(&text))
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut rows = Rows::new(reading.is_unit);
    let mut record = csv::StringRecord::new();
    let mut width = None;
    let mut first = true;
    let mut lines = Lines { bytes: text.as_bytes(), at: 0, line: 1 };
    loop {
        job::look();
        let more = reader.read_record(&mut record).map_err(|e| {
            let line = e.position().map_or(0, csv::Position::line);
            Malformed::line(line, "the line cannot be read as a row of cells")
        })?;
        if !more {
            break;
        }
        let line = lines.of(record.position().map_or(0, |p| p.byte() as usize));
        if record.iter().all(str::is_empty) {
            continue;
        }
        let cells = width.get_or_insert(record.len());
        if record.len() != *cells {
            let (n, at) = (record.len(), record.len().min(*cells) as u64 + 1);
            let what = format!("the row has {n} cell{}, the rows before have {cells}", if n == 1 { "" } else { "s" });
            return Err(Malformed::at(line, at, what));
        }
        let is_header = first && reading.header.unwrap_or_else(|| !record.iter().any(|text| is_number(text, reading.is_unit)));
        first = false;
        if is_header {
            let cells: Vec<String> = record.iter().map(str::to_owned).collect();
            rows.header(&cells, line)?;
        } else {
            rows.row(record.iter(), line)?;
        }
    }
    Ok(rows.table)
}

fn read_blanks(text: &str, reading: &Reading) -> Result<Table, Malformed> {
    let mut rows = Rows::new(reading.is_unit);
    let mut in_numbers = reading.header.is_some();
    let mut header_is_next = reading.header == Some(true);
    for (k, line) in text.lines().enumerate() {
        let number = k as u64 + 1;
        let content = line.split('#').next().unwrap_or("");
        let cells = || content.split_whitespace();
        if cells().next().is_none() {
            continue;
        }
        if header_is_next {
            header_is_next = false;
            let cells: Vec<String> = cells().map(str::to_owned).collect();
            rows.header(&cells, number)?;
            continue;
        }
        in_numbers = in_numbers || cells().all(|text| is_number(text, reading.is_unit));
        if !in_numbers {
            rows.table.title.push(content.trim().to_owned());
            continue;
        }
        rows.row(cells(), number)?;
        if let Some(header) = &rows.table.header
            && rows.table.rows.last().is_some_and(|row| row.len() > header.len())
        {
            return Err(Malformed::at(number, header.len() as u64 + 1, format!("the row is longer than its header of {}", header.len())));
        }
    }
    if rows.table.rows.is_empty() && text.contains([',', ';']) {
        return Err(Malformed::line(1, "no line is all numbers with blanks between; with commas it is a csv"));
    }
    Ok(rows.table)
}

/// Writes a csv with commas: the header, then a line per row; quantities with their unit, reals with all their digits.
pub fn write_csv(table: &Table, out: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(out);
    if let Some(header) = &table.header {
        writer.write_record(header)?;
    }
    let mut text = Vec::new();
    for row in &table.rows {
        for cell in row {
            text.clear();
            match cell {
                Cell::Number(x) => push_real(&mut text, *x),
                Cell::Quantity(x, unit) => {
                    push_real(&mut text, *x);
                    text.extend_from_slice(unit.as_bytes());
                }
                Cell::Text(words) => text.extend_from_slice(words.as_bytes()),
                Cell::None => {}
            }
            writer.write_field(&text)?;
        }
        writer.write_record(None::<&[u8]>)?;
    }
    writer.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_unit(text: &str) -> bool {
        ["mm", "m", "deg", "kg/m3", "%", "m2"].contains(&text)
    }

    fn csv(text: &str) -> Result<Table, Malformed> {
        read(text.as_bytes(), &Reading { layout: Layout::Separated, header: None, is_unit: &is_unit })
    }

    fn dat(text: &str, header: Option<bool>) -> Result<Table, Malformed> {
        read(text.as_bytes(), &Reading { layout: Layout::Blanks, header, is_unit: &is_unit })
    }

    fn number(x: f64) -> Cell {
        Cell::Number(x)
    }

    #[test]
    fn header_units_quantities_and_gaps() {
        let table = csv("\u{feff}name,x [mm],n [-]\r\n# a comment\r\n\"a, \"\"b\"\"\",50m,.5 # tail\r\n\r\nc,-3e2,\r\n,,\r\n").unwrap();
        assert_eq!(table.header, Some(vec!["name".to_owned(), "x".to_owned(), "n".to_owned()]));
        assert_eq!(table.rows[0], [Cell::Text("a, \"b\"".into()), Cell::Quantity(50.0, "m".into()), number(0.5)]);
        assert_eq!(table.rows[1], [Cell::Text("c".into()), Cell::Quantity(-300.0, "mm".into()), Cell::None]);
        assert_eq!((table.rows.len(), &table.lines), (2, &vec![3, 5]));
    }

    #[test]
    fn the_first_line_is_a_header_only_without_numbers() {
        assert_eq!(csv("a,b\n1,2\n").unwrap().header.unwrap(), ["a", "b"]);
        assert_eq!(csv("a,1\nb,2\n").unwrap().header, None);
        assert_eq!(csv("a,5mm\nb,2\n").unwrap().header, None);
        let outright = Reading { layout: Layout::Separated, header: Some(true), is_unit: &is_unit };
        let table = read(b"z,0.58,1\n0,2,3\n", &outright).unwrap();
        assert_eq!(table.header.unwrap(), ["z", "0.58", "1"]);
    }

    #[test]
    fn separators_are_found() {
        for text in ["a;b, c\n1;2\n", "a\tb, c\n1\t2\n", "a,\"b; c\"\n1,2\n"] {
            let table = csv(text).unwrap();
            assert_eq!((table.rows[0].clone(), table.header.unwrap().len()), (vec![number(1.0), number(2.0)], 2), "{text}");
        }
        assert_eq!(csv("1\n2\n").unwrap().rows.len(), 2);
    }

    #[test]
    fn words_that_begin_like_numbers_are_text() {
        assert_eq!(csv("3D,2nd,-,nan,5em\n").unwrap_err().what, "there is no row of values");
        let table = csv("3D,2nd,-,nan,5em,1e3m,7850kg/m3\n").unwrap();
        assert!(table.rows[0][..5].iter().all(|cell| matches!(cell, Cell::Text(_))));
        assert_eq!(table.rows[0][5..], [Cell::Quantity(1000.0, "m".into()), Cell::Quantity(7850.0, "kg/m3".into())]);
    }

    #[test]
    fn mistakes_have_a_place() {
        let place = |e: Malformed| (e.line, e.column);
        assert_eq!(place(csv("a,b\n1,2\n3\n").unwrap_err()), (3, Some(2)));
        assert_eq!(place(csv("a,b\n1,1e999\n").unwrap_err()), (2, Some(2)));
        assert_eq!(place(csv("a,a\n1,2\n").unwrap_err()), (1, Some(2)));
        assert_eq!(place(csv("a,b\n1,\u{1}\n").unwrap_err()), (2, Some(3)));
        let reading = Reading { layout: Layout::Separated, header: None, is_unit: &is_unit };
        assert_eq!(place(read(b"a,b\n1,\xe4\n", &reading).unwrap_err()), (2, Some(3)));
        assert_eq!(place(csv("").unwrap_err()), (1, None));
    }

    #[test]
    fn titles_above_columns_of_blanks() {
        let table = dat("NACA 0012\n\n  1.0  0.00126 # tail\n\t0.5 -5e-2\n", None).unwrap();
        assert_eq!(table.title, ["NACA 0012"]);
        assert_eq!(table.rows, [vec![number(1.0), number(0.00126)], vec![number(0.5), number(-0.05)]]);
        assert_eq!(table.lines, [3, 4]);
        let table = dat("x[mm] y\n1 2\n", Some(true)).unwrap();
        assert_eq!(table.rows[0], [Cell::Quantity(1.0, "mm".into()), number(2.0)]);
        assert_eq!(dat("x y\n1 2 3\n", Some(true)).unwrap_err().column, Some(3));
        assert!(dat("a,b\n1,2\n", None).unwrap_err().what.contains("csv"));
    }

    #[test]
    fn what_is_written_reads_back() {
        let table = csv("a,b\n1.5,\"x, y\"\n2m,\n").unwrap();
        let mut out = Vec::new();
        write_csv(&table, &mut out).unwrap();
        let again = csv(std::str::from_utf8(&out).unwrap()).unwrap();
        assert_eq!((again.header, again.rows), (table.header, table.rows));
    }
}
