//! Rows of maps that are as uneven as the bends of their faces: where even ones would have to be as narrow everywhere as the sharpest bend
//! demands, as round a profile with small roundings.
//!
//! Rows run on over all faces that share segments. Opposite sides are divided into segments at the same shares, so that each segment has one
//! opposite to it; all that are opposite to each other, face by face, are divided by one law, and no row leans.

use std::collections::{BTreeMap, BTreeSet};

use crate::base::tolerance::WHOLE_NUMBER;
use crate::base::{job, par, work};
use crate::mesh::border::layout::{Face, FaceSide, Layout};
use crate::mesh::border::nodes::{Nodes, line};
use crate::mesh::request::input::Input;
use crate::mesh::size::border_spacing::{BorderSpacing, SIZE_ROOM, SPACING_SETTINGS};
use crate::mesh::size::least_counts::MAX_COUNT;
use crate::mesh::size::opposite_segments::{Opposite, OppositeSegments};
use crate::mesh::size::row_bends::RowDirection;
use crate::mesh::size::spacing_solver::SpacingInput;

/// When rows are uneven.
struct RowSettings {
    /// Even rows have to be this many times as many.
    min_gain: f64,
    /// And this many more.
    min_saved: f64,
    /// Largest difference of the shares at which a row meets both sides, over its steps there.
    max_lean: f64,
    /// Rounds in which steps grow from segment to segment along sides.
    growth_rounds: usize,
}

const SETTINGS: RowSettings = RowSettings { min_gain: 2.0, min_saved: 8.0, max_lean: 0.5, growth_rounds: 4 };

/// Numbers of rows of a face along a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowCounts {
    /// As they are, uneven.
    pub uneven: u32,
    /// Even ones, as far as is known.
    pub even: f64,
}

/// Numbers of rows of each face along u and along v where they are uneven.
pub type UnevenRows = Vec<[Option<RowCounts>; 2]>;

/// A direction of a mapped face with four sides.
struct Rows {
    face: usize,
    direction: usize,
}

/// What bends demand of rows.
struct RowDemands {
    /// Steps as shares of a side.
    spacing: BorderSpacing,
    /// Number of even rows.
    even: f64,
}

/// Lowers the spacings of the sides of maps with uneven rows; gives the number of these rows.
pub(super) fn lower_to_rows(input: &Input, layout: &Layout, given: &SpacingInput, spacings: &mut [BorderSpacing]) -> UnevenRows {
    let mut uneven = vec![[None; 2]; layout.faces.len()];
    if given.limits.chord.is_none() && given.limits.angle.is_none() {
        return uneven;
    }
    let opposite = OppositeSegments::new(layout, input.tolerance.point);
    for strip in strips(layout, given, &opposite) {
        job::poll();
        let demands = par::map(strip.len(), |k| demands(input, layout, given, &strip[k]));
        let least = |rows: &Rows, demands: &RowDemands| {
            sides(&layout.faces[rows.face], rows.direction).map(|side| side.length).fold(f64::INFINITY, f64::min) / demands.even
        };
        // That even rows would be below a written floor is an error that tells what needs them.
        if strip.iter().zip(&demands).any(|(rows, demands)| least(rows, demands) < given.wanted.written) {
            continue;
        }
        let known = Laws::known(layout, given, &opposite, &strip, spacings);
        let mut laws = known.clone();
        strip.iter().zip(&demands).for_each(|(rows, demands)| laws.lower_to(layout, &opposite, rows, &demands.spacing));
        laws.grow(layout, &opposite, &strip, input.plan.slope());
        let counts: Vec<u32> = strip.iter().map(|rows| laws.count(layout, &opposite, rows)).collect();
        let by_known = strip.iter().map(|rows| f64::from(known.count(layout, &opposite, rows)));
        let even = demands.iter().map(|demands| demands.even).chain(by_known).fold(0.0, f64::max);
        let most = f64::from(counts.iter().copied().max().unwrap_or(0));
        if even < SETTINGS.min_gain * most || even < most + SETTINGS.min_saved {
            continue;
        }
        for rows in &strip {
            for part in sides(&layout.faces[rows.face], rows.direction).flat_map(|side| &side.uses) {
                spacings[part.segment] = laws.of_segment(layout, &opposite, part.segment);
            }
        }
        strip.iter().zip(counts).for_each(|(rows, count)| uneven[rows.face][rows.direction] = Some(RowCounts { uneven: count, even }));
    }
    uneven
}

