//! The space between cells and borders: one constrained triangulation, and the cells to cut where it exceeds a limit.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::triangulate_points::{Triangles, points};
use crate::mesh::chart::outline::inside;
use crate::mesh::deviation::poles::from_pole;
use crate::mesh::tri::isoline::Cut;
use crate::mesh::tri::isoline_mesh::{Failure, IsolineMesher, IsolineResult};
use crate::mesh::tri::limit_table::LimitRatios;
use crate::mesh::tri::no_mesh::NoMesh;
use crate::mesh::tri::placement_settings::ISOLINES;
use crate::mesh::tri::tree::Class;
use crate::mesh::tri::triangulation::Triangulation;

impl IsolineMesher<'_> {
    /// The triangulation of all nodes with the edges of borders and of the triangles that are sure, and which are inside.
    pub(crate) fn triangulated(&self, triangulation: &Triangulation, sure: &[[u32; 3]]) -> IsolineResult<(Triangles, Vec<bool>)> {
        let outline = self.input.outline;
        let mut edges: Vec<[u32; 2]> =
            sure.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let given: BTreeSet<[u32; 2]> = outline.edges().map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.retain(|e| !given.contains(e));
        let mut all: Vec<[u32; 2]> = outline.edges().collect();
        all.extend(edges);
        let all = points(&triangulation.xy, &all).map_err(|fault| Failure::NoMesh(NoMesh::Border(fault)))?;
        let kept = inside(&all, outline);
        if kept.contains(&true) { Ok((all, kept)) } else { Err(Failure::NoMesh(NoMesh::Empty)) }
    }

    /// Cells to cut for triangles beside borders that exceed the limits.
    pub(crate) fn beside(&mut self, triangulation: &Triangulation, ratios: &[Option<LimitRatios>]) -> Vec<(u32, Cut)> {
        self.worst = None;
        let mut bad: BTreeMap<u32, Cut> = BTreeMap::new();
        for (t, ratio) in ratios.iter().enumerate() {
            job::poll();
            let (c, Some(ratio)) = (triangulation.tri[t], *ratio) else { continue };
            let is_long = || self.is_flat(triangulation, c) || self.too_long(triangulation, c, triangulation.locked[t]);
            if ratio.worst() <= 1.0 && !is_long() {
                continue;
            }
            let uv = c.map(|n| DVec2::from(self.input.chart.uv(triangulation.xy[n as usize])));
            let middle = (uv[0] + uv[1] + uv[2]) / 3.0;
            if self.worst.is_none_or(|(worst, _)| ratio.worst() > worst.worst()) {
                self.worst = Some((ratio, c.iter().map(|n| triangulation.p[*n as usize]).sum::<DVec3>() / 3.0));
            }
            let leaf = self.cells.find(middle, [true; 2]);
            if self.cells.all()[leaf as usize].class == Class::Exterior {
                continue;
            }
            let of_border = c.iter().all(|n| *n < triangulation.fixed);
            if (of_border || !ratio.worst().is_finite()) && self.is_uncuttable(leaf) {
                return Vec::new();
            }
            let bounds = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
            if let Some(axis) = self.towards(leaf, bounds) {
                bad.entry(leaf).or_insert(Cut { axis, parts: 2 });
            }
        }
        bad.into_iter().collect()
    }

    /// Whether cutting a cell has no effect on triangles over unbounded parts of the surface or between border nodes alone: the cell is already
    /// smaller than a part of the chord error, and the steps of the border beside it, which are given, lie on both sides of a fold.
    fn is_uncuttable(&mut self, leaf: u32) -> bool {
        let (low, high) = (self.cells.all()[leaf as usize].low, self.cells.all()[leaf as usize].high);
        self.input.limits.chord.is_some_and(|limit| self.lengths(low, high).max_element() <= ISOLINES.min_cell_share * limit)
    }

    /// Whether the corners of a triangle lie on a straight line, within the tolerance.
    pub(crate) fn is_flat(&self, triangulation: &Triangulation, c: [u32; 3]) -> bool {
        let [a, b, d] = c.map(|n| triangulation.p[n as usize]);
        let longest = a.distance(b).max(b.distance(d)).max(d.distance(a));
        (b - a).cross(d - a).length() <= self.input.point * longest
    }

    /// Whether the surface between the places of a triangle without area is far from the line of its corners, by more than a share
    /// of its length and than the chord error: they are on both sides of a seam, or in several poles.
    pub(crate) fn wraps(&self, triangulation: &Triangulation, c: [u32; 3]) -> bool {
        let chart = self.input.chart;
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
        let near = (ISOLINES.max_flat_offset * a.distance(b) + self.input.point).max(self.input.limits.chord.unwrap_or(0.0));
        (off - along * off.dot(along)).length() > near
    }

    /// Whether a side of a triangle that is no edge of the border is longer than cells may be.
    fn too_long(&self, triangulation: &Triangulation, c: [u32; 3], given: u8) -> bool {
        let p = c.map(|n| triangulation.p[n as usize]);
        let most = |p: DVec3| self.input.rules.at(p, self.input.size);
        (0..3).filter(|k| given >> k & 1 == 0).any(|k| {
            let (a, b) = (p[(k + 1) % 3], p[(k + 2) % 3]);
            a.distance(b) > ISOLINES.max_side_ratio * most(a).max(most(b))
        })
    }
}

pub(crate) fn sorted(mut t: [u32; 3]) -> [u32; 3] {
    t.sort_unstable();
    t
}
