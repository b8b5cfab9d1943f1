//! Triangles that exceed a limit divided, and lengths lowered where that is not sufficient.

use crate::base::fault::Result;
use crate::base::job::{self, Job};
use crate::base::work;
use crate::mesh::tri::optimize::repair::{Keep, PatchPlan, PlanThreshold};
use crate::mesh::tri::optimize::{LimitCheck, MeshOptimizer};
use crate::mesh::tri::optimize_settings::DIVISION;
use crate::mesh::tri::pending::Pending;

impl<'a> MeshOptimizer<'a> {
    /// Triangles that exceed a limit, given those that did at the last check.
    pub fn broken(&mut self, limit_check: &dyn LimitCheck, before: &[u32]) -> Vec<u32> {
        let nodes = self.unseen.take();
        let mut some = self.triangles_at(&nodes);
        some.extend(before.iter().filter(|t| self.triangulation.alive(**t)));
        some.sort_unstable();
        some.dedup();
        limit_check.broken(&self.triangulation, &some)
    }

    /// Whether so few triangles exceed a limit that dividing them is sufficient.
    pub fn are_few(&self, broken: &[u32]) -> bool {
        broken.len() * DIVISION.many <= self.triangulation.tri.len()
    }

    /// Puts nodes into triangles that exceed a limit until none does, or too many do; what is left of `bad`.
    ///
    /// Where changes can be checked before they are made, only rough triangles are repaired while many are divided, since repaired ones that
    /// exceed a limit have to be divided again; when all keep their limits, the others are repaired within the limits, and the worst are searched.
    ///
    /// Where border nodes may slide, all that is done once more with these; the triangles from before stay where they are better, in their worst
    /// quality, their least angle or altogether.
    pub fn divide(&mut self, limit_check: &'a dyn LimitCheck, bad: Vec<u32>, job: &Job) -> Result<Vec<u32>> {
        let bad = self.divide_rounds(limit_check, bad, job)?;
        if !bad.is_empty() || !self.wants_sliding() {
            return Ok(bad);
        }
        let (before, quality, sharpest) = (self.triangulation.clone(), self.shape_quality(), self.sharpest());
        self.start_sliding();
        // Rounds and searches are bounded, and no face is to be given up for better shapes: this is not charged.
        let bad = work::uncharged(|| self.divide_rounds(limit_check, bad, job))?;
        if !bad.is_empty() || self.sharpest() > sharpest || !self.shape_quality().is_no_worse_than(&quality) {
            self.go_back(before);
        }
        Ok(Vec::new())
    }

    fn divide_rounds(&mut self, limit_check: &'a dyn LimitCheck, mut bad: Vec<u32>, job: &Job) -> Result<Vec<u32>> {
        let (wanted, mut settled) = (self.settings.min_quality, false);
        let mut unsearched = None;
        for round in 0..DIVISION.max_rounds {
            bad = self.broken(limit_check, &bad);
            let per_triangle = limit_check.is_per_triangle();
            let is_searched = per_triangle || self.settings.searches.by_shape;
            if bad.is_empty() && is_searched && !settled && self.settings.smoothing_rounds > 0 {
                settled = true;
                self.settings.min_quality = wanted;
                if per_triangle {
                    self.reserve_work();
                    self.limit_check = Some(limit_check);
                    self.changed = Pending::all(self.triangulation.p.len());
                } else {
                    unsearched = Some((self.triangulation.clone(), self.shape_quality()));
                }
                self.repair_last(self.settings.searches, job)?;
                bad = self.broken(limit_check, &bad);
            }
            if bad.is_empty() || !self.are_few(&bad) {
                break;
            }
            let mut divided = false;
            for &t in &bad {
                job::poll();
                if !self.triangulation.alive(t) {
                    continue;
                }
                if round >= DIVISION.rounds_before_lowering {
                    self.lower_sizes(t);
                }
                divided |= self.split(t);
            }
            if !divided {
                break;
            }
            self.flip_all();
            let rough = per_triangle && round > 0 && bad.len() * DIVISION.few > self.triangulation.tri.len();
            self.settings.min_quality = if rough { wanted - DIVISION.rough_reduction } else { wanted };
            // Triangles that alternate are repaired within the limits from now on.
            if round >= DIVISION.rounds_before_strict_repair && per_triangle && self.limit_check.is_none() {
                self.limit_check = Some(limit_check);
            }
            self.repair();
            job.go_on()?;
        }
        if let Some((triangulation, quality)) = unsearched
            && (!bad.is_empty() || !self.shape_quality().is_no_worse_than(&quality))
        {
            // What a search made better was lost when its long sides were divided.
            self.go_back(triangulation);
            bad = Vec::new();
        }
        Ok(bad)
    }

    /// Lowers the lengths wanted at the corners of a triangle.
    fn lower_sizes(&mut self, t: u32) {
        for n in self.triangulation.tri[t as usize].map(|n| n as usize) {
            self.failed_repairs.change(n as u32);
            self.size_factor[n] *= DIVISION.size_factor;
            self.triangulation.size[n] *= DIVISION.size_factor;
        }
    }

    /// A node more in a triangle and its neighbour across the longest free side; whether there is room for one.
    fn split(&mut self, t: u32) -> bool {
        let c = self.triangulation.tri[t as usize];
        let length = |k: usize| self.triangulation.p[c[(k + 1) % 3] as usize].distance(self.triangulation.p[c[(k + 2) % 3] as usize]);
        let free = |k: &usize| self.triangulation.locked[t as usize] >> k & 1 == 0;
        let mut sides: Vec<usize> = (0..3).filter(free).collect();
        sides.sort_by(|a, b| length(*b).total_cmp(&length(*a)).then(a.cmp(b)));
        for k in sides {
            let mut patch = std::mem::take(&mut self.patch);
            let plan = self
                .triangulation
                .patch(&[t, self.triangulation.across[t as usize][k]], &mut patch)
                .and_then(|()| self.plan(&patch, Keep::New, PlanThreshold::ANY));
            let is_split = match plan {
                Some((worst, PatchPlan::Star(star, node))) if worst > 0.0 => {
                    self.restar(&patch, node, &star);
                    true
                }
                _ => false,
            };
            self.patch = patch;
            if is_split {
                return true;
            }
        }
        false
    }
}
