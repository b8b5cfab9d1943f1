//! Cells between the pieces of borders and cutters in (u, v), and the faces that they make across the seams of a closed surface.
//!
//! A cell is a loop of half edges with what lies on its left and the loops directly inside. A seam lies twice in (u, v), a whole
//! turn apart, once for each of its sides; a piece of it and its twin are found by that. A face is made of the cells that hang
//! together across seams: they are moved by whole turns, beginning with one of them, until they lie side by side, and the seams
//! between cells that do are no borders of it. A seam round which the face closes on itself stays.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use glam::{DVec2, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::tolerance::{TOLD_APART, Tolerance};
use crate::network::Chain;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::faults::CutFault;
use crate::surface::rails::trim_curve::TrimCurve;
use crate::surface::trims::cutters::Piece;
use crate::surface::trims::faces::{Edge, Half, components, followers, is_plane, loops};
use crate::surface::trims::trim_loop::shifts;

/// The loops of a face, each half edge with the turns by which it is moved in (u, v).
pub(crate) type FaceLoops = Vec<Vec<(Half, DVec2)>>;

/// Ends of twins are no farther from each other than this, in (u, v) after whole turns.
const NEAR: f64 = 0.1;

/// Places along a piece at which others are looked for beside it, and how many times as far from its ends.
const MAX_SAMPLES: usize = 16;
const BESIDE: f64 = 4.0;

/// The cells between pieces.
pub(crate) struct Cells<'a> {
    base: &'a Surface,
    pieces: &'a [Piece],
    next: BTreeMap<Half, Half>,
    /// The loops of half edges, faces on their left, with their signed areas in (u, v).
    rows: Vec<Vec<Half>>,
    areas: Vec<f64>,
    /// The loops of each cell, the outer one first.
    cells: Vec<Vec<usize>>,
    /// The cell on the left of a half edge; none beyond the border of the surface.
    left: BTreeMap<Half, usize>,
    /// The other side of each piece of a seam, and how far it must be moved in (u, v) to lie on it.
    twins: BTreeMap<usize, (usize, DVec2)>,
    /// Smallest step in (u, v) that counts.
    step: f64,
    /// The model's tolerance.
    point: f64,
}

impl<'a> Cells<'a> {
    /// Fails where the pieces bound no cells that make up the surface: E721 where they are too near to each other for that, else it is
    /// a bug.
    pub fn new(base: &'a Surface, pieces: &'a [Piece], edges: &[Edge], tolerance: &Tolerance) -> Result<Self> {
        let next = followers(edges);
        let rows = loops(&next);
        let (areas, cells) = (Vec::new(), Vec::new());
        let step = tolerance.parameter;
        let mut made =
            Self { base, pieces, next, rows, areas, cells, left: BTreeMap::new(), twins: BTreeMap::new(), step, point: tolerance.point };
        made.areas = made.rows.iter().map(|row| made.area(row)).collect();
        if !is_plane(edges, &made.rows) {
            let crowded = [BESIDE, 1.0].into_iter().find_map(|beside| made.rows.iter().find_map(|row| made.crowded(row, beside)));
            return Err(crowded.unwrap_or_else(|| made.fault("loops leave a vertex in a wrong order", made.rows[0][0])));
        }
        made.bound(edges)?;
        made.pair(tolerance)?;
        Ok(made)
    }

