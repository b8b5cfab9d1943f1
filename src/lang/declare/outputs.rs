//! `check`, `report`, `export`, `picture`: evaluated to plain data that the session shows and writes.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::base::origin::Origin;
use crate::lang::declare::setting_values::{find, said, truth};
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::eval::comparisons::Comparison;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::syntax::ast;
use crate::lang::syntax::ast::{Declaration, DeclarationKind, Expr, ExprId, Keyword};
use crate::lang::values::plans::{CheckResult, ExportSpec, ReportTable};
use crate::lang::values::settings;
use crate::lang::values::units;
use crate::lang::values::value::{ModuleId, Quantity, Value};

impl Cx<'_> {
    pub(crate) fn output(&mut self, code: Code<'_>, declaration: &Declaration) -> Result<Value, Halt> {
        let DeclarationKind::Output { label, things, family, to, settings } = &declaration.kind else {
            return Err(Halt::Bug("not an output"));
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
                    self.sink.reports.extend(failure);
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
                    let picture = cx.picture(code, member, things, *to, settings)?;
                    done.push((code.declaration, picture));
                    Ok(Value::None)
                })?;
                self.machine.at_mut(code.module).pictures.extend(done);
            }
            _ => {
                let mut done = Vec::new();
                self.family(code, family, &mut |cx, member| {
                    let export = cx.export(code, member, things, *to, settings)?;
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
        things: &[ExprId],
        to: Option<ExprId>,
        settings: &[ast::SettingEntry],
    ) -> Result<ExportSpec, Halt> {
        let mut gather = Gather::default();
        let things = match self.things(code, things, Keyword::Export) {
            // What settings may say depends on the things.
            Err(Halt::NotYet) => return Err(Halt::NotYet),
            things => gather.take(things),
        };
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
        let things = once(things.unwrap_or_default());
        let elements = find(&settings, "element").map_or_else(Vec::new, |said| self.elements(code, written, &said.value, said.origin));
        let incomplete = said(&settings, "incomplete", truth).is_some_and(|said| said.0);
        let (encoding, schema, shells) = (word("encoding"), word("schema"), word("shells"));
        Ok(ExportSpec { things, path, path_origin, encoding, elements, schema, shells, incomplete, units, origin })
    }

    /// The words of `element:`; those of a list written out have their own places.
    fn elements(&mut self, code: Code<'_>, written: &[ast::SettingEntry], said: &Value, whole: Origin) -> Vec<(Arc<str>, Origin)> {
        let setting = written.iter().find(|setting| self.program.names.text(setting.key) == "element");
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

    pub(crate) fn path(&mut self, code: Code<'_>, to: Option<ExprId>) -> Result<(String, Origin), Halt> {
        let Some(to) = to else { return Err(Halt::Bug("an export without a path")) };
        match self.eval(code, to)? {
            Value::Text(t) => Ok((t.to_string(), self.origin_at(to))),
            other => {
                let found = self.kind(&other);
                Err(self.error(code, "E211", format!("a path is a text, got {found}"), code.span(to), found).stop())
            }
        }
    }

    /// A label as written and interpolated, or the source of what it is about.
    fn label(&mut self, code: Code<'_>, label: Option<ExprId>, thing: Option<ExprId>) -> Result<String, Halt> {
        match (label, thing) {
            (Some(label), _) => match code.expr(label) {
                Expr::Text(parts) => self.interpolate(code, parts),
                _ => Err(Halt::Bug("a label that is no text")),
            },
            (None, Some(thing)) => Ok(self.source(code, thing).split_whitespace().collect::<Vec<_>>().join(" ")),
            (None, None) => Ok(String::new()),
        }
    }

    fn check(&mut self, code: Code<'_>, label: Option<ExprId>, things: &[ExprId]) -> Result<(CheckResult, Option<Diagnostic>), Halt> {
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

    /// A report as a table: records are rows, a record is one row, an entity tells its members, anything else is one cell.
    fn report(&mut self, code: Code<'_>, label: Option<ExprId>, things: &[ExprId]) -> Result<ReportTable, Halt> {
        let (title, labelled) = (self.label(code, label, things.first().copied())?, label.is_some());
        let (mut values, mut gather) = (Vec::new(), Gather::default());
        for thing in things {
            values.extend(gather.take(self.eval(code, *thing)).map(|v| (*thing, v)));
        }
        gather.done()?;
        if let [(thing, value)] = values.as_slice() {
            self.machine.site.expr = *thing;
            let table = match self.members_table(value)? {
                Some(table) => ReportTable { title, ..table },
                None => self.table(title, value),
            };
            return Ok(ReportTable { labelled, ..table });
        }
        // Several things: a row each; what is no entity under its source.
        let named: Vec<(String, Value)> = values.iter().map(|(thing, value)| (self.source(code, *thing), value.clone())).collect();
        let table = match self.members_rows(&named)? {
            Some(table) => ReportTable { title, ..table },
            None => {
                let rows = named.into_iter().map(|(source, value)| vec![Value::text(&source), value]).collect();
                self.with_units(title, vec!["what".into(), "value".into()], rows)
            }
        };
        Ok(ReportTable { labelled, ..table })
    }
}

/// A number with four significant digits, for differences in words.
fn rounded(x: f64) -> String {
    units::number_text(rounded_value(x))
}

fn rounded_value(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// Each surface and shell once, where it is named first: a group may hold what stands beside it, and twice in a file it would be two bodies.
fn once(things: Vec<(Value, Origin)>) -> Vec<(Value, Origin)> {
    let mut known: BTreeMap<Origin, Vec<Value>> = BTreeMap::new();
    let mut is_new = |value: &Value| {
        let of = match value {
            Value::Surface(surface) => surface.origin(),
            Value::Shell(shell) => shell.origin,
            _ => return true,
        };
        let same = |other: &Value| match (value, other) {
            (Value::Surface(a), Value::Surface(b)) => a.is(b),
            (Value::Shell(a), Value::Shell(b)) => {
                a.surfaces.len() == b.surfaces.len() && a.surfaces.iter().zip(&b.surfaces).all(|(a, b)| a.is(b))
            }
            _ => false,
        };
        let known = known.entry(of).or_default();
        let is_new = !known.iter().any(same);
        known.extend(is_new.then(|| value.clone()));
        is_new
    };
    things.into_iter().filter(|(value, _)| is_new(value)).collect()
}
