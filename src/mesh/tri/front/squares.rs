//! The first row of a lattice of squares: round the border, a node over each of its nodes, so that the cells beside it are
//! perpendicular to it.

use glam::{DVec2, DVec3};

use crate::base::math;
use crate::mesh::tri::front::square_lattice::{LatticeFrame, SquareLattice};
use crate::mesh::tri::front::{Front, FrontStep, HolesInLattice, STRAIGHT};
use crate::mesh::tri::placement_settings::{FRONT, SQUARE_HOLES, SQUARE_ROWS};
use crate::mesh::tri::point_hash::SurfacePoint;

/// A right angle, radians.
const RIGHT: f64 = std::f64::consts::FRAC_PI_2;

/// Edges of a border that run straight on.
#[derive(Clone, Copy, Default)]
struct Run {
    along: DVec3,
    length: f64,
    edges: usize,
    /// A node of it.
    node: u32,
}

impl Front<'_> {
    /// A node over each node of the border, and those between where it turns outwards; gives the one over the longest
    /// straight run, from which the lattice starts.
    pub(crate) fn layer_of_squares(&mut self) -> Option<u32> {
        let outline = self.input.outline;
        let runs = self.runs();
        let longest = runs.iter().copied().reduce(|a, b| if b.length > a.length { b } else { a })?;
        let perpendicular = |r: &&Run| r.along.dot(longest.along).abs() < SQUARE_ROWS.max_perpendicular_cosine;
        let across = runs.iter().filter(perpendicular).copied().reduce(|a, b| if b.length > a.length { b } else { a });
        self.steps = [self.followed(Some(longest)), self.followed(across)];
        let mut before = vec![u32::MAX; outline.p.len()];
        outline.loops.iter().for_each(|e| before[e[1] as usize] = e[0]);
        let mut first = None;
        let lattice = self.lattice(&longest);
        for &[a, b] in outline.loops.iter().filter(|e| lattice.as_ref().is_none_or(|lattice| !lattice.fits(e[0]))) {
            let Some(from) = outline.p.get(before[a as usize] as usize).copied() else { continue };
            let here = self.grown.p.len() as u32;
            self.place_over(a, outline.p[b as usize], from, longest.along);
            if a == longest.node && self.grown.p.len() as u32 > here {
                first = Some(here);
            }
        }
        self.open.clear();
        self.row = self.grown.p.len() as u32;
        let Some(lattice) = lattice else { return first };
        self.fill(&lattice, longest.along);
        self.lattice_end = self.grown.p.len() as u32;
        // Where lengths are shorter, nodes grow on from those of the lattice.
        if self.input.field.is_even() {
            self.open.clear();
        }
        None
    }

    /// The whole lattice of the longest steps, where the face is a plane.
    fn lattice(&self, longest: &Run) -> Option<SquareLattice> {
        let plane = self.input.chart_surface.plane().filter(|_| self.input.holes != HolesInLattice::None)?;
        let (outline, field) = (self.input.outline, self.input.field);
        let origin = outline.xy[longest.node as usize];
        let size = outline.xy.iter().zip(&outline.p).map(|(xy, p)| field.size(*xy, *p)).fold(0.0, f64::max);
        let along = DVec2::new(longest.along.dot(plane.dx), longest.along.dot(plane.dy)).try_normalize()?;
        let frame = LatticeFrame { origin, along: along * (size * self.steps[0]), across: along.perp() * (size * self.steps[1]) };
        SquareLattice::new(
            outline,
            frame,
            &|xy| field.size(xy, self.input.chart_surface.point(xy)) / size,
            self.input.holes == HolesInLattice::Searched,
        )
    }

    /// Places the nodes of a lattice that are near no other, where lengths are about as long as its steps.
    fn fill(&mut self, lattice: &SquareLattice, along: DVec3) {
        let surface = self.input.chart_surface;
        let step = lattice.step() / DVec2::from(self.steps).max_element();
        lattice.nodes(|xy, is_fitted| {
            let p = surface.point(xy);
            let at = SurfacePoint { p, xy, ..SurfacePoint::default() };
            let size = self.input.field.size(xy, p);
            let fits = || {
                size >= SQUARE_HOLES.min_wanted_elsewhere * step
                    && !self.near_rows(at, size, |_| false)
                    && !self.near_border(FrontStep { from: xy, to: at, size })
            };
            if is_fitted || fits() {
                self.add(at, size, along);
            }
            self.grown.p.len() <= self.input.most
        });
    }

    /// Whether a place is too near to a node, or between two of the first row.
    pub(crate) fn near_square(&self, p: SurfacePoint, size: f64) -> bool {
        let lattice = self.row..self.lattice_end;
        let wide = if lattice.is_empty() { 0.0 } else { SQUARE_HOLES.min_spacing_beside * size };
        self.nodes.any(p, wide, size, |node, _| lattice.contains(&node.tag)) || self.near_rows(p, size, |_| true)
    }

    /// Whether a place is too near to a node, or between two of the border or the first row; of the others those that `counts`.
    fn near_rows(&self, at: SurfacePoint, size: f64, counts: impl Fn(u32) -> bool) -> bool {
        // The middle of a cell is as far from its corners as its steps are long.
        let steps = DVec2::from(self.steps).length() * std::f64::consts::FRAC_1_SQRT_2;
        let (near, far) = (
            SQUARE_ROWS.min_first_row_spacing * SQUARE_ROWS.min_first_row_spacing * size * size,
            SQUARE_ROWS.min_lattice_spacing * steps * size,
        );
        let mut beside = 0;
        let over = |tag: u32, node: DVec3| (at.p - node).dot(self.arms[tag as usize]) < SQUARE_ROWS.min_first_row_spacing * size;
        let row = |tag: u32| tag < self.row;
        self.nodes.any(at, far, size, |node, square| {
            let is_inner = node.tag != u32::MAX && !row(node.tag);
            if is_inner && !counts(node.tag) {
                return false;
            }
            beside += 1;
            square < near || beside > 1 || is_inner
        }) || self.nodes.any(at, size, size, |node, _| row(node.tag) && over(node.tag, node.at.p))
    }

    /// Straight runs of the loops; the node of each is in its middle.
    fn runs(&self) -> Vec<Run> {
        let outline = self.input.outline;
        let (mut runs, mut nodes): (Vec<Run>, Vec<u32>) = (Vec::new(), Vec::new());
        for &[a, b] in &outline.loops {
            let side = outline.p[b as usize] - outline.p[a as usize];
            let Some(along) = side.try_normalize() else { continue };
            match runs.last_mut() {
                Some(run) if run.along.dot(along) > STRAIGHT && nodes.last() == Some(&a) => {
                    run.length += side.length();
                    run.edges += 1;
                }
                _ => {
                    nodes.clear();
                    runs.push(Run { along, length: side.length(), edges: 1, node: a });
                }
            }
            nodes.push(b);
            if let Some(run) = runs.last_mut() {
                run.node = nodes[(nodes.len() - 1) / 2];
            }
        }
        runs
    }

    /// The steps of a run over the wanted length, where the lattice can follow them; else 1.
    fn followed(&self, run: Option<Run>) -> f64 {
        let Some(run) = run.filter(|run| run.edges >= SQUARE_ROWS.min_run_edges) else { return 1.0 };
        let outline = self.input.outline;
        let size = self.input.field.size(outline.xy[run.node as usize], outline.p[run.node as usize]);
        let share = run.length / run.edges as f64 / size;
        if SQUARE_ROWS.followed_steps.contains(&share) { share } else { 1.0 }
    }

    /// Nodes over a node of the border between its next and its last one: as many cells as fill the angle best.
    fn place_over(&mut self, node: u32, next: DVec3, last: DVec3, along: DVec3) {
        let outline = self.input.outline;
        let (p, xy) = (outline.p[node as usize], outline.xy[node as usize]);
        let spot = self.input.chart_surface.spot(xy);
        let normal = spot.normal();
        let (out, back) = ((next - p).reject_from_normalized(normal), (last - p).reject_from_normalized(normal));
        let (Some(unit), true) = (out.try_normalize(), back != DVec3::ZERO) else { return };
        let turn = math::atan2(normal.dot(out.cross(back)), out.dot(back));
        let turn = if turn <= 0.0 { turn + 4.0 * RIGHT } else { turn };
        let frame = Frame::new(along, normal);
        let cells = frame.map_or((turn / RIGHT).round().clamp(1.0, 4.0) as usize, |f| f.cells(turn, unit, -back.normalize_or_zero()));
        let size = self.input.field.size(xy, p);
        let aside = normal.cross(unit);
        let bent = turn > SQUARE_ROWS.min_outward_turn * 2.0 * RIGHT && cells == 2;
        let way = |k: usize| {
            let (sin, cos) = math::sin_cos(turn * k as f64 / cells as f64);
            let way = unit * cos + aside * sin;
            // Between corners the row turns half as fast as the border.
            frame.filter(|_| bent).map_or(way, |frame| (way + frame.nearest(way)).normalize_or_zero())
        };
        let ratio = |way: DVec3| {
            let lengthwise = way.dot(along).abs();
            if lengthwise > 1.0 - SQUARE_ROWS.max_perpendicular_cosine {
                self.steps[0]
            } else if lengthwise < SQUARE_ROWS.max_perpendicular_cosine {
                self.steps[1]
            } else {
                1.0
            }
        };
        let arms: Vec<DVec3> = (1..cells).map(|k| way(k) * (size * ratio(way(k)))).collect();
        let between: Vec<DVec3> = arms.windows(2).map(|w| w[0] + w[1]).collect();
        for arm in arms.iter().chain(&between) {
            let Some(step) = spot.step(*arm) else { continue };
            let to = self.input.chart_surface.clamp(xy + step);
            let new = self.input.chart_surface.spot(to);
            let at = self.point(to, &new);
            let near = self.near_edges(FrontStep { from: xy, to: at, size }, SQUARE_ROWS.min_border_distance, Some(node));
            let occupied = self.nodes.any(at, SQUARE_ROWS.min_spacing_within_row * size, size, |_, _| true);
            let ahead = along.reject_from_normalized(new.normal()).normalize_or_zero();
            let far = new.p.distance(spot.p) > FRONT.max_step_ratio * arm.length() || self.is_on_edge(to);
            if !near && !occupied && !far {
                let ahead = if ahead == DVec3::ZERO { arm.reject_from_normalized(new.normal()).normalize_or_zero() } else { ahead };
                self.add(at, size, ahead);
                self.arms.push(arm.normalize_or_zero());
            }
        }
    }
}

