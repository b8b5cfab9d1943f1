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
use crate::mesh::tri::front::{PlacedNodes, apart, border_points, samples};
use crate::mesh::tri::no_mesh::NoMesh;
use crate::mesh::tri::placement_settings::{FRONT, QUADTREE};
use crate::mesh::tri::point_hash::{Facing, PointHash, SurfacePoint};
use crate::mesh::tri::tree::{Class, Halt, Tree, TreeCell};

/// The face of a tree.
pub struct TreeFace<'a> {
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
pub fn nodes(task: &TreeFace) -> Result<PlacedNodes, NoMesh> {
    let outline = task.outline;
    let segments: Vec<[DVec2; 2]> = outline.edges().map(|e| e.map(|n| outline.xy[n as usize])).collect();
    // At a pole the chart has an edge that is a point in space: no cell can be as short as that.
    let length = |e| Some(outline.length(e)).filter(|l| *l > 0.0).unwrap_or(f64::INFINITY);
    let lengths: Vec<f64> = outline.edges().map(length).collect();
    let (low, high) = outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), xy| (l.min(*xy), h.max(*xy)));
    let side = QUADTREE.cell_side * largest(task, low, high);
    let count = |x: f64| (x / side).ceil().clamp(1.0, QUADTREE.max_roots) as u32;
    let mut tree = Tree::new(&segments, outline.loops.len(), (low, high), (count(high.x - low.x), count(high.y - low.y)));
    let needs_split = |tree: &Tree, cell: &TreeCell| {
        if cell.class == Class::Exterior {
            return false;
        }
        let shortest = cell.segments.iter().map(|s| lengths[*s as usize]).fold(f64::INFINITY, f64::min);
        let (long, middle, p) = span(task.chart_surface, tree, cell);
        long > (QUADTREE.cell_side * task.field.size(middle, p)).min(shortest)
    };
    if let Err(halt) = tree.refine(&needs_split, 4 * task.most) {
        let cell = |k: u32| &tree.cells()[k as usize];
        return Err(match halt {
            Halt::Full => NoMesh::TooManyNodes,
            Halt::Deep(k) => NoMesh::TreeTooDeep(span(task.chart_surface, &tree, cell(k)).2),
        });
    }
    tree.balance();
    Ok(corners(task, &segments, &tree))
}

/// The largest wanted length over a box of the chart, by samples.
fn largest(task: &TreeFace, low: DVec2, high: DVec2) -> f64 {
    let at = |k: usize| (k as f64 + 0.5) / QUADTREE.size_samples as f64;
    let size = |k: usize| {
        let xy = task.chart_surface.clamp(low + (high - low) * DVec2::new(at(k % QUADTREE.size_samples), at(k / QUADTREE.size_samples)));
        task.field.size(xy, task.chart_surface.spot(xy).p)
    };
    (0..QUADTREE.size_samples * QUADTREE.size_samples).map(size).fold(0.0, f64::max).min((high - low).max_element())
}

/// Longer side of a cell in space, its middle in the chart and in space.
fn span(chart_surface: &dyn ParametricSurface, tree: &Tree, cell: &TreeCell) -> (f64, DVec2, DVec3) {
    let side = tree.side(cell.level);
    let middle = chart_surface.clamp(tree.corner(cell.level, cell.at) + 0.5 * side);
    let spot = chart_surface.spot(middle);
    ((spot.dx.length() * side.x).max(spot.dy.length() * side.y), middle, spot.p)
}

/// A corner of leaves: its place on the finest grid, and a leaf.
type LeafCorner = ((u32, u32), u32);

