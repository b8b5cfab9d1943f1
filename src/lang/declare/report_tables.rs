//! Values as the tables that a `report` shows.

use std::sync::Arc;

use crate::lang::eval::context::Cx;
use crate::lang::values::plans::{Column, ReportTable};
use crate::lang::values::units;
use crate::lang::values::value::{Dim, Value};

impl Cx<'_> {
    /// A record, or a list of records, as a table; `None` for other values.
    pub fn table_of(&mut self, value: &Value) -> Option<ReportTable> {
        let tabular = match value {
            Value::Record(_) => true,
            Value::List(items) => matches!(items.first(), Some(Value::Record(_))),
            _ => false,
        };
        tabular.then(|| self.table(String::new(), value))
    }

    /// A table, a list or a record by rows; anything else as one cell.
    pub(crate) fn table(&mut self, title: String, value: &Value) -> ReportTable {
        match value {
            Value::Table(t) => {
                let names = match &t.header {
                    Some(header) => header.iter().map(|v| self.show(v)).collect(),
                    None => Vec::new(),
                };
                let rows: Vec<Vec<Value>> = t.rows.iter().map(|r| (0..r.len().unwrap_or(0)).filter_map(|i| r.item(i)).collect()).collect();
                self.with_units(title, names, rows)
            }
            Value::List(items) if !items.is_empty() && items.iter().all(|v| matches!(v, Value::Record(_))) => {
                let mut keys = Vec::new();
                for item in items.iter() {
                    if let Value::Record(r) = item {
                        for key in r.keys.iter() {
                            if !keys.contains(key) {
                                keys.push(*key);
                            }
                        }
                    }
                }
                let row = |v: &Value| match v {
                    Value::Record(r) => keys.iter().map(|k| r.get(*k).cloned().unwrap_or_default()).collect(),
                    _ => Vec::new(),
                };
                let rows = items.iter().map(row).collect();
                let names = keys.iter().map(|k| self.names.text(*k).to_owned()).collect();
                self.with_units(title, names, rows)
            }
            Value::Record(r) => {
                let names = r.keys.iter().map(|k| self.names.text(*k).to_owned()).collect();
                self.with_units(title, names, vec![r.values.clone()])
            }
            list if list.len().is_some() => {
                let items: Vec<Value> = (0..list.len().unwrap_or(0)).filter_map(|i| list.item(i)).collect();
                let rows: Vec<Vec<Value>> = items
                    .iter()
                    .map(|v| match v.len() {
                        Some(n) => (0..n).filter_map(|i| v.item(i)).collect(),
                        None => vec![v.clone()],
                    })
                    .collect();
                let width = rows.iter().map(Vec::len).max().unwrap_or(1);
                let names = if width == 1 { vec!["value".into()] } else { (1..=width).map(|i| i.to_string()).collect() };
                self.with_units(title, names, rows)
            }
            other => self.with_units(title, vec!["value".into()], vec![vec![other.clone()]]),
        }
    }

    /// Columns with the unit that all their numbers and points share; where they differ, cells are texts with their units.
    pub(crate) fn with_units(&self, title: String, mut names: Vec<String>, mut rows: Vec<Vec<Value>>) -> ReportTable {
        let width = rows.iter().map(Vec::len).max().unwrap_or(0).max(names.len());
        names.extend((names.len()..width).map(|i| (i + 1).to_string()));
        let mut columns = Vec::with_capacity(width);
        for (k, name) in names.into_iter().enumerate() {
            let mut dims = rows.iter().filter_map(|r| match r.get(k) {
                Some(Value::Number(q)) => Some(q.dim),
                Some(Value::Vector(_, dim)) => Some(*dim),
                Some(Value::Node(_)) => Some(Dim::LENGTH),
                _ => None,
            });
            let dim = dims.next();
            let one = dim.is_some_and(|d| dims.all(|other| other == d));
            let unit = dim.filter(|_| one).map_or_else(String::new, |d: Dim| units::unit_text(d, self.unit));
            for row in &mut rows {
                if row.len() <= k {
                    row.push(Value::None);
                }
                let plain = match &row[k] {
                    Value::Number(q) => one || q.dim.is_none(),
                    Value::Vector(_, dim) => one || dim.is_none(),
                    Value::Node(_) => one,
                    Value::None | Value::Bool(_) | Value::Text(_) => true,
                    _ => false,
                };
                if !plain {
                    row[k] = Value::Text(Arc::from(self.show(&row[k])));
                }
            }
            columns.push(Column { name, unit });
        }
        ReportTable { title, labelled: false, columns, rows }
    }
}
