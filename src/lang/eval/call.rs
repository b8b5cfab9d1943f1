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
use crate::lang::eval::machine::{CallFrame, Code, Gather, Site, Word};
use crate::lang::eval::module::State;
use crate::lang::eval::reach::given_beyond;
use crate::lang::eval::std;
use crate::lang::eval::std::Builtin;
use crate::lang::syntax::ast::{Arg, DeclarationKind, ExprId, FnParam, Keyword};
use crate::lang::values::types::Ty;
use crate::lang::values::value::{ModuleId, Value};
use crate::lang::words::names::Name;

/// A call of a builtin: what stands before its dot, if anything, and its arguments.
struct BuiltinCall<'a> {
    builtin: &'static Builtin,
    first: Option<&'a Value>,
    args: &'a [Arg],
}

impl Cx<'_> {
    /// What a name followed by `(` leads to, looked up once: a function, and whether fields have this name.
    pub(crate) fn word(&mut self, name: Name) -> (Option<&'static Builtin>, bool) {
        if let Some(Word { function, fields }) = self.machine.words.get(name) {
            return (*function, !fields.is_empty());
        }
        let text = self.program.names.text(name);
        let function = std::builtins().find(|b| b.name == text);
        let fields: Box<[&'static Builtin]> = std::fields().filter(|f| f.name == text).collect();
        let has_fields = !fields.is_empty();
        self.machine.words.insert(name, Word { function, fields });
        (function, has_fields)
    }

    /// The field of that name for this kind of value; [`Cx::word`] has looked the name up.
    pub(crate) fn field_for(&self, name: Name, value: &Value) -> Option<&'static Builtin> {
        let Word { fields, .. } = self.machine.words.get(name)?;
        fields.iter().copied().find(|f| f.params.first().is_some_and(|p| accepts(p.ty, value)))
    }

    /// `name(args)` and `of.name(args)`.
    pub(crate) fn call(
        &mut self,
        code: Code<'_>,
        id: ExprId,
        name: Name,
        name_span: Span,
        of: Option<ExprId>,
        args: &[Arg],
    ) -> Result<Value, Halt> {
        let first = match of {
            Some(of) => match self.eval(code, of)? {
                Value::Module(module) => return self.call_in(code, id, module, name, name_span, args),
                value => Some(value),
            },
            None => None,
        };
        if let Some(declaration) = self.script_fn(code.module, name) {
            return self.call_fn(code, id, code.module, declaration, first, args);
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
    pub(crate) fn script_fn(&self, module: ModuleId, name: Name) -> Option<u32> {
        let module = self.machine.at(module);
        let declaration = module.find(name)?;
        (module.script.declarations.keyword(declaration as usize) == Keyword::Fn).then_some(declaration)
    }

    /// `ribs.rib(3m)`: a function of a module.
    fn call_in(&mut self, code: Code<'_>, id: ExprId, module: ModuleId, name: Name, span: Span, args: &[Arg]) -> Result<Value, Halt> {
        match self.script_fn(module, name) {
            Some(declaration) => self.call_fn(code, id, module, declaration, None, args),
            None if self.machine.at(module).is_broken(name) => Err(Halt::Broken),
            None => {
                let (label, text) = (self.machine.at(module).label.clone(), self.program.names.text(name).to_owned());
                Err(self.error(code, "E214", format!("`{label}` has no function `{text}`"), span, "no such function").stop())
            }
        }
    }

    /// Binds, calls a builtin, and shows its faults at the arguments.
    pub(crate) fn run(
        &mut self,
        code: Code<'_>,
        id: ExprId,
        builtin: &'static Builtin,
        first: Option<Value>,
        args: &[Arg],
    ) -> Result<Value, Halt> {
        let before = first.clone();
        let values = self.bind(code, id, builtin, first, args)?;
        self.machine.site.expr = id;
        let budget = self.machine.budget.clone();
        let called = match given_beyond(builtin, &values) {
            Some(fault) => Ok(Err(fault.into())),
            None => budget.within(|| (builtin.call)(self, values)),
        };
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
                self.made_in_reach(code, id, builtin, &value)?;
                self.made_by_builtin(code, id, &value)?;
                self.finite_result(code, id, value)
            }
            Err(Halt::Fault(crate::base::fault::Fault::Interrupted)) => Err(crate::base::fault::Fault::Interrupted.into()),
            Err(Halt::Fault(fault)) => {
                let blame = self.blame(code, id, builtin, before.is_some(), args);
                let mut diagnostic = self.locate(&fault, code, call_name(code, id), &blame);
                self.advise(&fault, code, id, &blame, &mut diagnostic);
                let of_value = fault.of::<ValueFault>().is_some();
                let diagnostic = self.by_place(code, id, diagnostic, of_value, &BuiltinCall { builtin, first: before.as_ref(), args });
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
    fn by_place(&self, code: Code<'_>, id: ExprId, mut diagnostic: Diagnostic, of_value: bool, call: &BuiltinCall) -> Diagnostic {
        let BuiltinCall { builtin, first, args } = *call;
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
                diagnostic = diagnostic.help(format!("`.{near}`")).put(call_name(code, id), near);
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
    pub(crate) fn call_fn(
        &mut self,
        code: Code<'_>,
        id: ExprId,
        module: ModuleId,
        declaration: u32,
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
        let declared = script.declarations.whole(declaration as usize);
        let DeclarationKind::Fn { bound, params, returns, body } = &declared.kind else { return Err(Halt::Bug("not a function")) };
        let callee = Code { nodes: &declared.nodes, module, declaration };
        let given = self.fn_args(code, id, bound.name, params, first, args)?;

        let site = self.machine.site;
        let (base, room) = (self.machine.locals.len(), self.machine.room);
        let old_base = ::std::mem::replace(&mut self.machine.base, base);
        self.machine.calls.push(CallFrame { name: bound.name, site: Site { expr: id, ..site }, origin: Origin::NONE });
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
        name: Name,
        params: &[FnParam],
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
}
