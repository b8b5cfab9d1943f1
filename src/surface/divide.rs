//! The part of a surface that holds a point, when curves divide it.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use super::closest::closest;
use super::core::{Border, Surface};
use super::faces::{Edge, Half, followers, loops, without_tails};
use super::plane;
use super::pull::{Course, is_pole};
use super::strands::{Piece, Strand, pieces, strands};
use super::trim::{Walk, assembled, shifts};
use crate::base::fault::{CutFault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;

/// Divides a surface by curves on it, together with its own border, and keeps the part with a point.
///
/// Curves may run on beyond each other; what hangs loose cuts nothing. E613 when a curve leaves the surface, E659 when one
/// of them cuts nothing off, E660 when the point is not on the surface, or on a cut.
pub fn divide(base: &Surface, cutters: &[Chain], keep: DVec3, origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let base = &plane::unmapped(base, tolerance)?;
    let foot = foot_of(base, cutters, keep, tolerance)?;
    let (pieces, edges) = dividing(base, cutters, tolerance)?;
    let division = Division::new(base, &pieces, &edges, tolerance);
    let Some(face) = division.face(foot) else {
        return Err(CutFault::KeepOff { surface: base.origin(), at: keep, off: 0.0, on: None, tolerance: tolerance.point }.into());
    };
    assembled(base, division.walks(face), origin)
}

/// All parts into which curves on a surface divide it, together with its own border; fails as [`divide`] does.
pub fn split(whole: &Surface, cutters: &[Chain], origin: Origin, tolerance: &Tolerance) -> Result<Vec<Surface>> {
    let base = &plane::unmapped(whole, tolerance)?;
    let (pieces, edges) = dividing(base, cutters, tolerance)?;
    let division = Division::new(base, &pieces, &edges, tolerance);
    let part = |face| Ok(assembled(base, division.walks(face), origin)?.cut_from(std::slice::from_ref(whole)));
    division.faces().into_iter().map(part).collect()
}

/// The pieces of the border and of curves that divide a surface, loose ends left out.
fn dividing(base: &Surface, cutters: &[Chain], tolerance: &Tolerance) -> Result<(Vec<Piece>, Vec<Edge>)> {
    let strands = strands(base, cutters, tolerance)?;
    let all = pieces(base, &strands, tolerance)?;
    let edges = graph(base, &all, tolerance);
    let stays = without_tails(&edges);
    for (k, cutter) in cutters.iter().enumerate() {
        let own = |i: &usize| strands[all[*i].strand].cutter == Some(k);
        let mut parts = (0..all.len()).filter(own).peekable();
        if parts.peek().is_some() && !parts.any(|i| stays[i]) {
            let ends = open_ends(cutter, &strands, &all, &stays, tolerance);
            return Err(CutFault::CutOpen { cutter: cutter.origin(), surface: base.origin(), ends }.into());
        }
    }
    let kept = || (0..all.len()).filter(|i| stays[*i]);
    Ok((kept().map(|i| all[i].clone()).collect(), kept().map(|i| edges[i].clone()).collect()))
}

/// The foot of the point to keep.
fn foot_of(base: &Surface, cutters: &[Chain], keep: DVec3, tolerance: &Tolerance) -> Result<DVec2> {
    let fault = |off: f64, on: Option<Origin>| CutFault::KeepOff { surface: base.origin(), at: keep, off, on, tolerance: tolerance.point };
    let near = closest(base, keep);
    if near.distance > tolerance.point {
        return Err(fault(near.distance, None).into());
    }
    if let Some(cutter) = cutters.iter().find(|c| c.closest(keep).2 <= tolerance.point) {
        return Err(fault(0.0, Some(cutter.origin())).into());
    }
    let below = closest(&base.untrimmed(), keep).uv;
    Ok(DVec2::new(below.0, below.1))
}

/// The ends of a cutter that are on nothing that divides the surface.
fn open_ends(cutter: &Chain, strands: &[Strand], all: &[Piece], stays: &[bool], tolerance: &Tolerance) -> Vec<DVec3> {
    let held = |p: DVec3| {
        let near = |piece: &Piece| match (&strands[piece.strand].chain, piece.own_chain()) {
            (_, Some(run)) | (Some(run), None) => run.closest(p).2 <= 2.0 * tolerance.point,
            (None, None) => piece.p.1.distance(p) <= 2.0 * tolerance.point,
        };
        all.iter().zip(stays).any(|(piece, stays)| *stays && near(piece))
    };
    let mut ends = vec![cutter.start(), cutter.end()];
    ends.retain(|p| !held(*p));
    ends
}

/// Vertices found by place, edges with their directions.
fn graph(base: &Surface, all: &[Piece], tolerance: &Tolerance) -> Vec<Edge> {
    let mut places: Vec<(DVec2, DVec3)> = Vec::new();
    let mut vertex = |uv: DVec2, p: DVec3| {
        let same = |(other, q): &(DVec2, DVec3)| {
            let near = if is_pole(base, uv) { NEAR.0 } else { NEAR.1 };
            q.distance(p) <= 4.0 * tolerance.point && (*other - uv).abs().max_element() <= near
        };
        places.iter().position(same).unwrap_or_else(|| {
            places.push((uv, p));
            places.len() - 1
        })
    };
    let ends: Vec<(usize, usize)> = all.iter().map(|piece| (vertex(piece.uv.0, piece.p.0), vertex(piece.uv.1, piece.p.2))).collect();
    // Curves that touch leave a vertex in one direction: at one distance from it they have parted, at one share of each perhaps not.
    let length = |piece: &Piece| match (&piece.course, piece.own_chain()) {
        (Course::Pull(pull), Some(chain)) => chain.length() * (pull.fraction(1.0) - pull.fraction(0.0)).abs(),
        _ => f64::INFINITY,
    };
    let mut shortest: BTreeMap<usize, f64> = BTreeMap::new();
    for (piece, ends) in all.iter().zip(&ends) {
        for vertex in [ends.0, ends.1] {
            let least = shortest.entry(vertex).or_insert(f64::INFINITY);
            *least = least.min(length(piece));
        }
    }
    let out = |piece: &Piece, ends: &(usize, usize)| {
        let place = |f: f64| match (&piece.course, piece.own_chain()) {
            (Course::Pull(pull), Some(chain)) => {
                let f = pull.fraction(f);
                super::pull::foot((base, None), chain.point(f), pull.guess(f)).0
            }
            (course, _) => {
                let places = course.places();
                places[0].lerp(places[places.len() - 1], f)
            }
        };
        let share = |vertex: usize| START * (shortest[&vertex] / length(piece)).min(1.0);
        let (first, last) = match length(piece).is_finite() {
            true => (share(ends.0), share(ends.1)),
            false => (START, START),
        };
        (place(first) - piece.uv.0, place(1.0 - last) - piece.uv.1)
    };
    all.iter().zip(ends).map(|(piece, ends)| Edge { ends, out: out(piece, &ends) }).collect()
}

/// Share of the shortest piece at a vertex at which directions out of it are taken.
const START: f64 = 0.01;
/// Places nearer in (u, v) than this may be one vertex: at a pole, elsewhere.
const NEAR: (f64, f64) = (NUDGE, 0.1);

/// The faces between pieces.
struct Division<'a> {
    base: &'a Surface,
    pieces: &'a [Piece],
    next: BTreeMap<Half, Half>,
    /// The loops of half edges, faces on their left, with their signed areas in (u, v).
    rows: Vec<Vec<Half>>,
    areas: Vec<f64>,
    point: f64,
    /// A step in (u, v) that is none.
    hair: f64,
}

