//! Reads tables: csv (comma, semicolon or tab), dat and txt (blanks).

use crate::base::job;
use crate::io::files::fault::Malformed;
use crate::io::tables::cells::{Rows, is_number};
use crate::io::tables::table::{Layout, Reading, Table};
use crate::io::tables::text::{decode, separator, without_comments};

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

/// Line numbers of growing places; a row starts behind the empty lines before it.
pub(crate) struct LineCounter<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
}

impl LineCounter<'_> {
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

pub(crate) fn read_separated(text: &str, reading: &Reading) -> Result<Table, Malformed> {
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
    let mut lines = LineCounter { bytes: text.as_bytes(), at: 0, line: 1 };
    loop {
        job::poll();
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

pub(crate) fn read_blanks(text: &str, reading: &Reading) -> Result<Table, Malformed> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::tables::table::Cell;
    use crate::io::tables::table_write::write_csv;

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
