//! Faces along a profile of lines and arcs, cut where its pieces meet: each part then has a form that files know by name.

use std::collections::BTreeMap;

use crate::base::job::Job;
use crate::base::tolerance::Tolerance;
use crate::io::cad::bodies::Faces;
use crate::io::cad::defect::Defect;
use crate::model::{Lines, Model, Shell, SurfaceId};

impl Faces {
    /// The same faces in a model of their own, in which they are cut, and which of them are; `None` where none is to be cut. Each part
    /// has the name, colour and layers of its face.
    pub(super) fn in_pieces(&self, tolerance: &Tolerance) -> Result<Option<(Self, Vec<SurfaceId>)>, Defect> {
        let listed = &self.shell.surfaces;
        let cut = |(k, (id, _)): (usize, &(SurfaceId, bool))| {
            let v = self.model.surfaces[id.index()].surface.form_joints(tolerance);
            (!v.is_empty()).then(|| (SurfaceId::at(k), Lines { u: Vec::new(), v }))
        };
        let lines: Vec<(SurfaceId, Lines)> = listed.iter().enumerate().filter_map(cut).collect();
        if lines.is_empty() {
            return Ok(None);
        }
        let surfaces = listed.iter().map(|(id, _)| self.model.surfaces[id.index()].clone()).collect();
        let model = Model::build_cut(surfaces, &lines, &self.network, tolerance, &Job::default())?;
        let place_of: BTreeMap<SurfaceId, SurfaceId> = listed.iter().enumerate().map(|(k, (id, _))| (*id, SurfaceId::at(k))).collect();
        let shell = Shell {
            surfaces: listed.iter().enumerate().map(|(k, (_, other))| (SurfaceId::at(k), *other)).collect(),
            free: Vec::new(),
            ..self.shell.clone()
        };
        let faces = Self {
            model: model.into(),
            network: self.network.clone(),
            shell,
            solid: self.solid,
            colors: moved(&self.colors, &place_of),
            names: moved(&self.names, &place_of),
            layers: moved(&self.layers, &place_of),
        };
        Ok(Some((faces, lines.into_iter().map(|line| line.0).collect())))
    }
}

/// What is known of surfaces, by their places in another model.
fn moved<T: Clone>(of: &BTreeMap<SurfaceId, T>, place_of: &BTreeMap<SurfaceId, SurfaceId>) -> BTreeMap<SurfaceId, T> {
    of.iter().filter_map(|(id, known)| Some((*place_of.get(id)?, known.clone()))).collect()
}
