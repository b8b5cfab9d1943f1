//! Lengths along the borders of free faces that their bends allow under chord error and angle.

use glam::{DVec2, DVec3};

use crate::base::par;
use crate::mesh::border::inside::trace;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::deviation::edge_length::{self, EdgePlace};
use crate::mesh::deviation::poles;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::Method;
use crate::mesh::size::border_spacing::{BorderSpacing, FILLED, SPACING_SETTINGS};
use crate::mesh::size::gaps::{self, PLACES, SegmentBeside};
use crate::mesh::size::spacing_solver::SpacingInput;
use crate::surface::Evaluator;

/// Lowers spacings to the lengths that the bends of free faces allow.
pub(super) fn lower_to_bends(input: &Input, layout: &Layout, given: &SpacingInput, spacings: &mut [BorderSpacing]) {
    if given.limits.chord.is_none() && given.limits.angle.is_none() {
        return;
    }
    let found = par::map(layout.faces.len(), |f| of_face(input, layout, &layout.faces[f], &given.rows[f], given.limits));
    for (segment, lengths) in found.into_iter().flatten() {
        let (spacing, size) = (&mut spacings[segment], given.size[segment]);
        if spacing.at.len() == 2 {
            *spacing = BorderSpacing {
                at: (0..=PLACES).map(|k| k as f64 / PLACES as f64).collect(),
                lengths: vec![size; PLACES + 1],
                why: Vec::new(),
            };
        }
        spacing.lengths.iter_mut().zip(lengths).for_each(|(l, other)| *l = l.min(other.max(given.wanted.written)));
    }
    let graded = graded(layout, spacings.len());
    for (segment, spacing) in spacings.iter_mut().enumerate().filter(|(k, p)| p.at.len() > 2 && graded[*k]) {
        level(&mut spacing.lengths, input.plan.slope() * layout.length(segment) / PLACES as f64);
    }
}

/// Segments beside a free face on which lengths grow step by step.
fn graded(layout: &Layout, n: usize) -> Vec<bool> {
    let mut graded = vec![false; n];
    let grown = layout.faces.iter().filter(|f| f.free && !f.method.is_coarse());
    grown.flat_map(|f| f.sides.iter().flat_map(|s| s.segments()).chain(f.lines.iter().copied())).for_each(|k| graded[k] = true);
    graded
}

/// Lengths grow by no more than `step` from place to place.
fn level(lengths: &mut [f64], step: f64) {
    for k in 1..lengths.len() {
        lengths[k] = lengths[k].min(lengths[k - 1] + step);
    }
    for k in (1..lengths.len()).rev() {
        lengths[k - 1] = lengths[k - 1].min(lengths[k] + step);
    }
}

/// Wanted lengths along the segments of one face.
fn of_face(input: &Input, layout: &Layout, own: &Face, rows: &[SegmentBeside], limits: &Limits) -> Vec<(usize, Vec<f64>)> {
    let surface = &input.model.surfaces[own.surface.index()].surface;
    if !own.free || surface.is_flat() {
        return Vec::new();
    }
    let prepared = surface.prepared();
    let evaluator = prepared.evaluator();
    let mut found = Vec::new();
    let apart = |segment: usize| layout.length(segment) / PLACES as f64;
    // Cells halve by twos and fit best where a curve has one length; `display` joins them again.
    let by_cells = own.method == Method::Isoline;
    let both = |row: &SegmentBeside, apart: f64| {
        let curve = |i: usize| if by_cells { f64::INFINITY } else { by_curve(&row.points, i, limits) };
        let bent = BentRow { evaluator, row, apart, size: own.size.0, limits };
        let lengths = if own.method.is_coarse() { bent.coarse_lengths(own.method == Method::Display) } else { bent.lengths() };
        lengths.into_iter().enumerate().map(|(i, length)| length.min(curve(i))).collect::<Vec<_>>()
    };
    for (u, row) in own.sides.iter().flat_map(|side| &side.uses).zip(rows) {
        found.push((u.segment, both(row, apart(u.segment))));
    }
    for line in &own.lines {
        let points: Vec<DVec3> = (0..=PLACES).map(|k| layout.point(*line, k as f64 / PLACES as f64)).collect();
        let places = trace(surface, &input.model.patches[own.patch.index()], &points);
        let row = SegmentBeside::new(surface, places, points, input.tolerance.point * gaps::SLIGHT);
        found.push((*line, both(&row, apart(*line))));
    }
    found
}

/// The length at a place of a row of points for which a step keeps the limits as a piece of the curve, by the circle through it and
/// its neighbours: what is left to be found by [`least_steps`](crate::mesh::deviation::curve::least_steps) for all steps together is next to nothing.
fn by_curve(points: &[DVec3], i: usize, limits: &Limits) -> f64 {
    let i = i.clamp(1, points.len() - 2);
    let (a, b) = (points[i] - points[i - 1], points[i + 1] - points[i]);
    let bend = 2.0 * a.cross(b).length() / (a.length() * b.length() * (a + b).length());
    let by_chord = limits.chord.map_or(f64::INFINITY, |limit| (8.0 * limit / bend).sqrt());
    let by_angle = limits.angle.map_or(f64::INFINITY, |limit| limit / bend);
    by_chord.min(by_angle)
}

