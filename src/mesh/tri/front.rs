//! Inner nodes: a lattice of equilateral triangles or of squares that grows over the surface from a seed until it meets the border.
//!
//! Each node proposes its neighbours at the wanted distance, in directions carried along from its parent; what comes too
//! near to a known point or to the border is dropped. On a plane with one size this is the regular lattice; on curved
//! surfaces and where sizes change, neighbouring fronts meet at distances that smoothing evens out.

mod square_hole;
mod square_lattice;
pub mod squares;
pub mod triangles;

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::{self, Job};
use crate::base::tolerance::NUDGE;
use crate::base::work;
use crate::mesh::chart::outline::{Outline, cross};
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField, Spot};
use crate::mesh::request::plan::TALL;
use crate::mesh::tri::placement_settings::FRONT;
use crate::mesh::tri::point_hash::{Facing, PointHash, SurfacePoint};

/// What a lattice is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LatticeCell {
    /// Equilateral triangles: six neighbours a node.
    Triangle,
    /// Squares: four neighbours a node.
    Square,
}

/// Which holes of a plane face are rectangles of its lattice of squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HolesInLattice {
    /// None: rows follow every border.
    None,
    /// Those with room for one about their middle.
    WithRoom,
    /// As many as a search finds room for.
    Searched,
}

/// What growing needs.
pub struct FrontInput<'a> {
    /// The surface.
    pub chart_surface: &'a dyn ParametricSurface,
    /// The wanted lengths.
    pub field: &'a dyn SizeField,
    /// The border.
    pub outline: &'a Outline,
    /// Places where a lattice may start, with a direction in space (zero: any).
    pub seeds: &'a [(DVec2, DVec3)],
    /// What grows.
    pub cell: LatticeCell,
    /// Which holes of plane faces are rectangles of a lattice of squares.
    pub holes: HolesInLattice,
    /// Most nodes.
    pub most: usize,
}

/// Nodes that the front placed.
#[derive(Clone, Debug, Default)]
pub struct PlacedNodes {
    /// Places in the chart.
    pub xy: Vec<DVec2>,
    /// Points.
    pub p: Vec<DVec3>,
    /// Wanted lengths there.
    pub size: Vec<f64>,
    /// There would have been more than the limit.
    pub full: bool,
}

/// A node of the lattice: its place, its point and the wanted length there.
#[derive(Clone, Copy)]
struct FrontNode {
    xy: DVec2,
    p: DVec3,
    size: f64,
}

/// A step of the front from a place in the chart to a point, with the wanted length there.
#[derive(Clone, Copy)]
struct FrontStep {
    from: DVec2,
    to: SurfacePoint,
    size: f64,
}

struct Front<'a> {
    input: &'a FrontInput<'a>,
    /// Nodes of the border and inner nodes.
    nodes: PointHash,
    /// Samples of the border's edges.
    border: PointHash,
    edges: Vec<[u32; 2]>,
    /// Points may lie on two sides of a fold.
    has_folds: bool,
    grown: PlacedNodes,
    along: Vec<DVec3>,
    open: VecDeque<u32>,
    /// Steps of squares along and across the lattice, over the wanted length.
    steps: [f64; 2],
    /// The box of the border in the chart: nodes that passed between two steps of the border do not grow beyond it.
    within: (DVec2, DVec2),
    /// Nodes of the first row of squares.
    row: u32,
    /// Nodes from there to here are those of a lattice of squares that was placed as a whole.
    lattice_end: u32,
    /// Directions of nodes of the first row from the border.
    arms: Vec<DVec3>,
}

/// Grows nodes from the seeds, the first ones first.
pub fn grow(input: &FrontInput, job: &Job) -> Result<PlacedNodes> {
    let outline = input.outline;
    let edges: Vec<[u32; 2]> = outline.edges().collect();
    let unit = edges.iter().map(|e| outline.length(*e)).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let mut front = Front {
        input,
        nodes: PointHash::new(unit, !input.field.is_even()),
        border: PointHash::new(unit, !input.field.is_even()),
        edges,
        has_folds: false,
        grown: PlacedNodes::default(),
        along: Vec::new(),
        open: VecDeque::new(),
        steps: [1.0; 2],
        within: outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), xy| (l.min(*xy), h.max(*xy))),
        row: 0,
        lattice_end: 0,
        arms: Vec::new(),
    };
    front.border();
    let first = match input.cell {
        LatticeCell::Triangle => front.layer(),
        LatticeCell::Square => front.layer_of_squares(),
    };
    let firsts = first.into_iter().map(|n| (None, n));
    let seeds = input.seeds.iter().map(|s| (Some(*s), 0));
    for (seed, node) in firsts.chain(seeds) {
        match seed {
            Some((xy, along)) => front.seed(xy, along),
            None => front.open.push_back(node),
        }
        let mut watch = 0;
        while let Some(node) = front.open.pop_front() {
            front.expand(node as usize);
            watch += 1;
            if watch % FRONT.nodes_per_check == 0 {
                job.go_on()?;
            }
            if front.grown.p.len() > input.most {
                front.grown.full = true;
                return Ok(front.grown);
            }
        }
    }
    Ok(front.grown)
}

