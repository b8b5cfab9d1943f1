//! Trimmed faces as triangles fine enough for the picture.

use glam::DVec3;

use super::faces::{Bend, MAX_SAMPLES, MOST, Show, curvature, shown};
use super::scene::Sheet;
use crate::base::bbox::Box3;
use crate::base::job::Job;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::outline::Outline;
use crate::mesh::chart::parametric_surface::UniformSize;
use crate::mesh::tri::build::{NodePlacement, Task, triangulate};
use crate::mesh::tri::optimize::{FINEST, OptimizeSettings, SearchBudget};
use crate::surface::{Side, Surface};

/// Points of a border, for each of its sides.
const SIDE: usize = 48;

/// A face inside loops of sides.
pub(super) fn sheet(surface: &Surface, fine: f64, show: Show) -> Sheet {
    let mut places: Vec<(f64, f64)> = Vec::new();
    let mut outline = Outline::default();
    let mut side = 0;
    for n in surface.loops() {
        let first = places.len() as u32;
        for k in side..side + n {
            match (surface.side(k), surface.border_line(k)) {
                (Side::Chain { chain, from, to }, _) => {
                    let straight = chain.runs().len() == 1 && chain.runs()[0].curve.kind() == crate::geometry::Kind::Line;
                    let steps = if straight && surface.is_flat() { 1 } else { SIDE };
                    let at = |i: usize| from + (to - from) * i as f64 / steps as f64;
                    for f in (0..steps).map(at) {
                        places.push(surface.border_place(k, f).unwrap_or_default());
                        outline.p.push(chain.point(f));
                    }
                }
                (_, Some((a, b))) => {
                    for t in (0..SIDE).map(|i| i as f64 / SIDE as f64) {
                        let place = (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
                        places.push(place);
                        outline.p.push(surface.point(place.0, place.1));
                    }
                }
                _ => {}
            }
        }
        side += n;
        let last = places.len() as u32;
        outline.loops.extend((first..last).map(|i| [i, if i + 1 < last { i + 1 } else { first }]));
    }
    let (points, uv, triangles) = filled(surface, outline, &places, fine, show);
    let normals: Vec<DVec3> = uv.iter().map(|(u, v)| surface.normal(*u, *v)).collect();
    shown((points, normals, triangles), show, &mut |k| surface.jet(uv[k].0, uv[k].1))
}

/// Points, their places and triangles.
type Filled = (Vec<DVec3>, Vec<(f64, f64)>, Vec<[u32; 3]>);

/// Triangles inside an outline, small enough that they show the surface; none where its borders cross.
fn filled(surface: &Surface, mut outline: Outline, places: &[(f64, f64)], fine: f64, show: Show) -> Filled {
    let none = (outline.p.clone(), places.to_vec(), Vec::new());
    let Some(chart) = Chart::new(surface, places.iter().copied()) else { return none };
    outline.xy = places.iter().map(|uv| chart.xy(*uv)).collect();
    let bounds = Box3::of(outline.p.iter().copied());
    let bend = places.iter().map(|(u, v)| curvature(&surface.jet(*u, *v), surface.normal(*u, *v), Bend::Principal).abs());
    let within = inner_bends(surface, places);
    let bend = bend.chain(within).filter(|k| k.is_finite()).fold(0.0, f64::max);
    // A chord of a bend k over h is k·h²/8 away.
    let size = (8.0 * fine / bend).sqrt().clamp(bounds.diagonal() / MOST as f64, bounds.diagonal() / show.least() as f64);
    let flat = surface.is_flat();
    let field = UniformSize(if flat { 4.0 * bounds.diagonal() } else { size });
    let settings = OptimizeSettings {
        smoothing_rounds: 0,
        relaxation: 1.0,
        still_quality: FINEST,
        min_quality: 0.0,
        fair_quality: 1.0,
        max_length_ratio: f64::INFINITY,
        searches: SearchBudget::FEW,
    };
    let task = Task {
        interpolated: None,
        chart_surface: &chart,
        field: &field,
        outline: &outline,
        lattice: NodePlacement::Triangles,
        settings,
        most: MOST * MOST,
        limit_check: None,
        sliding: None,
    };
    match triangulate(&task, &Job::new()) {
        Ok(Ok(made)) => {
            let triangulation = made.triangulation;
            let uv = triangulation.xy.iter().map(|xy| chart.uv(*xy)).collect();
            (triangulation.p, uv, triangulation.tri)
        }
        _ => none,
    }
}

/// Curvatures on a grid over the places of a border.
fn inner_bends(surface: &Surface, places: &[(f64, f64)]) -> Vec<f64> {
    let range =
        |of: fn(&(f64, f64)) -> f64| places.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let (u, v) = (range(|p| p.0), range(|p| p.1));
    let at = |(low, high): (f64, f64), k: usize| low + (high - low) * (k as f64 + 0.5) / MAX_SAMPLES as f64;
    let places = (0..MAX_SAMPLES * MAX_SAMPLES).map(|k| (at(u, k % MAX_SAMPLES), at(v, k / MAX_SAMPLES)));
    places.map(|(u, v)| curvature(&surface.jet(u, v), surface.normal(u, v), Bend::Principal).abs()).collect()
}
