//! Arguments to parameters: positions, names, defaults, types; what is missing, too much or misspelled.

use crate::lang::diag::span::Span;
use crate::lang::eval::coerce::axis_of_word;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::eval::std::{Args, Builtin};
use crate::lang::syntax::ast::{Arg, Expr, ExprId};
use crate::lang::values::types::Ty;
use crate::lang::values::value::Value;
use crate::lang::words::elsewhere::meant;
use crate::lang::words::lookalikes;

/// What a call passes to a parameter list: by position or name, before or after the dot.
pub(crate) struct Signature<'p> {
    /// What is called, without quotes.
    pub name: &'p str,
    /// Names of the parameters.
    pub params: Vec<&'p str>,
    /// The parameter that takes all remaining positions.
    pub rest: Option<usize>,
    /// As shown in help.
    pub shown: String,
}

fn rest_of(builtin: &Builtin) -> Option<usize> {
    builtin.params.iter().position(|p| matches!(p.ty, Ty::Rest(_)))
}

/// Parameter of each argument; `None` where there is none. `taken` positions are filled by what stands before the dot.
fn places(params: &[&str], rest: Option<usize>, taken: usize, args: &[Option<&str>]) -> Vec<Option<usize>> {
    let mut next = if rest == Some(0) { 0 } else { taken };
    args.iter()
        .map(|name| match name {
            Some(name) => params.iter().position(|p| p == name),
            None if rest == Some(next) => rest,
            None => {
                next += 1;
                (next <= params.len()).then_some(next - 1)
            }
        })
        .collect()
}

