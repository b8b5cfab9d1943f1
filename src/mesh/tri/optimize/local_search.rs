//! The last bad triangles, where no single change helps: each change near one is tried, all nodes round it are moved together
//! after it, and what is best of all that stays [Freitag 1997].

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::{self, Job};
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::tri::optimize::MeshOptimizer;
use crate::mesh::tri::optimize::repair::{Plan, Worth};
use crate::mesh::tri::shape::Star;
use crate::mesh::tri::triangulation::Patch;

/// One triangle in so many is worked on; of small faces one in so many more, up to so many.
const RARE: usize = 8000;
const SMALL: (usize, usize) = (64, 8);
/// Sweeps over the nodes round a triangle, and those after which a change has to look like something.
const SWEEPS: usize = 10;
const FIRST: usize = 3;
/// Share of the way that a node goes in a sweep to where the worst sides want it.
const SHARE: f64 = 0.4;
/// Share of how bad a place is that may be left of it.
const LESS: f64 = 0.9;
/// How bad it may be after the first sweeps, over what it has to come below.
const MAX_START_RATIO: f64 = 3.0;

/// A change of the triangles.
enum Change {
    None,
    Flip(u32, usize),
    Star(Patch, Option<u32>, Star),
    Fan(Patch, usize),
}

/// Triangles round some nodes: the least they are worth, and how bad they are together.
#[derive(Clone, Copy)]
struct Sight {
    least: f64,
    bad: f64,
}

/// How bad a place is after a change, and where its free nodes are then.
struct Swept {
    bad: f64,
    places: Vec<(u32, DVec2, DVec3)>,
}

impl MeshOptimizer<'_> {
    /// Works on bad triangles, and then on the worst that are left.
    pub fn repair_last(&mut self, job: &Job) -> Result<()> {
        self.repair();
        if self.last(job)? > 0 {
            self.repair();
        }
        Ok(())
    }

    /// Works on the worst triangles below the wanted quality; how many places got better.
    fn last(&mut self, job: &Job) -> Result<usize> {
        let live = (0..self.triangulation.tri.len() as u32).filter(|t| self.triangulation.alive(*t));
        let mut bad: Vec<(f64, u32)> = live.map(|t| (self.worth(t), t)).filter(|(q, _)| *q < self.settings.wanted).collect();
        bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let n = self.triangulation.tri.len();
        bad.truncate(1 + (n / SMALL.0).min(SMALL.1) + n / RARE);
        let mut better = 0;
        for (_, t) in bad {
            job.go_on()?;
            let still = self.triangulation.alive(t) && self.worth(t) < self.settings.wanted;
            better += usize::from(still && self.try_all(t));
        }
        Ok(better)
    }

    fn try_all(&mut self, t: u32) -> bool {
        let corners = self.triangulation.tri[t as usize];
        let near = self.rings_of(&corners);
        let nodes = self.triangulation.nodes_of(&near);
        let all = self.rings_of(&nodes);
        let kept = self.triangulation.before(&all);
        let before = self.sight(&all);
        let mut best: Option<(usize, Swept)> = None;
        let changes = self.changes(t);
        for (k, change) in changes.iter().enumerate() {
            job::poll();
            let (nodes, _) = self.apply(change, &nodes);
            let most = best.as_ref().map_or(before.bad * LESS, |best| best.1.bad);
            if let Some(swept) = self.sweep(&nodes, (before, most)) {
                best = Some((k, swept));
            }
            self.triangulation.put_back(&kept);
        }
        let Some((k, Swept { places, .. })) = best else { return false };
        let (nodes, star) = self.apply(&changes[k], &nodes);
        self.squeezed.resize(self.triangulation.p.len(), 1.0);
        if let (Change::Star(patch, ..), Some(node)) = (&changes[k], star) {
            self.squeezed[node as usize] = self.squeezed(&patch.rim);
        }
        for (n, xy, p) in places {
            self.place(n, xy, p);
        }
        nodes.into_iter().for_each(|n| self.touch(n));
        true
    }

    fn sight(&self, some: &[u32]) -> Sight {
        some.iter().fold(Sight { least: f64::INFINITY, bad: 0.0 }, |sight, t| {
            let worth = self.worth(*t);
            let short = (1.0 - worth) * (1.0 - worth);
            Sight { least: sight.least.min(worth), bad: sight.bad + short * short * short * short }
        })
    }

    /// What may be done at a triangle and its neighbours.
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
            match self.plan(&patch, keep, Worth::ANY) {
                Some((_, Plan::Star(star, node))) => changes.push(Change::Star(patch, node, star)),
                Some((_, Plan::Fan(k))) => changes.push(Change::Fan(patch, k)),
                None => {}
            }
        }
        changes
    }

    /// Makes a change; the nodes of the place after it, and that of a star.
    fn apply(&mut self, change: &Change, nodes: &[u32]) -> (Vec<u32>, Option<u32>) {
        let (mut nodes, mut made) = (nodes.to_vec(), None);
        match change {
            Change::None => {}
            Change::Flip(t, k) => self.triangulation.flip(*t, *k),
            Change::Star(patch, node, star) => {
                let size = self.field.size(star.xy, star.p) * self.squeezed(&patch.rim);
                let new = self.triangulation.restar(patch, *node, star, size);
                nodes.push(new);
                made = Some(new);
            }
            Change::Fan(patch, k) => self.triangulation.refan(patch, *k),
        }
        nodes.retain(|n| self.triangulation.at[*n as usize] != NO_TRIANGLE);
        nodes.sort_unstable();
        nodes.dedup();
        (nodes, made)
    }

    /// Moves the nodes of a place together, time and again; how bad it was at its best and where they were then, where that is less than
    /// `most`, the worst triangle was worth no less than before, and all keep the limits.
    fn sweep(&mut self, nodes: &[u32], (before, most): (Sight, f64)) -> Option<Swept> {
        let all = self.rings_of(nodes);
        let (mut best, mut most): (Option<Swept>, f64) = (None, most);
        for round in 0..=SWEEPS {
            let now = self.sight(&all);
            if now.bad < most && now.least >= before.least && all.iter().all(|t| self.triangulation.chart_area(*t) > 0.0) {
                let free = nodes.iter().filter(|n| self.triangulation.is_free(**n));
                let places = free.map(|n| (*n, self.triangulation.xy[*n as usize], self.triangulation.p[*n as usize])).collect();
                best = Some(Swept { bad: now.bad, places });
                most = now.bad;
            }
            if round == SWEEPS || round == FIRST && now.bad > MAX_START_RATIO * most {
                break;
            }
            let mut moved = false;
            for &node in nodes {
                job::poll();
                if !self.triangulation.is_free(node) {
                    continue;
                }
                self.fill_rim(node);
                let (xy, p) = (self.triangulation.xy[node as usize], self.triangulation.p[node as usize]);
                self.rim.worst(xy, p);
                let Some(way) = self.chart_surface.spot(xy).step(self.rim.demand(p) * SHARE) else { continue };
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
        all.iter().all(|t| self.keeps(self.triangulation.tri[*t as usize], None)).then_some(best)
    }
}
