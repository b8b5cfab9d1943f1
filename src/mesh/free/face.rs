//! A face of a mesh made freely: its border from the divided stretches, its inside grown.

mod quads;

pub(in crate::mesh) use quads::halved;

use std::cell::RefCell;
use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::bound;
use super::build::{Lattice, Task, Trouble, triangulate};
use super::ground::{Even, Field, Ground};
use super::improve::{Broken, Care};
use super::lay::{Ask, Failure, lay};
use super::loads::{self, Loads};
use super::outline::Outline;
use super::sheet::Sheet;
use super::size::{Background, Blend};
use super::taken::{self, Taken};
use super::thin::Thinner;
use super::tree::DEEPEST;
use super::web::Web;
use crate::base::bbox::Box3;
use crate::base::fault::{Fault, MeshFault, Result};
use crate::base::job::Job;
use crate::base::limits::MESH_ELEMENTS;
use crate::base::par;
use crate::base::tolerance::{NUDGE, WHOLE_NUMBER};
use crate::base::triangulate_points::PointsFault;
use crate::mesh::build::Input;
use crate::mesh::chart::{Chart, Free, Shape};
use crate::mesh::edges::Limits;
use crate::mesh::explain::{Decider, Tally, Why};
use crate::mesh::faces::{Frame, Prepared, limits_of, middle};
use crate::mesh::layout::{Face, Layout, side_parameters};
use crate::mesh::nodes::Nodes;
use crate::mesh::plan::{Elements, Method};
use crate::mesh::reuse::Known;
use crate::mesh::sources::{Body, Source, Sources};
use crate::mesh::wanted::{Wanted, floor_keeps};
use crate::model::Trace;
use crate::surface::{Domain, Side, Surface};

/// Spacing of the crystal as a share of the size, so that hardly an edge comes out longer than the size allows.
pub const SPACING: f64 = 0.8;
/// Longest edge inside over the size (language reference, mesh settings).
const LONGEST: f64 = 1.05;
/// Quality below which triangles are worked on.
const WANTED: f64 = 0.92;
/// The same where lengths vary with the bends: neighbouring triangles cannot all be equilateral there.
const WANTED_BENT: f64 = 0.85;
/// The same for halves of squares, which have 0.83.
const WANTED_TREE: f64 = 0.8;
/// Rounds of smoothing: more move nodes on, but make no triangle better (mean quality differs in the third digit).
const SMOOTH: usize = 8;
/// The same for corners of cells, which start far from where they end.
const SMOOTH_TREE: usize = 30;

/// Feet of one point nearer than this in u and v are one place.
pub(super) const ONE_PLACE: f64 = NUDGE;

/// Ends of two borders of one face that became one junction lie within this many glue distances of each other in the chart,
/// whose lengths are right on average only.
const ROOM: f64 = 8.0;

/// Everything a face is made from.
pub struct Made<'a> {
    /// The plan and the model.
    pub input: &'a Input<'a>,
    /// Its stretches.
    pub layout: &'a Layout,
    /// Their nodes.
    pub nodes: &'a Nodes,
    /// Points of all border nodes.
    pub points: &'a [DVec3],
    /// What `near`, `in` and `min_size` ask for.
    pub wanted: &'a Wanted,
}

/// Nodes of a border with their places, in order of first use.
#[derive(Default)]
pub(in crate::mesh) struct Border {
    pub(super) uv: Vec<(f64, f64)>,
    pub(in crate::mesh) ids: Vec<u32>,
    pub(super) edges: Vec<[u32; 2]>,
    /// Edges of lines inside.
    pub(super) lines: Vec<[u32; 2]>,
}

impl Border {
    /// Edges of the chart where a loop passes a pole: it goes on at another place of the same node.
    fn jump(&mut self, loops: &[usize], ends: &[Option<(u32, u32)>]) {
        let mut rest = ends;
        for n in loops {
            let (own, others) = rest.split_at(*n);
            rest = others;
            let own: Vec<(u32, u32)> = own.iter().copied().flatten().collect();
            for k in 0..own.len() {
                let (from, to) = (own[k].1, own[(k + 1) % own.len()].0);
                if from != to {
                    self.edges.push([from, to]);
                }
            }
        }
    }