/// A row of places along a segment beside a bent face.
struct BentRow<'a> {
    evaluator: Evaluator<'a>,
    row: &'a SegmentBeside,
    /// Distance of neighbouring places, model units.
    apart: f64,
    /// Target size of the face, model units.
    size: f64,
    limits: &'a Limits,
}

impl BentRow<'_> {
    /// Lengths at all places so that triangles on both sides of the row keep the limits, the chord error less how far
    /// the row is off the surface within a step.
    fn lengths(&self) -> Vec<f64> {
        let Self { evaluator, row, apart, size, limits } = *self;
        let last = row.places.len() - 1;
        let step = |i: usize| DVec2::from(row.places[(i + 1).min(last)]) - DVec2::from(row.places[(i + 1).min(last) - 1]);
        let tangents = |at: DVec2| evaluator.tangents(at.x, at.y);
        let length = |i: usize, off: f64| {
            let chord = limits.chord.map(|limit| gaps::remaining_chord_error(limit, off));
            let wanted = |at: DVec2| {
                let jet = evaluator.jet(at.x, at.y);
                let plain = edge_length::wanted(&jet, chord, limits.angle).min(size / FILLED);
                let along = jet.du * step(i).x + jet.dv * step(i).y;
                let bounded = |limit| edge_length::bounded(evaluator, EdgePlace { at, jet: &jet, along }, limit, plain);
                SPACING_SETTINGS.border_ratio * FILLED * chord.map_or(plain, bounded)
            };
            let at = DVec2::from(row.places[i]);
            poles::at_tip(evaluator.surface(), &tangents, at, &wanted).unwrap_or_else(|| wanted(at))
        };
        let within = |i: usize, h: f64| {
            let reach = (h / apart).ceil().min(last as f64) as usize;
            row.off[i.saturating_sub(reach)..=(i + reach).min(last)].iter().copied().fold(0.0, f64::max)
        };
        let one = |i: usize| {
            let own = length(i, row.off[i]);
            let worst = within(i, own);
            if worst > row.off[i] { length(i, worst) } else { own }
        };
        self.interpolated(&one)
    }

    /// Lengths at all places by as few of them as are needed: where one between two that are near each other is their mean,
    /// and borders run alike beside the surface, lengths are linear.
    fn interpolated(&self, length: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let Self { row, apart, limits, .. } = *self;
        let last = row.places.len() - 1;
        let room = limits.chord.map_or(f64::INFINITY, |limit| SPACING_SETTINGS.max_linear_error * limit);
        let mut found = vec![0.0; last + 1];
        (found[0], found[last]) = (length(0), length(last));
        let mut open: Vec<(usize, usize)> = vec![(0, last)];
        while let Some((a, b)) = open.pop() {
            let middle = a.midpoint(b);
            if middle == a {
                continue;
            }
            let own = length(middle);
            found[middle] = own;
            let (most, least) = (found[a].max(found[b]), found[a].min(found[b]));
            let off = |pick: fn(f64, f64) -> f64| row.off[a..=b].iter().copied().reduce(pick).unwrap_or(0.0);
            let even = most <= SPACING_SETTINGS.max_linear_ratio * least
                && (own - 0.5 * (most + least)).abs() <= SPACING_SETTINGS.max_linear_error * own
                && off(f64::max) - off(f64::min) <= room;
            if b - a > SPACING_SETTINGS.max_linear_places || (b - a) as f64 * apart > SPACING_SETTINGS.max_linear_distance * least || !even
            {
                open.extend([(a, middle), (middle, b)]);
                continue;
            }
            for (from, to) in [(a, middle), (middle, b)] {
                let (start, end) = (found[from], found[to]);
                (from + 1..to).for_each(|k| found[k] = start + (end - start) * (k - from) as f64 / (to - from) as f64);
            }
        }
        found
    }

    /// The same where triangles may be long, and along the border `sheared`: an edge is no longer than the length wanted at any place on it.
    fn coarse_lengths(&self, sheared: bool) -> Vec<f64> {
        let Self { evaluator, row, apart, size, limits } = *self;
        let last = row.places.len() - 1;
        let wide = evaluator.surface().hull().diagonal().min(size);
        let step = |i: usize| DVec2::from(row.places[(i + 1).min(last)]) - DVec2::from(row.places[(i + 1).min(last) - 1]);
        let length = |i: usize| {
            let at = row.places[i];
            let jet = evaluator.jet(at.0, at.1);
            // At a pole there is nothing across, and what is beside it decides.
            if poles::is_pole(&|_| [jet.p, jet.du, jet.dv], at.into()) {
                return size;
            }
            let along = jet.du * step(i).x + jet.dv * step(i).y;
            let chord = limits.chord.map(|limit| gaps::remaining_chord_error(limit, row.off[i]));
            edge_length::on_coarse_border(
                evaluator,
                EdgePlace { at: at.into(), jet: &jet, along },
                &Limits { chord, ..*limits },
                wide,
                sheared,
            )
            .min(size)
        };
        let lengths: Vec<f64> = (0..=last).map(length).collect();
        // An edge about a place reaches half its length to both sides.
        let reached = |i: usize| {
            let shorter = |(j, other): (usize, &f64)| other.max(2.0 * apart * i.abs_diff(j) as f64);
            lengths.iter().enumerate().map(shorter).fold(lengths[i], f64::min)
        };
        (0..=last).map(reached).collect()
    }
}