/// The directions of a lattice in the tangent plane of a place.
#[derive(Clone, Copy)]
struct Frame {
    along: DVec3,
    aside: DVec3,
}

impl Frame {
    fn new(along: DVec3, normal: DVec3) -> Option<Self> {
        let along = along.reject_from_normalized(normal).try_normalize()?;
        Some(Self { along, aside: normal.cross(along) })
    }

    /// The number of quarter turns from the lattice to the nearest of its four directions.
    fn quarter(&self, way: DVec3) -> f64 {
        (math::atan2(way.dot(self.aside), way.dot(self.along)) / RIGHT).round()
    }

    fn nearest(&self, way: DVec3) -> DVec3 {
        match self.quarter(way).rem_euclid(4.0) as u32 {
            0 => self.along,
            1 => self.aside,
            2 => -self.along,
            _ => -self.aside,
        }
    }

    /// How many cells fill the angle `turn` at a node of the border, between the edge that leaves it and the one that comes.
    ///
    /// Where it bends outwards, edges count as the nearest of the lattice's four directions: a round hole then is a square to
    /// the cells round it, and no row of them meets the lattice askew.
    fn cells(&self, turn: f64, leaves: DVec3, comes: DVec3) -> usize {
        let turned = (self.quarter(comes) - self.quarter(leaves)).rem_euclid(4.0);
        let squared = 2.0 + if turned > 2.0 { turned - 4.0 } else { turned };
        let bent =
            turn > SQUARE_ROWS.min_outward_turn * 2.0 * RIGHT && squared >= 2.0 && SQUARE_ROWS.corner_angles.contains(&(turn / squared));
        (if bent { squared } else { (turn / RIGHT).round().clamp(1.0, 4.0) }) as usize
    }
}
