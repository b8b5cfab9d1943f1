//! `thicken`: a face moved to both sides or to one, and what joins the borders of the two.

mod border;
mod carried;

pub(super) use border::whole;
use border::{Hem, curve, hems};
pub(super) use carried::trimmed;
use carried::with_loops;

use super::core::{Domain, Side, Surface, SurfaceKind};
use super::iso::between;
use super::nurbs::NurbsSurface;
use super::offset::{is_exact, offset};
use super::plane;
use super::ruled::ruled;
use super::trim::natural;
use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::build::line;
use crate::network::Chain;

/// Copies of the borders of a face, loop by loop; none where it has none.
type Copies = Vec<Vec<Option<Chain>>>;

/// The faces of the wall between `below` and `above` a surface (model units along its normals, `below < above`), and warnings.
///
/// The two sides come first, each seen from outside, then rims along the normals of the free borders: closed surfaces have none
/// where they close, and a pole needs none. Fails as [`offset`] does.
pub fn thicken(surface: &Surface, (below, above): (f64, f64), origin: Origin, tolerance: &Tolerance) -> Result<(Vec<Surface>, Vec<Fault>)> {
    if is_exact(surface, tolerance)? {
        let (inner, mut notes) = moved(surface, below, origin, tolerance)?;
        let (outer, more) = moved(surface, above, origin, tolerance)?;
        notes.extend(more);
        let rims = ruled_rims((&inner, &outer), origin, tolerance, &mut notes)?;
        return Ok(([outer, inner.flipped()].into_iter().chain(rims).collect(), notes));
    }
    let walks = natural(surface, tolerance)?;
    let (mut low, mut high, mut rims): (Copies, Copies, Vec<Surface>) = (Vec::new(), Vec::new(), Vec::new());
    for row in hems(surface, &walks, tolerance) {
        let made = row.iter().map(|hem| hem.as_ref().map(|hem| rim(hem, (below, above), origin, tolerance)).transpose());
        let made: Vec<Option<Rim>> = made.collect::<Result<_>>()?;
        low.push(made.iter().map(|rim| rim.as_ref().map(|rim| rim.low.clone())).collect());
        high.push(made.iter().map(|rim| rim.as_ref().map(|rim| rim.high.clone())).collect());
        rims.extend(made.into_iter().flatten().map(|rim| rim.face));
    }
    let side = |distance: f64, copies: &Copies| {
        if distance == 0.0 || surface.parts().trim.is_none() {
            return moved(surface, distance, origin, tolerance);
        }
        with_loops(surface, (&walks, copies), distance, origin, tolerance)
    };
    let ((inner, mut notes), (outer, more)) = (side(below, &low)?, side(above, &high)?);
    notes.extend(more);
    Ok(([outer, inner.flipped()].into_iter().chain(rims).collect(), notes))
}

/// A face at a distance along its normals.
fn moved(surface: &Surface, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<(Surface, Vec<Fault>)> {
    if distance == 0.0 {
        return Ok((surface.with_origin(origin), Vec::new()));
    }
    offset(surface, distance, origin, tolerance)
}

/// What stands along a border, with its two long sides.
struct Rim {
    low: Chain,
    high: Chain,
    face: Surface,
}

/// The strip along the normals of a face beside its border.
fn rim(hem: &Hem, (below, above): (f64, f64), origin: Origin, tolerance: &Tolerance) -> Result<Rim> {
    let [low, high] = hem.copies([below, above], origin, tolerance)?;
    let n = low.poles.len();
    let net = NurbsSurface {
        degree: (3, 1),
        knots: (low.knots.clone(), vec![0.0, 0.0, 1.0, 1.0]),
        poles: low.poles.iter().chain(&high.poles).copied().collect(),
        counts: (n, 2),
    };
    let face = net.surface(SurfaceKind::Ruled, origin, tolerance);
    Ok(Rim { low: curve(low, origin), high: curve(high, origin), face })
}

/// Ruled faces between the borders of two faces that have the same ones, named by curves.
fn ruled_rims((inner, outer): (&Surface, &Surface), origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Result<Vec<Surface>> {
    let mut rims = Vec::new();
    for k in 0..inner.n_sides() {
        let (Some(low), Some(high)) = (named(inner, k, tolerance)?, named(outer, k, tolerance)?) else { continue };
        let bent = !low.kinks(tolerance).is_empty() || !high.kinks(tolerance).is_empty();
        if bent && let Some(flat) = flat_rim(&low, &high, origin, tolerance)? {
            rims.push(flat);
            continue;
        }
        let (rim, more) = ruled(&low, &high, origin, tolerance)?;
        notes.extend(more);
        rims.push(rim);
    }
    Ok(rims)
}

/// The plane face between two curves with corners, which need not be at the same shares of them; none where they lie in no plane.
fn flat_rim(low: &Chain, high: &Chain, origin: Origin, tolerance: &Tolerance) -> Result<Option<Surface>> {
    let closed = low.is_closed(tolerance) && high.is_closed(tolerance);
    let made = if closed {
        plane::bounded(std::slice::from_ref(high), origin, tolerance)
            .and_then(|(face, _)| super::trim(&face, &[], &[vec![low.clone()]], origin, tolerance))
            .or_else(|_| {
                plane::bounded(std::slice::from_ref(low), origin, tolerance)
                    .and_then(|(face, _)| super::trim(&face, &[], &[vec![high.clone()]], origin, tolerance))
            })
    } else {
        let ends = [line(low.start(), high.start(), origin)?, line(low.end(), high.end(), origin)?].map(|c| Chain::of_curve(&c));
        let [first, last] = ends;
        plane::bounded(&[low.clone(), last, high.clone(), first], origin, tolerance).and_then(|(face, _)| plane::unmapped(&face, tolerance))
    };
    Ok(made.ok())
}

/// The curve along a free border; none where the surface closes or ends in a pole.
fn named(surface: &Surface, k: usize, tolerance: &Tolerance) -> Result<Option<Chain>> {
    let closed = surface.closed();
    if surface.domain() == Domain::Square && (if k % 2 == 1 { closed.0 } else { closed.1 }) {
        return Ok(None);
    }
    match surface.side(k) {
        Side::Chain { chain, from, to } => between(&chain, from, to, tolerance).map(Some),
        Side::Pole(_) | Side::Seam | Side::Free => Ok(None),
    }
}
