//! Better triangles: flips, smoothing on the surface, and patches made anew with a node more or less.
//!
//! Every change keeps the triangles right side up in the chart and does not make the worst of those it touches worse
//! [Freitag 1997].

pub mod divide;
pub mod failed_repairs;
pub mod flips;
pub mod local_search;
pub mod repair;
pub(crate) mod slide;
pub mod smooth;
pub mod upright;

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::work;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField};
use crate::mesh::tri::optimize::failed_repairs::FailedRepairs;
use crate::mesh::tri::optimize_settings::{DIVISION, REPAIR};
use crate::mesh::tri::pending::Pending;
use crate::mesh::tri::shape::{PatchRim, Star};
use crate::mesh::tri::sliding_border::SlidingBorder;
use crate::mesh::tri::triangulation::{Patch, Ring, Triangulation};

/// Settings of the optimization of one face.
#[derive(Clone, Copy, Debug)]
pub struct OptimizeSettings {
    /// Rounds of smoothing.
    pub smoothing_rounds: usize,
    /// Share of the way to the mean of its neighbours that a node is moved.
    pub relaxation: f64,
    /// Least quality of the triangles of a node above which it does not move.
    pub still_quality: f64,
    /// Quality below which triangles are repaired.
    pub min_quality: f64,
    /// Quality from which on a change needs a larger gain: small gains would be repeated again and again.
    pub fair_quality: f64,
    /// Longest edge over wanted length.
    pub max_length_ratio: f64,
    /// Searches round the worst triangles.
    pub searches: SearchBudget,
}

/// How many searches round bad triangles a face has.
#[derive(Clone, Copy, Debug)]
pub struct SearchBudget {
    /// One triangle in so many is searched.
    pub triangles_per_search: usize,
    /// Of small faces one in so many more.
    pub triangles_per_extra_search: usize,
    /// Largest number of those.
    pub max_extra_searches: usize,
    /// Largest number of passes over the bad triangles.
    pub max_rounds: usize,
    /// Triangles are bad by their shapes alone: beside long steps of a border all sides are too long, and are divided.
    pub by_shape: bool,
}

impl SearchBudget {
    /// A few: where limits of bends are bounded triangle by triangle, a search costs many times more.
    pub const FEW: Self =
        Self { triangles_per_search: 8000, triangles_per_extra_search: 64, max_extra_searches: 24, max_rounds: 2, by_shape: false };

    /// The searches of a face with so many triangles.
    fn of(&self, triangles: usize) -> usize {
        1 + (triangles / self.triangles_per_extra_search).min(self.max_extra_searches) + triangles / self.triangles_per_search
    }
}

/// Quality that smoothing does not improve.
pub const FINEST: f64 = 0.9999;

/// Limits that triangles have to keep.
pub trait LimitCheck {
    /// Those of some triangles of a triangulation that exceed a limit; all others are unchanged since the last call.
    fn broken(&self, triangulation: &Triangulation, some: &[u32]) -> Vec<u32>;

    /// Whether triangles are bounded one by one, so that a change can be checked before it is made.
    fn is_per_triangle(&self) -> bool;

    /// Whether nodes keep the limits from the first move on, and not only when all triangles do.
    fn holds_from_the_start(&self) -> bool {
        false
    }

    /// Allows the face the work that bounds of so many triangles may take; none where they are not bounded one by one.
    fn allow_work(&self, triangles: usize);

