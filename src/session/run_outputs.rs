//! The files of a run: exports and pictures, written under temporary names.

use std::sync::Arc;

use super::export;
use super::picture_request;
use super::pictures;
use super::report::OutputRow;
use super::run::Run;
use super::store::Outputs;
use super::task::Wanted;
use crate::base::fault::ValueFault;
use crate::lang::eval::halt::Halt;
use crate::lang::values::value::{ModuleId, Value};
use crate::mesh::Mesh;

impl Run<'_> {
    /// Writes all outputs under temporary names.
    pub(super) fn write(&mut self) {
        for spec in self.cx.exports() {
            if self.cx.job.go_on().is_err() {
                return;
            }
            if self.is_barred(&spec.path) {
                continue;
            }
            let _phase = self.cx.job.phase(format!("writing {}", spec.path));
            let row = export::write(&mut self.cx, &spec, self.disk);
            self.written(row);
        }
        self.say_absent_groups();
        let model = self.model_name();
        for spec in self.cx.pictures() {
            if self.cx.job.go_on().is_err() {
                return;
            }
            if self.is_barred(&spec.path) {
                continue;
            }
            let _phase = self.cx.job.phase(format!("drawing {}", spec.path));
            let row = pictures::write(&mut self.cx, &spec, &model, self.disk, self.disk.outputs());
            self.written(row);
        }
    }

    /// W224: groups of which no mesh that is written holds anything.
    fn say_absent_groups(&mut self) {
        let exports = self.cx.exports();
        let values = exports.iter().flat_map(|spec| &spec.things);
        let mut meshes: Vec<Arc<Mesh>> = Vec::new();
        for value in values.filter_map(|(value, _)| if let Value::Mesh(mesh) = value { Some(mesh) } else { None }) {
            let mesh = self.cx.mesh(value);
            meshes.extend(self.take(mesh));
        }
        if meshes.is_empty() {
            return;
        }
        meshes.dedup_by(|a, b| Arc::ptr_eq(a, b));
        let groups = self.cx.groups(ModuleId::MAIN);
        for group in self.take(groups).unwrap_or_default() {
            let own = |mesh: &Arc<Mesh>| mesh.groups.iter().any(|g| *g.name == *group.name && !g.is_empty());
            if !group.value.is_empty() && !meshes.iter().any(own) {
                let mut names: Vec<String> = meshes.iter().map(|mesh| mesh.name.clone()).collect();
                names.dedup();
                let fault = ValueFault::NotMeshed { of: group.origin, group: group.name.to_string(), meshes: names };
                self.cx.say(&fault.into());
            }
        }
    }

    /// Whether an output would take the place of another one or of something that is read.
    fn is_barred(&self, path: &str) -> bool {
        !self.barred.is_empty() && self.disk.file_of(path).is_some_and(|file| self.barred.contains(&file))
    }

    fn written(&mut self, row: Result<OutputRow, Halt>) {
        let Some(mut row) = self.take(row) else { return };
        self.report.renamed.append(&mut row.renamed);
        self.unnamed.extend(row.unnamed.drain(..).map(|what| format!("\"{}\" does without {what}", row.path)));
        if self.disk.outputs() == Outputs::Written {
            row.place = self.disk.shown_place(&row.path);
            self.report.outputs.push(row);
        }
    }

    /// Files that the script asks for and that were not written.
    pub(super) fn unwritten(&self) -> Vec<String> {
        if self.task.picture.is_some() || self.light {
            return Vec::new();
        }
        let (exports, pictures) = (self.cx.exports(), self.cx.pictures());
        let all = exports.iter().map(|spec| &spec.path).chain(pictures.iter().map(|spec| &spec.path));
        let written = |path: &String| self.report.outputs.iter().any(|row| row.path == *path);
        all.filter(|path| !written(path)).map(|path| path.to_string()).collect()
    }

    /// The script's name without folder and ending.
    fn model_name(&self) -> String {
        let name = std::path::Path::new(self.task.name).file_stem().unwrap_or_default().to_string_lossy();
        if name == "-" { "model".to_owned() } else { name.into_owned() }
    }

    /// The one picture that was asked for.
    pub(super) fn picture(&mut self, wanted: &Wanted) {
        if self.cx.job.go_on().is_err() || self.said.is_some() {
            return;
        }
        let model = self.model_name();
        let _phase = self.cx.job.phase(format!("drawing {}", wanted.spec.path));
        match picture_request::request(&mut self.cx, wanted) {
            Ok(spec) => {
                let row = pictures::write(&mut self.cx, &spec, &model, self.disk, self.disk.outputs());
                self.written(row);
            }
            Err(message) => self.said = Some(*message),
        }
    }
}
