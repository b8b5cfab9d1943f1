//! Cells between lines of constant u and v: boxes halved by one direction at a time, each only where it has to be.
//!
//! Lines that run through all of a face would be needed everywhere for one place that demands them; cells are halved alone, and
//! fine cells meet coarse ones node to node [Piegl & Tiller 1998]. A cut starts where one beyond
//! the side of its cell ends, or at a node of a straight border, when there is one near its place, and else at a value that is
//! cut elsewhere when one is very near: lines go on from cell to cell. Kink lines are cut first. Whether a border crosses a cell is
//! decided exactly.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use glam::DVec2;

use crate::base::tolerance::NUDGE;
use crate::mesh::request::decider::Why;
use crate::mesh::tri::placement_settings::ISOLINES;
use crate::mesh::tri::tree::{Class, Tree, meets};

/// A direction across which a cell is cut, and the number of parts it is cut into in the end, two at least.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    /// 0: across u, 1: across v.
    pub axis: usize,
    /// Parts.
    pub parts: u32,
}

/// A box of (u, v).
#[derive(Clone, Debug)]
pub struct IsolineCell {
    /// Least u and v.
    pub low: DVec2,
    /// Largest u and v.
    pub high: DVec2,
    /// Where it lies.
    pub class: Class,
    /// Border segments that meet it or run along it.
    pub segments: Vec<u32>,
    /// The cause of its size.
    pub why: Why,
    /// First of two children; 0: it is a leaf.
    child: u32,
    /// Which direction is cut, and where.
    cut: (usize, f64),
}

impl IsolineCell {
    /// Whether it is not cut.
    pub fn is_leaf(&self) -> bool {
        self.child == 0
    }

    /// Extent in u and v.
    pub fn width(&self) -> DVec2 {
        self.high - self.low
    }
}

/// The cells of a face.
pub struct IsolineCells<'a> {
    segments: &'a [[DVec2; 2]],
    /// Only what bounds the face, for whether a place is inside.
    loops: Tree<'a>,
    cells: Vec<IsolineCell>,
    /// What is nearer than this is at one place, in u and v.
    pub near: DVec2,
    /// Values of u and of v at nodes of straight borders round all, with the value that stands for them: where two such borders
    /// have nodes that nearly face each other, the line from one to the other has the value of the first.
    values: [Vec<(f64, f64)>; 2],
    /// Where cuts across u, and across v, end: by the value of the other parameter, then by their own.
    ends: [BTreeSet<(Sorted, Sorted)>; 2],
    /// All values of u, and of v, at which cells are cut.
    cuts: [BTreeSet<Sorted>; 2],
    /// Values of u and of v that have to be cut.
    kinks: [Vec<f64>; 2],
    /// Leaves that no border crosses.
    whole: usize,
}

/// A number in its order.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sorted(f64);

impl Eq for Sorted {}

impl PartialOrd for Sorted {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Sorted {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl<'a> IsolineCells<'a> {
    /// One cell round all segments, of which the first `loops` bound the face. `kinks` are the values of u and of v that no
    /// cell may run across.
    pub fn new(segments: &'a [[DVec2; 2]], loops: usize, kinks: [Vec<f64>; 2]) -> Self {
        let ends = segments.iter().flatten();
        let (low, high) = ends.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
        let near = NUDGE * (high - low);
        let values = [0, 1].map(|axis| {
            let side = |at: f64| {
                let along = segments.iter().flatten().filter(|p| (p[1 - axis] - at).abs() <= near[1 - axis]);
                let mut all: Vec<f64> = along.map(|p| p[axis]).collect();
                all.sort_by(f64::total_cmp);
                all.dedup();
                all
            };
            facing(&side(low[1 - axis]), &side(high[1 - axis]))
        });
        let tree = Tree::new(&segments[..loops], loops, (low, high), (1, 1));
        let all = (0..segments.len() as u32).collect();
        let ends = [0, 1].map(|axis| {
            let borders = [low[1 - axis], high[1 - axis]];
            let values: &Vec<(f64, f64)> = &values[axis];
            borders.iter().flat_map(|b| values.iter().map(|x| (Sorted(*b), Sorted(x.1)))).collect()
        });
        let cuts = [0, 1].map(|axis| values[axis].iter().map(|x| Sorted(x.1)).collect());
        let mut cells = Self { segments, loops: tree, cells: Vec::new(), near, values, ends, cuts, kinks, whole: 0 };
        let root = cells.cell((low, high), all, Why::Size);
        cells.cells.push(root);
        cells
    }