    /// Gathers loops to cells.
    fn bound(&mut self, edges: &[Edge]) -> Result<()> {
        let beyond = |h: &Half| h.1 && self.pieces[h.0].rim;
        let outside: Vec<bool> = self.rows.iter().map(|row| row.iter().any(beyond)).collect();
        if let Some(r) = (0..self.rows.len()).find(|r| outside[*r] && !self.rows[*r].iter().all(beyond)) {
            return Err(self.crowded(&self.rows[r], BESIDE).unwrap_or_else(|| self.fault("a part runs over the border", self.rows[r][0])));
        }
        let outer: Vec<usize> = (0..self.rows.len()).filter(|r| !outside[*r] && self.areas[*r] > self.step * self.step).collect();
        let mut cells: BTreeMap<usize, Vec<usize>> = outer.iter().map(|r| (*r, vec![*r])).collect();
        let graph = components(edges);
        let part = |r: usize| graph[edges[self.rows[r][0].0].ends.0];
        for r in (0..self.rows.len()).filter(|r| !outside[*r] && self.areas[*r] < 0.0) {
            let place = self.pieces[self.rows[r][0].0].uv.0;
            let around = outer.iter().filter(|o| part(**o) != part(r) && self.holds(&self.rows[**o], place));
            match around.min_by(|a, b| self.areas[**a].total_cmp(&self.areas[**b])) {
                Some(o) => cells.entry(*o).or_default().push(r),
                None if self.base.domain() == Domain::Unbounded => {}
                None => {
                    return Err(self
                        .crowded(&self.rows[r], BESIDE)
                        .unwrap_or_else(|| self.fault("a loop lies in no part", self.rows[r][0])));
                }
            }
        }
        self.cells = cells.into_values().collect();
        for (c, rows) in self.cells.iter().enumerate() {
            self.left.extend(rows.iter().flat_map(|r| &self.rows[*r]).map(|h| (*h, c)));
        }
        Ok(())
    }

    /// Finds the twins of seams.
    fn pair(&mut self, tolerance: &Tolerance) -> Result<()> {
        let (reach, (closed_u, closed_v)) = (TOLD_APART * tolerance.point, self.base.closed());
        let seams: Vec<usize> = (0..self.pieces.len()).filter(|k| self.pieces[*k].seam).collect();
        let turn = |x: f64, closed: bool| if closed { x.round() } else { 0.0 };
        let twin = |a: &Piece, k: usize| -> Option<(f64, usize, DVec2)> {
            let b = &self.pieces[k];
            let (first, last) = (a.uv.0 - b.uv.1, a.uv.1 - b.uv.0);
            let by = DVec2::new(turn(first.x, closed_u), turn(first.y, closed_v));
            let off = (first - by).abs().max_element().max((last - by).abs().max_element());
            let one = b.p.0.distance(a.p.2) <= reach && b.p.2.distance(a.p.0) <= reach;
            (one && by != DVec2::ZERO && off <= NEAR).then_some((off, k, by))
        };
        for &k in &seams {
            let found = seams.iter().filter(|other| **other != k).filter_map(|other| twin(&self.pieces[k], *other));
            if let Some((_, other, by)) = found.min_by(|a, b| a.0.total_cmp(&b.0)) {
                self.twins.insert(k, (other, by));
            }
        }
        let twins = self.twins.clone();
        self.twins.retain(|k, (other, _)| twins.get(other).is_some_and(|back| back.0 == *k));
        // A part of a closed surface may have one side of a seam only; the whole has both.
        let single = seams.into_iter().find(|k| self.base.domain() != Domain::Loop && !self.twins.contains_key(k));
        single.map_or(Ok(()), |k| Err(self.fault("a seam has one side", (k, false))))
    }

    fn fault(&self, what: &'static str, half: Half) -> Fault {
        let at: DVec3 = self.pieces[half.0].p.1;
        CutFault::NotDivided { surface: self.base.origin(), what, at }.into()
    }

