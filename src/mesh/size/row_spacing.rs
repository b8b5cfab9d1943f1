//! Rows of maps that are as uneven as the bends of their faces: where even ones would have to be as narrow everywhere as the sharpest bend
//! demands, as round a profile with small roundings.
//!
//! All sides that rows of one face, of the next one, and so on run across are divided by one law: shares of their length.

use std::collections::BTreeMap;

use crate::base::{job, par};
use crate::mesh::border::layout::{Face, FaceSide, Layout};
use crate::mesh::border::nodes::{Nodes, line};
use crate::mesh::request::input::Input;
use crate::mesh::size::border_spacing::{BorderSpacing, SIZE_ROOM, SPACING_SETTINGS};
use crate::mesh::size::least_counts::MAX_COUNT;
use crate::mesh::size::row_profile::RowDirection;
use crate::mesh::size::spacing_solver::SpacingInput;
use crate::model::glue::root;
use crate::model::segments::SegmentUse;
use crate::surface::Evaluator;

/// When rows are uneven.
struct RowSettings {
    /// Even rows have to be this many times as many.
    min_gain: f64,
    /// And this many more.
    min_saved: f64,
    /// Largest difference of the shares at which two sides are divided into segments.
    max_misfit: f64,
    /// Largest difference of the shares at which a row meets both sides, over its steps there.
    max_lean: f64,
}

const SETTINGS: RowSettings = RowSettings { min_gain: 2.0, min_saved: 8.0, max_misfit: 1e-6, max_lean: 0.5 };

/// Number of rows of each face along u and along v where they are uneven.
pub type UnevenRows = Vec<[Option<u32>; 2]>;

/// Rows of one direction of a face.
struct Rows {
    face: usize,
    direction: usize,
    /// Steps as shares of a side.
    spacing: BorderSpacing,
    /// The longest step that the size allows, such a share.
    most: f64,
    /// Number of even rows.
    even: f64,
}

/// Lowers the spacings of the sides of maps with uneven rows; gives the number of these rows.
pub(super) fn lower_to_rows(input: &Input, layout: &Layout, given: &SpacingInput, spacings: &mut [BorderSpacing]) -> UnevenRows {
    let mut uneven = vec![[None; 2]; layout.faces.len()];
    if given.limits.chord.is_none() && given.limits.angle.is_none() {
        return uneven;
    }
    let found = par::map(layout.faces.len(), |f| rows_of_face(input, layout, given, f));
    let all: Vec<Rows> = found.into_iter().flatten().collect();
    for mut strip in strips(layout, given, all) {
        if strip.iter().any(|rows| stays_even(layout, given, rows)) {
            continue;
        }
        let even = strip.iter().map(|rows| rows.even).fold(0.0, f64::max);
        let segments = strip.iter().flat_map(|rows| sides(&layout.faces[rows.face], rows.direction).flat_map(FaceSide::segments));
        let known = segments.filter(|k| spacings[*k].least() < given.size[*k]).map(|k| (k, spacings[k].clone())).collect();
        let agreed = agreed(layout, &mut strip, known);
        let count = |rows: &Rows| rows.spacing.demand(1.0, rows.most, MAX_COUNT);
        let most = strip.iter().map(|rows| f64::from(count(rows))).fold(0.0, f64::max);
        if even < SETTINGS.min_gain * most || even < most + SETTINGS.min_saved {
            continue;
        }
        agreed.into_iter().for_each(|(segment, spacing)| spacings[segment] = spacings[segment].lower(&spacing));
        strip.iter().for_each(|rows| uneven[rows.face][rows.direction] = Some(count(rows)));
    }
    uneven
}

/// Whether both sides along a direction are divided into segments at the same shares of their lengths.
fn is_aligned(face: &Face, direction: usize) -> bool {
    let [a, b] = [&face.sides[direction], &face.sides[direction + 2]];
    let end = |side: &FaceSide, k: usize| side.uses[k].s.1 / side.length;
    a.uses.is_empty()
        || b.uses.is_empty()
        || a.uses.len() == b.uses.len() && (0..a.uses.len()).all(|k| (end(a, k) - end(b, k)).abs() <= SETTINGS.max_misfit)
}