    fn cell(&self, (low, high): (DVec2, DVec2), mut segments: Vec<u32>, why: Why) -> IsolineCell {
        let around = (low - self.near, high + self.near);
        segments.retain(|s| meets(self.segments[*s as usize], around));
        let inner = (low + self.near, high - self.near);
        let class = if segments.iter().any(|s| meets(self.segments[*s as usize], inner)) {
            Class::Partial
        } else if self.loops.holds(0.5 * (low + high)) {
            Class::Interior
        } else {
            Class::Exterior
        };
        IsolineCell { low, high, class, segments, why, child: 0, cut: (0, 0.0) }
    }

    /// All cells, parents before their children.
    pub fn all(&self) -> &[IsolineCell] {
        &self.cells
    }

    /// Whether a place is inside the loops; exact but for places on them.
    pub fn holds(&self, at: DVec2) -> bool {
        self.loops.holds(at)
    }

    /// The place of a node in the lines that stand for those of straight borders.
    pub fn lined(&self, at: DVec2) -> DVec2 {
        let root = &self.cells[0];
        let mut lined = at;
        for axis in 0..2 {
            let other = 1 - axis;
            if (at[other] - root.low[other]).abs().min((at[other] - root.high[other]).abs()) <= self.near[other] {
                let values = &self.values[axis];
                let first = values.partition_point(|x| x.0 < at[axis]);
                lined[axis] = values.get(first).filter(|x| x.0 == at[axis]).map_or(at[axis], |x| x.1);
            }
        }
        lined
    }

    /// The two places of a segment.
    pub fn segment(&self, s: u32) -> [DVec2; 2] {
        self.segments[s as usize]
    }

    /// The direction in which a kink line runs through a cell, if one does.
    pub fn kinked(&self, k: u32) -> Option<usize> {
        (0..2).find(|axis| self.kink(k, *axis).is_some())
    }

    /// The kink line inside a cell that is nearest to its middle.
    fn kink(&self, k: u32, axis: usize) -> Option<f64> {
        let IsolineCell { low, high, .. } = &self.cells[k as usize];
        let inside = |x: &&f64| **x > low[axis] + self.near[axis] && **x < high[axis] - self.near[axis];
        nearest(self.kinks[axis].iter().filter(inside), 0.5 * (low[axis] + high[axis]))
    }

    /// Whether a cell can be cut across a direction.
    pub fn divisible(&self, k: u32, axis: usize) -> bool {
        self.cells[k as usize].width()[axis] > ISOLINES.min_cut_width * self.near[axis]
    }

    /// Where a cell that is cut into `parts` parts is cut first: with half of them on each side.
    fn place(&self, k: u32, axis: usize, parts: u32) -> f64 {
        let IsolineCell { low, high, .. } = &self.cells[k as usize];
        let width = high[axis] - low[axis];
        let wanted = low[axis] + width * f64::from(parts / 2) / f64::from(parts);
        let reach = (ISOLINES.snap_to_node * width).min(width / f64::from(parts));
        let drawn = |side: f64| {
            let (from, to) = ((Sorted(side), Sorted(wanted - reach)), (Sorted(side), Sorted(wanted + reach)));
            self.ends[axis].range(from..=to).map(|end| end.1.0).collect::<Vec<f64>>()
        };
        let (below, above) = (drawn(low[1 - axis]), drawn(high[1 - axis]));
        let both = nearest(below.iter().filter(|x| above.contains(x)), wanted);
        let any = || nearest(below.iter().chain(&above), wanted);
        let alike = || {
            let reach = reach * ISOLINES.snap_to_cut;
            nearest(self.cuts[axis].range(Sorted(wanted - reach)..=Sorted(wanted + reach)).map(|x| &x.0), wanted)
        };
        self.kink(k, axis).or(both).or_else(any).or_else(alike).unwrap_or(wanted)
    }

