//! `plane`: flat faces between curves.
//!
//! A boundary of two, three or four sides is mapped (ruled, uniform trilateral, bilinear Coons) where that map is regular. Sides are
//! the curves as written; of one curve, or of more than four, the runs between corners. Any other boundary is a face with an area and
//! a border, over the box of its plane, but without a map.

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::{Chain, Flow, FlowKind};
use crate::surface::blended::coons::{borders, set_kinks};
use crate::surface::core::plane::{around, fitted, flat};
use crate::surface::core::regular::is_regular;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::flow_words::phrase;
use crate::surface::data::kind::Domain;
use crate::surface::faults::LoopRole;
use crate::surface::rails::boundary::{Step, simple, walked};
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::Map;
use crate::surface::rails::side::{Border, Side};
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::trilateral::Trilateral;
use crate::surface::shapes::weights::BlendAxis;

/// The flat face inside curves that close, in any order and direction; the first curve runs along u.
///
/// Returns warnings too (W614). Fails with E502 when the curves do not close, E611 when they cross, E655 when they
/// leave their plane.
pub fn bounded(chains: &[Chain], origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    let walk = walked(chains, LoopRole::Plane, tolerance)?;
    simple(&walk, tolerance)?;
    let frame = fitted(&walk, tolerance)?;
    let sides = if (2..=4).contains(&walk.len()) { walk.clone() } else { between_corners(&walk, origin, tolerance)? };
    let mut notes = Vec::new();
    let surface = match sides.as_slice() {
        [a, b] => two(a, b, origin, tolerance, &mut notes),
        [a, b, c] => three(a, b, c, origin),
        [a, b, c, d] => four([a, b, c, d], origin, tolerance, &mut notes),
        _ => return Ok((around(&walk, frame, origin), Vec::new())),
    };
    let normal = frame.eu.cross(frame.ev).normalize_or_zero();
    if !is_regular(&surface, normal, tolerance) || sides.len() == 2 && is_sheared(&surface) {
        return Ok((around(&walk, frame, origin), Vec::new()));
    }
    Ok((Surface::new(Parts { chains: chains.to_vec(), ..surface.parts().clone() }), notes))
}

/// Least sine of the angle at which the lines between two sides meet them: below, as between an airfoil and its blunt edge, they run
/// along the longer side.
const LEAST_SINE: f64 = 0.1;
/// Places along two sides at which these angles are looked at.
const PLACES: usize = 32;

/// Whether the lines between two sides that end in poles run along one of them.
fn is_sheared(surface: &Surface) -> bool {
    let places = (0..PLACES).map(|k| (k as f64 + 0.5) / PLACES as f64);
    places.flat_map(|u| [(u, 0.0), (u, 1.0)]).any(|(u, v)| {
        let jet = surface.jet(u, v);
        jet.du.cross(jet.dv).length() < LEAST_SINE * jet.du.length() * jet.dv.length()
    })
}

/// The boundary cut at its corners, begun at the first corner along the walk when the first chain does not start in one.
fn between_corners(walk: &[Step], origin: Origin, tolerance: &Tolerance) -> Result<Vec<Step>> {
    let parts: Vec<Chain> = walk.iter().map(|(chain, against)| if *against { chain.reversed() } else { chain.clone() }).collect();
    let whole = if parts.len() == 1 { parts[0].clone() } else { Chain::join(&parts, origin, tolerance)? };
    let corners = whole.kinks(tolerance);
    let n = corners.len();
    if !(2..=4).contains(&n) {
        return Ok(Vec::new());
    }
    (0..n)
        .map(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % n]);
            Ok((whole.slice(from, if to == 0.0 { 1.0 } else { to }, tolerance)?, false))
        })
        .collect()
}

fn rail((chain, against): &Step, backwards: bool) -> Rail {
    Rail::new(chain.clone(), if *against == backwards { Map::identity() } else { Map::reverse() })
}

fn linear() -> BlendAxis {
    BlendAxis::new(vec![0.0, 1.0], Rule::Lagrange)
}

fn blended(mut blend: Blend, poles: bool, origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Surface {
    let kinks = set_kinks(&mut blend, origin, tolerance, notes);
    let mut sides = borders(&blend);
    if poles {
        sides[1] = Border::straight(Side::Pole(blend.along_u()[0].point(1.0)));
        sides[3] = Border::straight(Side::Pole(blend.along_u()[0].point(0.0)));
    }
    let flow = phrase(if poles { 2 } else { 0 }, (false, false));
    let surface = flat(Shape::Blend(blend), Domain::Square, sides, flow, origin, Vec::new());
    Surface::new(Parts { kinks, ..surface.parts().clone() })
}

/// Two curves with both ends common: straight lines between them.
fn two(a: &Step, b: &Step, origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Surface {
    let blend = Blend::new(linear(), linear(), Vec::new(), vec![rail(a, false), rail(b, true)]);
    blended(blend, true, origin, tolerance, notes)
}

fn three(a: &Step, b: &Step, c: &Step, origin: Origin) -> Surface {
    let sides = [rail(a, false), rail(b, false), rail(c, true)];
    let borders = vec![Border::chain(a.0.clone(), a.1), Border::chain(b.0.clone(), b.1), Border::chain(c.0.clone(), !c.1)];
    let none = Flow {
        kind: FlowKind::UniformTrilateral,
        along_u: Vec::new(),
        along_v: Vec::new(),
        closed_u: false,
        closed_v: false,
        poles: (None, None),
        overhangs: Vec::new(),
    };
    flat(Shape::Trilateral(Trilateral::new(sides)), Domain::Triangle, borders, none.phrase(), origin, Vec::new())
}

/// Bilinear Coons: the walk goes round v = 0, u = 1, v = 1, u = 0.
fn four([a, b, c, d]: [&Step; 4], origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Surface {
    let blend = Blend::new(linear(), linear(), vec![rail(d, true), rail(b, false)], vec![rail(a, false), rail(c, true)]);
    blended(blend, false, origin, tolerance, notes)
}