    /// Places of one node that are no further apart than borders were glued over become one: on the face itself the ends of
    /// its borders need not meet.
    fn close(&mut self, sheet: &Sheet, near: f64) {
        let mut into: Vec<u32> = (0..self.ids.len() as u32).collect();
        for n in 0..self.ids.len() {
            let here = sheet.xy(self.uv[n]);
            let first = (0..n).find(|m| self.ids[*m] == self.ids[n] && sheet.xy(self.uv[*m]).distance(here) <= ROOM * near);
            into[n] = first.map_or(into[n], |m| into[m]);
        }
        let kept: Vec<usize> = (0..into.len()).filter(|n| into[*n] == *n as u32).collect();
        let place = |n: u32| kept.partition_point(|k| *k < into[n as usize] as usize) as u32;
        self.edges = self.edges.iter().map(|e| e.map(place)).filter(|[a, b]| a != b).collect();
        self.lines = self.lines.iter().map(|e| e.map(place)).filter(|[a, b]| a != b).collect();
        self.uv = kept.iter().map(|n| self.uv[*n]).collect();
        self.ids = kept.iter().map(|n| self.ids[*n]).collect();
    }
}

/// A face without anything in it, for as long as only its border matters.
pub fn empty(made: &Made, face: &Face) -> Prepared {
    prepared(made, face, Free::default(), Vec::new(), Vec::new())
}

/// The border of a face, its chart, and the border in it; `None` where the surface is singular all along it.
pub(in crate::mesh) fn outlined(made: &Made, face: &Face) -> Option<(Border, Sheet, Outline)> {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let mut border = border(made, face);
    let sheet = Sheet::new(surface, border.uv.iter().copied())?;
    if face.near > made.input.tolerance.point {
        border.close(&sheet, face.near);
    }
    let outline = Outline {
        xy: border.uv.iter().map(|uv| sheet.xy(*uv)).collect(),
        p: border.ids.iter().map(|n| made.points[*n as usize]).collect(),
        loops: border.edges.clone(),
        lines: border.lines.clone(),
    };
    Some((border, sheet, outline))
}

/// Makes the face, or takes it over from an earlier run.
pub fn prepare(made: &Made, face: &Face, (known, job): (Option<&Known>, &Job)) -> Result<Prepared> {
    let (border, sheet, outline) = outlined(made, face).ok_or_else(|| no_area(made, face))?;
    let key = known.map(|known| {
        let odd = if face.takes_quads() { quads::odd(made, face) } else { Vec::new() };
        (known, taken::key(known, made, face, (&border, &outline), (&odd, &near(made, face, &outline))))
    });
    if let Some((known, key)) = key
        && let Some((free, inner, deciders, tally)) = known.free(key).and_then(|taken| taken.parts(border.uv.len()))
    {
        return Ok(Prepared { deciders, tally, ..prepared(made, face, free, border.ids, inner) });
    }
    let ready = grown(made, face, (border, sheet, outline), job)?;
    if let (Some((known, key)), Shape::Free(free)) = (key, &ready.chart.shape) {
        known.keep_free(key, Taken::of(&ready, free));
    }
    Ok(ready)
}

fn grown(made: &Made, face: &Face, (border, sheet, outline): (Border, Sheet, Outline), job: &Job) -> Result<Prepared> {
    if face.elements != Elements::Triangles && face.method.of_triangles().is_none() {
        return quads::prepare(made, face, border, (&sheet, &outline), job);
    }
    let (web, deciders, tally) = match fitting(made, face, &sheet, &outline, job)? {
        Ok(fitted) => fitted,
        Err(trouble) => return Err(fault(made, face, &border, trouble)),
    };
    let fixed = web.fixed as usize;
    // At a pole the chart has an edge that is a point in space.
    let node = |n: u32| border.ids.get(n as usize).copied();
    let flat = |t: &[u32; 3]| (0..3).any(|k| node(t[k]).is_some() && node(t[k]) == node(t[(k + 1) % 3]));
    let triangles: Vec<[u32; 3]> = web.tri.iter().copied().filter(|t| !flat(t)).collect();
    let mut uv = border.uv;
    uv.extend(web.xy[fixed..].iter().map(|xy| sheet.uv(*xy)));
    let inner = web.p[fixed..].to_vec();
    let free = Free { uv, border: fixed, triangles, ..Free::default() };
    Ok(Prepared { deciders, tally, ..prepared(made, face, free, border.ids, inner) })
}

