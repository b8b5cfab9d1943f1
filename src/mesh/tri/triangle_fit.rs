//! Triangles of a face fitted to its limits: made for wanted lengths, bounded, and made again with shorter ones where a bound
//! exceeds a limit.

use std::cell::{Cell, RefCell};

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::border::layout::Face;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::face_input::{FaceInput, outlined};
use crate::mesh::chart::interpolated::InterpolatedChart;
use crate::mesh::chart::outline::Outline;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField, UniformSize};
use crate::mesh::deviation::edge_length::{self, EdgePlace};
use crate::mesh::deviation::poles;
use crate::mesh::request::decider::{Decided, Tally, Why};
use crate::mesh::request::fault::{MeshLimit, SizeFault};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::request::size_requests::floor_keeps;
use crate::mesh::request::sources::{Body, STEEP, Source, Sources};
use crate::mesh::size::border_spacing::{FILLED, SPACING};
use crate::mesh::tri::background::Background;
use crate::mesh::tri::bound_check::BoundCheck;
use crate::mesh::tri::build::{NodePlacement, Task, expected_nodes, triangulate};
use crate::mesh::tri::fold_check::FoldCheck;
use crate::mesh::tri::front::HolesInLattice;
use crate::mesh::tri::graded_size::GradedSize;
use crate::mesh::tri::limit_table::LimitTable;
use crate::mesh::tri::longest::{Longest, longest_side};
use crate::mesh::tri::no_mesh::{NoMesh, Outcome};
use crate::mesh::tri::optimize::{LimitCheck, OptimizeSettings};
use crate::mesh::tri::optimize_settings::{BENT_FACE, EVEN_FACE, FIT, GRADED_FACE, TREE_FACE};
use crate::mesh::tri::sliding_border::SlidingBorder;
use crate::mesh::tri::triangulation::Triangulation;
use crate::surface::Surface;

/// The tag of the edges of a border among sources.
const BORDER_TAG: u32 = u32::MAX;

/// A face being fitted to its limits, with all that its triangles follow from and are measured by.
pub(crate) struct FaceFit<'a> {
    pub(crate) face_input: &'a FaceInput<'a>,
    pub(crate) face: &'a Face,
    pub(crate) surface: &'a Surface,
    pub(crate) chart: &'a Chart,
    pub(crate) outline: &'a Outline,
    pub(crate) limits: Limits,
    pub(crate) longest: Longest<'a>,
    pub(crate) settings: OptimizeSettings,
    /// The chart interpolated, where that is quicker and no limit is bounded on it.
    pub(crate) interpolated: Option<InterpolatedChart<'a>>,
    /// Border nodes that may slide.
    pub(crate) sliding: Option<&'a SlidingBorder<'a>>,
}

/// The triangles of a face that keep its limits.
pub(crate) struct FittedFace {
    pub(crate) triangulation: Triangulation,
    /// What decided their sizes.
    pub(crate) decided: Decided,
    /// The cells between lines of constant u and v, where they were made of such.
    pub(crate) tally: Option<Tally>,
}

