//! Walls: a face moved to both sides or to one, and what joins the borders of the two.

use crate::base::fault::{Fault, Result, ValueFault};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::surface::{Domain, Side, Surface, offset, ruled};

/// The faces of the wall between `below` and `above` a surface (model units along its normals, `below < above`), and warnings.
///
/// The two sides come first, each seen from outside, then ruled rims along the free borders: closed surfaces have none where they
/// close, and a pole needs none. Fails as [`offset`] does, and with E230 for faces whose borders are no curves: nets.
pub fn thicken(surface: &Surface, (below, above): (f64, f64), origin: Origin, tolerance: &Tolerance) -> Result<(Vec<Surface>, Vec<Fault>)> {
    let mut notes = Vec::new();
    let mut side = |distance: f64| -> Result<Surface> {
        if distance == 0.0 {
            return Ok(surface.with_origin(origin));
        }
        let (made, more) = offset(surface, distance, origin, tolerance)?;
        notes.extend(more);
        Ok(made)
    };
    let (inner, outer) = (side(below)?, side(above)?);
    let mut rims = Vec::new();
    for k in 0..inner.n_sides() {
        let (Some(low), Some(high)) = (border(&inner, k, tolerance)?, border(&outer, k, tolerance)?) else { continue };
        let (rim, more) = ruled(&low, &high, origin, tolerance)?;
        notes.extend(more);
        rims.push(rim);
    }
    let faces = [outer, inner.flipped()].into_iter().chain(rims).collect();
    Ok((faces, notes))
}

/// The curve along a free border; none where the surface closes or ends in a pole.
fn border(surface: &Surface, k: usize, tolerance: &Tolerance) -> Result<Option<Chain>> {
    let closed = surface.closed();
    if surface.domain() == Domain::Square && (if k % 2 == 1 { closed.0 } else { closed.1 }) {
        return Ok(None);
    }
    match surface.side(k) {
        Side::Pole(_) | Side::Seam => Ok(None),
        Side::Chain { chain, from, to } => {
            let (chain, from, to) = if from > to { (chain.reversed(), 1.0 - from, 1.0 - to) } else { (chain, from, to) };
            let whole = from <= 0.0 && to >= 1.0;
            Ok(Some(if whole { chain } else { chain.slice(from, to, tolerance)? }))
        }
        Side::Free => {
            Err(ValueFault::NotInThisVersion { what: "`thicken` of what is no plane, extrusion or revolution".to_owned() }.into())
        }
    }
}
