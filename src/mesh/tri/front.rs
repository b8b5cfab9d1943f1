//! Inner nodes: a lattice of equilateral triangles or of squares that grows over the surface from a seed until it meets the border.
//!
//! Each node proposes its neighbours at the wanted distance, in directions carried along from its parent; what comes too
//! near to a known point or to the border is dropped. On a plane with one size this is the regular lattice; on curved
//! surfaces and where sizes change, neighbouring fronts meet at distances that smoothing evens out.

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
use crate::mesh::tri::cells::Cells;

/// Nearest distance between two nodes, as a share of the wanted length.
const APART: f64 = 0.7;
/// The same before the length wanted there is known, which is hardly ever less than half of that here; where it is, nodes that are
/// nearer to it grow there.
const TAKEN: f64 = 0.5 * APART;
/// Distance of two places, as a share of the wanted length, within which what is near to one counts as near to the other: nodes may be as
/// much nearer to each other.
const SAME_PLACE_SHARE: f64 = 0.02;
/// Nearest distance of a node to an edge of the border, as a share of the wanted length.
const CLEAR: f64 = 0.52;
/// How far along the border its samples are apart, as a share of the wanted length.
const SAMPLES: f64 = 0.5;
/// How far the border is looked for, as a share of the wanted length: a step and half a sample's distance.
pub(crate) const SIGHT: f64 = 1.3;
/// Nodes between two questions whether to go on.
const WATCH: usize = 4096;

/// What a lattice is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    /// Equilateral triangles: six neighbours a node.
    Triangle,
    /// Squares: four neighbours a node.
    Square,
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
    pub cell: Cell,
    /// Most nodes.
    pub most: usize,
}

/// Nodes that grew.
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

struct Front<'a> {
    input: &'a FrontInput<'a>,
    /// Nodes of the border and inner nodes.
    nodes: Cells,
    /// Samples of the border's edges.
    border: Cells,
    edges: Vec<[u32; 2]>,
    grown: PlacedNodes,
    along: Vec<DVec3>,
    open: VecDeque<u32>,
    /// Steps of squares along and across the lattice, over the wanted length.
    steps: [f64; 2],
    /// The box of the border in the chart: what got through between two steps of it grows no further.
    within: (DVec2, DVec2),
    /// Nodes of the first row of squares.
    row: u32,
    /// Their directions from the border.
    arms: Vec<DVec3>,
}

/// Grows nodes from the seeds, the first ones first.
pub fn grow(input: &FrontInput, job: &Job) -> Result<PlacedNodes> {
    let outline = input.outline;
    let edges: Vec<[u32; 2]> = outline.edges().collect();
    let unit = edges.iter().map(|e| outline.length(*e)).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let mut front = Front {
        input,
        nodes: Cells::new(unit, !input.field.is_even()),
        border: Cells::new(unit, !input.field.is_even()),
        edges,
        grown: PlacedNodes::default(),
        along: Vec::new(),
        open: VecDeque::new(),
        steps: [1.0; 2],
        within: outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), xy| (l.min(*xy), h.max(*xy))),
        row: 0,
        arms: Vec::new(),
    };
    front.border();
    let first = match input.cell {
        Cell::Triangle => front.layer(),
        Cell::Square => front.layer_of_squares(),
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
            front.enclosure(node as usize);
            watch += 1;
            if watch % WATCH == 0 {
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
        for (p, xy) in outline.p.iter().zip(&outline.xy) {
            self.nodes.add(*p, *xy, self.input.field.size(*xy, *p), u32::MAX);
        }
        self.border = samples(outline, self.input.field);
    }

    fn seed(&mut self, xy: DVec2, along: DVec3) {
        let spot = self.input.chart_surface.spot(xy);
        let size = self.input.field.size(xy, spot.p);
        if self.near_node(spot.p, size) || self.near_border(xy, xy, spot.p, size) {
            return;
        }
        let normal = spot.normal();
        let along = along.reject_from_normalized(normal).try_normalize().unwrap_or_else(|| spot.dx.normalize_or_zero());
        self.take(xy, spot.p, size, along);
    }

    fn take(&mut self, xy: DVec2, p: DVec3, size: f64, along: DVec3) {
        let id = self.grown.p.len() as u32;
        self.nodes.add(p, xy, size, id);
        self.grown.xy.push(xy);
        self.grown.p.push(p);
        self.grown.size.push(size);
        self.along.push(along);
        self.open.push_back(id);
    }

    /// Proposes the neighbours of a node.
    fn enclosure(&mut self, node: usize) {
        let (xy, p, size) = (self.grown.xy[node], self.grown.p[node], self.grown.size[node]);
        let spot = self.input.chart_surface.spot(xy);
        let normal = spot.normal();
        let ahead = self.along[node];
        let aside = normal.cross(ahead);
        if self.input.cell == Cell::Square {
            let [along, across] = self.steps;
            for (way, segment) in [(ahead, along), (aside, across), (-ahead, along), (-aside, across)] {
                self.propose((xy, p, size), &spot, (way, segment), Some(ahead));
            }
            return;
        }
        const HALF: f64 = 0.5;
        let tall = aside * TALL;
        let ways = [ahead, ahead * HALF + tall, -ahead * HALF + tall, -ahead, -ahead * HALF - tall, ahead * HALF - tall];
        for way in ways {
            self.propose((xy, p, size), &spot, (way, 1.0), None);
        }
    }

    /// A neighbour in a direction, `segment` times the wanted length away; it carries `ahead` on, or looks on along the arm.
    fn propose(&mut self, (xy, p, size): (DVec2, DVec3, f64), spot: &Spot, (way, segment): (DVec3, f64), ahead: Option<DVec3>) {
        let guess = p + way * size;
        if self.input.cell == Cell::Triangle && self.nodes.beside(guess, TAKEN * size, size) {
            return;
        }
        let Some(step) = spot.step(way * size) else { return };
        // The mean of the lengths wanted here and there.
        let there = self.input.field.size(self.input.chart_surface.clamp(xy + step), guess);
        let length = 0.5 * (size + there) * segment;
        if self.near_node(p + way * length, there) {
            return;
        }
        let step = step * (length / size);
        let outside = (xy + step).cmplt(self.within.0).any() || (xy + step).cmpgt(self.within.1).any();
        if outside || self.near_border(xy, xy + step, p + way * length, there) {
            return;
        }
        let mut to = self.input.chart_surface.clamp(xy + step);
        let mut new = self.input.chart_surface.spot(to);
        // The surface bends away from its tangent plane: once more with the length that came out.
        let made = new.p.distance(p);
        if (made - length).abs() > BENT * length && made > 0.0 {
            to = self.input.chart_surface.clamp(xy + step * (length / made));
            new = self.input.chart_surface.spot(to);
            if self.near_border(xy, to, new.p, there) {
                return;
            }
        }
        if new.p.distance(p) > FAR * length || self.is_on_edge(to) {
            return;
        }
        let off = new.p.distance_squared(p + way * length);
        if off > SAME_PLACE_SHARE * SAME_PLACE_SHARE * there * there && self.near_node(new.p, there) {
            return;
        }
        let arm = ahead.unwrap_or(new.p - p);
        let along = arm.reject_from_normalized(new.normal()).normalize_or_zero();
        if along != DVec3::ZERO {
            self.take(to, new.p, there, along);
        }
    }

    /// Whether a place is on the box of the border in the chart, where only nodes of the border are: a step was held there.
    fn is_on_edge(&self, xy: DVec2) -> bool {
        !(xy.cmpgt(self.within.0).all() && xy.cmplt(self.within.1).all())
    }

    fn near_node(&self, p: DVec3, size: f64) -> bool {
        if self.input.cell == Cell::Square {
            return self.near_square(p, size);
        }
        self.nodes.any(p, APART * size, size, |_, _| true)
    }

    /// Whether a step meets the border or ends too near to it.
    fn near_border(&self, from: DVec2, to: DVec2, p: DVec3, size: f64) -> bool {
        self.near_edges((from, to), (p, size), CLEAR, None)
    }

    /// Whether a step to `p` meets an edge of the border, or ends nearer to one than `clear` of the wanted length; a step from a
    /// node of the border meets its own edges there.
    fn near_edges(&self, (from, to): (DVec2, DVec2), (p, size): (DVec3, f64), clear: f64, node: Option<u32>) -> bool {
        let outline = self.input.outline;
        self.border.any(p, SIGHT * size, size, |sample, _| {
            let edge = self.edges[sample.tag as usize];
            let [a, b] = edge.map(|n| n as usize);
            let own = node.is_some_and(|n| edge.contains(&n));
            !own && cross(from, to, outline.xy[a], outline.xy[b]) || apart(p, outline.p[a], outline.p[b]) < clear * size
        })
    }
}

