//! Calls, fields and indexing.

use crate::base::fault::ValueFault;
use crate::base::limits;
use crate::base::origin::Origin;
use crate::base::work::{self, Exceeded};
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::diag::span::Span;
use crate::lang::eval::bind::{Signature, call_name, positional};
use crate::lang::eval::coerce::accepts;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::later;
use crate::lang::eval::machine::{Code, Frame, Gather, Site, Word};
use crate::lang::eval::misspelt::{Among, Unknown};
use crate::lang::eval::module::State;
use crate::lang::eval::room::LIST_COST;
use crate::lang::eval::std;
use crate::lang::eval::std::Builtin;
use crate::lang::syntax::ast::{Arg, DeclarationKind, Expr, ExprId, FnParam, Keyword};
use crate::lang::values::types::Ty;
use crate::lang::values::value::{ModuleId, Record, Value};
use crate::lang::words::elsewhere::meant;
use crate::lang::words::lookalikes;
use crate::lang::words::names::Name;

impl Cx<'_> {
    /// What a name followed by `(` leads to, looked up once: a function, and whether fields have this name.
    pub(crate) fn word(&mut self, name: Name) -> (Option<&'static Builtin>, bool) {
        if let Some(Word::Known { function, fields }) = self.machine.words.get(name.index()) {
            return (*function, !fields.is_empty());
        }
        let text = self.program.names.text(name);
        let function = std::builtins().find(|b| b.name == text);
        let fields: Box<[&'static Builtin]> = std::fields().filter(|f| f.name == text).collect();
        let has_fields = !fields.is_empty();
        if self.machine.words.len() <= name.index() {
            self.machine.words.resize_with(name.index() + 1, || Word::Unknown);
        }
        self.machine.words[name.index()] = Word::Known { function, fields };
        (function, has_fields)
    }

    /// The field of that name for this kind of value; [`Cx::word`] has looked the name up.
    fn field_for(&self, name: Name, value: &Value) -> Option<&'static Builtin> {
        match self.machine.words.get(name.index()) {
            Some(Word::Known { fields, .. }) => fields.iter().copied().find(|f| f.params.first().is_some_and(|p| accepts(p.ty, value))),
            _ => None,
        }
    }

    /// `name(args)` and `of.name(args)`.
    pub(crate) fn call(
        &mut self,
        code: Code<'_>,
        id: ExprId,
        (name, name_span): (Name, Span),
        of: Option<ExprId>,
        args: &[Arg],
    ) -> Result<Value, Halt> {
        let first = match of {
            Some(of) => match self.eval(code, of)? {
                Value::Module(module) => return self.call_in(code, id, module, (name, name_span), args),
                value => Some(value),
            },
            None => None,
        };
        if let Some(declaration) = self.script_fn(code.module, name) {
            return self.call_fn(code, id, (code.module, declaration), first, args);
        }
        let (function, has_fields) = self.word(name);
        let one = usize::from(first.is_some()) + args.len() == 1 && args.iter().all(|a| a.name.is_none());
        if has_fields && one {
            let value = match (first, args.first()) {
                (Some(value), _) => value,
                (None, Some(arg)) => self.eval(code, arg.value)?,
                (None, None) => return Err(Halt::Bug("a call of one value without any")),
            };
            return match (self.field_for(name, &value), function) {
                (Some(field), _) => self.run(code, id, field, Some(value), &[]),
                (None, Some(function)) => self.run(code, id, function, Some(value), &[]),
                (None, None) if self.machine.at(code.module).is_broken(name) => Err(Halt::Broken),
                (None, None) => Err(self.no_field(code, &value, name, name_span)),
            };
        }
        match function {
            Some(function) => self.run(code, id, function, first, args),
            None => match first {
                Some(value) if has_fields => Err(self.no_field(code, &value, name, name_span)),
                _ => Err(self.no_function(code, id, name, name_span)),
            },
        }
    }

    /// The function that a script declares under this name.
    fn script_fn(&self, module: ModuleId, name: Name) -> Option<u32> {
        let module = self.machine.at(module);
        let declaration = module.find(name)?;
        (module.script.declarations[declaration as usize].keyword == Keyword::Fn).then_some(declaration)
    }

    /// `ribs.rib(3m)`: a function of a module.
    fn call_in(&mut self, code: Code<'_>, id: ExprId, module: ModuleId, (name, span): (Name, Span), args: &[Arg]) -> Result<Value, Halt> {
        match self.script_fn(module, name) {
            Some(declaration) => self.call_fn(code, id, (module, declaration), None, args),
            None if self.machine.at(module).is_broken(name) => Err(Halt::Broken),
            None => {
                let (label, text) = (self.machine.at(module).label.clone(), self.program.names.text(name).to_owned());
                Err(self.error(code, "E214", format!("`{label}` has no function `{text}`"), span, "no such function").stop())
            }
        }
    }

    /// Binds, calls a builtin, and shows its faults at the arguments.
    fn run(&mut self, code: Code<'_>, id: ExprId, builtin: &'static Builtin, first: Option<Value>, args: &[Arg]) -> Result<Value, Halt> {
        let before = first.clone();
        let values = self.bind(code, id, builtin, first, args)?;
        self.machine.site.expr = id;
        let budget = self.machine.budget.clone();
        let called = budget.within(|| (builtin.call)(self, values));
        match called.unwrap_or_else(|Exceeded| Err(ValueFault::Work.into())) {
            Ok(value) => {
                if self.tolerance.is_none()
                    && let Value::Curve(chain) = &value
                {
                    for run in chain.runs() {
                        self.seen = self.seen.union(run.curve.bbox());
                    }
                }
                self.machine.site.expr = id;
                self.made_by_builtin(code, id, &value)?;
                self.finite_result(code, id, value)
            }
            Err(Halt::Fault(crate::base::fault::Fault::Interrupted)) => Err(crate::base::fault::Fault::Interrupted.into()),
            Err(Halt::Fault(fault)) => {
                let blame = self.blame(code, id, builtin, before.is_some(), args);
                let mut diagnostic = self.locate(&fault, code, call_name(code, id), &blame);
                self.advise(&fault, (code, id), &blame, &mut diagnostic);
                let of_value = fault.of::<ValueFault>().is_some();
                let diagnostic = self.by_place((code, call_name(code, id)), (diagnostic, of_value), (builtin, before.as_ref(), args));
                let few = diagnostic.code.0 == "E402";
                self.sink.reports.push(diagnostic);
                if few {
                    self.type_out(code, id, builtin, args, self.sink.reports.len() - 1);
                }
                Err(Halt::Failed)
            }
            Err(other) => Err(other),
        }
    }

    /// A fault of a call in the words of the one who wrote it: arguments without a name go by their place, a field that things
    /// of other kinds have is offered under its own name, and a value outside its range comes with what it was made of.
    #[cold]
    fn by_place(
        &self,
        (code, called): (Code<'_>, Span),
        (mut diagnostic, of_value): (Diagnostic, bool),
        (builtin, first, args): (&'static Builtin, Option<&Value>, &[Arg]),
    ) -> Diagnostic {
        let named = |name: &str| args.iter().any(|a| a.name.is_some_and(|(n, _)| self.program.names.text(n) == name));
        let spoken = builtin.params.iter().position(|p| diagnostic.message.starts_with(&format!("`{}` ", p.name)));
        if let Some(k) = spoken.filter(|k| of_value && !named(builtin.params[*k].name)) {
            let name = builtin.params[k].name;
            diagnostic.message = diagnostic.message.replacen(&format!("`{name}`"), &positional(builtin, k), 1);
        }
        if matches!(diagnostic.code.0, "E306" | "E401" | "E405" | "E407" | "E411" | "E412")
            && let Some(span) = diagnostic.labels.first().map(|l| l.span)
        {
            let notes = self.came_from(code, span);
            diagnostic.notes.extend(notes);
        }
        if let (Some(value), true, "E211") = (first, args.is_empty(), diagnostic.code.0) {
            let fields =
                std::fields().filter(|f| f.params.first().is_some_and(|p| accepts(p.ty, value))).map(|f| f.name).collect::<Vec<_>>();
            let near = crate::lang::words::elsewhere::ours(builtin.name, fields.into_iter()).map(str::to_owned);
            if let Some(near) = near {
                diagnostic = diagnostic.help(format!("`.{near}`")).put(called, near);
            }
        }
        diagnostic
    }

    fn finite_result(&mut self, code: Code<'_>, id: ExprId, value: Value) -> Result<Value, Halt> {
        match &value {
            Value::Number(q) if !q.value.is_finite() => {
                Err(self.error(code, "E408", "the result is not a finite number", code.span(id), "too large, or undefined, here").stop())
            }
            _ => Ok(value),
        }
    }

    /// Calls a function of a script.
    fn call_fn(
        &mut self,
        code: Code<'_>,
        id: ExprId,
        (module, declaration): (ModuleId, u32),
        first: Option<Value>,
        args: &[Arg],
    ) -> Result<Value, Halt> {
        match self.machine.at(module).states[declaration as usize] {
            State::Done(_) => {}
            _ => {
                self.machine.site.expr = id;
                self.ensure(module, declaration)?;
            }
        }
        if self.machine.calls.len() >= limits::CALL_DEPTH {
            return Err(self.too_deep(code, id));
        }
        let script = self.machine.at(module).script.clone();
        let declared = &script.declarations[declaration as usize];
        let DeclarationKind::Fn { bound, params, returns, body } = &declared.kind else { return Err(Halt::Bug("not a function")) };
        let callee = Code { nodes: &declared.nodes, module, declaration };
        let given = self.fn_args(code, id, (bound.name, params), first, args)?;

        let site = self.machine.site;
        let (base, room) = (self.machine.locals.len(), self.machine.room);
        let old_base = ::std::mem::replace(&mut self.machine.base, base);
        self.machine.calls.push(Frame { name: bound.name, site: Site { expr: id, ..site }, origin: Origin::NONE });
        self.machine.site = Site { module, declaration, member: site.member, expr: *body };
        let result = work::uncharged(|| self.run_fn(callee, params, given, *body)).and_then(|value| match returns {
            Some(ty) => {
                let ty = Ty::written(self.program.names.text(ty.name), ty.lists).unwrap_or(Ty::Any);
                let subject = format!("the result of `{}`", self.program.names.text(bound.name));
                self.fit_expr(callee, *body, value, ty, &subject)
            }
            None => Ok(value),
        });
        self.machine.calls.pop();
        self.machine.room.give_back(room, result.as_ref().ok());
        self.machine.locals.truncate(base);
        self.machine.base = old_base;
        self.machine.site = site;
        result
    }

    fn run_fn(&mut self, callee: Code<'_>, params: &[FnParam], given: Vec<Option<Value>>, body: ExprId) -> Result<Value, Halt> {
        for (param, value) in params.iter().zip(given) {
            let value = match (value, param.default) {
                (Some(value), _) => value,
                (None, Some(default)) => self.param_value(callee, default, param)?,
                (None, None) => return Err(Halt::Bug("a missing argument was not reported")),
            };
            self.machine.locals.push((param.bound.name, value));
        }
        self.eval(callee, body)
    }

    fn param_value(&mut self, code: Code<'_>, id: ExprId, param: &FnParam) -> Result<Value, Halt> {
        match param.ty.and_then(|ty| Ty::written(self.program.names.text(ty.name), ty.lists)) {
            Some(ty) => {
                let subject = format!("`{}`", self.program.names.text(param.bound.name));
                self.eval_as(code, id, ty, &subject)
            }
            None => self.eval(code, id),
        }
    }

    /// Arguments of a script's function, evaluated at the call.
    fn fn_args(
        &mut self,
        code: Code<'_>,
        id: ExprId,
        (name, params): (Name, &[FnParam]),
        first: Option<Value>,
        args: &[Arg],
    ) -> Result<Vec<Option<Value>>, Halt> {
        let taken = usize::from(first.is_some());
        let simple = args.iter().all(|a| a.name.is_none()) && args.len() + taken <= params.len();
        let places: Vec<usize> = if simple {
            (taken..taken + args.len()).collect()
        } else {
            self.with_signature(name, params, |cx, signature| cx.match_args(code, signature, taken, args))?
        };
        let mut given: Vec<Option<Value>> = vec![None; params.len()];
        let mut gather = Gather::default();
        if let (Some(value), Some(param)) = (first, params.first()) {
            let value = match param.ty.and_then(|ty| Ty::written(self.program.names.text(ty.name), ty.lists)) {
                Some(ty) => {
                    let subject = format!("`{}`", self.program.names.text(param.bound.name));
                    self.fit_expr(code, id, value, ty, &subject)
                }
                None => Ok(value),
            };
            given[0] = gather.take(value);
        }
        for (arg, k) in args.iter().zip(places) {
            given[k] = gather.take(self.param_value(code, arg.value, &params[k]));
        }
        gather.done()?;
        match params.iter().zip(&given).find(|(p, v)| v.is_none() && p.default.is_none()) {
            None => Ok(given),
            Some((param, _)) => {
                let missing = self.program.names.text(param.bound.name).to_owned();
                self.with_signature(name, params, |cx, signature| Err(cx.missing(code, id, signature, &missing)))
            }
        }
    }

    fn with_signature<T>(
        &mut self,
        name: Name,
        params: &[FnParam],
        work: impl FnOnce(&mut Self, &Signature<'_>) -> Result<T, Halt>,
    ) -> Result<T, Halt> {
        let texts: Vec<String> = params.iter().map(|p| self.program.names.text(p.bound.name).to_owned()).collect();
        let name = self.program.names.text(name).to_owned();
        let parts: Vec<String> = params
            .iter()
            .zip(&texts)
            .map(|(p, text)| match p.ty {
                Some(ty) => format!("{text}: {}", self.program.names.text(ty.name)),
                None => text.clone(),
            })
            .collect();
        let shown = format!("{name}({})", parts.join(", "));
        let signature = Signature { name: &name, params: texts.iter().map(String::as_str).collect(), rest: None, shown };
        work(self, &signature)
    }

    /// `of.name`: a record's field, a name of a module, a field of the kind, then a function of one value.
    pub(crate) fn field(&mut self, code: Code<'_>, id: ExprId, of: ExprId, (name, span): (Name, Span)) -> Result<Value, Halt> {
        let value = self.eval(code, of)?;
        match &value {
            Value::Record(r) => {
                if let Some(value) = r.get(name) {
                    return Ok(value.clone());
                }
            }
            Value::Module(module) => return self.member_of(code, id, *module, (name, span)),
            _ => {}
        }
        let (function, has_fields) = self.word(name);
        if has_fields && let Some(field) = self.field_for(name, &value) {
            return self.run(code, id, field, Some(value), &[]);
        }
        if let Some(declaration) = self.script_fn(code.module, name) {
            return self.call_fn(code, id, (code.module, declaration), Some(value), &[]);
        }
        match function {
            Some(function) if !matches!(value, Value::Record(_)) || accepts(function.params.first().map_or(Ty::None, |p| p.ty), &value) => {
                self.run(code, id, function, Some(value), &[])
            }
            _ => Err(self.no_field(code, &value, name, span)),
        }
    }

    /// `ribs.arch`: what a module declares.
    fn member_of(&mut self, code: Code<'_>, id: ExprId, module: ModuleId, (name, span): (Name, Span)) -> Result<Value, Halt> {
        match self.machine.at(module).find(name) {
            Some(declaration) if self.machine.at(module).script.declarations[declaration as usize].keyword != Keyword::Fn => {
                self.machine.site.expr = id;
                self.ensure(module, declaration)
            }
            None if self.machine.at(module).is_broken(name) => Err(Halt::Broken),
            found => {
                let label = self.machine.at(module).label.clone();
                let text = self.program.names.text(name).to_owned();
                if found.is_some() {
                    let draft = self.error(code, "E211", format!("`{label}.{text}` is a function"), span, "functions are not values");
                    return Err(draft.help(format!("call it: `{label}.{text}(…)`")).stop());
                }
                self.note_unknown(code.module, span, Unknown { name, of: module, among: Among::Members });
                Err(self.error(code, "E214", format!("`{label}` declares no `{text}`"), span, "not in that script").stop())
            }
        }
    }

    /// E214: nothing of that name for this kind.
    #[cold]
    fn no_field(&mut self, code: Code<'_>, value: &Value, name: Name, span: Span) -> Halt {
        let text = self.program.names.text(name).to_owned();
        if later::is_function(&text) {
            return self.error(code, "E230", format!("`{text}` is not in this version"), span, "a later version has it").stop();
        }
        let kind = self.kind(value);
        let fields: Vec<String> = match value {
            Value::Record(r) => r.keys.iter().map(|k| self.program.names.text(*k).to_owned()).collect(),
            _ => std::fields().filter(|f| f.params.first().is_some_and(|p| accepts(p.ty, value))).map(|f| f.name.to_owned()).collect(),
        };
        let near = meant(&text, fields.iter().map(String::as_str)).map(str::to_owned);
        let alike = near.as_deref().and_then(|near| lookalikes::difference(&text, near));
        let draft = self.error(code, "E214", format!("{kind} has no `{text}`"), span, "no such field").notes(alike);
        match near {
            Some(near) => draft.help(format!("`.{near}`")).put(span, near).stop(),
            None if fields.is_empty() || fields.len() > 24 => draft.stop(),
            None => draft.note(format!("it has {}", fields.join(", "))).stop(),
        }
    }

    /// `of[index]`.
    pub(crate) fn index(&mut self, code: Code<'_>, id: ExprId, of: ExprId, index: ExprId) -> Result<Value, Halt> {
        let value = self.eval(code, of)?;
        if matches!(value, Value::Curve(_) | Value::Link(..)) {
            return self.slice_curve(code, id, value, index);
        }
        let value = if let Value::Table(t) = value { Value::List(t.rows.clone()) } else { value };
        if let Value::Record(record) = &value
            && !record.row
            && !matches!(code.expr(index), Expr::Slice { .. })
        {
            return match self.eval(code, index)? {
                Value::Text(key) => self.member(code, record, &key, index),
                other => {
                    let found = self.show_inside(&other);
                    Err(self
                        .error(code, "E211", format!("a record is indexed by a name in quotes, got {found}"), code.span(index), found)
                        .stop())
                }
            };
        }
        let Some(n) = value.len() else {
            let found = self.kind(&value);
            let axis = match (&value, code.expr(index)) {
                (Value::Vector(..) | Value::Node(_) | Value::Vertex(..), Expr::Number(k)) => ["x", "y", "z"].get(*k as usize),
                _ => None,
            };
            let typed: Vec<String> = axis.map(|axis| format!("{}.{axis}", self.source(code, of))).into_iter().collect();
            let draft = self.error(code, "E211", format!("{found} has no members to index"), code.span(of), found);
            return Err(if typed.is_empty() { draft.stop() } else { draft.ways(code.span(id), &typed).stop() });
        };
        match code.expr(index) {
            Expr::Slice { from, to } => {
                let a = from.map_or(Ok(0), |e| self.bound_of(code, e, n))?;
                let b = to.map_or(Ok(n), |e| self.bound_of(code, e, n))?;
                self.made(code, id, LIST_COST + b.saturating_sub(a))?;
                Ok(Value::list((a..b.max(a)).filter_map(|i| value.item(i)).collect()))
            }
            _ => match self.eval(code, index)? {
                Value::Number(q) if q.dim.is_none() && q.value == q.value.trunc() => {
                    let k = if q.value < 0.0 { q.value + n as f64 } else { q.value };
                    match (k >= 0.0 && k < n as f64).then(|| value.item(k as usize)).flatten() {
                        Some(item) => Ok(item),
                        None => Err(self.outside(code, index, q.value, n)),
                    }
                }
                Value::Range(a, b) => {
                    let clip = |k: i64| usize::try_from(k.clamp(0, n as i64)).unwrap_or(0);
                    self.made(code, id, LIST_COST + clip(b).saturating_sub(clip(a)))?;
                    Ok(Value::list((clip(a)..clip(b).max(clip(a))).filter_map(|i| value.item(i)).collect()))
                }
                Value::Text(key) => match &value {
                    Value::Record(record) => self.member(code, record, &key, index),
                    _ => Err(self.error(code, "E214", format!("there is no \"{key}\""), code.span(index), "no such name").stop()),
                },
                other => {
                    let found = self.show_inside(&other);
                    Err(self.error(code, "E211", format!("an index is a whole number, got {found}"), code.span(index), found).stop())
                }
            },
        }
    }

    /// `part["deck"]`.
    fn member(&mut self, code: Code<'_>, record: &Record, key: &str, index: ExprId) -> Result<Value, Halt> {
        if let Some(value) = self.program.names.find(key).and_then(|name| record.get(name)) {
            return Ok(value.clone());
        }
        let near =
            crate::lang::words::names::nearest(key, record.keys.iter().map(|name| self.program.names.text(*name))).map(str::to_owned);
        let draft = self.error(code, "E214", format!("there is no \"{key}\""), code.span(index), "no such name");
        Err(match near {
            Some(near) => draft.help(format!("[\"{near}\"]")).stop(),
            None => draft.stop(),
        })
    }

    fn bound_of(&mut self, code: Code<'_>, id: ExprId, n: usize) -> Result<usize, Halt> {
        match self.eval(code, id)? {
            Value::Number(q) if q.dim.is_none() && q.value == q.value.trunc() => {
                let k = if q.value < 0.0 { q.value + n as f64 } else { q.value };
                if (0.0..=n as f64).contains(&k) { Ok(k as usize) } else { Err(self.outside(code, id, q.value, n)) }
            }
            other => {
                let found = self.show_inside(&other);
                Err(self.error(code, "E211", format!("a place in a list is a whole number, got {found}"), code.span(id), found).stop())
            }
        }
    }

    #[cold]
    fn outside(&mut self, code: Code<'_>, id: ExprId, k: f64, n: usize) -> Halt {
        let k = crate::lang::values::units::number_text(k);
        let text = match n {
            0 => format!("index {k} of an empty list"),
            1 => format!("index {k} of a list with one member"),
            _ => format!("index {k} of a list with {n} members"),
        };
        let draft = self.error(code, "E215", text, code.span(id), "outside");
        match n {
            0 => draft.stop(),
            _ => draft.help(format!("0 to {}, or -1 to -{n} from the end", n - 1)).stop(),
        }
    }
}
