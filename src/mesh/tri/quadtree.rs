//! Inner nodes from a quadtree: corners of its cells that lie inside and not too near to the border.
//!
//! Roots have the largest wanted length; a cell is split while its side in space is longer than wanted there, and a cell on
//! the border while its side is longer than the shortest segment in it. After balancing, no cell has a neighbour over an
//! edge of less than half its side, so lengths grow by two at most.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::tolerance::ON_EDGE;
use crate::mesh::chart::outline::Outline;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField};
use crate::mesh::tri::cells::Cells;
use crate::mesh::tri::front::{PlacedNodes, SIGHT, apart, samples};
use crate::mesh::tri::tree::{Cell, Class, Halt, Tree};
use crate::mesh::tri::trouble::Trouble;

/// Side of a cell over the wanted length: its diagonal is then hardly longer than a side may be.
const SIDE: f64 = 0.74;
/// Distance of a node to the border over the side of the cells about it.
const CLEAR: f64 = 0.5;
/// Least distance of two nodes over the longer side of the cells about one of them: where the chart is stretched, as towards a
/// pole, cells are much narrower than long, and their corners would lie in crowds.
const APART: f64 = 0.55;
/// Least distance of a node, in the chart, to an edge of the border whose chord is off the surface, over the side of the cells.
const BESIDE: f64 = 0.25;
/// Distance of an edge from the surface, over its length, from which on distances to its chord say little.
const BENT: f64 = 0.05;
/// Parts of an edge at whose ends its distance from the surface is looked at.
const PLACES: u32 = 8;
/// Roots along a side at most.
const ROOTS: f64 = 2048.0;
/// Places along each direction at which the largest wanted length is looked for.
const SAMPLES_PER_DIRECTION: usize = 16;

/// What a tree is made for.
pub struct Plot<'a> {
    /// The surface.
    pub chart_surface: &'a dyn ParametricSurface,
    /// Wanted lengths.
    pub field: &'a dyn SizeField,
    /// The border.
    pub outline: &'a Outline,
    /// Most nodes.
    pub most: usize,
}

/// The nodes of a balanced tree.
///
/// Fails where there are more cells than four for each node allowed, or cells had to be smaller than the deepest ones.
pub fn nodes(task: &Plot) -> Result<PlacedNodes, Trouble> {
    let outline = task.outline;
    let segments: Vec<[DVec2; 2]> = outline.edges().map(|e| e.map(|n| outline.xy[n as usize])).collect();
    // At a pole the chart has an edge that is a point in space: no cell can be as short as that.
    let length = |e| Some(outline.length(e)).filter(|l| *l > 0.0).unwrap_or(f64::INFINITY);
    let lengths: Vec<f64> = outline.edges().map(length).collect();
    let (low, high) = outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), xy| (l.min(*xy), h.max(*xy)));
    let side = SIDE * largest(task, low, high);
    let count = |x: f64| (x / side).ceil().clamp(1.0, ROOTS) as u32;
    let mut tree = Tree::new(&segments, outline.loops.len(), (low, high), (count(high.x - low.x), count(high.y - low.y)));
    let wants = |tree: &Tree, cell: &Cell| {
        if cell.class == Class::Exterior {
            return false;
        }
        let shortest = cell.segments.iter().map(|s| lengths[*s as usize]).fold(f64::INFINITY, f64::min);
        let (long, middle, p) = span(task.chart_surface, tree, cell);
        long > (SIDE * task.field.size(middle, p)).min(shortest)
    };
    if let Err(halt) = tree.refine(&wants, 4 * task.most) {
        let cell = |k: u32| &tree.cells()[k as usize];
        return Err(match halt {
            Halt::Full => Trouble::Full,
            Halt::Deep(k) => Trouble::Deep(span(task.chart_surface, &tree, cell(k)).2),
        });
    }
    tree.balance();
    Ok(corners(task, &segments, &tree))
}

/// The largest wanted length over a box of the chart, by looking.
fn largest(task: &Plot, low: DVec2, high: DVec2) -> f64 {
    let at = |k: usize| (k as f64 + 0.5) / SAMPLES_PER_DIRECTION as f64;
    let size = |k: usize| {
        let xy = task.chart_surface.clamp(low + (high - low) * DVec2::new(at(k % SAMPLES_PER_DIRECTION), at(k / SAMPLES_PER_DIRECTION)));
        task.field.size(xy, task.chart_surface.spot(xy).p)
    };
    (0..SAMPLES_PER_DIRECTION * SAMPLES_PER_DIRECTION).map(size).fold(0.0, f64::max).min((high - low).max_element())
}

