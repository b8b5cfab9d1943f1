//! What matched to a `Shape`.

use crate::lang::diag::span::Span;
use crate::lang::syntax::Rule;
use crate::lang::syntax::ast::*;
use crate::lang::syntax::matching::Pair;
use crate::lang::syntax::mistake::Refused;
use crate::lang::syntax::scan::Tokens;
use crate::lang::syntax::shape::Shape;
use crate::lang::syntax::token::Kind;
use crate::lang::words::names::Name;

pub(crate) type Result<T> = std::result::Result<T, Refused>;

/// Builds the shape of one declaration.
pub(crate) struct Builder<'a> {
    pub tokens: &'a Tokens,
    pub base: usize,
    pub nodes: Vec<Node>,
    pub stretches: Vec<Vec<u32>>,
}

/// The shape of the declaration in tokens `base..end`, from the rule that matched it.
pub(crate) fn build(declaration: Pair<'_>, tokens: &Tokens, base: usize, end: usize) -> Result<Shape> {
    let mut builder = Builder { tokens, base, nodes: Vec::new(), stretches: Vec::new() };
    let kind = builder.declaration(declaration)?;
    let keyword = tokens.kinds[base].keyword().ok_or_else(|| Refused::whole("no keyword", 0, 0))?;
    let keyword_end = u32::from(keyword == Keyword::ModelingCurve);
    let span = Span { start: 0, end: (end - base - 1) as u32 };
    let keyword_span = Span { start: 0, end: keyword_end };
    let declaration = Declaration { keyword, span, keyword_span, doc: None, kind, nodes: builder.nodes };
    let powers = tokens.kinds[base..end].windows(3).enumerate();
    let powers = powers.filter(|(_, w)| **w == [Kind::Quantity, Kind::Caret, Kind::Number]).map(|(at, _)| at as u32).collect();
    Ok(Shape::new(declaration, builder.stretches.concat(), powers))
}

