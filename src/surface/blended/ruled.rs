//! Straight lines between two curves.

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build::line;
use crate::network::Chain;
use crate::surface::blended::coons::{borders, set_kinks};
use crate::surface::blended::skin_align::{Read, SkinSection, aligned, join_at, join_corners};
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::flow_words::phrase;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::rails::ring::Ring;
use crate::surface::rails::side::{Border, Side};
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::weights::BlendAxis;

/// The ruled surface S(u, v) = (1 − v) a(u) + v b(u), u the arc-length fraction of both; between corners, where both have equally many.
///
/// `b` is read backwards when that makes the two end lines shorter together (the longer way crosses them). Of closed curves it is read
/// as a skin reads its sections: the way round that `a` runs, from the start from which lines twist least. Ends that meet are poles.
/// Returns warnings too (W614).
pub fn ruled(a: &Chain, b: &Chain, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let read = if closed(a, b, tolerance) {
        aligned(&[a, b].map(|chain| SkinSection::Curve(chain.clone())), true, tolerance)?
    } else {
        let mut read = as_drawn(a, b, tolerance);
        join_corners(&mut read, tolerance);
        read
    };
    between((a, b), &read, origin, tolerance)
}

/// The same by arc-length fractions from where curves start, however the lines twist.
pub fn ruled_as_drawn(a: &Chain, b: &Chain, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    between((a, b), &as_drawn(a, b, tolerance), origin, tolerance)
}

/// The same, but piece by piece between joints and knots where both curves have equally many of them: copies of one curve at two distances
/// are joined along its normals if their pieces are lines and arcs.
pub fn ruled_by_pieces(a: &Chain, b: &Chain, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let mut read = as_drawn(a, b, tolerance);
    join_at(&mut read, &chain_breaks, tolerance);
    between((a, b), &read, origin, tolerance)
}

/// Both from their starts, or the second backwards.
fn as_drawn(a: &Chain, b: &Chain, tolerance: &Tolerance) -> Vec<Read> {
    let apart = |b0: glam::DVec3, b1: glam::DVec3| a.start().distance_squared(b0) + a.end().distance_squared(b1);
    let reversed = match closed(a, b, tolerance) {
        true => Ring::of(a).runs_against(&Ring::of(b)) == Some(true),
        false => apart(b.end(), b.start()) < apart(b.start(), b.end()),
    };
    vec![Read::whole(a.clone(), false), Read::whole(b.clone(), reversed)]
}

fn closed(a: &Chain, b: &Chain, tolerance: &Tolerance) -> bool {
    a.is_closed(tolerance) && b.is_closed(tolerance)
}

fn between((a, b): (&Chain, &Chain), read: &[Read], origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let closed = closed(a, b, tolerance);
    let rails = read.iter().map(Read::rail).collect();
    let axis = || BlendAxis::new(vec![0.0, 1.0], Rule::Lagrange);
    let mut blend = Blend::new(axis(), axis(), Vec::new(), rails);
    let mut notes = Vec::new();
    let kinks = set_kinks(&mut blend, origin, tolerance, &mut notes);
    let mut borders = borders(&blend);
    let mut generated = Vec::new();
    let mut poles = 0;
    for (k, u) in [(1, 1.0), (3, 0.0)] {
        let (from, to) = (blend.along_u()[0].point(u), blend.along_u()[1].point(u));
        borders[k] = if closed && k == 1 {
            continue;
        } else if tolerance.same_point(from, to) {
            poles += 1;
            Border::straight(Side::Pole(0.5 * (from + to)))
        } else {
            let side = Chain::of_curve(&line(from, to, origin)?);
            generated.push(side.clone());
            Border::chain(side, false)
        };
    }
    if closed {
        borders[1] = borders[3].clone();
    }
    let surface = Surface::new(Parts {
        origin,
        kind: SurfaceKind::Ruled,
        flow: phrase(poles, (closed, false)),
        domain: Domain::Square,
        closed: (closed, false),
        borders,
        kinks,
        shape: Shape::Blend(blend),
        chains: vec![a.clone(), b.clone()],
        generated,
        trim: None,
        flipped: false,
    });
    Ok((surface, notes))
}
