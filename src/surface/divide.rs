//! The part of a surface that holds a point, when curves divide it.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::closest::closest;
use super::core::{Border, Surface};
use super::faces::{Edge, Half, followers, loops, without_tails};
use super::plane;
use super::pull::{Course, is_pole};
use super::strands::{Piece, pieces, strands};
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
    let strands = strands(base, cutters, tolerance)?;
    let all = pieces(base, &strands, tolerance)?;
    let edges = graph(base, &all, tolerance);
    let stays = without_tails(&edges);
    for (k, cutter) in cutters.iter().enumerate() {
        let own = |i: &usize| strands[all[*i].strand].cutter == Some(k);
        let mut parts = (0..all.len()).filter(own).peekable();
        if parts.peek().is_some() && !parts.any(|i| stays[i]) {
            let at = open_end(cutter, &all, &edges, k, &|s| strands[s].cutter);
            return Err(CutFault::CutOpen { cutter: cutter.origin(), surface: base.origin(), at }.into());
        }
    }
    let kept: Vec<usize> = (0..all.len()).filter(|i| stays[*i]).collect();
    let all: Vec<Piece> = kept.iter().map(|i| all[*i].clone()).collect();
    let edges: Vec<Edge> = kept.iter().map(|i| edges[*i].clone()).collect();
    let division = Division { base, pieces: &all, next: followers(&edges), point: tolerance.point, hair: tolerance.parameter };
    let Some(face) = division.face(foot) else {
        return Err(CutFault::KeepOff { surface: base.origin(), at: keep, off: 0.0, on: None, tolerance: tolerance.point }.into());
    };
    assembled(base, division.walks(face), origin)
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

/// The end of a cutter that hangs loose.
fn open_end(cutter: &Chain, all: &[Piece], edges: &[Edge], k: usize, cutter_of: &dyn Fn(usize) -> Option<usize>) -> DVec3 {
    let mut degree: BTreeMap<usize, usize> = BTreeMap::new();
    for edge in edges {
        *degree.entry(edge.ends.0).or_default() += 1;
        *degree.entry(edge.ends.1).or_default() += 1;
    }
    let own = (0..all.len()).filter(|i| cutter_of(all[*i].strand) == Some(k));
    let mut ends = own.flat_map(|i| [(edges[i].ends.0, all[i].p.0), (edges[i].ends.1, all[i].p.2)]);
    ends.find(|(v, _)| degree[v] == 1).map_or(cutter.end(), |(_, p)| p)
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
    let out = |piece: &Piece| {
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
        (place(START) - piece.uv.0, place(1.0 - START) - piece.uv.1)
    };
    all.iter().zip(ends).map(|(piece, ends)| Edge { ends, out: out(piece) }).collect()
}

/// Share of a piece at which its direction out of an end is taken.
const START: f64 = 0.01;
/// Places nearer in (u, v) than this may be one vertex: at a pole, elsewhere.
const NEAR: (f64, f64) = (NUDGE, 0.1);

/// The faces between pieces.
struct Division<'a> {
    base: &'a Surface,
    pieces: &'a [Piece],
    next: BTreeMap<Half, Half>,
    point: f64,
    /// A step in (u, v) that is none.
    hair: f64,
}

/// The loops of the face that is kept, each half edge with the turns by which it is moved in (u, v).
type Face = Vec<Vec<(Half, DVec2)>>;

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
        let rows = loops(&self.next);
        let areas: Vec<f64> = rows.iter().map(|row| self.area(row)).collect();
        let around = |p: DVec2| {
            let inner = (0..rows.len()).filter(|r| areas[*r] > 0.0 && self.holds(&rows[*r], p));
            inner.min_by(|a, b| areas[*a].total_cmp(&areas[*b]))
        };
        // On a seam, a pole or a border a place a hair inside decides.
        let hair = self.hair;
        let places =
            [DVec2::ZERO, DVec2::X * hair, DVec2::Y * hair, DVec2::X * -hair, DVec2::Y * -hair, DVec2::splat(hair), DVec2::splat(-hair)];
        let on_border = |p: DVec2| self.pieces.iter().any(|piece| piece.course.touches(p, 0.5 * hair));
        let near = places.into_iter().flat_map(|d| shifts(self.base).into_iter().map(move |by| foot + by + d));
        let outer = near.filter(|p| !on_border(*p)).find_map(around)?;
        // What goes round clockwise bounds from outside: a hole of the smallest face around it.
        let hole = |r: &usize| {
            let place = self.pieces[rows[*r][0].0].uv.0;
            areas[*r] < 0.0 && around_but(&rows, &areas, *r, |row| self.holds(row, place)) == Some(outer)
        };
        let mut loops_of: Vec<usize> = vec![outer];
        loops_of.extend((0..rows.len()).filter(hole));
        Some(self.across_seams(loops_of.into_iter().map(|r| rows[r].clone()).collect(), &rows))
    }

    /// The same with what lies beyond seams, which are no borders of it.
    fn across_seams(&self, first: Vec<Vec<Half>>, rows: &[Vec<Half>]) -> Face {
        let mut next = self.next.clone();
        let mut moved: BTreeMap<Half, DVec2> = first.iter().flatten().map(|h| (*h, DVec2::ZERO)).collect();
        let mut open: Vec<Half> = moved.keys().copied().filter(|h| self.pieces[h.0].seam).collect();
        while let Some(half) = open.pop() {
            let Some(by) = moved.get(&half).copied() else { continue };
            let Some((twin, shift)) = self.twin(half) else { continue };
            match moved.get(&twin) {
                // Round the surface and back: the seam stays.
                Some(there) if (*there - by - shift).length() > 0.5 => continue,
                Some(_) => {}
                None => {
                    let Some(row) = rows.iter().find(|row| row.contains(&twin)) else { continue };
                    for h in row {
                        moved.insert(*h, by + shift);
                        if self.pieces[h.0].seam {
                            open.push(*h);
                        }
                    }
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
        loops(&next).into_iter().map(|row| row.into_iter().map(|h| (h, moved[&h])).collect()).collect()
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
