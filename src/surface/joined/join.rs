//! `join`: surfaces that follow one another along whole common borders, as one.

use crate::base::fault::{Fault, Result, ValueFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::quadrature::gauss_legendre;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::surface::core::joined::Joined;
use crate::surface::core::joined_piece::{JoinedPiece, Turn};
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::jet::unit_normal;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::data::one_sided::OneSided;
use crate::surface::faults::JoinFault;
use crate::surface::joined::rims::{self, Link, Rim, links};
use crate::surface::rails::side::{Border, Side};

/// Lines of a surface whose mean is its length.
const LINES: usize = 5;
/// Points of the rule for a length.
const ORDER: usize = 16;
/// Places at which the two sides of a seam are compared.
const MAX_SAMPLES: usize = 33;

/// Surfaces with common whole borders, in any order and direction, as one.
///
/// The first one's u and v stay u and v: one of them runs across all, in proportion to their mean lengths, the other along the common borders.
/// Fails with E306 for fewer than two, and with E722 for surfaces without four sides, and where they do not follow one another.
pub fn join(surfaces: &[Surface], origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let all: Vec<Surface> = surfaces.iter().flat_map(given).collect();
    if surfaces.len() < 2 {
        let (found, range) = (format!("{} given", surfaces.len()), "two surfaces or more".to_owned());
        return Err(ValueFault::OutsideRange { argument: "surfaces", found, range }.into());
    }
    if let Some(other) = all.iter().find(|s| s.domain() != Domain::Square) {
        return Err(JoinFault::NotFourSided { a: other.origin() }.into());
    }
    let rims: Vec<Vec<Rim>> = all.iter().map(Rim::all).collect();
    let links = links(&all, &rims, tolerance);
    let follow = row(&all, &rims, &links)?;
    let across_v = follow.across_v;
    let lengths: Vec<f64> = follow.pieces.iter().map(length).collect();
    let joined = Joined::new(follow.pieces, &lengths, across_v);
    Ok(surface(joined, across_v, origin, tolerance))
}

/// The surfaces that a joined one was made of; any other by itself.
fn given(surface: &Surface) -> Vec<Surface> {
    match &surface.parts().shape {
        Shape::Joined(joined) if surface.domain() == Domain::Square => {
            let turned = |s: Surface| if surface.parts().flipped { s.flipped() } else { s };
            joined.given().into_iter().map(turned).collect()
        }
        _ => vec![surface.clone()],
    }
}

/// Pieces in a row.
struct Row {
    pieces: Vec<JoinedPiece>,
    across_v: bool,
}

/// The row of all surfaces, as the first one lies; E722 where there is none.
fn row(all: &[Surface], rims: &[Vec<Rim>], links: &[Link]) -> Result<Row> {
    let of = |n: usize| links.iter().filter(move |l| l.ends[0].0 == n || l.ends[1].0 == n).collect::<Vec<_>>();
    for (n, surface) in all.iter().enumerate() {
        let own: Vec<(usize, usize)> = of(n).iter().map(|l| (l.side(n), l.other(n).0)).collect();
        let fits = match own.as_slice() {
            [] | [_] => true,
            [a, b] => (a.0 + 2) % 4 == b.0,
            _ => false,
        };
        if !fits {
            let (b, c) = (all[own[0].1].origin(), all[own[1].1].origin());
            return Err(JoinFault::NotInRow { a: surface.origin(), b, c }.into());
        }
    }
    let Some(first) = of(0).first().map(|l| l.side(0)) else { return Err(apart(all, rims, &[0])) };
    let across_v = first % 2 == 0;
    let start = Turn { swap: across_v, ..Turn::default() };
    let (near, far) = if across_v { (0, 2) } else { (3, 1) };
    let walk = |side: usize, ahead: bool, seen: &mut Vec<usize>| -> Vec<JoinedPiece> {
        let (mut found, mut at, mut turn) = (Vec::new(), (0, side), start);
        let mut before = JoinedPiece::new(all[0].clone(), start, 0);
        while let Some(link) = links.iter().find(|l| l.ends.contains(&at)) {
            let (next, entered) = link.from(at);
            if seen.contains(&next) {
                break;
            }
            turn = rims::turn(entered, ahead, turn.back_y != link.reversed);
            let mut piece = JoinedPiece::new(all[next].clone(), turn, next);
            let (end, begin) = if ahead { (1.0, 0.0) } else { (0.0, 1.0) };
            // A piece whose y begins elsewhere than its border takes the next one along.
            if link.apart || before.shift > 0.0 {
                piece.begin_at(begin, before.jet(end, 0.0, LAST).p);
            }
            before = piece.clone();
            found.push(piece);
            seen.push(next);
            at = (next, (entered + 2) % 4);
        }
        found
    };
    let mut seen = vec![0];
    let after = walk(far, true, &mut seen);
    let mut pieces = walk(near, false, &mut seen);
    if seen.len() < all.len() {
        return Err(apart(all, rims, &seen));
    }
    pieces.reverse();
    pieces.push(JoinedPiece::new(all[0].clone(), start, 0));
    pieces.extend(after);
    Ok(Row { pieces, across_v })
}

/// E722 for the nearest pair of a surface that was reached and one that was not.
fn apart(all: &[Surface], rims: &[Vec<Rim>], seen: &[usize]) -> Fault {
    let mut best: Option<(f64, JoinFault)> = None;
    for a in seen.iter().copied() {
        for b in (0..all.len()).filter(|n| !seen.contains(n)) {
            for (x, y) in rims[a].iter().flat_map(|x| rims[b].iter().map(move |y| (x, y))) {
                let (gap, at) = x.apart(y);
                if best.as_ref().is_none_or(|b| gap < b.0) {
                    best = Some((gap, JoinFault::Apart { a: all[a].origin(), b: all[b].origin(), gap, at }));
                }
            }
        }
    }
    best.map_or_else(|| JoinFault::NotFourSided { a: all[0].origin() }.into(), |b| b.1.into())
}

/// The mean length of lines along x.
fn length(piece: &JoinedPiece) -> f64 {
    let rule = gauss_legendre(ORDER);
    let sides = (OneSided::After, OneSided::After);
    let line = |y: f64| rule.iter().map(|(x, w)| 0.5 * w * piece.jet(0.5 + 0.5 * x, y, sides).du.length()).sum::<f64>();
    (0..LINES).map(|k| line((k as f64 + 0.5) / LINES as f64)).sum::<f64>() / LINES as f64
}

/// Whether the surface has a crease along the seam before piece k.
fn folds(joined: &Joined, k: usize, tolerance: &Tolerance) -> bool {
    (0..MAX_SAMPLES).any(|n| {
        let (a, b) = joined.beside(k, n as f64 / (MAX_SAMPLES - 1) as f64);
        match (unit_normal(&a), unit_normal(&b)) {
            (Some(a), Some(b)) => math::angle_between(a, b) > tolerance.angle,
            _ => false,
        }
    })
}

fn surface(joined: Joined, across_v: bool, origin: Origin, tolerance: &Tolerance) -> Surface {
    let pieces = joined.pieces();
    let smooth: Vec<f64> = (1..pieces.len()).filter(|k| !folds(&joined, *k, tolerance)).map(|k| joined.seams()[k - 1]).collect();
    let (mut us, mut vs) = joined.lines(|s| (s.kinks().0.to_vec(), s.kinks().1.to_vec()));
    // Seams of pieces that are none of all.
    let along = if across_v { &mut us } else { &mut vs };
    along.extend(joined.turned_seams().into_iter().filter(|y| joined.fold_at(*y) > tolerance.angle));
    along.sort_by(f64::total_cmp);
    along.dedup();
    let across = if across_v { &mut vs } else { &mut us };
    across.retain(|x| smooth.iter().all(|s| s != x));
    let point = |x: f64, y: f64| if across_v { joined.jet(y, x, LAST).p } else { joined.jet(x, y, LAST).p };
    let places = |f: &dyn Fn(f64) -> bool| (0..MAX_SAMPLES).all(|n| f(n as f64 / (MAX_SAMPLES - 1) as f64));
    let same = |a: glam::DVec3, b: glam::DVec3| a.distance(b) <= tolerance.rounding.max(tolerance.point * tolerance.parameter);
    let closed_x = pieces.len() > 1 && places(&|y| same(point(0.0, y), point(1.0, y)));
    let closed_y = pieces.iter().all(|p| if p.turn.swap { p.surface.closed().0 } else { p.surface.closed().1 });
    // A side that is a point of all pieces, or of the one at the end.
    let own = |piece: &JoinedPiece, k: usize| piece.surface.side(piece.turn.side(k));
    let pole = |k: usize| -> Option<glam::DVec3> {
        let of: Vec<&JoinedPiece> = match k {
            1 => pieces.last().into_iter().collect(),
            3 => pieces.first().into_iter().collect(),
            _ => pieces.iter().collect(),
        };
        let points: Vec<glam::DVec3> =
            of.into_iter().map(|p| if let Side::Pole(at) = own(p, k) { Some(at) } else { None }).collect::<Option<_>>()?;
        points.iter().all(|p| tolerance.same_point(*p, points[0])).then(|| points[0])
    };
    let side = |k: usize| match (pole(k), if k % 2 == 1 { closed_x } else { closed_y }) {
        (Some(at), _) => Side::Pole(at),
        (None, true) => Side::Seam,
        (None, false) => Side::Free,
    };
    // Sides of (u, v) in their order.
    let borders = (0..4).map(|k| Border::straight(side(if across_v { 3 - k } else { k }))).collect();
    let mut chains: Vec<Chain> = Vec::new();
    let mut generated: Vec<Chain> = Vec::new();
    for piece in pieces {
        for chain in piece.surface.chains() {
            if chains.iter().all(|c| !c.is(chain)) {
                chains.push(chain.clone());
            }
        }
        generated.extend(piece.surface.generated().iter().cloned());
    }
    Surface::new(Parts {
        origin,
        kind: SurfaceKind::Join,
        flow: format!("{} surfaces", pieces.len()),
        domain: Domain::Square,
        closed: if across_v { (closed_y, closed_x) } else { (closed_x, closed_y) },
        borders,
        kinks: (us, vs),
        shape: Shape::Joined(joined),
        chains,
        generated,
        trim: None,
        flipped: false,
    })
}

const LAST: (OneSided, OneSided) = (OneSided::After, OneSided::After);
