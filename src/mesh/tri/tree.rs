//! A quadtree over a chart: cells by where they lie to the loops, split where a border meets them, balanced over edges.
//!
//! Classes are exact: a border segment meets a cell when the open segment meets the open square, and a cell that none meets
//! lies inside or outside by its middle.

use glam::DVec2;

use crate::base::job;
use crate::base::predicates::orient;

/// Deepest level under a root: its squares are a millionth of a root.
pub const MAX_DEPTH: u8 = 20;

/// Why a tree cannot be refined further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halt {
    /// There are too many cells.
    Full,
    /// This cell, of the deepest level, would have to be split.
    Deep(u32),
}

/// Where a cell lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Inside all loops.
    Interior,
    /// Met by a border.
    Partial,
    /// Outside.
    Exterior,
}

/// A square of the tree.
#[derive(Clone, Debug)]
pub struct TreeCell {
    /// Depth under its root, 0…20.
    pub level: u8,
    /// Column and row among all squares of its level.
    pub at: (u32, u32),
    /// Where it lies.
    pub class: Class,
    /// Border segments that meet it.
    pub segments: Vec<u32>,
    /// First of four children, lower left, lower right, upper left, upper right; 0: it is a leaf.
    child: u32,
}

impl TreeCell {
    /// Whether it is not divided.
    pub fn is_leaf(&self) -> bool {
        self.child == 0
    }
}

/// The tree; roots are a grid of equal squares.
#[derive(Clone, Debug)]
pub struct Tree<'a> {
    segments: &'a [[DVec2; 2]],
    low: DVec2,
    side: DVec2,
    roots: (u32, u32),
    cells: Vec<TreeCell>,
    /// Segments of loops by horizontal bands, for the middle of cells.
    bands: Vec<Vec<u32>>,
    high: f64,
}

/// Bands for the test of a point.
const BANDS: usize = 256;

impl<'a> Tree<'a> {
    /// A grid of roots over a box (low, high), and the segments in it, classified: the first `bounding` of them are closed
    /// loops, the others lines that part nothing.
    pub fn new(segments: &'a [[DVec2; 2]], bounding: usize, (low, high): (DVec2, DVec2), roots: (u32, u32)) -> Self {
        let side = (high - low) / DVec2::new(f64::from(roots.0), f64::from(roots.1));
        let mut tree = Self { segments, low, side, roots, cells: Vec::new(), bands: vec![Vec::new(); BANDS], high: high.y };
        for (k, [a, b]) in segments.iter().enumerate().take(bounding) {
            for band in tree.band(a.y.min(b.y))..=tree.band(a.y.max(b.y)) {
                tree.bands[band].push(k as u32);
            }
        }
        let mut met = vec![Vec::new(); (roots.0 * roots.1) as usize];
        for (k, [a, b]) in segments.iter().enumerate() {
            job::poll();
            let (from, to) = (tree.column(a.min(*b)), tree.column(a.max(*b)));
            for j in from.1..=to.1 {
                for i in from.0..=to.0 {
                    if tree.meets(k as u32, 0, (i, j)) {
                        met[(j * roots.0 + i) as usize].push(k as u32);
                    }
                }
            }
        }
        for (k, segments) in met.into_iter().enumerate() {
            job::poll();
            let at = (k as u32 % roots.0, k as u32 / roots.0);
            let class = if segments.is_empty() { tree.by_middle(0, at) } else { Class::Partial };
            tree.cells.push(TreeCell { level: 0, at, class, segments, child: 0 });
        }
        tree
    }

    fn band(&self, y: f64) -> usize {
        (((y - self.low.y) / (self.high - self.low.y) * BANDS as f64).max(0.0) as usize).min(BANDS - 1)
    }

    fn column(&self, p: DVec2) -> (u32, u32) {
        let q = ((p - self.low) / self.side).max(DVec2::ZERO);
        ((q.x as u32).min(self.roots.0 - 1), (q.y as u32).min(self.roots.1 - 1))
    }

    /// Lower left corner of a square.
    pub fn corner(&self, level: u8, (i, j): (u32, u32)) -> DVec2 {
        let scale = 1.0 / f64::from(1_u32 << level);
        self.low + self.side * DVec2::new(f64::from(i) * scale, f64::from(j) * scale)
    }

    /// Sides of the squares of a level.
    pub fn side(&self, level: u8) -> DVec2 {
        self.side / f64::from(1_u32 << level)
    }

    /// All cells, parents before their children.
    pub fn cells(&self) -> &[TreeCell] {
        &self.cells
    }

    /// Whether an open segment meets an open square.
    fn meets(&self, segment: u32, level: u8, at: (u32, u32)) -> bool {
        meets(self.segments[segment as usize], (self.corner(level, at), self.corner(level, (at.0 + 1, at.1 + 1))))
    }

