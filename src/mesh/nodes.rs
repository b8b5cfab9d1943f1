//! Nodes on borders and curves: junctions, then the inner nodes of every segment, each once for all its faces.

use glam::DVec3;

use super::counts::steps;
use super::layout::Layout;
use super::sizing::Sizing;
use crate::base::par;

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
    /// Numbers the nodes: used junctions, lonely points, then segment by segment.
    pub fn new(layout: &Layout, sizing: &Sizing, counts: &[u32]) -> Self {
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
        for (count, decision) in nodes.counts.iter().zip(&sizing.decisions) {
            nodes.first.push(nodes.total);
            nodes.fractions.push(match &sizing.spacings[nodes.fractions.len()] {
                Some(spacing) => spacing.steps(*count),
                None => steps(*count, decision.bias),
            });
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
    pub fn points(&self, layout: &Layout, lonely: &[DVec3]) -> Vec<DVec3> {
        let mut points = vec![DVec3::ZERO; self.total as usize];
        for (junction, id) in self.junctions.iter().enumerate().filter(|(_, id)| **id != u32::MAX) {
            points[*id as usize] = layout.pieces.junctions[junction];
        }
        for ((p, id), junction) in lonely.iter().zip(&self.points).zip(&layout.points) {
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
