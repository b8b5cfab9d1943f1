//! Functions and fields of imported tables and meshes.

use std::sync::Arc;

use glam::DVec3;

use crate::base::fault::ValueFault;
use crate::lang::eval::context::{Cx, Halt};
use crate::lang::values::table::Table;
use crate::lang::values::value::{Dim, Value};
use crate::{builtins, fields};

/// What a row lacks to be a point.
fn not_a_point(row: usize, what: &str) -> Halt {
    let found = format!("{what} in row {row}");
    ValueFault::OutsideRange { argument: "of", found, range: "a table of two or three columns of numbers".into() }.into()
}

/// Rows of two or three numbers as points; one length among them makes them lengths.
fn points(cx: &mut Cx, table: &Table) -> Result<Vec<Value>, Halt> {
    let bare = cx.bare_unit(cx.module());
    let mut out = Vec::with_capacity(table.rows.len());
    for (i, row) in table.rows.iter().enumerate() {
        let n = row.len().unwrap_or(0);
        if !(2..=3).contains(&n) {
            return Err(not_a_point(i, &format!("{n} columns")));
        }
        let (mut v, mut dims) = ([0.0; 3], [Dim::NONE; 3]);
        for k in 0..n {
            match row.item(k) {
                Some(Value::Number(q)) => (v[k], dims[k]) = (q.value, q.dim),
                other => return Err(not_a_point(i, &cx.kind(&other.unwrap_or_default()))),
            }
        }
        let dim = dims.into_iter().find(|d| !d.is_none()).unwrap_or(Dim::NONE);
        for k in 0..n {
            if dims[k].is_none() && dim == Dim::LENGTH {
                v[k] *= bare;
            } else if dims[k] != dim && v[k] != 0.0 {
                return Err(not_a_point(i, "numbers of several dimensions"));
            }
        }
        out.push(Value::Vector(DVec3::from_array(v), dim));
    }
    Ok(out)
}

/// The filled cells of a grid: rows begin with their place, the header has that of the columns.
fn cells(cx: &mut Cx, table: &Table) -> Result<Vec<Value>, Halt> {
    let Some(header) = &table.header else {
        let example = "import \"offsets.csv\" (header: true) as offsets";
        return Err(ValueFault::Missing { function: "cells", what: "a table with a header", example }.into());
    };
    let mut out = Vec::new();
    for row in table.rows.iter() {
        let place = row.item(0).unwrap_or_default();
        for k in 1..row.len().unwrap_or(0) {
            let value = row.item(k).unwrap_or_default();
            let column = header.get(k).cloned().unwrap_or_default();
            // A trailing comma makes a column without a head.
            if !matches!(value, Value::None) && !matches!(&column, Value::Text(t) if t.is_empty()) {
                out.push(cx.record([("row", place.clone()), ("column", column), ("value", value)]));
            }
        }
    }
    Ok(out)
}

builtins! {
    /// One column of a table, by the name in its header or its place from 0.
    ///
    /// ```loft
    /// // import "offsets.csv" as offsets
    /// // let z = offsets.column("z")
    /// let a = 1 // => 1
    /// ```
    fn column(
        /// A table.
        table: Arc<Table>,
        /// Name in the header, or a place from 0.
        name: Value,
    ) -> Vec<Value> = |cx, table, name| {
        let place = match &name {
            Value::Number(q) if q.dim.is_none() && q.value >= 0.0 => {
                let width = table.rows.first().and_then(Value::len).unwrap_or(0);
                Some(q.value as usize).filter(|k| *k < width)
            }
            other => {
                let text = cx.show(other);
                cx.names.find(&text).and_then(|id| table.keys.iter().position(|k| *k == id))
            }
        };
        match place {
            Some(k) => Ok(table.rows.iter().map(|r| r.item(k).unwrap_or_default()).collect()),
            None => {
                let names: Vec<&str> = table.keys.iter().map(|k| cx.names.text(*k)).collect();
                let range = if names.is_empty() { "a place inside the rows".to_owned() } else { format!("one of {}", names.join(", ")) };
                Err(ValueFault::OutsideRange { argument: "name", found: cx.show_inside(&name), range }.into())
            }
        }
    };
}

fields! {
    /// Rows of a table; with a header each also by name: `rows[3].x`.
    fn rows(of: Arc<Table>) -> Value = |_, of| Ok(Value::List(of.rows.clone()));
    /// Header of a table, `none` when it has none; what reads as a number is one.
    fn header(of: Arc<Table>) -> Value = |_, of| Ok(of.header.clone().map_or(Value::None, Value::List));
    /// Lines above the numbers of a dat or txt file.
    fn title(of: Arc<Table>) -> Arc<str> = |_, of| Ok(of.title.clone());
    /// Rows of two or three numbers as points.
    fn points(of: Arc<Table>) -> Vec<Value> = |cx, of| points(cx, &of);
    /// Filled cells of a grid headed by numbers, as `{row, column, value}`.
    fn cells(of: Arc<Table>) -> Vec<Value> = |cx, of| cells(cx, &of);
}