/// Triangles that keep the limits.
pub(crate) fn fitted(
    face_input: &FaceInput,
    face: &Face,
    chart: &Chart,
    outline: &Outline,
    sliding: Option<&SlidingBorder>,
    job: &Job,
) -> Outcome<FittedFace> {
    let surface = &face_input.input.model.surfaces[face.surface.index()].surface;
    let limits = Limits::of(face_input.input);
    let bent = !surface.is_flat() && (limits.chord.is_some() || limits.angle.is_some());
    let tree = face.method == Method::Quadtree;
    let with_rounds = |settings: OptimizeSettings| {
        let rounds = face_input.input.plan.settings.smooth.map_or(settings.smoothing_rounds, |n| n.0 as usize);
        OptimizeSettings { smoothing_rounds: rounds, ..settings }
    };
    let settings = with_rounds(if tree {
        TREE_FACE
    } else if bent {
        BENT_FACE
    } else {
        EVEN_FACE
    });
    let rules = near(face_input, face, outline);
    let longest = Longest::new(face.size.0, outline, &rules).graded(outline, face_input.input.plan.slope());
    let mut fit = FaceFit { face_input, face, surface, chart, outline, limits, longest, settings, interpolated: None, sliding };
    if face.method.is_coarse() {
        let mut outcome = fit.between_isolines(&rules, job)?;
        match (face.method, &mut outcome) {
            (Method::Display, Ok(fitted)) => {
                fit.coarsen(&mut fitted.triangulation, job)?;
                fitted.tally = None;
                // Nodes were joined and moved as far as the limits allow.
                let by_limits = fit.limits.chord.is_some() || fit.limits.angle.is_some();
                fitted.decided = fitted.decided.other_nodes(
                    &fitted.triangulation.p,
                    fitted.triangulation.fixed as usize,
                    if by_limits { Why::Bends } else { Why::Size },
                );
            }
            (_, Ok(fitted)) => fit.flip_sharp(&mut fitted.triangulation),
            _ => {}
        }
        return Ok(outcome);
    }
    let background = bent.then(|| fit.background(&fit.limits));
    // Growth is that of distances of nodes.
    let slope = rules.slope() / SPACING;
    let sources = Sources::new([rules.items(), &fit.short_edges(background.as_ref(), SPACING)].concat(), slope);
    if !bent && !tree && !sources.is_empty() {
        fit.settings = with_rounds(GRADED_FACE);
    }
    let mut field = GradedSize { sources: &sources, range: (face.size.0, face_input.wanted.written), spacing: SPACING, background };
    fit.refuse_large(&field)?;
    if !bent {
        fit.interpolated = InterpolatedChart::new(chart, outline, face.size.0);
    }
    let triangulation = if bent { fit.bent(&mut field, job)? } else { fit.even(&mut field, job)? };
    if matches!(triangulation, Err(NoMesh::TooManyNodes)) {
        return Err(fit.too_large(&field, None));
    }
    Ok(triangulation.map(|triangulation| {
        let decided = fit.decided(&field, &triangulation);
        FittedFace { triangulation, decided, tally: None }
    }))
}

/// Estimated numbers of elements between borders as they are divided here: for the wanted lengths, and for the size of the face alone; `None`
/// where these borders cross or bound nothing.
pub(crate) fn elements_ahead(face_input: &FaceInput, face: &Face) -> Option<[f64; 2]> {
    let (_, chart, outline) = outlined(face_input, face)?;
    let rules = near(face_input, face, &outline);
    let quads = face.elements == Elements::Quads;
    let (lattice, spacing) = if quads {
        (NodePlacement::Squares(HolesInLattice::WithRoom), 1.0)
    } else {
        (NodePlacement::Triangles, if face.is_grown() { SPACING } else { 1.0 })
    };
    let sources = Sources::new(rules.items().to_vec(), rules.slope() / spacing);
    let field = GradedSize { sources: &sources, range: (face.size.0, face_input.wanted.written), spacing, background: None };
    let even = UniformSize(spacing * face.size.0);
    let fields: [&dyn SizeField; 2] = [if sources.is_empty() { &even } else { &field }, &even];
    let task = |field| Task {
        interpolated: None,
        chart_surface: &chart,
        field,
        outline: &outline,
        settings: EVEN_FACE,
        lattice,
        most: face_input.input.plan.most_nodes(),
        limit_check: None,
        sliding: None,
    };
    let nodes = expected_nodes(fields.map(task).each_ref())?;
    Some(nodes.map(|nodes| if quads { nodes } else { 2.0 * nodes }))
}

/// The sources of a plan that reach a face.
pub(crate) fn near(face_input: &FaceInput, face: &Face, outline: &Outline) -> Sources {
    let all = &face_input.wanted.sources;
    let hull = face_input.input.model.surfaces[face.surface.index()].surface.hull().union(Box3::of(outline.p.iter().copied()));
    let items = all.items().iter().filter(|source| source.reaches(&hull, all.slope(), face.size.0));
    Sources::new(items.copied().collect(), all.slope())
}

