//! Calls whose arguments are right and stand in the wrong places, typed out: `circle(5)`, `spline(A, B, C)`, `revolve(p, 90)`.

use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::diag::span::Span;
use crate::lang::eval::bind::call_name;
use crate::lang::eval::coerce::Misfit;
use crate::lang::eval::context::Cx;
use crate::lang::eval::machine::Code;
use crate::lang::eval::std::Builtin;
use crate::lang::syntax::ast::{Arg, DeclarationKind, Expr, ExprId};
use crate::lang::syntax::foreign::{Call, Made, shape};
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::Value;

/// Why the typed form is another one.
const LISTED: &str = "give these as one list";
const NAMED: &str = "name the arguments behind one that is left out";

impl Cx<'_> {
    /// Puts the typed form of a call into what was said about its arguments since `said`: that is one report then.
    #[cold]
    pub(crate) fn type_out(&mut self, code: Code<'_>, id: ExprId, builtin: &'static Builtin, args: &[Arg], said: usize) {
        let spans: Vec<_> = args
            .iter()
            .map(|a| code.span(a.value))
            .chain(args.iter().filter_map(|a| a.name.map(|(_, span)| span)))
            .chain([call_name(code, id)])
            .collect();
        let file = self.machine.at(code.module).file;
        let about = |d: &Diagnostic| {
            let place = d.labels.first().is_some_and(|l| l.file == file && spans.contains(&l.span));
            place && d.fixes.is_empty() && matches!(d.code.0, "E211" | "E301" | "E302" | "E304" | "E402")
        };
        if self.sink.reports.len() <= said || !self.sink.reports[said..].iter().all(about) {
            return;
        }
        let reports = self.sink.reports.split_off(said);
        let typed = self.values_of(code, args).and_then(|values| self.typed_call(code, builtin, args, &values));
        self.sink.reports.truncate(said);
        match (typed, reports.split_first()) {
            (Some((why, typed)), Some((first, _))) => {
                self.sink.reports.push(first.clone().help(format!("{why}: `{typed}`")).put(code.span(id), typed));
            }
            _ => self.sink.reports.extend(reports),
        }
    }

    /// The arguments once more; what is said about them was said before.
    fn values_of(&mut self, code: Code<'_>, args: &[Arg]) -> Option<Vec<Value>> {
        let values: Result<Vec<Value>, _> = args.iter().map(|a| self.eval(code, a.value)).collect();
        values.ok()
    }

    /// The form of a call that takes these arguments.
    fn typed_call(&mut self, code: Code<'_>, builtin: &Builtin, args: &[Arg], values: &[Value]) -> Option<(&'static str, String)> {
        let sources: Vec<String> = args.iter().map(|a| self.source(code, a.value)).collect();
        let first = builtin.params.first()?;
        if let Ty::List(of) = first.ty {
            let mut listed = 0;
            while listed < args.len() && args[listed].name.is_none() && self.coerce(values[listed].clone(), *of, code.module).is_ok() {
                listed += 1;
            }
            if listed < 2 || args[listed..].iter().any(|a| a.name.is_none()) {
                return None;
            }
            let rest = args[listed..].iter().zip(&sources[listed..]);
            let rest: String = rest.filter_map(|(a, s)| a.name.map(|(n, _)| format!(", {}: {s}", self.program.names.text(n)))).collect();
            return Some((LISTED, format!("{}([{}]{rest})", builtin.name, sources[..listed].join(", "))));
        }
        self.named_call(code, builtin, args, &sources, values).map(|typed| (NAMED, typed))
    }

    /// The arguments by the names of the parameters that they fit, in order; a centre that is not told is the origin.
    fn named_call(&mut self, code: Code<'_>, builtin: &Builtin, args: &[Arg], sources: &[String], values: &[Value]) -> Option<String> {
        let mut taken: Vec<Option<String>> = vec![None; builtin.params.len()];
        let mut next = 0;
        for ((arg, value), source) in args.iter().zip(values).zip(sources) {
            let place = match arg.name {
                Some((name, _)) => {
                    let name = self.program.names.text(name);
                    let k = builtin.params.iter().position(|p| p.name == name)?;
                    (k, self.fitting(code, value, builtin.params[k].ty, source)?)
                }
                None => (next..builtin.params.len())
                    .find_map(|k| self.fitting(code, value, builtin.params[k].ty, source).map(|text| (k, text)))?,
            };
            next = place.0 + 1;
            taken[place.0] = Some(place.1);
        }
        let last = taken.iter().rposition(Option::is_some)?;
        let skips = taken.iter().position(Option::is_none).filter(|k| *k < last)?;
        let mut parts = Vec::new();
        for (k, (param, text)) in builtin.params.iter().zip(taken).enumerate() {
            let optional = param.default.is_some() || matches!(param.ty, Ty::Optional(_) | Ty::Rest(_));
            match text {
                Some(text) if k < skips => parts.push(text),
                Some(text) => parts.push(format!("{}: {text}", param.name)),
                None if optional => {}
                None if param.name == "center" => parts.push("center: (0, 0, 0)".to_owned()),
                None => return None,
            }
        }
        Some(format!("{}({})", builtin.name, parts.join(", ")))
    }

    /// The text of a value where this type is wanted: with its unit where that is missing; `None` where it does not fit.
    fn fitting(&mut self, code: Code<'_>, value: &Value, ty: Ty, source: &str) -> Option<String> {
        match self.coerce(value.clone(), ty, code.module) {
            Ok(_) => Some(source.to_owned()),
            Err((Value::Number(q), Misfit::Bare)) => {
                let Ty::Quantity(dim) = ty else { return None };
                let unit = units::meant_units(q.value, dim, self.machine.at(code.module).unit).into_iter().next()?;
                source.parse::<f64>().is_ok().then(|| format!("{source}{unit}"))
            }
            Err(_) => None,
        }
    }

    /// What is typed for a call of another tool's shape: the expression in its place, or the declaration with what it is made of.
    pub(crate) fn typed_shape(&self, code: Code<'_>, id: ExprId) -> Option<(Span, String)> {
        let Expr::Call { name, args, of: None, .. } = code.expr(id) else { return None };
        let args = args.iter().map(|a| (a.name.map(|(n, _)| self.program.names.text(n).to_owned()), self.source(code, a.value)));
        let made = shape(&Call { name: self.program.names.text(*name).to_owned(), args: args.collect() })?;
        if let Made::Solid { .. } = made {
            let declaration = self.machine.at(code.module).script.declarations.whole(code.declaration as usize);
            let DeclarationKind::Value { bound, family, value } = &declaration.kind else { return None };
            let whole = *value == id && family.is_empty();
            let span = Span { start: declaration.keyword_span.start, ..declaration.span };
            return made.declared(self.program.names.text(bound.name), "").filter(|_| whole).map(|typed| (span, typed));
        }
        Some((code.span(id), made.expression()))
    }
}
