//! `near` and `in` clauses of a mesh: places where elements are smaller.

use crate::base::bbox::Box3;
use crate::base::origin::Origin;
use crate::lang::declare::setting_values::filled;
use crate::lang::declare::shares::Meshed;
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::syntax::ast::{ClauseWord, ExprId, Keyword, MeshClause};
use crate::lang::values::plans::RefineSpec;
use crate::lang::values::settings;
use crate::lang::values::types::Ty;
use crate::lang::values::value::Value;
use crate::mesh::request::settings::{BoxSettings, NearSettings};

impl Cx<'_> {
    /// `near points, curves { … }` or `in box { … }`.
    pub(crate) fn refine(&mut self, code: Code<'_>, clause: &MeshClause, meshed: &mut Meshed<'_>) -> Result<RefineSpec, Halt> {
        let mut gather = Gather::default();
        let (word, table) = if clause.word == ClauseWord::Near { ("near", settings::NEAR) } else { ("in", settings::IN) };
        let (mut things, mut boxes) = (Vec::new(), Vec::new());
        if clause.word == ClauseWord::Near {
            things = gather.take(self.near_things(code, &clause.things)).unwrap_or_default();
        } else {
            boxes = gather.take(self.boxes(code, &clause.things)).unwrap_or_default();
        }
        let settings = gather.take(self.settings(code, word, table, &clause.settings));
        gather.done()?;
        let mut settings = settings.unwrap_or_default();
        self.shares(code, &mut settings, meshed)?;
        let (size, radius) = if clause.word == ClauseWord::Near {
            let near: NearSettings = filled(&settings)?;
            (near.size, near.radius())
        } else {
            (filled::<BoxSettings>(&settings)?.size, 0.0)
        };
        let Some(size) = size else {
            let span = Span { start: clause.span.start, end: clause.span.start + word.len() as u32 };
            let draft = self.error(code, "E301", format!("`{word}` needs `size`"), span, "`size` is missing");
            return Err(draft.help("say how long edges may be there: `{ size: 5mm }`").stop());
        };
        let origin = clause.things.first().map_or(Origin::NONE, |thing| self.origin_at(*thing));
        Ok(RefineSpec { things, boxes, size, radius, origin })
    }

    fn near_things(&mut self, code: Code<'_>, things: &[ExprId]) -> Result<Vec<(Value, Origin)>, Halt> {
        let found = self.things_for(code, things, Keyword::Group, "clause `near`")?;
        let fits = |v: &Value| {
            matches!(v, Value::Vector(..) | Value::Node(_) | Value::Vertex(..) | Value::Curve(_) | Value::Link(..) | Value::Edge(..))
        };
        let Some((value, origin)) = found.iter().find(|(v, _)| !fits(v)) else { return Ok(found) };
        let (kind, span) = (self.kind(value), self.span_of(*origin).map_or_else(Span::default, |s| s.1));
        let text = format!("`near` takes points and curves, got {kind}");
        Err(self.error(code, "E211", text, span, kind).stop())
    }

    /// Boxes as `box` and `bbox` give them: records with the points `min` and `max`.
    fn boxes(&mut self, code: Code<'_>, things: &[ExprId]) -> Result<Vec<Box3>, Halt> {
        let mut boxes = Vec::new();
        let (min, max) = (self.program.names.intern("min"), self.program.names.intern("max"));
        for &thing in things {
            let value = self.eval(code, thing)?;
            for value in self.flattened(code, thing, value)? {
                let corners = match &value {
                    Value::Record(record) => [min, max].map(|key| record.get(key).cloned()),
                    _ => [None, None],
                };
                let [Some(low), Some(high)] = corners else {
                    let kind = self.kind(&value);
                    let text = format!("`in` takes boxes, got {kind}");
                    return Err(self.error(code, "E211", text, code.span(thing), kind).help("in box((0, 0, 0), (1m, 1m, 1m))").stop());
                };
                let mut corner = |value: Value| {
                    let point = self.fit_expr(code, thing, value, Ty::Point, "a corner of the box")?;
                    self.as_vector(point)
                };
                let (a, b) = (corner(low)?.0, corner(high)?.0);
                boxes.push(Box3::of([a, b]));
            }
        }
        Ok(boxes)
    }
}
