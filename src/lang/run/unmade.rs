//! What a run did not make: declarations that failed, and those that wait for them.

use crate::lang::diag::diagnostic::FileId;
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::module::{Stage, State};
use crate::lang::values::value::ModuleId;

/// Something that was not made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unmade {
    /// Its name; of what has none its text.
    pub name: String,
    /// The word that declares it; empty where its declaration was not read.
    pub what: String,
    /// Its script.
    pub file: FileId,
    /// Its declaration.
    pub span: Span,
    /// Why.
    pub why: Why,
}

/// Why something was not made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    /// It is wrong itself.
    Failed,
    /// It depends on this one, which failed.
    Waits(String),
    /// It uses something that could not be read, or a network or model that failed.
    Unread,
}

impl Cx<'_> {
    /// What was not made, in order of the scripts and of their declarations. A check that does not hold was made.
    pub fn unmade(&self) -> Vec<Unmade> {
        let mut out: Vec<Unmade> = Vec::new();
        for (m, module) in self.machine.modules.iter().enumerate() {
            let own = ModuleId::at(m);
            let waits = |(of, d): (ModuleId, u32)| Why::Waits(self.declaration_name(of, d));
            let mut here: Vec<Unmade> = Vec::new();
            for broken in &module.script.broken {
                let name = self.program.names.text(broken.name).to_owned();
                here.push(Unmade { name, what: String::new(), file: module.file, span: broken.span, why: Why::Failed });
            }
            let declarations = &module.script.declarations;
            for (i, state) in module.states.iter().enumerate() {
                let why = match state {
                    State::Failed if module.checks.iter().any(|check| check.0 == i as u32) => continue,
                    State::Failed => Why::Failed,
                    State::Skipped(of, d) => waits((*of, *d)),
                    State::Broken => Why::Unread,
                    State::Waiting | State::Running | State::Suspended | State::Done(_) => continue,
                };
                let what = self.program.sources.text(module.file, declarations.keyword_span(i)).to_owned();
                let name = self.declaration_name(own, i as u32);
                let name = if declarations.bound(i).is_some() { name } else { unworded(&name, &what) };
                here.push(Unmade { name, what, file: module.file, span: declarations.span(i), why });
            }
            for (spec, stage) in module.meshes.iter().zip(&module.mesh_stages) {
                let why = match stage {
                    Stage::Failed => Why::Failed,
                    Stage::Skipped(of, d) => waits((*of, *d)),
                    Stage::Waiting | Stage::Running | Stage::Done(_) => continue,
                };
                let name = if module.label.is_empty() { spec.name.to_string() } else { format!("{}.{}", module.label, spec.name) };
                let span = self.span_of(spec.origin).filter(|(file, _)| *file == module.file).map_or_else(Span::default, |found| found.1);
                here.push(Unmade { name, what: "mesh".to_owned(), file: module.file, span, why });
            }
            here.sort_by_key(|unmade| unmade.span.start);
            out.extend(here);
        }
        out
    }
}

/// The first line of a declaration without the word that opens it.
fn unworded(text: &str, word: &str) -> String {
    text.strip_prefix(word).unwrap_or(text).trim().to_owned()
}
