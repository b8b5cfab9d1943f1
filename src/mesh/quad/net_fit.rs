//! Nets of quads fitted to the limits: made for wanted lengths, bounded, and made again with shorter ones until one keeps the limits.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job::{self, Job};
use crate::mesh::chart::halves::{Halves, NONE};
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField, Spot, UniformSize};
use crate::mesh::data::quality::{has_no_area, is_concave};
use crate::mesh::quad::collapse::collapse;
use crate::mesh::quad::equalize::Sides;
use crate::mesh::quad::level_face::LevelFace;
use crate::mesh::quad::net::{Net, Raw};
use crate::mesh::quad::odd::whole_sides;
use crate::mesh::quad::open::open;
use crate::mesh::quad::pair::{SingleTriangles, pair};
use crate::mesh::quad::regular::{RegularInput, regularize};
use crate::mesh::quad::remesh::remesh;
use crate::mesh::quad::settings::{CELL_SINGLES, COLLAPSE, MIXED_SINGLES, NET_FIT, REMESH};
use crate::mesh::quad::smooth::Smoother;
use crate::mesh::quad::split::split;
use crate::mesh::quad::swap::Swapper;
use crate::mesh::request::fault::{MeshLimit, SizeFault};
use crate::mesh::request::methods::Elements;
use crate::mesh::request::size_requests::floor_keeps;
use crate::mesh::request::work::allow;
use crate::mesh::size::face_settings::is_plane_lattice;
use crate::mesh::tri::build::{NodePlacement, Task, initial_triangulation};
use crate::mesh::tri::graded_size::GradedSize;
use crate::mesh::tri::limit_table::LimitTable;
use crate::mesh::tri::longest::longest_side;
use crate::mesh::tri::no_mesh::{NoMesh, Outcome};
use crate::mesh::tri::optimize::MeshOptimizer;
use crate::mesh::tri::optimize_settings::FIT;
use crate::mesh::tri::triangle_fit::FaceFit;
use crate::mesh::tri::triangulation::Triangulation;

/// The fit of nets of one face to its limits.
pub(crate) struct NetFit<'a> {
    pub(crate) fit: &'a FaceFit<'a>,
    pub(crate) halves: &'a Halves,
    /// The plane z = 0 in which it lies instead of its own, if it does.
    pub(crate) level: Option<&'a LevelFace<'a>>,
}

/// The largest excess over a limit.
#[derive(Clone, Copy)]
struct Worst {
    over: f64,
    at: DVec3,
    limit: MeshLimit,
}