impl Front<'_> {
    /// Nodes and samples of the border.
    fn border(&mut self) {
        let outline = self.input.outline;
        let nodes = border_points(outline, self.input.chart_surface);
        self.has_folds = nodes.iter().any(|node| node.facing != Facing::default());
        for node in &nodes {
            self.nodes.add(*node, self.input.field.size(node.xy, node.p), u32::MAX);
        }
        self.border = samples(outline, self.input.field, &nodes);
    }

    fn seed(&mut self, xy: DVec2, along: DVec3) {
        let spot = self.input.chart_surface.spot(xy);
        let size = self.input.field.size(xy, spot.p);
        let at = self.point(xy, &spot);
        if self.near_node(at, size) || self.near_border(FrontStep { from: xy, to: at, size }) {
            return;
        }
        let normal = spot.normal();
        let along = along.reject_from_normalized(normal).try_normalize().unwrap_or_else(|| spot.dx.normalize_or_zero());
        self.add(at, size, along);
    }

    fn add(&mut self, at: SurfacePoint, size: f64, along: DVec3) {
        let id = self.grown.p.len() as u32;
        self.nodes.add(at, size, id);
        self.grown.xy.push(at.xy);
        self.grown.p.push(at.p);
        self.grown.size.push(size);
        self.along.push(along);
        self.open.push_back(id);
    }

    /// Proposes the neighbours of a node.
    fn expand(&mut self, node: usize) {
        let from = FrontNode { xy: self.grown.xy[node], p: self.grown.p[node], size: self.grown.size[node] };
        let spot = self.input.chart_surface.spot(from.xy);
        let normal = spot.normal();
        let ahead = self.along[node];
        let aside = normal.cross(ahead);
        if self.input.cell == LatticeCell::Square {
            let [along, across] = self.steps;
            for (way, ratio) in [(ahead, along), (aside, across), (-ahead, along), (-aside, across)] {
                self.propose(from, &spot, way, ratio, Some(ahead));
            }
            return;
        }
        const HALF: f64 = 0.5;
        let tall = aside * TALL;
        let ways = [ahead, ahead * HALF + tall, -ahead * HALF + tall, -ahead, -ahead * HALF - tall, ahead * HALF - tall];
        for way in ways {
            self.propose(from, &spot, way, 1.0, None);
        }
    }

    /// Places a neighbour in the direction `way`, `ratio` times the wanted length away, where none is near; its own first direction is `ahead`, or
    /// the one of the step.
    fn propose(&mut self, from: FrontNode, spot: &Spot, way: DVec3, ratio: f64, ahead: Option<DVec3>) {
        let FrontNode { xy, p, size } = from;
        let Some(step) = spot.step(way * size) else { return };
        let here = self.point(xy, spot);
        let on_tangent = |length: f64| SurfacePoint { p: p + way * length, xy: xy + step * (length / size), ..here };
        let guess = on_tangent(size);
        if self.input.cell == LatticeCell::Triangle && self.nodes.beside(guess, FRONT.min_guess_spacing * size, size) {
            return;
        }
        // The mean of the lengths wanted here and there.
        let there = self.input.field.size(self.input.chart_surface.clamp(guess.xy), guess.p);
        let length = 0.5 * (size + there) * ratio;
        let wanted = on_tangent(length);
        if self.near_node(wanted, there) {
            return;
        }
        let outside = wanted.xy.cmplt(self.within.0).any() || wanted.xy.cmpgt(self.within.1).any();
        if outside || self.near_border(FrontStep { from: xy, to: wanted, size: there }) {
            return;
        }
        let spot_at = |xy: DVec2| {
            let xy = self.input.chart_surface.clamp(xy);
            (xy, self.input.chart_surface.spot(xy))
        };
        let (mut to, mut new) = spot_at(wanted.xy);
        let mut at = self.point(to, &new);
        // The surface bends away from its tangent plane: a second step with the corrected length, but not beyond a fold.
        let reached = new.p.distance(p);
        if (reached - length).abs() > FRONT.max_step_error * length && reached > 0.0 {
            if !at.facing.is_opposite(here.facing) {
                (to, new) = spot_at(xy + step * (length / size) * (length / reached));
                at = self.point(to, &new);
            }
            if self.near_border(FrontStep { from: xy, to: at, size: there }) {
                return;
            }
        }
        if new.p.distance(p) > FRONT.max_step_ratio * length || self.is_on_edge(to) {
            return;
        }
        let off = new.p.distance_squared(wanted.p);
        if off > FRONT.same_place_distance * FRONT.same_place_distance * there * there && self.near_node(at, there) {
            return;
        }
        let arm = ahead.unwrap_or(new.p - p);
        let along = arm.reject_from_normalized(new.normal()).normalize_or_zero();
        if along != DVec3::ZERO {
            self.add(at, there, along);
        }
    }

    /// Whether a place is on the box of the border in the chart, where only nodes of the border are: a step was clamped there.
    fn is_on_edge(&self, xy: DVec2) -> bool {
        !(xy.cmpgt(self.within.0).all() && xy.cmplt(self.within.1).all())
    }

    /// A point of the surface; where nothing is folded all points face all ways.
    fn point(&self, xy: DVec2, spot: &Spot) -> SurfacePoint {
        SurfacePoint::new(xy, spot, self.has_folds)
    }

    fn near_node(&self, p: SurfacePoint, size: f64) -> bool {
        if self.input.cell == LatticeCell::Square {
            return self.near_square(p, size);
        }
        self.nodes.any(p, FRONT.min_node_spacing * size, size, |_, _| true)
    }

    /// Whether a step meets the border or ends too near to it.
    fn near_border(&self, step: FrontStep) -> bool {
        self.near_edges(step, FRONT.min_border_distance, None)
    }

    /// Whether a step meets an edge of the border, or ends nearer to one than `min_distance` times the wanted length. A step from a
    /// `node` of the border may meet its edges.
    fn near_edges(&self, step: FrontStep, min_distance: f64, node: Option<u32>) -> bool {
        let FrontStep { from, to, size } = step;
        let outline = self.input.outline;
        self.border.any(to, FRONT.border_search_radius * size, size, |sample, _| {
            let edge = self.edges[sample.tag as usize];
            let [a, b] = edge.map(|n| n as usize);
            let own = node.is_some_and(|n| edge.contains(&n));
            !own && cross(from, to.xy, outline.xy[a], outline.xy[b]) || apart(to.p, outline.p[a], outline.p[b]) < min_distance * size
        })
    }
}

