//! Wanted lengths over a face: those of places with a size of their own, and those by bends.

use glam::{DVec2, DVec3};

use crate::mesh::chart::parametric_surface::SizeField;
use crate::mesh::request::sources::Sources;
use crate::mesh::tri::background::Background;

/// Lengths by places with a size of their own, under those of a background.
pub struct GradedSize<'a> {
    /// Places, in lengths of edges.
    pub sources: &'a Sources,
    /// Largest and least length of an edge.
    pub range: (f64, f64),
    /// Distance of nodes over the length of edges.
    pub spacing: f64,
    /// Distances of nodes by bends.
    pub background: Option<Background>,
}

impl GradedSize<'_> {
    /// A lower bound of the wanted distances of nodes.
    pub fn least(&self) -> f64 {
        let by_bends = self.background.as_ref().map_or(f64::INFINITY, Background::least);
        let (most, least) = self.range;
        (self.sources.least().min(most) * self.spacing).min(by_bends).max(least * self.spacing)
    }

    /// The distance of nodes that bends demand.
    pub fn by_bends(&self, xy: DVec2, p: DVec3) -> f64 {
        self.background.as_ref().map_or(f64::INFINITY, |b| b.size(xy, p))
    }
}

impl SizeField for GradedSize<'_> {
    fn size(&self, xy: DVec2, p: DVec3) -> f64 {
        let (most, least) = self.range;
        // Sources are evaluated up to what bends allow.
        let bends = self.by_bends(xy, p).min(most * self.spacing);
        self.sources.who(p, bends / self.spacing).map_or(bends, |found| found.size * self.spacing).max(least * self.spacing)
    }
}
