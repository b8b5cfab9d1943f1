//! `shell`, `group`, `mesh`: things and settings, resolved to plain data.

use std::sync::Arc;

use crate::base::fault::ValueFault;
use crate::base::limits;
use crate::base::origin::Origin;
use crate::base::text::article;
use crate::lang::declare::shares::Meshed;
use crate::lang::diag::span::Span;
use crate::lang::eval::coerce::flatten_into;
use crate::lang::eval::context::Cx;
use crate::lang::eval::faults::member_name;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::later;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::eval::room::flat_len;
use crate::lang::eval::scene::each_once;
use crate::lang::eval::std::imprint::pieces;
use crate::lang::syntax::ast;
use crate::lang::syntax::ast::bound;
use crate::lang::syntax::ast::{ClauseWord, Declaration, Expr, ExprId, For, Keyword, MeshClause};
use crate::lang::values::origins::NO_MEMBER;
use crate::lang::values::part::Skin;
use crate::lang::values::plans::{Located, MeshSpec, RefineSpec, RuleSpec};
use crate::lang::values::settings;
use crate::lang::values::settings::Setting;
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, MeshValue, ShellValue, Value};
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
    /// The origin of an expression of the declaration being evaluated.
    pub(crate) fn origin_at(&mut self, expr: ExprId) -> Origin {
        self.machine.site.expr = expr;
        self.origin()
    }

    pub(crate) fn collection(
        &mut self,
        code: Code<'_>,
        declaration: &Declaration,
        family: &[For],
        things: &[ExprId],
        (settings, clauses): (&[ast::Setting], &[MeshClause]),
    ) -> Result<Value, Halt> {
        let name = bound(declaration).map(|b| self.program.names.text(b.name).to_owned()).unwrap_or_default();
        let mut meshes: Vec<MeshSpec> = Vec::new();
        let base = self.machine.at(code.module).meshes.len();
        let keyword = declaration.keyword;
        let value = self.family(code, family, &mut |cx, member| {
            let name: Arc<str> = member_name(&name, member).into();
            let origin = cx.own_origin(code, member);
            let mut gather = Gather::default();
            let thing_exprs = things;
            let things = gather.take(cx.things(code, things, keyword));
            match keyword {
                Keyword::Shell => {
                    let settings = gather.take(cx.settings(code, "shell", settings::SHELL, settings));
                    gather.done()?;
                    let settings = settings.unwrap_or_default();
                    let mut snap = said(&settings, "snap", number);
                    let flip = said(&settings, "flip", truth).is_some_and(|said| said.0);
                    let skins = cx.skins(code, thing_exprs)?;
                    let asked = said(&settings, "imprint", truth).filter(|said| said.0);
                    let mut imprint = asked.map(|said| said.1);
                    let things = things.unwrap_or_default();
                    // What is of one body alone is that body.
                    let body = match (skins.as_slice(), things.as_slice()) {
                        ([(_, body)], _) => *body,
                        (_, [(Value::Shell(s), _)]) => s.body,
                        _ => None,
                    };
                    let mut surfaces = Vec::with_capacity(things.len());
                    for (thing, _) in things {
                        match thing {
                            Value::Surface(s) => surfaces.push(s),
                            Value::Shell(s) => {
                                surfaces.extend(s.surfaces.iter().map(|face| if s.flip { face.flipped() } else { face.clone() }));
                                snap = snap.or(s.snap);
                                imprint = imprint.or(s.imprint);
                            }
                            _ => return Err(Halt::Bug("a shell of something else")),
                        }
                    }
                    let mut surfaces = each_once(surfaces);
                    if skins.len() > 1 {
                        let mut shells = Vec::with_capacity(skins.len());
                        for (k, (mut surfaces, body)) in skins.into_iter().enumerate() {
                            let mut member = member;
                            let free = member.iter().position(|m| *m == NO_MEMBER).unwrap_or(1);
                            member[free] = k as u32;
                            let origin = cx.own_origin(code, member);
                            if let Some((_, origin)) = asked {
                                surfaces = pieces(cx, surfaces, origin)?;
                            }
                            let name = format!("{name}[{k}]").into();
                            let shell = ShellValue { name, module: code.module, origin, surfaces, snap, imprint, flip, body };
                            shells.push(Value::Shell(Arc::new(shell)));
                        }
                        return Ok(Value::list(shells));
                    }
                    if let Some((_, origin)) = asked {
                        surfaces = pieces(cx, surfaces, origin)?;
                    }
                    Ok(Value::Shell(Arc::new(ShellValue { name, module: code.module, origin, surfaces, snap, imprint, flip, body })))
                }
                Keyword::Mesh => {
                    let settings = gather.take(cx.settings(code, "mesh", settings::MESH, settings));
                    let (on, others): (Vec<&MeshClause>, Vec<_>) = clauses.iter().partition(|c| c.word == ClauseWord::On);
                    // Without things there is a fault already, or they are asked for again.
                    let diagonal = if things.is_none() { Some(1.0) } else { None };
                    let things = things.unwrap_or_default();
                    let mut meshed = Meshed { things: &things, said: thing_exprs, diagonal };
                    let rules: Vec<RuleSpec> = on.into_iter().filter_map(|c| gather.take(cx.rule(code, c, &mut meshed))).collect();
                    let refines: Vec<RefineSpec> =
                        others.into_iter().filter_map(|c| gather.take(cx.refine(code, c, &mut meshed))).collect();
                    gather.done()?;
                    let mut settings = settings.unwrap_or_default();
                    cx.shares(code, &mut settings, &mut meshed)?;
                    meshes.push(MeshSpec { name, origin, things, settings: filled(&settings)?, rules, refines });
                    let index = u32::try_from(base + meshes.len() - 1).unwrap_or(u32::MAX);
                    Ok(Value::Mesh(Arc::new(MeshValue::Declared { module: code.module, index })))
                }
                _ => {
                    gather.take(cx.settings(code, "group", &[], settings));
                    gather.done()?;
                    Ok(Value::list(things.unwrap_or_default().into_iter().map(|t| t.0).collect()))
                }
            }
        })?;
        let module = self.machine.at_mut(code.module);
        module.mesh_stages.resize_with(base + meshes.len(), || crate::lang::eval::module::Stage::Waiting);
        module.meshes.extend(meshes.into_iter().map(Arc::new));
        Ok(value)
    }

    /// Things of a collection, nested lists flattened, each of a kind that may be there.
    pub(crate) fn things(&mut self, code: Code<'_>, things: &[ExprId], keyword: Keyword) -> Result<Vec<(Value, Origin)>, Halt> {
        self.things_for(code, things, (keyword, later::keyword_word(keyword)))
    }

    /// The same, with the word for what the things are for.
    pub(crate) fn things_for(
        &mut self,
        code: Code<'_>,
        things: &[ExprId],
        (keyword, word): (Keyword, &'static str),
    ) -> Result<Vec<(Value, Origin)>, Halt> {
        let (wanted, fits): (&str, fn(&Value) -> bool) = match keyword {
            Keyword::Shell => ("surfaces", |v| matches!(v, Value::Surface(_) | Value::Shell(_))),
            Keyword::Mesh => ("surfaces, shells, curves and points", |v| {
                matches!(
                    v,
                    Value::Surface(_)
                        | Value::Shell(_)
                        | Value::Curve(_)
                        | Value::Link(..)
                        | Value::Edge(..)
                        | Value::Vector(..)
                        | Value::Node(_)
                        | Value::Vertex(..)
                )
            }),
            Keyword::Picture => ("things with geometry", |v| {
                matches!(
                    v,
                    Value::Surface(_)
                        | Value::Shell(_)
                        | Value::Mesh(_)
                        | Value::Curve(_)
                        | Value::Link(..)
                        | Value::Edge(..)
                        | Value::Patch(..)
                        | Value::Vertex(..)
                        | Value::Vector(..)
                        | Value::Node(_)
                        | Value::Network(_)
                )
            }),
            Keyword::Export => ("meshes, curves, surfaces or records", |v| !matches!(v, Value::None | Value::Module(_) | Value::Plane(_))),
            _ => ("things with geometry", |v| {
                !matches!(
                    v,
                    Value::None
                        | Value::Bool(_)
                        | Value::Number(_)
                        | Value::Text(_)
                        | Value::Word(_)
                        | Value::Record(_)
                        | Value::Range(..)
                        | Value::Module(_)
                        | Value::Table(_)
                        | Value::Plane(_)
                )
            }),
        };
        let (mut out, mut gather) = (Vec::new(), Gather::default());
        for &thing in things {
            let Some(value) = gather.take(self.eval(code, thing)) else { continue };
            let origin = self.origin_at(thing);
            // What a mesh or shell is of may well be empty in some variants of a model.
            if !matches!(keyword, Keyword::Shell | Keyword::Mesh) {
                self.say_empty(code, thing, &value, word);
            }
            let flat = self.opened(code, thing, value, keyword)?;
            for value in flat {
                if fits(&value) {
                    // A bare tuple is a point here.
                    let value = if keyword != Keyword::Export && matches!(value, Value::Vector(_, d) if d.is_none()) {
                        self.fit_expr(code, thing, value, crate::lang::values::types::Ty::Point, "this")?
                    } else {
                        value
                    };
                    out.push((value, origin));
                    continue;
                }
                let found = self.kind(&value);
                let text = match keyword {
                    Keyword::Export => format!("{found} cannot be exported"),
                    _ => format!("a {word} takes {wanted}, got {found}"),
                };
                gather.take::<()>(Err(self.error(code, "E211", text, code.span(thing), found).stop()));
                break;
            }
        }
        gather.done().map(|()| out)
    }

    /// The skins of a part that a shell alone is of: several become a shell each.
    fn skins(&mut self, code: Code<'_>, things: &[ExprId]) -> Result<Vec<Skin>, Halt> {
        let [thing] = things else { return Ok(Vec::new()) };
        if !matches!(code.expr(*thing), Expr::Name(_) | Expr::Field { .. } | Expr::Index { .. }) {
            return Ok(Vec::new());
        }
        let value = self.eval(code, *thing)?;
        Ok(value.part().map_or_else(Vec::new, |part| part.skins()))
    }

    /// Nested lists flattened, and parts as what they are made of: bodies as shells for what keeps them apart, else faces.
    fn opened(&mut self, code: Code<'_>, thing: ExprId, value: Value, keyword: Keyword) -> Result<Vec<Value>, Halt> {
        let flat = self.flattened(code, thing, value)?;
        if flat.iter().all(|value| value.part().is_none()) {
            return Ok(flat);
        }
        let mut open = Vec::new();
        for value in flat {
            let Some(part) = value.part() else {
                open.push(value);
                continue;
            };
            match keyword {
                Keyword::Mesh => open.extend(part.things()),
                Keyword::Picture | Keyword::Export => {
                    open.extend(part.things());
                    for key in ["curves", "points"] {
                        let list =
                            self.program.names.find(key).and_then(|key| if let Value::Record(r) = &value { r.get(key) } else { None });
                        flatten_into(list.cloned().unwrap_or_else(|| Value::list(Vec::new())), &mut open);
                    }
                }
                _ => open.extend(part.faces.iter().cloned().map(Value::Surface)),
            }
        }
        Ok(open)
    }

    /// W728 where a selection is empty: the whole expression, or one that is written inside a list.
    fn say_empty(&mut self, code: Code<'_>, thing: ExprId, value: &Value, word: &'static str) {
        // Lists that hold each other without end are no empty ones to look for.
        if flat_len(value, limits::LIST_MEMBERS) > limits::LIST_MEMBERS {
            return;
        }
        let mut flat = Vec::new();
        flatten_into(value.clone(), &mut flat);
        match (value, code.expr(thing)) {
            (Value::List(values), Expr::List(items)) if items.len() == values.len() && !values.is_empty() => {
                let pairs = items.iter().zip(values.iter()).filter(|(_, value)| matches!(value, Value::List(_) | Value::Range(..)));
                pairs.for_each(|(item, value)| self.say_empty(code, *item, value, word));
            }
            _ if flat.is_empty() => {
                let of = self.origin_at(thing);
                self.say(&ValueFault::NothingSelected { of, keyword: word }.into());
            }
            _ => {}
        }
    }

    /// Settings of a block, each key known, given once and of its type.
    pub(crate) fn settings(
        &mut self,
        code: Code<'_>,
        word: &str,
        table: &'static [Setting],
        settings: &[ast::Setting],
    ) -> Result<Vec<Resolved>, Halt> {
        let (mut out, mut gather) = (Vec::<Resolved>::with_capacity(settings.len()), Gather::default());
        for setting in settings {
            let key = self.program.names.text(setting.key).to_owned();
            let Some(known) = table.iter().find(|s| s.key == key) else {
                gather.take::<()>(Err(self.no_setting(code, (word, table), &key, setting.key_span)));
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
    fn no_setting(&mut self, code: Code<'_>, (word, table): (&str, &[Setting]), key: &str, span: Span) -> Halt {
        let near = meant(key, table.iter().map(|s| s.key)).map(str::to_owned);
        let text = format!("{} has no setting `{key}`", if word == "on" { "`on`".to_owned() } else { format!("{} {word}", article(word)) });
        let label = near.as_ref().map_or_else(|| "no such setting".to_owned(), |near| format!("did you mean `{near}`?"));
        let keys: Vec<&str> = table.iter().map(|s| s.key).collect();
        let alike = near.as_deref().and_then(|near| lookalikes::difference(key, near));
        let draft = self.error(code, "E303", text, span, label).puts(span, near).notes(alike);
        if keys.is_empty() { draft.stop() } else { draft.note(format!("it takes {}", keys.join(", "))).stop() }
    }

    /// `on things { … }`.
    fn rule(&mut self, code: Code<'_>, clause: &MeshClause, meshed: &mut Meshed<'_>) -> Result<RuleSpec, Halt> {
        let mut gather = Gather::default();
        let things = gather.take(self.rule_things(code, &clause.things)).unwrap_or_default();
        let mut settings = gather.take(self.settings(code, "on", settings::ON, &clause.settings)).unwrap_or_default();
        gather.done()?;
        self.shares(code, &mut settings, meshed)?;
        let origin = match clause.things.first() {
            Some(thing) => self.origin_at(*thing),
            None => Origin::NONE,
        };
        Ok(RuleSpec { things, settings: filled(&settings)?, origin })
    }

    fn rule_things(&mut self, code: Code<'_>, things: &[ExprId]) -> Result<Vec<(Value, Origin)>, Halt> {
        let found = self.things_for(code, things, (Keyword::Group, "rule"))?;
        let wrong = found.iter().find(|(v, _)| matches!(v, Value::Vector(..) | Value::Node(_) | Value::Vertex(..) | Value::Mesh(_)));
        match wrong {
            None => Ok(found),
            Some((value, origin)) => {
                let (kind, span) = (self.kind(value), self.span_of(*origin).map_or_else(Span::default, |s| s.1));
                let text = format!("`on` takes links, curves, edges and faces, got {kind}");
                Err(self.error(code, "E211", text, span, kind).stop())
            }
        }
    }
}
