//! A lattice of squares over a plane face, bent to the holes in it: a hole with an even number of steps is a rectangle of cells to
//! the lattice, whose sides are those steps, so that rows run up to it and none ends. What the lattice has to move for that fades with the
//! distance from the hole; a hole with too little room for it stays with rows of its own.

use glam::DVec2;

use crate::base::job;
use crate::mesh::chart::outline::Outline;
use crate::mesh::tri::front::square_hole::{Node, SquareHole, Variant, area, between, hole};
use crate::mesh::tri::placement_settings::SQUARE_HOLES;

/// A lattice in the plane: the place of a node of it, and its steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct LatticeFrame {
    /// A node.
    pub origin: DVec2,
    /// The step along, in the chart; the other one is perpendicular.
    pub along: DVec2,
    /// The step across.
    pub across: DVec2,
}

impl LatticeFrame {
    /// Lattice coordinates of a place.
    fn inward(&self, xy: DVec2) -> DVec2 {
        let d = xy - self.origin;
        DVec2::new(d.dot(self.along) / self.along.length_squared(), d.dot(self.across) / self.across.length_squared())
    }

    /// The place of lattice coordinates.
    fn outward(&self, q: DVec2) -> DVec2 {
        self.origin + self.along * q.x + self.across * q.y
    }
}

/// A loop of the border in lattice coordinates, the face on its left.
struct Loop {
    /// Places.
    q: Vec<DVec2>,
    /// First node of the outline of each of its edges.
    nodes: Vec<u32>,
}

/// What a node of the lattice is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Outside the border.
    Outside,
    /// At its place.
    Still,
    /// At its place, beside a border that the lattice does not fit.
    Pinned,
    /// Moved for a hole.
    Moved,
    /// A node of the border of a hole.
    Rim,
    /// Inside a hole.
    Hole,
}

/// A lattice with holes.
pub(super) struct SquareLattice {
    frame: LatticeFrame,
    loops: Vec<Loop>,
    holes: Vec<SquareHole>,
    /// Nodes of the outline on loops of holes that are rectangles of it.
    fitted: Vec<bool>,
    /// Lowest node, and numbers of columns and rows.
    low: Node,
    size: Node,
    kind: Vec<Kind>,
    /// Places of nodes.
    q: Vec<DVec2>,
}

