//! The parts into which curves divide a surface.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::fault::quantities::round_up;
use crate::base::job;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, TOLD_APART, Tolerance};
use crate::network::Chain;
use crate::surface::closest::foot;
use crate::surface::closest::nearest::closest;
use crate::surface::core::plane;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::CutFault;
use crate::surface::rails::side::{Border, Side};
use crate::surface::rails::trim_curve::TrimCurve;
use crate::surface::trims::cells::{Cells, FaceLoops};
use crate::surface::trims::cutters::{DividingCurve, Meets, Piece, bounded, dividing_curves, pieces, within};
use crate::surface::trims::faces::{Edge, bridges, followers, is_plane, loops, without_tails};
use crate::surface::trims::pcurve::is_pole;
use crate::surface::trims::trim_loop::{TrimLoop, assembled, natural};

/// How vertices are found and the pieces that leave them are ordered.
struct Vertices {
    /// Ends of one piece farther from each other than so many tolerances are two vertices.
    apart_tolerances: f64,
    /// Share of the shortest piece at a vertex at which directions out of it are taken.
    direction_share: f64,
    /// Directions are taken so many tolerances away from a vertex, or at `clear_share` of the shortest piece where that is less.
    clear_tolerances: f64,
    /// Share of the shortest piece.
    clear_share: f64,
    /// Directions of pieces that are not apart there are taken no farther away than at this share of the shortest piece.
    farthest_share: f64,
    /// Places nearer in (u, v) than this may be one vertex: at a pole, elsewhere.
    near_uv: (f64, f64),
}

const VERTICES: Vertices = Vertices {
    apart_tolerances: 2.0,
    direction_share: 0.01,
    clear_tolerances: 8.0,
    clear_share: 0.25,
    farthest_share: 0.45,
    near_uv: (NUDGE, 0.1),
};

/// Divides a surface by curves on it, together with its own border, and keeps the part with a point.
///
/// Curves may run on beyond each other and beyond the border; what hangs loose cuts nothing. A point on a border, or hardly off the surface,
/// stands for the only part within a thousandth of the surface's size. E613 when a curve is not on the surface, E659 when one of them cuts
/// nothing off, E660 when there is no such part, or several.
pub fn divide(base: &Surface, cutters: &[Chain], keep: DVec3, origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let base = &plane::unmapped(base, tolerance)?;
    let foot = foot_of(base, cutters, keep, tolerance);
    let dividing = dividing(base, cutters, Meets::Anywhere, tolerance)?;
    let cells = Cells::new(base, &dividing.pieces, &dividing.edges, tolerance)?;
    undivided(base, &dividing, cells.faces()?.len(), tolerance)?;
    let fault = match foot {
        Ok(foot) => match cells.face(foot)? {
            Some(face) => return assembled(base, trim_loops(&dividing.pieces, &face), origin),
            None => CutFault::KeepOff { surface: base.origin(), at: keep, off: 0.0, on: None, tolerance: tolerance.point }.into(),
        },
        Err(fault) => fault,
    };
    if base.ground() == Domain::Unbounded {
        return Err(fault);
    }
    let room = KEEP_SHARE * base.hull().diagonal();
    let mut near = Vec::new();
    for face in cells.faces()? {
        let part = assembled(base, trim_loops(&dividing.pieces, &face), origin)?;
        if part.hull().touches(&Box3::of([keep]), room) && closest(&part, keep).distance <= room {
            near.push(part);
        }
    }
    if near.len() == 1 { near.pop().ok_or(fault) } else { Err(fault) }
}

