//! Bounds of the triangles of a free face over the limits of their mesh.

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

/// Number of triangles that one thread bounds at a time.
const BATCH_SIZE: usize = 1024;

/// Bounds of a triangle over its limits: a limit is kept up to 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct LimitRatios {
    /// Bound of the chord error over the limit.
    pub chord: f64,
    /// Turn of the normal over the limit.
    pub angle: f64,
    /// The triangle stands on edge and the surface may be too far beyond it: by how much does not tell how much smaller it has to be.
    pub on_edge: bool,
}

impl LimitRatios {
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
    seen: Vec<([DVec2; 3], LimitRatios)>,
}

impl LimitTable {
    /// The ratios of a triangle after [`LimitTable::update`].
    pub fn of(&self, t: u32) -> LimitRatios {
        self.seen[t as usize].1
    }

    /// Finds those of some triangles that are new or have changed.
    pub fn update(&mut self, chart: &Chart, triangulation: &Triangulation, some: &[u32], limits: &Limits) {
        self.seen.resize(triangulation.tri.len(), ([DVec2::INFINITY; 3], LimitRatios::default()));
        let corners = |t: u32| triangulation.tri[t as usize].map(|n| triangulation.xy[n as usize]);
        let stale: Vec<u32> = some.iter().copied().filter(|t| corners(*t) != self.seen[*t as usize].0).collect();
        let batches = par::map(stale.len().div_ceil(BATCH_SIZE), |batch| {
            let some = &stale[batch * BATCH_SIZE..stale.len().min((batch + 1) * BATCH_SIZE)];
            some.iter().map(|t| ratio_with_sides(chart, triangulation, *t, limits)).collect::<Vec<_>>()
        });
        for (t, ratio) in stale.iter().zip(batches.into_iter().flatten()) {
            self.seen[*t as usize] = (corners(*t), ratio);
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
        let own = nodes.map(|n| {
            let (xy, known) = (triangulation.xy[n as usize], &mut seen[n as usize]);
            if known.0 != xy {
                *known = (xy, normal_at(chart, xy));
            }
            known.1
        });
        on_own_side(chart, nodes.map(|n| triangulation.xy[n as usize]), own)
    }
}

/// Three places of a chart with their points.
#[derive(Clone, Copy)]
pub struct ChartTriangle {
    /// Places.
    pub xy: [DVec2; 3],
    /// Points, model units.
    pub p: [DVec3; 3],
}

impl ChartTriangle {
    fn of(triangulation: &Triangulation, corners: [u32; 3]) -> Self {
        let c = corners.map(|n| n as usize);
        Self { xy: c.map(|n| triangulation.xy[n]), p: c.map(|n| triangulation.p[n]) }
    }
}

/// The ratios of three nodes as a triangle that may be long.
pub fn ratio_of_long(chart: &Chart, triangulation: &Triangulation, corners: [u32; 3], limits: &Limits, normals: &Normals) -> LimitRatios {
    let cosine = tilt_of(normals.of_all(chart, triangulation, corners), corners.map(|n| triangulation.p[n as usize]));
    ratio_of_tilted(chart, triangulation, corners, limits, cosine)
}

/// The worse ratio, infinite where the triangle lies upside down at one of its corners.
pub fn ratio_of_upright(chart: &Chart, triangulation: &Triangulation, corners: [u32; 3], limits: &Limits, normals: &Normals) -> f64 {
    let cosine = tilt_of(normals.of_all(chart, triangulation, corners), corners.map(|n| triangulation.p[n as usize]));
    if cosine < 0.0 { f64::INFINITY } else { ratio_of_tilted(chart, triangulation, corners, limits, cosine).worst() }
}

fn ratio_of_tilted(chart: &Chart, triangulation: &Triangulation, corners: [u32; 3], limits: &Limits, cosine: f64) -> LimitRatios {
    let triangle = ChartTriangle::of(triangulation, corners);
    // Most triangles that are tried are far too large: some points tell.
    let seen = limits.chord.map_or(0.0, |limit| sampled_chord(chart, triangle) / limit);
    if seen > 1.0 {
        return LimitRatios { chord: seen / cosine.max(MIN_TILT_COSINE), ..LimitRatios::default() };
    }
    let gap = border_gap(chart, triangulation, corners.map(|n| n as usize), limits);
    let ratio = tilted(chart, triangle, gap, of_places(chart, triangle, gap, limits), cosine, limits);
    let fixed = corners.iter().any(|n| *n < triangulation.fixed);
    if fixed { ratio } else { capped(chart, triangle, ratio, limits) }
}

/// The ratios with the chord error bounded by the extent of the surface over the triangle: at a tip, where the bends are unbounded, the only
/// bound.
fn capped(chart: &Chart, triangle: ChartTriangle, ratio: LimitRatios, limits: &Limits) -> LimitRatios {
    let ChartTriangle { xy, p } = triangle;
    let Some(limit) = limits.chord.filter(|_| ratio.chord > 1.0) else { return ratio };
    // The surface reaches at least from corner to corner.
    if ratio.chord.is_finite() && (0..3).any(|k| p[k].distance(p[(k + 1) % 3]) > limit) {
        return ratio;
    }
    let at = xy.map(|xy| DVec2::from(chart.uv(xy)));
    let (low, high) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
    if !(low.cmpge(DVec2::ZERO).all() && high.cmple(DVec2::ONE).all()) {
        return ratio;
    }
    let enclosure = chart.surface().enclosure((low.x, high.x), (low.y, high.y));
    let reach = enclosure.du.reach() * (high.x - low.x) + enclosure.dv.reach() * (high.y - low.y);
    if reach.is_finite() { LimitRatios { chord: ratio.chord.min(reach / limit), ..ratio } } else { ratio }
}

/// Least cosine between a triangle and its surface for the bound by its plane.
const MIN_TILT_COSINE: f64 = 0.5;

/// Largest distance of the surface from a triangle that lies upside down at a corner, over the chord error.
const MAX_INVERTED_RATIO: f64 = 0.25;

/// The normal of the surface at a place; none at a pole, where rounding alone has one.
fn normal_at(chart: &Chart, xy: DVec2) -> DVec3 {
    if poles::is_pole(&|at| chart.tangents(at.into()), DVec2::from(chart.uv(xy))) { DVec3::ZERO } else { chart.spot(xy).normal() }
}

/// The least cosine of the angles between a triangle and its surface at the corners. Three places on one bent line are a
/// triangle perpendicular to the surface: the surface is near it along its own normal, while its sides are far from the surface.
fn tilt(chart: &Chart, triangle: ChartTriangle) -> f64 {
    tilt_of(on_own_side(chart, triangle.xy, triangle.xy.map(|xy| normal_at(chart, xy))), triangle.p)
}

/// The normals at the corners of a triangle with those of corners on a crease taken on the triangle's side of it: by the other side's the
/// triangle would lie upside down beside a sharp crease. A corner in a pole has none.
fn on_own_side(chart: &Chart, xy: [DVec2; 3], mut own: [DVec3; 3]) -> [DVec3; 3] {
    let surface = chart.surface();
    let (us, vs) = surface.kinks();
    if us.is_empty() && vs.is_empty() && surface.closed() == (false, false) {
        return own;
    }
    let places = xy.map(|xy| DVec2::from(chart.uv(xy)));
    let middle = (places[0] + places[1] + places[2]) / 3.0;
    for (normal, place) in own.iter_mut().zip(places) {
        if *normal != DVec3::ZERO
            && let Some(beside) = surface.normal_on_crease(place, middle)
        {
            *normal = beside;
        }
    }
    own
}

/// The same by the normals of the surface at the corners.
fn tilt_of(own: [DVec3; 3], p: [DVec3; 3]) -> f64 {
    // Two corners in a pole, or three on a line, have no normal but by rounding.
    let square = p[0].distance_squared(p[1]).max(p[1].distance_squared(p[2])).max(p[2].distance_squared(p[0]));
    let up = (p[1] - p[0]).cross(p[2] - p[0]);
    let normal = if up.length() > PARALLEL * square { up.normalize_or_zero() } else { DVec3::ZERO };
    let cosine = |own: DVec3| if own == DVec3::ZERO || normal == DVec3::ZERO { 1.0 } else { own.dot(normal) };
    own.into_iter().map(cosine).fold(1.0, f64::min)
}

/// The ratios of a triangle that is tilted against its surface by the angle of a `cosine`: its sides may be farther from the surface by the
/// inverse of the cosine. Where that alone exceeds the limit the sides themselves are measured. Where the triangle is
/// nearly perpendicular to the surface, the bound is the distance of the surface in any direction from the places between the corners; upside
/// down that has to be a part of the limit, since the surface itself turns round within it.
fn tilted(chart: &Chart, triangle: ChartTriangle, gap: f64, ratio: LimitRatios, cosine: f64, limits: &Limits) -> LimitRatios {
    let ChartTriangle { xy, p } = triangle;
    let chord = match limits.chord {
        Some(limit) if ratio.chord > 0.0 && cosine < MIN_TILT_COSINE => {
            let (first, second) = under(&|at| chart.tangents(at.into()), xy.map(|xy| DVec2::from(chart.uv(xy))));
            let off = |uv| triangle::in_any_direction(chart.surface(), uv);
            let off = (off(first).max(second.map_or(0.0, off)) + gap) / limit;
            if cosine < 0.0 && off > MAX_INVERTED_RATIO { f64::INFINITY } else { off }
        }
        Some(limit) if ratio.chord > cosine && ratio.chord <= 1.0 => {
            let ends = poles::sides(&|at| chart.tangents(at.into()), xy.map(|xy| DVec2::from(chart.uv(xy)))).map(Some);
            let farthest = sides::distance(chart.evaluator(), ends, p, limit - gap);
            ratio.chord.max((farthest + gap) / limit).min(ratio.chord / cosine)
        }
        _ => ratio.chord / cosine.max(MIN_TILT_COSINE),
    };
    LimitRatios { chord, ..ratio }
}

/// The ratios of three nodes as a triangle; `first` is where the first of them is to go.
pub fn ratio(
    chart: &Chart,
    triangulation: &Triangulation,
    corners: [u32; 3],
    first: Option<(DVec2, DVec3)>,
    limits: &Limits,
) -> LimitRatios {
    let c = corners.map(|n| n as usize);
    let at = |k: usize| first.filter(|_| k == 0).unwrap_or_else(|| (triangulation.xy[c[k]], triangulation.p[c[k]]));
    let at = [at(0), at(1), at(2)];
    let triangle = ChartTriangle { xy: at.map(|at| at.0), p: at.map(|at| at.1) };
    of_places(chart, triangle, border_gap(chart, triangulation, c, limits), limits)
}

/// The largest distance of the border nodes among some from the surface.
fn border_gap(chart: &Chart, triangulation: &Triangulation, nodes: [usize; 3], limits: &Limits) -> f64 {
    let Some(limit) = limits.chord else { return 0.0 };
    nodes.into_iter().filter(|n| *n < triangulation.fixed as usize).map(|n| off_surface(chart, triangulation, n, limit)).fold(0.0, f64::max)
}

/// The ratios of a triangle with those of its sides where it is tilted so far that they may exceed the limit though its plane keeps it: a
/// height over the plane is longer along the normal of the surface by the inverse of the cosine between the two.
fn ratio_with_sides(chart: &Chart, triangulation: &Triangulation, t: u32, limits: &Limits) -> LimitRatios {
    let corners = triangulation.tri[t as usize];
    let found = ratio(chart, triangulation, corners, None, limits);
    let Some(limit) = limits.chord.filter(|_| found.chord > 0.0 && found.chord <= 1.0) else { return found };
    let triangle = ChartTriangle::of(triangulation, corners);
    let cosine = tilt(chart, triangle);
    if found.chord <= cosine {
        return found;
    }
    let ChartTriangle { xy, p } = triangle;
    if cosine < MIN_TILT_COSINE {
        let (first, second) = under(&|at| chart.tangents(at.into()), xy.map(|xy| DVec2::from(chart.uv(xy))));
        let off = |uv| triangle::beyond(chart.evaluator(), uv, p, limit);
        let beyond = off(first).max(second.map_or(0.0, off)) / limit;
        if beyond > 1.0 {
            return LimitRatios { chord: beyond, on_edge: true, ..found };
        }
    }
    let mut ends = poles::sides(&|at| chart.tangents(at.into()), xy.map(|xy| DVec2::from(chart.uv(xy)))).map(Some);
    // Borders keep the limit by themselves.
    let locked = triangulation.locked.get(t as usize).map_or(0, |bits| *bits);
    (0..3).filter(|k| locked >> k & 1 == 1).for_each(|k| ends[k] = None);
    let farthest = sides::distance(chart.evaluator(), ends, p, limit);
    LimitRatios { chord: found.chord.max(farthest / limit), ..found }
}

/// The ratios of three places of the chart with their points.
pub fn ratio_of(chart: &Chart, triangle: ChartTriangle, limits: &Limits) -> LimitRatios {
    let ratio = tilted(chart, triangle, 0.0, of_places(chart, triangle, 0.0, limits), tilt(chart, triangle), limits);
    capped(chart, triangle, ratio, limits)
}

/// The ratios by the plane of the triangle; its points are up to `gap` off the surface.
fn of_places(chart: &Chart, triangle: ChartTriangle, gap: f64, limits: &Limits) -> LimitRatios {
    let ChartTriangle { xy, p } = triangle;
    let places = xy.map(|xy| DVec2::from(chart.uv(xy)));
    let chord = limits.chord.map_or(0.0, |limit| {
        let (first, second) = under(&|at| chart.tangents(at.into()), places);
        (triangle::chord(chart.evaluator(), first, second, p, limit - gap) + gap) / limit
    });
    LimitRatios { chord, angle: turn_ratio(chart, xy, places, limits), on_edge: false }
}

/// The turn of the normals of the surface between three places, in the chart and in (u, v), over the limit.
fn turn_ratio(chart: &Chart, xy: [DVec2; 3], places: [DVec2; 3], limits: &Limits) -> f64 {
    limits.angle.map_or(0.0, |limit| {
        let tangents = |at: DVec2| chart.tangents(at.into());
        let columns = from_pole(&tangents, places);
        let middle = (places[0] + places[1] + places[2]) / 3.0;
        let normal = |k: usize| {
            let on_crease = || chart.surface().normal_on_crease(places[k], middle);
            poles::normal(chart.surface(), &tangents, columns[k]).or_else(on_crease).unwrap_or_else(|| chart.spot(xy[k]).normal())
        };
        let normals = [0, 1, 2].map(normal);
        let turn = |i: usize, j: usize| angle_between(normals[i], normals[j]);
        turn(0, 1).max(turn(1, 2)).max(turn(2, 0)) / limit
    })
}

/// The worse ratio of three places with their points, the chord error by samples: within some hundredths of the bound, for a
/// twentieth of the work.
pub fn sampled_ratio(chart: &Chart, triangle: ChartTriangle, limits: &Limits) -> f64 {
    let places = triangle.xy.map(|xy| DVec2::from(chart.uv(xy)));
    let chord = limits.chord.map_or(0.0, |limit| sampled_chord(chart, triangle) / limit);
    chord.max(turn_ratio(chart, triangle.xy, places, limits))
}

/// How far the surface is from the plane of three places with their points, by samples.
fn sampled_chord(chart: &Chart, ChartTriangle { xy, p }: ChartTriangle) -> f64 {
    let (first, second) = under(&|at| chart.tangents(at.into()), xy.map(|xy| DVec2::from(chart.uv(xy))));
    let off = |uv| triangle::sampled(&|uv: DVec2| chart.evaluator().point(uv.x, uv.y), uv, p);
    off(first).max(second.map_or(0.0, off))
}

/// How far a border node is from the surface: glued edges run beside it.
fn off_surface(chart: &Chart, triangulation: &Triangulation, n: usize, limit: f64) -> f64 {
    gaps::distance(chart.surface(), triangulation.p[n], chart.uv(triangulation.xy[n]), limit * gaps::SLIGHT)
}