    /// E721 where a piece of a loop that bounds no cell is as short as vertices are taken as one, or runs that near beside another piece,
    /// `beside` times as far from its ends.
    fn crowded(&self, row: &[Half], beside: f64) -> Option<Fault> {
        let near = TOLD_APART * self.point;
        let chain = |k: usize| self.pieces[k].own_chain();
        let fault = |k: usize, other: usize, at: DVec3, apart: f64| {
            let cut = |k: usize| chain(k).map_or(self.base.origin(), Chain::origin);
            CutFault::CutsTooNear { surface: self.base.origin(), cuts: [cut(k), cut(other)], at, apart, tolerance: self.point }
        };
        let length = |k: &usize| {
            let (a, middle, b) = self.pieces[*k].p;
            a.distance(middle) + middle.distance(b)
        };
        let at_corner = |k: &usize| {
            let corner = |p: DVec3| row.iter().map(|h| self.pieces[h.0].p).any(|own| own.0.distance(p).min(own.2.distance(p)) <= near);
            corner(self.pieces[*k].p.0) || corner(self.pieces[*k].p.2)
        };
        let mut short = (0..self.pieces.len()).filter(|k| chain(*k).is_some() && length(k) <= near && at_corner(k));
        if let Some(k) = short.next() {
            return Some(fault(k, k, self.pieces[k].p.1, length(&k)).into());
        }
        let mut least: Option<(f64, CutFault)> = None;
        for k in row.iter().map(|h| h.0) {
            let Some(own) = chain(k) else { continue };
            let piece = &self.pieces[k];
            let TrimCurve::Pcurve(pcurve) = &piece.trim_curve else { continue };
            let places = (1..MAX_SAMPLES).map(|n| pcurve.fraction(n as f64 / MAX_SAMPLES as f64)).map(|f| (own.point(f), pcurve.guess(f)));
            // Where pieces part they are near to each other in any case.
            for (at, uv) in places.filter(|(p, _)| p.distance(piece.p.0).min(p.distance(piece.p.2)) > beside * near) {
                for other in (0..self.pieces.len()).filter(|other| *other != k && self.pieces[*other].trim_curve.passes(uv, NEAR)) {
                    let apart = chain(other).map_or(f64::INFINITY, |chain| chain.closest(at).2);
                    if apart <= near && least.as_ref().is_none_or(|least| apart < least.0) {
                        least = Some((apart, fault(k, other, at, apart)));
                    }
                }
            }
        }
        least.map(|least| least.1.into())
    }

    fn area(&self, row: &[Half]) -> f64 {
        let each = |(k, backwards): &Half| {
            let mut places = self.pieces[*k].trim_curve.places();
            if *backwards {
                places.reverse();
            }
            places.pop();
            places
        };
        let polygon: Vec<DVec2> = row.iter().flat_map(each).collect();
        0.5 * (0..polygon.len()).map(|k| polygon[k].perp_dot(polygon[(k + 1) % polygon.len()])).sum::<f64>()
    }

    /// Whether a loop goes round a place.
    fn holds(&self, row: &[Half], p: DVec2) -> bool {
        let turn = |(k, backwards): &Half| {
            let piece = &self.pieces[*k];
            let turn = self.base.turn_along(&piece.trim_curve, piece.own_chain(), p);
            if *backwards { -turn } else { turn }
        };
        row.iter().map(turn).sum::<f64>().abs() > std::f64::consts::PI
    }

    /// The face around a place: that of the smallest cell whose outer loop goes round it.
    pub fn face(&self, foot: DVec2) -> Result<Option<FaceLoops>> {
        self.at(foot).map(|c| self.joined(c).map(|(face, _)| face)).transpose()
    }

    /// The smallest cell whose outer loop goes round a place.
    pub fn at(&self, foot: DVec2) -> Option<usize> {
        let around = |p: DVec2| {
            let holding = (0..self.cells.len()).filter(|c| self.holds(&self.rows[self.cells[*c][0]], p));
            holding.min_by(|a, b| self.areas[self.cells[*a][0]].total_cmp(&self.areas[self.cells[*b][0]]))
        };
        // On a seam, a pole or a border a place one step inside decides.
        let step = self.step;
        let places =
            [DVec2::ZERO, DVec2::X * step, DVec2::Y * step, DVec2::X * -step, DVec2::Y * -step, DVec2::splat(step), DVec2::splat(-step)];
        let on_border = |p: DVec2| self.pieces.iter().any(|piece| piece.trim_curve.touches(p, 0.5 * step));
        let mut copies = self.base.copies(foot.into());
        copies.extend(shifts(self.base).into_iter().map(|by| foot + by));
        let near = places.into_iter().flat_map(|d| copies.iter().map(move |at| *at + d));
        near.filter(|p| !on_border(*p)).find_map(around)
    }

    /// How many cells there are.
    pub fn count(&self) -> usize {
        self.cells.len()
    }

    /// The cells on the left of a piece and on its right; none beyond the border of the surface.
    pub fn beside(&self, piece: usize) -> [Option<usize>; 2] {
        [false, true].map(|backwards| self.left.get(&(piece, backwards)).copied())
    }

