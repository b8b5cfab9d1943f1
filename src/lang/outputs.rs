//! `check`, `report`, `export`, `picture`: evaluated to plain data that the session shows and writes.

use std::sync::Arc;

use super::collections::find;
use super::cx::{Cx, Stop};
use super::diag::Diagnostic;
use super::eval::{Code, Gather};
use super::operators::Comparison;
use super::plans::{CheckResult, Column, ExportSpec, ReportTable};
use super::settings;
use super::syntax::ast::{self, Declaration, DeclarationKind, Expr, ExprId, Keyword};
use super::units;
use super::value::{Dim, ModuleId, Quantity, Value};
use crate::base::origin::Origin;

impl Cx<'_> {
    pub(super) fn output(&mut self, code: Code<'_>, declaration: &Declaration) -> Result<Value, Stop> {
        let DeclarationKind::Output { label, things, family, to, settings } = &declaration.kind else {
            return Err(Stop::Bug("not an output"));
        };
        // A module's checks run; its exports, pictures and reports do not.
        if declaration.keyword != Keyword::Check && code.module != ModuleId::MAIN {
            return Ok(Value::None);
        }
        match declaration.keyword {
            Keyword::Check => {
                let mut done = Vec::new();
                self.family(code, family, &mut |cx, _| {
                    let result = cx.check(code, *label, things)?;
                    done.push(result);
                    Ok(Value::None)
                })?;
                for (result, failure) in done {
                    self.machine.at_mut(code.module).checks.push((code.declaration, result));
                    self.sink.extend(failure);
                }
            }
            Keyword::Report => {
                let mut done = Vec::new();
                self.family(code, family, &mut |cx, _| {
                    let table = cx.report(code, *label, things)?;
                    done.push((code.declaration, table));
                    Ok(Value::None)
                })?;
                self.machine.at_mut(code.module).reports.extend(done);
            }
            Keyword::Picture => {
                let mut done = Vec::new();
                self.family(code, family, &mut |cx, member| {
                    let picture = cx.picture(code, member, (things, *to), settings)?;
                    done.push((code.declaration, picture));
                    Ok(Value::None)
                })?;
                self.machine.at_mut(code.module).pictures.extend(done);
            }
            _ => {
                let mut done = Vec::new();
                self.family(code, family, &mut |cx, member| {
                    let export = cx.export(code, member, (things, *to), settings)?;
                    done.push((code.declaration, export));
                    Ok(Value::None)
                })?;
                self.machine.at_mut(code.module).exports.extend(done);
            }
        }
        Ok(Value::None)
    }

    fn export(
        &mut self,
        code: Code<'_>,
        member: [u32; 2],
        (things, to): (&[ExprId], Option<ExprId>),
        settings: &[ast::Setting],
    ) -> Result<ExportSpec, Stop> {
        let mut gather = Gather::default();
        let things = gather.take(self.things(code, things, Keyword::Export));
        let path = gather.take(self.path(code, to));
        let written = settings;
        let settings = gather.take(self.settings(code, "export", settings::EXPORT, written));
        gather.done()?;
        let origin = self.own_origin(code, member);
        let settings = settings.unwrap_or_default();
        let word = |key: &str| match find(&settings, key) {
            Some(r) => match &r.value {
                Value::Word(w) => Some((w.clone(), r.origin)),
                _ => None,
            },
            None => None,
        };
        let (path, path_origin) = path.unwrap_or_default();
        let units = word("units").and_then(|(w, origin)| units::file_unit(&w).map(|u| (u, origin)));
        let things = things.unwrap_or_default();
        let elements = find(&settings, "element").map_or_else(Vec::new, |said| self.elements(code, written, &said.value, said.origin));
        Ok(ExportSpec { things, path, path_origin, encoding: word("encoding"), elements, units, origin })
    }

    /// The words of `element:`; those of a list written out have their own places.
    fn elements(&mut self, code: Code<'_>, written: &[ast::Setting], said: &Value, whole: Origin) -> Vec<(Arc<str>, Origin)> {
        let setting = written.iter().find(|setting| self.names.text(setting.key) == "element");
        let items: &[ExprId] = match setting.map(|setting| code.expr(setting.value)) {
            Some(Expr::List(items)) => items,
            _ => &[],
        };
        let values = match said {
            Value::List(values) => values.as_slice(),
            one => std::slice::from_ref(one),
        };
        let mut elements = Vec::with_capacity(values.len());
        for (k, value) in values.iter().enumerate() {
            if let Value::Word(word) = value {
                let place = items.get(k).map_or(whole, |item| self.origin_at(*item));
                elements.push((word.clone(), place));
            }
        }
        elements
    }

    pub(super) fn path(&mut self, code: Code<'_>, to: Option<ExprId>) -> Result<(String, Origin), Stop> {
        let Some(to) = to else { return Err(Stop::Bug("an export without a path")) };
        match self.eval(code, to)? {
            Value::Text(t) => Ok((t.to_string(), self.origin_at(to))),
            other => {
                let found = self.kind(&other);
                Err(self.error(code, "E211", format!("a path is a text, got {found}"), code.span(to), found).stop())
            }
        }
    }

    /// A label as written and interpolated, or the source of what it is about.
    fn label(&mut self, code: Code<'_>, label: Option<ExprId>, thing: Option<ExprId>) -> Result<String, Stop> {
        match (label, thing) {
            (Some(label), _) => match code.expr(label) {
                Expr::Text(parts) => self.interpolate(code, parts),
                _ => Err(Stop::Bug("a label that is no text")),
            },
            (None, Some(thing)) => Ok(self.source(code, thing).split_whitespace().collect::<Vec<_>>().join(" ")),
            (None, None) => Ok(String::new()),
        }
    }

    fn check(&mut self, code: Code<'_>, label: Option<ExprId>, things: &[ExprId]) -> Result<(CheckResult, Option<Diagnostic>), Stop> {
        let &[thing] = things else {
            let span = things.get(1).map_or(code.span(things[0]), |t| code.span(*t));
            return Err(self.error(code, "E302", "a check checks one thing", span, "one too many").help("join them with `and`").stop());
        };
        let label_text = self.label(code, label, Some(thing))?;
        let module = self.machine.at(code.module);
        let (file, name) = (module.file, module.label.clone());
        let label_text = if name.is_empty() { label_text } else { format!("{name}: {label_text}") };
        let comparison = match self.comparison(code, thing) {
            Some(comparison) => Some(comparison?),
            None => None,
        };
        let pass = match &comparison {
            Some(c) => c.holds,
            None => self.condition(code, thing)?,
        };
        let failure = (!pass).then(|| {
            let source = self.source(code, thing).split_whitespace().collect::<Vec<_>>().join(" ");
            let quoted = if label.is_some() { format!("\"{label_text}\"") } else { format!("`{source}`") };
            let mut diagnostic = match &comparison {
                Some(c) => {
                    let (words, detail) = self.failed(c);
                    let diagnostic = Diagnostic::new("E901", format!("check {quoted} failed: {words}"), file, code.span(thing), detail);
                    self.with_sides(code, thing, c, diagnostic)
                }
                None => Diagnostic::new("E901", format!("check {quoted} failed"), file, code.span(thing), "this is false"),
            };
            self.add_calls(&mut diagnostic);
            diagnostic
        });
        let side = |value: Option<&Value>| value.map(|v| self.show(v));
        let allowed = comparison.as_ref().and_then(|c| c.allowed).map(Value::Number);
        let (left, right) = comparison.map_or((None, None), |c| (Some(c.left), Some(c.right)));
        let result = CheckResult {
            label: label_text,
            labelled: label.is_some(),
            pass,
            file,
            span: code.span(thing),
            left: side(left.as_ref()),
            right: side(right.as_ref()),
            left_value: left,
            right_value: right,
            allowed,
        };
        Ok((result, failure))
    }

    /// What a comparison found, and by how much.
    fn failed(&self, c: &Comparison) -> (String, String) {
        let (left, right) = (self.show(&c.left), self.show(&c.right));
        let percent = match (&c.right, c.difference) {
            (Value::Number(q), Some(d)) if q.value != 0.0 => format!(", {}%", rounded(100.0 * d.value / q.value.abs())),
            _ => String::new(),
        };
        let near = |q: Quantity| self.quantity(Quantity { value: rounded_value(q.value), ..q });
        match (c.difference, c.allowed) {
            (Some(d), Some(allowed)) => {
                (format!("{left} against {right}"), format!("differs by {}{percent}; {} allowed", near(d), near(allowed)))
            }
            (Some(d), None) if d.value != 0.0 => (format!("{left} against {right}"), format!("they differ by {}{percent}", near(d))),
            _ => (format!("{left} against {right}"), "does not hold".to_owned()),
        }
    }

    /// Labels both sides with their values where they are not literals.
    fn with_sides(&self, code: Code<'_>, thing: ExprId, c: &Comparison, mut diagnostic: Diagnostic) -> Diagnostic {
        let of = match code.expr(thing) {
            Expr::Within { of, .. } => *of,
            _ => thing,
        };
        if let Expr::Binary { a, b, .. } = code.expr(of) {
            for (side, value) in [(*a, &c.left), (*b, &c.right)] {
                if !matches!(code.expr(side), Expr::Number(_) | Expr::Quantity(..) | Expr::Bool(_) | Expr::Text(_)) {
                    diagnostic = diagnostic.label(self.machine.at(code.module).file, code.span(side), self.show(value));
                }
            }
        }
        diagnostic
    }

    /// A record, or a list of records, as a table; `None` for other values.
    pub fn table_of(&mut self, value: &Value) -> Option<ReportTable> {
        let tabular = match value {
            Value::Record(_) => true,
            Value::List(items) => matches!(items.first(), Some(Value::Record(_))),
            _ => false,
        };
        tabular.then(|| self.table(String::new(), value))
    }

    /// A report as a table: records are rows, a record is one row, anything else one cell.
    fn report(&mut self, code: Code<'_>, label: Option<ExprId>, things: &[ExprId]) -> Result<ReportTable, Stop> {
        let (title, labelled) = (self.label(code, label, things.first().copied())?, label.is_some());
        let (mut values, mut gather) = (Vec::new(), Gather::default());
        for thing in things {
            values.extend(gather.take(self.eval(code, *thing)).map(|v| (*thing, v)));
        }
        gather.done()?;
        if let [(thing, value)] = values.as_slice() {
            self.machine.site.expr = *thing;
            let pipeline = self.pipeline;
            if let Some(table) = pipeline.table(self, value)? {
                return Ok(ReportTable { title, labelled, ..table });
            }
            return Ok(ReportTable { labelled, ..self.table(title, value) });
        }
        // Several things: a row each, under their source.
        let rows = values.iter().map(|(thing, value)| vec![Value::text(&self.source(code, *thing)), value.clone()]).collect();
        Ok(ReportTable { labelled, ..self.with_units(title, vec!["what".into(), "value".into()], rows) })
    }

    fn table(&mut self, title: String, value: &Value) -> ReportTable {
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
    fn with_units(&self, title: String, mut names: Vec<String>, mut rows: Vec<Vec<Value>>) -> ReportTable {
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

/// A number with four significant digits, for differences in words.
fn rounded(x: f64) -> String {
    units::number_text(rounded_value(x))
}

fn rounded_value(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
