//! Writes tables as csv.

use std::io::{self, Write};

use crate::base::text::push_real;
use crate::io::tables::table::{Cell, Table};

/// Writes a csv with commas: the title as comments, the header, then a line per row; quantities with their unit, reals with all their digits.
pub fn write_csv(table: &Table, out: &mut dyn Write) -> io::Result<()> {
    for line in &table.title {
        writeln!(out, "# {line}")?;
    }
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
