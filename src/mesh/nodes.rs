//! Nodes on borders and curves: junctions, then the inner nodes of every stretch, each once for all its faces.

use glam::DVec3;

use super::counts::steps;
use super::layout::Layout;
use super::sizing::Sizing;
use crate::base::par;

/// Ids and fractions of the nodes of all stretches.
#[derive(Clone, Debug, Default)]
pub struct Nodes {
    junctions: Vec<u32>,
    first: Vec<u32>,
    counts: Vec<u32>,
    fractions: Vec<Vec<f64>>,
    /// Number of nodes on junctions and stretches, and of points that lie on none.
    pub total: u32,
    /// Node of each point of the plan.
    pub points: Vec<u32>,
}

impl Nodes {
    /// Numbers the nodes: used junctions, lonely points, then stretch by stretch.
    pub fn new(layout: &Layout, sizing: &Sizing, counts: &[u32]) -> Self {
        let n = layout.pieces.atoms.len();
        let mut used = vec![false; layout.pieces.junctions.len()];
        for atom in &layout.pieces.atoms {
            used[atom.ends.0] = true;
            used[atom.ends.1] = true;
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
            nodes.fractions.push(match &sizing.paces[nodes.fractions.len()] {
                Some(pace) => pace.steps(*count),
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

    /// Steps of a stretch.
    pub fn count(&self, stretch: usize) -> u32 {
        self.counts[stretch]
    }

    /// First inner node of a stretch.
    pub fn first_inner(&self, stretch: usize) -> u32 {
        self.first[stretch]
    }

    /// All nodes of a stretch from its start, or from its end.
    pub fn of_stretch(&self, layout: &Layout, stretch: usize, against: bool) -> Vec<u32> {
        let ends = layout.pieces.atoms[stretch].ends;
        let first = self.first[stretch];
        let mut ids = Vec::with_capacity(self.counts[stretch] as usize + 1);
        ids.push(self.junctions[ends.0]);
        ids.extend(first..first + self.counts[stretch] - 1);
        ids.push(self.junctions[ends.1]);
        if against {
            ids.reverse();
        }
        ids
    }

    /// Fractions of the length of these nodes.
    pub fn fractions(&self, stretch: usize, against: bool) -> Vec<f64> {
        let own = &self.fractions[stretch];
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
        let made = par::map(self.counts.len(), |stretch| {
            let inner = &self.fractions[stretch][1..self.counts[stretch] as usize];
            layout.points_along(stretch, inner)
        });
        for (first, part) in self.first.iter().zip(made) {
            points[*first as usize..*first as usize + part.len()].copy_from_slice(&part);
        }
        points
    }
}
