//! Nodes round holes of plane faces that slide along their curves for better triangles: how far, and when they do not.

use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use lofting::mesh::Mesh;
use lofting::session::disk::{Disk, Outputs};

use crate::support::script;

/// Holes of the plate: centres and radii, mm.
fn hole(k: usize) -> ([f64; 2], f64) {
    let k = k as f64;
    ([13.0 + 12.0 * k, 12.0 + 3.5 * k], 4.0 + 0.5 * k)
}

/// A plate of 60 × 40 with four holes that are 3 mm apart; `more` stands before its mesh.
fn plate(more: &str, settings: &str) -> Arc<Mesh> {
    let text = format!(
        "units mm
curve rim = polyline([(0, 0), (60, 0), (60, 40), (0, 40)], closed: true)
curve hole for k in 0..4 = circle(center: (13 + 12 * k, 12 + 3.5 * k, 0), radius: 4mm + 0.5mm * k)
surface plate = trim(plane(rim), holes: hole)
{more}
mesh m of plate {{
  size: 3.8mm
{settings}
}}
"
    );
    let disk = Disk::new(None, Some(Path::new(env!("CARGO_TARGET_TMPDIR"))), &[], Outputs::Counted).unwrap();
    let outcome = script::outcome("plate.loft", text.as_bytes(), &[], &disk);
    assert!(outcome.report.ok, "{}", outcome.drawn(false, false));
    outcome.meshes.into_iter().next().unwrap().1
}

/// Angles of the steps round a hole from the start of its circle on, over their mean.
fn steps(mesh: &Mesh, k: usize) -> Vec<f64> {
    let ([x, y], radius) = hole(k);
    let off = |p: &DVec3| (p.x - x, p.y - y);
    let on = mesh.nodes.iter().map(off).filter(|(x, y)| (x.hypot(*y) - radius).abs() < 1e-9);
    let mut angles: Vec<f64> = on.map(|(x, y)| y.atan2(x).rem_euclid(TAU)).collect();
    angles.sort_by(f64::total_cmp);
    angles.push(angles[0] + TAU);
    let mean = TAU / (angles.len() - 1) as f64;
    angles.windows(2).map(|w| (w[1] - w[0]) / mean).collect()
}

fn is_even(steps: &[f64]) -> bool {
    steps.iter().all(|step| (step - 1.0).abs() < 1e-9)
}

/// The largest ratio of steps beside each other.
fn growth(steps: &[f64]) -> f64 {
    (0..steps.len()).map(|k| steps[k] / steps[(k + 1) % steps.len()]).fold(1.0, |most: f64, ratio| most.max(ratio).max(1.0 / ratio))
}

/// Walls that are not meshed: another mesh may need the nodes of the holes where they are.
const WALLS: &str = "surface wall for k in 0..4 = extrude(hole[k], by: (0, 0, 5mm))";

#[test]
fn steps_round_holes_change_by_a_fifth_at_most_and_those_of_the_rim_do_not() {
    let (mesh, held) = (plate("", ""), plate(WALLS, ""));
    let mut slid = false;
    for k in 0..4 {
        let (now, before) = (steps(&mesh, k), steps(&held, k));
        assert_eq!(now.len(), before.len());
        assert!(
            now.iter().zip(&before).all(|(now, before)| (0.8 - 1e-9..=1.2 + 1e-9).contains(&(now / before))),
            "hole {k}: {now:?} {before:?}"
        );
        assert!(growth(&now) <= growth(&before).max(1.3) + 1e-9, "hole {k}: {now:?}");
        slid |= now.iter().zip(&before).any(|(now, before)| (now / before - 1.0).abs() > 0.01);
    }
    assert!(slid);
    for (length, along, on) in [(60.0, 0, 1), (40.0, 1, 0)] {
        let mut at: Vec<f64> = mesh.nodes.iter().filter(|p| p.to_array()[on] == 0.0).map(|p| p.to_array()[along]).collect();
        at.sort_by(f64::total_cmp);
        let step = length / (at.len() - 1) as f64;
        assert!(at.windows(2).all(|w| (w[1] - w[0] - step).abs() < 1e-9), "{at:?}");
    }
    let quality = |mesh: &Mesh| mesh.quality().unwrap();
    assert!(quality(&mesh).min_quality > quality(&held).min_quality + 0.02);
    assert!(quality(&mesh).min_angle > quality(&held).min_angle);
    assert!((0..4).all(|k| is_even(&steps(&plate("", "  on hole { bias: 1 }"), k))));
}

#[test]
fn written_steps_stay() {
    let counted = plate("", "  on hole { count: 10 }");
    assert!((0..4).all(|k| is_even(&steps(&counted, k))));
}

#[test]
fn limits_of_the_border_are_kept() {
    for limit in [0.05, 0.15, 0.3] {
        let mesh = plate("", &format!("  chord_error: {limit}mm"));
        for k in 0..4 {
            let (_, radius) = hole(k);
            let steps = steps(&mesh, k);
            let mean = TAU / steps.len() as f64;
            let off = steps.iter().map(|step| radius * (1.0 - (0.5 * step * mean).cos())).fold(0.0, f64::max);
            assert!(off <= limit * (1.0 + 1e-6), "hole {k}: {off} for {limit}");
        }
    }
}