/// A face being fitted: what its triangles are made from and measured by.
struct Fit<'a> {
    made: &'a Made<'a>,
    face: &'a Face,
    surface: &'a Surface,
    sheet: &'a Sheet,
    outline: &'a Outline,
    limits: Limits,
    longest: Longest<'a>,
    care: Care,
}

/// Most inner nodes of a face.
const MOST: usize = MESH_ELEMENTS as usize / 2;

/// Triangles, what decided their sizes, and the cells they were made of.
type Shown = (Web, Vec<Decider>, Option<Tally>);

type Fitted = Result<std::result::Result<Web, Trouble>>;

/// Triangles that keep the limits, and what decided their sizes.
fn fitting(made: &Made, face: &Face, sheet: &Sheet, outline: &Outline, job: &Job) -> Result<std::result::Result<Shown, Trouble>> {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let limits = limits_of(made.input);
    let bent = !surface.is_flat() && (limits.chord.is_some() || limits.angle.is_some());
    let tree = face.method == Method::Quadtree;
    let smooth = if tree { SMOOTH_TREE } else { SMOOTH };
    let care = Care {
        smooth: made.input.plan.smooth.map_or(smooth, |n| n.0 as usize),
        wanted: if tree {
            WANTED_TREE
        } else if bent {
            WANTED_BENT
        } else {
            WANTED
        },
        longest: LONGEST / SPACING,
    };
    let rules = near(made, face, outline);
    let longest = Longest::new(face.size.0, outline, &rules);
    let fit = Fit { made, face, surface, sheet, outline, limits, longest, care };
    if face.method.is_sparing() {
        let mut laid = fit.laid(&rules, job)?;
        if let (Method::Display, Ok((web, _, tally))) = (face.method, &mut laid) {
            fit.thin(web, job)?;
            *tally = None;
        }
        return Ok(laid);
    }
    let background = bent.then(|| fit.background());
    // Growth is that of distances of nodes.
    let slope = rules.slope() / SPACING;
    let sources = Sources::new([rules.items(), &fit.short_edges(background.as_ref(), SPACING)].concat(), slope);
    let mut field = Blend { sources: &sources, range: (face.size.0, made.wanted.written), spacing: SPACING, background };
    let web = if bent { fit.bent(&mut field, job)? } else { fit.even(&mut field, job)? };
    Ok(web.map(|web| {
        let deciders = fit.deciders(&field, &web);
        (web, deciders, None)
    }))
}

/// The sources of a plan that reach a face.
fn near(made: &Made, face: &Face, outline: &Outline) -> Sources {
    let all = &made.wanted.sources;
    let hull = made.input.model.surfaces[face.surface.index()].surface.hull().union(Box3::of(outline.p.iter().copied()));
    let items = all.items().iter().filter(|source| source.reaches(&hull, all.slope(), face.size.0));
    Sources::new(items.copied().collect(), all.slope())
}

/// What stands for the edges of a border among sources.
const BORDER: u32 = u32::MAX;

