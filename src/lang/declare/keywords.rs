//! Declarations: what each keyword makes of its right side.

use crate::base::origin::Origin;
use crate::lang::declare::collections::Contents;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::eval::room::LIST_COST;
use crate::lang::eval::std;
use crate::lang::eval::unbound::keyword_word;
use crate::lang::syntax::ast::{Declaration, DeclarationKind, ExprId, FnParam, For, Keyword, TypeName};
use crate::lang::values::origins::{NO_MEMBER, OriginEntry};
use crate::lang::values::types::{TYPE_NAMES, Ty};
use crate::lang::values::value::{Dim, ModuleId, Value};
use crate::lang::words::names::Name;
use crate::network::Chain;

/// Makes one member of a family, told its indices.
type Make<'m, C> = &'m mut dyn FnMut(&mut C, [u32; 2]) -> Result<Value, Halt>;

impl Cx<'_> {
    /// Evaluates a declaration.
    pub(crate) fn declare(&mut self, code: Code<'_>, declaration: &Declaration) -> Result<Value, Halt> {
        match &declaration.kind {
            DeclarationKind::Value { family, value, .. } => {
                let (keyword, value) = (declaration.keyword, *value);
                self.family(code, family, &mut |cx, member| cx.one_value(code, keyword, value, member))
            }
            DeclarationKind::Param { bound, ty, value, allowed } => self.param(code, *bound, ty.as_ref(), *value, allowed.as_ref()),
            DeclarationKind::Fn { bound, params, returns, .. } => self.check_fn(code, bound.name, params, returns.as_ref()),
            DeclarationKind::Load { path, args, bound } if declaration.keyword == Keyword::Use => {
                self.load_module(code, *path, args, *bound)
            }
            DeclarationKind::Load { path, args, .. } => self.import(code, *path, args),
            DeclarationKind::Collection { family, things, settings, clauses, .. } => {
                self.collection(code, declaration, family, Contents { things, settings, clauses })
            }
            DeclarationKind::Output { .. } => self.output(code, declaration),
            DeclarationKind::Units(_) | DeclarationKind::Tolerance(_) | DeclarationKind::Snap(_) => Ok(Value::None),
        }
    }

    /// Evaluates the members of a family, or the one thing when there is no `for`.
    pub(crate) fn family(&mut self, code: Code<'_>, family: &[For], make: Make<'_, Self>) -> Result<Value, Halt> {
        self.members(code, family, [NO_MEMBER; 2], 0, make)
    }

    fn members(&mut self, code: Code<'_>, family: &[For], member: [u32; 2], level: usize, make: Make<'_, Self>) -> Result<Value, Halt> {
        let Some((f, rest)) = family.split_first() else {
            self.machine.site.member = member;
            return make(self, member);
        };
        let Some(slot) = (level < member.len()).then_some(level) else {
            return Err(self.error(code, "E302", "a family runs over one or two lists", f.name_span, "one `for` too many").stop());
        };
        let list = self.list_of(code, f)?;
        self.made(code, f.list, LIST_COST + list.len().unwrap_or(0))?;
        let (mut out, mut gather) = (Vec::with_capacity(list.len().unwrap_or(0)), Gather::default());
        self.each(f.name, &list, |cx, i| {
            let mut member = member;
            member[slot] = i as u32;
            cx.step()?;
            let before = cx.machine.room;
            let made = cx.members(code, rest, member, level + 1, make);
            cx.machine.room.give_back(before, made.as_ref().ok());
            let failed = made.is_err();
            out.extend(gather.take(made));
            // Many members with the same mistake are one mistake.
            if failed && cx.sink.reports.len() > 20 { Err(Halt::Failed) } else { Ok(()) }
        })?;
        gather.done().map(|()| Value::list(out))
    }

    fn one_value(&mut self, code: Code<'_>, keyword: Keyword, value: ExprId, member: [u32; 2]) -> Result<Value, Halt> {
        let ty = match keyword {
            Keyword::Point => Ty::Point,
            Keyword::Curve | Keyword::ModelingCurve => Ty::Curve,
            Keyword::Surface => Ty::Surface,
            _ => return self.eval(code, value),
        };
        let found = self.eval(code, value)?;
        let fitted = match (ty, found) {
            (Ty::Curve, found @ Value::Curve(_)) | (Ty::Surface, found @ Value::Surface(_)) => found,
            (Ty::Point, Value::Vector(p, Dim::NONE)) => Value::point(p * self.bare_unit(code.module)),
            (Ty::Point, Value::Vector(p, Dim::LENGTH)) => Value::point(p),
            (ty, found) => {
                let subject = format!("`{}`", self.declaration_name(code.module, code.declaration));
                self.fit_expr(code, value, found, ty, &subject)?
            }
        };
        match (keyword, fitted) {
            (Keyword::Curve, Value::Curve(chain)) => {
                let curve = match chain.whole_curve() {
                    Some(curve) if self.is_own(curve.origin(), code, value, member) => return Ok(Value::Curve(chain)),
                    Some(curve) => curve.clone(),
                    None => chain.to_curve()?,
                };
                let origin = self.own_origin(code, member);
                Ok(Value::Curve(Chain::of_curve(&curve.with_origin(origin))))
            }
            (Keyword::ModelingCurve, Value::Curve(chain)) => Ok(Value::Curve(chain.with_origin(self.own_origin(code, member)))),
            (Keyword::Surface, Value::Surface(surface)) if !self.is_own(surface.origin(), code, value, member) => {
                Ok(Value::Surface(surface.with_origin(self.own_origin(code, member))))
            }
            (_, Value::Node(p)) => Ok(Value::point(p)),
            (_, other) => Ok(other),
        }
    }

    /// The origin that stands for a declaration or a member of it.
    pub(crate) fn own_origin(&mut self, code: Code<'_>, member: [u32; 2]) -> Origin {
        self.program.origins.add(OriginEntry {
            module: code.module,
            declaration: code.declaration,
            member,
            expr: None,
            caller: Origin::NONE,
        })
    }

    /// Whether an entity was made by the right side itself, so that its origin is the declaration's already.
    fn is_own(&self, origin: Origin, code: Code<'_>, value: ExprId, member: [u32; 2]) -> bool {
        let own = OriginEntry { module: code.module, declaration: code.declaration, member, expr: Some(value), caller: Origin::NONE };
        self.program.origins.place(origin) == Some(own)
    }

    /// Names and types of a function; its body is looked at when it is called.
    fn check_fn(&mut self, code: Code<'_>, name: Name, params: &[FnParam], returns: Option<&TypeName>) -> Result<Value, Halt> {
        let mut gather = Gather::default();
        let text = self.program.names.text(name).to_owned();
        if std::builtins().any(|b| b.name == text) {
            let span = self.machine.at(code.module).script.declarations.keyword_span(code.declaration as usize);
            let span = self.machine.at(code.module).script.declarations.bound(code.declaration as usize).map_or(span, |b| b.span);
            let draft = self.error(code, "E202", format!("`{text}` is a function of the language"), span, "taken");
            gather.take::<()>(Err(draft.help(format!("another name: `my_{text}`")).put(span, format!("my_{text}")).stop()));
        }
        for (i, param) in params.iter().enumerate() {
            if let Some(ty) = &param.ty {
                gather.take(self.written_type(code, ty));
            }
            if let Some(before) = params[..i].iter().find(|p| p.bound.name == param.bound.name) {
                let text = format!("`{}` is defined twice", self.program.names.text(param.bound.name));
                let draft = self.error(code, "E202", text, param.bound.span, "again here").and(before.bound.span, "first here");
                gather.take::<()>(Err(draft.stop()));
            }
        }
        if let Some(ty) = returns {
            gather.take(self.written_type(code, ty));
        }
        gather.done().map(|()| Value::None)
    }

    /// A type as written.
    pub(crate) fn written_type(&mut self, code: Code<'_>, ty: &TypeName) -> Result<Ty, Halt> {
        let text = self.program.names.text(ty.name).to_owned();
        if let Some(ty) = Ty::written(&text, ty.lists) {
            return Ok(ty);
        }
        let near = crate::lang::words::names::nearest(&text, TYPE_NAMES.iter().copied());
        let draft = self.error(code, "E213", format!("there is no type `{text}`"), ty.span, "no such type");
        Err(match near {
            Some(near) => draft.help(format!("`{near}`")).put(ty.span, near).stop(),
            None => draft.help(format!("one of {}", TYPE_NAMES.join(", "))).stop(),
        })
    }

    /// How many declarations of each keyword, in words: "2 curves, 1 surface".
    pub(crate) fn count_words(&self, members: &[(ModuleId, u32)]) -> String {
        let mut counts: Vec<(Keyword, usize)> = Vec::new();
        for (m, d) in members {
            let keyword = self.machine.at(*m).script.declarations.keyword(*d as usize);
            match counts.iter_mut().find(|c| c.0 == keyword) {
                Some(count) => count.1 += 1,
                None => counts.push((keyword, 1)),
            }
        }
        counts.sort_unstable();
        let plural = |k: Keyword, n: usize| match (keyword_word(k), n) {
            ("fn", 1) => "function".to_owned(),
            ("fn", _) => "functions".to_owned(),
            ("let", 1) => "value".to_owned(),
            ("let", _) => "values".to_owned(),
            (word, 1) => word.to_owned(),
            ("mesh", _) => "meshes".to_owned(),
            (word, _) => format!("{word}s"),
        };
        counts.iter().map(|(k, n)| format!("{n} {}", plural(*k, *n))).collect::<Vec<_>>().join(", ")
    }
}