/// Divides a surface by a curve on it, together with its own border, and keeps the part beside the curve on the side to which `away`
/// looks from its places; fails as [`divide`] does.
pub fn beside(base: &Surface, cutter: &Chain, away: impl Fn(DVec3) -> DVec3, origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let base = &plane::unmapped(base, tolerance)?;
    let dividing = dividing(base, std::slice::from_ref(cutter), Meets::Anywhere, tolerance)?;
    let cells = Cells::new(base, &dividing.pieces, &dividing.edges, tolerance)?;
    let (whole, mut kept) = (base.untrimmed(), vec![false; cells.count()]);
    for (i, piece) in dividing.pieces.iter().enumerate() {
        let (TrimCurve::Pcurve(pcurve), Some(chain), false) = (&piece.trim_curve, piece.own_chain(), piece.seam || piece.rim) else {
            continue;
        };
        let middle = pcurve.fraction(0.5);
        let at = chain.jet(middle);
        let (uv, _) = foot::foot(base.evaluator(), at.p, pcurve.guess(middle));
        let jet = whole.jet(uv.x, uv.y);
        let left = jet.du.cross(jet.dv).cross(at.d1 * (pcurve.fraction(1.0) - pcurve.fraction(0.0)));
        let [on_left, on_right] = cells.beside(i);
        if let Some(cell) = if left.dot(away(at.p)) > 0.0 { on_left } else { on_right } {
            kept[cell] = true;
        }
    }
    match cells.faces_of(&kept)?.as_slice() {
        [face] => assembled(base, trim_loops(&dividing.pieces, face), origin),
        _ => Err(CutFault::NothingParted { surface: base.origin(), at: cutter.point(0.5), tolerance: tolerance.point }.into()),
    }
}

/// Share of the size of a surface within which a point beside a part stands for that part.
const KEEP_SHARE: f64 = 1.0 / 1000.0;

/// All parts into which curves on a surface divide it, together with its own border; fails as [`divide`] does.
pub fn split(whole: &Surface, cutters: &[Chain], origin: Origin, tolerance: &Tolerance) -> Result<Vec<Surface>> {
    let base = &plane::unmapped(whole, tolerance)?;
    parts(whole, base, &dividing(base, cutters, Meets::Anywhere, tolerance)?, origin, tolerance)
}

/// All parts into which those of some curves divide a surface that cut something off, together with its own border; `None` where none does.
/// Otherwise as [`split`].
pub fn parted(whole: &Surface, cutters: &[Chain], origin: Origin, tolerance: &Tolerance) -> Result<Option<Vec<Surface>>> {
    if cutters.is_empty() {
        return Ok(None);
    }
    let base = &plane::unmapped(whole, tolerance)?;
    let (dividing, _) = arranged(base, cutters, Meets::Anywhere, tolerance)?;
    // Along a seam alone a curve cuts nothing off either.
    if dividing.pieces.iter().all(|piece| piece.rim) {
        return Ok(None);
    }
    parts(whole, base, &dividing, origin, tolerance).map(Some)
}

/// The parts into which curves divide a surface; `base` is the same surface without a map.
fn parts(whole: &Surface, base: &Surface, dividing: &Dividing, origin: Origin, tolerance: &Tolerance) -> Result<Vec<Surface>> {
    let cells = Cells::new(base, &dividing.pieces, &dividing.edges, tolerance)?;
    let part = |face: &FaceLoops| Ok(assembled(base, trim_loops(&dividing.pieces, face), origin)?.cut_from(std::slice::from_ref(whole)));
    let faces = cells.faces()?;
    undivided(base, dividing, faces.len(), tolerance)?;
    faces.iter().map(part).collect()
}

/// Fails where cuts that end nowhere leave one part of a surface on which every way round encloses something: then one of them was
/// taken the wrong way round.
fn undivided(base: &Surface, dividing: &Dividing, parts: usize, tolerance: &Tolerance) -> Result<()> {
    let (closed_u, closed_v) = base.closed();
    let pole = |k: usize| matches!(base.side(k), Side::Pole(_));
    let simple = match base.domain() {
        Domain::Square => match (closed_u, closed_v) {
            (false, false) => true,
            (true, false) => pole(0) || pole(2),
            (false, true) => pole(1) || pole(3),
            (true, true) => false,
        },
        _ => false,
    };
    let cut = dividing.pieces.iter().find(|piece| !piece.rim);
    match cut.filter(|_| simple && parts < 2) {
        Some(piece) => Err(CutFault::NothingParted { surface: base.origin(), at: piece.p.1, tolerance: tolerance.point }.into()),
        None => Ok(()),
    }
}

/// What divides a surface: pieces of its border and of curves, as a graph in (u, v).
pub(crate) struct Dividing {
    pub pieces: Vec<Piece>,
    pub edges: Vec<Edge>,
}

