//! Triangles that break a limit divided, and lengths squeezed where that does not do.

use crate::base::fault::Result;
use crate::base::job::{self, Job};
use crate::mesh::tri::optimize::repair::{Keep, Plan, Worth};
use crate::mesh::tri::optimize::{LimitCheck, MeshOptimizer};
use crate::mesh::tri::pending::Pending;

/// Divisions of triangles that break a limit.
const DIVISIONS: usize = 64;
/// Divisions before lengths are squeezed where a limit is still broken: what is mended there would break it again and again.
const PATIENCE: usize = 2;
/// Divisions after which nothing is mended that would break a limit.
const TOO_OFTEN: usize = 16;
/// What lengths are squeezed by.
const SQUEEZE: f64 = 0.93;
/// What is wanted less of the quality while more than one triangle in so many breaks a limit.
const ROUGH: f64 = 0.05;
const FEW_DIVISOR: usize = 200;
/// One triangle in so many may be divided; where more break a limit, the lengths were wrong.
const MANY: usize = 12;

impl<'a> MeshOptimizer<'a> {
    /// Triangles that break a limit, given those that did when it was looked at last.
    pub fn broken(&mut self, limit_check: &dyn LimitCheck, before: &[u32]) -> Vec<u32> {
        let nodes = self.unseen.take();
        let mut some = self.triangles_at(&nodes);
        some.extend(before.iter().filter(|t| self.triangulation.alive(**t)));
        some.sort_unstable();
        some.dedup();
        limit_check.broken(&self.triangulation, &some)
    }

    /// Whether so few triangles break a limit that dividing them will do.
    pub fn are_few(&self, broken: &[u32]) -> bool {
        broken.len() * MANY <= self.triangulation.tri.len()
    }

    /// Puts nodes into triangles that break a limit until none does, or too many do; what is left of `bad`.
    ///
    /// Where changes can be asked about ahead, only rough triangles are mended while many are divided, for what mending breaks has
    /// to be divided again; when all keep their limits, the others are mended so that none breaks one anew.
    pub fn divide(&mut self, limit_check: &'a dyn LimitCheck, mut bad: Vec<u32>, job: &Job) -> Result<Vec<u32>> {
        let (wanted, mut settled) = (self.settings.wanted, false);
        for round in 0..DIVISIONS {
            bad = self.broken(limit_check, &bad);
            if bad.is_empty() && limit_check.foresees() && !settled && self.settings.smooth > 0 {
                settled = true;
                (self.limit_check, self.settings.wanted) = (Some(limit_check), wanted);
                self.changed = Pending::all(self.triangulation.p.len());
                self.repair_last(job)?;
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
                if round >= PATIENCE {
                    self.squeeze(t);
                }
                divided |= self.split(t);
            }
            if !divided {
                break;
            }
            self.flip_all();
            let rough = limit_check.foresees() && round > 0 && bad.len() * FEW_DIVISOR > self.triangulation.tri.len();
            self.settings.wanted = if rough { wanted - ROUGH } else { wanted };
            // What goes to and fro is mended within the limits from now on.
            if round >= TOO_OFTEN && limit_check.foresees() && self.limit_check.is_none() {
                self.limit_check = Some(limit_check);
            }
            self.repair();
            job.go_on()?;
        }
        Ok(bad)
    }

    /// Lengths wanted at the corners of a triangle are a little shorter from now on.
    fn squeeze(&mut self, t: u32) {
        for n in self.triangulation.tri[t as usize].map(|n| n as usize) {
            self.tried.change(n as u32);
            self.squeezed[n] *= SQUEEZE;
            self.triangulation.size[n] *= SQUEEZE;
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
                .and_then(|()| self.plan(&patch, Keep::New, Worth::ANY));
            let made = match plan {
                Some((worst, Plan::Star(star, node))) if worst > 0.0 => {
                    self.restar(&patch, node, &star);
                    true
                }
                _ => false,
            };
            self.patch = patch;
            if made {
                return true;
            }
        }
        false
    }
}
