//! How far the triangles of a free face are from the limits of their mesh.

use std::cell::RefCell;

use glam::{DVec2, DVec3};

use crate::base::math::angle_between;
use crate::base::par;
use crate::base::tolerance::PARALLEL;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::deviation::poles::{self, from_pole, under};
use crate::mesh::deviation::{sides, triangle};
use crate::mesh::request::fault::MeshLimit;
use crate::mesh::request::limits::Limits;
use crate::mesh::size::gaps;
use crate::mesh::tri::triangulation::Triangulation;

/// Triangles that one thread bounds at a time.
const BATCH: usize = 1024;

/// How far a triangle is from its limits: 1 is just kept.
#[derive(Clone, Copy, Debug, Default)]
pub struct LimitRatio {
    /// Bound of the chord error over the limit.
    pub chord: f64,
    /// Turn of the normal over the limit.
    pub angle: f64,
}

impl LimitRatio {
    /// The worse of the two.
    pub fn worst(&self) -> f64 {
        self.chord.max(self.angle)
    }

    /// Which of the two is worse.
    pub fn limit(&self) -> MeshLimit {
        if self.chord >= self.angle { MeshLimit::ChordError } else { MeshLimit::AngleError }
    }
}

/// Limit ratios of the triangles of a triangulation, each found once for the same corners at the same places.
#[derive(Default)]
pub struct LimitTable {
    seen: Vec<([DVec2; 3], LimitRatio)>,
}

impl LimitTable {
    /// The load of a triangle after [`LimitTable::update`].
    pub fn of(&self, t: u32) -> LimitRatio {
        self.seen[t as usize].1
    }

    /// Finds those of some triangles that are new or have changed.
    pub fn update(&mut self, chart: &Chart, triangulation: &Triangulation, some: &[u32], limits: &Limits) {
        self.seen.resize(triangulation.tri.len(), ([DVec2::INFINITY; 3], LimitRatio::default()));
        let corners = |t: u32| triangulation.tri[t as usize].map(|n| triangulation.xy[n as usize]);
        let stale: Vec<u32> = some.iter().copied().filter(|t| corners(*t) != self.seen[*t as usize].0).collect();
        let batches = par::map(stale.len().div_ceil(BATCH), |batch| {
            let some = &stale[batch * BATCH..stale.len().min((batch + 1) * BATCH)];
            some.iter().map(|t| load_with_sides(chart, triangulation, *t, limits)).collect::<Vec<_>>()
        });
        for (t, load) in stale.iter().zip(batches.into_iter().flatten()) {
            self.seen[*t as usize] = (corners(*t), load);
        }
    }
}

/// Normals of the surface at the nodes of a triangulation, each found once for a node at the same place.
#[derive(Default)]
pub struct Normals {
    seen: RefCell<Vec<(DVec2, DVec3)>>,
}

impl Normals {
    fn of_all(&self, chart: &Chart, triangulation: &Triangulation, nodes: [u32; 3]) -> [DVec3; 3] {
        let mut seen = self.seen.borrow_mut();
        if seen.len() < triangulation.xy.len() {
            seen.resize(triangulation.xy.len(), (DVec2::INFINITY, DVec3::ZERO));
        }
        nodes.map(|n| {
            let (xy, known) = (triangulation.xy[n as usize], &mut seen[n as usize]);
            if known.0 != xy {
                *known = (xy, normal_at(chart, xy));
            }
            known.1
        })
    }
}

/// The bounds of three nodes as a triangle that may be long against the limits.
pub fn load_of_long(chart: &Chart, triangulation: &Triangulation, corners: [u32; 3], limits: &Limits, normals: &Normals) -> LimitRatio {
    let lean = lean_of(normals.of_all(chart, triangulation, corners), corners.map(|n| triangulation.p[n as usize]));
    load_of_leaning(chart, triangulation, corners, limits, lean)
}

/// The worse of the two, infinite where the triangle lies upside down at one of its corners.
pub fn load_of_upright(chart: &Chart, triangulation: &Triangulation, corners: [u32; 3], limits: &Limits, normals: &Normals) -> f64 {
    let lean = lean_of(normals.of_all(chart, triangulation, corners), corners.map(|n| triangulation.p[n as usize]));
    if lean < 0.0 { f64::INFINITY } else { load_of_leaning(chart, triangulation, corners, limits, lean).worst() }
}

fn load_of_leaning(chart: &Chart, triangulation: &Triangulation, corners: [u32; 3], limits: &Limits, lean: f64) -> LimitRatio {
    let c = corners.map(|n| n as usize);
    let (xy, p) = (c.map(|n| triangulation.xy[n]), c.map(|n| triangulation.p[n]));
    let beside = beside(chart, triangulation, c, limits);
    let load = leaning(chart, (xy, p, beside), of_places(chart, (xy, p, beside), limits), lean, limits);
    let fixed = corners.iter().any(|n| *n < triangulation.fixed);
    if fixed { load } else { capped(chart, (xy, p), load, limits) }
}

