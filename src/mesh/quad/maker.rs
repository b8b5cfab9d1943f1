//! Nets of quads made for wanted lengths, bounded, and made again with shorter ones until one keeps the limits.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::{self, Job};
use crate::mesh::chart::halves::{Halves, NONE};
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField, UniformSize};
use crate::mesh::data::quality::is_concave;
use crate::mesh::quad::net::{Net, Raw};
use crate::mesh::quad::odd::whole_sides;
use crate::mesh::quad::open::open;
use crate::mesh::quad::pair::{Alone, pair};
use crate::mesh::quad::smooth::Smoother;
use crate::mesh::quad::split::split;
use crate::mesh::quad::swap::Swapper;
use crate::mesh::request::fault::{MeshFault, MeshLimit};
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::request::size_requests::floor_keeps;
use crate::mesh::request::work::allow;
use crate::mesh::tri::build::{Lattice, Task, initial_triangulation};
use crate::mesh::tri::fit::{Fit, LESS};
use crate::mesh::tri::graded_size::GradedSize;
use crate::mesh::tri::limit_table::LimitTable;
use crate::mesh::tri::longest::longest_side;
use crate::mesh::tri::optimize::MeshOptimizer;
use crate::mesh::tri::triangulation::Triangulation;
use crate::mesh::tri::trouble::Trouble;

/// Work of an element over that of a triangle: nets are smoothed, split and smoothed again, and repaired.
const WORK_OF_QUADS: u64 = 4;
/// Quality of pairs that is better than two triangles: of `mixed`.
const MIXED: Alone = Alone { least: 0.5, worth: 0.5 };
/// The same for cells that are halved: triangles become three quads each.
const CELLS: Alone = Alone { least: 0.2, worth: 0.45 };
/// Quality below which elements are worked on.
const WANTED: f64 = 0.8;
/// Rounds of that work.
const MENDS: usize = 6;
/// Rounds in which long sides are shared out to their neighbours.
const SHARES: usize = 60;
/// Rounds in which nodes at long sides are opened.
const OPENINGS: usize = 8;
/// How much longer than that a side may be that is left after so many tries: a row of squares met another one there.
const ROOM: f64 = 1.2;
/// Tries in which no side may be longer: lengths are lowered everywhere for one that is, and the next try leaves another one.
const STRICT: usize = 1;
/// What is made smaller where a limit is broken is made more so.
const LOWER: f64 = 0.9;
/// Times a face is made anew for its limits.
const TRIES: usize = 20;
/// Tries after which concave quads are told, and no longer made anew with shorter lengths.
const WHOLE: usize = 8;
/// Rounds in which lengths are lowered only where a limit is broken.
const LOCAL: usize = 4;
/// The least that all lengths are lowered to at once, over what they were.
const MOST_LESS: f64 = 0.9;

/// A net, or why there is none.
type Fitted = Result<std::result::Result<Net, Trouble>>;

/// Makes nets of one face until one keeps the limits.
pub(crate) struct Maker<'a> {
    pub(crate) fit: &'a Fit<'a>,
    pub(crate) halves: &'a Halves,
}

/// What breaks a limit most.
#[derive(Clone, Copy)]
struct Worst {
    over: f64,
    at: DVec3,
    limit: MeshLimit,
}

