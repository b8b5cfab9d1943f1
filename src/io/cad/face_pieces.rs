//! Faces along a profile of lines and arcs, cut where its pieces meet: each part then has a form that files know by name.

use std::collections::BTreeMap;

use crate::base::job::Job;
use crate::base::tolerance::Tolerance;
use crate::io::cad::bodies::Faces;
use crate::io::cad::defect::Defect;
use crate::model::topology::Named;
use crate::model::{Lines, Model, Shell, SurfaceId};
use crate::surface::Domain;

/// Faces that were cut, and which of the surfaces given.
pub(super) type CutFaces = (Faces, Vec<SurfaceId>);

impl Faces {
    /// The faces cut where the pieces of their profiles meet, in a model of their own, with the surfaces that were cut; `None` where none
    /// is. Each part has the name, colour and layers of its face.
    pub(super) fn in_pieces(&self, tolerance: &Tolerance) -> Result<Option<CutFaces>, Defect> {
        let (mut surfaces, mut sides): (Vec<Named>, Vec<(SurfaceId, bool)>) = (Vec::new(), Vec::new());
        let mut lines: Vec<(SurfaceId, Lines)> = Vec::new();
        let mut place_of: BTreeMap<SurfaceId, Vec<SurfaceId>> = BTreeMap::new();
        let mut parted = Vec::new();
        for (id, other) in &self.shell.surfaces {
            let named = &self.model.surfaces[id.index()];
            let trimmed = named.surface.in_forms(tolerance);
            let parts = if trimmed.is_empty() { vec![named.surface.clone()] } else { trimmed };
            let is_trimmed = parts.len() > 1;
            for surface in parts {
                let own = SurfaceId::at(surfaces.len());
                let v = if surface.domain() == Domain::Square { surface.form_joints(tolerance) } else { Vec::new() };
                if is_trimmed || !v.is_empty() {
                    parted.push(own);
                }
                lines.extend(Some((own, Lines { u: Vec::new(), v })).filter(|(_, lines)| !lines.v.is_empty()));
                surfaces.push(Named { surface, ..named.clone() });
                sides.push((own, *other));
                place_of.entry(*id).or_default().push(own);
            }
        }
        if parted.is_empty() {
            return Ok(None);
        }
        let model = Model::build_cut(surfaces, &lines, &self.network, tolerance, &Job::default())?;
        let faces = Self {
            model: model.into(),
            network: self.network.clone(),
            shell: Shell { surfaces: sides, free: Vec::new(), ..self.shell.clone() },
            solid: self.solid,
            colors: moved(&self.colors, &place_of),
            names: moved(&self.names, &place_of),
            layers: moved(&self.layers, &place_of),
        };
        Ok(Some((faces, parted)))
    }
}

/// What is known of surfaces, by the places of their parts in another model.
fn moved<T: Clone>(of: &BTreeMap<SurfaceId, T>, place_of: &BTreeMap<SurfaceId, Vec<SurfaceId>>) -> BTreeMap<SurfaceId, T> {
    let places =
        |(id, known): (&SurfaceId, &T)| place_of.get(id).into_iter().flatten().map(|own| (*own, known.clone())).collect::<Vec<_>>();
    of.iter().flat_map(places).collect()
}
