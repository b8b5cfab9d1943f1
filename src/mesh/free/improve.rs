//! Better triangles: flips, smoothing on the surface, and patches made anew with a node more or less.
//!
//! Every change keeps the triangles right side up in the chart and does not make the worst of those it touches worse
//! [Freitag 1997].

use glam::{DVec2, DVec3};

use super::ground::{Field, Ground, foot_near};
use super::pending::Pending;
use super::shape::{Rim, Star, quality};
use super::web::{Patch, Ring, Web};
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::tolerance::PARALLEL;
use crate::base::triangulate_points::NO_TRIANGLE;

/// How the improvement is done.
#[derive(Clone, Copy, Debug)]
pub struct Care {
    /// Rounds of smoothing.
    pub smooth: usize,
    /// Triangles below this quality are worked on.
    pub wanted: f64,
    /// Longest edge over wanted length.
    pub longest: f64,
}

/// A move below this share of the wanted length ends the smoothing of a node.
const STILL: f64 = 0.005;
/// A node whose triangles are all at least this good is left where it is.
const FINE: f64 = 0.9999;
/// What a change must gain.
const GAIN: f64 = 0.001;
/// Share of the quality that is there which a first guess must have to be searched on.
const HOPE: f64 = 0.6;
/// Divisions of triangles that break a limit.
const DIVISIONS: usize = 64;
/// Divisions before lengths are squeezed where a limit is still broken: what is mended there would break it again and again.
const PATIENCE: usize = 2;
/// What lengths are squeezed by.
const SQUEEZE: f64 = 0.93;
/// One triangle in so many may be divided; where more break a limit, the lengths were wrong.
const MANY: usize = 12;
/// Rounds of work on bad triangles.
const ROUNDS: usize = 6;

/// Those of some triangles of a web that break a limit; all others are as they were when it was asked last.
pub type Broken<'a> = dyn Fn(&Web, &[u32]) -> Vec<u32> + 'a;

/// A web being improved.
pub struct Gardener<'a> {
    /// The triangles.
    pub web: Web,
    /// Their surface.
    pub ground: &'a dyn Ground,
    /// Wanted lengths.
    pub field: &'a dyn Field,
    /// How.
    pub care: Care,
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
}

impl<'a> Gardener<'a> {
    /// Takes a web.
    pub fn new(web: Web, ground: &'a dyn Ground, field: &'a dyn Field, care: Care) -> Self {
        let all = Pending::all(web.p.len());
        let squeezed = vec![1.0; web.p.len()];
        Self {
            web,
            ground,
            field,
            care,
            ring: Ring::default(),
            rim: Rim::default(),
            patch: Patch::default(),
            active: all.clone(),
            moved: all.clone(),
            changed: all.clone(),
            unseen: all,
            squeezed,
        }
    }

    /// The first flips and rounds of smoothing: from here on nodes hardly move.
    pub fn settle(&mut self) {
        self.flip_all();
        if self.care.smooth > 0 {
            self.smooth(self.care.smooth);
            self.flip_all();
            // What still moves a little is left; what is mended wakes its neighbours.
            self.active.clear();
        }
    }

    /// Triangles that break a limit, given those that did when it was looked at last.
    pub fn broken(&mut self, broken: &Broken, before: &[u32]) -> Vec<u32> {
        let nodes = self.unseen.take();
        let mut some = self.triangles_at(&nodes);
        some.extend(before.iter().filter(|t| self.web.alive(**t)));
        some.sort_unstable();
        some.dedup();
        broken(&self.web, &some)
    }

    /// Whether so few triangles break a limit that dividing them will do.
    pub fn are_few(&self, broken: &[u32]) -> bool {
        broken.len() * MANY <= self.web.tri.len()
    }