impl Maker<'_> {
    pub(crate) fn fitted(&self, field: &mut GradedSize, job: &Job) -> Fitted {
        let plan = self.fit.made.input.plan;
        let mut worst = Worst { over: 0.0, at: DVec3::ZERO, limit: MeshLimit::Size };
        for round in 0..TRIES {
            let mut net = match self.net(field, job)? {
                Ok(net) => net,
                Err(trouble) => return Ok(Err(trouble)),
            };
            let mut loads = LimitTable::default();
            if field.background.is_some() {
                self.repair(&mut net, field, &mut loads, job)?;
            }
            let side = self.too_long(&net);
            let bend = self.lower(field, &net, (side, &mut loads))?;
            // Only sides have room: how much too long one is says nothing of limits that are proved.
            let room = if round >= STRICT { ROOM } else { 1.0 };
            worst = if bend.over > 1.0 && bend.over * room >= side.over { bend } else { side };
            if side.over <= room && bend.over <= 1.0 {
                if round >= WHOLE || !has_concave(&net) {
                    return Ok(Ok(net));
                }
                field.spacing *= LESS;
            }
            if let Some(background) = &mut field.background {
                // Where cells fall is another matter each time: in the end all of them are made smaller.
                background.scale(if round < LOCAL { 1.0 } else { LESS });
                background.level();
            }
            job.go_on()?;
        }
        let says = plan.limit(worst.limit);
        let reached = worst.over * says.map_or(self.fit.face.size.0, |s| s.0);
        let (says, surface) = (says.map_or(plan.origin, |s| s.1), self.fit.surface.origin());
        Err(MeshFault::NotReached { limit: worst.limit, says, surface, reached, at: worst.at }.into())
    }

    /// One net for these lengths, which may take the work that its elements are worth whatever nets before took.
    fn net(&self, field: &GradedSize, job: &Job) -> Fitted {
        let same = UniformSize(field.spacing * self.fit.face.size.0);
        let plain = field.sources.is_empty() && field.background.is_none();
        let wanted: &dyn SizeField = if plain { &same } else { field };
        let quads = self.fit.face.elements == Elements::Quads;
        let twice = Twice(wanted);
        let cells: &dyn SizeField = if quads { &twice } else { wanted };
        let lattice = if self.fit.face.method == Method::Quadtree { Lattice::Tree } else { Lattice::Squares };
        let (chart_surface, outline) = (self.fit.chart, &self.halves.outline);
        let most = if quads { self.fit.most().div_ceil(4) } else { self.fit.most() };
        let task = Task { chart_surface, field: cells, outline, settings: self.fit.settings, lattice, most, limit_check: None };
        let triangulation = match initial_triangulation(&task, job)? {
            Ok(triangulation) => triangulation,
            Err(trouble) => return Ok(Err(trouble)),
        };
        allow(WORK_OF_QUADS * if quads { 2 } else { 1 } * triangulation.tri.len() as u64, &mut 0);
        let mut optimizer = MeshOptimizer::new(triangulation, chart_surface, cells, self.fit.settings);
        optimizer.flip_all();
        let mut triangulation = optimizer.triangulation;
        // Where loops touch, nodes may have grown through the point into a hole.
        triangulation.compact();
        job.go_on()?;
        let normal: Vec<DVec3> = triangulation.xy.iter().map(|xy| chart_surface.spot(*xy).normal()).collect();
        let flat = Alone::flat(&triangulation, self.halves);
        let mate = pair(&triangulation, &normal, &flat, if quads { CELLS } else { MIXED });
        let mut net = Raw { triangulation: &triangulation, mate: &mate, flat: &flat, normal: &normal, halves: self.halves }.net();
        debug_assert_eq!(net.check().and(net.check_upright()), Ok(()));
        drop(triangulation);
        self.smooth(&mut net, cells, job)?;
        if quads {
            Swapper::new(&mut net).swap();
            debug_assert_eq!(net.check(), Ok(()));
            self.smooth(&mut net, cells, job)?;
            let Some(whole) = whole_sides(&net) else { return Ok(Err(Trouble::Odd)) };
            self.narrow_rows(&mut net, &whole, cells, job)?;
            net = split(&net, &whole, (chart_surface, wanted));
            self.smooth(&mut net, wanted, job)?;
        }
        self.shorten(&mut net, wanted, job)?;
        Ok(Ok(net))
    }

    /// Rows of sides that are not halved get half as wide as others.
    fn narrow_rows(&self, net: &mut Net, whole: &[u8], cells: &dyn SizeField, job: &Job) -> Result<()> {
        let mut sides: BTreeSet<(usize, usize)> = BTreeSet::new();
        for (f, whole) in whole.iter().enumerate().filter(|(_, whole)| **whole != 0) {
            let c = net.corners(f);
            let side = |k: usize| (c[k] as usize, c[(k + 1) % c.len()] as usize);
            sides.extend((0..c.len()).filter(|k| whole >> k & 1 == 1).map(side).map(|(a, b)| (a.min(b), a.max(b))));
        }
        if sides.is_empty() || self.fit.settings.smooth == 0 {
            return Ok(());
        }
        let longest = &self.fit.longest;
        let over = |net: &Net, a: usize, b: usize| {
            let steps = if sides.contains(&(a.min(b), a.max(b))) { 1.0 } else { 2.0 };
            net.p[a].distance(net.p[b]) / (steps * longest.at(&net.p, a as u32).max(longest.at(&net.p, b as u32)))
        };
        Smoother::new(net, self.fit.chart, cells).even_out(&over, SHARES, job)
    }

    /// Shares long sides out, and crosses those that stay too long by more quads.
    fn shorten(&self, net: &mut Net, wanted: &dyn SizeField, job: &Job) -> Result<()> {
        if self.fit.settings.smooth == 0 {
            return Ok(());
        }
        let (longest, chart_surface) = (&self.fit.longest, self.fit.chart);
        let over =
            |net: &Net, a: usize, b: usize| net.p[a].distance(net.p[b]) / longest.at(&net.p, a as u32).max(longest.at(&net.p, b as u32));
        Smoother::new(net, chart_surface, wanted).even_out(&over, SHARES, job)?;
        for _ in 0..OPENINGS {
            let opened = open(net, (chart_surface, wanted), &over);
            if opened.is_empty() {
                break;
            }
            let mut smoother = Smoother::new(net, chart_surface, wanted).only(&opened);
            smoother.smooth(self.fit.settings.smooth, job)?;
            smoother.repair(WANTED, MENDS, job)?;
            smoother.even_out(&over, SHARES, job)?;
        }
        Ok(())
    }

    fn smooth(&self, net: &mut Net, field: &dyn SizeField, job: &Job) -> Result<()> {
        let mut smoother = Smoother::new(net, self.fit.chart, field);
        smoother.smooth(self.fit.settings.smooth, job)?;
        if self.fit.settings.smooth > 0 {
            smoother.repair(WANTED, MENDS, job)?;
        }
        Ok(())
    }

    /// Lowers lengths where the longest side or an element breaks a limit; what breaks one of chord error or angle most, 0 where nothing does.
    fn lower(&self, field: &mut GradedSize, net: &Net, (side, loads): (Worst, &mut LimitTable)) -> Result<Worst> {
        let mut worst = Worst { over: 0.0, limit: MeshLimit::ChordError, ..side };
        if side.over > 1.0 {
            field.spacing *= (1.0 / side.over).clamp(MOST_LESS, LESS);
        }
        if field.background.is_none() {
            return Ok(worst);
        }
        let triangulation = nodes(net);
        let all: Vec<u32> = (0..triangulation.tri.len() as u32).collect();
        loads.update(self.fit.chart, &triangulation, &all, &self.fit.limits);
        let least = self.fit.made.wanted.written;
        for t in 0..triangulation.tri.len() as u32 {
            let load = loads.of(t);
            if load.worst() <= 1.0 {
                continue;
            }
            let c = triangulation.tri[t as usize].map(|n| n as usize);
            let at = (triangulation.p[c[0]] + triangulation.p[c[1]] + triangulation.p[c[2]]) / 3.0;
            let factor = if load.chord >= load.angle { load.chord.sqrt() } else { load.angle };
            if longest_side(&triangulation, t) <= least {
                return Err(floor_keeps(self.fit.made.input, least / factor, at));
            }
            if load.worst() > worst.over {
                worst = Worst { over: load.worst(), at, limit: load.limit() };
            }
            let smaller = (LOWER / factor).max(0.5);
            if let Some(background) = &mut field.background {
                c.iter().for_each(|n| background.lower(triangulation.xy[*n], triangulation.size[*n] * smaller));
            }
        }
        Ok(worst)
    }

    /// The side inside the face that is longest for its place.
    fn too_long(&self, net: &Net) -> Worst {
        let longest = &self.fit.longest;
        let mut worst = Worst { over: 0.0, at: DVec3::ZERO, limit: MeshLimit::Size };
        for f in 0..net.face.len() {
            let c = net.corners(f);
            for k in 0..c.len() {
                let (a, b) = (c[k], c[(k + 1) % c.len()]);
                // Each side once; those between border nodes are what they are.
                if a > b || a < net.fixed && b < net.fixed {
                    continue;
                }
                let allowed = longest.at(&net.p, a).max(longest.at(&net.p, b));
                let over = net.p[a as usize].distance(net.p[b as usize]) / allowed;
                if over > worst.over {
                    worst = Worst { over, at: net.p[a as usize], ..worst };
                }
            }
        }
        worst
    }
}

/// Whether some quad has a corner of a half turn or more.
fn has_concave(net: &Net) -> bool {
    let quads = net.face.iter().filter(|face| face[3] != NONE);
    job::looking(quads).any(|quad| is_concave(quad.map(|n| net.p[n as usize])))
}

/// The nodes of a net as those of a triangulation, with each quad as two triangles.
pub(crate) fn nodes(net: &Net) -> Triangulation {
    let mut triangulation = Triangulation::default();
    (triangulation.p, triangulation.xy, triangulation.size, triangulation.fixed) =
        (net.p.clone(), net.xy.clone(), net.size.clone(), net.fixed);
    for [a, b, c, d] in net.face.iter().copied() {
        triangulation.tri.push([a, b, c]);
        if d != NONE {
            triangulation.tri.push([a, c, d]);
        }
    }
    triangulation
}

/// Twice the wanted lengths: of cells that are halved.
struct Twice<'a>(&'a dyn SizeField);

impl SizeField for Twice<'_> {
    fn size(&self, xy: DVec2, p: DVec3) -> f64 {
        2.0 * self.0.size(xy, p)
    }

    fn is_even(&self) -> bool {
        self.0.is_even()
    }
}
