//! The last bad triangles, where no single change helps: each change near one is tried, all nodes round it are moved together
//! after it, and what is best of all that stays [Freitag 1997, §3: smoothing beside swaps].

use glam::{DVec2, DVec3};

use super::Gardener;
use super::mend::{Plan, Worth};
use crate::base::triangulate_points::NO_TRIANGLE;
use crate::mesh::free::shape::Star;
use crate::mesh::free::web::Patch;

/// One triangle in so many is worked on, and one more.
const RARE: usize = 8000;
/// Those below this share of the wanted quality.
const BAD: f64 = 1.0;
/// Sweeps over the nodes round a triangle, and those after which a change has to look like something.
const SWEEPS: usize = 10;
const FIRST: usize = 3;
/// Share of the way that a node goes in a sweep to where the worst sides want it.
const SHARE: f64 = 0.4;
/// Share of what is bad that must be left at most, and up to which more sweeps may help.
const LESS: f64 = 0.9;
const HOPE: f64 = 3.0;

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

impl Gardener<'_> {
    /// Works on the worst triangles; how many places got better.
    pub fn last(&mut self) -> usize {
        let live = (0..self.web.tri.len() as u32).filter(|t| self.web.alive(*t));
        let mut bad: Vec<(f64, u32)> = live.map(|t| (self.worth(t), t)).filter(|(q, _)| *q < BAD * self.care.wanted).collect();
        bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        bad.truncate(self.web.tri.len() / RARE + 8);
        let still = |of: &Self, t: u32| of.web.alive(t) && of.worth(t) < BAD * of.care.wanted;
        bad.into_iter().filter(|(_, t)| still(self, *t) && self.try_all(*t)).count()
    }

    fn try_all(&mut self, t: u32) -> bool {
        let corners = self.web.tri[t as usize];
        let near = self.triangles_at(&corners);
        let nodes = self.nodes_of(&near);
        let all = self.triangles_at(&nodes);
        let kept = self.web.before(&all);
        let before = self.sight(&all);
        let mut best: Option<(f64, usize, Vec<(u32, DVec2, DVec3)>)> = None;
        let changes = self.changes(t);
        for (k, change) in changes.iter().enumerate() {
            let nodes = self.apply(change, &nodes);
            let most = best.as_ref().map_or(before.bad * LESS, |best| best.0);
            if let Some((bad, places)) = self.sweep(&nodes, (before, most)) {
                best = Some((bad, k, places));
            }
            self.web.put_back(&kept);
        }
        let Some((_, k, places)) = best else { return false };
        let nodes = self.apply(&changes[k], &nodes);
        self.squeezed.resize(self.web.p.len(), 1.0);
        for (n, xy, p) in places {
            self.place(n, xy, p);
        }
        nodes.into_iter().for_each(|n| self.touch(n));
        true
    }

    /// The nodes of some triangles, ascending.
    fn nodes_of(&self, some: &[u32]) -> Vec<u32> {
        let mut nodes: Vec<u32> = some.iter().flat_map(|t| self.web.tri[*t as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
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
        let near = self.web.across[t as usize].into_iter().filter(|next| *next != NO_TRIANGLE);
        for t in std::iter::once(t).chain(near).collect::<Vec<_>>() {
            changes.extend((0..3).filter(|k| self.quad(t, *k).is_some_and(|quad| self.convex(quad))).map(|k| Change::Flip(t, k)));
        }
        for (tri, keep) in self.candidates(t) {
            let mut patch = Patch::default();
            if self.web.patch(&tri, &mut patch).is_none() {
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

    /// Makes a change; the nodes of the place after it.
    fn apply(&mut self, change: &Change, nodes: &[u32]) -> Vec<u32> {
        let mut nodes = nodes.to_vec();
        match change {
            Change::None => {}
            Change::Flip(t, k) => self.web.flip(*t, *k),
            Change::Star(patch, node, star) => {
                let size = self.field.size(star.xy, star.p) * self.squeezed(&patch.rim);
                let new = self.web.restar(patch, *node, star, size);
                nodes.push(new);
            }
            Change::Fan(patch, k) => self.web.refan(patch, *k),
        }
        nodes.retain(|n| self.web.at[*n as usize] != NO_TRIANGLE);
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Moves the nodes of a place together, as often as it helps; how bad it is then and where they are, where that is less than
    /// `most`, no triangle is worse than before, and all keep the limits.
    fn sweep(&mut self, nodes: &[u32], (before, most): (Sight, f64)) -> Option<(f64, Vec<(u32, DVec2, DVec3)>)> {
        let all = self.triangles_at(nodes);
        let mut best = None;
        let mut most = most;
        for round in 0..=SWEEPS {
            let now = self.sight(&all);
            if now.bad < most && now.least >= before.least && all.iter().all(|t| self.web.chart_area(*t) > 0.0) {
                let free = nodes.iter().filter(|n| self.web.is_free(**n));
                best = Some((now.bad, free.map(|n| (*n, self.web.xy[*n as usize], self.web.p[*n as usize])).collect::<Vec<_>>()));
                most = now.bad;
            }
            if round == SWEEPS || round == FIRST && now.bad > HOPE * most {
                break;
            }
            for &node in nodes {
                if !self.web.is_free(node) {
                    continue;
                }
                self.fill_rim(node);
                let (xy, p) = (self.web.xy[node as usize], self.web.p[node as usize]);
                self.rim.worst(xy, p);
                let Some(way) = self.ground.spot(xy).step(self.rim.wish(p) * SHARE) else { continue };
                let xy = self.ground.clamp(xy + way);
                let p = self.ground.point(xy);
                if self.rim.worst(xy, p) > 0.0 {
                    (self.web.xy[node as usize], self.web.p[node as usize]) = (xy, p);
                }
            }
        }
        let (bad, places) = best?;
        for (n, xy, p) in &places {
            (self.web.xy[*n as usize], self.web.p[*n as usize]) = (*xy, *p);
        }
        all.iter().all(|t| self.keeps(self.web.tri[*t as usize], None)).then_some((bad, places))
    }
}