    /// Whether a triangle would keep the limits, with its first corner moved to a place; that of a new node has no number below
    /// the border's. Always so where triangles are not bounded one by one.
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
    /// The limits of repaired triangles.
    pub limit_check: Option<&'a dyn LimitCheck>,
    /// Whether moves and flips of the first rounds keep the limits too.
    pub guards_moves: bool,
    /// Border nodes that may slide.
    sliding: Option<&'a SlidingBorder<'a>>,
    /// Whether they do: once nothing else makes the worst triangles better.
    may_slide: bool,
    /// Work below which triangles are improved no further, so that the face is made.
    reserved_work: u64,
    ring: Ring,
    rim: PatchRim,
    patch: Patch,
    /// Nodes that may have to move.
    active: Pending,
    /// Nodes that moved since the last flips.
    moved: Pending,
    /// Nodes that changed since the last repair: unchanged triangles are not repaired again.
    changed: Pending,
    /// Nodes that changed since limits were checked.
    unseen: Pending,
    /// Factor on the wanted length at each node.
    size_factor: Vec<f64>,
    /// Triangles that could not be repaired.
    failed_repairs: FailedRepairs,
    /// Triangles round which a search failed.
    failed_searches: FailedRepairs,
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
        let size_factor = vec![1.0; triangulation.p.len()];
        Self {
            triangulation,
            chart_surface,
            field,
            settings,
            limit_check: None,
            guards_moves: false,
            sliding: None,
            may_slide: false,
            reserved_work: 0,
            ring: Ring::default(),
            rim: PatchRim::default(),
            patch: Patch::default(),
            active: all.clone(),
            moved: all.clone(),
            changed: all.clone(),
            unseen: all,
            size_factor,
            failed_repairs: FailedRepairs::default(),
            failed_searches: FailedRepairs::default(),
        }
    }

    /// Keeps a part of the work that is left from improvements.
    pub fn reserve_work(&mut self) {
        self.reserved_work = work::left() / DIVISION.reserved_work;
    }

    /// Whether improvements have to end for what is left of the work.
    fn is_out_of_work(&self) -> bool {
        work::left() < self.reserved_work
    }

    /// The triangles alone.
    pub fn into_triangulation(self) -> Triangulation {
        self.triangulation
    }

    /// Puts the nodes on another surface, at their places in the chart; the largest move over the wanted length there.
    pub fn move_onto(&mut self, chart_surface: &'a dyn ParametricSurface) -> f64 {
        self.chart_surface = chart_surface;
        self.unseen = Pending::all(self.triangulation.p.len());
        let mut largest = 0.0_f64;
        for n in self.triangulation.fixed as usize..self.triangulation.p.len() {
            let p = chart_surface.point(self.triangulation.xy[n]);
            largest = largest.max(p.distance(self.triangulation.p[n]) / self.triangulation.size[n]);
            self.triangulation.p[n] = p;
        }
        largest
    }

    /// Goes back to triangles from before; all of them count as changed.
    fn go_back(&mut self, triangulation: Triangulation) {
        let nodes = triangulation.p.len();
        self.triangulation = triangulation;
        self.size_factor.resize(nodes, 1.0);
        for pending in [&mut self.active, &mut self.moved, &mut self.changed, &mut self.unseen] {
            *pending = Pending::all(nodes);
        }
        (self.failed_repairs, self.failed_searches) = (FailedRepairs::default(), FailedRepairs::default());
    }

    /// The first flips and rounds of smoothing: from here on nodes hardly move.
    pub fn settle(&mut self) {
        self.flip_all();
        if self.settings.smoothing_rounds > 0 {
            self.smooth(self.settings.smoothing_rounds);
            self.flip_all();
            // Small remaining moves are dropped; repair activates its neighbours.
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

    /// The same by the ring of each node.
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

    /// Repairs bad triangles, after [`MeshOptimizer::settle`].
    pub fn improve(&mut self, job: &Job) -> Result<()> {
        if self.settings.smoothing_rounds == 0 {
            return Ok(());
        }
        for _ in 0..REPAIR.max_rounds {
            job.go_on()?;
            if self.repair() == 0 {
                break;
            }
            self.smooth(self.settings.smoothing_rounds.min(4));
            self.flip_all();
        }
        self.repair_last(SearchBudget::FEW, job)
    }

    /// The mean factor on wanted lengths of some nodes.
    fn mean_size_factor(&self, among: &[u32]) -> f64 {
        among.iter().map(|n| self.size_factor[*n as usize]).sum::<f64>() / among.len() as f64
    }

    /// A patch becomes the star of a node inside it, or of a new one.
    fn restar(&mut self, patch: &Patch, node: Option<u32>, star: &Star) {
        let factor = self.mean_size_factor(&patch.rim);
        let node = self.triangulation.restar(patch, node, star, self.field.size(star.xy, star.p) * factor);
        self.wake_patch(patch);
        self.size_factor[node as usize] = factor;
    }

    /// The nodes of a patch made anew may have to move.
    fn wake_patch(&mut self, patch: &Patch) {
        self.size_factor.resize(self.triangulation.p.len(), 1.0);
        patch.rim.iter().chain(&patch.inner).for_each(|n| self.touch(*n));
    }

    /// The nodes of a triangle may have to move.
    fn wake(&mut self, t: u32) {
        for n in self.triangulation.tri[t as usize] {
            self.failed_repairs.change(n);
            self.failed_searches.change(n);
            self.active.add(n);
            self.changed.add(n);
            self.unseen.add(n);
        }
    }

    /// A node or its triangles changed.
    fn touch(&mut self, node: u32) {
        self.failed_repairs.change(node);
        self.failed_searches.change(node);
        self.active.add(node);
        self.moved.add(node);
        self.changed.add(node);
        self.unseen.add(node);
    }
}
