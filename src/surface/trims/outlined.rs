//! The faces that loops bound on a surface, as CAD systems write them: a seam run twice, poles, loops round the surface, loops in any
//! order, a border of the surface left out.
//!
//! Curves that a loop runs there and back bound nothing and are taken out. The others, with the border and the seams of the surface,
//! part it into cells (`cells.rs`): of the two cells beside each curve one is kept. That leaves two choices for all cells that hang
//! together; the border of the surface, what is known to be inside the face and the directions of the loops say which is meant.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::tolerance::{ROUNDING_SHARE, Tolerance};
use crate::network::Chain;
use crate::surface::closest::nearest::Nearest;
use crate::surface::core::plane;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::faults::BorderFault;
use crate::surface::rails::side::Side;
use crate::surface::rails::trim_curve::TrimCurve;
use crate::surface::trims::cells::Cells;
use crate::surface::trims::cutters::{Meets, Piece};
use crate::surface::trims::divide::{dividing, trim_loops};
use crate::surface::trims::trim_loop::{assembled, shifts};

/// Where two curves are compared, as shares of their lengths.
const SHARES: [f64; 5] = [0.0, 0.23, 0.48, 0.77, 1.0];
/// A curve and one beside it within so many tolerances are one.
const ONE: f64 = 2.0;
/// Where a piece is asked what lies along it: no place that is special for anything.
const MIDDLE: f64 = 0.4873;

/// What is known of the loops of a face beside their curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlined {
    /// One of the loops bounds the face from outside; else the border of the surface does.
    pub has_outer: bool,
    /// A point inside the face, where one is known.
    pub inside: Option<DVec3>,
    /// Loops have the face on their right.
    pub against: bool,
}

/// What was asked which side of loops is the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// Where the border of the surface has no curve.
    Border,
    /// Curves that are run there and back, inside the face.
    Inner,
    /// A point inside the face.
    Point,
    /// The directions of the loops.
    Directions,
    /// Which of both sides is smaller, or larger where no loop bounds the face from outside.
    Size,
}

/// A side of loops that was kept although not everything speaks for it: the other side has another area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doubt {
    /// What decided.
    pub by: Ground,
    /// Share of it that speaks for the side that was kept, from 0.5 to 1.
    pub share: f64,
    /// A place on one of the loops.
    pub at: DVec3,
}

/// The parts of a surface on the left of loops, each given by its curves in the direction of the loop; one for each outer loop.
///
/// Where the surface closes loops may run along its seam twice, over it, round the surface and through poles; curves shorter than the
/// tolerance are left out. The direction of the loops decides only where nothing else does. Where what decides speaks for both sides the
/// larger share of it is followed, and reported. Fails with E502 or E659 where a loop does not
/// close, E612 where the loops bound nothing, E613 when a curve leaves the surface.
pub fn outlined(
    base: &Surface,
    loops: &[Vec<Chain>],
    known: Outlined,
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<(Vec<Surface>, Vec<Doubt>)> {
    let mut base = plane::unmapped(base, tolerance)?;
    if base.domain() == Domain::Unbounded {
        base = plane::over(&base, loops.iter().flatten().map(Chain::bbox).fold(Box3::EMPTY, Box3::union));
    }
    let given = loops.iter().flatten().filter(|c| c.length() > tolerance.point).cloned().collect();
    let (borders, inner) = there_and_back(given, tolerance);
    if borders.is_empty() {
        return Ok((vec![base], Vec::new()));
    }
    let dividing = dividing(&base, &borders, Meets::AtEnds, tolerance)?;
    let cells = Cells::new(&base, &dividing.pieces, &dividing.edges, tolerance)?;
    let sides = Sides { base: &base, pieces: &dividing.pieces, cells: &cells, borders: &borders, known, tolerance };
    let Some((kept, doubts)) = sides.kept(&inner) else { return Err(sides.nothing(origin).into()) };
    let faces = cells.faces_of(&kept)?;
    let made: Result<Vec<Surface>> = faces.iter().map(|face| assembled(&base, trim_loops(&dividing.pieces, face), origin)).collect();
    Ok((made?, doubts))
}

/// Curves without those that are run once each way, and the latter.
fn there_and_back(curves: Vec<Chain>, tolerance: &Tolerance) -> (Vec<Chain>, Vec<Chain>) {
    let back = |a: &Chain, b: &Chain| {
        let room = ONE * tolerance.point;
        (a.length() - b.length()).abs() <= room.max(tolerance.point * a.length())
            && SHARES.iter().all(|f| b.closest(a.point(*f)).2 <= room && a.closest(b.point(*f)).2 <= room)
            && a.jet(MIDDLE).d1.dot(b.jet(b.closest(a.point(MIDDLE)).0).d1) < 0.0
    };
    let mut open: Vec<Chain> = Vec::with_capacity(curves.len());
    let mut inner = Vec::new();
    for curve in curves {
        let near = |other: &Chain| other.bbox().touches(&curve.bbox(), tolerance.point) && back(other, &curve);
        match open.iter().position(near) {
            Some(k) => inner.push(open.remove(k)),
            None => open.push(curve),
        }
    }
    (open, inner)
}

/// What the cells on the sides of pieces have to do with each other.
#[derive(Clone, Copy, Debug)]
enum Tie {
    /// A seam between them: both are kept or neither.
    Same,
    /// A curve of a loop between them: one is kept.
    Other,
}

/// What speaks for keeping a cell, strongest first: as [`GROUNDS`].
type Votes = [f64; 5];
const GROUNDS: [Ground; 5] = [Ground::Border, Ground::Inner, Ground::Point, Ground::Directions, Ground::Size];

struct Sides<'a> {
    base: &'a Surface,
    pieces: &'a [Piece],
    cells: &'a Cells<'a>,
    borders: &'a [Chain],
    known: Outlined,
    tolerance: &'a Tolerance,
}