/// The pieces of the border and of curves that divide a surface, loose ends left out; E659 where one of the curves cuts nothing off.
pub(crate) fn dividing(base: &Surface, cutters: &[Chain], meets: Meets, tolerance: &Tolerance) -> Result<Dividing> {
    let (dividing, idle) = arranged(base, cutters, meets, tolerance)?;
    idle.map_or(Ok(dividing), |fault| Err(fault.into()))
}

/// The same where curves may cut nothing off: with the fault of the first one that does not.
fn arranged(base: &Surface, cutters: &[Chain], meets: Meets, tolerance: &Tolerance) -> Result<(Dividing, Option<CutFault>)> {
    let curves = dividing_curves(base, cutters, meets, tolerance)?;
    let (all, along) = pieces(base, &curves, tolerance)?;
    let (edges, places) = graph(base, &all, tolerance);
    let bare: Vec<bool> = all.iter().map(|piece| piece.seam || matches!(piece.border.side, Side::Pole(_))).collect();
    let mut stays = without_tails(&edges, &sites(base, &places, tolerance), &bare);
    // A curve from one loop to another, as from the border to a hole, parts nothing either.
    let kept: Vec<usize> = (0..all.len()).filter(|k| stays[*k]).collect();
    let graph: Vec<Edge> = kept.iter().map(|k| edges[*k].clone()).collect();
    let rows = loops(&followers(&graph));
    if is_plane(&graph, &rows) {
        bridges(&rows).into_iter().map(|k| kept[k]).filter(|k| !all[*k].rim).for_each(|k| stays[k] = false);
    }
    let mut idle = None;
    for (k, cutter) in cutters.iter().enumerate() {
        let parts = || (0..all.len()).filter(|i| curves[all[*i].curve].cutter == Some(k));
        let outside = parts().next().is_none();
        if parts().any(|i| stays[i]) || outside && along.contains(&k) {
            continue;
        }
        let mut ends = if outside { Vec::new() } else { open_ends(cutter, &curves, &all, &stays, tolerance) };
        if bounded(base) {
            let loops = natural(base, tolerance)?;
            ends.retain(|p| within(base, &loops, *p).is_some());
        }
        let reach = reaching(base, cutter, &ends, tolerance);
        idle = Some(CutFault::CutOpen { cutter: cutter.origin(), surface: base.origin(), ends, outside, reach });
        break;
    }
    let kept = || (0..all.len()).filter(|i| stays[*i]);
    let (pieces, edges) = kept().map(|i| (all[i].clone(), edges[i].clone())).unzip();
    Ok((Dividing { pieces, edges }, idle))
}

