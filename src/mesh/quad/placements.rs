//! Which placement of nodes a face of quads keeps.
//!
//! Where few irregular nodes are asked for, a plane face is made with as many holes in its lattice as a search finds room for, and with those that
//! have room; the better net is kept.

use crate::base::fault::Result;
use crate::base::job::{self, Job};
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::quad::net::Net;
use crate::mesh::quad::net_fit::NetFit;
use crate::mesh::quad::settings::PLACEMENTS;
use crate::mesh::request::methods::Method;
use crate::mesh::tri::build::NodePlacement;
use crate::mesh::tri::front::HolesInLattice;
use crate::mesh::tri::graded_size::GradedSize;
use crate::mesh::tri::no_mesh::Outcome;

impl NetFit<'_> {
    /// The best net for these lengths.
    pub(super) fn net(&self, field: &GradedSize, job: &Job) -> Outcome<Net> {
        if self.fit.face.method == Method::Quadtree {
            return self.net_of(field, NodePlacement::Tree, job);
        }
        let is_regular = self.is_regular();
        let holes = if is_regular { HolesInLattice::Searched } else { HolesInLattice::WithRoom };
        let mut best = match self.net_of(field, NodePlacement::Squares(holes), job)? {
            Ok(net) => net,
            Err(reason) => return Ok(Err(reason)),
        };
        if is_regular && self.fit.chart.plane().is_some() {
            self.improve(&mut best, HolesInLattice::WithRoom, field, job)?;
        }
        Ok(Ok(best))
    }

    /// Takes the net with these holes in its lattice if there is one and it is better.
    fn improve(&self, best: &mut Net, holes: HolesInLattice, field: &GradedSize, job: &Job) -> Result<()> {
        let Ok(other) = self.net_of(field, NodePlacement::Squares(holes), job)? else { return Ok(()) };
        let (own, new) = (least(best), least(&other));
        let is_better = if own.min(new) < PLACEMENTS.min_quality { new > own } else { irregular(&other) < irregular(best) };
        if is_better {
            *best = other;
        }
        Ok(())
    }
}

/// The least quality of a net.
fn least(net: &Net) -> f64 {
    job::looking(0..net.face.len()).map(|f| net.quality(f)).fold(f64::INFINITY, f64::min)
}

/// Number of inner nodes that have not four faces.
fn irregular(net: &Net) -> usize {
    let mut faces = vec![0_u8; net.p.len()];
    for f in job::looking(0..net.face.len()) {
        net.corners(f).iter().for_each(|n| faces[*n as usize] = faces[*n as usize].saturating_add(1));
    }
    faces[net.fixed as usize..].iter().filter(|count| **count != 4).count()
}
