//! Origins: which declaration and expression made an entity, and how faults find their places in the script.

use std::sync::Arc;

use super::diag::FileId;
use super::syntax::ast::{ExprId, Span};
use super::value::ModuleId;
use crate::base::origin::Origin;

/// Not a member of a family.
pub const NO_MEMBER: u32 = u32::MAX;

/// One entry: a declaration, the member of its family, an expression of it, and the call it was run by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Script.
    pub module: ModuleId,
    /// Declaration in it.
    pub declaration: u32,
    /// Indices of the family's member, [`NO_MEMBER`] where there is none.
    pub member: [u32; 2],
    /// Expression; `None` means the declaration itself.
    pub expr: Option<ExprId>,
    /// The call of a script's function that ran this.
    pub caller: Origin,
}

/// All origins of a run.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    places: Vec<Place>,
}

impl Origins {
    /// A new origin.
    pub fn add(&mut self, place: Place) -> Origin {
        self.places.push(place);
        Origin(u32::try_from(self.places.len()).unwrap_or(0))
    }

    /// The entry of an origin.
    pub fn place(&self, origin: Origin) -> Option<&Place> {
        self.places.get((origin.0 as usize).wrapping_sub(1))
    }
}

/// A text that diagnostics point into.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name as shown.
    pub name: String,
    /// The text.
    pub text: Arc<str>,
}

/// All texts of a run: the main script is 0.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<Source>,
}

impl Sources {
    /// Adds a text.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> FileId {
        self.files.push(Source { name: name.into(), text: text.into() });
        FileId::at(self.files.len() - 1)
    }

    /// A text by id.
    pub fn get(&self, file: FileId) -> Option<&Source> {
        self.files.get(file.index())
    }

    /// All of them in order.
    pub fn all(&self) -> &[Source] {
        &self.files
    }

    /// Line of a byte, counted from 1.
    pub fn line(&self, file: FileId, byte: u32) -> usize {
        self.get(file).map_or(1, |s| 1 + s.text.as_bytes().iter().take(byte as usize).filter(|b| **b == b'\n').count())
    }

    /// The stretch of a text.
    pub fn text(&self, file: FileId, span: Span) -> &str {
        self.get(file).and_then(|s| s.text.get(span.start as usize..span.end as usize)).unwrap_or("")
    }
}