/// No place of the surface over a triangle is farther from it than the surface there reaches: all there is to say at a tip, where
/// nothing bounds its bend.
fn capped(chart: &Chart, (xy, p): ([DVec2; 3], [DVec3; 3]), load: LimitRatio, limits: &Limits) -> LimitRatio {
    let Some(limit) = limits.chord.filter(|_| load.chord > 1.0) else { return load };
    // The surface reaches at least from corner to corner.
    if load.chord.is_finite() && (0..3).any(|k| p[k].distance(p[(k + 1) % 3]) > limit) {
        return load;
    }
    let at = xy.map(|xy| DVec2::from(chart.uv(xy)));
    let (low, high) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
    if !(low.cmpge(DVec2::ZERO).all() && high.cmple(DVec2::ONE).all()) {
        return load;
    }
    let enclosure = chart.surface().enclosure((low.x, high.x), (low.y, high.y));
    let reach = enclosure.du.reach() * (high.x - low.x) + enclosure.dv.reach() * (high.y - low.y);
    if reach.is_finite() { LimitRatio { chord: load.chord.min(reach / limit), ..load } } else { load }
}

/// Cosine of the largest angle that a triangle may stand at to its surface.
const UPRIGHT: f64 = 0.5;

/// Share of the chord error by which the surface may be off a triangle that lies upside down at a corner.
const TURNED: f64 = 0.25;

/// The normal of the surface at a place; none at a pole, where rounding alone has one.
fn normal_at(chart: &Chart, xy: DVec2) -> DVec3 {
    if poles::is_pole(&|at| chart.tangents(at.into()), DVec2::from(chart.uv(xy))) { DVec3::ZERO } else { chart.spot(xy).normal() }
}

/// The least cosine of the angles between a triangle and its surface at the corners. Three places on one bent line are a
/// triangle that stands on edge: near to what is over it along its own normal, and its sides far from the surface all the same.
fn lean(chart: &Chart, xy: [DVec2; 3], p: [DVec3; 3]) -> f64 {
    lean_of(xy.map(|xy| normal_at(chart, xy)), p)
}

/// The same by the normals of the surface at the corners.
fn lean_of(own: [DVec3; 3], p: [DVec3; 3]) -> f64 {
    // Two corners in a pole, or three on a line, have no normal but by rounding.
    let square = p[0].distance_squared(p[1]).max(p[1].distance_squared(p[2])).max(p[2].distance_squared(p[0]));
    let up = (p[1] - p[0]).cross(p[2] - p[0]);
    let normal = if up.length() > PARALLEL * square { up.normalize_or_zero() } else { DVec3::ZERO };
    let cosine = |own: DVec3| if own == DVec3::ZERO || normal == DVec3::ZERO { 1.0 } else { own.dot(normal) };
    own.into_iter().map(cosine).fold(1.0, f64::min)
}

/// The load of a triangle that leans against its surface: what is over it along its normal may be, from its sides, as much farther as the
/// cosine between the two, `lean`, is less than 1. Where that alone breaks the limit the sides themselves are looked at. Where it stands
/// nearly on edge, how far the surface is in any direction from the places between the corners is the bound; upside down it has to be a part of
/// the limit, for there the surface itself turns round within it.
fn leaning(chart: &Chart, (xy, p, beside): ([DVec2; 3], [DVec3; 3], f64), load: LimitRatio, lean: f64, limits: &Limits) -> LimitRatio {
    let chord = match limits.chord {
        Some(limit) if load.chord > 0.0 && lean < UPRIGHT => {
            let (first, second) = under(&|at| chart.tangents(at.into()), xy.map(|xy| DVec2::from(chart.uv(xy))));
            let off = |uv| triangle::in_any_direction(chart.surface(), uv);
            let off = (off(first).max(second.map_or(0.0, off)) + beside) / limit;
            if lean < 0.0 && off > TURNED { f64::INFINITY } else { off }
        }
        Some(limit) if load.chord > lean && load.chord <= 1.0 => {
            let ends = poles::sides(&|at| chart.tangents(at.into()), xy.map(|xy| DVec2::from(chart.uv(xy)))).map(Some);
            let farthest = sides::distance(chart.evaluator(), ends, p, limit - beside);
            load.chord.max((farthest + beside) / limit).min(load.chord / lean)
        }
        _ => load.chord / lean.max(UPRIGHT),
    };
    LimitRatio { chord, ..load }
}

