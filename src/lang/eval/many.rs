//! Declarations of one thing that are given a list: the declarations that hold many.

use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::machine::Code;
use crate::lang::syntax::ast::{Clause, DeclarationKind, Expr, ExprId};

impl Cx<'_> {
    /// For `curve a = [for k in list: one]` the family `curve a for k in list = one`, for any other list `let a = …`, with the
    /// place of the declaration and its short form for a message; `None` where the list is not the value of a whole declaration.
    pub(crate) fn as_many(&self, code: Code<'_>, id: ExprId) -> Option<(Span, String, String)> {
        let declaration = self.machine.at(code.module).script.declarations.whole(code.declaration as usize);
        let DeclarationKind::Value { bound, family, value } = &declaration.kind else { return None };
        if *value != id || !family.is_empty() {
            return None;
        }
        let name = self.program.names.text(bound.name);
        let span = Span { start: declaration.keyword_span.start, ..declaration.span };
        let as_list = || Some((span, format!("let {name} = …"), format!("let {name} = {}", self.source(code, id))));
        let Expr::Comprehension { clauses, body } = code.expr(id) else { return as_list() };
        let keyword = self.program.sources.text(self.machine.at(code.module).file, declaration.keyword_span);
        let (mut short, mut head) = (format!("{keyword} {name}"), format!("{keyword} {name}"));
        for clause in clauses {
            let Clause::For(each) = clause else { return as_list() };
            let each_name = self.program.names.text(each.name);
            short.push_str(&format!(" for {each_name} in …"));
            head.push_str(&format!(" for {each_name} in {}", self.source(code, each.list)));
        }
        let one = self.source(code, *body);
        let call = one.split_once('(').map_or("…".to_owned(), |(name, _)| format!("{name}(…)"));
        Some((span, format!("{short} = {call}"), format!("{head} = {one}")))
    }
}