/// Faces with uneven rows that lean: beyond half of a step.
pub fn leaning(layout: &Layout, nodes: &Nodes, rows: &UnevenRows) -> Vec<usize> {
    let leans = |f: usize, direction: usize| {
        let face = &layout.faces[f];
        if rows[f][direction].is_none() || face.sides[direction].uses.is_empty() || face.sides[direction + 2].uses.is_empty() {
            return false;
        }
        let shares = |k: usize| {
            let length = face.sides[k].length;
            line(layout, nodes, face, k, 0).lengths.into_iter().map(|s| s / length).collect::<Vec<f64>>()
        };
        let (a, b) = (shares(direction), shares(direction + 2));
        let apart = |k: usize| (a[k] - b[k]).abs() > SETTINGS.max_lean * (a[k] - a[k - 1]).min(a[k + 1] - a[k]);
        a.len() != b.len() || (1..a.len() - 1).any(apart)
    };
    (0..layout.faces.len()).filter(|f| leans(*f, 0) || leans(*f, 1)).collect()
}

/// Whether uneven rows would lean, or have steps below a written floor: that even ones have them is told with what needs them.
fn stays_even(layout: &Layout, given: &SpacingInput, rows: &Rows) -> bool {
    let face = &layout.faces[rows.face];
    let shortest = sides(face, rows.direction).map(|side| side.length).fold(f64::INFINITY, f64::min) / rows.even;
    face.even_rows || !is_aligned(face, rows.direction) || shortest < given.wanted.written
}

/// Both sides along a direction.
fn sides(face: &Face, direction: usize) -> impl Iterator<Item = &FaceSide> {
    [direction, direction + 2].into_iter().map(|k| &face.sides[k]).filter(|side| !side.uses.is_empty())
}

/// Rows along u and along v of a mapped face with four sides.
fn rows_of_face(input: &Input, layout: &Layout, given: &SpacingInput, f: usize) -> Vec<Rows> {
    let face = &layout.faces[f];
    if face.free || face.is_triangle() {
        return Vec::new();
    }
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let form = surface.power_form();
    let evaluator = Evaluator::new(surface, form.as_ref());
    let one = |direction: usize| {
        let profile = RowDirection::new(input, evaluator, given.limits, face, direction)?.profile();
        let side = sides(face, direction).map(|side| side.length).fold(0.0, f64::max);
        let most = (face.size.0 / side).min(SIZE_ROOM * face.size.0 / profile.longest());
        let is_ring = {
            let [from, to] = if direction == 0 { [3, 1] } else { [0, 2] }.map(|k| face.sides[k].segments());
            from.iter().any(|segment| to.contains(segment))
        };
        let longest = profile.longest_steps(most);
        let even = 1.0 / longest.iter().copied().fold(most, f64::min);
        Some(Rows { face: f, direction, spacing: profile.spacing(&longest, input.plan.slope(), is_ring), most, even })
    };
    [0, 1].into_iter().filter_map(one).collect()
}

/// Rows that share segments, strip by strip. Those that run across a segment whose steps are written, or across a triangle of a map, are
/// even.
fn strips(layout: &Layout, given: &SpacingInput, all: Vec<Rows>) -> Vec<Vec<Rows>> {
    let mut parent: Vec<usize> = (0..layout.pieces.segments.len()).collect();
    let segments = |rows: &Rows| sides(&layout.faces[rows.face], rows.direction).flat_map(FaceSide::segments).collect::<Vec<usize>>();
    for rows in &all {
        let own = segments(rows);
        for other in &own[1..] {
            let (a, b) = (root(&mut parent, own[0]), root(&mut parent, *other));
            parent[a.max(b)] = a.min(b);
        }
    }
    let triangles = layout.faces.iter().filter(|face| !face.free && face.is_triangle()).flat_map(Face::segments);
    let written = (0..parent.len()).filter(|k| given.written[*k].is_some());
    let even: Vec<usize> = triangles.chain(written).collect();
    let even: Vec<usize> = even.into_iter().map(|k| root(&mut parent, k)).collect();
    let mut strips: BTreeMap<usize, Vec<Rows>> = BTreeMap::new();
    for rows in all {
        let strip = root(&mut parent, segments(&rows)[0]);
        if !even.contains(&strip) {
            strips.entry(strip).or_default().push(rows);
        }
    }
    strips.into_values().collect()
}

