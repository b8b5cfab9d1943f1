//! Meshes: plain arrays, quality, and files.

use std::path::Path;
use std::sync::Arc;

use super::error::Error;
use super::names::{Names, Speaker};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::io::{Deck, Loss, Options, format_for};
use crate::lang::values::units::{LengthUnit, length_unit};
use crate::mesh;
use crate::session::disk::{plain, write_whole};
use crate::session::export::in_file;
use crate::session::report::DiagnosticRow;

/// Nodes and elements. Cheap to clone.
///
/// Nodes are numbered from 0; corners of an element run counter-clockwise seen against the normal. Elements of one face stand together.
#[derive(Clone, Debug)]
pub struct Mesh {
    mesh: Arc<mesh::Mesh>,
    tolerance: Tolerance,
    unit: LengthUnit,
    /// Names of the groups that were asked for.
    groups: Vec<String>,
    notes: Vec<DiagnosticRow>,
}

impl Mesh {
    pub(super) fn new(
        mesh: Arc<mesh::Mesh>,
        tolerance: Tolerance,
        unit: LengthUnit,
        groups: Vec<String>,
        notes: Vec<DiagnosticRow>,
    ) -> Self {
        Self { mesh, tolerance, unit, groups, notes }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.mesh.name
    }

    /// Places of the nodes, model units; mid nodes of order 2 come after all corner nodes.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + '_ {
        self.mesh.nodes.iter().map(|p| p.to_array())
    }

    /// 1, or 2 for elements with mid nodes.
    pub fn order(&self) -> u8 {
        self.mesh.order
    }

    /// Corner nodes of the line elements.
    pub fn lines(&self) -> &[[u32; 2]] {
        &self.mesh.lines
    }

    /// Corner nodes of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.mesh.triangles
    }

    /// Corner nodes of the quads.
    pub fn quads(&self) -> &[[u32; 4]] {
        &self.mesh.quads
    }

    /// Order 2: the mid node of each line.
    pub fn line_mids(&self) -> &[u32] {
        &self.mesh.line_mids
    }

    /// Order 2: the mid nodes of each triangle, after corners 0, 1, 2.
    pub fn triangle_mids(&self) -> &[[u32; 3]] {
        &self.mesh.triangle_mids
    }

    /// Order 2: the mid nodes of each quad, after corners 0, 1, 2, 3.
    pub fn quad_mids(&self) -> &[[u32; 4]] {
        &self.mesh.quad_mids
    }

    /// The named sets: one for each surface, then those of groups.
    pub fn groups(&self) -> &[mesh::Group] {
        &self.mesh.groups
    }

    /// The set of a name.
    pub fn group(&self, name: &str) -> Option<&mesh::Group> {
        self.mesh.groups.iter().find(|group| group.name == name)
    }

    /// Angles (radians), quality and area of its elements; `None` without faces.
    pub fn quality(&self) -> Option<mesh::Quality> {
        self.mesh.quality()
    }

    /// Largest distance between faces and their surfaces, model units; `None` without faces.
    pub fn chord_error(&self) -> Option<f64> {
        self.mesh.chord_error(&self.tolerance)
    }

    /// Whether every edge has an element on either side.
    pub fn is_watertight(&self) -> bool {
        self.mesh.is_watertight()
    }

    /// Warnings and notes of a mesh made by a plan. Those of a script stand with the model.
    pub fn diagnostics(&self) -> &[DiagnosticRow] {
        &self.notes
    }

    /// Writes it in the format of the file's ending: `.stl`, `.obj`, `.ply`, `.vtu`, `.msh`, `.inp`, `.bdf`, `.glb` (in metres),
    /// `.3mf` (in millimetres, closed bodies alone). The file is there whole or not at all. Gives what the format cannot hold, as warnings.
    ///
    /// Fails with E804 or E805 where the ending chooses no format of meshes or the format cannot hold this one, E808 where the file cannot
    /// be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<Vec<DiagnosticRow>, Error> {
        let path = path.as_ref();
        let shown = path.to_string_lossy();
        let (bytes, notes) = self.encoded(&shown)?;
        write_whole(path, &bytes).map_err(|error| Error::new("E808", format!("cannot write \"{shown}\": {}", plain(&error))))?;
        Ok(notes)
    }

    /// The bytes of the file that [`Mesh::write`] would write under this name.
    ///
    /// Fails with E804 or E805 as [`Mesh::write`].
    pub fn to_bytes(&self, name: &str) -> Result<Vec<u8>, Error> {
        Ok(self.encoded(name)?.0)
    }

    fn encoded(&self, name: &str) -> Result<(Vec<u8>, Vec<DiagnosticRow>), Error> {
        let names = Names::default();
        let say = Speaker { names: &names, unit: Some(self.unit), tolerance: Some(self.tolerance) };
        let failed = |fault: crate::io::files::fault::FormatFault| Error::of_fault(&fault.into(), &say);
        let format = format_for(Origin::NONE, name).map_err(failed)?;
        let (unit, units_per_file_unit) = in_file(format.unit.and_then(length_unit).unwrap_or(self.unit), self.unit);
        let options = Options { groups: self.groups.clone(), units_per_file_unit, ..Options::default() };
        let deck = Deck { mesh: &self.mesh, unit, options: &options };
        format.check(Origin::NONE, &deck).map_err(failed)?;
        let mut bytes = Vec::new();
        let losses = (format.write)(&deck, &mut bytes).map_err(|error| Error::new("E808", plain(&error)))?;
        let notes = Loss::faults(&losses, Origin::NONE, name);
        Ok((bytes, notes.into_iter().map(|fault| super::error::row(&fault.into(), &say)).collect()))
    }
}
