//! A face from its border to its triangles.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use crate::base::job::{self, Job};
use crate::base::triangulate_points::{Triangles, points};
use crate::mesh::chart::outline::{Outline, inside};
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField};
use crate::mesh::request::plan::TALL;
use crate::mesh::tri::front::{FrontInput, HolesInLattice, LatticeCell, STRAIGHT, grow};
use crate::mesh::tri::no_mesh::{NoMesh, Outcome};
use crate::mesh::tri::optimize::{LimitCheck, MeshOptimizer, OptimizeSettings};
use crate::mesh::tri::optimize_settings::REPAIR;
use crate::mesh::tri::placement_settings::ESTIMATE;
use crate::mesh::tri::quadtree::{self, TreeFace};
use crate::mesh::tri::sliding_border::SlidingBorder;
use crate::mesh::tri::triangulation::Triangulation;

/// Where inner nodes come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodePlacement {
    /// A lattice of equilateral triangles, grown from the border.
    Triangles,
    /// A lattice of squares, grown from the border, with these holes of plane faces in it.
    Squares(HolesInLattice),
    /// The corners of a quadtree's cells.
    Tree,
}

/// A face to be triangulated.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The surface.
    pub chart_surface: &'a dyn ParametricSurface,
    /// The surface interpolated, where that is quicker: nodes grow and are smoothed on it before they are put on the surface.
    pub interpolated: Option<&'a dyn ParametricSurface>,
    /// The wanted lengths.
    pub field: &'a dyn SizeField,
    /// The border.
    pub outline: &'a Outline,
    /// Settings of the optimization.
    pub settings: OptimizeSettings,
    /// Where inner nodes come from.
    pub lattice: NodePlacement,
    /// Largest number of inner nodes.
    pub most: usize,
    /// Limits: triangles over one are divided.
    pub limit_check: Option<&'a dyn LimitCheck>,
    /// Border nodes that may slide.
    pub sliding: Option<&'a SlidingBorder<'a>>,
}

/// The triangles of a face.
pub struct Triangulated {
    /// Triangles and nodes.
    pub triangulation: Triangulation,
    /// Whether none of them exceeds a limit that was checked.
    pub keeps_limits: bool,
}

/// Largest move of a node from the interpolated surface onto the surface itself, over the wanted length; where one is larger the face is meshed
/// on the surface itself.
const MAX_MOVE: f64 = 0.02;

/// Triangulates a face.
pub fn triangulate(task: &Task, job: &Job) -> Outcome<Triangulated> {
    let chart_surface = task.interpolated.unwrap_or(task.chart_surface);
    let triangulation = match initial_triangulation(&Task { chart_surface, ..*task }, job)? {
        Ok(triangulation) => triangulation,
        Err(reason) => return Ok(Err(reason)),
    };
    let mut optimizer = MeshOptimizer::new(triangulation, chart_surface, task.field, task.settings);
    if let Some(border) = task.sliding {
        optimizer.slide_on(border);
    }
    if let Some(limit_check) = task.limit_check.filter(|limit_check| limit_check.holds_from_the_start()) {
        optimizer.limit_check = Some(limit_check);
        optimizer.guards_moves = true;
    }
    optimizer.settle();
    job.go_on()?;
    if let Some(limit_check) = task.limit_check {
        // The lengths that were expected may have been far too large where the surface bends.
        limit_check.allow_work(optimizer.triangulation.tri.len());
    }
    // Where lengths were wrong, the face is not optimized before better ones are known: its nodes stay on the interpolated surface, and limits are
    // not kept.
    let mut bad = task.limit_check.map_or(Vec::new(), |limit_check| optimizer.broken(limit_check, &[]));
    if optimizer.are_few(&bad) {
        if task.limit_check.is_some_and(|limit_check| limit_check.is_per_triangle()) {
            optimizer.reserve_work();
        }
        if bad.len() * REPAIR.few_over_limit <= optimizer.triangulation.tri.len() {
            optimizer.improve(job)?;
        }
        if task.interpolated.is_some() && optimizer.move_onto(task.chart_surface) > MAX_MOVE {
            return triangulate(&Task { interpolated: None, ..*task }, job);
        }
        if let Some(limit_check) = task.limit_check {
            bad = optimizer.divide(limit_check, bad, job)?;
        }
    }
    optimizer.set_upright();
    let mut triangulation = optimizer.into_triangulation();
    triangulation.compact();
    Ok(Ok(Triangulated { triangulation, keeps_limits: bad.is_empty() }))
}

