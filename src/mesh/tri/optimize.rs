//! Better triangles: flips, smoothing on the surface, and patches made anew with a node more or less.
//!
//! Every change keeps the triangles right side up in the chart and does not make the worst of those it touches worse
//! [Freitag 1997].

pub mod divide;
pub mod flips;
pub mod local_search;
pub mod repair;
pub mod smooth;
pub mod tried;
pub mod upright;

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField};
use crate::mesh::tri::optimize::tried::Tried;
use crate::mesh::tri::pending::Pending;
use crate::mesh::tri::shape::{Rim, Star};
use crate::mesh::tri::triangulation::{Patch, Ring, Triangulation};

/// How the improvement is done.
#[derive(Clone, Copy, Debug)]
pub struct OptimizeSettings {
    /// Rounds of smoothing.
    pub smooth: usize,
    /// Share of the way to the mean of its neighbours that a node is moved.
    pub beyond: f64,
    /// A node whose triangles are all at least this good is left where it is.
    pub fine: f64,
    /// Triangles below this quality are worked on.
    pub wanted: f64,
    /// From this quality on a change has to be worth its while: what is little better is looked at again and again.
    pub fair: f64,
    /// Longest edge over wanted length.
    pub longest: f64,
}

/// What cannot get better by smoothing.
pub const FINEST: f64 = 0.9999;
/// Rounds of work on bad triangles.
const ROUNDS: usize = 6;

/// Limits that triangles have to keep.
pub trait LimitCheck {
    /// Those of some triangles of a triangulation that break a limit; all others are as they were when it was asked last.
    fn broken(&self, triangulation: &Triangulation, some: &[u32]) -> Vec<u32>;

    /// Whether triangles are bounded one by one, so that a change can be asked about ahead.
    fn foresees(&self) -> bool;

    /// Whether a triangle would keep the limits, with its first corner moved to a place; that of a new node has no number below
    /// the border's. Always so where nothing is foreseen.
    fn keeps(&self, triangulation: &Triangulation, corners: [u32; 3], first: Option<(DVec2, DVec3)>) -> bool;
}

/// A triangulation being improved.
pub struct MeshOptimizer<'a> {
    /// The triangles.
    pub triangulation: Triangulation,
    /// Their surface.
    pub chart_surface: &'a dyn ParametricSurface,
    /// Wanted lengths.
    pub field: &'a dyn SizeField,
    /// How.
    pub settings: OptimizeSettings,
    /// What mended triangles have to keep.
    pub limit_check: Option<&'a dyn LimitCheck>,
    ring: Ring,
    rim: Rim,
    patch: Patch,
    /// Nodes that may have to move.
    active: Pending,
    /// Nodes that moved since the last flips.
    moved: Pending,
    /// Nodes that changed since the last mending: what is as it was when nothing helped is left alone.
    changed: Pending,
    /// Nodes that changed since limits were looked at.
    unseen: Pending,
    /// What lengths at each node are squeezed by.
    squeezed: Vec<f64>,
    /// What could not be mended, and since when.
    tried: Tried,
}

impl<'a> MeshOptimizer<'a> {
    /// Takes a triangulation.
    pub fn new(
        triangulation: Triangulation,
        chart_surface: &'a dyn ParametricSurface,
        field: &'a dyn SizeField,
        settings: OptimizeSettings,
    ) -> Self {
        let all = Pending::all(triangulation.p.len());
        let squeezed = vec![1.0; triangulation.p.len()];
        Self {
            triangulation,
            chart_surface,
            field,
            settings,
            limit_check: None,
            ring: Ring::default(),
            rim: Rim::default(),
            patch: Patch::default(),
            active: all.clone(),
            moved: all.clone(),
            changed: all.clone(),
            unseen: all,
            squeezed,
            tried: Tried::default(),
        }
    }

    /// The first flips and rounds of smoothing: from here on nodes hardly move.
    pub fn settle(&mut self) {
        self.flip_all();
        if self.settings.smooth > 0 {
            self.smooth(self.settings.smooth);
            self.flip_all();
            // What still moves a little is left; what is mended wakes its neighbours.
            self.active.clear();
        }
    }

    /// Triangles at some nodes, ascending.
    fn triangles_at(&mut self, nodes: &[u32]) -> Vec<u32> {
        let n = self.triangulation.tri.len() as u32;
        if 2 * nodes.len() > self.triangulation.p.len() {
            return (0..n).filter(|t| self.triangulation.alive(*t)).collect();
        }
        self.rings_of(nodes)
    }

    /// The same, each node looked at whatever their number.
    fn rings_of(&mut self, nodes: &[u32]) -> Vec<u32> {
        let mut found = Vec::with_capacity(6 * nodes.len());
        for node in nodes {
            self.triangulation.ring(*node, &mut self.ring);
            found.extend_from_slice(&self.ring.tri);
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Works on bad triangles, after [`MeshOptimizer::settle`].
    pub fn improve(&mut self, job: &Job) -> Result<()> {
        if self.settings.smooth == 0 {
            return Ok(());
        }
        for _ in 0..ROUNDS {
            job.go_on()?;
            if self.repair() == 0 {
                break;
            }
            self.smooth(self.settings.smooth.min(4));
            self.flip_all();
        }
        self.repair_last(job)
    }

    /// What lengths are squeezed by among some nodes.
    fn squeezed(&self, among: &[u32]) -> f64 {
        among.iter().map(|n| self.squeezed[*n as usize]).sum::<f64>() / among.len() as f64
    }

    /// A patch becomes the star of a node inside it, or of a new one.
    fn restar(&mut self, patch: &Patch, node: Option<u32>, star: &Star) {
        let squeezed = self.squeezed(&patch.rim);
        let node = self.triangulation.restar(patch, node, star, self.field.size(star.xy, star.p) * squeezed);
        self.wake_patch(patch);
        self.squeezed[node as usize] = squeezed;
    }

    /// The nodes of a patch made anew may have to move.
    fn wake_patch(&mut self, patch: &Patch) {
        self.squeezed.resize(self.triangulation.p.len(), 1.0);
        patch.rim.iter().chain(&patch.inner).for_each(|n| self.touch(*n));
    }

    /// The nodes of a triangle may have to move.
    fn wake(&mut self, t: u32) {
        for n in self.triangulation.tri[t as usize] {
            self.tried.change(n);
            self.active.add(n);
            self.changed.add(n);
            self.unseen.add(n);
        }
    }

    /// A node or its triangles changed.
    fn touch(&mut self, node: u32) {
        self.tried.change(node);
        self.active.add(node);
        self.moved.add(node);
        self.changed.add(node);
        self.unseen.add(node);
    }
}
