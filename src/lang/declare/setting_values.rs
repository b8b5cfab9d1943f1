//! Settings in braces: evaluated, checked against their table, and found by name.

use crate::base::limits;
use crate::base::origin::Origin;
use crate::base::text::article;
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::syntax::ast;
use crate::lang::syntax::ast::ExprId;
use crate::lang::values::plans::Located;
use crate::lang::values::settings::Setting;
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, Value};
use crate::lang::words::elsewhere::meant;
use crate::lang::words::lookalikes;
use crate::mesh::request::settings::{Given, Settings};

/// A setting as resolved: its key, its value, the expression that says it.
pub(crate) struct Resolved {
    pub key: &'static str,
    pub ty: Ty,
    pub value: Value,
    pub origin: Origin,
}

/// The setting of a key.
pub(crate) fn find<'r>(resolved: &'r [Resolved], key: &str) -> Option<&'r Resolved> {
    resolved.iter().find(|r| r.key == key)
}

pub(crate) fn said<T>(resolved: &[Resolved], key: &str, take: impl Fn(&Value) -> Option<T>) -> Located<T> {
    find(resolved, key).and_then(|r| take(&r.value).map(|v| (v, r.origin)))
}

pub(crate) fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Number(q) => Some(q.value),
        _ => None,
    }
}

pub(crate) fn truth(value: &Value) -> Option<bool> {
    if let Value::Bool(b) = value { Some(*b) } else { None }
}

/// Settings of a block of the mesher; angles in radians.
pub(crate) fn filled<S: Settings>(resolved: &[Resolved]) -> Result<S, Halt> {
    let mut all = S::default();
    for Resolved { key, ty, value, origin } in resolved {
        let is_taken = match value {
            Value::Number(q) if *ty == Ty::Quantity(Dim::ANGLE) => all.set(key, Given::Number(units::radians(q.value)), *origin),
            Value::Number(q) => all.set(key, Given::Number(q.value), *origin),
            Value::Bool(b) => all.set(key, Given::Flag(*b), *origin),
            Value::Word(word) => all.set(key, Given::Word(word), *origin),
            _ => false,
        };
        if !is_taken {
            return Err(Halt::Bug("a setting of a mesh of another type than declared"));
        }
    }
    Ok(all)
}

impl Cx<'_> {
    /// Settings of a block, each key known, given once and of its type.
    pub(crate) fn settings(
        &mut self,
        code: Code<'_>,
        word: &str,
        table: &'static [Setting],
        settings: &[ast::SettingEntry],
    ) -> Result<Vec<Resolved>, Halt> {
        let (mut out, mut gather) = (Vec::<Resolved>::with_capacity(settings.len()), Gather::default());
        for setting in settings {
            let key = self.program.names.text(setting.key).to_owned();
            let Some(known) = table.iter().find(|s| s.key == key) else {
                gather.take::<()>(Err(self.no_setting(code, word, table, &key, setting.key_span)));
                continue;
            };
            if let Some(before) = settings.iter().take_while(|s| s.key_span != setting.key_span).find(|s| s.key == setting.key) {
                let draft = self.error(code, "E304", format!("`{key}` is given twice"), setting.key_span, "the second time");
                gather.take::<()>(Err(draft.and(before.key_span, "the first time").stop()));
                continue;
            }
            let value = self.eval_as(code, setting.value, known.ty, &format!("`{key}`"));
            let value = value.and_then(|v| self.in_range(code, known, v, setting.value));
            if let Some(value) = gather.take(value) {
                let origin = self.origin_at(setting.value);
                out.push(Resolved { key: known.key, ty: known.ty, value, origin });
            }
        }
        gather.done().map(|()| out)
    }

    fn in_range(&mut self, code: Code<'_>, setting: &Setting, value: Value, id: ExprId) -> Result<Value, Halt> {
        let Some(x) = number(&value) else { return Ok(value) };
        let key = setting.key;
        if x > 1.0 && setting.ty == Ty::Size && matches!(&value, Value::Number(q) if q.percent) {
            let found = self.show(&value);
            let text = format!("`{key}` is at most 100% of the diagonal of what is meshed, got {found}");
            return Err(self.error(code, "E306", text, code.span(id), found).came_from(code).stop());
        }
        let (least, most) = (f64::from(limits::PICTURE_LEAST), f64::from(limits::PICTURE_SIDE));
        if matches!(key, "width" | "height") && !(least..=most).contains(&x) {
            return Err(self.out_of_page(code, key, &value, id));
        }
        let Some((_, range)) = setting.range.iter().find(|(holds, _)| !holds(x)) else { return Ok(value) };
        let found = if let Value::Number(q) = &value { units::in_words(*q, self.program.unit) } else { self.show(&value) };
        Err(self.error(code, "E306", format!("`{key}` must be {range}, got {found}"), code.span(id), found).came_from(code).stop())
    }

    #[cold]
    fn out_of_page(&mut self, code: Code<'_>, key: &str, value: &Value, id: ExprId) -> Halt {
        let (least, most, found) = (limits::PICTURE_LEAST, limits::PICTURE_SIDE, self.show(value));
        let text = format!("`{key}` must be {least} to {most} pixels, got {found}");
        self.error(code, "E306", text, code.span(id), found).stop()
    }

    #[cold]
    fn no_setting(&mut self, code: Code<'_>, word: &str, table: &[Setting], key: &str, span: Span) -> Halt {
        let near = meant(key, table.iter().map(|s| s.key)).map(str::to_owned);
        let text = format!("{} has no setting `{key}`", if word == "on" { "`on`".to_owned() } else { format!("{} {word}", article(word)) });
        let label = near.as_ref().map_or_else(|| "no such setting".to_owned(), |near| format!("did you mean `{near}`?"));
        let keys: Vec<&str> = table.iter().map(|s| s.key).collect();
        let alike = near.as_deref().and_then(|near| lookalikes::difference(key, near));
        let draft = self.error(code, "E303", text, span, label).puts(span, near).notes(alike);
        if keys.is_empty() { draft.stop() } else { draft.note(format!("it takes {}", keys.join(", "))).stop() }
    }
}