/// The bounds of three nodes as a triangle against the limits; `first` is where the first of them is to go.
pub fn load(chart: &Chart, triangulation: &Triangulation, corners: [u32; 3], first: Option<(DVec2, DVec3)>, limits: &Limits) -> LimitRatio {
    let c = corners.map(|n| n as usize);
    let at = |k: usize| first.filter(|_| k == 0).unwrap_or_else(|| (triangulation.xy[c[k]], triangulation.p[c[k]]));
    let at = [at(0), at(1), at(2)];
    of_places(chart, (at.map(|at| at.0), at.map(|at| at.1), beside(chart, triangulation, c, limits)), limits)
}

/// How far nodes of the border among some are from the surface.
fn beside(chart: &Chart, triangulation: &Triangulation, nodes: [usize; 3], limits: &Limits) -> f64 {
    let Some(limit) = limits.chord else { return 0.0 };
    nodes.into_iter().filter(|n| *n < triangulation.fixed as usize).map(|n| off_surface(chart, triangulation, n, limit)).fold(0.0, f64::max)
}

/// The bounds of a triangle, and of its sides where it leans so far that they may break the limit though its plane keeps it: a height over
/// the plane is, along the normal of the surface, as much farther as the cosine between the two is less than 1.
fn load_with_sides(chart: &Chart, triangulation: &Triangulation, t: u32, limits: &Limits) -> LimitRatio {
    let corners = triangulation.tri[t as usize];
    let found = load(chart, triangulation, corners, None, limits);
    let Some(limit) = limits.chord.filter(|_| found.chord > 0.0 && found.chord <= 1.0) else { return found };
    let (xy, p) = (corners.map(|n| triangulation.xy[n as usize]), corners.map(|n| triangulation.p[n as usize]));
    if found.chord <= lean(chart, xy, p) {
        return found;
    }
    let mut ends = poles::sides(&|at| chart.tangents(at.into()), xy.map(|xy| DVec2::from(chart.uv(xy)))).map(Some);
    // Borders keep the limit by themselves.
    let locked = triangulation.locked.get(t as usize).map_or(0, |bits| *bits);
    (0..3).filter(|k| locked >> k & 1 == 1).for_each(|k| ends[k] = None);
    let farthest = sides::distance(chart.evaluator(), ends, p, limit);
    LimitRatio { chord: found.chord.max(farthest / limit), ..found }
}

/// The same of three places of the chart with their points, by parts.
pub fn load_of(chart: &Chart, (xy, p): ([DVec2; 3], [DVec3; 3]), limits: &Limits) -> LimitRatio {
    let load = leaning(chart, (xy, p, 0.0), of_places(chart, (xy, p, 0.0), limits), lean(chart, xy, p), limits);
    capped(chart, (xy, p), load, limits)
}

/// Points are up to `beside` off the surface.
fn of_places(chart: &Chart, (xy, p, beside): ([DVec2; 3], [DVec3; 3], f64), limits: &Limits) -> LimitRatio {
    let places = xy.map(|xy| DVec2::from(chart.uv(xy)));
    let chord = limits.chord.map_or(0.0, |limit| {
        let (first, second) = under(&|at| chart.tangents(at.into()), places);
        (triangle::chord(chart.evaluator(), first, second, p, limit - beside) + beside) / limit
    });
    LimitRatio { chord, angle: turned(chart, (xy, places), limits) }
}

/// How far the normals of the surface at three places turn, over the limit.
fn turned(chart: &Chart, (xy, places): ([DVec2; 3], [DVec2; 3]), limits: &Limits) -> f64 {
    limits.angle.map_or(0.0, |limit| {
        let tangents = |at: DVec2| chart.tangents(at.into());
        let columns = from_pole(&tangents, places);
        let normals =
            [0, 1, 2].map(|k| poles::normal(chart.surface(), &tangents, columns[k]).unwrap_or_else(|| chart.spot(xy[k]).normal()));
        let turn = |i: usize, j: usize| angle_between(normals[i], normals[j]);
        turn(0, 1).max(turn(1, 2)).max(turn(2, 0)) / limit
    })
}

/// The worse load of three places with their points, the chord error by samples: what the bounds say but for some hundredths, for a
/// twentieth of the work.
pub fn likely(chart: &Chart, (xy, p): ([DVec2; 3], [DVec3; 3]), limits: &Limits) -> f64 {
    let places = xy.map(|xy| DVec2::from(chart.uv(xy)));
    let chord = limits.chord.map_or(0.0, |limit| {
        let (first, second) = under(&|at| chart.tangents(at.into()), places);
        let off = |uv| triangle::sampled(&|uv: DVec2| chart.evaluator().point(uv.x, uv.y), uv, p);
        off(first).max(second.map_or(0.0, off)) / limit
    });
    chord.max(turned(chart, (xy, places), limits))
}

/// How far a border node is from the surface: glued edges run beside it.
fn off_surface(chart: &Chart, triangulation: &Triangulation, n: usize, limit: f64) -> f64 {
    gaps::distance(chart.surface(), triangulation.p[n], chart.uv(triangulation.xy[n]), limit * gaps::SLIGHT)
}