impl Builder<'_> {
    /// First and last token of a pair.
    pub fn extent(&self, pair: &Pair<'_>) -> Span {
        pair.extent()
    }

    pub fn kind(&self, token: u32) -> Kind {
        self.tokens.kinds[self.base + token as usize]
    }

    pub fn node(&mut self, span: Span, expr: Expr) -> ExprId {
        self.nodes.push(Node { span, expr });
        ExprId::at(self.nodes.len() - 1)
    }

    pub(crate) fn name(&self, pair: &Pair<'_>) -> (Name, Span) {
        let span = self.extent(pair);
        (Name(span.start), span)
    }

    fn bound(&self, pair: &Pair<'_>) -> Bound {
        let (name, span) = self.name(pair);
        Bound { name, span }
    }

    // ---- declarations

    fn declaration(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        match pair.as_rule() {
            Rule::units => Ok(DeclarationKind::Units(self.only_bound(pair, Rule::unit_name)?)),
            Rule::tolerance => Ok(DeclarationKind::Tolerance(self.exprs(pair)?)),
            Rule::snap => self.exprs(pair).map(|values| DeclarationKind::Snap(values[0])),
            Rule::load => self.load(pair),
            Rule::param => self.param(pair),
            Rule::fn_ => self.function(pair),
            Rule::value => self.value(pair),
            Rule::holder | Rule::mesh => self.collection(pair),
            _ => self.output(pair),
        }
    }

    pub(crate) fn only_bound(&self, pair: Pair<'_>, rule: Rule) -> Result<Bound> {
        let found = pair.into_inner().find(|p| p.as_rule() == rule);
        found.map(|p| self.bound(&p)).ok_or_else(|| Refused::whole("a name is missing", 0, 0))
    }

    /// All expressions that stand directly in a pair.
    pub(crate) fn exprs(&mut self, pair: Pair<'_>) -> Result<Vec<ExprId>> {
        pair.into_inner().filter(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p)).collect()
    }

    fn load(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut path, mut args) = (ExprId(0), Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::string => path = self.string(part)?,
                Rule::args => args = self.args(part)?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Load { path, args, bound })
    }

    fn param(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut ty, mut value, mut allowed) = (None, ExprId(0), None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::type_ => ty = Some(self.ty(part)),
                Rule::expr => value = self.expr(part)?,
                Rule::choices => allowed = Some(Allowed::Choices(self.exprs(part)?)),
                Rule::bounds => {
                    let ends = self.exprs(part)?;
                    allowed = Some(Allowed::Range(ends[0], ends[1]));
                }
                _ => {}
            }
        }
        Ok(DeclarationKind::Param { bound, ty, value, allowed })
    }

    fn ty(&self, pair: Pair<'_>) -> TypeName {
        let span = self.extent(&pair);
        let (mut lists, mut inner) = (0u8, pair);
        loop {
            let part = inner.into_inner().find(|p| matches!(p.as_rule(), Rule::type_ | Rule::word));
            match part {
                Some(part) if part.as_rule() == Rule::type_ => {
                    lists = lists.saturating_add(1);
                    inner = part;
                }
                Some(word) => return TypeName { name: self.name(&word).0, lists, span },
                None => return TypeName { name: Name(span.start), lists, span },
            }
        }
    }

    fn function(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut params, mut returns, mut body) = (Vec::new(), None, ExprId(0));
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::parameters => {
                    for one in part.into_inner().filter(|p| p.as_rule() == Rule::parameter) {
                        params.push(self.parameter(one)?);
                    }
                }
                Rule::type_ => returns = Some(self.ty(part)),
                Rule::expr => body = self.expr(part)?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Fn { bound, params, returns, body })
    }

    fn parameter(&mut self, pair: Pair<'_>) -> Result<FnParam> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut ty, mut default) = (None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::type_ => ty = Some(self.ty(part)),
                Rule::expr => default = Some(self.expr(part)?),
                _ => {}
            }
        }
        Ok(FnParam { bound, ty, default })
    }

    pub(crate) fn value(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut family, mut value) = (Vec::new(), ExprId(0));
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::for_clause => family.push(self.for_clause(part)?),
                Rule::expr => value = self.expr(part)?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Value { bound, family, value })
    }

    fn collection(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let bound = self.only_bound(pair, Rule::name)?;
        let (mut family, mut things, mut settings, mut clauses) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::for_clause => family.push(self.for_clause(part)?),
                Rule::things => things = self.exprs(part)?,
                Rule::settings | Rule::mesh_settings => self.block(part, &mut settings, &mut clauses)?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Collection { bound, family, things, settings, clauses })
    }

    fn block(&mut self, pair: Pair<'_>, settings: &mut Vec<SettingEntry>, clauses: &mut Vec<MeshClause>) -> Result<()> {
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::setting => settings.push(self.setting(part)?),
                Rule::clause => clauses.push(self.clause(part)?),
                _ => {}
            }
        }
        Ok(())
    }

    pub(crate) fn setting(&mut self, pair: Pair<'_>) -> Result<SettingEntry> {
        let Bound { name: key, span: key_span } = self.only_bound(pair, Rule::word)?;
        let value = self.exprs(pair)?[0];
        Ok(SettingEntry { key, key_span, value })
    }

    fn clause(&mut self, pair: Pair<'_>) -> Result<MeshClause> {
        let span = self.extent(&pair);
        let word = match self.kind(span.start) {
            Kind::On => ClauseWord::On,
            Kind::Near => ClauseWord::Near,
            _ => ClauseWord::In,
        };
        let (mut things, mut settings) = (Vec::new(), Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::things => things = self.exprs(part)?,
                Rule::settings => self.block(part, &mut settings, &mut Vec::new())?,
                _ => {}
            }
        }
        Ok(MeshClause { word, span, things, settings })
    }

    fn output(&mut self, pair: Pair<'_>) -> Result<DeclarationKind> {
        let (mut label, mut things, mut family, mut to, mut settings) = (None, Vec::new(), Vec::new(), None, Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::label => {
                    if let Some(string) = part.into_inner().next() {
                        label = Some(self.string(string)?);
                    }
                }
                Rule::expr => things.push(self.expr(part)?),
                Rule::things => things = self.exprs(part)?,
                Rule::for_clause => family.push(self.for_clause(part)?),
                Rule::string => to = Some(self.string(part)?),
                Rule::settings => self.block(part, &mut settings, &mut Vec::new())?,
                _ => {}
            }
        }
        Ok(DeclarationKind::Output { label, things, family, to, settings })
    }

    // ---- expressions
}
