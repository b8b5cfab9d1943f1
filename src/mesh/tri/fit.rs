//! Triangles of a face that keep its limits: made for wanted lengths, bounded, and made again with shorter ones where a bound
//! is broken.

use std::cell::RefCell;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::border::layout::Face;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::face_input::{FaceInput, outlined};
use crate::mesh::chart::outline::Outline;
use crate::mesh::chart::parametric_surface::{SizeField, UniformSize};
use crate::mesh::deviation::edge_length::{self, EdgePlace};
use crate::mesh::deviation::poles;
use crate::mesh::request::decider::{Decider, Tally, Why};
use crate::mesh::request::fault::{MeshFault, MeshLimit};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::request::size_requests::floor_keeps;
use crate::mesh::request::sources::{Body, STEEP, Source, Sources};
use crate::mesh::size::border_spacing::{FILLED, SPACING};
use crate::mesh::tri::build::{Lattice, Task, expected_nodes, triangulate};
use crate::mesh::tri::graded_size::{Background, GradedSize};
use crate::mesh::tri::limit_table::{LimitTable, load};
use crate::mesh::tri::longest::{LONGEST, Longest, longest_side};
use crate::mesh::tri::optimize::{FINEST, LimitCheck, OptimizeSettings};
use crate::mesh::tri::triangulation::Triangulation;
use crate::mesh::tri::trouble::Trouble;
use crate::surface::Surface;

/// Quality below which triangles are worked on.
const WANTED: f64 = 0.92;
/// The same where lengths vary with the bends: neighbouring triangles cannot all be equilateral there.
const WANTED_BENT: f64 = 0.83;
/// Quality of all its triangles with which a node is left where it is there.
const FINE_BENT: f64 = 0.98;
/// Quality from which on triangles are mended there only where that is worth its while.
const FAIR_BENT: f64 = 0.78;
/// The same for halves of squares, which have 0.83.
pub(crate) const WANTED_TREE: f64 = 0.8;
/// Rounds of smoothing: more move nodes on, but make no triangle better (mean quality differs in the third digit).
const SMOOTH: usize = 5;
/// The same where lengths vary with the bends: dividing and mending move most nodes again.
const SMOOTH_BENT: usize = 4;
/// Share of the way to the mean that a node is moved: five rounds beyond it do what eight do that stop there, as for any relaxation
/// from neighbour to neighbour.
const BEYOND: f64 = 1.6;
/// Rounds that stop at the mean, where lengths grow from short pieces: there nodes overshoot.
const SMOOTH_GRADED: usize = 8;
/// The same for corners of cells, which start far from where they end.
const SMOOTH_TREE: usize = 30;
/// What stands for the edges of a border among sources.
const BORDER: u32 = u32::MAX;
/// What is made smaller is made a little more so.
pub(crate) const LESS: f64 = 0.96;
/// Times a face is made anew for its limits.
const ROUNDS: usize = 12;

/// A face being fitted: what its triangles are made from and measured by.
pub(crate) struct Fit<'a> {
    pub(crate) made: &'a FaceInput<'a>,
    pub(crate) face: &'a Face,
    pub(crate) surface: &'a Surface,
    pub(crate) chart: &'a Chart,
    pub(crate) outline: &'a Outline,
    pub(crate) limits: Limits,
    pub(crate) longest: Longest<'a>,
    pub(crate) settings: OptimizeSettings,
}

/// Triangles, what decided their sizes, and the cells they were made of.
pub(crate) type Shown = (Triangulation, Vec<Decider>, Option<Tally>);

type Fitted = Result<std::result::Result<Triangulation, Trouble>>;

