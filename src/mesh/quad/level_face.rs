//! A plane face as one in the plane z = 0: a mesh turns with its model, since rounding in space decides nothing between equal lengths.

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::tolerance::{PLANE_GRID, Tolerance};
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::outline::Outline;
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::request::sources::{Body, Source, Sources};
use crate::surface::core::plane;
use crate::surface::{Nearest, Surface};

/// At least so many times the rounding of coordinates, and at most this share of the tolerance.
const ROUNDINGS: f64 = 4096.0 * f64::EPSILON;
const TOLERANCE_SHARE: f64 = 1.0 / 16.0;

/// A plane face in the plane z = 0.
pub(crate) struct LevelFace<'a> {
    /// The face in space.
    surface: &'a Surface,
    /// Whether places of the plane are those of the chart of the face.
    is_chart: bool,
    origin: DVec3,
    /// Unit directions of x, y and z.
    axes: [DVec3; 3],
    pub(crate) chart: Chart,
    pub(crate) outline: Outline,
    /// What is refined about it.
    pub(crate) rules: Sources,
}

impl<'a> LevelFace<'a> {
    /// The face with its border and the sources that reach it; `None` where it is no plane, or where a box along the axes of the model
    /// is refined.
    pub(crate) fn of(surface: &'a Surface, chart: &Chart, outline: &Outline, rules: &Sources, tolerance: &Tolerance) -> Option<Self> {
        if !surface.is_in_plane() || rules.items().iter().any(|source| matches!(source.body, Body::Box(_))) {
            return None;
        }
        let plane = chart.plane();
        let (origin, axes) = match &plane {
            Some(spot) => (spot.p, [spot.dx, spot.dy, spot.dx.cross(spot.dy)]),
            None => {
                let middle = outline.xy.iter().sum::<DVec2>() / outline.xy.len() as f64;
                let (spot, [a, b]) = (chart.spot(middle), *outline.loops.first()?);
                let normal = spot.normal().try_normalize()?;
                let along = (outline.p[b as usize] - outline.p[a as usize]).reject_from_normalized(normal).try_normalize()?;
                (spot.p, [along, normal.cross(along), normal])
            }
        };
        let into = |p: DVec3| DVec3::from(axes.map(|axis| axis.dot(p - origin)));
        let placed = |k: usize| if plane.is_some() { outline.xy[k] } else { into(outline.p[k]).truncate() };
        let mut xy: Vec<DVec2> = (0..outline.p.len()).map(placed).collect();
        let (size, furthest) = (Box3::of(xy.iter().map(|xy| xy.extend(0.0))).diagonal(), Box3::of(outline.p.iter().copied()).furthest());
        let step = power_of_two((PLANE_GRID * size).max(ROUNDINGS * furthest).min(TOLERANCE_SHARE * tolerance.point))?;
        xy.iter_mut().for_each(|xy| *xy = (*xy / step).round() * step);
        let moved = |body: &Body| match body {
            Body::Point(p) => Body::Point(into(*p)),
            Body::Segment(a, b) => Body::Segment(into(*a), into(*b)),
            Body::Box(b) => Body::Box(*b),
        };
        let items = rules.items().iter().map(|source| Source { body: moved(&source.body), ..*source }).collect();
        let level = plane::level(surface.origin());
        let outline = Outline { p: xy.iter().map(|xy| xy.extend(0.0)).collect(), xy, ..outline.clone() };
        let chart = Chart::new(&level, [(0.0, 0.0)].into_iter())?;
        Some(Self { surface, is_chart: plane.is_some(), origin, axes, chart, outline, rules: Sources::new(items, rules.slope()) })
    }

    /// The point in space of a place.
    pub(crate) fn point(&self, p: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        self.origin + x * p.x + y * p.y + z * p.z
    }

    /// The surface parameters of places, with their points in space; `chart` is that of the face.
    pub(crate) fn uv(&self, chart: &Chart, xy: &[DVec2], p: &[DVec3]) -> Vec<(f64, f64)> {
        if self.is_chart {
            return xy.iter().map(|xy| chart.uv(*xy)).collect();
        }
        let nearest = Nearest::new(self.surface);
        p.iter().map(|p| nearest.at(*p).uv).collect()
    }
}

/// The largest power of two that is no larger.
fn power_of_two(x: f64) -> Option<f64> {
    const EXPONENT: u64 = 0x7ff << 52;
    let power = f64::from_bits(x.to_bits() & EXPONENT);
    (x.is_normal() && x > 0.0).then_some(power)
}
