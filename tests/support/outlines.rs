//! Outlines in the plane of a chart, and surfaces over it, that several tests triangulate.

use glam::{DVec2, DVec3};
use lofting::base::math::{cos, sin, sin_cos};
use lofting::base::triangulate_points::NO_TRIANGLE;
use lofting::mesh::chart::outline::Outline;
use lofting::mesh::chart::parametric_surface::{ParametricSurface, Spot};
use lofting::mesh::tri::optimize::{FINEST, OptimizeSettings, SearchBudget};
use lofting::mesh::tri::triangulation::Triangulation;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

/// z = h sin x cos y.
pub struct Waves(pub f64);

impl ParametricSurface for Waves {
    fn spot(&self, xy: DVec2) -> Spot {
        let ((sx, cx), (sy, cy)) = (sin_cos(xy.x), sin_cos(xy.y));
        let h = self.0;
        Spot { p: xy.extend(h * sx * cy), dx: DVec3::new(1.0, 0.0, h * cx * cy), dy: DVec3::new(0.0, 1.0, -h * sx * sy) }
    }

    fn clamp(&self, xy: DVec2) -> DVec2 {
        xy
    }
}

/// How triangles are improved.
pub const CARE: OptimizeSettings = OptimizeSettings {
    smoothing_rounds: 20,
    relaxation: 1.0,
    still_quality: FINEST,
    min_quality: 0.9,
    fair_quality: 1.0,
    max_length_ratio: 1.25,
    searches: SearchBudget::FEW,
};

/// Adds a polygon with steps of about a size.
pub fn add_loop(outline: &mut Outline, chart_surface: &dyn ParametricSurface, corners: &[DVec2], size: f64) {
    let first = outline.xy.len() as u32;
    for k in 0..corners.len() {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        let n = (a.distance(b) / size).ceil().max(1.0) as usize;
        for i in 0..n {
            let xy = a.lerp(b, i as f64 / n as f64);
            outline.xy.push(xy);
            outline.p.push(chart_surface.spot(xy).p);
        }
    }
    let last = outline.xy.len() as u32;
    outline.loops.extend((first..last).map(|i| [i, if i + 1 < last { i + 1 } else { first }]));
}

/// A star-shaped polygon: radii at even angles.
pub fn star(center: DVec2, radii: &[f64], turn: f64) -> Vec<DVec2> {
    let angle = |k: usize| turn + std::f64::consts::TAU * k as f64 / radii.len() as f64;
    radii.iter().enumerate().map(|(k, r)| center + DVec2::new(cos(angle(k)), sin(angle(k))) * *r).collect()
}

/// Everything that must hold of a finished face with so many holes that lie apart.
pub fn sound(triangulation: &Triangulation, outline: &Outline, holes: Option<usize>) -> TestCaseResult {
    triangulation.check().map_err(TestCaseError::fail)?;
    prop_assert!(!triangulation.tri.is_empty());
    let open = triangulation.across.iter().flatten().filter(|t| **t == NO_TRIANGLE).count();
    prop_assert_eq!(open, outline.loops.len(), "free edges are those of the loops");
    let mut used = vec![false; triangulation.p.len()];
    triangulation.tri.iter().flatten().for_each(|n| used[*n as usize] = true);
    prop_assert!(used.iter().all(|u| *u), "a node without triangles");
    let edges = (3 * triangulation.tri.len() + open) / 2;
    let euler = triangulation.p.len() as i64 - edges as i64 + triangulation.tri.len() as i64;
    if let Some(holes) = holes {
        prop_assert_eq!(euler, 1 - holes as i64);
    }
    for (k, p) in outline.p.iter().enumerate() {
        prop_assert_eq!(triangulation.p[k], *p, "border nodes stay");
    }
    Ok(())
}