/// Triangles that keep the limits, and what decided their sizes.
pub(crate) fn fitting(
    made: &FaceInput,
    face: &Face,
    chart: &Chart,
    outline: &Outline,
    job: &Job,
) -> Result<std::result::Result<Shown, Trouble>> {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let limits = Limits::of(made.input);
    let bent = !surface.is_flat() && (limits.chord.is_some() || limits.angle.is_some());
    let tree = face.method == Method::Quadtree;
    let (smooth, fine, wanted, fair) = if tree {
        (SMOOTH_TREE, FINEST, WANTED_TREE, 1.0)
    } else if bent {
        (SMOOTH_BENT, FINE_BENT, WANTED_BENT, FAIR_BENT)
    } else {
        (SMOOTH, FINEST, WANTED, 1.0)
    };
    let smooth = made.input.plan.settings.smooth.map_or(smooth, |n| n.0 as usize);
    let settings = OptimizeSettings { smooth, beyond: BEYOND, fine, wanted, fair, longest: LONGEST / SPACING };
    let rules = near(made, face, outline);
    let longest = Longest::new(face.size.0, outline, &rules).graded(outline, made.input.plan.slope());
    let mut fit = Fit { made, face, surface, chart, outline, limits, longest, settings };
    if face.method.is_coarse() {
        let mut laid = fit.laid(&rules, job)?;
        match (face.method, &mut laid) {
            (Method::Display, Ok((triangulation, _, tally))) => {
                fit.thin(triangulation, job)?;
                *tally = None;
            }
            (_, Ok((triangulation, ..))) => fit.raise(triangulation),
            _ => {}
        }
        return Ok(laid);
    }
    let background = bent.then(|| fit.background(&fit.limits));
    // Growth is that of distances of nodes.
    let slope = rules.slope() / SPACING;
    let sources = Sources::new([rules.items(), &fit.short_edges(background.as_ref(), SPACING)].concat(), slope);
    if !bent && !tree && !sources.is_empty() {
        fit.settings.beyond = 1.0;
        fit.settings.smooth = made.input.plan.settings.smooth.map_or(SMOOTH_GRADED, |n| n.0 as usize);
    }
    let mut field = GradedSize { sources: &sources, range: (face.size.0, made.wanted.written), spacing: SPACING, background };
    fit.refuse_large(&field)?;
    let triangulation = if bent { fit.bent(&mut field, job)? } else { fit.even(&mut field, job)? };
    if matches!(triangulation, Err(Trouble::Full)) {
        return Err(fit.too_large(&field, None));
    }
    Ok(triangulation.map(|triangulation| {
        let deciders = fit.deciders(&field, &triangulation);
        (triangulation, deciders, None)
    }))
}

/// About how many elements the wanted lengths ask for between borders as they are divided here, and how many the size of the
/// face alone does; `None` where these borders cross or bound nothing.
pub(crate) fn elements_ahead(made: &FaceInput, face: &Face) -> Option<[f64; 2]> {
    let (_, chart, outline) = outlined(made, face)?;
    let rules = near(made, face, &outline);
    let quads = face.elements == Elements::Quads;
    let (lattice, spacing) =
        if quads { (Lattice::Squares, 1.0) } else { (Lattice::Triangles, if face.is_grown() { SPACING } else { 1.0 }) };
    let sources = Sources::new(rules.items().to_vec(), rules.slope() / spacing);
    let field = GradedSize { sources: &sources, range: (face.size.0, made.wanted.written), spacing, background: None };
    let even = UniformSize(spacing * face.size.0);
    let fields: [&dyn SizeField; 2] = [if sources.is_empty() { &even } else { &field }, &even];
    let settings = OptimizeSettings { smooth: 0, beyond: 1.0, fine: FINEST, wanted: WANTED, fair: 1.0, longest: LONGEST };
    let task = |field| Task {
        chart_surface: &chart,
        field,
        outline: &outline,
        settings,
        lattice,
        most: made.input.plan.most_nodes(),
        limit_check: None,
    };
    let nodes = expected_nodes(fields.map(task).each_ref())?;
    Some(nodes.map(|nodes| if quads { nodes } else { 2.0 * nodes }))
}

/// The sources of a plan that reach a face.
pub(crate) fn near(made: &FaceInput, face: &Face, outline: &Outline) -> Sources {
    let all = &made.wanted.sources;
    let hull = made.input.model.surfaces[face.surface.index()].surface.hull().union(Box3::of(outline.p.iter().copied()));
    let items = all.items().iter().filter(|source| source.reaches(&hull, all.slope(), face.size.0));
    Sources::new(items.copied().collect(), all.slope())
}

/// Sides by their lengths and triangles by their bounds.
struct Bounded<'a> {
    fit: &'a Fit<'a>,
    /// What is shorter is left as it is.
    floor: f64,
    loads: &'a RefCell<LimitTable>,
}

