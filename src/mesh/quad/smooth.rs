//! Nodes of quads moved over their surface: to area-weighted centroids, and where elements are bad to where the worst of
//! those round the node is best. No move makes the worst one worse [Freitag 1997].

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::work;
use crate::mesh::chart::halves::NONE;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField, foot_near, foot_spot};
use crate::mesh::quad::net::{Net, least_quality};
use crate::mesh::quad::settings::SMOOTHING;

/// Length of the side between two nodes over what is allowed there.
pub type Over<'a> = dyn Fn(&Net, usize, usize) -> f64 + 'a;

/// The quality of some faces of a net together.
pub type Score<'a> = dyn Fn(&Net, &[u32]) -> f64 + 'a;

/// A place of a node.
#[derive(Clone, Copy)]
struct NodePosition {
    xy: DVec2,
    p: DVec3,
    normal: DVec3,
}

/// Moves the nodes of a net.
pub struct Smoother<'a> {
    /// The net.
    pub net: &'a mut Net,
    chart_surface: &'a dyn ParametricSurface,
    field: &'a dyn SizeField,
    /// Faces round each node: from `first[n]` to the next one.
    first: Vec<u32>,
    of: Vec<u32>,
    /// Nodes that may have to move.
    active: Vec<bool>,
    /// Nodes that moved: elements round others are unchanged.
    fresh: Vec<bool>,
}

impl<'a> Smoother<'a> {
    /// Takes a net.
    pub fn new(net: &'a mut Net, chart_surface: &'a dyn ParametricSurface, field: &'a dyn SizeField) -> Self {
        let n = net.p.len();
        let mut first = vec![0; n + 1];
        let corners =
            || net.face.iter().enumerate().flat_map(|(f, c)| c.iter().filter(|n| **n != NONE).map(move |n| (*n as usize, f as u32)));
        corners().for_each(|(node, _)| first[node + 1] += 1);
        (0..n).for_each(|k| first[k + 1] += first[k]);
        let (mut of, mut next) = (vec![0; first[n] as usize], first.clone());
        for (node, f) in corners() {
            of[next[node] as usize] = f;
            next[node] += 1;
        }
        let (active, fresh) = (vec![true; n], vec![true; n]);
        Self { net, chart_surface, field, first, of, active, fresh }
    }

    /// Only these nodes and those round them may have to move.
    pub fn only(mut self, nodes: &[u32]) -> Self {
        self.active.fill(false);
        self.fresh.fill(false);
        nodes.iter().for_each(|n| self.wake(*n as usize));
        self
    }

    /// Faces round a node, in no order round it.
    pub fn faces(&self, node: usize) -> &[u32] {
        &self.of[self.first[node] as usize..self.first[node + 1] as usize]
    }

    /// Number of faces round a node.
    pub fn valence(&self, node: usize) -> usize {
        self.faces(node).len()
    }

    /// The least quality round a node.
    fn worst(&self, node: usize) -> f64 {
        least_quality(self.net, self.faces(node))
    }

    fn place(&self, node: usize) -> NodePosition {
        NodePosition { xy: self.net.xy[node], p: self.net.p[node], normal: self.net.normal[node] }
    }

    fn put(&mut self, node: usize, place: NodePosition) {
        (self.net.xy[node], self.net.p[node], self.net.normal[node]) = (place.xy, place.p, place.normal);
    }

    /// The foot of a point near a node.
    fn foot(&self, node: usize, p: DVec3) -> NodePosition {
        let (xy, spot) = foot_spot(self.chart_surface, self.net.xy[node], p);
        NodePosition { xy, p: spot.p, normal: spot.normal() }
    }

    /// Completes the move of a node.
    fn settle(&mut self, node: usize) {
        self.net.size[node] = self.field.size(self.net.xy[node], self.net.p[node]);
        self.wake(node);
    }

    /// A node changed: those round it may have to move.
    fn wake(&mut self, node: usize) {
        self.fresh[node] = true;
        for k in self.first[node]..self.first[node + 1] {
            for n in self.net.face[self.of[k as usize] as usize] {
                if n != NONE {
                    self.active[n as usize] = true;
                }
            }
        }
    }

    /// Rounds of moves towards centroids until all nodes are still.
    pub fn smooth(&mut self, rounds: usize, job: &Job) -> Result<()> {
        for _ in 0..rounds {
            let mut moved = false;
            for node in self.net.fixed as usize..self.net.p.len() {
                if node % SMOOTHING.nodes_per_check == 0 {
                    job.go_on()?;
                }
                if std::mem::take(&mut self.active[node]) && self.relax(node) {
                    moved = true;
                    self.settle(node);
                }
            }
            if !moved {
                break;
            }
        }
        Ok(())
    }