    /// Inside or outside by the middle.
    fn by_middle(&self, level: u8, at: (u32, u32)) -> Class {
        if self.holds(0.5 * (self.corner(level, at) + self.corner(level, (at.0 + 1, at.1 + 1)))) {
            Class::Interior
        } else {
            Class::Exterior
        }
    }

    /// Whether a point is inside an odd number of loops; exact but for points on a segment.
    pub fn holds(&self, p: DVec2) -> bool {
        let right = |k: &&u32| {
            let [a, b] = self.segments[**k as usize];
            (a.y <= p.y) != (b.y <= p.y) && (orient(a, b, p) > 0.0) == (a.y < b.y)
        };
        self.bands[self.band(p.y)].iter().filter(right).count() % 2 == 1
    }

    fn split(&mut self, cell: u32) {
        let first = self.cells.len() as u32;
        let TreeCell { level, at, class, .. } = self.cells[cell as usize];
        let segments = std::mem::take(&mut self.cells[cell as usize].segments);
        for k in 0..4 {
            let at = (2 * at.0 + k % 2, 2 * at.1 + k / 2);
            let own: Vec<u32> = segments.iter().copied().filter(|s| self.meets(*s, level + 1, at)).collect();
            let class = match class {
                Class::Partial if own.is_empty() => self.by_middle(level + 1, at),
                other => other,
            };
            self.cells.push(TreeCell { level: level + 1, at, class, segments: own, child: 0 });
        }
        self.cells[cell as usize].child = first;
    }

    /// Splits leaves for as long as `needs_split` says so.
    ///
    /// Fails when there are then more than `most` cells, or one of level 20 is to be split.
    pub fn refine(&mut self, needs_split: &dyn Fn(&Self, &TreeCell) -> bool, most: usize) -> Result<(), Halt> {
        let mut k = 0;
        while k < self.cells.len() {
            let cell = &self.cells[k];
            if cell.is_leaf() && needs_split(self, cell) {
                if cell.level == MAX_DEPTH {
                    return Err(Halt::Deep(k as u32));
                }
                if self.cells.len() > most {
                    return Err(Halt::Full);
                }
                self.split(k as u32);
            }
            k += 1;
        }
        Ok(())
    }

    /// Splits leaves until none has a neighbour over an edge that is less than half its size [Yerry & Shephard 1983].
    pub fn balance(&mut self) {
        let mut open: Vec<u32> = (0..self.cells.len() as u32).filter(|k| self.cells[*k as usize].is_leaf()).collect();
        while let Some(k) = open.pop() {
            job::poll();
            if !self.cells[k as usize].is_leaf() || self.cells[k as usize].level < 2 {
                continue;
            }
            for side in 0..4 {
                let TreeCell { level, at, .. } = self.cells[k as usize];
                // The square of the next coarser level beyond the side must not lie in a larger leaf.
                let Some(next) = self.beyond(level, at, side) else { continue };
                if self.cells[next as usize].is_leaf() && self.cells[next as usize].level + 1 < level {
                    self.split(next);
                    let child = self.cells[next as usize].child;
                    open.push(k);
                    open.extend(child..child + 4);
                }
            }
        }
    }

    /// The leaf beyond a side of a square (right, left, above, below), or the cell of its own level.
    fn beyond(&self, level: u8, (i, j): (u32, u32), side: usize) -> Option<u32> {
        let (i, j) = match side {
            0 => (i + 1, j),
            1 => (i.checked_sub(1)?, j),
            2 => (i, j + 1),
            _ => (i, j.checked_sub(1)?),
        };
        self.find(level, (i, j))
    }

    /// The cell of a level at a place, or the leaf that holds it; `None` outside the roots.
    pub fn find(&self, level: u8, (i, j): (u32, u32)) -> Option<u32> {
        let root = (i >> level, j >> level);
        if root.0 >= self.roots.0 || root.1 >= self.roots.1 {
            return None;
        }
        let mut k = root.1 * self.roots.0 + root.0;
        while !self.cells[k as usize].is_leaf() && self.cells[k as usize].level < level {
            let down = level - self.cells[k as usize].level - 1;
            k = self.cells[k as usize].child + (i >> down & 1) + 2 * (j >> down & 1);
        }
        Some(k)
    }
}

/// Whether an open segment meets an open box: no axis parts them, nor the segment's own line.
pub fn meets([a, b]: [DVec2; 2], (low, high): (DVec2, DVec2)) -> bool {
    if !(a.max(b).cmpgt(low).all() && a.min(b).cmplt(high).all()) {
        return false;
    }
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let sides = corners.map(|c| orient(a, b, c));
    sides.iter().any(|s| *s > 0.0) && sides.iter().any(|s| *s < 0.0)
}
