//! Meshes carried by motions.

use crate::geometry::Motion;
use crate::mesh::data::mesh::Mesh;

impl Mesh {
    /// The mesh carried by a motion; a mirror turns the elements over, so that their normals are carried too.
    pub fn moved(&self, motion: &Motion) -> Self {
        let mut moved = self.clone();
        moved.nodes.iter_mut().for_each(|p| *p = motion.point(*p));
        moved.border_error *= motion.scale();
        moved.sizes.scale(motion.scale());
        for geometry in &mut moved.geometries.0 {
            geometry.surface = geometry.surface.moved(motion);
            geometry.flipped ^= motion.mirrors();
            geometry.quality = None;
        }
        if motion.mirrors() {
            moved.triangles.iter_mut().for_each(|t| t.swap(1, 2));
            moved.triangle_mids.iter_mut().for_each(|m| m.swap(0, 2));
            moved.quads.iter_mut().for_each(|q| q.swap(1, 3));
            moved.quad_mids.iter_mut().for_each(|m| m.reverse());
        }
        moved
    }
}