fn corners(task: &TreeFace, segments: &[[DVec2; 2]], tree: &Tree) -> PlacedNodes {
    let depth = tree.cells().iter().map(|c| c.level).max().unwrap_or(0);
    let mut found: Vec<LeafCorner> = Vec::new();
    for (k, cell) in tree.cells().iter().enumerate().filter(|(_, c)| c.is_leaf() && c.class != Class::Exterior) {
        job::poll();
        let up = depth - cell.level;
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            found.push((((cell.at.0 + i) << up, (cell.at.1 + j) << up), k as u32));
        }
    }
    // Row by row, as the lattice lies: neighbours in the list are neighbours on the face.
    found.sort_unstable_by_key(|((i, j), k)| (*j, *i, *k));
    let mut placed = PlacedCells::new(task);
    for run in found.chunk_by(|a, b| a.0 == b.0) {
        job::poll();
        let leaves: Vec<&TreeCell> = run.iter().map(|(_, k)| &tree.cells()[*k as usize]).collect();
        let xy = tree.corner(depth, run[0].0);
        if leaves.iter().all(|c| c.class == Class::Partial) && !tree.holds(xy) {
            continue;
        }
        let sides = leaves.iter().map(|c| (span(task.chart_surface, tree, c).0, tree.side(c.level)));
        let side = sides.reduce(|a, b| (a.0.min(b.0), a.1.min(b.1))).unwrap_or_default();
        let mut edges = leaves.iter().flat_map(|c| &c.segments).map(|s| segments[*s as usize]);
        if !edges.any(|edge| is_beside(xy, edge, side.1, ON_EDGE)) {
            placed.consider(xy, side.0, side.1);
        }
    }
    placed.grown
}

/// The nodes placed so far.
struct PlacedCells<'a> {
    task: &'a TreeFace<'a>,
    /// Points may lie on two sides of a fold.
    has_folds: bool,
    /// Places along the border.
    border: PointHash,
    /// Edges of the border whose chords are off the surface, in the chart.
    bent: Vec<[DVec2; 2]>,
    nodes: PointHash,
    grown: PlacedNodes,
}

impl<'a> PlacedCells<'a> {
    fn new(task: &'a TreeFace<'a>) -> Self {
        let outline = task.outline;
        let is_bent = |edge: &[u32; 2]| {
            let [a, b] = edge.map(|n| n as usize);
            let off = |k: u32| {
                let t = f64::from(k) / f64::from(QUADTREE.edge_parts);
                apart(task.chart_surface.spot(outline.xy[a].lerp(outline.xy[b], t)).p, outline.p[a], outline.p[b])
            };
            (1..QUADTREE.edge_parts).any(|k| off(k) > QUADTREE.max_edge_deviation * outline.length(*edge))
        };
        let bent = outline.edges().filter(is_bent).map(|edge| edge.map(|n| outline.xy[n as usize])).collect();
        let unit = outline.edges().map(|e| outline.length(e)).fold(f64::MIN_POSITIVE, f64::max);
        let nodes = border_points(outline, task.chart_surface);
        Self {
            task,
            has_folds: nodes.iter().any(|node| node.facing != Facing::default()),
            border: samples(outline, task.field, &nodes),
            bent,
            nodes: PointHash::new(unit, true),
            grown: PlacedNodes::default(),
        }
    }

    /// Places a node at a corner of cells with these least sides, in space and in the chart, where nothing is too near.
    fn consider(&mut self, xy: DVec2, side: f64, side_in_chart: DVec2) {
        let outline = self.task.outline;
        let spot = self.task.chart_surface.spot(xy);
        let (p, at) = (spot.p, SurfacePoint::new(xy, &spot, self.has_folds));
        let size = self.task.field.size(xy, p);
        let near = self.border.any(at, FRONT.border_search_radius * size, size, |sample, _| {
            let [a, b] = outline.edge(sample.tag).map(|n| outline.p[n as usize]);
            apart(p, a, b) < QUADTREE.min_border_distance * side
        });
        let beside = |edge: &[DVec2; 2]| is_beside(xy, *edge, side_in_chart, QUADTREE.min_chart_distance);
        if near || self.bent.iter().any(beside) || self.nodes.any(at, QUADTREE.min_node_spacing * side, side, |_, _| true) {
            return;
        }
        self.nodes.add(at, side, 0);
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