impl Cx<'_> {
    /// Parameter of each argument of a call, every mistake reported.
    pub(crate) fn match_args(&mut self, code: Code<'_>, signature: &Signature<'_>, taken: usize, args: &[Arg]) -> Result<Vec<usize>, Halt> {
        let names: Vec<Option<&str>> = args.iter().map(|a| a.name.map(|(n, _)| self.program.names.text(n))).collect();
        let found = places(&signature.params, signature.rest, taken, &names);
        drop(names);
        let mut gather = Gather::default();
        let mut out: Vec<usize> = Vec::with_capacity(args.len());
        for (arg, place) in args.iter().zip(&found) {
            let result = match (place, arg.name) {
                (None, Some((name, span))) => {
                    let text = self.program.names.text(name).to_owned();
                    Err(self.no_argument(code, signature, &text, span, arg.value))
                }
                (None, None) => Err(self.too_many(code, signature, arg.value)),
                (Some(k), _) => {
                    let before = out.iter().position(|p| p == k);
                    let twice = signature.rest != Some(*k) && (before.is_some() || *k < taken);
                    if twice { Err(self.twice(code, signature, *k, arg, before.map(|b| args[b]))) } else { Ok(*k) }
                }
            };
            if let Some(k) = gather.take(result) {
                out.push(k);
            }
        }
        gather.done().map(|()| out)
    }

    /// Arguments of a builtin in the order of its parameters; `first` is the value before the dot.
    pub(crate) fn bind(
        &mut self,
        code: Code<'_>,
        id: ExprId,
        builtin: &'static Builtin,
        first: Option<Value>,
        args: &[Arg],
    ) -> Result<Args, Halt> {
        let (said, alone) = (self.sink.reports.len(), first.is_none());
        let bound = self.bound(code, id, builtin, first, args);
        if alone && matches!(bound, Err(Halt::Failed)) {
            self.type_out(code, id, builtin, args, said);
        }
        bound
    }

    fn bound(&mut self, code: Code<'_>, id: ExprId, builtin: &'static Builtin, first: Option<Value>, args: &[Arg]) -> Result<Args, Halt> {
        let rest_at = rest_of(builtin);
        let taken = usize::from(first.is_some());
        // The usual call, positions only, needs no names.
        let simple = rest_at.is_none() && args.iter().all(|a| a.name.is_none()) && args.len() + taken <= builtin.params.len();
        let places = if simple { None } else { Some(self.match_args(code, &builtin_signature(builtin), taken, args)?) };
        let mut values: Args = vec![Value::None; builtin.params.len()];
        let (mut given, mut rest, mut gather) = (0_u64, Vec::new(), Gather::default());
        if let Some(value) = first {
            let of = before_dot(code, id);
            let Some(param) = builtin.params.first() else {
                return Err(self.too_many(code, &builtin_signature(builtin), of));
            };
            given |= 1;
            match param.ty {
                Ty::Rest(inner) => rest.extend(gather.take(self.fit_rest(code, of, value, param.ty, *inner, &positional(builtin, 0)))),
                ty => values[0] = gather.take(self.fit_expr(code, of, value, ty, &positional(builtin, 0))).unwrap_or_default(),
            }
        }
        for (i, arg) in args.iter().enumerate().take(places.as_ref().map_or(args.len(), Vec::len)) {
            let k = places.as_ref().map_or(taken + i, |places| places[i]);
            let param = &builtin.params[k];
            given |= 1 << k.min(63);
            let subject = || if arg.name.is_some() { quoted(param.name) } else { positional(builtin, k) };
            match param.ty {
                Ty::Rest(inner) => {
                    let value = self.eval(code, arg.value);
                    let value = value.and_then(|v| self.fit_rest(code, arg.value, v, param.ty, *inner, &subject()));
                    rest.extend(gather.take(value));
                }
                ty => values[k] = gather.take(self.eval_param(code, arg.value, ty, &subject)).unwrap_or_default(),
            }
        }
        gather.done()?;
        for (k, param) in builtin.params.iter().enumerate() {
            if Some(k) == rest_at {
                values[k] = self.one_list(code, id, std::mem::take(&mut rest))?;
            } else if given & (1 << k.min(63)) == 0 {
                values[k] = match param.default {
                    Some(text) => self.default_of(builtin, k, text)?,
                    None if matches!(param.ty, Ty::Optional(_)) => Value::None,
                    None => return Err(self.missing(code, id, &builtin_signature(builtin), param.name)),
                };
            }
        }
        Ok(values)
    }

    /// Like [`Cx::eval_as`] without building texts on the way that all is well.
    #[inline]
    fn eval_param(&mut self, code: Code<'_>, id: ExprId, ty: Ty, subject: &dyn Fn() -> String) -> Result<Value, Halt> {
        if ty.choices().is_some() {
            return self.eval_as(code, id, ty, &subject());
        }
        if let (Ty::Direction | Ty::Axis | Ty::Optional(Ty::Direction | Ty::Axis), Expr::Name(name)) = (ty, code.expr(id))
            && let Some(direction) = axis_of_word(self.program.names.text(*name)).filter(|_| !self.is_bound(code.module, *name))
        {
            let text = format!("`{}` is not defined", self.program.names.text(*name));
            let draft = self.error(code, "E201", text, code.span(id), "a direction is written with three numbers");
            return Err(draft.ways(code.span(id), &[direction.to_owned()]).stop());
        }
        let value = self.eval(code, id)?;
        match (ty, &value) {
            (Ty::Any | Ty::Measure, Value::Number(_)) | (Ty::Point, Value::Vector(_, crate::lang::values::value::Dim::LENGTH)) => Ok(value),
            (Ty::Quantity(dim), Value::Number(q)) if q.dim == dim => Ok(value),
            (Ty::Curve, Value::Curve(_)) | (Ty::Surface, Value::Surface(_)) => Ok(value),
            _ => self.fit_expr(code, id, value, ty, &subject()),
        }
    }

    /// One argument among the rest: a thing, or lists of things.
    fn fit_rest(&mut self, code: Code<'_>, id: ExprId, value: Value, list: Ty, of: Ty, subject: &str) -> Result<Value, Halt> {
        let value = if let Value::Table(t) = value { Value::List(t.rows.clone()) } else { value };
        let ty = if matches!(value, Value::List(_) | Value::Range(..)) { list } else { of };
        self.fit_expr(code, id, value, ty, subject)
    }

    /// All rest arguments as one flat list; a single list is kept as it is.
    fn one_list(&mut self, code: Code<'_>, id: ExprId, mut rest: Vec<Value>) -> Result<Value, Halt> {
        if let [Value::List(items)] = rest.as_slice()
            && !items.iter().any(|v| matches!(v, Value::List(_) | Value::Range(..)))
        {
            return Ok(rest.remove(0));
        }
        self.flattened(code, id, Value::list(rest)).map(Value::list)
    }

    /// A default, evaluated once a run.
    fn default_of(&mut self, builtin: &'static Builtin, k: usize, text: &'static str) -> Result<Value, Halt> {
        let key = (std::ptr::from_ref(builtin) as usize, k);
        if let Some(value) = self.machine.defaults.get(&key) {
            return Ok(value.clone());
        }
        let ty = builtin.params[k].ty;
        let value = match text {
            _ if ty.choices().is_some_and(|words| words.contains(&text)) => Value::Word(text.into()),
            "none" => Value::None,
            "true" | "false" => Value::Bool(text == "true"),
            _ => self.literal_text(text).ok_or(Halt::Bug("a default that is no literal"))?,
        };
        let value = match self.coerce(value, ty, crate::lang::values::value::ModuleId::MAIN) {
            Ok(value) => value,
            Err(_) if text == "0" => match ty {
                Ty::Quantity(dim) => Value::quantity(0.0, dim),
                _ => return Err(Halt::Bug("a default of the wrong type")),
            },
            Err(_) => return Err(Halt::Bug("a default of the wrong type")),
        };
        self.machine.defaults.insert(key, value.clone());
        Ok(value)
    }

    #[cold]
    pub(crate) fn missing(&mut self, code: Code<'_>, id: ExprId, signature: &Signature<'_>, name: &str) -> Halt {
        let span = call_name(code, id);
        self.error(code, "E301", format!("`{}` needs `{name}`", signature.name), span, format!("`{name}` is missing"))
            .help(format!("`{}`", signature.shown))
            .stop()
    }

    #[cold]
    fn too_many(&mut self, code: Code<'_>, signature: &Signature<'_>, id: ExprId) -> Halt {
        let text = match signature.params.len() {
            0 => format!("`{}` takes no arguments", signature.name),
            1 => format!("`{}` takes one argument", signature.name),
            n => format!("`{}` takes at most {n} arguments", signature.name),
        };
        let bare = matches!(code.expr(id), Expr::Number(_)) && signature.shown.contains(": point");
        let draft = self.error(code, "E302", text, code.span(id), "one too many").help(format!("`{}`", signature.shown));
        if bare { draft.note("a point has brackets: `(0, 0, 0)`").stop() } else { draft.stop() }
    }

    #[cold]
    fn no_argument(&mut self, code: Code<'_>, signature: &Signature<'_>, name: &str, span: Span, value: ExprId) -> Halt {
        let near = meant(name, signature.params.iter().copied()).map(str::to_owned);
        let text = format!("`{}` has no argument `{name}`", signature.name);
        if matches!(name, "d" | "diameter") && signature.params.contains(&"radius") {
            let half = format!("radius: {} / 2", self.source(code, value));
            let whole = Span { start: span.start, end: code.span(value).end };
            return self.error(code, "E303", text, span, "no such argument").ways(whole, &[half]).stop();
        }
        match near {
            Some(near) => {
                let alike = lookalikes::difference(name, &near);
                let draft = self.error(code, "E303", text, span, format!("did you mean `{near}`?")).notes(alike);
                draft.help(format!("`{near}:`")).put(span, near).stop()
            }
            None => self.error(code, "E303", text, span, "no such argument").help(format!("`{}`", signature.shown)).stop(),
        }
    }

    #[cold]
    fn twice(&mut self, code: Code<'_>, signature: &Signature<'_>, k: usize, arg: &Arg, before: Option<Arg>) -> Halt {
        let span = arg.name.map_or(code.span(arg.value), |(_, span)| span);
        let draft = self.error(code, "E304", format!("`{}` is given twice", signature.params[k]), span, "the second time");
        match before {
            Some(before) => draft.and(code.span(before.value), "the first time").stop(),
            None => draft.stop(),
        }
    }

    /// Where the arguments of a failed call stand, by parameter name.
    pub(crate) fn blame(&self, code: Code<'_>, id: ExprId, builtin: &'static Builtin, first: bool, args: &[Arg]) -> Blame {
        let params: Vec<&str> = builtin.params.iter().map(|p| p.name).collect();
        let names: Vec<Option<&str>> = args.iter().map(|a| a.name.map(|(n, _)| self.program.names.text(n))).collect();
        let found = places(&params, rest_of(builtin), usize::from(first), &names);
        let before = first.then(|| builtin.params.first().map(|p| (p.name, code.span(before_dot(code, id))))).flatten();
        let whole: Vec<(&'static str, Span)> = before.into_iter().collect();
        let mut blame = Blame { items: whole.clone(), whole };
        for (arg, place) in args.iter().zip(found) {
            let Some(k) = place else { continue };
            let name = builtin.params[k].name;
            let members: Vec<(&'static str, Span)> = match code.expr(arg.value) {
                Expr::List(items) => items.iter().map(|i| (name, code.span(*i))).collect(),
                _ => vec![(name, code.span(arg.value))],
            };
            // Of a list written out where a row is wanted the members are arguments.
            if matches!(builtin.params[k].ty, Ty::Rest(_)) {
                blame.whole.extend(&members);
            } else {
                blame.whole.push((name, code.span(arg.value)));
            }
            blame.items.extend(members);
        }
        blame
    }
}