impl Sides<'_> {
    /// Which cells make the face, with what speaks for others too; none where no choice has it on one side of each curve.
    fn kept(&self, inner: &[Chain]) -> Option<(Vec<bool>, Vec<Doubt>)> {
        let ties = self.ties();
        let votes = self.votes(inner);
        let n = self.cells.count();
        let mut beside: Vec<Vec<(usize, bool)>> = vec![Vec::new(); n];
        for (a, b, tie) in ties {
            let turns = matches!(tie, Tie::Other);
            beside[a].push((b, turns));
            beside[b].push((a, turns));
        }
        let mut side: Vec<Option<bool>> = vec![None; n];
        let (mut kept, mut doubts) = (vec![false; n], Vec::new());
        for first in 0..n {
            if side[first].is_some() {
                continue;
            }
            let (mut group, mut open) = (Vec::new(), VecDeque::from([first]));
            side[first] = Some(true);
            while let Some(cell) = open.pop_front() {
                let own = side[cell]?;
                group.push(cell);
                for (other, turns) in &beside[cell] {
                    let wanted = own != *turns;
                    match side[*other] {
                        Some(known) if known != wanted => return None,
                        Some(_) => {}
                        None => {
                            side[*other] = Some(wanted);
                            open.push_back(*other);
                        }
                    }
                }
            }
            let (mut sum, mut all): (Votes, Votes) = ([0.0; 5], [0.0; 5]);
            for cell in &group {
                let sign = if side[*cell] == Some(true) { 1.0 } else { -1.0 };
                (0..sum.len()).for_each(|k| {
                    sum[k] += sign * votes[*cell][k];
                    all[k] += votes[*cell][k].abs();
                });
            }
            let decides = (0..sum.len()).find(|k| sum[*k].abs() > self.tolerance.rounding);
            let as_is = decides.is_none_or(|k| sum[k] > 0.0);
            doubts.extend(self.doubt(&group, decides.unwrap_or(GROUNDS.len() - 1), &sum, &all));
            group.iter().for_each(|cell| kept[*cell] = (side[*cell] == Some(true)) == as_is);
        }
        kept.iter().any(|k| *k).then_some((kept, doubts))
    }

    /// What speaks for the side of a group of cells that is not kept, where anything does.
    fn doubt(&self, group: &[usize], decides: usize, sum: &Votes, all: &Votes) -> Option<Doubt> {
        let share = if all[decides] > 0.0 { 0.5 + 0.5 * sum[decides].abs() / all[decides] } else { 0.5 };
        if group.len() < 2 || share > 1.0 - ROUNDING_SHARE {
            return None;
        }
        let own = |k: &usize| self.cells.beside(*k).into_iter().flatten().any(|cell| group.contains(&cell));
        let mut bounding = (0..self.pieces.len()).filter(|k| !self.pieces[*k].rim).filter(own);
        let at = bounding.find_map(|k| middle(self.base, &self.pieces[k]))?.0;
        Some(Doubt { by: GROUNDS[decides], share, at })
    }

    /// Pairs of cells across seams and across curves of loops.
    fn ties(&self) -> Vec<(usize, usize, Tie)> {
        let mut ties = Vec::new();
        for (k, piece) in self.pieces.iter().enumerate() {
            let [left, right] = self.cells.beside(k);
            if !piece.rim {
                ties.extend(left.zip(right).map(|(a, b)| (a, b, Tie::Other)));
            } else if piece.seam {
                let across = self.cells.twin(k).and_then(|twin| self.cells.beside(twin)[0]);
                ties.extend(left.zip(across).map(|(a, b)| (a, b, Tie::Same)));
            }
        }
        ties
    }

    /// For each cell: border of the surface that no curve runs along, curves and a point inside the face, directions of curves, size.
    fn votes(&self, inner: &[Chain]) -> Vec<Votes> {
        let mut votes: Vec<Votes> = vec![[0.0; 5]; self.cells.count()];
        let sense = if self.known.against { -1.0 } else { 1.0 };
        for (k, piece) in self.pieces.iter().enumerate() {
            let [left, right] = self.cells.beside(k);
            let length = piece.p.0.distance(piece.p.1) + piece.p.1.distance(piece.p.2);
            if !piece.rim {
                left.into_iter().for_each(|c| votes[c][3] += sense * length);
                right.into_iter().for_each(|c| votes[c][3] -= sense * length);
                continue;
            }
            let (Some(cell), false, false) = (left, piece.seam, matches!(piece.border.side, Side::Pole(_))) else { continue };
            let along = self.along(piece);
            if along.is_empty() {
                votes[cell][0] += if self.known.has_outer { -length } else { length };
            }
            votes[cell][3] += sense * along.into_iter().sum::<f64>() * length;
        }
        if !inner.is_empty() || self.known.inside.is_some() {
            let nearest = Nearest::new(self.base);
            for chain in inner {
                let p = chain.point(MIDDLE);
                let foot = DVec2::from(nearest.at(p).uv);
                let on_seam = |piece: &&Piece| piece.seam && near(self.base, piece, p, foot, ONE * self.tolerance.point);
                let beside = (0..self.pieces.len()).filter(|k| on_seam(&&self.pieces[*k])).filter_map(|k| self.cells.beside(k)[0]);
                let beside: Vec<usize> = beside.collect();
                let found = if beside.is_empty() { self.cells.at(foot).into_iter().collect() } else { beside };
                found.into_iter().for_each(|c| votes[c][1] += chain.length());
            }
            let within = self.known.inside.and_then(|p| self.cells.at(DVec2::from(nearest.at(p).uv)));
            within.into_iter().for_each(|c| votes[c][2] = 1.0);
        }
        for (c, votes) in votes.iter_mut().enumerate() {
            votes[4] = if self.known.has_outer { -self.cells.size(c) } else { self.cells.size(c) };
        }
        votes
    }

    /// The curves of loops that run along a piece of the border: 1 for each in its direction, −1 against it.
    fn along(&self, piece: &Piece) -> Vec<f64> {
        let Some((at, ahead)) = middle(self.base, piece) else { return Vec::new() };
        let room = ONE * self.tolerance.point;
        let beside = |chain: &Chain| {
            let (f, _, distance) = chain.closest(at);
            (distance <= room).then(|| chain.jet(f).d1.dot(ahead).signum())
        };
        let touched = |c: &&Chain| c.bbox().distance_squared(at) <= room * room;
        self.borders.iter().filter(touched).filter_map(beside).collect()
    }

    fn nothing(&self, trimming: Origin) -> BorderFault {
        let of = self.borders.first().map_or(trimming, Chain::origin);
        let at = self.borders.first().map_or(DVec3::ZERO, Chain::start);
        BorderFault::LoopGoesRound { of, surface: self.base.origin(), trimming, at }
    }
}