/// Longer side of a cell in space, its middle in the chart and in space.
fn span(chart_surface: &dyn ParametricSurface, tree: &Tree, cell: &Cell) -> (f64, DVec2, DVec3) {
    let side = tree.side(cell.level);
    let middle = chart_surface.clamp(tree.corner(cell.level, cell.at) + 0.5 * side);
    let spot = chart_surface.spot(middle);
    ((spot.dx.length() * side.x).max(spot.dy.length() * side.y), middle, spot.p)
}

/// A corner of leaves: its place on the finest grid, and a leaf.
type Corner = ((u32, u32), u32);

fn corners(task: &Plot, segments: &[[DVec2; 2]], tree: &Tree) -> PlacedNodes {
    let depth = tree.cells().iter().map(|c| c.level).max().unwrap_or(0);
    let mut found: Vec<Corner> = Vec::new();
    for (k, cell) in tree.cells().iter().enumerate().filter(|(_, c)| c.is_leaf() && c.class != Class::Exterior) {
        job::poll();
        let up = depth - cell.level;
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            found.push((((cell.at.0 + i) << up, (cell.at.1 + j) << up), k as u32));
        }
    }
    // Row by row, as the lattice lies: neighbours in the list are neighbours on the face.
    found.sort_unstable_by_key(|((i, j), k)| (*j, *i, *k));
    let mut taken = PlacedCells::new(task);
    for run in found.chunk_by(|a, b| a.0 == b.0) {
        job::poll();
        let leaves: Vec<&Cell> = run.iter().map(|(_, k)| &tree.cells()[*k as usize]).collect();
        let xy = tree.corner(depth, run[0].0);
        if leaves.iter().all(|c| c.class == Class::Partial) && !tree.holds(xy) {
            continue;
        }
        let sides = leaves.iter().map(|c| (span(task.chart_surface, tree, c).0, tree.side(c.level)));
        let side = sides.reduce(|a, b| (a.0.min(b.0), a.1.min(b.1))).unwrap_or_default();
        let mut edges = leaves.iter().flat_map(|c| &c.segments).map(|s| segments[*s as usize]);
        if !edges.any(|edge| is_beside(xy, edge, side.1, ON_EDGE)) {
            taken.consider(xy, side);
        }
    }
    taken.grown
}

/// The nodes taken so far.
struct PlacedCells<'a> {
    task: &'a Plot<'a>,
    /// Places along the border.
    border: Cells,
    /// Edges of the border whose chords are off the surface, in the chart.
    bent: Vec<[DVec2; 2]>,
    nodes: Cells,
    grown: PlacedNodes,
}

impl<'a> PlacedCells<'a> {
    fn new(task: &'a Plot<'a>) -> Self {
        let outline = task.outline;
        let is_bent = |edge: &[u32; 2]| {
            let [a, b] = edge.map(|n| n as usize);
            let off = |k: u32| {
                let t = f64::from(k) / f64::from(PLACES);
                apart(task.chart_surface.spot(outline.xy[a].lerp(outline.xy[b], t)).p, outline.p[a], outline.p[b])
            };
            (1..PLACES).any(|k| off(k) > BENT * outline.length(*edge))
        };
        let bent = outline.edges().filter(is_bent).map(|edge| edge.map(|n| outline.xy[n as usize])).collect();
        let unit = outline.edges().map(|e| outline.length(e)).fold(f64::MIN_POSITIVE, f64::max);
        Self { task, border: samples(outline, task.field), bent, nodes: Cells::new(unit, true), grown: PlacedNodes::default() }
    }

    /// Takes a corner of cells with these least sides, in space and in the chart, where nothing is too near.
    fn consider(&mut self, xy: DVec2, (side, in_chart): (f64, DVec2)) {
        let outline = self.task.outline;
        let p = self.task.chart_surface.spot(xy).p;
        let size = self.task.field.size(xy, p);
        let near = self.border.any(p, SIGHT * size, size, |sample, _| {
            let [a, b] = outline.edge(sample.tag).map(|n| outline.p[n as usize]);
            apart(p, a, b) < CLEAR * side
        });
        let beside = |edge: &[DVec2; 2]| is_beside(xy, *edge, in_chart, BESIDE);
        if near || self.bent.iter().any(beside) || self.nodes.any(p, APART * side, side, |_, _| true) {
            return;
        }
        self.nodes.add(p, xy, side, 0);
        self.grown.xy.push(xy);
        self.grown.p.push(p);
        self.grown.size.push(size);
    }
}

/// Whether a place of the chart is nearer to an edge than a share of the sides of the cells.
fn is_beside(xy: DVec2, [a, b]: [DVec2; 2], sides: DVec2, share: f64) -> bool {
    let [p, a, b] = [xy, a, b].map(|place| (place / sides).extend(0.0));
    apart(p, a, b) < share
}