impl LimitCheck for Bounded<'_> {
    fn broken(&self, triangulation: &Triangulation, some: &[u32]) -> Vec<u32> {
        let mut loads = self.loads.borrow_mut();
        loads.update(self.fit.chart, triangulation, some, &self.fit.limits);
        let mut found = self.fit.longest.broken(triangulation, some);
        let over = |t: &u32| loads.of(*t).worst() > 1.0 && longest_side(triangulation, *t) > self.floor;
        found.extend(some.iter().copied().filter(over));
        found.sort_unstable();
        found.dedup();
        found
    }

    fn foresees(&self) -> bool {
        true
    }

    fn keeps(&self, triangulation: &Triangulation, corners: [u32; 3], first: Option<(DVec2, DVec3)>) -> bool {
        let [a, b, c] = corners.map(|n| n as usize);
        let a = first.map_or_else(|| triangulation.p[a], |first| first.1);
        let longest =
            a.distance(triangulation.p[b]).max(triangulation.p[b].distance(triangulation.p[c])).max(triangulation.p[c].distance(a));
        longest <= self.floor || load(self.fit.chart, triangulation, corners, first, &self.fit.limits).worst() <= 1.0
    }
}

impl LimitCheck for Longest<'_> {
    fn broken(&self, triangulation: &Triangulation, some: &[u32]) -> Vec<u32> {
        self.broken(triangulation, some)
    }

    fn foresees(&self) -> bool {
        false
    }

    fn keeps(&self, _: &Triangulation, _: [u32; 3], _: Option<(DVec2, DVec3)>) -> bool {
        true
    }
}

