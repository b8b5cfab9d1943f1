//! A look over a finished surface: places without a normal and places where it folds over.

use glam::DVec3;

use crate::base::fault::Fault;
use crate::base::tolerance::{SINGULAR, Tolerance};
use crate::base::{job, math};
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::{Jet2, unit_normal};
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::SurfaceFault;

/// Samples a direction and cell, beside those at its ends: at most and at least, and how many there may be in all.
const SAMPLES: (usize, usize) = (9, 1);
const MOST: usize = 1 << 18;
/// Samples at the ends of a cell lie this share of it inside: a border that turns back folds its corner only.
const END: f64 = 1.0 / 1000.0;

/// W606 and W607, each at its worst place, from 11×11 samples inside every cell between network lines and kinks, fewer where
/// there are thousands of cells.
pub fn validate(surface: &Surface, tolerance: &Tolerance) -> Vec<Fault> {
    if !matches!(surface.domain(), Domain::Square | Domain::Triangle) {
        return Vec::new();
    }
    let (us, vs) = surface.cells();
    let cells = (us.len() + 1).saturating_mul(vs.len() + 1);
    let samples = (SAMPLES.1..=SAMPLES.0).rev().find(|n| cells.saturating_mul((n + 2) * (n + 2)) <= MOST).unwrap_or(SAMPLES.1);
    let (us, vs) = (inside(&us, samples, tolerance), inside(&vs, samples, tolerance));
    let triangle = surface.domain() == Domain::Triangle;
    let jets: Vec<Jet2> = if triangle {
        // The square (x, y) ↦ (x (1 − y), y) covers the triangle and its inside stays inside.
        vs.iter().flat_map(|&y| us.iter().map(move |&x| (x * (1.0 - y), y))).map(|(u, v)| surface.jet(u, v)).collect()
    } else {
        let leaning = |list: &[f64]| list.iter().map(|&x| (x, OneSided::After)).collect::<Vec<_>>();
        surface.jets(&leaning(&us), &leaning(&vs))
    };
    let place = |k: usize| {
        let (x, y) = (us[k % us.len()], vs[k / us.len()]);
        if triangle { (x * (1.0 - y), y) } else { (x, y) }
    };
    let normals: Vec<Option<DVec3>> = jets.iter().map(unit_normal).collect();
    let scale = jets.iter().map(|j| j.du.length()).fold(0.0, f64::max) * jets.iter().map(|j| j.dv.length()).fold(0.0, f64::max);
    let mut found = Vec::new();
    let singular = |k: usize| normals[k].is_none() || jets[k].du.cross(jets[k].dv).length() < SINGULAR * scale;
    let end = |k: usize| [0, samples + 1].contains(&(k % (samples + 2)));
    if let Some(k) = (0..jets.len()).find(|&k| !end(k % us.len()) && !end(k / us.len()) && singular(k)) {
        found.push(
            SurfaceFault::PatchSingular { surface: surface.origin(), uv: place(k), at: jets[k].p, made: surface.kind().construction() }
                .into(),
        );
    }
    // A fold turns the normal by more than a right angle between neighbours of one smooth piece, however near they come;
    // a sharp bend, the nose of an airfoil, does so only between samples that lie apart.
    let (kink_u, kink_v) = surface.kinks();
    let parted = |a: f64, b: f64, lines: &[f64]| lines.iter().any(|&x| a < x && x < b);
    let turn = |a: usize, b: usize| match (normals[a], normals[b]) {
        (Some(a), Some(b)) if a.dot(b) < 0.0 => Some(math::angle_between(a, b)),
        _ => None,
    };
    let mut worst: Option<(f64, usize)> = None;
    for k in 0..jets.len() {
        job::poll();
        let (i, j) = (k % us.len(), k / us.len());
        let right = (i + 1 < us.len() && !parted(us[i], us[i + 1], kink_u)).then_some(k + 1);
        let up = (j + 1 < vs.len() && !parted(vs[j], vs[j + 1], kink_v)).then_some(k + us.len());
        for other in [right, up].into_iter().flatten() {
            if let Some(angle) = turn(k, other)
                && worst.is_none_or(|(largest, _)| angle > largest)
                && folds_between(surface, place(k), place(other), tolerance)
            {
                worst = Some((angle, other));
            }
        }
    }
    if let Some((turn, k)) = worst {
        found.push(
            SurfaceFault::PatchFolded { surface: surface.origin(), uv: place(k), at: jets[k].p, turn, made: surface.kind().construction() }
                .into(),
        );
    }
    found
}

impl Surface {
    /// Where it folds over, with the turn of its normal there, or else where it has none, as the report finds them.
    pub fn fold(&self, tolerance: &Tolerance) -> Option<(DVec3, Option<f64>)> {
        let found = validate(self, tolerance);
        let place = |fault: &Fault| match fault.of()? {
            SurfaceFault::PatchFolded { at, turn, .. } => Some((*at, Some(*turn))),
            SurfaceFault::PatchSingular { at, .. } => Some((*at, None)),
            _ => None,
        };
        found.iter().rev().find_map(place)
    }
}

/// Whether the normal jumps over a right angle between two places: halved towards the jump until it is found or dissolves.
fn folds_between(surface: &Surface, mut a: (f64, f64), mut b: (f64, f64), tolerance: &Tolerance) -> bool {
    let normal = |at: (f64, f64)| unit_normal(&surface.jet(at.0, at.1));
    let (Some(mut from), Some(mut to)) = (normal(a), normal(b)) else { return false };
    while (b.0 - a.0).abs().max((b.1 - a.1).abs()) > tolerance.parameter {
        let middle = (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
        let Some(between) = normal(middle) else { return true };
        if from.dot(between) < 0.0 {
            (b, to) = (middle, between);
        } else if between.dot(to) < 0.0 {
            (a, from) = (middle, between);
        } else {
            return false;
        }
    }
    true
}

/// Sample parameters inside every cell, cells narrower than a point of the parameter left out.
fn inside(breaks: &[f64], samples: usize, tolerance: &Tolerance) -> Vec<f64> {
    let mut stops = vec![0.0];
    stops.extend_from_slice(breaks);
    stops.push(1.0);
    stops
        .windows(2)
        .filter(|w| w[1] - w[0] > tolerance.parameter)
        .flat_map(|w| {
            let inner = (0..samples).map(|k| (k as f64 + 0.5) / samples as f64);
            let shares = std::iter::once(END).chain(inner).chain(std::iter::once(1.0 - END));
            shares.map(|f| w[0] + (w[1] - w[0]) * f).collect::<Vec<_>>()
        })
        .collect()
}

impl Surface {
    /// Warnings found while building (singular or folded patches, oscillation), by sampling 9×9 a cell.
    pub fn validate(&self, tolerance: &Tolerance) -> Vec<Fault> {
        crate::surface::analysis::validate::validate(self, tolerance)
    }
}