    /// The area-weighted mean of the centroids round a node, with the same mean in the chart; elements where lengths are short
    /// weigh more.
    fn centre(&self, node: usize) -> Option<(DVec3, DVec2)> {
        let (mut sum, mut place, mut weights) = (DVec3::ZERO, DVec2::ZERO, 0.0);
        let (here, xy) = (self.net.p[node], self.net.xy[node]);
        for f in self.faces(node) {
            let c = self.net.corners(*f as usize);
            let n = c.len();
            let k = c.iter().position(|c| *c as usize == node)?;
            let at = |i: usize| c[(k + i) % n] as usize;
            let (p, of) = (&self.net.p, &self.net.xy);
            let size = c.iter().map(|c| self.net.size[*c as usize]).sum::<f64>() / n as f64;
            let share = 1.0 / (size * size * size * size);
            for i in 1..n - 1 {
                let (a, b) = (at(i), at(i + 1));
                let weight = (p[a] - here).cross(p[b] - here).length() * share;
                sum += (here + p[a] + p[b]) * weight;
                place += (xy + of[a] + of[b]) * weight;
                weights += weight;
            }
        }
        (weights > 0.0).then(|| (sum / (3.0 * weights), place / (3.0 * weights)))
    }

    /// One step of one node; whether it moved by more than the least move.
    fn relax(&mut self, node: usize) -> bool {
        let Some((demand, to)) = self.centre(node) else { return false };
        let start = self.place(node);
        let step = demand - start.p;
        let still = SMOOTHING.min_move * self.net.size[node];
        if step.length_squared() < still * still {
            return false;
        }
        let mut before = None;
        let mut share = 1.0;
        for _ in 0..3 {
            // The mean in the chart is nearly the foot of the one in space.
            let guess = self.chart_surface.clamp(start.xy + (to - start.xy) * share);
            let (xy, spot) = foot_near(self.chart_surface, guess, start.p + step * share, step.length() * share);
            self.put(node, NodePosition { xy, p: spot.p, normal: spot.normal() });
            let after = self.worst(node);
            if after >= SMOOTHING.min_smoothed_quality {
                return true;
            }
            let place = self.place(node);
            self.put(node, start);
            if after >= *before.get_or_insert_with(|| self.worst(node)) {
                self.put(node, place);
                return true;
            }
            share *= 0.4;
        }
        false
    }

    /// Shortens long sides at the cost of their neighbours: nodes move towards those they are too far from, while elements keep a least
    /// quality. `over` is the length of a side over what is allowed, of two places.
    pub fn even_out(&mut self, over: &Over, rounds: usize, job: &Job) -> Result<()> {
        self.active.copy_from_slice(&self.fresh);
        for _ in 0..rounds {
            let mut moved = false;
            for node in self.net.fixed as usize..self.net.p.len() {
                if node % SMOOTHING.nodes_per_check == 0 {
                    job.go_on()?;
                }
                if std::mem::take(&mut self.active[node]) && self.pull(node, over) {
                    moved = true;
                    self.settle(node);
                }
            }
            if !moved {
                break;
            }
        }
        Ok(())
    }

    /// Ends of the sides at a node.
    fn neighbours(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        self.faces(node).iter().filter_map(move |f| {
            let c = self.net.corners(*f as usize);
            c.iter().position(|c| *c as usize == node).map(|k| c[(k + 1) % c.len()] as usize)
        })
    }

    /// The shortest side at a node.
    fn shortest(&self, node: usize) -> f64 {
        self.neighbours(node).map(|other| self.net.p[node].distance(self.net.p[other])).fold(f64::INFINITY, f64::min)
    }

    /// One move of a node with a long side.
    fn pull(&mut self, node: usize, over: &Over) -> bool {
        let tension = |net: &Net, other: usize| over(net, node, other);
        let (mut sum, mut weights, mut most) = (DVec3::ZERO, 0.0, 0.0_f64);
        for other in self.neighbours(node) {
            let t = tension(self.net, other);
            let weight = t * t * t * t * t * t;
            most = most.max(t);
            sum += self.net.p[other] * weight;
            weights += weight;
        }
        if most <= SMOOTHING.max_side_ratio {
            return false;
        }
        let strain =
            |this: &Self| this.neighbours(node).map(|other| tension(this.net, other)).map(|t| t * t * t * t * t * t * t * t).sum::<f64>();
        let (start, before, worst) = (self.place(node), strain(self), self.worst(node));
        let short = self.shortest(node).min(SMOOTHING.min_side * self.net.size[node]);
        let mut step = sum / weights - start.p;
        for _ in 0..3 {
            let place = self.foot(node, start.p + step);
            self.put(node, place);
            if strain(self) < before * (1.0 - SMOOTHING.min_gain)
                && self.worst(node) >= worst.min(SMOOTHING.min_evened_quality)
                && self.shortest(node) >= short
            {
                return true;
            }
            step *= 0.5;
        }
        self.put(node, start);
        false
    }

