//! `thicken`: faces moved to both sides or to one, and what joins the borders of the two.

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::build::line;
use crate::network::Chain;
use crate::surface::blended::plane_face;
use crate::surface::blended::ruled::ruled_by_pieces;
use crate::surface::closest::nearest::closest;
use crate::surface::core::plane;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::faults::{WallEdge, WallFault};
use crate::surface::offset::boundary::{Boundary, boundaries, curve};
use crate::surface::offset::build::{offset, with_loops};
use crate::surface::offset::exact::{is_exact, parts_of};
use crate::surface::offset::joint::{Bend, FaceSheet};
use crate::surface::offset::shell::layer;
use crate::surface::rails::side::{Side, between};
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::trims::trim::trim;
use crate::surface::trims::trim_loop::natural;

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
    let trim_loops = natural(surface, tolerance)?;
    let (mut low, mut high, mut rims): (Copies, Copies, Vec<Surface>) = (Vec::new(), Vec::new(), Vec::new());
    for row in boundaries(surface, &trim_loops, tolerance) {
        let made =
            row.iter().map(|boundary| boundary.as_ref().map(|boundary| rim(boundary, (below, above), origin, tolerance)).transpose());
        let made: Vec<Option<RimFace>> = made.collect::<Result<_>>()?;
        low.push(made.iter().map(|rim| rim.as_ref().map(|rim| rim.low.clone())).collect());
        high.push(made.iter().map(|rim| rim.as_ref().map(|rim| rim.high.clone())).collect());
        rims.extend(made.into_iter().flatten().map(|rim| rim.face));
    }
    let side = |distance: f64, copies: &Copies| {
        if distance == 0.0 || surface.parts().trim.is_none() {
            return moved(surface, distance, origin, tolerance);
        }
        with_loops(surface, &trim_loops, copies, distance, origin, tolerance)
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
struct RimFace {
    low: Chain,
    high: Chain,
    face: Surface,
}

/// The strip along the normals of a face beside its border.
fn rim(boundary: &Boundary, (below, above): (f64, f64), origin: Origin, tolerance: &Tolerance) -> Result<RimFace> {
    let [low, high] = boundary.copies([below, above], origin, tolerance)?;
    let n = low.poles.len();
    let net = NurbsSurface {
        degree: (3, 1),
        knots: (low.knots.clone(), vec![0.0, 0.0, 1.0, 1.0]),
        poles: low.poles.iter().chain(&high.poles).copied().collect(),
        counts: (n, 2),
    };
    let face = net.surface(SurfaceKind::Ruled, origin, tolerance);
    Ok(RimFace { low: curve(low, origin), high: curve(high, origin), face })
}

/// Ruled faces between the borders of two faces that have the same ones, named by curves.
fn ruled_rims((inner, outer): (&Surface, &Surface), origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Result<Vec<Surface>> {
    let mut rims = Vec::new();
    for k in 0..inner.n_sides() {
        let (Some(low), Some(high)) = (named(inner, k, tolerance)?, named(outer, k, tolerance)?) else { continue };
        let made = strip(&low, &high, origin, tolerance, notes)?;
        // Sides run with ascending u and v; the far ones against the loop.
        let way = low.jet(0.5).d1 * if inner.domain() != Domain::Loop && k >= 2 { -1.0 } else { 1.0 };
        rims.push(outwards(made, (&low, &high), way));
    }
    Ok(rims)
}

/// A strip between two curves with its normal away from the face, whose loop runs along the lower one in some direction.
fn outwards(strip: Surface, (low, high): (&Chain, &Chain), way: DVec3) -> Surface {
    let p = low.point(0.5);
    let up = high.closest(p).1 - p;
    let (u, v) = closest(&strip, p + up * 0.5).uv;
    if strip.untrimmed().normal(u, v).dot(way.cross(up)) < 0.0 { strip.flipped() } else { strip }
}

/// The face between two curves.
fn strip(low: &Chain, high: &Chain, origin: Origin, tolerance: &Tolerance, notes: &mut Vec<Fault>) -> Result<Surface> {
    let bent = !low.kinks(tolerance).is_empty() || !high.kinks(tolerance).is_empty();
    if bent && let Some(flat) = flat_rim(low, high, origin, tolerance)? {
        return Ok(flat);
    }
    let (rim, more) = ruled_by_pieces(low, high, origin, tolerance)?;
    notes.extend(more);
    Ok(rim)
}

/// The plane face between two curves with corners, which need not be at the same shares of them; none where they lie in no plane.
fn flat_rim(low: &Chain, high: &Chain, origin: Origin, tolerance: &Tolerance) -> Result<Option<Surface>> {
    let closed = low.is_closed(tolerance) && high.is_closed(tolerance);
    let made = if closed {
        plane_face::bounded(std::slice::from_ref(high), origin, tolerance)
            .and_then(|(face, _)| trim(&face, &[], &[vec![low.clone()]], origin, tolerance))
            .or_else(|_| {
                plane_face::bounded(std::slice::from_ref(low), origin, tolerance)
                    .and_then(|(face, _)| trim(&face, &[], &[vec![high.clone()]], origin, tolerance))
            })
    } else {
        let ends = [line(low.start(), high.start(), origin)?, line(low.end(), high.end(), origin)?].map(|c| Chain::of_curve(&c));
        let [first, last] = ends;
        plane_face::bounded(&[low.clone(), last, high.clone(), first], origin, tolerance)
            .and_then(|(face, _)| plane::unmapped(&face, tolerance))
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

/// The faces of the wall of several faces that share edges: both sides, then rims along the free borders.
///
/// Faces that go on smoothly into each other share the moved edge; at sharp edges they are made longer or cut back to where the moved
/// ones meet. The sides are those of the first face, of flipped faces where `turned` says so of them and whether they close. Borders within `near` of each other
/// are meant to be one edge. Fails as
/// [`offset`] does, and with E671 where moved faces do not meet.
pub fn thicken_all(
    faces: &[Surface],
    (below, above): (f64, f64),
    near: f64,
    turned: &dyn Fn(&[Surface], bool) -> bool,
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<(Vec<Surface>, Vec<Fault>)> {
    if let [face] = faces {
        let closed = boundaries(face, &natural(face, tolerance)?, tolerance).iter().flatten().all(Option::is_none);
        let face = if turned(faces, closed) { face.flipped() } else { face.clone() };
        return thicken(&face, (below, above), origin, tolerance);
    }
    let mut sheet = FaceSheet::new(faces, near, origin, tolerance)?;
    let closed = sheet.joints.iter().all(|joint| joint.bend != Bend::Free);
    // Which side of one piece is that of another one follows from neither.
    if below != -above
        && let Some(second) = sheet.second_piece()
    {
        let (a, b) = (sheet.faces[0].origin(), second.origin());
        let at = closest(second, second.hull().center()).point;
        return Err(WallFault::Edge { wall: origin, a, b, at, why: WallEdge::Loose }.into());
    }
    if turned(&sheet.faces, closed) {
        let other: Vec<Surface> = sheet.faces.iter().map(Surface::flipped).collect();
        sheet = FaceSheet::new(&other, near, origin, tolerance)?;
    }
    let (inner, outer) = (layer(&sheet, below, origin, tolerance)?, layer(&sheet, above, origin, tolerance)?);
    let mut notes = [inner.notes, outer.notes].concat();
    let mut all = outer.faces;
    all.extend(inner.faces.iter().map(Surface::flipped));
    for (k, joint) in sheet.joints.iter().enumerate().filter(|(_, joint)| joint.bend == Bend::Free) {
        let at = joint.uses[0];
        let boundary = &sheet.boundaries[at.face][at.boundary];
        let own = rim(boundary, (below, above), origin, tolerance)?;
        let ends = |a: &Chain, b: &Chain| tolerance.same_point(a.start(), b.start()) && tolerance.same_point(a.end(), b.end());
        if ends(&own.low, &inner.edges[k]) && ends(&own.high, &outer.edges[k]) {
            all.push(own.face);
            continue;
        }
        let made = strip(&inner.edges[k], &outer.edges[k], origin, tolerance, &mut notes)?;
        let way = boundary.jet(0.5, false).map_or(DVec3::ZERO, |jet| jet.d1);
        all.push(outwards(made, (&inner.edges[k], &outer.edges[k]), way));
    }
    Ok((all, notes))
}

/// Faces without creases that make up some faces: extrusions and revolutions are divided at the corners of their profiles.
pub fn without_creases(faces: &[Surface], origin: Origin, tolerance: &Tolerance) -> Result<Vec<Surface>> {
    let mut all = Vec::new();
    for face in faces {
        all.extend(parts_of(face, origin, tolerance)?);
    }
    Ok(all)
}
