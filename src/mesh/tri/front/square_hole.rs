//! A hole in a lattice of squares: the rectangle of cells whose sides are the steps of its border.

use glam::DVec2;

use crate::base::job;
use crate::mesh::tri::placement_settings::SQUARE_HOLES;

/// Column and row of a node of a lattice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) x: i32,
    pub(super) y: i32,
}

impl Node {
    pub(super) const fn new(x: i32, y: i32) -> Self {
        Self { x, y }
    }

    pub(super) fn at(q: DVec2) -> Self {
        Self::new(q.x as i32, q.y as i32)
    }

    pub(super) fn place(self) -> DVec2 {
        DVec2::new(f64::from(self.x), f64::from(self.y))
    }

    pub(super) const fn plus(self, x: i32, y: i32) -> Self {
        Self::new(self.x + x, self.y + y)
    }
}

/// How the rectangle of a hole differs from the most likely one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Variant {
    /// Cells more along its upper side.
    pub(super) wider: i32,
    /// Columns to the right and rows up.
    pub(super) by: (i32, i32),
}

impl Variant {
    /// All that are tried.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let near = [0, -1, 1];
        let all = near.into_iter().flat_map(move |wider| near.into_iter().flat_map(move |x| near.map(|y| Self { wider, by: (x, y) })));
        all.skip(1)
    }
}

/// A hole as a rectangle of cells.
#[derive(Clone)]
pub(super) struct SquareHole {
    /// Which loop.
    pub(super) of: usize,
    /// Lowest and highest corner.
    pub(super) low: Node,
    pub(super) high: Node,
    /// For each node round the rectangle, clockwise from its upper left corner, the way from there to the node of the border.
    off: Vec<DVec2>,
    /// Number of rows about it in which nodes move.
    pub(super) reach: i32,
}

impl SquareHole {
    /// Distance in rows from the rectangle, 0 on it, negative inside.
    pub(super) fn rows_to(&self, q: DVec2) -> f64 {
        let d = (self.low.place() - q).max(q - self.high.place());
        d.x.max(d.y)
    }

    /// The way from the place of the rectangle nearest to a node to the node of the border there.
    pub(super) fn off_at(&self, at: Node) -> DVec2 {
        let on = Node::new(at.x.clamp(self.low.x, self.high.x), at.y.clamp(self.low.y, self.high.y));
        let size = Node::new(self.high.x - self.low.x, self.high.y - self.low.y);
        let place = if on.y == self.high.y {
            on.x - self.low.x
        } else if on.x == self.high.x {
            size.x + self.high.y - on.y
        } else if on.y == self.low.y {
            size.x + size.y + self.high.x - on.x
        } else {
            2 * size.x + size.y + on.y - self.low.y
        };
        self.off.get(usize::try_from(place).unwrap_or(0)).copied().unwrap_or_default()
    }

    /// Nodes on the rectangle and some rows about it.
    pub(super) fn about(&self, rows: i32) -> impl Iterator<Item = Node> + use<> {
        between(self.low.plus(-rows, -rows), self.high.plus(rows, rows))
    }

    /// Whether the nodes of two move each other.
    pub(super) fn meets(&self, other: &Self) -> bool {
        let apart = |low: i32, high: i32, from: i32, to: i32| (low - to).max(from - high);
        let columns = apart(self.low.x, self.high.x, other.low.x, other.high.x);
        columns.max(apart(self.low.y, self.high.y, other.low.y, other.high.y)) <= self.reach + other.reach
    }
}

/// A hole as the rectangle whose sides run most as its border does; `None` where it has an odd number of steps, or is no hole.
pub(super) fn hole(q: &[DVec2], of: usize, variant: Variant) -> Option<SquareHole> {
    let n = q.len();
    if n % 2 == 1 || n < SQUARE_HOLES.min_steps || area(q) >= 0.0 {
        return None;
    }
    let (low, high) = q.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), q| (l.min(*q), h.max(*q)));
    let extent = high - low;
    let half = n / 2;
    let likely = (half as f64 * extent.x / (extent.x + extent.y)).round() as usize;
    let mut best = (f64::NEG_INFINITY, 0, 0);
    let widths = if variant.wider == 0 {
        likely.saturating_sub(2).max(1)..=(likely + 2).min(half - 1)
    } else {
        let wide = likely.saturating_add_signed(variant.wider as isize).clamp(1, half - 1);
        wide..=wide
    };
    for wide in widths {
        for first in 0..n {
            job::poll();
            let [a, b, c, d] = [0, wide, half, half + wide].map(|k| q[(first + k) % n]);
            // To the right along the top, down, to the left, and up.
            let run = b.x - a.x + b.y - c.y + c.x - d.x + a.y - d.y;
            if run > best.0 {
                best = (run, first, wide);
            }
        }
    }
    let (_, first, wide) = best;
    let tall = half - wide;
    let (w, h) = (wide as i32, tall as i32);
    let round = |k: usize| {
        let k = k as i32;
        match () {
            () if k <= w => Node::new(k, 0),
            () if k <= w + h => Node::new(w, w - k),
            () if k <= 2 * w + h => Node::new(2 * w + h - k, -h),
            () => Node::new(0, k - 2 * w - 2 * h),
        }
    };
    let at = |k: usize| q[(first + k) % n];
    let mean = (0..n).map(|k| at(k) - round(k).place()).sum::<DVec2>() / n as f64;
    let corner = Node::at(mean.round()).plus(variant.by.0, variant.by.1);
    let off: Vec<DVec2> = (0..n).map(|k| at(k) - corner.place() - round(k).place()).collect();
    let farthest = off.iter().map(|d| d.length()).fold(0.0, f64::max);
    let reach = (SQUARE_HOLES.reach * farthest).ceil() as i32 + 1;
    Some(SquareHole { of, low: corner.plus(0, -h), high: corner.plus(w, 0), off, reach })
}

/// Nodes between two corners, both included.
pub(super) fn between(low: Node, high: Node) -> impl Iterator<Item = Node> {
    (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| Node::new(x, y)))
}

/// Twice the area inside a loop, negative of holes.
pub(super) fn area(q: &[DVec2]) -> f64 {
    (0..q.len()).map(|k| q[k].perp_dot(q[(k + 1) % q.len()])).sum()
}
