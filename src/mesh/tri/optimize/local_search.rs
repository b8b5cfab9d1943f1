//! Search round the last bad triangles, where no single change helps: each change near one is tried, all nodes round it are moved together
//! after it, and the best result is kept [Freitag 1997].

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::{self, Job};
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::tri::optimize::repair::{PatchPlan, PlanThreshold};
use crate::mesh::tri::optimize::slide::SlidPlace;
use crate::mesh::tri::optimize::{MeshOptimizer, SearchBudget};
use crate::mesh::tri::optimize_settings::{LOCAL_SEARCH, SLIDE};
use crate::mesh::tri::shape::Star;
use crate::mesh::tri::triangulation::Patch;

/// A change of the triangles.
enum Change {
    None,
    Flip(u32, usize),
    Star(Patch, Option<u32>, Star),
    Fan(Patch, usize),
}

/// The triangles round some nodes.
#[derive(Clone, Copy)]
struct LocalQuality {
    /// Their least quality, lowered where sides are too long.
    least: f64,
    /// Their least quality by shape alone.
    least_shape: f64,
    /// Sum of the eighth powers of their distances from quality 1.
    penalty: f64,
}

/// How well some triangles are shaped, whatever the lengths of their sides.
#[derive(Clone, Copy)]
pub(super) struct ShapeQuality {
    least: f64,
    /// Sum of the eighth powers of their distances from quality 1.
    penalty: f64,
}

impl ShapeQuality {
    /// Whether neither the worst is worse nor all together.
    pub(super) fn is_no_worse_than(&self, other: &Self) -> bool {
        self.least >= other.least && self.penalty <= other.penalty
    }
}

/// The eighth power of the distance from quality 1.
fn penalty_of(quality: f64) -> f64 {
    let short = (1.0 - quality) * (1.0 - quality);
    short * short * short * short
}

/// The penalty after a change and sweeps, and the nodes that may move then.
struct Swept {
    penalty: f64,
    places: Vec<(u32, DVec2, DVec3)>,
    /// Border nodes with their fractions.
    slid: Vec<(u32, f64)>,
}

