//! Repair of bad triangles, worst first: a corner moved, a side flipped, or a patch made anew with a node more or less.

use glam::{DVec2, DVec3};

use crate::base::triangulate_points::NO_TRIANGLE;
use crate::base::{job, work};
use crate::mesh::chart::outline::area2;
use crate::mesh::tri::optimize::MeshOptimizer;
use crate::mesh::tri::optimize_settings::{REPAIR, SLIDE};
use crate::mesh::tri::shape::Star;
use crate::mesh::tri::triangulation::Patch;

impl MeshOptimizer<'_> {
    /// Repairs triangles below the wanted quality, the worst first; number of changes.
    pub fn repair(&mut self) -> usize {
        let changed = self.changed.take();
        let mut bad: Vec<(f64, u32)> = self
            .triangles_at(&changed)
            .into_iter()
            .map(|t| (self.penalized_quality(t), t))
            .filter(|(q, _)| *q < self.settings.min_quality)
            .collect();
        bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut changes = 0;
        for (_, t) in bad {
            job::poll();
            if self.is_out_of_work() {
                break;
            }
            for _ in 0..3 {
                if !self.triangulation.alive(t) || self.penalized_quality(t) >= self.settings.min_quality {
                    break;
                }
                if !self.repair_triangle(t) {
                    self.failed_repairs.give_up(t);
                    break;
                }
                changes += 1;
            }
        }
        changes
    }

    fn repair_triangle(&mut self, t: u32) -> bool {
        work::spend(REPAIR.triangle_work);
        self.shift_corners(t) || self.flip_worse(t) || self.rebuild(t)
    }

    /// Least gain of a change where the worst triangle has a quality.
    pub(super) fn min_gain(&self, worst: f64) -> f64 {
        if worst < self.settings.fair_quality { REPAIR.min_gain } else { REPAIR.min_fair_gain }
    }

    /// The quality of a triangle, lowered where a side is too long.
    pub(crate) fn penalized_quality(&self, t: u32) -> f64 {
        let c = self.triangulation.tri[t as usize];
        let shape = self.triangulation.shape(c);
        let mut quality = shape;
        for k in 0..3 {
            let (i, j) = (c[k], c[(k + 1) % 3]);
            if self.triangulation.is_free(i) || self.triangulation.is_free(j) {
                let size =
                    if self.triangulation.is_free(i) { self.triangulation.size[i as usize] } else { self.triangulation.size[j as usize] };
                let length = self.triangulation.p[i as usize].distance(self.triangulation.p[j as usize]);
                quality = quality.min(shape * (size * self.settings.max_length_ratio / length).min(1.0));
            }
        }
        quality
    }

    /// Moves a corner to where its worst triangle is best.
    fn shift_corners(&mut self, t: u32) -> bool {
        let mut any = false;
        let since = self.failed_repairs.since(t);
        let may_slide = self.may_slide && self.triangulation.shape(self.triangulation.tri[t as usize]) < SLIDE.min_quality;
        for node in self.triangulation.tri[t as usize] {
            if !self.triangulation.is_free(node) {
                any |= may_slide && self.slide_corner(node, since);
                continue;
            }
            self.fill_rim(node);
            if !self.failed_repairs.is_new(self.ring.node.iter().copied().chain([node]), since) {
                continue;
            }
            let (xy, p) = (self.triangulation.xy[node as usize], self.triangulation.p[node as usize]);
            let before = self.rim.worst(xy, p);
            let star = self.rim.best(self.chart_surface, xy, p);
            if star.worst > before + self.min_gain(before) && self.star_keeps(&self.ring.node, node, &star) {
                self.place(node, star.xy, star.p);
                any = true;
            }
        }
        any
    }

    /// Slides a corner on the border to where its worst triangle is best.
    fn slide_corner(&mut self, node: u32, since: u32) -> bool {
        if !self.slides(node) {
            return false;
        }
        self.triangulation.ring(node, &mut self.ring);
        let is_new = self.failed_repairs.is_new(self.ring.node.iter().copied().chain([node]), since);
        is_new && self.slide(node)
    }

    /// Tries patches round a triangle with a node more or less; takes the best.
    fn rebuild(&mut self, t: u32) -> bool {
        let mut best: Option<(f64, Patch, PatchPlan)> = None;
        let since = self.failed_repairs.since(t);
        for (tri, keep) in self.candidates(t) {
            if !self.failed_repairs.is_new(tri.iter().flat_map(|t| self.triangulation.tri[*t as usize]), since) {
                continue;
            }
            let before = tri.iter().map(|t| self.penalized_quality(*t)).fold(f64::INFINITY, f64::min);
            let mut patch = std::mem::take(&mut self.patch);
            let fits = self.triangulation.patch(&tri, &mut patch);
            if fits.is_some()
                && let Some((after, plan)) = self.plan(
                    &patch,
                    keep,
                    PlanThreshold { first: before * REPAIR.min_start_ratio, best: before + best.as_ref().map_or(0.0, |b| b.0) },
                )
                && after > before + self.min_gain(before)
                && best.as_ref().is_none_or(|b| after - before > b.0)
                && self.plan_keeps(&patch, &plan)
            {
                best = Some((after - before, patch.clone(), plan));
            }
            self.patch = patch;
        }
        let Some((_, patch, plan)) = best else { return false };
        match plan {
            PatchPlan::Star(star, node) => self.restar(&patch, node, &star),
            PatchPlan::Fan(k) => {
                self.triangulation.refan(&patch, k);
                self.wake_patch(&patch);
            }
        }
        true
    }

    /// Whether a triangle keeps the limits, with its first corner moved to a place.
    pub(crate) fn keeps(&self, corners: [u32; 3], first: Option<(DVec2, DVec3)>) -> bool {
        self.limit_check.is_none_or(|limit_check| limit_check.keeps(&self.triangulation, corners, first))
    }

    /// The same of the triangles from a place to the sides of a rim.
    pub(crate) fn star_keeps(&self, rim: &[u32], node: u32, star: &Star) -> bool {
        let n = rim.len();
        (0..n).all(|i| self.keeps([node, rim[i], rim[(i + 1) % n]], Some((star.xy, star.p))))
    }

    fn plan_keeps(&self, patch: &Patch, plan: &PatchPlan) -> bool {
        let rim = &patch.rim;
        let n = rim.len();
        match plan {
            PatchPlan::Star(star, node) => self.star_keeps(rim, node.unwrap_or(u32::MAX), star),
            PatchPlan::Fan(k) => (1..n - 1).all(|i| self.keeps([rim[*k], rim[(k + i) % n], rim[(k + i + 1) % n]], None)),
        }
    }

    /// Sets of triangles round a triangle: two at each side for a new node, stars of corners without it, stars of two
    /// neighbouring corners as one.
    pub(crate) fn candidates(&mut self, t: u32) -> Vec<(Vec<u32>, Keep)> {
        let mut sets = Vec::new();
        let c = self.triangulation.tri[t as usize];
        let across = self.triangulation.across[t as usize];
        for (k, next) in across.into_iter().enumerate() {
            if self.triangulation.locked[t as usize] >> k & 1 == 0 && next != NO_TRIANGLE {
                sets.push((vec![t, next], Keep::New));
            }
        }
        let open: Vec<u32> = (0..3).filter(|k| self.triangulation.locked[t as usize] >> k & 1 == 0).map(|k| across[k]).collect();
        if open.len() >= 2 {
            sets.push((std::iter::once(t).chain(open).collect(), Keep::New));
        }
        for k in 0..3 {
            if let Some([_, _, tip, _]) = self.quad(t, k)
                && self.triangulation.is_free(tip)
            {
                self.triangulation.ring(tip, &mut self.ring);
                sets.push((self.ring.tri.iter().copied().chain([t]).collect(), Keep::One(tip)));
            }
        }
        for k in 0..3 {
            let (a, b) = (c[k], c[(k + 1) % 3]);
            if self.triangulation.is_free(a) {
                self.triangulation.ring(a, &mut self.ring);
                sets.push((self.ring.tri.clone(), Keep::None));
            }
            if self.triangulation.is_free(a) && self.triangulation.is_free(b) {
                self.triangulation.ring(a, &mut self.ring);
                let mut tri = self.ring.tri.clone();
                self.triangulation.ring(b, &mut self.ring);
                tri.extend(self.ring.tri.iter().filter(|t| !tri.contains(t)).copied().collect::<Vec<_>>());
                sets.push((tri, Keep::One(a.min(b))));
            }
        }
        sets
    }

    /// The best plan of a patch with its worst quality, where that may exceed the threshold.
    pub(crate) fn plan(&mut self, patch: &Patch, keep: Keep, threshold: PlanThreshold) -> Option<(f64, PatchPlan)> {
        work::spend(REPAIR.patch_work);
        self.rim.fill(patch.rim.iter().map(|n| (self.triangulation.p[*n as usize], self.triangulation.xy[*n as usize])));
        if let Keep::None = keep {
            return self.best_fan(patch);
        }
        if self.rim.ceiling() <= threshold.best {
            return None;
        }
        let (xy, p) = self.rim.middle();
        let xy = self.chart_surface.clamp(xy);
        self.rim.longest = self.field.size(xy, p) * self.mean_size_factor(&patch.rim) * self.settings.max_length_ratio;
        // A rim that is far too large or too small for one node is not searched for its best place.
        let p = self.chart_surface.point(xy);
        if self.rim.worst(xy, p) < threshold.first {
            return None;
        }
        let star = self.rim.best(self.chart_surface, xy, p);
        let node = if let Keep::One(node) = keep { Some(node) } else { None };
        (star.worst > 0.0).then_some((star.worst, PatchPlan::Star(star, node)))
    }

    /// The fan of the rim's node that gives the best worst triangle.
    fn best_fan(&self, patch: &Patch) -> Option<(f64, PatchPlan)> {
        let n = patch.rim.len();
        let (p, xy) = (self.rim.points(), self.rim.places());
        let mut best: Option<(f64, usize)> = None;
        for k in 0..n {
            let mut worst = f64::INFINITY;
            for i in 1..n - 1 {
                let (a, b) = ((k + i) % n, (k + i + 1) % n);
                if area2(xy[k], xy[a], xy[b]) <= 0.0 {
                    worst = -1.0;
                    break;
                }
                let far = p[k].distance(p[a]);
                let longest = self.triangulation.size[patch.rim[a] as usize] * self.settings.max_length_ratio;
                let share = if i > 1 { (longest / far).min(1.0) } else { 1.0 };
                worst = worst.min(self.triangulation.shape([k, a, b].map(|i| patch.rim[i])) * share);
            }
            if worst > 0.0 && best.is_none_or(|b| worst > b.0) {
                best = Some((worst, k));
            }
        }
        best.map(|(worst, k)| (worst, PatchPlan::Fan(k)))
    }
}

/// Least qualities of a plan.
#[derive(Clone, Copy)]
pub(crate) struct PlanThreshold {
    /// Of its first guess.
    pub first: f64,
    /// Of its best place, by the bound for the rim.
    pub best: f64,
}

impl PlanThreshold {
    /// Anything.
    pub const ANY: Self = Self { first: f64::NEG_INFINITY, best: f64::NEG_INFINITY };
}

/// Which node a patch keeps.
#[derive(Clone, Copy)]
pub(crate) enum Keep {
    /// A new one in its middle.
    New,
    /// One of those inside.
    One(u32),
    /// None: a fan from its rim.
    None,
}

pub(crate) enum PatchPlan {
    Star(Star, Option<u32>),
    Fan(usize),
}