/// The nodes of a border. On planes and on faces with a pole, beside which opposite sides are near each other, they face all ways.
pub(crate) fn border_points(outline: &Outline, chart_surface: &dyn ParametricSurface) -> Vec<SurfacePoint> {
    let is_bent = chart_surface.plane().is_none() && outline.edges().all(|edge| outline.length(edge) > 0.0);
    let facing = |xy: DVec2| if is_bent { Facing::of(chart_surface.spot(xy).normal()) } else { Facing::default() };
    outline.p.iter().zip(&outline.xy).map(|(p, xy)| SurfacePoint { p: *p, xy: *xy, facing: facing(*xy) }).collect()
}

/// Samples along the edges of a border, near enough to each other that each edge is found from a step away; tagged by edge.
pub(crate) fn samples(outline: &Outline, field: &dyn SizeField, nodes: &[SurfacePoint]) -> PointHash {
    let unit = outline.edges().map(|e| outline.length(e)).fold(f64::MIN_POSITIVE, f64::max);
    let mut cells = PointHash::new(unit, !field.is_even());
    for (k, [a, b]) in outline.edges().enumerate() {
        job::poll();
        let (pa, pb) = (outline.p[a as usize], outline.p[b as usize]);
        let (xa, xb) = (outline.xy[a as usize], outline.xy[b as usize]);
        let size = |t: f64| field.size(xa.lerp(xb, t), pa.lerp(pb, t));
        // Where lengths grow along an edge, its parts have places as far apart as lengths are there.
        let mut open = vec![(0.0, 1.0, FRONT.max_edge_halvings)];
        while let Some((from, to, left)) = open.pop() {
            let middle = 0.5 * (from + to);
            let least = [from, middle, to].map(size).into_iter().fold(f64::INFINITY, f64::min);
            let n = ((to - from) * pa.distance(pb) / (least * FRONT.border_sample_spacing)).ceil().clamp(1.0, 1e6) as usize;
            if n > FRONT.max_equal_samples && left > 0 {
                open.extend([(middle, to, left - 1), (from, middle, left - 1)]);
                continue;
            }
            work::spend(FRONT.sample_work * n as u64);
            for i in 0..=n {
                let t = from + (to - from) * i as f64 / n as f64;
                let facing = nodes[if t < 0.5 { a } else { b } as usize].facing;
                cells.add(SurfacePoint { p: pa.lerp(pb, t), xy: xa.lerp(xb, t), facing }, size(t), k as u32);
            }
        }
    }
    cells
}

/// Cosine between edges that run straight on.
pub(crate) const STRAIGHT: f64 = 1.0 - NUDGE;

/// Distance of a point from a segment.
pub(crate) fn apart(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    p.distance(a + d * t)
}
