//! `shell`, `group`, `mesh`: things and settings, resolved to plain data.

use std::sync::Arc;

use crate::base::fault::ValueFault;
use crate::base::limits;
use crate::base::origin::Origin;
use crate::lang::declare::setting_values::{filled, number, said, truth};
use crate::lang::declare::shares::Meshed;
use crate::lang::diag::span::Span;
use crate::lang::eval::coerce::flatten_into;
use crate::lang::eval::context::Cx;
use crate::lang::eval::faults::member_name;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::eval::room::flat_len;
use crate::lang::eval::scene::each_once;
use crate::lang::eval::std::imprint::pieces;
use crate::lang::eval::unbound;
use crate::lang::syntax::ast;
use crate::lang::syntax::ast::{ClauseWord, Declaration, Expr, ExprId, For, Keyword, MeshClause};
use crate::lang::syntax::scopes::bound;
use crate::lang::values::origins::NO_MEMBER;
use crate::lang::values::part::Skin;
use crate::lang::values::plans::{MeshSpec, RefineSpec, RuleSpec};
use crate::lang::values::settings;
use crate::lang::values::value::{MeshValue, ShellValue, Value};

/// What stands behind the name of a `shell`, `group` or `mesh`.
#[derive(Clone, Copy)]
pub(crate) struct Contents<'a> {
    /// The things behind `of`.
    pub things: &'a [ExprId],
    pub settings: &'a [ast::SettingEntry],
    /// `on`, `near` and `in` of a mesh.
    pub clauses: &'a [MeshClause],
}

/// One member of the family of a collection; the collection itself when it is no family.
struct Member {
    name: Arc<str>,
    /// Its places in the family; `NO_MEMBER` where there is none.
    indices: [u32; 2],
    origin: Origin,
}

/// What a declaration of this keyword holds: in words, and as a test of a value.
fn members_of(keyword: Keyword) -> (&'static str, fn(&Value) -> bool) {
    match keyword {
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
                    | Value::Drawing(_)
            )
        }),
        Keyword::Export => {
            ("meshes, curves, surfaces or records", |v| !matches!(v, Value::None | Value::Module(_) | Value::Plane(_) | Value::Drawing(_)))
        }
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
                    | Value::Drawing(_)
            )
        }),
    }
}

impl Cx<'_> {
    /// The origin of an expression of the declaration being evaluated.
    pub(crate) fn origin_at(&mut self, expr: ExprId) -> Origin {
        self.machine.site.expr = expr;
        self.origin()
    }

    /// Evaluates a `shell`, `group` or `mesh`, or the list of them that its family makes.
    pub(crate) fn collection(
        &mut self,
        code: Code<'_>,
        declaration: &Declaration,
        family: &[For],
        contents: Contents<'_>,
    ) -> Result<Value, Halt> {
        let name = bound(declaration).map(|b| self.program.names.text(b.name).to_owned()).unwrap_or_default();
        let mut meshes: Vec<MeshSpec> = Vec::new();
        let base = self.machine.at(code.module).meshes.len();
        let keyword = declaration.keyword;
        let value = self.family(code, family, &mut |cx, indices| {
            let member = Member { name: member_name(&name, indices).into(), indices, origin: cx.own_origin(code, indices) };
            let mut gather = Gather::default();
            let things = gather.take(cx.things(code, contents.things, keyword));
            match keyword {
                Keyword::Shell => cx.shell(code, contents, member, things, gather),
                Keyword::Mesh => {
                    meshes.push(cx.mesh_spec(code, contents, member, things, gather)?);
                    let index = u32::try_from(base + meshes.len() - 1).unwrap_or(u32::MAX);
                    Ok(Value::Mesh(Arc::new(MeshValue::Declared { module: code.module, index })))
                }
                _ => {
                    gather.take(cx.settings(code, "group", &[], contents.settings));
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

    /// The shell of surfaces and shells; a list of shells when they are a part of several bodies.
    fn shell(
        &mut self,
        code: Code<'_>,
        contents: Contents<'_>,
        member: Member,
        things: Option<Vec<(Value, Origin)>>,
        mut gather: Gather,
    ) -> Result<Value, Halt> {
        let settings = gather.take(self.settings(code, "shell", settings::SHELL, contents.settings));
        gather.done()?;
        let settings = settings.unwrap_or_default();
        let Member { name, indices, origin } = member;
        let module = code.module;
        let mut snap = said(&settings, "snap", number);
        let flip = said(&settings, "flip", truth).is_some_and(|said| said.0);
        let skins = self.skins(code, contents.things)?;
        let imprinted = said(&settings, "imprint", truth).filter(|said| said.0);
        let mut imprint = imprinted.map(|said| said.1);
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
                let mut indices = indices;
                let free = indices.iter().position(|m| *m == NO_MEMBER).unwrap_or(1);
                indices[free] = k as u32;
                let origin = self.own_origin(code, indices);
                if let Some((_, origin)) = imprinted {
                    surfaces = pieces(self, surfaces, origin)?;
                }
                let name = format!("{name}[{k}]").into();
                shells.push(Value::Shell(Arc::new(ShellValue { name, module, origin, surfaces, snap, imprint, flip, body })));
            }
            return Ok(Value::list(shells));
        }
        if let Some((_, origin)) = imprinted {
            surfaces = pieces(self, surfaces, origin)?;
        }
        Ok(Value::Shell(Arc::new(ShellValue { name, module, origin, surfaces, snap, imprint, flip, body })))
    }

    /// What a mesh asks for: its things, settings, rules and refinements.
    fn mesh_spec(
        &mut self,
        code: Code<'_>,
        contents: Contents<'_>,
        member: Member,
        things: Option<Vec<(Value, Origin)>>,
        mut gather: Gather,
    ) -> Result<MeshSpec, Halt> {
        let settings = gather.take(self.settings(code, "mesh", settings::MESH, contents.settings));
        let (on, others): (Vec<&MeshClause>, Vec<_>) = contents.clauses.iter().partition(|c| c.word == ClauseWord::On);
        // Without things there is a fault already, or they are evaluated again.
        let diagonal = if things.is_none() { Some(1.0) } else { None };
        let things = things.unwrap_or_default();
        let mut meshed = Meshed { things: &things, said: contents.things, diagonal };
        let rules: Vec<RuleSpec> = on.into_iter().filter_map(|c| gather.take(self.rule(code, c, &mut meshed))).collect();
        let refines: Vec<RefineSpec> = others.into_iter().filter_map(|c| gather.take(self.refine(code, c, &mut meshed))).collect();
        gather.done()?;
        let mut settings = settings.unwrap_or_default();
        self.shares(code, &mut settings, &mut meshed)?;
        Ok(MeshSpec { name: member.name, origin: member.origin, things, settings: filled(&settings)?, rules, refines })
    }

    /// Things of a collection, nested lists flattened, each of a kind that may be there.
    pub(crate) fn things(&mut self, code: Code<'_>, things: &[ExprId], keyword: Keyword) -> Result<Vec<(Value, Origin)>, Halt> {
        self.things_for(code, things, keyword, unbound::keyword_word(keyword))
    }

    /// The same, with the word for what the things are for.
    pub(crate) fn things_for(
        &mut self,
        code: Code<'_>,
        things: &[ExprId],
        keyword: Keyword,
        word: &'static str,
    ) -> Result<Vec<(Value, Origin)>, Halt> {
        let (wanted, fits) = members_of(keyword);
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
        let found = self.things_for(code, things, Keyword::Group, "rule")?;
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
