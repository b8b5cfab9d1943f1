//! Chord errors of single faces, cached while the faces do not change.

use crate::base::digest::{Digest, StableHash, StableHasher};
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::mesh::cache::reuse::Reuse;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::data::mesh::{FaceRange, Mesh};
use crate::mesh::deviation::measure;

impl Mesh {
    /// [`Mesh::chord_error`] with the cached errors of faces in `reuse`, to which new ones are added.
    pub fn chord_error_again(&self, tolerance: &Tolerance, reuse: Option<&Reuse>) -> Option<f64> {
        let faces: Vec<_> = self.faces.iter().filter(|f| !f.triangles.is_empty() || !f.quads.is_empty()).collect();
        if faces.is_empty() || faces.len() != self.geometries.0.len() {
            return None;
        }
        let errors = par::map(faces.len(), |k| {
            let geometry = &self.geometries.0[k];
            let measure = || {
                let range = faces[k].triangles.start as usize..faces[k].triangles.end as usize;
                measure::of_face(&geometry.surface, geometry, &self.triangles[range], &self.nodes, tolerance)
            };
            reuse.map_or_else(measure, |reuse| reuse.chord(self.face_key(faces[k], geometry, tolerance), measure))
        });
        Some(errors.into_iter().fold(self.border_error, f64::max))
    }

    /// Everything that the chord error of a face follows from, by content.
    fn face_key(&self, face: &FaceRange, geometry: &FaceGeometry, tolerance: &Tolerance) -> Digest {
        let FaceGeometry { surface, nodes, .. } = geometry;
        let mut to = StableHasher::new("chord").with(surface);
        nodes.hash_places(&mut to);
        tolerance.hash_into(&mut to);
        if let FaceNodes::Grid(_, frame) = nodes {
            frame.poles.hash_into(&mut to);
        }
        // Elements are in the order of the cells: their corners determine the places of nodes and the diagonals.
        let mut corners = |ids: &[u32]| ids.iter().for_each(|n| self.nodes[*n as usize].hash_into(&mut to));
        self.triangles[face.triangles.start as usize..face.triangles.end as usize].iter().for_each(|t| corners(t));
        self.quads[face.quads.start as usize..face.quads.end as usize].iter().for_each(|q| corners(q));
        to.finish()
    }
}