/// Places along the edges of a border, near enough to each other that none is overlooked from a step away; tagged by edge.
pub(crate) fn samples(outline: &Outline, field: &dyn SizeField) -> Cells {
    let unit = outline.edges().map(|e| outline.length(e)).fold(f64::MIN_POSITIVE, f64::max);
    let mut cells = Cells::new(unit, !field.is_even());
    for (k, [a, b]) in outline.edges().enumerate() {
        job::poll();
        let (pa, pb) = (outline.p[a as usize], outline.p[b as usize]);
        let (xa, xb) = (outline.xy[a as usize], outline.xy[b as usize]);
        let size = |t: f64| field.size(xa.lerp(xb, t), pa.lerp(pb, t));
        // Where lengths grow along an edge, its parts have places as far apart as lengths are there.
        let mut open = vec![(0.0, 1.0, MAX_DEPTH)];
        while let Some((from, to, left)) = open.pop() {
            let middle = 0.5 * (from + to);
            let least = [from, middle, to].map(size).into_iter().fold(f64::INFINITY, f64::min);
            let n = ((to - from) * pa.distance(pb) / (least * SAMPLES)).ceil().clamp(1.0, 1e6) as usize;
            if n > MOST_PLACES && left > 0 {
                open.extend([(middle, to, left - 1), (from, middle, left - 1)]);
                continue;
            }
            work::spend(PLACE_WORK * n as u64);
            for i in 0..=n {
                let t = from + (to - from) * i as f64 / n as f64;
                cells.add(pa.lerp(pb, t), xa.lerp(xb, t), size(t), k as u32);
            }
        }
    }
    cells
}

/// Places along an edge that are as far apart everywhere.
const MOST_PLACES: usize = 4096;
/// What a place costs, evaluations of a curve: it is kept three times.
const PLACE_WORK: u64 = 8;
/// Halvings of an edge.
const MAX_DEPTH: u32 = 20;

/// Share of the length by which a step may be off before it is made again.
const BENT: f64 = 0.01;

/// Length of a step over the wanted one from which its direction says nothing: where the map stands still, as at a corner in which
/// control points coincide, a step goes anywhere.
const FAR: f64 = 2.0;

/// Cosine between edges that run straight on.
pub(crate) const STRAIGHT: f64 = 1.0 - NUDGE;

/// Distance of a point from a segment.
pub(crate) fn apart(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    p.distance(a + d * t)
}
