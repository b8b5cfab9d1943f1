//! Kink lines and sharp folds inside faces, cut at the loops: lines that triangles have to hold, as those between patches are.

use glam::DVec2;

use crate::base::math::angle_between;
use crate::base::solve::turn;
use crate::mesh::border::folds;
use crate::mesh::border::inside::surround;
use crate::mesh::request::input::Input;
use crate::model::segments::Part;
use crate::model::{PatchId, Trace, Track};
use crate::surface::{Domain, OneSided, Side, Surface};

/// A line that folds by less, radians (3°), is no crease that has to be seen.
const MIN_FOLD: f64 = 0.052;
/// Turn of a loop from which on it has a corner, radians (10°).
const MIN_CORNER: f64 = 0.175;
/// The sides of a surface that is not trimmed.
const SQUARE: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
/// Places along a line at which its fold is sampled.
const MAX_SAMPLES: usize = 16;
/// Samples of a border between which it crosses a kink line once at most.
const SAMPLES: usize = 128;
/// Tracks of lower rank give the geometry of what several share: all others come first.
const RANK: u8 = u8::MAX;

/// The kink lines and folds inside a trimmed patch as tracks. Other patches are cut at their kinks, and have folds where faces are made freely.
pub fn of_patch(input: &Input, patch: PatchId) -> Vec<Part> {
    let surface = &input.model.surfaces[input.model.patches[patch.index()].surface.index()].surface;
    let is_free = input.plan.settings.method.is_some_and(|method| method.0.is_free() && !method.0.is_coarse());
    let is_whole = surface.domain() == Domain::Square && surface.kinks() == (&[], &[]) && is_free;
    if surface.is_flat() || surface.domain() != Domain::Loop && !is_whole {
        return Vec::new();
    }
    let outlines = if is_whole { vec![SQUARE.to_vec()] } else { surface.outlines() };
    let [us, vs] = lines(input, surface, &outlines);
    if us.is_empty() && vs.is_empty() {
        return Vec::new();
    }
    let side = |k: usize| if is_whole { Some(line(SQUARE[k], SQUARE[(k + 1) % SQUARE.len()])) } else { border(surface, k) };
    let borders: Vec<Box<dyn Fn(f64) -> DVec2 + '_>> = (0..surface.n_sides()).filter_map(side).collect();
    let limited = input.plan.settings.chord_error.is_some();
    let mut parts = Vec::new();
    for (axis, lines, others) in [(0, &us, &vs), (1, &vs, &us)] {
        for (at, room) in lines.iter().flat_map(|line| surface.copies_along(axis, line.0).into_iter().map(|x| (x, line.1))) {
            let mut ends: Vec<f64> = borders.iter().flat_map(|border| crossings(border, axis, at)).collect();
            ends.sort_by(f64::total_cmp);
            for w in ends.windows(2) {
                let place = |other: f64| if axis == 0 { DVec2::new(at, other) } else { DVec2::new(other, at) };
                let middle = place(0.5 * (w[0] + w[1]));
                if !surround(&outlines, middle) {
                    continue;
                }
                // Nets of other programs have knots at which directions jump by a hair: held only for a limit on bends.
                if room.is_none()
                    && !limited
                    && (0..=MAX_SAMPLES)
                        .all(|k| fold(surface, axis, place(w[0] + (w[1] - w[0]) * k as f64 / MAX_SAMPLES as f64)) < MIN_FOLD)
                {
                    continue;
                }
                let whole = Trace::new(surface, place(w[0]).into(), place(w[1]).into());
                let pieces = match (room, input.plan.settings.size) {
                    (Some(room), Some(size)) => {
                        let clear = (0.5 * size.0 / whole.length()).min(1.0) * (w[1] - w[0]);
                        clear_of_loops(&outlines, axis, (at, room), (w[0], w[1]), clear)
                    }
                    _ => vec![(w[0], w[1])],
                };
                for (from, to) in pieces {
                    let trace = Trace::new(surface, place(from).into(), place(to).into());
                    if trace.length() <= 2.0 * input.tolerance.point {
                        continue;
                    }
                    let inner = others.iter().flat_map(|line| surface.copies_along(1 - axis, line.0)).filter(|x| *x > from && *x < to);
                    let cuts = inner.map(|x| trace.length_at((x - from) / (to - from))).collect();
                    parts.push(Part { track: Track::Iso(trace), cuts, rank: RANK, near: input.tolerance.point });
                }
            }
        }
    }
    parts
}

