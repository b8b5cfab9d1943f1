//! Lines of a surface along which it turns back within less than a step, as at the leading edge of a wing: nodes on them keep sides from
//! passing over the fold.
//!
//! Only lines on which u or v stays are found. Where a surface turns back in another way, `tri/fold_check.rs` looks at its triangles.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::math::angle_between;
use crate::surface::Surface;

/// What steers the search for folds.
struct FoldSettings {
    /// Length along the surface within which it turns back, over the size.
    width: f64,
    /// The same over a chord error: wider folds have elements as short as that by their bends.
    width_over_chord: f64,
    /// Least distance of folds from each other, over the size: nearer ones are waves that elements pass over.
    min_apart: f64,
    /// How far it turns there at least, radians: 120°.
    min_turn: f64,
    /// Share of that turn in the inner half of the width, at least: a tube is bent all round.
    min_inner_share: f64,
    /// Lines across the fold that are looked at.
    lines: usize,
    /// Places along each to begin with.
    places: usize,
    /// Largest turn between two places, radians: 7.5°.
    max_turn: f64,
    /// Most times that what is between two places is halved.
    max_halvings: u32,
    /// Most places on a line: where a surface has no area its normals are noise.
    max_places: usize,
    /// Largest distance of the folds of lines from each other, over the width.
    max_spread: f64,
}

const SETTINGS: FoldSettings = FoldSettings {
    width: 0.5,
    width_over_chord: 2.0,
    min_apart: 1.0,
    min_turn: 2.094,
    min_inner_share: 0.7,
    lines: 5,
    places: 32,
    max_turn: 0.131,
    max_halvings: 24,
    max_places: 1 << 14,
    max_spread: 0.125,
};

/// A place on a line across, with the length up to there, how far the normals have turned, and the normal.
#[derive(Clone, Copy)]
struct FoldPlace {
    t: f64,
    length: f64,
    turned: f64,
    normal: DVec3,
}

/// Values of u (axis 0) or v (axis 1) within a box along which a surface is folded, for elements of a size within a chord error, ascending;
/// each with how far the line may be moved and still lie on the fold.
pub fn along(surface: &Surface, axis: usize, (low, high): (DVec2, DVec2), (size, chord): (f64, Option<f64>)) -> Vec<(f64, f64)> {
    let width = chord.map_or(f64::INFINITY, |chord| SETTINGS.width_over_chord * chord).min(SETTINGS.width * size);
    let across = |k: usize| {
        let other = 1 - axis;
        let at = low[other] + (high[other] - low[other]) * (k as f64 + 0.5) / SETTINGS.lines as f64;
        FoldLine { surface, axis, other: at, ends: (low[axis], high[axis]) }.folds(width, SETTINGS.min_apart * size)
    };
    let first = across(0);
    if first.is_empty() {
        return Vec::new();
    }
    let others: Vec<Vec<(f64, f64)>> = (1..SETTINGS.lines).map(across).collect();
    let near = |fold: &(f64, f64)| {
        let beside = |line: &Vec<(f64, f64)>| line.iter().copied().find(|other| (other.0 - fold.0).abs() <= fold.1.min(other.1));
        others.iter().map(beside).collect::<Option<Vec<_>>>()
    };
    let mean = |fold: &(f64, f64)| {
        near(fold).map(|others| {
            let sum = others.iter().fold(*fold, |(sum, least), other| (sum + other.0, least.min(other.1)));
            (sum.0 / SETTINGS.lines as f64, sum.1)
        })
    };
    first.iter().filter_map(mean).collect()
}

/// A line across, on which the other parameter stays.
struct FoldLine<'a> {
    surface: &'a Surface,
    axis: usize,
    other: f64,
    ends: (f64, f64),
}