    /// Cuts a leaf once.
    pub fn split(&mut self, k: u32, cut: Cut, why: Why) {
        let Cut { axis, parts } = cut;
        let at = self.place(k, axis, parts);
        let parent = &mut self.cells[k as usize];
        let (low, high) = (parent.low, parent.high);
        let segments = std::mem::take(&mut parent.segments);
        self.cuts[axis].insert(Sorted(at));
        for side in [low[1 - axis], high[1 - axis]] {
            self.ends[axis].insert((Sorted(side), Sorted(at)));
        }
        let (mut middle_high, mut middle_low) = (high, low);
        (middle_high[axis], middle_low[axis]) = (at, at);
        let children = [self.cell((low, middle_high), segments.clone(), why), self.cell((middle_low, high), segments, why)];
        let first = self.cells.len() as u32;
        (self.cells[k as usize].child, self.cells[k as usize].cut) = (first, (axis, at));
        let is_whole = |cell: &IsolineCell| usize::from(cell.class == Class::Interior);
        self.whole += children.iter().map(is_whole).sum::<usize>();
        self.whole -= is_whole(&self.cells[k as usize]).min(self.whole);
        self.cells.extend(children);
    }

    /// Leaves that no border crosses; each becomes two triangles or more.
    pub fn n_whole(&self) -> usize {
        self.whole
    }

    /// The leaf at a place; on a cut the one before or after it, by direction.
    pub fn find(&self, at: DVec2, after: [bool; 2]) -> u32 {
        let mut k = 0;
        while !self.cells[k as usize].is_leaf() {
            let IsolineCell { child, cut: (axis, cut), .. } = &self.cells[k as usize];
            let beyond = match at[*axis].total_cmp(cut) {
                Ordering::Less => false,
                Ordering::Equal => after[*axis],
                Ordering::Greater => true,
            };
            k = child + u32::from(beyond);
        }
        k
    }

    /// The leaves round a place: up to four different ones.
    pub fn around(&self, at: DVec2) -> Vec<u32> {
        let mut found: Vec<u32> = [[false, false], [true, false], [true, true], [false, true]].map(|after| self.find(at, after)).to_vec();
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// Values of two sides, each with the one that stands for it; sorted.
fn facing(first: &[f64], second: &[f64]) -> Vec<(f64, f64)> {
    let gap = |all: &[f64], k: usize| {
        let before = k.checked_sub(1).map_or(f64::INFINITY, |b| all[k] - all[b]);
        all.get(k + 1).map_or(f64::INFINITY, |after| after - all[k]).min(before)
    };
    let stands = |(k, x): (usize, &f64)| {
        let other = first.iter().enumerate().min_by(|a, b| (a.1 - x).abs().total_cmp(&(b.1 - x).abs()));
        match other {
            Some((j, y)) if (x - y).abs() <= ISOLINES.max_facing_offset * gap(second, k).min(gap(first, j)) => (*x, *y),
            _ => (*x, *x),
        }
    };
    let mut all: Vec<(f64, f64)> = first.iter().map(|x| (*x, *x)).chain(second.iter().enumerate().map(stands)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    all.dedup();
    all
}

/// The value nearest to another.
fn nearest<'v>(values: impl Iterator<Item = &'v f64>, to: f64) -> Option<f64> {
    values.copied().min_by(|a, b| (a - to).abs().total_cmp(&(b - to).abs()))
}