/// An argument that the user gave by its place: "the second argument of `ruled`".
pub(crate) fn positional(builtin: &Builtin, k: usize) -> String {
    const PLACES: [&str; 6] = ["first", "second", "third", "fourth", "fifth", "sixth"];
    match builtin.params.get(k) {
        Some(param) if matches!(param.ty, Ty::Rest(_)) => format!("an argument of `{}`", builtin.name),
        _ if builtin.params.len() == 1 => format!("the argument of `{}`", builtin.name),
        // The one that goes by its name in other messages as well.
        Some(param) if param.name == "by" => format!("`by`, the {} argument of `{}`,", PLACES.get(k).unwrap_or(&"last"), builtin.name),
        _ => format!("the {} argument of `{}`", PLACES.get(k).unwrap_or(&"last"), builtin.name),
    }
}

/// Where the arguments of a call stand, by parameter name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blame {
    /// Each argument.
    pub whole: Vec<(&'static str, Span)>,
    /// The same with the members of lists written out one by one.
    pub items: Vec<(&'static str, Span)>,
}

fn quoted(name: &str) -> String {
    format!("`{name}`")
}

fn builtin_signature(builtin: &'static Builtin) -> Signature<'static> {
    Signature {
        name: builtin.name,
        params: builtin.params.iter().map(|p| p.name).collect(),
        rest: rest_of(builtin),
        shown: builtin.signature(),
    }
}

/// What stands before the dot of a call or field.
fn before_dot(code: Code<'_>, id: ExprId) -> ExprId {
    match code.expr(id) {
        Expr::Call { of: Some(of), .. } | Expr::Field { of, .. } => *of,
        Expr::Call { args, .. } => args.first().map_or(id, |a| a.value),
        _ => id,
    }
}

/// The name of a call, or the whole expression.
pub(crate) fn call_name(code: Code<'_>, id: ExprId) -> Span {
    match code.expr(id) {
        Expr::Call { name_span, .. } | Expr::Field { name_span, .. } => *name_span,
        _ => code.span(id),
    }
}

#[cfg(test)]
mod tests {
    use super::places;

    fn check(rest: Option<usize>, taken: usize, args: &[Option<&str>], expected: &[Option<usize>]) {
        assert_eq!(places(&["a", "b", "c"], rest, taken, args), expected);
    }

    #[test]
    fn positions_then_names() {
        check(None, 0, &[None, None], &[Some(0), Some(1)]);
        check(None, 1, &[None, Some("c")], &[Some(1), Some(2)]);
        check(None, 0, &[None, None, None, None], &[Some(0), Some(1), Some(2), None]);
        check(Some(0), 0, &[None, None, Some("b"), None], &[Some(0), Some(0), Some(1), Some(0)]);
        check(Some(1), 1, &[None, None, None, None], &[Some(1), Some(1), Some(1), Some(1)]);
        check(None, 0, &[Some("x")], &[None]);
    }
}
