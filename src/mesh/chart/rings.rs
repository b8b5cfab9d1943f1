//! Rings of nodes that stay, through the nodes of a seam, where the way round a face is short: with fewer than three nodes all round,
//! as towards a sharp tip, the elements on both sides of the seam would have the same nodes.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::mesh::border::layout::Face;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::face_border::{FaceBorder, ONE_PLACE};
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::chart::outline::Outline;
use crate::surface::Surface;

/// What steers rings.
struct RingSettings {
    /// Nodes of a ring, at least and at most.
    nodes: (f64, f64),
    /// Steps of the seam all round the face from which on elements go round it by themselves.
    max_steps_round: f64,
    /// Pieces of a way round a face by which it is measured.
    pieces: u32,
}

const SETTINGS: RingSettings = RingSettings { nodes: (3.0, 5.0), max_steps_round: 5.0, pieces: 16 };

/// Length of the way over a surface that is straight in (u, v).
pub(crate) fn way_round(surface: &Surface, from: (f64, f64), to: (f64, f64)) -> f64 {
    let at = |k: u32| {
        let (u, v) = DVec2::from(from).lerp(DVec2::from(to), f64::from(k) / f64::from(SETTINGS.pieces)).into();
        surface.point(u, v)
    };
    (0..SETTINGS.pieces).map(|k| at(k).distance(at(k + 1))).sum()
}

/// Adds rings where the face has one seam.
pub(crate) fn add_rings(context: &FaceInput, face: &Face, border: &FaceBorder, chart: &Chart, outline: &mut Outline) {
    let mut places: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    border.ids.iter().zip(0..).for_each(|(id, n)| places.entry(*id).or_default().push(n));
    // What turns back along itself has no way round.
    let turns = face.turns().next().is_some();
    if turns || !face.lines.is_empty() || !face.points.is_empty() || places.values().any(|places| places.len() > 2) {
        return;
    }
    let mut beside = vec![Vec::new(); border.ids.len()];
    for [a, b] in &border.edges {
        beside[*a as usize].push(*b);
        beside[*b as usize].push(*a);
    }
    let id = |n: u32| border.ids[n as usize];
    let twice = |n: &u32| places[&id(*n)].len() == 2;
    let is_pole = |n: u32| beside[n as usize].iter().any(|o| id(*o) == id(n));
    for both in places.values() {
        let &[s, t] = both.as_slice() else { continue };
        // Ends of the seam are on other borders, or in a pole.
        if is_pole(s) || !beside[s as usize].iter().chain(&beside[t as usize]).all(twice) {
            continue;
        }
        let surface = chart.surface();
        let (from, to) = (border.uv[s as usize], border.uv[t as usize]);
        if (from.1 - to.1).abs() > ONE_PLACE {
            continue;
        }
        let here = context.points[id(s) as usize];
        let step = beside[s as usize].iter().map(|o| context.points[id(*o) as usize].distance(here)).fold(0.0, f64::max);
        let round = way_round(surface, from, to);
        if round >= SETTINGS.max_steps_round * step {
            continue;
        }
        let n = (round / step).round().clamp(SETTINGS.nodes.0, SETTINGS.nodes.1) as u32;
        let mut last = s;
        for k in 1..n {
            // On one line to the last digit, or three of them could be a triangle in space that is none in the chart.
            let (u, v) = (from.0 + (to.0 - from.0) * f64::from(k) / f64::from(n), from.1);
            outline.xy.push(chart.xy((u, v)));
            outline.p.push(surface.point(u, v));
            let new = outline.p.len() as u32 - 1;
            outline.lines.push([last, new]);
            last = new;
        }
        outline.lines.push([last, t]);
        outline.xy[t as usize] = chart.xy((to.0, from.1));
    }
}