/// Carries the steps of each face of a strip, and those known of its segments, on to the others until all agree; gives those of the segments,
/// model units.
fn agreed(layout: &Layout, strip: &mut [Rows], known: BTreeMap<usize, BorderSpacing>) -> BTreeMap<usize, BorderSpacing> {
    let mut found = known;
    for _ in 0..SPACING_SETTINGS.max_rounds {
        let mut changed = false;
        for rows in &mut *strip {
            job::poll();
            for side in sides(&layout.faces[rows.face], rows.direction) {
                let on_side = on_side(&rows.spacing, side, &found);
                if is_lower(&on_side, &rows.spacing) {
                    rows.spacing = rows.spacing.lower(&on_side);
                }
            }
            for side in sides(&layout.faces[rows.face], rows.direction) {
                for part in &side.uses {
                    let own = along(&rows.spacing, side, part);
                    let now = found.entry(part.segment).or_insert_with(|| own.clone());
                    if is_lower(&own, now) {
                        *now = now.lower(&own);
                        changed = true;
                    }
                }
            }
        }
        if !changed {
            break;
        }
    }
    found
}

/// Whether a spacing is clearly lower than another one somewhere.
fn is_lower(own: &BorderSpacing, other: &BorderSpacing) -> bool {
    own.at.iter().zip(&own.lengths).any(|(at, length)| *length < SPACING_SETTINGS.min_change * other.length_at(*at))
}

/// Steps of the rows of a face along one of its segments, model units.
fn along(rows: &BorderSpacing, side: &FaceSide, part: &SegmentUse) -> BorderSpacing {
    let (from, to) = (part.s.0 / side.length, part.s.1 / side.length);
    let inner = rows.at.iter().copied().filter(|at| *at > from && *at < to);
    let places: Vec<f64> = std::iter::once(from).chain(inner).chain([to]).collect();
    let share = |at: f64| if at == to { 1.0 } else { (at - from) / (to - from) };
    let mut at: Vec<f64> = places.iter().map(|at| share(*at)).collect();
    let mut lengths: Vec<f64> = places.iter().map(|at| rows.length_at(*at) * side.length).collect();
    if part.against {
        at = at.iter().rev().map(|at| 1.0 - at).collect();
        lengths.reverse();
    }
    BorderSpacing { at, lengths, why: Vec::new() }
}

/// Steps along the segments of a side as shares of it; where nothing is known yet, those of `rows`.
fn on_side(rows: &BorderSpacing, side: &FaceSide, known: &BTreeMap<usize, BorderSpacing>) -> BorderSpacing {
    let mut whole = BorderSpacing { at: Vec::new(), lengths: Vec::new(), why: Vec::new() };
    for part in &side.uses {
        let (from, to) = (part.s.0 / side.length, part.s.1 / side.length);
        let mut places: Vec<(f64, f64)> = match known.get(&part.segment) {
            Some(spacing) => spacing.at.iter().zip(&spacing.lengths).map(|(f, length)| (*f, length / side.length)).collect(),
            None => [0.0, 1.0].map(|f| (f, rows.length_at(from + (to - from) * f))).to_vec(),
        };
        if part.against {
            places = places.into_iter().rev().map(|(f, length)| (1.0 - f, length)).collect();
        }
        for (f, length) in places {
            let at = from + (to - from) * f;
            match whole.at.last() {
                Some(last) if at <= *last => {
                    let last = whole.lengths.len() - 1;
                    whole.lengths[last] = whole.lengths[last].min(length);
                }
                _ => {
                    whole.at.push(at);
                    whole.lengths.push(length);
                }
            }
        }
    }
    whole
}
