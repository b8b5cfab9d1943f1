//! `size: 1%`: lengths of a mesh as shares of the diagonal of the box around what is meshed.

use crate::base::bbox::Box3;
use crate::base::origin::Origin;
use crate::lang::declare::setting_values::Resolved;
use crate::lang::diag::diagnostic::Label;
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::syntax::ast::ExprId;
use crate::lang::values::types::Ty;
use crate::lang::values::value::{Quantity, Value};
use crate::model::measure;
use crate::surface::{Surface, curve_bbox};

/// The things of a mesh, and the diagonal of the box around them once it was asked for.
pub(crate) struct Meshed<'t> {
    pub things: &'t [(Value, Origin)],
    /// What says them.
    pub said: &'t [ExprId],
    pub diagonal: Option<f64>,
}

impl Cx<'_> {
    /// Shares among settings as the lengths that they are.
    pub(crate) fn shares(&mut self, code: Code<'_>, settings: &mut [Resolved], meshed: &mut Meshed<'_>) -> Result<(), Halt> {
        for setting in settings.iter_mut().filter(|setting| setting.ty == Ty::Size) {
            let Value::Number(Quantity { value, percent: true, .. }) = setting.value else { continue };
            if meshed.things.is_empty() && meshed.diagonal.is_none() {
                return Err(self.share_of_none(code, setting, meshed.said));
            }
            let diagonal = match meshed.diagonal {
                Some(diagonal) => diagonal,
                None => self.box_around(meshed.things)?.diagonal(),
            };
            meshed.diagonal = Some(diagonal);
            if diagonal <= 0.0 || diagonal.is_nan() {
                let span = self.span_of(setting.origin).map_or_else(Span::default, |s| s.1);
                let text = format!("`{}` is a percentage of the diagonal of what is meshed, which is 0", setting.key);
                return Err(self.error(code, "E306", text, span, "a percentage of 0").stop());
            }
            setting.value = Value::length(value * diagonal);
        }
        Ok(())
    }

    /// E306: a share of what is meshed, where that is empty: names what chose nothing.
    fn share_of_none(&mut self, code: Code<'_>, setting: &Resolved, said: &[ExprId]) -> Halt {
        let file = self.machine.at(code.module).file;
        let (share, found) = (self.span_of(setting.origin), said.iter().map(|expr| code.span(*expr)).collect::<Vec<_>>());
        let span = found.first().copied().unwrap_or_default();
        let words = found.iter().map(|span| format!("`{}`", self.program.sources.text(file, *span))).collect::<Vec<_>>().join(" and ");
        let holds = if found.len() == 1 { "contains" } else { "contain" };
        let text = format!("`{}` is a percentage of the diagonal of what is meshed, and {words} {holds} nothing", setting.key);
        let draft = self.error(code, "E306", text, span, "is empty");
        let labels = found.iter().skip(1).map(|span| Label { file, span: *span, text: "so is this".to_owned() });
        let label = share.map(|(file, span)| Label { file, span, text: "a percentage of it".to_owned() });
        let help = "choose something that is not empty, or give a length";
        draft.labels(labels.chain(label)).help(help).stop()
    }

    /// The smallest box along the axes around all things of a mesh.
    fn box_around(&mut self, things: &[(Value, Origin)]) -> Result<Box3, Halt> {
        let (mut around, mut surfaces) = (Box3::EMPTY, Vec::<Surface>::new());
        for (thing, _) in things {
            match thing {
                Value::Surface(surface) => surfaces.push(surface.clone()),
                Value::Shell(shell) => surfaces.extend(shell.surfaces.iter().cloned()),
                Value::Curve(_) | Value::Link(..) => around = around.union(curve_bbox(&self.as_chain(thing.clone())?)),
                Value::Edge(home, edge) => {
                    let curve = crate::lang::eval::std::curve_of(self, crate::lang::eval::std::kinds::EdgeOf(home.clone(), edge.clone()))?;
                    around = around.union(curve_bbox(&curve));
                }
                place => around = around.with(self.as_vector(place.clone())?.0),
            }
        }
        Ok(if surfaces.is_empty() { around } else { around.union(measure::bounds(&surfaces)) })
    }
}