/// A value of u or v at which a surface has a kink or, with how far the line may be moved, a fold.
type Line = (f64, Option<f64>);

/// Values of u and of v at which a surface has kinks or folds inside its outlines. Folds go through corners of loops that lie on them.
fn lines(input: &Input, surface: &Surface, outlines: &[Vec<DVec2>]) -> [Vec<Line>; 2] {
    let (us, vs) = surface.kinks();
    let kinks = [us, vs].map(|lines| lines.iter().map(|x| (*x, None)).collect::<Vec<Line>>());
    // Cells between lines of constant u and v follow folds by themselves, and elements that turn little.
    let is_coarse = input.plan.settings.method.is_some_and(|method| method.0.is_coarse());
    let Some(size) = input.plan.settings.size.map(|size| size.0).filter(|_| !is_coarse && input.plan.settings.angle_error.is_none()) else {
        return kinks;
    };
    let chord = input.plan.settings.chord_error.map(|chord| chord.0);
    let ends = outlines.iter().flatten().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    let corners: Vec<DVec2> = outlines.iter().flat_map(|polygon| corners(polygon)).collect();
    let [us, vs] = kinks;
    [(0, us), (1, vs)].map(|(axis, mut kinks)| {
        for (fold, room) in folds::along(surface, axis, ends, (size, chord)) {
            let is_kink = |kink: &Line| kink.1.is_none() && (kink.0 - fold).abs() <= room;
            if !kinks.iter().any(is_kink) {
                let off = |corner: &DVec2| (corner[axis] - fold).abs();
                let nearest = corners.iter().filter(|corner| off(corner) <= room).min_by(|a, b| off(a).total_cmp(&off(b)));
                kinks.push((nearest.map_or(fold, |corner| corner[axis]), Some(room)));
            }
        }
        kinks
    })
}

/// Where a polygon of many sides turns.
fn corners(polygon: &[DVec2]) -> impl Iterator<Item = DVec2> {
    let n = polygon.len();
    let turn = move |k: usize| (polygon[k] - polygon[(k + n - 1) % n]).angle_to(polygon[(k + 1) % n] - polygon[k]).abs();
    (0..n).filter(move |k| turn(*k) > MIN_CORNER).map(|k| polygon[k])
}

/// The pieces of a line between two loops that are farther than `clear` along it from where a loop runs beside it, nearer than there is room:
/// between them were slivers. Loops within `clear` of an end are those that it ends at.
fn clear_of_loops(outlines: &[Vec<DVec2>], axis: usize, (at, room): (f64, f64), (from, to): (f64, f64), clear: f64) -> Vec<(f64, f64)> {
    let beside = |p: &DVec2| (p[axis] - at).abs() <= room;
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for polygon in outlines {
        for (k, p) in polygon.iter().enumerate().filter(|(_, p)| beside(p)) {
            let next = Some(polygon[(k + 1) % polygon.len()]).filter(|next| beside(next)).unwrap_or(*p);
            let (low, high) = (p[1 - axis].min(next[1 - axis]), p[1 - axis].max(next[1 - axis]));
            if high > from + clear && low < to - clear {
                runs.push((low - clear, high + clear));
            }
        }
    }
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut pieces, mut start) = (Vec::new(), from);
    for (low, high) in runs {
        if low > start + clear {
            pieces.push((start, low));
        }
        start = start.max(high);
    }
    if start == from || to > start + clear {
        pieces.push((start, to));
    }
    pieces
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

fn line<'a>(a: DVec2, b: DVec2) -> Box<dyn Fn(f64) -> DVec2 + 'a> {
    Box::new(move |t| a.lerp(b, t))
}

/// Places along a border in the direction of its loop, by a fraction.
fn border(surface: &Surface, k: usize) -> Option<Box<dyn Fn(f64) -> DVec2 + '_>> {
    if let Some((a, b)) = surface.border_line(k) {
        return Some(line(a.into(), b.into()));
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