impl Fit<'_> {
    /// Distances of nodes by the bends of the surface.
    fn background(&self) -> Background {
        let whole = self.outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), xy| (l.min(*xy), h.max(*xy)));
        let size = self.face.size.0 * SPACING;
        let surface = (self.surface, self.sheet.quick());
        let wanted = |xy: DVec2| {
            let jet = self.sheet.jet(xy);
            let plain = bound::wanted(&jet, self.limits.chord, self.limits.angle).min(size / FILLED);
            let at = (DVec2::from(self.sheet.uv(xy)), &jet);
            FILLED * self.limits.chord.map_or(plain, |limit| bound::surely(surface, at, jet.du, (limit, plain)))
        };
        let of = |xy: DVec2| wanted(xy).min(size);
        Background::new(self.sheet, whole, 1.0 + self.made.input.plan.slope(), &of)
    }

    /// Edges of the border that are so short that lengths have to grow from them; nodes are `spacing` times as far apart as
    /// sides are long.
    fn short_edges(&self, background: Option<&Background>, spacing: f64) -> Vec<Source> {
        let growth = 1.0 + self.made.input.plan.slope();
        let source = |edge: [u32; 2]| {
            let [a, b] = edge.map(|n| n as usize);
            let size = self.outline.length(edge);
            let (xy, p) = (0.5 * (self.outline.xy[a] + self.outline.xy[b]), 0.5 * (self.outline.p[a] + self.outline.p[b]));
            let there = background.map_or(f64::INFINITY, |field| field.size(xy, p)).min(self.face.size.0 * SPACING);
            let body = Body::Segment(self.outline.p[a], self.outline.p[b]);
            let from = size.max(self.made.wanted.floor);
            // Nodes are as far from it as it is long.
            (size > 0.0 && from * growth < there).then_some(Source { body, radius: 0.0, size: from / spacing, tag: BORDER })
        };
        self.outline.edges().filter_map(source).collect()
    }

    fn task<'t>(&'t self, field: &'t dyn Field, broken: &'t Broken<'t>) -> Task<'t> {
        let lattice = if self.face.method == Method::Quadtree { Lattice::Tree } else { Lattice::Crystal };
        Task { ground: self.sheet, field, outline: self.outline, care: self.care, lattice, most: MOST, broken: Some(broken) }
    }

    /// Fewer triangles for the same limits.
    fn thin(&self, web: &mut Web, job: &Job) -> Result<()> {
        let limits = if self.surface.is_flat() { &Limits::default() } else { &self.limits };
        let bound = |web: &Web, c: [u32; 3]| loads::load_of_long(self.sheet, web, c, limits).worst();
        let twins = self.outline.twins();
        let allowed = |web: &Web, a: u32, b: u32| self.longest.allows(web, a, b) && !web.joined_elsewhere(&twins, a, b);
        let point = |xy: DVec2| self.sheet.spot(xy).p;
        Thinner { bound: &bound, allowed: &allowed, point: &point }.thin(web, job)?;
        web.compact();
        Ok(())
    }

    /// Between lines of constant u and v.
    fn laid(&self, rules: &Sources, job: &Job) -> Result<std::result::Result<Shown, Trouble>> {
        let plan = self.made.input.plan;
        let floor = self.made.wanted.written;
        let flat = Limits::default();
        let limits = if self.surface.is_flat() { &flat } else { &self.limits };
        let ask = Ask { sheet: self.sheet, outline: self.outline, limits, size: self.face.size.0, rules, floor, most: MOST };
        match lay(&ask, job)? {
            Ok(laid) => Ok(Ok((laid.web, laid.deciders, Some(laid.tally)))),
            Err(Failure::Trouble(trouble)) => Ok(Err(trouble)),
            Err(Failure::Floor(needed, at)) => Err(floor_keeps(self.made.input, needed, at)),
            Err(Failure::Missed(load, at)) => {
                let (limit, says, over) = match (plan.chord_error, plan.angle_error) {
                    (Some(says), _) if load.chord >= load.angle => ("chord_error", says, load.chord),
                    (_, Some(says)) => ("angle_error", says, load.angle),
                    _ => ("size", plan.size.unwrap_or((self.face.size.0, plan.origin)), 1.0),
                };
                Err(MeshFault::NotReached { limit, says: says.1, surface: self.surface.origin(), reached: over * says.0, at }.into())
            }
        }
    }

    /// Without limits on bends: nodes nearer to each other until no side is too long.
    fn even(&self, field: &mut Blend, job: &Job) -> Fitted {
        let broken = |web: &Web, some: &[u32]| self.longest.broken(web, some);
        for _ in 0..ROUNDS {
            let same = Even(field.spacing * self.face.size.0);
            let field_now: &dyn Field = if field.sources.is_empty() { &same } else { &*field };
            match triangulate(&self.task(field_now, &broken), job)? {
                Ok(made) if !made.keeps => field.spacing *= LESS,
                other => return Ok(other.map(|made| made.web)),
            }
        }
        let plan = self.made.input.plan;
        let (says, at) = (plan.size.map_or(plan.origin, |s| s.1), self.outline.p[0]);
        let reached = self.longest.inside;
        Err(MeshFault::NotReached { limit: "size", says, surface: self.surface.origin(), reached, at }.into())
    }

    /// Lengths by the bends at first, smaller where a triangle's bound says so.
    fn bent(&self, field: &mut Blend, job: &Job) -> Fitted {
        let floor = self.made.wanted.written;
        let mut worst = (0.0, DVec3::ZERO, "chord_error");
        let loads = RefCell::new(Loads::default());
        for _ in 0..ROUNDS {
            let broken = |web: &Web, some: &[u32]| {
                let mut loads = loads.borrow_mut();
                loads.update(self.sheet, web, some, &self.limits);
                let mut found = self.longest.broken(web, some);
                let over = |t: &u32| loads.of(*t).worst() > 1.0 && longest_side(web, *t) > floor;
                found.extend(some.iter().copied().filter(over));
                found.sort_unstable();
                found.dedup();
                found
            };
            let web = match triangulate(&self.task(&*field, &broken), job)? {
                // Below a floor limits may be broken all the same; that is told.
                Ok(made) if made.keeps && floor == 0.0 => return Ok(Ok(made.web)),
                Ok(made) => made.web,
                Err(trouble) => return Ok(Err(trouble)),
            };
            worst = self.lower(field, &web, &mut loads.borrow_mut())?;
            if worst.0 == 0.0 {
                return Ok(Ok(web));
            }
            if let Some(background) = &mut field.background {
                background.level();
            }
            job.go_on()?;
        }
        let (limit, at) = (worst.2, worst.1);
        let plan = self.made.input.plan;
        let says = if limit == "chord_error" { plan.chord_error } else { plan.angle_error };
        let reached = worst.0 * says.map_or(0.0, |s| s.0);
        let says = says.map_or(plan.origin, |s| s.1);
        Err(MeshFault::NotReached { limit, says, surface: self.surface.origin(), reached, at }.into())
    }

    /// Lowers lengths where triangles break a limit; the worst of them, with its place and the limit.
    fn lower(&self, field: &mut Blend, web: &Web, loads: &mut Loads) -> Result<(f64, DVec3, &'static str)> {
        let all: Vec<u32> = (0..web.tri.len() as u32).collect();
        loads.update(self.sheet, web, &all, &self.limits);
        let mut stretched = vec![false; web.tri.len()];
        self.longest.broken(web, &all).into_iter().for_each(|t| stretched[t as usize] = true);
        let least = self.made.wanted.written;
        let mut worst = (0.0, DVec3::ZERO, "chord_error");
        for (t, stretched) in stretched.into_iter().enumerate() {
            let load = loads.of(t as u32);
            let over = load.worst().max(if stretched { 1.0 / LESS } else { 0.0 });
            if over <= 1.0 {
                continue;
            }
            let c = web.tri[t].map(|n| n as usize);
            let middle = (web.p[c[0]] + web.p[c[1]] + web.p[c[2]]) / 3.0;
            let factor = if load.chord >= load.angle { load.chord.sqrt() } else { load.angle };
            if load.worst() > 1.0 && longest_side(web, t as u32) <= least {
                return Err(floor_keeps(self.made.input, least / factor, middle));
            }
            if over > worst.0 {
                worst = (over, middle, if load.chord >= load.angle { "chord_error" } else { "angle_error" });
            }
            let smaller = (LESS / factor).max(0.5);
            if let Some(background) = &mut field.background {
                c.iter().for_each(|n| background.lower(web.xy[*n], web.size[*n] * smaller));
            }
        }
        Ok(worst)
    }

    /// What decided the sizes, with the number of inner nodes and one of them.
    fn deciders(&self, field: &Blend, web: &Web) -> Vec<Decider> {
        let mut found: Vec<Decider> = Vec::new();
        let (most, least) = field.range;
        for n in 0..web.p.len() {
            let (xy, p) = (web.xy[n], web.p[n]);
            let source = field.sources.who(p, most);
            let by_sources = source.map_or(most, |s| s.size) * field.spacing;
            let why = match source {
                _ if by_sources.min(field.by_bends(xy, p)) < least * field.spacing => Why::Floor,
                _ if field.by_bends(xy, p) < by_sources => Why::Bends,
                Some(source) if field.sources.items()[source.item as usize].tag == BORDER => Why::Border,
                Some(source) => Why::Refined(field.sources.items()[source.item as usize].tag as usize),
                None => Why::Size,
            };
            let inner = usize::from(n >= web.fixed as usize);
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

/// The longest side of a triangle.
fn longest_side(web: &Web, t: u32) -> f64 {
    let [a, b, c] = web.tri[t as usize].map(|n| web.p[n as usize]);
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

/// How long sides inside a face may be.
struct Longest<'a> {
    /// Between inner nodes where nothing is refined.
    inside: f64,
    /// At each border node: where the border itself has longer steps (a written count), what leans on them is as long.
    at_border: Vec<f64>,
    /// Places where they have to be shorter.
    rules: &'a Sources,
}

impl<'a> Longest<'a> {
    fn new(size: f64, outline: &Outline, rules: &'a Sources) -> Self {
        let inside = LONGEST * size * (1.0 + WHOLE_NUMBER);
        let mut longest = Self { inside, at_border: Vec::new(), rules };
        longest.at_border = outline.p.iter().map(|p| longest.there(*p)).collect();
        // Where something is refined a border may step out of it: the shorter edge at a node counts.
        let (start, pick): (f64, fn(f64, f64) -> f64) = if rules.is_empty() { (0.0, f64::max) } else { (f64::INFINITY, f64::min) };
        let mut steps = vec![start; outline.p.len()];
        for edge in outline.edges() {
            let most = LONGEST * outline.length(edge);
            edge.iter().for_each(|n| steps[*n as usize] = pick(steps[*n as usize], most));
        }
        longest.at_border.iter_mut().zip(steps).filter(|(_, step)| step.is_finite()).for_each(|(most, step)| *most = most.max(step));
        longest
    }

    fn there(&self, p: DVec3) -> f64 {
        if self.rules.is_empty() {
            return self.inside;
        }
        let share = LONGEST * (1.0 + WHOLE_NUMBER);
        share * self.rules.plateau(p, self.inside / share)
    }

    /// How long sides at a node may be.
    fn most_at(&self, web: &Web, n: u32) -> f64 {
        self.at_border.get(n as usize).copied().unwrap_or_else(|| self.there(web.p[n as usize]))
    }

    /// Whether a side inside the face between two nodes may be as long as it is.
    fn allows(&self, web: &Web, a: u32, b: u32) -> bool {
        web.p[a as usize].distance(web.p[b as usize]) <= self.most_at(web, a).max(self.most_at(web, b))
    }

    /// Those of some triangles with a side inside the face that is too long; those between two border nodes are what they are.
    fn broken(&self, web: &Web, some: &[u32]) -> Vec<u32> {
        // Where most are looked at, each node is asked once.
        let all = if 2 * some.len() > web.tri.len() { web.p.len() } else { 0 };
        let known: Vec<f64> = par::map(all, |n| self.most_at(web, n as u32));
        let most = |n: usize| known.get(n).copied().unwrap_or_else(|| self.most_at(web, n as u32));
        let too_long = |t: &u32| {
            let c = web.tri[*t as usize].map(|n| n as usize);
            (0..3).filter(|k| web.locked[*t as usize] >> k & 1 == 0).any(|k| {
                let [a, b] = [c[(k + 1) % 3], c[(k + 2) % 3]];
                a.max(b) >= web.fixed as usize && web.p[a].distance(web.p[b]) > most(a).max(most(b))
            })
        };
        some.iter().copied().filter(too_long).collect()
    }
}

/// First lengths over those that bends ask for: triangles are not all equilateral.
pub const FILLED: f64 = 0.85;
/// What is made smaller is made a little more so.
const LESS: f64 = 0.96;
/// Times a face is made anew for its limits.
const ROUNDS: usize = 12;

fn prepared(made: &Made, face: &Face, free: Free, mut ids: Vec<u32>, inner: Vec<DVec3>) -> Prepared {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let (triangles, quads) = (free.triangles.len() as u64, free.quads.len() as u64);
    ids.resize(free.uv.len(), 0);
    Prepared {
        surface: face.surface,
        chart: Chart { surface: surface.clone(), shape: Shape::Free(free), frame: Frame::Free(ids), flipped: face.flipped },
        elements: face.elements,
        first: 0,
        inner: inner.len() as u64,
        triangles,
        quads,
        made: inner,
        deciders: Vec::new(),
        tally: None,
    }
}

/// The nodes round a face, loop by loop, with their places on the surface.
fn border(made: &Made, face: &Face) -> Border {
    let record = &made.input.model.patches[face.patch.index()];
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let mut border = Border::default();
    let mut known: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    // First and last node of each side, loops apart.
    let mut ends: Vec<Option<(u32, u32)>> = Vec::new();
    for (k, side) in face.sides.iter().enumerate() {
        ends.push(None);
        let line = crate::mesh::faces::line(made.layout, made.nodes, face, k, 1);
        let uv = if side.uses.is_empty() {
            match surface.border_line(k) {
                Some((a, b)) => vec![a, b],
                // An edge that was glued together: its neighbours meet there.
                None if surface.domain() == Domain::Loop => continue,
                None => pole(record, k),
            }
        } else {
            let feet = line.ids.iter().map(|n| surface.flat_uv(made.points[*n as usize])).collect::<Option<Vec<_>>>();
            feet.unwrap_or_else(|| places(made.input, face, k, &line.lengths))
        };
        // Edges have the face on their left; sides of a mapped domain run with ascending u or v.
        let back = made.input.model.runs_back(record, k);
        let mut last: Option<u32> = None;
        for (id, at) in line.ids.iter().zip(uv) {
            // A node may be in several places of the chart (a seam, a pole), but in each of them once.
            let same = |n: &&u32| {
                let there = border.uv[**n as usize];
                (there.0 - at.0).abs().max((there.1 - at.1).abs()) <= ONE_PLACE
            };
            let places = known.entry(*id).or_default();
            let node = places.iter().find(same).copied().unwrap_or_else(|| {
                border.uv.push(at);
                border.ids.push(*id);
                places.push(border.ids.len() as u32 - 1);
                border.ids.len() as u32 - 1
            });
            if let Some(before) = last.filter(|before| *before != node) {
                border.edges.push(if back { [node, before] } else { [before, node] });
            }
            last = Some(node);
            ends[k] = Some((ends[k].map_or(node, |e| e.0), node));
        }
    }
    if surface.domain() == Domain::Loop {
        border.jump(&surface.loops(), &ends);
    }
    super::inner::add(made, face, &mut border, &mut known);
    border
}

/// The two corners of a side that is one point.
fn pole(record: &crate::model::Patch, side: usize) -> Vec<(f64, f64)> {
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    match side {
        0 => vec![(u0, v0), (u1, v0)],
        1 => vec![(u1, v0), (u1, v1)],
        2 => vec![(u0, v1), (u1, v1)],
        _ => vec![(u0, v0), (u0, v1)],
    }
}

/// Surface parameters at ascending lengths along a side of a face that is not a flat one without a map.
pub fn places(input: &Input, face: &Face, side: usize, lengths: &[f64]) -> Vec<(f64, f64)> {
    let record = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    if surface.domain() == Domain::Loop {
        return along_border(surface, side, face.sides[side].length, lengths);
    }
    let at = side_parameters(input, face, side, lengths);
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    at.into_iter()
        .map(|t| match (face.is_triangle(), side) {
            (_, 0) => (t, v0),
            (true, 1) => (1.0 - t, t),
            (true, _) => (0.0, t),
            (false, 1) => (u1, t),
            (false, 2) => (t, v1),
            (false, _) => (u0, t),
        })
        .collect()
}

/// The same on a border of a trimmed surface, `total` long.
fn along_border(surface: &Surface, side: usize, total: f64, lengths: &[f64]) -> Vec<(f64, f64)> {
    match (surface.side(side), surface.border_line(side)) {
        (Side::Chain { from, to, .. }, _) => {
            let place = |s: &f64| surface.border_place(side, from + (to - from) * (s / total)).unwrap_or_default();
            lengths.iter().map(place).collect()
        }
        (_, Some((from, to))) => {
            let trace = Trace::new(surface, from, to);
            lengths.iter().map(|s| trace.uv(trace.at_length(s / total * trace.length()))).collect()
        }
        _ => vec![(0.0, 0.0); lengths.len()],
    }
}

fn no_area(made: &Made, face: &Face) -> Fault {
    let surface = made.input.model.surfaces[face.surface.index()].surface.origin();
    MeshFault::FaceEmpty { surface, at: middle(made.input, face) }.into()
}

/// What went wrong, in the user's words.
fn fault(made: &Made, face: &Face, border: &Border, trouble: Trouble) -> Fault {
    let surface = made.input.model.surfaces[face.surface.index()].surface.origin();
    let place = |n: u32| border.ids.get(n as usize).map_or(DVec3::ZERO, |id| made.points[*id as usize]);
    match trouble {
        Trouble::Border(PointsFault::Crosses(a, b)) => {
            MeshFault::BordersCross { surface, at: 0.5 * (place(a) + place(b)), size: face.size.0 }.into()
        }
        Trouble::Border(PointsFault::Same(a, _)) => MeshFault::BordersCross { surface, at: place(a), size: face.size.0 }.into(),
        Trouble::Border(PointsFault::Flat) | Trouble::Empty => no_area(made, face),
        Trouble::Deep(at) => MeshFault::TreeTooDeep { surface, at, levels: DEEPEST }.into(),
        Trouble::Full => crate::mesh::faces::too_many(made.input.plan, 2 * MESH_ELEMENTS),
    }
}
