//! Borders in a chart.

use glam::DVec2;

/// The segments of a closed polygon.
pub fn closed(points: &[DVec2]) -> Vec<[DVec2; 2]> {
    (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]]).collect()
}