impl MeshOptimizer<'_> {
    /// Repairs bad triangles, and then searches round the worst that are left.
    pub fn repair_last(&mut self, budget: SearchBudget, job: &Job) -> Result<()> {
        self.repair();
        if self.search_worst(budget, job)? > 0 {
            self.repair();
        }
        Ok(())
    }

    /// How well all triangles are shaped.
    pub(super) fn shape_quality(&self) -> ShapeQuality {
        let all = (0..self.triangulation.tri.len() as u32).filter(|t| self.triangulation.alive(*t));
        all.fold(ShapeQuality { least: f64::INFINITY, penalty: 0.0 }, |quality, t| {
            let own = self.triangulation.shape(self.triangulation.tri[t as usize]);
            ShapeQuality { least: quality.least.min(own), penalty: quality.penalty + penalty_of(own) }
        })
    }

    /// Searches round the worst triangles below the wanted quality, the worst first, and again where a search changed something; how many
    /// got better.
    fn search_worst(&mut self, budget: SearchBudget, job: &Job) -> Result<usize> {
        let mut left = budget.of(self.triangulation.tri.len());
        let mut better = 0;
        for round in 1..=budget.max_rounds {
            let before = better;
            let mut bad = self.bad_triangles(budget);
            if !budget.by_shape {
                bad.truncate(left);
            }
            for t in bad {
                job.go_on()?;
                if left == 0 || self.is_out_of_work() {
                    break;
                }
                if !self.is_bad(t, budget) || budget.by_shape && !self.is_unsearched(t) {
                    continue;
                }
                left -= 1;
                if self.try_all(t) {
                    better += 1;
                } else {
                    self.failed_searches.give_up(t);
                }
            }
            if left == 0 || better == before || round == budget.max_rounds {
                break;
            }
            self.repair();
        }
        Ok(better)
    }

    /// The quality by which triangles are searched.
    fn searched_quality(&self, t: u32, budget: SearchBudget) -> f64 {
        let corners = self.triangulation.tri[t as usize];
        if budget.by_shape { self.triangulation.shape(corners) } else { self.penalized_quality(t) }
    }

    fn is_bad(&self, t: u32, budget: SearchBudget) -> bool {
        self.triangulation.alive(t) && self.searched_quality(t, budget) < self.settings.min_quality
    }

    /// Triangles below the wanted quality, the worst first.
    fn bad_triangles(&self, budget: SearchBudget) -> Vec<u32> {
        let all = (0..self.triangulation.tri.len() as u32).filter(|t| self.is_bad(*t, budget));
        let mut bad: Vec<(f64, u32)> = all.map(|t| (self.searched_quality(t, budget), t)).collect();
        bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        bad.into_iter().map(|(_, t)| t).collect()
    }

    /// Whether something near a triangle changed since a search there failed.
    fn is_unsearched(&mut self, t: u32) -> bool {
        let corners = self.triangulation.tri[t as usize];
        let near = self.rings_of(&corners);
        let since = self.failed_searches.since(t);
        self.failed_searches.is_new(self.triangulation.nodes_of(&near).into_iter(), since)
    }

    fn try_all(&mut self, t: u32) -> bool {
        let corners = self.triangulation.tri[t as usize];
        let near = self.rings_of(&corners);
        let nodes = self.triangulation.nodes_of(&near);
        let all = self.rings_of(&nodes);
        let kept = self.triangulation.before(&all);
        let before = self.local_quality(&all);
        let mut best: Option<(usize, Swept)> = None;
        let changes = self.changes(t);
        for (k, change) in changes.iter().enumerate() {
            job::poll();
            let (nodes, _) = self.apply(change, &nodes);
            let most = best.as_ref().map_or(before.penalty * LOCAL_SEARCH.max_penalty_ratio, |best| best.1.penalty);
            if let Some(swept) = self.sweep(&nodes, before, most) {
                best = Some((k, swept));
            }
            self.triangulation.put_back(&kept);
        }
        let Some((k, Swept { places, slid, .. })) = best else { return false };
        let (nodes, star) = self.apply(&changes[k], &nodes);
        self.size_factor.resize(self.triangulation.p.len(), 1.0);
        if let (Change::Star(patch, ..), Some(node)) = (&changes[k], star) {
            self.size_factor[node as usize] = self.mean_size_factor(&patch.rim);
        }
        slid.into_iter().for_each(|(n, fraction)| self.triangulation.along[n as usize] = fraction);
        for (n, xy, p) in places {
            self.place(n, xy, p);
        }
        nodes.into_iter().for_each(|n| self.touch(n));
        true
    }

    fn local_quality(&self, some: &[u32]) -> LocalQuality {
        some.iter().fold(LocalQuality { least: f64::INFINITY, least_shape: f64::INFINITY, penalty: 0.0 }, |quality, t| {
            let own = self.penalized_quality(*t);
            let shape = self.triangulation.shape(self.triangulation.tri[*t as usize]);
            LocalQuality {
                least: quality.least.min(own),
                least_shape: quality.least_shape.min(shape),
                penalty: quality.penalty + penalty_of(own),
            }
        })
    }

    /// The possible changes at a triangle and its neighbours.
    fn changes(&mut self, t: u32) -> Vec<Change> {
        let mut changes = vec![Change::None];
        let near = self.triangulation.across[t as usize].into_iter().filter(|next| *next != NO_TRIANGLE);
        for other in std::iter::once(t).chain(near) {
            // A side of both is flipped once.
            let own = |k: &usize| other == t || self.triangulation.across[other as usize][*k] != t;
            let free = |k: &usize| self.quad(other, *k).is_some_and(|quad| self.convex(quad));
            changes.extend((0..3).filter(own).filter(free).map(|k| Change::Flip(other, k)));
        }
        for (tri, keep) in self.candidates(t) {
            let mut patch = Patch::default();
            if self.triangulation.patch(&tri, &mut patch).is_none() {
                continue;
            }
            match self.plan(&patch, keep, PlanThreshold::ANY) {
                Some((_, PatchPlan::Star(star, node))) => changes.push(Change::Star(patch, node, star)),
                Some((_, PatchPlan::Fan(k))) => changes.push(Change::Fan(patch, k)),
                None => {}
            }
        }
        changes
    }

    /// Makes a change; the nodes of the place after it, and that of a star.
    fn apply(&mut self, change: &Change, nodes: &[u32]) -> (Vec<u32>, Option<u32>) {
        let (mut nodes, mut star_node) = (nodes.to_vec(), None);
        match change {
            Change::None => {}
            Change::Flip(t, k) => self.triangulation.flip(*t, *k),
            Change::Star(patch, node, star) => {
                let size = self.field.size(star.xy, star.p) * self.mean_size_factor(&patch.rim);
                let new = self.triangulation.restar(patch, *node, star, size);
                nodes.push(new);
                star_node = Some(new);
            }
            Change::Fan(patch, k) => self.triangulation.refan(patch, *k),
        }
        nodes.retain(|n| self.triangulation.at[*n as usize] != NO_TRIANGLE);
        nodes.sort_unstable();
        nodes.dedup();
        (nodes, star_node)
    }

    /// Moves some nodes together in sweeps; the least penalty and where they were then, where that is less than
    /// `most`, the worst triangle is no worse than before, by its shape and with its lengths, and all keep the limits.
    fn sweep(&mut self, nodes: &[u32], before: LocalQuality, most: f64) -> Option<Swept> {
        let all = self.rings_of(nodes);
        let (mut best, mut most): (Option<Swept>, f64) = (None, most);
        let may_slide = self.may_slide && before.least_shape < SLIDE.min_quality;
        for round in 0..=LOCAL_SEARCH.max_sweeps {
            let now = self.local_quality(&all);
            let is_no_worse = now.least >= before.least && now.least_shape >= before.least_shape;
            if now.penalty < most && is_no_worse && all.iter().all(|t| self.triangulation.chart_area(*t) > 0.0) {
                let movable = nodes.iter().filter(|n| self.triangulation.is_free(**n) || self.slides(**n));
                let places = movable.map(|n| (*n, self.triangulation.xy[*n as usize], self.triangulation.p[*n as usize])).collect();
                let sliding = nodes.iter().filter(|n| self.slides(**n));
                let slid = sliding.map(|n| (*n, self.triangulation.along[*n as usize])).collect();
                best = Some(Swept { penalty: now.penalty, places, slid });
                most = now.penalty;
            }
            if round == LOCAL_SEARCH.max_sweeps || round == LOCAL_SEARCH.trial_sweeps && now.penalty > LOCAL_SEARCH.max_trial_ratio * most {
                break;
            }
            let mut moved = false;
            for &node in nodes {
                job::poll();
                if !self.triangulation.is_free(node) {
                    moved |= may_slide && self.sweep_border(node);
                    continue;
                }
                self.fill_rim(node);
                let (xy, p) = (self.triangulation.xy[node as usize], self.triangulation.p[node as usize]);
                self.rim.worst(xy, p);
                let Some(way) = self.chart_surface.spot(xy).step(self.rim.demand(p) * LOCAL_SEARCH.sweep_share) else { continue };
                let xy = self.chart_surface.clamp(xy + way);
                let p = self.chart_surface.point(xy);
                if self.rim.worst(xy, p) > 0.0 {
                    (self.triangulation.xy[node as usize], self.triangulation.p[node as usize]) = (xy, p);
                    moved = true;
                }
            }
            if !moved {
                break;
            }
        }
        let best = best?;
        for (n, xy, p) in &best.places {
            (self.triangulation.xy[*n as usize], self.triangulation.p[*n as usize]) = (*xy, *p);
        }
        best.slid.iter().for_each(|(n, fraction)| self.triangulation.along[*n as usize] = *fraction);
        all.iter().all(|t| self.keeps(self.triangulation.tri[*t as usize], None)).then_some(best)
    }

    /// Slides a border node a part of the way to where its worst triangle is best; whether it may slide.
    fn sweep_border(&mut self, node: u32) -> bool {
        let Some((before, best)) = self.best_slide(node) else { return false };
        let Some(SlidPlace { fraction, xy, p, .. }) = self.part_of_slide(node, &before, &best, LOCAL_SEARCH.sweep_share) else {
            return false;
        };
        let n = node as usize;
        (self.triangulation.xy[n], self.triangulation.p[n], self.triangulation.along[n]) = (xy, p, fraction);
        true
    }
}
