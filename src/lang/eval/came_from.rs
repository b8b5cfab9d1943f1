//! Where the numbers of a refused value come from: `gap = pitch - wire = -1mm` (line 5), and the cell that a text stood in.

use std::sync::Arc;

use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::machine::Code;
use crate::lang::eval::module::State;
use crate::lang::syntax::ast::{Declaration, DeclarationKind, Expr, ExprId, Unary};
use crate::lang::values::value::{ModuleId, Value};
use crate::lang::words::names::Name;

/// Declarations told of.
const SHOWN: usize = 4;
/// Characters of the longest source that is quoted.
const SOURCE: usize = 60;

impl Cx<'_> {
    /// A line for each number that the expression at this place names, the declarations behind them included.
    pub(crate) fn came_from(&self, code: Code<'_>, span: Span) -> Vec<String> {
        let mut told: Vec<(Option<u32>, String)> = Vec::new();
        let names = names_inside(code.nodes.iter().map(|n| (&n.expr, n.span)), span);
        self.tell(code.module, &names, &mut told, true);
        told.into_iter().map(|t| t.1).collect()
    }

    fn tell(&self, module: ModuleId, names: &[Name], told: &mut Vec<(Option<u32>, String)>, locals: bool) {
        for &name in names {
            if told.len() >= SHOWN {
                return;
            }
            let text = self.program.names.text(name);
            let local = self.machine.locals[self.machine.base..].iter().rev().find(|l| l.0 == name).filter(|_| locals);
            if let Some((_, Value::Number(q))) = local {
                told.push((None, format!("`{text} = {}`", crate::lang::values::units::in_words(*q, self.program.unit))));
            }
            let m = self.machine.at(module);
            let Some(index) = m.find(name).filter(|i| local.is_none() && !told.iter().any(|t| t.0 == Some(*i))) else { continue };
            let State::Done(Value::Number(q)) = &m.states[index as usize] else { continue };
            let declaration: &Declaration = &m.script.declarations.whole(index as usize);
            let Some((at, name_span)) = value_of(declaration) else { continue };
            let node = &declaration.nodes[at.index()];
            let (source, value) =
                (self.program.sources.text(m.file, node.span), crate::lang::values::units::in_words(*q, self.program.unit));
            let line = self.program.sources.place(m.file, name_span.start).map_or(1, |p| p.line);
            let short = source.chars().count() <= SOURCE && !source.contains(['\n', '`']);
            let words = if is_literal(declaration, at) || !short {
                format!("`{text} = {value}`")
            } else {
                format!("`{text} = {source} = {value}`")
            };
            told.push((Some(index), format!("{words} (line {line})")));
            let inner = names_inside(declaration.nodes.iter().map(|n| (&n.expr, n.span)), node.span);
            self.tell(module, &inner, told, false);
        }
    }

    /// Where a text stands in an imported table: "row 2, column `x` of "offsets.csv" holds "12,5"".
    pub(crate) fn cell_of(&self, text: &Arc<str>) -> Option<String> {
        for (m, module) in self.machine.modules.iter().enumerate() {
            for (at, state) in module.states.iter().enumerate() {
                let State::Done(Value::Table(table)) = state else { continue };
                let declaration = module.script.declarations.whole(at);
                let DeclarationKind::Load { path, .. } = &declaration.kind else { continue };
                for (i, row) in table.rows.iter().enumerate() {
                    let found = (0..row.len().unwrap_or(0)).find(|&k| matches!(row.item(k), Some(Value::Text(t)) if Arc::ptr_eq(&t, text)));
                    let Some(k) = found else { continue };
                    let file = self.program.sources.text(self.machine.at(ModuleId::at(m)).file, declaration.nodes[path.index()].span);
                    let column =
                        table.keys.get(k).map_or_else(|| (k + 1).to_string(), |key| format!("`{}`", self.program.names.text(*key)));
                    return Some(format!("row {} (`.rows[{i}]`), column {column} of {file} holds \"{text}\"", i + 1));
                }
            }
        }
        None
    }
}

/// The expression that gives a declared name its value, and where the name stands.
fn value_of(declaration: &Declaration) -> Option<(ExprId, Span)> {
    match &declaration.kind {
        DeclarationKind::Param { value, bound, .. } => Some((*value, bound.span)),
        DeclarationKind::Value { value, bound, .. } => Some((*value, bound.span)),
        _ => None,
    }
}

fn is_literal(declaration: &Declaration, id: ExprId) -> bool {
    match &declaration.nodes[id.index()].expr {
        Expr::Number(_) | Expr::Quantity(..) => true,
        Expr::Unary(Unary::Minus, of) => is_literal(declaration, *of),
        _ => false,
    }
}

/// Names used as values inside a stretch, each once.
fn names_inside<'n>(nodes: impl Iterator<Item = (&'n Expr, Span)>, inside: Span) -> Vec<Name> {
    let mut names: Vec<(u32, Name)> = nodes
        .filter_map(|(expr, span)| match expr {
            Expr::Name(name) if span.start >= inside.start && span.end <= inside.end => Some((span.start, *name)),
            _ => None,
        })
        .collect();
    names.sort_by_key(|n| n.0);
    let mut once = Vec::new();
    for (_, name) in names {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    once
}