    /// Moves corners of elements below `wanted` to where the worst element round them is best, the worst ones first, for so
    /// many rounds at most.
    pub fn repair(&mut self, wanted: f64, rounds: usize, job: &Job) -> Result<()> {
        // Nodes round which nothing moved since they were tried: they would stay where they are once more.
        let mut tried = vec![false; self.net.p.len()];
        for _ in 0..rounds {
            let changed = |f: &usize| self.net.corners(*f).iter().any(|n| self.fresh[*n as usize]);
            let quality = (0..self.net.face.len()).filter(changed).map(|f| (self.net.quality(f), f));
            let mut bad: Vec<(f64, usize)> = quality.filter(|(q, _)| *q < wanted).collect();
            bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let mut gained = false;
            for (_, f) in bad {
                job.go_on()?;
                for n in self.net.face[f] {
                    if n == NONE || n < self.net.fixed || tried[n as usize] || self.net.quality(f) >= wanted {
                        continue;
                    }
                    let before = self.net.xy[n as usize];
                    gained |= self.climb(n as usize, &least_quality, f64::INFINITY);
                    tried[n as usize] = true;
                    if self.net.xy[n as usize] != before {
                        let round = self.faces(n as usize).iter().flat_map(|f| self.net.corners(*f as usize));
                        round.for_each(|n| tried[*n as usize] = false);
                    }
                }
            }
            if !gained {
                break;
            }
        }
        Ok(())
    }

    /// Searches round a node for the place where the `score` of the faces round it is largest, or `enough`; whether it moved.
    pub fn climb(&mut self, node: usize, score: &Score, enough: f64) -> bool {
        work::spend(SMOOTHING.search_work);
        let size = self.mean_side(node);
        let start = score(self.net, self.faces(node));
        let (mut best, mut place) = (start, self.place(node));
        let mut reach = SMOOTHING.search_steps.end;
        while reach > SMOOTHING.search_steps.start && best < enough {
            let (ahead, aside) = self.frame(node, place);
            let (mut found, short) = (false, self.shortest(node).min(SMOOTHING.min_side * size));
            for (x, y) in EIGHT {
                let trial = self.foot(node, place.p + (ahead * x + aside * y) * (reach * size));
                self.put(node, trial);
                let now = score(self.net, self.faces(node));
                if now > best + SMOOTHING.min_gain * reach && self.shortest(node) >= short {
                    (best, place, found) = (now, trial, true);
                    break;
                }
            }
            self.put(node, place);
            if !found {
                reach *= 0.5;
            }
        }
        if best > start + SMOOTHING.min_gain {
            self.settle(node);
        }
        best > start + SMOOTHING.min_gain
    }

    /// Two directions along the surface, the first towards a neighbour.
    fn frame(&self, node: usize, place: NodePosition) -> (DVec3, DVec3) {
        let normal = if place.normal == DVec3::ZERO { DVec3::Z } else { place.normal };
        let c = self.faces(node).first().map_or(&[][..], |f| self.net.corners(*f as usize));
        let next = c.iter().position(|c| *c as usize == node).map_or(node, |k| c[(k + 1) % c.len()] as usize);
        let ahead = (self.net.p[next] - place.p).reject_from_normalized(normal).try_normalize();
        let ahead = ahead.unwrap_or_else(|| normal.any_orthonormal_vector());
        (ahead, normal.cross(ahead))
    }

    /// Mean length of the sides round a node.
    fn mean_side(&self, node: usize) -> f64 {
        let (mut sum, mut n) = (0.0, 0.0);
        for f in self.faces(node) {
            let c = self.net.corners(*f as usize);
            if let Some(k) = c.iter().position(|c| *c as usize == node) {
                sum += self.net.p[node].distance(self.net.p[c[(k + 1) % c.len()] as usize]);
                n += 1.0;
            }
        }
        sum / n
    }
}

/// Directions of a search.
const EIGHT: [(f64, f64); 8] = {
    const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [
        (1.0, 0.0),
        (-1.0, 0.0),
        (0.0, 1.0),
        (0.0, -1.0),
        (DIAGONAL, DIAGONAL),
        (-DIAGONAL, -DIAGONAL),
        (DIAGONAL, -DIAGONAL),
        (-DIAGONAL, DIAGONAL),
    ]
};
