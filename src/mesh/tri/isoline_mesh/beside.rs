//! What cells leave: one constrained triangulation between them and the borders, and the cells to cut where it breaks a limit.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::triangulate_points::{Triangles, points};
use crate::mesh::chart::outline::inside;
use crate::mesh::deviation::poles::from_pole;
use crate::mesh::tri::isoline_mesh::cut::Cut;
use crate::mesh::tri::isoline_mesh::{Failure, Tried, Work};
use crate::mesh::tri::limit_table;
use crate::mesh::tri::tree::Class;
use crate::mesh::tri::triangulation::Triangulation;
use crate::mesh::tri::trouble::Trouble;

/// Longest side of a triangle beside a border over the longest side of a cell: its diagonal, and a little.
const STRETCH: f64 = 1.5;

/// Share of the chord error up to which cells are cut beside what nothing bounds.
const FINE: f64 = 0.25;

/// Share of the longest side of a triangle without area by which the surface may be off it.
const ROUND: f64 = 0.25;

impl Work<'_> {
    /// The triangulation of all nodes with the edges of borders and of the triangles that are sure, and which are inside.
    pub(crate) fn triangulated(&self, triangulation: &Triangulation, sure: &[[u32; 3]]) -> Tried<(Triangles, Vec<bool>)> {
        let outline = self.ask.outline;
        let mut edges: Vec<[u32; 2]> =
            sure.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let given: BTreeSet<[u32; 2]> = outline.edges().map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.retain(|e| !given.contains(e));
        let mut all: Vec<[u32; 2]> = outline.edges().collect();
        all.extend(edges);
        let all = points(&triangulation.xy, &all).map_err(|fault| Failure::Trouble(Trouble::Border(fault)))?;
        let kept = inside(&all, outline);
        if kept.contains(&true) { Ok((all, kept)) } else { Err(Failure::Trouble(Trouble::Empty)) }
    }

    /// Cells to cut for triangles beside borders that do not keep the limits.
    pub(crate) fn beside(
        &mut self,
        triangulation: &Triangulation,
        (all, kept): (&Triangles, &[bool]),
        sure: &BTreeSet<[u32; 3]>,
    ) -> Vec<(u32, Cut)> {
        self.worst = None;
        let mut bad: BTreeMap<u32, Cut> = BTreeMap::new();
        for t in (0..kept.len()).filter(|t| kept[*t]) {
            job::poll();
            let c = all.corners[t];
            // At a pole the chart has edges that are points in space, and lines of the surface run into it: what stands on an edge,
            // or has its corners on a line, is no triangle in the end.
            let flat = self.is_flat(triangulation, c);
            let wraps = flat && self.wraps(triangulation, c);
            if sure.contains(&sorted(c)) || flat && !wraps {
                continue;
            }
            let load = limit_table::load_of_long(self.ask.chart, triangulation, c, self.ask.limits, &self.normals);
            let long = wraps || self.too_long(triangulation, (c, all.given[t]));
            if load.worst() <= 1.0 && !long {
                continue;
            }
            let uv = c.map(|n| DVec2::from(self.ask.chart.uv(triangulation.xy[n as usize])));
            let middle = (uv[0] + uv[1] + uv[2]) / 3.0;
            if self.worst.is_none_or(|(worst, _)| load.worst() > worst.worst()) {
                self.worst = Some((load, c.iter().map(|n| triangulation.p[*n as usize]).sum::<DVec3>() / 3.0));
            }
            let leaf = self.cells.find(middle, [true; 2]);
            if self.cells.all()[leaf as usize].class == Class::Exterior {
                continue;
            }
            let of_border = c.iter().all(|n| *n < triangulation.fixed);
            if (of_border || !load.worst().is_finite()) && self.is_hopeless(leaf) {
                return Vec::new();
            }
            let bounds = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
            if let Some(axis) = self.towards(leaf, bounds) {
                bad.entry(leaf).or_insert((axis, 2));
            }
        }
        bad.into_iter().collect()
    }

    /// Whether smaller cells help no more where nothing bounds the surface, or between nodes of a border alone: a cell reaches no farther than a
    /// part of the chord error already, and the steps of the border beside it, which are given, stand on both sides of a fold.
    fn is_hopeless(&mut self, leaf: u32) -> bool {
        let (low, high) = (self.cells.all()[leaf as usize].low, self.cells.all()[leaf as usize].high);
        self.ask.limits.chord.is_some_and(|limit| self.lengths(low, high).max_element() <= FINE * limit)
    }

    /// Whether the corners of a triangle lie on a straight line, within the tolerance.
    fn is_flat(&self, triangulation: &Triangulation, c: [u32; 3]) -> bool {
        let [a, b, d] = c.map(|n| triangulation.p[n as usize]);
        let longest = a.distance(b).max(b.distance(d)).max(d.distance(a));
        (b - a).cross(d - a).length() <= self.ask.point * longest
    }

    /// Whether the surface between the places of a triangle without area goes round a good way off the line of its corners, and
    /// farther than the chord error: they are on both sides of a seam, or in several poles.
    fn wraps(&self, triangulation: &Triangulation, c: [u32; 3]) -> bool {
        let chart = self.ask.chart;
        let places = c.map(|n| DVec2::from(chart.uv(triangulation.xy[n as usize])));
        let columns = from_pole(&|at| chart.tangents(at.into()), places);
        let middle = (columns[0] + columns[1] + columns[2]) / 3.0;
        let p = c.map(|n| triangulation.p[n as usize]);
        let (a, b) = [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])]
            .into_iter()
            .max_by(|one, other| one.0.distance_squared(one.1).total_cmp(&other.0.distance_squared(other.1)))
            .unwrap_or_default();
        let off = chart.evaluator().point(middle.x, middle.y) - a;
        let along = (b - a).normalize_or_zero();
        let near = (ROUND * a.distance(b) + self.ask.point).max(self.ask.limits.chord.unwrap_or(0.0));
        (off - along * off.dot(along)).length() > near
    }

    /// Whether a side of a triangle that is no edge of the border is longer than cells may be.
    fn too_long(&self, triangulation: &Triangulation, (c, given): ([u32; 3], u8)) -> bool {
        let p = c.map(|n| triangulation.p[n as usize]);
        let most = |p: DVec3| self.ask.rules.at(p, self.ask.size);
        (0..3).filter(|k| given >> k & 1 == 0).any(|k| {
            let (a, b) = (p[(k + 1) % 3], p[(k + 2) % 3]);
            a.distance(b) > STRETCH * most(a).max(most(b))
        })
    }
}

pub(crate) fn sorted(mut t: [u32; 3]) -> [u32; 3] {
    t.sort_unstable();
    t
}
