//! Nodes on borders and curves: junctions, then the inner nodes of every segment, each once for all its faces.

use glam::DVec3;

use crate::base::par;
use crate::mesh::border::layout::{Face, Layout};

/// Ids and fractions of the nodes of all segments.
#[derive(Clone, Debug, Default)]
pub struct Nodes {
    junctions: Vec<u32>,
    first: Vec<u32>,
    counts: Vec<u32>,
    fractions: Vec<Vec<f64>>,
    /// Number of nodes on junctions and segments, and of points that lie on none.
    pub total: u32,
    /// Node of each point of the plan.
    pub points: Vec<u32>,
}

impl Nodes {
    /// Numbers the nodes: used junctions, isolated points, then segment by segment; `fractions` of the length are those of the nodes of a
    /// segment with so many steps, from 0 to 1.
    pub fn new(layout: &Layout, counts: &[u32], fractions: impl Fn(usize, u32) -> Vec<f64>) -> Self {
        let n = layout.pieces.segments.len();
        let mut used = vec![false; layout.pieces.junctions.len()];
        for segment in &layout.pieces.segments {
            used[segment.ends.0] = true;
            used[segment.ends.1] = true;
        }
        let mut nodes = Self { junctions: vec![u32::MAX; used.len()], counts: counts[..n].to_vec(), ..Self::default() };
        for (slot, _) in nodes.junctions.iter_mut().zip(&used).filter(|(_, used)| **used) {
            *slot = nodes.total;
            nodes.total += 1;
        }
        for junction in &layout.points {
            match junction {
                Some(j) => nodes.points.push(nodes.junctions[*j]),
                None => {
                    nodes.points.push(nodes.total);
                    nodes.total += 1;
                }
            }
        }
        for (segment, count) in nodes.counts.iter().enumerate() {
            nodes.first.push(nodes.total);
            nodes.fractions.push(fractions(segment, *count));
            nodes.total += count - 1;
        }
        nodes
    }

    /// Node of a junction.
    pub fn of_junction(&self, junction: usize) -> u32 {
        self.junctions[junction]
    }

    /// Steps of a segment.
    pub fn count(&self, segment: usize) -> u32 {
        self.counts[segment]
    }

    /// The segment that a node is inside, with its place along it; none of a junction or a point.
    pub fn on_segment(&self, node: u32) -> Option<(usize, usize)> {
        let segment = self.first.partition_point(|first| *first <= node).checked_sub(1)?;
        let place = (node - self.first[segment]) as usize + 1;
        (place < self.counts[segment] as usize).then_some((segment, place))
    }

    /// Moves a node inside a segment to another fraction of its length.
    pub fn slide(&mut self, segment: usize, place: usize, fraction: f64) {
        self.fractions[segment][place] = fraction;
    }

    /// First inner node of a segment.
    pub fn first_inner(&self, segment: usize) -> u32 {
        self.first[segment]
    }

    /// All nodes of a segment from its start, or from its end.
    pub fn of_segment(&self, layout: &Layout, segment: usize, against: bool) -> Vec<u32> {
        let ends = layout.pieces.segments[segment].ends;
        let first = self.first[segment];
        let mut ids = Vec::with_capacity(self.counts[segment] as usize + 1);
        ids.push(self.junctions[ends.0]);
        ids.extend(first..first + self.counts[segment] - 1);
        ids.push(self.junctions[ends.1]);
        if against {
            ids.reverse();
        }
        ids
    }

    /// Fractions of the length of these nodes.
    pub fn fractions(&self, segment: usize, against: bool) -> Vec<f64> {
        let own = &self.fractions[segment];
        if against { own.iter().rev().map(|f| 1.0 - f).collect() } else { own.clone() }
    }

    /// Points of all these nodes.
    pub fn points(&self, layout: &Layout, isolated: &[DVec3]) -> Vec<DVec3> {
        let mut points = vec![DVec3::ZERO; self.total as usize];
        for (junction, id) in self.junctions.iter().enumerate().filter(|(_, id)| **id != u32::MAX) {
            points[*id as usize] = layout.pieces.junctions[junction];
        }
        for ((p, id), junction) in isolated.iter().zip(&self.points).zip(&layout.points) {
            if junction.is_none() {
                points[*id as usize] = *p;
            }
        }
        let made = par::map(self.counts.len(), |segment| {
            let inner = &self.fractions[segment][1..self.counts[segment] as usize];
            layout.points_along(segment, inner)
        });
        for (first, part) in self.first.iter().zip(made) {
            points[*first as usize..*first as usize + part.len()].copy_from_slice(&part);
        }
        points
    }
}

/// Side nodes of a face with their lengths along the side.
pub struct SideNodes {
    /// Nodes.
    pub ids: Vec<u32>,
    /// Arc length from the side's start, model units.
    pub lengths: Vec<f64>,
}

/// The nodes along a side, ascending; a pole gives `steps + 1` times its node.
pub fn line(layout: &Layout, nodes: &Nodes, face: &Face, side: usize, steps: usize) -> SideNodes {
    let border = &face.sides[side];
    let (mut ids, mut lengths) = (Vec::new(), Vec::new());
    for u in &border.uses {
        let segment = nodes.of_segment(layout, u.segment, u.against);
        let fractions = nodes.fractions(u.segment, u.against);
        if !ids.is_empty() {
            ids.pop();
            lengths.pop();
        }
        ids.extend(segment);
        lengths.extend(fractions.iter().map(|f| if *f == 1.0 { u.s.1 } else { u.s.0 + (u.s.1 - u.s.0) * f }));
    }
    if border.uses.is_empty() {
        ids = vec![border.pole.map_or(0, |p| nodes.of_junction(p)); steps + 1];
    }
    SideNodes { ids, lengths }
}
