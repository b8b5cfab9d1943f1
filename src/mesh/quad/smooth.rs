//! Nodes of quads moved over their surface: to area-weighted centroids, and where elements are bad to where the worst of
//! those round the node is best. No move makes the worst one worse [Freitag 1997].

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::chart::halves::NONE;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField, Spot, foot_near, foot_spot};
use crate::mesh::quad::net::{Net, least_quality};
use crate::mesh::quad::plane;
use crate::mesh::quad::settings::SMOOTHING;

/// A place of a node.
#[derive(Clone, Copy)]
pub(super) struct NodePosition {
    pub(super) xy: DVec2,
    pub(super) p: DVec3,
    pub(super) normal: DVec3,
}

/// Moves the nodes of a net.
pub struct Smoother<'a> {
    /// The net.
    pub net: &'a mut Net,
    chart_surface: &'a dyn ParametricSurface,
    field: &'a dyn SizeField,
    /// The origin of the chart, where it is the plane of the face itself.
    plane: Option<Spot>,
    /// Faces round each node: from `first[n]` to the next one.
    first: Vec<u32>,
    of: Vec<u32>,
    /// Nodes that may have to move.
    pub(super) active: Vec<bool>,
    /// Nodes that moved: elements round others are unchanged.
    pub(super) fresh: Vec<bool>,
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
        Self { net, chart_surface, field, plane: chart_surface.plane(), first, of, active, fresh }
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

    /// The quality of a face.
    pub(super) fn quality(&self, f: usize) -> f64 {
        if self.plane.is_some() { plane::quality(self.net, f) } else { self.net.quality(f) }
    }

    /// The least quality of some faces of the net.
    pub(super) fn least(&self) -> fn(&Net, &[u32]) -> f64 {
        if self.plane.is_some() { plane::least_quality } else { least_quality }
    }

    /// The least quality round a node.
    pub(super) fn worst(&self, node: usize) -> f64 {
        self.least()(self.net, self.faces(node))
    }

    pub(super) fn place(&self, node: usize) -> NodePosition {
        NodePosition { xy: self.net.xy[node], p: self.net.p[node], normal: self.net.normal[node] }
    }

    pub(super) fn put(&mut self, node: usize, place: NodePosition) {
        (self.net.xy[node], self.net.p[node], self.net.normal[node]) = (place.xy, place.p, place.normal);
    }

    /// The foot of a point near a node.
    pub(super) fn foot(&self, node: usize, p: DVec3) -> NodePosition {
        if let Some(plane) = &self.plane {
            let off = p - plane.p;
            return self.in_plane(node, plane, DVec2::new(off.dot(plane.dx), off.dot(plane.dy)));
        }
        let (xy, spot) = foot_spot(self.chart_surface, self.net.xy[node], p);
        NodePosition { xy, p: spot.p, normal: spot.normal() }
    }

    /// A place of the plane for a node.
    fn in_plane(&self, node: usize, plane: &Spot, xy: DVec2) -> NodePosition {
        let xy = self.chart_surface.clamp(xy);
        NodePosition { xy, p: plane.p + plane.dx * xy.x + plane.dy * xy.y, normal: self.net.normal[node] }
    }

    /// Completes the move of a node.
    pub(super) fn settle(&mut self, node: usize) {
        if !self.field.is_even() {
            self.net.size[node] = self.field.size(self.net.xy[node], self.net.p[node]);
        }
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
                if !std::mem::take(&mut self.active[node]) {
                    continue;
                }
                let moves = match self.plane {
                    Some(plane) => self.relax_in_plane(node, &plane),
                    None => self.relax(node),
                };
                if moves {
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

    /// How much the area of a face weighs: elements where lengths are short weigh more.
    fn share(&self, f: usize) -> f64 {
        let c = self.net.corners(f);
        let size = c.iter().map(|c| self.net.size[*c as usize]).sum::<f64>() / c.len() as f64;
        1.0 / (size * size * size * size)
    }

    /// The area-weighted mean of the centroids round a node, with the same mean in the chart.
    fn centre(&self, node: usize) -> Option<(DVec3, DVec2)> {
        let (mut sum, mut place, mut weights) = (DVec3::ZERO, DVec2::ZERO, 0.0);
        let (here, xy) = (self.net.p[node], self.net.xy[node]);
        for f in self.faces(node) {
            let c = self.net.corners(*f as usize);
            let n = c.len();
            let k = c.iter().position(|c| *c as usize == node)?;
            let at = |i: usize| c[(k + i) % n] as usize;
            let (p, of) = (&self.net.p, &self.net.xy);
            let share = self.share(*f as usize);
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

    /// The same where the chart is the plane.
    fn relax_in_plane(&mut self, node: usize, plane: &Spot) -> bool {
        let share_of = |f: usize| self.share(f);
        let Some(to) = plane::centre(self.net, node, self.faces(node), &share_of, self.field.is_even()) else { return false };
        let start = self.net.xy[node];
        let still = SMOOTHING.min_move * self.net.size[node];
        if start.distance_squared(to) < still * still {
            return false;
        }
        let mut before = None;
        let mut share = 1.0;
        for _ in 0..3 {
            let place = self.in_plane(node, plane, start.lerp(to, share));
            self.net.xy[node] = place.xy;
            let good = plane::reach(self.net, self.faces(node), SMOOTHING.min_smoothed_quality) || {
                let after = self.worst(node);
                self.net.xy[node] = start;
                after >= *before.get_or_insert_with(|| self.worst(node))
            };
            if good {
                self.put(node, place);
                return true;
            }
            share *= 0.4;
        }
        false
    }
}