impl FoldLine<'_> {
    fn place(&self, t: f64) -> (DVec3, DVec3) {
        let (u, v) = if self.axis == 0 { (t, self.other) } else { (self.other, t) };
        let jet = self.surface.jet(u, v);
        (jet.p, jet.du.cross(jet.dv).normalize_or_zero())
    }

    /// Places of folds that are so far from each other, each with how far in the parameter others may be from it to be the same.
    fn folds(&self, width: f64, apart: f64) -> Vec<(f64, f64)> {
        let places = self.places();
        if places.last().is_none_or(|last| last.turned < SETTINGS.min_turn) {
            return Vec::new();
        }
        let mut found: Vec<(f64, (f64, f64))> = Vec::new();
        let mut end = 0;
        let mut start = 0;
        while start < places.len() {
            while end + 1 < places.len() && places[end + 1].length - places[start].length <= width {
                end += 1;
            }
            match self.fold(&places[start..=end], width) {
                Some(fold) => {
                    found.push(fold);
                    start = end.max(start + 1);
                }
                None => start += 1,
            }
            end = end.max(start.min(places.len() - 1));
        }
        let is_alone = |k: usize| {
            let gap = |i: usize, j: usize| found[j].0 - found[i].0;
            (k == 0 || gap(k - 1, k) >= apart) && (k + 1 == found.len() || gap(k, k + 1) >= apart)
        };
        (0..found.len()).filter(|k| is_alone(*k)).map(|k| found[k].1).collect()
    }

    /// The fold of the places within a width, where they turn back about its middle, with the length up to there.
    fn fold(&self, within: &[FoldPlace], width: f64) -> Option<(f64, (f64, f64))> {
        let (first, last) = (within.first()?, within.last()?);
        let turn = last.turned - first.turned;
        if turn < SETTINGS.min_turn || angle_between(first.normal, last.normal) < SETTINGS.min_turn {
            return None;
        }
        let middle = first.turned + 0.5 * turn;
        let k = within.partition_point(|place| place.turned < middle).max(1);
        let (a, b) = (within[k - 1], within[k]);
        let share = ((middle - a.turned) / (b.turned - a.turned)).clamp(0.0, 1.0);
        let (t, length) = (a.t + (b.t - a.t) * share, a.length + (b.length - a.length) * share);
        let inner = within.iter().filter(|place| (place.length - length).abs() <= 0.25 * width);
        let (least, most) = inner.fold((f64::INFINITY, 0.0_f64), |(l, m), place| (l.min(place.turned), m.max(place.turned)));
        // The whole width lies about the fold, which is not at an end of the line.
        let is_inside = last.length - first.length > 0.5 * width && most - least >= SETTINGS.min_inner_share * turn;
        let speed = (last.t - first.t) / (last.length - first.length);
        is_inside.then_some((length, (t, SETTINGS.max_spread * width * speed)))
    }

    /// Places so dense that normals turn little between them.
    fn places(&self) -> Vec<FoldPlace> {
        let (low, high) = self.ends;
        let t = |k: usize| low + (high - low) * k as f64 / SETTINGS.places as f64;
        let mut before = (t(0), self.place(t(0)));
        let mut found = vec![FoldPlace { t: before.0, length: 0.0, turned: 0.0, normal: before.1.1 }];
        let mut open: Vec<(f64, (DVec3, DVec3), u32)> = (1..=SETTINGS.places).rev().map(|k| (t(k), self.place(t(k)), 0)).collect();
        while let Some((to, (p, normal), halvings)) = open.pop() {
            let turn = if normal == DVec3::ZERO || before.1.1 == DVec3::ZERO { 0.0 } else { angle_between(before.1.1, normal) };
            job::poll();
            let has_room = halvings < SETTINGS.max_halvings && found.len() + open.len() < SETTINGS.max_places;
            if turn > SETTINGS.max_turn && has_room {
                let middle = 0.5 * (before.0 + to);
                open.push((to, (p, normal), halvings + 1));
                open.push((middle, self.place(middle), halvings + 1));
                continue;
            }
            let last = found[found.len() - 1];
            let length = last.length + p.distance(before.1.0);
            found.push(FoldPlace { t: to, length, turned: last.turned + turn, normal });
            before = (to, (p, normal));
        }
        found
    }
}
