//! What the file of an imported part says of its faces and bodies.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::base::origin::Origin;
use crate::lang::eval::context::Cx;
use crate::lang::eval::module::State;
use crate::lang::values::origins::{NO_MEMBER, OriginEntry};
use crate::lang::values::part::{PartFile, PartValue, SurfaceProperties};
use crate::lang::values::value::{ShellValue, Value};
use crate::surface::Surface;

impl Cx<'_> {
    /// The part that a face was imported with, and its number there.
    fn part_of(&self, face: &Surface) -> Option<(&Arc<PartValue>, usize)> {
        let OriginEntry { module, declaration, member, .. } = self.program.origins.place(face.origin())?;
        let [face, NO_MEMBER] = member else { return None };
        let State::Done(value) = self.machine.modules.get(module.index())?.states.get(declaration as usize)? else { return None };
        value.part().map(|part| (part, face as usize))
    }

    /// What a file says of a face that was imported.
    pub fn said_of(&self, face: &Surface) -> Option<&SurfaceProperties> {
        self.part_of(face).and_then(|(part, face)| part.file.said.get(face))
    }

    /// The name of a face in the file that it was imported from, where it has one there.
    pub fn name_in_file(&self, face: &Surface) -> Option<String> {
        self.said_of(face)?.own.as_deref().map(str::to_owned)
    }

    /// The file of an imported assembly that a face comes from, and the product of it at its place.
    pub fn node_of(&self, face: &Surface) -> Option<(&Arc<PartFile>, usize)> {
        let (part, face) = self.part_of(face)?;
        Some((&part.file, part.file.said.get(face)?.node?))
    }

    /// The names that a file has for a body, as imported or moved: as it stands there, and that of which there is one only.
    pub fn body_said(&self, shell: &ShellValue) -> Option<&[Arc<str>; 2]> {
        let (part, _) = self.part_of(shell.surfaces.first()?)?;
        part.file.bodies.get(&*shell.name)
    }

    /// Whether a shell is a body of a file as it came in, under no name of the script.
    pub fn is_body(&self, shell: &ShellValue) -> bool {
        let part = shell.surfaces.first().and_then(|face| self.part_of(face));
        part.is_some_and(|(part, _)| part.bodies.iter().any(|body| body.name == shell.name))
    }

    /// A part, or a body of one, that lacks faces while all others of it are among these surfaces.
    pub fn lacking(&self, surfaces: &[Surface]) -> Option<Arc<PartValue>> {
        let held: BTreeSet<Origin> = surfaces.iter().map(Surface::origin).collect();
        let all_of = |part: &&Arc<PartValue>| {
            !part.unusable.is_empty() && !part.faces.is_empty() && part.faces.iter().all(|face| held.contains(&face.origin()))
        };
        let states = self.machine.modules.iter().flat_map(|module| &module.states);
        let imports = states.filter_map(|state| if let State::Done(Value::Record(record)) = state { Some(record) } else { None });
        for record in imports.filter(|record| record.part.as_ref().is_some_and(|part| !part.unusable.is_empty())) {
            let bodies =
                record.values.iter().filter_map(|v| if let Value::List(items) = v { Some(items) } else { None }).flat_map(|v| v.iter());
            let found = record.part.iter().chain(bodies.filter_map(Value::part)).find(all_of);
            if let Some(part) = found {
                return Some(part.clone());
            }
        }
        None
    }
}