impl SquareLattice {
    /// The lattice of a frame over an outline, with the wanted length at a place of the chart over its steps; other rectangles are tried for holes
    /// that have too little room if there is a `search` for them. `None` where most of the box round it is outside.
    pub fn new(outline: &Outline, frame: LatticeFrame, wanted: &dyn Fn(DVec2) -> f64, search: bool) -> Option<Self> {
        let loops = loops(outline, &frame);
        let outer = (0..loops.len()).max_by(|a, b| area(&loops[*a].q).total_cmp(&area(&loops[*b].q)))?;
        let all = loops.iter().flat_map(|l| &l.q);
        let (low, high) = all.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), q| (l.min(*q), h.max(*q)));
        let columns = high.ceil() - low.floor() + 1.0;
        let inside = 0.5 * area(&loops[outer].q);
        if columns.x * columns.y > SQUARE_HOLES.max_box_over_area * inside + SQUARE_HOLES.small_box {
            return None;
        }
        let holes = (0..loops.len())
            .filter(|k| *k != outer && outline.lines.is_empty())
            .filter_map(|k| hole(&loops[k].q, k, Variant::default()))
            .collect();
        let (low, size) = (Node::at(low.floor()), Node::at(columns));
        let fitted = vec![false; outline.p.len()];
        let mut lattice = Self { frame, loops, holes, fitted, low, size, kind: Vec::new(), q: Vec::new() };
        lattice.drop_refined(wanted);
        if search {
            lattice.search();
        } else {
            lattice.lay();
            while lattice.drop_strained() {
                lattice.lay();
            }
        }
        for hole in &lattice.holes {
            lattice.loops[hole.of].nodes.iter().for_each(|n| lattice.fitted[*n as usize] = true);
        }
        Some(lattice)
    }

    /// Whether a node of the outline is on a hole that the lattice fits.
    pub fn fits(&self, node: u32) -> bool {
        self.fitted[node as usize]
    }

    /// Nodes inside the border, with whether they were moved for a hole, as long as they are taken.
    pub fn nodes(&self, mut add: impl FnMut(DVec2, bool) -> bool) {
        for (kind, q) in job::looking(self.kind.iter().zip(&self.q)) {
            let is_node = matches!(kind, Kind::Still | Kind::Pinned | Kind::Moved);
            if is_node && !add(self.frame.outward(*q), *kind == Kind::Moved) {
                return;
            }
        }
    }

    /// Takes holes out of the lattice beside which much shorter lengths are wanted than its steps.
    fn drop_refined(&mut self, wanted: &dyn Fn(DVec2) -> f64) {
        let frame = self.frame;
        let is_even = |at: Node| wanted(frame.outward(at.place())) >= SQUARE_HOLES.min_wanted;
        self.holes.retain(|hole| hole.about(1).all(is_even));
    }

    /// The longer step, chart units.
    pub fn step(&self) -> f64 {
        self.frame.along.length().max(self.frame.across.length())
    }

    fn index(&self, at: Node) -> Option<usize> {
        let d = at.plus(-self.low.x, -self.low.y);
        let is_in = d.x >= 0 && d.y >= 0 && d.x < self.size.x && d.y < self.size.y;
        is_in.then(|| d.y as usize * self.size.x as usize + d.x as usize)
    }

    fn at(&self, index: usize) -> Node {
        self.low.plus((index % self.size.x as usize) as i32, (index / self.size.x as usize) as i32)
    }

    /// All nodes, moved for the holes as they are.
    fn lay(&mut self) {
        let n = self.size.x as usize * self.size.y as usize;
        self.kind = vec![Kind::Outside; n];
        self.q = job::looking(0..n).map(|k| self.at(k).place()).collect();
        let is_hole = |k: usize| self.holes.iter().any(|hole| hole.of == k);
        let rest: Vec<usize> = (0..self.loops.len()).filter(|k| !is_hole(*k)).collect();
        let mut edges: Vec<Vec<f64>> = vec![Vec::new(); self.size.y as usize];
        for q in rest.iter().map(|k| &self.loops[*k].q) {
            for k in 0..q.len() {
                job::poll();
                let (a, b) = (q[k], q[(k + 1) % q.len()]);
                for y in a.y.min(b.y).ceil() as i32..a.y.max(b.y).ceil() as i32 {
                    edges[(y - self.low.y) as usize].push(a.x + (b.x - a.x) * (f64::from(y) - a.y) / (b.y - a.y));
                }
            }
        }
        for (row, crossings) in edges.iter_mut().enumerate() {
            crossings.sort_by(f64::total_cmp);
            for span in crossings.chunks_exact(2) {
                for x in span[0].ceil() as i32..=span[1].floor() as i32 {
                    self.kind[row * self.size.x as usize + (x - self.low.x) as usize] = Kind::Still;
                }
            }
        }
        for q in rest.iter().flat_map(|k| &self.loops[*k].q) {
            let (low, high) = ((*q - SQUARE_HOLES.rows_beside_border).ceil(), (*q + SQUARE_HOLES.rows_beside_border).floor());
            for at in between(Node::at(low), Node::at(high)) {
                if let Some(k) = self.index(at)
                    && self.kind[k] == Kind::Still
                {
                    self.kind[k] = Kind::Pinned;
                }
            }
        }
        self.cut_holes();
        self.relax();
    }

    /// Cuts the rectangles out; those that do not fit between others are left out.
    fn cut_holes(&mut self) {
        let holes = std::mem::take(&mut self.holes);
        for hole in holes {
            let free = |at: Node| self.index(at).is_some_and(|k| !matches!(self.kind[k], Kind::Outside | Kind::Rim | Kind::Hole));
            if !hole.about(1).all(free) {
                continue;
            }
            for at in hole.about(0) {
                let is_inside = hole.rows_to(at.place()) < 0.0;
                if let Some(k) = self.index(at) {
                    self.kind[k] = if is_inside { Kind::Hole } else { Kind::Rim };
                    self.q[k] += if is_inside { DVec2::ZERO } else { hole.off_at(at) };
                }
            }
            self.holes.push(hole);
        }
        for hole in &self.holes {
            for at in hole.about(hole.reach) {
                let Some(k) = self.index(at) else { continue };
                if matches!(self.kind[k], Kind::Still | Kind::Moved) {
                    self.kind[k] = Kind::Moved;
                    self.q[k] += hole.off_at(at) * (1.0 - hole.rows_to(at.place()) / f64::from(hole.reach + 1));
                }
            }
        }
    }

    /// Moves nodes to the means of their neighbours.
    fn relax(&mut self) {
        let width = self.size.x as usize;
        let inner = |k: &usize| !k.is_multiple_of(width) && k % width + 1 < width && *k >= width && k + width < self.q.len();
        let moved: Vec<usize> = (0..self.q.len()).filter(|k| self.kind[*k] == Kind::Moved).filter(inner).collect();
        for _ in 0..SQUARE_HOLES.sweeps {
            for k in job::looking(&moved).copied() {
                let mean = 0.25 * (self.q[k - 1] + self.q[k + 1] + self.q[k - width] + self.q[k + width]);
                self.q[k] = self.q[k].lerp(mean, SQUARE_HOLES.relaxation);
            }
        }
    }

    /// Takes holes out of the lattice round which cells are strained too much, the worst ones first; whether there were any.
    fn drop_strained(&mut self) -> bool {
        let scores: Vec<f64> = self.holes.iter().map(|hole| self.score(hole)).collect();
        let mut order: Vec<usize> = (0..scores.len()).filter(|k| scores[*k] < SQUARE_HOLES.min_quality).collect();
        order.sort_by(|a, b| scores[*a].total_cmp(&scores[*b]).then(a.cmp(b)));
        let mut dropped: Vec<usize> = Vec::new();
        for k in order {
            job::poll();
            // What strains a neighbour may be the one that is dropped.
            if !dropped.iter().any(|other| self.holes[k].meets(&self.holes[*other])) {
                dropped.push(k);
            }
        }
        let mut k = 0;
        self.holes.retain(|_| {
            k += 1;
            !dropped.contains(&(k - 1))
        });
        !dropped.is_empty()
    }

    /// Lays the lattice with as many holes as have room, if need be as other rectangles.
    fn search(&mut self) {
        let mut left = SQUARE_HOLES.max_search;
        let mut tried = vec![false; self.loops.len()];
        loop {
            let all = self.holes.clone();
            self.lay();
            let scores = self.scores();
            // Those that others leave no place for come first.
            let worst = all.iter().map(|hole| (scores[hole.of], hole.of)).filter(|s| s.0 < SQUARE_HOLES.min_quality);
            let Some((_, of)) = worst.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) else { return };
            let mut others: Vec<SquareHole> = all.into_iter().filter(|hole| hole.of != of).collect();
            if !std::mem::replace(&mut tried[of], true) {
                let new = self.variant(of, &others, &scores, &mut left);
                others.extend(new);
            }
            self.holes = others;
        }
    }

    /// The other rectangle of a hole that leaves it and its neighbours the best cells; `None` where all are strained too much.
    fn variant(&mut self, of: usize, others: &[SquareHole], before: &[f64], left: &mut usize) -> Option<SquareHole> {
        let mut best: Option<(f64, SquareHole)> = None;
        for variant in Variant::all() {
            let Some(new) = hole(&self.loops[of].q, of, variant) else { continue };
            let Some(rest) = left.checked_sub(self.q.len()) else { break };
            *left = rest;
            self.holes = others.to_vec();
            self.holes.push(new.clone());
            self.lay();
            let after = self.scores();
            let near = others.iter().filter(|hole| hole.meets(&new) && before[hole.of] >= SQUARE_HOLES.min_quality);
            let least = near.map(|hole| after[hole.of]).fold(after[of], f64::min);
            if least >= SQUARE_HOLES.min_quality && best.as_ref().is_none_or(|best| least > best.0) {
                best = Some((least, new));
            }
        }
        best.map(|best| best.1)
    }

    /// The score of each loop that is a hole of the lattice; -1 of others.
    fn scores(&self) -> Vec<f64> {
        let mut scores = vec![-1.0; self.loops.len()];
        self.holes.iter().for_each(|hole| scores[hole.of] = self.score(hole));
        scores
    }

    /// The least quality of the cells about a hole: the sines of their corners, and their sides over a share of a step.
    fn score(&self, hole: &SquareHole) -> f64 {
        let width = self.size.x as usize;
        let mut worst = f64::INFINITY;
        for at in hole.about(SQUARE_HOLES.scored_rows) {
            job::poll();
            let Some(k) = self.index(at) else { continue };
            let corners = [k, k + 1, k + width + 1, k + width];
            let is_cell = corners.iter().all(|k| self.kind.get(*k).is_some_and(|kind| !matches!(kind, Kind::Outside | Kind::Hole)));
            let middle = at.place() + 0.5;
            if !is_cell || (at.x - self.low.x) as usize + 1 >= width || self.holes.iter().any(|hole| hole.rows_to(middle) < 0.0) {
                continue;
            }
            let (p, is_rim) = (corners.map(|k| self.q[k]), corners.map(|k| self.kind[k] == Kind::Rim));
            for k in 0..4 {
                let (on, back) = (p[(k + 1) % 4] - p[k], p[(k + 3) % 4] - p[k]);
                let sine = on.perp_dot(back) / (on.length() * back.length());
                // The border's own steps are given.
                let given = is_rim[k] && is_rim[(k + 1) % 4];
                let side = if given { f64::INFINITY } else { on.length() / SQUARE_HOLES.min_side };
                worst = worst.min(sine).min(side * SQUARE_HOLES.min_quality);
            }
        }
        worst
    }
}

/// The loops of an outline in lattice coordinates.
fn loops(outline: &Outline, frame: &LatticeFrame) -> Vec<Loop> {
    let mut loops: Vec<Loop> = Vec::new();
    let mut last = None;
    for [a, b] in job::looking(&outline.loops).copied() {
        if last != Some(a) {
            loops.push(Loop { q: Vec::new(), nodes: Vec::new() });
        }
        if let Some(own) = loops.last_mut() {
            own.q.push(frame.inward(outline.xy[a as usize]));
            own.nodes.push(a);
        }
        last = Some(b);
    }
    loops
}
