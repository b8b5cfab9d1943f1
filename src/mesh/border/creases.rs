//! Kink lines inside trimmed faces, cut at the loops: lines that triangles have to hold, as those between patches are.

use glam::DVec2;

use crate::base::math::angle_between;
use crate::base::solve::turn;
use crate::mesh::border::inside::surround;
use crate::mesh::request::input::Input;
use crate::model::segments::Part;
use crate::model::{PatchId, Trace, Track};
use crate::surface::{Domain, OneSided, Side, Surface};

/// A line that folds by less, radians (3°), is no crease that has to be seen.
const MIN_FOLD: f64 = 0.052;
/// Places along a line at which its fold is sampled.
const MAX_SAMPLES: usize = 16;
/// Samples of a border between which it crosses a kink line once at most.
const SAMPLES: usize = 128;
/// Tracks of lower rank give the geometry of what several share: all others come first.
const RANK: u8 = u8::MAX;

/// The kink lines inside a trimmed patch as tracks; none for others, which are cut at theirs.
pub fn of_patch(input: &Input, patch: PatchId) -> Vec<Part> {
    let surface = &input.model.surfaces[input.model.patches[patch.index()].surface.index()].surface;
    let (us, vs) = surface.kinks();
    if surface.domain() != Domain::Loop || surface.is_flat() || us.is_empty() && vs.is_empty() {
        return Vec::new();
    }
    let borders: Vec<Box<dyn Fn(f64) -> DVec2 + '_>> = (0..surface.n_sides()).filter_map(|k| border(surface, k)).collect();
    let outlines = surface.outlines();
    let limited = input.plan.settings.chord_error.is_some();
    let mut parts = Vec::new();
    for (axis, lines, others) in [(0, us, vs), (1, vs, us)] {
        for at in lines.iter().flat_map(|x| surface.copies_along(axis, *x)) {
            let mut ends: Vec<f64> = borders.iter().flat_map(|border| crossings(border, axis, at)).collect();
            ends.sort_by(f64::total_cmp);
            for w in ends.windows(2) {
                let place = |other: f64| if axis == 0 { DVec2::new(at, other) } else { DVec2::new(other, at) };
                let middle = place(0.5 * (w[0] + w[1]));
                if !surround(&outlines, middle) {
                    continue;
                }
                // Nets of other programs have knots at which directions jump by a hair: held only for a limit on bends.
                if !limited
                    && (0..=MAX_SAMPLES)
                        .all(|k| fold(surface, axis, place(w[0] + (w[1] - w[0]) * k as f64 / MAX_SAMPLES as f64)) < MIN_FOLD)
                {
                    continue;
                }
                let trace = Trace::new(surface, place(w[0]).into(), place(w[1]).into());
                if trace.length() <= 2.0 * input.tolerance.point {
                    continue;
                }
                let inner = others.iter().flat_map(|x| surface.copies_along(1 - axis, *x)).filter(|x| *x > w[0] && *x < w[1]);
                let cuts = inner.map(|x| trace.length_at((x - w[0]) / (w[1] - w[0]))).collect();
                parts.push(Part { track: Track::Iso(trace), cuts, rank: RANK, near: input.tolerance.point });
            }
        }
    }
    parts
}

/// Angle between the normals on both sides of a line, radians.
fn fold(surface: &Surface, axis: usize, at: DVec2) -> f64 {
    let normal = |side: OneSided| {
        let lean = if axis == 0 { (side, OneSided::After) } else { (OneSided::After, side) };
        let jet = surface.jet_one_sided(at.x, at.y, lean);
        jet.du.cross(jet.dv)
    };
    angle_between(normal(OneSided::Before), normal(OneSided::After))
}

/// Places along a border in the direction of its loop, by a fraction.
fn border(surface: &Surface, k: usize) -> Option<Box<dyn Fn(f64) -> DVec2 + '_>> {
    if let Some((a, b)) = surface.border_line(k) {
        return Some(Box::new(move |t| DVec2::from(a).lerp(DVec2::from(b), t)));
    }
    let Side::Chain { from, to, .. } = surface.side(k) else { return None };
    Some(Box::new(move |t| surface.border_place(k, from + (to - from) * t).unwrap_or_default().into()))
}

/// The other parameter where a border crosses a line on which one parameter (0: u) stays.
fn crossings(border: &dyn Fn(f64) -> DVec2, axis: usize, at: f64) -> Vec<f64> {
    let below = |t: f64| border(t)[axis] < at;
    let fraction = |k: usize| k as f64 / SAMPLES as f64;
    let mut found = Vec::new();
    let mut before = below(0.0);
    for k in 1..=SAMPLES {
        let now = below(fraction(k));
        if now != before {
            let at = turn(fraction(k - 1), fraction(k), before, |t| Some(below(t)));
            found.extend(at.map(|t| border(t)[1 - axis]));
        }
        before = now;
    }
    found
}
