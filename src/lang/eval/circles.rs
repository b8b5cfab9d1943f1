//! Reports of declarations that need themselves.

use crate::lang::diag::diagnostic::Label;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;
use crate::lang::syntax::ast::{Expr, Keyword, Node};
use crate::lang::values::value::ModuleId;

/// Why a circle closes that no name closes.
const ALL: &str = "links, nodes, `network` and meshes depend on all curves and surfaces";

impl Cx<'_> {
    /// Reports a cycle once, with all its members.
    pub(crate) fn cycle(&mut self, module: ModuleId, index: u32) -> Halt {
        let from = self.machine.running.iter().rposition(|r| *r == (module, index)).unwrap_or(0);
        let members: Vec<(ModuleId, u32)> = self.machine.running[from..].to_vec();
        self.machine.in_cycle.extend(&members);
        let least = (0..members.len()).min_by_key(|k| members[*k]).unwrap_or(0);
        let members: Vec<(ModuleId, u32)> = members[least..].iter().chain(&members[..least]).copied().collect();
        let mut names: Vec<String> = members.iter().map(|&(m, d)| self.declaration_name(m, d)).collect();
        names.push(names[0].clone());
        let shown = if names.len() > 9 {
            format!("{} → … → {}", names[..4].join(" → "), names[names.len() - 1])
        } else {
            names.join(" → ")
        };
        let labels: Vec<Label> = members
            .iter()
            .take(4)
            .filter_map(|&(m, d)| {
                let module = self.machine.at(m);
                let b = module.script.declarations.bound(d as usize)?;
                Some(Label { file: module.file, span: b.span, text: format!("`{}` is declared here", self.program.names.text(b.name)) })
            })
            .collect();
        // The report stands where the last member names the first one again.
        let closing = members.last().copied().unwrap_or((module, index));
        let script = self.machine.at(closing.0).script.clone();
        let closed = script.declarations.whole(closing.1 as usize);
        let nodes = &closed.nodes;
        let code = Code { nodes, module: closing.0, declaration: closing.1 };
        let first = members.first().and_then(|f| self.machine.at(f.0).script.declarations.bound(f.1 as usize)).map(|b| b.name);
        let names_first = |node: &&Node| match node.expr {
            Expr::Name(name) | Expr::Call { name, .. } | Expr::Field { name, .. } => Some(name) == first,
            _ => false,
        };
        let span = nodes.iter().find(names_first).map_or(closed.span, |n| n.span);
        let through_all = self.machine.stages > 0;
        // Of a circle through all curves one can be taken out.
        let outside = members.iter().copied().find(|m| through_all && self.may_stay_out(*m)).map(|m| self.stay_out(m));
        let draft = self.error(code, "E203", format!("`{}` depends on itself: {shown}", names[0]), span, "the cycle closes here");
        let draft = draft.labels(labels);
        match (outside, through_all) {
            (Some(help), _) => draft.help(help).note(ALL).stop(),
            (None, true) => draft.note(ALL).stop(),
            (None, false) => draft.stop(),
        }
    }

    /// The declaration being evaluated that is itself one of these: nothing that asks for all of them can be its part.
    pub(crate) fn own_part(&self, module: ModuleId, keywords: &[Keyword]) -> Option<(ModuleId, u32)> {
        let script = &self.machine.at(module).script;
        let is_part = |&&(m, d): &&(ModuleId, u32)| m == module && keywords.contains(&script.declarations.keyword(d as usize));
        self.machine.running.iter().rev().find(is_part).copied()
    }

    /// Reports that `part`, one of all curves and surfaces, is made from all of them, at the expression that asks for all.
    pub(crate) fn circle_through_all(&mut self, part: (ModuleId, u32)) -> Halt {
        let from = self.machine.running.iter().position(|r| *r == part).unwrap_or(0);
        let members: Vec<(ModuleId, u32)> = self.machine.running[from..].to_vec();
        self.machine.in_cycle.extend(&members);
        let site = self.machine.site;
        let script = self.machine.at(site.module).script.clone();
        let declaration = script.declarations.whole(site.declaration as usize);
        let code = Code { nodes: &declaration.nodes, module: site.module, declaration: site.declaration };
        let span = self.machine_span(code);
        let names: Vec<String> = members.iter().map(|&(m, d)| self.declaration_name(m, d)).collect();
        let text = format!("`{}` depends on itself: {} → all curves and surfaces → {}", names[0], names.join(" → "), names[0]);
        let help = self.may_stay_out(part).then(|| self.stay_out(part));
        let keyword = self.machine.at(part.0).script.declarations.keyword_span(part.1 as usize);
        let here = part == (site.module, site.declaration);
        let file = self.machine.at(part.0).file;
        let named = (!here).then(|| Label { file, span: keyword, text: format!("`{}` is one of them", names[0]) });
        let draft = self.error(code, "E203", text, span, "this asks for all of them").labels(named).note(ALL);
        match help {
            Some(help) if here => draft.help(help).put(keyword, "let").stop(),
            Some(help) => draft.help(help).stop(),
            None => draft.stop(),
        }
    }

    /// Whether there is a declaration of the same thing that does not belong to all curves and surfaces.
    fn may_stay_out(&self, (module, index): (ModuleId, u32)) -> bool {
        matches!(self.machine.at(module).script.declarations.keyword(index as usize), Keyword::Curve | Keyword::Point)
    }

    fn stay_out(&self, (module, index): (ModuleId, u32)) -> String {
        let name = self.declaration_name(module, index);
        match self.machine.at(module).script.declarations.keyword(index as usize) {
            Keyword::Point => format!("`let {name} = …`: a `let` point does not belong to the network"),
            _ => format!("`let {name} = …`: a `let` curve does not belong to the network, so it may be made from all of it"),
        }
    }
}
