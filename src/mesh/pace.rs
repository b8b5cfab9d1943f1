//! Steps along a border that follow the bends of the free faces beside it: small where they bend much.

use super::build::Input;
use super::counts::steps;
use super::edges::Limits;
use super::free::{bound, face};
use super::layout::Layout;
use crate::base::par;
use crate::base::tolerance::WHOLE_NUMBER;

/// Places along a stretch at which lengths are asked for.
const PLACES: usize = 64;
/// Ratio of lengths a unit apart: how fast they may grow along a border.
const GROWTH: f64 = 0.3;

/// Wanted lengths at even places along a stretch, model units; from its start to its end.
#[derive(Clone, Debug)]
pub struct Pace {
    lengths: Vec<f64>,
}

impl Pace {
    /// Number of steps over the whole for no step longer than wanted or than `size`.
    pub fn wish(&self, length: f64, size: f64, most: u32) -> u32 {
        let sum: f64 = self.lengths.windows(2).map(|w| 0.5 * (1.0 / w[0].min(size) + 1.0 / w[1].min(size))).sum();
        let n = length / (self.lengths.len() - 1) as f64 * sum;
        let n = (n - WHOLE_NUMBER).ceil().clamp(1.0, f64::from(most)) as u32;
        // Even steps are what the size asks for at the least.
        n.max((length / size - WHOLE_NUMBER).ceil().clamp(1.0, f64::from(most)) as u32)
    }

    /// Fractions 0…1 of so many steps.
    pub fn steps(&self, count: u32) -> Vec<f64> {
        let mut run = vec![0.0];
        for w in self.lengths.windows(2) {
            run.push(run[run.len() - 1] + 0.5 * (1.0 / w[0] + 1.0 / w[1]));
        }
        let total = run[run.len() - 1];
        let cells = (run.len() - 1) as f64;
        let mut at = steps(count, 1.0);
        let last = at.len() - 1;
        for f in &mut at[1..last] {
            let wanted = *f * total;
            let k = run.partition_point(|r| *r <= wanted).clamp(1, run.len() - 1);
            *f = (k as f64 - 1.0 + (wanted - run[k - 1]) / (run[k] - run[k - 1])) / cells;
        }
        at
    }
}

/// The paces of stretches on free faces under limits.
pub fn along(input: &Input, layout: &Layout, limits: &Limits) -> Vec<Option<Pace>> {
    let mut paces: Vec<Option<Pace>> = vec![None; layout.pieces.atoms.len()];
    if limits.chord.is_none() && limits.angle.is_none() {
        return paces;
    }
    let found = par::map(layout.faces.len(), |f| of_face(input, layout, f, limits));
    for (stretch, lengths) in found.into_iter().flatten() {
        let pace = paces[stretch].get_or_insert_with(|| Pace { lengths: vec![f64::INFINITY; PLACES + 1] });
        pace.lengths.iter_mut().zip(lengths).for_each(|(l, other)| *l = l.min(other));
    }
    for (stretch, pace) in paces.iter_mut().enumerate() {
        if let Some(pace) = pace {
            level(&mut pace.lengths, layout.length(stretch));
        }
    }
    paces.iter_mut().filter(|p| p.as_ref().is_some_and(|p| !p.lengths.iter().all(|l| l.is_finite()))).for_each(|p| *p = None);
    paces
}

/// Lengths grow no faster than allowed; what is not wanted at all takes the largest.
fn level(lengths: &mut [f64], length: f64) {
    let step = GROWTH * length / PLACES as f64;
    for k in 1..lengths.len() {
        lengths[k] = lengths[k].min(lengths[k - 1] + step);
    }
    for k in (1..lengths.len()).rev() {
        lengths[k - 1] = lengths[k - 1].min(lengths[k] + step);
    }
}

/// Wanted lengths along the stretches of one face.
fn of_face(input: &Input, layout: &Layout, f: usize, limits: &Limits) -> Vec<(usize, Vec<f64>)> {
    let own = &layout.faces[f];
    let surface = &input.model.surfaces[own.surface.index()].surface;
    if !own.free || surface.is_flat() {
        return Vec::new();
    }
    let mut found = Vec::new();
    for (k, side) in own.sides.iter().enumerate() {
        for u in &side.uses {
            let at = |i: usize| {
                let share = i as f64 / PLACES as f64;
                u.s.0 + (u.s.1 - u.s.0) * if u.against { 1.0 - share } else { share }
            };
            let mut lengths: Vec<f64> = (0..=PLACES).map(at).collect();
            if u.against {
                lengths.reverse();
            }
            let places = face::places(input, own, k, &lengths);
            let mut wanted: Vec<f64> = places
                .into_iter()
                .map(|place| (face::FILLED * bound::wanted(surface, place, limits.chord, limits.angle)).min(own.size.0))
                .collect();
            if u.against {
                wanted.reverse();
            }
            found.push((u.atom, wanted));
        }
    }
    found
}
