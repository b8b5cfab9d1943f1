//! The area of the union of two outlines, by strips between the heights of their corners and crossings: exact for polygons.

use glam::{DVec2, DVec3};

/// Steps of an arc.
const STEPS: usize = 256;

/// A side with its lower end first.
type Side = [DVec2; 2];

fn sides(corners: &[DVec2]) -> impl Iterator<Item = Side> + '_ {
    corners.iter().enumerate().map(|(k, a)| [*a, corners[(k + 1) % corners.len()]]).map(|[a, b]| if a.y <= b.y { [a, b] } else { [b, a] })
}

fn x_at([a, b]: Side, y: f64) -> f64 {
    a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)
}

fn spans(corners: &[DVec2], y: f64) -> Vec<[f64; 2]> {
    let mut x: Vec<f64> = sides(corners).filter(|s| s[0].y < y && y < s[1].y).map(|s| x_at(s, y)).collect();
    x.sort_by(f64::total_cmp);
    x.chunks_exact(2).map(|c| [c[0], c[1]]).collect()
}

fn crossing(a: Side, b: Side) -> Option<f64> {
    let (d, e, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let det = d.perp_dot(e);
    let (s, t) = (w.perp_dot(e) / det, w.perp_dot(d) / det);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then(|| a[0].y + s * d.y)
}

/// The areas of the union and of the common region.
pub fn union_and_common(a: &[DVec2], b: &[DVec2]) -> (f64, f64) {
    let mut heights: Vec<f64> = a.iter().chain(b).map(|p| p.y).collect();
    let other: Vec<Side> = sides(b).collect();
    heights.extend(sides(a).flat_map(|s| other.iter().filter_map(move |o| crossing(s, *o))));
    heights.sort_by(f64::total_cmp);
    let (mut union, mut common) = (0.0, 0.0);
    for pair in heights.windows(2).filter(|h| h[1] > h[0]) {
        let y = 0.5 * (pair[0] + pair[1]);
        let (p, q) = (spans(a, y), spans(b, y));
        let width = |spans: &[[f64; 2]]| spans.iter().map(|s| s[1] - s[0]).sum::<f64>();
        let both: f64 = p.iter().flat_map(|s| q.iter().map(|t| (s[1].min(t[1]) - s[0].max(t[0])).max(0.0))).sum();
        common += both * (pair[1] - pair[0]);
        union += (width(&p) + width(&q) - both) * (pair[1] - pair[0]);
    }
    (union, common)
}

pub fn area(corners: &[DVec2]) -> f64 {
    0.5 * (0..corners.len()).map(|k| corners[k].perp_dot(corners[(k + 1) % corners.len()])).sum::<f64>().abs()
}

/// Whether no two sides meet but neighbours in their corner, and no corner is sharp or flat.
pub fn is_sound(corners: &[DVec2]) -> bool {
    let all: Vec<Side> = sides(corners).collect();
    let n = all.len();
    let apart = (0..n).all(|i| (i + 2..n).all(|j| (i, j) == (0, n - 1) || crossing(all[i], all[j]).is_none()));
    let open = (0..n).all(|k| {
        let (a, b) = (corners[(k + n - 1) % n] - corners[k], corners[(k + 1) % n] - corners[k]);
        (0.2..3.0).contains(&a.angle_to(b).abs())
    });
    apart && open
}

/// An outline with arcs at its corners; `None` where two do not fit on a side.
pub fn rounded(corners: &[DVec2], radius: f64) -> Option<Vec<DVec2>> {
    let n = corners.len();
    let ways = |k: usize| [corners[(k + n - 1) % n] - corners[k], corners[(k + 1) % n] - corners[k]].map(DVec2::normalize);
    let angle = |k: usize| ways(k)[0].angle_to(ways(k)[1]).abs();
    let cut = |k: usize| radius / (0.5 * angle(k)).tan();
    if (0..n).any(|k| cut(k) + cut((k + 1) % n) > 0.95 * corners[k].distance(corners[(k + 1) % n])) {
        return None;
    }
    let mut all = Vec::new();
    for (k, corner) in corners.iter().enumerate() {
        let [a, b] = ways(k);
        let center = corner + (a + b).normalize() * radius / (0.5 * angle(k)).sin();
        let (from, to) = (corner + a * cut(k) - center, corner + b * cut(k) - center);
        let step = from.angle_to(to) / STEPS as f64;
        // Chords on both sides of the arc, which have its area.
        let out = (step / step.sin()).sqrt();
        all.extend((0..=STEPS).map(|i| {
            let end = i == 0 || i == STEPS;
            center + DVec2::from_angle(step * i as f64).rotate(from) * if end { 1.0 } else { out }
        }));
    }
    Some(all)
}

pub fn circle(center: DVec2, radius: f64) -> Vec<DVec2> {
    let n = 4 * STEPS;
    let step = std::f64::consts::TAU / n as f64;
    (0..n).map(|i| center + DVec2::from_angle(step * i as f64) * radius * (step / step.sin()).sqrt()).collect()
}

/// Corners in z = 0.
pub fn in_space(corners: &[DVec2]) -> Vec<DVec3> {
    corners.iter().map(|p| p.extend(0.0)).collect()
}