/// The Delaunay triangles of a face in its chart, over its border and the nodes of its lattice; nothing is improved yet.
pub fn initial_triangulation(task: &Task, job: &Job) -> Outcome<Triangulation> {
    let outline = task.outline;
    let edges: Vec<[u32; 2]> = outline.edges().collect();
    let coarse = match points(&outline.xy, &edges) {
        Ok(triangles) => triangles,
        Err(fault) => return Ok(Err(NoMesh::Border(fault))),
    };
    let kept = inside(&coarse, outline);
    if !kept.contains(&true) {
        return Ok(Err(NoMesh::Empty));
    }
    if expected(task, &coarse, &kept) > task.most as f64 {
        return Ok(Err(NoMesh::TooManyNodes));
    }
    let mut grown = match task.lattice {
        NodePlacement::Triangles | NodePlacement::Squares(_) => {
            let seeds = seeds(&coarse, &kept, outline);
            let (cell, holes) = match task.lattice {
                NodePlacement::Squares(holes) => (LatticeCell::Square, holes),
                _ => (LatticeCell::Triangle, HolesInLattice::None),
            };
            let (chart_surface, field, most) = (task.chart_surface, task.field, task.most);
            grow(&FrontInput { chart_surface, field, outline, seeds: &seeds, cell, holes, most }, job)?
        }
        NodePlacement::Tree => {
            match quadtree::nodes(&TreeFace { chart_surface: task.chart_surface, field: task.field, outline, most: task.most }) {
                Ok(grown) => grown,
                Err(reason) => return Ok(Err(reason)),
            }
        }
    };
    if grown.full {
        return Ok(Err(NoMesh::TooManyNodes));
    }
    job.go_on()?;
    let mut xy = outline.xy.clone();
    xy.append(&mut grown.xy);
    grown.xy = Vec::new();
    let all = match points(&xy, &edges) {
        Ok(triangles) => triangles,
        Err(fault) => return Ok(Err(NoMesh::Border(fault))),
    };
    job.go_on()?;
    let kept = inside(&all, outline);
    let mut p = outline.p.clone();
    p.extend(&grown.p);
    let mut size: Vec<f64> = job::looking(outline.p.iter().zip(&outline.xy)).map(|(p, xy)| task.field.size(*xy, *p)).collect();
    size.extend(&grown.size);
    drop(grown);
    Ok(Ok(Triangulation::new(p, xy, size, outline.p.len() as u32, &all, &kept)))
}

/// Estimated numbers of nodes of some tasks on one outline; `None` where the outline crosses itself or bounds nothing.
pub fn expected_nodes<const N: usize>(tasks: [&Task; N]) -> Option<[f64; N]> {
    let outline = tasks.first()?.outline;
    let edges: Vec<[u32; 2]> = outline.edges().collect();
    let coarse = points(&outline.xy, &edges).ok()?;
    let kept = inside(&coarse, outline);
    kept.contains(&true).then(|| tasks.map(|task| expected(task, &coarse, &kept)))
}

/// Estimated number of nodes for the wanted lengths, by the triangles between border nodes.
fn expected(task: &Task, coarse: &Triangles, kept: &[bool]) -> f64 {
    let corner = |n: u32| (task.outline.xy[n as usize], task.outline.p[n as usize]);
    // Breadth first: the triangles left undivided at the bound are small.
    let mut open: VecDeque<_> = (0..kept.len()).filter(|t| kept[*t]).map(|t| coarse.corners[t].map(corner)).collect();
    let (mut total, mut left) = (0.0, ESTIMATE.max_divisions + open.len());
    while let Some(c) = open.pop_front() {
        let middle = (c.iter().map(|c| c.0).sum::<DVec2>() / 3.0, c.iter().map(|c| c.1).sum::<DVec3>() / 3.0);
        let size = task.field.size(middle.0, middle.1);
        let area = (c[1].1 - c[0].1).cross(c[2].1 - c[0].1).length();
        // Half a node a triangle of side `size`, whose area is √3/4 of its square, or one a square.
        let cell = if matches!(task.lattice, NodePlacement::Squares(_)) { 1.0 } else { TALL };
        let nodes = 0.5 * area / (cell * size * size);
        let varies = || c.iter().any(|c| task.field.size(c.0, c.1) * ESTIMATE.equal_size_ratio < size);
        if task.field.is_even() || left == 0 || nodes < 1.0 || nodes < ESTIMATE.nodes_of_one_size && !varies() {
            total += nodes;
            continue;
        }
        left -= 1;
        let mid = |i: usize, j: usize| (0.5 * (c[i].0 + c[j].0), 0.5 * (c[i].1 + c[j].1));
        let [a, b, d] = [mid(1, 2), mid(2, 0), mid(0, 1)];
        open.extend([[c[0], d, b], [c[1], a, d], [c[2], b, a], [a, b, d]]);
    }
    total
}

/// Places to start from: the middles of the largest triangles between border nodes first, in the direction of the longest
/// straight run of the border.
fn seeds(coarse: &Triangles, kept: &[bool], outline: &Outline) -> Vec<(DVec2, DVec3)> {
    let along = main_direction(outline);
    let area = |t: usize| {
        let [a, b, c] = coarse.corners[t].map(|n| outline.p[n as usize]);
        (b - a).cross(c - a).length_squared()
    };
    let mut order: Vec<(f64, usize)> = job::looking(0..kept.len()).filter(|t| kept[*t]).map(|t| (area(t), t)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let middle = |t: usize| coarse.corners[t].map(|n| outline.xy[n as usize]).into_iter().sum::<DVec2>() / 3.0;
    order.into_iter().map(|(_, t)| (middle(t), along)).collect()
}

/// The direction that most of the border runs in, with all directions folded by a sixth of a turn about the mean normal.
fn main_direction(outline: &Outline) -> DVec3 {
    let mut best = (0.0, DVec3::ZERO);
    let mut run = (0.0, DVec3::ZERO);
    for [a, b] in outline.edges() {
        let d = outline.p[b as usize] - outline.p[a as usize];
        let Some(unit) = d.try_normalize() else { continue };
        run = if unit.dot(run.1) > STRAIGHT { (run.0 + d.length(), run.1) } else { (d.length(), unit) };
        if run.0 > best.0 {
            best = run;
        }
    }
    best.1
}