    /// The other side of a piece of a seam.
    pub fn twin(&self, piece: usize) -> Option<usize> {
        self.twins.get(&piece).map(|(twin, _)| *twin)
    }

    /// The area of a cell in (u, v).
    pub fn size(&self, cell: usize) -> f64 {
        self.cells[cell].iter().map(|row| self.areas[*row]).sum()
    }

    /// The faces that some cells make, each once; they go on over no piece but those of seams.
    pub fn faces_of(&self, kept: &[bool]) -> Result<Vec<FaceLoops>> {
        let (mut found, mut seen) = (Vec::new(), BTreeSet::new());
        for c in (0..self.cells.len()).filter(|c| kept[*c]) {
            if !seen.contains(&c) {
                let (face, cells) = self.joined(c)?;
                seen.extend(cells);
                found.push(face);
            }
        }
        Ok(found)
    }

    /// All faces, each once.
    pub fn faces(&self) -> Result<Vec<FaceLoops>> {
        self.faces_of(&vec![true; self.cells.len()])
    }

    /// The seams on the border of a cell, each with its twin and the turns by which that must be moved.
    fn seams(&self, cell: usize) -> Vec<(usize, usize, DVec2)> {
        let halves = self.cells[cell].iter().flat_map(|r| &self.rows[*r]).filter(|h| !h.1);
        let mut seams: Vec<(usize, usize, DVec2)> = halves.filter_map(|h| self.twins.get(&h.0).map(|(t, by)| (h.0, *t, *by))).collect();
        seams.sort_unstable_by_key(|s| s.0);
        seams
    }

    /// The face of a cell with what lies beyond seams, which are no borders of it, and the cells that it is made of.
    fn joined(&self, first: usize) -> Result<(FaceLoops, BTreeSet<usize>)> {
        let (mut by, mut open) = (BTreeMap::from([(first, DVec2::ZERO)]), VecDeque::from([first]));
        let mut between: Vec<(usize, usize)> = Vec::new();
        while let Some(cell) = open.pop_front() {
            for (seam, twin, turn) in self.seams(cell) {
                let Some(beyond) = self.left.get(&(twin, false)).copied() else { continue };
                let there = by[&cell] + turn;
                let placed = *by.entry(beyond).or_insert_with(|| {
                    open.push_back(beyond);
                    there
                });
                // Otherwise round the surface and back: the seam stays.
                if (placed - there).length() < 0.5 && seam < twin {
                    between.push((seam, twin));
                }
            }
        }
        let halves = |c: &usize| self.cells[*c].iter().flat_map(|r| &self.rows[*r]).copied().collect::<Vec<Half>>();
        let mut next: BTreeMap<Half, Half> = by.keys().flat_map(halves).map(|h| (h, self.next[&h])).collect();
        let mut before: BTreeMap<Half, Half> = next.iter().map(|(from, to)| (*to, *from)).collect();
        for (a, b) in between {
            let (a, b) = ((a, false), (b, false));
            let ends = (before.get(&a).copied(), next.get(&a).copied(), before.get(&b).copied(), next.get(&b).copied());
            let (Some(to_a), Some(from_a), Some(to_b), Some(from_b)) = ends else { return Err(self.fault("a seam is joined twice", a)) };
            for h in [a, b] {
                next.remove(&h);
                before.remove(&h);
            }
            for (from, to) in [(to_a, from_b), (to_b, from_a)] {
                if from != a && from != b && to != a && to != b {
                    next.insert(from, to);
                    before.insert(to, from);
                }
            }
        }
        if next.values().any(|h| !next.contains_key(h)) {
            return Err(self.fault("a part is not closed", self.rows[self.cells[first][0]][0]));
        }
        let moved = |h: Half| (h, self.left.get(&h).and_then(|c| by.get(c)).copied().unwrap_or(DVec2::ZERO));
        let face = loops(&next).into_iter().map(|row| row.into_iter().map(moved).collect()).collect();
        Ok((face, by.into_keys().collect()))
    }
}