/// Faces whose uneven rows have to be even: those that lean beyond half of a step, or whose limits turned out to demand more rows than
/// even ones would be. `rows_of_face` are the rows of each face, as in [`crate::mesh::divide::relations::Relations::of_face`].
pub fn unfit(layout: &Layout, nodes: &Nodes, rows: &UnevenRows, rows_of_face: &[Vec<usize>], counts: &[u32]) -> Vec<usize> {
    let is_unfit = |f: usize, direction: usize| {
        let face = &layout.faces[f];
        let Some(own) = rows[f][direction] else { return false };
        if f64::from(counts[rows_of_face[f][direction]]) > own.even.max(f64::from(own.uneven)) {
            return true;
        }
        if face.sides[direction].uses.is_empty() || face.sides[direction + 2].uses.is_empty() {
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
    (0..layout.faces.len()).filter(|f| is_unfit(*f, 0) || is_unfit(*f, 1)).collect()
}

/// Both sides along a direction that are no poles.
fn sides(face: &Face, direction: usize) -> impl Iterator<Item = &FaceSide> {
    [direction, direction + 2].into_iter().map(|k| &face.sides[k]).filter(|side| !side.uses.is_empty())
}

/// Rows that run on from face to face, strip by strip. Those that run across a segment whose steps are written, across a triangle of a map,
/// or between sides that are not divided alike are even and left out.
fn strips(layout: &Layout, given: &SpacingInput, opposite: &OppositeSegments) -> Vec<Vec<Rows>> {
    let mut even = BTreeSet::new();
    let triangles = layout.faces.iter().filter(|face| !face.free && face.is_triangle()).flat_map(Face::segments);
    let written = (0..given.written.len()).filter(|k| given.written[*k].is_some());
    triangles.chain(written).for_each(|k| {
        even.insert(opposite.strip(k));
    });
    let mut strips: BTreeMap<usize, Vec<Rows>> = BTreeMap::new();
    for (f, face) in layout.faces.iter().enumerate().filter(|(_, face)| !face.free && !face.is_triangle()) {
        for direction in [0, 1] {
            let Some(segment) = sides(face, direction).flat_map(FaceSide::segments).next() else { continue };
            let strip = opposite.strip(segment);
            if face.even_rows || !opposite.is_aligned(f, direction) {
                even.insert(strip);
            }
            strips.entry(strip).or_default().push(Rows { face: f, direction });
        }
    }
    strips.into_iter().filter(|(strip, _)| !even.contains(strip)).map(|(_, rows)| rows).collect()
}

/// What the bends of a face demand of its rows along a direction.
fn demands(input: &Input, layout: &Layout, given: &SpacingInput, rows: &Rows) -> RowDemands {
    let face = &layout.faces[rows.face];
    let side = sides(face, rows.direction).map(|side| side.length).fold(0.0, f64::max);
    let by_size = (face.size.0 / side).min(1.0);
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let Some(found) = RowDirection::new(input, surface.evaluator(), given.limits, face, rows.direction) else {
        return RowDemands { spacing: BorderSpacing::even(by_size), even: 1.0 / by_size };
    };
    let profile = found.profile();
    let most = by_size.min(SIZE_ROOM * face.size.0 / profile.longest);
    let [from, to] = if rows.direction == 0 { [3, 1] } else { [0, 2] }.map(|k| face.sides[k].segments());
    let is_ring = from.iter().any(|segment| to.contains(segment));
    let longest = profile.longest_steps(most);
    let even = 1.0 / longest.iter().copied().fold(most, f64::min);
    RowDemands { spacing: profile.spacing(&longest, input.plan.slope(), is_ring), even }
}

/// Steps of the segments of a strip as shares of their lengths: one law for all that are opposite to each other, along the first of them.
#[derive(Clone)]
struct Laws(BTreeMap<usize, BorderSpacing>);

impl Laws {
    /// By the sizes of the segments, and by what else is known to shorten their steps.
    fn known(layout: &Layout, given: &SpacingInput, opposite: &OppositeSegments, strip: &[Rows], spacings: &[BorderSpacing]) -> Self {
        let mut laws = Self(BTreeMap::new());
        let of_face = |rows: &Rows| sides(&layout.faces[rows.face], rows.direction).flat_map(FaceSide::segments).collect::<Vec<usize>>();
        for segment in strip.iter().flat_map(of_face) {
            let share = 1.0 / layout.length(segment);
            let mut own = spacings[segment].clone();
            own.lengths.iter_mut().for_each(|length| *length = length.min(given.size[segment]) * share);
            // A step is no longer than its size, not by a little either.
            laws.lower(opposite.of(segment), own, 1.0 - WHOLE_NUMBER);
        }
        laws
    }

    /// Lowers the law of a segment to steps along it, where these are below the share `min_change` of it somewhere.
    fn lower(&mut self, Opposite { first, is_reversed }: Opposite, steps: BorderSpacing, min_change: f64) {
        let steps = if is_reversed { reversed(&steps) } else { steps };
        let Some(law) = self.0.get_mut(&first) else {
            self.0.insert(first, steps);
            return;
        };
        work::spend((steps.at.len() + law.at.len()) as u64);
        let is_lower = |f: f64| steps.length_at(f) < min_change * law.length_at(f);
        if steps.at.iter().chain(&law.at).any(|f| is_lower(*f)) {
            *law = law.lower(&steps);
        }
    }

    /// Lowers the laws to the steps of the rows of a face, shares of a side.
    fn lower_to(&mut self, layout: &Layout, opposite: &OppositeSegments, rows: &Rows, steps: &BorderSpacing) {
        let Some(side) = sides(&layout.faces[rows.face], rows.direction).next() else { return };
        for part in &side.uses {
            let (from, to) = (part.s.0 / side.length, part.s.1 / side.length);
            let inner = steps.at.iter().copied().filter(|at| *at > from && *at < to);
            let places: Vec<f64> = std::iter::once(from).chain(inner).chain([to]).collect();
            let lengths = places.iter().map(|at| steps.length_at(*at) / (to - from)).collect();
            let at = places.iter().map(|at| if *at == to { 1.0 } else { (at - from) / (to - from) }).collect();
            let own = BorderSpacing { at, lengths, why: Vec::new() };
            self.lower(opposite.of(part.segment), if part.against { reversed(&own) } else { own }, SPACING_SETTINGS.min_change);
        }
    }

    /// Steps grow by no more than `slope` from each segment of a side to the next.
    fn grow(&mut self, layout: &Layout, opposite: &OppositeSegments, strip: &[Rows], slope: f64) {
        for _ in 0..SETTINGS.growth_rounds {
            for side in strip.iter().flat_map(|rows| sides(&layout.faces[rows.face], rows.direction)) {
                let pairs = side.uses.windows(2);
                for [a, b] in pairs.clone().map(|w| [&w[0], &w[1]]).chain(pairs.rev().map(|w| [&w[1], &w[0]])) {
                    // Where both meet, seen along each segment: `b` begins there if it follows `a`.
                    let follows = a.s.1 <= b.s.0;
                    let [end, start] = [(a, follows), (b, !follows)].map(|(part, last)| if last != part.against { 1.0 } else { 0.0 });
                    let length = self.of_segment(layout, opposite, a.segment).length_at(end);
                    let own = self.of_segment(layout, opposite, b.segment);
                    if length < SPACING_SETTINGS.min_change * own.length_at(start) {
                        let share = 1.0 / layout.length(b.segment);
                        let grown = BorderSpacing::about(&[(start, length * share)], own.most() * share, slope);
                        self.lower(opposite.of(b.segment), grown, SPACING_SETTINGS.min_change);
                    }
                }
            }
        }
    }

    /// Steps along a segment, model units.
    fn of_segment(&self, layout: &Layout, opposite: &OppositeSegments, segment: usize) -> BorderSpacing {
        let Opposite { first, is_reversed } = opposite.of(segment);
        let Some(law) = self.0.get(&first) else { return BorderSpacing::even(layout.length(segment)) };
        let mut own = if is_reversed { reversed(law) } else { law.clone() };
        own.lengths.iter_mut().for_each(|length| *length *= layout.length(segment));
        own
    }

    /// Number of rows of a face.
    fn count(&self, layout: &Layout, opposite: &OppositeSegments, rows: &Rows) -> u32 {
        let Some(side) = sides(&layout.faces[rows.face], rows.direction).next() else { return 1 };
        let steps = |segment: usize| self.0.get(&opposite.of(segment).first).map_or(1, |law| law.demand(1.0, 1.0, MAX_COUNT));
        side.uses.iter().map(|part| steps(part.segment)).fold(0, u32::saturating_add)
    }
}

/// Steps along a segment from its other end.
fn reversed(steps: &BorderSpacing) -> BorderSpacing {
    BorderSpacing {
        at: steps.at.iter().rev().map(|at| 1.0 - at).collect(),
        lengths: steps.lengths.iter().rev().copied().collect(),
        why: Vec::new(),
    }
}
