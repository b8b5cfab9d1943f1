//! From kernel faults to diagnostics: names, quantities and spans.

use glam::DVec3;

use crate::base::fault::{Fault, Say, Subject};
use crate::base::origin::Origin;
use crate::lang::diag::diagnostic::{Diagnostic, FileId, Label};
use crate::lang::diag::span::Span;
use crate::lang::eval::bind::Blame;
use crate::lang::eval::context::Cx;
use crate::lang::eval::machine::Code;
use crate::lang::syntax::ast::{DeclarationKind, ExprId};
use crate::lang::syntax::scopes::bound;
use crate::lang::values::origins::{NO_MEMBER, OriginEntry};
use crate::lang::values::value::ModuleId;

/// Longest source text that stands for the name of a nameless entity.
const NAME_CHARACTERS: usize = 40;

/// Speaks of entities by their declared names and of quantities in model units.
impl Say for Cx<'_> {
    fn name(&self, origin: Origin) -> String {
        let Some(place) = self.program.origins.place(origin) else { return String::new() };
        let outer = self.outermost(place);
        let module = self.machine.at(outer.module);
        let declaration = module.script.declarations.whole(outer.declaration as usize);
        let is_root = match outer.expr {
            None => true,
            Some(expr) => matches!(&declaration.kind, DeclarationKind::Value { value, .. } if *value == expr),
        };
        if let (DeclarationKind::Load { bound, .. }, [face, NO_MEMBER]) = (&declaration.kind, outer.member)
            && face != NO_MEMBER
        {
            return format!("{}.faces[{face}]", self.program.names.text(bound.name));
        }
        if is_root && let Some(b) = bound(&declaration) {
            return member_name(self.program.names.text(b.name), outer.member);
        }
        let text =
            outer.expr.and_then(|e| declaration.nodes.get(e.index())).map(|n| self.program.sources.text(module.file, n.span)).unwrap_or("");
        let short = text.chars().count() <= NAME_CHARACTERS && !text.contains(['\n', '`']);
        if short { text.to_owned() } else { String::new() }
    }

    fn length(&self, length: f64) -> String {
        let (text, unit) = crate::lang::values::units::told_length(length, self.unit());
        format!("{text} {}", unit.name)
    }

    fn points(&self, places: &[DVec3]) -> Vec<String> {
        crate::lang::values::places::place_texts(places, self.tolerance, self.unit())
    }

    fn angle(&self, radians: f64) -> String {
        crate::lang::values::units::angle_text(radians)
    }
}

/// `ribs[2]`, `cells[1][3]`.
pub(crate) fn member_name(name: &str, member: [u32; 2]) -> String {
    let mut text = name.to_owned();
    for index in member.into_iter().filter(|i| *i != NO_MEMBER) {
        text.push_str(&format!("[{index}]"));
    }
    text
}

impl Cx<'_> {
    /// The call of the declaration's own expression that led to a place.
    pub(crate) fn outermost(&self, mut place: OriginEntry) -> OriginEntry {
        while let Some(caller) = self.program.origins.place(place.caller) {
            place = caller;
        }
        place
    }

    /// Where an entity was made: the innermost expression, and the calls that led there.
    pub fn span_of(&self, origin: Origin) -> Option<(FileId, Span)> {
        let place = self.program.origins.place(origin)?;
        let module = self.machine.at(place.module);
        let declaration = module.script.declarations.whole(place.declaration as usize);
        let span = match place.expr {
            Some(ExprId(u32::MAX)) => declaration.span,
            Some(expr) => declaration.nodes.get(expr.index())?.span,
            None => match &declaration.kind {
                DeclarationKind::Value { value, .. } => declaration.nodes.get(value.index())?.span,
                _ => bound(&declaration).map_or(declaration.span, |b| b.span),
            },
        };
        Some((module.file, span))
    }

    /// Says that no declaration is being evaluated any more: later faults are shown at their entities alone.
    pub fn leave(&mut self) {
        self.machine.site.module = crate::lang::values::value::ModuleId::MAIN;
        self.machine.site.declaration = u32::MAX;
    }

    /// A fault as a diagnostic; what has no place is shown at the call being made.
    pub fn diagnose(&self, fault: &Fault) -> Diagnostic {
        let site = self.machine.site;
        match self.machine.modules.get(site.module.index()) {
            Some(module) if (site.declaration as usize) < module.script.declarations.len() => {
                let declaration = module.script.declarations.whole(site.declaration as usize);
                let code = Code { nodes: &declaration.nodes, module: site.module, declaration: site.declaration };
                self.locate(fault, code, self.machine_span(code), &Blame::default())
            }
            _ => {
                let find = |subject| match subject {
                    Subject::Entity(origin) => self.span_of(origin),
                    _ => None,
                };
                Diagnostic::from_fault(fault, find, self)
            }
        }
    }

    /// A fault as a diagnostic with places: entities where they were made, arguments by `blame`, the rest at `span`.
    pub(crate) fn locate(&self, fault: &Fault, code: Code<'_>, span: Span, blame: &Blame) -> Diagnostic {
        let file = self.machine.at(code.module).file;
        let find = |subject| match subject {
            Subject::Entity(origin) => self.span_of(origin),
            Subject::Argument(name) => blame.whole.iter().find(|b| b.0 == name).map(|b| (file, b.1)).or(Some((file, span))),
            Subject::Item(name, k) => {
                let of = |list: &[(&'static str, Span)], k: usize| list.iter().filter(|b| b.0 == name).nth(k).map(|b| (file, b.1));
                of(&blame.items, k).or(of(&blame.whole, 0)).or(Some((file, span)))
            }
            Subject::Call => Some((file, span)),
        };
        let mut diagnostic = Diagnostic::from_fault(fault, find, self);
        let inside = self.machine.at(code.module).script.declarations.span(code.declaration as usize);
        let shown = |l: &Label| l.file == file && l.span.start >= inside.start && l.span.end <= inside.end;
        if !diagnostic.labels.iter().any(shown) {
            diagnostic.labels.push(Label { file, span, text: "asked for here".to_owned() });
        }
        self.add_calls(&mut diagnostic);
        diagnostic
    }

    /// The name of a declaration, or its source when it binds none.
    pub(crate) fn declaration_name(&self, module: ModuleId, index: u32) -> String {
        let m = self.machine.at(module);
        let name = match m.script.declarations.bound(index as usize) {
            Some(b) => self.program.names.text(b.name).to_owned(),
            None => self.program.sources.text(m.file, m.script.declarations.span(index as usize)).lines().next().unwrap_or("").to_owned(),
        };
        if m.label.is_empty() { name } else { format!("{}.{name}", m.label) }
    }
}
