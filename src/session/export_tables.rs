//! Tables as csv: lengths as bare numbers in one unit, which a comment above the header states, so that `import` reads them again.

use super::export::{Written, no_mesh_settings, put, unit_of};
use crate::base::text::real;
use crate::io::Files;
use crate::io::files::fault::FormatFault;
use crate::io::formats::endings::{Sort, ending_for};
use crate::io::tables::table::{Cell, Table};
use crate::io::tables::table_write;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::values::plans::ExportSpec;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, Value};

/// Writes the one table of an export; E805 for a second thing.
pub(super) fn table(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<Written, Halt> {
    ending_for(spec.path_origin, &spec.path, Sort::Tables)?;
    no_mesh_settings(spec)?;
    let [(Value::Table(table), _)] = spec.things.as_slice() else {
        let of = spec.things.get(1).map_or(spec.origin, |thing| thing.1);
        let help = Some("one `export` for each".to_owned());
        return Err(FormatFault::Unsupported { of, what: "a file holds one table".to_owned(), help, edits: Vec::new() }.into());
    };
    let model = cx.unit();
    let unit = spec.units.map_or(model, |(unit, _)| unit);
    let cell = |value: Value| match value {
        Value::None => Cell::None,
        Value::Number(q) if q.dim == Dim::LENGTH => Cell::Number(units::convert(q.value, model, unit, 1)),
        Value::Number(q) if q.dim.is_none() => Cell::Number(q.value),
        Value::Number(q) => Cell::Quantity(q.value, units::unit_text(q.dim, model)),
        Value::Text(t) | Value::Word(t) => Cell::Text(t.to_string()),
        other => Cell::Text(cx.show(&other)),
    };
    let words = |cell: Cell| match cell {
        Cell::Number(x) => real(x),
        Cell::Quantity(x, unit) => format!("{}{unit}", real(x)),
        Cell::Text(text) => text,
        Cell::None => String::new(),
    };
    let rows = table.rows.iter().map(|row| (0..row.len().unwrap_or(0)).map(|k| cell(row.item(k).unwrap_or_default())).collect()).collect();
    let header = table.header.as_ref().map(|header| header.iter().map(|value| words(cell(value.clone()))).collect());
    let is_length = |value: &Value| matches!(value, Value::Number(q) if q.dim == Dim::LENGTH);
    let in_rows = || table.rows.iter().any(|row| (0..row.len().unwrap_or(0)).any(|k| row.item(k).is_some_and(|value| is_length(&value))));
    let has_lengths = table.header.iter().any(|header| header.iter().any(is_length)) || in_rows();
    let title = if has_lengths { vec![format!("lengths in {}", unit_of(cx, spec).0)] } else { Vec::new() };
    let written = Table { title, header, rows, lines: Vec::new() };
    put(spec, files, &mut |out| table_write::write_csv(&written, out).map(|()| Vec::new()))
}