    /// Triangles at some nodes, ascending.
    fn triangles_at(&mut self, nodes: &[u32]) -> Vec<u32> {
        let n = self.web.tri.len() as u32;
        if 2 * nodes.len() > self.web.p.len() {
            return (0..n).filter(|t| self.web.alive(*t)).collect();
        }
        let mut found = Vec::with_capacity(6 * nodes.len());
        for node in nodes {
            self.web.ring(*node, &mut self.ring);
            found.extend_from_slice(&self.ring.tri);
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Works on bad triangles, after [`Gardener::settle`].
    pub fn improve(&mut self, job: &Job) -> Result<()> {
        if self.care.smooth == 0 {
            return Ok(());
        }
        for _ in 0..ROUNDS {
            job.go_on()?;
            if self.mend() == 0 {
                break;
            }
            self.smooth(self.care.smooth.min(4));
            self.flip_all();
        }
        self.mend();
        Ok(())
    }

    /// Puts nodes into triangles that break a limit until none does, or too many do; what is left of `bad`.
    pub fn divide(&mut self, broken: &Broken, mut bad: Vec<u32>, job: &Job) -> Result<Vec<u32>> {
        for round in 0..DIVISIONS {
            bad = self.broken(broken, &bad);
            if bad.is_empty() || !self.are_few(&bad) {
                break;
            }
            let mut divided = false;
            for &t in &bad {
                if !self.web.alive(t) {
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
            self.mend();
            job.go_on()?;
        }
        Ok(bad)
    }

    /// Lengths wanted at the corners of a triangle are a little shorter from now on.
    fn squeeze(&mut self, t: u32) {
        for n in self.web.tri[t as usize].map(|n| n as usize) {
            self.squeezed[n] *= SQUEEZE;
            self.web.size[n] *= SQUEEZE;
        }
    }

    /// What lengths are squeezed by among some nodes.
    fn squeezed(&self, among: &[u32]) -> f64 {
        among.iter().map(|n| self.squeezed[*n as usize]).sum::<f64>() / among.len() as f64
    }

    /// A patch becomes the star of a node inside it, or of a new one.
    fn restar(&mut self, patch: &Patch, node: Option<u32>, star: &Star) {
        let squeezed = self.squeezed(&patch.rim);
        let node = self.web.restar(patch, node, star, self.field.size(star.xy, star.p) * squeezed);
        self.wake_patch(patch);
        self.squeezed[node as usize] = squeezed;
    }

    /// A node more in a triangle and its neighbour across the longest free side; whether there is room for one.
    fn split(&mut self, t: u32) -> bool {
        let c = self.web.tri[t as usize];
        let length = |k: usize| self.web.p[c[(k + 1) % 3] as usize].distance(self.web.p[c[(k + 2) % 3] as usize]);
        let free = |k: &usize| self.web.locked[t as usize] >> k & 1 == 0;
        let mut sides: Vec<usize> = (0..3).filter(free).collect();
        sides.sort_by(|a, b| length(*b).total_cmp(&length(*a)).then(a.cmp(b)));
        for k in sides {
            let mut patch = std::mem::take(&mut self.patch);
            let plan = self
                .web
                .patch(&[t, self.web.across[t as usize][k]], &mut patch)
                .and_then(|()| self.plan(&patch, Keep::New, f64::NEG_INFINITY));
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

    /// The nodes of a patch made anew may have to move.
    fn wake_patch(&mut self, patch: &Patch) {
        self.squeezed.resize(self.web.p.len(), 1.0);
        patch.rim.iter().chain(&patch.inner).for_each(|n| self.touch(*n));
    }

    /// Flips every free side whose opposite angles in space exceed a half turn together.
    pub fn flip_all(&mut self) {
        let moved = self.moved.take();
        let mut open = self.triangles_at(&moved);
        open.reverse();
        let mut left = 4 * self.web.tri.len() + 64;
        while let Some(t) = open.pop() {
            if !self.web.alive(t) {
                continue;
            }
            for k in 0..3 {
                let other = self.web.across[t as usize][k];
                if left > 0 && self.wants_flip(t, k) {
                    left -= 1;
                    self.web.flip(t, k);
                    open.push(other);
                    open.push(t);
                    self.wake(t);
                    self.wake(other);
                    break;
                }
            }
        }
    }

    /// The nodes of a triangle may have to move.
    fn wake(&mut self, t: u32) {
        for n in self.web.tri[t as usize] {
            self.active.add(n);
            self.changed.add(n);
            self.unseen.add(n);
        }
    }

    fn quad(&self, t: u32, k: usize) -> Option<[u32; 4]> {
        let web = &self.web;
        if web.locked[t as usize] >> k & 1 == 1 {
            return None;
        }
        let other = web.across[t as usize][k];
        if other == NO_TRIANGLE {
            return None;
        }
        let c = web.tri[t as usize];
        let o = web.tri[other as usize];
        let (a, b, d) = (c[k], c[(k + 1) % 3], c[(k + 2) % 3]);
        let tip = o.iter().copied().find(|n| *n != b && *n != d)?;
        Some([a, b, tip, d])
    }

    /// Whether the chart allows the flip.
    fn convex(&self, [a, b, c, d]: [u32; 4]) -> bool {
        let xy = |n: u32| self.web.xy[n as usize];
        super::outline::area2(xy(a), xy(b), xy(c)) > 0.0 && super::outline::area2(xy(a), xy(c), xy(d)) > 0.0
    }

    fn wants_flip(&self, t: u32, k: usize) -> bool {
        let Some(quad) = self.quad(t, k) else { return false };
        let [a, b, c, d] = quad.map(|n| self.web.p[n as usize]);
        let cot = |tip: DVec3, x: DVec3, y: DVec3| {
            let (x, y) = (x - tip, y - tip);
            x.dot(y) / x.cross(y).length().max(f64::MIN_POSITIVE)
        };
        cot(a, b, d) + cot(c, b, d) < -PARALLEL && self.convex(quad)
    }

    /// Moves free nodes that wait towards the area-weighted mean of their triangles' centroids, and in the next round their
    /// neighbours too.
    pub fn smooth(&mut self, rounds: usize) {
        for _ in 0..rounds {
            let mut moved = false;
            for node in self.active.take() {
                if !self.web.is_free(node) || self.web.at[node as usize] == NO_TRIANGLE {
                    continue;
                }
                if self.relax(node) {
                    moved = true;
                    self.ring.node.iter().for_each(|n| self.active.add(*n));
                }
            }
            if !moved {
                return;
            }
        }
    }

    fn fill_rim(&mut self, node: u32) {
        let web = &self.web;
        web.ring(node, &mut self.ring);
        self.rim.fill(self.ring.node.iter().map(|n| (web.p[*n as usize], web.xy[*n as usize])));
        self.rim.longest = web.size[node as usize] * self.care.longest;
    }

    /// One step of one node; whether it moved worth mentioning.
    fn relax(&mut self, node: u32) -> bool {
        self.fill_rim(node);
        let here = self.web.p[node as usize];
        let before = self.rim.worst(self.web.xy[node as usize], here);
        if before > FINE {
            return false;
        }
        let xy = self.web.xy[node as usize];
        let (mut sum, mut place, mut weights) = (DVec3::ZERO, DVec2::ZERO, 0.0);
        let (points, places) = (self.rim.points(), self.rim.places());
        let n = points.len();
        for i in 0..n {
            let j = if i + 1 < n { i + 1 } else { 0 };
            let (a, b) = (points[i], points[j]);
            let area = (a - here).cross(b - here).length();
            let size = (self.web.size[self.ring.node[i] as usize] + self.web.size[self.ring.node[j] as usize]) * 0.5;
            let weight = area / (size * size * size * size);
            sum += (here + a + b) * weight;
            place += (xy + places[i] + places[j]) * weight;
            weights += weight;
        }
        let size = self.web.size[node as usize];
        let wish = sum / (3.0 * weights) - here;
        // The same mean in the chart is nearly the foot of the one in space.
        let way = place / (3.0 * weights) - xy;
        let mut share = 1.0;
        for _ in 0..3 {
            let step = wish * share;
            if step.length() < STILL * size {
                return false;
            }
            let (xy, spot) = foot_near(self.ground, self.ground.clamp(xy + way * share), here + step, step.length());
            let p = spot.p;
            if self.rim.worst(xy, p) >= before.min(FINE) {
                self.place(node, xy, p);
                return true;
            }
            share *= 0.4;
        }
        false
    }

    fn place(&mut self, node: u32, xy: DVec2, p: DVec3) {
        self.web.xy[node as usize] = xy;
        self.web.p[node as usize] = p;
        self.web.size[node as usize] = self.field.size(xy, p) * self.squeezed[node as usize];
        self.touch(node);
    }

    /// A node or its triangles changed.
    fn touch(&mut self, node: u32) {
        self.active.add(node);
        self.moved.add(node);
        self.changed.add(node);
        self.unseen.add(node);
    }

    /// What a triangle is worth: its quality less what its longest side takes.
    fn worth(&self, t: u32) -> f64 {
        let c = self.web.tri[t as usize];
        let [a, b, d] = c.map(|n| self.web.p[n as usize]);
        let mut worth = quality(a, b, d);
        for k in 0..3 {
            let (i, j) = (c[k], c[(k + 1) % 3]);
            if self.web.is_free(i) || self.web.is_free(j) {
                let size = if self.web.is_free(i) { self.web.size[i as usize] } else { self.web.size[j as usize] };
                let length = self.web.p[i as usize].distance(self.web.p[j as usize]);
                worth = worth.min(quality(a, b, d) * (size * self.care.longest / length).min(1.0));
            }
        }
        worth
    }

    /// Works on triangles below the wanted quality, the worst first; how many changes were made.
    pub fn mend(&mut self) -> usize {
        let changed = self.changed.take();
        let mut bad: Vec<(f64, u32)> =
            self.triangles_at(&changed).into_iter().map(|t| (self.worth(t), t)).filter(|(q, _)| *q < self.care.wanted).collect();
        bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut changes = 0;
        for (_, t) in bad {
            for _ in 0..3 {
                if !self.web.alive(t) || self.worth(t) >= self.care.wanted || !self.mend_one(t) {
                    break;
                }
                changes += 1;
            }
        }
        changes
    }

    fn mend_one(&mut self, t: u32) -> bool {
        self.shift_corners(t) || self.flip_worse(t) || self.rebuild(t)
    }

    /// Moves a corner to where its worst triangle is best.
    fn shift_corners(&mut self, t: u32) -> bool {
        let mut any = false;
        for node in self.web.tri[t as usize] {
            if !self.web.is_free(node) {
                continue;
            }
            self.fill_rim(node);
            let (xy, p) = (self.web.xy[node as usize], self.web.p[node as usize]);
            let before = self.rim.worst(xy, p);
            let star = self.rim.best(self.ground, xy, p);
            if star.worst > before + GAIN {
                self.place(node, star.xy, star.p);
                any = true;
            }
        }
        any
    }

    /// Flips a side if the worse of the two triangles gets better.
    fn flip_worse(&mut self, t: u32) -> bool {
        for k in 0..3 {
            let Some(quad) = self.quad(t, k) else { continue };
            if !self.convex(quad) {
                continue;
            }
            let [a, b, c, d] = quad.map(|n| self.web.p[n as usize]);
            let before = quality(a, b, d).min(quality(c, d, b));
            let after = quality(a, b, c).min(quality(a, c, d));
            if after > before + GAIN {
                let other = self.web.across[t as usize][k];
                self.web.flip(t, k);
                self.wake(t);
                self.wake(other);
                return true;
            }
        }
        false
    }

    /// Tries patches round a triangle with a node more or less; takes the best.
    fn rebuild(&mut self, t: u32) -> bool {
        let mut best: Option<(f64, Patch, Plan)> = None;
        for (tri, keep) in self.candidates(t) {
            let before = tri.iter().map(|t| self.worth(*t)).fold(f64::INFINITY, f64::min);
            let mut patch = std::mem::take(&mut self.patch);
            let fits = self.web.patch(&tri, &mut patch);
            if fits.is_some()
                && let Some((after, plan)) = self.plan(&patch, keep, before * HOPE)
                && after > before + GAIN
                && best.as_ref().is_none_or(|b| after - before > b.0)
            {
                best = Some((after - before, patch.clone(), plan));
            }
            self.patch = patch;
        }
        let Some((_, patch, plan)) = best else { return false };
        match plan {
            Plan::Star(star, node) => self.restar(&patch, node, &star),
            Plan::Fan(k) => {
                self.web.refan(&patch, k);
                self.wake_patch(&patch);
            }
        }
        true
    }

    /// Sets of triangles round a triangle: two at each side for a new node, stars of corners without it, stars of two
    /// neighbouring corners as one.
    fn candidates(&mut self, t: u32) -> Vec<(Vec<u32>, Keep)> {
        let mut sets = Vec::new();
        let c = self.web.tri[t as usize];
        let across = self.web.across[t as usize];
        for (k, next) in across.into_iter().enumerate() {
            if self.web.locked[t as usize] >> k & 1 == 0 && next != NO_TRIANGLE {
                sets.push((vec![t, next], Keep::New));
            }
        }
        let open: Vec<u32> = (0..3).filter(|k| self.web.locked[t as usize] >> k & 1 == 0).map(|k| across[k]).collect();
        if open.len() >= 2 {
            sets.push((std::iter::once(t).chain(open).collect(), Keep::New));
        }
        for k in 0..3 {
            if let Some([_, _, tip, _]) = self.quad(t, k)
                && self.web.is_free(tip)
            {
                self.web.ring(tip, &mut self.ring);
                sets.push((self.ring.tri.iter().copied().chain([t]).collect(), Keep::One(tip)));
            }
        }
        for k in 0..3 {
            let (a, b) = (c[k], c[(k + 1) % 3]);
            if self.web.is_free(a) {
                self.web.ring(a, &mut self.ring);
                sets.push((self.ring.tri.clone(), Keep::None));
            }
            if self.web.is_free(a) && self.web.is_free(b) {
                self.web.ring(a, &mut self.ring);
                let mut tri = self.ring.tri.clone();
                self.web.ring(b, &mut self.ring);
                tri.extend(self.ring.tri.iter().filter(|t| !tri.contains(t)).copied().collect::<Vec<_>>());
                sets.push((tri, Keep::One(a.min(b))));
            }
        }
        sets
    }

    /// The best that can be made of a patch.
    fn plan(&mut self, patch: &Patch, keep: Keep, least: f64) -> Option<(f64, Plan)> {
        self.rim.fill(patch.rim.iter().map(|n| (self.web.p[*n as usize], self.web.xy[*n as usize])));
        if let Keep::None = keep {
            return self.best_fan(patch);
        }
        let (xy, p) = self.rim.middle();
        let xy = self.ground.clamp(xy);
        self.rim.longest = self.field.size(xy, p) * self.squeezed(&patch.rim) * self.care.longest;
        // A rim that is far too large or too small for one node is not searched for its best place.
        let p = self.ground.point(xy);
        if self.rim.worst(xy, p) < least {
            return None;
        }
        let star = self.rim.best(self.ground, xy, p);
        let node = if let Keep::One(node) = keep { Some(node) } else { None };
        (star.worst > 0.0).then_some((star.worst, Plan::Star(star, node)))
    }

    /// The fan of the rim's node that gives the best worst triangle.
    fn best_fan(&self, patch: &Patch) -> Option<(f64, Plan)> {
        let n = patch.rim.len();
        let (p, xy) = (self.rim.points(), self.rim.places());
        let mut best: Option<(f64, usize)> = None;
        for k in 0..n {
            let mut worst = f64::INFINITY;
            for i in 1..n - 1 {
                let (a, b) = ((k + i) % n, (k + i + 1) % n);
                if super::outline::area2(xy[k], xy[a], xy[b]) <= 0.0 {
                    worst = -1.0;
                    break;
                }
                let far = p[k].distance(p[a]);
                let longest = self.web.size[patch.rim[a] as usize] * self.care.longest;
                let share = if i > 1 { (longest / far).min(1.0) } else { 1.0 };
                worst = worst.min(quality(p[k], p[a], p[b]) * share);
            }
            if worst > 0.0 && best.is_none_or(|b| worst > b.0) {
                best = Some((worst, k));
            }
        }
        best.map(|(worst, k)| (worst, Plan::Fan(k)))
    }
}

/// Which node a patch keeps.
#[derive(Clone, Copy)]
enum Keep {
    /// A new one in its middle.
    New,
    /// One of those inside.
    One(u32),
    /// None: a fan from its rim.
    None,
}

enum Plan {
    Star(Star, Option<u32>),
    Fan(usize),
}