/// The loops of the face that is kept, each half edge with the turns by which it is moved in (u, v).
type Face = Vec<Vec<(Half, DVec2)>>;

impl<'a> Division<'a> {
    fn new(base: &'a Surface, pieces: &'a [Piece], edges: &[Edge], tolerance: &Tolerance) -> Self {
        let next = followers(edges);
        let rows = loops(&next);
        let mut division = Self { base, pieces, next, rows, areas: Vec::new(), point: tolerance.point, hair: tolerance.parameter };
        division.areas = division.rows.iter().map(|row| division.area(row)).collect();
        division
    }
}

impl Division<'_> {
    fn polygon(&self, row: &[Half]) -> Vec<DVec2> {
        let each = |(k, backwards): &Half| {
            let mut places = self.pieces[*k].course.places();
            if *backwards {
                places.reverse();
            }
            places.pop();
            places
        };
        row.iter().flat_map(each).collect()
    }

    fn area(&self, row: &[Half]) -> f64 {
        let polygon = self.polygon(row);
        0.5 * (0..polygon.len()).map(|k| polygon[k].perp_dot(polygon[(k + 1) % polygon.len()])).sum::<f64>()
    }

    /// Whether a loop goes round a place.
    fn holds(&self, row: &[Half], p: DVec2) -> bool {
        let turn = |(k, backwards): &Half| {
            let piece = &self.pieces[*k];
            let turn = self.base.turn_along(&piece.course, piece.own_chain(), p);
            if *backwards { -turn } else { turn }
        };
        row.iter().map(turn).sum::<f64>().abs() > std::f64::consts::PI
    }

    /// The loops around a place: the smallest one that goes round it and those directly inside.
    fn face(&self, foot: DVec2) -> Option<Face> {
        let around = |p: DVec2| {
            let inner = (0..self.rows.len()).filter(|r| self.areas[*r] > 0.0 && self.holds(&self.rows[*r], p));
            inner.min_by(|a, b| self.areas[*a].total_cmp(&self.areas[*b]))
        };
        // On a seam, a pole or a border a place a hair inside decides.
        let hair = self.hair;
        let places =
            [DVec2::ZERO, DVec2::X * hair, DVec2::Y * hair, DVec2::X * -hair, DVec2::Y * -hair, DVec2::splat(hair), DVec2::splat(-hair)];
        let on_border = |p: DVec2| self.pieces.iter().any(|piece| piece.course.touches(p, 0.5 * hair));
        let near = places.into_iter().flat_map(|d| shifts(self.base).into_iter().map(move |by| foot + by + d));
        let outer = near.filter(|p| !on_border(*p)).find_map(around)?;
        Some(self.across_seams(outer).0)
    }

    /// All faces, each once.
    fn faces(&self) -> Vec<Face> {
        let (mut found, mut seen) = (Vec::new(), BTreeSet::new());
        for outer in (0..self.rows.len()).filter(|r| self.areas[*r] > self.hair * self.hair) {
            if seen.insert(outer) {
                let (face, rows) = self.across_seams(outer);
                seen.extend(rows);
                found.push(face);
            }
        }
        found
    }

    /// A loop and its holes: what goes round clockwise bounds from outside, and is a hole of the smallest face around it.
    fn with_holes(&self, outer: usize) -> Vec<usize> {
        let hole = |r: &usize| {
            let place = self.pieces[self.rows[*r][0].0].uv.0;
            self.areas[*r] < 0.0 && around_but(&self.rows, &self.areas, *r, |row| self.holds(row, place)) == Some(outer)
        };
        std::iter::once(outer).chain((0..self.rows.len()).filter(hole)).collect()
    }

    /// The face of a loop with what lies beyond seams, which are no borders of it, and the loops that it is made of.
    fn across_seams(&self, first: usize) -> (Face, BTreeSet<usize>) {
        let mut next = self.next.clone();
        let (mut moved, mut own): (BTreeMap<Half, DVec2>, BTreeSet<usize>) = (BTreeMap::new(), BTreeSet::new());
        let mut open: Vec<Half> = Vec::new();
        let mut enter = |row: usize, by: DVec2, moved: &mut BTreeMap<Half, DVec2>, open: &mut Vec<Half>| {
            for r in self.with_holes(row) {
                own.insert(r);
                for h in &self.rows[r] {
                    moved.insert(*h, by);
                    if self.pieces[h.0].seam {
                        open.push(*h);
                    }
                }
            }
        };
        enter(first, DVec2::ZERO, &mut moved, &mut open);
        open.sort_unstable();
        while let Some(half) = open.pop() {
            let Some(by) = moved.get(&half).copied() else { continue };
            let Some((twin, shift)) = self.twin(half) else { continue };
            match moved.get(&twin) {
                // Round the surface and back: the seam stays.
                Some(there) if (*there - by - shift).length() > 0.5 => continue,
                Some(_) => {}
                None => {
                    let Some(row) = self.rows.iter().position(|row| row.contains(&twin)) else { continue };
                    enter(row, by + shift, &mut moved, &mut open);
                }
            }
            let before = |next: &BTreeMap<Half, Half>, h: Half| next.iter().find(|(_, to)| **to == h).map(|(from, _)| *from);
            let (Some(p), Some(q)) = (before(&next, half), before(&next, twin)) else { continue };
            let (a, b) = (next[&half], next[&twin]);
            if p != twin {
                next.insert(p, b);
            }
            if q != half {
                next.insert(q, a);
            }
            for h in [half, twin] {
                next.remove(&h);
                moved.remove(&h);
            }
        }
        next.retain(|h, _| moved.contains_key(h));
        let face = loops(&next).into_iter().map(|row| row.into_iter().map(|h| (h, moved[&h])).collect()).collect();
        (face, own)
    }

    /// The half edge of the opposite seam at the same place, and how far it must be moved in (u, v) to lie on it.
    fn twin(&self, half: Half) -> Option<(Half, DVec2)> {
        let own = &self.pieces[half.0];
        let reach = 4.0 * self.point;
        let found = (0..self.pieces.len()).find(|k| {
            let other = &self.pieces[*k];
            *k != half.0 && other.seam && other.p.0.distance(own.p.2) <= reach && other.p.2.distance(own.p.0) <= reach
        })?;
        let twin = (found, half.1);
        Some((twin, own.uv.0 - self.pieces[found].uv.1))
    }

    /// The loops as walks, the outer one first.
    fn walks(&self, face: Face) -> Vec<Walk> {
        let mut walks: Vec<Walk> = face.iter().map(|row| self.walk(row)).collect();
        walks.sort_by(|a, b| b.area2().abs().total_cmp(&a.area2().abs()));
        walks
    }

    fn walk(&self, row: &[(Half, DVec2)]) -> Walk {
        let mut walk = Walk { borders: Vec::new(), courses: Vec::new(), chains: Vec::new() };
        for ((k, backwards), by) in row {
            let piece = &self.pieces[*k];
            let (border, course): (Border, Course) =
                if *backwards { (piece.border.turned(), piece.course.turned()) } else { (piece.border.clone(), piece.course.clone()) };
            if let super::core::Side::Chain { chain, .. } = &border.side {
                walk.chains.push(chain.clone());
            }
            walk.borders.push(border);
            walk.courses.push(course.shifted(*by));
        }
        walk
    }
}

/// The smallest loop around a place that is not of the same part of the graph.
fn around_but(rows: &[Vec<Half>], areas: &[f64], but: usize, holds: impl Fn(&[Half]) -> bool) -> Option<usize> {
    let touches = |r: usize| rows[r].iter().any(|h| rows[but].contains(&(h.0, !h.1)));
    let others = (0..rows.len()).filter(|r| areas[*r] > 0.0 && !touches(*r) && holds(&rows[*r]));
    others.min_by(|a, b| areas[*a].total_cmp(&areas[*b]))
}