impl NetFit<'_> {
    pub(crate) fn fitted(&self, field: &mut GradedSize, job: &Job) -> Outcome<Net> {
        let plan = self.fit.face_input.input.plan;
        let mut worst = Worst { over: 0.0, at: DVec3::ZERO, limit: MeshLimit::Size };
        for round in 0..NET_FIT.max_tries {
            let mut net = match self.net(field, job)? {
                Ok(net) => net,
                Err(reason) => return Ok(Err(reason)),
            };
            let mut ratios = LimitTable::default();
            if field.background.is_some() {
                self.repair(&mut net, field, &mut ratios, job)?;
            }
            let side = self.too_long(&net);
            let bend = self.lower(field, &net, side, &mut ratios)?;
            // Only sides may exceed their length: limits are proved.
            let is_strict = round < NET_FIT.strict_tries && !is_plane_lattice(self.fit.face_input.input, self.fit.face);
            let room = if is_strict { 1.0 } else { NET_FIT.max_side_ratio };
            worst = if bend.over > 1.0 && bend.over * room >= side.over { bend } else { side };
            if side.over <= room && bend.over <= 1.0 {
                // What has no area is no element, however often it was tried.
                let is_sound = !self.fit.surface.is_flat() || !any_quad(&net, has_no_area);
                if is_sound && (round >= NET_FIT.tries_without_concave || !any_quad(&net, is_concave)) {
                    return Ok(Ok(net));
                }
                field.spacing *= FIT.size_factor;
            }
            if let Some(background) = &mut field.background {
                // Each net has its cells elsewhere: in the end all of them are made smaller.
                background.scale(if round < NET_FIT.local_tries { 1.0 } else { FIT.size_factor });
                background.level();
            }
            job.go_on()?;
        }
        let at = self.level.map_or(worst.at, |level| level.point(worst.at));
        let setting = plan.limit(worst.limit);
        let reached = worst.over * setting.map_or(self.fit.face.size.0, |s| s.0);
        let (written_at, surface) = (setting.map_or(plan.origin, |s| s.1), self.fit.surface.origin());
        Err(SizeFault::NotReached { limit: worst.limit, written_at, surface, reached, at }.into())
    }

    /// One net for these lengths from nodes of one placement, with a work budget of its own by its number of elements.
    pub(super) fn net_of(&self, field: &GradedSize, placement: NodePlacement, job: &Job) -> Outcome<Net> {
        let same = UniformSize(field.spacing * self.fit.face.size.0);
        let plain = field.sources.is_empty() && field.background.is_none();
        let wanted: &dyn SizeField = if plain { &same } else { field };
        let quads = self.fit.face.elements == Elements::Quads;
        let twice = Twice(wanted);
        let cells: &dyn SizeField = if quads { &twice } else { wanted };
        let mut net = match self.pairs(cells, placement, job)? {
            Ok(net) => net,
            Err(reason) => return Ok(Err(reason)),
        };
        self.smooth(&mut net, cells, job)?;
        if quads {
            Swapper::new(&mut net).swap();
            self.collapse(&mut net, cells, job)?;
            debug_assert_eq!(net.check(), Ok(()));
            self.smooth(&mut net, cells, job)?;
            let Some(whole) = whole_sides(&net) else { return Ok(Err(NoMesh::Odd)) };
            self.narrow_rows(&mut net, &whole, cells, job)?;
            net = split(&net, &whole, self.fit.chart, wanted);
            self.smooth(&mut net, wanted, job)?;
            let fewer = self.collapse(&mut net, wanted, job)?;
            if self.regularize(&mut net, wanted, job)? || fewer {
                self.smooth(&mut net, wanted, job)?;
            }
            self.remesh(&mut net, wanted, job)?;
        }
        self.shorten(&mut net, wanted, job)?;
        Ok(Ok(net))
    }

    /// Triangles between nodes of a lattice and of the border, paired.
    fn pairs(&self, cells: &dyn SizeField, lattice: NodePlacement, job: &Job) -> Outcome<Net> {
        let quads = self.fit.face.elements == Elements::Quads;
        let (chart_surface, outline) = (self.fit.chart, &self.halves.outline);
        let most = if quads { self.fit.most().div_ceil(4) } else { self.fit.most() };
        let task = Task {
            chart_surface,
            interpolated: None,
            field: cells,
            outline,
            settings: self.fit.settings,
            lattice,
            most,
            limit_check: None,
            sliding: None,
        };
        let triangulation = match initial_triangulation(&task, job)? {
            Ok(triangulation) => triangulation,
            Err(reason) => return Ok(Err(reason)),
        };
        allow(NET_FIT.element_work * if quads { 2 } else { 1 } * triangulation.tri.len() as u64, &mut 0);
        let mut optimizer = MeshOptimizer::new(triangulation, chart_surface, cells, self.fit.settings);
        optimizer.flip_all();
        let mut triangulation = optimizer.triangulation;
        // Where loops touch, nodes may have grown through the point into a hole.
        triangulation.compact();
        job.go_on()?;
        let normal: Vec<DVec3> = triangulation.xy.iter().map(|xy| chart_surface.spot(*xy).normal()).collect();
        let flat = SingleTriangles::flat(&triangulation, self.halves);
        let mate = pair(&triangulation, &normal, &flat, if quads { CELL_SINGLES } else { MIXED_SINGLES });
        let net = Raw { triangulation: &triangulation, mate: &mate, flat: &flat, normal: &normal, halves: self.halves }.net();
        debug_assert_eq!(net.check().and(net.check_upright()), Ok(()));
        Ok(Ok(net))
    }

    /// Whether few irregular nodes are asked for.
    pub(super) fn is_regular(&self) -> bool {
        self.fit.face.elements == Elements::Quads && self.fit.face_input.input.plan.settings.regular()
    }

    /// Fills cavities about irregular nodes anew where that is asked for; whether any was.
    fn regularize(&self, net: &mut Net, field: &dyn SizeField, job: &Job) -> Result<bool> {
        let Some(plane) = self.fit.chart.plane().filter(|_| self.is_regular()) else { return Ok(false) };
        regularize(net, &self.regular_input(plane, field), job)
    }

    fn regular_input<'a>(&self, plane: Spot, field: &'a dyn SizeField) -> RegularInput<'a> {
        RegularInput { plane, field, always: self.fit.longest.always(), has_lines: !self.halves.outline.lines.is_empty() }
    }

    /// Fills cavities about bad quads anew.
    fn remesh(&self, net: &mut Net, field: &dyn SizeField, job: &Job) -> Result<()> {
        let Some(plane) = self.fit.chart.plane().filter(|_| self.fit.settings.smoothing_rounds > 0) else { return Ok(()) };
        for _ in 0..REMESH.max_rounds {
            let nodes = remesh(net, &self.regular_input(plane, field), job)?;
            if nodes.is_empty() {
                break;
            }
            let mut smoother = Smoother::new(net, self.fit.chart, field).only(&nodes);
            smoother.smooth(self.fit.settings.smoothing_rounds, job)?;
            smoother.repair(NET_FIT.min_quality, NET_FIT.max_repair_rounds, job)?;
        }
        Ok(())
    }

    /// Takes out quads between irregular nodes; whether there were any.
    fn collapse(&self, net: &mut Net, field: &dyn SizeField, job: &Job) -> Result<bool> {
        for round in 0..COLLAPSE.max_rounds {
            let left = collapse(net, self.fit.chart, field);
            if left.is_empty() {
                return Ok(round > 0);
            }
            Smoother::new(net, self.fit.chart, field).only(&left).smooth(self.fit.settings.smoothing_rounds, job)?;
        }
        Ok(true)
    }

    /// Rows of sides that are not halved get half as wide as others.
    fn narrow_rows(&self, net: &mut Net, whole: &[u8], cells: &dyn SizeField, job: &Job) -> Result<()> {
        let mut sides: BTreeSet<(usize, usize)> = BTreeSet::new();
        for (f, whole) in whole.iter().enumerate().filter(|(_, whole)| **whole != 0) {
            let c = net.corners(f);
            let side = |k: usize| (c[k] as usize, c[(k + 1) % c.len()] as usize);
            sides.extend((0..c.len()).filter(|k| whole >> k & 1 == 1).map(side).map(|(a, b)| (a.min(b), a.max(b))));
        }
        if sides.is_empty() || self.fit.settings.smoothing_rounds == 0 {
            return Ok(());
        }
        let longest = &self.fit.longest;
        let over = |net: &Net, a: usize, b: usize| {
            let steps = if sides.contains(&(a.min(b), a.max(b))) { 1.0 } else { 2.0 };
            net.p[a].distance(net.p[b]) / (steps * longest.at(&net.p, a as u32).max(longest.at(&net.p, b as u32)))
        };
        let sides = Sides { over: &over, always: 0.0 };
        Smoother::new(net, self.fit.chart, cells).even_out(&sides, NET_FIT.max_evening_rounds, job)
    }

    /// Shortens long sides at the cost of their neighbours, and puts more quads across those that stay too long.
    fn shorten(&self, net: &mut Net, wanted: &dyn SizeField, job: &Job) -> Result<()> {
        if self.fit.settings.smoothing_rounds == 0 {
            return Ok(());
        }
        let (longest, chart_surface) = (&self.fit.longest, self.fit.chart);
        let over =
            |net: &Net, a: usize, b: usize| net.p[a].distance(net.p[b]) / longest.at(&net.p, a as u32).max(longest.at(&net.p, b as u32));
        let sides = Sides { over: &over, always: longest.always() };
        Smoother::new(net, chart_surface, wanted).even_out(&sides, NET_FIT.max_evening_rounds, job)?;
        for _ in 0..NET_FIT.max_opening_rounds {
            let opened = open(net, chart_surface, wanted, &sides);
            if opened.is_empty() {
                break;
            }
            let mut smoother = Smoother::new(net, chart_surface, wanted).only(&opened);
            smoother.smooth(self.fit.settings.smoothing_rounds, job)?;
            smoother.repair(NET_FIT.min_quality, NET_FIT.max_repair_rounds, job)?;
            smoother.even_out(&sides, NET_FIT.max_evening_rounds, job)?;
        }
        Ok(())
    }

    fn smooth(&self, net: &mut Net, field: &dyn SizeField, job: &Job) -> Result<()> {
        let mut smoother = Smoother::new(net, self.fit.chart, field);
        smoother.smooth(self.fit.settings.smoothing_rounds, job)?;
        if self.fit.settings.smoothing_rounds > 0 {
            smoother.repair(NET_FIT.min_quality, NET_FIT.max_repair_rounds, job)?;
        }
        Ok(())
    }

    /// Lowers lengths where the longest side or an element exceeds a limit; the largest excess over the chord error or the angle, 0 where there is
    /// none.
    fn lower(&self, field: &mut GradedSize, net: &Net, side: Worst, ratios: &mut LimitTable) -> Result<Worst> {
        let mut worst = Worst { over: 0.0, limit: MeshLimit::ChordError, ..side };
        if side.over > 1.0 {
            field.spacing *= (1.0 / side.over).clamp(NET_FIT.min_spacing_factor, FIT.size_factor);
        }
        if field.background.is_none() {
            return Ok(worst);
        }
        let triangulation = nodes(net);
        let all: Vec<u32> = (0..triangulation.tri.len() as u32).collect();
        ratios.update(self.fit.chart, &triangulation, &all, &self.fit.limits);
        let least = self.fit.face_input.wanted.written;
        for t in 0..triangulation.tri.len() as u32 {
            let ratio = ratios.of(t);
            if ratio.worst() <= 1.0 {
                continue;
            }
            let c = triangulation.tri[t as usize].map(|n| n as usize);
            let at = (triangulation.p[c[0]] + triangulation.p[c[1]] + triangulation.p[c[2]]) / 3.0;
            let factor = if ratio.chord >= ratio.angle { ratio.chord.sqrt() } else { ratio.angle };
            if longest_side(&triangulation, t) <= least {
                return Err(floor_keeps(self.fit.face_input.input, least / factor, at));
            }
            if ratio.worst() > worst.over {
                worst = Worst { over: ratio.worst(), at, limit: ratio.limit() };
            }
            let smaller = (NET_FIT.size_factor / factor).max(0.5);
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
        let always = longest.always();
        for f in 0..net.face.len() {
            let c = net.corners(f);
            for k in 0..c.len() {
                let (a, b) = (c[k], c[(k + 1) % c.len()]);
                // Each side once; those between border nodes are given.
                if a > b || a < net.fixed && b < net.fixed {
                    continue;
                }
                if net.p[a as usize].distance_squared(net.p[b as usize]) <= always * always {
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

/// Whether something holds of the corners of some quad.
fn any_quad(net: &Net, holds: impl Fn([DVec3; 4]) -> bool) -> bool {
    let quads = net.face.iter().filter(|face| face[3] != NONE);
    job::looking(quads).any(|quad| holds(quad.map(|n| net.p[n as usize])))
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