/// A place of a piece with its direction there.
fn middle(base: &Surface, piece: &Piece) -> Option<(DVec3, DVec3)> {
    match (&piece.trim_curve, piece.own_chain()) {
        (TrimCurve::Line(a, b), _) => {
            let (a, b) = (DVec2::from(*a), DVec2::from(*b));
            let at = a.lerp(b, MIDDLE);
            let jet = base.jet(at.x, at.y);
            Some((jet.p, jet.du * (b - a).x + jet.dv * (b - a).y))
        }
        (TrimCurve::Pcurve(pcurve), Some(chain)) => {
            let jet = chain.jet(pcurve.fraction(MIDDLE));
            Some((jet.p, jet.d1 * (pcurve.fraction(1.0) - pcurve.fraction(0.0)).signum()))
        }
        _ => None,
    }
}

/// Whether a point with its place on the surface lies on a piece.
fn near(base: &Surface, piece: &Piece, p: DVec3, foot: DVec2, room: f64) -> bool {
    match (piece.own_chain(), &piece.trim_curve) {
        (Some(chain), _) => chain.closest(p).2 <= room,
        (None, TrimCurve::Line(a, b)) => {
            let (a, along) = (DVec2::from(*a), DVec2::from(*b) - DVec2::from(*a));
            let on_line = |uv: DVec2| a + along * ((uv - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            shifts(base).into_iter().map(|by| on_line(foot + by)).any(|uv| base.point(uv.x, uv.y).distance(p) <= room)
        }
        (None, TrimCurve::Pcurve(_)) => false,
    }
}