impl FaceFit<'_> {
    /// Distances of nodes by the bends of the surface.
    pub(crate) fn background(&self, limits: &Limits) -> Background {
        let whole = self.outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), xy| (l.min(*xy), h.max(*xy)));
        let size = self.face.size.0 * SPACING;
        let tangents = |at: DVec2| self.chart.tangents(at.into());
        let wanted = |at: DVec2| {
            let jet = self.chart.evaluator().jet(at.x, at.y);
            let plain = edge_length::wanted(&jet, limits.chord, limits.angle).min(size / FILLED);
            let edge = EdgePlace { at, jet: &jet, along: jet.du };
            FILLED * limits.chord.map_or(plain, |limit| edge_length::sampled(self.chart.evaluator(), edge, limit, plain))
        };
        let of = |xy: DVec2| {
            let at = DVec2::from(self.chart.uv(xy));
            poles::at_tip(self.surface, &tangents, at, &wanted).unwrap_or_else(|| wanted(at)).min(size)
        };
        Background::new(self.chart, whole, 1.0 + self.face_input.input.plan.slope(), self.chart.breaks(self.outline), &of)
    }

    /// Edges of the border that are so short that lengths have to grow from them; nodes are `spacing` times as far apart as
    /// sides are long.
    pub(crate) fn short_edges(&self, background: Option<&Background>, spacing: f64) -> Vec<Source> {
        let slope = self.face_input.input.plan.slope();
        let least = if self.face_input.wanted.written > 0.0 { self.face_input.wanted.floor } else { self.face_input.input.tolerance.point };
        let sources = |edge: [u32; 2]| {
            let [a, b] = edge.map(|n| n as usize);
            let size = self.outline.length(edge);
            let (xy, p) = (0.5 * (self.outline.xy[a] + self.outline.xy[b]), 0.5 * (self.outline.p[a] + self.outline.p[b]));
            let there = background.map_or(f64::INFINITY, |field| field.size(xy, p)).min(self.face.size.0 * SPACING);
            let body = Body::Segment(self.outline.p[a], self.outline.p[b]);
            let floor = self.face_input.wanted.floor_where(there / spacing);
            let from = [(size.max(floor), 1.0), (size.max(least), STEEP)];
            // Nodes are as far from it as it is long.
            let source = |(from, steep)| Source { body, radius: 0.0, size: from / spacing, steep, tag: BORDER_TAG };
            let is_short = |(from, steep): &(f64, f64)| size > 0.0 && from * (1.0 + slope * steep) < there;
            // An edge below the floor is two sources.
            from.into_iter().take(if from[1].0 < from[0].0 { 2 } else { 1 }).filter(is_short).map(source).collect::<Vec<_>>()
        };
        self.outline.edges().flat_map(sources).collect()
    }

    fn task<'t>(&'t self, field: &'t dyn SizeField, limit_check: &'t dyn LimitCheck) -> Task<'t> {
        let lattice = if self.face.method == Method::Quadtree { NodePlacement::Tree } else { NodePlacement::Triangles };
        Task {
            chart_surface: self.chart,
            interpolated: self.interpolated.as_ref().map(|chart| chart as &dyn ParametricSurface),
            field,
            outline: self.outline,
            settings: self.settings,
            lattice,
            most: self.most(),
            limit_check: Some(limit_check),
            sliding: self.sliding,
        }
    }

    /// Without limits on bends: nodes nearer to each other until no side is too long.
    fn even(&self, field: &mut GradedSize, job: &Job) -> Outcome<Triangulation> {
        let allowed = Cell::new(0);
        let folds = FoldCheck::new(self, &allowed);
        let mut has_folds = false;
        for _ in 0..FIT.max_rounds {
            let same = UniformSize(field.spacing * self.face.size.0);
            let field_now: &dyn SizeField = if field.sources.is_empty() { &same } else { &*field };
            let limit_check: &dyn LimitCheck = if has_folds { &folds } else { &self.longest };
            match triangulate(&self.task(field_now, limit_check), job)? {
                Ok(result) if !has_folds && !self.surface.is_flat() && folds.is_needed(&result.triangulation) => has_folds = true,
                Ok(result) if !result.keeps_limits => field.spacing *= FIT.size_factor,
                other => return Ok(other.map(|result| result.triangulation)),
            }
        }
        let plan = self.face_input.input.plan;
        let (written_at, at) = (plan.size_origin(), self.outline.p[0]);
        let reached = self.longest.inside;
        Err(SizeFault::NotReached { limit: MeshLimit::Size, written_at, surface: self.surface.origin(), reached, at }.into())
    }

    /// Lengths by the bends at first, smaller where a triangle exceeds a limit.
    fn bent(&self, field: &mut GradedSize, job: &Job) -> Outcome<Triangulation> {
        let floor = self.face_input.wanted.written;
        let mut worst = (0.0, DVec3::ZERO, MeshLimit::ChordError);
        let (ratios, allowed) = (RefCell::new(LimitTable::default()), Cell::new(0));
        for _ in 0..FIT.max_rounds {
            let limit_check = BoundCheck { fit: self, floor, ratios: &ratios, allowed: &allowed };
            let triangulation = match triangulate(&self.task(&*field, &limit_check), job)? {
                // Below a floor limits may be exceeded: `lower` reports that.
                Ok(result) if result.keeps_limits && floor == 0.0 => return Ok(Ok(result.triangulation)),
                Ok(result) => result.triangulation,
                Err(reason) => return Ok(Err(reason)),
            };
            worst = self.lower(field, &triangulation, &mut ratios.borrow_mut())?;
            if worst.0 == 0.0 {
                return Ok(Ok(triangulation));
            }
            if let Some(background) = &mut field.background {
                background.level();
            }
            job.go_on()?;
        }
        let (limit, at) = (worst.2, worst.1);
        let plan = self.face_input.input.plan;
        let written_at = plan.limit(limit);
        let reached = if limit == MeshLimit::Size { self.longest.inside } else { worst.0 * written_at.map_or(0.0, |s| s.0) };
        let written_at = written_at.map_or(plan.origin, |s| s.1);
        Err(SizeFault::NotReached { limit, written_at, surface: self.surface.origin(), reached, at }.into())
    }

    /// Lowers lengths where triangles exceed a limit; the worst of them with its place and the limit.
    fn lower(&self, field: &mut GradedSize, triangulation: &Triangulation, ratios: &mut LimitTable) -> Result<(f64, DVec3, MeshLimit)> {
        let all: Vec<u32> = (0..triangulation.tri.len() as u32).collect();
        ratios.update(self.chart, triangulation, &all, &self.limits);
        let mut is_too_long = vec![false; triangulation.tri.len()];
        self.longest.broken(triangulation, &all).into_iter().for_each(|t| is_too_long[t as usize] = true);
        let least = self.face_input.wanted.written;
        let mut worst = (0.0, DVec3::ZERO, MeshLimit::ChordError);
        for (t, is_too_long) in is_too_long.into_iter().enumerate() {
            let ratio = ratios.of(t as u32);
            let over = ratio.worst().max(if is_too_long { 1.0 / FIT.size_factor } else { 0.0 });
            if over <= 1.0 {
                continue;
            }
            let c = triangulation.tri[t].map(|n| n as usize);
            let middle = (triangulation.p[c[0]] + triangulation.p[c[1]] + triangulation.p[c[2]]) / 3.0;
            // A side that is too long gets shorter even where the limits are kept.
            let factor = if ratio.chord >= ratio.angle { ratio.chord.sqrt() } else { ratio.angle }.max(1.0);
            if ratio.worst() > 1.0 && longest_side(triangulation, t as u32) <= least {
                return Err(floor_keeps(self.face_input.input, least / factor, middle));
            }
            if over > worst.0 {
                worst = (over, middle, if ratio.worst() > 1.0 { ratio.limit() } else { MeshLimit::Size });
            }
            let smaller = if ratio.on_edge { 0.5 } else { (FIT.size_factor / factor).max(0.5) };
            // Lengths that were lowered at single nodes, to divide triangles there, are no lengths of a whole cell of the grid.
            let least = FIT.least_over_side * longest_side(triangulation, t as u32);
            if let Some(background) = &mut field.background {
                c.iter().for_each(|n| background.lower(triangulation.xy[*n], triangulation.size[*n].max(least) * smaller));
            }
        }
        Ok(worst)
    }

    /// What decided the sizes at all nodes.
    pub(crate) fn decided(&self, field: &GradedSize, triangulation: &Triangulation) -> Decided {
        let mut found = Decided::default();
        let (most, least) = field.range;
        for n in 0..triangulation.p.len() {
            let (xy, p) = (triangulation.xy[n], triangulation.p[n]);
            let bends = field.by_bends(xy, p);
            let source = field.sources.who(p, most.min(bends / field.spacing));
            let by_sources = source.map_or(most, |s| s.size) * field.spacing;
            let why = match source {
                _ if by_sources.min(bends) < least * field.spacing => Why::Floor,
                _ if bends < by_sources => Why::Bends,
                Some(source) if field.sources.items()[source.item as usize].tag == BORDER_TAG => Why::Border,
                Some(source) => Why::Refined(field.sources.items()[source.item as usize].tag as usize),
                None => Why::Size,
            };
            let length = by_sources.min(bends).max(least * field.spacing) / field.spacing;
            found.push(why, length, p, n >= triangulation.fixed as usize);
        }
        found.sorted()
    }
}