/// By how much a curve on a plane is to be longer, straight on at the ends that lie inside, to leave the box of the plane: rounded up.
fn reaching(base: &Surface, cutter: &Chain, inside: &[DVec3], tolerance: &Tolerance) -> Vec<(&'static str, f64)> {
    let flat = matches!(base.parts().shape, Shape::Plane(_)) || base.kind() == SurfaceKind::Plane;
    if !flat || base.domain() == Domain::Unbounded {
        return Vec::new();
    }
    let (room, mut reach) = (base.hull(), Vec::new());
    for (side, p, way) in [("start", cutter.start(), -cutter.jet(0.0).d1), ("end", cutter.end(), cutter.jet_before(1.0).d1)] {
        let Some(way) = math::unit(way, 0.0).filter(|_| inside.iter().any(|q| tolerance.same_point(p, *q))) else { continue };
        let out = |axis: usize| (if way[axis] > 0.0 { room.max[axis] } else { room.min[axis] } - p[axis]) / way[axis];
        let most = (0..3).filter(|axis| way[*axis].abs() > NUDGE).map(out).fold(f64::INFINITY, f64::min);
        if most > tolerance.point && most.is_finite() {
            reach.push((side, round_up(most)));
        }
    }
    reach
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
fn open_ends(cutter: &Chain, curves: &[DividingCurve], all: &[Piece], stays: &[bool], tolerance: &Tolerance) -> Vec<DVec3> {
    let held = |p: DVec3| {
        let near = |piece: &Piece| match (&curves[piece.curve].chain, piece.own_chain()) {
            (_, Some(run)) | (Some(run), None) => run.closest(p).2 <= 2.0 * tolerance.point,
            (None, None) => piece.p.1.distance(p) <= 2.0 * tolerance.point,
        };
        all.iter().zip(stays).any(|(piece, stays)| *stays && !piece.seam && near(piece))
    };
    let mut ends = vec![cutter.start(), cutter.end()];
    ends.retain(|p| !held(*p));
    ends
}

/// Places of the vertices, in (u, v) and in space.
type Places = Vec<(DVec2, DVec3)>;

/// Vertices found by place, edges with their directions.
fn graph(base: &Surface, all: &[Piece], tolerance: &Tolerance) -> (Vec<Edge>, Places) {
    let (ends, places) = vertices(base, all, tolerance);
    // Curves that touch leave a vertex in one direction: at one distance from it they have parted, at one share of each perhaps not.
    let length = |piece: &Piece| match (&piece.trim_curve, piece.own_chain()) {
        (TrimCurve::Pcurve(pcurve), Some(chain)) => chain.length() * (pcurve.fraction(1.0) - pcurve.fraction(0.0)).abs(),
        _ => f64::INFINITY,
    };
    let mut fans: BTreeMap<usize, Vec<(usize, bool)>> = BTreeMap::new();
    for (k, ends) in ends.iter().enumerate() {
        fans.entry(ends.0).or_default().push((k, false));
        fans.entry(ends.1).or_default().push((k, true));
    }
    let away: BTreeMap<usize, f64> = fans.iter().map(|(vertex, fan)| (*vertex, apart_at(all, fan, &length, tolerance))).collect();
    let out = |piece: &Piece, ends: &(usize, usize)| {
        let place = |f: f64| match (&piece.trim_curve, piece.own_chain()) {
            (TrimCurve::Pcurve(pcurve), Some(chain)) => {
                let f = pcurve.fraction(f);
                foot::foot(base.evaluator(), chain.point(f), pcurve.guess(f)).0
            }
            (trim_curve, _) => {
                let places = trim_curve.places();
                places[0].lerp(places[places.len() - 1], f)
            }
        };
        let share = |vertex: usize| away[&vertex] / length(piece);
        let (first, last) = match length(piece).is_finite() {
            true => (share(ends.0), share(ends.1)),
            false => (VERTICES.direction_share, VERTICES.direction_share),
        };
        // From the place of the vertex: where pieces leave a run that they share, only what they are off it separates them.
        (place(first) - places[ends.0].0, place(1.0 - last) - places[ends.1].0)
    };
    let edges = all.iter().zip(ends).map(|(piece, ends)| Edge { ends, out: out(piece, &ends) }).collect();
    (edges, places)
}

/// How far from a vertex the pieces that leave it are apart, in space, so that their directions give their order: pieces that touch or
/// cross flatly may run within the tolerance of each other for long.
fn apart_at(all: &[Piece], fan: &[(usize, bool)], length: &impl Fn(&Piece) -> f64, tolerance: &Tolerance) -> f64 {
    let shortest = fan.iter().map(|(k, _)| length(&all[*k])).fold(f64::INFINITY, f64::min);
    let first =
        (VERTICES.direction_share * shortest).max((VERTICES.clear_tolerances * tolerance.point).min(VERTICES.clear_share * shortest));
    let place = |(k, last): &(usize, bool), away: f64| {
        let (piece, share) = (&all[*k], away / length(&all[*k]));
        match (&piece.trim_curve, piece.own_chain()) {
            (TrimCurve::Pcurve(pcurve), Some(chain)) => Some(chain.point(pcurve.fraction(if *last { 1.0 - share } else { share }))),
            _ => None,
        }
    };
    let apart = |away: f64| {
        let places: Vec<DVec3> = fan.iter().filter_map(|end| place(end, away)).collect();
        (1..places.len()).all(|k| places[..k].iter().all(|p| p.distance(places[k]) > VERTICES.apart_tolerances * tolerance.point))
    };
    if !(first > 0.0 && first.is_finite()) {
        return first;
    }
    let mut farther =
        std::iter::successors(Some(first), |away| Some(1.5 * away)).take_while(|away| *away <= VERTICES.farthest_share * shortest);
    farther.find(|away| apart(*away)).unwrap_or(first)
}

/// The vertices at the ends of pieces, and their places: ends that are near to each other are one vertex, the nearest ones first,
/// but never the two ends of a piece that are apart.
fn vertices(base: &Surface, all: &[Piece], tolerance: &Tolerance) -> (Vec<(usize, usize)>, Places) {
    let ends: Places = all.iter().flat_map(|piece| [(piece.uv.0, piece.p.0), (piece.uv.1, piece.p.2)]).collect();
    let apart: Vec<bool> = all.iter().map(|piece| piece.p.0.distance(piece.p.2) > VERTICES.apart_tolerances * tolerance.point).collect();
    let near: Vec<f64> = ends.iter().map(|(uv, _)| if is_pole(base, *uv) { VERTICES.near_uv.0 } else { VERTICES.near_uv.1 }).collect();
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (b, (uv, p)) in job::looking(ends.iter().enumerate()) {
        for (a, (st, q)) in ends[..b].iter().enumerate() {
            let off = p.distance(*q);
            if off <= TOLD_APART * tolerance.point && (*uv - *st).abs().max_element() <= near[b] {
                pairs.push((off, a, b));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut group: Vec<usize> = (0..ends.len()).collect();
    let mut members: Vec<Vec<usize>> = (0..ends.len()).map(|k| vec![k]).collect();
    for (_, a, b) in pairs {
        let (a, b) = (group[a].min(group[b]), group[a].max(group[b]));
        // Ends 2 k and 2 k + 1 are those of piece k.
        if a == b || members[b].iter().any(|end| apart[end / 2] && group[end ^ 1] == a) {
            continue;
        }
        let moved = std::mem::take(&mut members[b]);
        moved.iter().for_each(|end| group[*end] = a);
        members[a].extend(moved);
    }
    let firsts: Vec<usize> = (0..ends.len()).filter(|k| group[*k] == *k).collect();
    let vertex = |end: usize| firsts.partition_point(|first| *first < group[end]);
    let of_pieces = (0..all.len()).map(|k| (vertex(2 * k), vertex(2 * k + 1))).collect();
    (of_pieces, firsts.iter().map(|k| ends[*k]).collect())
}

/// Which vertices are one point of the surface, across its seams and at its poles: the first of them for each.
fn sites(base: &Surface, places: &Places, tolerance: &Tolerance) -> Vec<usize> {
    let (closed_u, closed_v) = base.closed();
    let off = |x: f64, closed: bool| if closed { (x - x.round()).abs() } else { x.abs() };
    let poles: Vec<bool> = places.iter().map(|(uv, _)| is_pole(base, *uv)).collect();
    let one = |a: usize, b: usize| {
        let ((uv, p), (st, q)) = (places[a], places[b]);
        let turned = off(uv.x - st.x, closed_u).max(off(uv.y - st.y, closed_v)) <= VERTICES.near_uv.1;
        p.distance(q) <= TOLD_APART * tolerance.point && (turned || poles[a] && poles[b])
    };
    (0..places.len()).map(|k| (0..k).find(|j| one(*j, k)).unwrap_or(k)).collect()
}

/// The loops of a face, the outer one first.
pub(crate) fn trim_loops(pieces: &[Piece], face: &FaceLoops) -> Vec<TrimLoop> {
    let mut trim_loops: Vec<TrimLoop> = face.iter().map(|row| trim_loop(pieces, row)).collect();
    trim_loops.sort_by(|a, b| b.area2().abs().total_cmp(&a.area2().abs()));
    trim_loops
}

fn trim_loop(pieces: &[Piece], row: &[((usize, bool), DVec2)]) -> TrimLoop {
    let mut trim_loop = TrimLoop { borders: Vec::new(), trim_curves: Vec::new(), chains: Vec::new() };
    for ((k, backwards), by) in row {
        let piece = &pieces[*k];
        let (border, trim_curve): (Border, TrimCurve) =
            if *backwards { (piece.border.turned(), piece.trim_curve.turned()) } else { (piece.border.clone(), piece.trim_curve.clone()) };
        if let Side::Chain { chain, .. } = &border.side {
            trim_loop.chains.push(chain.clone());
        }
        trim_loop.borders.push(border);
        trim_loop.trim_curves.push(trim_curve.shifted(*by));
    }
    trim_loop
}
