//! Writing diagnostics while evaluating: place, labels, help, and the calls that led there.

use crate::lang::diag::diagnostic::{Diagnostic, FileId, Label};
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::machine::Code;

/// Calls shown above a failure.
const CALLS_SHOWN: usize = 3;

/// A diagnostic being written; [`Draft::stop`] files it.
pub(crate) struct Draft<'a, 'w> {
    cx: &'a mut Cx<'w>,
    diagnostic: Diagnostic,
}

impl<'w> Cx<'w> {
    /// Begins a report at a place of the code being run; the calls that led there are added.
    pub(crate) fn error(
        &mut self,
        code: Code<'_>,
        error: &'static str,
        message: impl Into<String>,
        span: Span,
        label: impl Into<String>,
    ) -> Draft<'_, 'w> {
        let file = self.machine.at(code.module).file;
        let mut diagnostic = Diagnostic::new(error, message, file, span, label);
        self.add_calls(&mut diagnostic);
        Draft { cx: self, diagnostic }
    }

    /// Adds "in `rib(…)` called here" for the calls being run, innermost first.
    pub(crate) fn add_calls(&self, diagnostic: &mut Diagnostic) {
        let mut shown: Vec<Label> = Vec::new();
        for frame in self.machine.calls.iter().rev() {
            let module = self.machine.at(frame.site.module);
            let declaration = module.script.declarations.whole(frame.site.declaration as usize);
            let Some(node) = declaration.nodes.get(frame.site.expr.index()) else { continue };
            let text = format!("in `{}(…)` called here", self.program.names.text(frame.name));
            let label = Label { file: module.file, span: node.span, text };
            let outermost = frame.site.module == self.machine.running.last().map_or(frame.site.module, |r| r.0)
                && Some(frame.site.declaration) == self.machine.running.last().map(|r| r.1);
            let known = diagnostic.labels.iter().chain(&shown).any(|l| l.file == label.file && l.span == label.span);
            if !known && (shown.len() < CALLS_SHOWN || outermost) {
                shown.push(label);
            }
        }
        diagnostic.labels.extend(shown);
        if self.machine.calls.len() > CALLS_SHOWN {
            diagnostic.notes.push(format!("{} calls inside each other", self.machine.calls.len()));
        }
    }
}

impl Draft<'_, '_> {
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.diagnostic.help = Some(text.into());
        self
    }

    /// With help that is this text in the place of that stretch, in the same file.
    pub fn put(mut self, span: Span, text: impl Into<String>) -> Self {
        self.diagnostic = self.diagnostic.put(span, text);
        self
    }

    /// The same where such a text is known.
    pub fn puts(self, span: Span, text: Option<String>) -> Self {
        match text {
            Some(text) => self.put(span, text),
            None => self,
        }
    }

    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.diagnostic.notes.push(text.into());
        self
    }

    /// With a note where there is one.
    pub fn notes(self, text: Option<String>) -> Self {
        match text {
            Some(text) => self.note(text),
            None => self,
        }
    }

    /// With these ways of typing it, all of them help.
    pub fn ways(self, span: Span, ways: &[String]) -> Self {
        let help: Vec<String> = ways.iter().map(|way| format!("`{way}`")).collect();
        let draft = self.help(help.join(" or "));
        ways.iter().fold(draft, |draft, way| draft.put(span, way))
    }

    /// With where the numbers of the value at the foremost label come from.
    pub fn came_from(mut self, code: Code<'_>) -> Self {
        let label = self.diagnostic.labels.first().map(|l| l.span);
        self.diagnostic.notes.extend(label.into_iter().flat_map(|span| self.cx.came_from(code, span)));
        self
    }

    /// One more label in the same file.
    pub fn and(mut self, span: Span, text: impl Into<String>) -> Self {
        let file = self.diagnostic.labels.first().map_or(FileId(0), |l| l.file);
        self.diagnostic.labels.insert(1.min(self.diagnostic.labels.len()), Label { file, span, text: text.into() });
        self
    }

    pub fn labels(mut self, labels: impl IntoIterator<Item = Label>) -> Self {
        self.diagnostic.labels.extend(labels);
        self
    }

    /// The unit of the run.
    pub fn unit(&self) -> crate::lang::values::units::LengthUnit {
        self.cx.program.unit
    }

    /// Files it and gives the reason to stop.
    pub fn stop(self) -> Halt {
        self.cx.sink.reports.push(self.diagnostic);
        Halt::Failed
    }

    /// Files it; evaluation goes on (warnings).
    pub fn say(self) {
        self.cx.sink.reports.push(self.diagnostic);
    }
}
