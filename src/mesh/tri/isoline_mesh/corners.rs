//! Where cells meet and where nodes of borders lie on their sides: the places that may become nodes.

use glam::DVec2;

use crate::base::job;
use crate::mesh::tri::fill;
use crate::mesh::tri::isoline_mesh::IsolineMesher;
use crate::mesh::tri::marks::corners as box_corners;
use crate::mesh::tri::placement_settings::ISOLINES;
use crate::mesh::tri::tree::Class;

/// A place where cells meet, or a border has a node on the side of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellCorner {
    pub(crate) at: DVec2,
    /// A node of the border.
    pub(crate) border: Option<u32>,
    /// Two nodes of the border are here.
    pub(crate) dropped: bool,
}

/// Corners by place, and how to find them.
pub(crate) struct CellCorners {
    /// By u, then v.
    pub(crate) all: Vec<CellCorner>,
    /// By v, then u.
    pub(crate) by_v: Vec<u32>,
    /// Their nodes.
    pub(crate) node: Vec<Option<u32>>,
}

fn order(a: DVec2, b: DVec2, first: usize) -> std::cmp::Ordering {
    a[first].total_cmp(&b[first]).then(a[1 - first].total_cmp(&b[1 - first]))
}

impl CellCorners {
    /// The corner at a place.
    pub(crate) fn of(&self, at: DVec2) -> Option<usize> {
        self.all.binary_search_by(|c| order(c.at, at, 0)).ok()
    }

    /// Corners strictly between two places of one value of u (axis 1 runs) or v (axis 0 runs), ascending.
    fn between(&self, from: DVec2, to: DVec2, axis: usize) -> Vec<usize> {
        let place = |k: usize| if axis == 1 { k } else { self.by_v[k] as usize };
        let first = partition(self.all.len(), |k| order(self.all[place(k)].at, from, 1 - axis).is_le());
        let last = partition(self.all.len(), |k| order(self.all[place(k)].at, to, 1 - axis).is_lt());
        (first..last).map(place).collect()
    }
}

/// The first of `n` for which a condition, true up to some place, is not.
fn partition(n: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, n);
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) { low = middle + 1 } else { high = middle }
    }
    low
}

impl IsolineMesher<'_> {
    /// Corners of cells and nodes of borders on their sides.
    pub(crate) fn corners(&self) -> CellCorners {
        let mut all: Vec<CellCorner> = Vec::new();
        for cell in self.cells.all().iter().filter(|c| c.is_leaf() && c.class != Class::Exterior) {
            job::poll();
            all.extend(box_corners((cell.low, cell.high)).map(|at| CellCorner { at, border: None, dropped: false }));
        }
        let near = self.cells.near;
        for (n, at) in self.at.iter().enumerate() {
            let lined = self.cells.lined(*at);
            let beside =
                [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(|d| self.cells.find(lined + near * DVec2::from(d), [true; 2]));
            for (i, k) in beside.iter().enumerate() {
                let cell = &self.cells.all()[*k as usize];
                if beside[..i].contains(k) || cell.class == Class::Exterior {
                    continue;
                }
                let (mut snapped, mut on) = (lined, false);
                for axis in 0..2 {
                    for side in [cell.low[axis], cell.high[axis]] {
                        if (lined[axis] - side).abs() <= near[axis] {
                            (snapped[axis], on) = (side, true);
                        }
                    }
                }
                if on {
                    all.push(CellCorner { at: snapped, border: Some(n as u32), dropped: false });
                }
            }
        }
        all.sort_by(|a, b| order(a.at, b.at, 0).then(b.border.cmp(&a.border)));
        let merged = all
            .chunk_by(|a, b| a.at == b.at)
            .map(|same| CellCorner { dropped: same.iter().any(|c| c.border.is_some() && c.border != same[0].border), ..same[0] });
        let all: Vec<CellCorner> = merged.collect();
        let mut by_v: Vec<u32> = (0..all.len() as u32).collect();
        by_v.sort_by(|a, b| order(all[*a as usize].at, all[*b as usize].at, 1));
        let node = vec![None; all.len()];
        CellCorners { all, by_v, node }
    }

    /// Whether a place is too near to a border, or outside.
    pub(crate) fn unfit(&self, at: DVec2) -> bool {
        let leaves = self.cells.around(at);
        let around = || leaves.iter().map(|k| &self.cells.all()[*k as usize]).filter(|c| c.class != Class::Exterior);
        let scale = around().fold(DVec2::INFINITY, |s, c| s.min(c.width()));
        let close = |s: &u32| {
            let [a, b] = self.cells.segment(*s).map(|p| (p - at) / scale);
            let along = b - a;
            let square = along.length_squared();
            let t = if square > 0.0 { (-a.dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
            (a + along * t).length() < ISOLINES.min_border_distance
        };
        around().any(|c| c.segments.iter().any(close)) || !around().any(|c| c.class == Class::Interior) && !self.cells.holds(at)
    }
}

/// Corners round a cell, counter-clockwise, with those on its sides; `None` where one of its own has no node.
pub(crate) fn polygon(corners: &CellCorners, (low, high): (DVec2, DVec2)) -> Option<Vec<usize>> {
    let own = box_corners((low, high)).map(|at| corners.of(at).filter(|k| corners.node[*k].is_some()));
    let [a, b, c, d] = [own[0]?, own[1]?, own[2]?, own[3]?];
    let mut round = Vec::new();
    for (first, side, back) in [(a, (a, b, 0), false), (b, (b, c, 1), false), (c, (d, c, 0), true), (d, (a, d, 1), true)] {
        let (from, to, axis) = side;
        round.push(first);
        let mut on = corners.between(corners.all[from].at, corners.all[to].at, axis);
        on.retain(|k| corners.node[*k].is_some());
        if back {
            on.reverse();
        }
        round.extend(on);
    }
    (round.len() <= fill::MAX_NODES).then_some(round)
}