impl Fit<'_> {
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
        Background::new(self.chart, whole, 1.0 + self.made.input.plan.slope(), &of)
    }

    /// Edges of the border that are so short that lengths have to grow from them; nodes are `spacing` times as far apart as
    /// sides are long.
    pub(crate) fn short_edges(&self, background: Option<&Background>, spacing: f64) -> Vec<Source> {
        let slope = self.made.input.plan.slope();
        let least = if self.made.wanted.written > 0.0 { self.made.wanted.floor } else { self.made.input.tolerance.point };
        let sources = |edge: [u32; 2]| {
            let [a, b] = edge.map(|n| n as usize);
            let size = self.outline.length(edge);
            let (xy, p) = (0.5 * (self.outline.xy[a] + self.outline.xy[b]), 0.5 * (self.outline.p[a] + self.outline.p[b]));
            let there = background.map_or(f64::INFINITY, |field| field.size(xy, p)).min(self.face.size.0 * SPACING);
            let body = Body::Segment(self.outline.p[a], self.outline.p[b]);
            let from = [(size.max(self.made.wanted.floor), 1.0), (size.max(least), STEEP)];
            // Nodes are as far from it as it is long.
            let source = |(from, steep)| Source { body, radius: 0.0, size: from / spacing, steep, tag: BORDER };
            let asks = |(from, steep): &(f64, f64)| size > 0.0 && from * (1.0 + slope * steep) < there;
            // What is below the floor asks twice.
            from.into_iter().take(if from[1].0 < from[0].0 { 2 } else { 1 }).filter(asks).map(source).collect::<Vec<_>>()
        };
        self.outline.edges().flat_map(sources).collect()
    }

    fn task<'t>(&'t self, field: &'t dyn SizeField, limit_check: &'t dyn LimitCheck) -> Task<'t> {
        let lattice = if self.face.method == Method::Quadtree { Lattice::Tree } else { Lattice::Triangles };
        Task {
            chart_surface: self.chart,
            field,
            outline: self.outline,
            settings: self.settings,
            lattice,
            most: self.most(),
            limit_check: Some(limit_check),
        }
    }

    /// Without limits on bends: nodes nearer to each other until no side is too long.
    fn even(&self, field: &mut GradedSize, job: &Job) -> Fitted {
        for _ in 0..ROUNDS {
            let same = UniformSize(field.spacing * self.face.size.0);
            let field_now: &dyn SizeField = if field.sources.is_empty() { &same } else { &*field };
            match triangulate(&self.task(field_now, &self.longest), job)? {
                Ok(made) if !made.keeps => field.spacing *= LESS,
                other => return Ok(other.map(|made| made.triangulation)),
            }
        }
        let plan = self.made.input.plan;
        let (says, at) = (plan.size_origin(), self.outline.p[0]);
        let reached = self.longest.inside;
        Err(MeshFault::NotReached { limit: MeshLimit::Size, says, surface: self.surface.origin(), reached, at }.into())
    }

    /// Lengths by the bends at first, smaller where a triangle's bound says so.
    fn bent(&self, field: &mut GradedSize, job: &Job) -> Fitted {
        let floor = self.made.wanted.written;
        let mut worst = (0.0, DVec3::ZERO, MeshLimit::ChordError);
        let loads = RefCell::new(LimitTable::default());
        for _ in 0..ROUNDS {
            let limit_check = Bounded { fit: self, floor, loads: &loads };
            let triangulation = match triangulate(&self.task(&*field, &limit_check), job)? {
                // Below a floor limits may be broken all the same; that is told.
                Ok(made) if made.keeps && floor == 0.0 => return Ok(Ok(made.triangulation)),
                Ok(made) => made.triangulation,
                Err(trouble) => return Ok(Err(trouble)),
            };
            worst = self.lower(field, &triangulation, &mut loads.borrow_mut())?;
            if worst.0 == 0.0 {
                return Ok(Ok(triangulation));
            }
            if let Some(background) = &mut field.background {
                background.level();
            }
            job.go_on()?;
        }
        let (limit, at) = (worst.2, worst.1);
        let plan = self.made.input.plan;
        let says = plan.limit(limit);
        let reached = if limit == MeshLimit::Size { self.longest.inside } else { worst.0 * says.map_or(0.0, |s| s.0) };
        let says = says.map_or(plan.origin, |s| s.1);
        Err(MeshFault::NotReached { limit, says, surface: self.surface.origin(), reached, at }.into())
    }

    /// Lowers lengths where triangles break a limit; the worst of them, with its place and the limit.
    fn lower(&self, field: &mut GradedSize, triangulation: &Triangulation, loads: &mut LimitTable) -> Result<(f64, DVec3, MeshLimit)> {
        let all: Vec<u32> = (0..triangulation.tri.len() as u32).collect();
        loads.update(self.chart, triangulation, &all, &self.limits);
        let mut stretched = vec![false; triangulation.tri.len()];
        self.longest.broken(triangulation, &all).into_iter().for_each(|t| stretched[t as usize] = true);
        let least = self.made.wanted.written;
        let mut worst = (0.0, DVec3::ZERO, MeshLimit::ChordError);
        for (t, stretched) in stretched.into_iter().enumerate() {
            let load = loads.of(t as u32);
            let over = load.worst().max(if stretched { 1.0 / LESS } else { 0.0 });
            if over <= 1.0 {
                continue;
            }
            let c = triangulation.tri[t].map(|n| n as usize);
            let middle = (triangulation.p[c[0]] + triangulation.p[c[1]] + triangulation.p[c[2]]) / 3.0;
            // A side that is too long where limits have room gets shorter all the same.
            let factor = if load.chord >= load.angle { load.chord.sqrt() } else { load.angle }.max(1.0);
            if load.worst() > 1.0 && longest_side(triangulation, t as u32) <= least {
                return Err(floor_keeps(self.made.input, least / factor, middle));
            }
            if over > worst.0 {
                worst = (over, middle, if load.worst() > 1.0 { load.limit() } else { MeshLimit::Size });
            }
            let smaller = (LESS / factor).max(0.5);
            if let Some(background) = &mut field.background {
                c.iter().for_each(|n| background.lower(triangulation.xy[*n], triangulation.size[*n] * smaller));
            }
        }
        Ok(worst)
    }

    /// What decided the sizes, with the number of inner nodes and one of them.
    pub(crate) fn deciders(&self, field: &GradedSize, triangulation: &Triangulation) -> Vec<Decider> {
        let mut found: Vec<Decider> = Vec::new();
        let (most, least) = field.range;
        for n in 0..triangulation.p.len() {
            let (xy, p) = (triangulation.xy[n], triangulation.p[n]);
            let bends = field.by_bends(xy, p);
            let source = field.sources.who(p, most.min(bends / field.spacing));
            let by_sources = source.map_or(most, |s| s.size) * field.spacing;
            let why = match source {
                _ if by_sources.min(bends) < least * field.spacing => Why::Floor,
                _ if bends < by_sources => Why::Bends,
                Some(source) if field.sources.items()[source.item as usize].tag == BORDER => Why::Border,
                Some(source) => Why::Refined(field.sources.items()[source.item as usize].tag as usize),
                None => Why::Size,
            };
            let inner = usize::from(n >= triangulation.fixed as usize);
            match found.iter_mut().find(|d| d.why == why) {
                Some(decider) if decider.nodes == 0 && inner == 1 => (decider.nodes, decider.at) = (1, p),
                Some(decider) => decider.nodes += inner,
                None => found.push(Decider { why, nodes: inner, at: p }),
            }
        }
        found.sort_by_key(|d| d.why);
        found
    }
}
