//! A model as a mesher is given it: trimmed nets that run very unevenly in their parameters are there in others.

use super::topology::{EdgeCurve, Model, SurfaceId};

impl Model {
    /// The same model where some of these surfaces run evenly in other parameters ([`crate::surface::Surface::evened`]), and edges along their
    /// lines are in those; `None` where all may stay.
    pub fn evened(&self, surfaces: impl Iterator<Item = SurfaceId>) -> Option<Self> {
        let uneven: Vec<SurfaceId> = surfaces.filter(|id| self.surfaces[id.index()].surface.evened().is_some()).collect();
        if uneven.is_empty() {
            return None;
        }
        let mut model = self.clone();
        for id in uneven {
            let Some(evened) = self.surfaces[id.index()].surface.evened() else { continue };
            model.surfaces[id.index()].surface = evened.surface().clone();
            for edge in &mut model.edges {
                if let EdgeCurve::Iso { surface, from, to } = &mut edge.curve
                    && *surface == id
                {
                    (*from, *to) = (evened.place(*from), evened.place(*to));
                }
            }
        }
        Some(model)
    }
}
